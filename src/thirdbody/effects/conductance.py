"""How well the contact conducts heat and current: through asperities, particles, and the gap."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np

from ..contact.evaluation import bodies_of
from ..contact.field_sums import FieldSpots
from ..contact.output import AbstractOutput, Column, changes, missing
from ..errors import Mistake, Note
from ..populations.conduction import conducts
from ..populations.materials import Material
from ..quantities.say import number, percent
from ..quantities.value import choice, quantity
from .single.heat import (
    Spreading,
    absolute_slope,
    cooper_mikic_yovanovich,
    particle_resistance,
    sphere_resistance,
    spot_resistance,
    spreading,
)
from .single_contacts import single_contacts

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..contact.contact import Contact
    from ..contact.evaluation import Solved
    from ..contact.output import Probe
    from ..contact.spots import AsperitySpots
    from ..laws.spots import ParticleSpots
    from ..populations.particles import Particles
    from .single_contacts import SingleContacts

    Array = NDArray[np.float64]
    Resistivity = Callable[[Material], float]
    _Conductance: TypeAlias = "ThermalConductance | ElectricalConductance"

__all__ = ["ElectricalConductance", "ThermalConductance"]

ONE, SMALL = 1.0, 1e-6
"""Contacts of an area below which it is mostly open, and the area [m²] if none is given."""
BY_MATERIAL = "by material"
WIDE = 0.5
"""Contact radius over particle radius above which the particle's resistance is far off."""


def _through_asperities(
    state: Solved,
    rho: Resistivity,
    form: Spreading,
    *,
    film: float = 0.0,
    mean_free_path: float = 0.0,
) -> Array:
    """Σ n/(ψR) of the asperities per nominal area: (N,)."""
    pair = state.contact.surfaces
    rho_1, rho_2 = rho(pair.first), rho(pair.second)

    def conductance(spots: AsperitySpots, film: float, mean_free_path: float) -> Array:
        touches = spots.area > 0
        b = np.sqrt(np.where(touches, spots.area, 1.0) / np.pi)
        R = spot_resistance(b, rho_1=rho_1, rho_2=rho_2, film=film, mean_free_path=mean_free_path)
        return np.where(touches, 1 / R, 0.0)

    def total_conductance(film: float, mean_free_path: float) -> Array:
        return state.total(lambda spots: conductance(spots, film, mean_free_path))

    if patches := [patch for patch in state.asperities if isinstance(patch, FieldSpots)]:
        whole = sum((patch.stiffness / patch.E_star for patch in patches), np.zeros_like(state.d))
        of_patches = 2 / (rho_1 + rho_2) * whole
        if film or mean_free_path:  # in series, as spots have them
            with np.errstate(divide="ignore", invalid="ignore"):
                more = 1 / total_conductance(film, mean_free_path) - 1 / total_conductance(0.0, 0.0)
                of_patches = np.where(of_patches > 0, 1 / (1 / of_patches + more), 0.0)
        return of_patches
    A_ss = state.total(lambda spots: spots.area)
    psi = spreading(np.sqrt(np.minimum(A_ss, 1.0)), form=form)
    return total_conductance(film, mean_free_path) / psi


def _through_particles(
    state: Solved,
    rho: Resistivity,
    output: _Conductance,
    *,
    film: float = 0.0,
    mean_free_path: float = 0.0,
) -> Array:
    """Σ n/R of the particles that conduct per nominal area: (N,)."""
    pair = state.contact.surfaces
    if not _some_conduct(output, state.contact):
        return np.zeros_like(state.d)

    def conductance(spots: ParticleSpots) -> Any:
        assert spots.population is not None
        if not output.passes(spots.population):
            return 0.0
        rho_particle = rho(spots.population.material)
        touches = (spots.areas[0] > 0) & (spots.areas[1] > 0)
        b_1, b_2 = (np.sqrt(np.where(touches, area, 1.0) / np.pi) for area in spots.areas)
        radius = np.where(touches, spots.x / 2, 1.0)
        R = particle_resistance(b_1, a_2=b_2, r=radius, height=spots.height, k=1 / rho_particle)
        # its own constrictions are part of that; the other body, film and Γ come on top
        for b, material in ((b_1, pair.first), (b_2, pair.second)):
            spot = spot_resistance(
                b, rho_1=rho(material), rho_2=rho_particle, film=film, mean_free_path=mean_free_path
            )
            R = R + spot - rho_particle / (4 * b)
        return np.where(touches, 1 / R, 0.0)

    return state.total_of_particles(conductance)


def _conducting(state: Solved, output: _Conductance) -> Array:
    """Contacts through which something flows, per nominal area (N,) [1/m²]."""
    n = state.total(lambda spots: spots.area > 0)
    if _some_conduct(output, state.contact):
        n = n + state.total_of_particles(
            lambda spots: (
                output.passes(spots.population) & (spots.areas[0] > 0) & (spots.areas[1] > 0)
            )
        )
    return n


def _some_conduct(output: _Conductance, contact: Contact) -> bool:
    """Whether anything flows through particles."""
    return any(map(output.passes, contact.populations))


def _closing(
    output: _Conductance, state: Solved, means: dict[str, Array], closed: str
) -> dict[str, Array]:
    """Columns that are means over many contacts of A_n (NaN where it is open), and P_c."""
    if output.A_n is None:
        return means | {closed: np.full_like(state.d, np.nan)}
    count = output.A_n * _conducting(state, output)
    out = means | {closed: -np.expm1(-count)}
    is_open = count < ONE
    conduct = _some_conduct(output, state.contact)
    singles = single_contacts(output, state, tuple(means), closed, conduct=conduct)
    if singles is not None:
        out = {
            name: np.where(singles.concerned, singles.values[name], value)
            for name, value in out.items()
        }
        is_open = np.where(singles.concerned, out[closed] < -math.expm1(-ONE), is_open)
    state.kept[output] = singles
    if output.few == "open":
        out |= {
            name: np.where(is_open, np.nan, out[name])
            for name in means
            if name.endswith(("_ss", "_sa"))
        }
    return out


def _about_single(output: _Conductance, singles: SingleContacts, closed: str) -> list[str]:
    """Notes on areas with so few particles that contacts with and without them differ."""
    say = f"outputs.{output.name}: A_n = {number(output.A_n)} m²"
    out: list[str] = []
    unknown = singles.concerned & np.isnan(singles.values[closed])
    if np.any(solved := singles.concerned & ~unknown):
        i = int(np.flatnonzero(solved)[np.argmax(singles.without[solved])])
        what = (
            f"{say} has no particle in the way in {percent(float(singles.without[i]))} of all "
            f"contacts, closed there with probability {number(float(singles.clean[i]))}: {closed} "
            "and the conductances are means over contacts with and without, each under the whole "
            "load; mode and shares of the state are of a surface that spreads it over all particles"
        )
        action = "a table [connector] tells how often single contacts stay open, and of how many"
        out.append(Note(what, code=f"{output.name}.single", effect=1.0, action=action))
    for i in np.flatnonzero(unknown)[:1]:
        low, high = float(singles.low[i]), float(singles.high[i])
        why = (
            f"holds so few particles under load that chance decides which they are: {closed} is "
            f"between {number(low)} and {number(high)}"
        )
        if math.isnan(high):
            why = f"does not carry the load without particles: {closed} is not known"
        what, code = f"{say} {why} (NaN)", f"{output.name}.unknown"
        out.append(Note(what, code=code, effect=math.inf, action="a larger A_n holds more"))
    return out


def _about_open(
    output: _Conductance, state: Solved, numbers: str, which: Any = slice(None)
) -> list[str]:
    """Notes on states in which fewer than one contact conducts."""
    n = _conducting(state, output)[which]
    if not len(n):
        return []
    least = float(np.min(n))
    say, code = f"outputs.{output.name}: ", f"{output.name}.open"
    if output.A_n is None:
        if not 0 < least * SMALL < ONE:
            return []
        what = (
            f"{say}on average one contact conducts in {number(1 / least)} m²: a smaller area is "
            "mostly open, and this is the mean over many"
        )
        return [Note(what, code=code, effect=1.0, action="give A_n")]
    count = output.A_n * least
    if not count < ONE:
        return []
    if not count:  # the mean over such areas is that of each: 0
        what = f"{say}at some loads nothing in A_n conducts: it is open there ({numbers} are NaN)"
        return [Note(what, code=code, effect=math.inf)] if output.few == "open" else []
    chance = f"closed with probability {number(-math.expm1(-count))}"
    what = (
        f"{say}A_n = {number(output.A_n)} m² holds {number(count)} contacts that conduct on average"
    )
    if output.few == "open":
        what = f"{what}: it is open ({numbers} are NaN), {chance}"
        return [Note(what, code=code, effect=math.inf, action='few = "mean" gives the mean')]
    what = f"{what}: most such areas are open ({chance}), and this is the mean over all of them"
    return [Note(what, code=code, effect=1.0)]


def about_wide(name: str, share: float) -> Note:
    """Note on particles that touch on more than half their radius: how sure their resistance is."""
    what = (
        f"outputs.{name}: particles with {percent(share, digits=2)} of the particle load touch on "
        "more than half their radius, where their resistance is overestimated: by up to 11 % where "
        "they are squashed, by 7 % and more where they sink in"
    )
    action = "under less load it is known better"
    return Note(what, code=f"{name}.wide", effect=0.11 * share, action=action)


def resistance_bends(probe: Probe, ends: str | tuple[str, str] = "isothermal") -> list[float]:
    """Squeezes ε at which the resistance of a particle changes its formula."""

    def by_cones(spots: ParticleSpots) -> NDArray[np.intp]:
        a_1, a_2 = (np.sqrt(area / np.pi) for area in spots.areas)
        r = spots.x / 2
        sphere = sphere_resistance(a_1, a_2=a_2, r=r, k=1.0, ends=ends)
        whole = particle_resistance(a_1, a_2=a_2, r=r, height=spots.height, k=1.0, ends=ends)
        return np.asarray(sphere != whole, dtype=np.intp)

    return changes(probe, by_cones)


def wide_share(state: Solved) -> float:
    """Largest share of the particle load on particles with contacts wider than half of them."""
    wide = state.total_of_particles(
        lambda spots: spots.load * (np.maximum(*spots.areas) > np.pi * (WIDE * spots.x / 2) ** 2)
    )
    load = state.total_of_particles(lambda spots: spots.load)
    return float(np.max(wide / np.where(load > 0, load, 1.0), initial=0.0))


def _warnings(output: _Conductance, state: Solved, numbers: str, closed: str) -> list[str]:
    singles = state.kept.get(output)
    if singles is None:
        out = _about_open(output, state, numbers)
    else:
        out = _about_open(output, state, numbers, ~singles.concerned)
        out += _about_single(output, singles, closed)
    if _some_conduct(output, state.contact) and (share := wide_share(state)) > 0.01:
        out.append(about_wide(output.name, share))
    return out


@dataclass(frozen=True, slots=True, kw_only=True)
class ThermalConductance(AbstractOutput):
    r"""Thermal conductance of the contact per nominal area: asperities, particles, and gap.

    .. math:: h_{ss} = \frac{2k_h}{\psi}\sum_{ss} n\,b, \qquad
              h_{sa} = \sum_{sa}\frac{n}{R}, \qquad h_{gap} = \frac{k_g}{Y+M},

    with :math:`k_h = 2k_1k_2/(k_1+k_2)`, b = √(a/π), ψ = (1−√A_ss)^1.5, and the resistance of a
    particle :math:`R = 1/(4k_1b_1)+1/(4k_2b_2)+R_p`
    (`thirdbody.effects.single.heat.particle_resistance`).

    Parameters
    ----------
    particles : {"conduct", "insulate"}, optional
        Insulating particles still hold the surfaces apart, which is most of what they do.
    film : float, optional
        Resistance of a surface film times its area at every spot [m² K/W]; two on a particle.
    k_gap : float, optional
        Conductivity of what fills the gap [W/(m K)]; 0 is a vacuum.
    M : float, optional
        Length M that a gas adds to the gap, its molecules being sparse [m]; air at 1 bar about
        0.4 µm (from memory: not confirmed in a source).
    form : {"power", "series", "none"}, optional
        Factor ψ, see `thirdbody.effects.single.heat.spreading`.
    A_n : float, optional
        Nominal area of the contact [m²]. Where fewer than one contact conducts in it on average,
        it is open, closed with the probability :math:`P_c = 1-e^{-A_n n}`: contacts lie at random.
        Where it holds few particles, contacts with and without them each carry the load, and the
        columns are means over both (`thirdbody.effects.single_contacts`).
    few : {"open", "mean"}, optional
        What is given there: NaN, or the mean over many such areas, most of them open.

    Notes
    -----
    ``hc_cmy`` is the conductance after Cooper, Mikic and Yovanovich of the clean plastic surfaces
    at the same pressure, with the mean absolute slope of
    `thirdbody.effects.single.heat.absolute_slope`: a check
    of magnitude for a contact without particles. Elastic-plastic asperities have more spots and
    1 to 2 times its value. Y is the separation of the mean planes h.

    The law `thirdbody.asperity.Field` has no spots: its patches conduct as they are stiff (Barber),
    :math:`2K/[E^*(1/k_1+1/k_2)]` with the stiffness K of the patches at rest, crowded or not, and
    ``form`` has no effect. It is 3 % off up to a real area of 0.1, 11 % low at 0.3 where it is
    plastic; a film lies in series to that, by spots scaled to its area.

    Particles do not take part in ψ: most of their resistance is their own. Grains below 0.1 µm
    conduct worse than the bulk of their crystal: give them their own conductivity. Flakes conduct
    at least as well as the ball of their thickness that is used here.

    References
    ----------
    Cooper, Mikic, Yovanovich 1969, Int. J. Heat Mass Transfer 12, 279,
    doi:10.1016/0017-9310(69)90011-8; Yovanovich 2005, IEEE Trans. Compon. Packag. Technol. 28,
    182, doi:10.1109/TCAPT.2005.848483; Barber 2003, Proc. R. Soc. A 459, 53,
    doi:10.1098/rspa.2002.1038; the particle is derived.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"].replace(thermal_conductivity=50)
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     outputs=tb.outputs.ThermalConductance(),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ... )
    >>> state = tb.solve(contact, pressure=5e6)
    >>> f"{state.outputs['hc']:.4g} W/(m² K)"
    '1.179e+05 W/(m² K)'
    """

    particles: Literal["conduct", "insulate"] = choice("what particles do", default="conduct")
    film: float = quantity("R_f", "m^2*K/W", "resistance of a film", default=0.0, ge=0)
    k_gap: float = quantity("k_g", "W/m/K", "conductivity of the gap", default=0.0, ge=0)
    M: float = quantity("M", "m", "length that a gas adds to the gap", default=0.0, ge=0)
    form: Spreading = choice("spreading factor", default="power")
    A_n: float | None = quantity(
        "A_n", "m^2", "nominal area of the contact", default=None, gt=0, hint="1 mm² is 1e-6"
    )
    few: Literal["open", "mean"] = choice("what is given below one contact", default="open")

    name = "thermal_conductance"
    title = "Thermal contact conductance"
    year = 1969
    citation = (
        "Cooper, Mikic, Yovanovich 1969, Int. J. Heat Mass Transfer 12, 279; particles derived"
    )
    doi = "10.1016/0017-9310(69)90011-8"
    provenance = "derived"
    valid_range = "A_t < 0.2; b < x/4 for particles that sink in"
    tells_few = True
    follows_sinks = True
    columns = {
        "hc": Column("h", "W/m^2/K", "thermal conductance"),
        "hc_ss": Column("h_ss", "W/m^2/K", "thermal conductance of asperities"),
        "hc_sa": Column("h_sa", "W/m^2/K", "thermal conductance of particles"),
        "hc_gap": Column("h_gap", "W/m^2/K", "thermal conductance of the gap"),
        "hc_closed": Column("P_c", "1", "probability that a contact of A_n conducts heat"),
        "hc_cmy": Column("h_CMY", "W/m^2/K", "thermal conductance of clean plastic surfaces"),
    }

    def problems(self, contact: Contact) -> list[str]:
        return missing(self, _conducting_bodies(contact, self), "thermal_conductivity")

    def passes(self, dust: Particles | None) -> bool:
        """Whether heat flows through the particles of a population."""
        return self.particles == "conduct"

    def one_by_one(self, contact: Contact) -> bool:
        return bool(self.film or self.A_n)

    def of(self, state: Solved) -> dict[str, Array]:
        asperities = _through_asperities(state, _thermal, self.form, film=self.film)
        particles = _through_particles(state, _thermal, self, film=self.film)
        gap = np.zeros_like(state.d)
        if self.k_gap:
            with np.errstate(divide="ignore"):
                gap = self.k_gap / (np.maximum(state.h, 0.0) + self.M)
        means = {"hc_ss": asperities, "hc_sa": particles, "hc_gap": gap}
        out = _closing(self, state, means, "hc_closed")
        return {
            "hc": out["hc_ss"] + out["hc_sa"] + out["hc_gap"],
            **out,
            "hc_cmy": self._clean(state),
        }

    def _clean(self, state: Solved) -> Array:
        """Conductance of clean plastic surfaces; NaN where they would touch by half."""
        pair, rough = state.contact.surfaces, state.contact.roughness
        k = 2 / (_thermal(pair.first) + _thermal(pair.second))
        m = absolute_slope(sigma=rough.sigma, R=rough.R, alpha=rough.alpha)
        low_pressure = np.where(state.pressure < 0.5 * pair.H, state.pressure, np.nan)
        return cooper_mikic_yovanovich(low_pressure, H=pair.H, k=k, m=float(m), sigma=rough.sigma)

    def splits(self, probe: Probe) -> Sequence[float]:
        return resistance_bends(probe)

    def warnings(self, state: Solved, values: Mapping[str, Array]) -> list[str]:
        return _warnings(self, state, "hc, hc_ss and hc_sa", "hc_closed")


@dataclass(frozen=True, slots=True, kw_only=True)
class ElectricalConductance(AbstractOutput):
    r"""Electrical conductance of the contact per nominal area, and its specific resistance.

    .. math:: g_{ss} = \frac1\psi\sum_{ss}\frac{n}{R_{spot}}, \qquad
              g_{sa} = \sum_{sa}\frac nR, \qquad \rho_c = \frac1{g_{ss}+g_{sa}},

    with :math:`R_{spot}` after Wexler (`thirdbody.effects.single.heat.spot_resistance`): Holm's
    constriction, what a spot smaller than the mean free path adds, and a surface film.

    Parameters
    ----------
    particles : {"insulate", "conduct", "by material"}, optional
        Insulating particles still hold the surfaces apart. "conduct" needs their resistivity; by
        material those conduct that have one, or are of a metal of the library, and the others
        insulate. What a population says of itself (``conducts``) counts before this.
    film : float, optional
        Resistance of a surface film times its area at every spot, σ_f [Ω m²]; two on a particle.
    mean_free_path : float, optional
        Of the electrons [m], about 40 nm in copper and silver (from memory: not confirmed in a
        source); 0 leaves the effect out.
    form : {"power", "series", "none"}, optional
        Factor ψ, see `thirdbody.effects.single.heat.spreading`.
    A_n : float, optional
        Nominal area of the contact [m²]. Where fewer than one contact conducts in it on average,
        it is open, closed with the probability :math:`P_c = 1-e^{-A_n n}`: contacts lie at random.
        Where it holds few particles, contacts with and without them each carry the load, and the
        columns are means over both (`thirdbody.effects.single_contacts`).
    few : {"open", "mean"}, optional
        What is given there: NaN, or the mean over many such areas, most of them open.

    Notes
    -----
    Two solids that close on dust, a ball on a flat: `thirdbody.systems.contact_probability`.

    The law `thirdbody.asperity.Field` has no spots: its patches conduct as they are stiff (Barber),
    :math:`2K/[E^*(\rho_1+\rho_2)]` with the stiffness K of the patches at rest, crowded or not, and
    ``form`` has no effect. It is 3 % off up to a real area of 0.1, 11 % low at 0.3 where it is
    plastic; film and free path lie in series to that, by spots scaled to its area.

    Without films and with the electrons as the only carriers of heat, the thermal conductance is
    :math:`L\,T` times this one (Wiedemann and Franz; `thirdbody.effects.single.heat.LORENZ`).

    References
    ----------
    Holm 1967, Electric Contacts; Wexler 1966, Proc. Phys. Soc. 89, 927,
    doi:10.1088/0370-1328/89/4/316; Barber 2003, Proc. R. Soc. A 459, 53,
    doi:10.1098/rspa.2002.1038; the particle is derived.

    Examples
    --------
    >>> import thirdbody as tb
    >>> brass = tb.Material(E=110e9, nu=0.34, H=1.3e9, resistivity=6.4e-8)
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(brass, brass),
    ...                      roughness=tb.Roughness(sigma=200e-9, R=5e-6),
    ...                      outputs=tb.outputs.ElectricalConductance())
    >>> state = tb.solve(contact, pressure=5e6)
    >>> f"{state.outputs['rho_c'] / 1e-6 * 1e6:.1f} µΩ on 1 mm²"
    '21.8 µΩ on 1 mm²'
    """

    particles: Literal["insulate", "conduct", "by material"] = choice(
        "what particles do", default="insulate"
    )
    film: float = quantity("σ_f", "ohm*m^2", "resistance of a film", default=0.0, ge=0)
    mean_free_path: float = quantity("l", "m", "mean free path", default=0.0, ge=0)
    form: Spreading = choice("spreading factor", default="power")
    A_n: float | None = quantity(
        "A_n", "m^2", "nominal area of the contact", default=None, gt=0, hint="1 mm² is 1e-6"
    )
    few: Literal["open", "mean"] = choice("what is given below one contact", default="open")

    name = "electrical_conductance"
    title = "Electrical contact conductance"
    year = 1967
    citation = (
        "Holm 1967, Electric Contacts; Wexler 1966, Proc. Phys. Soc. 89, 927; particles derived"
    )
    doi = "10.1088/0370-1328/89/4/316"
    provenance = "derived"
    valid_range = "A_t < 0.2; b < x/4 for particles that sink in"
    tells_few = True
    follows_sinks = True
    columns = {
        "gc": Column("g", "S/m^2", "electrical conductance"),
        "gc_ss": Column("g_ss", "S/m^2", "electrical conductance of asperities"),
        "gc_sa": Column("g_sa", "S/m^2", "electrical conductance of particles"),
        "rho_c": Column("ρ_c", "ohm*m^2", "specific contact resistance"),
        "gc_closed": Column("P_c", "1", "probability that A_n is closed"),
    }

    def problems(self, contact: Contact) -> list[str]:
        out = missing(self, _conducting_bodies(contact, self), "resistivity")
        kinds = {self.passes(dust) for dust in contact.populations}
        if self.A_n is not None and len(kinds) > 1:
            out.append(
                self.problem(
                    "must be left out where some particles conduct and some insulate: which of "
                    "them close a contact that holds few is not known",
                    key="A_n",
                    code=Mistake.CLASH,
                )
            )
        return out

    def passes(self, dust: Particles | None) -> bool:
        """Whether a current flows through the particles of a population.

        What a population says of itself (`Particles.conducts`) counts before ``particles``.
        """
        if dust is not None and dust.conducts is not None:
            return dust.conducts
        if self.particles == BY_MATERIAL and dust is not None:
            return bool(conducts(dust))
        return self.particles == "conduct"

    def one_by_one(self, contact: Contact) -> bool:
        return bool(self.film or self.mean_free_path or self.A_n)

    def of(self, state: Solved) -> dict[str, Array]:
        small: dict[str, float] = dict(film=self.film, mean_free_path=self.mean_free_path)
        asperities = _through_asperities(state, _electrical, self.form, **small)
        particles = _through_particles(state, _electrical, self, **small)
        out = _closing(self, state, {"gc_ss": asperities, "gc_sa": particles}, "gc_closed")
        total = out["gc_ss"] + out["gc_sa"]
        with np.errstate(divide="ignore"):
            return {"gc": total, **out, "rho_c": 1 / total}

    def splits(self, probe: Probe) -> Sequence[float]:
        return resistance_bends(probe)

    def warnings(self, state: Solved, values: Mapping[str, Array]) -> list[str]:
        return _warnings(self, state, "gc, gc_ss, gc_sa and rho_c", "gc_closed")


def _conducting_bodies(contact: Contact, output: _Conductance) -> dict[str, Material]:
    """Bodies whose conductivity counts."""
    surfaces, particles = 2, list(bodies_of(contact).items())
    flows = [True] * surfaces + [output.passes(dust) for dust in contact.populations]
    return {name: body for (name, body), does in zip(particles, flows, strict=True) if does}


def _thermal(material: Material) -> float:
    """1/k [m K/W]."""
    assert material.thermal_conductivity is not None
    return 1 / material.thermal_conductivity


def _electrical(material: Material) -> float:
    """ρ [Ω m]."""
    assert material.resistivity is not None
    return material.resistivity
