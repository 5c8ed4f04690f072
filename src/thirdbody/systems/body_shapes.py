"""The shapes that a force presses together: balls, rollers, faces, and their smooth contact."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ..errors import Mistake, Problem
from ..quantities.value import Value, choice, count_field, quantity
from .conjunctions import Hertz, Line, Point

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Number = float | NDArray[np.float64]

__all__ = ["BallInGroove", "BallOnFlat", "Body", "Cylinders", "Flat", "Ring", "Roller"]

Ring = Literal["inner", "outer"]
"""Which ring of a bearing a rolling body touches."""


def _diameter(meaning: str, **options: Any) -> Any:
    return quantity("D", "m", meaning, gt=0, usual=1.0, **options)


class Body(Value, ABC):
    """Base of the pairs of bodies of a table [body]; `BODIES` lists them."""

    __slots__ = ()
    bodies: float
    """Contacts among which the force is divided equally [1]."""

    @property
    @abstractmethod
    def conjunction(self) -> Point | Line | None:
        """The shape between the bodies; None for flat ones."""

    @property
    def rolling_speed(self) -> float | None:
        """Mean speed at which the bodies drag oil in u [m/s]; None where it is not known."""
        return None

    @property
    def track(self) -> str:
        """What the second surface is."""
        return "surface 2"

    def load_on_one(self, force: object, E_star: float) -> Number:
        """Load on the contact that carries most of the force on all [N]."""
        return np.asarray(force, float) / self.bodies

    def hertz(self, force: object, E_star: float) -> Hertz:
        """Area and pressures of one smooth dry contact under the force on all [N]."""
        shape = self.conjunction
        assert shape is not None
        return shape.hertz(self.load_on_one(force, E_star), E=2 * E_star)


def _bodies() -> Any:
    return count_field("Z", "contacts that share the force equally", default=1.0, ge=1)


@dataclass(frozen=True, slots=True, kw_only=True)
class BallOnFlat(Body):
    """A ball on a flat.

    Parameters
    ----------
    diameter : float
        Of the ball D [m].
    bodies : float, optional
        Balls that share the force Z [1].

    Examples
    --------
    >>> round(float(BallOnFlat(diameter=10e-3).hertz(50.0, 115e9).mean) / 1e6)
    1149
    """

    diameter: float = _diameter("diameter of the ball")
    bodies: float = _bodies()

    @property
    def conjunction(self) -> Point:
        """A circle: R = D/2."""
        return Point(R=self.diameter / 2)


@dataclass(frozen=True, slots=True, kw_only=True)
class BallInGroove(Body):
    r"""A ball in the groove of a ball bearing or a ball screw.

    .. math:: \frac1{R_x} = \frac2D\,\frac{1}{1 \mp \gamma}, \quad
              \gamma = \frac{D\cos\beta}{d_m}, \qquad \frac1{R_y} = \frac2D - \frac1{fD}

    Parameters
    ----------
    diameter : float
        Of the ball D [m].
    conformity : float, optional
        Radius of the groove over the diameter of the ball f [1], above 0.5.
    pitch_diameter : float, optional
        Of the circle on which the balls run d_m [m]; without it the groove is straight.
    contact_angle : float, optional
        β [rad].
    ring : {"inner", "outer"}, optional
        Where the groove is: on the inner ring or screw (−), or the outer ring or nut (+).
    bodies : float, optional
        Balls that share the force Z [1].

    Examples
    --------
    >>> ball = BallInGroove(diameter=6e-3, conformity=0.52)
    >>> round(float(ball.hertz(300.0, 115e9).maximum) / 1e6)
    1882
    """

    diameter: float = _diameter("diameter of the ball")
    conformity: float = quantity(
        "f", "1", "groove radius over ball diameter", default=0.52, gt=0.5, le=10
    )
    pitch_diameter: float | None = quantity(
        "d_m", "m", "diameter of the circle of balls", default=None, gt=0, usual=10.0
    )
    contact_angle: float = quantity(
        "β", "rad", "contact angle", default=0.0, ge=0, lt=math.pi / 2, hint="write '45 deg'"
    )
    ring: Ring = choice("where the groove is", default="inner")
    bodies: float = _bodies()

    def _problems(self) -> list[str]:
        if self.pitch_diameter is not None and self.pitch_diameter <= self.diameter:
            return [
                Problem(
                    "pitch_diameter",
                    "must be above the "
                    f"diameter of a ball, {self.diameter:g} [m]; check the units of both",
                    f"{self.pitch_diameter:g}",
                    code=Mistake.ORDER,
                )
            ]
        return []

    @property
    def conjunction(self) -> Point:
        """An ellipse, long across the motion."""
        gamma = 0.0
        if self.pitch_diameter is not None:
            gamma = self.diameter * math.cos(self.contact_angle) / self.pitch_diameter
        sign = -1 if self.ring == "inner" else 1
        along = 0.5 * self.diameter * (1 + sign * gamma)
        return Point(R=along, R_y=1 / (2 / self.diameter - 1 / (self.conformity * self.diameter)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Roller(Body):
    r"""A cylindrical roller on a flat or on a ring.

    .. math:: \frac1R = \frac2D \pm \frac2{d_r}

    Parameters
    ----------
    diameter, length : float
        Of the roller D [m]; length of the contact l [m].
    track_diameter : float, optional
        Of the track d_r [m]; without it the track is flat.
    ring : {"inner", "outer"}, optional
        Whether the roller runs outside (+) or inside (−) of the track.
    bodies : float, optional
        Rollers that share the force Z [1].

    Examples
    --------
    >>> round(float(Roller(diameter=0.01, length=0.01).hertz(1000.0, 115e9).maximum) / 1e6)
    856
    """

    diameter: float = _diameter("diameter of the roller")
    length: float = quantity("l", "m", "length of the contact", gt=0, usual=1.0)
    track_diameter: float | None = quantity(
        "d_r", "m", "diameter of the track", default=None, gt=0, usual=10.0
    )
    ring: Ring = choice("where the track is", default="inner")
    bodies: float = _bodies()

    def _problems(self) -> list[str]:
        track = self.track_diameter
        if self.ring == "outer" and track is not None and track <= self.diameter:
            return [
                Problem(
                    "track_diameter",
                    f"must be above the diameter of the roller, "
                    f'{self.diameter:g} [m], with ring = "outer"; check the units of both',
                    f"{track:g}",
                    code=Mistake.ORDER,
                )
            ]
        return []

    @property
    def conjunction(self) -> Line:
        """A line."""
        track = 0.0 if self.track_diameter is None else 2 / self.track_diameter
        sign = 1 if self.ring == "inner" else -1
        return Line(R=1 / (2 / self.diameter + sign * track), length=self.length)


@dataclass(frozen=True, slots=True, kw_only=True)
class Cylinders(Body):
    """Two parallel cylinders side by side: rollers, gear teeth.

    Parameters
    ----------
    first_diameter, second_diameter, length : float
        Diameters [m]; length of the contact l [m].
    bodies : float, optional
        Pairs that share the force Z [1].

    Examples
    --------
    >>> pair = Cylinders(first_diameter=0.02, second_diameter=0.02, length=0.01)
    >>> pair.conjunction.R
    0.005
    """

    first_diameter: float = _diameter("diameter of the first cylinder")
    second_diameter: float = _diameter("diameter of the second cylinder")
    length: float = quantity("l", "m", "length of the contact", gt=0, usual=1.0)
    bodies: float = _bodies()

    @property
    def conjunction(self) -> Line:
        """A line."""
        R = 0.5 / (1 / self.first_diameter + 1 / self.second_diameter)
        return Line(R=R, length=self.length)


@dataclass(frozen=True, slots=True, kw_only=True)
class Flat(Body):
    """Two flat faces under an even pressure.

    Parameters
    ----------
    area : float
        Nominal area of one contact [m²].
    bodies : float, optional
        Contacts that share the force Z [1].

    Examples
    --------
    >>> float(Flat(area=1e-4).hertz(500.0, 115e9).mean)
    5000000.0
    """

    area: float = quantity("A_n", "m^2", "nominal area of one contact", gt=0)
    bodies: float = _bodies()

    @property
    def conjunction(self) -> None:
        """No curvature."""
        return None

    def hertz(self, force: object, E_star: float) -> Hertz:
        """The even pressure."""
        even = np.asarray(force, float) / self.bodies / self.area
        return Hertz(np.full_like(even, self.area), even, even)
