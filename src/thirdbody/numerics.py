"""Quadrature panels, piecewise Chebyshev functions, and a safeguarded Halley root finder."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = [
    "PiecewiseChebyshev",
    "gauss_legendre",
    "halley_root",
    "in_pieces",
    "panel_rule",
    "subdivide",
]


@cache
def gauss_legendre(n: int) -> tuple[Array, Array]:
    """Nodes and weights of the n-point Gauss–Legendre rule on [−1, 1]."""
    nodes, weights = np.polynomial.legendre.leggauss(n)
    nodes.setflags(write=False)
    weights.setflags(write=False)
    return nodes, weights


def panel_rule(edges: Array, n: int) -> tuple[Array, Array]:
    """Nodes and weights of the composite Gauss rule over the panels between ``edges``.

    ``edges`` (..., B + 1) increase along the last axis; panels of zero width are allowed.
    Returns two arrays (..., B·n).
    """
    nodes, weights = gauss_legendre(n)
    half = 0.5 * (edges[..., 1:] - edges[..., :-1])[..., None]
    middle = 0.5 * (edges[..., 1:] + edges[..., :-1])[..., None]
    shape = (*edges.shape[:-1], -1)
    return (middle + half * nodes).reshape(shape), (half * weights).reshape(shape)


def subdivide(edges: Array, *, width: float, ratio: float = np.inf) -> Array:
    """Split panels until none is wider than ``width``, nor spans more than ``ratio``."""
    out = [edges[:1]]
    for a, b in zip(edges[:-1], edges[1:], strict=True):
        if b <= a:
            continue
        if a > 0 and b > a * ratio:
            parts = np.geomspace(a, b, int(np.ceil(np.log(b / a) / np.log(ratio))) + 1)
        else:
            parts = np.array([a, b])
        for left, right in zip(parts[:-1], parts[1:], strict=True):
            count = max(1, int(np.ceil((right - left) / width)))
            out.append(np.linspace(left, right, count + 1)[1:])
    return np.concatenate(out)


ONE_THREAD = 200_000
"""Multiplications of a product of matrices that BLAS does not share among threads: where it does,
last digits depend on how many there are."""


def in_pieces(rows: int, work: int) -> Iterator[slice]:
    """Slices of rows, of ``work`` multiplications each, whose products take one thread."""
    size = max(1, ONE_THREAD // work)
    for start in range(0, rows, size):
        yield slice(start, min(start + size, rows))


def chebyshev_transform(n: int) -> tuple[Array, Array]:
    """Chebyshev nodes (n,) on [−1, 1], and the matrix from values there to n coefficients."""
    theta = np.pi * (np.arange(n) + 0.5) / n
    transform = 2 / n * np.cos(np.arange(n)[:, None] * theta)
    transform[0] *= 0.5
    return np.cos(theta), transform


EPS, NOISE = float(np.finfo(float).eps), 1e-8
"""Of the size of a function: the most that rounding may leave in its last coefficients, where
the places at which it is taken are not themselves rounded by more of a panel."""
MOST_PANELS = 200
"""So many panels that still ask to be halved are noise, not structure."""


class PiecewiseChebyshev:
    """A vector function on [a, b], Chebyshev series between given breakpoints, split until exact.

    Parameters
    ----------
    function : callable
        Maps (N,) to (N, K).
    breakpoints : array
        Increasing; the function is smooth between neighbours.
    degree : int
        Degree of each series.
    tolerance : float
        Relative to the largest value of each column on a panel: panels are halved until the
        last coefficients fall below it.
    kinds : sequence of int, optional
        A number for each column. On a panel where a column stays below 1e-13 of the largest
        column of its kind, it does not ask for more panels.
    """

    def __init__(
        self,
        function: Callable[[Array], Array],
        breakpoints: Array,
        *,
        degree: int = 17,
        tolerance: float = 3e-14,
        max_depth: int = 12,
        kinds: Sequence[int] | None = None,
    ):
        n = degree + 1
        nodes, transform = chebyshev_transform(n)
        pending = [(a, b) for a, b in zip(breakpoints[:-1], breakpoints[1:], strict=True) if b > a]
        done: list[tuple[float, float, Array]] = []
        before = np.zeros((len(pending), 1))
        for depth in range(max_depth + 1):
            if not pending:
                break
            ends = np.array(pending)
            half, middle = 0.5 * (ends[:, 1] - ends[:, 0]), 0.5 * (ends[:, 1] + ends[:, 0])
            values = function((middle[:, None] + half[:, None] * nodes).ravel())
            coefs = np.einsum("ij,pjk->pik", transform, values.reshape(len(pending), n, -1))
            size = np.max(np.abs(values.reshape(len(pending), n, -1)), axis=1)
            tail = np.max(np.abs(coefs[:, -2:]), axis=1)
            largest = size
            if kinds is not None:
                largest = np.stack(
                    [size[:, np.equal(kinds, kind)].max(axis=1) for kind in kinds], axis=1
                )
            exact = (tail <= tolerance * size) | (size <= 1e-13 * largest) | (size < 1e-300)
            if depth:
                # of a panel halved, one half at least loses most of its tail, unless it is noise
                places = EPS * np.max(np.abs(ends), axis=1) / half
                noise = (tail >= 0.1 * before) & (tail <= np.fmax(NOISE, places)[:, None] * size)
                exact |= np.repeat(noise.reshape(-1, 2, noise.shape[1]).all(axis=1), 2, axis=0)
            good = np.all(exact, axis=1) | (depth == max_depth) | (len(pending) > MOST_PANELS)
            done += [(*pending[i], coefs[i]) for i in np.flatnonzero(good)]
            before = np.repeat(tail[~good], 2, axis=0)
            pending = [
                half_panel
                for i in np.flatnonzero(~good)
                for half_panel in (
                    (ends[i, 0], middle[i]),
                    (middle[i], ends[i, 1]),
                )
            ]
        done.sort(key=lambda panel: panel[0])
        self.edges = np.array([panel[0] for panel in done] + [done[-1][1]])
        self.half = 0.5 * np.diff(self.edges)
        self.middle = 0.5 * (self.edges[1:] + self.edges[:-1])
        self.coefficients = np.stack([panel[2] for panel in done])  # (P, n, K)
        slope = np.zeros((n, n))
        slope[:-1] = np.polynomial.chebyshev.chebder(np.eye(n))
        first = slope @ self.coefficients / self.half[:, None, None]
        second = slope @ first / self.half[:, None, None]
        self.with_derivatives = np.stack([self.coefficients, first, second], axis=-1)

    def _evaluate(self, x: Array, coefficients: Array) -> Array:
        """Σ_k T_k(s) c_k panel by panel: (N, ...) for coefficients (P, n, ...)."""
        panel = np.clip(np.searchsorted(self.edges, x, side="right") - 1, 0, len(self.half) - 1)
        order = np.argsort(panel.astype(np.int16), kind="stable")
        where = panel[order]
        s = (x[order] - self.middle[where]) / self.half[where]
        basis = np.empty((coefficients.shape[1], len(x)))
        basis[0], basis[1] = 1.0, s
        for k in range(2, len(basis)):
            np.multiply(s, basis[k - 1], out=basis[k])
            basis[k] *= 2
            basis[k] -= basis[k - 2]
        flat = coefficients.reshape(*coefficients.shape[:2], -1)
        sorted_values = np.empty((len(x), flat.shape[2]))
        starts = np.searchsorted(where, np.arange(len(self.half) + 1))
        for p in np.unique(where):
            mine = slice(starts[p], starts[p + 1])
            terms, values = basis[:, mine].T, sorted_values[mine]
            for part in in_pieces(len(values), flat[p].size):
                np.matmul(terms[part], flat[p], out=values[part])
        out = np.empty_like(sorted_values)
        out[order] = sorted_values
        return out.reshape(len(x), *coefficients.shape[2:])

    def __call__(self, x: Array) -> Array:
        """Values (N, K) at ``x`` (N,)."""
        return self._evaluate(x, self.coefficients)

    def derivatives(self, x: Array, columns: tuple[int, ...]) -> Array:
        """Value, first and second derivative of some columns: (N, len(columns), 3)."""
        return self._evaluate(x, self.with_derivatives[:, :, list(columns), :])


def halley_root(
    function: Callable[[Array, NDArray[np.intp]], tuple[Array, Array, Array]],
    low: Array,
    high: Array,
    start: Array,
    *,
    falling: bool = True,
    xtol: float = 1e-15,
    max_iterations: int = 80,
) -> tuple[Array, Array, Array]:
    """Roots of many scalar functions at once by Halley's method inside a bracket.

    Parameters
    ----------
    function : callable
        ``function(x, which)`` gives value and first two derivatives at ``x`` for the problems
        numbered ``which``.
    low, high, start : array (N,)
        Bracket and first guess.
    falling : bool
        The function is positive at ``low`` and negative at ``high``.
    xtol : float
        A problem is solved when its step is below ``xtol`` times the larger of |x| and the
        width of the first bracket.

    Returns
    -------
    root, residual, iterations : array (N,)

    Notes
    -----
    A step that leaves the bracket, or a bracket that does not halve in three steps, is replaced
    by bisection. The size of the step is tested before the bracket, so that a converged iterate
    is not thrown away.
    """
    sign = 1.0 if falling else -1.0
    x, lo, hi = start.copy(), low.copy(), high.copy()
    scale = np.maximum(hi - lo, np.maximum(np.abs(lo), np.abs(hi)))
    residual = np.full_like(x, np.nan)
    iterations = np.zeros(len(x), dtype=int)
    active = np.arange(len(x))
    for sweep in range(max_iterations):
        xa = x[active]
        f, f1, f2 = function(xa, active)
        residual[active] = f
        iterations[active] += 1
        positive = sign * f > 0
        lo[active] = np.where(positive, xa, lo[active])
        hi[active] = np.where(positive, hi[active], xa)
        with np.errstate(all="ignore"):
            newton = -f / f1
            correction = 1 + 0.5 * newton * f2 / f1
            step = newton / np.clip(correction, 0.5, 2.0)
            trial = xa + step
        solved = (np.abs(step) <= xtol * scale[active]) | (f == 0)
        a, b = lo[active], hi[active]
        inside = (trial > a) & (trial < b)
        if sweep % 4 == 3:
            # a safeguard against creeping: every fourth step may be a bisection
            creeping = (b - a) > 0.5 * scale[active]
            inside &= ~creeping | (np.abs(step) < 1e-3 * (b - a))
        bisected = 0.5 * (a + b)
        pinched = ~inside & (b - a <= 4 * np.spacing(np.maximum(np.abs(a), np.abs(b))))
        x[active] = np.where(
            solved | pinched,
            np.where(solved & inside, trial, xa),
            np.where(inside, trial, bisected),
        )
        active = active[~(solved | pinched)]
        if not len(active):
            break
    return x, residual, iterations
