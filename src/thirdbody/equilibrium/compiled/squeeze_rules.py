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
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...errors import NotCompiled
from ...laws.base import COLUMNS, REGIMES, AbstractAsperityLaw
from ...laws.particle.one_particle import Side
from ...numerics.chebyshev import PiecewiseChebyshev, chebyshev_transform
from ...numerics.products import in_pieces
from ...numerics.quadrature import gauss_legendre
from ...numerics.roots import bracketed_root
from .layout import CURVE, LAW, MOST_NODES, RESPONSE, SHARED, SIDE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Index = NDArray[np.intp]
    Records = NDArray[np.void]

__all__ = [
    "NEAR",
    "InverseLaw",
    "SharedRules",
    "SqueezeRule",
    "near_rule",
    "squeeze_rule",
    "squeeze_rules",
]

NODES, NODES_ALIKE = 20, 14
"""of a panel, and where both sides are of one material: 5e-13 of every sum over 600 pairs of
materials and seats of 1/500 to 3 in the size, 3e-12 of the area of one regime"""
RATIO = 2.8
"""Largest ratio of the roots of the indentations at the ends of a panel."""
NEAR, MOST_REACH = 3.0, 8.0
"""Standard deviations of a seat beyond the gaps within which fewer nodes do, and the most of them
that the gaps may span."""
SEAT_WIDTHS = 2.0
"""Widest panel in widths of the seat."""
STEP, TERMS, EXACT = 0.0625, 24, 1e-13
"""Of rules as series in ln(H/E*): widest panel, terms, and what their last terms may reach."""
WORTH = 200
"""Materials for which series are quicker than rules of each."""


def _table(function: PiecewiseChebyshev, dtype: np.dtype[np.void], *columns: str) -> Records:
    """Panels of a function, each of its columns by name."""
    table = np.empty(len(function.middle), dtype)
    table["middle"], table["half"] = function.middle, function.half
    for i, name in enumerate(columns):
        table[name] = function.coefficients[:, :, i]
    return table


class InverseLaw:
    """Reduced indentation y of a law from its load f(y), and from its mean pressure f/a.

    Raises
    ------
    NotCompiled
        A law that jumps, or does not begin with Hertz' contact, or whose mean pressure does not
        rise up to its last breakpoint and stay constant beyond.
    """

    def __init__(self, law: AbstractAsperityLaw):
        self.law = law
        points = law.breakpoints or (1.0,)
        self.first, self.last = points[0], points[-1]
        self.elastic = not law.breakpoints
        ends = np.array([self.first, self.last])
        self.forces, self.areas = (law.reduced(name, ends) for name in ("force", "area"))
        self.pressures = self.forces / self.areas
        self.bends = np.zeros(0)
        """y at the ends of the panels that resolve y of f."""
        self._check(np.array(points))
        self.tables: tuple[Records, ...] = tuple(np.empty(0, it) for it in (RESPONSE, CURVE, CURVE))
        """Load and area of √y, ln y of the load, y of the distance from the last pressure."""
        if self.first < self.last:
            log_y = PiecewiseChebyshev(
                lambda f: np.log(self._solve("force", np.exp(f)))[:, None],
                np.log(law.reduced("force", np.array(points))),
            )
            self.bends = np.exp(log_y(log_y.edges[1:-1])[:, 0])
            # near the last breakpoint the pressure may approach its limit like a square
            rise = np.sqrt(self.pressures[1] - self._pressure_at(np.array(points)))[::-1]
            y_of_rise = PiecewiseChebyshev(
                lambda r: self._solve("pressure", self.pressures[1] - r * r)[:, None], rise
            )
            forward = PiecewiseChebyshev(
                lambda v: np.stack([law.reduced(name, v * v) for name in ("force", "area")], -1),
                np.sqrt(points),
            )
            self.tables = (
                _table(forward, RESPONSE, "load", "area"),
                _table(log_y, CURVE, "y"),
                _table(y_of_rise, CURVE, "y"),
            )
            self._y_of_area = PiecewiseChebyshev(
                lambda a: self._solve("area", a)[:, None], law.reduced("area", np.array(points))
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
            ends = self.last * np.array([2.0, 10.0, 1e4])
            beyond = self._pressure_at(ends)
            good &= np.allclose(beyond, self.pressures[1], rtol=1e-12)
            linear = ends / self.last * self.areas[1]
            good &= np.allclose(law.reduced("area", ends), linear, rtol=1e-12)
        if not good:
            raise NotCompiled(f"{law.name} is not a law whose load tells its indentation")

    def _solve(self, quantity: str, value: Array) -> Array:
        def excess(y: Array, value: Array) -> Array:
            pressure = quantity == "pressure"
            return (self._pressure_at(y) if pressure else self.law.reduced(quantity, y)) - value

        ends = np.full_like(value, self.first), np.full_like(value, self.last)
        root = bracketed_root(excess, *ends, (value,), xrtol=4e-16)
        return np.clip(root, self.first, self.last)

    def record(self, plateau: bool) -> np.void:
        """The law as the compiled code reads it."""
        law = np.empty(1, LAW)
        law["first"], law["last"] = self.first, self.last
        law["first_load"], law["last_load"] = self.forces
        law["first_area"], law["last_area"] = self.areas
        law["elastic"], law["plateau"] = self.elastic, plateau
        return law[0]

    def of_area(self, a: Array) -> Array:
        """y at which the contact area is a."""
        if self.elastic:
            return self.first * (a / self.areas[0])
        y = np.where(
            a <= self.areas[0],
            self.first * (a / self.areas[0]),
            self.last * (a / self.areas[1]),
        )
        between = (a > self.areas[0]) & (a < self.areas[1])
        if np.any(between):
            y[between] = self._y_of_area(a[between])[:, 0]
        return y


@lru_cache(maxsize=64)
def inverse_law(law: AbstractAsperityLaw) -> InverseLaw:
    """The cached inverse of a bound law."""
    return InverseLaw(law)


class SqueezeRule(NamedTuple):
    """Nodes of M materials: lengths in the size of the particle."""

    rows: Array
    """(M, 8, n): weight times every column, then the gaps 1 − ε, increasing"""
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
    from .squeeze_kernel import carrying, fill, share

    inverse = inverse_law(law)
    one, two = (_Sides(inverse, E, H, tip_radius) for E, H in (first, second))
    weaker = one.limit <= two.limit
    A, B = Side.chosen(weaker, one, two), Side.chosen(weaker, two, one)
    equal = np.all((A.delta_1 == B.delta_1) & (A.unit == B.unit), axis=1)
    laid = (inverse.record(A.plateau), inverse.tables, _records(A), _records(B), equal)

    def shared(y: Array) -> Records:
        out = np.empty(y.shape, SHARED)
        share(*laid, y, out)
        return out

    def more_area(y: Array) -> tuple[Array, Array]:
        """Contact areas of the weaker and the stronger side, over the same unit."""
        both = shared(y)
        return A.delta_1 * both["area_weaker"], B.delta_1 * both["area_stronger"]

    top = A.kinks[:, -1:]
    kinks = A.kinks
    if not np.all(equal):
        points = _kinks_and_bends(B, inverse)
        met = np.empty_like(points)
        carrying(*laid[:3], B.unit / A.unit * B.reduced_force(points), met)
        kinks = np.concatenate([kinks, np.minimum(met, top)], axis=1)
        if split_areas:
            crossings = _crossings(np.sort(kinks, axis=1), more_area)
            kinks = np.concatenate([kinks, np.minimum(crossings, top)], axis=1)
    kinks = np.sort(kinks, axis=1)
    edges = np.concatenate([np.zeros_like(top), kinks], axis=1)
    eps = A.delta_1 * edges + B.delta_1 * shared(edges)["y_stronger"]
    edges = _panels(np.sqrt(edges), eps / widths)
    per = NODES_ALIKE if np.all(equal) else NODES
    count, n = len(edges), (edges.shape[1] - 1) * per
    rows = np.empty((count, len(COLUMNS) + 1, n))
    bottom, floor = np.empty(count), np.empty((count, len(COLUMNS)))
    order = np.array([REGIMES.index(branch.regime) for branch in A.law.branches])
    fill(
        *laid,
        ~weaker[:, 0],
        np.array(A.law.breakpoints, dtype=float),
        order,
        edges,
        gauss_legendre(per)[0],
        np.ascontiguousarray(_derivative(per).T),
        tip_radius,
        *(rows, bottom, floor),
    )
    return SqueezeRule(rows, bottom, floor)


def near_rule(rule: SqueezeRule, width: float) -> Array | None:
    """Rules with fewer nodes, for seats that are not far from touching.

    A Gaussian seat weighs the squeeze with a function that varies slowly over all of it: sums over
    the nodes of its Chebyshev interpolant are sums over as many Chebyshev nodes.

    Parameters
    ----------
    rule : SqueezeRule
    width : float
        Least standard deviation of a seat, in the size of the particle.

    Returns
    -------
    array (M, 8, m), or None
        Like `SqueezeRule.rows`. For seats whose mean gap is within `NEAR` standard deviations of
        the gaps: 2e-13 of the load and of the whole area. None where there would not be fewer.
    """
    from .squeeze_kernel import gather

    reach = float(np.max(1 - rule.bottom)) / width
    count = 8 * math.ceil((10 + 6 * reach**0.75) / 8)  # found by trial
    if count >= rule.rows.shape[2] or reach > MOST_REACH:
        return None
    x, transform = chebyshev_transform(count)
    out = np.empty((*rule.rows.shape[:2], count))
    gather(rule.rows, rule.bottom, np.ascontiguousarray(transform[:, ::-1]), out)
    out[:, -1] = 1 - 0.5 * (1 - rule.bottom[:, None]) * (1 + x)
    return out


def squeeze_rules(
    law: AbstractAsperityLaw,
    first: tuple[Array, Array],
    second: tuple[Array, Array],
    *,
    widths: Array,
    **options: Any,
) -> Iterator[tuple[Index, SqueezeRule | SharedRules]]:
    """Which materials, and their rules by `squeeze_rule` or the series on which these lie.

    Everything but the load depends on H₁/E*₁, H₂/E*₂ and E*₂/E*₁ alone, and the load is E*₁ times
    what depends on them. Where one of them varies, or the first two alike, the rules are Chebyshev
    series in its logarithm, between the values at which the area of the great circle is one where
    the law changes its formula. Where series do not converge, and where more varies, each
    material has its rule.

    Parameters
    ----------
    law, first, second, widths, **options
        As in `squeeze_rule`.
    """
    E = first[0]
    ratios = [np.log(first[1] / E), np.log(second[1] / second[0]), np.log(second[0] / E)]
    varied = [ratio[:, 0] for ratio in ratios if np.ptp(ratio) > 0]
    rest = np.ones(len(E), bool)
    if varied and len(E) >= WORTH and all(np.array_equal(ratio, varied[0]) for ratio in varied):
        fixed = tuple(None if np.ptp(ratio) > 0 else float(ratio[0, 0]) for ratio in ratios)
        # a little finer than asked for, so that others share them
        width = 2 ** (math.floor(4 * math.log2(np.min(widths))) / 4)
        given = (("widths", width), *options.items())
        edges = _edges_in_ratio(law, options["tip_radius"], varied[0].min(), varied[0].max())
        panel = np.searchsorted(edges, varied[0], side="right")
        for p in np.unique(panel):
            series = _series_in_ratio(law, fixed, edges[p - 1], edges[p], given)
            if series is not None:
                here = np.flatnonzero(panel == p)
                rest[here] = False
                yield here, series.shared(varied[0][here], E[here, 0])
    if np.any(rest):
        which = np.flatnonzero(rest)
        sides = [(E[which], H[which]) for E, H in (first, second)]
        some = widths[which] if len(widths) > 1 else widths
        yield which, squeeze_rule(law, *sides, widths=some, **options)


class SharedRules(NamedTuple):
    """Rules of M materials that lie on one series."""

    series: RuleSeries
    across: Array
    """(M,): where they lie on it, −1 to 1"""
    bottom: Array
    floor: Array
    """As in `SqueezeRule`"""


@dataclass(frozen=True, eq=False)
class RuleSeries:
    """Rules of unit E*₁ as Chebyshev series in the logarithm of a ratio of materials."""

    low: float
    high: float
    rows: Array
    """(TERMS, 8, n), coefficients of `SqueezeRule.rows`"""
    ends: Array
    """(TERMS, 8), of the floor and the bottom"""
    near: Array | None = None
    """(TERMS, 8, m), of those of `near_rule`"""

    def shared(self, ratio: Array, E: Array) -> SharedRules:
        """Rules for ratios (M,) between the ends and moduli E*₁ (M,)."""
        x = np.clip((2 * ratio - self.low - self.high) / (self.high - self.low), -1, 1)
        ends = np.empty((len(x), self.ends.shape[1]))
        for part in in_pieces(len(x), self.ends.size):
            ends[part] = np.polynomial.chebyshev.chebvander(x[part], TERMS - 1) @ self.ends
        ends[:, 0] *= E
        return SharedRules(self, x, ends[:, 7], ends[:, :7])


@lru_cache(maxsize=64)
def _great_circles(law: AbstractAsperityLaw, tip_radius: float) -> Array:
    """ln(H/E*) at which the area of the great circle is one where the law changes its formula."""
    one = np.ones((1, 1))
    full = np.ravel(_Sides(inverse_law(law), one, one, tip_radius).full)[0]
    # the area over that at yield falls with the square of H/E*
    areas = law.reduced("area", np.array(law.breakpoints or (1.0,)))
    return np.asarray(0.5 * np.log(full / areas))


def _edges_in_ratio(law: AbstractAsperityLaw, tip_radius: float, low: float, high: float) -> Array:
    """Edges of panels over low to high: steps that do not depend on them, and great circles."""
    steps = STEP * np.arange(math.floor(low / STEP), math.floor(high / STEP) + 2)
    circles = _great_circles(law, tip_radius)
    return np.unique(np.append(steps, circles[(circles > steps[0]) & (circles < steps[-1])]))


@lru_cache(maxsize=128)
def _series_in_ratio(
    law: AbstractAsperityLaw,
    fixed: tuple[float | None, ...],
    low: float,
    high: float,
    options: tuple[tuple[str, Any], ...],
) -> RuleSeries | None:
    """Series where the ratios that are not fixed go from low to high; None if they diverge."""
    x, transform = chebyshev_transform(TERMS)
    ratio = 0.5 * (low + high) + 0.5 * (high - low) * x[:, None]
    one, two, E = (np.exp(ratio if value is None else 0 * ratio + value) for value in fixed)
    given = dict(options)
    width = given.pop("widths")
    sides = (np.ones_like(E), one), (E, two * E)
    rule = squeeze_rule(law, *sides, widths=np.full((1, 1), width), **given)
    if rule.rows.shape[2] > MOST_NODES:
        return None
    ends = np.concatenate([rule.floor, rule.bottom[:, None]], axis=1)
    near = near_rule(rule, width)
    found = []
    for values in (rule.rows, ends, *([] if near is None else [near])):
        series = np.einsum("ij,j...->i...", transform, values)
        size = np.abs(series).reshape(TERMS, 8, -1).max(axis=2)
        if np.any(size[-2:] > EXACT * size.max(axis=0)):
            return None
        found.append(series)
    return RuleSeries(low, high, *found)


class _Sides(Side):
    """Sides of many materials, whose great circle the law's own inverse tells."""

    def __init__(self, inverse: InverseLaw, E_star: Array, H: Array, R: float):
        self.inverse = inverse
        super().__init__(inverse.law, E_star, H, 0.0, R)

    def _cap(self) -> Array:
        return self.inverse.of_area(np.asarray(self.full, dtype=float))


def _kinks_and_bends(side: Side, inverse: InverseLaw) -> Array:
    """y at which a side changes its formula, or its inverse bends sharply."""
    bends = np.broadcast_to(inverse.bends, (len(side.kinks), len(inverse.bends)))
    return np.concatenate([side.kinks, np.minimum(bends, side.kinks[:, -1:])], axis=1)


def _records(side: Side) -> Records:
    """Materials as the compiled code reads them."""
    columns = np.broadcast_arrays(side.delta_1, side.unit, side.full, side.cap, side.limit)
    out = np.empty(len(columns[0]), SIDE)
    for name, values in zip(("delta", "unit", "full", "cap", "limit"), columns, strict=True):
        out[name] = values[:, 0]
    return out


def _panels(edges: Array, reach: Array) -> Array:
    """Edges (M, k) split into as many panels for all as the worst needs; ``reach`` is in widths.

    From one kink to the next the reach grows about like the square of the edges. Panels of equal
    ratio come first, up to where one would be too wide for the seat, and then panels of equal
    reach.
    """
    out = [edges[:, :1]]
    shrink = 1 - 1 / RATIO**2
    for i in range(edges.shape[1] - 1):
        low, high = edges[:, i : i + 1], edges[:, i + 1 : i + 2]
        if np.all(high - low <= 1e-14 * high):
            continue
        wide = (reach[:, i + 1] - reach[:, i])[:, None] / SEAT_WIDTHS
        square = high**2 - low**2
        middle = low
        if i > 0:
            most = np.divide(square, shrink * wide, out=np.full_like(high, np.inf), where=wide > 0)
            middle = np.clip(np.sqrt(most), low, high)
            steps = math.ceil(np.log(np.max(middle / low)) / math.log(RATIO) - 1e-9)
            if steps > 0:
                out.append(low * (middle / low) ** (np.arange(1, steps + 1) / steps))
        rest = np.divide(high**2 - middle**2, square, out=np.zeros_like(high), where=square > 0)
        count = max(math.ceil(np.max(wide * rest) - 1e-9), int(i == 0))
        if count > 0:
            parts = np.arange(1, count + 1) / count
            out.append(np.sqrt(middle**2 + (high**2 - middle**2) * parts))
            out[-1][:, -1:] = high
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
