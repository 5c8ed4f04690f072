"""From dust to numbers: what a code, a test dust or a concentration says of the particles."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

import numpy as np
from nicegui import events, ui

import thirdbody as tb

from ...errors import InvalidValue
from ...quantities.say import percent, value_of
from ..bounds import LARGEST_TABLE
from ..figures import empty, figure, line, plain
from ..inputs import Inputs
from ..state import Answer, State
from ..uploads import keep
from ..widgets import facts

__all__ = ["TITLE", "build", "dust_facts", "size_figure"]

TITLE = "Dust"


def dust_facts(dust: tb.Particles) -> list[tuple[str, str]]:
    """One population in numbers."""
    sizes = dust.diameter
    low, middle, high = (float(sizes.ppf(q)) for q in (0.05, 0.5, 0.95))
    each = sizes.moment(3) * np.pi / 6 * dust.areal_density
    return [
        ("particles per area", value_of(dust.areal_density, "1/m^2")),
        ("mean distance", value_of(dust.areal_density**-0.5, "m")),
        ("mean diameter", value_of(float(sizes.mean_diameter), "m")),
        (
            "5 %, 50 %, 95 % by number",
            ", ".join(value_of(size, "m") for size in (low, middle, high)),
        ),
        ("covered area", percent(dust.coverage)),
        ("volume per area", value_of(each, "m")),
    ]


def size_figure(contact: tb.Contact) -> dict[str, Any]:
    """Sizes of every population, by number and by volume."""
    traces = []
    for number, dust in enumerate(contact.populations):
        sizes = dust.diameter
        low, high = float(sizes.ppf(1e-4)), float(sizes.ppf(1 - 1e-6))
        if not low < high:
            low, high = 0.9 * low, 1.1 * high
        x = np.geomspace(max(low, 1e-3 * high), high, 240)
        density = np.asarray(sizes.pdf(x)) * x
        name = plain(dust.name or dust.material.name or f"population {number + 1}")
        for k, (values, how) in enumerate(((density, "number"), (density * x**3, "volume"))):
            top = values.max() if np.isfinite(values).all() and values.max() > 0 else 1.0
            traces.append(line(1e6 * x, values / top, f"{name}, by {how}", 2 * number + k))
    return figure(traces, x="diameter [µm]", y="density per ln x, over its largest", title="Sizes")


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """Entries for the particles alone, and what they amount to."""
    ui.label(
        "Give the sizes and numbers of the particles as a cleanliness code (ISO 4406, NAS 1638, "
        "AS4059), a test dust (ISO 12103-1), a file of the particle counter, or a distribution "
        'with a concentration such as "0.1 wt%" and the gap that traps it.'
    ).classes("hint")

    def renewed() -> None:
        entries.refresh()
        again()

    inputs = Inputs(state, renewed)

    @ui.refreshable
    def entries() -> None:
        inputs.shown.clear()
        with ui.column().classes("w-full gap-2 narrow"):
            inputs.particles()
            inputs.rest = ui.column().classes("w-full")

    async def uploaded(event: events.UploadEventArguments) -> None:
        upload.reset()
        try:
            name = await keep(state.folder, event)
        except InvalidValue as error:
            ui.notify("; ".join(error.problems))
            return
        places = inputs.populations()
        if not places:
            ui.notify("Add particles first.")
            return
        place = places[0]
        table = dict(state.get(*place) or {})
        kept = {k: table[k] for k in ("material", "name", "law", "areal_density") if k in table}
        kept.setdefault("areal_density", "1e9 / m^2")
        inputs.change(*place, kept | {"sizes": name})

    with ui.element("div").classes("figures w-full"):
        with ui.column().classes("w-full"):
            entries()
            upload = ui.upload(
                label="Sizes from a particle counter",
                auto_upload=True,
                max_file_size=LARGEST_TABLE,
                max_files=1,
                on_upload=uploaded,
                on_rejected=lambda: ui.notify(f"more than {LARGEST_TABLE} bytes are not taken"),
            ).props('flat bordered data-upload="sizes"')
        with ui.column().classes("w-full"):
            plot = ui.plotly(empty(360)).classes("w-full")
            plot.props('data-figure="sizes"')
            table = ui.column().classes("w-full")

    seen: dict[str, Any] = {"particles": state.get("particles")}

    async def draw() -> None:
        now = state.get("particles")
        if _shape(now) != _shape(seen["particles"]):
            seen["particles"] = now
            entries.refresh()
        seen["particles"] = now
        inputs.tell()
        answer = state.answer
        assert answer is not None
        plot.set_visibility(not answer.contact.two_body)
        if answer.contact.two_body:
            table.clear()
            return
        drawn, told = await state.ask(_found)
        plot.update_figure(drawn)
        table.clear()
        with table:
            for name, numbers in told:
                ui.label(name).classes("subhead")
                with ui.row().classes("facts w-full"):
                    facts(numbers)

    return draw


def _found(answer: Answer) -> tuple[dict[str, Any], list[tuple[str, list[tuple[str, str]]]]]:
    """The figure, and the numbers of each population."""
    contact = answer.contact
    told = [(dust.name or dust.material.name, dust_facts(dust)) for dust in contact.populations]
    return size_figure(contact), told


def _shape(particles: Any) -> Any:
    """Which entries there are: the keys and the words, without the numbers."""
    if isinstance(particles, list):
        return [_shape(each) for each in particles]
    if not isinstance(particles, dict):
        return particles is None
    return sorted(particles), particles.get("distribution"), type(particles.get("material"))
