"""Mistakes in the keys of a study file: missing, unknown, or misplaced."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import ValidationError

from ..errors import InvalidValue, Problem
from ..quantities.nearest import guess
from ..quantities.units import say
from .vocabulary import in_words, near

__all__ = ["Known", "clash", "in_file", "wrong"]


class Known:
    """The keys that a file may hold, table by table, and the sentences about others."""

    def __init__(self) -> None:
        self.keys: dict[str, dict[str, str]] = {}
        """Known keys of every table met, and what they are."""
        self.variants: dict[str, tuple[str, dict[str, set[str]]]] = {}
        """Tables whose keys depend on a word: that word's key, and the keys of each variant."""
        self.refused: dict[str, Mapping[str, str]] = {}
        """Keys of a table that are known elsewhere and have no sense there: why not."""

    def problems(self, error: ValidationError) -> list[Problem]:
        """Every mistake that pydantic found, at its place in the file."""
        out: list[Problem | tuple[str, str]] = []
        found = error.errors()
        guessed: set[tuple[str, str | None]] = set()
        for item in found:
            path, key = _split(item["loc"])
            if item["type"] == "extra_forbidden":
                problem, meant = self.unknown(path, key, item["input"])
                out.append(problem)
                guessed.add((path, meant))
            elif item["type"] == "value_error":
                told = item.get("ctx", {})["error"].problems
                out += [Problem.from_sentence(_join(path, key), each) for each in told]
            elif item["type"] == "missing":
                out.append((path, key))
            else:
                where = _join(path, key)
                written = f", written [{where}]" if "." not in where else " { ... }"
                out.append(Problem(where, f"must be a table{written}", say(item["input"])))
        return [
            item if isinstance(item, Problem) else self.missing(*item)
            for item in out
            if isinstance(item, Problem) or item not in guessed
        ]

    def missing(self, path: str, key: str) -> Problem:
        """A key that must stand and does not."""
        about = self.keys.get(path, {}).get(key, "")
        return Problem(_join(path, key), "is missing" + (f": {about}" if about else ""))

    def unknown(self, path: str, key: str, value: Any) -> tuple[Problem, str | None]:
        """A key that is not known, and the key that was probably meant."""
        known = self.keys.get(path, {})
        place, shown = _join(path, key), say(value)
        if why := self.refused.get(path, {}).get(key):
            return Problem(place, why, shown), None
        if not path and _is_table(value):
            meant = near(key, known)
            hint = guess(key, known, meant=meant, show="[{}]".format)
            return Problem(f"[{key}]", "is not a known table", hint=hint), meant

        def not_known(more: str = "", hint: str = "") -> Problem:
            return Problem(place, f"is not a known key{more}", shown, hint=hint)

        tag, variants = self.variants.get(path, ("", {}))
        homes = [say(name) for name, keys in variants.items() if key in keys]
        if homes:
            return not_known(f" here: it goes with {tag} = {' or '.join(homes)}"), None
        meant = near(key, known)
        homes = [table for table, keys in self.keys.items() if key in keys and table != path]
        numbered = [table for table in homes if re.fullmatch(rf"{re.escape(path)}\.\d+", table)]
        if numbered:
            several = path.rpartition(".")[2]
            hint = f"there are several {several}: did you mean {numbered[0]}.{key}?"
            return not_known(hint=hint), None
        if meant is None and len(key) > 2:
            word = key.lower().replace("_", " ")
            meanings = {name: about.partition(", e.g.")[0] for name, about in known.items()}
            meant = next((name for name, text in meanings.items() if word in text.lower()), None)
        if meant is None and homes:
            return not_known(" here", f"it belongs to {_heading(homes[0])}"), None
        return not_known(hint=guess(key, known, meant=meant)), meant


def wrong(path: str, rule: str, value: Any, *, hint: str = "") -> InvalidValue:
    """The error of one value of a file."""
    return InvalidValue(Problem(path, rule, say(value), hint=hint))


def clash(path: str, data: Mapping[str, Any], keys: Sequence[str], rule: str) -> Problem:
    """Keys of a table that cannot stand side by side."""
    shown = ", ".join(f"{path}.{key} = {say(data[key])}" for key in keys)
    return Problem.from_sentence(f"{path}.{keys[0]}", f"{shown}: {rule}")


def in_file(error: InvalidValue, kind: type, path: str, values: Mapping[str, Any]) -> InvalidValue:
    """Mistakes of a value class at the keys of its table, with the value where it is not said."""
    out = []
    for each in error.problems:
        value, entry = each.value, values.get(each.path)
        items = entry if isinstance(entry, (list, tuple)) else (entry,)
        said = value is not None or each.rule[:1] in ":="
        if not said and all(isinstance(one, (str, float, int)) for one in items):
            value = say(entry)
        owner = path if each.owner == kind.__name__ else each.owner
        out.append(each.changed(owner=owner, value=value).worded(in_words))
    return InvalidValue(*out)


def _heading(table: str) -> str:
    """How a table is headed in the file."""
    if not table:
        return "the top of the file, before the first table"
    name, _, number = table.partition(".")
    return f"[[{name}]]" if number.isdecimal() else f"[{table}]"


def _is_table(value: Any) -> bool:
    several = isinstance(value, list) and value and all(isinstance(item, dict) for item in value)
    return isinstance(value, dict) or bool(several)


def _join(path: str, key: str) -> str:
    return f"{path}.{key}" if path and key else path or key


def _split(loc: tuple[Any, ...]) -> tuple[str, str]:
    """Path of the table and the key.

    Tables headed ``[[name]]`` are numbered as for --set, ``name.0``; positions in a list stand in
    brackets.
    """
    parts: list[str] = []
    for item in loc:
        if isinstance(item, int):
            parts[-1] += f".{item}" if len(parts) == 1 else f"[{item}]"
        else:
            parts.append(str(item))
    return ".".join(parts[:-1]), parts[-1] if parts else ""
