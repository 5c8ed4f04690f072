"""Study files as text: written from tables, and with the keys that the command line sets."""

from __future__ import annotations

import json
import math
import re
import tomllib
from collections.abc import Iterable

from .toml import override, value_of

__all__ = ["text_with", "to_toml", "toml_value"]

HEAD = re.compile(r"^\s*(\[\[?)\s*([\w.-]+)\s*\]\]?\s*(#.*)?$")
"""The head of a table, and of one of several."""


def to_toml(study: dict[str, object]) -> str:
    """The study as a file: `tomllib.loads` gives it back.

    >>> print(to_toml({"title": "t", "load": {"pressure": "5 MPa"}}), end="")
    title = "t"
    <BLANKLINE>
    [load]
    pressure = "5 MPa"
    """
    lines: list[str] = []
    _table(study, (), lines)
    return "\n".join(lines).lstrip("\n") + "\n"


def _table(table: dict[str, object], path: tuple[str, ...], lines: list[str]) -> None:
    """Plain keys first, tables under their headings after them."""
    inner: dict[str, object] = {}
    for key, value in table.items():
        heads = isinstance(value, dict) and (len(path) < 1 or _deep(path, key))
        several = isinstance(value, list) and value and all(isinstance(x, dict) for x in value)
        if heads or (several and not path):
            inner[key] = value
        else:
            lines.append(f"{_key(key)} = {toml_value(value)}")
    for key, value in inner.items():
        name = ".".join(map(_key, (*path, key)))
        for inner_table in value if isinstance(value, list) else [value]:
            lines += ["", f"[[{name}]]" if isinstance(value, list) else f"[{name}]"]
            assert isinstance(inner_table, dict)
            _table(inner_table, (*path, key), lines)


def _deep(path: tuple[str, ...], key: str) -> bool:
    """Tables inside tables that are written under a heading of their own."""
    return path == ("outputs",) or (*path, key) in (("uncertainty", "inputs"), ("sweep", "vary"))


def _key(key: str) -> str:
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else toml_value(key)


def toml_value(value: object) -> str:
    """One value as in TOML."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, float) and not math.isfinite(value):
        return "nan" if math.isnan(value) else "inf" if value > 0 else "-inf"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(k)} = {toml_value(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    return repr(value)


# -------------------------------------------------------------------------- keys over a text
def text_with(text: str, settings: Iterable[str]) -> str:
    """The text of a study file with keys set in it, as ``--set`` sets them over it.

    What a person wrote stays where it can, comments too; else the tables are written anew.

    >>> file = '[load]      # on the ring\\nforce = "1 kN"  # radial\\n'
    >>> print(text_with(file, ["load.force=2 kN"]))
    [load]      # on the ring
    force = "2 kN"  # radial
    <BLANKLINE>
    """
    for setting in settings:
        wanted = override(tomllib.loads(text), [setting])
        path, _, value = setting.partition("=")
        keys = [key.strip() for key in path.split(".")]
        edited = _edit_line(text, keys, toml_value(value_of(value)))
        text = edited if _holds(edited, wanted) else to_toml(wanted)
    return text


def _holds(text: str, wanted: dict[str, object]) -> bool:
    """Whether a text says just this."""
    try:
        return tomllib.loads(text) == wanted
    except tomllib.TOMLDecodeError:
        return False


def _edit_line(text: str, keys: list[str], value: str) -> str:
    """The text with one line changed, or added to its table, or with a table more at the end."""
    lines = text.splitlines()
    *table, key = keys
    start, end = _lines_of(lines, table)
    if start is None:
        head = ["", f"[{'.'.join(table)}]"] if table else []
        return "\n".join([*lines, *head, f"{key} = {value}"]) + "\n"
    for i in range(start, end):
        name, equals, rest = lines[i].partition("=")
        if equals and name.strip() == key:
            comment = re.search(r"\s+#[^\"']*$", rest)
            lines[i] = f"{name}= {value}{comment[0] if comment else ''}"
            return "\n".join(lines) + "\n"
    while end > start and not lines[end - 1].split("#")[0].strip():
        end -= 1
    lines.insert(end, f"{key} = {value}")
    return "\n".join(lines) + "\n"


def _lines_of(lines: list[str], table: list[str]) -> tuple[int | None, int]:
    """The first line of a table below its head, and that after its last; None without a head."""
    number = int(table[-1]) if table and table[-1].isdecimal() else None
    name = ".".join(table if number is None else table[:-1])
    heads = [(i, match[2]) for i, line in enumerate(lines) if (match := HEAD.match(line))]
    starts = [(-1, ""), *heads]
    same = [place for place, (_, head) in enumerate(starts) if head == name]
    if (number or 0) >= len(same):
        return None, 0
    place = same[number or 0]
    after = starts[place + 1][0] if place + 1 < len(starts) else len(lines)
    return starts[place][0] + 1, after
