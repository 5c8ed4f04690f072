"""The fields of a page: an entry for everything a study file can say, mistakes beside it."""

from __future__ import annotations

from typing import Any

from nicegui import events, ui

import thirdbody as tb

from ..analysis.uncertainty.inputs import KINDS
from ..errors import InvalidValue
from ..quantities.units import say
from ..study import LOADS
from ..study.inputs import inputs_of
from .bounds import LARGEST_TABLE
from .entries import Place, dotted
from .fields import VARIANTS, Field, fields_of, number_field, value_from
from .particle_inputs import ParticleInputs
from .text import with_micro
from .uploads import keep
from .widgets import put, upload

__all__ = ["FORMED", "Inputs"]

FORMED = (
    "title", "materials", "surfaces", "roughness", "asperity_law", "particles", "particle_law",
    "outputs", "load",
)  # fmt: skip
"""Tables of a study file that have forms; every other can be written as text."""


class Inputs(ParticleInputs):
    """Widgets bound to entries of the study; after every change each shows its own mistake."""

    def surfaces(self) -> None:
        """Both bodies."""
        for side in ("first", "second"):
            self.material(("surfaces", side), f"{side} surface")

        async def uploaded(event: events.UploadEventArguments) -> None:
            try:
                self.change("materials", await keep(self.state.folder, event))
            except InvalidValue as error:
                ui.notify("; ".join(error.problems))

        about = "a file, dropped below"
        self.field((), Field(name="materials", kind="string", label="own materials", about=about))
        made = upload(
            "materials",
            "Own materials",
            max_file_size=LARGEST_TABLE,
            on_upload=uploaded,
            on_rejected=lambda: ui.notify(f"more than {LARGEST_TABLE} bytes are not taken"),
        )
        made.props('accept=".toml,text/plain"')

    def asperity_law(self) -> None:
        """What one asperity does."""
        self.variant(("asperity_law",), VARIANTS["asperity"], "zmc", "law of asperities")

    def roughness(self) -> None:
        """The rough surface."""
        if self.state.get("roughness", "topography") is not None:
            ui.label("The roughness is that of a measured file, or of two faces.").classes("hint")
            self.known("roughness")
            ui.button("Numbers instead", on_click=self._numbers).props("flat dense")
            return
        for each in fields_of(tb.Roughness):
            self.field(("roughness",), each)
        self.variant(("roughness", "heights"), VARIANTS["heights"], "gaussian", "heights")
        self.ellipticity()

    def ellipticity(self) -> None:
        """Round tips, classes of elliptic ones, or two faces at an angle."""
        place: Place = ("roughness", "ellipticity")
        now = self.state.get(*place)
        starts: dict[str, Any] = {
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
            self.known("roughness", "ellipticity")

    def _numbers(self) -> None:
        answer = self.state.answer
        if answer is not None:
            rough = answer.contact.roughness
            new = {"sigma": rough.sigma, "R": rough.R, "alpha": rough.alpha, "eta": rough.density}
            self.change("roughness", new)

    def load(self) -> None:
        """Which load, and its values."""
        table = self.table("load")
        kind = next((name for name in VARIANTS["load"] if name in table), "pressure")
        starts = {
            "F_star": {"from": 5e-7, "to": 2.4e-4, "points": 200, "spacing": "log"},
            "pressure": {"from": "50 kPa", "to": "20 MPa", "points": 200, "spacing": "log"},
            "separation": {"from": "100 nm", "to": "500 nm", "points": 200, "spacing": "linear"},
        }
        words = {
            "F_star": "F_star: load F/(A_n E*)",
            "pressure": "pressure: nominal",
            "separation": "separation d",
        }
        self.select(
            None, words, kind, "load", lambda word: self.change("load", {word: starts[word]})
        )
        place: Place = ("load", kind)
        about = VARIANTS["load"][kind]
        if not isinstance(self.state.get(*place), dict):
            said = "one value, or several with commas between"
            self.field(("load",), Field(name=kind, kind="text", label=kind, about=said))
            ui.button("A range", on_click=lambda: self.change("load", {kind: starts[kind]})).props(
                "flat dense"
            )
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
        at = self.state.at if self.state.answer is not None else 1e-5
        ui.button("One value", on_click=lambda: self.change("load", {kind: at})).props("flat dense")

    def outputs(self) -> None:
        """Every output of the library: a switch, then its numbers."""
        for name, kind in VARIANTS["outputs"].items():
            place: Place = ("outputs", name)
            on = self.state.get(*place) is not None
            box = ui.switch(str(getattr(kind, "title", name)), value=on)
            put(box, {"data-path": dotted(place)})
            box.on_value_change(lambda e, p=place: self._switch(p, e.value))
            if on:
                with ui.column().classes("w-full pl-4 gap-1"):
                    for each in fields_of(kind):
                        self.field(place, each)

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
        names = [e.name for e in inputs_of(self.state.study) if e.quantity and not e.idle]
        names += [f"load.{name}" for name in LOADS if self.state.get("load", name) is not None]
        given = self.table("uncertainty", "inputs")
        flat = _flat(given)
        for label, entry in flat.items():
            with ui.row().classes("w-full items-center no-wrap gap-2"):
                ui.label(label).classes("grow break-all")
                ui.label(with_micro(say(entry))).classes("hint")
                drop = ui.button(icon="delete", on_click=lambda _, k=label: self._known(k, None))
                put(drop.props("flat dense"), {"aria-label": f"remove {label}"})
        kinds = {
            "uniform": "between two values",
            "log-uniform": "between two values, over decades",
            "normal": "mean and standard deviation",
            "lognormal": "median and geometric deviation",
        }
        with ui.row().classes("w-full items-end gap-2"):
            which = ui.select(names, label="input, or several that move together", multiple=True)
            which.set_value(names[:1])
            which.props('dense options-dense data-path="uncertain.name"').classes("grow")
            how = (
                ui.select(
                    {kind: kinds.get(kind, kind) for kind in KINDS},
                    label="what is known",
                    value="uniform",
                )
                .props("dense options-dense")
                .classes("grow")
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
                self._known("+".join(which.value), entry)

            ui.button("Add", icon="add", on_click=add).props('dense data-path="uncertain.add"')

    def _known(self, label: str, entry: dict[str, Any] | None) -> None:
        flat = _flat(self.table("uncertainty", "inputs"))
        flat.pop(label, None)
        if entry is not None:
            flat[label] = entry
        table = self.table("uncertainty")
        self.change("uncertainty", table | {"inputs": flat} if flat else None)


def _flat(tree: dict[str, Any], path: str = "") -> dict[str, Any]:
    """Uncertain inputs by their dotted names."""
    out: dict[str, Any] = {}
    for name, value in tree.items():
        where = f"{path}.{name}" if path else name
        if isinstance(value, dict) and any(isinstance(part, dict) for part in value.values()):
            out |= _flat(value, where)
        else:
            out[where] = value
    return out
