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
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextvars import ContextVar
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import TypeVar, TypeVarTuple, cast

from nicegui import ui

from ..errors import InvalidValue, Mistake, ThirdBodyError
from .worker import MEMORY

__all__ = [
    "MOST",
    "SECONDS",
    "TRIES",
    "Died",
    "Solver",
    "ask_for_page",
    "ended_by",
    "ended_message",
    "note_waits",
    "solver",
]

MOST = 3
"""Processes, started as they are needed."""
STARTS = 120.0
"""Seconds that a process may take until it is ready."""
AGAIN = 0.5
"""Seconds after which a call that waits looks whether a process is to be started for it."""
SECONDS = 60.0
"""An answer that takes longer is refused."""


TRIES = 3
"""Processes that may end under one call before it is given up."""


Found = TypeVar("Found")
Args = TypeVarTuple("Args")


Span = tuple[float, float]
"""When something began and when it ended."""
WAITS: ContextVar[deque[Span] | None] = ContextVar("waits", default=None)
"""When the calls of what runs here waited for a process."""


def note_waits(waits: deque[Span]) -> None:
    """Note from now on, in this context, when calls wait for a process."""
    WAITS.set(waits)


def merge_spans(spans: Iterable[Span]) -> list[Span]:
    """Spans of time in order, those that meet as one.

    >>> merge_spans([(3.0, 4.0), (0.0, 2.0), (1.0, 2.5)])
    [(0.0, 2.5), (3.0, 4.0)]
    """
    out: list[Span] = []
    for began, ended in sorted(spans):
        if out and began <= out[-1][1]:
            out[-1] = (out[-1][0], max(ended, out[-1][1]))
        else:
            out.append((began, ended))
    return out


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


def ended_message(how: list[str]) -> str:
    """What is told where processes ended instead of answering.

    >>> ended_message(["killed (SIGKILL)"] * 3)[:64]
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
        self.most, self.seconds, self.warm = most, seconds, warm
        self.starts: deque[Span] = deque(maxlen=10 * most)
        """When processes were started, and when they were ready."""
        self.starting: set[float] = set()
        """When those were started that are not ready yet."""
        self.threads = ThreadPoolExecutor(most, "thirdbody-wait")
        self.idle: queue.LifoQueue[tuple[BaseProcess, Connection] | None] = queue.LifoQueue()
        """Processes that wait for a call; None for one that did not get ready."""
        self.waiting = 0
        """Calls that wait for a process."""
        self.all: dict[BaseProcess, float] = {}
        """Processes that live, as far as is known, and when each was started."""
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
        waits = WAITS.get()
        return await loop.run_in_executor(self.threads, self._ask, call, args, wanted, waits)

    def _ask(
        self,
        call: Callable[[*Args], Found],
        args: tuple[*Args],
        wanted: Callable[[], bool],
        waits: deque[Span] | None,
    ) -> Found:
        if self.closed or not wanted():
            raise asyncio.CancelledError
        ends: list[str] = []
        called_at = time.perf_counter()
        while len(ends) < TRIES:
            began = time.perf_counter()
            process, pipe = self._free()
            if waits is not None:
                waits.append((began, time.perf_counter()))
            with contextlib.suppress(OSError):  # the next call need not wait until this one ends
                self._start_missing(spare=1)
            try:
                pipe.send((call, args))
                answered = pipe.poll(self.seconds)
                problems, answer = pipe.recv() if answered else (None, None)
                break
            except (EOFError, OSError):
                process.join(1.0)  # the pipe may close before the process has ended
                # of those that were there before the call, more than one ended without it
                if not ends or self.all.get(process, called_at) >= called_at:
                    ends.append(ended_by(process.exitcode))
                self._kill(process, pipe)
                if self.closed or not wanted():
                    raise asyncio.CancelledError from None
        else:
            raise Died(f"No answer: {ended_message(ends)}")
        if not answered:
            self._kill(process, pipe)
            raise InvalidValue(
                f"stopped after {self.seconds:g} s: the page has no more time for one answer; ask "
                "for fewer loads, sizes or populations, or use the command line",
                code=Mistake.TOO_LARGE,
            )
        self.idle.put((process, pipe))
        if problems is not None:
            raise InvalidValue(*problems)
        return cast(Found, answer)

    def _free(self) -> tuple[BaseProcess, Connection]:
        """An idle process: one that is there, that is started, or that becomes free meanwhile."""
        with contextlib.suppress(queue.Empty):
            while True:
                idle = self.idle.get_nowait()
                if idle is not None and idle[0].is_alive():
                    return idle
                if idle is not None:
                    self._kill(*idle)
        with self.lock:
            self.waiting += 1
        try:
            while True:
                self._start_missing()
                with contextlib.suppress(queue.Empty):
                    freed = self.idle.get(timeout=AGAIN)
                    break
        finally:
            with self.lock:
                self.waiting -= 1
        if freed is None:
            raise Died(f"No answer: a process that computes was not ready after {STARTS:g} s")
        return freed

    def _start_missing(self, *, spare: int = 0) -> None:
        """Start a process where more calls wait, and are to be expected, than some are for."""
        with self.lock:
            if self.closed:
                raise asyncio.CancelledError
            if self.waiting + spare <= len(self.starting) + (self.idle.qsize() if spare else 0):
                return
            if spare and len(self.all) >= self.most:
                return
            context = multiprocessing.get_context("spawn")
            ours, theirs = context.Pipe()
            process = context.Process(target=_serve, args=(theirs, self.warm), daemon=True)
            began = time.perf_counter()
            with interrupts_blocked():
                process.start()
            self.all[process] = began
            self.starting.add(began)
        theirs.close()
        threading.Thread(target=self._get_ready, args=(process, ours, began), daemon=True).start()

    def _get_ready(self, process: BaseProcess, ours: Connection, began: float) -> None:
        """Give a process to the calls that wait once it is ready."""
        try:
            ready = ours.poll(STARTS) and ours.recv() == READY
        except (EOFError, OSError):
            ready = True  # the call that gets it finds it dead, and counts it
        if not ready:
            self._kill(process, ours)
        with self.lock:
            self.starts.append((began, time.perf_counter()))
        # what is ready is there before it no longer counts as being started
        self.idle.put((process, ours) if ready else None)
        with self.lock:
            self.starting.discard(began)

    def starting_seconds(self, since: float) -> float:
        """Seconds since then in which calls of this context waited while a process was started."""
        now = time.perf_counter()
        with self.lock:
            starts = merge_spans([*self.starts, *((began, now) for began in self.starting)])
        waits = merge_spans(
            (max(began, since), end) for began, end in WAITS.get() or () if end > since
        )
        return sum(max(min(b, d) - max(a, c), 0.0) for a, b in waits for c, d in starts)

    @property
    def preparing(self) -> bool:
        """Whether an answer has to wait until a process has started, as none is ready."""
        return bool(self.starting) and len(self.starting) >= len(self.all)

    def _kill(self, process: BaseProcess, pipe: Connection) -> None:
        pipe.close()
        process.kill()
        process.join()
        with self.lock:
            self.all.pop(process, None)

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


async def ask_for_page(call: Callable[[*Args], Found], *args: *Args) -> Found:
    """`Solver.ask` for the page at hand; nothing comes back to one that was closed."""
    client = ui.context.client
    answer = await solver().ask(call, *args, wanted=lambda: not client._deleted)
    if client._deleted:
        raise asyncio.CancelledError
    return answer
