"""The interface under every asperity law, side by side."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

import numpy as np
from nicegui import ui

from ...equilibrium.words import load_of
from ...quantities.say import number, percent, signed, value_of
from ..figures import AXES, SCALES, empty, figure, line
from ..state import Answer, State, loads_as
from ..widgets import put
from ..widgets import table as shown_table
from ..work import Work
from ..worker import compared

__all__ = ["TITLE", "build", "law_figure"]

TITLE = "Compare"
LOADS = 40
LITTLE = 5
"""A preview has every fifth of them."""
SHOWN = {
    "A_t": ("real contact area A<sub>t</sub>", True, 1.0),
    "A_t_difference": ("difference of A<sub>t</sub> [%]", False, 1.0),
    "d_star": ("separation d/σ", False, 1.0),
    "mean_pressure": ("mean pressure F/A<sub>t</sub> [Pa]", True, 1.0),
    "elastic_share": ("elastic part of the area [%]", False, 100.0),
    "plastic_share": ("plastic part of the area [%]", False, 100.0),
    "particle_load_share": ("particles' load [%]", False, 100.0),
}


def law_figure(found: dict[str, Any], of: str) -> dict[str, Any]:
    """One curve a law; the study's own is the thickest."""
    label, ylog, scale = SHOWN[of]
    traces = []
    loads = np.array(found["loads"]) * SCALES.get(found["load"], 1.0)
    for row, law in enumerate(found["laws"]):
        y = np.array([np.nan if v is None else scale * v for v in found["columns"][of][row]])
        own = law == found["own"]
        traces.append(line(loads, y, law, row, line={"width": 4 if own else 1.8}))
    return figure(
        traces, x=AXES[found["load"]], y=label, title="Asperity laws", ylog=ylog, height=460
    )


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """One figure, and a table at the load nearest to the operating load."""
    found: dict[str, Any] = {}

    async def ask() -> dict[str, Any] | None:
        await state.settle()
        answer = state.answer
        if answer is None:
            return None
        load = answer.load
        values = answer.loads
        if load == "d":
            load, values = "F_star", await state.ask(loads_as, "F_star")
        values = np.sort(values[np.isfinite(values) & (values > 0)])
        if not len(values):
            work.fail("no load of the study is positive")
            return None
        found["load"] = load
        return {
            "study": state.study,
            "folder": str(state.folder),
            "load": load,
            "loads": np.geomspace(values[0], values[-1], LOADS).tolist(),
        }

    async def show(result: dict[str, Any]) -> None:
        found["result"] = result
        await draw()

    def little(asked: dict[str, Any]) -> dict[str, Any]:
        return asked | {"loads": [*asked["loads"][::LITTLE], asked["loads"][-1]]}

    work = Work("compare", "Compare all laws", ask, show, key=lambda: state.answer, little=little)
    what = ui.select(
        {name: _plain(text[0]) for name, text in SHOWN.items()}, value="A_t_difference"
    )
    what.props('dense options-dense aria-label="what is compared"')
    plot = ui.plotly(empty(460)).classes("w-full")
    plot.props('data-figure="compare"')
    table = ui.column().classes("w-full scroll-x")
    plot.set_visibility(False)

    async def draw() -> None:
        if "result" not in found:
            return
        plot.set_visibility(True)
        result = found["result"]
        plot.update_figure(law_figure(result, str(what.value)))
        _table(await state.ask(_here, state.at), table)

    async def tell() -> None:
        await work.tell(state)
        await draw()

    what.on_value_change(state.tell)
    return tell


def _here(answer: Answer, at: float) -> dict[str, Any]:
    """Every law under the operating load."""
    return compared(answer.contact, "F_star", [float(answer.solve(at).F_star)])


def _plain(label: str) -> str:
    return label.replace("<sub>", "_").replace("</sub>", "")


def _table(found: dict[str, Any], place: Any) -> None:
    columns = found["columns"]
    rows = []
    for row, law in enumerate(found["laws"]):

        def cell(name: str, row: int = row) -> float | None:
            return columns[name][row][0] if name in columns else None

        difference = cell("A_t_difference")
        pressure = cell("mean_pressure")
        rows.append(
            {
                "law": law,
                "A_t": number(cell("A_t")),
                "difference": "" if not difference else signed(difference, 1, "%"),
                "pressure": value_of(pressure, "Pa"),
                "d": number(cell("d_star")),
                "plastic": percent(cell("plastic_share")),
                "note": columns.get("note", [""] * len(found["laws"]))[row] or "",
            }
        )
    heads = {
        "law": "law",
        "A_t": "A_t",
        "difference": "difference",
        "pressure": "F/A_t",
        "d": "d/σ",
        "plastic": "plastic",
        "note": "note",
    }
    place.clear()
    with place:
        said = load_of(columns["pressure"][0], columns["F_star"][0])
        put(
            ui.label(f"At the operating load, {said}").classes("subhead"),
            {"data-fact": "compared at"},
        )
        shown_table("laws", heads, rows)
