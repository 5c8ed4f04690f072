"""The best size, density or roughness over a range of loads, under limits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from nicegui import ui

from ...equilibrium import COLUMNS, about
from ...errors import InvalidValue
from ...study.inputs import inputs_of
from ..fields import engineering, number_of, value_from
from ..figures import GREY, empty, figure, line
from ..state import State
from ..work import Work

__all__ = ["TITLE", "build", "design_figure"]

TITLE = "Design"
LOADS = 16
METRICS = ("particle_load_share", "A_t", "plastic_share", "d", "h", "A_p")
TOGETHER = {"particles.mean": "particles.diameter.mean+particles.diameter.std"}


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


def variables_of(state: State) -> dict[str, tuple[str, dict[str, Any]]]:
    """Inputs that may be searched, by their name in the file: field and quantity."""
    out: dict[str, tuple[str, dict[str, Any]]] = {}
    for each in inputs_of(state.study):
        if each.quantity and not each.idle:
            out[each.name] = (each.field, each.quantity)
    if state.get("particles", "std") is not None and "particles.mean" in out:
        quantity = out["particles.mean"][1]
        out = {"particles.mean": (TOGETHER["particles.mean"], quantity)} | out
        out["particles.mean"] = (TOGETHER["particles.mean"], quantity)
    return out


def design_figure(found: dict[str, Any], variable: str, objective: str) -> dict[str, Any]:
    """Every point tried, the best marked, the tolerance as a band."""
    x = np.array(found["points"][variable], dtype=float)
    y = np.array([np.nan if v is None else v for v in found["points"][objective]], dtype=float)
    good = np.array(found["points"]["feasible"], dtype=bool)
    order = np.argsort(x)
    traces = [
        line(x[order], y[order], "all points", 0, line={"width": 1.5}),
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
            "x": [found["values"][variable]],
            "y": [found["objectives"][objective]],
            "name": "best",
            "marker": {"symbol": "star", "size": 16, "color": "#D55E00"},
        },
    ]
    made = figure(
        traces,
        x=f"{variable} [SI]",
        y=objective,
        title="Search",
        xlog=bool(x.min() > 0),
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


def build(state: State, again: Callable[[], None]) -> Callable[[], None]:
    """What may change, what is wanted, what must hold; then the search."""
    ui.label(
        "The search runs over the loads of the study. Limits hold at every load; besides, "
        "always: A_t < 0.2, and particles cover less than 0.3."
    ).classes("hint")
    known = variables_of(state)
    with ui.row().classes("w-full items-end gap-3"):
        first = "particles.mean" if "particles.mean" in known else next(iter(known))
        which = ui.select(list(known), value=first, label="what may change").classes("grow")
        low = ui.input("from", value="50 nm").props('data-path="design.low"')
        high = ui.input("to", value="1 um").props('data-path="design.high"')
    with ui.row().classes("w-full items-end gap-3"):
        of = ui.select(metrics_of(state), value="particle_load_share", label="what counts")
        of.classes("grow")
        aims = {
            "smallest": "as small as possible",
            "largest": "as large as possible",
            "window": "within 0.25 to 0.75",
        }
        aim = ui.select(aims, value="largest", label="aim")
        over = ui.select({"mean": "on average", "worst": "at the worst load"}, value="mean")
    with ui.row().classes("w-full items-end gap-3"):
        limit = ui.select({"": "no limit"} | metrics_of(state), value="", label="limit")
        limit.classes("grow")
        most = ui.input("at most").props('data-path="design.most"')
        least = ui.input("at least").props('data-path="design.least"')
    for each in (which, of, aim, over, limit, low, high, most, least):
        each.props("dense")
    told: dict[str, Any] = {}

    def ranged() -> None:
        field = variables_of(state).get(str(which.value))
        if field is None or state.answer is None:
            return
        try:
            now = float(state.answer.contact.part(field[0].split("+")[0]))
        except (InvalidValue, TypeError, ValueError):
            return
        low.set_value(str(engineering(now / 5, field[1]["unit"])))
        high.set_value(str(engineering(now * 3, field[1]["unit"])))

    which.on_value_change(ranged)

    def ask() -> dict[str, Any] | None:
        answer = state.answer
        if answer is None:
            return None
        field, about_it = variables_of(state)[str(which.value)]
        ends = [number_of(value_from(str(w.value or "")), about_it) for w in (low, high)]
        limits: list[dict[str, Any]] = []
        if limit.value:
            one: dict[str, Any] = {"of": str(limit.value)}
            for key, entry in (("most", most), ("least", least)):
                value = value_from(str(entry.value or ""))
                if isinstance(value, (int, float)):
                    one[key] = value
            limits.append(one)
        values = answer.loads
        load = answer.load
        if load == "d":
            load, values = "F_star", np.asarray(answer.curves.F_star)
        if not (np.isfinite(ends).all() and ends[0] < ends[1]):
            work.said.set_text("the range needs two values with their units, the smaller first")
            return None
        told.update(variable=field, unit=about_it["unit"], name=str(which.value))
        return {
            "study": state.study,
            "folder": str(state.folder),
            "over": {field: ends},
            "load": load,
            "loads": np.geomspace(values.min(), values.max(), LOADS).tolist(),
            "objective": {
                "of": str(of.value),
                "aim": str(aim.value),
                "over_loads": str(over.value),
            },
            "limits": limits,
        }

    def show(result: dict[str, Any]) -> None:
        objective = next(iter(result["objectives"]))
        plot.update_figure(design_figure(result, told["variable"], objective))
        plot.set_visibility(True)
        value = result["values"][told["variable"]]
        told["best"] = value
        words = [
            f"Best: {told['name']} = {engineering(value, told['unit'])}, {objective} = "
            f"{result['objectives'][objective]:.4g}."
        ]
        if not result["feasible"]:
            words = [f"Nothing that was tried obeys the limits: {result['reason']}."]
        if band := result["tolerance"].get(told["variable"]):
            words.append(
                f"Less than 5 % is lost between {engineering(band[0], told['unit'])} and "
                f"{engineering(band[1], told['unit'])}."
            )
        if result["at_bound"]:
            words.append("It lies at an end of the range: the best may lie beyond.")
        if result["active"]:
            words.append(f"Limits that hold it there: {', '.join(result['active'])}.")
        said.set_text(" ".join(words))

    work = Work("design", "Search", ask, show)
    said = ui.label().props('data-fact="design"')
    plot = ui.plotly(empty(420)).classes("w-full")
    plot.props('data-figure="design"')
    plot.set_visibility(False)

    def draw() -> None:
        names = variables_of(state)
        if list(names) != which.options:
            which.set_options(list(names), value=which.value if which.value in names else None)
        for menu, blank in ((of, {}), (limit, {"": "no limit"})):
            options = blank | metrics_of(state)
            if options != menu.options:
                menu.set_options(options, value=menu.value if menu.value in options else None)

    return draw
