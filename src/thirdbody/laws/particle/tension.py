r"""The largest tension inside a particle that two caps press.

With s = 2a/x of a contact, :math:`c=\sqrt{1-s^2}` and K = (7+2ν)/(7+5ν), the tension across the
axis at the centre of a sphere under uniform pressure on its caps is

.. math:: T_c = \frac{F}{x^2}\frac4\pi\left[\tfrac54 Kc - \frac1{1+c}\right],

that of its equator a sum over harmonics, and G the larger of both over T_c of small caps.
"""

from __future__ import annotations

import itertools
import math
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...errors import InvalidValue
from ...numerics.chebyshev import PiecewiseChebyshev
from ...populations.strength import WeibullStrength

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...populations.materials import Material
    from ..base import OneParticle, Squeezed

    Array = NDArray[np.float64]

__all__ = ["Tension", "at_centre", "at_equator", "breaks", "confined_tension", "tension"]

HARMONICS = 6000
LOWEST = 1e-9
"""Squeeze below which the tension is extended as a power of the squeeze."""
STEPS = 48
"""Squeezes between two kinks at which a falling tension is looked for."""
BESIDE = 1e-13
"""Part of a kink by which it is kept away from: at the kink itself a law that jumps has either of
its two values, as rounding has it, and the load of two sides in series any between."""


def at_centre(s: Array, nu: float) -> Array:
    """T_c x²/F at caps of radius s x/2."""
    c = np.sqrt(np.maximum(1 - np.square(s), 0.0))
    return 4 / math.pi * (1.25 * _K(nu) * c - 1 / (1 + c))


def _K(nu: float) -> float:
    return (7 + 2 * nu) / (7 + 5 * nu)


def at_equator(s: Array, nu: float) -> Array:
    """T_e x²/F, the hoop tension at the equator, at caps of radius s x/2."""
    return _equator(nu)(np.square(np.clip(s, 0.0, 1.0)).ravel())[:, 0].reshape(np.shape(s))


@lru_cache(maxsize=32)
def _equator(nu: float) -> PiecewiseChebyshev:
    """T_e x²/F against s²."""
    edges = np.array([0.0, 0.5, 0.9, 1.0])
    return PiecewiseChebyshev(
        lambda q: _harmonics(q, nu)[:, None], edges, tolerance=1e-9, max_depth=4
    )


def _harmonics(q: Array, nu: float) -> Array:
    """The sum over even harmonics at s² = q > 0, its end let down gently."""
    c = np.sqrt(1 - q)
    nu = min(nu, 0.5 - 1e-9)  # its parts are infinite for what cannot be compressed, not their sum
    lam = 2 * nu / (1 - 2 * nu)
    total = (1 - c) * (1 - 2 * nu)
    before, now = np.ones_like(c), c  # P_(l−1) and P_l at c, l = 1
    at_zero = 1.0  # P_l(0)
    for l in range(1, HARMONICS):  # noqa: E741
        after = ((2 * l + 1) * c * now - l * before) / (l + 1)
        if l % 2 == 0:
            at_zero *= -(l - 1) / l
            gently = math.exp(-36 * (l / HARMONICS) ** 8)
            total = total + gently * (before - after) * (_hoop(l, nu, lam) - 2 * nu) * at_zero
        before, now = now, after
    return -4 / (math.pi * q) * total


def _hoop(l: int, nu: float, lam: float) -> float:  # noqa: E741
    """t_l: hoop stress at the surface, less what depends on angle, over the pressure of l."""
    a_1, b_1, a_2, b_2 = (l + 1) * (l - 2 + 4 * nu), float(l), l + 5 - 4 * nu, 1.0

    def S(u: float, v: float, n: int) -> float:
        return lam * ((n + 2) * u - l * (l + 1) * v) + 2 * n * u

    def Q(u: float, v: float, n: int) -> float:
        return (n - 1) * v + u

    (s_1, s_2), (q_1, q_2) = ((f(a_1, a_2, l + 1), f(b_1, b_2, l - 1)) for f in (S, Q))
    determinant = s_1 * q_2 - s_2 * q_1
    A, B = q_2 / determinant, -q_1 / determinant
    U, V = A * a_1 + B * b_1, A * a_2 + B * b_2
    rising = (l + 1) * A * a_1 + (l - 1) * B * b_1
    return lam * (rising + 2 * U - l * (l + 1) * V) + 2 * U


def confined_tension(s: Array, nu: float) -> Array:
    """G(s): the largest tension over that of small caps under the same load, 0 under pressure."""
    small = 4 / math.pi * (1.25 * _K(nu) - 0.5)
    larger = np.maximum(at_centre(s, nu), at_equator(s, nu))
    return np.maximum(larger, 0.0) / small


@lru_cache(maxsize=32)
def _bends(nu: float) -> tuple[float, ...]:
    """Values of s at which G changes its formula: T_c = T_e, and the zero of G."""
    from scipy.optimize import brentq

    s = np.linspace(1e-3, 1 - 1e-6, 1000)
    bends: list[float] = []
    for f in (
        lambda s: at_centre(s, nu) - at_equator(s, nu),
        lambda s: np.maximum(at_centre(s, nu), at_equator(s, nu)),
    ):
        values = f(s)
        for i in np.flatnonzero(np.sign(values[1:]) != np.sign(values[:-1])):
            bends.append(float(brentq(lambda x, f=f: float(f(np.array([x]))[0]), s[i], s[i + 1])))
    return tuple(sorted(bends))


class Held(NamedTuple):
    """Range of squeeze in which the tension stays below its maximum so far."""

    begin: float
    end: float


class Tension:
    r"""Largest tension that one particle has met, as a function of its squeeze ε.

    .. math:: \sigma_t = \frac{f}{x^2}\,\tfrac12[G(s_1)+G(s_2)], \qquad
              \hat\sigma(\varepsilon) = \max_{\varepsilon'\le\varepsilon}\sigma_t(\varepsilon')

    Attributes
    ----------
    kinks : array
        Increasing ε at which a formula changes; constant beyond the last.
    greatest : float
        Of all squeezes [Pa].
    """

    def __init__(self, particle: OneParticle, nu: float, confinement: str):
        self.particle, self.nu, self.confinement = particle, nu, confinement
        of_particle = np.asarray(particle.kinks, dtype=float)
        kinks = {*of_particle.tolist(), *self._bends_of(of_particle)}
        self.held: list[Held] = []
        edges = np.array(sorted(kinks))
        self._find_held(edges)
        kinks |= {eps for held in self.held for eps in held if np.isfinite(eps)}
        end = self.held[-1].begin if self.held and np.isinf(self.held[-1].end) else np.inf
        self.kinks = np.array(sorted(eps for eps in kinks if eps <= end))
        self.greatest = float(self.greatest_so_far(self.kinks[-1:] * (1 - BESIDE))[0])

    def _sides(self, eps: Array) -> tuple[Array, Array]:
        areas = self.particle.at(eps).areas
        one, two = (np.minimum(2 * np.sqrt(area / math.pi), 1.0) for area in areas)
        return one, two

    def _bends_of(self, kinks: Array) -> list[float]:
        """Squeezes at which a cap reaches a bend of G."""
        from scipy.optimize import brentq

        if self.confinement == "none":
            return []
        out = []
        for side in (0, 1):
            for s in _bends(self.nu):

                def excess(eps: float, side: int = side, s: float = s) -> float:
                    return float(self._sides(np.array([eps]))[side][0]) - s

                if excess(float(kinks[-1])) > 0:
                    out.append(float(brentq(excess, LOWEST, float(kinks[-1]), xtol=1e-15)))
        return out

    def now(self, eps: Array, squeezed: Squeezed | None = None) -> Array:
        """σ_t at ε > 0 [Pa]."""
        state = self.particle.at(eps) if squeezed is None else squeezed
        if self.confinement == "none":
            return state.load
        s = [np.minimum(2 * np.sqrt(area / math.pi), 1.0) for area in state.areas]
        return (
            state.load * 0.5 * (confined_tension(s[0], self.nu) + confined_tension(s[1], self.nu))
        )

    def _find_held(self, edges: Array) -> None:
        from scipy.optimize import brentq, minimize_scalar

        starts = np.concatenate([[1e-2 * edges[0]], edges])
        # closer and closer to each kink, in front of which the tension may fall a little
        close = np.geomspace(1e-6, 0.3, STEPS)[::-1]
        parts = [
            np.union1d(np.geomspace(a * (1 + BESIDE), b * (1 - BESIDE), STEPS), b - (b - a) * close)
            for a, b in itertools.pairwise(starts)
        ]
        grid = np.concatenate([*parts, edges[-1:] * (1 + BESIDE)])
        values = self.now(grid)
        most = np.maximum.accumulate(values)
        below = values < most * (1 - 1e-12)
        one = lambda eps: float(self.now(np.array([eps]))[0])  # noqa: E731
        i = 0
        while i < len(grid):
            if not below[i]:
                i += 1
                continue
            top = minimize_scalar(
                lambda eps: -one(eps),
                bounds=(grid[max(i - 2, 0)], grid[i]),
                method="bounded",
                options={"xatol": 1e-12},
            )
            begin, peak = float(top.x), -float(top.fun)
            if (highest := float(most[i])) >= peak:
                begin, peak = float(grid[i - 1]), highest
            after = np.flatnonzero(~below[i:])
            if not len(after):
                self.held.append(Held(begin, math.inf))
                return
            j = i + int(after[0])
            a, b = grid[j - 1], grid[j]
            end = brentq(lambda e, top=peak: one(e) - top, a, b) if one(b) > peak > one(a) else b
            self.held.append(Held(begin, float(end)))
            i = j

    # ------------------------------------------------------------------ running maximum
    def greatest_so_far(self, eps: Array) -> Array:
        """σ̂ at ε > 0 [Pa], from its definition."""
        eps = np.array(eps, dtype=float)
        for held in self.held:
            eps[(eps > held.begin) & (eps < held.end)] = held.begin
        return self.now(eps)

    @cached_property
    def table(self) -> PiecewiseChebyshev:
        """ln σ̂ against ln ε up to the last kink."""
        v = np.log(np.append(LOWEST, self.kinks[self.kinks > LOWEST]))

        def logarithm(x: Array) -> Array:
            return np.log(self.greatest_so_far(np.exp(x)))[:, None]

        return PiecewiseChebyshev(logarithm, v, tolerance=1e-13, max_depth=10)

    def __call__(self, eps: Array) -> Array:
        """σ̂ at ε (N,) [Pa]; 0 without a squeeze."""
        with np.errstate(divide="ignore"):
            v = np.log(np.maximum(eps, 0.0))
        low, high = self.table.edges[[0, -1]]
        out = np.exp(self.table(np.clip(v, low, high))[:, 0])
        under = v < low
        if np.any(under):
            slope = self._slope_at_lowest
            with np.errstate(invalid="ignore"):
                out[under] *= np.exp(slope * (v[under] - low))
        return out

    @cached_property
    def _slope_at_lowest(self) -> float:
        low = self.table.edges[:1]
        return float(self.table.derivatives(low, (0,))[0, 0, 1])


@lru_cache(maxsize=256)
def tension(particle: OneParticle, nu: float, confinement: str) -> Tension:
    """The cached tension inside one particle."""
    return Tension(particle, nu, confinement)


def breaks(
    particle: OneParticle,
    material: Material,
    *,
    x: float,
    squeeze: float,
    strength: WeibullStrength | None = None,
) -> bool:
    """Whether most particles of this diameter [m] have broken at a squeeze δ/x on their way there.

    Without a strength of their own they have that of their material; of one that has none none has.
    """
    try:
        strength = strength or WeibullStrength.of(material)
    except InvalidValue:
        return False
    met = tension(particle, material.nu, strength.confinement).greatest_so_far(np.array([squeeze]))
    return bool(x > strength.least(material) and met[0] > strength.of_size(x))
