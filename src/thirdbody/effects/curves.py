r"""How an output of one particle grows with its squeeze, and the squeezes at which it has a value.

A particle of size x squeezed by ε = δ/x has the value :math:`v = x^p f(\varepsilon)`, p = 1 for a
length and 0 for a ratio. f is tabulated between the squeezes at which a formula changes, until the
squeeze that is read back for a value has that value to 1e-8. It may jump, and fall: the squeezes
with larger values are those on one side of it in every run along which f rises or falls.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["Curve"]

LEAST = 1e-13
"""Smallest squeeze of a table."""
NEAR = 1e-13
"""Part of a stretch by which its ends stay off the squeezes where formulas change."""
NEAREST = 1e-12
"""Part of a squeeze by which two where formulas change differ; nearer ones are one."""
CLOSE = 1e-8
"""Relative error of a value at the squeeze that is read for it."""
ROUNDS, MOST = 60, 20_000
"""Times that a table is refined, and its most nodes."""
SAME = 1e-12
"""Change of a value v that is rounding, over √(v v_max): values set in as small differences."""
SMALL = 1e-12
"""Of the largest value: smaller ones are not told apart."""


@dataclass(frozen=True, eq=False)
class _Run:
    """A stretch of squeezes along which f only rises, or only falls."""

    ends: tuple[float, float]
    """ε from, to; infinite for the last."""
    rises: bool
    roots: Array
    """√f at the nodes, increasing; twice the same where f is constant or ε jumps."""
    cubics: Array
    """ε between a node and the next (n − 1, 4): coefficients in the part of the way."""

    @property
    def low(self) -> float:
        return float(self.roots[0] ** 2)

    @property
    def high(self) -> float:
        return float(self.roots[-1] ** 2)

    def squeeze(self, f: Array) -> Array:
        """Squeeze ε at which f passes a value; the end of the run if f never does."""
        begin, end = self.ends if self.rises else self.ends[::-1]
        out = np.where(f < self.low, begin, _read_cubics(self.roots, self.cubics, np.sqrt(f)))
        return np.where(f >= self.high, end, out)


class Curve:
    """f(ε) of one particle, and the squeezes with larger values.

    Parameters
    ----------
    f : callable
        Values ≥ 0 (N,) at squeezes (N,).
    kinks : sequence of float
        ε at which f may jump or bend; beyond four times the last, and 4, it is constant.
    power : {0, 1}
        p of the size in a value.
    """

    def __init__(self, f: Callable[[Array], Array], kinks: Sequence[float], power: int = 1):
        self.power = power
        edges = [LEAST]
        for kink in sorted((1.0, *map(float, kinks))):
            if kink > edges[-1] * (1 + NEAREST):
                edges.append(kink)
        edges.append(4 * edges[-1])
        top = float(np.max(f(np.array(edges))))
        eps, values = _tabulate_curve(f, np.array(edges), top)
        seams = np.searchsorted(eps, edges)[1:-1]
        self.runs = tuple(_runs(eps, values, seams))
        end_values = [values[0], values[-1], *values[seams - 1], *values[seams]]
        end_values += [end for run in self.runs for end in (run.low, run.high)]
        seam_values = np.unique([end for end in end_values if end > 0])
        self.seams = seam_values[np.diff(seam_values, prepend=-1.0) > CLOSE * seam_values]
        """Values at which the squeeze of a value may jump or bend."""
        self.top = float(np.max(values))

    def stretches(self, f: Array) -> Iterator[tuple[Array | float, Array | float]]:
        """Between which ε f is larger than this, two ends for every run; equal where nowhere."""
        for run in self.runs:
            at, (begin, end) = run.squeeze(f), run.ends
            yield (at, end) if run.rises else (begin, at)

    def first(self, f: Array) -> Array:
        """Smallest ε above which f exceeds the value; infinite if f never does."""
        out = np.full_like(f, np.inf)
        for begin, end in reversed(tuple(self.stretches(f))):
            out = np.where(np.less(begin, end), begin, out)
        return out


def _tabulate_curve(f: Callable[[Array], Array], edges: Array, top: float) -> tuple[Array, Array]:
    """Squeezes between edges, dense where f bends, and f there; no cubic crosses an edge."""
    eps = np.concatenate([_first_nodes(a, b) for a, b in pairwise(edges)])
    values = np.maximum(f(eps), 0.0)
    open_ = np.ones(len(eps) - 1, dtype=bool)
    open_[np.searchsorted(eps, edges[1:-1]) - 1] = False
    for _ in range(ROUNDS):
        starts = np.searchsorted(eps, edges)
        at = np.flatnonzero(open_)
        mine = np.searchsorted(starts, at, side="right") - 1
        few = np.diff(starts)[mine] <= MOST
        at, mine = at[few], mine[few]
        if not len(at):
            break
        begin, end, low, high = eps[at], eps[at + 1], values[at], values[at + 1]
        middle = 0.5 * (begin + end)
        at_middle = np.maximum(f(middle), 0.0)
        with np.errstate(all="ignore"):
            read = np.empty_like(at_middle)
            for way in (1, -1):
                here = way * (high - low) > 0
                nearest = np.clip(at[here] - 1, starts[mine[here]], starts[mine[here] + 1] - 4)
                read[here] = _read_between(
                    eps, way * np.sqrt(values), at[here], nearest, way * np.sqrt(at_middle[here])
                )
            miss = np.abs(read - middle) / (end - begin) * np.abs(high - low) / at_middle
        turns = (high - at_middle) * (at_middle - low) < 0
        flat = np.maximum(np.abs(high - at_middle), np.abs(at_middle - low)) <= _rounding(
            at_middle, top
        )
        flat |= np.maximum(high, at_middle) <= SMALL * top
        narrow = end - begin <= 1e-15 * end
        good = flat | narrow | (~turns & (miss <= CLOSE))
        eps, values = np.insert(eps, at + 1, middle), np.insert(values, at + 1, at_middle)
        # every middle is kept, and both halves of what was not good are looked at again
        open_ = np.zeros(len(eps) - 1, dtype=bool)
        place = at + np.arange(len(at))
        open_[place], open_[place + 1] = ~good, ~good
    return eps, values


def _first_nodes(a: float, b: float) -> Array:
    """Squeezes between a and b, dense near both."""
    step = np.geomspace(NEAR, 0.5, 28) * (b - a)
    eps = np.unique(np.concatenate([a + step, b - step, np.geomspace(a, b, 16)[1:-1]]))
    return eps[(eps > a) & (eps < b)]


def _rounding(values: Array, top: float) -> Array:
    return SAME * np.sqrt(values * max(top, 0.0))


def _read_between(
    eps: Array, roots: Array, at: NDArray[np.intp], nearest: NDArray[np.intp], wanted: Array
) -> Array:
    """ε of wanted roots in intervals ``at``, by cubics through four nodes from ``nearest`` on."""
    start = nearest[:, None] + np.arange(4)
    return _horner(_cubics(roots[start], eps[start], at - start[:, 0]), roots, at, wanted)


def _cubics(roots: Array, eps: Array, place: NDArray[np.intp]) -> Array:
    """Coefficients (n, 4) of ε over the way from node ``place`` of four (n, 4) to the next.

    Where the four are no increasing row, of the straight line between the two.
    """
    row = np.arange(len(roots))
    here, step = roots[row, place], roots[row, place + 1] - roots[row, place]
    a, b = eps[row, place], eps[row, place + 1]
    with np.errstate(all="ignore"):
        u = (roots - here[:, None]) / step[:, None]
        good = np.all(np.diff(u, axis=1) > 0, axis=1) & (np.abs(u).max(axis=1) < 1e6)
    straight = np.stack([a, b - a, 0 * a, 0 * a], axis=1)
    # divided differences, then powers of u
    out = straight
    n, e = u[good], eps[good].copy()
    for k in (1, 2, 3):
        e[:, k:] = (e[:, k:] - e[:, k - 1 : -1]) / (n[:, k:] - n[:, : 4 - k])
    p = np.zeros((len(n), 4))
    p[:, 0] = e[:, 3]
    for k in (2, 1, 0):
        shifted = np.roll(p, 1, axis=1)
        shifted[:, 0] = 0.0
        p = shifted - n[:, k : k + 1] * p
        p[:, 0] += e[:, k]
    out[good] = p
    return out


def _horner(cubics: Array, roots: Array, at: NDArray[np.intp], wanted: Array) -> Array:
    step = roots[at + 1] - roots[at]
    u = np.divide(wanted - roots[at], step, out=np.ones_like(wanted), where=step > 0)
    u = np.clip(u, 0.0, 1.0)
    a, b, c, d = np.moveaxis(cubics, -1, 0)
    out = a + u * (b + u * (c + u * d))
    far = a + b + c + d
    return np.clip(out, np.minimum(a, far), np.maximum(a, far))


def _read_cubics(roots: Array, cubics: Array, wanted: Array) -> Array:
    at = np.clip(np.searchsorted(roots, wanted, side="right") - 1, 0, len(roots) - 2)
    return _horner(cubics[at], roots, at, wanted)


def _runs(eps: Array, values: Array, seams: NDArray[np.intp]) -> Iterator[_Run]:
    """The stretches along which f rises or falls; of where it is 0 none is made."""
    change = np.diff(values)
    top = float(np.max(values))
    change[np.abs(change) <= _rounding(np.maximum(values[1:], values[:-1]), top)] = 0.0
    way = np.sign(change)
    moving = np.flatnonzero(way)
    if not len(moving) and values[0] == 0:
        return
    turns = np.flatnonzero(np.diff(way[moving]))
    # a value that is constant at first belongs to what follows; of one that stays so all is a run
    first = int(moving[0]) if values[0] == 0 else 0
    starts = [first, *(int(moving[i + 1]) for i in turns)]
    ways = [way[moving[0]] if len(moving) else 1.0, *(way[start] for start in starts[1:])]
    stops = [*starts[1:], len(eps) - 1]
    for start, stop, rising in zip(starts, stops, ways, strict=True):
        rises = bool(rising > 0)
        nodes = slice(start, stop + 1)
        last = stop == len(eps) - 1
        ends = (float(eps[start]), np.inf if last else float(eps[stop]))
        inner_seams = seams[(seams > start) & (seams <= stop)] - start
        yield _run(eps[nodes], np.sqrt(values[nodes]), inner_seams, ends, rises)


def _run(
    eps: Array, roots: Array, seams: NDArray[np.intp], ends: tuple[float, float], rises: bool
) -> _Run:
    group = np.zeros(len(eps), dtype=int)
    group[seams] = 1
    group = np.cumsum(group)
    if not rises:
        eps, roots, group = eps[::-1], roots[::-1], group[::-1]
    roots = np.maximum.accumulate(roots)
    # of nodes with one value the first and the last: ε jumps there
    new = np.diff(roots) > 0
    keep = np.append(True, new) | np.append(new, True)
    eps, roots, group = eps[keep], roots[keep], group[keep]
    at = np.arange(len(eps) - 1)
    jumps = (np.diff(roots) == 0) | (np.diff(group) != 0)
    block = np.append(0, np.cumsum(jumps))
    first = np.searchsorted(block, block[:-1], side="left")
    behind = np.searchsorted(block, block[:-1], side="right")
    start = np.clip(at - 1, first, np.maximum(behind - 4, first))
    few = (behind - first < 4) | jumps
    start = np.where(few, np.clip(at - 1, 0, max(len(eps) - 4, 0)), start)
    cubics = np.stack([eps[:-1], np.diff(eps), 0 * at, 0 * at], axis=1)
    if len(eps) >= 4:
        stencil = start[:, None] + np.arange(4)
        new_cubics = _cubics(roots[stencil], eps[stencil], at - start)
        cubics[~few] = new_cubics[~few]
    return _Run(ends, rises, roots, cubics)
