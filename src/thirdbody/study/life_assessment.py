"""How sure the answer of an oil or a dry contact over time is: bands, and what decides them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ..errors import InvalidValue, Mistake, Problem
from .asked_result import QuestionResult, question_entries
from .life import AskedDry, AskedLife
from .life_bands import COUNT, LifeBands
from .run_life import bands_of

__all__ = ["LifeAssessment", "assess_life"]


@dataclass(frozen=True, eq=False, kw_only=True)
class LifeAssessment(QuestionResult):
    """Results of `assess_life`; indexed, they are the plain data of `to_dict`.

    Attributes
    ----------
    asked : AskedLife or AskedDry
    bands : LifeBands
    """

    in_dict = question_entries(
        ("inputs", lambda life: {n: repr(one) for n, one in life.asked.uncertainty.items()}),
        ("", "bands"),
        (
            "missed",
            lambda life: {name: life.bands.count_missed(name) for name in life.bands.reached},
        ),
    )
    asked: AskedLife | AskedDry
    bands: LifeBands

    title_without = "How sure a life is"
    citations = ()

    @property
    def run_notes(self) -> tuple[str, ...]:
        """None: they are those of `thirdbody life`."""
        return ()

    def table(self) -> tuple[dict[str, list[object]], dict[str, str]]:
        """Columns, a row an input, and their units."""
        swings = self.bands.swings
        unit = "1/m^3" if self.bands.swings_of == COUNT else "m"
        columns: dict[str, list[object]] = {
            "input": [swing.name for swing in swings],
            "at_low": [swing.low for swing in swings],
            "at_high": [swing.high for swing in swings],
            "factor": [swing.factor for swing in swings],
        }
        return columns, {"input": "", "at_low": unit, "at_high": unit, "factor": "1"}

    @property
    def meanings(self) -> Mapping[str, str]:
        """Meanings of the columns."""
        of = self.bands.swings_of
        return {
            "input": "that alone is moved",
            "at_low": f"{of} at the end, the input at its lowest probability",
            "at_high": f"{of} at the end, the input at its highest",
            "factor": "the larger over the smaller",
        }


def assess_life(
    request: AskedLife | AskedDry, *, progress: bool = False, keep: Path | None = None
) -> LifeAssessment:
    """Bands of a life, from its table [life.uncertainty].

    Parameters
    ----------
    request : AskedLife or AskedDry
        As `thirdbody.study.run_life.load_life` reads it.
    progress, keep
        As in `thirdbody.study.run_life.bands_of`.

    Raises
    ------
    InvalidValue
        Nothing is said of what is known.
    """
    bands = bands_of(request, progress=progress, keep=keep)
    if bands is None:
        raise InvalidValue(
            Problem(
                "life.uncertainty", "is missing: what is known of the numbers", code=Mistake.MISSING
            )
        )
    return LifeAssessment(asked=request, bands=bands)
