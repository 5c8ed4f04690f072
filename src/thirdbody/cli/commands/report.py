"""``thirdbody report``: a study as one page to hand on."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..options import Force, Settings, StudyFile, read_study
from ..streams import tell_written, warn_of

__all__ = ["command"]

USUAL = Path("report.html")
"""Where the page goes when nobody says so."""


def command(
    study: StudyFile,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="FILE", help="The page, one HTML file; report.html else."),
    ] = None,
    force: Force = False,
    settings: Settings = None,
) -> None:
    """A report to hand on: answer, figures, tables, error bars and sources, in one file."""
    from ...quantities.files import read_bytes, write_text
    from ...quantities.progress import stages
    from ...views.report import PARTS, report
    from ..own_files import need_places

    target = out or USUAL
    asked = read_study(study, settings, writes=[target])
    need_places([(target, "page")], force=force)
    text = read_bytes(study, "a study file").decode("utf-8-sig")
    given = "".join(f"# --set {setting}\n" for setting in settings or ())
    with stages("report", len(PARTS)) as progress:
        file = f"{text.rstrip()}\n\n{given}".rstrip() + "\n"
        found = report(asked, file=file, progress=progress)
        progress(PARTS[-1])
        page = found.html()
    warn_of(found.result.run_warnings)
    write_text(target, page)
    tell_written(target)
