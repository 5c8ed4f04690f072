"""How far a long run is: a bar on a terminal, a line now and then elsewhere."""

from __future__ import annotations

import math
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, TypeVar

from ..errors import Advice, SlowWarning, tell_of_range

__all__ = [
    "Cost",
    "Stages",
    "advance",
    "aside",
    "count_contacts",
    "count_states",
    "duration",
    "heartbeat",
    "nested_stages",
    "report_solved",
    "reporting",
    "solving",
    "stages",
    "watch_contacts",
    "watch_states",
    "weigh_states",
]

EVERY = 30.0
"""Seconds between two lines where there is no terminal."""

Report = Callable[[int], None]
Result = TypeVar("Result")


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
            bar.update(task, completed=now, rate=f"{_rate(rate)} {what}/s")

        yield report


def _rate(each_second: float) -> str:
    """A rate; below ten with two digits, so that slow is not nothing.

    >>> _rate(1234.5), _rate(0.034)
    ('1,234', '0.034')
    """
    return f"{each_second:,.0f}" if each_second >= 9.5 else f"{each_second:.2g}"


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
            f"{title}: {now:,} of {total:,} {what}, {_rate(rate)} a second, {left:,.0f} s left",
            file=sys.stderr,
            flush=True,
        )

    return report


class Stages:
    """Progress of a work in parts, and within each part over contacts.

    Called with the name of each part as it begins.
    """

    def __init__(self, title: str):
        self.title, self.name, self.begun = title, "", -1
        self.expected, self.said, self.promised = 0, False, 0.0
        self.seen = self.start = self.counted_from = time.monotonic()
        self.uncounted = 0
        """When something was shown last, the work began that takes so long, and from when on
        contacts are counted, but for so many: before the first something may have been compiled."""

    def __call__(self, name: str) -> None:
        self.name, self.begun = name, self.begun + 1
        self.show(0.0, "")

    def show(self, share: float, more: str) -> None:
        """Show what part of the present part is done, where there is something to show it on."""

    def expect(self, contacts: int) -> None:
        """Announce contacts that will need tables; their cost is reported once it is known."""
        self.expected, self.start = contacts, time.monotonic()
        self.counted_from, self.uncounted = self.start, 0

    def report_contacts(self, done: int, total: int) -> None:
        """Report the number of contacts done in the present part, of about so many."""
        if done == 1:
            self.counted_from, self.uncounted = time.monotonic(), 1
        if self.expected and done >= MEASURED:
            seconds = (time.monotonic() - self.counted_from) / (done - self.uncounted)
            every = max(self.expected, done)
            if not self.said or every * seconds > FAR_OFF * self.promised > 0:
                self.said = False
                self.cost((every, seconds, "contacts"))
            self.said = True
        self.report_progress(done, total)

    def report_progress(self, done: int, total: int, what: str = "") -> None:
        """Report the progress of the present part; it is shown from the first second on."""
        if time.monotonic() - self.start > SURE:
            words = f"{done:,} of about {max(done, total):,} {what}".rstrip()
            self.show(min(done / max(total, 1), 1.0), words)

    def cost(self, *items: tuple[int, float, str]) -> None:
        """Report what all items cost, so many of so many seconds each, once, if it is long."""
        whole = sum(count * seconds for count, seconds, _ in items)
        if whole > LONG and not self.said:
            self.said, self.promised = True, whole
            costs = (f"{count:,} {what}, {seconds:.2g} s each" for count, seconds, what in items)
            self.tell(f"about {', and '.join(costs)}: some {duration(whole)}")

    def tell(self, sentence: str) -> None:
        """A first result, or what the work costs, on standard error."""
        print(f"{self.title}: {sentence}", file=sys.stderr, flush=True)


MEASURED, LONG, FAR_OFF = 3, 10.0, 2.0
"""Contacts after which their cost is known, seconds that are worth telling, and times of what was
promised from which on it is promised anew."""


def duration(seconds: float) -> str:
    """A time in words: 40 s, 2.5 minutes, 12 minutes, 2 hours."""
    for size, unit in ((3600, "hours"), (60, "minutes")):
        if seconds >= 1.5 * size:
            halves = round(2 * seconds / size) / 2
            return f"{halves:g} {unit}" if halves < 5 else f"{seconds / size:.0f} {unit}"
    return f"{seconds:.0f} s"


class _Lines(Stages):
    """A line now and then."""

    def show(self, share: float, more: str) -> None:
        if time.monotonic() - self.seen >= EVERY:
            self.seen = time.monotonic()
            self.tell(f"{self.name}, {more}" if more else self.name)


@contextmanager
def stages(title: str, total: int, wanted: bool = True) -> Iterator[Stages]:
    """A function to call at the start of each part of a work, with its name.

    A bar on a terminal, and elsewhere a line every half minute.
    """
    if not wanted:
        made = Stages(title)
        made.tell = lambda sentence: None  # type: ignore[method-assign]
        yield made
        return
    if not _terminal():
        yield _Lines(title)
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(title, total=total)

        class OnBar(Stages):
            def show(self, share: float, more: str) -> None:
                words = f"{self.name}, {more}" if more else self.name
                bar.update(task, completed=self.begun + share, description=f"{title}: {words}")

            def tell(self, sentence: str) -> None:
                bar.console.print(f"{title}: {sentence}", highlight=False, markup=False)

        yield OnBar(title)


# -------------------------------------------------------------------------- contacts of a part
class _Tally:
    """Contacts that have been bound since a part of a work began."""

    def __init__(self, total: int, report: Callable[[int, int], None]):
        self.done, self.total, self.report = 0, total, report

    def add(self) -> None:
        self.done += 1
        self.report(self.done, self.total)


_TALLY: ContextVar[_Tally | None] = ContextVar("tally", default=None)


@contextmanager
def count_contacts(total: int, report: Callable[[int, int], None] | None) -> Iterator[None]:
    """Every contact that is bound inside tells ``report`` how many there are, of about ``total``.

    Parameters
    ----------
    total : int
        Contacts that are expected.
    report : callable or None
        Gets the number so far and the expected one.
    """
    before = _TALLY.set(None if report is None else _Tally(total, report))
    try:
        yield
    finally:
        _TALLY.reset(before)


def advance() -> None:
    """One more contact is bound: what costs time."""
    if (tally := _TALLY.get()) is not None:
        tally.add()


def nested_stages(outer: Callable[[str], None], count: int) -> Stages:
    """Stages of a work that is itself one part of another."""
    inner = Stages("")
    if isinstance(outer, Stages):

        def show(share: float, more: str) -> None:
            inner_name = inner.name if inner.name != outer.name else ""
            words = ", ".join(filter(None, (inner_name, more)))
            outer.show((inner.begun + share) / count, words)

        inner.show = show  # type: ignore[method-assign]
        inner.tell = outer.tell  # type: ignore[method-assign]
    else:
        inner.tell = lambda sentence: None  # type: ignore[method-assign]
    return inner


@contextmanager
def watch_contacts(what: str, total: int, wanted: bool | Report, why: str = "") -> Iterator[None]:
    """Contacts that are bound inside are shown, or a `SlowWarning` says how long they take.

    Nothing where somebody counts them already.

    Parameters
    ----------
    what : str
        Whose they are.
    total : int
        About how many will be bound.
    wanted : bool or callable
        As in `reporting`.
    why : str, optional
        What makes them go one by one.
    """
    if _TALLY.get() is not None:
        yield
        return
    with reporting(what, total, 0, wanted, "contacts") as report:
        # the first is that of the user, and what all others share is made before the second
        cost = Cost(total, report, "" if wanted else f"contacts of {what}", uncounted=2)
        with count_contacts(total, lambda done, expected: cost(1.0, why)):
            yield


@contextmanager
def heartbeat(title: str) -> Iterator[None]:
    """Says that a work still goes on whose parts are not shown, and how many contacts are bound.

    On a terminal a line that stays in its place, after a second; elsewhere one every half minute.

    Parameters
    ----------
    title : str
        What stands in front.
    """
    contacts, start, ended = 0, time.monotonic(), threading.Event()

    def count(done: int, expected: int) -> None:
        nonlocal contacts
        contacts = done

    def words() -> str:
        more = f", contacts so far: {contacts}" if contacts > 1 else ""
        return f"{title}: still at work after {duration(time.monotonic() - start)}{more}"

    beat = _beat_on_terminal if _terminal() else _beat_in_lines
    thread = threading.Thread(target=beat, args=(words, ended), daemon=True)
    thread.start()
    try:
        with count_contacts(0, count):
            yield
    finally:
        ended.set()
        thread.join()


def _beat_in_lines(words: Callable[[], str], ended: threading.Event) -> None:
    while not ended.wait(EVERY):
        print(words(), file=sys.stderr, flush=True)


def _beat_on_terminal(words: Callable[[], str], ended: threading.Event) -> None:
    if ended.wait(SURE):
        return
    from rich.console import Console

    with Console(stderr=True).status(words()) as shown:
        while not ended.wait(SURE):
            shown.update(words())


# -------------------------------------------------------------------------- states
Solving = Callable[[float, str], None]
_SOLVING: ContextVar[Solving | None] = ContextVar("solving", default=None)


@contextmanager
def solving(report: Solving | None) -> Iterator[None]:
    """Context in which solved states are reported: how many more, and why one by one."""
    before = _SOLVING.set(report)
    try:
        yield
    finally:
        _SOLVING.reset(before)


def report_solved(count: float, why: str = "") -> None:
    """Report more solved states; ``why`` says what makes them go one by one."""
    if (report := _SOLVING.get()) is not None:
        report(count, why)


@contextmanager
def weigh_states(share: float) -> Iterator[None]:
    """States solved inside count only so much: their outputs are still to come."""
    outer = _SOLVING.get()
    with solving(None if outer is None else lambda count, why: outer(share * count, why)):
        yield


def count_states(task: Callable[[], Result], report: Solving) -> Result:
    """Carry out a task whose states are told while they are solved, in whatever thread."""
    with solving(report):
        return task()


@contextmanager
def watch_states(
    title: str, total: int, wanted: bool | Report | Stages, what: str = "states", done: int = 0
) -> Iterator[Cost]:
    """States solved inside are shown, or it is said how long they take.

    Parameters
    ----------
    title : str
        What stands in front.
    total, done : int
        States of the whole run, and those of earlier runs.
    wanted : bool, callable or Stages
        As in `reporting`; without it a `SlowWarning` says how long they take. To `Stages` they are
        the present part.
    what : str, optional
        What is counted.
    """
    if isinstance(wanted, Stages):
        parts = wanted
        cost = Cost(
            total,
            lambda now: parts.report_progress(now, total, what),
            what,
            done,
            promise=lambda whole: parts.cost((total, whole / total, what)),
        )
        with solving(cost):
            yield cost
        return
    with reporting(title, total, done, wanted, what) as report:
        cost = Cost(total, report, "" if wanted else what, done)
        with solving(cost):
            yield cost


_ASIDE = [0.0]
"""Seconds of this process that count in no estimate."""


@contextmanager
def aside() -> Iterator[None]:
    """What is done inside, once and for all states to come, counts in no estimate of their time."""
    begin = time.monotonic()
    try:
        yield
    finally:
        _ASIDE[0] += time.monotonic() - begin


class Cost:
    """Counter of solved states that warns once they turn out to take long.

    Parameters
    ----------
    total : int
        States.
    report : callable
        Gets the number so far, at most twice a second, and only once it has grown.
    what : str
        What is solved, for the warning; empty for none.
    done : int
        States of earlier runs.
    early : bool
        Whether states are told before `report_finished`: not where each number must be one that
        lasts, as every time the same.
    promise : callable, optional
        Gets the seconds of all states once they are known to be many, in the place of the warning.
    uncounted : int
        Calls at the beginning from which nothing follows: something may have been compiled before.
    """

    def __init__(
        self,
        total: int,
        report: Report,
        what: str = "",
        done: int = 0,
        early: bool = True,
        promise: Callable[[float], None] | None = None,
        uncounted: int = 1,
    ):
        self.total, self.report, self.what, self.early = total, report, what, early
        self.promise = promise
        self.done, self.reported = float(done), done
        self.start, self.uncounted = 0.0, uncounted
        self.shown, self.first = -math.inf, 0.0

    def __call__(self, count: float, why: str = "") -> None:
        self.done += count
        now = time.monotonic() - _ASIDE[0]
        if self.uncounted > 0:
            self.uncounted -= 1
            self.start, self.first = now, self.done
        elif self.what and now - self.start > SURE:
            whole = (now - self.start) * self.total / max(self.done - self.first, 1e-9)
            if whole > LONG and self.done < self.total:
                if self.promise is None:
                    self._warn(whole, why)
                else:
                    self.promise(whole)
            self.what = ""
        if self.early and now - self.shown > 0.5:
            self.shown = now
            self._report_count(min(int(self.done), self.total))

    def report_finished(self, states: int) -> None:
        """Report the number of states that are solved for good."""
        self._report_count(states)

    def _report_count(self, states: int) -> None:
        """Report a number if it is higher than all before: no state is reported twice."""
        if states > self.reported:
            self.reported = states
            self.report(states)

    def _warn(self, whole: float, why: str) -> None:
        rate = self.total / whole
        reason = f" ({why})" if why else ""
        tell_of_range(
            f"{self.total:,} {self.what} take some {duration(whole)}: {rate:.2g} a second, as they "
            f"are solved one by one{reason}" + Advice("; progress=True shows how far they are", ""),
            SlowWarning,
        )


SURE = 1.0
"""Seconds after which the cost of many states is known."""
