"""Answers by their names: what `solve`, `transitions`, `sensitivity` and their kin return.

A user receives these and rarely makes one; they stand here for annotations, for ``isinstance``
and for their pages in the reference. Each has columns with symbol, unit and meaning.
"""

from .analysis.assessment import Assessment
from .analysis.design.design import Best
from .analysis.sensitivity import Sensitivity
from .analysis.uncertainty.propagation import Propagation
from .equilibrium.columns import Equilibrium
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
    "StudyResult",
    "Transitions",
    "TurningPoint",
]
