"""Machine elements as bodies: what a drawing states, and the contact that carries most."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..quantities.value import choice, quantity
from .body_shapes import BallInGroove, Body
from .conjunctions import Hertz, Point
from .load_sharing import BALLS, RadialShare, share_radial_load

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["BallBearing"]

STATIC, STATIC_SHARE = 4.2e9, 5.0
"""Largest Hertz pressure at the static rating of a ball bearing [Pa], and Z Q_max/C_0 there."""
FATIGUE = 22.0
"""C_0/C_u of ball bearings up to 100 mm pitch diameter."""
REDUCED = 0.95
"""What ISO 281 leaves of the theoretical rating of a single-row deep-groove bearing."""
STEEL_E_STAR = 2.07e11 / 2 / (1 - 0.3**2)
"""E* of bearing steel on itself, with which bearings are rated [Pa]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BallBearing(Body):
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
    >>> bearing = BallBearing(bore=25e-3, outer_diameter=52e-3, ball_diameter=7.938e-3, balls=9)
    >>> round(bearing.load_on_one(2000.0, 113e9) / 2000 * 9, 2)
    4.37
    >>> inner, outer = (bearing.replace(ring=ring) for ring in ("inner", "outer"))
    >>> [round(float(each.hertz(2000.0, 113e9).maximum) / 1e6) for each in (inner, outer)]
    [2361, 2125]
    """

    bore: float = quantity("d", "m", "bore of the bearing", gt=0, usual=1.0)
    outer_diameter: float = quantity("D", "m", "outer diameter of the bearing", gt=0, usual=2.0)
    ball_diameter: float = quantity("D_w", "m", "diameter of a ball", gt=0, usual=1.0)
    balls: float = quantity("Z", "1", "number of balls", ge=3)
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
    ring: str = choice("on which ring the contact is", "inner", "outer", default="inner")
    dynamic_rating: float | None = quantity(
        "C", "N", "basic dynamic load rating", default=None, gt=0
    )
    fatigue_limit: float | None = quantity("C_u", "N", "fatigue load limit", default=None, gt=0)

    def _problems(self) -> list[str]:
        out = []
        if self.outer_diameter <= self.bore:
            return [
                f"BallBearing.outer_diameter = {self.outer_diameter:g} must be above the bore, "
                f"{self.bore:g} [m]; check the units of both"
            ]
        room = 0.5 * (self.outer_diameter - self.bore)
        if self.ball_diameter >= room:
            out.append(
                f"BallBearing.ball_diameter = {self.ball_diameter:g} must be below {room:g} [m], "
                "the room between bore and outer diameter"
            )
        elif self.balls * self.ball_diameter > math.pi * self.pitch_diameter:
            out.append(
                f"BallBearing.balls = {self.balls:g} of {self.ball_diameter:g} m do not fit on a "
                f"circle of {self.pitch_diameter:g} m"
            )
        if self.balls != round(self.balls):
            out.append(f"BallBearing.balls = {self.balls:g} must be a whole number")
        if abs(self.clearance) > 0.1 * self.ball_diameter:
            out.append(
                f"BallBearing.clearance = {self.clearance:g} must be within a tenth of the ball, "
                f"{0.1 * self.ball_diameter:g} [m]; 10 um are 10e-6"
            )
        return out

    @property
    def bodies(self) -> float:  # type: ignore[override]
        """Balls Z [1]."""
        return self.balls

    @property
    def pitch_diameter(self) -> float:
        """Of the circle of the balls d_m [m]."""
        return 0.5 * (self.bore + self.outer_diameter)

    @property
    def gamma(self) -> float:
        """Ball over pitch diameter γ [1]."""
        return self.ball_diameter / self.pitch_diameter

    def on_ring(self, ring: str) -> Point:
        """The ellipse of a ball on the inner or outer ring."""
        inner = ring == "inner"
        return BallInGroove(
            diameter=self.ball_diameter,
            conformity=self.inner_conformity if inner else self.outer_conformity,
            pitch_diameter=self.pitch_diameter,
            ring=ring,
        ).conjunction

    @property
    def conjunction(self) -> Point:
        """The ellipse on the ring that is solved."""
        return self.on_ring(self.ring)

    def stiffness(self, E_star: float) -> float:
        """Load over approach of the rings to the power 3/2, of one ball [N/m^1.5]."""
        yielding = sum(self.on_ring(ring).approach(1.0, E=2 * E_star) for ring in RINGS)
        return float(yielding**-BALLS)

    def share_load(self, force: float, E_star: float) -> RadialShare:
        """How the balls share a radial load [N], by Sjövall's integral.

        Parameters
        ----------
        force : float
            F_r [N].
        E_star : float
            Of the rings and balls E* [Pa].
        """
        return share_radial_load(
            force, bodies=self.balls, stiffness=self.stiffness(E_star), clearance=self.clearance
        )

    def load_on_one(self, force: Any, E_star: float) -> Any:
        """Load on the most loaded ball, of a radial load [N]."""
        forces = np.asarray(force, float)
        found = [self.share_load(float(each), E_star).largest for each in forces.ravel()]
        return np.reshape(found, forces.shape)[()]

    # ------------------------------------------------------------------ how it turns
    @property
    def rolling_speed(self) -> float | None:
        """Mean speed at which rings and balls drag the oil in u [m/s]; None without shaft speed."""
        if self.shaft_speed is None:
            return None
        return 0.25 * self.shaft_speed * self.pitch_diameter * (1 - self.gamma**2)

    def overrollings(self, ring: str) -> float | None:
        """Balls that pass a place of a ring per second [1/s]; None without shaft speed."""
        if self.shaft_speed is None:
            return None
        sign = 1 if ring == "inner" else -1
        return self.balls * self.shaft_speed / (4 * math.pi) * (1 + sign * self.gamma)

    def swept_area(self, share: RadialShare, ring: str, E_star: float) -> float:
        """Track that all balls together roll over while each goes by one length of rolling [m²/m].

        The sum of the widths of the contact ellipses, 2b.
        """
        loads: NDArray[np.float64] = share.loads[share.loads > 0]
        return float(2 * np.sum(self.on_ring(ring).semi_axes(loads, E=2 * E_star)[1]))

    def track_area(self, share: RadialShare, ring: str, E_star: float) -> float:
        """Of the track that the most loaded ball rolls over, all around the ring [m²]."""
        sign = -1 if ring == "inner" else 1
        around = math.pi * self.pitch_diameter * (1 + sign * self.gamma)
        return float(2 * self.on_ring(ring).semi_axes(share.largest, E=2 * E_star)[1] * around)

    # ------------------------------------------------------------------ what it is rated for
    @property
    def rated_as(self) -> str:
        """Kind of bearing by which ISO 281 rates it."""
        return "ball"

    @property
    def rolling_bodies(self) -> str:
        """What rolls in it."""
        return "balls"

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

    def hertz_of(self, load: Any, ring: str, E_star: float) -> Hertz:
        """The smooth dry contact of a ball under its own load [N] on one of the rings."""
        return self.on_ring(ring).hertz(load, E=2 * E_star)


RINGS = ("inner", "outer")
