"""Several objectives: points that no other beats, and how much of the plane they leave behind."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["front", "hypervolume"]

Array = NDArray[np.float64]


def front(costs: Array) -> NDArray[np.bool_]:
    """Mask (N,) of the points that no other beats, for costs (N, K).

    Examples
    --------
    >>> front(np.array([[1.0, 3.0], [2.0, 2.0], [3.0, 3.0]])).tolist()
    [True, True, False]
    """
    out = np.ones(len(costs), bool)
    for i, point in enumerate(costs):
        no_worse = np.all(costs <= point, axis=1)
        better = np.any(costs < point, axis=1)
        out[i] = not np.any(no_worse & better)
    return out


def hypervolume(costs: Array, reference: Array) -> float:
    """Volume of the costs that some point beats, up to a reference: larger is better.

    By slices along the last objective, exact.

    Examples
    --------
    >>> hypervolume(np.array([[1.0, 2.0], [2.0, 1.0]]), np.array([3.0, 3.0]))
    3.0
    """
    inside = costs[np.all(costs < reference, axis=1)]
    if not len(inside):
        return 0.0
    if costs.shape[1] == 1:
        return float(reference[0] - inside.min())
    inside = inside[np.argsort(inside[:, -1])]
    tops = np.append(inside[1:, -1], reference[-1])
    return sum(
        float(top - bottom) * hypervolume(inside[: i + 1, :-1], reference[:-1])
        for i, (bottom, top) in enumerate(zip(inside[:, -1], tops, strict=True))
        if top > bottom
    )
