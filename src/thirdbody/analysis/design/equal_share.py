"""The size at which particles and asperities share the load equally: the turning-point rule."""

from __future__ import annotations

import itertools
import math

import numpy as np

from ...contact.contact import Contact
from ...equilibrium.modes import need_shares
from ...equilibrium.solve import solve
from ...errors import InvalidValue, Mistake, Problem
from ...quantities.arguments import need_positive
from ...quantities.carried import takes_units

__all__ = ["equal_share_size"]


@takes_units
def equal_share_size(
    contact: Contact,
    *,
    pressure: float | None = None,
    F_star: float | None = None,
    low: float = 0.05,
    high: float = 20.0,
    share: float = 0.5,
) -> float:
    r"""Mean particle size over σ at which particles carry a given share of the load.

    .. math:: s(x_a; F) = \tfrac12

    The size of equal shares at one load: definition B of the turning point, seen from the size.
    It moves with load, density and tip radius; no single x_a/σ stands for it.

    Parameters
    ----------
    contact : Contact
        With one population; its size distribution is scaled as a whole.
    pressure, F_star : float
        The load, as in `solve`.
    low, high : float, optional
        Range of x_a/σ searched [1].
    share : float, optional
        Load share of the particles.

    Returns
    -------
    float
        x_a/σ of the smallest such size; NaN where there is none in the range.

    References
    ----------
    Horng et al. 2022, Lubricants 10(7), 164, doi:10.3390/lubricants10070164, finds 0.5 to 0.7, the
    later paper of the group, doi:10.3389/fmech.2024.1390335, 0.8 to 1.3.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=3.5e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=30e-9)))
    >>> round(tb.equilibria.equal_share_size(contact, pressure=5e6), 3)
    2.509
    """
    from scipy.optimize import brentq

    need_positive(low=low, high=high)
    if not low < high:
        raise InvalidValue(
            Problem("low", f"must be below high = {high!r}", repr(low), code=Mistake.ORDER)
        )
    need_shares(share=share)
    if len(contact.populations) != 1:
        raise InvalidValue(
            "equal_share_size needs exactly one population of particles", code=Mistake.MISSING
        )
    (dust,) = contact.populations
    unit = contact.roughness.sigma / dust.diameter.mean_diameter
    bare = contact.replace(outputs=())

    def excess(log_ratio: float) -> float:
        sizes = dust.diameter.scaled(math.exp(log_ratio) * unit)
        try:
            made = bare.replace(particles=dust.replace(diameter=sizes))
        except InvalidValue:  # jammed: particles that cover the area carry everything
            return 1 - share
        state = solve(made, F_star=F_star, pressure=pressure)
        return float(state.particle_load_share) - share

    grid = np.linspace(math.log(low), math.log(high), 49)
    before = excess(float(grid[0]))
    for start, end in itertools.pairwise(grid):
        after = excess(float(end))
        if before < 0 <= after:
            return math.exp(brentq(excess, start, end, xtol=1e-12))
        before = after
    return math.nan
