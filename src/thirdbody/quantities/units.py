"""Numbers with a unit, as a user writes them: "300 nm", "5 GPa", "1e11 / m^2".

Everything else in the library is a plain number in SI; strings are read here and nowhere else.
Quantities that carry a unit of their own are taken as well.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from fractions import Fraction
from typing import Any, NoReturn, NotRequired, TypedDict

from ..errors import InvalidValue, Mistake, Problem
from .kinds import KINDS, is_usual, kind_of_parsed, one_spelling, registry
from .nearest import guess, nearest_word

__all__ = [
    *("EXAMPLES", "MICRONS", "Meant", "Quantity", "Range", "comma_may_part_thousands"),
    *("example_of", "not_among", "quantity_to_si", "say", "to_si"),
]


class Meant(TypedDict):
    """Unit and meaning of a number."""

    unit: str
    meaning: str


class Range(TypedDict):
    """Unit and limits of a number, and the likely cause of one outside them."""

    unit: str
    gt: float | None
    ge: float | None
    lt: float | None
    le: float | None
    hint: str
    whole: NotRequired[bool]


class Quantity(Range):
    """Declaration of a number in SI, as `thirdbody.quantities.value.quantity` makes it."""

    symbol: str
    meaning: str
    usual: NotRequired[float | None]


MICRONS = "um are 1e-6 or '1 um'"
EXAMPLES = {
    "m": '"300 nm"',
    "Pa": '"5 GPa"',
    "1/m^2": '"1e11 / m^2"',
    "J/m^2": '"50 mJ/m^2"',
    "kg/m^3": '"7800 kg/m^3"',
    "W/m/K": '"46 W/m/K"',
    "J/kg/K": '"460 J/kg/K"',
    "ohm*m": '"2e-7 ohm*m"',
    "Pa m^0.5": '"1.2 MPa m^0.5"',
    "rad": '"25 deg"',
    "N": '"20 N"',
    "m/s": '"0.5 m/s"',
    "Pa s": '"20 mPa s"',
    "1/Pa": '"20 / GPa"',
    "s": '"1000 h"',
    "m^2": '"0.5 m^2"',
    "m^3": '"200 L"',
    "m^3/s": '"60 L/min"',
    "kg": '"50 g"',
    "kg/s": '"125 mg/h"',
    "1/s": '"1e6 / min"',
    "1/m": '"1 / mm"',
    "rad/s": '"1500 rpm"',
    "K": '"350 K"',
    "W/m^2/K": '"2000 W/m^2/K"',
    "m^2*K/W": '"1e-6 m^2*K/W"',
    "ohm*m^2": '"1e-12 ohm*m^2"',
    "1": "0.5",
}
"""How a value in each of the library's units may be written."""
WRITTEN = re.compile(r"'([+-]?\d[^']*)'")
"""A value as the hint on a quantity writes it."""

_USUAL = ("nm", "um", "µm", "mm", "m", "angstrom", "Pa", "kPa", "MPa", "GPa", "bar", "psi")

_POWERS = {
    "m": {"nm": -9, "um": -6, "µm": -6, "mm": -3, "cm": -2, "m": 0},
    "Pa": {"Pa": 0, "kPa": 3, "bar": 5, "MPa": 6, "GPa": 9},
    "1/m": {"1/m": 0, "/ m": 0, "1/mm": 3, "/ mm": 3},
    "m^2": {"um^2": -12, "mm^2": -6, "cm^2": -4, "m^2": 0},
    "1/m^2": {"1/m^2": 0, "/ m^2": 0, "1/mm^2": 6, "/ mm^2": 6},
    "m^3": {"mL": -6, "L": -3, "m^3": 0},
    "1/m^3": {"1/m^3": 0, "/ m^3": 0, "1/mL": 6, "/ mL": 6},
    "N": {"mN": -3, "N": 0, "kN": 3},
    "m/s": {"mm/s": -3, "m/s": 0},
    "s": {"us": -6, "ms": -3, "s": 0},
    "rad": {"rad": 0},
    "rad/s": {"rad/s": 0},
    "Pa s": {"mPa s": -3, "cP": -3, "Pa s": 0},
    "1/Pa": {"1/GPa": -9, "/ GPa": -9, "1/Pa": 0},
    "Pa m^0.5": {"MPa m^0.5": 6},
    "kg": {"mg": -6, "g": -3, "kg": 0},
    "kg/m^3": {"kg/m^3": 0, "g/cm^3": 3},
    "J/m^2": {"mJ/m^2": -3, "J/m^2": 0},
    "W/m/K": {"W/m/K": 0},
    "J/kg/K": {"J/kg/K": 0},
    "ohm*m": {"ohm*m": 0, "ohm m": 0},
    "A": {"mA": -3, "A": 0},
}
"""The usual units as powers of ten of those that are needed: the registry takes half a second."""

_FACTORS = {
    "rad": {"deg": math.pi / 180},
    "rad/s": {"rpm": math.pi / 30},
    "s": {"min": 60.0, "h": 3600.0, "day": 86400.0},
}
"""Usual units that are no powers of ten, with the factors of the registry."""

_NUMBER = re.compile(
    r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?|[+-]?(?:infinity|inf|nan)\b", re.IGNORECASE
)
_HARDNESS = re.compile(
    r"(?P<number>[^\s\d]*[\d.,]+(?:[eE][+-]?\d+)?)\s*(?P<scale>H(?:V|BW?|BS|RC|K))(?:\s*[\d.]+)?"
)
"""A hardness number, as "700 HV", "700 HV10", "62 HRC"; the test load behind it is not used."""


def example_of(unit: str, hint: str = "") -> str:
    """How a value of a unit may be written; of a quantity as its hint writes one.

    >>> example_of("Pa"), example_of("Pa", "MPa are 5e6 or '5 MPa'"), example_of("m^2*K/W")
    ('"5 GPa"', '"5 MPa"', '"1e-6 m^2*K/W"')
    """
    written = WRITTEN.search(hint)
    return f'"{written[1]}"' if written else EXAMPLES.get(unit, f'"1 {unit}"')


def to_si(value: object, unit: str, *, example: str = "") -> float:
    """One number in SI from a plain number or a string with a unit.

    Parameters
    ----------
    value : float or str
        A plain number is taken as SI already.
    unit : str
        The SI unit that is needed: "m", "Pa", "1/m^2", or "1" for a pure number.
    example : str, optional
        How such a value may be written, in quotes; one of this unit by default.

    Returns
    -------
    float
        The value in ``unit``; NaN and infinity pass, whoever knows the range refuses them.

    Raises
    ------
    InvalidValue
        One sentence that begins with the value: no number, unknown unit, wrong dimension.

    Examples
    --------
    >>> to_si("300 nm", "m"), to_si("5 GPa", "Pa"), to_si("1e11 / m^2", "1/m^2"), to_si(0.3, "1")
    (3e-07, 5000000000.0, 100000000000.0, 0.3)
    >>> to_si("300 GPa", "m")
    Traceback (most recent call last):
    ...
    thirdbody.errors.InvalidValue: "300 GPa" is a pressure, but a length [m] is needed...
    """
    example = example or example_of(unit)
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        try:
            return float(value)
        except OverflowError:
            return math.inf
    if not isinstance(value, str):
        from .carried import carries_unit, in_si  # numpy, which `thirdbody --help` does not need

        if carries_unit(value) and not isinstance(value, (list, tuple, dict)):
            return _one(in_si(value, unit), unit, example)
        if hasattr(value, "__float__") and not isinstance(value, bool):  # numpy's numbers
            return _one(value, unit, example)
        return _refuse(f"{say(value)} must be {_need_text(unit, example)}", Mistake.KIND)
    text = value.strip()
    number = _NUMBER.match(text)
    if number is None:
        return _refuse(
            f"{say(value)} has no number in front; it must be {_need_text(unit, example)}",
            Mistake.KIND,
        )
    rest = text[number.end() :].strip()
    if not rest:
        return float(number.group())
    power = _POWERS.get(unit, {}).get(rest)
    if power is not None and math.isfinite(float(number.group())):
        return _shift(number.group(), power)
    factor = _FACTORS.get(unit, {}).get(rest)
    if factor is not None:
        return float(number.group()) * factor
    shown = say(value)
    if re.match(r",\d", rest):
        return _refuse(_about_comma(text, shown), Mistake.FORM)
    if ends := _RANGE.fullmatch(rest):
        return _refuse(_about_range(number.group(), ends, shown, example), Mistake.FORM)
    body = one_spelling(rest)
    if body is None:
        return _refuse(f"{shown} cannot be read; it must be {_need_text(unit, example)}")
    return _scale(number.group(), body, shown, unit, example)


_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+(?![\d,])")


def comma_may_part_thousands(text: str) -> bool:
    """Whether a comma in a number may stand between thousands as well as for a decimal point.

    >>> comma_may_part_thousands("1,100 N"), comma_may_part_thousands("0,100 N")
    (True, False)
    """
    return _THOUSANDS.match(text.strip()) is not None


_RANGE = re.compile(
    r"(?P<unit>\D*?)(?:\s*\bto\b|\s*(?:–|—|\.\.+)|\s+-\s|^-)\s*"
    r"(?P<high>\d[\d.eE]*)\s*(?P<unit_of_high>.*)"
)
"""What follows the first number of a range in words: "nm to 100 nm"."""


def _about_range(low: str, ends: re.Match[str], shown: str, example: str) -> str:
    """What a range in words is, and how one is written where it may stand."""
    first = f"{low} {ends['unit'] or ends['unit_of_high']}".strip()
    last = f"{ends['high']} {ends['unit_of_high']}".strip()
    return (
        f"{shown} is a range, but one value is needed here, e.g. {example}; in "
        f"[load] or [sweep.vary] a range is {{ from = {say(first)}, to = {say(last)}, "
        "points = 10 }"
    )


def _about_comma(text: str, shown: str) -> str:
    """What a comma in a number may mean: a decimal point, or, before three digits, thousands."""
    point = shown.replace(",", ".")
    thousands = _THOUSANDS.match(text)
    if thousands is None:
        return f"{shown} has a decimal comma; write a point: {point}"
    whole = shown.replace(",", "")
    if thousands[0].count(",") > 1 or text[thousands.end() :].startswith("."):
        return f"{shown} has commas between thousands; leave them out: {whole}"
    return (
        f"{shown} has a comma, which may stand for a decimal point or between thousands; write "
        f"{point} or {whole}"
    )


def quantity_to_si(value: object, about: Meant) -> float:
    """One number in SI for a quantity; a hardness may be a number on a hardness scale.

    Parameters
    ----------
    value : float or str
        As for `to_si`; where a hardness [Pa] is needed also "700 HV", "62 HRC", "200 HB",
        "870 HK": the mean pressure on the projected area
        (`thirdbody.quantities.hardness.pressure`).
    about : mapping
        What `thirdbody.quantities.value.quantity` says of the quantity: its unit and meaning.

    Returns
    -------
    float
        The value in SI.

    Raises
    ------
    InvalidValue
        One sentence that begins with the value.

    Examples
    --------
    >>> H = {"unit": "Pa", "meaning": "hardness"}
    >>> quantity_to_si("5 GPa", H), round(quantity_to_si("62 HRC", H) / 1e9, 2)
    (5000000000.0, 7.89)
    """
    wanted = about["unit"] == "Pa" and about["meaning"].startswith("hardness")
    match = _HARDNESS.fullmatch(value.strip()) if wanted and isinstance(value, str) else None
    if match is None:
        hint = about.get("hint")
        example = example_of(about["unit"], hint if isinstance(hint, str) else "")
        return to_si(value, about["unit"], example=example)
    from .hardness import pressure

    number = to_si(match["number"], "1")
    try:
        return pressure(number, match["scale"])
    except InvalidValue as error:
        return _refuse(f"{say(value)} cannot be used: {error}", error.code)


def _one(value: Any, unit: str, example: str) -> float:
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        return _refuse(f"{say(value)} must be {_need_text(unit, example)}", Mistake.KIND)


def _refuse(sentence: str, code: Mistake = Mistake.UNIT, *, hint: str = "") -> NoReturn:
    raise InvalidValue(Problem("", sentence, hint=hint, code=code))


def say(value: object) -> str:
    """A value as it stands in a study file, shortened if long."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value if len(value) <= 60 else value[:57] + "..."}"'
    if isinstance(value, dict):
        value = "{ " + ", ".join(f"{key} = {say(item)}" for key, item in value.items()) + " }"
    elif isinstance(value, (list, tuple)):
        value = "[" + ", ".join(say(item) for item in value) + "]"
    text = str(value)
    return text if len(text) <= 80 else text[:76] + " ..."


def not_among(key: str, value: object, allowed: Iterable[str]) -> Problem:
    """The mistake of a word that is none of those allowed.

    >>> not_among("limit", "rough", ("coarse", "fine"))
    'limit = "rough" must be one of "coarse", "fine"'
    """
    return Problem(
        key, f"must be one of {', '.join(map(say, allowed))}", say(value), code=Mistake.OPTION
    )


def _need_text(unit: str, example: str) -> str:
    kind = KINDS.get("" if unit == "1" else unit.replace("^", "**"), "a quantity")
    if unit == "1":
        return f"{kind}, e.g. {EXAMPLES['1']}"
    return f"{kind}: a number in SI [{unit}] or with a unit, e.g. {example}"


def _shift(number: str, power: int) -> float:
    """The number times a power of ten: "300 nm" is the double 300e-9, not 300 * 1e-9."""
    try:
        return float(Fraction(number) * Fraction(10) ** power)
    except OverflowError:
        return math.copysign(math.inf, float(number))


def _scale(number: str, body: str, shown: str, unit: str, example: str = "") -> float:
    units = registry()
    wanted = "" if unit == "1" else unit.replace("^", "**")
    try:
        parsed = units.parse_units(body)
    except Exception:
        return _refuse_unknown(body, shown, unit, example)
    if strange := next((word for word in re.findall(r"[^\W\d_]+", body) if not is_usual(word)), ""):
        must = f"it must be {_need_text(unit, example)}"
        return _refuse(f"{shown} has the unit {strange}, which is not used here; {must}")
    if parsed.dimensionality == units.parse_units(wanted).dimensionality:
        factor = units.convert(1.0, parsed, wanted)
        exponent = round(math.log10(factor)) if factor > 0 else 0
        if math.isfinite(float(number)) and math.isclose(factor, 10.0**exponent, rel_tol=1e-12):
            return _shift(number, exponent)
        return float(number) * factor
    kind = kind_of_parsed(parsed)
    if unit == "1":
        return _refuse(f"{shown} is {kind}, but a pure number is needed, e.g. {EXAMPLES['1']}")
    return _refuse(
        f"{shown} is {kind}, but {KINDS.get(wanted, 'a quantity')} [{unit}] is needed, "
        f"e.g. {example}"
    )


def _refuse_unknown(body: str, shown: str, unit: str, example: str) -> NoReturn:
    units = registry()
    for word in re.findall(r"[^\W\d_]+", body):
        if word in units:
            continue
        if word in ("HV", "HB", "HK"):
            _refuse(
                f"{shown} is a hardness number, not a pressure; one unit of {word} is 1 kgf/mm^2, "
                f"so write {shown.replace(word, 'kgf/mm^2')}"
            )
        rule = f"{shown} has the unit {word}, which is not known (case matters)"
        meant = nearest_word(word, _USUAL, cutoff=0.7)
        hint = guess("", (), meant=meant) if meant else f"it must be {_need_text(unit, example)}"
        _refuse(rule, hint=hint)
    _refuse(f"{shown} has a unit that cannot be read; it must be {_need_text(unit, example)}")
