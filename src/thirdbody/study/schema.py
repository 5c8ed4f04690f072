"""What a study file may hold: its keys, and JSON Schema for editors, which complete words by it."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import combinations
from pathlib import Path
from typing import Any

from ..populations.materials import materials
from ..quantities.unit_patterns import pattern_of_unit
from .life import LIFE
from .load import LOAD, PRESSES
from .mistakes import Known
from .reader import NOTHING, ONE_OF, UNITS, Key, Reader, Table, get, keys_of, tag_key
from .tables import TABLES
from .vocabulary import LOADS

__all__ = ["Describer", "study_schema"]

DRAFT = "http://json-schema.org/draft-07/schema#"
REMARKS = ("description", "default")
"""What a schema says of a key beside what may stand there."""
DEEPEST = 5
"""Names in the path of a table inside tables beyond which all may stand."""


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
    >>> from thirdbody.study import study_schema
    >>> schema = study_schema()
    >>> schema["else"]["required"]  # where there is no [life], an oil without a contact
    ['surfaces', 'roughness']
    >>> schema["properties"]["explicit"]["properties"]["size"]["maximum"]
    4096
    """
    describer = Describer(Path(), {})
    describer.every_way = True
    keys = {table.name: table.key for table in TABLES}
    schema = describer.table("", {}, keys)
    # an oil without a contact needs no surfaces
    contact = {"required": schema.pop("required")}
    contact["anyOf"] = [
        *({"required": [name]} for name in (LOAD.name, *PRESSES)),
        *({"required": ["sweep"], "properties": {"sweep": {"required": [name]}}} for name in LOADS),
    ]
    schema |= {"if": {"required": [LIFE.name]}, "then": {}, "else": contact}
    schema["allOf"] = [
        *_exclusions(),
        _named_materials(schema["properties"]["surfaces"]["properties"]),
    ]
    schema["definitions"] = {
        name: {"type": "string", "pattern": pattern_of_unit(unit)}
        for name, unit in sorted(UNITS.items())
    }
    return {"$schema": DRAFT, "title": "A study file of thirdbody"} | schema


def _exclusions() -> Iterator[dict[str, object]]:
    """Tables in which two keys say the same thing."""
    for name, keys in ONE_OF.items():
        table = name.partition(".")[0]
        for pair in combinations(keys, 2):
            yield {"properties": {table: {"not": {"required": list(pair)}}}}
    yield {"properties": {LOAD.name: {"minProperties": 1}}}


def _named_materials(surfaces: Iterable[str]) -> dict[str, object]:
    """Materials by their names are those of the library, but where a file has its own."""
    name = {"anyOf": [{"not": {"type": "string"}}, {"enum": list(materials)}]}
    one = {"properties": {"material": name}}
    several = {"anyOf": [one | {"type": "object"}, {"type": "array", "items": one}]}
    sides = {"properties": {side: name for side in surfaces}}
    tables = {"properties": {"surfaces": sides, "particles": several}}
    return {"if": {"required": ["materials"]}, "then": {}, "else": tables}


class Describer(Reader):
    """Walker through the tables of a file, as a `Reader`, that says what each may hold.

    ``table`` gives JSON Schema in the place of a value, and keeps the keys in ``known_keys``.
    """

    def known_of(self, tables: Iterable[Table]) -> Known:
        """The keys of these tables, for the data of the file."""
        self.table("", self.whole, {table.name: table.key for table in tables})
        return self.known_keys

    def table(
        self,
        path: str,
        data: Any,
        keys: Mapping[str, Key],
        build: Callable[[dict[str, object]], object] = dict,
    ) -> Any:
        """The schema of a table with these keys and no others."""
        if path.count(".") >= DEEPEST:
            return {}
        self.known_keys.keys[path] = {name: key.about for name, key in keys.items()}
        properties = {}
        keys = {name: key for name, key in keys.items() if not _is_refused(key)}
        for name, key in keys.items():
            where = f"{path}.{name}" if path else name
            ways = self._ways(key, where, get(data, name))
            if not self.every_way:  # of which the keys alone are wanted
                deque(ways, maxlen=0)
                continue
            described: dict[str, object] = {"description": key.about} if key.about else {}
            if _in_json(key.default):
                described["default"] = key.default
            properties[name] = described | _any_of(ways)
        return _schema_of(properties, [name for name, key in keys.items() if key.required])

    def read_each(
        self, items: Mapping[str, object], read: Callable[[Reader, str, Any], Any]
    ) -> Any:
        """The schema of a list."""
        ways = [read(self, *item) for item in items.items()]
        return {"type": "array", "items": _any_of(ways)} if self.every_way else {}

    def variant(
        self,
        path: str,
        data: object,
        tag: str,
        kinds: Mapping[str, type],
        build: Callable[[dict[str, object]], object] | None = None,
        common: Mapping[str, Key] | None = None,
    ) -> Any:
        """The schema of a table whose keys depend on a word: of all of them, for whatever data."""
        if not self.every_way:
            return super().variant(path, data, tag, kinds, build, common)
        ways = (
            {tag: tag_key(tuple(kinds))} | keys_of(kind) | dict(common or {})
            for kind in kinds.values()
        )
        return _any_of([self.table(path, data, keys) for keys in ways])

    def _ways(self, key: Key, path: str, data: Any) -> Iterator[dict[str, Any]]:
        """Schemas of all that can stand under a key."""
        yield key.schema
        among = (data, *key.also) if self.every_way else (data,)
        outermost = "." not in path and not isinstance(data, list)
        alone = self.every_way or key.read is None or outermost
        if key.table is not None and (alone or isinstance(data, dict)):
            ways: Iterator[Any] = (key.table(self, path, entry) for entry in among)
            yield from ways
        if key.items is not None and (self.every_way or isinstance(data, list)):
            form = "{}.{}" if "." not in path else "{}[{}]"
            items = among if self.every_way else data
            yield self.read_each(
                {form.format(path, i): entry for i, entry in enumerate(items)}, key.items
            )


def _is_refused(key: Key) -> bool:
    """Whether nothing can stand under a key: it is known elsewhere, and told of here."""
    return key.schema is NOTHING and key.table is None and key.items is None


def _any_of(ways: Iterable[dict[str, object]]) -> dict[str, Any]:
    """Schema of a value that may be written in any of these ways; tables become one."""
    tables: list[dict[str, object]] = []
    out: list[dict[str, object]] = []
    for schema in _each_way(ways):
        if "properties" in schema:
            tables.append(schema)
        elif schema not in out:
            out.append(schema)
    if tables:
        out.append(_merge_tables(tables))
    if {} in out or not out:
        return {}
    return out[0] if len(out) == 1 else {"anyOf": out}


def _each_way(ways: Iterable[dict[str, Any]]) -> Iterator[dict[str, object]]:
    for schema in ways:
        if "anyOf" in schema:
            yield from _each_way(schema["anyOf"])
        elif "enum" in schema:
            if options := list(schema["enum"]):
                yield {"enum": options}
        else:
            yield schema | ({"items": _any_of([schema["items"]])} if "items" in schema else {})


def _merge_tables(tables: list[dict[str, Any]]) -> dict[str, object]:
    """The schema of a table that is written in these ways: all their keys, and no others."""
    ways: dict[str, list[dict[str, object]]] = {}
    for table in tables:
        for name, schema in table["properties"].items():
            ways.setdefault(name, []).append(schema)
    properties = {}
    for name, several in ways.items():
        about = next((schema["description"] for schema in several if "description" in schema), None)
        described: dict[str, object] = {} if about is None else {"description": about}
        defaults = [schema.get("default") for schema in several]
        if defaults[0] is not None and all(schema == defaults[0] for schema in defaults):
            described["default"] = defaults[0]
        bare = ({k: v for k, v in schema.items() if k not in REMARKS} for schema in several)
        properties[name] = described | _any_of(bare)
    first, *others = (table.get("required", []) for table in tables)
    needed = [name for name in first if all(name in other for other in others)]
    return _schema_of(properties, needed)


def _in_json(default: object) -> bool:
    """Whether a default can stand in a schema: finite, and not the empty text of a label."""
    if isinstance(default, float):
        return math.isfinite(default)
    return default is not None and default != ""


def _schema_of(properties: Mapping[str, object], needed: list[str]) -> dict[str, object]:
    """The schema of a table with these keys and no others."""
    needs = {"required": needed} if needed else {}
    return {"type": "object", "properties": properties} | needs | {"additionalProperties": False}
