"""A sphere pressed against a hard flat until it is fully plastic."""

from __future__ import annotations

import numpy as np

import thirdbody as tb

from .row import ABSTRACT, CHOSEN, Band, Input, Row, statement

__all__ = ["ROW"]

HARD, STIFF = (0.8e9, 1.5e9, 3e9), (70e9, 120e9, 200e9)
"""H [Pa] and contact modulus E* [Pa]."""
DEPTHS = np.geomspace(0.02, 0.1, 9)
"""Interference over R."""


def _over(what: str) -> Band:
    default = tb.asperity.ZMC()
    spheres = [
        {"R": 1.0, "E_star": E_star, "H": H}
        for H in HARD
        for E_star in STIFF
        if default.regime(DEPTHS[0], R=1.0, E_star=E_star, H=H) == "plastic"
    ]

    def values(law: tb.asperity.AbstractAsperityLaw) -> list[float]:
        found: list[float] = []
        for sphere in spheres:
            area = law.area(DEPTHS, **sphere)
            hard = law.force(DEPTHS, **sphere) / area / sphere["H"]
            cut_off = np.pi * DEPTHS * (2 - DEPTHS)
            found += {
                "pressure": hard,
                "constant": hard[-1:] / hard[0],
                "area": area / cut_off,
            }[what].tolist()
        return found

    other = Band.of(values(tb.asperity.JG(nu=0.3)))
    return Band.of(values(default), f"Jackson–Green: {other.text}")


ROW = Row(
    "jamari2006",
    "A sphere against a hard flat, fully plastic",
    "Jamari, Schipper 2006, J. Tribol. 128(2), 230",
    "Deformable spheres pressed against a hard flat beyond full yield; contact area measured.",
    (
        Input("hardness of the sphere", "0.8 to 3 GPa", CHOSEN),
        Input("contact modulus", "70 to 200 GPa, where the default law is fully plastic", CHOSEN),
        Input("interference", "0.02 to 0.1 of the radius", CHOSEN),
    ),
    (
        statement(
            "pressure",
            "The mean contact pressure is lower than the hardness",
            ABSTRACT,
            "p/H, fully plastic",
            {"kind": "below", "value": 1.0},
            lambda: _over("pressure"),
            remark="By how much is not in the abstract",
        ),
        statement(
            "constant",
            "The mean contact pressure stays constant as the load rises",
            ABSTRACT,
            "p at five times the interference over p",
            {"kind": "relative", "value": 1.0, "of": 0.05},
            lambda: _over("constant"),
            remark="Constant is read as within 5 %",
        ),
        statement(
            "area",
            "The contact area is that of a sphere cut off by the flat",
            ABSTRACT,
            "A over π ω (2R − ω)",
            {"kind": "relative", "value": 1.0, "of": 0.1},
            lambda: _over("area"),
            remark="Within 10 %, chosen",
        ),
    ),
    "Take the hardness that a flattened tip shows, not that of an indentation, where the load of "
    "fully plastic tips matters.",
)
