"""``thirdbody report``: a study as one page to hand on."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from ...errors import InvalidValue
from ..options import Settings, StudyFile, read_study
from ..streams import warn

__all__ = ["command"]

USUAL = Path("report.html")
"""Where the page goes when nobody says so."""


def command(
    study: StudyFile,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="FILE", help="The page, one HTML file; report.html else."),
    ] = None,
    settings: Settings = None,
) -> None:
    """A report to hand on: answer, figures, tables, error bars and sources, in one file."""
    from ...quantities.files import need_folders, read_bytes, write_text
    from ...quantities.progress import stages
    from ...views.html import is_page
    from ...views.report import PARTS, report

    target = out or USUAL
    asked = read_study(study, settings, writes=[target])
    need_folders(target)
    if out is None and target.exists() and not is_page(target):
        raise InvalidValue(
            f"{target} exists and is no report of thirdbody; choose another name: --out NAME.html"
        )
    text = read_bytes(study, "a study file").decode("utf-8-sig")
    given = "".join(f"# --set {setting}\n" for setting in settings or ())
    with stages("report", len(PARTS)) as progress:
        file = f"{text.rstrip()}\n\n{given}".rstrip() + "\n"
        found = report(asked, file=file, progress=progress)
        progress(PARTS[-1])
        page = found.html()
    for sentence in found.result["warnings"][len(asked.notes) :]:
        warn(sentence)
    write_text(target, page)
    print(f"written: {target}", file=sys.stderr)
