"""Contact of rough surfaces with particles between them.

Populations say what lies in the interface, laws say what one contact does, a `Contact`
integrates laws over populations, and `solve` finds the separation that balances the load.
"""

from typing import TYPE_CHECKING, Any

from . import asperity, particle
from .citations import cite
from .compare import compare
from .contact import Contact
from .distributions import (
    Distribution,
    Histogram,
    LogNormal,
    Mixture,
    Monodisperse,
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
from .states import solve_states
from .surfaces import Roughness
from .sweep import sweep
from .transitions import Critical, Transitions, TurningPoint, transitions

__version__ = "0.1.0"

if TYPE_CHECKING:
    from . import fractal, interaction, plot, reference, rough_body, waviness

__all__ = [
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
    "LogNormal",
    "Material",
    "MaterialPair",
    "Mixture",
    "Monodisperse",
    "NoEquilibrium",
    "NoTransition",
    "Particles",
    "RangeWarning",
    "Roughness",
    "Sensitivity",
    "ThirdBodyError",
    "Transitions",
    "TruncatedGaussian",
    "TurningPoint",
    "Uniform",
    "Weibull",
    "WeibullHeights",
    "asperity",
    "cite",
    "compare",
    "fractal",
    "interaction",
    "materials",
    "particle",
    "plot",
    "pull_off",
    "reference",
    "roots",
    "rough_body",
    "sensitivity",
    "solve",
    "solve_states",
    "sweep",
    "transitions",
    "waviness",
]


# imported when first used, to keep the start quick
_LATER = frozenset({"fractal", "interaction", "plot", "reference", "rough_body", "waviness"})


def __getattr__(name: str) -> Any:
    if name in _LATER:
        from importlib import import_module

        return import_module(f".{name}", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
