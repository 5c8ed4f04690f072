"""Roots inside their brackets, many at a time."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["bracketed_root", "halley_root"]

MOST_HALVINGS = 2045
"""Octaves of floating point."""


def halley_root(
    function: Callable[[Array, NDArray[np.intp]], tuple[Array, Array, Array]],
    low: Array,
    high: Array,
    start: Array,
    *,
    falling: bool = True,
    xtol: float = 1e-15,
    max_iterations: int = 80,
) -> tuple[Array, Array, NDArray[np.intp]]:
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


def bracketed_root(
    function: Callable[..., Array],
    low: Array,
    high: Array,
    args: tuple[Array, ...] = (),
    *,
    xrtol: float = 1e-15,
) -> Array:
    """Roots of many scalar functions at once by Chandrupatla's method; NaN where no sign changes.

    Every number is that of `scipy.optimize.elementwise.find_root` with this relative tolerance of
    x and no other; that module takes longer to import than most contacts to solve.

    Parameters
    ----------
    function : callable
        ``function(x, *args)`` gives the values at ``x`` for the problems of these ``args``.
    low, high : array
        Brackets; they and ``args`` have one shape when broadcast.
    xrtol : float
        A problem is solved when its bracket is narrower than ``xrtol`` times its root.

    References
    ----------
    Chandrupatla 1997, Advances in Engineering Software 28, 145,
    doi:10.1016/S0965-9978(96)00051-8.
    """
    low, high, *args_ = np.broadcast_arrays(low, high, *args)
    f1, f2 = (np.ravel(np.asarray(function(x, *args_), dtype=float)) for x in (low, high))
    x1, x2 = (np.array(x, dtype=float).ravel() for x in (low, high))
    f1, f2, arguments = f1.copy(), f2.copy(), [arg.ravel() for arg in args_]
    root = np.full(x1.shape, np.nan)
    active = np.arange(x1.size)
    x3, f3 = x2, f2
    for turn in range(MOST_HALVINGS):
        nearer = np.abs(f1) < np.abs(f2)
        x, f = np.where(nearer, x1, x2), np.where(nearer, f1, f2)
        wrong = (np.sign(f1) == np.sign(f2)) | ~(np.isfinite(x1) & np.isfinite(x2))
        wrong |= np.isnan(f1) & np.isnan(f2)
        x = np.where(wrong & (f != 0), np.nan, x)
        width, least = np.abs(x2 - x1), np.abs(x) * xrtol
        done = (f == 0) | wrong | (width < least)
        root[active[done]] = x[done]
        go = ~done
        active = active[go]
        if not active.size:
            break
        x1, x2, x3, f1, f2, f3 = (array[go] for array in (x1, x2, x3, f1, f2, f3))
        width, least, arguments = width[go], least[go], [arg[go] for arg in arguments]
        t = np.full_like(x1, 0.5) if turn == 0 else _step(x1, x2, x3, f1, f2, f3, least / width)
        x = x1 + t * (x2 - x1)
        f = np.asarray(function(x, *arguments), dtype=float)
        same = np.sign(f) == np.sign(f1)
        x3, f3 = np.where(same, x1, x2), np.where(same, f1, f2)
        x2, f2 = np.where(same, x2, x1), np.where(same, f2, f1)
        x1, f1 = x, f
    return root.reshape(low.shape)


def _step(x1: Array, x2: Array, x3: Array, f1: Array, f2: Array, f3: Array, near: Array) -> Array:
    """Part of the bracket to go: inverse quadratic where that is safe, else half."""
    xi = (x1 - x2) / (x3 - x2)
    with np.errstate(divide="ignore", invalid="ignore"):
        phi = (f1 - f2) / (f3 - f2)
    alpha = (x3 - x1) / (x2 - x1)
    j = ((1 - np.sqrt(1 - xi)) < phi) & (phi < np.sqrt(xi))
    a, b, c = f1[j], f2[j], f3[j]
    t = np.full_like(alpha, 0.5)
    t[j] = a / (a - b) * c / (c - b) - alpha[j] * a / (c - a) * b / (b - c)
    edge = 0.5 * near
    return np.clip(t, edge, 1 - edge)
