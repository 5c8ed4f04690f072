"""Film, asperities and particles carry one load: against sums made here, limits, scaling."""

import math
import warnings

import numpy as np
import pytest
from scipy import integrate, optimize, stats

import thirdbody as tb
from thirdbody.errors import code_of, note_of
from thirdbody.systems import film_formulas as films
from thirdbody.systems.film_conditions import Entrainment
from thirdbody.systems.mixed_film import COLUMNS, height_of, mean_gap, mixed_film
from thirdbody.systems.stribeck import stribeck

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
BALL, OIL = films.Point(R=9.5e-3), films.Oil(eta=0.02, alpha=2e-8)
pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")


def case(size=0.0, density=1e10, sigma=100e-9, **others):
    dust = None
    if size:
        sizes = tb.TruncatedGaussian(mean=size, std=0.2 * size)
        dust = tb.Particles(material=SILICA, areal_density=density, diameter=sizes)
    rough = tb.Roughness(sigma=sigma, R=28 * sigma)
    pair = tb.MaterialPair(STEEL, STEEL)
    others.setdefault("particle_law", tb.particle.Series(deep="off"))
    return tb.Contact(surfaces=pair, roughness=rough, particles=dust, **others)


def run(contact, speed, load=20.0, **options):
    given = {"conjunction": BALL, "oil": OIL} | options
    return mixed_film(contact, load=load, speed=speed, **given)


# ------------------------------------------------------------------ the gap
@pytest.mark.parametrize("t", [-3.0, -0.5, 0.63, 2.0, 6.0])
def test_mean_gap_is_an_integral(t):
    value, _ = integrate.quad(lambda z: (t - z) * stats.norm.pdf(z), -np.inf, t, epsabs=1e-14)
    assert float(mean_gap(t * 1e-7, sigma=1e-7)) == pytest.approx(value * 1e-7, rel=1e-7)


def test_height_undoes_mean_gap():
    h = np.concatenate([np.linspace(-4, 8, 49), [1e3, 1e6]]) * 1e-7
    np.testing.assert_allclose(
        height_of(mean_gap(h, sigma=1e-7), sigma=1e-7), h, rtol=1e-11, atol=1e-19
    )
    assert float(mean_gap(0.63e-7, sigma=1e-7)) == pytest.approx(0.79e-7, rel=0.005)


# ------------------------------------------------------------------ the balance
@pytest.mark.parametrize(("speed", "share"), [(0.02, 0.0095118786), (0.5, 0.5347478689)])
def test_balance_of_a_bare_contact_by_hand(speed, share):
    """The load of the asperities by adaptive quadrature, the balance in h instead of γ."""
    contact = case()
    rough, law, pair = contact.roughness, contact.asperity_law, contact.surfaces
    E = 2 * pair.E_star
    a = (3 * 20 * BALL.R / (2 * E)) ** (1 / 3)
    p = 20 / (math.pi * a * a)
    omega = law.yield_interference(R=rough.R, E_star=pair.E_star, H=pair.H)
    kinks = [omega * y for y in law.breakpoints]

    def solids(h):
        d = h - rough.y_s
        ends = [d, *(d + k for k in kinks), 8 * rough.sigma_s]
        total = 0.0
        for low, high in zip(ends[:-1], ends[1:], strict=True):
            total += integrate.quad(
                lambda z: (
                    float(law.force(z - d, R=rough.R, E_star=pair.E_star, H=pair.H))
                    * stats.norm.pdf(z / rough.sigma_s)
                    / rough.sigma_s
                ),
                low,
                max(low, high),
                epsrel=1e-11,
                limit=200,
            )[0]
        return rough.density * total

    def excess(t):
        gamma = 1 / (1 - solids(t * rough.sigma) / p)
        film = films.NijenbanningVennerMoes().central(
            load=20 / gamma, speed=speed, eta=0.02, alpha=2e-8, R=BALL.R, E=E / gamma
        )
        return math.log(float(mean_gap(t * rough.sigma, sigma=rough.sigma)) / film)

    # below this gap the asperities alone carry more than the load
    dry = optimize.brentq(lambda t: solids(t * rough.sigma) / p - 1, 0.0, 3.0, xtol=1e-14)
    t = optimize.brentq(excess, dry * (1 + 1e-6), 4.0, xtol=1e-14)
    found = run(contact, speed)
    assert found.film_share == pytest.approx(1 - solids(t * rough.sigma) / p, rel=1e-8)
    assert found.H == pytest.approx(t, rel=1e-9)
    # an independent code, whose last digits differ from both routes here
    assert found.film_share == pytest.approx(share, rel=3e-6)


@pytest.mark.parametrize(
    ("size", "speed", "share", "area"),
    [
        (0.0, 0.5, 0.5347478689, 0.05899),
        (300e-9, 0.5, 0.5305515504, 0.05942),
        (500e-9, 0.5, 0.5213216123, 0.06038),
        (0.0, 0.02, 0.0095118786, 0.12117),
        (500e-9, 0.02, 0.0093173113, 0.12104),
    ],
)
def test_reference_run(size, speed, share, area):
    state = run(case(size), speed)
    assert state.pressure == pytest.approx(542e6, rel=1e-3)
    assert state.film_share == pytest.approx(share, rel=3e-6)
    assert round(state.A_t, 5) == area


@pytest.mark.parametrize("size", [0.0, 500e-9])
def test_shares_are_one_and_the_volume_is_that_of_the_film(size):
    contact = case(size)
    state = run(contact, np.geomspace(1e-3, 10, 25))
    total = state.film_share + state.ss_share + state.sa_share
    np.testing.assert_allclose(total, 1, atol=1e-12)
    np.testing.assert_allclose(mean_gap(state.h, sigma=100e-9), state.h_T, rtol=1e-11)
    np.testing.assert_allclose(state.film_share * state.gamma, 1, rtol=1e-14)
    E = 2 * contact.E_ss
    thick = films.NijenbanningVennerMoes().central(
        load=20 / state.gamma, speed=state.speed, eta=0.02, alpha=2e-8, R=BALL.R, E=E / state.gamma
    )
    np.testing.assert_allclose(thick, state.h_T, rtol=1e-13)
    assert np.all(np.diff(state.film_share) > 0)
    assert np.all(np.diff(state.h) > 0)
    assert set(state.regime) == {"boundary", "mixed", "full film"}


def test_slow_is_dry_and_fast_is_smooth():
    contact = case(300e-9)
    slow = run(contact, 1e-9)
    dry = tb.solve(contact, pressure=slow.pressure)
    assert slow.film_share < 1e-8
    assert slow.A_t == pytest.approx(dry.A_t, rel=1e-7)
    assert slow.h == pytest.approx(dry.h, rel=1e-7)
    fast = run(contact, 50.0)
    assert fast.film_share == pytest.approx(1, abs=1e-12)
    assert fast.h_T == pytest.approx(fast.h_smooth, rel=1e-12)
    assert fast.regime == "full film"
    assert fast.H == pytest.approx(fast.lambda_ratio, rel=1e-9)


def test_no_particles_are_bare():
    none, bare = run(case(300e-9, density=1e-3), 0.1), run(case(), 0.1)
    assert none.film_share == pytest.approx(bare.film_share, rel=1e-9)
    assert math.isnan(bare.h_over_x)
    assert bare.sa_share == 0


def test_every_length_doubled():
    """σ, R, x_a, the ball and the film double, loads grow fourfold: the same shares."""
    small = run(case(300e-9), 0.3)
    ball = films.Point(R=2 * BALL.R)
    large = run(case(600e-9, density=2.5e9, sigma=200e-9), 0.6, load=80.0, conjunction=ball)
    for name in ("film_share", "ss_share", "sa_share", "A_t", "H", "lambda_ratio", "h_over_x"):
        assert getattr(large, name) == pytest.approx(getattr(small, name), rel=1e-8), name


def test_swapped_surfaces():
    soft = STEEL.replace(H=3e9, E=150e9)
    contact = case(400e-9)
    shares = [
        run(contact.replace(surfaces=pair), 0.2).film_share
        for pair in (tb.MaterialPair(STEEL, soft), tb.MaterialPair(soft, STEEL))
    ]
    assert shares[0] == pytest.approx(shares[1], rel=1e-10)


def test_one_by_one():
    contact = case(300e-9)
    u, w = np.array([0.02, 0.3, 2.0]), np.array([5.0, 20.0, 80.0])
    many = run(contact, u, w)
    for i in range(3):
        one = run(contact, float(u[i]), float(w[i]))
        assert isinstance(one.h, float)
        for name in COLUMNS:
            value = getattr(many, name)[i]
            if name in ("residual", "regime", "status"):
                continue
            assert getattr(one, name) == pytest.approx(value, rel=1e-11, nan_ok=True), name
        assert one.state.d == pytest.approx(many.state.d[i], rel=1e-11)


# ------------------------------------------------------------------ what it predicts
def test_particles_raise_the_area_in_mixed_and_lower_it_in_boundary_lubrication():
    contacts = [case(x) for x in (0.0, 300e-9, 500e-9)]
    mixed = [run(each, 0.5).A_t for each in contacts]
    boundary = [run(each, 0.02).A_t for each in contacts]
    assert mixed[0] < mixed[1] < mixed[2]
    assert boundary[0] > boundary[1] > boundary[2]
    dry = [tb.solve(each, pressure=541.9e6).A_t for each in contacts]
    np.testing.assert_allclose(dry, [0.12228, 0.12222, 0.12212], atol=6e-6)


def test_lambda_does_not_order_the_contact_once_particles_bridge():
    """More film over σ, and yet more load on solids."""
    clean, dirty = run(case(), 1.5), run(case(1e-6, density=1e10), 1.5)
    assert dirty.lambda_ratio >= clean.lambda_ratio
    assert dirty.solid_share > 2 * clean.solid_share
    assert dirty.h_over_x < 1


# ------------------------------------------------------------------ traction
RUBS = films.Oil(eta=0.02, alpha=2e-8, eyring_stress=5e6)


def test_traction_parts():
    friction = tb.outputs.Friction(tau_ss=500e6, tau_sa=300e6)
    contact = case(400e-9, outputs=friction)
    state = run(contact, np.geomspace(5e-3, 5, 9), oil=RUBS, slide_roll=0.1)
    np.testing.assert_allclose(state.mu_film + state.mu_ss + state.mu_sa, state.mu, rtol=1e-14)
    mu_s = np.asarray(state.state.outputs["mu"])
    solids = state.solid_share
    np.testing.assert_allclose(state.mu_ss + state.mu_sa, mu_s * solids, rtol=1e-10, atol=1e-15)
    rate = 0.1 * state.speed / state.h_T
    stress = 5e6 * np.arcsinh(RUBS.at_pressure(state.pressure * state.film_share) * rate / 5e6)
    expected = (1 - state.A_t) * stress / state.pressure
    np.testing.assert_allclose(state.mu_film, expected, rtol=1e-13)
    assert np.all(np.diff(state.mu_ss) < 0)
    rolling = run(contact, 0.1, oil=RUBS, slide_roll=0.0)
    assert rolling.mu == 0


def test_no_traction_without_its_numbers():
    assert math.isnan(run(case(), 0.1, oil=RUBS).mu)
    state = run(case(), 0.1, oil=RUBS, slide_roll=0.1)
    assert state.mu_film > 0
    assert math.isnan(state.mu)


def test_stribeck_curve():
    contact = case(400e-9, outputs=tb.outputs.Friction(tau_ss=500e6, tau_sa=300e6))
    speeds = np.geomspace(1e-3, 20, 40)
    curve = stribeck(contact, conjunction=BALL, oil=RUBS, load=20.0, speed=speeds, slide_roll=0.05)
    assert curve.mu.attrs == {"symbol": "μ", "units": "1", "long_name": "traction coefficient"}
    assert curve.sizes == {"speed": 40}
    np.testing.assert_allclose(curve.hersey, 0.02 * speeds * 9.5e-3 / 20)
    # boundary friction, then a fall, then the film's own traction
    mu, solid = curve.mu.values, (curve.mu_ss + curve.mu_sa).values
    assert mu[0] == pytest.approx(solid[0], rel=0.01)
    assert mu.min() < 0.6 * mu[0]
    assert set(curve.regime.values.tolist()) == {"boundary", "mixed", "full film"}
    line = stribeck(
        case(), conjunction=films.Line(R=0.01, length=0.01), oil=OIL, load=2000.0, speed=speeds
    )
    share = line.film_share.values
    assert np.all(np.diff(share)[share[1:] < 0.999] > 0)
    assert share[0] < 0.01 < 0.999 < share[-1]


# ------------------------------------------------------------------ what enters
def test_entrained_particles_by_hand():
    x = 1e-6
    one = tb.distributions.Monodisperse(mean=x)
    dirt = Entrainment(concentration=1e-5, entry_ratio=0.5, friction=0.2)
    n = 6e-5 / (math.pi * x**3)
    assert dirt.per_volume(one) == pytest.approx(n)
    assert dirt.areal_density(one, h=2e-6, R=0.01) == pytest.approx(0.5 * n * 2e-6)
    assert dirt.areal_density(one, h=0.3e-6, R=0.01) == pytest.approx(0.5 * n * x)
    film = dirt.replace(height="film")
    assert film.areal_density(one, h=0.3e-6, R=0.01) == pytest.approx(0.5 * n * 0.3e-6)
    # too large for the wedge
    assert dirt.areal_density(tb.distributions.Monodisperse(mean=2e-3), h=0.3e-6, R=0.01) == 0
    assert dirt.passes(one, h=2e-6) == 1


@pytest.mark.parametrize("height", ["size", "film"])
def test_entrained_particles_by_drawing(height):
    sizes = tb.LogNormal(median=1e-6, gsd=1.6)
    dirt = Entrainment(concentration=1e-5, entry_ratio=1.0, friction=0.012, height=height)
    h, R = 0.8e-6, 0.01
    x = sizes.sample(np.random.default_rng(2), 1_000_000)
    layer = np.maximum(h, x) if height == "size" else h
    drawn = np.mean(layer * (x <= dirt.largest(h, R=R)))
    found = dirt.areal_density(sizes, h=h, R=R) / dirt.per_volume(sizes)
    assert found == pytest.approx(drawn, rel=5e-3)
    assert float(dirt.passes(sizes, h=h)) == pytest.approx(np.mean(x < h), abs=2e-3)


@pytest.mark.parametrize("friction", [0.02, 0.05, 0.1])
def test_largest_particle_in_the_wedge(friction):
    """A sphere between a flat and a cylinder's circle slips out above twice the friction angle."""
    R, h = 0.01, 1e-6

    def wedge(x):
        # centre of the sphere at x/2 above the flat, touching the circle outside
        r = x / 2
        up = R + h - r
        return math.acos(up / (R + r))

    x = optimize.brentq(lambda x: math.tan(wedge(x) / 2) - friction, h * (1 + 1e-9), R)
    found = Entrainment(concentration=1e-5, entry_ratio=1.0, friction=friction).largest(h, R=R)
    assert found == pytest.approx(x, rel=3 * friction**2)


# ------------------------------------------------------------------ refusals
def test_refusals():
    contact = case()
    for words, changes in {
        "speed = 0 must be finite and > 0": {"speed": 0.0},
        "load = -3 must be": {"load": -3.0},
        "differ in length": {"load": [1.0, 2.0], "speed": [0.1, 0.2, 0.3]},
        "is for line contacts": {"film": films.MoesLine()},
        "must be 'mean' or 'maximum'": {"hertz": "peak"},
        "must be films.Oil": {"oil": 0.04},
        "must be films.Point or films.Line": {"conjunction": 9.5e-3},
        "slide_roll = -1": {"slide_roll": -1},
        "few, most = 0.5, 0.1": {"few": 0.5, "most": 0.1},
    }.items():
        given = {"conjunction": BALL, "oil": OIL, "load": 20.0, "speed": 0.1} | changes
        with pytest.raises(tb.errors.InvalidValue, match=words):
            mixed_film(contact, **given)
    with pytest.raises(TypeError, match="entry_ratio"):
        Entrainment(concentration=1e-5, friction=0.1)


def test_thin_films_are_told():
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        state = run(case(), 0.02)
    assert "film.thin" in [code_of(note_of(each.message)) for each in heard]
    assert "film.thin" in map(code_of, state.warnings)


def test_other_heights_are_told():
    rough = case().roughness.replace(heights=tb.heights.WeibullHeights(shape=4.0))
    state = run(case().replace(roughness=rough), 2.0)
    assert any("WeibullHeights" in sentence for sentence in state.warnings)


def test_a_formula_beyond_its_regime_may_have_no_balance():
    with pytest.raises(tb.errors.NoEquilibrium, match="speed = 1e-12 m/s"):
        run(case(), [1e-12, 0.1], film=films.HamrockDowson())


def test_thresholds():
    state = run(case(), np.array([0.02, 0.5]))
    assert state.regime.tolist() == ["boundary", "mixed"]
    assert state.regimes(most=0.995).tolist() == ["mixed", "mixed"]
    assert state.regimes(few=0.5).tolist() == ["boundary", "full film"]
