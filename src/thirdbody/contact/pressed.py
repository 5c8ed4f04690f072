"""Particles pressed beyond the laws of one contact: deeper than their radius, or broken."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ..errors import InvalidValue
from ..quantities.say import percent
from .interface import interface

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..laws.base import AbstractParticleLaw
    from ..populations.materials import Material, MaterialPair
    from .contact import Contact

    Array = NDArray[np.float64]

__all__ = ["about_pressed", "buried"]

TOLD = 0.01
"""Share of the particles' load from which such particles are told of."""
BRITTLE = ("ceramic", "glass", "oxide particle")
"""Kinds of the materials library whose grains break."""
STRENGTH, AT, EXPONENT, SMALLEST = 67e6, 1e-3, 0.55, 1e-6
"""Load at failure over the square of its size [Pa], of a grain of quartz of 1 mm, and how it falls
with size (from memory; measured 0.47 to 0.65); below 1 µm quartz deforms and does not break
(Schönert, Steier 1971)."""


def buried(contact: Contact, d: Array) -> Array:
    """Share of the particles' load on those that sit deeper than their radius: (N,).

    Zero where the particle law knows no single particles.
    """
    return _shares(contact, d)[0]


def _shares(contact: Contact, d: Array) -> tuple[Array, Array]:
    """Shares of the particles' load on buried ones, and on brittle ones beyond their strength."""
    total, deep, broken = (np.zeros(len(d)) for _ in range(3))
    for each, response in zip(contact.populations, interface(contact).populations, strict=True):
        try:
            split = _radius_squeeze(contact.law_of(each), contact.surfaces, each.material)
            groups = response.spots(d, split)
        except InvalidValue:
            continue
        breaks = _is_brittle(each.material)
        for spots in groups:
            total += spots.total(spots.load)
            deep += spots.total(spots.load * (np.maximum(*spots.depths) > spots.radius))
            if breaks:
                most = STRENGTH * (AT / spots.x) ** EXPONENT
                beyond = (spots.x > SMALLEST) & (spots.load > most * spots.x**2)
                broken += spots.total(spots.load * beyond)

    def of(part: Array) -> Array:
        return np.divide(part, total, out=np.zeros_like(part), where=total > 0)

    return of(deep), of(broken)


def about_pressed(contact: Contact, d: Array) -> list[str]:
    """What the lowest of these d does to particles that no law of one contact follows."""
    deep, broken = (float(share[0]) for share in _shares(contact, np.array([np.nanmin(d)])))
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
            "beyond the strength of a grain of quartz of their size: they would break, and the "
            "laws keep them whole"
        )
    return out


@lru_cache(maxsize=512)
def _is_brittle(material: Material) -> bool:
    from ..populations.materials import materials

    return materials.entries().get(material.name, {}).get("kind") in BRITTLE


@lru_cache(maxsize=512)
def _radius_squeeze(
    law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material
) -> tuple[float, ...]:
    """Squeeze over diameter at which a particle sits as deep as its radius."""
    from scipy.optimize import brentq

    def beyond(eps: float) -> float:
        one = law.probe(np.array([eps]), surfaces=surfaces, particle=particle)
        return float((np.maximum(*one.depths) - one.radius)[0, 0])

    return (brentq(beyond, 1e-6, 4.0, xtol=1e-12),) if beyond(1e-6) < 0 < beyond(4.0) else ()
