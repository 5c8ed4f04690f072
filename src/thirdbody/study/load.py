"""The tables [load] and [body]: F*, pressure, separation, or a force and what it presses."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..contact.contact import Contact
from ..errors import InvalidValue, Mistake, Problem
from ..quantities.value import quantity
from ..systems.bodies import BODIES, Body, Pressed, press
from .reader import NOTHING, Key, Reader, Table, amounts, variants
from .vocabulary import LOADS

__all__ = [
    "BODY",
    "FORCE",
    "LOAD",
    "PRESSES",
    "force_sentences",
    "loads_of",
    "press_forces",
    "told_forces",
]

FORCE = quantity(
    "F", "N", "force on the bodies of [body]", gt=0, hint="kN are 5e3 or '5 kN'"
).metadata["quantity"]
MOST_INTEGRATED = 3
"""Forces that are integrated over the contact, which takes seconds each; of more, the ends."""

PRESSES = ("film", "connector", "plate")
"""Tables that say themselves what presses the surfaces together."""
KEYS = {name: amounts(name, about) for name, about in (LOADS | {"force": FORCE}).items()}


def _load(reader: Reader, path: str, data: object) -> object:
    """Name and values of the load."""
    reader.only_one(path, data)

    def build(values: dict[str, Any]) -> tuple[str, np.ndarray]:
        for name in KEYS:
            if name in values:
                return name, values[name]
        ways = f'one of {", ".join(LOADS)}, e.g. pressure = "5 MPa", or force on a [body]'
        raise InvalidValue(
            Problem(f"[{path}]", "is empty", hint=f"give exactly {ways}", code=Mistake.EMPTY)
        )

    return reader.table(path, data, KEYS, build)


def _is_needed(whole: Mapping[str, object]) -> bool:
    """Whether no other table of a file says what presses the surfaces together."""
    sweep = whole.get("sweep")
    is_swept = isinstance(sweep, dict) and any(sweep.get(name) is not None for name in LOADS)
    return not is_swept and whole.keys().isdisjoint(PRESSES)


LOAD = Table(
    name="load",
    key=Key(
        about='a table [load] with one of F_star, pressure, separation, e.g. pressure = "5 MPa"',
        schema=NOTHING,
        table=_load,
    ),
    required=_is_needed,
    role="study",
)
BODY = Table(
    name="body",
    key=variants(
        "kind", BODIES, 'what the force presses, e.g. kind = "ball-on-flat", diameter = "6 mm"'
    ),
    role="study",
)


# -------------------------------------------------------------------------- forces
def loads_of(bodies: Body | None, forces: np.ndarray, contact: Contact) -> np.ndarray:
    """The pressures at which the study is solved: mean and largest of every force [Pa]."""
    if bodies is None:
        raise InvalidValue(
            Problem(
                "load.force",
                "needs a table [body] that says on what it acts, e.g. "
                f'[body] kind = "ball-on-flat", diameter = "6 mm" (kinds: {", ".join(BODIES)})',
                f"{forces[0]:g} N",
                hint="or give load.pressure",
                code=Mistake.MISSING,
            )
        )
    hertz = bodies.hertz(forces, contact.E_ss)
    if bodies.conjunction is None:
        return np.asarray(hertz.mean)
    return np.stack([hertz.mean, hertz.maximum], axis=-1).ravel()


def press_forces(bodies: Body, forces: np.ndarray, contact: Contact) -> list[Pressed]:
    """Every force; integrated over the contact where they are few, else the ends."""
    some = range(len(forces)) if len(forces) <= MOST_INTEGRATED else (0, len(forces) - 1)
    return [
        press(contact, bodies, float(force), integrate=i in some) for i, force in enumerate(forces)
    ]


def told_forces(forces: np.ndarray) -> np.ndarray:
    """The forces that are told of, integrated over the contact: of many, the ends."""
    return forces if len(forces) <= MOST_INTEGRATED else forces[[0, -1]]


def force_sentences(forces: list[Pressed]) -> list[str]:
    """Sentences of the forces; of many, those of the ends."""
    some = forces if len(forces) <= MOST_INTEGRATED else [forces[0], forces[-1]]
    return [force.sentence() for force in some]
