"""``thirdbody sweep``: many states, in a folder."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ...errors import InvalidValue, NoEquilibrium
from ..interrupt import Interrupted
from ..options import Settings, argument, option, tell_notes
from ..streams import warn_of

if TYPE_CHECKING:
    from ...analysis.sweep.plan import Plan
    from ...analysis.sweep.streaming import Folder

__all__ = ["command"]


@dataclass(frozen=True, kw_only=True)
class Options:
    """What the command is told."""

    study: Path | None = argument(
        "A study file with a table [sweep].", "STUDY.toml", default=None, show_default=False
    )
    out: Path | None = option("--out", "Folder for the states; the same command resumes.", "DIR")
    format: str = option("--format", "Of the data in DIR.", "zarr|netcdf", default="zarr")
    workers: int = option("--workers", "Threads that solve blocks of states.", "N", default=1)
    scheduler: str | None = option(
        "--scheduler", "A Dask cluster that solves them instead.", "ADDRESS"
    )
    check: Path | None = option(
        "--check", "Say instead whether a folder is as it was written.", "DIR"
    )
    settings: Settings = None


def command(options: Options) -> None:
    """Many states, in a folder: on a grid, in pairs or sampled; resumable."""
    from ...analysis.sweep.streaming import run

    if options.check is not None:
        _check(options.check, alone=options.study is None and options.out is None)
        return
    if options.study is None or options.out is None:
        problems = (
            [] if options.study is not None else ["STUDY.toml is missing: the study to sweep"]
        )
        problems += (
            [] if options.out is not None else ["--out DIR is missing: the folder for the states"]
        )
        raise InvalidValue(*problems)
    plan = _read_plan(options.study, options.settings, options.format, options.workers)
    client = None
    if options.scheduler is not None:
        from ...quantities.sharing import connected

        client = connected(options.scheduler)
    try:
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
    _tell(folder)


def _check(folder: Path, *, alone: bool) -> None:
    """Say whether a folder is as it was written."""
    from ...analysis.sweep.folder import check_folder

    if not alone:
        raise InvalidValue("--check DIR stands alone, without STUDY.toml and --out")
    found, *rest = check_folder(folder, progress=True).splitlines()
    warn_of(rest)
    print(found)


def _read_plan(study: Path, settings: Settings, format: str, workers: int) -> Plan:
    """The sweep of a study; every slip of the command and of the file is told at once."""
    from ...analysis.sweep.streaming import FORMATS
    from ...study import load_study

    problems = []
    if format not in FORMATS:
        problems.append(f"--format {format} must be one of {', '.join(FORMATS)}")
    if workers < 1:
        problems.append(f"--workers {workers} must be at least 1")
    try:
        asked = load_study(study, settings or ())
        if asked.sweep is None:
            problems.append(
                f"{study} has no table [sweep]: it says what is varied, e.g. "
                '[sweep.vary] roughness.sigma = ["50 nm", "100 nm"]'
            )
    except InvalidValue as error:
        problems += error.problems
    if problems:
        raise InvalidValue(*problems)
    tell_notes(asked)
    assert asked.sweep is not None
    return asked.sweep


def _tell(folder: Folder) -> None:
    """What a finished sweep warns of, and how many states it has."""
    summary = folder.finished
    assert summary is not None
    with folder.open() as data:
        warn_of(filter(None, data.attrs["warnings"].splitlines()))
    unsolved = f", {summary['unsolved']:,} without equilibrium" if summary["unsolved"] else ""
    print(f"{summary['states']:,} states in {folder.data}{unsolved}", file=sys.stderr)
    if summary["unsolved"] == summary["states"]:
        raise NoEquilibrium("no state of the sweep has an equilibrium; check the unit of the load")
