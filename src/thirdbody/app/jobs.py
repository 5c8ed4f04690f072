"""Long work: in a process of its own, with progress, stopped by a kill."""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import signal
import sys
from collections.abc import Callable
from typing import Any

from ..errors import InvalidValue, Mistake, Problem
from .solver import TRIES, Died, ended_by, ended_message
from .text import without_paths

__all__ = ["MOST", "RUNNING", "Job", "Stopped"]

LONGEST_LINE = 8 * 2**20
"""Bytes of an answer."""
MOST = 4
"""Jobs that may be started while others run."""
RUNNING: set[Job] = set()


class Stopped(Exception):
    """The job was cancelled."""


class Job:
    """One task of `worker`, which can be cancelled.

    Parameters
    ----------
    task : str
        A key of `worker.TASKS`.
    report : callable, optional
        Called with the part that is done, 0 to 1.
    seconds : float
        After so long it is killed.
    """

    def __init__(
        self, task: str, report: Callable[[float], None] | None = None, seconds: float = 300.0
    ) -> None:
        self.task, self.report, self.seconds = task, report, seconds
        self.process: asyncio.subprocess.Process | None = None
        self.stopped = False
        self.ends: list[str] = []
        """How processes ended that were to answer."""

    async def run(self, **arguments: object) -> Any:
        """The result of the task.

        Raises
        ------
        InvalidValue
            What is wrong with the request, or that it took too long.
        Died
            One process after another was ended from outside, or ended itself.
        Stopped
            It was cancelled.
        """
        # nothing of the page's surroundings is of use to a parser of files
        kept = ("PATH", "PYTHONPATH", "HOME", "TMPDIR", "LANG", "SYSTEMROOT", "NUMBA_CACHE_DIR")
        surroundings = {name: os.environ[name] for name in kept if name in os.environ}
        surroundings |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        RUNNING.add(self)
        try:
            self.ends.clear()
            while True:
                try:
                    return await self._run(surroundings, arguments)
                except Died:  # which the next process need not be
                    if len(self.ends) == TRIES:
                        raise
        finally:
            RUNNING.discard(self)

    async def _run(
        self, surroundings: dict[str, str], arguments: dict[str, object]
    ) -> dict[str, object]:
        self.process = await asyncio.create_subprocess_exec(
            sys.executable,
            "-m",
            "thirdbody.app.worker",
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.DEVNULL,
            env=surroundings,
            limit=LONGEST_LINE,
        )
        try:
            if self.stopped:
                raise Stopped
            return await asyncio.wait_for(self._talk({"task": self.task} | arguments), self.seconds)
        except TimeoutError:
            raise InvalidValue(
                f"{self.task}: stopped after {self.seconds:g} s; ask for less",
                code=Mistake.TOO_LARGE,
            ) from None
        finally:
            await self._end()

    async def _talk(self, request: dict[str, object]) -> Any:
        assert self.process is not None
        stdin, stdout = self.process.stdin, self.process.stdout
        assert stdin is not None
        assert stdout is not None
        with contextlib.suppress(ConnectionError):
            stdin.write(json.dumps(request).encode())
            await stdin.drain()
            stdin.close()
        try:
            while line := await stdout.readline():
                said = json.loads(line)
                if "done" in said and self.report is not None:
                    self.report(float(said["done"]))
                elif "problems" in said:
                    wrong = (Problem(**parts) for parts in said["problems"])
                    raise InvalidValue(*(problem.put_in_words(without_paths) for problem in wrong))
                elif "result" in said:
                    result = said["result"]
                    for name in {"warnings", "notes"} & result.keys():
                        result[name] = [without_paths(str(text)) for text in result[name]]
                    return result
        except ValueError as error:
            if isinstance(error, InvalidValue):
                raise
            raise InvalidValue(
                f"{self.task}: the answer cannot be read", code=Mistake.UNREADABLE
            ) from None
        if self.stopped:
            raise Stopped
        code = await self.process.wait()
        if code == -getattr(signal, "SIGXCPU", 0):
            raise InvalidValue(
                f"{self.task}: it needed more time than the page allows", code=Mistake.TOO_LARGE
            )
        self.ends.append(ended_by(code))
        raise Died(f"{self.task}: no answer: {ended_message(self.ends)}")

    def cancel(self) -> None:
        """Stop at once."""
        self.stopped = True
        if self.process is not None and self.process.returncode is None:
            with contextlib.suppress(ProcessLookupError):
                self.process.kill()

    async def _end(self) -> None:
        if self.process is not None and self.process.returncode is None:
            with contextlib.suppress(ProcessLookupError):
                self.process.kill()
        if self.process is not None:
            await self.process.wait()
