"""The table [body]: what a force in newtons presses together."""

from __future__ import annotations

import numpy as np

from ..contact.contact import Contact
from ..errors import InvalidValue
from ..quantities.value import quantity
from ..systems.bodies import BODIES, Body, Pressed, press
from .reader import Table, variants

__all__ = [
    "BODY",
    "FORCE",
    "force_sentences",
    "loads_of",
    "pressed",
    "told_forces",
]

FORCE = quantity(
    "F", "N", "force on the bodies of [body]", gt=0, hint="kN are 5e3 or '5 kN'"
).metadata["quantity"]
MOST_INTEGRATED = 3
"""Forces that are integrated over the contact, which takes seconds each; of more, the ends."""


def loads_of(bodies: Body | None, forces: np.ndarray, contact: Contact) -> np.ndarray:
    """The pressures at which the study is solved: mean and largest of every force [Pa]."""
    if bodies is None:
        raise InvalidValue(
            f"load.force = {forces[0]:g} N needs a table [body] that says on what it acts, e.g. "
            '[body] kind = "ball-on-flat", diameter = "6 mm" (kinds: '
            f"{', '.join(BODIES)}); or give load.pressure"
        )
    hertz = bodies.hertz(forces, contact.E_ss)
    if bodies.conjunction is None:
        return np.asarray(hertz.mean)
    return np.stack([hertz.mean, hertz.maximum], axis=-1).ravel()


def pressed(bodies: Body, forces: np.ndarray, contact: Contact) -> list[Pressed]:
    """Every force; integrated over the contact where they are few, else the ends."""
    some = range(len(forces)) if len(forces) <= MOST_INTEGRATED else (0, len(forces) - 1)
    return [
        press(contact, bodies, float(force), integrate=i in some) for i, force in enumerate(forces)
    ]


def told_forces(forces: np.ndarray) -> np.ndarray:
    """The forces that are told of, integrated over the contact: of many, the ends."""
    return forces if len(forces) <= MOST_INTEGRATED else forces[[0, -1]]


def force_sentences(found: list[Pressed]) -> list[str]:
    """Sentences of the forces; of many, those of the ends."""
    some = found if len(found) <= MOST_INTEGRATED else [found[0], found[-1]]
    return [each.sentence() for each in some]


BODY = Table(
    name="body",
    key=variants(
        "kind", BODIES, 'what the force presses, e.g. kind = "ball-on-flat", diameter = "6 mm"'
    ),
    role="study",
)
