r"""A plate on a chuck with dust under it: how high it stands, and how often too high.

The bump over one particle is that of `plate_over_particle`. Of particles at random under a plate
of area A_w, of which the part t touches the chuck,

.. math:: N = t\,A_w\,\eta_a\,P(x > x_l), \qquad P(\text{none}) = e^{-N}

lift the plate by more than a limit l, where x_l is the particle that lifts it by l.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..laws.particle.series import Series
from ..laws.particle.tension import breaks
from ..populations.materials import MaterialPair
from ..populations.particles import Particles
from ..quantities.value import Value, items_of, quantity
from .plate_over_particle import Bump, PlateOverParticle

if TYPE_CHECKING:
    from ..laws.base import AbstractParticleLaw

__all__ = ["Chuck"]


def __dir__() -> list[str]:
    return sorted(__all__)


@dataclass(frozen=True, slots=True, kw_only=True)
class Chuck(Value):
    r"""A plate, film or wafer held on a flat, and the dust between them.

    .. math:: f(x - h) = 4\pi\sqrt{p D h}

    Parameters
    ----------
    surfaces : MaterialPair
        The plate first, then the chuck.
    thickness : float
        Thickness t of the plate [m].
    pressure : float
        Pressure p that holds it [Pa].
    diameter : float, optional
        Diameter of a round plate [m].
    limit : float, optional
        Largest height l that is allowed, as a depth of focus [m].
    touching : float, optional
        Part of the plate that touches the chuck [1]: of a chuck with pins some hundredths.
    particles : Particles or sequence of Particles, optional
        What lies under the plate.
    law : AbstractParticleLaw, optional
        What one particle does between plate and chuck.

    Notes
    -----
    As `thirdbody.systems.plate_over_particle.PlateOverParticle`, with the same limits. Bumps do
    not meet. Between pins a particle lifts nothing.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.chuck import Chuck
    >>> silicon = tb.Material(E=160e9, nu=0.22, H=12e9)
    >>> dust = tb.Particles(material=tb.materials["SiO2"], areal_density=1e4,
    ...                     diameter=tb.LogNormal(median=3e-6, gsd=1.8))
    >>> chuck = Chuck(surfaces=tb.MaterialPair(silicon, tb.materials["SiC"]), thickness=775e-6,
    ...               pressure=80e3, diameter=0.3, limit=50e-9, particles=dust)
    >>> f"{chuck.bumps_above(50e-9):.1f} bumps from {chuck.lifting(50e-9) * 1e6:.1f} µm"
    '147.9 bumps from 4.8 µm'
    """

    surfaces: MaterialPair
    thickness: float = quantity("t", "m", "thickness of the plate", gt=0, usual=0.1)
    pressure: float = quantity("p", "Pa", "pressure that holds the plate", gt=0, usual=1e3)
    diameter: float | None = quantity(
        "D_w", "m", "diameter of the plate", default=None, gt=0, usual=10
    )
    limit: float | None = quantity("l", "m", "largest height that is allowed", default=None, gt=0)
    touching: float = quantity(
        "t_c", "1", "part of the plate that touches the chuck", default=1.0, gt=0, le=1
    )
    particles: tuple[Particles, ...] = ()
    law: AbstractParticleLaw = Series()

    def __post_init__(self) -> None:
        several = (self.particles,) if isinstance(self.particles, Particles) else self.particles
        object.__setattr__(self, "particles", items_of(several))
        Value.__post_init__(self)

    @property
    def area(self) -> float | None:
        """Area of the plate [m²]."""
        return None if self.diameter is None else math.pi / 4 * self.diameter**2

    def over(self, diameter: float, dust: Particles) -> Bump:
        """The bump over a particle of a kind of dust.

        Parameters
        ----------
        diameter : float
            Diameter x of the particle [m].
        dust : Particles
            What it is of.
        """
        return self._plate(self._law(dust)).over(diameter, dust.material)

    def breaks(self, bump: Bump, dust: Particles) -> bool:
        """Whether most particles of this kind would break under this bump."""
        one = self._law(dust).one(surfaces=self.surfaces, particle=dust.material)
        x = bump.height + bump.squeeze
        squeeze = bump.squeeze / x
        return breaks(one, dust.material, x=x, squeeze=squeeze, strength=dust.strength)

    def bump(self, height: float) -> Bump:
        """The plate lifted by a rigid point.

        Parameters
        ----------
        height : float
            Height h of the point [m].
        """
        return self._plate(self.law).bump(height)

    def lifting(self, height: float, dust: Particles | None = None) -> float:
        """Diameter of the particle that lifts the plate so high [m].

        Parameters
        ----------
        height : float
            Height h of the plate [m].
        dust : Particles, optional
            What the particle is of, by default the first kind.
        """
        from scipy.optimize import brentq

        kind = dust or self.particles[0]

        def excess(log_x: float) -> float:
            return math.log(self.over(math.exp(log_x), kind).height / height)

        low = math.log(height)  # no particle lifts by more than its diameter
        high = low + 1.0
        while excess(high) < 0:
            low, high = high, high + 1.0
        return math.exp(brentq(excess, low, high, xtol=1e-12))

    def bumps_above(self, height: float) -> float:
        """Mean number N of bumps that are higher, under the whole plate [1].

        Parameters
        ----------
        height : float
            Height l [m].
        """
        assert self.area is not None
        out = 0.0
        for dust in self.particles:
            above = 1 - float(dust.diameter.partial_moment(0, 0.0, self.lifting(height, dust)))
            out += self.touching * self.area * dust.areal_density * max(above, 0.0)
        return out

    def _law(self, dust: Particles) -> AbstractParticleLaw:
        return (dust.law or self.law).of_shape(dust.shape)  # type: ignore[attr-defined]

    def _plate(self, law: AbstractParticleLaw) -> PlateOverParticle:
        return PlateOverParticle(
            plate=self.surfaces.first,
            flat=self.surfaces.second,
            thickness=self.thickness,
            pressure=self.pressure,
            law=law,
        )
