"""What the page computes, in processes beside it: the server itself only hands out answers.

A study can take minutes, or all the memory. Here it takes one of a few processes, which is killed
when it has had its time, and another visitor is answered meanwhile.
"""

from __future__ import annotations

import asyncio
import contextlib
import multiprocessing
import queue
import signal
import threading
import time
import traceback
import warnings
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import TypeVar, TypeVarTuple, cast

from nicegui import ui

from ..errors import InvalidValue, ThirdBodyError
from .worker import MEMORY

__all__ = ["MOST", "SECONDS", "TRIES", "Died", "Solver", "apart", "ended", "ended_by", "solver"]

MOST = 3
"""Processes, started as they are needed."""
STARTS = 120.0
"""Seconds that a process may take until it is ready."""
SECONDS = 60.0
"""An answer that takes longer is refused."""


TRIES = 3
"""Processes that may end under one call before it is given up."""


Found = TypeVar("Found")
Args = TypeVarTuple("Args")


class Died(InvalidValue):
    """Every process that was to answer a call was ended under it: the study is not at fault."""


def ended_by(code: int | None) -> str:
    """How a process ended, by its exit status, in words.

    >>> ended_by(-9), ended_by(1), ended_by(None)
    ('killed (SIGKILL)', 'ended with status 1', 'ended')
    """
    if code is None or code >= 0:
        return "ended" + ("" if code is None else f" with status {code}")
    with contextlib.suppress(ValueError):
        name = signal.Signals(-code).name
        return f"killed ({name})" if name in ("SIGKILL", "SIGTERM") else f"ended by {name}"
    return f"ended by signal {-code}"


def ended(how: list[str]) -> str:
    """What is told where processes ended instead of answering.

    >>> ended(["killed (SIGKILL)"] * 3)[:64]
    'the process that computes was killed (SIGKILL), 3 times in a row'
    """
    return (
        f"the process that computes was {', then '.join(dict.fromkeys(how))}, {len(how)} times in "
        "a row. That says nothing of the study: somebody ends processes, or the system does where "
        "its memory runs out. Try again, or ask for less"
    )


@contextlib.contextmanager
def interrupts_blocked() -> Iterator[None]:
    """Where processes are started that Ctrl-C must not reach, from their first instruction on.

    It goes to every process of a terminal; the page ends these.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    # where it does not run yet, the start of a process starts it, and unblocks the interrupt after
    resource_tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _serve(pipe: Connection, warm: Callable[[], None] | None) -> None:
    """Get ready, then answer calls until the page is gone."""
    with contextlib.suppress(ImportError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # for good, and where no signal can be blocked
    warnings.simplefilter("ignore")
    with contextlib.suppress(Exception):  # what is wrong is told to who asks
        if warm is not None:
            warm()
    with contextlib.suppress(OSError):
        pipe.send(READY)
    while True:
        try:
            call, args = pipe.recv()
        except (EOFError, OSError):
            return
        try:
            said: tuple[list[str] | None, object] = (None, call(*args))
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


READY = "ready"
"""What a process says once it has loaded and compiled what it needs."""


class Solver:
    """A few processes that answer one call each at a time.

    Parameters
    ----------
    most : int
        Processes.
    seconds : float
        After so long a process is killed, and its call refused.
    warm : callable, optional
        A function of a module that each process calls before its first answer.
    """

    def __init__(
        self,
        most: int = MOST,
        seconds: float = SECONDS,
        warm: Callable[[], None] | None = None,
    ) -> None:
        self.seconds, self.warm = seconds, warm
        self.starts: deque[tuple[float, float]] = deque(maxlen=10 * most)
        """When processes were started, and when they were ready."""
        self.starting: set[float] = set()
        """When those were started that are not ready yet."""
        self.threads = ThreadPoolExecutor(most, "thirdbody-wait")
        self.idle: queue.LifoQueue[tuple[BaseProcess, Connection]] = queue.LifoQueue()
        self.all: set[BaseProcess] = set()
        self.lock = threading.Lock()
        self.closed = False

    async def ask(
        self,
        call: Callable[[*Args], Found],
        *args: *Args,
        wanted: Callable[[], bool] = lambda: True,
    ) -> Found:
        """What a function of a module gives; both ways only what pickle can carry.

        Raises
        ------
        InvalidValue
            What it says is wrong, or that it took too long.
        Died
            One process after another was ended from outside, or ended itself.
        CancelledError
            Nobody wants the answer any more.
        """
        loop = asyncio.get_running_loop()
        return await loop.run_in_executor(self.threads, self._ask, call, args, wanted)

    def _ask(
        self,
        call: Callable[[*Args], Found],
        args: tuple[*Args],
        wanted: Callable[[], bool],
    ) -> Found:
        if self.closed or not wanted():
            raise asyncio.CancelledError
        ends: list[str] = []
        while len(ends) < TRIES:
            process, pipe = self._free()
            try:
                pipe.send((call, args))
                known = pipe.poll(self.seconds)
                problems, found = pipe.recv() if known else (None, None)
                break
            except (EOFError, OSError):
                process.join(1.0)  # the pipe may close before the process has ended
                ends.append(ended_by(process.exitcode))
                self._kill(process, pipe)
                if self.closed or not wanted():
                    raise asyncio.CancelledError from None
        else:
            raise Died(f"No answer: {ended(ends)}")
        if not known:
            self._kill(process, pipe)
            raise InvalidValue(
                f"stopped after {self.seconds:g} s: the page has no more time for one answer; ask "
                "for fewer loads, sizes or populations, or use the command line"
            )
        self.idle.put((process, pipe))
        if problems is not None:
            raise InvalidValue(*problems)
        return cast(Found, found)

    def _free(self) -> tuple[BaseProcess, Connection]:
        with contextlib.suppress(queue.Empty):
            process, pipe = self.idle.get_nowait()
            if process.is_alive():
                return process, pipe
            self._kill(process, pipe)
        context = multiprocessing.get_context("spawn")
        ours, theirs = context.Pipe()
        process = context.Process(target=_serve, args=(theirs, self.warm), daemon=True)
        began = time.perf_counter()
        with self.lock:
            if self.closed:
                raise asyncio.CancelledError
            with interrupts_blocked():
                process.start()
            self.all.add(process)
            self.starting.add(began)
        theirs.close()
        try:
            ready = ours.poll(STARTS) and ours.recv() == READY
        except (EOFError, OSError):
            ready = True  # the call that it is for finds it dead, and counts it
        finally:
            with self.lock:
                self.starting.discard(began)
                self.starts.append((began, time.perf_counter()))
        if not ready:
            self._kill(process, ours)
            raise Died(f"No answer: a process that computes was not ready after {STARTS:g} s")
        return process, ours

    def prepared(self, since: float) -> float:
        """Seconds since then in which a process was being started."""
        now = time.perf_counter()
        with self.lock:
            every = [*self.starts, *((began, now) for began in self.starting)]
        total, reached = 0.0, since
        for began, ready in sorted(every):
            total += max(ready - max(began, reached), 0.0)
            reached = max(reached, ready)
        return total

    @property
    def preparing(self) -> bool:
        """Whether a process is being started, so that an answer may wait for it."""
        return bool(self.starting)

    def _kill(self, process: BaseProcess, pipe: Connection) -> None:
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


def solver(warm: Callable[[], None] | None = None) -> Solver:
    """The one of this server; who asks for it first says what its processes begin with."""
    global _solver
    if _solver is None:
        _solver = Solver(warm=warm)
    return _solver


async def apart(call: Callable[[*Args], Found], *args: *Args) -> Found:
    """`Solver.ask` for the page at hand; nothing comes back to one that was closed."""
    client = ui.context.client
    found = await solver().ask(call, *args, wanted=lambda: not client._deleted)
    if client._deleted:
        raise asyncio.CancelledError
    return found
