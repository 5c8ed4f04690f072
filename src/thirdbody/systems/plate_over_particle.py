r"""A plate pressed on a flat with one particle under it: a wafer on a chuck.

A pressure p presses a thin plate on a flat; a particle lifts it by h over a circle of radius b.
Outside the plate lies on the flat, so that deflection, slope and moment are zero at b:

.. math:: h = \frac{p\,b^4}{64 D}, \qquad F = \tfrac12\pi p\,b^2 = 4\pi\sqrt{p D h}, \qquad
          D = \frac{E t^3}{12(1-\nu^2)} .

The particle carries the same force F squeezed by x − h between plate and flat. A rigid one would
lift the plate by its diameter; one that yields, or sinks in, by far less.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..laws.particle.series import Series
from ..populations.materials import Material, MaterialPair
from ..quantities.value import Value, quantity

if TYPE_CHECKING:
    from ..laws.base import AbstractParticleLaw

__all__ = ["Bump", "PlateOverParticle"]


def __dir__() -> list[str]:
    return sorted(__all__)


ATOM = 1e-10
"""Metres, about the size of an atom: a plate that stands less high does not stand on the particle,
which is pressed into plate and chuck."""
THIN = 3.0
"""Radius of the bump over the thickness below which a plate is no thin plate."""


class Bump(NamedTuple):
    """Bump of a plate above a particle: one number each, in SI.

    Examples
    --------
    >>> from thirdbody.systems.plate_over_particle import Bump
    >>> Bump(height=1e-7, radius=4.3e-3, force=2.9, squeeze=9.9e-6, thin=True).force
    2.9
    """

    height: float
    """Lift h of the plate above the particle [m]."""
    radius: float
    """Radius b over which it is lifted [m]."""
    force: float
    """Force F on the particle [N]."""
    squeeze: float
    """Diameter less height, δ = x − h [m]."""
    thin: bool
    """Whether b is above three thicknesses, as the theory of thin plates asks."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlateOverParticle(Value):
    r"""A thin plate on a flat, and one particle between them.

    .. math:: f(x - h) = 4\pi\sqrt{p D h}

    Parameters
    ----------
    plate, flat : Material
        Of the plate, and of what it lies on.
    thickness : float
        Thickness t of the plate [m].
    pressure : float
        Pressure p on the plate [Pa].
    law : AbstractParticleLaw, optional
        What the particle does between the two.

    Notes
    -----
    The plate is thin (b > 3 t is told by `Bump.thin`), wide against b, and deflected by less than
    its thickness; there is no friction. The force law is loading: a plate let down on a particle.

    References
    ----------
    The plate is Timoshenko, Woinowsky-Krieger, Theory of Plates and Shells, 2nd ed., ch. 3, with
    a radius that is free: the clamped plate under F and p, with the moment at b zero.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.plate_over_particle import PlateOverParticle
    >>> silicon = tb.Material(E=160e9, nu=0.22, H=12e9)
    >>> chuck = PlateOverParticle(plate=silicon, flat=tb.materials["S45C"], thickness=725e-6,
    ...                           pressure=1e5)
    >>> round(chuck.bump(100e-9).radius * 1e3, 1)
    4.3
    >>> found = chuck.over(10e-6, tb.materials["SiO2"])
    >>> f"{found.height * 1e9:.1f} nm instead of 10 µm"
    '17.2 nm instead of 10 µm'
    """

    plate: Material
    flat: Material
    thickness: float = quantity("t", "m", "thickness of the plate", gt=0, usual=0.1)
    pressure: float = quantity("p", "Pa", "pressure on the plate", gt=0, usual=1e3)
    law: AbstractParticleLaw = Series()

    @property
    def rigidity(self) -> float:
        """Bending stiffness D [N m]."""
        return self.plate.E * self.thickness**3 / (12 * (1 - self.plate.nu**2))

    def bump(self, height: float) -> Bump:
        """The plate lifted by a rigid point.

        Parameters
        ----------
        height : float
            Height h of the point [m].
        """
        radius = (64 * self.rigidity * height / self.pressure) ** 0.25
        return Bump(
            height=height,
            radius=radius,
            force=4 * math.pi * math.sqrt(self.pressure * self.rigidity * height),
            squeeze=0.0,
            thin=radius > THIN * self.thickness,
        )

    def over(self, diameter: float, material: Material) -> Bump:
        """The bump over a particle, which yields.

        The height is found to 1e-12 of itself: force of the plate, which rises with h, against
        that of the particle, which falls.

        Parameters
        ----------
        diameter : float
            Diameter D of the particle [m].
        material : Material
            Its material.
        """
        from scipy.optimize import brentq

        one = self.law.one(surfaces=MaterialPair(self.plate, self.flat), particle=material)

        def excess(log_height: float) -> float:
            height = math.exp(log_height)
            carried = one.at(np.array([1 - height / diameter])).load[0] * diameter**2
            return math.log(self.bump(height).force) - math.log(max(float(carried), 1e-300))

        top = math.log(diameter)
        height = math.exp(brentq(excess, top - 200, top - 1e-16, xtol=1e-13, rtol=1e-14))
        return self.bump(height)._replace(squeeze=diameter - height)
