"""The fields of a page: an entry for everything a study file can say, mistakes beside it."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from nicegui import events, ui

import thirdbody as tb

from ..analysis.uncertainty.inputs import KINDS
from ..errors import InvalidValue
from ..quantities.say import number, value_of
from ..quantities.units import say
from ..study import LOADS
from ..study.concentration import AMOUNT
from ..study.counted import COUNTED
from ..study.inputs import inputs_of
from .bounds import LARGEST_TABLE
from .fields import (
    COUNTED_FIELDS,
    VARIANTS,
    Field,
    fields_of,
    known_keys,
    number_field,
    options_of,
    shown,
    value_from,
)
from .state import State
from .text import from_toml, to_toml, with_micro
from .uploads import keep
from .widgets import put, upload

__all__ = ["FORMED", "Inputs"]

Place = tuple[str | int, ...]
OWN = "own values"
SIZES = (*VARIANTS["distribution"], *COUNTED)
AMOUNTS = ("gap", "particle_density", "oil_density")
FORMED = (
    "title", "materials", "surfaces", "roughness", "asperity_law", "particles", "particle_law",
    "outputs", "load",
)  # fmt: skip
"""Tables of a study file that have forms; every other can be written as text."""
BEGUN = {
    "sweep": """[sweep]
design = "sobol"
samples = 256

[sweep.vary.roughness]
sigma = { from = "50 nm", to = "200 nm" }
""",
    "uncertainty": """[uncertainty]
samples = 1024
seed = 1

[uncertainty.inputs]
"roughness.sigma" = { low = "90 nm", high = "110 nm" }
""",
    "design": """[design]
objective = { of = "particle_load_share", aim = "largest" }
limits = [{ of = "A_t", most = 0.1 }]

[design.vary]
"roughness.sigma" = { low = "50 nm", high = "200 nm" }
""",
}
"""How a table may begin; shown while there is none."""


def dotted(path: Iterable[str | int]) -> str:
    """A place in the study as messages name it."""
    return ".".join(map(str, path))


class Entry(NamedTuple):
    """A widget of one entry; ``read`` gives what is meant by its text, None for a menu."""

    widget: Any
    read: Callable[[str], Any] | None = None
    show: Callable[[Any], str] = shown
    whole: bool = False
    """Whether mistakes inside the table belong to it as well."""


class Inputs:
    """Widgets bound to entries of the study; after every change each shows its own mistake."""

    def __init__(self, state: State, again: Callable[[], None]) -> None:
        self.state = state
        self.again = again
        """Called when other entries are needed than before."""
        self.shown: dict[str, Entry] = {}
        self.rest: Any = None
        self.left: tuple[Any, list[str]] = (None, [])
        """Where mistakes without a field stand, and which."""

    # ------------------------------------------------------------------ mistakes
    def tell(self) -> None:
        """Put every mistake beside its field, and the others where they can be seen."""
        left = list(self.state.problems)
        for name, (widget, read, show, whole) in self.shown.items():
            inner = f"{name}." if whole else name
            mine = [t for t in left if about_of(t) == name or about_of(t).startswith(inner)]
            left = [text for text in left if text not in mine]
            path = tuple(int(step) if step.isdecimal() else step for step in name.split("."))
            now = self.state.get(*path)
            if read is not None:
                try:
                    if read(widget.value or "") != now and not mine:
                        widget.value = show(now)
                except InvalidValue as error:
                    mine = list(error.problems)
            fitting = with_micro(" ".join(mine)) or None
            if widget.error != fitting:
                widget.error = fitting
        if self.rest is not None and self.left != (self.rest, left):
            self.left = (self.rest, left)
            self.rest.clear()
            with self.rest:
                for text in left:
                    ui.label(with_micro(text)).classes("problem").props("role=alert")

    # ------------------------------------------------------------------ one entry
    def field(self, path: Place, field: Field) -> None:
        """The widget of one entry."""
        place = (*path, field.name)
        now = self.state.get(*place)
        if field.kind == "word":
            blank = {"": f"{field.default} (when left out)" if field.default else "left out"}
            options = blank | {word: word for word in field.options}
            self.select(place, options, now or "", field.label, hint=field.about)
        elif field.kind == "switch":
            box = ui.checkbox(field.label, value=field.default if now is None else bool(now))
            box.on_value_change(lambda e: self.state.set(*place, bool(e.value)))
        else:
            self.text(place, field)

    def text(self, place: Place, field: Field, to: Callable[[Any], None] | None = None) -> Any:
        """An entry that is written: the study changes when typing pauses."""
        set_to = to or (lambda value: self.state.set(*place, value))
        read, show = (
            (lambda text: text.strip() or None, lambda value: str(value or ""))
            if field.kind == "string"
            else (value_from, shown)
        )
        entry = ui.input(field.label, value=show(self.state.get(*place))).classes("w-full")
        name = dotted(place)
        put(entry.props("dense debounce=350"), {"hint": with_micro(field.about)})
        put(entry, {"aria-label": name, "data-path": name})
        entry.on_value_change(lambda event: set_to(read(event.value or "")))
        self.shown[name] = Entry(entry, read, show)
        return entry

    def known(self, *place: str) -> None:
        """The entries of a table without a form of its own, as the reader knows them."""
        for name, about in known_keys(self.state.study, place[0]).get(dotted(place), {}).items():
            if about:
                self.field(place, Field(name=name, kind="text", label=name, about=about))

    def as_text(self, name: str) -> None:
        """A table as it stands in the file, its mistakes below."""

        def read(text: str) -> Any:
            given = from_toml(text)
            if other := [key for key in given if key != name]:
                raise InvalidValue(f"here stands [{name}] alone, not {', '.join(other)}")
            return given.get(name)

        def changed(event: Any) -> None:
            try:
                self.state.set(name, read(event.value or ""))
            except InvalidValue:
                self.state.tell()  # which reads it again, to put the mistake beside it

        def show(table: Any) -> str:
            return "" if table is None else to_toml({name: table})

        entry = ui.textarea(value=show(self.state.get(name)), placeholder=BEGUN.get(name, ""))
        entry.props("outlined autogrow debounce=500")
        put(entry, {"data-path": name, "aria-label": f"[{name}]"})
        entry.classes("w-full code").on_value_change(changed)
        keys = known_keys(self.state.study, name).get(name, {})
        ui.label(f"Keys: {', '.join(keys)}.").classes("hint")
        self.shown[name] = Entry(entry, read, show, whole=True)

    def select(
        self,
        place: Place | None,
        options: dict[str, str],
        now: Any,
        label: str,
        then: Callable[[Any], None] | None = None,
        hint: str = "",
    ) -> Any:
        """A menu; what follows from a choice is ``then``."""

        def changed(event: Any) -> None:
            if then is not None:
                then(event.value)
            elif place is not None:
                self.state.set(*place, event.value or None)

        if not isinstance(now, str):
            now = shown(now)  # a mistake, which stands there as it is written
        known = options if now in options else {now: now, **options}
        menu = ui.select(known, value=now, label=label, on_change=changed)
        put(menu.props("dense options-dense").classes("w-full"), {"hint": with_micro(hint)})
        if place is not None:
            put(menu, {"data-path": dotted(place)})
            self.shown[dotted(place)] = Entry(menu)
        return menu

    def change(self, *path_and_value: Any) -> None:
        """Set an entry on which depends which others there are."""
        self.state.set(*path_and_value, whole=True)
        self.again()

    # ------------------------------------------------------------------ tables
    def table(self, *place: str | int) -> dict[str, Any]:
        """A table of the study; an empty one where something else stands."""
        given = self.state.get(*place)
        return given if isinstance(given, dict) else {}

    def material(self, place: Place, label: str) -> None:
        """A material of the library, or own values."""
        now = self.state.get(*place)
        own = isinstance(now, dict)
        library = self.state.library
        options = {OWN: OWN, **{name: name for name in library}}

        def then(value: Any) -> None:
            if value != OWN:
                self.change(*place, value)
                return
            known = library[now] if isinstance(now, str) and now in library else None
            given = {"E": known.E, "nu": known.nu, "H": known.H} if known else {}
            self.change(*place, given or {"E": "205 GPa", "nu": 0.29, "H": "5 GPa"})

        self.select(place, options, OWN if own else now, label, then)
        if own:
            for each in fields_of(tb.Material):
                self.field(place, each)
        elif isinstance(now, str) and now in library:
            known = library[now]
            ui.label(
                f"E = {value_of(known.E, 'Pa')}, ν = {number(known.nu)}, "
                f"H = {value_of(known.H, 'Pa')}"
            ).classes("hint")

    def variant(
        self,
        place: Place,
        registry: Any,
        default: str,
        label: str,
        tag: str = "name",
        blank: str | None = None,
    ) -> None:
        """A word of a registry and the entries that go with it."""
        now = self.state.get(*place)
        word = now.get(tag) if isinstance(now, dict) else now
        word = word if isinstance(word, str) else shown(word)
        words = options_of(registry)
        if blank is not None:
            words = {"": blank, **words}

        def then(value: Any) -> None:
            self.change(*place, {tag: value} if value else None)

        chosen = word or ("" if blank is not None else default)
        self.select((*place, tag), words, chosen, label, then)
        kind = registry.get(chosen)
        if kind is None:
            return
        for each in fields_of(kind):
            if not isinstance(now, dict):
                # an entry needs a table to stand in
                self._named(place, each, tag, chosen)
            else:
                self.field(place, each)
        for item in dataclasses.fields(kind):
            if item.type == "AbstractAsperityLaw" and isinstance(now, dict):
                label = f"{item.name}: asperity law inside"
                inner = (*place, item.name)
                self.variant(inner, VARIANTS["asperity"], "", label, blank="left out")

    def _named(self, place: Place, field: Field, tag: str, word: str) -> None:
        """An entry of a table that is still a word, or left out."""

        def to(value: Any) -> None:
            table = self.state.get(*place)
            if value is None and not isinstance(table, dict):
                return
            kept = table if isinstance(table, dict) else {tag: word}
            new = {key: old for key, old in kept.items() if key != field.name}
            self.state.set(*place, new if value is None else new | {field.name: value})

        self.text((*place, field.name), field, to)

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

    @staticmethod
    def first_population(state: State) -> Place:
        """Where the first population stands, or would."""
        return ("particles", 0) if isinstance(state.get("particles"), list) else ("particles",)

    def populations(self) -> list[Place]:
        """Where each population of particles stands."""
        given = self.state.get("particles")
        if isinstance(given, list):
            return [("particles", i) for i in range(len(given))]
        return [("particles",)] if given is not None else []

    def population(self, place: Place) -> None:
        """One population: material, sizes, how many."""
        table = self.table(*place)
        self.material((*place, "material"), "material")
        kind = next((key for key in COUNTED if key in table), table.get("distribution"))
        kind = kind if isinstance(kind, str) else None
        labels = options_of({name: None for name in SIZES}) | {
            "iso4406": "iso4406: oil cleanliness code",
            "as4059": "as4059: cleanliness class",
            "nas1638": "nas1638: cleanliness class",
            "test_dust": "test_dust: ISO 12103-1 A1 to A4",
            "sizes": "sizes: a file of the particle counter",
        }
        self.select(
            (*place, "distribution"), labels, kind or "", "sizes", lambda w: self._sized(place, w)
        )
        if kind in COUNTED:
            example = {"iso4406": "18/16/13", "test_dust": "A2", "sizes": "sizes.csv"}.get(
                kind, "6"
            )
            about = f"as written, e.g. {example}"
            self.field(place, Field(name=kind, kind="string", label=kind, about=about))
            for each in COUNTED_FIELDS[kind]:
                self.field(place, each)
        elif kind in VARIANTS["distribution"]:
            for each in fields_of(VARIANTS["distribution"][kind]):
                self.field(place, each)
        self.amount(place, kind)
        self.field(place, Field(name="name", kind="string", label="name", about="in the results"))
        if not isinstance(table.get("strength"), dict):  # a table stands in the file alone
            about = "material: that of the library; empty: never break"
            self.field(place, Field(name="strength", kind="string", label="strength", about=about))
        if kind != "weibull":  # whose own shape has the name
            label = "shape of these particles"
            self.variant((*place, "shape"), VARIANTS["shape"], "sphere", label, tag="kind")
        self.variant(
            (*place, "law"), VARIANTS["particle"], "", "law of these particles", blank="as below"
        )

    def amount(self, place: Place, kind: Any) -> None:
        """Per area, or a concentration and the gap."""
        coded = kind in ("iso4406", "as4059", "nas1638")
        if not coded:
            about = next(f for f in fields_of(tb.Particles) if f.name == "areal_density")
            self.field(place, about)
            said = "instead of areal_density, with a gap, e.g. 0.1 wt%"
            self.field(
                place, Field(name="concentration", kind="text", label="concentration", about=said)
            )
        for name in AMOUNTS[: 1 if coded else 3]:
            if name == "particle_density" and kind == "test_dust":
                continue
            self.field(place, number_field(name, AMOUNT[name], needed=False))

    def _sized(self, place: Place, word: str) -> None:
        """Another way to give the sizes: what does not go with it goes."""
        table = self.table(*place)
        own = ("material", "name", "law", "strength")
        kept = {key: table[key] for key in own if key in table}
        if isinstance(shape := table.get("shape"), dict) and word != "weibull":
            kept["shape"] = shape
        amounts = {key: table[key] for key in ("areal_density", *AMOUNTS) if key in table}
        starts: dict[str, dict[str, Any]] = {
            "iso4406": {"iso4406": "18/16/13", "gap": table.get("gap", "1 um")},
            "as4059": {"as4059": "6", "gap": table.get("gap", "1 um")},
            "nas1638": {"nas1638": "6", "gap": table.get("gap", "1 um")},
            "test_dust": {"test_dust": "A2"} | {"areal_density": "1e9 / m^2"} | amounts,
            "sizes": {"sizes": table.get("sizes", "sizes.csv")} | amounts,
            "truncated-gaussian": {"mean": "300 nm", "std": "24 nm"},
            "log-normal": {"median": "300 nm", "gsd": 1.3},
            "monodisperse": {"mean": "300 nm"},
            "uniform": {"low": "200 nm", "high": "400 nm"},
            "weibull": {"scale": "300 nm", "shape": 4},
            "power-law": {
                "edges": ["100 nm", "300 nm", "1 um"],
                "counts": [10, 1],
                "slopes": [3, 3.5],
            },
            "histogram": {"edges": ["200 nm", "300 nm", "400 nm"], "counts": [3, 1]},
            "mixture": {
                "parts": [
                    {"distribution": "monodisperse", "mean": "200 nm"},
                    {"distribution": "monodisperse", "mean": "400 nm"},
                ],
                "weights": [3, 1],
            },
        }
        start = starts.get(word, {})
        if word not in COUNTED:
            start = {"distribution": word} | start | amounts
            start.setdefault("areal_density", "1e11 / m^2")
            start = {key: value for key, value in start.items() if key not in AMOUNTS}
        self.change(*place, kept | start)

    def particles(self) -> None:
        """Every population, one more, one less."""
        for i, place in enumerate(self.populations()):
            with ui.row().classes("w-full items-center justify-between"):
                ui.label(f"Population {i + 1}").classes("subhead")
                remove = ui.button(icon="delete", on_click=lambda _, p=place: self._remove(p))
                remove.props('flat dense aria-label="remove this population"')
            self.population(place)
        ui.button("Add particles", icon="add", on_click=self._add).props("flat dense")
        if self.populations():
            self.variant(("particle_law",), VARIANTS["particle"], "series", "law of particles")

    def _add(self) -> None:
        new = {
            "material": "SiO2",
            "distribution": "truncated-gaussian",
            "mean": "300 nm",
            "std": "24 nm",
            "areal_density": "1e11 / m^2",
        }
        given = self.state.get("particles")
        if given is None:
            self.change("particles", new)
            return
        several = given if isinstance(given, list) else [given]
        name = f"population {len(several) + 1}"
        self.change("particles", [*several, new | {"name": name}])

    def _remove(self, place: Place) -> None:
        given = self.state.get("particles")
        if not isinstance(given, list):
            study = {k: v for k, v in self.state.study.items() if k not in ("particles",)}
            study.pop("particle_law", None)
            self.state.replace(study)
            self.again()
            return
        left = [each for i, each in enumerate(given) if i != place[1]]
        self.change("particles", left if len(left) > 1 else left[0])

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


def about_of(problem: str) -> str:
    """The entry that a sentence is about: it begins with its place."""
    first = problem.split(" ", 1)[0].rstrip(":,")
    return first.split("[", 1)[0]
