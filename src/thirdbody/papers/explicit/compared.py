"""One case pressed and laid beside the model, and what its numbers say."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import norm
from scipy.stats import t as student

from ...contact.contact import Contact
from ...equilibrium.solve import solve
from ...explicit import Ensemble, ensemble, surface_of
from ...laws.asperity import Field, OwnSpectrum
from ...quantities.say import percent
from ..engine import ignore_ranges
from ..seats import explicit_particles
from .cases import SIGMA, Case

__all__ = ["FULL", "QUICK", "Effort", "Point", "box_of", "by_field", "points_of", "press_case"]

SURE = 0.975
"""Probability to each side within which a difference is one of the draw."""


@dataclass(frozen=True, kw_only=True)
class Effort:
    """How much is pressed."""

    surfaces: int
    size: int
    spacing: float
    """Of the points [m]."""
    loads: tuple[float, ...]

    @property
    def words(self) -> str:
        side = self.size * self.spacing * 1e6
        return (
            f"{self.surfaces} surfaces of ({side:.3g} µm)², {self.size}² points "
            f"{self.spacing * 1e9:.3g} nm apart"
        )


FULL = Effort(surfaces=8, size=512, spacing=200e-9, loads=(1e-5, 1e-4, 3e-4, 1e-3))
QUICK = Effort(surfaces=3, size=128, spacing=200e-9, loads=(1e-4, 1e-3))


@dataclass(frozen=True, kw_only=True)
class Point:
    """One case under one load: explicit with its error, statistical, and why they differ.

    Attributes
    ----------
    raw, share : (float, float)
        Load share of the particles and its standard error, as drawn and without the luck of the
        draw [1].
    statistical : float
        The same of the model, its seats being those that were measured [1].
    h, h_statistical, area, area_statistical
        Separation over σ and real contact area [1].
    ratios : dict
        The four of `Ensemble` at the separation found.
    model_bare : float
        What ``bare_over_bearing`` is in the model.
    surfaces : int
        How many the error is from.
    zeta : (float, float)
        Mean and width of the heights of the seats over σ, which the model has [1].
    stored : (float, float) or None
        The share that the stored runs gave, and its error.
    bounds : (float, float)
        Least and most of the share where too little was drawn for a number with an error; else
        NaN [1].
    field : (float, float, float)
        Share [1], separation over σ and real contact area [1] by the law of one field.
    """

    case: Case
    F_star: float
    raw: tuple[float, float]
    share: tuple[float, float]
    statistical: float
    h: tuple[float, float]
    h_statistical: float
    area: tuple[float, float]
    area_statistical: float
    ratios: dict[str, float]
    model_bare: float
    surfaces: int
    zeta: tuple[float, float]
    stored: tuple[float, float] | None
    bounds: tuple[float, float] = (math.nan, math.nan)
    field: tuple[float, float, float] = (math.nan, math.nan, math.nan)

    @property
    def has_bounds_only(self) -> bool:
        """Whether bounds are all that is known of the share."""
        return math.isfinite(self.bounds[0])

    @property
    def difference(self) -> float:
        """Share of the model over the explicit one, less 1."""
        return self.statistical / self.share[0] - 1 if self.share[0] > 0 else math.nan

    @property
    def apart_by_field(self) -> float:
        """Difference as of `difference`, for the law of one field."""
        return self.field[0] / self.share[0] - 1 if self.share[0] > 0 else math.nan

    @property
    def errors(self) -> float:
        """The difference in standard errors."""
        return (self.statistical - self.share[0]) / self.share[1] if self.share[1] > 0 else math.nan

    @property
    def is_off(self) -> bool:
        """Whether the model is off by more than the error bars: 95 %, few surfaces counted.

        Where only bounds are known, whether it is outside them.
        """
        if self.surfaces < 2:
            return False
        if self.has_bounds_only:
            return not self.bounds[0] <= self.statistical <= self.bounds[1]
        return abs(self.errors) > float(student.ppf(SURE, self.surfaces - 1))

    @property
    def why(self) -> str:
        """Sentence on the four ratios behind the difference, largest part first; "" without one.

        The shares' odds differ by the factors with which explicit asperities carry less than
        those of the model at one separation, and explicit particles less than their sum.
        """
        if not self.is_off:
            return ""
        ratios = self.ratios
        bare = ratios["bare_over_bearing"] / self.model_bare
        parts = [
            (ratios["particles_over_sum"], "particles carry {} of the sum of their law"),
            (bare, "bare asperities carry {} of the model's"),
            (ratios["asperities_with_over_without"], "beside particles asperities carry {}"),
            (ratios["bearing_over_gaussian"], "the bearing area drawn is {} of the Gaussian one"),
        ]
        sized_words = [(abs(math.log(r)), words.format(percent(r, digits=2)))
                 for r, words in parts if math.isfinite(r) and r > 0]  # fmt: skip
        phrases = [words for size, words in sorted(sized_words, reverse=True) if size > 0.01]
        return "; ".join(phrases[:3])


def press_case(
    case: Case, effort: Effort, folder: Path | None, report: Callable[[int], None]
) -> Ensemble:
    """The surfaces of a case, finished ones read from the folder."""
    with ignore_ranges():
        return ensemble(
            case.contact,
            surfaces=effort.surfaces,
            F_star=case.loads or effort.loads,
            size=effort.size,
            spacing=effort.spacing,
            seats=case.seats,
            folder=None if folder is None else folder / case.name,
            progress=report,
        )


@lru_cache(maxsize=8)
def box_of(contact: Contact, size: int, spacing: float) -> OwnSpectrum:
    """The waves of the maps that are pressed, which repeat themselves."""
    return OwnSpectrum.of(surface_of(contact, size=size, spacing=spacing, seed=1), box=True)


def by_field(
    model: Contact, loads: Sequence[float], waves: OwnSpectrum | None
) -> list[list[float]]:
    """Share, separation over σ and real area by the law of one field, for each F*: (N, 3)."""
    contact = model.replace(asperity_law=Field(spectrum=waves))
    with ignore_ranges():
        state = solve(contact, F_star=np.array(loads))
    rows = (state.particle_load_share, np.asarray(state.h) / SIGMA, state.A_t)
    return np.stack([np.asarray(row, dtype=float) for row in rows], axis=-1).tolist()


def points_of(case: Case, ensemble: Ensemble, effort: Effort) -> list[Point]:
    """Every load of a case."""
    table, at, state = ensemble.table, ensemble.at_h, ensemble.statistical
    bare = case.contact.replace(particles=None)
    waves = box_of(bare, effort.size, effort.spacing)
    fields = by_field(ensemble.model, table.F_star.values.tolist(), waves)
    hardness = ensemble.contact.surfaces.H

    def pair(name: str, i: int, scale: float = 1.0) -> tuple[float, float]:
        value, error = (float(table[f"{name}{end}"].values[i]) for end in ("", "_error"))
        return value / scale, error / scale

    out = []
    for i, load in enumerate(table.F_star.values.tolist()):
        h = float(table["h_cv"].values[i])
        ratios = {
            name: float(np.interp(h, at.h.values[::-1], at[name].values[::-1])) for name in RATIOS
        }
        model_h = float(np.atleast_1d(state.h)[i])
        bearing = hardness * float(norm.sf(model_h / SIGMA))
        carried = float(np.atleast_1d(state.F_ss_star)[i]) * ensemble.contact.E_ss / bearing
        out.append(
            Point(
                case=case,
                F_star=load,
                raw=pair("particle_load_share_raw", i),
                share=pair("particle_load_share_cv", i),
                statistical=float(table["particle_load_share_statistical"].values[i]),
                h=pair("h_cv", i, SIGMA),
                h_statistical=model_h / SIGMA,
                area=pair("A_t_cv", i),
                area_statistical=float(table["A_t_statistical"].values[i]),
                ratios=ratios,
                model_bare=carried,
                surfaces=ensemble.surfaces,
                zeta=(ensemble.seats.mean, ensemble.seats.std),
                stored=_stored_share(case, load),
                bounds=(
                    float(table["particle_load_share_cv_least"].values[i]),
                    float(table["particle_load_share_cv_most"].values[i]),
                ),
                field=(fields[i][0], fields[i][1], fields[i][2]),
            )
        )
    return out


RATIOS = (
    "bare_over_bearing",
    "particles_over_sum",
    "asperities_with_over_without",
    "bearing_over_gaussian",
)


def _stored_share(case: Case, load: float) -> tuple[float, float] | None:
    """What the stored runs gave for the same contact."""
    if case.group not in ("sizes", "bumps"):
        return None
    for point in explicit_particles()["points"]:
        same = math.isclose(point["diameter"], case.diameter, rel_tol=1e-6)
        if same and math.isclose(point["F_star"], load, rel_tol=1e-6):
            stored: dict[str, Any] = point["control_variate"] or point["raw"]
            return stored["load_share"], stored["load_share_error"]
    return None
