"""The paper's checkable statements and its errata as data."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

from ..ledger import Claim

__all__ = ["Errata", "claims", "errata", "study_data"]


@cache
def study_data() -> dict[str, Any]:
    """The data file: paper, definitions, claims and errata."""
    text = resources.files("thirdbody").joinpath("data/horng2022_claims.json").read_text("utf-8")
    return json.loads(text)


@dataclass(frozen=True)
class Errata:
    """One slip of the paper and what the readings do about it."""

    erratum: int
    where: str
    printed: str
    used: str
    why: str
    applied: str


@cache
def claims() -> tuple[Claim, ...]:
    """All statements in the order of the paper.

    Returns
    -------
    tuple of Claim

    Examples
    --------
    >>> len(claims())
    84
    """
    return tuple(
        Claim(**{**entry, "conflicts": tuple(entry.get("conflicts", ()))})
        for entry in study_data()["claims"]
    )


@cache
def errata() -> tuple[Errata, ...]:
    """The errata that bear on the figures.

    Returns
    -------
    tuple of Errata

    Examples
    --------
    >>> errata()[0].erratum
    1
    """
    return tuple(Errata(**entry) for entry in study_data()["errata"])
