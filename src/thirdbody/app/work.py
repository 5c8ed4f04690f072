"""A button that starts long work, a bar that shows how far it is, a button that stops it."""

from __future__ import annotations

import asyncio
import operator
import time
from collections import deque
from collections.abc import Awaitable, Callable
from typing import Generic, TypeVar, cast

from nicegui import background_tasks, ui

from ..errors import InvalidValue
from .jobs import MOST, RUNNING, Job, Stopped
from .solver import ask_for_page, note_waits, solver
from .state import State, surface_key
from .text import as_shown
from .widgets import set_attributes
from .worker import in_little

__all__ = ["Work", "when_left"]

RESTS = 0.6
"""Seconds that a study rests before what was shown as a preview is done in full."""
SLOW = 8.0
"""Seconds of a preview from which on the rest is left to the button."""
LEFT = 3.0
"""Seconds after which a page that is not seen any more counts as closed."""
MOST_WAITS = 8
"""Calls of a preview of which it is known how long they waited."""
FOLLOWS = "A preview; all of it follows."
STALE = "What is shown belongs to the study as it was before the last changes: do it again."


def when_left(call: Callable[[], None]) -> None:
    """Call when the page at hand is closed, not when its connection breaks for a moment."""
    client = ui.context.client

    async def call_when_gone() -> None:
        await asyncio.sleep(LEFT)
        if not client.has_socket_connection:
            call()

    client.on_disconnect(lambda: background_tasks.create(call_when_gone()))
    client.on_delete(call)


Found = TypeVar("Found")
Asked = dict[str, object]


class Work(Generic[Found]):
    """Widgets around one kind of `Job`.

    Parameters
    ----------
    task : str
        A key of `worker.TASKS`.
    label : str
        Of the button.
    ask : callable
        Gives what the task is to be told, or None where it cannot start.
    show : callable
        Shows the result.
    key : callable, optional
        What a result belongs to: once that is another, the result is marked stale.
    same : callable, optional
        Whether two such are the same.
    little : callable, optional
        What the task is told for a preview, in the place of all.
    """

    def __init__(
        self,
        task: str,
        label: str,
        ask: Callable[[], Asked | Awaitable[Asked | None] | None],
        show: Callable[[Found], Awaitable[None] | None],
        seconds: float = 300.0,
        *,
        key: Callable[[], object] = lambda: None,
        same: Callable[[object, object], bool] = operator.eq,
        little: Callable[[Asked], Asked] | None = None,
    ) -> None:
        self.task, self.ask, self.show, self.seconds = task, ask, show, seconds
        self.key, self.same, self.little = key, same, little
        self.done: tuple[object] | None = None
        """What the result that is shown belongs to; None where none is shown."""
        self.tried: tuple[object] | None = None
        """What the last preview was asked for."""
        self.trying = False
        """Whether a preview is being computed."""
        self.failed: tuple[object] | None = None
        """What the mistakes that are said belong to."""
        self.preview = False
        """Whether it is a preview."""
        self.slow = False
        """Whether previews take long: then nothing more begins of itself."""
        self.following = False
        """Whether all of a preview is being computed."""
        self.job: Job | None = None
        with ui.row().classes("w-full items-center gap-3"):
            self.start = ui.button(label, icon="play_arrow", on_click=self.run)
            set_attributes(self.start.props("no-caps"), {"data-work": task})
            self.bar = ui.linear_progress(value=0.0, show_value=False).classes("grow")
            set_attributes(self.bar, {"aria-label": f"progress of {task}"})
            self.stop = ui.button("Cancel", icon="stop", on_click=self.cancel).props("flat no-caps")
            set_attributes(self.stop, {"data-cancel": task})
        self.said = set_attributes(
            ui.label().classes("problem"), {"role": "alert", "data-said": task}
        )
        self.stale = set_attributes(
            ui.label().classes("stale"), {"role": "status", "data-stale": task}
        )
        self._idle()
        when_left(self.cancel)

    async def update_preview(self, state: State) -> None:
        """Show a preview of the study as it is, then all of it; or say that it does not fit."""
        if self._is_wanted(state) and not self.trying and not self._fits(self.tried):
            self.tried, self.trying = (self.key(),), True
            background_tasks.create(self._try(state))  # the page does not wait for it
        self._fit()

    def _is_wanted(self, state: State) -> bool:
        """Whether another answer begins of itself."""
        if self.little is None or state.problems or surface_key(state.study, state.folder):
            return False
        return self.done is None or not (self.slow or self._fits(self.done))

    async def _try(self, state: State) -> None:
        """One preview; another one where the study moved on before there was one."""
        note_waits(deque(maxlen=MOST_WAITS))  # the page does not wait for these calls
        began, asked_for = time.perf_counter(), self.tried
        try:
            shown = await self._by_itself(self.little)
            self.slow = time.perf_counter() - began - solver().starting_seconds(began) > SLOW
        finally:
            self.trying = False
        if self.said.client._deleted:
            return
        if not self._fits(self.tried):
            with self.said.client:
                await self.update_preview(state)
        elif shown and not self.slow and self.tried is asked_for:
            await self._follow(asked_for)

    async def _follow(self, asked_for: object) -> None:
        """All of what was shown as a preview, once the study rests."""
        await asyncio.sleep(RESTS)
        while self.following:
            await asyncio.sleep(RESTS)
        if self.tried is not asked_for or not self._fits(self.tried) or self.job is not None:
            return
        self.following = True
        try:
            await self._by_itself(None)
        finally:
            self.following = False

    async def again(self, state: State) -> None:
        """Another preview in the place of the one that is shown."""
        self.done = self.tried = None
        await self.update_preview(state)

    def forget(self) -> None:
        """No result is shown any more."""
        self.done, self.preview = None, False
        self._fit()

    def _fits(self, done: tuple[object] | None) -> bool:
        """Whether what is known belongs to the study as it is."""
        return done is not None and self.same(done[0], self.key())

    def fail(self, text: str, key: object = None) -> None:
        """Say what went wrong with the study, or with that of a key, until there is another."""
        self.said.set_text(as_shown(text))
        self.failed = (self.key() if key is None else key,)

    def _fit(self) -> None:
        if self.failed is not None and not self._fits(self.failed):
            self.said.set_text("")
            self.failed = None
        text = ""
        if self.done is not None and not self.same(self.done[0], self.key()):
            text = STALE
        elif self.preview:
            by_hand = f"A preview: “{self.start.text}” does it in full."
            text = by_hand if self.slow else FOLLOWS
        self.stale.set_text(text)
        self.stale.set_visibility(bool(text))

    async def _by_itself(self, little: Callable[[Asked], Asked] | None) -> bool:
        """A preview, or all of it, without a button; whether it is shown."""
        asked_for, client, before = self.tried, self.said.client, self.done
        assert asked_for is not None
        with client:
            try:
                request = self.ask()
                if isinstance(request, Awaitable):
                    request = await request
                if request is None:
                    return False
                result = await ask_for_page(
                    in_little, self.task, little(request) if little else request
                )
            except InvalidValue as error:
                if self.tried is asked_for and self.done is before:
                    self.fail("; ".join(error.problems), asked_for[0])
                return False
            if self.tried is not asked_for or self.done is not before or client._deleted:
                return False  # asked anew or done by the button meanwhile, or nobody looks
            self.preview, self.done, self.failed = little is not None, asked_for, None
            self.said.set_text("")
            await self._show_result(result)
            self._fit()
            return True

    async def _show_result(self, result: object) -> None:
        shown = self.show(cast(Found, result))
        if shown is not None:
            await shown

    def _idle(self) -> None:
        self.bar.set_visibility(False)
        self.stop.set_visibility(False)
        self.start.enable()

    async def run(self) -> None:
        """Start; a second start while it runs does nothing."""
        if self.job is not None:
            return
        self.said.set_text("")
        self.failed = None
        if len(RUNNING) >= MOST:
            self.said.set_text(f"{MOST} long computations run here already; start when one ends")
            return
        self.job = job = Job(self.task, self._report, self.seconds)
        self.bar.set_value(0.02)
        self.bar.set_visibility(True)
        self.stop.set_visibility(True)
        self.start.disable()
        key = self.key()
        try:
            request = self.ask()
            if isinstance(request, Awaitable):
                request = await request
            if request is None:
                return
            key = self.key()
            result = await job.run(**request)
        except Stopped:
            self.said.set_text("cancelled")  # which is true of every study
        except InvalidValue as error:
            self.fail("; ".join(error.problems), key)
        else:
            self.preview, self.done = False, (key,)
            current = self.same(key, self.key())
            self.stale.set_text("" if current else STALE)
            self.stale.set_visibility(not current)
            await self._show_result(result)
        finally:
            self.job = None
            self._idle()

    def _report(self, fraction: float) -> None:
        self.bar.set_value(fraction)

    def cancel(self) -> None:
        """Stop what runs."""
        if self.job is not None:
            self.job.cancel()
