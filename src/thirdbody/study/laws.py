"""The tables [asperity_law] and [particle_law], and a law wherever a file names one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import AfterValidator, PlainValidator

from ..laws import asperity, particle
from .one_value import word
from .reader import Reader, Table, get, reads_also

__all__ = ["ASPERITY_LAW", "PARTICLE_LAW", "asperity_law", "class_of", "named_law", "particle_law"]


def asperity_law(reader: Reader, path: str, data: Any) -> Any:
    """What one asperity does."""
    return named_law(reader, path, data, asperity.REGISTRY)


def particle_law(reader: Reader, path: str, data: Any) -> Any:
    """What one particle does."""
    return named_law(reader, path, data, particle.REGISTRY)


def class_of(data: Any, registry: Mapping[str, type]) -> type | None:
    """The class of the law that a file names, by a word or in a table."""
    return registry.get(str(get(data, "name") if isinstance(data, dict) else data))


@reads_also("", {})
def named_law(reader: Reader, path: str, data: Any, registry: Mapping[str, type]) -> Any:
    """A name, or a table with the name and options of the law."""

    def build(values: dict[str, Any]) -> Any:
        return reader.make(registry[values.pop("name")], path, values)

    if isinstance(data, str):
        name = PlainValidator(word(path, registry))
        return Annotated[Any, name, AfterValidator(lambda name: build({"name": name}))]
    return reader.variant(path, data, "name", registry, build, {})


ASPERITY_LAW = Table(name="asperity_law", read=asperity_law)
PARTICLE_LAW = Table(name="particle_law", read=particle_law)
