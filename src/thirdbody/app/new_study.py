"""A study from a drawing: bodies and load, surfaces, what is in the oil."""

from __future__ import annotations

import copy
import tomllib
from collections.abc import Callable
from importlib import resources

from nicegui import ui

from ..errors import InvalidValue, ThirdBodyError
from ..populations.finish import STATED, processes
from ..quantities.units import Quantity
from ..study.bearing_file import bearing_file
from ..study.load import FORCE, force_sentences
from ..study.particles import AMOUNT
from ..systems.bodies import BODIES
from .fields import Field, fields_of, number_field
from .inputs import BODIES_BEGUN, Inputs
from .solver import Died
from .soon import Soon
from .state import Answer, State
from .tabs.film import oil_of as oil_of_film
from .tabs.interface import at_once
from .text import with_micro
from .verdict import sentence_of
from .widgets import set_attributes

__all__ = ["KINDS", "OILS", "NewStudy", "first_study", "with_oil"]

KINDS = {
    "ball-bearing": "ball bearing",
    "roller-bearing": "roller bearing",
    "ball-screw": "ball screw",
    "linear-guide": "linear guide",
    "gear": "gears",
    "ball-on-flat": "ball on a flat",
    "ball-in-groove": "ball in a groove",
    "roller": "roller on a flat",
    "cylinders": "two cylinders",
    "flat": "two flat faces under a force",
    "pressure": "two flat faces under a pressure",
}
"""What a drawing may show."""
FILED = ("ball-bearing", "roller-bearing", "ball-screw", "linear-guide", "gear")
"""Those of which the library has a study file to begin with."""
FACES: dict[str, object] = {
    "first": {"Ra": "0.1 um", "process": "lapped"},
    "second": {"Ra": "0.2 um", "process": "ground"},
}
OILS = {
    "code": "dust and steel debris, by an ISO 4406 code",
    "grains": "grains of one kind, so many on an area",
    "room": "dust from the air of a clean room",
    "clean": "nothing: the surfaces alone",
}
DIRT: list[dict[str, object]] = [
    {"name": "dust", "material": "quartz", "iso4406": "18/16/13", "share": 0.1, "gap": "0.5 um"},
    {
        "name": "steel debris",
        "material": "100Cr6",
        "iso4406": "18/16/13",
        "share": 0.9,
        "gap": "0.5 um",
    },
]
PARTICLES: dict[str, object] = {
    "code": DIRT,
    "grains": {
        "material": "quartz",
        "distribution": "log-normal",
        "median": "1 um",
        "gsd": 1.5,
        "areal_density": "1e9 / m^2",
    },
    "room": {
        "material": "quartz",
        "iso14644": 7,
        "exposure": "24 h",
        "particle_density": "2650 kg/m^3",
    },
}
"""What particles begin as, by what is in the oil."""
FIRST = ("shaft_speed", "ring")
"""What a drawing states of a ball bearing beside its designation."""
NUMBERED = ("Bodies and load", "Surfaces", "What is in the oil")


def first_study(kind: str, which: str = "") -> dict[str, object]:
    """The study that a form begins with, for a kind of bodies and, of a ball bearing, which one.

    Raises
    ------
    InvalidValue
        A designation that nobody knows.

    Examples
    --------
    >>> first_study("ball-bearing", "6305")["body"]["bore"], first_study("gear")["body"]["kind"]
    ('25 mm', 'gear')
    """
    if kind in FILED:
        text = resources.files("thirdbody").joinpath(f"data/studies/{kind}.toml").read_text("utf-8")
        study = tomllib.loads(bearing_file(text, which) if which else text)
        study["title"] = f"{KINDS[kind].capitalize()} {which}".strip()
        return study
    loaded: dict[str, object] = {"load": {"force": "20 N"}, "body": BODIES_BEGUN.get(kind)}
    if kind == "pressure":
        loaded = {"load": {"pressure": {"from": "10 kPa", "to": "100 MPa", "points": 200}}}
    study = {
        "title": KINDS[kind].capitalize(),
        "surfaces": {"first": "100Cr6", "second": "100Cr6"},
        "roughness": FACES,
        **loaded,
        "particles": DIRT,
    }
    return copy.deepcopy(study)


def oil_of(study: dict[str, object]) -> str:
    """What is in the oil of a study, as the form says it."""
    particles = study.get("particles")
    first = particles[0] if isinstance(particles, list) else particles
    if not isinstance(first, dict):
        return "clean"
    return "code" if "iso4406" in first else "room" if "iso14644" in first else "grains"


def with_oil(study: dict[str, object], word: str) -> dict[str, object]:
    """The study with something else in its oil.

    >>> sorted(with_oil(first_study("flat"), "clean").keys() & {"particles", "particle_law"})
    []
    """
    rest = {k: v for k, v in study.items() if k not in ("particles", "particle_law")}
    if word not in PARTICLES:
        return rest
    return rest | {"particles": copy.deepcopy(PARTICLES[word])}


def answer_so_far(answer: Answer) -> str:
    """The answer so far: that of the oil, else of the force, else of the pressure."""
    if answer.study.film is not None and (oil := oil_of_film(answer, "")) is not None:
        return oil.sentences[0]
    if answer.study.forces is not None and answer.study.body is not None:
        return " ".join(force_sentences(at_once(answer)[:1]))
    return sentence_of(answer, answer.default_at())


class NewStudy:
    """A form of three steps, the answer below it, and a button that opens the study."""

    def __init__(self, state: State, opened: Callable[[str], None]) -> None:
        self.state, self.opened = state, opened
        """The page, and what is called with the tab that answers the new study first."""
        self.dialog = ui.dialog().props(':maximized="Quasar.Screen.lt.md" full-width')
        self.kind, self.which = "ball-bearing", "6205"
        self.soon = Soon(self._show_answer)

    def open(self) -> None:
        """Show the form, as it was left or with what it begins with."""
        self.dialog.clear()
        self._begin()
        with self.dialog, ui.card().classes("new-study") as card:
            set_attributes(card, {"role": "region", "aria-label": "a new study"})
            with ui.row().classes("w-full items-center justify-between no-wrap"):
                ui.label("A new study, from the drawing").classes("headline")
                close = ui.button(icon="close", on_click=self.dialog.close)
                set_attributes(close.props("flat dense round"), {"aria-label": "close"})
            self.steps = ui.element("div").classes("steps")
            with self.steps:
                self._form()
            self.rest = ui.column().classes("w-full gap-0")
            with ui.row().classes("w-full items-center justify-between gap-3 new-end"):
                self.said = ui.label().classes("so-far").props('role=status data-fact="so far"')
                self.go = ui.button(
                    "Open this study", icon="arrow_forward", on_click=self._open_study
                )
                set_attributes(self.go.props("no-caps"), {"data-path": "new.open"})
        self.dialog.open()
        self.soon()

    def _begin(self) -> None:
        """A draft of its own; the study of the page stays until the form is done."""
        which = self.which if self.kind == "ball-bearing" else ""
        self.draft = State(first_study(self.kind, which), self.state.folder, later=True)
        self.draft.shelf = self.state.shelf
        self.draft.changed.append(self.soon)
        self.inputs = Inputs(self.draft, self._refresh_form)

    def _refresh_form(self) -> None:
        self._form.refresh()

    @ui.refreshable_method
    def _form(self) -> None:
        self.inputs.shown.clear()
        builds = (self._bodies, self._surfaces, self._oil)
        for number, (name, build) in enumerate(zip(NUMBERED, builds, strict=True), 1):
            with set_attributes(
                ui.column().classes("step gap-2"), {"role": "group", "aria-label": name}
            ):
                with ui.row().classes("items-center gap-2 no-wrap"):
                    set_attributes(ui.label(str(number)).classes("number"), {"aria-hidden": "true"})
                    ui.label(name).classes("subhead")
                build()

    # ------------------------------------------------------------------ three steps
    def _bodies(self) -> None:
        inputs = self.inputs
        menu = inputs.select(None, KINDS, self.kind, "what the drawing shows", self._set_kind)
        set_attributes(menu, {"data-path": "new.kind"})
        if self.kind == "ball-bearing":
            size = ui.input("designation", value=self.which).classes("w-full")
            size.props('dense data-path="new.which" hint="6205, 6305-2RS/C3, or 25x52x15 mm"')
            size.on("change", lambda: self._set_size(str(size.value or ""), size))
        if self.draft.get("load", "force") is not None:
            inputs.field(("load",), number_field("force", FORCE))
        else:
            inputs.load()
        body = self.draft.get("body")
        every = [f for f in fields_of(BODIES.get(self.kind, object)) if f.name in (body or {})]
        first = [f for f in every if f.name in FIRST or self.kind != "ball-bearing"]
        for field in first:
            inputs.field(("body",), field)
        if len(first) < len(every):
            with ui.expansion("Dimensions").classes("w-full").props("dense"):
                for field in every:
                    if field not in first:
                        inputs.field(("body",), field)

    def _surfaces(self) -> None:
        inputs = self.inputs
        options = tuple(processes())
        about = "how the face is finished"
        for side in ("first", "second"):
            inputs.material(("surfaces", side), f"{side} body")
            place = ("roughness", side)
            inputs.field(place, number_field("Ra", STATED["Ra"], needed=False))
            kind = Field(name="process", kind="word", label="process", about=about, options=options)
            inputs.field(place, kind)

    def _oil(self) -> None:
        inputs, word = self.inputs, oil_of(self.draft.study)
        menu = inputs.select(None, OILS, word, "what is there", self._set_oil)
        set_attributes(menu, {"data-path": "new.oil"})
        if word == "code":
            self._code()
        elif word != "clean":
            place = inputs.first_population(self.draft)
            inputs.material((*place, "material"), "material")
            names = {"grains": ("median", "gsd"), "room": ()}[word]
            for field in self._fields(*names):
                inputs.field(place, field)
            if word == "room":
                about = "ISO 14644-1, e.g. 7"
                inputs.field(place, Field(name="iso14644", kind="text", label="class", about=about))
                about = "how long it settles"
                inputs.field(
                    place, Field(name="exposure", kind="text", label="exposure", about=about)
                )
            else:
                inputs.field(place, number_field("areal_density", _density(), needed=True))
        if isinstance(oil := self.draft.get("film", "oil"), dict):
            ui.label("The oil").classes("subhead")
            from ..systems.film_formulas import Oil

            for field in fields_of(Oil):
                if field.name in oil:
                    inputs.field(("film", "oil"), field)

    def _fields(self, *names: str) -> list[Field]:
        """Fields of the sizes that are written."""
        from ..study import DISTRIBUTIONS

        return [f for f in fields_of(DISTRIBUTIONS["log-normal"]) if f.name in names]

    def _code(self) -> None:
        """One code for all populations, and how they share it."""
        several = self.draft.get("particles")
        entry = ui.input("ISO 4406 code", value=several[0]["iso4406"]).classes("w-full")
        entry.props('dense data-path="new.code" hint="of the oil, e.g. 18/16/13"')
        entry.on("change", lambda: self._set_in_all("iso4406", str(entry.value or "")))
        for i, population in enumerate(several):
            share = Field(
                name="share",
                kind="text",
                label=f"of them {population.get('name', 'particles')}",
                about="part of the counted particles, 0 to 1",
            )
            self.inputs.field(("particles", i), share)
            self.inputs.material(("particles", i, "material"), "material")
        self.inputs.field(("particles", 0), number_field("gap", AMOUNT["gap"], needed=False))

    # ------------------------------------------------------------------ what happens
    def _set_in_all(self, key: str, value: object) -> None:
        """The same entry in every population."""
        several = self.draft.get("particles")
        if isinstance(several, list):
            self.draft.set("particles", [population | {key: value} for population in several])

    def _set_kind(self, kind: str) -> None:
        self.kind = kind
        self._begin()
        self._refresh_form()
        self.soon()

    def _set_size(self, which: str, entry: ui.input) -> None:
        try:
            first_study(self.kind, which)
        except InvalidValue as error:
            entry.error = with_micro("; ".join(error.problems))
            return
        entry.error = None
        self.which = which
        self._begin()
        self._refresh_form()
        self.soon()

    def _set_oil(self, word: str) -> None:
        self.draft.replace(with_oil(self.draft.study, word))
        self._refresh_form()

    async def _show_answer(self) -> None:
        """The mistakes of the draft, each beside its entry, or its answer so far."""
        draft = self.draft
        try:
            await draft.settle()
            said = (
                await draft.ask(answer_so_far) if draft.current and draft.answer is not None else ""
            )
        except Died as error:
            said = "; ".join(error.problems)
        except ThirdBodyError as error:
            said = str(error)
        if draft is not self.draft or self.go.is_deleted:
            return
        self.inputs.rest = self.rest
        self.inputs.show_mistakes()
        self.go.set_enabled(not draft.problems)
        self.said.set_text(with_micro(said))

    def _open_study(self) -> None:
        self.dialog.close()
        self.state.open(self.draft.study)
        self.opened("film" if self.draft.get("film") is not None else "interface")


def _density() -> Quantity:
    import thirdbody as tb

    about: Quantity = tb.Particles.__dataclass_fields__["areal_density"].metadata["quantity"]
    return about
