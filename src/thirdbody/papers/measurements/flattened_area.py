"""How wide the contact of a sphere is that is squashed to a fraction of its height."""

from __future__ import annotations

from functools import cache

import numpy as np

import thirdbody as tb

from .chaudhri1984 import HARD, PLATEN, STIFF
from .row import ABSTRACT, CHOSEN, Band, Input, Row, Statement, statement

__all__ = ["ROW", "over_truncation"]

FRICTIONS = (0.05, 0.2, 0.5)
"""Friction factor of the faces [1]."""
SQUASHED = (0.2, 0.3, 0.4)
"""Squash of one half over R."""


@cache
def over_truncation(squash: float, deep: str) -> tuple[float, ...]:
    """Contact area over that of the sphere cut off by the flat, over metals and friction.

    Parameters
    ----------
    squash : float
        Of one half over its radius s [1].
    deep : str
        As in `thirdbody.particle.Series`.

    Examples
    --------
    >>> round(over_truncation(0.3, "off")[0], 2)
    1.68
    """
    found = []
    for m in FRICTIONS:
        law = tb.particle.Series(deep=deep, friction_factor=m)
        for H in HARD:
            for E in STIFF:
                sphere = tb.Material(E=E, nu=0.33, H=H)
                one = law.one(surfaces=tb.MaterialPair(PLATEN, PLATEN), particle=sphere)
                # almost all of the squeeze is the sphere's: 1e-4 is the platens'
                area = one.at(np.array([squash])).areas[0][0] / (np.pi / 4)
                found.append(float(area / (squash * (2 - squash))))
    return tuple(found)


def _statement(squash: float) -> Statement:
    cut = squash * (2 - squash)

    def band() -> Band:
        off = Band.of(over_truncation(squash, "off"))
        return Band.of(over_truncation(squash, "table"), f'deep = "off": {off.text}')

    return statement(
        f"area-{squash:g}",
        f"Squashed by {squash:g} R, the area is that of a sphere cut off, {cut:.2f} πR²",
        ABSTRACT,
        f"A over {cut:.2f} πR²",
        {"kind": "relative", "value": 1.0, "of": 0.1},
        band,
        remark="Within 10 %, chosen",
    )


ROW = Row(
    "flattened_area",
    "The area of a flattened sphere",
    "Jamari, Schipper 2006, J. Tribol. 128(2), 230",
    "Deformable spheres pressed against a hard flat beyond full yield; contact area measured, and "
    "found to be that of simple truncation.",
    (
        Input("hardness of the sphere", "1 to 2 GPa", CHOSEN),
        Input("modulus of the sphere", "70 to 120 GPa, ν = 0.33", CHOSEN),
        Input("friction factor of the faces", "0.05 to 0.5", CHOSEN),
        Input("squash of one half", "0.2, 0.3, 0.4 of the radius", CHOSEN),
    ),
    tuple(_statement(squash) for squash in SQUASHED),
    "A squashed particle is as wide as its law says; without the computed table it was 40 to 75 % "
    "too wide.",
)
