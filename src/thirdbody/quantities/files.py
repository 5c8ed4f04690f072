"""Output files appear whole or not at all, written beside their place, then renamed; what is read
has a size that it may have."""

from __future__ import annotations

import csv
import io
import os
import secrets
import stat
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ..errors import InvalidValue

__all__ = ["csv_of", "need_folders", "read_bytes", "whole", "with_units", "write_text"]

MOST_BYTES = 2**24
"""Of a file of text: a study, materials, sizes."""


def read_bytes(path: str | os.PathLike[str], what: str, *, most: int = MOST_BYTES) -> bytes:
    """The bytes of a file or of a pipe that ends.

    Parameters
    ----------
    path : path-like
    what : str
        What the file should be, for a message: "a study file".
    most : int, optional
        Bytes it may have.

    Raises
    ------
    OSError, ValueError
        It cannot be opened: no such file, a folder, no name of a file.
    InvalidValue
        It is a device or a socket, which may never end, or longer than that.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "study.toml"
    >>> _ = file.write_text("title = 'short'")
    >>> read_bytes(file, "a study file")
    b"title = 'short'"
    """
    mode = os.stat(path).st_mode
    if not (stat.S_ISREG(mode) or stat.S_ISFIFO(mode) or stat.S_ISDIR(mode)):
        raise InvalidValue(f"cannot read {path}: it is a device, not {what}")
    with open(path, "rb") as file:
        found = file.read(most + 1)
    if len(found) > most:
        raise InvalidValue(
            f"cannot read {path}: it is longer than {most // 2**20} MiB, which {what} never is"
        )
    return found


@contextmanager
def whole(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A temporary file to write, which takes the place of ``path`` when the block succeeds.

    It lies in the same folder and ends in the same suffix. When the block fails, or is
    interrupted, it is removed and an older ``path`` stays as it was. A link is followed; a
    device or pipe is written directly.

    Parameters
    ----------
    path : path-like
        The file that shall appear.

    Yields
    ------
    pathlib.Path
        Where to write.

    Raises
    ------
    InvalidValue
        The folder does not exist, or the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> place = Path(tempfile.mkdtemp()) / "numbers.csv"
    >>> with whole(place) as draft:
    ...     _ = draft.write_text("1,2")
    >>> place.read_text()
    '1,2'
    """
    target = Path(os.path.realpath(path))
    if target.is_dir():
        raise InvalidValue(f"cannot write {path}: it is a folder; give the name of a file")
    if os.path.exists(path) and not os.path.isfile(path):
        yield Path(path)
        return
    draft = target.with_name(f".{target.stem}.{secrets.token_hex(4)}.part{target.suffix}")
    try:
        try:
            draft.touch(exist_ok=False)
        except OSError as error:
            raise InvalidValue(f"cannot write {path}: {_why(error, target)}") from None
        yield draft
        with draft.open("rb+") as written:
            os.fsync(written.fileno())
        if target.exists():
            draft.chmod(target.stat().st_mode & 0o777)
        draft.replace(target)
    finally:
        draft.unlink(missing_ok=True)


def need_folders(*paths: str | os.PathLike[str] | None) -> None:
    """Refuse files whose folder does not exist before long work is done for them.

    Raises
    ------
    InvalidValue
        As `whole` says it, a sentence a file.
    """
    targets = [(path, Path(os.path.realpath(path))) for path in paths if path is not None]
    problems = [
        f"cannot write {path}: {_why(FileNotFoundError(), target)}"
        for path, target in targets
        if not target.parent.is_dir()
    ]
    if problems:
        raise InvalidValue(*problems)


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write a text file in UTF-8, whole or not at all.

    Raises
    ------
    InvalidValue
        The file cannot be written.
    """
    with whole(path) as draft:
        try:
            draft.write_text(text, encoding="utf-8", newline="")
        except BrokenPipeError:
            raise
        except OSError as error:
            raise InvalidValue(f"cannot write {path}: {_why(error, draft)}") from None


def _why(error: OSError, target: Path) -> str:
    if isinstance(error, (FileNotFoundError, NotADirectoryError)):
        return f"there is no folder {target.parent}; make it first"
    return (error.strerror or str(error)).lower()


def with_units(
    columns: Mapping[str, Sequence[Any]], units: Mapping[str, str]
) -> dict[str, Sequence[Any]]:
    """The same columns with their unit in their names, where they have one.

    Examples
    --------
    >>> list(with_units({"d": [1e-7], "mode": ["s-s"]}, {"d": "m"}))
    ['d [m]', 'mode']
    """
    return {
        f"{name} [{units[name]}]" if units.get(name) else name: values
        for name, values in columns.items()
    }


def csv_of(columns: Mapping[str, Sequence[Any]]) -> str:
    """Columns as comma-separated values; None is an empty cell.

    Examples
    --------
    >>> print(csv_of({"d [m]": [1e-7, None], "mode": ["s-s", "p-s"]}), end="")
    d [m],mode
    1e-07,s-s
    ,p-s
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(zip(*columns.values(), strict=True))
    return text.getvalue()
