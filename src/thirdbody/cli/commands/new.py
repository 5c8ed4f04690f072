"""``thirdbody new``: a study file to begin with."""

from __future__ import annotations

import json
import re
import sys
from importlib import resources
from pathlib import Path
from typing import Annotated

import typer

from ...errors import InvalidValue, Mistake, Problem
from .schema import schema_text

__all__ = ["KINDS", "command"]

KINDS = (
    "ball-bearing",
    "ball-screw",
    "roller-bearing",
    "gear",
    "linear-guide",
    "rolling-bearing",
    "additive",
    "electrical",
    "connector",
    "wafer-chuck",
    "oil-circuit",
    "dry-contact",
    "two-body",
    "measured-surface",
)


SIZED = ("ball-bearing",)
"""Kinds that have sizes of their own."""
FIRST = re.compile(r"^#   thirdbody (solve|film|probability|plate|life)\b", re.MULTILINE)
"""What the head of a file says to type first."""
MEANT = {
    "unit": "of heights: a guess by their size, as the file does not tell; put yours",
    "spacing": "of neighbouring points: a place to put yours, as the file does not tell",
}
"""Options of a measured surface, as its study file says them."""
SCHEMA = "study.schema.json"


def command(
    kind: Annotated[str, typer.Argument(metavar="KIND", help=f"One of {', '.join(KINDS)}.")],
    which: Annotated[
        str | None,
        typer.Argument(
            metavar="[WHICH]",
            help="Of a ball-bearing its designation, 6205, or dimensions in mm, 25x52x15; of a "
            "measured-surface its file.",
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="STUDY.toml", help="Write the file here; KIND.toml without it."
        ),
    ] = None,
    schema: Annotated[
        bool,
        typer.Option(
            "--schema",
            help=f"Name {SCHEMA} in the file, and write it beside where there is none: "
            "editors complete keys and words by it.",
        ),
    ] = False,
) -> None:
    """A study file that runs at once: start with this one."""
    from ...quantities.files import need_folders, write_text
    from ...quantities.nearest import guess
    from ...study.bearing_file import bearing_file

    problems: list[str] = []
    measured = Path(which) if which is not None and kind not in SIZED else None
    if kind not in KINDS:
        hint = guess(kind, KINDS, otherwise=None)
        problems.append(
            Problem(
                "KIND", f"{kind} must be one of {', '.join(KINDS)}", hint=hint, code=Mistake.OPTION
            )
        )
    elif measured is not None and kind != "measured-surface":
        problems.append(
            Problem(
                "",
                f"FILE {measured} goes with measured-surface; {kind} needs none",
                code=Mistake.IDLE,
            )
        )
    elif measured is not None and not measured.is_file():
        problems.append(
            Problem("", f"FILE {measured}: there is no such file", code=Mistake.UNREADABLE)
        )
    target = out or Path(f"{kind}.toml")
    if not problems and target.exists():
        problems.append(
            Problem(
                "",
                f"{target} exists and is not overwritten; remove it, or choose another: --out "
                "NAME.toml",
                code=Mistake.UNWRITABLE,
            )
        )
    if schema and target.name == SCHEMA:
        problems.append(
            Problem(
                "--out",
                "is the name of the schema; choose another",
                str(target),
                code=Mistake.CLASH,
            )
        )
    text = ""
    if kind in KINDS:
        text = resources.files("thirdbody").joinpath(f"data/studies/{kind}.toml").read_text("utf-8")
    if which is not None and kind in SIZED:
        try:
            text = bearing_file(text, which)
        except InvalidValue as error:
            problems[:0] = error.problems
    if problems:
        raise InvalidValue(*problems)
    first = FIRST.search(text)
    assert first is not None
    if out is not None:
        text = text.replace(f"{kind}.toml", str(out))
    if measured is not None:
        text = _of_measured(text, measured, relative=out is None)
    need_folders(target)
    written = {target: text}
    if schema:
        written[target] = f"#:schema ./{SCHEMA}\n{text}"
        if not (beside := target.with_name(SCHEMA)).exists():
            written[beside] = schema_text()
    for file, content in written.items():
        write_text(file, content)
        print(f"written: {file}", file=sys.stderr)
    print(f"thirdbody {first[1]} {target}")


def _of_measured(text: str, measured: Path, *, relative: bool) -> str:
    """The study file of this surface, with what its file leaves open; it runs at once."""
    from ...populations.measured.instruments import options_unsaid
    from ...quantities.units import say

    where = measured if measured.is_absolute() or relative else measured.resolve()
    lines = [f"topography = {json.dumps(str(where))}"]
    for key, likely in options_unsaid(measured).items():
        lines.append(f'{key} = "{likely}"  # {MEANT[key]}')
        print(f"warning: roughness.{key} = {likely!r}: {MEANT[key]}", file=sys.stderr)
    text = re.sub(r'topography = "example".*', lambda _: "\n".join(lines), text)
    text = text.replace('cutoff = "1 um"  ', '# cutoff = "1 um"')
    # a map of one's own may be one that the law refuses: a profile, or a broad spectrum
    for line in ("[asperity_law]", 'name = "field"', 'spectrum = "measured"'):
        text = text.replace(line, f"# {line}")
    return text.replace("thirdbody surface FILE", f"thirdbody surface {say(str(measured))}")
