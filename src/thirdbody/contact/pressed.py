"""Particles pressed beyond the laws of one contact: deeper than their radius, or broken."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ..errors import InvalidValue
from ..laws.particle.tension import tension
from ..numerics.roots import bracketed_root
from ..populations.strength import WeibullStrength
from ..quantities.say import percent
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

__all__ = ["about_pressed", "buried"]

TOLD = 0.01
"""Share of the particles' load from which such particles are told of."""


def buried(contact: Contact, d: Array) -> Array:
    """Share of the particles' load on those that sit deeper than their radius: (N,).

    Zero where the particle law knows no single particles.
    """
    return _shares(contact, d)[0]


def _shares(contact: Contact, d: Array) -> tuple[Array, Array]:
    """Shares of the particles' load on buried ones, and on brittle ones beyond their strength."""
    total, deep, broken = (np.zeros(len(d)) for _ in range(3))
    for each, response in zip(contact.populations, interface(contact).populations, strict=True):
        if each.strength is not None:
            continue  # what becomes of these is the output `Crushing`
        try:
            split = _radius_squeeze(contact.law_of(each), contact.surfaces, each.material)
            groups = response.spots(d, split)
        except InvalidValue:
            continue
        strength = _strength(each)
        for spots in groups:
            total += spots.total(spots.load)
            deep += spots.total(spots.load * (np.maximum(*spots.depths) > spots.half))
            if strength is not None:
                one = contact.law_of(each).one(surfaces=contact.surfaces, particle=each.material)
                beyond = _broken(spots, strength, one, each.material)
                broken += spots.total(spots.load * beyond)

    def of(part: Array) -> Array:
        return np.divide(part, total, out=np.zeros_like(part), where=total > 0)

    return of(deep), of(broken)


def about_pressed(contact: Contact, d: Array) -> list[str]:
    """What the lowest of these d does to particles that no law of one contact follows."""
    lowest = np.array([np.nanmin(d)])
    if max(_at_most(contact, lowest)) <= TOLD:
        return []
    deep, broken = (float(share[0]) for share in _shares(contact, lowest))
    out = []
    if deep > TOLD:
        out.append(
            f"{percent(deep, digits=2)} of the particles' load is on particles that sit deeper "
            "than their radius, where the laws of one contact end; load, area and every output "
            "are extrapolated there"
        )
    if broken > TOLD:
        out.append(
            f"{percent(broken, digits=2)} of the particles' load is on brittle particles pressed "
            "beyond the strength of most grains of their size: they would break, and the laws keep "
            'them whole; give the particles a strength ("material" takes the library\'s)'
        )
    return out


def _at_most(contact: Contact, d: Array) -> tuple[float, float]:
    """Bounds from above of both shares at one d, from the tables alone.

    A particle squeezed by ε of its size x lies in a gap of (1 − ε) x, which is no wider than that
    under the largest one. What particles carry in all gaps so narrow is never less.
    """
    total = deep = broken = 0.0
    for each, response in zip(contact.populations, interface(contact).populations, strict=True):
        if each.strength is not None:
            continue
        law = contact.law_of(each)
        try:
            split = _radius_squeeze(law, contact.surfaces, each.material)
        except InvalidValue:
            continue
        if not isinstance(response, SeatedParticles):
            return math.inf, math.inf
        strength = _strength(each)
        for part in response.parts:
            total += float(part.columns(d)[0, 0])
            deep += float(part.load_in_gaps(d, min(split, default=math.inf))[0])
            top = part.scale * part.average.particles.top
            if strength is not None and top > strength.least(each.material):
                most = strength.of_size(top)
                squeeze = _squeeze_under(law, contact.surfaces, each.material, most)
                broken += float(part.load_in_gaps(d, squeeze)[0])
    if not total > 0:
        return math.inf, math.inf
    return deep / total, broken / total


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
def _radius_squeeze(
    law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material
) -> tuple[float, ...]:
    """Squeeze over diameter at which a particle sits as deep as its radius."""

    def beyond(eps: Array) -> Array:
        one = law.probe(eps, surfaces=surfaces, particle=particle)
        return np.ravel(np.maximum(*one.depths) - one.half)

    found = bracketed_root(beyond, np.array([1e-6]), np.array([4.0]), xrtol=1e-12)
    return tuple(found[np.isfinite(found)].tolist())


def _strength(particles: Particles) -> WeibullStrength | None:
    """Of particles that would break, and are not told to."""
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
        squeeze = (spots.depths[0] + spots.depths[1]) / spots.x
        found = np.zeros(beyond.shape)
        found[beyond] = tension(one, material.nu, strength.confinement).met(squeeze[beyond])
        beyond &= found > most
    return beyond
