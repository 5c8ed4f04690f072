"""The tables [life.contact], [life.debris] and [life.running_in]: what acts in the oil."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ..contact.contact import Contact
from ..errors import InvalidValue, Mistake, Problem
from ..quantities.say import join_words, value_of
from ..quantities.value import quantity
from ..systems.bodies import Body
from ..systems.film_conditions import FilmConditions
from ..systems.life.debris import Debris, wears
from ..systems.life.surfaces import RunningIn
from ..systems.life.until import ContactUntil
from ..systems.machine_elements import RadialBearing
from .film import on_body
from .reader import (
    NOTHING,
    Key,
    Reader,
    get,
    quantity_key,
    read_number,
    read_numbers,
    table_of,
    word,
    wrong,
)
from .tracks import track_areas
from .vocabulary import DISTRIBUTIONS

__all__ = ["BOUNDARY", "CONTACT_KEYS", "LifeContact", "Rolling", "contact_of", "rolling_of"]

BOUNDARY, AS_SURFACE = "boundary-lubricated", "as surface"
OF_CONTACT = ("surfaces", "roughness", "asperity_law", "particle_law", "outputs")
"""Tables of a study that make its contact; its particles are those of the oil."""
QUANTITIES = {
    name: declared.metadata["quantity"]
    for name, declared in {
        "entry_ratio": quantity(
            "ε", "1", "particles that enter the contact over those in the oil that passes", gt=0
        ),
        "contacts": quantity("N", "1", "contacts in the oil", gt=0),
        "particle_friction": quantity("μ", "1", "friction that drags particles in", gt=0),
        "stays": quantity("s_e", "1", "part of the deeply sunk particles that stays", ge=0, le=1),
    }.items()
}
HARDNESS = quantity("H_d", "Pa", "hardness of the debris", gt=0).metadata["quantity"]
WORN = quantity("A_w", "m^2", "area that is worn in turn", gt=0).metadata["quantity"]
FILM_NEEDS = (
    "[film] with oil, and with conjunction, load and speed where no [body] under load.force has "
    "them"
)
RANGES = (
    "nobody can predict it: count dents (entry_ratio_from_dents), or try it from 1e-3 to 1 with "
    "--set life.contact.entry_ratio=..."
)


@dataclass(frozen=True, eq=False, kw_only=True)
class LifeContact:
    """The contacts that an oil goes through, as a study says them.

    Parameters
    ----------
    contact : Contact
        Without particles, which are those of the oil.
    conditions : dict
        Of the film and of what enters it, arguments of `thirdbody.life`.
    debris : Debris, optional
        What wear leaves behind.
    running_in : RunningIn, optional
        How roughness falls with wear.
    """

    contact: Contact
    conditions: Mapping[str, Any] = field(default_factory=dict)
    debris: Debris | None = None
    running_in: RunningIn | None = None


def _read_worn(reader: Reader, path: str, value: object) -> tuple[float, float]:
    """Areas of both surfaces."""
    if not isinstance(value, list) or len(value) != 2:
        raise wrong(
            path,
            'must be two areas, first and second, e.g. ["10 cm^2", "1 cm^2"]',
            value,
            code=Mistake.SHAPE,
        )
    first, second = read_numbers(WORN, reader, path, value)
    return first, second


WORN_AREA = Key(
    _read_worn,
    about='area of each surface that is worn in turn, e.g. ["10 cm^2", "1 cm^2"]: a whole track, '
    "and a pin",
    schema={"type": "array", "items": quantity_key("worn_area", WORN).schema},
)


def need_debris(contact: Contact, life: Mapping[str, object]) -> None:
    """Refuse surfaces that wear where [life.debris] does not say what they lose."""
    if wears(contact) and "debris" not in life:
        rule = "is missing: surfaces wear, and what they lose has sizes that nobody can predict"
        hint = (
            f'sizes = "{BOUNDARY}" is an estimate, and a table '
            '{ distribution = "log-normal", median = "1 um", gsd = 1.6 } your own'
        )
        raise InvalidValue(Problem("life.debris.sizes", rule, hint=hint, code=Mistake.MISSING))


def _contact(reader: Reader, path: str, data: object) -> dict[str, object]:
    """What enters the contacts."""
    keys = {name: quantity_key(name, about) for name, about in QUANTITIES.items()}
    ratio = keys["entry_ratio"]
    keys["entry_ratio"] = ratio._replace(required=True, about=f"{ratio.about}; {RANGES}")
    keys["worn_area"] = WORN_AREA
    keys["entry_height"] = word(("size", "film"), "height of oil that brings a particle")
    return reader.table(path, data, keys)


def _sizes(reader: Reader, path: str, value: object) -> Debris:
    """The word of the one estimate there is."""
    if value != BOUNDARY:
        table = '{ distribution = "log-normal", median = "1 um", gsd = 1.6 }'
        raise wrong(
            path, f'must be "{BOUNDARY}" or a table, e.g. {table}', value, code=Mistake.KIND
        )
    return Debris.boundary_lubricated()


def _distribution(reader: Reader, path: str, data: object) -> object:
    """Sizes of debris as a distribution."""

    def build(values: dict[str, Any]) -> Debris:
        kind = DISTRIBUTIONS[values.pop("distribution")]
        return Debris(diameter=reader.make(kind, path, values))

    return reader.variant(path, data, "distribution", DISTRIBUTIONS, build)


def _hardness(reader: Reader, path: str, value: object) -> float | None:
    """A hardness, or that of the surface."""
    return None if value == AS_SURFACE else read_number(HARDNESS, reader, path, value)


def _debris(reader: Reader, path: str, data: object) -> Debris:
    """What wear leaves behind."""
    keys = {
        "sizes": Key(
            _sizes,
            True,
            f'sizes of the debris, which nobody can predict: "{BOUNDARY}" (an estimate), or a '
            "distribution",
            {"enum": [BOUNDARY]},
            _distribution,
            ({"distribution": "log-normal"},),
        ),
        "hardness": Key(
            _hardness, about=f'"{AS_SURFACE}", or a hardness', schema={"type": ["number", "string"]}
        ),
    }

    def build(values: dict[str, Any]) -> Debris:
        return values["sizes"].replace(hardness=values.get("hardness"))

    return reader.table(path, data, keys, build)


CONTACT_KEYS = {
    "contact": Key(
        None,
        False,
        "contacts that the oil goes through, with entry_ratio; they need [surfaces], [roughness], "
        "[outputs.friction], [outputs.wear] and [film]; load and speed may follow from [body]",
        NOTHING,
        _contact,
    ),
    "debris": Key(None, False, 'what wear leaves behind, with sizes = "..."', NOTHING, _debris),
    "running_in": table_of(RunningIn, "how roughness falls with wear"),
}
"""Keys of [life] that a contact in the oil has."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Rolling:
    """What rolls in an oil: a contact, its film, and the body whose contacts they are.

    Parameters
    ----------
    contact : Contact
        Without particles, which are those of the oil.
    film : FilmConditions
    body : Body, optional
    force : float, optional
        On the body [N].
    """

    contact: Contact
    film: FilmConditions
    body: Body | None = None
    force: float | None = None

    @property
    def contacts(self) -> float:
        """Contacts as the most loaded one that sweep as much as all of the body [1]."""
        E_star, film = self.contact.E_ss, self.film
        area, _, _ = track_areas(self.body, self.force, film, E_star=E_star, speed=1.0)
        return area / (2 * float(film.conjunction.semi_axes(film.load, E=2 * E_star)[1]))

    @property
    def worn_area(self) -> tuple[float, float]:
        """What wears in turn in a bearing: its balls or rollers, and the track [m²]."""
        assert isinstance(self.body, RadialBearing)
        _, track, _ = track_areas(
            self.body, self.force, self.film, E_star=self.contact.E_ss, speed=1.0
        )
        return self.body.rolling_area, track


def rolling_of(reader: Reader, values: dict[str, Any]) -> Rolling | None:
    """What rolls in the oil of a study; None where surfaces, roughness or film are not given."""
    if any(name not in values for name in ("surfaces", "roughness", "film")):
        return None
    parts = {name: values[name] for name in OF_CONTACT if name in values}
    parts.pop("particle_law", None)
    contact = reader.make(Contact, "", parts)
    body = values.get("body")
    name, loads = values.get("load", ("", None))
    forces = loads if name == "force" else None
    film = on_body(reader, values["film"], body, forces, contact.E_ss)
    assert film is not None
    if get(reader.whole, "particles") is not None:
        reader.notes.append("[particles] has no effect on [life]: the oil brings its particles")
    one = None if forces is None or len(forces) != 1 else float(forces[0])
    return Rolling(contact=contact, film=film, body=None if one is None else body, force=one)


def contact_of(
    reader: Reader, values: dict[str, Any], rolling: Rolling | None
) -> LifeContact | None:
    """The contacts in the oil of a study; None where it has no [life.contact]."""
    life_table = values["life"]
    if "contact" not in life_table:
        for name in ("debris", "running_in"):
            if name in life_table:
                rule = "has no effect without [life.contact], with entry_ratio"
                raise InvalidValue(Problem(f"life.{name}", rule, code=Mistake.IDLE))
        idle = [event for event in life_table.get("until", ()) if isinstance(event, ContactUntil)]
        if idle:
            rule = "has no effect without [life.contact], with entry_ratio"
            raise InvalidValue(
                Problem(f"life.until.{idle[0].name.replace(' ', '_')}", rule, code=Mistake.IDLE)
            )
        return None
    missing = [f"[{name}]" for name in ("surfaces", "roughness", "outputs") if name not in values]
    missing += [] if rolling is not None else [FILM_NEEDS]
    if missing:
        raise InvalidValue(
            Problem("life.contact", f"needs {', '.join(missing)}", code=Mistake.MISSING)
        )
    assert rolling is not None
    contact, film = rolling.contact, rolling.film
    need_debris(contact, life_table)
    conditions = {
        "conjunction": film.conjunction,
        "lubricant": film.oil,
        "load": film.load,
        "speed": film.speed[len(film.speed) // 2],
        "film": film.formula,
        "hertz": film.hertz,
        "slide_roll": film.slide_roll or 0.0,
    }
    given_here = dict(life_table["contact"])
    if "contacts" not in given_here and rolling.body is not None:
        given_here["contacts"] = rolling.contacts
        reader.assumed.append(
            f"life.contact.contacts = {given_here['contacts']:.3g}: as many contacts as the most "
            f"loaded one of [body] sweep as much of {rolling.body.track} as all that carry"
        )
    body = rolling.body
    if isinstance(body, RadialBearing) and "worn_area" not in given_here and wears(contact):
        worn = given_here["worn_area"] = rolling.worn_area
        both = join_words([f"{value_of(area, 'm^2', 3)}" for area in worn])
        reader.assumed.append(
            f"life.contact.worn_area: {both} are worn in turn, all {body.rolling_bodies} wherever "
            f"they turn, and the track of {body.track}"
        )
    return LifeContact(
        contact=contact,
        conditions=conditions | given_here,
        debris=life_table.get("debris"),
        running_in=life_table.get("running_in"),
    )
