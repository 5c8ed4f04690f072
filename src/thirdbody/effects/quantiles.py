r"""The value that so many particles per area exceed: percentiles and extremes of an output.

A value v that grows with the squeeze is exceeded by the particles of size x that sit in gaps
narrower than :math:`g^*(x, v)`. On seats of a Gaussian height these are

.. math:: N(>v) = \eta_a\int \varphi_a(x)\,
          \Phi\!\left(\frac{g^*(x,v)-\bar g}{\sigma}\right)dx ,

on plane seats :math:`\eta_a` times the part of the sizes larger than the one whose value is v.
Sums over the classes of an output count a class as a whole, in or out, which is far too coarse for
the rare ones: here only :math:`g^*` is interpolated between classes, and the number is exact.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy import special

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from ..laws.spots import Layout, ParticleSpots

    Array = NDArray[np.float64]

__all__ = ["exceeded", "number_above", "number_squeezed"]

LOWEST = 1e-4
"""The smallest value that is looked for, over the largest."""
HALVINGS = 44
"""Of the logarithm of the range: 1e-12 of the value."""
LEVELS = 240
"""Values at which pieces are counted, evenly over their logarithm."""
SAME = 1e-9
"""By so much of the largest a value may fall, by rounding, as a gap closes."""
NEVER = -40.0
"""In widths of the seat: where nobody sits."""


def exceeded(
    groups: Sequence[tuple[ParticleSpots, Array, Array]], counts: Sequence[Array]
) -> list[Array]:
    """The value that so many (N,) spots per area exceed; 0 where fewer have any value.

    Parameters
    ----------
    groups : sequence of (ParticleSpots, values, weight)
        Values (M, n) of every class, 0 for those that do not count; and how often each counts.
    counts : sequence of array (N,)
        Numbers per nominal area [1/m²].

    Returns
    -------
    list of array (N,)
        Against exact integrals within 2e-3 of the value, for whole particles of any sizes on any
        seats. Particles that break are counted class by class, at 240 levels.
    """
    top = _largest(groups)
    if top == 0:
        return [np.zeros_like(count) for count in counts]
    above = _above(groups, top)
    out = []
    for count in counts:
        low, high = np.full(len(count), LOWEST * top), np.full(len(count), top)
        some = above(low) > count
        for _ in range(HALVINGS):
            middle = np.sqrt(low * high)
            more = above(middle) > count
            low, high = np.where(more, middle, low), np.where(more, high, middle)
        out.append(np.where(some, high, 0.0))
    return out


def number_above(
    groups: Sequence[tuple[ParticleSpots, Array, Array]], value: float, *, states: int
) -> Array:
    """Spots per area whose value exceeds this one, above 0: (N,), as exact as `exceeded`."""
    top = _largest(groups)
    if top <= value:
        return np.zeros(states)
    return _above(groups, top)(np.full(states, value))


def number_squeezed(spots: ParticleSpots, eps: float) -> Array | None:
    r"""Whole particles per area squeezed by more than ε of their size: (N,); None where unknown.

    .. math:: n = \eta_a\int\varphi_a(x)\,\Phi\!\left(\frac{(1-\varepsilon)x - \bar g}{w}\right)dx

    on seats of Gaussian height, whose gaps have the mean g and the width w.
    """
    layout = spots.layout
    if layout is None or layout.fragment is not None:
        return None
    if layout.means is None:
        return layout.density * layout.larger(layout.gaps / (1 - eps)) if eps < 1 else None
    low, high = layout.sizes.support
    x = layout.scale * (np.array([high]) if low == high else _edges(layout))
    return _on_seats(layout, x, np.multiply.outer((1 - eps) * x, np.ones(len(layout.means))))


def _largest(groups: Sequence[tuple[ParticleSpots, Array, Array]]) -> float:
    return max((float(np.max(values, initial=0.0)) for _, values, _ in groups), default=0.0)


def _above(
    groups: Sequence[tuple[ParticleSpots, Array, Array]], top: float
) -> Callable[[Array], Array]:
    tails = [
        _tail(spots, values, weight, top)
        for spots, values, weight in groups
        if np.size(values)  # a population may have no spot in any state
    ]

    def above(values: Array) -> Array:
        return np.sum([tail.above(values) for tail in tails], axis=0)

    return above


def _tail(
    spots: ParticleSpots, values: Array, weight: Array, top: float
) -> _OnSeats | _OnPlane | _Counted:
    """How many particles of a group exceed a value, by the best way that there is."""
    layout = spots.layout
    values = np.broadcast_to(values, spots.number.shape)
    if layout is not None and np.all((weight == 1) | (values == 0)):
        found = _Columns.from_layout(layout, values)
        if found is not None:
            return found.tail()
    return _Counted(spots, values, weight, top)


@dataclass(frozen=True, eq=False)
class _Columns:
    """Values of sizes x (K,) in gaps (M,): (M, K), rising with x and with closing gaps."""

    layout: Layout
    x: Array
    values: Array

    @classmethod
    def from_layout(cls, layout: Layout, values: Array) -> _Columns | None:
        """The values at the same sizes in every gap; None where they do not rise."""
        low, high = layout.sizes.support
        if low == high:
            x, columns = np.array([layout.scale * high]), values.max(axis=1, keepdims=True)
        else:
            x = layout.scale * _edges(layout)
            columns = np.array(
                [_row(x, *row) for row in zip(layout.x, values, layout.gaps, strict=True)]
            )
        slack = SAME * columns.max()
        falls = np.diff(columns, axis=1).min(initial=0.0) < -slack
        if layout.means is not None:
            falls |= np.diff(columns, axis=0).max(initial=0.0) > slack
        return None if falls else cls(layout, x, columns)

    def tail(self) -> _OnSeats | _OnPlane:
        if self.layout.means is None:
            return _OnPlane(self)
        return _OnSeats(self)


def _edges(layout: Layout) -> Array:
    """Sizes between which there are few particles: fine among the rare large ones."""
    sizes = layout.sizes
    rare = np.geomspace(1e-12, 0.01, 41)
    part = np.unique(np.concatenate([[0.0, 1e-4], np.linspace(0.01, 0.99, 65), 1 - rare, [1.0]]))
    edges = np.concatenate([sizes.ppf(part), sizes.pieces, sizes.kinks])
    if layout.fragment is not None:
        edges = np.append(edges, layout.fragment / layout.scale)
    return np.unique(np.clip(edges, *sizes.support))


def _row(x: Array, sizes: Array, values: Array, gap: float) -> Array:
    """The values of sizes x in one gap, in which the sizes of the classes have theirs."""
    at = np.flatnonzero(np.diff(sizes, prepend=min(gap, sizes[0]) - 1.0) > 0)
    known, found = sizes[at], values[at]
    if gap < known[0]:  # what just fits is not squeezed
        known, found = np.append(gap, known), np.append(0.0, found)
    out = np.interp(x, known, found, left=0.0 if gap >= 0 else None)
    if len(at) > 1:  # the largest sizes lie beyond the last class
        slope = (found[-1] - found[-2]) / (known[-1] - known[-2])
        out = np.where(x > known[-1], found[-1] + slope * (x - known[-1]), out)
    return out


class _OnSeats:
    """Particles on seats of Gaussian height."""

    def __init__(self, columns: _Columns):
        layout = columns.layout
        assert layout.means is not None
        self.layout, self.x = layout, columns.x
        self.gap_of = [_GapOf(layout.gaps, column) for column in columns.values.T]

    def above(self, values: Array) -> Array:
        return _on_seats(self.layout, self.x, np.array([gap_of(values) for gap_of in self.gap_of]))


def _on_seats(layout: Layout, x: Array, gaps: Array) -> Array:
    """Particles per area in gaps narrower than those (K, N) of each size x (K,): (N,)."""
    assert layout.means is not None
    one = len(x) == 1
    larger = layout.larger(np.zeros(1) if one else x)
    u = np.maximum((gaps - layout.means) / layout.width, NEVER)
    part = special.ndtr(u)
    if one:
        return layout.density * (larger @ part)
    # a density that rises from one end to the other weighs that end more
    part = _mean_normal(u[:-1], u[1:]) + 0.5 * _lean(layout, x)[:, None] * np.diff(part, axis=0)
    return layout.density * (-np.diff(larger) @ part)


def _lean(layout: Layout, x: Array) -> Array:
    """Mean size between neighbours less their middle, over half of their distance."""
    if layout.fragment is not None:
        return np.zeros(len(x) - 1)
    a, b = x[:-1] / layout.scale, x[1:] / layout.scale
    number, sum_of = (layout.sizes.partial_moment(n, a, b) for n in (0, 1))
    mean = np.divide(sum_of, number, out=0.5 * (a + b), where=number > 0)
    return np.clip((2 * mean - a - b) / (b - a), -1.0, 1.0)


class _GapOf:
    """The gap g* in which a particle has a value, from the values (M,) that it has in some gaps.

    Interpolated in √v, which rises about evenly as the gap closes, from the widest gap with a
    value on; between that one and the next wider one straight.
    """

    def __init__(self, gaps: Array, values: Array):
        from scipy.interpolate import PchipInterpolator

        order = np.argsort(-gaps)
        gaps, values = gaps[order], np.maximum.accumulate(values[order])
        first = int(np.argmax(values > 0))
        self.rise, at = np.unique(np.sqrt(values[first:]), return_index=True)
        self.gaps, self.beyond = gaps[first:][at], gaps[max(first - 1, 0)]
        self.line = PchipInterpolator(self.rise, self.gaps) if len(at) > 1 else None

    def __call__(self, values: Array) -> Array:
        low, high = self.rise[[0, -1]]
        if high == 0:
            return np.full_like(values, -np.inf)
        rise = np.sqrt(values)
        out = self.beyond + (self.gaps[0] - self.beyond) * (rise / low)
        if self.line is not None:
            out = np.where(rise > low, self.line(np.clip(rise, low, high)), out)
        return np.where(rise < high, out, -np.inf)


def _mean_normal(a: Array, b: Array) -> Array:
    r"""The mean of Φ between a and b: [G(b) − G(a)]/(b − a) with G = uΦ + φ."""
    far = np.abs(b - a) > 1e-4
    step = np.where(far, b - a, 1.0)

    def integral(u: Array) -> Array:
        return u * special.ndtr(u) + np.exp(-0.5 * u * u) / np.sqrt(2 * np.pi)

    return np.where(far, (integral(b) - integral(a)) / step, special.ndtr(0.5 * (a + b)))


class _OnPlane:
    """Particles on plane seats: a state is a row."""

    def __init__(self, columns: _Columns):
        self.layout, self.x, self.values = columns.layout, columns.x, columns.values

    def above(self, values: Array) -> Array:
        if len(self.x) == 1:
            return (
                self.layout.density * self.layout.larger(np.zeros(1)) * (self.values[:, 0] > values)
            )
        at = [
            np.interp(value, np.maximum.accumulate(row), self.x)
            for value, row in zip(values, self.values, strict=True)
        ]
        over = self.layout.larger(np.array(at))
        return self.layout.density * np.where(values < self.values.max(axis=1), over, 0.0)


class _Counted:
    """Particles class by class, each as a whole."""

    def __init__(self, spots: ParticleSpots, values: Array, weight: Array, top: float):
        self.levels = top * np.geomspace(LOWEST, 1.0, LEVELS)
        self.counts = spots.above(values, self.levels, weight)

    def above(self, values: Array) -> Array:
        """Linear in the logarithm of the level: (N,) for (N,)."""
        place = np.interp(np.log(values), np.log(self.levels), np.arange(LEVELS, dtype=float))
        at = np.minimum(place.astype(int), LEVELS - 2)
        row = np.arange(len(values))
        more, less = self.counts[row, at], self.counts[row, at + 1]
        return more + (place - at) * (less - more)
