"""Quadrature rules over the sizes of particles, and over the gaps of rough seats under them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache, partial
from typing import TYPE_CHECKING

import numpy as np

from ...contact.particle_averages import SizeAverage
from ...errors import NotCompiled
from ...numerics.quadrature import panel_rule, subdivide
from ...populations.distributions import NORMAL_CUT, Distribution, Monodisperse, TruncatedGaussian
from .inputs import size_factor

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["FEW_SIZES", "MOST_WIDTHS", "densest", "few_on_seats", "seat_rule", "size_rules"]

FEW_SIZES = 0.55
"""Share of the sizes with which a sum comes close enough to a root."""
MOST_WIDTHS = 2_000.0
"""Widths of the seat over which nodes are laid."""


@lru_cache(maxsize=128)
def densest(shape: Distribution) -> float:
    """The most of x²φ(x), nearly; infinite where all are of one size."""
    if isinstance(shape, Monodisperse):
        return math.inf
    x, _ = panel_rule(np.array(shape.pieces), 12)
    return float(np.max(x**2 * shape.pdf(x)))


@lru_cache(maxsize=128)
def seat_rule(average: SizeAverage, octave: int) -> Array:
    """Weighted columns and gaps for seats of 2^octave to 2^(octave + 1) in the size."""
    if average.top - average.bottom > MOST_WIDTHS * 2.0**octave:
        raise NotCompiled("the seat is too smooth for shared nodes")
    gaps, weight, values = average.nodes(1.25 * 2.0**octave)
    return np.vstack([weight * values.T, gaps])


@lru_cache(maxsize=128)
def few_on_seats(average: SizeAverage, octave: int) -> Array:
    """As `seat_rule`, with nodes enough to come close to a root."""
    depth = subdivide(np.array([0.0, average.top - average.bottom]), width=0.75 * 2.0**octave)
    u, weight = panel_rule(np.sqrt(depth), 6)
    gaps = average.top - u[::-1] ** 2
    return np.vstack([(2 * u * weight)[::-1] * average(gaps).T, gaps])


def size_rules(
    base: Distribution, varied: Distribution, arrays: Mapping[str, Array], count: int
) -> Iterator[tuple[float, Array, Callable[..., tuple[Array, Array]]]]:
    """Weight, size (N, 1) [m], and a rule over the sizes in its unit for a width to resolve.

    The rule also takes the share of its nodes that are wanted, to come close to a root.
    """
    factor = size_factor(base, arrays)
    if factor is not None:
        for weight, part in base.components:
            scale, shape = part.standardised()
            size = np.broadcast_to(scale * factor, count)[:, None]
            yield weight, size, partial(_shape_rule, shape)
    elif isinstance(varied, TruncatedGaussian):
        size = np.broadcast_to(varied.mean, count)[:, None]
        std = np.broadcast_to(varied.std, count)[:, None] / size
        yield 1.0, size, partial(_gaussian_sizes, std, np.broadcast_to(varied.n, count)[:, None])
    else:
        raise NotCompiled("the shape of these sizes varies")


def _shape_rule(shape: Distribution, width: float, part: float = 1.0) -> tuple[Array, Array]:
    """Diameters and number weights of a fixed shape."""
    if isinstance(shape, Monodisperse):
        return np.full((1, 1), shape.mean), np.ones((1, 1))
    low, high = shape.support
    if low <= 0.5 * high:
        edges = subdivide(np.array(shape.pieces), width=1.5 * width)
        x, weight = panel_rule(edges, math.ceil(12 * part))
        return x[None], (weight * shape.pdf(x))[None]
    # sizes close together are counted from the largest, so that their densities keep all digits
    edges = subdivide(high - np.array(shape.pieces)[::-1], width=1.5 * width)
    depth, weight = panel_rule(edges, math.ceil(12 * part))
    return high - depth[None, ::-1], (weight * shape.pdf_below(depth))[None, ::-1]


def _gaussian_sizes(std: Array, n: Array, width: float, part: float = 1.0) -> tuple[Array, Array]:
    """Diameters over the mean and number weights of truncated Gaussians of their own widths."""
    high = np.minimum(n, NORMAL_CUT)
    low = np.maximum(-high, -1 / std)
    # One panel. The load smooths the seats of all gaps; the area of one regime may come from a few
    # of them, and is as steep in the size as one seat: exp(−k²w²/2) falls below 1e-13 at kw = 7.7,
    # and n nodes over a length L resolve k up to 4n/L, so n = 1.9 L/w and some at the ends.
    count = math.ceil(part * np.max((high - low) / 6 * (20 + 12 * std / width)))
    u, weight = panel_rule(np.concatenate([low, high], axis=1), count)
    density = np.exp(-0.5 * u * u) * weight
    return 1 + std * u, density / density.sum(axis=1, keepdims=True)
