"""The four sheets of a workbook that answers one question: answer, states, inputs, notes."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from ..errors import rank_notes
from ..populations.materials import NUMBERS
from ..quantities.say import unit_of
from ..version import __version__
from .printed_tables import grid_of_words
from .report.sources import Row, as_stated, bodies_by_label, value_rows
from .study_sheets import amount_cells, note_line
from .workbook import Grid, Sheet, sheet_of_table

if TYPE_CHECKING:
    from ..populations.materials import Material
    from ..quantities.value import Value
    from ..study.described import BareNumber

__all__ = ["inputs_of", "question_sheets"]


def question_sheets(
    title: str,
    answer: Sequence[str],
    table: tuple[Sequence[str], Sequence[Sequence[str]]] | None,
    last: Sequence[str | Grid | bytes],
    *,
    states: tuple[Mapping[str, Sequence[object]], Mapping[str, str]],
    meanings: Mapping[str, str],
    inputs: Sequence[tuple[object, ...]],
    warnings: Iterable[str],
    citations: Iterable[str],
) -> list[Sheet]:
    """Sheets of an answer, as the command prints it, and of everything behind it.

    Parameters
    ----------
    title : str
    answer : sequence of str
        Sentences above the table.
    last : sequence of str, Grid or bytes
        Sentences, tables and pictures below it.
    table : (heads, rows), optional
        As it is printed.
    states : (columns, units)
        Every number, as in the CSV file.
    meanings : mapping
        Of the columns.
    inputs : sequence of tuple
        Rows of the sheet Inputs, as `inputs_of` makes them.
    warnings, citations : iterable of str
    """
    columns, units = states
    contents: list[str | Grid | bytes] = [*answer]
    if table is not None:
        contents.append(grid_of_words(*table))
    column_rows = [(name, unit_of(units.get(name, "")), meanings.get(name, "")) for name in columns]
    notes = [note_line(note) for note in rank_notes(warnings)] or [("none", None, "")]
    cited = [(line, None, "") for line in (*citations, f"thirdbody {__version__}")]
    return [
        Sheet("Answer", (*contents, *last), title=f"{title} (thirdbody {__version__})"),
        sheet_of_table("States", columns, units),
        Sheet("Inputs", (Grid(("input", "symbol", "value", "unit", "from", "name"), inputs),)),
        Sheet(
            "Notes",
            (
                Grid(("note", "effect on the answer", "what to do"), notes),
                Grid(("column of States", "unit", "meaning"), column_rows),
                Grid(("to be cited", "", ""), cited),
            ),
        ),
    ]


def inputs_of(
    values: Mapping[str, Value],
    bodies: Mapping[str, Material],
    numbers: Iterable[BareNumber] = (),
    stated: Collection[str] = frozenset(),
) -> list[tuple[object, ...]]:
    """A row an input: of values by what their names begin with, "plate.", then of materials.

    Numbers that are no fields of a value stand first. Of what the file states none is a default.
    """
    rows = [
        Row(number.name, number.about["symbol"], "", number.about["meaning"], False,
            number.value, number.about["unit"])
        for number in numbers
    ]  # fmt: skip
    rows += [row for name, value in values.items() for row in value_rows(value, name)]
    rows = as_stated(rows, stated)
    out: list[tuple[object, ...]] = [
        (row.meaning, row.symbol, *amount_cells(row), "default" if row.default else "study",
         row.name)
        for row in rows
    ]  # fmt: skip
    for label, body in bodies_by_label(dict(bodies)):
        for key, about in NUMBERS.items():
            if (value := getattr(body, key)) is not None:
                row = Row(key, about["symbol"], "", about["meaning"], False, value, about["unit"])
                said = (f"{label}: {row.meaning}", row.symbol, *amount_cells(row))
                out.append((*said, body.name, key))
    return out
