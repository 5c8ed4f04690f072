"""Files that are dropped on a page: kept in its own folder, under a harmless name, never run."""

from __future__ import annotations

import asyncio
import re
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import InvalidValue, Mistake
from .guard import LARGEST_UPLOAD

if TYPE_CHECKING:
    from nicegui.events import UploadEventArguments

    from .state import State

__all__ = ["harmless", "keep", "take"]

LARGEST_FOLDER = 4 * LARGEST_UPLOAD
"""Bytes of all files of one page."""


def harmless(name: str) -> str:
    """The last part of a name, of letters, digits, dot, dash and underscore.

    >>> harmless("../../etc/pass wd.x3p")
    'pass_wd.x3p'
    >>> harmless("..")
    'file'
    """
    last = re.split(r"[/\\]", name)[-1]
    kept = re.sub(r"[^A-Za-z0-9._-]", "_", last).lstrip(".-")[-80:]
    return kept or "file"


async def keep(folder: Path, event: UploadEventArguments) -> str:
    """Write an uploaded file into the folder of the page; its name there.

    Raises
    ------
    InvalidValue
        The folder would hold too much.
    """
    name = harmless(event.file.name)
    others = sum(file.stat().st_size for file in folder.iterdir() if file.name != name)
    if others + event.file.size() > LARGEST_FOLDER:
        raise InvalidValue(
            f"the files of this page would have more than {LARGEST_FOLDER // 2**20} MB together; "
            "open the page anew",
            code=Mistake.TOO_LARGE,
        )
    # the shelf may hold what was there before, as the same file
    (folder / name).unlink(missing_ok=True)
    await event.file.save(folder / name)
    (folder / name).chmod(0o600)
    return name


async def take(state: State, event: UploadEventArguments) -> str:
    """Keep an uploaded file for the page and for its address; its name.

    Raises
    ------
    InvalidValue
        As `keep`.
    """
    name = await keep(state.folder, event)
    key = None
    if state.shelf is not None:
        key = await asyncio.to_thread(state.shelf.keep, state.folder / name)
    state.note_file(name, key)
    return name
