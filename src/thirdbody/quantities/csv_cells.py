"""Cells of tables that people write, as CSV files of a spreadsheet."""

from __future__ import annotations

import csv
import re
from pathlib import Path

from ..errors import InvalidValue, Mistake
from .files import read_bytes

__all__ = ["numbered_cells"]


def numbered_cells(path: Path, what: str, *, most: int) -> list[tuple[int, list[str]]]:
    """Numbered lines of cells of a CSV file, without comments and empty lines.

    Columns are parted by comma, semicolon or tab; with semicolons or tabs the decimal mark may be
    a comma.

    Parameters
    ----------
    path : Path
        Of the file.
    what : str
        What it is, as a message says it: "a CSV file of sizes".
    most : int
        Most lines that it may have.

    Raises
    ------
    InvalidValue
        No file, no text, nothing in it, or too much.
    """
    try:
        text = read_bytes(path, what).decode("utf-8-sig")
    except FileNotFoundError:
        raise InvalidValue(
            f"cannot read {path}: there is no such file", code=Mistake.UNREADABLE
        ) from None
    except IsADirectoryError:
        raise InvalidValue(
            f"cannot read {path}: it is a folder, not a CSV file", code=Mistake.UNREADABLE
        ) from None
    except UnicodeDecodeError:
        raise InvalidValue(
            f"cannot read {path}: it is not UTF-8 text; save the sheet as CSV UTF-8",
            code=Mistake.UNREADABLE,
        ) from None
    except InvalidValue:
        raise
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise InvalidValue(f"cannot read {path}: {why.lower()}", code=Mistake.UNREADABLE) from None
    if "\0" in text:
        raise InvalidValue(
            f"cannot read {path}: it is not text; save the sheet as CSV UTF-8",
            code=Mistake.UNREADABLE,
        )
    kept = [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip(" ,;\t") and not line.lstrip().startswith("#")
    ]
    if not kept:
        raise InvalidValue(
            f"{path} is empty; its first line must name the columns", code=Mistake.EMPTY
        )
    if len(kept) > most:
        raise InvalidValue(
            f"{path} has {len(kept)} lines; {what} has at most {most}", code=Mistake.TOO_LARGE
        )
    parted = next((mark for mark in ";\t," if mark in kept[0][1]), ",")
    out: list[tuple[int, list[str]]] = []
    for number, line in kept:
        try:
            cells = next(csv.reader([line], delimiter=parted, skipinitialspace=True))
        except csv.Error as error:
            raise InvalidValue(f"{path}, line {number}: {error}", code=Mistake.FORM) from None
        cells = [cell.strip() for cell in cells]
        while len(cells) > 1 and not cells[-1]:
            cells.pop()
        if parted != "," and out:
            cells = [re.sub(r"^([+-]?\d*),(\d+)", r"\1.\2", cell) for cell in cells]
        out.append((number, cells))
    return out
