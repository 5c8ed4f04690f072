"""The inputs of a study by their names in the file: what may be varied or uncertain."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from ..effects import REGISTRY as OUTPUTS
from ..laws import asperity, particle
from ..populations.materials import BULK, Material
from ..populations.particles import Particles
from ..populations.roughness import Roughness
from ..populations.strength import WeibullStrength
from ..quantities.units import Quantity
from ..quantities.value import Choice
from .fields import filled_in, idle
from .particles import SHAPES, populations
from .reader import get
from .surfaces import class_of
from .vocabulary import DISTRIBUTIONS

__all__ = ["Input", "field_of", "inputs_of"]


@dataclass(frozen=True, kw_only=True)
class Input:
    """One field of the contact that the file can name."""

    table: str
    key: str
    quantity: Quantity | None
    choice: Choice | None
    idle: str
    """Why varying it changes nothing; empty where it does."""

    @property
    def name(self) -> str:
        """Dotted name in the study file."""
        return f"{self.table}.{self.key}"

    @property
    def field(self) -> str:
        """Dotted name in Python, for `Contact.replace`."""
        return field_of(self.table, self.key)


def field_of(table: str, key: str) -> str:
    """The dotted name of a field: sizes stand beside the other keys of [particles] in a file."""
    fields = {item.name for item in dataclasses.fields(Particles)} - {"shape"}  # a number of sizes
    if re.fullmatch(r"particles(\.\d+)?", table) and key not in fields:
        return f"{table}.diameter.{key}"
    return f"{table}.{key}"


def inputs_of(whole: Mapping[str, object]) -> list[Input]:
    """Every field of the tables of a file that holds a number, a word or a label."""
    inputs: dict[tuple[str, str], Input] = {}
    for table, kind in _kinds(whole):
        without_effect = {
            name: f"has no part in the contact ({what}), so nothing would change with it"
            for name, what in idle(kind).items()
            if not (kind is Material and get(whole, "outputs") and name in BULK)
        }
        without_effect |= dict.fromkeys(
            filled_in(kind), "follows from the contact, whatever is given for it"
        )
        for item in dataclasses.fields(kind):
            about = {name: item.metadata.get(name) for name in ("quantity", "choice")}
            why = without_effect.get(item.name, "")
            if why or any(about.values()):
                one = Input(table=table, key=item.name, idle=why, **about)
                inputs.setdefault((table, item.name), one)
    return list(inputs.values())


def _sizes(table: object) -> Iterable[type]:
    """The distribution of a table; all of them where its word is none, which is told there."""
    name = get(table, "distribution")
    if name is None or (isinstance(name, str) and name in DISTRIBUTIONS):
        return [DISTRIBUTIONS[name]] if name else []
    return DISTRIBUTIONS.values()


def _kinds(whole: Mapping[str, object]) -> list[tuple[str, type]]:
    """The classes whose fields each table of the file holds."""
    kinds: list[tuple[str, type | None]] = [
        ("surfaces.first", Material),
        ("surfaces.second", Material),
        ("roughness", Roughness),
        ("asperity_law", class_of(whole.get("asperity_law", "zmc"), asperity.REGISTRY)),
    ]
    tables = populations(whole)
    for path, table in tables.items():
        kinds += [(path, Particles), *((path, sizes) for sizes in _sizes(table))]
        kinds.append((f"{path}.material", Material))
        if get(table, "strength") is not None:
            kinds.append((f"{path}.strength", WeibullStrength))
        if isinstance(word := get(get(table, "shape"), "kind"), str):
            kinds.append((f"{path}.shape", SHAPES.get(word)))
        if get(table, "law") is not None:
            kinds.append((f"{path}.law", class_of(get(table, "law"), particle.REGISTRY)))
    if any(get(table, "law") is None for table in tables.values()):
        common = class_of(whole.get("particle_law", "series"), particle.REGISTRY)
        kinds.append(("particle_law", common))
    outputs = whole.get("outputs")
    if isinstance(outputs, dict):
        kinds += [(f"outputs.{name}", OUTPUTS.get(name)) for name in outputs]
    return [(path, kind) for path, kind in kinds if kind is not None]
