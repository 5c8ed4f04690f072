"""Everything that the page of a study shows, computed."""

from __future__ import annotations

import warnings
from collections.abc import Callable

import numpy as np

from ...analysis.assess import PARTS as ASSESSED
from ...analysis.assess import assess
from ...analysis.assessment import Assessment
from ...analysis.inputs import inputs
from ...analysis.sensitivity import Sensitivity, sensitivity
from ...analysis.uncertainty.inputs import stated_ranges
from ...analysis.uncertainty.samples import enough
from ...contact.contact import Contact
from ...equilibrium.columns import Equilibrium
from ...equilibrium.load import ForceLoad, as_force_load
from ...equilibrium.modes import FAINT
from ...equilibrium.solve import solve
from ...equilibrium.transitions import Transitions
from ...errors import InvalidValue, RangeWarning, ThirdBodyError
from ...quantities.progress import Stages, count_contacts, nested_stages
from ...study import Study, run_film, run_study
from ...study.dirty_oil import dirty_oil
from ...study.life import AskedDry
from ...study.one_surface import OneSurface, one_surface
from ...study.run_connector import run_connector
from ...study.run_life import run_life
from ...study.run_plate import run_plate
from ...systems.oil_filter import Filter
from .found import some_of
from .page import MOST_SAMPLES, Report, most_samples

DRAWN, WINDOW, BEYOND = 120, (1e-8, 1e-2), 5.0
"""Loads of the curves, F* within which they lie, and the factor beyond what is marked on them."""

USUAL = 1e-5
"""The load F* around which is drawn where the study presses nothing."""

MOST_PRESSED = 5
"""Loads under which one small surface is pressed point by point."""

PARTS = ("states", "error bars", "which inputs matter", "figures")
"""What is done one after the other until there is a page."""


def report(
    study: Study,
    *,
    file: str = "",
    progress: Callable[[str], None] = lambda stage: None,
    filter: Filter | None = None,
) -> Report:
    """Everything that the page of a study tells.

    Parameters
    ----------
    study : Study
        From `load_study`.
    file : str, optional
        The study file, to be printed at the end.
    progress : callable, optional
        Gets the name of each part of the work, as it begins.
    filter : Filter, optional
        Of a lubricated contact with particles: the oil before and behind it, side by side.

    Returns
    -------
    Report
        ``.html()`` is the page, ``.sentences()`` the answer in three sentences.

    Raises
    ------
    NoEquilibrium
        No state of the study has an equilibrium.

    Notes
    -----
    Error bars and elasticities are those at the middle of the loads. Error bars take what the
    table [uncertainty] says, in at most 256 samples (`assess` takes all that it asks for);
    without it, the ranges of the materials library, where it states some, but for particles that
    break, whose samples take a second each, and for a dry contact over time, whose own bars are of
    [life.uncertainty]. A table [explicit] has one small surface pressed, in
    seconds; `thirdbody.study.run_explicit` takes all that it asks for.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from thirdbody.study import load_study
    >>> file = Path(tempfile.mkdtemp()) / "study.toml"
    >>> _ = file.write_text('''
    ... [surfaces]
    ... first = "S45C"
    ... second = "S45C"
    ... [roughness]
    ... sigma = "100 nm"
    ... R = "2.8 um"
    ... [load]
    ... pressure = "5 MPa"
    ... ''')
    >>> print(report(load_study(file)).sentences()[0])
    At 5 MPa (F* = 4.468×10⁻⁵) asperities carry the whole load, because there are no particles.
    """
    progress(PARTS[0])
    result = run_study(study)
    result.need_state()
    states = result.states
    F_star = np.atleast_1d(states.F_star)
    solved_states = sorted(result.solved_states, key=lambda i: F_star[i])
    loaded = [i for i in solved_states if F_star[i] >= FAINT]
    some = loaded or solved_states
    if study.forces is not None and study.body is not None and study.body.conjunction is not None:
        # of the mean and the largest pressure of every force the mean, as `assess` takes it
        some = [i for i in some if i % 2 == 0] or some
    at = some[len(some) // 2]
    force_load = as_force_load(study.load, float(study.values[at]))
    if study.load == "separation":
        force_load = {"F_star": float(F_star[at])}
    bare = study.contact.replace(outputs=())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        curve = curve_over(bare, result.transitions, F_star[loaded].tolist() or [USUAL])
        pressed = None
        if study.explicit is not None and loaded:
            pressed = _press_surface(study, F_star[loaded].tolist())
        progress(PARTS[1])
        assessment = _assess(study, bare, force_load, progress) if loaded else None
        progress(PARTS[2])
        return Report(
            study=study,
            result=result,
            curve=curve,
            assessment=assessment,
            slopes=_slopes(bare, force_load, progress) if loaded else None,
            at=at,
            file=file,
            film=None if study.film is None else run_film(study),
            pressed=pressed,
            oil=dirty_oil(study),
            life=None if study.life is None else run_life(study.life),
            connector=None if study.connector is None else run_connector(study.connector),
            plate=None if study.plate is None else run_plate(study.plate),
            oil_filtered=None if filter is None else dirty_oil(study, filter=filter),
        )


def _press_surface(study: Study, loads: list[float]) -> OneSurface | str:
    """Press one small surface under a few of the loads; where that fails, the reason."""
    few = [loads[i] for i in some_of(len(loads), MOST_PRESSED)]
    try:
        return one_surface(study, few)
    except InvalidValue as error:
        return "; ".join(error.problems)


def curve_over(contact: Contact, critical: Transitions, loads: list[float]) -> Equilibrium:
    """States over the loads of the study, the critical ones, and somewhat beyond."""
    every = (loads[0], loads[-1], critical.F_cr1.value, critical.F_cr2.value)
    marked = [F for F in every if F]
    low = min(max(min(marked) / BEYOND, WINDOW[0]), loads[0])
    high = max(min(max(marked) * BEYOND, WINDOW[1]), loads[-1])
    return solve(contact, F_star=np.geomspace(low, high, DRAWN))


def _assess(
    study: Study, contact: Contact, force_load: ForceLoad[float], progress: Callable[[str], None]
) -> Assessment | None:
    inner = nested_stages(progress, len(ASSESSED))
    uncertainty = study.uncertainty
    if uncertainty is None:
        if isinstance(study.life, AskedDry):
            return None  # its answer is of the life, of which [life.uncertainty] says more
        breaks = any(population.strength is not None for population in contact.populations)
        ranges = stated_ranges(contact)
        if breaks or not ranges:
            return None
        samples = min(enough(contact, None, ranges), MOST_SAMPLES)
        return assess(contact, **force_load, samples=samples, progress=inner)
    loads = {"pressure", "F_star", "d"} - set(force_load)
    vary = {
        label: distribution
        for label, distribution in uncertainty.inputs.items()
        if label not in loads
    }
    if not vary:
        return None
    samples = min(enough(contact, uncertainty.samples, vary), most_samples(contact, vary))
    return assess(
        contact, vary=vary, **force_load, samples=samples, seed=uncertainty.seed, progress=inner
    )


def _slopes(
    contact: Contact, force_load: ForceLoad[float], progress: Callable[[str], None]
) -> Sensitivity | None:
    """Elasticities of load share, area and separation to every input."""
    names = ["A_t", "h"]
    if not contact.two_body:
        names.insert(0, "particle_load_share")
    within = progress.report_contacts if isinstance(progress, Stages) else None
    try:
        with count_contacts(4 * len(inputs(contact)), within):
            return sensitivity(contact, of=names, **force_load, quick=True)
    except ThirdBodyError:
        return None
