"""One entry of the study on the page: its widget, what is meant by its text, its mistake."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

from nicegui import ui

import thirdbody as tb

from ..errors import InvalidValue, Mistake, Problem
from ..quantities.say import number, value_of
from .fields import VARIANTS, Field, fields_of, known_keys, options_of, text_of, value_from
from .state import State
from .text import from_toml, to_toml, with_micro
from .widgets import set_attributes

if TYPE_CHECKING:
    from collections.abc import Mapping

    from nicegui.events import ValueChangeEventArguments

__all__ = ["Entries", "Place", "about_of", "dotted_name"]

Place = tuple[str | int, ...]
OWN = "own values"
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


def dotted_name(path: Iterable[str | int]) -> str:
    """A place in the study as messages name it."""
    return ".".join(map(str, path))


class Entry(NamedTuple):
    """A widget of one entry; ``read`` gives what is meant by its text.

    It is None for a menu on whose choice depends which other entries there are: these are made
    anew together.
    """

    widget: Any
    read: Callable[[str], object] | None = None
    show: Callable[[object], str] = text_of
    whole: bool = False
    """Whether mistakes inside the table belong to it as well."""


class Entries:
    """Widgets bound to entries of the study; after every change each shows its own mistake."""

    def __init__(self, state: State, again: Callable[[], None]) -> None:
        self.state = state
        self.again = again
        """Called when other entries are needed than before."""
        self.shown: dict[str, Entry] = {}
        self.rest: Any = None
        self.left: tuple[object, list[Problem]] = (None, [])
        """Where mistakes without a field stand, and which."""

    # ------------------------------------------------------------------ mistakes
    def show_mistakes(self) -> None:
        """Put every mistake beside its field, and the others where they can be seen."""
        left = list(self.state.problems)
        for name, (widget, read, show, whole) in self.shown.items():
            inner = f"{name}." if whole else name
            mine = [p for p in left if about_of(p) == name or about_of(p).startswith(inner)]
            left = [problem for problem in left if problem not in mine]
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

    def text(
        self, place: Place, field: Field, to: Callable[[object], None] | None = None
    ) -> ui.input:
        """An entry that is written: the study changes when typing pauses."""
        set_to = to or (lambda value: self.state.set(*place, value))
        read, show = (
            (lambda text: text.strip() or None, lambda value: str(value or ""))
            if field.kind == "string"
            else (lambda text: value_from(text, one=field.kind == "number"), text_of)
        )
        entry = ui.input(field.label, value=show(self.state.get(*place))).classes("w-full")
        name = dotted_name(place)
        set_attributes(entry.props("dense debounce=350"), {"hint": with_micro(field.about)})
        set_attributes(entry, {"aria-label": name, "data-path": name})
        entry.on_value_change(lambda event: set_to(read(event.value or "")))
        self.shown[name] = Entry(entry, read, show)
        return entry

    def other_fields(self, *place: str) -> None:
        """The entries of a table without a form of its own, as the reader knows them."""
        for name, about in (
            known_keys(self.state.study, place[0]).get(dotted_name(place), {}).items()
        ):
            if about:
                self.field(place, Field(name=name, kind="text", label=name, about=about))

    def as_text(self, name: str) -> None:
        """A table as it stands in the file, its mistakes below."""

        def read(text: str) -> object:
            tables = from_toml(text)
            if other := [key for key in tables if key != name]:
                raise InvalidValue(
                    f"here stands [{name}] alone, not {', '.join(other)}", code=Mistake.CLASH
                )
            return tables.get(name)

        def set_text(event: ValueChangeEventArguments[Any]) -> None:
            try:
                self.state.set(name, read(event.value or ""))
            except InvalidValue:
                self.state.announce_change()  # which reads it again, to put the mistake beside it

        def show(table: object) -> str:
            return "" if table is None else to_toml({name: table})

        entry = ui.textarea(value=show(self.state.get(name)), placeholder=BEGUN.get(name, ""))
        entry.props("outlined autogrow debounce=500")
        set_attributes(entry, {"data-path": name, "aria-label": f"[{name}]"})
        entry.classes("w-full code").on_value_change(set_text)
        keys = known_keys(self.state.study, name).get(name, {})
        ui.label(f"Keys: {', '.join(keys)}.").classes("hint")
        self.shown[name] = Entry(entry, read, show, whole=True)

    def select(
        self,
        place: Place | None,
        options: dict[str, str],
        now: object,
        label: str,
        then: Callable[[Any], None] | None = None,
        hint: str = "",
    ) -> ui.select:
        """A menu; what follows from a choice is ``then``."""

        def set_choice(event: ValueChangeEventArguments[Any]) -> None:
            if then is not None:
                then(event.value)
            elif place is not None:
                self.state.set(*place, event.value or None)

        def show_word(value: object) -> str:
            word = word_of(value)
            menu.set_options(with_word(word), value=word)
            return word

        def word_of(value: object) -> str:
            return value if isinstance(value, str) else text_of(value)

        def with_word(word: str) -> dict[str, str]:
            """The options, and a mistake, which stands there as it is written."""
            return options if word in options else {word: word, **options}

        word = word_of(now)
        menu = ui.select(with_word(word), value=word, label=label, on_change=set_choice)
        set_attributes(
            menu.props("dense options-dense").classes("w-full"), {"hint": with_micro(hint)}
        )
        if place is not None:
            set_attributes(menu, {"data-path": dotted_name(place)})
            entry = Entry(menu) if then else Entry(menu, lambda word: word or None, show_word)
            self.shown[dotted_name(place)] = entry
        return menu

    def change(self, *path_and_value: object) -> None:
        """Set an entry on which depends which others there are."""
        self.state.set(*path_and_value, whole=True)
        self.again()

    # ------------------------------------------------------------------ tables
    def table(self, *place: str | int) -> dict[str, object]:
        """A table of the study; an empty one where something else stands."""
        value = self.state.get(*place)
        return value if isinstance(value, dict) else {}

    def material(self, place: Place, label: str) -> None:
        """A material of the library, or own values."""
        now = self.state.get(*place)
        is_table = isinstance(now, dict)
        library = self.state.library
        options = {OWN: OWN, **{name: name for name in library}}

        def set_material(value: object) -> None:
            if value != OWN:
                self.change(*place, value)
                return
            chosen = library[now] if isinstance(now, str) and now in library else None
            values = {"E": chosen.E, "nu": chosen.nu, "H": chosen.H} if chosen else {}
            self.change(*place, values or {"E": "205 GPa", "nu": 0.29, "H": "5 GPa"})

        self.select(place, options, OWN if is_table else now, label, set_material)
        if is_table:
            for field in fields_of(tb.Material):
                self.field(place, field)
        elif isinstance(now, str) and now in library:
            chosen = library[now]
            ui.label(
                f"E = {value_of(chosen.E, 'Pa')}, ν = {number(chosen.nu)}, "
                f"H = {value_of(chosen.H, 'Pa')}"
            ).classes("hint")

    def variant(
        self,
        place: Place,
        registry: Mapping[str, type],
        default: str,
        label: str,
        tag: str = "name",
        blank: str | None = None,
    ) -> None:
        """A word of a registry and the entries that go with it."""
        now = self.state.get(*place)
        word = now.get(tag) if isinstance(now, dict) else now
        word = word if isinstance(word, str) else text_of(word)
        words = options_of(registry)
        if blank is not None:
            words = {"": blank, **words}

        def set_variant(value: object) -> None:
            self.change(*place, {tag: value} if value else None)

        chosen = word or ("" if blank is not None else default)
        self.select((*place, tag), words, chosen, label, set_variant)
        kind = registry.get(chosen)
        if kind is None:
            return
        for field in fields_of(kind):
            if not isinstance(now, dict):
                # an entry needs a table to stand in
                self._word_entry(place, field, tag, chosen)
            else:
                self.field(place, field)
        for item in dataclasses.fields(kind):
            if item.type == "AbstractAsperityLaw" and isinstance(now, dict):
                label = f"{item.name}: asperity law inside"
                inner = (*place, item.name)
                self.variant(inner, VARIANTS["asperity"], "", label, blank="left out")

    def _word_entry(self, place: Place, field: Field, tag: str, word: str) -> None:
        """An entry of a table that is still a word, or left out."""

        def set_field(value: object) -> None:
            table = self.state.get(*place)
            if value is None and not isinstance(table, dict):
                return
            kept = table if isinstance(table, dict) else {tag: word}
            new = {key: old for key, old in kept.items() if key != field.name}
            self.state.set(*place, new if value is None else new | {field.name: value})

        self.text((*place, field.name), field, set_field)


def about_of(problem: Problem) -> str:
    """The entry that a mistake is about: a list has one for all of its items."""
    return problem.place.partition("[")[0]
