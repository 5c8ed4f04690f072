"""Machine elements as bodies: what a drawing states, and the contact that carries most."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Literal, get_args

import numpy as np

from ..errors import Mistake, Problem
from ..quantities.carried import takes_units
from ..quantities.value import choice, count_field, quantity
from .body_shapes import BallInGroove, Body, Ring
from .conjunctions import Hertz, Line, Point
from .load_sharing import BALLS, ROLLERS, RadialShare, share_radial_load

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Number = float | NDArray[np.float64]

__all__ = [
    "BallBearing",
    "BallScrew",
    "Gear",
    "LinearGuide",
    "RadialBearing",
    "RollerBearing",
    "preloaded_load",
]

RINGS: tuple[Ring, ...] = get_args(Ring)

BALLS_RELIEVED = 2**1.5
"""Force over preload at which the other nut carries nothing [1]."""
STATIC, STATIC_SHARE = 4.2e9, 5.0
"""Largest Hertz pressure at the static rating of a ball bearing [Pa], and Z Q_max/C_0 there."""
FATIGUE = 22.0
"""C_0/C_u of ball bearings up to 100 mm pitch diameter."""
REDUCED = 0.95
"""What ISO 281 leaves of the theoretical rating of a single-row deep-groove bearing."""
STEEL_E_STAR = 2.07e11 / 2 / (1 - 0.3**2)
"""E* of bearing steel on itself, with which bearings are rated [Pa]."""


class RadialBearing(Body):
    """Base of ball and roller bearings: shared radial load and rotation."""

    __slots__ = ()
    bore: float
    outer_diameter: float
    clearance: float
    shaft_speed: float | None
    ring: Ring
    rated_as: ClassVar[str]
    """Kind of bearing by which ISO 281 rates it."""
    rolling_bodies: ClassVar[str]
    """What rolls in it."""
    exponent: ClassVar[float]
    """Of load over approach."""
    rolling_diameter: float
    """Of a ball or a roller [m]."""
    rolling_area: float
    """Surface of all balls or rollers [m²]."""

    @abstractmethod
    def on_ring(self, ring: Ring) -> Any:
        """The contact of a rolling body with the inner or outer ring."""

    @abstractmethod
    def stiffness(self, E_star: float) -> float:
        """Load over approach of the rings to the power ``exponent``, of one rolling body."""

    @abstractmethod
    def widths(self, loads: object, ring: Ring, E_star: float) -> Any:
        """Widths of the tracks of rolling bodies under their loads [N] on a ring [m]."""

    @property
    def conjunction(self) -> Point | Line:
        """The contact on the ring that is solved."""
        return self.on_ring(self.ring)

    @property
    def track(self) -> str:
        """The ring whose contact is solved."""
        return f"the {self.ring} ring"

    @property
    def pitch_diameter(self) -> float:
        """Diameter of the circle of the rolling bodies d_m [m]."""
        return 0.5 * (self.bore + self.outer_diameter)

    @property
    def gamma(self) -> float:
        """Diameter of a rolling body over pitch diameter γ [1]."""
        return self.rolling_diameter / self.pitch_diameter

    def share_load(self, force: float, E_star: float) -> RadialShare:
        """How the rolling bodies share a radial load [N], by Sjövall's integral.

        Parameters
        ----------
        force : float
            F_r [N].
        E_star : float
            Of the rings and rolling bodies E* [Pa].
        """
        return share_radial_load(
            force,
            bodies=self.bodies,
            stiffness=self.stiffness(E_star),
            clearance=self.clearance,
            exponent=self.exponent,
        )

    def load_on_one(self, force: object, E_star: float) -> Number:
        """Load on the most loaded rolling body, of a radial load [N]."""
        forces = np.asarray(force, float)
        largest = [
            self.share_load(float(radial_load), E_star).largest for radial_load in forces.ravel()
        ]
        return np.reshape(largest, forces.shape)[()]

    def hertz_of(self, load: object, ring: Ring, E_star: float) -> Hertz:
        """The smooth dry contact of a rolling body under its own load [N] on one of the rings."""
        return self.on_ring(ring).hertz(load, E=2 * E_star)

    # ------------------------------------------------------------------ how it turns
    @property
    def rolling_speed(self) -> float | None:
        """Mean speed at which rings and balls drag the oil in u [m/s]; None without shaft speed."""
        if self.shaft_speed is None:
            return None
        return 0.25 * self.shaft_speed * self.pitch_diameter * (1 - self.gamma**2)

    def overrollings(self, ring: Ring) -> float | None:
        """Rolling bodies that pass a place of a ring per second [1/s]; None without shaft speed."""
        if self.shaft_speed is None:
            return None
        sign = 1 if ring == "inner" else -1
        return self.bodies * self.shaft_speed / (4 * math.pi) * (1 + sign * self.gamma)

    def swept_area(self, share: RadialShare, ring: Ring, E_star: float) -> float:
        r"""Area that all rolling bodies sweep while each rolls by unit length [m²/m].

        .. math:: \frac Z\pi\int_0^{\psi_l} w(Q_\psi)\,d\psi

        on average over a turn of the cage, with the widths w of their tracks.
        """
        return self.bodies * share.over_a_turn(lambda loads: self.widths(loads, ring, E_star))

    def track_area(self, share: RadialShare, ring: Ring, E_star: float) -> float:
        """Area of the track below the most loaded rolling body, all around the ring [m²]."""
        sign = -1 if ring == "inner" else 1
        around = math.pi * self.pitch_diameter * (1 + sign * self.gamma)
        return float(self.widths(share.largest, ring, E_star) * around)


@dataclass(frozen=True, slots=True, kw_only=True)
class BallBearing(RadialBearing):
    r"""A deep-groove ball bearing under a radial load: its most loaded ball on one ring.

    .. math:: Q_{max} = \frac{F_r}{Z J_r(\varepsilon)}, \qquad
              K = \left(c_i+c_o\right)^{-3/2}, \quad \delta_{i,o} = c_{i,o}Q^{2/3}, \qquad
              u = \frac{\omega d_m}{4}\left(1-\gamma^2\right), \quad \gamma = D_w/d_m

    Parameters
    ----------
    bore, outer_diameter : float
        Of the bearing d and D [m]; the balls run on d_m = (d + D)/2.
    ball_diameter : float
        D_w [m].
    balls : float
        Z [1].
    inner_conformity, outer_conformity : float, optional
        Radius of each groove over the diameter of a ball [1], above 0.5.
    clearance : float, optional
        Diametral (radial internal) clearance P_d in operation [m]; below 0 is preload.
    shaft_speed : float, optional
        Of the inner ring ω [rad/s]; the outer one stands.
    ring : {"inner", "outer"}, optional
        On which ring the contact is solved.
    dynamic_rating, fatigue_limit : float, optional
        Basic dynamic load rating C and fatigue load limit C_u [N], as the catalogue has them;
        without them they follow from the geometry (``rating``, ``fatigue_load``).

    Notes
    -----
    C follows Lundberg and Palmgren's formula behind ISO 281, C_0 is the load at 4200 MPa of ISO 76,
    C_u = C_0/22 of ISO 281; constants are from memory, and meet catalogues within 4 %.
    Centrifugal forces of the balls are left out; so are misalignment and axial load.

    References
    ----------
    Harris 2001, Rolling Bearing Analysis, 4th ed., ch. 2, 7; ISO 76 and 281.

    Examples
    --------
    >>> from thirdbody.systems.machine_elements import BallBearing
    >>> bearing = BallBearing(bore=25e-3, outer_diameter=52e-3, ball_diameter=7.938e-3, balls=9)
    >>> round(float(bearing.load_on_one(2000.0, 113e9)) / 2000 * 9, 2)
    4.37
    >>> inner, outer = (bearing.replace(ring=ring) for ring in ("inner", "outer"))
    >>> [round(float(each.hertz(2000.0, 113e9).maximum) / 1e6) for each in (inner, outer)]
    [2537, 2284]
    """

    rated_as: ClassVar[str] = "ball"
    rolling_bodies: ClassVar[str] = "balls"
    exponent: ClassVar[float] = BALLS
    bore: float = quantity("d", "m", "bore of the bearing", gt=0, usual=1.0)
    outer_diameter: float = quantity("D", "m", "outer diameter of the bearing", gt=0, usual=2.0)
    ball_diameter: float = quantity("D_w", "m", "diameter of a ball", gt=0, usual=1.0)
    balls: float = count_field("Z", "number of balls", ge=3)
    inner_conformity: float = quantity(
        "f_i", "1", "groove radius over ball diameter, inner ring", default=0.52, gt=0.5, le=10
    )
    outer_conformity: float = quantity(
        "f_o", "1", "groove radius over ball diameter, outer ring", default=0.53, gt=0.5, le=10
    )
    clearance: float = quantity("P_d", "m", "internal clearance in operation", default=0.0)
    shaft_speed: float | None = quantity(
        "ω", "rad/s", "speed of the shaft", default=None, gt=0, hint="write '3000 rpm'"
    )
    ring: Ring = choice("on which ring the contact is", default="inner")
    dynamic_rating: float | None = quantity(
        "C", "N", "basic dynamic load rating", default=None, gt=0
    )
    fatigue_limit: float | None = quantity("C_u", "N", "fatigue load limit", default=None, gt=0)

    def _problems(self) -> list[str]:
        return _misfits(self, self.ball_diameter, "ball", self.balls)

    @property
    def bodies(self) -> float:  # type: ignore[override]
        """Balls Z [1]."""
        return self.balls

    @property
    def rolling_diameter(self) -> float:  # type: ignore[override]
        """Diameter of a ball D_w [m]."""
        return self.ball_diameter

    @property
    def rolling_area(self) -> float:  # type: ignore[override]
        """Surface of all balls, Z π D_w² [m²]."""
        return self.balls * math.pi * self.ball_diameter**2

    def on_ring(self, ring: Ring) -> Point:
        """The ellipse of a ball on the inner or outer ring."""
        inner = ring == "inner"
        return BallInGroove(
            diameter=self.ball_diameter,
            conformity=self.inner_conformity if inner else self.outer_conformity,
            pitch_diameter=self.pitch_diameter,
            ring=ring,
        ).conjunction

    def stiffness(self, E_star: float) -> float:
        """Load over approach of the rings to the power 3/2, of one ball [N/m^1.5]."""
        yielding = sum(self.on_ring(ring).approach(1.0, E=2 * E_star) for ring in RINGS)
        return float(yielding**-BALLS)

    def widths(self, loads: Any, ring: Ring, E_star: float) -> Any:
        """Widths of the tracks: of the ellipses across the motion [m]."""
        return 2 * self.on_ring(ring).semi_axes(loads, E=2 * E_star)[1]

    # ------------------------------------------------------------------ what it is rated for
    @property
    def static_rating(self) -> float:
        """Basic static load rating C_0 [N]: 4200 MPa below the most loaded ball, 5 F_r/Z on it."""
        at_one = max(
            float(self.on_ring(ring).hertz(1.0, E=2 * STEEL_E_STAR).maximum) for ring in RINGS
        )
        return (STATIC / at_one) ** 3 * self.balls / STATIC_SHARE

    @property
    def rating(self) -> float:
        """Basic dynamic load rating C [N]: as given, else by ISO 281 from its geometry."""
        if self.dynamic_rating is not None:
            return self.dynamic_rating
        g, f_i, f_o = self.gamma, self.inner_conformity, self.outer_conformity
        ratio = f_i * (2 * f_o - 1) / (f_o * (2 * f_i - 1))
        rings = 1.04 * ((1 - g) / (1 + g)) ** 1.72 * ratio**0.41
        f_c = (
            REDUCED * 39.9 * (1 + rings ** (10 / 3)) ** -0.3
            * g**0.3 * (1 - g) ** 1.39 / (1 + g) ** (1 / 3) * (2 * f_i / (2 * f_i - 1)) ** 0.41
        )  # fmt: skip
        mm = 1e3 * self.ball_diameter
        size = mm**1.8 if mm <= 25.4 else 3.647 * mm**1.4
        return 1.3 * f_c * self.balls ** (2 / 3) * size

    @property
    def fatigue_load(self) -> float:
        """Fatigue load limit C_u [N]: as given, else C_0/22."""
        return self.static_rating / FATIGUE if self.fatigue_limit is None else self.fatigue_limit


@dataclass(frozen=True, slots=True, kw_only=True)
class RollerBearing(RadialBearing):
    r"""A cylindrical roller bearing under a radial load: its most loaded roller on one ring.

    .. math:: \frac1R = \frac2D \pm \frac2{d_m \mp D}, \qquad
              \delta = 2.72\,(Q/E^*)^{0.9}\,l^{-0.8}\quad\text{(both rings, Palmgren)}

    Parameters
    ----------
    bore, outer_diameter : float
        Of the bearing d and D [m]; the rollers run on d_m = (d + D)/2.
    roller_diameter, length : float
        Of a roller D_w, and of the line on which it carries l [m].
    rollers : float
        Z [1].
    clearance : float, optional
        Diametral (radial internal) clearance P_d in operation [m]; below 0 is preload.
    shaft_speed : float, optional
        Of the inner ring ω [rad/s]; the outer one stands.
    ring : {"inner", "outer"}, optional
        On which ring the contact is solved.
    dynamic_rating, fatigue_limit : float, optional
        Basic dynamic load rating C, for lives in hours, and fatigue load limit C_u [N]; without it
        C_0/8.2.

    Notes
    -----
    Rollers are cylinders, loaded evenly over their length. Palmgren's approach, ISO 76's static
    rating and ISO 281's C_0/8.2 are from memory.

    References
    ----------
    Palmgren 1959, Ball and Roller Bearing Engineering, 3rd ed.; Harris 2001, ch. 6, 7.

    Examples
    --------
    >>> from thirdbody.systems.machine_elements import RollerBearing
    >>> bearing = RollerBearing(bore=25e-3, outer_diameter=52e-3, roller_diameter=7.5e-3,
    ...                         length=7.5e-3, rollers=12)
    >>> round(float(bearing.load_on_one(2000.0, 113e9)) / 2000 * 12, 2)
    4.08
    """

    rated_as: ClassVar[str] = "roller"
    rolling_bodies: ClassVar[str] = "rollers"
    exponent: ClassVar[float] = ROLLERS
    bore: float = quantity("d", "m", "bore of the bearing", gt=0, usual=1.0)
    outer_diameter: float = quantity("D", "m", "outer diameter of the bearing", gt=0, usual=2.0)
    roller_diameter: float = quantity("D_w", "m", "diameter of a roller", gt=0, usual=1.0)
    length: float = quantity("l", "m", "length of the contact", gt=0, usual=1.0)
    rollers: float = count_field("Z", "number of rollers", ge=3)
    clearance: float = quantity("P_d", "m", "internal clearance in operation", default=0.0)
    shaft_speed: float | None = quantity(
        "ω", "rad/s", "speed of the shaft", default=None, gt=0, hint="write '3000 rpm'"
    )
    ring: Ring = choice("on which ring the contact is", default="inner")
    dynamic_rating: float | None = quantity(
        "C", "N", "basic dynamic load rating", default=None, gt=0
    )
    fatigue_limit: float | None = quantity("C_u", "N", "fatigue load limit", default=None, gt=0)

    def _problems(self) -> list[str]:
        return _misfits(self, self.roller_diameter, "roller", self.rollers)

    @property
    def bodies(self) -> float:  # type: ignore[override]
        """Rollers Z [1]."""
        return self.rollers

    @property
    def rolling_diameter(self) -> float:  # type: ignore[override]
        """Diameter of a roller D_w [m]."""
        return self.roller_diameter

    @property
    def rolling_area(self) -> float:  # type: ignore[override]
        """Surface of all rollers that meets the rings, Z π D_w l [m²]."""
        return self.rollers * math.pi * self.roller_diameter * self.length

    def on_ring(self, ring: Ring) -> Line:
        """The line of a roller on the inner or outer ring."""
        sign = 1 if ring == "inner" else -1
        track = self.pitch_diameter - sign * self.roller_diameter
        return Line(R=1 / (2 / self.roller_diameter + sign * 2 / track), length=self.length)

    def stiffness(self, E_star: float) -> float:
        """Load over approach of the rings to the power 10/9, of one roller [N/m^(10/9)]."""
        return float((self.length**0.8 / (2 * 1.36)) ** ROLLERS * E_star)

    def widths(self, loads: object, ring: Ring, E_star: float) -> Any:
        """Widths of the tracks: the length of the rollers [m]."""
        return np.full_like(np.asarray(loads, float), self.length)

    @property
    def static_rating(self) -> float:
        """Basic static load rating C_0 [N]: ISO 76, 44 (1 − γ) Z l D_w with lengths in mm."""
        return 44e6 * (1 - self.gamma) * self.rollers * self.length * self.roller_diameter

    @property
    def rating(self) -> float:
        """Basic dynamic load rating C [N] as given; NaN else."""
        return math.nan if self.dynamic_rating is None else self.dynamic_rating

    @property
    def fatigue_load(self) -> float:
        """Fatigue load limit C_u [N]: as given, else C_0/8.2."""
        return self.static_rating / 8.2 if self.fatigue_limit is None else self.fatigue_limit


def _misfits(
    bearing: BallBearing | RollerBearing, size: float, what: str, count: float
) -> list[str]:
    """What cannot be of the dimensions of a bearing."""
    kind = type(bearing).__name__
    bore, outer = bearing.bore, bearing.outer_diameter
    if outer <= bore:
        rule = f"must be above the bore, {bore:g} [m]"
        hint = "check the units of both"
        return [
            Problem("outer_diameter", rule, f"{outer:g}", hint=hint, owner=kind, code=Mistake.ORDER)
        ]
    out: list[str] = []
    if size >= (room := 0.5 * (outer - bore)):
        rule = f"must be below {room:g} [m], the room between bore and outer diameter"
        out.append(Problem(f"{what}_diameter", rule, f"{size:g}", owner=kind, code=Mistake.ORDER))
    elif count * size > math.pi * bearing.pitch_diameter:
        rule = f"of {size:g} m do not fit on a circle of {bearing.pitch_diameter:g} m"
        out.append(Problem(f"{what}s", rule, f"{count:g}", owner=kind, code=Mistake.BEYOND))
    if abs(bearing.clearance) > 0.1 * size:
        rule = f"must be within a tenth of the {what}, {0.1 * size:g} [m]"
        value = f"{bearing.clearance:g}"
        out.append(
            Problem(
                "clearance", rule, value, hint="10 um are 10e-6", owner=kind, code=Mistake.BEYOND
            )
        )
    return out


@takes_units
def preloaded_load(force: float, preload: float) -> float:
    r"""Load on the one of two preloaded nuts, or sides, that a force presses more.

    .. math:: F_1 - F_2 = F, \qquad F_1^{2/3} + F_2^{2/3} = 2F_0^{2/3}

    until the other one is relieved, from F = 2^{3/2} F_0 on; then F_1 = F.

    Parameters
    ----------
    force : float
        F [N].
    preload : float
        F_0 [N].

    Notes
    -----
    Point contacts alone give way (Hertz, load over approach to the power 3/2); screw, nut and
    carriage are stiff.

    Examples
    --------
    >>> from thirdbody.systems.machine_elements import preloaded_load
    >>> preloaded_load(0.0, 100.0), round(preloaded_load(100.0, 100.0), 1)
    (100.0, 154.2)
    """
    from scipy.optimize import brentq

    if preload <= 0 or force >= BALLS_RELIEVED * preload:
        return max(force, preload)
    if force <= 0:
        return preload

    def excess(x: float) -> float:
        """Of F_1 = x F_0, which a preload of any size leaves near 1."""
        return x - max(2 - x ** (2 / 3), 0.0) ** 1.5 - force / preload

    return preload * float(brentq(excess, 1.0, BALLS_RELIEVED, xtol=1e-300, rtol=1e-14))


@dataclass(frozen=True, slots=True, kw_only=True)
class BallScrew(Body):
    r"""A ball screw under an axial force: its balls on the screw or in the nut.

    .. math:: Q = \frac{F_1}{Z\sin\beta\cos\varphi}, \qquad
              \frac1{R_x} = \frac2D \pm \frac{2\cos\beta\cos^2\varphi}{d_m \mp D\cos\beta}, \qquad
              \tan\varphi = \frac{P_h}{\pi\,(d_m \mp D\cos\beta)}

    with F_1 the force on the nut that carries more (`preloaded_load`); upper signs for the screw.

    Parameters
    ----------
    diameter : float
        Of a ball D [m].
    pitch_diameter : float
        Of the circle on which the balls run d_m [m].
    lead : float
        Way per turn P_h [m].
    balls : float
        Loaded balls of one nut Z [1], which share its force alike.
    contact_angle : float, optional
        β [rad].
    screw_conformity, nut_conformity : float, optional
        Radius of each groove over the diameter of a ball [1], above 0.5.
    preload : float, optional
        Axial force between two nuts, F_0 [N].
    shaft_speed : float, optional
        Of the screw ω [rad/s].
    side : {"screw", "nut"}, optional
        Where the contact is solved.

    Notes
    -----
    The curvature along the groove is the normal curvature of its helix at the contact. Balls at
    the ends of a nut carry more than others in reality, as screw and nut stretch; here all carry
    alike.

    References
    ----------
    Derived here from the geometry of a helix; without lead it is `BallInGroove`. Preload: Harris
    2001, Rolling Bearing Analysis, 4th ed., ch. 8.

    Examples
    --------
    >>> from thirdbody.systems.machine_elements import BallScrew
    >>> screw = BallScrew(diameter=6.35e-3, pitch_diameter=40e-3, lead=10e-3, balls=60)
    >>> round(float(screw.load_on_one(2000.0, 113e9)), 1)
    47.3
    """

    diameter: float = quantity("D", "m", "diameter of a ball", gt=0, usual=1.0)
    pitch_diameter: float = quantity(
        "d_m", "m", "diameter of the circle of balls", gt=0, usual=10.0
    )
    lead: float = quantity("P_h", "m", "way per turn", gt=0, usual=1.0)
    balls: float = count_field("Z", "loaded balls of a nut", ge=1)
    contact_angle: float = quantity(
        "β",
        "rad",
        "contact angle",
        default=math.pi / 4,
        gt=0,
        lt=math.pi / 2,
        hint="write '45 deg'",
    )
    screw_conformity: float = quantity(
        "f_s", "1", "groove radius over ball diameter, screw", default=0.53, gt=0.5, le=10
    )
    nut_conformity: float = quantity(
        "f_n", "1", "groove radius over ball diameter, nut", default=0.53, gt=0.5, le=10
    )
    preload: float = quantity("F_0", "N", "force between two nuts", default=0.0, ge=0)
    shaft_speed: float | None = quantity(
        "ω", "rad/s", "speed of the screw", default=None, gt=0, hint="write '1500 rpm'"
    )
    side: Literal["screw", "nut"] = choice("where the contact is", default="screw")

    def _problems(self) -> list[str]:
        if self.pitch_diameter <= self.diameter:
            return [
                Problem(
                    "pitch_diameter",
                    f"must be above the diameter of "
                    f"a ball, {self.diameter:g} [m]; check the units of both",
                    f"{self.pitch_diameter:g}",
                    code=Mistake.ORDER,
                )
            ]
        if self.lead < self.diameter:
            return [
                Problem(
                    "lead",
                    f"must be at least the diameter of a ball, "
                    f"{self.diameter:g} [m], which lies between two turns",
                    f"{self.lead:g}",
                    code=Mistake.RANGE,
                )
            ]
        return []

    @property
    def bodies(self) -> float:  # type: ignore[override]
        """Loaded balls Z [1]."""
        return self.balls

    @property
    def track(self) -> str:
        """Where the contact is solved."""
        return f"the {self.side}"

    @property
    def lead_angle(self) -> float:
        """Lead angle of the circle of balls φ [rad]."""
        return math.atan(self.lead / (math.pi * self.pitch_diameter))

    @property
    def conjunction(self) -> Point:
        """An ellipse, long across the motion."""
        sign = 1 if self.side == "screw" else -1
        cos = math.cos(self.contact_angle)
        track = self.pitch_diameter - sign * self.diameter * cos  # its diameter at the contact
        slope = self.lead / (math.pi * track)
        along = 2 / self.diameter + sign * 2 * cos / ((1 + slope**2) * track)
        f = self.screw_conformity if self.side == "screw" else self.nut_conformity
        return Point(R=1 / along, R_y=1 / (2 / self.diameter - 1 / (f * self.diameter)))

    def load_on_one(self, force: object, E_star: float) -> Number:
        """Load on a ball of the nut that carries more, of an axial force [N]."""
        forces = np.asarray(force, float)
        more = [preloaded_load(float(axial_load), self.preload) for axial_load in forces.ravel()]
        share = self.balls * math.sin(self.contact_angle) * math.cos(self.lead_angle)
        return np.reshape(more, forces.shape)[()] / share

    @property
    def rolling_speed(self) -> float | None:
        """Mean speed at which groove and balls drag the oil in u [m/s]; None without its speed."""
        if self.shaft_speed is None:
            return None
        gamma = self.diameter * math.cos(self.contact_angle) / self.pitch_diameter
        around = self.pitch_diameter / math.cos(self.lead_angle)
        return 0.25 * self.shaft_speed * around * (1 - gamma**2)


@dataclass(frozen=True, slots=True, kw_only=True)
class LinearGuide(Body):
    r"""A linear guide under a force: the balls of its rows on the straight grooves.

    .. math:: Q = \frac{F_1}{n_r Z \sin\beta}, \qquad R_x = \tfrac12D, \qquad u = \tfrac12v

    with F_1 the force on the rows that it presses (`preloaded_load`).

    Parameters
    ----------
    diameter : float
        Of a ball D [m].
    rows : float
        Rows that the force presses n_r [1].
    balls : float
        Loaded balls of a row Z [1], which carry alike.
    contact_angle : float, optional
        Between the line of contact and the plane across the force, β [rad].
    conformity : float, optional
        Radius of the groove over the diameter of a ball [1], above 0.5.
    preload : float, optional
        Force between the rows and those opposite, F_0 [N].
    speed : float, optional
        Of the carriage v [m/s].

    References
    ----------
    Derived here: a ball rolls between rail and carriage at half the speed of the carriage.

    Examples
    --------
    >>> from thirdbody.systems.machine_elements import LinearGuide
    >>> guide = LinearGuide(diameter=4e-3, rows=2, balls=12)
    >>> round(float(guide.load_on_one(1000.0, 113e9)), 2)
    58.93
    """

    diameter: float = quantity("D", "m", "diameter of a ball", gt=0, usual=1.0)
    rows: float = count_field("n_r", "rows that the force presses", ge=1)
    balls: float = count_field("Z", "loaded balls of a row", ge=1)
    contact_angle: float = quantity(
        "β",
        "rad",
        "contact angle",
        default=math.pi / 4,
        gt=0,
        le=math.pi / 2,
        hint="write '45 deg'",
    )
    conformity: float = quantity(
        "f", "1", "groove radius over ball diameter", default=0.52, gt=0.5, le=10
    )
    preload: float = quantity("F_0", "N", "force between opposite rows", default=0.0, ge=0)
    speed: float | None = quantity("v", "m/s", "speed of the carriage", default=None, gt=0)

    @property
    def bodies(self) -> float:  # type: ignore[override]
        """Loaded balls of all pressed rows [1]."""
        return self.rows * self.balls

    @property
    def track(self) -> str:
        """The groove of the rail."""
        return "the rail"

    @property
    def conjunction(self) -> Point:
        """An ellipse, long across the motion."""
        return BallInGroove(diameter=self.diameter, conformity=self.conformity).conjunction

    def load_on_one(self, force: object, E_star: float) -> Number:
        """Load on a ball of the pressed rows, of a force on the carriage [N]."""
        forces = np.asarray(force, float)
        more = [
            preloaded_load(float(carriage_load), self.preload) for carriage_load in forces.ravel()
        ]
        return np.reshape(more, forces.shape)[()] / (self.bodies * math.sin(self.contact_angle))

    @property
    def rolling_speed(self) -> float | None:
        """Mean speed at which groove and balls drag the oil in u [m/s]; None without its speed."""
        return None if self.speed is None else 0.5 * self.speed


@dataclass(frozen=True, slots=True, kw_only=True)
class Gear(Body):
    r"""A pair of involute gears at the pitch point: the line where one tooth rolls on the other.

    .. math::

        \rho_{1,2} = \tfrac12 d_{1,2}\frac{\sin\alpha_t}{\cos\beta_b}, \qquad
        Q = \frac{F_t}{\cos\alpha_t\cos\beta_b}, \qquad l = \frac{b}{\cos\beta_b}, \qquad
        u = \tfrac12\omega_1 d_1\sin\alpha_t

    Parameters
    ----------
    pinion_teeth, wheel_teeth : float
        z_1 and z_2 [1].
    module : float
        Normal module m_n [m].
    face_width : float
        b [m].
    pressure_angle : float, optional
        Normal pressure angle α_n [rad].
    helix_angle : float, optional
        β [rad]; 0 for spur gears.
    shaft_speed : float, optional
        Of the pinion ω_1 [rad/s].

    Notes
    -----
    The force of [load] is the tangential one at the pitch circle, F_t = 2T_1/d_1, and one pair of
    teeth carries it over the whole width, without profile shift. The largest pressure is then that
    of ISO 6336-2, Z_H Z_E √(F_t/(d_1 b) (u + 1)/u).

    References
    ----------
    ISO 6336-2; Johnson 1985, Contact Mechanics, ch. 4.

    Examples
    --------
    >>> from thirdbody.systems.machine_elements import Gear
    >>> pair = Gear(pinion_teeth=20, wheel_teeth=60, module=2e-3, face_width=20e-3)
    >>> round(pair.conjunction.R * 1e3, 3), round(float(pair.hertz(1000.0, 113e9).maximum) / 1e6)
    (5.13, 611)
    """

    pinion_teeth: float = count_field("z_1", "teeth of the pinion", ge=5)
    wheel_teeth: float = count_field("z_2", "teeth of the wheel", ge=5)
    module: float = quantity("m_n", "m", "normal module", gt=0)
    face_width: float = quantity("b", "m", "width of the teeth", gt=0, usual=1.0)
    pressure_angle: float = quantity(
        "α_n", "rad", "normal pressure angle", default=math.radians(20), gt=0, lt=math.pi / 4,
        hint="write '20 deg'",
    )  # fmt: skip
    helix_angle: float = quantity(
        "β", "rad", "helix angle", default=0.0, ge=0, lt=math.pi / 3, hint="write '15 deg'"
    )
    shaft_speed: float | None = quantity(
        "ω_1", "rad/s", "speed of the pinion", default=None, gt=0, hint="write '1500 rpm'"
    )

    @property
    def bodies(self) -> float:  # type: ignore[override]
        """One pair of teeth carries."""
        return 1.0

    @property
    def track(self) -> str:
        """The second gear."""
        return "the wheel"

    @property
    def transverse_angle(self) -> float:
        """Transverse pressure angle α_t [rad]."""
        return math.atan(math.tan(self.pressure_angle) / math.cos(self.helix_angle))

    @property
    def base_helix(self) -> float:
        """Helix angle on the base cylinder β_b [rad]."""
        return math.asin(math.sin(self.helix_angle) * math.cos(self.pressure_angle))

    @property
    def pitch_diameters(self) -> tuple[float, float]:
        """Diameters of pinion and wheel, d_1 and d_2 [m]."""
        size = self.module / math.cos(self.helix_angle)
        return size * self.pinion_teeth, size * self.wheel_teeth

    @property
    def conjunction(self) -> Line:
        """The line of contact at the pitch point."""
        bent = 0.5 * math.sin(self.transverse_angle) / math.cos(self.base_helix)
        first, second = (bent * d for d in self.pitch_diameters)
        length = self.face_width / math.cos(self.base_helix)
        return Line(R=1 / (1 / first + 1 / second), length=length)

    def load_on_one(self, force: object, E_star: float) -> Number:
        """Load normal to the teeth, of a tangential force [N]."""
        tilt = math.cos(self.transverse_angle) * math.cos(self.base_helix)
        return np.asarray(force, float) / tilt

    @property
    def rolling_speed(self) -> float | None:
        """Mean speed at which the teeth drag the oil in u [m/s]; None without shaft speed."""
        if self.shaft_speed is None:
            return None
        return 0.5 * self.shaft_speed * self.pitch_diameters[0] * math.sin(self.transverse_angle)
