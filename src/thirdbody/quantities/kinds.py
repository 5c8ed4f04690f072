"""What a unit measures, in words; the registry of units, and the one spelling that it reads.

The registry (pint) is loaded with the first unit that is not among the usual ones.
"""

from __future__ import annotations

import re
from functools import cache
from typing import Any

__all__ = [
    "KINDS",
    "is_usual",
    "kind_needed",
    "kind_of",
    "kind_of_parsed",
    "library_unit",
    "one_spelling",
    "registry",
]

KINDS = {
    "": "a pure number",
    "m": "a length",
    "Pa": "a pressure",
    "1/m**2": "a number per area",
    "1/m**3": "a number per volume",
    "1/m": "a number per length",
    "m**2": "an area",
    "m**3": "a volume",
    "N": "a force",
    "N/m": "a force per length",
    "J/m**2": "an energy per area",
    "kg": "a mass",
    "kg/m**3": "a mass density",
    "kg/m**2": "a mass per area",
    "mol/m**3": "a molar concentration",
    "s": "a time",
    "1/s": "a number per time",
    "kg/s": "a mass per time",
    "m**3/s": "a volume per time",
    "m/s": "a speed",
    "K": "a temperature",
    "W/m/K": "a thermal conductivity",
    "J/kg/K": "a specific heat",
    "ohm*m": "an electrical resistivity",
    "J": "an energy",
    "rad/s": "a rate",
    "Pa*s": "a viscosity",
    "Pa s": "a viscosity",
    "Pa m**0.5": "a fracture toughness",
    "rad": "an angle",
    "1/Pa": "one over a pressure",
    "A": "an electric current (angstrom is written angstrom)",
}
"""What is measured in which unit."""

FACTOR = re.compile(
    r"\s*(?P<sign>[*/·×]?)\s*(?P<name>[^\W\d_]+|%|1)(?:(?:\s*(?:\^|\*\*)\s*)?(?P<power>-?\d\d?(?:\.\d)?))?"
)
SUPERSCRIPTS = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")


SYMBOLS = frozenset(("m", "kg", "s", "K", "A", "Pa", "N", "J", "W", "V", "Hz", "ohm", "rad"))
"""Symbols of SI that stand in this library, under which the registry has them too."""


@cache
def registry() -> Any:
    """The registry of units."""
    import pint

    return pint.UnitRegistry()


USUAL = frozenset(
    (
        *("meter", "micron", "angstrom", "inch", "thou", "foot"),
        *("pascal", "bar", "torr", "meter_Hg", "standard_atmosphere", "technical_atmosphere"),
        *("pound_force_per_square_inch", "kip_per_square_inch"),
        *("newton", "force_kilogram", "force_gram", "force_pound", "dyne"),
        *("gram", "metric_ton", "pound", "ounce", "mole", "molar", "liter"),
        *("second", "minute", "hour", "day", "hertz", "revolutions_per_minute"),
        *("kelvin", "degree_Celsius", "delta_degree_Celsius"),
        *("joule", "erg", "electron_volt", "calorie", "watt", "horsepower"),
        *("volt", "ampere", "ohm", "siemens", "poise", "stokes", "reyn"),
        *("radian", "degree", "arcminute", "arcsecond", "turn", "revolution"),
        *("percent", "permille", "ppm", "count", "dimensionless"),
    )
)
"""Units that engineers measure interfaces in, as the registry calls them; any prefix goes."""


def is_usual(word: str) -> bool:
    """Whether this library writes a unit under this name.

    >>> is_usual("nm"), is_usual("psi"), is_usual("furlong"), is_usual("parsec")
    (True, True, False, False)
    """
    return any(name in USUAL for _, name, _ in registry().parse_unit_name(word))


def one_spelling(rest: str) -> str | None:
    """The unit in the one spelling that the registry reads; None for anything else."""
    rest = re.sub(r"\bparticles?\b", "count", rest.translate(SUPERSCRIPTS))
    out, at = "1", 0
    while at < len(rest):
        factor = FACTOR.match(rest, at)
        if factor is None or len(rest) > 60:
            return None
        sign, name, power = factor["sign"], factor["name"], factor["power"]
        out += f" {'/' if sign == '/' else '*'} {'percent' if name == '%' else name}"
        out += f"**({power})" if power else ""
        at = factor.end()
    return out


def library_unit(unit: str) -> str | None:
    """A unit in SI as libraries of units read it, "" for a pure number; None if it is none.

    >>> library_unit("1/m²"), library_unit("Pa m^0.5"), library_unit("1"), library_unit("N or N/m")
    ('1/m**2', 'Pa*m**0.5', '', None)
    >>> library_unit("W/(m² K)")
    'W/m**2/K'
    """
    if unit == "1":
        return ""
    # W/(m K) is W/m/K
    unit = re.sub(r"/\(([^()]+)\)", lambda all_of: "/" + "/".join(all_of[1].split()), unit)
    body = one_spelling(unit)
    if body is None:
        return None
    try:
        if not SYMBOLS.issuperset(re.findall(r"[^\W\d_]+", body)):  # to load it takes 0.6 s
            registry().parse_units(body)
    except Exception:
        return None
    return re.sub(r"\*\*\(([\d.]+)\)", r"**\1", body.removeprefix("1 * ").replace(" ", ""))


def kind_of(unit: str) -> str:
    """What a unit of any library measures, in words.

    >>> kind_of("megapascal"), kind_of("furlong^7"), kind_of("wibble")
    ('a pressure', 'in m**7', 'in wibble')
    """
    try:
        parsed = registry().parse_units(unit)
    except Exception:
        return f"in {unit}"
    return kind_of_parsed(parsed)


def kind_needed(unit: str) -> str:
    """What a quantity must be, in words.

    >>> kind_needed("m"), kind_needed("1")
    ('a length [m] is needed', 'a pure number is needed')
    """
    plain = unit.replace("^", "**")
    kind = KINDS.get("" if unit == "1" else plain) or KINDS.get(
        library_unit(unit) or plain, "a quantity"
    )
    return f"{kind} is needed" if unit == "1" else f"{kind} [{unit}] is needed"


def kind_of_parsed(parsed: Any) -> str:
    """What a unit of the registry measures, in words."""
    kinds = (
        name
        for kind, name in KINDS.items()
        if registry().parse_units(kind).dimensionality == parsed.dimensionality
    )
    return next(kinds, f"in {registry().get_base_units(parsed)[1]:~C}")
