"""How sure the answer is: bands over the load, and what each input alone does."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable

import numpy as np
from nicegui import ui

from ...analysis.assessment import unit_of
from ...analysis.inputs import words_of
from ...analysis.uncertainty.inputs import KINDS, stated_ranges
from ...analysis.uncertainty.propagation import about_result
from ...equilibrium.critical_loads import CRITICAL
from ...quantities.plain_data import plain_data
from ...quantities.say import percent, value_of
from ...study.inputs import inputs_of
from ...views.palette import OKABE_ITO
from ..fields import engineering, number_of
from ..figures import (
    AXES,
    GREY,
    INKS,
    SCALES,
    Figure,
    Part,
    figure,
    json_numbers,
    line,
    mark,
    wrap_text,
)
from ..inputs import Inputs
from ..state import State
from ..text import as_shown
from ..widgets import plot_place, set_attributes
from ..work import Asked, Work
from ..worker import Bands
from .outputs import are_bounded

__all__ = ["TITLE", "band_figure", "build", "critical_figure", "results_of", "tornado_figure"]

TITLE = "Error bars"
LOADS = 21
WIDE = 26
"""Characters of an input beside its bar."""
PLAIN = ("particle_load_share", "particle_area_share", "plastic_share", "A_t", "d", "h")


LIKELY = (
    "roughness.sigma",
    "roughness.Ra",
    "roughness.first.Ra",
    "roughness.second.Ra",
    "roughness.R",
    "particles.mean",
    "particles.median",
    "particles.areal_density",
    "surfaces.second.H",
)
"""Inputs that are taken as uncertain where the study says nothing of any."""
PART = 0.1
"""By how much of each."""
ASSUMED = "The study does not say how well its inputs are known: shown for ±10 % of {}."


def assumed_ranges(state: State) -> dict[str, dict[str, object]]:
    """Ranges to begin with, where neither study nor library states any; else none."""
    if state.answer is None or state.get("uncertainty", "inputs") or _ranges(state):
        return {}
    ranges: dict[str, dict[str, object]] = {}
    for one_input in inputs_of(state.study):
        if one_input.name not in LIKELY or one_input.idle or one_input.quantity is None:
            continue
        value = number_of(state.get(*one_input.name.split(".")), one_input.quantity)
        if value > 0:
            unit = str(one_input.quantity["unit"])
            ends = (engineering(value * (1 + share), unit) for share in (-PART, PART))
            ranges[one_input.name] = dict(zip(("low", "high"), ends, strict=True))
    return ranges


def label_of(name: str) -> str:
    """What a result is called."""
    about = about_result(name)
    return about.meaning + (f" [{about.unit}]" if about.unit not in ("1", "") else "")


def results_of(state: State) -> dict[str, str]:
    """What can have a band: the state, critical loads, and outputs that the study asks for."""
    names = list(PLAIN)
    if (answer := state.answer) is not None:
        names += [] if answer.contact.two_body else CRITICAL
        names += [column for output in answer.contact.outputs for column in output.columns]
    return {
        name: label_of(name) if name in PLAIN else f"{name}: {label_of(name)}" for name in names
    }


def band_figure(bands: Bands, load: str) -> Figure:
    """Bands between outer and inner quantiles, the median, and the study's own numbers."""
    band = np.array(bands["bands"], float)
    scale = SCALES.get(load, 1.0)
    x = np.array(bands["loads"]) * scale
    q = bands["probabilities"]
    order = np.argsort(q)
    traces: list[Part] = []
    pairs = len(order) // 2
    for k in range(pairs):
        low, high = order[k], order[-1 - k]
        plain: Part = {
            "mode": "lines",
            "line": {"width": 0},
            "type": "scatter",
            "x": json_numbers(x),
        }
        traces.append(
            plain | {"y": json_numbers(band[:, low]), "showlegend": False, "hoverinfo": "skip"}
        )
        traces.append(
            plain
            | {
                "y": json_numbers(band[:, high]),
                "fill": "tonexty",
                "fillcolor": f"rgba(0,114,178,{0.22 + 0.2 * k})",
                "name": f"{percent(q[high] - q[low])} of cases",
            }
        )
    if len(order) % 2:
        traces.append(line(x, band[:, order[pairs]], "median", 0))
    nominal = np.array(bands["nominal"], float)
    style = {"color": GREY, "dash": "dash"}
    traces.append(line(x, nominal, "this study", 1, line=style))
    positive = bool(np.nanmin(band) > 0) and not are_bounded([bands["of"]])
    made = figure(
        traces,
        x=AXES[load],
        y=label_of(bands["of"]),
        title="Bands",
        xlog=load != "d",
        ylog=positive,
        height=420,
    )
    made["layout"]["shapes"] = [mark(bands["at"] * scale, "", dash="solid")[0]]
    return made


def critical_figure(bands: Bands) -> Figure:
    """Each critical load as an interval, its median and the study's own; the load as a line."""
    names = [n if row[-1] else f"{n} (none)" for n, row in bands["critical"].items()]
    rows = list(bands["critical"].values())
    q = bands["probabilities"]
    traces: list[Part] = []
    for k in range(len(q) // 2):
        low, high = (np.array([row[i] for row in rows], float) for i in (k, len(q) - 1 - k))
        traces.append(
            {
                "type": "bar",
                "orientation": "h",
                "y": names,
                "base": plain_data(low),
                "x": plain_data(high - low),
                "width": 0.3 + 0.3 * k,
                "marker": {"color": f"rgba(0,114,178,{0.3 + 0.3 * k})"},
                "name": f"{percent(q[-1 - k] - q[k])} of cases",
            }
        )
    for place, name, symbol, ink in (
        (len(q) // 2, "median", "line-ns", INKS[0]),
        (-1, "this study", "x", INKS[1]),
    ):
        traces.append(
            {
                "type": "scatter",
                "mode": "markers",
                "y": names,
                "x": [row[place] for row in rows],
                "name": name,
                "marker": {
                    "symbol": symbol,
                    "size": 12,
                    "color": ink,
                    "line": {"width": 2, "color": ink},
                },
            }
        )
    made = figure(
        traces, x="load F*", y="", title="Critical loads", height=420, barmode="overlay",
        hovermode="closest",
    )  # fmt: skip
    made["layout"]["yaxis"] |= {"autorange": "reversed", "type": "category"}
    made["layout"]["shapes"] = [mark(bands["F_star_at"], "", dash="solid")[0]]
    return made


def tornado_figure(bands: Bands) -> Figure:
    """One bar an input, from its 5th to its 95th percentile; the strongest on top."""
    middle = bands["nominal_at"]
    labels = list(bands["tornado"])
    traces: list[Part] = []
    for side, (name, colour, pattern) in enumerate(
        (
            ("low end of the input", OKABE_ITO["blue"], ""),
            ("high end of the input", OKABE_ITO["orange"], "/"),
        )
    ):
        ends = [bands["tornado"][label][side] for label in labels]
        traces.append(
            {
                "type": "bar",
                "orientation": "h",
                "y": [wrap_text(bands["words"][label], WIDE) for label in labels],
                "x": [None if v is None or middle is None else v - middle for v in ends],
                "base": middle,
                "name": name,
                "marker": {"color": colour, "pattern": {"shape": pattern}},
                "customdata": [bands["ends"][label][side] for label in labels],
                "hovertemplate": "%{y}: %{customdata}<extra></extra>",
            }
        )
    made = figure(
        traces,
        x=label_of(bands["of"]),
        y="",
        title="One input at a time, at the operating load",
        xlog=False,
        height=200 + 44 * len(labels),
        barmode="overlay",
        hovermode="closest",
    )
    made["layout"]["yaxis"] |= {"autorange": "reversed", "type": "category"}
    made["layout"]["margin"]["l"] = 190
    return made


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """What is uncertain, a button, two figures."""
    return ErrorBars(state).draw


class ErrorBars:
    """Entries for what is uncertain, and the bands that follow."""

    def __init__(self, state: State) -> None:
        self.state = state
        self.said = ui.label().classes("headline second").props('data-fact="error bars"')
        self.assumed = ui.label().classes("hint").props('data-fact="error bars assumed"')
        with ui.row().classes("w-full items-end gap-3"):
            self.of = ui.select(results_of(state), value=PLAIN[0], label="result")
            self.of.props('dense options-dense data-path="error bars.of"').classes("grow")
            self.samples = ui.select([256, 1024, 4096, 16384], value=1024, label="samples")
            self.samples.props("dense").classes("w-24")
        self.load = ""
        """The load that the bands were asked over."""
        self.work = Work(
            "error bars", "Draw error bars", self._ask, self._show, key=self._key, little=_little
        )
        self.of.on_value_change(lambda: self.work.update_preview(state))
        self.box = ui.element("div").classes("figures w-full")
        self.plots: dict[str, ui.plotly] = {}
        with self.box:
            for name in ("bands", "tornado"):
                self.plots[name] = plot_place(name, 380)
        ui.label("What is known of the inputs").classes("subhead")
        ui.label(
            "Without any entry the ranges of the materials library count, where it states some."
        ).classes("hint")
        self.inputs = Inputs(state, self._refresh_entries)
        self.shown_inputs: object = None
        """What the entries show."""
        self._entries()

    def _refresh_entries(self) -> None:
        self._entries.refresh()

    @ui.refreshable_method
    def _entries(self) -> None:
        inputs = self.inputs
        self.shown_inputs = self._inputs_and_ranges()
        inputs.shown.clear()
        with ui.column().classes("w-full gap-2"):
            inputs.uncertain()
            _offer(inputs, self.state)
            inputs.rest = ui.column().classes("w-full")
            inputs.show_mistakes()

    def _inputs_and_ranges(self) -> object:
        return self.state.get("uncertainty", "inputs"), _ranges(self.state)

    def _key(self) -> object:
        state = self.state
        return state.answer, state.get("uncertainty"), str(self.of.value), state.operating_load

    async def _ask(self) -> Asked | None:
        await self.state.settle()
        answer = self.state.answer
        if answer is None:
            return None
        values = answer.loads
        space = np.linspace if answer.load == "d" else np.geomspace
        self.load = answer.load
        study = self.state.study
        if start := assumed_ranges(self.state):
            study = study | {"uncertainty": {"inputs": start}}
        return {
            "study": study,
            "folder": str(self.state.folder),
            "load": answer.load,
            "loads": space(values[0], values[-1], LOADS).tolist(),
            "at": self.state.operating_load,
            "of": str(self.of.value),
            "samples": int(self.samples.value or 1024),
        }

    def _show(self, result: Bands) -> None:
        critical = result["critical"]
        bands = critical_figure(result) if critical else band_figure(result, self.load)
        self.plots["bands"].update_figure(bands)
        self.plots["tornado"].update_figure(tornado_figure(result))
        low, middle, high = result["band_at"][0], result["nominal_at"], result["band_at"][-1]
        meaning = about_result(result["of"]).meaning
        at = f"{meaning[0].upper()}{meaning[1:]} at the operating load"
        start = result["of"] if critical else at
        unit = about_result(result["of"]).unit
        said = (
            f"{start}: {value_of(middle, unit)}, in nine of ten cases between "
            f"{value_of(low, unit)} and {value_of(high, unit)} ({result['samples']} samples)."
            if None not in (low, middle, high)
            else f"{result['of']} is not known at every end of the inputs."
        )
        self.said.set_text(as_shown(said))
        self.box.set_visibility(True)
        self.said.set_visibility(True)

    async def draw(self) -> None:
        if self._inputs_and_ranges() != self.shown_inputs:
            self._refresh_entries()
        self.inputs.show_mistakes()
        options, of = results_of(self.state), self.of
        if options != of.options:
            of.set_options(options, value=of.value if of.value in options else PLAIN[0])
        names = words_of_inputs(self.state, assumed_ranges(self.state))
        self.assumed.set_text(as_shown(ASSUMED.format(", ".join(names))) if names else "")
        self.assumed.set_visibility(bool(names))
        await self.work.update_preview(self.state)
        shown = self.work.done is not None or self.work.trying
        self.box.set_visibility(shown)
        self.said.set_visibility(self.work.done is not None)


def _little(request: Asked) -> Asked:
    return request | {"loads": np.array(request["loads"])[::4].tolist(), "samples": 128}


def words_of_inputs(state: State, names: Iterable[str]) -> list[str]:
    """What inputs are, by meaning and symbol."""
    quantities = {
        one_input.name: one_input.quantity
        for one_input in inputs_of(state.study)
        if one_input.quantity
    }
    return [f"{quantities[name]['meaning']} {quantities[name]['symbol']}" for name in names]


def _ranges(state: State) -> dict[str, dict[str, float]]:
    """Ranges of the materials library, as a study file writes them."""
    if state.answer is None:
        return {}
    stated = stated_ranges(state.answer.contact)
    return {
        name: dict(zip(KINDS[u.kind], (u.first, u.second), strict=True))
        for name, u in stated.items()
    }


def _offer(inputs: Inputs, state: State) -> None:
    """The ranges of the library: what they are, and a button that writes them into the study."""
    ranges, written = _ranges(state), state.get("uncertainty", "inputs")
    if not ranges or state.answer is None:
        said = "The materials library states no range for the materials of this study."
        ui.label(said).classes("hint")
        return
    contact = state.answer.contact
    counts = "is not used, as the study has entries of its own" if written else "counts"
    ui.label(f"What the materials library states {counts}:").classes("hint")
    for name, ends in ranges.items():
        low, high = (value_of(end, unit_of(contact, name)) for end in ends.values())
        ui.label(f"{words_of(contact, name)} between {low} and {high}").classes("hint")
    kept = written if isinstance(written, dict) else {}
    set_attributes(
        ui.button(
            "Take these ranges into the study",
            icon="input",
            on_click=lambda: inputs.change("uncertainty", "inputs", kept | ranges),
        ).props("flat dense no-caps"),
        {"data-take": "ranges"},
    )
