"""Results of studies that solve no contact: a table, and what the answer hangs on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from ..quantities.plain_data import plain_data
from ..quantities.record import MappedRecord, declared_columns
from ..version import __version__
from .what_ifs import WhatIf

__all__ = ["AskedResult"]


@dataclass(frozen=True, eq=False, kw_only=True)
class AskedResult(MappedRecord):
    """Results of a study without a solved contact; indexed, the plain data of `to_dict`.

    Attributes
    ----------
    asked
        What the study says.
    what_ifs : tuple of WhatIf
        What the answer hangs on, the most first.
    run_warnings : tuple of str
        What is to be said of the answer.
    """

    asked: Any
    what_ifs: tuple[WhatIf, ...] = ()
    run_warnings: tuple[str, ...] = ()
    title_without: ClassVar[str]
    """Title of a study without one."""
    citations: ClassVar[tuple[str, ...]]
    """The works behind the numbers."""

    @property
    def title(self) -> str:
        """Title of the study, or of its kind."""
        return str(self.asked.title or self.title_without)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Notes of reading and of computing, one sentence each."""
        return tuple(dict.fromkeys((*self.asked.notes, *self.run_warnings)))

    def table(self) -> tuple[dict[str, list[Any]], dict[str, str]]:
        """Columns, and their units."""
        declared = declared_columns(type(self))
        columns = {name: plain_data(getattr(self, name)) for name in declared}
        return columns, {name: each.unit for name, each in declared.items()}

    def inputs(self) -> dict[str, Any]:
        """Inputs as plain data."""
        raise NotImplementedError

    def numbers(self) -> dict[str, Any]:
        """Results beside the table, as plain data."""
        raise NotImplementedError

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        return {
            "title": self.asked.title,
            "version": __version__,
            "inputs": self.inputs(),
            "states": self.table()[0],
            **self.numbers(),
            "what_ifs": [each.to_dict() for each in self.what_ifs],
            "warnings": list(self.warnings),
            "citations": list(self.citations),
        }
