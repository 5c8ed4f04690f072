"""Several values of one quantity: a value, a list, a range, or a range to sample."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ..errors import InvalidValue, Problem
from ..quantities.units import say
from .one_value import One, count, number, word
from .reader import Key, Reader, Ways, plain

__all__ = ["amounts", "is_span"]


def amounts(
    reader: Reader, path: str, about: dict[str, Any], data: Any, *, sampled: bool = False
) -> Any:
    """One value, a list of values, or a range; a range to sample has no ``points``."""
    if reader.every_way:
        every: tuple[Any, ...] = (None, [], {})
        return Ways(tuple(_amounts(reader, path, about, way, sampled=True) for way in every))
    return _amounts(reader, path, about, data, sampled=sampled)


def _amounts(reader: Reader, path: str, about: dict[str, Any], data: Any, *, sampled: bool) -> Any:
    one = number(reader, path, about)
    if isinstance(data, dict):
        return _range(reader, path, about, data, sampled=sampled)
    if not isinstance(data, list):
        return plain(One(lambda value: np.array([one(value)]), one.schema))

    def read(value: list[Any]) -> np.ndarray:
        if not value:
            raise InvalidValue(f"{path} = [] is empty; give at least one value")
        numbers: list[float] = []
        problems: list[str] = []
        for i, item in enumerate(value):
            try:
                numbers.append(number(reader, f"{path}[{i}]", about)(item))
            except InvalidValue as error:
                problems += error.problems
        if problems:
            raise InvalidValue(*problems)
        return np.array(numbers)

    return plain(One(read, {"type": "array", "items": one.schema}))


def _range(
    reader: Reader, path: str, about: dict[str, Any], data: dict[str, Any], *, sampled: bool = False
) -> Any:
    spacings = ("linear", "log") if about["gt"] is None else ("log", "linear")
    ends = f'e.g. {{ from = 5e-7, to = 2.4e-4, points = 200, spacing = "{spacings[0]}" }}'
    ends_of = {end: number(reader, f"{path}.{end}", about) for end in ("from", "to")}
    keys = {
        "from": Key(plain(ends_of["from"]), True, f"the lowest value, {ends}"),
        "to": Key(plain(ends_of["to"]), True, f"the highest value, {ends}"),
        "points": Key(plain(count(f"{path}.points")), not sampled, f"how many values, {ends}"),
        "spacing": Key(plain(word(f"{path}.spacing", spacings)), False, ""),
    }
    log = data.get("spacing", spacings[0]) == "log"
    low, high = (_quietly(ends_of[end], data.get(end)) for end in ("from", "to"))
    wrong = []
    if low >= high:
        wrong.append(
            Problem(
                path,
                f"is an empty range: from = {say(data['from'])} must be below "
                f"to = {say(data['to'])}",
            )
            + ("; exchange them" if low > high else "; for one value write it alone")
        )
    if log and low <= 0:
        wrong.append(
            Problem(
                f"{path}.from",
                f'= {say(data["from"])} must be > 0 with spacing = "log"; use spacing = "linear"',
            )
        )
    reader.problems += wrong

    def build(values: dict[str, Any]) -> Any:
        if wrong:
            return np.empty(0)
        if "points" not in values:
            scale = "log" if log else "linear"
            return {"low": values["from"], "high": values["to"], "scale": scale}
        space = np.geomspace if log else np.linspace
        return space(values["from"], values["to"], values["points"])

    return reader.table(path, keys, build)


def is_span(values: Any) -> bool:
    """Whether this is what a range to sample is read as."""
    return isinstance(values, dict) and set(values) == {"low", "high", "scale"}


def _quietly(read: Callable[[Any], float], value: Any) -> float:
    try:
        return read(value)
    except InvalidValue:
        return math.nan
