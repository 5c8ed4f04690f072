"""Output files appear whole or not at all, written beside their place, then renamed; what is read
has a size that it may have."""

from __future__ import annotations

import csv
import hashlib
import io
import os
import platform
import re
import secrets
import stat
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from ..errors import InvalidValue, Mistake, Problem

__all__ = [
    "csv_of",
    "hindrance",
    "hindrance_of_folder",
    "is_draft",
    "make_folder",
    "need_folders",
    "read_bytes",
    "refuse_clashes",
    "refused_by_disk",
    "remove_files",
    "whole",
    "with_units",
    "write_text",
]

DAY = 86400.0
"""Seconds after which a draft that another machine wrote is taken for left."""
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
        raise InvalidValue(
            f"cannot read {path}: it is a device, not {what}", code=Mistake.UNREADABLE
        )
    with open(path, "rb") as file:
        content = file.read(most + 1)
    if len(content) > most:
        raise InvalidValue(
            f"cannot read {path}: it is longer than {most // 2**20} MiB, which {what} never is",
            code=Mistake.UNREADABLE,
        )
    return content


@contextmanager
def whole(path: str | os.PathLike[str], *, tidy: bool = True) -> Iterator[Path]:
    """A temporary file to write, which takes the place of ``path`` when the block succeeds.

    It lies in the same folder and ends in the same suffix. When the block fails, or is
    interrupted, it is removed and an older ``path`` stays as it was. A link is followed; a
    device or pipe is written directly.

    Parameters
    ----------
    path : path-like
        The file that shall appear.
    tidy : bool, optional
        Remove what killed runs left of the same file. A folder of many files is tidied at once
        (`is_draft`).

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
        raise InvalidValue(
            f"cannot write {path}: it is a folder; give the name of a file",
            code=Mistake.UNWRITABLE,
            source=str(path),
        )
    if os.path.exists(path) and not os.path.isfile(path):
        yield Path(path)
        return
    draft = _draft(target)
    try:
        if tidy:
            _remove_left(target)
        try:
            draft.touch(exist_ok=False)
        except OSError as error:
            raise InvalidValue(
                f"cannot write {path}: {_why(error, target)}",
                code=Mistake.UNWRITABLE,
                source=str(path),
            ) from None
        with refused_by_disk(path, draft):
            yield draft
            with draft.open("rb+") as written:
                os.fsync(written.fileno())
            if target.exists():
                draft.chmod(target.stat().st_mode & 0o777)
            draft.replace(target)
    finally:
        with suppress(OSError):  # where none can be made, none can be removed
            draft.unlink(missing_ok=True)


@contextmanager
def refused_by_disk(
    path: str | os.PathLike[str], draft: str | os.PathLike[str] = ""
) -> Iterator[None]:
    """Say in one sentence that a file cannot be written: a full disk, a folder of others.

    Raises
    ------
    InvalidValue
        In place of an OSError about ``path`` or its draft; others, and a reader that has gone,
        pass.
    """
    try:
        yield
    except BrokenPipeError:
        raise
    except OSError as error:
        about = error.filename
        ours = about is None or any(
            Path(about).is_relative_to(place) for place in (path, draft) if place
        )
        if not ours:
            raise
        raise InvalidValue(
            f"cannot write {path}: {_why(error, Path(path))}",
            code=Mistake.UNWRITABLE,
            source=str(path),
        ) from None


def _draft(target: Path) -> Path:
    """Path of the draft of a file; its name says which process writes it."""
    who = f"{_machine()}-{os.getpid():x}-{secrets.token_hex(2)}"
    return target.with_name(f".{target.stem}.{who}.part{target.suffix}")


def _machine() -> str:
    """This machine, in four digits."""
    return hashlib.sha256(platform.node().encode()).hexdigest()[:4]


def _draft_names(stem: str, suffix: str) -> re.Pattern[str]:
    """Names of drafts of a file, of earlier versions too, which said no writer."""
    who = r"(?:[0-9a-f]{8}|(?P<machine>[0-9a-f]{4})-(?P<process>[0-9a-f]+)-[0-9a-f]{4})"
    return re.compile(rf"\.{re.escape(stem)}\.{who}\.part{re.escape(suffix)}")


def is_draft(name: str, of: str) -> bool:
    """Whether a file of this name is a draft of the file of another name.

    Examples
    --------
    >>> is_draft(".states.01ab23cd.part.csv", "states.csv"), is_draft(".film.part.mkv", "film.mkv")
    (True, False)
    """
    stem, suffix = os.path.splitext(of)
    return _draft_names(stem, suffix).fullmatch(name) is not None


def _remove_left(target: Path) -> None:
    """Remove the drafts of a file whose writers are gone."""
    names = _draft_names(target.stem, target.suffix)
    with suppress(OSError), os.scandir(target.parent) as entries:
        for entry in entries:
            match = names.fullmatch(entry.name)
            if match and entry.is_file(follow_symlinks=False) and not _is_written(match, entry):
                Path(entry.path).unlink(missing_ok=True)


def _is_written(draft: re.Match[str], entry: os.DirEntry[str]) -> bool:
    """Whether somebody may still be writing a draft."""
    if draft["machine"] is None:
        return False
    if draft["machine"] != _machine() or sys.platform == "win32":  # where asking would kill
        return time.time() - entry.stat().st_mtime < DAY
    try:
        os.kill(int(draft["process"], 16), 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        return True
    return True


def remove_files(place: Path, names: re.Pattern[str]) -> None:
    """Remove a folder of which every file has a name of ours; what else lies there stays.

    Parameters
    ----------
    place : pathlib.Path
        A folder, or nothing.
    names : re.Pattern
        Paths of our files within it, with slashes.

    Raises
    ------
    InvalidValue
        There are others.
    """
    if place.is_symlink() or not place.is_dir():
        return
    files = [Path(folder, name) for folder, _, held in os.walk(place) for name in held]
    strange = [file for file in files if not names.fullmatch(file.relative_to(place).as_posix())]
    if strange:
        shown = ", ".join(str(file) for file in sorted(strange)[:3])
        raise InvalidValue(
            f"{place} has to go, and holds what this run did not make ({shown}); move that away",
            code=Mistake.UNWRITABLE,
        )
    for file in files:
        file.unlink(missing_ok=True)
    for folder, _, _ in os.walk(place, topdown=False):
        Path(folder).rmdir()


def make_folder(path: str | os.PathLike[str]) -> Path:
    """A folder, made when missing.

    Raises
    ------
    InvalidValue
        It cannot be made.
    """
    folder = Path(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InvalidValue(
            f"cannot make the folder {folder}: {error.strerror}", code=Mistake.UNWRITABLE
        ) from None
    return folder


def refuse_clashes(
    writes: Sequence[str | os.PathLike[str] | None], reads: Sequence[str | os.PathLike[str]]
) -> None:
    """Refuse to write over what is read, or two things into one file.

    Raises
    ------
    InvalidValue
        A sentence a file.
    """
    taken = {os.path.realpath(path): f"{path} is read" for path in reads}
    problems = []
    for path in writes:
        if path is None or (os.path.exists(path) and not os.path.isfile(path)):
            continue  # two may write to a terminal or a pipe
        place = os.path.realpath(path)
        if place in taken:
            problems.append(
                Problem(
                    "",
                    f"cannot write {path}: {taken[place]}; give another name",
                    code=Mistake.UNWRITABLE,
                    source=str(path),
                )
            )
        taken.setdefault(place, "another file of that name is written")
    if problems:
        raise InvalidValue(*problems)


def need_folders(*paths: str | os.PathLike[str] | None) -> None:
    """Refuse files that cannot be made, before long work is done for them.

    Their folder does not exist or takes no files, or a folder has their name.

    Raises
    ------
    InvalidValue
        As `whole` says it, a sentence a file.
    """
    problems = [
        Problem("", f"cannot write {path}: {why}", code=Mistake.UNWRITABLE, source=str(path))
        for path in paths
        if path is not None and (why := hindrance(path))
    ]
    if problems:
        raise InvalidValue(*problems)


def hindrance(path: str | os.PathLike[str]) -> str:
    """Why a file cannot be made, as far as can be known before; "" where it can."""
    target = Path(os.path.realpath(path))
    if target.is_dir():
        return "it is a folder; give the name of a file"
    if not target.parent.is_dir():
        return _why(FileNotFoundError(), target)
    if os.path.exists(path) and not os.path.isfile(path):
        # a device or a pipe
        if not os.access(path, os.W_OK):
            return "it takes nothing; give the name of a file"
        return _device_hindrance(Path(path))
    draft = _draft(target)
    try:
        draft.touch(exist_ok=False)
        draft.unlink()
    except OSError as error:
        return _why(error, target)
    return ""


def _device_hindrance(device: Path) -> str:
    """Why a device takes nothing; of a pipe nothing is known before."""
    try:
        if not stat.S_ISCHR(device.stat().st_mode):
            return ""
        number = os.open(device, os.O_WRONLY | getattr(os, "O_NOCTTY", 0))
        try:
            os.write(number, b"")  # one that is full refuses this, too
        finally:
            os.close(number)
    except OSError as error:
        return _why(error, device)
    return ""


def hindrance_of_folder(folder: str | os.PathLike[str]) -> str:
    """Why files cannot be written into a folder, which may have to be made; "" where they can."""
    place = Path(os.path.realpath(folder))
    while not place.exists() and place != place.parent:
        place = place.parent
    if not place.is_dir():
        return f"{place} is a file; give the name of a folder"
    return hindrance(_draft(place / "a"))  # a name that nothing there has


def write_text(path: str | os.PathLike[str], text: str, *, tidy: bool = True) -> None:
    """Write a text file in UTF-8, whole or not at all; arguments as of `whole`.

    Raises
    ------
    InvalidValue
        The file cannot be written.
    """
    with whole(path, tidy=tidy) as draft, refused_by_disk(path, draft):
        draft.write_text(text, encoding="utf-8", newline="")


def _why(error: OSError, target: Path) -> str:
    if isinstance(error, (FileNotFoundError, NotADirectoryError)):
        if target.parent.is_dir():
            return f"{target.parent} takes no files; give another folder"
        return f"there is no folder {target.parent}; make it first"
    return (error.strerror or str(error)).lower()


def with_units(
    columns: Mapping[str, Sequence[object]], units: Mapping[str, str]
) -> dict[str, Sequence[object]]:
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


def csv_of(columns: Mapping[str, Sequence[object]]) -> str:
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
