"""The interface in section, to scale, at the operating load."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

from nicegui import ui

import thirdbody as tb

from ...equilibrium.words import NO_CONTACT, load_of
from ...quantities.say import number, percent, value_of
from ..cross_section import section, to_svg
from ..state import Answer, State
from ..widgets import facts

__all__ = ["TITLE", "build", "told"]

TITLE = "Interface"


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
        counted = tb.solve(
            point.contact.replace(outputs=(tb.outputs.Counts(),)), d=_one(point.d)
        ).outputs
        every = sum(dust.areal_density for dust in point.contact.populations)
        at.append(("particles loaded", percent(_one(counted["n_sa"]) / every)))
    for part in point.populations:
        at.append((f"{part.name} carries", percent(_one(part.load_share))))
    return at


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """The drawing, what it shows, and another draw."""
    seed = {"now": 0}
    with ui.row().classes("w-full items-center justify-between"):
        caption = ui.label().classes("hint grow")
        ui.button("Another place", icon="casino", on_click=lambda: another()).props("flat dense")
    picture = (
        ui.html("", sanitize=False)
        .classes("w-full scroll-x")
        .props('data-figure="section" tabindex=0')
    )
    legend = ui.row().classes("w-full gap-4")
    table = ui.row().classes("facts w-full")
    status = ui.label().classes("problem")

    async def draw() -> None:
        bad, found = await state.ask(_drawn, state.at, seed["now"])
        status.set_text(bad)
        status.set_visibility(bool(bad))
        if bad:
            return
        svg, says, names, numbers = found
        picture.set_content(svg)
        caption.set_text(says)
        legend.clear()
        with legend:
            _legend(names)
        table.clear()
        with table:
            facts(numbers)

    async def another() -> None:
        seed["now"] += 1
        await draw()

    return draw


def _drawn(answer: Answer, at: float, seed: int) -> tuple[str, Any]:
    """What is wrong with the state; else the drawing, what it shows, whose, and the state."""
    point = answer.solve(at)
    if str(point.status) != "ok":
        return str(point.status), None
    drawn = section(answer.contact, point, seed=seed)
    svg = to_svg(drawn, title="Cross-section of the interface, to scale")
    return "", (svg, _caption(drawn), drawn.names, told(point))


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
    )


def _legend(names: tuple[str, ...]) -> None:
    from ...views.plot.style import OKABE_ITO
    from ..cross_section import COLOURS

    for i, name in enumerate(names):
        _swatch(f"background:{COLOURS[i % len(COLOURS)]}", name)
    if names:
        _swatch(f"border:3px solid {OKABE_ITO['vermilion']}", "loaded")
        _swatch("border:1px dashed currentColor", "free")
    _swatch(f"background:{OKABE_ITO['vermilion']};height:5px", "asperity contact")


def _swatch(style: str, name: str) -> None:
    with ui.row().classes("items-center gap-2 no-wrap"):
        ui.element("div").style(f"width:18px;height:14px;border-radius:4px;{style}")
        ui.label(name).classes("hint")


def _one(value: Any) -> float:
    return float(value)
