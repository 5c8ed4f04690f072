"""The library's sums against the oracle's quadratures, at given separations."""

import numpy as np
import oracle
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from twins import Twin, agree, base, horng_twins, interfaces, series_twin, series_twins, sizes

import thirdbody as tb

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
SLOW = settings(max_examples=settings().max_examples * 2 // 3)


@given(interface=interfaces(), h=st.floats(-4, 12))
def test_two_body(interface, h):
    twin = Twin(base(interface), interface, None, h * interface.rough.sigma)
    agree(tb.solve(twin.contact, d=twin.d), twin.expected())


def test_two_body_over_the_whole_range():
    """One call with an array, σ by σ, from deep contact to loads of 1e-40."""
    interface = oracle.Interface()
    d = 1e-7 * np.arange(-4.0, 12.1, 0.5)
    states = tb.solve(base(interface), d=d).columns()
    for i, each in enumerate(d):
        for name, want in oracle.series_state(each, interface, None).items():
            total = states["F_star" if name.startswith("F") else "A_t"][i]
            assert states[name][i] == pytest.approx(want, rel=1e-10, abs=1e-13 * total), (
                name,
                each,
            )


@SLOW
@given(twin=series_twins(seats=("plane", "offset")))
def test_series_law_on_a_plane(twin):
    agree(tb.solve(twin.contact, d=twin.d), twin.expected())


@SLOW
@given(twin=series_twins(seats=("rough",)))
def test_series_law_on_a_rough_seat(twin):
    agree(tb.solve(twin.contact, d=twin.d), twin.expected())


@settings(max_examples=4 * settings().max_examples)
@given(twin=horng_twins())
def test_printed_model_with_all_switches(twin):
    agree(tb.solve(twin.contact, d=twin.d), twin.expected())


HARD, SOFT = oracle.Body(205e9, 0.29, 5e9), oracle.Body(100e9, 0.3, 1.2e9)
DUSTS = {
    "silica": oracle.SILICA,
    "soft": oracle.Body(20e9, 0.3, 3e8),
    "rubbery": oracle.Body(1e9, 0.45, 1.5e8),
    "diamond": oracle.Body(1.1e12, 0.07, 9e10),
}


@pytest.mark.spread(5)
@pytest.mark.parametrize("seat", ["plane", "offset", "rough"])
@pytest.mark.parametrize("dust", DUSTS)
@pytest.mark.parametrize("second", [HARD, SOFT], ids=["like", "unlike"])
def test_materials(seat, dust, second):
    """Indenting particles and flattened ones, equal and unequal surfaces, in the same gap."""
    interface = oracle.Interface(HARD, second)
    twin = series_twin(
        interface,
        DUSTS[dust],
        sizes("gaussian", 3e-7, 0.2),
        1e11,
        2.3e-7,
        seat=seat,
        h_0=0.4e-7,
    )
    agree(tb.solve(twin.contact, d=twin.d), twin.expected())


@pytest.mark.spread(3)
@pytest.mark.parametrize("shadow", ["footprint", "projected", "covered", "none"])
@pytest.mark.parametrize("seat", ["plane", "rough"])
@pytest.mark.parametrize("kind", ["gaussian", "lognormal", "weibull", "uniform", "monodisperse"])
def test_size_laws_and_shadows(kind, seat, shadow):
    twin = series_twin(
        oracle.Interface(),
        oracle.SILICA,
        sizes(kind, 3e-7, 0.25),
        2e11,
        2.5e-7,
        seat=seat,
        shadow=shadow,
    )
    agree(tb.solve(twin.contact, d=twin.d), twin.expected())


@pytest.mark.parametrize("seat", ["plane", "rough"])
@pytest.mark.parametrize(
    ("kind", "width"),
    [("gaussian", 1e-3), ("lognormal", 1e-3), ("lognormal", 0.8), ("weibull", 0.04)],
)
def test_very_narrow_and_very_wide_sizes(kind, width, seat):
    diameter, twin_sizes = sizes(kind, 3e-7, width)
    squeeze = 3e-3 if width < 1e-2 else 0.15
    d = 3e-7 * (1 - squeeze) - (oracle.Interface().rough.y_s if seat == "rough" else 0)
    density = 0.05 / (0.785 * diameter.moment(2))
    twin = series_twin(
        oracle.Interface(), oracle.SILICA, (diameter, twin_sizes), density, d, seat=seat
    )
    agree(tb.solve(twin.contact, d=twin.d), twin.expected())


@pytest.mark.parametrize("t", [1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 0.038, 0.1, 0.3, 0.6, 1.2])
@pytest.mark.parametrize("rule", ["hermite", "log"])
def test_one_size_on_a_plane_is_one_particle(t, rule):
    """The sum over a single size has no integral: it is `Series.single` times the density."""
    interface, x = oracle.Interface(SOFT, SOFT), 3e-7
    twin = series_twin(
        interface, SOFT, sizes("monodisperse", x, 0), 1e11, x * (1 - t), rule=rule, shadow="none"
    )
    state = tb.solve(twin.contact, d=twin.d)
    single = twin.contact.particle_law.single(
        x, twin.d, surfaces=twin.contact.surfaces, particle=twin.contact.particles.material
    )
    assert state.F_sa_star * interface.E_ss == pytest.approx(
        1e11 * float(single["force"]), rel=1e-10
    )
    assert state.A_sa == pytest.approx(1e11 * float(single["area_1"]), rel=1e-10)


def test_mixture_is_the_sum_of_its_parts():
    """Loads and areas of two kinds of sizes add; so do their footprints."""
    parts = (
        tb.TruncatedGaussian(mean=2e-7, std=2e-8),
        tb.LogNormal(median=4e-7, gsd=1.2),
        tb.distributions.Monodisperse(mean=3.3e-7),
    )
    weights = (5.0, 1.0, 2.0)
    for seat in ("plane", "rough"):
        twin = series_twin(
            oracle.Interface(), oracle.SILICA, sizes("gaussian", 3e-7, 0.2), 8e10, 2e-7, seat=seat
        )

        def load(diameter, density, contact=twin.contact):
            changed = contact.replace(
                **{"particles.diameter": diameter, "particles.areal_density": density}
            )
            state = tb.solve(changed, d=1.8e-7)
            return np.array([state.F_sa_star, state.A_sa, state.A_sa2, state.shadow])

        both = load(tb.distributions.Mixture(parts=parts, weights=weights), 8e10)
        alone = sum(load(part, 1e10 * w) for part, w in zip(parts, weights, strict=True))
        np.testing.assert_allclose(both, alone, rtol=1e-10)


def test_histogram_of_many_bins_approaches_the_law():
    law = tb.TruncatedGaussian(mean=3e-7, std=4e-8)
    edges = np.linspace(*law.support, 49)
    bins = tb.distributions.Histogram(
        edges=tuple(edges), counts=tuple(law.partial_moment(0, edges[:-1], edges[1:]))
    )
    twin = series_twin(oracle.Interface(), oracle.SILICA, sizes("gaussian", 3e-7, 0.2), 1e11, 2e-7)
    for seat in ("plane", "rough"):
        contact = twin.contact.replace(**{"particle_law.seat": seat, "particles.diameter": law})
        smooth = tb.solve(contact, d=2.2e-7)
        stepped = tb.solve(contact.replace(**{"particles.diameter": bins}), d=2.2e-7)
        assert stepped.F_sa_star == pytest.approx(smooth.F_sa_star, rel=2e-3)
        assert stepped.A_sa == pytest.approx(smooth.A_sa, rel=2e-3)


@settings(max_examples=settings().max_examples // 3)
@given(twin=series_twins())
def test_arrays_equal_scalars(twin):
    d = twin.d + twin.interface.rough.sigma * np.array([0.3, 0.0, -0.1, 1.5])
    together = tb.solve(twin.contact, d=d)
    for i, each in enumerate(d):
        alone = tb.solve(twin.contact, d=float(each))
        for name in ("F_star", "F_sa_star", "A_t", "A_sa", "A_sa2", "A_e", "A_ep", "A_p", "shadow"):
            assert getattr(together, name)[i] == pytest.approx(
                getattr(alone, name), rel=1e-13, abs=1e-300
            )
        assert together.mode[i] == alone.mode
