"""Number of spots between a rough surface and a softer flat."""

from __future__ import annotations

import numpy as np

import thirdbody as tb

from ..seats import contact
from .row import Band, row_of

__all__ = ["ROW", "most"]

LOADS = np.geomspace(1e-4, 0.3, 60)
"""P/M."""
BREADTHS = (3.0, 5.0, 10.0)


def most(breadth: float) -> float:
    """P/M at which most asperities touch, up to 0.3.

    Examples
    --------
    >>> round(most(5.0), 2)
    0.3
    """
    bare = contact(300e-9).replace(particles=None, outputs=(tb.outputs.Counts(),))
    bare = bare.replace(roughness=bare.roughness.replace(alpha=breadth))
    spots = tb.solve(bare, pressure=LOADS * bare.surfaces.first.H).outputs["n_ss"]
    return float(LOADS[int(np.argmax(spots))])


ROW = row_of(
    "ocallaghan1970", {"spots": lambda: Band.from_values([most(breadth) for breadth in BREADTHS])}
)
