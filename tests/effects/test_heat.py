"""Heat through one contact: against exact limits, quadrature of the source, and series."""

import json
import math
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
import scipy.sparse.linalg
from scipy import integrate, optimize, special

from thirdbody.effects.single import heat

BOTH = [(flux, kind) for flux in get_args(heat.Flux) for kind in get_args(heat.Kind)]
SHARED = Path(__file__).parents[3] / "shared" / "reference" / "outputs.json"


def intensity(r2, flux):
    return np.ones_like(r2) if flux == "uniform" else 1.5 * np.sqrt(np.maximum(1 - r2, 0))


def rise_at(x, y, Pe, flux, nodes=160):
    """Rise at a point of the disc by polar quadrature about it; the heat trails to x > 0."""
    u, w = np.polynomial.legendre.leggauss(nodes)
    phi, w_phi = (u + 1) * np.pi, w * np.pi
    across = x * np.cos(phi) + y * np.sin(phi)
    edge = -across + np.sqrt(np.maximum(across**2 + 1 - x**2 - y**2, 0))
    s, w_s = (u + 1) / 2, w / 2
    R = edge[:, None] * s**2
    X, Y = x + R * np.cos(phi)[:, None], y + R * np.sin(phi)[:, None]
    # exp(−Pe (R + distance back to the source)), the source behind at smaller x
    decay = np.exp(-Pe * R * (1 + np.cos(phi)[:, None]))
    part = intensity(X**2 + Y**2, flux) * decay * edge[:, None] * 2 * s * w_s
    return w_phi @ part.sum(axis=1) / (2 * np.pi)


def largest(Pe, flux):
    found = optimize.minimize_scalar(
        lambda x: -rise_at(x, 0.0, Pe, flux), bounds=(-0.999, 0.999), method="bounded"
    )
    return -found.fun


def mean(Pe, flux):
    """Average of `rise_at` over the disc."""
    u, w = np.polynomial.legendre.leggauss(24)
    r, w_r = (u + 1) / 2, w / 2
    angles = (np.arange(24) + 0.5) * np.pi / 24
    grid = [[rise_at(a * np.cos(t), a * np.sin(t), Pe, flux, 60) for t in angles] for a in r]
    return float(2 * w_r * r @ np.mean(grid, axis=1))


@pytest.mark.parametrize(
    ("flux", "kind", "rest", "fast"),
    [
        ("uniform", "max", 1.0, 2 / math.sqrt(math.pi)),
        ("uniform", "mean", 8 / (3 * math.pi), 4 / 3 * 2**1.5 * special.beta(0.5, 1.75)),
        ("hertz", "max", 3 * math.pi / 8, None),
        ("hertz", "mean", 9 * math.pi / 32, None),
    ],
)
def test_limits_of_a_moving_source(flux, kind, rest, fast):
    assert heat.moving_rise(0.0, kind=kind, flux=flux) == pytest.approx(rest, rel=2e-4)
    if fast is None:
        # every strip is heated by itself: ∫ q(s')/√(s−s') ds'
        def strip(y, s):
            w = math.sqrt(1 - y * y)
            return integrate.quad(
                lambda t: 3 * math.sqrt(max(w**2 - (s - t**2 - w) ** 2, 0)), 0, math.sqrt(s)
            )[0]

        if kind == "max":
            peak = optimize.minimize_scalar(
                lambda s: -strip(0.0, s), bounds=(0.5, 2), method="bounded"
            )
            fast = -peak.fun / math.sqrt(2 * math.pi)
        else:
            # the heat set free at a distance t from the trailing edge warms it by 2√t
            along = integrate.quad(lambda t: math.sqrt(1 - t * t) * math.sqrt(1 - t), -1, 1)[0]
            fast = 3 * along * special.beta(0.5, 2.25) / math.pi / math.sqrt(2 * math.pi)
    elif kind == "mean":
        fast /= math.pi * math.sqrt(2 * math.pi)
    found = heat.moving_rise(1e8, kind=kind, flux=flux) * 1e4
    assert found == pytest.approx(fast, rel=1.5e-3)


@pytest.mark.spread(2)
@pytest.mark.parametrize("Pe", [0.3, 2.0, 8.0])
@pytest.mark.parametrize("flux", get_args(heat.Flux))
def test_moving_source_against_quadrature(Pe, flux):
    error = heat.moving_rise(Pe, kind="max", flux=flux) / largest(Pe, flux) - 1
    assert -0.012 < error < 0.0235
    error = heat.moving_rise(Pe, kind="mean", flux=flux) / mean(Pe, flux) - 1
    assert -0.047 < error < 0.001


def test_quadrature_itself():
    """Jaeger's moving disc at Pe = 1, from two routes that share nothing."""
    R, w = heat._pairs("uniform", "mean")
    assert mean(1.0, "uniform") == pytest.approx(np.sum(w * special.ive(0, R)), rel=1e-4)
    assert np.sum(w * special.ive(0, R)) == pytest.approx(0.555413555849775, rel=1e-10)  # mpmath
    assert largest(1.0, "uniform") == pytest.approx(0.73244, abs=1e-5)


def test_suddenly_heated_disc():
    Fo = np.geomspace(1e-8, 1e8, 801)
    z = 1 / (2 * np.sqrt(Fo))
    ierfc = np.exp(-z * z) / math.sqrt(math.pi) - z * special.erfc(z)
    exact = 2 * np.sqrt(Fo) * (1 / math.sqrt(math.pi) - ierfc)
    np.testing.assert_allclose(heat.sudden_share(Fo, kind="max"), exact, rtol=3e-5)


@pytest.mark.parametrize("Fo", [1e-4, 0.05, 2.0])
def test_sudden_mean(Fo):
    """By Hankel transform: ∫ J_1² erf(λ√Fo)/λ² dλ, 2 of them over 8/3π."""
    end, count = 4000.0, 400_001
    x = np.linspace(1e-9, end, count)
    f = special.j1(x) ** 2 / x**2 * special.erf(x * math.sqrt(Fo))
    tail = 1 / (2 * math.pi * end**2)  # J_1² → 1/πλ on average
    share = 2 * (integrate.simpson(f, x=x) + tail) / (8 / (3 * math.pi))
    assert heat.sudden_share(Fo) == pytest.approx(share, rel=3e-5)


@pytest.mark.parametrize(("flux", "kind"), BOTH)
def test_sudden_limits(flux, kind):
    steady = heat.moving_rise(0.0, kind=kind, flux=flux)
    start = heat.sudden_share(1e-10, kind=kind, flux=flux) * steady
    # a half-space heated all over: 2q√(Dt/π)/k, with the flux at the centre or the mean one
    local = 1.5 if (flux, kind) == ("hertz", "max") else 1.0
    assert start == pytest.approx(local * 2 * math.sqrt(1e-10 / math.pi), rel=2e-3)
    assert heat.sudden_share(1e9, kind=kind, flux=flux) == pytest.approx(1, abs=1e-4)
    Fo = np.geomspace(1e-9, 1e7, 200)
    assert np.all(np.diff(heat.sudden_share(Fo, kind=kind, flux=flux)) > 0)


# ------------------------------------------------------------------ bridges
def test_two_bodies():
    rng = np.random.default_rng(1)
    Q, G_1, G_2, T_1, T_2 = rng.uniform(0.1, 3, (5, 20))
    T = heat.partition(Q, G_1=G_1, G_2=G_2, T_1=T_1, T_2=T_2)
    np.testing.assert_allclose(G_1 * (T - T_1) + G_2 * (T - T_2), Q)
    blok = 1 / (1 / (Q / G_1) + 1 / (Q / G_2))
    np.testing.assert_allclose(heat.partition(Q, G_1=G_1, G_2=G_2, T_1=0, T_2=0), blok)


def test_bridge():
    rng = np.random.default_rng(2)
    Q_1, Q_2, G_1, G_2, R, T_1, T_2 = rng.uniform(0.1, 3, (7, 20))
    one, two = heat.bridge((Q_1, Q_2), G=(G_1, G_2), R=R, T=(T_1, T_2))
    np.testing.assert_allclose(G_1 * (one - T_1) + (one - two) / R, Q_1)
    np.testing.assert_allclose(G_2 * (two - T_2) + (two - one) / R, Q_2)
    one, two = heat.bridge((0 * Q_1, Q_2), G=(G_1, G_2), R=1e-12)
    np.testing.assert_allclose(two, heat.partition(Q_2, G_1=G_1, G_2=G_2, T_1=0, T_2=0), rtol=1e-10)
    _, two = heat.bridge((0 * Q_1, Q_2), G=(G_1, G_2), R=np.full(20, np.inf))
    np.testing.assert_allclose(two, Q_2 / G_2)


def legendre(a, kind, terms=20_000):
    """k r R of a sphere with uniform flux in through one cap and out through the other."""
    cosine = math.sqrt(1 - a * a)
    P = np.empty(terms + 2)
    P[:2] = 1, cosine
    for n in range(1, terms + 1):
        P[n + 1] = ((2 * n + 1) * cosine * P[n] - n * P[n - 1]) / (n + 1)
    n = np.arange(1, terms + 1)
    over_cap = (P[n - 1] - P[n + 1]) / ((2 * n + 1) * (1 - cosine))
    there = over_cap if kind == "mean" else 1.0
    # n r ∂T/∂r = q r/k for every order; odd orders differ between the poles
    return 4 * np.sum(((2 * n + 1) / (4 * math.pi * n) * over_cap * there)[::2])


@pytest.mark.parametrize("kind", get_args(heat.Kind))
def test_sphere_against_the_legendre_series(kind):
    for a, worst in ((0.1, 2.4e-3), (0.3, 2.2e-2), (0.5, 6.8e-2)):
        found = heat.sphere_resistance(a, a_2=a, r=1.0, k=1.0, ends=("uniform", kind))
        error = found / legendre(a, kind) - 1
        assert worst / 2 < error < worst


def test_sphere_with_isothermal_ends():
    """Power of the flux 1/√(1−ρ²), which is the right one where the cap is small."""
    a, terms = 0.1, 3000
    u, w = np.polynomial.legendre.leggauss(1500)
    phi = (u + 1) * np.pi / 4
    w = w * np.sin(phi) / np.sum(w * np.sin(phi))
    x = 1 - 2 * (math.sin(math.asin(a) / 2) * np.sin(phi)) ** 2
    before, now = np.ones_like(x), x
    sums = []
    total = 0.0
    for n in range(1, terms + 1):
        if n % 2:
            total += (2 * n + 1) / n * (w @ now) ** 2
        sums.append(total / math.pi)
        before, now = now, ((2 * n + 1) * x * now - n * before) / (n + 1)
    series = 2 * sums[-1] - sums[terms // 2 - 1]  # what is left falls like 1/terms
    assert heat.sphere_resistance(a, a_2=a, r=1, k=1) == pytest.approx(series, rel=3e-3)
    spread = heat.sphere_resistance(a, a_2=a, r=1, k=1, ends=("uniform", "mean"))
    assert heat.sphere_resistance(a, a_2=a, r=1, k=1) < spread


def test_ends_of_a_sphere_are_a_half_space_at_rest():
    """a k R → θ(0)/π."""
    for flux, kind in BOTH:
        R = heat.sphere_resistance(1e-6, a_2=1e-6, r=1.0, k=1.0, ends=(flux, kind))
        G = heat.body_conductance(1e-6, k=1.0, D=1.0, kind=kind, flux=flux)
        assert R * G / 2 == pytest.approx(1, rel=2e-4)


def test_logarithms_of_the_distance():
    """⟨ln R⟩ of source and target, by drawing them."""
    rng = np.random.default_rng(3)
    count = 400_000
    turn = rng.uniform(0, 2 * np.pi, count)
    uniform = np.sqrt(rng.uniform(size=count))
    hertz = np.sqrt(1 - rng.uniform(size=count) ** (2 / 3))
    flat = np.sqrt(1 - rng.uniform(size=(2, count)) ** 2)
    draws = {
        ("uniform", "mean"): (uniform, np.sqrt(rng.uniform(size=count))),
        ("uniform", "max"): (uniform, 0 * uniform),
        ("hertz", "mean"): (hertz, np.sqrt(rng.uniform(size=count))),
        ("hertz", "max"): (hertz, 0 * hertz),
        "isothermal": (flat[0], flat[1]),
    }
    for ends, (r, s) in draws.items():
        logs = 0.5 * np.log(r**2 + s**2 - 2 * r * s * np.cos(turn))
        error = 4 * logs.std() / math.sqrt(count)
        assert heat._SPHERE_END[ends][1] == pytest.approx(logs.mean(), abs=error)


# ------------------------------------------------------------------ conductance
def test_small_spots():
    assert heat.spot_resistance(1e-6, rho_1=1e-7, rho_2=3e-7) == pytest.approx(4e-7 / 4e-6)
    small = heat.spot_resistance(1e-12, rho_1=2e-7, rho_2=2e-7, mean_free_path=1e-8)
    assert small == pytest.approx(4 * 2e-7 * 1e-8 / (3 * math.pi * 1e-24), rel=1e-3)
    film = heat.spot_resistance(1e-6, rho_1=2e-7, rho_2=2e-7, film=1e-12) - 0.1
    assert film == pytest.approx(1e-12 / (math.pi * 1e-12))


def test_spreading_factors():
    e = np.linspace(0, 0.2, 50)
    power, series = heat.spreading(e), heat.spreading(e, form="series")
    assert np.all(np.abs(power / series - 1) < 0.015)
    assert np.all(heat.spreading(e, form="none") == 1)
    # isothermal disc on a tube: half of its two ends' ψ is (8/3π) of the uniform one at most
    assert heat.spreading(0.1) == pytest.approx(0.9**1.5)


@pytest.mark.parametrize("part", [1e-4, 1e-3, 1e-2])
def test_plastic_conductance(part):
    """From density and mean radius of the spots of a Gaussian surface cut at λ."""
    lam = special.erfcinv(2 * part) * math.sqrt(2)
    density = math.exp(-(lam**2)) / (16 * part)  # (σ/m)²
    radius = math.sqrt(8 / math.pi) * math.exp(lam**2 / 2) * part
    h = 2 * density * radius / (1 - math.sqrt(part)) ** 1.5
    given = dict(H=1.0, k=1.0, m=1.0, sigma=1.0)
    assert heat.cooper_mikic_yovanovich(part, **given) == pytest.approx(h, rel=1e-12)
    assert heat.cooper_mikic_yovanovich_fit(part, **given) == pytest.approx(h, rel=0.015)


def test_elastic_conductance_of_a_cut_surface():
    """Elastic spots have half the area of the cut at the same load: p/(E* m_rms/√π …), Mikic."""
    m, E = 0.1, 1e11
    for p in (1e5, 1e6, 1e7):
        hard = E * m / math.sqrt(2)  # mean pressure of elastic spots, with m absolute
        part = p / hard
        lam = -special.ndtri(2 * part)  # the cut has twice the area
        density = math.exp(-(lam**2)) / (16 * 2 * part)
        radius = math.sqrt(8 / math.pi) * math.exp(lam**2 / 2) * 2 * part / math.sqrt(2)
        h = 2 * density * radius * m / (1 - math.sqrt(part)) ** 1.5
        found = heat.mikic_elastic(p, E_star=E, k=1.0, m=m, sigma=1.0)
        assert found == pytest.approx(h, rel=0.03)


def test_slope_of_a_profile():
    """A Gaussian surface with α = 5 has m_0 m_4/m_2² = 5."""
    sigma, R, alpha = 1e-7, 3e-6, 5.0
    m = heat.absolute_slope(sigma=sigma, R=R, alpha=alpha)
    m_2 = m**2 * math.pi / 2
    assert sigma**2 * (9 * math.pi / 64 / R**2) / m_2**2 == pytest.approx(alpha)


def test_lorenz_number():
    assert heat.LORENZ == pytest.approx(2.4430e-8, rel=1e-4)


@pytest.mark.skipif(not SHARED.exists(), reason="the shared reference is not here")
def test_reference():
    values = {each["id"]: each for each in json.loads(SHARED.read_text())["values"]}
    spot = values["spot_ss"]
    G = [
        heat.body_conductance(1e-6, k=50, D=spot["inputs"]["D"], v=v, kind="max") for v in (0, 1.0)
    ]
    assert 3e-5 / sum(G) == pytest.approx(spot["value"], rel=1e-12)
    for k in (1.4, 50.0):
        R = heat.sphere_resistance(1e-7, a_2=1e-7, r=2.5e-7, k=k, ends=("uniform", "mean"))
        R += 1 / heat.body_conductance(1e-7, k=50, D=1.0, kind="max")
        assert R == pytest.approx(values[f"Rp_k{k}"]["value"], rel=1e-12)
    for part, name in ((1e-4, "CMY_0.0001"), (1e-2, "CMY_0.01")):
        h = heat.cooper_mikic_yovanovich(part, H=1, k=1, m=1, sigma=1)
        assert h == pytest.approx(values[name]["value"], rel=1e-10)
    assert heat.spreading(0.1) == pytest.approx(values["psi_0.1"]["value"], rel=1e-12)
    assert heat.spreading(0.1, form="series") == pytest.approx(values["psi_0.1"]["second"])
    series = legendre(0.1, "mean")
    assert series == pytest.approx(values["sphere_caps_0.1"]["value"], rel=1e-4)
    assert heat.sudden_share(1e6, kind="max") == pytest.approx(
        values["transient_inf"]["value"], rel=1e-5
    )


def barrel(height: float, steps: int = 100) -> tuple[float, float]:
    """Radius of the ends, and resistance, of a unit sphere squashed to a height, by finite elements.

    A zone of a larger sphere of the same volume, with isothermal ends and k = 1: linear elements of
    one half, turned around the axis.
    """
    wide = math.sqrt(4 / 3 / height + height**2 / 12)
    share = np.linspace(0, 1, steps + 1)
    z = 0.5 * height * (1 - (1 - share) ** 1.5)  # closer where the end meets the side
    r = share[:, None] ** 0.7 * np.sqrt(wide**2 - z**2)
    place = np.arange(r.size).reshape(r.shape)
    a, b, c, d = (
        place[i, j].ravel()
        for i, j in (
            (slice(None, -1), slice(None, -1)),
            (slice(1, None), slice(None, -1)),
            (slice(1, None), slice(1, None)),
            (slice(None, -1), slice(1, None)),
        )
    )
    corners = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    R, Z = r.ravel()[corners], np.broadcast_to(z, r.shape).ravel()[corners]
    twice = (R[:, 1] - R[:, 0]) * (Z[:, 2] - Z[:, 0]) - (R[:, 2] - R[:, 0]) * (Z[:, 1] - Z[:, 0])
    across = (np.roll(Z, -1, 1) - np.roll(Z, -2, 1)) / twice[:, None]
    along = (np.roll(R, -2, 1) - np.roll(R, -1, 1)) / twice[:, None]
    stiff = across[:, :, None] * across[:, None] + along[:, :, None] * along[:, None]
    stiff *= (math.pi * R.mean(1) * twice)[:, None, None]
    ends = np.repeat(corners, 3, 1).ravel(), np.tile(corners, (1, 3)).ravel()
    matrix = scipy.sparse.csr_matrix((stiff.ravel(), ends), (r.size, r.size))
    T = np.zeros(r.size)
    T[place[:, -1]] = 1.0
    free = place[:, 1:-1].ravel()
    T[free] = scipy.sparse.linalg.spsolve(matrix[free][:, free].tocsc(), -matrix[free] @ T)
    return math.sqrt(wide**2 - height**2 / 4), 2 / float(T @ (matrix @ T))


@pytest.mark.parametrize("height", [1.9, 1.7, 1.5, 1.2, 0.8, 0.3])
def test_a_squashed_particle_is_a_barrel(height):
    a, R = barrel(height)
    found = heat.particle_resistance(a, a_2=a, r=1.0, height=height, k=1.0)
    assert 0 < found / R - 1 < 0.11
    assert found / R - 1 < 0.01 or a < 1.3


def test_a_particle_that_keeps_its_shape_is_a_sphere():
    a = np.array([0.01, 0.1, 0.3, 0.5, 0.7, 0.999])
    sphere = heat.sphere_resistance(a, a_2=0.8 * a, r=1.0, k=2.0)
    found = heat.particle_resistance(a, a_2=0.8 * a, r=1.0, height=2.0, k=2.0)
    assert found == pytest.approx(sphere, rel=1e-15)


def test_a_flat_disc_is_a_cylinder():
    h = 1e-3
    a = math.sqrt(4 / 3 / h)
    found = heat.particle_resistance(a, a_2=a, r=1.0, height=h, k=3.0)
    assert found == pytest.approx(h / (3 * math.pi * a**2), rel=1e-6)
    assert heat.sphere_resistance(a, a_2=a, r=1.0, k=3.0) < 0
