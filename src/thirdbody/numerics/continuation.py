"""Branches of solutions of a few equations, followed through their folds by pseudo-arclength."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import optimize

from .turns import known_turn, stretches_with_a_turn

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Residual = Callable[[Array, float], Array]

__all__ = ["Branch", "follow_branch"]

DIFFERENCE = 1e-5
"""Step of the first Jacobian, in units of the unknowns."""
ROUGH, CLOSE = 1e-7, 1e-11
"""A point is on the branch when every equation is closer to zero than this, times the largest slope
where that is above 1: on the way, and at folds and solutions."""
TINY = 1e-9
"""Corrections below it teach nothing of the Jacobian: rounding decides what they change."""
CORRECTIONS = 12
"""Corrections after which a step is halved."""
SHORTEST = 1e-4
"""Steps below which a branch ends, over the largest step."""
AT_EXTREMUM = 3e-5
"""How near a fold is looked for along the branch; the parameter varies with the square of it."""


class Branch(NamedTuple):
    """Solutions of F(x, λ) = 0 along one curve.

    Examples
    --------
    >>> circle = follow_branch(lambda x, t: x * x + t * t - 1, x=[0.6], parameter=-0.8, step=0.1,
    ...                        inside=lambda x, t: x[0] > -0.5)
    >>> [round(float(t), 8) for t in circle.parameter[circle.folds]]
    [1.0]
    """

    x: Array
    """The unknowns (M, n)."""
    parameter: Array
    """The parameter λ of every point (M,)."""
    folds: NDArray[np.intp]
    """Numbers of the points at which the parameter turns."""
    ended: str
    """Why it ends: "border", "step" (no shorter step helps), or "points" (as many as allowed)."""

    def solutions(self, residual: Residual, value: float) -> list[Array]:
        """The unknowns at each place where the parameter passes ``value``, along the branch.

        Parameters
        ----------
        residual : callable
            That of `follow_branch`.
        value : float
            λ.
        """
        y = np.column_stack([self.x, self.parameter])
        over = self.parameter >= value
        turns = np.flatnonzero(over[1:] != over[:-1])
        return [_point_at_value(residual, y[i], y[i + 1], value)[:-1] for i in turns]


@dataclass
class _Walk:
    """A walk along a branch: equations, their Jacobian as it is updated, and the points so far."""

    residual: Residual
    jacobian: Array
    points: list[Array] = field(default_factory=list)

    def correct_guess(
        self, guess: Array, direction: Array, close: float = CLOSE
    ) -> tuple[Array, int] | None:
        """The point of the branch in the plane through a guess across a direction, and the
        corrections it took; None where there is none near."""
        y, value = guess.copy(), self.residual(guess[:-1], float(guess[-1]))
        for count in range(1, CORRECTIONS + 1):
            system = np.vstack([self.jacobian, direction])
            away = np.append(value, direction @ (y - guess))
            try:
                change = np.linalg.solve(system, -away)
            except np.linalg.LinAlgError:
                return None
            y = y + change
            after = self.residual(y[:-1], float(y[-1]))
            if not np.all(np.isfinite(after)):
                return None
            size = float(change @ change)
            if size > TINY**2:  # Broyden's update
                miss = after - value - self.jacobian @ change
                self.jacobian = self.jacobian + np.outer(miss, change) / size
            value = after
            if np.abs(after).max() < close * max(1.0, np.abs(self.jacobian).max()):
                return y, count
        return None

    def find_point(self, guess: Array, direction: Array) -> Array | None:
        """The point of the branch in the plane through a guess across a direction, by the Jacobian
        at hand or else one taken there; None where there is none near."""
        kept = self.jacobian
        solution = self.correct_guess(guess, direction, ROUGH)
        if solution is None:
            fresh = first_jacobian(self.residual, guess)
            self.jacobian = fresh if np.all(np.isfinite(fresh)) else kept
            solution = self.correct_guess(guess, direction, ROUGH)
        return None if solution is None else solution[0]

    def slope(self, y: Array, direction: Array) -> float:
        """Change of the parameter per length along the branch at a point, in a direction; NaN where
        the equations have no value beside it."""
        here = self.residual(y[:-1], float(y[-1]))
        columns = []
        for i in range(len(y)):  # to one side: what is asked at the point itself is known already
            z = y.copy()
            z[i] += DIFFERENCE
            columns.append((self.residual(z[:-1], float(z[-1])) - here) / DIFFERENCE)
        jacobian = np.stack(columns, axis=1)
        if not np.all(np.isfinite(jacobian)):
            return math.nan
        self.jacobian = jacobian
        tangent = np.linalg.svd(jacobian)[2][-1]
        return float(tangent[-1] * (1.0 if tangent @ direction > 0 else -1.0))

    def extreme_point(self, first: Array, middle: Array, last: Array, *, highest: bool) -> Array:
        """The point between three at which the parameter is highest, or lowest."""
        direction = (last - first) / np.linalg.norm(last - first)
        sign = 1.0 if highest else -1.0
        length = float(direction @ (last - first))
        places = np.array([0.0, float(direction @ (middle - first)), length])
        through = np.polyfit(places, np.stack([first, middle, last]), 2)
        best = {"y": max((first, middle, last), key=lambda y: sign * y[-1])}

        def height(place: float) -> float:
            guess = through[0] * place**2 + through[1] * place + through[2]
            solution = self.correct_guess(guess, direction)
            if solution is None:
                return np.inf
            if sign * solution[0][-1] > sign * best["y"][-1]:
                best["y"] = solution[0]
            return -sign * float(solution[0][-1])

        optimize.minimize_scalar(
            height,
            bounds=(0.0, length),
            method="bounded",
            options={"xatol": AT_EXTREMUM * length, "maxiter": 40},
        )
        return best["y"]


def _point_at_value(residual: Residual, one: Array, other: Array, value: float) -> Array:
    """The point between two of a branch at which the parameter has a value."""
    jacobian = first_jacobian(residual, one)
    walk = _Walk(residual, jacobian)
    way = other - one
    share = (value - one[-1]) / way[-1]
    upright = np.zeros_like(one)
    upright[-1] = 1.0
    straight = walk.correct_guess(one + share * way, upright)
    if straight is not None and 0 <= way @ (straight[0] - one) <= way @ way:
        return straight[0]
    # near a fold, where the branch hardly leaves the plane of the value
    walk.jacobian = jacobian
    direction = way / np.linalg.norm(way)
    last = one

    def excess(share: float) -> float:
        nonlocal last
        if share in (0.0, 1.0):
            last = one if share == 0 else other
            return float(last[-1] - value)
        solution = walk.correct_guess(one + share * (other - one), direction)
        if solution is None:
            raise ValueError("the branch is lost between two of its points")
        last = solution[0]
        return float(last[-1] - value)

    share = optimize.brentq(excess, 0.0, 1.0, xtol=1e-13, rtol=1e-13)
    excess(share)
    return last


def first_jacobian(residual: Residual, y: Array) -> Array:
    """The Jacobian by central differences at one point: (n, n + 1)."""
    columns = []
    for i in range(len(y)):
        step = np.zeros_like(y)
        step[i] = DIFFERENCE
        up, down = (residual(z[:-1], float(z[-1])) for z in (y + step, y - step))
        columns.append((up - down) / (2 * DIFFERENCE))
    return np.stack(columns, axis=1)


def follow_branch(
    residual: Residual,
    *,
    x: Array | list[float],
    parameter: float,
    step: float,
    inside: Callable[[Array, float], bool],
    forward: bool = True,
    most: int = 400,
) -> Branch:
    r"""The curve of solutions of F(x, λ) = 0 through a first one, over all its folds.

    The next point is sought in the plane across the secant of the last two, a step ahead of the
    parabola through the last three:

    .. math:: F(x, \lambda) = 0, \qquad t\cdot(y - y_{guess}) = 0, \qquad y = (x, \lambda)

    Parameters
    ----------
    residual : callable
        ``F(x, λ)`` with x of shape (n,), n small; unknowns and parameter of order one. NaN where
        it has no value.
    x : array (n,)
        Near the first solution.
    parameter : float
        λ of the first solution.
    step : float
        Largest step along the curve.
    inside : callable
        ``inside(x, λ)``: whether a point counts; the branch ends before the first that does not.
    forward : bool, optional
        Begin towards larger λ.
    most : int, optional
        Largest number of points.

    Returns
    -------
    Branch
        Its folds are points of it.

    Raises
    ------
    ValueError
        There is no solution near the first guess.

    Notes
    -----
    Points lie on the branch to 1e-7, folds and solutions to 1e-11; λ of a fold varies with the
    square of its place, which is known to 3e-5 of a step. Branches that never meet this one are
    not seen.

    References
    ----------
    Keller 1977, in Applications of Bifurcation Theory (ed. Rabinowitz), 359 (from memory).

    Examples
    --------
    The curve r = x − 2x²/(1 + x²) turns at r = 0.134884 and, at x = 1, at r = 0.

    >>> curve = follow_branch(lambda x, r: r - x + 2 * x**2 / (1 + x**2), x=[0.0], parameter=0.0,
    ...                       step=0.1, inside=lambda x, r: x[0] < 3)
    >>> [round(abs(float(r)), 6) for r in curve.parameter[curve.folds]]
    [0.134884, 0.0]
    """
    start = np.append(np.asarray(x, dtype=float), parameter)
    walk = _Walk(residual, first_jacobian(residual, start))
    upright = np.zeros_like(start)
    upright[-1] = 1.0
    solution = walk.correct_guess(start, upright)
    if solution is None:
        raise ValueError("no solution near the first guess")
    walk.points.append(solution[0])
    *_, tangent = np.linalg.svd(walk.jacobian)[2]
    tangent = tangent * (1.0 if (tangent[-1] > 0) == forward else -1.0)
    folds: list[int] = []
    ahead, ended = 0.1 * step, "points"
    while len(walk.points) < most:
        if ahead < SHORTEST * step:
            ended = "step"
            break
        here = walk.points[-1]
        kept = walk.jacobian
        solution = walk.correct_guess(_guess(walk.points, tangent, ahead), tangent, ROUGH)
        if solution is None or np.linalg.norm(solution[0] - here) > 2 * ahead:
            walk.jacobian, ahead = kept, 0.5 * ahead
            continue
        new, count = solution
        if not inside(new[:-1], float(new[-1])):
            ended = "border"
            break
        walk.points.append(new)
        tangent = (new - here) / np.linalg.norm(new - here)
        if len(walk.points) > 2 and _turns(*walk.points[-3:]):
            _put_fold(walk, folds)
        ahead = min(step, ahead * (1.6 if count <= 3 else 1.0 if count <= 5 else 0.6))
    folds = _put_missed_folds(walk, folds, step)
    y = np.stack(walk.points)
    return Branch(y[:, :-1], y[:, -1], np.array(folds, dtype=np.intp), ended)


def _put_missed_folds(walk: _Walk, folds: list[int], step: float) -> list[int]:
    """Numbers of the folds, with those between two points that a step went over."""
    plain = [y for i, y in enumerate(walk.points) if i not in set(folds)]
    stretches = stretches_with_a_turn(walk, plain, step)
    turns = [walk.points[i] for i in folds]
    if len(turns) == len(stretches) == sum(known_turn(s, turns) is not None for s in stretches):
        return folds
    points: list[Array] = []
    out = []
    rest = list(stretches)
    for i, y in enumerate(plain):
        points.append(y)
        while rest and rest[0].after == i:
            stretch = rest.pop(0)
            _, first, last, highest = stretch
            if first is not points[-1]:
                points.append(first)
            fold = known_turn(stretch, turns)
            if fold is None:
                way = (last - first) / np.linalg.norm(last - first)
                middle = walk.find_point(0.5 * (first + last), way)
                three = first, first if middle is None else middle, last
                fold = walk.extreme_point(*three, highest=highest)
            out.append(len(points))
            points.append(fold)
            if last is not plain[i + 1]:
                points.append(last)
    walk.points = points
    return out


def _guess(points: list[Array], tangent: Array, ahead: float) -> Array:
    """A step ahead: along the parabola through the last three points, or the tangent."""
    if len(points) < 3:
        return points[-1] + ahead * tangent
    three = np.stack(points[-3:])
    lengths = np.linalg.norm(np.diff(three, axis=0), axis=1)
    if lengths.min() < 0.05 * ahead:
        return points[-1] + ahead * tangent
    places = np.array([-lengths.sum(), -lengths[1], 0.0])
    square, slope, last = np.polyfit(places, three, 2)
    return np.asarray((square * ahead + slope) * ahead + last)


def _turns(first: Array, middle: Array, last: Array) -> bool:
    """Whether the parameter turns at the middle one of three points."""
    return bool((middle[-1] - first[-1]) * (last[-1] - middle[-1]) < 0)


def _put_fold(walk: _Walk, folds: list[int]) -> None:
    """Put the turning point among the last three in its place."""
    first, middle, last = walk.points[-3:]
    highest = middle[-1] > max(first[-1], last[-1])
    fold = walk.extreme_point(first, middle, last, highest=highest)
    direction = last - first
    places = [float(direction @ (y - first)) for y in (fold, middle)]
    rest = [(places[0], fold, True)]
    if not np.allclose(fold, middle, rtol=0, atol=1e-9):
        rest.append((places[1], middle, False))
    rest.sort(key=lambda row: row[0])
    start = len(walk.points) - 2
    walk.points[start:] = [*(y for _, y, _ in rest), last]
    folds.append(start + next(i for i, row in enumerate(rest) if row[2]))
