r"""Fatigue under an oil that changes: two sums of damage over the life factor of ISO 281.

.. math:: D = \int \frac{dt}{a_{ISO}(t)\,L_{10}}, \qquad D = 1 \text{ at the rating life}

Dents that were rolled over stay when the oil is cleaned. What a dirty hour leaves behind lies
between two extremes: ``forgets`` takes the code of the moment, ``remembers`` the worst so far.
The pair is the answer; most factors of the standard are from memory here, and give an order.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.carried import takes_units
from ...quantities.record import Record
from ..bearing_life import contamination_factor, life_factor

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["FatiguePair", "miner_pair"]


def __dir__() -> list[str]:
    return sorted(__all__)


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class FatiguePair(Record):
    """Damage and rating life of a bearing over a history of codes; made by `miner_pair`.

    Examples
    --------
    >>> from thirdbody.systems.life.fatigue import miner_pair
    >>> pair = miner_pair([0.0, 3.6e5], codes=["-/19/16", "-/13/10"], end=7.2e5, place="bath",
    ...                   bearing="ball", kappa=1.0, D=0.05, load_ratio=0.1, L_10=3.6e7)
    >>> round(pair.forgets / 3600), round(pair.remembers / 3600)
    (13261, 2244)
    """

    forgets: float
    """Rating life with the code of each moment [s]; the last code goes on."""
    remembers: float
    """The same with the worst code so far [s]."""
    damage_forgets: float
    """D at the end of the history [1]."""
    damage_remembers: float
    """D at the end of the history, with the worst code so far [1]."""
    factors: Array
    """a_ISO of each stretch [1]: (N,)."""


@takes_units
def miner_pair(
    times: Sequence[float],
    *,
    codes: Sequence[str],
    end: float,
    place: str,
    bearing: str,
    kappa: float,
    D: float,
    load_ratio: float,
    L_10: float,
) -> FatiguePair:
    r"""Rating life of a bearing in an oil whose code changes, by Miner's sum, twice.

    Parameters
    ----------
    times : sequence of float
        When each stretch begins, increasing from 0 [s].
    codes : sequence of str
        ISO 4406 code of each.
    end : float
        End of the history [s].
    place : {"filter", "bath"}
        As in `thirdbody.systems.bearing_life`.
    bearing : {"ball", "roller"}
        Kind of the bearing.
    kappa : float
        Viscosity ratio κ [1].
    D : float
        Pitch diameter [m].
    load_ratio : float
        C_u/P, fatigue load limit over equivalent load [1].
    L_10 : float
        Rating life without the factor [s].

    Returns
    -------
    FatiguePair

    Raises
    ------
    InvalidValue
        Times that do not increase from 0, an end before the last, or what the factors refuse.

    Notes
    -----
    Palmgren and Miner's sum of parts of life is an assumption, with no memory of the order but
    that of ``remembers``.

    References
    ----------
    Miner 1945, J. Appl. Mech. 12, A159 (from memory: not confirmed in a source); ISO 281:2007.

    Examples
    --------
    >>> from thirdbody.systems.life.fatigue import miner_pair
    >>> clean = miner_pair([0.0], codes=["-/13/10"], end=3.6e6, place="bath", bearing="ball",
    ...                    kappa=1.0, D=0.05, load_ratio=0.1, L_10=3.6e7)
    >>> round(clean.forgets / 3600), clean.forgets == clean.remembers
    (13775, True)
    """
    t = np.asarray(times, float)
    if len(t) != len(codes) or not len(t):
        rule = f"({len(t)}) and codes ({len(codes)}) must be as many, and some"
        raise InvalidValue(Problem("times", rule, code=Mistake.SHAPE))
    if t[0] != 0 or np.any(np.diff(t) <= 0) or not end >= t[-1]:
        rule = "must increase from 0 and not pass end [s]"
        raise InvalidValue(Problem("times", rule, code=Mistake.ORDER))
    if not (math.isfinite(L_10) and L_10 > 0 and math.isfinite(load_ratio) and load_ratio > 0):
        rule = f"and load_ratio = {load_ratio:g} [1] must be > 0"
        raise InvalidValue(Problem("L_10", rule, f"{L_10:g} [s]", code=Mistake.RANGE))
    factors_by_code: dict[str, float] = {}
    for code in codes:
        if code not in factors_by_code:
            e_C = contamination_factor(place, code, kappa=kappa, D=D)
            factors_by_code[code] = life_factor(bearing, kappa=kappa, load=e_C * load_ratio)
    now = np.array([factors_by_code[code] for code in codes])
    worst = np.minimum.accumulate(now)
    (forgets, damage), (remembers, kept) = (
        _life_and_damage(t, a * L_10, end) for a in (now, worst)
    )
    return FatiguePair(
        forgets=forgets,
        remembers=remembers,
        damage_forgets=damage,
        damage_remembers=kept,
        factors=now,
    )


def _life_and_damage(start: Array, life: Array, end: float) -> tuple[float, float]:
    """When the sum of dt over life reaches 1, the last stretch going on, and the sum at the end."""
    before = np.concatenate([[0.0], np.cumsum(np.diff(start) / life[:-1])])
    last = int(np.flatnonzero(before < 1)[-1])
    reached = float(start[last] + (1 - before[last]) * life[last])
    return reached, float(before[-1] + (end - start[-1]) / life[-1])
