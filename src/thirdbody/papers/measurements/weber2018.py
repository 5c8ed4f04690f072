"""Mean pressure on the real area of a rough polymer sphere."""

from __future__ import annotations

import numpy as np

import thirdbody as tb

from .row import Band, row_of

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


ROW = row_of(
    "weber2018",
    {"rise": lambda: Band.from_values([rise(*face, H) for face in FACES for H in HARD])},
)
