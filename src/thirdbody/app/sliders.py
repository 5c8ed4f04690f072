"""Sliders over the tabs: the load, and the numbers one wants to feel."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from nicegui import ui

import thirdbody as tb

from ..populations.finish import STATED
from ..quantities.say import value_of
from .fields import engineering, number_of
from .inputs import Inputs
from .sizing import size_of, with_size
from .state import Answer, State
from .widgets import put

__all__ = ["Slider", "Sliders", "at_position", "position_of"]

STEPS = 400
REACH = 10.0
"""A slider goes so many times up and down."""


def at_position(loads: np.ndarray, part: float) -> float:
    """The load at a part of the way along the loads of the study, four digits of it."""
    first, last = float(loads[0]), float(loads[-1])
    if part in (0.0, 1.0):
        return last if part else first
    if first > 0:
        value = first * (last / first) ** part
        return float(min(max(float(f"{value:.4g}"), first), last))
    return first + (last - first) * part


def position_of(loads: np.ndarray, at: float) -> float:
    """The inverse of `at_position`."""
    first, last = float(loads[0]), float(loads[-1])
    if first > 0 and at > 0:
        return math.log(at / first) / math.log(last / first)
    return (at - first) / (last - first)


def _load_text(answer: Answer, at: float) -> str:
    """The operating load as a slider says it: as a pressure where it is a load."""
    if answer.load == "d":
        return f"separation d = {value_of(at, 'm')}"
    pressure = at if answer.load == "pressure" else at * answer.contact.E_ss
    return f"load {value_of(pressure, 'Pa')}"


def _length(value: float) -> str:
    return value_of(value, "m")


class Slider(ui.slider):
    """A slider whose value is the user's: no answer of the server to a former place moves it."""

    LOOPBACK = False

    def speak(self, text: str) -> None:
        """What is read out in the place of the position."""
        put(self, {"aria-valuetext": text})


@dataclass
class Knob:
    """One number of the study under a slider."""

    label: str
    place: str
    read: Callable[[], float | None]
    write: Callable[[float], None]
    say: Callable[[float], str]


class Sliders:
    """The strip over the tabs."""

    def __init__(self, state: State) -> None:
        self.state = state
        self.moving = False
        """While a slider sets the study, no slider is set."""
        with ui.row().classes("sliders w-full"):
            with ui.column().classes("slider load gap-0"):
                self.load_label = ui.label("load").classes("hint")
                self.load = Slider(min=0, max=STEPS, step=1, value=STEPS // 2)
                self.load.props('aria-label="load" data-slider="load"')
                self.load.on_value_change(self._load_moved)
            with ui.row().classes("knobs"):
                self.knobs = [self._knob(knob) for knob in self._all()]

    def _all(self) -> list[Knob]:
        sizes = Knob(
            "mean size x_a",
            "particles.size",
            self._size,
            lambda v: self.state.replace(
                with_size(self.state.study, float(f"{v:.3g}")), kind="particles.size"
            ),
            _length,
        )
        amount = Knob(
            "particles per area",
            "particles.areal_density",
            self._density,
            lambda v: self.state.set(
                *Inputs.first_population(self.state), "areal_density", engineering(v, "1/m^2", 3)
            ),
            lambda v: value_of(v, "1/m^2"),
        )
        fields = tb.Roughness.__dataclass_fields__
        return [
            self._rough("σ", "sigma", fields["sigma"].metadata["quantity"]),
            self._rough("Ra", "Ra", STATED["Ra"]),
            self._rough("R", "R", fields["R"].metadata["quantity"]),
            sizes,
            amount,
        ]

    def _rough(self, label: str, name: str, about: dict[str, Any]) -> Knob:
        """A length of the roughness."""

        def read() -> float | None:
            value = number_of(self.state.get("roughness", name), about)
            return value if value > 0 else None

        def write(value: float) -> None:
            self.state.set("roughness", name, engineering(value, "m", 3))

        return Knob(label, f"roughness.{name}", read, write, _length)

    def _size(self) -> float | None:
        state = self.state
        if state.answer is None or state.answer.contact.two_body:
            return None
        known = state.get(*Inputs.first_population(state), "distribution")
        scalable = known not in (None, "mixture", "histogram", "power-law")
        return size_of(state.answer.contact) if scalable else None

    def _density(self) -> float | None:
        about = tb.Particles.__dataclass_fields__["areal_density"].metadata["quantity"]
        place = Inputs.first_population(self.state)
        value = number_of(self.state.get(*place, "areal_density"), about)
        return value if value > 0 else None

    def _knob(self, knob: Knob) -> dict[str, Any]:
        made: dict[str, Any] = {"knob": knob, "middle": None}
        with ui.column().classes("slider gap-0") as box:
            made["label"] = ui.label(knob.label).classes("hint")
            made["slider"] = Slider(min=-STEPS // 2, max=STEPS // 2, step=1, value=0)
            put(made["slider"], {"aria-label": knob.label, "data-slider": knob.place})
        made["box"] = box
        box.set_visibility(False)  # until its number is known

        def moved(event: Any) -> None:
            if self.moving or made["middle"] is None or event.value is None:
                return
            value = made["middle"] * REACH ** (2 * float(event.value) / STEPS)
            now = knob.read()
            if now is not None and abs(value / now - 1) < 2e-3:
                return
            made["own"] = True
            knob.write(value)

        made["slider"].on_value_change(moved)
        return made

    def _load_moved(self, event: Any) -> None:
        answer = self.state.answer
        if self.moving or answer is None or event.value is None:
            return
        self.state.go(at_position(answer.loads, float(event.value) / STEPS))

    def tell(self) -> None:
        """Show where the study is."""
        answer = self.state.answer
        if answer is None:
            return
        self.moving = True
        try:
            at = self.state.at
            part = position_of(answer.loads, at)
            self.load.set_value(round(STEPS * part))
            self.load_label.set_text(_load_text(answer, at))
            self.load.speak(_load_text(answer, at))
            for made in self.knobs:
                self._tell(made)
        finally:
            self.moving = False

    def _tell(self, made: dict[str, Any]) -> None:
        knob: Knob = made["knob"]
        now = knob.read()
        made["box"].set_visibility(now is not None)
        if now is None:
            made["middle"] = None
            return
        # the number and its unit stay in one line
        said = knob.say(now).replace(" ", "\u00a0")
        made["label"].set_text(f"{knob.label} = {said}")
        made["slider"].speak(knob.say(now))
        middle = made["middle"]
        if middle is None or not made.pop("own", False):
            inside = middle is not None and 1 / REACH <= now / middle <= REACH
            made["middle"] = middle if inside else now
            where = round(STEPS / 2 * math.log(now / made["middle"]) / math.log(REACH))
            made["slider"].set_value(where)
