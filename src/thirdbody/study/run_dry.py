"""A study of a dry contact over time: particles that arrive, stay, act and leave."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..contact.citations import cite
from ..errors import InvalidValue, RangeWarning
from ..quantities.plain_data import plain_data
from ..quantities.record import Entry, with_names
from ..systems.life.contact_history import DryHistory
from ..systems.life.run import life
from .asked_result import QuestionResult, question_entries
from .life_bands import LifeBands, check_dry, propagate_dry
from .life_dry import AskedDry

if TYPE_CHECKING:
    from ..systems.life.history import LifeHistory
    from .life import AskedLife

__all__ = ["DryResult", "bands_of_dry", "drawn_of", "life_of_asked", "run_dry"]

DURATION: Entry = ("duration", "asked.duration")
UNTIL: Entry = ("until", "asked.until")
FLOWS: Entry = (
    "flows",
    lambda result: [{"from": a, "to": b, "kg": mass} for a, b, mass in result.history.flows()],
)


@dataclass(frozen=True, eq=False, kw_only=True)
class DryResult(QuestionResult):
    """Results of `run_dry`; indexed, they are the plain data of `to_dict`.

    Attributes
    ----------
    asked : AskedDry
    history : DryHistory
    bands : LifeBands, optional
        Where the study says what is known of its numbers.
    """

    in_dict = question_entries(
        (
            "inputs",
            (("contact", "asked.contact"), ("conditions", "asked.conditions"), DURATION, UNTIL),
        ),
        *(("", "history"), ("steady", with_names("history.steady")), FLOWS, "bands"),
    )
    asked: AskedDry
    history: DryHistory
    bands: LifeBands | None = None

    title_without = "Life of a dry contact"

    @property
    def citations(self) -> tuple[str, ...]:  # type: ignore[override]
        """The works behind the numbers."""
        return (
            "Fillot, Iordanoff, Berthier 2007, Wear 262, 1196, doi:10.1016/j.wear.2006.10.011",
            *cite(self.asked.contact).splitlines(),
        )

    @property
    def run_notes(self) -> tuple[str, ...]:
        """Those of the history."""
        return self.history.warnings

    @property
    def meanings(self) -> Mapping[str, str]:
        """Meanings of the columns."""
        out = {"time": "since the beginning", "eta": "particles per area of the contact"}
        out |= {name: f"mass, {name}" for name in self._masses()}
        return out | {name: about.meaning for name, (about, _) in self.history.more.items()}

    def _masses(self) -> dict[str, np.ndarray]:
        columns = self.history.ledger.over_time()
        return {name.replace("in the oil", "in the contact"): v for name, v in columns.items()}

    def table(self) -> tuple[dict[str, list[object]], dict[str, str]]:
        """Columns, a row a time, and their units."""
        history = self.history
        columns: dict[str, list[object]] = {
            "time": plain_data(history.times),
            "eta": plain_data(history.numbers.sum(axis=(1, 2))),
        }
        units = {"time": "s", "eta": "1/m^2"}
        for name, values in self._masses().items():
            columns[name], units[name] = plain_data(values), "kg"
        for name, (about, values) in history.more.items():
            columns[name], units[name] = plain_data(np.asarray(values)), about.unit
        return columns, units


def _arguments(request: AskedDry) -> dict[str, Any]:
    """Arguments of `thirdbody.life` beside contact, duration and events."""
    return {**request.conditions, "debris": request.debris, "running_in": request.running_in}


def life_of_asked(request: AskedLife | AskedDry, **arguments: Any) -> LifeHistory | DryHistory:
    """The history that a study asks for; its warnings stand in it, and are not told twice."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        try:
            return life(duration=request.duration, until=request.until, **arguments)
        except InvalidValue as error:
            raise InvalidValue(
                *(
                    problem.move_under("life") if problem.place == "duration" else problem
                    for problem in error.problems
                )
            ) from None


def drawn_of(request: AskedLife | AskedDry) -> dict[str, Any]:
    """Arguments that say what is drawn of a study, and over which time."""
    return {
        "vary": request.uncertainty,
        "duration": request.duration,
        "until": request.until,
        "samples": request.drawn.samples,
        "seed": request.drawn.seed,
    }


def bands_of_dry(
    request: AskedDry, *, progress: bool = False, keep: Path | None = None
) -> LifeBands | None:
    """Bands of a dry contact; None where the study says nothing of what is known.

    Parameters
    ----------
    request : AskedDry
    progress, keep
        As in `thirdbody.study.life_bands.propagate_life`.
    """
    if not request.uncertainty:
        return None
    with request.drawn.in_file():
        return propagate_dry(
            request.contact, **drawn_of(request), conditions=_arguments(request), progress=progress,
            keep=keep,
        )  # fmt: skip


def run_dry(request: AskedDry, *, progress: bool = False, keep: Path | None = None) -> DryResult:
    """The history of a dry contact, as its study asks.

    Parameters
    ----------
    request : AskedDry
        As `thirdbody.study.run_life.load_life` reads it.
    progress : bool, optional
        As in `thirdbody.study.life_bands.propagate_dry`.
    keep : Path, optional
        As in `thirdbody.study.run_life.run_life`.
    """
    if request.uncertainty:
        with request.drawn.in_file():
            check_dry(request.contact, vary=request.uncertainty, conditions=_arguments(request))
    one: dict[str, Any] = {} if keep is None or request.uncertainty else {"keep": keep}
    history = life_of_asked(request, contact=request.contact, **_arguments(request), **one)
    assert isinstance(history, DryHistory)
    bands = bands_of_dry(request, progress=progress, keep=keep)
    return DryResult(asked=request, history=history, bands=bands)
