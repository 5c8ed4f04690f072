"""The paper's checkable statements and its errata as data."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from ..ledger import Claim, claims_of, data_of

__all__ = ["PAPER", "Errata", "claims", "errata"]

PAPER = "horng2022"


@dataclass(frozen=True)
class Errata:
    """One slip of the paper and what the readings do about it."""

    erratum: int
    where: str
    printed: str
    used: str
    why: str
    applied: str


def claims() -> tuple[Claim, ...]:
    """All statements in the order of the paper.

    Returns
    -------
    tuple of Claim

    Examples
    --------
    >>> from thirdbody.papers.horng2022.claims import claims
    >>> len(claims())
    84
    """
    return claims_of(PAPER)


@cache
def errata() -> tuple[Errata, ...]:
    """The errata that bear on the figures.

    Returns
    -------
    tuple of Errata

    Examples
    --------
    >>> from thirdbody.papers.horng2022 import errata
    >>> errata()[0].erratum
    1
    """
    return tuple(Errata(**entry) for entry in data_of(PAPER)["errata"])
