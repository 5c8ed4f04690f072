"""Particles: what lies between the surfaces."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .distributions import Distribution
from .materials import Material
from .values import Value, quantity

__all__ = ["Particles"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Particles(Value):
    """A population of spherical particles in the interface.

    Parameters
    ----------
    material : Material
        E_a, ν_a, H_a.
    diameter : Distribution
        Sizes x by number [m].
    areal_density : float
        η_a, particles per nominal area [1/m²].
    name : str, optional
        What results call this population, where several share one interface.
    law : AbstractParticleLaw, optional
        What one of these particles does; without it the particle law of the contact.

    Raises
    ------
    InvalidValue
        A number outside its meaning, or so many particles that their projected area
        :math:`\\eta_a\\langle\\pi x^2/4\\rangle` reaches the nominal area (jammed).

    Examples
    --------
    >>> from thirdbody import materials, Monodisperse
    >>> dust = Particles(material=materials["SiO2"], diameter=Monodisperse(mean=3e-7),
    ...                  areal_density=1e11)
    >>> round(dust.coverage, 6)
    0.007069
    """

    material: Material
    diameter: Distribution
    areal_density: float = quantity(
        "η_a", "1/m^2", "particles per nominal area", ge=0, hint="1e11 / m^2 is 1e11"
    )
    name: str = ""
    law: Value | None = None

    def _problems(self) -> list[str]:
        out: list[str] = []
        if not isinstance(self.material, Material):
            out.append(f"Particles.material = {self.material!r} must be a Material")
        if not isinstance(self.diameter, Distribution):
            out.append(f"Particles.diameter = {self.diameter!r} must be a size distribution")
        if not out and self.coverage >= 1:
            out.append(
                f"Particles.areal_density = {self.areal_density:g} is jammed: the particles would "
                f"cover {self.coverage:.3g} of the nominal area and it must stay below 1 "
                "(check the unit of the diameter, or that the density is per area)"
            )
        return out

    @property
    def coverage(self) -> float:
        """Projected particle area per nominal area η_a⟨πx²/4⟩ [1]."""
        return self.areal_density * math.pi / 4 * self.diameter.moment(2)
