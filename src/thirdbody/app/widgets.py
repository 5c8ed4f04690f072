"""Widgets that several tabs show: named numbers, tables, what is told of a file."""

from __future__ import annotations

import contextlib
from collections.abc import Awaitable, Callable, Iterable, Mapping
from types import MappingProxyType
from typing import TypeVar

from nicegui import events, ui
from nicegui.json import dumps

from .figures import CONFIG, Figure, Part, empty

__all__ = [
    "Facts",
    "Plot",
    "facts",
    "plot_place",
    "set_attributes",
    "show_figures",
    "skeleton",
    "table",
    "upload",
]


Made = TypeVar("Made", bound=ui.element)


def set_attributes(element: Made, props: Mapping[str, object]) -> Made:
    """Set attributes of an element by their values, and give it back.

    A text written into ``element.props("...")`` is parsed there, so that it could add attributes.
    """
    for name, value in props.items():
        if name not in element.props or element.props[name] != value:  # else nothing is sent
            element.props[name] = value
    return element


def skeleton() -> ui.element:
    """What stands in the place of a tab until its answer is there: its outline, in grey."""
    with set_attributes(ui.element("div").classes("waiting"), {"aria-hidden": "true"}) as made:
        for style in ("line", "line short", "block", "row"):
            ui.element("div").classes("bone").classes(style)
    return made


def facts(pairs: Iterable[tuple[str, str]], kind: str = "") -> None:
    """Named numbers side by side."""
    for name, value in pairs:
        with ui.column().classes("fact gap-0"):
            ui.label(name).classes("hint")
            set_attributes(ui.label(value).classes("value"), {"data-fact": f"{kind}{name}"})


class Facts:
    """Named numbers side by side that change in place."""

    def __init__(
        self,
        abouts: Mapping[str, str] = MappingProxyType({}),
        said: Iterable[str] = (),
        *,
        kind: str = "",
    ) -> None:
        self.abouts, self.said, self.kind = abouts, tuple(said), kind
        """What names mean, names that a sentence above says to those who see it, and what they are
        of."""
        self.row = ui.row().classes("facts w-full")
        self.labels: dict[str, ui.label] = {}

    def show(self, pairs: Iterable[tuple[str, str]]) -> None:
        """These numbers."""
        values = dict(pairs)
        if list(values) != list(self.labels):
            self.row.clear()
            self.labels = {}
            with self.row:
                for name in values:
                    with ui.column().classes("fact gap-0") as both:
                        ui.label(name).classes("hint")
                        label = ui.label().classes("value")
                        set_attributes(label, {"data-fact": f"{self.kind}{name}"})
                    self.labels[name] = label
                    if name in self.said:
                        both.classes("said")
                    if name in self.abouts:
                        set_attributes(both, {"title": self.abouts[name]})
        for name, value in values.items():
            self.labels[name].set_text(value)


DRAWS = 10.0
"""Seconds a browser may take to draw a figure."""


def plot_place(name: str, height: int = 360) -> ui.plotly:
    """A place for a figure."""
    return set_attributes(ui.plotly(empty(height)).classes("w-full"), {"data-figure": name})


class Plot:
    """A figure; another one in its place goes to the browser past all other elements."""

    def __init__(self, name: str, height: int = 360) -> None:
        self.widget = plot_place(name, height)
        self.made: Figure | None = None
        """What the browser has drawn."""

    async def show(self, made: Figure) -> bool:
        """This figure, as `figures.figure` gives it; whether the browser has drawn it."""
        return await show_figures([(self, made)])

    def change(self, made: Figure) -> list[object]:
        """The function of Plotly that draws this figure, and its arguments: what is new alone."""
        data, layout = made["data"], made["layout"]
        anew: list[object] = ["react", data, layout, CONFIG]
        old = self.made
        if not old or old["layout"].keys() != layout.keys():
            return anew
        if list(map(_without_y, old["data"])) != list(map(_without_y, data)):
            return anew
        before: Mapping[str, object] = {**old["layout"]}
        new = {name: value for name, value in layout.items() if value != before[name]}
        for axis, was, now in (
            ("xaxis", old["layout"]["xaxis"], layout["xaxis"]),
            ("yaxis", old["layout"]["yaxis"], layout["yaxis"]),
        ):
            if was.keys() != now.keys():
                return anew
            new.pop(axis, None)
            new |= {f"{axis}.{k}": v for k, v in now.items() if v != was[k]}
        if data == old["data"]:
            return ["relayout", new]
        return ["update", {"y": [trace.get("y") for trace in data]}, new]


def _without_y(trace: Part) -> Part:
    return {name: value for name, value in trace.items() if name != "y"}


async def show_figures(figures: Iterable[tuple[Plot, Figure]]) -> bool:
    """Figures in their places, in one message; whether the browser has drawn all of them."""
    new = [(plot, made) for plot, made in figures if made != plot.made]
    if not new:
        return True
    calls = [[plot.widget.html_id, *plot.change(made)] for plot, made in new]
    for plot, made in new:
        plot.made = None
        plot.widget.figure = made
        # every number would be watched by the framework otherwise
        dict.__setitem__(plot.widget.props, "options", made)
    code = f"redraw({dumps(calls)})"  # JSON is data there as well
    client, drawn = new[0][0].widget.client, None
    with contextlib.suppress(TimeoutError):  # the browser is gone
        drawn = await client.run_javascript(code, timeout=DRAWS)
    for (plot, made), done in zip(new, drawn or [False] * len(new), strict=True):
        if done is True:
            plot.made = made
        else:
            plot.widget.update()  # not in sight, or not yet: it is drawn when it is
    return all(plot.made is made for plot, made in new)


PICK = "e => e.currentTarget.closest('.q-uploader').querySelector('input[type=file]').click()"


def upload(
    name: str,
    label: str,
    largest: int,
    on_upload: Callable[[events.UploadEventArguments], Awaitable[None]],
    *,
    refused: Callable[[], object] | None = None,
    most: int | None = 1,
) -> ui.upload:
    """A place where a file is dropped or chosen, and sent at once."""
    too_large = refused or (lambda: ui.notify(f"more than {largest} bytes are not taken"))
    made = ui.upload(
        auto_upload=True,
        max_file_size=largest,
        max_files=most,
        on_upload=on_upload,
        on_rejected=too_large,
    )
    set_attributes(made.props("flat bordered"), {"data-upload": name})
    with made.add_slot("header"), ui.row().classes("w-full items-center no-wrap q-pa-sm"):
        ui.label(label).classes("grow text-weight-bold")
        button = ui.button(icon="add").on("click", js_handler=PICK)
        set_attributes(
            button.props("flat dense color=white"), {"aria-label": f"{label}: choose a file"}
        )
        # the framework's own button, without a name, has the entry inside
        with ui.element("div").classes("hidden"):
            ui.element("q-uploader-add-trigger")
    return made


SHORT = 20
"""Characters of what stands in one line of a table."""


def table(name: str, heads: dict[str, str], rows: list[dict[str, str]]) -> None:
    """Rows under heads, by their keys."""
    columns = [
        {"name": key, "label": label, "field": key, "align": "left"} for key, label in heads.items()
    ]
    for column in columns:
        if all(len(str(row[column["name"]])) <= SHORT for row in rows):
            column["style"] = "white-space: nowrap"
    made = ui.table(columns=columns, rows=rows).classes("w-full")
    # narrow windows have a card for each row
    made.props('dense flat wrap-cells :grid="Quasar.Screen.lt.sm"')
    set_attributes(made, {"data-figure": name})
