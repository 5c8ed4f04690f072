"""A half of a particle that is softer than its surface: squashed, its volume kept."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.say import value_of
from ..asperity.jg import JG
from .one_particle import Side

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..base import AbstractAsperityLaw
    from .one_particle import Array

__all__ = ["Squash", "widest_disc"]

FULL, COLUMN = 2.84, 1.0
"""Hardness over yield strength of a small contact, and of a column as wide as the sphere."""
JG_RANGE = (8.0, 150.0)
"""E*/H within which the area of Jackson and Green does not fill the volume too early."""
SOLID = (1e-6, 1e9)
"""E*/H of what counts as a solid, and how many times as hard the surfaces may be."""
THINNEST = 1e-12
"""Height left over the size, below which no disc is followed: digits of the squash end there."""


def widest_disc(H_particle: float, H_surface: float, *, friction_factor: float = 0.2) -> float:
    r"""Diameter over that of the sphere at which a flattened particle sinks into the surface [1].

    .. math:: \frac{p}{H_p} = \frac{1}{2.84}\left[1+\frac{2m_f}{3\sqrt3}\,\frac{a}{x\,t}\right]
              = \frac{H_s}{H_p}, \qquad \frac ax = \frac{1}{\sqrt{6t}}, \qquad
              \frac Dx = \sqrt{\frac{2}{3t}} \ge 1

    A disc of the sphere's volume, as high as t x: the yield strength of a column, and the rise of
    the mean pressure by friction on its faces, as in `thirdbody.particle.Series`, up to the
    hardness of the surface. From there on the disc sinks in and grows no wider.

    Parameters
    ----------
    H_particle, H_surface : float
        Hardness of the particle and of the surface [Pa].
    friction_factor : float, optional
        Shear stress on the faces over the shear strength, m_f [1].

    Returns
    -------
    float
        D/x [1]; 1 where the pressure on a column is above the hardness of the surface.

    Examples
    --------
    >>> round(widest_disc(2e9, 2e9), 2), widest_disc(10e9, 2e9)
    (3.17, 1.0)
    """
    rise = FULL * H_surface / H_particle - COLUMN
    if not rise > 0:
        return 1.0
    t = (2 * friction_factor / (3 * math.sqrt(3) * math.sqrt(6) * rise)) ** (2 / 3)
    return max(math.sqrt(2 / (3 * t)), 1.0)


@dataclass(frozen=True)
class Squash:
    """How one half of a soft particle is squashed.

    Attributes
    ----------
    surface : float
        Hardness of the surface [Pa], at which the disc sinks in.
    friction_factor : float
        Shear stress on the faces over the shear strength [1].
    onset : {"hermite", "jg"}
        What the load sets in with.
    """

    surface: float
    friction_factor: float
    onset: str

    def side(
        self, law: AbstractAsperityLaw, E_star: float, H: float, nu: float, R: float
    ) -> Side | None:
        """The contact of this half; None where the law knows no yielding."""
        low, high = SOLID
        if not (low <= E_star / H <= high and self.surface / H <= high):
            raise InvalidValue(
                f"a squashed particle of E* = {value_of(E_star, 'Pa', 3)} and H = "
                f"{value_of(H, 'Pa', 3)} between surfaces "
                f"of H = {value_of(float(self.surface), 'Pa', 3)} is beyond the law: E*/H must be "
                "from "
                f"{low:g} to "
                f"{high:g}, and the surfaces at most {high:g} times as hard; check the units of E "
                "and H, or use soft = 'sphere'",
                code=Mistake.BEYOND,
            )
        if self.onset == "jg":
            low, high = JG_RANGE
            if not low <= E_star / H <= high:
                raise InvalidValue(
                    Problem(
                        "onset",
                        f"holds for E*/H from {low:g} to {high:g} of a squashed particle, and here "
                        f"it is {E_star / H:.3g} (E* = {value_of(E_star, 'Pa', 3)}, H = "
                        f"{value_of(H, 'Pa', 3)}): its contact area would grow too fast",
                        "'jg'",
                        hint="use onset = 'hermite'",
                        code=Mistake.BEYOND,
                    )
                )
            return _OfJacksonGreen(self, JG(), E_star, H, nu, R)
        law_with_parameters = law.bound(R=R, E_star=E_star, H=H, nu=nu)
        if law_with_parameters.branches[-1].regime != "plastic":
            return None
        return _OfLaw(self, law, E_star, H, nu, R)


class _SquashedSide(Side):
    """Area and mean pressure of a half whose height left is t = 1 − 2δ over x.

    The volume of the half bounds the area, A t ≤ π/6; the load ends where the mean pressure is
    the hardness of the surface.
    """

    spreads = True

    def __init__(
        self, squash: Squash, law: AbstractAsperityLaw, E_star: float, H: float, nu: float, R: float
    ):
        self.law, self.H, self.R = law.bound(R=R, E_star=E_star, H=H, nu=nu), H, R
        self.delta_1 = self.law.yield_interference(R=R, E_star=E_star, H=H)
        self.unit = R * math.pi * self.delta_1 * H
        self.plateau = True
        self.full = 1 / (6 * R * self.delta_1)  # reduced area of a pancake over 1 − τ
        # mean friction hill over S_y, times a/t
        self.hill = 2 * squash.friction_factor / (3 * math.sqrt(3))
        self.end = 0.5 / self.delta_1
        self.cap = self._cap()
        """Where the volume bounds the area."""
        wide = self._where(self._spread, 0.0, self._tau(1 - 1e-6))
        if math.isclose(wide, float(self.cap), rel_tol=1e-9):
            wide = float(self.cap)
        begin = max(wide, float(self.cap))
        self.end = self._sinks(squash.surface, begin)
        turns = [y for y in (*self.law.breakpoints, float(self.cap), wide) if y < self.end]
        turns += self._more_turns()
        # the area grows like 1/t: its kinks lie so close that series resolve it
        t, last = self._height_left(begin), self._height_left(self.end)
        while t > GRADING * last:
            t /= GRADING
            turns.append(self._tau(1 - t))
        self.kinks = np.unique([*turns, self.end])
        self.limit = self.unit * self.reduced_force(self.kinks[-1:])

    def _height_left(self, y: Any) -> Any:
        """Height t left at y, over x."""
        return 1 - 2 * self.delta_1 * y

    def _tau(self, tau: float) -> float:
        """y at a squash τ."""
        return float(tau / (2 * self.delta_1))

    def _radius(self, a: Array) -> Array:
        """Contact radius over x of a reduced area."""
        return np.sqrt(self.R * self.delta_1 * a)

    def _spread(self, y: float) -> float:
        """By how much the contact is wider than the sphere."""
        return 2 * float(self._radius(self.reduced_area(np.array(y)))) - 1

    def _sinks(self, surface: float, y: float) -> float:
        """Where the mean pressure is the hardness of the surface, beyond y."""

        def excess(log_t: float) -> float:
            y = np.array(self._tau(-math.expm1(log_t)))
            return float(self.pressure(y) * self.H) - surface

        high = low = math.log(self._height_left(y))
        while excess(low) < 0:
            high, low = low, low - math.log(2)
            if low < math.log(THINNEST):
                raise InvalidValue(
                    f"a squashed particle of H = {value_of(float(self.H), 'Pa', 3)} does not "
                    "reach the "
                    "hardness of "
                    f"the surfaces, {value_of(float(surface), 'Pa', 3)}, before it is squashed to "
                    f"{THINNEST:g} of its "
                    "size; check H and friction_factor, or use soft = 'sphere'",
                    code=Mistake.BEYOND,
                )
        if low == high:
            return y
        return self._tau(-math.expm1(self._where(excess, low, high)))

    @staticmethod
    def _where(function: Callable[[float], float], low: float, high: float) -> float:
        from scipy.optimize import brentq

        return float(brentq(function, low, high, xtol=1e-16, rtol=1e-15))

    def _more_turns(self) -> list[float]:
        """Further y at which a formula changes."""
        return []

    @abstractmethod
    def pressure(self, y: Array) -> Array:
        """Mean pressure over H."""

    def reduced_force(self, y: Array) -> Array:
        y = np.minimum(y, self.end)
        return self.reduced_area(y) * self.pressure(y)

    def _hill(self, y: Array, radius: Array) -> Array:
        """Rise of the mean pressure by friction on the faces, over the yield strength."""
        return self.hill * radius / self._height_left(y)


class _OfLaw(_SquashedSide):
    """From the area and the pressure of a law of one contact."""

    def reduced_area(self, y: Array) -> Array:
        y = np.minimum(y, self.end)
        return np.minimum(self.law.reduced("area", y), self.full) / self._height_left(y)

    def pressure(self, y: Array) -> Array:
        force, area = (self.law.reduced(name, y) for name in ("force", "area"))
        p = np.divide(force, area, out=np.zeros_like(force), where=area > 0)
        radius = self._radius(self.reduced_area(y))
        fall = (FULL - COLUMN) / 2 * (1 - np.cos(math.pi * np.minimum(2 * radius, 1.0)))
        return p * (1 + (self._hill(y, radius) - fall) / FULL)


class _OfJacksonGreen(_SquashedSide):
    """From the area and the load of Jackson and Green, with a hardness that ends at S_y."""

    law: JG

    def _cap(self) -> Array:
        """Where the area first reaches what the volume allows."""

        def excess(y: float) -> float:
            return float(self.law.reduced("area", np.array(y))) * self._height_left(y) - self.full

        grid = np.linspace(0.0, self._tau(0.7), 701)
        first = int(np.argmax([excess(y) > 0 for y in grid]))
        if first == 0:
            raise InvalidValue(
                Problem(
                    "onset",
                    f": with ν = {self.law.nu:g} and E*/H so, the contact area never fills the "
                    "volume of a squashed particle",
                    "'jg'",
                    hint="use onset = 'hermite'",
                    code=Mistake.BEYOND,
                )
            )
        return np.array(self._where(excess, grid[first - 1], grid[first]))

    def reduced_area(self, y: Array) -> Array:
        y = np.minimum(y, self.end)
        pancake = self.full / self._height_left(y)
        return np.where(y < self.cap, self.law.reduced("area", y), pancake)

    def _bare(self, y: Array) -> Array:
        """Mean pressure over S_y without friction and without the column's least."""
        C, _, _ = self.law._constants()
        area = self.reduced_area(y)
        wide = np.minimum(2 * self._radius(area), 1.0)
        hardness = FULL - (FULL - COLUMN) / 2 * (1 - np.cos(math.pi * wide))
        first = np.exp(-(y ** (5 / 12)) / 4) * y**1.5
        second = 4 / C * hardness * -np.expm1(-(y ** (5 / 9)) / 25) * y
        return 2 / 3 * C * (first + second) / area

    def _more_turns(self) -> list[float]:
        first = self.law.breakpoints[0]

        def excess_pressure(y: float) -> float:
            return float(self._bare(np.array(y))) - COLUMN

        grid = np.linspace(first, self.end, 1001)
        sign = np.sign(self._bare(grid) - COLUMN)
        return [
            self._where(excess_pressure, grid[i], grid[i + 1])
            for i in np.flatnonzero(sign[1:] * sign[:-1] < 0)
        ]

    def pressure(self, y: Array) -> Array:
        C, _, _ = self.law._constants()
        y = np.asarray(y, dtype=float)
        safe = np.maximum(y, 1e-300)
        elastic = 2 / 3 * C * np.sqrt(safe)
        p = np.where(y < self.law.breakpoints[0], elastic, np.maximum(self._bare(safe), COLUMN))
        p = p + self._hill(y, self._radius(self.reduced_area(y)))
        return np.where(y > 0, p, 0.0) / self.law.hardness_ratio


GRADING = 4.0
"""Ratio of the heights left at neighbouring kinks of the pancake."""
