"""The table [plate]: a wafer, film or plate held on a chuck or a flat, with dust under it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InvalidValue, Mistake
from ..laws.particle.series import Series
from ..quantities.value import quantity
from ..systems.chuck import Chuck
from .connector import populations_of
from .described import Described, describe
from .reader import NOTHING, Key, Reader, Table, amounts, keys_of

__all__ = ["PLATE", "AskedPlate", "plate_of"]

GRAIN = quantity(
    "x", "m", "diameters of particles of which the height is told", gt=0, usual=0.1
).metadata["quantity"]


@dataclass(frozen=True, eq=False, kw_only=True)
class AskedPlate:
    """What a study says of a plate on a chuck.

    Parameters
    ----------
    title : str
        As in the file.
    chuck : Chuck
        Plate, chuck and dust.
    grains : array (M,)
        Diameters x of particles of which the height is asked [m]; empty where none is named.
    notes : tuple of str
        What is allowed but looks like a slip.
    assumed : tuple of str
        What was taken for what the file does not say.
    stated : frozenset of str
        Dotted names of all keys that the file states.
    """

    title: str
    chuck: Chuck
    grains: np.ndarray
    notes: tuple[str, ...] = ()
    assumed: tuple[str, ...] = ()
    stated: frozenset[str] = frozenset()

    @property
    def described_inputs(self) -> Described:
        """Inputs with symbols and units."""
        return describe("plate.", self.chuck)


def _plate(reader: Reader, path: str, data: object) -> dict[str, object]:
    """The plate of [plate], as a table of arguments."""
    return reader.table(path, data, keys_of(Chuck) | {"grain": amounts("grain", GRAIN)})


def plate_of(reader: Reader, values: dict[str, Any]) -> AskedPlate:
    """The plate, from the objects that the tables of its study stand for."""
    keywords = dict(values["plate"])
    grains = np.sort(keywords.pop("grain", np.empty(0)))
    dust = populations_of(values)
    if not dust:
        raise InvalidValue(
            "a plate without particles lies flat: add a table [particles] that says what they "
            'are, e.g. material = "quartz", distribution = "monodisperse", mean = "5 um", '
            'areal_density = "1e4 / m^2"',
            code=Mistake.BEYOND,
        )
    law = values.get("particle_law", Series())
    whole = keywords | {"surfaces": values["surfaces"], "particles": dust, "law": law}
    made = reader.make(Chuck, "plate", whole)
    return AskedPlate(
        title=values.get("title", ""),
        chuck=made,
        grains=grains,
        notes=tuple(reader.notes),
        assumed=tuple(reader.assumed),
        stated=reader.stated_keys,
    )


PLATE = Table(
    name="plate",
    key=Key(
        about='a wafer, film or plate on a flat, e.g. thickness = "775 um", pressure = "80 kPa"; '
        "thirdbody new wafer-chuck writes a whole study",
        schema=NOTHING,
        table=_plate,
    ),
    role="study",
)
