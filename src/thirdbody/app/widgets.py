"""Widgets that several tabs show: named numbers, tables, what is told of a file."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

from nicegui import ui

from .figures import CONFIG, empty

__all__ = ["Facts", "Plot", "facts", "put", "table", "upload"]


def put(element: Any, props: Mapping[str, Any]) -> Any:
    """Set attributes of an element by their values, and give it back.

    A text written into ``element.props("...")`` is parsed there, so that it could add attributes.
    """
    for name, value in props.items():
        element.props[name] = value
    return element


def facts(pairs: Iterable[tuple[str, str]], kind: str = "") -> None:
    """Named numbers side by side."""
    for name, value in pairs:
        with ui.column().classes("fact gap-0"):
            ui.label(name).classes("hint")
            put(ui.label(value).classes("value"), {"data-fact": f"{kind}{name}"})


class Facts:
    """Named numbers side by side that change in place."""

    def __init__(self, abouts: Mapping[str, str] = MappingProxyType({})) -> None:
        self.abouts = abouts
        self.row = ui.row().classes("facts w-full")
        self.labels: dict[str, Any] = {}

    def show(self, pairs: Iterable[tuple[str, str]]) -> None:
        """These numbers."""
        told = dict(pairs)
        if list(told) != list(self.labels):
            self.row.clear()
            self.labels = {}
            with self.row:
                for name in told:
                    with ui.column().classes("fact gap-0") as both:
                        ui.label(name).classes("hint")
                        label = put(ui.label().classes("value"), {"data-fact": name})
                    self.labels[name] = label
                    if name in self.abouts:
                        put(both, {"title": self.abouts[name]})
        for name, value in told.items():
            self.labels[name].set_text(value)


DRAWS = 10.0
"""Seconds a browser may take to draw a figure."""


class Plot:
    """A figure; once it is drawn, another one in its place goes to the browser by itself."""

    def __init__(self, name: str, height: int = 360) -> None:
        self.widget = put(ui.plotly(empty(height)).classes("w-full"), {"data-figure": name})
        self.made: dict[str, Any] = {}
        self.drawn = False
        self.widget.on("plotly_afterplot", self._drawn, args=[], throttle=1.0)

    def _drawn(self) -> None:
        self.drawn = bool(self.made)  # and not the empty figure of the beginning

    def show(self, made: dict[str, Any]) -> None:
        """This figure, as `figures.figure` gives it."""
        if call := self._taken(made):
            self.widget.run_plot_method(*call)

    async def shown(self, made: dict[str, Any]) -> None:
        """The same, and wait until the browser has drawn it."""
        if call := self._taken(made):
            with contextlib.suppress(TimeoutError):  # the browser is gone
                await self.widget.run_plot_method(*call, timeout=DRAWS)

    def _taken(self, made: dict[str, Any]) -> tuple[Any, ...] | None:
        """What to call in the browser, past the framework, which goes through all elements."""
        if made == self.made:
            return None
        layout = made["layout"]
        marks = {name: layout.get(name, []) for name in ("shapes", "annotations")}
        same = self.made | {"layout": self.made.get("layout", {}) | marks} == made
        self.made = made
        if not self.drawn:
            self.widget.update_figure(made)
            return None
        self.widget.figure = made
        # every number would be watched by the framework otherwise
        dict.__setitem__(self.widget.props, "options", made)
        return ("relayout", marks) if same else ("react", made["data"], layout, CONFIG)


PICK = "e => e.currentTarget.closest('.q-uploader').querySelector('input[type=file]').click()"


def upload(name: str, label: str, **more: Any) -> Any:
    """A place where a file is dropped or chosen, and sent at once."""
    made = put(ui.upload(auto_upload=True, **more).props("flat bordered"), {"data-upload": name})
    with made.add_slot("header"), ui.row().classes("w-full items-center no-wrap q-pa-sm"):
        ui.label(label).classes("grow text-weight-bold")
        button = ui.button(icon="add").on("click", js_handler=PICK)
        put(button.props("flat dense color=white"), {"aria-label": f"{label}: choose a file"})
        # the framework's own button, without a name, has the entry inside
        with ui.element("div").classes("hidden"):
            ui.element("q-uploader-add-trigger")
    return made


def table(name: str, heads: dict[str, str], rows: list[dict[str, Any]], **more: Any) -> None:
    """Rows under heads, by their keys."""
    columns = [
        {"name": key, "label": label, "field": key, "align": "left"} for key, label in heads.items()
    ]
    made = ui.table(columns=columns, rows=rows, **more).classes("w-full")
    # narrow windows have a card for each row
    made.props('dense flat wrap-cells :grid="Quasar.Screen.lt.sm"')
    put(made, {"data-figure": name})
