"""An oil over time under three sliders: flow and service of its filter, and what enters it."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from nicegui import ui

from ...quantities.say import number
from ...study.life import AskedLife, oil_of
from ...study.run_life import NEEDED, LifeResult
from ...study.whole import read_tables
from ...systems.life.history import LifeHistory
from ...systems.life.oil_history import run_oil_history
from ...views.life_amounts import flow_of
from ...views.life_words import answer as words_of
from ...views.life_words import events, facts
from ..figures import CLEAR, CONFIG, GREY, INKS, Figure, figure, line
from ..sliders import Slider
from ..state import Answer, State
from ..text import as_shown
from ..widgets import Facts, Plot, set_attributes

__all__ = ["START", "TITLE", "LifeShown", "build", "contents_of", "words_of_oil"]

TITLE = "Life"
START: dict[str, object] = {
    "duration": "2000 h",
    "oil": {
        "volume": "200 L",
        "material": "quartz",
        "start": "20/18/15",
        "ingress": {"test_dust": "A3-lot", "rate": "125 mg/h"},
    },
    "filters": [
        {"flow": "60 L/min", "beta": {"4 um": 5, "7 um": 75, "14 um": 1000}, "capacity": "50 g"}
    ],
}
"""The table where the study has none."""
POINTS, HOUR, LITRE_PER_MINUTE = 60, 3600.0, 1e-3 / 60
STEPS, REACH = 60, 10.0
"""A slider goes so many steps each way, and so many times up and down."""
SERVICE_STEPS = 30
"""The slider of the service goes down by a 40th a step."""
NAMES = ("flow", "service", "ingress")


class LifeShown(NamedTuple):
    """What is shown of an oil."""

    answer: list[str]
    facts: list[tuple[str, str]]
    history: Figure
    flows: Figure
    labels: dict[str, str]
    """What each slider says."""
    notes: list[str]


@cache
def _start() -> AskedLife:
    """The oil where the study has none."""
    return read_tables({"life": START}, Path(), oil_of, NEEDED)


def _scale_oil(request: AskedLife, flow: float, service: float, ingress: float) -> AskedLife:
    """The oil with its sliders where they are: factors on what the study says."""
    circuit = request.circuit
    changes: dict[str, object] = {}
    for i, oil_filter in enumerate(circuit.filters):
        assert oil_filter.flow is not None
        changes[f"filters.{i}.flow"] = flow * oil_filter.flow
        changes[f"filters.{i}.service"] = service * oil_filter.service
    entering = tuple(
        source.replace(
            **{
                name: ingress * getattr(source, name)
                for name in ("rate", "steady")
                if getattr(source, name) is not None
            }
        )
        for source in circuit.ingress
    )
    circuit = circuit.replace(ingress=entering, **changes)
    return AskedLife(
        title=request.title, circuit=circuit, duration=request.duration, until=request.until
    )


def _oil_of(answer: Answer) -> AskedLife | None:
    """The oil of a study; None where it has none, or asks for a dry contact."""
    request = answer.study.life
    return request if isinstance(request, AskedLife) else None


def contents_of(
    answer_of_study: Answer, flow: float = 1.0, service: float = 1.0, ingress: float = 1.0
) -> LifeShown:
    """The answer in words, numbers, the course of the code, and the flows of dirt."""
    request = _scale_oil(_oil_of(answer_of_study) or _start(), flow, service, ingress)
    times = np.concatenate([[0.0], np.geomspace(1e-5, 1.0, POINTS) * request.duration])
    times[-1] = request.duration
    history = run_oil_history(
        request.circuit, duration=request.duration, until=request.until, times=times
    )
    result = LifeResult(asked=request, history=history)
    return LifeShown(
        answer=words_of(result),
        facts=list(facts(history).items()),
        history=_course(history),
        flows=_flows(history),
        labels=_labels(request),
        notes=[*events(history), *history.warnings],
    )


def _labels(request: AskedLife) -> dict[str, str]:
    """What the sliders say."""
    circuit = request.circuit
    flow = sum(oil_filter.flow or 0.0 for oil_filter in circuit.filters)
    service = circuit.filters[0].service if circuit.filters else 1.0
    rates = [source.mass_rate for source in circuit.ingress]
    entering = flow_of(float(np.nansum(rates))) if rates else "none"
    return {
        "flow": f"filter flow = {number(flow / LITRE_PER_MINUTE, 3)} L/min",
        "service": f"ln β in service = {number(100 * service, 3)} % of the data sheet",
        "ingress": f"ingress = {entering}",
    }


def _course(history: LifeHistory) -> Figure:
    """Counts over time."""
    hours = np.maximum(history.times, 0.5 * history.times[1]) / HOUR
    names = ("from 4 µm", "from 6 µm", "from 14 µm")
    traces = [
        line(hours, np.where(counts > 0, counts / 1e6, np.nan), name, i)
        for i, (name, counts) in enumerate(zip(names, history.counts.T, strict=True))
    ]
    return figure(
        traces, x="time [h]", y="particles per mL", title="How dirty the oil is", ylog=True
    )


def _flows(history: LifeHistory) -> Figure:
    """Where the dirt came from and where it went; widths are masses."""
    ledger = history.ledger
    came = {"in the oil before": ledger.in_oil[0]} | {k: v[-1] for k, v in ledger.came.items()}
    went = {k: v[-1] for k, v in ledger.went.items()} | {"in the oil now": ledger.in_oil[-1]}
    names = [*came, "oil", *went]
    middle = len(came)
    sources = [*range(len(came)), *[middle] * len(went)]
    targets = [*[middle] * len(came), *range(middle + 1, len(names))]
    grams = [1e3 * float(mass) for mass in (*came.values(), *went.values())]
    trace: dict[str, object] = {
        "type": "sankey",
        "node": {
            "label": names,
            "color": [INKS[i % len(INKS)] for i in range(len(names))],
            "thickness": 14,
            "pad": 14,
        },
        "link": {
            "source": sources,
            "target": targets,
            "value": grams,
            "color": "rgba(127,127,127,0.35)",
        },
        "valuesuffix": " g",
        "valueformat": ".3g",
    }
    made = figure([], x="", y="", title="Where the dirt goes", xlog=False)
    made["data"] = [trace]
    made["layout"]["xaxis"] = {"visible": False}
    made["layout"]["yaxis"] = {"visible": False}
    made["layout"]["showlegend"] = False
    made["layout"]["paper_bgcolor"] = CLEAR
    made["layout"]["font"] = {"color": GREY, "size": 12}
    made["config"] = CONFIG
    return made


def words_of_oil(answer: Answer) -> str:
    """Words that say where the oil is not that of the study."""
    if _oil_of(answer) is not None:
        return ""
    shown = "Shown for 200 L of oil with one filter of 60 L/min"
    if answer.study.life is not None:
        return f"{shown}: this page shows oils only; thirdbody life answers for the dry contact."
    return f"{shown}; a table [life] in the study takes its place (thirdbody new oil-circuit)."


class LifeTab:
    """The answer, three sliders, two figures."""

    def __init__(self, state: State) -> None:
        self.state, self.tab = state, state.tab
        self.answer: Answer | None = None
        self.words = ui.column().classes("w-full gap-1")
        ui.label(
            "How dirty does the oil become, which filter is enough, and where does the dirt go? "
            "What enters, nobody can predict: move it, or take it from reports of the oil "
            "(thirdbody life STUDY.toml --reports oil.csv)."
        ).classes("hint")
        self.shown_for = ui.label("").classes("hint")
        self.sliders: dict[str, Slider] = {}
        self.texts: dict[str, ui.label] = {}
        with ui.row().classes("sliders w-full"):
            for name in NAMES:
                with ui.column().classes("slider gap-0"):
                    self.texts[name] = ui.label(name).classes("hint")
                    low, high = (-SERVICE_STEPS, 0) if name == "service" else (-STEPS, STEPS)
                    slider = Slider(min=low, max=high, step=1, value=0)
                    set_attributes(slider, {"aria-label": name, "data-slider": f"life.{name}"})
                    slider.on_value_change(self._show_scaled)
                    self.sliders[name] = slider
        self.facts = Facts()
        with ui.element("div").classes("figures w-full"):
            self.course, self.flows = Plot("life"), Plot("life-flows")
        self.notes = ui.column().classes("w-full gap-0")

    def _factors(self) -> tuple[float, float, float]:
        """What the sliders multiply."""
        flow, service, ingress = (float(self.sliders[name].value) for name in NAMES)
        return REACH ** (flow / STEPS), 1 + service / 40, REACH ** (ingress / STEPS)

    async def _show_scaled(self) -> None:
        if self.state.answer is not None:
            await self._show()

    async def draw(self) -> None:
        """The answer of the study as it is now."""
        answer = self.state.answer
        assert answer is not None
        if answer is self.answer:
            return
        self.answer = answer
        self.shown_for.set_text(words_of_oil(answer))
        await self._show()

    async def _show(self) -> None:
        flow, service, ingress = self._factors()
        shown: LifeShown = await self.state.ask(contents_of, flow, service, ingress)
        self.words.clear()
        with self.words:
            for i, text in enumerate(shown.answer):
                said = ui.label(as_shown(text)).classes("whole-contact" if i == 0 else "")
                set_attributes(said, {"data-fact": f"life: answer {i}"})
        self.facts.show(shown.facts)
        for name, text in shown.labels.items():
            self.texts[name].set_text(as_shown(text))
            self.sliders[name].speak(text)
        await self.course.show(shown.history)
        await self.flows.show(shown.flows)
        self.notes.clear()
        with self.notes:
            for text in shown.notes:
                ui.label(as_shown(text)).classes("hint")


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """The answer, sliders, the course of the code and the flows of dirt."""
    return LifeTab(state).draw
