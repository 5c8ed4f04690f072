"""A sphere pressed against a hard flat until it is fully plastic."""

from __future__ import annotations

import numpy as np

import thirdbody as tb

from .row import Band, row_of

__all__ = ["ROW"]

HARD, STIFF = (0.8e9, 1.5e9, 3e9), (70e9, 120e9, 200e9)
"""H [Pa] and contact modulus E* [Pa]."""
DEPTHS = np.geomspace(0.02, 0.1, 9)
"""Interference over R."""


def _band_of(what: str) -> Band:
    default = tb.asperity.ZMC()
    spheres = [
        {"R": 1.0, "E_star": E_star, "H": H}
        for H in HARD
        for E_star in STIFF
        if default.regime(DEPTHS[0], R=1.0, E_star=E_star, H=H) == "plastic"
    ]

    def values(law: tb.asperity.AbstractAsperityLaw) -> list[float]:
        numbers: list[float] = []
        for sphere in spheres:
            area = law.area(DEPTHS, **sphere)
            hard = law.force(DEPTHS, **sphere) / area / sphere["H"]
            cut_off = np.pi * DEPTHS * (2 - DEPTHS)
            numbers += {
                "pressure": hard,
                "constant": hard[-1:] / hard[0],
                "area": area / cut_off,
            }[what].tolist()
        return numbers

    other = Band.from_values(values(tb.asperity.JG(nu=0.3)))
    return Band.from_values(values(default), f"Jackson–Green: {other.text}")


ROW = row_of(
    "jamari2006",
    {
        "pressure": lambda: _band_of("pressure"),
        "constant": lambda: _band_of("constant"),
        "area": lambda: _band_of("area"),
    },
)
