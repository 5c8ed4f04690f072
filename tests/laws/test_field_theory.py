"""The programme of one field of heights, against its exact limits and a programme of its own."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad, simpson
from scipy.optimize import minimize_scalar
from scipy.special import j0, ndtr

import thirdbody as tb
from thirdbody.errors import InvalidValue
from thirdbody.laws.field.formulas import area, hardness_ratio, load, remainder
from thirdbody.laws.field.programme import Edges, solve_programme
from thirdbody.laws.field.spectrum import rolled_off
from thirdbody.laws.field.table import field_of

H = np.array([3.0, 2.0, 1.0, 0.5])
PRINTED = {
    0.0737: ([2.315e-5, 5.058e-4, 5.098e-3, 1.267e-2], [8.13e-5, 1.353e-3, 1.007e-2, 2.119e-2]),
    0.1827: ([4.389e-5, 9.485e-4, 9.869e-3, 2.598e-2], [1.538e-4, 2.533e-3, 2.030e-2, 4.714e-2]),
    0.4097: ([5.993e-5, 1.299e-3, 1.426e-2, 4.099e-2], [2.097e-4, 3.489e-3, 3.097e-2, 8.452e-2]),
    50.0: ([6.277e-5, 1.374e-3, 1.569e-2, 4.872e-2], [2.200e-4, 3.713e-3, 3.538e-2, 1.138e-1]),
}
"""Φ and ⟨f⟩ at H for α = 5, of two implementations that share no code.

They are sums cut and grids: at χ = 0.07, where f jumps, their load is 1e-3 off a sum four times as
long.
"""


@pytest.mark.parametrize(
    ("alpha", "known"),
    [
        (5.0, [1.816, 1.084, 0.824, 0.687, 0.461, 0.319]),
        (15.0, [2.647, 1.510, 1.104, 0.891, 0.546, 0.349]),
        (3.0, [1.384, 0.907, 0.729, 0.629, 0.443, 0.313]),
    ],
)
def test_powers_of_the_autocorrelation(alpha, known):
    k = rolled_off(alpha).integrals(0.0, 16)
    assert k[[1, 2, 3, 4, 8, 16]] == pytest.approx(known, abs=8e-4)


def test_integrals_by_adaptive_quadrature():
    spectrum = rolled_off(5.0)

    def rho(r):
        return float(spectrum.weight @ j0(spectrum.q * r))

    own, mixed = spectrum.integrals_from(0.7, np.array([0.0]), 6)
    for n in (3, 6):
        expected = quad(lambda r, n=n: rho(r) ** n, 0.7, 40.0, limit=400, epsabs=1e-11)[0]
        assert own[n] == pytest.approx(expected, abs=1e-6)
        assert mixed[0, n] == pytest.approx(own[n], rel=1e-12)  # τ = 0: s is z
    assert own[0] == -0.7
    lead = spectrum.integrals(0.0, 400)[400] * math.sqrt(400)
    assert lead == pytest.approx(math.sqrt(math.pi / 2), rel=2e-3)


@pytest.mark.parametrize("chi", list(PRINTED))
def test_energy_and_load_as_printed(chi):
    surface = field_of(chi, 5.0)
    energy, mean = PRINTED[chi]
    assert surface.energy(H) == pytest.approx(energy, rel=1.2e-3)
    assert surface.load(H)[:, 0] == pytest.approx(mean, rel=2e-3)


class ByMaximisation:
    """The programme on a grid of s: box-constrained, by sets that change until none does."""

    STEP, TERMS = 0.04, 400

    def __init__(self, alpha):
        self.series = rolled_off(alpha)
        self.s = np.arange(-3 + self.STEP / 2, 8.0, self.STEP)
        self.w = self.STEP * np.exp(-(self.s**2) / 2) / math.sqrt(2 * math.pi)
        he = np.empty((self.TERMS + 1, len(self.s)))
        he[0], he[1] = 1.0, self.s
        for n in range(1, self.TERMS):
            he[n + 1] = (self.s * he[n] - math.sqrt(n) * he[n - 1]) / math.sqrt(n + 1)
        self.he = he

    def at(self, tau, h, chi):
        """Φ and ⟨f⟩ with one filter."""
        c = self.series.filtered_correlations(tau)[0]
        k = self.series.integrals(tau, self.TERMS)
        last = 0.6 * k[-1]
        part = np.concatenate([[-last], k[1:] - last])
        kernel = 2 * math.sqrt(2) * (self.he.T * part) @ self.he * self.w * self.w[:, None]
        kernel[np.diag_indices_from(kernel)] += 2 * math.sqrt(2) * last * self.w
        gain = (c * self.s - h) * self.w
        free, full = self.s > h, np.zeros(len(self.s), bool)
        for _ in range(60):
            f = np.where(full, chi, 0.0)
            some = np.flatnonzero(free)
            f[some] = np.linalg.solve(kernel[np.ix_(some, some)], (gain - kernel @ f)[some])
            rest = gain - kernel @ f
            now_full = np.where(free, f > chi, full & (rest > 0))
            now_free = np.where(free, f > 0, ~full & (rest > 0)) & ~now_full | (full & ~now_full)
            if np.array_equal(now_free, free) and np.array_equal(now_full, full):
                break
            free, full = now_free, now_full
        return gain @ f - 0.5 * f @ kernel @ f, self.w @ f

    def best(self, h, chi):
        found = minimize_scalar(
            lambda tau: -self.at(tau, h, chi)[0], bounds=(0, 1), method="bounded",
            options={"xatol": 2e-3},
        )  # fmt: skip
        return self.at(found.x, h, chi)


@pytest.mark.parametrize(
    ("alpha", "chi", "h"), [(5.0, 0.3, 1.5), (3.4, 0.9, 2.2), (12.0, 0.15, 0.8)]
)
def test_the_table_is_the_maximum_on_a_grid(alpha, chi, h):
    energy, mean = ByMaximisation(alpha).best(h, chi)
    surface, at = field_of(chi, alpha), np.array([h])
    assert surface.energy(at)[0] == pytest.approx(energy, rel=1.5e-3)
    assert surface.load(at)[0, 0] == pytest.approx(mean, rel=5e-3)


def test_the_table_is_the_programme_between_its_points():
    alpha, chi, h = 6.3, 0.34, np.array([1.33, 2.61])
    series = rolled_off(alpha).series(400)
    start = Edges(h + 0.2, np.full(2, -1.5), np.array([0.25, 0.12]), np.zeros(2, bool))
    direct, surface = solve_programme(series, h, chi, start), field_of(chi, alpha)
    assert surface.energy(h) == pytest.approx(direct.energy, rel=2e-4)
    assert surface.load(h)[:, 0] == pytest.approx(direct.moments[:, 0], rel=5e-4)
    columns = surface.columns(h)
    assert h + columns[:, 1] == pytest.approx(direct.low, abs=0.004)
    assert columns[:, 4:10] == pytest.approx(
        direct.moments[:, 1:7] / direct.moments[:, :1], rel=3e-3, abs=3e-3
    )


@pytest.mark.parametrize("chi", [0.004, 0.05, 0.3, 0.41, 2.0, 40.0])
def test_load_is_the_slope_of_the_energy(chi):
    surface = field_of(chi, 7.0)
    h = np.concatenate([np.linspace(max(surface.lowest, -1) + 0.05, 5.9, 40), [8.0, 14.0, 25.0]])
    step = 1e-4
    values = surface.load(h)
    slope = (surface.energy(h + step) - surface.energy(h - step)) / (2 * step)
    assert -slope == pytest.approx(values[:, 0], rel=3e-6)
    for n in (0, 1):
        slope = (surface.load(h + step)[:, n] - surface.load(h - step)[:, n]) / (2 * step)
        assert slope == pytest.approx(values[:, n + 1], rel=3e-5)
    assert np.all(np.diff(values[:, 0]) < 0)  # Φ is convex


def test_a_plastic_surface_carries_on_its_bearing_area():
    h = np.array([-0.9, 0.0, 1.0, 2.5, 4.0])
    for chi in (1e-4, 1e-6):
        surface = field_of(chi, 5.0)
        assert surface.load(h)[:, 0] / chi == pytest.approx(ndtr(-h), rel=15 * chi)
        found, plastic = area(surface, h, remains=True)
        assert found == pytest.approx(ndtr(-h), rel=15 * chi)
        assert plastic == pytest.approx(1.0, abs=15 * chi)


def test_a_hard_surface_no_longer_asks_how_hard():
    h = np.linspace(0.25, 4, 9)
    assert field_of(4.0, 5.0).energy(h) == pytest.approx(field_of(400.0, 5.0).energy(h), rel=1e-12)


def test_softer_surfaces_carry_less():
    h = np.linspace(0.25, 4, 9)
    loads = [field_of(chi, 9.0).load(h)[:, 0] for chi in (0.02, 0.1, 0.3, 0.39, 0.42, 0.9, 2.5)]
    assert all(np.all(b > a) for a, b in zip(loads, loads[1:], strict=False))


def test_the_remainder():
    h = np.array([-0.5, 0.0, 0.7, 6.0])
    e = remainder(h, chi=0.18, alpha=5.0)
    full = (0.10 + 0.04 * math.log(5)) * 0.18 / (0.18 + 0.28 + 5 / 25)
    assert e[:, 0] == pytest.approx([0, 0, full * (1 - 2 * ndtr(-0.7)), full], rel=1e-6)
    surface = field_of(0.18, 5.0)
    bare, whole = (load(surface, h[2:], remains=r) for r in (False, True))
    assert whole[:, 0] / bare[:, 0] == pytest.approx(1 + e[2:, 0])
    step = 1e-5
    slope = load(surface, h[2:] + step, remains=True) - load(surface, h[2:] - step, remains=True)
    assert slope[:, 0] / (2 * step) == pytest.approx(whole[:, 1], rel=1e-6)


def test_gradient_of_a_surface():
    rough = tb.Roughness(sigma=2e-7, R=4e-6, alpha=8.0)
    m4 = math.pi * (0.375 / rough.R) ** 2
    m2 = rough.slope**2 / 2
    assert rough.sigma**2 * m4 / m2**2 == pytest.approx(8.0)
    assert hardness_ratio(rough, E_star=1e11, H=2e9) == pytest.approx(0.02 / rough.slope)


def test_no_table_beyond_its_bandwidths():
    with pytest.raises(InvalidValue, match="alpha = 40"):
        field_of(0.2, 40.0)


@pytest.mark.parametrize("r", [3.0, 20.0, 60.0])
def test_what_is_felt_from_far_away_by_many_even_steps(r):
    """Also where the nearest part has hundreds of waves."""
    spectrum = rolled_off(12.0)
    powers, _ = spectrum.integrals_from(r, np.array([0.0]), 3)
    at = np.linspace(r, spectrum.farthest, 60_001)
    plain, _, _ = spectrum.correlations(at)
    expected = [simpson(plain**n, x=at) for n in (2, 3)]
    assert powers[2:] == pytest.approx(expected, abs=1e-9)
    assert powers[0] == -r
