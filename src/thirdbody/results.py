"""Answers by their names: what `solve`, `transitions`, `sensitivity` and their kin return.

You receive these and rarely make one; they stand here for annotations, for ``isinstance``
and for their pages in the reference. Each has columns with symbol, unit and meaning.

- `Equilibrium`: of `solve`, the solved states
- `Status`: what became of a state, the enumeration behind `Equilibrium.status_code`
- `Transitions`: of `transitions`, critical loads; `Critical`: one of them; `TurningPoint`: three
- `Assessment`: of `assess`, how sure the answer is, on one page
- `Sensitivity`: of `sensitivity`, derivatives with respect to inputs
- `Propagation`: of `propagate`, bands on results
- `Best`: of `design`, the best inputs
- `LifeHistory`: of `life`, an oil and its contact over time
- `MixedFilm`: of `films.mixed_film`, a lubricated contact
- `Coupled`, `CoupledState`: of `equilibria.coupled`, states that agree with their heat
- `ExplicitState`: of `explicit.solve`, one surface with every particle at its place
- `Ensemble`: of `explicit.ensemble`, many such surfaces against the statistical model
- `StudyResult`, `FilmResult`: of a study file, dry and with its film
"""

from .analysis.assessment import Assessment
from .analysis.design.design import Best
from .analysis.sensitivity import Sensitivity
from .analysis.uncertainty.propagation import Propagation
from .equilibrium.columns import Equilibrium
from .equilibrium.status import Status
from .equilibrium.transitions import Critical, Transitions, TurningPoint
from .explicit.ensemble import Ensemble
from .explicit.state import ExplicitState
from .study.results import FilmResult, StudyResult
from .systems.coupled import Coupled, CoupledState
from .systems.life.history import LifeHistory
from .systems.mixed_film import MixedFilm

__all__ = [
    "Assessment",
    "Best",
    "Coupled",
    "CoupledState",
    "Critical",
    "Ensemble",
    "Equilibrium",
    "ExplicitState",
    "FilmResult",
    "LifeHistory",
    "MixedFilm",
    "Propagation",
    "Sensitivity",
    "Status",
    "StudyResult",
    "Transitions",
    "TurningPoint",
]
