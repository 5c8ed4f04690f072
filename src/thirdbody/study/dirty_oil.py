"""What the particles of a study's oil do to its rolling contact: who carries, who dents, what life.

Each population acts alone in the film (`thirdbody.systems.oil_particles`); the life is that of
ISO 281 (`thirdbody.systems.bearing_life`), where [body] is a bearing that turns.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import Any

from ..contact.contact import Contact
from ..errors import InvalidValue, Mistake, NoEquilibrium, Problem, RangeWarning
from ..populations.distributions import Mixture
from ..populations.measured.cleanliness import iso4406_of
from ..populations.particles import Particles
from ..quantities.record import Record
from ..quantities.units import say
from ..systems.bearing_life import contamination_factor, life_factor, viscosity_ratio
from ..systems.film_conditions import FilmConditions
from ..systems.machine_elements import RadialBearing
from ..systems.oil_filter import Filter
from ..systems.oil_particles import FilmParticles
from .tracks import HOUR, SIDE, Track, speed_of, track_areas
from .whole import Study

__all__ = ["DirtyOil", "Life", "PopulationDents", "dirty_oil", "need_particles", "read_filter"]

DENSITY = 870.0
"""Of the oil [kg/m³], as elsewhere in study files."""


@dataclass(frozen=True, eq=False, kw_only=True)
class PopulationDents(Record):
    """Dents of one population of particles in the film.

    Attributes
    ----------
    name : str
    per_volume : float
        Particles per volume of oil [1/m³].
    load_share : float
        Of the whole load, the film's included [1].
    per_overrolling : float
        Dents per area of track each time that a body rolls over it [1/m²].
    per_hour : float
        Dents in the whole track per hour [1].
    depth, depth_p95, width : float
        Mean depth, depth that 5 % of the dents exceed, mean diameter [m]; depths are NaN where
        particles are flattened.
    deepest : float
        Depth of the deepest dent of an hour (median) [m].
    """

    name: str
    per_volume: float
    load_share: float
    per_overrolling: float
    per_hour: float
    depth: float
    depth_p95: float
    width: float
    deepest: float


@dataclass(frozen=True, eq=False, kw_only=True)
class Life(Record):
    """Life of a bearing in its oil by ISO 281.

    Attributes
    ----------
    kappa : float
        Viscosity ratio κ [1].
    code : str
        ISO 4406 code of all particles together.
    place : str
        Row of the contamination factor: "bath" or "filter".
    e_C, a_ISO, clean : float
        Contamination factor, life factor, and that of clean oil, e_C = 1 [1]; NaN with ``why``.
    hours : float
        Rating life a_ISO L_10 [h].
    load_over_rating : float
        Equivalent load over the basic dynamic load rating, P/C [1].
    why : str
        Why there is no factor.
    """

    kappa: float
    code: str
    place: str
    e_C: float = math.nan
    a_ISO: float = math.nan
    clean: float = math.nan
    hours: float = math.nan
    load_over_rating: float = math.nan
    why: str = ""


@dataclass(frozen=True, eq=False, kw_only=True)
class DirtyOil(Record):
    """What the particles of the oil do; made by `dirty_oil`.

    Attributes
    ----------
    where : str
        The track in which dents are counted.
    speed, load, film, lambda_ratio : float
        Rolling speed [m/s], load on the contact [N], film h_T [m], h_T/σ [1].
    film_share, asperity_share, particle_share : float
        Of the load [1].
    populations : tuple of PopulationDents
    life : Life or None
        None where [body] is no bearing that turns.
    from_size : float
        Behind a filter, the size from which its data sheet says what it holds [m].
    most_per_hour : float
        Dents per hour if it held nothing below that size [1].
    """

    where: str
    speed: float
    load: float
    film: float
    lambda_ratio: float
    film_share: float
    asperity_share: float
    particle_share: float
    populations: tuple[PopulationDents, ...]
    life: Life | None = None
    from_size: float = math.nan
    most_per_hour: float = math.nan


def read_filter(text: str) -> Filter:
    """A filter as the option ``--filter`` writes it, "5=75, 10=1000"; raises with its name."""
    try:
        return Filter.from_text(text)
    except InvalidValue as error:
        first = error.problems[0]
        bare = first.changed(owner="") if first.owner == "Filter" else first
        raise InvalidValue(Problem("--filter", f": {bare}", say(text), code=first.code)) from None


def need_particles(study: Study) -> None:
    """Refuse a filter where it has nothing to hold."""
    if study.film is None or study.contact.two_body:
        lacks = "[film]" if study.film is None else "[particles]"
        raise InvalidValue(
            Problem(
                "--filter",
                f"has nothing to hold: the study has no table {lacks}",
                code=Mistake.MISSING,
            )
        )


def dirty_oil(study: Study, *, filter: Filter | None = None) -> DirtyOil | None:
    """What the particles of the oil do to the rolling contact of a study, behind a filter or not.

    Parameters
    ----------
    study : Study
        With a table [film] and particles.
    filter : Filter, optional
        Through which the oil comes.

    Returns
    -------
    DirtyOil or None
        None for a study without film or without particles, and where no state was found.

    Notes
    -----
    Of several speeds that of [body] counts, else the middle one. Dents are those of surface 2.
    The film is that of the most loaded body, everywhere on the track. Behind a filter ISO 281's
    rows of oil with an on-line filter hold, without one those of an oil bath.

    Examples
    --------
    >>> from thirdbody.study.dirty_oil import dirty_oil
    >>> import warnings; warnings.simplefilter("ignore")
    >>> from importlib import resources
    >>> from thirdbody import load_study
    >>> from thirdbody.systems.oil_filter import Filter
    >>> file = resources.files("thirdbody").joinpath("data/studies/ball-bearing.toml")
    >>> study = load_study(file)
    >>> before = dirty_oil(study)
    >>> after = dirty_oil(study, filter=Filter.from_text("5=75, 10=1000"))
    >>> before.life.code, after.life.code, before.life.a_ISO < after.life.a_ISO
    ('18/16/13', '13/9/3', True)
    """
    film, contact = study.film, study.contact
    if film is None or contact.two_body:
        return None
    gaps = dict(enumerate(study.gaps))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        speed = speed_of(study.body, film)
        before, leaky = contact.populations, None
        if filter is not None:
            leaky = _behind_filter(contact, filter, goes_on=False)
            contact = _behind_filter(contact, filter)
        try:
            state = film.at(contact, speed=speed)
        except (InvalidValue, NoEquilibrium):  # run_film says why
            return None
        h = float(state.h_T)
        solids = 1 - float(state.film_share)
        shares = [float(population.load_share) for population in state.state.populations]
        shares = shares or [float(state.state.particle_load_share)]
        force = None if study.forces is None else float(study.forces[0])
        rate, area, where = track_areas(study.body, force, film, E_star=contact.E_ss, speed=speed)
        track = Track(
            name=where, surfaces=contact.surfaces, film=h, rate=rate, area=area,
            entry=1.0 if film.entrainment is None else film.entrainment.entry_ratio,
        )  # fmt: skip

        def particles(i: int, population: Particles) -> FilmParticles:
            density = population.areal_density / (gaps.get(i) or h)
            return track.particles(
                population.material, population.diameter, density, population.strength
            )

        parts = []
        for i, population in enumerate(contact.populations):
            dents = particles(i, population)
            side_dents = dents.dents(SIDE)
            parts.append(
                PopulationDents(
                    name=before[i].name or before[i].material.name or f"particles {i + 1}",
                    per_volume=dents.number,
                    load_share=solids * shares[i],
                    per_overrolling=side_dents.number,
                    per_hour=track.per_hour(side_dents),
                    depth=side_dents.depth,
                    depth_p95=side_dents.depth_p95,
                    width=side_dents.diameter,
                    deepest=track.deepest(dents),
                )
            )
        most: dict[str, float] = {}
        if filter is not None and leaky is not None:
            some = enumerate(leaky.populations)
            more = sum(
                track.per_hour(particles(i, population).dents(SIDE)) for i, population in some
            )
            most = {"from_size": filter.sizes[0], "most_per_hour": more}
        return DirtyOil(
            where=where,
            speed=speed,
            load=film.load,
            film=h,
            lambda_ratio=float(state.lambda_ratio),
            film_share=float(state.film_share),
            asperity_share=float(state.ss_share),
            particle_share=float(state.sa_share),
            populations=tuple(parts),
            life=_life(study, film, contact, parts, filter),
            **most,
        )


def _behind_filter(contact: Contact, filter: Filter, *, goes_on: bool = True) -> Contact:
    """The contact with the particles that come through a filter."""
    behind = []
    for population in contact.populations:
        number, sizes = filter.behind(
            population.areal_density, population.diameter, goes_on=goes_on
        )
        behind.append(population.replace(areal_density=number, diameter=sizes))
    return contact.replace(particles=tuple(behind) if len(behind) > 1 else behind[0])


def _life(
    study: Study,
    film: FilmConditions,
    contact: Contact,
    parts: list[PopulationDents],
    filter: Filter | None,
) -> Life | None:
    """Life factors where [body] is a bearing that turns."""
    body: Any = study.body
    turns_not = not isinstance(body, RadialBearing) or body.shaft_speed is None
    if turns_not or study.forces is None:
        return None
    turns, D, P = body.shaft_speed / (2 * math.pi), body.pitch_diameter, float(study.forces[0])
    numbers = [dents.per_volume for dents in parts]
    sizes = [population.diameter for population in contact.populations]
    mixed = Mixture(parts=tuple(sizes), weights=tuple(numbers)) if len(sizes) > 1 else sizes[0]
    code = iso4406_of(density=sum(numbers), diameter=mixed)
    kappa = viscosity_ratio(film.oil.eta / DENSITY, turns=turns, D=D)
    place = "bath" if filter is None else "filter"
    keywords: dict[str, Any] = {"kappa": kappa, "code": code, "place": place}
    try:
        e_C = contamination_factor(place, code, kappa=kappa, D=D)
        fatigue_ratio = body.fatigue_load / P
        a_ISO = life_factor(body.rated_as, kappa=kappa, load=e_C * fatigue_ratio)
        clean = life_factor(body.rated_as, kappa=kappa, load=fatigue_ratio)
    except InvalidValue as error:
        return Life(**keywords, why=error.problems[0])
    exponent = 3.0 if body.rated_as == "ball" else 10 / 3
    hours = float(a_ISO * (body.rating / P) ** exponent * 1e6 / (turns * HOUR))
    keywords |= {"e_C": e_C, "a_ISO": a_ISO, "clean": clean}
    return Life(**keywords, hours=hours, load_over_rating=P / body.rating)
