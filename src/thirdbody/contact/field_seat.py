r"""Sums over the heights of ground that particles press down, one separation a row.

Particles sit on ground of height ζ, a share dN(ζ) of them, in gaps h − ζ + u(ζ). Where the ground
gives way much, a gap may rise with the height; panels follow it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache, cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..laws.base import COLUMNS
from ..laws.field.programme import MOMENTS
from ..numerics.quadrature import panel_rule, subdivide
from .particle_averages import SeatAverage

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..laws.field.spectrum import Spectrum
    from .particle_sums import Part

    Array = NDArray[np.float64]

__all__ = ["Nodes", "Seat", "heights"]

CHORDS, SET_IN, LEVEL_OUT = 40, 1e-14, 1e-9
"""Of the search for the ground that leaves a gap: chords at most, how near [σ], and the slope of
a gap [1] at which it is widest or narrowest."""
HIGHEST_SEAT = 4.0
"""Height over σ beyond which the ground is as there: 3e-5 of it lie higher."""
TINY = 1e-250
"""Load over that of a particle without a gap below which nothing is carried."""
DENSITY = 8.5
"""Widths of the seat beyond which nothing is counted."""
NODES, GRID = 8, 0.25
"""Of sums over seats: nodes of a panel, and how far heights lie apart from which ends of panels are
sought, over the width of the seat."""
WIDTH, FALL = 1.25, 3.5
"""Width of a panel over that of the seat, at most, and how much ln dN may change over one."""


def heights(u: Array, zeta: Array) -> Array:
    """Σ u_n he_n at ζ (N, M) for u (N, 13), constant far from the mean plane."""
    x = np.clip(zeta, -HIGHEST_SEAT, HIGHEST_SEAT)
    after = later = np.zeros_like(x)
    for n in range(MOMENTS, -1, -1):  # Clenshaw
        value = after * (1 / math.sqrt(n + 1))
        value *= x
        value -= math.sqrt((n + 1) / (n + 2)) * later
        value += u[:, n : n + 1]
        later, after = after, value
    return after


def heights_slope(u: Array, zeta: Array) -> Array:
    """Derivative of `heights` with respect to ζ (N, M), which is not far from the mean plane."""
    shifted = np.zeros_like(u)
    shifted[:, :-1] = u[:, 1:] * np.sqrt(np.arange(1.0, u.shape[1]))
    return heights(shifted, zeta)


def _zeros_by_chords(
    of: Callable[[NDArray[np.intp], Array], Array],
    ends: tuple[Array, Array],
    values: tuple[Array, Array],
    close: Array,
) -> Array:
    """Places (N,) between two ends at which functions of opposite values there are near 0.

    By chords with the weight of an end that stays halved; ``of`` tells which of the functions at
    which places are asked for.
    """
    (a, b), (f_a, f_b) = ends, values
    places, last = np.where(f_a == 0, a, b), np.zeros(len(a))
    here = np.flatnonzero((f_a != 0) & (f_b != 0))
    a, b, f_a, f_b, last = (one[here] for one in (a, b, f_a, f_b, last))
    for _ in range(CHORDS):
        if not len(here):
            break
        zeta = (a * f_b - b * f_a) / (f_b - f_a)
        f = of(here, zeta)
        places[here] = zeta
        behind = (f < 0) == (f_b < 0)
        f_a = np.where(behind & (last == 1), 0.5 * f_a, f_a)
        f_b = np.where(~behind & (last == -1), 0.5 * f_b, f_b)
        a, f_a = np.where(behind, a, zeta), np.where(behind, f_a, f)
        b, f_b = np.where(behind, zeta, b), np.where(behind, f, f_b)
        last = np.where(behind, 1, -1)
        far = np.abs(f) > close[here]
        here = here[far]
        a, b, f_a, f_b, last = (one[far] for one in (a, b, f_a, f_b, last))
    return places


class Nodes(NamedTuple):
    """Nodes of sums over seats, row by row: which row, height ζ, gap over σ and weight dN, (M,)."""

    rows: NDArray[np.intp]
    zeta: Array
    gap: Array
    weight: Array

    def sum_rows(self, values: Array, count: int) -> Array:
        """Sums of values (M, K) over the nodes of each row: (count, K)."""
        out = np.zeros((count, values.shape[1]))
        first = np.flatnonzero(np.diff(self.rows, prepend=-1))
        if len(first):
            out[self.rows[first]] = np.add.reduceat(values, first)
        return out


def _in_rows(rows: NDArray[np.intp], values: Array, count: int, rest: float) -> Array:
    """Values of rows that do not fall, beside each other, and a rest where rows have fewer."""
    most = np.bincount(rows, minlength=count)
    out = np.full((count, int(most.max(initial=0))), rest)
    out[rows, np.arange(len(rows)) - np.repeat(np.cumsum(most) - most, most)] = values
    return out


@cache
def _fixed_ends() -> Array:
    """Heights from the mean of a seat over its width at which panels end at least."""
    ends = [0.0]
    while ends[-1] < DENSITY:
        ends.append(ends[-1] + min(WIDTH, FALL / (ends[-1] + 0.5)))
    ends[-1] = DENSITY
    return np.array([*(-end for end in ends[:0:-1]), *ends])


def _beside(*values: Array) -> Array:
    """Rows of several arrays side by side, sorted."""
    return np.sort(np.concatenate(values, axis=1), axis=1)


class Seat:
    """Particles of one shape of size distribution on ground that gives way."""

    def __init__(
        self,
        component: Part,
        sigma: float,
        mean: float,
        width: float,
        spectrum: Spectrum,
        shadow: str,
    ):
        self.height, self.slope = spectrum.height, spectrum.slope
        self.shadow = COLUMNS.index(shadow) if shadow in COLUMNS else None
        """Column of the area in which its particles keep asperities apart, if it is one."""
        assert isinstance(component.average, SeatAverage)
        self.component, self.mean, self.width = component, mean, width
        self.average = component.average
        self.unit = component.scale / sigma
        """Size of the standardised particles over σ."""
        load, *areas = component.average.average.floor
        self.pressure = load / max(areas)
        """On the area that particles without a gap have [Pa]."""

    def _gap(self, h: Array, u: Array, zeta: Array) -> Array:
        """Gaps over σ at h (N,) on ground u (N, 13) of heights ζ (N, M)."""
        return h[:, None] - self.height(zeta) + heights(u, zeta)

    def nodes(self, h: Array, u: Array, more: Sequence[float] = ()) -> Nodes:
        """Nodes of sums over seats at h (N,) with u (N, 13), where particles are squeezed.

        Panels end where a gap is one at which the columns over sizes have a kink, or one of
        ``more`` [σ], where gaps are narrowest or widest, and where the ground levels out. The
        variable is the root of the distance from the ground on which a size sets in, as loads go
        like powers of it.
        """
        average = self.average.average
        onsets = self.unit * average.onsets
        gaps = np.unique(np.concatenate([self.unit * average.edges, onsets, more]))
        fixed, grid, turns = self._turning_points(h, u)
        beside = self._gap(h, u, grid)
        every = np.broadcast_to(fixed, (len(h), len(fixed)))
        row, want, places = self._heights_at(h, u, gaps, grid, beside)
        lowest, sets_in = grid[0, 0], np.isin(gaps, onsets)[want]
        ends = _beside(every, turns, _in_rows(row, places, len(h), lowest))
        begins = _in_rows(row[sets_in], places[sets_in], len(h), lowest)
        starts = _beside(grid[:, :1], begins, grid[:, -1:])
        rows, panel = np.nonzero(ends[:, 1:] > ends[:, :-1])
        begin, end = ends[rows, panel], ends[rows, panel + 1]
        between = self._gap(h[rows], u[rows], np.stack([begin, 0.5 * (begin + end), end], axis=1))
        some = between[:, 1] < onsets.max()
        rows, begin, end, between = rows[some], begin[some], end[some], between[some]
        falls = between[:, 2] < between[:, 0]
        # from the next ground below a falling gap, or above a rising one, on which sizes set in
        after = np.count_nonzero(starts[rows] <= begin[:, None], axis=1)
        start, sign = starts[rows, after - falls], np.where(falls, 1.0, -1.0)
        distances = np.stack([begin - start, end - start], axis=1) * sign[:, None]
        distances.sort(axis=1)
        root, weight = panel_rule(np.sqrt(np.maximum(distances, 0.0)), NODES)
        zeta = (start[:, None] + sign[:, None] * root**2).ravel()
        rows = np.repeat(rows, NODES)
        z = (zeta - self.mean) / self.width
        normal = np.exp(-0.5 * z * z) / (self.width * math.sqrt(2 * math.pi))
        gap = self._gap(h[rows], u[rows], zeta[:, None])[:, 0]
        return Nodes(rows, zeta, gap, (2 * root * weight).ravel() * normal)

    @cached_property
    def _places(self) -> tuple[Array, Array]:
        """Heights at which panels end at any ground, and between which ends are sought."""
        low, high = self.mean - DENSITY * self.width, self.mean + DENSITY * self.width
        fixed = self.mean + self.width * _fixed_ends()
        level = np.array([-HIGHEST_SEAT, HIGHEST_SEAT])
        fixed = np.sort(np.append(fixed, level[(level > low) & (level < high)]))
        return fixed, subdivide(fixed, width=GRID * self.width)

    def _turning_points(self, h: Array, u: Array) -> tuple[Array, Array, Array]:
        """Heights at which panels end (K,), and between which gaps only fall or rise: (N, M).

        Last those of widest and narrowest gaps (N, L), or the lowest in rows with fewer of them.
        """
        (fixed, grid), low = self._places, self.mean - DENSITY * self.width
        within = grid[np.abs(grid) <= HIGHEST_SEAT]  # beyond, gaps only fall

        def slope(u: Array, zeta: Array) -> Array:
            return heights_slope(u, zeta) - self.slope(zeta)

        slopes = slope(u, np.broadcast_to(within, (len(h), len(within))))
        rows, left = np.nonzero(slopes[:, 1:] * slopes[:, :-1] < 0)
        places = _zeros_by_chords(
            lambda at, zeta: slope(u[rows[at]], zeta[:, None])[:, 0],
            (within[left], within[left + 1]),
            (slopes[rows, left], slopes[rows, left + 1]),
            np.full(len(rows), LEVEL_OUT),
        )
        turns = _in_rows(rows, places, len(h), low)
        return fixed, _beside(np.broadcast_to(grid, (len(h), len(grid))), turns), turns

    def _heights_at(
        self, h: Array, u: Array, wanted: Array, grid: Array, beside: Array
    ) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
        """Heights ζ at which gaps over σ are wanted ones: row, which is wanted, and height (M,).

        From heights ``grid`` (N, M) with gaps ``beside``, between which gaps only fall or rise.
        """
        crossings = []
        for k, gap in enumerate(wanted):
            above = beside >= gap
            rows, cells = np.nonzero(above[:, 1:] != above[:, :-1])
            crossings.append([rows, cells, np.full(len(rows), k)])
        row, cell, want = np.concatenate(crossings, axis=1)

        def miss(at: NDArray[np.intp], zeta: Array) -> Array:
            n = row[at]
            return self._gap(h[n], u[n], zeta[:, None])[:, 0] - wanted[want[at]]

        places = _zeros_by_chords(
            miss,
            (grid[row, cell], grid[row, cell + 1]),
            (beside[row, cell] - wanted[want], beside[row, cell + 1] - wanted[want]),
            SET_IN * np.maximum(1.0, 0.1 * np.abs(h[row])),
        )
        order = np.argsort(row, kind="stable")
        return row[order], want[order], places[order]

    def sums(self, h: Array, u: Array) -> tuple[Array, Array]:
        """Columns per factor (N, 7), and the loads' moments (N, 13), at h (N,)."""
        nodes = self.nodes(h, u)
        values = np.maximum(self.average.average(nodes.gap / self.unit), 0.0)
        values *= nodes.weight[:, None]
        moments = np.empty((len(nodes.gap), MOMENTS + 1))
        x = np.clip(nodes.zeta, -HIGHEST_SEAT, HIGHEST_SEAT)
        before, now = np.zeros_like(x), values[:, 0]
        for n in range(MOMENTS + 1):
            moments[:, n] = now
            before, now = now, (x * now - math.sqrt(n) * before) / math.sqrt(n + 1)
        return nodes.sum_rows(values, len(h)), nodes.sum_rows(moments, len(h))

    def logarithms(self, h: Array, u: Array) -> Array:
        """ln of the load, not below `TINY`, and `pressure` over that on each area: (N, 7)."""
        values, _ = self.sums(h, u)
        load = np.maximum(values[:, :1], TINY)
        return np.hstack([np.log(load), self.pressure * values[:, 1:] / load])

    def shares(self, h: Array, u: Array, gaps: Array) -> Array:
        """Number of particles in each of these gaps over σ, which increase: (N, M).

        Those between two gaps count to both, by their distances: sums over what is linear in
        between are exact.
        """
        nodes = self.nodes(h, u)
        inside = (nodes.gap >= gaps[0]) & (nodes.gap <= gaps[-1])
        rows, gap, weight = nodes.rows[inside], nodes.gap[inside], nodes.weight[inside]
        after = np.clip(np.searchsorted(gaps, gap, side="right"), 1, len(gaps) - 1)
        share = (gap - gaps[after - 1]) / (gaps[after] - gaps[after - 1])
        out = np.zeros((len(h), len(gaps)))
        np.add.at(out, (rows, after - 1), weight * (1 - share))
        np.add.at(out, (rows, after), weight * share)
        return out
