"""What the contact does besides carrying load: every output of the library, over the load."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Awaitable, Callable
from itertools import takewhile

import numpy as np
from nicegui import ui

from ...analysis.uncertainty.propagation import about_result
from ...equilibrium.columns import about
from ...quantities.say import prefixed, value_of
from ..figures import AXES, SCALES, Figure, clipped, figure, line, mark, plain, symbol, wrapped
from ..inputs import Inputs
from ..state import Answer, State
from ..widgets import Plot, show_figures
from ..widgets import table as shown_table

__all__ = ["TITLE", "bounded", "build", "output_figures"]

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
        for column, told in output.columns.items():
            units.setdefault(told.unit, []).append(column)
        for unit, columns in units.items():
            what = quantity_of(columns, unit)
            title = str(output.title) if len(units) == 1 else f"{output.title}: {what}"
            made = _figure(answer, columns, unit, what, wrapped(title, WIDE))
            scale = SCALES.get(answer.load, 1.0)
            made["layout"]["shapes"] = [mark(at * scale, "", dash="solid")[0]]
            out[f"{output.name} [{unit}]"] = made
    return out


def _figure(answer: Answer, columns: list[str], unit: str, what: str, title: str) -> Figure:
    """Columns of one unit over the load, in the prefix of their largest value."""
    scale = SCALES.get(answer.load, 1.0)
    values = [np.asarray(answer.curves.outputs[column], dtype=float) for column in columns]
    every = np.concatenate(values)
    every = every[np.isfinite(every) & (every != 0)]
    size, name = prefixed(float(np.abs(every).max()) if len(every) else 1.0, unit)
    matters = clipped(values)
    wide = len(every) > 0 and every.min() > 0 and matters.max() > WIDE_FROM * matters.min()
    names = [f"{symbol(about(c).symbol)}: {plain(about(c).meaning)}" for c in columns]
    names = [_folded(each) for each in names]
    return figure(
        [
            line(answer.loads * scale, y / size, each, i)
            for i, (y, each) in enumerate(zip(values, names, strict=True))
        ],
        x=AXES[answer.load],
        title=title,
        y=wrapped(what + (f" [{name}]" if name else ""), WIDE),
        xlog=answer.load != "d",
        ylog=bool(wide) and not bounded(columns),
        height=HEIGHT + LINE * sum(each.count("<br>") + 1 for each in names),
    )


def bounded(columns: list[str]) -> bool:
    """Whether all columns are parts of a whole or coefficients of friction, none far above 1.

    What of them is small does not matter: their axis is linear.

    >>> bounded(["mu", "mu_ss", "rolling_share"]), bounded(["n_ss"]), bounded(["wear", "wear_K"])
    (True, False, False)
    """
    told = [about_result(column) for column in columns]
    return all(each.unit == "1" and BOUNDED.search(each.meaning) for each in told)


def quantity_of(columns: list[str], unit: str) -> str:
    """What columns of one unit are, in words.

    >>> quantity_of(["f_ss", "f_sa"], "N"), quantity_of(["n_ss", "n_sa"], "1/m^2")
    ('mean load', 'number per area')
    """
    every = zip(*(about(column).meaning.split() for column in columns), strict=False)
    words = [each[0] for each in takewhile(lambda each: len(set(each)) == 1, every)]
    while len(columns) > 1 and words and words[-1] in LINKS:
        words = words[:-1]
    return " ".join(words).rstrip(":,") or QUANTITIES.get(unit, "value")


def _folded(name: str) -> str:
    """A name of a legend in lines, its tags whole."""
    return "<br>".join(textwrap.wrap(name, WIDE + 12, break_long_words=False))


def names_of_outputs(state: State) -> list[str]:
    """Names of the outputs that the study asks for."""
    given = state.get("outputs")
    return list(given) if isinstance(given, dict) else []


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """Switches with their numbers, figures, and the values at the operating load."""

    seen = {"asked": names_of_outputs(state)}

    def renewed() -> None:
        seen["asked"] = names_of_outputs(state)
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
    plots: dict[str, Plot] = {}

    async def draw() -> None:
        if names_of_outputs(state) != seen["asked"]:  # undone, or another study
            renewed()
        inputs.tell()
        made, rows = await state.ask(_figures_and_rows, state.at)
        for name in [name for name in plots if name not in made]:
            plots.pop(name).widget.delete()
        with grid:
            for name, drawn in made.items():
                if name not in plots:
                    plots[name] = Plot(f"output {name}", drawn["layout"]["height"])
        _table(rows, table)
        await show_figures((plots[name], drawn) for name, drawn in made.items())

    return draw


def _figures_and_rows(answer: Answer, at: float) -> tuple[dict[str, Figure], list[dict[str, str]]]:
    """The figures, and the rows of the table."""
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
