"""``thirdbody plate``: how high a wafer, film or plate stands over a particle."""

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

    from ...study.run_plate import PlateResult

__all__ = ["command", "warn_of"]


def command(
    study: Annotated[
        Path,
        typer.Argument(
            metavar="STUDY.toml",
            help="A study file with tables [surfaces], [particles], [plate]; "
            "`thirdbody new wafer-chuck` writes one.",
        ),
    ],
    json_file: JsonFile = None,
    csv_file: Annotated[
        Path | None,
        typer.Option(
            "--csv", metavar="FILE", help="Write a table, one row per particle, e.g. a.csv."
        ),
    ] = None,
    xlsx_file: XlsxFile = None,
    parquet_file: ParquetFile = None,
    figure: Annotated[
        Path | None,
        typer.Option(
            "--figure",
            metavar="FILE",
            help="Draw the height over the diameter, as .png, .svg or .pdf.",
        ),
    ] = None,
    force: Force = False,
    settings: Settings = None,
) -> None:
    """How high a wafer or plate stands over a particle.

    And how often it is too high: bumps above a limit, plates without one.
    """
    from ...study.run_plate import load_plate, run_plate
    from ...views.plate_words import MEANS, answer, heads, rows, uncertainty

    files = TableFiles(csv_file, xlsx_file, parquet_file, json_file)
    question = read_question(load_plate, study, settings, files, figure=figure, force=force)
    with heartbeat("plate"):
        result = run_plate(question)
    give_answer(
        result,
        files,
        settings=settings,
        answer=answer(result),
        table=WordTable(heads(result), rows(result), MEANS),
        last=uncertainty(result),
        draw=partial(_draw, result),
        figure=figure,
    )


def _draw(result: PlateResult) -> Figure:
    from ...views.plot.questions import draw_heights

    return draw_heights(result)
