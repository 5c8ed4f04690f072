"""The strength of particles: a table, or that of their material."""

from __future__ import annotations

from typing import Any

from pydantic import AfterValidator

from ..errors import InvalidValue
from ..populations.particles import Particles
from ..populations.strength import WeibullStrength
from .mistakes import clash
from .one_value import One, number, refused
from .reader import Key, Reader, plain, reads_also

__all__ = ["strength"]

NO_STRENGTH = (
    'must be "material", for the strength that the material has in the library, or a table: '
    '{ sigma_0 = "67 MPa", at = "1 mm", m = 3, size_exponent = 0.55 }'
)
OWN = ("sigma_0", "x_0", "at", "m")
"""Keys of a strength of one's own; a table without them changes that of the material."""


class _OfMaterial:
    """What a file says of a strength whose numbers are the material's."""

    def __init__(self) -> None:
        self.options: dict[str, Any] | None = None


def strength(reader: Reader, path: str, data: Any, own: dict[str, Key]) -> Any:
    """Adds the key ``strength`` of a population; what completes the particles."""
    asked = _OfMaterial()
    where = f"{path}.strength"
    own["strength"] = Key(_read(reader, where, data, asked), False, "how strong the particles are")

    def complete(particles: Particles) -> Particles:
        if asked.options is None:
            return particles
        try:
            found = WeibullStrength.of(particles.material, **asked.options)
        except InvalidValue as error:
            raise InvalidValue(*(f"{where}: {text}" for text in error.problems)) from None
        return particles.replace(strength=found)

    return AfterValidator(complete)


@reads_also("material", {}, {"m": 1})
def _read(reader: Reader, path: str, data: Any, asked: _OfMaterial) -> Any:
    if data == "material":
        asked.options = {}
        return plain(One(lambda _: None, {"const": "material"}))
    if data is None:
        return Any
    if not isinstance(data, dict):
        return plain(refused(path, NO_STRENGTH))
    keys = reader.keys_of(WeibullStrength, path, data)
    keys["at"] = keys["x_0"]._replace(type=_size_tested(reader, path), required=False)
    of_material = not any(key in data for key in OWN)
    if of_material:
        keys = {name: key._replace(required=False) for name, key in keys.items()}
    elif "at" in data:
        keys["x_0"] = keys["x_0"]._replace(required=False)
        if "x_0" in data:
            rule = "both are the size of the test; keep one of them"
            reader.problems.append(clash(path, data, ("at", "x_0"), rule))

    def build(values: dict[str, Any]) -> WeibullStrength | None:
        if "at" in values:
            values["x_0"] = values.pop("at")
        if of_material:
            asked.options = values
            return None
        return reader.make(WeibullStrength, path, values)

    return reader.table(path, keys, build)


def _size_tested(reader: Reader, path: str) -> Any:
    about = dict(WeibullStrength.__dataclass_fields__["x_0"].metadata["quantity"])
    return plain(number(reader, f"{path}.at", about))
