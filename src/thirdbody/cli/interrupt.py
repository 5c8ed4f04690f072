"""Ctrl-C ends the command line with one line and status 130, whatever it is doing."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from types import FrameType
from typing import NoReturn

__all__ = [
    "INTERRUPTED",
    "Interrupted",
    "command_line",
    "interruptible",
    "interruption",
    "leave",
    "resumable",
]

INTERRUPTED = 130
"""Exit status, 128 + SIGINT as in a shell."""

SOON = 0.05
"""Seconds after which it is seen whether `Interrupted` was ignored or put off."""

REPEATS = hasattr(signal, "setitimer")  # not on Windows


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
    """Ctrl-C raises `Interrupted` inside, where there may be files to tidy up; a command only.

    Python ignores what is raised while an object is being removed or a library calls back, so it
    is raised again until it is being handled; and not while LLVM's memory is being handed back,
    which would be freed twice.
    """
    if signal.getsignal(signal.SIGINT) is not _leave_at_once:
        yield
        return
    usual = sys.unraisablehook
    sys.unraisablehook = lambda ignored: (
        None if isinstance(ignored.exc_value, Interrupted) else usual(ignored)
    )
    if REPEATS:
        signal.signal(signal.SIGALRM, _raise_again)
    signal.signal(signal.SIGINT, _raise)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, _leave_at_once)
        if REPEATS:
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            signal.signal(signal.SIGALRM, signal.SIG_IGN)
        sys.unraisablehook = usual


@contextlib.contextmanager
def resumable(what: str, keep: Path | None, *, of: str = "histories") -> Iterator[None]:
    """Ctrl-C inside says how much is kept in a file, with which the command goes on."""
    try:
        yield
    except KeyboardInterrupt:
        if keep is None or not keep.is_file():
            raise
        done = keep.read_bytes().count(b"\n") - 1
        raise Interrupted(
            f"{what}: interrupted; {keep} holds {done} {of}, and the same command goes on"
        ) from None


def leave() -> None:
    """End the command line, with nothing removed that was interrupted half-way."""
    if command_line():
        sys.stderr.flush()
        os._exit(INTERRUPTED)


def interruption(error: BaseException | None) -> Interrupted | None:
    """Ctrl-C as the cause of an error; None where it is not."""
    while error is not None and not isinstance(error, Interrupted):
        error = error.__context__
    return error


def _leave_at_once(*_: object) -> NoReturn:
    with contextlib.suppress(OSError):
        os.write(2, b"error: interrupted\n")
    os._exit(INTERRUPTED)


def _raise(_: int, frame: FrameType | None) -> None:
    if REPEATS:
        signal.setitimer(signal.ITIMER_REAL, SOON)
        if _in_llvm(frame):
            return
    raise Interrupted("interrupted")


def _raise_again(signum: int, frame: FrameType | None) -> None:
    if interruption(sys.exc_info()[1]) is None:
        _raise(signum, frame)
    else:
        signal.setitimer(signal.ITIMER_REAL, SOON)


def _in_llvm(frame: FrameType | None) -> bool:
    while frame is not None:
        if frame.f_globals.get("__name__", "").startswith("llvmlite.binding"):
            return True
        frame = frame.f_back
    return False


if command_line() and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    # while the rest loads there is nothing to tidy up yet
    signal.signal(signal.SIGINT, _leave_at_once)
