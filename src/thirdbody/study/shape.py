"""The shape of particles: round, or a table of angular ones."""

from __future__ import annotations

from typing import Any

from ..errors import InvalidValue
from ..populations.shape import SPHERE, Angular, Sphere
from ..quantities.units import say
from .one_value import One, number
from .reader import Key, Reader, get, plain, reads_also
from .vocabulary import DISTRIBUTIONS

__all__ = ["OF_SIZES", "SHAPES", "shape"]

SHAPES = {"sphere": Sphere, "angular": Angular}
ABOUT = 'sphere, or the table { kind = "angular", roundness = 0.25, angle = "25 deg" }'
OF_SIZES = "weibull_shape"
"""The key for the shape of Weibull sizes, where that of particles has its name."""


def shape(reader: Reader, path: str, data: Any, own: dict[str, Key]) -> None:
    """Adds the key ``shape`` of a population; a number there is that of Weibull sizes."""
    given = get(data, "shape")
    sizes = DISTRIBUTIONS.get(str(get(data, "distribution")))
    of_sizes = getattr(sizes, "__dataclass_fields__", {}).get("shape")
    if of_sizes is not None:
        if not isinstance(given, dict):
            return
        read = plain(number(reader, f"{path}.{OF_SIZES}", dict(of_sizes.metadata["quantity"])))
        own[OF_SIZES] = Key(read, True, "Weibull shape of the sizes, beside a table shape")
    own["shape"] = Key(_read(reader, f"{path}.shape", given), False, ABOUT)


@reads_also({})
def _read(reader: Reader, path: str, data: Any) -> Any:
    if isinstance(data, dict):

        def build(values: dict[str, Any]) -> Any:
            return reader.make(SHAPES[values.pop("kind")], path, values)

        return reader.variant(path, data, "kind", SHAPES, build, {})

    def word(value: Any) -> Sphere:
        if value == "sphere":
            return SPHERE
        raise InvalidValue(f"{path} = {say(value)} must be {ABOUT}")

    return plain(One(word, {"const": "sphere"}))
