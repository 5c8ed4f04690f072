"""What the tables of a study describe, for the sheet of inputs of a workbook."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from ..populations.materials import Material
    from ..quantities.units import Quantity
    from ..quantities.value import Value
    from ..systems.chuck import Chuck
    from ..systems.connector import Connector

__all__ = ["BareNumber", "Described", "describe"]


class BareNumber(NamedTuple):
    """A number of a study that is no field of a value."""

    name: str
    """As the file calls it."""
    about: Quantity
    """Symbol, unit and meaning."""
    value: float
    """In SI."""


class Described(NamedTuple):
    """Inputs of a study that are values, materials, and bare numbers."""

    values: Mapping[str, Value]
    """By what their names begin with, "plate."."""
    bodies: Mapping[str, Material]
    """Materials by their role."""
    numbers: tuple[BareNumber, ...] = ()


def describe(prefix: str, system: Connector | Chuck) -> Described:
    """Inputs of a part that has surfaces and particles.

    Parameters
    ----------
    prefix : str
        What the names of its fields begin with.
    system : Value
        With ``surfaces`` and ``particles``.
    """
    from ..systems.connector import name_of

    bodies = {"surface 1": system.surfaces.first, "surface 2": system.surfaces.second}
    bodies |= {name_of(dust, i): dust.material for i, dust in enumerate(system.particles)}
    return Described({prefix: system}, bodies)
