"""One particle between two flats: two contacts in series, in lengths of its size."""

from __future__ import annotations

import math
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING, Protocol

import numpy as np

from ...errors import InvalidValue, Mistake
from ...numerics.chebyshev import PiecewiseChebyshev
from ...numerics.roots import bracketed_root
from ...populations.materials import reduced_modulus
from ...quantities.arguments import names_arguments
from ...quantities.say import value_of
from ..base import REGIMES, AbstractAsperityLaw, OneParticle, Squeezed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from ...populations.materials import Material, MaterialPair
    from ...populations.shape import Angular

    Array = NDArray[np.float64]
    Number = float | Array
    Index = NDArray[np.intp]
    Body = tuple[float, float, float]

__all__ = ["Side", "SideForm", "SqueezedParticle", "contact_sides"]

MOST_DOUBLED = 200
"""Times that an indentation is doubled in search of a contact as wide as its particle."""


class SideForm(Protocol):
    """Form of a side of a particle that is no sphere; frozen, so that equal ones share a table."""

    def side(
        self, law: AbstractAsperityLaw, E_star: float, H: float, nu: float, R: float
    ) -> Side | None:
        """The contact of this side, or None for a sphere's."""


class Side:
    """One contact of a particle of unit size: load and area against indentation.

    Lengths are in units of the size x, loads in x²·Pa, areas in x². The tip radius is R. The
    area stops at the great circle, πR/2 (π/4 for a sphere) or ``breadth`` π/4; from there on the
    load is mean pressure × great circle, and constant where the law has no plastic pressure to go
    on to.

    Attributes
    ----------
    kinks : array (..., k)
        Increasing reduced indentations where the formula changes; constant beyond the last.
    spreads : bool
        The contact may become wider than the particle was.
    """

    spreads = False
    knows_sink = False
    """`sink` is not the whole indentation, but what was computed."""
    sink_bends: Sequence[float] = ()
    """Indentations over x at which `sink` bends."""

    def __init__(
        self,
        law: AbstractAsperityLaw,
        E_star: Number,
        H: Number,
        nu: float,
        R: float = 0.5,
        breadth: float | None = None,
    ):
        self.law, self.H, self.R = law.bound(R=R, E_star=E_star, H=H, nu=nu), H, R
        self.delta_1 = self.law.yield_interference(R=R, E_star=E_star, H=H)
        # reduced area of the great circle, that is of breadth π/4
        great_circle = 0.5 if breadth is None else 0.25 * breadth / R
        self.full = great_circle / self.delta_1
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
        return self._indentation_at_area(self.full)

    def _indentation_at_area(self, area: Number) -> Array:
        """Reduced interference at which the law reaches a reduced area."""
        full = np.asarray(area, dtype=float)

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
            for _ in range(MOST_DOUBLED):
                short = excess(high, full[rest]) < -1e-9 * full[rest]
                if not np.any(short):
                    break
                high = np.where(short, 2 * high, high)  # areas that jump down stay behind y
            else:
                raise InvalidValue(
                    f"the law {self.law.name} has no indentation at which the contact of a "
                    "particle is as wide as the particle: its area must grow with the indentation",
                    code=Mistake.RANGE,
                )
            root = bracketed_root(excess, low, high, (full[rest],))
            y[rest] = np.where(excess(high, full[rest]) <= 0, high, root)
        for point in self.law.breakpoints:  # where the area jumps past what is asked for
            y = np.where(np.abs(y - point) <= 1e-13 * point, point, y)
        return y

    def reduced_force(self, y: Array) -> Array:
        """Load over `unit` at y = δ/δ_1."""
        if not self.plateau:
            y = np.minimum(y, self.cap)
        force = self.law.reduced("force", y)
        over = y >= self.cap  # there the area of the law may jump past the great circle
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

    def both(self, delta: Array) -> tuple[Array, Array]:
        """Load and area."""
        return self.force(delta), self.area(delta)

    def sink(self, delta: Array) -> Array:
        """Depth of the impression in the surface, of an indentation δ; both over x."""
        return delta

    def regime(self, delta: Array) -> Index:
        """Index into `REGIMES`; beyond the great circle a contact that can yield is plastic."""
        y = delta / self.delta_1
        order = np.array([REGIMES.index(branch.regime) for branch in self.law.branches])
        index = order[np.searchsorted(self.law.breakpoints, y, side="right")]
        return np.where((y >= self.cap) & self.plateau, REGIMES.index("plastic"), index)

    def loads_around(self, y: float) -> tuple[float, float]:
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
            below, at = self.loads_around(y)
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


class SqueezedParticle(OneParticle):
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

    def __init__(
        self,
        law: AbstractAsperityLaw,
        first: Body,
        second: Body,
        R: float = 0.5,
        forms: tuple[SideForm | None, SideForm | None] = (None, None),
        shape: Angular | None = None,
    ):
        self.key = (law, first, second, R, forms, shape)
        self.equal = first == second and forms[0] == forms[1]

        def side_of(body: Body, form: SideForm | None) -> Side:
            return (form and form.side(law, *body, R)) or Side(law, *body, R)

        upper = side_of(first, forms[0])
        self.sides = (upper, upper if self.equal else side_of(second, forms[1]))
        self.tip_radius, self.breadth, self.shape = R, 2 * R, shape
        if shape is not None:
            self.breadth = shape.breadth
        self.yields = (float(self.sides[0].delta_1), float(self.sides[1].delta_1))
        self.hardness = (float(self.sides[0].H), float(self.sides[1].H))
        self.great_circle = self.breadth * math.pi / 4
        self.spreads = any(side.spreads for side in self.sides)
        self.knows_sink = (self.sides[0].knows_sink, self.sides[1].knows_sink)
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
                below, at = side.loads_around(y)
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
            hardness = value_of(max(float(side.H) for side in self.sides), "Pa", 3)
            modulus = value_of(float(min(first[0], second[0])), "Pa", 3)
            raise InvalidValue(
                f"the hardness {hardness} is so high against the contact modulus {modulus} that a "
                f"particle would stay elastic beyond {self.kinks[-1]:.3g} times its diameter; the "
                "contact law holds "
                "for small indentations only (check the units of E and H)",
                code=Mistake.BEYOND,
            )
        self._split_table = None if self.equal else self._tabulate_split()
        if not self.equal:
            self.kinks = np.array(sorted({*self.kinks, *self._area_crossings()}))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SqueezedParticle) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)

    def _solve_split(self, eps: Array) -> Array:
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
        return bracketed_root(excess, low, high, (eps,))

    def _tabulate_split(self) -> PiecewiseChebyshev:
        v = np.log(self.kinks)
        # elastic up to the first: one share, or nearly, where friction on the faces tells
        v = np.append(v[0] - (30 if self.spreads else 1), v)
        self._lowest = math.exp(v[0] + 0.1) if self.spreads else 0.5 * self.kinks[0]
        return PiecewiseChebyshev(lambda x: self._solve_split(np.exp(x))[:, None], v)

    def _area_crossings(self) -> list[float]:
        """Values of ε at which the two contact areas change order."""
        from scipy.optimize import brentq

        # between two kinks areas may change order twice
        closer = [np.linspace(*ends, 24)[1:-1] for ends in pairwise(self.kinks)]
        grid = np.geomspace(self.kinks[0], self.kinks[-1], 400)
        grid = np.unique(np.concatenate([grid, *closer]))
        smallest: Number = 1e-13 * self.great_circle

        def areas(eps: ArrayLike) -> tuple[Array, Array]:
            one, two = self.indentations(np.atleast_1d(np.asarray(eps, dtype=float)))
            return self.sides[0].area(one), self.sides[1].area(two)

        def difference(eps: ArrayLike) -> Array:
            return np.subtract(*areas(eps))

        values = difference(grid)
        if self.spreads:  # the area of a pancake magnifies what rounding leaves of its height
            wide = np.maximum(*areas(grid)) / self.great_circle
            smallest = 1e-12 * self.great_circle * np.maximum(wide, 1.0) ** 2
        sign = np.where(np.abs(values) > smallest, np.sign(values), 0.0)

        def crossing(i: int) -> float:
            low, high = grid[i], grid[i + 1]
            ends = [float(difference(end)[0]) for end in (low, high)]
            if ends[0] * ends[1] > 0:  # one lies on a jump, to rounding: seen from its other side
                return float(low if np.sign(ends[0]) != sign[i] else high)
            return float(brentq(lambda e: float(difference(e)[0]), low, high, xtol=1e-16))

        return [crossing(int(i)) for i in np.flatnonzero(sign[1:] * sign[:-1] < 0)]

    def indentations(self, eps: Array) -> tuple[Array, Array]:
        """δ_1 and δ_2 over x."""
        if self._split_table is None:
            half = 0.5 * eps
            return half, half
        low, high = self._lowest, self.kinks[-1]
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

    def _load(self, eps: Array, one: Array, force: Array) -> Array:
        """Load over x² at ε, of which ``one`` and the load ``force`` are the first side's."""
        for begin, end, number, _ in self.held:
            if number == 0 and np.any(here := (eps > begin) & (eps < end)):
                force = np.where(here, self.sides[1].force(eps - one), force)
        limit = min(float(side.limit[0]) for side in self.sides)
        return np.where(eps > self.kinks[-1], limit, force)

    def at(self, eps: Array) -> Squeezed:
        one, two = depths = self.indentations(eps)
        force, area = self.sides[0].both(one)
        if self.equal:
            return Squeezed(load=force, depths=depths, areas=(area, area))
        load = self._load(eps, one, force)
        return Squeezed(load=load, depths=depths, areas=(area, self.sides[1].area(two)))

    def sinks(self, depths: tuple[Array, Array]) -> tuple[Array, Array]:
        one, two = depths
        sink = self.sides[0].sink(one)
        return sink, sink if self.equal else self.sides[1].sink(two)

    @cached_property
    def sink_bends(self) -> Sequence[float]:
        """Squeezes ε at which the sink into either side bends."""
        if self.equal:
            return [2 * delta for delta in self.sides[0].sink_bends]
        bends = set()
        for side, other in (self.sides, self.sides[::-1]):
            for delta in side.sink_bends:
                force = float(side.force(np.array([delta]))[0])
                if force < float(other.limit[0]) * (1 - 1e-12):
                    bends.add(delta + other.indentation(force))
        return sorted(bends)

    def __call__(self, eps: Array) -> Array:
        out = OneParticle.__call__(self, eps)
        if self.spreads:
            out[:, 6] = np.maximum(out[:, 6], out[:, 5])
        return out

    def regime(self, side: int, depth: Array) -> Index:
        return self.sides[side].regime(depth)


@lru_cache(maxsize=512)
def squeezed_particle(
    law: AbstractAsperityLaw,
    first: Body,
    second: Body,
    R: float = 0.5,
    forms: tuple[SideForm | None, SideForm | None] = (None, None),
    shape: Angular | None = None,
) -> SqueezedParticle:
    """The cached response of one particle; sides are (E*, H, ν), and what is no sphere there."""
    return SqueezedParticle(law, first, second, R, forms, shape)


@names_arguments
def contact_sides(surfaces: MaterialPair, particle: Material) -> tuple[Body, Body]:
    """E*, and H and ν of the softer body, where the particle meets surface 1 and surface 2."""

    def side(surface: Material) -> Body:
        softer = min(surface, particle, key=lambda body: body.H)
        return reduced_modulus(surface, particle), softer.H, softer.nu

    return side(surfaces.first), side(surfaces.second)


DEEPEST_SQUEEZE = 1e3
"""Squeeze over diameter at which a particle must be fully plastic for the law to have a meaning."""
