"""Particles that break: closed limits, values from elsewhere, and explicit grains that break."""

import json
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.contact.broken_averages import BrokenAverage, roughly
from thirdbody.contact.interface import interface
from thirdbody.laws.base import OneParticle, Squeezed
from thirdbody.laws.particle.breakage import Breakage, crush_embed_size
from thirdbody.laws.particle.tension import at_centre, at_equator, confined_tension, tension

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")

CASES = json.loads((Path(__file__).parents[1] / "cases" / "crushing.json").read_text())["values"]
STEEL = tb.Material(E=206e9, nu=0.29, H=7.4e9)
SOFTER = tb.Material(E=180e9, nu=0.3, H=3e9)
QUARTZ = tb.Material(E=95.8e9, nu=0.082, H=12e9, name="quartz")
PAIR = tb.MaterialPair(STEEL, STEEL)
STRENGTH = tb.grains.WeibullStrength(sigma_0=67e6, x_0=1e-3, m=3, size_exponent=0.55, x_c=0.96e-6)
ONE = tb.particle.Series(deep="off").one(surfaces=PAIR, particle=QUARTZ)
UNIFORM = tb.distributions.Uniform(low=4e-6, high=8e-6)
FRAGMENTS = ("gone", "footprint", "all")


def average_of(strength, sizes, *, one=ONE, material=QUARTZ):
    """The average over sizes, and the scale of its lengths [m]."""
    scale, shape = sizes.standardised()
    return BrokenAverage(one, shape, Breakage.of_material(strength, material, scale)), scale


def expected_load(x, gap, strength, one=ONE):
    """Mean load [N] of one particle of size x and its pieces."""
    average, scale = average_of(strength, tb.distributions.Monodisperse(mean=x), one=one)
    return scale**2 * average.average(np.array([gap / x]), np.array([1 - gap / x]))[0, 0]


def contact_of(strength, *, seat="rough", sizes=UNIFORM, pair=PAIR, material=QUARTZ, **others):
    dust = tb.Particles(material=material, diameter=sizes, areal_density=1e8, strength=strength)
    others = {"roughness": tb.Roughness(sigma=0.5e-6, R=1e-4)} | others
    law = tb.particle.Series(deep="off", seat=seat)
    return tb.Contact(surfaces=pair, particles=dust, particle_law=law, **others)


def pressure_of(contact, h):
    """F_sa [Pa] at separations h [m] of the mean planes."""
    bound = interface(contact)
    return bound.particles.fields(np.atleast_1d(h) - bound.mean_plane)["F_sa"]


# ---------------------------------------------------------------- values from elsewhere
def library(case):
    q, inputs = case["quantity"], case["inputs"]
    if q.startswith(("T_c", "T_e", "G")):
        f = {"T_c": at_centre, "T_e": at_equator, "G": confined_tension}[q.split()[0]]
        return f(np.array([inputs["s"]]), inputs["nu"])[0]
    if q.startswith("running"):
        return tension(ONE, QUARTZ.nu, "sphere")(np.array([inputs["eps"]]))[0]
    fragments = {0.0: "gone", 0.5: "footprint", 1.0: "all"}.get(inputs.get("kept"), "gone")
    strength = STRENGTH.replace(fragments=fragments)
    if q.startswith("survival"):
        eps = np.array([1 - inputs["g"] / inputs["x"]])
        law = Breakage.of_material(strength, QUARTZ, inputs["x"])
        return law.survival(np.ones(1), tension(ONE, QUARTZ.nu, "sphere")(eps))[0]
    if q.startswith("expected"):
        return expected_load(inputs["x"], inputs["g"], strength)
    breaks = None if inputs["kept"] == "uncrushed" else strength
    return pressure_of(contact_of(breaks), inputs["h"])[0]


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case['quantity']}-{case['value']:.4g}")
def test_values_of_an_independent_implementation(case):
    assert library(case) == pytest.approx(case["value"], rel=case["rel_tol"])


def test_a_realistic_case():
    """Quartz of 5 to 40 µm between 60 HRC, counted by hand elsewhere to the digits shown."""
    hard = tb.Material(E=206e9, nu=0.29, H=7.37e9)
    sizes = tb.distributions.PowerLaw(edges=(5e-6, 40e-6), counts=(1,), slopes=(3.0,))
    gaps = np.array([30, 20, 10, 5, 2, 0.1]) * 1e-6
    told = {
        None: [0.0246, 0.212, 0.967, 2.48, 3.81, 3.81],
        "gone": [0.0023, 0.0052, 0.023, 0.204, 0.552, 0.552],
        "footprint": [0.0023, 0.0052, 0.035, 0.350, 2.19, 3.81],
        "all": [0.0023, 0.0052, 0.046, 0.586, 6.0, 16.5],
    }
    quartz = tb.materials["quartz"]
    caught = sizes.partial_moment(0, gaps, np.inf)
    mass = sizes.partial_moment(3, gaps, np.inf) / sizes.moment(3)
    for fragments, expected in told.items():
        strength = fragments and tb.grains.WeibullStrength.of(quartz, fragments=fragments)
        dust = tb.Particles(material=quartz, diameter=sizes, areal_density=1e7, strength=strength)
        contact = tb.Contact(
            surfaces=tb.MaterialPair(hard, hard),
            roughness=tb.Roughness(sigma=50e-9, R=20e-6),
            particles=dust,
            particle_law=tb.particle.Series(deep="off", seat="plane"),
            outputs=(tb.outputs.Crushing(),) if strength else (),
        )
        state = tb.solve(contact, d=gaps)
        found = (state.pressure * state.particle_load_share)[:-1] / 1e6
        np.testing.assert_allclose(found, expected[:-1], rtol=0.025)  # two digits are shown
        closed = interface(contact).particles.fields(gaps[-1:])["F_sa"][0] / 1e6
        assert closed == pytest.approx(expected[-1], rel=2e-3)
        if strength:
            broken = state.outputs["broken_share"] * caught
            of_mass = state.outputs["broken_mass_share"] * mass
            np.testing.assert_allclose(broken, [0.002, 0.009, 0.08, 0.48, 0.75, 0.75], atol=0.006)
            np.testing.assert_allclose(of_mass, [0.095, 0.28, 0.59, 0.86, 0.92, 0.92], atol=0.006)


# ---------------------------------------------------------------- tension
def test_tension_of_small_caps_and_where_it_ends():
    for nu, familiar in ((0.082, 0.902), (0.25, 0.810), (0.3, 0.786)):
        K = (7 + 2 * nu) / (7 + 5 * nu)
        small = at_centre(np.zeros(1), nu)[0]
        assert small == pytest.approx(4 / math.pi * (5 * K / 4 - 0.5), rel=1e-14)
        assert small == pytest.approx(familiar, abs=6e-4)
        assert confined_tension(np.array([1e-6]), nu)[0] == pytest.approx(1, abs=1e-9)
        # T_c = 0 where 5/4 K c (1 + c) = 1
        c = 0.5 * (math.sqrt(1 + 3.2 / K) - 1)
        assert at_centre(np.array([math.sqrt(1 - c * c)]), nu)[0] == pytest.approx(0, abs=1e-14)


@pytest.mark.parametrize(
    ("nu", "g", "s"),
    [(0.07, 0.211, 0.63), (0.14, 0.213, 0.78), (0.2, 0.266, 0.81), (0.3, 0.367, 0.86)],
)
def test_largest_tension_under_the_pressure_of_plastic_contacts(nu, g, s):
    at = np.linspace(0.01, 1, 4001)
    load = at**2 * confined_tension(at, nu)  # F/x² = πH s²/4
    assert load.max() == pytest.approx(g, abs=6e-4)
    assert at[load.argmax()] == pytest.approx(s, abs=0.01)


def test_running_maximum_from_its_definition():
    eps = np.geomspace(1e-7, 1.5, 40_000)
    for pair in (PAIR, tb.MaterialPair(STEEL, SOFTER)):
        one = tb.particle.Series(deep="off").one(surfaces=pair, particle=QUARTZ)
        inside = tension(one, 0.2, "sphere")
        found = one.at(eps)
        s = [np.minimum(2 * np.sqrt(area / np.pi), 1.0) for area in found.areas]
        now = found.load * 0.5 * (confined_tension(s[0], 0.2) + confined_tension(s[1], 0.2))
        np.testing.assert_allclose(inside(eps), np.maximum.accumulate(now), rtol=1e-6)
        assert inside(np.zeros(1))[0] == 0
        # in front of the kink where the equator takes over, the tension falls by 1e-4
        assert np.all(np.diff(inside(eps)) >= -1e-9 * inside.greatest)
        at_all = tension(one, 0.2, "none")(eps)
        np.testing.assert_allclose(at_all, found.load, rtol=1e-9)


# ---------------------------------------------------------------- closed limits
@pytest.mark.parametrize("seat", ["rough", "plane"])
def test_strong_particles_are_those_of_before(seat):
    whole, strong = (
        contact_of(strength, seat=seat, sizes=sizes)
        for strength in (None, STRENGTH.replace(sigma_0=1e20))
        for sizes in (UNIFORM,)
    )
    d = np.linspace(0.5e-6, 8.2e-6, 40)
    for name, values in interface(whole).fields(d).items():
        scale = np.abs(values).max()
        np.testing.assert_allclose(
            interface(strong).fields(d)[name], values, rtol=1e-9, atol=1e-12 * scale
        )


@pytest.mark.parametrize("sizes", [UNIFORM, tb.TruncatedGaussian(mean=9e-6, std=2.5e-6),
                                   tb.LogNormal(median=4e-6, gsd=1.8),
                                   tb.distributions.Monodisperse(mean=7e-6)], ids=lambda s: type(s).__name__)  # fmt: skip
@pytest.mark.parametrize("m", [1.0, 3.0, 12.0])
def test_a_closed_gap_carries_what_whole_particles_would(sizes, m):
    """Fragments over the footprint of their parent, all embedded: min(H) πx²/4 exactly."""
    for sigma_0, ratio in ((67e6, 0.5), (1e6, 0.4), (5e8, 0.7)):
        strength = STRENGTH.replace(sigma_0=sigma_0, m=m, ratio=ratio)
        average, scale = average_of(strength, sizes)
        found = scale**2 * average.average(np.zeros(1), np.array([average.top]))[0, 0]
        assert found == pytest.approx(7.4e9 * np.pi / 4 * sizes.moment(2), rel=1e-9)


@pytest.mark.parametrize(
    "sizes", [UNIFORM, tb.distributions.Monodisperse(mean=7e-6)], ids=["many", "one"]
)
def test_pieces_of_all_generations_keep_the_volume(sizes):
    average, scale = average_of(STRENGTH.replace(fragments="all"), sizes)
    pieces = average.pieces(
        np.zeros((1, 1)), np.full((1, 1), average.top), nodes=16, squeezes=average.squeezes
    )
    volume = scale**3 * np.sum(pieces.number * pieces.x**3)
    assert volume == pytest.approx(sizes.moment(3), rel=1e-9)


def test_what_is_gone_leaves_the_survivors():
    x, gone = 20e-6, STRENGTH.replace(fragments="gone")
    for eps in (0.03, 0.1, 0.4, 0.9):
        whole = x**2 * ONE.at(np.array([eps])).load[0]
        law = Breakage.of_material(gone, QUARTZ, x)
        share = law.survival(np.ones(1), tension(ONE, QUARTZ.nu, "sphere")(np.array([eps])))[0]
        assert expected_load(x, x * (1 - eps), gone) == pytest.approx(share * whole, rel=1e-10)


def test_survival_at_the_characteristic_and_the_median_strength():
    law = Breakage.of_material(STRENGTH, QUARTZ, 1e-5)
    sigma = STRENGTH.of_size(1e-5)
    stress = np.array([sigma, sigma * math.log(2) ** (1 / 3)])
    np.testing.assert_allclose(law.survival(np.ones(2), stress), [1 / math.e, 0.5], rtol=1e-14)
    assert STRENGTH.replace(size_exponent=None).b == 1.0


@dataclass(frozen=True)
class Spring(OneParticle):
    """f = kε x², whatever its contacts."""

    stiffness: float
    kinks = (2.0,)
    hardness = (1e9, 1e9)
    yields = (1.0, 1.0)

    def at(self, eps):
        load = self.stiffness * np.minimum(eps, 2.0)
        area = np.full_like(eps, 1e-3)
        return Squeezed(load=load, depths=(eps / 2, eps / 2), areas=(area, area))

    def regime(self, side, depth):
        return np.zeros(np.shape(depth), dtype=np.intp)


@pytest.mark.parametrize("m", [1.5, 3.0, 8.0])
def test_the_load_of_springs_peaks_where_it_must(m):
    """G = 1 and f ∝ ε: at (σ/σ_x)^m = 1/m, where e^(−1/m) survive."""
    strength = tb.grains.WeibullStrength(
        sigma_0=1e8, x_0=1e-5, m=m, x_c=0.0, fragments="gone", confinement="none"
    )
    spring, x = Spring(5e8), 1e-5
    peak = 0.2 * (1 / m) ** (1 / m)
    at = np.array([peak * (1 - 1e-4), peak, peak * (1 + 1e-4)])
    loads = [expected_load(x, x * (1 - eps), strength, one=spring) for eps in at]
    assert loads[1] > loads[0]
    assert loads[1] > loads[2]
    assert loads[1] == pytest.approx(x**2 * 5e8 * peak * math.exp(-1 / m), rel=1e-9)


def test_below_x_c_nothing_breaks():
    gaps = np.linspace(0.0, 8e-6, 30)
    weak = STRENGTH.replace(sigma_0=1.0, x_c=8e-6)
    whole = pressure_of(contact_of(None), gaps)
    np.testing.assert_allclose(pressure_of(contact_of(weak), gaps), whole, rtol=1e-9)


def test_x_c_follows_from_toughness():
    tough = QUARTZ.replace(K_c=1.2e6)
    free = STRENGTH.replace(x_c=None)
    assert free.least(tough) == pytest.approx(96 * 1e-8, rel=1e-12)
    assert free.replace(B=30.0).least(tough) == pytest.approx(30 * 1e-8, rel=1e-12)
    assert free.least(QUARTZ) == 0.0
    # the toughness of an equal material decides: none of the two takes the other's sums
    d = np.array([0.2e-6])
    loads = [pressure_of(contact_of(free.replace(fragments="gone"), material=each,
                                    sizes=tb.distributions.Uniform(low=0.5e-6, high=1e-6)), d)[0]
             for each in (QUARTZ, QUARTZ.replace(K_c=2e6))]  # fmt: skip
    assert loads[0] < loads[1]


@pytest.mark.parametrize("fragments", FRAGMENTS)
def test_change_of_units(fragments):
    gaps, strength = np.linspace(0.3e-6, 7.5e-6, 12), STRENGTH.replace(fragments=fragments)
    before = pressure_of(contact_of(strength), gaps)
    # lengths × 3: loads × 9, particles per area / 9
    large = contact_of(
        strength.replace(x_0=3e-3, x_c=3 * 0.96e-6),
        sizes=UNIFORM.scaled(3),
        roughness=tb.Roughness(sigma=1.5e-6, R=3e-4),
    ).replace(**{"particles.areal_density": 1e8 / 9})
    np.testing.assert_allclose(pressure_of(large, 3 * gaps), before, rtol=1e-9)
    # stresses × 2
    twice = [body.replace(E=2 * body.E, H=2 * body.H) for body in (STEEL, QUARTZ)]
    hard = contact_of(
        strength.replace(sigma_0=2 * strength.sigma_0),
        pair=tb.MaterialPair(twice[0], twice[0]),
        material=twice[1],
    )
    np.testing.assert_allclose(pressure_of(hard, gaps), 2 * before, rtol=1e-9)


def test_surfaces_exchanged():
    gaps = np.linspace(0.3e-6, 7.5e-6, 12)
    one, two = (
        interface(contact_of(STRENGTH, pair=tb.MaterialPair(*bodies))).particles.fields(gaps)
        for bodies in ((STEEL, SOFTER), (SOFTER, STEEL))
    )
    np.testing.assert_allclose(one["F_sa"], two["F_sa"], rtol=1e-9)
    area = one["A_e"] + one["A_ep"] + one["A_p"]
    np.testing.assert_allclose(area, two["A_sa2"], rtol=1e-9)


@pytest.mark.parametrize("seat", ["rough", "plane"])
def test_what_pieces_bear_is_bounded(seat):
    gaps = np.linspace(0.1e-6, 8e-6, 60)
    gone, footprint, every = (
        pressure_of(contact_of(STRENGTH.replace(fragments=word), seat=seat), gaps)
        for word in FRAGMENTS
    )
    assert np.all(gone <= footprint * (1 + 1e-9))
    assert np.all(footprint <= every * (1 + 1e-9))
    assert every[0] > 1.5 * footprint[0] > 2 * gone[0]


def test_crush_embed_size():
    hard = tb.Material(E=206e9, nu=0.29, H=7.4e9)
    one = tb.particle.Series(deep="off").one(surfaces=tb.MaterialPair(hard, hard), particle=QUARTZ)
    x = 1e-3 * crush_embed_size(one, Breakage.of_material(STRENGTH, QUARTZ, 1e-3))
    # g = 0.211 at the Poisson ratio of quartz
    assert x == pytest.approx(1e-3 * (0.211 * np.pi * 7.4e9 / 4 / 67e6) ** (-1 / 0.55), rel=0.12)
    swallowed = np.array([2.0])
    law = Breakage.of_material(STRENGTH, QUARTZ, x)
    share = law.survival(np.ones(1), tension(one, QUARTZ.nu, "sphere")(swallowed))
    assert share[0] == pytest.approx(1 / math.e, rel=1e-9)


# ---------------------------------------------------------------- tables, slopes, spots
SIZES = {
    "uniform": UNIFORM,
    "gaussian": tb.TruncatedGaussian(mean=6e-6, std=1e-6),
    "narrow": tb.TruncatedGaussian(mean=6e-6, std=6e-9),
    "lognormal": tb.LogNormal(median=3e-6, gsd=1.6),
    "one": tb.distributions.Monodisperse(mean=6e-6),
    "histogram": tb.distributions.Histogram(edges=(2e-6, 4e-6, 5e-6, 9e-6), counts=(5, 1, 2)),
}


@pytest.mark.spread(5)
@pytest.mark.parametrize("fragments", FRAGMENTS)
@pytest.mark.parametrize("name", SIZES)
def test_tables_are_the_sums(name, fragments):
    average, _ = average_of(STRENGTH.replace(fragments=fragments), SIZES[name])
    gaps = np.random.default_rng(1).uniform(average.bottom, average.top, 150)
    exact = average.average(gaps, average.top - gaps)
    largest = exact[:, [0, *[5] * 5, 6]]  # the load, the larger area, the projected one
    before = np.maximum.accumulate(largest[np.argsort(-gaps)])[np.argsort(np.argsort(-gaps))]
    assert np.max(np.abs(average(gaps) - exact) / before) < 1e-7


@pytest.mark.spread(5)
@pytest.mark.parametrize("seat", ["rough", "plane"])
@pytest.mark.parametrize("name", ["uniform", "gaussian", "lognormal"])
def test_slope_is_the_derivative(name, seat):
    bound = interface(contact_of(STRENGTH, seat=seat, sizes=SIZES[name]))
    d, step = np.linspace(1.1e-6, 7.1e-6, 23), 2e-11
    slope = bound.load(d)[:, 1]
    ahead, behind = bound.load(d + step)[:, 0], bound.load(d - step)[:, 0]
    scale = np.abs(slope).max()
    np.testing.assert_allclose((ahead - behind) / (2 * step), slope, atol=2e-6 * scale)


@pytest.mark.parametrize("fragments", FRAGMENTS)
@pytest.mark.parametrize("seat", ["rough", "plane"])
def test_spots_add_up_to_the_sums(seat, fragments):
    bound = interface(contact_of(STRENGTH.replace(fragments=fragments), seat=seat))
    d = np.linspace(0.5e-6, 7e-6, 9)
    fields, spots = bound.particles.fields(d), bound.particles.spots(d)
    load = sum(each.total(each.load) for each in spots)
    area = sum(each.total(each.areas[1]) for each in spots)
    np.testing.assert_allclose(load, fields["F_sa"], rtol=1e-5)
    np.testing.assert_allclose(area, fields["A_sa2"], rtol=1e-5)


# ---------------------------------------------------------------- grains that break one by one
def closing(rng, sizes, gaps, strength, at):
    """Loads [N] of explicit grains in some of falling gaps: (at, grains), pieces with their grain."""
    draw = lambda x: strength.of_size(x) * rng.exponential(size=len(x)) ** (1 / strength.m)  # noqa: E731
    count = round(strength.bearing_share / strength.ratio**3)
    # size, stress at which it breaks and grain of each: pieces that may break, and that never do
    weak, strong = np.zeros((3, 0)), []
    new = np.array([sizes, draw(sizes), np.arange(len(sizes))])
    loads = []
    for i, gap in enumerate(gaps):
        while True:
            ends = new[0] <= strength.x_c
            weak = np.hstack([weak, new[:, ~ends]])
            strong.append(new[:, ends])
            squeezed = np.flatnonzero(weak[0] > gap)
            x, limit, _ = weak[:, squeezed]
            found = ONE.at(1 - gap / x)
            s = [np.minimum(2 * np.sqrt(area / np.pi), 1.0) for area in found.areas]
            stress = (
                found.load
                * 0.5
                * (confined_tension(s[0], QUARTZ.nu) + confined_tension(s[1], QUARTZ.nu))
            )
            broken = squeezed[stress > limit]
            if not len(broken):
                new = np.zeros((3, 0))
                break
            piece, grain = (np.repeat(weak[j, broken], count) for j in (0, 2))
            new = np.array([strength.ratio * piece, draw(strength.ratio * piece), grain])
            weak = np.delete(weak, broken, axis=1)
        if i in at:
            x, _, grain = np.hstack([weak, *strong])
            squeezed = x > gap
            bears = x[squeezed] ** 2 * ONE.at(1 - gap / x[squeezed]).load
            loads.append(np.bincount(grain[squeezed].astype(int), bears, len(sizes)))
    return np.array(loads)


@pytest.mark.parametrize(
    "fragments",
    [pytest.param(each, marks=() if each == "gone" else pytest.mark.slow) for each in FRAGMENTS],
)
def test_explicit_grains_break_one_by_one(fragments):
    rng = np.random.default_rng(7)
    sizes = tb.TruncatedGaussian(mean=14e-6, std=5e-6, n=2)
    strength = STRENGTH.replace(fragments=fragments, x_c=2e-6)
    gaps = np.geomspace(24e-6, 0.2e-6, 500)
    grains = sizes.sample(rng, {"gone": 5000, "footprint": 1200, "all": 600}[fragments])
    at = np.array([160, 260, 330, 400, 460, 499])
    loads = closing(rng, grains, gaps, strength, at)
    average, scale = average_of(strength, sizes)
    expected = scale**2 * average.average(gaps[at] / scale, average.top - gaps[at] / scale)[:, 0]
    error = loads.std(axis=1) / math.sqrt(loads.shape[1])
    assert np.all(np.abs(loads.mean(axis=1) - expected) < 4 * error)
    assert np.all(error < 0.15 * expected)


# ---------------------------------------------------------------- where nothing is
ABOVE = {
    "monodisperse": tb.distributions.Monodisperse(mean=6e-6),
    "gaussian": tb.TruncatedGaussian(mean=6e-6, std=6e-7),
    "log-normal": tb.LogNormal(median=6e-6, gsd=1.2),
    "power law": tb.distributions.PowerLaw(edges=(2e-6, 9e-6), counts=(1,), slopes=(3.0,)),
    "histogram": tb.distributions.Histogram(edges=(2e-6, 5e-6, 9e-6), counts=(3, 1)),
    "down to nothing": tb.distributions.Uniform(low=0.0, high=8e-6),
}


def complete(material):
    return material.replace(
        thermal_conductivity=40.0, resistivity=2e-7, density=7800.0, specific_heat=480.0
    )


def outputs_of_all():
    needed = {
        "friction": {"tau_ss": 0.2e9, "tau_sa": 0.2e9},
        "flash_temperature": {"speed": 1.0},
        "wear": {"k": 1e-4},
    }
    for name, kind in tb.outputs.REGISTRY.items():
        try:
            yield kind(**needed.get(name, {}))
        except TypeError:
            try:
                yield kind()
            except (TypeError, tb.errors.InvalidValue):
                continue
        except tb.errors.InvalidValue:
            continue


@pytest.mark.check
@pytest.mark.spread(5)
@pytest.mark.parametrize(
    ("fragments", "seat", "sizes"),
    [
        pytest.param(fragments, seat, sizes, id=f"{fragments}-{seat}-{name}")
        for i, fragments in enumerate(FRAGMENTS)
        for j, seat in enumerate(["rough", "plane"])
        for k, (name, sizes) in enumerate(ABOVE.items())
        if (i + j + k) % 2 == 0  # any two in all their ways
    ],
)
def test_no_particle_is_loaded_in_a_gap_above_the_largest(sizes, seat, fragments):
    """Every output has an answer, alone and beside a gap in which there are some."""
    steel, quartz = complete(STEEL), complete(QUARTZ)
    outputs = tuple(outputs_of_all())
    assert {"counts", "dents", "crushing"} <= {each.name for each in outputs}
    contact = contact_of(
        STRENGTH.replace(fragments=fragments),
        seat=seat,
        sizes=sizes,
        material=quartz,
        pair=tb.MaterialPair(steel, steel),
        outputs=outputs,
    )
    state = tb.solve(contact, d=60e-6)
    assert state.pressure == state.A_t == 0
    assert state.outputs["n_sa"] == 0
    both = tb.solve(contact, d=[60e-6, 3e-6])
    assert both.outputs["n_sa"][0] == 0 < both.outputs["n_sa"][1]


# ---------------------------------------------------------------- what has no end
@pytest.mark.parametrize("seat", ["rough", "plane"])
@pytest.mark.parametrize(
    "sizes",
    [tb.distributions.Monodisperse(mean=1e-5), tb.distributions.Uniform(low=0.0, high=1e-5)],
)
@pytest.mark.parametrize("fragments", ["footprint", "all"])
@pytest.mark.parametrize(
    "changes",
    [
        {"size_exponent": 0.0},
        {"size_exponent": 0.05},
        {"ratio": 0.999999},
        {"ratio": 1e-39, "size_exponent": 0.0},
        {"size_exponent": 0.0, "x_c": 1e-300},
    ],
    ids=str,
)
def test_pieces_that_break_for_ever_are_refused(seat, sizes, fragments, changes):
    strength = STRENGTH.replace(**{"x_c": 0.0, "fragments": fragments, **changes})
    with pytest.raises(tb.errors.InvalidValue, match="generations"):
        tb.solve(contact_of(strength, seat=seat, sizes=sizes), pressure=1e5)


def test_pieces_that_end_are_followed_to_the_end():
    """A smaller share of what is left changes nothing: the bound is far beyond what bears."""
    strength = STRENGTH.replace(x_c=0.0, size_exponent=0.3)
    average, scale = average_of(strength, tb.distributions.Monodisperse(mean=1e-5))
    assert average.least * scale < 1e-10
    shallow, _ = average_of(strength.replace(x_c=1e-10), tb.distributions.Monodisperse(mean=1e-5))
    gap = np.array([1e-4])
    np.testing.assert_allclose(
        average.average(gap, 1 - gap)[0, 0], shallow.average(gap, 1 - gap)[0, 0], rtol=1e-9
    )


def test_pieces_that_bear_nothing_need_no_ratio():
    """Where fragments are gone, their size decides nothing."""
    gone = STRENGTH.replace(fragments="gone")
    gaps = np.array([5e-6, 3e-6, 1e-6])
    one, other = (
        pressure_of(contact_of(gone.replace(ratio=ratio)), gaps) for ratio in (0.5, 0.999999)
    )
    np.testing.assert_array_equal(one, other)


# ---------------------------------------------------------------- samples
@pytest.mark.spread(5)
@pytest.mark.parametrize("fragments", FRAGMENTS)
@pytest.mark.parametrize("sigma", [5e-8, 5e-7, 5e-6])
@pytest.mark.parametrize(
    "sizes", [UNIFORM, tb.LogNormal(median=6e-6, gsd=1.4), ABOVE["power law"]], ids=repr
)
def test_rough_sums_of_samples_are_near(sizes, sigma, fragments):
    """To 1e-3 of the load, as they promise, and the same contact is exact again afterwards."""
    contact = contact_of(
        STRENGTH.replace(fragments=fragments),
        sizes=sizes,
        roughness=tb.Roughness(sigma=sigma, R=1e-4),
    )
    F_star = np.geomspace(1e-8, 1e-4, 7)
    exact = tb.solve(contact, F_star=F_star)
    with roughly():
        near = tb.solve(contact, F_star=F_star)
    assert list(near.status) == list(exact.status)
    np.testing.assert_allclose(near.particle_load_share, exact.particle_load_share, atol=1e-3)
    np.testing.assert_allclose(near.A_t, exact.A_t, rtol=1e-3)
    np.testing.assert_array_equal(tb.solve(contact, F_star=F_star).d, exact.d)
