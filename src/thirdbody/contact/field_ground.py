r"""The ground of particles on a rough surface that is one field of heights.

Asperities and particles press the ground at height ζ down by the mean displacement

.. math:: \frac{u(\zeta)}{\sigma} = 2\sqrt2\sum_{n=0}^{12}\left[(1-\varsigma)\,k_n^{zs}a_n
          + k_n^{pp}\beta_n\right]\mathrm{he}_n(\zeta), \qquad
          \beta_n = \frac{n_A}{E^*g}\int F_1\,\mathrm{he}_n(\zeta)\,dN(\zeta)

with F_1 of particles in gaps h − ζ + u(ζ), and particles press down the ground of asperities,
which then see the separation h + w,

.. math:: w = 2\sqrt2\sum_n k_n^{as}\beta_n\,a_n'(h + w)/a_0'(h + w) .

From h + w = 3.5 on the right side levels out, to its value at 4.0 beyond 4.5: the asperities that
touch there are higher than any of which twelve moments say something.

k_n^pp and k_n^as leave out what lies nearer than one diameter, and half of one; their n = 0 is
minus that distance, as the mean plane sinks with the nominal pressure and nothing else does.
β_n are found by iteration at separations of a table. Where a separation between two of these is
asked, it is found at more of them there, until every column is a series that leaves nothing out.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import NoEquilibrium
from ..laws.base import COLUMNS, SeatedLaw
from ..laws.field.programme import MOMENTS
from ..laws.field.table import FIRST, TAU
from ..numerics.chebyshev import PiecewiseChebyshev, chebyshev_transform
from .broken_averages import is_rough
from .field_seat import DENSITY, TINY, Seat
from .field_sums import ROUNDING, FieldSum
from .particle_averages import SeatAverage
from .particle_sums import Part, SeatedParticles
from .spots import AsperitySpots

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray
    from scipy.interpolate import BSpline

    from ..laws.spots import ParticleSpots

    Array = NDArray[np.float64]

__all__ = ["Ground", "GroundedPart", "LiftedSum", "put_on_ground"]

STEP = 0.2
"""Distance of separations of the table over σ, or over the width of the seat."""
ROUNDS, CLOSE, MEMORY, MEMORIES = 60, 1e-9, 4, (6, 4, 8)
"""Of the iteration: the most, the last change of u/σ and w, how many steps it remembers, and how
many, one after another, where a separation is solved by itself."""
BEFORE = np.array([5.0, -10.0, 10.0, -5.0, 1.0])
"""Parts of the rows above one that is solved by itself, of which the iteration begins."""
FINE, MORE = 1e-12, 6
"""Change of u/σ and w that is aimed at, in so many more rounds."""
SPOTS = 0.25
"""Width of panels of gaps of single particles over that of the seat."""
FAR = 30.0
"""Separation over σ from which asperities are as there: nothing of them is left."""
LEVEL, LEVELS = 3.5, 1.0
"""Separation over σ from which the ground under asperities levels out, and over how much more: to
that of half as much more. Beyond, terms of twelve moments are large and cancel."""
FLAT = 1.0
"""Mean slope of u over ζ from which on particles leave nothing of the surface."""
LIFTS, LEAP, CREEPS, KINK = 12, 0.5, (4, 32), 4.0
"""Chords by which the lift of asperities is found, at most; second difference of it, over the step
between two separations, from which on it may belong to another ground; steps between two
separations that show whether it does, as differences of a kink are so many times less in them."""
TERMS = 16
"""Of k_n over τ."""
FEWEST, PARTS = 12, (1e-3, 0.03, 0.3)
"""Separations that a table must keep, and parts of a step of it at which its end is tried, from
where it is expected."""
DEGREE, LEFT_OUT, LEFT_OUT_ROUGHLY, DEEPEST, ON_ROW = 9, 3e-11, 1e-7, 9, 1e-11
"""Of series between separations of the table: degree, what they leave out of u/σ, w, ln load and
areas over it, that of one of many samples, halvings, and how near a row [σ] is the row."""
SMOOTH, BLOCK, AT_ONCE = 6.0, 8, 32
"""Separation over σ from which so many steps of the table have one series, as asperities have no
say any more; and series that are solved together."""
LIFT, OF_SEATS = MOMENTS + 1, MOMENTS + 2
"""Columns of these: u_n, w, then those of each seat."""


def rows_between(lowest: float | Array, reach: float | Array, width: float | Array) -> Any:
    """How many steps a table has from the lowest separation up; the same whatever is rounded.

    Floats or arrays, for the lowest and highest separation and the width of the seat [σ].
    """
    return np.maximum(8, np.ceil((reach - lowest) / (STEP * width) - 1e-9)).astype(int)


def level_out(h: Array) -> Array:
    """Separations over σ at which the ground under asperities is read: two slopes have no step."""
    x = np.clip((h - LEVEL) / LEVELS, 0.0, 1.0)
    levels = LEVEL + LEVELS * x * (1 - x * x * (1 - 0.5 * x))
    return np.where(h > LEVEL, levels, h)


def _series_of(tau: Array) -> Array:
    """Chebyshev polynomials at each τ between 0 and 1: (N, 16)."""
    return np.asarray(np.polynomial.chebyshev.chebvander(2 * tau - 1, TERMS - 1))


class Ground:
    """Displacements of the ground over the separation, solved once for an interface.

    Attributes
    ----------
    h : array (M,)
        Separations over σ of the table.
    u : array (M, 13)
        Hermite moments of the particles' ground over σ.
    w : array (M,)
        Lift of the asperities' ground over σ.
    state : array (M, 14)
        β_n and the shadow.
    cut : bool
        Whether nothing was found at the lowest separations of the field, which are left out.
    """

    def __init__(self, field: FieldSum, seats: Sequence[Seat], apart: float):
        self.field, self.seats, self.cut = field, list(seats), False
        spectrum = field.surface.spectrum
        self.twice = 2 * math.sqrt(2) * spectrum.steeper
        x, transform = chebyshev_transform(TERMS)
        tau = 0.5 * (1 + x)
        self.k_pp, _ = spectrum.integrals_from(apart, tau, MOMENTS)
        self._k_zs = transform @ spectrum.integrals_from(0.0, tau, MOMENTS)[1]
        self._k_as = transform @ spectrum.integrals_from(0.5 * apart, tau, MOMENTS)[1]
        lowest = field.surface.lowest
        highest = max(seat.mean + DENSITY * seat.width for seat in seats)
        more = float(spectrum.height(np.array([highest]))[0]) - highest
        reach = max((seat.average.high * seat.unit + field_offset(seat, field)) for seat in seats)
        reach += max(more, 0.0)
        width = min(1.0, *(seat.width for seat in seats))
        count = int(rows_between(lowest, reach, width))
        self.h = np.linspace(lowest, max(reach, lowest + 1.0), count + 1)
        self._series: dict[int, PiecewiseChebyshev | None] = {}
        self.u, self.w, self.state = self._solve_separations()
        self._end_with_asperities()

    def _of_asperities(self, h: Array) -> Array:
        """k_n^zs a_n at h: (N, 13)."""
        surface, h = self.field.surface, np.clip(h, self.field.surface.lowest, FAR)
        columns = surface.columns(h)
        ratios = np.hstack([np.ones((len(h), 1)), columns[:, FIRST:]])
        return (_series_of(columns[:, TAU]) @ self._k_zs) * ratios * surface.load(h)[:, :1]

    def _under_asperities(self, h: Array) -> Array:
        """k_n^as a_n′/a_0′ at h, far above as where their ground levels out: (N, 13)."""
        surface, h = self.field.surface, level_out(np.clip(h, self.field.surface.lowest, FAR))
        columns, slopes = surface.columns(h), surface.columns(h, 1)
        load = surface.load(h)
        turned = columns[:, FIRST:] + slopes[:, FIRST:] * (load[:, 0] / load[:, 1])[:, None]
        ratios = np.hstack([np.ones((len(h), 1)), turned])
        return (_series_of(columns[:, TAU]) @ self._k_as) * ratios

    def _round(self, h: Array, state: Array, lift: Array) -> tuple[Array, Array]:
        """β_n and the shadow again, from those of the round before: (M, 14); and u_n."""
        beta, shade = state[:, :-1], np.clip(state[:, -1:], 0.0, 1.0)
        pressed = self._of_asperities(h + lift)
        u = self.twice * ((1 - shade) * pressed + self.k_pp * beta)
        out = np.zeros_like(state)
        for seat in self.seats:
            columns, moments = seat.sums(h, u)
            out[:, :-1] += (seat.component.factor / self.field.unit) * moments
            if seat.shadow is not None:
                out[:, -1] += seat.component.factor * columns[:, seat.shadow]
        return out, u

    def _lift(self, h: Array, beta: Array, start: Array) -> Array:
        """w where particles carry β, from one that is near: (M,)."""
        w = before = start
        miss, lowest = np.full(len(h), np.nan), self.field.surface.lowest
        for _ in range(LIFTS):
            weights = self._under_asperities(h + w)
            lift = np.maximum(self.twice * np.sum(weights * beta, axis=1), lowest - h)
            last, miss = miss, lift - w
            if np.max(np.abs(miss), initial=0.0) < 1e-12:
                return lift
            # a chord through the last two, where it is no longer than two plain steps
            with np.errstate(divide="ignore", invalid="ignore"):
                chord = miss * (w - before) / (last - miss)
            short = np.abs(chord) <= 2 * np.abs(miss)
            before, w = w, w + np.where(short, chord, miss)
        return lift

    def _solve_separations(self) -> tuple[Array, Array, Array]:
        """Solve all separations at once; those that fail or leap, one by one from the ones above.

        Of several grounds that answer the equations, the one to which surfaces come together. The
        table ends where that does, or where it is pressed flat: high ground would lie below low.
        """
        count = len(self.h)
        u, w, kept = (np.zeros((count, more)) for more in (MOMENTS + 1, 1, MOMENTS + 2))
        failed = np.zeros(count, bool)
        failed[self._iterate_states(self.h, u, w, kept)] = True
        if failed[-2:].any():
            return self._above(count, u, w, kept)
        for row in range(count - 3, -1, -1):
            whole = not failed[row] and not self._leaps(w[row : row + 3])
            whole = whole or self._solve_from_above(row, u, w, kept)
            whole = whole or self._creep_down(row, u, w, kept)
            if not whole or u[row, 1] >= FLAT:
                return self._above(row + 1, u, w, kept)
        return u, w[:, 0], kept

    def _leaps(self, lifts: Array) -> bool:
        """Whether the first of three lifts (3, 1) may belong to another ground than the others."""
        bend = abs(float(lifts[0, 0] - 2 * lifts[1, 0] + lifts[2, 0]))
        return not bend <= LEAP * (self.h[1] - self.h[0])

    def _solve_from_above(self, row: int, u: Array, w: Array, kept: Array) -> bool:
        """Solve one separation from what those above say of it; whether that goes on smoothly."""
        here = slice(row, row + 1)
        for memory in MEMORIES:
            for values in (kept, w):
                near = values[row + 1 : row + 1 + len(BEFORE)]
                values[row] = BEFORE @ near if len(near) == len(BEFORE) else near[0]
            if not len(self._iterate_states(self.h[here], u[here], w[here], kept[here], memory)):
                return not self._leaps(w[row : row + 3])
        return False

    def _creep_down(self, row: int, u: Array, w: Array, kept: Array) -> bool:
        """Solve one separation by small steps from the one above; whether they go on smoothly."""
        above, below = row + 2, row + 1
        for steps in CREEPS:
            # as if the step before had come from the separation above
            path = [
                [values[below] - (values[below] - values[above]) / steps, values[below]]
                for values in (kept, w)
            ]
            for h in np.linspace(self.h[below], self.h[row], steps + 1)[1:]:
                for memory in MEMORIES:
                    state, lift = (2 * past[-1:] - past[-2:-1] for past in map(np.array, path))
                    ground = np.zeros((1, MOMENTS + 1))
                    if not len(self._iterate_states(np.array([h]), ground, lift, state, memory)):
                        break
                else:
                    break
                path[0].append(state[0])
                path[1].append(lift[0])
                if self._leaps(np.array(path[1][-3:]) * KINK):
                    break
            else:
                u[row], w[row], kept[row] = ground[0], lift[0], state[0]
                return True
        return False

    def _iterate_states(
        self, h: Array, u: Array, w: Array, kept: Array, memory: int = MEMORY
    ) -> NDArray[np.intp]:
        """Iteration after Anderson at h from the states kept; fills u, w, gives those not found."""
        rest = np.arange(len(h))
        state = kept[rest]
        states: list[Array] = []
        misses: list[Array] = []
        left = np.full(len(rest), MORE)
        for _ in range(ROUNDS + MORE):
            lift = self._lift(h[rest], state[:, :-1], w[rest, 0])
            updated, now = self._round(h[rest], state, lift)
            misses = [*misses, updated - state][-memory:]
            states = [*states, state][-memory:]
            change = np.maximum(np.max(np.abs(now - u[rest]), axis=1), np.abs(lift - w[rest, 0]))
            u[rest], w[rest, 0], kept[rest] = now, lift, state
            if len(states) == 1:  # without particles the ground may be flat, and stay so
                change[:] = np.inf
            left = np.where((change < CLOSE) | (left < MORE), left - 1, left)
            more = (change >= FINE) & (left > 0)
            rest, left = rest[more], left[more]
            if not len(rest):
                break
            states = [past[more] for past in states]
            misses = [miss[more] for miss in misses]
            state = _next_state(states, misses)
        return rest[left == MORE]

    def _above(self, first: int, u: Array, w: Array, kept: Array) -> tuple[Array, Array, Array]:
        """The table without separations where particles, all but grown together, find no ground."""
        self._check_rows(first)
        self.h, self.cut = self.h[first:], True
        return u[first:], w[first:, 0], kept[first:]

    def _check_rows(self, first: int) -> None:
        """Refuse a table that begins so high that little of it is left."""
        if len(self.h) - first < FEWEST:
            raise NoEquilibrium(
                "no equilibrium: the ground of the particles was not found at separations up to "
                f"{self.h[first - 1]:.3g} sigma (law field)"
            )

    def _end_with_asperities(self) -> None:
        """Let the table begin where asperities on lifted ground come into their own table."""
        lowest = self.field.surface.lowest
        outside = np.flatnonzero(self.h + self.w <= lowest + ON_ROW)
        if not len(outside):
            return
        first = int(outside[-1]) + 1
        self._check_rows(first)
        rows = [every[first:] for every in (self.h, self.u, self.w, self.state)]
        (low, high), (of_low, of_high) = rows[0][:2], (rows[0] + rows[2])[:2] - lowest
        expected = max(low - of_low * (high - low) / (of_high - of_low), self.h[first - 1])
        for share in PARTS:
            h, u = np.array([expected + share * (low - expected)]), np.zeros((1, MOMENTS + 1))
            w, state = rows[2][:1, None].copy(), rows[3][:1].copy()
            failed = self._iterate_states(h, u, w, state)
            if not len(failed) and h + w[0] > lowest + ON_ROW:
                rows = [np.concatenate(two) for two in zip((h, u, w[0], state), rows, strict=True)]
                break
        self.h, self.u, self.w, self.state = rows

    @cached_property
    def _spline(self) -> BSpline:
        """u_n, w and the state between the rows, as far as they say."""
        from scipy.interpolate import make_interp_spline

        return make_interp_spline(self.h, np.column_stack([self.u, self.w, self.state]), k=5)

    def patch_moments(self, h: Array) -> Array:
        """u_n and w at h: (N, 14); beyond the table as at its end."""
        out = self._spline(np.minimum(h, self.h[-1]))[:, :OF_SEATS, None]
        self.refine(h, range(OF_SEATS), out)
        out[h > self.h[-1]] = 0.0
        out[h < self.h[0]] = np.nan
        return out[:, :, 0]

    def lifts(self, h: Array) -> Array:
        """w over σ at h with two derivatives: (N, 3); nothing beyond the table."""
        inside = np.clip(h, self.h[0], self.h[-1])
        out = np.stack([self._spline(inside, nu)[:, LIFT] for nu in range(3)], axis=1)
        self.refine(h, (LIFT,), out[:, None])
        out[h > self.h[-1]] = 0.0
        return out

    def refine(self, h: Array, columns: Sequence[int], out: Array) -> None:
        """Put columns with derivatives at h (N,), where it lies between rows: (N, K, 1 or 3)."""
        after = np.clip(np.searchsorted(self.h, h), 1, len(self.h) - 1)
        apart = np.minimum(np.abs(h - self.h[after]), np.abs(h - self.h[after - 1]))
        inside = (h > self.h[0]) & (h < self.h[-1]) & (apart > ON_ROW)
        blocks = np.unique(np.searchsorted(self._ends, after[inside]) - 1)
        new = np.array([k for k in blocks.tolist() if k not in self._series], dtype=int)
        for beside in np.split(new, np.flatnonzero(np.diff(new) > 1) + 1) if len(new) else ():
            for some in np.split(beside, range(AT_ONCE, len(beside), AT_ONCE)):
                self._fill_series(some.tolist())
        laid = [self._series[k] for k in blocks.tolist()]
        out[inside] = np.nan
        for series in dict.fromkeys(every for every in laid if every is not None):
            here = inside & (h > series.edges[0]) & (h < series.edges[-1])
            out[here] = series.derivatives(h[here], tuple(columns))[:, :, : out.shape[2]]
            out[here, :, 0] -= 1.0

    @cached_property
    def _ends(self) -> NDArray[np.intp]:
        """Rows between which columns have a series of their own: longer ones far above."""
        last = len(self.h) - 1
        near = min(int(np.searchsorted(self.h, SMOOTH)), last)
        return np.unique([*range(near), *range(near, last, BLOCK), last])

    def _fill_series(self, blocks: list[int]) -> None:
        """Lay every column with 1 added over blocks side by side; none where no ground is found."""
        series = None
        with suppress(NoEquilibrium):
            series = PiecewiseChebyshev(
                self._columns_at,
                self.h[self._ends[blocks[0] : blocks[-1] + 2]],
                degree=DEGREE,
                tolerance=LEFT_OUT_ROUGHLY if is_rough() else LEFT_OUT,
                max_depth=DEEPEST,
            )
        if series is None and len(blocks) > 1:
            for k in blocks:
                self._fill_series([k])
        else:
            self._series |= dict.fromkeys(blocks, series)

    def _columns_at(self, h: Array) -> Array:
        """Every column at separations h, solved there, with 1 added: what is small is rounding.

        Raises `NoEquilibrium` where only another ground than that of the rows beside is found.
        """
        start = self._spline(h)[:, LIFT:]
        u, solved = np.zeros((len(h), LIFT)), np.full_like(start, np.nan)
        rest = np.arange(len(h))
        for memory in (MEMORY, *MEMORIES):
            begin = start[rest] + self._miss_of_spline(h, solved - start)(h[rest])
            ground, lift, state = u[rest], begin[:, :1].copy(), begin[:, 1:].copy()
            failed = self._iterate_states(h[rest], ground, lift, state, memory)
            whole = np.abs(lift - begin[:, :1])[:, 0] <= LEAP * (self.h[-1] - self.h[-2])
            whole[failed] = False
            done, rest = rest[whole], rest[~whole]
            u[done], solved[done] = ground[whole], np.hstack([lift, state])[whole]
            if not len(rest):
                columns = [seat.logarithms(h, u) for seat in self.seats]
                return 1.0 + np.column_stack([u, solved[:, :1], *columns])
        raise NoEquilibrium("between two separations of the table")

    def _miss_of_spline(self, h: Array, miss: Array) -> BSpline:
        """What the spline misses between rows and separations h, where that is not NaN: (N, K)."""
        from scipy.interpolate import make_interp_spline

        some = ~np.isnan(miss[:, 0])
        every = np.append(self.h, h[some])
        values = np.vstack([np.zeros((len(self.h), miss.shape[1])), miss[some]])
        every, first = np.unique(every, return_index=True)
        return make_interp_spline(every, values[first], k=1)


def field_offset(seat: Seat, field: FieldSum) -> float:
    """h − (d + offset)/σ of a part."""
    return (field.rough.y_s - field.centre - seat.component.offset) / field.sigma


def _next_state(states: list[Array], misses: list[Array]) -> Array:
    """The next state: the combination of the last ones that misses least, row by row."""
    if len(states) == 1:
        return states[0] + 0.5 * misses[0]
    last, miss = states[-1], misses[-1]
    d_state = np.stack([last - earlier for earlier in states[:-1]], axis=-1)
    d_miss = np.stack([miss - earlier for earlier in misses[:-1]], axis=-1)
    size = np.max(np.abs(d_miss), axis=(1, 2))[:, None, None] + 1e-300
    weights = np.linalg.pinv(d_miss / size, rcond=1e-8) @ miss[..., None] / size
    weights = np.clip(weights, -3.0, 3.0)
    return last + miss - ((d_state + d_miss) @ weights)[..., 0]


class GroundedPart(Part):
    """A `Part` whose ground gives way."""

    def __init__(self, ground: Ground, seat: Seat):
        component = seat.component
        assert isinstance(component.average, SeatAverage)
        super().__init__(
            component.average, component.scale, component.density, offset=component.offset
        )
        self.ground, self.seat = ground, seat

    def _h(self, d: Array) -> Array:
        return self.ground.field.h(d)

    @cached_property
    def _spline(self) -> tuple[BSpline, float]:
        """Splines of ln load and of the other columns over the load, with their ends."""
        from scipy.interpolate import BSpline, make_interp_spline

        rows = self.seat.logarithms(self.ground.h, self.ground.u)
        some = rows[:, 0] > math.log(TINY)
        last = int(np.argmin(some)) if not some.all() else len(rows)
        if last < 6:
            knots = np.array([0.0] * 6 + [1.0] * 6)
            return BSpline(knots, np.zeros((6, len(COLUMNS))), 5), -math.inf
        h = self.ground.h[:last]
        return make_interp_spline(h, rows[:last], k=5), float(h[-1])

    @property
    def marks(self) -> Array:
        return np.empty(0)

    @property
    def stretch(self) -> float:
        return math.inf

    def _read(self, d: Array, columns: Sequence[int], derivatives: int) -> Array:
        """ln load and other columns over it, with derivatives in h: (N, K, 1 or 3)."""
        spline, last = self._spline
        h, first = self._h(d), OF_SEATS + len(COLUMNS) * self.ground.seats.index(self.seat)
        inside = np.clip(h, self.ground.h[0], max(last, self.ground.h[0]))
        out = np.stack([spline(inside, nu)[:, list(columns)] for nu in range(derivatives)], axis=-1)
        self.ground.refine(inside, [first + column for column in columns], out)
        return out

    def _outside(self, d: Array) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Whether separations lie above what carries anything, and below the table."""
        h = self._h(d)
        return h > self._spline[1], h < self.ground.h[0]

    def _derivatives(self, d: Array, columns: tuple[int, ...]) -> Array:
        """Columns per factor with two derivatives in h: (N, len(columns), 3)."""
        every = self._read(d, [0, *(column for column in columns if column)], 3)
        (log, first, second), rest = every[:, 0].T, every[:, 1:] / self.seat.pressure
        F = np.exp(log)
        F1 = F * first
        F2 = F * (second + first**2)
        out = np.empty((len(d), len(columns), 3))
        place = 0
        for i, column in enumerate(columns):
            if column == 0:
                out[:, i] = np.stack([F, F1, F2], axis=-1)
                continue
            r, r1, r2 = rest[:, place].T
            place += 1
            out[:, i, 0] = F * r
            out[:, i, 1] = F1 * r + F * r1
            out[:, i, 2] = F2 * r + 2 * F1 * r1 + F * r2
        above, below = self._outside(d)
        out[above], out[below] = 0.0, np.nan
        return out

    def load(self, d: Array, shadow: int) -> Array:
        sigma = self.ground.field.sigma
        return self.factor / sigma ** np.arange(3) * self._derivatives(d, (0, shadow))

    def columns(self, d: Array) -> Array:
        value = self._read(d, range(len(COLUMNS)), 1)[:, :, 0]
        value[:, 0] = np.exp(value[:, 0])
        value[:, 1:] *= value[:, :1] / self.seat.pressure
        value = np.maximum(value, 0.0)
        above, below = self._outside(d)
        value[above], value[below] = 0.0, np.nan
        return self.factor * value

    def direct_columns(self, d: Array) -> Array:
        return self.columns(d)

    def load_in_gaps(self, d: Array, squeeze: float) -> Array:
        narrow = self._gap_under_largest(squeeze) * self.seat.unit
        h = self._h(d)
        nodes = self.seat.nodes(h, self.ground.patch_moments(h)[:, :-1], (narrow,))
        load = nodes.weight * self.seat.average.average(nodes.gap / self.seat.unit)[:, 0]
        inside = np.where(nodes.gap < narrow, load, 0.0)
        return self.factor * nodes.sum_rows(inside[:, None], len(d))[:, 0]

    def most_in_gaps(self, d: Array, squeeze: float) -> Array:
        return np.full(len(d), math.inf)  # no bound without its ground: it is looked at

    def spots(self, d: Array, splits: Sequence[float] = ()) -> ParticleSpots:
        h, seat = self._h(d), self.seat
        average, u = seat.average.average, self.ground.patch_moments(h)[:, :-1]
        gaps, rise, _ = average.gaps(SPOTS * seat.average.width, splits)
        lowest = float(np.min(seat.nodes(h, u).gap, initial=math.inf)) / seat.unit
        # below the gaps of the tables loads no longer change, but depths do
        low = min(lowest, float(gaps[0]) - seat.average.width)
        count = max(8, math.ceil(4 * (gaps[0] - low) / seat.average.width))
        below = np.linspace(low, gaps[0], count + 1)[:-1]
        gaps = np.concatenate([below, gaps, [average.top]])
        rise = np.concatenate([average.top - below, rise, [0.0]])
        share = seat.shares(h, u, seat.unit * gaps)
        near = np.any(share > 0, axis=0)
        gaps, rise, share = gaps[near, None], rise[near, None], share[:, near]
        spots = average.spots_in(gaps, rise, splits, share, 1.0)
        spots = spots.of_size(self.scale, self.density)
        total, wanted = spots.total(spots.load), self.columns(d)[:, 0]
        return spots.thin_spots(np.divide(wanted, total, out=np.ones_like(total), where=total > 0))


class LiftedSum(FieldSum):
    """A `FieldSum` whose ground particles press down: it sees h + w."""

    def __init__(self, field: FieldSum, ground: Ground):
        self.__dict__.update(vars(field))
        self.plain, self.ground = field, ground
        self._ends(float(ground.h[0]))
        if ground.cut:
            self.ends = "below which particles press their ground down too far for the law field"

    def _lifts(self, d: Array) -> Array:
        """w over σ with two derivatives with respect to h: (N, 3)."""
        return self.ground.lifts(self.h(d))

    def _lift_separations(self, d: Array) -> Array:
        return d + self.sigma * self._lifts(d)[:, 0]

    @property
    def rows(self) -> Array:
        """Separations d [m] of the table, from its lowest up: loads there are known."""
        rows = np.append(self.ground.h[0] + ROUNDING, self.ground.h[1:])
        return self.sigma * rows - self.rough.y_s + self.centre

    def load(self, d: Array) -> Array:
        lift, slope, bend = self._lifts(d).T
        F = self.plain.load(d + self.sigma * lift)
        first, second = 1 + slope, bend / self.sigma
        bend = F[:, 2] * first**2 + F[:, 1] * second
        return np.stack([F[:, 0], F[:, 1] * first, bend], axis=-1)

    def fields(self, d: Array) -> Array:
        return self.plain.fields(self._lift_separations(d))

    def stiffness(self, d: Array) -> Array:
        return self.plain.stiffness(self._lift_separations(d))

    def spots(self, d: Array) -> list[AsperitySpots]:
        return self.plain.spots(self._lift_separations(d))


def put_on_ground(
    field: FieldSum,
    populations: Sequence[SeatedParticles],
    laws: Sequence[SeatedLaw],
    diameters: Sequence[float],
) -> tuple[LiftedSum, list[SeatedParticles]]:
    """The asperities and every population on ground that all of them press down."""
    seats, owners = [], []
    for i, (population, law) in enumerate(zip(populations, laws, strict=True)):
        for component in population.parts:
            spectrum = field.surface.spectrum
            mean, width = law.zeta_mean, law.zeta_std
            seats.append(Seat(component, field.sigma, mean, width, spectrum, population.shadow))
            owners.append(i)
    density = np.array(
        [sum(component.density for component in population.parts) for population in populations]
    )
    mean_diameter = float(density @ np.array(diameters) / density.sum())
    # √(m0/m2) = √2 σ/g
    waves = math.sqrt(2) * field.surface.spectrum.steeper * field.sigma / field.gradient
    apart = mean_diameter / waves
    ground = Ground(field, seats, apart)
    out = []
    for i, population in enumerate(populations):
        parts: list[Part] = [
            GroundedPart(ground, seat) for seat, owner in zip(seats, owners, strict=True)
            if owner == i
        ]  # fmt: skip
        out.append(SeatedParticles(parts, population.shadow, population.coverage))
    return LiftedSum(field, ground), out
