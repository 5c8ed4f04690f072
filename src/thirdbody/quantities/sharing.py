"""Long work in parts, shared among threads or handed to an existing Dask cluster.

Who shares only solves: every part carries its inputs, may be solved any number of times with the
same result, and comes back to this process, which writes it once. So workers of a cluster need no
common file system, and may die and join.
"""

from __future__ import annotations

import queue
import secrets
import threading
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import ThreadPoolExecutor
from itertools import islice
from typing import TYPE_CHECKING, Any, TypeVar

from ..errors import InvalidValue, Mistake, ThirdBodyError
from ..version import __version__

if TYPE_CHECKING:
    from distributed import Client

__all__ = ["connect_client", "need_version", "share_parts"]

TIMEOUT = 10.0
"""Seconds within which a scheduler has to answer."""
TIMES = 3
"""How often a part is handed out again after the scheduler has given it up."""

Result = TypeVar("Result")
Parts = Iterable[tuple[int, Callable[[], Result]]]
Results = Generator[tuple[int, Result], None, None]


def share_parts(
    parts: Parts[Result],
    *,
    workers: int = 1,
    client: Client | None = None,
    noun: str = "block",
    smaller: str = "a smaller chunk",
) -> Results[Result]:
    """Results of numbered parts, in the order in which they finish.

    Parameters
    ----------
    parts : iterable of (int, callable)
        Taken when there is somebody to solve them.
    workers : int
        Threads that solve parts.
    client : distributed.Client, optional
        A Dask cluster that solves them instead.
    noun, smaller : str
        What a part is called, and what to take where workers die on it.
    """
    if client is not None:
        return _on_cluster(parts, client, noun, smaller)
    return _in_threads(parts, workers) if workers > 1 else _in_line(parts)


def need_version(version: str, what: str) -> None:
    """Refuse work that another version of the library hands out."""
    if version != __version__:
        raise InvalidValue(
            f"this worker runs thirdbody {__version__} and the {what} needs {version}; "
            "install the same version everywhere",
            code=Mistake.OTHER_STUDY,
        )


def connect_client(address: str, *, timeout: float | None = None) -> Client:
    """A client of the scheduler at an address, e.g. ``tcp://10.0.0.1:8786``.

    Raises
    ------
    InvalidValue
        Dask is not installed, or no scheduler answers.
    """
    import asyncio

    try:
        from distributed import Client
        from distributed.comm import resolve_address
    except ImportError:
        raise InvalidValue(
            "a Dask cluster needs the package distributed: pip install 'thirdbody[cluster]'",
            code=Mistake.ABSENT,
        ) from None
    seconds = timeout or TIMEOUT
    try:
        resolve_address(address)  # a client that finds the mistake dies with a traceback
        with ThreadPoolExecutor(1) as pool:  # a notebook has a loop of its own in this thread
            pool.submit(asyncio.run, _greet(address, seconds)).result()
        return Client(address, timeout=seconds, set_as_default=False)
    except Exception as error:  # what answers there may be anything
        why = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise InvalidValue(
            f"no Dask scheduler answers at {address} ({why}); start one with `dask scheduler` and "
            "give the address that it prints",
            code=Mistake.ABSENT,
        ) from None


async def _greet(address: str, seconds: float) -> None:
    """A scheduler says there who it is; a client would wait for that without an end."""
    import asyncio

    from distributed.core import rpc
    from distributed.security import Security

    scheduler = rpc(address, connection_args=Security().get_connection_args("client"))
    try:
        identity = await asyncio.wait_for(scheduler.identity(), seconds)
    except TimeoutError:
        raise TimeoutError(f"no answer within {seconds:g} s") from None
    except MemoryError:  # words of another protocol read as the length of an answer
        raise ValueError("what answers there is no scheduler") from None
    finally:
        await scheduler.close_rpc()
    if identity.get("type") != "Scheduler":
        raise ValueError(f"{identity.get('type')} answers there")


def _in_line(parts: Parts[Result]) -> Results[Result]:
    for number, task in parts:
        yield number, task()


def _in_threads(parts: Parts[Result], workers: int) -> Results[Result]:
    """Parts solved in threads that do not outlive an interrupted run."""
    todo: queue.SimpleQueue[tuple[int, Callable[[], Result]] | None] = queue.SimpleQueue()
    done: queue.SimpleQueue[tuple[int, Result | None, BaseException | None]] = queue.SimpleQueue()

    def serve() -> None:
        while (item := todo.get()) is not None:
            number, task = item
            try:
                done.put((number, task(), None))
            except BaseException as error:
                done.put((number, None, error))

    for _ in range(workers):
        threading.Thread(target=serve, daemon=True).start()
    waiting = iter(parts)
    flying = 0
    try:
        for item in islice(waiting, workers + 1):
            todo.put(item)
            flying += 1
        while flying:
            try:
                # a wait without an end cannot be interrupted everywhere
                number, result, error = done.get(timeout=0.5)
            except queue.Empty:
                continue
            flying -= 1
            if error is not None:
                raise error
            assert result is not None
            for item in islice(waiting, 1):
                todo.put(item)
                flying += 1
            yield number, result
    finally:
        while not todo.empty():
            todo.get()
        for _ in range(workers):
            todo.put(None)


def _solve_task(task: Callable[[], object]) -> Any:
    return task()


def _on_cluster(parts: Parts[Result], client: Client, noun: str, smaller: str) -> Results[Result]:
    """Results in the order in which they come.

    No more parts are under way than the workers can chew, twice, so that neither the scheduler
    nor this process holds more than that.
    """
    from distributed import as_completed
    from distributed.scheduler import KilledWorker

    run = secrets.token_hex(8)
    waiting = iter(parts)
    flying: dict[str, tuple[int, Callable[[], Result], object]] = {}
    given_up: dict[int, int] = {}
    results = as_completed(loop=client.loop)

    def hand_out(number: int, task: Callable[[], Result]) -> None:
        # a key of its own for every attempt: the cluster remembers the failed ones
        key = f"thirdbody-{run}-{number}-{given_up.get(number, 0)}"
        future = client.submit(_solve_task, task, key=key, pure=False)
        flying[key] = number, task, future
        results.add(future)

    def fill() -> None:
        most = max(4, 2 * sum(client.nthreads().values()))
        for number, task in islice(waiting, max(0, most - len(flying))):
            hand_out(number, task)

    try:
        fill()
        for future in results:
            number, task, _ = flying.pop(future.key)
            try:
                if future.cancelled():
                    raise ThirdBodyError(
                        "the scheduler has gone; the same command goes on where this one stopped"
                    )
                result = future.result()
            except KilledWorker:
                given_up[number] = given_up.get(number, 0) + 1
                if given_up[number] > TIMES:
                    raise ThirdBodyError(
                        f"{noun} {number} was given up {TIMES + 1} times, each time after several "
                        f"workers had died on it; check their memory, or take {smaller}"
                    ) from None
                hand_out(number, task)
                continue
            future.release()
            yield number, result
            fill()
    finally:
        if flying and client.status == "running":
            client.cancel([future for _, _, future in flying.values()])
