"""Machine elements: geometry by hand, Hertz by another way, kinematics, catalogues."""

import math

import numpy as np
import pytest
from refusals import Mistake, refuses
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from thirdbody import InvalidValue
from thirdbody.systems.bearing_sizes import DESIGNATIONS, bearing_size
from thirdbody.systems.bodies import BallInGroove
from thirdbody.systems.machine_elements import (
    BallBearing,
    BallScrew,
    Gear,
    LinearGuide,
    RollerBearing,
    preloaded_load,
)

E_STAR = 113e9
BEARING = BallBearing(
    bore=25e-3, outer_diameter=52e-3, ball_diameter=7.938e-3, balls=9, shaft_speed=100 * math.pi
)
CATALOGUE = {  # C and C_0 [kN] of one maker's catalogue, from memory: not confirmed in a source
    "6000": (4.55, 1.97), "6001": (5.1, 2.37), "6002": (5.6, 2.83), "6003": (6.0, 3.25),
    "6004": (9.4, 5.0), "6005": (10.1, 5.85), "6006": (13.2, 8.3), "6007": (16.0, 10.3),
    "6008": (16.8, 11.5), "6009": (20.9, 15.2), "6010": (21.8, 16.6), "6011": (28.3, 21.2),
    "6012": (29.4, 23.2), "6200": (5.1, 2.39), "6201": (6.8, 3.05), "6202": (7.65, 3.75),
    "6203": (9.55, 4.8), "6204": (12.8, 6.6), "6205": (14.0, 7.85), "6206": (19.5, 11.3),
    "6207": (25.7, 15.3), "6208": (29.1, 17.9), "6209": (31.5, 20.4), "6210": (35.0, 23.2),
    "6211": (43.5, 29.3), "6212": (52.5, 36.0), "6300": (8.1, 3.45), "6301": (9.7, 4.2),
    "6302": (11.4, 5.45), "6303": (13.6, 6.65), "6304": (15.9, 7.9), "6305": (21.2, 10.9),
    "6306": (26.7, 15.0), "6307": (33.5, 19.2), "6308": (40.5, 24.0), "6309": (53.0, 32.0),
    "6310": (62.0, 38.5), "6311": (71.5, 44.5), "6312": (82.0, 52.0),
}  # fmt: skip


def hertz(R_x, R_y, load):
    """Semi-axes along x and y, largest pressure, approach: Johnson 1985, eq. 4.26 to 4.32."""
    A, B = sorted((1 / (2 * R_x), 1 / (2 * R_y)))  # A goes with the longer axis

    def excess(k):  # k = b/a < 1
        e2 = 1 - k * k
        K, E = ellipk(e2), ellipe(e2)
        return math.log((E / k**2 - K) / (K - E)) - math.log(B / A)

    k = brentq(excess, 1e-4, 1 - 1e-9, xtol=1e-15)
    e2 = 1 - k * k
    K, E = ellipk(e2), ellipe(e2)
    # A + B = p_0 E(e)/(b E*) · ..., from A = p_0 b/(E* e² a²)(K − E)
    a = (1.5 * load / math.pi / E_STAR * (K - E) / e2 / A) ** (1 / 3)
    b = k * a
    p_0 = 1.5 * load / (math.pi * a * b)
    return a, b, p_0, p_0 * b * K / E_STAR


@pytest.mark.parametrize("ring", ["inner", "outer"])
def test_the_ellipses_of_both_rings(ring):
    sign, f = (1, 0.52) if ring == "inner" else (-1, 0.53)
    D, d_m = 7.938e-3, 38.5e-3
    track = 0.5 * (d_m - sign * D)  # radius of the raceway
    R_x = 1 / (2 / D + sign / track)
    R_y = 1 / (2 / D - 1 / (f * D))
    a, b, p_0, approach = hertz(R_x, R_y, 700.0)
    shape = BEARING.on_ring(ring)
    assert shape.R == pytest.approx(R_x, rel=1e-12)
    assert shape.R_y == pytest.approx(R_y, rel=1e-12)
    found = shape.hertz(700.0, E=2 * E_STAR)
    assert found.maximum == pytest.approx(p_0, rel=1e-9)
    assert shape.semi_axes(700.0, E=2 * E_STAR) == pytest.approx((b, a), rel=1e-9)
    assert shape.approach(700.0, E=2 * E_STAR) == pytest.approx(approach, rel=1e-9)


def test_both_rings_give_way_one_after_the_other():
    K = BEARING.stiffness(E_STAR)
    both = sum(BEARING.on_ring(ring).approach(350.0, E=2 * E_STAR) for ring in ("inner", "outer"))
    assert 350.0 == pytest.approx(K * both**1.5, rel=1e-12)


def test_the_most_loaded_ball_is_solved():
    tight = BEARING.load_on_one(2000.0, E_STAR)
    assert tight == pytest.approx(4.37 * 2000 / 9, rel=1e-4)
    loose = BEARING.replace(clearance=20e-6)
    many = loose.load_on_one(np.array([[500.0, 2000.0]]), E_STAR)
    assert many.shape == (1, 2)
    assert many[0, 1] == loose.share_load(2000.0, E_STAR).largest > tight
    assert BEARING.hertz(2000.0, E_STAR).maximum == BEARING.hertz_of(tight, "inner", E_STAR).maximum


def test_how_it_turns():
    """Of a cage that the inner ring drives without slip: Case Western's ratios of its 6205."""
    tested = BEARING.replace(ball_diameter=0.3126 * 25.4e-3, bore=26.04e-3, outer_diameter=52.04e-3)
    assert tested.pitch_diameter == pytest.approx(1.537 * 25.4e-3, abs=1e-6)
    assert tested.overrollings("outer") / 50 == pytest.approx(3.5848, abs=2e-4)
    assert tested.overrollings("inner") / 50 == pytest.approx(5.4152, abs=2e-4)
    # u: half the sum of both surfaces' speeds relative to the contact
    omega, d_m, g = BEARING.shaft_speed, BEARING.pitch_diameter, BEARING.gamma
    cage = 0.5 * omega * (1 - g)
    inner = (omega - cage) * 0.5 * d_m * (1 - g)
    outer = cage * 0.5 * d_m * (1 + g)
    assert inner == pytest.approx(outer, rel=1e-14)
    assert BEARING.rolling_speed == pytest.approx(inner, rel=1e-14)
    still = BEARING.replace(shaft_speed=None)
    assert still.rolling_speed is still.overrollings("inner") is None


def test_the_track_that_is_rolled_over():
    """A place of the track meets each ball that passes: swept area over area, without load zone."""
    preloaded = BEARING.replace(clearance=-60e-6)
    share = preloaded.share_load(1e-3, E_STAR)
    for ring in ("inner", "outer"):
        swept = preloaded.swept_area(share, ring, E_STAR) * preloaded.rolling_speed
        area = preloaded.track_area(share, ring, E_STAR)
        assert swept / area == pytest.approx(preloaded.overrollings(ring), rel=1e-3)


@pytest.mark.parametrize("name", DESIGNATIONS)
def test_ratings_are_those_of_catalogues(name):
    """Balls that are typical give the ratings that makers print."""
    bearing = bearing_size(name).bearing()
    C, C_0 = CATALOGUE[name]
    assert bearing.rating == pytest.approx(1e3 * C, rel=0.045)
    assert bearing.static_rating == pytest.approx(1e3 * C_0, rel=0.025)
    assert bearing.fatigue_load == bearing.static_rating / 22
    given = bearing.replace(dynamic_rating=1e4, fatigue_limit=300.0)
    assert (given.rating, given.fatigue_load) == (1e4, 300.0)


@pytest.mark.parametrize("name", DESIGNATIONS)
def test_dimensions_alone_give_nearly_the_same_bearing(name):
    known = bearing_size(name)
    sizes = [f"{1e3 * each:g}" for each in (known.bore, known.outer_diameter, known.width)]
    found = bearing_size("x".join(sizes))
    assert found.estimated
    assert not known.estimated
    assert found[1:4] == known[1:4]
    near = 0.26 if name == "6200" else 0.14  # whose balls are small
    assert found.ball_diameter == pytest.approx(known.ball_diameter, rel=near)
    assert abs(found.balls - known.balls) <= (2 if name == "6200" else 1)


def test_designations():
    assert bearing_size("6203").ball_diameter == pytest.approx(0.2656 * 25.4e-3, abs=1e-6)
    for text, clearance in (
        ("6205", (5e-6, 20e-6)),
        ("6205 C2", (1e-6, 11e-6)),
        ("6205-2RS1/C3", (13e-6, 28e-6)),
        ("6205-2Z C4", (23e-6, 41e-6)),
        ("25 x 52 x 15 C3", (13e-6, 28e-6)),
    ):
        assert bearing_size(text).clearance == clearance
    for text, words in (
        ("6305x", ""),
        ("6505", "did you mean"),
        ("205", "bore x outer diameter x width"),
        ("52x25x15", "must rise from bore"),
        ("70x125x24", "at most 65"),
    ):
        if not words:
            assert bearing_size(text).name == "6305"
            continue
        with pytest.raises(InvalidValue, match=words):
            bearing_size(text)


@pytest.mark.parametrize(
    ("text", "kind", "action"),
    [
        ("7205", "an angular contact ball bearing", "ball-in-groove"),
        ("7205 BEP", "an angular contact ball bearing", "contact_angle"),
        ("NU205", "a cylindrical roller bearing", "new roller-bearing"),
        ("NU 205 ECP", "a cylindrical roller bearing", "new roller-bearing"),
        ("NA4905", "a needle roller bearing", "new rolling-bearing"),
        ("30205", "a tapered roller bearing", "new rolling-bearing"),
        ("51105", "a thrust ball bearing", "ball-in-groove"),
        ("22205", "a spherical roller bearing", "film.conjunction"),
        ("1205", "a self-aligning ball bearing", "ball-in-groove"),
        ("6313", "a deep-groove ball bearing that is not in the list", "25x52x15"),
        ("608", "a deep-groove ball bearing that is not in the list", "25x52x15"),
    ],
)
def test_other_designations_are_named_with_what_can_be_done(text, kind, action):
    with pytest.raises(InvalidValue, match=kind) as told:
        bearing_size(text)
    (problem,) = told.value.problems
    assert action in problem.hint
    assert problem.meant is None


def test_what_the_hints_on_other_bearings_name_can_be_written():
    """A ball of an angular contact bearing and of a thrust bearing, by the keys of the hints."""
    angular = BallInGroove(
        diameter=8e-3, conformity=0.52, pitch_diameter=39e-3, contact_angle=math.radians(40)
    )
    assert angular.conjunction.R == pytest.approx(4e-3 * (1 - 8 / 39 * math.cos(math.radians(40))))
    thrust = BallInGroove(diameter=6e-3, conformity=0.54, bodies=14)
    assert thrust.conjunction.R == pytest.approx(3e-3)
    assert thrust.load_on_one(1400.0, 1e11) == pytest.approx(100.0)


@pytest.mark.parametrize(
    ("change", "refusal"),
    [
        (
            {"outer_diameter": 20e-3},
            refuses(Mistake.ORDER, "BallBearing.outer_diameter", value="0.02"),
        ),
        (
            {"ball_diameter": 15e-3},
            refuses(Mistake.ORDER, "BallBearing.ball_diameter", value="0.015"),
        ),
        ({"balls": 20}, refuses(Mistake.BEYOND, "BallBearing.balls", value="20")),
        ({"balls": 8.5}, refuses(Mistake.KIND, "BallBearing.balls", value="8.5")),
        ({"clearance": 5e-3}, refuses(Mistake.BEYOND, "BallBearing.clearance", value="0.005")),
        (
            {"inner_conformity": 0.5},
            refuses(Mistake.RANGE, "BallBearing.inner_conformity", value="0.5"),
        ),
    ],
)
def test_mistakes(change, refusal):
    with refusal:
        BEARING.replace(**change)


COUNTED = [
    (BallScrew, dict(diameter=6e-3, pitch_diameter=40e-3, lead=10e-3, balls=60), "balls"),
    (LinearGuide, dict(diameter=4e-3, rows=2, balls=12), "balls"),
    (LinearGuide, dict(diameter=4e-3, rows=2, balls=12), "rows"),
    (Gear, dict(pinion_teeth=20, wheel_teeth=60, module=2e-3, face_width=2e-2), "pinion_teeth"),
    (Gear, dict(pinion_teeth=20, wheel_teeth=60, module=2e-3, face_width=2e-2), "wheel_teeth"),
    (BallInGroove, dict(diameter=6e-3, bodies=60), "bodies"),
]
"""Bodies of which some parts are counted."""


@pytest.mark.parametrize(("kind", "options", "name"), COUNTED)
def test_what_is_counted_is_a_whole_number(kind, options, name):
    with refuses(Mistake.KIND, f"{kind.__name__}.{name}", value="60.5"):
        kind(**options | {name: 60.5})
    assert getattr(kind(**options), name) == options[name]


# ------------------------------------------------------------------ rollers
ROLLER = RollerBearing(
    bore=25e-3, outer_diameter=52e-3, roller_diameter=7.5e-3, length=7.5e-3, rollers=12,
    shaft_speed=100 * math.pi,
)  # fmt: skip


def test_rollers_on_both_rings():
    inner, outer = (ROLLER.on_ring(ring) for ring in ("inner", "outer"))
    assert inner.R == pytest.approx(1 / (1 / 3.75e-3 + 1 / 15.5e-3), rel=1e-12)
    assert outer.R == pytest.approx(1 / (1 / 3.75e-3 - 1 / 23e-3), rel=1e-12)
    # Palmgren for steel: 3.84e-5 Q^0.9 l^-0.8 in mm and N on each ring
    steel = 2.07e11 / 2 / (1 - 0.3**2)
    approach = 2 * 3.84e-5 * 1000**0.9 / 7.5**0.8 * 1e-3
    assert ROLLER.stiffness(steel) * approach ** (10 / 9) == pytest.approx(1000, rel=0.02)
    assert ROLLER.load_on_one(2000.0, steel) == pytest.approx(4.085 * 2000 / 12, rel=1e-3)
    share = ROLLER.replace(clearance=-60e-6).share_load(1e-3, steel)
    swept = ROLLER.swept_area(share, "inner", steel) * ROLLER.rolling_speed
    area = ROLLER.track_area(share, "inner", steel)
    assert swept / area == pytest.approx(ROLLER.overrollings("inner"), rel=1e-9)


@pytest.mark.parametrize("clearance", [-20e-6, 0.0, 10e-6, 40e-6])
@pytest.mark.parametrize("ring", ["inner", "outer"])
@pytest.mark.parametrize("body", [BEARING, ROLLER], ids=["balls", "rollers"])
def test_what_is_swept_is_the_mean_over_places_of_the_cage(body, ring, clearance):
    """Bodies at their places, the cage turned little by little, and the tracks of all of them."""
    bearing = body.replace(clearance=clearance)
    share = bearing.share_load(1000.0, E_STAR)
    steps, count = 4000, round(bearing.bodies)
    angles = 2 * np.pi * (np.arange(count * steps) + 0.5) / (count * steps)
    level = np.maximum(1 - (1 - np.cos(angles)) / (2 * share.eps), 0)
    loads = share.largest * level[level > 0] ** body.exponent
    mean = np.sum(bearing.widths(loads, ring, E_STAR)) / steps
    assert bearing.swept_area(share, ring, E_STAR) == pytest.approx(mean, rel=1e-4)


def test_rollers_are_rated():
    """C_0 = 44 (1 − γ) Z l D_w [N, mm]: 4000 MPa below the most loaded roller, ISO 76."""
    steel = 2.07e11 / 2 / (1 - 0.3**2)
    Q = 5 * ROLLER.static_rating / 12
    p_0 = float(ROLLER.hertz_of(Q, "inner", steel).maximum)
    assert p_0 == pytest.approx(4.0e9, rel=0.01)
    assert ROLLER.fatigue_load == ROLLER.static_rating / 8.2
    assert math.isnan(ROLLER.rating)


# ------------------------------------------------------------------ screws and guides
def test_preload_by_the_known_limits():
    """F_0 alone; relieved from 2.83 F_0 on; between, what one gives way the other gets."""
    assert preloaded_load(0.0, 100.0) == 100
    assert preloaded_load(2**1.5 * 100, 100.0) == pytest.approx(2**1.5 * 100, rel=1e-12)
    assert preloaded_load(500.0, 100.0) == 500
    assert preloaded_load(500.0, 0.0) == 500
    small = 1e-3  # both nuts are as stiff: each takes half
    assert preloaded_load(small, 100.0) - 100 == pytest.approx(small / 2, rel=1e-4)
    for F in (10.0, 100.0, 250.0, 280.0):
        one = preloaded_load(F, 100.0)
        assert one ** (2 / 3) + (one - F) ** (2 / 3) == pytest.approx(2 * 100 ** (2 / 3), rel=1e-9)


SCREW = BallScrew(diameter=6.35e-3, pitch_diameter=40e-3, lead=10e-3, balls=60)


@pytest.mark.parametrize("side", ["screw", "nut"])
def test_without_lead_a_screw_is_a_bearing(side):
    """A lead so small counts for nothing; the least that a screw may have is that of the ball."""
    fine = SCREW.replace(diameter=6.35e-6, lead=6.35e-6, side=side)
    ring = {"screw": "inner", "nut": "outer"}[side]
    groove = BallInGroove(
        diameter=6.35e-6, conformity=0.53, pitch_diameter=40e-3, ring=ring,
        contact_angle=math.pi / 4,
    ).conjunction  # fmt: skip
    assert fine.conjunction.R == pytest.approx(groove.R, rel=1e-7)
    assert fine.conjunction.R_y == pytest.approx(groove.R_y, rel=1e-12)


@pytest.mark.parametrize("side", ["screw", "nut"])
@pytest.mark.parametrize("lead", [10e-3, 40e-3])
def test_the_curvature_of_the_helix_by_differences(side, lead):
    """Second derivative of the line of contact over its length, along the normal of the ball."""
    screw = SCREW.replace(lead=lead, side=side)
    sign = 1 if side == "screw" else -1
    r = 0.5 * (40e-3 - sign * 6.35e-3 * math.cos(math.pi / 4))

    def place(t):
        return np.array([r * math.cos(t), r * math.sin(t), lead * t / (2 * math.pi)])

    step = 1e-3
    ahead, here, behind = place(step), place(0.0), place(-step)
    length = np.linalg.norm(ahead - behind) / 2
    bend = (ahead - 2 * here + behind) / length**2
    normal = np.array([math.cos(math.pi / 4), 0.0, math.sin(math.pi / 4)])
    along = 1 / (2 / 6.35e-3 + sign * abs(float(bend @ normal)))
    assert screw.conjunction.R == pytest.approx(along, rel=1e-5)


def test_the_force_on_a_ball_of_a_screw():
    """The balls' forces, resolved along the axis, hold the axial force; torque turns it."""
    Q = float(SCREW.load_on_one(2000.0, E_STAR))
    axial = 60 * Q * math.sin(math.pi / 4) * math.cos(SCREW.lead_angle)
    assert axial == pytest.approx(2000, rel=1e-12)
    torque = 60 * Q * math.sin(math.pi / 4) * math.sin(SCREW.lead_angle) * 20e-3
    assert torque * 2 * math.pi == pytest.approx(2000 * 10e-3, rel=1e-12)  # work of one turn
    tight = SCREW.replace(preload=500.0)
    assert tight.load_on_one(0.1, E_STAR) == pytest.approx(Q / 4, rel=1e-3)
    assert tight.load_on_one(2000.0, E_STAR) == pytest.approx(Q, rel=1e-12)
    with refuses(Mistake.RANGE, "BallScrew.lead", value="0.002"):
        SCREW.replace(lead=2e-3)


def test_a_guide_is_a_straight_screw():
    guide = LinearGuide(diameter=4e-3, rows=2, balls=12, speed=1.0)
    groove = BallInGroove(diameter=4e-3, conformity=0.52).conjunction
    assert guide.conjunction == groove
    assert guide.load_on_one(1000.0, E_STAR) == pytest.approx(1000 / 24 * math.sqrt(2), rel=1e-12)
    assert guide.rolling_speed == 0.5
    assert guide.replace(preload=1e4).load_on_one(1e-6, E_STAR) == pytest.approx(
        1e4 / 24 * math.sqrt(2), rel=1e-6
    )


# ------------------------------------------------------------------ gears
@pytest.mark.parametrize("beta", [0.0, 15.0, 30.0])
@pytest.mark.parametrize("ratio", [1.0, 3.0])
def test_the_pitch_point_is_that_of_iso_6336(beta, ratio):
    """σ_H0 = Z_H Z_E √(F_t/(d_1 b) (u + 1)/u), with the zone factor of the standard."""
    pair = Gear(
        pinion_teeth=20, wheel_teeth=20 * ratio, module=2e-3, face_width=20e-3,
        helix_angle=math.radians(beta), shaft_speed=100.0,
    )  # fmt: skip
    a_n = math.radians(20)
    a_t = math.atan(math.tan(a_n) / math.cos(math.radians(beta)))
    b_b = math.atan(math.tan(math.radians(beta)) * math.cos(a_t))
    Z_H = math.sqrt(2 * math.cos(b_b) * math.cos(a_t) / (math.cos(a_t) ** 2 * math.sin(a_t)))
    Z_E = math.sqrt(E_STAR / math.pi)
    d_1 = 20 * 2e-3 / math.cos(math.radians(beta))
    sigma = Z_H * Z_E * math.sqrt(1000 / (d_1 * 20e-3) * (ratio + 1) / ratio)
    assert float(pair.hertz(1000.0, E_STAR).maximum) == pytest.approx(sigma, rel=1e-12)
    assert pair.rolling_speed == pytest.approx(50.0 * d_1 * math.sin(a_t), rel=1e-12)
    assert pair.pitch_diameters[1] == pytest.approx(ratio * d_1, rel=1e-12)
