"""How hot the contacts get that rub: asperities, and particles as bridges between the bodies."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from ..contact.evaluation import bodies_of
from ..contact.output import AbstractOutput, Column, missing
from ..errors import Mistake, Note, Problem
from ..quantities.say import number
from ..quantities.value import choice, quantity
from .conductance import about_wide, resistance_bends, wide_share
from .single.heat import (
    Flux,
    Kind,
    body_conductance,
    bridge,
    particle_resistance,
    partition,
    peclet,
    sudden_share,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from numpy.typing import NDArray

    from ..contact.contact import Contact
    from ..contact.evaluation import Solved
    from ..contact.output import Probe
    from ..contact.spots import AsperitySpots
    from ..laws.spots import ParticleSpots, Spots
    from ..populations.materials import Material
    from .friction import Friction

    Array = NDArray[np.float64]

__all__ = ["FlashTemperature"]

QUANTILES = {"p50": 0.5, "p95": 0.95, "p99": 0.99}
LEVELS = 400
"""Temperatures at which spots are counted for quantiles and peaks that have no closed inverse."""


class Body(NamedTuple):
    """What a surface takes up heat with."""

    k: float
    """Conductivity [W/(m K)]"""
    D: float
    """Diffusivity [m²/s]"""

    @staticmethod
    def of_material(material: Material) -> Body:
        k, density, heat = material.thermal_conductivity, material.density, material.specific_heat
        assert k is not None
        assert density is not None
        assert heat is not None
        return Body(k, k / (density * heat))


@dataclass(frozen=True, slots=True, kw_only=True)
class FlashTemperature(AbstractOutput):
    r"""Rise of the contact temperature over the bulk: weighted means, quantiles and the peak.

    An asperity contact sets free the heat :math:`Q = \mu_{spot} f v`. Each body takes it up with
    :math:`G_i = \pi b k_i/\theta(\mathrm{Pe}_i)` (`thirdbody.effects.single.heat.moving_rise`), so
    that

    .. math:: T_c = \frac{Q+G_1T_1+G_2T_2}{G_1+G_2} .

    A particle is a bridge (`thirdbody.effects.single.heat.bridge`): one that slides over surface 2
    heats that
    contact, which loses heat to body 2 and, through the particle, to body 1. One that rolls heats
    both contacts by half, and they move at v/2 over either surface. The hotter end counts.

    Parameters
    ----------
    v : float
        Sliding speed [m/s].
    A_n : float
        Nominal area A_n of which the peak is the hottest contact [m²]: the temperature that the
        hottest one of A_n exceeds in half of all cases, :math:`A_n N(>T)=\ln 2`.
    T_1, T_2 : float, optional
        Temperatures of the bodies below the contacts [°C or K]; where ``h_1`` and ``h_2`` are
        given, those of their surroundings.
    h_1, h_2 : float, optional
        Conductance from the surface through either body to its surroundings, per nominal area
        [W/(m² K)], e.g. k/l. Both surfaces then have the bulk temperature
        :math:`(\mu p v + h_1T_1 + h_2T_2)/(h_1+h_2)`. Without them T_1 and T_2 stay as given.
    spots_on : {"first", "second", "both"}, optional
        The surface on which an asperity contact stays put while it moves at v over the other;
        "both": at v/2 over either.
    kind : {"mean", "max"}, optional
        Mean temperature of a contact, or the largest in it.
    flux : {"uniform", "hertz"}, optional
        How the heat is spread over a contact.
    lifetime : {"steady", "lifetime"}, optional
        Steady state, an upper bound where an asperity contact stays put, or heating during its
        life 2b/v only.
    quantiles : {"number", "area", "load"}, optional
        Of what p50, p95 and p99 are shares.

    Notes
    -----
    Rises are over the hotter bulk temperature. A mean without a weight is no property of the
    contact: there are three, by number, area and load.

    Asperities of one shape: quantiles by number and the peak follow from the heights exactly, as
    a deeper contact is a hotter one. Otherwise contacts are counted, class by class, over 400
    levels of temperature and interpolated. Of particles p95, p99 and the peak are then within
    2.5 %, and the median within 5 % (measured against the integral over sizes and seats, of
    Gaussian and lognormal sizes that slide slowly); asperities within 1 % (against explicit
    contacts).

    Neighbours heat a contact through the bulk temperature alone. Flakes conduct at least as well
    as the ball of their thickness that is used here. Shear and ploughing heat are set free in the
    contact.

    Bulk heat is μpv; the network for it is Ashby's (from memory: not confirmed in a source).

    References
    ----------
    Tian and Kennedy 1994, J. Tribol. 116, 167, doi:10.1115/1.2927035; Blok 1937; the particle is
    derived.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"].replace(
    ...     thermal_conductivity=50, density=7850, specific_heat=480)
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     outputs=(
    ...         tb.outputs.Friction(tau_ss=580e6),
    ...         tb.outputs.FlashTemperature(v=1.0, A_n=1e-6),
    ...     ),
    ... )
    >>> state = tb.solve(contact, pressure=5e6)
    >>> f"{state.outputs['dT_ss_load']:.2f} K, hottest {state.outputs['dT_ss_peak']:.2f} K"
    '2.77 K, hottest 6.31 K'
    """

    v: float = quantity("v", "m/s", "sliding speed", ge=0)
    A_n: float = quantity(
        "A_n", "m^2", "nominal area of which the peak is", gt=0, hint="1 mm² is 1e-6"
    )
    T_1: float = quantity("T_1", "K", "bulk temperature of body 1", default=0.0)
    T_2: float = quantity("T_2", "K", "bulk temperature of body 2", default=0.0)
    h_1: float | None = quantity(
        "h_1", "W/m^2/K", "conductance of body 1 to its surroundings", default=None, ge=0
    )
    h_2: float | None = quantity(
        "h_2", "W/m^2/K", "conductance of body 2 to its surroundings", default=None, ge=0
    )
    spots_on: Literal["first", "second", "both"] = choice(
        "surface on which asperity contacts stay put", default="second"
    )
    kind: Kind = choice("temperature of a contact", default="max")
    flux: Flux = choice("heat over a contact", default="uniform")
    lifetime: Literal["steady", "lifetime"] = choice(
        "heating of contacts that stay put", default="steady"
    )
    quantiles: Literal["number", "area", "load"] = choice(
        "what quantiles are shares of", default="number"
    )

    name = "flash_temperature"
    title = "Flash temperature"
    year = 1994
    citation = "Tian and Kennedy 1994, J. Tribol. 116, 167; thirdbody: particles as bridges"
    doi = "10.1115/1.2927035"
    provenance = "derived"
    valid_range = (
        "a < r/2 for particles that sink in; temperatures at which hardness and strength stay"
    )
    follows_sinks = True
    needs = ("friction",)
    columns = {
        f"dT_{group}_{name}": Column(f"ΔT_{group},{name}", "K", f"{meaning} of {kind}")
        for group, kind in (("ss", "asperity contacts"), ("sa", "particles"))
        for name, meaning in (
            ("number", "mean rise by number"),
            ("area", "mean rise by area"),
            ("load", "mean rise by load"),
            ("p50", "rise that half exceed"),
            ("p95", "rise that one in 20 exceeds"),
            ("p99", "rise that one in 100 exceeds"),
            ("peak", "median rise of the hottest"),
        )
    } | {
        "dT_peak": Column("ΔT_max", "K", "median rise of the hottest contact"),
        "T_bulk": Column("T_b", "K", "bulk temperature, the hotter of two"),
        "T_peak": Column("T_max", "K", "temperature of the hottest contact"),
    }

    def _problems(self) -> list[str]:
        if (self.h_1 is None) != (self.h_2 is None):
            return [
                Problem(
                    "h_1", "and h_2 make one network: give both (0 insulates)", code=Mistake.CLASH
                )
            ]
        if self.h_1 == 0 and self.h_2 == 0:
            return [
                Problem(
                    "h_1",
                    "= h_2 = 0 leave the heat no way out: one must be > 0",
                    code=Mistake.CLASH,
                )
            ]
        return []

    def problems(self, contact: Contact) -> list[str]:
        bodies = bodies_of(contact)
        surfaces = {name: bodies[name] for name in ("surface 1", "surface 2")}
        names = ("thermal_conductivity", "density", "specific_heat")
        particles = {name: body for name, body in bodies.items() if name not in surfaces}
        return missing(self, surfaces, *names) + missing(self, particles, names[0])

    # ------------------------------------------------------------------ one contact
    def _takes(self, body: Body, b: Array, speed: float) -> Array:
        """Heat conductance G of one body [W/K] under moving contacts of radius b."""
        return body_conductance(  # type: ignore[return-value]
            b, k=body.k, D=body.D, v=speed, kind=self.kind, flux=self.flux
        )

    def _colder(self) -> tuple[float, float]:
        """Bulk temperatures of the bodies, less the hotter one."""
        if self.h_1 is not None:
            return 0.0, 0.0
        hotter = max(self.T_1, self.T_2)
        return self.T_1 - hotter, self.T_2 - hotter

    def of_asperities(self, spots: AsperitySpots, state: Solved) -> Array:
        """Rise of every asperity contact [K]: (M, n)."""
        friction: Friction = state.output("friction")
        force = friction.of_asperities(spots, friction.ratio(state.contact))
        b = np.sqrt(spots.area / np.pi)
        pair = state.contact.surfaces
        speeds = {"first": (0.0, self.v), "second": (self.v, 0.0), "both": (self.v / 2,) * 2}
        G = []
        for material, speed in zip((pair.first, pair.second), speeds[self.spots_on], strict=True):
            body = Body.of_material(material)
            takes = self._takes(body, b, speed)
            if speed == 0 and self.v > 0 and self.lifetime == "lifetime":
                # Fo = D (2b/v)/b²
                with np.errstate(divide="ignore"):
                    Fo = 1 / peclet(b, v=self.v, D=body.D)
                takes = takes / sudden_share(Fo, kind=self.kind, flux=self.flux)
            G.append(takes)
        Q = sum(force.values()) * self.v
        with np.errstate(invalid="ignore"):
            T_1, T_2 = self._colder()
            rise = partition(Q, G_1=G[0], G_2=G[1], T_1=T_1, T_2=T_2)
        return np.where(spots.area > 0, rise, 0.0)

    def of_particles(self, spots: ParticleSpots, state: Solved) -> Array:
        """Rise of the hotter end of every particle [K]: (M, n)."""
        friction: Friction = state.output("friction")
        Q = sum(friction.of_particles(spots).values()) * self.v
        motion = friction.motion(spots)
        rolls, side = motion.rolls, motion.side
        assert spots.population is not None
        k = spots.population.material.thermal_conductivity
        assert k is not None
        with np.errstate(invalid="ignore", divide="ignore"):
            a_1, a_2 = (np.sqrt(area / np.pi) for area in spots.areas)
            R = particle_resistance(
                a_1,
                a_2=a_2,
                r=spots.x / 2,
                height=spots.height,
                k=k,
                ends=(self.flux, self.kind),
            )
            G, heat = [], []
            pair = state.contact.surfaces
            for i, (material, a) in enumerate(
                zip((pair.first, pair.second), (a_1, a_2), strict=True)
            ):
                body = Body.of_material(material)
                slow, half, fast = (self._takes(body, a, share * self.v) for share in (0, 0.5, 1))
                G.append(np.where(rolls, half, np.where(side == i, fast, slow)))
                heat.append(np.where(rolls, 0.5, side == i) * Q)
            rise = np.maximum(*bridge((heat[0], heat[1]), G=(G[0], G[1]), R=R, T=self._colder()))
        return np.where(spots.load > 0, rise, 0.0)

    # ------------------------------------------------------------------ all of them
    def of(self, state: Solved) -> dict[str, Array]:
        T_ss = [self.of_asperities(spots, state) for spots in state.asperities]
        T_sa = [self.of_particles(spots, state) for spots in state.particles]
        out = self._summary("ss", state.asperities, T_ss, len(state.d))
        out |= self._summary("sa", state.particles, T_sa, len(state.d))
        if self._is_sorted(state):
            out |= self._exact(state)
        out["dT_peak"] = np.fmax(out["dT_ss_peak"], out["dT_sa_peak"])
        out["T_bulk"] = self._bulk(state)
        out["T_peak"] = out["T_bulk"] + out["dT_peak"]
        return out

    def _bulk(self, state: Solved) -> Array:
        if self.h_1 is None or self.h_2 is None:
            return np.full_like(state.d, max(self.T_1, self.T_2))
        friction: Friction = state.output("friction")
        ratio = friction.ratio(state.contact)
        force = state.total(lambda spots: sum(friction.of_asperities(spots, ratio).values()))
        force = force + state.total_of_particles(
            lambda spots: sum(friction.of_particles(spots).values())
        )
        return partition(force * self.v, G_1=self.h_1, G_2=self.h_2, T_1=self.T_1, T_2=self.T_2)  # type: ignore[return-value]

    def _summary(
        self, group: str, spots: Sequence[Spots], T: list[Array], states: int
    ) -> dict[str, Array]:
        """Means, quantiles and peak of one group of contacts: NaN where there are none."""
        out = {}
        total: dict[str, Array] = {}
        for name, weight in WEIGHTS.items():
            total[name] = _sum(states, (contacts.total(weight(contacts)) for contacts in spots))
            above = _sum(
                states,
                (
                    contacts.total(weight(contacts) * t)
                    for contacts, t in zip(spots, T, strict=True)
                ),
            )
            with np.errstate(invalid="ignore", divide="ignore"):
                out[f"dT_{group}_{name}"] = above / total[name]
        counted = _Counted.from_spots(spots, T, WEIGHTS[self.quantiles], states)
        for name, share in QUANTILES.items():
            out[f"dT_{group}_{name}"] = counted.inverse((1 - share) * total[self.quantiles])
        if self.quantiles != "number":
            counted = _Counted.from_spots(spots, T, WEIGHTS["number"], states)
        out[f"dT_{group}_peak"] = counted.inverse(np.full(states, math.log(2) / self.A_n))
        return out

    def _is_sorted(self, state: Solved) -> bool:
        """Whether a deeper asperity is a hotter one, and all are of one shape."""
        one, two = self._colder()
        return len(state.asperities) == 1 and one == two

    def _exact(self, state: Solved) -> dict[str, Array]:
        """Peak and, by number, quantiles of asperities of one shape."""
        (spots,) = state.asperities
        touching = np.maximum(spots.deeper(np.zeros(())), 0.0)
        counts = {"peak": np.full_like(state.d, math.log(2) / self.A_n)}
        if self.quantiles == "number":
            counts |= {name: (1 - share) * touching for name, share in QUANTILES.items()}
        omega = np.stack([spots.deepest(count) for count in counts.values()], axis=1)
        pressed = np.where(omega > 0, omega, np.nan)
        one = replace(
            spots,
            share=None,
            number=np.ones_like(pressed),
            depth=pressed,
            load=spots.load_at(pressed),
            area=spots.area_at(pressed),
            regime=np.zeros(pressed.shape, dtype=np.intp),
        )
        with np.errstate(invalid="ignore"):
            rises = np.where(omega > 0, self.of_asperities(one, state), np.nan)
        return {f"dT_ss_{name}": rises[:, i] for i, name in enumerate(counts)}

    def _about_few(self, state: Solved) -> list[str]:
        """Where less than half of all areas A_n hold a contact: no hottest one has a median."""
        out: list[str] = []
        for group, kind, n in (
            ("ss", "asperity contacts", state.total(_pressing)),
            ("sa", "loaded particles", state.total_of_particles(_pressing)),
        ):
            if np.any(few := (n > 0) & (n * self.A_n < math.log(2))):
                least = number(float(np.min(n[few])) * self.A_n)
                what = (
                    f"outputs.flash_temperature: A_n = {number(self.A_n)} m² holds {least} {kind} "
                    f"on average: most such areas hold none, and dT_{group}_peak is NaN"
                )
                code = f"{self.name}.few.{group}"
                out.append(Note(what, code=code, effect=math.inf, action="a larger A_n has one"))
        return out

    def splits(self, probe: Probe) -> Sequence[float]:
        return resistance_bends(probe, (self.flux, self.kind))

    def warnings(self, state: Solved, values: Mapping[str, Array]) -> list[str]:
        share = wide_share(state)
        return [*self._about_few(state), *([about_wide(self.name, share)] if share >= 0.01 else [])]


def _pressing(spots: Spots) -> Any:
    return spots.load > 0


def _area(spots: Any) -> Array:
    """Smaller contact area of a particle, the hotter one between equal bodies."""
    return spots.area if hasattr(spots, "area") else np.minimum(*spots.areas)


def _load(spots: Spots) -> Array:
    return spots.load


WEIGHTS: dict[str, Callable[[Spots], Array]] = {"number": _pressing, "area": _area, "load": _load}


def _sum(states: int, parts: Iterable[Array], axes: int = 0) -> Array:
    return sum(parts, np.zeros((states,) + (1,) * axes))


class _Counted(NamedTuple):
    """How much weight is on contacts above each of many temperatures: (N, L)."""

    levels: Array
    above: Array

    @staticmethod
    def from_spots(
        spots: Sequence[Spots], T: list[Array], weight: Callable[[Spots], Array], states: int
    ) -> _Counted:
        parts = [t[contacts.load > 0] for contacts, t in zip(spots, T, strict=True)]
        rises = np.concatenate([*parts, np.zeros(0)])
        if not len(rises):
            return _Counted(np.zeros(2), np.zeros((states, 2)))
        levels = np.unique(rises)
        if len(levels) > LEVELS:
            bottom = max(levels[0], 1e-6 * levels[-1])
            span = np.geomspace if bottom > 0 else np.linspace
            levels = span(bottom if bottom > 0 else levels[0], levels[-1], LEVELS)
        weights = [weight(contacts) * (contacts.load > 0) for contacts in spots]

        def above(over: Array) -> Array:
            return _sum(
                states, (s.above(t, over, w) for s, t, w in zip(spots, T, weights, strict=True)), 1
            )

        # half of the contacts at a level are above it
        counts = 0.5 * (above(levels) + above(np.nextafter(levels, -np.inf)))
        everything = _sum(states, (s.total(w) for s, w in zip(spots, weights, strict=True)))
        return _Counted(
            np.concatenate([[np.nextafter(levels[0], -np.inf)], levels, levels[-1:]]),
            np.column_stack([everything, counts, np.zeros(states)]),
        )

    def inverse(self, weight: Array) -> Array:
        """Temperature above which so much weight is; NaN where all have less: (N,)."""
        enough = self.above >= weight[:, None]
        last = np.clip(np.sum(enough, axis=1) - 1, 0, len(self.levels) - 2)
        rows = np.arange(len(weight))
        upper, lower = self.above[rows, last], self.above[rows, last + 1]
        with np.errstate(invalid="ignore", divide="ignore"):
            share = np.where(upper > lower, (upper - weight) / (upper - lower), 0.0)
        T = self.levels[last] + share * (self.levels[last + 1] - self.levels[last])
        return np.where(enough.any(axis=1) & (weight > 0), T, np.nan)
