"""Gauss-Legendre quadrature, on panels."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["gauss_legendre", "panel_rule", "subdivide"]


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
    shape = (*edges.shape[:-1], (edges.shape[-1] - 1) * len(nodes))
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
