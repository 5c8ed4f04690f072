"""A punch driven deep into a soft metal: how its pressure goes on rising."""

from __future__ import annotations

from functools import cache

import numpy as np

import thirdbody as tb
from thirdbody.laws.particle.series import Deep

from .row import Band, row_of

__all__ = ["ROW", "pressure"]

FRICTIONS = (0.05, 0.2, 1.0)
"""Friction factor of the faces [1]."""
MODULI, HARDNESS = (70e9, 120e9, 206e9), 1e9
"""E and H of the soft metal [Pa]."""
GRAIN = tb.Material(E=1e15, nu=0.3, H=1e13)
FULL = 2.84
"""H over the yield stress Y."""


@cache
def pressure(depth: float, deep: Deep) -> tuple[float, ...]:
    """Mean pressure over Y under a rigid sphere, over moduli and friction.

    Parameters
    ----------
    depth : float
        Over the radius of the sphere [1].
    deep : str
        As in `thirdbody.particle.Series`.

    Examples
    --------
    >>> round(pressure(0.5, "off")[0], 2)
    2.84
    """
    pressures = []
    for m in FRICTIONS:
        law = tb.particle.Series(deep=deep, friction_factor=m)
        for E in MODULI:
            soft = tb.Material(E=E, nu=0.33, H=HARDNESS)
            one = law.one(surfaces=tb.MaterialPair(soft, soft), particle=GRAIN)
            squeezed = one.at(np.array([depth]))
            pressures.append(float(squeezed.load[0] / squeezed.areas[0][0] / HARDNESS * FULL))
    return tuple(pressures)


def _rise(deep: Deep) -> Band:
    pairs = zip(pressure(0.95, deep), pressure(0.4, deep), strict=True)
    return Band.from_values([deeper / shallow for deeper, shallow in pairs])


def _band() -> Band:
    band = _rise("table")
    return Band(band.low, band.best, band.high, f'deep = "off": {_rise("off").text}')


def _limit() -> Band:
    off = Band.from_values(pressure(0.95, "off"))
    return Band.from_values(pressure(0.95, "table"), f'deep = "off": {off.text}')


ROW = row_of("bishop1945", {"rises": _band, "limit": _limit})
