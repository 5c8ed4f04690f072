"""Particles pressed beyond the laws of one contact: deeper than their radius, or broken."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ..errors import InvalidValue, Note
from ..laws.particle.deep import TABLE_BEGINS, DeepSide
from ..laws.particle.tension import tension
from ..numerics.roots import bracketed_root
from ..populations.strength import WeibullStrength
from ..quantities.say import percent, value_of
from .interface import interface
from .particle_sums import SeatedParticles

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..laws.base import AbstractParticleLaw, OneParticle
    from ..laws.spots import ParticleSpots
    from ..populations.materials import Material, MaterialPair
    from ..populations.particles import Particles
    from .contact import Contact

    Array = NDArray[np.float64]

__all__ = ["about_pressed", "buried_share", "most_buried"]

OTHER_FRICTION = (
    "solve again with particle_law.friction_factor = 0.05 and 1 to see what the friction does"
)
WIDE = 0.2
"""Contact radius over that of a squashed particle from which it presses less than the law says;
Chaudhri, Hutchings, Makin 1984, doi:10.1080/01418618408236551 (abstract seen)."""
COLLARS = 0.68
"""Squeeze of a side from which the collars around an embedded grain touch: with smooth faces, and
later with rough ones (`data/deep_squeeze.json`)."""
TOLD = 0.01
"""Share of the particles' load from which such particles are told of."""


def buried_share(contact: Contact, d: Array) -> Array:
    """Share of the particles' load on those that sink in deeper than their radius: (N,).

    Zero where the particle law knows no single particles.
    """
    return _shares(contact, d, brittle=False)[0]


def most_buried(contact: Contact, d: Array) -> Array:
    """Pressure [Pa] on such particles at most, as if each bore what the deepest can: (N,)."""
    out = np.zeros(len(d))
    for population, response in zip(
        contact.populations, interface(contact).populations, strict=True
    ):
        if population.strength is None and isinstance(response, SeatedParticles):
            split = _radius_squeeze(
                contact.law_of(population), contact.surfaces, population.material
            )
            for component in response.parts:
                out += component.most_in_gaps(d, min(split, default=math.inf))
        elif population.strength is None:
            out[:] = math.inf
    return out


def _shares(
    contact: Contact, d: Array, *, brittle: bool = True, followed: bool = True
) -> tuple[Array, Array]:
    """Shares of the particles' load on buried ones, and on brittle ones beyond their strength.

    Of the buried ones with or without those that their law follows to any depth.
    """
    total, deep, broken = (np.zeros(len(d)) for _ in range(3))
    for population, response in zip(
        contact.populations, interface(contact).populations, strict=True
    ):
        if population.strength is not None:
            continue  # what becomes of these is the output `Crushing`
        try:
            law = contact.law_of(population)
            split = _radius_squeeze(law, contact.surfaces, population.material)
            if not followed and _follows(law, contact.surfaces, population.material):
                split = ()
            groups = response.spots(d, split)
        except InvalidValue:
            continue
        strength = _strength(population) if brittle else None
        for spots in groups:
            total += spots.total(spots.load)
            if split:
                deep += spots.total(spots.load * (np.maximum(*spots.sinks) > spots.half))
            if strength is not None:
                one = contact.law_of(population).one(
                    surfaces=contact.surfaces, particle=population.material
                )
                beyond = _broken(spots, strength, one, population.material)
                broken += spots.total(spots.load * beyond)

    def share_of(load: Array) -> Array:
        return np.divide(load, total, out=np.zeros_like(load), where=total > 0)

    return share_of(deep), share_of(broken)


def about_pressed(contact: Contact, d: Array) -> list[str]:
    """Notes on particles pressed beyond every law of one contact, at the lowest of these d."""
    lowest = np.array([np.nanmin(d)])
    out = [*_about_squashed(contact, lowest), *_about_computed(contact, lowest)]
    if np.max(_at_most(contact, lowest)) <= TOLD:
        return out
    deep, broken = (float(share[0]) for share in _shares(contact, lowest, followed=False))
    if deep > TOLD:
        what = (
            f"{percent(deep, digits=2)} of the particles' load is on particles that sit deeper "
            "than their radius, where the laws of one contact end; load, area and every output "
            "are extrapolated there"
        )
        out.append(Note(what, code="buried"))
    if broken > TOLD:
        what = (
            f"{percent(broken, digits=2)} of the particles' load at the separation h = "
            f"{value_of(lowest[0] + interface(contact).mean_plane, 'm')} is on brittle particles "
            "pressed beyond the strength of most grains of their size: they would break, but they "
            'count as whole here; give the particles a strength ("material" takes the library\'s)'
        )
        out.append(Note(what, code="brittle"))
    return out


def _about_squashed(contact: Contact, d: Array) -> list[str]:
    """Squashed particles beyond the width at which spheres were measured to press less."""
    total = wide = 0.0
    for population, response in zip(
        contact.populations, interface(contact).populations, strict=True
    ):
        if population.strength is not None or not isinstance(response, SeatedParticles):
            continue
        try:
            squeeze = _wide_squeeze(
                contact.law_of(population), contact.surfaces, population.material
            )
        except InvalidValue:
            continue
        for component in response.parts:
            total += float(component.columns(d)[0, 0])
            wide += float(component.load_in_gaps(d, squeeze)[0]) if squeeze < math.inf else 0.0
    share = min(wide / total, 1.0) if total > 0 else 0.0
    if share <= TOLD:
        return []
    what = (
        f"up to {percent(share, digits=2)} of the particles' load is on soft particles squashed to "
        f"contacts wider than {WIDE:g} of their radius: metal spheres were measured to press with "
        "at most 0.7 to 0.8 of their Vickers hardness, at 0.20 to 0.28; this law says at most 0.95 "
        "to 1.08, and no measurement is known beyond"
    )
    return [Note(what, code="squashed")]


def _about_computed(contact: Contact, d: Array) -> list[str]:
    """Notes on particles that follow the computed table, and on collars that touch."""
    total = far = collars = 0.0
    less, more = 0.0, 0.0
    for population, response in zip(
        contact.populations, interface(contact).populations, strict=True
    ):
        if population.strength is not None or not isinstance(response, SeatedParticles):
            continue
        try:
            law = contact.law_of(population)
            follows = _follows(law, contact.surfaces, population.material)
            for low, high in _friction_bands(law, contact.surfaces, population.material):
                less, more = min(less, low), max(more, high)
            begin, touch = _computed_squeezes(law, contact.surfaces, population.material)
        except InvalidValue:
            continue
        for component in response.parts:
            total += float(component.columns(d)[0, 0])
            if follows:
                far += float(component.load_in_gaps(d, begin)[0])
            if touch < math.inf:
                collars += float(component.load_in_gaps(d, touch)[0])
    if total <= 0 or min(far / total, 1.0) <= TOLD:
        return []
    what = (
        f"up to {percent(min(far / total, 1.0), digits=2)} of the particles' load is on particles "
        f"squeezed by more than {TABLE_BEGINS:g} of their radius on each side: their law agrees "
        "with a computation there within ±10 %, but with no measurement; friction of their faces, "
        f"from smooth to rough, changes their load by {_signed_percent(less)} to "
        f"{_signed_percent(more)} %"
    )
    action = OTHER_FRICTION
    if min(collars / total, 1.0) > TOLD:
        action += (
            f". On up to {percent(min(collars / total, 1.0), digits=2)} the collars that both "
            "surfaces push up around a grain may touch: what they carry is not counted, and "
            "the particles' part of the load is too small there; fewer or smaller grains avoid it"
        )
    return [Note(what, code="squeezed", effect=max(0.1, -less, more), action=action)]


@lru_cache(maxsize=512)
def _computed_squeezes(
    law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material
) -> tuple[float, float]:
    """Squeezes over diameter from which a side follows the table, and from which collars touch."""
    one = law.one(surfaces=surfaces, particle=particle)
    if not any(one.knows_sink):
        return math.inf, math.inf
    squeezes = np.geomspace(1e-3, 2.0, 400)
    depths = one.at(squeezes).depths
    sides = zip(depths, one.sinks(depths), strict=True)
    begins, touch = np.zeros((2, len(squeezes)), bool)
    for depth, sink in sides:
        begins |= depth > TABLE_BEGINS * one.tip_radius
        # only a grain that embeds pushes up a collar that high
        touch |= (depth > COLLARS * one.tip_radius) & (sink > 0.5 * depth)

    def first(holds: NDArray[np.bool_]) -> float:
        return float(squeezes[int(np.argmax(holds))]) if np.any(holds) else math.inf

    return first(begins), first(touch)


def _signed_percent(share: float) -> str:
    """A part of one in whole per cent with its sign."""
    return f"{100 * share:+.0f}".replace("-", "−").replace("+0", "0").replace("−0", "0")


@lru_cache(maxsize=512)
def _friction_bands(
    law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material
) -> list[tuple[float, float]]:
    """Effect of the friction of its faces on each side of a particle that follows the table."""
    one = law.one(surfaces=surfaces, particle=particle)
    sides = getattr(one, "sides", ())
    return [side.friction_band for side in sides if isinstance(side, DeepSide)]


def _follows(law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material) -> bool:
    """Whether the law follows particles to any depth on both surfaces."""
    return all(law.one(surfaces=surfaces, particle=particle).knows_sink)


def _at_most(contact: Contact, d: Array) -> tuple[Array, Array]:
    """Bounds from above of both shares at d, from the tables alone; of laws that do not follow.

    A particle squeezed by ε of its size x lies in a gap of (1 − ε) x, which is no wider than that
    under the largest one. What particles carry in all gaps so narrow is never less.
    """
    total, deep, broken = (np.zeros(len(d)) for _ in range(3))
    for population, response in zip(
        contact.populations, interface(contact).populations, strict=True
    ):
        if population.strength is not None:
            continue
        law = contact.law_of(population)
        try:
            split = _radius_squeeze(law, contact.surfaces, population.material)
        except InvalidValue:
            continue
        if not isinstance(response, SeatedParticles):
            return np.full(len(d), math.inf), np.full(len(d), math.inf)
        strength = _strength(population)
        for component in response.parts:
            total += component.columns(d)[:, 0]
            if not _follows(law, contact.surfaces, population.material):
                deep += component.load_in_gaps(d, min(split, default=math.inf))
            top = component.scale * component.average.particles.top
            if strength is not None and top > strength.least(population.material):
                most = strength.of_size(top)
                squeeze = _squeeze_under(law, contact.surfaces, population.material, most)
                broken += component.load_in_gaps(d, squeeze)

    def share_of(load: Array) -> Array:
        return np.divide(load, total, out=np.full_like(load, math.inf), where=total > 0)

    return share_of(deep), share_of(broken)


@lru_cache(maxsize=512)
def _squeeze_under(
    law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material, stress: float
) -> float:
    """Squeeze over diameter up to which F/x² stays below a stress [Pa]."""
    one = law.one(surfaces=surfaces, particle=particle)
    squeezes = np.geomspace(1e-6, 4.0, 200)
    beyond = np.maximum.accumulate(one(squeezes)[:, 0]) > stress
    first = int(np.argmax(beyond))
    if not beyond[first]:
        return math.inf
    return float(squeezes[first - 1]) if first else 0.0


@lru_cache(maxsize=512)
def _wide_squeeze(law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material) -> float:
    """Squeeze over diameter at which a squashed particle's contact is `WIDE`; inf for others."""
    one = law.one(surfaces=surfaces, particle=particle)
    if not getattr(one, "spreads", False) or all(one.knows_sink):
        return math.inf
    squeezes = np.geomspace(1e-6, 2.0, 400)
    wide = np.minimum(*one.at(squeezes).areas) > math.pi * (WIDE / 2) ** 2
    return float(squeezes[int(np.argmax(wide))]) if np.any(wide) else math.inf


@lru_cache(maxsize=512)
def _radius_squeeze(
    law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material
) -> tuple[float, ...]:
    """Squeeze over diameter at which a particle sits as deep as its radius."""

    def sink_past_radius(eps: Array) -> Array:
        one = law.probe(eps, surfaces=surfaces, particle=particle)
        return np.ravel(np.maximum(*one.sinks) - one.half)

    squeeze = bracketed_root(sink_past_radius, np.array([1e-6]), np.array([4.0]), xrtol=1e-12)
    return tuple(squeeze[np.isfinite(squeeze)].tolist())


def _strength(particles: Particles) -> WeibullStrength | None:
    """Strength of the material of particles that have none set; None if it has none."""
    if particles.strength is not None:
        return None
    try:
        return WeibullStrength.of(particles.material)
    except InvalidValue:
        return None


def _broken(
    spots: ParticleSpots, strength: WeibullStrength, one: OneParticle, material: Material
) -> NDArray[np.bool_]:
    """Particles whose tension, now or on the way, is beyond the strength of 63 % of their size."""
    most = strength.of_size(np.maximum(spots.x, np.finfo(float).tiny))
    beyond = (spots.x > strength.least(material)) & (spots.load > most * spots.x**2)
    if np.any(beyond):  # the surfaces around a particle only lessen its tension
        approach = np.broadcast_to(spots.depths[0] + spots.depths[1], beyond.shape)[beyond]
        squeeze = approach / np.broadcast_to(spots.x, beyond.shape)[beyond]
        tensions = np.zeros(beyond.shape)
        tensions[beyond] = tension(one, material.nu, strength.confinement).greatest_so_far(squeeze)
        beyond &= tensions > most
    return beyond
