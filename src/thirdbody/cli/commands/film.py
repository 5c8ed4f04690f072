"""``thirdbody film``: film thickness, load shares and friction of a lubricated contact."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...quantities.progress import heartbeat
from ...quantities.say import number, value_of
from ...quantities.tables import Table
from ...version import __version__
from ..options import AsJson, FilterText, Force, ParquetFile, Settings, XlsxFile, read_study
from ..show import ALL, MOST_ROWS, some, terminal
from ..streams import TableFiles, figure_format, warn_of, write_figure

if TYPE_CHECKING:
    from ...study import FilmResult
    from ...study.dirty_oil import DirtyOil

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
    as_json: AsJson = False,
    csv_file: Annotated[
        Path | None, typer.Option("--csv", metavar="FILE", help="Write one row per speed.")
    ] = None,
    xlsx_file: XlsxFile = None,
    parquet_file: ParquetFile = None,
    force: Force = False,
    figure: Annotated[
        Path | None, typer.Option("--figure", metavar="FILE", help="Draw the curve over speed.")
    ] = None,
    filter_text: FilterText = None,
    settings: Settings = None,
) -> None:
    """Film, load shares and friction of a lubricated contact, at one speed or over many."""
    from ...study import run_film
    from ...study.dirty_oil import dirty_oil, need_particles, read_filter

    fine = None if filter_text is None else read_filter(filter_text)
    files = TableFiles(csv_file, xlsx_file, parquet_file)
    asked = read_study(study, settings, writes=[*files, figure])
    if fine is not None:
        need_particles(asked)
    files.need(figure, force=force)
    if figure is not None:
        figure_format(figure)  # refused before long work
    with heartbeat("film"):
        result = run_film(asked)
        oil = dirty_oil(asked)
        filtered = None if fine is None else dirty_oil(asked, filter=fine)
    warn_of(result.run_warnings)
    drawn = None
    if figure is not None:
        from ...views.plot.film import stribeck

        drawn = stribeck(result.states, result.regime_speeds)
    files.write(*result.table())
    for path in files.paths:
        print(f"written: {path}", file=sys.stderr)
    if figure is not None:
        write_figure(figure, drawn)
    if as_json:
        found = {"oil": oil, "oil_filtered": filtered}
        told = {name: each.to_dict() for name, each in found.items() if each is not None}
        print(json.dumps(result.to_dict() | told, indent=1, allow_nan=False))
    else:
        _show(result, oil, filtered)


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
    from ...views.film_words import share

    states = result.states
    shares = {"film_share": "on film", "ss_share": "on asperities"}
    if result.passing:
        shares["sa_share"] = "on particles"
    known = any(map(math.isfinite, states["mu"]))
    heads = ["speed", "film h_T", "lambda", *shares.values(), *["friction"] * known, "regime"]
    table = Table(heads, right=True, drop=DROP, more=ALL, legend=MEANS)
    for i in some(len(states["speed"])):
        table.add_row(
            value_of(states["speed"][i], "m/s"),
            value_of(states["h_T"][i], "m"),
            number(states["lambda_ratio"][i]),
            *(share(states[name][i]) for name in shares),
            *[number(states["mu"][i])] * known,
            states["regime"][i],
        )
    return table
