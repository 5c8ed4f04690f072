"""What a study found, and how the parts of its report name it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ...analysis.assessment import Assessment
from ...analysis.sensitivity import Sensitivity
from ...contact.contact import Contact
from ...contact.evaluation import bodies_of
from ...equilibrium.columns import Equilibrium
from ...equilibrium.words import CRITICAL, load_of
from ...populations.materials import Material
from ...study import Study
from ...study.one_surface import OneSurface


@dataclass(frozen=True, kw_only=True)
class Found:
    """What a study found; every attribute as `Report` lists it."""

    study: Study
    result: dict[str, Any] = field(repr=False)
    curve: Equilibrium = field(repr=False)
    assessment: Assessment | None
    slopes: Sensitivity | None
    at: int
    file: str = field(repr=False, default="")
    film: dict[str, Any] | None = field(repr=False, default=None)
    pressed: OneSurface | str | None = field(repr=False, default=None)

    @property
    def contact(self) -> Contact:
        """The interface."""
        return self.study.contact

    def _solved_places(self) -> list[int]:
        return [i for i, status in enumerate(self.result["states"]["status"]) if status == "ok"]

    def _load(self, i: int) -> str:
        states = self.result["states"]
        return load_of(states["pressure"][i], states["F_star"][i])

    def _at_load(self, i: int) -> str:
        return f"{'At' if self.film is None else 'Without the oil, at'} {self._load(i)}"

    def _existing_loads(self, *names: str) -> dict[str, float]:
        """Critical loads F* that exist."""
        values = {name: self._entry(name)["value"] for name in names or CRITICAL}
        return {name: value for name, value in values.items() if value}

    def _entry(self, name: str) -> dict[str, Any]:
        head, _, which = name.partition(" ")
        entry = self.result["transitions"][head]
        return entry[which] if which else entry

    def _bodies(self) -> dict[str, Material]:
        return bodies_of(self.contact)


def some_of(total: int, most: int) -> list[int]:
    """Numbers of at most so many states, evenly spread."""
    rows = min(total, most)
    return [round(row * (total - 1) / max(rows - 1, 1)) for row in range(rows)]
