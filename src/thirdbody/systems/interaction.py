r"""Asperities that feel each other: two corrections of a contact's separation and load.

`mean`: the nominal pressure sinks the whole summit plane by

.. math:: U = \kappa\,\bar p\,\sqrt{A_n}/E^*, \qquad \bar p = F_t(d_0 + U)

A displacement common to all asperities shifts d and nothing else: *at a given load* the real
area, every share and the mode are those without interaction; only the separation d_0 from the
undeformed plane and the stiffness change. The result needs a nominal area: a larger specimen at
equal pressure sinks deeper. A periodic cell has no such term.

`local`: the mean displacement smears every load over its share of the nominal area, the load of
the asperity itself included, which is already in its own law. Taken back out,

.. math:: \omega_i = z_i - d + c\,\sqrt{\bar p\,W_i}/E^*, \qquad W_i = F_1(\omega_i), \qquad
          \bar p = \eta\,\overline{W}

with d measured from the *deformed* mean plane of summits: from there the correction is positive
and raises the load. Measured from the undeformed plane, d_0 = d − U, the sum of both lowers the
load of any specimen with many asperities. This correction does change the area at a given load.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..contact.contact import Contact
from ..contact.interface import interface
from ..equilibrium.columns import Equilibrium
from ..equilibrium.load_scan import load_scan
from ..equilibrium.solve import given_load, solve
from ..equilibrium.status import DEEPEST, Status
from ..errors import InvalidValue, Mistake, NoEquilibrium, Problem
from ..laws.base import REGIMES
from ..numerics.quadrature import panel_rule, subdivide
from ..numerics.roots import halley_root
from ..populations.heights import GaussianHeights
from ..quantities.carried import takes_units
from ..quantities.record import StateRecord, Variable, column
from ..quantities.say import value_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]
    Number = float | Array

__all__ = [
    "DISC_CENTRE",
    "DISC_MEAN",
    "SQUARE_CENTRE",
    "SQUARE_MEAN",
    "LocalInteraction",
    "MeanInteraction",
    "local_interaction",
    "mean_interaction",
]


def __dir__() -> list[str]:
    return sorted(__all__)


SQUARE_CENTRE = 4 * math.log(1 + math.sqrt(2)) / math.pi
"""U E*/(p √A) at the centre of a square under uniform pressure: 1.1222."""
SQUARE_MEAN = 4 / math.pi * (math.log(1 + math.sqrt(2)) + (1 - math.sqrt(2)) / 3)
"""The same, averaged over the square: 0.9464."""
DISC_CENTRE = 2 / math.sqrt(math.pi)
"""U E*/(p √A) at the centre of a disc under uniform pressure: 1.1284."""
DISC_MEAN = 16 / (3 * math.pi**1.5)
"""The same, averaged over the disc: 0.9578."""


# ------------------------------------------------------------------------------ mean
@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class MeanInteraction(StateRecord):
    """A contact whose summit plane sinks under its own nominal pressure.

    Made by `mean_interaction`, where the source stands.

    Attributes
    ----------
    state : Equilibrium
        The contact at the separation d that the asperities see: loads, areas, shares, mode.
    d_0 : float or array
        Separation from the undeformed plane [m], d − U.
    U : float or array
        Sinking of the summit plane [m].
    stiffness, summit_stiffness : float or array
        −dp/dd_0 with, and −dp/dd without the displacement [Pa/m].
    nominal_area, kappa : float
        A_n [m²] and the shape factor κ [1].

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.interaction import mean_interaction
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> sunk = mean_interaction(contact, nominal_area=1e-6, pressure=5e6)
    >>> sunk.stiffness < sunk.summit_stiffness
    True
    """

    in_dict = (("", "state"), ("", "columns"), "nominal_area", "kappa")
    state: Equilibrium
    d_0: Number = column("d_0", "m", "separation from the undeformed plane, d − U")
    U: Number = column("U", "m", "sinking of the summit plane")
    stiffness: Number = column("−dp/dd_0", "Pa/m", "stiffness with the displacement")
    summit_stiffness: Number = column("−dp/dd", "Pa/m", "stiffness without the displacement")
    nominal_area: float
    kappa: float

    def variables(self) -> dict[str, Variable]:
        """The columns of the state, and these."""
        return {**self.state.variables(), **StateRecord.variables(self)}

    def coordinates(self) -> Mapping[str, Variable]:
        """Those of the state."""
        return self.state.coordinates()

    def attributes(self) -> dict[str, object]:
        """Those of the state, the nominal area and its shape factor."""
        numbers = {"nominal_area": self.nominal_area, "kappa": self.kappa}
        return {**self.state.attributes(), **numbers}


@takes_units
def mean_interaction(
    contact: Contact,
    *,
    nominal_area: float,
    kappa: float = 1.0,
    pressure: ArrayLike | None = None,
    F_star: ArrayLike | None = None,
    d_0: ArrayLike | None = None,
) -> MeanInteraction:
    r"""Interaction by the mean displacement, after Ciavarella, Greenwood and Paggi.

    .. math:: \bar p = F_t\left(d_0 + \kappa\,\bar p\,\sqrt{A_n}/E^*\right)

    At a given load only d_0 and the stiffness differ from `solve`.

    Parameters
    ----------
    contact : Contact
        Particles included.
    nominal_area : float
        A_n [m²], macroscopic.
    kappa : float, optional
        κ [1]: 1 as published; `SQUARE_CENTRE`, `SQUARE_MEAN`, `DISC_CENTRE`, `DISC_MEAN` for a
        uniformly loaded square or disc.
    pressure, F_star : float or array, optional
        Nominal pressure [Pa] or F* [1].
    d_0 : float or array, optional
        Separation from the undeformed plane [m]. Exactly one of the three.

    Returns
    -------
    MeanInteraction

    Raises
    ------
    InvalidValue
        A law of the whole surface (`thirdbody.asperity.Field`), which holds the interaction.

    Notes
    -----
    Provenance: recalled; the shape factors are derived. The balance has one root where the load
    falls with d. ``1/stiffness = 1/summit_stiffness + κ√A_n/E*``.

    References
    ----------
    Ciavarella, Greenwood, Paggi 2008, Wear 265, 729, doi:10.1016/j.wear.2008.01.019
    (DOI from memory).

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.interaction import mean_interaction
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> sunk = mean_interaction(contact, nominal_area=1e-6, pressure=5e6)
    >>> round(sunk.U * 1e9, 2), sunk.state.A_t == tb.solve(contact, pressure=5e6).A_t
    (44.68, True)
    """
    for name, value in (("nominal_area", nominal_area), ("kappa", kappa)):
        if not (math.isfinite(value) and value > 0):
            raise InvalidValue(Problem(name, "must be > 0", repr(value), code=Mistake.RANGE))
    _check_sum(contact)
    solids = interface(contact)
    compliance = kappa * math.sqrt(nominal_area) / contact.E_ss
    if d_0 is None:
        state = solve(contact, pressure=pressure, F_star=F_star)
    else:
        _, start, scalar = given_load(contact, pressure, F_star, d_0)
        if not load_scan(solids).monotone:
            raise InvalidValue(
                "the load of this contact does not fall everywhere with d, so one d_0 may belong "
                "to several states; give the load instead of d_0",
                code=Mistake.BEYOND,
            )

        def gap(d: Array, which: NDArray[np.intp]) -> tuple[Array, Array, Array]:
            p, slope, bend = solids.load(d).T
            return start[which] + compliance * p - d, compliance * slope - 1, compliance * bend

        skin = solids.asperities
        lowest = np.maximum(start, skin.centre + DEEPEST * skin.sigma_s)
        highest = start + compliance * solids.load(lowest)[:, 0]
        if np.any(deep := highest < lowest):
            raise NoEquilibrium(
                f"at d_0 = {value_of(start[deep][0], 'm')} the asperities stand below {DEEPEST:g} "
                "sigma_s, where every one is in contact",
                Status.TOO_DEEP,
            )
        d, *_ = halley_root(gap, lowest, highest, lowest)
        state = solve(contact, d=float(d[0]) if scalar else d)
    is_solved = np.isfinite(np.atleast_1d(state.d))
    slope = np.full(is_solved.shape, np.nan)
    slope[is_solved] = -solids.load(np.atleast_1d(state.d)[is_solved])[:, 1]
    summit: Number = slope if np.ndim(state.d) else float(slope[0])
    U = compliance * state.pressure
    return MeanInteraction(
        state=state,
        d_0=state.d - U,
        U=U,
        stiffness=summit / (1 + compliance * summit),
        summit_stiffness=summit,
        nominal_area=nominal_area,
        kappa=kappa,
    )


def _check_sum(contact: Contact) -> None:
    """Refuse laws of a whole surface, which include the interaction already."""
    if contact.asperity_law.of_surface:
        raise InvalidValue(
            f"asperity_law {contact.asperity_law.name}: its pressures already press each other's "
            "ground down, and interaction would count that twice; call solve, or take a law of "
            'single asperities, e.g. "zmc"; how two bodies sink in as a whole is that of '
            "rough_body",
            code=Mistake.BEYOND,
        )


# ------------------------------------------------------------------------------ local
@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class LocalInteraction(StateRecord):
    """Asperities whose own load is taken out of the mean displacement.

    Made by `local_interaction`, where the source stands.

    Attributes
    ----------
    d : float or array
        Separation from the deformed mean plane of summits [m].
    d_0 : float, array or None
        Separation from the undeformed plane [m], d − κp√A_n/E*; None without a nominal area.
    pressure, F_star : float or array
        Nominal pressure [Pa], F/(A_n E*) [1].
    pressure_alone : float or array
        The pressure without interaction at the same d [Pa].
    A_t, A_e, A_ep, A_p : float or array
        Real contact area per nominal area [1], and its elastic, elastoplastic, plastic parts.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.interaction import local_interaction
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> near = local_interaction(contact, d=100e-9)
    >>> round(near.pressure / near.pressure_alone, 2)
    1.08
    """

    contact: Contact = field(repr=False)
    d: Number = column("d", "m", "separation from the deformed mean plane of summits")
    d_0: Number | None = column("d_0", "m", "separation from the undeformed plane")
    pressure: Number = column("p", "Pa", "nominal pressure")
    F_star: Number = column("F*", "1", "F/(A_n E*)")
    pressure_alone: Number = column("p", "Pa", "nominal pressure without interaction at this d")
    A_t: Number = column("A_t*", "1", "real contact area")
    A_e: Number = column("A_e*", "1", "real area in elastic contact")
    A_ep: Number = column("A_ep*", "1", "real area in elastoplastic contact")
    A_p: Number = column("A_p*", "1", "real area in plastic contact")


class _SelfLoaded:
    """Sums over asperities with ω − c√(pF_1(ω))/E* as the height above the separation."""

    PANELS, NODES = 32, 20

    def __init__(self, contact: Contact):
        if not contact.two_body:
            raise InvalidValue(
                "local interaction is derived for asperities; it has no form for particles. "
                "Use mean_interaction, or a contact without particles",
                code=Mistake.BEYOND,
            )
        rough, surfaces = contact.roughness, contact.surfaces
        if rough.ellipticity is not None:
            raise InvalidValue(
                "local interaction is derived for asperities of one shape; use mean_interaction, "
                "or a law with one ratio and a roughness without ellipticity",
                code=Mistake.BEYOND,
            )
        self.E_star = contact.E_ss
        self.R, self.sigma_s, self.density = rough.R, rough.sigma_s, rough.density
        self.heights = rough.heights
        self.sum = interface(contact).asperities
        self.centre = self.sum.centre
        law = self.law = contact.asperity_law.bound(
            R=self.R, E_star=self.E_star, H=surfaces.H, nu=surfaces.softer.nu
        )
        if law.start < 0 or np.any(law.reduced("force", np.geomspace(1e-12, 1e3, 200)) < 0):
            raise InvalidValue(
                f"local interaction needs F_1 >= 0; {law.title} is adhesive", code=Mistake.BEYOND
            )
        self.omega_1 = float(law.yield_interference(R=self.R, E_star=self.E_star, H=surfaces.H))
        self.unit = math.pi * self.R * self.omega_1
        self.force_unit = self.unit * surfaces.H

    def alone(self, d: float) -> float:
        return float(self.sum.load(np.array([d]))[0, 0])

    def _above(self, omega: Array, branch: int, pressure: float) -> Array:
        """z − d [m] of the asperity with interference ω, by the formula of one branch."""
        force = self.force_unit * self.law.branches[branch].force(omega / self.omega_1)
        return omega - SQUARE_CENTRE * np.sqrt(pressure * force) / self.E_star

    def _passes(self, branch: int, pressure: float, low: float, high: float, level: float) -> float:
        """Interference of a branch from which on the height stays above ``level``."""
        from scipy.optimize import brentq

        def above(omega: float) -> float:
            return float(self._above(np.array([omega]), branch, pressure)[0]) - level

        grid = np.geomspace(max(low, 1e-30 * high), high, 600)
        below = np.flatnonzero(self._above(grid, branch, pressure) <= level)
        if not len(below):
            return low
        if below[-1] == len(grid) - 1:
            return high
        return brentq(above, grid[below[-1]], grid[below[-1] + 1], xtol=1e-300, rtol=1e-15)

    def _ranges(self, pressure: float, reach: float) -> list[tuple[int, float, float]]:
        """Branch and range of ω met as the height z − d rises from 0 to ``reach`` [m]."""
        ends = [y * self.omega_1 for y in self.law.breakpoints] + [math.inf]
        out = []
        low, level = 0.0, 0.0
        for branch, end in enumerate(ends):
            high = end
            if math.isinf(high):
                high = low + reach
                while self._above(np.array([high]), branch, pressure)[0] < reach:
                    high *= 1.5
                    if high > 1e6 * self.R:
                        raise NoEquilibrium("local interaction runs away at this pressure")
            start = self._passes(branch, pressure, low, high, level)
            if high > start:
                out.append((branch, start, high))
                level = max(level, float(self._above(np.array([high]), branch, pressure)[0]))
            low = high
            if level >= reach:
                break
        return out

    def __call__(self, d: float, pressure: float) -> Array:
        """Pressure [Pa] and area by regime of asperities under a nominal pressure: (4,)."""
        h = (d - self.centre) / self.sigma_s
        top = self.heights.pieces[-1] - h
        if isinstance(self.heights, GaussianHeights):
            # the density falls by e^-50 within this
            top = min(top, math.sqrt(max(h, 0.0) ** 2 + 100) - h)
        out = np.zeros(4)
        if top <= 0:
            return out
        knots = (np.array([*self.heights.kinks, self.heights.pieces[-1]]) - h) * self.sigma_s
        for branch, start, high in self._ranges(pressure, top * self.sigma_s):
            law = self.law.branches[branch]
            bottom, peak = self._above(np.array([start, high]), branch, pressure)
            inside = knots[(knots > bottom) & (knots < peak)]
            marks = [self._passes(branch, pressure, start, high, float(z)) for z in inside]
            edges = np.array(sorted({start, high, *marks})) ** 0.25
            fine = subdivide(edges, width=(edges[-1] - edges[0]) / self.PANELS)
            # F_1 starts like ω^(3/2): in ω^(1/4) the height is smooth
            root, weight = panel_rule(fine, self.NODES)
            omega = root**4
            y = omega / self.omega_1
            reduced = law.force(y)
            force = self.force_unit * reduced
            push = SQUARE_CENTRE / self.E_star * np.sqrt(pressure * force)
            stiffness = self.force_unit / self.omega_1 * law.stiffness(y)
            rising = 1 - 0.5 * push * stiffness / force
            z = h + (omega - push) / self.sigma_s
            density = self.heights.pdf(z) * rising * 4 * root**3 * weight / self.sigma_s
            out[0] += self.density * (density @ force)
            area = self.density * self.unit * (density @ law.area(y))
            out[1 + REGIMES.index(law.regime)] += area
        return out

    def at_gap(self, d: float) -> float:
        """The least pressure [Pa] in balance at d."""
        from scipy.optimize import brentq

        def excess(pressure: float) -> float:
            return self(d, pressure)[0] / pressure - 1

        low = high = self.alone(d)
        if low == 0:
            return 0.0
        while excess(high) > 0:
            low, high = high, 1.15 * high
            if high > 0.3 * self.E_star:
                raise NoEquilibrium(f"local interaction runs away at d = {value_of(d, 'm')}")
        if high == low:
            return low
        return brentq(excess, low, high, xtol=1e-300, rtol=1e-14)

    def at_load(self, pressure: float, d: float) -> float:
        """Separation [m] that carries a pressure; ``d`` does so without interaction."""
        from scipy.optimize import brentq

        def excess(gap: float) -> float:
            return math.log(max(self(gap, pressure)[0], 1e-300) / pressure)

        low, high = d, d + 0.1 * self.sigma_s
        if excess(low) <= 0:
            return low
        while excess(high) > 0:
            low, high = high, high + 2 * (high - low)
            if high > 1e6 * self.R:
                raise NoEquilibrium(
                    f"local interaction carries {value_of(pressure, 'Pa')} at every gap"
                )
        return brentq(excess, low, high, xtol=1e-14 * self.sigma_s, rtol=1e-15)


@takes_units
def local_interaction(
    contact: Contact,
    *,
    pressure: ArrayLike | None = None,
    F_star: ArrayLike | None = None,
    d: ArrayLike | None = None,
    nominal_area: float | None = None,
    kappa: float = 1.0,
) -> LocalInteraction:
    r"""Interaction asperity by asperity, after Zhao and Chang.

    .. math:: z - d = \omega - \frac{c}{E^*}\sqrt{\bar p\,F_1(\omega)}, \qquad
              c = \frac{4}{\pi}\ln(1+\sqrt2) = 1.122

    c is the displacement at the centre of the square over which the mean displacement spreads
    an asperity's load. An asperity touches when z = d and then follows the least interference
    that belongs to its height. Where F_1 jumps up, the asperity jumps with it.

    Parameters
    ----------
    contact : Contact
        Without particles.
    pressure, F_star : float or array, optional
        Nominal pressure [Pa] or F* [1].
    d : float or array, optional
        Separation from the *deformed* mean plane of summits [m]: from there the correction
        raises the load. Exactly one of the three.
    nominal_area, kappa : float, optional
        With A_n [m²], ``d_0 = d − κp√A_n/E*`` from the undeformed plane is given too.

    Returns
    -------
    LocalInteraction

    Raises
    ------
    InvalidValue
        Particles, elliptic or adhesive tips, or a law of the whole surface
        (`thirdbody.asperity.Field`), which holds the interaction.

    Notes
    -----
    Provenance: the formula 1.12√(pW)/E* recalled, rederived here. For a given separation the
    least pressure in balance is taken. Relative error 1e-12 for Gaussian heights and GW.

    References
    ----------
    Zhao, Chang 2001, J. Tribol. 123, 857, doi:10.1115/1.1338482.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.interaction import local_interaction
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> near = local_interaction(contact, pressure=100e6)
    >>> alone = tb.solve(contact, pressure=100e6)
    >>> round((near.d - alone.d) * 1e9, 3), round(near.A_t / alone.A_t - 1, 4)
    (5.588, -0.009)
    """
    _check_sum(contact)
    name, values, scalar = given_load(contact, pressure, F_star, d)
    sums = _SelfLoaded(contact)
    if nominal_area is not None and not nominal_area > 0:
        raise InvalidValue(
            Problem("nominal_area", "must be > 0 [m^2]", repr(nominal_area), code=Mistake.RANGE)
        )
    if name == "d":
        gaps = values
        loads = np.array([sums.at_gap(float(gap)) for gap in values])
    else:
        loads = values
        starts = np.atleast_1d(solve(contact, pressure=loads).d)
        gaps = np.array(
            [
                sums.at_load(float(p), float(start)) if np.isfinite(start) else np.nan
                for p, start in zip(loads, starts, strict=True)
            ]
        )
        if scalar and np.isnan(gaps[0]):
            raise NoEquilibrium(
                f"no equilibrium: no separation above {DEEPEST:g} sigma_s carries "
                f"{value_of(loads[0], 'Pa')}"
            )
    rows = np.array(
        [
            sums(float(gap), float(p)) if np.isfinite(gap) else np.full(4, np.nan)
            for gap, p in zip(gaps, loads, strict=True)
        ]
    )
    alone = sums.sum.load(gaps)[:, 0]
    out: dict[str, Any] = {
        "d": gaps,
        "pressure": loads,
        "F_star": loads / contact.E_ss,
        "pressure_alone": alone,
        "A_t": rows[:, 1:].sum(axis=1),
        **{key: rows[:, 1 + i] for i, key in enumerate(("A_e", "A_ep", "A_p"))},
        "d_0": None,
    }
    if nominal_area is not None:
        out["d_0"] = gaps - kappa * loads * math.sqrt(nominal_area) / contact.E_ss
    if scalar:
        out = {key: None if v is None else float(v[0]) for key, v in out.items()}
    return LocalInteraction(contact=contact, **out)
