"""The stiffness of patches at rest: elastic loading, bounds, and punches on explicit maps."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import ndtri

import thirdbody as tb
from thirdbody.explicit import surface_of
from thirdbody.laws.field.conduction import patch_remainder, patch_stiffness
from thirdbody.laws.field.formulas import load, stiffness
from thirdbody.laws.field.own import OwnSpectrum
from thirdbody.laws.field.spectrum import rolled_off
from thirdbody.laws.field.table import EDGE, TAU, field_of

H = np.array([0.7, 1.0, 1.5, 2.0, 3.0, 4.5])


@pytest.mark.parametrize("alpha", [3.0, 5.0, 15.0])
def test_elastic_patches_are_as_stiff_as_the_surface(alpha):
    """Edges of elastic patches carry nothing: what the load rises by is what punches carry.

    That the filter may change with the load makes the loaded surface stiffer, never softer.
    """
    surface = field_of(50.0, alpha)
    bare = surface.stiffness(H) / -load(surface, H, remains=False)[:, 1]
    assert np.all(bare < 1)
    assert np.all(bare > 0.86)
    whole = stiffness(surface, H, remains=True) / -load(surface, H, remains=True)[:, 1]
    assert whole == pytest.approx(1.0, abs=0.03)


def test_yielding_surfaces_load_less_stiffly_than_their_patches_are():
    surface = field_of(0.1, 5.0)
    assert np.all(surface.stiffness(H) > -1.5 * load(surface, H, remains=False)[:, 1])


def test_more_trial_forces_and_more_terms_change_nothing():
    low, tau = np.array([0.5, 2.0, 3.5]), np.array([0.6, 0.3, 0.1])
    spectrum = rolled_off(5.0)
    few = patch_stiffness(spectrum.series(400), low, tau)
    many = patch_stiffness(spectrum.series(1600), low, tau)
    assert few == pytest.approx(many, rel=1e-3)


def solved_directly(surface, h, terms: int):
    """κ at separations by the columns of the table there, without a table of κ."""
    columns = surface.columns(h)
    series, tau = surface.spectrum.series(terms), np.clip(columns[:, TAU], 0, 1)
    return patch_stiffness(series, h + columns[:, EDGE], tau)


@pytest.mark.parametrize("chi", [0.1, 0.41, 50.0])
def test_table_of_stiffness(chi):
    """Between its separations as solved there."""
    surface = field_of(chi, 5.0)
    h = np.array([0.33, 1.27, 3.1, 4.99])
    assert surface.stiffness(h) == pytest.approx(solved_directly(surface, h, 400), rel=5e-4)
    assert np.isnan(surface.stiffness(np.array([surface.lowest - 0.1]))[0])


@pytest.mark.spread(3)
@pytest.mark.parametrize(("alpha", "error"), [(2.5, 3e-3), (5.0, 0.01), (30.0, 0.025)])
@pytest.mark.parametrize("chi", [0.05, 1.0, 20.0])
def test_stiffness_beyond_the_table(alpha, chi, error):
    """It goes on to lone round patches, and where there are none to 0."""
    surface = field_of(chi, alpha)
    h = np.array([5.01, 5.5, 6.0, 7.0, 8.0, 10.0])
    assert surface.stiffness(h) == pytest.approx(solved_directly(surface, h, 3000), rel=error)
    far = surface.stiffness(np.array([20.0, 37.0, 38.0, 45.0, 1e4]))
    assert np.all(np.diff(far) <= 0)
    assert far[0] > 0
    assert np.all(far[3:] == 0)


def test_lone_patches_of_high_levels():
    """Far apart, patches are round and κ follows from their radii, K = 2E*Σa.

    Above a high level h they are as many as Nayak's excursions, N = m2 h e^(−h²/2)/((2π)^1.5 m0),
    and their heights, so a², are exponential: ⟨a⟩ = √π/2 · √⟨a²⟩.
    """
    h = 6.0
    number = h * math.exp(-h * h / 2) / (2 * math.pi) ** 1.5  # per m0/m2, ⟨q²⟩ = 2
    area = 0.5 * math.erfc(h / math.sqrt(2))
    radius = 0.5 * math.sqrt(math.pi) * math.sqrt(area / number / math.pi)
    found = patch_stiffness(rolled_off(5.0).series(1600), np.array([h]), np.array([0.0]))[0]
    assert 0.98 < found / (math.sqrt(2) * number * radius) < 1.0


def punched(touches, spacing):
    """Nominal stiffness over E* [1/m] of patches at rest: conjugate gradients on the half-space."""
    size = len(touches)
    q = np.hypot(np.fft.fftfreq(size)[:, None], np.fft.rfftfreq(size)) * 2 * np.pi / spacing
    with np.errstate(divide="ignore"):
        K = np.where(q > 0, 2 / q, 0.0)
    rough = np.where(q > 0, q / 2, np.pi / (size * spacing))

    def act(kernel, p):
        return np.where(touches, np.fft.irfft2(np.fft.rfft2(p) * kernel, s=p.shape), 0.0)

    p, r = np.zeros(touches.shape), np.where(touches, 1.0, 0.0)
    z = act(rough, r)
    d, rz = z, np.sum(r * z)
    for _ in range(200):
        Kd = act(K, d)
        step = rz / np.sum(d * Kd)
        p, r = p + step * d, r - step * Kd
        if np.max(np.abs(r)) < 1e-4:
            break
        z = act(rough, r)
        before, rz = rz, np.sum(r * z)
        d = z + rz / before * d
    return float(p.mean())


@pytest.mark.slow
@pytest.mark.parametrize(
    ("area", "tau", "least", "most"),
    [(0.1, 0.0, -0.03, 0.04), (0.1, 0.4, -0.03, 0.04), (0.3, 0.0, 0.07, 0.13)],
)
def test_explicit_patches(area, tau, least, most):
    """Flat punches in the shape of the highest parts of maps are so much stiffer than it says.

    Pixels cost 1 %. At an area of 0.3 patches have grown together, and it is 10 % low.
    """
    body = tb.Material(E=2e11, nu=0.3, H=5e9)
    case = tb.Contact(
        surfaces=tb.MaterialPair(body, body), roughness=tb.Roughness(sigma=3e-7, R=3e-6)
    )
    maps = [surface_of(case, size=512, spacing=1e-7, seed=seed) for seed in range(4)]
    own = OwnSpectrum.of(maps[0], box=True)
    spectrum = own.spectrum
    unit = spectrum.q[0] / own.q[0]
    found = []
    for each in maps:
        z = np.array(each.filtered(None))
        q = np.hypot(np.fft.fftfreq(512)[:, None], np.fft.rfftfreq(512)) * 2 * np.pi / 1e-7
        s = np.fft.irfft2(np.fft.rfft2(z - z.mean()) * (1 - tau + tau * q * unit), s=z.shape)
        found.append(punched(s > np.quantile(s, 1 - area), 1e-7))
    K = np.mean(found) * unit / math.sqrt(2)  # σ/g = √(m0/m2)/√2
    low = np.array([-ndtri(area)])
    bound = patch_stiffness(spectrum.series(400), low, np.array([tau]))[0]
    assert bound < K
    assert least < K / ((1 + patch_remainder(5.0)) * bound) - 1 < most
