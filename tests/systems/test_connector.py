"""Connectors on dust: against Poisson limits, the law of one kind of dust, and drawn particles."""

import math
from fractions import Fraction

import numpy as np
import pytest
from refusals import refuses

import thirdbody as tb
from thirdbody.errors import Mistake
from thirdbody.study.connector import AskedConnector
from thirdbody.study.run_connector import run_connector
from thirdbody.systems import connector
from thirdbody.systems.compound_sums import expand_sum, fill_squeezes, tabulate_squeezes
from thirdbody.systems.connector import Connector, overlap
from thirdbody.systems.contact_probability import ContactProbability

BRONZE = tb.materials["CuSn8"]
PAIR = tb.MaterialPair(BRONZE, BRONZE)
LAW = tb.particle.Series(deep="off")
RADIUS = 2e-3


def dust(number, sizes=None, material="quartz", **more):
    """So many particles in the way of one contact, on average."""
    sizes = sizes or tb.distributions.Monodisperse(mean=10e-6)
    return tb.Particles(
        material=tb.materials[material],
        diameter=sizes,
        areal_density=number / (2 * math.pi * RADIUS * sizes.moment(1)),
        **more,
    )


def plug(*kinds, **more):
    return Connector(**(dict(radius=RADIUS, surfaces=PAIR, particles=kinds, law=LAW) | more))


@pytest.mark.parametrize("number", [1e-6, 0.25, 3.0, 40.0])
def test_without_force_one_particle_is_enough(number):
    assert plug(dust(number)).failure(0.0) == pytest.approx(-math.expm1(-number), rel=1e-12)
    both = plug(dust(number, name="a"), dust(2 * number, name="b"))
    assert both.failure(0.0) == pytest.approx(-math.expm1(-3 * number), rel=1e-12)


@pytest.mark.parametrize("n", [1, 20, 1000])
@pytest.mark.parametrize("m", [1, 2])
def test_in_series_all_must_close_and_of_parallel_spots_one(n, m):
    many = plug(dust(0.01), contacts=n, parallel=m)
    one = many.failure(0.05)
    closes = (1 - one**m) ** n
    assert many.failure_of_all(0.05) == pytest.approx(1 - closes, rel=1e-9)
    rare = plug(dust(1e-7), contacts=n, parallel=m)
    f = rare.failure(0.0) ** m
    assert rare.failure_of_all(0.0) == pytest.approx(n * f, rel=1e-3)


@pytest.mark.parametrize(
    "sizes",
    [tb.distributions.Monodisperse(mean=8e-6), tb.LogNormal(median=8e-6, gsd=1.5)],
    ids=["one size", "log-normal"],
)
def test_one_kind_of_dust_is_that_of_contact_probability(sizes):
    kind = dust(1.3, sizes)
    alone = ContactProbability(radius=RADIUS, surfaces=PAIR, particles=kind, law=LAW)
    several = plug(kind)
    assert several.in_the_way == pytest.approx(alone.in_the_way, rel=1e-9)
    for load in np.array([0.1, 0.5, 0.99, 1.0, 2.5]) * alone.threshold:
        low, high = several.bounds(load)
        assert low <= high
        assert high - low < 4e-3
        assert several.failure(load) == pytest.approx(1 - alone.probability(load), abs=2e-3)


def test_a_curve_is_its_points():
    spread = plug(dust(1.3, tb.LogNormal(median=8e-6, gsd=1.4)))
    loads = np.geomspace(1e-3, 2.0, 25)
    expected = [spread.failure(float(load)) for load in loads]
    assert spread.failures(loads) == pytest.approx(expected, rel=0.03, abs=1e-4)
    kinds = dust(0.3, name="sand"), dust(0.3, material="CuSn8", name="debris")
    mixed = plug(*kinds, conducting=["debris"])
    assert mixed.failures([0.05])[0] == mixed.failure(0.05)
    assert spread.failures([0.0, 0.1])[0] == spread.failure(0.0)


def test_two_halves_are_the_whole():
    whole = plug(dust(0.8))
    halves = plug(dust(0.4, name="a"), dust(0.4, name="b"))
    for load in (0.02, 0.1, 0.3):
        assert halves.failure(load) == pytest.approx(whole.failure(load), abs=1e-3)


def test_a_wipe_that_pushes_nothing_aside_changes_nothing():
    still, wiped = plug(dust(0.8)), plug(dust(0.8), wipe=0.1e-3)
    assert wiped.failure(0.05) == still.failure(0.05)


def test_a_long_wipe_leaves_what_it_does_not_push_aside():
    """Discs of radius √(2 R x) that do not meet: a thinned Poisson number."""
    reach = math.sqrt(2 * RADIUS * 10e-6)
    for part in (0.3, 1.0):
        long = plug(dust(0.8), wipe=2 * reach, pushed_aside=part)
        fewer = plug(dust(0.8 * (1 - part)) if part < 1 else dust(1e-30))
        assert long.failure(0.0) == pytest.approx(fewer.failure(0.0), rel=1e-9, abs=1e-15)
        assert long.failure(0.05) == pytest.approx(fewer.failure(0.05), rel=1e-9, abs=1e-15)


def test_a_short_wipe_pushes_aside_what_two_discs_do_not_share():
    reach = math.sqrt(2 * RADIUS * 10e-6)
    k = 0.5
    shared = (2 * math.acos(k / 2) - 0.5 * k * math.sqrt(4 - k**2)) / math.pi
    short = plug(dust(0.8), wipe=k * reach, pushed_aside=1.0)
    assert short.in_the_way == pytest.approx(0.8 * shared, rel=1e-12)
    assert short.failure(0.0) == pytest.approx(-math.expm1(-0.8 * shared), rel=1e-12)


def test_the_area_that_discs_share_against_drawn_points():
    rng = np.random.default_rng(3)
    points = rng.uniform(-1, 1, (400_000, 2))
    for u, k in ((0.3, 0.2), (0.3, 0.7), (1.0, 1.2), (0.8, 1.6)):
        inside = np.hypot(*points.T) <= 1
        other = np.hypot(points[:, 0] - k, points[:, 1]) <= math.sqrt(u)
        expected = 4 * np.mean(inside & other) / math.pi
        assert float(overlap(u, k)) == pytest.approx(expected, abs=4e-3)


def drawn(kinds, reach, rng, draws):
    """Particles of every kind thrown on discs: which draw, place, diameter; in µm and metres."""
    for kind in kinds:
        count = rng.poisson(math.pi * reach**2 * kind.areal_density, draws)
        of = np.repeat(np.arange(draws), count)
        r, phi = reach * np.sqrt(rng.uniform(size=len(of))), rng.uniform(0, 2 * np.pi, len(of))
        yield of, r * np.cos(phi), r * np.sin(phi), kind.diameter.sample(rng, len(of))


@pytest.mark.parametrize("part", [0.5, 1.0])
def test_a_wipe_against_drawn_particles(part):
    """Each particle: in the way at last, and there at first or not pushed aside."""
    sizes = tb.LogNormal(median=8e-6, gsd=1.3)
    kind, wipe, draws = dust(1.5, sizes), 0.12e-3, 30_000
    wiped = plug(kind, wipe=wipe, pushed_aside=part)
    rng = np.random.default_rng(8)
    reach = math.sqrt(2 * RADIUS * sizes.support[1])
    ((of, x, y, size),) = drawn([kind], reach, rng, draws)
    gap = (x**2 + y**2) / (2 * RADIUS)
    before = ((x - wipe) ** 2 + y**2) / (2 * RADIUS) < size
    stays = before | (rng.uniform(size=len(of)) > part)
    force = LAW.single(size, gap, surfaces=PAIR, particle=kind.material)["force"]
    carried = np.bincount(of, np.where(stays, force, 0.0), minlength=draws)
    for load in np.array([0.1, 0.5, 1.3]) * wiped.threshold:
        open_ = np.mean(carried > load)
        error = 4 * math.sqrt(max(open_ * (1 - open_), 1e-4) / draws)
        low, high = wiped.bounds(load)
        assert low - error <= open_ <= high + error, load


def test_dust_that_conducts_against_drawn_particles():
    """The height at which insulating particles carry, and whether a conducting one is taller."""
    kinds = [dust(0.7, name="sand"), dust(0.5, material="CuSn8", name="debris")]
    mixed = plug(*kinds, conducting=("debris",))
    rng = np.random.default_rng(9)
    draws, reach = 4000, math.sqrt(2 * RADIUS * 10e-6)
    sand, debris = drawn(kinds, reach, rng, draws)
    heights = np.linspace(0, 10e-6, 300)
    for load in np.array([0.2, 0.7]) * mixed.threshold:
        gap, size = (sand[1] ** 2 + sand[2] ** 2) / (2 * RADIUS), sand[3]
        found = np.zeros(draws)
        for h in heights:  # the least height at which they carry no more than the load
            force = LAW.single(size, gap + h, surfaces=PAIR, particle=kinds[0].material)["force"]
            found += np.bincount(sand[0], force, minlength=draws) > load
        stands = np.where(found > 0, found * heights[1], 0.0)
        tallest = np.full(draws, -1.0)
        np.maximum.at(
            tallest, debris[0], debris[3] - (debris[1] ** 2 + debris[2] ** 2) / (2 * RADIUS)
        )
        open_ = np.mean((stands > 0) & (tallest < stands))
        error = 4 * math.sqrt(open_ * (1 - open_) / draws) + 4e-3
        assert mixed.failure(load) == pytest.approx(open_, abs=error)


def test_dust_that_only_conducts_never_keeps_a_circuit_open():
    assert plug(dust(3.0, name="debris"), conducting=("debris",)).failure(0.01) == 0.0


def test_by_material_metal_conducts_and_sand_does_not():
    kinds = dust(0.7, name="sand"), dust(0.5, material="CuSn8", name="debris")
    named, told = plug(*kinds, conducting=("debris",)), plug(*kinds, conducting="by material")
    assert told.failure(0.05) == named.failure(0.05)
    sand = plug(dust(0.7), conducting="by material")
    assert sand.failure(0.05) == plug(dust(0.7)).failure(0.05)


def test_dust_that_conducts_closes_more_often_than_dust_that_does_not():
    kinds = dust(0.7, name="sand"), dust(0.5, material="CuSn8", name="debris")
    insulating, alone = plug(*kinds), plug(kinds[0])
    mixed = plug(*kinds, conducting=("debris",))
    for load in (0.0, 0.02, 0.1):
        assert mixed.failure(load) <= alone.failure(load) + 2e-3
        assert alone.failure(load) <= insulating.failure(load) + 2e-3


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"radius": 5e-6}, "of which 100 % reach it"),
        ({"contacts": 2.5}, "must be a whole number"),
        ({"pushed_aside": 1.2}, "pushed_aside"),
        ({"conducting": ("gold",)}, "must name particles"),
    ],
)
def test_what_is_no_connector(changes, words):
    with pytest.raises(tb.errors.InvalidValue, match=words):
        plug(dust(1.0), **changes)


def test_a_tail_that_hardly_any_particle_has_is_no_boulder():
    """A log-normal has no largest size: one in 1e11 of those in the way is as large as the sphere."""
    broad = tb.LogNormal(median=8e-6, gsd=2.0)
    assert broad.support[1] > RADIUS
    assert 0 < plug(dust(0.1, broad)).failure(0.5) < 0.1
    with pytest.raises(tb.errors.InvalidValue, match=r"of which 0\.\d+ % reach it"):
        plug(dust(0.1, tb.LogNormal(median=20e-6, gsd=3.0)))


def test_particles_that_break_are_refused():
    strong = tb.grains.WeibullStrength.of(tb.materials["quartz"])
    with pytest.raises(tb.errors.InvalidValue, match="break"):
        plug(dust(1.0, strength=strong))


@pytest.mark.parametrize("load", [-1.0, math.nan, math.inf])
def test_loads_that_are_none(load):
    with refuses(Mistake.RANGE, "", says="load"):
        plug(dust(1.0)).bounds(load)


def test_a_curve_over_the_force_is_that_of_single_forces():
    """Of many particles each takes little: steps of the largest force are too long for small ones."""
    fine = tb.LogNormal(median=1e-6, gsd=1.2)
    many = plug(dust(300, fine))
    forces = np.geomspace(0.3, 6.0, 6)
    singles = [many.failure(float(force)) for force in forces]
    np.testing.assert_allclose(many.failures(forces), singles, atol=1e-3)


def test_a_curve_never_rises_with_the_force():
    """Many fine particles: from always open over a steep fall to never, far below the last digit."""
    fine = tb.TruncatedGaussian(mean=300e-9, std=24e-9, n=3)
    many = plug(dust(377, fine))
    failures = many.failures(np.geomspace(0.005, 2.0, 31))
    assert np.all(np.diff(failures) <= 1e-12)
    assert failures[0] == 1.0
    assert failures[-1] == 0.0
    falls = (failures > 1e-3) & (failures < 1 - 1e-3)
    assert falls.any()


@pytest.mark.parametrize("number", [0.02, 5.0, 100.0])
@pytest.mark.parametrize("height", [0.0, 3e-6])
def test_what_is_certain_is_what_the_sums_say(monkeypatch, number, height):
    """Chernoff's bounds against the sums, which without them are computed under every load."""
    kinds = plug(dust(number, tb.LogNormal(median=8e-6, gsd=1.4)))._kinds()
    mean = sum(float(kind.in_the_way @ (kind.most * kind.x**2)) for kind in kinds)
    loads = np.geomspace(1e-3 * mean, 1000 * max(mean, kinds[0].most * (8e-6) ** 2), 40)
    more, less = connector._certain(kinds, loads, height)
    assert less.any()
    assert more.any() == (number * (1 - height / 9.4e-6) > 42)  # e^-N is 1e-18
    assert not (more | less).all()
    monkeypatch.setattr(connector, "_certain", lambda kinds, w, h: (w < 0, w < 0))
    sums = np.array([connector._open(kinds, loads[[i]], height) for i in range(len(loads))])
    np.testing.assert_allclose(sums[more], 1.0, rtol=0, atol=1e-13)
    np.testing.assert_allclose(sums[less], 0.0, rtol=0, atol=1e-12)


@pytest.mark.check
@pytest.mark.parametrize("pushed_aside", [0.0, 0.6])
@pytest.mark.parametrize("height", [0.0, 4e-6, 9e-6])
@pytest.mark.parametrize(
    "sizes",
    [
        tb.LogNormal(median=8e-6, gsd=1.3),
        tb.LogNormal(median=8e-6, gsd=1.02),
        tb.distributions.Uniform(low=5e-6, high=12e-6),
        tb.distributions.Monodisperse(mean=9.5e-6),
    ],
    ids=["broad", "narrow", "uniform", "one size"],
)
def test_particles_below_a_load_are_those_that_the_law_says(height, sizes, pushed_aside):
    """Against the share of an even spread of places and sizes that carries no more alone."""
    wiped = plug(dust(2.0, sizes), wipe=0.1e-3, pushed_aside=pushed_aside)
    (kind,) = wiped._kinds()
    loads = kind.most * (8e-6) ** 2 * np.array([0.0, 1e-3, 0.03, 0.2, 0.7, 1.0, 1.6, 4.0])
    places = (np.arange(400) + 0.5) / 400  # r²/(2 R_s x), of all that touch at height 0
    quantiles = (np.arange(400) + 0.5) / 400
    expected = np.zeros(len(loads))
    for x in np.atleast_1d(sizes.ppf(quantiles)):
        gap = height + places * x
        force = LAW.single(np.full_like(gap, x), gap, surfaces=PAIR, particle=kind.material)
        ends = 1 - height / x - places
        k = 0.1e-3 / math.sqrt(2 * RADIUS * x)
        shared = np.diff(overlap(np.linspace(0, 1, 401), np.full(401, k))) * 400
        stays = 1 - pushed_aside * (1 - shared)
        below = (force["force"][:, None] <= loads) & (ends > 0)[:, None]
        expected += x * np.mean(stays[:, None] * below, axis=0)
    expected *= 2.0 / (len(quantiles) * sizes.moment(1))
    np.testing.assert_allclose(kind.number_below(loads, height), expected, rtol=0, atol=6e-3)


@pytest.mark.parametrize(
    "sizes",
    [
        tb.LogNormal(median=8e-6, gsd=1.6),
        tb.LogNormal(median=8e-6, gsd=1.05),
        tb.LogNormal(median=3e-6, gsd=2.2),
        tb.TruncatedGaussian(mean=8e-6, std=0.4e-6),
        tb.distributions.Weibull(scale=8e-6, shape=2.0),
    ],
)
def test_the_classes_of_size_leave_less_than_the_bounds(monkeypatch, sizes):
    """Four times as many classes, by the sizes that matter under each load."""
    plugs = plug(dust(0.1, sizes))
    loads = np.array([0.1, 0.5]) * (1.0 if sizes.moment(1) > 5e-6 else 0.3)
    found = [plugs.bounds(load) for load in loads]
    monkeypatch.setattr(connector, "STEP", 0.005)
    monkeypatch.setattr(connector, "FEWEST", 1000)
    connector._classes.cache_clear()
    for (low, high), load in zip(found, loads, strict=True):
        finer = plugs.failure(load)
        assert low <= finer <= high
        assert 0.5 * (low + high) == pytest.approx(finer, rel=1e-3)
    connector._classes.cache_clear()


def test_the_mean_squeeze_between_two_sizes():
    """Against Gauss points between the sizes, with a load that rests while ε goes on."""
    eps = np.array([0.0, 0.0, 0.1, 0.4, 0.7, 1.0])
    load = np.array([0.0, 1.0, 2.0, 7.0, 7.0, 9.0])
    x = np.exp(np.linspace(math.log(0.8), math.log(1.3), 200_001))
    forces = np.array([0.0, 0.5, 1.0, 3.0, 6.5, 8.0, 14.0, 20.0])
    out = np.empty(len(forces))
    logs = np.log(np.where(forces > 0, forces, 1.0))
    fill_squeezes(forces, logs, 0.8, 1.3, tabulate_squeezes(eps, load), out)
    for f, mean in zip(forces, out, strict=True):
        p = f / x**2
        k = np.searchsorted(load, p, side="right") - 1
        inside = np.clip(k, 0, 4)
        step = np.maximum(load[inside + 1] - load[inside], 1e-300)
        slope = (eps[inside + 1] - eps[inside]) / step
        squeeze = np.where(k == 5, 1.0, eps[inside] + slope * (p - load[inside]))
        assert mean == pytest.approx(np.mean(squeeze), abs=1e-5)


def test_the_masses_of_a_sum_are_those_of_exact_fractions():
    """Panjer's recursion in whole numbers, for masses that end early and with zeros among them."""
    mass = [Fraction(k, 32) for k in (3, 0, 7, 11, 0, 0, 5, 0, 0, 0, 0, 0)]
    number = Fraction(7, 2)
    exact = [Fraction(1)]
    for j in range(1, len(mass)):
        terms = (number * i * mass[i] * exact[j - i] for i in range(1, j + 1))
        exact.append(sum(terms, Fraction(0)) / j)
    weight = np.array([float(number * i * each) for i, each in enumerate(mass)])
    g = np.zeros(len(mass))
    g[0] = 1.0
    assert expand_sum(weight, 6, 1e200, g) == 0
    np.testing.assert_allclose(g, [float(each) for each in exact], rtol=1e-14)
    scaled = np.zeros(len(mass))
    scaled[0] = 1.0
    times = expand_sum(weight, 6, 0.5, scaled)
    assert times > 0
    np.testing.assert_allclose(scaled * 0.5**times, g, rtol=1e-14)


def test_what_would_be_no_connector_is_no_what_if():
    """Twice the dust would cover more than there is: the answer comes without that."""
    crowded = dust(1.0, tb.distributions.Monodisperse(mean=10e-6)).replace(areal_density=9e9)
    found = run_connector(AskedConnector(title="", connector=plug(crowded), forces=np.array([0.5])))
    assert found.failure_of_all[2] == pytest.approx(1.0, abs=1e-12)
    whats = {each.what for each in found.what_ifs}
    assert whats == {"the hardness of the contacts"}
    thin = AskedConnector(title="", connector=plug(dust(1.0)), forces=np.array([0.5]))
    assert len(run_connector(thin).what_ifs) == 3
