"""``thirdbody report``: a study as one page to hand on."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from ..options import FilterText, Force, Settings, StudyFile, read_study
from ..show import terminal
from ..streams import tell_written, warn_of, write_together

__all__ = ["command"]

USUAL = Path("report.html")
"""Where the page goes when nobody says so."""


def command(
    study: StudyFile,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="FILE",
            help="Write the page here, one HTML file; report.html without it.",
        ),
    ] = None,
    pdf_file: Annotated[
        Path | None,
        typer.Option(
            "--pdf",
            metavar="FILE",
            help="Write it as PDF, e.g. a.pdf (needs Chromium, Chrome or Edge).",
        ),
    ] = None,
    force: Force = False,
    filter_text: FilterText = None,
    settings: Settings = None,
) -> None:
    """A report to hand on, as one HTML file or PDF.

    With the answer, figures, tables, error bars and sources.
    """
    from ...quantities.files import read_bytes
    from ...quantities.progress import stages
    from ...study.dirty_oil import need_particles, read_filter
    from ...study.toml import heading_of
    from ...study.toml_text import text_with
    from ...study.toml_text import toml_value as in_toml
    from ...views.pdf import need_browser, pdf_of
    from ...views.report import PARTS, report
    from ...views.report.page import UNTITLED
    from ..own_files import need_places

    fine = None if filter_text is None else read_filter(filter_text)
    target = out if pdf_file is not None else out or USUAL
    loaded_study = read_study(study, settings, writes=[target, pdf_file])
    if fine is not None:
        need_particles(loaded_study)
    fine = fine or loaded_study.filter
    need_places([(target, "page"), (pdf_file, "PDF")], force=force)
    if pdf_file is not None:
        need_browser()  # refused before long work
    text = read_bytes(study, "a study file").decode("utf-8-sig")
    over = [*(settings or ())]
    if over:  # the head tells what was set
        over.append(
            f"title={in_toml(heading_of(loaded_study.title or UNTITLED, loaded_study.settings))}"
        )
    if filter_text is not None:
        over.append(f"film.filter={in_toml(filter_text)}")
    with stages("report", len(PARTS)) as progress:
        file = text_with(text, over).rstrip() + "\n"
        document = report(loaded_study, file=file, progress=progress, filter=fine)
        progress(PARTS[-1])
        page = document.html()
    written = {} if target is None else {target: page.encode()}
    if pdf_file is not None:
        written[pdf_file] = pdf_of(page)
    warn_of(document.result.run_warnings)
    write_together({path: partial(Path.write_bytes, data=held) for path, held in written.items()})
    console = terminal()
    for sentence in document.lead:
        console.print(sentence)
    tell_written(*written)
