"""What goes to which stream, and the exit status.

Standard output holds the answer and nothing else; progress, warnings and errors go to standard
error. Exit status: 0 done, 2 bad input, 3 no equilibrium or no transition in the range searched,
130 interrupted.
"""

from __future__ import annotations

import contextlib
import errno
import importlib.util
import io
import json
import os
import shutil
import stat
import sys
import textwrap
import warnings
from collections.abc import Iterable, Mapping, Sequence
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import typer
from typer.core import TyperGroup

from ..errors import InvalidValue, NoEquilibrium, NoTransition, ranked
from ..quantities.say import plural
from ..quantities.study_words import in_study_words
from .interrupt import INTERRUPTED, interruptible, interruption, leave

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = [
    "Commands",
    "TableFiles",
    "complain",
    "figure_format",
    "open_closed_streams",
    "print_json",
    "refuse_full_output",
    "tell_written",
    "warn",
    "warn_of",
    "without_output",
    "write_figure",
]

BAD_INPUT, NO_ANSWER, BROKEN_PIPE = 2, 3, 141
MOST_SHOWN = 3
"""Notes that are shown where not all are asked for."""
SHOWS_ALL: ContextVar[bool] = ContextVar("shows_all", default=False)
"""Whether a command shows every note."""
WARNINGS: ContextVar[int] = ContextVar("warnings", default=0)
"""How many warnings a command has shown."""
LEAST = 40
"""Width that messages are wrapped to at least."""


class Commands(TyperGroup):
    """Turns errors and warnings of every command into lines on standard error."""

    def invoke(self, ctx: Any) -> Any:
        with warnings.catch_warnings():
            warnings.showwarning = warn
            try:
                with interruptible():
                    answer = super().invoke(ctx)
                    sys.stdout.flush()
                return answer
            except InvalidValue as error:
                complain(error.problems)
                raise typer.Exit(BAD_INPUT) from None
            except (NoEquilibrium, NoTransition) as error:
                complain([str(error)])
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
    return BAD_INPUT


def complain(sentences: Iterable[str]) -> None:
    """Errors, a line each; the exit status tells of them where nothing can be written."""
    with contextlib.suppress(OSError):
        for sentence in sentences:
            for line in in_study_words(sentence).splitlines():
                print(_wrap_line(f"error: {line}"), file=sys.stderr)


def warn(message: Warning | str, *_: object, **__: object) -> None:
    """A warning: one line of a pipe or file, as many lines of a terminal as it takes."""
    WARNINGS.set(WARNINGS.get() + 1)
    sentence = in_study_words(" ".join(str(message).split()))
    print(_wrap_line(f"warning: {sentence}"), file=sys.stderr)


def warn_of(notes: Iterable[str]) -> None:
    """What an answer leaves open: what matters most to it, and how much more there is.

    What was said of the inputs counts among the most that are shown; the worst is always shown.
    """
    worst = ranked(notes)
    shown = worst if SHOWS_ALL.get() else worst[: max(MOST_SHOWN - WARNINGS.get(), 1)]
    for note in shown:
        warn(note)
    if left := len(worst) - len(shown):
        remark(f"{plural(left, 'more warning')} of less effect on the answer; --verbose shows all")


def _wrap_line(line: str) -> str:
    """A line as a terminal shows it whole, in words; as it is where none reads along.

    ``COLUMNS`` sets the width, as of tables.
    """
    asked = os.environ.get("COLUMNS", "")
    if asked.isdecimal() and int(asked) > 0:
        width = max(int(asked), LEAST)
    elif sys.stderr.isatty():
        width = max(shutil.get_terminal_size().columns, LEAST)
    else:
        return line
    return textwrap.fill(
        line, width, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False
    )


def remark(sentence: str) -> None:
    """What was done, in one line: nothing is doubted by it."""
    print(_wrap_line(f"note: {' '.join(sentence.split())}"), file=sys.stderr)


def print_json(data: object) -> None:
    """An answer as JSON, on standard output."""
    print(json.dumps(data, indent=1, allow_nan=False))


def tell_written(*files: Path) -> None:
    """Say which files there are now."""
    for file in files:
        print(f"written: {file}", file=sys.stderr)


class TableFiles(NamedTuple):
    """Files that a table is written to; None for those not asked for."""

    csv: Path | None = None
    xlsx: Path | None = None
    parquet: Path | None = None

    @property
    def paths(self) -> list[Path]:
        return [path for path in self if path is not None]

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
                    f"--{option} {path} needs {library}, which is not installed: "
                    f"pip install 'thirdbody[{option}]'"
                )
        if problems:
            raise InvalidValue(*problems)
        kinds = ("table", "workbook", "Parquet file", "picture")
        need_places(zip((*self, figure), kinds, strict=True), force=force)

    def write(self, columns: Mapping[str, Sequence[object]], units: Mapping[str, str]) -> None:
        """A column each, its unit in its name, a row a state; the same bytes every time."""
        from ..quantities.files import csv_of, whole, with_units, write_text

        named = with_units(columns, units)
        if self.csv is not None:
            write_text(self.csv, csv_of(named))
        if self.xlsx is not None:
            _write_xlsx(self.xlsx, named)
        if self.parquet is not None:
            import pandas

            with whole(self.parquet) as part:
                pandas.DataFrame(named).to_parquet(part, engine="pyarrow", index=False)


def _write_xlsx(path: Path, columns: Mapping[str, Sequence[object]]) -> None:
    """A workbook of one sheet; when it was made stands nowhere in it."""
    import re
    import zipfile

    import pandas

    from ..quantities.files import whole

    made = io.BytesIO()
    pandas.DataFrame(columns).to_excel(made, engine="openpyxl", index=False, freeze_panes=(1, 1))
    with (
        whole(path) as part,
        zipfile.ZipFile(made) as book,
        zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as out,
    ):
        for name in book.namelist():
            data = book.read(name)
            if name == "docProps/core.xml":
                data = re.sub(rb"\d{4}-\d\d-\d\dT[\d:]+Z", b"1980-01-01T00:00:00Z", data)
            entry = zipfile.ZipInfo(name)  # dated 1980
            entry.compress_type = zipfile.ZIP_DEFLATED
            out.writestr(entry, data)


def figure_format(figure: Path) -> str:
    """What a figure is written as, by the end of its name."""
    kind = figure.suffix.lstrip(".").lower() or "png"
    if kind not in ("png", "svg", "pdf"):
        raise InvalidValue(f"--figure {figure} must end in .png, .svg or .pdf")
    return kind


def write_figure(figure: Path, drawing: Figure) -> None:
    """A matplotlib figure as a file, the same bytes every time."""
    from matplotlib import rc_context

    from ..quantities.files import whole
    from ..version import __version__

    kind = figure_format(figure)
    # by which the next run knows it for one of ours
    made = {"Software" if kind == "png" else "Creator": f"thirdbody {__version__}"}
    made |= {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(kind, {})  # type: ignore[arg-type]
    with whole(figure) as part, rc_context({"svg.hashsalt": "thirdbody"}):
        drawing.savefig(part, format=kind, metadata=made)
    tell_written(figure)
