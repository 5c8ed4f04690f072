"""How far a long run is: a bar on a terminal, a line now and then elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

__all__ = ["reporting", "stages"]

EVERY = 30.0
"""Seconds between two lines where there is no terminal."""

Report = Callable[[int], None]


@contextmanager
def reporting(
    title: str, total: int, done: int, wanted: bool | Report, what: str = "states"
) -> Iterator[Report]:
    """A function to call with the number of states solved so far, out of ``total``.

    Parameters
    ----------
    title : str
        What stands in front.
    total, done : int
        States of the whole run, and those of earlier runs: they count as done, but not for the
        rate.
    wanted : bool or callable
        True shows rate and time left on standard error; a callable gets the number itself.
    what : str, optional
        What is counted, where it is not states.
    """
    if callable(wanted):
        yield wanted
    elif not wanted:
        yield lambda _: None
    elif _terminal():
        with _bar(title, total, done, what) as report:
            yield report
    else:
        yield _lines(title, total, done, what)


def _terminal() -> bool:
    return sys.stderr.isatty()


@contextmanager
def _bar(title: str, total: int, done: int, what: str) -> Iterator[Report]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns: tuple[Any, ...] = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:.1f} %"),
        TextColumn("{task.fields[rate]}"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(title, total=total, completed=done, rate="")
        start = time.monotonic()

        def report(now: int) -> None:
            rate = (now - done) / max(time.monotonic() - start, 1e-9)
            bar.update(task, completed=now, rate=f"{rate:,.0f} {what}/s")

        yield report


def _lines(title: str, total: int, done: int, what: str) -> Report:
    start = said = time.monotonic()
    print(f"{title}: {done:,} of {total:,} {what} ...", file=sys.stderr, flush=True)

    def report(now: int) -> None:
        nonlocal said
        if time.monotonic() - said < EVERY or now == done:
            return
        said = time.monotonic()
        rate = (now - done) / (said - start)
        left = (total - now) / rate
        print(
            f"{title}: {now:,} of {total:,} {what}, {rate:,.0f} a second, {left:,.0f} s left",
            file=sys.stderr,
            flush=True,
        )

    return report


@contextmanager
def stages(title: str, total: int, wanted: bool = True) -> Iterator[Callable[[str], None]]:
    """A function to call with the name of each of so many parts of a work, as it begins.

    A bar on a terminal, and nothing elsewhere: the parts take seconds.
    """
    if not (wanted and _terminal()):
        yield lambda _: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task, begun = bar.add_task(title, total=total), 0

        def report(name: str) -> None:
            nonlocal begun
            bar.update(task, completed=begun, description=f"{title}: {name}")
            begun += 1

        yield report
