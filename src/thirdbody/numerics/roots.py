"""Roots inside their brackets, many at a time."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["halley_root"]


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
