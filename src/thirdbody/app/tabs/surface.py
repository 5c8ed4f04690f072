"""A measured surface: drop an instrument file, see what its asperities owe to the cut-off."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from nicegui import events, ui

from ...errors import InvalidValue
from ...quantities.say import number, value_of
from ...quantities.units import to_si
from ..fields import value_from
from ..figures import empty, figure, line, mark
from ..guard import LARGEST_UPLOAD
from ..state import State
from ..text import with_micro
from ..uploads import keep
from ..widgets import facts, put, upload
from ..work import Work

__all__ = ["TITLE", "build", "options_from"]

TITLE = "Surface"
SECONDS = 60.0
"""A file that takes longer to read is refused."""


def options_from(texts: dict[str, str]) -> dict[str, Any]:
    """What `from_topography` is told, from what was written.

    Raises
    ------
    InvalidValue
        A length that cannot be read.
    """
    out: dict[str, Any] = {}
    problems: list[str] = []
    for name in ("cutoff", "resolution"):
        if texts.get(name):
            try:
                out[name] = to_si(texts[name], "m")
            except InvalidValue as error:
                problems += [f"{name} = {text}" for text in error.problems]
    if texts.get("spacing"):
        try:
            out["spacing"] = [to_si(part, "m") for part in texts["spacing"].split(",")]
        except InvalidValue as error:
            problems += [f"spacing = {text}" for text in error.problems]
    for name in ("detrend", "unit", "channel"):
        if texts.get(name):
            out[name] = texts[name]
    if problems:
        raise InvalidValue(*problems)
    return out


def build(state: State, again: Callable[[], None]) -> Callable[[], None]:
    """An upload, options, pictures, and a button that takes the numbers over."""
    now: dict[str, Any] = {"file": "example"}
    texts: dict[str, Any] = {}
    work: Work
    source: Any
    chooser: Any
    table: Any
    notes: Any
    box: Any
    ui.label(
        "Maps and profiles of instruments (x3p, sur, opd, al3d, npy, txt, ...), up to "
        f"{LARGEST_UPLOAD // 2**20} MB. The file stays on this machine; it is read in a process "
        f"of its own, which is stopped after {value_of(SECONDS, 's')}."
    ).classes("hint")

    async def uploaded(event: events.UploadEventArguments) -> None:
        try:
            name = await keep(state.folder, event)
        except InvalidValue as error:
            work.said.set_text("; ".join(error.problems))
            return
        now["file"] = str(state.folder / name)
        box.set_visibility(False)
        source.set_text(f"file: {name}")
        chooser.reset()
        await work.run()

    with ui.row().classes("w-full items-center gap-4"):
        chooser = upload(
            "surface",
            "Drop a file",
            max_file_size=LARGEST_UPLOAD,
            max_files=1,
            on_upload=uploaded,
            on_rejected=lambda: work.said.set_text(
                f"the file is larger than {LARGEST_UPLOAD // 2**20} MB, or not one file"
            ),
        )
        source = ui.label("file: the example of the library").classes("hint")
    with ui.row().classes("w-full gap-3"):
        for name, hint in (
            ("cutoff", "cut-off, e.g. 2 µm; 0 as sampled"),
            ("spacing", "of a file that tells none"),
            ("unit", "of a file that tells none"),
            ("channel", "of a file with several"),
            ("resolution", "of the instrument"),
        ):
            entry = ui.input(name).props("dense").classes("w-52")
            texts[name] = put(entry, {"hint": hint, "data-path": f"surface.{name}"})
        forms = {"": "tilt", "none": "none", "curvature": "curvature"}
        texts["detrend"] = ui.select(forms, value="", label="form removed")
        texts["detrend"].props("dense").classes("w-36")

    def written() -> dict[str, str]:
        return {name: str(w.value or "") for name, w in texts.items()}

    def ask() -> dict[str, Any] | None:
        try:
            options = options_from(written())
        except InvalidValue as error:
            work.said.set_text("; ".join(error.problems))
            return None
        box.set_visibility(False)
        now["asked"] = written()
        return {"file": now["file"], "options": options}

    def show(result: dict[str, Any]) -> None:
        now["result"] = result
        plots["heights"].update_figure(height_figure(result))
        for name in ("R", "eta", "rms_gradient"):
            plots[name].update_figure(cutoff_figure(result, name))
        used = result["used"]
        words = {
            "σ": value_of(used["sigma"], "m"),
            "R": value_of(used["R"], "m"),
            "η": value_of(used["eta"], "1/m^2"),
            "α": number(used["alpha"]),
            "σ_s": value_of(used["sigma_s"], "m"),
            "cut-off": value_of(used["cutoff"], "m") if used["cutoff"] else "as sampled",
            "skewness": number(result["skewness"]),
            "kurtosis": number(result["kurtosis"]),
        }
        table.clear()
        with table:
            facts(words.items(), "surface ")
        notes.clear()
        with notes:
            for text in result["warnings"]:
                ui.label(with_micro(text)).classes("hint")
        box.set_visibility(True)

    work = Work(
        "surface", "Read it", ask, show, seconds=SECONDS, key=lambda: (now["file"], written())
    )
    for entry in texts.values():
        entry.on_value_change(lambda: work.tell(state))
    box = ui.column().classes("w-full")
    with box:
        table = ui.row().classes("facts w-full")
        notes = ui.column().classes("w-full gap-1")
        with ui.row():
            for label, name in (("Use these numbers", "surface"), ("Use the file", "file")):
                button = ui.button(label, icon="input", on_click=lambda _, n=name: take(n))
                put(button.props("no-caps"), {"data-take": name})
        plots: dict[str, Any] = {}
        with ui.element("div").classes("figures w-full"):
            for name in ("heights", "rms_gradient", "R", "eta"):
                plots[name] = ui.plotly(empty(360)).classes("w-full")
                put(plots[name], {"data-figure": f"surface-{name}"})
    box.set_visibility(False)

    def take(what: str) -> None:
        used = now["result"]["used"]
        if what == "file":
            # as it was read, not as it may be written by now
            asked = {name: value_from(text) for name, text in now["asked"].items()}
            asked.pop("resolution")
            rough = {"topography": Path(now["file"]).name} | {k: v for k, v in asked.items() if v}
        else:
            rough = {key: used[key] for key in ("sigma", "R", "alpha", "eta")}
        state.set("roughness", rough)
        again()
        ui.notify("The roughness of the study is that of this surface now.")

    return lambda: None


def height_figure(found: dict[str, Any]) -> dict[str, Any]:
    """Heights as a map or a line."""
    picture = found["picture"]
    heights = np.array(picture["heights"], dtype=float) * 1e9
    steps = [1e6 * step for step in picture["spacing"]]
    if heights.ndim == 1:
        x = steps[0] * np.arange(len(heights))
        return figure(
            [line(x, heights, "height")], x="x [µm]", y="height [nm]", title="Heights", xlog=False
        )
    rows = [[None if not np.isfinite(v) else round(v, 2) for v in row] for row in heights.T]
    trace = {
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
    "R": ("tip radius R [m]", ("R", "R_counted")),
    "eta": ("asperities per area η [1/m²]", ("eta", "eta_counted")),
    "rms_gradient": ("RMS gradient", ("rms_gradient",)),
}


def cutoff_figure(found: dict[str, Any], name: str) -> dict[str, Any]:
    """One quantity against the cut-off, the cut-off used marked."""
    label, columns = LABELS[name]
    curve = found["curve"]
    x = np.array([np.nan if v is None else v for v in curve["cutoff"]], dtype=float)
    known = x > 0
    traces = []
    for i, column in enumerate(columns):
        y = np.array([np.nan if v is None else v for v in curve[column]], dtype=float)
        words = "counted" if column.endswith("_counted") else "from moments"
        traces.append(
            line(x[known] * 1e6, y[known], words, i, mode="lines+markers", marker={"size": 7})
        )
    made = figure(traces, x="cut-off [µm]", y=label, title=label.split(" [")[0], ylog=True)
    if found["used"]["cutoff"]:
        shape, _ = mark(1e6 * found["used"]["cutoff"], "")
        made["layout"]["shapes"] = [shape]
    return made
