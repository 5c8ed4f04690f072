"""One side of an angular particle: a rounded tip, then faces that stay similar to themselves."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..base import REGIMES
from .one_particle import Side

if TYPE_CHECKING:
    from ...populations.shape import Angular
    from ..base import AbstractAsperityLaw
    from .one_particle import Array, Index

__all__ = ["FacedSide", "Faces"]


class FacedSide(Side):
    r"""The contact of a tip of radius r up to the radius b = r tan β, of a cone from there on.

    .. math:: a = b + (\delta-\delta_j)\cot\beta/r_c, \qquad p = p(\delta_j), \qquad
        r_c = 1 + \left(\frac\pi2-1\right)\left(\frac{\delta_j}{\delta_t}-1\right)

    with the indentation δ_j at which the law reaches b and δ_t = r tan²β/2, up to A = πφ²/4. r_c,
    depth over that of the cone without pile-up or sinking in, is 1 for a plastic tip and π/2,
    Sneddon's, for an elastic one; between them a line is chosen.

    Attributes
    ----------
    joint : float
        y = δ/δ_1 at which the faces begin.
    pressure : float
        Mean pressure on the faces over H.
    """

    def __init__(
        self, law: AbstractAsperityLaw, E_star: float, H: float, nu: float, shape: Angular
    ):
        R = shape.tip_radius
        self.law, self.H, self.R = law.bound(R=R, E_star=E_star, H=H, nu=nu), H, R
        self.delta_1 = self.law.yield_interference(R=R, E_star=E_star, H=H)
        self.unit = R * math.pi * self.delta_1 * H
        self.plateau = self.law.branches[-1].regime == "plastic"
        self.full = 0.25 * shape.breadth / (R * self.delta_1)
        edge = shape.edge**2 / (R * self.delta_1)
        self.joint = float(self._indentation_at_area(edge))
        force, area = (self.law.reduced(name, self.joint) for name in ("force", "area"))
        self.pressure = float(force / area)
        deeper = 1 + (math.pi / 2 - 1) * (2 * self.joint / edge - 1)
        # of the square root of the reduced area
        self.start = math.sqrt(edge)
        self.rate = math.sqrt(self.delta_1 / R) / (math.tan(shape.angle) * deeper)
        self.cap = np.array(self.joint + (math.sqrt(self.full) - self.start) / self.rate)
        inner = [y for y in self.law.breakpoints if y < self.joint]
        self.kinks = np.array([*inner, self.joint, float(self.cap)])
        self.limit = self.unit * self.reduced_force(2 * self.kinks[-1:])

    def reduced_area(self, y: Array) -> Array:
        y = np.asarray(y, dtype=float)
        faces = self.start + self.rate * (np.minimum(y, self.cap) - self.joint)
        area = np.minimum(np.square(faces), self.full)
        return np.where(y < self.joint, self.law.reduced("area", y), area)

    def reduced_force(self, y: Array) -> Array:
        y = np.asarray(y, dtype=float)
        faces = self.pressure * self.reduced_area(y)
        return np.where(y < self.joint, self.law.reduced("force", y), faces)

    def regime(self, delta: Array) -> Index:
        """Regime of the joint, until the contact ends."""
        y = delta / self.delta_1
        regime = Side.regime(self, np.minimum(y, self.joint) * self.delta_1)
        return np.where((y >= self.cap) & self.plateau, REGIMES.index("plastic"), regime)


@dataclass(frozen=True)
class Faces:
    """Form of an angular side of a particle."""

    shape: Angular

    def side(self, law: AbstractAsperityLaw, E_star: float, H: float, nu: float, R: float) -> Side:
        """Contact of this side; that of its tip if the faces lie beyond the end of the contact."""
        if self.shape.has_touching_faces:
            return FacedSide(law, E_star, H, nu, self.shape)
        return Side(law, E_star, H, nu, R, breadth=self.shape.breadth)
