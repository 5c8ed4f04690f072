"""How sure the answer of a life is, in words, and what decides it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from ..quantities.say import number, percent, value_of
from .life_words import words_of_bands

if TYPE_CHECKING:
    from ..study.life_assessment import LifeAssessment

__all__ = ["HEADS", "MEANS", "answer", "last_words", "rows"]

HEADS = ("input", "at its low end", "at its high end", "factor")
MEANS = {"factor": "the larger over the smaller, the other inputs as the study has them"}


def answer(assessment: LifeAssessment) -> list[str]:
    """Bands of code, wear and times."""
    return words_of_bands(assessment.bands)[:-1]


def rows(assessment: LifeAssessment) -> list[list[str]]:
    """The table: a row an input, the one that moves most first."""
    bands = assessment.bands
    unit = "1/m^3" if bands.swings_of == "count from 6 µm" else "m"

    def amount(value: float) -> str:
        if unit == "m":
            return value_of(value, "m", 3) if value else "0"
        return f"{number(value / 1e6, 3)} per mL"

    return [
        [
            swing.name,
            amount(swing.low),
            amount(swing.high),
            number(swing.factor, 3) if math.isfinite(swing.factor) else "no end",
        ]
        for swing in bands.swings
    ]


def last_words(assessment: LifeAssessment) -> list[str]:
    """What moves the answer most, and what to do."""
    bands = assessment.bands
    most = words_of_bands(bands)[-1]
    low, high = min(bands.probabilities), max(bands.probabilities)
    return [
        f"The table is of the {bands.swings_of} at the end; each input alone at its "
        f"{percent(low)} and {percent(high)} ends.",
        f"{most} Measure that first.",
    ]
