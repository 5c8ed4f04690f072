"""The best size, density or roughness over a range of loads, under limits."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

import numpy as np
from nicegui import ui

from ...equilibrium.columns import COLUMNS, about
from ...errors import InvalidValue
from ...quantities.plain_data import plain_data
from ...quantities.say import number, readable_unit
from ...study.inputs import field_of, inputs_of
from ..fields import engineering, text_of, value_from
from ..figures import GREY, Figure, Part, band, escape_tags, figure, line, symbol
from ..state import State, loads_as
from ..text import as_shown
from ..widgets import plot_place
from ..work import Asked, Work
from ..worker import Designed

__all__ = ["TITLE", "build", "design_figure"]

TITLE = "Design"
LOADS, FEW = 16, 4
METRICS = ("particle_load_share", "A_t", "plastic_share", "d", "h", "A_p")
WITH_SPREAD = ", and its spread in proportion"
"""What is said of a size that is searched."""
WRITTEN = "as the table [design] says"
SIZE = "particles.mean+particles.std"
LIKELY = (SIZE, "roughness.sigma", "roughness.Ra", "roughness.first.Ra")
"""Inputs that a search begins with, the first that the study has."""
AIMS = {
    "smallest": "as small as possible",
    "largest": "as large as possible",
    "window": "within 0.25 to 0.75",
}
OVER = {"mean": "on average", "worst": "at the worst load"}
NO_LIMIT = {"": "no limit"}


def metrics_of(state: State) -> dict[str, str]:
    """What can be made small or large: states, then outputs that the study asks for."""
    out = {name: name for name in METRICS}
    for name in out:
        if name in COLUMNS:
            out[name] = f"{name}: {COLUMNS[name].meaning}"
    if state.answer is not None:
        for output in state.answer.contact.outputs:
            for column in output.columns:
                out[column] = f"{column}: {about(column).meaning}"
    return out


def variables_of(state: State) -> dict[str, str]:
    """Inputs that may be searched, by their names in the file, with their units."""
    out = {e.name: e.quantity["unit"] for e in inputs_of(state.study) if e.quantity and not e.idle}
    if {"particles.mean", "particles.std"} <= out.keys():
        # a size is searched with its spread in proportion
        out = {SIZE: out["particles.mean"]} | out
    return out


def design_figure(
    designed: Designed, variable: str, objective: str, unit: str, words_of: dict[str, str]
) -> Figure:
    """Every point tried, the best marked, the tolerance as a band."""
    every = designed["points"][variable]
    words = any(isinstance(item, str) for item in every)
    x = np.array([escape_tags(str(item)) for item in every]) if words else np.array(every, float)
    size, name = (1.0, "") if words else readable_unit(float(np.max(np.abs(x))), unit)
    x = x if words else x / size
    y = np.array(designed["points"][objective], float)
    good = np.array(designed["points"]["feasible"], np.bool_)
    order = np.argsort(x)
    best = designed["values"][variable]
    best = escape_tags(best) if isinstance(best, str) else best / size
    traces: list[Part] = [
        line([], y[order], "all points", 0, line={"width": 1.5}) | {"x": x[order].tolist()},
        {
            "type": "scatter",
            "mode": "markers",
            "x": x[~good].tolist(),
            "y": plain_data(y[~good]),
            "name": "breaks a limit",
            "marker": {"symbol": "x", "size": 8, "color": GREY},
        },
        {
            "type": "scatter",
            "mode": "markers",
            "x": [best],
            "y": [designed["objectives"][objective]],
            "name": "best",
            "marker": {"symbol": "star", "size": 16, "color": "#D55E00"},
        },
    ]
    made = figure(
        traces,
        x=symbol(words_of.get(variable, variable)) + (f" [{name}]" if name else ""),
        y=escape_tags(meaning(objective)),
        title="What was tried",
        xlog=not words and bool(x.min() > 0),
        height=420,
    )
    if ends := designed["tolerance"].get(variable):
        made["layout"]["shapes"] = [band(ends[0] / size, ends[1] / size, "#009E73", 0.18)]
    return made


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """What may change, what is wanted, what must hold; then the search."""
    return Search(state).draw


class Search:
    """The form that asks for a design, and the answer."""

    def __init__(self, state: State) -> None:
        self.state = state
        names = _names(state)
        first = next((name for name in (WRITTEN, *LIKELY) if name in names), next(iter(names)))
        self.said = ui.label().props('data-fact="design"').classes("break-any headline second")
        self.which = ui.select(names, value=first, label="what may change").classes("w-full")
        self.which.props('dense data-path="design.which"')
        self.form = ui.column().classes("w-full")
        with self.form, ui.row().classes("w-full items-end gap-3"):
            self._aim()
        with self.form, ui.row().classes("w-full items-end gap-3"):
            self._limit()
        self.form.set_visibility(first != WRITTEN)
        if first != SIZE:
            self._set_range()
        self.work = Work("design", "Search", self._ask, self._show, key=self._key, little=_little)
        self.plot = plot_place("design", 420)
        ui.label(
            "The search runs over the loads of the study. Limits hold at every load; besides, "
            "always: A_t < 0.2, and particles cover less than 0.3."
        ).classes("hint")
        self.which.on_value_change(self._update_range)
        for entry in (self.of, self.aim, self.over, self.limit):
            entry.on_value_change(lambda: self.work.update_preview(state))
        for text in (self.low, self.high, self.most, self.least):
            text.on("change", lambda: self.work.update_preview(state))

    def _aim(self) -> None:
        """The range, and what is to be small or large in it."""
        self.low = ui.input("from", value="50 nm").props('dense data-path="design.low"')
        self.high = ui.input("to", value="1 µm").props('dense data-path="design.high"')
        self.of = ui.select(
            metrics_of(self.state), value="particle_load_share", label="what counts"
        )
        self.of.props("dense").classes("grow")
        self.aim = ui.select(AIMS, value="largest", label="aim").props("dense")
        self.over = (
            ui.select(OVER, value="mean", label="over the loads").props("dense").classes("w-36")
        )

    def _limit(self) -> None:
        """What must hold."""
        self.limit = ui.select(NO_LIMIT | metrics_of(self.state), value="", label="limit")
        self.limit.props("dense").classes("grow")
        self.most = ui.input("at most").props('dense data-path="design.most"')
        self.least = ui.input("at least").props('dense data-path="design.least"')

    def _key(self) -> object:
        """What a design belongs to: the study, and the form."""
        form = (self.which, self.low, self.high, self.of, self.aim, self.over)
        entries = [str(entry.value) for entry in (*form, self.limit, self.most, self.least)]
        return self.state.answer, self.state.get("design"), entries

    async def _update_range(self) -> None:
        self._set_range()
        await self.work.update_preview(self.state)

    def _set_range(self) -> None:
        """Another input: a range about what it is."""
        name, answer = str(self.which.value), self.state.answer
        unit = variables_of(self.state).get(name)
        self.form.set_visibility(name != WRITTEN)
        if unit is None or answer is None:
            return
        *path, last = name.split("+")[0].split(".")
        try:
            now = float(answer.contact.value_at(field_of(".".join(path), last)))
        except (InvalidValue, TypeError, ValueError):
            return
        self.low.set_value(text_of(engineering(now / 5, unit)))
        self.high.set_value(text_of(engineering(now * 3, unit)))

    async def _table(self) -> dict[str, object]:
        """What the form asks, as the table [design] of a study."""
        ends = {"low": _value(self.low), "high": _value(self.high)}
        wanted = {"of": self.of.value, "aim": self.aim.value, "over_loads": self.over.value}
        table: dict[str, object] = {"objective": wanted, "vary": {str(self.which.value): ends}}
        if self.limit.value:
            ends = {"most": _value(self.most), "least": _value(self.least)}
            limits = {key: value for key, value in ends.items() if value is not None}
            table["limits"] = [{"of": self.limit.value} | limits]
        if (answer := self.state.answer) is not None:
            name = answer.load if answer.load != "d" else "F_star"
            same = name == answer.load
            values = answer.loads if same else await self.state.ask(loads_as, name)
            first, last = float(values.min()), float(values.max())
            table[name] = {"from": first, "to": last, "points": LOADS}
        return table

    async def _ask(self) -> Asked:
        await self.state.settle()
        changes = {} if self.which.value == WRITTEN else {"design": await self._table()}
        return {"study": self.state.study | changes, "folder": str(self.state.folder)}

    def _show(self, result: Designed) -> None:
        objective, variable = next(iter(result["objectives"])), next(iter(result["values"]))
        units = {e.field: e.quantity["unit"] for e in inputs_of(self.state.study) if e.quantity}
        unit = units.get(variable.split("+")[0], "1")
        names = in_words(self.state.study, list(result["values"]))
        self.plot.update_figure(design_figure(result, variable, objective, unit, names))
        self.said.set_text(as_shown(" ".join(design_sentences(result, units, names))))

    async def draw(self) -> None:
        await self.work.update_preview(self.state)
        names, which = _names(self.state), self.which
        if names != which.options:
            which.set_options(
                names, value=which.value if which.value in names else next(iter(names))
            )
        for menu, blank in ((self.of, {}), (self.limit, NO_LIMIT)):
            options = blank | metrics_of(self.state)
            if options != menu.options:
                menu.set_options(options, value=menu.value if menu.value in options else None)
        self.plot.set_visibility(self.work.done is not None or self.work.trying)


def _little(request: Asked) -> Asked:
    """Fewer loads, where the form says which."""
    study = request["study"]
    assert isinstance(study, dict)
    table = study.get("design")
    if not isinstance(table, dict):
        return request
    few = {
        key: value | {"points": FEW} if isinstance(value, dict) and "points" in value else value
        for key, value in table.items()
    }
    return request | {"study": study | {"design": few}}


def in_words(study: dict[str, object], fields: list[str]) -> dict[str, str]:
    """Inputs by meaning and symbol; with their names where two have the same.

    >>> from ..examples import example
    >>> for name in in_words(example(), ["roughness.R", "surfaces.first.H"]).values():
    ...     print(name)
    mean asperity radius R
    hardness H (surfaces.first)
    """
    quantities = {e.field: e.quantity for e in inputs_of(study) if e.quantity}
    said = {
        field: f"{quantity['meaning']} {quantity['symbol']}"
        for field, quantity in quantities.items()
    }
    out = {}
    for field in fields:
        first = field.partition("+")[0]
        if first not in said:
            continue
        several = list(said.values()).count(said[first]) > 1
        out[field] = said[first] + (f" ({first.rpartition('.')[0]})" if several else "")
    return out


def meaning(column: str) -> str:
    """What a column is; some aims are none."""
    return str(about(column).meaning) if column in COLUMNS else column


def design_sentences(result: Designed, units: dict[str, str], names: dict[str, str]) -> list[str]:
    """The design that was found, in sentences."""

    def one(name: str, value: str | float) -> str:
        unit = units.get(name.split("+")[0], "1")
        return str(value) if isinstance(value, str) else str(engineering(value, unit))

    best = [
        f"{names.get(name, name)} = {one(name, value)}"
        + (" and what goes along in proportion" if "+" in name else "")
        for name, value in result["values"].items()
    ]
    best += [f"{meaning(name)} = {number(value)}" for name, value in result["objectives"].items()]
    words = [f"Best: {', '.join(best)}."]
    if not result["feasible"]:
        words = [f"Nothing that was tried obeys the limits: {result['reason']}."]
    for name, ends in result["tolerance"].items():
        low, high = (one(name, end) for end in ends)
        which = f" for {names.get(name, name)}" if len(result["tolerance"]) > 1 else ""
        words.append(f"Less than 5 % is lost{which} between {low} and {high}.")
    if result["at_bound"]:
        words.append("It lies at an end of the range: the best may lie beyond.")
    if result["active"]:
        words.append(f"Limits that hold it there: {', '.join(result['active'])}.")
    return words


def _value(entry: ui.input) -> object:
    return value_from(str(entry.value or ""))


def _names(state: State) -> dict[str, str]:
    """What may change, an input or what the study says, and how the menu calls it."""
    quantities = {e.name: e.quantity for e in inputs_of(state.study) if e.quantity}
    said = {
        name: f"{quantity['meaning']} {quantity['symbol']}" for name, quantity in quantities.items()
    }
    menu = {}
    for name in variables_of(state):
        first = name.partition("+")[0]
        several = list(said.values()).count(said[first]) > 1
        menu[name] = said[first] + (f" ({first})" if several else "")
        menu[name] += WITH_SPREAD if name == SIZE else ""
    return ({WRITTEN: WRITTEN} if state.get("design") else {}) | menu
