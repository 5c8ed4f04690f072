r"""Particles of an oil: how many of each size are in a volume of it, and what they are of.

.. math:: n = \int \varphi_n(x)\,dx \quad [1/m^3]
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self

from ...errors import Mistake, Problem
from ...populations.distributions import Distribution
from ...populations.materials import Material
from ...populations.measured import cleanliness
from ...quantities.units import to_si
from ...quantities.value import Value, quantity

__all__ = ["OilDirt"]


def __dir__() -> list[str]:
    return sorted(__all__)


@dataclass(frozen=True, slots=True, kw_only=True)
class OilDirt(Value):
    r"""Particles of one material in an oil.

    .. math:: n(>x) = n \int_x^\infty \varphi_a\,dx

    Parameters
    ----------
    material : Material
        Of the particles; its density is needed where mass is counted.
    diameter : Distribution
        Sizes by number [m].
    number : float
        Particles per volume of oil n [1/m³].

    Examples
    --------
    >>> import thirdbody as tb
    >>> dirt = tb.oil.OilDirt.from_iso4406("18/16/13", material=tb.materials["quartz"])
    >>> f"{dirt.number / 1e6:.0f} per mL, {dirt.mass_per_volume * 1e3:.2f} mg/L"
    '1803 per mL, 1.46 mg/L'
    """

    material: Material
    diameter: Distribution
    number: float = quantity("n", "1/m^3", "particles per volume of oil", ge=0)

    def _problems(self) -> list[str]:
        return problems_of_kinds(self)

    @classmethod
    def from_iso4406(
        cls,
        code: str,
        *,
        material: Material,
        level: cleanliness.Level = "middle",
        smallest: float | str | None = None,
        largest: float | str | None = None,
    ) -> Self:
        """The particles of an oil with an ISO 4406 code.

        Parameters
        ----------
        code : str
            "18/16/13".
        material : Material
            Of the particles; the code does not know it.
        level : {"low", "middle", "high"}, optional
            Where in its range each number is taken.
        smallest, largest : float or str, optional
            Ends of the sizes [m]: 4 µm and 70 µm by default.

        Raises
        ------
        InvalidValue
            An impossible code, level or end.
        """
        number, diameter = cleanliness.suspension_of_iso4406(
            code, level=level, smallest=_length(smallest), largest=_length(largest)
        )
        return cls(material=material, diameter=diameter, number=number)

    @classmethod
    def of_dust(
        cls,
        grade: str,
        *,
        material: Material,
        concentration: float | str,
        limit: cleanliness.Limit = "middle",
    ) -> Self:
        """A test dust in oil.

        Parameters
        ----------
        grade : {"A1", "A2", "A3", "A4", "A3-lot"}
            As in `thirdbody.dust.dust_sizes`.
        material : Material
            Of the dust, with a density.
        concentration : float or str
            "10 mg/L", "50 ppm" by mass; a number is in particles per volume [1/m³].
        limit : {"coarse", "middle", "fine"}, optional
            Where between its printed limits the dust is taken.

        Raises
        ------
        InvalidValue
            An unknown dust, or a concentration that is none.
        """
        diameter = cleanliness.dust_sizes(grade, limit=limit)
        mass_concentration = cleanliness.concentration(concentration)
        number = cleanliness.particles_in(
            mass_concentration, diameter, particle_density=material.density
        )
        return cls(material=material, diameter=diameter, number=number)

    @property
    def mass_per_volume(self) -> float:
        """Mass of the particles per volume of oil [kg/m³]; NaN without a density."""
        if self.material.density is None:
            return math.nan
        return self.number * self.material.density * math.pi / 6 * self.diameter.moment(3)


def problems_of_kinds(value: object) -> list[str]:
    """Where material and diameter are not what they must be."""
    return [
        Problem(name, f"must be a {kind.__name__}", repr(getattr(value, name)), code=Mistake.KIND)
        for name, kind in (("material", Material), ("diameter", Distribution))
        if not isinstance(getattr(value, name), kind)
    ]


def _length(value: float | str | None) -> float | None:
    return None if value is None else to_si(value, "m")
