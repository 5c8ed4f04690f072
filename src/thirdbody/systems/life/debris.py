r"""Debris: what wear leaves behind, spread over sizes.

.. math:: g_k = \varphi_k\,\frac{G}{v_k}, \qquad \sum_k \varphi_k = 1

particles of class k per time from the volume G that a surface loses per time, with the volume v_k
of one. Nobody can predict φ from the materials; it is measured.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from ...errors import InvalidValue, Mistake, Note, Problem
from ...populations.distributions import Distribution, LogNormal
from ...populations.materials import Material
from ...populations.tabulated_sizes import PowerLaw
from ...quantities.say import percent
from ...quantities.value import Value, quantity
from .size_classes import SizeClasses

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...contact.contact import Contact

    Array = NDArray[np.float64]

__all__ = ["Debris"]


def __dir__() -> list[str]:
    return sorted(__all__)


ESTIMATE = (
    "sizes of debris are an estimate: between two ways to measure them on one pair of steels under "
    "boundary lubrication"
)


def wears(contact: Contact) -> bool:
    """Whether the Wear of a contact takes anything away."""
    wear: Any = next((output for output in contact.outputs if output.name == "wear"), None)
    names = ("K_ss", "K_ss_ep", "K_ss_e", "K_sa", "K_sa_ep", "K_sa_e", "f_ab", "f_roll")
    return wear is not None and any(getattr(wear, name) for name in names)


@dataclass(frozen=True, slots=True, kw_only=True)
class Debris(Value):
    r"""Sizes and hardness of what wear leaves behind.

    .. math:: \varphi_k = \int_{e_k}^{e_{k+1}} x^3\varphi_a\,dx \Big/ \int x^3\varphi_a\,dx

    Parameters
    ----------
    diameter : Distribution
        Sizes by number [m].
    hardness : float, optional
        Of the debris [Pa]; that of the surface it comes from where it is not given. Debris no
        harder than the surfaces does not groove them: whether wear feeds itself hangs on it.
    origin : str, optional
        Where the sizes are from, as results say it; "" for those of a report of one's own.

    Examples
    --------
    >>> import thirdbody as tb
    >>> debris = tb.oil.Debris.boundary_lubricated()
    >>> classes = tb.oil.SizeClasses(edges=(0.25e-6, 0.5e-6, 1e-6, 2e-6, 4e-6))
    >>> debris.shares(classes).round(3).tolist()
    [0.175, 0.53, 0.273, 0.022]
    """

    diameter: Distribution
    hardness: float | None = quantity("H_d", "Pa", "hardness of the debris", default=None, gt=0)
    origin: str = ""

    def _problems(self) -> list[str]:
        if isinstance(self.diameter, Distribution):
            return []
        return [
            Problem(
                "diameter", "must be a size distribution", repr(self.diameter), code=Mistake.KIND
            )
        ]

    @classmethod
    def boundary_lubricated(cls, *, hardness: float | None = None) -> Self:
        """Debris of steel in base oil without additives: median 0.4 µm, gsd 1.6. An estimate.

        Parameters
        ----------
        hardness : float, optional
            As in the class [Pa].

        Notes
        -----
        Radii of 230 to 260 nm by light scattering, which weighs large particles, and of 133 to
        175 nm by atomic force microscopy, where it was not seen whether the size is a radius; the
        median is chosen between, by number, the spread is assumed. Severe wear, fatigue and
        grinding leave other sizes.

        References
        ----------
        Akchurin, Bosman, Lugt 2016, Tribol. Lett. 63, 3, doi:10.1007/s11249-016-0701-z (abstract).
        """
        sizes = LogNormal(median=0.4e-6, gsd=1.6)
        return cls(diameter=sizes, hardness=hardness, origin=ESTIMATE)

    @classmethod
    def from_report(
        cls, *, sizes: Sequence[float], counts: Sequence[float], hardness: float | None = None
    ) -> Self:
        """Debris as counted: numbers between sizes.

        Parameters
        ----------
        sizes : sequence of float
            Increasing sizes between which particles were counted [m]; one more than counts.
        counts : sequence of float
            Particles of each class, in any unit.
        hardness : float, optional
            As in the class [Pa].

        Raises
        ------
        InvalidValue
            Sizes that do not increase, counts that do not fit or are none.

        Examples
        --------
        >>> import thirdbody as tb
        >>> tb.oil.Debris.from_report(sizes=[1e-6, 2e-6, 5e-6], counts=[90, 10]).diameter.support
        (1e-06, 5e-06)
        """
        edges, numbers = tuple(map(float, sizes)), tuple(map(float, counts))
        if len(edges) != len(numbers) + 1:
            raise InvalidValue(
                Problem("sizes", f"({len(edges)}) must be one more than counts", code=Mistake.SHAPE)
            )
        diameter = PowerLaw(edges=edges, counts=numbers, slopes=(3.0,) * len(numbers))
        return cls(diameter=diameter, hardness=hardness)

    def material(self, surface: Material, *, name: str) -> Material:
        """The debris of a surface as a material.

        Parameters
        ----------
        surface : Material
        name : str
            What results call it.
        """
        hardness = surface.H if self.hardness is None else self.hardness
        return surface.replace(H=hardness, name=name)

    def shares(self, classes: SizeClasses) -> Array:
        """φ_k: parts of its volume in each class [1], (K,); what lies beyond is put in the ends.

        Parameters
        ----------
        classes : SizeClasses
        """
        edges = np.array([0.0, *classes.edges[1:-1], math.inf])
        top = max(self.diameter.support[1], classes.edges[-1])
        edges[-1] = 2 * top
        volume = np.asarray(self.diameter.partial_moment(3, edges[:-1], edges[1:]))
        return volume / volume.sum()

    def notes(self, classes: SizeClasses) -> list[Note]:
        """What is to be said of the sizes.

        Parameters
        ----------
        classes : SizeClasses
        """
        out = []
        if self.origin:
            out.append(Note(self.origin, code="debris.sizes", action="give sizes of your own"))
        low, high = classes.edges[0], classes.edges[-1]
        inside = float(self.diameter.partial_moment(3, low, high)) / self.diameter.moment(3)
        if inside < 1 - 1e-3:
            what = f"{percent(1 - inside, digits=2)} of the volume of the debris lies outside "
            what += "the classes of size and is put in the first and the last"
            out.append(Note(what, code="debris.outside", effect=1 - inside))
        return out
