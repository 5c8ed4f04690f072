"""The arguments and options that several commands share."""

from __future__ import annotations

import inspect
import math
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import MISSING, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_type_hints

import typer

from ..errors import InvalidValue, Mistake, Problem
from ..quantities.installed import offers
from .streams import SHOWS_ALL, WARNINGS, answer_first, at_once, remark, warn

if TYPE_CHECKING:
    from ..study import Study

__all__ = [
    "AsJson",
    "FilterText",
    "Force",
    "JsonFile",
    "KeepFile",
    "OwnCode",
    "ParquetFile",
    "Settings",
    "StudyFile",
    "XlsxFile",
    "argument",
    "load_own_code",
    "metres",
    "named_as_options",
    "not_a_folder",
    "option",
    "parameters_of",
    "read_study",
    "with_common_options",
]

StudyFile = Annotated[
    Path,
    typer.Argument(metavar="STUDY.toml", help="A study file; `thirdbody new KIND` writes one."),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]
JsonFile = Annotated[
    Path | None,
    typer.Option(
        "--json",
        metavar="[FILE.json]",
        help="Print one JSON object and nothing else, or write it to FILE.json.",
    ),
]
XlsxFile = Annotated[
    Path | None,
    typer.Option("--xlsx", metavar="FILE", help="Write a workbook, e.g. a.xlsx (needs openpyxl)."),
]
ParquetFile = Annotated[
    Path | None,
    typer.Option(
        "--parquet",
        metavar="FILE",
        help="Write the rows as Parquet, e.g. a.parquet (needs pyarrow).",
    ),
]
Force = Annotated[
    bool, typer.Option("--force", help="Write over files that thirdbody did not make, too.")
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help='Change a key for this run, e.g. roughness.sigma="80 nm"; may be repeated.',
    ),
]
KeepFile = Annotated[
    Path | None,
    typer.Option(
        "--keep",
        metavar="FILE",
        help="Keep what was computed there (the histories of [life.uncertainty], or the steps of "
        "one with a contact): the same command goes on with it.",
    ),
]
FilterText = Annotated[
    str | None,
    typer.Option(
        "--filter",
        metavar="SIZE=BETA,...",
        help="A filter by the beta ratios of its data sheet, sizes in um(c), e.g. "
        '"5=75, 10=1000": the oil before and after it.',
    ),
]
OwnCode = Annotated[
    list[Path] | None,
    typer.Option(
        "--import",
        metavar="FILE.py",
        help="A Python file with laws, outputs or distributions of your own; may be repeated.",
        show_default=False,
    ),
]


Verbose = Annotated[
    bool, typer.Option("--verbose", help="Show every warning, not only the three that matter most.")
]


def load_own_code(files: Iterable[Path] | None) -> None:
    """Laws, outputs and distributions of one's own: of installed packages, then of these files."""
    # asked by name first: loading takes a while, and most have none
    if files or offers() or os.environ.get("THIRDBODY_IMPORT"):
        from ..study.own_code import load_file, load_installed

        load_installed()
        for file in files or ():
            load_file(file)


def option(name: str, help: str, metavar: str | None = None, default: object = None) -> Any:
    """A field of a record of options: what a command is told behind this name."""
    typer_option = typer.Option(name, metavar=metavar, help=help)
    return field(default=default, metadata={"typer": typer_option})


def argument(
    help: str, metavar: str | None = None, *, default: object = MISSING, show_default: bool = True
) -> Any:
    """A field of a record of options: what a command is told without a name."""
    typer_argument = typer.Argument(metavar=metavar, help=help, show_default=show_default)
    return field(default=default, metadata={"typer": typer_argument})


def parameters_of(command: Callable[..., None]) -> list[inspect.Parameter]:
    """Parameters of a command, one for each option, where it takes a record of them."""
    parameters = inspect.signature(command, eval_str=True).parameters
    if "options" not in parameters:
        return list(parameters.values())
    record, out = parameters["options"].annotation, []
    for name, kind in get_type_hints(record, include_extras=True).items():
        record_field = record.__dataclass_fields__[name]
        if record_field.metadata:
            kind = Annotated[kind, record_field.metadata["typer"]]
        default = (
            inspect.Parameter.empty if record_field.default is MISSING else record_field.default
        )
        one = inspect.Parameter
        out.append(one(name, one.KEYWORD_ONLY, default=default, annotation=kind))
    return out


def with_common_options(
    command: Callable[..., None], *, warns: bool, waits: bool
) -> Callable[..., None]:
    """The command with the option ``--import`` and, where its answer ``warns``, ``--verbose``.

    The files of ``--import`` are loaded before anything is read. Notes of one that ``waits``
    stand behind its answer.
    """
    parameters = parameters_of(command)
    record = inspect.signature(command, eval_str=True).parameters.get("options")

    def run(*, own_code: list[Path] | None = None, verbose: bool = False, **values: object) -> None:
        SHOWS_ALL.set(verbose)
        WARNINGS.set(0)
        with answer_first() if waits else nullcontext():
            load_own_code(own_code)
            if record is None:
                command(**values)
            else:
                command(record.annotation(**values))

    run.__name__, run.__doc__ = command.__name__, command.__doc__
    common = {"own_code": (None, OwnCode)} | ({"verbose": (False, Verbose)} if warns else {})
    added = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=kind)
        for name, (default, kind) in common.items()
    ]
    run.__signature__ = inspect.Signature([*parameters, *added])  # type: ignore[attr-defined]
    run.__annotations__ = {
        parameter.name: parameter.annotation for parameter in [*parameters, *added]
    }
    return run


def read_study(
    file: Path,
    settings: list[str] | None,
    *,
    writes: Sequence[Path | None] = (),
) -> Study:
    """The study with the keys set by --set; what looks like a slip is told at once.

    Files that are to be written must be none of those that are read.
    """
    from ..equilibrium.compiled.batch import threads
    from ..quantities.files import refuse_clashes
    from ..study import load_study
    from ..study.whole import files_of

    threads()  # an odd number of them is told before anything is solved, and whoever solves it
    study = load_study(file, settings or ())
    if any(writes):
        refuse_clashes(writes, files_of(file, settings or ()))
    tell_notes(study)
    return study


def tell_notes(study: Study) -> None:
    """Warn of what looks like a slip at once; with the answer, say what was taken for a drawing."""
    from ..quantities.slips import SLIP

    for sentence in study.notes:
        if getattr(sentence, "code", "").startswith(SLIP):
            with at_once():
                warn(sentence)
        elif sentence in study.assumed:
            remark(sentence, counts=True)
        else:
            warn(sentence)


def not_a_folder(out: Path | None) -> list[Problem]:
    """Why files cannot be written into this folder."""
    from ..quantities.files import hindrance_of_folder

    if out is None:
        return []
    if out.exists() and not out.is_dir():
        rule = "must be a folder, and a file of that name exists"
        return [Problem("--out", rule, str(out), code=Mistake.UNWRITABLE)]
    why = hindrance_of_folder(out)
    rule = f": cannot write there: {why}"
    return [Problem("--out", rule, str(out), code=Mistake.UNWRITABLE)] if why else []


@contextmanager
def named_as_options(*names: str) -> Iterator[None]:
    """Context in which mistakes in arguments of these names are told as those in options."""
    try:
        yield
    except InvalidValue as error:
        raise type(error)(
            *(
                problem.changed(path=f"--{problem.path}") if problem.place in names else problem
                for problem in error.problems
            )
        ) from None


def metres(option: str, text: str, problems: list[str]) -> float:
    """The length that an option says [m]; NaN, and one problem more, where it says none."""
    from ..quantities.units import to_si

    try:
        return to_si(text, "m")
    except InvalidValue as error:
        problems += [problem.put_at(option, sign=":") for problem in error.problems]
        return math.nan
