"""The interface under every asperity law, side by side."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

import numpy as np
from nicegui import ui

from ...quantities.say import number, percent, signed, value_of
from ..figures import AXES, SCALES, empty, figure, line
from ..state import Answer, State, loads_as
from ..widgets import table as shown_table
from ..work import Work

__all__ = ["TITLE", "build", "law_figure"]

TITLE = "Compare"
LOADS = 40
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
        answer = state.answer
        if answer is None:
            return None
        load = answer.load
        values = answer.loads
        if load == "d":
            load, values = "F_star", await state.ask(loads_as, "F_star")
        values = np.sort(values[np.isfinite(values) & (values > 0)])
        if not len(values):
            work.said.set_text("no load of the study is positive")
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
        found["answer"] = state.answer
        await draw()

    work = Work("compare", "Compare all laws", ask, show)
    stale = ui.label().classes("hint")
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
        changed = found["answer"] is not state.answer
        stale.set_text("The study has changed since: compare again." if changed else "")
        here = await state.ask(_here, state.at, result["load"])
        at = int(np.argmin(np.abs(np.log(np.array(result["loads"]) / here))))
        _table(result, at, table)

    what.on_value_change(lambda: draw())
    return draw


def _here(answer: Answer, at: float, load: str) -> float:
    return float(getattr(answer.solve(at), load))


def _plain(label: str) -> str:
    return label.replace("<sub>", "").replace("</sub>", "")


def _table(found: dict[str, Any], at: int, place: Any) -> None:
    columns = found["columns"]
    rows = []
    for row, law in enumerate(found["laws"]):

        def cell(name: str, row: int = row) -> float | None:
            return columns[name][row][at] if name in columns else None

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
        said = value_of(columns["pressure"][at], "Pa") if "pressure" in columns else ""
        ui.label(f"At {said}" if said else "").classes("hint")
        shown_table("laws", heads, rows)
