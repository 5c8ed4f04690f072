"""Results of studies that ask one question: a title, a table, and what the answer hangs on."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

from ..quantities.plain_data import plain_data
from ..quantities.record import (
    VERSION,
    Column,
    Entry,
    MappedRecord,
    TableRecord,
    Variable,
    declared_columns,
)
from ..version import __version__
from .described import Described
from .what_ifs import WhatIf

__all__ = ["AskedResult", "QuestionResult", "answer_entries", "question_entries"]


class Asked(Protocol):
    """Protocol of a study that asks one question."""

    @property
    def title(self) -> str:
        """Title as in the file, or empty."""

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes of reading, one sentence each."""

    @property
    def assumed(self) -> tuple[str, ...]:
        """Notes on numbers that were taken because the file leaves them out."""

    @property
    def described_inputs(self) -> Described:
        """Inputs with symbols and units."""


def question_entries(*entries: Entry) -> tuple[Entry, ...]:
    """Entries of a result between title and warnings, and these."""
    return ("title", "asked.title"), VERSION, *entries, "warnings", "citations"


def answer_entries(inputs: tuple[Entry, ...], *numbers: Entry) -> tuple[Entry, ...]:
    """Entries of an `AskedResult`: its inputs, and numbers beside the table."""
    states: Entry = ("states", lambda answer: answer.table()[0])
    return question_entries(("inputs", inputs), states, *numbers, "what_ifs")


@dataclass(frozen=True, eq=False, kw_only=True)
class QuestionResult(MappedRecord, TableRecord):
    """Results of a study that asks one question; indexed, the plain data of `to_dict`.

    As labelled data and as a table they are the columns of `table`, along the first of them.

    Attributes
    ----------
    asked : Asked
        What the study says.
    """

    asked: Asked
    title_without: ClassVar[str]
    """Title of a study without one."""
    citations: ClassVar[tuple[str, ...]]
    """The works behind the numbers."""

    @property
    def title(self) -> str:
        """Title of the study, or of its kind."""
        return self.asked.title or self.title_without

    @property
    @abstractmethod
    def run_notes(self) -> tuple[str, ...]:
        """Notes of computing, one sentence each."""

    @property
    def warnings(self) -> tuple[str, ...]:
        """Notes of reading and of computing, one sentence each."""
        return tuple(dict.fromkeys((*self.asked.notes, *self.run_notes)))

    @abstractmethod
    def table(self) -> tuple[dict[str, list[object]], dict[str, str]]:
        """Columns, and their units."""

    @property
    @abstractmethod
    def meanings(self) -> Mapping[str, str]:
        """Meanings of the columns."""

    def variables(self) -> dict[str, Variable]:
        """Every column but the first."""
        return dict(self._columns()[1:])

    def coordinates(self) -> dict[str, Variable]:
        """The first column."""
        return dict(self._columns()[:1])

    def _columns(self) -> list[tuple[str, Variable]]:
        """Every column by its name."""
        columns, units = self.table()
        along, declared = next(iter(columns)), declared_columns(type(self))
        about = {
            name: declared.get(name) or Column("", units[name], self.meanings[name])
            for name in columns
        }
        return [
            (name, Variable((along,), _with_nan(values), about[name].labels))
            for name, values in columns.items()
        ]

    def attributes(self) -> Mapping[str, object]:
        """Version, warnings and citations."""
        said = {"warnings": self.warnings, "citations": self.citations}
        return {"version": __version__} | {name: "\n".join(lines) for name, lines in said.items()}


def _with_nan(values: list[object]) -> np.ndarray:
    """A column with NaN, or no word, where there is nothing."""
    nothing = "" if any(isinstance(value, str) for value in values) else np.nan
    return np.array([nothing if value is None else value for value in values])


@dataclass(frozen=True, eq=False, kw_only=True)
class AskedResult(QuestionResult):
    """Results of a study without a solved contact.

    Attributes
    ----------
    what_ifs : tuple of WhatIf
        What the answer hangs on, the most first.
    run_warnings : tuple of str
        What is to be said of the answer.
    """

    what_ifs: tuple[WhatIf, ...] = ()
    run_warnings: tuple[str, ...] = ()

    @property
    def run_notes(self) -> tuple[str, ...]:
        """The sentences of ``run_warnings``."""
        return self.run_warnings

    @property
    def meanings(self) -> Mapping[str, str]:
        """Meanings as the columns declare them."""
        return {name: column.meaning for name, column in declared_columns(type(self)).items()}

    def table(self) -> tuple[dict[str, list[object]], dict[str, str]]:
        """Columns, and their units."""
        declared = declared_columns(type(self))
        columns = {name: plain_data(getattr(self, name)) for name in declared}
        return columns, {name: column.unit for name, column in declared.items()}
