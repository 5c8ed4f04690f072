"""Angular particles: a rounded tip, then faces that stay similar to themselves."""

import math
from unittest import mock

import numpy as np
import pytest
from refusals import Mistake, refuses, warns_of

import thirdbody as tb
from thirdbody.effects.single.ploughing import (
    coefficient_of_faces,
    groove_area,
    groove_area_of_faces,
)
from thirdbody.equilibrium import solve as equilibrium
from thirdbody.equilibrium.states import state_columns
from thirdbody.laws.particle import Flakes, Horng2022, Series
from thirdbody.laws.particle.faces import FacedSide
from thirdbody.laws.particle.one_particle import Side

QUARTZ = tb.Material(E=95.8e9, nu=0.082, H=12e9)
STEEL = tb.Material(E=206e9, nu=0.29, H=7.4e9)
SOFTER = STEEL.replace(H=4.0e9)
HARD = tb.MaterialPair(STEEL, STEEL)
UNLIKE = tb.MaterialPair(STEEL, SOFTER)
ROUGH = tb.Roughness(sigma=100e-9, R=3e-6)


def angular(roundness=0.25, degrees=35.0, flatness=1.0):
    return tb.grains.Angular(roundness=roundness, angle=f"{degrees} deg", flatness=flatness)


def load(eps, shape, surfaces=HARD, particle=QUARTZ, law=None):
    """Load over x² [Pa]."""
    law = (law or Series(deep="off")).of_shape(shape)
    found = law.single(1.0, 1 - np.asarray(eps), surfaces=surfaces, particle=particle)
    return found["force"]


def one(shape, surfaces=HARD, particle=QUARTZ, law=None):
    return (law or Series(deep="off")).of_shape(shape).one(surfaces=surfaces, particle=particle)


def side(shape, E_over_H=40.0, law=None, H=1e9):
    return FacedSide(law or tb.asperity.Hermite(), E_over_H * H, H, 0.3, shape)


def contact(shape=None, surfaces=UNLIKE, outputs=(), law=None, **options):
    more = {} if shape is None else {"shape": shape}
    dust = tb.Particles(
        material=QUARTZ, areal_density=2e10,
        diameter=tb.TruncatedGaussian(mean=1e-6, std=1e-7), **more | options,
    )  # fmt: skip
    return tb.Contact(
        surfaces=surfaces, roughness=ROUGH, particles=dust, outputs=outputs,
        particle_law=law or Series(deep="off"),
    )  # fmt: skip


# ------------------------------------------------------------- an independent slow implementation
@pytest.mark.parametrize(
    ("roundness", "degrees", "value"),
    [
        (0.25, 25, 0.9241320198053088),
        (0.25, 35, 0.9783893168465594),
        (0.15, 18, 0.839277335749562),
    ],
)
def test_pressure_on_the_faces(roundness, degrees, value):
    found = one(angular(roundness, degrees)).sides[0].pressure
    assert found == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    ("surfaces", "roundness", "degrees", "eps", "value"),
    [
        (HARD, 0.25, 35, 0.3, 1135436608.3062418),
        (HARD, 0.5, 45, 0.2, 1019728116.251211),
        (UNLIKE, 0.25, 25, 0.2, 675319886.4736111),
        (UNLIKE, 0.25, 35, 0.5, 2333904315.8069673),
    ],
)
def test_loads(surfaces, roundness, degrees, eps, value):
    found = float(load(eps, angular(roundness, degrees), surfaces))
    assert found == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    ("a", "roundness", "degrees", "value"),
    [(0.1, 0.25, 25, 0.2632407658450211), (0.03, 0.3, 40, 0.08488263631567752)],
)
def test_ploughing(a, roundness, degrees, value):
    shape = angular(roundness, degrees)
    found = coefficient_of_faces(a, edge=shape.edge, angle=shape.angle)
    assert float(found) == pytest.approx(value, rel=1e-12)


TABLE = {
    (0.5, 45): (1.00, 0.007, 0.022, 0.059, 0.297, 0.552, 1.00),
    (0.25, 35): (0.98, 0.004, 0.015, 0.040, 0.196, 0.471, 0.98),
    (0.25, 25): (0.92, 0.004, 0.014, 0.038, 0.247, 0.637, 0.92),
    (0.15, 18): (0.84, 0.003, 0.012, 0.042, 0.338, 0.840, 0.84),
}
"""Pressure on the faces over H, and load over πHx²/4 at ε = 0.02, 0.05, 0.1, 0.3, 0.5 and 1."""


@pytest.mark.parametrize("which", list(TABLE))
def test_quartz_in_hardened_steel(which):
    steel = STEEL.replace(H=7.37e9)
    shape = angular(*which)
    pair = tb.MaterialPair(steel, steel)
    eps = np.array([0.02, 0.05, 0.1, 0.3, 0.5, 1.0])
    found = load(eps, shape, pair) / (np.pi / 4 * steel.H)
    assert one(shape, pair).sides[0].pressure == pytest.approx(TABLE[which][0], abs=0.005)
    np.testing.assert_allclose(found[:-1], TABLE[which][1:-1], rtol=0, atol=0.0005)
    assert found[-1] == pytest.approx(TABLE[which][-1], abs=0.005)


# ---------------------------------------------------------------------------- closed limits
@pytest.mark.spread(3)
@pytest.mark.parametrize("degrees", [45.0, 60.0, 89.0])
def test_a_round_shape_is_a_sphere(degrees):
    """R_w = 1 and faces of 45° and more: every number of a sphere, bit for bit."""
    outputs = (tb.outputs.Friction(tau_ss=1e6, tau_sa=1e6), tb.outputs.Dents())
    loads = [1e6, 1e7, 1e8]
    spheres = tb.solve(contact(outputs=outputs), pressure=loads).columns()
    shaped = tb.solve(contact(angular(1.0, degrees), outputs=outputs), pressure=loads).columns()
    for name, value in spheres.items():
        np.testing.assert_array_equal(shaped[name], value, err_msg=name)


def test_a_sphere_is_what_the_law_is_written_for():
    law = Series(deep="off")
    assert law.of_shape(tb.grains.Sphere()) is law
    assert contact(tb.grains.Sphere()) == contact()
    assert contact().law_of(contact().particles) is contact().particle_law or law == Series(
        deep="off"
    )


@pytest.mark.parametrize("degrees", [10.0, 30.0, 60.0])
def test_rigid_plastic(degrees):
    """A = π cot²β (δ + δ_t)² on one side, and a sharp cone f = (π/4) cot²β H δ² between two."""
    shape = angular(0.2, degrees)
    cot = 1 / math.tan(shape.angle)
    half = side(shape, E_over_H=1e9)
    delta_t = 0.5 * shape.tip_radius * math.tan(shape.angle) ** 2
    delta = np.linspace(1.01 * delta_t, 0.99 * half.cap * half.delta_1, 20)
    np.testing.assert_allclose(half.area(delta), np.pi * cot**2 * (delta + delta_t) ** 2, rtol=1e-9)
    np.testing.assert_allclose(half.force(delta), 1e9 * half.area(delta), rtol=1e-12)
    sharp = angular(1e-7, degrees)
    stiff = tb.Material(E=1e18, nu=0.3, H=7e9)
    found = load(0.1, sharp, tb.MaterialPair(stiff, stiff), stiff.replace(H=1e10))
    assert float(found) == pytest.approx(np.pi / 4 * cot**2 * 7e9 * 0.01, rel=1e-5)


def test_unequal_plastic_cones():
    """δ_1/δ_2 = √(H_2/H_1)."""
    stiff = tb.Material(E=1e18, nu=0.3, H=8e9)
    pair = tb.MaterialPair(stiff, stiff.replace(H=2e9))
    law = Series(deep="off").of_shape(angular(1e-7, 40.0))
    found = law.single(1.0, 0.8, surfaces=pair, particle=stiff.replace(H=1e10))
    assert float(found["delta_2"] / found["delta_1"]) == pytest.approx(2.0, rel=1e-5)


def test_an_elastic_joint_is_sneddons_cone():
    """a′ = (2/π) cot β, and a mean pressure of 0.424 E* tan β against ½ E* tan β."""
    shape = angular(0.3, 8.0)
    half = side(shape, E_over_H=1e-3)
    delta = np.array([1.5, 1.6]) * half.joint * half.delta_1
    a = np.sqrt(half.area(delta) / np.pi)
    slope = (a[1] - a[0]) / (delta[1] - delta[0])
    assert slope == pytest.approx(2 / np.pi / math.tan(shape.angle), rel=1e-12)
    p = half.pressure * half.H
    assert p == pytest.approx(4 / (3 * np.pi) * 1e6 * math.tan(shape.angle), rel=1e-12)


LAWS = ["gw", "ceb", "zmc", "hermite", "ke", "jg"]


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("degrees", [5.0, 25.0, 50.0])
@pytest.mark.parametrize("E_over_H", [5.0, 40.0, 1000.0])
def test_continuous_and_rising(name, degrees, E_over_H):
    """Area, pressure and load at the joint and at the cap; the slope jumps as it is said to."""
    law = tb.asperity.REGISTRY[name]()
    shape = angular(0.4, degrees, 1.2)
    half = side(shape, E_over_H, law)
    for y in (half.joint, float(half.cap)):
        around = np.array([y * (1 - 1e-12), y * (1 + 1e-12)]) * half.delta_1
        if y not in half.law.jumps:
            assert np.ptp(half.force(around)) <= 1e-9 * half.force(around)[0]
            assert np.ptp(half.area(around)) <= 1e-9 * half.area(around)[0]
    delta = np.geomspace(1e-6, 2 * half.cap, 4000) * half.delta_1
    if not half.law.jumps:
        assert np.all(np.diff(half.area(delta)) >= -1e-15)
        assert np.all(np.diff(half.force(delta)) >= -1e-9 * half.H * 1e-6)
    assert half.area(delta[-1:])[0] == pytest.approx(np.pi / 4 * 1.2**2, rel=1e-15)
    # dF/dδ: 2π p_j b cot β/r_c on the faces, the law's stiffness on the tip
    joint = half.joint * half.delta_1
    delta_t = 0.5 * shape.tip_radius * math.tan(shape.angle) ** 2
    r_c = 1 + (np.pi / 2 - 1) * (joint / delta_t - 1)
    on_faces = 2 * np.pi * half.pressure * half.H * shape.edge / math.tan(shape.angle) / r_c
    step = 1e-6 * joint
    after = np.diff(half.force(np.array([joint, joint + step])))[0] / step
    assert after == pytest.approx(on_faces, rel=1e-4)


@pytest.mark.parametrize("name", LAWS)
def test_the_faces_begin_where_the_law_reaches_their_radius(name):
    """Also where its area has jumped down before."""
    shape = angular(0.05, 5.0)
    law = tb.asperity.REGISTRY[name]()
    first = side(shape, 40.0, law)
    here = shape.edge**2 / (first.R * first.delta_1)  # reduced area of the joint, as (E/H)²
    for reduced in (1.03, 1.05, *np.geomspace(0.3, 300, 40)):
        E_over_H = 40.0 * math.sqrt(reduced / here)
        half = side(shape, E_over_H, law)
        if np.min(np.abs(half.joint / np.array(half.law.breakpoints or (0.0,)) - 1)) > 1e-6:
            area = float(half.law.reduced("area", half.joint))
            assert area == pytest.approx(reduced, rel=1e-9)


def test_the_slope_of_a_plastic_tip_does_not_jump():
    """p_j = H and s ≥ 1: the faces go on as the tip ended."""
    half = side(angular(0.5, 40.0), E_over_H=1e8)
    joint = half.joint * half.delta_1
    step = 1e-6 * joint
    f = half.force(joint + step * np.array([-1.0, 0.0, 1.0]))
    assert f[2] - f[1] == pytest.approx(f[1] - f[0], rel=1e-5)


def test_ploughing_is_continuous_and_ends_at_the_cone():
    edge, angle = 0.07, 0.4
    around = coefficient_of_faces(edge * np.array([1 - 1e-12, 1 + 1e-12]), edge=edge, angle=angle)
    assert np.ptp(around) < 1e-11
    cone = 2 / np.pi * math.tan(angle)
    assert coefficient_of_faces(1e9, edge=edge, angle=angle) == pytest.approx(cone, rel=1e-12)
    assert coefficient_of_faces(0.0, edge=edge, angle=angle) == 0
    # the groove of a shallow tip is that of a sphere
    a, r = 1e-3, edge / math.tan(angle)
    tip = groove_area_of_faces(a, edge=edge, angle=angle)
    assert float(tip) == pytest.approx(float(groove_area(a**2 / (2 * r), radius=r)), rel=1e-3)


@pytest.mark.parametrize("degrees", [27.0, 45.0, 70.0])
@pytest.mark.parametrize("surfaces", [HARD, UNLIKE], ids=["like", "unlike"])
def test_no_more_load_than_a_sphere_of_the_size(degrees, surfaces):
    """Until the contact ends. Faces below tan β = ½ are wider there than a sphere."""
    shape = angular(0.6, degrees)
    particle = one(shape, surfaces)
    ends = [half.cap * half.delta_1 for half in particle.sides]
    eps = np.geomspace(1e-5, min(ends), 300)
    assert np.all(
        load(eps, shape, surfaces) <= load(eps, tb.grains.Sphere(), surfaces) * (1 + 1e-12)
    )


def test_flatness_bounds_the_area():
    for shape in (angular(0.25, 35.0, 1.5), angular(1.0, 80.0, 1.5)):
        particle = one(shape)
        deep = particle.at(np.array([50.0]))
        assert deep.areas[0][0] == pytest.approx(np.pi / 4 * 1.5**2, rel=1e-15)
        assert particle.breadth == 1.5**2


# ---------------------------------------------------------------------------- populations
@pytest.mark.check
def test_one_contact_by_both_engines():
    case = contact(angular())
    loads = np.geomspace(1e5, 3e7, 40)
    slow = tb.solve(case, pressure=loads)
    with mock.patch.object(equilibrium.engine, "FEWEST", 1):
        quick = tb.solve(case, pressure=loads)
    assert quick.engine == "compiled"
    for name, value in slow.columns().items():
        if name not in ("status", "mode", "iterations", "residual"):
            np.testing.assert_allclose(quick.columns()[name], value, rtol=1e-10, atol=1e-18)


@pytest.mark.parametrize(
    "vary",
    [
        {"roughness.sigma": np.linspace(8e-8, 2e-7, 24)},
        {"particles.areal_density": np.linspace(0, 4e10, 24)},
        {"particles.shape.angle": np.linspace(0.2, 1.0, 24)},
        {"particles.shape.roundness": np.linspace(0.05, 1.0, 24)},
        {"particles.material.H": np.linspace(3e9, 13e9, 24)},
    ],
    ids=lambda vary: next(iter(vary)),
)
def test_many_states_are_each_state(vary):
    case = contact(angular())
    found = state_columns(case, pressure=2e6, vary=vary)
    (name, values), *_ = vary.items()
    for i in (0, 11, 23):
        own = tb.solve(case.replace(**{name: float(values[i])}), pressure=2e6)
        for key in ("d", "A_t", "F_sa_star"):
            assert found[key][i] == pytest.approx(getattr(own, key), rel=1e-9), (key, i)
        plastic = pytest.approx(own.A_p, rel=1e-9, abs=1e-12 * own.A_t)
        assert found["A_p"][i] == plastic, i


def test_a_closed_gap():
    """Particles that the surfaces swallow carry the smaller pressure of their two sides."""
    case = contact(angular(0.25, 35.0, 1.2), law=Series(deep="off", seat="plane", shadow="none"))
    dust = case.particles
    lowest = min(half.pressure * half.H for half in one(dust.shape, UNLIKE).sides)
    covered = np.pi / 4 * 1.2**2 * dust.areal_density * dust.diameter.moment(2)
    found = tb.solve(case, d=0.0)
    assert found.F_sa_star * case.E_ss == pytest.approx(lowest * covered, rel=1e-12)


def test_scale_and_exchange():
    case = contact(angular())
    here = tb.solve(case, pressure=5e6)
    large = case.replace(**{
        "roughness.sigma": 3e-7, "roughness.R": 9e-6, "particles.areal_density": 2e10 / 9,
        "particles.diameter.mean": 3e-6, "particles.diameter.std": 3e-7,
    })  # fmt: skip
    there = tb.solve(large, pressure=5e6)
    assert there.d == pytest.approx(3 * here.d, rel=1e-9)
    assert there.A_t == pytest.approx(here.A_t, rel=1e-9)
    turned = tb.solve(contact(angular(), surfaces=tb.MaterialPair(SOFTER, STEEL)), pressure=5e6)
    assert turned.A_sa == pytest.approx(here.A_sa2, rel=1e-9)


def test_a_tip_softer_than_the_surface_is_blunted_at_its_own_hardness():
    soft = QUARTZ.replace(H=1e9)
    particle = one(angular(0.25, 60.0), particle=soft)
    assert particle.hardness == (1e9, 1e9)
    assert isinstance(particle.sides[0], FacedSide)
    steep = load(2.0, angular(0.25, 60.0), particle=soft)
    assert float(steep) == pytest.approx(particle.sides[0].pressure * 1e9 * np.pi / 4, rel=1e-12)


def test_grains_that_break_may_be_angular():
    """Infinitely strong they are whole; quartz breaks at its corners' tension."""
    strong = tb.grains.WeibullStrength(sigma_0=1e16, x_0=1e-3, m=3, x_c=0.0)
    whole = tb.solve(contact(angular()), pressure=5e6)
    kept = tb.solve(contact(angular(), strength=strong), pressure=5e6)
    assert kept.d == pytest.approx(whole.d, rel=1e-9)
    weak = tb.grains.WeibullStrength(sigma_0=1e8, x_0=1e-6, m=3, x_c=0.0, fragments="gone")
    gone = tb.solve(contact(angular(), strength=weak), d=5e-7)
    assert gone.F_sa_star < 0.5 * tb.solve(contact(angular()), d=5e-7).F_sa_star


# ---------------------------------------------------------------------------- what they leave
def test_dents_are_cones():
    case = contact(angular(0.1, 30.0), surfaces=HARD, outputs=(tb.outputs.Dents(),),
                   law=Series(deep="off", seat="plane"))  # fmt: skip
    case = case.replace(**{"particles.diameter": tb.distributions.Monodisperse(mean=1e-6)})
    state = tb.solve(case, d=6e-7)
    law = case.law_of(case.particles)
    found = law.single(1e-6, 6e-7, surfaces=HARD, particle=QUARTZ)
    a = math.sqrt(float(found["area_1"]) / np.pi)
    assert a > 2 * case.particles.shape.edge * 1e-6
    assert state.outputs["dent_width_1"] == pytest.approx(2 * a, rel=1e-9)
    depth = state.outputs["dent_depth_1"]
    volume = np.pi * a**2 * depth / 3 * case.particles.areal_density
    assert state.outputs["dent_volume_1"] == pytest.approx(volume, rel=1e-9)


def test_half_a_radius_is_a_quarter_of_the_size():
    """Grains are counted as embedded from x/4 in one side, whatever the radius of their tip."""
    outputs = (tb.outputs.Dents(),)
    for d, n in ((5.2e-7, 0.0), (4.8e-7, 2e10)):
        case = contact(
            angular(), surfaces=HARD, outputs=outputs, law=Series(deep="off", seat="plane")
        )
        case = case.replace(**{"particles.diameter": tb.distributions.Monodisperse(mean=1e-6)})
        assert tb.solve(case, d=d).outputs["embedded_1"] == pytest.approx(n)


@pytest.mark.parametrize("degrees", [25.0, 35.0])
def test_the_groove_no_longer_grows_with_load(degrees):
    """μ_p of an unsupported particle between unlike surfaces tends to (2/π) tan β."""
    friction = tb.outputs.Friction(tau_ss=0.0, tau_sa=0.0, rear="rigid")
    case = contact(
        angular(0.05, degrees), outputs=(friction,), law=Series(deep="off", seat="plane")
    )
    case = case.replace(**{"particles.diameter": tb.distributions.Monodisperse(mean=1e-6)})
    law = case.law_of(case.particles)
    spots = law.probe(np.array([0.4, 0.6]), surfaces=UNLIKE, particle=QUARTZ)
    one_side, _ = friction.motion(spots).plough
    np.testing.assert_allclose(one_side, 2 / np.pi * math.tan(math.radians(degrees)), rtol=0.01)


# ---------------------------------------------------------------------------- input and output
def test_shapes_round_trip():
    case = contact(angular(0.3, 20.0, 1.4))
    assert tb.Contact.from_dict(case.to_dict()) == case
    assert hash(case) == hash(tb.Contact.from_dict(case.to_dict()))
    moved = case.replace(**{"particles.shape.angle": 0.5})
    assert moved.particles.shape == tb.grains.Angular(roundness=0.3, angle=0.5, flatness=1.4)
    assert tb.grains.Angular.from_spq(0.5, roundness=0.3).angle == pytest.approx(
        math.pi / 6, rel=1e-15
    )


@pytest.mark.parametrize(
    ("build", "refusal"),
    [
        (lambda: angular(0.0), refuses(Mistake.RANGE, "Angular.roundness", value="0.0")),
        (lambda: angular(1.1), refuses(Mistake.RANGE, "Angular.roundness", value="1.1")),
        (
            lambda: tb.grains.Angular(roundness=0.3, angle=25),
            refuses(Mistake.RANGE, "Angular.angle", value="25"),
        ),
        (lambda: angular(0.3, 0.0), refuses(Mistake.RANGE, "Angular.angle", value="0.0")),
        (
            lambda: angular(0.3, 90.0),
            refuses(Mistake.RANGE, "Angular.angle", value="1.5707963267948966"),
        ),
        (lambda: angular(0.3, 30.0, 0.9), refuses(Mistake.RANGE, "Angular.flatness", value="0.9")),
        (
            lambda: tb.grains.Angular(roundness=0.3, angle="3 nm"),
            refuses(Mistake.UNIT, "Angular.angle", says='"3 nm"'),
        ),
        (
            lambda: tb.grains.Angular.from_spq(1.0, roundness=0.3),
            refuses(Mistake.RANGE, "", says="1.0"),
        ),
        (lambda: contact("angular"), refuses(Mistake.KIND, "Particles.shape", value="'angular'")),
        (lambda: contact(angular(), law=Flakes()), refuses(Mistake.CLASH, "particles.shape")),
        (lambda: contact(angular(), law=Horng2022()), refuses(Mistake.CLASH, "particles.shape")),
    ],
)
def test_bad_input(build, refusal):
    with refusal:
        build()


def test_angles_have_no_default():
    with pytest.raises(TypeError):
        tb.grains.Angular(roundness=0.3)


def test_blunt_faces_are_told_of():
    with warns_of("the particles.blunt", effect=0.15):
        tb.solve(contact(angular(0.3, 3.0)), pressure=1e6)


def test_steep_faces_cut():
    friction = tb.outputs.Friction(tau_ss=1e6, tau_sa=1e6)
    with warns_of("friction.cuts", says="50°"):
        tb.solve(contact(angular(0.3, 50.0), outputs=(friction,)), pressure=1e6)


def test_no_joint_is_a_tip_with_its_own_end():
    """b ≥ φ/2: the tip's law up to the end."""
    shape = angular(0.9, 60.0)
    assert not shape.has_touching_faces
    (half, _) = one(shape).sides
    assert type(half) is Side
    assert half.area(np.array([5.0]))[0] == pytest.approx(np.pi / 4, rel=1e-15)
