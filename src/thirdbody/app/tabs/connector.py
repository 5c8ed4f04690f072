"""Connectors in dust: how often they fail to close, over the contact force."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

import numpy as np

from ...study.connector import AskedConnector
from ...study.run_connector import run_connector
from ...systems.connector import Connector
from ...views.connector_words import HEADS, SELDOM, answer, facts, rows, uncertainty
from ..fields import Field
from ..figures import figure, line, mark
from ..question import Question, QuestionTab, Shown
from ..state import Answer, State

__all__ = ["START", "TITLE", "build", "contents_of"]

TITLE = "Connector"
START: dict[str, object] = {"radius": "2 mm", "force": "0.5 N", "contacts": 20}
FORCE = Field(
    name="force",
    kind="text",
    label="contact force W [N]",
    about="of each contact: one value with its unit, or several with commas between",
)


def _question_of(answer: Answer) -> AskedConnector:
    """What the study asks, or the start where it has no such table."""
    if (request := answer.study.connector) is not None:
        return request
    contact = answer.contact
    plug = Connector(
        radius=2e-3,
        contacts=20,
        surfaces=contact.surfaces,
        particles=contact.populations,
        law=contact.particle_law,
    )
    return AskedConnector(title="", connector=plug, forces=np.array([0.5]))


def contents_of(answer_of_study: Answer) -> Shown:
    """The answer in words, numbers and a curve over the force."""
    request = _question_of(answer_of_study)
    result, plug = run_connector(request), request.connector
    forces, one, every = result.curve()
    traces = [line(forces, np.where(one > SELDOM, one, np.nan), "one contact", 0)]
    if plug.contacts > 1:
        traces.append(line(forces, np.where(every > SELDOM, every, np.nan), "connector", 1))
    made = figure(
        traces,
        x="contact force [N]",
        y="part of all closings that fail",
        title="How often it fails to close",
        ylog=True,
    )
    made["layout"]["shapes"] = [
        mark(float(force), "", dash="solid")[0] for force in request.forces[:1]
    ]
    return Shown(
        answer=answer(result),
        facts=list(facts(result).items()),
        notes=[*uncertainty(result), *(f"Note: {text}" for text in result.run_warnings)],
        heads=HEADS,
        rows=rows(result),
        figure=made,
    )


QUESTION = Question(
    table="connector",
    about="How often does a connector, relay or switch fail to close because of dust? Dust that "
    "lies where contacts meet keeps the metal apart, unless the force presses it in. The dust and "
    "the metal are those at the side.",
    kind=Connector,
    first_entries=(FORCE,),
    start=START,
    left_out=("law",),
    contents=contents_of,
)


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """The answer, entries, a curve and a table."""
    return QuestionTab(state, QUESTION).draw
