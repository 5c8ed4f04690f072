"""The table [particles], or several populations side by side, each headed [[particles]]."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import AfterValidator

from ..errors import InvalidValue, Problem
from ..populations.particles import Particles
from ..quantities.units import say, to_si
from .concentration import amount, laden
from .counted import COUNTED, counted
from .laws import particle_law
from .mistakes import clash
from .reader import Key, Reader, Table, get, reads_also
from .shape import OF_SIZES, shape
from .strength import strength
from .vocabulary import DISTRIBUTIONS

__all__ = ["TABLE", "gaps_of", "populations"]

LAW = "law of these particles, in the place of [particle_law]"


def populations(whole: dict[str, Any]) -> dict[str, Any]:
    """The tables of all populations of a file by their paths, particles or particles.0, ..."""
    given = whole.get("particles")
    if isinstance(given, list) and given:
        return {f"particles.{i}": table for i, table in enumerate(given)}
    return {"particles": given} if "particles" in whole else {}


def gaps_of(whole: dict[str, Any]) -> tuple[float | None, ...]:
    """Heights of the oil whose particles each population is [m]; None where a file has none."""
    given = [get(table, "gap") or get(table, "film") for table in populations(whole).values()]
    return tuple(None if gap is None else to_si(gap, "m") for gap in given)


@reads_also([{}])
def particles(reader: Reader, path: str, data: Any) -> Any:
    """One population, or a list of them."""
    if not (isinstance(data, list) and data):
        return _population(reader, path, data)
    named: dict[str, int] = {}
    for i, table in enumerate(data):
        name = get(table, "name")
        if isinstance(name, str) and name and named.setdefault(name, i) != i:
            reader.problems.append(
                Problem(
                    f"{path}.{i}.name",
                    f"is the name of {path}.{named[name]} as well; "
                    "results could not tell them apart",
                    say(name),
                )
            )
    several = tuple(_population(reader, f"{path}.{i}", table) for i, table in enumerate(data))
    return Annotated[tuple[several], AfterValidator(tuple)]  # type: ignore[valid-type]


@reads_also(
    *({key: ""} for key in COUNTED),
    {"sizes": {}},
    {"distribution": "weibull"},
    {"distribution": "weibull", "shape": {}},
    {"concentration": ""},
)
def _population(reader: Reader, path: str, data: Any) -> Any:
    """One population, whose sizes are a distribution or were counted."""
    own = reader.keys_of(Particles, path, data)
    own["material"] = own["material"]._replace(
        about='what the particles are made of, e.g. material = "SiO2"'
    )
    own["areal_density"] = own["areal_density"]._replace(
        about=f'{own["areal_density"].about}, or concentration = "0.1 wt%" with gap = "1 um"'
    )
    complete = strength(reader, path, get(data, "strength"), own)
    shape(reader, path, data, own)
    own["law"] = Key(_law(reader, f"{path}.law", get(data, "law")), False, LAW)
    given = [key for key in ("distribution", *COUNTED) if get(data, key) is not None]
    kind = given[0] if given else "distribution"
    wrong = amount(reader, path, data, kind, own)
    if len(given) > 1:
        wrong.append(clash(path, data, given, "each of these gives the sizes; keep one of them"))
    reader.problems += wrong
    own |= {key: Key(Any, False, "") for key in COUNTED}
    if kind != "distribution":
        return Annotated[counted(reader, path, data, kind, own, wrong), complete]

    def build(values: dict[str, Any]) -> Particles:
        if wrong:
            raise InvalidValue(*wrong)
        mine = {key: values.pop(key) for key in own if key in values}
        if OF_SIZES in mine:
            values["shape"] = mine.pop(OF_SIZES)
        diameter = reader.make(DISTRIBUTIONS[values.pop("distribution")], path, values)
        return laden(reader, path, mine, diameter)

    found = reader.variant(path, data, "distribution", DISTRIBUTIONS, build, own)
    return Annotated[found, complete]


def _law(reader: Reader, path: str, data: Any) -> Any:
    """The law of one population; its keys are known only where the file names one."""
    return particle_law(reader, path, data) if data is not None or reader.every_way else Any


TABLE = Table(name="particles", read=particles)
