"""The branch of coupled states over speed or load: its pieces, folds and jumps."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np
from scipy import optimize

from ..errors import NoEquilibrium, Note
from ..numerics.continuation import Branch, follow_branch
from ..quantities.say import number, value_of
from .feedback import friction_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..contact.contact import Contact

    Array = NDArray[np.float64]

__all__ = ["LAST", "Jump", "Walk"]

LAST = 0.999
"""Share of the way to a melting point up to which a branch is followed."""
COOLEST = 1e-3
"""Rise at which a branch begins, over that at which it ends."""
DECADES = 6.0
"""Unit of the logarithm of speed or load along a branch, whose other unit is the largest rise."""
STEP = 0.1
"""Largest step along a branch in these units."""
WIDEST = 40.0
"""Range of the logarithm of speed or load in which a branch is followed."""
LOOKS = 64
"""Places between which a jump of friction is looked for."""
BESIDE = 2e-5
"""How far behind a jump the branch goes on, over the largest rise: differences need room."""
CLOSE = 1e-9
"""How far beside a jump speed and load on its sides are taken, over the largest rise."""
AT_JUMP = 2e-3
"""How near a jump a piece of the branch must come to go on behind it, over the largest rise."""


class Loop(Protocol):
    """What a walk asks of a contact with its feedback."""

    @property
    def contact(self) -> Contact: ...
    @property
    def flash(self) -> bool: ...
    @property
    def cold(self) -> float: ...
    @property
    def span(self) -> float: ...
    def warm_contact(self, T: float, T_particles: float, v: float) -> Contact | None:
        """The contact with its bodies at temperatures."""
        ...

    def temperatures(self, x: Array) -> tuple[float, float]:
        """Temperatures of surfaces and particles from the unknowns."""
        ...

    def numbers(self, x: Array, v: float, p: float) -> tuple[float, float, float]:
        """Friction and flash rises."""
        ...

    def unknowns_made(self, x: Array, v: float, p: float) -> Array:
        """The unknowns that the contact makes at unknowns x."""
        ...


class Jump(NamedTuple):
    """A temperature at which friction jumps, and where the branch ends and begins again."""

    T: float
    """[K]."""
    before: float
    """Speed or load on the cold side [m/s or Pa]."""
    behind: float
    """On the hot side."""


class Walk:
    """The states of a loop along speed or load, from where nothing warms."""

    def __init__(self, loop: Loop, name: str, v: float, p: float) -> None:
        self.loop, self.name, self.v, self.p = loop, name, v, p
        cold = np.zeros(2 if loop.flash else 1)
        rise = float(np.max(loop.unknowns_made(cold, v, p)))
        if not math.isfinite(rise):
            raise NoEquilibrium("the contact has no state at the temperature without friction")
        self.begins = min(math.log(COOLEST / rise) if rise > 0 else -1.0, -0.5) / DECADES
        self.pieces: list[Branch] = []
        self.jumps: list[Jump] = []
        v_0, p_0 = self.speed_and_load(self.begins)
        x, place, forward = loop.unknowns_made(cold, v_0, p_0), self.begins, True
        self.low = -math.inf
        for self.high in (*_jumps_of(loop, v), math.inf):
            if x[0] >= self.high:  # the branch begins hotter
                continue
            piece = follow_branch(
                self.residual, x=x, parameter=place, step=STEP, inside=self.inside, forward=forward
            )
            self.pieces.append(piece)
            end, end_place = piece.x[-1], float(piece.parameter[-1])
            if not self.high - AT_JUMP < end[0]:
                break
            behind = self._state_behind(self.high, end, end_place)
            if behind is None:
                break
            sides = [
                self._value(self.state_with_rise(self.high + far, near, at)[1])
                for far, near, at in ((-CLOSE, end, end_place), (CLOSE, *behind[:2]))
            ]
            T = loop.temperatures(np.full_like(end, self.high))[0]
            self.jumps.append(Jump(T, *sides))
            self.low = self.high
            x, place, forward = behind

    def _state_behind(
        self, jump: float, end: Array, place: float
    ) -> tuple[Array, float, bool] | None:
        """The first state behind a jump, and whether the branch goes on to higher speed or load."""
        states = [self.state_with_rise(jump + far, end, place) for far in (BESIDE, 1e2 * BESIDE)]
        (x, here), (_, there) = states
        if not (math.isfinite(here) and math.isfinite(there)):
            return None
        return x, here, there > here

    def state_with_rise(self, first: float, near: Array, place: float) -> tuple[Array, float]:
        """The state with a rise of the surfaces and its place; NaN where there is none."""
        x = near.copy()
        x[0] = first

        def away(other: Array) -> Array:
            x[1:] = other[:-1]
            made = self.loop.unknowns_made(x, *self.speed_and_load(float(other[-1])))
            return np.asarray(np.where(np.isfinite(made), made - x, 1e3))

        if len(x) == 1:
            ends = self.begins - 0.5 / DECADES, self.begins + WIDEST / DECADES
            try:
                return x, float(optimize.brentq(lambda at: away(np.array([at]))[0], *ends))
            except ValueError:
                return x, math.nan
        root = optimize.root(away, np.append(near[1:], place), tol=1e-10)
        return x, float(root.x[-1]) if root.success else math.nan

    def speed_and_load(self, place: float) -> tuple[float, float]:
        """Speed and load at a place along the branch."""
        factor = math.exp(DECADES * place)
        return (self.v * factor, self.p) if self.name == "speed" else (self.v, self.p * factor)

    def _value(self, place: float) -> float:
        """Speed [m/s] or load [Pa] at a place."""
        return self.speed_and_load(place)[0 if self.name == "speed" else 1]

    def residual(self, x: Array, place: float) -> Array:
        """What is made less what is put in; NaN beyond the jumps beside a piece."""
        if not (np.all(x < 1 / LAST) and self.low < x[0] < self.high):
            return np.full_like(x, math.nan)
        return self.loop.unknowns_made(x, *self.speed_and_load(place)) - x

    def inside(self, x: Array, place: float) -> bool:
        """Whether a point belongs to the branch that is followed."""
        near = self.begins - 0.5 / DECADES < place < self.begins + WIDEST / DECADES
        return bool(np.all(x < 1)) and near

    def states(self) -> list[Array]:
        """Unknowns at the speed and load that were asked for, the coldest first."""
        self.low, self.high = -math.inf, math.inf
        unknowns = [x for piece in self.pieces for x in piece.solutions(self.residual, 0.0)]
        return sorted(unknowns, key=lambda x: float(x[0]))

    def end(self) -> tuple[float, str]:
        """Speed or load at which the stable state ends, NaN where it does not, and a sentence."""
        kind, unit = ("speed", "m/s") if self.name == "speed" else ("load", "Pa")
        ends = [
            (self._value(float(piece.parameter[i])), self.loop.temperatures(piece.x[i])[0])
            for piece in self.pieces
            for i in piece.folds
            if piece.parameter[i] > piece.parameter[i - 1]
        ]
        ends += [(jump.before, jump.T) for jump in self.jumps if jump.behind < jump.before]
        last = self.pieces[-1]
        T = self.loop.temperatures(last.x[-1])[0]
        value = self._value(float(last.parameter[-1]))
        if ends and max(ends)[0] >= value:
            ends.sort(key=lambda end: end[1])
            most, hottest = max(ends)
            words = f"the stable state ends at {value_of(most, unit)}, {number(hottest)} K"
            if ends[0][0] < most:
                words = (
                    f"the coldest stable state ends at {value_of(ends[0][0], unit)}, "
                    f"{number(ends[0][1])} K, the last one at {value_of(most, unit)}, "
                    f"{number(hottest)} K"
                )
            return most, f"{words}; above, friction heats without a stop"
        if last.ended == "step":
            return math.nan, (
                f"not known: beyond {value_of(value, unit)} and {number(T)} K no state is solved, "
                "or half of the area touches"
            )
        if last.x[-1].max() > 0.8:
            return math.nan, (
                f"none: the {kind} rises with the temperature up to {value_of(value, unit)} at "
                f"{number(T)} K, where the laws end"
            )
        return math.nan, f"none up to {value_of(value, unit)}"

    def notes(self) -> list[Note]:
        """Where friction jumps."""
        unit = "m/s" if self.name == "speed" else "Pa"
        operating_value = self.v if self.name == "speed" else self.p
        out = []
        for jump in self.jumps:
            low, high = sorted((jump.before, jump.behind))
            what = (
                f"friction jumps at {number(jump.T)} K, where one surface becomes harder than the "
                f"other by hardness_ratio, between {value_of(low, unit)} and {value_of(high, unit)}"
            )
            if low <= operating_value <= high and jump.before < jump.behind:
                what += "; at what was asked for the contact stays at this temperature"
            out.append(Note(what, code="coupled.jump", action="vary hardness_ratio of Friction"))
        return out

    def columns(self) -> dict[str, Array]:
        """The branch as columns."""
        places = np.concatenate([piece.parameter for piece in self.pieces])
        unknowns = np.concatenate([piece.x for piece in self.pieces])
        both = np.array([self.speed_and_load(float(place)) for place in places])
        index, label = (0, "speed") if self.name == "speed" else (1, "pressure")
        numbers = [
            self.loop.numbers(x, *speed_and_load)
            for x, speed_and_load in zip(unknowns, both, strict=True)
        ]
        return {
            label: both[:, index],
            "T": self.loop.cold + self.loop.span * unknowns[:, 0],
            "mu": np.array([row[0] for row in numbers]),
        }


def _jumps_of(loop: Loop, v: float) -> list[float]:
    """Rises over the largest at which one surface begins to plough the other, or ceases to."""
    friction = friction_of(loop.contact)
    if friction is None:
        return []

    def excess(x: float) -> float:
        T = loop.cold + loop.span * x
        contact = loop.warm_contact(T, T, v)
        if contact is None:
            return math.nan
        H = contact.surfaces.first.H, contact.surfaces.second.H
        return max(H) / min(H) - friction.hardness_ratio

    places = np.linspace(0.0, 1.0, LOOKS + 1)
    above = np.array([excess(float(x)) for x in places])
    return [
        float(optimize.brentq(excess, float(places[i]), float(places[i + 1]), xtol=1e-12))
        for i in np.flatnonzero(above[1:] * above[:-1] < 0)
    ]
