"""Particles at any squeeze and any hardness ratio: the law that follows a computed table."""

import hashlib
import itertools
import json
import math
from importlib import resources

import numpy as np
import pytest
from numpy.polynomial.chebyshev import chebval

import thirdbody as tb
from thirdbody.laws.particle import Series
from thirdbody.laws.particle.deep import (
    LAW_ENDS,
    TABLE_BEGINS,
    TABLE_ENDS,
    DeepSqueeze,
    curve_rows,
    place_of,
    squeeze_curve,
)

E, NU, H = 206e9, 0.3, 5e9
STEEL = tb.Material(E=E, nu=NU, H=H)
PAIR = tb.MaterialPair(STEEL, STEEL)
DEEP = Series(deep="table")
RNG = np.random.default_rng(5)


def particle_of(ratio):
    return tb.Material(E=E, nu=NU, H=ratio * H)


def single(eps, ratio, surfaces=PAIR, particle=None, **options):
    law = Series(**({"deep": "table"} | options))
    particle = particle or particle_of(ratio)
    return law.single(1.0, 1 - np.asarray(eps), surfaces=surfaces, particle=particle)


def load(eps, ratio, **options):
    """F/(Y_s R²)."""
    return 4 * 2.84 / H * single(eps, ratio, **options)["force"]


def side(ratio, m=0.2, kappa=30.0):
    E_star = kappa * H * min(ratio, 1.0)
    return DeepSqueeze(ratio, m).side(tb.asperity.Hermite(), E_star, H * min(ratio, 1.0), NU, 0.5)


SQUEEZES = np.geomspace(1e-4, 1.0, 3000)


# ---------------------------------------------------------------------------- exact
def test_small_squeezes_follow_the_law_of_one_contact():
    eps = np.geomspace(1e-6, LAW_ENDS, 40)
    for ratio in (0.4, 1.0, 3.0):
        old = single(eps, ratio, deep="off", soft="sphere")
        new = single(eps, ratio)
        for name in ("force", "area_1", "area_2"):
            np.testing.assert_allclose(new[name], old[name], rtol=1e-12)


def test_a_law_that_never_yields_keeps_its_own_response():
    eps = np.array([0.02, 0.3, 0.7])
    for ratio in (0.5, 2.0):
        old, new = (single(eps, ratio, law=tb.asperity.GW(), deep=it) for it in ("off", "table"))
        np.testing.assert_array_equal(old["force"], new["force"])


@pytest.mark.parametrize("ratio", [0.3, 1.0, 2.6])
def test_loads_change_with_the_unit_of_stress(ratio):
    eps = np.array([0.02, 0.1, 0.4, 0.9])
    soft = tb.Material(E=E / 7, nu=NU, H=H / 7)
    other = single(
        eps,
        ratio,
        surfaces=tb.MaterialPair(soft, soft),
        particle=tb.Material(E=E / 7, nu=NU, H=ratio * H / 7),
    )
    one = single(eps, ratio)
    np.testing.assert_allclose(7 * other["force"], one["force"], rtol=1e-12)
    np.testing.assert_allclose(other["area_1"], one["area_1"], rtol=1e-12)


def test_surfaces_may_change_places():
    soft = tb.Material(E=120e9, nu=0.34, H=2e9)
    eps = np.linspace(0.01, 0.99, 60)
    one = single(eps, 0.8, surfaces=tb.MaterialPair(STEEL, soft))
    two = single(eps, 0.8, surfaces=tb.MaterialPair(soft, STEEL))
    np.testing.assert_allclose(one["force"], two["force"], rtol=1e-9)
    np.testing.assert_allclose(one["delta_1"], two["delta_2"], rtol=1e-7)


def test_a_soft_particle_carries_in_proportion_to_its_hardness():
    """ρ → 0: hard surfaces only know the particle's yield strength, at one E*/H."""
    curves = [squeeze_curve(ratio, 0.2, 30.0) for ratio in (0.05, 0.2, 0.39)]
    for curve in curves[1:]:
        np.testing.assert_array_equal(curve.log_load, curves[0].log_load)


def test_the_volume_of_half_a_sphere_bounds_a_disc():
    for m in (0.05, 0.2, 1.0):
        one = side(0.2, m)
        eps = np.linspace(TABLE_BEGINS, 0.999 * one.end, 500)
        area = one.area(0.5 * eps) / (math.pi * 0.25)
        assert np.all(area * (1 - eps) <= 2 / 3 * 1.04)


# ---------------------------------------------------------------------------- what was computed
def test_series_are_those_of_the_table():
    data = resources.files("thirdbody").joinpath("data")
    table = data.joinpath("deep_squeeze.json").read_bytes()
    series = json.loads(data.joinpath("deep_series.json").read_text("utf-8"))
    assert series["sha256"] == hashlib.sha256(table).hexdigest()


@pytest.mark.parametrize("m", [0.0, 0.2, 1.0])
def test_rigid_plastic_sides_follow_the_computed_curves(m):
    table = json.loads(
        resources.files("thirdbody").joinpath("data/deep_squeeze.json").read_text("utf-8")
    )
    eps, compared = np.array(table["eps"]), 0
    for curve in table["curves"]:
        ratio = float(curve["rho"])
        if (curve["m"], curve["E_over_Y"], curve["surfaces"]) != (m, "inf", 2) or ratio == 0.5:
            continue
        reached = (eps >= TABLE_BEGINS) & np.array([value is not None for value in curve["F"]])
        load, area, collar = (
            np.array(curve[name], dtype=float)[reached] for name in ("F", "A", "collar")
        )
        own = np.maximum.accumulate(load * (1 - collar)) / (min(ratio, 1) or 1)
        one = squeeze_curve(min(max(ratio, 0.4), 10.0), m, 1e12)
        place = place_of(eps[reached], LAW_ENDS, TABLE_ENDS)
        np.testing.assert_allclose(
            np.exp(chebval(place, one.log_load)) * np.pi * 2.84, own, rtol=0.05
        )
        np.testing.assert_allclose(np.exp(chebval(place, one.log_area)), area, rtol=0.06)
        compared += 1
    assert compared >= 7


@pytest.mark.parametrize(
    ("ratio", "m", "loads"),
    [
        (50.0, 1.0, {0.2: 4.49, 0.3: 6.36, 0.5: 9.10}),
        (1.0, 1.0, {0.2: 2.05, 0.5: 4.18}),
        (1.4, 1.0, {0.2: 2.89, 0.5: 5.86}),
        (2.0, 1.0, {0.2: 4.32, 0.5: 8.53}),
        (3.0, 1.0, {0.2: 4.56, 0.5: 9.43}),
        (50.0, 0.0, {0.2: 3.8, 0.5: 6.7}),
    ],
)
def test_rigid_plastic_loads_against_another_computation(ratio, m, loads):
    """F/(Y_s R²) of a second program (triangles, remeshed), which shares no line with ours."""
    curve = squeeze_curve(ratio, m, 1e12)
    for eps, expected in loads.items():
        place = place_of(np.array(eps), LAW_ENDS, TABLE_ENDS)
        load = np.exp(chebval(place, curve.log_load)) * np.pi * 2.84
        assert float(load) == pytest.approx(expected, rel=0.07)


# ---------------------------------------------------------------------------- between the runs
def test_loads_rise_at_any_hardness_friction_and_stiffness():
    for _ in range(150):
        ratio, m, kappa = (
            math.exp(RNG.uniform(math.log(low), math.log(high)))
            for low, high in ((0.05, 20), (0.02, 1), (6, 300))
        )
        one = side(ratio, m, kappa)
        assert np.all(np.diff(one.force(0.5 * SQUEEZES)) >= -1e-12 * one.limit), (ratio, m, kappa)


def test_no_hardness_is_a_cliff():
    """One per cent of a particle's hardness moves its load by less than three up to ε = 0.8.

    Beyond, between ρ = 1.4 and 2, one that embeds and one that ends as a thin disc lie close
    together: their loads differ fourfold at ε = 0.9.
    """
    for ratio in np.geomspace(0.2, 12, 120):
        one, two = (load(SQUEEZES, factor * ratio) for factor in (0.995, 1.005))
        change = np.abs(np.log(two / one))
        assert np.max(change[SQUEEZES < 0.8]) < 0.03, ratio
        assert np.max(change) < 0.08, ratio


@pytest.mark.parametrize("ratio", [0.2, 0.7, 1.0, 1.3, 1.5, 1.62])
@pytest.mark.parametrize("m", [0.05, 0.2, 1.0])
def test_discs_keep_their_volume_beyond_the_table(ratio, m):
    """The height left is what the surface does not take: A (1 − ε + sink) stays, no load leaps."""
    one = side(ratio, m, kappa=300.0)
    eps = np.linspace(TABLE_ENDS, min(one.end, 1.0), 200)
    height = 1 - eps + one.sink(0.5 * eps) / 0.5
    volume = one.area(0.5 * eps) * height
    np.testing.assert_allclose(volume, volume[0], rtol=1e-9)
    before, at, after = np.log(one.force(0.5 * (TABLE_ENDS + np.array([-3e-3, 0.0, 3e-3]))))
    assert after - at < 2 * (at - before) + 0.01


@pytest.mark.parametrize("ratio", [0.1, 0.3, 0.4, 0.45, 0.5, 0.8])
def test_no_surface_bears_more_than_its_hardness_on_a_squashed_particle(ratio):
    one, eps = side(ratio, m=1.0), np.linspace(0.2, 1.0, 4000)
    pressure = one.force(0.5 * eps) / one.area(0.5 * eps)
    assert np.max(pressure) <= H * (1 + 1e-9)


def test_nothing_steps_over_hardness_stiffness_and_squeeze():
    """A step would stay as large however near two hardness ratios, or two squeezes, are."""
    eps = np.linspace(0.02, 0.95, 400)
    ratios = [0.4, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0, 5.0, *np.exp(RNG.uniform(-1.2, 1.8, 40))]

    def columns(ratio, kappa, m, eps):
        modulus = 2 * kappa * H * min(1, ratio) * (1 - NU**2)
        surface = tb.Material(E=modulus, nu=NU, H=H)
        law, pair = Series(friction_factor=m), tb.MaterialPair(surface, surface)
        spots = law.probe(eps, surfaces=pair, particle=surface.replace(H=ratio * H))
        return np.stack([spots.load[:, 0] / H, spots.areas[0][:, 0], 0.01 + spots.sinks[0][:, 0]])

    for ratio in ratios:
        kappa, m = math.exp(RNG.uniform(math.log(8), math.log(1000))), RNG.uniform(0.02, 1.0)
        for e in (eps, eps * (1 + 1e-8)):
            change = columns(ratio * (1 + 1e-8), kappa, m, e) / columns(ratio, kappa, m, eps)
            assert np.max(np.abs(np.log(change))) < 1e-5, (ratio, kappa, m)


def test_sums_over_squeezes_meet_every_kink():
    """Between kinks load and areas are smooth: 40 terms leave nothing."""
    from thirdbody.numerics.chebyshev import chebyshev_transform

    nodes, transform = chebyshev_transform(40)
    for ratio in (0.3, 1.0, 1.7, 6.0):
        one = DEEP.one(surfaces=PAIR, particle=particle_of(ratio))
        for a, b in itertools.pairwise(one.panels):
            values = one(0.5 * (a + b) + 0.5 * (b - a) * nodes)
            tail = np.abs(transform @ values)[-3:].max(axis=0)
            assert np.all(tail <= 1e-11 * np.maximum(np.abs(values).max(axis=0), 1e-300))


# ---------------------------------------------------------------------------- what holds
@pytest.mark.parametrize("ratio", [1.0, 1.4, 2.0, 3.0, 5.0])
def test_a_particle_takes_the_easier_way(ratio):
    """Load near the smaller of two upper bounds: it is flattened, or the surfaces flow."""
    for eps in (0.15, 0.3, 0.5):
        flattened, embedded = load(eps, 0.01) / 0.01, load(eps, 50.0)
        assert float(load(eps, ratio)) == pytest.approx(min(ratio * flattened, embedded), rel=0.25)


def test_who_is_dented():
    """A particle as hard as the surfaces is squashed; one three times as hard embeds."""
    sinks = {}
    for ratio in (1.0, 2.0, 3.0):
        law = Series(friction_factor=1.0)
        spots = law.probe(np.array([0.3, 0.5, 0.9]), surfaces=PAIR, particle=particle_of(ratio))
        sinks[ratio] = np.ravel(spots.sinks[0]) / 0.5
    assert np.all(sinks[1.0] < 0.2)
    assert sinks[2.0][0] < 0.25
    assert sinks[3.0][1] > 0.4
    hard = DEEP.probe(np.array([0.5]), surfaces=PAIR, particle=particle_of(100.0))
    assert float(hard.sinks[0][0, 0]) == pytest.approx(0.25, rel=0.02)


@pytest.mark.parametrize("options", [dict(soft="sphere"), dict(onset="jg")])
def test_the_choices_of_other_laws_put_the_table_aside(options):
    eps = np.array([0.02, 0.3, 0.9])
    for ratio in (0.5, 2.0):
        one, two = (single(eps, ratio, deep=deep, **options) for deep in ("table", "off"))
        np.testing.assert_array_equal(one["force"], two["force"])
        assert not any(Series(**options).one(surfaces=PAIR, particle=particle_of(ratio)).knows_sink)


# ---------------------------------------------------------------------------- how deep it sinks
def sinks_over_R(ratio, eps, m=1.0):
    return np.ravel(side(ratio, m).sink(0.5 * np.asarray(eps))) / 0.5


def test_a_rigid_particle_sinks_by_the_whole_squeeze():
    eps = np.linspace(1e-4, 1.7, 300)
    np.testing.assert_allclose(sinks_over_R(1e3, eps), eps, rtol=1e-12)
    # rough faces press so hard on a thin disc that it sinks into the harder surface
    assert np.all(sinks_over_R(0.3, eps[eps < 0.95], m=0.2) == 0.0)
    assert np.all(sinks_over_R(0.3, eps[eps < 0.9]) == 0.0)


def test_sinks_at_the_hardness_ratios_that_were_computed():
    """Welded: none embeds at ρ = 1, ρ = 2 passes R/4 late and never R/2, ρ = 3 halfway."""
    eps = np.linspace(0.05, 0.95, 2000)
    one, two, three = (sinks_over_R(ratio, eps) for ratio in (1.0, 2.0, 3.0))
    assert np.max(one[eps <= 0.93]) < 0.17
    assert eps[np.argmax(two > 0.25)] == pytest.approx(0.83, abs=0.01)
    assert np.max(two) < 0.5
    assert eps[np.argmax(three > 0.5)] == pytest.approx(0.503, abs=0.005)


def test_sink_and_squash_share_the_squeeze():
    """Neither falls as a particle is squeezed, whatever its hardness and friction."""
    eps = np.linspace(0.0, 1.6, 1500)
    for _ in range(60):
        ratio = math.exp(RNG.uniform(math.log(0.2), math.log(20)))
        sink = sinks_over_R(ratio, eps, RNG.uniform(0.02, 1.0))
        assert np.all(np.diff(sink) >= -1e-12), ratio
        assert np.all(np.diff(eps - sink) >= -1e-12), ratio
        assert sink[0] == 0.0


@pytest.mark.spread(3)
@pytest.mark.parametrize("m", [0.05, 0.2, 1.0])
def test_no_hardness_is_a_cliff_for_the_sink(m):
    """One per cent of a particle's hardness moves its sink by less than 3 % of the squeeze."""
    eps = np.linspace(0.02, 0.95, 200)
    for ratio in np.geomspace(0.3, 12, 150):
        one, two = (sinks_over_R(factor * ratio, eps, m) for factor in (0.995, 1.005))
        assert np.max(np.abs(one - two) / eps) < 0.03, ratio


@pytest.mark.parametrize("m", [0.0, 0.2, 1.0])
def test_sinks_are_those_of_the_table(m):
    table = json.loads(
        resources.files("thirdbody").joinpath("data/deep_squeeze.json").read_text("utf-8")
    )
    compared = 0
    for curve in table["curves"]:
        ratio = float(curve["rho"])
        if (curve["m"], curve["E_over_Y"], curve["surfaces"]) != (m, "inf", 2) or ratio == 0:
            continue
        known = np.array([value is not None for value in curve["sink"]])
        said = np.array(curve["sink"], dtype=float)[known]
        found = squeeze_curve(min(ratio, 10.0), m, 1e12).sinks[known]
        # what is beyond the error of the table: nothing
        np.testing.assert_allclose(found, said, atol=0.002)
        compared += 1
    assert compared >= 7


def test_thin_discs_go_on_until_they_sink_into_the_surface():
    one = side(0.3, m=0.2)
    assert one.end > TABLE_ENDS
    pressure = float(
        one.force(np.array([0.5 * one.end]))[0] / one.area(np.array([0.5 * one.end]))[0]
    )
    assert pressure == pytest.approx(H, rel=1e-9)


def test_tables_and_definition_agree():
    rough = tb.Roughness(sigma=100e-9, R=2.8e-6)
    dust = tb.Particles(
        material=particle_of(1.3),
        areal_density=1e11,
        diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
    )
    contact = tb.Contact(surfaces=PAIR, roughness=rough, particles=dust, particle_law=DEEP)
    h = np.array([220e-9])
    from scipy import integrate, stats

    one = DEEP.one(surfaces=PAIR, particle=dust.material)
    sizes = dust.diameter
    states = tb.solve(contact, d=h - rough.y_s)
    for i, gap in enumerate(h):

        def inner(x, gap=gap):
            seats = np.sort([gap - x * (1 - k) for k in [0.0, *one.kinks]])

            def f(z):
                squeezed = one(1 - (gap - z) / x)[:, 0]
                return x * x * squeezed * stats.norm.pdf(z, 0, 100e-9)

            ends = [*np.clip(seats, -9e-7, 9e-7), 9e-7]
            return (
                sum(
                    integrate.fixed_quad(f, a, b, n=24)[0]
                    for a, b in itertools.pairwise(ends)
                    if b > a
                )
                * sizes.pdf(np.array([x]))[0]
            )

        total = integrate.fixed_quad(np.vectorize(inner), *sizes.support, n=40)[0]
        assert states.F_sa_star[i] * contact.E_ss == pytest.approx(1e11 * total, rel=2e-6)


def test_many_curves_are_those_of_one():
    rng = np.random.default_rng(3)
    ratio, kappa = np.exp(rng.uniform(-3, 3, 40)), np.exp(rng.uniform(1, 7, 40))
    friction = np.where(rng.random(40) < 0.5, 0.2, rng.random(40))
    load, area = curve_rows(ratio, friction, kappa)
    for i, sides in enumerate(zip(ratio.tolist(), friction.tolist(), kappa.tolist(), strict=True)):
        one = squeeze_curve(*sides)
        np.testing.assert_allclose(load[i], one.log_load, atol=1e-13)
        np.testing.assert_allclose(area[i], one.log_area, atol=1e-13)


def test_a_side_has_the_same_bits_alone_and_among_others():
    rng = np.random.default_rng(7)
    cases = (
        np.exp(rng.uniform(-1.5, 2.0, 60)),
        rng.choice([0.0, 0.2, 0.5, 1.0], 60),
        10 ** rng.uniform(0.8, 4.0, 60),
    )
    together = curve_rows(*cases)
    for i in range(60):
        alone = curve_rows(*(values[i : i + 1] for values in cases))
        for one, many in zip(alone, together, strict=True):
            np.testing.assert_array_equal(one[0], many[i])


def test_series_of_many_sides_are_those_of_each():
    """Of every friction factor, one of the runs or between them, alone and among others."""
    from thirdbody.laws.particle.deep import curve_rows

    friction = np.array([0.0, 0.05, 0.3, 0.5, 0.77, 1.0])
    ratio, kappa = np.geomspace(0.2, 5.0, 6), np.geomspace(9.0, 300.0, 6)
    for whole, other in zip(
        curve_rows(ratio, friction, kappa),
        zip(*(curve_rows(*(v[i : i + 1] for v in (ratio, friction, kappa))) for i in range(6)),
            strict=True),
        strict=True,
    ):  # fmt: skip
        np.testing.assert_array_equal(whole, np.concatenate(other))
