"""Mean pressure on the real area of a rough polymer sphere."""

from __future__ import annotations

import numpy as np

import thirdbody as tb

from .row import CAPTION, CHOSEN, Band, Input, Row, statement

__all__ = ["ROW", "rise"]

FACES = ((0.1e-6, 2e-6), (0.3e-6, 5e-6), (0.5e-6, 20e-6))
"""σ and R [m]."""
HARD = (150e6, 250e6, 350e6)
"""H [Pa]."""


def rise(sigma: float, R: float, H: float) -> float:
    """Mean real pressure at the highest load over that at the lowest, a hundredfold apart.

    Examples
    --------
    >>> bool(1.0 < rise(0.3e-6, 5e-6, 250e6) < 2.0)
    True
    """
    polymer, glass = tb.Material(E=3e9, nu=0.34, H=H), tb.Material(E=70e9, nu=0.2, H=6e9)
    contact = tb.Contact(
        surfaces=tb.MaterialPair(polymer, glass),
        roughness=tb.Roughness(sigma=sigma, R=R),
    )
    pressure = np.array([0.1e6, 10e6])
    real = pressure / np.asarray(tb.solve(contact, pressure=pressure).A_t)
    return float(real[1] / real[0])


ROW = Row(
    "weber2018",
    "Mean pressure on a rough polymer",
    "Weber et al. 2018, Nature Communications, doi:10.1038/s41467-018-02981-y",
    "A rough polystyrene sphere on glass; real contact made visible by molecules that fluoresce.",
    (
        Input("polystyrene", "E = 3 GPa, H of 150 to 350 MPa", CHOSEN),
        Input("roughness", "σ of 0.1 to 0.5 µm, R of 2 to 20 µm", CHOSEN),
        Input("load", "a nominal pressure that grows from 0.1 to 10 MPa", CHOSEN),
    ),
    (
        statement(
            "rise",
            "The mean contact pressure rises from roughly 100 MPa to 250 MPa",
            CAPTION,
            "mean real pressure at the highest load over that at the lowest",
            {"kind": "range", "value": [2.0, 3.0]},
            lambda: Band.of([rise(*face, H) for face in FACES for H in HARD]),
            remark="Roughly is read as a factor 2 to 3",
        ),
    ),
    "Real area follows load too closely: hardening, and asperities that push each other, are not "
    "in the model.",
)
