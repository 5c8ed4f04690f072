"""``thirdbody table``: pressure and area against separation, for other solvers."""

from __future__ import annotations

from dataclasses import MISSING, dataclass
from pathlib import Path

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.progress import heartbeat
from ...quantities.say import value_of
from ..options import Force, Settings, StudyFile, metres, option, read_study
from ..show import terminal
from ..streams import tell_written

__all__ = ["command"]


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of the command."""

    study: StudyFile
    out: Path = option("--out", "Write the table here, e.g. a.inp.", "FILE", default=MISSING)
    form: str | None = option(
        "--format",
        "csv, abaqus, comsol, avl, python or c; without it by the suffix of FILE: "
        ".csv, .inp, .txt (COMSOL), .avl, .py, .c.",
        "NAME",
    )
    tolerance: float = option(
        "--tolerance",
        "Relative error of pressure and area between the rows.",
        "NUMBER",
        default=1e-06,
    )
    low: str | None = option("--from", 'Least separation, e.g. "50 nm".', "LENGTH")
    high: str | None = option("--to", 'Largest separation, e.g. "0.4 um".', "LENGTH")
    coordinate: str = option(
        "--coordinate",
        "Separation from the mean surface plane, h, or from the mean asperity height, d.",
        "h|d",
        default="h",
    )
    units: str | None = option("--units", "Units of abaqus and avl: SI, or mm with MPa.", "SI|mm")
    force: Force = False
    settings: Settings = None


def command(options: Options) -> None:
    """Pressure and real area over the gap, for other solvers."""
    from ...equilibrium.table.make import table
    from ...equilibrium.table.writers import FORMATS, rounded_up
    from ..own_files import need_places

    name, problems = _format(options.form, options.out, options.units)
    ends = [
        None if text is None else metres(option, text, problems)
        for option, text in (("--from", options.low), ("--to", options.high))
    ]
    if problems:
        raise InvalidValue(*problems)
    contact = read_study(options.study, options.settings, writes=[options.out]).contact
    need_places([(options.out, "export")], force=options.force)
    with heartbeat("table"):
        made = table(  # which judges the word as well
            contact, low=ends[0], high=ends[1], tolerance=options.tolerance,
            coordinate=options.coordinate,  # type: ignore[arg-type]
        )  # fmt: skip
    write, _ = FORMATS[name]
    write(made, options.out, **({} if options.units is None else {"units": options.units}))
    first, last = (value_of(float(made.p(end)), "Pa") for end in made.h[[0, -1]])
    terminal().print(
        f"From {options.coordinate} = {value_of(made.h[0], 'm')} to {value_of(made.h[-1], 'm')} "
        f"the pressure goes from {first} to {last}, with relative errors of at most "
        f"{rounded_up(made.error.p)} of p, {rounded_up(made.error.A)} of A_t and "
        f"{rounded_up(made.error.dp_dh)} of dp/d{options.coordinate}: a table for {name}."
    )
    tell_written(options.out)


def _format(form: str | None, out: Path, units: str | None) -> tuple[str, list[str]]:
    """Format by its name or the suffix of the file, and its problems."""
    from ...equilibrium.table.writers import FORMATS

    suffixes = {suffix: name for name, (_, suffix) in FORMATS.items()}
    name = form or suffixes.get(out.suffix.lower(), "")
    if not name:
        rule = (
            ": the suffix does not say which format; add --format "
            f"{', '.join(FORMATS)}, or use one of {', '.join(suffixes)}"
        )
        return name, [Problem("--out", rule, str(out), code=Mistake.MISSING)]
    if name not in FORMATS:
        rule = f"must be one of {', '.join(FORMATS)}"
        return name, [Problem("--format", rule, name, code=Mistake.OPTION)]
    if units is not None and name not in ("abaqus", "avl"):
        rule = f"has no meaning for {name}, which is in SI units"
        return name, [Problem("--units", rule, units, code=Mistake.IDLE)]
    return name, []
