"""Regular expressions of numbers with a unit, for JSON Schema: what `units.to_si` may read."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache

from .kinds import USUAL, registry

__all__ = ["HARDNESS_TEXT", "name_of_unit", "pattern_of_unit"]

NUMBER = r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,3})?(?![\d.])"
SIGN = r"[*/·×]"
SIMPLE = ("m", "s", "K", "A", "kg", "rad", "1")
"""Units of which nobody writes a product of others."""
POWERS = (1, 2, 3, -1, -2, -3)
RAISED = "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"
SUPERSCRIPTS = str.maketrans("-0123456789", RAISED)
PARTICLES = ("particle", "particles")
"""Words for a count that stand in the library and not in the registry."""
HARDNESS_TEXT = rf"^\s*{NUMBER}\s*H(V|BW?|BS|RC|K)(\s*[\d.]+)?\s*$"
"""Pattern of a number on a scale of hardness, "62 HRC"."""


def name_of_unit(unit: str) -> str:
    """Name under which a schema keeps the pattern of a unit.

    >>> name_of_unit("kg/m^3"), name_of_unit("1")
    ('kg_per_m3', 'number')
    """
    name = re.sub(r"\W+", "_", unit.replace("/", " per ").replace("^", ""))
    return "number" if unit == "1" else name.removeprefix("1_")


@cache
def pattern_of_unit(unit: str) -> str:
    """Pattern of a text that stands for a number in this unit of SI.

    It knows the words of all units that the library reads, and which of them measure the same. Of
    products it knows the words alone: it takes each number that can be read, and some that cannot.

    Examples
    --------
    >>> taken = re.compile(pattern_of_unit("m"))
    >>> [bool(taken.search(text)) for text in ("300 nm", "3e-7", "300 GPa", "3 furlong", "1,5 m")]
    [True, True, False, False, False]
    """
    units = registry()
    wanted = units.parse_units(unit.replace("^", "**") if unit != "1" else "").dimensionality
    alone: dict[int, list[str]] = {}
    for name in sorted(USUAL):
        dimensions = units.parse_units(name).dimensionality
        for power in POWERS:
            if dimensions**power == wanted and (power == 1 or dimensions):
                alone.setdefault(power, []).extend(_spellings(name))
    ways = [_word(words) + _power_text(power) for power, words in alone.items()]
    ways += [
        rf"(1\s*)?/\s*{_word(words)}{_power_text(-power)}"
        for power, words in alone.items()
        if power < 0
    ]
    if unit not in SIMPLE:
        every = _word([spelling for name in sorted(USUAL) for spelling in _spellings(name)])
        raised = rf"(\s*(\^|\*\*)?\s*-?\d\d?(\.\d)?|[{RAISED}]+)?"
        factor = rf"({every}{raised}|1)"
        ways.append(rf"{SIGN}?\s*{factor}((\s*{SIGN}\s*|\s+){factor})+")
    return rf"^\s*{NUMBER}\s*({'|'.join(ways)})?\s*$"


def _power_text(power: int) -> str:
    """What stands behind a unit of this power."""
    if power == 1:
        return r"(\s*(\^|\*\*)\s*1)?"
    return rf"\s*((\^|\*\*)?\s*{power}|{str(power).translate(SUPERSCRIPTS)})"


def _word(spellings: list[str]) -> str:
    """One of these spellings, with or without a prefix of the registry."""
    words = "|".join(_longest_first({*spellings} - {"%"}))
    percent = "|%" if "%" in spellings else ""
    return f"(({'|'.join(_prefixes())})?({words})s?{percent})"


def _longest_first(words: Iterable[str]) -> list[str]:
    return sorted(words, key=lambda word: (-len(word), word))


@cache
def _prefixes() -> tuple[str, ...]:
    names = (prefix for prefix in registry()._prefixes if re.fullmatch(r"[^\W\d_]+", prefix))
    return tuple(_longest_first(names))


@cache
def _spellings(name: str) -> tuple[str, ...]:
    """Words for a unit that consist of letters."""
    words = [name]
    if name != "dimensionless":
        definition = registry()._units[name]
        words += [definition.symbol, *definition.aliases]
    words += PARTICLES if name == "count" else ()
    words += ("%",) if name == "percent" else ()
    return tuple(word for word in words if word == "%" or re.fullmatch(r"[^\W\d_]+", word))
