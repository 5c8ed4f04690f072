"""What an asperity or a particle resists before it slides."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from ..contact.output import AbstractOutput, Column
from ..errors import Advice, Note
from ..laws.base import REGIMES
from ..numerics.quadrature import panel_rule
from ..populations.materials import reduced_modulus
from ..quantities.say import percent
from ..quantities.value import choice
from .friction import TIE, changes

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

    from ..contact.evaluation import Solved
    from ..contact.output import Probe
    from ..contact.spots import AsperitySpots
    from ..laws.spots import ParticleSpots
    from ..populations.materials import MaterialPair

    Array = NDArray[np.float64]

__all__ = ["StaticFriction", "full_stick", "kogut_etsion"]

FAILS = 6.264092264173105
"""ω/ω_c at which the cubic of Kogut and Etsion reaches zero."""


def kogut_etsion(omega_over_c: ArrayLike) -> Array:
    r"""Static friction of a sphere that has yielded under its normal load already.

    .. math:: \mu = \begin{cases} 0.52\,y^{-0.518} & y\le1\\
              -0.007y^3+0.085y^2-0.389y+0.822 & y>1\end{cases}

    Parameters
    ----------
    omega_over_c : array_like
        Interference over that of first yield y = ω/ω_c [1].

    Returns
    -------
    array
        μ [1]: infinite without load, zero from y = 6.264 on.

    Notes
    -----
    The published fits step from 0.520 to 0.511 at y = 1. Multiplied by the load of the same
    authors, 1.03 y^1.425, the cubic gives the tangential force that their rough-surface paper
    prints as 0.01, 0.09, 0.40 and 0.85; with those rounded numbers the force at y = 6 would be
    negative. Coefficients from memory: not confirmed in a source.

    References
    ----------
    Kogut, Etsion 2003, Tribol. Trans. 46, 383.

    Examples
    --------
    >>> print(kogut_etsion([1.0, 6.0, 7.0]).round(6))
    [0.52  0.036 0.   ]
    """
    y = np.asarray(omega_over_c, dtype=float)
    with np.errstate(divide="ignore"):
        low = 0.52 * np.maximum(y, 0.0) ** -0.518
    high = ((-0.007 * y + 0.085) * y - 0.389) * y + 0.822
    return np.where(y <= 1, low, np.where(y < FAILS, high, 0.0))


def full_stick(load_over_critical: ArrayLike) -> Array:
    r"""Static friction of a sphere that sticks to the flat.

    .. math:: \mu = 0.26\,\coth\left[0.27\,(P/P_c)^{0.46}\right]

    Parameters
    ----------
    load_over_critical : array_like
        Load over that of first yield P/P_c [1].

    Returns
    -------
    array
        μ [1]: infinite without load, 0.26 far beyond yield.

    Notes
    -----
    Coefficients from memory: not confirmed in a source.

    References
    ----------
    Brizmer, Kligerman, Etsion 2007, Tribol. Lett. 25, 61.

    Examples
    --------
    >>> print(full_stick([1.0, 1e6]).round(4))
    [0.9863 0.26  ]
    """
    with np.errstate(divide="ignore"):
        return 0.26 / np.tanh(0.27 * np.asarray(load_over_critical, dtype=float) ** 0.46)


def _first_yield(spots: AsperitySpots) -> float:
    """Interference of first yield ω_1 of the asperities [m]."""
    law = spots.law.bound(R=spots.R, E_star=spots.E_star, H=spots.H)
    return float(law.yield_interference(R=spots.R, E_star=spots.E_star, H=spots.H))


@dataclass(frozen=True, slots=True, kw_only=True)
class StaticFriction(AbstractOutput):
    r"""Coefficient of static friction from the tangential force that each contact can bear.

    .. math:: \mu_s\,p = \sum_{ss} n\,\mu(y)\,f + \sum_{sa} n\,\min_i \mu(y_i)\,f

    A particle gives way on the side that bears less.

    Parameters
    ----------
    law : {"full stick", "kogut-etsion"}, optional
        `full_stick`, or `kogut_etsion`, which lets a contact fail where it has yielded and finds
        no strength in a plastic one.

    Notes
    -----
    The loads that enter are those of the contact law in use; P_c is its load at first yield. Both
    formulas are fits to a deformable sphere on a flat, and to steady loading of one contact; the
    contacts fail together. The rule of Chang, Etsion and Bogy 1988 is left out: its equations
    could not be read.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     outputs=tb.outputs.StaticFriction(),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ... )
    >>> state = tb.solve(contact, pressure=5e6)
    >>> round(float(state.outputs["mu_static"]), 3)
    0.335
    """

    law: Literal["full stick", "kogut-etsion"] = choice(
        "static friction of one contact", default="full stick"
    )

    name = "static_friction"
    title = "Static friction"
    year = 2007
    citation = (
        "Brizmer, Kligerman, Etsion 2007, Tribol. Lett. 25, 61; Kogut, Etsion 2003, Tribol. "
        "Trans. 46, 383"
    )
    provenance = "recalled"
    valid_range = "contacts that stick; Kogut–Etsion: asperities that are not plastic"
    columns = {
        "mu_static": Column("μ_s", "1", "coefficient of static friction"),
        "mu_static_ss": Column("μ_s,ss", "1", "part of μ_s from asperities"),
        "mu_static_sa": Column("μ_s,sa", "1", "part of μ_s from particles"),
    }

    def _force(self, y: Array, load: Array, critical: Array | float) -> Array:
        """Largest tangential force of a contact [N] at y = ω/ω_c; ``critical`` is P_c."""
        loaded = (load > 0) & (y > 0)
        if self.law == "full stick":
            mu = full_stick(np.where(loaded, load, critical) / critical)
        else:
            mu = kogut_etsion(np.where(loaded, y, 1.0))
        return np.where(loaded, mu * load, 0.0)

    def of_asperities(self, spots: AsperitySpots) -> Array:
        """Largest tangential force of one asperity [N]: (M, n)."""
        omega_1 = _first_yield(spots)
        critical = spots.load_at(np.asarray(omega_1))
        return self._force(spots.depth / omega_1, spots.load, critical)

    def _all(self, spots: AsperitySpots) -> Array:
        """Largest tangential force of all asperities [Pa]: (N,)."""
        if self.law == "full stick":
            return spots.total(self.of_asperities(spots))
        # those that have not failed are few and shallow: a sum of their own, split at the jump
        omega_1 = _first_yield(spots)
        step = omega_1 / spots.sigma_s
        top = np.maximum(spots.heights.highest - spots.lowest, 0.0) / step
        edges = np.minimum(np.array([0.0, 1.0, FAILS]), top[:, None])
        root, weight = panel_rule(np.sqrt(edges), 24)
        y = root**2
        force = kogut_etsion(y) * spots.load_at(y * omega_1)
        many = spots.heights.pdf(spots.lowest[:, None] + y * step) * step
        return spots.density * np.sum(2 * root * weight * many * force, axis=-1)

    def of_particles(self, spots: ParticleSpots, surfaces: MaterialPair) -> Array:
        """Largest tangential force of one particle [N]: (M, n)."""
        particle = spots.population.material if spots.population else surfaces.first
        bears = []
        for body, depth, first in zip(
            (surfaces.first, surfaces.second), spots.depths, spots.yields, strict=True
        ):
            omega_1 = first * spots.x
            critical = 4 / 3 * reduced_modulus(particle, body) * np.sqrt(spots.radius * omega_1**3)
            bears.append(self._force(depth / omega_1, spots.load, critical))
        return np.minimum(*bears)

    def of(self, state: Solved) -> dict[str, Array]:
        surfaces = state.contact.surfaces
        T_ss = sum((self._all(spots) for spots in state.asperities), np.zeros_like(state.d))
        T_sa = state.total_of_particles(lambda spots: self.of_particles(spots, surfaces))
        with np.errstate(invalid="ignore", divide="ignore"):
            return {
                "mu_static": (T_ss + T_sa) / state.pressure,
                "mu_static_ss": T_ss / state.pressure,
                "mu_static_sa": T_sa / state.pressure,
            }

    def splits(self, probe: Probe) -> Sequence[float]:
        if self.law == "full stick":
            return []

        def kind(spots: ParticleSpots) -> NDArray[np.intp]:
            one, two = (
                depth / (first * spots.x)
                for depth, first in zip(spots.depths, spots.yields, strict=True)
            )
            larger = np.maximum(one, two)
            return (larger > 1) + 2 * (larger > FAILS) + 4 * (one > two * (1 + TIE))

        return changes(probe, kind)

    def warnings(self, state: Solved, values: Mapping[str, Array]) -> list[str]:
        if self.law == "full stick" or not state.particles:
            return []
        plastic = REGIMES.index("plastic")

        def plastic_load(spots: ParticleSpots) -> Array:
            return spots.load * (np.maximum(*spots.regimes) == plastic)

        F_sa = state.total_of_particles(lambda spots: spots.load)
        F_p = state.total_of_particles(plastic_load)
        share = np.max(np.divide(F_p, F_sa, out=np.zeros_like(F_p), where=F_sa > 0), initial=0)
        if share <= 0.01:
            return []
        what = (
            f"outputs.static_friction: {percent(share, digits=2)} of the particles' load is on "
            "plastic contacts, to which Kogut–Etsion give no friction at all"
        )
        code = f"{self.name}.plastic"
        action = Advice("use law='full stick'", 'use law = "full stick"')
        return [Note(what, code=code, effect=float(share), action=action)]
