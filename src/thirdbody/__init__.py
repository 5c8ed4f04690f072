"""Contact of rough surfaces with particles between them.

Populations say what lies in the interface, laws say what one contact does, a `Contact`
integrates laws over populations, and `solve` finds the separation that balances the load.

Describe
    `Contact`, `MaterialPair`, `Material`, `materials`, `Roughness`, `Particles`,
    `TruncatedGaussian`, `LogNormal`
Solve, and what each gives
    `solve`: an `Equilibrium`; `transitions`: `Transitions`; `table`: a `ContactTable`;
    `sweep`: an `xarray.Dataset`; `compare`: an `xarray.Dataset`
How sure
    `assess`: an `Assessment`; `sensitivity`: a `Sensitivity`; `propagate`: a `Propagation` of
    inputs that are `Uncertain`
Decide
    `design`: a `Best`; `life`: a `LifeHistory`, or without oil a `DryHistory`; `cite`: a `str`, the
    works behind an answer
A study file
    `load_study`: a `Study`, with methods `solve`: an `Equilibrium`, and `stribeck`: an
    `xarray.Dataset`. In `thirdbody.study` stand `run_study`: a `StudyResult`, all that the command
    ``solve`` prints; and `run_film`: a `FilmResult`, all that ``film`` prints

Modules hold the rest:

surfaces, heights
    measured, drawn and made surfaces; heights of asperities
distributions, sizes, dust, grains
    sizes of particles, measured sizes, cleanliness codes, grains that break
asperity, particle, outputs
    laws of one contact, and what a solved contact does
equilibria, objectives, results, errors
    more states, what a design is asked, answers and errors by their names
films, oil, systems
    lubricated contacts, the life of an oil, bodies and bearings; the life of a bearing by ISO 281
    is in `systems.bearing_life`, the sizes of bearings are in `systems.bearing_sizes`
explicit, plot, reference
    every particle at its place, figures, exact solutions
"""

from typing import TYPE_CHECKING, Any

from .version import __version__ as __version__

# isort: off
if TYPE_CHECKING:
    from . import (
        asperity,
        distributions,
        dust,
        equilibria,
        errors,
        explicit,
        films,
        grains,
        heights,
        objectives,
        oil,
        outputs,
        particle,
        plot,
        reference,
        results,
        sizes,
        surfaces,
        systems,
    )
    from .analysis.assess import assess
    from .analysis.compare import compare
    from .analysis.design.design import design
    from .analysis.sensitivity import sensitivity
    from .analysis.sweep.sweep import sweep
    from .analysis.uncertainty.inputs import Uncertain
    from .analysis.uncertainty.propagation import propagate
    from .contact.citations import cite
    from .contact.contact import Contact
    from .equilibrium.solve import solve
    from .equilibrium.table.make import table
    from .equilibrium.transitions import transitions
    from .populations.distributions import LogNormal, TruncatedGaussian
    from .populations.materials import Material, MaterialPair, materials
    from .populations.particles import Particles
    from .populations.roughness import Roughness
    from .study.whole import load_study
    from .systems.life.run import life

    # names "as" themselves: they stand in a module that is listed, and work at the top too
    from .equilibria import (
        coupled as coupled,
        critical_loads as critical_loads,
        equal_share_size as equal_share_size,
        pull_off as pull_off,
        roots as roots,
        solve_states as solve_states,
    )
    from .errors import (
        InvalidValue as InvalidValue,
        NoEquilibrium as NoEquilibrium,
        NoTransition as NoTransition,
        RangeWarning as RangeWarning,
        SlowWarning as SlowWarning,
        ThirdBodyError as ThirdBodyError,
    )
    from .films import mixed_film as mixed_film, stribeck as stribeck
    from .grains import Angular as Angular, Sphere as Sphere, WeibullStrength as WeibullStrength
    from .objectives import Limit as Limit, Objective as Objective, Suspension as Suspension
    from .oil import (
        Debris as Debris,
        Filter as Filter,
        Ingress as Ingress,
        OilCircuit as OilCircuit,
        OilDirt as OilDirt,
        RunningIn as RunningIn,
        SizeClasses as SizeClasses,
        entry_ratio_from_dents as entry_ratio_from_dents,
        oil_reports as oil_reports,
        until as until,
    )
    from .populations.distributions import (
        Distribution as Distribution,
        Histogram as Histogram,
        Mixture as Mixture,
        Monodisperse as Monodisperse,
        PowerLaw as PowerLaw,
        Uniform as Uniform,
        Weibull as Weibull,
    )
    from .populations.heights import (
        ExponentialHeights as ExponentialHeights,
        GaussianHeights as GaussianHeights,
        Heights as Heights,
        HistogramHeights as HistogramHeights,
        JohnsonHeights as JohnsonHeights,
        WeibullHeights as WeibullHeights,
    )
    from .populations.measured import synthetic as synthetic
    from .results import (
        Assessment as Assessment,
        Critical as Critical,
        Equilibrium as Equilibrium,
        LifeHistory as LifeHistory,
        Propagation as Propagation,
        Sensitivity as Sensitivity,
        Transitions as Transitions,
        TurningPoint as TurningPoint,
    )
    from .surfaces import (
        Ellipticity as Ellipticity,
        Finish as Finish,
        SpectralMoments as SpectralMoments,
        Topography as Topography,
    )
    from .systems import (
        feedback as feedback,
        fractal as fractal,
        interaction as interaction,
        rough_body as rough_body,
        waviness as waviness,
    )
# isort: on

__all__ = [
    "Contact",
    "LogNormal",
    "Material",
    "MaterialPair",
    "Particles",
    "Roughness",
    "TruncatedGaussian",
    "Uncertain",
    "asperity",
    "assess",
    "cite",
    "compare",
    "design",
    "distributions",
    "dust",
    "equilibria",
    "errors",
    "explicit",
    "films",
    "grains",
    "heights",
    "life",
    "load_study",
    "materials",
    "objectives",
    "oil",
    "outputs",
    "particle",
    "plot",
    "propagate",
    "reference",
    "results",
    "sensitivity",
    "sizes",
    "solve",
    "surfaces",
    "sweep",
    "systems",
    "table",
    "transitions",
]

# imported when first used, to keep the start quick
_MODULES = {
    "asperity": "asperity",
    "distributions": "distributions",
    "dust": "dust",
    "equilibria": "equilibria",
    "errors": "errors",
    "explicit": "explicit",
    "feedback": "systems.feedback",
    "films": "films",
    "fractal": "systems.fractal",
    "grains": "grains",
    "heights": "heights",
    "interaction": "systems.interaction",
    "objectives": "objectives",
    "oil": "oil",
    "outputs": "outputs",
    "particle": "particle",
    "plot": "plot",
    "reference": "reference",
    "results": "results",
    "rough_body": "systems.rough_body",
    "sizes": "sizes",
    "surfaces": "surfaces",
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
"""The module of every other name; one that `__all__` leaves out stands in a listed module too."""


def __getattr__(name: str) -> Any:
    from importlib import import_module

    if name in _MODULES:
        value = import_module(f".{_MODULES[name]}", __name__)
    elif name in _HOMES:
        value = getattr(import_module(f".{_HOMES[name]}", __name__), name)
    else:
        from .quantities.nearest import no_attribute

        inside = (f"systems.{system}" for system in _systems())
        raise no_attribute(__name__, name, (*__all__, *_MODULES, *_HOMES, *inside))
    globals()[name] = value
    return value


def _systems() -> list[str]:
    from . import systems

    return systems.__all__


def __dir__() -> list[str]:
    special_names = (name for name in globals() if name.startswith("__"))
    return sorted({*special_names, *__all__})
