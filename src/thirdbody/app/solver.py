"""What the page computes, in processes beside it: the server itself only hands out answers.

A study can take minutes, or all the memory. Here it takes one of a few processes, which is killed
when it has had its time, and another visitor is answered meanwhile.
"""

from __future__ import annotations

import asyncio
import contextlib
import multiprocessing
import queue
import threading
import traceback
import warnings
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from nicegui import ui

from ..errors import InvalidValue, ThirdBodyError
from .worker import MEMORY

__all__ = ["MOST", "SECONDS", "Solver", "apart", "solver"]

MOST = 3
"""Processes, started as they are needed."""
SECONDS = 60.0
"""An answer that takes longer is refused."""


def _serve(pipe: Any) -> None:
    """Answer calls until the page is gone."""
    with contextlib.suppress(ImportError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    with contextlib.suppress(ValueError):
        import signal

        # Ctrl-C reaches every process of a terminal; the page ends this one
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    warnings.simplefilter("ignore")
    while True:
        try:
            call, args = pipe.recv()
        except (EOFError, OSError):
            return
        try:
            said: tuple[list[str] | None, Any] = (None, call(*args))
        except ThirdBodyError as error:
            said = (list(getattr(error, "problems", None) or [str(error)]), None)
        except MemoryError:
            said = (["this needs more memory than the page allows"], None)
        except RecursionError:
            said = (["this is nested too deeply"], None)
        except Exception as error:
            traceback.print_exc()
            said = ([f"this failed: {type(error).__name__}"], None)
        try:
            pipe.send(said)
        except OSError:
            return


class Solver:
    """A few processes that answer one call each at a time.

    Parameters
    ----------
    most : int
        Processes.
    seconds : float
        After so long a process is killed, and its call refused.
    """

    def __init__(self, most: int = MOST, seconds: float = SECONDS) -> None:
        self.seconds = seconds
        self.threads = ThreadPoolExecutor(most, "thirdbody-wait")
        self.idle: queue.LifoQueue[tuple[Any, Any]] = queue.LifoQueue()
        self.all: set[Any] = set()
        self.lock = threading.Lock()
        self.closed = False

    async def ask(
        self, call: Callable[..., Any], *args: Any, wanted: Callable[[], bool] = lambda: True
    ) -> Any:
        """What a function of a module gives; both ways only what pickle can carry.

        Raises
        ------
        InvalidValue
            What it says is wrong, or that it took too long.
        CancelledError
            Nobody wants the answer any more.
        """
        loop = asyncio.get_running_loop()
        return await loop.run_in_executor(self.threads, self._ask, call, args, wanted)

    def _ask(self, call: Callable[..., Any], args: Any, wanted: Callable[[], bool]) -> Any:
        if self.closed or not wanted():
            raise asyncio.CancelledError
        process, pipe = self._free()
        try:
            pipe.send((call, args))
            known = pipe.poll(self.seconds)
            problems, found = pipe.recv() if known else (None, None)
        except (EOFError, OSError):
            self._kill(process, pipe)
            if self.closed:
                raise asyncio.CancelledError from None
            raise InvalidValue("this needs more memory than the page allows") from None
        if not known:
            self._kill(process, pipe)
            raise InvalidValue(
                f"stopped after {self.seconds:g} s: the page has no more time for one answer; ask "
                "for fewer loads, sizes or populations, or use the command line"
            )
        self.idle.put((process, pipe))
        if problems is not None:
            raise InvalidValue(*problems)
        return found

    def _free(self) -> tuple[Any, Any]:
        with contextlib.suppress(queue.Empty):
            process, pipe = self.idle.get_nowait()
            if process.is_alive():
                return process, pipe
            self._kill(process, pipe)
        context = multiprocessing.get_context("spawn")
        ours, theirs = context.Pipe()
        process = context.Process(target=_serve, args=(theirs,), daemon=True)
        with self.lock:
            if self.closed:
                raise asyncio.CancelledError
            process.start()
            self.all.add(process)
        theirs.close()
        return process, ours

    def _kill(self, process: Any, pipe: Any) -> None:
        pipe.close()
        process.kill()
        process.join()
        with self.lock:
            self.all.discard(process)

    def close(self) -> None:
        """End every process."""
        with self.lock:
            self.closed = True
            for process in self.all:
                process.kill()
        self.threads.shutdown(wait=False, cancel_futures=True)


_solver: Solver | None = None


def solver() -> Solver:
    """The one of this server."""
    global _solver
    if _solver is None:
        _solver = Solver()
    return _solver


async def apart(call: Callable[..., Any], *args: Any) -> Any:
    """`Solver.ask` for the page at hand; nothing comes back to one that was closed."""
    client = ui.context.client
    found = await solver().ask(call, *args, wanted=lambda: not client._deleted)
    if client._deleted:
        raise asyncio.CancelledError
    return found
