"""Area, shares, regimes and separation over the load."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

import numpy as np
from nicegui import ui

from ...equilibrium.words import BANDS, critical_load, happens
from ..figures import AXES, REGIME_FILLS, empty, figure, line, log_title, mark, mode_bands, plain
from ..state import Answer, State
from ..widgets import put
from ..widgets import table as shown_table

__all__ = ["TITLE", "build", "figures"]

TITLE = "Curves"
CRITICAL = {
    "F_cr1": "F<sub>cr1</sub>",
    "F_cr2": "F<sub>cr2</sub>",
    "A": "turning point",
    "B": "equal loads",
}


def critical_loads(answer: Answer) -> dict[str, float]:
    """Critical loads F* that exist, by their short names."""
    found = answer.critical
    if found is None or answer.contact.two_body:
        return {}
    every = {
        "F_cr1": found.F_cr1.value,
        "F_cr2": found.F_cr2.value,
        "A": found.F_tpca.A.value,
        "B": found.F_tpca.B.value,
    }
    return {name: value for name, value in every.items() if value}


def figures(
    answer: Answer, against: str, at: float, *, critical: bool = True
) -> dict[str, dict[str, Any]]:
    """The four figures as plain data."""
    state = answer.curves
    x = np.asarray(getattr(state, against))
    xlog = against != "d"
    two_body = answer.contact.two_body
    shapes = [] if two_body else mode_bands(x, state.mode)
    notes: list[dict[str, Any]] = []
    marked = critical_loads(answer) if critical else {}
    scale = {"F_star": 1.0, "pressure": answer.contact.E_ss}.get(against)
    if scale is not None:
        known = [(n, v * scale) for n, v in marked.items() if x.min() <= v * scale <= x.max()]
        for number, (name, value) in enumerate(sorted(known, key=lambda item: item[1])):
            shape, note = mark(value, CRITICAL[name], number=number)
            shapes.append(shape)
            notes.append(log_title(note))
    here = at if against == answer.load else None
    if here is not None:
        shape, _ = mark(here, "", dash="solid")
        shapes.append(shape)
    more: dict[str, Any] = {
        "x": AXES[against],
        "xlog": xlog,
        "shapes": shapes,
        "annotations": notes,
    }

    area = [line(x, state.A_t, "all A<sub>t</sub>", 0)]
    if not two_body:
        area += [
            line(x, state.A_ss, "asperities A<sub>ss</sub>", 1),
            line(x, state.A_sa, "particles A<sub>sa</sub>", 2),
        ]
    out = {
        "area": figure(
            area, y="real area over A<sub>n</sub>", title="Real contact area", ylog=True, **more
        )
    }
    if not two_body:
        parts = [
            line(x, 100 * np.asarray(state.particle_load_share), "of the load", 0),
            line(x, 100 * np.asarray(state.particle_area_share), "of the real area", 1),
        ]
        for number, part in enumerate(state.populations):
            share = 100 * np.asarray(part.load_share)
            parts.append(line(x, share, f"{plain(part.name)}: load", number + 2))
        out["shares"] = figure(
            parts, y="share of particles [%]", title="What particles carry; mode as bands", **more
        )
        out["shares"]["layout"]["yaxis"]["range"] = [-2, 102]
    total = np.asarray(state.A_t)
    stacked = []
    for name, (label, colour) in REGIME_FILLS.items():
        share = 100 * np.asarray(getattr(state, name)) / np.where(total > 0, total, np.nan)
        stacked.append(
            line(x, share, label)
            | {
                "stackgroup": "one",
                "fillcolor": colour,
                "line": {"color": colour, "width": 0.5},
                "fillpattern": {"shape": {"A_e": "", "A_ep": "/", "A_p": "x"}[name], "size": 7},
            }
        )
    lined = more | {"shapes": [s for s in shapes if s["type"] == "line"]}
    out["regimes"] = figure(
        stacked, y="part of the real area [%]", title="Deformation regimes", **lined
    )
    out["regimes"]["layout"]["yaxis"]["range"] = [0, 100]
    nm = 1e9
    out["separation"] = figure(
        [
            line(x, nm * np.asarray(state.h), "h, from the mean surface", 0),
            line(x, nm * np.asarray(state.d), "d, from the mean asperity", 1),
        ],
        y="separation [nm]",
        title="Separation",
        **more,
    )
    return out


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """Four figures and the critical loads."""
    with ui.row().classes("w-full items-center gap-4"):
        against = ui.toggle({"F_star": "F*", "pressure": "pressure"}, value="F_star")
        against.props('dense no-caps aria-label="horizontal axis" data-path="curves.against"')
        modes = ui.label().classes("hint")
    grid = ui.element("div").classes("figures w-full")
    plots: dict[str, Any] = {}
    with grid:
        for name in ("area", "shares", "regimes", "separation"):
            plots[name] = ui.plotly(empty(360)).classes("w-full")
            put(plots[name], {"data-figure": name})
    table = ui.column().classes("w-full scroll-x")
    later: dict[str, Any] = {"timer": None}

    async def show(critical: bool) -> None:
        answer = state.answer
        assert answer is not None
        found = await state.ask(_figures, str(against.value), state.at, critical)
        for name, made in found.items():
            plots[name].update_figure(made)
        plots["shares"].set_visibility(not answer.contact.two_body)
        modes.set_text("" if answer.contact.two_body else BANDS)

    async def finish() -> None:
        later["timer"] = None
        await show(critical=True)
        _table(state, table)

    async def draw() -> None:
        answer = state.answer
        assert answer is not None
        known = "critical" in answer.__dict__
        await show(critical=known)
        if known:
            _table(state, table)
        elif later["timer"] is None:
            # critical loads are many states: they follow when the slider rests
            with grid:
                later["timer"] = ui.timer(0.25, finish, once=True)

    against.on_value_change(lambda: draw())
    return draw


def _figures(answer: Answer, against: str, at: float, critical: bool) -> dict[str, dict[str, Any]]:
    if critical:
        _ = answer.critical  # which the table shows as well
    return figures(answer, against, at, critical=critical)


def _table(state: State, place: Any) -> None:
    """Critical loads, as the command line prints them."""
    answer = state.answer
    assert answer is not None
    place.clear()
    found = answer.__dict__.get("critical")
    if found is None or answer.contact.two_body:
        return
    entries = {
        "F_cr1": found.F_cr1,
        "F_cr2": found.F_cr2,
        "F_tpca A": found.F_tpca.A,
        "F_tpca B": found.F_tpca.B,
        "F_tpca C": found.F_tpca.C,
    }
    rows = [
        {
            "name": f"{name}: {happens(name)}",
            "F": critical_load(one.value, one.status),
            "p": critical_load(one.value, one.status, answer.contact.E_ss),
            "status": one.status,
        }
        for name, one in entries.items()
    ]
    heads = {"name": "critical load", "F": "F*", "p": "pressure", "status": "status"}
    with place:
        shown_table("critical", heads, rows)
