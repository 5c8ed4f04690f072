"""Blocks of a sweep handed to an existing Dask cluster.

The cluster only solves: every block carries its inputs, may be solved any number of times with the
same result, and comes back to this process, which writes it once. So workers need no common file
system, and may die and join.
"""

from __future__ import annotations

import secrets
from collections.abc import Iterable, Iterator
from itertools import islice
from typing import TYPE_CHECKING, Any

from ...errors import InvalidValue, ThirdBodyError
from .plan import Task

if TYPE_CHECKING:
    from distributed import Client

__all__ = ["connected", "on_cluster"]

TIMES = 3
"""How often a block is handed out again after the scheduler has given it up."""


def connected(address: str, *, timeout: float = 10.0) -> Client:
    """A client of the scheduler at an address, e.g. ``tcp://10.0.0.1:8786``.

    Raises
    ------
    InvalidValue
        Dask is not installed, or no scheduler answers.
    """
    try:
        from distributed import Client
    except ImportError:
        raise InvalidValue(
            "a Dask cluster needs the package distributed: pip install 'thirdbody[cluster]'"
        ) from None
    try:
        return Client(address, timeout=timeout, set_as_default=False)
    except (OSError, ValueError) as error:
        why = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise InvalidValue(
            f"no Dask scheduler answers at {address} ({why}); start one with `dask scheduler` and "
            "give the address that it prints"
        ) from None


def _solved(task: Task) -> Any:
    return task()


def on_cluster(
    tasks: Iterable[tuple[int, Task]], client: Client
) -> Iterator[tuple[int, tuple[dict[str, Any], dict[str, Any]]]]:
    """Results of the tasks in the order in which they come.

    No more blocks are under way than the workers can chew, twice, so that neither the scheduler
    nor this process holds more than that.
    """
    from distributed import as_completed
    from distributed.scheduler import KilledWorker

    run = secrets.token_hex(8)
    waiting = iter(tasks)
    flying: dict[str, tuple[int, Task, Any]] = {}
    given_up: dict[int, int] = {}
    results = as_completed(loop=client.loop)

    def hand_out(number: int, task: Task) -> None:
        # a key of its own for every attempt: the cluster remembers the failed ones
        key = f"thirdbody-{run}-{number}-{given_up.get(number, 0)}"
        future = client.submit(_solved, task, key=key, pure=False)
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
                        f"block {number} was given up {TIMES + 1} times, each time after several "
                        "workers had died on it; check their memory, or take a smaller chunk"
                    ) from None
                hand_out(number, task)
                continue
            future.release()
            yield number, result
            fill()
    finally:
        if flying and client.status == "running":
            client.cancel([future for _, _, future in flying.values()])
