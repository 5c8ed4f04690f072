"""Work that follows a change: once for many changes that come together."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable

from nicegui import background_tasks, ui

__all__ = ["Soon"]


class Soon:
    """Calls a function once for many requests that come together, and never twice at a time."""

    def __init__(self, call: Callable[[], Awaitable[None]]) -> None:
        self.call, self.waiting, self.running = call, False, False
        self.client = ui.context.client

    def __call__(self) -> None:
        self.waiting = True
        if not self.running:
            self.running = True
            background_tasks.create(self._run())

    async def _run(self) -> None:
        try:
            while self.waiting and not self.client._deleted:
                await asyncio.sleep(0.005)
                self.waiting = False
                with self.client:
                    await self.call()
        finally:
            self.running = False
