"""What a user is told: keys that are missing, unknown, or misplaced."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from ..quantities.units import say
from .vocabulary import in_words, near

__all__ = ["Known", "retold"]


class Known:
    """The keys that a file may hold, table by table, and the sentences about others."""

    def __init__(self) -> None:
        self.keys: dict[str, dict[str, str]] = {}
        """Known keys of every table met, and what they are."""
        self.variants: dict[str, tuple[str, dict[str, set[str]]]] = {}
        """Tables whose keys depend on a word: that word's key, and the keys of each variant."""
        self.refused: dict[str, Mapping[str, str]] = {}
        """Keys of a table that are known elsewhere and have no sense there: why not."""

    def tell(self, error: ValidationError) -> list[str]:
        """One sentence for each mistake that pydantic found."""
        out: list[str | tuple[str, str]] = []
        found = error.errors()
        guessed: set[tuple[str, str | None]] = set()
        for item in found:
            path, key = _split(item["loc"])
            if item["type"] == "extra_forbidden":
                sentence, meant = self.unknown(path, key, item["input"])
                out.append(sentence)
                guessed.add((path, meant))
            elif item["type"] == "value_error":
                out += item.get("ctx", {})["error"].problems
            elif item["type"] == "missing":
                out.append((path, key))
            else:
                where = _join(path, key)
                out.append(
                    f"{where} = {say(item['input'])} must be a table"
                    + (f", written [{where}]" if "." not in where else " { ... }")
                )
        return [
            item if isinstance(item, str) else self.missing(*item)
            for item in out
            if isinstance(item, str) or item not in guessed
        ]

    def missing(self, path: str, key: str) -> str:
        """The sentence for a key that must stand."""
        about = self.keys.get(path, {}).get(key, "")
        return f"{_join(path, key)} is missing" + (f": {about}" if about else "")

    def unknown(self, path: str, key: str, value: Any) -> tuple[str, str | None]:
        """The sentence for a key that is not known, and the key that was probably meant."""
        known = self.keys.get(path, {})
        if why := self.refused.get(path, {}).get(key):
            return f"{_join(path, key)} = {say(value)} {why}", None
        if not path and _is_table(value):
            meant = near(key, known)
            guess = f"did you mean [{meant}]?" if meant else f"known here: {', '.join(known)}"
            return f"[{key}] is not a known table; {guess}", meant
        start = f"{_join(path, key)} = {say(value)} is not a known key"
        tag, variants = self.variants.get(path, ("", {}))
        homes = [say(name) for name, keys in variants.items() if key in keys]
        if homes:
            return f"{start} here: it goes with {tag} = {' or '.join(homes)}", None
        meant = near(key, known)
        homes = [table for table, keys in self.keys.items() if key in keys and table != path]
        numbered = [table for table in homes if re.fullmatch(rf"{re.escape(path)}\.\d+", table)]
        if numbered:
            several = path.rpartition(".")[2]
            return f"{start}; there are several {several}: did you mean {numbered[0]}.{key}?", None
        if meant is None and len(key) > 2:
            word = key.lower().replace("_", " ")
            meanings = {name: about.partition(", e.g.")[0] for name, about in known.items()}
            meant = next((name for name, text in meanings.items() if word in text.lower()), None)
        if meant is None and homes:
            home = _heading(homes[0])
            return f"{start} here; it belongs to {home}", None
        if meant is not None:
            return f"{start}; did you mean {meant}?", meant
        return f"{start}; known here: {', '.join(known)}", None


def retold(problem: str, name: str, path: str, values: dict[str, Any]) -> str:
    """A sentence of a value class in the words of the file, with the value where it lacks."""
    prefix = f"{path}." if path else ""
    problem = re.sub(rf"^{name}\b(?!\.)", path, problem).replace(f"{name}.", prefix)
    for key, value in values.items():
        start = f"{prefix}{key} must"
        if problem.startswith(start):
            problem = f"{prefix}{key} = {say(value)} must" + problem.removeprefix(start)
    return in_words(problem)


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
