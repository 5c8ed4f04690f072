"""Thermal conductance of metal joints in vacuum over load."""

from __future__ import annotations

import numpy as np

import thirdbody as tb

from .row import Band, row_of

__all__ = ["ROW", "exponents"]

JOINTS = ((70e9, 1.2e9, 200.0), (200e9, 3e9, 16.0))
"""E [Pa], H [Pa], conductivity [W/(m K)]: aluminium and stainless steel."""
FACES = ((0.5e-6, 20e-6), (2e-6, 30e-6), (5e-6, 50e-6))
"""σ and R [m]."""


def exponents() -> list[float]:
    """Exponents of the conductance over pressure from 0.1 to 10 MPa.

    Examples
    --------
    >>> bool(0.9 < min(exponents()) and max(exponents()) < 1.0)
    True
    """
    out = []
    for E, H, conductivity in JOINTS:
        metal = tb.Material(E=E, nu=0.3, H=H, thermal_conductivity=conductivity)
        for sigma, R in FACES:
            contact = tb.Contact(
                surfaces=tb.MaterialPair(metal, metal),
                roughness=tb.Roughness(sigma=sigma, R=R, eta_R_sigma=0.05),
                outputs=(tb.outputs.ThermalConductance(),),
            )
            pressure = np.geomspace(1e5, 1e7, 5)
            log_hc = np.log(tb.solve(contact, pressure=pressure).outputs["hc"])
            out += (np.diff(log_hc) / np.diff(np.log(pressure))).tolist()
    return out


ROW = row_of("thomas1972", {"exponent": lambda: Band.from_values(exponents())})
