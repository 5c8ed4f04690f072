"""Tracks over which bodies roll in an oil, and the dents that its particles leave there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from ..contact.contact import Contact
from ..populations.distributions import Distribution
from ..populations.materials import Material, MaterialPair
from ..populations.strength import WeibullStrength
from ..systems.bodies import Body
from ..systems.film_conditions import FilmConditions
from ..systems.machine_elements import RINGS, RadialBearing
from ..systems.oil_particles import FilmDents, FilmParticles

__all__ = ["Track", "speed_of", "track_areas", "tracks_of"]

HOUR = 3600.0
SIDE = 2
"""The surface whose dents are told: the ring, the screw, the gear."""


@dataclass(frozen=True, kw_only=True)
class Track:
    """A track, its film, and how much of it bodies roll over.

    Parameters
    ----------
    name : str
        "the inner ring".
    surfaces : MaterialPair
    film : float
        Height h_T [m].
    rate : float
        Area rolled over per time [m²/s].
    area : float
        Of the whole track [m²].
    entry : float
        Particles that enter over those in the oil that passes ε [1].
    """

    name: str
    surfaces: MaterialPair
    film: float
    rate: float
    area: float
    entry: float

    def particles(
        self,
        material: Material,
        diameter: Distribution,
        number: float,
        strength: WeibullStrength | None = None,
    ) -> FilmParticles:
        """Particles of an oil in the film of the track."""
        return FilmParticles(
            surfaces=self.surfaces,
            material=material,
            diameter=diameter,
            number=number,
            film=self.film,
            entry=self.entry,
            strength=strength,
        )

    def per_hour(self, dents: FilmDents) -> float:
        """Dents in the whole track per hour [1]."""
        return dents.number * self.rate * HOUR

    def deepest(self, particles: FilmParticles) -> float:
        """Depth of the deepest dent of an hour (median) [m]."""
        overrollings = self.rate * HOUR / self.area
        return float(particles.largest(self.area, overrollings=overrollings, side=SIDE).depth)


def speed_of(body: Body | None, film: FilmConditions) -> float:
    """Rolling speed of a body, else the middle one of the film [m/s]."""
    speed = None if body is None else body.rolling_speed
    return speed if speed is not None else film.speed[len(film.speed) // 2]


def track_areas(
    body: Body | None, force: float | None, film: FilmConditions, *, E_star: float, speed: float
) -> tuple[float, float, str]:
    """Area of track rolled over per second [m²/s], area of the whole track [m²], and its name."""
    if isinstance(body, RadialBearing) and force is not None:
        share = body.share_load(force, E_star)
        area = body.track_area(share, body.ring, E_star)
        return body.swept_area(share, body.ring, E_star) * speed, area, body.track
    width = 2 * float(film.conjunction.semi_axes(film.load, E=2 * E_star)[1])
    if body is None:
        return width * speed, width * speed, "surface 2"
    return body.bodies * width * speed, body.bodies * width * speed, body.track


def tracks_of(
    contact: Contact, film: FilmConditions, body: Body | None, force: float | None, *, entry: float
) -> tuple[Track, ...]:
    """The tracks of an oil without particles: both rings of a bearing, or the one of other bodies.

    Parameters
    ----------
    contact : Contact
    film : FilmConditions
    body : Body or None
    force : float or None
        On the body [N].
    entry : float
        ε [1].

    Raises
    ------
    InvalidValue, NoEquilibrium
        There is no film at this speed.
    """
    clean = contact.replace(particles=None)
    film = film.replace(entrainment=None)
    parts: Sequence[tuple[Body | None, FilmConditions]] = [(body, film)]
    if isinstance(body, RadialBearing) and film.conjunction == body.conjunction:
        rings = [body.replace(ring=ring) for ring in RINGS]
        parts = [(ring, film.replace(conjunction=ring.conjunction)) for ring in rings]
    out = []
    for one_body, of in parts:
        speed = speed_of(one_body, of)
        h = float(of.at(clean, speed=speed).h_T)
        rate, area, name = track_areas(one_body, force, of, E_star=contact.E_ss, speed=speed)
        if math.isfinite(h):
            out.append(
                Track(name=name, surfaces=contact.surfaces, film=h, rate=rate, area=area,
                      entry=entry)
            )  # fmt: skip
    return tuple(out)
