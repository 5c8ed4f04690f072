"""The interface in section, to scale, at the operating load."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

from nicegui import ui

import thirdbody as tb

from ...equilibrium.columns import COLUMNS
from ...equilibrium.words import MODES, NO_CONTACT, carried, load_of, mode_of, two_bodies
from ...quantities.say import number, percent, value_of
from ...systems.bodies import press
from ..cross_section import section, to_svg
from ..state import Answer, State
from ..widgets import Facts

__all__ = ["TITLE", "abouts", "build", "headline", "swatch", "told"]

TITLE = "Interface"
LETTERS = {"h": "h", "d": "d", "F*": "F_star"}
FILM = "The study has an oil film: here surfaces and particles carry the load alone; see Film."
MEAN = "The page opens at the mean pressure; the slider of the load goes up to the largest."
MET = (
    " Where a population carries and the slab held none of its loaded particles, one of them is "
    "drawn in the place of a free one."
)


def headline(point: tb.Equilibrium) -> str:
    """The answer as a sentence, of the clauses of the command line."""
    load = load_of(_one(point.pressure), _one(point.F_star))
    if not _one(point.A_t):
        return f"At {load} {mode_of(None)}."
    if point.contact.two_body:
        return f"At {load} {two_bodies()}."
    parts = {part.name: _one(part.load_share) for part in point.populations}
    share = carried(_one(point.particle_load_share), parts if len(parts) > 1 else None)
    return f"{share[0].upper()}{share[1:]} at {load}; {mode_of(str(point.mode) or None)}."


def told(point: tb.Equilibrium) -> list[tuple[str, str]]:
    """The state under the operating load, in the words of the command line."""
    at = [
        ("load", load_of(_one(point.pressure), _one(point.F_star))),
        ("separation h", value_of(_one(point.h), "m")),
        ("separation d", f"{value_of(_one(point.d), 'm')} ({number(_one(point.d_star))} σ)"),
        ("real contact area", percent(_one(point.A_t))),
    ]
    if not point.contact.two_body:
        at += [
            ("mode", str(point.mode) or NO_CONTACT),
            ("particles carry", percent(_one(point.particle_load_share))),
            ("of the real area", percent(_one(point.particle_area_share))),
        ]
        counted = point.outputs
        if "n_sa" not in counted:
            contact = point.contact.replace(outputs=(tb.outputs.Counts(),))
            counted = tb.solve(contact, d=_one(point.d)).outputs
        every = sum(dust.areal_density for dust in point.contact.populations)
        at.append(("particles loaded", percent(_one(counted["n_sa"]) / every)))
    for part in point.populations:
        at.append((f"{part.name} carries", percent(_one(part.load_share))))
    return at


def abouts() -> dict[str, str]:
    """What the letters and modes of the page mean."""
    letters = {name: COLUMNS[key]["meaning"] for name, key in LETTERS.items()}
    return {mode: mode_of(mode).removesuffix(f" ({mode})") for mode in MODES} | letters


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """The answer, the drawing, what it shows, and another draw."""
    seed = {"now": 0}
    answer = ui.label().classes("headline").props('data-fact="headline" role=status')
    forced = ui.label().classes("hint").props('data-fact="force"')
    film = ui.label(FILM).classes("hint").props('data-fact="film"')
    picture = (
        ui.html("", sanitize=False)
        .classes("w-full scroll-x")
        .props('data-figure="section" tabindex=0 role=group aria-label="cross-section"')
    )
    with ui.row().classes("w-full gap-4 items-center justify-between"):
        legend = ui.row().classes("gap-4")
        ui.button("Another place", icon="casino", on_click=lambda: another()).props(
            "flat dense no-caps"
        )
    means = abouts()
    numbers = Facts(
        {"separation h": means["h"], "separation d": means["d"], "load": means["F*"]}
        | {"mode": "; ".join(f"{mode}: {means[mode]}" for mode in MODES)}
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
    shown: dict[str, Any] = {"names": None}

    async def draw() -> None:
        assert state.answer is not None
        forced.set_text(under_force(state.answer))
        forced.set_visibility(bool(forced.text))
        film.set_visibility(state.answer.study.film is not None)
        bad, found = await state.ask(_drawn, state.at, seed["now"])
        status.set_text(bad)
        status.set_visibility(bool(bad))
        if bad:
            return
        svg, says, names, pairs, sentence = found
        answer.set_text(sentence)
        picture.set_content(svg)
        caption.set_text(says)
        if names != shown["names"]:
            shown["names"] = names
            legend.clear()
            with legend:
                _legend(names)
        numbers.show(pairs)

    async def another() -> None:
        seed["now"] += 1
        await draw()

    return draw


def under_force(answer: Answer) -> str:
    """What one force does to its bodies; empty where the load is none."""
    body, forces = answer.study.body, answer.study.forces
    if body is None or forces is None or not answer.forced:
        return ""
    said = press(answer.contact, body, float(forces[0]), integrate=False).sentence()
    return said if body.conjunction is None else f"{said} {MEAN}"


def _drawn(answer: Answer, at: float, seed: int) -> tuple[str, Any]:
    """What is wrong with the state; else the drawing, what it shows, whose, and the state."""
    point = answer.solve(at, tb.outputs.Counts())
    if str(point.status) != "ok":
        return str(point.status), None
    drawn = section(answer.contact, point, seed=seed)
    svg = to_svg(drawn, title="Cross-section of the interface, to scale")
    return "", (svg, _caption(drawn), drawn.names, told(point), headline(point))


def _caption(drawn: Any) -> str:
    said = (
        "One draw from the model, to scale. Below the rough surface of both bodies together, "
        "above the flat at the separation h from its mean plane (dotted). "
    )
    if not drawn.grains:
        return said
    loaded = sum(grain.loaded for grain in drawn.grains)
    return said + (
        f"Particles are those of a slab {value_of(drawn.depth, 'm')} deep: {loaded} of "
        f"{len(drawn.grains)} are larger than the gap above their seat and carry load."
        + (MET if drawn.met else "")
    )


def _legend(names: tuple[str, ...]) -> None:
    from ...views.plot.style import OKABE_ITO
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
