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
from ..options import AsJson, Force, ParquetFile, Settings, XlsxFile, read_study
from ..show import ALL, MOST_ROWS, some, terminal
from ..streams import TableFiles, figure_format, warn_of, write_figure

if TYPE_CHECKING:
    from ...study import FilmResult

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
    settings: Settings = None,
) -> None:
    """Film, load shares and friction of a lubricated contact, at one speed or over many."""
    from ...study import run_film

    files = TableFiles(csv_file, xlsx_file, parquet_file)
    asked = read_study(study, settings, writes=[*files, figure])
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
    files.write(*result.table())
    for path in files.paths:
        print(f"written: {path}", file=sys.stderr)
    if figure is not None:
        write_figure(figure, drawn)
    if as_json:
        print(json.dumps(result.to_dict(), indent=1, allow_nan=False))
    else:
        _show(result)


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
