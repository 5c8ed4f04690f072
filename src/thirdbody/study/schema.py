"""What a study file may hold, as JSON Schema: for editors, which complete keys and words by it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Annotated, Any, get_args, get_origin

from pydantic import PlainValidator

from .reader import Built, Key, Read, Reader, Ways
from .tables import FIELDS, TABLES

__all__ = ["study_schema"]

DRAFT = "http://json-schema.org/draft-07/schema#"
BESIDES: dict[str, Any] = {"film": {}, "sweep": {"pressure": 1}}
"""A file in which only what must always stand is missing."""


def study_schema() -> dict[str, Any]:
    """The JSON Schema of study files, put together from the readers of their tables.

    Whatever a study file may hold fits it. Not all that fits is a study: which keys go together,
    and the ranges of numbers with a unit, the reader alone knows.

    Returns
    -------
    dict
        JSON Schema, draft 7.

    Examples
    --------
    >>> schema = study_schema()
    >>> schema["required"]
    ['surfaces', 'roughness']
    >>> schema["properties"]["explicit"]["properties"]["size"]["maximum"]
    4096
    """
    reader = Reader(Path(), {}, FIELDS)
    reader.every_way = True
    keys = {
        table.name: Key(table.read(reader, table.name, None), table.required(BESIDES), table.about)
        for table in TABLES
    }
    return {"$schema": DRAFT, "title": "A study file of thirdbody"} | _table([keys])


def _any_of(kinds: Iterable[Any]) -> dict[str, Any]:
    """The schema of a value whose types are these; tables among them become one."""
    tables: list[dict[str, Key]] = []
    out: list[dict[str, Any]] = []
    for schema in _schemas(kinds):
        if isinstance(schema, Built):
            tables.append(schema.keys)
        elif schema not in out:
            out.append(schema)
    if tables:
        out.append(_table(tables))
    if {} in out or not out:
        return {}
    return out[0] if len(out) == 1 else {"anyOf": out}


def _table(tables: list[dict[str, Key]]) -> dict[str, Any]:
    """The schema of a table that is read in these ways: all their keys, and no others."""
    ways: dict[str, list[Key]] = {}
    for keys in tables:
        for name, key in keys.items():
            ways.setdefault(name, []).append(key)
    properties = {}
    for name, several in ways.items():
        about = next((key.about for key in several if key.about), "")
        described = {"description": about} if about else {}
        properties[name] = described | _any_of(key.type for key in several)
    needed = [name for name, each in ways.items() if len(each) == len(tables) and all(
        key.required for key in each)]  # fmt: skip
    needs = {"required": needed} if needed else {}
    return {"type": "object", "properties": properties} | needs | {"additionalProperties": False}


def _schemas(kinds: Iterable[Any]) -> Iterator[dict[str, Any] | Built]:
    """Each way in which a value may stand: its schema, or the table that it is.

    Of what is known only once there are data nothing is yielded, nor of what is refused.
    """
    for kind in kinds:
        if isinstance(kind, Ways):
            yield from _schemas(kind.types)
        elif get_origin(kind) is tuple:
            yield {"type": "array", "items": _any_of(get_args(kind))}
        elif get_origin(kind) is Annotated:
            inner, *marks = get_args(kind)
            yield from _schemas([inner])
            yield from filter(None, map(_schema_of, marks))


def _schema_of(mark: Any) -> dict[str, Any] | Built | None:
    """What one annotation of a type says of the value; None where it only builds."""
    if isinstance(mark, Built):
        return mark
    if isinstance(mark, Read | PlainValidator):
        return getattr(mark.read if isinstance(mark, Read) else mark.func, "schema", {})
    return None
