"""One small surface pressed point by point: pressures, the particles that carry, and a section."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

import numpy as np
from nicegui import ui
from numpy.typing import ArrayLike

from ...quantities.say import percent, readable_unit, value_of
from ...study.one_surface import POINTS
from ..figures import INKS, Figure, Part, figure, line
from ..state import Answer, State
from ..text import as_shown
from ..widgets import facts, plot_place, set_attributes
from ..work import Asked, Work
from ..worker import Pressing

__all__ = ["TITLE", "build", "force_figure", "pressure_figure", "section_figure"]

TITLE = "Explicit"
SECONDS = 120.0
FEW = 64
"""Points along each side of a preview."""
MOST_CIRCLES = 400
"""Particles that are drawn, those that carry most."""
FEW_CARRY = 12
"""Particles up to which every whole number of them has a tick."""
CORNERS = 24
"""Of a circle."""
NAMES = ("pressure", "section", "forces")


def _circles(x: ArrayLike, y: ArrayLike, size: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Circles of these diameters as one line with breaks."""
    turn = np.append(np.linspace(0, 2 * np.pi, CORNERS + 1), np.nan)
    radius = 0.5 * np.asarray(size, float)[:, None]
    across = np.asarray(x, float)[:, None] + radius * np.cos(turn)
    along = np.asarray(y, float)[:, None] + radius * np.sin(turn)
    return across.ravel(), along.ravel()


def pressure_figure(pressing: Pressing) -> Figure:
    """Pressure on the surface, and the particles that carry in true size."""
    pressed = np.array(pressing["pressure"], float)
    top = max(float(pressed.max()), 1.0)
    shown, unit = readable_unit(top, "Pa")
    pressed *= shown / top
    step = 1e6 * pressing["spacing"]
    rows = [[round(v, 4) if v > 0 else None for v in row] for row in pressed.tolist()]
    traces: list[Part] = [
        {
            "type": "heatmap",
            "z": rows,
            "x0": 0,
            "dx": step,
            "y0": 0,
            "dy": step,
            "zmin": 0,
            "zmax": shown,
            "colorscale": "Cividis",
            "colorbar": {"title": {"text": unit}, "thickness": 12},
            "hovertemplate": f"%{{z:.3g}} {unit}<extra></extra>",
        }
    ]
    carrying = pressing["carrying"]
    if carrying["force"]:
        most = np.argsort(carrying["force"])[::-1][:MOST_CIRCLES]
        x, y, size = (1e6 * np.array(carrying[name])[most] for name in ("x", "y", "diameter"))
        circles = line(*_circles(x, y, size), "particles that carry", 1, line={"dash": "solid"})
        traces.append(circles | {"hoverinfo": "skip"})
    title = "Pressure, and particles in true size"
    made = figure(
        traces, x="x [µm]", y="y [µm]", title=title, xlog=False, height=460, hovermode="closest"
    )
    layout = made["layout"]
    for axis, count in zip((layout["xaxis"], layout["yaxis"]), pressed.shape[::-1], strict=True):
        axis |= {"range": [-0.5 * step, (count - 0.5) * step], "constrain": "domain"}
    layout["yaxis"]["scaleanchor"] = "x"
    return made


def section_figure(pressing: Pressing) -> Figure:
    """Through the particle that carries most: the deformed ground, and the flat above."""
    section = pressing["section"]
    along, before, deformed = (
        1e9 * np.array(column, float)
        for column in (section["along"], section["height"], section["deformed"])
    )
    flat = np.full(len(along), 1e9 * pressing["h"])
    traces = [
        line(along, flat, "the flat", 0, line={"dash": "solid"}),
        line(along, deformed, "deformed", 2, line={"dash": "solid"}),
        line(along, before, "as it was", 2, line={"dash": "dot", "width": 1.4}),
    ]
    if section["size"]:
        size = 1e9 * section["size"]
        x, y = _circles([0.0], [1e9 * section["seat"] + size / 2], [size])
        share = percent(section["share"])
        name = f"size {value_of(section['size'], 'm', 3)}, {share} of their load"
        traces.append(line(x, y, name, 1, fill="toself", line={"dash": "solid"}))
        title = "The particle that carries most"
    else:
        title = "The highest pressure"
    made = figure(traces, x="x from there [nm]", y="height [nm]", title=title, xlog=False)
    made["layout"]["hovermode"] = "closest"
    if section["size"]:
        made["layout"]["yaxis"]["scaleanchor"] = "x"
    return made


def force_figure(pressing: Pressing) -> Figure:
    """How many particles carry how much of the load."""
    trace: Part = {
        "type": "histogram",
        "x": [100 * share for share in pressing["carrying"]["share"]],
        "nbinsx": 30,
        "marker": {"color": INKS[1]},
        "name": "particles that carry",
    }
    title = "Load on single particles"
    made = figure(
        [trace], x="part of the load on one [%]", y="particles", title=title, xlog=False
    )  # fmt: skip
    made["layout"]["showlegend"] = False
    if len(pressing["carrying"]["share"]) <= FEW_CARRY:  # numbers of particles are whole
        made["layout"]["yaxis"]["dtick"] = 1
    return made


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """A button that presses the surface of the study, and what came of it."""
    return Explicit(state).draw


class Explicit:
    """The study on one small surface, at its operating load."""

    def __init__(self, state: State) -> None:
        self.state = state
        self.words = set_attributes(
            ui.label().classes("headline second"), {"data-fact": "explicit headline"}
        )
        self.work = Work(
            "explicit",
            "Press the surface",
            self._ask,
            self._show,
            SECONDS,
            key=self._key,
            little=lambda request: request | {"points": FEW},
        )
        self.box = ui.column().classes("w-full")
        with self.box:
            self.table = ui.row().classes("facts w-full")
            self.plots: dict[str, ui.plotly] = {}
            with ui.element("div").classes("figures w-full"):
                for name in NAMES:
                    self.plots[name] = plot_place(f"explicit {name}")
        ui.label(
            "A small part of the surface of the study, measured or made with its σ, R and α, is "
            "pressed point by point under the operating load, with every particle at its place, "
            "and laid beside the statistical answer."
        ).classes("hint")

    def _key(self) -> object:
        answer = self.state.answer
        return (
            None
            if answer is None
            else (answer.contact, answer.study.explicit, self.state.operating_load)
        )

    async def _ask(self) -> Asked | None:
        await self.state.settle()
        if self.state.answer is None:
            self.work.fail("the study has a mistake; see its entries")
            return None
        load = await self.state.ask(_load, self.state.operating_load)
        request = {"study": self.state.study, "folder": str(self.state.folder), "F_star": load}
        return request | {"points": POINTS}

    def _show(self, pressing: Pressing) -> None:
        self.words.set_text(as_shown(pressing["headline"].replace("`", "")))
        self.table.clear()
        with self.table:
            compared = pressing["compared"].items()
            facts(((name, f"{a}; statistically {b}") for name, (a, b) in compared), "explicit ")
        self.state.note("explicit", pressing["warnings"])
        draws = {"pressure": pressure_figure, "section": section_figure, "forces": force_figure}
        for name, draw in draws.items():
            self.plots[name].update_figure(draw(pressing))
        self.plots["forces"].set_visibility(bool(pressing["carrying"]["force"]))

    async def draw(self) -> None:
        await self.work.update_preview(self.state)
        nothing = self.work.done is None and not self.work.trying
        self.box.set_visibility(not nothing)


def _load(answer: Answer, at: float) -> float:
    return float(answer.solve(at).F_star)
