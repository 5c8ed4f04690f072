"""The cross-section to scale, as SVG: rough profile, flat, and the particles between them.

What is drawn is one draw from the model. The profile is a sum of waves with the moments of the
roughness: over many draws its RMS height is σ, its curvature gives R, its bandwidth is α. The
particles in a slab of stated depth lie on their seats; those larger than the gap above their seat
are loaded. A population that carries has one at least: where the slab held none, one is drawn from
those of the model that are, at another place of the surface if need be.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from html import escape
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from scipy import special

import thirdbody as tb

from ..quantities.say import value_of
from ..views.palette import OKABE_ITO

__all__ = ["Section", "section", "to_svg"]

Array = NDArray[np.float64]
Scale = Callable[[float], float]
WAVES = 96
POINTS = 900
DRAWN = 12
"""Particles drawn, about; the depth of the slab follows from it."""
LEAST = 3.0
"""Half a height in the drawing, of 1000 wide, below which a particle is pointed at."""
CARRIES = 5e-4
"""Share of the load below which no loaded particle is looked for."""
PLACES = 64
"""Profiles among which one with a place for a loaded particle is looked for."""
TAIL = 1 - np.geomspace(1, 1e-12, 400)
"""Parts of a population, finer towards its largest."""
COLOURS = tuple(OKABE_ITO[name] for name in ("orange", "sky", "purple", "green"))


@dataclass(frozen=True)
class Grain:
    """One particle of the drawing, in metres."""

    population: int
    diameter: float
    place: float
    seat: float
    gap: float

    @property
    def is_loaded(self) -> bool:
        return self.diameter > self.gap


@dataclass(frozen=True)
class Section:
    """What the drawing shows, in metres: heights count from the mean surface plane."""

    x: Array
    z: Array
    h: float
    d: float
    grains: tuple[Grain, ...]
    depth: float
    """of the slab whose particles are drawn [m]; 0 without particles"""
    sparse: float
    """square metres of surface with one particle [m²]; 0 without particles"""
    names: tuple[str, ...]
    soft: tuple[bool, ...]
    """Populations that are softer than both surfaces: they give way."""
    met: bool = False
    """Whether a loaded particle stands for a free one."""

    @property
    def width(self) -> float:
        return float(self.x[-1] - self.x[0])


@lru_cache(maxsize=32)
def profile(sigma: float, R: float, alpha: float, width: float, seed: int) -> tuple[Array, Array]:
    """A Gaussian profile with RMS height σ, tip radius R and bandwidth α."""
    m0, m4 = sigma**2, (3 * math.sqrt(math.pi) / (8 * R)) ** 2
    m2 = math.sqrt(m0 * m4 / alpha)
    # squared wave numbers spread so that <k²> = m2/m0 and <k⁴> = α <k²>²
    shape = 1 / (alpha - 1)
    probability = (np.arange(WAVES) + 0.5) / WAVES
    k2 = special.gammaincinv(shape, probability) * (m2 / m0 / shape)  # quantiles of a gamma law
    k2 *= (m2 / m0) / k2.mean()
    rng = np.random.default_rng(seed)
    phases = rng.uniform(0, 2 * math.pi, WAVES)
    x = np.linspace(0, width, POINTS)
    waves = np.cos(np.outer(x, np.sqrt(k2)) + phases)
    return x, sigma * math.sqrt(2 / WAVES) * waves.sum(axis=1)


def section(
    contact: tb.Contact, state: tb.results.Equilibrium, *, seed: int = 0, held: float = math.inf
) -> Section:
    """One draw from the model at a solved state; with no more particles than one contact holds.

    Where it holds less than one, that one is drawn of each population.
    """
    rough = contact.roughness
    h, d = float(np.ravel(state.h)[0]), float(np.ravel(state.d)[0])
    dusts = contact.populations
    largest = max((float(dust.diameter.ppf(0.999)) for dust in dusts), default=0.0)
    tall = 3 * rough.sigma + max(4 * rough.sigma, largest)
    width = float(f"{8.5 * tall:.2g}")
    carriers = [i for i, share in enumerate(_shares(state)) if share > CARRIES]

    def room(other: int) -> tuple[Array, Array, dict[int, tuple[Array, Array]]]:
        x, z = profile(rough.sigma, rough.R, rough.alpha, width, seed + 1000 * other)
        every = {i: _chances(contact, dusts[i], z, h) for i in carriers}
        return x, z, {i: pair for i, pair in every.items() if pair[1].any()}

    rooms = map(room, range(PLACES))
    x, z, chances = next((r for r in rooms if len(r[2]) == len(carriers)), room(0))
    density = sum(dust.areal_density for dust in dusts)
    depth = min(DRAWN, max(held, 1.0)) / (density * width) if density else 0.0
    rng = np.random.default_rng(seed + 1)
    grains: list[Grain] = []
    met = False
    for number, dust in enumerate(dusts):
        expected = dust.areal_density * width * depth
        count = max(round(expected), 1)
        sizes = dust.diameter.ppf((rng.permutation(count) + rng.uniform(size=count)) / count)
        places = width * (np.arange(count) + rng.uniform(0.15, 0.85, count)) / count
        for diameter, place in zip(np.ravel(sizes), places, strict=True):
            place, seat = _seat(contact, dust, float(place), x, z, rng)
            # particles of the slab lie before or behind the cut where they would leave the picture
            grains.append(Grain(number, float(diameter), place, seat, h - seat))
        if number in chances and not any(grain.is_loaded for grain in grains[-count:]):
            met = True
            grains[-1 - int(rng.integers(count))] = _draw_loaded_grain(
                number, dust, x, *chances[number], h, rng
            )
    pair = contact.surfaces
    hardness = min(pair.first.H, pair.second.H)
    return Section(
        x=x,
        z=z,
        h=h,
        d=d,
        grains=tuple(grains),
        depth=depth,
        sparse=1 / density if density else 0.0,
        names=tuple(
            dust.name or dust.material.name or f"particles {i + 1}" for i, dust in enumerate(dusts)
        ),
        soft=tuple(dust.material.H < hardness for dust in dusts),
        met=met,
    )


def _shares(state: tb.results.Equilibrium) -> list[float]:
    """Of the load, on each population."""
    if state.contact.two_body:
        return []
    if state.populations:
        return [float(np.ravel(population.load_share)[0]) for population in state.populations]
    return [float(np.ravel(state.particle_load_share)[0])]


def _chances(contact: tb.Contact, dust: tb.Particles, z: Array, h: float) -> tuple[Array, Array]:
    """Seat heights along the profile, and how probable a particle there is loaded."""
    law = contact.law_of(dust)
    seats = z if getattr(law, "seat", "plane") == "rough" else np.full_like(z, _flat(contact, law))
    sizes = np.asarray(dust.diameter.ppf(TAIL), dtype=float)
    larger = np.searchsorted(sizes, h - seats, side="right")
    return seats, np.append(1 - TAIL, 0.0)[larger]


def _draw_loaded_grain(
    number: int,
    dust: tb.Particles,
    x: Array,
    seats: Array,
    chances: Array,
    h: float,
    rng: Generator,
) -> Grain:
    """One of the particles of the model that are loaded."""
    at = int(rng.choice(len(x), p=chances / chances.sum()))
    # the parts of the population that are large enough there
    probability = 1 - chances[at] * rng.uniform(0, 1)
    diameter = float(dust.diameter.ppf(probability))
    return Grain(number, diameter, float(x[at]), float(seats[at]), float(h - seats[at]))


def _seat(
    contact: tb.Contact, dust: tb.Particles, place: float, x: Array, z: Array, rng: Generator
) -> tuple[float, float]:
    """Place and seat height of one particle, by the seat of its law."""
    law: Any = contact.law_of(dust)
    rough = contact.roughness
    kind = getattr(law, "seat", "plane")
    if kind == "rough":
        mean, spread = law.zeta_mean, law.zeta_std
        if (mean, spread) != (0.0, 1.0):
            wanted = rough.sigma * rng.normal(mean, spread)
            near = np.abs(z - wanted) / rough.sigma + np.abs(x - place) / np.ptp(x)
            place = float(x[int(np.argmin(near))])
        return place, float(np.interp(place, x, z))
    return place, _flat(contact, law)


def _flat(contact: tb.Contact, law: Any) -> float:
    """The seat height of a law that has one for all particles."""
    if getattr(law, "seat", "plane") == "offset":
        return float(contact.roughness.y_s + law.h_0)
    return float(contact.roughness.y_s) if hasattr(law, "seat") else 0.0


# ---------------------------------------------------------------------- drawing
def to_svg(drawn: Section, *, title: str = "Cross-section") -> str:
    """The drawing; one scale for both axes. Colours of paper and ink are those of the page."""
    top = max(drawn.h, float(drawn.z.max()), *(g.seat + g.diameter for g in drawn.grains), 0.0)
    low, high = float(min(drawn.z.min(), 0.0)), top
    low, high = low - 0.12 * (high - low), high + 0.12 * (high - low)
    scale = 1000 / drawn.width
    W, H = 1000.0, scale * (high - low)

    def X(x: float) -> float:
        return scale * x

    def Y(z: float) -> float:
        return H - scale * (z - low)

    def line(x: Array, z: Array) -> str:
        return " ".join(f"{X(a):.1f},{Y(b):.1f}" for a, b in zip(x, z, strict=True))

    flat = Y(drawn.h)
    body = f"0,{H:.1f} {line(drawn.x, np.minimum(drawn.z, drawn.h))} {W:.0f},{H:.1f}"
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="-112 -4 {W + 112:.0f} {H + 52:.1f}" '
        'role="img" class="section" font-family="sans-serif" font-size="15">',
        f"<title>{escape(title)}</title>",
        "<style>.ink{fill:currentColor}.edge{stroke:currentColor;fill:none}"
        f".spot{{stroke:{OKABE_ITO['vermilion']};stroke-width:5;stroke-linecap:round}}</style>",
        f'<polygon class="body rough" points="{body}" fill="#8a8f98" fill-opacity="0.55"/>',
        f'<rect class="body flat" x="0" y="0" width="{W:.0f}" height="{max(flat, 0):.1f}" '
        'fill="#8a8f98" fill-opacity="0.35"/>',
    ]
    out += [_grain(drawn, grain, X, Y, scale) for grain in drawn.grains]
    out.append(
        f'<polyline class="edge" points="{line(drawn.x, np.minimum(drawn.z, drawn.h))}" '
        'stroke-width="1.6"/>'
    )
    out.append(
        f'<line class="edge" x1="0" x2="{W:.0f}" y1="{flat:.1f}" y2="{flat:.1f}" '
        'stroke-width="1.6"/>'
    )
    for start, end in _runs(drawn.z >= drawn.h):
        a, b = X(drawn.x[start]), X(drawn.x[end])
        out.append(
            f'<line class="spot asperity" x1="{a:.1f}" x2="{b:.1f}" y1="{flat:.1f}" '
            f'y2="{flat:.1f}"/>'
        )
    out += _measures(drawn, X, Y, H, scale)
    return "".join(out) + "</svg>"


def _grain(drawn: Section, grain: Grain, X: Scale, Y: Scale, scale: float) -> str:
    """One particle: round while free, sunk into both surfaces or flattened under load."""
    radius = 0.5 * grain.diameter
    middle = grain.seat + radius
    rx = ry = radius
    if grain.is_loaded:
        middle = grain.seat + 0.5 * grain.gap
        if drawn.soft[grain.population]:
            ry = max(0.5 * grain.gap, 0.1 * radius)
            rx = min(radius * math.sqrt(radius / ry), 2.5 * radius)
    colour = COLOURS[grain.population % len(COLOURS)]
    kind = "loaded" if grain.is_loaded else "free"
    place = X(grain.place), Y(middle) - scale * ry - 6
    # one that is squashed to a line has a mark over it
    pointer = f'<path class="ink" d="M{place[0]:.1f} {place[1]:.1f}l-6 -11h12z"/>'
    stroke = (
        f'stroke="{OKABE_ITO["vermilion"]}" stroke-width="3"'
        if grain.is_loaded
        else 'stroke="currentColor" stroke-width="1.2" stroke-dasharray="4 3"'
    )
    return (
        f'<ellipse class="grain {kind}" cx="{X(grain.place):.1f}" cy="{Y(middle):.1f}" '
        f'rx="{scale * rx:.1f}" ry="{scale * ry:.1f}" fill="{colour}" '
        f'fill-opacity="{0.95 if grain.is_loaded else 0.45}" {stroke}/>'
    ) + pointer * (scale * ry < LEAST)


def _measures(drawn: Section, X: Scale, Y: Scale, H: float, scale: float) -> list[str]:
    """The mean plane, the separation, and a bar for scale."""
    length = _round_length(drawn.width / 6)
    bar = value_of(length, "m")
    x, mean, flat = -16.0, Y(0.0), Y(drawn.h)
    y = H + 30
    return [
        f'<line class="edge" x1="-16" x2="1000" y1="{mean:.1f}" y2="{mean:.1f}" '
        'stroke-dasharray="2 6" stroke-opacity="0.7"/>',
        f'<line class="edge" x1="{x}" x2="{x}" y1="{mean:.1f}" y2="{flat:.1f}" stroke-width="2"/>',
        f'<path class="ink" d="M{x - 5} {flat + 9:.1f}L{x} {flat:.1f}L{x + 5} {flat + 9:.1f}z'
        f'M{x - 5} {mean - 9:.1f}L{x} {mean:.1f}L{x + 5} {mean - 9:.1f}z"/>',
        f'<text class="ink" x="{x - 12}" y="{0.5 * (mean + flat) + 5:.1f}" text-anchor="end">'
        f"{value_of(drawn.h, 'm')}</text>",
        f'<line class="edge" x1="0" x2="{scale * length:.1f}" y1="{y}" y2="{y}" stroke-width="4"/>',
        f'<text class="ink" x="{10 + scale * length:.1f}" y="{y + 5}">{bar}, both axes</text>',
    ]


def _round_length(about: float) -> float:
    size = 10 ** math.floor(math.log10(about))
    return next(step * size for step in (5, 2, 1) if step * size <= about * 1.0001)


def _runs(inside: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and last index of every run of True."""
    steps = np.flatnonzero(np.diff(np.concatenate([[False], inside, [False]])))
    return [(int(a), int(b) - 1) for a, b in zip(steps[::2], steps[1::2], strict=True)]
