"""Dust between two solids: compound Poisson sums against closed forms and drawn particles."""

import math

import numpy as np
import pytest
from refusals import Mistake, refuses

import thirdbody as tb
from thirdbody.systems.contact_probability import ContactProbability

STEEL = tb.materials["S45C"]
PAIR = tb.MaterialPair(STEEL, STEEL)


def closing(number, sizes=None, *, law=None, material="SiO2"):
    sizes = sizes or tb.distributions.Monodisperse(mean=10e-6)
    radius = 4e-3
    law = law or tb.particle.Series(deep="off")
    return ContactProbability(
        radius=radius,
        surfaces=PAIR,
        particles=tb.Particles(
            material=tb.materials[material],
            diameter=sizes,
            areal_density=number / (2 * math.pi * radius * sizes.moment(1)),
        ),
        law=law,
    )


@pytest.mark.parametrize("number", [0.01, 0.25, 1.0, 3.0, 30.0])
def test_without_load_only_clean_places_touch(number):
    assert closing(number).probability(0.0) == pytest.approx(math.exp(-number), rel=1e-12)


def test_a_heavy_load_always_touches():
    for number in (0.25, 3.0, 100.0, 1000.0):
        dust = closing(number)
        low, high = dust.bounds((20 + 2 * number) * dust.threshold)
        assert 1 - 1e-9 < low
        assert high <= 1
        assert low <= high + 1e-12


def test_the_load_of_an_embedded_particle():
    """f_max = π/4 H x² of the softer body, and the area W/H is the cross-section."""
    dust = closing(1.0)
    assert dust.threshold == pytest.approx(math.pi / 4 * STEEL.H * (10e-6) ** 2, rel=1e-12)


def test_one_particle_at_most_below_its_load():
    """P(W < f_max) to first order in N: e^{-N} (1 + N G(W))."""
    number = 1e-4
    dust = closing(number)
    for part in (0.1, 0.5, 0.9):
        load = part * dust.threshold
        expected = math.exp(-number) * (1 + number * float(dust.of_one(load)))
        assert dust.probability(load) == pytest.approx(expected, rel=1e-7)


def irwin_hall(n, w):
    """Volume of the part of the n-cube where the sum is at most w."""
    if n == 0:
        return float(w >= 0)
    if w <= 0:
        return 0.0
    terms = ((-1) ** k * math.comb(n, k) * (w - k) ** n for k in range(min(n, int(w)) + 1))
    return min(1.0, math.fsum(terms) / math.factorial(n))


def plastic(number, w):
    """The same with f = f_max min(1, 2 ε): half the particles at their most, half even below."""
    total = 0.0
    for n in range(41):
        ways = sum(
            math.comb(n, j) * 0.5**n * irwin_hall(n - j, w - j) for j in range(n + 1) if j <= w
        )
        total += math.exp(-number) * number**n / math.factorial(n) * ways
    return total


class Plastic:
    """Load per size squared of a particle whose both sides are plastic."""

    kinks = (0.5,)

    def at(self, eps):
        from types import SimpleNamespace

        return SimpleNamespace(load=np.minimum(2 * np.asarray(eps), 1.0))


class PlasticDust(ContactProbability):
    _one = Plastic()


def test_plastic_particles_of_one_size():
    """Against the closed sum over numbers and embedded ones, in units of f_max."""
    for number in (0.25, 1.0, 3.0):
        like = closing(number)
        dust = PlasticDust(radius=like.radius, surfaces=PAIR, particles=like.particles)
        unit = dust.threshold
        for w in (0.5, 1 - 1e-9, 1.0, 1.5, 2 - 1e-9, 2.0, 3.0):
            low, high = dust.bounds(w * unit)
            expected = plastic(number, w)
            assert low - 1e-9 <= expected <= high + 1e-9, (number, w)
            assert high - low < 2e-3


def test_the_jump_at_the_load_of_one_particle():
    """P rises by at least e^{-N} N times the share of embedded particles."""
    number = 1.0
    dust = closing(number)
    below, at = dust.probability([dust.threshold * (1 - 1e-6), dust.threshold])
    embedded = 1 - float(dust.of_one(dust.threshold * (1 - 1e-9)))
    assert at - below >= 0.999 * math.exp(-number) * number * embedded > 0.1


@pytest.mark.spread(2)
@pytest.mark.parametrize(
    "sizes",
    [
        tb.distributions.Monodisperse(mean=8e-6),
        tb.LogNormal(median=8e-6, gsd=1.5),
        tb.distributions.Uniform(low=4e-6, high=12e-6)
        if hasattr(tb, "Uniform")
        else tb.distributions.Weibull(scale=8e-6, shape=3.0),
        tb.distributions.Mixture(
            parts=(tb.distributions.Monodisperse(mean=5e-6), tb.LogNormal(median=12e-6, gsd=1.2)),
            weights=(0.7, 0.3),
        ),
    ],
    ids=["one size", "log-normal", "broad", "mixture"],
)
def test_against_drawn_particles(sizes):
    """Particles thrown on the flat; the sphere's gap over each place, its load by the law."""
    dust = closing(1.3, sizes, material="Al2O3")
    rng = np.random.default_rng(20)
    draws = 40_000
    largest = sizes.support[1]
    disc = 2 * dust.radius * largest  # square of the radius within which any can be in the way
    count = rng.poisson(math.pi * disc * dust.particles.areal_density, draws)
    of = np.repeat(np.arange(draws), count)
    gap = rng.uniform(0, disc, len(of)) / (2 * dust.radius)
    x = sizes.sample(rng, len(of))
    response = dust.law.single(x, gap, surfaces=PAIR, particle=dust.particles.material)
    carried = np.bincount(of, response["force"], minlength=draws)
    for load in np.array([0.02, 0.3, 0.8, 1.7, 4.0]) * dust.threshold:
        low, high = dust.bounds(load)
        found = np.mean(carried <= load)
        error = 4 * math.sqrt(max(found * (1 - found), 1e-4) / draws)
        assert low - error <= found <= high + error, load


def test_scales():
    """Twice all lengths and the same number in the way: the same at four times the load."""
    one, two = closing(0.8), closing(0.8, tb.distributions.Monodisperse(mean=20e-6))
    loads = np.array([0.05, 0.2, 0.4])
    assert two.probability(4 * loads) == pytest.approx(one.probability(loads), rel=1e-9)


def test_the_bounds_hold_each_other_and_rise():
    dust = closing(2.0, tb.LogNormal(median=8e-6, gsd=1.4))
    loads = np.geomspace(1e-2, 10, 30)
    low, high = dust.bounds(loads)
    assert np.all(low <= high + 1e-12)
    assert np.all(np.diff(dust.probability(loads)) > -1e-9)
    assert dust.bounds(loads.reshape(5, 6))[0].shape == (5, 6)


def test_more_particles_than_a_factorial_holds():
    """e^{-N} is no number any more; the sum is."""
    dust = closing(1500.0)
    mean = 1500 * dust.threshold * 0.75
    low, high = dust.bounds(np.array([0.5, 1.5]) * mean)
    assert high[0] < 1e-9
    assert low[1] > 1 - 1e-9


@pytest.mark.parametrize("load", [-1.0, float("nan"), float("inf")])
def test_loads_that_are_none(load):
    with refuses(Mistake.RANGE, "load"):
        closing(1.0).probability(load)


def test_boulders_and_broken_particles_are_refused():
    with refuses(Mistake.ORDER, "radius", value="5 µm"):
        ContactProbability(radius=5e-6, surfaces=PAIR, particles=closing(1.0).particles)
    strong = tb.grains.WeibullStrength.of(tb.materials["quartz"])
    breaks = closing(1.0, material="quartz").particles.replace(strength=strong)
    with pytest.raises(tb.errors.InvalidValue, match="break"):
        ContactProbability(radius=4e-3, surfaces=PAIR, particles=breaks)


def test_angular_particles_sink_in_more_easily():
    """Faces carry less than a sphere until they are embedded: solids touch more often."""
    round_ones = closing(1.0, material="Al2O3")
    grit = tb.grains.Angular(roundness=0.3, angle="60 deg")
    faced = ContactProbability(
        radius=round_ones.radius,
        surfaces=PAIR,
        particles=round_ones.particles.replace(shape=grit),
        law=round_ones.law,
    )
    load = 0.3 * round_ones.threshold
    assert faced.probability(load) > round_ones.probability(load) + 0.01
