"""Where uploads lie: one folder a server, gone with it, and one inside for every page."""

from __future__ import annotations

import contextlib
import hmac
import os
import secrets
import shutil
import tempfile
from pathlib import Path
from typing import Any

__all__ = ["Folders", "Shelf", "remove_left"]

PREFIX = "thirdbody-app-"
LOCK = "lock"
LARGEST_SHELF = 400 * 2**20
"""Bytes of all files of a server that addresses can name; the oldest go first."""


class Folders:
    """The folder of one server; its lock says that the server is alive."""

    def __init__(self) -> None:
        self.path = Path(tempfile.mkdtemp(prefix=PREFIX))
        self.lock: Any = None
        with contextlib.suppress(ImportError, OSError):
            import fcntl

            beginning = self.path / f"{LOCK}-begins"
            self.lock = beginning.open("w")
            fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            # under its name nobody meets it open
            beginning.rename(self.path / LOCK)
        self.shelf = Shelf(self.path / "shelf")

    def new(self) -> Path:
        """A folder for one page."""
        return Path(tempfile.mkdtemp(dir=self.path))

    def close(self) -> None:
        """Remove everything."""
        shutil.rmtree(self.path, ignore_errors=True)
        if self.lock is not None:
            self.lock.close()


class Shelf:
    """Files that were given to a server, by keys that nobody can guess or work out.

    An address names its files by their keys, so that a reload finds them though the folder of the
    former page is gone.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.secret = secrets.token_bytes(32)

    def keep(self, file: Path) -> str:
        """Keep what a file holds; its key."""
        key = hmac.new(self.secret, file.read_bytes(), "sha256").hexdigest()
        self.path.mkdir(mode=0o700, exist_ok=True)
        kept = self.path / key
        with contextlib.suppress(FileExistsError):
            _same(file, kept)
        os.utime(kept)
        every = sorted(self.path.iterdir(), key=lambda path: (path != kept, -path.stat().st_mtime))
        room = LARGEST_SHELF
        for path in every:
            room -= path.stat().st_size
            if room < 0 and path != kept:
                path.unlink()
        return key

    def give(self, key: str, file: Path) -> bool:
        """Put what has this key where a page looks for it; whether it is there."""
        if not key.isalnum():
            return False
        with contextlib.suppress(FileNotFoundError):
            there = file.with_name(f"{file.name}.{secrets.token_hex(4)}")
            _same(self.path / key, there)
            there.replace(file)
            return True
        return False


def _same(file: Path, there: Path) -> None:
    """The same file under another name; a copy of it where the system has no such links."""
    try:
        os.link(file, there)
    except (FileExistsError, FileNotFoundError):
        raise
    except OSError:
        shutil.copyfile(file, there)


def remove_left() -> list[Path]:
    """Remove the folders of servers that were killed; those removed.

    Only one's own are touched, and of these only such whose lock nobody holds.
    """
    try:
        import fcntl
    except ImportError:
        return []  # without locks nobody knows whether a server is alive
    removed = []
    for folder in sorted(Path(tempfile.gettempdir()).glob(f"{PREFIX}*")):
        with contextlib.suppress(OSError):
            if folder.is_symlink() or folder.lstat().st_uid != os.getuid():
                continue
            with (folder / LOCK).open("r+") as lock:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                shutil.rmtree(folder)
                removed.append(folder)
    return removed
