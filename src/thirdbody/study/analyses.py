"""What a study file asks beside its states: assessment and design."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ..analysis.assess import PARTS, assess
from ..analysis.assessment import Assessment
from ..errors import InvalidValue
from ..numerics.sampling import Span
from ..quantities.progress import stages
from ..quantities.say import value_of
from ..systems.bodies import press
from .amounts import is_span

if TYPE_CHECKING:
    from ..analysis.design.design import Best
    from .whole import Study

__all__ = ["assess_study", "design_study"]


def assess_study(study: Study, *, progress: bool = False) -> Assessment:
    """The page of a study file: its load, and its table [uncertainty]; raises as `assess`.

    With ``progress`` a terminal shows how far it is, on standard error.
    """
    if study.load == "separation":
        raise InvalidValue(
            "load.separation: an assessment needs the operating load; give load.pressure or "
            "load.F_star instead"
        )
    if study.body is not None:
        return _assess_body(study, progress)
    if len(study.values) != 1:
        raise InvalidValue(
            f"load.{study.load} has {len(study.values)} values, and an assessment is of one "
            'operating load; choose it, e.g. --set load.pressure="5 MPa"'
        )
    return _assess(study, float(study.values[0]), progress)


def _assess_body(study: Study, progress: bool) -> Assessment:
    """At the mean pressure of the one force, with what the largest and the integral are."""
    assert study.body is not None
    assert study.forces is not None
    if len(study.forces) != 1:
        raise InvalidValue(
            f"load.force has {len(study.forces)} values, and an assessment is of one operating "
            'load; choose it, e.g. --set load.force="50 N"'
        )
    found = press(study.contact, study.body, float(study.forces[0]))
    page = _assess(study, found.mean, progress)
    notes = [found.sentence(), *(f"Warning: {text}." for text in found.warnings)]
    if found.kind != "flat":
        largest = value_of(found.maximum, "Pa")
        notes.append(
            f"This page is for the mean pressure; for the largest: --set load.pressure={largest!r}."
        )
    return replace(page, notes=(*notes, *page.notes))


def _assess(study: Study, load: float, progress: bool) -> Assessment:
    asked = study.uncertainty
    value: dict[str, Any] = {study.load: load}
    if asked is not None:
        value |= {"vary": asked.inputs, "samples": asked.samples, "seed": asked.seed}
    with stages("assess", len(PARTS), progress) as report:
        return assess(study.contact, **value, title=study.title, progress=report)


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
            "the study has no table [design]: it says what may be chosen and what is good, e.g. "
            '[design] objective = { of = "A_t" }, [design.vary] "roughness.sigma" = '
            '{ low = "50 nm", high = "200 nm" }'
        )
    given = dict(study.design)
    if given.pop("scatter", False) and study.uncertainty is not None:
        given["scatter"] = study.uncertainty.inputs
    names = [name for name in ("F_star", "pressure") if name in given]
    if not names:
        if study.load == "separation":
            raise InvalidValue("design needs a load: [load] gives a separation")
        given[study.load] = study.values
    for name in names:
        if is_span(given[name]):
            given[name] = Span(given[name]["low"], given[name]["high"], given[name]["scale"])
    return given
