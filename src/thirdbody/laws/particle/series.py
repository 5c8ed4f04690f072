"""The consistent model: a particle is two contacts in series, and it rests somewhere."""

from __future__ import annotations

import copy
import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np
from scipy import special

from ...distributions import Distribution, Monodisperse
from ...errors import InvalidValue
from ...materials import reduced_modulus
from ...numerics import PiecewiseChebyshev, gauss_legendre, in_pieces, panel_rule, subdivide
from ...spots import ParticleSpots
from ...values import choice, quantity
from ..asperity.hermite import Hermite
from ..base import (
    REGIMES,
    AbstractAsperityLaw,
    AbstractParticleLaw,
    ParticleResponse,
    ParticlesTogether,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ...materials import Material, MaterialPair
    from ...particles import Particles
    from ...surfaces import Roughness

    Array = NDArray[np.float64]
    Number = float | Array
    Index = NDArray[np.intp]
    Body = tuple[float, float, float]

__all__ = ["Series", "SqueezedParticle", "together_in"]

COLUMNS = ("force", "elastic", "elastoplastic", "plastic", "second", "footprint", "projected")
"""What one particle contributes: load, area on surface 1 by regime, area on surface 2, larger of
the two areas, projected area πx²/4."""

KINDS = (0, 1, 1, 1, 1, 1, 1)
"""Which columns are measured against each other: load, areas."""


class Side:
    """One contact of a particle of unit size: load and area against indentation.

    Lengths are in units of the size x, loads in x²·Pa, areas in x². The tip radius is R. The
    area stops at the great circle, πR/2 (π/4 for a sphere); from there on the load is mean
    pressure × great circle, and constant where the law has no plastic pressure to go on to.

    E* and H may be arrays (M, 1), one row a material, for a law that all bind alike.

    Attributes
    ----------
    kinks : array (..., k)
        Increasing reduced indentations where the formula changes; constant beyond the last.
    """

    def __init__(
        self, law: AbstractAsperityLaw, E_star: Number, H: Number, nu: float, R: float = 0.5
    ):
        self.law, self.H, self.R = law.bound(R=R, E_star=E_star, H=H, nu=nu), H, R
        self.delta_1 = self.law.yield_interference(R=R, E_star=E_star, H=H)
        self.full = 0.5 / self.delta_1  # reduced area of the great circle
        self.cap = self._cap()
        self.unit = self.R * math.pi * self.delta_1 * self.H
        self.plateau = self.law.branches[-1].regime == "plastic"
        kinks = [self.cap]
        for y in self.law.breakpoints:
            if self.plateau:
                kinks.append(np.full_like(self.cap, y))
            elif np.any(y < self.cap):
                kinks.append(np.minimum(y, self.cap))
        self.kinks = np.sort(np.concatenate([np.atleast_1d(y) for y in kinks], axis=-1), axis=-1)
        self.limit = self.unit * self.reduced_force(2 * self.kinks[..., -1:])

    def _cap(self) -> Array:
        """Reduced interference at which the area reaches the great circle."""
        from scipy.optimize.elementwise import find_root

        full = np.asarray(self.full, dtype=float)

        def excess(y: Array, full: Array) -> Array:
            return self.law.reduced("area", y) - full

        points = self.law.breakpoints or (1.0,)
        ends = np.array([0.5 * points[0], 2 * points[-1]])
        # most areas grow like the indentation while elastic, and again when plastic
        elastic, plastic = full * (ends / self.law.reduced("area", ends))[:, *(None,) * full.ndim]
        y = np.where(elastic <= points[0], elastic, plastic)
        rest = np.abs(excess(y, full)) > 4e-16 * full
        if np.any(rest):
            low, high = 0.4 * full[rest], np.maximum(full[rest], 1.0)
            low = np.where(excess(low, full[rest]) < 0, low, 0.0)
            found = find_root(
                excess,
                (low, high),
                args=(full[rest],),
                tolerances={"xatol": 0.0, "xrtol": 1e-15, "fatol": 0.0, "frtol": 0.0},
            )
            y[rest] = np.where(excess(high, full[rest]) <= 0, high, found.x)
        return y

    @staticmethod
    def chosen(first: NDArray[np.bool_], one: Side, two: Side) -> Side:
        """For each material side one where ``first``, else side two."""
        out = copy.copy(one)
        for name in ("H", "delta_1", "full", "cap", "unit", "kinks", "limit"):
            setattr(out, name, np.where(first, getattr(one, name), getattr(two, name)))
        return out

    def reduced_force(self, y: Array) -> Array:
        """Load over `unit` at y = δ/δ_1."""
        if not self.plateau:
            y = np.minimum(y, self.cap)
        force = self.law.reduced("force", y)
        over = y > self.cap
        if np.any(over):
            full = np.broadcast_to(self.full, y.shape)[over]
            force[over] *= full / self.law.reduced("area", y[over])
        return force

    def reduced_area(self, y: Array) -> Array:
        """Area over πRδ_1 at y = δ/δ_1."""
        return np.minimum(self.law.reduced("area", y), self.full)

    def force(self, delta: Array) -> Array:
        return self.unit * self.reduced_force(delta / self.delta_1)

    def area(self, delta: Array) -> Array:
        return self.R * math.pi * self.delta_1 * self.reduced_area(delta / self.delta_1)

    def regime(self, delta: Array) -> Index:
        """Index into `REGIMES`; beyond the great circle a contact that can yield is plastic."""
        y = delta / self.delta_1
        order = np.array([REGIMES.index(branch.regime) for branch in self.law.branches])
        index = order[np.searchsorted(self.law.breakpoints, y, side="right")]
        return np.where((y >= self.cap) & self.plateau, REGIMES.index("plastic"), index)

    def around(self, y: float) -> tuple[float, float]:
        """Loads just below and at y = δ/δ_1, for one material; equal where the law is smooth."""
        below, at = self.unit * self.reduced_force(np.array([np.nextafter(y, 0), y]))
        return (float(at), float(at)) if math.isclose(below, at, rel_tol=1e-9) else (below, at)

    def indentation(self, force: float) -> float:
        """Where `force` below the limit is first reached, for one material; also in a jump."""
        from scipy.optimize import brentq

        def excess(log_delta: float) -> float:
            return float(self.force(np.array([math.exp(log_delta)]))[0]) - force

        top = math.log(2 * self.kinks[-1] * self.delta_1)
        bottom = top - 600
        for y in self.kinks:
            below, at = self.around(y)
            edge = math.log(y * self.delta_1)
            if below == at:
                continue
            if force <= below:
                top = edge - 1e-15 * abs(edge)
                break
            if force <= at:
                return float(y * self.delta_1)
            bottom = edge + 1e-15 * abs(edge)
        if excess(top) <= 0:
            return math.exp(top)
        if excess(bottom) >= 0:
            return math.exp(bottom)
        return math.exp(brentq(excess, bottom, top, xtol=1e-15, rtol=1e-15))


class SqueezedParticle:
    r"""One particle of unit size squeezed by ε = δ/x between two flats.

    Solves :math:`F_1(\delta_1) = F_2(\delta-\delta_1)`; a particle of size x carries
    :math:`x^2` times the load and the area found here. A sphere has the tip radius R = 1/2.
    A side whose load jumps up stays there until the other has caught up; one whose load jumps
    down lets go where loading first reaches the jump.

    Attributes
    ----------
    kinks : array
        Values of ε where the response changes its formula; beyond the last it is constant.
    held : list of (float, float, int, float)
        From ε to ε side 0 or 1 stays at the indentation δ at which its load jumps up, while the
        load rises by the jump.
    let_go : list of (float, int, float)
        From ε on side 0 or 1 is past the indentation δ at which its load jumps down.
    """

    def __init__(self, law: AbstractAsperityLaw, first: Body, second: Body, R: float = 0.5):
        self.sides = (Side(law, *first, R), Side(law, *second, R))
        self.great_circle = R * math.pi / 2
        self.equal = first == second
        one, two = self.sides
        kinks = set()
        self.held: list[tuple[float, float, int, float]] = []
        self.let_go: list[tuple[float, int, float]] = []
        for number, (side, other) in enumerate(((one, two), (two, one))):
            limit = float(other.limit[0])
            for y in side.kinks:
                delta = y * side.delta_1
                if self.equal:
                    kinks.add(2 * delta)
                    continue
                below, at = side.around(y)
                ends = []
                for force in sorted({below, max(below, at)}):
                    if force < limit * (1 - 1e-12):
                        ends.append(delta + other.indentation(force))
                    elif force < limit * (1 + 1e-12):
                        ends.append(delta + other.kinks[-1] * other.delta_1)
                kinks.update(ends)
                if at > below and ends:
                    self.held.append((ends[0], ends[1] if len(ends) > 1 else np.inf, number, delta))
                elif at < below and ends:
                    self.let_go.append((ends[0], number, delta))
        self.kinks = np.array(sorted(kinks))
        if self.kinks[-1] > DEEPEST_SQUEEZE:
            raise InvalidValue(
                f"the hardness {max(side.H for side in self.sides):.3g} Pa is so high against the "
                f"contact modulus {min(first[0], second[0]):.3g} Pa that a particle would stay "
                f"elastic beyond {self.kinks[-1]:.3g} times its diameter; the contact law holds "
                "for small indentations only (check the units of E and H)"
            )
        self._split_table = None if self.equal else self._tabulate_split()
        if not self.equal:
            self.kinks = np.array(sorted({*self.kinks, *self._area_crossings()}))
        ratio = 4.0
        splits = [self.kinks[:1]]
        for a, b in zip(self.kinks[:-1], self.kinks[1:], strict=True):
            splits.append(np.geomspace(a, b, max(2, math.ceil(math.log(b / a, ratio)) + 1))[1:])
        self.panels = np.concatenate(splits)

    def _solve_split(self, eps: Array) -> Array:
        from scipy.optimize.elementwise import find_root

        one, two = self.sides

        def excess(t: Array, e: Array) -> Array:
            return one.force(t * e) - two.force((1 - t) * e)

        low, high = np.zeros_like(eps), np.ones_like(eps)
        for since, number, delta in self.let_go:
            share = delta / eps if number == 0 else 1 - delta / eps
            above = (eps > since) == (number == 0)  # the jump lies below the share of side 0
            low = np.where(above, np.maximum(low, share + 1e-15), low)
            high = np.where(above, high, np.minimum(high, share - 1e-15))
        if self.let_go:
            good = (low < high) & (excess(low, eps) <= 0) & (excess(high, eps) >= 0)
            low, high = np.where(good, low, 0.0), np.where(good, high, 1.0)
        root = find_root(
            excess,
            (low, high),
            args=(eps,),
            tolerances={"xatol": 0.0, "xrtol": 1e-15, "fatol": 0.0, "frtol": 0.0},
        )
        return root.x

    def _tabulate_split(self) -> PiecewiseChebyshev:
        v = np.log(self.kinks)
        v = np.append(v[0] - 1, v)  # elastic up to the first: one share
        return PiecewiseChebyshev(lambda x: self._solve_split(np.exp(x))[:, None], v)

    def _area_crossings(self) -> list[float]:
        """Values of ε at which the two contact areas change order."""
        from scipy.optimize import brentq

        grid = np.geomspace(self.kinks[0], self.kinks[-1], 400)
        smallest = 1e-13 * self.great_circle

        def difference(eps: ArrayLike) -> Array:
            one, two = self.indentations(np.atleast_1d(np.asarray(eps, dtype=float)))
            return self.sides[0].area(one) - self.sides[1].area(two)

        values = difference(grid)
        sign = np.where(np.abs(values) > smallest, np.sign(values), 0.0)
        return [
            brentq(lambda e: float(difference(e)[0]), grid[i], grid[i + 1], xtol=1e-16)
            for i in np.flatnonzero(sign[1:] * sign[:-1] < 0)
        ]

    def indentations(self, eps: Array) -> tuple[Array, Array]:
        """δ_1 and δ_2 over x."""
        if self._split_table is None:
            return 0.5 * eps, 0.5 * eps
        low, high = 0.5 * self.kinks[0], self.kinks[-1]
        share = self._split_table(np.log(np.clip(eps, low, high)))[:, 0]
        one = share * eps
        # beyond the last kink the softer side takes the rest; two equal limits share it
        past = eps > high
        if np.any(past):
            limits = [float(side.limit[0]) for side in self.sides]
            rest = eps - high
            if math.isclose(*limits, rel_tol=1e-12):
                gained = 0.5 * rest
            else:
                gained = rest if limits[0] < limits[1] else 0.0 * rest
            one = np.where(past, share * high + gained, one)
        two = eps - one
        for begin, end, number, delta in self.held:
            here = (eps > begin) & (eps < min(end, high))
            stays = delta * (1 - 1e-15)  # not past its jump, whatever rounding does
            one = np.where(here, stays if number == 0 else eps - stays, one)
            two = np.where(here, stays if number == 1 else eps - stays, two)
        return one, two

    def force(self, eps: Array, one: Array) -> Array:
        """Load over x² at ε, of which ``one`` is the first side's."""
        force = self.sides[0].force(one)
        if self.equal:
            return force
        for begin, end, number, _ in self.held:
            if number == 0 and np.any(here := (eps > begin) & (eps < end)):
                force = np.where(here, self.sides[1].force(eps - one), force)
        limit = min(float(side.limit[0]) for side in self.sides)
        return np.where(eps > self.kinks[-1], limit, force)

    def __call__(self, eps: Array) -> Array:
        """The seven `COLUMNS` per x² at ε > 0: (N, 7)."""
        eps = np.asarray(eps, dtype=float)
        one, two = self.indentations(eps)
        a1, a2 = self.sides[0].area(one), self.sides[1].area(two)
        regime = self.sides[0].regime(one)
        out = np.empty((len(eps), len(COLUMNS)))
        out[:, 0] = self.force(eps, one)
        for i in range(3):
            out[:, 1 + i] = np.where(regime == i, a1, 0.0)
        out[:, 4] = a2
        out[:, 5] = np.maximum(a1, a2)
        out[:, 6] = self.great_circle
        out[eps <= 0] = 0.0
        return out

    def spots(self, x: Array, delta: Array, *, share: Array | None, number: Array) -> ParticleSpots:
        """Particles of sizes x squeezed by δ (M, n), so many of each."""
        eps = np.divide(delta, x, out=np.zeros_like(x), where=x > 0).ravel()
        depths = self.indentations(eps)
        pairs = list(zip(self.sides, depths, strict=True))
        areas = [np.where(eps > 0, side.area(one), 0.0).reshape(x.shape) for side, one in pairs]
        regimes = [side.regime(one).reshape(x.shape) for side, one in pairs]
        one, two = (x * part.reshape(x.shape) for part in depths)
        return ParticleSpots(
            share=share,
            number=number,
            load=x**2 * np.where(eps > 0, self.force(eps, depths[0]), 0.0).reshape(x.shape),
            x=x,
            radius=self.sides[0].R * x,
            depths=(one, two),
            areas=(x**2 * areas[0], x**2 * areas[1]),
            regimes=(regimes[0], regimes[1]),
            yields=(float(self.sides[0].delta_1), float(self.sides[1].delta_1)),
            hardness=(float(self.sides[0].H), float(self.sides[1].H)),
        )


@lru_cache(maxsize=512)
def squeezed_particle(
    law: AbstractAsperityLaw, first: Body, second: Body, R: float = 0.5
) -> SqueezedParticle:
    """The cached response of one particle; sides are (E*, H, ν)."""
    return SqueezedParticle(law, first, second, R)


class SizeAverage:
    r"""The particle response averaged over sizes, as a function of the gap under it.

    .. math:: P(g) = \int_g^\infty \varphi_a(x)\, x^2\,\hat q\!\left(\frac{x-g}{x}\right) dx

    Tabulated once per shape of the distribution and material triple as Chebyshev series between
    the gaps where a size or a regime sets in: in the gap itself for small gaps, and in
    :math:`u=\sqrt{x_{max}-g}` near the largest size, where P sets in like a power of u.
    Lengths are those of the standardised distribution.
    """

    def __init__(self, particle: SqueezedParticle, sizes: Distribution):
        self.particle, self.sizes = particle, sizes
        low, self.top = sizes.support
        last = particle.kinks[-1]
        self.bottom = low * (1 - last) if last <= 1 else self.top * (1 - last)
        # leading powers of u as the last particle loses contact
        edge = 0 if isinstance(sizes, Monodisperse) else 2
        self.powers = np.array([2.0 + edge] * 6 + [float(edge)])
        self.join = self.bottom
        if 0.5 * self.top - self.bottom > 1e-12 * self.top:  # a sliver is rounding
            self.join = 0.5 * self.top
        gaps = [x * (1 - eps) for x in sizes.kinks for eps in (0.0, *particle.kinks)]
        gaps += [x * f for x in sizes.pieces for f in (0.25, 0.5) if x > 1e-4 * self.top]
        known = np.array(sorted({g for g in gaps if self.bottom < g < self.top}))
        rise = np.sqrt(self.top - np.array([self.join, *known[known > self.join]]))
        self.rises = _distinct(np.array([0.0, *np.sort(rise)]))
        """Breakpoints in u above the join."""
        self.gaps_below = np.empty(0)
        """Breakpoints in the gap below the join, if there are gaps."""
        if self.bottom < self.join:
            below = [self.bottom, *known[known < self.join], self.join]
            self.gaps_below = _distinct(np.array(below))
        bottom = np.array([self.bottom])
        self.floor = self.average(bottom, self.top - bottom)[0]

    @cached_property
    def upper(self) -> PiecewiseChebyshev:
        """P/u^powers as a function of u, above the join."""
        return PiecewiseChebyshev(self._reduced, self.rises, tolerance=1e-13, kinds=KINDS)

    @cached_property
    def lower(self) -> PiecewiseChebyshev | None:
        """P as a function of the gap, below the join."""
        if not len(self.gaps_below):
            return None
        return PiecewiseChebyshev(
            lambda g: self.average(g, self.top - g),
            self.gaps_below,
            tolerance=1e-13,
            kinds=KINDS,
        )

    def _reduced(self, u: Array) -> Array:
        return self.average(self.top - u * u, u * u) / u[:, None] ** self.powers

    def average(self, gap: Array, rise: Array) -> Array:
        """P(gap) by direct quadrature: (N, 7). Panels in √δ, split at every regime.

        ``rise`` = x_max − gap is given beside the gap because near the largest size the gap
        alone would lose it to rounding.
        """
        if isinstance(self.sizes, Monodisperse):
            return self.sizes.mean**2 * self.particle(rise / self.sizes.mean)
        out = np.empty((len(gap), len(COLUMNS)))
        for part in np.array_split(np.arange(len(gap)), max(1, len(gap) // 200)):
            out[part] = self._average(gap[part, None], rise[part, None])
        return out

    def of_sizes(
        self, gap: Array, rise: Array, splits: Sequence[float] = (), nodes: int = 16
    ) -> tuple[Array, Array, Array]:
        """Diameters, squeezes and weights φ_a(x) dx of sums over sizes: (N, n) for (N, 1)."""
        particle, sizes = self.particle, self.sizes
        if isinstance(sizes, Monodisperse):
            return np.full_like(gap, sizes.mean), rise, (rise > 0).astype(float)
        low, high = sizes.support
        pieces = np.array(sizes.pieces)
        # sizes are counted from `zero`, the largest of them where they lie close together, so
        # that their densities and how far they lie apart keep all digits; edges of panels
        # likewise, or where sizes begin to be squeezed from the gap, as squeezes δ
        close = low > 0.5 * high
        zero = high if close else 0.0
        gap_at = -rise if close else gap
        start = rise <= 2 * (high - low)
        above = np.where(gap > 0.5 * high, rise - (high - pieces), pieces - gap)
        of_sizes = np.where(start, above, pieces - zero)
        # where a regime of some size sets in: δ = εx, so x = g/(1 − ε), which must be positive
        eps = np.concatenate([particle.panels, splits])
        whole = eps == 1
        part = np.where(whole, 1.0, 1 - eps)
        of_regimes = gap / part - zero
        if close:
            of_regimes = np.where(gap > 0.5 * high, (high * eps - rise) / part, of_regimes)
        of_regimes = np.where(start, gap * eps / part, of_regimes)
        edges = np.concatenate([of_sizes, np.where(whole, -np.inf, of_regimes)], axis=1)
        first = np.maximum(of_sizes[:, :1], np.where(start, 0.0, gap_at))
        edges = np.sort(np.clip(edges, first, of_sizes[:, -1:]), axis=1)
        # Gauss panels in √δ, in which the response is smooth where it sets in
        root = np.sqrt(np.maximum(np.where(start, edges, edges - gap_at), 0.0))
        sums = root[:, 1:] + root[:, :-1]
        step = np.divide(np.diff(edges, axis=1), sums, out=np.zeros_like(sums), where=sums > 0)
        x, weight = gauss_legendre(nodes)
        from_edge = 0.5 * step[..., None] * (1 + x)
        root = root[:, :-1, None]
        place = edges[:, :-1, None] + from_edge * (2 * root + from_edge)
        root = root + from_edge
        weight = root * step[..., None] * weight
        root, place, weight = (each.reshape(len(gap), -1) for each in (root, place, weight))
        place = np.where(start, place + gap_at, place)
        diameter = np.clip(zero + place, low, high)
        density = sizes.pdf_below(-place) if close else sizes.pdf(diameter)
        return diameter, root * root, density * weight

    def _average(self, gap: Array, rise: Array) -> Array:
        diameter, delta, weight = self.of_sizes(gap, rise)
        density = weight * diameter**2
        used = density > 0
        values = np.zeros((*density.shape, len(COLUMNS)))
        values[used] = self.particle(delta[used] / diameter[used])
        return np.einsum("gn,gnk->gk", density, values)

    def __call__(self, gaps: Array) -> Array:
        """P(g) from the tables: (N, 7)."""
        u = np.sqrt(np.maximum(self.top - gaps, 0.0))
        values = self.upper(np.minimum(u, self.upper.edges[-1])) * u[:, None] ** self.powers
        if self.lower is not None and np.any(low := gaps < self.join):
            values[low] = self.lower(np.maximum(gaps[low], self.bottom))
        values[gaps < self.bottom] = self.floor
        values[gaps >= self.top] = 0.0
        return values

    def derivatives(self, gaps: Array, columns: tuple[int, ...]) -> Array:
        """P, P′ and P″ of some columns: (N, len(columns), 3)."""
        u = np.sqrt(np.maximum(self.top - gaps, 0.0))
        v = np.clip(u, 1e-60, self.upper.edges[-1])[:, None]
        c = self.upper.derivatives(v[:, 0], columns)
        p = self.powers[list(columns)]
        value, first, second = c[..., 0], c[..., 1], c[..., 2]
        lead = v**p
        # with respect to u, then dg = −2u du
        du = lead * (first + p * value / v)
        ddu = lead * (second + 2 * p * first / v + p * (p - 1) * value / v**2)
        out = np.empty_like(c)
        out[..., 0] = lead * value
        out[..., 1] = -du / (2 * v)
        out[..., 2] = (ddu - du / v) / (4 * v * v)
        out[u == 0] = 0.0
        if self.lower is not None and np.any(low := gaps < self.join):
            out[low] = self.lower.derivatives(np.maximum(gaps[low], self.bottom), columns)
        below = gaps < self.bottom
        out[below] = 0.0
        out[below, :, 0] = self.floor[list(columns)]
        return out

    def nodes(self, width: float) -> tuple[Array, Array, Array]:
        """Gauss nodes in the gap, weights and P there, for sums over a seat of this width.

        The panels of the tables, cut where they are wider than the seat: increasing gaps (M,),
        weights (M,), values (M, 7).
        """
        lower = None if self.lower is None else self.lower.edges
        gaps, rise, weights = self._gaps(self.upper.edges, lower, width, SEAT_NODES)
        values = np.empty((len(gaps), len(COLUMNS)))
        upper = gaps >= self.join
        u = np.sqrt(rise[upper])
        values[upper] = self.upper(u) * u[:, None] ** self.powers
        if self.lower is not None:
            values[~upper] = self.lower(gaps[~upper])
        return gaps, weights, values

    def gaps(self, width: float, splits: Sequence[float] = ()) -> tuple[Array, Array, Array]:
        """As `nodes` without the tables: gaps, x_max − gap, weights (M,); relative error 1e-9.

        ``splits`` are more values of ε at which sums over gaps have a kink.
        """
        # without a gap particles of every size are squeezed by ε = 1: up to their middles
        more = np.array([0.0, *(x * (1 - eps) for x in self.sizes.kinks for eps in splits)])
        more = more[(more > self.bottom) & (more < self.top)]
        upper = np.sqrt(self.top - more[more > self.join])
        lower = None
        if len(self.gaps_below):
            lower = _distinct(np.sort([*self.gaps_below, *more[more < self.join]]))
        upper = _distinct(np.sort([*self.rises, *upper]))
        return self._gaps(upper, lower, SPOT_WIDTHS * width, SPOT_NODES)

    def _gaps(
        self, upper: Array, lower: Array | None, width: float, nodes: tuple[int, int]
    ) -> tuple[Array, Array, Array]:
        """Nodes on panels between edges in u and, below the join, in the gap."""
        u, weight = _seat_rule(_cut(upper**2, width) ** 0.5, width, np.square, nodes)
        rise, weights = u * u, 2 * u * weight
        if lower is not None:
            g, weight = _seat_rule(_cut(lower, width), width, np.asarray, nodes)
            rise = np.concatenate([rise, self.top - g[::-1]])
            weights = np.concatenate([weights, weight[::-1]])
        return self.top - rise[::-1], rise[::-1], weights[::-1]

    def spots(self, gap: Array, splits: Sequence[float] = ()) -> ParticleSpots:
        """Every particle squeezed in gaps (N,) under which they rest on a plane."""
        rows = gap[:, None], self.top - gap[:, None]
        x, delta, weight = self.of_sizes(*rows, splits, SIZE_NODES)
        return self.particle.spots(x, np.maximum(delta, 0.0), share=None, number=weight)


def _seat_rule(
    edges: Array, width: float, gap: Callable[[Array], Array], nodes: tuple[int, int]
) -> tuple[Array, Array]:
    """Gauss rule over panels, of fewer nodes where the seat is wide against a panel."""
    narrow = np.abs(np.diff(gap(edges))) < 0.25 * width
    ends = [0, *(np.flatnonzero(np.diff(narrow)) + 1), len(narrow)]
    rules = [
        panel_rule(edges[a : b + 1], nodes[int(narrow[a])]) for a, b in itertools.pairwise(ends)
    ]
    places, weights = zip(*rules, strict=True)
    return np.concatenate(places), np.concatenate(weights)


def _distinct(edges: Array) -> Array:
    """Increasing edges without the slivers that rounding leaves between equal ones."""
    wide = np.diff(edges) > 1e-12 * np.max(np.abs(edges))
    return np.append(edges[:-1][wide], edges[-1])


def _cut(edges: Array, width: float) -> Array:
    return np.concatenate([edges[:1], subdivide(edges, width=width)[1:]])


@lru_cache(maxsize=256)
def size_average(
    law: AbstractAsperityLaw,
    first: Body,
    second: Body,
    sizes: Distribution,
    R: float = 0.5,
) -> SizeAverage:
    """The cached size average; sides are (E*, H, ν)."""
    return SizeAverage(squeezed_particle(law, first, second, R), sizes)


def contact_sides(surfaces: MaterialPair, particle: Material) -> tuple[Body, Body]:
    """E*, and H and ν of the softer body, where the particle meets surface 1 and surface 2."""

    def side(surface: Material) -> Body:
        softer = min(surface, particle, key=lambda body: body.H)
        return reduced_modulus(surface, particle), softer.H, softer.nu

    return side(surfaces.first), side(surfaces.second)


@dataclass(frozen=True, slots=True, kw_only=True)
class Series(AbstractParticleLaw):
    r"""A particle indents both surfaces with one load, from wherever it rests.

    A particle of diameter x in a local gap g is squeezed by δ = x − g, shared so that

    .. math:: F_1(\delta_1) = F_2(\delta - \delta_1) = f(x, \delta)

    with the single-contact ``law`` on both sides (radius x/2, softer hardness of each contact),
    the contact area never larger than the great circle πx²/4. Summed over sizes and seats,

    .. math:: F_{sa}(h) = \eta_a \int \varphi_a(x) \int_0^\infty f(x,\delta)\,
              p_\zeta(h - x + \delta)\,d\delta\,dx .

    Seats: where a particle rests decides most of its load.

    ``rough``
        at a random place of the equivalent surface, height ζ ~ N(m_ζ σ, (s_ζ σ)²) above its
        mean plane; local gap h − ζ. No adjusted parameter; the default for prediction.
    ``plane``
        on the mean plane of asperity heights; gap d. The paper's simplification.
    ``offset``
        on a plane h_0 above that; gap d − h_0.

    Parameters
    ----------
    law : AbstractAsperityLaw, optional
        The law of each contact; `Hermite` by default.
    seat : {"rough", "plane", "offset"}, optional
        Where particles rest.
    h_0 : float, optional
        Height of the seat above the mean asperity plane [m], for ``offset``.
    zeta_mean, zeta_std : float, optional
        Mean m_ζ and width s_ζ of the seat heights in units of σ [1], for ``rough``. Where
        particles lie is the main uncertainty of the model: valleys (m_ζ < 0) and peaks differ
        tenfold in load.
    shadow : {"footprint", "projected", "covered", "none"}, optional
        The share ς of nominal area in which loaded particles keep asperities apart: their
        larger contact area, their projected area when loaded, the projected area of all
        particles, or nothing. Asperity loads and areas are multiplied by 1 − ς.

    Notes
    -----
    Valid while x/2 ≪ R and x ≪ the lateral wavelength. Against explicit particles on explicit
    rough surfaces the ``rough`` seat gives the load share within 2, 6 and 10 % at x/σ = 2, 1
    and 0.67; ``plane`` and ``offset`` have the wrong sign of the load dependence.

    References
    ----------
    Horng et al. 2022, doi:10.3390/lubricants10070164, corrected as docs/errata.md says.

    Examples
    --------
    >>> law = Series()
    >>> law.seat, law.shadow
    ('rough', 'footprint')
    """

    name = "series"
    title = "Two contacts in series (consistent model)"
    year = 2026
    citation = (
        "thirdbody consistent model: two contacts in series on a rough seat, "
        "after Horng et al. 2022, Lubricants 10(7), 164"
    )
    doi = "10.3390/lubricants10070164"
    provenance = "derived"
    valid_range = "x/2 ≪ R, A_t < 0.2"

    law: AbstractAsperityLaw = field(default_factory=Hermite)
    seat: str = choice("where particles rest", "rough", "plane", "offset", default="rough")
    h_0: float = quantity("h_0", "m", "seat height above the mean asperity plane", default=0.0)
    zeta_mean: float = quantity("m_ζ", "1", "mean seat height over σ", default=0.0)
    zeta_std: float = quantity("s_ζ", "1", "width of seat heights over σ", default=1.0, gt=0)
    shadow: str = choice(
        "area in which particles keep asperities apart",
        "footprint",
        "projected",
        "covered",
        "none",
        default="footprint",
    )

    @property
    def tip_radius(self) -> float:
        """Radius of the contacting tips over the size x [1]."""
        return 0.5

    def _problems(self) -> list[str]:
        out = []
        name = type(self).__name__
        if not isinstance(self.law, AbstractAsperityLaw):
            out.append(f"{name}.law = {self.law!r} must be a law of one contact, e.g. Hermite()")
        elif not self.law.scale_free:
            out.append(
                f"{name}.law = {type(self.law).__name__} has a length of its own; particles of "
                "all sizes need a law that only knows indentation over radius, e.g. Hermite()"
            )
        if self.h_0 != 0 and self.seat != "offset":
            out.append(
                f"{name}.h_0 = {self.h_0:g} has no meaning with seat = {self.seat!r}; "
                "set seat = 'offset'"
            )
        if self.seat != "rough" and (self.zeta_mean, self.zeta_std) != (0.0, 1.0):
            out.append(f"{name}.zeta_mean and zeta_std need seat = 'rough', not {self.seat!r}")
        return out

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
        shape = x.shape
        x, eps = x.ravel(), np.maximum(1 - gap / x, 0.0).ravel()
        sides = contact_sides(surfaces, particle)
        law = squeezed_particle(self.law, *sides, self.tip_radius)
        values = law(eps) * x[:, None] ** 2
        one, two = (x * part for part in law.indentations(eps))
        names = np.array(REGIMES)[law.sides[0].regime(one / x)]
        return {
            "force": values[:, 0].reshape(shape),
            "area_1": values[:, 1:4].sum(axis=1).reshape(shape),
            "area_2": values[:, 4].reshape(shape),
            "delta_1": one.reshape(shape),
            "delta_2": two.reshape(shape),
            "regime": np.where(eps > 0, names, "none").reshape(shape),
        }

    def probe(self, eps: Array, *, surfaces: MaterialPair, particle: Material) -> ParticleSpots:
        law = squeezed_particle(self.law, *contact_sides(surfaces, particle), self.tip_radius)
        one = np.ones((len(eps), 1))
        return law.spots(one, eps[:, None], share=None, number=one)

    def response(
        self, surfaces: MaterialPair, roughness: Roughness, particles: Particles
    ) -> ParticleResponse:
        sides = contact_sides(surfaces, particles.material)
        parts = []
        for weight, sizes in particles.diameter.components:
            scale, shape = sizes.standardised()
            average: SizeAverage | SeatAverage
            average = size_average(self.law, *sides, shape, self.tip_radius)
            if self.seat == "rough":
                average = seat_average(average, self.zeta_std * roughness.sigma / scale)
            density = particles.areal_density * weight
            parts.append(Part(average, scale, density, offset=self.seat_offset(roughness)))
        return SeatedParticles(parts, self.shadow, self._coverage(particles))

    def seat_offset(self, roughness: Roughness) -> float:
        """Mean gap minus d [m]."""
        if self.seat == "rough":
            return roughness.y_s - self.zeta_mean * roughness.sigma
        return -self.h_0

    def _coverage(self, particles: Particles) -> float:
        """Projected particle area per nominal area [1]."""
        return 2 * self.tip_radius * particles.coverage

    def warnings(
        self, surfaces: MaterialPair, roughness: Roughness, particles: Particles
    ) -> list[str]:
        out = []
        # πd²/4 of a particle of size x is πx²·tip_radius/2
        radius = particles.diameter.mean_diameter * math.sqrt(0.5 * self.tip_radius)
        if self.seat == "rough" and radius > 0.5 * roughness.R:
            out.append(
                f"mean particle radius {radius:.3g} m is not small against the asperity "
                f"radius R = {roughness.R:.3g} m: the rough seat takes the surface under a "
                "particle as flat"
            )
        return out


class SeatAverage:
    """A size average over a Gaussian seat of some width; lengths in the size of the particles.

    The average over seats is a sum over local gaps weighted with the density of ζ, tabulated
    once as Chebyshev series in the mean gap.
    """

    def __init__(self, average: SizeAverage, width: float):
        self.average, self.width, self.particle = average, width, average.particle
        span = (average.top - average.bottom) / width
        if span > WIDEST:
            raise InvalidValue(
                f"particle diameters range over {span:.3g} widths of the seat, more than "
                f"{WIDEST:g}: the surface is smooth for such particles, use seat = 'plane'"
            )
        self.floor = average.floor
        self.low = average.bottom - NORMAL_REACH * width
        self.high = average.top + NORMAL_REACH * width

    @cached_property
    def nodes(self) -> tuple[Array, Array]:
        """Gaps, and the weighted columns there."""
        gaps, weight, values = self.average.nodes(self.width)
        return gaps, weight[:, None] * values / (self.width * math.sqrt(2 * math.pi))

    @cached_property
    def table(self) -> PiecewiseChebyshev:
        """Every column as a function of the mean gap."""
        panels = min(math.ceil((self.high - self.low) / (3 * self.width)), 32)
        return PiecewiseChebyshev(
            self._over_seats,
            np.linspace(self.low, self.high, panels + 1),
            tolerance=1e-12,
            max_depth=20,
            kinds=KINDS,
        )

    def _over_seats(self, mean_gap: Array) -> Array:
        """The columns averaged over seats by quadrature: (N, 7)."""
        gaps, weights = self.nodes
        z = (self.average.bottom - mean_gap) / self.width
        out = special.ndtr(z)[:, None] * self.floor
        order = np.argsort(mean_gap)
        for piece in in_pieces(len(order), weights[:1000].size):
            part = order[piece]
            lowest, highest = mean_gap[part[0]], min(mean_gap[part[-1]], gaps[-1])
            near = slice(
                np.searchsorted(gaps, min(lowest, highest) - 2 * NORMAL_REACH * self.width),
                np.searchsorted(gaps, highest + NORMAL_REACH * self.width),
            )
            z = (mean_gap[part, None] - gaps[near]) / self.width
            out[part] += np.exp(-0.5 * z * z) @ weights[near]
        return out

    def __call__(self, gap: Array) -> Array:
        """Every column: (N, 7)."""
        low, high = self.low, self.high
        out = self.table(np.clip(gap, low, high))
        out[gap > high] = 0.0
        out[gap < low] = self.floor
        return out

    def spots(self, mean_gap: Array, splits: Sequence[float] = ()) -> ParticleSpots:
        """Every squeezed particle at mean gaps (N,)."""
        average = self.average
        reach = NORMAL_REACH * self.width
        lowest, highest = mean_gap.min() - reach, mean_gap.max() + reach
        gaps, rise, weights = average.gaps(self.width, splits)
        near = slice(*np.searchsorted(gaps, [lowest, highest]))
        gaps, rise, weights = gaps[near], rise[near], weights[near]
        if lowest < average.bottom:
            # loads no longer change there, but depths do
            edges = np.array(
                sorted({lowest, min(max(lowest, 0.0), average.bottom), average.bottom})
            )
            edges = _cut(edges, SPOT_WIDTHS * self.width)
            below, weight = panel_rule(edges, SPOT_NODES[0])
            gaps = np.concatenate([below, gaps])
            rise = np.concatenate([average.top - below, rise])
            weights = np.concatenate([weight, weights])
        x, delta, weight = average.of_sizes(gaps[:, None], rise[:, None], splits, SIZE_NODES)
        z = (mean_gap[:, None] - gaps) / self.width
        return self.particle.spots(
            x,
            np.maximum(delta, 0.0),
            share=np.exp(-0.5 * z * z) / (self.width * math.sqrt(2 * math.pi)),
            number=weight * weights[:, None],
        )

    def derivatives(self, gap: Array, columns: tuple[int, ...]) -> Array:
        """Some columns with two derivatives: (N, len(columns), 3)."""
        low, high = self.low, self.high
        out = self.table.derivatives(np.clip(gap, low, high), columns)
        out[gap > high] = 0.0
        out[gap < low] = 0.0
        out[gap < low, :, 0] = self.floor[list(columns)]
        return out


@lru_cache(maxsize=512)
def seat_average(average: SizeAverage, width: float) -> SeatAverage:
    """The cached average over seats."""
    return SeatAverage(average, width)


class Part:
    """Particles of one shape of size distribution: an average, scaled; gap = d + offset."""

    def __init__(
        self, average: SizeAverage | SeatAverage, scale: float, density: float, *, offset: float
    ):
        self.average, self.scale, self.offset = average, scale, offset
        self.density = density
        self.factor = density * scale**2
        top = average.top if isinstance(average, SizeAverage) else average.high
        self.reach = scale * top - offset

    @property
    def marks(self) -> Array:
        """Ends of the panels of the tables, as separations d [m]."""
        average = self.average
        if isinstance(average, SeatAverage):
            gaps = average.table.edges
        else:
            below = average.lower.edges if average.lower is not None else np.empty(0)
            gaps = np.concatenate([below, average.top - average.upper.edges**2])
        return self.scale * gaps - self.offset

    def load(self, d: Array, shadow: int) -> Array:
        values = self.average.derivatives((d + self.offset) / self.scale, (0, shadow))
        return self.factor / self.scale ** np.arange(3) * values

    def columns(self, d: Array) -> Array:
        return self.factor * self.average((d + self.offset) / self.scale)

    def spots(self, d: Array, splits: Sequence[float] = ()) -> ParticleSpots:
        found = self.average.spots((d + self.offset) / self.scale, splits)
        return found.of_size(self.scale, self.density)


DEEPEST_SQUEEZE = 1e3
"""Squeeze over diameter at which a particle must be fully plastic for the law to have a meaning."""
NORMAL_REACH = 9.0
"""Standard deviations of the seat beyond which nothing is counted."""
SEAT_NODES = (14, 10)
"""Nodes of a panel in the gap as wide as the seat, and of a much narrower one."""
SPOT_NODES, SPOT_WIDTHS, SIZE_NODES = (14, 12), 2.0, 10
"""The same for spots, whose sums need 1e-9 of the load; width of their panels; nodes of sizes."""
WIDEST = 1e5


class SeatedParticles(ParticleResponse):
    """The sum over the components of the size distribution."""

    def __init__(self, parts: list[Part], shadow: str, coverage: float):
        self.parts, self.coverage = parts, coverage
        self.shadow = shadow
        self.reach = max(part.reach for part in parts)
        self._shadow_column = COLUMNS.index(shadow) if shadow in COLUMNS else 0

    @property
    def marks(self) -> Array:  # type: ignore[override]
        if self.shadow not in COLUMNS:  # what does not change takes no load from asperities
            return np.empty(0)
        return np.concatenate([part.marks for part in self.parts])

    def load(self, d: Array) -> tuple[Array, Array]:
        total = np.sum([part.load(d, self._shadow_column) for part in self.parts], axis=0)
        force, shadow = total[:, 0], total[:, 1]
        return force, self._shadow(shadow)

    def _shadow(self, values: Array) -> Array:
        if self.shadow in COLUMNS:
            return values
        fixed = np.zeros_like(values)
        if self.shadow == "covered":
            fixed[..., 0] = self.coverage
        return fixed

    def fields(self, d: Array) -> dict[str, Array]:
        total = np.sum([part.columns(d) for part in self.parts], axis=0)
        total = np.maximum(total, 0.0)  # rounding of the other regimes
        return {
            "F_sa": total[:, 0],
            "A_e": total[:, 1],
            "A_ep": total[:, 2],
            "A_p": total[:, 3],
            "A_sa2": total[:, 4],
            "shadow": self._shadow(total[:, self._shadow_column][:, None])[:, 0],
        }

    def spots(self, d: Array, splits: Sequence[float] = ()) -> list[ParticleSpots]:
        return [part.spots(d, splits) for part in self.parts]


def together_in(responses: Sequence[ParticleResponse]) -> ParticleResponse:
    """Populations side by side, as one sum where their shadows follow one rule."""
    if len(responses) == 1:
        return responses[0]
    seated = [each for each in responses if isinstance(each, SeatedParticles)]
    if len(seated) < len(responses) or len({each.shadow for each in seated}) > 1:
        return ParticlesTogether(responses)
    return SeatedParticles(
        [part for each in seated for part in each.parts],
        seated[0].shadow,
        sum(each.coverage for each in seated),
    )
