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


def answer(found: LifeDesign) -> list[str]:
    """What to take, and what that gives."""
    return _for_code(found) if found.codes else _longest(found)


def _for_code(found: LifeDesign) -> list[str]:
    design = found.asked.design
    assert design is not None
    if not found.best:
        none = "The filter is" if len(found.names) == 1 else f"None of the {len(found.names)} is"
        low = np.nanmin(found.flows) if np.any(np.isfinite(found.flows)) else math.nan
        with_flow = (
            "; more flow is not enough either, as it holds too few of the particles"
            if math.isnan(low)
            else f"; with {_flow(low)} {found.names[int(np.nanargmin(found.flows))]} would be"
        )
        what = " not enough" if len(found.names) == 1 else " enough"
        return [f"{none}{what} for {design.code}{with_flow}."]
    code = found.codes[found.names.index(found.best)]
    first = "is enough" if len(found.names) == 1 else f"is the first of {len(found.names)} enough"
    return [f"{found.best[0].upper()}{found.best[1:]} {first} for {design.code}: the oil comes to "
            f"{code}."]  # fmt: skip


def _longest(found: LifeDesign) -> list[str]:
    (event,) = found.asked.until
    end = duration_of(found.asked.duration)
    never = [n for n, time in zip(found.names, found.times, strict=True) if math.isinf(time)]
    if never:
        out = f"With {join_words(never)} it takes more than {end} until {event.sentence}"
        more = ": a longer life.duration tells them apart" if len(never) > 1 else ""
        return [f"{out}{more}."]
    time = float(np.max(found.times))
    next_best = sorted(float(each) for each in found.times)[-2]
    more = f", {number(time / next_best, 3)} times as long as with the next" if next_best else ""
    if time < SAME * next_best:
        more = ", about as long as with the next"
    said = f"With {found.best} it takes longest until {event.sentence}"
    return [f"{said}: {duration_of(time)}{more}."]


def _flow(cubic_metres: float) -> str:
    return f"{number(6e4 * cubic_metres, 3)} L/min"


def heads(found: LifeDesign) -> tuple[str, ...]:
    """Heads of the table."""
    if found.codes:
        return ("filter", "comes to", "least flow")
    return ("choice", "time")


def rows(found: LifeDesign) -> list[list[str]]:
    """The table: a row a choice."""
    if found.codes:
        flows = ["none is enough" if math.isnan(f) else _flow(f) for f in found.flows]
        return [list(row) for row in zip(found.names, found.codes, flows, strict=True)]
    times = [
        f"more than {duration_of(found.asked.duration)}" if math.isinf(t) else duration_of(float(t))
        for t in found.times
    ]
    return [list(row) for row in zip(found.names, times, strict=True)]


def last_words(found: LifeDesign) -> list[str]:
    """What was not known."""
    return [
        "What nobody can predict: the ingress, and whether filters hold in service what their data "
        "sheets say. The beta ratios are taken as constant; in engines they fell with flow and "
        "hours. See whether the choice stays with twice and half of what enters, and with service "
        "= 0.5 of each filter."
    ]
