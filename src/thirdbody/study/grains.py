"""What one particle is, in [particles]: its size, its shape, its strength."""

from __future__ import annotations

from typing import Any

from ..errors import InvalidValue
from ..populations.particles import Particles
from ..populations.shape import SPHERE, Angular, Sphere
from ..populations.strength import WeibullStrength
from .mistakes import clash
from .reader import FIELDS, NOTHING, Key, Reader, keys_of, variants, wrong
from .vocabulary import DISTRIBUTIONS

__all__ = ["SHAPE", "SHAPES", "STRENGTH", "with_strength"]


# -------------------------------------------------------------------------- sizes
def _parts(reader: Reader, path: str, value: Any) -> Any:
    """The components of a mixture, a list of tables."""
    if not (isinstance(value, list) and value):
        rule = 'must be a list of size distributions, e.g. [{ distribution = "monodisperse", '
        raise wrong(path, f'{rule}mean = "100 nm" }}, ...]', value)
    return reader.read_each({f"{path}.{i}": item for i, item in enumerate(value)}, _component)


def _component(reader: Reader, path: str, data: Any) -> Any:
    return reader.variant(path, data, "distribution", DISTRIBUTIONS)


FIELDS["tuple[Distribution, ...]"] = Key(
    _parts, about="a list of size distributions", schema=NOTHING, items=_component
)


# -------------------------------------------------------------------------- shape
SHAPES = {"sphere": Sphere, "angular": Angular}
ABOUT_SHAPE = 'sphere, or the table { kind = "angular", roundness = 0.25, angle = "25 deg" }'


def _sphere(reader: Reader, path: str, value: Any) -> Sphere:
    if value == "sphere":
        return SPHERE
    raise wrong(path, f"must be {ABOUT_SHAPE}", value)


SHAPE = variants("kind", SHAPES, ABOUT_SHAPE)._replace(read=_sphere, schema={"const": "sphere"})


# -------------------------------------------------------------------------- strength
NO_STRENGTH = (
    'must be "material", for the strength that the material has in the library, or a table: '
    '{ sigma_0 = "67 MPa", at = "1 mm", m = 3, size_exponent = 0.55 }'
)
OWN = ("sigma_0", "x_0", "at", "m")
"""Keys of a strength of one's own; a table without them changes that of the material."""


def _of_material(reader: Reader, path: str, value: Any) -> dict[str, Any]:
    """The strength that the material has, and nothing of one's own."""
    if value != "material":
        raise wrong(path, NO_STRENGTH, value)
    return {}


def _strength(reader: Reader, path: str, data: Any) -> WeibullStrength | dict[str, Any]:
    """A strength with its numbers, or changes to that of the material."""
    given = data if isinstance(data, dict) else {}
    keys = dict(keys_of(WeibullStrength))
    keys["at"] = keys["x_0"]._replace(required=False)
    of_material = not any(key in given for key in OWN)
    if of_material:
        keys = {name: key._replace(required=False) for name, key in keys.items()}
    elif "at" in given:
        keys["x_0"] = keys["at"]
        if "x_0" in given:
            rule = "both are the size of the test; keep one of them"
            reader.mistakes.append(clash(path, data, ("at", "x_0"), rule))

    def build(values: dict[str, Any]) -> WeibullStrength | dict[str, Any]:
        if "at" in values:
            values["x_0"] = values.pop("at")
        return values if of_material else reader.make(WeibullStrength, path, values)

    return reader.table(path, data, keys, build)


STRENGTH = Key(
    _of_material,
    False,
    "how strong the particles are",
    {"const": "material"},
    _strength,
    ({"m": 1},),
)


def with_strength(particles: Particles, path: str, asked: Any) -> Particles:
    """The particles, with the strength of their material where the file says so."""
    if not isinstance(asked, dict):
        return particles
    try:
        found = WeibullStrength.of(particles.material, **asked)
    except InvalidValue as error:
        raise error.under(path) from None
    return particles.replace(strength=found)
