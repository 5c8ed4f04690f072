"""Waviness: rigid, measured and elastic waves under the roughness."""

import math

import numpy as np
import pytest
from refusals import Mistake, Status, balances_not, refuses

import thirdbody as tb
from thirdbody.systems.waviness import elastic_wave, measured_wave, rigid_wave

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
# GW, Gaussian, ηRσ_s = 0.05, σ_s/R = 0.01: d/σ_s, a_w/σ_s; p/E*
RIGID = [
    (1, 0.0, 0.00050445451594),
    (1, 0.5, 0.000618192440062),
    (1, 1.5, 0.00160465152462),
    (2, 0.0, 4.43211841572e-05),
    (2, 0.5, 6.52767189359e-05),
    (2, 1.5, 0.000316918274277),
    (3, 0.0, 1.75978369513e-06),
    (3, 0.5, 3.32588674502e-06),
    (3, 1.5, 3.41125764446e-05),
]


def reference_contact():
    sigma_s, R = 10e-9, 1e-6
    rough = tb.Roughness(sigma=sigma_s / math.sqrt(1 - 0.8968 / 5), R=R, eta=0.05 / (R * sigma_s))
    surfaces = tb.MaterialPair(STEEL, STEEL)
    law = tb.asperity.GW()
    return tb.Contact(surfaces=surfaces, roughness=rough, asperity_law=law), rough.sigma_s


def dirty_contact():
    return tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(
            material=SILICA,
            areal_density=1e11,
            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
        ),
        particle_law=tb.particle.Series(deep="off"),
    )


@pytest.mark.parametrize(("h", "amplitude", "P"), RIGID)
def test_rigid_values(h, amplitude, P):
    contact, s = reference_contact()
    wavy = rigid_wave(contact, amplitude=amplitude * s, d=h * s)
    assert wavy.F_star == pytest.approx(P, rel=1e-11)
    back = rigid_wave(contact, amplitude=amplitude * s, F_star=wavy.F_star)
    assert back.d == pytest.approx(h * s, abs=1e-13 * s)
    # the same wave as a histogram of its heights
    heights = amplitude * s * np.cos(2 * np.pi * np.arange(64) / 64)
    for given in ({"d": h * s}, {"pressure": wavy.pressure}):
        measured = measured_wave(contact, heights=heights, **given)
        assert measured.F_star == pytest.approx(P, rel=1e-11)
        assert measured.d == pytest.approx(h * s, abs=1e-12 * s)
        assert measured.stiffness == pytest.approx(wavy.stiffness, rel=1e-10)


@pytest.mark.parametrize("wavelength", [0.0, 1e-3])
def test_without_amplitude_it_is_the_flat_contact(wavelength):
    contact = dirty_contact()
    wavy = elastic_wave(contact, amplitude=0.0, wavelength=wavelength, pressure=5e6)
    flat = tb.solve(contact, pressure=5e6)
    for name in ("d", "A_t", "A_ss", "A_sa", "particle_load_share"):
        assert getattr(wavy, name) == pytest.approx(getattr(flat, name), rel=1e-10), name


def test_small_amplitude_acts_in_second_order():
    contact = dirty_contact()
    flat = tb.solve(contact, pressure=5e6)
    shift = [rigid_wave(contact, amplitude=a, pressure=5e6).d - flat.d for a in (1e-9, 2e-9)]
    assert shift[1] / shift[0] == pytest.approx(4, rel=1e-3)


def test_elastic_wave_solves_its_equation():
    """Against the Fourier series on a full period, with the gap taken between the nodes."""
    contact = dirty_contact()
    a, wavelength = 200e-9, 1e-4
    wavy = elastic_wave(contact, amplitude=a, wavelength=wavelength, pressure=5e6)
    assert np.mean(wavy.local_pressure) == pytest.approx(5e6, rel=1e-12)
    assert wavy.local_pressure == pytest.approx(tb.solve(contact, d=wavy.gap).pressure, rel=1e-11)
    theta = 2 * np.pi * np.concatenate([wavy.x, 1 - wavy.x[::-1]])
    p = np.concatenate([wavy.local_pressure, wavy.local_pressure[::-1]])
    u = np.zeros_like(wavy.gap)
    for k in range(1, 30):
        wave = 2 * np.mean(p * np.cos(k * theta))
        u += 2 * wave / (contact.E_ss * 2 * np.pi * k / wavelength) * np.cos(k * theta[: len(u)])
    gap = wavy.d - a * np.cos(theta[: len(u)]) + u
    assert wavy.gap == pytest.approx(gap, abs=1e-11 * a)


def test_elastic_wave_between_rigid_and_flat():
    contact, s = reference_contact()
    amplitude = 1.5 * s
    rigid = rigid_wave(contact, amplitude=amplitude, d=s)
    flat = tb.solve(contact, d=s)
    loads, areas = [], []
    for wavelength in (1e-12, 1e-7, 1e-5, 1e-4, 1e-3, 1.0):
        wavy = elastic_wave(contact, amplitude=amplitude, wavelength=wavelength, d=s)
        loads.append(wavy.pressure)
        areas.append(wavy.A_t)
    assert np.all(np.diff(loads) < 0)
    assert np.all(np.diff(areas) < 0)
    assert loads[0] == pytest.approx(rigid.pressure, rel=1e-6)
    assert loads[-1] == pytest.approx(flat.pressure, rel=1e-6)


def test_full_closure():
    contact, s = reference_contact()
    a, wavelength = 1.5 * s, 1e-2
    wavy = elastic_wave(contact, amplitude=a, wavelength=wavelength, F_star=5e-4)
    swing = math.pi * contact.E_ss * a / wavelength
    assert swing < 0.05 * wavy.pressure
    expected = wavy.pressure + swing * np.cos(2 * np.pi * wavy.x)
    # the rest is the compliance of the roughness over that of the wave
    assert wavy.local_pressure == pytest.approx(expected, abs=0.01 * swing)
    assert np.ptp(wavy.gap) < 0.01 * a


def test_stiffness_is_the_slope_of_the_load():
    contact = dirty_contact()
    given = {"amplitude": 200e-9, "wavelength": 1e-4}
    wavy = elastic_wave(contact, d=200e-9, **given)
    step = 0.02e-9
    high, low = (elastic_wave(contact, d=wavy.d + dx, **given).pressure for dx in (step, -step))
    assert wavy.stiffness == pytest.approx((low - high) / (2 * step), rel=1e-6)


def test_histogram_counts_and_plain_law():
    def law(gap):
        p = np.exp(-gap)
        return p, -p

    twice = measured_wave(law, heights=[0, 0, 1], d=0.5, E_star=1.0)
    counted = measured_wave(law, heights=[0, 1], counts=[2, 1], d=0.5, E_star=1.0)
    assert counted.pressure == pytest.approx(twice.pressure, rel=1e-15)
    # an exponential law on a cosine wave: the modified Bessel function I_0
    wavy = rigid_wave(law, amplitude=2.0, d=3.0, E_star=1.0)
    assert wavy.pressure == pytest.approx(np.exp(-3.0) * np.i0(2.0), rel=1e-12)
    assert wavy.A_t is None


def test_mistakes():
    contact, s = reference_contact()
    with refuses(Mistake.RANGE, "amplitude", value="-1e-09"):
        rigid_wave(contact, amplitude=-1e-9, d=0.0)
    with refuses(Mistake.CLASH, "", says="d, pressure, F_star"):
        rigid_wave(contact, amplitude=1e-9, pressure=1e6, F_star=1e-5)
    with refuses(Mistake.MISSING, "", says="d, pressure, F_star"):
        measured_wave(contact, heights=[0.0, 1e-9])
    with refuses(Mistake.SHAPE, "", says="counts"):
        measured_wave(contact, heights=[0.0, 1e-9], counts=[1.0], d=0.0)
    with balances_not(Status.TOO_DEEP, says="-3 sigma_s"):
        rigid_wave(contact, amplitude=10 * s, d=0.0)
    with balances_not(Status.TOO_DEEP, says="-3 sigma_s"):
        measured_wave(contact, heights=[0.0, 10 * s], d=0.0)
