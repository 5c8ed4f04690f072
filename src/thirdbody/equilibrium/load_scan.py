"""The load over all separations, and the roots in it."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..contact.interface import Interface
from ..errors import NoEquilibrium
from ..numerics.roots import halley_root
from ..quantities.say import value_of
from .status import Status, Statuses

Array = NDArray[np.float64]

Index = NDArray[np.intp]


CHUNK = 16_384
"""States solved together: their arrays stay in the processor's cache."""
RESIDUAL, ULPS = 1e-9, 4
"""Largest imbalance |F_t/F − 1| of a state that is "ok", unless so many ulp of d explain it."""
RISE = 1e-6
"""Rise of the load with d, over the load, that counts as one."""
HALVINGS = 64


def is_carried(F: Array, slope: Array, target: Array, ulp: float) -> NDArray[np.bool_]:
    """Whether a load is carried: to `RESIDUAL` of it, or to what `ULPS` ulp of d change."""
    steep = np.where(np.isfinite(slope), ULPS * ulp * np.abs(slope), 0.0)  # infinite at a jump
    return np.abs(F - target) <= RESIDUAL * target + steep


class LoadScan:
    """The total load on a grid of separations, from the highest down, ready to bracket loads.

    Attributes
    ----------
    d, log_F : array (M,)
        Falling separations and ln of the load there, from the highest that carries a load.
    monotone : bool
        The load grows by no more than `RISE` of itself while d grows.
    """

    def __init__(self, contact_interface: Interface):
        self.interface = contact_interface
        asperities = contact_interface.asperities
        sigma_s, centre = asperities.sigma_s, asperities.centre
        low = contact_interface.lowest
        near = np.arange(asperities.searched, min(10.0, asperities.highest), 0.2)
        far = np.arange(10.0, asperities.highest, 1.0)
        # the last asperity of a bounded distribution sets in like a power of its distance
        edge = asperities.highest - np.geomspace(1e-6, 0.2, 12)
        grid = [centre + sigma_s * np.concatenate([near, far, edge])]
        particles = contact_interface.particles
        if particles is not None:
            top = particles.reach
            grid.append(np.linspace(low, max(top, low), 65)[1:])
            if len(marks := np.unique(particles.marks)):
                marks = np.unique(np.clip(marks, low, max(top, low)))
                grid.append(np.interp(np.arange(0, len(marks), 0.25), np.arange(len(marks)), marks))
            # the last particle sets in like a power of its distance, down to the last digit of it
            grid.append(top - (top - low) * np.geomspace(1e-15, 1e-2, 27))
            if not particles.monotone:
                count = int(np.ceil((top - low) / particles.resolution))
                grid.append(np.linspace(low, top, min(max(count, 2), 20_000)))
        d = np.unique(np.concatenate(grid))
        if contact_interface.one_field:
            d = d[d >= low]
        if len(rows := contact_interface.rows):
            d = np.append(rows, d[d > rows[-1]])
        F, slope, _ = contact_interface.load(d).T
        if np.any(F < 0):
            # adhesion: the load sets in at a separation where it changes its sign
            d = np.append(d, self._onset(d, F) - sigma_s * np.geomspace(1e-9, 0.2, 30))
            d = np.unique(d)
            F, slope, _ = contact_interface.load(d).T
        self.ulp = float(np.spacing(np.abs(d[[0, -1]]).max()))
        if len(turns := self._turns(d, F, slope)):
            d = np.unique(np.append(d, turns))
            F = contact_interface.load(d)[:, 0]
        if not np.any(F > 0):
            raise NoEquilibrium("no equilibrium: the laws carry no load at any separation")
        highest = np.flatnonzero(F > 0)[-1] + 1
        with np.errstate(divide="ignore"):
            self.d, self.log_F = d[:highest][::-1], np.log(np.maximum(F[:highest][::-1], 0.0))
        most = np.maximum.accumulate(self.log_F)
        self.monotone = bool(np.all(most - self.log_F <= RISE))

    def _turns(self, d: Array, F: Array, slope: Array) -> Array:
        """Separations where the load turns between falling and rising with d, or jumps up."""
        low, high, size = d[:-1], d[1:], np.maximum(np.abs(F[:-1]), np.abs(F[1:]))
        rises = slope * (d[-1] - d[0]) > RESIDUAL * np.abs(F)  # else rounding of what is flat
        jumps = ~rises[:-1] & ~rises[1:] & (F[1:] - F[:-1] > RESIDUAL * size)
        cells = np.flatnonzero((rises[:-1] != rises[1:]) | jumps)
        low, high, by_load, first = low[cells], high[cells], jumps[cells], rises[:-1][cells]
        F_low = F[:-1][cells]
        for _ in range(HALVINGS if len(cells) else 0):
            middle = 0.5 * (low + high)
            F_m, slope_m, _ = self.interface.load(middle).T
            right = np.where(by_load, F_m <= F_low, (slope_m > 0) == first)
            low, high = np.where(right, middle, low), np.where(right, high, middle)
            F_low = np.where(right, F_m, F_low)
        return np.concatenate([low, high])

    def _onset(self, d: Array, F: Array) -> float:
        """The highest separation at which the load changes its sign."""
        from scipy.optimize import brentq

        above = np.flatnonzero(F > 0)
        if not len(above) or above[-1] == len(d) - 1:
            return float(d[-1])
        low, high = d[above[-1]], d[above[-1] + 1]
        return float(
            brentq(lambda x: self.interface.load(np.array([x]))[0, 0], low, high, xtol=1e-24)
        )

    @property
    def _lowest(self) -> str:
        """The lowest separation, in words."""
        asperities = self.interface.asperities
        if self.interface.one_field:
            h = (self.interface.lowest + self.interface.mean_plane) / asperities.sigma
            return f"h = {h:.2g} sigma, {asperities.ends}"
        return f"{asperities.searched:g} sigma_s"

    # ------------------------------------------------------------------ brackets
    def cells(self, target: Array, branch: str) -> Index:
        """Index i of the cell d[i] > root >= d[i+1] for each load, −1 where there is none."""
        log_target = np.log(target)
        if branch == "loading" or load_scan(self.interface).monotone:
            # first separation, coming down, at which the load is reached
            reached = np.maximum.accumulate(self.log_F)
            cell = np.searchsorted(reached, log_target, side="left") - 1
            cell = np.where(cell >= len(self.d) - 1, -1, cell)
        else:
            # going up from the deepest, the last separation at which the load is still carried
            carried = np.minimum.accumulate(self.log_F[::-1])[::-1]
            cell = np.searchsorted(carried, log_target, side="left") - 1
            cell = np.where(cell >= len(self.d) - 1, -1, cell)
        return np.where(log_target <= self.log_F[0], -1, cell)

    def all_cells(self, target: float) -> tuple[Index, Index]:
        """Every cell in which the load is crossed, and whether the load falls with d there."""
        above = self.log_F >= np.log(target)
        cells = np.flatnonzero(above[1:] != above[:-1])
        return cells, above[1:][cells]

    def separations(self, target: Array) -> Index:
        """Number of separations that carry each load, those beside a jump included."""
        with np.errstate(invalid="ignore"):
            ends = np.sort(np.stack([self.log_F[:-1], self.log_F[1:]]), axis=0)
        begun, ended = (np.searchsorted(np.sort(row), np.log(target)) for row in ends)
        return begun - ended

    def why_not(self, target: float) -> tuple[Status, str]:
        """Why no separation carries this load."""
        E = self.interface.contact.E_ss
        top = float(np.exp(self.log_F.max()))
        said = f"{value_of(target, 'Pa')} (F* = {target / E:.3g})"
        if target > top:
            H = self.interface.contact.surfaces.H
            why = (
                f"it is above the softer body's hardness, {value_of(H, 'Pa')}; check the unit "
                "of the load"
            )
            if target <= H:
                why = (
                    f"it is below the hardness, {value_of(H, 'Pa')}, so its unit may be right: "
                    "asperities alone do not carry it, they would be pressed flat; in oil a film "
                    "carries it (thirdbody film)"
                )
            return Status.TOO_MUCH, (
                f"no equilibrium: the load {said} is beyond {value_of(top, 'Pa')} (F* = "
                f"{top / E:.3g}), the most this model carries down to "
                f"a separation d of {self._lowest}; {why}"
            )
        return Status.TOO_LITTLE, (
            f"no equilibrium: the load {said} is below "
            "the smallest load this model resolves; check the unit of the load"
        )

    # ------------------------------------------------------------------ roots
    def polish(
        self, target: Array, cells: Index, *, falling: bool = True
    ) -> tuple[Array, Index, dict[int, tuple[Status, str]]]:
        """Roots inside their cells, to rounding; evaluations; and where there is none, why not.

        At a jump the separation is the next one that carries the load and more.
        """
        high, low = self.d[cells], self.d[cells + 1]
        log_target = np.log(target)
        top, bottom = self.log_F[cells], self.log_F[cells + 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            fraction = (log_target - top) / (bottom - top)
        fraction = np.where(np.isfinite(fraction), np.clip(fraction, 0.0, 1.0), 0.5)
        start = high + fraction * (low - high)

        def imbalance(d: Array, which: Index) -> tuple[Array, Array, Array]:
            F, F1, F2 = self.interface.load(d).T
            with np.errstate(divide="ignore", invalid="ignore"):
                slope = F1 / F
                return np.log(F) - log_target[which], slope, F2 / F - slope**2

        d, residual, iterations = halley_root(imbalance, low, high, start, falling=falling)
        # beside what is steep for floats, or jumps
        rest = np.flatnonzero(~(np.abs(residual) <= 0.5 * RESIDUAL))
        passed = {}
        if len(rest):
            d[rest], causes = self._beside(target[rest], low[rest], high[rest], falling)
            passed = {int(rest[i]): cause for i, cause in causes.items()}
        return d, iterations, passed

    def _beside(
        self, target: Array, low: Array, high: Array, falling: bool
    ) -> tuple[Array, dict[int, tuple[Status, str]]]:
        """Float whose load is next to each load in its bracket, and why none carries it.

        The load jumps there, or one side of the bracket has no load.
        """
        low, high = low.copy(), high.copy()
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            right = (self.interface.load(middle)[:, 0] >= target) == falling
            low, high = np.where(right, middle, low), np.where(right, high, middle)
        carries, less = (low, high) if falling else (high, low)
        (F, slope, _), (F_less, slope_less, _) = (self.interface.load(x).T for x in (carries, less))
        good = is_carried(F, slope, target, self.ulp)
        other = is_carried(F_less, slope_less, target, self.ulp)
        closer = other & (~good | (np.abs(F_less - target) < np.abs(F - target)))
        E = self.interface.contact.E_ss
        passed = {
            int(i): (
                Status.JUMP,
                f"jump: the load {value_of(target[i], 'Pa')} (F* = {target[i] / E:.3g}) "
                f"lies in a jump of the load from F* = {F_less[i] / E:.3g} to {F[i] / E:.3g} "
                f"at d = {carries[i]:.6g} m, and no separation there carries it",
            )
            if np.isfinite(F[i]) and np.isfinite(F_less[i])
            else (Status.UNSOLVED, Status.UNSOLVED.sentence)
            for i in np.flatnonzero(~good & ~other)
        }
        return np.where(closer, less, carries), passed

    def solve(self, target: Array, branch: str) -> tuple[Array, Index, Statuses]:
        """Separation, number of evaluations and status of every load."""
        d, iterations, status = self.solve_across_jumps(target, branch)
        d[~status.is_solved] = np.nan
        return d, iterations, status

    def solve_across_jumps(self, target: Array, branch: str) -> tuple[Array, Index, Statuses]:
        """Separations as of `solve`; at a jump over a load, the separation of the jump."""
        d = np.full(len(target), np.nan)
        iterations = np.zeros(len(target), dtype=int)
        status = Statuses.ok(len(target))
        cells = self.cells(target, branch)
        carried = np.flatnonzero(cells >= 0)
        for start in range(0, len(carried), CHUNK):
            rows = carried[start : start + CHUNK]
            d[rows], iterations[rows], passed = self.polish(target[rows], cells[rows])
            for place, why in passed.items():
                status.set(rows[place], *why)
        for i in np.flatnonzero(cells < 0):
            status.set(i, *self.why_not(float(target[i])))
        return d, iterations, status


@lru_cache(maxsize=512)
def load_scan(contact_interface: Interface) -> LoadScan:
    """The cached scan of an interface."""
    return LoadScan(contact_interface)
