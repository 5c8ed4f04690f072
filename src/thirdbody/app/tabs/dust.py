"""From dust to numbers: what a code, a test dust or a concentration says of the particles."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

import numpy as np
from nicegui import events, ui

import thirdbody as tb

from ...errors import InvalidValue
from ...populations.measured.cleanliness import DUSTS
from ...quantities.say import percent, value_of
from ..bounds import LARGEST_TABLE, MOST_NUMBERS
from ..entries import about_of
from ..fields import text_of
from ..figures import Figure, escape_tags, figure, line
from ..inputs import Inputs
from ..solver import ask_for_page
from ..state import Answer, State
from ..text import as_shown, without_paths
from ..uploads import take
from ..widgets import facts, plot_place, upload
from ..worker import counter_bins

__all__ = ["TITLE", "build", "dust_facts", "size_figure"]

TITLE = "Dust"


def dust_facts(dust: tb.Particles) -> list[tuple[str, str]]:
    """One population in numbers."""
    sizes = dust.diameter
    low, middle, high = (float(sizes.ppf(q)) for q in (0.05, 0.5, 0.95))
    volume = sizes.moment(3) * np.pi / 6 * dust.areal_density
    return [
        ("particles per area", value_of(dust.areal_density, "1/m^2")),
        ("mean distance", value_of(dust.areal_density**-0.5, "m")),
        ("mean diameter", value_of(float(sizes.mean_diameter), "m")),
        (
            "5 %, 50 %, 95 % by number",
            ", ".join(value_of(size, "m") for size in (low, middle, high)),
        ),
        ("covered area", percent(dust.coverage)),
        ("volume per area", value_of(volume, "m")),
    ]


def size_figure(contact: tb.Contact) -> Figure:
    """Sizes of every population, by number and by volume."""
    traces = []
    for number, dust in enumerate(contact.populations):
        sizes = dust.diameter
        low, high = float(sizes.ppf(1e-4)), float(sizes.ppf(1 - 1e-6))
        if not low < high:
            low, high = 0.9 * low, 1.1 * high
        x = np.geomspace(max(low, 1e-3 * high), high, 240)
        density = np.asarray(sizes.pdf(x)) * x
        name = escape_tags(dust.name or dust.material.name or f"population {number + 1}")
        for k, (values, how) in enumerate(((density, "number"), (density * x**3, "volume"))):
            top = values.max() if np.isfinite(values).all() and values.max() > 0 else 1.0
            traces.append(line(1e6 * x, values / top, f"{name}, by {how}", 2 * number + k))
    return figure(traces, x="diameter [µm]", y="density per ln x, over its largest", title="Sizes")


STARTS = {
    "iso4406": {"iso4406": "18/16/13", "gap": "1 um"},
    "test_dust": {"test_dust": "A2", "areal_density": "1e9 / m^2"},
}
"""How a population begins that is given by a code, or by a test dust."""
KEPT = ("material", "name", "law")


def restart_population(table: dict[str, object], key: str, value: str) -> dict[str, object]:
    """A population given by another code or test dust; what goes with it is kept.

    >>> grains = {"material": "SiO2", "mean": "1 um", "areal_density": 1e9}
    >>> restart_population(grains, "iso4406", "16/14/11")
    {'material': 'SiO2', 'iso4406': '16/14/11', 'gap': '1 um'}
    """
    if key in table:
        return table | {key: value}
    kept = {name: table[name] for name in KEPT if name in table}
    start = STARTS[key]
    return kept | {name: table.get(name, default) for name, default in start.items()} | {key: value}


def build(state: State, again: Callable[[], None]) -> Callable[[], Awaitable[None]]:
    """A code, a test dust or a counted file, and what the particles amount to."""
    return Dust(state, again).draw


class Dust:
    """The first population, given in another way than by a distribution."""

    def __init__(self, state: State, again: Callable[[], None]) -> None:
        self.state, self.again = state, again
        with ui.element("div").classes("figures w-full"):
            with ui.column().classes("w-full narrow"):
                self._form()
            with ui.column().classes("w-full"):
                self.plot = plot_place("sizes")
                self.table = ui.column().classes("w-full")

    def _form(self) -> None:
        ui.label(
            "The first population as a cleanliness code of the oil, as a test dust, or as a "
            "particle counter found it. Everything else of it, other codes, distributions and "
            "concentrations stand at the side under Particles."
        ).classes("hint")
        self.code = ui.input("cleanliness code ISO 4406", placeholder="18/16/13")
        self.code.props('debounce=500 data-path="dust.iso4406"').classes("w-full")
        self.code.on_value_change(lambda e: self._use("iso4406", str(e.value or "").strip()))
        self.test = ui.select(list(DUSTS), label="test dust ISO 12103-1", clearable=False)
        self.test.props('data-path="dust.test_dust"').classes("w-full")
        self.test.on_value_change(lambda e: self._use("test_dust", str(e.value or "")))
        self.wrong = ui.label().classes("problem").props('role=alert data-said="dust"')
        self.chooser = upload(
            "sizes", "Sizes from a particle counter", LARGEST_TABLE, self._take_counts
        )

    def _particles(self) -> dict[str, object]:
        table = self.state.get(*Inputs.first_population(self.state))
        return table if isinstance(table, dict) else {"material": "SiO2"}

    def _set_particles(self, table: dict[str, object]) -> None:
        self.state.set(*Inputs.first_population(self.state), table, whole=True)
        self.again()

    def _use(self, key: str, value: str) -> None:
        if value and self._particles().get(key) != value:
            self._set_particles(restart_population(self._particles(), key, value))

    async def _take_counts(self, event: events.UploadEventArguments) -> None:
        self.chooser.reset()
        try:
            name = await take(self.state, event)
            bins = await ask_for_page(counter_bins, str(self.state.folder / name))
        except InvalidValue as error:
            self.wrong.set_text(as_shown(without_paths("; ".join(error.problems))))
            return
        kept = {k: v for k, v in self._particles().items() if k in (*KEPT, "areal_density")}
        kept.setdefault("areal_density", "1e9 / m^2")
        few = len(bins["edges"]) <= MOST_NUMBERS
        # in the study itself they are in its address, so that a reload keeps them
        self._set_particles(kept | {"sizes": bins if few else name})

    async def draw(self) -> None:
        table = self._particles()
        self.code.set_value(text_of(table.get("iso4406")))
        dust_name = table.get("test_dust")
        self.test.set_value(
            dust_name if isinstance(dust_name, str) and dust_name in DUSTS else None
        )
        mine = [text for text in self.state.problems if about_of(text).startswith("particles")]
        self.wrong.set_text(as_shown(" ".join(mine)))
        answer = self.state.answer
        none = answer is None or answer.contact.two_body
        self.plot.set_visibility(not none)
        if none:
            self.table.clear()
            return
        drawn, populations = await self.state.ask(_figure_and_rows)
        self.plot.update_figure(drawn)
        self.table.clear()
        with self.table:
            for name, numbers in populations:
                ui.label(name).classes("subhead")
                with ui.row().classes("facts w-full"):
                    facts(numbers)


def _figure_and_rows(
    answer: Answer,
) -> tuple[Figure, list[tuple[str, list[tuple[str, str]]]]]:
    """The figure, and the numbers of each population."""
    contact = answer.contact
    populations = [
        (dust.name or dust.material.name, dust_facts(dust)) for dust in contact.populations
    ]
    return size_figure(contact), populations
