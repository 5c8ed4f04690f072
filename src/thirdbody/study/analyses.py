"""What a study file asks beside its states: assessment and design."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..analysis.assess import PARTS, assess_each
from ..analysis.assessment import Assessment
from ..analysis.assessments import Assessments
from ..analysis.uncertainty.samples import costly
from ..equilibrium.modes import FAINT
from ..equilibrium.solve import solve
from ..errors import InvalidValue, Mistake, NoEquilibrium, Problem, RangeWarning
from ..numerics.sampling import Span
from ..quantities.progress import stages
from ..quantities.say import value_of
from ..systems.bodies import press
from .film import note_without_oil
from .reader import is_span
from .vocabulary import LOADS

if TYPE_CHECKING:
    from ..analysis.design.design import Best
    from .whole import Study

__all__ = ["assess_study", "design_study"]


MOST_ASSESSED = 7
"""Loads that are assessed; of more, some evenly spread: each takes a second or several."""


def assess_study(study: Study, *, progress: bool = False) -> Assessment | Assessments:
    """The page of a study file: its loads, and its table [uncertainty]; raises as `assess`.

    Of separations the loads are those that the study's own values carry there. With ``progress``
    a terminal shows how far it is, on standard error.
    """
    if study.body is not None:
        return _assess_body(study, progress)
    notes: tuple[str, ...] = ()
    apart, loads = np.empty(0), study.values[_some(len(study.values))]
    name = study.load
    if name == "separation":
        apart, name = loads, "F_star"
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RangeWarning)
            loads = np.asarray(solve(study.contact, d=apart).F_star, float)
        notes = (
            "The loads are those that the values of the study carry at its separations; what is "
            "uncertain or moved changes the separation, not the load.",
        )
    with stages("assess", len(PARTS), progress) as report:
        if len(study.values) == 1 and not len(apart):
            (page,) = _assess(study, name, loads.tolist(), report)
            if isinstance(page, NoEquilibrium):
                raise page
            return page
        return _assess_each(study, name, loads, apart, notes, report)


def _some(total: int) -> list[int]:
    """Places of the loads that are assessed: all, or some evenly spread."""
    count = min(total, MOST_ASSESSED)
    return [round(i * (total - 1) / max(count - 1, 1)) for i in range(count)]


def _assess_each(
    study: Study,
    name: str,
    loads: np.ndarray,
    apart: np.ndarray,
    notes: tuple[str, ...],
    report: Callable[[str], None],
) -> Assessments:
    """A page for every load."""
    if study.uncertainty is not None and name in study.uncertainty.inputs:
        notes += ("Each load is taken as exactly known: its own scatter is left out.",)
    touching = loads > FAINT
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)  # the pages tell of them
        solved_pages = iter(_assess(study, name, loads[touching].tolist(), report, alone=True))
    pages, unsolved, where = [], [], []
    for i, load in enumerate(loads.tolist()):
        load_text = value_of(apart[i], "m") if len(apart) else value_of(load, LOADS[name]["unit"])
        page = next(solved_pages) if touching[i] else None
        if page is None:
            unsolved.append(f"At {load_text} nothing is in contact.")
        elif isinstance(page, NoEquilibrium):
            unsolved.append(f"At {load_text} there is {page}.")
        else:
            pages.append(page)
            where += apart[i : i + 1].tolist()
    if not pages:
        raise NoEquilibrium(" ".join(unsolved))
    return Assessments(
        title=study.title,
        pages=tuple(pages),
        asked=len(study.values),
        separations=tuple(where),
        unsolved=tuple(unsolved),
        notes=notes,
    )


def _assess_body(study: Study, progress: bool) -> Assessment | Assessments:
    """At the mean pressure of every force, with what the largest and the integral are."""
    assert study.body is not None
    assert study.forces is not None
    some = study.forces[_some(len(study.forces))].tolist()
    pressed = [press(study.contact, study.body, force) for force in some]
    means = [pressing.mean for pressing in pressed]
    with stages("assess", len(PARTS), progress) as report:
        bare = _assess(study, study.load, means, report, alone=len(some) > 1)
    pages = []
    for pressing, page in zip(pressed, bare, strict=True):
        if isinstance(page, NoEquilibrium):
            raise page
        notes = [pressing.sentence(), *(f"Warning: {text}." for text in pressing.warnings)]
        if pressing.kind != "flat":
            largest = value_of(pressing.maximum, "Pa")
            way = f"; for the largest: --set load.pressure={largest!r}"
            if study.film is not None:  # whose load is that of the body
                way = f"; the largest is {largest}"
            notes.append(f"This page is for the mean pressure{way}.")
        pages.append(replace(page, notes=(*notes, *page.notes)))
    if len(pages) == 1:
        return pages[0]
    return Assessments(title=study.title, pages=tuple(pages), asked=len(study.forces))


def _assess(
    study: Study,
    name: str,
    loads: list[float],
    report: Callable[[str], None],
    *,
    alone: bool = False,
) -> list[Assessment | NoEquilibrium]:
    """At each load; ``alone`` without its own scatter."""
    uncertainty = study.uncertainty
    value: dict[str, Any] = {}
    taken: tuple[str, ...] = ()
    if uncertainty is not None:
        inputs = {
            label: uncertain
            for label, uncertain in uncertainty.inputs.items()
            if label not in OF_LOADS
        }
        value = {"vary": inputs if alone else uncertainty.inputs}
        value |= {"samples": uncertainty.samples, "seed": uncertainty.seed}
        if not value["vary"]:
            value = {}
        elif (uncertainty.samples or 0) > MOST_COSTLY and costly(study.contact, value["vary"]):
            value["samples"], taken = MOST_COSTLY, (TAKEN.format(asked=uncertainty.samples),)
    pages = assess_each(study.contact, name, loads, **value, title=study.title, progress=report)
    if study.film is not None:
        taken = (f"{note_without_oil('This page is')}.", *taken)
    return [
        replace(page, notes=(*taken, *page.notes)) if isinstance(page, Assessment) else page
        for page in pages
    ]


MOST_COSTLY = 256
"""Samples of a study where each takes tables of its own, a second or so."""
TAKEN = (
    f"{MOST_COSTLY} samples of the {{asked:,}} that the study asks for, as each takes tables of "
    "its own; in Python, `thirdbody.propagate` takes all."
)


OF_LOADS = ("pressure", "F_star", "d")
"""Names of loads among what is uncertain."""


# -------------------------------------------------------------------------- the answer
def design_study(study: Study, *, progress: bool = False) -> Best:
    """The best inputs that a study file asks for.

    Parameters
    ----------
    study : Study
        With a table [design].
    progress : bool, optional
        Shows a bar on standard error.

    Raises
    ------
    InvalidValue
        There is no table [design], or what it asks does not fit the contact.
    """
    from ..analysis.design.design import design as search

    return search(study.contact, **arguments(study), progress=progress)


def arguments(study: Study) -> dict[str, Any]:
    """The arguments of `thirdbody.design` beside the contact."""
    if study.design is None:
        raise InvalidValue(
            Problem(
                "design",
                "is missing: a table [design] says what may be chosen and what is good, e.g. "
                'objective = { of = "A_t", aim = "smallest" }, [design.vary] "roughness.sigma" = '
                '{ low = "50 nm", high = "200 nm" }; or [life.design], of an oil',
                code=Mistake.MISSING,
            )
        )
    keywords = dict(study.design)
    if keywords.pop("scatter", False) and study.uncertainty is not None:
        keywords["scatter"] = study.uncertainty.inputs
    names = [name for name in ("F_star", "pressure") if name in keywords]
    if not names:
        if study.load == "separation":
            raise InvalidValue(
                "design needs a load: [load] gives a separation", code=Mistake.BEYOND
            )
        keywords[study.load] = study.values
    for name in names:
        if is_span(keywords[name]):
            keywords[name] = Span(
                keywords[name]["low"], keywords[name]["high"], keywords[name]["scale"]
            )
    return keywords
