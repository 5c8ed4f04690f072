"""Sizes and numbers of particles from a code, a test dust or a measured histogram."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from ..errors import InvalidValue, Problem
from ..populations.distributions import Histogram
from ..populations.measured import clean_room, cleanliness
from ..populations.measured.sizes import FITS, WEIGHTINGS, MeasuredSizes, read_sizes
from ..populations.particles import Particles
from ..quantities.units import say
from .concentration import AMOUNT, complaints_of, laden
from .fields import about_of
from .one_value import number, word
from .reader import Key, Reader, get, plain

__all__ = ["COUNTED", "counted"]

COUNTED = {
    "iso4406": ("level", "smallest", "largest"),
    "as4059": ("smallest", "largest"),
    "nas1638": ("smallest", "largest"),
    "test_dust": ("limit", "smallest"),
    "sizes": ("weighting", "fit", "smallest"),
    "iso14644": ("exposure", "particle_density", "smallest", "largest"),
}
"""Keys of [particles] that stand in the place of a distribution, and their options."""


def counted(
    reader: Reader, path: str, data: Any, kind: str, own: dict[str, Key], wrong: list[str]
) -> Any:
    """Particles from a code, a test dust or a measured histogram."""
    keys = dict(own)
    words = {
        "level": cleanliness.LEVELS,
        "limit": cleanliness.LIMITS,
        "weighting": tuple(WEIGHTINGS),
        "fit": tuple(FITS),
    }
    for name in COUNTED[kind]:
        where = f"{path}.{name}"
        if name in words:
            keys[name] = Key(plain(word(where, words[name])), False, "")
        else:
            about = AMOUNT[name]
            keys[name] = Key(plain(number(reader, where, about)), False, about_of(name, about))
    inline = kind == "sizes" and isinstance(data[kind], dict)
    if kind == "iso14644":
        keys["exposure"] = keys["exposure"]._replace(required=not reader.every_way)
    read = (
        reader.value(f"{path}.{kind}", data[kind], Histogram)
        if inline
        else plain(_count_of(reader, path, data, kind))
    )
    keys[kind] = Key(read, True, "")

    def build(values: dict[str, Any]) -> Particles:
        if wrong:
            raise InvalidValue(*wrong)
        found = values.pop(kind)
        options = {name: values.pop(name) for name in COUNTED[kind] if name in values}
        with complaints_of(path):
            if kind == "sizes":
                if inline:
                    weighting = options.get("weighting", "number")
                    found = MeasuredSizes(sizes=found, weighting=weighting)
                smallest = options.get("smallest")
                source = found.fit(options["fit"]) if "fit" in options else found
                return laden(reader, path, values, source.by_number(smallest))
            if kind == "iso14644":
                return _settled(reader, path, found, options, values)
            gap = values.pop("gap", values.pop("film", None))
            if kind == "iso4406":
                return Particles.from_iso4406(found, gap=gap, **options, **values)
            if kind == "test_dust":
                if given := values.pop("concentration", None):
                    values |= {"concentration": given.amount, "by": given.by, "gap": gap}
                return Particles.test_dust(found, **options, **values)
            return Particles.from_cleanliness_class(kind, found, gap=gap, **options, **values)

    return reader.table(path, keys, build)


def _settled(
    reader: Reader,
    path: str,
    iso_class: float,
    options: dict[str, float],
    values: dict[str, Any],
) -> Particles:
    """Dust that settles out of the air of a clean room."""
    beyond = options.get("largest", 0.0) > clean_room.COUNTED_TO
    more = (
        "; ISO 14644-1 states its classes up to 5 µm, and beyond its power law is continued: count "
        f"large ones on a witness plate, and give {path}.areal_density and sizes"
    )
    reader.assumed.append(
        f"{path}.iso14644: dust settles from still air, at the limit of its class, on surfaces "
        f"that face up; nothing is brought by hands or charges{more * beyond}"
    )
    if (density := options.pop("particle_density", None)) is None:
        density = values["material"].density
    if density is None:
        rule = 'is missing: dust falls by its density, e.g. particle_density = "2650 kg/m^3"'
        raise InvalidValue(Problem("particle_density", rule))
    number, sizes = clean_room.settled(iso_class, particle_density=density, **options)
    return Particles(diameter=sizes, areal_density=number, **values)


def _count_of(reader: Reader, path: str, data: Any, kind: str) -> Callable[[Any], Any]:
    """Reads the key that says what was counted."""
    where = f"{path}.{kind}"

    def measured(value: Any) -> MeasuredSizes:
        if not isinstance(value, str):
            raise InvalidValue(
                f'{say(value)} must be the name of a file, e.g. "sizes.csv", or '
                'its bins, { edges = ["1 um", "2 um"], counts = [5] }'
            )
        given = get(data, "weighting")
        known = isinstance(given, str) and given in WEIGHTINGS
        beside = reader.folder / value
        file = beside if beside.exists() else Path(value)
        return read_sizes(file, weighting=given if known else "number")

    def read(value: Any) -> Any:
        try:
            if kind == "sizes":
                return measured(value)
            if kind == "iso14644":
                return clean_room.read_class(value)
            if kind == "iso4406":
                cleanliness.read_iso4406(value)
            elif kind == "test_dust":
                dust = cleanliness.dust_table(value)
                if not dust["verified"]:
                    reader.notes.append(
                        f"{where} = {say(value)}: its table is that of {dust['edition']} and "
                        "was not compared with a printed copy; compare it with the "
                        "certificate of the dust"
                    )
            else:
                cleanliness.suspension_of_class(kind, value)
        except InvalidValue as error:
            raise InvalidValue(f"{where}: {error}") from None
        return value

    return read
