"""Beside the headline: how far the answer holds, as a badge that opens what it leaves open."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from nicegui import ui

from ..errors import Note, rank_notes
from ..quantities.say import percent
from .state import Answer, State
from .tabs.interface import headline
from .text import as_shown, without_paths
from .widgets import set_attributes

__all__ = ["Badge", "Verdict", "badge_of"]

LITTLE = 0.1
"""An effect up to which an answer is called good."""
OWN_HEADLINE = ("interface", "film", "connector", "plate", "before_after")
"""Tabs that begin with a headline of their own."""
QUESTIONS = ("connector", "plate")
"""Tabs whose answer is not that of the pressed surfaces, and so not their limits."""
OWN_ANSWER = (*OWN_HEADLINE, "take_away", "explicit")
"""Tabs over which the sentence of the contact says nothing."""


class Badge(NamedTuple):
    """How far an answer holds: a class of the style sheet, an icon, and words."""

    kind: str
    icon: str
    words: str


def badge_of(notes: Sequence[str]) -> Badge:
    """The badge of an answer with these notes, by the largest of their effects.

    >>> badge_of([]).words, badge_of([Note("a", effect=0.04)]).words
    ('inside all ranges', 'good to about 4 %')
    >>> badge_of([Note("a", effect=0.04), "b"]).words, badge_of([Note("a", effect=0.283)]).words
    ('partly beyond its ranges', 'may be off by 28 %')
    """
    if not notes:
        return Badge("holds", "check_circle", "inside all ranges")
    effects = [note.effect if isinstance(note, Note) else math.nan for note in notes]
    largest = max((effect for effect in effects if not math.isnan(effect)), default=0.0)
    said = percent(largest, digits=2)
    if largest > LITTLE:
        return Badge("doubtful", "error_outline", f"may be off by {said}")
    if any(map(math.isnan, effects)):
        return Badge("doubtful", "error_outline", "partly beyond its ranges")
    return Badge("near", "info", f"good to about {said}")


def sentence_of(answer: Answer, at: float) -> str:
    """The answer under the operating load as a sentence; empty where none is solved."""
    point = answer.solve(at)
    return headline(point, answer.particles_held) if str(point.status) == "ok" else ""


class Verdict:
    """The line under the tabs: the answer as a sentence, its badge, and how long it took."""

    def __init__(self, state: State) -> None:
        self.state = state
        self.noted: list[str] | None = None
        """What the badge tells."""
        self.tab = state.tab
        """The tab that the badge is of."""
        self.shown: tuple[Answer, float] | None = None
        """What the sentence is of."""
        with ui.element("div").classes("verdict") as self.line:
            self.sentence = set_attributes(ui.label().classes("sentence"), {"data-fact": "answer"})
            with ui.element("div").classes("standing"):
                self.badge = ui.button(icon="info", color=None).classes("badge")
                self.badge.props("flat dense no-caps")
                set_attributes(self.badge, {"data-fact": "validity"})
                with self.badge:
                    self.menu = ui.menu().props('anchor="bottom right" self="top right"')
                with self.menu:
                    self.list = ui.column().classes("limits gap-2")
                self.clock = ui.label().classes("hint").props('data-fact="time"')
            self.remark = ui.label().classes("hint remark")
        self.badge.set_visibility(False)
        self.place()

    def place(self) -> None:
        """Beside the headline of a tab that has one, else with a sentence of its own."""
        beside = self.state.tab in OWN_HEADLINE
        self.line.classes(**{"add" if beside else "remove": "beside"})
        self.sentence.set_visibility(self.state.tab not in OWN_ANSWER)

    def turn(self) -> None:
        """Another tab is in sight: a badge that may not be its own waits until it is drawn."""
        self.place()
        notes_of_both = self.state.noted.get(self.tab), self.state.noted.get(self.state.tab)
        if self.tab != self.state.tab and (
            any(notes_of_both) or {self.tab, self.state.tab} & {*QUESTIONS}
        ):
            self.badge.set_visibility(False)

    async def show_sentence(self) -> None:
        """The sentence of the answer as it is now."""
        answer = self.state.answer
        if answer is None:
            return
        if self.shown == (answer, at := self.state.operating_load):
            return
        self.sentence.set_text(as_shown(await self.state.ask(sentence_of, at)))
        self.shown = (answer, at)

    def note(self, remark: str) -> None:
        """What the answer and that of the tab leave open, and a remark of the page."""
        answer = self.state.answer
        notes = list(self.state.noted.get(self.state.tab, []))
        if answer is not None and self.state.tab not in QUESTIONS:
            notes = [*answer.notes, *notes]
        self.remark.set_text(remark)
        self.remark.set_visibility(bool(remark))
        ranked = rank_notes(notes)
        self.tab = self.state.tab
        self.badge.set_visibility(True)
        if ranked == self.noted:
            return
        self.noted = ranked
        made = badge_of(ranked)
        self.badge.set_icon(made.icon)
        self.badge.set_text(made.words)
        self.badge.classes(replace=f"badge {made.kind}")
        set_attributes(self.badge, {"aria-label": f"how far the answer holds: {made.words}"})
        self.list.clear()
        with self.list:
            if not ranked:
                ui.label("Every law is used inside the range for which it was derived or tested.")
            for text in ranked:
                with ui.element("div").classes("limit"):
                    ui.label(as_shown(without_paths(str(text))))
