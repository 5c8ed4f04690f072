"""``thirdbody sweep``: many states, in a folder."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ...errors import InvalidValue, Mistake, NoEquilibrium, Problem
from ...quantities.say import join_words, percent, plural, value_of
from ..interrupt import Interrupted
from ..options import (
    Force,
    ParquetFile,
    Settings,
    XlsxFile,
    argument,
    named_as_options,
    option,
    tell_notes,
)
from ..show import terminal
from ..streams import TableFiles, tell_written, warn_of

if TYPE_CHECKING:
    import xarray

    from ...analysis.sweep.plan import Plan
    from ...analysis.sweep.streaming import Folder
    from ...views.workbook import Sheet

__all__ = ["command"]

MOST_IN_A_TABLE = 100_000
"""Rows of a table beside the folder."""


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of the command."""

    study: Path | None = argument(
        "A study file with a table [sweep].", "STUDY.toml", show_default=False, default=None
    )
    out: Path | None = option(
        "--out", "Write the states into a folder; the same command goes on with it.", "DIR"
    )
    format: str = option(
        "--format",
        "Format of the data in DIR; both need more packages: pip install 'thirdbody[sweep]'.",
        "zarr|netcdf",
        default="zarr",
    )
    workers: int = option(
        "--workers", "Threads that solve blocks of states, e.g. 4.", "N", default=1
    )
    scheduler: str | None = option(
        "--scheduler",
        "A Dask cluster that solves them instead, e.g. tcp://10.0.0.5:8786.",
        "ADDRESS",
    )
    check: Path | None = option(
        "--check", "Say whether a folder of states is as it was written; stands alone.", "DIR"
    )
    csv: Path | None = option(
        "--csv", "Write a table beside DIR, one row per state, e.g. a.csv.", "FILE"
    )
    xlsx: XlsxFile = None
    parquet: ParquetFile = None
    force: Force = False
    settings: Settings = None


def command(options: Options) -> None:
    """Many states, in a folder, on a grid, in pairs or sampled.

    The same command goes on where it was interrupted.
    """
    from ...analysis.sweep.streaming import run

    files = TableFiles(options.csv, options.xlsx, options.parquet)
    if options.check is not None:
        _check(
            options.check, alone=options.study is None and options.out is None and not files.paths
        )
        return
    if options.study is None or options.out is None:
        needed = {
            "STUDY.toml is missing: the study to sweep": options.study,
            "--out DIR is missing: the folder for the states": options.out,
        }
        missing = (rule for rule, value in needed.items() if value is None)
        raise InvalidValue(*missing, code=Mistake.MISSING)
    plan = _read_plan(options.study, options.settings, options.format, options.workers)
    _need_files(files, plan, options.study, options.settings, options.force)
    client = None
    if options.scheduler is not None:
        from ...quantities.sharing import connect_client

        client = connect_client(options.scheduler)
    try:
        with named_as_options("format"):
            folder = run(
                plan,
                options.out,
                format=options.format,
                workers=options.workers,
                client=client,
                progress=True,
            )
    except KeyboardInterrupt:
        done = len(list((options.out / "done").glob("[0-9]*.json")))
        raise Interrupted(
            f"interrupted after {done} of {plan.count} blocks; the same command goes on"
        ) from None
    finally:
        if client is not None:
            client.close()
    if files.paths:
        with folder.open() as data:
            files.write(*_table(data), sheets=partial(_sheets, data, options.study))
        tell_written(*files.paths)
    _tell_warnings(folder)


def _need_files(
    files: TableFiles, plan: Plan, study: Path, settings: Settings, force: bool
) -> None:
    """Refuse tables that cannot be written, or that nobody reads."""
    from ...quantities.files import refuse_clashes
    from ...study.whole import files_of

    rows = math.prod(plan.layout().sizes.values())
    if files.paths and rows > MOST_IN_A_TABLE:
        raise InvalidValue(
            f"{files.paths[0]} would have {rows:,} rows, and {MOST_IN_A_TABLE:,} are the most of a "
            "table; leave it out and read the folder with xarray, or give [sweep.reduce]",
            code=Mistake.TOO_LARGE,
        )
    refuse_clashes(files.paths, files_of(study, settings or ()))
    files.need(force=force)


def _table(data: xarray.Dataset) -> tuple[dict[str, list[object]], dict[str, str]]:
    """Columns of a folder and their units, a row a state."""
    from ...analysis.sweep.plan import CODES
    from ...equilibrium.columns import CODE
    from ...equilibrium.modes import MODES
    from ...quantities.plain_data import plain_data

    frame = data.to_dataframe().reset_index()
    frame.insert(0, "row of the sweep", range(len(frame)))
    columns = {str(name): plain_data(column.to_numpy()) for name, column in frame.items()}
    if "status" in columns:
        columns[CODE] = columns["status"]
    for name, words in {"mode": (None, *MODES), "status": CODES["status"]}.items():
        if name in columns:
            columns[name] = [words[code] for code in columns[name]]
    units = {
        str(name): variable.attrs.get("units", "") for name, variable in data.variables.items()
    }
    return columns, units


def _sheets(data: xarray.Dataset, study: Path) -> list[Sheet]:
    """The answer, the states, what their columns are, and what the sweep warns of."""
    from ...equilibrium.columns import BESIDE
    from ...quantities.say import unit_of
    from ...views.workbook import Grid, Sheet, sheet_of_table

    columns, units = _table(data)
    abouts = {name: data[name].attrs for name in columns if name in data.variables}
    abouts |= {name: BESIDE[name].labels for name in columns if name in BESIDE}
    meanings = [
        (name, unit_of(about.get("units", "")), about.get("long_name", ""))
        for name, about in abouts.items()
    ]
    notes = [(line, "", "") for name in ("warnings", "citations", "version")
             for line in str(data.attrs[name]).splitlines()]  # fmt: skip
    title = f"Sweep of {study.name} (thirdbody {data.attrs['version']})"
    return [
        Sheet("Answer", tuple(_answer(data)), title=title),
        sheet_of_table("States", columns, units),
        Sheet(
            "Notes", (Grid(("column", "unit", "meaning"), meanings), Grid(("note", "", ""), notes))
        ),
    ]


def _check(folder: Path, *, alone: bool) -> None:
    """Say whether a folder is as it was written."""
    from ...analysis.sweep.folder import check_folder

    if not alone:
        raise InvalidValue(
            "--check DIR stands alone, without STUDY.toml and --out", code=Mistake.CLASH
        )
    verdict, *rest = check_folder(folder, progress=True).splitlines()
    warn_of(rest)
    print(verdict)


def _read_plan(study: Path, settings: Settings, format: str, workers: int) -> Plan:
    """The sweep of a study; every slip of the command and of the file is told at once."""
    from ...analysis.sweep.streaming import FORMATS
    from ...study import load_study

    problems = []
    if format not in FORMATS:
        problems.append(
            Problem("--format", f"must be one of {', '.join(FORMATS)}", format, code=Mistake.OPTION)
        )
    if workers < 1:
        problems.append(
            Problem("--workers", "must be at least 1", str(workers), code=Mistake.RANGE)
        )
    try:
        loaded_study = load_study(study, settings or ())
        if loaded_study.sweep is None:
            problems.append(
                Problem(
                    "sweep",
                    "is missing: a table [sweep] says what is varied, e.g. "
                    '[sweep.vary] roughness.sigma = ["50 nm", "100 nm"]',
                    code=Mistake.MISSING,
                )
            )
    except InvalidValue as error:
        problems += error.problems
    if problems:
        raise InvalidValue(*problems)
    tell_notes(loaded_study)
    assert loaded_study.sweep is not None
    return loaded_study.sweep


def _answer(data: xarray.Dataset) -> list[str]:
    """Between what the columns lie over all states, the ones that most ask for."""
    ranges = []
    for name, words, say in (
        ("particle_load_share", "particles carry {} of the load", percent),
        ("A_t", "the real contact area is {} of the nominal one", percent),
        ("h", "separation h is {}", lambda value: value_of(value, "m")),
    ):
        column = data.get(name, data.get(f"{name}_mean"))
        if column is None:
            continue
        ends = [float(end) for end in (column.min(), column.max())]
        if all(map(math.isfinite, ends)):
            ranges.append(words.format(" to ".join(dict.fromkeys(map(say, ends)))))
    over = f"Over {plural(math.prod(data.sizes.values()), 'state')}"
    over = over if "h" in data else "On average over what is drawn"
    return [f"{over}, {join_words(ranges)}."] if ranges else []


def _tell_warnings(folder: Folder) -> None:
    """What a finished sweep warns of, and how many states it has."""
    summary = folder.finished_summary
    assert summary is not None
    unsolved = f", {summary['unsolved']:,} without equilibrium" if summary["unsolved"] else ""
    with folder.open() as data:
        for sentence in _answer(data):
            terminal().print(sentence)
        warn_of(filter(None, data.attrs["warnings"].splitlines()))
    print(f"{summary['states']:,} states in {folder.data}{unsolved}", file=sys.stderr)
    if summary["unsolved"] == summary["states"]:
        raise NoEquilibrium("no state of the sweep has an equilibrium; check the unit of the load")
