"""The table [life.dry]: a dry or greased contact over time, and how long its particles stay."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any

from ..analysis.uncertainty.inputs import Uncertain
from ..contact.contact import Contact
from ..contact.evaluation import bodies_of
from ..errors import InvalidValue, Mistake, Problem
from ..quantities.units import Quantity
from ..quantities.value import quantity
from ..systems.life.debris import Debris
from ..systems.life.ingress import Ingress
from ..systems.life.surfaces import RunningIn
from ..systems.life.until import CodeReached, FilterFull, Until
from .described import BareNumber, Described
from .life_contact import HARDNESS, WORN_AREA, need_debris
from .life_dirt import ARRIVALS, dirts_of
from .life_uncertainty import FACTOR, KnownOfLife, known_of_life
from .reader import NOTHING, Key, Reader, get, quantity_key, word
from .surfaces import MATERIAL
from .vocabulary import LOADS

__all__ = ["BANDS_HARDNESS", "DRY", "AskedDry", "dry_of"]

SIDES = ("first", "second")
NEEDED = ("surfaces", "roughness", "outputs", "load")
OF_CONTACT = ("surfaces", "roughness", "asperity_law", "particle_law", "outputs", "particles")
"""Tables of a study that make its contact."""
QUANTITIES = {
    name: declared.metadata["quantity"]
    for name, declared in {
        "sliding_speed": quantity("v_s", "m/s", "sliding speed", gt=0),
        "length": quantity("L", "m", "length of the contact along the motion", gt=0, usual=10),
        "area": quantity("A_n", "m^2", "nominal area of the contact", gt=0),
        "loss": quantity(
            "1-ρ_r", "1", "part of what leaves that does not come round again", ge=0, le=1
        ),
        "stays": quantity("s_e", "1", "part of the deeply sunk particles that stays", ge=0, le=1),
    }.items()
}
LOSS = (
    "; nobody can predict it: 1 where all is swept away, near 0 in a closed track; try both with "
    "--set life.dry.loss=..."
)
BANDS_HARDNESS = "debris.hardness"


@dataclass(frozen=True, eq=False, kw_only=True)
class AskedDry:
    """What a study says of a dry contact over time.

    Parameters
    ----------
    title : str
        As in the file.
    contact : Contact
        Its particles are there when it begins.
    duration : float
        How long at most [s].
    until : tuple of Until
        What is waited for.
    conditions : dict
        Arguments of `thirdbody.life`: pressure, sliding speed, length, area, arrivals, loss.
    debris : Debris, optional
        What wear leaves behind.
    running_in : RunningIn, optional
        How roughness falls with wear.
    uncertainty : dict of str to Uncertain
        What is known of its numbers.
    drawn : KnownOfLife
        The same, and how many sets are drawn of it.
    notes : tuple of str
        What is allowed but looks like a slip.
    assumed : tuple of str
        What was taken for what the file does not say.
    stated : frozenset of str
        Dotted names of all keys that the file states.
    """

    title: str
    contact: Contact
    duration: float
    until: tuple[Until, ...] = ()
    conditions: Mapping[str, Any] = field(default_factory=dict)
    debris: Debris | None = None
    running_in: RunningIn | None = None
    uncertainty: Mapping[str, Uncertain] = field(default_factory=dict)
    drawn: KnownOfLife = field(default_factory=KnownOfLife)
    notes: tuple[str, ...] = ()
    assumed: tuple[str, ...] = ()
    stated: frozenset[str] = frozenset()

    @property
    def described_inputs(self) -> Described:
        """What the tables describe."""
        abouts = {f"life.dry.{name}": (name, about) for name, about in QUANTITIES.items()}
        abouts["load.pressure"] = ("pressure", LOADS["pressure"])
        rows = [
            BareNumber(label, about, self.conditions[name])
            for label, (name, about) in abouts.items()
            if name in self.conditions
        ]
        bodies = bodies_of(self.contact)
        bodies |= {f"arrivals {i}": arrival.material for i, arrival in enumerate(self.arrivals, 1)}
        return Described({"": self.contact}, bodies, tuple(rows))

    @property
    def arrivals(self) -> tuple[Ingress, ...]:
        """Particles that arrive in the whole contact."""
        return tuple(self.conditions["arrivals"])


@cache
def _keys() -> dict[str, Key]:
    """Keys of [life.dry]."""
    keys = {
        name: quantity_key(name, about, required=name != "stays")
        for name, about in QUANTITIES.items()
    }
    loss = keys["loss"]
    return keys | {
        "loss": loss._replace(about=loss.about + LOSS),
        "moving": word(
            SIDES, "the surface that carries what it holds out of the contact", required=True
        ),
        "arrivals": ARRIVALS._replace(required=True),
        "material": MATERIAL._replace(about="what the particles that arrive are of"),
        "worn_area": WORN_AREA,
    }


def _dry(reader: Reader, path: str, data: object) -> dict[str, object]:
    return reader.table(path, data, _keys())


DRY = Key(
    None,
    False,
    "a dry or greased contact in the place of an oil, with sliding_speed, length, area, loss, "
    "moving and arrivals; thirdbody new dry-contact writes a whole study",
    NOTHING,
    _dry,
)


def _pressure(values: Mapping[str, Any], contact: Contact) -> float:
    """The one nominal pressure of [load] [Pa]."""
    name, loads = values["load"]
    if name not in ("pressure", "F_star"):
        rule = "does not go with [life.dry], which needs pressure or F_star"
        raise InvalidValue(Problem(f"load.{name}", rule, code=Mistake.CLASH))
    if len(loads) != 1:
        rule = f"has {len(loads)} values, and a history has one"
        raise InvalidValue(
            Problem(f"load.{name}", rule, hint="--set load.pressure=...", code=Mistake.SHAPE)
        )
    return float(loads[0]) * (1.0 if name == "pressure" else contact.E_ss)


def _uncertainty(
    reader: Reader, ranges: Mapping[str, object], debris: Debris | None
) -> KnownOfLife:
    """What is known of the numbers of a dry contact, by their names as arguments."""
    numbers = {f"dry.{name}": (name, about) for name, about in QUANTITIES.items()}
    numbers |= {"arrivals": ("arrivals", FACTOR), "load.pressure": ("pressure", LOADS["pressure"])}
    if debris is not None:
        numbers[BANDS_HARDNESS] = (BANDS_HARDNESS, HARDNESS)
    some = ", ".join(f'"{name}"' for name in numbers)

    def about(label: str) -> tuple[str, Quantity | None]:
        return numbers.get(label, (label, None))

    names = f"is not a number of the dry contact; it has {some}"
    return known_of_life(reader, ranges, about, names, contact=True)


def dry_of(reader: Reader, values: dict[str, Any]) -> AskedDry:
    """The dry contact that a study asks for, from the objects that its tables stand for."""
    life_table = values["life"]
    problems = [
        Problem(
            f"life.{name}",
            "does not go with [life.dry]: one is in an oil, the other is not",
            code=Mistake.CLASH,
        )
        for name in ("oil", "filters", "contact", "design")
        if name in life_table
    ]
    if missing := [f"[{name}]" for name in NEEDED if name not in values]:
        problems.append(Problem("life.dry", f"needs {', '.join(missing)}", code=Mistake.MISSING))
    if lost := [e for e in life_table.get("until", ()) if isinstance(e, CodeReached | FilterFull)]:
        problems.append(
            Problem(
                "life.until", f"waits for what only an oil has: {lost[0].name}", code=Mistake.CLASH
            )
        )
    if problems:
        raise InvalidValue(*problems)
    parts = {name: values[name] for name in OF_CONTACT if name in values}
    if "particles" not in parts:
        parts.pop("particle_law", None)
    contact = reader.make(Contact, "", parts)
    need_debris(contact, life_table)
    conditions = dict(life_table["dry"])
    arrivals = dirts_of(
        conditions.pop("arrivals"), conditions.pop("material", None), ingress=True, of="life.dry"
    )
    conditions |= {
        "arrivals": arrivals,
        "pressure": _pressure(values, contact),
        "moving": 1 + SIDES.index(conditions["moving"]),
    }
    if contact.populations and any(
        population.law is not None for population in contact.populations
    ):
        reader.notes.append("a law in [particles] has no effect on [life]: it takes [particle_law]")
    if get(reader.whole, "film") is not None:
        reader.notes.append("[film] has no effect on [life.dry], which has no oil")
    uncertainty = _uncertainty(reader, life_table.get("uncertainty", {}), life_table.get("debris"))
    return AskedDry(
        title=values.get("title", ""),
        contact=contact,
        duration=life_table["duration"],
        until=life_table.get("until", ()),
        conditions=conditions,
        debris=life_table.get("debris"),
        running_in=life_table.get("running_in"),
        uncertainty=uncertainty.vary,
        drawn=uncertainty,
        notes=tuple(dict.fromkeys(reader.notes)),
        assumed=tuple(dict.fromkeys(reader.assumed)),
        stated=reader.stated_keys,
    )
