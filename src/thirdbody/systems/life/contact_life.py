"""Runs of a history with a contact: arguments checked, tables made, the course, the record."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...contact.contact import Contact
from ...errors import InvalidValue, Mistake, Note, Problem
from ...quantities.say import number
from ..mixed_film import FEW, MOST, check_lubricated
from .breeding import births_and_losses
from .circuit import OilCircuit
from .conditions import ContactInUse, DryConditions, FilmConditions
from .contact_course import DRAINED, ContactCourse, Visited
from .contact_history import (
    COLUMNS,
    ContactHistory,
    DryHistory,
    contact_columns,
)
from .contact_tables import ContactTables, Kind, contact_tables
from .debris import Debris, wears
from .dry_loop import ARRIVED, LEFT, DryLoop
from .film_loop import FRESH, INGRESS, FilmLoop
from .history import LifeHistory
from .ingress import Ingress
from .kept_rates import KeptRates
from .ledger import Ledger
from .loop import FINER, Loop, Setting
from .oil_history import kept_times, need_oil_left, run_oil_history, usual_times
from .size_classes import SizeClasses, sizes_of
from .surfaces import RunningIn
from .until import ContactUntil, Until

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ...populations.materials import Material
    from ...populations.strength import WeibullStrength

    Array = NDArray[np.float64]

__all__ = ["run_dry_history", "run_film_history"]

CROWDED = 0.3
"""Part of the area that particles may cover before they hinder each other."""


# ------------------------------------------------------------------ what is common
def _check(use: ContactInUse) -> None:
    contact, debris, running_in = use.contact, use.debris, use.running_in
    problems: list[Problem] = []
    if not isinstance(contact, Contact):
        raise InvalidValue(
            Problem("contact", "must be a Contact", repr(contact), code=Mistake.KIND)
        )
    if wears(contact) and debris is None:
        rule = "is missing: surfaces wear, and what they lose has sizes that nobody can predict"
        hint = "Debris.from_report, or Debris.boundary_lubricated() as an estimate"
        problems.append(Problem("debris", rule, hint=hint, code=Mistake.MISSING))
    if not isinstance(debris, Debris | None):
        problems.append(
            Problem("debris", "must be Debris, or None", repr(debris), code=Mistake.KIND)
        )
    if not isinstance(running_in, RunningIn | None):
        problems.append(
            Problem("running_in", "must be RunningIn, or None", repr(running_in), code=Mistake.KIND)
        )
    if isinstance(debris, Debris):
        pair = contact.surfaces
        for side, body in ((1, pair.first), (2, pair.second)):
            if body.density is None:
                rule = "is missing: the mass of debris is counted [kg/m^3]"
                hint = "give material.replace(density=...), e.g. 7850 for steel"
                problems.append(
                    Problem(f"density of surface {side}", rule, hint=hint, code=Mistake.MISSING)
                )
    if problems:
        raise InvalidValue(*problems)


def _debris_materials(use: ContactInUse) -> dict[str, Material]:
    if (debris := use.debris) is None:
        return {}
    pair = use.contact.surfaces
    return {
        "debris 1": debris.material(pair.first, name="debris 1"),
        "debris 2": debris.material(pair.second, name="debris 2"),
    }


def _tables(use: ContactInUse, classes: SizeClasses, kinds: Sequence[Kind]) -> ContactTables:
    """Tables of the contact alone; where it runs in, σ may fall to a fifth."""
    sigma, span = use.contact.roughness.sigma, None
    if use.running_in is not None:
        span = sigma, max(use.running_in.sigma_end, 0.2 * sigma)
    return contact_tables(use.contact.replace(particles=None), classes, tuple(kinds), span)


def _setting(
    use: ContactInUse, tables: ContactTables, *, sliding_speed: float, area: float
) -> Setting:
    names, debris = [kind.name for kind in tables.kinds], use.debris
    return Setting(
        sliding_speed=sliding_speed,
        area=area,
        worn_area=(area, area) if use.worn_area is None else use.worn_area,
        shares=np.zeros(tables.classes.count) if debris is None else debris.shares(tables.classes),
        debris=(-1, -1) if debris is None else (names.index("debris 1"), names.index("debris 2")),
        stays=use.stays,
        running_in=use.running_in,
    )


def _start(loop: Loop, numbers: Array) -> Array:
    y = np.zeros(loop.layout.count)
    y[loop.layout[loop.pool]] = numbers
    y[loop.layout["sigma"]] = loop.tables.contact.roughness.sigma
    return y


def _masses(loop: Loop) -> Array:
    """Density of each kind [kg/m³]."""
    return np.array([kind.material.density or math.nan for kind in loop.tables.kinds])


def _ledger(loop: Loop, seen: Visited, came: Sequence[str], went: Sequence[str]) -> Ledger:
    states, density = seen.states, _masses(loop)

    def flow(name: str) -> Array:
        return np.array([float(loop.flow(y, name) @ density) for y in states])

    pool = np.array(
        [
            float(
                loop.shape_numbers(y[loop.layout[loop.pool]] * loop.volumes).sum(axis=1) @ density
            )
            for y in states
        ]
    )
    stored = np.array([float(loop.stored_volumes(y) @ density) for y in states])
    columns_in = {name: flow(name) for name in (*came, "worn 1", "worn 2")}
    columns_out = {name: flow(name) for name in (*went, FINER)}
    if FRESH in columns_in:
        columns_in[FRESH] = columns_in[FRESH] + np.array(seen.filled) @ density
        columns_out[DRAINED] = np.array(seen.drained) @ density
    if loop.setting.stays > 0:
        columns_out["embedded"] = stored - pool
    return Ledger(in_oil=pool, came=columns_in, went=columns_out)


def _notes(
    loop: Loop, more: dict[str, Array], use: ContactInUse, *, entry_ratio: float | None = None
) -> list[Note]:
    out = [] if use.debris is None else use.debris.notes(loop.tables.classes)
    fewest = float(np.min(more["present"]))
    if fewest < 1:
        what = (
            f"a contact holds {number(fewest, 2)} loaded particles on average: the history has "
            "mean rates; modes and shares of the particles at one moment have no meaning"
        )
        out.append(Note(what, code="life.single", effect=0.0))
    if entry_ratio == 1:
        what = "the entry ratio is assumed to be 1: surfaces that lasted show far fewer dents"
        action = "count dents, and take entry_ratio_from_dents"
        out.append(Note(what, code="life.entry", action=action))
    if use.worn_area is None:
        what = "wear depths are as if the same place of each surface were always in contact"
        action = "give worn_area, the area of each surface that is worn in turn"
        out.append(Note(what, code="life.worn_area", action=action))
    if (most := float(np.max(more["covered"]))) > CROWDED:
        what = f"particles cover up to {number(most, 2)} of the contact: they hinder each other"
        out.append(Note(what, code="life.crowded", action="sums of single particles end there"))
    if loop.setting.stays > 0:
        what = "a part of the deep particles stays embedded: nobody can predict how many do"
        out.append(Note(what, code="life.stays"))
    law = loop.setting.running_in
    if law is not None:
        how = "over the length that is given" if law.length is not None else "by what is removed"
        what = f"the roughness runs in {how}, towards an end that no theory gives"
        out.append(Note(what, code="life.running_in"))
    if loop.tables.error > 1e-4:
        what = f"the tables of the contact are good to {number(loop.tables.error, 2)} only"
        out.append(Note(what, code="life.tables", effect=loop.tables.error))
    return out


def _more(columns: dict[str, Array], leave_out: Sequence[str]) -> dict[str, Any]:
    return {
        name: (COLUMNS[name], values) for name, values in columns.items() if name not in leave_out
    }


def _by_class(loop: Loop, matrix: Array) -> Array:
    """A matrix of the loop in the order of classes and materials, (J, J)."""
    order = np.arange(len(loop.volumes)).reshape(loop.kinds, loop.classes).T.ravel()
    return matrix[np.ix_(order, order)]


# ------------------------------------------------------------------ in a film
def run_film_history(
    use: ContactInUse,
    film: FilmConditions,
    *,
    oil: OilCircuit,
    duration: float,
    until: Sequence[Until],
    times: ArrayLike | None,
    kept: KeptRates,
) -> LifeHistory:
    """The history of an oil and of alike contacts in it; arguments as in `thirdbody.life`."""
    _check(use)
    need_oil_left(oil, duration)
    contact, debris = use.contact, use.debris
    if contact.populations:
        rule = "are those of the oil: remove them from the contact"
        raise InvalidValue(Problem("contact.particles", rule, code=Mistake.CLASH))
    more_materials = _debris_materials(use)
    others = () if debris is None else (debris.diameter,)
    classes = oil.size_classes(*others)
    terms = oil.terms(classes=classes, materials=more_materials)
    bodies = check_lubricated(
        contact, film.conjunction, film.lubricant, np.array([film.load]), film.film,
        film.slide_roll, film.hertz, (FEW, MOST),
    )  # fmt: skip
    kinds = [
        Kind(name=name, material=material, strength=film.strengths.get(material))
        for name, material in terms.materials.items()
    ]
    tables = _tables(use, classes, kinds)
    area = film.contacts * float(film.conjunction.hertz(film.load, E=2 * contact.E_ss).area)
    setting = _setting(use, tables, sliding_speed=film.slide_roll * film.speed, area=area)
    loop = FilmLoop(tables, setting, film, bodies=bodies, terms=terms, volume=oil.volume)
    alone = None
    if debris is None and use.stays == 0 and not film.strengths:
        # nothing comes from the contact: the oil runs as it does alone, exactly
        alone = run_oil_history(oil, duration=duration, until=_of_oil(until), times=times)
        times = alone.times
        duration = float(alone.times[-1])
    if times is None:
        shortest = 1e-2 * oil.volume / max(float(np.max(terms.loss)), 1e-300)
        times = usual_times(duration, shortest=shortest)
    some = kept_times(times, duration=duration)
    start = _start(loop, oil.volume * terms.start.T.ravel())
    course = ContactCourse(
        loop, start, duration=duration, times=some,
        until=() if alone is not None else until, circuit=oil, kept=kept,
    )  # fmt: skip
    seen = course.run()
    columns = contact_columns(loop, np.array(seen.times), seen.states, kept)
    notes = _notes(loop, columns, use, entry_ratio=film.entry_ratio)
    births, losses = (_by_class(loop, rates) for rates in births_and_losses(loop, seen.states[-1]))
    moments = np.array(seen.times)
    numbers = np.array([loop.shape_numbers(y[loop.layout["oil"]]).T for y in seen.states])
    volume = loop.volume + loop.growth * moments
    numbers = numbers / volume[:, None, None]
    events, warned = course.events, tuple(oil.notes())
    ledger = _ledger(loop, seen, (INGRESS, FRESH), loop.removals)
    if alone is not None:
        place = np.searchsorted(moments, alone.times).clip(max=len(moments) - 1)
        columns = {name: values[place] for name, values in columns.items()}
        moments, numbers, volume = alone.times, alone.numbers, alone.volume
        ledger, events = alone.ledger, list(alone.events)
    return ContactHistory(
        circuit=oil,
        terms=terms,
        times=moments,
        volume=volume,
        numbers=numbers,
        ledger=ledger,
        events=tuple(events),
        warnings=(*warned, *notes),
        more=_more(columns, ()),
        births=births,
        losses=losses,
        loop=loop,
        last_state=seen.states[-1],
    )


def _of_oil(until: Sequence[Until]) -> tuple[Until, ...]:
    return tuple(goal for goal in until if not isinstance(goal, ContactUntil))


# ------------------------------------------------------------------ dry
def run_dry_history(
    use: ContactInUse,
    dry: DryConditions,
    *,
    duration: float,
    until: Sequence[Until],
    times: ArrayLike | None,
    kept: KeptRates,
) -> DryHistory:
    """The history of a dry or greased contact; arguments as in `thirdbody.life`."""
    _check(use)
    contact, arrivals = use.contact, dry.arrivals
    if wrong := [
        arrival for arrival in arrivals if not isinstance(arrival, Ingress) or arrival.rate is None
    ]:
        rule = "must be Ingress with a rate [1/s], particles into the whole contact"
        raise InvalidValue(Problem("arrivals", rule, repr(wrong[0]), code=Mistake.KIND))
    dirt: dict[Material, WeibullStrength | None] = {}
    for population in contact.populations:
        dirt[population.material] = population.strength
    for arrival in arrivals:
        dirt.setdefault(arrival.material, None)
    kinds = [
        Kind(name=f"{material.name or 'particles'} {i + 1}" if i else material.name or "particles",
             material=material, strength=strength)
        for i, (material, strength) in enumerate(dirt.items())
    ]  # fmt: skip
    kinds += [Kind(name=n, material=m) for n, m in _debris_materials(use).items()]
    diameters = [population.diameter for population in contact.populations]
    diameters += [arrival.diameter for arrival in arrivals]
    if use.debris is not None:
        diameters.append(use.debris.diameter)
    if (classes := dry.classes) is None:
        ends = [sizes_of(diameter) for diameter in diameters] or [(0.25e-6, 64e-6)]
        classes = SizeClasses.covering(
            smallest=min(a for a, _ in ends), largest=max(b for _, b in ends)
        )
    tables = _tables(use, classes, kinds)
    setting = _setting(use, tables, sliding_speed=dry.sliding_speed, area=dry.area)
    place = {material: i for i, material in enumerate(dirt)}
    coming = np.zeros((len(kinds), classes.count))
    for arrival in arrivals:
        assert arrival.rate is not None
        count = classes.numbers_of if arrival.kept == "number" else classes.numbers_by_volume
        coming[place[arrival.material]] += count(arrival.rate, arrival.diameter)
    present = np.zeros((len(kinds), classes.count))
    for population in contact.populations:
        present[place[population.material]] += classes.numbers_of(
            population.areal_density * dry.area, population.diameter
        )
    loop = DryLoop(
        tables, setting, pressure=dry.pressure, length=dry.length, arrivals=coming.ravel(),
        loss=dry.loss, moving=dry.moving,
    )  # fmt: skip
    if times is None:
        times = usual_times(duration, shortest=0.1 * dry.length / dry.sliding_speed)
    course = ContactCourse(
        loop, _start(loop, present.ravel()), duration=duration,
        times=kept_times(times, duration=duration), until=until, kept=kept,
    )  # fmt: skip
    seen = course.run()
    columns = contact_columns(loop, np.array(seen.times), seen.states, kept)
    births, losses = (_by_class(loop, rates) for rates in births_and_losses(loop, seen.states[-1]))
    numbers = (
        np.array([loop.shape_numbers(y[loop.layout["contact"]]).T for y in seen.states]) / dry.area
    )
    absent = ("film_share", *(f"{name}_{side}" for name in ("dents", "thrown") for side in (1, 2)))
    return DryHistory(
        loop=loop,
        last_state=seen.states[-1],
        times=np.array(seen.times),
        numbers=numbers,
        materials=tuple(kind.name for kind in kinds),
        ledger=_ledger(loop, seen, (ARRIVED,), (LEFT,)),
        births=births,
        losses=losses,
        events=tuple(course.events),
        warnings=tuple(_notes(loop, columns, use)),
        more=_more(columns, absent),
    )
