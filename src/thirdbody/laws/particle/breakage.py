"""What a strength means to one particle between its sides, in lengths of the sizes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, Self

import numpy as np

from ...errors import Note
from ...quantities.say import span, value_of
from .tension import Tension, tension

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...populations.distributions import Distribution
    from ...populations.materials import Material, MaterialPair
    from ...populations.strength import WeibullStrength
    from ..base import OneParticle

    Array = NDArray[np.float64]

__all__ = ["Breakage", "about_strength", "crush_embed_size"]


@dataclass(frozen=True)
class Breakage:
    """How particles of one material break, lengths in units of the scale of their sizes.

    Parameters
    ----------
    sigma : float
        Characteristic strength of a particle of unit size [Pa].
    m, b : float
        Weibull modulus and exponent of the size effect [1].
    x_c : float
        Size from which down nothing breaks.
    kept, ratio : float
        χ, part of the volume that stays, and κ, size of pieces over that of their parent [1].
    confinement : {"sphere", "none"}
    nu : float
        Poisson ratio of the particle [1].
    """

    sigma: float
    m: float
    b: float
    x_c: float
    kept: float
    ratio: float
    confinement: str
    nu: float

    @classmethod
    def of_material(cls, strength: WeibullStrength, material: Material, scale: float) -> Self:
        """Breakage of particles of a material, in units of ``scale`` [m]."""
        return cls(
            sigma=float(strength.of_size(scale)),
            m=strength.m,
            b=strength.b,
            x_c=strength.least(material) / scale,
            kept=strength.bearing_share,
            ratio=strength.ratio,
            confinement=strength.confinement,
            nu=material.nu,
        )

    def tension(self, particle: OneParticle) -> Tension:
        """Inside one particle of unit size."""
        return tension(particle, self.nu, self.confinement)

    def survival(self, x: Array, stress: Array) -> Array:
        """P_s of particles of size x that have met a tension [Pa]."""
        with np.errstate(over="ignore", divide="ignore"):
            exponent = (stress / self.sigma * x**self.b) ** self.m
        return np.where(x <= self.x_c, 1.0, np.exp(-exponent))


def crush_embed_size(particle: OneParticle, breakage: Breakage) -> float:
    r"""x*, above which particles break (63 %) before the surfaces swallow them.

    .. math:: x^* = x_0\,(\hat\sigma_{max}/\sigma_0)^{-1/b}

    In the lengths of ``breakage``; infinite where no size does (b = 0).
    """
    ratio = breakage.sigma / breakage.tension(particle).greatest
    if breakage.b == 0:
        return math.inf if ratio > 1 else 0.0
    return float(ratio ** (1 / breakage.b))


class Grains(Protocol):
    """What has a strength: particles of a contact, or of an oil."""

    @property
    def strength(self) -> WeibullStrength | None:
        """How strong they are."""

    @property
    def material(self) -> Material:
        """Material of the particles."""

    @property
    def diameter(self) -> Distribution:
        """Their sizes [m]."""


def about_strength(particles: Grains, surfaces: MaterialPair) -> list[str]:
    """Notes on particles whose strength leaves its range, one sentence each."""
    strength, material = particles.strength, particles.material
    if strength is None:
        return []
    out: list[str] = []
    name = getattr(particles, "name", "") or material.name or "the particles"
    if strength.x_c is None and material.K_c is None:
        what = (
            f"the strength of {name}: without x_c, and without K_c of the material, x_c is 0 and "
            "the smallest pieces break as the large ones do"
        )
        out.append(Note(what, code=f"strength.smallest.{name}"))
    low, high = particles.diameter.support
    low = max(low, strength.least(material), 1e-3 * high)
    p, q = strength.tested_sizes
    if high >= low and (low < p or high > q):
        tested = value_of(p, "m", 3) if p == q else span(p, q, "m")
        factor = max((p / low) ** strength.b, (high / q) ** strength.b)
        what = (
            f"the strength of {name}: x from {span(low, high, 'm')} lies outside the sizes "
            f"of the strength data ({tested}): strengths are extrapolated by a factor "
            f"{factor:.2g}"
        )
        out.append(Note(what, code=f"strength.sizes.{name}"))
    softer = material.H < max(surfaces.first.H, surfaces.second.H)
    if softer and material.K_c is not None:
        what = (
            f"{name}: the particle is softer than a surface: it is squashed there; strength is "
            "used all the same"
        )
        out.append(Note(what, code=f"strength.soft.{name}"))
    return out
