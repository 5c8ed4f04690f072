"""A prescribed sum within a box, on surfaces that yield nearly everywhere and anywhere else."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import thirdbody as tb
from thirdbody.explicit.box import pressures_with_sum, rescale


@pytest.mark.parametrize("seed", range(60))
def test_the_sum_is_the_total_and_the_shift_is_common(seed):
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 400))
    cap = np.where(rng.random(count) < rng.random(), 1e30, 10.0 ** rng.uniform(-3, 3, count))
    if seed % 3 == 0:
        cap[:] = 1.0  # all corners at a few places, as where every pixel yields
    moved = rng.choice([0.0, 1.0, 0.5, -1.0, 2.0], count) * np.minimum(cap, 10.0)
    moved += rng.normal(size=count) * 10.0 ** rng.uniform(-12, 1)
    tilt = rng.random(count) * 10.0 ** rng.uniform(-6, 6, count)
    total = float(np.sum(np.minimum(cap, 10.0))) * 10.0 ** rng.uniform(-4, -0.01)

    def lack(nu):
        return math.fsum(np.clip(moved + nu * tilt, 0.0, cap)) - total

    now = pressures_with_sum(moved, tilt, cap, total)
    assert math.fsum(np.clip(now, 0.0, cap)) == pytest.approx(total, rel=1e-12)
    span = float(np.max((np.minimum(cap, 10.0) + np.abs(moved)) / tilt))
    nu = brentq(lack, -span, span, xtol=1e-300, rtol=1e-15)
    expected = np.clip(moved + nu * tilt, 0.0, cap)
    np.testing.assert_allclose(np.clip(now, 0.0, cap), expected, rtol=1e-9, atol=1e-9 * total)


@pytest.mark.parametrize("seed", range(20))
def test_a_pattern_is_brought_to_the_sum(seed):
    rng = np.random.default_rng(seed)
    cap, most = rng.random((8, 8)) * (rng.random((8, 8)) < 0.7), rng.random(3)
    p, phi = np.minimum(rng.random((8, 8)), cap), np.minimum(rng.random(3), most)
    total = rng.random() * float(np.sum(cap) + np.sum(most))
    p, phi = rescale(p, phi, cap, most, total)
    assert np.sum(p) + np.sum(phi) == pytest.approx(total, rel=1e-11)
    assert np.all((p >= 0) & (p <= cap * (1 + 1e-12)))
    assert np.all((phi >= 0) & (phi <= most * (1 + 1e-12)))


@pytest.mark.parametrize("seed", range(25))
@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
def test_a_state_at_a_load_carries_that_load(seed):
    """Rough steel that yields nearly everywhere, down to chi = H/(E* g) of 0.001."""
    rng = np.random.default_rng(seed)
    count, spacing, E = 32, 1e-7, 210e9
    E_star, H = E / 1.82, E * 10.0 ** rng.uniform(-3.3, -1)
    wave = np.hypot(np.fft.fftfreq(count)[:, None], np.fft.fftfreq(count)[None])
    inside = (wave >= 2 / count) & (wave <= 1 / 12)
    spectrum = np.where(inside, np.maximum(wave, 1e-9) ** -1.8, 0.0)
    z = np.fft.ifft2(np.fft.fft2(rng.standard_normal((count, count))) * spectrum).real
    z = (z - z.mean()) * spacing * 10.0 ** rng.uniform(-1.5, 0.6) / z.std()
    body = tb.Material(E=E, nu=0.3, H=H)
    contact = tb.Contact(
        surfaces=tb.MaterialPair(body, body), roughness=tb.Roughness(sigma=float(z.std()), R=1e-6)
    )
    F_star = 10.0 ** rng.uniform(-2.5, -0.7) * H / E_star
    state = tb.explicit.solve(contact, z, spacing=spacing, F_star=F_star)
    assert state.converged
    assert state.F_star == pytest.approx(F_star, rel=1e-9)
