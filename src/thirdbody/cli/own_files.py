"""Files that a command may replace: those that this program made, and any with ``--force``.

Each kind is known by what every file of it says: a page by its style, a picture and a workbook by
who made them, a table by its columns, so that a command may be run again over what it wrote.
"""

from __future__ import annotations

import csv
import json
import re
import zipfile
from collections.abc import Callable, Iterable
from pathlib import Path

from ..errors import InvalidValue, Mistake, Problem
from ..quantities.files import hindrance
from ..views.html import is_page

__all__ = ["need_places", "refuse_strangers"]

HEADS = (
    {"status", "F_star [1]", "pressure [Pa]", "h [m]", "A_t [1]", "residual [1]", "iterations"},
    {"speed [m/s]", "hersey [1]", "h_T [m]", "lambda_ratio [1]", "regime", "status"},
    {"law", "F_star [1]", "A_t [1]", "mean_pressure [Pa]", "d_star_difference [1]", "note"},
    {"cutoff [m]", "m0 [m^2]", "m2 [1]", "m4 [1/m^2]", "eta_counted [1/m^2]", "R_counted [m]"},
    {"feasible", "front", "reason"},
    {"row of the sweep"},
    {"force [N]", "failure [1]", "failure_low [1]", "failure_high [1]", "failure_of_all [1]"},
    {"grain [m]", "particles", "height [m]", "width [m]", "force [N]", "thin"},
    {"time [s]", "code", "volume [m^3]", "in the oil [kg]", "ingress [kg]", "settled [kg]"},
    {"time [s]", "in the contact [kg]", "arrivals [kg]", "worn 1 [kg]", "worn 2 [kg]"},
)
"""Columns by which a table is known: of solve, film, compare, surface, design, sweep, probability,
plate, life of an oil, life of a dry contact."""
JSON_KEYS = (
    {"curve", "units"},
    {"title", "version", "inputs", "warnings", "citations"},
    {"title", "objectives", "values", "tolerance"},
)
"""Keys by which JSON is known: of surface; of solve, film; of design."""
PROBLEM_KEYS = {"code", "path", "allowed", "sentence"}
"""Keys by which a mistake is known that stands in the place of an answer."""
NAMED = {
    ".csv": "table",
    ".xlsx": "workbook",
    ".xls": "workbook of old Excel",
    ".ods": "workbook of LibreOffice",
    ".parquet": "Parquet file",
    ".json": "JSON",
    ".html": "page",
    ".pdf": "PDF",
}
"""Ends of names, and the kinds of files that have them."""
FIRST = 65536
"""Bytes in which a file of text says what it is."""


def need_places(places: Iterable[tuple[Path | None, str]], *, force: bool) -> None:
    """Refuse files that cannot be made or are somebody else's, before long work is done for them.

    Parameters
    ----------
    places : iterable of (path or None, str)
        Files to write, and their kinds: "table", "workbook", "Parquet file", "picture", "page",
        "PDF", "JSON", "export".
    force : bool
        Replace what exists, whosever it is.

    Raises
    ------
    InvalidValue
        A sentence a file.
    """
    problems = []
    for path, kind in places:
        if path is None:
            continue
        if (other := NAMED.get(path.suffix.lower(), kind)) != kind and kind in NAMED.values():
            end = next(end for end, named_kind in NAMED.items() if named_kind == kind)
            rule = f"cannot write {path}: that is the name of a {other}, and a {kind} goes into it"
            hint = f"give a name that ends in {end}"
            if kind == "table" and other.startswith("workbook"):
                hint += f", or write a workbook: --xlsx {path.with_suffix('.xlsx')}"
        elif why := hindrance(path):
            rule, hint = f"cannot write {path}: {why}", ""
        elif not force and not _may_go(path, kind):
            rule = f"cannot write {path}: it exists and is no {kind} of thirdbody"
            hint = "give another name, or add --force to replace it"
        else:
            continue
        problems.append(Problem("", rule, hint=hint, code=Mistake.UNWRITABLE, source=str(path)))
    if problems:
        raise InvalidValue(*problems)


def refuse_strangers(folder: Path | None, main: str, *others: str) -> None:
    """Refuse to put files into a folder where others of their names are somebody else's.

    Parameters
    ----------
    folder : pathlib.Path or None
    main : str
        Name of the file that says of what study all are; a table or JSON.
    *others : str

    Raises
    ------
    InvalidValue
        One exists, and the main one is none of ours.
    """
    if folder is None:
        return
    there = [name for name in (main, *others) if (folder / name).exists()]
    if there and not (_is_json if main.endswith(".json") else _is_table)(folder / main):
        raise InvalidValue(
            f"{folder} holds {', '.join(there)} of another study, or of another program; give "
            "another folder, remove what is not needed, or add --force to replace it",
            code=Mistake.OTHER_STUDY,
        )


def _may_go(path: Path, kind: str) -> bool:
    """Whether nothing of somebody else's is lost where a file of this kind takes the place."""
    if not path.is_file() or path.stat().st_size == 0:
        return True  # nothing there, an empty file, or a device or pipe
    try:
        return KINDS[kind](path)
    except OSError:
        return False


def _start(path: Path) -> str:
    with path.open("rb") as file:
        return file.read(FIRST).decode("utf-8", errors="replace")


def _is_table(path: Path) -> bool:
    """Whether columns and separators are those of a table that a command writes as CSV."""
    try:
        head = next(csv.reader([_start(path).partition("\n")[0]]), [])
    except (OSError, csv.Error):
        return False
    return _has_head(head)


def _has_head(head: Iterable[object]) -> bool:
    names = set(head)
    return any(columns <= names for columns in HEADS)


def _is_workbook(path: Path) -> bool:
    """Whether a sheet of a workbook has our columns, and it was saved by nobody since."""
    from openpyxl import load_workbook

    from ..views.workbook import MADE

    try:
        with zipfile.ZipFile(path) as book:
            saved = re.findall(rb"\d{4}-\d\d-\d\dT[\d:]+Z", book.read("docProps/core.xml"))
        if set(saved) != {MADE.encode()}:
            return False
        made = load_workbook(path, read_only=True)
        try:
            return any(
                _has_head(next(sheet.iter_rows(max_row=1, values_only=True), ()))
                for sheet in made.worksheets
            )
        finally:
            made.close()
    except OSError:
        raise
    except Exception:  # whatever those libraries raise for a file that is none
        return False


def _is_parquet(path: Path) -> bool:
    from pyarrow import ArrowException
    from pyarrow.parquet import read_schema

    try:
        return _has_head(read_schema(path).names)
    except ArrowException:
        return False


def _is_picture(path: Path) -> bool:
    """Whether a picture says that thirdbody made it, where its format says such things."""
    held = path.read_bytes()
    if held.startswith(b"\x89PNG"):
        return b"Software\0thirdbody" in held[:FIRST]
    if held.startswith(b"%PDF"):
        return b"/Creator (thirdbody" in held
    return b"<svg" in held[:FIRST] and b"<dc:title>thirdbody" in held[:FIRST]


def _is_export(path: Path) -> bool:
    """Whether a file for another solver says at its top who made it."""
    words = re.sub(r"\W+", " ", _start(path)[:1000])
    return "Contact pressure and real contact area against separation thirdbody" in words


def _is_json(path: Path) -> bool:
    """Whether JSON is that of a measured surface."""
    return JSON_KEYS[0] <= _object(path).keys()


def _is_answer(path: Path) -> bool:
    """Whether JSON is what a command answers, or the mistakes for which it has no answer."""
    held = _object(path)
    problems = held.get("problems")
    if len(held) == 1 and isinstance(problems, list):
        return all(isinstance(one, dict) and one.keys() >= PROBLEM_KEYS for one in problems)
    return any(needed <= held.keys() for needed in JSON_KEYS)


def _object(path: Path) -> dict[str, object]:
    """The object that JSON holds; an empty one where it holds none."""
    try:
        held = json.loads(path.read_bytes())
    except (OSError, ValueError, RecursionError):
        return {}
    return held if isinstance(held, dict) else {}


KINDS: dict[str, Callable[[Path], bool]] = {
    "table": _is_table,
    "workbook": _is_workbook,
    "Parquet file": _is_parquet,
    "picture": _is_picture,
    "PDF": _is_picture,
    "page": is_page,
    "JSON": _is_answer,
    "export": _is_export,
}
"""How a file of each kind is known."""
