"""States by quadrature over their own laws hold to the slow path, and to themselves."""

import os
from itertools import product
from unittest import mock

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.contact.broken_averages import roughly
from thirdbody.contact.interface import interface
from thirdbody.equilibrium.columns import COLUMNS
from thirdbody.equilibrium.load_scan import load_scan
from thirdbody.equilibrium.states import state_columns, tables_each
from thirdbody.errors import NotCompiled
from thirdbody.populations.distributions import PowerLaw

pytest.importorskip("numba")
from thirdbody.equilibrium.compiled.batch import NOT_MONOTONE
from thirdbody.equilibrium.engine.run import own_columns

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
BOUND = 1e-9
"""Of d over σ, of loads over F, of areas over A_t."""
ROUNDED = 2e-11
"""The same, of the slow path itself."""
STEEL = tb.Material(E=208e9, nu=0.3, H=6e9)
SERIES = tb.particle.Series
LAWS = {
    "hermite": SERIES(deep="off"),
    "zmc": SERIES(deep="off", law=tb.asperity.ZMC(k=0.38, rho=70.0)),
    "sphere": SERIES(deep="off", soft="sphere"),
    "projected": SERIES(deep="off", shadow="projected"),
    "deep": SERIES(deep="table"),
}
JUMPING = {
    "ke": SERIES(deep="off", soft="sphere", law=tb.asperity.KE(K=0.577)),
    "ke, deep": SERIES(deep="table", law=tb.asperity.KE(K=0.577)),
    "ceb": SERIES(deep="off", law=tb.asperity.CEB()),
    "jg": SERIES(deep="off", law=tb.asperity.JG()),
    "gw": SERIES(deep="off", law=tb.asperity.GW()),
}
"""Laws whose load jumps, up or down, or that never become plastic."""
SEATS = ("rough", "plane")
BODIES = {"hard": (72e9, 7.7e9), "soft": (190e9, 1e9)}
SIZES = {
    "gaussian": tb.TruncatedGaussian(mean=300e-9, std=30e-9, n=3.0),
    "one size": tb.distributions.Monodisperse(mean=300e-9),
}


def contact(law="hermite", seat="rough", body="hard", sizes="gaussian", other=STEEL, **more):
    E, H = BODIES[body]
    return tb.Contact(
        surfaces=tb.MaterialPair(STEEL, other),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6, alpha=5.0),
        particles=tb.Particles(
            material=tb.Material(E=E, nu=0.2, H=H), areal_density=1e11, diameter=SIZES[sizes]
        ),
        particle_law={**LAWS, **JUMPING}[law].replace(seat=seat),
        **more,
    )


def drawn(case: tb.Contact, count: int, seed: int, unlike: bool) -> tuple[dict, np.ndarray]:
    """Inputs that all vary at once, and loads F*."""
    rng = np.random.default_rng(seed)

    def around(value, spread):
        return value * np.exp(rng.uniform(-spread, spread, count))

    sizes, body = case.particles.diameter, case.particles.material
    x = around(sizes.mean, 0.5)
    vary = {
        "roughness.sigma": around(100e-9, 0.6),
        "roughness.R": around(2.8e-6, 0.7),
        "roughness.alpha": rng.uniform(2, 10, count),
        "particles.areal_density": around(3e10, 1.0),
        "particles.diameter.mean": x,
        "particles.material.E": around(body.E, 0.4),
        "particles.material.nu": rng.uniform(0.1, 0.45, count),
        "particles.material.H": around(body.H, 0.2),
    }
    if hasattr(sizes, "std"):
        vary["particles.diameter.std"] = x * rng.uniform(0.02, 0.25, count)
        vary["particles.diameter.n"] = rng.uniform(1.5, 5, count)
    if unlike:
        vary["surfaces.first.H"] = around(STEEL.H, 0.2)
        vary["surfaces.first.E"] = around(STEEL.E, 0.2)
    return vary, 10.0 ** rng.uniform(-7, -4, count)


def slow(case: tb.Contact, vary: dict, loads: np.ndarray) -> dict:
    with mock.patch.dict(os.environ, THIRDBODY_ENGINE="numpy"):
        return state_columns(case, F_star=loads, vary=vary)


def largest_error(got: dict, want: dict, which: np.ndarray) -> dict[str, float]:
    """Of each column, over what it is measured against."""
    out = {}
    for name in ("d_star", "F_ss_star", "F_sa_star", "A_e", "A_ep", "A_p", "A_sa", "A_sa2", "A_t"):
        unit = {"d": 1.0, "F": want["F_star"]}.get(name[0], want["A_t"])
        out[name] = float(np.max((np.abs(got[name] - want[name]) / unit)[which], initial=0.0))
    return out


def hold(case: tb.Contact, count: int, seed: int, unlike: bool = False) -> None:
    vary, loads = drawn(case, count, seed, unlike)
    got, want = own_columns(case, vary, "F_star", loads), slow(case, vary, loads)
    sure = (got["doubt"] == "") & (got["status"] == 0)
    assert sure.mean() > 0.8
    known = sure & np.isfinite(want["d"])
    assert np.array_equal(sure, known)
    assert max(largest_error(got, want, known).values()) <= BOUND
    assert np.all(got["error"][sure] <= BOUND / 2)
    assert np.all(got["residual"][sure] <= 1e-11)
    for i in np.flatnonzero(known):  # the slow path has some 1e-12 of its own
        one = np.arange(count) == i
        assert max(largest_error(got, want, one).values()) <= got["error"][i] + ROUNDED


@pytest.mark.parametrize("seat", SEATS)
@pytest.mark.parametrize("body", BODIES)
def test_like_sides_hold_to_the_slow_path(seat, body):
    hold(contact("hermite", seat, body), 3, 1)


@pytest.mark.parametrize(
    ("law", "seat"), [("deep", "rough"), ("sphere", "plane"), ("zmc", "rough")]
)
def test_laws_hold_to_the_slow_path(law, seat):
    hold(contact(law, seat, "soft"), 2, 2)


@pytest.mark.parametrize(
    ("law", "seat", "body", "unlike"),
    [
        ("ke", "rough", "hard", True),
        ("ke", "plane", "hard", False),
        ("ke, deep", "rough", "hard", True),
        ("ceb", "rough", "hard", True),
        ("jg", "rough", "soft", True),  # its load falls at its jump where ν is above 0.32
        ("jg", "plane", "soft", False),
        ("gw", "plane", "hard", True),
    ],
)
def test_loads_that_jump_hold_to_the_slow_path(law, seat, body, unlike):
    hold(contact(law, seat, body), 3, 2, unlike)


GRIT = {
    "faces": tb.grains.Angular(roundness=0.25, angle=0.6),
    "blunt": tb.grains.Angular(roundness=0.5, angle=0.2, flatness=1.4),
    "round": tb.grains.Angular(roundness=0.9, angle=1.3),
}


@pytest.mark.parametrize(
    ("shape", "law", "seat", "body", "unlike"),
    [
        ("faces", "hermite", "rough", "hard", True),
        ("faces", "ke", "plane", "soft", False),
        ("blunt", "hermite", "plane", "hard", True),
        ("blunt", "hermite", "rough", "soft", False),
        ("round", "ke", "rough", "hard", True),  # the area jumps past the great circle
    ],
)
def test_angular_particles_hold_to_the_slow_path(shape, law, seat, body, unlike):
    case = contact(law, seat, body)
    case = case.replace(particles=case.particles.replace(shape=GRIT[shape]))
    vary, loads = drawn(case, 3, 7, unlike)
    turn = np.linspace(0.9, 1.1, 3)
    vary["particles.shape.angle"] = GRIT[shape].angle * turn
    vary["particles.shape.roundness"] = GRIT[shape].roundness * turn
    got, want = own_columns(case, vary, "F_star", loads), slow(case, vary, loads)
    sure = got["doubt"] == ""
    assert sure.sum() >= 2
    assert np.array_equal(got["status"][sure] == 0, np.isfinite(want["d"])[sure])
    known = sure & np.isfinite(want["d"])
    assert max(largest_error(got, want, known).values()) <= BOUND


@pytest.mark.parametrize("seat", SEATS)
def test_particles_squeezed_to_the_end_have_the_area_of_the_law(seat):
    # the softer surface takes the rest; the area on the harder one stays where it was
    soft = tb.Material(E=7e9, nu=0.36, H=96e6)
    case = contact("deep", seat, other=soft)
    case = case.replace(
        surfaces=tb.MaterialPair(tb.Material(E=87e9, nu=0.39, H=575e6), soft),
        particles=case.particles.replace(material=tb.Material(E=88e9, nu=0.48, H=123e6)),
    )
    d = np.linspace(-2.0, 0.5, 6) * case.roughness.sigma
    if seat == "plane":
        case = case.replace(
            particles=case.particles.replace(diameter=tb.distributions.Monodisperse(mean=3e-7))
        )
        d = np.linspace(0.05, 0.15, 6) * 3e-7  # the squeeze of the end is 0.934
    got, want = own_columns(case, {}, "d", d), tb.solve(case, d=d).columns()
    assert not np.any(got["status"])
    for name in ("A_sa", "A_sa2", "F_sa_star"):
        np.testing.assert_allclose(got[name], want[name], rtol=1e-10, err_msg=name)


def test_areas_that_change_order_twice_between_kinks_cast_their_shadow():
    # at squeezes of 0.9434 and 0.9511, between kinks of one of the sides
    case = contact("deep").replace(
        surfaces=tb.MaterialPair(
            tb.Material(E=196698137306.0, nu=0.219223, H=4347886725.0), tb.Material(E=75242129568.0, nu=0.279017, H=542619517.0)
        ),
        particles=tb.Particles(
            material=tb.Material(E=25799455393.0, nu=0.344171, H=459986321.0), areal_density=1e9,
            diameter=tb.LogNormal(median=4.5756e-6, gsd=1.4),
        ),
    )  # fmt: skip
    sides = case.particle_law.one(surfaces=case.surfaces, particle=case.particles.material)
    fine = np.linspace(0.93, sides.kinks[-1], 20_001)
    first, second = (
        side.area(own) for side, own in zip(sides.sides, sides.indentations(fine), strict=True)
    )
    turns = fine[np.flatnonzero(np.diff(np.sign(first - second)))]
    assert len(turns) >= 2
    for turn in turns:
        assert np.min(np.abs(sides.kinks - turn)) < 1e-5
    d = np.array([1.6e-6, -1.4e-7])
    got, want = own_columns(case, {}, "d", d), tb.solve(case, d=d).columns()
    np.testing.assert_allclose(got["shadow"], want["shadow"], rtol=1e-10)


def test_wide_sizes_are_summed_to_the_end_of_the_table():
    # the last stretch of the table bends most: summed with few nodes it was 6e-9 of the area off
    case = contact("deep", "plane").replace(
        surfaces=tb.MaterialPair(
            tb.Material(E=120437731575.0, nu=0.1973, H=10360650666.0),
            tb.Material(E=66259395508.0, nu=0.3446, H=1428251779.0),
        ),
        particles=tb.Particles(
            material=tb.Material(E=99746204446.0, nu=0.2098, H=2338896855.0), areal_density=3.76e12,
            diameter=tb.LogNormal(median=72.9e-9, gsd=2.1029),
        ),
        particle_law=LAWS["deep"].replace(seat="plane", friction_factor=0.5),
    )  # fmt: skip
    d = np.array([0.25e-7, 1.6e-7])
    got, want = own_columns(case, {}, "d", d), tb.solve(case, d=d).columns()
    for name in ("A_sa", "A_sa2", "F_sa_star"):
        np.testing.assert_allclose(got[name], want[name], rtol=2e-11, err_msg=name)


@pytest.mark.parametrize("sizes", list(SIZES))
def test_a_plane_below_every_gap_is_solved(sizes):
    # asperities carry nearly all, and all particles are squeezed to their whole height
    case = contact("deep", "plane", sizes=sizes)
    scale = 0.05 if sizes == "gaussian" else 1.0
    dust = case.particles.diameter.scaled(scale)
    case = case.replace(particles=case.particles.replace(diameter=dust))
    d = np.array([-1.5, -0.5, -1e-6, 0.0, 1e-3]) * case.roughness.sigma
    got, want = own_columns(case, {}, "d", d), tb.solve(case, d=d).columns()
    assert not np.any(got["status"])
    for name in ("A_sa", "A_sa2", "F_sa_star", "shadow"):
        np.testing.assert_allclose(got[name], want[name], rtol=1e-9, err_msg=name)


def test_a_load_that_the_slow_path_carries_is_not_too_large_where_formulas_end():
    # nothing is known of soft grains on a plane in no gap: a load that is NaN bounds no load
    case = tb.Contact(
        surfaces=tb.MaterialPair(
            tb.Material(E=68e9, nu=0.16, H=3.1e9), tb.Material(E=256e9, nu=0.19, H=6e9)
        ),
        roughness=tb.Roughness(
            sigma=107e-9, R=86e-6, alpha=20.9, heights=tb.heights.ExponentialHeights()
        ),
        particles=tb.Particles(
            material=tb.Material(E=14.2e9, nu=0.44, H=369e6), areal_density=4.3e4,
            diameter=tb.LogNormal(median=77e-6, gsd=1.06), shape=tb.grains.Angular(roundness=0.13, angle=0.91),
        ),
        particle_law=SERIES(seat="offset", h_0=2.6e-7, shadow="none"),
    )  # fmt: skip
    loads = np.geomspace(1e-11, 2e-3, 6)
    vary = {"particles.areal_density": 4.3e4 * np.array([1.0, 0.1, 0.01, 0.01, 0.1, 1.0])}
    got, want = own_columns(case, vary, "F_star", loads), slow(case, vary, loads)
    assert np.all(np.isfinite(want["d"]))
    sure = got["doubt"] == ""
    assert sure.any()
    assert not got["status"][sure].any()
    np.testing.assert_allclose(got["d"][sure], want["d"][sure], rtol=1e-9)


STRENGTH = tb.grains.WeibullStrength(sigma_0=67e6, x_0=1e-3, m=3.0, size_exponent=0.55, x_c=50e-9)
BREAKING = {
    "plain": ("hermite", {}, {}),
    "gone": ("deep", {"fragments": "gone"}, {}),
    "finer": ("projected", {"fragments": "all", "ratio": 0.6}, {}),
    "brittle": ("deep", {"m": 8.0, "sigma_0": 40e6}, {}),
    "not confined": ("deep", {"confinement": "none"}, {}),
    "small ones too": ("hermite", {"x_c": 0.0, "size_exponent": 0.8}, {}),
    "wide": ("hermite", {}, {"diameter": tb.LogNormal(median=2.5e-7, gsd=1.3)}),
    "grit": ("hermite", {}, {"shape": GRIT["faces"]}),
    "from zero": ("deep", {}, {"diameter": tb.distributions.Uniform(low=0.0, high=6e-7)}),
}


def hold_breaking(kind, count, unlike, seed):
    law, strength, own = BREAKING[kind]
    case = contact(law)
    case = case.replace(
        particles=case.particles.replace(strength=STRENGTH.replace(**strength), **own)
    )
    vary, loads = drawn(case.replace(particles=contact().particles), count, seed, unlike)
    del vary["particles.material.nu"]
    if "diameter" in own:
        vary = {name: values for name, values in vary.items() if "diameter" not in name}
    sigma_0 = case.particles.strength.sigma_0
    vary["particles.strength.sigma_0"] = sigma_0 * np.linspace(0.6, 1.7, count)
    got, want = own_columns(case, vary, "F_star", loads), slow(case, vary, loads)
    sure = (got["doubt"] == "") & (got["status"] == 0)
    assert sure.mean() > 0.8
    assert max(largest_error(got, want, sure).values()) <= BOUND
    assert np.all(got["error"][sure] <= BOUND / 2)


def test_particles_that_break_hold_to_the_slow_path():
    hold_breaking("plain", 2, unlike=True, seed=7)


@pytest.mark.check
@pytest.mark.parametrize(
    ("kind", "unlike"),
    [
        *((kind, True) for kind in BREAKING),
        *((kind, False) for kind in ("plain", "gone", "finer", "grit")),  # fragments, shapes
    ],
)
def test_many_random_states_that_break(kind, unlike):
    hold_breaking(kind, 2, unlike, 9)


def test_particles_of_one_size_that_break_are_for_the_numpy_engine():
    case = contact(sizes="one size")
    strong = case.replace(particles=case.particles.replace(strength=STRENGTH))
    with pytest.raises(NotCompiled, match="break"):
        own_columns(strong, {"surfaces.first.H": STEEL.H * np.ones(4)}, "F_star", np.full(4, 1e-6))


CLASSES = {
    "bins": tb.distributions.Histogram(edges=(0.0, 3e-7, 5e-7, 8e-7), counts=(410, 0, 90)),
    "powers": PowerLaw(edges=(1e-7, 2e-7, 4e-7, 14e-7), counts=(9, 3, 1), slopes=(3.4, 2.0, -1)),
    "mixture": tb.distributions.Mixture(
        parts=(tb.distributions.Monodisperse(mean=3e-7), tb.LogNormal(median=2e-7, gsd=1.4)),
        weights=(1, 2),
    ),
}


@pytest.mark.spread(2)
@pytest.mark.parametrize(
    ("kind", "law", "seat"),
    [("bins", "hermite", "rough"), ("powers", "deep", "plane"), ("mixture", "hermite", "plane")],
)
def test_sizes_in_classes_hold_to_the_slow_path(kind, law, seat):
    case = contact(law, seat, "soft")
    dust = case.particles.replace(diameter=CLASSES[kind], areal_density=3e10)
    vary, loads = drawn(case, 4, 5, unlike=True)
    vary = {name: values for name, values in vary.items() if "diameter" not in name}
    case, vary["particles.areal_density"] = case.replace(particles=dust), np.full(4, 2e10)
    got, want = own_columns(case, vary, "F_star", loads), slow(case, vary, loads)
    sure = got["doubt"] == ""
    assert sure.sum() >= 3
    assert max(largest_error(got, want, sure).values()) <= BOUND


@pytest.mark.parametrize(("law", "seat"), [("hermite", "plane"), ("deep", "rough")])
def test_unlike_sides_hold_to_the_slow_path(law, seat):
    hold(contact(law, seat, "hard"), 2, 3, unlike=True)


@pytest.mark.parametrize(("sigma", "std"), [(8e-9, 0.25), (8e-9, 0.02), (1e-6, 0.1)])
@pytest.mark.parametrize("body", BODIES)
def test_seats_that_are_narrow_or_wide(sigma, std, body):
    case = contact(body=body)
    vary = {
        "roughness.sigma": np.array([0.9, 1.1]) * sigma,
        "particles.diameter.std": np.array([1.0, 1.1]) * std * 300e-9,
    }
    loads = np.array([1e-6, 3e-5])
    got, want = own_columns(case, vary, "F_star", loads), slow(case, vary, loads)
    sure = got["doubt"] == ""
    assert sure.all()
    assert max(largest_error(got, want, sure).values()) <= BOUND


@pytest.mark.spread(3)
@pytest.mark.parametrize(
    ("median", "gsd"), [(1e-7, 1.2), (1e-7, 1.5), (1e-7, 2.0), (4e-7, 1.2), (4e-7, 1.5)]
)
def test_wide_sizes_on_a_rough_seat(median, gsd):
    """Sizes lie as close as the gap shows them: less closely the more they are squeezed."""
    case = contact("deep", "rough", "soft")
    dust = case.particles.replace(
        diameter=tb.LogNormal(median=median, gsd=gsd), areal_density=3e-4 / median**2
    )
    vary, loads = drawn(case, 4, 8, unlike=gsd == 1.5)
    vary = {n: v for n, v in vary.items() if "diameter" not in n and "density" not in n}
    case = case.replace(particles=dust)
    got, want = own_columns(case, vary, "F_star", loads), slow(case, vary, loads)
    sure = got["doubt"] == ""
    assert sure.all()
    assert max(largest_error(got, want, sure).values()) <= BOUND


def test_dust_much_thicker_than_the_roughness_stays_with_the_engine():
    """Few large grains carry: finer nodes have no room, and the first ones are good to 2e-10."""
    bronze, count = tb.materials["CuSn8"], 3
    case = tb.Contact(
        surfaces=tb.MaterialPair(bronze, bronze),
        roughness=tb.Roughness(sigma=300e-9, R=10e-6),
        particles=tb.Particles(
            material=tb.materials["quartz"],
            diameter=tb.LogNormal(median=8e-6, gsd=1.5),
            areal_density=1e5,
        ),
    )
    vary = {"surfaces.first.E": bronze.E * np.linspace(0.95, 1.05, count)}
    loads = np.full(count, 1e-8)
    got, want = own_columns(case, vary, "F_star", loads), slow(case, vary, loads)
    assert np.all(got["doubt"] == "")
    assert np.any(got["error"] > 1e-10)
    for i in range(count):
        one = np.arange(count) == i
        assert max(largest_error(got, want, one).values()) <= got["error"][i] + ROUNDED


def test_the_largest_of_log_normal_sizes_are_seen_where_they_end():
    """Far above the median few sizes are left, and end within the panels of a usual state.

    Gauss rules over gaps and squeezes agree with the slow path there (5e-11 of the load).
    """
    dust = tb.LogNormal(median=10e-6, gsd=1.15)
    particles = tb.Particles(
        material=tb.materials["SiO2"], diameter=dust, areal_density=1.2 / (np.pi * dust.moment(2))
    )
    case = contact().replace(
        particles=particles,
        particle_law=tb.particle.Series(deep="off"),
        roughness=tb.Roughness(sigma=1e-7, R=2.8e-6),
    )
    loads = np.geomspace(1e-12, 1e-4, 24)
    vary = {"particles.material.E": particles.material.E * (1 + 1e-14 * np.arange(24))}
    got = own_columns(case, vary, "F_star", loads)
    want = tb.solve(case, F_star=loads)
    sigma = case.roughness.sigma
    error = np.abs(got["d"] - want.d) / np.maximum(sigma, np.abs(want.d))
    assert np.all(error < 1e-12 + 10 * got["error"])
    np.testing.assert_allclose(got["A_t"], want.A_t, rtol=1e-10)


@pytest.mark.parametrize("seat", SEATS)
def test_other_sizes_and_flakes(seat):
    case = contact(seat=seat)
    loads, turn = np.array([1e-7, 3e-5]), np.array([0.9, 1.1])
    for particles, law, vary in (
        (tb.LogNormal(median=250e-9, gsd=1.3), {}, {"particles.diameter.gsd": 1.3 * turn}),
        (
            tb.distributions.Uniform(low=1e-7, high=4e-7),
            {},
            {"particles.diameter.high": 4e-7 * turn},
        ),
        (SIZES["gaussian"], {"aspect": 2.0}, {"particle_law.aspect": 2.0 * turn}),
    ):
        own = tb.particle.Flakes(seat=seat, **law) if law else case.particle_law
        every = case.replace(particles=case.particles.replace(diameter=particles), particle_law=own)
        got, want = own_columns(every, vary, "F_star", loads), slow(every, vary, loads)
        sure = got["doubt"] == ""
        assert sure.all(), got["doubt"]
        assert max(largest_error(got, want, sure).values()) <= BOUND


PRINTED = {
    "as it falls": dict(preset="published"),
    "one window": dict(preset="window", datum=0.5),
    "by its approach": dict(preset="literal", particle_regime="split", normalise=True),
    "by x(x - d)": dict(plastic_weight="xxd", shadow="xmin"),
    "by the mean": dict(weight="xa2", hardness_rule="replace2", second_modulus="sa"),
}


@pytest.mark.parametrize("reading", PRINTED)
@pytest.mark.parametrize("sizes", ["gaussian", "lognormal", "uniform"])
def test_printed_integrals_hold_to_the_slow_path(reading, sizes):
    case = contact().replace(particle_law=tb.particle.Horng2022(**PRINTED[reading]))
    kind = {
        "gaussian": SIZES["gaussian"],
        "lognormal": tb.LogNormal(median=3e-7, gsd=1.3),
        "uniform": tb.distributions.Uniform(low=1e-7, high=4e-7),
    }[sizes]
    base = case.replace(particles=case.particles.replace(diameter=kind))
    vary, loads = drawn(case, 6, 8, unlike=True)
    if sizes != "gaussian":
        vary = {name: values for name, values in vary.items() if "diameter" not in name}
    vary["particle_law.chi"] = np.linspace(0.01, 0.5, 6)
    got, want = own_columns(base, vary, "F_star", loads), slow(base, vary, loads)
    sure = got["doubt"] == ""
    assert sure.all(), got["doubt"]
    assert np.array_equal(got["status"] == 0, np.isfinite(want["d"]))
    assert max(largest_error(got, want, np.isfinite(want["d"])).values()) <= BOUND
    np.testing.assert_allclose(got["h"] - got["d"], want["h"] - want["d"], rtol=1e-9)


def test_the_highest_of_several_separations_is_found():
    """A window of narrow sizes: the load rises and falls, and three separations carry some."""
    case = contact().replace(particle_law=tb.particle.Horng2022(preset="window", chi=1.0))
    dust = tb.TruncatedGaussian(mean=3e-7, std=6e-9, n=3.0)
    case = case.replace(particles=case.particles.replace(diameter=dust))
    loads = np.geomspace(1e-6, 1e-3, 60)
    several = [len(tb.equilibria.roots(case, F_star=x)) > 1 for x in loads]
    assert 3 < sum(several) < 57
    vary = {"roughness.alpha": np.full(60, case.roughness.alpha)}
    got, want = own_columns(case, vary, "F_star", loads), slow(case, vary, loads)
    sure = got["doubt"] == ""
    assert sure.mean() > 0.9
    assert max(largest_error(got, want, sure & np.isfinite(want["d"])).values()) <= BOUND


def test_populations_side_by_side_hold_to_the_slow_path():
    case = contact()
    wear = case.particles.replace(material=tb.Material(E=190e9, nu=0.3, H=1e9), areal_density=5e10)
    both = case.replace(particles=(case.particles, wear))
    vary = {"surfaces.first.H": STEEL.H * np.array([0.9, 1.1])}
    loads = np.array([1e-6, 5e-5])
    got, want = own_columns(both, vary, "F_star", loads), slow(both, vary, loads)
    assert max(largest_error(got, want, np.ones(2, bool)).values()) <= BOUND


def test_inputs_of_one_population_of_several_are_compiled():
    case = contact()
    wear = case.particles.replace(material=tb.Material(E=190e9, nu=0.3, H=1e9), areal_density=5e10)
    both, turn = case.replace(particles=(case.particles, wear)), np.linspace(0.9, 1.1, 20)
    vary = {"particles.0.areal_density": 2e10 * turn, "particles.1.diameter.mean": 3e-7 * turn}
    loads = np.geomspace(1e-6, 5e-5, 20)
    got = state_columns(both, F_star=loads, vary=vary)
    assert set(got["engine"]) == {"compiled"}
    some = np.array([0, 19])
    want = slow(both, {name: values[some] for name, values in vary.items()}, loads[some])
    got = {name: values[some] for name, values in got.items()}
    assert max(largest_error(got, want, np.ones(2, bool)).values()) <= BOUND


def test_the_engine_is_asked_what_is_slow():
    sizes, body = "particles.diameter.mean", "particles.material.H"
    deep, grit = contact("deep", "plane", "soft"), tb.grains.Angular(roundness=0.25, angle=0.6)
    angular = deep.replace(particles=deep.particles.replace(shape=grit))
    both = deep.replace(particles=(deep.particles, contact().particles))
    assert not tables_each(deep, [sizes, body, "pressure"])
    assert not tables_each(both, ["particles.1.diameter.mean", "surfaces.first.H"])
    assert not tables_each(angular, [sizes])
    strong = deep.particles.replace(
        strength=tb.grains.WeibullStrength(
            sigma_0=67e6, x_0=1e-3, m=3.0, size_exponent=0.55, x_c=50e-9
        )
    )
    breaks = deep.replace(particles=strong)
    assert tables_each(breaks, [sizes])
    assert not tables_each(breaks, ["roughness.sigma"])
    with mock.patch.dict(os.environ, THIRDBODY_ENGINE="numpy"):
        assert tables_each(deep, [sizes])
        assert tables_each(both, ["particles.1.diameter.mean"])


def test_asperity_laws_by_numbers_of_their_own():
    case = contact().replace(particles=None)
    loads, turn = np.geomspace(1e-8, 1e-4, 4), np.linspace(0.95, 1.05, 4)
    for law, own in (
        (tb.asperity.ZMC(), {"k": 0.4 * turn, "rho": 54 * turn}),
        (tb.asperity.Hermite(), {"k": 0.4 * turn}),
        (tb.asperity.KE(), {"K": 0.6 * turn}),
        (tb.asperity.CEB(), {"K": 0.6 * turn}),
        (tb.asperity.JG(), {"hardness_ratio": 2.8 * turn}),
        (tb.asperity.EllipticZMC(ratio=2.0), {"k": 0.4 * turn}),
        (tb.asperity.EllipticZMC(ratio=9.0, area_rule="doubling"), {"ratio": 9.0 * turn}),
        (tb.asperity.EllipticCEB(ratio=1.06), {"ratio": np.array([1.0, 1.001, 1.06, 40.0])}),
        (tb.asperity.GW(), {}),
    ):
        bare = case.replace(asperity_law=law.replace(K=0.6) if "K" in own else law)
        vary = {f"asperity_law.{name}": values for name, values in own.items()}
        vary["surfaces.first.H"] = STEEL.H * turn
        got, want = own_columns(bare, vary, "F_star", loads), slow(bare, vary, loads)
        assert set(got["doubt"]) == {""}
        assert max(largest_error(got, want, np.ones(4, bool)).values()) <= BOUND, law.name


ATTRACTING = {
    "jkr": tb.asperity.JKR(w=0.05),
    "jkr, unloading": tb.asperity.JKR(w=0.05, unloading=True),
    "dmt": tb.asperity.DMT(w=0.05),
}


@pytest.mark.parametrize("heights", ["gaussian", "weibull"])
@pytest.mark.parametrize("law", ATTRACTING)
def test_asperities_that_attract_hold_to_the_slow_path(law, heights):
    """Up to where they pull more than they push, and at given separations beyond."""
    bare = contact().replace(particles=None, asperity_law=ATTRACTING[law])
    if heights == "weibull":
        bare = bare.replace(**{"roughness.heights": HEIGHTS["weibull"]})
    turn = np.array([0.1, 0.7, 1.0, 1.5, 4.0])
    vary = {"surfaces.first.E": STEEL.E * turn, "asperity_law.w": 0.05 / turn}
    loads = np.geomspace(1e-11, 1e-4, 5)
    got, want = own_columns(bare, vary, "F_star", loads), slow(bare, vary, loads)
    assert set(got["doubt"]) == {""}
    assert max(largest_error(got, want, np.ones(5, bool)).values()) <= BOUND
    assert np.all(got["error"] <= 1e-10)
    d = np.array([-1.0, 0.5, 2.0, 3.0, 3.5]) * 2e-9
    vary["asperity_law.w"], vary["roughness.sigma"] = 0.5 / turn, np.full(5, 2e-9)
    got = own_columns(bare, vary, "d", d)
    with mock.patch.dict(os.environ, THIRDBODY_ENGINE="numpy"):
        want = state_columns(bare, d=d, vary=vary)
    assert set(got["doubt"]) == {""}
    assert heights == "weibull" or got["F_star"].min() < 0
    for name in ("F_star", "A_e"):
        np.testing.assert_allclose(got[name], want[name], rtol=1e-9, atol=1e-25)


@pytest.mark.parametrize("law", ATTRACTING)
def test_particles_between_asperities_that_attract_are_known_where_those_push(law):
    """Where they pull, the load may rise with the separation: that is for the scan of the load."""
    case = contact().replace(asperity_law=ATTRACTING[law])
    vary = {"surfaces.first.E": STEEL.E * np.linspace(0.8, 1.2, 6)}
    loads = np.geomspace(1e-8, 1e-3, 6)
    got, want = own_columns(case, vary, "F_star", loads), slow(case, vary, loads)
    sure = got["doubt"] == ""
    assert sure[-1]
    assert max(largest_error(got, want, sure).values()) <= BOUND
    assert not np.any(sure[want["F_ss_star"] < 0])


@pytest.mark.check
@pytest.mark.parametrize("indenter", [None, 70e9])
def test_coated_asperities_hold_to_the_slow_path(indenter):
    law = tb.asperity.Coated(E_1=3e11, nu_1=0.25, t=50e-9, E_3=indenter)
    bare = contact().replace(particles=None, asperity_law=law)
    vary = {
        "asperity_law.t": np.geomspace(1e-9, 3e-6, 6),  # beyond the table, and much thicker
        "surfaces.first.H": STEEL.H * np.linspace(0.5, 1.5, 6),
    }
    loads = np.geomspace(1e-8, 1e-4, 6)
    got, want = own_columns(bare, vary, "F_star", loads), slow(bare, vary, loads)
    assert set(got["doubt"]) == {""}
    assert max(largest_error(got, want, np.ones(6, bool)).values()) <= BOUND
    with pytest.raises(NotCompiled, match="coating"):
        own_columns(bare, {"asperity_law.E_1": 3e11 * np.ones(6)}, "F_star", loads)


def test_contacts_wider_than_the_table_of_a_coating_are_for_the_numpy_engine():
    law = tb.asperity.Coated(E_1=400e9, nu_1=0.3, t=5e-9, E_2=2e9, nu_2=0.3)
    case = contact().replace(particles=None, asperity_law=law)
    radii = np.array([1e-6, 50e-6])
    own_columns(case, {"roughness.R": radii[:1]}, "F_star", np.array([1e-5]))
    with pytest.raises(NotCompiled):
        own_columns(case, {"roughness.R": radii}, "F_star", np.full(2, 1e-5))


@pytest.mark.parametrize("heights", ["gaussian", "exponential"])
def test_asperities_of_several_shapes_hold_to_the_slow_path(heights):
    shapes = tb.surfaces.Ellipticity(
        ratios=(1.0, 2.0, 9.0), weights=(3, 2, 1), radii=(1.0, 0.7, 1.9)
    )
    rough = contact().roughness.replace(ellipticity=shapes)
    if heights == "exponential":
        rough = rough.replace(heights=HEIGHTS["exponential"])
    turn, loads = np.linspace(0.8, 1.2, 4), np.geomspace(1e-8, 1e-4, 4)
    for law in (tb.asperity.EllipticCEB(), tb.asperity.EllipticZMC()):
        case = contact("hermite").replace(roughness=rough, asperity_law=law)
        vary = {"roughness.sigma": 1e-7 * turn, "surfaces.first.H": STEEL.H * turn}
        for every in (case, case.replace(particles=None)):
            got, want = own_columns(every, vary, "F_star", loads), slow(every, vary, loads)
            assert set(got["doubt"]) == {""}
            assert max(largest_error(got, want, np.ones(4, bool)).values()) <= BOUND


HEIGHTS = {
    "exponential": tb.heights.ExponentialHeights(),
    "weibull": tb.heights.WeibullHeights(shape=1.3),
    "narrow": tb.heights.WeibullHeights(shape=8.0),
}


@pytest.mark.parametrize("kind", HEIGHTS)
def test_other_heights_hold_to_the_slow_path(kind):
    """From light loads to separations below the lowest asperity, alone and with particles."""
    base = contact("hermite", "plane", "hard")
    case = base.replace(roughness=base.roughness.replace(heights=HEIGHTS[kind]))
    bare, turn = case.replace(particles=None), np.linspace(0.95, 1.05, 4)
    vary = {"surfaces.first.H": STEEL.H * turn}
    loads = np.geomspace(1e-9, 1e-4, 4)
    for every in (bare, case):
        got, want = own_columns(every, vary, "F_star", loads), slow(every, vary, loads)
        assert set(got["doubt"]) == {""}
        assert max(largest_error(got, want, np.ones(4, bool)).values()) <= BOUND
    d = np.array([-4.5, -1.05, -0.95, 0.5]) * 100e-9
    got = own_columns(bare, vary, "d", d)
    with mock.patch.dict(os.environ, THIRDBODY_ENGINE="numpy"):
        want = state_columns(bare, d=d, vary=vary)
    assert set(got["doubt"]) == {""}
    for name in ("F_star", "A_e", "A_ep", "A_p"):
        np.testing.assert_allclose(got[name], want[name], rtol=1e-9, atol=1e-9 * want["A_t"][3])


def test_laws_beyond_what_was_shown_are_for_the_numpy_engine():
    bare = contact().replace(particles=None, asperity_law=tb.asperity.JG(hardness_ratio=0.4))
    with pytest.raises(NotCompiled, match="jg"):
        own_columns(bare, {"surfaces.first.H": STEEL.H * np.ones(4)}, "F_star", np.full(4, 1e-6))
    falls = contact("ke").replace(**{"particle_law.law": tb.asperity.KE(K=0.65)})
    with pytest.raises(NotCompiled, match="ke"):
        own_columns(falls, {"surfaces.first.H": STEEL.H * np.ones(4)}, "F_star", np.full(4, 1e-6))


@pytest.mark.spread(4)
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("law", ["hermite", "deep"])
def test_loads_that_asperities_carry_are_its_own_on_a_rough_seat(law, body):
    """Few particles shade too little for the load to rise again: NumPy need not look.

    That it falls is checked by the scan of the load over all separations.
    """
    count = 4
    case = contact(law, "rough", body)
    rng = np.random.default_rng(11)
    vary = {
        "surfaces.first.H": STEEL.H * rng.uniform(0.8, 1.2, count),
        "roughness.sigma": 100e-9 * rng.uniform(0.85, 1.15, count),
    }
    loads = np.full(count, 1e-2)  # the asperities carry a fifth of the hardness
    got, want = own_columns(case, vary, "F_star", loads), slow(case, vary, loads)
    assert NOT_MONOTONE not in set(got["doubt"])
    solved = got["status"] == 0
    assert solved.mean() > 0.8
    assert max(largest_error(got, want, solved).values()) <= BOUND
    for i in range(0, count, 2):
        one = case.replace(**{name: float(values[i]) for name, values in vary.items()})
        assert load_scan(interface(one)).monotone


def test_a_crowd_on_a_rough_seat_is_left_to_the_scan_of_the_load():
    """Where the shadow of many particles could outrun the asperities, nothing is claimed."""
    crowd = {
        "particles.areal_density": 5e12,
        "particle_law.zeta_std": 0.05,
        "particle_law.zeta_mean": -3.0,
    }
    case = contact("hermite").replace(**crowd)
    vary = {"surfaces.first.H": STEEL.H * np.linspace(0.9, 1.1, 4)}
    got = own_columns(case, vary, "F_star", np.full(4, 1e-2))
    assert set(got["doubt"]) == {NOT_MONOTONE}


@pytest.mark.parametrize("seat", SEATS)
def test_company_order_and_threads_change_no_bit(seat):
    case = contact("hermite", seat, "soft")
    vary, loads = drawn(case, 600, 4, unlike=False)
    # neighbours of one contact share what is laid for it, which others do not
    vary = {name: np.repeat(values[::3], 3) for name, values in vary.items()}
    whole = own_columns(case, vary, "F_star", loads)
    order = np.random.default_rng(5).permutation(600)
    mixed = {name: values[order] for name, values in vary.items()}
    other = own_columns(case, mixed, "F_star", loads[order], threads=2)
    one = {name: values[7:8] for name, values in vary.items()}
    alone = own_columns(case, one, "F_star", loads[7:8])
    for name in COLUMNS:
        if name not in ("mode", "status"):
            np.testing.assert_array_equal(whole[name][order], other[name], name)
            np.testing.assert_array_equal(whole[name][7:8], alone[name], name)


ASPERITIES = {
    "jkr": tb.asperity.JKR(w=0.05),
    "dmt": tb.asperity.DMT(w=0.05),
    "coated": tb.asperity.Coated(E_1=3e11, nu_1=0.25, t=50e-9),
    "elliptic": tb.asperity.EllipticZMC(ratio=2.0),
    "shapes": tb.asperity.EllipticCEB(),
}


@pytest.mark.parametrize("law", ASPERITIES)
def test_company_order_and_threads_change_no_bit_of_asperities(law):
    case = contact().replace(particles=None, asperity_law=ASPERITIES[law])
    if law == "shapes":
        shapes = tb.surfaces.Ellipticity(ratios=(1.0, 3.0))
        case = case.replace(**{"roughness.ellipticity": shapes})
    count, rng = 520, np.random.default_rng(6)  # more than one thread is handed at a time
    vary = {
        "roughness.sigma": 1e-7 * np.repeat(rng.uniform(0.5, 2, count // 4), 4),
        "surfaces.first.H": STEEL.H * np.repeat(rng.uniform(0.5, 2, count // 4), 4),
    }
    loads, order = 10.0 ** rng.uniform(-7, -4, count), rng.permutation(count)
    whole = own_columns(case, vary, "F_star", loads)
    mixed = {name: values[order] for name, values in vary.items()}
    other = own_columns(case, mixed, "F_star", loads[order], threads=2)
    alone = own_columns(case, {k: v[7:8] for k, v in vary.items()}, "F_star", loads[7:8])
    for name in ("d", "F_ss_star", "A_e", "A_ep", "A_p", "A_t"):
        np.testing.assert_array_equal(whole[name][order], other[name], name)
        np.testing.assert_array_equal(whole[name][7:8], alone[name], name)


def test_given_separations_give_the_load():
    case = contact("hermite", "plane", "soft")
    vary, loads = drawn(case, 40, 6, unlike=False)
    found = own_columns(case, vary, "F_star", loads)
    again = own_columns(case, vary, "d", found["d"])
    sure = found["doubt"] == ""
    np.testing.assert_allclose(again["F_star"][sure], loads[sure], rtol=1e-10)


def test_the_slow_rows_are_told_of_as_compiled():
    case = contact("hermite", "plane", "soft")
    vary, loads = drawn(case, 30, 7, unlike=True)
    got = state_columns(case, F_star=loads, vary=vary)
    assert np.mean(got["engine"] == "compiled") > 0.8
    assert all(each == "compiled" or each.startswith("numpy: ") for each in got["engine"])


@pytest.mark.check
@pytest.mark.parametrize("unlike", [False, True])
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("law", [name for name in JUMPING if name != "ceb"])
def test_many_random_states_of_loads_that_jump(law, body, unlike):
    hold(contact(law, "rough", body), 4, 8, unlike)


@pytest.mark.check
@pytest.mark.parametrize(
    ("law", "seat", "body", "sizes", "unlike"),
    [
        case
        # of the last four any three in all their combinations, which is every second case
        for law, *ways in product(LAWS, *(enumerate(each) for each in (SEATS, BODIES, SIZES)))
        for case in [(law, *(name for _, name in ways), sum(place for place, _ in ways) % 2 == 1)]
        # a shadow that jumps at one size: the load may rise, which is for the NumPy engine
        if not (case[0] == "projected" and case[1] == "plane" and case[3] == "one size")
    ],
)
def test_many_random_states(law, seat, body, sizes, unlike):
    hold(contact(law, seat, body, sizes), 3, 8, unlike)


@pytest.mark.slow
def test_laws_of_the_kernel_are_the_laws():
    """Load and area on every branch, by the kernel and by the objects that NumPy asks."""
    from numba import njit

    from thirdbody.equilibrium.engine import fields, sides
    from thirdbody.equilibrium.engine.columns import _law

    @njit
    def at(rows, y, out):
        for j in range(len(y)):
            out[j] = sides.law_at(rows, 0, y[j])

    a = tb.asperity
    y = np.geomspace(1e-3, 400.0, 200)
    laws = (
        a.GW(),
        a.ZMC(),
        a.Hermite(),
        a.CEB(),
        a.KE(),
        a.JG(),
        a.EllipticZMC(ratio=3.0),
        a.DMT(),
    )
    for law in laws:
        rows, tip = np.zeros((1, fields.OF_SIDE)), {"R": 1e-6, "H": 5e9}
        numbers, omega_1 = _law(type(law), law, tip["R"], 1.1e11, tip["H"], 0.3)
        rows[0, : len(numbers)] = numbers
        bound = law.bound(E_star=1.1e11, nu=0.3, **tip)
        assert omega_1 == pytest.approx(bound.yield_interference(E_star=1.1e11, **tip), rel=1e-14)
        out = np.empty((len(y), 2))
        at(rows, y, out)
        for column, name in enumerate(("force", "area")):
            np.testing.assert_allclose(out[:, column], bound.reduced(name, y), rtol=1e-13)


@pytest.mark.parametrize("kind", ["jump", "breaking", "heights"])
def test_company_and_order_change_no_bit_of_what_is_laid_once_a_state(kind):
    case = contact("ke", "rough", "hard")
    if kind == "breaking":
        case = contact("hermite").replace(**{"particles.strength": STRENGTH})
    if kind == "heights":
        case = case.replace(**{"roughness.heights": HEIGHTS["weibull"]})
    vary, loads = drawn(case, 9, 4, unlike=True)
    if kind == "breaking":
        del vary["particles.material.nu"]
    vary["surfaces.first.E"][::3], vary["surfaces.first.H"][::3] = STEEL.E, STEEL.H
    whole = own_columns(case, vary, "F_star", loads)
    mixed = {name: values[::-1] for name, values in vary.items()}
    other = own_columns(case, mixed, "F_star", loads[::-1])
    alone = own_columns(case, {k: v[4:5] for k, v in vary.items()}, "F_star", loads[4:5])
    for name in ("d", "F_sa_star", "A_e", "A_ep", "A_p", "A_sa2", "A_t"):
        np.testing.assert_array_equal(whole[name][::-1], other[name], name)
        np.testing.assert_array_equal(whole[name][4:5], alone[name], name)


@pytest.mark.parametrize("unlike", [False, True])
@pytest.mark.parametrize("seat", SEATS)
@pytest.mark.parametrize(
    "sizes",
    [
        SIZES["gaussian"],
        tb.LogNormal(median=300e-9, gsd=1.4),
        tb.LogNormal(median=3e-6, gsd=1.5),
        PowerLaw(edges=(4e-6, 6e-6, 14e-6, 70e-6), counts=(5.0, 1.5, 0.2), slopes=(3.4, 2.4, 3.3)),
        PowerLaw(
            edges=(2e-7, 2.3e-7, 3e-7, 5e-7), counts=(5.0, 3.0, 1.0), slopes=(0.5, 1.5, 3.0)
        ),
    ],
    ids=["gaussian", "log-normal", "thick", "powers", "narrow powers"],
)  # fmt: skip
def test_samples_hold_to_states_solved_by_themselves(sizes, seat, unlike):
    """Samples are solved with fewer nodes, and again with all where these do not do."""
    case = contact("deep", seat)
    density = 5e-3 / float(sizes.mean_diameter) ** 2
    dust = case.particles.replace(diameter=sizes, areal_density=density)
    case = case.replace(particles=dust)
    rng = np.random.default_rng(3)
    count = 24
    vary = {
        "particles.material.E": 72e9 * rng.uniform(0.7, 1.4, count),
        "particles.material.H": 10.0 ** rng.uniform(9.2, 10.2, count),
        "roughness.R": 2.8e-6 * rng.uniform(0.5, 2.0, count),
    }
    if unlike:
        vary["surfaces.first.H"] = 6e9 * rng.uniform(0.4, 1.2, count)
    loads = 10.0 ** rng.uniform(-7, -3, count)
    want = own_columns(case, vary, "F_star", loads)
    with roughly():
        got = own_columns(case, vary, "F_star", loads)
    sure = (got["doubt"] == "") & (want["doubt"] == "") & (got["status"] == 0)
    assert np.all(got["status"][want["status"] == 0] == 0)
    assert sure.sum() > 6
    for i in np.flatnonzero(sure):
        off = largest_error(got, want, np.arange(count) == i)
        off["d_star"] /= max(1.0, 0.1 * abs(want["d_star"][i]))  # as the engine measures it
        assert max(off.values()) <= got["error"][i] + want["error"][i] <= 1.1e-6
