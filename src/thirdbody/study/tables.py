"""Every table that a study file may hold, in the order in which they are read.

A new one is a file with a `Table` in it and one line here.
"""

from __future__ import annotations

from typing import Any

from .body import TABLE as BODY
from .connector import TABLE as CONNECTOR
from .design import TABLE as DESIGN
from .ellipticity import ellipticity
from .explicit import TABLE as EXPLICIT
from .film import TABLE as FILM
from .heights import heights
from .laws import ASPERITY_LAW, PARTICLE_LAW, asperity_law
from .load import TABLE as LOAD
from .one_value import text
from .outputs import TABLE as OUTPUTS
from .particles import TABLE as PARTICLES
from .plate import TABLE as PLATE
from .reader import FieldReader, Reader, Table, plain
from .roughness import TABLE as ROUGHNESS
from .sizes import parts
from .spectrum import spectrum
from .surfaces import OWN_MATERIALS, material
from .surfaces import TABLE as SURFACES
from .sweep import TABLE as SWEEP
from .uncertainty import TABLE as UNCERTAINTY

__all__ = ["FIELDS", "TABLES"]


def _title(reader: Reader, path: str, data: Any) -> Any:
    return plain(text(path))


TABLES: tuple[Table, ...] = (
    Table(name="title", read=_title, about="a line of text", role="study"),
    OWN_MATERIALS,
    SURFACES,
    ROUGHNESS,
    ASPERITY_LAW,
    PARTICLES,
    PARTICLE_LAW,
    OUTPUTS,
    BODY,
    LOAD,
    FILM,
    CONNECTOR,
    PLATE,
    SWEEP,
    UNCERTAINTY,
    DESIGN,
    EXPLICIT,
)

FIELDS: dict[str, tuple[FieldReader, str]] = {
    "Material": (material, ""),
    "Heights": (heights, "distribution of asperity heights"),
    "Ellipticity | None": (ellipticity, "shapes of elliptic asperities"),
    "AbstractAsperityLaw": (asperity_law, ""),
    "OwnSpectrum | RollOff | None": (spectrum, "waves of the roughness"),
    "tuple[Distribution, ...]": (parts, "a list of size distributions"),
}
"""Fields of value classes that are tables themselves, by their declared type."""
