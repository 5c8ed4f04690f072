"""How large a study may be that the page takes: beyond, the command line is the place."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from ..errors import InvalidValue, Mistake

__all__ = [
    "LARGEST_TABLE",
    "MOST_DRAWN",
    "MOST_NUMBERS",
    "MOST_POINTS",
    "refuse_large",
    "refuse_large_files",
    "refuse_long_names",
]

MOST_DRAWN = 400
"""Loads that a curve is drawn with."""
MOST_POINTS = 2000
"""Values of one range."""
MOST_NUMBERS = 2000
MOST_ITEMS = {"numbers": MOST_NUMBERS, "tables": 12, "keys": 100}
"""Of one list, or of one table."""
MOST_ENTRIES = 8000
"""In all."""
DEEPEST = 12
"""Tables inside one another."""
LONGEST_TEXT, LONGEST_KEY = 1000, 200
"""Characters of one value, of one key."""
MOST_SAMPLES = 2**20
LARGEST_TABLE = 200_000
"""Bytes of a file of materials or of sizes."""
MOST_DOTS = 100
"""In one name: the time to read a name of many parts grows with their square."""
MOST_SAID = 8
LIMITS = {"points": MOST_POINTS, "samples": MOST_SAMPLES}
END = "the page takes at most {most}; for more use the command line"


def refuse_large(study: dict[str, object]) -> None:
    """Refuse a study that would take long to draw.

    Raises
    ------
    InvalidValue
        One sentence for each entry that is too large, up to a few.

    Examples
    --------
    >>> refuse_large({"load": {"F_star": {"from": 1e-7, "to": 1e-4, "points": 1000000}}})
    Traceback (most recent call last):
    thirdbody.errors.InvalidValue: load.F_star.points = 1000000: the page takes at most 2000; ...
    """
    problems = []
    for problem in _problems(study):
        problems.append(problem)
        if len(problems) == MOST_SAID:
            break
    if problems:
        raise InvalidValue(*problems, code=Mistake.TOO_LARGE)


def _problems(study: dict[str, object]) -> Iterator[str]:
    waiting: list[tuple[str, int, object]] = [("", 0, study)]
    entries = 0
    while waiting:
        where, depth, value = waiting.pop()
        entries += 1
        if entries > MOST_ENTRIES:
            yield f"the study has more than {MOST_ENTRIES} entries: " + END.format(
                most=MOST_ENTRIES
            )
            return
        if depth > DEEPEST:
            yield f"{_short(where)} lies in more than {DEEPEST} tables: " + END.format(most=DEEPEST)
            return
        if isinstance(value, dict):
            if len(value) > MOST_ITEMS["keys"]:
                yield _too_many(where, len(value), "keys")
                continue
            for key in reversed(value):
                name = f"{where}.{key}" if where else key
                if len(key) > LONGEST_KEY:
                    yield f"{_short(name)}: a name of {len(key)} characters; " + END.format(
                        most=LONGEST_KEY
                    )
                elif (most := LIMITS.get(key)) and _number(value[key]) > most:
                    yield f"{name} = {str(value[key])[:30]}: " + END.format(most=most)
                else:
                    waiting.append((name, depth + 1, value[key]))
        elif isinstance(value, list):
            kind = "tables" if any(isinstance(x, (dict, list)) for x in value) else "numbers"
            if len(value) > MOST_ITEMS[kind]:
                yield _too_many(where, len(value), kind)
                continue
            waiting += [(f"{where}[{i}]", depth + 1, x) for i, x in enumerate(value)][::-1]
        elif isinstance(value, str) and len(value) > LONGEST_TEXT:
            yield f"{where}: a text of {len(value)} characters; " + END.format(most=LONGEST_TEXT)
        elif isinstance(value, int) and abs(value) > 10**300:
            yield f"{where}: a number of more than 300 digits is none that the page takes"


def _too_many(where: str, count: int, kind: str) -> str:
    named = where or "the study"
    return f"{_short(named)} has {count} entries: " + END.format(most=MOST_ITEMS[kind])


def _short(where: str) -> str:
    return where if len(where) <= 60 else f"{where[:57]}..."


def _number(value: object) -> float:
    return value if isinstance(value, (int, float)) else 0.0


def refuse_large_files(folder: Path, names: list[str]) -> None:
    """Refuse files of materials or of sizes that take long to read."""
    wrong = []
    for name in dict.fromkeys(names):
        file = folder / name
        if file.is_file() and file.stat().st_size > LARGEST_TABLE:
            wrong.append(
                f'"{name}" has {file.stat().st_size} bytes: ' + END.format(most=LARGEST_TABLE)
            )
    if wrong:
        raise InvalidValue(*wrong, code=Mistake.TOO_LARGE)


def refuse_long_names(text: str) -> None:
    """Refuse what only takes long to parse: a name of very many parts."""
    for run in re.findall(r"[^=,\n\[\]{}]+", text):
        if run.count(".") > MOST_DOTS:
            raise InvalidValue(
                f"this is not a study file: a name of more than {MOST_DOTS} parts, {run[:30]}...",
                code=Mistake.FORM,
            )
