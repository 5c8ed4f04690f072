"""The table [connector]: contacts that close on dust, as in connectors, relays and switches."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InvalidValue, Mistake
from ..laws.particle.series import Series
from ..quantities.value import quantity
from ..systems.connector import Connector
from ..systems.film_formulas import Point
from .described import Described, describe
from .reader import NOTHING, Key, Reader, Table, amounts, keys_of, words

__all__ = ["CONNECTOR", "AskedConnector", "connector_of", "populations_of"]

FORCE = quantity(
    "W", "N", "contact force of each contact", gt=0, hint="gram-force are '30 gf', or 0.3 N"
).metadata["quantity"]


@dataclass(frozen=True, eq=False, kw_only=True)
class AskedConnector:
    """What a study says of a connector.

    Parameters
    ----------
    title : str
        As in the file.
    connector : Connector
        Contacts, dust, wipe.
    forces : array (M,)
        Contact forces W [N].
    notes : tuple of str
        What is allowed but looks like a slip.
    assumed : tuple of str
        What was taken for what the file does not say.
    stated : frozenset of str
        Dotted names of all keys that the file states.
    """

    title: str
    connector: Connector
    forces: np.ndarray
    notes: tuple[str, ...] = ()
    assumed: tuple[str, ...] = ()
    stated: frozenset[str] = frozenset()

    @property
    def described_inputs(self) -> Described:
        """Inputs with symbols and units."""
        return describe("connector.", self.connector)

    def pressure(self, E: float) -> float:
        """Mean Hertz pressure of the smooth clean contacts under the first force [Pa].

        ``E`` is E_ss, half of which is Hertz's modulus.
        """
        bodies = Point(R=self.connector.radius)
        return float(bodies.hertz(float(self.forces[0]), E=2 * E).mean)


def _connector(reader: Reader, path: str, data: object) -> object:
    """The contacts of [connector], as a table of arguments."""
    keys = keys_of(Connector) | {
        "force": amounts("force", FORCE)._replace(required=True),
        "conducting": words(None, 'names of particles that conduct, or "by material"'),
    }
    return reader.table(path, data, keys)


def populations_of(values: Mapping[str, object]) -> tuple[object, ...]:
    """Every population of particles that the tables hold."""
    dust = values.get("particles", ())
    return dust if isinstance(dust, tuple) else (dust,)


def connector_of(reader: Reader, values: dict[str, Any]) -> AskedConnector:
    """The connector, from the objects that the tables of its study stand for."""
    keywords = dict(values["connector"])
    forces = np.sort(keywords.pop("force"))
    dust = populations_of(values)
    if not dust:
        raise InvalidValue(
            "a connector without dust always closes: add a table [particles], e.g. "
            'material = "quartz", distribution = "log-normal", median = "8 um", gsd = 1.6, '
            'areal_density = "1e6 / m^2"',
            code=Mistake.BEYOND,
        )
    law = values.get("particle_law", Series())
    whole = keywords | {"surfaces": values["surfaces"], "particles": dust, "law": law}
    made = reader.make(Connector, "connector", whole)
    notes = []
    if made.pushed_aside and not made.wipe:
        notes.append('connector.pushed_aside has no effect without a wipe, e.g. wipe = "0.2 mm"')
    notes += reader.notes
    return AskedConnector(
        title=values.get("title", ""),
        connector=made,
        forces=forces,
        notes=tuple(notes),
        assumed=tuple(reader.assumed),
        stated=reader.stated_keys,
    )


CONNECTOR = Table(
    name="connector",
    key=Key(
        about='contacts that close on dust, e.g. radius = "2 mm", force = "0.5 N"; '
        "thirdbody new connector writes a whole study",
        schema=NOTHING,
        table=_connector,
    ),
    role="study",
)
