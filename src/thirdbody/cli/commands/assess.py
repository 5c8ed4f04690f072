"""``thirdbody assess``: how sure the answer is, on one page."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..options import AsJson, Force, Settings, argument, option, read_study
from ..show import terminal
from ..streams import print_json, tell_written

__all__ = ["command"]


@dataclass(frozen=True, kw_only=True)
class Options:
    """What the command is told."""

    study: Path = argument(
        "A study file; its table [uncertainty] says what scatters.", "STUDY.toml"
    )
    as_json: AsJson = False
    html: Path | None = option("--html", "Write the page with figures, one file.", "FILE")
    force: Force = False
    settings: Settings = None


def command(options: Options) -> None:
    """One page: the mode at each operating load, how sure it is, and what would change it."""
    from ...quantities.files import write_text
    from ...study.analyses import assess_study
    from ...views.assess_page import page
    from ..own_files import need_places

    asked = read_study(options.study, options.settings, writes=[options.html])
    need_places([(options.html, "page")], force=options.force)
    answer = assess_study(asked, progress=True)
    if options.html is not None:
        write_text(options.html, page(answer))
        tell_written(options.html)
    if options.as_json:
        print_json(answer.to_dict())
    else:
        terminal().print(answer.page("--json or --html FILE has all of it"))
