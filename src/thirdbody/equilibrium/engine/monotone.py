"""Whether a separation is the highest that carries a load: above it the load only falls."""

from __future__ import annotations

import math

from ..compiled.machine import keep_apart
from .curves import AREA_1, AREA_2, AT, EDGE, ROOM, TO
from .curves import LOAD as CARRIED
from .fields import (
    BREADTH,
    BREAKS,
    CODE,
    COVERAGE,
    FOOTPRINT,
    JG,
    PRINTED,
    PROJECTED,
    ROUGH,
    SEAT,
    SHADOW,
    SIGMA_S,
    SIZE_2,
    SOFTEST,
    STIFFEST,
    WIDTH,
)  # fmt: skip
from .laid import COUNT, GRID, GRID_END, PIECES, WAY
from .printed import only_falls
from .seats import pays
from .shares import fill_particles, particle_at
from .sides import scalar
from .sums import shade
from .vectors import VECTOR

__all__ = ["only_falls_above"]

RISE = 1e-6
"""Rise of the load with the separation that does not count."""


@scalar
def _pays(given, work, laid, p, bound):
    """Whether the load of each particle of part p grows at least as fast as what it shades.

    The asperities carry ``bound`` [Pa] where nothing is shaded.
    """
    keep_apart()
    panels, coverage = work[2], given[p, COVERAGE]
    if bound > 0.2 * given[p, SOFTEST]:
        return False
    if coverage * (0.5 * math.pi * bound / given[p, STIFFEST]) ** 2 > RISE:
        return False
    own = laid[p, 1]
    if given[p, SEAT] == ROUGH and given[p, BREAKS] == 0 and own[WAY] == PIECES:
        return pays(work[3], own[GRID], own[GRID_END], bound, RISE * bound / coverage)
    most, worst, room = 0.0, 0.0, panels[p, len(panels[p]) - ROOM :]
    for n in range(laid[p, 0, COUNT]):
        a, b = panels[p, n, EDGE], panels[p, n, TO]
        for j in range(VECTOR):
            room[AT, j] = a + (b - a) * (j + 1) / VECTOR
        fill_particles(given, work[1], panels, p, n, VECTOR)
        for j in range(VECTOR):
            left = room[CARRIED, j] - bound * shade(given, p, room[AREA_1, j], room[AREA_2, j])
            most = max(most, left)
            worst = max(worst, most - left)
    return worst * coverage <= RISE * bound


@scalar
def _widest(given, work, laid, p):
    """Share of the area that part p would shade with every particle squeezed as far as it goes."""
    keep_apart()
    n = laid[p, 0, COUNT] - 1
    _, one, two = particle_at(given, work[1], work[2], p, n, work[2][p, n, TO])
    return given[p, COVERAGE] * shade(given, p, one, two) / (0.25 * math.pi * given[p, BREADTH])


@scalar
def only_falls_above(given, skin, work, laid, bound, h):
    """Whether no separation above d can carry the load, of which asperities take ``bound`` [Pa].

    Either a particle gains by each squeeze what it takes from the asperities, the bound times its
    shadow, or the shadow of all grows more slowly with the approach than the asperities' load:
    that of a Gaussian seat of a width s, up to c in all, by c/(s √(2π)) at most, and their load by
    0.3/σ_s of itself at least: by one over the mean excess of the heights or more, which falls
    with the separation for all heights that the kernel knows, and is 3 σ_s at its lowest; a fifth
    as much by the law of Jackson and Green, whose load may grow like the sixth root of ω only.

    The load of asperities that attract changes its sign once with the separation, as that of one
    does with its interference, for heights whose density is log-concave (Karlin 1968, Total
    Positivity, ch. 5): where it is positive it falls, and as fast as without attraction at least.
    """
    keep_apart()
    sigma_s, least = skin[0, SIGMA_S], 0.05 if skin[0, CODE] == JG else 0.3
    d = h * sigma_s
    if bound < 0:
        return False
    steepest = covered = 0.0
    for p in range(len(given)):
        if given[p, SEAT] == PRINTED:
            if not only_falls(given, p, d, bound):
                return False
            continue
        shadow = given[p, SHADOW]
        if shadow != FOOTPRINT and shadow != PROJECTED:
            continue
        covered += given[p, COVERAGE]
        rough = given[p, SEAT] == ROUGH
        if shadow == PROJECTED:
            width = given[p, WIDTH] if rough else given[p, SIZE_2]
            if not width > 0:
                return False
            steepest += given[p, COVERAGE] / (2.5 * width)
        if not _pays(given, work, laid, p, bound):
            if not rough or not given[p, WIDTH] > 0:
                return False
            widest = _widest(given, work, laid, p)
            steepest += widest / (2.5 * given[p, WIDTH])
            covered += widest
    return steepest * sigma_s <= least * (1 - covered)
