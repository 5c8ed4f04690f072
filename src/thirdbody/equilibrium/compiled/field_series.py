"""One field of heights as series in the separation.

What its table says is laid out once more, piece by piece between its own knots.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ...contact.field_sums import FieldSum
from ...numerics.chebyshev import PiecewiseChebyshev

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["asperity_numbers", "asperity_series", "beside_gaussian"]

TOLERANCE, DEPTH = 1e-13, 12
GRID, HALVINGS, MOST_KINKS = 1_000, 60, 40
"""Separations at which areas are looked at for a change of their formula, halvings to where it
is, and how many such changes are no rounding."""
FARTHEST = 1.0
"""Width of a panel over σ where the field itself has none."""


def asperity_numbers(skin: FieldSum) -> dict[str, float]:
    """Fields of an `INTERFACE`: separations are those of the mean planes over σ."""
    d = np.array([skin.deepest])
    return {
        **{"sigma_s": skin.sigma, "centre": skin.centre - skin.rough.y_s},
        **{"force": skin.unit, "area": 1.0},
        **{"lowest": float(skin.h(d)[0]), "highest": _highest(skin)},
    }


def _highest(skin: FieldSum) -> float:
    """Separation of the mean planes over σ above which nothing is carried."""
    return float(skin.h(np.array([skin.centre + skin.highest * skin.sigma_s]))[0])


@lru_cache(maxsize=64)
def asperity_series(skin: FieldSum) -> PiecewiseChebyshev:
    """Load over its unit and areas without shadow, over exp(−h²/2), as a function of h."""

    def d_of(h: Array) -> Array:
        return skin.sigma * h - skin.rough.y_s + skin.centre

    def columns(h: Array) -> Array:
        out = skin.fields(d_of(h)) * np.exp(0.5 * h * h)[:, None]
        out[:, 0] /= skin.unit
        return out

    lowest, highest = asperity_numbers(skin)["lowest"], _highest(skin)
    surface = skin.surface
    knots = np.concatenate([[0.0], surface.h, np.arange(surface.h[-1], highest, FARTHEST)])
    kinks = _kinks(columns, lowest, min(highest, float(surface.h[-1]) + 1))
    edges = np.unique(np.concatenate([knots, kinks, [lowest, highest]]))
    edges = edges[(edges >= lowest) & (edges <= highest)]
    return PiecewiseChebyshev(
        columns, edges, tolerance=TOLERANCE, max_depth=DEPTH, kinds=(0, 1, 1, 1)
    )


def _kinks(columns: Callable[[Array], Array], low: float, high: float) -> Array:
    """Separations at which an area begins to be all of it, or nothing."""

    def formula(h: Array) -> NDArray[np.intp]:
        _, elastic, _, plastic = columns(h).T
        return 2 * (elastic <= 0).astype(int) + (plastic <= 0)

    h = np.linspace(low, high, GRID)
    formulas = formula(h)
    cells = np.flatnonzero(formulas[1:] != formulas[:-1])
    if not 0 < len(cells) <= MOST_KINKS:
        return np.empty(0)
    left, right, first = h[cells], h[cells + 1], formulas[cells]
    for _ in range(HALVINGS):
        middle = 0.5 * (left + right)
        same = formula(middle) == first
        left, right = np.where(same, middle, left), np.where(same, right, middle)
    return np.concatenate([left, right])


def beside_gaussian(series: PiecewiseChebyshev) -> Array:
    """The load m_0 exp(−h²/2) as the kernel takes it: m_0, −m_0′, m_0″, (panels, terms, 3)."""
    return series.with_derivatives[:, :, 0, :] * np.array([1.0, -1.0, 1.0])
