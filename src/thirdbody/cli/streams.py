"""What goes to which stream, and the exit status.

Standard output holds the answer and nothing else; progress, warnings and errors go to standard
error. Exit status: 0 done, 2 bad input, 3 no equilibrium or no transition in the range searched,
130 interrupted. Of several states one that is solved is enough for 0; see `EXIT_STATUS`.
"""

from __future__ import annotations

import contextlib
import errno
import importlib.util
import io
import json
import math
import os
import re
import shutil
import stat
import sys
import textwrap
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextvars import ContextVar
from functools import partial
from itertools import pairwise, takewhile
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TextIO

import typer
from typer.core import TyperCommand, TyperGroup

from ..errors import (
    InvalidValue,
    Mistake,
    NoEquilibrium,
    NoTransition,
    Problem,
    code_of,
    in_study,
    note_of,
    problem_data,
    rank_notes,
)
from ..quantities.nearest import guess
from ..quantities.say import plural, unbroken
from .interrupt import INTERRUPTED, interruptible, interruption, leave

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..views.workbook import Sheet

__all__ = [
    "EXIT_STATUS",
    "STDOUT",
    "Command",
    "Commands",
    "TableFiles",
    "answer_first",
    "at_once",
    "complain",
    "figure_format",
    "fill",
    "open_closed_streams",
    "print_json",
    "refuse_full_output",
    "tell_written",
    "warn",
    "warn_of",
    "without_output",
    "write_figure",
    "write_together",
]

BAD_INPUT, NO_ANSWER, BROKEN_PIPE = 2, 3, 141
EXIT_STATUS = (
    "Exit status: 0 done, also where some of several states are not solved (status and "
    "status_code of each say so); 2 a mistake in the input; 3 no state is solved, or no "
    "transition is found; 130 interrupted."
)
MOST_SHOWN = 3
"""Notes that are shown where not all are asked for."""
SHOWS_ALL: ContextVar[bool] = ContextVar("shows_all", default=False)
"""Whether a command shows every note."""
WARNINGS: ContextVar[int] = ContextVar("warnings", default=0)
"""How many notes a command has shown."""
JSON_PLACE: ContextVar[Path | None] = ContextVar("json_place", default=None)
"""Where a command still has to put its JSON object; None where none is asked for."""
HELD: ContextVar[list[str] | None] = ContextVar("held", default=None)
"""Lines for standard error that wait for the answer; None where none waits."""
MOST_IN_A_SHEET = 2**20 - 1
"""Rows of a sheet below its head."""
STDOUT = Path("-")
"""What stands for standard output where a file may be named."""
SLIGHT = 1e-3
"""Effect on the whole answer below which a note on a part of it is not shown by itself."""
USAGE_ERROR: type[Exception] = typer.BadParameter.__mro__[1]
"""What is raised where a command line does not parse; typer names only a case of it."""
LEAST = 40
"""Width that messages are wrapped to at least."""


class Commands(TyperGroup):
    """Turns errors and warnings of every command into lines on standard error."""

    def parse_args(self, ctx: object, args: list[str]) -> list[str]:
        JSON_PLACE.set(place_of_json(args))
        try:
            return super().parse_args(ctx, args)  # type: ignore[arg-type]
        except USAGE_ERROR as error:
            show_in_one_form(error)
            raise

    def resolve_command(self, ctx: object, args: list[str]) -> object:  # type: ignore[override]
        try:
            return super().resolve_command(ctx, args)  # type: ignore[arg-type]
        except USAGE_ERROR:  # its sentence is printed where the command line ends
            meant = guess(args[0], self.commands)
            problem = Problem(args[0], "is no command", hint=meant, code=Mistake.UNKNOWN)
            give_problems([problem_data(problem)])
            raise

    def invoke(self, ctx: Any) -> object:
        with warnings.catch_warnings():
            warnings.showwarning = warn
            try:
                with interruptible():
                    answer = super().invoke(ctx)
                    sys.stdout.flush()
                return answer
            except InvalidValue as error:
                complain(error.problems)
                give_problems(map(problem_data, error.problems))
                raise typer.Exit(BAD_INPUT) from None
            except USAGE_ERROR as error:  # its sentence is printed where the command line ends
                show_in_one_form(error)
                give_problems([problem_data(problem_of_usage(error))])
                raise
            except (NoEquilibrium, NoTransition) as error:
                complain([str(error)])
                give_problems([_without_answer(error)])
                raise typer.Exit(NO_ANSWER) from None
            except (KeyboardInterrupt, SystemError) as error:
                # a compiled function in which it arrives makes it a SystemError
                pressed = interruption(error)
                if pressed is None and isinstance(error, SystemError):
                    raise
                complain([str(pressed or "interrupted")])
                leave()
                raise typer.Exit(INTERRUPTED) from None
            except OSError as error:
                raise typer.Exit(without_output(error)) from None


class Command(TyperCommand):
    """A command whose ``--json`` prints where no file is named behind it."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        named = any("--json" in parameter.opts and not getattr(parameter, "is_flag", True)
                    for parameter in self.params)  # fmt: skip
        words = with_json_file(args) if named else args
        JSON_PLACE.set(place_of_json(words))
        refuse_json_name(args, named=named)
        return super().parse_args(ctx, words)


def place_of_json(words: Sequence[str]) -> Path | None:
    """Where words of a command line ask for JSON: a file, "-" for standard output, or nowhere.

    >>> str(place_of_json(["solve", "--json"])), place_of_json(["solve", "--csv", "a.csv"])
    ('-', None)
    """
    place = None
    for word in takewhile(lambda word: word != "--", words):
        option, _, name = word.partition("=")
        if option == "--json":
            place = Path(name) if name else STDOUT
    return place


def with_json_file(args: Sequence[str]) -> list[str]:
    """Words of a command in which every ``--json`` names its file, "-" for standard output.

    What follows is its file where it ends in .json, as no study does.

    >>> with_json_file(["--json", "study.toml", "--csv", "a.csv"])
    ['--json=-', 'study.toml', '--csv', 'a.csv']
    >>> with_json_file(["study.toml", "--json", "a.json"])
    ['study.toml', '--json=a.json']
    """
    out: list[str] = []
    left = list(args)
    while left:
        word = left.pop(0)
        if word == "--":
            return [*out, word, *left]
        if word == "--json":
            file = left.pop(0) if left and left[0].lower().endswith(".json") else str(STDOUT)
            word = f"--json={file}"
        out.append(word)
    return out


def refuse_json_name(args: Sequence[str], *, named: bool) -> None:
    """Refuse what follows ``--json`` where it is a name for a file that would hold the JSON.

    A study or a measured surface may stand there: a TOML file, or any that exists.
    """
    for option, name in pairwise(args):
        if option == "--":
            return
        end = Path(name).suffix.lower()
        if option != "--json" or name.startswith("-") or end == ".toml":
            continue
        if not end and not (named and any(word.endswith(".toml") for word in args)):
            continue  # a word that a command searches for
        if (named and end == ".json") or Path(name).exists():
            continue
        hint = f"write --json > {name}"
        if named:
            hint += f", or --json {Path(name).with_suffix('.json')}"
        rule = "prints where no name that ends in .json follows it" if named else "takes no file"
        raise InvalidValue(
            Problem("--json", f": --json {rule}", name, hint=hint, code=Mistake.FORM)
        )


def open_closed_streams() -> None:
    """Streams that the shell has closed, as by ``>&-``, so that what is written there is refused.

    Left closed, the next file that is opened would take their number.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        flags = os.O_WRONLY if name == "stderr" else os.O_RDONLY
        if getattr(sys, name) is None and os.open(os.devnull, flags) == number:
            mode = "r" if name == "stdin" else "w"
            setattr(sys, name, open(number, mode, encoding="utf-8", closefd=False))  # noqa: SIM115


def refuse_full_output() -> None:
    """The OSError of an answer that will find no room, as on ``/dev/full``, before any work."""
    with contextlib.suppress(AttributeError, ValueError):  # no stream, or one without a number
        number = sys.stdout.fileno()
        if stat.S_ISCHR(os.fstat(number).st_mode):
            try:
                os.write(number, b"")
            except OSError as error:
                if error.errno == errno.ENOSPC:
                    raise


def without_output(error: OSError) -> int:
    """Say what could not be read or written; what is left of the answer is let go."""
    if not error.filename:
        # also at the last flush
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    if isinstance(error, BrokenPipeError):
        return BROKEN_PIPE  # whoever read the output has gone: leave quietly
    where = error.filename or "the output"
    complain([f"cannot read or write {where}: {error.strerror or error}"])
    try:
        sys.stderr.flush()
    except OSError:  # nor is there room for what is said: at the last flush neither
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stderr.fileno())
    return BAD_INPUT


@contextlib.contextmanager
def answer_first() -> Iterator[None]:
    """Notes, warnings and names of files wait until the answer stands; an error follows them.

    Of an answer that is interrupted nobody waits for notes.
    """
    waiting: list[str] = []
    before = HELD.set(waiting)
    try:
        yield
    except (KeyboardInterrupt, SystemError):
        waiting.clear()
        raise
    finally:
        HELD.reset(before)
        with contextlib.suppress(OSError):
            if waiting:
                sys.stdout.flush()
        for line in waiting:
            _print_beside(line)


@contextlib.contextmanager
def at_once() -> Iterator[None]:
    """Context whose notes are printed at once and do not wait for the answer."""
    before = HELD.set(None)
    try:
        yield
    finally:
        HELD.reset(before)


def _print_beside(line: str) -> None:
    """A line on standard error, behind the answer where one is awaited."""
    waiting = HELD.get()
    if waiting is None:
        print(line, file=sys.stderr)
    else:
        waiting.append(line)


def complain(sentences: Iterable[str]) -> None:
    """Errors, a line each; the exit status tells of them where nothing can be written."""
    with contextlib.suppress(OSError):
        for sentence in sentences:
            for line in in_study(sentence).splitlines():
                print(_wrap_line(f"error: {line}"), file=sys.stderr)


def give_problems(problems: Iterable[Mapping[str, object]]) -> None:
    """The JSON object of a command that has no answer, in the place of the answer.

    A file is written where nothing stands, or what an earlier run of this program wrote: no answer
    of an older study is taken for that of this one. Nobody else's is replaced, by ``--force``
    neither: what is wrong may be just that. Where files cannot be written, none is.
    """
    place, data = JSON_PLACE.get(), {"problems": list(problems)}
    no_files = any(problem["code"] == Mistake.UNWRITABLE for problem in data["problems"])
    if place == STDOUT:
        print_json(data)
        sys.stdout.flush()
    elif place is not None and not no_files:
        from .own_files import need_places

        with contextlib.suppress(InvalidValue):
            need_places([(place, "JSON")], force=False)
            text = f"{json.dumps(data, indent=1, allow_nan=False)}\n"
            write_together({place: partial(Path.write_bytes, data=text.encode())})
            JSON_PLACE.set(None)
            tell_written(place)


def show_in_one_form(error: Exception) -> None:
    """Let the sentence of a command line that does not parse begin as those of all other errors."""
    show = error.show  # type: ignore[attr-defined]

    def show_as_ours(file: TextIO | None = None) -> None:
        shown = io.StringIO()
        show(shown)
        text = re.sub("^Error: ", "error: ", shown.getvalue(), flags=re.MULTILINE)
        print(text, end="", file=file or sys.stderr)

    error.show = show_as_ours  # type: ignore[attr-defined]


def problem_of_usage(error: Exception) -> Problem:
    """The mistake in a command line that does not parse."""
    option, parameter = (getattr(error, name, None) for name in ("option_name", "param"))
    code = Mistake.UNKNOWN if option else Mistake.FORM
    message = getattr(error, "format_message", error.__str__)()
    if parameter is not None:
        name = max(parameter.opts, key=len)
        option = name if name.startswith("-") else parameter.metavar or name
    return Problem("", message, code=code, source=option or "")


def _without_answer(error: NoEquilibrium | NoTransition) -> dict[str, object]:
    """Why there is no answer, with the word of its status, as a mistake is taken apart."""
    kind = "no_transition" if isinstance(error, NoTransition) else "no_equilibrium"
    code = getattr(getattr(error, "status", None), "word", kind)
    return problem_data(Problem("", in_study(str(error)))) | {"code": code}


def warn(message: Warning | str, *_: object, **__: object) -> None:
    """A warning: one line of a pipe or file, as many lines of a terminal as it takes."""
    WARNINGS.set(WARNINGS.get() + 1)
    sentence = " ".join(in_study(note_of(message)).split())
    _print_beside(_wrap_line(f"warning: {sentence}"))


def warn_of(notes: Iterable[str], shares: Mapping[str, float] | None = None) -> None:
    """Print the notes of an answer: those that matter most, and how many more there are.

    What was said of the inputs counts among the most that are shown; the worst is always shown.

    Parameters
    ----------
    notes : iterable of str
    shares : mapping, optional
        Of codes whose effect is on a part of the answer alone, how large that part is [1]: a note
        whose effect on the whole is below `SLIGHT` is shown only where all are.
    """
    parts = shares or {}
    worst = rank_notes(notes)
    telling = [
        note
        for note in worst
        if not getattr(note, "effect", math.inf) * parts.get(code_of(note), math.inf) < SLIGHT
    ]
    shown = worst if SHOWS_ALL.get() else telling[: max(MOST_SHOWN - WARNINGS.get(), 1)]
    for note in shown:
        warn(note)
    if left := len(worst) - len(shown):
        remark(f"{plural(left, 'more warning')} of less effect on the answer; --verbose shows all")


def _wrap_line(line: str) -> str:
    """A line as a terminal shows it whole, in words; as it is where none reads along.

    ``COLUMNS`` sets the width, as of tables.
    """
    columns = os.environ.get("COLUMNS", "")
    if columns.isdecimal() and int(columns) > 0:
        width = max(int(columns), LEAST)
    elif sys.stderr.isatty():
        width = max(shutil.get_terminal_size().columns, LEAST)
    else:
        return line
    return fill(line, width, indent="  ")


def fill(line: str, width: int, *, indent: str = "") -> str:
    """A line as lines of so many characters, in which numbers stay beside their units.

    >>> fill("pressed by 1.2 MPa", 14)
    'pressed by\\n1.2 MPa'
    """
    filled = textwrap.fill(
        unbroken(line),
        width,
        subsequent_indent=indent,
        break_long_words=False,
        break_on_hyphens=False,
    )
    return filled.replace("\u00a0", " ")


def remark(sentence: str, *, counts: bool = False) -> None:
    """What was done or taken; one that ``counts`` is among the most notes that are shown."""
    WARNINGS.set(WARNINGS.get() + counts)
    _print_beside(_wrap_line(f"note: {' '.join(sentence.split())}"))


def print_json(data: object) -> None:
    """An answer as JSON, on standard output."""
    JSON_PLACE.set(None)
    print(json.dumps(data, indent=1, allow_nan=False))


def tell_written(*files: Path) -> None:
    """Say which files there are now."""
    for file in files:
        _print_beside(f"written: {file}")


class TableFiles(NamedTuple):
    """Files that an answer is written to; None for those not asked for."""

    csv: Path | None = None
    xlsx: Path | None = None
    parquet: Path | None = None
    json: Path | None = None

    @property
    def paths(self) -> list[Path]:
        return [path for path in self if path is not None and path != STDOUT]

    def need(self, figure: Path | None = None, *, force: bool = False) -> None:
        """Refuse what cannot or must not be written, of a figure too, before long work is done.

        A library or a folder is missing, or a file exists that thirdbody did not make.
        """
        from .own_files import need_places

        problems = []
        for option, library in (("xlsx", "openpyxl"), ("parquet", "pyarrow")):
            path = getattr(self, option)
            if path is not None and importlib.util.find_spec(library) is None:
                problems.append(
                    Problem(
                        f"--{option}",
                        f"needs {library}, which is not installed: "
                        f"pip install 'thirdbody[{option}]'",
                        str(path),
                        code=Mistake.ABSENT,
                    )
                )
        if problems:
            raise InvalidValue(*problems)
        kinds = ("table", "workbook", "Parquet file", "JSON", "picture")
        places = [(None if path == STDOUT else path, kind)
                  for path, kind in zip((*self, figure), kinds, strict=True)]  # fmt: skip
        need_places(places, force=force)

    def write(
        self,
        columns: Mapping[str, Sequence[object]],
        units: Mapping[str, str],
        *,
        sheets: Callable[[], Sequence[Sheet]] | None = None,
        data: Callable[[], object] | None = None,
    ) -> None:
        """A column each, its unit in its name, a row a state; the same bytes every time.

        All files of a run appear together, or none of them.

        Parameters
        ----------
        columns, units : mapping
        sheets : callable, optional
            Makes the sheets of the workbook; one that holds the columns alone by default.
        data : callable, optional
            Makes what goes into JSON, which is printed where its file is "-".
        """
        from ..quantities.files import csv_of, with_units

        named = with_units(columns, units)
        made: dict[Path, Callable[[Path], object]] = {}
        if self.csv is not None:
            made[self.csv] = partial(Path.write_bytes, data=csv_of(named).encode())
        if self.xlsx is not None:
            rows = max(map(len, columns.values()), default=0)
            if rows > MOST_IN_A_SHEET:
                raise InvalidValue(
                    f"cannot write {self.xlsx}: {rows:,} rows, and a sheet holds "
                    f"{MOST_IN_A_SHEET:,}; take --csv or --parquet",
                    code=Mistake.UNWRITABLE,
                )
            from ..views.workbook import sheet_of_table, workbook_bytes

            held = [sheet_of_table("Table", columns, units)] if sheets is None else sheets()
            made[self.xlsx] = partial(Path.write_bytes, data=workbook_bytes(held))
        if self.parquet is not None:
            made[self.parquet] = partial(_write_parquet, columns=named)
        said = None
        if self.json is not None and data is not None:
            said = json.dumps(data(), indent=1, allow_nan=False)
            if self.json != STDOUT:
                made[self.json] = partial(Path.write_bytes, data=f"{said}\n".encode())
        write_together(made)
        if said is not None:
            JSON_PLACE.set(None)
            if self.json == STDOUT:
                print(said)


def write_together(files: Mapping[Path, Callable[[Path], object]]) -> None:
    """Write several files, each whole, and none where one cannot be written.

    Parameters
    ----------
    files : mapping
        What writes each of them, into a path that it is given.
    """
    from ..quantities.files import refused_by_disk, whole

    with contextlib.ExitStack() as together:
        drafts = [(path, together.enter_context(whole(path))) for path in files]
        for path, draft in drafts:
            with refused_by_disk(path, draft):
                files[path](draft)


def _write_parquet(path: Path, columns: Mapping[str, Sequence[object]]) -> None:
    import pandas

    pandas.DataFrame(columns).to_parquet(path, engine="pyarrow", index=False)


def figure_format(figure: Path) -> str:
    """Format of a figure, by the suffix of its name."""
    kind = figure.suffix.lstrip(".").lower() or "png"
    if kind not in ("png", "svg", "pdf"):
        raise InvalidValue(
            Problem(
                "--figure",
                "must end in .png, .svg or .pdf",
                str(figure),
                code=Mistake.UNWRITABLE,
            )
        )
    return kind


def write_figure(figure: Path, drawing: Figure) -> None:
    """A matplotlib figure as a file, the same bytes every time."""
    from matplotlib import rc_context

    from ..quantities.files import whole
    from ..version import __version__
    from ..views.figure_files import save_figure

    kind = figure_format(figure)
    # by which the next run knows it for one of ours
    made = {"Software" if kind == "png" else "Creator": f"thirdbody {__version__}"}
    made |= {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(kind, {})  # type: ignore[arg-type]
    with whole(figure) as draft, rc_context({"svg.hashsalt": "thirdbody"}):
        save_figure(drawing, draft, kind, metadata=made)
    tell_written(figure)
