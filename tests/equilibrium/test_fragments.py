"""Particles that break, summed gap by gap by the compiled engine."""

from functools import cache

import numpy as np
import pytest
from scipy import integrate

import thirdbody as tb
from thirdbody.contact.interface import interface

pytest.importorskip("numba")

from thirdbody.equilibrium.engine.run import own_columns
from thirdbody.equilibrium.states import state_columns

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
STEEL = tb.Material(E=208e9, nu=0.3, H=6e9)
GLASS = tb.Material(E=72e9, nu=0.2, H=7.7e9)
STRENGTH = tb.grains.WeibullStrength(sigma_0=67e6, x_0=1e-3, m=3.0, size_exponent=0.55, x_c=50e-9)
SIZES = {
    "narrow": tb.TruncatedGaussian(mean=300e-9, std=30e-9, n=3.0),
    "log-normal": tb.LogNormal(median=250e-9, gsd=1.3),
    "powers": tb.distributions.PowerLaw(edges=(2e-7, 9e-7), counts=(1.0,), slopes=(3.2,)),
    "uniform": tb.distributions.Uniform(low=1e-7, high=5e-7),
}
KINDS = {
    "plain": {},
    "gone": {"fragments": "gone"},
    "finer": {"fragments": "all", "ratio": 0.6},
    "brittle": {"m": 8.0, "sigma_0": 40e6},
    "not confined": {"confinement": "none"},
}


def broken_contact(sizes="narrow", kind="plain", seat="plane", second=STEEL, **more):
    return tb.Contact(
        surfaces=tb.MaterialPair(STEEL, second),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6, alpha=5.0),
        particles=tb.Particles(
            material=GLASS,
            areal_density=3e10,
            diameter=SIZES[sizes],
            strength=STRENGTH.replace(**KINDS[kind]),
        ),
        particle_law=tb.particle.Series(seat=seat),
    ).replace(**more)


def load_of_one(part, size, gap):
    """Load of a particle of this size and of its fragments: each breaks by itself, or bears."""
    average, law = part.average, part.average.breakage
    if size <= gap or size < average.least:
        return 0.0
    eps = np.array([1 - gap / size])
    whole = float(law.survival(np.array([size]), average.tension(eps))[0])
    own = whole * size**2 * float(average.particle(eps)[0, 0])
    if law.kept == 0 or whole == 1:
        return own
    pieces = (1 - whole) * law.kept * law.ratio**-3
    return own + pieces * load_of_one(part, law.ratio * size, gap)


@pytest.mark.check
@pytest.mark.parametrize("sizes", SIZES)
@pytest.mark.parametrize("kind", KINDS)
def test_a_plane_carries_what_single_particles_and_their_fragments_do(sizes, kind):
    contact = broken_contact(sizes, kind)
    part, d = interface(contact).particles.parts[0], 140e-9
    gap, law = (d + part.offset) / part.scale, part.average.breakage
    low, high = part.average.sizes.support
    marks = {x * law.ratio**-k for x in (gap, law.x_c, part.average.least) for k in range(40)}
    inner = sorted(x for x in marks if low < x < high)
    want = 0.0
    for a, b in zip([max(low, gap), *inner], [*inner, high], strict=True):
        if b > max(a, gap):

            def integrand(x):
                return float(part.average.sizes.pdf(np.array([x]))[0]) * load_of_one(part, x, gap)

            want += integrate.quad(integrand, max(a, gap), b, epsrel=1e-9, limit=200)[0]
    got = own_columns(contact, {}, "d", np.array([d]))
    assert got["doubt"][0] == ""
    pressure = float(got["F_sa_star"][0]) * contact.E_ss
    assert pressure == pytest.approx(part.factor * want, rel=2e-8)


@cache
def solved_alone(kind, seat):
    contact, sigma = broken_contact(kind=kind, seat=seat), 100e-9 * np.linspace(0.8, 1.2, 3)
    return sigma, own_columns(contact, {"roughness.sigma": sigma}, "F_star", np.full(3, 1e-5))


@pytest.mark.parametrize("kind", KINDS)
def test_on_a_plane_the_root_is_that_of_the_slow_path(kind, monkeypatch):
    sigma, got = solved_alone(kind, "plane")
    monkeypatch.setenv("THIRDBODY_ENGINE", "numpy")
    want = state_columns(
        broken_contact(kind=kind), F_star=np.full(1, 1e-5), vary={"roughness.sigma": sigma[1:2]}
    )
    assert got["doubt"][1] == ""
    assert got["error"][1] <= 1e-10
    for name in ("d_star", "F_sa_star", "A_t"):
        assert got[name][1] == pytest.approx(float(want[name][0]), rel=1e-9), name


@pytest.mark.parametrize("kind", ["plain", "finer"])
def test_company_changes_no_bit(kind):
    sigma, together = solved_alone(kind, "plane")
    alone = own_columns(
        broken_contact(kind=kind), {"roughness.sigma": sigma[1:2]}, "F_star", np.full(1, 1e-5)
    )
    for name in ("d", "F_sa_star", "A_t"):
        assert together[name][1] == alone[name][0], name


BROAD = {
    "powers": tb.distributions.PowerLaw(edges=(4e-6, 70e-6), counts=(1.0,), slopes=(3.0,)),
    "log-normal": tb.LogNormal(median=3e-6, gsd=1.4),
}


@pytest.mark.parametrize("sizes", BROAD)
def test_under_gaps_wide_against_the_seat_a_rough_seat_is_a_plane_with_a_correction(sizes):
    """Where the load of a gap is smooth over a seat, F(d) is L + w²L″/2."""
    particles = broken_contact().particles.replace(
        diameter=BROAD[sizes], areal_density=1e8, strength=STRENGTH.replace(x_c=1e-6)
    )
    rough = broken_contact(seat="rough", particles=particles)
    plane = rough.replace(**{"particle_law.seat": "plane"})
    part = interface(rough).particles.parts[0]
    width = part.average.width * part.scale
    far = 1.3e-6 - part.offset  # no size begins to be squeezed near this gap
    shift = np.array([-2.0, -1.0, 0.0, 1.0, 2.0]) * 0.5 * width
    offset = interface(plane).particles.parts[0].offset
    plain = own_columns(plane, {}, "d", far + part.offset - offset + shift)["F_sa_star"]
    second = np.dot([-1, 16, -30, 16, -1], plain) / (12 * (0.5 * width) ** 2)
    got = own_columns(rough, {}, "d", np.array([far]))
    assert got["doubt"][0] == ""
    correction = 0.5 * width**2 * second
    assert abs(correction) > 1e-4 * plain[2]
    assert got["F_sa_star"][0] - plain[2] == pytest.approx(correction, rel=0.1)


@pytest.mark.check
@pytest.mark.parametrize(
    ("sizes", "second"), [("powers", STEEL), ("log-normal", STEEL.replace(H=4e9))]
)
def test_broad_sizes_on_a_rough_seat_hold_to_the_slow_path(sizes, second):
    particles = broken_contact().particles.replace(
        diameter=BROAD[sizes], areal_density=1e8, strength=STRENGTH.replace(x_c=1e-6)
    )
    contact = broken_contact(seat="rough", particles=particles, second=second)
    got = own_columns(contact, {}, "F_star", np.array([1e-7, 1e-5]))
    assert got["doubt"].tolist() == ["", ""]
    want = tb.solve(contact, d=got["d"])
    # the slow path is off by up to 1e-8 where a seat is narrow
    np.testing.assert_allclose(want.F_star, [1e-7, 1e-5], rtol=2e-8)
    np.testing.assert_allclose(got["A_t"], want.A_t, rtol=2e-8)


def test_the_split_of_areas_adds_up_between_equal_surfaces():
    contact = broken_contact("powers")
    got = own_columns(contact, {}, "d", np.linspace(20e-9, 500e-9, 7))
    np.testing.assert_allclose(got["A_sa"], got["A_sa2"], rtol=1e-13)
    assert np.all(got["A_sa"] > 0)


# ---------------------------------------------------------------- how much lies in one layer
def crowded(fragments, density, **strength):
    weak = STRENGTH.replace(fragments=fragments, **strength)
    dust = broken_contact("log-normal").particles.replace(strength=weak, areal_density=density)
    return broken_contact(particles=dust, particle_law=tb.particle.Series(seat="rough"))


def test_fragments_that_are_gone_take_no_area():
    """Round as they came, particles and what is left of them never cover more than before."""
    before = crowded("gone", 1e12).particles.coverage
    layers = [
        interface(crowded("gone", 1e12, sigma_0=sigma)).particles.in_one_layer
        for sigma in (1e3, 67e6, 1e13)
    ]
    assert np.all(np.diff(layers) > 0)
    assert layers[0] < 0.5 * layers[-1]
    assert layers[-1] == pytest.approx(before, rel=1e-6)
    kept = interface(crowded("footprint", 1e12, sigma_0=1e3)).particles.in_one_layer
    assert kept == pytest.approx(before, rel=1e-6)


@pytest.mark.parametrize("fragments", ["gone", "footprint", "all"])
def test_both_engines_refuse_the_same_crowds(fragments):
    """Only fragments that all lie in one layer can cover more than the particles did."""
    contact = crowded(fragments, 4e12, sigma_0=1e3)
    outcomes = []
    for fewest in (1, 1000):
        try:
            state_columns(contact, pressure=[1e6, 5e6], fewest=fewest)
            outcomes.append("solved")
        except tb.InvalidValue:
            outcomes.append("refused")
    assert outcomes == ["refused" if fragments == "all" else "solved"] * 2
