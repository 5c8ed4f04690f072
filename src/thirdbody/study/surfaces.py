"""The tables [surfaces], [asperity_law] and [particle_law]: materials and laws, wherever one is."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress

from ..errors import InvalidValue, Mistake
from ..laws import asperity, particle
from ..populations.materials import Material, MaterialPair, materials
from ..quantities.nearest import guess
from ..quantities.units import say
from .reader import (
    FIELDS,
    Key,
    Reader,
    Table,
    get,
    read_text,
    read_word,
    table_of,
    text,
    variants,
    wrong,
)

__all__ = [
    "ASPERITY_LAW",
    "MATERIAL",
    "OWN_MATERIALS",
    "PARTICLE_LAW",
    "SURFACES",
    "class_of",
    "law_key",
]

OTHER = 'another material is written { E = "205 GPa", nu = 0.29, H = "5 GPa" }'
ONE = 'a material, e.g. "S45C" or { E = "205 GPa", nu = 0.29, H = "5 GPa" }'
BOTH = 'a table [surfaces] with the two materials, e.g. first = "S45C", second = "S45C"'


# -------------------------------------------------------------------------- materials
def _from_library(reader: Reader, path: str, value: object) -> Material:
    """The material of a name."""
    library = reader.library
    if library is None:
        return materials["S45C"]  # no name can be judged, and the study is refused anyway
    if isinstance(value, str):
        with suppress(KeyError):
            return library[value]
    near = library.nearest_name(str(value))
    some = ", ".join(list(library)[:3])
    rule = (
        f"is not a material of the library ({some} and {len(library) - 3} more: thirdbody "
        "materials)"
    )
    hint = guess("", (), meant=near, show=say) + f"; {OTHER}" if near else OTHER
    raise wrong(path, rule, value, hint=hint, code=Mistake.UNKNOWN)


NAMES = {"anyOf": [{"enum": list(materials)}, {"type": "string"}]}  # and those of a file
FIELDS["Material"] = MATERIAL = table_of(Material, ONE)._replace(read=_from_library, schema=NAMES)


def _own_materials(reader: Reader, path: str, value: object) -> object:
    """Name of a file of materials; tables read after this one may use its names."""
    name = read_text(reader, path, value)
    try:
        reader.library = materials.load(reader.folder / name)
    except InvalidValue as error:
        reader.library = None
        raise InvalidValue(
            *(problem.put_at(path, say(value), sign=":") for problem in error.problems)
        ) from None
    return name


# -------------------------------------------------------------------------- laws
def law_key(registry: Mapping[str, type], about: str = "") -> Key:
    """The key of a law: its name, or a table with its name and options."""

    def read(reader: Reader, path: str, data: object) -> object:
        if not isinstance(data, str):
            return reader.variant(path, data, "name", registry)
        return reader.make(registry[read_word(registry, reader, path, data)], path, {})

    return variants("name", registry, about)._replace(read=read, schema={"enum": registry})


def class_of(data: object, registry: Mapping[str, type]) -> type | None:
    """The class of the law that a file names, by a word or in a table."""
    return registry.get(str(get(data, "name") if isinstance(data, dict) else data))


FIELDS["AbstractAsperityLaw"] = ASPERITY_LAW = law_key(asperity.REGISTRY)
PARTICLE_LAW = law_key(particle.REGISTRY)

OWN = 'a file of your own materials, "mine.toml"'
OWN_MATERIALS = Table(
    name="materials", key=text._replace(read=_own_materials, about=OWN), role="study"
)
SURFACES = Table(name="surfaces", key=table_of(MaterialPair, BOTH, required=True))
