"""Temperatures of all contacts: against explicit contacts one by one, and limits."""

import math
from dataclasses import replace

import numpy as np
import pytest
from refusals import Mistake, refuses
from scipy import stats

import thirdbody as tb
from thirdbody.contact.evaluation import Solved, spots_of
from thirdbody.contact.interface import interface
from thirdbody.effects import FlashTemperature, Friction

STEEL = tb.materials["S45C"].replace(thermal_conductivity=50.0, density=7850, specific_heat=480)
SILICA = tb.materials["SiO2"].replace(thermal_conductivity=1.4)
FRICTION = Friction(tau_ss=580e6, tau_sa=200e6)
pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")


def contact(*, size=300e-9, density=0.0, first=STEEL, second=STEEL, dust=SILICA, **given):
    heat = FlashTemperature(**(dict(v=1.0, A_n=1e-6) | given))
    particles = None
    if density:
        diameter = tb.TruncatedGaussian(mean=size, std=0.2 * size)
        particles = tb.Particles(material=dust, areal_density=density, diameter=diameter)
    return tb.Contact(
        surfaces=tb.MaterialPair(first, second),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=particles,
        particle_law=tb.particle.Series(deep="off"),
        outputs=(FRICTION, heat),
    )


def rise(pressure=5e6, **given):
    return tb.solve(contact(**given), pressure=pressure).outputs


def spot(area, v=1.0, k=50.0):
    """Rise of one asperity contact: 580 MPa of shear, uniform heat, largest temperature."""
    b, D = np.sqrt(area / np.pi), 50 / (7850 * 480)
    q = 580e6 * v
    rises = [2 * q * b / (k * np.sqrt(np.pi * (4 / np.pi + Pe))) for Pe in (0, v * b / (2 * D))]
    return 1 / (1 / rises[0] + 1 / rises[1])


def test_values():
    """By area: an independent state. Peak: the deepest asperity of 1 mm² by hand."""
    case = contact()
    state = tb.solve(case, pressure=5e6)
    assert state.outputs["dT_ss_area"] == pytest.approx(2.6293832753759974, rel=1e-9)
    rough = case.roughness
    top = stats.norm.isf(math.log(2) / (1e-6 * rough.density))
    omega = rough.sigma_s * top - state.d
    area = tb.asperity.ZMC().area(omega, R=rough.R, E_star=case.E_ss, H=STEEL.H)
    assert state.outputs["dT_ss_peak"] == pytest.approx(spot(area), rel=1e-9)
    assert state.outputs["dT_ss_peak"] == pytest.approx(6.295905147632126, rel=3e-3)


@pytest.mark.parametrize("quantiles", ["number", "area", "load"])
def test_explicit_asperities(quantiles):
    """A million asperities one by one."""
    case = contact(quantiles=quantiles)
    state = tb.solve(case, pressure=2e7)
    rough = case.roughness
    z = np.random.default_rng(1).standard_normal(2_000_000) * rough.sigma_s
    omega = (z - state.d)[z > state.d]
    law = dict(R=rough.R, E_star=case.E_ss, H=STEEL.H)
    area = tb.asperity.ZMC().area(omega, **law)
    weights = dict(number=1.0 + 0 * area, area=area, load=tb.asperity.ZMC().force(omega, **law))
    T = spot(area)
    for name, w in weights.items():
        error = 5 * np.std(w * (T - np.average(T, weights=w))) / np.mean(w) / math.sqrt(len(w))
        assert abs(state.outputs[f"dT_ss_{name}"] - np.average(T, weights=w)) < error
    order = np.argsort(T)
    part = np.cumsum(weights[quantiles][order])
    for share in (50, 95, 99):
        explicit = T[order][np.searchsorted(part, share / 100 * part[-1])]
        assert state.outputs[f"dT_ss_p{share}"] == pytest.approx(explicit, rel=0.012)


@pytest.mark.spread(2)
@pytest.mark.parametrize("second_H", [5e9, 2.5e9])
def test_explicit_particles(second_H):
    """Sizes and seats drawn at random, and every formula written out again."""
    second = STEEL.replace(H=second_H)
    case = contact(density=1e10, second=second, A_n=1e-8)
    state = tb.solve(case, pressure=5e6)
    rng = np.random.default_rng(2)
    count = 300_000
    x = case.particles.diameter.sample(rng, count)
    seats = rng.standard_normal(count) * case.roughness.sigma
    one = case.particle_law.single(x, state.h - seats, surfaces=case.surfaces, particle=SILICA)
    on = one["force"] > 0
    f, x = one["force"][on], x[on]
    a = [one[f"area_{i}"][on] for i in (1, 2)]
    delta = [one[f"delta_{i}"][on] for i in (1, 2)]
    b = [np.sqrt(each / np.pi) for each in a]

    # friction: the interface's own, of the same particles laid out as spots
    _, groups = spots_of(case, interface(case), np.atleast_1d(state.d), np.atleast_1d(state.shadow))
    spots = replace(
        groups[0], share=None, number=np.ones((1, len(x))), load=f[None], x=x[None],
        radius=x[None] / 2, depths=tuple(each[None] for each in delta),
        sinks=tuple(each[None] for each in delta), areas=tuple(each[None] for each in a),
    )  # fmt: skip
    Q = sum(FRICTION.of_particles(spots).values())[0]
    rolls, side = FRICTION.rolls(spots)[0], FRICTION.sliding_side(spots)[0]
    D = 50 / (7850 * 480)

    def G(b, v):
        return np.pi * b * 50 * np.sqrt(np.pi * (4 / np.pi + v * b / (2 * D))) / 2

    R = sum(
        1 / (np.pi * 1.4 * each) + (np.log(2 * x / each) - 0.5) / (2 * np.pi * 1.4 * x)
        for each in b
    )
    T = np.empty(len(x))
    for i in range(len(x)):
        here = [G(each[i], 0.5 if rolls[i] else float(side[i] == j)) for j, each in enumerate(b)]
        heat = [Q[i] / 2] * 2 if rolls[i] else [Q[i] * (side[i] == j) for j in (0, 1)]
        matrix = [[here[0] + 1 / R[i], -1 / R[i]], [-1 / R[i], here[1] + 1 / R[i]]]
        T[i] = max(np.linalg.solve(matrix, heat)) if i < 60_000 else np.nan
    some = slice(0, 60_000)
    T, f, smaller = T[some], f[some], np.minimum(*a)[some]
    for name, w in (("number", np.ones_like(f)), ("load", f), ("area", smaller)):
        mean = np.average(T, weights=w)
        error = 5 * np.std(w * (T - mean)) / np.mean(w) / math.sqrt(len(T))
        assert abs(state.outputs[f"dT_sa_{name}"] - mean) < error
    for share in (0.5, 0.95, 0.99):
        noise = 5 * math.sqrt(share * (1 - share) / len(T))
        low, high = np.quantile(T, [max(share - noise, 0), min(share + noise, 1)])
        found = state.outputs[f"dT_sa_p{share * 100:.0f}"]
        assert 0.99 * low < found < 1.01 * high
    # hottest of 1e-8 m²: 100 particles, those without load among them
    loaded = 1e10 * 1e-8 * on.mean()
    noise = math.log(2) / loaded
    peak = np.quantile(T, 1 - noise)
    assert state.outputs["dT_sa_peak"] == pytest.approx(peak, rel=0.02)


def test_finer_nodes_change_little():
    """Twice the nodes of the particles: means to 1e-6, quantiles within 1 %."""
    case = contact(density=1e10, second=STEEL.replace(H=2.5e9))
    pressure = np.geomspace(1e6, 3e7, 4)
    state = tb.solve(case, pressure=pressure)
    bound = interface(case)
    asperities, particles = spots_of(case, bound, state.d, state.shadow)
    (response,) = bound.populations
    splits = sorted(
        {
            *(
                float(e)
                for e in FRICTION.splits(
                    lambda eps: replace(
                        case.particle_law.probe(
                            eps, surfaces=case.surfaces, particle=case.particles.material
                        ),
                        material=case.particles.material,
                    )
                )
            ),
            *np.geomspace(1e-3, 0.3, 9),
        }
    )
    finer = [
        replace(spots, population=case.particles, material=case.particles.material)
        for spots in response.spots(state.d, splits)
    ]
    given = dict(contact=case, d=state.d, h=state.h, pressure=pressure, A_t=state.A_t)
    one, two = (
        case.outputs[1].of(Solved(**given, asperities=asperities, particles=each))
        for each in (particles, finer)
    )
    for name in FlashTemperature.columns:
        exact = name in ("dT_sa_number", "dT_sa_area", "dT_sa_load") or "ss" in name
        np.testing.assert_allclose(two[name], one[name], rtol=1e-5 if exact else 1e-2)


def test_slow_and_fast():
    """Q ∝ v: ΔT ∝ v at Pe ≪ 1, and ∝ √v where both bodies are fast."""
    slow = [rise(v=v, density=1e10)["dT_peak"] for v in (1e-4, 2e-4)]
    assert slow[1] / slow[0] == pytest.approx(2, rel=1e-4)
    fast = [rise(v=v, spots_on="both")["dT_ss_load"] for v in (1e6, 4e6)]
    assert fast[1] / fast[0] == pytest.approx(2, rel=1e-2)
    assert rise(v=0.0, density=1e10)["T_peak"] == 0


def test_what_the_particle_conducts():
    """A poor conductor is the hottest; a good one is two half-spaces and its constrictions."""
    peaks = [
        rise(
            density=1e10, second=STEEL.replace(H=2e9), dust=SILICA.replace(thermal_conductivity=k)
        )["dT_sa_load"]
        for k in (1e-9, 1e-6, 1.4, 50.0, 1e9)
    ]
    assert np.all(np.diff(peaks) <= 0)
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-4)
    assert peaks[4] < 0.8 * peaks[0]


def test_zero_particles():
    bare, none = rise(), rise(density=0.0)
    assert math.isnan(bare["dT_sa_load"])
    assert bare["dT_peak"] == bare["dT_ss_peak"] == none["dT_peak"]
    few = rise(density=1e3)
    assert few["dT_ss_load"] == pytest.approx(bare["dT_ss_load"], rel=1e-6)
    assert math.isnan(few["dT_sa_peak"])  # less than one on 1 mm²
    assert few["dT_sa_load"] > 0


def test_swapped_surfaces():
    soft = STEEL.replace(H=2.5e9, thermal_conductivity=20.0)
    one = rise(density=1e10, second=soft, spots_on="second", T_2=3.0)
    two = rise(density=1e10, first=soft, spots_on="first", T_1=3.0)
    for name in FlashTemperature.columns:
        assert one[name] == pytest.approx(two[name], rel=1e-7), name


def test_change_of_units():
    """Lengths × L and conductivity × L at equal speed: the same temperatures."""
    L = 5.0
    one = rise(density=1e10)
    metal, dust = (
        body.replace(thermal_conductivity=L * body.thermal_conductivity) for body in (STEEL, SILICA)
    )
    case = contact(size=300e-9 * L, density=1e10 / L**2, first=metal, second=metal, dust=dust,
                   A_n=1e-6 * L**2)  # fmt: skip
    case = case.replace(roughness=tb.Roughness(sigma=100e-9 * L, R=2.8e-6 * L))
    two = tb.solve(case, pressure=5e6).outputs
    for name in FlashTemperature.columns:
        assert one[name] == pytest.approx(two[name], rel=1e-6), name


def test_bulk():
    warm = tb.solve(contact(density=1e10, T_1=40.0, T_2=40.0), pressure=5e6).outputs
    cold = rise(density=1e10)
    assert warm["T_peak"] == pytest.approx(40 + cold["T_peak"])
    net = rise(density=1e10, T_1=20.0, T_2=60.0, h_1=3000.0, h_2=1000.0)
    assert net["T_bulk"] == pytest.approx((net["mu"] * 5e6 * 1.0 + 120e3) / 4000, rel=1e-9)
    assert net["dT_peak"] == pytest.approx(cold["dT_peak"], rel=1e-12)
    # bodies apart: the contact lies between, nearer the one that conducts better
    apart = rise(T_1=100.0, T_2=0.0, v=1e-9)
    assert apart["T_peak"] == pytest.approx(50, rel=1e-6)
    assert apart["T_bulk"] == 100


def test_lifetime():
    steady, short = (rise(lifetime=each) for each in ("steady", "lifetime"))
    assert short["dT_ss_peak"] < steady["dT_ss_peak"]
    slow = [rise(lifetime=each, v=1e-5)["dT_ss_peak"] for each in ("steady", "lifetime")]
    assert slow[0] == pytest.approx(slow[1], rel=1e-2)
    assert slow[0] > slow[1]


PLACE = "outputs.flash_temperature"


def test_kinds_are_ordered():
    at = {
        (flux, kind): rise(flux=flux, kind=kind, density=1e10)
        for flux in ("uniform", "hertz")
        for kind in ("mean", "max")
    }
    for name in ("dT_ss_load", "dT_sa_load", "dT_peak"):
        assert at["uniform", "mean"][name] < at["uniform", "max"][name] < at["hertz", "max"][name]
    # a quantile lies between mean and peak
    out = at["uniform", "max"]
    assert out["dT_ss_p50"] < out["dT_ss_p95"] < out["dT_ss_p99"] < out["dT_ss_peak"]
    assert out["dT_ss_number"] < out["dT_ss_load"]


@pytest.mark.parametrize(
    ("given", "code", "place", "says"),
    [
        (dict(first=tb.materials["WC"]), Mistake.MISSING, PLACE, "specific_heat of surface 1"),
        (
            dict(dust=tb.materials["TiO2"], density=1e10),
            Mistake.MISSING,
            PLACE,
            "thermal_conductivity of the particles",
        ),
        (dict(h_1=10.0), Mistake.CLASH, "FlashTemperature.h_1", "h_2"),
        (dict(h_1=0.0, h_2=0.0), Mistake.CLASH, "FlashTemperature.h_1", "no way out"),
        (dict(A_n=0.0), Mistake.RANGE, "FlashTemperature.A_n", "m^2"),
    ],
)
def test_mistakes(given, code, place, says):
    with refuses(code, place, says=says):
        contact(**given)


def test_needs_friction():
    with refuses(Mistake.MISSING, "outputs.flash_temperature", says="outputs.friction"):
        contact().replace(outputs=(FlashTemperature(v=1.0, A_n=1e-6),))
