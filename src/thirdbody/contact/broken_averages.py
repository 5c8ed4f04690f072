r"""Averages over particles that break as the gap under them closes, and over their pieces.

In a gap g a broken particle of size y becomes pieces of size κy. There are

.. math:: n(y, g) = \varphi_a(y) + \chi\kappa^{-4}\,[1 - P_s(y/\kappa, g)]\,n(y/\kappa, g)

particles and pieces that have arrived at a size, and :math:`n P_s` of them are whole. Sums over
sizes that follow the pieces from one generation to the next weigh every size once. As σ̂ is the
largest tension of the way down, this is exact for gaps that only close and for pieces that break
independently.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..errors import InvalidValue, Mistake
from ..laws.base import COLUMNS, KINDS, OneParticle
from ..laws.particle.breakage import Breakage
from ..numerics.chebyshev import PiecewiseChebyshev
from ..numerics.quadrature import gauss_legendre
from ..populations.distributions import Distribution, Monodisperse
from .particle_averages import SEAT_NODES, SizeAverage, _cut, _distinct, _seat_rule

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..laws.spots import ParticleSpots

    Array = NDArray[np.float64]

__all__ = ["BrokenAverage", "Pieces", "broken_average", "is_rough", "roughly"]

NEGLIGIBLE = 1e-15
"""Part of the load that sizes may leave out."""
TOLERANCE, DEGREE, MOST_HALVINGS = 1e-10, 17, 8
"""Of the tables: relative to the largest value on a panel, of each series, and of a panel."""
MOST_GENERATIONS, MOST_STRETCHES, SMALLEST = 40, 80, 1e-60
"""Times that the smallest particle may break into pieces which break again, steps by the ratio of
pieces over all sizes, and size of pieces over the largest particle, that are followed."""
ENDLESS = (
    "the pieces of particles that break still break after {generations} generations, at {part:.2g} "
    "of the largest size, and no more are followed: give the size from which down nothing breaks "
    "(x_c of the strength, or K_c of the material), a larger size_exponent, a smaller ratio of "
    "pieces, or fragments = 'gone'"
)
TOO_ALIKE = (
    "pieces of {ratio:.6g} times the size of their parent take more than {most} generations over "
    "sizes from {part:.2g} of the largest on; use a smaller ratio, or narrower sizes"
)
AT_ONCE = 300_000
"""Sizes laid out together."""
NODES, SPOT_NODES, SPOT_GAPS = 16, 8, (10, 6)
"""Of a panel over sizes, for tables and for spots; of a panel over gaps, for spots."""


class Pieces(NamedTuple):
    """Sizes in gaps (N, n): what is there, and what was."""

    x: Array
    delta: Array
    number: Array
    """Whole particles and pieces."""
    parents: Array
    """Particles before any broke."""
    survival: Array
    """P_s of those that have arrived at the size."""


class BrokenAverage(SizeAverage):
    """Averages over particles that break, as `SizeAverage`: each column as a function of the gap.

    Tabulated between the gaps at which a size of particles or pieces with a jump in its number
    begins to be squeezed, each stretch in the root of the distance to its upper end.
    """

    tolerance, degree, halvings, panel_nodes = TOLERANCE, DEGREE, MOST_HALVINGS, NODES

    def __init__(self, particle: OneParticle, sizes: Distribution, breakage: Breakage):
        self.particle, self.sizes, self.breakage = particle, sizes, breakage
        self.tension = breakage.tension(particle)
        self.top = sizes.support[1]
        self.ratio = breakage.ratio if breakage.kept else 0.5
        """From one stretch of sizes to the next: that of the pieces, if they count."""
        self.kinks = np.array(sorted({*map(float, particle.kinks), *self.tension.kinks.tolist()}))
        last = self.kinks[-1]
        self.least = self._least()
        if self.least < self.top * self.ratio**MOST_STRETCHES:
            share, ratio = self.least / self.top, self.ratio
            raise InvalidValue(
                TOO_ALIKE.format(ratio=ratio, most=MOST_STRETCHES, part=share), code=Mistake.BEYOND
            )
        self.join = self.bottom = float(
            self.least * (1 - last) if last <= 1 else self.top * (1 - last)
        )
        edge = 0 if isinstance(sizes, Monodisperse) else 2
        load, area = (2 * power + edge for power in particle.onset)
        self.powers = np.array([load] + [area] * 5 + [float(edge)])
        jumps = self._jumps()
        self.ends = _distinct(
            np.array(sorted({self.bottom, *(x for x in jumps if x > self.bottom)}))
        )
        """Increasing gaps between which there is one table each."""
        gaps = {x * (1 - eps) for x in self._first(jumps) for eps in self.kinks}
        x = self.top
        while x > max(self.least, 1e-12 * self.top):
            x *= self.ratio
            gaps.add(x)
        self.inside = np.array(sorted(gaps))
        bottom = np.array([self.bottom])
        self.floor = self.average(bottom, self.top - bottom)[0]

    @cached_property
    def closed_area(self) -> float:
        """Area of all that is there where the gap closes, side by side, as round as it came.

        Pieces that are gone take none; what spreads as it is squashed may lie over others.
        """
        gap = np.array([[self.bottom]])
        pieces = self.pieces(gap, self.top - gap, nodes=self.panel_nodes, squeezes=self.squeezes)
        return 0.25 * math.pi * self.particle.breadth * float(np.sum(pieces.number * pieces.x**2))

    # ------------------------------------------------------------------ sizes
    def _least(self) -> float:
        """Size below which nothing bears: of particles, or the smallest pieces of theirs."""
        low, ratio = self.sizes.support[0], self.ratio
        if not isinstance(self.sizes, Monodisperse):
            least, whole = self.top, self.sizes.moment(2)
            while least > low and self.sizes.partial_moment(2, 0.0, least) > NEGLIGIBLE * whole:
                least *= min(ratio, 0.9)
            low = max(low, least)
        if self.breakage.kept == 0:
            return low
        gain = self.breakage.kept / ratio
        share, x = max(gain, 1.0) ** math.ceil(math.log(low / self.top) / math.log(ratio)), low
        generations = 0
        while share > NEGLIGIBLE and x > self.breakage.x_c:
            if (generations := generations + 1) > MOST_GENERATIONS or x < SMALLEST * self.top:
                raise InvalidValue(
                    ENDLESS.format(generations=generations - 1, part=x / self.top),
                    code=Mistake.BEYOND,
                )
            size, stress = np.array([x]), np.array([self.tension.greatest])
            share *= gain * float(1 - self.breakage.survival(size, stress)[0])
            x *= ratio
        # pieces of other sizes end within one more step, and none is below κ x_c
        return min(low, max(ratio * x, ratio * self.breakage.x_c))

    def _jumps(self) -> list[float]:
        """Sizes at which the number of particles or pieces jumps."""
        first_sizes = {float(x) for x in self.sizes.kinks}
        if self.breakage.x_c > 0:
            first_sizes.add(self.breakage.x_c)
        out = set()
        for size in first_sizes:
            x = size
            while x >= self.least * (1 - 1e-12):
                if x <= self.top:
                    out.add(x)
                if self.breakage.kept == 0:
                    break
                x *= self.breakage.ratio
        return sorted(out)

    def _first(self, jumps: list[float]) -> list[float]:
        """Sizes whose regimes are worth a panel of their own."""
        if isinstance(self.sizes, Monodisperse) or len(jumps) < 12:
            return jumps
        return [float(x) for x in self.sizes.kinks]

    @cached_property
    def squeezes(self) -> Array:
        """Squeezes between which response and survival are smooth and not steep."""
        return self._ladder(2 ** min(1.0, 6 / self.breakage.m))

    def _ladder(self, step: float) -> Array:
        """The kinks, and steps between those squeezes at which the largest particles break."""
        law, eps = self.breakage, np.geomspace(1e-9, 1.0, 400)
        with np.errstate(over="ignore"):
            broken = (self.tension(eps) / law.sigma * self.top**law.b) ** law.m
        begin = float(eps[np.argmax(broken > 1e-12)]) if np.any(broken > 1e-12) else 0.5
        rungs = begin * step ** np.arange(math.ceil(math.log(0.6 / begin) / math.log(step)) + 1)
        kinks = np.array(sorted({*self.kinks.tolist(), *map(float, self.particle.panels)}))
        near = np.min(np.abs(np.log(rungs[:, None] / kinks)), axis=1)
        rungs = rungs[near > 0.25 * math.log(step)]
        return np.sort(np.concatenate([kinks, rungs]))

    def pieces(
        self, gap: Array, rise: Array, splits: Sequence[float] = (), *, nodes: int, squeezes: Array
    ) -> Pieces:
        """Sizes of sums over what is in gaps (N, 1), with its numbers."""
        if not len(gap):
            return Pieces(*np.empty((len(Pieces._fields), 0, 0)))
        if isinstance(self.sizes, Monodisperse):
            return self._of_one_size(gap, rise)
        law, top, ratio = self.breakage, self.top, self.ratio
        shrink = math.log(ratio)
        lowest = np.maximum(gap, self.least)
        octaves = max(1, math.ceil(math.log(float(lowest.min()) / top) / shrink - 1e-9))
        # panels of one stretch of sizes, from which κ leads to the next: all edges folded into it
        eps = np.concatenate([squeezes, splits])
        eps = eps[eps < 1]
        of_eps = np.maximum(gap, 0.0) / (1 - eps)
        sizes = {float(x) for x in self.sizes.pieces} | ({law.x_c} if law.x_c > 0 else set())
        of_sizes = np.array(sorted(sizes))[None, :]
        edges = []
        for size, delta in (
            (of_eps, np.maximum(gap, 0.0) * eps / (1 - eps)),
            (np.broadcast_to(of_sizes, (len(gap), of_sizes.shape[1])), rise - (top - of_sizes)),
        ):
            with np.errstate(divide="ignore"):
                fold = np.floor(np.log(lowest / size) / shrink + 1e-13)
            inside = np.isfinite(fold) & (fold >= 0)
            fold = np.where(inside, fold, 0.0)
            folded = np.where(fold == 0, delta, size * ratio**fold - gap)
            edges.append(np.where(inside, folded, -np.inf))
        first, last = np.maximum(lowest - gap, 0.0), lowest / ratio - gap
        ends = np.concatenate([first, *edges, last], axis=1)
        ends = np.sort(np.clip(ends, first, last), axis=1)
        root = np.sqrt(ends)
        place, weight = gauss_legendre(nodes)
        half = 0.5 * np.diff(root, axis=1)[..., None]
        at = (root[:, :-1, None] + half * (1 + place)).reshape(len(gap), 1, -1)
        weight = 2 * at * (half * weight).reshape(len(gap), 1, -1)
        k = np.arange(octaves)[:, None]
        delta = at * at
        x = (gap[..., None] + delta) * ratio**-k
        delta = np.where(k == 0, delta, x - gap[..., None])
        weight = weight * ratio**-k
        used = x <= top
        survival = np.ones_like(x)
        chosen = x[used]
        survival[used] = law.survival(chosen, self.tension(delta[used] / chosen))
        density = np.zeros_like(x)
        density[used] = self.sizes.pdf(chosen)
        number = density.copy()
        gain = law.kept * ratio**-4
        for j in range(octaves - 2, -1, -1):
            number[:, j] += gain * (1 - survival[:, j + 1]) * number[:, j + 1]
        shape = (len(gap), -1)
        return Pieces(
            x=x.reshape(shape),
            delta=delta.reshape(shape),
            number=(weight * number * survival).reshape(shape),
            parents=(weight * density).reshape(shape),
            survival=survival.reshape(shape),
        )

    def _of_one_size(self, gap: Array, rise: Array) -> Pieces:
        """One generation a column."""
        law = self.breakage
        count = 1
        if law.kept:
            smallest = max(float(gap.min()), self.least)
            count = max(1, math.ceil(math.log(smallest / self.top) / math.log(law.ratio)) + 1)
        x = np.broadcast_to(self.top * law.ratio ** np.arange(count), (len(gap), count))
        delta = rise - (self.top - x)
        caught = delta > 0
        survival = np.ones_like(x)
        survival[caught] = law.survival(x[caught], self.tension(delta[caught] / x[caught]))
        number = np.empty_like(x)
        number[:, 0] = 1.0
        for j in range(1, count):
            gain = law.kept * law.ratio**-3
            number[:, j] = gain * number[:, j - 1] * (1 - survival[:, j - 1])
        parents = np.zeros_like(x)
        parents[:, 0] = 1.0
        return Pieces(
            x=x,
            delta=delta,
            number=np.where(caught, number * survival, 0.0),
            parents=np.where(caught, parents, 0.0),
            survival=survival,
        )

    # ------------------------------------------------------------------ the average
    def average(self, gap: Array, rise: Array) -> Array:
        """P(gap) by direct quadrature: (N, 7)."""
        out = np.empty((len(gap), len(COLUMNS)))
        order = np.argsort(-gap)
        panels = len(self.squeezes) + len(self.sizes.pieces) + 2
        start = 0
        while start < len(order):
            lowest = max(float(gap[order[start]]), self.least)
            octaves = 2 + math.log(lowest / self.top) / math.log(self.ratio)
            stop = start + max(1, int(AT_ONCE / (octaves * panels * self.panel_nodes)))
            rows = order[start:stop]
            pieces = self.pieces(
                gap[rows, None],
                rise[rows, None],
                nodes=self.panel_nodes,
                squeezes=self.squeezes,
            )
            used = (pieces.number > 0) & (pieces.delta > 0)
            values = np.zeros((*used.shape, len(COLUMNS)))
            values[used] = self.particle(pieces.delta[used] / pieces.x[used])
            out[rows] = np.einsum("gn,gnk->gk", pieces.number * pieces.x**2, values)
            start = stop
        return out

    @cached_property
    def tables(self) -> list[PiecewiseChebyshev]:
        """Tables of the stretches between `ends`, functions of u; the last over u^powers."""
        return [self._table(i) for i in range(len(self.ends) - 1)]

    def _table(self, i: int) -> PiecewiseChebyshev:
        low, high = self.ends[i : i + 2]
        inside = self.inside[(self.inside > low) & (self.inside < high)]
        edges = _distinct(np.sort(np.array([0.0, *np.sqrt(high - np.array([low, *inside]))])))
        last = i == len(self.ends) - 2

        def values(u: Array) -> Array:
            averages = self.average(high - u * u, (self.top - high) + u * u)
            return averages / u[:, None] ** self.powers if last else averages

        return PiecewiseChebyshev(
            values,
            edges,
            degree=self.degree,
            tolerance=self.tolerance,
            kinds=KINDS,
            max_depth=self.halvings,
        )

    @property
    def edges(self) -> Array:
        return np.concatenate(
            [high - table.edges**2 for table, high in zip(self.tables, self.ends[1:], strict=True)]
        )

    @property
    def onsets(self) -> Array:
        return self.ends[1:]

    def _stretches(self, gaps: Array) -> list[tuple[int, NDArray[np.intp]]]:
        """The stretches in which gaps lie, and which of the gaps."""
        where = np.clip(np.searchsorted(self.ends, gaps, side="right") - 1, 0, len(self.ends) - 2)
        return [(int(i), np.flatnonzero(where == i)) for i in np.unique(where)]

    def __call__(self, gaps: Array) -> Array:
        """P(g) from the tables: (N, 7)."""
        out = np.empty((len(gaps), len(COLUMNS)))
        for i, which in self._stretches(gaps):
            u = self._roots(i, gaps[which])
            out[which] = self.tables[i](u)
            if i == len(self.tables) - 1:
                out[which] *= u[:, None] ** self.powers
        out[gaps < self.bottom] = self.floor
        out[gaps >= self.top] = 0.0
        return np.maximum(out, 0.0)

    def _roots(self, i: int, gaps: Array) -> Array:
        return np.clip(np.sqrt(np.maximum(self.ends[i + 1] - gaps, 0.0)), 0.0,
                       self.tables[i].edges[-1])  # fmt: skip

    def derivatives(self, gaps: Array, columns: tuple[int, ...]) -> Array:
        """P, P′ and P″ of some columns: (N, len(columns), 3)."""
        out = np.empty((len(gaps), len(columns), 3))
        powers = self.powers[list(columns)]
        for i, which in self._stretches(gaps):
            table, u = self.tables[i], self._roots(i, gaps[which])
            last = i == len(self.tables) - 1
            v = np.maximum(u, 1e-60 if last else 1e-5 * table.edges[-1])[:, None]
            c = table.derivatives(v[:, 0], columns)
            p = powers if last else 0.0 * powers
            value, first, second = c[..., 0], c[..., 1], c[..., 2]
            lead = v**p
            du = lead * (first + p * value / v)
            ddu = lead * (second + 2 * p * first / v + p * (p - 1) * value / v**2)
            derivatives = np.stack(
                [lead * value, -du / (2 * v), (ddu - du / v) / (4 * v * v)], axis=-1
            )
            if last:
                derivatives[u == 0] = 0.0
            out[which] = derivatives
        below = gaps < self.bottom
        out[below] = 0.0
        out[below, :, 0] = self.floor[list(columns)]
        out[gaps >= self.top] = 0.0
        out[out[..., 0] <= 0.0] = 0.0  # rounding where nothing is whole
        return out

    # ------------------------------------------------------------------ seats and spots
    def nodes(self, width: float) -> tuple[Array, Array, Array]:
        """Gauss nodes in the gap, weights and P there, as of `SizeAverage`."""
        gaps, _, weights = self._of_stretches(
            [table.edges for table in self.tables], width, SEAT_NODES
        )
        return gaps, weights, self(gaps)

    def gaps(self, width: float, splits: Sequence[float] = ()) -> tuple[Array, Array, Array]:
        """Nodes without tables: gaps, x_max − gap, weights (M,)."""
        return self._of_stretches(self._roots_of_stretches(), 2 * width, SPOT_GAPS)

    def _roots_of_stretches(self) -> list[Array]:
        """Ends of panels of each stretch where there are no tables, as distances below its end."""
        edges = []
        for low, high in itertools.pairwise(self.ends):
            inside = self.inside[(self.inside > low) & (self.inside < high)]
            edges.append(_distinct(np.sort([0.0, *np.sqrt(high - np.array([low, *inside]))])))
        return edges

    def _of_stretches(
        self, edges: list[Array], width: float, nodes: tuple[int, int]
    ) -> tuple[Array, Array, Array]:
        gaps, rises, weights = [], [], []
        for high, roots in zip(self.ends[1:], edges, strict=True):
            u, weight = _seat_rule(_cut(roots**2, width) ** 0.5, width, np.square, nodes)
            gaps.append((high - u * u)[::-1])
            rises.append(((self.top - high) + u * u)[::-1])
            weights.append((2 * u * weight)[::-1])
        return np.concatenate(gaps), np.concatenate(rises), np.concatenate(weights)

    def spots_in(
        self,
        gap: Array,
        rise: Array,
        splits: Sequence[float],
        share: Array | None,
        weight: Array | float,
    ) -> ParticleSpots:
        """Spots of particles and pieces in gaps (M, 1), each gap counted with its weight."""
        ladder = self._ladder(4.0)
        pieces = self.pieces(gap, rise, splits, nodes=SPOT_NODES, squeezes=ladder)
        spots = self.particle.spots(
            pieces.x, np.maximum(pieces.delta, 0.0), share=share, number=pieces.number * weight
        )
        return replace(spots, parents=pieces.parents * weight, survival=pieces.survival)


class RoughBrokenAverage(BrokenAverage):
    """A coarser `BrokenAverage`: within 1e-3 of the load, mostly 1e-5, at a sixth of the cost.

    Under a rough seat that is narrow against the sizes it is read from a coarse table over gaps,
    under others summed at the few gaps there are.
    """

    tolerance, degree, halvings, panel_nodes = 1e-3, 7, 2, 6

    def nodes(self, width: float) -> tuple[Array, Array, Array]:
        """Gauss nodes in the gap, weights and P there."""
        edges = self._roots_of_stretches()
        gaps, rise, weights = self._of_stretches(edges, 2 * width, ROUGH_GAPS)
        dearer = len(gaps) > 2 * self.degree * sum(map(len, edges))
        values = self(gaps) if dearer else self.average(gaps, rise)
        return gaps, weights, np.maximum(values, 0.0)


ROUGH_GAPS = (14, 10)
"""Nodes of a panel over gaps where samples are summed roughly."""
_ROUGHLY: ContextVar[bool] = ContextVar("roughly", default=False)


@contextmanager
def roughly() -> Iterator[None]:
    """Context in which sums over breaking particles are good to 1e-3, for samples of many contacts.

    Sums over other particles stay as they are, but where the compiled engine estimates an error
    above 1e-9: up to 1e-6 does. Particles on one field of heights are solved to that by it, and
    states of one contact side by side share what they can.
    """
    before = _ROUGHLY.set(True)
    try:
        yield
    finally:
        _ROUGHLY.reset(before)


def is_rough() -> bool:
    """Whether sums are asked `roughly` at present."""
    return _ROUGHLY.get()


def broken_average(particle: OneParticle, sizes: Distribution, breakage: Breakage) -> BrokenAverage:
    """The cached average: one for equal particles of equal sizes and strength."""
    kind = RoughBrokenAverage if is_rough() else BrokenAverage
    return _broken_average(kind, particle, sizes, breakage)


@lru_cache(maxsize=128)
def _broken_average(
    kind: type[BrokenAverage], particle: OneParticle, sizes: Distribution, breakage: Breakage
) -> BrokenAverage:
    return kind(particle, sizes, breakage)
