"""``thirdbody probability``: how often a connector, relay or switch fails to close on dust."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ...quantities.progress import heartbeat
from ...quantities.tables import WordTable
from ..answers import give_answer, read_question
from ..options import Force, JsonFile, ParquetFile, Settings, XlsxFile
from ..streams import TableFiles, warn_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ...study.run_connector import ConnectorResult

__all__ = ["command", "warn_of"]


def command(
    study: Annotated[
        Path,
        typer.Argument(
            metavar="STUDY.toml",
            help="A study file with tables [surfaces], [particles], [connector]; "
            "`thirdbody new connector` writes one.",
        ),
    ],
    json_file: JsonFile = None,
    csv_file: Annotated[
        Path | None,
        typer.Option("--csv", metavar="FILE", help="Write a table, one row per force, e.g. a.csv."),
    ] = None,
    xlsx_file: XlsxFile = None,
    parquet_file: ParquetFile = None,
    figure: Annotated[
        Path | None,
        typer.Option(
            "--figure",
            metavar="FILE",
            help="Draw how often it fails over the force, as .png, .svg or .pdf.",
        ),
    ] = None,
    force: Force = False,
    settings: Settings = None,
) -> None:
    """How often dust keeps a connector, relay or switch open."""
    from ...study.run_connector import load_connector, run_connector
    from ...views.connector_words import HEADS, MEANS, answer, rows, uncertainty

    files = TableFiles(csv_file, xlsx_file, parquet_file, json_file)
    question = read_question(load_connector, study, settings, files, figure=figure, force=force)
    with heartbeat("probability"):
        result = run_connector(question)
    give_answer(
        result,
        files,
        settings=settings,
        answer=answer(result),
        table=WordTable(HEADS, rows(result), MEANS),
        last=uncertainty(result),
        draw=partial(_draw, result),
        figure=figure,
    )


def _draw(result: ConnectorResult) -> Figure:
    from ...views.plot.questions import draw_failures

    return draw_failures(result)
