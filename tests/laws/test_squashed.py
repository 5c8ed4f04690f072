"""Particles softer than a surface: squashed, their volume kept."""

import itertools
import math
from unittest import mock

import numpy as np
import pytest
from refusals import Mistake, refuses

import thirdbody as tb
from thirdbody.equilibrium import solve as equilibrium
from thirdbody.equilibrium.states import state_columns
from thirdbody.errors import code_of
from thirdbody.laws.particle import Flakes, Series
from thirdbody.laws.particle.one_particle import Side
from thirdbody.laws.particle.squashed import Squash, widest_disc

STEEL = tb.Material(E=206e9, nu=0.29, H=7.4e9)
SOFT = tb.Material(E=193e9, nu=0.29, H=1.364e9)
LEAD = tb.Material(E=53e9, nu=0.35, H=245.2e6)
HARD = tb.MaterialPair(STEEL, STEEL)


def load(eps, *, second=STEEL, particle=SOFT, **options):
    """Load over x² [Pa]."""
    law, pair = Series(deep="off", **options), tb.MaterialPair(STEEL, second)
    return law.single(1.0, 1 - np.asarray(eps), surfaces=pair, particle=particle)["force"]


def half(H=1e9, E_over_H=80.0, surface=5.0, m=0.2, onset="hermite", law=None, nu=0.3):
    """One half, of unit size, on a surface so many times as hard."""
    squash = Squash(surface * H, m, onset)
    return squash.side(law or tb.asperity.Hermite(), E_over_H * H, H, nu, 0.5)


def indentations(side):
    """Up to where the disc sinks in, fine at both ends."""
    end = side.kinks[-1] * side.delta_1
    return np.unique([*np.geomspace(1e-7, end, 1000), *(end - np.geomspace(1e-9, end, 1000)[:-1])])


# ------------------------------------------------------------- an independent slow implementation
@pytest.mark.parametrize(
    ("options", "eps", "value", "rel"),
    [
        (dict(), 0.1, 169552579.48900613, 1e-9),
        (dict(), 0.5, 547656459.560061, 1e-9),
        (dict(friction_factor=1.0), 0.3, 413663084.3524948, 1e-9),
        (dict(friction_factor=0.05), 0.95, 8563869092.926443, 1e-9),
        (dict(second=LEAD), 0.4, 192579629.66505426, 1e-8),
        (dict(onset="jg"), 0.02, 39635415.609571, 1e-9),
        (dict(onset="jg"), 0.25, 293257946.76537544, 1e-9),
        (dict(onset="jg"), 0.9, 5085554271.694877, 1e-9),
    ],
)
def test_loads(options, eps, value, rel):
    assert float(load(eps, **options)) == pytest.approx(value, rel=rel)


@pytest.mark.parametrize(
    ("options", "value"),
    [
        (dict(friction_factor=1.0), 0.049179797423071214),
        (dict(onset="jg"), 0.016990291391728474),
    ],
)
def test_final_heights(options, value):
    one = Series(deep="off", **options).one(surfaces=HARD, particle=SOFT)
    assert 1 - one.kinks[-1] == pytest.approx(value, rel=1e-8)


# ---------------------------------------------------------------------------- closed limits
LAWS = {
    name: kind() for name, kind in tb.asperity.REGISTRY.items() if name not in ("coated", "field")
}
YIELDING = ["ceb", "zmc", "hermite", "ke"]
SIDES = list(
    itertools.product(YIELDING, (5.0, 20.0, 80.0, 300.0), (1.0001, 1.5, 50.0), (0.01, 0.2, 1.0))
)


@pytest.mark.parametrize("law", YIELDING)
def test_the_load_rises_and_the_volume_bounds_the_area(law):
    for name, E_over_H, surface, m in SIDES:
        if name != law:
            continue
        side = half(E_over_H=E_over_H, surface=surface, m=m, law=LAWS[law])
        delta = indentations(side)
        force, area, t = side.force(delta), side.area(delta), 1 - 2 * delta
        assert np.all(np.diff(force) > 0)
        assert np.all(area * t <= math.pi / 6 * (1 + 1e-12))
        assert force[-1] / area[-1] == pytest.approx(surface * 1e9, rel=1e-9)
        beyond = side.force(delta[-1] * np.array([1.0, 2.0, 5.0]))
        assert beyond == pytest.approx(force[-1], rel=1e-12)


@pytest.mark.parametrize("nu", [0.1, 0.29])
@pytest.mark.parametrize("E_over_H", [12.0, 40.0, 149.0])
def test_the_load_rises_from_the_onset_of_jackson_and_green(E_over_H, nu):
    side = half(E_over_H=E_over_H, onset="jg", nu=nu)
    delta = indentations(side)
    joins = np.isclose(delta, 1.9 * side.delta_1, rtol=0.02, atol=0)  # where their own load jumps
    force, area = side.force(delta), side.area(delta)
    assert np.all((np.diff(force) > 0) | joins[1:])
    assert np.all(area * (1 - 2 * delta) <= math.pi / 6 * (1 + 1e-12))


def test_a_third_squashed_it_is_a_cylinder_and_then_a_pancake():
    side = half()
    tau = np.array([0.1, 0.2, 1 / 3, 0.5, 0.9])
    area = side.area(tau / 2)
    plastic = math.pi / 4 * 2 * tau / (1 - tau)
    pancake = math.pi / 6 / (1 - tau)
    assert area[:3] == pytest.approx(plastic[:3], rel=1e-12)
    assert area[2:] == pytest.approx(pancake[2:], rel=1e-12)
    assert area[2] == pytest.approx(math.pi / 4, rel=1e-12)  # as wide as the sphere was


def test_the_pressure_of_the_pancake_is_that_of_a_column_and_its_hill():
    side, m = half(m=0.3), 0.3
    delta = np.array([0.2, 0.3, 0.45])
    t = 1 - 2 * delta
    S_y = 1e9 / 2.84
    hill = 2 * m / (3 * math.sqrt(3)) * np.sqrt(1 / (6 * t)) / t
    assert side.force(delta) / side.area(delta) == pytest.approx(S_y * (1 + hill), rel=1e-12)


def test_small_squeezes_are_those_of_a_sphere():
    sphere = Side(tb.asperity.Hermite(), 80e9, 1e9, 0.3)
    off = [
        float(half(m=m).force(np.array([delta]))[0] / sphere.force(np.array([delta]))[0]) - 1
        for m in (1.0, 1e-6)
        for delta in (1e-8, 1e-10)
    ]
    # the hill is of the order √τ, and all else of the order τ
    assert off[0] == pytest.approx(10 * off[1], rel=1e-2)
    assert abs(off[2]) < 1e-7
    assert abs(off[3]) < 1e-9


def test_a_thin_pancake_is_as_high_as_friction_makes_it():
    m, surface = 0.2, 500.0
    t = 1 - 2 * half(m=m, surface=surface).kinks[-1] * half(m=m, surface=surface).delta_1
    assert t == pytest.approx(
        (2 * m / (3 * math.sqrt(18)) / (2.84 * surface - 1)) ** (2 / 3), rel=1e-10
    )


def test_it_keeps_its_scales():
    base = load([0.05, 0.3, 0.9])
    bigger = Series(deep="off").single(3e-6, 3e-6 * (1 - np.array([0.05, 0.3, 0.9])), surfaces=HARD,
                             particle=SOFT)["force"]  # fmt: skip
    assert bigger == pytest.approx(9e-12 * base, rel=1e-12)

    def scaled(body):
        return tb.Material(E=2 * body.E, nu=body.nu, H=2 * body.H)

    twice = Series(deep="off").single(
        1.0,
        1 - np.array([0.05, 0.3, 0.9]),
        surfaces=tb.MaterialPair(scaled(STEEL), scaled(STEEL)),
        particle=scaled(SOFT),
    )["force"]
    assert twice == pytest.approx(2 * base, rel=1e-12)


def test_surfaces_swapped():
    eps = np.array([1e-4, 0.02, 0.3, 0.8, 1.1])
    for second in (LEAD, tb.Material(E=110e9, nu=0.33, H=2e9)):
        one, two = (
            Series(deep="off").single(1.0, 1 - eps, surfaces=tb.MaterialPair(*pair), particle=SOFT)
            for pair in ((STEEL, second), (second, STEEL))
        )
        assert one["force"] == pytest.approx(two["force"], rel=1e-11)
        assert one["area_1"] == pytest.approx(two["area_2"], rel=1e-11)


def test_both_sides_carry_one_load():
    second = tb.Material(E=110e9, nu=0.33, H=2e9)
    pair = tb.MaterialPair(STEEL, second)
    one = Series(deep="off").one(surfaces=pair, particle=SOFT)
    eps = np.geomspace(1e-9, 0.999 * one.kinks[-1], 500)
    depths = one.indentations(eps)
    loads = [side.force(depth) for side, depth in zip(one.sides, depths, strict=True)]
    assert loads[0] == pytest.approx(loads[1], rel=1e-11)


# ---------------------------------------------------------------------------- where it applies
def test_only_where_the_particle_is_softer():
    eps = np.linspace(0.01, 1.1, 30)
    equal = tb.Material(E=193e9, nu=0.29, H=7.4e9)
    for particle, second in ((equal, STEEL), (tb.materials["SiO2"], STEEL), (SOFT, LEAD)):
        pair = tb.MaterialPair(LEAD if particle is SOFT else STEEL, second)
        new, old = (
            Series(deep="off", soft=soft).single(1.0, 1 - eps, surfaces=pair, particle=particle)[
                "force"
            ]
            for soft in ("squashed", "sphere")
        )
        assert np.array_equal(new, old)


def test_a_particle_that_never_yields_stays_a_sphere():
    law, eps = tb.asperity.GW(), np.linspace(0.01, 0.4, 9)
    assert np.array_equal(load(eps, law=law), load(eps, law=law, soft="sphere"))


def test_what_changes_against_a_sphere():
    """304 steel between 60 HRC: less load in wide gaps, much more in thin films."""
    eps = [0.01, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95]
    ratio = load(eps) / load(eps, soft="sphere")
    want = [0.98, 0.90, 0.79, 0.62, 0.54, 0.51, 0.93, 1.6, 4.7, 18]
    assert ratio == pytest.approx(want, rel=0.02)  # two digits
    jg = load(eps, onset="jg") / load(eps, soft="sphere")
    want = [0.84, 0.95, 0.84, 0.60, 0.57, 0.52, 0.95, 1.6, 4.7, 18]
    assert jg == pytest.approx(want, rel=0.02)


@pytest.mark.parametrize(
    ("onset", "E_over_H", "pressure", "radius"),
    [
        ("hermite", 23, 0.95, 0.22),
        ("hermite", 38, 1.01, 0.17),
        ("hermite", 60, 1.04, 0.13),
        ("hermite", 117, 1.07, 0.08),
        ("jg", 23, 0.81, 0.27),
        ("jg", 38, 0.92, 0.22),
        ("jg", 60, 0.99, 0.17),
        ("jg", 117, 1.06, 0.11),
    ],
)
def test_spheres_between_platens(onset, E_over_H, pressure, radius):
    """Measured: at most 0.7 to 0.8 HV at a/R of 0.20 to 0.28, then less. The level is lost."""
    side = half(onset=onset, E_over_H=E_over_H, surface=1e4)
    delta = np.geomspace(1e-5, 0.2, 4000)
    area = side.area(delta)
    over_HV, wide = side.force(delta) / area / 0.927e9, 2 * np.sqrt(area / math.pi)
    most = np.argmax(over_HV)
    assert over_HV[most] == pytest.approx(pressure, abs=0.006)
    assert wide[most] == pytest.approx(radius, abs=0.006)
    assert over_HV[-1] < 0.7 * over_HV[most]


# ---------------------------------------------------------------------------- refusals
@pytest.mark.parametrize(
    ("kind", "options", "refusal"),
    [
        (
            Series,
            dict(friction_factor=0.0),
            refuses(Mistake.RANGE, "Series.friction_factor", value="0"),
        ),
        (
            Series,
            dict(friction_factor=-0.1),
            refuses(Mistake.RANGE, "Series.friction_factor", value="-0.1"),
        ),
        (
            Series,
            dict(friction_factor=1.5),
            refuses(Mistake.RANGE, "Series.friction_factor", value="1.5"),
        ),
        (Series, dict(soft="flat"), refuses(Mistake.OPTION, "Series.soft", value="'flat'")),
        (Series, dict(onset="hertz"), refuses(Mistake.OPTION, "Series.onset", value="'hertz'")),
        (
            Series,
            dict(soft="sphere", friction_factor=0.5),
            refuses(Mistake.IDLE, "Series.friction_factor", says="'squashed'"),
        ),
        (
            Series,
            dict(soft="sphere", onset="jg"),
            refuses(Mistake.IDLE, "Series.friction_factor", says="'squashed'"),
        ),
        (Flakes, dict(soft="squashed"), refuses(Mistake.OPTION, "Flakes.soft", value="'squashed'")),
    ],
)
def test_refused(kind, options, refusal):
    with refusal:
        kind(**options)


@pytest.mark.parametrize("E_over_H", [7.0, 160.0])
def test_jackson_and_green_outside_their_range(E_over_H):
    with refuses(Mistake.BEYOND, "onset", value="'jg'"):
        half(E_over_H=E_over_H, onset="jg")


def test_jackson_and_green_where_the_volume_is_never_filled():
    with refuses(Mistake.BEYOND, "onset", value="'jg'"):
        half(E_over_H=20.0, onset="jg", nu=0.5)


# ---------------------------------------------------------------------------- states
def contact(seat, shadow="footprint", density=1e10, particle=SOFT, **options):
    return tb.Contact(
        surfaces=HARD,
        roughness=tb.Roughness(sigma=50e-9, R=2.8e-6),
        particles=tb.Particles(
            material=particle,
            areal_density=density,
            diameter=tb.TruncatedGaussian(mean=300e-9, std=60e-9),
        ),
        particle_law=Series(deep="off", seat=seat, shadow=shadow, **options),
    )


def test_asperities_have_nothing_left_under_a_closed_layer():
    wide = contact("rough", density=4e12, particle=tb.Material(E=20e9, nu=0.4, H=50e6))
    state = tb.solve(wide, d=[-1e-7])
    assert state.shadow[0] == 1
    assert state.A_ss[0] == 0
    assert "shadow" in map(code_of, state.warnings)


def test_squashed_particles_keep_asperities_apart_by_what_they_cover():
    state = tb.solve(contact("plane", "projected"), d=[5e-9])
    assert state.shadow[0] == pytest.approx(state.A_sa[0], rel=1e-12)
    assert state.shadow[0] > 10 * contact("plane").particles.coverage


def test_engines_agree():
    """Tables in the compiled engine, and states beside each other, against the NumPy engine."""
    pytest.importorskip("numba")
    for seat in ("rough", "plane"):
        case, loads = contact(seat), np.geomspace(1e5, 1e9, 40)
        plain = tb.solve(case, pressure=loads)
        with mock.patch.object(equilibrium.engine, "FEWEST", 1):
            compiled = tb.solve(case, pressure=loads)
        assert (plain.engine[:5], compiled.engine) == ("numpy", "compiled")
        sigma = case.roughness.sigma * np.linspace(1.0, 1.3, 32)
        many = state_columns(case, pressure=5e6, vary={"roughness.sigma": sigma})
        first = tb.solve(case, pressure=5e6).columns()
        for name, values in plain.columns().items():
            if values.dtype.kind == "f" and name not in ("residual", "iterations"):
                assert compiled.columns()[name] == pytest.approx(values, rel=1e-9, abs=1e-15), name
                assert many[name][0] == pytest.approx(first[name][0], rel=1e-9, abs=1e-15), name


def test_hardness_and_friction_of_squashed_particles_are_compiled():
    """Hardness across that of the surfaces: those that are squashed and those that are not."""
    pytest.importorskip("numba")
    H = np.linspace(3e9, 12e9, 60)
    vary = {"particles.material.H": H}
    states = state_columns(contact("rough"), pressure=5e6, vary=vary)
    assert set(states["engine"]) == {"compiled"}
    for i in (0, 20, 59):
        alone = tb.solve(contact("rough", particle=SOFT.replace(H=H[i])), pressure=5e6)
        assert states["d"][i] == pytest.approx(alone.d, rel=1e-9)
    friction = {"particle_law.friction_factor": np.linspace(0.1, 0.5, 30)}
    states = state_columns(contact("rough"), pressure=5e6, vary=friction)
    assert set(states["engine"]) == {"compiled"}
    alone = tb.solve(contact("rough", friction_factor=0.5), pressure=5e6)
    assert states["d"][-1] == pytest.approx(alone.d, rel=1e-9)


@pytest.mark.parametrize("m_f", [0.1, 0.2, 0.7])
@pytest.mark.parametrize("ratio", [1.2, 2.0, 5.0])
def test_the_widest_disc_is_that_of_the_end_of_the_squash(ratio, m_f):
    """The closed form, and where the series of the squashed half ends."""
    H = 1e9
    side = Squash(ratio * H, m_f, "hermite").side(tb.asperity.Hermite(), 1e11, H, 0.3, 0.5)
    t = 1 - 2 * side.delta_1 * side.end
    area = float(side.reduced_area(np.array(side.end))) * np.pi * side.R * side.delta_1
    wide = widest_disc(H, ratio * H, friction_factor=m_f)
    assert wide == pytest.approx(np.sqrt(2 / (3 * t)), rel=1e-9)
    assert wide == pytest.approx(2 * np.sqrt(area / np.pi), rel=1e-9)


def test_a_disc_that_the_surface_does_not_bear_is_no_wider_than_the_sphere():
    assert widest_disc(5e9, 1e9) == 1.0
    assert widest_disc(1e9, 1e9, friction_factor=1.0) < widest_disc(1e9, 1e9)
