"""Mistakes in the keys of a study file: missing, unknown, or misplaced."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from ..errors import InvalidValue, Mistake, Problem, in_study
from ..quantities.nearest import Guess, guess
from ..quantities.units import say
from .fields import declarations
from .vocabulary import nearest_option

__all__ = ["Known", "Missing", "Unknown", "clash", "in_file"]


class Missing(NamedTuple):
    """A key that must stand in a table and does not."""

    path: str
    key: str


class Unknown(NamedTuple):
    """A key that is not known in its table."""

    path: str
    key: str
    value: object


@dataclass
class Known:
    """The keys that a file may hold, table by table, and the sentences about others.

    Parameters
    ----------
    keys : dict
        Known keys of every table met, and what they are.
    variants : dict
        Tables whose keys depend on a word: that word's key, and the class of each variant.
    refused : dict
        Keys of a table that are known elsewhere and have no sense there: why not.
    """

    keys: dict[str, dict[str, str]] = field(default_factory=dict)
    variants: dict[str, tuple[str, Mapping[str, type]]] = field(default_factory=dict)
    refused: dict[str, Mapping[str, str]] = field(default_factory=dict)

    def problems(self, mistakes: Iterable[Problem | Missing | Unknown]) -> list[Problem]:
        """The mistakes with their sentences, misspelt names before what follows from them.

        What a misspelt key means is not missing.
        """
        names: list[Problem] = []
        others: list[Problem | Missing] = []
        guessed = set()
        for mistake in mistakes:
            if isinstance(mistake, Unknown):
                problem, meant = self.unknown(*mistake)
                names.append(problem)
                guessed.add((mistake.path, meant))
            else:
                others.append(mistake)
        left = [mistake for mistake in others if mistake not in guessed]
        return names + [
            mistake if isinstance(mistake, Problem) else self.missing(*mistake) for mistake in left
        ]

    def missing(self, path: str, key: str) -> Problem:
        """A key that must stand and does not."""
        about = self.keys.get(path, {}).get(key, "")
        return Problem(
            _join(path, key), "is missing" + (f": {about}" if about else ""), code=Mistake.MISSING
        )

    def unknown(self, path: str, key: str, value: object) -> tuple[Problem, str | None]:
        """Problem of an unknown key, and the key that was probably meant."""
        keys_here = self.keys.get(path, {})
        place, shown = _join(path, key), say(value)
        if why := self.refused.get(path, {}).get(key):
            return Problem(place, why, shown, code=Mistake.IDLE), None
        if not path and _is_table(value):
            meant = nearest_option(key, keys_here)
            hint = guess(key, keys_here, meant=meant, show="[{}]".format)
            return Problem(
                f"[{key}]", "is not a known table", hint=hint, code=Mistake.UNKNOWN
            ), meant

        def not_known(more: str = "", hint: str = "") -> Problem:
            return Problem(
                place, f"is not a known key{more}", shown, hint=hint, code=Mistake.UNKNOWN
            )

        tag, variants = self.variants.get(path, ("", {}))
        homes = [
            say(name)
            for name, kind in variants.items()
            if key in (item.name for item in declarations(kind))
        ]
        if homes:
            return not_known(f" here: it goes with {tag} = {' or '.join(homes)}"), None
        meant = nearest_option(key, keys_here)
        if path == "sweep" and meant is None and ("." in key or _is_table(value)):
            return not_known(
                hint="inputs that vary stand in a table of their own, [sweep.vary]"
            ), None
        homes = [table for table, keys in self.keys.items() if key in keys and table != path]
        numbered = [table for table in homes if re.fullmatch(rf"{re.escape(path)}\.\d+", table)]
        if numbered:
            several = path.rpartition(".")[2]
            meant = f"{numbered[0]}.{key}"
            return not_known(
                hint=Guess(f"there are several {several}: did you mean {meant}?", meant)
            ), None
        meant = nearest_option(key, keys_here, keys_here)
        if meant is None and homes:
            return not_known(" here", f"it belongs to {_heading(homes[0])}"), None
        return not_known(hint=guess(key, keys_here, meant=meant)), meant


def clash(path: str, data: Mapping[str, object], keys: Sequence[str], rule: str) -> Problem:
    """Keys of a table that cannot stand side by side."""
    others = "".join(f", {path}.{key} = {say(data[key])}" for key in keys[1:])
    return Problem(f"{path}.{keys[0]}", f"{others}: {rule}", say(data[keys[0]]), code=Mistake.CLASH)


def in_file(
    error: InvalidValue, kind: type, path: str, values: Mapping[str, object]
) -> InvalidValue:
    """Problems of a value class at the keys of its table, each with its value."""
    out = []
    for problem in error.problems:
        value, entry = problem.value, values.get(problem.path)
        items = entry if isinstance(entry, (list, tuple)) else (entry,)
        said = value is not None or problem.rule[:1] in ":="
        if not said and all(isinstance(one, (str, float, int)) for one in items):
            value = say(entry)
        owner = path if problem.owner == kind.__name__ else problem.owner
        out.append(problem.changed(owner=owner, value=value).put_in_words(in_study))
    return InvalidValue(*out)


def _heading(table: str) -> str:
    """How a table is headed in the file."""
    if not table:
        return "the top of the file, before the first table"
    name, _, number = table.partition(".")
    return f"[[{name}]]" if number.isdecimal() else f"[{table}]"


def _is_table(value: object) -> bool:
    several = isinstance(value, list) and value and all(isinstance(item, dict) for item in value)
    return isinstance(value, dict) or bool(several)


def _join(path: str, key: str) -> str:
    return f"{path}.{key}" if path and key else path or key
