"""The address of a page: study, operating load and tab, so that the browser keeps the work."""

from __future__ import annotations

import asyncio
import json
import re
from collections.abc import Mapping
from typing import Any
from urllib.parse import quote

from nicegui import ui

from ..errors import InvalidValue
from .state import State
from .text import LONGEST_LINK, from_link, to_link
from .uploads import harmless
from .widgets import set_attributes

__all__ = [
    "FOLLOW",
    "TRAVELLED",
    "Address",
    "beside_in",
    "beside_query",
    "files_in",
    "query_of",
    "surface_in",
]

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


MOST_FILES = 20
READ_AS = ("file", "cutoff", "spacing", "unit", "channel", "resolution", "detrend")
"""What an address may tell of the file on the tab Surface."""


def query_of(state: State, at: float | None) -> str:
    """The query string that reopens the study at an operating load, and its files here."""
    query = to_link(state.study, at)
    if named := state.file_keys():
        query += "&files=" + ",".join(f"{name}:{key}" for name, key in named.items())
    if state.surface:
        query += "&surface=" + quote(json.dumps(state.surface, ensure_ascii=False))
    return query


def beside_query(state: State, room: int) -> str:
    """What an address of so much room tells of the studies that lie beside this one.

    They are the one as it was opened, where that is another, the one that was kept, and which of
    them, or of the examples, the tab lays beside.
    """
    studies = {"opened": state.opened if state.opened != state.study else None, "kept": state.kept}
    codes = {name: _code(study) for name, study in studies.items() if study is not None}
    if state.beside:
        codes["beside"] = quote(state.beside)
    out = "".join(f"&{name}={text}" for name, text in codes.items())
    return out if len(out) <= room else ""


def _code(study: dict[str, object]) -> str:
    return to_link(study).removeprefix("study=")


def beside_in(
    query: Mapping[str, str],
) -> tuple[dict[str, object] | None, dict[str, object] | None, str]:
    """The study as it was opened and the one that was kept, and the name of what lies beside.

    What an address does not tell, or not well, is None, or empty.

    >>> beside_in({"kept": "x", "beside": "as it was kept"})
    (None, None, 'as it was kept')
    """
    opened, kept = (_study_in(query.get(name, "")) for name in ("opened", "kept"))
    return opened, kept, query.get("beside", "")


def _study_in(code: str) -> dict[str, object] | None:
    try:
        return from_link(code) if code else None
    except InvalidValue:
        return None


def files_in(query: Mapping[str, str]) -> dict[str, str]:
    """Names of files and their keys, as an address tells them.

    >>> files_in({"files": "part.x3p:12ab,../part.x3p:12ab,other"})
    {'part.x3p': '12ab'}
    """
    pairs = [text.partition(":") for text in query.get("files", "").split(",", MOST_FILES)]
    first_pairs = pairs[:MOST_FILES]
    return {
        a: b for a, _, b in first_pairs if harmless(a) == a and re.fullmatch("[0-9a-f]{1,64}", b)
    }


def surface_in(query: Mapping[str, str]) -> dict[str, str]:
    """The file of the tab Surface, and how it is read, as an address tells them.

    >>> surface_in({"surface": '{"file": "part.x3p", "cutoff": "2 um"}'})
    {'file': 'part.x3p', 'cutoff': '2 um'}
    >>> surface_in({"surface": '{"file": "/part.x3p"}'}), surface_in({"surface": "["})
    ({}, {})
    """
    try:
        reading = json.loads(query.get("surface", "")[:2000])
    except (ValueError, RecursionError):
        return {}
    if not isinstance(reading, dict) or not set(reading) <= set(READ_AS):
        return {}
    if not all(isinstance(value, str) for value in reading.values()):
        return {}
    return reading if (name := reading.get("file")) and harmless(name) == name else {}


class Address:
    """Says in the page what its address is to be, once the study rests."""

    def __init__(self, state: State) -> None:
        self.state = state
        self.later: asyncio.TimerHandle | None = None
        self.mark = set_attributes(
            ui.element("div").classes("hidden"), {"data-step": "0", "data-address": ""}
        )
        self.written = self._now()
        self.tabs = 0
        """How often the tab was changed."""

    def _now(self) -> tuple[Any, ...]:
        state = self.state
        of_study = state.study, state.wanted, state.tab, state.file_keys(), dict(state.surface)
        return *of_study, state.opened, state.kept, state.beside

    def follow_study(self) -> str:
        """Follow the study; what is to be said about it."""
        if self._now() != self.written:
            if self.later is not None:
                self.later.cancel()
            self.later = asyncio.get_running_loop().call_later(REST, self._write)
        return TOO_LONG if self._too_long() else ""

    def _too_long(self) -> bool:
        return len(to_link(self.state.study)) > LONGEST_LINK

    def follow_browser(self) -> None:
        """The browser is there already."""
        if self.later is not None:
            self.later.cancel()
        self.written = self._now()

    def _write(self) -> None:
        now = self._now()
        _, at, tab, *_ = now
        self.tabs += tab != self.written[2]
        self.written = now
        query = "" if self._too_long() else query_of(self.state, at)
        if query:
            query += beside_query(self.state, LONGEST_LINK - len(query)) + "&"
        step = str(self.state.steps + self.tabs)
        set_attributes(self.mark, {"data-step": step, "data-address": f"?{query}tab={tab}"})
