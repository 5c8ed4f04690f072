"""``thirdbody new``: a study file to begin with."""

from __future__ import annotations

import json
from importlib import resources
from pathlib import Path
from typing import Annotated

import typer

from ...errors import InvalidValue, Problem
from ..streams import tell_written
from .schema import schema_text

__all__ = ["KINDS", "command"]

KINDS = (
    "ball-screw",
    "rolling-bearing",
    "additive",
    "electrical",
    "two-body",
    "measured-surface",
)


SCHEMA = "study.schema.json"


def command(
    kind: Annotated[str, typer.Argument(metavar="KIND", help=f"One of {', '.join(KINDS)}.")],
    measured: Annotated[
        Path | None,
        typer.Argument(
            metavar="[FILE]", help="The file of a measured-surface.", show_default=False
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="STUDY.toml", help="The file to write, KIND.toml else."),
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
    """A commented study file that runs at once, to be changed into your own."""
    from ...quantities.files import need_folders, write_text
    from ...quantities.nearest import guess
    from ...quantities.units import say

    problems: list[str] = []
    if kind not in KINDS:
        hint = guess(kind, KINDS, otherwise=None)
        problems.append(Problem("KIND", f"{kind} must be one of {', '.join(KINDS)}", hint=hint))
    elif measured is not None and kind != "measured-surface":
        problems.append(f"FILE {measured} goes with measured-surface; {kind} needs none")
    if measured is not None and not measured.is_file():
        problems.append(f"FILE {measured}: there is no such file")
    target = out or Path(f"{kind}.toml")
    if not problems and target.exists():
        problems.append(
            f"{target} exists and is not overwritten; remove it, or choose another: --out NAME.toml"
        )
    if schema and target.name == SCHEMA:
        problems.append(f"--out {target} is the name of the schema; choose another")
    if problems:
        raise InvalidValue(*problems)
    need_folders(target)
    text = resources.files("thirdbody").joinpath(f"data/studies/{kind}.toml").read_text("utf-8")
    if out is not None:
        text = text.replace(f"{kind}.toml", str(out))
    if measured is not None:
        where = measured if measured.is_absolute() or out is None else measured.resolve()
        text = text.replace('topography = "example"', f"topography = {json.dumps(str(where))}")
        text = text.replace('cutoff = "1 um"  ', '# cutoff = "1 um"')
        # a map of one's own may be one that the law refuses: a profile, or a broad spectrum
        for line in ("[asperity_law]", 'name = "field"', 'spectrum = "measured"'):
            text = text.replace(line, f"# {line}")
        text = text.replace("thirdbody surface FILE", f"thirdbody surface {say(str(measured))}")
    written = {target: text}
    if schema:
        written[target] = f"#:schema ./{SCHEMA}\n{text}"
        if not (beside := target.with_name(SCHEMA)).exists():
            written[beside] = schema_text()
    for file, content in written.items():
        write_text(file, content)
        tell_written(file)
    print(f"thirdbody solve {target}")
