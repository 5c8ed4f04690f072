r"""Scrambled Sobol sequences as `scipy.stats.qmc.Sobol` makes them, bit for bit.

Importing `scipy.stats` takes longer than most of what is done with the points.

.. math:: x_i = 2^{-b} \Bigl(s \oplus \bigoplus_{k:\, g_k(i) = 1} v_k\Bigr), \qquad
          g(i) = i \oplus \lfloor i/2 \rfloor

with the shift s and the direction numbers v of b bits, both scrambled by a matrix and a shift drawn
at random, and the Gray code g of the number of a point. Two Gray codes whose numbers share no bit
add up without a carry, so that points of a block differ from its first as those of the first block
do: any point is as near as the first.

References
----------
Joe, Kuo 2008, SIAM J. Sci. Comput. 30, 2635, doi:10.1137/070709359 (polynomials and first
direction numbers); Matoušek 1998, J. Complexity 14, 527, doi:10.1006/jcom.1998.0489 (scrambling).
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Whole = NDArray[Any]

__all__ = ["WIDEST", "scrambled_points"]

FIRST = (
    (3, 1),
    (7, 1, 3),
    (11, 1, 3, 1),
    (13, 1, 1, 1),
    (19, 1, 1, 3, 3),
    (25, 1, 3, 5, 13),
    (37, 1, 1, 5, 5, 17),
    (41, 1, 1, 5, 5, 5),
    (47, 1, 1, 7, 11, 19),
    (55, 1, 1, 5, 1, 1),
    (59, 1, 1, 1, 3, 11),
    (61, 1, 3, 5, 5, 31),
    (67, 1, 3, 3, 9, 7, 49),
    (91, 1, 1, 1, 15, 21, 21),
    (97, 1, 3, 1, 13, 27, 49),
    (103, 1, 1, 1, 15, 7, 5),
    (109, 1, 3, 1, 15, 13, 25),
    (115, 1, 1, 5, 5, 19, 61),
    (131, 1, 3, 7, 11, 23, 15, 103),
    (137, 1, 3, 7, 13, 13, 15, 69),
    (143, 1, 1, 3, 13, 7, 35, 63),
    (145, 1, 3, 5, 9, 1, 25, 53),
    (157, 1, 3, 1, 13, 9, 35, 107),
    (167, 1, 3, 1, 5, 27, 61, 31),
    (171, 1, 1, 5, 11, 19, 41, 61),
    (185, 1, 3, 5, 3, 3, 13, 69),
    (191, 1, 1, 7, 13, 1, 19, 1),
    (193, 1, 3, 7, 5, 13, 19, 59),
    (203, 1, 1, 3, 9, 25, 29, 41),
    (211, 1, 3, 5, 13, 23, 1, 55),
    (213, 1, 3, 7, 3, 13, 59, 17),
)
"""Primitive polynomials of the second input and those after it, as bits, and the first direction
numbers of each."""
WIDEST = 1 + len(FIRST)
"""Inputs that the table is enough for."""
BLOCK_BITS = 10
"""Logarithm of the points of a block."""


def scrambled_points(width: int, bits: int, seed: int, start: int, stop: int) -> Array:
    """Points (stop − start, width) of a scrambled sequence of 2**bits.

    Parameters
    ----------
    width : int
        Number of inputs, at most `WIDEST`.
    bits : int
        Of a number; 2**bits points differ.
    seed : int
        Of the scrambling.
    start, stop : int
        Which points.

    Returns
    -------
    array (stop − start, width)

    Examples
    --------
    >>> points = scrambled_points(2, 30, 1, 0, 4)
    >>> np.sort((4 * points[:, 0]).astype(int)).tolist()
    [0, 1, 2, 3]
    """
    shift, pattern, steps = _scrambled(width, bits, seed)
    index = np.arange(start, stop, dtype=np.uint64)
    block, inside = index >> np.uint64(BLOCK_BITS), index & np.uint64(len(pattern) - 1)
    first = int(block[0]) if len(block) else 0
    blocks = np.arange(first, 1 + int(block[-1]) if len(block) else first, dtype=np.uint64)
    begin = np.tile(shift, (len(blocks), 1))
    for k, step in enumerate(steps):
        begin[(blocks >> np.uint64(k)) & np.uint64(1) == 1] ^= step
    which = (block - np.uint64(first)).astype(np.intp)
    return np.asarray((pattern[inside.astype(np.intp)] ^ begin[which]) * (1.0 / 2**bits))


@lru_cache(maxsize=16)
def _scrambled(width: int, bits: int, seed: int) -> tuple[Whole, Whole, Whole]:
    """Shift (width,), first block without it, and what each bit of a block's number changes."""
    kind: Any = np.uint32 if bits <= 32 else np.uint64
    (spawned,) = np.random.SeedSequence(seed).spawn(1)  # SciPy spawns one of its own
    random = np.random.default_rng(spawned)
    places = np.arange(bits, dtype=kind)
    powers = kind(1) << places
    shift = np.sum(random.integers(2, size=(width, bits), dtype=kind) * powers, axis=1, dtype=kind)
    lower = np.tril(random.integers(2, size=(width, bits, bits), dtype=kind))
    lower[:, range(bits), range(bits)] = 1
    # the bits of a direction number, the highest first, times the matrix, over the field of two
    plain = (_direction_numbers(width, bits)[:, :, None] >> places[::-1]) & kind(1)
    mixed = np.einsum("wpk,wjk->wjp", lower, plain) & kind(1)
    v = np.sum(mixed * powers[::-1], axis=2, dtype=kind).T
    steps = v.copy()  # of one bit k of a number its Gray code has k and k - 1
    steps[1:] ^= v[:-1]
    pattern = np.zeros((1, width), kind)
    for step in steps[:BLOCK_BITS]:
        pattern = np.concatenate([pattern, pattern ^ step])
    return shift, pattern, steps[BLOCK_BITS:]


def _direction_numbers(width: int, bits: int) -> Whole:
    """Direction numbers (width, bits), of so many bits each."""
    rows = [[1] * bits]
    for polynomial, *known in FIRST[: width - 1]:
        degree, row = len(known), list(known[:bits])
        for j in range(degree, bits):
            new = row[j - degree]
            for k in range(1, degree + 1):
                if polynomial >> (degree - k) & 1:
                    new ^= row[j - k] << k
            row.append(new)
        rows.append(row)
    kind: Any = np.uint32 if bits <= 32 else np.uint64
    return np.array([[v << (bits - 1 - j) for j, v in enumerate(row)] for row in rows], kind)
