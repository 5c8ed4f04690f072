r"""Rough surfaces without a single scale: a fractal, stacked sinusoids, and particles between them.

`MajumdarBhushan` and `Stack` give the real area of two bare surfaces from the load;
`GhaedniaMultiscale` takes either and puts particles where the surfaces touch.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np
from scipy import special

from ..contact.particle_averages import size_average
from ..contact.particle_sums import Part
from ..errors import InvalidValue, Mistake, Problem
from ..laws.asperity import JG, AbstractAsperityLaw
from ..laws.asperity.hermite import SMOOTH
from ..laws.base import HERMITE
from ..laws.particle.one_particle import contact_sides, squeezed_particle
from ..numerics.quadrature import panel_rule
from ..populations.distributions import Monodisperse
from ..populations.materials import MaterialPair
from ..populations.particles import Particles
from ..populations.shape import Sphere
from ..quantities.record import Column, StateRecord, column
from ..quantities.say import value_of
from ..quantities.value import Value, quantity
from .sinusoids import Convergence, Sinusoid, Stack, jackson_streator

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = [
    "Convergence",
    "FractalLoad",
    "GhaedniaMultiscale",
    "MajumdarBhushan",
    "MultiscaleState",
    "NixGao",
    "Sinusoid",
    "Stack",
    "jackson_streator",
]


def __dir__() -> list[str]:
    return sorted(__all__)


# ---------------------------------------------------------------- Majumdar and Bhushan
class FractalLoad(NamedTuple):
    """The load [N] on elastic and on plastic spots, and together; see `MajumdarBhushan`.

    Examples
    --------
    >>> from thirdbody.systems.fractal import MajumdarBhushan
    >>> load = MajumdarBhushan(D=1.5, G=1e-12, E_star=1e11, H=2e9).load(1e-10)
    >>> bool(load.total == load.elastic + load.plastic)
    True
    """

    elastic: Array
    """P_e [N]"""
    plastic: Array
    """P_p [N]"""

    @property
    def total(self) -> Array:
        """P_e + P_p [N]"""
        return self.elastic + self.plastic


@dataclass(frozen=True, slots=True, kw_only=True)
class MajumdarBhushan(Value):
    r"""Contact of fractal surfaces: a power law of spot sizes, each spot elastic or plastic.

    Spots of area a have the curvature radius :math:`R = a^{D/2}/(\pi^2 G^{D-1})`, and their number
    per area is :math:`n(a) = (D/2)\,a_L^{D/2} a^{-D/2-1}` up to the largest, a_L. An elastic
    spot carries :math:`(4\sqrt\pi/3)\,E^* G^{D-1} a^{(3-D)/2}`, a plastic one Ha, and

    .. math:: A = \frac{D}{2-D}a_L, \qquad a_c = G^2 (2E^*/H)^{2/(D-1)},
    .. math:: P_e = \frac{4\sqrt\pi}{3} E^* G^{D-1} \frac D2 a_L^{D/2}\,
              \frac{a_L^e-a_c^e}{e}, \quad e = \frac{3-2D}{2}, \qquad
              P_p = H\frac{D}{2-D} a_L^{D/2} a_c^{1-D/2},

    P_e with :math:`\ln(a_L/a_c)` at D = 3/2; below a_L = a_c all is plastic, P = HA.

    Parameters
    ----------
    D : float
        Fractal dimension of a profile D [1], between 1 and 2; of the surface it is one more.
    G : float
        Fractal roughness G [m].
    E_star, H : float
        Contact modulus E* [Pa], hardness of the softer body H [Pa].
    nominal_area : float, optional
        A_n [m²], needed by `fraction` only.

    Notes
    -----
    Spots *smaller* than a_c are plastic, and a spot turns elastic as it grows. That is how the
    model was published, and the reverse of contact mechanics: it comes from a critical area that
    knows no scale (Morag, Etsion 2005). The load on an elastic spot uses its area, a = π·(contact
    radius)²; its height G^(D−1) a^(1−D/2) and R do not obey Hertz's a = πRω, and putting the
    height into Hertz's law gives 5.6 times less. The load of one spot falls by a factor
    2√π/3 = 1.18 from elastic to plastic at a_c.
    Factors on H in the plastic load differ between papers; here it is 1.

    Provenance: derived; the exponent :math:`P \propto A^{(3-D)/2}` and small-is-plastic seen.

    References
    ----------
    Majumdar, Bhushan 1991, J. Tribol. 113, 1, doi:10.1115/1.2920588.

    Examples
    --------
    >>> from thirdbody.systems.fractal import MajumdarBhushan
    >>> surface = MajumdarBhushan(D=1.5, G=1e-12, E_star=1e11, H=2e9)
    >>> load = surface.load(1e-10)
    >>> round(float(load.elastic), 8), round(float(load.plastic), 8)
    (0.07743582, 0.01897367)
    """

    citation: ClassVar[str] = "Majumdar, Bhushan 1991, J. Tribol. 113, 1"
    doi: ClassVar[str] = "10.1115/1.2920588"
    provenance: ClassVar[str] = "derived; exponent and regimes seen"

    D: float = quantity("D", "1", "fractal dimension of a profile", gt=1, lt=2)
    G: float = quantity("G", "m", "fractal roughness", gt=0)
    E_star: float = quantity("E*", "Pa", "contact modulus", gt=0)
    H: float = quantity("H", "Pa", "hardness of the softer body", gt=0)
    nominal_area: float | None = quantity("A_n", "m^2", "nominal area", default=None, gt=0)

    @property
    def _log_critical(self) -> float:
        return 2 * math.log(self.G) + 2 / (self.D - 1) * math.log(2 * self.E_star / self.H)

    @property
    def critical_area(self) -> float:
        """a_c [m²]: smaller spots are plastic; it overflows to inf as D → 1."""
        return math.exp(self._log_critical) if self._log_critical < 709 else math.inf

    def curvature_radius(self, a: ArrayLike) -> Array:
        """R of a spot of area a [m].

        Parameters
        ----------
        a : float or array
            Area of a spot [m²].
        """
        a = np.asarray(a, dtype=float)
        return a ** (self.D / 2) / (math.pi**2 * self.G ** (self.D - 1))

    def spot_force(self, a: ArrayLike) -> Array:
        """Load on one spot of area a [m²] in N.

        Parameters
        ----------
        a : float or array
            Area of a spot [m²].
        """
        a = np.asarray(a, dtype=float)
        elastic = self._elastic_unit * a ** ((3 - self.D) / 2)
        return np.where(a < self.critical_area, self.H * a, elastic)

    def spot_density(self, a: ArrayLike, *, a_L: float) -> Array:
        """n(a) [1/m²]: number of spots per spot area, up to the largest a_L [m²].

        Parameters
        ----------
        a : float or array
            Area of a spot [m²].
        a_L : float
            Area of the largest spot [m²].
        """
        a = np.asarray(a, dtype=float)
        return np.where(a <= a_L, self.D / 2 * a_L ** (self.D / 2) * a ** (-self.D / 2 - 1), 0.0)

    @property
    def _elastic_unit(self) -> float:
        return 4 * math.sqrt(math.pi) / 3 * self.E_star * self.G ** (self.D - 1)

    def area(self, a_L: ArrayLike) -> Array:
        """Real area A [m²] of all spots up to the largest a_L [m²].

        Parameters
        ----------
        a_L : float or array
            Area of the largest spot [m²].
        """
        return self.D / (2 - self.D) * np.asarray(a_L, dtype=float)

    def load(self, a_L: ArrayLike) -> FractalLoad:
        """Load [N] on all spots up to the largest a_L [m²], elastic and plastic.

        Parameters
        ----------
        a_L : float or array
            Area of the largest spot [m²].
        """
        D, a_L = self.D, np.asarray(a_L, dtype=float)
        e = 1.5 - D
        log_ratio = np.maximum(np.log(a_L) - self._log_critical, 0.0)  # ln(a_L/a_c)
        # (a_L^e − a_c^e)/e without cancellation, logarithm included
        spread = a_L**e * log_ratio * special.exprel(-e * log_ratio)
        elastic = self._elastic_unit * D / 2 * a_L ** (D / 2) * spread
        plastic = self.H * self.area(a_L) * np.exp(-(1 - D / 2) * log_ratio)
        return FractalLoad(elastic, plastic)

    def largest_spot(self, load: ArrayLike) -> Array:
        """a_L [m²] at which the spots carry a load P [N]; the inverse of `load`."""
        from scipy.optimize.elementwise import find_root

        P = np.asarray(load, dtype=float)
        safe = np.where(P > 0, P, 1.0)
        # no spot carries more than 2√π/3 H a
        low = np.log(safe / (1.2 * self.H) * (2 - self.D) / self.D)
        root = find_root(
            lambda x, p: np.log(self.load(np.exp(x)).total / p),
            (low, low + 150.0),
            args=(safe,),
            tolerances={"xatol": 1e-15, "xrtol": 1e-15, "fatol": 0.0, "frtol": 0.0},
        )
        return np.where(P > 0, np.exp(root.x), 0.0)

    def fraction(self, pressure: ArrayLike) -> Array:
        """Real area per nominal area [1] under a nominal pressure [Pa].

        The area of `nominal_area` at the load p A_n, at most 1. The load is not proportional to
        the area, so the fraction depends on A_n.
        """
        if self.nominal_area is None:
            raise InvalidValue(
                "MajumdarBhushan.nominal_area is needed for a pressure [m^2]", code=Mistake.MISSING
            )
        a_L = self.largest_spot(np.asarray(pressure, dtype=float) * self.nominal_area)
        return np.minimum(self.area(a_L) / self.nominal_area, 1.0)


# ---------------------------------------------------------------- particles
@dataclass(frozen=True, slots=True, kw_only=True)
class NixGao(Value):
    r"""Hardness that grows at small depth: :math:`H/H_0 = \sqrt{1 + h^*/h}` at the depth h.

    Parameters
    ----------
    h_star : float
        Characteristic depth h* [m].

    References
    ----------
    Nix, Gao 1998, J. Mech. Phys. Solids 46, 411, doi:10.1016/S0022-5096(97)00086-0. Recalled.

    Examples
    --------
    >>> from thirdbody.systems.fractal import NixGao
    >>> float(NixGao(h_star=300e-9)(100e-9))
    2.0
    """

    h_star: float = quantity("h*", "m", "characteristic depth", gt=0)

    def __call__(self, depth: ArrayLike) -> Array:
        return np.sqrt(1 + self.h_star / np.asarray(depth, dtype=float))


class ParticleFilm:
    """Particles between two smooth flats: load and areas per area of the flats, by gap [m]."""

    def __init__(self, model: GhaedniaMultiscale):
        self.model = model
        self.sides = contact_sides(model.surfaces, model.particles.material)
        self.sizes = model.particles.diameter
        self.top = self.sizes.support[1]
        self.seats: list[Part] = []
        if model.size_effect is None:
            for weight, sizes in self.sizes.components:
                scale, shape = sizes.standardised()
                average = size_average(squeezed_particle(model.law, *self.sides), shape)
                density = weight * model.particles.areal_density
                self.seats.append(Part(average, scale, density, offset=0.0))

    def __call__(self, gap: Array) -> Array:
        """Pressure [Pa], area on surface 1 and larger area of both [1]: (N, 3)."""
        out = np.zeros((len(gap), 3))
        if self.model.size_effect is None:
            for seat in self.seats:
                columns = seat.columns(gap)
                out += np.stack([columns[:, 0], columns[:, 1:4].sum(axis=1), columns[:, 5]], axis=1)
            return out
        eta = self.model.particles.areal_density
        for weight, sizes in self.sizes.components:
            if isinstance(sizes, Monodisperse):
                x, density = np.full((len(gap), 1), sizes.mean), np.ones((len(gap), 1))
            else:
                edges = np.clip(np.array(sizes.pieces), gap[:, None], None)
                # three panels for each piece of the density, √(x − g) as variable
                root = np.sqrt(np.maximum(edges - gap[:, None], 0.0))
                thirds = [root[:, :1]]
                for i in range(1, 4):
                    thirds.append(root[:, :-1] + i / 3 * np.diff(root, axis=1))
                u, du = panel_rule(np.sort(np.concatenate(thirds, axis=1), axis=1), 16)
                x = gap[:, None] + u * u
                density = sizes.pdf(x) * 2 * u * du
            values = self._single(x, np.maximum(x - gap[:, None], 0.0))
            out += weight * eta * np.einsum("gn,gnk->gk", density, values)
        return out

    def _single(self, x: Array, delta: Array) -> Array:
        """Load [N], area on surface 1 and larger area [m²] of single particles: (..., 3)."""
        one, two = self.sides
        share = np.full_like(delta, 0.5)
        pressed = delta > 0
        if one != two and np.any(pressed):
            from scipy.optimize.elementwise import find_root

            share[pressed] = find_root(
                lambda t, d, x: self._side(one, x, t * d)[0] - self._side(two, x, (1 - t) * d)[0],
                (np.zeros(pressed.sum()), np.ones(pressed.sum())),
                args=(delta[pressed], x[pressed]),
                tolerances={"xatol": 0.0, "xrtol": 1e-12, "fatol": 0.0, "frtol": 0.0},
            ).x
        force, area = self._side(one, x, share * delta)
        _, other = self._side(two, x, (1 - share) * delta)
        return np.stack([force, area, np.maximum(area, other)], axis=-1)

    def _side(
        self, side: tuple[float, float, float], x: Array, delta: Array
    ) -> tuple[Array, Array]:
        """Load and area of one contact, the area at most the great circle."""
        E_star, H_0, nu = side
        assert self.model.size_effect is not None
        law = self.model.law.bound(R=self.sizes.mean_diameter / 2, E_star=E_star, H=H_0, nu=nu)
        depth = np.maximum(delta, 1e-300)
        H = H_0 * np.asarray(self.model.size_effect(depth), dtype=float)
        H = np.minimum(H, 1e6 * E_star)  # elastic by far
        R = x / 2
        omega_1 = law.yield_interference(R=R, E_star=E_star, H=H)
        y = np.where(delta > 0, delta / omega_1, 0.0)
        area = math.pi * R * omega_1 * law.reduced("area", y)
        force = math.pi * R * omega_1 * H * law.reduced("force", y)
        cap = math.pi * x * x / 4
        over = area > cap
        force = np.where(over, force * cap / np.where(over, area, 1.0), force)
        return force, np.minimum(area, cap)


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class MultiscaleState(StateRecord):
    """Equilibrium of `GhaedniaMultiscale`: floats for one pressure, arrays for several.

    Areas are per nominal area [1]. Made by `GhaedniaMultiscale.solve`.

    Examples
    --------
    >>> from thirdbody.papers.ghaednia2013 import model
    >>> state = model("fractal").solve(1e6)
    >>> bool(state.A_real < state.A_0), round(float(state.particle_load_share), 3)
    (True, 1.0)
    """

    more_columns = {"A_real": Column("A", "1", "real area: particles and asperities")}
    pressure: Array = column("p", "Pa", "nominal pressure")
    A_0: Array = column("A_0", "1", "real area without particles, on which the particles work")
    local_pressure: Array = column("p/A_0", "Pa", "pressure on that area")
    gap: Array = column("g", "m", "gap between the asperities, 0 where they touch")
    A_particles: Array = column("A_p", "1", "area of the particles on surface 1")
    A_asperities: Array = column("A_a", "1", "area of the asperities, 0 while g > 0")
    particle_load_share: Array = column("F_p/F", "1", "load share of the particles")
    warnings: tuple[str, ...]

    @property
    def A_real(self) -> Array:
        """Real area: particles and asperities."""
        return self.A_particles + self.A_asperities


@dataclass(frozen=True, slots=True, kw_only=True)
class GhaedniaMultiscale(Value):
    r"""Particles in a multi-scale contact, in two submodels (Ghaednia and Jackson 2013).

    The multi-scale contact of the bare rough surfaces gives the area A_0 where they would touch.
    Particles lie there, between patches taken as smooth: A_0 is the *nominal* area of the
    particle contact. The gap g between the patches follows from

    .. math:: \eta_p \int_g^\infty f(x, x-g)\,\psi(x)\,dx = P_p(g) = p/A_0 .

    If even P_p(0) is too little, then g = 0 and the patches carry p − A_0 P_p(0) on what the
    particles leave free, :math:`A_0(1-\eta_p\langle\text{footprint}\rangle)`. Real area: the
    particles' while g > 0, both at g = 0.

    Parameters
    ----------
    surface : Stack or MajumdarBhushan
        The bare rough contact; its E* must be that of the two surfaces.
    surfaces : MaterialPair
    particles : Particles
        Sizes, and their number per area of either submodel η_p.
    law : AbstractAsperityLaw, optional
        One particle against one surface (radius x/2, area at most the great circle), in series on
        both sides; `Hermite` by default.
    size_effect : callable, optional
        H/H_0 as a function of the depth of indentation [m], for example `NixGao`; constant
        hardness by default. The load is then a quadrature with a relative error of about 1e-5.
        Of these only `NixGao` survives `to_dict`.

    Notes
    -----
    Reconstructed. Seen, in the authors' abstracts: two submodels, one for the rough contact and
    one for particles with distributed sizes; scale-dependent yield of a particle contact; the
    particles lower the real area. That the real area of the one is the nominal area of the other
    is the authors' idea; the equations here are not theirs. At the pressure where g reaches 0
    the real area jumps to A_0, because the patches are flat.

    References
    ----------
    Ghaednia, Jackson 2013, J. Tribol. 135, 041603, doi:10.1115/1.4024297.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.fractal import GhaedniaMultiscale, Sinusoid, Stack
    >>> steel = tb.materials["S45C"]
    >>> pair = tb.MaterialPair(steel, steel)
    >>> waves = (Sinusoid(amplitude=1e-6, frequency=1e3), Sinusoid(amplitude=2e-7, frequency=1e4))
    >>> model = GhaedniaMultiscale(
    ...     surface=Stack(levels=waves, E_star=pair.E_star),
    ...     surfaces=pair,
    ...     particles=tb.Particles(
    ...         material=tb.materials["SiO2"],
    ...         diameter=tb.TruncatedGaussian(mean=60e-9, std=12e-9),
    ...         areal_density=5e13,
    ...     ),
    ... )
    >>> state = model.solve(10e6)
    >>> state.A_real < state.A_0
    True
    """

    name: ClassVar[str] = "ghaednia-multiscale"
    title: ClassVar[str] = "Ghaednia–Jackson, two submodels (reconstruction)"
    year: ClassVar[int] = 2013
    citation: ClassVar[str] = "after Ghaednia, Jackson 2013, J. Tribol. 135, 041603"
    doi: ClassVar[str] = "10.1115/1.4024297"
    provenance: ClassVar[str] = "reconstructed"

    surface: Stack | MajumdarBhushan
    surfaces: MaterialPair
    particles: Particles
    law: AbstractAsperityLaw = SMOOTH
    size_effect: Callable[[ArrayLike], Array] | None = None

    def _problems(self) -> list[str]:
        kinds = {
            "surface": Stack | MajumdarBhushan,
            "surfaces": MaterialPair,
            "particles": Particles,
            "law": AbstractAsperityLaw,
        }
        out: list[str] = [
            Problem(name, f"is not a {kind}", repr(getattr(self, name)), code=Mistake.KIND)
            for name, kind in kinds.items()
            if not isinstance(getattr(self, name), kind)
        ]
        if out:
            return out
        if self.particles.strength is not None:
            out.append(
                Problem(
                    "particles",
                    "have a strength, and this model does not break particles; remove it",
                    code=Mistake.BEYOND,
                )
            )
        if not isinstance(self.particles.shape, Sphere):
            out.append(
                Problem(
                    "particles",
                    "are angular, and those of this model are spheres; remove shape",
                    code=Mistake.BEYOND,
                )
            )
        for name in ("E_star", "H"):
            surface_value, pair_value = getattr(self.surface, name), getattr(self.surfaces, name)
            if surface_value is not None and not math.isclose(
                surface_value, pair_value, rel_tol=1e-6
            ):
                out.append(
                    Problem(
                        f"surface.{name}",
                        f"Pa differs from that of the surfaces, {value_of(pair_value, 'Pa')}",
                        f"{surface_value:g}",
                        code=Mistake.BEYOND,
                    )
                )
        if not self.law.scale_free:
            out.append(
                Problem(
                    "law",
                    "has a length of its own; "
                    "particles of all sizes need a law that only knows indentation over radius, "
                    "e.g. " + HERMITE,
                    f"{type(self.law).__name__}",
                    code=Mistake.BEYOND,
                )
            )
        if isinstance(self.law, JG) and self.size_effect is not None:
            out.append(
                Problem(
                    "law",
                    "= JG has its own hardness; use another with a size_effect",
                    code=Mistake.BEYOND,
                )
            )
        return out

    def solve(self, pressure: ArrayLike) -> MultiscaleState:
        """The state under a nominal pressure [Pa], a number or an array."""
        from scipy.optimize.elementwise import find_root

        pressures = np.asarray(pressure, dtype=float)
        p = np.atleast_1d(pressures).ravel()
        if not np.all(p > 0):
            raise InvalidValue("pressure must be > 0 [Pa]", code=Mistake.RANGE)
        A_0 = self.surface.fraction(p)
        local = p / A_0
        film = ParticleFilm(self)
        closed = film(np.zeros(1))[0]
        touch = local >= closed[0]
        gap = np.zeros_like(p)
        if not np.all(touch):
            # in ln(x_max − g), in which small and large gaps are alike
            high = math.log(film.top)
            start = np.full(int((~touch).sum()), high - 40.0)
            root = find_root(
                lambda s, wanted: film(film.top - np.exp(s))[:, 0] - wanted,
                (start, np.full_like(start, high)),
                args=(local[~touch],),
                tolerances={"xatol": 1e-15, "xrtol": 1e-15, "fatol": 0.0, "frtol": 0.0},
            )
            gap[~touch] = film.top - np.exp(root.x)
        load, area, footprint = film(gap).T
        share = np.where(touch, load / local, 1.0)
        asperities = np.where(touch, A_0 * (1 - footprint), 0.0)

        def in_shape(values: Array) -> Array:
            return values.reshape(pressures.shape) if pressures.ndim else values[0].item()

        return MultiscaleState(
            pressure=in_shape(p),
            A_0=in_shape(A_0),
            local_pressure=in_shape(local),
            gap=in_shape(gap),
            A_particles=in_shape(A_0 * area),
            A_asperities=in_shape(asperities),
            particle_load_share=in_shape(share),
            warnings=self._warnings(p),
        )

    def _warnings(self, p: Array) -> tuple[str, ...]:
        if not isinstance(self.surface, Stack):
            return ()
        reports = [self.surface.convergence(float(end)) for end in (p.min(), p.max())]
        bad = [report.message for report in reports if not report.converged]
        return (f"stack of sinusoids: {bad[0]}",) if bad else ()
