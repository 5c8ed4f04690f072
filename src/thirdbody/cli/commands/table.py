"""``thirdbody table``: pressure and area against separation, for other solvers."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from ...errors import InvalidValue
from ...quantities.progress import heartbeat
from ...quantities.say import value_of
from ..options import Force, Settings, StudyFile, metres, read_study

__all__ = ["command"]


def command(
    study: StudyFile,
    out: Annotated[Path, typer.Option("--out", metavar="FILE", help="The file to write.")],
    form: Annotated[
        str | None,
        typer.Option(
            "--format",
            metavar="NAME",
            help="csv, abaqus, comsol, avl, python or c; without it by the suffix of FILE: "
            ".csv, .inp, .txt (COMSOL), .avl, .py, .c.",
        ),
    ] = None,
    tolerance: Annotated[
        float, typer.Option("--tolerance", help="Relative error of pressure and area.")
    ] = 1e-6,
    low: Annotated[
        str | None, typer.Option("--from", metavar="LENGTH", help='Lower end, e.g. "50 nm".')
    ] = None,
    high: Annotated[
        str | None, typer.Option("--to", metavar="LENGTH", help='Upper end, e.g. "0.4 um".')
    ] = None,
    coordinate: Annotated[
        str,
        typer.Option("--coordinate", help="h, from the mean surface plane, or d as in solve."),
    ] = "h",
    units: Annotated[
        str | None,
        typer.Option("--units", help="SI or mm (mm, MPa), for abaqus and avl."),
    ] = None,
    force: Force = False,
    settings: Settings = None,
) -> None:
    """Pressure and real area of a study's contact against separation, for other solvers."""
    from ...equilibrium.table.make import table
    from ...equilibrium.table.writers import FORMATS, rounded_up
    from ..own_files import need_places

    name, problems = _format(form, out, units)
    ends = [
        None if text is None else metres(option, text, problems)
        for option, text in (("--from", low), ("--to", high))
    ]
    if problems:
        raise InvalidValue(*problems)
    contact = read_study(study, settings, writes=[out]).contact
    need_places([(out, "export")], force=force)
    with heartbeat("table"):
        made = table(  # which judges the word as well
            contact, low=ends[0], high=ends[1], tolerance=tolerance,
            coordinate=coordinate,  # type: ignore[arg-type]
        )  # fmt: skip
    write, _ = FORMATS[name]
    write(made, out, **({} if units is None else {"units": units}))
    first, last = (value_of(float(made.p(end)), "Pa") for end in made.h[[0, -1]])
    print(
        f"written: {out} ({name}): {coordinate} from {value_of(made.h[0], 'm')} to "
        f"{value_of(made.h[-1], 'm')}, p from {first} to {last}; relative errors at most "
        f"{rounded_up(made.error.p)} of p, {rounded_up(made.error.A)} of A_t, "
        f"{rounded_up(made.error.dp_dh)} of dp/d{coordinate}",
        file=sys.stderr,
    )


def _format(form: str | None, out: Path, units: str | None) -> tuple[str, list[str]]:
    """The format by its name or the suffix of the file, and what is wrong with it."""
    from ...equilibrium.table.writers import FORMATS

    suffixes = {suffix: name for name, (_, suffix) in FORMATS.items()}
    name = form or suffixes.get(out.suffix.lower(), "")
    if not name:
        return name, [
            f"--out {out}: the suffix does not say which format; add --format "
            f"{', '.join(FORMATS)}, or use one of {', '.join(suffixes)}"
        ]
    if name not in FORMATS:
        return name, [f"--format {name} must be one of {', '.join(FORMATS)}"]
    if units is not None and name not in ("abaqus", "avl"):
        return name, [f"--units {units} has no meaning for {name}, which is in SI units"]
    return name, []
