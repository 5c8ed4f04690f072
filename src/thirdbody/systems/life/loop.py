r"""Particles, gap and surfaces in one set of equations.

At a given gap and roughness every rate is affine in the numbers of particles,

.. math:: \dot y = M(d,\sigma)\,y + r(d,\sigma), \qquad p(d; y, \sigma) = p

with the numbers in the oil or in a dry contact, those embedded in either surface, wear depths,
roughness, dents thrown, and the volume that has gone each way. So the gap is one root per
evaluation, and the Jacobian is M and one outer product,

.. math:: J = M + \frac{\partial (M y + r)}{\partial d} \otimes \frac{\partial d}{\partial y}

Every column of M keeps volume, and so does J: the sum of what is stored and what has gone is a
linear invariant, which the integrator keeps to rounding.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .contact_tables import ContactTables, Pressed
from .particle_curves import POWERS
from .pieces import break_up
from .surfaces import RunningIn

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["Gap", "Layout", "Loop", "Rates", "Setting"]

INDEX = {name: i for i, name in enumerate(POWERS)}
FINER = "finer than the classes"
STEP = 1e-5
"""Step in the separation over σ, for slopes."""
SURFACES = (1, 2)


@dataclass(frozen=True, eq=False, kw_only=True)
class Setting:
    """What a contact in a history is run with, beside its tables.

    Attributes
    ----------
    sliding_speed : float
        v_s [m/s].
    area : float
        Nominal area of all contacts together [m²].
    worn_area : two floats
        Of each surface, that is worn in turn [m²].
    shares : array (K,)
        Volume of the debris in each class [1].
    debris : two ints
        Kinds that are the debris of surfaces 1 and 2; -1 where nothing can wear.
    stays : float
        Part of the particles that sit deeper than half their radius and stay embedded [1].
    running_in : RunningIn or None
    """

    sliding_speed: float
    area: float
    worn_area: tuple[float, float]
    shares: Array
    debris: tuple[int, int]
    stays: float = 0.0
    running_in: RunningIn | None = None


class Gap(NamedTuple):
    """The root of a balance of loads."""

    d: float
    """Separation [m]."""
    film_share: float
    """Part of the load that the oil carries [1]; 0 of a dry contact."""


class Rates(NamedTuple):
    """Rates at one gap, affine in the unknowns; but for what wear sets free, which is frozen."""

    matrix: Array
    """M [1/s] (n, n)."""
    constant: Array
    """r (n,)."""
    births: Array
    """𝒢 of the numbers, daughters by parents [1/s] (J, J)."""
    release: Array
    """Change of M y with y through the rate at which surfaces wear [1/s] (n, n)."""


@dataclass(frozen=True, eq=False)
class Layout:
    """Where the unknowns stand in one vector: blocks by name."""

    sizes: dict[str, int]
    places: dict[str, slice] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        start = 0
        for name, size in self.sizes.items():
            self.places[name] = slice(start, start + size)
            start += size

    def __getitem__(self, name: str) -> slice:
        return self.places[name]

    def __contains__(self, name: str) -> bool:
        return name in self.places

    @property
    def count(self) -> int:
        """Number of unknowns."""
        return sum(self.sizes.values())


class Loop(ABC):
    """A contact with particles in it, and where they come from and go.

    Parameters
    ----------
    tables : ContactTables
    setting : Setting
    flows : sequence of str
        Names of the ways in and out; each is an unknown for each kind, a volume [m³].

    Notes
    -----
    Numbers are ordered kind by kind, and in each by class: J = kinds · classes.
    """

    pool: str
    """The block of the numbers that move: "oil" or "contact"."""
    last: float = 0.0
    """Where the root of the gap was last, in its own unknown."""

    def __init__(self, tables: ContactTables, setting: Setting, flows: tuple[str, ...]):
        self.tables, self.setting = tables, setting
        self.kinds, self.classes = len(tables.kinds), tables.classes.count
        self.flows = (*flows, "worn 1", "worn 2", FINER)
        J = self.kinds * self.classes
        sizes = {self.pool: J}
        if setting.stays > 0:
            sizes |= {"bound_1": J, "bound_2": J}
        sizes |= {"wear_1": 1, "wear_2": 1, "sigma": 1, "thrown_1": 1, "thrown_2": 1}
        sizes |= {"dents_1": 1, "dents_2": 1}
        sizes |= {f"flow {name}": self.kinds for name in self.flows}
        self.layout = Layout(sizes)
        self.volumes = np.tile(tables.classes.volumes, self.kinds)
        """Of one particle of each number [m³]: (J,)."""
        self.sizes = np.tile(tables.classes.mean_power(1), self.kinds)

    @property
    def warm(self) -> tuple[float, ...]:
        """From where the next root is searched, and how well the tables are known."""
        return (*self._start(), self.tables.particles.error, self.tables.spots.error)

    def start_warm(self, warm: tuple[float, ...]) -> None:
        """Search the next root from where another loop had `warm`, with its tables' errors.

        Parameters
        ----------
        warm : tuple of float
        """
        *start, particles, spots = warm
        self._start_from(*start)
        for table, error in ((self.tables.particles, particles), (self.tables.spots, spots)):
            table.error = max(table.error, error)

    # ------------------------------------------------------------------ what kinds of loops say
    def _start(self) -> tuple[float, ...]:
        """From where the next root of the gap is searched."""
        return (float(self.last),)

    def _start_from(self, *start: float) -> None:
        (self.last,) = start

    @abstractmethod
    def find_gap(self, y: Array) -> Gap:
        """The separation in a state."""

    @abstractmethod
    def gap_slopes(self, y: Array, gap: Gap) -> Array:
        """∂d/∂y of every unknown: (n,)."""

    @abstractmethod
    def standing(self, y: Array, d: float) -> Array:
        """Particles per area of contact for one of each in the pool [1/m²]: (J, J)."""

    def in_contact(self, y: Array, d: float) -> Array:
        """Particles of the pool per area of contact [1/m²]: (J,)."""
        return self.standing(y, d) @ y[self.layout[self.pool]]

    @abstractmethod
    def add_exchange(self, out: Rates, y: Array, state: Pressed) -> None:
        """Add what comes into the pool and leaves it, besides debris."""

    @abstractmethod
    def passes(self, side: int) -> float:
        """Times per second that a place of a surface meets the particles [1/s]; 0 if dry."""

    @property
    def breaks(self) -> bool:
        """Whether particles of some kind break."""
        return any(kind.strength is not None for kind in self.tables.kinds)

    @property
    def one_area(self) -> float:
        """Nominal area of one contact [m²]."""
        return self.setting.area

    # ------------------------------------------------------------------ one state
    def sigma_of(self, y: Array) -> float:
        """σ of a state, kept in the range of the tables [m]."""
        low, high = self.tables.span
        return min(max(float(y[self.layout["sigma"]][0]), low), high)

    def present(self, y: Array, d: float) -> Array:
        """Particles per area of contact η [1/m²], embedded ones with them: (J,)."""
        eta = self.in_contact(y, d)
        for side in SURFACES:
            if f"bound_{side}" in self.layout:
                eta = eta + y[self.layout[f"bound_{side}"]] / self.setting.worn_area[side - 1]
        return np.maximum(eta, 0.0)

    def shape_numbers(self, numbers: Array) -> Array:
        """(J,) as (kinds, classes)."""
        return numbers.reshape(self.kinds, self.classes)

    def press_at(self, y: Array, d: float) -> Pressed:
        """Everything at a separation."""
        sigma = self.sigma_of(y)
        return self.tables.press_at(d, eta=self.shape_numbers(self.present(y, d)), sigma=sigma)

    def columns(self, state: Pressed, name: str) -> Array:
        """A quantity of one particle of each number: (J,)."""
        return state.per_particle[:, :, INDEX[name]].ravel()

    @cached_property
    def _softer(self) -> tuple[float, float]:
        """What part of the asperities' wear each surface bears, as `Wear` has it."""
        one, two = self.tables.contact.surfaces.first.H, self.tables.contact.surfaces.second.H
        return (0.5, 0.5) if one == two else (float(one < two), float(one > two))

    def rates(self, y: Array, d: float) -> Rates:
        """M and r at a separation; y says where asperities are out of reach, and how fast wears."""
        count, J = self.layout.count, len(self.volumes)
        square = np.zeros((2, count, count))
        out = Rates(square[0], np.zeros(count), np.zeros((J, J)), square[1])
        state = self.press_at(y, d)
        standing = self.standing(y, d)
        rows = [self._wear_row(state, standing, side) for side in SURFACES]
        for side, (row, constant, _) in zip(SURFACES, rows, strict=True):
            self._add_wear(out, side, row, constant)
        self._add_roughness(out, y, state, rows)
        self._add_dents(out, state, standing)
        self.add_exchange(out, y, state)
        if self.setting.stays > 0:
            self._add_release(out, y, rows)
        return out

    def pieces(self, d: float, sigma: float) -> Array:
        """What one of each number is once all that breaks at d is broken: (J, J)."""
        out = np.eye(len(self.volumes))
        if not self.breaks:
            return out
        broken = self.tables.broken(d, sigma)
        for i, kind in enumerate(self.tables.kinds):
            if kind.strength is not None:
                mine = slice(i * self.classes, (i + 1) * self.classes)
                out[mine, mine] = break_up(
                    broken[i], classes=self.tables.classes, ratio=kind.strength.ratio
                )
        return out

    def _wear_row(self, state: Pressed, standing: Array, side: int) -> tuple[Array, float, float]:
        """Volume worn per second from a surface, by number of every block, and without particles.

        (n,), constant, and of the constant what asperities wear under the shadow as it is.
        """
        v, area, layout = self.setting.sliding_speed, self.setting.area, self.layout
        worn = state.asperities["worn"] * self._softer[side - 1]
        per_particle = self.columns(state, f"wear_{side}")
        if state.bare > 0:
            per_particle = per_particle - self.columns(state, "shadow") * worn
        row = np.zeros(layout.count)
        row[layout[self.pool]] = v * area * (per_particle @ standing)
        for other in SURFACES:
            if f"bound_{other}" not in layout:
                continue
            held = -self.columns(state, "shadow") * worn * (state.bare > 0)
            if other != side:
                held = held + self.columns(state, f"fixed_{side}")
            row[layout[f"bound_{other}"]] = v * area * held / self.setting.worn_area[other - 1]
        constant = v * area * worn * (state.bare > 0)
        return row, constant, v * area * worn * state.bare

    def wear_rate(self, y: Array, state: Pressed, side: int) -> float:
        """Wear depth of a surface per time [m/s]."""
        row, constant, _ = self._wear_row(state, self.standing(y, state.d), side)
        return (float(row @ y) + constant) / self.setting.worn_area[side - 1]

    def _add_wear(self, out: Rates, side: int, row: Array, constant: float) -> None:
        layout, kind = self.layout, self.setting.debris[side - 1]
        depth = layout[f"wear_{side}"]
        out.matrix[depth] += row / self.setting.worn_area[side - 1]
        out.constant[depth] += constant / self.setting.worn_area[side - 1]
        if kind < 0:
            return
        pool = layout[self.pool].start + kind * self.classes + np.arange(self.classes)
        number = self.setting.shares / self.tables.classes.volumes
        out.matrix[pool] += np.multiply.outer(number, row)
        out.constant[pool] += number * constant
        flow = layout[f"flow worn {side}"].start + kind
        out.matrix[flow] += row
        out.constant[flow] += constant
        mine = slice(kind * self.classes, (kind + 1) * self.classes)
        out.births[mine] += np.maximum(np.multiply.outer(number, row[layout[self.pool]]), 0.0)

    def _add_roughness(
        self, out: Rates, y: Array, state: Pressed, rows: list[tuple[Array, float, float]]
    ) -> None:
        law = self.setting.running_in
        if law is None:
            return
        h = state.d + self.tables.mean_plane(state.sigma)
        place, area = self.layout["sigma"], self.setting.worn_area
        sigma = float(y[place][0])
        if law.length is not None:
            slope = law.slope(sigma, separation=h)
            for (row, constant, _), over in zip(rows, area, strict=True):
                out.matrix[place] += slope * row / over
                out.constant[place] += slope * constant / over
            return
        by_asperities = tuple(bare / over for (_, _, bare), over in zip(rows, area, strict=True))
        out.constant[place] += law.rate(
            sigma,
            separation=h,
            wear=(0.0, 0.0),
            by_asperities=(by_asperities[0], by_asperities[1]),
        )

    def _add_dents(self, out: Rates, state: Pressed, standing: Array) -> None:
        pool = self.layout[self.pool]
        for side in SURFACES:
            rate = self.passes(side)
            for name, column in (("thrown", "dent_area"), ("dents", "dents")):
                per_particle = self.columns(state, f"{column}_{side}")
                out.matrix[self.layout[f"{name}_{side}"], pool] += rate * (per_particle @ standing)

    def _add_release(self, out: Rates, y: Array, rows: list[tuple[Array, float, float]]) -> None:
        """Embedded particles come free when their surface has worn by half their size."""
        pool = self.layout[self.pool]
        for side, (row, constant, _) in zip(SURFACES, rows, strict=True):
            depth_rate = max(float(row @ y) + constant, 0.0) / self.setting.worn_area[side - 1]
            free = 2 * depth_rate / self.sizes
            embedded = np.arange(*self.layout[f"bound_{side}"].indices(self.layout.count))
            out.matrix[embedded, embedded] -= free
            mine = np.arange(pool.start, pool.stop)
            out.matrix[mine, embedded] += free
            if depth_rate > 0:
                freed_per_volume = 2 / self.sizes * y[embedded] / self.setting.worn_area[side - 1]
                out.release[embedded] -= np.multiply.outer(freed_per_volume, row)
                out.release[mine] += np.multiply.outer(freed_per_volume, row)

    def add_flow(self, out: Rates, name: str, columns: slice, numbers: Array) -> None:
        """Book volume that goes a way per number of a block [1/s]: (J,)."""
        place = self.layout[f"flow {name}"]
        start = columns.start
        for kind in range(self.kinds):
            mine = slice(kind * self.classes, (kind + 1) * self.classes)
            at = slice(start + mine.start, start + mine.stop)
            out.matrix[place.start + kind, at] += numbers[mine] * self.volumes[mine]

    def add_passage(self, out: Rates, numbers: Array, *, pieces: Array) -> None:
        """Let numbers per one and time (J,) pass a gap and come out as pieces."""
        pool = self.layout[self.pool]
        change = (pieces - np.eye(len(numbers))) * numbers
        out.matrix[pool, pool] += change
        self.add_flow(out, FINER, pool, -(self.volumes @ change) / self.volumes)

    def add_retention(self, out: Rates, numbers: Array, state: Pressed) -> Array:
        """Embed a part of what passes, numbers per one and time (J,); returns it [1]."""
        if self.setting.stays == 0:
            return np.zeros_like(numbers)
        pool = self.layout[self.pool]
        parts = [self.setting.stays * self.columns(state, f"sunk_{side}") for side in SURFACES]
        total = np.minimum(parts[0] + parts[1], 1.0)
        scale = np.divide(total, parts[0] + parts[1], out=np.zeros_like(total), where=total > 0)
        mine = np.arange(pool.start, pool.stop)
        for side, share in zip(SURFACES, parts, strict=True):
            embedded = self.layout[f"bound_{side}"].start + np.arange(len(numbers))
            out.matrix[embedded, mine] += numbers * share * scale
        out.matrix[mine, mine] -= numbers * total
        return total

    def bearing(self, state: Pressed) -> Array:
        """∂p/∂η of one particle of each number [Pa m²]: (J,)."""
        shaded = state.asperities["force"] * (state.bare > 0)
        return self.columns(state, "load") - self.columns(state, "shadow") * shaded

    def slope_over_unknowns(self, y: Array, state: Pressed) -> Array:
        """∂p/∂y at a fixed separation [Pa]: (n,)."""
        out = np.zeros(self.layout.count)
        bears = self.bearing(state)
        out[self.layout[self.pool]] = bears @ self.standing(y, state.d)
        for side in SURFACES:
            if (name := f"bound_{side}") in self.layout:
                out[self.layout[name]] = bears / self.setting.worn_area[side - 1]
        return out

    def add_source(self, out: Rates, name: str, numbers: Array) -> None:
        """Book numbers that come into the pool per time (J,), and their volume."""
        out.constant[self.layout[self.pool]] += numbers
        volume = self.shape_numbers(numbers * self.volumes).sum(axis=1)
        out.constant[self.layout[f"flow {name}"]] += volume

    # ------------------------------------------------------------------ for the integrator
    def derivative(self, time: float, y: Array) -> Array:
        """dy/dt."""
        rates = self.rates(y, self.find_gap(y).d)
        return rates.matrix @ y + rates.constant

    def jacobian(self, time: float, y: Array) -> Array:
        """∂(dy/dt)/∂y."""
        gap = self.find_gap(y)
        here = self.rates(y, gap.d)
        value = here.matrix @ y + here.constant
        step = STEP * self.sigma_of(y)
        there = self.rates(y, gap.d + step)
        slope = (there.matrix @ y + there.constant - value) / step
        out = here.matrix + here.release + np.multiply.outer(slope, self.gap_slopes(y, gap))
        law, place = self.setting.running_in, self.layout["sigma"].start
        if law is not None:
            moved = y.copy()
            moved[place] *= 1 - 1e-6
            out[:, place] = (self.derivative(time, moved) - value) / (moved[place] - y[place])
        return out

    # ------------------------------------------------------------------ accounts
    def stored_volumes(self, y: Array) -> Array:
        """Volume of each kind that is in the oil, the contact and the surfaces [m³]: (kinds,)."""
        numbers = y[self.layout[self.pool]]
        for side in SURFACES:
            if f"bound_{side}" in self.layout:
                numbers = numbers + y[self.layout[f"bound_{side}"]]
        return self.shape_numbers(numbers * self.volumes).sum(axis=1)

    def flow(self, y: Array, name: str) -> Array:
        """Volume of each kind that has gone a way [m³]: (kinds,)."""
        return y[self.layout[f"flow {name}"]]
