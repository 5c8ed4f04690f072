"""Sums of many surfaces, pooled at equal separation and then taken at equal load."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .seats import SeatHeights, seat_heights
from .sums import EXPECTED, SUMS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["COMPARED", "RATIOS", "Pool", "pooled_seats"]

COMPARED = {
    "h": ("m", "separation of the mean planes"),
    "A_t": ("1", "real contact area"),
    "particle_load_share": ("1", "load share of particles"),
    "particle_area_share": ("1", "area share of particles"),
}
"""What is compared at each load: unit and meaning."""
RATIOS = {
    "bare_over_bearing": "load without particles over hardness times bearing area",
    "particles_over_sum": "load of the particles over the sum of their law at their seats",
    "asperities_with_over_without": "load of the asperities with over that without particles",
    "bearing_over_gaussian": "bearing area over that of Gaussian heights",
}
"""Why explicit and statistical answers differ, at equal separation."""


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
    def of(cls, records: list[dict[str, Any]], h: Array) -> Pool:
        """Of what `one_surface` tells of each."""
        return cls(
            h=h,
            nominal=np.array([each["nominal"] for each in records]),
            good=np.array([each["converged"] for each in records]),
            sums={name: np.array([each[name] for each in records]) for name in SUMS},
            expected={
                name: np.array([each["expected"][name] for each in records]) for name in EXPECTED
            },
        )

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

    def at_loads(self, pressure: Array, *, fair: bool) -> Iterator[tuple[str, Array, Array]]:
        """Each of `COMPARED` at nominal pressures [Pa], and its jackknife error over surfaces.

        ``fair`` takes out the luck of the draw.
        """
        n = len(self.nominal)
        found = self._some_at_loads(pressure, np.ones(n, bool), fair)
        without = np.array(
            [self._some_at_loads(pressure, np.arange(n) != i, fair) for i in range(n)]
        )
        error = np.full_like(found, math.nan)
        if n > 1:
            spread = without - without.mean(axis=0)
            error = np.sqrt((n - 1) / n * np.sum(spread**2, axis=0))
        return zip(COMPARED, found, error, strict=True)

    def _some_at_loads(self, pressure: Array, which: NDArray[np.bool_], fair: bool) -> Array:
        """`COMPARED` (4, loads) of some of the surfaces."""
        out = np.full((len(COMPARED), len(pressure)), np.nan)
        now = self._per_area(which, fair)
        load = now["asperities"] + now["particles"]
        usable = np.isfinite(load) & (load > 0)
        h, log = self.h[usable], np.log(load[usable])
        if len(h) < 2:
            return out
        order = np.argsort(log)
        log, h, at = log[order], h[order], np.log(pressure)
        from scipy.interpolate import PchipInterpolator

        particles, asperities, touched, dented = (
            _interpolated(now[name][usable][order], log, at)
            for name in ("particles", "asperities", "area", "particle_area")
        )
        out[0] = PchipInterpolator(log, h)(at)
        with np.errstate(invalid="ignore", divide="ignore"):
            out[1] = touched + dented
            out[2] = particles / (particles + asperities)
            out[3] = dented / (touched + dented)
        out[:, (at < log[0]) | (at > log[-1])] = np.nan
        return out

    def _per_area(self, which: NDArray[np.bool_], fair: bool) -> dict[str, Array]:
        """Sums of some of the surfaces over their nominal area."""
        counts = self.good[which]
        nominal = np.sum(counts * self.nominal[which][:, None], axis=0)

        def mean(values: dict[str, Array]) -> dict[str, Array]:
            with np.errstate(invalid="ignore", divide="ignore"):
                return {k: np.sum(v[which] * counts, axis=0) / nominal for k, v in values.items()}

        now = mean(self.sums)
        if fair:
            hoped = mean(self.expected)
            factor = {name: _held(hoped[name], now[name], self.h) for name in EXPECTED}
            now["asperities"] = now["asperities"] * factor["bearing"]
            now["area"] = now["area"] * factor["bearing"]
            now["particles"] = now["particles"] * factor["law"]
            now["particle_area"] = now["particle_area"] * factor["law_area"]
        return now


def _interpolated(values: Array, log: Array, at: Array) -> Array:
    """Values over ln load at other ln loads; 0 below the first that is not."""
    from scipy.interpolate import PchipInterpolator

    with np.errstate(divide="ignore"):
        logs = np.log(values)
    some = np.isfinite(logs)
    if not np.any(some):
        return np.zeros(len(at))
    if np.sum(some) < 2:
        return np.where(at < log[some][0], 0.0, values[some][0])
    found = np.exp(PchipInterpolator(log[some], logs[some])(np.minimum(at, log[-1])))
    return np.where(at < log[some][0], 0.0, found)


def _held(hoped: Array, drawn: Array, grid: Array) -> Array:
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
