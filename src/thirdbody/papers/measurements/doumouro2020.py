"""Thermal resistance of one glass sphere on a glass plate."""

from __future__ import annotations

from thirdbody.effects.single.heat import spot_resistance

from .row import Band, row_of

__all__ = ["ROW"]

RADII, CONDUCTIVITIES = (32e-9, 36e-9, 40e-9), (1.0, 1.05, 1.1)


def _resistance() -> Band:
    return Band.from_values(
        [float(spot_resistance(r, rho_1=1 / k, rho_2=1 / k)) for r in RADII for k in CONDUCTIVITIES]
    )


ROW = row_of("doumouro2020", {"resistance": _resistance})
