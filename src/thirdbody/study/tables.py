"""Every table that a study file may hold, in the order in which they are read.

A new one is a file with a `Table` in it and one line here.
"""

from __future__ import annotations

from typing import Any

from . import (
    design,
    ellipticity,
    film,
    heights,
    laws,
    load,
    outputs,
    particles,
    roughness,
    sizes,
    surfaces,
    sweep,
    uncertainty,
)
from .one_value import text
from .reader import FieldReader, Reader, Table, plain

__all__ = ["FIELDS", "TABLES"]


def _title(reader: Reader, path: str, data: Any) -> Any:
    return plain(text(path))


TABLES: tuple[Table, ...] = (
    Table(name="title", read=_title, about="a line of text", role="study"),
    surfaces.OWN_MATERIALS,
    surfaces.TABLE,
    roughness.TABLE,
    laws.ASPERITY_LAW,
    particles.TABLE,
    laws.PARTICLE_LAW,
    outputs.TABLE,
    load.TABLE,
    film.TABLE,
    sweep.TABLE,
    uncertainty.TABLE,
    design.TABLE,
)

FIELDS: dict[str, tuple[FieldReader, str]] = {
    "Material": (surfaces.material, ""),
    "Heights": (heights.heights, "distribution of asperity heights"),
    "Ellipticity | None": (ellipticity.ellipticity, "shapes of elliptic asperities"),
    "AbstractAsperityLaw": (laws.asperity_law, ""),
    "tuple[Distribution, ...]": (sizes.parts, "a list of size distributions"),
}
"""Fields of value classes that are tables themselves, by their declared type."""
