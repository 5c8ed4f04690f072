"""The walk through a study file: each table declares its keys, and one reader follows them."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple, Protocol, TypeVar, overload

import numpy as np

from ..errors import InvalidValue, Mistake, Note, Problem, in_study
from ..populations.materials import MaterialLibrary, materials
from ..populations.measured.topography import Topography
from ..quantities.nearest import Guess, guess
from ..quantities.say import join_words
from ..quantities.slips import SLIP, unit_meant
from ..quantities.unit_patterns import HARDNESS_TEXT, name_of_unit
from ..quantities.units import Quantity, example_of, quantity_to_si, say
from ..quantities.value import (
    allowed_range,
    hint_on,
    limits_of,
    problem_with,
    quantity,
)
from .fields import about_of, declarations
from .mistakes import Known, Missing, Unknown, clash, in_file
from .vocabulary import nearest_option

__all__ = [
    "ANYTHING",
    "FIELDS",
    "NOTHING",
    "Key",
    "Reader",
    "Table",
    "amounts",
    "count",
    "get",
    "is_span",
    "keys_of",
    "number",
    "numbers",
    "problems_of_order",
    "quantity_key",
    "read_number",
    "read_numbers",
    "read_text",
    "read_word",
    "refused_key",
    "rivals",
    "switch",
    "table_of",
    "tag_key",
    "text",
    "variants",
    "word",
    "words",
    "wrong",
]

ONE_OF = {
    "load": ("F_star", "pressure", "separation", "force"),
    "sweep": ("F_star", "pressure", "separation"),
    "roughness": ("eta", "eta_R_sigma"),
    "roughness.drawing": ("sigma", "Ra", "Rq", "Rz"),
}
"""Keys of a table of which only one can be given; after the dot a name where a table has several
such groups."""
MOST_POINTS = 1_000_000
LIMITS = {
    "gt": "exclusiveMinimum",
    "ge": "minimum",
    "lt": "exclusiveMaximum",
    "le": "maximum",
}
"""Limits of a quantity as JSON Schema calls them; of a number, which is in SI, not of text."""
ANYTHING: dict[str, Any] = {}
NOTHING: dict[str, Any] = {"enum": []}
DEFINITIONS = "#/definitions/"
"""Where a schema keeps the pattern of a unit."""
UNITS: dict[str, str] = {}
"""Units of the keys that are declared, by their names in a schema."""
"""What JSON Schema says of a key under which all, or nothing, can stand."""

Item = TypeVar("Item")
Read = TypeVar("Read")
Made = TypeVar("Made")
ReadOne = Callable[["Reader", str, object], object]
"""What reads the value at a path."""


class Key(NamedTuple):
    """One key of a table.

    Parameters
    ----------
    read : callable, optional
        What reads a value that is no table; None where only a table can stand.
    required : bool
        Whether it must stand.
    about : str
        What it is, for whoever left it out.
    schema : dict
        What ``read`` takes, in the words of JSON Schema.
    table : callable, optional
        What reads a table.
    also : tuple of dict
        Tables that have other keys than an empty one.
    items : callable, optional
        What reads each table of a list, where ``read`` takes one.
    default : object
        What counts where it is left out, as a file would write it; None where that is no one value.
    """

    read: ReadOne | None = None
    required: bool = False
    about: str = ""
    schema: dict[str, Any] = ANYTHING
    table: ReadOne | None = None
    also: tuple[Mapping[str, object], ...] = ()
    items: ReadOne | None = None
    default: bool | float | str | None = None

    def read_any(self, reader: Reader, path: str, value: object) -> object:
        """A value, whether it is a table or none."""
        if self.table is not None and (self.read is None or isinstance(value, dict)):
            return self.table(reader, path, value)
        return self.read(reader, path, value)  # type: ignore[misc]


FIELDS: dict[str, Key] = {}
"""Fields of value classes that are tables themselves, by their declared type; each is declared
where its table is read."""


@dataclass(frozen=True, kw_only=True)
class Table:
    """One top-level table or key of a study file.

    Parameters
    ----------
    name : str
        As in the file.
    key : Key
        How it is read.
    required : callable, optional
        Whether it must stand, from the whole file.
    role : {"contact", "study"}
        An argument of `Contact`, or of use to the study itself.
    """

    name: str
    key: Key
    required: Callable[[Mapping[str, object]], bool] | None = None
    role: str = "contact"


def rivals(path: str, key: str) -> tuple[str, ...]:
    """Keys of a table that cannot stand beside this one."""
    for name, keys in ONE_OF.items():
        if name.partition(".")[0] == path and key in keys:
            return tuple(other for other in keys if other != key)
    return ()


class Reader:
    """Reader of the tables of one file, which collects all mistakes.

    Parameters
    ----------
    folder : Path
        Where the file lies: names of other files count from there.
    whole : dict
        The parsed file.
    """

    every_way = False
    """Whether keys are looked up for whatever data may come, to say what a file may hold."""

    def __init__(self, folder: Path, whole: dict[str, object]) -> None:
        self.folder = folder
        self.whole = whole
        self.library: MaterialLibrary | None = materials
        """The materials that the file can name; None when they cannot be read."""
        self.mistakes: list[Problem | Missing | Unknown] = []
        self.notes: list[str] = []
        """What is allowed but looks like a slip."""
        self.assumed: list[str] = []
        """What numbers were taken for what a drawing says."""
        self.faces: list[Topography] = []
        """The measured surfaces that stand in [roughness]."""
        self.known_keys = Known()

    @property
    def stated_keys(self) -> frozenset[str]:
        """Dotted names of all keys of the file, items of lists by their numbers."""
        return frozenset(_names_in(self.whole, ""))

    @overload
    def table(
        self,
        path: str,
        data: object,
        keys: Mapping[str, Key],
        build: Callable[[dict[str, Any]], Made],
    ) -> Made: ...
    @overload
    def table(self, path: str, data: object, keys: Mapping[str, Key]) -> dict[str, Any]: ...
    def table(
        self,
        path: str,
        data: object,
        keys: Mapping[str, Key],
        build: Callable[[dict[str, Any]], object] = dict,
    ) -> object:
        """Object built from a table with these keys and no others.

        Its mistakes are kept, and an empty `InvalidValue` says that there are some.
        """
        if not isinstance(data, dict):
            written = f", written [{path}]" if "." not in path else " { ... }"
            raise wrong(path, f"must be a table{written}", data, code=Mistake.KIND)
        before, values = len(self.mistakes), {}
        for name, key in keys.items():
            if name in data:
                where = f"{path}.{name}" if path else name
                try:
                    values[name] = key.read_any(self, where, data[name])
                except InvalidValue as error:
                    self.mistakes += error.problems
            elif key.required:
                self.mistakes.append(Missing(path, name))
        self.mistakes += [Unknown(path, name, data[name]) for name in data if name not in keys]
        if len(self.mistakes) > before:
            self.known_keys.keys[path] = {name: key.about for name, key in keys.items()}
            raise InvalidValue
        # in the order of the file, which decides what each sampled input is given
        return build({name: values[name] for name in data})

    def read_each(
        self, items: Mapping[str, Item], read: Callable[[Reader, str, Item], Read]
    ) -> tuple[Read, ...]:
        """Several values, each read at its path; their mistakes are raised together."""
        out: list[Read] = []
        problems: list[Problem] = []
        for path, item in items.items():
            try:
                out.append(read(self, path, item))
            except InvalidValue as error:
                problems += error.problems
        if len(out) < len(items):
            raise InvalidValue(*problems)
        return tuple(out)

    def variant(
        self,
        path: str,
        data: object,
        tag: str,
        kinds: Mapping[str, type],
        build: Callable[[dict[str, Any]], object] | None = None,
        common: Mapping[str, Key] | None = None,
    ) -> object:
        """A table whose other keys depend on the word under ``tag``.

        When the word is missing or misspelt, the rest of the table is checked all the same, against
        what any kind would take, the nearest one first.
        """
        kind_word = get(data, tag)
        is_known = isinstance(kind_word, str) and kind_word in kinds
        nearest = kind_word if is_known else nearest_option(str(kind_word), kinds)
        keys = {tag: tag_key(tuple(kinds))}
        likely = [] if nearest is None else [nearest]
        for name in likely if is_known else [*likely, *kinds]:
            for field, key in keys_of(kinds[name]).items():
                keys.setdefault(field, key._replace(required=key.required and is_known))
        self.known_keys.variants[path] = tag, kinds
        made = build or (lambda values: self.make(kinds[values.pop(tag)], path, values))
        return self.table(path, data, keys | dict(common or {}), made)

    def only_one(self, path: str, data: Any, group: str = "") -> list[str]:
        """Tell of keys that say the same thing twice; the ones to leave out."""
        present = [key for key in ONE_OF[group or path] if get(data, key) is not None]
        if len(present) > 1:
            rule = "only one of these can be given; remove the other"
            self.mistakes.append(clash(path, data, present, rule))
        return present[1:]

    def make(self, kind: type[Made], path: str, values: Mapping[str, object]) -> Made:
        """The object, its own complaints told with the keys of the file."""
        try:
            return kind(**values)
        except InvalidValue as error:
            raise in_file(error, kind, path, values) from None


def _names_in(data: object, path: str) -> Iterator[str]:
    """Dotted names below a path."""
    items: Iterable[tuple[object, object]] = ()
    if isinstance(data, dict):
        items = data.items()
    elif isinstance(data, list) and any(isinstance(item, dict) for item in data):
        items = enumerate(data)
    for key, value in items:
        name = f"{path}.{key}" if path else str(key)
        yield name
        yield from _names_in(value, name)


# -------------------------------------------------------------------------- keys that are tables
@cache
def keys_of(kind: type) -> dict[str, Key]:
    """The keys of a table that stands for a value class.

    A field of a kind that a file cannot express, or that a contact fills in, is left out,
    and so is not a known key.
    """
    out = {}
    for field in declarations(kind):
        if field.quantity is not None:
            key = quantity_key(field.name, field.quantity)
        elif field.kind == "word":
            key = word(field.options, field.meaning)
        elif field.kind == "list":
            key = numbers(field.unit, usual=math.inf if field.any_unit else None)
        elif field.kind in PLAIN:
            key = PLAIN[field.kind]._replace(about=field.meaning)
        elif field.declared in FIELDS:
            key = FIELDS[field.declared]
        else:
            continue
        default = field.default if isinstance(field.default, bool | float | int | str) else None
        out[field.name] = key._replace(required=field.needed, default=default)
    return out


@cache
def tag_key(options: tuple[str, ...]) -> Key:
    """The key of the word on which the other keys of a table depend."""
    return word(options, f"one of {', '.join(map(say, options))}", required=True)


def table_of(kind: type, about: str = "", *, required: bool = False) -> Key:
    """The key of a table that stands for a value class: its fields are the keys."""

    def read(reader: Reader, path: str, data: object) -> object:
        return reader.table(path, data, keys_of(kind), partial(reader.make, kind, path))

    return Key(None, required, about, NOTHING, read)


def variants(
    tag: str, kinds: Mapping[str, type], about: str = "", *, required: bool = False
) -> Key:
    """Key of a table for one of several classes, chosen by a word in it."""

    def read(reader: Reader, path: str, data: object) -> object:
        return reader.variant(path, data, tag, kinds)

    return Key(None, required, about, NOTHING, read)


# -------------------------------------------------------------------------- keys of one value
class Notes(Protocol):
    """Protocol of objects that collect notes on a file."""

    notes: list[str]


class Unsaid:
    """Notes that nobody reads."""

    def __init__(self) -> None:
        self.notes: list[str] = []


def wrong(
    path: str, rule: str, value: object, *, hint: str = "", code: Mistake | None = None
) -> InvalidValue:
    """The error of one value of a file."""
    return InvalidValue(Problem(path, rule, say(value), hint=hint, code=code))


def quantity_key(name: str, about: Quantity, *, required: bool = False) -> Key:
    """Key of a number whose meaning is told with its name."""
    return number(about)._replace(about=about_of(name, about), required=required)


def number(about: Quantity) -> Key:
    """Key of a number in SI inside the range of its quantity; text has a unit."""
    plain: dict[str, object] = {"type": "number"}
    plain |= {LIMITS[key]: limit for key, limit in limits_of(about).items()}
    if about.get("whole"):
        plain["multipleOf"] = 1
    ways = [plain, text_of_unit(about["unit"])]
    if about["unit"] == "Pa" and about["meaning"].startswith("hardness"):
        ways.append({"type": "string", "pattern": HARDNESS_TEXT})
    return Key(partial(read_number, about), schema={"anyOf": ways})


def text_of_unit(unit: str) -> dict[str, object]:
    """What a schema says of a text with a unit; the pattern stands once in its definitions."""
    UNITS[name_of_unit(unit)] = unit
    return {"$ref": DEFINITIONS + name_of_unit(unit)}


def read_number(about: Quantity, reader: Notes, path: str, value: object) -> float:
    """The number in SI that a value of a file stands for."""
    try:
        si_value = quantity_to_si(value, about)
    except InvalidValue as error:
        problem = error.problems[0].put_at(path, say(value))
        if path.startswith("load.F_star") and "Pa" in str(value):
            cause = "a load in Pa goes under the key pressure"
            problem = problem.changed(hint=problem.hint + f"; {cause}" if problem.hint else cause)
        raise InvalidValue(problem) from None
    if not math.isfinite(si_value):
        allowed = f"; it must be {allowed_range(about)}" if limits_of(about) else ""
        raise wrong(path, f"is not a finite number{allowed}", value, code=Mistake.RANGE)
    if why := problem_with(about, si_value):
        meant = "" if hint_on(about, si_value) else f"; it is the {about['meaning']}"
        raise wrong(path, in_study(why) + meant, value, code=why.code)
    load = path.startswith(("load.pressure", "sweep.pressure", "design.pressure"))
    if likely := unit_meant(about, si_value, load=load):
        _refuse_slip(reader, path, value, f"{si_value:g} {about['unit']}", f"{si_value:g} {likely}")
    return si_value


def _refuse_slip(reader: Notes, path: str, value: object, taken: str, meant: str) -> None:
    """Refuse a number without a unit that no interface has; note one with a unit."""
    if not isinstance(value, str):
        has_unit = not isinstance(value, (int, float))  # a quantity of a library of units
    else:
        has_unit = re.fullmatch(r"[\d\s.+-]*([eE][+-]?\d+)?\s*", value) is None
    if has_unit:
        what = f"{path} = {say(value)} is taken as {taken}"
        action = "check its unit (upper and lower case matter)"
        reader.notes.append(Note(what, code=SLIP + path, action=action))
        return
    rule = f"has no unit, so it would be {taken}, which is not plausible"
    any_value = f'With its unit any value is taken: "{taken}"'
    hint = Guess(f'was "{meant}" meant? {any_value}', meant)
    raise wrong(path, rule, value, hint=hint, code=Mistake.UNIT)


def numbers(unit: str, about: str = "", *, usual: float | None = None) -> Key:
    """Key of a list of numbers; the class of the table checks their range.

    Lengths up to ``usual`` are no slip: infinity where numbers without a unit may be in any unit.
    """
    one: Quantity = quantity("", unit, "number").metadata["quantity"] | {"usual": usual}

    def read(reader: Reader, path: str, value: object) -> tuple[float, ...]:
        if not isinstance(value, list):
            raise wrong(
                path, f"must be a list, e.g. [{example_of(unit)}, ...]", value, code=Mistake.KIND
            )
        return read_numbers(one, Unsaid(), path, value)

    item = {"anyOf": [{"type": "number"}, text_of_unit(unit)]}
    schema = {"type": "array", "items": item}
    return Key(read, about=about or f"a list of numbers [{unit}]", schema=schema)


def read_numbers(
    about: Quantity, reader: Notes, path: str, value: Sequence[object]
) -> tuple[float, ...]:
    """The numbers in SI of a list."""
    out: list[float] = []
    problems: list[Problem] = []
    for i, item in enumerate(value):
        try:
            out.append(read_number(about, reader, f"{path}[{i}]", item))
        except InvalidValue as error:
            problems += error.problems
    if problems:
        raise InvalidValue(*problems)
    return tuple(out)


def amounts(name: str, about: Quantity, *, sampled: bool = False) -> Key:
    """The key of one value, a list of values, or a range; one to sample has no ``points``."""
    one = number(about).schema
    schema = {"anyOf": [one, {"type": "array", "items": one}]}
    table = partial(_range, about, _keys_of_range(about, sampled))
    return Key(partial(_amounts, about), False, about_of(name, about), schema, table)


def _amounts(about: Quantity, reader: Reader, path: str, value: object) -> np.ndarray:
    if not isinstance(value, list):
        return np.array([read_number(about, reader, path, value)])
    if not value:
        raise InvalidValue(
            Problem(path, "is empty; give at least one value", "[]", code=Mistake.EMPTY)
        )
    return np.array(read_numbers(about, reader, path, value))


def _spacings(about: Quantity) -> tuple[str, str]:
    """How the values of a range may lie, that of a range without the word first."""
    return ("linear", "log") if about["gt"] is None else ("log", "linear")


def _keys_of_range(about: Quantity, sampled: bool) -> dict[str, Key]:
    spacings = _spacings(about)
    example = f'e.g. {{ from = 5e-7, to = 2.4e-4, points = 200, spacing = "{spacings[0]}" }}'
    end = number(about)._replace(required=True)
    return {
        "from": end._replace(about=f"the lowest value, {example}"),
        "to": end._replace(about=f"the highest value, {example}"),
        "points": count(f"how many values, {example}")._replace(required=not sampled),
        "spacing": word(spacings),
    }


def _range(
    about: Quantity, keys: Mapping[str, Key], reader: Reader, path: str, data: object
) -> object:
    if reader.every_way:
        keys = {**keys, "points": keys["points"]._replace(required=False)}
    elif isinstance(data, dict) and (renamed := range_meant(data)):
        if keys["points"].required:
            renamed.setdefault("points", 10)
        else:
            renamed.pop("points", None)
        rule = f"is no range: {join_words(sorted(set(data) - set(renamed)))} are no keys of one"
        hint = f"write {path.rpartition('.')[2]} = {in_toml(renamed)}"
        reader.mistakes.append(Problem(path, rule, hint=hint, code=Mistake.UNKNOWN))
        data, keys = renamed, {**keys, "points": keys["points"]._replace(required=False)}
    spacing = get(data, "spacing")
    log = (_spacings(about)[0] if spacing is None else spacing) == "log"
    problems = _problems_of_ends(about, path, data, log)
    reader.mistakes += problems

    def build(values: dict[str, Any]) -> np.ndarray | dict[str, object]:
        low, high = values["from"], values["to"]
        if problems:
            raise InvalidValue
        if "points" not in values:
            return {"low": low, "high": high, "scale": "log" if log else "linear"}
        space = np.geomspace if log else np.linspace
        return space(low, high, values["points"])

    return reader.table(path, data, keys, build)


MEANT = {
    "from": ("start", "begin", "low", "lower", "min"),
    "to": ("stop", "end", "high", "upper", "max"),
    "points": ("num", "n", "number", "count", "steps", "values"),
}
"""Keys of a range, and how other programs call them."""


def range_meant(data: object) -> dict[str, object]:
    """A range whose keys are named as in other programs, in the keys of this one; else nothing.

    >>> range_meant({"start": 1, "stop": 5, "num": 3})
    {'from': 1, 'to': 5, 'points': 3}
    >>> range_meant({"from": 1, "to": 5, "points": 3}), range_meant({"low": 1})
    ({}, {})
    """
    if not isinstance(data, dict):
        return {}
    out: dict[str, object] = {}
    for key, others in MEANT.items():
        name = next((name for name in (key, *others) if name in data), None)
        if name is not None:
            out[key] = data[name]
    meant = {"from", "to"} <= out.keys() and not {"from", "to", "points"} >= data.keys()
    every_name = {"spacing", *MEANT, *itertools.chain(*MEANT.values())}
    if not meant or not data.keys() <= every_name or {"spacing", *MEANT} >= data.keys():
        return {}
    return out | {key: data[key] for key in ("spacing",) if key in data}


def in_toml(table: Mapping[str, object]) -> str:
    """A table in one line, as a study file has it."""
    return f"{{ {', '.join(f'{key} = {say(value)}' for key, value in table.items())} }}"


def _problems_of_ends(about: Quantity, path: str, data: Any, log: bool) -> list[Problem]:
    """Problems of the two ends of a range together."""
    try:
        low, high = (read_number(about, Unsaid(), path, data[end]) for end in ("from", "to"))
    except (InvalidValue, LookupError, TypeError):
        return []
    problems = problems_of_order(path, data, low, high, ends=("from", "to"))
    if log and low <= 0:
        rule, hint = 'must be > 0 with spacing = "log"', 'use spacing = "linear"'
        problems.append(
            Problem(f"{path}.from", rule, say(data["from"]), hint=hint, code=Mistake.RANGE)
        )
    return problems


def problems_of_order(
    path: str,
    data: Mapping[str, object],
    low: float,
    high: float,
    *,
    ends: tuple[str, str] = ("low", "high"),
    alone: str = "for one value write it alone",
) -> list[Problem]:
    """Problem of a range that does not go up, with its ends as the file writes them.

    >>> written = {"low": "1 um", "high": "50 nm"}
    >>> (problem,) = problems_of_order("vary", written, 1e-6, 5e-8)
    >>> str(problem)
    'vary is an empty range: low = "1 um" must be below high = "50 nm"; exchange them'
    """
    if low < high:
        return []
    hint = "exchange them" if low > high else alone
    first, last = (f"{end} = {say(data[end])}" for end in ends)
    rule = f"is an empty range: {first} must be below {last}"
    return [Problem(path, rule, hint=hint, code=Mistake.ORDER)]


def is_span(values: object) -> bool:
    """Whether this is what a range to sample is read as."""
    return isinstance(values, dict) and set(values) == {"low", "high", "scale"}


def count(about: str = "", *, least: int = 1, most: int = MOST_POINTS) -> Key:
    """Key of a whole number."""

    def read(reader: Reader, path: str, value: Any) -> int:
        whole = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not (whole and value == value // 1 and least <= value <= most):
            raise wrong(
                path, f"must be a whole number from {least} to {most}", value, code=Mistake.KIND
            )
        return int(value)

    return Key(read, about=about, schema={"type": "integer", "minimum": least, "maximum": most})


def word(options: Iterable[str], about: str = "", *, required: bool = False) -> Key:
    """Key of one of a few words."""
    return Key(partial(read_word, options), required, about, {"enum": options})


def read_word(options: Iterable[str], reader: object, path: str, value: object) -> str:
    """The word that a value of a file is."""
    if isinstance(value, str) and value in options:
        return value
    meant = nearest_option(str(value), options)
    hint = guess(str(value), options, meant=meant, show=say, otherwise=None)
    raise wrong(
        path,
        f"must be one of {', '.join(map(say, options))}",
        value,
        hint=hint,
        code=Mistake.OPTION,
    )


def words(options: Iterable[str] | None, about: str = "") -> Key:
    """Key of one word or a list of words; any word where there are no options."""

    def read(reader: Reader, path: str, value: Any) -> list[str]:
        values = value if isinstance(value, list) else [value]
        if options is not None:
            return [read_word(options, reader, path, item) for item in values]
        if not all(isinstance(item, str) for item in values):
            raise wrong(path, "must be a list of names in quotes", value, code=Mistake.KIND)
        return values

    one = {"type": "string"} if options is None else {"enum": options}
    return Key(read, about=about, schema={"anyOf": [one, {"type": "array", "items": one}]})


def refused_key(why: str, code: Mistake = Mistake.IDLE) -> Key:
    """A key that is known and has no place here."""

    def read(reader: Reader, path: str, value: object) -> object:
        raise wrong(path, why, value, code=code)

    return Key(read, schema=NOTHING)


def _read_word_or_number(reader: Reader, path: str, value: object) -> str | float:
    """A word or a pure number; the object checks which words it takes."""
    if isinstance(value, str) or (isinstance(value, (int, float)) and not isinstance(value, bool)):
        return value
    raise wrong(path, "must be a word in quotes or a number", value, code=Mistake.KIND)


def read_text(reader: Reader, path: str, value: object) -> str:
    """The text that a value of a file is."""
    if isinstance(value, str):
        return value
    simple = isinstance(value, (int, float)) and not isinstance(value, bool)
    raise wrong(
        path, "must be text in quotes" + f', e.g. "{value}"' * simple, value, code=Mistake.KIND
    )


def _read_switch(reader: Reader, path: str, value: object) -> bool:
    if isinstance(value, bool):
        return value
    raise wrong(path, "must be true or false, without quotes", value, code=Mistake.KIND)


text = Key(read_text, schema={"type": "string"})
"""Text in quotes."""
switch = Key(_read_switch, schema={"type": "boolean"})
"""True or false."""
PLAIN: Mapping[str, Key] = {
    "switch": switch,
    "text": text,
    "word or number": Key(_read_word_or_number, schema={"type": ["number", "string"]}),
}
"""Keys of which all is known but what they are."""


def get(data: object, key: str) -> Any:
    """An entry of a table, None where there is no table or no entry."""
    return data.get(key) if isinstance(data, dict) else None
