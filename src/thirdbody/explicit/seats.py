"""Where particles lie on a map of heights: rules that give places, and what they mean for a model.

All rules but `GivenSeats` start from random places. The heights at which particles then rest are
close to Gaussian, so that their mean and width, as ``zeta_mean`` and ``zeta_std`` of
`thirdbody.particle.Series`, bring the statistical model to the same seat.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..errors import InvalidValue, Mistake, Problem
from ..quantities.value import Value, quantity

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Index = NDArray[np.int64]

__all__ = [
    "SEATS",
    "AbstractSeats",
    "DownhillSeats",
    "GivenSeats",
    "HighestSeats",
    "RandomSeats",
    "SeatHeights",
    "SettledSeats",
    "SphereSeats",
    "SummitSeats",
    "ValleySeats",
    "height_at",
    "seat_heights",
    "seats_named",
]

HIGH = 2.5
"""ζ/σ above which seats decide the load of particles under small loads."""
MOST_DRAWS = 100
"""Rounds in which particles that overlap are drawn again."""


class Seated(NamedTuple):
    """Places [m], and how far the underside is held above the heights there [m]."""

    x: Array
    y: Array
    lift: Array


class SeatHeights(NamedTuple):
    """Heights of seats over σ: what brings the statistical model to them."""

    mean: float
    """m_ζ = ``zeta_mean``"""
    std: float
    """s_ζ = ``zeta_std``"""
    high: float
    """Share of seats above 2.5 σ"""
    high_gaussian: float
    """The same of a Gaussian of this mean and width"""


class AbstractSeats(Value):
    """A rule that says where particles lie."""

    __slots__ = ()

    @abstractmethod
    def draw(self, z: Array, spacing: float, size: Array, rng: np.random.Generator) -> Seated:
        """Places of particles of these sizes on a periodic map."""

    def room(self, z: Array) -> float:
        """How many particles a map has places for."""
        return math.inf


@dataclass(frozen=True, slots=True, kw_only=True)
class RandomSeats(AbstractSeats):
    """Anywhere: ζ has the heights of the surface."""

    def draw(self, z: Array, spacing: float, size: Array, rng: np.random.Generator) -> Seated:
        x, y = _random_places(z, spacing, len(size), rng)
        return Seated(x, y, np.zeros(len(size)))


@dataclass(frozen=True, slots=True, kw_only=True)
class SettledSeats(AbstractSeats):
    """The lowest of some random spots.

    Parameters
    ----------
    spots : float, optional
        How many [1].
    within : float, optional
        Radius of the circle in which they lie [m].
    """

    spots: float = quantity("k", "1", "spots to choose from", default=5.0, ge=1, le=1000)
    within: float = quantity("r", "m", "radius in which they lie", default=0.5e-6, gt=0)

    def draw(self, z: Array, spacing: float, size: Array, rng: np.random.Generator) -> Seated:
        return _best(z, spacing, len(size), rng, round(self.spots), self.within, -1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class HighestSeats(AbstractSeats):
    """The highest of some random spots; fields as `SettledSeats`."""

    spots: float = quantity("k", "1", "spots to choose from", default=5.0, ge=1, le=1000)
    within: float = quantity("r", "m", "radius in which they lie", default=1.5e-6, gt=0)

    def draw(self, z: Array, spacing: float, size: Array, rng: np.random.Generator) -> Seated:
        return _best(z, spacing, len(size), rng, round(self.spots), self.within, 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class DownhillSeats(AbstractSeats):
    """At the end of a way down the steepest descent from a random place.

    Parameters
    ----------
    distance : float, optional
        Length of the way [m].
    """

    distance: float = quantity("s", "m", "length of the way down", default=1e-6, gt=0)

    def draw(self, z: Array, spacing: float, size: Array, rng: np.random.Generator) -> Seated:
        return _descend(z, spacing, len(size), rng, self.distance)


@dataclass(frozen=True, slots=True, kw_only=True)
class ValleySeats(AbstractSeats):
    """Down the steepest descent from a random place, to its end."""

    def draw(self, z: Array, spacing: float, size: Array, rng: np.random.Generator) -> Seated:
        return _to_the_end(z, spacing, len(size), rng)


@dataclass(frozen=True, slots=True, kw_only=True)
class SummitSeats(AbstractSeats):
    """A summit each, in random order."""

    def draw(self, z: Array, spacing: float, size: Array, rng: np.random.Generator) -> Seated:
        tops = np.flatnonzero(_is_summit(z).ravel())
        if len(size) > len(tops):
            raise InvalidValue(
                Problem(
                    "seats",
                    f": {len(size)} particles for {len(tops)} summits",
                    "'summits'",
                    hint="take fewer particles or another seat",
                    code=Mistake.BEYOND,
                )
            )
        here = rng.permutation(tops)[: len(size)]
        m = z.shape[1]
        return Seated(here // m * spacing, here % m * spacing, np.zeros(len(size)))

    def room(self, z: Array) -> float:
        return int(np.count_nonzero(_is_summit(z)))


@dataclass(frozen=True, slots=True, kw_only=True)
class SphereSeats(AbstractSeats):
    """At a random place, as a sphere rests on all heights under it."""

    def draw(self, z: Array, spacing: float, size: Array, rng: np.random.Generator) -> Seated:
        x, y = _random_places(z, spacing, len(size), rng)
        return Seated(x, y, _rest(z, spacing, x, y, size))


@dataclass(frozen=True, slots=True, kw_only=True)
class GivenSeats(AbstractSeats):
    """At the places that you give.

    Parameters
    ----------
    positions : tuple of (float, float)
        x and y of each particle [m]; their number takes the place of the areal density.
    """

    positions: tuple[tuple[float, float], ...]

    def _problems(self) -> list[str]:
        try:
            places = np.asarray(self.positions, dtype=float)
        except (TypeError, ValueError):
            places = np.empty(0)
        if places.ndim != 2 or places.shape[1] != 2 or not np.all(np.isfinite(places)):
            return [
                Problem(
                    "positions",
                    "must be pairs (x, y) of finite lengths [m], one each",
                    code=Mistake.SHAPE,
                )
            ]
        object.__setattr__(self, "positions", tuple(map(tuple, places.tolist())))
        return []

    def draw(self, z: Array, spacing: float, size: Array, rng: np.random.Generator) -> Seated:
        x, y = np.asarray(self.positions, dtype=float).T
        return Seated(x % (z.shape[0] * spacing), y % (z.shape[1] * spacing), np.zeros(len(x)))


SEATS: dict[str, type[AbstractSeats]] = {
    "random": RandomSeats,
    "settled": SettledSeats,
    "downhill": DownhillSeats,
    "valleys": ValleySeats,
    "highest": HighestSeats,
    "summits": SummitSeats,
    "sphere": SphereSeats,
}
"""Every rule by the word that study files use."""


def seats_named(seats: object) -> AbstractSeats:
    """The rule that a word, an array of positions or a rule itself stands for."""
    if isinstance(seats, AbstractSeats):
        return seats
    if isinstance(seats, str):
        if seats in SEATS:
            return SEATS[seats]()
        options = ", ".join(repr(name) for name in SEATS)
        raise InvalidValue(
            Problem(
                "seats",
                f"must be one of {options}, or positions (N, 2) [m]",
                repr(seats),
                code=Mistake.OPTION,
            )
        )
    try:
        places = np.asarray(seats, dtype=float)
    except (TypeError, ValueError):
        raise InvalidValue(
            Problem(
                "seats", "must be a word or positions (N, 2) [m]", repr(seats), code=Mistake.KIND
            )
        ) from None
    if places.ndim != 2 or places.shape[1] != 2:
        raise InvalidValue(
            f"seats: positions of shape {places.shape} must be (N, 2) [m]", code=Mistake.SHAPE
        )
    return GivenSeats(positions=tuple(map(tuple, places.tolist())))


def height_at(z: Array, spacing: float, x: Array, y: Array) -> Array:
    """Heights between the points of a periodic map, bilinear [m]."""
    n, m = z.shape
    a, b = x / spacing, y / spacing
    i, j = np.floor(a).astype(np.int64), np.floor(b).astype(np.int64)
    s, t = a - i, b - j
    low = (1 - s) * z[i % n, j % m] + s * z[(i + 1) % n, j % m]
    high = (1 - s) * z[i % n, (j + 1) % m] + s * z[(i + 1) % n, (j + 1) % m]
    return (1 - t) * low + t * high


def placed_apart(
    seats: AbstractSeats, z: Array, spacing: float, size: Array, rng: np.random.Generator
) -> tuple[Seated, int]:
    """Places where particles do not overlap, as far as that goes, and how many pairs still do."""
    places = seats.draw(z, spacing, size, rng)
    fixed = isinstance(seats, (GivenSeats, SummitSeats))
    for _ in range(0 if fixed else MOST_DRAWS):
        second = _overlaps(places, size, z.shape, spacing)[:, 1]
        if not len(second):
            return places, 0
        again = np.unique(second)
        new = seats.draw(z, spacing, size[again], rng)
        for old, drawn in zip(places, new, strict=True):
            old[again] = drawn
    return places, len(_overlaps(places, size, z.shape, spacing))


def seat_heights(zeta: Array) -> SeatHeights:
    """Mean, width and tail of heights over σ."""
    if not len(zeta):
        return SeatHeights(math.nan, math.nan, math.nan, math.nan)
    mean, std = float(np.mean(zeta)), float(np.std(zeta))
    gauss = 0.5 * math.erfc((HIGH - mean) / (std * math.sqrt(2))) if std > 0 else float(mean > HIGH)
    return SeatHeights(mean, std, float(np.mean(zeta > HIGH)), gauss)


# -------------------------------------------------------------------------- rules
def _random_places(z: Array, spacing: float, count: int, rng: np.random.Generator) -> Array:
    side = np.array(z.shape) * spacing
    return np.ascontiguousarray((rng.random((count, 2)) * side).T)


def _best(
    z: Array,
    spacing: float,
    count: int,
    rng: np.random.Generator,
    spots: int,
    within: float,
    sign: float,
) -> Seated:
    """Place of the largest ``sign`` × height among ``spots`` places in a circle."""
    middle = _random_places(z, spacing, count, rng)
    away = within * np.sqrt(rng.random((count, spots)))
    turn = 2 * math.pi * rng.random((count, spots))
    x = (middle[0][:, None] + away * np.cos(turn)) % (z.shape[0] * spacing)
    y = (middle[1][:, None] + away * np.sin(turn)) % (z.shape[1] * spacing)
    best = np.argmax(sign * height_at(z, spacing, x, y), axis=1) if count else np.empty(0, int)
    row = np.arange(count)
    return Seated(x[row, best], y[row, best], np.zeros(count))


NEIGHBOURS = [(a, b) for a in (-1, 0, 1) for b in (-1, 0, 1) if (a, b) != (0, 0)]


def _descend(
    z: Array, spacing: float, count: int, rng: np.random.Generator, distance: float
) -> Seated:
    """Along the gradient in steps of half a pixel, until a step would lead up."""
    slopes = [(np.roll(z, -1, axis) - np.roll(z, 1, axis)) / (2 * spacing) for axis in (0, 1)]
    side = np.array(z.shape)[:, None] * spacing
    at = np.array(_random_places(z, spacing, count, rng))
    height, going = height_at(z, spacing, *at), np.ones(count, bool)
    steps = max(1, math.ceil(distance / (0.5 * spacing)))
    for _ in range(steps):
        down = np.stack([-height_at(slope, spacing, *at) for slope in slopes])
        steep = np.hypot(*down)
        ahead = (at + distance / steps * down / np.where(steep > 0, steep, 1.0)) % side
        low = height_at(z, spacing, *ahead)
        going &= low < height
        if not np.any(going):
            break
        at, height = np.where(going, ahead, at), np.where(going, low, height)
    return Seated(at[0].copy(), at[1].copy(), np.zeros(count))


def _to_the_end(z: Array, spacing: float, count: int, rng: np.random.Generator) -> Seated:
    """From point to point of the grid, each the steepest way down, until there is none."""
    n, m = z.shape
    fall, points = np.zeros((n, m)), np.arange(n * m).reshape(n, m)
    to = points.copy()
    for a, b in NEIGHBOURS:
        slope = (z - np.roll(z, (-a, -b), axis=(0, 1))) / math.hypot(a, b)
        here = slope > fall
        fall[here] = slope[here]
        to[here] = np.roll(points, (-a, -b), axis=(0, 1))[here]
    next_ = to.ravel()
    x, y = _random_places(z, spacing, count, rng)
    at = np.round(x / spacing).astype(np.int64) % n * m + np.round(y / spacing).astype(np.int64) % m
    while np.any(next_[at] != at):
        at = next_[at]
    return Seated(at // m * spacing, at % m * spacing, np.zeros(count))


def _is_summit(z: Array) -> NDArray[np.bool_]:
    out = np.ones(z.shape, bool)
    for a, b in NEIGHBOURS:
        out &= z > np.roll(z, (a, b), axis=(0, 1))
    return out


def _rest(z: Array, spacing: float, x: Array, y: Array, size: Array) -> Array:
    """How far a sphere's underside is held above the height at its place [m]."""
    n, m = z.shape
    out = np.zeros(len(x))
    centre_height = height_at(z, spacing, x, y)
    for k in range(len(x)):
        radius = size[k] / 2
        reach = math.floor(radius / spacing) + 1
        i = round(x[k] / spacing) + np.arange(-reach, reach + 1)
        j = round(y[k] / spacing) + np.arange(-reach, reach + 1)
        away = (i * spacing - x[k])[:, None] ** 2 + (j * spacing - y[k]) ** 2
        inside = away < radius**2
        if np.any(inside):
            rise = radius - np.sqrt(radius**2 - np.where(inside, away, 0.0))
            heights = np.where(inside, z[np.ix_(i % n, j % m)] - rise, -math.inf)
            out[k] = max(0.0, float(np.max(heights)) - centre_height[k])
    return out


def _overlaps(places: Seated, size: Array, shape: tuple[int, int], spacing: float) -> Index:
    """Pairs of particles that overlap (P, 2), the second to be drawn again."""
    from scipy.spatial import cKDTree

    if len(size) < 2:
        return np.empty((0, 2), np.int64)
    side = np.array(shape) * spacing
    at = np.stack([places.x, places.y], axis=1) % side
    reach = min(float(np.max(size)), 0.499 * float(np.min(side)))
    pairs = cKDTree(at, boxsize=side).query_pairs(reach, output_type="ndarray")
    apart = at[pairs[:, 0]] - at[pairs[:, 1]]
    apart -= side * np.round(apart / side)
    close = np.hypot(*apart.T) < (size[pairs[:, 0]] + size[pairs[:, 1]]) / 2
    overlapping = pairs[close]
    return overlapping[np.lexsort((overlapping[:, 1], overlapping[:, 0]))]
