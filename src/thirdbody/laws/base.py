r"""What a contact law is.

A law says what one contact does. For an asperity it is stated in reduced form: with the
interference of first yield ω_1, the interference :math:`y = \omega/\omega_1`,

.. math:: F = \pi R\,\omega_1 H\, f(y), \qquad A = \pi R\,\omega_1\, a(y),

as a sequence of smooth branches between the `breakpoints`. Everything else (contact radius,
mean pressure, stiffness, energy, regime, sums over a population) follows from the branches,
so a new law is one file with its equations.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

import numpy as np

from ..errors import InvalidValue
from ..numerics.quadrature import panel_rule
from ..quantities.value import Value

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ..populations.materials import Material, MaterialPair
    from ..populations.particles import Particles
    from ..populations.roughness import Roughness
    from .spots import ParticleSpots

    Array = NDArray[np.float64]
    Number = float | Array

__all__ = ["REGIMES", "AbstractAsperityLaw", "AbstractParticleLaw", "Branch", "Jump", "Law"]

REGIMES = ("elastic", "elastoplastic", "plastic")
NO_SPOTS = (
    "this particle law knows loads and areas of all particles together, not how deep one of them "
    "sits; outputs need particle.Series or particle.Flakes"
)


class Branch(NamedTuple):
    """One smooth piece of a law, in reduced form.

    Examples
    --------
    Hertz, with y = ω/ω_1 and the pressure 0.4 H at first yield:

    >>> elastic = Branch("elastic", lambda y: 0.4 * y**1.5, lambda y: y, lambda y: 0.6 * y**0.5)
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
    """What the published formulas step by at a breakpoint: upper over lower branch, less one [1].

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


class Law(Value):
    """What every law, for asperities or particles, says of itself."""

    __slots__ = ()

    name: ClassVar[str]
    """The word that study files use."""
    title: ClassVar[str]
    year: ClassVar[int]
    citation: ClassVar[str]
    doi: ClassVar[str] = ""
    provenance: ClassVar[str]
    """seen in the source, derived, recalled, or reconstructed"""
    valid_range: ClassVar[str]
    scale_free: ClassVar[bool] = True
    """F(λω; λR) = λ²F: the law has no length of its own, as a coating or adhesion gives it."""

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if "name" in vars(cls):
            cls.registry[cls.name] = cls

    registry: ClassVar[dict[str, type[Law]]] = {}
    """Every law of one kind by name: a law enters it when its module is imported."""


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
    def reduced(self, quantity: str, y: ArrayLike) -> Array:
        """f(y), a(y) or df/dy (``"force"``, ``"area"``, ``"stiffness"``); zero without contact."""
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
    def _scaled(
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
        f, omega_1 = self._scaled(lambda law, y: law.reduced("force", y), omega, R, E_star, H)
        return np.pi * R * omega_1 * H * f

    def area(self, omega: ArrayLike, *, R: Number, E_star: Number, H: Number) -> Array:
        """Contact area A [m²] of one contact; arguments as in `force`."""
        a, omega_1 = self._scaled(lambda law, y: law.reduced("area", y), omega, R, E_star, H)
        return np.pi * R * omega_1 * a

    def stiffness(self, omega: ArrayLike, *, R: Number, E_star: Number, H: Number) -> Array:
        """dF/dω [N/m] of one contact; arguments as in `force`."""
        slope, _ = self._scaled(lambda law, y: law.reduced("stiffness", y), omega, R, E_star, H)
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
        work, omega_1 = self._scaled(AbstractAsperityLaw._reduced_work, omega, R, E_star, H)
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
        return self._scaled(AbstractAsperityLaw._reduced_regime, omega, R, E_star, H)[0]

    def _reduced_regime(self, y: Array) -> NDArray[np.str_]:
        names = np.array([branch.regime for branch in self.branches])
        which = np.searchsorted(self.breakpoints, y, side="right")
        return np.where(y > self.start, names[which], "none")


class AbstractParticleLaw(Law):
    """What a particle caught between two surfaces does.

    `response` binds the law to an interface and returns a `ParticleResponse`.

    Examples
    --------
    >>> import thirdbody as tb
    >>> sorted(tb.particle.REGISTRY)
    ['flakes', 'horng2022', 'series']
    """

    __slots__ = ()
    registry: ClassVar[dict[str, type[Law]]] = {}

    @property
    def centre(self) -> float:
        """Mean asperity height in the coordinate of d, in units of σ."""
        return 0.0

    @abstractmethod
    def response(
        self, surfaces: MaterialPair, roughness: Roughness, particles: Particles
    ) -> ParticleResponse:
        """The particles' answer as a function of d."""

    def probe(self, eps: Array, *, surfaces: MaterialPair, particle: Material) -> ParticleSpots:
        """Particles of unit size squeezed by ε, one a row (N, 1): what one particle does."""
        raise InvalidValue(NO_SPOTS)

    def warnings(
        self, surfaces: MaterialPair, roughness: Roughness, particles: Particles
    ) -> list[str]:
        """Where this interface leaves the law's range, one sentence each."""
        return []


class ParticleResponse(ABC):
    """Particles between two surfaces, per nominal area, as functions of the separation d [m].

    Made by `AbstractParticleLaw.response`.

    Examples
    --------
    >>> import numpy as np
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> dust = tb.Particles(material=tb.materials["SiO2"], areal_density=1e11,
    ...                     diameter=tb.Monodisperse(mean=300e-9))
    >>> made = tb.particle.Series(seat="plane").response(
    ...     tb.MaterialPair(steel, steel), tb.Roughness(sigma=100e-9, R=2.8e-6), dust)
    >>> f"{made.reach:.1e}", f"{made.fields(np.array([250e-9]))['F_sa'][0]:.3g} Pa"
    ('3.0e-07', '7.49e+06 Pa')
    """

    reach: float
    """Separation [m] above which no particle is loaded (or the load is negligible)."""
    monotone: bool = True
    """The load falls with d everywhere."""
    resolution: float = np.inf
    """Step of d [m] that resolves the load, where it is not monotone."""
    marks: Array | tuple[float, ...] = ()
    """Separations d [m] between which load and shadow are smooth, where the law knows them."""

    @abstractmethod
    def load(self, d: Array) -> tuple[Array, Array]:
        """Pressure F_sa and shadow ς with first and second derivative: two arrays (N, 3)."""

    @abstractmethod
    def fields(self, d: Array) -> dict[str, Array]:
        """F_sa [Pa], A_e, A_ep, A_p on surface 1, A_sa2 on surface 2, and the shadow ς."""

    def spots(self, d: Array, splits: Sequence[float] = ()) -> list[ParticleSpots]:
        """Every loaded particle at d (N,), in groups.

        Parameters
        ----------
        d : array (N,)
        splits : sequence of float, optional
            Squeezes over diameter ε where what is asked of a particle changes its formula.
        """
        raise InvalidValue(NO_SPOTS)


class ParticlesTogether(ParticleResponse):
    """Several populations side by side: loads, areas and shadows add."""

    def __init__(self, responses: Sequence[ParticleResponse]):
        self.responses = responses
        self.reach = max(each.reach for each in responses)
        self.monotone = all(each.monotone for each in responses)
        self.resolution = min(each.resolution for each in responses)
        self.marks = np.concatenate([np.asarray(each.marks, float) for each in responses])

    def load(self, d: Array) -> tuple[Array, Array]:
        loads, shadows = zip(*(each.load(d) for each in self.responses), strict=True)
        return np.sum(loads, axis=0), np.sum(shadows, axis=0)

    def fields(self, d: Array) -> dict[str, Array]:
        parts = [each.fields(d) for each in self.responses]
        return {name: np.sum([part[name] for part in parts], axis=0) for name in parts[0]}
