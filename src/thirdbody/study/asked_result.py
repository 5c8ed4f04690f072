"""Results of studies that ask one question: a title, a table, and what the answer hangs on."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Protocol

from ..quantities.plain_data import plain_data
from ..quantities.record import VERSION, Entry, MappedRecord, declared_columns
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
class QuestionResult(MappedRecord):
    """Results of a study that asks one question; indexed, the plain data of `to_dict`.

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
