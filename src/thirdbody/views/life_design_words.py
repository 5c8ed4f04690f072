"""What to choose for an oil, in words: the smallest filter for a code, the longest time."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ..quantities.say import join_words, number
from .life_amounts import duration_of

if TYPE_CHECKING:
    from ..study.run_life_design import LifeDesign

__all__ = ["MEANS", "answer", "heads", "last_words", "rows"]

MEANS = {
    "comes to": "ISO 4406 code of the oil that no longer changes",
    "least flow": "with which the filter is enough",
}


SAME = 1.005
"""Factor of times below which they are the same."""


def answer(result: LifeDesign) -> list[str]:
    """What to take, and what that gives."""
    return _for_code(result) if result.codes else _longest(result)


def _for_code(result: LifeDesign) -> list[str]:
    design = result.asked.design
    assert design is not None
    if not result.best:
        none = "The filter is" if len(result.names) == 1 else f"None of the {len(result.names)} is"
        low = np.nanmin(result.flows) if np.any(np.isfinite(result.flows)) else math.nan
        with_flow = (
            "; more flow is not enough either, as it holds too few of the particles"
            if math.isnan(low)
            else f"; with {_flow(low)} {result.names[int(np.nanargmin(result.flows))]} would be"
        )
        what = " not enough" if len(result.names) == 1 else " enough"
        return [f"{none}{what} for {design.code}{with_flow}."]
    code = result.codes[result.names.index(result.best)]
    first = "is enough" if len(result.names) == 1 else f"is the first of {len(result.names)} enough"
    return [f"{result.best[0].upper()}{result.best[1:]} {first} for {design.code}: the oil comes "
            f"to {code}."]  # fmt: skip


def _longest(result: LifeDesign) -> list[str]:
    (event,) = result.asked.until
    end = duration_of(result.asked.duration)
    never = [n for n, time in zip(result.names, result.times, strict=True) if math.isinf(time)]
    if never:
        out = f"With {join_words(never)} it takes more than {end} until {event.sentence}"
        more = ": a longer life.duration tells them apart" if len(never) > 1 else ""
        return [f"{out}{more}."]
    time = float(np.max(result.times))
    next_best = sorted(float(time) for time in result.times)[-2]
    more = f", {number(time / next_best, 3)} times as long as with the next" if next_best else ""
    if time < SAME * next_best:
        more = ", about as long as with the next"
    said = f"With {result.best} it takes longest until {event.sentence}"
    return [f"{said}: {duration_of(time)}{more}."]


def _flow(cubic_metres: float) -> str:
    return f"{number(6e4 * cubic_metres, 3)} L/min"


def heads(result: LifeDesign) -> tuple[str, ...]:
    """Heads of the table."""
    if result.codes:
        return ("filter", "comes to", "least flow")
    return ("choice", "time")


def rows(result: LifeDesign) -> list[list[str]]:
    """The table: a row a choice."""
    if result.codes:
        flows = ["none is enough" if math.isnan(f) else _flow(f) for f in result.flows]
        return [list(row) for row in zip(result.names, result.codes, flows, strict=True)]
    times = [
        f"more than {duration_of(result.asked.duration)}"
        if math.isinf(t)
        else duration_of(float(t))
        for t in result.times
    ]
    return [list(row) for row in zip(result.names, times, strict=True)]


def last_words(result: LifeDesign) -> list[str]:
    """What was not known."""
    return [
        "What nobody can predict: the ingress, and whether filters hold in service what their data "
        "sheets say. The beta ratios are taken as constant; in engines they fell with flow and "
        "hours. See whether the choice stays with twice and half of what enters, and with service "
        "= 0.5 of each filter."
    ]
