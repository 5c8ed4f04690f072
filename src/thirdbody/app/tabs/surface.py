"""A measured surface: drop an instrument file, see what its asperities owe to the cut-off."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path
from typing import cast

import numpy as np
from nicegui import background_tasks, events, ui

from ...errors import InvalidValue, Problem
from ...quantities.say import number, value_of
from ...quantities.units import to_si
from ..fields import value_from
from ..figures import Figure, Part, figure, line, mark
from ..guard import LARGEST_UPLOAD
from ..solver import ask_for_page
from ..state import State, missing
from ..text import as_shown
from ..uploads import take
from ..widgets import facts, plot_place, set_attributes, upload
from ..work import Asked, Work
from ..worker import Reading, in_little
from ..worker import Surface as Found

__all__ = ["TITLE", "build", "options_from"]

TITLE = "Surface"
SECONDS = 60.0
"""A file that takes longer to read is refused."""


def options_from(texts: dict[str, str]) -> Reading:
    """What `from_topography` is told, from what was written.

    Raises
    ------
    InvalidValue
        A length that cannot be read.
    """
    out: dict[str, object] = {}
    problems: list[str] = []
    for name in ("cutoff", "resolution"):
        if texts.get(name):
            try:
                out[name] = to_si(texts[name], "m")
            except InvalidValue as error:
                problems += [
                    Problem(name, f"= {problem}", code=problem.code) for problem in error.problems
                ]
    if texts.get("spacing"):
        try:
            out["spacing"] = [to_si(text, "m") for text in texts["spacing"].split(",")]
        except InvalidValue as error:
            problems += [
                Problem("spacing", f"= {problem}", code=problem.code) for problem in error.problems
            ]
    for name in ("detrend", "unit", "channel"):
        if texts.get(name):
            out[name] = texts[name]
    if problems:
        raise InvalidValue(*problems)
    return cast(Reading, out)


ENTRIES = (
    ("cutoff", "cut-off, e.g. 2 µm; 0 as sampled"),
    ("spacing", "of a file that tells none"),
    ("unit", "of a file that tells none"),
    ("channel", "of a file with several"),
    ("resolution", "of the instrument"),
)
FORMS = {"": "tilt", "none": "none", "curvature": "curvature"}
TAKEN = (("Use these numbers", "surface"), ("Use the file", "file"))


def build(state: State, again: Callable[[], None]) -> Callable[[], None]:
    """An upload, options, pictures, and a button that takes the numbers over."""
    return Surface(state, again).draw


class Surface:
    """A measured file, how it is read, and what it says."""

    def __init__(self, state: State, again: Callable[[], None]) -> None:
        self.state, self.again = state, again
        self.file = "example"
        self.read_as: dict[str, str] = {}
        """How the file was read that is shown."""
        self.result: Found | None = None
        self.followed: dict[str, str] = {}
        """What the address told last, or was told."""
        self._chooser()
        self.texts: dict[str, ui.input | ui.select] = {}
        with ui.row().classes("w-full gap-3"):
            self._options()
        self.work = Work(
            "surface", "Read it", self._ask, self._show, seconds=SECONDS, key=self._key
        )
        for entry in self.texts.values():
            entry.on_value_change(lambda: self.work.update_preview(state))
        self.begun = False
        """Whether the example was shown, or something else."""
        self.box = ui.column().classes("w-full")
        with self.box:
            self._results()
        ui.label(
            "Maps and profiles of instruments (x3p, sur, opd, al3d, npy, txt, ...), up to "
            f"{LARGEST_UPLOAD // 2**20} MB. The file stays on this machine; it is read in a "
            f"process of its own, which is stopped after {value_of(SECONDS, 's')}."
        ).classes("hint")

    # ------------------------------------------------------------------ what there is
    def _chooser(self) -> None:
        with ui.row().classes("w-full items-center gap-4"):
            self.chooser = upload(
                "surface",
                "Drop a file",
                LARGEST_UPLOAD,
                self._take_file,
                refused=lambda: self.work.said.set_text(
                    f"the file is larger than {LARGEST_UPLOAD // 2**20} MB, or not one file"
                ),
            )
            self.source = ui.label("file: the example of the library").classes("hint")

    def _options(self) -> None:
        for name, hint in ENTRIES:
            entry = ui.input(name).props("dense").classes("w-52")
            self.texts[name] = set_attributes(entry, {"hint": hint, "data-path": f"surface.{name}"})
        form = ui.select(FORMS, value="", label="form removed")
        self.texts["detrend"] = form.props("dense").classes("w-36")

    def _results(self) -> None:
        self.table = ui.row().classes("facts w-full")
        self.notes = ui.column().classes("w-full gap-1")
        with ui.row():
            for label, name in TAKEN:
                button = ui.button(label, icon="input", on_click=lambda _, n=name: self._take(n))
                set_attributes(button.props("no-caps"), {"data-take": name})
        self.plots: dict[str, ui.plotly] = {}
        with ui.element("div").classes("figures w-full"):
            for name in ("heights", "rms_gradient", "R", "eta"):
                self.plots[name] = plot_place(f"surface-{name}")

    # ------------------------------------------------------------------ what happens
    def _texts_written(self) -> dict[str, str]:
        return {name: str(w.value or "") for name, w in self.texts.items()}

    def _key(self) -> object:
        return self.file, self._texts_written()

    def _reading(self) -> dict[str, str]:
        """The file and how it is read, for the address."""
        return {"file": Path(self.file).name} | {
            k: v for k, v in self._texts_written().items() if v
        }

    def _choose_file(self, name: str) -> None:
        """Another file is the one to read."""
        mine = name != "example"
        self.file = str(self.state.folder / name) if mine else name
        self.source.set_text(f"file: {name if mine else 'the example of the library'}")

    def _hide(self) -> None:
        """Show no result, and none as that of a former file."""
        self.begun = True
        self.box.set_visibility(False)
        self.table.clear()
        self.work.forget()

    def draw(self) -> None:
        """Read again what the address tells, after a reload and on the way back."""
        reading = self.state.surface
        if not reading and not self.begun:
            self.begun = True
            background_tasks.create(self._begin())
        if not reading or reading == self.followed:
            return
        self.followed = reading
        self._choose_file(reading["file"])
        for name, entry in self.texts.items():
            text = reading.get(name, "")
            entry.set_value(text if name != "detrend" or text in FORMS else "")
        self._hide()
        if reading["file"] != "example" and not Path(self.file).is_file():
            self.work.fail(missing(reading["file"]))
            return
        background_tasks.create(self._read())

    async def _begin(self) -> None:
        """The example of the library, until a file is dropped."""
        with self.box, contextlib.suppress(InvalidValue):
            example: dict[str, object] = {"file": "example", "options": {}}
            result = await ask_for_page(in_little, "surface", example)
            if self.result is None and self.file == "example" and not self.box.is_deleted:
                self._show(cast(Found, result))

    async def _read(self) -> None:
        with self.box:
            await self.work.run()

    async def _take_file(self, event: events.UploadEventArguments) -> None:
        try:
            name = await take(self.state, event)
        except InvalidValue as error:
            self.work.said.set_text("; ".join(error.problems))
            return
        self._choose_file(name)
        self._hide()
        self.chooser.reset()
        await self.work.run()

    def _ask(self) -> Asked | None:
        try:
            options = options_from(self._texts_written())
        except InvalidValue as error:
            self.work.said.set_text("; ".join(error.problems))
            return None
        self._hide()
        self.read_as = self._texts_written()
        self.state.surface = self.followed = self._reading()
        self.state.announce_change()
        return {"file": self.file, "options": options}

    def _show(self, result: Found) -> None:
        self.result = result
        self.plots["heights"].update_figure(height_figure(result))
        for name in ("R", "eta", "rms_gradient"):
            self.plots[name].update_figure(cutoff_figure(result, name))
        self.table.clear()
        with self.table:
            facts(surface_numbers(result).items(), "surface ")
        self.notes.clear()
        with self.notes:
            for text in result["warnings"]:
                ui.label(as_shown(text)).classes("hint")
        self.box.set_visibility(True)

    def _take(self, what: str) -> None:
        assert self.result is not None
        used = self.result["used"]
        if what == "file":
            # as it was read, not as it may be written by now
            options = {name: value_from(text) for name, text in self.read_as.items()}
            kept = {k: v for k, v in options.items() if v and k != "resolution"}
            rough: dict[str, object] = {"topography": Path(self.file).name} | kept
        else:
            rough = {k: v for k, v in used.items() if k in ("sigma", "R", "alpha", "eta")}
        self.state.set("roughness", rough)
        self.again()
        ui.notify("The roughness of the study is that of this surface now.")


def surface_numbers(result: Found) -> dict[str, str]:
    """A measured surface in numbers."""
    used = result["used"]
    return {
        "σ": value_of(used["sigma"], "m"),
        "R": value_of(used["R"], "m"),
        "η": value_of(used["eta"], "1/m^2"),
        "α": number(used["alpha"]),
        "σ_s": value_of(used["sigma_s"], "m"),
        "cut-off": value_of(used["cutoff"], "m") if used["cutoff"] else "as sampled",
        "skewness": number(result["skewness"]),
        "kurtosis": number(result["kurtosis"]),
    }


def height_figure(surface: Found) -> Figure:
    """Heights as a map or a line."""
    picture = surface["picture"]
    heights = np.array(picture["heights"], dtype=float) * 1e9
    steps = [1e6 * step for step in picture["spacing"]]
    if heights.ndim == 1:
        x = steps[0] * np.arange(len(heights))
        return figure(
            [line(x, heights, "height")], x="x [µm]", y="height [nm]", title="Heights", xlog=False
        )
    rows = [[None if not np.isfinite(v) else round(v, 2) for v in row] for row in heights.T]
    trace: Part = {
        "type": "heatmap",
        "z": rows,
        "x0": 0,
        "dx": steps[0],
        "y0": 0,
        "dy": steps[1],
        "colorscale": "Cividis",
        "colorbar": {"title": {"text": "nm"}, "thickness": 12},
    }
    made = figure([trace], x="x [µm]", y="y [µm]", title="Heights, form removed", xlog=False)
    made["layout"]["yaxis"]["scaleanchor"] = "x"
    made["layout"]["showlegend"] = False
    made["layout"]["height"] = 360
    return made


LABELS = {
    "R": ("tip radius R [µm]", ("R", "R_counted"), 1e-6),
    "eta": ("asperities per area η [m⁻²]", ("eta", "eta_counted"), 1.0),
    "rms_gradient": ("RMS gradient", ("rms_gradient",), 1.0),
}


def cutoff_figure(surface: Found, name: str) -> Figure:
    """One quantity against the cut-off, the cut-off used marked."""
    label, columns, size = LABELS[name]
    curve = surface["curve"]
    x = np.array(curve["cutoff"], float)
    positive = x > 0
    traces = []
    for i, column in enumerate(columns):
        y = np.array(curve[column], float) / size
        words = "counted" if column.endswith("_counted") else "from moments"
        traces.append(
            line(x[positive] * 1e6, y[positive], words, i, mode="lines+markers", marker={"size": 7})
        )
    made = figure(traces, x="cut-off [µm]", y=label, title=label.split(" [")[0], ylog=True)
    if cutoff := surface["used"]["cutoff"]:
        made["layout"]["shapes"] = [mark(1e6 * cutoff, "")[0]]
    return made
