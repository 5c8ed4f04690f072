"""What can be set: the fields of every table, as the classes and registries declare them."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import thirdbody as tb

from ..errors import InvalidValue
from ..populations.measured import cleanliness
from ..populations.measured.sizes import FITS, WEIGHTINGS
from ..quantities.units import Quantity, comma_may_part_thousands, quantity_to_si
from ..quantities.value import allowed_range
from ..study import DISTRIBUTIONS, HEIGHTS, LOADS
from ..study.fields import declarations
from ..study.particles import AMOUNT, COUNTED, SHAPES
from ..study.reader import FIELDS
from ..study.schema import Describer
from ..study.tables import TABLES
from ..study.toml import value_of
from .bounds import refuse_long_names
from .text import in_ascii, toml_value, with_micro

__all__ = [
    "COUNTED_FIELDS",
    "VARIANTS",
    "Field",
    "engineering",
    "fields_of",
    "known_keys",
    "number_field",
    "number_of",
    "options_of",
    "text_of",
    "value_from",
]

PREFIXES = {
    "m": {"m": 1.0, "mm": 1e-3, "um": 1e-6, "nm": 1e-9},
    "Pa": {"GPa": 1e9, "MPa": 1e6, "kPa": 1e3, "Pa": 1.0},
    "1/m^2": {"/ m^2": 1.0},
}


@dataclass(frozen=True, kw_only=True)
class Field:
    """One entry of a table, and how a page lets it be set.

    Parameters
    ----------
    name : str
        The key.
    kind : {"number", "word", "switch", "text"}
        Text that is not said otherwise is TOML.
    label : str
        The key with its symbol and unit.
    about : str
        What it is and what is allowed.
    options : tuple of str
        Of a word.
    quantity : dict, optional
        What `thirdbody.quantities.value.quantity` says of a number.
    default : object
        What counts when it is left out; None where it must stand or there is none.
    """

    name: str
    kind: str
    label: str
    about: str
    options: tuple[str, ...] = ()
    quantity: Quantity | None = None
    default: Any = None


NESTED = {"Material", "Heights", "Ellipticity | None", "AbstractAsperityLaw"}
"""Types of fields that have widgets of their own."""
TOML = "as in a study file, e.g. [1, 2, 5]"
ENTRIES = {
    "word": ("word", ""),
    "switch": ("switch", ""),
    "text": ("string", "text"),
    "list": ("text", TOML),
    "word or number": ("text", TOML),
}
"""The entry for each kind of declaration, and what is said of it."""


def fields_of(kind: type) -> list[Field]:
    """The fields of a value class that a study file can set with one entry."""
    out = []
    for declaration in declarations(kind):
        if declaration.quantity is not None:
            out.append(
                number_field(
                    declaration.name, declaration.quantity, declaration.default, declaration.needed
                )
            )
        elif declaration.kind in ENTRIES or declaration.declared in FIELDS.keys() - NESTED:
            entry, said = ENTRIES.get(declaration.kind, ("text", TOML))
            out.append(
                Field(
                    name=declaration.name,
                    kind=entry,
                    label=declaration.name,
                    about=declaration.meaning or said,
                    options=declaration.options,
                    default=declaration.default,
                )
            )
    return out


def known_keys(study: dict[str, object], name: str) -> dict[str, dict[str, str]]:
    """What the reader of study files knows in one table and those inside: keys, what each is."""
    tables = [table for table in TABLES if table.name == name]
    by_path = Describer(Path(), study).known_of(tables).keys
    return {path: keys for path, keys in by_path.items() if path}


def number_field(name: str, about: Quantity, default: object = None, needed: bool = True) -> Field:
    """The field of a quantity."""
    symbol = f" {about['symbol']}" if about["symbol"] != name else ""
    unit = f" [{about['unit']}]" if about["unit"] != "1" else ""
    allowed = allowed_range(about)
    said = f"{about['meaning']}; {allowed}"
    if default is not None:
        said += f"; {text_of(default)} when left out"
    elif not needed:
        said += "; may be left out"
    return Field(
        name=name,
        kind="number",
        label=f"{name}{symbol}{unit}",
        about=said,
        quantity=about,
        default=default,
    )


COUNTED_FIELDS: dict[str, tuple[Field, ...]] = {
    kind: tuple(
        Field(
            name=name,
            kind="word",
            label=name,
            about={
                "level": "which end of the range of each number of the code",
                "limit": "which end of the limits of the dust",
                "weighting": "what the histogram weighs",
                "fit": "a distribution fitted to it",
            }[name],
            options=tuple(
                {
                    "level": cleanliness.LEVELS,
                    "limit": cleanliness.LIMITS,
                    "weighting": WEIGHTINGS,
                    "fit": FITS,
                }[name]
            ),
        )
        if name in ("level", "limit", "weighting", "fit")
        else number_field(name, AMOUNT[name], needed=False)
        for name in names
    )
    for kind, names in COUNTED.items()
}
"""Options beside a code, a test dust or a measured histogram."""

VARIANTS = {
    "distribution": DISTRIBUTIONS,
    "shape": SHAPES,
    "heights": HEIGHTS,
    "asperity": tb.asperity.REGISTRY,
    "particle": tb.particle.REGISTRY,
    "outputs": tb.outputs.REGISTRY,
    "load": LOADS,
}
"""Registries from which a word is chosen."""


def options_of(kind: Any) -> dict[str, str]:
    """The words of a registry and how a menu shows them."""
    return {
        name: f"{name}: {title}" if (title := getattr(choice, "title", "")) else name
        for name, choice in kind.items()
    }


# ---------------------------------------------------------------------- text and values
def text_of(value: object) -> str:
    """A value of a study as a field shows it: strings without quotes, the rest as in TOML."""
    if value is None:
        return ""
    if isinstance(value, list) and not any(isinstance(x, dict) for x in value):
        return ", ".join(map(text_of, value))
    return with_micro(value if isinstance(value, str) else toml_value(value))


DECIMAL_COMMA = re.compile(r"([+-]?\d+),(\d+(?:[eE][+-]?\d+)?\s*(?:[^\d\s,][^,]*)?)")


def value_from(text: str, *, one: bool = False) -> object:
    """What a user wrote: numbers as numbers, tables and lists as in TOML, text as text.

    A comma inside a number is a decimal one where ``one`` value is asked for, and where a unit
    stands behind: "0,4 um" are no two values of which the first has no unit. In "1,100 N" it may
    stand between thousands as well: this is left as it is, to be refused.
    """
    text = in_ascii(text.strip())
    if (comma := DECIMAL_COMMA.fullmatch(text)) and (one or comma[2][-1].isalpha()):
        if comma_may_part_thousands(text):
            return text  # which is refused where it is read, with both that it may stand for
        text = f"{comma[1]}.{comma[2]}"
    if not text:
        return None
    try:
        refuse_long_names(text)
    except InvalidValue:
        return text
    if "," in text and text[0] not in '[{"':
        return [value_of(entry) for entry in text.split(",") if entry.strip()]
    return value_of(text)


def number_of(value: object, about: Quantity) -> float:
    """The number in SI that an entry stands for; NaN where it stands for none."""
    try:
        return quantity_to_si(value, about)
    except InvalidValue:
        return math.nan


def engineering(value: float, unit: str, digits: int = 4) -> str | float:
    """A number as an engineer writes it: "316 nm", "5 MPa"; a pure number stays one."""
    if unit not in PREFIXES:
        rounded = float(f"{value:.{digits}g}")
        return rounded if unit == "1" else f"{rounded:g} {unit}"
    name, size = next(
        ((n, s) for n, s in PREFIXES[unit].items() if abs(value) >= 0.9995 * s),
        list(PREFIXES[unit].items())[-1],
    )
    return f"{value / size:.{digits}g} {name}"
