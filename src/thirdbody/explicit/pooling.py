"""Sums of many surfaces, pooled at equal separation and then taken at equal load."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..quantities.say import number, percent
from .seats import SeatHeights, seat_heights
from .sums import EXPECTED, SUMS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Index = NDArray[np.int64]

__all__ = ["COMPARED", "RATIOS", "SHARES", "AtLoads", "Pool", "pooled_seats"]

COMPARED = ("h", "A_t", "particle_load_share", "particle_area_share")
"""Columns that are compared at each load."""
RATIOS = {
    "bare_over_bearing": "load without particles over hardness times bearing area",
    "particles_over_sum": "load of the particles over the sum of their law at their seats",
    "asperities_with_over_without": "load of the asperities with over that without particles",
    "bearing_over_gaussian": "bearing area over that of Gaussian heights",
}
"""Why explicit and statistical answers differ, at equal separation."""
SHARES = ("particle_load_share", "particle_area_share")
"""Those of `COMPARED` that have bounds where nothing was drawn."""
TIED = 1e-6
"""Relative difference below which two loads are one: the certificate knows no better."""


@dataclass(frozen=True, eq=False, kw_only=True)
class AtLoads:
    """What a pool says at K loads.

    Attributes
    ----------
    values, errors : dict of array (K,)
        `COMPARED` and their standard errors; NaN where they are not known.
    least, most : dict of array (K,)
        Bounds of `SHARES` where these or their errors are not known, NaN elsewhere.
    idle : array (2, K) of bool
        Whether no asperity, and whether no particle, of any surface carries.
    """

    values: dict[str, Array]
    errors: dict[str, Array]
    least: dict[str, Array]
    most: dict[str, Array]
    idle: NDArray[np.bool_]

    @property
    def is_outside(self) -> NDArray[np.bool_]:
        """Loads that the surfaces carry at none of the separations pressed."""
        return np.isnan(self.values["h"])

    def doubts(self, loads: Array, *, columns: str = "") -> list[str]:
        """Notes on shares that too small a sample leaves open, with their bounds and what to do.

        ``columns`` says whose separations these are, where other columns have others.
        """
        there = f" at the separations of the {columns} columns" if columns else ""
        error, least, most = (
            shares["particle_load_share"] for shares in (self.errors, self.least, self.most)
        )
        idle = self.idle.any(axis=0)
        lone = np.isfinite(least) & ~idle & np.isnan(error)
        out = []
        for which, words in (
            (self.idle[0], "no asperity of any surface carries"),
            (self.idle[1], "no particle of any surface carries"),
            (lone, "asperities or particles of too few surfaces carry"),
        ):
            if np.any(which):
                sure = "; ".join(
                    f"{percent(float(least[i]), digits=3)} to {percent(float(most[i]), digits=3)} "
                    f"at F* = {number(float(loads[i]), 3)}"
                    for i in np.flatnonzero(which)
                )
                out.append(
                    f"{words}{there}: the particles' load share has no error there, and all that "
                    f"is known "
                    f"of it is {sure}; more or larger surfaces draw some"
                )
        return out


@dataclass(frozen=True, eq=False, kw_only=True)
class Pool:
    """What every surface gave at the same separations.

    Attributes
    ----------
    h : array (M,)
        Separations [m].
    nominal : array (N,)
        Nominal area of each surface [m²].
    good : array (N, M) of bool
        States that converged; the others count nowhere.
    sums, expected : dict of array (N, M)
        Loads [N] and areas [m²], as drawn and as such draws have them on average.
    """

    h: Array
    nominal: Array
    good: NDArray[np.bool_]
    sums: dict[str, Array]
    expected: dict[str, Array]

    @classmethod
    def from_records(cls, records: list[dict[str, Any]], h: Array) -> Pool:
        """Pool of the records that `one_surface` makes."""
        return cls(
            h=h,
            nominal=np.array([record["nominal"] for record in records]),
            good=np.array([record["converged"] for record in records]),
            sums={name: np.array([record[name] for record in records]) for name in SUMS},
            expected={
                name: np.array([record["expected"][name] for record in records])
                for name in EXPECTED
            },
        )

    @property
    def dusty(self) -> bool:
        """Whether there are particles: without any their share is 0, which is no luck."""
        return bool(np.any(self.expected["law"] != 0))  # NaN where their seats are given

    def totals(self) -> dict[str, Array]:
        """Sums over all surfaces at each separation."""
        return {name: np.sum(values * self.good, axis=0) for name, values in self.sums.items()}

    def ratios(self, hardness: float) -> dict[str, Array]:
        """`RATIOS` at each separation; NaN where nothing is carried."""
        total = self.totals()
        gaussian = np.sum(self.expected["bearing"] * self.good, axis=0)
        with np.errstate(invalid="ignore", divide="ignore"):
            ratios = {
                "bare_over_bearing": total["bare"] / (hardness * total["bearing"]),
                "particles_over_sum": total["particles"] / total["law"],
                "asperities_with_over_without": total["asperities"] / total["bare"],
                "bearing_over_gaussian": total["bearing"] / gaussian,
            }
        return {name: np.where(np.isfinite(ratio), ratio, np.nan) for name, ratio in ratios.items()}

    def at_loads(self, pressure: Array, *, fair: bool, cap: float | None = None) -> AtLoads:
        """`COMPARED` at nominal pressures [Pa], with jackknife errors over surfaces.

        Parameters
        ----------
        pressure : array (K,)
        fair : bool
            Correct for the random surfaces that were drawn.
        cap : float or None
            The highest pressure of asperities [Pa]: what those can carry that nobody drew.

        Notes
        -----
        Where no asperity (or no particle) of any surface carries, all surfaces agree, and yet the
        next may have one. Shares have no error there and, where the luck is taken out, no number:
        0/0 of what was drawn and was to be expected. What remains are bounds: asperities carry at
        most the cap on the bearing area of an average draw, idle particles the sum of their law.
        """
        n = len(self.nominal)
        values, idle = self._some_at_loads(pressure, np.ones(n, bool), fair)
        error = np.full_like(values, math.nan)
        if n > 1:
            without = np.array(
                [self._some_at_loads(pressure, np.arange(n) != i, fair)[0] for i in range(n)]
            )
            spread = without - without.mean(axis=0)
            error = np.sqrt((n - 1) / n * np.sum(spread**2, axis=0))
        if self.dusty:  # that none differs from the others is no knowledge of the next
            error[2:, idle.any(axis=0) | (error[2:] == 0).any(axis=0)] = math.nan
        lone = np.isnan(error[2:]).any(axis=0) & (n > 1) & np.isfinite(values[0])
        unsure = idle.any(axis=0) | lone
        least, most, more = self._bounds(pressure, values, idle, fair, cap)
        error[:2] = np.hypot(error[:2], more)
        return AtLoads(
            values=dict(zip(COMPARED, values, strict=True)),
            errors=dict(zip(COMPARED, error, strict=True)),
            least=dict(zip(SHARES, np.where(unsure, least, math.nan), strict=True)),
            most=dict(zip(SHARES, np.where(unsure, most, math.nan), strict=True)),
            idle=idle,
        )

    def _bounds(
        self,
        pressure: Array,
        values: Array,
        idle: NDArray[np.bool_],
        fair: bool,
        cap: float | None,
    ) -> tuple[Array, Array, Array]:
        """Least and most of both shares, and how much higher h and A_t may be: (2, K) each."""
        every = np.ones(len(self.nominal), bool)
        order, hoped = np.argsort(self.h), self._mean(self.expected, every)
        bearing, law, dents = (
            np.interp(values[0], self.h[order], hoped[name][order]) for name in EXPECTED
        )
        with np.errstate(invalid="ignore", divide="ignore"):
            asperities = np.minimum((math.inf if cap is None else cap) * bearing / pressure, 1.0)
            particles = np.minimum(law / pressure, 1.0)
            area = values[1]
            least = np.stack([1 - asperities, np.maximum(1 - bearing / area, 0.0)])
            most = np.where(idle[1], np.stack([particles, dents / (dents + area)]), 1.0)
            unseen = np.where(idle[0], asperities, 0.0) + np.where(idle[1], particles, 0.0)
            lower = self._some_at_loads(pressure * np.maximum(1 - unseen, 1e-300), every, fair)[0]
        least = np.where(idle[1] & ~idle[0], 0.0, least)
        more = np.stack([
            lower[0] - values[0], np.where(idle[0], bearing, 0.0) + np.where(idle[1], dents, 0.0)
        ])  # fmt: skip
        return least, most, np.where(idle.any(axis=0), more, 0.0)

    def _some_at_loads(
        self, pressure: Array, which: NDArray[np.bool_], fair: bool
    ) -> tuple[Array, NDArray[np.bool_]]:
        """`COMPARED` (4, K) of some surfaces; where asperities and particles (2, K) are idle."""
        out = np.full((len(COMPARED), len(pressure)), np.nan)
        idle = np.zeros((2, len(pressure)), bool)
        now = self._per_area(which, fair)
        load = now["asperities"] + now["particles"]
        kept = _first_reached(load, self.h)
        if len(kept) < 2:
            return out, idle
        log, at = np.log(load[kept]), np.log(pressure)
        from scipy.interpolate import PchipInterpolator

        particles, asperities, touched, dented = (
            _interpolate(now[name][kept], log, at)
            for name in ("particles", "asperities", "area", "particle_area")
        )
        out[0] = PchipInterpolator(log, self.h[kept])(at)
        with np.errstate(invalid="ignore", divide="ignore"):
            out[1] = touched + dented
            out[2] = particles / (particles + asperities)
            out[3] = dented / (touched + dented)
        beyond = (at < log[0]) | (at > log[-1])
        out[:, beyond] = np.nan
        idle[0] = (asperities == 0) & ~beyond
        idle[1] = (particles == 0) & ~beyond & self.dusty
        if fair:
            out[2:, idle.any(axis=0)] = np.nan
        return out, idle

    def _mean(self, values: dict[str, Array], which: NDArray[np.bool_]) -> dict[str, Array]:
        """Sums over some of the surfaces, over their nominal area."""
        counts = self.good[which]
        nominal = np.sum(counts * self.nominal[which][:, None], axis=0)
        with np.errstate(invalid="ignore", divide="ignore"):
            return {k: np.sum(v[which] * counts, axis=0) / nominal for k, v in values.items()}

    def _per_area(self, which: NDArray[np.bool_], fair: bool) -> dict[str, Array]:
        """Sums of some of the surfaces over their nominal area."""
        now = self._mean(self.sums, which)
        if fair:
            hoped = self._mean(self.expected, which)
            factor = {name: _ratio_of_draw(hoped[name], now[name], self.h) for name in EXPECTED}
            now["asperities"] = now["asperities"] * factor["bearing"]
            now["area"] = now["area"] * factor["bearing"]
            now["particles"] = now["particles"] * factor["law"]
            now["particle_area"] = now["particle_area"] * factor["law_area"]
        return now


def _first_reached(load: Array, h: Array) -> Index:
    """States by which the load grows as the flat comes down, each more than all before by `TIED`.

    The same load at several separations (all that carries is embedded, or the draw of one surface
    ends) stands for the first of them.
    """
    kept: list[int] = []
    highest = 0.0
    for i in np.argsort(-h, kind="stable").tolist():
        if load[i] > highest * (1 + TIED):  # NaN is not
            kept.append(i)
            highest = float(load[i])
    return np.array(kept, dtype=np.int64)


def _interpolate(values: Array, log: Array, at: Array) -> Array:
    """Values over ln load at other ln loads; 0 below the first that is not."""
    from scipy.interpolate import PchipInterpolator

    with np.errstate(divide="ignore"):
        logs = np.log(values)
    some = np.isfinite(logs)
    if not np.any(some):
        return np.zeros(len(at))
    if np.sum(some) < 2:
        return np.where(at < log[some][0], 0.0, values[some][0])
    within = np.clip(at, log[some][0], log[some][-1])
    interpolated = np.exp(PchipInterpolator(log[some], logs[some])(within))
    return np.where(at < log[some][0], 0.0, interpolated)


def _ratio_of_draw(hoped: Array, drawn: Array, grid: Array) -> Array:
    """hoped/drawn; where nothing is drawn the ratio of the next lower h that has."""
    order = np.argsort(grid)
    out, last = np.ones(len(grid)), 1.0
    for i in order:
        if drawn[i] > 0 and hoped[i] > 0:
            last = hoped[i] / drawn[i]
        out[i] = last
    return out


def pooled_seats(parts: list[list[float]]) -> SeatHeights:
    """Heights of the seats of all surfaces, from their sums."""
    first, second, high, count = np.sum(np.array(parts, dtype=float), axis=0).tolist()
    if not count:
        return seat_heights(np.empty(0))
    mean = first / count
    std = math.sqrt(max(second / count - mean**2, 0.0))
    gauss = 0.5 * math.erfc((2.5 - mean) / (std * math.sqrt(2))) if std > 0 else 0.0
    return SeatHeights(mean, std, high / count, gauss)
