"""From a contact to the numbers of its states: the one place where that happens."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import special

from ...contact.contact import Contact
from ...contact.field_sums import ROUNDING
from ...contact.particle_sums import printed_numbers
from ...errors import NotCompiled
from ...laws import asperity, particle
from ...laws.asperity.elliptic import hertz_of
from ...laws.asperity.layer import ElasticLayer, table_of
from ...laws.field.formulas import hardness_ratio
from ...laws.field.reduced import area_factor, remainder_height
from ...laws.field.table import ALPHAS, SOFT, rows_of, separations
from ...laws.particle.deep import curve_rows, sink_rows, squashed_part
from ...laws.particle.tension import _bends, _equator
from ...numerics.quadrature import gauss_legendre
from ...populations import distributions as sizes
from ...populations.heights import COMPLETE, ExponentialHeights, GaussianHeights, WeibullHeights
from ...populations.materials import reduced_modulus
from ...populations.shape import Sphere
from . import fields as f
from .grounds import Grounds, check_grounded
from .sections import Power, Section

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...populations.distributions import Distribution
    from ...populations.materials import Material
    from ...populations.particles import Particles
    from ...populations.shape import Angular
    from ...populations.strength import WeibullStrength
    from .sections import Sizes

    Array = NDArray[np.float64]
    Number = float | Array

__all__ = ["Numbers", "rules"]

SHADOWS = {
    "footprint": f.FOOTPRINT,
    "projected": f.PROJECTED,
    "covered": f.COVERED,
    "none": f.NOTHING,
}
TERMS, DEEPEST = 24, 5.0
"""Of the series of a panel; lowest separation [σ_s] that may be given, down."""
NODES = (
    ((6, 3.0, 10, 6.5, 16, 3.6, 8, 3.0, 4.0), (12, 3.0, 16, 6.5, 32, 3.6, 16, 3.0, 4.0)),
    ((12, 2.0, 16, 4.0, 16, 2.4, 16, 2.0, 2.0), (24, 2.0, 24, 4.0, 32, 2.4, 32, 2.0, 2.0)),
)
"""Of each level, few and all: nodes of a panel over heights and how many widths of a density it
covers, then the same of sizes on a rough seat, and of polynomials over a seat; nodes of a panel of
a squeeze, and widths of a rough seat and of the sizes on a plane that it covers."""
CARE, CARE_OF_SAMPLES = (1e-10, 5e-10), (1e-7, 1e-6)
"""Error that is asked for, and with which a state is solved at the finest nodes."""
MOST_SECTIONS = 40
"""Classes of size of a population: each costs as much as a population of its own."""
WIDEST = math.log(2.5)
"""Standard deviation of ln x up to which log-normal sizes were held to the slow path at 1e-9."""
MOST_STRAIN = 0.1
"""S_y/E* up to which the law of Jackson and Green was held to the slow path: its fits end at 0.007,
and the power of its area is an exponential of it."""
MOST_K = 3 / 1.4 * 110**-0.263
"""K of Kogut and Etsion above which the load falls at their last step (ν > 0.41)."""
NARROWEST = 1e-5
"""Width of sizes over their middle below which differences of sizes keep too few digits."""


BREAKING = (8, 16)
"""Nodes of a panel at the first level where particles break: how many are whole bends more than
what one carries."""


@lru_cache(maxsize=4)
def rules(breaks: bool = False, samples: bool = False) -> Array:
    """Rules of every level, then places and transform of the series of a panel."""
    most = max(asked[4] for asked in itertools.chain(*NODES))
    out = np.zeros((2 * len(NODES) + 1, f.POLYNOMIAL + 1 + most, most))
    _add_series(out[-1], TERMS)
    out[-1, 0, [f.ASKED, f.ENOUGH]] = CARE_OF_SAMPLES if samples else CARE
    for i, asked in enumerate(itertools.chain(*NODES)):
        if breaks and i < len(BREAKING):
            asked = (BREAKING[i], *asked[1:])
        narrow, half = asked[0] // 2, asked[6] // 2
        out[i, 0, : f.ALL_KINKS + 1] = *asked, narrow, half, i >= len(NODES[0])
        each = (f.RULE, asked[0]), (f.SIZE_RULE, asked[2]), (f.NARROW_RULE, narrow)
        for row, count in (*each, (f.PANEL_RULE, asked[6]), (f.HALF_RULE, half)):
            out[i, row, :count], out[i, row + 1, :count] = gauss_legendre(count)
        _add_series(out[i], asked[4])
    return out


def _add_series(rows: Array, terms: int) -> None:
    """Fill in Chebyshev nodes, and what each term of a series has of the values there."""
    angle = (np.arange(terms) + 0.5) * math.pi / terms
    series = rows[f.POLYNOMIAL :, :terms]
    series[0] = np.cos(angle)
    series[1 : terms + 1] = 2 / terms * np.cos(np.outer(np.arange(terms), angle))
    series[1] /= 2


def _law(
    kind: type, law: Any, R: Number, E: Number, H: Number, nu: Number
) -> tuple[list[Number], Number]:
    """Code and numbers of a law at a contact, and ω_1."""
    a = asperity
    if kind is a.GW:
        return [f.GW, 0, 0, 0, 0], law.yield_interference(R=R, E_star=E, H=H)
    if kind in (a.ZMC, a.Hermite):
        code = f.ZMC if kind is a.ZMC else f.HERMITE
        return [code, law.k, law.rho, 1.0, 2.0], law.yield_interference(R=R, E_star=E, H=H)
    if kind is a.EllipticZMC:
        r = hertz_of(law.ratio).R_A
        full = 2.0 if law.area_rule == "volume" else 2 * r
        return [f.ZMC, law.k, law.rho, r, full], law.yield_interference(R=R, E_star=E, H=H)
    if kind in (a.CEB, a.KE, a.EllipticCEB):
        K = law.K if law.K is not None else 0.454 + 0.41 * (nu if law.nu is None else law.nu)
        omega_1 = (math.pi * K * H / (2 * E)) ** 2 * R
        if kind is a.KE:
            return [f.KE, K, 0, 0, 0], omega_1
        if kind is a.CEB:
            return [f.CEB, K, 1.0, 2.0, 0], omega_1
        hertz = hertz_of(law.ratio)
        slope = 2.0 if law.area_rule == "volume" else 2 * hertz.R_A
        return [f.CEB, K, hertz.R_A, slope, 0], hertz.yield_factor * (2 / 3 * K * H / E) ** 2 * R
    if kind is a.JG:
        C = 1.295 * np.exp(0.736 * (nu if law.nu is None else law.nu))
        strain = H / (law.hardness_ratio * E)
        if np.any(strain > MOST_STRAIN):
            raise NotCompiled("the law jg, far beyond its fits")
        over_R = (math.pi * C * strain / 2) ** 2
        return [f.JG, C, 0.14 * np.exp(23 * strain), over_R, law.hardness_ratio], over_R * R
    if kind in (a.Coated, a.JKR, a.DMT):
        return _law_with_length(kind, law, R, E, H)
    raise NotCompiled(f"the law {law.name} is known to the NumPy engine alone")


def _law_with_length(
    kind: type, law: Any, R: Number, E: Number, H: Number
) -> tuple[list[Number], Number]:
    """As `_law`, of laws that have a length of their own and stay elastic."""
    unit = law.yield_interference(R=R, E_star=E, H=H)
    if kind is asperity.Coated:
        moduli = (law.E_1, law.nu_1, law.E_2, law.nu_2, law.E_3, law.nu_3)
        if any(np.ndim(each) for each in moduli):
            raise NotCompiled("a table of its own for each coating")
        return [f.COATED, law.E_1_star * law.t / (math.pi * R * H), 0, 0, 0], unit
    load = law.w / (unit * H)  # over that of a pressure H on πR times the unit of ω
    if kind is asperity.JKR:
        return [f.JKR, load, 0, 0, 0], unit
    return [f.DMT, 2 * load, 0, 0, 0], unit


STIFFEST, HIGHEST_PEAK, WIDEST_OVER_COATING = 20.0, 10.0, 1024.0
"""E_1/E_2 up to which a coating is known beyond its table; height of an asperity that may be
pressed flat [σ_s], and radius of its contact over the coating up to which that is tabulated."""
NO_COATING = np.zeros((1, 2 * f.COATING_TERMS))
PIECES = 256
"""Of the table of a coating: load to 1e-14 of it and area to 6e-13, for E_1/E_2 up to 1e3."""


@lru_cache(maxsize=8)
def coating_of(layer: ElasticLayer) -> Array:
    """What the kernel knows of coated asperities of these materials."""
    table, out = table_of(layer), np.zeros((1 + PIECES, 2 * f.COATING_TERMS))
    out[0, f.BENDS], out[0, f.STEPS] = table.beta, PIECES / table.table.edges[-1]
    out[0, f.TOP], out[0, f.THIN] = table.top, table.thin
    out[0, f.REST : f.REST + 4] = *table.load_rest, *table.area_rest
    out[1:] = table.pieces(PIECES, f.COATING_TERMS)
    return out


def _fill_columns(rows: Array, values: Mapping[int, Number | NDArray[np.bool_]]) -> None:
    for column, value in values.items():
        rows[:, column] = value


def _heights(heights: Any) -> dict[int, Number]:
    """Numbers of the heights of asperities [σ_s]."""
    kind = type(heights)
    if kind is GaussianHeights:
        last = DEEPEST + math.sqrt(DEEPEST**2 + 100.0)
        own = {f.HEIGHTS: f.GAUSSIAN_HEIGHTS, f.LAID_FROM: -math.inf}
        return {**own, f.STEP: 2.5, f.LAST: last}
    if kind is ExponentialHeights:  # without its end, one exponential at every separation
        own = {f.HEIGHTS: f.EXPONENTIAL, f.LOWEST_HEIGHT: -1.0, f.LAID_FROM: -1.0}
        return {**own, f.STEP: 4.0, f.LAST: COMPLETE}
    if kind is WeibullHeights:
        shape = heights.shape
        first, second = (special.gamma(1 + j / shape) for j in (1, 2))
        spread = np.sqrt(second - first**2)
        own = {f.HEIGHTS: f.WEIBULL, f.SHAPE: shape, f.MIDDLE: first, f.SPREAD: spread}
        ends = {f.LOWEST_HEIGHT: -first / spread, f.LAID_FROM: 1 - first / spread}
        return {**own, **ends, f.STEP: 1.5, f.LAST: COMPLETE ** (1 / shape) / spread}
    raise NotCompiled("such heights are known to the NumPy engine alone")


@lru_cache(maxsize=32)
def inside_of(nu: float, confines: bool) -> Array:
    """What the kernel knows of G, the tension inside a sphere between two caps."""
    table, bends = _equator(nu), _bends(nu)
    out = np.zeros((2 + len(table.half), 2 + table.coefficients.shape[1]))
    K = (7 + 2 * nu) / (7 + 5 * nu)
    out[0, :5] = 4 / math.pi * (1.25 * K - 0.5), confines, len(bends) * confines, len(table.half), K
    out[1, : len(bends)] = bends
    out[2:, 0], out[2:, 1] = table.edges[:-1], table.edges[1:]
    out[2:, 2:] = table.coefficients[:, :, 0]
    return out


def _softer(first: Material, second: Material) -> tuple[Any, Any]:
    """Hardness and Poisson ratio of the softer of two bodies."""
    takes = first.H <= second.H
    return np.where(takes, first.H, second.H), np.where(takes, first.nu, second.nu)


def _sections(one: Any, changed: Distribution) -> list[tuple[float, tuple[Sizes, Sizes]]]:
    """Shares of particles, and sizes of each that the kernel knows: a population is their sum.

    Numbers of classes are no inputs that vary.
    """
    if type(one) not in (sizes.Histogram, sizes.PowerLaw):
        return [(1.0, (one, changed))]
    out: list[tuple[float, tuple[Sizes, Sizes]]] = []
    slopes: tuple[float | None, ...] = getattr(one, "slopes", (None,) * len(one.counts))
    classes = zip(itertools.pairwise(one.edges), one.counts, slopes, strict=True)
    for (low, high), count, slope in classes:
        if count > 0:
            kind = sizes.Uniform(low=low, high=high) if slope is None else Power(low, high, slope)
            out.append((count / math.fsum(one.counts), (kind, kind)))
    if len(out) > MOST_SECTIONS:
        raise NotCompiled(f"sizes in more than {MOST_SECTIONS} classes")
    return out


class Numbers:
    """The numbers of N states, as the kernel reads them.

    Parameters
    ----------
    contact : Contact
        The inputs that do not vary.
    arrays : mapping
        Dotted names of inputs and their values (N,).

    Attributes
    ----------
    skins, parts, bodies : array (N, K, ...), (N, P, ...), (N, 2P, ...)
        Of asperities of each shape, populations and sides.

    Raises
    ------
    NotCompiled
        Models that the kernel does not know.
    """

    def __init__(self, contact: Contact, arrays: Mapping[str, Array], count: int):
        self.contact, self.count = contact, count
        self.varied = contact.with_arrays(arrays)
        shapes = contact.roughness.ellipticity
        classes = shapes.classes if shapes else [(None, 1.0, 1.0)]
        self.skins = np.zeros((count, len(classes), f.OF_ASPERITIES))
        self.coating = NO_COATING
        """What asperities that are coated do, if they are."""
        self.origin: Number = 0.0
        """Where the separations of the kernel begin, over the datum of d [m]."""
        self.deepest: Number = -DEEPEST
        """Lowest separation that may be given, in the unit of the kernel."""
        self.outside: Any = np.zeros(count, bool)
        """States that a table of the kernel does not reach, whose numbers are those of its edge."""
        if type(contact.asperity_law) is asperity.Field:
            self._add_field()
        else:
            for k, (ratio, radius, share) in enumerate(classes):
                self._add_asperities(self.skins[:, k], ratio, radius, share)
        bare = contact.two_body and "particles.areal_density" not in arrays
        found = [] if bare else self._populations()
        grounded = bool(found) and self.skins[0, 0, f.CODE] == f.FIELD
        if grounded:
            check_grounded(contact, found)
        self.inside = np.zeros((1, 1))
        """What particles that break have inside, if any do."""
        self.layer = np.zeros(self.count)
        """Bound of the part of the area that fragments cover in one layer."""
        self.centre = 0.0
        """Mean asperity height over the datum of d [m]."""
        if found:
            self.centre = found[0].varied.centre * self.varied.roughness.sigma
            self.origin = self.origin + self.centre if grounded else self.centre
        self.parts = np.zeros((count, len(found), f.OF_PARTICLES))
        self.bodies = np.zeros((count, 2 * len(found), f.OF_SIDE))
        self.last: Particles | None = None
        for p, each in enumerate(found):
            self._add_particles(p, each)
        self.ground: Grounds | None = None
        """Of particles on one field of heights."""
        if grounded:
            self.ground = Grounds(self.skins, self.parts, found, self.varied.roughness)

    def _add_asperities(
        self, rows: Array, ratio: float | None, radius: float, share: float
    ) -> None:
        """Fill in the numbers of asperities of one shape, by its λ, R_g/R and share."""
        rough, surfaces, law = self.varied.roughness, self.varied.surfaces, self.varied.asperity_law
        own = self.contact.asperity_law
        if ratio is not None:
            law = law.replace(ratio=ratio)
        E, (H, nu), R = surfaces.E_star, _softer(surfaces.first, surfaces.second), radius * rough.R
        numbers, omega_1 = _law(type(own), law, R, E, H, nu)
        area, w = share * rough.density * math.pi * R * omega_1, omega_1 / rough.sigma_s
        _fill_columns(rows, dict(enumerate(numbers)))
        _fill_columns(rows, {f.W: w, f.FORCE: area * H, f.AREA: area, f.FINEST: math.inf})
        _fill_columns(
            rows, {f.SIGMA_S: rough.sigma_s, f.SIGMA: rough.sigma, **_heights(rough.heights)}
        )
        if rows[:, f.W].min() < 1e-9 or rows[:, f.W].max() > 1e9:
            raise NotCompiled("asperities that yield at once, or never")
        if type(own) is asperity.JKR:  # stretched asperities reach above their height
            rows[:, f.START] = own.start
            rows[:, f.LAID_FROM] -= own.start * rows[:, f.W]
        if type(own) is asperity.Coated and isinstance(law, asperity.Coated):
            widest = np.sqrt(2 * R * HIGHEST_PEAK * rough.sigma_s) / law.t
            if own.layer.modulus_ratio > STIFFEST and np.any(widest > WIDEST_OVER_COATING):
                raise NotCompiled("stiff coatings so thin that contacts are as wide as their table")
            self.coating = coating_of(own.layer)
            rows[:, f.FINEST] = (0.5 / self.coating[0, f.BENDS]) ** 2

    def _add_field(self) -> None:
        """Fill in one field of heights, whose separations are those of the mean planes over σ."""
        rough, surfaces = self.varied.roughness, self.varied.surfaces
        law: Any = self.contact.asperity_law
        if law.spectrum is not None:
            raise NotCompiled("a field of a spectrum of its own has tables of its own")
        E, H = surfaces.E_star, _softer(surfaces.first, surfaces.second)[0]
        chi = np.broadcast_to(hardness_ratio(rough, E_star=E, H=H), self.count)
        alpha = np.array(np.broadcast_to(rough.alpha, self.count), dtype=float)
        self.outside = (alpha < ALPHAS[0]) | (alpha > ALPHAS[1])
        if self.outside.all():
            raise NotCompiled("bandwidths outside the table of the law field")
        alpha = np.clip(alpha, *ALPHAS)
        self.skins = np.zeros((self.count, 1, f.OF_FIELD))
        skin = self.skins[:, 0]
        remains = remainder_height(chi, alpha) if law.remainder else 0.0
        _fill_columns(
            skin,
            {
                **{f.CODE: f.FIELD, f.FORCE: E * rough.slope, f.AREA: 1.0, f.W: 1.0},
                **{f.SIGMA_S: rough.sigma, f.SIGMA: rough.sigma, f.CHI: chi},
                **{f.ABOVE_FIELD: remains, f.WIDER: area_factor(alpha), f.IS_SOFT: chi <= SOFT},
            },
        )
        for soft in (True, False):
            if len(some := np.flatnonzero((chi <= SOFT) == soft)):
                rows = rows_of(chi[some], alpha[some], soft=soft, columns=slice(f.COLUMNS_OF_TABLE))
                flat = rows.swapaxes(1, 2).reshape(len(some), f.COLUMNS_OF_TABLE, -1)
                for k in range(f.COLUMNS_OF_TABLE):
                    begin = f.OF_TABLE + k * f.HEIGHTS_OF_TABLE
                    skin[some, begin : begin + flat.shape[2]] = flat[:, k]
        self.origin = -np.asarray(rough.y_s)
        lowest = (separations(True)[0], separations(False)[0])
        self.deepest = np.where(chi <= SOFT, *lowest) + ROUNDING

    def _populations(self) -> list[Section]:
        """Sections of all populations."""
        given: Any = self.contact.particles
        varied: Any = self.varied.particles
        if not isinstance(given, tuple):
            given, varied = (given,), (varied,)
        out: list[Section] = []
        number = 0
        for one, changed in zip(given, varied, strict=True):
            if one.law is not None:
                law = one.law, changed.law
            else:
                law = self.contact.particle_law, self.varied.particle_law
            for weight, simple in one.diameter.components:
                now = changed.diameter if simple is one.diameter else simple
                for part, section in _sections(simple, now):
                    out.append(Section(one, changed, *law, weight * part, part, number, section))
                number += 1
        return out

    def _add_particles(self, p: int, each: Section) -> None:
        one, changed, law, varied = each.one, each.changed, each.law, each.varied
        if type(law) is particle.Horng2022:
            self._add_printed(self.parts[:, p], one.diameter, changed, varied)
            return
        if type(law) not in (particle.Series, particle.Flakes) or law.onset != "hermite":
            raise NotCompiled("particles that are not Series")
        grit = None if isinstance(one.shape, Sphere) else changed.shape
        if grit is not None and type(law) is not particle.Series:
            raise NotCompiled("angular flakes")
        rows, rough = self.parts[:, p], self.varied.roughness
        breadth = 2 * varied.tip_radius if grit is None else grit.flatness**2
        width = varied.zeta_std * rough.sigma if law.seat == "rough" else 0.0
        _fill_columns(
            rows,
            {
                **{f.SEAT: f.ROUGH if law.seat == "rough" else f.PLANE, f.WIDTH: width},
                f.OFFSET: varied.seat_offset(rough) + self.centre,
                **{f.SHADOW: SHADOWS[law.shadow]},
                **{f.DENSITY: changed.areal_density * each.share, f.BREADTH: breadth},
            },
        )
        squared = self._add_sizes(rows, *each.sizes)
        if one.strength is not None:
            self._add_strength(rows, one.strength, changed, each.sizes[0])
        rows[:, f.COVERAGE] = math.pi / 4 * rows[:, f.BREADTH] * rows[:, f.DENSITY] * squared
        if np.any(rows[:, f.COVERAGE] >= 1):
            raise NotCompiled("some particles are jammed")  # said better, one contact at a time
        if one.strength is not None:
            self._need_one_layer(rows)
        self._add_sides(rows, p, changed, law, varied, grit)

    def _need_one_layer(self, rows: Array) -> None:
        """Refuse contacts whose fragments might cover more than the area, in one layer.

        Those which cover no more than their parents cannot. Of others there is no more volume
        than of the particles, in fragments larger than κ x_c.
        """
        with np.errstate(divide="ignore"):
            finest = rows[:, f.HIGH] / (rows[:, f.RATIO] * rows[:, f.UNBROKEN])
        grows = rows[:, f.KEPT] > rows[:, f.RATIO]
        self.layer = self.layer + np.where(grows, rows[:, f.COVERAGE] * (1 + finest), 0.0)
        if np.any(self.layer >= 1):
            raise NotCompiled("some fragments may be jammed")  # counted one contact at a time

    def _add_sides(
        self, rows: Array, p: int, changed: Particles, law: Any, varied: Any, grit: Any
    ) -> None:
        """Fill in both sides of part p: once for all classes of size of one population."""
        here, other = self.bodies[:, 2 * p], self.bodies[:, 2 * p + 1]
        if p > 0 and changed is self.last:
            here[:], other[:] = self.bodies[:, 2 * p - 2], self.bodies[:, 2 * p - 1]
            for k in (f.STIFFEST, f.SOFTEST, f.EQUAL):
                rows[:, k] = self.parts[:, p - 1, k]
            return
        self.last = changed
        first, second = self.varied.surfaces.first, self.varied.surfaces.second
        E, H = self._side(here, first, changed.material, law, varied, grit)
        E_2, H_2 = E, H
        if all(np.array_equal(getattr(first, x), getattr(second, x)) for x in ("H", "E", "nu")):
            other[:] = here
        else:
            E_2, H_2 = self._side(other, second, changed.material, law, varied, grit)
        rows[:, f.STIFFEST], rows[:, f.SOFTEST] = np.minimum(E, E_2), np.minimum(H, H_2)
        rows[:, f.EQUAL] = np.all(here == other, axis=1)

    def _add_strength(self, rows: Array, one: WeibullStrength, changed: Any, size: Sizes) -> None:
        """Fill in how particles break."""
        if type(size) is sizes.Monodisperse:
            raise NotCompiled("particles that break, of one size")
        strength, body = changed.strength, changed.material
        nu = np.unique(np.broadcast_to(body.nu, self.count))
        confines = one.confinement == "sphere"
        if confines and len(nu) > 1:
            raise NotCompiled("particles that break, of different Poisson ratios")
        inside = inside_of(float(nu[0]), confines)
        if self.inside.shape[1] > 1 and not np.array_equal(inside, self.inside):
            raise NotCompiled("particles that break, of different Poisson ratios")
        self.inside = inside
        kept = strength.bearing_share
        _fill_columns(
            rows,
            {
                **{f.BREAKS: 1, f.MODULUS: strength.m, f.EXPONENT: strength.b, f.KEPT: kept},
                f.LN_STRENGTH: np.log(strength.sigma_0) + strength.b * np.log(strength.x_0),
                **{f.UNBROKEN: strength.least(body), f.RATIO: np.where(kept, strength.ratio, 0.5)},
            },
        )

    def _add_printed(
        self, rows: Array, one: Distribution, changed: Particles, law: particle.Horng2022
    ) -> None:
        """Fill in the numbers of particles whose sum is printed."""
        if type(one) not in (sizes.TruncatedGaussian, sizes.LogNormal, sizes.Uniform):
            raise NotCompiled("sizes over which the paper prints no integral")
        self._add_sizes(rows, one, changed.diameter)
        x_a, mass = rows[:, f.SIZE_1], np.ones(self.count)
        if type(one) is sizes.TruncatedGaussian:
            mass = 1 / (math.sqrt(2 * math.pi) * rows[:, f.SIZE_2] * rows[:, f.NORM])
        elif type(one) is sizes.LogNormal:
            x_a = x_a * np.exp(0.5 * rows[:, f.SIZE_2] ** 2)
        rough = self.varied.roughness
        found = printed_numbers(law, self.varied.surfaces, rough, changed, x_a, mass)
        above = f.BY_APPROACH if law.plastic_weight == "xxd" else f.AS_FIRST
        _fill_columns(
            rows,
            {
                **{f.SEAT: f.PRINTED, f.SHADOW: f.NOTHING, f.OFFSET: self.centre},
                **{f.BEYOND: found.h_e, f.TAKES: found.area_factor, f.BEARS: found.pressure},
                **{f.WINDOW: found.C, f.FIXED: x_a if law.weight == "xa2" else 0.0},
                **{f.ABOVE: above if law.plastic else f.NEVER},
                **{f.SHADES: 0.0 if law.shadow == "none" else found.shadow_factor},
                **{f.DARK: float(law.shadow == "xmin"), f.SPLIT: law.particle_regime == "split"},
            },
        )

    def _side(
        self,
        rows: Array,
        surface: Material,
        body: Material,
        law: Any,
        varied: Any,
        grit: Any,
    ) -> tuple[Number, Number]:
        """Fill in the rows of a side, of angular particles if ``grit`` is a shape; its E* and H."""
        R = varied.tip_radius if grit is None else 0.5 * grit.roundness
        E, (H, nu) = reduced_modulus(surface, body), _softer(surface, body)
        numbers, delta_1 = _law(type(law.law), varied.law, R, E, H, nu)
        _fill_columns(rows, dict(enumerate(numbers)))
        falls = type(law.law) is asperity.KE and np.any(numbers[1] > MOST_K)
        if hasattr(law.law, "ratio") or falls:
            raise NotCompiled(
                f"particles by the law {law.law.name} are known to the NumPy engine alone"
            )
        if grit is not None:
            self._add_grit(rows, H, delta_1, R, grit)
            return E, H
        soft = np.broadcast_to(body.H < surface.H, self.count)
        yields = type(law.law) not in (asperity.GW, asperity.JG)
        if law.soft != "squashed" or not yields:
            soft = np.zeros(self.count, bool)
        ratio = np.broadcast_to(E / H, self.count)
        if np.any(soft & ((ratio < 1e-6) | (ratio > 1e9) | (surface.H / H > 1e9))):
            raise NotCompiled("squashed particles beyond the law")
        if law.deep == "table" and law.soft == "squashed" and yields:
            return self._add_deep(rows, surface.H, body.H, E, H, delta_1, varied)
        full = np.where(soft, 1 / (6 * R * delta_1), 0.5 / delta_1)
        _fill_columns(
            rows,
            {
                **{f.FORM: np.where(soft, f.SQUASHED, f.SPHERE), f.DELTA_1: delta_1, f.TIP: R},
                **{f.UNIT: R * math.pi * delta_1 * H, f.FULL: full},
                f.HILL: np.where(soft, 2 * varied.friction_factor / (3 * math.sqrt(3)), 0.0),
                f.HARDER: np.where(soft, surface.H / H, 1.0),
            },
        )
        return E, H

    def _add_grit(self, rows: Array, H: Number, delta_1: Number, R: Number, grit: Angular) -> None:
        """Fill in the rows of a side that is a tip, or a tip and faces."""
        edge = R * np.tan(grit.angle)
        faced = edge < 0.5 * grit.flatness * (1 - 1e-12)
        _fill_columns(
            rows,
            {
                **{f.FORM: np.where(faced, f.FACED, f.SPHERE), f.DELTA_1: delta_1, f.TIP: R},
                f.UNIT: R * math.pi * delta_1 * H,
                f.FULL: 0.25 * grit.flatness**2 / (R * delta_1),
                **{f.FACE_AREA: edge**2 / (R * delta_1), f.FACE_TAN: np.tan(grit.angle)},
            },
        )

    def _add_deep(
        self,
        rows: Array,
        surface: Number,
        body: Number,
        E: Number,
        H: Number,
        delta_1: Number,
        varied: Any,
    ) -> tuple[Number, Number]:
        """Fill in the rows of a side by the table of deep squeezes; its E* and H."""
        ratio, R = body / surface, 0.5
        given = (ratio, varied.friction_factor, E / H)
        # one case, where none of them varies
        cases = np.broadcast_arrays(*(np.atleast_1d(each) for each in given))
        load, area = curve_rows(*cases)
        terms = f.TABLE_LOAD + f.TABLE_TERMS
        rows[:, f.TABLE_LOAD : terms], rows[:, f.TABLE_AREA : f.OF_SIDE] = load, area
        _fill_columns(
            rows,
            {
                **{f.FORM: f.DEEP, f.DELTA_1: delta_1, f.TIP: R, f.FULL: 0.5 / delta_1},
                f.UNIT: R * math.pi * delta_1 * H,
                f.HILL: varied.friction_factor / (3 * math.sqrt(3)),
                f.HARDER: np.maximum(1 / ratio, 1.0),
                f.TAKEN: squashed_part(sink_rows(*cases[:2])),
            },
        )
        return E, H

    def _add_sizes(self, rows: Array, one: Sizes, changed: Any) -> Number:
        """Fill in the sizes; ⟨x²⟩."""
        if type(one) is sizes.Monodisperse:
            x = changed.mean
            kind = {f.KIND: f.ONE_SIZE, f.SIZE_1: x, f.LOW: x, f.HIGH: x, f.NORM: 1.0}
            _fill_columns(rows, kind)
            return x * x
        if type(one) is sizes.TruncatedGaussian:
            mean, std = changed.mean, changed.std
            cut = np.minimum(changed.n, sizes.NORMAL_CUT)
            low, high = np.maximum(0.0, mean - cut * std), mean + cut * std
            A, B = (low - mean) / std, (high - mean) / std
            mass = special.ndtr(B) - special.ndtr(A)
            root = math.sqrt(2 * math.pi)
            edge = [np.exp(-0.5 * u * u) / root for u in (A, B)]
            norm = 1 / (root * std * mass)
            kind = {f.KIND: f.GAUSSIAN, f.SIZE_1: mean, f.SIZE_2: std, f.NORM: norm}
            _fill_columns(rows, {**kind, f.LOW: low, f.HIGH: high})
            if np.any(std < NARROWEST * mean):
                raise NotCompiled("sizes that lie very close together")
            m1 = mean + std * (edge[0] - edge[1]) / mass
            v = 1 + (A * edge[0] - B * edge[1]) / mass
            return mean * (2 * m1 - mean) + std**2 * v
        if type(one) is sizes.LogNormal:
            median, s = changed.median, np.log(changed.gsd)
            cut = sizes.NORMAL_CUT
            _fill_columns(
                rows,
                {
                    **{f.KIND: f.LOGNORMAL, f.SIZE_1: median, f.SIZE_2: s},
                    f.NORM: 1 / (math.sqrt(2 * math.pi) * s),
                    **{
                        f.LOW: median * np.exp(-cut * s),
                        f.HIGH: median * np.exp((cut + 2 * s) * s),
                    },
                },
            )
            if np.any(s < NARROWEST):
                raise NotCompiled("sizes that lie very close together")
            if np.any(s > WIDEST):
                raise NotCompiled("sizes over many decades are known to the NumPy engine alone")
            return median**2 * np.exp(2 * s * s)
        if type(one) is sizes.Uniform:
            low, high = changed.low, changed.high
            if np.any(high - low < NARROWEST * high):
                raise NotCompiled("sizes that lie very close together")
            kind = {f.KIND: f.UNIFORM, f.SIZE_1: 0.5 * (low + high), f.NORM: 1 / (high - low)}
            _fill_columns(rows, {**kind, f.LOW: low, f.HIGH: high})
            return (high**2 + high * low + low**2) / 3
        if type(one) is Power:
            low, high, slope = one
            if high - low < NARROWEST * high:
                raise NotCompiled("sizes that lie very close together")
            long = math.log1p((high - low) / low)
            kind = {f.KIND: f.POWER, f.SIZE_1: low, f.SIZE_2: slope + 1, f.LOW: low, f.HIGH: high}
            _fill_columns(rows, {**kind, f.NORM: 1 / (low * long * special.exprel(-slope * long))})
            ratio = special.exprel((2 - slope) * long) / special.exprel(-slope * long)
            return low**2 * float(ratio)
        raise NotCompiled(f"{type(one).__name__} sizes are known to the NumPy engine alone")
