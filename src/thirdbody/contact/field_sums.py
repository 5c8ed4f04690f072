r"""A rough surface as one field of heights, as a function of the separation.

.. math:: F_{ss}(d) = E^* g\,\langle f\rangle(h)\,(1 + \varepsilon), \qquad
          h = (d - \mu_0 + y_s)/\sigma

with what `thirdbody.laws.field` says of the surface. It stands where a sum over summits stands.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from ..laws.asperity.field import TIP, Field
from ..laws.field.formulas import area, hardness_ratio, load, stiffness
from ..laws.field.own import own_field
from ..populations.materials import MaterialPair
from ..populations.roughness import Roughness
from .asperity_sums import AsperitySum, asperity_sum_of
from .spots import AsperitySpots

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["FieldSpots", "FieldSum"]

HIGHEST = 36.0
"""Separation of the mean planes over σ above which the density underflows."""


ROUNDING = 1e-12
"""Of a separation over σ."""


class FieldSum:
    """One rough surface as a field, as a function of the separation d [m]."""

    ends = "where the table of the law field ends"
    """What `deepest` is."""

    def __init__(self, law: Field, rough: Roughness, surfaces: MaterialPair, datum: float):
        self.law, self.rough, self.surfaces = law, rough, surfaces
        self.sigma, self.sigma_s = rough.sigma, rough.sigma_s
        self.centre = datum * rough.sigma
        self.datum = datum
        self.gradient = rough.slope
        chi = hardness_ratio(rough, E_star=surfaces.E_star, H=surfaces.H)
        self.surface = own_field(law.spectrum, chi, rough.alpha)
        self.unit = surfaces.E_star * self.gradient
        self.highest = (HIGHEST * self.sigma - rough.y_s) / self.sigma_s
        self._ends(self.surface.lowest)

    def _ends(self, lowest: float) -> None:
        """Nothing is known below this separation over σ, inside the table whatever the rounding."""
        self.deepest = self.centre + (lowest + ROUNDING) * self.sigma - self.rough.y_s
        self.searched = (self.deepest - self.centre) / self.sigma_s

    def h(self, d: Array) -> Array:
        """Separation of the mean planes over σ."""
        return (d - self.centre + self.rough.y_s) / self.sigma

    def load(self, d: Array) -> Array:
        """F_ss without shadow [Pa], and its first and second derivative: (N, 3)."""
        out = load(self.surface, self.h(d), remains=self.law.remainder)
        return self.unit * out / self.sigma ** np.arange(3)

    def fields(self, d: Array) -> Array:
        """F_ss [Pa], A_e, A_ep, A_p without shadow: (N, 4); of A_ep there is none."""
        h = self.h(d)
        F = self.unit * load(self.surface, h, remains=self.law.remainder)[:, 0]
        A, plastic = area(self.surface, h, remains=self.law.remainder)
        return np.stack([F, A * (1 - plastic), np.zeros_like(F), A * plastic], axis=-1)

    def stiffness(self, d: Array) -> Array:
        """δp/δ of the patches that touch, their edges at rest, without shadow [Pa/m]: (N,)."""
        reduced = stiffness(self.surface, self.h(d), remains=self.law.remainder)
        return self.unit / self.sigma * reduced

    def share_beyond(self, d: float) -> float:
        """Its range ends where its table does: nothing is carried beyond."""
        return 0.0

    def spots(self, d: Array) -> list[AsperitySpots]:
        """The summits of `ZMC` at d, in number and area scaled to load and area of the field."""
        tips = AsperitySum(TIP, self.rough, self.surfaces, self.datum)
        (spots,) = tips.spots(d)
        F, *areas = self.fields(d).T
        F_tips, *areas_tips = tips.fields(d).T
        tiny = np.finfo(float).tiny
        count = F / np.maximum(F_tips, tiny)
        size = np.sum(areas, axis=0) / np.maximum(count * np.sum(areas_tips, axis=0), tiny)
        scaled = FieldSpots.scaled_from(spots, count, np.where(F > 0, size, 1.0))
        return [replace(scaled, stiffness=self.stiffness(d), regimes=np.stack(areas, axis=-1))]


@dataclass(frozen=True, eq=False, kw_only=True)
class FieldSpots(AsperitySpots):
    """Summits whose number and area are scaled, state by state; loads of one spot are not.

    Parameters
    ----------
    size : array (N,)
        Area of each spot over that of its law [1].
    stiffness : array (N,)
        Of all patches at rest together [Pa/m], from the field.
    regimes : array (N, 3)
        A_e, A_ep, A_p of the field [1].
    """

    size: Array
    stiffness: Array
    regimes: Array

    def thin_spots(self, factor: Array) -> Self:
        return replace(
            super().thin_spots(factor),
            stiffness=self.stiffness * factor,
            regimes=self.regimes * factor[:, None],
        )

    @classmethod
    def scaled_from(cls, spots: AsperitySpots, count: Array, size: Array) -> Self:
        """Field spots from asperity spots, their number and size multiplied by (N,) factors."""
        share = spots.share
        number = spots.number.T if share is None else share * spots.number[:, 0]
        if share is None:
            number = np.broadcast_to(spots.number, (len(count), spots.number.shape[1]))

        def flatten_values(values: NDArray[Any]) -> NDArray[Any]:
            flat = values if share is None else values[:, 0]
            return np.broadcast_to(flat, number.shape)

        return cls(
            share=None,
            number=number * count[:, None],
            load=flatten_values(spots.load),
            area=flatten_values(spots.area) * size[:, None],
            regime=flatten_values(spots.regime),
            depth=flatten_values(spots.depth),
            R=spots.R,
            law=spots.law,
            E_star=spots.E_star,
            H=spots.H,
            heights=spots.heights,
            sigma_s=spots.sigma_s,
            lowest=spots.lowest,
            density=spots.density * count,
            size=size,
            stiffness=np.full_like(size, np.nan),
            regimes=np.full((len(size), 3), np.nan),
        )

    def area_at(self, omega: Array) -> Array:
        area = AsperitySpots.area_at(self, omega)
        return area * (self.size if np.ndim(area) == 1 else self.size[:, None])


@asperity_sum_of.register(Field)
def _of_field(law: Field, rough: Roughness, surfaces: MaterialPair, datum: float) -> FieldSum:
    return FieldSum(law, rough, surfaces, datum)
