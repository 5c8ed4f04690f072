"""What a study found, and how the parts of its report name it."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

from ...analysis.assessment import Assessment
from ...analysis.sensitivity import Sensitivity
from ...contact.contact import Contact
from ...contact.evaluation import bodies_of
from ...equilibrium.columns import Equilibrium
from ...equilibrium.transitions import Critical
from ...equilibrium.words import load_of
from ...populations.materials import Material
from ...study import FilmResult, Study, StudyResult
from ...study.dirty_oil import DirtyOil
from ...study.oil_what_ifs import OilWhatIf, what_ifs_of_oil
from ...study.one_surface import OneSurface
from ...study.run_connector import ConnectorResult
from ...study.run_dry import DryResult
from ...study.run_life import LifeResult
from ...study.run_plate import PlateResult


@dataclass(frozen=True, kw_only=True)
class Found:
    """Results of a study; every attribute as `Report` lists it."""

    study: Study
    result: StudyResult = field(repr=False)
    curve: Equilibrium = field(repr=False)
    assessment: Assessment | None
    slopes: Sensitivity | None
    at: int
    file: str = field(repr=False, default="")
    film: FilmResult | None = field(repr=False, default=None)
    pressed: OneSurface | str | None = field(repr=False, default=None)
    oil: DirtyOil | None = field(repr=False, default=None)
    oil_filtered: DirtyOil | None = field(repr=False, default=None)
    life: LifeResult | DryResult | None = field(repr=False, default=None)
    connector: ConnectorResult | None = field(repr=False, default=None)
    plate: PlateResult | None = field(repr=False, default=None)

    @property
    def contact(self) -> Contact:
        """The interface."""
        return self.study.contact

    @cached_property
    def oil_what_ifs(self) -> tuple[OilWhatIf, ...]:
        """What dents and life in the oil hang on."""
        return () if self.oil is None else what_ifs_of_oil(self.study, self.oil)

    @property
    def dry(self) -> str:
        """What heads of parts that leave the oil out say of it."""
        return "" if self.film is None else ", without the oil"

    def load(self, i: int) -> str:
        """The load of a state, in words."""
        states = self.result.states
        return load_of(states.pressure[i], states.F_star[i])

    def at_load(self, i: int) -> str:
        """Under which load, at the start of a sentence."""
        return f"{'At' if self.film is None else 'Without the oil, at'} {self.load(i)}"

    @property
    def mode_changes(self) -> dict[str, Critical]:
        """The critical loads at which the mode changes, or why there are none."""
        transitions = self.result.transitions
        return {"F_cr1": transitions.F_cr1, "F_cr2": transitions.F_cr2}

    def existing_loads(self) -> dict[str, float]:
        """Critical loads F* that exist."""
        return {name: entry.value for name, entry in self.mode_changes.items() if entry.value}

    def bodies(self) -> dict[str, Material]:
        """Surfaces and particles, by what they are called."""
        return bodies_of(self.contact)


def some_of(total: int, most: int) -> list[int]:
    """Numbers of at most so many states, evenly spread."""
    rows = min(total, most)
    return [round(row * (total - 1) / max(rows - 1, 1)) for row in range(rows)]
