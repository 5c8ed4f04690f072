"""The text of a study file as tables, with the keys that the command line sets (--set)."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ..errors import InvalidValue, Mistake, Problem
from ..quantities.files import read_bytes
from ..quantities.nearest import guess, nearest_word
from ..quantities.say import join_words
from ..quantities.units import say
from .other_files import problem_of_other_file
from .reader import rivals

__all__ = ["heading_of", "override", "read", "setting_in_words", "value_of"]


def read(path: Path) -> dict[str, object]:
    """The tables of a file; InvalidValue says why it cannot be read, with the line."""
    try:
        return _read(path)
    except InvalidValue as error:
        raise error.name_source(path) from None


def _read(path: Path) -> dict[str, object]:
    try:
        content = read_bytes(path, "a study file")
        if problem := problem_of_other_file(path, content):
            raise InvalidValue(problem)
        text = content.decode("utf-8-sig")
    except FileNotFoundError:
        meant = nearest_word(path.name, [p.name for p in _toml_files(path)], cutoff=0.75)
        hint = guess("", (), meant=str(path.with_name(meant))) if meant else ""
        rule = f"cannot read {path}: there is no such file"
        raise InvalidValue(Problem("", rule, hint=hint, code=Mistake.UNREADABLE)) from None
    except IsADirectoryError:
        raise InvalidValue(
            f"cannot read {path}: it is a folder, not a study file", code=Mistake.UNREADABLE
        ) from None
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        raise InvalidValue(
            f"cannot read {path}: line {line} is not UTF-8 text; save the file as UTF-8, "
            "or write um instead of µm",
            code=Mistake.UNREADABLE,
        ) from None
    except InvalidValue:
        raise
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise InvalidValue(f"cannot read {path}: {why.lower()}", code=Mistake.UNREADABLE) from None
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InvalidValue(_syntax(path, text, str(error)), code=Mistake.FORM) from None
    except RecursionError:
        raise InvalidValue(
            f"{path} is nested too deeply to be a study file", code=Mistake.UNREADABLE
        ) from None


def value_of(text: str) -> Any:
    """A value as in TOML; text that is not TOML counts as a string."""
    try:
        parsed = tomllib.loads(f"value = {text}")
    except (tomllib.TOMLDecodeError, RecursionError):
        return text.strip()
    return parsed["value"] if set(parsed) == {"value"} else text.strip()


def _toml_files(path: Path) -> list[Path]:
    try:
        return list(path.parent.glob("*.toml"))
    except OSError:
        return []


CLOSED = re.compile(r'"(?:\\.|[^"\\])*"|\'[^\']*\'')
"""A string of TOML on one line."""


def _closed_line(line: str) -> str:
    """A line with the quote that it lacks; "" where it lacks none, or may go on below.

    >>> _closed_line('median = "300 nm   # a size'), _closed_line('median = "300 nm" # its "size')
    ('median = "300 nm"', '')
    """
    bare = CLOSED.sub("", line).partition("#")[0]
    if not re.search("[\"']", bare) or re.search("\"{3}|'{3}", line):
        return ""
    key, equals, value = line.partition("#")[0].strip().partition("=")
    alone = value.strip().strip("\"'")
    return f'{key}{equals} "{alone}"' if equals and not re.search("[\"']", alone) else line.strip()


def _syntax(path: Path, text: str, message: str) -> str:
    """A TOML syntax error with its line and the likely cause."""
    where = re.search(r" \(at (?:line (\d+), column (\d+)|end of document)\)", message)
    lines = text.splitlines() or [""]
    number = int(where[1]) if where and where[1] else len(lines)
    what = message[: where.start()] if where else message
    for i, text_of_line in enumerate(lines[:number], start=1):
        if (meant := _closed_line(text_of_line)) and (
            i == number or "'\\n'" in what or '"\'"' in what
        ):
            lone = text_of_line.strip()
            hint = "a quote is probably missing" + (f": {meant}" if meant != lone else "")
            return f"{path}, line {i}: a string has no end, in: {lone}; {hint}"
    line = lines[min(number, len(lines)) - 1].split("#")[0].strip()
    if twice := re.fullmatch(r"Cannot declare \((.+?),?\) twice", what):
        table = twice[1].replace("'", "").replace(", ", ".")
        return f"{path}, line {number}: the table [{table}] stands twice; keep one of the two"
    out = f"{path}, line {number}: {what[:1].lower()}{what[1:]}, in: {line}"
    key, equals, value = (piece.strip() for piece in line.partition("="))
    if "overwrite" in what:
        return f"{out}; {key} is given twice"
    if equals and re.fullmatch(r"[+-]?[\d.,]+(?:[eE][+-]?\d+)?\s*[^\d\s,.\]}].*", value):
        return f'{out}; a value with a unit stands in quotes: {key} = "{value}"'
    if equals and re.fullmatch(r"[A-Za-zµ][\w .-]*", value):
        return f'{out}; words stand in quotes: {key} = "{value}"'
    if equals and re.fullmatch(r"[+-]?(\d+,\d+|\.\d+.*|\d+\.)", value):
        return f"{out}; numbers have a decimal point between digits: 2.8, 0.4, 5.0"
    return out


# -------------------------------------------------------------------------- keys set over a file
def override(data: dict[str, object], overrides: Iterable[str]) -> dict[str, object]:
    """The data with keys set; one of several exclusive keys drives out the others.

    Tables of one name, ``[[particles]]``, and items of a list are numbered from 0:
    ``particles.0.mean``.
    """
    problems = []
    for text in overrides:
        path, equals, value = text.partition("=")
        keys = [key.strip() for key in path.split(".")]
        if not equals or not all(keys):
            rule = 'must be KEY=VALUE, e.g. --set roughness.sigma="80 nm"'
            problems.append(Problem("--set", rule, repr(text), code=Mistake.FORM))
            continue
        try:
            _set(data, keys, value_of(value))
        except InvalidValue as error:
            problems += [problem.put_at("--set", text, sign=":") for problem in error.problems]
    if problems:
        raise InvalidValue(*problems)
    return data


def setting_in_words(text: str) -> str:
    """A key that is set, as a heading tells it.

    >>> setting_in_words('particles.mean="500 nm"'), setting_in_words("film.speed=1")
    ('particles.mean = 500 nm', 'film.speed = 1')
    """
    key, _, value = text.partition("=")
    parsed = value_of(value)
    shown = parsed if isinstance(parsed, str) else value.strip()
    return " ".join(f"{key.strip()} = {shown}".split())


def heading_of(title: str, settings: Iterable[str]) -> str:
    """A title, and the keys that were set over its file, which it may not know of.

    >>> heading_of("Bearing under 1 kN", ["load.force = 2 kN"])
    'Bearing under 1 kN, with load.force = 2 kN'
    """
    changes = join_words(list(settings))
    return f"{title}, with {changes}" if changes else title


def _set(data: dict[str, object], keys: list[str], value: object) -> None:
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


def _place(table: object, where: str, key: str, rest: list[str]) -> Any:
    """The key of a table, or the number of an item of a list."""
    if isinstance(table, list):
        if key.isdecimal() and int(key) < len(table):
            return int(key)
        example = ".".join([where, "0", *rest] if key.isdecimal() else [where, "0", key, *rest])
        numbers = f"numbered 0 to {len(table) - 1}" if len(table) > 1 else "numbered 0"
        raise InvalidValue(
            f"{where} is a list of {len(table)}, {numbers}; name one of them, e.g. {example}"
            if table
            else f"{where} is an empty list",
            code=Mistake.SHAPE,
        )
    if not isinstance(table, dict):
        raise InvalidValue(
            f"{where} = {say(table)} is not a table, so {key} cannot be "
            f"set in it; set {where} as a whole, e.g. --set '{where}={{ ... }}'",
            code=Mistake.KIND,
        )
    if where == "particles" and key.isdecimal() and table:
        raise InvalidValue(
            f"there is one table [particles], which has no number; name {'.'.join([where, *rest])}",
            code=Mistake.UNKNOWN,
        )
    return key
