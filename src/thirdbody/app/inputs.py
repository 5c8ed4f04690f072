"""The fields of a page: an entry for everything a study file can say, mistakes beside it."""

from __future__ import annotations

from nicegui import events, ui

import thirdbody as tb

from ..analysis.uncertainty.inputs import KINDS
from ..errors import InvalidValue
from ..populations.finish import STATED, processes
from ..quantities.units import say
from ..study import LOADS
from ..study.inputs import inputs_of
from ..study.load import FORCE
from ..study.roughness import is_drawn
from ..systems.bodies import BODIES
from .bounds import LARGEST_TABLE
from .entries import Place, dotted_name
from .fields import VARIANTS, Field, fields_of, number_field, text_of, value_from
from .particle_inputs import ParticleInputs
from .text import with_micro
from .uploads import take
from .widgets import set_attributes, upload

__all__ = ["FORMED", "Inputs"]

FORMED = (
    "title", "materials", "surfaces", "roughness", "asperity_law", "particles", "particle_law",
    "outputs", "load", "body",
)  # fmt: skip
"""Tables of a study file that have forms; every other can be written as text."""
HEIGHTS_GIVEN = {
    "sigma": "σ and R of the surface",
    "pair": "Ra, Rq or Rz of the drawing",
    "faces": "Ra, Rq or Rz of each face",
}
ROUGHNESS_BEGUN: dict[str, dict[str, object]] = {
    "sigma": {"sigma": "100 nm", "R": "2.8 um"},
    "pair": {"Ra": "0.1 um", "process": "lapped"},
    "faces": {
        "first": {"Ra": "0.2 um", "process": "ground"},
        "second": {"Ra": "0.1 um", "process": "lapped"},
    },
}
LOAD_WORDS = {
    "F_star": "F_star: load F/(A_n E*)",
    "pressure": "pressure: nominal",
    "separation": "separation d",
    "force": "force: on a ball, a roller or a face",
}
LOADS_BEGUN: dict[str, object] = {
    "F_star": {"from": 5e-7, "to": 2.4e-4, "points": 200, "spacing": "log"},
    "pressure": {"from": "50 kPa", "to": "20 MPa", "points": 200, "spacing": "log"},
    "separation": {"from": "100 nm", "to": "500 nm", "points": 200, "spacing": "linear"},
    "force": "5 N",
}
BODIES_BEGUN: dict[str, dict[str, object]] = {
    "ball-on-flat": {"kind": "ball-on-flat", "diameter": "6 mm"},
    "ball-in-groove": {"kind": "ball-in-groove", "diameter": "6 mm", "conformity": 0.52},
    "roller": {"kind": "roller", "diameter": "10 mm", "length": "12 mm"},
    "cylinders": {
        "kind": "cylinders",
        "first_diameter": "10 mm",
        "second_diameter": "20 mm",
        "length": "10 mm",
    },
    "flat": {"kind": "flat", "area": "1 cm^2"},
    "ball-bearing": {
        "kind": "ball-bearing",
        "bore": "25 mm",
        "outer_diameter": "52 mm",
        "ball_diameter": "7.938 mm",
        "balls": 9,
    },
    "roller-bearing": {
        "kind": "roller-bearing",
        "bore": "25 mm",
        "outer_diameter": "52 mm",
        "roller_diameter": "7.5 mm",
        "length": "7.5 mm",
        "rollers": 12,
    },
    "ball-screw": {
        "kind": "ball-screw",
        "diameter": "6.35 mm",
        "pitch_diameter": "40 mm",
        "lead": "10 mm",
        "balls": 60,
    },
    "linear-guide": {"kind": "linear-guide", "diameter": "4 mm", "rows": 2, "balls": 12},
    "gear": {
        "kind": "gear",
        "pinion_teeth": 20,
        "wheel_teeth": 60,
        "module": "2 mm",
        "face_width": "20 mm",
    },
}
"""How a table begins that is chosen in a menu."""


def in_words(entry: object) -> str:
    """What is known of an input.

    >>> in_words({"low": "95 nm", "high": "105 nm"})
    'between 95 nm and 105 nm'
    >>> in_words({"mean": "5 GPa", "std": "0.3 GPa"}), in_words({"median": "1 um", "gsd": 1.5})
    ('5 GPa ± 0.3 GPa', '1 µm, two of three cases within a factor of 1.5')
    """
    if isinstance(entry, dict) and len(entry) == 2:
        keys, (one, two) = list(entry), map(text_of, entry.values())
        if keys == ["low", "high"]:
            return f"between {one} and {two}"
        if keys == ["mean", "std"]:
            return f"{one} ± {two}"
        if keys == ["median", "gsd"]:
            return f"{one}, two of three cases within a factor of {two}"
    return say(entry)


class Inputs(ParticleInputs):
    """Widgets bound to entries of the study; after every change each shows its own mistake."""

    def surfaces(self) -> None:
        """Both bodies."""
        for side in ("first", "second"):
            self.material(("surfaces", side), f"{side} surface")

        async def take_table(event: events.UploadEventArguments) -> None:
            try:
                self.change("materials", await take(self.state, event))
            except InvalidValue as error:
                ui.notify("; ".join(error.problems))

        about = "a file, dropped below"
        self.field((), Field(name="materials", kind="string", label="own materials", about=about))
        made = upload("materials", "Own materials", LARGEST_TABLE, take_table, most=None)
        made.props('accept=".toml,text/plain"')

    def asperity_law(self) -> None:
        """What one asperity does."""
        self.variant(("asperity_law",), VARIANTS["asperity"], "zmc", "law of asperities")

    def roughness(self) -> None:
        """The rough surface."""
        if self.state.get("roughness", "topography") is not None:
            ui.label("The roughness is that of a measured file, or of two faces.").classes("hint")
            self.other_fields("roughness")
            ui.button("Numbers instead", on_click=self._numbers).props("flat dense")
            return
        table = self.table("roughness")
        stated = "faces" if {"first", "second"} & table.keys() else "pair"
        self.select(
            None,
            HEIGHTS_GIVEN,
            stated if is_drawn(table) else "sigma",
            "heights given as",
            lambda word: self.change("roughness", ROUGHNESS_BEGUN[word]),
        )
        if is_drawn(table):
            self._drawing_fields(stated == "faces")
        for field in fields_of(tb.Roughness):
            if not is_drawn(table):
                self.field(("roughness",), field)
            elif field.quantity is not None and field.name != "sigma":
                better = number_field(field.name, field.quantity, field.default, needed=False)
                self.field(("roughness",), better)
        self.variant(("roughness", "heights"), VARIANTS["heights"], "gaussian", "heights")
        self.ellipticity()

    def _drawing_fields(self, faces: bool) -> None:
        """What a drawing states, of the pair or of each face."""
        process = Field(
            name="process",
            kind="word",
            label="process",
            about="how the face is finished",
            options=tuple(processes()),
        )
        for place in (("first",), ("second",)) if faces else ((),):
            for face in place:
                ui.label(f"{face} face").classes("subhead")
            for name, about in STATED.items():
                self.field(("roughness", *place), number_field(name, about, needed=False))
            self.field(("roughness", *place), process)

    def ellipticity(self) -> None:
        """Round tips, classes of elliptic ones, or two faces at an angle."""
        place: Place = ("roughness", "ellipticity")
        now = self.state.get(*place)
        starts: dict[str, object] = {
            "": None,
            "ratios": {"ratios": [1, 2, 5], "weights": [5, 3, 2]},
            "faces": {"first": 4, "second": 2, "angle": "30 deg"},
        }
        words = {"": "round", "ratios": "classes of ratios", "faces": "two faces at an angle"}
        faces = isinstance(now, dict) and bool({"first", "second", "angle"} & set(now))
        chosen = "" if now is None else "faces" if faces else "ratios"
        self.select(
            place, words, chosen, "shape of the tips", lambda w: self.change(*place, starts[w])
        )
        if now is not None:
            self.other_fields("roughness", "ellipticity")

    def _numbers(self) -> None:
        answer = self.state.answer
        if answer is not None:
            rough = answer.contact.roughness
            new = {"sigma": rough.sigma, "R": rough.R, "alpha": rough.alpha, "eta": rough.density}
            self.change("roughness", new)

    def load(self) -> None:
        """Which load, and its values; under a force the bodies that it presses."""
        table = self.table("load")
        kind = next((name for name in LOADS_BEGUN if name in table), "pressure")
        self.select(None, LOAD_WORDS, kind, "load", self._set_load_kind)
        self._values(kind)
        if kind == "force":
            self.body()

    def _set_load_kind(self, kind: str) -> None:
        """Another kind of load; bodies come and go with the force."""
        study = {key: value for key, value in self.state.study.items() if key != "body"}
        body = {"body": self.state.get("body") or BODIES_BEGUN["ball-on-flat"]}
        self.state.replace(
            study | {"load": {kind: LOADS_BEGUN[kind]}} | (body if kind == "force" else {})
        )
        self.again()

    def _values(self, kind: str) -> None:
        """One value of the load, several, or a range."""
        place: Place = ("load", kind)
        about = FORCE if kind == "force" else VARIANTS["load"][kind]
        if not isinstance(self.state.get(*place), dict):
            said = "one value, or several with commas between"
            self.field(("load",), Field(name=kind, kind="text", label=kind, about=said))
            start = LOADS_BEGUN[kind]
            if isinstance(start, dict):
                wide = ui.button("A range", on_click=lambda: self.change("load", {kind: start}))
                wide.props("flat dense")
            return
        for end in ("from", "to"):
            self.field(place, number_field(end, about))
        self.field(
            place, Field(name="points", kind="text", label="points", about="how many values")
        )
        self.field(
            place,
            Field(
                name="spacing",
                kind="word",
                label="spacing",
                about="of the values",
                options=("log", "linear"),
            ),
        )
        if kind == "force":
            one: object = LOADS_BEGUN[kind]
        else:
            one = self.state.operating_load if self.state.answer is not None else 1e-5
        single = ui.button("One value", on_click=lambda: self.change("load", {kind: one}))
        single.props("flat dense")

    def body(self) -> None:
        """What the force presses together."""
        kind = self.state.get("body", "kind")
        kind = kind if isinstance(kind, str) else ""
        self.select(
            ("body", "kind"),
            {name: name for name in BODIES},
            kind,
            "bodies",
            lambda word: self.change("body", BODIES_BEGUN[word]),
        )
        for field in fields_of(BODIES[kind]) if kind in BODIES else ():
            self.field(("body",), field)

    def output_switches(self) -> None:
        """A switch for every output of the library."""
        for name, kind in VARIANTS["outputs"].items():
            place: Place = ("outputs", name)
            box = ui.switch(
                str(getattr(kind, "title", name)), value=self.state.get(*place) is not None
            )
            set_attributes(box, {"data-path": dotted_name(place)})
            box.on_value_change(lambda e, p=place: self._switch(p, e.value))

    def output_numbers(self) -> None:
        """The numbers of every output that is on."""
        for name, kind in VARIANTS["outputs"].items():
            place: Place = ("outputs", name)
            if self.state.get(*place) is None:
                continue
            with ui.column().classes("w-full gap-1"):
                ui.label(str(getattr(kind, "title", name))).classes("subhead")
                self._of_output(place, fields_of(kind))

    def _of_output(self, place: Place, every: list[Field]) -> None:
        """The numbers of an output; what has a default and is not given is folded."""
        folded = [
            f for f in every if f.default is not None and self.state.get(*place, f.name) is None
        ]
        for field in every:
            if field not in folded:
                self.field(place, field)
        if folded:
            with ui.expansion("more").classes("w-full").props("dense"):
                for field in folded:
                    self.field(place, field)

    def _switch(self, place: Place, on: bool) -> None:
        wanted = dict(self.table("outputs"))
        if on:
            kind = VARIANTS["outputs"][str(place[1])]
            wanted[str(place[1])] = {}
            for other in getattr(kind, "needs", ()):
                wanted.setdefault(other, {})
        else:
            wanted.pop(str(place[1]), None)
        self.change("outputs", wanted or None)

    # ------------------------------------------------------------------ uncertainty
    def uncertain(self) -> None:
        """What is known of the inputs: a row each."""
        numbers = [e for e in inputs_of(self.state.study) if e.quantity and not e.idle]
        meanings = {e.name: str(e.quantity["meaning"]) for e in numbers if e.quantity}
        names = {name: f"{name}: {meaning}" for name, meaning in meanings.items()}
        given_loads = [name for name in LOADS if self.state.get("load", name) is not None]
        names |= {f"load.{name}": f"load.{name}" for name in given_loads}
        ranges = self.table("uncertainty", "inputs")
        flat = _flat(ranges)
        for label, entry in flat.items():
            with ui.row().classes("w-full items-center no-wrap gap-2"):
                with ui.column().classes("grow gap-0"):
                    parts = dict.fromkeys(meanings.get(name, name) for name in label.split("+"))
                    ui.label(f"{', '.join(parts)}: {with_micro(in_words(entry))}")
                    ui.label(label).classes("hint break-any")
                drop = ui.button(
                    icon="delete", on_click=lambda _, k=label: self._set_uncertainty(k, None)
                )
                set_attributes(drop.props("flat dense"), {"aria-label": f"remove {label}"})
        kinds = {
            "uniform": "between two values",
            "log-uniform": "between two values, over decades",
            "normal": "mean and standard deviation",
            "lognormal": "median and geometric deviation",
        }
        with ui.row().classes("w-full items-end gap-2"):
            which = ui.select(names, label="input, or several that move together", multiple=True)
            which.set_value(list(names)[:1])
            which.props('dense options-dense data-path="uncertain.name"').classes("wide")
            how = (
                ui.select(
                    {kind: kinds.get(kind, kind) for kind in KINDS},
                    label="what is known",
                    value="uniform",
                )
                .props("dense options-dense")
                .classes("wide")
            )
            first = ui.input("low, mean or median").props('dense data-path="uncertain.first"')
            second = ui.input("high, std or gsd").props('dense data-path="uncertain.second"')

            def add() -> None:
                kind = str(how.value)
                keys = KINDS[kind]
                values = [value_from(first.value or ""), value_from(second.value or "")]
                entry = dict(zip(keys, values, strict=False))
                if kind == "log-uniform":
                    entry["spacing"] = "log"
                self._set_uncertainty("+".join(which.value), entry)

            ui.button("Add", icon="add", on_click=add).props('dense data-path="uncertain.add"')

    def _set_uncertainty(self, label: str, entry: dict[str, object] | None) -> None:
        flat = _flat(self.table("uncertainty", "inputs"))
        flat.pop(label, None)
        if entry is not None:
            flat[label] = entry
        table = self.table("uncertainty")
        self.change("uncertainty", table | {"inputs": flat} if flat else None)


def _flat(tree: dict[str, object], path: str = "") -> dict[str, object]:
    """Uncertain inputs by their dotted names."""
    out: dict[str, object] = {}
    for name, value in tree.items():
        where = f"{path}.{name}" if path else name
        if isinstance(value, dict) and any(isinstance(entry, dict) for entry in value.values()):
            out |= _flat(value, where)
        else:
            out[where] = value
    return out
