r"""Error bars of one map: what it says without each of its blocks (jackknife), at the same load.

Without a block b the others carry another mean pressure :math:`p_{-b}`, so that what they say is
brought back to the load by the slope of the whole map's own curve:

.. math:: q'_b = q_{-b} + \frac{\mathrm d q}{\mathrm d\ln p} \ln\frac{p}{p_{-b}}, \qquad
          \delta q = \sqrt{\frac{B - 1}{B} \sum_b (q'_b - \bar q')^2}

with :math:`q` the mean gap h, the logarithm of the real area, and the shares of the particles.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ..errors import Note
from ..quantities.carried import takes_units
from ..quantities.say import percent
from .press import contact_share

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .interface import Interface
    from .press import Pressed

    Array = NDArray[np.float64]

__all__ = ["BLOCKS", "ERRORS", "STEP", "block_sums", "errors_of", "long_waves"]

BLOCKS = 4
"""Blocks along each side of a map."""
STEP = 1.5
"""The load over which the slope of the map's curve is taken."""
ERRORS = ("h", "A_t", "particle_load_share", "particle_area_share")
"""Columns that have an error."""
TOGETHER = 0.3
"""RMS of the mean heights of the blocks, over σ, above which they are no draws of their own."""


def block_sums(inside: Interface, state: Pressed, dented: Array, blocks: int) -> Array:
    """Loads and areas of pixels and particles [N, m²], volume of the gap [m³]: (5, blocks²).

    ``dented`` is the area of each particle on the first surface.
    """
    shape, spacing = state.p.shape, inside.map.spacing
    rows, columns = (np.arange(count) * blocks // count for count in shape)
    of_pixels = (rows[:, None] * blocks + columns).ravel()
    places = zip((inside.bodies.x, inside.bodies.y), shape, strict=True)
    x, y = ((place / (count * spacing) % 1.0 * blocks).astype(int) for place, count in places)
    of_particles = np.minimum(x, blocks - 1) * blocks + np.minimum(y, blocks - 1)
    share = contact_share(state.p, inside.c, inside.cap)
    gap = state.h + state.u - inside.map.z
    pixels = (np.bincount(of_pixels, field.ravel(), blocks**2) * spacing**2
              for field in (state.p, share, gap))  # fmt: skip
    particles = (np.bincount(of_particles, values, blocks**2) for values in (state.f, dented))
    load, area, volume = pixels
    on_particles, dents = particles
    return np.stack([load, on_particles, area, dents, volume])


@takes_units
def errors_of(sums: Array, steeper: Array, area: float) -> Array:
    """Standard errors of `ERRORS` at the load of a map (4,); NaN where nothing is known.

    Parameters
    ----------
    sums : array (5, B)
        What `block_sums` says at the load.
    steeper : array (5,)
        Sums over the whole map at another load, which give the slopes.
    area : float
        Nominal area of the map [m²].
    """
    count = sums.shape[1]
    whole = sums.sum(axis=1)
    if not whole[:2].sum() > 0:
        return np.full(len(ERRORS), math.nan)
    here, there = (_figures_of_sums(totals[:, None], area) for totals in (whole, steeper))
    rise = math.log(steeper[:2].sum() / whole[:2].sum())
    slope = (there - here) / rise
    left = whole[:, None] - sums
    kept_share = (count - 1) / count
    with np.errstate(divide="ignore", invalid="ignore"):
        away = np.log(kept_share * whole[:2].sum() / left[:2].sum(axis=0))
        without = _figures_of_sums(left, area * kept_share) + slope * away
        spread = without - without.mean(axis=1, keepdims=True)
    out = np.sqrt(kept_share * np.sum(spread**2, axis=1))
    out[1] *= math.exp(here[1, 0])
    # that every block says the same is no knowledge of the next
    return np.where(np.isfinite(out) & (out > 0), out, math.nan)


def _figures_of_sums(sums: Array, area: float) -> Array:
    """Separation, logarithm of the real area, shares of particles: (4, n)."""
    load, on_particles, touched, dents, volume = sums
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.stack([
            volume / area, np.log((touched + dents) / area), on_particles / (load + on_particles),
            dents / (touched + dents),
        ])  # fmt: skip


def long_waves(z: Array, sigma: float, blocks: int) -> Note | None:
    """Why blocks of a map are no draws of their own: waves longer than a block."""
    means = [np.mean(block) for row in np.array_split(z, blocks) for block in
             np.array_split(row, blocks, axis=1)]  # fmt: skip
    ratio = float(np.std(means)) / sigma if sigma else 0.0
    if ratio <= TOGETHER:
        return None
    return Note(
        f"the error bars of this one map are rough: waves longer than a block of it carry "
        f"{percent(ratio**2)} of the variance of its heights",
        code="blocks",
        action="press more or larger maps",
    )
