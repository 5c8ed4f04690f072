"""How many particles: a density per area, or a concentration and the gap that traps it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from ..errors import InvalidValue, Problem
from ..populations.measured import cleanliness
from ..populations.particles import Particles
from ..quantities.units import say
from ..quantities.value import quantity
from .fields import about_of
from .mistakes import clash
from .one_value import number
from .reader import Key, Reader, plain

__all__ = ["AMOUNT", "amount", "complaints_of", "laden"]

AMOUNT = {
    name: declared.metadata["quantity"]
    for name, declared in {
        "gap": quantity("h_gap", "m", "height of the fluid whose particles are trapped", gt=0),
        "film": quantity("h_gap", "m", "film thickness, another word for gap", gt=0),
        "particle_density": quantity("ρ_p", "kg/m^3", "density of the particles", gt=0),
        "oil_density": quantity("ρ_f", "kg/m^3", "density of the fluid", gt=0),
        "smallest": quantity("x_min", "m", "smallest diameter", gt=0),
        "largest": quantity("x_max", "m", "largest diameter", gt=0),
        "exposure": quantity("t", "s", "time for which dust settles", gt=0, hint="a day is '24 h'"),
        "share": quantity("w", "1", "part of the counted particles of this kind", gt=0, le=1),
    }.items()
}
"""The numbers that lead from a count or a concentration to an areal density."""


def amount(reader: Reader, path: str, data: Any, kind: str, own: dict[str, Key]) -> list[str]:
    """Adds the keys that lead to an areal density; what is wrong with those of the file."""
    if kind == "iso14644":
        return _settles(path, data, own)
    coded = kind in ("iso4406", "as4059", "nas1638")
    names = ["gap", "film"]
    if not coded:
        names += ["oil_density"] if kind == "test_dust" else ["oil_density", "particle_density"]
        read = plain(_concentration(f"{path}.concentration"))
        own["concentration"] = Key(read, False, 'e.g. "0.1 wt%"')
    for name in names:
        read = plain(number(reader, f"{path}.{name}", AMOUNT[name]))
        own[name] = Key(read, False, about_of(name, AMOUNT[name]))
    given = data if isinstance(data, dict) else {}
    by_volume = coded or given.get("concentration") is not None
    if by_volume:
        own["areal_density"] = own["areal_density"]._replace(required=False)

    def present(*keys: str) -> list[str]:
        return [key for key in keys if key in given]

    wrong: list[str] = []
    for pair in ((kind if coded else "concentration", "areal_density"), ("gap", "film")):
        if len(both := present(*pair)) > 1:
            rule = "only one of these can be given; remove the other"
            wrong.append(clash(path, given, both, rule))
    if by_volume and not present("gap", "film"):
        what = kind if coded else "concentration"
        rule = 'is missing: the height of the fluid whose particles are trapped, e.g. gap = "1 um"'
        wrong.append(Problem(f"{path}.gap", rule, hint=f"{what} counts them per volume"))
    if not by_volume and (idle := present(*names)):
        rule = f"has no effect without {path}.concentration"
        wrong.append(Problem(f"{path}.{idle[0]}", rule, say(given[idle[0]])))
    return wrong


def _settles(path: str, data: Any, own: dict[str, Key]) -> list[str]:
    """The same where dust settles from air: the class and the time say how many."""
    own["areal_density"] = own["areal_density"]._replace(required=False)
    if "areal_density" not in data:
        return []
    rule = "the class and the time say how many there are; remove areal_density"
    return [clash(path, data, ["iso14644", "areal_density"], rule)]


def laden(reader: Reader, path: str, values: dict[str, Any], diameter: Any) -> Particles:
    """Particles with these sizes, and the density or the concentration of the file."""
    if "concentration" not in values:
        return reader.make(Particles, path, values | {"diameter": diameter})
    found = values.pop("concentration")
    gap = values.pop("gap", values.pop("film", None))
    with complaints_of(path):
        return Particles.from_concentration(
            found.amount, by=found.by, gap=gap, diameter=diameter, **values
        )


@contextmanager
def complaints_of(path: str) -> Iterator[None]:
    """Complaints about particles, with the name of their table."""
    try:
        yield
    except InvalidValue as error:
        raise error.under(path) from None


def _concentration(path: str) -> Callable[[Any], cleanliness.Concentration]:
    def read(value: Any) -> cleanliness.Concentration:
        try:
            return cleanliness.concentration(value)
        except InvalidValue as error:
            raise InvalidValue(f"{path} = {error}") from None

    return read
