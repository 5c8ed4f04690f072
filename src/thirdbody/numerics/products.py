"""Products of large arrays in pieces that take one thread of BLAS."""

from __future__ import annotations

from collections.abc import Iterator

__all__ = ["in_pieces"]

ONE_THREAD = 200_000
"""Multiplications of a product of matrices that BLAS does not share among threads: where it does,
last digits depend on how many there are."""


def in_pieces(rows: int, work: int) -> Iterator[slice]:
    """Slices of rows, of ``work`` multiplications each, whose products take one thread."""
    size = max(1, ONE_THREAD // work)
    for start in range(0, rows, size):
        yield slice(start, min(start + size, rows))
