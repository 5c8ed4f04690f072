"""Brute force: explicit asperities and explicit particles, drawn at random and added up.

No integral anywhere. Each estimate must agree with the library within four of its own standard
errors, and the standard error must be small enough to mean something.
"""

import math

import numpy as np
import oracle
import pytest
from twins import base, series_twin, sizes

import thirdbody as tb

N = 2_000_000
INTERFACE = oracle.Interface()
UNLIKE = oracle.Interface(oracle.STEEL, oracle.Body(100e9, 0.3, 1.2e9))


def contact_law(omega, tip: oracle.Tip):
    """Load and area of many contacts at once; ``tip`` may be of unit size."""
    omega = np.maximum(omega, 0.0)
    w_1, w_2 = tip.omega_1, tip.omega_2
    s = np.clip((omega - w_1) / (w_2 - w_1), 0, 1)
    area = np.pi * tip.R * omega * (1 + s * s * (3 - 2 * s))
    with np.errstate(divide="ignore"):
        u = np.clip(np.log(omega / w_1) / math.log(tip.rho), 0, 1)
    if tip.rule == "log":
        ratio = tip.k + (1 - tip.k) * u
    else:
        rise = u * u * (3 - 2 * u)
        ratio = tip.k * (1 - rise) + 0.5 * tip.k * math.log(tip.rho) * u * (1 - u) ** 2 + rise
    hertz = 4 * tip.E / (3 * np.pi) * np.sqrt(omega / tip.R)
    pressure = np.where(omega < w_1, hertz, tip.H * ratio)
    if tip.cap:
        area = np.minimum(area, np.pi * tip.R**2)
    return pressure * area, area


def squeeze(t, pair: oracle.Squeezed):
    """Load and both areas of particles of unit diameter, each balanced by bisection."""
    t = np.minimum(np.maximum(t, 0.0), pair.end)
    lo, hi = np.zeros_like(t), t.copy()
    for _ in range(36):
        mid = 0.5 * (lo + hi)
        less = contact_law(mid, pair.one)[0] < contact_law(t - mid, pair.two)[0]
        lo, hi = np.where(less, mid, lo), np.where(less, hi, mid)
    force, one = contact_law(0.5 * (lo + hi), pair.one)
    return force, one, contact_law(t - 0.5 * (lo + hi), pair.two)[1]


def compare(samples, want: float, meaningful: float) -> None:
    """Sample mean against a number, in the sample's own standard errors."""
    mean, error = np.mean(samples), np.std(samples) / math.sqrt(len(samples))
    assert error < meaningful * mean
    assert abs(mean - want) < 4 * error, f"{mean} ± {error} is not {want}"


@pytest.mark.spread(3)
@pytest.mark.parametrize("h", [-1.0, 0.0, 1.0, 2.0])
@pytest.mark.parametrize("interface", [INTERFACE, UNLIKE], ids=["like", "unlike"])
def test_asperities(interface, h):
    rough = interface.rough
    heights = np.random.default_rng(1).normal(0.0, rough.sigma_s, N if h < 1.5 else 4 * N)
    d = h * rough.sigma
    force, area = contact_law(heights - d, interface.tip)
    state = tb.solve(base(interface), d=d)
    compare(rough.eta * force / interface.E_ss, state.F_star, meaningful=6e-3)
    compare(rough.eta * area, state.A_t, meaningful=6e-3)
    touching = heights > d
    elastic = touching & (heights - d < interface.tip.omega_1)
    plastic = heights - d >= interface.tip.omega_2
    compare(rough.eta * area * elastic, state.A_e, meaningful=0.03)
    compare(rough.eta * area * (touching & ~elastic & ~plastic), state.A_ep, meaningful=0.03)
    if h < 0.5:
        compare(rough.eta * area * plastic, state.A_p, meaningful=0.03)


def diameters(rng, mean: float, std: float, n: float, size: int):
    """Truncated Gaussian by rejection."""
    x = rng.normal(mean, std, int(1.05 * size / math.erf(n / math.sqrt(2))) + 1000)
    return x[np.abs(x - mean) <= n * std][:size]


def lognormal(rng, median: float, gsd: float, size: int):
    return median * np.exp(math.log(gsd) * rng.standard_normal(size))


@pytest.mark.spread(3)
@pytest.mark.parametrize("interface", [INTERFACE, UNLIKE], ids=["like", "unlike"])
@pytest.mark.parametrize(
    ("seat", "d", "options"),
    [
        ("plane", 2.4e-7, {}),
        ("offset", 4.6e-7, {"h_0": 2e-7}),
        ("rough", 1.6e-7, {}),
        ("rough", 2.2e-7, {"zeta_mean": 0.5, "zeta_std": 0.7}),
    ],
    ids=["plane", "offset", "rough", "peaks"],
)
@pytest.mark.parametrize("dust", [oracle.SILICA, oracle.Body(20e9, 0.3, 8e8)], ids=["hard", "soft"])
def test_particles(interface, seat, d, options, dust):
    n, size, density = 2.5, 150_000, 2e11
    rng = np.random.default_rng(2)
    x = diameters(rng, 3e-7, 4.5e-8, n, size)
    gap = np.full_like(x, d - options.get("h_0", 0.0))
    if seat == "rough":
        sigma = interface.rough.sigma
        zeta = rng.normal(
            options.get("zeta_mean", 0.0) * sigma, options.get("zeta_std", 1.0) * sigma, len(x)
        )
        gap = d + interface.rough.y_s - zeta
    twin = series_twin(
        interface, dust, sizes("gaussian", 3e-7, 0.15, n), density, d, seat=seat, **options
    )
    state = tb.solve(twin.contact, d=d)
    pair = oracle.squeezed(interface, twin.law)
    force, one, two = (density * x**2 * part for part in squeeze((x - gap) / x, pair))
    compare(force / interface.E_ss, state.F_sa_star, meaningful=6e-3)
    compare(one, state.A_sa, meaningful=6e-3)
    compare(two, state.A_sa2, meaningful=6e-3)
    compare(np.maximum(one, two), state.shadow, meaningful=6e-3)
    bare = tb.solve(base(interface), d=d)
    assert state.F_ss_star == pytest.approx((1 - state.shadow) * bare.F_star, rel=1e-12)
    projected = twin.contact.replace(**{"particle_law.shadow": "projected"})
    loaded = density * np.pi / 4 * x**2 * (x > gap)
    compare(loaded, tb.solve(projected, d=d).shadow, meaningful=6e-3)


@pytest.mark.parametrize("seat", ["plane", "rough"])
def test_lognormal_dust(seat):
    d, size, density = 2e-7, 400_000, 2e11
    rng = np.random.default_rng(3)
    x = lognormal(rng, 2.5e-7, 1.35, size)
    gap = np.full_like(x, d)
    if seat == "rough":
        rough = INTERFACE.rough
        gap = d + rough.y_s - rng.normal(0, rough.sigma, size)
    twin = series_twin(
        INTERFACE, oracle.SILICA, sizes("lognormal", 2.5e-7, 0.35), density, d, seat=seat
    )
    state = tb.solve(twin.contact, d=d)
    t = np.maximum(1 - gap / x, 0)
    # equal sides share the squeeze equally
    pair = oracle.squeezed(INTERFACE, twin.law)
    force, area = contact_law(np.minimum(t, pair.end) / 2, pair.one)
    compare(density * x**2 * force / INTERFACE.E_ss, state.F_sa_star, meaningful=6e-3)
    compare(density * x**2 * area, state.A_sa, meaningful=6e-3)


def test_the_brute_force_itself():
    """The vectorised laws above are the oracle's, contact by contact."""
    for rule in ("log", "hermite"):
        tip = oracle.Tip(0.5, 50.0, 1.0, rule, cap=True)
        omega = np.geomspace(1e-8, 1, 200)
        force, area = contact_law(omega, tip)
        np.testing.assert_allclose(force, [tip.force(w) for w in omega], rtol=1e-12)
        np.testing.assert_allclose(area, [tip.area(w) for w in omega], rtol=1e-12)
    pair = oracle.Squeezed(
        oracle.Tip(0.5, 50.0, 1.0, cap=True), oracle.Tip(0.5, 9.0, 1.4, cap=True)
    )
    t = np.linspace(1e-3, 0.99 * pair.end, 50)
    force, one, two = squeeze(t, pair)
    np.testing.assert_allclose(
        np.transpose([force, one, two]), [pair.response(float(each))[:3] for each in t], rtol=1e-8
    )
