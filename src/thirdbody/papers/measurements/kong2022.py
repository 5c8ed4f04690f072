"""Silica nanoparticles on surfaces of different roughness."""

from __future__ import annotations

import numpy as np

import thirdbody as tb

from ..seats import contact
from .row import Band, row_of

__all__ = ["ROW", "share"]

HEIGHTS = (1.0, 3.0, 4.0, 6.0)
"""Height of the roughness over σ: σ itself, or a peak height."""
LEVELS = (1e-6, 1e-5, 1e-4)


def share(ratio: float) -> list[float]:
    """Share of the load on particles where roughness height over diameter is ``ratio``.

    Examples
    --------
    >>> bool(max(share(20.0)) < min(share(2.0)))
    True
    """
    out = []
    for height in HEIGHTS:
        dusty = contact(300e-9 * height / ratio)
        shares = tb.solve(dusty, F_star=np.array(LEVELS)).particle_load_share
        out += np.asarray(shares).tolist()
    return out


ROW = row_of(
    "kong2022",
    {"none": lambda: Band.from_values(share(20.0)), "rolls": lambda: Band.from_values(share(3.0))},
)
