"""Counts of oil reports that are 0: fewer particles than the report can tell from none."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["Zeros"]

NONE = 1e-3
"""Part of its limit at which a count of 0 is taken as none."""


class Zeros(NamedTuple):
    r"""Counts of 0 among those of reports, each somewhere below a limit.

    .. math:: 0 \le n_{ij} < L_{ij} = \min(L,\ \min_{k:\,n_{kj} > 0} n_{kj},\ n_{i,j-1})

    Examples
    --------
    >>> counts = np.array([[5e9, 4e6], [3e9, 0.0]])
    >>> zeros = Zeros.of_counts(counts, least=1e7)
    >>> float(zeros.limits[1, 1]), zeros.replace_zeros(counts, 0.5).tolist()
    (4000000.0, [[5000000000.0, 4000000.0], [3000000000.0, 2000000.0]])
    """

    here: NDArray[np.bool_]
    """Where they are (R, S)."""
    limits: Array
    """L, infinite elsewhere [1/m³], (R, S)."""

    @classmethod
    def of_counts(cls, counts: Array, *, least: float) -> Self:
        """Zeros of counts, below the least count, those of their size, and the smaller size's."""
        here = counts == 0
        some = np.where(here, np.inf, counts)
        limits = np.minimum(some.min(axis=0), least)
        limits = np.minimum.accumulate(np.where(here, limits, some), axis=1)
        return cls(here, np.where(here, limits, np.inf))

    def replace_zeros(self, counts: Array, parts: Array | float) -> Array:
        """Counts with each 0 at a part of its limit."""
        parts = np.maximum(parts, NONE)
        return np.where(self.here, np.where(self.here, self.limits, 0.0) * parts, counts)

    def excess(self, fitted: Array) -> Array:
        """Logarithm by which a fit is above the limits [1]; 0 where it is not."""
        return np.log(np.maximum(fitted / self.limits, 1.0))
