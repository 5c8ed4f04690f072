r"""What a mass from oil reports leaves out, and what of it no report counts.

.. math:: m(s) = \frac{\pi\rho x^3}{6}\,\frac{s}{3-s}\,
                 \frac{(X/x)^{3-s} - 1}{1 - (X/x)^{-s}}
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ...populations.measured.cleanliness import LARGEST, TAIL_SLOPE, dust_sizes
from ...quantities.say import number, percent, value_of

if TYPE_CHECKING:
    from .reports import OilReports

__all__ = ["below_counts", "beyond_counts", "share_beyond", "zero_counts"]

COARSE, FINE = 2.0, 5.0
"""Slopes beyond the last size between which that of an oil lies: A4 has 2."""
DUSTS = ("A1", "A4")
"""The finest and the coarsest of the test dusts, by mass."""


def below_counts(reports: OilReports) -> str:
    """What the mass leaves out, because no report counts it.

    Parameters
    ----------
    reports : OilReports
    """
    first = float(reports.sizes[0])
    shares = [
        float(dust.partial_moment(3, 0.0, first)) / dust.moment(3)
        for dust in map(dust_sizes, DUSTS)
    ]
    return (
        f"Particles below {value_of(first, 'm')} are not counted and not in it; of the test dusts "
        f"A4 to A1 they are {percent(shares[1], digits=2)} to {percent(shares[0], digits=2)} of "
        "the mass."
    )


def mass_beyond(reports: OilReports, slope: float) -> float:
    """Mass per time of particles beyond the largest counted size, falling with a slope [kg/s]."""
    x = float(reports.sizes[-1])
    ratio = LARGEST["iso4406"] / x
    size = slope / (3 - slope) * (ratio ** (3 - slope) - 1) / (1 - ratio**-slope)
    density = reports.ingress.material.density or math.nan
    return float(reports.rate[-1]) * density * math.pi / 6 * x**3 * size


def share_beyond(reports: OilReports) -> float:
    """Part of the mass that is of particles beyond the largest counted size [1].

    Parameters
    ----------
    reports : OilReports
    """
    return mass_beyond(reports, TAIL_SLOPE) / reports.mass_rate if reports.mass_rate > 0 else 0.0


def beyond_counts(reports: OilReports) -> str | None:
    """How much of the mass hangs on sizes that no report says; None where nothing does.

    Parameters
    ----------
    reports : OilReports
    """
    share = share_beyond(reports)
    if not share > 0:
        return None
    more, less = (
        percent(
            abs(mass_beyond(reports, slope) - mass_beyond(reports, TAIL_SLOPE)) / reports.mass_rate
        )
        for slope in (COARSE, FINE)
    )
    size, end = value_of(float(reports.sizes[-1]), "m"), value_of(LARGEST["iso4406"], "m")
    return (
        f"{percent(share, digits=2)} of this mass is of particles beyond {size}, whose sizes no "
        f"report says: their count is taken to fall with the power {TAIL_SLOPE:g} up to {end}, as "
        f"in SAE AS4059. With the power {COARSE:g} of a coarse dust the mass is {more} more, with "
        f"{FINE:g} {less} less."
    )


def zero_counts(reports: OilReports) -> str | None:
    """How counts of 0 are taken; None where there are none.

    Parameters
    ----------
    reports : OilReports
    """
    zeros = int(np.sum(reports.counts == 0))
    if not zeros:
        return None
    counts = "1 count is" if zeros == 1 else f"{zeros} counts are"
    least = f"{number(reports.least / 1e6, 2)} /mL"
    return (
        f"{counts} 0: taken as anything below {least}, below the least count of its size and below "
        "that of the smaller size."
    )
