"""``thirdbody film``: film thickness, load shares and friction of a lubricated contact."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...quantities.progress import heartbeat
from ...quantities.say import value_of
from ...quantities.tables import Table
from ...version import __version__
from ..options import (
    FilterText,
    Force,
    JsonFile,
    ParquetFile,
    Settings,
    XlsxFile,
    argument,
    option,
    read_study,
)
from ..show import ALL, MOST_ROWS, some, terminal
from ..streams import STDOUT, TableFiles, figure_format, tell_written, warn_of, write_figure

if TYPE_CHECKING:
    from ...study import FilmResult
    from ...study.dirty_oil import DirtyOil
    from ...views.workbook import Sheet

__all__ = ["command"]

MEANS = {
    "speed": "mean speed at which the surfaces drag the oil in",
    "film h_T": "mean gap",
    "lambda": "that over the RMS roughness, no unit",
    "on film": "its part of the load",
    "friction": "coefficient mu, no unit",
}
"""What the heads of the curve mean."""
DROP = ("lambda", "on film")
"""Columns in the order in which they go where the width is small."""


@dataclass(frozen=True, kw_only=True)
class Options:
    """What the command is told."""

    study: Path = argument("A study file with a table [film].", "STUDY.toml")
    json: JsonFile = None
    csv: Path | None = option("--csv", "Write one row per speed.", "FILE")
    xlsx: XlsxFile = None
    parquet: ParquetFile = None
    force: Force = False
    figure: Path | None = option("--figure", "Draw the curve over speed.", "FILE")
    filter_text: FilterText = None
    settings: Settings = None


def command(options: Options) -> None:
    """Film, load shares and friction of a lubricated contact, at one speed or over many."""
    from ...study import run_film
    from ...study.dirty_oil import dirty_oil, need_particles, read_filter

    fine = None if options.filter_text is None else read_filter(options.filter_text)
    files = TableFiles(options.csv, options.xlsx, options.parquet, options.json)
    asked = read_study(options.study, options.settings, writes=[*files.paths, options.figure])
    if fine is not None:
        need_particles(asked)
    files.need(options.figure, force=options.force)
    if options.figure is not None:
        figure_format(options.figure)  # refused before long work
    with heartbeat("film"):
        result = run_film(asked)
        oil = dirty_oil(asked)
        filtered = None if fine is None else dirty_oil(asked, filter=fine)
    warn_of(result.run_warnings)
    drawn = None
    if options.figure is not None:
        from ...views.plot.film import stribeck

        drawn = stribeck(result.states, result.regime_speeds)
    files.write(
        *result.table(),
        sheets=partial(_sheets, result, oil, filtered),
        data=partial(_data, result, oil, filtered),
    )
    tell_written(*files.paths)
    if options.figure is not None and drawn is not None:
        write_figure(options.figure, drawn)
    if options.json != STDOUT:
        _show(result, oil, filtered)


def _data(result: FilmResult, oil: DirtyOil | None, filtered: DirtyOil | None) -> dict[str, Any]:
    found = {"oil": oil, "oil_filtered": filtered}
    return result.to_dict() | {
        name: each.to_dict() for name, each in found.items() if each is not None
    }


def _sheets(result: FilmResult, oil: DirtyOil | None, filtered: DirtyOil | None) -> list[Sheet]:
    from ...views import oil_words
    from ...views.film_words import bodies, summary
    from ...views.study_sheets import film_sheets

    answer = [] if oil is None else oil_words.answer(oil)
    if oil is not None and filtered is not None:
        answer = [oil_words.filter_answer(oil, filtered), *answer]
    return film_sheets(result, [*answer, bodies(result), *summary(result)])


def _show(result: FilmResult, oil: DirtyOil | None, filtered: DirtyOil | None) -> None:
    """The result for a reader: the answer, the point or the curve, then in words."""
    from ...views.film_words import bodies, point, summary

    console = terminal()
    console.print(f"{result.title} (thirdbody {__version__})")
    if oil is not None:
        _show_oil(console, oil, filtered)
    _show_bearing(console, result)
    states, sigma = result.states, result.study.contact.roughness.sigma
    console.print(f"{bodies(result)}, sigma = {value_of(sigma, 'm')}")
    total = len(states["speed"])
    if total == 1:
        head = f"at {value_of(states['speed'][0], 'm/s')}"
        table = Table((head, "value"), words=[head])
        for name, value in point(result, 0).items():
            table.add_row(name, value)
        console.print(table)
    else:
        console.print(_curve(result))
    if total > MOST_ROWS:
        console.print(f"{MOST_ROWS} of {total} speeds shown; --csv FILE writes all\n")
    for sentence in summary(result):
        console.print(sentence)


def _show_oil(console: Any, oil: DirtyOil, filtered: DirtyOil | None) -> None:
    """What the particles of the oil do, before and after a filter where there is one."""
    from ...views import oil_words as words

    if filtered is not None:
        console.print(words.filter_answer(oil, filtered))
    for sentence in words.answer(oil):
        console.print(sentence)
    if filtered is None:
        table = Table(
            words.HEADS, right=True, words=words.HEADS[:1], drop=words.DROP, more=ALL,
            legend=words.MEANS,
        )  # fmt: skip
        for row in words.rows(oil):
            table.add_row(*row)
    else:
        table = Table(("", "before", "after the filter"))
        for row in words.filter_rows(oil, filtered):
            table.add_row(*row)
    console.print(table)


def _show_bearing(console: Any, result: FilmResult) -> None:
    """How the bodies of a bearing share its load."""
    from ...views import bearing_words as words

    if not words.shares_load(result.study):
        return
    console.print(words.sharing(result.study))
    table = Table(words.HEADS, right=True, drop=words.DROP, more=ALL, legend=words.MEANS)
    for row in words.rows(result.study):
        table.add_row(*row)
    console.print(table)


def _curve(result: FilmResult) -> Any:
    """A row a speed; of many speeds some, evenly spread."""
    from ...views.columns import film_columns

    states, columns = result.states, film_columns(result)
    heads = [*(each.head for each in columns), "regime"]
    table = Table(heads, right=True, drop=DROP, more=ALL, legend=MEANS)
    for i in some(len(states["speed"])):
        cells = (each.words(float(states[each.name][i])) for each in columns)
        table.add_row(*cells, states["regime"][i])
    return table
