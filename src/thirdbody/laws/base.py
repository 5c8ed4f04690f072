r"""What a contact law is.

A law says what one contact does. For an asperity it is stated in reduced form: with the
interference of first yield ω_1, the interference :math:`y = \omega/\omega_1`,

.. math:: F = \pi R\,\omega_1 H\, f(y), \qquad A = \pi R\,\omega_1\, a(y),

as a sequence of smooth branches between the `breakpoints`. Everything else (contact radius,
mean pressure, stiffness, energy, regime, sums over a population) follows from the branches,
so a new law is one file with its equations. For a particle it is stated for unit size, as load,
areas and indentations against the squeeze ε; sums over sizes and seats follow.
"""

from __future__ import annotations

import itertools
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple, Self, TypeVar, get_args

import numpy as np

from ..errors import Advice, InvalidValue, Mistake, Problem
from ..numerics.quadrature import panel_rule
from ..populations.shape import Sphere
from ..quantities.arguments import need_one
from ..quantities.carried import takes_units
from ..quantities.named import Named
from ..quantities.say import value_of
from ..quantities.value import choice, quantity
from .spots import ParticleSpots, of_both_sides

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ..populations.materials import Material, MaterialPair
    from ..populations.particles import Particles
    from ..populations.roughness import Roughness
    from ..populations.shape import Angular, Shape

    Array = NDArray[np.float64]
    Number = float | Array
    Kept = TypeVar("Kept", bound=np.generic)

__all__ = [
    "COLUMNS",
    "FLAKES",
    "HERMITE",
    "KINDS",
    "REGIMES",
    "SERIES",
    "AbstractAsperityLaw",
    "AbstractParticleLaw",
    "Branch",
    "Jump",
    "Law",
    "OneParticle",
    "Seat",
    "SeatedLaw",
    "Squeezed",
]

Reduced = Literal["force", "area", "stiffness"]
"""What a law gives in reduced form."""
Seat = Literal["rough", "plane", "offset"]
"""Where particles rest: on the rough surface, on its mean plane, or on a plane above that."""
SERIES = Advice("particle.Series", 'particle_law.name = "series"')
FLAKES = Advice("particle.Flakes", 'particle_law.name = "flakes"')
HERMITE = Advice("Hermite()", '"hermite"')
"""Laws that are advised, in words of Python and of study files."""

REGIMES = ("elastic", "elastoplastic", "plastic")
COLUMNS = ("force", "elastic", "elastoplastic", "plastic", "second", "footprint", "projected")
"""What one particle contributes: load, area on surface 1 by regime, area on surface 2, larger of
the two areas, projected area."""
KINDS = (0, 1, 1, 1, 1, 1, 1)
"""Which columns are measured against each other: load, areas."""


class Branch(NamedTuple):
    """One smooth piece of a law, in reduced form.

    Examples
    --------
    Hertz, with y = ω/ω_1 and the pressure 0.4 H at first yield:

    >>> import thirdbody as tb
    >>> elastic = tb.asperity.Branch(
    ...     "elastic", lambda y: 0.4 * y**1.5, lambda y: y, lambda y: 0.6 * y**0.5
    ... )
    >>> elastic.force(4.0) / elastic.area(4.0)
    0.8
    """

    regime: str
    """One of `REGIMES`."""
    force: Callable[[Array], Array]
    """f(y) = F/(πRω_1 H)"""
    area: Callable[[Array], Array]
    """a(y) = A/(πRω_1)"""
    stiffness: Callable[[Array], Array]
    """df/dy"""


class Jump(NamedTuple):
    """Steps of the published formulas at a breakpoint: upper over lower branch, less one [1].

    Examples
    --------
    >>> import thirdbody as tb
    >>> round(tb.asperity.KE(K=0.6).jumps[1].force, 6)
    0.03
    """

    force: float = 0.0
    """Of F."""
    area: float = 0.0
    """Of A."""
    stiffness: float = 0.0
    """Of dF/dω."""


class Law(Named):
    """What every law, for asperities or particles, says of itself."""

    __slots__ = ()

    title: ClassVar[str]
    year: ClassVar[int]
    citation: ClassVar[str]
    doi: ClassVar[str] = ""
    provenance: ClassVar[str]
    """seen in the source, derived, recalled, or reconstructed"""
    valid_range: ClassVar[str]
    scale_free: ClassVar[bool] = True
    """F(λω; λR) = λ²F: the law has no length of its own, as a coating or adhesion gives it."""


class AbstractAsperityLaw(Law):
    """A frictionless contact of one tip of radius R with a flat.

    A subclass is a frozen, slotted, keyword-only dataclass. It gives `yield_interference`,
    `breakpoints` and `branches` (one more branch than breakpoints), the class data of `Law`,
    where the published formulas do not join, `jumps`, and, where their range ends, `valid_to`
    and `beyond`. The book's page "Add a law" writes one out.

    Examples
    --------
    >>> import thirdbody as tb
    >>> law, tip = tb.asperity.ZMC(), dict(R=2.8e-6, E_star=115e9, H=5e9)
    >>> omega_1 = law.yield_interference(**tip)
    >>> round(float(law.mean_pressure(omega_1, **tip)) / 5e9, 12)  # first yield at k H
    0.4
    """

    __slots__ = ()
    registry: ClassVar[dict[str, type[Law]]] = {}
    of_surface: ClassVar[bool] = False
    """It says what a rough surface does as a whole; of one tip it borrows what another law says."""
    bandwidths: ClassVar[tuple[float, float]] = (0.0, math.inf)
    """Least and largest α that the law knows [1]."""
    beyond: ClassVar[str] = ""
    """What an asperity is past `valid_to`, to follow "x % of the asperities' area is"."""

    @property
    def start(self) -> float:
        """Reduced interference at which contact begins; negative where adhesion stretches it."""
        return 0.0

    @property
    def onset(self) -> float:
        """Reduced load f at first contact, y just above `start`: not zero where adhesion pulls.

        A sum over heights has it in its slope, as it has the jumps: with J = πRω_1H f,
        dF/dd = −η[∫F_1′φ + Jφ(d + ω_start) + ...].
        """
        return 0.0

    @property
    def jumps(self) -> dict[float, Jump]:
        """Where the published formulas do not join: {breakpoint: `Jump`}, all others are smooth.

        Written down from the formulas, not computed from `branches`: the tests hold one against
        the other.
        """
        return {}

    @property
    def valid_to(self) -> float:
        """Reduced interference y up to which the law is meant; `beyond` says what lies there."""
        return math.inf

    def problems(
        self, roughness: Roughness, particle_laws: Sequence[AbstractParticleLaw]
    ) -> list[str]:
        """Reasons why this law does not know such a surface, or such particles on it."""
        return []

    def bound(self, *, R: Number, E_star: Number, H: Number, nu: float | None = None) -> Self:
        """The law with what its formulas need to know of the contact; itself by default.

        A law whose reduced form holds a constant of the contact (Poisson ratio ν of the softer
        body, yield strain, a length over R) keeps it as an optional field and returns a copy
        with the field filled.
        """
        return self

    @abstractmethod
    def yield_interference(self, *, R: Number, E_star: Number, H: Number) -> Number:
        """Interference of first yield ω_1 [m]."""

    @property
    @abstractmethod
    def breakpoints(self) -> tuple[float, ...]:
        """Values of y = ω/ω_1 where the formula changes; the upper branch holds there."""

    @property
    @abstractmethod
    def branches(self) -> tuple[Branch, ...]:
        """The formulas between the breakpoints, from zero interference upward."""

    # ---------------------------------------------------------------- reduced form
    def reduced(self, quantity: Reduced, y: ArrayLike) -> Array:
        """f(y), a(y) or df/dy (``"force"``, ``"area"``, ``"stiffness"``); zero without contact."""
        need_one("quantity", quantity, *get_args(Reduced))
        y = np.asarray(y, dtype=float)
        out = np.zeros_like(y)
        start = self.start
        which = np.searchsorted(self.breakpoints, y, side="right")
        for i, branch in enumerate(self.branches):
            here = (which == i) & (y > start)
            if np.any(here):
                out[here] = getattr(branch, quantity)(y[here])
        return out

    # ---------------------------------------------------------------- one contact
    def _evaluate_bound(
        self,
        of: Callable[[Self, Array], Any],
        omega: ArrayLike,
        R: Number,
        E_star: Number,
        H: Number,
    ) -> tuple[Any, Number]:
        """``of(law, ω/ω_1)`` of the bound law, and ω_1; contacts that bind alike go together."""
        numbers = np.ndim(R) == np.ndim(E_star) == np.ndim(H) == 0
        if numbers or type(self).bound is AbstractAsperityLaw.bound:
            law = self.bound(R=R, E_star=E_star, H=H)
            omega_1 = law.yield_interference(R=R, E_star=E_star, H=H)
            return of(law, np.asarray(omega, dtype=float) / omega_1), omega_1
        every = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (omega, R, E_star, H)))
        flat, *body = (values.ravel() for values in every)
        cases, which = np.unique(np.stack(body), axis=1, return_inverse=True)
        groups: dict[Self, list[int]] = {}
        for i, (r, e, h) in enumerate(cases.T.tolist()):
            groups.setdefault(self.bound(R=r, E_star=e, H=h), []).append(i)
        scale, out = np.empty(flat.shape), np.empty(flat.shape)
        for law, members in groups.items():
            here = np.isin(which.ravel(), members)
            r, e, h = (values[here] for values in body)
            scale[here] = law.yield_interference(R=r, E_star=e, H=h)
            values = of(law, flat[here] / scale[here])
            out = out.astype(values.dtype, copy=False)
            out[here] = values
        return out.reshape(every[0].shape), scale.reshape(every[0].shape)

    def force(self, omega: ArrayLike, *, R: Number, E_star: Number, H: Number) -> Array:
        """Load F [N] of one contact.

        Parameters
        ----------
        omega : array_like
            Interference ω [m]; zero or negative gives zero.
        R, E_star, H : float or array
            Tip radius [m], contact modulus [Pa], hardness of the softer body [Pa]; arrays are
            broadcast with ``omega``.
        """
        f, omega_1 = self._evaluate_bound(
            lambda law, y: law.reduced("force", y), omega, R, E_star, H
        )
        return np.pi * R * omega_1 * H * f

    def area(self, omega: ArrayLike, *, R: Number, E_star: Number, H: Number) -> Array:
        """Contact area A [m²] of one contact; arguments as in `force`."""
        a, omega_1 = self._evaluate_bound(
            lambda law, y: law.reduced("area", y), omega, R, E_star, H
        )
        return np.pi * R * omega_1 * a

    def stiffness(self, omega: ArrayLike, *, R: Number, E_star: Number, H: Number) -> Array:
        """dF/dω [N/m] of one contact; arguments as in `force`."""
        slope, _ = self._evaluate_bound(
            lambda law, y: law.reduced("stiffness", y), omega, R, E_star, H
        )
        return np.pi * R * H * slope

    def contact_radius(self, omega: ArrayLike, *, R: Number, E_star: Number, H: Number) -> Array:
        """a = √(A/π) [m] of one contact; arguments as in `force`."""
        return np.sqrt(self.area(omega, R=R, E_star=E_star, H=H) / np.pi)

    def mean_pressure(self, omega: ArrayLike, *, R: Number, E_star: Number, H: Number) -> Array:
        """p = F/A [Pa] of one contact, zero without contact; arguments as in `force`."""
        area = self.area(omega, R=R, E_star=E_star, H=H)
        force = self.force(omega, R=R, E_star=E_star, H=H)
        return np.divide(force, area, out=np.zeros_like(force), where=area > 0)

    def energy(self, omega: ArrayLike, *, R: Number, E_star: Number, H: Number) -> Array:
        """Work ∫F dω [J] done in one loading to ω; arguments as in `force`."""
        work, omega_1 = self._evaluate_bound(AbstractAsperityLaw._reduced_work, omega, R, E_star, H)
        return np.pi * R * omega_1**2 * H * work

    def _reduced_work(self, y: Array) -> Array:
        """∫f dy from 0."""
        y = np.maximum(y, 0.0)
        splits = np.array([0.0, *self.breakpoints])
        edges = np.concatenate([np.minimum(y[..., None], splits), y[..., None]], axis=-1)
        # panels in √y: every law starts like y^(3/2)
        root, weight = panel_rule(np.sqrt(edges), 40)
        return np.sum(weight * 2 * root * self.reduced("force", root**2), axis=-1)

    def regime(self, omega: ArrayLike, *, R: Number, E_star: Number, H: Number) -> NDArray[np.str_]:
        """One of `REGIMES`, or ``"none"`` without contact; arguments as in `force`."""
        return self._evaluate_bound(AbstractAsperityLaw._reduced_regime, omega, R, E_star, H)[0]

    def _reduced_regime(self, y: Array) -> NDArray[np.str_]:
        names = np.array([branch.regime for branch in self.branches])
        which = np.searchsorted(self.breakpoints, y, side="right")
        return np.where(y > self.start, names[which], "none")


class Squeezed(NamedTuple):
    """Particles of unit size, each squeezed by some ε: arrays (N,), sides 1 and 2 in pairs."""

    load: Array
    """Load over x² [Pa]; both sides carry it."""
    depths: tuple[Array, Array]
    """Indentations δ_1 and δ_2 over x, ε in sum."""
    areas: tuple[Array, Array]
    """Contact areas over x² [1]."""


class OneParticle(ABC):
    """One particle of unit size between two sides, as a function of its squeeze ε = δ/x.

    A particle of size x has x² times the load and the areas. The load must not fall with ε.
    Equal particles share the tables of their sums; a frozen dataclass knows which are equal.

    Attributes
    ----------
    kinks : sequence of float
        Increasing ε > 0 at which a formula changes; beyond the last, load and areas are constant.
    onset : (float, float), optional
        Powers of ε with which load and areas set in, whole or half; smaller ones do no harm.
    breadth : float, optional
        Projected area over πx²/4 [1].
    tip_radius : float, optional
        Radius of the contacting tips over x [1].
    yields : (float, float)
        Indentation of first yield over x, on each side [1].
    hardness : (float, float)
        Of the softer body of each side [Pa].
    shape : Angular, optional
        Of particles that are not round.
    knows_sink : (bool, bool), optional
        Whether the law says of each side how deep the particle sinks into the surface, and how
        much of the indentation is its own squash.
    equal : bool, optional
        Whether both sides are alike in everything.
    """

    kinks: Sequence[float] | Array
    onset: tuple[float, float] = (1.0, 1.0)
    breadth: float = 1.0
    tip_radius: float = 0.5
    yields: tuple[float, float]
    hardness: tuple[float, float]
    shape: Angular | None = None
    knows_sink: tuple[bool, bool] = (False, False)
    equal: bool = False

    @abstractmethod
    @takes_units
    def at(self, eps: Array) -> Squeezed:
        """What particles squeezed by ε (N,) carry; of ε ≤ 0 no account is taken."""

    @abstractmethod
    @takes_units
    def regime(self, side: int, depth: Array) -> NDArray[np.intp]:
        """Index into `REGIMES` of side 0 or 1 indented by depth over x (N,)."""

    @property
    def sink_bends(self) -> Sequence[float]:
        """Squeezes ε at which the depth of an impression bends, between `kinks`."""
        return ()

    def sinks(self, depths: tuple[Array, Array]) -> tuple[Array, Array]:
        """Depths of the impressions in the surfaces, of indentations (N,); all over x."""
        return depths

    @cached_property
    def panels(self) -> Array:
        """The kinks, and more ε between kinks that lie far apart."""
        splits = [np.asarray(self.kinks[:1])]
        for a, b in itertools.pairwise(self.kinks):
            splits.append(np.geomspace(a, b, max(2, math.ceil(math.log(b / a, 4.0)) + 1))[1:])
        return np.concatenate(splits)

    def __call__(self, eps: Array) -> Array:
        """The seven `COLUMNS` per x² at ε: (N, 7)."""
        eps = np.asarray(eps, dtype=float)
        load, depths, (one, two) = self.at(eps)
        regime = self.regime(0, depths[0])
        out = np.empty((len(eps), len(COLUMNS)))
        out[:, 0] = load
        for i in range(len(REGIMES)):
            out[:, 1 + i] = np.where(regime == i, one, 0.0)
        out[:, 4] = two
        out[:, 5] = np.maximum(one, two)
        out[:, 6] = 0.25 * math.pi * self.breadth
        out[eps <= 0] = 0.0
        return out

    @takes_units
    def spots(self, x: Array, delta: Array, *, share: Array | None, number: Array) -> ParticleSpots:
        """Particles of sizes x squeezed by δ (M, n), so many of each."""
        eps = np.divide(delta, x, out=np.zeros_like(x), where=x > 0)
        first, place = _without_repeats(number, x.shape)
        eps = eps[first]
        unit_state = self.at(eps)

        def of_each(values: NDArray[Kept]) -> NDArray[Kept]:
            return values[place]

        depths = of_both_sides(unit_state.depths, lambda depth: x * of_each(depth))
        sinks = depths
        if any(self.knows_sink):
            sinks = of_both_sides(self.sinks(unit_state.depths), lambda sink: x * of_each(sink))
        one, two = unit_state.depths
        regime = of_each(self.regime(0, one))
        return ParticleSpots(
            share=share,
            number=number,
            load=x**2 * of_each(np.where(eps > 0, unit_state.load, 0.0)),
            x=x,
            radius=self.tip_radius * x,
            depths=depths,
            sinks=sinks,
            areas=of_both_sides(
                unit_state.areas, lambda area: x**2 * of_each(np.where(eps > 0, area, 0))
            ),
            regimes=(regime, regime if self.equal else of_each(self.regime(1, two))),
            yields=self.yields,
            hardness=self.hardness,
            shape=self.shape,
            knows_sink=self.knows_sink,
        )


def _without_repeats(
    number: Array, shape: tuple[int, ...]
) -> tuple[NDArray[np.bool_], NDArray[np.intp]]:
    """Which nodes of rows (M, n) are no repeats of the last that stands for particles.

    And where among these the values of each node are.
    """
    used = np.broadcast_to(number > 0, shape)
    last = np.argmax(used[:, ::-1], axis=1)[:, None] if used.size else np.zeros((len(used), 1))
    first = np.arange(shape[1]) < shape[1] - last
    return first, (np.cumsum(first) - 1).reshape(shape)


class AbstractParticleLaw(Law):
    """What a particle caught between two surfaces does.

    A subclass says what one particle does (`one`); `thirdbody.contact.particle_sums` sums over
    sizes and seats. Laws whose particles rest somewhere derive from `SeatedLaw`. The book's page
    "Add a law" writes one out.

    Examples
    --------
    >>> import thirdbody as tb
    >>> sorted(tb.particle.REGISTRY)
    ['flakes', 'horng2022', 'series']
    """

    __slots__ = ()
    registry: ClassVar[dict[str, type[Law]]] = {}
    breakable: ClassVar[bool] = False
    """Its particles are round: their strength has a meaning."""
    knows_each: ClassVar[bool] = True
    """It says what one particle does, which outputs need; if not, only what all do together."""

    @property
    def centre(self) -> float:
        """Mean asperity height in the coordinate of d, in units of σ."""
        return 0.0

    @abstractmethod
    def one(self, *, surfaces: MaterialPair, particle: Material) -> OneParticle:
        """One particle of unit size of this material between these surfaces."""

    def of_shape(self, shape: Shape) -> AbstractParticleLaw:
        """This law for particles of a shape; most laws are written for a `Sphere`."""
        if isinstance(shape, Sphere):
            return self
        rule = f": particles of the law {self.name} have a shape of their own"
        hint = "use " + SERIES + ", or remove shape"
        raise InvalidValue(Problem("shape", rule, hint=hint, owner="Particles", code=Mistake.CLASH))

    def single(
        self, x: ArrayLike, gap: ArrayLike, *, surfaces: MaterialPair, particle: Material
    ) -> dict[str, Array]:
        """One particle between two flats.

        Parameters
        ----------
        x, gap : array_like
            Diameter and gap between the flats [m].
        surfaces : MaterialPair
        particle : Material

        Returns
        -------
        dict
            ``force`` [N], ``area_1``, ``area_2`` [m²], ``delta_1``, ``delta_2`` [m], and
            ``regime`` on surface 1.
        """
        x, gap = np.broadcast_arrays(np.asarray(x, float), np.asarray(gap, float))
        eps = np.maximum(1 - gap / x, 0.0)
        unit = self.probe(eps.ravel(), surfaces=surfaces, particle=particle)
        names = np.array(REGIMES)[unit.regimes[0]].reshape(x.shape)
        return {
            "force": unit.load.reshape(x.shape) * x**2,
            "area_1": unit.areas[0].reshape(x.shape) * x**2,
            "area_2": unit.areas[1].reshape(x.shape) * x**2,
            "delta_1": x * unit.depths[0].reshape(x.shape),
            "delta_2": x * unit.depths[1].reshape(x.shape),
            "regime": np.where(eps > 0, names, "none"),
        }

    def probe(self, eps: Array, *, surfaces: MaterialPair, particle: Material) -> ParticleSpots:
        """Spots of particles of unit size squeezed by ε, one a row (N, 1)."""
        ones = np.ones((len(eps), 1))
        one = self.one(surfaces=surfaces, particle=particle)
        return one.spots(ones, eps[:, None], share=None, number=ones)

    def describe_jam(self, coverage: float) -> str:
        """Note on particles that would cover this part of the area, 1 or more."""
        return (
            f"particles of the law {self.name} would cover {coverage:.3g} of the nominal area and "
            "it must stay below 1"
        )

    def warnings(
        self, surfaces: MaterialPair, roughness: Roughness, particles: Particles
    ) -> list[str]:
        """Notes on interfaces outside the law's range, one sentence each."""
        return []


@dataclass(frozen=True, slots=True, kw_only=True)
class SeatedLaw(AbstractParticleLaw):
    """Base of laws whose particles rest on a seat: the response of one particle, and seat options.

    Parameters
    ----------
    seat : {"rough", "plane", "offset"}, optional
        Where particles rest, as in `thirdbody.particle.Series`.
    h_0 : float, optional
        Height of the seat above the mean asperity plane [m], for ``offset``.
    zeta_mean, zeta_std : float, optional
        Mean and width of the seat heights in units of σ [1], for ``rough``.
    shadow : {"footprint", "projected", "covered", "none"}, optional
        The share of nominal area in which loaded particles keep asperities apart.
    """

    seat: Seat = choice("where particles rest", default="rough")
    h_0: float = quantity("h_0", "m", "seat height above the mean asperity plane", default=0.0)
    zeta_mean: float = quantity("m_ζ", "1", "mean seat height over σ", default=0.0)
    zeta_std: float = quantity("s_ζ", "1", "width of seat heights over σ", default=1.0, gt=0)
    shadow: Literal["footprint", "projected", "covered", "none"] = choice(
        "area in which particles keep asperities apart", default="footprint"
    )

    def _problems(self) -> list[str]:
        out: list[str] = []
        if self.h_0 != 0 and self.seat != "offset":
            out.append(
                Problem(
                    "h_0",
                    f"has no meaning with seat = {self.seat!r}; set seat = 'offset'",
                    f"{self.h_0:g}",
                    code=Mistake.IDLE,
                )
            )
        if self.seat != "rough" and (self.zeta_mean, self.zeta_std) != (0.0, 1.0):
            out.append(
                Problem(
                    "zeta_mean",
                    f"and zeta_std need seat = 'rough', not {self.seat!r}",
                    code=Mistake.IDLE,
                )
            )
        return out

    def seat_offset(self, roughness: Roughness) -> float:
        """Mean gap minus d [m]."""
        if self.seat == "rough":
            return roughness.y_s - self.zeta_mean * roughness.sigma
        return -self.h_0

    def warnings(
        self, surfaces: MaterialPair, roughness: Roughness, particles: Particles
    ) -> list[str]:
        out = []
        one = self.one(surfaces=surfaces, particle=particles.material)
        # πd²/4 of a particle of size x is breadth·πx²/4, and its radius d/2
        radius = particles.diameter.mean_diameter * math.sqrt(0.25 * one.breadth)
        if self.seat == "rough" and radius > 0.5 * roughness.R:
            out.append(
                f"mean particle radius {value_of(radius, 'm', 3)} is not small against the "
                "asperity "
                f"radius R = {value_of(roughness.R, 'm', 3)}: the rough seat takes the surface "
                "under a particle as flat"
            )
        return out
