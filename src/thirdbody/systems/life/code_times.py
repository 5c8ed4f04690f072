"""How soon the counts of an oil are where they end, and which sizes take far longer."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.optimize import brentq

from ...quantities.carried import takes_units
from .circuit import LEAKED, SETTLED, OilTerms

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["SlowSizes", "slow_sizes", "times_within"]

HALF_CODE = math.sqrt(2.0)
"""Half a number of an ISO 4406 code, as a factor on the count."""
NONE_LEFT = 1e4
"""Count at which number 0 of a code ends [1/m³]; below, a count that falls to none has ended."""
LEFT = 0.01
"""Part of the way of a size that is left when its time is over."""
FAR = 10.0
"""Times of the code after which a size that still changes is a slow one."""
PER_OCTAVE, OCTAVES = 4, 50
"""Times that are looked at for each factor of two, and how many of these."""


class SlowSizes(NamedTuple):
    """Sizes that go on when the counts of a code have long ended; made by `slow_sizes`."""

    below: float
    """All of them are smaller than this [m]."""
    time: float
    """Until a hundredth of the way is left, of the slowest one [s]; infinite if they never end."""
    taken_by: str
    """What alone takes them out: "settled", "leaked", the name of a filter, or "" for nothing."""


@takes_units
def times_within(
    counts: Callable[[float], Array], end: Array, *, first: float, factor: float = HALF_CODE
) -> tuple[float, ...]:
    """Times from which counts stay within a factor of their ends [s].

    Parameters
    ----------
    counts : callable
        Counts after a time [s], (S,) [1/m³].
    end : array (S,)
        Their ends [1/m³]; NaN for none.
    first : float
        The first time that is looked at [s]; each next one is a factor 2^¼ later.
    factor : float, optional
        Above 1 [1].

    Returns
    -------
    tuple of float
        0 for what is there at once, NaN for what has no end or does not come there.

    Examples
    --------
    >>> end = np.array([1e9])
    >>> halves = times_within(lambda t: end * (1 + 9 * 0.5**t), end, first=0.01)
    >>> f"{halves[0]:.5f}", f"{math.log2(9 / (math.sqrt(2) - 1)):.5f}"
    ('4.44148', '4.44148')
    """
    within = [first * 2.0 ** (j / PER_OCTAVE) for j in range(PER_OCTAVE)]
    # times a power of two is exact: half of a time is one of them
    times = [0.0, *(math.ldexp(time, n) for n in range(OCTAVES) for time in within)]
    ends = np.asarray(end, float)
    out = []
    seen: dict[float, Array] = {}

    def far(time: float, i: int) -> float:
        if time not in seen:
            seen[time] = np.asarray(counts(time), float)
        now = float(seen[time][i])
        if ends[i] <= NONE_LEFT / factor:
            return now - NONE_LEFT
        return abs(math.log(max(now, 1e-300) / ends[i])) - math.log(factor)

    for i, last in enumerate(ends):
        if not math.isfinite(last):
            out.append(math.nan)
            continue
        outside = [k for k, time in enumerate(times) if far(time, i) > 0]
        if not outside:
            out.append(0.0)
        elif outside[-1] == len(times) - 1:
            out.append(math.nan)
        else:
            low, high = times[outside[-1]], times[outside[-1] + 1]
            out.append(float(brentq(far, low, high, args=(i,), rtol=1e-9)))
    return tuple(out)


@takes_units
def slow_sizes(terms: OilTerms, *, volume: float, than: float) -> SlowSizes | None:
    """The small sizes of an oil that take far longer than a time; None where there are none.

    Parameters
    ----------
    terms : OilTerms
    volume : float
        Of the oil [m³].
    than : float
        The time of the code [s].
    """
    leaving = terms.loss + terms.growth
    there = (terms.source > 0) | (terms.start > 0)
    with np.errstate(divide="ignore"):
        time = np.where(leaving > 0, -math.log(LEFT) * volume / leaving, math.inf)
    slow = there & (time > FAR * max(than, 1e-9))
    _, high = terms.classes.ends
    if not np.any(slow):
        return None
    last = int(np.flatnonzero(slow.any(axis=1))[-1])
    names = [name for name, removal in terms.removal.items() if np.any(removal[slow] > 0)]
    order = sorted(names, key=lambda name: name in (SETTLED, LEAKED))
    return SlowSizes(
        below=float(high[last]),
        time=float(np.max(time[slow])),
        taken_by=order[0] if order else "",
    )
