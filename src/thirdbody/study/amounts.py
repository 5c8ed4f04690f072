"""Several values of one quantity: a value, a list, a range, or a range to sample."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from ..errors import InvalidValue, Problem
from ..quantities.units import say
from .fields import about_of
from .reader import Key, Reader, Unsaid, count, get, number, read_number, read_numbers, word

__all__ = ["amounts", "is_span"]


def amounts(name: str, about: dict[str, Any], *, sampled: bool = False) -> Key:
    """The key of one value, a list of values, or a range; one to sample has no ``points``."""
    one = number(about).schema
    schema = {"anyOf": [one, {"type": "array", "items": one}]}
    table = partial(_range, about, sampled)
    return Key(partial(_read, about), False, about_of(name, about), schema, table)


def _read(about: dict[str, Any], reader: Reader, path: str, value: Any) -> np.ndarray:
    if not isinstance(value, list):
        return np.array([read_number(about, reader, path, value)])
    if not value:
        raise InvalidValue(Problem(path, "is empty; give at least one value", "[]"))
    return np.array(read_numbers(about, reader, path, value))


def _range(about: dict[str, Any], sampled: bool, reader: Reader, path: str, data: Any) -> Any:
    spacings = ("linear", "log") if about["gt"] is None else ("log", "linear")
    example = f'e.g. {{ from = 5e-7, to = 2.4e-4, points = 200, spacing = "{spacings[0]}" }}'
    end, points = number(about)._replace(required=True), count(f"how many values, {example}")
    keys = {
        "from": end._replace(about=f"the lowest value, {example}"),
        "to": end._replace(about=f"the highest value, {example}"),
        "points": points._replace(required=not (sampled or reader.every_way)),
        "spacing": word(spacings),
    }

    log = get(data, "spacing") in ((None, "log") if spacings[0] == "log" else ("log",))
    problems = _problems_of_ends(about, path, data, log)
    reader.mistakes += problems

    def build(values: dict[str, Any]) -> Any:
        low, high = values["from"], values["to"]
        if problems:
            raise InvalidValue
        if "points" not in values:
            return {"low": low, "high": high, "scale": "log" if log else "linear"}
        space = np.geomspace if log else np.linspace
        return space(low, high, values["points"])

    return reader.table(path, data, keys, build)


def _problems_of_ends(about: dict[str, Any], path: str, data: Any, log: bool) -> list[Problem]:
    """Problems of the two ends of a range together."""
    try:
        low, high = (read_number(about, Unsaid(), path, data[end]) for end in ("from", "to"))
    except (InvalidValue, LookupError, TypeError):
        return []
    problems = []
    if low >= high:
        ends = f"from = {say(data['from'])} must be below to = {say(data['to'])}"
        hint = "exchange them" if low > high else "for one value write it alone"
        problems.append(Problem(path, f"is an empty range: {ends}", hint=hint))
    if log and low <= 0:
        rule, hint = 'must be > 0 with spacing = "log"', 'use spacing = "linear"'
        problems.append(Problem(f"{path}.from", rule, say(data["from"]), hint=hint))
    return problems


def is_span(values: Any) -> bool:
    """Whether this is what a range to sample is read as."""
    return isinstance(values, dict) and set(values) == {"low", "high", "scale"}
