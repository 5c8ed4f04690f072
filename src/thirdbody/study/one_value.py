"""One value of a study file: a number with a unit, a word, a switch, a list of these."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Protocol

from ..errors import InvalidValue, Problem
from ..quantities.nearest import guess
from ..quantities.units import EXAMPLES, quantity_to_si, say
from ..quantities.value import allowed_range, problem_with, unit_meant
from .mistakes import wrong
from .vocabulary import in_words, near

__all__ = [
    "One",
    "count",
    "number",
    "numbers",
    "refused",
    "switch",
    "text",
    "word",
    "word_or_number",
    "words",
]

MOST_POINTS = 1_000_000
LIMITS = {
    "gt": "exclusiveMinimum",
    "ge": "minimum",
    "lt": "exclusiveMaximum",
    "le": "maximum",
}
"""Limits of a quantity as JSON Schema calls them; of a number, which is in SI, not of text."""


@dataclass(frozen=True)
class One:
    """How one value is read, and what it is in the words of JSON Schema."""

    read: Callable[[Any], Any]
    schema: dict[str, Any] | None
    """None where no value can stand."""

    def __call__(self, value: Any) -> Any:
        return self.read(value)


class Notes(Protocol):
    """Who keeps what is to be said of a file."""

    notes: list[str]


class Unsaid:
    """Notes that nobody reads."""

    def __init__(self) -> None:
        self.notes: list[str] = []


def plain_number(unit: str) -> dict[str, Any]:
    """A quantity of which nothing is known but its unit."""
    limits: dict[str, Any] = dict.fromkeys(("gt", "ge", "lt", "le"))
    return limits | {"symbol": "", "unit": unit, "meaning": "number", "hint": ""}


def number(reader: Notes, path: str, about: dict[str, Any]) -> One:
    """A number in SI inside the range of its quantity; text has a unit."""

    def read(value: Any) -> float:
        try:
            found = quantity_to_si(value, about)
        except InvalidValue as error:
            elsewhere = "; a load in Pa goes under the key pressure"
            cause = elsewhere if path.startswith("load.F_star") and "Pa" in str(value) else ""
            raise InvalidValue(Problem(path, f"= {error}{cause}")) from None
        if not math.isfinite(found):
            allowed = allowed_range(about).removeprefix("must be ")
            allowed = "" if allowed.startswith("a finite") else f"; it must be {allowed}"
            raise wrong(path, f"is not a finite number{allowed}", value)
        if why := problem_with(about, found):
            meant = "" if about["hint"] else f"; it is the {about['meaning']}"
            raise wrong(path, in_words(why) + meant, value)
        _plausible(reader, path, about, value, found)
        return found

    limits = {word: about[key] for key, word in LIMITS.items() if about[key] is not None}
    return One(read, {"type": ["number", "string"]} | limits)


def _plausible(reader: Notes, path: str, about: dict[str, Any], value: Any, number: float) -> None:
    """Refuse a number without a unit that no interface has; note one with a unit."""
    unit = about["unit"]
    load = path.startswith(("load.pressure", "sweep.pressure", "design.pressure"))
    if (meant := unit_meant(about, number, load=load)) is None:
        return
    if has_unit(value):
        reader.notes.append(
            f"{path} = {say(value)} is taken as {number:g} {unit}: check its unit (upper and lower "
            "case matter)"
        )
        return
    rule = f"has no unit, so it would be {number:g} {unit}, which is not plausible"
    any_value = f'With its unit any value is taken: "{number:g} {unit}"'
    raise wrong(path, rule, value, hint=f'was "{number:g} {meant}" meant? {any_value}')


def has_unit(value: Any) -> bool:
    """Whether a value of a file says its unit."""
    if not isinstance(value, str):
        return not isinstance(value, (int, float))  # a quantity of a library of units
    return re.fullmatch(r"[\d\s.+-]*([eE][+-]?\d+)?\s*", value) is None


def count(path: str, *, least: int = 1, most: int = MOST_POINTS) -> One:
    """A whole number."""

    def read(value: Any) -> int:
        whole = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not (whole and value == value // 1 and least <= value <= most):
            raise wrong(path, f"must be a whole number from {least} to {most}", value)
        return int(value)

    return One(read, {"type": "integer", "minimum": least, "maximum": most})


def word(path: str, options: Iterable[str]) -> One:
    """One of a few words."""

    def read(value: Any) -> str:
        if isinstance(value, str) and value in options:
            return value
        rule = f"must be one of {', '.join(map(say, options))}"
        raise wrong(
            path,
            rule,
            value,
            hint=guess(
                str(value), options, meant=near(str(value), options), show=say, otherwise=None
            ),
        )

    return One(read, {"enum": list(options)})


def words(path: str, options: Iterable[str] | None) -> One:
    """One word or a list of words."""

    def read(value: Any) -> list[str]:
        values = value if isinstance(value, list) else [value]
        if options is not None:
            return [word(path, options)(item) for item in values]
        if not all(isinstance(item, str) for item in values):
            raise wrong(path, "must be a list of names in quotes", value)
        return values

    one = {"type": "string"} if options is None else {"enum": list(options)}
    return One(read, {"anyOf": [one, {"type": "array", "items": one}]})


def word_or_number(path: str) -> One:
    """A word or a pure number; which ones, the object it is for knows."""

    def read(value: Any) -> str | float:
        if isinstance(value, str) or (
            isinstance(value, (int, float)) and not isinstance(value, bool)
        ):
            return value
        raise wrong(path, "must be a word in quotes or a number", value)

    return One(read, {"type": ["number", "string"]})


def text(path: str) -> One:
    """Text in quotes."""

    def read(value: Any) -> str:
        if isinstance(value, str):
            return value
        raise wrong(path, f'must be text in quotes, e.g. "{value}"', value)

    return One(read, {"type": "string"})


def switch(path: str) -> One:
    """True or false."""

    def read(value: Any) -> bool:
        if isinstance(value, bool):
            return value
        raise wrong(path, "must be true or false, without quotes", value)

    return One(read, {"type": "boolean"})


def numbers(path: str, unit: str, *, usual: float | None = None) -> One:
    """A list of numbers; the class of the table checks their range.

    Lengths up to ``usual`` are no slip: infinity where numbers without a unit may be in any unit.
    """

    def read(value: Any) -> tuple[float, ...]:
        if not isinstance(value, list):
            raise wrong(path, f"must be a list, e.g. [{EXAMPLES[unit]}, ...]", value)
        out: list[float] = []
        problems: list[str] = []
        for i, item in enumerate(value):
            try:
                about = plain_number(unit) | {"usual": usual}
                out.append(number(Unsaid(), f"{path}[{i}]", about)(item))
            except InvalidValue as error:
                problems += error.problems
        if problems:
            raise InvalidValue(*problems)
        return tuple(out)

    return One(read, {"type": "array", "items": {"type": ["number", "string"]}})


def refused(path: str, why: str) -> One:
    """A key that is known and has no place here."""

    def read(value: Any) -> Any:
        raise wrong(path, why, value)

    return One(read, None)
