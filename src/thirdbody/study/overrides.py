"""Keys set on the command line: --set particles.mean="500 nm"."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..errors import InvalidValue
from ..quantities.units import say
from .reader import rivals
from .toml import value_of

__all__ = ["override"]


def override(data: dict[str, Any], overrides: Iterable[str]) -> dict[str, Any]:
    """The data with keys set; one of several exclusive keys drives out the others.

    Tables of one name, ``[[particles]]``, and items of a list are numbered from 0:
    ``particles.0.mean``.
    """
    problems = []
    for text in overrides:
        path, equals, value = text.partition("=")
        keys = [key.strip() for key in path.split(".")]
        if not equals or not all(keys):
            problems.append(f'--set {text!r} must be KEY=VALUE, e.g. --set particles.mean="500 nm"')
            continue
        try:
            _set(data, keys, value_of(value))
        except InvalidValue as error:
            problems += [f"--set {text}: {problem}" for problem in error.problems]
    if problems:
        raise InvalidValue(*problems)
    return data


def _set(data: dict[str, Any], keys: list[str], value: Any) -> None:
    table: Any = data
    for depth, key in enumerate(keys):
        where = ".".join(keys[:depth])
        place = _place(table, where, key, keys[depth + 1 :])
        if depth == len(keys) - 1:
            for other in rivals(where, key):
                table.pop(other, None)
            table[place] = value
        elif isinstance(table, list):
            table = table[place]
        else:
            table = table.setdefault(place, {})


def _place(table: Any, where: str, key: str, rest: list[str]) -> Any:
    """The key of a table, or the number of an item of a list."""
    if isinstance(table, list):
        if key.isdecimal() and int(key) < len(table):
            return int(key)
        example = ".".join([where, "0", *rest] if key.isdecimal() else [where, "0", key, *rest])
        numbers = f"numbered 0 to {len(table) - 1}" if len(table) > 1 else "numbered 0"
        raise InvalidValue(
            f"{where} is a list of {len(table)}, {numbers}; name one of them, e.g. {example}"
            if table
            else f"{where} is an empty list"
        )
    if not isinstance(table, dict):
        raise InvalidValue(
            f"{where} = {say(table)} is not a table, so {key} cannot be "
            f"set in it; set {where} as a whole, e.g. --set '{where}={{ ... }}'"
        )
    if where == "particles" and key.isdecimal() and table:
        raise InvalidValue(
            f"there is one table [particles], which has no number; name {'.'.join([where, *rest])}"
        )
    return key
