"""Ctrl-C ends the command line with one line and status 130, whatever it is doing."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
from collections.abc import Iterator
from itertools import pairwise
from typing import Any, NoReturn

__all__ = ["INTERRUPTED", "Interrupted", "command_line", "interruptible"]

INTERRUPTED = 130
"""Exit status, 128 + SIGINT as in a shell."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C in a command.

    Not KeyboardInterrupt itself: once that has passed through ``exec`` of a text, as it may while
    numba or a dataclass loads, CPython ends ``python -m`` by the signal, although it was caught.
    """


def command_line() -> bool:
    """Whether this process is ``thirdbody ...`` or ``python -m thirdbody ...``."""
    words = sys.orig_argv[1:]
    script = os.path.splitext(os.path.basename("".join(words[:1])))[0]
    return script == "thirdbody" or ("-m", "thirdbody") in pairwise(words)


@contextlib.contextmanager
def interruptible() -> Iterator[None]:
    """Ctrl-C raises `Interrupted` inside, where there may be files to tidy up; a command only."""
    if signal.getsignal(signal.SIGINT) is not _leave:
        yield
        return
    signal.signal(signal.SIGINT, _raise)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, _leave)


def _leave(*_: Any) -> NoReturn:
    with contextlib.suppress(OSError):
        os.write(2, b"error: interrupted\n")
    os._exit(INTERRUPTED)


def _raise(*_: Any) -> NoReturn:
    raise Interrupted


if command_line() and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    # while the rest loads there is nothing to tidy up yet
    signal.signal(signal.SIGINT, _leave)
