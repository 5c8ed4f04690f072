"""Contact of rough surfaces with particles between them.

Populations say what lies in the interface, laws say what one contact does, a `Contact`
integrates laws over populations, and `solve` finds the separation that balances the load.
"""

from typing import TYPE_CHECKING, Any

from .version import __version__ as __version__

# names "as" themselves: reached at the top too, and listed in a module of their own
# isort: off
if TYPE_CHECKING:
    from . import (
        effects as outputs,
        errors as errors,
        explicit as explicit,
        reference,
        results as results,
        systems as systems,
    )
    from .analysis.assess import assess
    from .analysis.assessment import Assessment as Assessment
    from .analysis.compare import compare
    from .analysis.design.design import design
    from .analysis.design.equal_share import equal_share_size
    from .analysis.design.problem import Limit, Objective, Suspension
    from .analysis.sensitivity import Sensitivity as Sensitivity, sensitivity
    from .analysis.sweep.sweep import sweep
    from .analysis.uncertainty.inputs import Uncertain
    from .analysis.uncertainty.propagation import Propagation as Propagation, propagate
    from .contact.citations import cite
    from .contact.contact import Contact
    from .equilibrium.columns import Equilibrium as Equilibrium
    from .equilibrium.critical_loads import critical_loads
    from .equilibrium.solve import pull_off, roots, solve
    from .equilibrium.states import solve_states
    from .equilibrium.table.make import table
    from .equilibrium.transitions import (
        Critical as Critical,
        Transitions as Transitions,
        TurningPoint as TurningPoint,
        transitions,
    )
    from .errors import (
        InvalidValue as InvalidValue,
        NoEquilibrium as NoEquilibrium,
        NoTransition as NoTransition,
        RangeWarning as RangeWarning,
        SlowWarning as SlowWarning,
        ThirdBodyError as ThirdBodyError,
    )
    from .laws import asperity, particle
    from .populations import distributions as distributions, heights as heights
    from .populations.distributions import (
        Distribution as Distribution,
        Histogram,
        LogNormal,
        Mixture,
        Monodisperse,
        PowerLaw,
        TruncatedGaussian,
        Uniform,
        Weibull,
    )
    from .populations.ellipticity import Ellipticity
    from .populations.finish import Finish
    from .populations.heights import (
        ExponentialHeights as ExponentialHeights,
        GaussianHeights as GaussianHeights,
        Heights as Heights,
        HistogramHeights as HistogramHeights,
        JohnsonHeights as JohnsonHeights,
        WeibullHeights as WeibullHeights,
    )
    from .populations.materials import Material, MaterialPair, materials
    from .populations.measured import cleanliness as dust, sizes, synthetic, topography as surfaces
    from .populations.measured.spectra import SpectralMoments as SpectralMoments
    from .populations.measured.topography import Topography as Topography
    from .populations.particles import Particles
    from .populations.roughness import Roughness
    from .populations.shape import Angular, Sphere
    from .populations.strength import WeibullStrength
    from .study.whole import load_study
    from .systems import (
        film_formulas as films,
        feedback,
        fractal as fractal,
        interaction as interaction,
        rough_body as rough_body,
        waviness as waviness,
    )
    from .systems.coupled import coupled
    from .systems.life import until as until
    from .systems.life.circuit import OilCircuit
    from .systems.life.debris import Debris
    from .systems.life.entry import entry_ratio_from_dents
    from .systems.life.history import LifeHistory as LifeHistory
    from .systems.life.ingress import Ingress
    from .systems.life.oil_dirt import OilDirt
    from .systems.life.reports import oil_reports
    from .systems.life.run import life
    from .systems.life.size_classes import SizeClasses
    from .systems.life.surfaces import RunningIn
    from .systems.mixed_film import mixed_film
    from .systems.oil_filter import Filter
    from .systems.stribeck import stribeck
    from .views import plot
# isort: on

__all__ = [
    "Angular",
    "Contact",
    "Debris",
    "Ellipticity",
    "Filter",
    "Finish",
    "Histogram",
    "Ingress",
    "Limit",
    "LogNormal",
    "Material",
    "MaterialPair",
    "Mixture",
    "Monodisperse",
    "Objective",
    "OilCircuit",
    "OilDirt",
    "Particles",
    "PowerLaw",
    "Roughness",
    "RunningIn",
    "SizeClasses",
    "Sphere",
    "Suspension",
    "TruncatedGaussian",
    "Uncertain",
    "Uniform",
    "Weibull",
    "WeibullStrength",
    "asperity",
    "assess",
    "cite",
    "compare",
    "coupled",
    "critical_loads",
    "design",
    "distributions",
    "dust",
    "entry_ratio_from_dents",
    "equal_share_size",
    "errors",
    "explicit",
    "feedback",
    "films",
    "heights",
    "life",
    "load_study",
    "materials",
    "mixed_film",
    "oil_reports",
    "outputs",
    "particle",
    "plot",
    "propagate",
    "pull_off",
    "reference",
    "results",
    "roots",
    "sensitivity",
    "sizes",
    "solve",
    "solve_states",
    "stribeck",
    "surfaces",
    "sweep",
    "synthetic",
    "systems",
    "table",
    "transitions",
    "until",
]

# imported when first used, to keep the start quick
_MODULES = {
    "asperity": "laws.asperity",
    "distributions": "populations.distributions",
    "dust": "populations.measured.cleanliness",
    "errors": "errors",
    "explicit": "explicit",
    "feedback": "systems.feedback",
    "films": "systems.film_formulas",
    "fractal": "systems.fractal",
    "heights": "populations.heights",
    "interaction": "systems.interaction",
    "outputs": "effects",
    "particle": "laws.particle",
    "plot": "views.plot",
    "reference": "reference",
    "results": "results",
    "rough_body": "systems.rough_body",
    "sizes": "populations.measured.sizes",
    "surfaces": "populations.measured.topography",
    "synthetic": "populations.measured.synthetic",
    "systems": "systems",
    "until": "systems.life.until",
    "waviness": "systems.waviness",
}
"""Modules by the names that users give them."""
_HOMES = {
    "Angular": "populations.shape",
    "Assessment": "analysis.assessment",
    "Contact": "contact.contact",
    "Critical": "equilibrium.transitions",
    "Debris": "systems.life.debris",
    "Distribution": "populations.distributions",
    "Ellipticity": "populations.ellipticity",
    "Equilibrium": "equilibrium.columns",
    "ExponentialHeights": "populations.heights",
    "Filter": "systems.oil_filter",
    "Finish": "populations.finish",
    "GaussianHeights": "populations.heights",
    "Heights": "populations.heights",
    "Histogram": "populations.distributions",
    "HistogramHeights": "populations.heights",
    "Ingress": "systems.life.ingress",
    "InvalidValue": "errors",
    "JohnsonHeights": "populations.heights",
    "LifeHistory": "systems.life.history",
    "Limit": "analysis.design.problem",
    "LogNormal": "populations.distributions",
    "Material": "populations.materials",
    "MaterialPair": "populations.materials",
    "Mixture": "populations.distributions",
    "Monodisperse": "populations.distributions",
    "NoEquilibrium": "errors",
    "NoTransition": "errors",
    "Objective": "analysis.design.problem",
    "OilCircuit": "systems.life.circuit",
    "OilDirt": "systems.life.oil_dirt",
    "Particles": "populations.particles",
    "PowerLaw": "populations.distributions",
    "Propagation": "analysis.uncertainty.propagation",
    "RangeWarning": "errors",
    "Roughness": "populations.roughness",
    "RunningIn": "systems.life.surfaces",
    "Sensitivity": "analysis.sensitivity",
    "SizeClasses": "systems.life.size_classes",
    "SlowWarning": "errors",
    "SpectralMoments": "populations.measured.spectra",
    "Sphere": "populations.shape",
    "Suspension": "analysis.design.problem",
    "ThirdBodyError": "errors",
    "Topography": "populations.measured.topography",
    "Transitions": "equilibrium.transitions",
    "TruncatedGaussian": "populations.distributions",
    "TurningPoint": "equilibrium.transitions",
    "Uncertain": "analysis.uncertainty.inputs",
    "Uniform": "populations.distributions",
    "Weibull": "populations.distributions",
    "WeibullHeights": "populations.heights",
    "WeibullStrength": "populations.strength",
    "assess": "analysis.assess",
    "cite": "contact.citations",
    "compare": "analysis.compare",
    "coupled": "systems.coupled",
    "critical_loads": "equilibrium.critical_loads",
    "design": "analysis.design.design",
    "entry_ratio_from_dents": "systems.life.entry",
    "equal_share_size": "analysis.design.equal_share",
    "life": "systems.life.run",
    "load_study": "study.whole",
    "materials": "populations.materials",
    "mixed_film": "systems.mixed_film",
    "propagate": "analysis.uncertainty.propagation",
    "oil_reports": "systems.life.reports",
    "pull_off": "equilibrium.solve",
    "roots": "equilibrium.solve",
    "sensitivity": "analysis.sensitivity",
    "solve": "equilibrium.solve",
    "solve_states": "equilibrium.states",
    "stribeck": "systems.stribeck",
    "sweep": "analysis.sweep.sweep",
    "table": "equilibrium.table.make",
    "transitions": "equilibrium.transitions",
}
"""The module of every other name; those that `__all__` leaves out stand in a named module too."""


def __getattr__(name: str) -> Any:
    from importlib import import_module

    if name in _MODULES:
        value = import_module(f".{_MODULES[name]}", __name__)
    elif name in _HOMES:
        value = getattr(import_module(f".{_HOMES[name]}", __name__), name)
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    special_names = (name for name in globals() if name.startswith("__"))
    return sorted({*special_names, *__all__})
