"""Wafers, films and plates on a chuck: how high they stand over a particle."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

import numpy as np

from ...study.plate import AskedPlate
from ...study.run_plate import run_plate
from ...systems.chuck import Chuck
from ...systems.plate_over_particle import ATOM
from ...views.plate_words import answer, facts, heads, rows, uncertainty
from ..fields import Field
from ..figures import escape_tags, figure, line
from ..question import Question, QuestionTab, Shown
from ..state import Answer, State

__all__ = ["START", "TITLE", "build", "contents_of"]

TITLE = "Wafer"
START: dict[str, object] = {"thickness": "775 um", "pressure": "80 kPa"}
GRAIN = Field(
    name="grain",
    kind="text",
    label="particle x [m]",
    about="diameters to tell of, with commas between; without them quantiles of the dust",
)


def _question_of(answer: Answer) -> AskedPlate:
    """What the study asks, or the start where it has no such table."""
    if (request := answer.study.plate) is not None:
        return request
    contact = answer.contact
    chuck = Chuck(
        thickness=775e-6,
        pressure=80e3,
        surfaces=contact.surfaces,
        particles=contact.populations,
        law=contact.particle_law,
    )
    return AskedPlate(title="", chuck=chuck, grains=np.empty(0))


def contents_of(answer_of_study: Answer) -> Shown:
    """The answer in words, numbers and a curve over the size of the particle."""
    request = _question_of(answer_of_study)
    result, chuck = run_plate(request), request.chuck
    sizes, kinds = result.curve()
    traces = []
    for i, (name, heights) in enumerate(kinds):
        seen = np.where(heights < ATOM, np.nan, heights)
        traces.append(line(1e6 * sizes, 1e9 * seen, escape_tags(name), i))
    traces.append(line(1e6 * sizes, 1e9 * sizes, "as high as the particle", 5))
    if chuck.limit is not None:
        level = np.full(2, 1e9 * chuck.limit)
        traces.append(line(1e6 * sizes[[0, -1]], level, "limit", 3))
    return Shown(
        answer=answer(result),
        facts=list(facts(result).items()),
        notes=[*uncertainty(result), *(f"Note: {text}" for text in result.run_warnings)],
        heads=heads(result),
        rows=rows(result),
        figure=figure(
            traces,
            x="diameter of the particle [µm]",
            y="height of the plate [nm]",
            title="How high the plate stands",
            ylog=True,
        ),
    )


QUESTION = Question(
    table="plate",
    about="How high does a wafer, film or plate stand over a particle on its chuck? The plate is "
    "the first surface at the side, the chuck the second, and the particles are those there.",
    kind=Chuck,
    first_entries=(GRAIN,),
    start=START,
    left_out=("law",),
    contents=contents_of,
)


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """The answer, entries, a curve and a table."""
    return QuestionTab(state, QUESTION).draw
