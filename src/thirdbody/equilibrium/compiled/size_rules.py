"""Quadrature rules over the sizes of particles, and over the gaps of rough seats under them."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache, partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial.chebyshev import chebvander

from ...contact.particle_averages import SizeAverage
from ...errors import NotCompiled
from ...numerics.chebyshev import chebyshev_transform
from ...numerics.quadrature import panel_rule, subdivide
from ...populations.distributions import (
    NORMAL_CUT,
    Distribution,
    Monodisperse,
    TruncatedGaussian,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = [
    "FEW_SIZES",
    "MOST_WIDTHS",
    "NEAR",
    "densest",
    "few_on_seats",
    "near_rule",
    "seat_rule",
    "size_rules",
]

FEW_SIZES = 0.55
"""Share of the sizes with which a sum comes close enough to a root."""
MOST_WIDTHS = 2_000.0
"""Widths of the seat over which nodes are laid."""
NEAR, MOST_REACH = 3.0, 8.0
"""Standard deviations of a seat beyond the gaps within which fewer nodes do, and the most of them
that the gaps may span."""


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
def near_rule(average: SizeAverage, octave: int) -> Array | None:
    """As `seat_rule` with fewer nodes, for seats that are not far from touching.

    A Gaussian seat weighs the gaps with a function that varies slowly over all of them: sums over
    the nodes of its Chebyshev interpolant are sums over as many Chebyshev nodes. For seats whose
    mean gap is within `NEAR` standard deviations of the gaps: 2e-13 of the load and of the whole
    area. None where there would not be fewer.
    """
    rule, span = seat_rule(average, octave), average.top - average.bottom
    reach = span / 2.0**octave
    count = 8 * math.ceil((10 + 6 * reach**0.75) / 8)  # found by trial
    if count >= rule.shape[1] or reach > MOST_REACH:
        return None
    x, transform = chebyshev_transform(count)  # from the highest to the lowest
    powers = chebvander(2 * (average.top - rule[-1]) / span - 1, count - 1)
    return np.vstack([rule[:-1] @ powers @ transform, average.top - 0.5 * span * (1 + x)])


@lru_cache(maxsize=128)
def few_on_seats(average: SizeAverage, octave: int) -> Array:
    """As `seat_rule`, with nodes enough to come close to a root."""
    depth = subdivide(np.array([0.0, average.top - average.bottom]), width=0.75 * 2.0**octave)
    u, weight = panel_rule(np.sqrt(depth), 6)
    gaps = average.top - u[::-1] ** 2
    return np.vstack([(2 * u * weight)[::-1] * average(gaps).T, gaps])


def size_rules(
    varied: Distribution, count: int
) -> tuple[Array, Callable[..., tuple[Array, Array]]]:
    """Size (N, 1) [m], and a rule over the sizes in its unit for a width to resolve.

    The rule also takes the share of its nodes that are wanted, to come close to a root.
    """
    if not isinstance(varied, TruncatedGaussian):
        raise NotCompiled("the shape of these sizes varies")
    size = np.broadcast_to(varied.mean, count)[:, None]
    std = np.broadcast_to(varied.std, count)[:, None] / size
    return size, partial(_gaussian_sizes, std, np.broadcast_to(varied.n, count)[:, None])


def _gaussian_sizes(
    std: Array, n: Array, width: float, node_share: float = 1.0
) -> tuple[Array, Array]:
    """Diameters over the mean and number weights of truncated Gaussians of their own widths."""
    high = np.minimum(n, NORMAL_CUT)
    low = np.maximum(-high, -1 / std)
    # One panel. The load smooths the seats of all gaps; the area of one regime may come from a few
    # of them, and is as steep in the size as one seat: exp(−k²w²/2) falls below 1e-13 at kw = 7.7,
    # and n nodes over a length L resolve k up to 4n/L, so n = 1.9 L/w and some at the ends.
    count = math.ceil(node_share * np.max((high - low) / 6 * (20 + 12 * std / width)))
    u, weight = panel_rule(np.concatenate([low, high], axis=1), count)
    density = np.exp(-0.5 * u * u) * weight
    return 1 + std * u, density / density.sum(axis=1, keepdims=True)
