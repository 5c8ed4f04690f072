r"""Connectors: how often a pair of contacts fails to close because of dust.

One pair is that of `contact_probability`: a sphere or crossed cylinders come down on particles at
random. Here there are several kinds of them, the contacts wipe, and pairs stand side by side and
in series:

.. math::

    f = 1 - P(W), \qquad f_{all} = 1 - (1 - f^m)^n

for n contacts in series, each of m spots of which one is enough. Dust that conducts closes the
circuit, too, wherever it is squeezed. The wipe moves the sphere by s along the flat. A particle
lies in the way over a disc of radius :math:`\sqrt{2R_s x}` about the spot; those that were under
the first spot and lie outside the last are left behind, and of those in front the share c is
pushed aside, so that at the place :math:`u = r^2/(2R_s x)` there are, of all,

.. math:: w(u) = 1 - c\,[1 - \theta(u, s)], \qquad
          \int_0^u \theta\,du = \frac{\text{area in both discs}}{\pi\,2R_s x} .
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InvalidValue, Mistake, Problem
from ..laws.particle.series import Series
from ..laws.particle.tension import breaks
from ..populations.conduction import conducts
from ..populations.distributions import Monodisperse
from ..populations.materials import MaterialPair
from ..populations.particles import Particles
from ..quantities.say import value_of
from ..quantities.units import say
from ..quantities.value import Value, count_field, items_of, quantity
from .contact_probability import (
    CELLS,
    MOST_CELLS,
    PER_PARTICLE,
    SURE,
    boulders_among,
    compound,
)

if TYPE_CHECKING:
    from types import EllipsisType

    from numpy.typing import ArrayLike, NDArray

    from ..laws.base import AbstractParticleLaw
    from ..populations.distributions import Distribution
    from ..populations.materials import Material

    Array = NDArray[np.float64]
    Yes = NDArray[np.bool_]

__all__ = ["Connector"]


def __dir__() -> list[str]:
    return sorted(__all__)


BY_MATERIAL = "by material"
STEP, FEWEST, ROUGHLY = 0.02, 250, 100
"""Widths of classes of size in ln x, how many there are at least, and to see what sizes occur."""
WIDE = 1.5
"""Particles of a class between sizes this far apart, or as good as equal, have one size."""
EQUAL = 1 + 1e-6
SHARED = 20.0
"""Loads of a curve within this factor share their steps."""
APART = 1e-3, 0.05
"""Bounds farther apart than this, or than this part, are computed anew, with steps of their own."""
NEVER = math.log(1e-18)
"""What is less likely than this does not show in a number near 1."""
SQUEEZES = 4096
"""Squeezes at which the load of a particle is tabled."""
HEIGHTS, COARSE = 40, 256
"""Heights at which contacts stand on insulating dust, where other dust conducts, and steps
of the load there."""
ENDS, TILTS = 250, 60
"""Loads and tilts at which it is looked whether an answer is certain."""
NONE = 1e-15
"""Classes with less than this part of all particles are left out."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Connector(Value):
    r"""Contacts in series that close on dust.

    .. math:: f_{all} = 1 - (1 - f^m)^n

    Parameters
    ----------
    radius : float
        Radius R_s of the sphere that meets a flat, or of both crossed cylinders [m].
    surfaces : MaterialPair
        The two contacts.
    particles : Particles or sequence of Particles
        Dust: of each kind material, diameters x, particles per area η_a.
    contacts : float, optional
        Contacts in series n, all of which must close [1].
    parallel : float, optional
        Spots m of each contact of which one is enough, as of a bifurcated spring [1].
    wipe : float, optional
        Way s along the flat after touch [m].
    pushed_aside : float, optional
        Part c of the particles before the wipe that it pushes aside [1]. Nobody can predict it;
        without it none is, and the wipe changes nothing.
    conducting : tuple of str, optional
        Names of the kinds of dust that conduct; ``"by material"`` for those whose resistivity is
        known, or that are of a metal of the library. What a population says of itself
        (``conducts``) counts before this.
    law : AbstractParticleLaw, optional
        What one particle does between the contacts.

    Raises
    ------
    InvalidValue
        A radius that is not above the particles, particles that break, names that no dust
        has, or numbers of contacts that are not whole.

    Notes
    -----
    As `thirdbody.systems.contact_probability.ContactProbability`, with the same limits. All
    contacts meet dust of their own, so that they fail independently. A particle stays where it
    lies on the flat unless it is pushed aside. Where dust conducts, the contacts stand at the
    height h at which insulating particles carry the load, and fail if no conducting one is taller:
    :math:`f = \int e^{-N_c(h)}\,dF(h)` with the distribution F of that height.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.connector import Connector
    >>> bronze = tb.materials["CuSn8"]
    >>> dust = tb.Particles(material=tb.materials["quartz"], areal_density=1e6,
    ...                     diameter=tb.distributions.Monodisperse(mean=10e-6))
    >>> plug = Connector(radius=2e-3, surfaces=tb.MaterialPair(bronze, bronze), particles=dust,
    ...                  contacts=20)
    >>> f"{plug.failure(0.0):.4f} of one, {plug.failure_of_all(0.0):.2f} of 20, without force"
    '0.1181 of one, 0.92 of 20, without force'
    """

    radius: float = quantity(
        "R_s", "m", "radius of the sphere or crossed cylinders", gt=0, usual=10
    )
    surfaces: MaterialPair
    particles: tuple[Particles, ...]
    contacts: float = count_field("n", "contacts in series", default=1.0, ge=1, le=1e6)
    parallel: float = count_field(
        "m", "spots of each contact of which one is enough", default=1.0, ge=1, le=100
    )
    wipe: float = quantity("s", "m", "way along the flat after touch", default=0.0, ge=0)
    pushed_aside: float | None = quantity(
        "c", "1", "part of the dust before the wipe that it pushes aside", default=None, ge=0, le=1
    )
    conducting: tuple[str, ...] = ()
    law: AbstractParticleLaw = Series()

    def __post_init__(self) -> None:
        several = (self.particles,) if isinstance(self.particles, Particles) else self.particles
        object.__setattr__(self, "particles", items_of(several))
        names = (self.conducting,) if isinstance(self.conducting, str) else self.conducting
        object.__setattr__(self, "conducting", tuple(names))
        Value.__post_init__(self)

    def _problems(self) -> list[str]:
        out: list[str] = []
        names = [name_of(dust, i) for i, dust in enumerate(self.particles)]
        for name in self.conducting:
            if name not in (*names, BY_MATERIAL):
                allowed_names = ", ".join(map(say, names))
                out.append(
                    Problem(
                        "conducting",
                        f"must name particles, here {allowed_names}",
                        say(name),
                        code=Mistake.KIND,
                    )
                )
        for dust, name in zip(self.particles, names, strict=True):
            if dust.strength is not None:
                out.append(
                    Problem(
                        "",
                        f"{name}: particles that break are not followed here; leave out strength",
                        code=Mistake.BEYOND,
                    )
                )
            if boulders := boulders_among(dust.diameter, self.radius):
                out.append(
                    Problem(
                        "radius",
                        f"must be above the particles of {name}, of which {boulders} reach it: "
                        "contacts come down on dust, not on boulders",
                        value_of(self.radius, "m"),
                        hint="give the sizes an end, or take a larger radius",
                        code=Mistake.ORDER,
                    )
                )
        return out

    # ------------------------------------------------------------------ what lies in the way
    @property
    def in_the_way(self) -> float:
        """Mean number N of particles that keep one pair apart, after the wipe [1]."""
        return sum(kind.number(0.0) for kind in self._kinds())

    @property
    def threshold(self) -> float:
        """Load of the mean particle in the way, squeezed to its diameter [N]."""
        kinds = self._kinds()
        weight = sum(float(kind.in_the_way.sum()) for kind in kinds)
        return sum(float(kind.in_the_way @ (kind.most * kind.x**2)) for kind in kinds) / weight

    @property
    def reach(self) -> float:
        """Radius of the disc in which the mean particle in the way lies [m]."""
        kinds = self._kinds()
        weight = sum(float(kind.in_the_way.sum()) for kind in kinds)
        mean = sum(float(kind.in_the_way @ kind.x) for kind in kinds) / weight
        return math.sqrt(2 * self.radius * mean)

    def breaking(self) -> list[str]:
        """Kinds of dust whose mean particle in the way would break before it is pressed in."""
        return [
            kind.name
            for kind in self._kinds()
            if breaks(kind.one, kind.material, x=kind.mean, squeeze=1.0)
        ]

    def _kinds(self, *, conduct: bool | None = None) -> list[_Kind]:
        return [
            _Kind(self, dust, name_of(dust, i))
            for i, dust in enumerate(self.particles)
            if dust.areal_density > 0 and conduct in (None, self._conducts(dust, name_of(dust, i)))
        ]

    def _conducts(self, dust: Particles, name: str) -> bool:
        if dust.conducts is not None:
            return dust.conducts
        return name in self.conducting or (BY_MATERIAL in self.conducting and bool(conducts(dust)))

    # ------------------------------------------------------------------ how often it fails
    def failure(self, load: float) -> float:
        """How often one pair stays open: in the middle of `bounds`.

        Parameters
        ----------
        load : float
            Load W [N].
        """
        return float(np.mean(self.bounds(load)))

    def failure_of_all(self, load: float) -> float:
        """How often a connector of all its contacts stays open.

        Parameters
        ----------
        load : float
            Load W on each contact [N].
        """
        return self.of_all(self.failure(load))

    def failures(self, loads: ArrayLike) -> Array:
        """How often one pair stays open under many loads: as `failure`, for a curve.

        Parameters
        ----------
        loads : array_like
            Loads W [N].
        """
        every = np.asarray(loads, float)
        if self.conducting or any(dust.conducts for dust in self.particles):
            return np.array([self.failure(float(load)) for load in every])
        kinds = self._kinds(conduct=False)
        out, left = np.empty(len(every)), every.copy()
        if every.size:
            more, less = _certain(kinds, every, 0.0)
            out[more], out[less] = 1.0, 0.0
            left[more | less] = -1.0
        while np.any(left >= 0):
            here = np.flatnonzero(left >= left.max() / SHARED)
            low, high = _open(kinds, left[here], 0.0)
            out[here] = 0.5 * (low + high)
            apart = (high - low > APART[0]) | (high - low > APART[1] * high)
            for i in here[apart & (left[here] < left[here].max())]:  # the steps are too long
                out[i] = np.mean(_open(kinds, left[[i]], 0.0))
            left[here] = -1.0
        return out

    def of_all(self, failure: float) -> float:
        """How often n contacts of m spots stay open.

        Parameters
        ----------
        failure : float
            How often one spot does [1].
        """
        return -math.expm1(self.contacts * math.log1p(-min(failure**self.parallel, 1 - 1e-16)))

    def bounds(self, load: float) -> tuple[float, float]:
        """Bounds of the failure of one pair, the load of each particle rounded.

        Parameters
        ----------
        load : float
            Load W [N].

        Raises
        ------
        InvalidValue
            A load below zero or not finite.
        """
        if not (math.isfinite(load) and load >= 0):
            raise InvalidValue("load must be finite and not below 0 N", code=Mistake.RANGE)
        insulating, conductors = self._kinds(conduct=False), self._kinds(conduct=True)
        if not conductors:
            low, high = _open(insulating, np.array([load]), 0.0)
            return float(low[0]), float(high[0])
        if not insulating:
            return 0.0, 0.0
        largest = max(float(kind.high.max()) for kind in insulating)
        heights = np.array([0.0, *np.geomspace(largest / 300, largest, HEIGHTS)])
        one = np.array([load])
        above = np.array([_open(insulating, one, h) for h in heights])[:, :, 0]
        closed = np.exp([-sum(kind.number(h) for kind in conductors) for h in heights])
        between = above[:-1] - above[1:]
        low = between[:, 0] @ closed[:-1] + above[-1, 0] * closed[-1]
        high = between[:, 1] @ closed[1:] + above[-1, 1] * closed[-1]
        return float(min(low, high)), float(max(low, high))


def name_of(dust: Particles, i: int) -> str:
    """What a kind of dust is called."""
    return dust.name or dust.material.name or f"particles {i + 1}"


class _Kind:
    """One kind of dust in size classes: how many are in the way, and the load of each."""

    def __init__(self, plug: Connector, dust: Particles, name: str) -> None:
        self.name, self.material = name, dust.material
        law: Any = (dust.law or plug.law).of_shape(dust.shape)  # type: ignore[attr-defined]
        self.one, self.table = _loads_of_one(law, plug.surfaces, dust.material)
        self.x, self.low, self.high, weight = _classes(dust.diameter)
        self.in_the_way = 2 * math.pi * plug.radius * dust.areal_density * weight
        """In the way before the wipe, at touch."""
        self.k = plug.wipe / np.sqrt(2 * plug.radius * self.x)
        """Wipe over the radius of the disc."""
        self.aside = plug.pushed_aside or 0.0 if plug.wipe > 0 else 0.0

    @property
    def mean(self) -> float:
        """Diameter of the mean particle in the way [m]."""
        return float(self.in_the_way @ self.x / self.in_the_way.sum())

    @property
    def most(self) -> float:
        """Load over x² of a particle squeezed to its diameter [Pa]."""
        return float(self.table[-1, 0])

    @property
    def heaviest(self) -> float:
        """Load of the largest particle, squeezed to its diameter [N]."""
        return self.most * float(self.high.max()) ** 2

    def count_within(self, u: Array, of: int | EllipsisType = ...) -> Array:
        """Particles of each class, or of one, nearer than u = r²/(2 R_s x)."""
        inside = np.maximum(u, 0.0)
        if not self.aside:
            return self.in_the_way[of] * inside
        shared = overlap(inside, self.k[of])
        return self.in_the_way[of] * ((1 - self.aside) * inside + self.aside * shared)

    def number(self, height: float) -> float:
        """Particles in the way while the contacts stand at this height [m]."""
        return float(self.count_within(1 - height / self.x).sum())

    def number_below(self, loads: Array, height: float) -> Array:
        """Number of particles that carry at most these loads [N]."""
        from .compound_sums import add_numbers_below, fill_squeezes

        reach = 1 - height / self.x
        sure = loads * (1 + SURE)
        logs = np.log(np.where(sure > 0, sure, 1.0))
        out = np.zeros(len(loads))
        if not self.aside:
            classes = self.low, self.high, self.in_the_way, reach
            add_numbers_below(sure, logs, *classes, self.table, out)
            return out
        squeeze = np.empty(len(loads))
        for i, ends in enumerate(zip(self.low, self.high, strict=True)):
            fill_squeezes(sure, logs, *ends, self.table, squeeze)
            out += self.count_within(reach[i], i) - self.count_within(reach[i] - squeeze, i)
        return out


@lru_cache(maxsize=64)
def _loads_of_one(law: Any, surfaces: MaterialPair, material: Material) -> tuple[Any, Array]:
    """What one particle does, and the table of its squeezes under loads over x² [Pa]."""
    from .compound_sums import tabulate_squeezes

    one = law.one(surfaces=surfaces, particle=material)
    kinks = np.asarray(one.kinks)
    eps = np.unique([*np.linspace(0, 1, SQUEEZES + 1), *kinks[kinks < 1]])
    load = np.maximum.accumulate(np.asarray(one.at(eps).load, float))
    return one, tabulate_squeezes(eps, load)


@lru_cache(maxsize=64)
def _classes(diameter: Any) -> tuple[Array, Array, Array, Array]:
    """Mean sizes of classes, between which sizes each is spread [m], and its part of the mean."""
    parts = []
    for share, component in diameter.components:
        if isinstance(component, Monodisperse):
            size = np.array([component.mean])
            parts.append((size, size, size, share * size))
            continue
        low, high = component.support
        low = max(low, float(component.ppf(1e-9)), 1e-4 * high)
        roughly = _edges(component, low, high, ROUGHLY)
        amount = component.partial_moment(1, roughly[:-1], roughly[1:])
        some = np.flatnonzero(amount > NONE * amount.sum())
        low, high = max(low, roughly[some[0]]), roughly[some[-1] + 1]
        edges = _edges(component, low, high, max(FEWEST, math.ceil(math.log(high / low) / STEP)))
        first, second = (component.partial_moment(n, edges[:-1], edges[1:]) for n in (1, 2))
        some = first > NONE * first.sum()
        x = second[some] / first[some]
        wide = (edges[1:] / np.maximum(edges[:-1], 1e-300))[some]
        wide = np.where((wide > EQUAL) & (wide < WIDE), wide, 1.0)
        # spread evenly over ln x, about the same mean
        begins = x * np.where(wide > 1, np.log(wide) / np.maximum(wide - 1, EQUAL - 1), 1.0)
        parts.append((x, begins, begins * wide, share * first[some]))
    x, low, high, weight = (np.concatenate(column) for column in zip(*parts, strict=True))
    return x, low, high, weight


def _edges(diameter: Distribution, low: float, high: float, count: int) -> Array:
    """Edges of classes that are equally wide in ln x, with the kinks of the sizes among them."""
    first, last = diameter.support
    edges = np.unique([first, *np.geomspace(low, high, count + 1), last, *diameter.kinks])
    return np.asarray(edges, float)


def _open(kinds: list[_Kind], loads: Array, height: float) -> tuple[Array, Array]:
    """How often these particles carry more than loads at a height: bounds [1]."""
    number = sum(kind.number(height) for kind in kinds)
    top = float(loads.max())
    if not number > 0 or top == 0:
        none = np.full(len(loads), -math.expm1(-number))
        return none, none
    more, less = _certain(kinds, loads, height)
    if np.all(more | less):
        certain = np.where(more, 1.0, 0.0)
        return certain, certain
    step = top / min(max(CELLS if height == 0 else COARSE, PER_PARTICLE * number), MOST_CELLS)
    if len(kinds) == 1 and len(kinds[0].x) == 1 and height == 0:
        jump = kinds[0].heaviest
        if jump < top + step:  # the jumps of one size lie on multiples of the step
            step = jump / math.ceil(jump / step)
    places = np.asarray(step * np.arange(math.floor(top / step * (1 + SURE)) + 1), float)
    at = np.floor(loads / step * (1 + SURE)).astype(int)
    out = []
    for ends in (places, np.asarray((places + step) * (1 - 2 * SURE), float)):
        below = np.sum([kind.number_below(ends, height) for kind in kinds], axis=0)
        mass = np.diff(below, prepend=0.0) / number
        out.append(np.maximum(1 - compound(number, mass)[at], 0.0))
    return out[1], out[0]


def _certain(kinds: list[_Kind], loads: Array, height: float) -> tuple[Yes, Yes]:
    r"""Under which loads these particles carry more, and under which less, as good as always.

    By Chernoff's bounds, for every :math:`\theta > 0`,

    .. math:: P(S \le W) \le e^{\theta W}\,\langle e^{-\theta S}\rangle, \qquad
              P(S > W) \le e^{-\theta W}\,\langle e^{\theta S}\rangle

    with the load of each particle rounded to the safe side.
    """
    in_the_way = [kind for kind in kinds if kind.number(height) > 0]
    if not in_the_way:
        return loads < 0, loads >= 0
    most = max(kind.heaviest for kind in in_the_way)
    ends = most * np.geomspace(1e-5, 1, ENDS)
    count = np.diff(
        np.sum([kind.number_below(ends, height) for kind in in_the_way], axis=0), prepend=0
    )
    low = np.geomspace(1e-3, 1e8, TILTS) / most
    high = np.geomspace(1e-3, 500, TILTS) / most
    begins = np.array([0.0, *ends[:-1]])
    below = np.expm1(-low[:, None] * begins) @ count
    above = np.expm1(high[:, None] * ends) @ count
    more = np.min(low * loads[:, None] + below, axis=1) < NEVER
    less = np.min(above - high * loads[:, None], axis=1) < NEVER
    return more, less


def overlap(u: ArrayLike, k: ArrayLike) -> Array:
    """Area shared by a disc of radius √u and one of radius 1 whose centres are k apart, over π.

    >>> overlap([0.25, 1.0, 1.0], [0.0, 0.0, 2.0]).tolist()
    [0.25, 1.0, 0.0]
    """
    u, k = np.broadcast_arrays(np.asarray(u, float), np.asarray(k, float))
    r = np.sqrt(u)
    apart, within = k >= 1 + r, k <= np.abs(1 - r)
    safe_k, safe_r = np.where(apart | within, 1.0, k), np.where(apart | within, 1.0, r)
    first = np.arccos(np.clip((safe_k**2 + safe_r**2 - 1) / (2 * safe_k * safe_r), -1, 1))
    second = np.arccos(np.clip((safe_k**2 + 1 - safe_r**2) / (2 * safe_k), -1, 1))
    sides = (safe_k + safe_r) ** 2 - 1, 1 - (safe_k - safe_r) ** 2
    lens = safe_r**2 * first + second - 0.5 * np.sqrt(np.maximum(sides[0] * sides[1], 0.0))
    return np.where(apart, 0.0, np.where(within, np.minimum(u, 1.0), lens / np.pi))
