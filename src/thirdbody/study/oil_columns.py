"""What the particles of an oil do, as columns beside the speeds of a film."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from .dirty_oil import DirtyOil

__all__ = ["OilColumn", "columns_of_oil"]

OF_POPULATION = {
    "per_hour": ("1/h", "dents in the whole track per hour"),
    "per_overrolling": ("1/m^2", "dents per area of track and overrolling"),
    "depth": ("m", "mean depth of its dents, an upper bound"),
    "depth_p95": ("m", "depth that 5 % of its dents exceed"),
    "deepest": ("m", "depth of the deepest dent of an hour (median)"),
    "width": ("m", "mean diameter of its dents"),
}
OF_LIFE = {
    "kappa": ("1", "viscosity ratio of ISO 281"),
    "e_C": ("1", "contamination factor of ISO 281"),
    "a_ISO": ("1", "life factor of ISO 281"),
    "hours": ("h", "rating life of ISO 281"),
}
"""Numbers by the names that the JSON has for them: unit and meaning."""


class OilColumn(NamedTuple):
    """One number of the oil, with a place for each speed; None where it is not known."""

    name: str
    unit: str
    meaning: str
    values: list[float | None]


def columns_of_oil(
    oil: DirtyOil | None, speeds: Sequence[float], *, before: str = ""
) -> list[OilColumn]:
    """Columns of dents and life, at the one speed of which `dirty_oil` tells; others are empty.

    Parameters
    ----------
    oil : DirtyOil or None
    speeds : sequence of float
        Of the rows [m/s].
    before : str, optional
        What stands before each name, as "oil_filtered: ".

    Returns
    -------
    list of OilColumn
        Empty without oil, and where its speed is none of these.
    """
    if oil is None or oil.speed not in speeds:
        return []
    return [
        OilColumn(
            f"{before}{name}",
            unit,
            meaning,
            [value if speed == oil.speed else None for speed in speeds],
        )
        for name, unit, meaning, value in _numbers(oil)
    ]


def _numbers(oil: DirtyOil) -> Iterator[tuple[str, str, str, float | None]]:
    """Name, unit, meaning and value of each number."""
    for population in oil.populations:
        for name, (unit, meaning) in OF_POPULATION.items():
            yield f"{population.name}: {name}", unit, meaning, _finite(getattr(population, name))
    if oil.life is not None:
        for name, (unit, meaning) in OF_LIFE.items():
            yield name, unit, meaning, _finite(getattr(oil.life, name))


def _finite(value: float) -> float | None:
    """The number, None where it is not finite."""
    return value if math.isfinite(value) else None
