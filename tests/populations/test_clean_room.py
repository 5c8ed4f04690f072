"""Dust from the air of a clean room: against the printed table, and Stokes by hand."""

import math

import pytest
from refusals import Mistake, refuses
from scipy import integrate

from thirdbody.populations.measured.clean_room import (
    airborne,
    read_class,
    settled_particles,
    settling_speed,
)
from thirdbody.study import check

TABLE = {
    1: {0.1: 10, 0.2: 2},
    3: {0.1: 1000, 0.2: 237, 0.3: 102, 0.5: 35, 1: 8},
    5: {0.1: 100_000, 0.2: 23_700, 0.3: 10_200, 0.5: 3520, 1: 832, 5: 29},
    7: {0.5: 352_000, 1: 83_200, 5: 2930},
    9: {0.5: 35_200_000, 1: 8_320_000, 5: 293_000},
}
"""Particles per m³ of at least so many µm, as tables of ISO 14644-1 print them."""


@pytest.mark.parametrize("iso_class", TABLE)
def test_the_printed_table(iso_class):
    for size, printed in TABLE[iso_class].items():
        found = float(airborne(size * 1e-6, iso_class=iso_class))
        assert found == pytest.approx(printed, rel=5e-3, abs=0.5)


def test_the_speed_of_a_falling_grain_is_that_of_stokes():
    """Weight against 3πμxv, for grains that are large against the path of molecules."""
    x, rho = 20e-6, 2650
    by_hand = rho * math.pi / 6 * x**3 * 9.80665 / (3 * math.pi * 18.2e-6 * x)
    assert float(settling_speed(x, density=rho)) == pytest.approx(by_hand, rel=0.01)
    # the slip of 1 µm that aerosol courses print
    slip = float(settling_speed(1e-6, density=1)) / (1e-12 * 9.80665 / (18 * 18.2e-6))
    assert slip == pytest.approx(1.16, abs=0.01)


@pytest.mark.parametrize("ends", [(0.5e-6, 5e-6), (2e-6, 40e-6)])
def test_what_settles_is_the_integral_of_speed_and_concentration(ends):
    number, sizes = settled_particles(
        6, exposure=3600.0, particle_density=2000.0, smallest=ends[0], largest=ends[1]
    )

    def rate(x, n=0):
        return x**n * settling_speed(x, density=2000.0) * 2.08 * airborne(x, iso_class=6) / x

    expected = 3600 * integrate.quad(rate, *ends, epsabs=0, epsrel=1e-10)[0]
    assert number == pytest.approx(expected, rel=1e-6)
    for low, high in ((ends[0], 2 * ends[0]), (0.5 * ends[1], ends[1])):
        part = 3600 * integrate.quad(rate, low, high, epsabs=0, epsrel=1e-10)[0]
        found = float(sizes.partial_moment(0, low, high))
        assert found == pytest.approx(part / expected, rel=2e-4)
    mean = integrate.quad(lambda x: rate(x, 1), *ends, epsabs=0, epsrel=1e-10)[0]
    assert sizes.mean_diameter == pytest.approx(3600 * mean / expected, rel=1e-5)


def test_ten_times_the_dust_a_class_higher_and_twice_in_twice_the_time():
    def number(iso_class, hours):
        return settled_particles(iso_class, exposure=3600.0 * hours, particle_density=2650.0)[0]

    assert number(7, 1) == pytest.approx(10 * number(6, 1), rel=1e-12)
    assert number(6, 2) == pytest.approx(2 * number(6, 1), rel=1e-12)


@pytest.mark.parametrize("value", [0, 10, -1, True, "clean", None, math.nan])
def test_classes_that_are_none(value):
    with refuses(Mistake.OPTION, "", says="ISO 14644-1"):
        read_class(value)


STUDY = {
    "surfaces": {"first": "S45C", "second": "S45C"},
    "roughness": {"sigma": "100 nm", "R": "10 um"},
    "load": {"pressure": "5 MPa"},
}


def particles(**changes):
    table = {"material": "quartz", "iso14644": 7, "exposure": "24 h"} | changes
    table = {key: value for key, value in table.items() if value is not None}
    return check(STUDY | {"particles": table})


def test_a_study_file_takes_the_class():
    dust = particles().contact.populations[0]
    number, sizes = settled_particles(7, exposure=86400.0, particle_density=2650.0)
    assert dust.areal_density == number
    assert dust.diameter == sizes
    assert "settles from still air" in " ".join(particles().assumed)
    assert "up to 5 µm" in " ".join(particles(largest="20 um").assumed)


@pytest.mark.parametrize(
    ("changes", "refusal"),
    [
        ({"exposure": None}, refuses(Mistake.MISSING, "particles.exposure")),
        ({"exposure": "8 mm"}, refuses(Mistake.UNIT, "particles.exposure", says='"8 mm"')),
        ({"iso14644": 12}, refuses(Mistake.OPTION, "particles.iso14644", says="12")),
        ({"areal_density": 1e9}, refuses(Mistake.CLASH, "particles.iso14644", value="7")),
        ({"material": "SiO2"}, refuses(Mistake.MISSING, "particles.particle_density")),
        ({"smallest": "9 um"}, refuses(Mistake.RANGE, "particles")),
        ({"gap": "1 um"}, refuses(Mistake.UNKNOWN, "particles.gap", value='"1 um"')),
    ],
)
def test_mistakes_of_a_study_file(changes, refusal):
    with refusal as told:
        particles(**changes)
    assert len(told.value.problems) == 1


def test_grains_of_another_density():
    heavy = particles(particle_density="5300 kg/m^3").contact.populations[0]
    light = particles().contact.populations[0]
    assert heavy.areal_density == pytest.approx(2 * light.areal_density, rel=1e-12)
    mean = light.diameter.mean_diameter
    assert heavy.diameter.mean_diameter == pytest.approx(mean, rel=1e-12)
