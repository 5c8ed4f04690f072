"""Two studies side by side: as one was before, and as it is now."""

from __future__ import annotations

import dataclasses
from collections.abc import Awaitable, Callable, Iterator
from typing import NamedTuple

import numpy as np
from nicegui import ui

import thirdbody as tb

from ...quantities.say import number, percent, signed_number
from ...study import Study, run_film
from ...views.film_words import point as film_point
from ..examples import EXAMPLES, example
from ..fields import engineering, number_of, text_of
from ..figures import AXES, GREY, SCALES, Figure, figure, fix, line
from ..sliders import CODES, shift_code
from ..solver import ask_for_page
from ..state import Answer, State, look, surface_key
from ..text import as_shown
from ..widgets import Plot, set_attributes, show_figures
from ..widgets import table as shown_table
from .interface import facts_of

__all__ = ["TITLE", "Beside", "build", "changes", "compare_answers"]

TITLE = "Before / after"
OPENED, KEPT = "as it was opened", "as it was kept"
SAME = "Nothing has changed yet; for a start, the same with a tenth of the particles."
ALONE = "Nothing has changed yet: move a slider, or change an entry."
FEWER, CLASSES = 0.1, -3
"""A start has so many times the particles, or an oil of so many classes more."""
MOST_CHANGES = 6
"""Changed entries that are named."""
NUMBERS = {
    "separation h": "h",
    "separation d": "d",
    "real contact area": "A_t",
    "particles carry": "particle_load_share",
    "of the real area": "particle_area_share",
}
"""Facts whose change is a number, and the columns they are of."""


class Beside(NamedTuple):
    """Two answers side by side: a sentence, rows of a table, figures."""

    sentence: str
    rows: list[dict[str, str]]
    figures: dict[str, Figure]


def flat(table: object, place: str = "") -> Iterator[tuple[str, object]]:
    """Entries of a study by their dotted places."""
    if isinstance(table, dict):
        for key, value in table.items():
            yield from flat(value, f"{place}.{key}" if place else str(key))
    elif isinstance(table, list) and any(isinstance(entry, dict) for entry in table):
        for i, entry in enumerate(table):
            yield from flat(entry, f"{place}.{i}")
    else:
        yield place, table


def changes(before: dict[str, object], after: dict[str, object]) -> list[str]:
    """What has changed between two studies, an entry each.

    >>> changes({"a": {"b": "1 nm", "c": 2}}, {"a": {"b": "2 nm", "d": 3}})
    ['a.b: 1 nm → 2 nm', 'a.c: 2 → none', 'a.d: none → 3']
    """
    old, new = dict(flat(before)), dict(flat(after))

    def shown_text(table: dict[str, object], name: str) -> str:
        return text_of(table[name]) if name in table else "none"

    return [
        f"{name}: {shown_text(old, name)} → {shown_text(new, name)}"
        for name in dict.fromkeys([*old, *new])
        if name != "title" and old.get(name) != new.get(name)
    ]


def cleaner(study: dict[str, object]) -> dict[str, object] | None:
    """The study with about a tenth of its particles; None where it does not say how many.

    >>> cleaner({"particles": {"iso4406": "18/16/13"}})
    {'particles': {'iso4406': '15/13/10'}}
    """
    particles = study.get("particles")
    several = particles if isinstance(particles, list) else [particles]
    new, about = [], tb.Particles.__dataclass_fields__["areal_density"].metadata["quantity"]
    for population in several:
        if not isinstance(population, dict):
            return None
        many = number_of(population.get("areal_density"), about)
        if CODES.fullmatch(str(population.get("iso4406"))):
            new.append(population | {"iso4406": shift_code(population["iso4406"], CLASSES)})
        elif many > 0:
            new.append(population | {"areal_density": engineering(FEWER * many, "1/m^2", 3)})
        else:
            return None
    return study | {"particles": new if isinstance(particles, list) else new[0]}


def compare_answers(before: Answer, after: Answer, at: float) -> Beside:
    """Two answers under the operating load of the second; each under its own mean pressure where
    forces press."""
    forced = before.has_one_force or after.has_one_force
    same = before.load == after.load and not forced
    points = (before.solve(at if same else _load_before(before, after, at)), after.solve(at))
    facts = [
        dict(facts_of(point, answer.particles_held))
        for point, answer in zip(points, (before, after), strict=True)
    ]
    rows = []
    for name in dict.fromkeys([*facts[0], *facts[1]]):
        rows.append(_row(name, facts, _change(points, NUMBERS.get(name, ""))))
    films = [_film_facts(answer.study) for answer in (before, after)]
    for name in dict.fromkeys([*films[0], *films[1]]):
        rows.append(_row(f"film: {name}", [{f"film: {k}": v for k, v in f.items()} for f in films]))
    return Beside(_sentence(points), rows, _figures(before, after))


def _load_before(before: Answer, after: Answer, at: float) -> float:
    """The load of the study before that is compared: its own, or the same load in its words."""
    if before.has_one_force or after.has_one_force:
        return before.default_at()
    F_star = float(after.solve(at).F_star)
    loads = {"F_star": F_star, "pressure": F_star * before.contact.E_ss}
    return loads.get(before.load, before.default_at())


def _row(name: str, facts: list[dict[str, str]], change: str = "") -> dict[str, str]:
    old, new = (answer_facts.get(name, "-") for answer_facts in facts)
    return {"name": name, "before": old, "after": new, "change": change}


def _change(points: tuple[tb.results.Equilibrium, tb.results.Equilibrium], column: str) -> str:
    if not column:
        return ""
    old, new = (float(getattr(point, column)) for point in points)
    if not (np.isfinite(old) and np.isfinite(new)) or old <= 0 or old == new:
        return ""
    return (
        f"×{number(new / old, 3)}"
        if new > 2 * old
        else signed_number(100 * (new / old - 1), 1, "%")
    )


def _sentence(points: tuple[tb.results.Equilibrium, tb.results.Equilibrium]) -> str:
    """The answer: what particles carry before and after."""
    if any(point.contact.two_body for point in points):
        old, new = (percent(float(point.A_t)) for point in points)
        return f"Real contact is {old} of the area before and {new} after."
    old, new = (percent(float(point.particle_load_share)) for point in points)
    return f"Particles carry {old} of the load before and {new} after."


def _film_facts(study: Study) -> dict[str, str]:
    """What the film says at the middle of the speeds; nothing without one."""
    if study.film is None:
        return {}
    speeds = study.film.speed
    only = study.film.replace(speed=(float(speeds[len(speeds) // 2]),))
    return dict(film_point(run_film(dataclasses.replace(study, film=only)), 0))


def _figures(before: Answer, after: Answer) -> dict[str, Figure]:
    """The share of the particles and the real area over the pressure, one curve each."""
    states = [answer.curves for answer in (before, after)]
    x = [SCALES["pressure"] * np.asarray(state.pressure) for state in states]
    looks: list[dict[str, object]] = [
        {"color": GREY, "dash": "dash"},
        {"dash": "solid", "width": 2.8},
    ]
    out = {}
    for name, column, scale, label, title in (
        ("shares", "particle_load_share", 100.0, "share of particles [%]", "What particles carry"),
        ("area", "A_t", 1.0, "real area over A<sub>n</sub>", "Real contact area"),
    ):
        traces = [
            line(x[i], scale * np.asarray(getattr(states[i], column)), word, i, line=looks[i])
            for i, word in enumerate(("before", "after"))
        ]
        out[name] = figure(
            traces, x=AXES["pressure"], y=label, title=title, ylog=name == "area", height=340
        )
    fix(out["shares"], "yaxis", [-2, 102])
    return out


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """What has changed, a table, two figures."""
    return BeforeAfter(state, again).draw


class BeforeAfter:
    """The study as it was before beside what it is now."""

    def __init__(self, state: State, again: Callable[[], None]) -> None:
        self.state, self.again = state, again
        self.read: tuple[dict[str, object], Answer | None] | None = None
        """The study before, and its answer."""
        self.shown: tuple[Answer, Answer, float] | None = None
        self.said = set_attributes(
            ui.label().classes("headline"), {"data-fact": "before and after"}
        )
        self.said.props("role=status")
        self.start = ui.label().classes("stale").props('data-fact="before begun"')
        self.wrong = ui.label().classes("problem").props('role=alert data-said="before"')
        with ui.row().classes("w-full items-end gap-3"):
            chosen = state.beside if state.beside in self._options() else OPENED
            self.which = ui.select(self._options(), value=chosen, label="before")
            set_attributes(
                self.which.props("dense options-dense").classes("wide"), {"data-path": "before"}
            )
            keep = ui.button("Keep as it is now", icon="push_pin", on_click=self._keep_study)
            set_attributes(keep.props("no-caps outline"), {"data-path": "before.keep"})
            back = ui.button("Go back to before", icon="history", on_click=self._go_back)
            set_attributes(back.props("no-caps flat"), {"data-path": "before.back"})
        self.changed = ui.column().classes("w-full gap-0").props('data-figure="changes"')
        self.rows = ui.column().classes("w-full scroll-x")
        with ui.element("div").classes("figures w-full"):
            self.plots = {name: Plot(f"before {name}", 340) for name in ("shares", "area")}
        self.which.on_value_change(self._choose_before)

    def _options(self) -> list[str]:
        return [OPENED, *([KEPT] if self.state.kept is not None else []), *EXAMPLES]

    def _study_before(self) -> dict[str, object]:
        """The study that stands on the left."""
        name = str(self.which.value)
        if name == KEPT and self.state.kept is not None:
            return self.state.kept
        return self.state.opened if name in (OPENED, KEPT) else example(name)

    def _choose_before(self) -> None:
        name = str(self.which.value)
        self.state.beside = "" if name == OPENED else name
        self.state.announce_change()

    def _keep_study(self) -> None:
        self.state.kept = self.state.study
        self.which.set_options(self._options(), value=KEPT)
        self._choose_before()

    def _go_back(self) -> None:
        self.state.replace(self._study_before())
        self.again()

    async def draw(self) -> None:
        """Both studies as they are now."""
        state, before = self.state, self._study_before()
        answer = state.answer
        assert answer is not None
        self._show_changes(before)
        now: Answer = answer
        old: Answer | None = answer
        if before != state.study:
            old = await self._answer(before)
        elif (fewer := cleaner(before)) is not None:
            now = await self._answer(fewer) or answer
        if old is None:
            return
        if self.shown == (old, now, state.operating_load):
            return
        beside = await ask_for_page(compare_answers, old, now, state.operating_load)
        self.shown = (old, now, state.operating_load)
        self.said.set_text(as_shown(beside.sentence))
        start = (
            "" if old is not now and before != state.study else SAME if old is not now else ALONE
        )
        self.start.set_text(start)
        self.start.set_visibility(bool(start))
        self.rows.clear()
        with self.rows:
            heads = {"name": "quantity", "before": "before", "after": "after", "change": "change"}
            shown_table("before and after", heads, beside.rows)
        await show_figures((self.plots[name], made) for name, made in beside.figures.items())

    async def _answer(self, before: dict[str, object]) -> Answer | None:
        """The answer of the study before, None with a mistake."""
        if self.read is None or self.read[0] != before:
            state, key = self.state, surface_key(before, self.state.folder)
            surface = state.surfaces.get(key)
            answer, problems, _ = await ask_for_page(look, before, state.folder, surface)
            self.wrong.set_text(as_shown("; ".join(problems)))
            self.read = (before, answer)
        return self.read[1]

    def _show_changes(self, before: dict[str, object]) -> None:
        """What has changed, entry by entry."""
        every = [as_shown(text) for text in changes(before, self.state.study)]
        more = len(every) - MOST_CHANGES
        self.changed.clear()
        with self.changed:
            for text in every[:MOST_CHANGES]:
                ui.label(text)
            if more > 0:
                ui.label(f"and {more} more").classes("hint")
