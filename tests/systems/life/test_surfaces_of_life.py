"""What a history does to surfaces, against brute force and against printed numbers."""

import math

import numpy as np
import pytest
from mpmath import mp, mpf, quad
from scipy.integrate import solve_ivp

import thirdbody as tb
from thirdbody.systems.life.surfaces import (
    RunningIn,
    archard_depth,
    ball_scar_radius,
    clip_gaussian,
    dent_roughness,
    variance_slope,
)


def test_clipped_gaussian_to_its_printed_digits():
    found = clip_gaussian(1.0)
    assert f"{found.wear:.7f} {found.sigma:.6f} {found.slope:.5f}" == "0.0833155 0.866653 -1.25000"


@pytest.mark.parametrize("level", [-1.5, 0.0, 0.7, 2.5])
def test_clipped_gaussian_against_integrals(level):
    mp.dps = 25

    def density(z):
        return mp.exp(-z * z / 2) / mp.sqrt(2 * mp.pi)

    def moment(n):
        body = quad(lambda z: z**n * density(z), [-mp.inf, level])
        return body + mpf(level) ** n * quad(density, [level, mp.inf])

    mean = moment(1)
    found = clip_gaussian(level)
    assert found.wear == pytest.approx(float(-mean), abs=1e-15)
    assert found.sigma == pytest.approx(float(mp.sqrt(moment(2) - mean**2)), rel=1e-13)


def test_the_slope_of_the_clipped_gaussian_is_that_of_the_exact_identity():
    step = 1e-5
    above, below, here = (clip_gaussian(1 + k * step) for k in (1, -1, 0))
    numerical = (below.sigma - above.sigma) / (below.wear - above.wear)
    assert here.slope == pytest.approx(numerical, rel=1e-8)


@pytest.fixture(scope="module")
def measured():
    """A rough surface of correlated heights [m]."""
    rng = np.random.default_rng(5)
    z = np.fft.irfft2(np.fft.rfft2(rng.normal(size=(96, 96))) * 0.1)
    return 1e-7 * (z + 0.3 * z**2)


@pytest.mark.parametrize("kind", ["tops", "even", "random", "valleys"])
def test_the_identity_holds_for_any_removal(measured, kind):
    z = measured
    removal = {
        "tops": (z > np.quantile(z, 0.9)).astype(float),
        "even": np.ones_like(z),
        "random": np.random.default_rng(3).random(z.shape),
        "valleys": (z < np.quantile(z, 0.2)).astype(float),
    }[kind]
    removal = removal / removal.mean()
    dw = 1e-14
    after = z - removal * dw
    exact = (after.var() - z.var() - dw**2 * removal.var()) / dw  # of first order
    assert variance_slope(z, removal=removal) == pytest.approx(exact, rel=1e-6, abs=1e-13)
    assert (kind == "even") == (abs(variance_slope(z, removal=removal)) < 1e-20)


def test_dent_roughness_to_its_printed_digits():
    found = dent_roughness(1.0, coverage=[0.1, math.log(3), 50.0])
    assert [f"{each:.6f}" for each in found] == ["0.171630", "0.333333", "0.288675"]


def test_dent_roughness_against_random_caps():
    rng = np.random.default_rng(11)
    size, radius, depth = 1200, 9.0, 0.4
    x, y = np.meshgrid(np.arange(size), np.arange(size), indexing="ij")
    z, count = np.zeros((size, size)), 3600
    window = int(radius) + 1
    for cx, cy in rng.uniform(0, size, (count, 2)):
        # edges wrap around
        i = np.arange(int(cx) - window, int(cx) + window + 1)
        j = np.arange(int(cy) - window, int(cy) + window + 1)
        square = (i[:, None] - cx) ** 2 + (j - cy) ** 2
        places = np.ix_(i % size, j % size)
        z[places] = np.where(square < radius**2, depth * (square / radius**2 - 1), z[places])
    c = count * math.pi * radius**2 / size**2
    assert 0.5 < c < 0.8
    assert z.std() == pytest.approx(float(dent_roughness(depth, coverage=c)), rel=0.01)
    assert x.shape == y.shape


def test_a_ball_wears_by_archard():
    a = float(ball_scar_radius(1e-6, R=9.5e-3, load=20.0, distance=1000.0, H=7.37e9))
    assert f"{a * 1e3:.6f} mm, {20 / (math.pi * a * a) / 1e6:.3f} MPa" == "0.425646 mm, 35.138 MPa"
    # dV/ds = K F/H with V = πa⁴/4R, step by step
    K, R, F, H = 1e-6, 9.5e-3, 20.0, 7.37e9
    done = solve_ivp(
        lambda s, a: K * F / H / (math.pi * a**3 / R), (1e-9, 1000.0),
        [float(ball_scar_radius(K, R=R, load=F, distance=1e-9, H=H))], rtol=1e-10, atol=1e-16,
    )  # fmt: skip
    assert done.y[0, -1] == pytest.approx(a, rel=1e-7)


def test_wear_of_a_plane_to_its_printed_digits_and_in_other_units():
    depth = archard_depth(1e-6, pressure=5e6, distance=0.1 * 3.6e6, H=2.5e9)
    assert f"{depth * 1e3:.3f} mm" == "0.720 mm"
    scale = (
        7.0  # lengths in a unit 7 times smaller: pressures fall as length^-1 at fixed mass, time
    )
    other = archard_depth(1e-6, pressure=5e6 / scale, distance=scale * 3.6e5, H=2.5e9 / scale)
    assert float(other) == pytest.approx(scale * float(depth), rel=1e-14)


def test_running_in_by_a_length_decays_and_by_the_identity_clips():
    run = RunningIn(sigma_end=60e-9, length=2e-7)
    done = solve_ivp(
        lambda w, s: run.slope(s[0], separation=0.0), (0, 1e-6), [1e-7], rtol=1e-11, atol=1e-20
    )
    assert done.y[0, -1] == pytest.approx(60e-9 + 40e-9 * math.exp(-5), rel=1e-9)
    # without an end, worn at the height of the cut: the clipped Gaussian
    clip = RunningIn(sigma_end=0.0, share_1=1.0)
    sigma_0, levels = 1e-7, np.linspace(2.0, 1.0, 2001)
    sigma, before = sigma_0 * clip_gaussian(2.0).sigma, clip_gaussian(2.0).wear
    for level in levels[1:]:
        middle = clip_gaussian(level + 0.00025)
        dw = clip_gaussian(level).wear - before
        h = sigma_0 * (level + 0.00025 + middle.wear)  # of the cut over the mean plane
        rate = clip.rate(
            middle.sigma * sigma_0, separation=h, wear=(1.0, 0.0), by_asperities=(1.0, 0.0)
        )
        sigma, before = sigma + rate * dw * sigma_0, before + dw
    assert sigma / sigma_0 == pytest.approx(0.866653, abs=2e-6)


def test_running_in_shares_the_roughness_of_two_surfaces():
    """Each of two Gaussian surfaces is worn at the mean height h σ_i²/σ²; their variances add."""
    h, sigma, share = 1.7e-7, 1e-7, 0.3
    run = RunningIn(sigma_end=0.0, share_1=share)
    rates = (2e-12, 5e-12)
    rng = np.random.default_rng(2)
    z1 = math.sqrt(share) * sigma * rng.normal(size=2_000_000)
    z2 = math.sqrt(1 - share) * sigma * rng.normal(size=2_000_000)
    touch = (np.abs(z1 + z2 - h) < 0.02 * sigma).astype(float)  # what touches at the separation
    change = sum(w * variance_slope(z, removal=touch) for w, z in zip(rates, (z1, z2), strict=True))
    found = run.rate(sigma, separation=h, wear=(0.0, 0.0), by_asperities=rates)
    assert 2 * sigma * found == pytest.approx(change, rel=0.02)


def test_bad_numbers_are_refused():
    with pytest.raises(tb.errors.InvalidValue, match="coverage"):
        dent_roughness(1e-6, coverage=-0.1)
    with pytest.raises(tb.errors.InvalidValue, match="one shape"):
        variance_slope(np.zeros(3), removal=np.zeros(2))
    with pytest.raises(tb.errors.InvalidValue, match="sigma_end"):
        RunningIn(sigma_end=-1e-9)
