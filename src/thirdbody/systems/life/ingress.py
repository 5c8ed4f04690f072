r"""Particles that enter an oil: so many of each size per time, whatever leaves it.

.. math:: r_k = \dot N \int_{e_k}^{e_{k+1}} \varphi_a\,dx
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Self

from ...errors import InvalidValue, Mistake, Problem
from ...populations.distributions import Distribution
from ...populations.materials import Material
from ...populations.measured import cleanliness
from ...quantities.units import to_si
from ...quantities.value import Value, choice, quantity
from .oil_dirt import problems_of_kinds

__all__ = ["Ingress"]


def __dir__() -> list[str]:
    return sorted(__all__)


@dataclass(frozen=True, slots=True, kw_only=True)
class Ingress(Value):
    r"""Particles of one material that enter an oil.

    .. math:: \dot N\ \text{particles per time}, \quad\text{or}\quad
              r_k = n_k\,(\text{all that leaves at}\ n_k = 1)

    Give ``rate`` or ``steady``. With ``steady`` as many enter as keep that many in the oil: the
    circuit says how many that is.

    Parameters
    ----------
    material : Material
        Of the particles.
    diameter : Distribution
        Sizes by number, of those that enter with ``rate``, of those in the oil with ``steady`` [m].
    rate : float, optional
        Particles per time [1/s].
    steady : float, optional
        Particles per volume of oil that stay when it no longer changes [1/m³].
    kept : {"number", "volume"}, optional
        What is kept where sizes are put into classes: the count, or the volume and so the mass.

    Examples
    --------
    >>> import thirdbody as tb
    >>> dust = tb.oil.Ingress.of_dust("A3", rate="125 mg/h", material=tb.materials["quartz"])
    >>> f"{dust.rate:.3g} per second, {dust.mass_rate * 3.6e9:.0f} mg/h"
    '1.1e+06 per second, 125 mg/h'
    """

    material: Material
    diameter: Distribution
    rate: float | None = quantity("N'", "1/s", "particles per time", default=None, ge=0)
    steady: float | None = quantity(
        "n", "1/m^3", "particles per volume that stay in the oil", default=None, ge=0
    )
    kept: str = choice("what classes of size keep", "number", "volume", default="number")

    def _problems(self) -> list[str]:
        out = problems_of_kinds(self)
        if (self.rate is None) == (self.steady is None):
            out.append(Problem("rate", "or steady must be given, one of them", code=Mistake.CLASH))
        return out

    @classmethod
    def of_dust(
        cls,
        grade: str,
        *,
        rate: float | str,
        material: Material,
        limit: cleanliness.Limit = "middle",
    ) -> Self:
        """So much of a test dust per time.

        Parameters
        ----------
        grade : {"A1", "A2", "A3", "A4", "A3-lot"}
            As in `thirdbody.dust.dust_sizes`.
        rate : float or str
            Mass per time [kg/s]; "125 mg/h".
        material : Material
            Of the dust, with a density.
        limit : {"coarse", "middle", "fine"}, optional
            Where between its printed limits the dust is taken.

        Raises
        ------
        InvalidValue
            An unknown dust, a material without density, or a rate that is none.
        """
        diameter = cleanliness.dust_sizes(grade, limit=limit)
        if material.density is None:
            rule = "is missing: a mass of dust needs it [kg/m^3], e.g. 2650 for quartz"
            raise InvalidValue(
                Problem("material.density", rule, owner="Ingress", code=Mistake.MISSING)
            )
        mass = to_si(rate, "kg/s")
        number = mass / (material.density * math.pi / 6 * diameter.moment(3))
        return cls(material=material, diameter=diameter, rate=number, kept="volume")

    @classmethod
    def from_counts(
        cls,
        *,
        sizes: Sequence[float],
        counts: Sequence[float],
        material: Material,
        largest: float | str = 70e-6,
    ) -> Self:
        r"""Counts per time above sizes, power laws between them.

        Parameters
        ----------
        sizes : sequence of float
            Increasing sizes [m], usually 4, 6 and 14 µm(c).
        counts : sequence of float
            Particles per time larger than each [1/s], falling.
        material : Material
            Of the particles.
        largest : float or str, optional
            End of the sizes [m].

        Raises
        ------
        InvalidValue
            No counts, counts that rise, or an end below the sizes.
        """
        above = [float(count) for count in counts]
        if not above or any(not (n > 0 and math.isfinite(n)) for n in above):
            raise InvalidValue(
                Problem("counts", "must be above 0 at every size [1/s]", code=Mistake.RANGE)
            )
        if len(above) != len(sizes) or any(b >= a for a, b in pairwise(above)):
            rule = "must fall with the size, one for each: larger particles are among the smaller"
            raise InvalidValue(Problem("counts", rule, code=Mistake.ORDER))
        diameter = cleanliness.sizes_above(sizes, counts=above, largest=to_si(largest, "m"))
        return cls(material=material, diameter=diameter, rate=above[0])

    @classmethod
    def keeping_iso4406(
        cls,
        code: str,
        *,
        material: Material,
        level: cleanliness.Level = "middle",
        smallest: float | None = None,
        largest: float | None = None,
    ) -> Self:
        """As many as keep an oil at an ISO 4406 code when it no longer changes.

        Parameters
        ----------
        code : str
            "18/16/13".
        material : Material
            Of the particles.
        level : {"low", "middle", "high"}, optional
            Where in its range each number is taken.
        smallest, largest : float, optional
            Ends of the sizes [m]: 4 µm and 70 µm by default.

        Raises
        ------
        InvalidValue
            An impossible code, level or end.
        """
        number, diameter = cleanliness.suspension_of_iso4406(
            code, level=level, smallest=smallest, largest=largest
        )
        return cls(material=material, diameter=diameter, steady=number)

    @property
    def mass_rate(self) -> float:
        """Mass that enters per time [kg/s]; NaN without a density, or where ``steady`` is given."""
        if self.rate is None or self.material.density is None:
            return math.nan
        return self.rate * self.material.density * math.pi / 6 * self.diameter.moment(3)
