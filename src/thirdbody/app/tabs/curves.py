"""Area, shares, regimes and separation over the load."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable
from functools import partial

import numpy as np
from nicegui import ui

from ...equilibrium.words import critical_load, happens
from ...errors import InvalidValue
from ...views.palette import HATCHES
from ..figures import (
    AXES,
    MODE_FILLS,
    REGIME_FILLS,
    SCALES,
    Figure,
    Part,
    escape_tags,
    figure,
    fix,
    line,
    log_title,
    mark,
    mode_bands,
    span,
)
from ..state import Answer, State
from ..widgets import Plot, set_attributes, show_figures
from ..widgets import table as shown_table
from .interface import abouts, swatch

__all__ = ["TITLE", "build", "figures"]

TITLE = "Curves"
TAB = "curves"
RESTS = 0.4
"""Seconds after which the slider counts as at rest."""
BETWEEN = 0.2
"""Seconds in which the next move of a slider comes, if it moves."""
TICK = 0.01
"""Seconds by which a timer may be early, and between two looks."""
LOOKS = 0.05
"""Seconds after which it is looked whether the tab is still in sight."""
ABOVE, BELOW = ("area", "shares"), ("regimes", "separation")
FIGURES = (*ABOVE, *BELOW)
Draw = Callable[..., Figure]
CRITICAL = {
    "F_cr1": "F<sub>cr1</sub>",
    "F_cr2": "F<sub>cr2</sub>",
    "A": "turning point",
    "B": "equal loads",
}


def critical_loads(answer: Answer) -> dict[str, float]:
    """Critical loads F* that exist, by their short names."""
    critical = answer.critical
    if critical is None or answer.contact.two_body:
        return {}
    every = {
        "F_cr1": critical.F_cr1.value,
        "F_cr2": critical.F_cr2.value,
        "A": critical.F_tpca.A.value,
        "B": critical.F_tpca.B.value,
    }
    return {name: value for name, value in every.items() if value}


def figures(answer: Answer, against: str, *, critical: bool = True) -> dict[str, Figure]:
    """The four figures as plain data."""
    state = answer.curves
    x = np.asarray(getattr(state, against)) * SCALES.get(against, 1.0)
    lines, notes = _critical_lines(answer, against, x) if critical else ([], [])
    bands = [] if answer.contact.two_body else mode_bands(x, state.mode)
    draw = partial(figure, x=AXES[against], xlog=against != "d", annotations=notes)
    over_bands = partial(draw, shapes=bands + lines)
    out = {"area": _area(answer, x, over_bands)}
    if not answer.contact.two_body:
        out["shares"] = _shares(answer, x, over_bands)
    out["regimes"] = _regimes(answer, x, partial(draw, shapes=lines))
    out["separation"] = _separation(answer, x, over_bands)
    for made in out.values():
        fix(made, "xaxis", span(x, log=against != "d", padded=False))
    return out


def _critical_lines(answer: Answer, against: str, x: np.ndarray) -> tuple[list[Part], list[Part]]:
    """Critical loads in sight, as shapes and annotations."""
    scale = {"F_star": 1.0, "pressure": answer.contact.E_ss * SCALES["pressure"]}.get(against)
    if scale is None:
        return [], []
    marked = critical_loads(answer)
    in_sight = [(n, v * scale) for n, v in marked.items() if x.min() <= v * scale <= x.max()]
    in_sight.sort(key=lambda item: item[1])
    made = [mark(v, CRITICAL[name], number=i) for i, (name, v) in enumerate(in_sight)]
    return [shape for shape, _ in made], [log_title(note) for _, note in made]


def _area(answer: Answer, x: np.ndarray, draw: Draw) -> Figure:
    state = answer.curves
    lines = [line(x, state.A_t, "all A<sub>t</sub>", 0)]
    if not answer.contact.two_body:
        lines += [
            line(x, state.A_ss, "asperities A<sub>ss</sub>", 1),
            line(x, state.A_sa, "particles A<sub>sa</sub>", 2),
        ]
    return draw(lines, y="real area over A<sub>n</sub>", title="Real contact area", ylog=True)


def _shares(answer: Answer, x: np.ndarray, draw: Draw) -> Figure:
    state = answer.curves
    lines = [
        line(x, 100 * np.asarray(state.particle_load_share), "of the load", 0),
        line(x, 100 * np.asarray(state.particle_area_share), "of the real area", 1),
    ]
    for number, population in enumerate(state.populations):
        share = 100 * np.asarray(population.load_share)
        lines.append(line(x, share, f"{escape_tags(population.name)}: load", number + 2))
    made = draw(lines, y="share of particles [%]", title="What particles carry; mode as bands")
    fix(made, "yaxis", [-2, 102])
    return made


def _regimes(answer: Answer, x: np.ndarray, draw: Draw) -> Figure:
    state = answer.curves
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
                "fillpattern": {"shape": HATCHES[name], "size": 7},
            }
        )
    made = draw(stacked, y="part of the real area [%]", title="Deformation regimes")
    fix(made, "yaxis", [0, 100])
    return made


def _separation(answer: Answer, x: np.ndarray, draw: Draw) -> Figure:
    state, nm = answer.curves, 1e9
    lines = [
        line(x, nm * np.asarray(state.h), "h, mean surface", 0),
        line(x, nm * np.asarray(state.d), "d, mean asperity", 1),
    ]
    made = draw(lines, y="separation [nm]", title="Separation")
    fix(made, "yaxis", span([nm * np.asarray(state.h), nm * np.asarray(state.d)]))
    return made


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """Four figures and the critical loads."""
    return Curves(state).draw


class Curves:
    """Four figures over the load, and a table of the critical loads once the slider rests."""

    def __init__(self, state: State) -> None:
        self.state = state
        with ui.row().classes("w-full items-center gap-4"):
            self.against = ui.toggle({"pressure": "pressure", "F_star": "F*"}, value="pressure")
            self.against.props('dense no-caps aria-label="horizontal axis"')
            self.against.props('data-path="curves.against"')
            self.key = ui.row().classes("items-center gap-4").props('data-figure="bands key"')
            with self.key:
                for mode, colour in MODE_FILLS.items():
                    swatch("opacity:0.5;background:" + colour, f"{mode}: {abouts()[mode]}")
        self.grid = ui.element("div").classes("figures w-full")
        with self.grid:
            self.plots = {name: Plot(name) for name in FIGURES}
        self.table = ui.column().classes("w-full scroll-x")
        self.later: ui.timer | None = None
        """The timer after which critical loads follow."""
        self.drawn = 0.0
        """When the figures were drawn last."""
        self.shown: tuple[Answer, str, bool] | None = None
        """What the figures show."""
        self.drawing: asyncio.Future[bool] | None = None
        """Figures that the browser may still draw, of a study that has moved on meanwhile."""
        self.in_table: Answer | None = None
        """Whose critical loads the table holds."""
        self.against.on_value_change(state.announce_change)

    async def draw(self) -> None:
        answer = self.state.answer
        assert answer is not None
        has_critical = "critical" in answer.__dict__
        await self._place(answer)
        await self._show(answer, critical=has_critical)
        self.drawn = time.perf_counter()
        if has_critical:
            self._show_table(answer)
        elif self.later is None:
            # critical loads are many states: they follow when the slider rests
            self._wait(RESTS)

    def _wait(self, seconds: float) -> None:
        with self.grid:
            self.later = ui.timer(seconds, self._finish, once=True)

    async def _place(self, answer: Answer) -> None:
        """Where the line of the operating load is."""
        state, axis = self.state, str(self.against.value)
        at = (
            await state.ask(_solve_load, state.operating_load)
            if answer.load == "d"
            else state.operating_load
        )
        F_star = at / answer.contact.E_ss if answer.load == "pressure" else at
        here = F_star * (1.0 if axis == "F_star" else answer.contact.E_ss * SCALES[axis])
        set_attributes(self.grid, {"data-at": repr(here)})

    async def _show(self, answer: Answer, *, critical: bool) -> None:
        view = (answer, str(self.against.value), critical)
        if view == self.shown:
            return
        new_figures = await self.state.ask(_figures, view[1], critical)
        if answer is not self.state.answer:
            return  # it moved on meanwhile
        self.shown = view
        two_body = answer.contact.two_body
        self.plots["shares"].widget.set_visibility(not two_body)
        self.key.set_visibility(not two_body)
        # those on top first, the others one by one as it rests: a move waits for one at most
        for names in (ABOVE, *((name,) for name in BELOW)):
            below = names != ABOVE
            if below and await self._moves_on(BETWEEN if names == BELOW[:1] else 0.0):
                self.shown = None
                return
            every = [(self.plots[name], new_figures[name]) for name in names if name in new_figures]
            drawn = await self._draw(every, below)
            if not drawn:
                self.shown = None
            if drawn is None:
                return

    async def _draw(self, every: list[tuple[Plot, Figure]], below: bool) -> bool | None:
        """Draw figures, and whether the browser has drawn them; None where that is not waited for.

        It is not once the tab is left, nor for figures below of a study that has moved on: the
        answer to the move begins while the browser draws them.
        """
        while self.drawing is not None:  # the browser gets one message at a time
            await self._wait_for(self.drawing)
        self.drawing = drawing = asyncio.ensure_future(show_figures(every))
        while not drawing.done():
            if self.state.tab != TAB or (below and self.state.study is not self.state.read):
                return None
            await asyncio.wait([drawing], timeout=TICK if below else LOOKS)
        await self._wait_for(drawing)
        return drawing.result()

    async def _wait_for(self, drawing: asyncio.Future[bool]) -> None:
        await asyncio.wait([drawing])
        if self.drawing is drawing:
            self.drawing = None

    async def _moves_on(self, seconds: float) -> bool:
        """Whether the study is another one within these seconds: the last move wins."""
        until = time.perf_counter() + seconds
        while self.state.study is self.state.read:
            if time.perf_counter() > until:
                return False
            await asyncio.sleep(TICK)
        return True

    async def _finish(self) -> None:
        self.later = None
        moved = time.perf_counter() - self.drawn
        if moved < RESTS:  # the slider moves
            self._wait(RESTS - moved + TICK)
            return
        answer = self.state.answer
        assert answer is not None
        try:
            await self._show(answer, critical=True)
        except InvalidValue as error:
            self.shown = None
            self.table.clear()
            with self.table:
                ui.label("; ".join(error.problems)).classes("problem")
            return
        if answer is self.state.answer:
            self._show_table(answer)

    def _show_table(self, answer: Answer) -> None:
        if answer is not self.in_table:
            self.in_table = answer
            _table(answer, self.table)


def _figures(answer: Answer, against: str, critical: bool) -> dict[str, Figure]:
    if critical:
        _ = answer.critical  # which the table shows as well
    return figures(answer, against, critical=critical)


def _solve_load(answer: Answer, d: float) -> float:
    return float(answer.solve(d).F_star)


def _table(answer: Answer, place: ui.element) -> None:
    """Critical loads, as the command line prints them."""
    place.clear()
    critical = answer.__dict__.get("critical")
    if critical is None or answer.contact.two_body:
        return
    entries = {
        "F_cr1": critical.F_cr1,
        "F_cr2": critical.F_cr2,
        "F_tpca A": critical.F_tpca.A,
        "F_tpca B": critical.F_tpca.B,
        "F_tpca C": critical.F_tpca.C,
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
