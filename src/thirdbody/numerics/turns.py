"""Turns of a branch between its points: where its slope says that steps went over some."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["Stretch", "known_turn", "stretches_with_a_turn"]

STEEP = 0.9
"""Part of a step along the parameter from which, with steps beside as steep, no turn is sought."""
FLAT = 0.3
"""Slope below which shorter stretches are looked at."""
LONGEST, LONGEST_FLAT = 1.2, 0.6
"""Largest part of the largest step whose ends and middle may do, and where a slope is flat."""
FINEST = 2e-3
"""Part of the largest step that is not parted again: a kink has no straight slope at any length."""
MARGIN = 2.0
"""How many times its own error a slope must be away from zero to be trusted between its places."""
UNEVEN = 0.05
"""Largest error of a slope, whatever the slope: a larger one shows something narrower."""
BESIDE = 0.05
"""How far outside of a stretch a turn may lie that is the same, over the length of the stretch."""


class Walk(Protocol):
    """What a search for turns asks of a walk along a branch."""

    def find_point(self, guess: Array, direction: Array) -> Array | None:
        """The point of the branch in the plane through a guess across a direction."""
        ...

    def slope(self, y: Array, direction: Array) -> float:
        """Change of the parameter per length along the branch at a point, in a direction."""
        ...


class Stretch(NamedTuple):
    """A stretch of a branch in which the parameter turns once."""

    after: int
    """Number of the point of the branch before it."""
    first: Array
    last: Array
    highest: bool
    """Whether the parameter is highest at the turn; otherwise lowest."""


class _Place(NamedTuple):
    """A point of the branch and its slope."""

    y: Array
    slope: float


def stretches_with_a_turn(walk: Walk, points: list[Array], step: float) -> list[Stretch]:
    r"""Stretches between the points of a branch in which the parameter turns once.

    .. math:: s = \frac{d\lambda}{d\ell}, \qquad
              \max\left(\left|s_m - \tfrac{s_a + s_b}{2}\right|,
              \left|s_m - \tfrac{3}{2}\tfrac{\lambda_b-\lambda_a}{\ell} + \tfrac{s_a+s_b}{4}\right|
              \right) < \min\left(\tfrac{1}{2}\min |s|, 0.05\right)

    A stretch from a to b is parted at its middle m until its three slopes have one sign and are far
    enough from zero, or change sign once and evenly, or until it is short. The second of the two
    errors is that of the cubic through the ends.

    Parameters
    ----------
    walk : Walk
        Of the branch.
    points : list of array (n + 1,)
        Its points in order, without its turns.
    step : float
        Largest step along the branch.

    Returns
    -------
    list of Stretch
        In the order of the branch.

    Notes
    -----
    Two turns nearer than 0.002 of a step may be missed, and what happens between slopes 0.2 of a
    step apart without a mark on the points and slopes beside.

    Examples
    --------
    A wave on a slope, of which one step goes over both turns:

    >>> import numpy as np
    >>> from thirdbody.numerics.continuation import follow_branch
    >>> step = follow_branch(lambda x, t: x - 0.04 * np.tanh((x - 0.53) / 0.02) - t, x=[0.04],
    ...                      parameter=0.08, step=0.1, inside=lambda x, t: x[0] < 1)
    >>> [round(float(x), 4) for x in step.x[step.folds, 0]]
    [0.5124, 0.5476]
    """
    if len(points) < 2:
        return []
    secants = np.diff(np.stack(points), axis=0)
    ways = np.concatenate([secants[:1], secants[1:] + secants[:-1], secants[-1:]])
    steep = np.abs(secants[:, -1]) > STEEP * np.linalg.norm(secants, axis=1)
    steep = np.r_[True, steep, True]
    looked = ~(steep[:-2] & steep[1:-1] & steep[2:])
    places = [
        _Place(y, walk.slope(y, way) if near else math.nan)
        for y, way, near in zip(
            points, ways, np.r_[looked, False] | np.r_[False, looked], strict=True
        )
    ]
    out: list[Stretch] = []
    for i in np.flatnonzero(looked):
        parts = _split_stretch(walk, places[i], places[i + 1], step)
        out += [Stretch(int(i), a.y, b.y, highest=a.slope > b.slope) for a, b in parts]
    return out


def _split_stretch(walk: Walk, a: _Place, b: _Place, step: float) -> list[tuple[_Place, _Place]]:
    """Ends of the parts of a stretch in which the parameter turns once."""
    way = b.y - a.y
    length = float(np.linalg.norm(way))
    if not np.isfinite(a.slope + b.slope):
        return []
    alone = [(a, b)] if (a.slope < 0) != (b.slope < 0) else []
    if length < FINEST * step:
        return alone
    middle = walk.find_point(0.5 * (a.y + b.y), way / length)
    if middle is None:
        return alone
    m = _Place(middle, walk.slope(middle, way))
    if not np.isfinite(m.slope):
        return alone
    if _is_plain(a, m, b, step):
        return alone
    return _split_stretch(walk, a, m, step) + _split_stretch(walk, m, b, step)


def _is_plain(a: _Place, m: _Place, b: _Place, step: float) -> bool:
    """Whether three slopes leave room for no turn but the one that their signs show."""
    length = float(np.linalg.norm(b.y - a.y))
    slopes = np.array([a.slope, m.slope, b.slope])
    flattest = float(np.abs(slopes).min())
    if length > step * (LONGEST_FLAT if flattest < FLAT else LONGEST):
        return False
    mean = 0.5 * (a.slope + b.slope)
    cubic = 1.5 * (b.y[-1] - a.y[-1]) / length - 0.5 * mean
    error = max(abs(m.slope - mean), abs(m.slope - cubic))
    if np.all(slopes > 0) or np.all(slopes < 0):
        return error < min(flattest / MARGIN, UNEVEN)
    return bool(a.slope * b.slope < 0 and abs(b.slope - a.slope) > 2 * MARGIN * error)


def known_turn(stretch: Stretch, turns: list[Array]) -> Array | None:
    """The turn among these that a stretch holds; None where it holds none of them."""
    way = stretch.last - stretch.first
    for turn in turns:
        along = float(way @ (turn - stretch.first) / (way @ way))
        across = np.linalg.norm(turn - stretch.first - along * way)
        if -BESIDE < along < 1 + BESIDE and across < np.linalg.norm(way):
            return turn
    return None
