r"""Groups of particles laid out for one question: fragments, and dents from a depth on.

Sums over sizes and gaps are exact where panels end at every jump of what is summed. Fragments of
one size are particles of one size, beside those that were smaller and stay whole. A depth δ_0 from
which dents count is passed by particles of size x at the squeezes where :math:`x f(\varepsilon) =
\delta_0`; in a gap g that is at :math:`f(\varepsilon)/|1-\varepsilon| = \delta_0/|g|`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from ..contact.particle_averages import SeatAverage, SizeAverage
from ..numerics.roots import bracketed_root
from ..populations.distributions import Distribution, Monodisperse
from ..quantities.carried import takes_units

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike, NDArray

    from ..laws.base import OneParticle
    from ..laws.spots import Layout, ParticleSpots

    Array = NDArray[np.float64]

__all__ = ["Passage", "lay_out_again"]

LEAST, FAR = 1e-12, 1e9
"""Smallest and largest squeeze at which a depth is looked for."""
OFF = 1e-14
"""Part of a squeeze by which nodes stay off where a formula changes."""
QUANTILES = (1e-6, 1e-3, 0.15, 0.5, 0.85, 0.999, 1 - 1e-6)
"""Part of the particles below sizes whose passage of a depth ends a panel over gaps."""
NONE = 1.0
"""Squeeze in place of none: no size has it in a gap that is open, or closed."""


@dataclass(frozen=True)
class SizesUpTo(Distribution):
    """The particles of a distribution up to one size, by number."""

    whole: Distribution
    largest: float

    @cached_property
    def share(self) -> float:
        """Part of the particles that are so small."""
        return float(self.whole.partial_moment(0, -1.0, self.largest))

    @property
    def support(self) -> tuple[float, float]:
        return self.whole.support[0], self.largest

    def pdf(self, x: ArrayLike) -> Array:
        x = np.asarray(x, dtype=float)
        return np.where(x <= self.largest, self.whole.pdf(x), 0.0) / self.share

    def pdf_below(self, depth: Array) -> Array:
        return self.whole.pdf_below(depth + (self.whole.support[1] - self.largest)) / self.share

    def ppf(self, q: ArrayLike) -> Array:
        return np.clip(self.whole.ppf(np.asarray(q, dtype=float) * self.share), *self.support)

    def partial_moment(self, n: int, a: ArrayLike, b: ArrayLike) -> Array:
        return self.whole.partial_moment(n, a, np.minimum(b, self.largest)) / self.share

    def multiply_sizes(self, factor: float) -> SizesUpTo:
        return SizesUpTo(self.whole.scaled(factor), factor * self.largest)

    def scale_and_shape(self) -> tuple[float, Distribution]:
        scale, shape = self.whole.standardised()
        return scale, SizesUpTo(shape, self.largest / scale)

    scaled, standardised = multiply_sizes, scale_and_shape

    @property
    def pieces(self) -> tuple[float, ...]:
        return (*(x for x in self.whole.pieces if x < self.largest), self.largest)

    @property
    def kinks(self) -> tuple[float, ...]:
        return (*(x for x in self.whole.kinks if x < self.largest), self.largest)


class Passage:
    """Squeezes at which particles pass a depth.

    Parameters
    ----------
    depth : callable
        f(ε) ≥ 0 of particles of unit size (N,).
    kinks : sequence of float
        ε at which f jumps or bends.
    """

    def __init__(self, depth: Callable[[Array], Array], kinks: Sequence[float]):
        self.depth = depth
        inside = np.unique([LEAST, 1.0, *(e for e in kinks if LEAST < e < FAR), FAR])
        self.kinks = inside[np.append(np.diff(inside) > 4 * OFF * inside[1:], True)]
        self.eps = np.concatenate([_nodes_between(a, b) for a, b in pairwise(self.kinks)])
        self.values = depth(self.eps)

    def of_size(self, ratio: float) -> Array:
        """Squeezes at which f is δ_0/x."""
        at = np.flatnonzero(np.diff(self.values > ratio))
        return self._solve(at, np.full(len(at), ratio), np.ones_like)

    def in_gaps(self, ratio: Array) -> Array:
        """Squeezes (N, k) at which particles in gaps pass it, of g/δ_0 (N,); `NONE` for fewer."""
        out = np.full((len(ratio), 0), NONE)
        for closed in (False, True):
            rows = np.flatnonzero(ratio < 0 if closed else ratio > 0)
            here = self.eps > 1 if closed else self.eps < 1
            first = int(np.argmax(here))
            size = 1 / np.abs(1 - self.eps[here])
            above = self.values[here] * size * np.abs(ratio[rows, None]) > 1
            row, at = np.nonzero(np.diff(above, axis=1))
            wanted = 1 / np.abs(ratio[rows[row]])
            roots = self._solve(at + first, wanted, lambda eps: 1 / np.abs(1 - eps))
            place = np.arange(len(row)) - np.searchsorted(row, row)
            more = int(place.max(initial=-1)) + 1 - out.shape[1]
            if more > 0:
                out = np.concatenate([out, np.full((len(out), more), NONE)], axis=1)
            out[rows[row], place] = roots
        return out

    def _solve(self, at: NDArray[np.intp], wanted: Array, size: Callable[[Array], Array]) -> Array:
        """ε between nodes ``at`` and the next at which f times a size is what is wanted (n,)."""
        if not len(at):
            return np.empty(0)
        low, high = self.eps[at], self.eps[at + 1]
        way = np.where(self.values[at + 1] * size(high) > wanted, 1.0, -1.0)

        def excess(eps: Array, wanted: Array, way: Array) -> Array:
            return way * (self.depth(eps) * size(eps) / wanted - 1)

        root = bracketed_root(excess, low, high, (wanted, way))
        return np.where(np.isnan(root), low, root)  # within rounding of a node

    def gaps_of_bends(self, depth: float, sizes: tuple[float, float]) -> Array:
        """Gaps in which the size that has the depth is at a bend of f, if there are such sizes."""
        near = np.concatenate([self.kinks * (1 - 2 * OFF), self.kinks * (1 + 2 * OFF)])
        values = self.depth(near)
        x = np.divide(depth, values, out=np.full_like(values, np.inf), where=values > 0)
        good = (x >= sizes[0]) & (x <= sizes[1])
        return x[good] * (1 - near[good])


def _nodes_between(a: float, b: float) -> Array:
    """Squeezes between two, dense near both."""
    low, high = a * (1 + OFF), b * (1 - OFF)
    step = np.geomspace(1e-12, 0.5, 40) * (high - low)
    even = np.geomspace(low, high, 24)
    eps = np.unique(np.concatenate([low + step, high - step, even, [low, high]]))
    return eps[(eps >= low) & (eps <= high)]


class _FromDepths(SizeAverage):
    """An average over sizes that ends panels where dents pass depths."""

    def __init__(
        self, one: OneParticle, sizes: Distribution, passages: Sequence[Passage], depth: float
    ):
        super().__init__(one, sizes)
        self.passages, self.depth = passages, depth

    def gaps_at(self, splits: Sequence[float]) -> Array:
        more = [SizeAverage.gaps_at(self, splits)]
        for passage in self.passages:
            more.append(passage.gaps_of_bends(self.depth, self.sizes.support))
            for x in np.unique([*self.sizes.kinks, *self.sizes.ppf(QUANTILES)]):
                if x > 0:
                    more.append(x * (1 - passage.of_size(self.depth / x)))
        return np.concatenate(more)

    def of_sizes(
        self, gap: Array, rise: Array, splits: Sequence[float] | Array = (), nodes: int = 16
    ) -> tuple[Array, Array, Array]:
        every = [passage.in_gaps(gap[:, 0] / self.depth) for passage in self.passages]
        of_all = np.broadcast_to(np.asarray(splits, dtype=float), (len(gap), len(splits)))
        return super().of_sizes(gap, rise, np.concatenate([of_all, *every], axis=1), nodes)


@takes_units
def lay_out_again(
    spots: ParticleSpots,
    one: OneParticle,
    splits: Sequence[float],
    *,
    fragment: float | None = None,
    passages: Sequence[Passage] = (),
    depth: float = 0.0,
) -> list[ParticleSpots]:
    """The particles of a group with a layout, laid out anew.

    Parameters
    ----------
    spots : ParticleSpots
    one : OneParticle
    splits : sequence of float
        Squeezes ε at which what is asked jumps or bends.
    fragment : float, optional
        Size x_f to which larger ones are broken, each into (x/x_f)³ [m].
    passages : sequence of Passage, optional
        Of a depth that is passed; it is ``depth`` [m].
    """
    layout = spots.layout
    assert layout is not None
    out = []
    for sizes, weight in _parts(layout, fragment):
        average: SizeAverage = SizeAverage(one, sizes)
        if passages and depth > 0:
            average = _FromDepths(one, sizes, passages, depth / layout.scale)
        if layout.means is None:
            again = average.spots(layout.gaps / layout.scale, splits)
        else:
            seats = SeatAverage(average, layout.width / layout.scale)
            again = seats.spots(layout.means / layout.scale, splits)
        again = again.of_size(layout.scale, weight)
        states = len(layout.gaps if layout.means is None else layout.means)
        again = again.thin_spots(np.broadcast_to(np.asarray(layout.density, float), (states,)))
        out.append(replace(again, material=spots.material, population=spots.population))
    return out


def _parts(layout: Layout, fragment: float | None) -> list[tuple[Distribution, float]]:
    """Sizes and how many particles have them for one of the layout: whole ones, fragments."""
    sizes = layout.sizes
    low, high = sizes.support
    if fragment is None or fragment >= layout.scale * high:
        return [(sizes, 1.0)]
    cut = fragment / layout.scale
    pieces = float(sizes.partial_moment(3, cut, high)) / cut**3
    parts: list[tuple[Distribution, float]] = [(Monodisperse(mean=cut), pieces)]
    if cut > low:
        smaller = SizesUpTo(sizes, cut)
        if smaller.share > 0:
            parts.append((smaller, smaller.share))
    return parts
