"""Single particles in a film: exact geometry, quadrature and random throws."""

import itertools
import json
import math
from dataclasses import astuple
from pathlib import Path

import mpmath
import numpy as np
import pytest
from refusals import Mistake, refuses, warns_of
from scipy import integrate, optimize

import thirdbody as tb
from thirdbody.effects.single import dent as co
from thirdbody.effects.single.ploughing import residual_depth
from thirdbody.laws.particle.squashed import widest_disc
from thirdbody.laws.particle.tension import tension
from thirdbody.systems import oil_particles

SHARED = Path(__file__).parents[2].parent / "shared" / "reference" / "outputs.json"
STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
SOFT = STEEL.replace(H=2.5e9)
PAIR = tb.MaterialPair(STEEL, STEEL)
ONE = dict(surfaces=PAIR, material=SILICA, film=0.5e-6, entry=1.0, deep="off")
TWO = dict(ONE, surfaces=tb.MaterialPair(STEEL, SOFT))


def oil(code="18/16/13", **options):
    return oil_particles.FilmParticles.from_iso4406(code, **(ONE | options))


def test_values():
    """Numbers of the reference, as far as they belong here."""
    # a 2 µm grain in a 0.5 µm film between equal surfaces
    grain = oil().single(2e-6)
    assert grain.depths[0][0, 0] == pytest.approx(0.75e-6, rel=1e-12)
    assert grain.depths[1][0, 0] == pytest.approx(0.75e-6, rel=1e-12)
    assert float(residual_depth(10.0, depth_over_yield=10.0)) == pytest.approx(
        3.7817067580703516, rel=1e-14
    )
    slopes = tb.dust.suspension_of_iso4406("18/16/13", level="high")[1].slopes
    assert slopes[1] == pytest.approx(2.4542036973037558, rel=1e-12)
    # 1250 particles from 4 µm in each square metre of the film
    assert oil(level="high").above(0.0) == pytest.approx(1250, rel=1e-12)


def test_number_of_a_dust():
    """20 % of the volume of 1 g/m³ between 5 and 10 µm, evenly over ln x."""
    sizes = tb.distributions.PowerLaw(edges=(5e-6, 10e-6), counts=(1.0,), slopes=(3.0,))
    found = tb.dust.particles_in(
        tb.dust.concentration(0.2e-3, "mass per volume"), sizes, particle_density=2650
    )
    a, b = 5e-6, 10e-6
    mean = (a**-3 - b**-3) / (3 * math.log(b / a))
    assert found == pytest.approx(0.2e-3 / 2650 * 6 / math.pi * mean, rel=1e-12)
    if SHARED.exists():
        values = {each["id"]: each["value"] for each in json.loads(SHARED.read_text())["values"]}
        assert found == pytest.approx(values["dust_number"], rel=1e-8)


def test_diameter_and_volume_of_a_cap():
    with mpmath.workdps(30):
        for depth in (1e-6, 0.3, 1.0):
            whole = mpmath.quad(lambda z: mpmath.pi * (2 * z - z**2), [0, depth])
            assert float(co.dent_volume(depth, depth=depth, radius=1.0)) == pytest.approx(
                float(whole), rel=1e-10
            )
    assert co.dent_volume(1.7, depth=1.8, radius=1.0) == pytest.approx(
        math.pi * (2 / 3 + 0.7), rel=1e-14
    )
    assert float(co.dent_diameter(0.5, radius=1.0)) == pytest.approx(math.sqrt(3), rel=1e-14)
    assert float(co.dent_diameter(1.6, radius=1.0)) == 2.0


def test_discs_and_fragments_keep_the_volume():
    x = np.array([2.0, 5.0])
    D = co.flattened_diameter(x, gap=0.7)
    np.testing.assert_allclose(np.pi * D**2 / 4 * 0.7, np.pi * x**3 / 6, rtol=1e-14)
    assert co.flattened_diameter(1.0, gap=0.9) == 1.0
    np.testing.assert_allclose(co.fragments(x, size=0.5) * 0.5**3, x**3, rtol=1e-14)
    assert co.fragments(0.3, size=0.5) == 1


def test_dents_after_many_passes_by_random_throws():
    """The covered share is that of discs thrown on a torus."""
    rng = np.random.default_rng(4)
    radius, thrown = 0.04, 300
    covered = []
    for _ in range(40):
        centres, points = rng.random((thrown, 2)), rng.random((500, 2))
        apart = np.abs(points[:, None] - centres)
        apart = np.minimum(apart, 1 - apart)
        covered.append(np.mean(np.any(np.sum(apart**2, axis=-1) < radius**2, axis=1)))
    area = math.pi * radius**2
    expected = float(co.dents_after(thrown, overrollings=1.0, area=area)) * area
    error = np.std(covered) / math.sqrt(len(covered))
    assert abs(np.mean(covered) - expected) < 4 * error < 0.02
    assert float(co.dents_after(10.0, overrollings=1e-9, area=area)) == pytest.approx(
        1e-8, rel=1e-9
    )
    assert float(co.dents_after(10.0, overrollings=1e12, area=area)) == pytest.approx(
        1 / area, rel=1e-12
    )
    assert float(co.dents_after(10.0, overrollings=3.0, area=0.0)) == 30.0


@pytest.mark.spread(3)
@pytest.mark.parametrize("side", [1, 2])
@pytest.mark.parametrize(
    "sizes",
    [
        tb.LogNormal(median=0.6e-6, gsd=1.6),
        tb.TruncatedGaussian(mean=0.55e-6, std=0.05e-6),
        tb.distributions.Histogram(edges=(0.2e-6, 0.6e-6, 1.5e-6), counts=(3, 1)),
        tb.distributions.Monodisperse(mean=0.8e-6),
    ],
    ids=lambda each: type(each).__name__,
)
def test_sums_over_sizes(sizes, side):
    """Against random particles one by one, and adaptive quadrature for the volume."""
    film = oil_particles.FilmParticles(diameter=sizes, number=1e15, **TWO)
    dents = film.dents(side)
    rng = np.random.default_rng(1)
    x = sizes.sample(rng, 200_000)
    x = x[x > film.film]
    each = co.dent_of(film.single(x), side=side - 1, particle=SILICA)
    there = each.depth > 0
    depth, width = each.depth[there], each.diameter[there]
    if type(sizes) is tb.distributions.Monodisperse:
        assert dents.number == pytest.approx(1e15 * film.film, rel=1e-12)
        assert dents.depth == pytest.approx(depth[0], rel=1e-12)
        return
    for found, sample in ((dents.depth, depth), (dents.diameter, width)):
        assert abs(found - sample.mean()) < 5 * sample.std() / math.sqrt(len(sample))
    share = np.mean(there) * len(x) / 200_000
    assert dents.number == pytest.approx(film.columns_of_oil * share, rel=0.03)
    for found, sample in ((dents.depth_p95, depth), (dents.diameter_p95, width)):
        assert abs(np.mean(sample > found) - 0.05) < 5 * math.sqrt(0.05 / len(sample))

    def volume(y):
        dent = co.dent_of(film.single(y), side=side - 1, particle=SILICA)
        return float(dent.volume[0, 0]) * float(sizes.pdf(y))

    edges = np.unique([film.film, *np.geomspace(film.film, sizes.support[1], 40), 0.6e-6])
    edges = edges[(edges >= max(film.film, sizes.support[0])) & (edges <= sizes.support[1])]
    total = sum(
        integrate.quad(volume, a, b, epsabs=0, epsrel=1e-9)[0] for a, b in itertools.pairwise(edges)
    )
    assert dents.volume == pytest.approx(film.columns_of_oil * total, rel=1e-6)


def test_largest_by_change_of_variable():
    """The particle that ln 2 of all exceed makes the largest dent."""
    film = oil()
    area, passes = 1e-6, 1e6
    dent = film.largest(area, overrollings=passes)
    x = 1e-6 * np.linspace(4, 70, 400_001)
    counts = np.array([film.above(y) for y in x[::4000]]) * area * passes
    at = float(np.interp(-math.log(2), -counts, x[::4000]))
    assert float(dent.depth) == pytest.approx(
        float(co.dent_of(film.single(at), side=0, particle=SILICA).depth[0, 0]), rel=1e-2
    )
    assert math.isnan(film.largest(1e-9, overrollings=1.0).depth)  # even one is unlikely
    assert film.largest(1e-6, overrollings=1e8).depth > dent.depth


def test_swap_of_the_surfaces():
    swapped = oil(surfaces=tb.MaterialPair(SOFT, STEEL), slip=1e-5, f_ab=0.3)
    given = oil(surfaces=tb.MaterialPair(STEEL, SOFT), slip=1e-5, f_ab=0.3)
    np.testing.assert_allclose(astuple(given.dents(1)), astuple(swapped.dents(2)), rtol=1e-11)
    one, two = given.severity_index(), swapped.severity_index()
    assert one.grooves_1 == pytest.approx(two.grooves_2, rel=1e-11)
    assert one.dents_2 == pytest.approx(two.dents_1, rel=1e-11)
    assert one.total == pytest.approx(two.total, rel=1e-11)


def test_change_of_units():
    """Lengths × 1000, numbers per volume × 1e-9: depths × 1000, counts per area × 1e-6."""
    big = oil_particles.FilmParticles(
        diameter=oil().diameter.scaled(1e3), number=oil().number * 1e-9, **ONE | {"film": 0.5e-3}
    )
    one, two = oil().dents(), big.dents()
    assert two.number == pytest.approx(1e-6 * one.number, rel=1e-11)
    assert two.depth_p95 == pytest.approx(1e3 * one.depth_p95, rel=1e-11)
    assert two.volume == pytest.approx(1e3 * one.volume, rel=1e-11)


def test_parts_of_the_index():
    found = oil(slip=2e-5, f_ab=0.25, surfaces=tb.MaterialPair(STEEL, SOFT)).severity_index()
    parts = (found.dents_1, found.dents_2, found.grooves_1, found.grooves_2)
    assert sum(parts) == pytest.approx(found.total, rel=1e-14)
    assert found.dents_2 > found.dents_1
    assert found.grooves_1 > 0 == found.grooves_2  # held in the softer surface
    even = oil(slip=2e-5, f_ab=0.25).severity_index()
    assert even.grooves_1 == pytest.approx(even.grooves_2, rel=1e-12)
    assert oil(slip=4e-5, f_ab=0.25).severity_index().grooves_1 == pytest.approx(
        2 * even.grooves_1, rel=1e-12
    )
    # fully plastic sphere between equal surfaces: S = 6(x−h)/x
    grain = oil_particles.FilmParticles(
        diameter=tb.distributions.Monodisperse(mean=0.9e-6), number=1.0, **ONE
    )
    assert grain.severity_index().severity == pytest.approx(6 * 0.4 / 0.9, rel=1e-2)


def test_nothing_passes():
    assert oil(film=80e-6).dents().number == 0
    assert oil(film=80e-6).severity_index().total == 0
    assert oil(entry=0.0).dents().number == 0
    assert math.isnan(oil(film=80e-6).dents().depth)
    assert oil(entry=0.0).after(1e9) == 0


def test_brittle_particles():
    whole = oil(debris="brittle", fragment=80e-6).dents()
    np.testing.assert_allclose(astuple(whole), astuple(oil().dents()), rtol=1e-12)
    gone = oil(debris="brittle", fragment=0.4e-6)
    assert gone.dents().number == 0
    fine = oil(debris="brittle", fragment=1e-6)
    # every particle of the code is larger than its fragments: volumes add
    assert fine.dents().number == pytest.approx(
        fine.columns_of_oil * fine.diameter.moment(3) / 1e-18, rel=1e-12
    )
    assert fine.dents().depth < 0.5e-6
    mixed = oil(debris="brittle", fragment=8e-6)
    rng = np.random.default_rng(2)
    x = mixed.diameter.sample(rng, 300_000)
    counts = co.fragments(x, size=8e-6)
    deep = co.dent_of(mixed.single(np.minimum(x, 8e-6)), side=0, particle=SILICA).depth[:, 0]
    assert mixed.dents().depth == pytest.approx(np.average(deep, weights=counts), rel=5e-3)


def test_ductile_particles():
    flat = oil(debris="ductile").dents()
    x = oil().diameter.sample(np.random.default_rng(3), 300_000)
    wide = np.minimum(co.flattened_diameter(x, gap=0.5e-6), widest_disc(1.0, 1.0) * x)
    assert np.any(wide < co.flattened_diameter(x, gap=0.5e-6))
    assert flat.diameter == pytest.approx(wide.mean(), rel=1e-2)
    assert flat.diameter_p95 == pytest.approx(np.quantile(wide, 0.95), rel=2e-2)
    assert math.isnan(flat.depth)
    assert math.isnan(flat.volume)
    assert math.isnan(oil(debris="ductile").severity_index().total)


@pytest.mark.parametrize("ratio", [1.0, 0.5])
def test_steel_debris_is_flattened_and_says_so(ratio):
    """Not harder than the surface: footprints as of ductile particles, a reason, and no zeros."""
    H = oil().surfaces.first.H
    soft = oil(material=SILICA.replace(H=ratio * H))
    with warns_of("dents.flat.1"):
        found = soft.dents()
    flat = oil(debris="ductile", material=SILICA.replace(H=ratio * H)).dents()
    np.testing.assert_array_equal(found, flat)
    assert found.number > 0 < found.diameter
    assert math.isnan(found.depth)
    assert math.isnan(soft.severity_index().total)
    largest = soft.largest(1e-2)
    assert math.isnan(largest.depth)
    assert largest.diameter > found.diameter
    kept = oil(material=SILICA.replace(H=H), debris="hard").dents()
    assert kept.depth > 0 < kept.volume


@pytest.mark.parametrize(
    ("options", "refusal"),
    [
        ({"debris": "brittle"}, refuses(Mistake.MISSING, "FilmParticles.fragment", value="None")),
        ({"fragment": 1e-6}, refuses(Mistake.MISSING, "FilmParticles.fragment", value="1e-06")),
        ({"slip": 1e-6}, refuses(Mistake.MISSING, "FilmParticles.f_ab")),
        ({"film": 0.0}, refuses(Mistake.RANGE, "FilmParticles.film", value="0.0")),
        ({"entry": -1.0}, refuses(Mistake.RANGE, "FilmParticles.entry", value="-1.0")),
        ({"surfaces": STEEL}, refuses(Mistake.KIND, "FilmParticles.surfaces")),
    ],
)
def test_refusals(options, refusal):
    with refusal:
        oil(**options)
    with refuses(Mistake.OPTION, "side", value="3"):
        oil().dents(3)


def test_entry_has_no_default():
    with pytest.raises(TypeError, match="entry"):
        oil_particles.FilmParticles.from_iso4406(
            "18/16/13", surfaces=PAIR, material=SILICA, film=1e-6
        )


def test_the_embedded_share_is_that_of_the_sizes():
    """Whoever is larger than the size that sits half its radius deep."""
    sizes = tb.TruncatedGaussian(mean=0.8e-6, std=0.15e-6)
    film = oil_particles.FilmParticles(diameter=sizes, number=1e15, **ONE)

    def deep(x):
        return 2 * film.single(x).depths[0][0, 0] - 0.5 * x

    size = optimize.brentq(deep, 1.01 * film.film, 3e-6, xtol=1e-18)
    first = optimize.brentq(
        lambda x: film.single(x).depths[0][0, 0] / x - film.single(x).yields[0], 0.5001e-6, 0.7e-6
    )
    share = sizes.partial_moment(0, size, 9e-6) / sizes.partial_moment(0, first, 9e-6)
    assert film.dents().embedded == pytest.approx(float(share), rel=1e-9)


# ------------------------------------------------------------------ particles that break
QUARTZ = tb.materials["quartz"]
BEARING = tb.Material(E=206e9, nu=0.29, H=7.37e9)
HARD = dict(
    surfaces=tb.MaterialPair(BEARING, BEARING), material=QUARTZ, film=1e-6, entry=1.0, deep="off"
)


def strong(fragments="footprint", **changes):
    numbers = dict(sigma_0=67e6, x_0=1e-3, m=3.0, size_exponent=0.55, x_c=0.96e-6)
    return tb.grains.WeibullStrength(**numbers | changes, fragments=fragments)


def breaking(sizes, strength, **options):
    with warns_of(f"strength.sizes.{HARD['material'].name}"):
        return oil_particles.FilmParticles(
            diameter=sizes, number=1e12, strength=strength, **(HARD | options)
        )


@pytest.mark.parametrize("fragments", ["gone", "footprint", "all"])
def test_particles_of_one_size_break_in_the_film(fragments):
    """Generation by generation: N_k S_k P_k whole pieces of κ^k x."""
    strength, x, kept = strong(fragments), 20e-6, {"gone": 0.0, "footprint": 0.5, "all": 1.0}
    film = breaking(tb.distributions.Monodisperse(mean=x), strength)
    one = tb.particle.Series(deep="off", soft="sphere").one(surfaces=film.surfaces, particle=QUARTZ)
    met = tension(one, QUARTZ.nu, "sphere")
    number, arrived, y, whole = 0.0, 1.0, x, []
    while y > film.film and arrived > 0:
        stress = float(met.greatest_so_far(np.array([1 - film.film / y]))[0])
        survival = 1.0 if y <= strength.x_c else math.exp(-((stress / strength.of_size(y)) ** 3))
        whole.append((y, arrived * survival))
        arrived *= kept[fragments] * 8 * (1 - survival)
        y /= 2
    number = sum(n for _, n in whole)
    dents = film.dents()
    assert dents.number == pytest.approx(film.columns_of_oil * number, rel=1e-6)
    volume = sum(
        n * co.dent_of(film.single(size), side=0, particle=QUARTZ).volume[0, 0] for size, n in whole
    )
    assert dents.volume == pytest.approx(film.columns_of_oil * volume, rel=1e-6)
    assert film.broken_share == pytest.approx(1 - whole[0][1], rel=1e-6)


def test_particles_of_many_sizes_break_in_the_film():
    """Against grains that break one by one, each with its own luck."""
    strength, sizes = strong("all"), tb.LogNormal(median=4e-6, gsd=1.5)
    film = breaking(sizes, strength)
    dents = film.dents()
    one = tb.particle.Series(deep="off", soft="sphere").one(surfaces=film.surfaces, particle=QUARTZ)
    met = tension(one, QUARTZ.nu, "sphere")
    rng = np.random.default_rng(3)
    n = 40_000
    x, whole, broken = sizes.sample(rng, n), [], []
    while np.any(x > film.film):
        x = x[x > film.film]
        stress = met(1 - film.film / x)
        stays = rng.random(len(x)) < np.exp(-((stress / strength.of_size(x)) ** strength.m))
        stays |= x <= strength.x_c
        whole.append(x[stays])
        broken.append(1 - np.mean(stays))
        x = np.repeat(x[~stays] / 2, 8)
    sizes_there = np.concatenate(whole)
    error = 5 / math.sqrt(len(sizes_there) / 8)
    assert dents.number / film.columns_of_oil == pytest.approx(len(sizes_there) / n, rel=error)
    depth = co.dent_of(film.single(sizes_there), side=0, particle=QUARTZ).depth
    assert dents.depth == pytest.approx(depth.mean(), rel=error)
    assert np.mean(depth > dents.depth_p95) == pytest.approx(0.05, rel=5 * error)
    assert film.broken_share == pytest.approx(broken[0], abs=0.01)


def test_a_strength_that_breaks_nothing():
    """All that dents is as without a strength."""
    sizes = tb.TruncatedGaussian(mean=3e-6, std=0.6e-6)
    plain = oil_particles.FilmParticles(diameter=sizes, number=1e12, **HARD)
    never = breaking(sizes, strong(sigma_0=1e15))
    assert never.broken_share == 0
    for found in ("dents", "severity_index"):
        one, other = (getattr(film, found)() for film in (plain, never))
        assert astuple(other) == pytest.approx(astuple(one), rel=1e-9), found
    assert tuple(never.largest(1e-4)) == pytest.approx(tuple(plain.largest(1e-4)), rel=1e-9)
    assert plain.broken_share == 0


def test_broken_grains_leave_smaller_dents_and_more():
    sizes = tb.LogNormal(median=10e-6, gsd=1.3)
    whole = oil_particles.FilmParticles(diameter=sizes, number=1e12, **HARD).dents()
    gone, some, all_ = (breaking(sizes, strong(name)).dents() for name in FRAGMENTS)
    assert gone.number < whole.number < all_.number
    assert gone.number < some.number < all_.number
    assert all_.depth < whole.depth
    assert all_.depth_p95 < whole.depth_p95


FRAGMENTS = ("gone", "footprint", "all")


@pytest.mark.parametrize(
    ("fields", "refusal"),
    [
        ({"strength": "strong"}, refuses(Mistake.KIND, "FilmParticles.strength", value="'strong'")),
        (
            {"strength": strong(), "debris": "brittle", "fragment": 1e-6},
            refuses(Mistake.CLASH, "FilmParticles.strength"),
        ),
    ],
)
def test_mistakes_in_a_strength(fields, refusal):
    with refusal:
        oil_particles.FilmParticles(
            diameter=tb.distributions.Monodisperse(mean=5e-6), number=1.0, **(HARD | fields)
        )
