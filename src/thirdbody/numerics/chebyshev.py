"""Functions as Chebyshev series, piece by piece."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from .products import in_pieces

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["PiecewiseChebyshev"]


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
        panel = self.edges[1:-1].searchsorted(x, side="right")
        order = panel.astype(np.int16).argsort(kind="stable")
        where = panel[order]
        s = (x[order] - self.middle[where]) / self.half[where]
        basis = np.empty((coefficients.shape[1], len(x)))
        basis[0], basis[1] = 1.0, s
        s += s
        for before, last, term in zip(basis, basis[1:], basis[2:], strict=False):
            np.multiply(s, last, out=term)
            term -= before
        flat = coefficients.reshape(*coefficients.shape[:2], -1)
        sorted_values = np.empty((len(x), flat.shape[2]))
        ends = [*(np.flatnonzero(where[1:] != where[:-1]) + 1).tolist(), len(x)] if len(x) else []
        for start, end in zip([0, *ends], ends, strict=False):
            mine, p = slice(start, end), where[start]
            terms, values = basis[:, mine].T, sorted_values[mine]
            for rows in in_pieces(len(values), flat[p].size):
                np.matmul(terms[rows], flat[p], out=values[rows])
        out = np.empty_like(sorted_values)
        out[order] = sorted_values
        return out.reshape(len(x), *coefficients.shape[2:])

    def __call__(self, x: Array) -> Array:
        """Values (N, K) at ``x`` (N,)."""
        return self._evaluate(x, self.coefficients)

    def derivatives(self, x: Array, columns: tuple[int, ...]) -> Array:
        """Value, first and second derivative of some columns: (N, len(columns), 3)."""
        return self._evaluate(x, self.with_derivatives[:, :, list(columns), :])
