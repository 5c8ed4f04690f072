"""Pressures and forces between zero and what each can carry, with a sum that is prescribed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["pressures_with_sum", "rescale", "room"]

NEWTON, BALANCE = 30, 1e-14
"""Newton steps to the load before its corners are searched, and what of the load may be missing."""


def pressures_with_sum(moved: Array, tilt: Array, cap: Array, total: float) -> Array:
    """``moved`` + ν ``tilt`` so that the sum within the box is the total: Newton, then exactly."""
    scale = float(np.sum(tilt))
    if scale <= 0:
        return moved
    nu = 0.0
    for _ in range(NEWTON):
        now = moved + nu * tilt
        lack = total - float(np.sum(np.clip(now, 0.0, cap)))
        if abs(lack) <= BALANCE * abs(total):
            return now
        free = (now > 0) & (now < cap) if lack < 0 else (now >= 0) & (now < cap)
        slope = float(np.sum(tilt[free]))
        nu += lack / (slope if slope > 0 else scale)
    return moved + _level(moved, tilt, cap, total) * tilt


def _level(moved: Array, tilt: Array, cap: Array, total: float) -> float:
    """The ν at which Σ clip(moved + ν tilt, 0, cap), which rises in straight lines, is the total.

    Each pixel bends the line twice: where it leaves zero and where it reaches its cap.
    """
    moves = tilt > 0
    start, end = -moved[moves] / tilt[moves], (cap[moves] - moved[moves]) / tilt[moves]
    corners = np.unique(np.concatenate([start, end]))

    def load_at(nu: float) -> float:
        return float(np.sum(np.clip(moved + nu * tilt, 0.0, cap)))

    low, high = 0, len(corners) - 1
    while high - low > 1:
        middle = (low + high) // 2
        if load_at(float(corners[middle])) > total:
            high = middle
        else:
            low = middle
    below = load_at(float(corners[low]))
    rise = load_at(float(corners[high])) - below
    share = min(max((total - below) / rise, 0.0), 1.0) if rise > 0 else 0.0
    return float(corners[low] + share * (corners[high] - corners[low]))


def room(X: Array, s: Array, cap: Array) -> float:
    """The longest step along s inside the box, at least 1."""
    down, up = s < 0, s > 0
    ends = [math.inf]
    if np.any(down):
        ends.append(float(np.min(-X[down] / s[down])))
    if np.any(up):
        ends.append(float(np.min((cap[up] - X[up]) / s[up])))
    return max(1.0, min(ends))


def rescale(p: Array, phi: Array, c: Array, most: Array, total: float) -> tuple[Array, Array]:
    """The same pattern with the sum wanted: a common factor, within the box."""
    X, cap = np.concatenate([p.ravel(), phi]), np.concatenate([c.ravel(), most])
    factor = 1.0
    for _ in range(60):
        now = np.minimum(factor * X, cap)
        sum_now = float(np.sum(now))
        if abs(sum_now - total) <= 1e-12 * total:
            break
        free = now < cap
        rest = float(np.sum(now[free]))
        if rest <= 0:
            break
        above = sum_now > total  # where much is at its limit, the rest alone cannot give way
        factor *= total / sum_now if above else (total - sum_now + rest) / rest
    lack = total - float(np.sum(now))
    if abs(lack) > 1e-12 * total:  # what is left goes where there is room
        room = np.minimum(cap - now, total)
        now = now + lack * room / float(np.sum(room)) if lack > 0 else now * (1 + lack / sum_now)
    return now[: p.size].reshape(p.shape), now[p.size :]
