"""``thirdbody report``: a study as one page to hand on."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from ..options import Settings, StudyFile, read_study
from ..streams import warn

__all__ = ["command"]


def command(
    study: StudyFile,
    out: Annotated[
        Path, typer.Option("--out", metavar="FILE", help="The page, one HTML file.")
    ] = Path("report.html"),
    settings: Settings = None,
) -> None:
    """A report to hand on: answer, figures, tables, error bars and sources, in one file."""
    from ...quantities.files import need_folders, read_bytes, write_text
    from ...quantities.progress import stages
    from ...views.report import PARTS, report

    asked = read_study(study, settings)
    need_folders(out)
    text = read_bytes(study, "a study file").decode("utf-8-sig")
    given = "".join(f"# --set {setting}\n" for setting in settings or ())
    with stages("report", len(PARTS)) as progress:
        file = f"{text.rstrip()}\n\n{given}".rstrip() + "\n"
        found = report(asked, file=file, progress=progress)
        progress(PARTS[-1])
        page = found.html()
    for sentence in found.result["warnings"][len(asked.notes) :]:
        warn(sentence)
    write_text(out, page)
    print(f"written: {out}", file=sys.stderr)
