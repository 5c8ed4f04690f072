"""What a design asks: objectives, limits, suspensions."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidValue, Mistake, Problem
from ...populations.measured import cleanliness
from ...populations.particles import Particles
from ...quantities.value import Value, choice, quantity

__all__ = ["Limit", "Objective", "Suspension"]

Array = NDArray[np.float64]


# -------------------------------------------------------------------------- what is asked
@dataclass(frozen=True, slots=True, kw_only=True)
class Objective(Value):
    """What should be small, large, or inside a window.

    Parameters
    ----------
    of : str
        A column of the states or of an output, or "plastic_share".
    aim : {"smallest", "largest", "window"}, optional
        "window": the weighted share of loads at which the metric lies in [low, high] is to be
        large.
    over_loads : {"mean", "worst"}, optional
        Weighted mean, or the worst of the load cases.
    over_scatter : {"mean", "nominal", "worst", "robust", "tail"}, optional
        What counts of the scattered samples: their mean; nothing, the nominal contact alone; the
        worst; mean and ``k`` standard deviations to the bad side; or the mean of the worst
        ``tail`` part of them (CVaR).
    low, high : float, optional
        The window.
    k, tail : float, optional

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.objectives.Objective(of="particle_load_share", aim="window").high
    0.75
    """

    of: str
    aim: Literal["smallest", "largest", "window"] = choice("what is good", default="smallest")
    over_loads: Literal["mean", "worst"] = choice("what counts of the loads", default="mean")
    over_scatter: Literal["mean", "nominal", "worst", "robust", "tail"] = choice(
        "what counts of the samples", default="mean"
    )
    low: float = quantity("m_lo", "1", "lower end of the window", default=0.25)
    high: float = quantity("m_hi", "1", "upper end of the window", default=0.75)
    k: float = quantity("k", "1", "standard deviations of a robust objective", default=2.0, ge=0)
    tail: float = quantity("q", "1", "part of a tail that counts", default=0.1, gt=0, le=1)

    def _problems(self) -> list[str]:
        if self.low < self.high:
            return []
        return [
            Problem(
                "low", f"must be below high = {self.high:g}", f"{self.low:g}", code=Mistake.ORDER
            )
        ]

    @property
    def sign(self) -> float:
        """+1 where less is better."""
        return 1.0 if self.aim == "smallest" else -1.0

    @property
    def label(self) -> str:
        """Name of the objective in results."""
        how = [self.of]
        if self.aim == "window" or self.over_loads == "worst":
            how.append("window" if self.aim == "window" else "worst")
        if self.over_scatter not in ("mean", "nominal"):
            how.append(self.over_scatter)
        return ":".join(how)

    def cost(self, metric: Array, weights: Array) -> Array:
        """Cost (P,) of metrics (P, S, J), where sample 0 is nominal."""
        if self.aim == "window":
            inside = ((metric >= self.low) & (metric <= self.high)).astype(float)
            values = -(np.where(np.isnan(metric), np.nan, inside) @ weights)
        elif self.over_loads == "mean":
            values = self.sign * (metric @ weights)
        else:
            values = np.max(self.sign * metric, axis=-1)
        samples = values[:, 1:]
        if self.over_scatter == "nominal" or not samples.shape[1]:
            return values[:, 0]
        if self.over_scatter == "mean":
            return samples.mean(axis=1)
        if self.over_scatter == "robust":
            return samples.mean(axis=1) + self.k * samples.std(axis=1)
        count = 1 if self.over_scatter == "worst" else math.ceil(self.tail * samples.shape[1])
        return np.sort(samples, axis=1)[:, -count:].mean(axis=1)


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit(Value):
    """A bound on a metric at every load.

    Parameters
    ----------
    of : str
        As in `Objective`.
    most, least : float, optional
        In the unit of the metric; at least one.
    share : float, optional
        Part of the scattered samples in which it must hold; in the nominal contact always.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.objectives.Limit(of="plastic_share", most=0.1).share
    1.0
    """

    of: str
    most: float | None = quantity("m_max", "1", "largest value allowed", default=None)
    least: float | None = quantity("m_min", "1", "smallest value allowed", default=None)
    share: float = quantity("q", "1", "part of the samples that must obey", default=1.0, gt=0, le=1)

    def _problems(self) -> list[str]:
        if self.most is None and self.least is None:
            return [
                Problem(
                    "",
                    f"of {self.of} gives neither most nor least",
                    owner=type(self).__name__,
                    code=Mistake.MISSING,
                )
            ]
        return []

    def excess(self, metric: Array) -> Array:
        """By how much the limit is broken, over its size; ≤ 0 where it holds: (P,).

        A metric without a value breaks it.
        """
        over = np.full(metric.shape[:2], -np.inf)
        for limit, sign in ((self.most, 1.0), (self.least, -1.0)):
            if limit is not None:
                worst = np.max(sign * (metric - limit), axis=-1) / (abs(limit) or 1.0)
                over = np.maximum(over, np.where(np.isnan(worst), np.inf, worst))
        nominal, samples = over[:, 0], np.sort(over[:, 1:], axis=1)
        if not samples.shape[1]:
            return nominal
        return np.maximum(nominal, samples[:, math.ceil(self.share * samples.shape[1]) - 1])

    def __str__(self) -> str:
        most = "" if self.most is None else f" <= {self.most:g}"
        least = "" if self.least is None else f"{self.least:g} <= "
        return f"{least}{self.of}{most}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Suspension(Value):
    r"""The fluid that brings the particles: their number follows from size and concentration.

    .. math:: \eta_a = n\,h_{gap}, \qquad n = \frac{\phi}{\langle\pi x^3/6\rangle}

    Parameters
    ----------
    gap : float
        h_gap, the film thickness or trapping gap that closes [m].
    concentration : float, optional
        Needed where it is not searched.
    by : {"mass", "volume", "number", "mass per volume"}, optional
        What the concentration is: w [1], φ [1], n [1/m³] or c [kg/m³].
    particle_density, oil_density : float, optional
        ρ_p, by default that of the material; ρ_f [kg/m³].

    Examples
    --------
    >>> import thirdbody as tb
    >>> dust = tb.Particles(material=tb.materials["quartz"], areal_density=0.0,
    ...                     diameter=tb.LogNormal(median=300e-9, gsd=1.5))
    >>> f"{tb.objectives.Suspension(gap=1e-6, concentration=1e-3).areal_density(dust):.4g}"
    '1.109e+10'
    """

    gap: float = quantity("h_gap", "m", "height of the fluid whose particles are trapped", gt=0)
    concentration: float | None = quantity(
        "c", "1", "how much of the fluid is particles", default=None, gt=0
    )
    by: Literal["mass", "volume", "number", "mass per volume"] = choice(
        "what the concentration is", default="mass"
    )
    particle_density: float | None = quantity(
        "ρ_p", "kg/m^3", "density of the particles", default=None, gt=0
    )
    oil_density: float = quantity(
        "ρ_f", "kg/m^3", "density of the fluid", default=cleanliness.OIL_DENSITY, gt=0
    )

    def areal_density(self, particles: Particles, *, concentration: float | None = None) -> float:
        """Particles per nominal area [1/m²], of these sizes and this material."""
        amount = self.concentration if concentration is None else concentration
        if amount is None:
            raise InvalidValue(
                "Suspension.concentration is missing, and it is not searched", code=Mistake.MISSING
            )
        particle_content = cleanliness.Concentration(float(amount), self.by)
        density = self.particle_density or particles.material.density
        n = cleanliness.particles_in(
            particle_content,
            particles.diameter,
            particle_density=density,
            oil_density=self.oil_density,
        )
        return n * self.gap
