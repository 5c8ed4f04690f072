"""What one surface carries at each separation, and what such a draw carries on average."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import ndtr

from ..contact.contact import Contact
from .interface import Interface, Map, interface_of, law_tables
from .press import Pressed
from .seats import AbstractSeats, GivenSeats, RandomSeats, height_at
from .solve import Effort, curve, numbers_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["EXPECTED", "SUMS", "one_surface", "places"]

PLACES = 20_000
"""Places drawn on each map to know the heights of a seat."""
WIDTHS = np.linspace(-6.0, 6.0, 241)
"""Averages are over the sizes of these Gaussian quantiles, so that a wide tail counts."""
SUMS = ("asperities", "particles", "area", "particle_area", "bearing", "law", "law_area", "bare")
"""What each surface gives at each separation: loads [N] and areas [m²]."""
EXPECTED = ("bearing", "law", "law_area")
"""Those of which the mean over all draws is known."""


def one_surface(
    contact: Contact,
    surface: Map,
    rule: AbstractSeats,
    grid: Array,
    seed: int,
    *,
    cap: str | float | None,
    effort: Effort,
    gaussian: bool,
) -> dict[str, object]:
    """The sums of one surface at every separation, as plain data."""
    rng = np.random.default_rng(seed)
    inside = interface_of(contact, surface, seats=rule, cap=cap, rng=rng)
    states, _ = curve(inside, "h", grid, effort)
    bare = curve(inside.bare(), "h", grid, effort)[0] if len(inside.bodies) else states
    out: dict[str, list[float]] = {name: [] for name in SUMS}
    columns = [numbers_of(inside, state) for state in states]
    pixel = surface.spacing**2
    for h, state, alone in zip(grid.tolist(), states, bare, strict=True):
        sums = _sums(inside, h, state, alone, pixel)
        for name in SUMS:
            out[name].append(sums[name])
    zeta = places(surface, rule, contact, np.random.default_rng([seed, 1]))
    return {
        **out,
        "nominal": surface.area,
        "sigma": surface.sigma,
        "converged": [a.converged and b.converged for a, b in zip(states, bare, strict=True)],
        "columns": {name: [row[name] for row in columns] for name in columns[0]},
        "zeta": [float(np.sum(zeta)), float(np.sum(zeta**2)), int(np.sum(zeta > 2.5)), len(zeta)],
        "warnings": [str(note) for note in inside.warnings],  # plain, as files keep them
        "expected": _sums_of_draw(contact, surface, rule, zeta, grid, gaussian),
    }


def _sums(
    inside: Interface, h: float, state: Pressed, alone: Pressed, pixel: float
) -> dict[str, float]:
    bodies, area = inside.bodies, inside.map.area
    numbers = numbers_of(inside, state)
    squeeze = bodies.diameter + inside.zeta - h
    law_area = 0.0
    for i, law in enumerate(bodies.laws):
        here = (bodies.kind == i) & (squeeze > 0)
        x = bodies.diameter[here]
        law_area += float(np.sum(x**2 * law.area(squeeze[here] / x)))
    return {
        "asperities": float(np.sum(state.p)) * pixel,
        "particles": float(np.sum(state.f)),
        "area": numbers["A_ss"] * area,
        "particle_area": numbers["A_sa"] * area,
        "bearing": float(np.sum(inside.map.z > h)) * pixel,
        "law": float(np.sum(bodies.force(squeeze))),
        "law_area": law_area,
        "bare": float(np.sum(alone.p)) * pixel,
    }


def places(surface: Map, rule: AbstractSeats, contact: Contact, rng: np.random.Generator) -> Array:
    """Relative seat heights ζ/σ of many places that follow the rule."""
    if not contact.populations or isinstance(rule, GivenSeats):
        return np.empty(0)
    count = int(min(PLACES, rule.room(surface.z)))
    size = contact.populations[0].diameter.sample(rng, PLACES)[:count]
    seated = rule.draw(surface.z, surface.spacing, size, rng)
    heights = height_at(surface.z, surface.spacing, seated.x, seated.y) + seated.lift
    return heights / (surface.sigma or 1.0)


def _sums_of_draw(
    contact: Contact,
    surface: Map,
    rule: AbstractSeats,
    zeta: Array,
    grid: Array,
    gaussian: bool,
) -> dict[str, list[float]]:
    """What the draw gives on average: bearing area, sums of the law [m², N, m²]."""
    sigma = surface.sigma
    if not gaussian:
        bearing = np.array([np.mean(surface.z > h) for h in grid])
    else:
        bearing = np.array([0.5 * math.erfc(h / (sigma * math.sqrt(2))) for h in grid])
    if gaussian and isinstance(rule, RandomSeats):
        mean, std = 0.0, 1.0
    elif len(zeta):
        mean, std = float(np.mean(zeta)), float(np.std(zeta))
    else:
        mean, std = math.nan, math.nan
    # dense heights for the sum over seats: a Gaussian of their mean and width, or the seats drawn
    if gaussian or isinstance(rule, GivenSeats):
        t = np.linspace(-7, 7, 1401)
        weight = np.exp(-(t**2) / 2)
        seats, weight = (mean + std * t) * sigma, weight / weight.sum()
    else:
        seats, weight = np.sort(zeta) * sigma, np.full(len(zeta), 1 / max(len(zeta), 1))
    force, area = np.zeros(len(grid)), np.zeros(len(grid))
    size_weights = np.exp(-(WIDTHS**2) / 2)
    size_weights /= size_weights.sum()
    for population, law in zip(contact.populations, law_tables(contact), strict=True):
        sizes, same = np.unique(population.diameter.ppf(ndtr(WIDTHS)), return_inverse=True)
        for x, weighs in zip(sizes, np.bincount(same, size_weights), strict=True):
            share = population.areal_density * surface.area * weighs
            for i, h in enumerate(grid):
                eps = (x + seats - h) / x
                force[i] += share * x**2 * float(np.sum(weight * law.force(eps)))
                area[i] += share * x**2 * float(np.sum(weight * law.area(eps)))
    return {
        "bearing": (bearing * surface.area).tolist(),
        "law": force.tolist(),
        "law_area": area.tolist(),
    }
