"""Averages of one particle over sizes and over seats, tabulated once and shared."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np
from scipy import special

from ..laws.base import COLUMNS, KINDS, OneParticle
from ..laws.spots import Layout, ParticleSpots
from ..numerics.chebyshev import PiecewiseChebyshev
from ..numerics.products import in_pieces
from ..numerics.quadrature import gauss_legendre, panel_rule, subdivide
from ..populations.distributions import Distribution, Monodisperse

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["WIDEST", "SeatAverage", "SizeAverage", "seat_average", "size_average"]


class SizeAverage:
    r"""The particle response averaged over sizes, as a function of the gap under it.

    .. math:: P(g) = \int_g^\infty \varphi_a(x)\, x^2\,\hat q\!\left(\frac{x-g}{x}\right) dx

    Tabulated once per particle and shape of the distribution as Chebyshev series between
    the gaps where a size or a regime sets in: in the gap itself for small gaps, and in
    :math:`u=\sqrt{x_{max}-g}` near the largest size, where P sets in like a power of u.
    Lengths are those of the standardised distribution.
    """

    def __init__(self, particle: OneParticle, sizes: Distribution):
        self.particle, self.sizes = particle, sizes
        low, self.top = sizes.support
        last = particle.kinks[-1]
        self.bottom = low * (1 - last) if last <= 1 else self.top * (1 - last)
        # leading powers of u as the last particle loses contact
        edge = 0 if isinstance(sizes, Monodisperse) else 2
        load, area = (2 * power + edge for power in particle.onset)
        self.powers = np.array([load] + [area] * 5 + [float(edge)])
        self.join = self.bottom
        if 0.5 * self.top - self.bottom > 1e-12 * self.top:  # a sliver is rounding
            self.join = 0.5 * self.top
        gaps = [x * (1 - eps) for x in sizes.kinks for eps in (0.0, *particle.kinks)]
        gaps += [x * f for x in sizes.pieces for f in (0.25, 0.5) if x > 1e-4 * self.top]
        breakpoints = np.array(sorted({g for g in gaps if self.bottom < g < self.top}))
        rise = np.sqrt(self.top - np.array([self.join, *breakpoints[breakpoints > self.join]]))
        self.rises = _distinct(np.array([0.0, *np.sort(rise)]))
        """Breakpoints in u above the join."""
        self.gaps_below = np.empty(0)
        """Breakpoints in the gap below the join, if there are gaps."""
        if self.bottom < self.join:
            below = [self.bottom, *breakpoints[breakpoints < self.join], self.join]
            self.gaps_below = _distinct(np.array(below))

    @cached_property
    def floor(self) -> Array:
        """P where the gap squeezes every particle as far as it goes: (7,)."""
        bottom = np.array([self.bottom])
        return np.asarray(self.average(bottom, self.top - bottom)[0])

    @cached_property
    def upper(self) -> PiecewiseChebyshev:
        """P/u^powers as a function of u, above the join."""
        return PiecewiseChebyshev(self._reduced_columns, self.rises, tolerance=1e-13, kinds=KINDS)

    @cached_property
    def lower(self) -> PiecewiseChebyshev | None:
        """P as a function of the gap, below the join."""
        if not len(self.gaps_below):
            return None
        return PiecewiseChebyshev(
            lambda g: self.average(g, self.top - g),
            self.gaps_below,
            tolerance=1e-13,
            kinds=KINDS,
        )

    def _reduced_columns(self, u: Array) -> Array:
        return self.average(self.top - u * u, u * u) / u[:, None] ** self.powers

    def average(self, gap: Array, rise: Array) -> Array:
        """P(gap) by direct quadrature: (N, 7). Panels in √δ, split at every regime.

        ``rise`` = x_max − gap is given beside the gap because near the largest size the gap
        alone would lose it to rounding.
        """
        if isinstance(self.sizes, Monodisperse):
            return self.sizes.mean**2 * self.particle(rise / self.sizes.mean)
        out = np.empty((len(gap), len(COLUMNS)))
        for rows in np.array_split(np.arange(len(gap)), max(1, len(gap) // 200)):
            out[rows] = self._average(gap[rows, None], rise[rows, None])
        return out

    def of_sizes(
        self, gap: Array, rise: Array, splits: Sequence[float] | Array = (), nodes: int = 16
    ) -> tuple[Array, Array, Array]:
        """Diameters, squeezes and weights φ_a(x) dx of sums over sizes: (N, n) for (N, 1).

        ``splits`` are those of all gaps, or of each (N, k).
        """
        particle, sizes = self.particle, self.sizes
        if isinstance(sizes, Monodisperse):
            return np.full_like(gap, sizes.mean), rise, (rise > 0).astype(float)
        low, high = sizes.support
        pieces = np.array(sizes.pieces)
        # sizes are counted from `zero`, the largest of them where they lie close together, so
        # that their densities and how far they lie apart keep all digits; edges of panels
        # likewise, or where sizes begin to be squeezed from the gap, as squeezes δ
        close = low > 0.5 * high
        zero = high if close else 0.0
        gap_at = -rise if close else gap
        start = rise <= 2 * (high - low)
        above = np.where(gap > 0.5 * high, rise - (high - pieces), pieces - gap)
        of_sizes = np.where(start, above, pieces - zero)
        # where a regime of some size sets in: δ = εx, so x = g/(1 − ε), which must be positive
        more = np.atleast_2d(np.asarray(splits, dtype=float))
        of_particle = np.broadcast_to(particle.panels, (len(more), len(particle.panels)))
        eps = np.concatenate([of_particle, more], axis=1)
        whole = eps == 1
        gap_ratio = np.where(whole, 1.0, 1 - eps)
        of_regimes = gap / gap_ratio - zero
        if close:
            of_regimes = np.where(gap > 0.5 * high, (high * eps - rise) / gap_ratio, of_regimes)
        of_regimes = np.where(start, gap * eps / gap_ratio, of_regimes)
        edges = np.concatenate([of_sizes, np.where(whole, -np.inf, of_regimes)], axis=1)
        first = np.maximum(of_sizes[:, :1], np.where(start, 0.0, gap_at))
        edges = np.sort(np.clip(edges, first, of_sizes[:, -1:]), axis=1)
        # Gauss panels in √δ, in which the response is smooth where it sets in
        begin, end = _drop_empty_panels(edges)
        root, last = (
            np.sqrt(np.maximum(np.where(start, ends, ends - gap_at), 0.0)) for ends in (begin, end)
        )
        sums = last + root
        step = np.divide(end - begin, sums, out=np.zeros_like(sums), where=sums > 0)
        x, weight = gauss_legendre(nodes)
        from_edge = 0.5 * step[..., None] * (1 + x)
        root = root[..., None]
        place = begin[..., None] + from_edge * (2 * root + from_edge)
        root = root + from_edge
        weight = root * step[..., None] * weight
        root, place, weight = (
            values.reshape(len(gap), math.prod(values.shape[1:]))
            for values in (root, place, weight)
        )
        place = np.where(start, place + gap_at, place)
        diameter = np.clip(zero + place, low, high)
        density = sizes.pdf_below(-place) if close else sizes.pdf(diameter)
        return diameter, root * root, density * weight

    def _average(self, gap: Array, rise: Array) -> Array:
        diameter, delta, weight = self.of_sizes(gap, rise)
        density = weight * diameter**2
        used = density > 0
        values = np.zeros((*density.shape, len(COLUMNS)))
        values[used] = self.particle(delta[used] / diameter[used])
        return np.einsum("gn,gnk->gk", density, values)

    def __call__(self, gaps: Array) -> Array:
        """P(g) from the tables: (N, 7)."""
        u = np.sqrt(np.maximum(self.top - gaps, 0.0))
        values = self.upper(np.minimum(u, self.upper.edges[-1])) * u[:, None] ** self.powers
        if self.lower is not None and np.any(low := gaps < self.join):
            values[low] = self.lower(np.maximum(gaps[low], self.bottom))
        values[gaps < self.bottom] = self.floor
        values[gaps >= self.top] = 0.0
        return values

    def direct(self, gaps: Array) -> Array:
        """P(g) by quadrature, without tables: (N, 7)."""
        out = np.zeros((len(gaps), len(COLUMNS)))
        out[gaps < self.bottom] = self.floor
        here = (gaps >= self.bottom) & (gaps < self.top)
        if here.any():
            out[here] = np.maximum(self.average(gaps[here], self.top - gaps[here]), 0.0)
        return out

    @property
    def particles(self) -> SizeAverage:
        """The average over sizes itself, of one over seats too."""
        return self

    def load_in_gaps(self, gaps: Array, narrow: float) -> Array:
        """The load of P(g) where the gap is narrower than this, else 0: (N,)."""
        return np.where(gaps < narrow, self(gaps)[:, 0], 0.0)

    def part_in_gaps(self, gaps: Array, narrow: float) -> Array:
        """Part of the particles in gaps narrower than this: (N,)."""
        return np.where(gaps < narrow, 1.0, 0.0)

    def touching(self, gaps: Array) -> Array:
        """Part of the particles that is larger than gaps (N,), by number."""
        top = np.nextafter(self.top, np.inf)
        return np.asarray(self.sizes.partial_moment(0, np.nextafter(gaps, np.inf), top))

    def derivatives(self, gaps: Array, columns: tuple[int, ...]) -> Array:
        """P, P′ and P″ of some columns: (N, len(columns), 3)."""
        u = np.sqrt(np.maximum(self.top - gaps, 0.0))
        v = np.clip(u, 1e-60, self.upper.edges[-1])[:, None]
        c = self.upper.derivatives(v[:, 0], columns)
        p = self.powers[list(columns)]
        value, first, second = c[..., 0], c[..., 1], c[..., 2]
        lead = v**p
        # with respect to u, then dg = −2u du
        du = lead * (first + p * value / v)
        ddu = lead * (second + 2 * p * first / v + p * (p - 1) * value / v**2)
        out = np.empty_like(c)
        out[..., 0] = lead * value
        out[..., 1] = -du / (2 * v)
        out[..., 2] = (ddu - du / v) / (4 * v * v)
        out[u == 0] = 0.0
        if self.lower is not None and np.any(low := gaps < self.join):
            out[low] = self.lower.derivatives(np.maximum(gaps[low], self.bottom), columns)
        below = gaps < self.bottom
        out[below] = 0.0
        out[below, :, 0] = self.floor[list(columns)]
        return out

    def nodes(self, width: float) -> tuple[Array, Array, Array]:
        """Gauss nodes in the gap, weights and P there, for sums over a seat of this width.

        The panels of the tables, cut where they are wider than the seat: increasing gaps (M,),
        weights (M,), values (M, 7).
        """
        lower = None if self.lower is None else self.lower.edges
        gaps, rise, weights = self._gaps(self.upper.edges, lower, width, SEAT_NODES)
        values = np.empty((len(gaps), len(COLUMNS)))
        upper = gaps >= self.join
        u = np.sqrt(rise[upper])
        values[upper] = self.upper(u) * u[:, None] ** self.powers
        if self.lower is not None:
            values[~upper] = self.lower(gaps[~upper])
        return gaps, weights, values

    def gaps(self, width: float, splits: Sequence[float] = ()) -> tuple[Array, Array, Array]:
        """Nodes without tables: gaps, x_max − gap, weights (M,); relative error 1e-9.

        ``splits`` are more values of ε at which sums over gaps have a kink.
        """
        # without a gap particles of every size are squeezed by ε = 1: up to their middles
        more = np.append(self.gaps_at(splits), 0.0)
        more = more[(more > self.bottom) & (more < self.top)]
        upper = np.sqrt(self.top - more[more > self.join])
        lower = None
        if len(self.gaps_below):
            lower = _distinct(np.sort([*self.gaps_below, *more[more < self.join]]))
        upper = _distinct(np.sort([*self.rises, *upper]))
        return self._gaps(upper, lower, _step(self.sizes, width), SPOT_NODES)

    def gaps_at(self, splits: Sequence[float]) -> Array:
        """Gaps that squeeze particles of the sizes at kinks by these ε."""
        return np.array([x * (1 - eps) for x in self.sizes.kinks for eps in splits])

    def _gaps(
        self, upper: Array, lower: Array | None, width: float, nodes: tuple[int, int]
    ) -> tuple[Array, Array, Array]:
        """Nodes on panels between edges in u and, below the join, in the gap."""
        u, weight = _seat_rule(_cut(upper**2, width) ** 0.5, width, np.square, nodes)
        rise, weights = u * u, 2 * u * weight
        if lower is not None:
            g, weight = _seat_rule(_cut(lower, width), width, np.asarray, nodes)
            rise = np.concatenate([rise, self.top - g[::-1]])
            weights = np.concatenate([weights, weight[::-1]])
        return self.top - rise[::-1], rise[::-1], weights[::-1]

    def spots(self, gap: Array, splits: Sequence[float] = ()) -> ParticleSpots:
        """Spots of all particles squeezed in gaps (N,), resting on a plane."""
        spots = self.spots_in(gap[:, None], self.top - gap[:, None], splits, None, 1.0)
        return self.laid_out(spots, gap)

    def laid_out(
        self, spots: ParticleSpots, gaps: Array, means: Array | None = None, width: float = 0.0
    ) -> ParticleSpots:
        """Spots with their sizes and gaps, for whole particles only."""
        if spots.parents is not None:
            return spots
        layout = Layout(sizes=self.sizes, x=spots.x, gaps=gaps, means=means, width=width)
        return replace(spots, layout=layout)

    def spots_in(
        self,
        gap: Array,
        rise: Array,
        splits: Sequence[float],
        share: Array | None,
        weight: Array | float,
    ) -> ParticleSpots:
        """Spots of all particles in gaps (M, 1), each gap counted with its weight."""
        x, delta, number = _drop_empty_nodes(*self.of_sizes(gap, rise, splits, SIZE_NODES))
        return self.particle.spots(x, np.maximum(delta, 0.0), share=share, number=number * weight)

    @property
    def edges(self) -> Array:
        """Ends of the panels of the tables, as gaps."""
        below = self.lower.edges if self.lower is not None else np.empty(0)
        return np.concatenate([below, self.top - self.upper.edges**2])

    @property
    def onsets(self) -> Array:
        """Gaps in the root of the distance to which the columns are smooth below."""
        return np.array([self.top])


def _drop_empty_panels(edges: Array) -> tuple[Array, Array]:
    """Begin and end of panels between increasing edges (N, B + 1), as many as most rows have.

    Rows in which fewer have room end with some that have none.
    """
    begin, end = edges[:, :-1], edges[:, 1:]
    empty = end == begin
    most = int(np.max(np.count_nonzero(~empty, axis=1), initial=0))
    if most == begin.shape[1]:
        return begin, end
    order = np.argsort(empty, axis=1, kind="stable")[:, :most]
    return np.take_along_axis(begin, order, axis=1), np.take_along_axis(end, order, axis=1)


def _drop_empty_nodes(x: Array, delta: Array, number: Array) -> tuple[Array, Array, Array]:
    """The same without nodes that stand for nothing, on panels that have no room in their row.

    Rows with fewer nodes than others repeat their last one, for nothing.
    """
    used = number > 0
    count = used.sum(axis=1, keepdims=True)
    if (most := int(count.max(initial=0))) == number.shape[1]:
        return x, delta, number
    place = np.arange(most)
    order = np.argsort(~used, axis=1, kind="stable")
    order = np.take_along_axis(order, np.clip(count - 1, 0, place), axis=1)
    x, delta, number = (np.take_along_axis(values, order, axis=1) for values in (x, delta, number))
    return x, delta, np.where(place < count, number, 0.0)


def _seat_rule(
    edges: Array, width: float, gap: Callable[[Array], Array], nodes: tuple[int, int]
) -> tuple[Array, Array]:
    """Gauss rule over panels, of fewer nodes where the seat is wide against a panel."""
    narrow = np.abs(np.diff(gap(edges))) < 0.25 * width
    ends = [0, *(np.flatnonzero(np.diff(narrow)) + 1), len(narrow)]
    rules = [
        panel_rule(edges[a : b + 1], nodes[int(narrow[a])]) for a, b in itertools.pairwise(ends)
    ]
    places, weights = zip(*rules, strict=True)
    return np.concatenate(places), np.concatenate(weights)


def _distinct(edges: Array) -> Array:
    """Increasing edges without the slivers that rounding leaves between equal ones."""
    wide = np.diff(edges) > 1e-12 * np.max(np.abs(edges))
    return np.append(edges[:-1][wide], edges[-1])


def _cut(edges: Array, width: float) -> Array:
    return np.concatenate([edges[:1], subdivide(edges, width=width)[1:]])


@lru_cache(maxsize=256)
def size_average(particle: OneParticle, sizes: Distribution) -> SizeAverage:
    """The cached size average: one for equal particles of equal sizes."""
    return SizeAverage(particle, sizes)


@lru_cache(maxsize=64)
def larger_ones(sizes: Distribution, width: float) -> tuple[Array, Array]:
    """Gaps (M,), and the part of particles larger than each, by number, weighed for a seat.

    Of sizes alone: it serves every law and material.
    """
    low, top = sizes.support
    gaps = {low, *sizes.kinks, *(x * share for x in sizes.pieces for share in (0.25, 0.5, 1.0))}
    rise = np.sqrt(np.sort([top - gap for gap in gaps if low <= gap < top]))
    rule = panel_rule(_cut(_distinct(np.append(0.0, rise)) ** 2, _step(sizes, width)) ** 0.5, 14)
    places = top - rule[0] ** 2
    larger = sizes.partial_moment(0, np.nextafter(places, np.inf), np.nextafter(top, np.inf))
    return places, 2 * rule[0] * rule[1] * larger / (width * math.sqrt(2 * math.pi))


def _step(sizes: Distribution, width: float) -> float:
    """Width of panels over gaps: nothing changes faster than the seat and the sizes together."""
    m1, m2 = (float(sizes.partial_moment(k, -1.0, np.inf)) for k in (1, 2))
    spread = math.sqrt(max(m2 - m1 * m1, 0.0))
    if spread > 1e-6 * m1:
        return SMOOTH_WIDTHS * width * spread / math.hypot(width, spread)
    return SPOT_WIDTHS * width


class SeatAverage:
    """A size average over a Gaussian seat of some width; lengths in the size of the particles.

    The average over seats is a sum over local gaps weighted with the density of ζ, tabulated
    once as Chebyshev series in the mean gap.
    """

    def __init__(self, average: SizeAverage, width: float):
        self.average, self.width, self.particle = average, width, average.particle
        self.low = average.bottom - NORMAL_REACH * width
        self.high = average.top + NORMAL_REACH * width

    @property
    def floor(self) -> Array:
        """The columns where every particle is squeezed as far as it goes: (7,)."""
        return self.average.floor

    @cached_property
    def nodes(self) -> tuple[Array, Array]:
        """Gaps, and the weighted columns there."""
        gaps, weight, values = self.average.nodes(self.width)
        return gaps, weight[:, None] * values / (self.width * math.sqrt(2 * math.pi))

    @property
    def edges(self) -> Array:
        """Ends of the panels of the table, as mean gaps."""
        return self.table.edges

    @cached_property
    def table(self) -> PiecewiseChebyshev:
        """Every column as a function of the mean gap."""
        panels = min(math.ceil((self.high - self.low) / (3 * self.width)), 32)
        return PiecewiseChebyshev(
            self._over_seats,
            np.linspace(self.low, self.high, panels + 1),
            tolerance=1e-12,
            max_depth=20,
            kinds=KINDS,
        )

    def _over_seats(self, mean_gap: Array) -> Array:
        """The columns averaged over seats by quadrature: (N, 7)."""
        gaps, weights = self.nodes
        z = (self.average.bottom - mean_gap) / self.width
        out = special.ndtr(z)[:, None] * self.floor
        order = np.argsort(mean_gap)
        # mean gaps that share no local gap are summed apart
        apart = np.diff(mean_gap[order]) > 2 * NORMAL_REACH * self.width
        for close in np.split(order, np.flatnonzero(apart) + 1):
            for piece in in_pieces(len(close), weights[:1000].size):
                rows = close[piece]
                lowest, highest = mean_gap[rows[0]], min(mean_gap[rows[-1]], gaps[-1])
                near = slice(
                    np.searchsorted(gaps, min(lowest, highest) - 2 * NORMAL_REACH * self.width),
                    np.searchsorted(gaps, highest + NORMAL_REACH * self.width),
                )
                z = (mean_gap[rows, None] - gaps[near]) / self.width
                out[rows] += np.exp(-0.5 * z * z) @ weights[near]
        return out

    def _within_reach(self, gaps: Array, mean_gap: Array) -> NDArray[np.bool_]:
        """Which local gaps count at one of the mean gaps at least."""
        reach = NORMAL_REACH * self.width
        means = np.append(np.sort(mean_gap), np.inf)
        return means[np.searchsorted(means, gaps - reach)] <= gaps + reach

    def __call__(self, gap: Array) -> Array:
        """Every column: (N, 7)."""
        low, high = self.low, self.high
        out = self.table(np.clip(gap, low, high))
        out[gap > high] = 0.0
        out[gap < low] = self.floor
        return out

    def direct(self, mean_gap: Array) -> Array:
        """Every column by quadrature over sizes and seats, without tables: (N, 7)."""
        average = self.average
        out = special.ndtr((average.bottom - mean_gap) / self.width)[:, None] * self.floor
        gaps, rise, weights = average.gaps(self.width)
        near = self._within_reach(gaps, mean_gap)
        gaps, rise, weights = gaps[near], rise[near], weights[near]
        if not len(gaps):
            return out
        values = weights[:, None] * average.average(gaps, rise)
        z = (mean_gap[:, None] - gaps) / self.width
        return out + np.exp(-0.5 * z * z) @ values / (self.width * math.sqrt(2 * math.pi))

    def touching(self, mean_gap: Array) -> Array:
        """Part of the particles that is larger than the gap it lies in, by number: (N,)."""
        average = self.average
        if isinstance(average.sizes, Monodisperse):
            return special.ndtr((average.top - mean_gap) / self.width)
        gaps, values = larger_ones(average.sizes, self.width)
        z = (mean_gap[:, None] - gaps) / self.width
        # every one in gaps below the first
        low = average.sizes.support[0]
        return special.ndtr((low - mean_gap) / self.width) + np.exp(-0.5 * z * z) @ values

    @property
    def particles(self) -> SizeAverage:
        """The average over sizes of which this is the average over seats."""
        return self.average

    def load_in_gaps(self, mean_gap: Array, narrow: float) -> Array:
        """The load at mean gaps from those seats alone in which the gap is narrower: (N,)."""
        gaps, weights = self.nodes
        out = self.floor[0] * self.part_in_gaps(mean_gap, min(narrow, self.average.bottom))
        below = (gaps < narrow) & self._within_reach(gaps, mean_gap)
        z = (mean_gap[:, None] - gaps[below]) / self.width
        return out + np.exp(-0.5 * z * z) @ weights[below, 0]

    def part_in_gaps(self, mean_gap: Array, narrow: float) -> Array:
        """Part of the seats in which the gap is narrower than this: (N,)."""
        return special.ndtr((narrow - mean_gap) / self.width)

    def spots(self, mean_gap: Array, splits: Sequence[float] = ()) -> ParticleSpots:
        """Every squeezed particle at mean gaps (N,)."""
        average = self.average
        gaps, rise, weights = average.gaps(self.width, splits)
        lowest = mean_gap.min() - NORMAL_REACH * self.width
        if lowest < average.bottom:
            # loads no longer change there, but depths do
            ends = np.concatenate([average.gaps_at(splits), self._closed_gaps(splits)])
            ends = np.append(ends[(ends > lowest) & (ends < average.bottom)], [lowest, 0.0])
            edges = _distinct(np.sort(np.append(np.minimum(ends, average.bottom), average.bottom)))
            edges = _cut(edges[edges >= lowest], SPOT_WIDTHS * self.width)
            below, weight = panel_rule(edges, SPOT_NODES[0])
            gaps = np.concatenate([below, gaps])
            rise = np.concatenate([average.top - below, rise])
            weights = np.concatenate([weight, weights])
        near = self._within_reach(gaps, mean_gap)
        gaps, rise, weights = gaps[near], rise[near], weights[near]
        if (open_gaps := self._over_squeezes(mean_gap, splits)) is not None:
            return self._spots_by_squeeze(open_gaps, mean_gap, splits, (gaps, rise, weights))
        share = self._density_of_seats(gaps, mean_gap)
        spots = average.spots_in(gaps[:, None], rise[:, None], splits, share, weights[:, None])
        return average.laid_out(spots, gaps, mean_gap, self.width)

    def _density_of_seats(self, gaps: Array, mean_gap: Array) -> Array:
        """Part of the seats with a local gap, per gap, at mean gaps (N,): (N, M)."""
        z = (mean_gap[:, None] - gaps) / self.width
        return np.exp(-0.5 * z * z) / (self.width * math.sqrt(2 * math.pi))

    def _over_squeezes(
        self, mean_gap: Array, splits: Sequence[float]
    ) -> tuple[Array, Array, Array] | None:
        """Diameters, squeezes ε and weights (M,) of sums over open gaps for few states.

        A regime begins at one ε whatever the size, so that panels of sizes and of ε end nowhere
        else; in rows of gaps they do for every size at which the density jumps, but many states
        share a row. None where rows of gaps take less time; both sums are to 1e-9 of the load.
        """
        average = self.average
        sizes, (low, top) = average.sizes, average.sizes.support
        step = SPOT_WIDTHS * self.width
        plain = type(average) is SizeAverage and not isinstance(sizes, Monodisperse)
        if not plain or len(mean_gap) > FEW or top > MOST * step:
            return None
        marks = np.unique([0.0, *average.particle.panels, *splits, 1.0])
        edges = subdivide(_distinct(marks[(marks >= 0) & (marks <= 1)]), width=step / top)
        # densities keep all digits by how far sizes are from the largest
        narrow = low > 0.5 * top
        pieces = top - np.array(sizes.pieces)[::-1] if narrow else np.array(sizes.pieces)
        places = subdivide(_distinct(pieces), width=step)
        if SPOT_SQUEEZES * len(edges) * SPOT_SIZES * len(places) > MOST:
            return None
        # ends like powers of a root: there regimes set in, or end
        nodes, weights = gauss_legendre(SPOT_SQUEEZES)
        angle = 0.25 * np.pi * (1 + nodes)
        squeezed = (edges[:-1, None] + np.diff(edges)[:, None] * np.sin(angle) ** 2).ravel()
        of_eps = (0.25 * np.pi * np.diff(edges)[:, None] * np.sin(2 * angle) * weights).ravel()
        place, of_sizes = panel_rule(places, SPOT_SIZES)
        x = top - place if narrow else place
        of_sizes = of_sizes * (sizes.pdf_below(place) if narrow else sizes.pdf(place))
        every = np.broadcast_arrays(x, squeezed[:, None], of_eps[:, None] * (x * of_sizes))
        x, eps, weight = (values.ravel() for values in every)
        near = self._within_reach(x * (1 - eps), mean_gap)
        return x[near], eps[near], weight[near]

    def _spots_by_squeeze(
        self,
        open_gaps: tuple[Array, Array, Array],
        mean_gap: Array,
        splits: Sequence[float],
        rule: tuple[Array, Array, Array],
    ) -> ParticleSpots:
        """Spots in open gaps by their squeeze, and in closed ones by rows of the rule of gaps."""
        (x, eps, number), (gaps, rise, weights) = open_gaps, rule
        delta, gap = eps * x, x * (1 - eps)
        if np.any(closed := gaps < 0):
            sizes, squeeze, weight = self.average.of_sizes(
                gaps[closed, None], rise[closed, None], splits, SIZE_NODES
            )
            used = weight > 0
            rows = np.broadcast_to(gaps[closed, None], weight.shape)[used]
            x, delta = np.append(x, sizes[used]), np.append(delta, squeeze[used])
            number = np.append(number, (weight * weights[closed, None])[used])
            gap = np.append(gap, rows)
        share = self._density_of_seats(gap, mean_gap)
        spots = self.average.particle.spots(
            x[:, None], np.maximum(delta, 0.0)[:, None], share=share, number=number[:, None]
        )
        return self.average.laid_out(spots, gap, mean_gap, self.width)

    def _closed_gaps(self, splits: Sequence[float]) -> Array:
        """Negative gaps, dense near none, and where splits cross the bulk of the sizes.

        A squeeze above 1 is one of sizes in proportion to the gap: sums over sizes then change
        as fast as these lie close together, however wide the seat is. Panels halve towards none
        from as wide as elsewhere to the size of the particles.
        """
        low, high = self.average.sizes.ppf(np.array([1e-9, 1 - 1e-9]))
        pieces = [x for x in self.average.sizes.pieces if low <= x <= high]
        widest = SPOT_WIDTHS * self.width
        near = -widest * 0.5 ** np.arange(max(1.0, math.log2(widest)))
        return np.concatenate([near, *(np.multiply(pieces, 1 - eps) for eps in splits if eps > 1)])

    def derivatives(self, gap: Array, columns: tuple[int, ...]) -> Array:
        """Some columns with two derivatives: (N, len(columns), 3)."""
        low, high = self.low, self.high
        out = self.table.derivatives(np.clip(gap, low, high), columns)
        out[gap > high] = 0.0
        out[gap < low] = 0.0
        out[gap < low, :, 0] = self.floor[list(columns)]
        return out


@lru_cache(maxsize=512)
def seat_average(average: SizeAverage, width: float) -> SeatAverage:
    """The cached average over seats."""
    return SeatAverage(average, width)


NORMAL_REACH = 9.0
"""Standard deviations of the seat beyond which nothing is counted."""
SEAT_NODES = (14, 10)
"""Nodes of a panel in the gap as wide as the seat, and of a much narrower one."""
SPOT_NODES, SPOT_WIDTHS, SMOOTH_WIDTHS, SIZE_NODES = (14, 12), 2.0, 4.6, 10
"""The same for spots, whose sums need 1e-9 of the load; width of their panels over that of the seat
under particles of one size, and over that of seat and sizes together; nodes of sizes."""
SPOT_SQUEEZES, SPOT_SIZES, MOST, FEW = 16, 10, 70_000, 16
"""Nodes of a panel of squeezes, and of sizes, where sums are over both; how many in all at most,
and for how many states."""
WIDEST = 1e5
