r"""Designs: where in the unit cube the samples of a sweep lie.

Sample i of a design depends on nothing but the design, its size, its seed and i, so that any
part of it can be made anywhere, in the memory of that part.
"""

from __future__ import annotations

import math
import threading
import warnings
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..quantities.record import Record

__all__ = ["Span", "latin", "sobol"]

Array = NDArray[np.float64]

ROUNDS = 6
_last = threading.local()


@dataclass(frozen=True)
class Span(Record):
    """A range that is sampled: evenly between its ends, or evenly in the logarithm."""

    low: float
    high: float
    scale: str = "linear"

    def values_at(self, u: Array) -> Array:
        """Values at u in [0, 1)."""
        if self.scale == "log":
            return self.low * (self.high / self.low) ** u
        return self.low + u * (self.high - self.low)


def sobol(size: int, width: int, seed: int, start: int, stop: int) -> Array:
    """Points ``start`` to ``stop`` of the scrambled Sobol sequence of `scipy.stats.qmc.Sobol`.

    Parameters
    ----------
    size : int
        How many points the whole design has; above 2³⁰ the sequence needs more bits.
    width : int
        Number of sampled inputs k.
    seed : int
        Of the scrambling.
    start, stop : int
        Which points.

    Returns
    -------
    array (stop − start, k)

    References
    ----------
    Owen 1998, ACM Trans. Model. Comput. Simul. 8, 71, doi:10.1145/272991.273010.

    Examples
    --------
    >>> whole = sobol(8, 2, 1, 0, 8)
    >>> bool(np.all(sobol(8, 2, 1, 5, 8) == whole[5:]))
    True
    """
    from scipy.stats import qmc

    key = (size, width, seed)
    engine: Any = None
    if getattr(_last, "key", None) == key:
        engine = _last.engine
    _last.key = None  # an interrupt may leave it between two points
    # skipping costs a few nanoseconds a point: go on where the last part ended when possible
    if engine is None or engine.num_generated > start:
        engine = qmc.Sobol(width, rng=seed, bits=max(30, math.ceil(math.log2(size))))
    if start > engine.num_generated:
        engine.fast_forward(start - engine.num_generated)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="The balance properties")
        points = engine.random(stop - start)
    _last.key, _last.engine = key, engine
    return points


def latin(size: int, width: int, seed: int, start: int, stop: int) -> Array:
    r"""Points ``start`` to ``stop`` of a Latin hypercube.

    .. math:: u_{ij} = \frac{\pi_j(i) + r_{ij}}{N}

    Every one of the N strata of every input holds exactly one point. The permutations
    :math:`\pi_j` are keyed: a Feistel network over the next power of four, walked until it falls
    below N. So no permutation is stored, and a part of the design costs the memory of that part.
    (`scipy.stats.qmc.LatinHypercube` makes the whole design at once: 8 bytes a sample and input,
    several times over.)

    Parameters
    ----------
    size, width, seed, start, stop : int
        As in `sobol`.

    Returns
    -------
    array (stop − start, k)

    References
    ----------
    McKay, Beckman, Conover 1979, Technometrics 21, 239, doi:10.2307/1268522; permutation: Black,
    Rogaway 2002, CT-RSA, doi:10.1007/3-540-45760-7_9.

    Examples
    --------
    >>> whole = latin(10, 2, 1, 0, 10)
    >>> np.sort((10 * whole[:, 1]).astype(int)).tolist()
    [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]
    """
    index = np.arange(start, stop, dtype=np.uint64)
    # as many random bits as a double has left beside the number of the stratum
    bits = 52 - math.ceil(math.log2(size))
    out = np.empty((len(index), width))
    for j in range(width):
        *keys, inside_key = np.random.SeedSequence([seed, j]).generate_state(ROUNDS + 1, np.uint64)
        inside = (_mix_bits(index ^ inside_key) >> np.uint64(64 - bits)) * 2.0**-bits
        out[:, j] = (_permute_index(index, size, keys) + inside) / size
    return out


def _permute_index(index: NDArray[np.uint64], size: int, keys: list[Any]) -> NDArray[np.uint64]:
    half = np.uint64(max(1, math.ceil(math.log2(size) / 2)))
    mask = (np.uint64(1) << half) - np.uint64(1)
    out = index.copy()
    rest = np.arange(len(out))
    while len(rest):
        left, right = out[rest] >> half, out[rest] & mask
        for key in keys:
            left, right = right, left ^ (_mix_bits(right ^ key) & mask)
        out[rest] = (left << half) | right
        rest = rest[out[rest] >= size]
    return out


def _mix_bits(x: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """The finaliser of splitmix64: every bit of x changes half of the bits that come out."""
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))


SweepDesign = Literal["grid", "zip", "latin", "sobol"]
"""How a sweep puts values of several inputs together."""
DESIGNS = {"latin": latin, "sobol": sobol}
"""The sampled designs by name."""
