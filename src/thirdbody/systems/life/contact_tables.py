r"""A contact as tables over the gap: any mixture of particles at the price of a product.

At a given gap a contact is affine in its particles: with η_km per area of class k and material m

.. math:: p(d) = F_{ss}(d)\,\Big(1-\sum_{km}\eta_{km} s_{km}(d)\Big) + \sum_{km}\eta_{km} f_{km}(d)

and every volume, count, area and force is a sum over spots alike. So each class and material has
one column of numbers over the gap, and a history costs a scalar root. Asperities are tabulated
over d/σ, particles over the mean gap under them; both over ln σ where σ moves.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...contact.asperity_sums import SEARCHED, asperity_sum
from ...contact.field_sums import FieldSum
from ...errors import InvalidValue, Mistake, NoEquilibrium
from ...laws.base import SeatedLaw
from ...numerics.chebyshev import chebyshev_transform
from ...quantities.carried import takes_units
from .particle_curves import (
    POWERS,
    REACH,
    ParticleCurve,
    SurvivalCurve,
    local_gaps,
    particle_curve,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...contact.contact import Contact
    from ...populations.materials import Material
    from ...populations.roughness import Roughness
    from ...populations.strength import WeibullStrength
    from .size_classes import SizeClasses

    Array = NDArray[np.float64]

__all__ = ["ContactTables", "Kind", "Pressed", "contact_tables", "scale_roughness"]

NODES, SIGMA_NODES = 16, 12
"""Chebyshev nodes of a panel over the gap, and over ln σ."""
PANEL = 4.0
"""Width of a panel over the mean gap, in the smallest σ: nothing changes faster."""
DECLARED = 1e-5
"""Relative error that tables may have, of the largest value of a quantity on a panel."""
DEEPEST_HALVING = 3
NOTHING = 1e-7
"""Part of the largest value of a quantity that needs no relative accuracy of its own."""
NAMES = tuple(POWERS)
FIRST = ("load", "shadow")
"""What the balance of the load needs."""
SPOTS = ("force", "elastic", "elastoplastic", "plastic", "worn", "shear", "plough")
"""What is tabulated of asperities per area: load [Pa], areas by regime [1], worn volume per sliding
length [1], and forces of shear and ploughing [Pa]."""


@dataclass(frozen=True, kw_only=True)
class Kind:
    """A kind of particles in a history: a material, and its strength if they break."""

    name: str
    material: Material
    strength: WeibullStrength | None = None


class Pressed(NamedTuple):
    """A contact at one gap: what one particle of each kind and class adds, and the asperities."""

    d: float
    """Separation [m]."""
    sigma: float
    """Roughness [m]."""
    per_particle: Array
    """(kinds, classes, quantities of `POWERS`)."""
    asperities: dict[str, float]
    """`SPOTS`, without the shadow of particles."""
    bare: float
    """Part of the area that is out of the shadow of particles [1]."""


@takes_units
def scale_roughness(roughness: Roughness, sigma: float) -> Roughness:
    """A surface with its heights scaled at fixed wavelengths: R ∝ 1/σ, η stays.

    Parameters
    ----------
    roughness : Roughness
    sigma : float
        The new σ [m].
    """
    if sigma == roughness.sigma:
        return roughness
    return roughness.replace(sigma=sigma, R=roughness.R * roughness.sigma / sigma)


class PanelTable:
    """A vector function of one place and of ln σ, tabulated panel by panel where it is asked.

    Parameters
    ----------
    function : callable
        Maps places (N,) and several σ [m] (S,) to (N, S, C).
    edges : array
        Increasing; the panels before any is halved.
    span : (float, float)
        σ from and to [m]; equal ends for one σ.
    largest : array (C,)
        The largest value of each column anywhere: less than `NOTHING` of it needs no digits.
    """

    def __init__(
        self,
        function: Callable[[Array, Array], Array],
        edges: Array,
        span: tuple[float, float],
        largest: Array,
    ):
        self.function, self.span, self.largest = function, span, largest
        self.edges = list(map(float, edges))
        self.depth = [0] * (len(self.edges) - 1)
        self.panels: dict[tuple[float, float], Array] = {}
        self.error = 0.0
        """The largest relative error that was measured."""
        self.built = 0
        moves = span[1] > span[0]
        count = SIGMA_NODES if moves else 1
        self.nodes, self.transform = chebyshev_transform(NODES)
        self.sigma_nodes, self.sigma_transform = chebyshev_transform(count)
        middle, half = self._log_span
        self.sigmas = np.exp(middle + half * self.sigma_nodes)
        if not moves:
            self.sigmas = np.array([span[0]])

    @property
    def _log_span(self) -> tuple[float, float]:
        low, high = np.log(self.span)
        return 0.5 * (low + high), 0.5 * (high - low)

    def basis(self, place: float, sigma: float) -> tuple[Array, Array, Array]:
        """Coefficients of the panel (n·s, C), the products there, and their slope in the place."""
        place = min(max(place, self.edges[0]), self.edges[-1])
        low, high, coefficients = self._panel(place)
        half = 0.5 * (high - low)
        t = min(max((place - 0.5 * (low + high)) / half, -1.0), 1.0)
        values, slopes = _chebyshev_and_slope(t, NODES)
        over = np.ones(1)
        if len(self.sigmas) > 1:
            middle, wide = self._log_span
            s = min(max((math.log(sigma) - middle) / wide, -1.0), 1.0)
            over = _chebyshev_and_slope(s, SIGMA_NODES)[0]
        return (
            coefficients,
            np.multiply.outer(values, over).ravel(),
            np.multiply.outer(slopes / half, over).ravel(),
        )

    def __call__(self, place: float, sigma: float) -> Array:
        """All columns at one place: (C,)."""
        coefficients, values, _ = self.basis(place, sigma)
        return values @ coefficients

    def _panel(self, place: float) -> tuple[float, float, Array]:
        while True:
            i = min(max(bisect_right(self.edges, place) - 1, 0), len(self.edges) - 2)
            low, high = self.edges[i], self.edges[i + 1]
            if (panel := self.panels.get((low, high))) is not None:
                return low, high, panel
            made, error = self._make(low, high)
            if error <= DECLARED or self.depth[i] >= DEEPEST_HALVING:
                self.panels[low, high] = made
                self.error = max(self.error, error)
                continue
            self.edges.insert(i + 1, 0.5 * (low + high))
            self.depth[i : i + 1] = [self.depth[i] + 1] * 2

    def _make(self, low: float, high: float) -> tuple[Array, float]:
        """Coefficients of a panel (n·s, C), and its error at random states."""
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        self.built += 1
        places = middle + half * self.nodes
        values = self.function(places, self.sigmas)
        made = np.tensordot(self.transform, values, 1)
        if len(self.sigmas) > 1:
            made = np.matmul(self.sigma_transform, made)
        size = np.maximum(np.max(np.abs(values), axis=(0, 1)), NOTHING * self.largest)
        # the same places in every process
        rng = np.random.default_rng(len(self.sigmas))
        error = 0.0
        for t, s in rng.uniform(-1, 1, (2, 2)):
            at, spread = self._log_span
            sigma = math.exp(at + spread * s) if len(self.sigmas) > 1 else float(self.sigmas[0])
            exact = self.function(np.array([middle + half * t]), np.array([sigma]))[0, 0]
            over = _chebyshev_and_slope(s, len(self.sigmas))[0]
            near = np.einsum("i,k,ikc->c", _chebyshev_and_slope(t, NODES)[0], over, made)
            relative = np.abs(near - exact)[size > 0] / size[size > 0]
            error = max(error, float(relative.max(initial=0.0)))
        return made.reshape(-1, made.shape[-1]), error


def _chebyshev_and_slope(t: float, count: int) -> tuple[Array, Array]:
    """T_0 … T_{count−1} at t in [−1, 1], and their slopes."""
    order = np.arange(count)
    angle = math.acos(t)
    sine = math.sin(angle)
    values = np.cos(order * angle)
    if sine < 1e-6:  # at the ends T_k' is ±k²
        return values, order**2 * (1.0 if t > 0 else (-1.0) ** (order + 1))
    return values, order * np.sin(order * angle) / sine


class ContactTables:
    """What particles of every kind and class do in a contact, and its asperities.

    Parameters
    ----------
    contact : Contact
        With `Friction` and `Wear`; its own particles do not matter.
    classes : SizeClasses
        Those of one ratio of edges share a curve.
    kinds : sequence of Kind
        Kinds of particles, in the order of every array here.
    sigma : (float, float), optional
        σ from and to [m], where it moves; that of the contact otherwise.

    Raises
    ------
    InvalidValue
        No Friction or Wear, or a law of asperities or particles that does not know single ones.
    """

    def __init__(
        self,
        contact: Contact,
        classes: SizeClasses,
        kinds: Sequence[Kind],
        *,
        sigma: tuple[float, float] | None = None,
    ):
        self.contact = contact.replace(particles=None)
        _check_contact(self.contact)
        self.classes, self.kinds = classes, tuple(kinds)
        edges = np.array(classes.edges)
        self.tops = edges[1:]
        contact_sigma = contact.roughness.sigma
        self.span = (contact_sigma, contact_sigma) if sigma is None else (min(sigma), max(sigma))
        law = self.contact.particle_law
        assert isinstance(law, SeatedLaw)
        self.law = law
        self.rough_seat = law.seat == "rough"
        width = law.zeta_std * self.span[1] if self.rough_seat else 0.0
        lowest = -(REACH * width + 4 * self.span[1]) / self.tops[0]
        ratios = [float(f"{ratio:.12g}") for ratio in edges[:-1] / edges[1:]]
        self.curves = [
            tuple(particle_curve(self.contact, kind.material, ratio, lowest) for ratio in ratios)
            for kind in self.kinds
        ]
        """Of every kind and class."""
        self.survival = [
            self._survival(kind, curves)
            for kind, curves in zip(self.kinds, self.curves, strict=True)
        ]
        """Of every kind and class, with its place in the curve; None of what does not break."""
        self._sums: dict[float, Any] = {}
        self._roughs: dict[float, Roughness] = {}
        self._distinct: dict[tuple[int, int], int] = {}
        self.place = [self._place(i) for i in range(len(self.kinds))]
        """Which of the distinct kinds each is."""
        top = float(self.tops[-1]) + 9 * width
        step = PANEL * self.span[0]
        first = math.floor(-8 * self.span[1] / step)
        panels = step * np.arange(
            first, math.ceil((top + 9 * self.span[1]) / step) + 1, dtype=np.float64
        )
        most = np.stack([self._largest(i) for i, _ in self._distinct]).ravel()
        self.particles = PanelTable(self._of_particles, panels, self.span, most)
        most = self._of_asperities(np.zeros(1), np.array(self.span[1:]))[0, 0]
        self.spots = PanelTable(self._of_asperities, np.linspace(-5.0, 20.0, 26), self.span, most)
        self._first = [NAMES.index(name) for name in FIRST]
        self._parts: dict[int, tuple[Array, Array]] = {}
        """Of panels of the particles their coefficients, and of these load and shadow alone."""

    def _largest(self, i: int) -> Array:
        """The largest value of every column of a kind: (K, Q + 1)."""
        most = np.array([curve.largest for curve in self.curves[i]])
        powers = self.curves[i][0].powers
        return np.column_stack([most * self.tops[:, None] ** powers, np.ones(len(self.tops))])

    def _survival(
        self, kind: Kind, curves: tuple[ParticleCurve, ...]
    ) -> tuple[tuple[SurvivalCurve, int], ...] | None:
        if kind.strength is None:
            return None
        alike = {curve: [k for k, c in enumerate(curves) if c is curve] for curve in curves}
        made = {
            curve: SurvivalCurve(curve, kind.strength, self.tops[mine])
            for curve, mine in alike.items()
        }
        return tuple((made[curve], alike[curve].index(k)) for k, curve in enumerate(curves))

    def _place(self, i: int) -> int:
        """The first of the kinds with the same curve and strength."""
        alike = [
            j
            for j in range(i + 1)
            if self.curves[j] == self.curves[i] and self.kinds[j].strength == self.kinds[i].strength
        ]
        key = (alike[0], 0)
        return self._distinct.setdefault(key, len(self._distinct))

    # ------------------------------------------------------------------ tables
    def roughness_at(self, sigma: float) -> Roughness:
        """The surface at a roughness σ [m]."""
        if sigma not in self._roughs:
            if len(self._roughs) > 64:
                self._roughs.clear()
            self._roughs[sigma] = scale_roughness(self.contact.roughness, sigma)
        return self._roughs[sigma]

    def offset(self, sigma: float) -> float:
        """Mean gap under a particle minus d [m]."""
        return self.law.seat_offset(self.roughness_at(sigma))

    def mean_plane(self, sigma: float) -> float:
        """h − d [m]."""
        return self.roughness_at(sigma).y_s - self._asperity_sum(sigma).centre

    def _asperity_sum(self, sigma: float) -> Any:
        if sigma not in self._sums:
            if len(self._sums) > 64:
                self._sums.clear()
            contact = self.contact
            self._sums[sigma] = asperity_sum(
                contact.asperity_law, self.roughness_at(sigma), contact.surfaces, self.law.centre
            )
        return self._sums[sigma]

    def _of_particles(self, gap: Array, sigmas: Array) -> Array:
        """Every quantity of the distinct kinds at mean gaps (N,): (N, S, kinds·classes·columns)."""
        blocks = [self._of_kind(first, gap, sigmas) for first, _ in self._distinct]
        return np.stack(blocks, axis=2).reshape(len(gap), len(sigmas), -1)

    def _of_kind(self, i: int, gap: Array, sigmas: Array) -> Array:
        """Quantities and the broken part of one kind at mean gaps (N,): (N, S, K, Q + 1)."""
        curve = self.curves[i][0]
        out = np.zeros((len(gap), len(sigmas), len(self.tops), len(NAMES) + 1))
        for k, top in enumerate(self.tops):
            out[:, :, k] = self._of_class(i, k, gap / top, sigmas / top)
        out[..., :-1] *= self.tops[:, None] ** curve.powers
        if self.law.shadow == "covered":
            covered = math.pi / 4 * curve.one.breadth * self.classes.mean_power(2)
            out[..., NAMES.index("shadow")] = covered
        return out

    def _of_class(self, i: int, k: int, gap: Array, sigmas: Array) -> Array:
        """Quantities of a class with upper edge 1, averaged over its seats: (N, S, Q + 1)."""
        curve = self.curves[i][k]
        breaking = self.survival[i]
        survival, place = (None, 0) if breaking is None else breaking[k]

        def values(local: Array) -> Array:
            broken = np.zeros(len(local)) if survival is None else survival.of_class(place, local)
            return np.column_stack([curve(local), broken])

        if not self.rough_seat:
            return np.repeat(values(gap)[:, None], len(sigmas), axis=1)
        out = np.zeros((len(gap), len(sigmas), len(NAMES) + 1))
        widths = self.law.zeta_std * sigmas
        kinks = curve.panels if survival is None else np.union1d(curve.panels, survival.panels)
        local, weight = local_gaps(gap, widths=widths, kinks=kinks, top=1.0)
        if not len(local):
            return out
        weighted = weight[:, None] * values(local)
        for j, width in enumerate(widths):
            near = np.searchsorted(local, [gap.min() - REACH * width, gap.max() + REACH * width])
            mine = slice(*near)
            z = (gap[:, None] - local[mine]) / width
            density = np.exp(-0.5 * z * z) / (width * math.sqrt(2 * math.pi))
            out[:, j] = density @ weighted[mine]
        return out

    def _of_asperities(self, y: Array, sigmas: Array) -> Array:
        """`SPOTS` at d/σ (N,): (N, S, 7)."""
        out = np.zeros((len(y), len(sigmas), len(SPOTS)))
        outputs: dict[str, Any] = {output.name: output for output in self.contact.outputs}
        friction, wear = outputs["friction"], outputs["wear"]
        ratio = friction.ratio(self.contact)
        for j, sigma in enumerate(sigmas):
            rough, d = self._asperity_sum(float(sigma)), y * sigma
            out[:, j, :4] = rough.fields(d)
            with np.errstate(all="ignore"):
                for spots in rough.spots(d):
                    out[:, j, 4] += spots.total(wear._archard("ss", spots.regime, spots.area))
                    forces = friction.of_asperities(spots, ratio)
                    out[:, j, 5] += spots.total(forces["ss_shear"])
                    out[:, j, 6] += spots.total(forces["ss_plough"])
        return out

    @property
    def error(self) -> float:
        """The largest relative error that was measured when panels were made [1]."""
        return max(self.particles.error, self.spots.error)

    # ------------------------------------------------------------------ one state
    def _all(self, d: float, sigma: float) -> Array:
        """(kinds, classes, columns) at d, with the broken part last."""
        gap = d + self.offset(sigma)
        if self.rough_seat:
            flat = self.particles(gap, sigma)
        else:
            flat = self._of_particles(np.array([gap]), np.array([sigma]))[0, 0]
        blocks = flat.reshape(len(self._distinct), len(self.tops), -1)
        return blocks[self.place]

    def broken(self, d: float, sigma: float) -> Array:
        """Part of the particles that break on the way down to d: (kinds, classes)."""
        return self._all(d, sigma)[:, :, -1]

    def _first_of_particles(self, d: float, sigma: float) -> tuple[Array, Array]:
        """Load and shadow of each particle (kinds, classes, 2), and their slopes in d."""
        gap, columns = d + self.offset(sigma), len(NAMES) + 1
        if self.rough_seat:
            coefficients, values, slopes = self.particles.basis(gap, sigma)
            load_and_shadow = self._load_and_shadow(coefficients)
            shape = (2, len(self._distinct), len(self.tops), 2)
            both = (np.stack([values, slopes]) @ load_and_shadow).reshape(shape)
        else:
            step = 1e-7 * sigma
            places = gap + step * np.array([-1.0, 0.0, 1.0])
            three = self._of_particles(places, np.array([sigma]))
            three = three.reshape(3, len(self._distinct), len(self.tops), columns)
            three = three[..., self._first]
            both = np.stack([three[1], (three[2] - three[0]) / (2 * step)])
        return both[0][self.place], both[1][self.place]

    def _load_and_shadow(self, coefficients: Array) -> Array:
        """The coefficients of a panel of load and shadow alone: (n·s, distinct·classes·2)."""
        of, load_and_shadow = self._parts.get(id(coefficients), (None, coefficients))
        if of is not coefficients:
            shape = (len(coefficients), len(self._distinct), len(self.tops), len(NAMES) + 1)
            some = coefficients.reshape(shape)[..., self._first]
            load_and_shadow = np.ascontiguousarray(some.reshape(len(coefficients), -1))
            self._parts[id(coefficients)] = coefficients, load_and_shadow
        return load_and_shadow

    def load_alone(self, d: float, *, eta: Array, sigma: float) -> float:
        """The pressure of `load` without its slope."""
        if not self.rough_seat:
            return self.load(d, eta=eta, sigma=sigma)[0]
        coefficients, values, _ = self.particles.basis(d + self.offset(sigma), sigma)
        load_and_shadow = self._load_and_shadow(coefficients)
        per_particle = (values @ load_and_shadow).reshape(len(self._distinct), len(self.tops), 2)
        particle_load, shadow = np.tensordot(eta, per_particle[self.place], 2)
        return float(self._force(d, sigma)[0] * max(1 - shadow, 0.0) + particle_load)

    def load(self, d: float, *, eta: Array, sigma: float) -> tuple[float, float]:
        """Pressure that particles η (kinds, classes) [1/m²] and asperities bear, and its slope."""
        f, f1 = self._force(d, sigma)
        value, slope = self._first_of_particles(d, sigma)
        particle_load, shadow = np.tensordot(eta, value, 2)
        particle_load_1, shadow_1 = np.tensordot(eta, slope, 2)
        bare = max(1 - shadow, 0.0)
        return f * bare + particle_load, f1 * bare - f * shadow_1 * (bare > 0) + particle_load_1

    def _force(self, d: float, sigma: float) -> tuple[float, float]:
        y = d / sigma
        if y > self.spots.edges[-1]:
            return 0.0, 0.0
        coefficients, values, slopes = self.spots.basis(y, sigma)
        return float(values @ coefficients[:, 0]), float(slopes @ coefficients[:, 0]) / sigma

    def find_gap(self, pressure: float, *, eta: Array, sigma: float, start: float) -> float:
        """The separation d at which asperities and particles bear the pressure [m].

        Parameters
        ----------
        pressure : float
            p [Pa].
        eta : array (kinds, classes)
            Particles per area [1/m²].
        sigma, start : float
            σ, and a separation to start from [m].

        Raises
        ------
        NoEquilibrium
            The lowest separation that is searched does not bear the load.
        """
        rough = self.roughness_at(sigma)
        floor = SEARCHED * rough.sigma_s + self._asperity_sum(sigma).centre
        low, high = floor, math.inf
        d, step = max(start, floor), 0.25 * sigma
        for _ in range(200):
            bears, slope = self.load(d, eta=eta, sigma=sigma)
            if bears >= pressure:
                low = d
            else:
                high = d
                if d <= floor:
                    raise NoEquilibrium(
                        f"no equilibrium at {pressure:g} Pa: asperities and particles bear less "
                        "at the lowest separation that is searched"
                    )
            newton = math.nan
            if bears > 0 and slope < 0:
                newton = d - math.log(bears / pressure) * bears / slope
            if math.isfinite(newton) and abs(newton - d) <= 1e-14 * (abs(d) + sigma):
                return newton
            if not low < newton < high:
                newton = 0.5 * (low + high) if math.isfinite(high) else d + step
                newton = newton if newton >= floor else floor
                step *= 2
            elif abs(newton - d) > 4 * step:
                newton = d + math.copysign(4 * step, newton - d)
            if high - low <= 1e-15 * (abs(d) + sigma):
                return d
            d = max(newton, floor)
        return d

    def press_at(self, d: float, *, eta: Array, sigma: float) -> Pressed:
        """Everything at a separation d [m] under particles η (kinds, classes) [1/m²]."""
        per_particle = self._all(d, sigma)[:, :, :-1]
        y = d / sigma
        inside = y <= self.spots.edges[-1]
        spots = self.spots(y, sigma) if inside else np.zeros(len(SPOTS))
        shadow = float(np.tensordot(eta, per_particle[:, :, NAMES.index("shadow")], 2))
        return Pressed(
            d=d,
            sigma=sigma,
            per_particle=per_particle,
            asperities=dict(zip(SPOTS, map(float, spots), strict=True)),
            bare=max(1 - shadow, 0.0),
        )


@lru_cache(maxsize=8)
def contact_tables(
    contact: Contact,
    classes: SizeClasses,
    kinds: tuple[Kind, ...],
    sigma: tuple[float, float] | None,
) -> ContactTables:
    """The cached tables of a contact: one for all histories with these particles."""
    return ContactTables(contact, classes, kinds, sigma=sigma)


def _check_contact(contact: Contact) -> None:
    names = {output.name for output in contact.outputs}
    if lost := [name for name in ("friction", "wear") if name not in names]:
        raise InvalidValue(
            f"the contact lacks outputs.{' and outputs.'.join(x.capitalize() for x in lost)}: a "
            "history needs to know how particles move and what they take away",
            code=Mistake.MISSING,
        )
    if not isinstance(contact.particle_law, SeatedLaw):
        raise InvalidValue(
            f"the particle law {contact.particle_law.name} does not say what one particle does in "
            "its seat; a history needs particle.Series or particle.Flakes",
            code=Mistake.BEYOND,
        )
    made = asperity_sum(
        contact.asperity_law, contact.roughness, contact.surfaces, contact.particle_law.centre
    )
    if isinstance(made, FieldSum):
        raise InvalidValue(
            f"the asperity law {contact.asperity_law.name} takes the surface as one field of "
            "heights, on which particles do not add up; a history needs a law of single asperities",
            code=Mistake.BEYOND,
        )
