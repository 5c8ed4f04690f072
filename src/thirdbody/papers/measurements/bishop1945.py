"""A punch driven deep into a soft metal: how its pressure goes on rising."""

from __future__ import annotations

from functools import cache

import numpy as np

import thirdbody as tb

from .row import ABSTRACT, CHOSEN, Band, Input, Row, statement

__all__ = ["ROW", "pressure"]

FRICTIONS = (0.05, 0.2, 1.0)
"""Friction factor of the faces [1]."""
MODULI, HARDNESS = (70e9, 120e9, 206e9), 1e9
"""E and H of the soft metal [Pa]."""
GRAIN = tb.Material(E=1e15, nu=0.3, H=1e13)
FULL = 2.84
"""H over the yield stress Y."""


@cache
def pressure(depth: float, deep: str) -> tuple[float, ...]:
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
    found = []
    for m in FRICTIONS:
        law = tb.particle.Series(deep=deep, friction_factor=m)
        for E in MODULI:
            soft = tb.Material(E=E, nu=0.33, H=HARDNESS)
            one = law.one(surfaces=tb.MaterialPair(soft, soft), particle=GRAIN)
            squeezed = one.at(np.array([depth]))
            found.append(float(squeezed.load[0] / squeezed.areas[0][0] / HARDNESS * FULL))
    return tuple(found)


def _rise(deep: str) -> Band:
    pairs = zip(pressure(0.95, deep), pressure(0.4, deep), strict=True)
    return Band.of([deeper / shallow for deeper, shallow in pairs])


def _band() -> Band:
    found = _rise("table")
    return Band(found.low, found.best, found.high, f'deep = "off": {_rise("off").text}')


def _most() -> Band:
    off = Band.of(pressure(0.95, "off"))
    return Band.of(pressure(0.95, "table"), f'deep = "off": {off.text}')


ROW = Row(
    "bishop1945",
    "Deep indentation of a soft metal",
    "Bishop, Hill, Mott 1945, Proc. Phys. Soc. 57, 147",
    "Lubricated cone-headed punches driven into copper, 4 to 5 diameters deep.",
    (
        Input("modulus of the metal", "70 to 206 GPa, H = 1 GPa", CHOSEN),
        Input("friction factor of the faces", "0.05 to 1", CHOSEN),
        Input("what is pressed in", "a sphere, 0.4 and 0.95 of its radius deep", CHOSEN),
    ),
    (
        statement(
            "rises",
            "The load goes on rising long after the head has sunk in",
            ABSTRACT,
            "mean pressure at 0.95 R over that at 0.4 R",
            {"kind": "above", "value": 1.0},
            _band,
        ),
        statement(
            "limit",
            "It tends to some five times the yield stress, 4 to 5 diameters deep",
            ABSTRACT,
            "mean pressure over Y, 0.95 R deep",
            {"kind": "below", "value": 5.0},
            _most,
            undecided="a sphere here goes no deeper than half a diameter, where it must be below",
        ),
    ),
    "The pressure under a deep grain goes on rising with its depth; without the computed table it "
    "stayed at the hardness.",
)
