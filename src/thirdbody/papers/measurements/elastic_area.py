"""Elastic real area of a rough surface against boundary elements."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

import thirdbody as tb
from thirdbody.reference import persson_area

from ..panels import Line, Panel
from .row import COMPUTED, Band, row_of, statement

__all__ = ["ROW", "area"]

Array = NDArray[np.float64]

BREADTH = 11.6
"""α of the map."""
COMPUTED_AREA = {0.01: 0.0236, 0.05: 0.1112, 0.10: 0.2095}
"""A/A_n over p/(E* g)."""


def area(load: Array, breadth: float = BREADTH) -> Array:
    """Elastic A/A_n of asperities with the moments of a surface of rms gradient 1.

    Parameters
    ----------
    load : array
        p/(E* g) with the rms gradient g.
    breadth : float, optional
        Nayak's α.

    Examples
    --------
    >>> round(float(area(np.array([0.01]))[0]), 4)
    0.0166
    """
    m0, m2 = 1.0, 0.5
    m4 = breadth * m2**2 / m0
    # lengths in units of σ are set to 1 µm: the area depends on none of them
    unit = 1e-6
    body = tb.Material(E=2e9, nu=0.0, H=1e15)
    contact = tb.Contact(
        surfaces=tb.MaterialPair(body, body),
        roughness=tb.Roughness(
            sigma=unit,
            R=3 * math.sqrt(math.pi) / (8 * math.sqrt(m4)) * unit,
            alpha=breadth,
            eta=m4 / (6 * math.pi * math.sqrt(3) * m2) / unit**2,
        ),
        asperity_law=tb.asperity.GW(),
    )
    return np.asarray(tb.solve(contact, pressure=load * contact.E_ss).A_t)


def _band_at(load: float) -> Band:
    ratio = float(area(np.array([load]))[0]) / COMPUTED_AREA[load]
    other = float(persson_area(load, E_star=1.0, g=1.0)) / COMPUTED_AREA[load]
    return Band(ratio, ratio, ratio, f"Persson: {other:.2f}")


def _panel() -> Panel:
    load = np.geomspace(0.003, 0.15, 40)
    loads = np.array(list(COMPUTED_AREA))
    return Panel(
        "area",
        "elastic real area of one rough surface",
        "load $p/(E^* g)$",
        "real area $A/A_n$",
        ("p_over_Eg", "A"),
        (
            Line("boundary elements", loads, np.array(list(COMPUTED_AREA.values())), colour=-1),
            Line("asperities (model)", load, area(load)),
            Line("Persson", load, persson_area(load, E_star=1.0, g=1.0), colour=1, dash=1),
        ),
        ylog=True,
        note="Nayak's α = 11.6; three loads were computed.",
    )


ROW = row_of(
    "elastic_area",
    {},
    panels=(_panel,),
    statements=tuple(
        statement(
            f"area-{load:g}",
            f"At p/(E* g) = {load:g} the real area is {computed_area:g} of the nominal one",
            COMPUTED,
            "model over boundary elements",
            {"kind": "relative", "value": 1.0, "of": 0.2},
            lambda load=load: _band_at(load),  # type: ignore[misc]
            remark="Within 20 %, chosen before",
        )
        for load, computed_area in COMPUTED_AREA.items()
    ),
)
