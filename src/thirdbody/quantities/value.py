"""Value objects: what a user builds is frozen, checked once, comparable, and has a JSON round trip.

Each physical field is declared with `quantity`, which keeps symbol, unit, meaning and the
allowed range beside the field: constructor checks, study files and the documentation read
the same declaration.
"""

from __future__ import annotations

import dataclasses
import inspect
import math
import re
import sys
import types
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import MISSING, field
from functools import cache
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypedDict, get_args

from ..errors import Clause, InvalidValue, Mistake, NotCompiled, Problem
from .arguments import FAILURES, NamesArguments, names_arguments, refuse_misfits
from .carried import carries_unit, huge_words, in_si, masked_words, takes_units
from .nearest import guess
from .notebook import Card, Row, Shown, words_of
from .plain_data import plain_data
from .slips import is_silent, slips_are_told, unit_meant, warn_of_slip
from .uncertain import HELD, is_uncertain
from .units import Quantity, Range, say

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = [
    "Choice",
    "Value",
    "choice",
    "count_field",
    "items_of",
    "meanings_of",
    "paths_of",
    "quantity",
    "sequences",
    "several",
]


class Choice(TypedDict):
    """Declaration of a word, as `choice` makes it."""

    meaning: str
    options: tuple[str, ...]


def quantity(
    symbol: str,
    unit: str,
    meaning: str,
    *,
    default: object = MISSING,
    gt: float | None = None,
    ge: float | None = None,
    lt: float | None = None,
    le: float | None = None,
    hint: str = "",
    usual: float | None = None,
) -> Any:
    """A dataclass field that holds one finite number in SI.

    Parameters
    ----------
    symbol, unit, meaning : str
        As in the nomenclature; ``unit`` is "1" for a pure number.
    default : float or None, optional
        None makes the field optional.
    gt, ge, lt, le : float, optional
        Allowed range.
    hint : str, optional
        The likely cause of a mistake, appended to the message.
    usual : float, optional
        Lengths up to it, and pressures from it on, are no slip; `USUAL_LENGTH` by default, and as
        for a modulus.
    """
    about = Quantity(
        symbol=symbol, unit=unit, meaning=meaning, gt=gt, ge=ge, lt=lt, le=le, hint=hint
    )
    if usual is not None:
        about["usual"] = usual
    return field(default=default, metadata={"quantity": about})


def count_field(
    symbol: str,
    meaning: str,
    *,
    default: object = MISSING,
    ge: float | None = None,
    le: float | None = None,
) -> float:
    """A dataclass field that holds how many there are of something: a whole number."""
    about = Quantity(
        symbol=symbol, unit="1", meaning=meaning, gt=None, ge=ge, lt=None, le=le, hint="",
        whole=True,
    )  # fmt: skip
    return field(default=default, metadata={"quantity": about})  # type: ignore[return-value]


def several(unit: str, meaning: str, *, default: object = MISSING) -> Any:
    """A dataclass field that holds a tuple of numbers in SI."""
    return field(default=default, metadata={"several": {"unit": unit, "meaning": meaning}})


def choice(meaning: str, *options: str, default: str) -> Any:
    """A dataclass field that holds one of a few words: ``options``, or those of its `Literal`."""
    return field(default=default, metadata={"choice": {"meaning": meaning, "options": options}})


def _take_options(kind: type) -> None:
    """Fill in the words of the choices of a class that is being made, from its annotations."""
    fields = {n: getattr(member, "metadata", {}) for n, member in vars(kind).items()}
    choices = {n: about["choice"] for n, about in fields.items() if "choice" in about}
    for name in (n for n, about in choices.items() if not about["options"]):
        words = inspect.get_annotations(kind)[name]
        if isinstance(words, str):
            words = eval(words, vars(sys.modules[kind.__module__]))
        choices[name]["options"] = get_args(words)


def limits_of(about: Range) -> dict[str, float]:
    """The limits that a quantity has, by the names of their keys."""
    every = {"gt": about["gt"], "ge": about["ge"], "lt": about["lt"], "le": about["le"]}
    return {key: limit for key, limit in every.items() if limit is not None}


SIGNS = {"gt": ">", "ge": ">=", "lt": "<", "le": "<="}


def allowed_range(about: Range) -> str:
    """The allowed range of a quantity in words, e.g. ``"> 0 [Pa]"``."""
    limits = " and ".join(f"{SIGNS[key]} {limit:g}" for key, limit in limits_of(about).items())
    text = limits or "a finite number"
    unit = "" if about["unit"] == "1" else f" [{about['unit']}]"
    return f"{text}{unit}"


def problem_with(about: Range, value: Any) -> Clause | None:
    """Why ``value`` cannot stand for this quantity, or None when it can."""
    if type(value) not in (float, int):
        if isinstance(value, (bool, str)) or not hasattr(value, "__float__"):
            return Mistake.KIND.clause(
                f"must be a number in SI units [{about['unit']}], not {type(value).__name__}"
            )
        if is_uncertain(value):
            return HELD
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    except (TypeError, ValueError):
        return Mistake.KIND.clause(f"must be one number in SI units [{about['unit']}]")
    outside = (
        not math.isfinite(number)
        or (about["gt"] is not None and not number > about["gt"])
        or (about["ge"] is not None and not number >= about["ge"])
        or (about["lt"] is not None and not number < about["lt"])
        or (about["le"] is not None and not number <= about["le"])
    )
    if outside:
        cause = hint_on(about, number)
        hint = "; " + cause if cause else ""
        return Mistake.RANGE.clause(f"must be {allowed_range(about)}" + hint)
    if about.get("whole") and not number.is_integer():
        return Mistake.KIND.clause("must be a whole number")
    return why_extreme(number, about["unit"], positive=about["gt"] is not None and about["gt"] >= 0)


def hint_on(about: Range, number: float) -> str:
    """Likely cause of a number outside its range: a sign, a unit, no number; "" where it is none.

    A hint on units has a number as an example; on one that is not positive it would mislead.

    >>> force = quantity("F", "N", "force", gt=0, lt=1e9, hint="kN are '5 kN'").metadata["quantity"]
    >>> hint_on(force, -1e3), hint_on(force, 0.0), hint_on(force, 1e12)
    ('leave out the minus sign', '', "kN are '5 kN'")
    >>> hint_on(force, math.nan)
    'it is not a number, like 0/0 or a missing value'
    """
    if math.isnan(number):
        return "it is not a number, like 0/0 or a missing value"
    least = about["ge"] if about["gt"] is None else about["gt"]
    if least is None or least < 0 or number > 0:
        return about["hint"]
    if -math.inf < number < 0:
        return "leave out the minus sign"
    return "" if re.search(r"\d", about["hint"]) else about["hint"]


SMALLEST, LARGEST = 1e-40, 1e40
"""Sizes of numbers in SI that can be computed with: no product or ratio of a few of them is beyond
what a double holds, and nothing measured is beyond them."""


def why_extreme(number: float, unit: str, *, positive: bool) -> Clause | None:
    """Why a number is too small or too large to compute with, or None where it is not.

    Only what must be positive is divided by: a number that may be 0 may be as small as it likes.
    """
    shown = "" if unit == "1" else f" [{unit}]"
    if abs(number) > LARGEST:
        return Mistake.RANGE.clause(
            f"must be at most {LARGEST:g}{shown} in size; check its exponent"
        )
    if positive and number < SMALLEST:
        return Mistake.RANGE.clause(f"must be at least {SMALLEST:g}{shown}; check its exponent")
    return None


def warn_of_slips(value: Value, *, prefix: str = "", before: Value | None = None) -> None:
    """Warn of every number of a value that looks like a slip.

    Values in it have told of theirs when they were made, but for those that do not. Of a copy of
    ``before`` all that has changed is told.
    """
    if is_silent() or not dataclasses.is_dataclass(value):  # an output or law of one's own
        return
    for name, about, _ in _declarations(type(value)):
        new, old = getattr(value, name), getattr(before, name, None)
        if new is old:
            continue
        if about:
            if new is not None and unit_meant(about, new):
                warn_of_slip(prefix + name, about, new)
        elif isinstance(new, (Value, tuple)):
            old_values = dict(_values_in(prefix + name, old))
            for where, inner in _values_in(prefix + name, new):
                tells = before is not None or not inner._tells_of_slips
                if tells and inner is not old_values.get(where):
                    warn_of_slips(inner, prefix=f"{where}.", before=old_values.get(where))


def _tells(content: object) -> bool:
    """Whether what a field holds has told of its slips when it was made."""
    values = content if isinstance(content, tuple) else (content,)
    return all(isinstance(value, Value) and value._tells_of_slips for value in values)


@cache
def _declarations(
    kind: type,
) -> tuple[tuple[str, Quantity | None, Choice | None], ...]:
    """Fields of a class, each with its declared quantity or choice."""
    return tuple(
        (item.name, item.metadata.get("quantity"), item.metadata.get("choice"))
        for item in dataclasses.fields(kind)
    )


def _values_in(name: str, content: object) -> Iterator[tuple[str, Value]]:
    """The values in a field, by dotted names."""
    if isinstance(content, Value):
        yield name, content
    elif isinstance(content, tuple):
        yield from (
            (f"{name}.{i}", element)
            for i, element in enumerate(content)
            if isinstance(element, Value)
        )


BARE = (float, str, bool, type(None))
"""Types of values that are neither masked nor huge, and carry no unit."""


class Value(Shown, NamesArguments):
    """Base class of the frozen, slotted, keyword-only dataclasses a user builds."""

    __slots__ = ()
    _classes: ClassVar[dict[str, type[Value]]] = {}
    _tells_of_slips: ClassVar[bool] = True
    """Whether it warns of numbers in it that look like slips, when it is made. What may stand
    without a unit, as a distribution of sizes over their mean, is told of by what holds it."""

    def __init_subclass__(cls, *, stand_in: bool = False, **kwargs: object) -> None:
        super().__init_subclass__(**kwargs)
        if not stand_in:
            Value._classes[cls.__name__] = cls
            _take_options(cls)
        for name, member in list(vars(cls).items()):
            if not name.startswith("_") and (taker := _taker(member)):
                setattr(cls, name, taker)

    def __post_init__(self) -> None:
        problems: list[str] = []
        owner = type(self).__name__
        for name, about, words in _declarations(type(self)):  # type: ignore[arg-type]
            value = getattr(self, name)
            why, bare = None, type(value) in BARE or isinstance(value, Value)
            if not bare and (fault := masked_words(value) or huge_words(value)):
                problems.append(Problem(name, fault, owner=owner))
                continue
            if not bare and carries_unit(value):
                value, fault = _without_unit(type(self), name, value)
                if fault:
                    problems.append(fault)
                    continue
                object.__setattr__(self, name, value)
            if about:
                if value is None and type(self).__dataclass_fields__[name].default is None:  # type: ignore[attr-defined]
                    continue
                if not (why := problem_with(about, value)):
                    object.__setattr__(self, name, float(value))
            elif words and not (isinstance(value, str) and value in words["options"]):
                why = Mistake.OPTION.clause(
                    f"must be one of {', '.join(map(repr, words['options']))}"
                )
            if why:
                shown = " ".join(repr(value).split())
                shown = shown if len(shown) <= 100 else shown[:96] + " ..."
                problems.append(Problem(name, why, shown, owner=owner))
        if not problems:
            try:
                problems = list(self._problems())
            except FAILURES as error:
                kind = type(self)
                held = {name: getattr(self, name) for name in kind.__dataclass_fields__}  # type: ignore[attr-defined]
                refuse_misfits(error, kind, (), held, where=kind.__name__)
                raise
        if problems:
            raise InvalidValue(*(_problem_of_class(owner, problem) for problem in problems))
        if self._tells_of_slips:
            warn_of_slips(self)

    def _problems(self) -> list[str]:
        """Mistakes that concern several fields at once; subclasses override.

        A `Problem` whose path is a field is told with the name of the class. The classes inside
        have said what is wrong with them.
        """
        return []

    def _cards(self) -> Iterator[Card]:
        """A table for notebooks: symbol, value with unit, and words of every field."""
        yield Card(type(self).__name__, _rows(self))

    def replace(self, **changes: object) -> Self:
        """A copy with some fields changed; dots reach inside: ``**{"diameter.mean": 1e-7}``."""
        now: dict[str, object] = {}
        inner: dict[str, dict[str, object]] = {}
        names = {name for name, _, _ in _declarations(type(self))}  # type: ignore[arg-type]
        for key, value in changes.items():
            head, _, rest = key.partition(".")
            if head not in names:
                raise InvalidValue(_no_field(self, head, names))
            if rest:
                inner.setdefault(head, {})[rest] = value
            else:
                now[head] = value
        before = self.replace_unchecked(**{head: now[head] for head in now if _tells(now[head])})
        with slips_are_told():
            for head, deeper in inner.items():
                where = f"{type(self).__name__}.{head}"
                now[head] = _replace_at(where, now.get(head, getattr(self, head)), deeper)
            out = dataclasses.replace(self, **now)  # type: ignore[type-var]
        if self._tells_of_slips:
            warn_of_slips(out, before=before)
        return out

    def replace_unchecked(self, **changes: object) -> Self:
        """A copy with some fields changed to what needs no check and no warning."""
        out = object.__new__(type(self))
        for item in dataclasses.fields(self):  # type: ignore[arg-type]
            object.__setattr__(out, item.name, changes.get(item.name, getattr(self, item.name)))
        return out

    @names_arguments
    def value_at(self, path: str) -> Any:
        """Value of a dotted name: a field, or an item of a tuple by place or name."""
        where: Any = self
        for step in filter(None, path.split(".")):
            if isinstance(where, tuple):
                where = where[_index(path, list(where), step)]
            elif isinstance(where, Value) and hasattr(where, step):
                where = getattr(where, step)
            else:
                raise InvalidValue(f"{type(self).__name__} has no {path!r}", code=Mistake.UNKNOWN)
        return where

    @names_arguments
    def with_arrays(self, changes: Mapping[str, NDArray[np.float64]]) -> Self:
        """A copy that holds an array (N,) in some of its quantities, one value a state.

        Properties that are plain formulas then give arrays. It is no value: it has no hash and
        equals itself alone, so that no cache takes it. Values are checked against the range
        of their quantity; what concerns several fields at once is left to the caller.

        Parameters
        ----------
        changes : mapping
            Dotted names of quantities and their values.

        Raises
        ------
        InvalidValue
            A name that is no field, or values outside their range.
        NotCompiled
            A field that is not a quantity.
        """
        fields = {item.name: item for item in dataclasses.fields(self)}  # type: ignore[arg-type]
        now: dict[str, object] = {}
        inner: dict[str, dict[str, NDArray[np.float64]]] = {}
        for key, values in changes.items():
            head, _, rest = key.partition(".")
            if head not in fields:
                raise InvalidValue(_no_field(self, head, fields))
            if rest:
                inner.setdefault(head, {})[rest] = values
                continue
            about = fields[head].metadata.get("quantity")
            if about is None:
                raise NotCompiled(f"{type(self).__name__}.{head} is not a quantity")
            for extreme in (float(values.min()), float(values.max())):
                if why := problem_with(about, extreme):
                    owner = type(self).__name__
                    raise InvalidValue(Problem(head, why, repr(extreme), owner=owner))
            now[head] = values
        for head, deeper in inner.items():
            field_value = getattr(self, head)
            if isinstance(field_value, tuple) and all(
                isinstance(element, Value) for element in field_value
            ):
                now[head] = _each_with_arrays(field_value, deeper, f"{type(self).__name__}.{head}")
                continue
            if not isinstance(field_value, Value):
                raise NotCompiled(f"{type(self).__name__}.{head} has no fields of its own")
            now[head] = field_value.with_arrays(deeper)
        out = object.__new__(_stand_in(type(self)))  # type: ignore[arg-type]
        for name in fields:
            object.__setattr__(out, name, now.get(name, getattr(self, name)))
        return out

    def to_dict(self) -> dict[str, Any]:
        """Every field in SI, ready for JSON; ``type`` names the class.

        A field that is declared as "where filled" is left out where it is empty.
        """
        out: dict[str, object] = {"type": type(self).__name__}
        for item in dataclasses.fields(self):  # type: ignore[arg-type]
            value = getattr(self, item.name)
            if "in_dict" not in item.metadata or value:
                out[item.name] = plain_data(value)
        return out

    @staticmethod
    @names_arguments
    def from_dict(data: Mapping[str, object]) -> Any:
        """The inverse of `to_dict`."""
        kind = data.get("type")
        if kind not in Value._classes:
            raise InvalidValue(
                f"type = {kind!r} is not a class of this library", code=Mistake.UNKNOWN
            )
        return Value._classes[kind](**{k: _revive(v) for k, v in data.items() if k != "type"})


def _each_with_arrays(
    parts: tuple[Value, ...], changes: Mapping[str, NDArray[np.float64]], name: str
) -> tuple[object, ...]:
    """Stand-ins of the numbered parts that change, beside the others."""
    changes_by_number: dict[int, dict[str, NDArray[np.float64]]] = {}
    for key, values in changes.items():
        number, _, rest = key.partition(".")
        if not number.isdigit() or int(number) >= len(parts) or not rest:
            raise NotCompiled(f"{name} has no number {number}")
        changes_by_number.setdefault(int(number), {})[rest] = values
    return tuple(
        element.with_arrays(changes_by_number[i]) if i in changes_by_number else element
        for i, element in enumerate(parts)
    )


def _problem_of_class(owner: str, problem: str) -> str:
    """A mistake at a field of a class, with the name of the class."""
    if isinstance(problem, Problem) and problem.path and not problem.owner:
        return problem.changed(owner=owner)
    return problem


def _taker(member: object) -> object:
    """A method that takes quantities with a unit; None for what is no method."""
    if isinstance(member, types.FunctionType):
        return takes_units(member)
    if isinstance(member, (classmethod, staticmethod)):
        return type(member)(takes_units(member.__func__))
    return None


def _no_field(value: Value, name: str, names: Iterable[str]) -> Problem:
    meanings = meanings_of(value)
    hint = guess(name, sorted(names), meanings=meanings, show=repr, otherwise="it has ")
    return Problem(
        "", f"has no field {name!r}", hint=hint, owner=type(value).__name__, code=Mistake.UNKNOWN
    )


def meanings_of(value: Value, prefix: str = "") -> dict[str, str]:
    """What the class of a value declares its numbers and words to be, by their dotted names."""
    return {
        f"{prefix}{name}": about["meaning"]
        for name, *declared in _declarations(type(value))  # type: ignore[arg-type]
        for about in declared
        if about
    }


def paths_of(value: Value, prefix: str = "") -> Iterator[str]:
    """Dotted names of every field of a value and of the values in it, for `Value.part`."""
    for item in dataclasses.fields(value):  # type: ignore[arg-type]
        name, field_value = f"{prefix}{item.name}", getattr(value, item.name)
        yield name
        several = (
            enumerate(field_value) if isinstance(field_value, tuple) else ((None, field_value),)
        )
        for place, element in several:
            if isinstance(element, Value):
                label = getattr(element, "name", "") or place
                yield from paths_of(element, f"{name}." if place is None else f"{name}.{label}.")


def _without_unit(kind: type[Value], name: str, value: object) -> tuple[object, str]:
    """The value of a field in SI where it carries a unit, and why it cannot be."""
    item = kind.__dataclass_fields__[name]  # type: ignore[attr-defined]
    about = item.metadata.get("quantity") or item.metadata.get("several")
    try:
        if about is None:
            raise InvalidValue(
                f"{value} carries a unit, which is not understood here", code=Mistake.UNIT
            )
        if about["unit"] == "K" and "delta_" in str(getattr(value, "units", "")):
            raise InvalidValue(
                f"{value} is a difference of temperatures, but a temperature [K] is needed; give "
                "the temperature itself, in K or degC",
                code=Mistake.KIND,
            )
        return in_si(value, about["unit"]), ""
    except InvalidValue as error:
        return value, error.problems[0].put_at(name, say(value)).changed(owner=kind.__name__)


def items_of(values: Any) -> tuple[object, ...]:
    """The items of what should hold several; of anything else itself, to be refused by name."""
    try:
        return tuple(values)
    except TypeError:
        return (values,)


def sequences(value: Value, *names: str) -> None:
    """Fields of a value that hold several numbers, made tuples of floats in SI.

    Raises
    ------
    InvalidValue
        One is no sequence of numbers, or carries a unit of another dimension.
    """
    problems = []
    for name in names:
        values = getattr(value, name)
        if values is None and type(value).__dataclass_fields__[name].default is None:  # type: ignore[attr-defined]
            continue
        some = values if type(values) in (list, tuple) else ()
        fault = masked_words(values) or next(filter(None, map(huge_words, some)), "")
        if fault:
            fault = Problem(name, fault, owner=type(value).__name__)
        elif carries_unit(values):
            values, fault = _without_unit(type(value), name, values)
        if fault:
            problems.append(fault)
            continue
        try:
            object.__setattr__(value, name, tuple(float(item) for item in values))
        except (TypeError, ValueError, OverflowError):
            rule, owner = "must be a sequence of numbers", type(value).__name__
            problems.append(Problem(name, rule, repr(values), owner=owner, code=Mistake.KIND))
            continue
        unit = type(value).__dataclass_fields__[name].metadata["several"]["unit"]  # type: ignore[attr-defined]
        for i, number in enumerate(getattr(value, name)):
            positive = unit == "m" and number > 0  # a size; the first class may begin at 0
            if math.isfinite(number) and (why := why_extreme(number, unit, positive=positive)):
                owner = type(value).__name__
                problems.append(Problem(f"{name}[{i}]", why, repr(number), owner=owner))
    if problems:
        raise InvalidValue(*problems)


def _rows(value: Value) -> Iterator[Row]:
    """Rows of the fields of a value, with a heading for each value inside."""
    inner: list[tuple[str, Value]] = []
    for item in dataclasses.fields(value):  # type: ignore[arg-type]
        field_value = getattr(value, item.name)
        if held_values := list(_values_in(item.name, field_value)):
            inner += held_values
        elif field_value is None or (isinstance(field_value, (str, tuple)) and not field_value):
            continue
        elif about := item.metadata.get("quantity"):
            yield Row(about["symbol"], [words_of(field_value, about["unit"])], about["meaning"])
        else:
            meaning = item.metadata.get("choice", {}).get("meaning", "")
            yield Row(item.name, [words_of(field_value)], meaning)
    for name, inner_value in inner:
        yield Row(name, [], type(inner_value).__name__)
        yield from (
            row if row.values else row._replace(symbol=f"{name}.{row.symbol}")
            for row in _rows(inner_value)
        )


@cache
def _stand_in(kind: type[Value]) -> type[Any]:
    """A subclass whose fields may hold arrays, without equality or hash: no cache takes it."""
    body = {"__slots__": (), "__eq__": object.__eq__, "__hash__": None}
    name = f"{kind.__name__}OfArrays"
    return types.new_class(name, (kind,), {"stand_in": True}, lambda space: space.update(body))


def _replace_at(where: str, field_value: object, changes: Mapping[str, object]) -> object:
    """A value, or a tuple of them with the number of the one before the dot, with changes."""
    if isinstance(field_value, Value):
        return field_value.replace(**changes)
    if not isinstance(field_value, tuple):
        raise InvalidValue(f"{where} has no fields of its own", code=Mistake.MISSING)
    items = list(field_value)
    inner: dict[int, dict[str, object]] = {}
    for key, value in changes.items():
        which, _, rest = key.partition(".")
        inner.setdefault(_index(where, items, which), {})[rest] = value
    for index, deeper in inner.items():
        items[index] = _replace_at(f"{where}.{index}", items[index], deeper)
    return tuple(items)


def _index(where: str, items: Sequence[object], which: str) -> int:
    """Place of an item by its number or its name."""
    names = [getattr(item, "name", "") for item in items]
    if which.isdecimal() and int(which) < len(items):
        return int(which)
    if which in names:
        return names.index(which)
    choices = ", ".join([*map(str, range(len(items))), *filter(None, names)]) or "none"
    raise InvalidValue(
        f"{where} holds {len(items)} values and no {which!r}; name one by place or name: {choices}",
        code=Mistake.UNKNOWN,
    )


def _revive(value: object) -> object:
    if isinstance(value, dict):
        return Value.from_dict(value)
    if isinstance(value, list):
        return tuple(_revive(item) for item in value)
    return value
