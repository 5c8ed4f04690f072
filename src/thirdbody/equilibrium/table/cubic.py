"""Cubics of the logarithm between knots."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class _LogCubic:
    """exp of a piecewise cubic Hermite interpolant, with its continuations."""

    x: Array
    left: Array
    """Value at the left knot of each panel."""
    c: Array
    """Coefficients c_1, c_2, c_3 in s of ln(value/left): (N, 3)."""
    last: float
    head: float
    """Logarithmic slope at the first knot [1/m]."""
    tail: float
    """Logarithmic slope at the last knot [1/m]."""

    @property
    def width(self) -> Array:
        return np.diff(self.x)

    def panel(self, x: Array) -> NDArray[np.intp]:
        return np.clip(np.searchsorted(self.x, x, side="right") - 1, 0, len(self.x) - 2)

    def _inside(self, x: Array) -> tuple[Array, Array]:
        i = self.panel(x)
        s = (np.clip(x, self.x[0], self.x[-1]) - self.x[i]) / self.width[i]
        c1, c2, c3 = self.c[i].T if x.ndim == 1 else np.moveaxis(self.c[i], -1, 0)
        value = self.left[i] * np.exp(s * (c1 + s * (c2 + s * c3)))
        return value, (c1 + s * (2 * c2 + s * (3 * c3))) / self.width[i]

    def value(self, x: Array) -> Array:
        inside, _ = self._inside(x)
        with np.errstate(under="ignore"):
            above = self.last * np.exp(self.tail * np.maximum(x - self.x[-1], 0.0))
        below = self.left[0] * (1 + self.head * (x - self.x[0]))
        return np.where(x > self.x[-1], above, np.where(x < self.x[0], below, inside))

    def slope(self, x: Array) -> Array:
        inside, log_slope = self._inside(x)
        above = self.tail * self.value(x)
        below = np.full_like(x, self.left[0] * self.head)
        return np.where(x > self.x[-1], above, np.where(x < self.x[0], below, inside * log_slope))

    def at_knots(self) -> Array:
        return np.append(self.left, self.last)
