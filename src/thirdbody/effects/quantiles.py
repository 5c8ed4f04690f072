r"""The value that so many particles per area exceed: percentiles and extremes of an output.

A particle of size x has a larger value than v between squeezes that its `Curve` knows, so between
gaps :math:`g = x(1-\varepsilon)`. On seats of a Gaussian height, in gaps of mean :math:`\bar g`
and standard deviation σ, these are

.. math:: N(>v) = \eta_a\int \varphi_a(x) \sum \left[
          \Phi\!\left(\frac{x(1-\varepsilon_i)-\bar g}{\sigma}\right)
          -\Phi\!\left(\frac{x(1-\varepsilon'_i)-\bar g}{\sigma}\right)\right] dx ,

on plane seats :math:`\eta_a` times the part of the sizes that have it in the one gap. The integral
is a Gauss rule over panels that end where its integrand bends. Sums over the classes of an output
count a class as a whole, in or out, which is far too coarse for the rare ones.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import special

from ..numerics.quadrature import panel_rule
from ..numerics.roots import bracketed_root

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from ..laws.spots import Layout, ParticleSpots
    from .curves import Curve

    Array = NDArray[np.float64]
    Rows = NDArray[np.intp]
    _Above = Callable[..., Array]

__all__ = ["Values", "exceeded_values", "number_above"]

PER_DECADE = 60
"""Levels at which pieces are counted, evenly over their logarithm."""
RANGE = 1e-40
"""The smallest value that is looked for, over the largest; that of any class, if it is larger."""
TOLERANCE = 1e-10
"""Of the logarithm of a value, over the logarithm of the range."""
FEWEST = 1e-30
"""Part of what is wanted that is as good as none."""
PARTS = (1e-12, 1e-9, 1e-7, 1e-5, 1e-4, 1e-3, 1e-2, 0.05, 0.15, 0.3, 0.5)
"""Parts of the particles up to sizes where panels end, from either side."""
WIDTHS = (-12.0, -8.0, -6.0, -4.5, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.5, 6.0, 8.0)
"""In widths of the seat about the size that has the value in the mean gap: panels end there."""
ABOVE_TOP = 1 + np.array([1e-5, 1e-3, 1e-2, 5e-2])
"""Over the smallest size that has a value: panels end there."""
SCAN, SCANS, SMALLEST = 25, 4, 1e-9
"""Sizes that are tried together for that one, how often, and the smallest over the largest."""
HALVINGS = 60
"""Of sizes on a plane."""
TINY = 1e-200
"""A size [m] in place of none."""
FEW_NODES, NODES = 6, 14
"""Of a panel, where a value is looked for, and where it is found."""
NEAR = 3e-5
"""How near few nodes come, as `TOLERANCE`."""
AT_ONCE = 100_000
"""Nodes that are summed together, few enough for the caches."""


class Values(NamedTuple):
    """An output of one group of particles."""

    spots: ParticleSpots
    values: Array
    """Of every class (M, n); 0 for those that do not count."""
    weight: Array | float = 1.0
    """How often each counts."""
    curve: Curve | None = None
    """The same of one particle; without it classes are counted."""
    least: tuple[Curve, float] | None = None
    """Another value of a particle that counts, and what it exceeds."""


def exceeded_values(groups: Sequence[Values], counts: Sequence[Array]) -> list[Array]:
    """The value that so many (N,) spots per area exceed; 0 where fewer have any value.

    Parameters
    ----------
    groups : sequence of Values
    counts : sequence of array (N,)
        Numbers per nominal area [1/m²].

    Returns
    -------
    list of array (N,)
        Within 1e-7 for particles with a curve. Others are counted class by class, at 60
        levels a decade: within a few percent.
    """
    top = _largest(groups)
    if top == 0:
        return [np.zeros_like(count) for count in counts]
    above, low = _above(groups, top), 0.5 * min(_least(group, top) for group in groups)
    wanted = np.concatenate([*counts, np.zeros(0)])
    rows = np.tile(np.arange(len(wanted) // max(len(counts), 1)), len(counts))
    out = np.zeros(len(wanted))
    some = np.flatnonzero(above(np.full(len(wanted), low), rows) > wanted)
    if len(some):
        values = _where_so_many(above, wanted[some], (low, top), rows[some])
        # where more than that many have the largest value, it is that
        out[some] = np.where(np.isnan(values), top, values)
    return np.split(out, len(counts))


def _where_so_many(above: _Above, count: Array, between: tuple[float, float], rows: Rows) -> Array:
    """Value between two limits that a given number exceeds; NaN where none does.

    First by a few nodes, then near there by many.
    """
    low, top = between
    floor = np.maximum(FEWEST * count, 1e-300)
    every = np.arange(len(rows))
    first, last = np.full(len(rows), 1.0), np.full(len(rows), 1.0 + math.log(top / low))

    def root_of(nodes: int, begin: Array, end: Array, which: Rows, tolerance: float) -> Array:
        def excess(place: Array, index: Array) -> Array:
            at = index.astype(np.intp)
            number = above(low * np.exp(place - 1.0), rows[at], nodes)
            return np.log(np.maximum(number, floor[at]) / np.maximum(count[at], floor[at]))

        return bracketed_root(
            excess, begin[which], end[which], (which.astype(float),), xrtol=tolerance
        )

    near = root_of(FEW_NODES, first, last, every, NEAR * 0.1)
    here = np.flatnonzero(np.isfinite(near))
    root = np.full(len(rows), np.nan)
    margin = NEAR * near
    begin, end = np.maximum(near - margin, first), np.minimum(near + margin, last)
    root[here] = root_of(NODES, begin, end, here, TOLERANCE)
    rest = np.flatnonzero(np.isnan(root))  # few nodes were too far off
    root[rest] = root_of(NODES, first, last, rest, TOLERANCE)
    return low * np.exp(root - 1.0)


def number_above(groups: Sequence[Values], value: float, *, states: int) -> Array:
    """Number of spots per area whose value exceeds a limit ≥ 0: (N,).

    As exact as `exceeded_values`.
    """
    top = _largest(groups)
    if top <= value:
        return np.zeros(states)
    return _above(groups, top)(np.full(states, value), np.arange(states))


def _largest(groups: Sequence[Values]) -> float:
    return max((_most(group) for group in groups), default=0.0)


def _most(group: Values) -> float:
    """The largest value that a particle of a group may have."""
    if not np.size(group.values):  # a population may have no spot in any state
        return 0.0
    layout, curve = group.spots.layout, group.curve
    if layout is None or curve is None:
        return float(np.max(group.values, initial=0.0))
    return curve.top * (layout.scale * layout.sizes.support[1]) ** curve.power


def _least(group: Values, top: float) -> float:
    """The smallest value of any class that there are any of."""
    values = np.broadcast_to(group.values, group.spots.number.shape)
    there = (values > RANGE * top) & (group.spots.number > 0)
    return float(np.min(values, where=there, initial=top))


def _above(groups: Sequence[Values], top: float) -> _Above:
    tails = [_tail(group, top) for group in groups if _most(group) > 0]

    def above(values: Array, rows: Rows, nodes: int = NODES) -> Array:
        return sum((tail.above(values, rows, nodes) for tail in tails), np.zeros(len(values)))

    return above


def _tail(group: Values, top: float) -> _OnSeats | _OnPlane | _Counted:
    """How many particles of a group exceed a value, by the best way that there is."""
    layout, curve = group.spots.layout, group.curve
    if layout is None or curve is None:
        return _Counted(group, top)
    kind = _OnPlane if layout.means is None else _OnSeats
    return kind(layout, curve, group.least)


@dataclass(frozen=True, eq=False)
class _Whole:
    """Whole particles."""

    layout: Layout
    curve: Curve
    least: tuple[Curve, float] | None

    @property
    def density(self) -> Array:
        layout = self.layout
        states = len(layout.gaps if layout.means is None else layout.means)
        return np.broadcast_to(np.asarray(layout.density, dtype=float), (states,))

    def sizes(self) -> Array:
        """Sizes [m] where panels end."""
        sizes, parts = self.layout.sizes, np.array(PARTS)
        edges = np.concatenate([sizes.pieces, sizes.kinks, sizes.ppf([*parts, *(1 - parts)])])
        return self.layout.scale * np.unique(np.clip(edges, *sizes.support))

    def density_of(self, x: Array) -> Array:
        """φ_a(x) [1/m]."""
        return self.layout.sizes.pdf(x / self.layout.scale) / self.layout.scale

    def squeezes(self, values: Array, x: Array) -> list[tuple[Array, Array]]:
        """Between which ε particles of sizes x exceed these values: lower and upper ends."""
        stretches = list(self.curve.stretches(values / x**self.curve.power))
        if self.least is not None:
            other, value = self.least
            begin = other.first(value / x**other.power)
            stretches = [(np.maximum(a, begin), np.maximum(b, begin)) for a, b in stretches]
        shape = np.broadcast(values, x).shape
        return [(np.broadcast_to(a, shape), np.broadcast_to(b, shape)) for a, b in stretches]

    def bends(self, values: Array) -> Array:
        """Sizes (N, k) at which the squeezes of these values jump or bend."""
        out = []
        if self.curve.power:
            out.append(values[:, None] / self.curve.seams)
            # values set in at their largest like a root
            out.append(values[:, None] / self.curve.top * ABOVE_TOP)
        if self.least is not None:
            other, value = self.least
            out.append(np.broadcast_to(value / other.seams, (len(values), len(other.seams))))
        return np.concatenate(out, axis=1) if out else np.empty((len(values), 0))


class _OnSeats(_Whole):
    """Particles on seats of Gaussian height."""

    def _share_above(self, values: Array, x: Array, means: Array) -> Array:
        """Part of the particles of sizes x that exceed the values."""
        width = self.layout.width
        out, x = np.zeros(np.broadcast(values, x).shape), np.maximum(x, TINY)
        for begin, end in self.squeezes(values, x):
            there = end > begin
            upper = np.where(there, x * (1 - np.where(there, begin, 0.0)) - means, -np.inf)
            lower = np.where(there, x * (1 - end) - means, -np.inf)
            out += special.ndtr(upper / width) - special.ndtr(lower / width)
        return out

    def _turn(self, values: Array, means: Array, low: float, high: float) -> Array:
        """The size that has the value in the mean gap (N,), close enough for ends of panels."""
        least = max(low, SMALLEST * high)
        steps = np.broadcast_to(np.geomspace(least, high, SCAN), (len(values), SCAN))
        row = np.arange(len(values))
        for _ in range(SCANS):
            begin = np.full(steps.shape, np.inf)
            for a, b in self.squeezes(values[:, None], steps):
                begin = np.where(a < b, np.minimum(begin, a), begin)
            less = np.where(np.isfinite(begin), steps * (1 - begin), -np.inf) < means[:, None]
            at = np.clip(np.sum(less, axis=1), 1, SCAN - 1)
            a, b = steps[row, at - 1, None], steps[row, at, None]
            steps = a + (b - a) * np.linspace(0.0, 1.0, SCAN)
        return np.where(np.all(less, axis=1), high, steps[:, SCAN // 2])

    def above(self, values: Array, rows: Rows, nodes: int = NODES) -> Array:
        layout = self.layout
        assert layout.means is not None
        edges = self.sizes()
        count = max(1, AT_ONCE // (nodes * (len(edges) + 40)))
        out = np.empty(len(values))
        for start in range(0, len(values), count):
            batch = slice(start, start + count)
            means = layout.means[rows[batch]]
            out[batch] = self._sum(values[batch], means, edges, nodes)
        return self.density[rows] * out

    def _sum(self, values: Array, means: Array, edges: Array, nodes: int) -> Array:
        low, high = float(edges[0]), float(edges[-1])
        if low == high:
            return self._share_above(values, np.full(len(values), high), means)
        turn = self._turn(values, means, low, high)
        more = turn[:, None] + self.layout.width * np.array(WIDTHS)
        fixed = np.broadcast_to(edges, (len(values), len(edges)))
        ends = np.concatenate([fixed, more, self.bends(values)], axis=1)
        ends = np.sort(np.clip(ends, low, high), axis=1)
        x, weight = panel_rule(ends, nodes)
        share = self._share_above(values[:, None], x, means[:, None])
        density = np.where(weight > 0, self.density_of(np.maximum(x, TINY)), 0.0)
        return np.sum(weight * density * share, axis=1)


class _OnPlane(_Whole):
    """Particles on plane seats: a state is a row."""

    def above(self, values: Array, rows: Rows, nodes: int = NODES) -> Array:
        layout, gaps = self.layout, self.layout.gaps[rows]
        edges = self.sizes()
        low, high = float(edges[0]), float(edges[-1])
        if low == high:
            return self.density[rows] * self._exceeds(values, np.full(len(values), high), gaps)
        # between sizes so close that at most one of the bounds is crossed
        more = np.linspace(low, high, 400)
        fixed = np.broadcast_to(np.unique([*edges, *more]), (len(values), len({*edges, *more})))
        starts = gaps[:, None] * np.array([1.0, 1 + 1e-9, 1 + 1e-6, 1 + 1e-4, 1.01])
        ends = np.concatenate([fixed, starts, self.bends(values)], axis=1)
        ends = np.sort(np.clip(ends, low, high), axis=1)
        inside = self._exceeds(values[:, None], ends, gaps[:, None])
        row, at = np.nonzero(np.diff(inside, axis=1))
        a, b, first = ends[row, at], ends[row, at + 1], inside[row, at]
        for _ in range(HALVINGS):
            middle = 0.5 * (a + b)
            same = self._exceeds(values[row], middle, gaps[row]) == first
            a, b = np.where(same, middle, a), np.where(same, b, middle)
        larger = self.layout.sizes.partial_moment(0, 0.5 * (a + b) / layout.scale,
                                                  high / layout.scale)  # fmt: skip
        top = inside[:, -1] * 0.0
        np.add.at(top, row, np.where(first > 0, -larger, larger))
        everything = self.layout.sizes.partial_moment(0, -1.0, high / layout.scale)
        return self.density[rows] * (top + inside[:, 0] * everything)

    def _exceeds(self, values: Array, x: Array, gaps: Array) -> Array:
        """1 where particles of sizes x exceed the values, else 0."""
        with np.errstate(divide="ignore", invalid="ignore"):
            eps = np.where(x > 0, 1 - gaps / x, 0.0)
        out = np.zeros(np.broadcast(values, x).shape, dtype=bool)
        for begin, end in self.squeezes(values, np.where(x > 0, x, 1.0)):
            out |= (eps > begin) & (eps <= end) & (x > 0)
        return out.astype(float)


class _Counted:
    """Particles class by class, each as a whole."""

    def __init__(self, group: Values, top: float):
        values = np.broadcast_to(group.values, group.spots.number.shape)
        decades = -math.log10(min(_least(group, top) / top, 0.1)) + 0.1
        self.levels = top * np.geomspace(10**-decades, 1.0, math.ceil(PER_DECADE * decades))
        self.counts = group.spots.above(values, self.levels, group.weight)

    def above(self, values: Array, rows: Rows, nodes: int = NODES) -> Array:
        """Linear in the logarithm of the level: (N,) for (N,)."""
        with np.errstate(divide="ignore"):
            wanted = np.log(values)
        count = len(self.levels)
        place = np.interp(wanted, np.log(self.levels), np.arange(count, dtype=float))
        at = np.minimum(place.astype(int), count - 2)
        more, less = self.counts[rows, at], self.counts[rows, at + 1]
        return more + (place - at) * (less - more)
