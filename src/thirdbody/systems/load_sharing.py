r"""How rolling bodies share a radial load: Stribeck's formula and Sjövall's integral.

.. math:: Q_\psi = Q_{max}\left[1-\frac{1-\cos\psi}{2\varepsilon}\right]^n, \qquad
          F_r = Z\,Q_{max}\,J_r(\varepsilon), \qquad
          \varepsilon = \frac12\left(1-\frac{P_d}{2\delta_r}\right)

with the exponent n of load over approach, 3/2 for balls (Hertz) and 10/9 for rollers (Palmgren),
the diametral clearance P_d and the shift of the rings δ_r. Without clearance half the bodies carry,
ε = 1/2, and the most loaded one of Z balls has 4.37 F_r/Z (Stribeck).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..errors import InvalidValue, Mistake, Problem
from ..numerics.quadrature import gauss_legendre
from ..quantities.arguments import not_positive
from ..quantities.carried import takes_units
from ..quantities.record import TableRecord, column

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["BALLS", "ROLLERS", "RadialShare", "radial_integral", "share_radial_load"]


def __dir__() -> list[str]:
    return sorted(__all__)


BALLS, ROLLERS = 1.5, 10 / 9
"""Exponents of load over approach: point contacts (Hertz) and line contacts (Palmgren)."""
NODES = 48
WIDEST = 1e9
"""Where the load zone counts as endless: all bodies are preloaded alike."""


@takes_units
def radial_integral(eps: float, *, exponent: float = BALLS) -> float:
    r"""Sjövall's integral of a radial load.

    .. math:: J_r(\varepsilon) = \frac1{2\pi}\int_{-\psi_l}^{\psi_l}
              \left[1-\frac{1-\cos\psi}{2\varepsilon}\right]^n \cos\psi\,d\psi, \qquad
              \psi_l = \arccos(1-2\varepsilon)

    Parameters
    ----------
    eps : float
        Half the loaded arc's projection over the diameter of the track ε > 0 [1]: 0.5 without
        clearance, less with it, above 0.5 with preload, above 1 where all bodies carry.
    exponent : float, optional
        n of load over approach [1].

    Returns
    -------
    float
        J_r [1].

    Notes
    -----
    For n = 1 it is a closed form, (ψ_l − sin ψ_l cos ψ_l)/(4πε). Values agree with Harris's table
    within its rounding (``tests/systems/test_load_sharing.py``).

    References
    ----------
    Sjövall 1933, Teknisk Tidskrift, Mekanik 9, 97; Harris 2001, Rolling Bearing Analysis, 4th ed.,
    table 7.1. The load zone of zero clearance: Stribeck 1907, Trans. ASME 29, 420.

    Examples
    --------
    >>> from thirdbody.systems.load_sharing import radial_integral
    >>> round(radial_integral(0.5), 4), round(1 / radial_integral(0.5), 2)
    (0.2288, 4.37)
    """
    if problems := not_positive(eps=eps):
        raise InvalidValue(*problems)
    psi, w, level = _load_zone(eps)
    return float(np.sum(w * level**exponent * np.cos(psi)) / math.pi)


def _load_zone(eps: float) -> tuple[Array, Array, Array]:
    """Angles of one side of the load zone, their weights [rad], and approach over the largest."""
    t, w = gauss_legendre(NODES)
    if eps >= 1:
        # near 1 the load falls to nothing at the far side, as a power of the distance from there
        psi, w = math.pi * (1 - ((1 - t) / 2) ** 2), w * math.pi * (1 - t) / 2
        return psi, w, (1 - 1 / eps) + np.cos(psi / 2) ** 2 / eps
    last = 2 * math.asin(math.sqrt(eps))
    # ψ = ψ_l sin θ: powers of the approach end smoothly
    theta = 0.25 * math.pi * (1 + t)
    psi, w = last * np.sin(theta), w * 0.25 * math.pi * last * np.cos(theta)
    return psi, w, np.sin((last - psi) / 2) * np.sin((last + psi) / 2) / eps


@dataclass(frozen=True, eq=False, kw_only=True)
class RadialShare(TableRecord):
    """How the bodies of one row share a radial load; made by `share_radial_load`.

    Attributes
    ----------
    force : float
        Radial load F_r [N].
    largest : float
        Load of the most loaded body Q_max [N].
    eps : float
        Load zone ε [1]; infinite without load.
    shift : float
        Of the rings against each other δ_r [m].
    angles, loads : array (Z,)
        Places of the bodies from the direction of the load ψ [rad], one straight in it, and what
        each carries [N].
    exponent : float
        n of load over approach [1].
    """

    along = "angles"
    force: float = column("F_r", "N", "radial load")
    largest: float = column("Q_max", "N", "load of the most loaded body")
    eps: float = column("ε", "1", "load zone")
    shift: float = column("δ_r", "m", "shift of the rings against each other")
    angles: Array = column("ψ", "rad", "place of a body from the direction of the load")
    loads: Array = column("Q", "N", "load of a body")
    exponent: float = column("n", "1", "exponent of load over approach")

    @property
    def carrying(self) -> int:
        """Bodies that carry something."""
        return int(np.count_nonzero(self.loads))

    @property
    def balance(self) -> float:
        """Σ Q cos ψ over F_r [1]: 1 but for the places of few bodies."""
        return float(self.loads @ np.cos(self.angles) / self.force)

    @takes_units
    def over_a_turn(self, quantity: Callable[[Array], Array]) -> float:
        r"""What a body has of a quantity on average over a turn of the cage.

        .. math:: \frac1\pi\int_0^{\psi_l} q(Q_\psi)\,d\psi

        Parameters
        ----------
        quantity : callable
            q of the loads of bodies [N], an array; 0 without load.

        Notes
        -----
        Exact to 1e-9 for powers of the load.
        """
        _, w, level = _load_zone(self.eps)
        return float(np.sum(w * quantity(self.largest * level**self.exponent)) / math.pi)


@takes_units
def share_radial_load(
    force: float,
    *,
    bodies: float,
    stiffness: float,
    clearance: float = 0.0,
    exponent: float = BALLS,
) -> RadialShare:
    r"""How Z rolling bodies share a radial load, by Sjövall's integral.

    .. math:: F_r = Z K_n\left(\delta_r-\tfrac12P_d\right)^n J_r(\varepsilon)

    Parameters
    ----------
    force : float
        F_r [N].
    bodies : float
        Z [1].
    stiffness : float
        K_n of a body between both rings, load over approach to the n-th power [N/m^n].
    clearance : float, optional
        Diametral internal clearance P_d [m]; below 0 is preload.
    exponent : float, optional
        n [1].

    Returns
    -------
    RadialShare

    Notes
    -----
    The integral stands for bodies everywhere around; with one straight in the line of the load,
    the sum over the bodies differs from the load by a few per cent (``balance``). Where clearance
    leaves so few that one would carry more than the whole load, those at their places balance it
    instead. In between, with one or two that carry, the largest load is up to a tenth too small,
    and what bodies sweep on average over a turn up to a third.

    References
    ----------
    Harris 2001, Rolling Bearing Analysis, 4th ed., ch. 7.

    Examples
    --------
    >>> from thirdbody.systems.load_sharing import share_radial_load
    >>> found = share_radial_load(1000.0, bodies=9, stiffness=1e10)
    >>> round(found.largest * 9 / 1000, 2), found.carrying
    (4.37, 5)
    """
    from scipy.optimize import brentq

    problems = not_positive(force=force, bodies=bodies, stiffness=stiffness)
    if not math.isfinite(clearance):
        problems.append(
            Problem("clearance", "must be a finite number [m]", repr(clearance), code=Mistake.RANGE)
        )
    if problems:
        raise InvalidValue(*problems)
    half = 0.5 * clearance

    def zone(pressed: float) -> float:
        """ε where the most loaded body gives way by so much."""
        shift = pressed + half
        return 0.5 * pressed / shift if shift > 0.5 * pressed / WIDEST else WIDEST

    def total_load(pressed: float) -> float:
        eps = zone(pressed)
        integral = radial_integral(eps, exponent=exponent) if eps < WIDEST else 0.0
        return bodies * stiffness * pressed**exponent * integral

    # J_r is at most 0.25 or so, and 1/2 for a single body: start where it surely is too little
    low = max(-half, (force / (bodies * stiffness)) ** (1 / exponent))
    high = 2 * low
    while total_load(high) < force:
        high *= 2
    angles = 2 * math.pi * np.arange(round(bodies)) / round(bodies)
    angles = np.where(angles > math.pi + 1e-12, angles - 2 * math.pi, angles)

    def loads(pressed: float) -> Array:
        level = np.maximum(1 - (1 - np.cos(angles)) / (2 * zone(pressed)), 0.0)
        return stiffness * (pressed * level) ** exponent

    pressed = float(brentq(lambda x: total_load(x) - force, low, high, xtol=1e-18, rtol=1e-13))
    if half >= 0 and stiffness * pressed**exponent > force:
        upper, lower = pressed, 1e-3 * pressed
        pressed = float(
            brentq(
                lambda x: loads(x) @ np.cos(angles) - force, lower, upper, xtol=1e-18, rtol=1e-13
            )
        )
    return RadialShare(
        force=float(force),
        largest=stiffness * pressed**exponent,
        eps=zone(pressed),
        shift=pressed + half,
        angles=angles,
        loads=loads(pressed),
        exponent=exponent,
    )
