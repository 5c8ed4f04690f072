r"""Quadrature over the squeeze of a particle, for many materials at once.

A particle is two contacts in series. Taken by the indentation of its weaker side it needs no
equation solved: that indentation gives the load, the load gives the indentation of the other
side, and both together the squeeze ε. Sums over particles are then sums over these nodes,

.. math:: \int \hat q(\varepsilon)\,w(\varepsilon)\,d\varepsilon
          = \sum_j \hat q_j\,w(\varepsilon_j)\,\Delta\varepsilon_j ,

with the weights Δε from the derivative of ε along the nodes of a panel.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache, lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...numerics import PiecewiseChebyshev, gauss_legendre
from ..base import REGIMES, AbstractAsperityLaw
from .series import COLUMNS, Side

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["InverseLaw", "SqueezeRule", "squeeze_rule"]

NODES = 16
"""of a panel"""
RATIO = 2.0
"""Largest ratio of the roots of the indentations at the ends of a panel."""
SEAT_WIDTHS = 1.25
"""Widest panel in widths of the seat."""


class _Function:
    """A piecewise Chebyshev function of one column, evaluated by the compiled engine."""

    def __init__(self, function: PiecewiseChebyshev):
        from ...kernels import LOAD, PANEL, TERMS

        self.series = np.zeros((len(function.half), PANEL + 1, TERMS))
        self.series[:, LOAD] = function.coefficients[:, :, 0]
        self.series[:, PANEL, 0] = function.edges[:-1]
        self.series[:, PANEL, 1] = function.half

    def __call__(self, x: Array) -> Array:
        from ...kernels import evaluate

        out = np.empty_like(x)
        evaluate(self.series, x, out)
        return out


class InverseLaw:
    """Reduced indentation y of a law from its load f(y), and from its mean pressure f/a.

    Raises
    ------
    TypeError
        A law that jumps, or does not begin with Hertz' contact, or whose mean pressure does not
        rise up to its last breakpoint and stay constant beyond.
    """

    def __init__(self, law: AbstractAsperityLaw):
        self.law = law
        points = law.breakpoints or (1.0,)
        self.first, self.last = points[0], points[-1]
        self.elastic = not law.breakpoints
        ends = np.array([self.first, self.last])
        self.forces = law.reduced("force", ends)
        self.pressures = self.forces / law.reduced("area", ends)
        self.bends = np.zeros(0)
        """y at the ends of the panels that resolve y of f."""
        self._check(np.array(points))
        if self.first < self.last:
            log_y = PiecewiseChebyshev(
                lambda f: np.log(self._solve("force", np.exp(f)))[:, None],
                np.log(law.reduced("force", np.array(points))),
            )
            self.bends = np.exp(log_y(log_y.edges[1:-1])[:, 0])
            self._force = _Function(log_y)
            # near the last breakpoint the pressure may approach its limit like a square
            rise = np.sqrt(self.pressures[1] - self._pressure_at(np.array(points)))[::-1]
            self._rise = _Function(
                PiecewiseChebyshev(
                    lambda r: self._solve("pressure", self.pressures[1] - r * r)[:, None], rise
                )
            )

    def _pressure_at(self, y: Array) -> Array:
        return self.law.reduced("force", y) / self.law.reduced("area", y)

    def _check(self, points: Array) -> None:
        law = self.law
        below = self.first * np.geomspace(1e-9, 1 - 1e-9, 7)
        hertz = self.forces[0] * (below / self.first) ** 1.5
        good = law.start == 0 and np.allclose(law.reduced("force", below), hertz, rtol=1e-9)
        if not self.elastic:
            for y in points:
                below, above = law.reduced("force", np.array([y * (1 - 1e-12), y]))
                good &= bool(np.isclose(below, above, rtol=1e-9))
            rising = self._pressure_at(np.linspace(self.first, self.last, 400))
            good &= self.first == self.last or bool(np.all(np.diff(rising) > 0))
            beyond = self._pressure_at(self.last * np.array([2.0, 10.0, 1e4]))
            good &= np.allclose(beyond, self.pressures[1], rtol=1e-12)
        if not good:
            raise TypeError(f"{law.name} is not a law whose load tells its indentation")

    def _solve(self, quantity: str, value: Array) -> Array:
        from scipy.optimize.elementwise import find_root

        def excess(y: Array, value: Array) -> Array:
            found = self.law.reduced("force", y) if quantity == "force" else self._pressure_at(y)
            return found - value

        ends = np.full_like(value, self.first), np.full_like(value, self.last)
        tolerances = {"xatol": 0.0, "xrtol": 4e-16, "fatol": 0.0, "frtol": 0.0}
        root = find_root(excess, ends, args=(value,), tolerances=tolerances)
        return np.clip(root.x, self.first, self.last)

    def of_force(self, f: Array) -> Array:
        """y at which the law carries f."""
        if self.elastic:
            return self.first * (f / self.forces[0]) ** (2 / 3)
        y = f * (self.last / self.forces[1])
        below = f <= self.forces[0]
        y[below] = self.first * (f[below] / self.forces[0]) ** (2 / 3)
        between = ~below & (f < self.forces[1])
        if np.any(between):
            y[between] = np.exp(self._force(np.log(f[between])))
        return y

    def of_pressure(self, p: Array) -> Array:
        """y ≤ the last breakpoint at which the mean pressure is p."""
        y = self.first * (p / self.pressures[0]) ** 2
        y[p >= self.pressures[1]] = self.last
        between = (p > self.pressures[0]) & (p < self.pressures[1])
        if np.any(between):
            y[between] = self._rise(np.sqrt(self.pressures[1] - p[between]))
        return y

    def on(self, side: Side, f: Array) -> Array:
        """y at which a side of a particle carries f times its unit, below its limit."""
        y = self.of_force(f)
        over = y > side.cap
        if np.any(over):
            if not side.plateau:
                return np.minimum(y, side.cap)
            full = np.broadcast_to(side.full, f.shape)[over]
            cap = np.broadcast_to(side.cap, f.shape)[over]
            y[over] = np.maximum(self.of_pressure(f[over] / full), cap)
        return y


@lru_cache(maxsize=64)
def inverse_law(law: AbstractAsperityLaw) -> InverseLaw:
    """The cached inverse of a bound law."""
    return InverseLaw(law)


class SqueezeRule(NamedTuple):
    """Nodes of M materials: lengths in the size of the particle."""

    gaps: Array
    """(M, n): 1 − ε, increasing"""
    weighted: Array
    """(M, n, 7): weight times every column"""
    bottom: Array
    """(M,): gap below which nothing changes"""
    floor: Array
    """(M, 7): the columns there"""


@cache
def _derivative(n: int) -> Array:
    """Matrix that takes values at Gauss nodes on [−1, 1] to weight times their derivative."""
    x, weight = gauss_legendre(n)
    gaps = x[:, None] - x
    np.fill_diagonal(gaps, 1.0)
    barycentric = 1 / gaps.prod(axis=1)
    D = barycentric / barycentric[:, None] / gaps
    np.fill_diagonal(D, 0.0)
    np.fill_diagonal(D, -D.sum(axis=1))
    return weight[:, None] * D


def squeeze_rule(
    law: AbstractAsperityLaw,
    first: tuple[Array, Array],
    second: tuple[Array, Array],
    *,
    tip_radius: float,
    widths: Array,
    split_areas: bool,
) -> SqueezeRule:
    """Nodes over the squeeze of particles of unit size between two surfaces.

    Parameters
    ----------
    law : AbstractAsperityLaw
        Bound, the same for all.
    first, second : (array (M, 1), array (M, 1))
        E* and softer hardness [Pa] of the contact with surfaces 1 and 2.
    tip_radius : float
        Over the size.
    widths : array (M, 1)
        Length, in the size, that a panel has to resolve.
    split_areas : bool
        Split also where the two contact areas change order.
    """
    inverse = inverse_law(law)
    one, two = (Side(law, E, H, 0.0, tip_radius) for E, H in (first, second))
    weaker = one.limit <= two.limit
    A, B = Side.chosen(weaker, one, two), Side.chosen(weaker, two, one)

    def both(y: Array) -> tuple[Array, Array]:
        """Load over A.unit, and y on the stronger side, at y on the weaker."""
        f = A.reduced_force(y)
        return f, inverse.on(B, np.minimum(A.unit / B.unit * f, B.limit / B.unit))

    def squeeze(y: Array, yB: Array) -> Array:
        return A.delta_1 * y + B.delta_1 * yB

    def more_area(y: Array) -> tuple[Array, Array]:
        """Contact areas of the weaker and the stronger side, over the same unit."""
        return A.delta_1 * A.reduced_area(y), B.delta_1 * B.reduced_area(both(y)[1])

    top = A.kinks[:, -1:]
    kinks = A.kinks
    if not np.all((A.delta_1 == B.delta_1) & (A.unit == B.unit)):
        # where the stronger side changes its formula, or its inverse bends sharply
        bends = np.broadcast_to(inverse.bends, (len(kinks), len(inverse.bends)))
        points = np.concatenate([B.kinks, np.minimum(bends, B.kinks[:, -1:])], axis=1)
        met = np.minimum(B.unit / A.unit * B.reduced_force(points), A.limit / A.unit)
        kinks = np.concatenate([kinks, np.minimum(inverse.on(A, met), top)], axis=1)
        if split_areas:
            crossings = _crossings(np.sort(kinks, axis=1), more_area)
            kinks = np.concatenate([kinks, np.minimum(crossings, top)], axis=1)
    kinks = np.sort(kinks, axis=1)
    edges = np.concatenate([np.zeros_like(top), kinks], axis=1)
    edges = _panels(np.sqrt(edges), squeeze(edges, both(edges)[1]) / widths)
    low, high = edges[:, :-1, None], edges[:, 1:, None]
    v = 0.5 * (low + high) + 0.5 * (high - low) * gauss_legendre(NODES)[0]
    y = np.concatenate([(v * v).reshape(len(v), -1), top], axis=1)
    f, yB = both(y)
    eps, last = np.split(squeeze(y, yB), [-1], axis=1)
    unit = tip_radius * math.pi
    q = A.unit * f
    aA, aB = unit * A.delta_1 * A.reduced_area(y), unit * B.delta_1 * B.reduced_area(yB)
    a1, a2 = np.where(weaker, aA, aB), np.where(weaker, aB, aA)
    regime = one.regime(np.where(weaker, y, yB) * one.delta_1)
    columns = np.empty((*y.shape, len(COLUMNS)))
    columns[..., 0] = q
    for i in range(len(REGIMES)):
        columns[..., 1 + i] = np.where(regime == i, a1, 0.0)
    columns[..., 4], columns[..., 5] = a2, np.maximum(a1, a2)
    columns[..., 6] = tip_radius * math.pi / 2
    weights = (eps.reshape(len(eps), -1, NODES) @ _derivative(NODES).T).reshape(eps.shape)
    weighted = weights[..., None] * columns[:, :-1]
    return SqueezeRule(1 - eps[:, ::-1], weighted[:, ::-1], 1 - last[:, 0], columns[:, -1])


def _panels(edges: Array, reach: Array) -> Array:
    """Edges (M, k) split into as many panels for all as the worst needs; ``reach`` is in widths."""
    out = [edges[:, :1]]
    for i in range(edges.shape[1] - 1):
        low, high = edges[:, i : i + 1], edges[:, i + 1 : i + 2]
        if np.all(high - low <= 1e-14 * high):
            continue
        wide = math.ceil(np.max(reach[:, i + 1] - reach[:, i]) / SEAT_WIDTHS)
        if i == 0:
            parts = np.linspace(0, 1, max(wide, 1) + 1)[1:]
            out.append(low + (high - low) * parts)
            continue
        steps = math.ceil(np.log(np.max(high / low)) / math.log(RATIO))
        parts = np.arange(1, max(wide, steps, 1) + 1) / max(wide, steps, 1)
        out.append(low * (high / low) ** parts)
    return np.concatenate(out, axis=1)


def _crossings(kinks: Array, areas: Callable[[Array], tuple[Array, Array]]) -> Array:
    """Where the two contact areas change order: (M, k), infinite where there is none."""
    between = [kinks[:, :-1] + part * np.diff(kinks, axis=1) for part in (0.0, 0.3, 0.6)]
    y = np.sort(np.concatenate([*between, kinks[:, -1:]], axis=1), axis=1)
    a, b = areas(y)
    sign = np.where(np.abs(a - b) > 1e-13 * (a + b), np.sign(a - b), 0.0)
    changes = sign[:, 1:] * sign[:, :-1] < 0
    rank = np.cumsum(changes, axis=1)
    out = np.full((len(y), int(rank.max(initial=0))), np.inf)
    for k in range(out.shape[1]):
        rows, columns = np.nonzero(changes & (rank == k + 1))
        ends = y[:, [0, -1]].copy()
        ends[rows, 0], ends[rows, 1] = y[rows, columns], y[rows, columns + 1]
        out[rows, k] = _illinois(lambda x: np.subtract(*areas(x)), ends)[rows, 0]
    return out


def _illinois(function: Callable[[Array], Array], ends: Array) -> Array:
    """Roots (M, 1) between ends (M, 2) by false position that halves the value of a stale end."""
    low, high = ends[:, :1], ends[:, 1:]
    f_low, f_high = function(low), function(high)
    x = low
    for _ in range(8):  # a kink missed by δ costs a sum δ²
        with np.errstate(invalid="ignore", divide="ignore"):
            x = np.where(f_low == f_high, low, (low * f_high - high * f_low) / (f_high - f_low))
        f = function(x)
        crossed = f * f_high < 0
        low, f_low = np.where(crossed, high, low), np.where(crossed, f_high, 0.5 * f_low)
        high, f_high = x, f
    return x
