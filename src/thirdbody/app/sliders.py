"""Sliders over the tabs: the load, and the numbers one wants to feel."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from nicegui import ui
from nicegui.events import ValueChangeEventArguments

import thirdbody as tb

from ..populations.finish import STATED
from ..quantities.say import value_of
from ..quantities.units import Quantity
from ..study.load import FORCE
from .fields import engineering, number_of
from .inputs import Inputs
from .sizing import size_of, with_size
from .state import Answer, State
from .widgets import set_attributes

__all__ = ["CODES", "CodeKnob", "Slider", "Sliders", "at_position", "position_of", "shift_code"]

STEPS = 400
REACH = 10.0
"""A slider goes so many times up and down."""


def at_position(loads: np.ndarray, fraction: float) -> float:
    """The load at a part of the way along the loads of the study, four digits of it."""
    first, last = float(loads[0]), float(loads[-1])
    if fraction in (0.0, 1.0):
        return last if fraction else first
    if first > 0:
        value = first * (last / first) ** fraction
        return float(min(max(float(f"{value:.4g}"), first), last))
    return first + (last - first) * fraction


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
        set_attributes(self, {"aria-valuetext": text})


@dataclass
class Knob:
    """One number of the study under a slider."""

    label: str
    place: str
    read: Callable[[], float | None]
    write: Callable[[float], None]
    say: Callable[[float], str]
    middle: float | None = None
    """The number in the middle of the slider."""
    moved: bool = False
    """Whether it was the slider that set the number."""

    def build(self) -> None:
        """Put the slider and its label on the page."""
        with ui.column().classes("slider gap-0") as self.box:
            self.text = ui.label(self.label).classes("hint")
            self.slider = Slider(min=-STEPS // 2, max=STEPS // 2, step=1, value=0)
            set_attributes(self.slider, {"aria-label": self.label, "data-slider": self.place})
        self.box.set_visibility(False)  # until its number is known

    def follow(self, position: float) -> None:
        """Set the number by the position of the slider."""
        if self.middle is None:
            return
        value = self.middle * REACH ** (2 * position / STEPS)
        now = self.read()
        if now is not None and abs(value / now - 1) < 2e-3:
            return
        self.moved = True
        self.write(value)

    def show_value(self) -> None:
        """Show the number of the study."""
        now = self.read()
        self.box.set_visibility(now is not None)
        if now is None:
            self.middle = None
            return
        # the number and its unit stay in one line
        said = self.say(now).replace(" ", "\u00a0")
        self.text.set_text(f"{self.label} = {said}")
        self.slider.speak(self.say(now))
        moved_here, self.moved = self.moved and self.middle is not None, False
        if not moved_here:
            inside = self.middle is not None and 1 / REACH <= now / self.middle <= REACH
            self.middle = self.middle if self.middle is not None and inside else now
            where = round(STEPS / 2 * math.log(now / self.middle) / math.log(REACH))
            self.slider.set_value(where)


CODES = re.compile(r"\d+(/\d+){1,2}")
MOST_SHIFTED = 6
"""Classes that an oil goes up and down."""


def shift_code(code: str, classes: int) -> str:
    """A cleanliness code by so many classes, each of which doubles the particles.

    >>> shift_code("18/16/13", 2), shift_code("9/2", -3)
    ('20/18/15', '6/0')
    """
    return "/".join(str(max(int(number) + classes, 0)) for number in code.split("/"))


class CodeKnob(Knob):
    """The number of particles of an oil, in the classes of its ISO 4406 code."""

    def __init__(self, state: State) -> None:
        self.state = state
        self.first = ""
        """The code in the middle of the slider."""
        super().__init__("oil", "particles.iso4406", lambda: None, lambda v: None, str)

    def code(self) -> str:
        """The code of the study; empty where it has none, or several."""
        particles = self.state.get("particles")
        every = particles if isinstance(particles, list) else [particles]
        codes = {
            str(population["iso4406"])
            for population in every
            if isinstance(population, dict) and "iso4406" in population
        }
        code = codes.pop() if len(codes) == 1 else ""
        return code if CODES.fullmatch(code) else ""

    def build(self) -> None:
        """Put the slider on the page; each step of it is a class."""
        super().build()
        set_attributes(self.slider, {"min": -MOST_SHIFTED, "max": MOST_SHIFTED})

    def follow(self, position: float) -> None:
        """Set the code of every population by the position of the slider."""
        code, particles = shift_code(self.first, round(position)), self.state.get("particles")
        if not self.first or code == self.code():
            return
        self.moved = True
        several = particles if isinstance(particles, list) else [particles]
        new = [
            population | {"iso4406": code} if "iso4406" in population else population
            for population in several
        ]
        study = self.state.study | {"particles": new if isinstance(particles, list) else new[0]}
        self.state.replace(study, kind=self.place)

    def show_value(self) -> None:
        """Show the code of the study."""
        code = self.code()
        self.box.set_visibility(bool(code))
        self.text.set_text(f"oil {code}")
        self.slider.speak(code)
        moved_here, self.moved = self.moved, False
        if moved_here or not code:
            return
        here = [n for n in range(-MOST_SHIFTED, MOST_SHIFTED + 1) if self.first]
        fitting = [n for n in here if shift_code(self.first, n) == code]
        self.first = self.first if fitting else code
        self.slider.set_value(fitting[0] if fitting else 0)


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
                self.knobs = [self._knob(knob) for knob in self._knobs()]

    def _knobs(self) -> list[Knob]:
        sizes = Knob(
            "mean size",
            "particles.size",
            self._size,
            lambda v: self.state.replace(
                with_size(self.state.study, float(f"{v:.3g}")), kind="particles.size"
            ),
            _length,
        )
        amount = Knob(
            "particles",
            "particles.areal_density",
            self._density,
            lambda v: self.state.set(
                *Inputs.first_population(self.state), "areal_density", engineering(v, "1/m^2", 3)
            ),
            lambda v: value_of(v, "1/m^2"),
        )
        fields = tb.Roughness.__dataclass_fields__
        return [
            self._force(),
            self._rough("σ", "sigma", fields["sigma"].metadata["quantity"]),
            self._rough("Ra", "Ra", STATED["Ra"]),
            self._rough("Ra, first", "first.Ra", STATED["Ra"]),
            self._rough("Ra, second", "second.Ra", STATED["Ra"]),
            self._rough("R", "R", fields["R"].metadata["quantity"]),
            sizes,
            amount,
            CodeKnob(self.state),
        ]

    def _force(self) -> Knob:
        """The one force of the study."""

        def read() -> float | None:
            value = number_of(self.state.get("load", "force"), FORCE)
            return value if value > 0 else None

        def write(value: float) -> None:
            self.state.set("load", "force", f"{float(f'{value:.3g}'):g} N")

        return Knob("force", "load.force", read, write, lambda v: value_of(v, "N"))

    def _rough(self, label: str, name: str, about: Quantity) -> Knob:
        """A length of the roughness."""

        place = ("roughness", *name.split("."))

        def read() -> float | None:
            value = number_of(self.state.get(*place), about)
            return value if value > 0 else None

        def write(value: float) -> None:
            self.state.set(*place, engineering(value, "m", 3))

        return Knob(label, f"roughness.{name}", read, write, _length)

    def _size(self) -> float | None:
        state = self.state
        if state.answer is None or state.answer.contact.two_body:
            return None
        distribution = state.get(*Inputs.first_population(state), "distribution")
        scalable = distribution not in (None, "mixture", "histogram", "power-law")
        return size_of(state.answer.contact) if scalable else None

    def _density(self) -> float | None:
        about = tb.Particles.__dataclass_fields__["areal_density"].metadata["quantity"]
        place = Inputs.first_population(self.state)
        value = number_of(self.state.get(*place, "areal_density"), about)
        return value if value > 0 else None

    def _knob(self, knob: Knob) -> Knob:
        def follow_slider(event: ValueChangeEventArguments[float | None]) -> None:
            if not self.moving and event.value is not None:
                knob.follow(float(event.value))

        knob.build()
        knob.slider.on_value_change(follow_slider)
        return knob

    def _load_moved(self, event: ValueChangeEventArguments[float | None]) -> None:
        answer = self.state.answer
        if self.moving or answer is None or event.value is None:
            return
        self.state.go(at_position(answer.loads, float(event.value) / STEPS))

    def show_study(self) -> None:
        """Show where the study is."""
        answer = self.state.answer
        if answer is None:
            return
        self.moving = True
        try:
            at = self.state.operating_load
            fraction = position_of(answer.loads, at)
            self.load.set_value(round(STEPS * fraction))
            self.load_label.set_text(_load_text(answer, at))
            self.load.speak(_load_text(answer, at))
            for knob in self.knobs:
                knob.show_value()
        finally:
            self.moving = False
