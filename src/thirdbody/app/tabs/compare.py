"""The interface under every asperity law, side by side."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

import numpy as np
from nicegui import ui

from ...equilibrium.words import load_of
from ...quantities.say import number, percent, signed_number, value_of
from ..figures import AXES, SCALES, Figure, figure, line
from ..state import Answer, State, loads_as
from ..widgets import plot_place, set_attributes
from ..widgets import table as shown_table
from ..work import Asked, Work
from ..worker import Laws, compare_laws

__all__ = ["TITLE", "build", "law_figure"]

TITLE = "Laws"
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


def law_figure(laws: Laws, of: str) -> Figure:
    """One curve a law; the study's own is the thickest."""
    label, ylog, scale = SHOWN[of]
    loads = np.array(laws["loads"]) * SCALES.get(laws["load"], 1.0)
    rows = scale * np.array(laws["columns"][of], float)
    traces = [
        line(loads, y, law, row, line={"width": 4 if law == laws["own"] else 1.8})
        for row, (law, y) in enumerate(zip(laws["laws"], rows, strict=True))
    ]
    return figure(
        traces, x=AXES[laws["load"]], y=label, title="Asperity laws", ylog=ylog, height=460
    )


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """One figure, and a table at the load nearest to the operating load."""
    shown: Laws | None = None

    async def ask() -> Asked | None:
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
        return {
            "study": state.study,
            "folder": str(state.folder),
            "load": load,
            "loads": np.geomspace(values[0], values[-1], LOADS).tolist(),
        }

    async def show(result: Laws) -> None:
        nonlocal shown
        shown = result
        await draw()

    def little(request: Asked) -> Asked:
        loads = request["loads"]
        assert isinstance(loads, list)
        return request | {"loads": [*loads[::LITTLE], loads[-1]]}

    work = Work("compare", "Compare all laws", ask, show, key=lambda: state.answer, little=little)
    what = ui.select(
        {name: _without_tags(text[0]) for name, text in SHOWN.items()}, value="A_t_difference"
    )
    what.props('dense options-dense aria-label="what is compared"')
    plot = plot_place("compare", 460)
    table = ui.column().classes("w-full scroll-x")

    async def draw() -> None:
        if shown is None:
            return
        plot.set_visibility(True)
        plot.update_figure(law_figure(shown, str(what.value)))
        _table(await state.ask(_laws_at, state.operating_load), table)

    async def draw_tab() -> None:
        await work.update_preview(state)
        plot.set_visibility(shown is not None or work.trying)
        await draw()

    what.on_value_change(state.announce_change)
    return draw_tab


def _laws_at(answer: Answer, at: float) -> Laws:
    """Every law under the operating load."""
    return compare_laws(answer.contact, "F_star", [float(answer.solve(at).F_star)])


def _without_tags(label: str) -> str:
    return label.replace("<sub>", "_").replace("</sub>", "")


def _table(laws: Laws, place: ui.element) -> None:
    columns, conditions = laws["columns"], laws["conditions"]
    rows = []
    for row, law in enumerate(laws["laws"]):
        one = {name: values[row][0] for name, values in columns.items()}
        difference = one.get("A_t_difference")
        rows.append(
            {
                "law": law,
                "A_t": number(one.get("A_t")),
                "difference": signed_number(difference, 1, "%") if difference else "",
                "pressure": value_of(one.get("mean_pressure"), "Pa"),
                "d": number(one.get("d_star")),
                "plastic": percent(one.get("plastic_share")),
                "note": laws["notes"][row] or "",
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
        said = load_of(conditions["pressure"][0], conditions["F_star"][0])
        set_attributes(
            ui.label(f"At the operating load, {said}").classes("subhead"),
            {"data-fact": "compared at"},
        )
        shown_table("laws", heads, rows)
