"""The table [surfaces], and materials wherever a file names one."""

from __future__ import annotations

from typing import Any

from ..errors import InvalidValue
from ..populations.materials import Material, MaterialLibrary, MaterialPair, materials
from ..quantities.units import say
from .mistakes import wrong
from .one_value import One, text
from .reader import Key, Reader, Table, get, plain, reads_also

__all__ = ["OWN_MATERIALS", "TABLE", "material"]

OTHER = 'another material is written { E = "205 GPa", nu = 0.29, H = "5 GPa" }'


def surfaces(reader: Reader, path: str, data: Any) -> Any:
    """The two bodies."""
    keys = {}
    for side in ("first", "second"):
        read = material(reader, f"{path}.{side}", get(data, side))
        keys[side] = Key(
            read, True, 'a material, e.g. "S45C" or { E = "205 GPa", nu = 0.29, H = "5 GPa" }'
        )
    return reader.table(path, keys, lambda values: reader.make(MaterialPair, path, values))


@reads_also({})
def material(reader: Reader, path: str, data: Any) -> Any:
    """A name of the library, or a table with the numbers."""
    if isinstance(data, dict):
        return reader.value(path, data, Material)

    def from_library(value: Any) -> Material:
        known = reader.library
        if known is None:
            return materials["S45C"]  # no name can be judged, and the study is refused anyway
        if isinstance(value, str) and value in known:
            return known[value]
        near = known.near(str(value))
        some = ", ".join(list(known)[:3])
        rule = (
            f"is not a material of the library ({some} and {len(known) - 3} more: thirdbody "
            "materials)" + (f"; did you mean {say(near)}?" if near else "")
        )
        raise wrong(path, rule, value, hint=OTHER)

    names = {"anyOf": [{"enum": list(materials)}, {"type": "string"}]}  # and those of a file
    return plain(One(from_library, names))


def own_materials(reader: Reader, path: str, given: Any) -> Any:
    """The name of a file, whose materials the tables read after this one can name."""
    reader.library = _library(reader, given)
    return plain(text(path))


def _library(reader: Reader, given: Any) -> MaterialLibrary | None:
    if not isinstance(given, str):
        return materials
    try:
        return materials.load(reader.folder / given)
    except InvalidValue as error:
        reader.problems += [f"materials = {say(given)}: {problem}" for problem in error.problems]
        return None


TABLE = Table(
    name="surfaces",
    read=surfaces,
    about='a table [surfaces] with the two materials, e.g. first = "S45C", second = "S45C"',
    required=lambda whole: True,
)
OWN_MATERIALS = Table(
    name="materials",
    read=own_materials,
    about='a file of your own materials, "mine.toml"',
    role="study",
)
