"""Numbers, units and lists in words: one home for every rounding that a reader sees.

Data go out whole (JSON, CSV, files); these functions are for sentences, tables and labels.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

__all__ = [
    "NOT_KNOWN",
    "UNITS",
    "Least",
    "concentration_of",
    "join_words",
    "number",
    "percent",
    "plural",
    "powers",
    "readable_unit",
    "signed_number",
    "span",
    "times",
    "unbroken",
    "unit_of",
    "value_of",
]

NOT_KNOWN = "not known"
"""What stands for a number that is missing or not finite."""
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
PREFIXED = {
    "m": ((1.0, "m"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm")),
    "Pa": ((1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (1.0, "Pa")),
    "Pa m^0.5": ((1e6, "MPa √m"),),
    "kg": ((1.0, "kg"), (1e-3, "g"), (1e-6, "mg"), (1e-9, "µg")),
    "m^2": ((1.0, "m²"), (1e-6, "mm²"), (1e-12, "µm²")),
    "rad": ((math.pi / 180, "deg"),),
    "rad/s": ((math.pi / 30, "rpm"),),
}
SMALLEST, LARGEST = 1e-12, 1e13
"""Magnitudes between which units take a prefix."""
UNITS = {
    "um": "µm",
    "1/m^2": "m⁻²",
    "1/m": "m⁻¹",
    "1/m^3": "m⁻³",
    "1/Pa": "Pa⁻¹",
    "1/K": "K⁻¹",
    "1/s": "s⁻¹",
    "m^3/s": "m³/s",
    "Pa m^0.5": "Pa √m",
    "m^3": "m³",
    "m^2": "m²",
    "kg/m^3": "kg/m³",
    "W/m^2": "W/m²",
    "W/m/K": "W/(m K)",
    "W/m^2/K": "W/(m² K)",
    "J/kg/K": "J/(kg K)",
    "J/m^2": "J/m²",
    "m^2*K/W": "m² K/W",
    "S/m^2": "S/m²",
    "ohm*m": "Ω m",
    "ohm*m^2": "Ω m²",
}
"""Units that people read otherwise than a file writes them."""


UNIT = re.compile(
    r"(?<=[\d⁰¹²³⁴⁵⁶⁷⁸⁹]) (?=(?:%|σ|deg|rpm|ppm|wt%|min|h|°C|"
    r"[fpnµumckMGT]?(?:m|g|s|N|Pa|J|W|A|V|Hz|Ω|L|K))[²³⁻⁰¹⁴-⁹]*(?![\w%]))"
)
"""The space between a number and its unit."""


class Least(str):
    """Words for a number too small to be read, which keep it: "< 0.0001 %" is 4e-8.

    >>> percent(4e-8, least=1e-6), percent(4e-8, least=1e-6).value
    ('< 0.0001 %', 4e-08)
    """

    value: float

    def __new__(cls, text: str, value: float) -> Least:
        self = super().__new__(cls, text)
        self.value = value
        return self

    def __reduce__(self) -> tuple[type[Least], tuple[str, float]]:
        return type(self), (str(self), self.value)


def unbroken(text: str) -> str:
    """A text whose numbers stay beside their units where its lines break.

    >>> unbroken("5.2 % at 1.2 MPa, 2 of 13 in 0.5 Pa s, 1×10¹¹ m⁻²").replace("\u00a0", "~")
    '5.2~% at 1.2~MPa, 2 of 13 in 0.5~Pa~s, 1×10¹¹~m⁻²'
    """
    return UNIT.sub("\u00a0", text).replace("Pa s", "Pa\u00a0s")


def powers(text: str) -> str:
    """A text with its powers of ten as people write them.

    >>> powers("F* = 1.2e-05")
    'F* = 1.2×10⁻⁵'
    """
    return re.sub(
        r"(?<=\d)e([+-]\d+)\b", lambda m: f"×10{str(int(m[1])).translate(SUPERSCRIPTS)}", text
    )


def unit_of(unit: str) -> str:
    """A unit as people read it.

    >>> unit_of("1/m^2"), unit_of("K"), unit_of("1")
    ('m⁻²', 'K', '')
    """
    return "" if unit == "1" else UNITS.get(unit, unit)


def number(value: float | None, digits: int = 4, *, least: float = 0.0) -> str:
    """A number to so many digits; nobody reads those below ``least``.

    >>> number(0.5), number(4.4676e-5), number(-0.0), number(math.nan), number(2e-12, least=1e-9)
    ('0.5', '4.468×10⁻⁵', '0', 'not known', '< 1×10⁻⁹')
    >>> number(-3.14159, 3)
    '−3.14'
    """
    if value is None or not math.isfinite(value):
        return NOT_KNOWN
    if 0 < value < least:
        return Least(f"< {number(least)}", value)
    text = f"{abs(value):.{digits}g}"
    return f"{'−' if value < 0 else ''}{powers(text)}"


def value_of(value: float | None, unit: str, digits: int = 4) -> str:
    """A number with its unit, metres and pascals with a prefix, angles in degrees.

    >>> value_of(3e-7, "m"), value_of(5e6, "Pa"), value_of(1e11, "1/m^2"), value_of(0.3, "1")
    ('300 nm', '5 MPa', '1×10¹¹ m⁻²', '0.3')
    >>> value_of(0.999996e-6, "m"), value_of(1e-13, "m"), value_of(None, "m")
    ('1 µm', '1×10⁻¹³ m', 'not known')
    """
    if value is None or not math.isfinite(value):
        return NOT_KNOWN
    size, name = readable_unit(value, unit, digits)
    return f"{number(value / size, digits)} {name}".rstrip()


def readable_unit(value: float, unit: str, digits: int = 4) -> tuple[float, str]:
    """Size and name of the unit in which people read a number.

    >>> readable_unit(3e-7, "m"), readable_unit(1e11, "1/m^2"), readable_unit(0.3, "1")
    ((1e-09, 'nm'), (1.0, 'm⁻²'), (1.0, ''))
    """
    if unit not in PREFIXED or not (value == 0 or SMALLEST < abs(value) < LARGEST):
        return 1.0, unit_of(unit)
    rounded = abs(float(f"{value:.{digits}g}")) * (1 + 1e-9)
    fitting = (pair for pair in PREFIXED[unit] if rounded >= pair[0])
    return next(fitting, PREFIXED[unit][-1])


def concentration_of(value: float | None, by: str) -> str:
    """How much of a fluid is particles, as study files write it.

    >>> concentration_of(0.007, "mass"), concentration_of(1e12, "number")
    ('0.7 wt %', '1×10⁶ per mL')
    """
    factor, unit = {
        "mass": (100.0, "wt %"),
        "volume": (100.0, "vol %"),
        "number": (1e-6, "per mL"),
        "mass per volume": (1e3, "mg/L"),
    }[by]
    return NOT_KNOWN if value is None else f"{number(factor * value, 3)} {unit}"


def percent(value: float | None, error: float = 0.0, *, digits: int = 3, least: float = 0.0) -> str:
    """Text of a share, with its error if it has one; finer near the whole.

    >>> percent(0.1234), percent(0.99996), percent(1), percent(0.3, 0.02), percent(None)
    ('12.3 %', '99.996 %', '100 %', '30 % (± 2 %)', 'not known')
    >>> percent(1e-8, least=1e-6), percent(0.1234, digits=2), percent(1, digits=1)
    ('< 0.0001 %', '12 %', '100 %')
    >>> percent(0.8, 0.123)
    '80 % (± 12 %)'
    """
    if value is None or not math.isfinite(value):
        return NOT_KNOWN
    if 0 < value < least:
        return Least(f"< {percent(least)}", value)
    near = 1 - 0.5 * 10.0**-digits <= value and value != 1
    whole = len(f"{abs(100 * value):.0f}")  # 100 is no 1×10²
    text = f"{number(100 * value, max(digits + 2 if near else digits, whole))} %"
    if not error > 0:
        return text
    tens = len(f"{abs(100 * error):.0f}")  # nor is 10 one of the first digit
    return f"{text} (± {number(100 * error, tens if 100 * error >= 9.5 else 1)} %)"


def signed_number(value: float | None, decimals: int, unit: str = "") -> str:
    """A difference, always with its sign.

    >>> signed_number(3.14, 1, "%"), signed_number(-0.5, 3), signed_number(-1e-9, 1)
    ('+3.1 %', '−0.500', '+0.0')
    """
    if value is None or not math.isfinite(value):
        return NOT_KNOWN
    return f"{value:+z.{decimals}f} {unit}".rstrip().replace("-", "−")


def times(value: float | None) -> str:
    """A ratio.

    >>> times(2.5)
    '2.5 times'
    """
    return NOT_KNOWN if value is None else f"{number(value, 3)} times"


def span(low: float | None, high: float | None, unit: str) -> str:
    """From where to where.

    >>> span(80e-9, 1.2e-6, "m")
    '80 nm to 1.2 µm'
    """
    return f"{value_of(low, unit)} to {value_of(high, unit)}"


def join_words(names: Sequence[str]) -> str:
    """Words with "and" before the last.

    >>> join_words(["a", "b", "c"]), join_words(["a"])
    ('a, b and c', 'a')
    """
    return " and ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))


def plural(count: int, word: str) -> str:
    """How many of something.

    >>> plural(1, "load"), plural(3, "load")
    ('1 load', '3 loads')
    """
    return f"{count} {word}{'' if count == 1 else 's'}"
