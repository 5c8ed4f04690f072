"""The sheets of a workbook of a study: the answer, every state, the inputs, what is to be known."""

from __future__ import annotations

import warnings
from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..contact.evaluation import bodies_of
from ..equilibrium.columns import CODE
from ..equilibrium.modes import FAINT
from ..equilibrium.words import (
    critical_load,
    critical_name,
    happens,
)
from ..errors import Note, RangeWarning, rank_notes
from ..populations.materials import NUMBERS
from ..quantities.say import NOT_KNOWN, number, readable_unit, unit_of, value_of
from ..version import __version__
from .columns import Cell, Shown, film_columns, in_unit, modes_of, state_columns
from .figure_files import png_of
from .film_figure import draw_film
from .film_words import point
from .report.figures import first_figure
from .report.found import Found, some_of
from .report.make import USUAL, curve_over
from .report.sources import (
    Row,
    as_stated,
    bodies_by_label,
    film_rows,
    laws_of,
    load_rows,
    rows_of,
    sources_of,
    value_rows,
)
from .state_words import answer, details, uncertainty
from .workbook import Grid, Sheet, cell_of, cell_of_words, sheet_of_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    from ..contact.contact import Contact
    from ..study import FilmResult, StudyResult

__all__ = [
    "amount_cells",
    "film_sheets",
    "grid_of",
    "note_line",
    "state_sheets",
]

MOST_ROWS = 100
"""States on the sheet of the answer."""
MOST_LOADS = 6
"""Loads beside each other in the table of outputs."""
CODED = {CODE: "number of the status, 0 where the state is solved"}


# -------------------------------------------------------------------------- the answer
def state_sheets(result: StudyResult) -> list[Sheet]:
    """Sheets of what `run_study` found."""
    states, contact = result.states, result.study.contact
    columns = state_columns(contact)
    table = grid_of(columns, {column.name: getattr(states, column.name) for column in columns})
    if not contact.two_body:
        table = _with_column(table, "mode", modes_of(result))
    contents: list[str | Grid | bytes] = [*answer(result), *_some_rows(table), *uncertainty(result)]
    if not contact.two_body:
        contents.append(_critical_grid(result))
    if contact.outputs:
        contents.append(_output_grid(result))
    contents += details(result)
    contents.append(png_of(_figure_of_states(result)))
    meanings = _meanings_of_states(result)
    return _sheets(result, contents, _rows_of_study(result), meanings)


def film_sheets(
    result: FilmResult,
    sentences: Sequence[str | Grid],
    table: tuple[Mapping[str, Sequence[object]], Mapping[str, str]],
    more: Mapping[str, str],
) -> list[Sheet]:
    """Sheets of what `run_film` found.

    Parameters
    ----------
    result : FilmResult
    sentences : sequence of str or Grid
        The answer in words and tables, as the command prints it.
    table : tuple
        Columns of the sheet of states, and their units.
    more : mapping
        Meanings of those columns that are none of the result.
    """
    from ..systems.mixed_film import COLUMNS

    states = result.states
    contents: list[str | Grid | bytes] = [*sentences]
    if len(states["speed"]) == 1:
        at = {"speed": value_of(states["speed"][0], "m/s"), **point(result, 0)}
        rows = [(name, *cell_of_words(text)) for name, text in at.items()]
        contents.append(Grid(("at this speed", "value", "unit"), rows))
    else:
        curve = grid_of(film_columns(result), states)
        contents += _some_rows(_with_column(curve, "regime", states["regime"].tolist()))
    contents.append(png_of(draw_film(result)))
    meanings = {name: COLUMNS[name].meaning for name in states if name in COLUMNS}
    meanings |= {"hersey": "Hersey number", "largest": "largest particle dragged in", **CODED}
    for population in result.passing:
        meanings[f"{population.name}: passing"] = "share of its particles narrower than the gap"
        meanings[f"{population.name}: areal_density"] = "particles that enter, per area"
    study = result.study
    inputs = load_rows(study) if study.own_load else []
    inputs += [] if study.body is None else value_rows(study.body, "body.")
    inputs += [*film_rows(result), *rows_of(study.contact)]
    inputs = as_stated(inputs, study.stated)
    return _sheets(result, contents, inputs, meanings | dict(more), table)


def _some_rows(grid: Grid) -> list[str | Grid]:
    """A table, of many rows some, evenly spread, and a sentence that says so."""
    total = len(grid.rows)
    if total <= MOST_ROWS:
        return [grid]
    some = Grid(grid.heads, [grid.rows[i] for i in some_of(total, MOST_ROWS)])
    return [some, f"{MOST_ROWS} of {total} states; the sheet States has all."]


def grid_of(columns: Sequence[Shown], values: Mapping[str, ArrayLike]) -> Grid:
    """A table for readers, each column in the unit that suits most of its values."""
    drawn = [column.column(np.atleast_1d(values[column.name]).tolist()) for column in columns]
    return Grid([head for head, _ in drawn], list(zip(*(cells for _, cells in drawn), strict=True)))


def _with_column(grid: Grid, head: str, words: Sequence[object]) -> Grid:
    rows = [(*row, str(word)) for row, word in zip(grid.rows, words, strict=True)]
    return Grid([*grid.heads, head], rows)


def _critical_grid(result: StudyResult) -> Grid:
    """Critical loads, or on which side they lie."""
    E_ss = result.study.contact.E_ss
    entries = result.transitions.entries()
    load, pressure = Shown("F*", "F*", "1"), Shown("pressure", "pressure", "Pa")
    values = [entry.value for entry in entries.values()]
    head, first = load.column(values)
    head_2, second = pressure.column([None if v is None else v * E_ss for v in values])
    rows = []
    for (name, entry), F, p in zip(entries.items(), first, second, strict=True):
        if not isinstance(F, Cell):
            F, p = (critical_load(entry.value, entry.status, E) for E in (None, E_ss))
        rows.append((critical_name(name), F, p, entry.status, happens(name)))
    return Grid(("critical load", head, head_2, "status", "what happens there"), rows)


def _output_grid(result: StudyResult) -> Grid:
    """Grid of the outputs under each load; of many loads, some."""
    states = result.states
    some = some_of(len(states.status), MOST_LOADS)
    rows = []
    for name, values in states.outputs.items():
        about = states.about(name)
        numbers = [cell_of(float(values[i])) or NOT_KNOWN for i in some]
        rows.append((name, *numbers, unit_of(about.unit), about.meaning))
    loads = (f"at {value_of(states.pressure[i], 'Pa')}" for i in some)
    return Grid(("output", *loads, "unit", "meaning"), rows)


def _figure_of_states(result: StudyResult) -> Figure:
    """Modes over the load, of two bodies the area, with the loads of the study marked."""
    states, contact = result.states, result.study.contact.replace(outputs=())
    loads = np.sort([float(states.F_star[i]) for i in result.solved_states])
    loaded = loads[loads >= FAINT].tolist() or [USUAL]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)  # the answer has told of them
        curve = curve_over(contact, result.transitions, loaded)
    results = Found(
        study=result.study,
        result=result,
        curve=curve,
        assessment=None,
        slopes=None,
        at=result.solved_states[0],
    )
    axes, _ = first_figure(results)
    return axes.figure  # type: ignore[return-value]


# -------------------------------------------------------------------------- the others
def _sheets(
    result: StudyResult | FilmResult,
    contents: Sequence[str | Grid | bytes],
    inputs: Sequence[Row],
    meanings: Mapping[str, str],
    table: tuple[Mapping[str, Sequence[object]], Mapping[str, str]] | None = None,
) -> list[Sheet]:
    """The sheets, by what stands on the first; the columns of states are those of the result."""
    columns, units = result.table() if table is None else table
    contact = result.study.contact
    return [
        Sheet("Answer", tuple(contents), title=f"{result.heading} (thirdbody {__version__})"),
        sheet_of_table("States", columns, units),
        Sheet("Inputs", (_input_grid(inputs, contact), _source_grid(contact, result.study.stated))),
        Sheet("Notes", _notes(result, columns, units, meanings)),
    ]


def _rows_of_study(result: StudyResult) -> list[Row]:
    """Rows of loads, bodies and contact: inputs of the study, and assumed ones."""
    study = result.study
    rows = load_rows(study)
    rows += value_rows(study.body, "body.") if study.body is not None else []
    return as_stated([*rows, *rows_of(study.contact)], study.stated)


def _input_grid(rows: Sequence[Row], contact: Contact) -> Grid:
    """Grid of inputs, a row each, in units that suit them."""
    lines = [
        (
            row.meaning,
            row.symbol,
            *amount_cells(row),
            "default" if row.default else "study",
            row.name,
        )
        for row in rows
    ]
    for label, body in bodies_by_label(bodies_of(contact)):
        for key, about in NUMBERS.items():
            if (value := getattr(body, key)) is not None:
                row = Row(key, about["symbol"], "", about["meaning"], False, value, about["unit"])
                said = (f"{label}: {row.meaning}", row.symbol, *amount_cells(row))
                lines.append((*said, body.name, key))
    return Grid(("input", "symbol", "value", "unit", "from", "name"), lines)


def _source_grid(contact: Contact, stated: Collection[str]) -> Grid:
    """Where laws and the numbers of materials come from."""
    rows = [(f"material of {label}", body.name, "", "", "; ".join(filter(None, (*texts, standing))))
            for label, body in bodies_by_label(bodies_of(contact))
            for texts, standing in [sources_of(body)]]  # fmt: skip
    rows += [
        (
            f"{'' if what == 'output' else 'law of '}{what}, "
            f"{'study' if chosen else 'default'}: {law.title}",
            law.name,
            "",
            "",
            law.citation + (f", doi:{law.doi}" if law.doi else ""),
        )
        for what, law, chosen in laws_of(contact, stated)
    ]
    return Grid(("of", "name", "", "", "source"), rows)


def amount_cells(row: Row) -> tuple[Cell | str, str]:
    """A number in the unit in which it is read, and the unit; or words and none."""
    if row.amount is None:
        return row.value, ""
    size, unit = readable_unit(row.amount, row.unit)
    return Cell(in_unit(row.amount, size), number(row.amount / size)), unit


def _notes(
    result: StudyResult | FilmResult,
    columns: Mapping[str, object],
    units: Mapping[str, str],
    meanings: Mapping[str, str],
) -> tuple[Grid, ...]:
    """Warnings with what to do, the columns of the states, and what is to be cited."""
    notes = [note_line(note) for note in rank_notes(result.warnings)] or [("none", None, "")]
    column_rows = [(name, unit_of(units.get(name, "")), meanings.get(name, "")) for name in columns]
    cited = [(line, None, "") for line in (*result.citations, f"thirdbody {__version__}")]
    return (
        Grid(("note", "effect on the answer", "what to do"), notes),
        Grid(("column of States", "unit", "meaning"), column_rows),
        Grid(("to be cited", "", ""), cited),
    )


def note_line(note: str) -> tuple[str, Cell | None, str]:
    """A note, its effect on the answer, and what to do about it."""
    if not isinstance(note, Note):
        return note, None, ""
    what = note.removesuffix(f"; {note.action}") if note.action else note
    share = Shown("", "", "share")
    has_effect = np.isfinite(note.effect) and note.effect > 0
    cell = share.column([note.effect])[1][0] if has_effect else None
    return str(what), cell if isinstance(cell, Cell) else None, note.action


def _meanings_of_states(result: StudyResult) -> dict[str, str]:
    states = result.states
    out = {name: states.about(name).meaning for name in states.columns()}
    for population in states.populations:
        out |= {
            f"{population.name}: {name}": population.about(name).meaning
            for name in population.columns()
        }
    return out | CODED
