"""Readings of the paper: what has to be assumed before its equations give a curve.

The paper leaves the asperity radius, the width of the particle sizes and h_e open, and its
equations contain slips. A reading fixes all of that. Five use the printed equations, three the
consistent model.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...contact.contact import Contact
from ...equilibrium.columns import Equilibrium
from ...equilibrium.solve import solve
from ...laws.particle import AbstractParticleLaw, Horng2022, Series
from ...populations.distributions import TruncatedGaussian
from ...populations.materials import MaterialPair, materials
from ...populations.particles import Particles
from ...populations.roughness import ETA_R_SIGMA, Roughness
from ..engine import ignore_ranges

__all__ = ["LOADS", "READINGS", "SILICA", "STEEL", "Curve", "Curves", "Reading"]

Array = NDArray[np.float64]

NM = 1e-9
STEEL, SILICA = "S45C", "SiO2"
"""Wear debris and foreign particles; both surfaces are steel."""

RANGE = (4.8e-7, 2.4e-4)
"""Loads F* of the figures (Table 2: 0.16 to 80 N)."""
SEARCH_TO = 4e-4
"""Critical loads are searched a little beyond the figures."""
QUOTED = (
    *(5e-7, 1e-6, 2e-6, 7e-6, 7.5e-6, 1e-5, 2e-5, 3e-5, 5.1e-5, 1e-4, 1.2e-4, 1.5e-4),
    *RANGE,
)
LOADS = np.unique([*np.geomspace(RANGE[0], SEARCH_TO, 241), *QUOTED])
"""Loads F* at which every curve is computed: an even grid in log F*, and those the text names."""


@dataclass(frozen=True)
class Reading:
    """One way to read the paper.

    Parameters
    ----------
    key, name, title : str
        A letter for tables, the name that ``preset`` takes, and a line for people.
    law : callable
        Particle law for σ and x_a [m].
    law_words : str
        That law in words, for tables.
    R : float
        Asperity radius [m].
    spread, cut : float
        σ_a/x_a, and the cut of the sizes in units of σ_a [1].
    areal_density : float
        η_a [1/m²]; the paper states 1e11.
    datum : float
        Centre of the asperity heights in the coordinate of the reported d, in units of σ [1].
    F_star_scale : float
        Modulus of the reading's F* over E_ss: 2 where the paper's E is taken as E' = 2E*.
    paper_booking : bool
        Book the area under particles as eqs. (1), (2) and (13) do: F_sa/H_s, all of it plastic.
    adjusted : str
        What was chosen so that the paper's numbers come out.

    Examples
    --------
    >>> from thirdbody.papers.horng2022.readings import READINGS
    >>> READINGS["published"].contact("SiO2", 100, 300).particle_law.preset  # σ and x_a [nm]
    'published'
    """

    key: str
    name: str
    title: str
    law: Callable[[float, float], AbstractParticleLaw] = field(repr=False)
    law_words: str
    R: float
    spread: float
    cut: float
    areal_density: float = 1e11
    datum: float = 1.0
    F_star_scale: float = 1.0
    paper_booking: bool = False
    adjusted: str = ""

    def contact(self, material: str, sigma: float, x_a: float) -> Contact:
        """The contact for a particle material, σ and x_a in nm; x_a = 0 is two-body contact."""
        sigma, x_a = sigma * NM, x_a * NM
        steel = materials[STEEL]
        bare = Contact(
            surfaces=MaterialPair(steel, steel), roughness=Roughness(sigma=sigma, R=self.R)
        )
        if x_a == 0:
            return bare
        sizes = TruncatedGaussian(mean=x_a, std=self.spread * x_a, n=self.cut)
        return bare.replace(
            particles=Particles(
                material=materials[material], diameter=sizes, areal_density=self.areal_density
            ),
            particle_law=self.law(sigma, x_a),
        )

    def parameters(self) -> dict[str, object]:
        """What the tables show."""
        return {
            "particle law": self.law_words,
            "R [m]": self.R,
            "eta_R_sigma": ETA_R_SIGMA,
            "sigma_a/x_a": self.spread,
            "n": self.cut,
            "eta_a [1/m^2]": self.areal_density,
            "centre of asperity heights/sigma": self.datum,
            "F* scale/E_ss": self.F_star_scale,
            "adjusted to the paper": self.adjusted,
        }


def _printed_reading(key: str, preset: str, words: str, **rest: Any) -> Reading:
    def law(sigma: float, x_a: float) -> AbstractParticleLaw:
        return Horng2022(preset=preset)

    return Reading(key=key, name=preset, law=law, law_words=words, **rest)


def _on_plane(sigma: float, x_a: float) -> AbstractParticleLaw:
    return Series(deep="off", seat="plane")


def _on_tops(sigma: float, x_a: float) -> AbstractParticleLaw:
    # The imitation measures its offset 3.16 σ + 0.6 x_a from a plane one σ below the mean
    # asperity height, from which the library measures h_0.
    return Series(deep="off", seat="offset", h_0=(3.16 - 1) * sigma + 0.6 * x_a)


def _on_rough_seat(sigma: float, x_a: float) -> AbstractParticleLaw:
    return Series(deep="off", seat="rough")


READINGS: dict[str, Reading] = {
    reading.name: reading
    for reading in (
        _printed_reading(
            "P",
            "published",
            "printed, both integrals; χ = 0.00738, h_e = 3.11 σ, pressure H_s + H_a",
            title="printed equations, particle pressure H_s + H_a",
            R=11.1e-6,
            spread=0.388,
            cut=2.05,
            adjusted="R, σ_a, n, h_e, χ, and the pressure H_s + H_a",
        ),
        _printed_reading(
            "W",
            "window",
            "printed, first integral only; χ = 1/16, h_e = 3.25 σ",
            title="printed equations, first particle integral alone",
            R=2.8e-6,
            spread=0.08,
            cut=3.0,
            adjusted="R, σ_a, h_e; χ follows from errata 7 and 9",
        ),
        _printed_reading(
            "V",
            "window_E2",
            "printed, first integral only; E' = 2E* in the bracket, h_e = 2.39 σ",
            title="the same with E' = 2E* throughout",
            R=3.32e-6,
            spread=0.162,
            cut=2.22,
            F_star_scale=2.0,
            adjusted="R, σ_a, n, h_e",
        ),
        _printed_reading(
            "X3",
            "all_terms",
            "printed, both integrals; χ = 0.0185, h_e = 3.15 σ",
            title="printed equations, all terms, fewer particles",
            R=3.5e-6,
            spread=1 / 3,
            cut=3.0,
            adjusted="R, h_e, χ",
        ),
        _printed_reading(
            "L",
            "literal",
            "printed, both integrals; h_e = C x_a/2",
            title="printed equations to the letter",
            R=3.0e-6,
            spread=0.2,
            cut=3.0,
            adjusted="nothing; R, σ_a and n are guesses",
        ),
        Reading(
            key="S",
            name="series-offset",
            title="consistent model, particles on the asperity tops (imitation)",
            law=_on_tops,
            law_words="series, seat offset; h_0 = 2.16 σ + 0.6 x_a above the mean asperity height",
            R=3.0e-6,
            spread=0.12,
            cut=3.0,
            areal_density=8.3e8,
            adjusted="R, σ_a, h_0, η_a",
        ),
        Reading(
            key="C",
            name="series-plane",
            title="consistent model, particles on the mean asperity plane",
            law=_on_plane,
            law_words="series, seat plane",
            R=2.8e-6,
            spread=0.1,
            cut=3.0,
            datum=0.0,
            adjusted="nothing; R and σ_a are guesses",
        ),
        Reading(
            key="R",
            name="series-rough",
            title="consistent model, particles anywhere on the rough surface",
            law=_on_rough_seat,
            law_words="series, seat rough",
            R=2.8e-6,
            spread=0.1,
            cut=3.0,
            datum=0.0,
            adjusted="nothing; R and σ_a are guesses",
        ),
    )
}
"""Every reading that the ledger scores, by the name that ``preset`` takes."""


AREAS = ("A_t", "A_ss", "A_sa", "A_e", "A_ep", "A_p")


@dataclass(frozen=True, eq=False)
class Curve:
    """One contact under the loads F*, in the paper's terms; areas per nominal area [1]."""

    F: Array
    A_t: Array
    A_ss: Array
    A_sa: Array
    A_e: Array
    A_ep: Array
    A_p: Array
    d: Array
    """Separation from the reading's datum [m]."""
    d_star: Array
    load_share: Array
    """F_sa/F_t."""

    @property
    def particle_share(self) -> Array:
        """A_sa,t*."""
        return self.A_sa / self.A_t

    @property
    def asperity_share(self) -> Array:
        """A_ss,t*."""
        return self.A_ss / self.A_t

    def share(self, regime: str) -> Array:
        """A_e,t*, A_ep,t* or A_p,t* for the regime "e", "ep" or "p"."""
        return getattr(self, f"A_{regime}") / self.A_t

    def value_at(self, load: float, values: Array) -> float:
        """One of the curve's columns at a load, between grid points linear in log F*."""
        return float(np.interp(np.log(load), np.log(self.F), values))


class Curves:
    """The load curves of one reading, each computed once.

    Parameters
    ----------
    reading : Reading

    Examples
    --------
    >>> from thirdbody.papers.horng2022 import Curves
    >>> from thirdbody.papers.horng2022.readings import READINGS
    >>> curve = Curves(READINGS["published"])("SiO2", 100, 300)  # σ and x_a [nm]
    >>> bool(curve.particle_share[0] > curve.particle_share[-1])
    True
    """

    def __init__(self, reading: Reading):
        self.reading = reading
        self._kept: dict[tuple[object, ...], Curve] = {}

    def __call__(self, material: str, sigma: float, x_a: float) -> Curve:
        """The curve for a particle material, σ and x_a in nm, at `LOADS`."""
        key = (material if x_a else "", sigma, x_a)
        if key not in self._kept:
            self._kept[key] = self.curve_under(LOADS, material, sigma, x_a)
        return self._kept[key]

    def two_body(self, sigma: float) -> Curve:
        """The curve without particles."""
        return self(STEEL, sigma, 0)

    def state_at(self, load: float, material: str, sigma: float, x_a: float) -> Curve:
        """The single state under one load, kept."""
        key = (material if x_a else "", sigma, x_a, load)
        if key not in self._kept:
            self._kept[key] = self.curve_under(np.array([load]), material, sigma, x_a)
        return self._kept[key]

    def curve_under(self, loads: Array, material: str, sigma: float, x_a: float) -> Curve:
        """The curve at other loads, not kept."""
        contact = self.reading.contact(material, sigma, x_a)
        with ignore_ranges():  # several readings leave the range of the laws on purpose
            state = solve(contact, F_star=loads * self.reading.F_star_scale)
            areas = {name: getattr(state, name) for name in AREAS}
            if self.reading.paper_booking and x_a:
                areas = self._as_the_paper_books(state, contact)
        # h has one meaning in every law; the reading says how far below it counts d
        d = np.asarray(state.h) - contact.roughness.y_s + self.reading.datum * sigma * NM
        return Curve(
            F=np.asarray(loads),
            d=d,
            d_star=d / (sigma * NM),
            load_share=np.asarray(state.particle_load_share),
            **areas,
        )

    def _as_the_paper_books(self, state: Equilibrium, contact: Contact) -> dict[str, Array]:
        """Areas with A_sa = F_sa/H_s, all plastic; the asperities keep theirs."""
        bare = solve(contact.replace(particles=None), d=state.d)
        asperities = {name: (1 - state.shadow) * getattr(bare, name) for name in AREAS}
        A_sa = state.F_sa_star * contact.E_ss / contact.surfaces.first.H
        return asperities | {
            "A_sa": A_sa,
            "A_p": asperities["A_p"] + A_sa,
            "A_t": asperities["A_t"] + A_sa,
        }
