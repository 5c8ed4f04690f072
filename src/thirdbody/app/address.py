"""The address of a page: study, operating load and tab, so that the browser keeps the work."""

from __future__ import annotations

import asyncio
from typing import Any

from nicegui import ui

from .state import State
from .text import LONGEST_LINK, to_link
from .widgets import put

__all__ = ["FOLLOW", "TRAVELLED", "Address"]

REST = 0.25
"""Seconds without a change after which the address follows: browsers refuse many in a row."""
TRAVELLED = "travelled"
"""Event of the browser: back or forward was pressed, with the query of the address."""
FOLLOW = """
<script>
(() => {
  let step = "0";
  new MutationObserver(() => {
    const told = document.querySelector("[data-address]").dataset;
    if (told.address && told.address !== location.search)
      history[told.step === step ? "replaceState" : "pushState"](
        null, "", location.pathname + told.address);
    step = told.step;
  }).observe(document.documentElement, { subtree: true, attributeFilter: ["data-address"] });
  addEventListener("popstate", () => emitEvent("travelled", location.search));
})();
</script>
"""
"""What `Address` sets becomes the address; a larger step is an entry of its own in the history."""
TOO_LONG = "The study is too long for an address: reloading loses it, a file of it (Take away) not."


class Address:
    """Says in the page what its address is to be, once the study rests."""

    def __init__(self, state: State) -> None:
        self.state = state
        self.later: asyncio.TimerHandle | None = None
        self.mark = put(ui.element("div").classes("hidden"), {"data-step": "0", "data-address": ""})
        self.told = self._now()
        self.tabs = 0
        """How often the tab was changed."""

    def _now(self) -> tuple[Any, ...]:
        return self.state.study, self.state.wanted, self.state.tab

    def tell(self) -> str:
        """Follow the study; what is to be said about it."""
        if self._now() != self.told:
            if self.later is not None:
                self.later.cancel()
            self.later = asyncio.get_running_loop().call_later(REST, self._write)
        return TOO_LONG if self._too_long() else ""

    def _too_long(self) -> bool:
        return len(to_link(self.state.study)) > LONGEST_LINK

    def travelled(self) -> None:
        """The browser is there already."""
        if self.later is not None:
            self.later.cancel()
        self.told = self._now()

    def _write(self) -> None:
        study, at, tab = self._now()
        self.tabs += tab != self.told[2]
        self.told = study, at, tab
        query = "" if self._too_long() else f"{to_link(study, at)}&"
        step = str(self.state.steps + self.tabs)
        put(self.mark, {"data-step": step, "data-address": f"?{query}tab={tab}"})
