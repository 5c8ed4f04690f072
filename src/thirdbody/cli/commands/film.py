"""``thirdbody film``: film thickness, load shares and friction of a lubricated contact."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

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
    from rich.console import Console

    from ...study import FilmResult
    from ...study.dirty_oil import DirtyOil
    from ...study.oil_columns import OilColumn
    from ...study.oil_what_ifs import OilWhatIf
    from ...views.workbook import Grid, Sheet

__all__ = ["command"]

MEANS = {
    "speed": "mean speed at which the surfaces drag the oil in",
    "film h_T": "mean gap",
    "lambda": "that over the RMS roughness, no unit",
    "on film": "its part of the load",
    "friction": "coefficient mu, no unit",
}
"""What the heads of the curve mean."""
WORKBOOK = "--xlsx FILE has all of it"
DROP = ("lambda", "on film")
"""Columns in the order in which they go where the width is small."""


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of the command."""

    study: Path = argument("A study file with a table [film].", "STUDY.toml")
    json: JsonFile = None
    csv: Path | None = option("--csv", "Write a table, one row per speed, e.g. a.csv.", "FILE")
    xlsx: XlsxFile = None
    parquet: ParquetFile = None
    force: Force = False
    figure: Path | None = option(
        "--figure", "Draw the film over speed, as .png, .svg or .pdf.", "FILE"
    )
    filter_text: FilterText = None
    settings: Settings = None


def command(options: Options) -> None:
    """What an oil film and its dirt do: who carries, dents, life.

    Of a lubricated contact, at one speed or over many.
    """
    from ...study import run_film
    from ...study.dirty_oil import need_particles, read_filter

    fine = None if options.filter_text is None else read_filter(options.filter_text)
    files = TableFiles(options.csv, options.xlsx, options.parquet, options.json)
    study = read_study(options.study, options.settings, writes=[*files.paths, options.figure])
    if fine is not None:
        need_particles(study)
        study = replace(study, filter=fine)
    files.need(options.figure, force=options.force)
    if options.figure is not None:
        figure_format(options.figure)  # refused before long work
    with heartbeat("film"):
        result = run_film(study)
        film = _Found(result, result.oil, result.oil_filtered, result.what_ifs)
    warn_of(result.run_warnings)
    drawn = None
    if options.figure is not None:
        from ...views.film_figure import draw_film

        drawn = draw_film(result)
    files.write(
        *film.table(),
        sheets=partial(_sheets, film),
        data=result.to_dict,
    )
    tell_written(*files.paths)
    if options.figure is not None and drawn is not None:
        write_figure(options.figure, drawn)
    if options.json != STDOUT:
        _show(film)


class _Found(NamedTuple):
    """Everything that the command finds."""

    result: FilmResult
    oil: DirtyOil | None
    filtered: DirtyOil | None
    what_ifs: tuple[OilWhatIf, ...]

    def answer(self) -> list[str]:
        """What the particles of the oil do, or who carries where there are none."""
        from ...views import film_words, oil_words

        if self.oil is None:
            return film_words.answer(self.result)
        first = [] if self.filtered is None else [oil_words.filter_answer(self.oil, self.filtered)]
        return [*first, *oil_words.answer(self.oil)]

    def oil_columns(self) -> list[OilColumn]:
        """What the oil does, beside the columns of the film."""
        from ...study.oil_columns import columns_of_oil

        speeds = self.result.states["speed"].tolist()
        behind = columns_of_oil(self.filtered, speeds, before="oil_filtered: ")
        return [*columns_of_oil(self.oil, speeds), *behind]

    def table(self) -> tuple[dict[str, list[object]], dict[str, str]]:
        """Columns, a row a speed, and their units."""
        columns, units = self.result.table()
        for column in self.oil_columns():
            columns[column.name], units[column.name] = list(column.values), column.unit
        return columns, units

    def oil_table(self) -> tuple[Sequence[str], list[list[str]]]:
        """Heads and rows of the populations, before and after a filter where there is one."""
        from ...views import oil_words

        assert self.oil is not None
        if self.filtered is None:
            return oil_words.HEADS, oil_words.rows(self.oil)
        return ("", "before", "after the filter"), oil_words.filter_rows(self.oil, self.filtered)

    def natures(self) -> list[str]:
        """What the particles of each population are, a sentence each."""
        from ...views.nature_words import sentences

        return sentences(self.result.natures)

    def rest(self) -> list[str]:
        """Sentences below the tables; without particles in the oil the first is in the answer."""
        from ...views.film_words import summary

        return summary(self.result)[self.oil is None :]


def _sheets(film: _Found) -> list[Sheet]:
    from ...views import bearing_words, oil_words
    from ...views.film_words import bodies
    from ...views.printed_tables import grid_of_words
    from ...views.study_sheets import film_sheets

    content: list[str | Grid] = [*film.answer()]
    if film.oil is not None:
        content.append(grid_of_words(*film.oil_table()))
    content += [*oil_words.uncertainty(film.what_ifs), *film.natures()]
    if bearing_words.shares_load(study := film.result.study):
        content += [
            bearing_words.sharing(study),
            grid_of_words(bearing_words.HEADS, bearing_words.rows(study)),
        ]
    content += [bodies(film.result), *film.rest()]
    meanings = {column.name: column.meaning for column in film.oil_columns()}
    return film_sheets(film.result, content, film.table(), meanings)


def _show(film: _Found) -> None:
    """The result for a reader: the answer, what the oil does, the point or the curve, the rest."""
    from ...views.film_words import bodies, point
    from ...views.oil_words import uncertainty

    console, result = terminal(), film.result
    console.print(f"{result.heading} (thirdbody {__version__})")
    for sentence in film.answer():
        console.print(sentence)
    if film.oil is not None:
        console.print(_oil_table(film))
    for sentence in [*uncertainty(film.what_ifs), *film.natures()]:
        console.print(sentence)
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
    for sentence in film.rest():
        console.print(sentence)


def _oil_table(film: _Found) -> Table:
    """What the particles of the oil do."""
    from ...views import oil_words as words

    heads, rows = film.oil_table()
    if film.filtered is None:
        table = Table(
            heads, right=True, words=heads[:1], drop=words.DROP, more=ALL, legend=words.MEANS
        )
    else:
        table = Table(heads)
    for row in rows:
        table.add_row(*row)
    return table


def _show_bearing(console: Console, result: FilmResult) -> None:
    """How the bodies of a bearing share its load."""
    from ...views import bearing_words as words

    if not words.shares_load(result.study):
        return
    console.print(words.sharing(result.study))
    table = Table(words.HEADS, right=True, drop=words.DROP, more=WORKBOOK, legend=words.MEANS)
    for row in words.rows(result.study):
        table.add_row(*row)
    console.print(table)


def _curve(result: FilmResult) -> object:
    """A row a speed; of many speeds some, evenly spread."""
    from ...views.columns import film_columns

    states, columns = result.states, film_columns(result)
    heads = [*(column.head for column in columns), "regime"]
    table = Table(heads, right=True, drop=DROP, more=ALL, legend=MEANS)
    for i in some(len(states["speed"])):
        cells = (column.words(float(states[column.name][i])) for column in columns)
        table.add_row(*cells, states["regime"][i])
    return table
