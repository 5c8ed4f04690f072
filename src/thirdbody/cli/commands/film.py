"""``thirdbody film``: film thickness, load shares and friction of a lubricated contact."""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...quantities.progress import heartbeat
from ...quantities.say import value_of
from ...quantities.tables import Table
from ...version import __version__
from ..options import Force, JsonFile, ParquetFile, Settings, XlsxFile, read_study
from ..show import ALL, MOST_ROWS, some, terminal
from ..streams import STDOUT, TableFiles, figure_format, warn_of, write_figure

if TYPE_CHECKING:
    from ...study import FilmResult
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


def command(
    study: Annotated[
        Path, typer.Argument(metavar="STUDY.toml", help="A study file with a table [film].")
    ],
    json_file: JsonFile = None,
    csv_file: Annotated[
        Path | None, typer.Option("--csv", metavar="FILE", help="Write one row per speed.")
    ] = None,
    xlsx_file: XlsxFile = None,
    parquet_file: ParquetFile = None,
    force: Force = False,
    figure: Annotated[
        Path | None, typer.Option("--figure", metavar="FILE", help="Draw the curve over speed.")
    ] = None,
    settings: Settings = None,
) -> None:
    """Film, load shares and friction of a lubricated contact, at one speed or over many."""
    from ...study import run_film

    files = TableFiles(csv_file, xlsx_file, parquet_file, json_file)
    asked = read_study(study, settings, writes=[*files.paths, figure])
    files.need(figure, force=force)
    if figure is not None:
        figure_format(figure)  # refused before long work
    with heartbeat("film"):
        result = run_film(asked)
    warn_of(result.run_warnings)
    drawn = None
    if figure is not None:
        from ...views.plot.film import stribeck

        drawn = stribeck(result.states, result.regime_speeds)
    files.write(
        *result.table(),
        sheets=partial(_sheets, result),
        data=result.to_dict,
    )
    for path in files.paths:
        print(f"written: {path}", file=sys.stderr)
    if figure is not None:
        write_figure(figure, drawn)
    if json_file != STDOUT:
        _show(result)


def _sheets(result: FilmResult) -> list[Sheet]:
    from ...views.film_words import bodies, summary
    from ...views.study_sheets import film_sheets

    return film_sheets(result, [bodies(result), *summary(result)])


def _show(result: FilmResult) -> None:
    """The result for a reader: the point or the curve, then in words."""
    from ...views.film_words import bodies, point, summary

    console = terminal()
    console.print(f"{result.title} (thirdbody {__version__})")
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
