"""A plate on a chuck: against the plate over one particle, its limits, and drawn dust."""

import math

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.laws.particle.tension import tension
from thirdbody.populations.strength import WeibullStrength
from thirdbody.systems.chuck import Chuck

SILICON = tb.Material(E=160e9, nu=0.22, H=12e9)
STEEL = tb.materials["S45C"]
SIZES = tb.LogNormal(median=3e-6, gsd=1.8)


def dust(sizes=SIZES, material="SiO2", number=1e4, **more):
    return tb.Particles(
        material=tb.materials[material], diameter=sizes, areal_density=number, **more
    )


def chuck(*kinds, **changed):
    given = dict(surfaces=tb.MaterialPair(SILICON, STEEL), thickness=725e-6, pressure=1e5)
    given |= dict(particles=kinds or (dust(),), law=tb.particle.Series(deep="off"))
    return Chuck(**(given | changed))


def test_a_soft_chuck_takes_the_particle_in():
    """π/4 H x² carries 4π√(p D h): the height goes with x⁴ H²."""
    plate = chuck()
    D = 160e9 * (725e-6) ** 3 / (12 * (1 - 0.22**2))
    for x in (2e-6, 2e-5):
        by_hand = (math.pi / 4 * STEEL.H * x**2) ** 2 / (16 * math.pi**2 * 1e5 * D)
        assert plate.over(x, dust()).height == pytest.approx(by_hand, rel=1e-9)
    assert plate.lifting(by_hand) == pytest.approx(2e-5, rel=1e-9)


def test_bodies_that_do_not_give_way_stand_on_the_diameter():
    hard = tb.Material(E=1e12, nu=0.2, H=100e9)
    foil = chuck(surfaces=tb.MaterialPair(hard, hard), thickness=20e-6, pressure=100.0)
    bump = foil.over(20e-6, dust().replace(material=hard))
    assert 0.97 * 20e-6 < bump.height < 20e-6


def test_the_particle_of_a_height_has_that_height():
    plate = chuck(dust(material="Al2O3"))
    for height in (1e-10, 50e-9, 3e-6):
        x = plate.lifting(height)
        assert plate.over(x, plate.particles[0]).height == pytest.approx(height, rel=1e-9)


def test_bumps_are_the_particles_larger_than_that():
    hard = tb.MaterialPair(SILICON, tb.materials["SiC"])
    plate = chuck(surfaces=hard, diameter=0.3, limit=10e-9)
    x = plate.lifting(10e-9)
    rng = np.random.default_rng(4)
    share = np.mean(SIZES.sample(rng, 400_000) > x)
    expected = math.pi / 4 * 0.3**2 * 1e4 * share
    assert plate.bumps_above(10e-9) == pytest.approx(expected, rel=0.01)


def test_pins_and_kinds_of_dust_add_up():
    whole = chuck(diameter=0.3)
    count = whole.bumps_above(20e-9)
    assert chuck(diameter=0.3, touching=0.02).bumps_above(20e-9) == pytest.approx(0.02 * count)
    twice = chuck(dust(name="a"), dust(name="b"), diameter=0.3)
    assert twice.bumps_above(20e-9) == pytest.approx(2 * count, rel=1e-12)
    assert chuck(diameter=0.15).bumps_above(20e-9) == pytest.approx(count / 4, rel=1e-12)


def test_a_brittle_grain_breaks_and_a_small_or_soft_one_does_not():
    quartz = dust(material="quartz")
    plate = chuck(quartz, surfaces=tb.MaterialPair(SILICON, tb.materials["SiC"]))
    assert plate.breaks(plate.over(20e-6, quartz), quartz)
    assert not plate.breaks(plate.over(0.2e-6, quartz), quartz)
    soft = dust(material="Al6061-T6")
    assert not plate.breaks(plate.over(20e-6, soft), soft)


def test_a_strength_of_its_own_decides_from_which_size_on_a_grain_breaks():
    """That of the material changes nothing; with one of the squeeze's own tension it just breaks."""
    quartz = dust(material="quartz")
    known = WeibullStrength.of(quartz.material)
    pair = tb.MaterialPair(SILICON, tb.materials["SiC"])
    for x in (0.2e-6, 20e-6):
        own = quartz.replace(strength=known)
        plain, told = chuck(quartz, surfaces=pair), chuck(own, surfaces=pair)
        bump = plain.over(x, quartz)
        assert told.over(x, own) == bump  # heights are those of whole grains
        assert told.breaks(bump, own) == plain.breaks(bump, quartz)
    bump = chuck(quartz, surfaces=pair).over(20e-6, quartz)
    diameter = bump.height + bump.squeeze
    one = chuck(quartz, surfaces=pair)._law(quartz).one(surfaces=pair, particle=quartz.material)
    stress = tension(one, quartz.material.nu, known.confinement)
    met = float(stress.greatest_so_far(np.array([bump.squeeze / diameter]))[0])
    for factor, breaks in ((0.99, True), (1.01, False)):
        strong = quartz.replace(
            strength=known.replace(sigma_0=known.sigma_0 * factor * met / known.of_size(diameter))
        )
        assert chuck(strong, surfaces=pair).breaks(bump, strong) is breaks
