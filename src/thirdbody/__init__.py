"""Contact of rough surfaces with particles between them.

Populations say what lies in the interface, laws say what one contact does, a `Contact`
integrates laws over populations, and `solve` finds the separation that balances the load.
"""

from typing import TYPE_CHECKING, Any

from . import asperity, outputs, particle, surfaces
from .assess import Assessment, assess
from .citations import cite
from .compare import compare
from .contact import Contact
from .design import Limit, Objective, Suspension, design, equal_share_size
from .distributions import (
    Distribution,
    Histogram,
    LogNormal,
    Mixture,
    Monodisperse,
    PowerLaw,
    TruncatedGaussian,
    Uniform,
    Weibull,
)
from .ellipticity import Ellipticity
from .equilibrium import Equilibrium, pull_off, roots, solve
from .errors import InvalidValue, NoEquilibrium, NoTransition, RangeWarning, ThirdBodyError
from .heights import (
    ExponentialHeights,
    GaussianHeights,
    Heights,
    HistogramHeights,
    JohnsonHeights,
    WeibullHeights,
)
from .materials import Material, MaterialPair, materials
from .particles import Particles
from .sensitivities import Sensitivity, sensitivity
from .spectral import SpectralMoments
from .states import solve_states
from .surfaces import Roughness
from .sweep import sweep
from .topography import Topography
from .transitions import Critical, Transitions, TurningPoint, transitions
from .uncertainty import Propagation, Uncertain, critical_loads, propagate

__version__ = "0.1.0"

if TYPE_CHECKING:
    from . import films, fractal, interaction, plot, reference, rough_body, synthetic, waviness
    from .lubrication import mixed_film, stribeck

__all__ = [
    "Assessment",
    "Contact",
    "Critical",
    "Distribution",
    "Ellipticity",
    "Equilibrium",
    "ExponentialHeights",
    "GaussianHeights",
    "Heights",
    "Histogram",
    "HistogramHeights",
    "InvalidValue",
    "JohnsonHeights",
    "Limit",
    "LogNormal",
    "Material",
    "MaterialPair",
    "Mixture",
    "Monodisperse",
    "NoEquilibrium",
    "NoTransition",
    "Objective",
    "Particles",
    "PowerLaw",
    "Propagation",
    "RangeWarning",
    "Roughness",
    "Sensitivity",
    "SpectralMoments",
    "Suspension",
    "ThirdBodyError",
    "Topography",
    "Transitions",
    "TruncatedGaussian",
    "TurningPoint",
    "Uncertain",
    "Uniform",
    "Weibull",
    "WeibullHeights",
    "asperity",
    "assess",
    "cite",
    "compare",
    "critical_loads",
    "design",
    "equal_share_size",
    "films",
    "fractal",
    "interaction",
    "materials",
    "mixed_film",
    "outputs",
    "particle",
    "plot",
    "propagate",
    "pull_off",
    "reference",
    "roots",
    "rough_body",
    "sensitivity",
    "solve",
    "solve_states",
    "stribeck",
    "surfaces",
    "sweep",
    "synthetic",
    "transitions",
    "waviness",
]


# imported when first used, to keep the start quick
_LATER = frozenset(
    {"films", "fractal", "interaction", "plot", "reference", "rough_body", "synthetic", "waviness"}
)
_HOME = {"mixed_film": "lubrication", "stribeck": "lubrication"}


def __getattr__(name: str) -> Any:
    from importlib import import_module

    if name in _LATER:
        return import_module(f".{name}", __name__)
    if name in _HOME:
        return getattr(import_module(f".{_HOME[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
