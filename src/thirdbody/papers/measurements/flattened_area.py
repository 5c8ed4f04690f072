"""How wide the contact of a sphere is that is squashed to a fraction of its height."""

from __future__ import annotations

from functools import cache, partial

import numpy as np

import thirdbody as tb
from thirdbody.laws.particle.series import Deep

from .chaudhri1984 import HARD, PLATEN, STIFF
from .row import Band, row_of

__all__ = ["ROW", "over_truncation"]

FRICTIONS = (0.05, 0.2, 0.5)
"""Friction factor of the faces [1]."""
SQUASHED = (0.2, 0.3, 0.4)
"""Squash of one half over R."""


@cache
def over_truncation(squash: float, deep: Deep) -> tuple[float, ...]:
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
    ratios = []
    for m in FRICTIONS:
        law = tb.particle.Series(deep=deep, friction_factor=m)
        for H in HARD:
            for E in STIFF:
                sphere = tb.Material(E=E, nu=0.33, H=H)
                one = law.one(surfaces=tb.MaterialPair(PLATEN, PLATEN), particle=sphere)
                # almost all of the squeeze is the sphere's: 1e-4 is the platens'
                area = one.at(np.array([squash])).areas[0][0] / (np.pi / 4)
                ratios.append(float(area / (squash * (2 - squash))))
    return tuple(ratios)


def _band(squash: float) -> Band:
    off = Band.from_values(over_truncation(squash, "off"))
    return Band.from_values(over_truncation(squash, "table"), f'deep = "off": {off.text}')


ROW = row_of("flattened_area", {f"area-{squash:g}": partial(_band, squash) for squash in SQUASHED})
