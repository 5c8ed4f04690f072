"""The table [body]: what a force in newtons presses together."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..contact.contact import Contact
from ..errors import InvalidValue
from ..quantities.say import percent, value_of
from ..quantities.value import quantity
from ..systems.bodies import BODIES, Body, Pressed, press
from .reader import Reader, Table

__all__ = [
    "FORCE",
    "TABLE",
    "force_sentences",
    "held_in",
    "loads_of",
    "of_bodies",
    "pressed",
    "told_forces",
]

FORCE = quantity(
    "F", "N", "force on the bodies of [body]", gt=0, hint="kN are 5e3 or '5 kN'"
).metadata["quantity"]
MOST_INTEGRATED = 3
"""Forces that are integrated over the contact, which takes seconds each; of more, the ends."""


def body(reader: Reader, path: str, data: Any) -> Any:
    """The bodies, by their kind."""

    def build(values: dict[str, Any]) -> Any:
        return reader.make(BODIES[values.pop("kind")], path, values)

    return reader.variant(path, data, "kind", BODIES, build, {})


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


def of_bodies(result: dict[str, Any]) -> str:
    """What holds of the bodies themselves, where it is not what the states say; else empty.

    States are of a surface under one pressure, which shares its load among all its particles.
    """
    forces = result.get("body", {}).get("forces", ())
    each = [force for force in forces if force["particle_load_share"] is not None]
    if not each:
        return ""
    rare = any(0 < force["particles_held"] < 1 for force in each)
    if not (rare or any(force["method"] == "rough body" for force in each)):
        return ""
    loads = ", ".join(
        f"{percent(force['particle_load_share'])} under {value_of(force['force'], 'N')}"
        for force in each
    )
    pressures = "" if each[0]["kind"] == "flat" else "under the pressures of smooth bodies, "
    means = ", on average over contacts with and without one," if rare else ""
    return (
        f"That is of a wide surface {pressures}whose particles all share the load; of the load "
        f"of the bodies themselves particles carry{means} {loads}."
    )


def held_in(result: dict[str, Any], state: int) -> float:
    """Particles that the contact of a state holds on average; infinite where nobody knows."""
    forces = result.get("body", {}).get("forces", ())
    if not forces:  # of a film that has bodies of its own
        held = result.get("particles_held")
        return math.inf if held is None else float(held)
    each = len(result["states"]["status"]) // len(forces)
    held = forces[state // each]["particles_held"]
    return math.inf if held is None else float(held)


TABLE = Table(
    name="body",
    read=body,
    about='what the force presses, e.g. kind = "ball-on-flat", diameter = "6 mm"',
    role="study",
)
