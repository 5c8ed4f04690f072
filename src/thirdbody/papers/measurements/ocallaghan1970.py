"""Number of spots between a rough surface and a softer flat."""

from __future__ import annotations

import numpy as np

import thirdbody as tb

from ..seats import contact
from .row import ABSTRACT, CHOSEN, Band, Input, Row, statement

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
    found = tb.solve(bare, pressure=LOADS * bare.surfaces.first.H).outputs["n_ss"]
    return float(LOADS[int(np.argmax(found))])


ROW = Row(
    "ocallaghan1970",
    "Number of contact spots over load",
    "O'Callaghan, Probert 1970, Real Area of Contact between a Rough Surface and a Softer "
    "Optically Flat Surface",
    "A rough surface on a softer optical flat, P from zero to half the microhardness M; spots "
    "counted and measured.",
    (
        Input("roughness", "σ = 0.3 µm, R = 3 µm, α of 3 to 10", CHOSEN),
        Input("hardness", "5 GPa; P is over it", CHOSEN),
    ),
    (
        statement(
            "spots",
            "Most spots are found at P/M of about 7.5e-3",
            ABSTRACT,
            "P/M at which most asperities touch",
            {"kind": "factor", "value": 7.5e-3, "of": 3.0},
            lambda: Band.of([most(each) for each in BREADTHS]),
            remark="About is read as within a factor 3",
        ),
    ),
    "Asperities are counted one by one and never merge: counts mean something up to a real area "
    "of some 1 %.",
)
