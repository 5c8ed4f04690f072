"""The machinery under every table: a pydantic schema for one file, put together key by key."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, NamedTuple

from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema

from ..errors import InvalidValue
from ..populations.materials import MaterialLibrary, materials
from ..populations.measured.topography import Topography
from ..quantities.units import say
from .fields import about_of, declarations
from .mistakes import Known, clash, in_file
from .one_value import number, numbers, switch, text, word, word_or_number
from .vocabulary import near

__all__ = [
    "Built",
    "Key",
    "Read",
    "Reader",
    "Table",
    "Ways",
    "get",
    "plain",
    "reads_also",
    "rivals",
]

ONE_OF = {
    "load": ("F_star", "pressure", "separation", "force"),
    "sweep": ("F_star", "pressure", "separation"),
    "roughness": ("eta", "eta_R_sigma"),
    "roughness.drawing": ("sigma", "Ra", "Rq", "Rz"),
}
"""Keys of a table of which only one can be given; after the dot a name where a table has several
such groups."""


def rivals(path: str, key: str) -> tuple[str, ...]:
    """The other keys of a table that cannot stand beside this one."""
    for name, keys in ONE_OF.items():
        if name.partition(".")[0] == path and key in keys:
            return tuple(other for other in keys if other != key)
    return ()


class Key(NamedTuple):
    """One key of a table: the type pydantic checks, whether it must stand, what it is."""

    type: Any
    required: bool
    about: str


@dataclass(frozen=True, kw_only=True)
class Table:
    """One top-level table or key of a study file.

    Parameters
    ----------
    name : str
        As in the file.
    read : callable
        From the reader, the path and the data under it (None where it is left out): the type that
        pydantic checks, which gives the object.
    about : str, optional
        What a user is told when it is missing.
    required : callable, optional
        Whether it must stand, from the whole file.
    role : {"contact", "study"}
        An argument of `Contact`, or of use to the study itself.
    """

    name: str
    read: Callable[[Reader, str, Any], Any]
    about: str = ""
    required: Callable[[Mapping[str, Any]], bool] = lambda whole: False
    role: str = "contact"


FieldReader = Callable[["Reader", str, Any], Any]
PLAIN: Mapping[str, Callable[[str], Any]] = {
    "switch": switch,
    "text": text,
    "word or number": word_or_number,
}
"""What reads the values of which the path is all that one must know."""


class Ways(NamedTuple):
    """Every type that a key may have, where its data decide which."""

    types: tuple[Any, ...]


DEEPEST = 5
"""Names in the path of a table inside tables beyond which `Ways` are not followed."""


def reads_also(*others: Any) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Marks what reads a table or a key, with data that it reads in other ways than none."""

    def mark(read: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(read)
        def reading(reader: Reader, path: str, data: Any, *more: Any, **options: Any) -> Any:
            if not reader.every_way:
                return read(reader, path, data, *more, **options)
            if path.count(".") >= DEEPEST:
                return Any
            ways = (data, *(other for other in others if other != data))
            return Ways(tuple(read(reader, path, way, *more, **options) for way in ways))

        return reading

    return mark


class Reader:
    """What the readers of all tables of one file share.

    Parameters
    ----------
    folder : Path
        Where the file lies: names of other files count from there.
    whole : dict
        The parsed file.
    fields : mapping
        For fields that are themselves tables: the type as declared in the value class, how it is
        read and what it is.
    """

    every_way = False
    """Whether keys are put together for whatever data may come, to say what a file may hold."""

    def __init__(
        self, folder: Path, whole: dict[str, Any], fields: Mapping[str, tuple[FieldReader, str]]
    ) -> None:
        self.folder = folder
        self.whole = whole
        self.fields = fields
        self.library: MaterialLibrary | None = materials
        """The materials that the file can name; None when they cannot be read."""
        self.problems: list[str] = []
        """Mistakes that concern several keys at once."""
        self.notes: list[str] = []
        """What is allowed but looks like a slip."""
        self.assumed: list[str] = []
        """What numbers were taken for what a drawing says."""
        self.faces: list[Topography] = []
        """The measured surfaces that stand in [roughness]."""
        self.known = Known()

    # ------------------------------------------------------------------ tables
    def value(self, path: str, data: Any, kind: type) -> Any:
        """A table that stands for a value class: its fields are the keys."""
        keys = self.keys_of(kind, path, data)
        return self.table(path, keys, lambda values: self.make(kind, path, values))

    def keys_of(self, kind: type, path: str, data: Any) -> dict[str, Key]:
        """The keys of a table that stands for a value class.

        A field of a kind that a file cannot express, or that a contact fills in, is left out,
        and so is not a known key.
        """
        out = {}
        for each in declarations(kind):
            where, about = f"{path}.{each.name}", each.meaning
            if each.quantity is not None:
                read = plain(number(self, where, each.quantity))
                about = about_of(each.name, each.quantity)
            elif each.kind == "word":
                read = plain(word(where, each.options))
            elif each.kind == "list":
                usual = math.inf if each.any_unit else None
                read = plain(numbers(where, each.unit, usual=usual))
                about = f"a list of numbers [{each.unit}]"
            elif each.kind in PLAIN:
                read = plain(PLAIN[each.kind](where))
            elif each.declared in self.fields:
                read_field, about = self.fields[each.declared]
                read = read_field(self, where, get(data, each.name))
            else:
                continue
            out[each.name] = Key(read, each.needed, about)
        return out

    def variant(
        self,
        path: str,
        data: Any,
        tag: str,
        kinds: Mapping[str, type],
        build: Callable[[dict[str, Any]], Any],
        common: dict[str, Key],
    ) -> Any:
        """A table whose other keys depend on the word under ``tag``.

        When the word is missing or misspelt, the rest of the table is checked all the same:
        against the nearest kind, or against what any kind would take.
        """
        asked = get(data, tag)
        chosen = asked if isinstance(asked, str) and asked in kinds else near(str(asked), kinds)
        if self.every_way:
            chosen = None
        self.known.variants[path] = (
            tag,
            {name: {each.name for each in declarations(kind)} for name, kind in kinds.items()},
        )
        words = ", ".join(map(say, kinds))
        keys = {tag: Key(plain(word(f"{path}.{tag}", kinds)), True, f"one of {words}")}
        if chosen is not None:
            keys |= self.keys_of(kinds[chosen], path, data) | common
        else:
            for kind in kinds.values():
                any_kind = self.keys_of(kind, path, data)
                for name, key in any_kind.items():
                    if name not in keys:
                        keys[name] = key._replace(required=False)
                    elif self.every_way:
                        keys[name] = Key(Ways((keys[name].type, key.type)), False, key.about)
            keys |= common
        return self.table(path, keys, build)

    def table(self, path: str, keys: dict[str, Key], build: Callable[[dict[str, Any]], Any]) -> Any:
        """What pydantic checks of the table, followed by the object it stands for."""
        self.known.keys[path] = {name: key.about for name, key in keys.items()}
        return Annotated[Any, Built(keys, build)]

    # ------------------------------------------------------------------ several keys at once
    def only_one(self, path: str, data: Any, group: str = "") -> list[str]:
        """Tell of keys that say the same thing twice; the ones to leave out."""
        given = [key for key in ONE_OF[group or path] if get(data, key) is not None]
        if len(given) > 1:
            rule = "only one of these can be given; remove the other"
            self.problems.append(clash(path, data, given, rule))
        return given[1:]

    def make(self, kind: type, path: str, values: dict[str, Any]) -> Any:
        """The object, its own complaints told with the keys of the file."""
        try:
            return kind(**values)
        except InvalidValue as error:
            raise in_file(error, kind, path, values) from None


@dataclass(frozen=True)
class Built:
    """A table with these keys and no others, as a schema: faster to put together than a model."""

    keys: dict[str, Key]
    build: Callable[[dict[str, Any]], Any]

    def __get_pydantic_core_schema__(self, kind: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        fields = {
            name: core_schema.typed_dict_field(
                handler.generate_schema(key.type), required=key.required
            )
            for name, key in self.keys.items()
        }
        table = core_schema.typed_dict_schema(fields, extra_behavior="forbid")
        return core_schema.no_info_wrap_validator_function(self._finish, table)

    def _finish(self, given: Any, check: Callable[[Any], Any]) -> Any:
        values = check(given)
        # in the order of the file, which decides what each sampled input is given
        return self.build({name: values[name] for name in given})


def plain(read: Callable[[Any], Any]) -> Any:
    """A type that reads one value."""
    return Annotated[Any, Read(read)]


@dataclass(frozen=True)
class Read:
    """What reads one value; `pydantic.PlainValidator` would look for ways to write it as well."""

    read: Callable[[Any], Any]

    def __get_pydantic_core_schema__(self, kind: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)


def get(data: Any, key: str) -> Any:
    """An entry of a table, None where there is no table or no entry."""
    return data.get(key) if isinstance(data, dict) else None
