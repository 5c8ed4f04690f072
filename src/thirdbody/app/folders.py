"""Where uploads lie: one folder a server, gone with it, and one inside for every page."""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
from pathlib import Path
from typing import Any

__all__ = ["Folders", "remove_left"]

PREFIX = "thirdbody-app-"
LOCK = "lock"


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

    def new(self) -> Path:
        """A folder for one page."""
        return Path(tempfile.mkdtemp(dir=self.path))

    def close(self) -> None:
        """Remove everything."""
        shutil.rmtree(self.path, ignore_errors=True)
        if self.lock is not None:
            self.lock.close()


def remove_left() -> list[Path]:
    """Remove the folders of servers that were killed; those removed.

    Only one's own are touched, and of these only such whose lock nobody holds.
    """
    try:
        import fcntl
    except ImportError:
        return []  # without locks nobody knows whether a server is alive
    removed = []
    for found in sorted(Path(tempfile.gettempdir()).glob(f"{PREFIX}*")):
        with contextlib.suppress(OSError):
            if found.is_symlink() or found.lstat().st_uid != os.getuid():
                continue
            with (found / LOCK).open("r+") as lock:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                shutil.rmtree(found)
                removed.append(found)
    return removed
