"""``thirdbody life``: an oil or a dry contact over time, and what reports of an oil say."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...quantities.progress import heartbeat
from ...quantities.tables import WordTable
from ..answers import give_answer, read_question
from ..interrupt import resumable
from ..options import (
    Force,
    JsonFile,
    KeepFile,
    ParquetFile,
    Settings,
    XlsxFile,
    argument,
    option,
)
from ..streams import TableFiles, warn_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ...views.plot.life import Histories

__all__ = ["command", "warn_of"]

FILM_TABLES = ("surfaces", "roughness", "film")
"""Tables with which dents are counted."""


@dataclass(frozen=True, kw_only=True)
class Options:
    """What the command is told."""

    study: Path = argument(
        "A study file with a table [life]; `thirdbody new` oil-circuit or dry-contact writes one.",
        "STUDY.toml",
    )
    reports: Path | None = option(
        "--reports",
        "Print what enters the oil, from a file with the head time [h],iso4406 and two or more "
        "lines, e.g. 500,18/16/13; or with counts, time [h],4 um [1/mL],6 um [1/mL],14 um [1/mL].",
        "OIL.csv",
    )
    flow_for: str | None = option(
        "--flow-for",
        "Print the least flow of each filter that brings the oil to a code, e.g. 16/14/11.",
        "CODE",
    )
    filter_text: str | None = option(
        "--filter",
        "Count dents with another filter too, by the beta ratios of its data sheet, sizes in "
        'um(c), e.g. "5=75, 10=1000".',
        "SIZE=BETA,...",
    )
    json: JsonFile = None
    csv: Path | None = option("--csv", "Write a table, one row per time, e.g. a.csv.", "FILE")
    xlsx: XlsxFile = None
    parquet: ParquetFile = None
    figure: Path | None = option(
        "--figure", "Draw codes, masses and flows of dirt, as .png, .svg or .pdf.", "FILE"
    )
    keep: KeepFile = None
    force: Force = False
    settings: Settings = None


def command(options: Options) -> None:
    """How dirty an oil or a dry contact becomes over time.

    And where its dirt goes; with --reports, how much enters, from reports of an oil.
    """
    if options.reports is None:
        _tell_history(options)
    else:
        _tell_reports(options, options.reports)


def _tell_history(options: Options) -> None:
    """The history of the oil, or of the dry contact."""
    from ...errors import InvalidValue, Mistake, Problem
    from ...populations.measured.cleanliness import read_iso4406
    from ...quantities.say import join_words
    from ...study.dirty_oil import read_filter
    from ...study.life_dry import AskedDry
    from ...study.run_dry import DryResult
    from ...study.run_life import LifeResult, load_life, run_life
    from ...views import life_dry_words, life_words
    from ...views.life_dents_words import tables_of_dents

    if options.flow_for is not None:
        read_iso4406(options.flow_for)
    fine = None if options.filter_text is None else read_filter(options.filter_text)
    files = TableFiles(options.csv, options.xlsx, options.parquet, options.json)
    question = read_question(
        load_life,
        options.study,
        options.settings,
        files,
        figure=options.figure,
        force=options.force,
    )
    if isinstance(question, AskedDry):
        if options.flow_for is not None:
            raise InvalidValue(
                Problem(
                    "--flow-for",
                    "sizes the filters of an oil; [life.dry] has none",
                    code=Mistake.IDLE,
                )
            )
        if fine is not None:
            raise InvalidValue(
                Problem("--filter", "is of an oil; [life.dry] has none", code=Mistake.IDLE)
            )
    elif fine is not None and (question.rolling is None or not question.circuit.filters):
        lacks = _missing(options) if question.rolling is None else []
        lacks += [] if question.circuit.filters else ["[[life.filters]]"]
        raise InvalidValue(
            Problem(
                "--filter",
                f"asks for dents with another filter; the study lacks {join_words(lacks)}",
                code=Mistake.MISSING,
            )
        )
    bands = bool(question.uncertainty)
    contact = isinstance(question, AskedDry) or question.contact is not None
    if options.keep is not None and not (bands or contact):
        raise InvalidValue(
            Problem(
                "--keep",
                "keeps many histories, or a long one with a contact; the study has neither "
                "[life.uncertainty] nor [life.contact]: its history takes a moment",
                code=Mistake.IDLE,
            )
        )
    of = "histories" if bands else "steps"
    with nullcontext() if bands else heartbeat("life"), resumable("life", options.keep, of=of):
        result = run_life(question, progress=bands, keep=options.keep, filter=fine)
    words: Any = life_dry_words if isinstance(result, DryResult) else life_words
    sized = []
    if options.flow_for is not None and isinstance(result, LifeResult):
        sized = life_words.least_flow_words(result, options.flow_for)
    give_answer(
        result,
        files,
        settings=options.settings,
        answer=[*words.answer(result), *sized],
        table=WordTable(words.HEADS, words.rows(result), words.MEANS),
        last=words.last_words(result),
        times=result.history.times.tolist(),
        more=tables_of_dents(result.dents) if isinstance(result, LifeResult) else (),
        draw=partial(_draw, result.history),
        figure=options.figure,
    )


def _missing(options: Options) -> list[str]:
    """Tables that the study lacks for dents."""
    from ...study.toml import override, read

    data = override(read(options.study), options.settings or [])
    return [f"[{name}]" for name in FILM_TABLES if name not in data]


def _draw(history: Histories) -> Figure:
    from ...views.plot.life import life

    return life(history)


def _tell_reports(options: Options, reports: Path) -> None:
    """What reports of the oil say of what enters it."""
    from ...errors import InvalidValue, Mistake, Problem
    from ...study.run_life import load_circuit, reports_of
    from ...views.life_words import REPORT_HEADS, REPORT_MEANS, report_answer, report_rows

    if options.figure is not None:
        raise InvalidValue(
            Problem("--figure", "draws a history; with --reports there is none", code=Mistake.CLASH)
        )
    files = TableFiles(options.csv, options.xlsx, options.parquet, options.json)
    question = read_question(
        load_circuit, options.study, options.settings, files, force=options.force
    )
    with heartbeat("life"):
        result = reports_of(question, reports)
    give_answer(
        result,
        files,
        settings=options.settings,
        answer=report_answer(result.reports),
        table=WordTable(REPORT_HEADS, report_rows(result.reports), REPORT_MEANS),
        last=[],
    )
