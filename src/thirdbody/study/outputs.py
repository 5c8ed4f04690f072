"""The table [outputs]: what else the states of the contact tell, a table for each output."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..contact.contact import Contact
from ..effects import REGISTRY
from ..systems.bodies import Body, Flat
from .reader import Key, Reader, Table, get

__all__ = ["TABLE", "on_area"]


def outputs(reader: Reader, path: str, data: Any) -> Any:
    """Every output that the file names, in the order of the library."""
    keys = {
        name: Key(reader.value(f"{path}.{name}", get(data, name), kind), False, kind.title)
        for name, kind in REGISTRY.items()
    }
    return reader.table(path, keys, lambda values: tuple(values.values()))


def on_area(contact: Contact, body: Body | None, forces: Any) -> Contact:
    """The contact whose outputs that ask for a nominal area and have none get that of the body.

    It is one of a flat body, and of others under a single force: the Hertz contact. Under several
    forces there are several, and none is taken.
    """
    if isinstance(body, Flat):
        area = body.area
    elif body is not None and forces is not None and np.size(forces) == 1:
        area = float(body.hertz(np.ravel(forces)[0], contact.E_ss).area)
    else:
        return contact
    filled = tuple(
        each.replace(A_n=area) if getattr(each, "A_n", 0.0) is None else each
        for each in contact.outputs
    )
    return contact if filled == contact.outputs else contact.replace(outputs=filled)


TABLE = Table(name="outputs", read=outputs)
