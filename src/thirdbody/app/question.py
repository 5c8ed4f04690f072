"""A tab that answers one question: the answer at once, then the entries, a figure and a table."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from nicegui import ui

from .fields import Field, fields_of
from .figures import Figure
from .inputs import Inputs
from .state import Answer, State
from .text import as_shown
from .widgets import Facts, Plot, set_attributes, table

__all__ = ["Question", "QuestionTab", "Shown"]


NOTE = "Note: "
"""How a sentence begins that the badge tells."""


class Shown(NamedTuple):
    """What is shown of an answer: plain words, numbers and a figure."""

    answer: list[str]
    facts: list[tuple[str, str]]
    notes: list[str]
    heads: tuple[str, ...]
    rows: list[list[str]]
    figure: Figure


class Question(NamedTuple):
    """What a tab asks.

    Parameters
    ----------
    table : str
        The table of the study that holds what is asked.
    about : str
        What the tab is for.
    kind : type
        The class that the table stands for.
    first_entries : tuple of Field
        Entries of the table beside those of the class, first.
    start : dict
        The table where the study has none.
    left_out : tuple of str
        Fields of the class that have no entry.
    contents : callable
        What is shown of an answer, and of the start where the study has no such table.
    """

    table: str
    about: str
    kind: type
    first_entries: tuple[Field, ...]
    start: dict[str, object]
    left_out: tuple[str, ...]
    contents: Callable[[Answer], Shown]


class QuestionTab:
    """One question, its answer first."""

    def __init__(self, state: State, question: Question) -> None:
        self.state, self.question, self.tab = state, question, state.tab
        self.inputs = Inputs(state, self._refresh_form)
        self.has_entries = False
        """Whether the form has entries, or a button that makes them."""
        self.answer: Answer | None = None
        name = question.table
        self.words = ui.column().classes("w-full gap-1 headline-place")
        self.none = ui.label("Add particles at the side: without them there is nothing to ask.")
        ui.label(question.about).classes("hint")
        with ui.element("div").classes("figures w-full") as self.grid:
            self.beside = ui.column().classes("w-full gap-1")
            with self.beside:
                self.facts = Facts(kind=f"{name}: ")
                with ui.element("div").classes("pair w-full"):
                    self.plot = Plot(name)
                    self.rows = ui.column().classes("w-full")
                self.notes = ui.column().classes("w-full gap-0")
            with ui.column().classes("w-full entries"):
                self._form()

    def _is_asked(self) -> bool:
        return isinstance(self.state.get(self.question.table), dict)

    def _refresh_form(self) -> None:
        self._form.refresh()

    @ui.refreshable_method
    def _form(self) -> None:
        self.inputs.shown.clear()
        question, name = self.question, self.question.table
        self.has_entries = self._is_asked()
        self.grid.classes(**{"remove" if self.has_entries else "add": "alone"})
        with ui.column().classes("w-full gap-2 narrow"):
            if not self.has_entries:
                values = ", ".join(f"{key} {value}" for key, value in question.start.items())
                ui.label(as_shown(f"Shown for {values}.")).classes("hint")
                change = ui.button("Change these", icon="edit", on_click=self._start_question)
                set_attributes(change.props("no-caps"), {"data-path": f"{name}.add"})
                return
            for field in (*question.first_entries, *fields_of(question.kind)):
                if field.name not in question.left_out:
                    self.inputs.field((name,), field)
            remove = ui.button("Remove", icon="delete", on_click=self._remove_question)
            set_attributes(remove.props("flat dense no-caps"), {"data-path": f"{name}.remove"})
            self.inputs.rest = ui.column().classes("w-full")

    def _start_question(self) -> None:
        self.inputs.change(self.question.table, self.question.start)

    def _remove_question(self) -> None:
        self.inputs.change(self.question.table, None)

    async def draw(self) -> None:
        """The answer of the study as it is now."""
        if self._is_asked() != self.has_entries:  # undone, or another study
            self._refresh_form()
        self.inputs.show_mistakes()
        answer = self.state.answer
        assert answer is not None
        self.none.set_visibility(answer.contact.two_body)
        for element in (self.words, self.beside):
            element.set_visibility(not answer.contact.two_body)
        if answer.contact.two_body or answer is self.answer:
            return
        shown: Shown = await self.state.ask(self.question.contents)
        self.answer = answer
        await self._show(shown)

    async def _show(self, shown: Shown) -> None:
        name = self.question.table
        self.words.clear()
        with self.words:
            for i, text in enumerate(shown.answer):
                said = ui.label(as_shown(text)).classes("whole-contact" if i == 0 else "")
                set_attributes(said, {"data-fact": f"{name}: answer {i}"})
        self.facts.show(shown.facts)
        self.rows.clear()
        with self.rows:
            heads = {f"c{i}": head for i, head in enumerate(shown.heads)}
            table(name, heads, [dict(zip(heads, row, strict=True)) for row in shown.rows])
        self.notes.clear()
        with self.notes:
            for text in shown.notes:
                if not text.startswith(NOTE):
                    ui.label(as_shown(text)).classes("hint")
        noted = [text.removeprefix(NOTE) for text in shown.notes if text.startswith(NOTE)]
        self.state.note(self.tab, noted)
        await self.plot.show(shown.figure)
