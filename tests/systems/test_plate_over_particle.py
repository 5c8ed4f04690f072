"""A plate over a particle: against the clamped plate, its energy, and the law of one particle."""

import math

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.systems.plate_over_particle import PlateOverParticle

SILICON = tb.Material(E=160e9, nu=0.22, H=12e9)


def chuck(**changed):
    given = dict(plate=SILICON, flat=tb.materials["S45C"], thickness=725e-6, pressure=1e5)
    given["law"] = tb.particle.Series(deep="off")
    return PlateOverParticle(**(given | changed))


def energy(plate, force, radius):
    """Potential of a plate clamped at ``radius`` under ``force`` up and the pressure down.

    Deflections of the clamped plate by a point load and by a pressure, Timoshenko: half the work.
    """
    D, p, b = plate.rigidity, plate.pressure, radius
    under_force, under_pressure = b**2 / (16 * math.pi * D), b**4 / (64 * D)
    work = force**2 * under_force - 2 * force * p * under_pressure
    return -0.5 * (work + p**2 * math.pi * b**6 / (192 * D))


@pytest.mark.parametrize("height", [1e-9, 1e-7, 5e-6])
def test_the_clamped_plate_of_that_radius_has_that_height(height):
    plate = chuck()
    bump = plate.bump(height)
    clamped = bump.force * bump.radius**2 / (16 * math.pi * plate.rigidity)
    clamped -= plate.pressure * bump.radius**4 / (64 * plate.rigidity)
    assert clamped == pytest.approx(height, rel=1e-12)


def test_the_radius_is_where_the_energy_is_level():
    plate = chuck()
    bump = plate.bump(1e-7)
    steps = np.array([-1e-3, 0.0, 1e-3]) * bump.radius
    low, here, high = (energy(plate, bump.force, bump.radius + step) for step in steps)
    slope = (high - low) / (2e-3 * bump.radius)
    assert abs(slope) < 1e-5 * abs(here) / bump.radius
    # a plate clamped nearer or farther is not in balance with the flat
    for wrong in (0.8, 1.25):
        b = wrong * bump.radius
        step = 1e-4 * b
        slope = energy(plate, bump.force, b + step) - energy(plate, bump.force, b - step)
        assert abs(slope) > 1e-6 * abs(here)


def test_deflection_solves_the_plate_equation():
    """w of the closed form: D∇⁴w = −p, and w, w′, w″ are zero at b."""
    plate = chuck()
    bump = plate.bump(1e-7)
    D, p, b = plate.rigidity, plate.pressure, bump.radius
    C = bump.force / (8 * math.pi * D)
    # the rest from w'(b) = w''(b) = 0
    B = -0.5 * (C * (2 * math.log(b) + 1) - p * b**2 / (16 * D))

    def w(r):
        return bump.height + B * r**2 + C * r**2 * np.log(r) - p * r**4 / (64 * D)

    def slope(r):
        return 2 * B * r + C * r * (2 * np.log(r) + 1) - p * r**3 / (16 * D)

    def bend(r):
        return 2 * B + C * (2 * np.log(r) + 3) - 3 * p * r**2 / (16 * D)

    assert abs(w(b)) < 1e-12 * bump.height
    assert abs(slope(b)) < 1e-12 * bump.height / b
    assert abs(bend(b)) < 1e-10 * bump.height / b**2
    inside = np.linspace(0.01, 0.999, 200) * b
    assert np.all(w(inside) > 0)


def test_the_particle_carries_the_force_of_the_plate():
    plate, grit = chuck(), tb.materials["Al2O3"]
    for x in (1e-6, 1e-5, 3e-5, 1e-4):
        bump = plate.over(x, grit)
        pair = tb.MaterialPair(SILICON, tb.materials["S45C"])
        one = plate.law.single(x, bump.height, surfaces=pair, particle=grit)
        assert float(one["force"]) == pytest.approx(bump.force, rel=1e-9)
        assert 0 < bump.height < x
        assert bump.squeeze == pytest.approx(x - bump.height, rel=1e-12)


def test_an_embedded_particle_by_hand():
    """f_max²/(16 π² p D) with f_max = π/4 H x²: goes with x⁴H²."""
    plate = chuck()
    for x in (1e-6, 1e-5, 3e-5):
        most = math.pi / 4 * 5e9 * x**2
        expected = most**2 / (16 * math.pi**2 * 1e5 * plate.rigidity)
        found = plate.over(x, tb.materials["SiO2"]).height
        assert found == pytest.approx(expected, rel=1e-9)


def test_a_stiff_particle_on_hard_bodies_lifts_by_nearly_its_size():
    hard = tb.Material(E=1e12, nu=0.2, H=100e9)
    plate = chuck(plate=hard, flat=hard, thickness=50e-6, pressure=1e3)
    bump = plate.over(20e-6, tb.Material(E=1e12, nu=0.2, H=100e9))
    assert 0.9 * 20e-6 < bump.height < 20e-6


def test_thin_or_not():
    assert chuck().bump(1e-6).thin
    assert not chuck().bump(1e-12).thin
