"""The interface in section, to scale, at the operating load."""

from __future__ import annotations

import math
import time
from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING, Any

from nicegui import ui

import thirdbody as tb

from ...equilibrium.columns import COLUMNS
from ...equilibrium.words import (
    MODES,
    NO_CONTACT,
    is_rare,
    load_of,
    meets,
    mode_among,
    mode_of,
    particle_share_text,
    two_bodies,
)
from ...errors import InvalidValue
from ...quantities.say import number, percent, value_of
from ...study.load import force_sentences, told_forces
from ...systems.bodies import Pressed, press
from ..cross_section import section, to_svg
from ..state import Answer, State
from ..text import as_shown
from ..widgets import Facts, set_attributes

if TYPE_CHECKING:
    from ..cross_section import Section

__all__ = ["TITLE", "abouts", "build", "drawing_of", "facts_of", "headline", "swatch"]

TITLE = "Interface"
IN_HEADLINE = ("load", "mode", "particles carry")
"""Facts that the headline says."""
LETTERS = {"h": "h", "d": "d", "F*": "F_star"}
FILM = "The study has an oil film: here surfaces and particles carry the load alone; see Film."
PLACE = (
    "What follows is a place of this contact where the pressure is that of the slider, which "
    "begins at the mean and goes up to the largest."
)
FORCED = "What the force does to the whole contact"
FIRST = "Preliminary: the integral over the contact follows."
RESTS = 0.4
"""Seconds after which what takes long is computed for a study that has not changed."""
TICK = 0.01
"""Seconds by which a timer may be early."""
SPARSE = 100
"""A slab so many times deeper than the drawing is wide is no picture of a place."""
MET = (
    " Where a population carries and the slab held none of its loaded particles, one of them is "
    "drawn in the place of a free one."
)


def headline(point: tb.results.Equilibrium, held: float = math.inf) -> str:
    """The answer as a sentence, of the clauses of the command line."""
    load = load_of(_one(point.pressure), _one(point.F_star))
    if not _one(point.A_t):
        return f"At {load} {mode_of(None)}."
    if point.contact.two_body:
        return f"At {load} {two_bodies()}."
    parts = {population.name: _one(population.load_share) for population in point.populations}
    share = particle_share_text(_one(point.particle_load_share), parts if len(parts) > 1 else None)
    mode = str(point.mode) or None
    if is_rare(mode, held):
        how = mode_among(mode, held)
        return f"At {load} {how}; on a wide surface {share}."
    return f"{share[0].upper()}{share[1:]} at {load}; {mode_of(mode)}."


def facts_of(point: tb.results.Equilibrium, held: float = math.inf) -> list[tuple[str, str]]:
    """The state under the operating load, in the words of the command line."""
    at = [
        ("load", load_of(_one(point.pressure), _one(point.F_star))),
        ("separation h", value_of(_one(point.h), "m")),
        ("separation d", f"{value_of(_one(point.d), 'm')} ({number(_one(point.d_star))} σ)"),
        ("real contact area", percent(_one(point.A_t))),
    ]
    if not point.contact.two_body:
        mode = str(point.mode)
        at += [
            ("mode", meets(held) if is_rare(mode, held) else mode or NO_CONTACT),
            ("particles carry", percent(_one(point.particle_load_share))),
            ("of the real area", percent(_one(point.particle_area_share))),
        ]
        counted = point.outputs
        if "n_sa" not in counted:
            contact = point.contact.replace(outputs=(tb.outputs.Counts(),))
            counted = tb.solve(contact, d=_one(point.d)).outputs
        at.append(_loaded_row(point.contact, _one(counted["n_sa"])))
    for population in point.populations:
        at.append((f"{population.name} carries", percent(_one(population.load_share))))
    return at


def _loaded_row(contact: tb.Contact, n: float) -> tuple[str, str]:
    """How many of the particles bear load; of those that break, pieces for each that came.

    Pieces bear beside whole particles, and so they are no part of those that came.
    """
    share = n / sum(dust.areal_density for dust in contact.populations)
    if any(dust.strength and dust.strength.fragments != "gone" for dust in contact.populations):
        return ("whole particles and pieces loaded", f"{number(share, 3)} for each particle")
    return ("particles loaded", percent(share))


def abouts() -> dict[str, str]:
    """What the letters and modes of the page mean."""
    letters = {name: COLUMNS[key].meaning for name, key in LETTERS.items()}
    return {mode: mode_of(mode).removesuffix(f" ({mode})") for mode in MODES} | letters


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """The answer, the drawing, what it shows, and another draw."""
    seed = {"now": 0}
    force = Force(state, lambda: draw())
    answer = ui.label().classes("headline").props('data-fact="headline" role=status')
    film = ui.label(FILM).classes("hint").props('data-fact="film"')
    picture = (
        ui.html("", sanitize=False)
        .classes("w-full scroll-x")
        .props('data-figure="section" tabindex=0 role=group aria-label="cross-section"')
    )
    with ui.row().classes("w-full gap-4 items-center justify-between"):
        legend = ui.row().classes("gap-4")
        ui.button("Another place", icon="casino", on_click=lambda: draw_another()).props(
            "flat dense no-caps"
        )
    means = abouts()
    numbers = Facts(
        {"separation h": means["h"], "separation d": means["d"], "load": means["F*"]}
        | {"mode": "; ".join(f"{mode}: {means[mode]}" for mode in MODES)},
        said=IN_HEADLINE,
    )
    status = ui.label().classes("problem")
    caption = ui.label().classes("hint")
    fold = ui.expansion("What the words mean").classes("w-full").props("dense")
    with fold, ui.element("dl").classes("words").props('data-figure="words"'):
        for name, meaning in means.items():
            with ui.element("dt").classes("font-bold"):
                ui.label(name)
            with ui.element("dd"):
                ui.label(meaning)
    shown: dict[str, object] = {"names": None}

    async def draw() -> None:
        assert state.answer is not None
        force.draw()
        answer.classes(**{"add" if state.answer.study.forces is not None else "remove": "second"})
        film.set_visibility(state.answer.study.film is not None)
        bad, drawing = await state.ask(drawing_of, state.operating_load, seed["now"])
        status.set_text(bad)
        status.set_visibility(bool(bad))
        if bad:
            return
        svg, says, names, pairs, sentence = drawing
        answer.set_text(as_shown(sentence))
        picture.set_content(svg)
        caption.set_text(as_shown(says))
        if names != shown["names"]:
            shown["names"] = names
            legend.clear()
            with legend:
                _legend(names)
        numbers.show(pairs)

    def draw_another() -> None:
        seed["now"] += 1
        state.announce_change()  # which is answered as every other change is

    return draw


class Force:
    """What forces do to their bodies: the pressures at once, the integral once the study rests."""

    def __init__(self, state: State, redraw: Callable[[], Awaitable[None]]) -> None:
        self.state, self.redraw = state, redraw
        self.box = ui.column().classes("w-full gap-1")
        with self.box:
            self.said = ui.label().classes("whole-contact").props('data-fact="force" role=status')
            self.first = ui.label(FIRST).classes("stale").props('data-fact="preliminary"')
            self.fold = ui.expansion(FORCED).classes("w-full").props("dense")
            set_attributes(self.fold, {"data-fold": "force"})
            with self.fold:
                self.rest = ui.label().props('data-fact="force in full"')
                self.warned = ui.label().classes("problem").props('data-fact="force warning"')
                self.place = ui.label(PLACE).classes("hint")
        self.box.set_visibility(False)
        self.shown: Answer | None = None
        """Whose integral is shown, or asked for."""
        self.later: Any = None
        """The timer after which the integral is asked for."""
        self.drawn = 0.0
        """When the pressures were shown last."""
        self.running = False

    def draw(self) -> None:
        """Show what is known, and have the rest follow."""
        answer = self.state.answer
        assert answer is not None
        whole = "forces" in answer.__dict__
        forces = answer.forces if whole else at_once(answer)
        self.box.set_visibility(bool(forces))
        if not forces:
            return
        follows = not whole and forces[0].kind != "flat"
        first, rest = first_and_rest(force_sentences(forces))
        self.said.set_text(as_shown(first))
        self.rest.set_text(as_shown(rest))
        self.fold.set_visibility(bool(rest) or forces[0].kind != "flat")
        self.first.set_visibility(follows)
        warned = [text for force in forces for text in force.warnings]
        self.warned.set_text(f"Warning: {'; '.join(warned)}." if warned else "")
        self.warned.set_visibility(bool(warned))
        self.place.set_visibility(forces[0].kind != "flat" and answer.has_one_force)
        self.drawn = time.perf_counter()
        if follows and self.later is None and not self.running:
            self._wait(RESTS)

    def _wait(self, seconds: float) -> None:
        with self.box:
            self.later = ui.timer(seconds, self._finish, once=True)

    async def _finish(self) -> None:
        self.later, answer = None, self.state.answer
        if answer is None or self.running:
            return
        moved = time.perf_counter() - self.drawn
        if moved < RESTS:  # the study moves
            self._wait(RESTS - moved + TICK)
            return
        self.running = True
        try:
            await self.state.ask(_integrate_forces)
        except InvalidValue as error:
            self.first.set_text("; ".join(error.problems))
            return
        finally:
            self.running = False
        self.first.set_text(FIRST)
        # what is drawn counts particles on the area that carries, known only now; of another
        # answer meanwhile the integral is asked for
        await self.redraw()


def first_and_rest(sentences: list[str]) -> tuple[str, str]:
    """The first sentence of several texts, and all the others.

    >>> first_and_rest(["2 N on a ball: 0.1 mm² wide. It yields. So far.", "3 N on it. None."])
    ('2 N on a ball: 0.1 mm² wide.', 'It yields. So far. 3 N on it. None.')
    """
    first, _, rest = " ".join(sentences).partition(". ")
    return f"{first.removesuffix('.')}.", rest


def at_once(answer: Answer) -> list[Pressed]:
    """What forces do to their bodies, as far as it takes no time."""
    body, forces = answer.study.body, answer.study.forces
    if body is None or forces is None:
        return []
    return [
        press(answer.contact, body, float(force), integrate=False) for force in told_forces(forces)
    ]


def _integrate_forces(answer: Answer) -> None:
    """Have the answer learn what its forces do."""
    _ = answer.forces


def drawing_of(answer: Answer, at: float, seed: int) -> tuple[str, Any]:
    """What is wrong with the state; else the drawing, what it shows, whose, and the state."""
    point = answer.solve(at, tb.outputs.Counts())
    if str(point.status) != "ok":
        return str(point.status), None
    held = answer.particles_held
    made = section(answer.contact, point, seed=seed, held=held)
    svg = to_svg(made, title="Cross-section of the interface, to scale")
    return "", (svg, _caption(made, held), made.names, facts_of(point, held), headline(point, held))


def _caption(drawn: Section, held: float) -> str:
    """What is drawn, and of how much surface."""
    said = (
        "One draw from the model, to scale. Below the rough surface of both bodies together, "
        "above the flat at the separation h from its mean plane (dotted). "
    )
    if not drawn.grains:
        return said
    loaded = sum(grain.is_loaded for grain in drawn.grains)
    carry = "larger than the gap above their seat and carry load."
    if rare := meets(held):
        does = "is larger than the gap above its seat and carries load"
        if len(drawn.grains) == 1:
            which = "the particle " + (does if loaded else "fits into the gap above its seat")
        else:
            which = f"with one particle of each kind: {loaded} of {len(drawn.grains)} carry load"
        return f"{said}{rare[0].upper()}{rare[1:]}. The drawing is of one that does; {which}."
    if drawn.depth > SPARSE * drawn.width:
        area = value_of(drawn.sparse, "m^2")
        return (
            f"{said}Particles are rare, one on {area}, and drawn side by side: {loaded} of "
            f"{len(drawn.grains)} are {carry}"
        ) + (MET if drawn.met else "")
    return said + (
        f"Particles are those of a slab {value_of(drawn.depth, 'm')} deep: {loaded} of "
        f"{len(drawn.grains)} are {carry}" + (MET if drawn.met else "")
    )


def _legend(names: tuple[str, ...]) -> None:
    from ...views.palette import OKABE_ITO
    from ..cross_section import COLOURS

    for i, name in enumerate(names):
        swatch(f"background:{COLOURS[i % len(COLOURS)]}", name)
    if names:
        swatch(f"border:3px solid {OKABE_ITO['vermilion']}", "loaded")
        swatch("border:1px dashed currentColor", "free")
    swatch(f"background:{OKABE_ITO['vermilion']};height:5px", "asperity contact")


def swatch(style: str, name: str) -> None:
    """A word of a key."""
    with ui.row().classes("items-center gap-2 no-wrap"):
        ui.element("div").style(f"width:18px;height:14px;border-radius:4px;{style}")
        ui.label(name).classes("hint")


def _one(value: Any) -> float:
    return float(value)
