"""The command line: ``thirdbody solve STUDY.toml`` and its neighbours.

Standard output holds the answer and nothing else; progress, warnings and errors go to standard
error. Exit status: 0 done, 2 bad input, 3 no equilibrium or no transition in the range searched.
"""

from __future__ import annotations

import csv
import dataclasses
import io
import json
import math
import os
import sys
import warnings
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from .errors import InvalidValue, NoEquilibrium, NoTransition

if TYPE_CHECKING:
    from rich.console import Console

__all__ = ["app", "main"]

BAD_INPUT, NO_ANSWER, INTERRUPTED, BROKEN_PIPE = 2, 3, 130, 141
MOST_ROWS = 20
PAPERS = ("horng2022", "ghaednia2013", "ghaednia2014")
PLACES = ("start", "middle", "end")


class Commands(TyperGroup):
    """Turns errors and warnings of every command into lines on standard error."""

    def invoke(self, ctx: Any) -> Any:
        with warnings.catch_warnings():
            warnings.showwarning = _one_line
            try:
                answer = super().invoke(ctx)
                sys.stdout.flush()
                return answer
            except InvalidValue as error:
                _complain(error.problems)
                raise typer.Exit(BAD_INPUT) from None
            except (NoEquilibrium, NoTransition) as error:
                _complain([str(error)])
                raise typer.Exit(NO_ANSWER) from None
            except KeyboardInterrupt:
                _complain(["interrupted"])
                raise typer.Exit(INTERRUPTED) from None
            except BrokenPipeError:
                # whoever read the output has gone: leave quietly, also at the last flush
                os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
                raise typer.Exit(BROKEN_PIPE) from None
            except OSError as error:
                where = f" {error.filename}" if error.filename else " the output"
                _complain([f"cannot read or write{where}: {error.strerror or error}"])
                raise typer.Exit(BAD_INPUT) from None


def _complain(sentences: Iterable[str]) -> None:
    for sentence in sentences:
        for line in sentence.splitlines():
            print(f"error: {line}", file=sys.stderr)


def _one_line(message: Warning | str, *_: Any, **__: Any) -> None:
    print(f"warning: {' '.join(str(message).split())}", file=sys.stderr)


app = typer.Typer(
    cls=Commands,
    name="thirdbody",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    help="Contact of rough surfaces with particles between them.",
)


def main() -> None:
    """Entry point of the command ``thirdbody``."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    app()


def _version(wanted: bool) -> None:
    if wanted:
        from . import __version__

        print(f"thirdbody {__version__}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    """Contact of rough surfaces with particles between them."""


# -------------------------------------------------------------------------- solve
@app.command()
def solve(
    study: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="The study file.")],
    as_json: Annotated[
        bool, typer.Option("--json", help="Print one JSON object and nothing else.")
    ] = False,
    csv_file: Annotated[
        Path | None, typer.Option("--csv", metavar="FILE", help="Write one row per state.")
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE",
            help='Change a key of the file, e.g. particles.mean="500 nm"; may be repeated.',
        ),
    ] = None,
) -> None:
    """Separation, real contact area, load shares and contact mode under the loads of a study."""
    from .study import load_study, run_study

    if as_json and csv_file is not None:
        raise typer.BadParameter("--json and --csv exclude each other; run the command twice")
    asked = load_study(study, settings or ())
    for sentence in asked.notes:
        _one_line(sentence)
    result = run_study(asked)
    for sentence in result["warnings"][len(asked.notes) :]:
        _one_line(sentence)
    statuses = result["states"]["status"]
    solved = statuses.count("ok")
    if as_json:
        print(json.dumps(result, indent=1, allow_nan=False))
    elif solved and csv_file is not None:
        _write_csv(csv_file, result["states"])
        print(f"{len(statuses)} states written to {csv_file}", file=sys.stderr)
    elif solved:
        _show(result)
    if not solved:
        more = f" (and so for all {len(statuses)} states)" if len(statuses) > 1 else ""
        raise NoEquilibrium(statuses[0] + more)


def _write_csv(path: Path, states: dict[str, list[Any]]) -> None:
    from .equilibrium import COLUMNS
    from .files import write_text

    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    units = {name: COLUMNS[name]["unit"] for name in states}
    writer.writerow(f"{name} [{unit}]" if unit else name for name, unit in units.items())
    writer.writerows(zip(*states.values(), strict=True))
    write_text(path, text.getvalue())


def _console() -> Console:
    from rich.console import Console

    # a pipe has no width of its own
    width = None if sys.stdout.isatty() else 120
    return Console(file=sys.stdout, width=width, highlight=False, markup=False, emoji=False)


def _table(headers: Iterable[str], *, right: bool = False) -> Any:
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for header in headers:
        table.add_column(header, justify="right" if right else "left", overflow="fold")
    return table


def _show(result: dict[str, Any]) -> None:
    """The result for a reader: states, transitions, one sentence."""
    console = _console()
    states, scales = result["states"], result["scales"]
    three_body = result["inputs"]["particles"] is not None
    console.print(f"{result['title'] or 'Study'} (thirdbody {result['version']})")
    console.print(f"E_ss = {scales['E_ss'] / 1e9:.4g} GPa, sigma = {_length(scales['sigma'])}")

    columns: dict[str, Callable[[int], str]] = {
        "F*": lambda i: _number(states["F_star"][i]),
        "pressure": lambda i: _pressure(states["pressure"][i]),
        "d": lambda i: _length(states["d"][i]),
        "d/sigma": lambda i: _number(states["d_star"][i]),
        "A_t": lambda i: _number(states["A_t"][i]),
        "A_ss": lambda i: _number(states["A_ss"][i]),
    }
    if three_body:
        columns |= {
            "A_sa": lambda i: _number(states["A_sa"][i]),
            "particles' load": lambda i: _percent(states["particle_load_share"][i]),
            "particles' area": lambda i: _percent(states["particle_area_share"][i]),
            "mode": lambda i: states["mode"][i] or "-",
        }
    table = _table(columns, right=True)
    total = len(states["status"])
    rows = min(total, MOST_ROWS)
    for row in range(rows):
        i = round(row * (total - 1) / max(rows - 1, 1))
        table.add_row(*(cell(i) for cell in columns.values()))
    console.print(table)
    if rows < total:
        console.print(f"{rows} of {total} states shown; --csv FILE writes all\n")
    for status in dict.fromkeys(states["status"]):
        if status != "ok":
            console.print(f"{states['status'].count(status)} state(s) unsolved: {status}")
    if three_body:
        console.print(_transition_table(result["transitions"], scales["E_ss"]))
    console.print(summary(result))


def _transition_table(critical: dict[str, Any], E_ss: float) -> Any:
    turning = critical["F_tpca"]
    rows = {
        "F_cr1: asperities come into contact (p-s to hybrid)": critical["F_cr1"],
        "F_cr2: particles have little of the contact left (hybrid to s-s)": critical["F_cr2"],
        "F_tpca A: largest particle share": turning["A"],
        "F_tpca B: equal loads": turning["B"],
        "F_tpca C: strongest bend of the area": turning["C"],
    }
    table = _table(("critical load", "F*", "pressure", "status"))
    for name, entry in rows.items():
        value = entry["value"]
        pressure = None if value is None else value * E_ss
        table.add_row(name, _number(value), _pressure(pressure), entry["status"])
    return table


def summary(result: dict[str, Any]) -> str:
    """The result in plain words."""
    states = result["states"]
    known = [i for i, status in enumerate(states["status"]) if status == "ok"]
    three_body = result["inputs"]["particles"] is not None
    words = {
        "p-s": "nearly all real contact is on particles (p-s)",
        "hybrid": "real contact is on particles and on asperities (hybrid)",
        "s-s": "nearly all real contact is on asperities (s-s)",
    }

    def state(i: int) -> str:
        gap = f"separation {_length(states['d'][i])} ({states['d_star'][i]:.3g} sigma)"
        area = f"real contact area {_percent(states['A_t'][i])} of the nominal area"
        if not three_body:
            return f"{gap}, {area}"
        share = f"particles carry {_percent(states['particle_load_share'][i])} of the load"
        if states["mode"][i] is None:
            return f"no contact, {gap}"
        return f"{words[states['mode'][i]]}; {share}, {gap}, {area}"

    def load(i: int) -> str:
        return f"{_pressure(states['pressure'][i])} (F* = {_number(states['F_star'][i])})"

    known.sort(key=lambda i: states["pressure"][i])
    first, last = known[0], known[-1]
    if first == last:
        return f"At {load(first)}: {state(first)}."
    modes = [states["mode"][i] or "no contact" for i in known]
    path = [mode for i, mode in enumerate(modes) if i == 0 or mode != modes[i - 1]]
    passes = f" In between the mode goes {' -> '.join(path)}." if len(path) > 1 else ""
    return f"At {load(first)}: {state(first)}. At {load(last)}: {state(last)}.{passes}"


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def _percent(value: float | None) -> str:
    if value is None:
        return "-"
    return f"{100 * value:.3g} %" if value < 0.9995 or value == 1 else f"{100 * value:.5g} %"


def _pressure(value: float | None) -> str:
    return _prefixed(value, "Pa", {"G": 1e9, "M": 1e6, "k": 1e3})


def _length(value: float | None) -> str:
    return _prefixed(value, "m", {"": 1.0, "m": 1e-3, "u": 1e-6, "n": 0.0})


def _prefixed(value: float | None, unit: str, thresholds: dict[str, float]) -> str:
    if value is None:
        return "-"
    sizes = {"G": 1e9, "M": 1e6, "k": 1e3, "": 1.0, "m": 1e-3, "u": 1e-6, "n": 1e-9}
    prefix = next((name for name, least in thresholds.items() if abs(value) >= least), "")
    return f"{value / sizes[prefix]:.4g} {prefix}{unit}"


# -------------------------------------------------------------------------- sweep
@app.command()
def sweep(
    study: Annotated[
        Path, typer.Argument(metavar="STUDY.toml", help="A study file with a table [sweep].")
    ],
    out: Annotated[
        Path,
        typer.Option(
            "--out", metavar="DIR", help="Folder for the states; the same command resumes."
        ),
    ],
    format: Annotated[
        str, typer.Option("--format", metavar="zarr|netcdf", help="Of the data in DIR.")
    ] = "zarr",
    workers: Annotated[
        int, typer.Option("--workers", metavar="N", help="Threads that solve blocks of states.")
    ] = 1,
    scheduler: Annotated[
        str | None,
        typer.Option(
            "--scheduler", metavar="ADDRESS", help="A Dask cluster that solves them instead."
        ),
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="As in solve; may be repeated."),
    ] = None,
) -> None:
    """Many states, in a folder: on a grid, in pairs or sampled; resumable."""
    from .streaming import FORMATS, run
    from .study import load_study

    problems = []
    if format not in FORMATS:
        problems.append(f"--format {format} must be one of {', '.join(FORMATS)}")
    if workers < 1:
        problems.append(f"--workers {workers} must be at least 1")
    try:
        asked = load_study(study, settings or ())
        if asked.sweep is None:
            problems.append(
                f"{study} has no table [sweep]: it says what is varied, e.g. "
                '[sweep.vary] roughness.sigma = ["50 nm", "100 nm"]'
            )
    except InvalidValue as error:
        problems += error.problems
    if problems:
        raise InvalidValue(*problems)
    for sentence in asked.notes:
        _one_line(sentence)
    plan = asked.sweep
    assert plan is not None
    client = None
    if scheduler is not None:
        from .cluster import connected

        client = connected(scheduler)
    try:
        folder = run(plan, out, format=format, workers=workers, client=client, progress=True)
    except KeyboardInterrupt:
        done = len(list((out / "done").glob("*.json")))
        _complain([f"interrupted after {done} of {plan.count} blocks; the same command goes on"])
        raise typer.Exit(INTERRUPTED) from None
    finally:
        if client is not None:
            client.close()
    summary = folder.finished
    assert summary is not None
    with folder.open() as data:
        for sentence in filter(None, data.attrs["warnings"].splitlines()):
            _one_line(sentence)
    unsolved = f", {summary['unsolved']:,} without equilibrium" if summary["unsolved"] else ""
    print(f"{summary['states']:,} states in {folder.data}{unsolved}", file=sys.stderr)
    if summary["unsolved"] == summary["states"]:
        raise NoEquilibrium("no state of the sweep has an equilibrium; check the unit of the load")


# -------------------------------------------------------------------------- assess
@app.command()
def assess(
    study: Annotated[
        Path,
        typer.Argument(metavar="STUDY.toml", help="A study file with a table [uncertainty]."),
    ],
    as_json: Annotated[
        bool, typer.Option("--json", help="Print one JSON object and nothing else.")
    ] = False,
    html_file: Annotated[
        Path | None,
        typer.Option("--html", metavar="FILE", help="Write the page with figures, one file."),
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="As in solve; may be repeated."),
    ] = None,
) -> None:
    """One page: the mode at the operating load, how sure it is, and what would change it."""
    from .assess import assess_study
    from .files import write_text
    from .study import load_study

    asked = load_study(study, settings or ())
    for sentence in asked.notes:
        _one_line(sentence)
    answer = assess_study(asked)
    if html_file is not None:
        write_text(html_file, answer.html())
        print(f"written: {html_file}", file=sys.stderr)
    if as_json:
        print(json.dumps(answer.to_dict(), indent=1, allow_nan=False))
    else:
        _console().print(answer.page())


# -------------------------------------------------------------------------- compare
@app.command()
def compare(
    study: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="The study file.")],
    names: Annotated[
        str | None,
        typer.Option(
            "--laws",
            metavar="NAMES",
            help='Asperity laws, e.g. ke,jg, or "all"; without it all but adhesive and elliptic.',
        ),
    ] = None,
    at: Annotated[
        str, typer.Option("--at", help=f"Which load the table shows: {', '.join(PLACES)}.")
    ] = "middle",
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Folder for compare.csv, .png and .svg."),
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="As in solve; may be repeated."),
    ] = None,
) -> None:
    """The interface of a study under every asperity law, against the law the study names."""
    from . import asperity
    from .compare import compare as compare_laws
    from .compare import save
    from .study import load_study

    problems = []
    if at not in PLACES:
        problems.append(f"--at {at} must be one of {', '.join(PLACES)}")
    if out is not None and out.exists() and not out.is_dir():
        problems.append(f"--out {out} must be a folder, and a file of that name exists")
    if problems:
        raise InvalidValue(*problems)
    asked = load_study(study, settings or ())
    for sentence in asked.notes:
        _one_line(sentence)
    words: list[str] | None = None
    if names is not None:
        words = [word.strip() for word in names.split(",") if word.strip()]
        words = list(asperity.REGISTRY) if words == ["all"] else words
    load: dict[str, Any] = {asked.load: asked.values}
    if asked.load == "separation":
        load = {"F_star": _loads_at(asked)}
        _one_line(
            f"laws are compared at equal loads: those of {asked.contact.asperity_law.name} at the "
            "separations of the study"
        )
    table = compare_laws(asked.contact, **load, laws=words)
    for sentence in filter(None, table.attrs["warnings"].splitlines()):
        _one_line(sentence)
    reasons = table.status.values
    if not (reasons == "ok").any():
        raise NoEquilibrium(f"{reasons[0, 0]} (and so under every law)")
    order = table.F_star.values.argsort()
    index = int(order[{"start": 0, "middle": len(order) // 2, "end": -1}[at]])
    # the files first: a table on the screen says that all is done
    written = save(table, out, at=index) if out is not None else []
    _show_comparison(asked.title, table, index)
    for path in written:
        print(f"written: {path}", file=sys.stderr)


def _loads_at(asked: Any) -> Any:
    """The loads F* of a study that gives separations."""
    import numpy as np

    loads = np.asarray(asked.solve().F_star)
    loads = loads[np.isfinite(loads) & (loads > 0)]
    if not len(loads):
        raise NoEquilibrium("no load at the separations of the study, so there is none to compare")
    return loads


def _show_comparison(title: str, table: Any, index: int) -> None:
    """One row a law, at one load; what is to be said of a law stands below, numbered."""
    console = _console()
    one = table.isel({table.A_t.dims[1]: index})
    particles = "particle_load_share" in one
    own = table.attrs["own_law"]
    load = f"{_pressure(float(one.pressure))} (F* = {_number(float(one.F_star))})"
    console.print(f"{title or 'Study'}: every law at {load}, differences against {own}")

    def cells(row: Any, number: str) -> list[str]:
        if row.status.item() != "ok":
            return [row.law.item(), *["-"] * (9 if particles else 8), number]
        value = {str(name): row[name].values.item() for name in row.data_vars}
        first = row.law.item() == own
        out = [
            row.law.item(),
            _number(value["A_t"]),
            "" if first else f"{value['A_t_difference']:+z.1f} %",
            _pressure(value["mean_pressure"]),
            f"{value['d_star']:.3f}",
            "" if first else f"{value['d_star_difference']:+z.3f}",
        ]
        shares = ["elastic_share", "elastoplastic_share", "plastic_share"]
        shares += ["particle_load_share"] if particles else []
        return [*out, *(f"{100 * value[name]:.1f} %" for name in shares), number]

    heads = ["law", "A_t", "diff.", "F/A_t", "d/sigma", "diff.", "elastic", "el.-plastic"]
    heads += ["plastic", "particles' load"] if particles else ["plastic"]
    shown = _table([*heads, "note"], right=True)
    shown.columns[0].justify = "left"
    notes: list[str] = []
    for i in range(one.sizes["law"]):
        row = one.isel(law=i)
        if text := row.note.item():
            notes.append(f"{len(notes) + 1} {row.law.item()}: {text}")
        shown.add_row(*cells(row, str(len(notes)) if text else ""))
    console.print(shown)
    for note in notes:
        console.print(note)


# -------------------------------------------------------------------------- table
@app.command()
def table(
    study: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="The study file.")],
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
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="As in solve; may be repeated."),
    ] = None,
) -> None:
    """Pressure and real area of a study's contact against separation, for other solvers."""
    from .study import load_study
    from .table import FORMATS, rounded_up
    from .units import to_si

    suffixes = {suffix: name for name, (_, suffix) in FORMATS.items()}
    name = form or suffixes.get(out.suffix.lower())
    problems = []
    if name is None:
        problems.append(
            f"--out {out}: the suffix does not say which format; add --format "
            f"{', '.join(FORMATS)}, or use one of {', '.join(suffixes)}"
        )
    elif name not in FORMATS:
        problems.append(f"--format {name} must be one of {', '.join(FORMATS)}")
    elif units is not None and name not in ("abaqus", "avl"):
        problems.append(f"--units {units} has no meaning for {name}, which is in SI units")
    ends: dict[str, float | None] = {"low": None, "high": None}
    for key, option, text in (("low", "--from", low), ("high", "--to", high)):
        if text is not None:
            try:
                ends[key] = to_si(text, "m")
            except InvalidValue as error:
                problems += [f"{option}: {sentence}" for sentence in error.problems]
    if problems or name is None:
        raise InvalidValue(*problems)
    asked = load_study(study, settings or ())
    for sentence in asked.notes:
        _one_line(sentence)
    made = asked.contact.table(
        low=ends["low"], high=ends["high"], tolerance=tolerance, coordinate=coordinate
    )
    write, _ = FORMATS[name]
    write(made, out, **({} if units is None else {"units": units}))
    first, last = (_pressure(float(made.p(end))) for end in made.h[[0, -1]])
    print(
        f"written: {out} ({name}): {coordinate} from {_length(made.h[0])} to "
        f"{_length(made.h[-1])}, p from {first} to {last}; relative errors at most "
        f"{rounded_up(made.error.p)} of p, {rounded_up(made.error.A)} of A_t, "
        f"{rounded_up(made.error.dp_dh)} of dp/d{coordinate}",
        file=sys.stderr,
    )


# -------------------------------------------------------------------------- surface
@app.command()
def surface(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help='A measured surface or profile, or "example".')
    ],
    cutoff: Annotated[
        str | None,
        typer.Option("--cutoff", metavar="LENGTH", help='E.g. "2 um"; 0 as sampled.'),
    ] = None,
    detrend: Annotated[
        str | None,
        typer.Option("--detrend", help="Form to remove: none, tilt (default) or curvature."),
    ] = None,
    unit: Annotated[
        str | None, typer.Option("--unit", help="Of a file that tells none, e.g. um.")
    ] = None,
    spacing: Annotated[
        str | None,
        typer.Option("--spacing", metavar="LENGTH[,LENGTH]", help="Of a file that tells none."),
    ] = None,
    channel: Annotated[
        str | None, typer.Option("--channel", help="Number or name of a channel of the file.")
    ] = None,
    resolution: Annotated[
        str | None,
        typer.Option(
            "--resolution", metavar="LENGTH", help="Shortest wave the instrument tells apart."
        ),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print one JSON object and nothing else.")
    ] = False,
    csv_file: Annotated[
        Path | None, typer.Option("--csv", metavar="FILE", help="Write one row per cut-off.")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Folder for surface.png, .svg and .json."),
    ] = None,
) -> None:
    """Moments and asperities of a measured surface, and what they owe to the cut-off."""
    from .topography import from_topography
    from .units import to_si

    problems: list[str] = []

    def metres(option: str, text: str) -> float:
        try:
            return to_si(text, "m")
        except InvalidValue as error:
            problems.extend(f"{option}: {sentence}" for sentence in error.problems)
            return 1.0

    given: dict[str, Any] = {"detrend": detrend, "unit": unit, "channel": channel}
    for name, text in (("cutoff", cutoff), ("resolution", resolution)):
        given[name] = None if text is None else metres(f"--{name}", text)
    if spacing is not None:
        given["spacing"] = tuple(metres("--spacing", part) for part in spacing.split(","))
    if out is not None and out.exists() and not out.is_dir():
        problems.append(f"--out {out} must be a folder, and a file of that name exists")
    if problems:
        raise InvalidValue(*problems)
    found = from_topography(file, **given)
    result = found.to_dict()
    for sentence in found.warnings:
        _one_line(sentence)
    written = []
    if csv_file is not None:
        _write_curve(csv_file, result)
        written.append(csv_file)
    if out is not None:
        written += _write_surface(out, found, result)
    if as_json:
        print(json.dumps(_finite(result), indent=1, allow_nan=False))
    else:
        _show_surface(found, result)
    for path in written:
        print(f"written: {path}", file=sys.stderr)


def _finite(value: Any) -> Any:
    """Plain data with None for numbers that are not finite."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _write_curve(path: Path, result: dict[str, Any]) -> None:
    from .files import write_text

    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    units, curve = result["units"], _finite(result["curve"])
    writer.writerow(f"{name} [{units[name]}]" if units[name] else name for name in curve)
    writer.writerows(zip(*curve.values(), strict=True))
    write_text(path, text.getvalue())


def _write_surface(folder: Path, found: Any, result: dict[str, Any]) -> list[Path]:
    import matplotlib as mpl

    from .files import whole, write_text
    from .plot import surface as draw

    folder.mkdir(parents=True, exist_ok=True)
    out = [folder / f"surface.{suffix}" for suffix in ("png", "svg", "json")]
    drawing = draw(found)
    with whole(out[0]) as png, whole(out[1]) as svg:
        drawing.savefig(png, dpi=200)
        with mpl.rc_context({"svg.hashsalt": "thirdbody"}):
            drawing.savefig(svg, metadata={"Date": None})
        write_text(out[2], json.dumps(_finite(result), indent=1, allow_nan=False) + "\n")
    return out


def _show_surface(found: Any, result: dict[str, Any]) -> None:
    """What was read, the answer at the cut-off used, and its course with the cut-off."""
    console = _console()
    points = " x ".join(map(str, result["points"]))
    sides = " x ".join(map(_length, result["size"]))
    kind = "map" if found.dim == 2 else "profile"
    console.print(f"{found.source}: {kind} of {points} points, {sides}")
    sampled, used = result["as_sampled"], result["cutoff"]
    console.print(
        f"as sampled: RMS height {_length(sampled['rms_height'])}, RMS "
        f"{'gradient' if found.dim == 2 else 'slope'} {_number(sampled['rms_slope'])}, RMS "
        f"curvature {_number(sampled['rms_curvature'])} 1/m"
    )
    limit = "" if used["instrument_limit"] is None else _length(used["instrument_limit"]) + ", "
    console.print(f"limit of the instrument: {limit}{used['instrument_limit_reason']}")
    console.print(f"recommended cut-off: {_length(used['recommended'])}: {used['reason']}")
    console.print()
    at = "as sampled" if used["used"] == 0 else f"at {_length(used['used'])}"
    columns = ("sigma", "R", "eta [1/m^2]", "eta R sigma", "alpha", "sigma_s", "y_s")
    answer = _table((at, *columns), right=True)
    answer.columns[0].justify = "left"
    spectral = found.moments_at(method="spectrum")
    for label, one in (("differences", found.moments), ("spectrum", spectral)):
        answer.add_row(
            label,
            _length(one.sigma),
            _length(one.R),
            _number(one.eta),
            _number(one.eta * one.R * one.sigma),
            _number(one.alpha),
            _length(one.sigma_s),
            _length(one.y_s),
        )
    if found.dim == 2 and found.summits.count > 1:
        counted = found.summits
        answer.add_row(
            f"{counted.count} summits",
            _length(found.moments.sigma),
            _length(counted.R),
            _number(counted.density),
            _number(counted.density * counted.R * found.moments.sigma),
            "-",
            _length(counted.sigma_s),
            _length(counted.y_s),
        )
    console.print(answer)
    curve = _finite(result["curve"])
    heads = ("cut-off", "sigma", "gradient", "alpha", "R", "R counted", "eta", "eta counted")
    course = _table((*heads, "R per octave"), right=True)
    change = found.curve().per_octave("R")
    for i, cut in enumerate(curve["cutoff"]):
        course.add_row(
            _length(cut),
            _length(curve["sigma"][i]),
            _number(curve["rms_gradient"][i]),
            _number(curve["alpha"][i]),
            _length(curve["R"][i]),
            _length(curve["R_counted"][i]),
            _number(curve["eta"][i]),
            _number(curve["eta_counted"][i]),
            f"{100 * change[i]:+.0f} %",
        )
    console.print(course)
    console.print(
        f"skewness {result['skewness']:.3g}, kurtosis {result['kurtosis']:.3g}, mean square slopes "
        f"{_number(result['anisotropy'])} : 1 along and across"
    )


# -------------------------------------------------------------------------- reproduce
@app.command()
def reproduce(
    paper: Annotated[str, typer.Argument(help=f"One of: {', '.join(PAPERS)}.")],
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Folder for figures and ledger.")
    ] = None,
    preset: Annotated[
        str | None,
        typer.Option(
            "--preset",
            metavar="NAME",
            help="Reading that draws the figures of horng2022; the other studies draw them all.",
        ),
    ] = None,
) -> None:
    """Every figure and the ledger of claims of a paper."""
    from importlib import import_module

    problems = []
    if paper not in PAPERS:
        problems.append(f"paper = {paper!r} must be one of {', '.join(PAPERS)}")
    folder = out or Path(paper)
    if folder.exists() and not folder.is_dir():
        problems.append(f"--out {folder} must be a folder, and a file of that name exists")
    if problems:
        raise InvalidValue(*problems)
    study = import_module(f".studies.{paper}", __package__)
    with _progress() as progress:
        chosen = {} if preset is None else {"preset": preset}
        done = study.reproduce(folder, progress=progress, **chosen)
    for line in done.lines():
        print(line)


class _progress:
    """Progress on standard error: a bar on a terminal, a line a stage elsewhere."""

    def __enter__(self) -> Callable[[str, int, int], None]:
        self.bar = None
        self.tasks: dict[str, Any] = {}
        if sys.stderr.isatty():
            from rich.console import Console
            from rich.progress import Progress

            self.bar = Progress(console=Console(stderr=True), transient=True)
            self.bar.start()
        return self.report

    def report(self, stage: str, done: int, total: int) -> None:
        if self.bar is not None:
            if stage not in self.tasks:
                self.tasks[stage] = self.bar.add_task(stage, total=total)
            self.bar.update(self.tasks[stage], completed=done, total=total)
        elif stage not in self.tasks:
            self.tasks[stage] = None
            print(f"{stage} ...", file=sys.stderr, flush=True)

    def __exit__(self, *_: Any) -> None:
        if self.bar is not None:
            self.bar.stop()


# -------------------------------------------------------------------------- what there is
@app.command()
def laws(
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    as_page: Annotated[
        bool, typer.Option("--markdown", help="Print the page of asperity laws, docs/laws.md.")
    ] = False,
) -> None:
    """The laws of asperities and particles, with citation and range."""
    from . import asperity, particle
    from .units import say

    if as_json and as_page:
        raise typer.BadParameter("--json and --markdown exclude each other; run the command twice")
    if as_page:
        from .compare import laws_page

        print(laws_page(), end="")
        return

    kinds = {"asperity": asperity.REGISTRY, "particle": particle.REGISTRY}
    found = {
        kind: [_about_law(law) for law in registry.values()] for kind, registry in kinds.items()
    }
    if as_json:
        print(json.dumps(found, indent=1, allow_nan=False))
        return
    console = _console()
    for kind, entries in found.items():
        table = _table(("name", "law", "valid range", "citation"))
        for entry in entries:
            doi = f", doi:{entry['doi']}" if entry["doi"] else ""
            table.add_row(
                entry["name"],
                f"{entry['title']} ({entry['year']})",
                entry["valid_range"],
                f"{entry['citation']}{doi} ({entry['provenance']})",
            )
        console.print(f"[{kind}_law]")
        console.print(table)
        for entry in filter(lambda entry: entry["options"], entries):
            table = _table((f"options of {entry['name']}", "default", "allowed", "meaning"))
            for option in entry["options"]:
                default = "-" if option["default"] is None else say(option["default"])
                table.add_row(option["key"], default, option["allowed"], option["meaning"])
            console.print(table)


def _about_law(law: type) -> dict[str, Any]:
    from .study import filled_in

    about = ("name", "title", "year", "citation", "doi", "provenance", "valid_range")
    usual = law()
    options = [
        _about_option(item, getattr(usual, item.name))
        for item in dataclasses.fields(law)
        if item.name not in filled_in(law)
    ]
    return {key: getattr(law, key) for key in about} | {"options": options}


def _about_option(item: dataclasses.Field, default: Any) -> dict[str, Any]:
    from .units import say
    from .values import allowed_range

    default = getattr(default, "name", default)
    allowed, meaning, unit = "", "", ""
    if about := item.metadata.get("quantity"):
        allowed, unit = allowed_range(about).removeprefix("must be "), about["unit"]
        meaning = f"{about['meaning']} {about['symbol']}"
    elif about := item.metadata.get("choice"):
        allowed, meaning = ", ".join(map(say, about["options"])), about["meaning"]
    elif isinstance(default, bool):
        allowed = "true, false"
    elif isinstance(default, str):
        allowed = "name of an asperity law, or a table with its options"
    return {
        "key": item.name,
        "default": default,
        "allowed": allowed,
        "unit": unit,
        "meaning": meaning,
    }


@app.command("materials")
def list_materials(
    query: Annotated[
        list[str] | None,
        typer.Argument(help="Words of name, kind or description.", show_default=False),
    ] = None,
    own: Annotated[
        list[Path] | None,
        typer.Option("--file", help="A TOML file of your own materials.", show_default=False),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    as_table: Annotated[
        bool, typer.Option("--markdown", help="Print the tables of the page docs/materials.md.")
    ] = False,
) -> None:
    """The materials of the library, with range and source: thirdbody materials bearing steel."""
    from .materials import materials

    if as_json and as_table:
        raise typer.BadParameter("--json and --markdown exclude each other; run the command twice")
    library = materials.load(*own) if own else materials
    asked = " ".join(query or [])
    every = library.entries()
    entries = {name: every[name] for name in library.search(asked)}
    if as_json:
        print(json.dumps(entries, indent=1, allow_nan=False))
        return
    if not entries:
        kinds = dict.fromkeys(entry.get("kind", "") for entry in every.values())
        raise InvalidValue(
            f"no material has {asked!r} in its name or description; "
            f"there are kinds {', '.join(filter(None, kinds))}"
        )
    if as_table:
        print(_materials_in_markdown(entries))
        return
    table = _table(("name", "what", "E", "nu", "H", "standing", "source"))
    for name, entry in entries.items():
        doi = f", doi:{entry['doi']}" if entry.get("doi") else ""
        table.add_row(
            name,
            entry.get("about", ""),
            _in_range(entry, "E", 1e9, " GPa"),
            _in_range(entry, "nu", 1.0, ""),
            _in_range(entry, "H", 1e9, " GPa"),
            entry.get("standing", ""),
            entry["source"] + doi,
        )
    _console().print(table)


def _in_range(entry: dict[str, Any], key: str, scale: float, unit: str) -> str:
    """A value and, where sources differ, the range between them."""
    if key not in entry:
        return "-"
    low, high = entry.get("range", {}).get(key, (entry[key], entry[key]))
    spread = f" ({low / scale:.5g} to {high / scale:.5g})" if low < high else ""
    return f"{entry[key] / scale:.5g}{unit}{spread}"


def _materials_in_markdown(entries: dict[str, dict[str, Any]]) -> str:
    """Two tables: the numbers, and where each comes from."""
    numbers = {
        "E": ("E [GPa]", 1e9),
        "nu": ("ν", 1.0),
        "H": ("H [GPa]", 1e9),
        "density": ("ρ [kg/m³]", 1.0),
        "thermal_conductivity": ("κ [W/(m K)]", 1.0),
        "specific_heat": ("c_p [J/(kg K)]", 1.0),
        "resistivity": ("ρ_e [nΩ m]", 1e-9),
    }
    lines = [
        "| name | what | " + " | ".join(title for title, _ in numbers.values()) + " |",
        "| --- " * (2 + len(numbers)) + "|",
    ]
    for name, entry in entries.items():
        cells = (_in_range(entry, key, scale, "") for key, (_, scale) in numbers.items())
        lines.append(f"| `{name}` | {entry.get('about', '')} | {' | '.join(cells)} |")
    lines += ["", "| name | standing | source | numbers from elsewhere |", "| --- " * 4 + "|"]
    for name, entry in entries.items():
        doi = entry.get("doi")
        source = entry["source"] + (f", [{doi}](https://doi.org/{doi})" if doi else "")
        elsewhere = "; ".join(f"**{key}** {told}" for key, told in entry.get("sources", {}).items())
        lines.append(f"| `{name}` | {entry.get('standing', '')} | {source} | {elsewhere} |")
    return "\n".join(lines)
