"""What the contact does besides carrying load: every output of the library, over the load."""

from __future__ import annotations

import textwrap
from collections.abc import Awaitable, Callable
from typing import Any

import numpy as np
from nicegui import ui

from ...equilibrium.columns import about
from ...quantities.say import number, unit_of
from ..figures import AXES, SCALES, figure, line, mark, plain
from ..inputs import Inputs
from ..state import Answer, State
from ..widgets import put
from ..widgets import table as shown_table

__all__ = ["TITLE", "build", "output_figures"]

TITLE = "Outputs"
FEW = 3
"""Columns of a figure that its title names."""


def output_figures(answer: Answer, at: float) -> dict[str, dict[str, Any]]:
    """A figure for each output and unit of its columns."""
    out: dict[str, dict[str, Any]] = {}
    state = answer.curves
    load = answer.load
    scale = SCALES.get(load, 1.0)
    x = answer.loads * scale
    for output in answer.contact.outputs:
        units: dict[str, list[str]] = {}
        for column, told in output.columns.items():
            units.setdefault(told.unit, []).append(column)
        for unit, columns in units.items():
            names = ", ".join(columns) if len(columns) <= FEW else ""
            traces = []
            values = []
            for i, column in enumerate(columns):
                y = np.asarray(state.outputs[column], dtype=float)
                values.append(y)
                traces.append(line(x, y, plain(column), i))
            every = np.concatenate(values)
            every = every[np.isfinite(every) & (every != 0)]
            wide = len(every) > 0 and every.min() > 0 and every.max() > 30 * every.min()
            shape, _ = mark(at * scale, "", dash="solid")
            out[f"{output.name} [{unit}]"] = figure(
                traces,
                x=AXES[load],
                y=_quantity(columns, str(output.title), unit),
                title=plain(f"{output.title}: {names}" if names else str(output.title)),
                xlog=load != "d",
                ylog=bool(wide),
                height=380,
                shapes=[shape],
            )
    return out


def _quantity(columns: list[str], title: str, unit: str) -> str:
    """What an axis shows: the one column on it, the names of a few, or what many are of."""
    few = ", ".join(columns) if len(columns) <= FEW else title
    words = about(columns[0])["meaning"] if len(columns) == 1 else few
    whole = words + (f" [{unit_of(unit)}]" if unit_of(unit) else "")
    return "<br>".join(map(plain, textwrap.wrap(whole, 40)))


def asked(state: State) -> list[str]:
    """Names of the outputs that the study asks for."""
    given = state.get("outputs")
    return list(given) if isinstance(given, dict) else []


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """Switches with their numbers, figures, and the values at the operating load."""

    seen = {"asked": asked(state)}

    def renewed() -> None:
        seen["asked"] = asked(state)
        entries.refresh()

    inputs = Inputs(state, renewed)

    @ui.refreshable
    def entries() -> None:
        inputs.shown.clear()
        with ui.column().classes("w-full gap-1 narrow"):
            inputs.outputs()
            inputs.rest = ui.column().classes("w-full")

    with ui.element("div").classes("figures w-full"):
        with ui.column().classes("w-full"):
            entries()
        table = ui.column().classes("w-full")
    grid = ui.element("div").classes("figures w-full")
    plots: dict[str, Any] = {}

    async def draw() -> None:
        if asked(state) != seen["asked"]:  # undone, or another study
            renewed()
        inputs.tell()
        made, rows = await state.ask(_found, state.at)
        for name in set(plots) - set(made):
            plots.pop(name).delete()
        with grid:
            for name, drawn in made.items():
                if name not in plots:
                    plots[name] = ui.plotly(drawn).classes("w-full")
                    put(plots[name], {"data-figure": f"output {name}"})
                else:
                    plots[name].update_figure(drawn)
        _table(rows, table)

    return draw


def _found(answer: Answer, at: float) -> tuple[dict[str, dict[str, Any]], list[dict[str, Any]]]:
    """The figures, and the rows of the table."""
    rows = [
        {
            "name": name,
            "meaning": about(name)["meaning"],
            "value": number(float(value)),
            "unit": unit_of(about(name)["unit"]),
        }
        for name, value in answer.solve(at).outputs.items()
    ]
    return output_figures(answer, at), rows


def _table(rows: list[dict[str, Any]], place: Any) -> None:
    place.clear()
    with place:
        if not rows:
            ui.label("Switch an output on.").classes("hint")
            return
        ui.label("At the operating load").classes("subhead")
        heads = {key: key for key in ("name", "value", "unit", "meaning")}
        shown_table("outputs", heads, rows, pagination=12)
