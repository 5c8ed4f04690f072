"""How many nodes and panels sums over sizes, gaps and squeezes take, and that these suffice."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import thirdbody as tb
from thirdbody.contact.particle_averages import SizeAverage
from thirdbody.equilibrium.states import state_columns
from thirdbody.laws.particle.one_particle import squeezed_particle
from thirdbody.numerics.chebyshev import PiecewiseChebyshev
from thirdbody.numerics.quadrature import gauss_legendre

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
SIGMA, MEAN = 100e-9, 500e-9


def case(diameter, seat="rough", particle=SILICA, surfaces=(STEEL, STEEL), density=1e11):
    return tb.Contact(
        surfaces=tb.MaterialPair(*surfaces),
        roughness=tb.Roughness(sigma=SIGMA, R=2.8e-6),
        particles=tb.Particles(material=particle, areal_density=density, diameter=diameter),
        particle_law=tb.particle.Series(
            deep="off", soft="sphere", seat=seat, **({"h_0": SIGMA} if seat == "offset" else {})
        ),
    )


def alike(states, contact, vary, which, rtol=1e-10, **load):
    """States solved together against each contact alone."""
    for i in which:
        alone = tb.solve(contact.replace(**{k: v[i] for k, v in vary.items()}), **load).columns()
        assert states["status"][i] == "ok"
        for name, values in alone.items():
            if values.dtype.kind == "f" and name != "residual":
                assert_allclose(states[name][i], values[0], rtol=rtol, atol=1e-13, err_msg=name)


# ------------------------------------------------------------------------ squeezed flat
SOFT = tb.Material(E=15e9, nu=0.3, H=30e6)


@pytest.mark.parametrize("widths", [19.0, 40.0])
@pytest.mark.parametrize("gsd", [1.0033, 1.1])
def test_particles_squeezed_flat_carry_by_all_their_sizes(widths, gsd):
    """Under particles far larger than the seat is rough the gap is below all that changes."""
    pytest.importorskip("numba")
    size = widths * SIGMA
    dust = SILICA.replace(H=0.3e9)
    sizes = tb.LogNormal(median=size, gsd=gsd)
    contact = case(sizes, particle=dust, surfaces=(STEEL, SOFT), density=0.01 / size**2)
    vary = {"surfaces.first.H": np.linspace(4e9, 6e9, 32)}
    states = state_columns(contact, pressure=5e6, vary=vary)
    alike(states, contact, vary, (0, 13, 31), pressure=5e6)


def test_particles_squeezed_flat_with_spreads_of_their_own():
    pytest.importorskip("numba")
    size = 40 * SIGMA
    sizes = tb.TruncatedGaussian(mean=size, std=0.1 * size)
    dust = SILICA.replace(H=0.3e9)
    contact = case(sizes, particle=dust, surfaces=(STEEL, SOFT), density=0.01 / size**2)
    vary = {"particles.diameter.std": size * np.linspace(0.01, 0.2, 32)}
    states = state_columns(contact, pressure=5e6, vary=vary)
    alike(states, contact, vary, (0, 13, 31), pressure=5e6)


def test_wide_spreads_of_their_own_by_regime():
    """The elastic area comes from the seats of few gaps, so the sum over sizes must tell them."""
    pytest.importorskip("numba")
    size = 15 * SIGMA
    sizes = tb.TruncatedGaussian(mean=size, std=0.4 * size)
    contact = case(sizes, density=0.01 / size**2)
    contact = contact.replace(**{"particle_law.zeta_std": 0.4})
    vary = {"particles.diameter.std": size * np.linspace(0.3, 0.45, 24)}
    states = state_columns(contact, F_star=1e-5, vary=vary)
    alike(states, contact, vary, (0, 12, 23), F_star=1e-5)


@pytest.mark.parametrize("load", [1e-6, 1e-4])
def test_loads_that_do_not_change_with_the_separation(load):
    """Far above the asperities, yet under the lowest gap that particles feel, nothing changes."""
    pytest.importorskip("numba")
    surfaces = (STEEL, STEEL.replace(H=3e9))
    contact = case(
        tb.distributions.Uniform(low=3e-6, high=5e-6), "plane", surfaces=surfaces, density=2e6
    )
    contact = contact.replace(roughness=tb.Roughness(sigma=30e-9, R=1e-6))
    vary = {"particles.areal_density": np.linspace(1e6, 2e6, 24)}
    states = state_columns(contact, F_star=load, vary=vary)
    assert np.all(np.isfinite(states["d"]))
    alike(states, contact, vary, (0, 23), F_star=load)


# ------------------------------------------------------------------------- close sizes
def close_sizes(kind: str, spread: float) -> tb.distributions.Distribution:
    if kind == "gaussian":
        return tb.TruncatedGaussian(mean=MEAN, std=spread * MEAN)
    if kind == "lognormal":
        return tb.LogNormal(median=MEAN, gsd=1 + spread)
    return tb.distributions.Uniform(low=MEAN * (1 - spread), high=MEAN * (1 + spread))


@pytest.mark.parametrize("seat", ["plane", "offset", "rough"])
@pytest.mark.parametrize("spread", [2e-16, 1e-14, 1e-12, 1e-10, 1e-9])
@pytest.mark.parametrize("kind", ["gaussian", "lognormal", "uniform"])
def test_sizes_too_close_to_tell_are_as_one(kind, spread, seat):
    loads = [1e-6, 1e-5, 1e-4]
    got = tb.solve(case(close_sizes(kind, spread), seat), F_star=loads).columns()
    want = tb.solve(case(tb.distributions.Monodisperse(mean=MEAN), seat), F_star=loads).columns()
    for name in ("F_ss_star", "F_sa_star", "A_t", "A_sa", "A_sa2", "shadow", "d"):
        assert_allclose(got[name], want[name], rtol=1e-12, err_msg=name)


@pytest.mark.parametrize("spread", [1e-9, 1e-7, 1e-5, 1e-3])
@pytest.mark.parametrize("kind", ["gaussian", "lognormal", "uniform"])
def test_close_sizes_by_their_definition(kind, spread):
    """The load of one particle, summed over sizes that all are squeezed alike."""
    contact = case(close_sizes(kind, spread), "plane")
    law, surfaces = contact.particle_law, contact.surfaces
    u, weight = gauss_legendre(80)
    place = 8.5 * u if kind == "lognormal" else u if kind == "uniform" else 3 * u
    x = MEAN * (1 + spread) ** place if kind == "lognormal" else MEAN * (1 + spread * place)
    if kind != "uniform":
        weight = weight * np.exp(-0.5 * place**2)
    weight = weight / weight.sum()
    for d in (0.93 * MEAN, 0.8 * MEAN):
        one = law.single(x, d, surfaces=surfaces, particle=SILICA)
        state = tb.solve(contact, d=d)
        want = 1e11 * np.sum(weight * one["force"]) / contact.E_ss
        assert_allclose(state.F_sa_star, want, rtol=1e-12)
        assert_allclose(state.A_sa2, 1e11 * np.sum(weight * one["area_2"]), rtol=1e-12)


@pytest.mark.check
@pytest.mark.spread(4)
@pytest.mark.parametrize("kind", ["gaussian", "lognormal", "uniform"])
@pytest.mark.parametrize("spread", [1e-9, 1e-6, 1e-3])
def test_states_of_close_sizes(kind, spread):
    """By nodes that states share, with materials of their own."""
    pytest.importorskip("numba")
    contact = case(close_sizes(kind, spread))
    vary = {"surfaces.first.H": np.linspace(4e9, 6e9, 24)}
    states = state_columns(contact, F_star=1e-5, vary=vary)
    alike(states, contact, vary, (0, 23), rtol=1e-11, F_star=1e-5)


@pytest.mark.parametrize(
    "sizes",
    [
        tb.TruncatedGaussian(mean=3.0, std=0.2, n=2.5),
        tb.LogNormal(median=3.0, gsd=1.04),
        tb.distributions.Uniform(low=2.0, high=3.0),
        tb.distributions.Weibull(scale=3.0, shape=20.0),
    ],
)
def test_density_below_the_largest_size(sizes):
    low, high = sizes.support
    x = np.linspace(max(low, 0.6 * high), high, 41)[1:-1]
    assert_allclose(sizes.pdf_below(high - x), sizes.pdf(x), rtol=1e-11)


# ----------------------------------------------------------------------- how many panels
BODIES = {
    "two bins": (
        *("ZMC", (5.24e9, 3.73e6, 0.341), (7.12e9, 4.93e5, 0.29)),
        tb.distributions.Histogram(edges=(1 / 3, 0.5333333, 2 / 3, 1.0), counts=(1, 3, 2)),
    ),
    "yielding together": (
        *("Hermite", (2.43e10, 3.1e7, 0.203), (2.43e10, 3e7, 0.0716)),
        tb.TruncatedGaussian(mean=1.0, std=0.217, n=2.27),
    ),
    "elastic for moments": (
        *("Hermite", (4.32e9, 2.74e6, 0.206), (7.93e9, 2.74e6, 0.206)),
        tb.TruncatedGaussian(mean=1.0, std=0.01, n=1.65),
    ),
    "very soft": (
        *("ZMC", (1.34e9, 1.87e5, 0.0583), (1.34e10, 1.87e5, 0.0583)),
        tb.distributions.PowerLaw(edges=(0.1, 1 / 3, 1.0), counts=(3, 1), slopes=(3.4, 2.5)),
    ),
    "very hard": (
        *("Hermite", (3.62e9, 2.92e9, 0.126), (3.62e9, 2.92e9, 0.126)),
        tb.TruncatedGaussian(mean=1.0, std=0.00132, n=4.29),
    ),
    "one size but for rounding": (
        *("Hermite", (1e11, 5e9, 0.3), (1e11, 4e9, 0.3)),
        tb.LogNormal(median=1.0, gsd=1 + 1e-9),
    ),
}


@pytest.mark.parametrize("name", BODIES)
def test_rounding_asks_for_no_panels(name):
    """A table of a plane seat takes some panels for every kink, whatever the materials."""
    law, first, second, sizes = BODIES[name]
    particle = squeezed_particle(getattr(tb.asperity, law)(), first, second)
    average = SizeAverage(particle, sizes)
    tables = [average.upper] + ([] if average.lower is None else [average.lower])
    panels = sum(len(table.half) for table in tables)
    kinks = len(average.rises) + len(average.gaps_below)
    assert panels <= 10 * kinks, (panels, kinks)
    # and they say what the sums say
    gaps = np.linspace(average.bottom, average.top, 301)[1:-1]
    want = average.average(gaps, average.top - gaps)
    assert_allclose(average(gaps)[:, 0], want[:, 0], rtol=3e-12)


def test_noise_is_known_from_structure():
    """Panels halve where a function bends and not where it trembles."""
    rng = np.random.default_rng(0)

    def trembling(x):
        return (np.exp(x) * (1 + 1e-11 * rng.standard_normal(len(x))))[:, None]

    assert len(PiecewiseChebyshev(trembling, np.array([0.0, 1.0])).half) <= 4

    def bent(x):
        return np.abs(x - 1 / math.pi)[:, None] ** 1.5

    assert len(PiecewiseChebyshev(bent, np.array([0.0, 1.0]), max_depth=10).half) > 10
