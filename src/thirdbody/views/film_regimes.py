"""Regimes of a lubricated contact over speed, as figures in print and on the page show them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ..systems.stribeck import RegimeSpeeds

__all__ = ["OF_PARTICLES", "Band", "bands_of"]

Band = tuple[float, float, str]
"""From, to and word of a regime."""
OF_PARTICLES = ("mu_sa", "sa_share", "h_over_x")
"""Columns that say something where particles pass alone."""


def bands_of(u: ArrayLike, changes: RegimeSpeeds | Mapping[str, float | None]) -> list[Band]:
    """Regimes over these speeds [m/s]: from, to and word of each."""
    speeds = changes if isinstance(changes, Mapping) else changes._asdict()
    low, high = float(np.min(u)), float(np.max(u))
    slow = low if speeds["boundary"] is None else min(max(speeds["boundary"], low), high)
    fast = high if speeds["full"] is None else min(max(speeds["full"], low), high)
    ends = [(low, slow, "boundary"), (slow, fast, "mixed"), (fast, high, "full film")]
    return [band for band in ends if band[0] < band[1]]
