"""What the contact does besides carrying load: every output of the library, over the load."""

from __future__ import annotations

import dataclasses
import re
import textwrap
from collections.abc import Awaitable, Callable
from itertools import takewhile

import numpy as np
from nicegui import ui

import thirdbody as tb

from ...analysis.uncertainty.propagation import about_result
from ...contact.output import AbstractOutput
from ...equilibrium.columns import about
from ...quantities.say import readable_unit, value_of
from ..figures import (
    AXES,
    SCALES,
    Figure,
    escape_tags,
    figure,
    line,
    mark,
    symbol,
    upper_decades,
    wrap_text,
)
from ..inputs import Inputs
from ..state import Answer, State
from ..widgets import Plot, show_figures
from ..widgets import table as shown_table

__all__ = ["TITLE", "are_bounded", "build", "output_figures"]

TITLE = "Outputs"
QUANTITIES = {
    "1": "coefficient or share",
    "m": "length",
    "K": "temperature or rise",
    "1/m^2": "number per area",
}
"""What columns of one unit are where their meanings have no words in common."""
BOUNDED = re.compile(r"\b(share|part|friction)\b")
"""Words of the meanings of numbers that are bounded."""
GROUPS = {
    "How many contacts": ("counts",),
    "Heat and current": ("thermal_conductance", "electrical_conductance", "flash_temperature"),
    "Damage": ("dents", "crushing", "wear"),
    "Friction": ("friction", "static_friction"),
}
"""Outputs by what they are about; others follow."""
OTHERS = "Others"
START = (
    "The study asks for no output: these need no number of their own. Switch on what is to stay "
    "in the study."
)
BEGUN: tuple[AbstractOutput, ...] = (tb.outputs.Counts(), tb.outputs.ThermalConductance())
"""Outputs that are shown where the study asks for none."""
WIDE_FROM = 30
"""Largest value over smallest from which an axis is logarithmic."""
LINKS = {"of", "a", "an", "the", "on", "in", "by", "that", "from"}
"""Words with which no name ends."""
WIDE = 44
"""Characters of one line of an axis or a legend."""
HEIGHT, LINE = 330, 19
"""Pixels of a figure, and more for each line of its legend."""


def output_figures(answer: Answer, at: float) -> dict[str, Figure]:
    """A figure for each output and unit of its columns."""
    out: dict[str, Figure] = {}
    for output in answer.contact.outputs:
        units: dict[str, list[str]] = {}
        for column, declared in output.columns.items():
            units.setdefault(declared.unit, []).append(column)
        for unit, columns in units.items():
            what = quantity_of(columns, unit)
            title = str(output.title) if len(units) == 1 else f"{output.title}: {what}"
            made = _figure(answer, columns, unit, what, wrap_text(title, WIDE))
            made["layout"]["shapes"] = [mark(_value_on_axis(answer, at), "", dash="solid")[0]]
            out[f"{output.name} [{unit}]"] = made
    return out


def _value_on_axis(answer: Answer, at: float) -> float:
    """Where the operating load is on the axis of the figures: a separation, or a pressure."""
    if answer.load == "d":
        return at
    return at * SCALES["pressure"] * (answer.contact.E_ss if answer.load == "F_star" else 1.0)


def _figure(answer: Answer, columns: list[str], unit: str, what: str, title: str) -> Figure:
    """Columns of one unit over the load, in the prefix of their largest value."""
    against = "d" if answer.load == "d" else "pressure"
    x = np.asarray(getattr(answer.curves, against)) * SCALES.get(against, 1.0)
    values = [np.asarray(answer.curves.outputs[column], dtype=float) for column in columns]
    every = np.concatenate(values)
    every = every[np.isfinite(every) & (every != 0)]
    size, name = readable_unit(float(np.abs(every).max()) if len(every) else 1.0, unit)
    matters = upper_decades(values)
    wide = len(every) > 0 and every.min() > 0 and matters.max() > WIDE_FROM * matters.min()
    names = [f"{symbol(about(c).symbol)}: {escape_tags(about(c).meaning)}" for c in columns]
    names = [_fold_name(text) for text in names]
    return figure(
        [line(x, y / size, text, i) for i, (y, text) in enumerate(zip(values, names, strict=True))],
        x=AXES[against],
        title=title,
        y=wrap_text(what + (f" [{name}]" if name else ""), WIDE),
        xlog=against != "d",
        ylog=bool(wide) and not are_bounded(columns),
        height=HEIGHT + LINE * sum(text.count("<br>") + 1 for text in names),
    )


def are_bounded(columns: list[str]) -> bool:
    """Whether all columns are parts of a whole or coefficients of friction, none far above 1.

    What of them is small does not matter: their axis is linear.

    >>> [are_bounded(c) for c in (["mu", "mu_ss", "rolling_share"], ["n_ss"], ["wear", "wear_K"])]
    [True, False, False]
    """
    abouts = [about_result(column) for column in columns]
    return all(entry.unit == "1" and BOUNDED.search(entry.meaning) for entry in abouts)


def quantity_of(columns: list[str], unit: str) -> str:
    """What columns of one unit are, in words.

    >>> quantity_of(["f_ss", "f_sa"], "N"), quantity_of(["n_ss", "n_sa"], "1/m^2")
    ('mean load', 'number per area')
    """
    every = zip(*(about(column).meaning.split() for column in columns), strict=False)
    words = [at_place[0] for at_place in takewhile(lambda at_place: len(set(at_place)) == 1, every)]
    while len(columns) > 1 and words and words[-1] in LINKS:
        words = words[:-1]
    return " ".join(words).rstrip(":,") or QUANTITIES.get(unit, "value")


def _fold_name(name: str) -> str:
    """A name of a legend in lines, its tags whole."""
    return "<br>".join(textwrap.wrap(name, WIDE + 12, break_long_words=False))


def names_of_outputs(state: State) -> list[str]:
    """Names of the outputs that the study asks for."""
    outputs = state.get("outputs")
    return list(outputs) if isinstance(outputs, dict) else []


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """Switches with their numbers, figures, and the values at the operating load."""

    return Outputs(state).draw


def group_of(name: str) -> str:
    """What an output is about.

    >>> group_of("wear"), group_of("one of my own")
    ('Damage', 'Others')
    """
    return next((group for group, names in GROUPS.items() if name in names), OTHERS)


class Outputs:
    """Values at the operating load, figures in groups, and switches with their numbers."""

    def __init__(self, state: State) -> None:
        self.state = state
        self.shown_names = names_of_outputs(state)
        """What the entries show."""
        self.inputs = Inputs(state, self._refresh_tab)
        self._switches()
        self.start = ui.label(START).classes("hint").props('data-fact="outputs begun"')
        self.grids: dict[str, tuple[ui.element, ui.element]] = {}
        """Of each group its heading and the place of its figures."""
        for group in (*GROUPS, OTHERS):
            heading = ui.label(group).classes("subhead group")
            self.grids[group] = (heading, ui.element("div").classes("figures w-full"))
        self.plots: dict[str, Plot] = {}
        self.table = ui.column().classes("w-full scroll-x")
        self._numbers()

    def _refresh_tab(self) -> None:
        self.shown_names = names_of_outputs(self.state)
        self.inputs.shown.clear()
        self._switches.refresh()
        self._numbers.refresh()

    @ui.refreshable_method
    def _switches(self) -> None:
        with ui.row().classes("w-full switches"):
            self.inputs.output_switches()

    @ui.refreshable_method
    def _numbers(self) -> None:
        """The numbers of the outputs, and mistakes that belong to none of them."""
        with ui.element("div").classes("figures w-full"):
            self.inputs.output_numbers()
        self.inputs.rest = ui.column().classes("w-full")

    async def draw(self) -> None:
        """The outputs of the study as it is now, or some to begin with."""
        state = self.state
        if names_of_outputs(state) != self.shown_names:  # undone, or another study
            self._refresh_tab()
        self.inputs.show_mistakes()
        made, rows = await state.ask(_figures_and_rows, state.operating_load)
        for name in [name for name in self.plots if name not in made]:
            self.plots.pop(name).widget.delete()
        groups = {name: group_of(name.split(" [")[0]) for name in made}
        for name, drawn in made.items():
            if name not in self.plots:
                with self.grids[groups[name]][1]:
                    self.plots[name] = Plot(f"output {name}", drawn["layout"]["height"])
        for group, (heading, _) in self.grids.items():
            heading.set_visibility(group in groups.values())
        answer = state.answer
        self.start.set_visibility(answer is not None and not answer.contact.outputs)
        _table(rows, self.table)
        await show_figures((self.plots[name], drawn) for name, drawn in made.items())


def _figures_and_rows(answer: Answer, at: float) -> tuple[dict[str, Figure], list[dict[str, str]]]:
    """The figures, and the rows of the table; of some outputs where the study asks for none."""
    answer = answer if answer.contact.outputs else _with_first_outputs(answer)
    rows = [
        {
            "meaning": about(name).meaning,
            "symbol": about(name).symbol,
            "value": value_of(float(value), about(name).unit),
            "name": name,
        }
        for name, value in answer.solve(at).outputs.items()
    ]
    return output_figures(answer, at), rows


def _with_first_outputs(answer: Answer) -> Answer:
    """The answer with outputs that need no number of their own."""
    contact = answer.contact
    fitting = tuple(output for output in BEGUN if not output.problems(contact))
    made = dataclasses.replace(answer.study, contact=contact.replace(outputs=fitting))
    return Answer(made)


def _table(rows: list[dict[str, str]], place: ui.element) -> None:
    place.clear()
    with place:
        if not rows:
            ui.label("Switch an output on.").classes("hint")
            return
        ui.label("At the operating load").classes("subhead")
        heads = {
            "meaning": "quantity",
            "symbol": "symbol",
            "value": "value",
            "name": "in files",
        }
        shown_table("outputs", heads, rows)
