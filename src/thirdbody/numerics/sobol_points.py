r"""Points of the scrambled Sobol sequence, wherever they stand in it.

.. math:: x_i = s \oplus \bigoplus_b g_b(i)\,v_b, \qquad g(i) = i \oplus \lfloor i/2 \rfloor

with direction numbers :math:`v_b` scrambled by random lower triangular matrices and a shift s: the
points of `scipy.stats.qmc.Sobol` to the last bit, without what loading `scipy.stats` takes.

References
----------
Joe and Kuo 2008, SIAM J. Sci. Comput. 30, 2635, doi:10.1137/070709359; Matoušek 1998, J. Complexity
14, 527, doi:10.1006/jcom.1998.0489.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["WIDEST", "points"]

# fmt: off
POLYNOMIALS = (
    1, 3, 7, 11, 13, 19, 25, 37, 41, 47, 55, 59, 61, 67, 91, 97, 103, 109, 115, 131, 137, 143,
    145, 157,
)
"""Primitive polynomials over GF(2), their coefficients as bits."""
FIRST = (
    (1,), (1,), (1, 3), (1, 3, 1), (1, 1, 1), (1, 1, 3, 3), (1, 3, 5, 13), (1, 1, 5, 5, 17),
    (1, 1, 5, 5, 5), (1, 1, 7, 11, 19), (1, 1, 5, 1, 1), (1, 1, 1, 3, 11), (1, 3, 5, 5, 31),
    (1, 3, 3, 9, 7, 49), (1, 1, 1, 15, 21, 21), (1, 3, 1, 13, 27, 49), (1, 1, 1, 15, 7, 5),
    (1, 3, 1, 15, 13, 25), (1, 1, 5, 5, 19, 61), (1, 3, 7, 11, 23, 15, 103),
    (1, 3, 7, 13, 13, 15, 69), (1, 1, 3, 13, 7, 35, 63), (1, 3, 5, 9, 1, 25, 53),
    (1, 3, 1, 13, 9, 35, 107),
)
"""First direction numbers of each input."""
# fmt: on
WIDEST = len(POLYNOMIALS)
"""Inputs for which there are direction numbers."""


def points(width: int, seed: int, bits: int, start: int, stop: int) -> NDArray[np.float64]:
    """Points ``start`` to ``stop``: (stop − start, width).

    Parameters
    ----------
    width : int
        Number of inputs, at most `WIDEST`.
    seed : int
        Of the scrambling.
    bits : int
        Digits of a point, at most 64.
    start, stop : int
        Which points.
    """
    directions, shift = _scrambled(width, seed, bits)
    index = np.arange(start, stop, dtype=np.uint64)
    gray = index ^ (index >> np.uint64(1))
    out = np.tile(shift, (len(index), 1))
    for b in range(max(stop - 1, 0).bit_length()):
        odd = (gray >> np.uint64(b)) & np.uint64(1) == 1
        out[odd] ^= directions[:, b]
    found: NDArray[np.float64] = out * (1.0 / 2**bits)
    return found


@lru_cache(maxsize=16)
def _scrambled(width: int, seed: int, bits: int) -> tuple[NDArray[Any], NDArray[Any]]:
    """Direction numbers (width, bits) and the shift (width,)."""
    kind: Any = np.uint32 if bits <= 32 else np.uint64
    (random,) = np.random.default_rng(seed).spawn(1)
    powers = 2 ** np.arange(bits, dtype=kind)
    shift = np.dot(random.integers(2, size=(width, bits), dtype=kind), powers)
    matrices = np.tril(random.integers(2, size=(width, bits, bits), dtype=kind))
    matrices[:, np.arange(bits), np.arange(bits)] = 1
    plain = np.array([_directions(i, bits) for i in range(width)], dtype=kind)
    digits = (plain[:, :, None] >> np.arange(bits, dtype=kind)[::-1]) & kind(1)
    scrambled = np.einsum("dpk,djk->djp", matrices, digits) & kind(1)
    return np.sum(scrambled * powers[::-1], axis=2, dtype=kind), shift


def _directions(which: int, bits: int) -> list[int]:
    """Direction numbers of one input."""
    if which == 0:
        numbers = [1] * bits
    else:
        polynomial, numbers = POLYNOMIALS[which], list(FIRST[which])
        degree = polynomial.bit_length() - 1
        for j in range(degree, bits):
            new = numbers[j - degree]
            for k in range(degree):
                if polynomial >> (degree - 1 - k) & 1:
                    new ^= numbers[j - k - 1] << (k + 1)
            numbers.append(new)
    return [number << (bits - 1 - j) for j, number in enumerate(numbers[:bits])]
