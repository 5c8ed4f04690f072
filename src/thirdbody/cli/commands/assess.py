"""``thirdbody assess``: how sure the answer is, on one page."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated

import typer

from ..options import AsJson, Force, Settings, read_study
from ..show import terminal

__all__ = ["command"]


def command(
    study: Annotated[
        Path,
        typer.Argument(
            metavar="STUDY.toml", help="A study file; its table [uncertainty] says what scatters."
        ),
    ],
    as_json: AsJson = False,
    html_file: Annotated[
        Path | None,
        typer.Option("--html", metavar="FILE", help="Write the page with figures, one file."),
    ] = None,
    force: Force = False,
    settings: Settings = None,
) -> None:
    """One page: the mode at each operating load, how sure it is, and what would change it."""
    from ...quantities.files import write_text
    from ...study.analyses import assess_study
    from ...views.assess_page import page
    from ..own_files import need_places

    asked = read_study(study, settings, writes=[html_file])
    need_places([(html_file, "page")], force=force)
    answer = assess_study(asked, progress=True)
    if html_file is not None:
        write_text(html_file, page(answer))
        print(f"written: {html_file}", file=sys.stderr)
    if as_json:
        print(json.dumps(answer.to_dict(), indent=1, allow_nan=False))
    else:
        terminal().print(answer.page("--json or --html FILE tells all"))
