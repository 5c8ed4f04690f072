"""The particles at the side: every population with its material, sizes and number."""

from __future__ import annotations

from collections.abc import Mapping

from nicegui import ui

import thirdbody as tb

from ..quantities.say import value_of
from ..study.particles import AMOUNT, COUNTED
from .entries import Entries, Place
from .fields import COUNTED_FIELDS, VARIANTS, Field, fields_of, number_field, options_of, text_of
from .state import State

__all__ = ["ParticleInputs"]

SIZES = (*VARIANTS["distribution"], *COUNTED)
AMOUNTS = ("gap", "particle_density", "oil_density")


def bins_in_words(bins: Mapping[str, object]) -> str:
    """What a counter found, in a few words.

    >>> bins_in_words({"edges": [1e-6, 2e-6, 4e-6], "counts": [5, 1]})
    '2 bins from 1 µm to 4 µm'
    """
    edges = bins.get("edges")
    if not isinstance(edges, list) or len(edges) < 2:
        return "bins in the study file"
    ends = [value_of(edge, "m") if isinstance(edge, float) else text_of(edge) for edge in edges]
    return f"{len(edges) - 1} bins from {ends[0]} to {ends[-1]}"


CURRENT = {"": "as the material", "yes": "they conduct", "no": "they insulate"}
"""What may be said of a current through the particles."""


class ParticleInputs(Entries):
    """Widgets of [particles] and [particle_law]."""

    @staticmethod
    def first_population(state: State) -> Place:
        """Where the first population stands, or would."""
        return ("particles", 0) if isinstance(state.get("particles"), list) else ("particles",)

    def populations(self) -> list[Place]:
        """Where each population of particles stands."""
        particles = self.state.get("particles")
        if isinstance(particles, list):
            return [("particles", i) for i in range(len(particles))]
        return [("particles",)] if particles is not None else []

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
            "iso14644": "iso14644: class of a clean room",
        }
        self.select(
            (*place, "distribution"),
            labels,
            kind or "",
            "sizes",
            lambda w: self._set_sizes_kind(place, w),
        )
        if kind in COUNTED:
            self._build_count(place, kind, table[kind])
        elif kind in VARIANTS["distribution"]:
            for field in fields_of(VARIANTS["distribution"][kind]):
                self.field(place, field)
        self.amount(place, kind)
        self.field(place, Field(name="name", kind="string", label="name", about="in the results"))
        if not isinstance(table.get("strength"), dict):  # a table stands in the file alone
            about = "material: that of the library; empty: never break"
            self.field(place, Field(name="strength", kind="string", label="strength", about=about))
        flows = table.get("conducts")
        said = "yes" if flows is True else "no" if flows is False else ""
        self.select(
            (*place, "conducts"), CURRENT, said, "current",
            lambda word: self.state.set(*place, "conducts", {"yes": True, "no": False}.get(word)),
        )  # fmt: skip
        if kind != "weibull":  # whose own shape has the name
            label = "shape of these particles"
            self.variant((*place, "shape"), VARIANTS["shape"], "sphere", label, tag="kind")
        self.variant(
            (*place, "law"), VARIANTS["particle"], "", "law of these particles", blank="as below"
        )

    def _build_count(self, place: Place, kind: str, count: object) -> None:
        """A code, or what a counter found, and their options."""
        if isinstance(count, dict):  # dropped on the page
            ui.label(f"{kind}: {bins_in_words(count)}").classes("hint")
        else:
            examples = {"iso4406": "18/16/13", "test_dust": "A2", "sizes": "sizes.csv"}
            example = (examples | {"iso14644": "7"}).get(kind, "6")
            about = f"as written, e.g. {example}"
            self.field(place, Field(name=kind, kind="string", label=kind, about=about))
        for field in COUNTED_FIELDS[kind]:
            self.field(place, field)

    def amount(self, place: Place, kind: object) -> None:
        """Per area, or a concentration and the gap; what settles is counted by its class."""
        if kind == "iso14644":
            return
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

    def _set_sizes_kind(self, place: Place, word: str) -> None:
        """Another way to give the sizes: what does not go with it goes."""
        table = self.table(*place)
        common = ("material", "name", "law", "strength", "conducts")
        kept = {key: table[key] for key in common if key in table}
        if isinstance(shape := table.get("shape"), dict) and word != "weibull":
            kept["shape"] = shape
        amounts = {key: table[key] for key in ("areal_density", *AMOUNTS) if key in table}
        starts: dict[str, dict[str, object]] = {
            "iso4406": {"iso4406": "18/16/13", "gap": table.get("gap", "1 um")},
            "as4059": {"as4059": "6", "gap": table.get("gap", "1 um")},
            "nas1638": {"nas1638": "6", "gap": table.get("gap", "1 um")},
            "test_dust": {"test_dust": "A2"} | {"areal_density": "1e9 / m^2"} | amounts,
            "sizes": {"sizes": table.get("sizes", "sizes.csv")} | amounts,
            "iso14644": {
                "iso14644": 7,
                "exposure": "24 h",
                "particle_density": table.get("particle_density", "2650 kg/m^3"),
            },
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
        particles = self.state.get("particles")
        if particles is None:
            self.change("particles", new)
            return
        several = particles if isinstance(particles, list) else [particles]
        name = f"population {len(several) + 1}"
        self.change("particles", [*several, new | {"name": name}])

    def _remove(self, place: Place) -> None:
        particles = self.state.get("particles")
        if not isinstance(particles, list):
            study = {k: v for k, v in self.state.study.items() if k not in ("particles",)}
            study.pop("particle_law", None)
            self.state.replace(study)
            self.again()
            return
        left = [population for i, population in enumerate(particles) if i != place[1]]
        self.change("particles", left if len(left) > 1 else left[0])
