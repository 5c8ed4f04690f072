"""The best size, density or roughness over a range of loads, under limits."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

import numpy as np
from nicegui import ui

from ...equilibrium.columns import COLUMNS, about
from ...errors import InvalidValue
from ...quantities.say import number
from ...study.inputs import field_of, inputs_of
from ..fields import engineering, shown, value_from
from ..figures import GREY, empty, figure, line, plain
from ..state import State, loads_as
from ..text import with_micro
from ..work import Work

__all__ = ["TITLE", "build", "design_figure"]

TITLE = "Design"
LOADS = 16
METRICS = ("particle_load_share", "A_t", "plastic_share", "d", "h", "A_p")
WRITTEN = "as the table [design] says"


def metrics_of(state: State) -> dict[str, str]:
    """What can be made small or large: states, then outputs that the study asks for."""
    out = {name: name for name in METRICS}
    for name in out:
        if name in COLUMNS:
            out[name] = f"{name}: {COLUMNS[name]['meaning']}"
    if state.answer is not None:
        for output in state.answer.contact.outputs:
            for column in output.columns:
                out[column] = f"{column}: {about(column)['meaning']}"
    return out


def variables_of(state: State) -> dict[str, str]:
    """Inputs that may be searched, by their names in the file, with their units."""
    out = {e.name: e.quantity["unit"] for e in inputs_of(state.study) if e.quantity and not e.idle}
    if {"particles.mean", "particles.std"} <= out.keys():
        # a size is searched with its spread in proportion
        out = {"particles.mean+particles.std": out["particles.mean"]} | out
    return out


def design_figure(found: dict[str, Any], variable: str, objective: str) -> dict[str, Any]:
    """Every point tried, the best marked, the tolerance as a band."""
    every = found["points"][variable]
    words = any(isinstance(item, str) for item in every)
    x = np.array([plain(item) for item in every] if words else every, dtype=str if words else float)
    y = np.array([np.nan if v is None else v for v in found["points"][objective]], dtype=float)
    good = np.array(found["points"]["feasible"], dtype=bool)
    order = np.argsort(x)
    best = found["values"][variable]
    traces = [
        line([], y[order], "all points", 0, line={"width": 1.5}) | {"x": x[order].tolist()},
        {
            "type": "scatter",
            "mode": "markers",
            "x": x[~good].tolist(),
            "y": [v if np.isfinite(v) else None for v in y[~good].tolist()],
            "name": "breaks a limit",
            "marker": {"symbol": "x", "size": 8, "color": GREY},
        },
        {
            "type": "scatter",
            "mode": "markers",
            "x": [plain(str(best)) if words else best],
            "y": [found["objectives"][objective]],
            "name": "best",
            "marker": {"symbol": "star", "size": 16, "color": "#D55E00"},
        },
    ]
    made = figure(
        traces,
        x=f"{plain(variable.split('+')[0])} [SI]",
        y=plain(objective),
        title="Search",
        xlog=not words and bool(x.min() > 0),
        height=420,
    )
    if band := found["tolerance"].get(variable):
        made["layout"]["shapes"] = [
            {
                "type": "rect",
                "xref": "x",
                "yref": "paper",
                "x0": band[0],
                "x1": band[1],
                "y0": 0,
                "y1": 1,
                "fillcolor": "#009E73",
                "opacity": 0.18,
                "line": {"width": 0},
            }
        ]
    return made


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """What may change, what is wanted, what must hold; then the search."""
    ui.label(
        "The search runs over the loads of the study. Limits hold at every load; besides, "
        "always: A_t < 0.2, and particles cover less than 0.3."
    ).classes("hint")
    names = _names(state)
    which = ui.select(names, value=names[0], label="what may change").classes("w-full")
    which.props('data-path="design.which"')
    form = ui.column().classes("w-full")
    with form, ui.row().classes("w-full items-end gap-3"):
        low = ui.input("from", value="50 nm").props('data-path="design.low"')
        high = ui.input("to", value="1 µm").props('data-path="design.high"')
        of = ui.select(metrics_of(state), value="particle_load_share", label="what counts")
        aims = {
            "smallest": "as small as possible",
            "largest": "as large as possible",
            "window": "within 0.25 to 0.75",
        }
        aim = ui.select(aims, value="largest", label="aim")
        over = ui.select({"mean": "on average", "worst": "at the worst load"}, value="mean")
    with form, ui.row().classes("w-full items-end gap-3"):
        limit = ui.select({"": "no limit"} | metrics_of(state), value="", label="limit")
        most = ui.input("at most").props('data-path="design.most"')
        least = ui.input("at least").props('data-path="design.least"')
    for each in (which, of, aim, over, limit, low, high, most, least):
        each.props("dense")
    for each in (of, limit):
        each.classes("grow")
    form.set_visibility(names[0] != WRITTEN)

    def ranged() -> None:
        name = str(which.value)
        unit = variables_of(state).get(name)
        form.set_visibility(name != WRITTEN)
        if unit is None or state.answer is None:
            return
        *path, last = name.split("+")[0].split(".")
        try:
            now = float(state.answer.contact.part(field_of(".".join(path), last)))
        except (InvalidValue, TypeError, ValueError):
            return
        low.set_value(shown(engineering(now / 5, unit)))
        high.set_value(shown(engineering(now * 3, unit)))

    which.on_value_change(ranged)

    async def table() -> dict[str, Any]:
        """What the form asks, as the table [design] of a study."""
        ends = {end: value_from(str(w.value or "")) for end, w in (("low", low), ("high", high))}
        wanted = {"of": of.value, "aim": aim.value, "over_loads": over.value}
        asked: dict[str, Any] = {"objective": wanted, "vary": {str(which.value): ends}}
        if limit.value:
            ends = {"most": value_from(most.value or ""), "least": value_from(least.value or "")}
            asked["limits"] = [
                {"of": limit.value} | {k: v for k, v in ends.items() if v is not None}
            ]
        if (answer := state.answer) is not None:
            name = answer.load if answer.load != "d" else "F_star"
            values = answer.loads if name == answer.load else await state.ask(loads_as, name)
            first, last = float(values.min()), float(values.max())
            asked[name] = {"from": first, "to": last, "points": LOADS}
        return asked

    async def ask() -> dict[str, Any]:
        own = {} if which.value == WRITTEN else {"design": await table()}
        return {"study": state.study | own, "folder": str(state.folder)}

    def show(result: dict[str, Any]) -> None:
        objective, variable = next(iter(result["objectives"])), next(iter(result["values"]))
        plot.update_figure(design_figure(result, variable, objective))
        plot.set_visibility(True)
        units = {e.field: e.quantity["unit"] for e in inputs_of(state.study) if e.quantity}

        def told(name: str, value: Any) -> str:
            unit = units.get(name.split("+")[0], "1")
            return str(value) if isinstance(value, str) else str(engineering(value, unit))

        best = [f"{name} = {told(name, value)}" for name, value in result["values"].items()]
        best += [f"{name} = {number(value)}" for name, value in result["objectives"].items()]
        words = [f"Best: {', '.join(best)}."]
        if not result["feasible"]:
            words = [f"Nothing that was tried obeys the limits: {result['reason']}."]
        for name, band in result["tolerance"].items():
            low_, high_ = (told(name, end) for end in band)
            words.append(f"Less than 5 % is lost for {name} between {low_} and {high_}.")
        if result["at_bound"]:
            words.append("It lies at an end of the range: the best may lie beyond.")
        if result["active"]:
            words.append(f"Limits that hold it there: {', '.join(result['active'])}.")
        said.set_text(with_micro(" ".join(words)))

    work = Work("design", "Search", ask, show, key=lambda: state.answer)
    said = ui.label().props('data-fact="design"')
    plot = ui.plotly(empty(420)).classes("w-full")
    plot.props('data-figure="design"')
    plot.set_visibility(False)

    async def draw() -> None:
        await work.tell(state)
        names = _names(state)
        if names != which.options:
            which.set_options(names, value=which.value if which.value in names else names[0])
        for menu, blank in ((of, {}), (limit, {"": "no limit"})):
            options = blank | metrics_of(state)
            if options != menu.options:
                menu.set_options(options, value=menu.value if menu.value in options else None)

    return draw


def _names(state: State) -> list[str]:
    """What may change: an input, or what the study says."""
    return [*([WRITTEN] if state.get("design") else []), *variables_of(state)]
