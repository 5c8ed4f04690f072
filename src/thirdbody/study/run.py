"""Running a study: everything it asks for, as plain data."""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np

from ..citations import cite
from ..contact import Contact
from ..equilibrium import Equilibrium
from ..errors import RangeWarning, ThirdBodyError
from ..transitions import Critical, Transitions, TurningPoint, transitions
from .whole import Study

__all__ = ["run_study"]


def run_study(study: Study) -> dict[str, Any]:
    """Everything a study file asks for, as plain data ready for JSON.

    Parameters
    ----------
    study : Study

    Returns
    -------
    dict
        Title, version, inputs (SI), scales, states (a list each), what each of several populations
        carries in them, transitions, warnings, citations. A state that cannot be solved keeps its
        place with None and a status that says why.
    """
    from .. import __version__

    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always", RangeWarning)
        state = study.solve()
        critical = _transitions(study.contact)
    sentences = [*study.notes, *state.warnings, *(str(item.message) for item in heard)]
    states = {name: _listed(column) for name, column in state.columns().items()}
    states["mode"] = [mode or None for mode in states["mode"]]
    return {
        "title": study.title,
        "version": __version__,
        "inputs": study.contact.to_dict() | {"load": {study.load: study.values.tolist()}},
        "scales": state.scales,
        "states": {"status": states.pop("status"), **states},
        "populations": _populations(state),
        "transitions": critical.to_dict(),
        "warnings": list(dict.fromkeys(sentences)),
        "citations": cite(study.contact).splitlines(),
    }


def _populations(state: Equilibrium) -> list[dict[str, Any]]:
    """What each of several populations carries in every state; nothing for one."""
    numbers = ("F_sa_star", "A_sa", "load_share", "area_share")
    return [
        {"name": part.name} | {name: _listed(getattr(part, name)) for name in numbers}
        for part in state.populations
    ]


def _transitions(contact: Contact) -> Transitions:
    try:
        return transitions(contact)
    except ThirdBodyError as error:
        none = Critical(None, f"none: {str(error).splitlines()[0]}")
        return Transitions(none, none, TurningPoint(none, none, none))


def _listed(column: Any) -> list[Any]:
    """A column as plain numbers, None for those that are not finite."""
    items = (
        item.item() if isinstance(item, np.generic) else item for item in np.atleast_1d(column)
    )
    return [None if isinstance(x, float) and not math.isfinite(x) else x for x in items]
