"""Spots: every contact of a state, against the state's own sums and against explicit contacts."""

import tracemalloc

import numpy as np
import pytest
from refusals import Mistake, refuses
from scipy.stats import norm

import thirdbody as tb
from thirdbody.contact.evaluation import spots_of
from thirdbody.contact.interface import interface

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
SOFT = STEEL.replace(H=2.5e9)
LOADS = np.geomspace(1e-7, 1e-3, 9)
SIZES = {
    "narrow": tb.TruncatedGaussian(mean=300e-9, std=24e-9),
    "one": tb.distributions.Monodisperse(mean=300e-9),
    "broad": tb.LogNormal(median=150e-9, gsd=1.8),
    "two": tb.distributions.Mixture(
        parts=(
            tb.distributions.Monodisperse(mean=200e-9),
            tb.TruncatedGaussian(mean=400e-9, std=40e-9),
        ),
        weights=(0.7, 0.3),
    ),
}


def contact(sizes="narrow", *, seat="rough", law=None, heights=None, second=STEEL, **others):
    rough = tb.Roughness(sigma=100e-9, R=2.8e-6, heights=heights or tb.heights.GaussianHeights())
    dust = tb.Particles(material=SILICA, areal_density=2e10, diameter=SIZES[sizes])
    return tb.Contact(
        surfaces=tb.MaterialPair(STEEL, second),
        roughness=rough,
        asperity_law=law or tb.asperity.ZMC(),
        particles=dust,
        particle_law=tb.particle.Series(deep="off", seat=seat),
        **others,
    )


def spots(case, state):
    return spots_of(case, interface(case), np.atleast_1d(state.d), np.atleast_1d(state.shadow))


def close(found, expected, scale):
    assert np.max(np.abs(found - expected) / scale) < 1e-9


@pytest.mark.parametrize("sizes", SIZES)
@pytest.mark.parametrize("seat", ["rough", "plane"])
def test_spots_carry_the_load(sizes, seat):
    case = contact(sizes, seat=seat, second=SOFT)
    state = tb.solve(case, F_star=LOADS)
    asperities, particles = spots(case, state)
    E = case.E_ss
    close(sum(s.total(s.load) for s in asperities), state.F_ss_star * E, state.pressure)
    close(sum(s.total(s.load) for s in particles), state.F_sa_star * E, state.pressure)
    close(sum(s.total(s.area) for s in asperities), state.A_ss, state.A_t)
    close(sum(s.total(s.areas[0]) for s in particles), state.A_sa, state.A_t)
    close(sum(s.total(s.areas[1]) for s in particles), state.A_sa2, state.A_t)
    by_regime = sum(
        np.stack([s.total(area * (regime == i)) for i in range(3)])
        for group in (asperities, particles)
        for s in group
        for area, regime in [
            (s.area, s.regime) if hasattr(s, "area") else (s.areas[0], s.regimes[0])
        ]
    )
    close(by_regime, np.stack([state.A_e, state.A_ep, state.A_p]), state.A_t)


@pytest.mark.parametrize("sizes", SIZES)
@pytest.mark.parametrize("seat", ["rough", "plane"])
def test_loaded_particles_are_counted_without_laying_them_out(sizes, seat):
    case = contact(sizes, seat=seat)
    sums = interface(case).populations[0]
    d = np.linspace(-1e-7, 0.9 * sums.reach, 11)
    found = sums.spots(d)
    want = sum(each.total((each.load > 0).astype(float)) for each in found)
    np.testing.assert_allclose(sums.touching(d), want, rtol=1e-9, atol=1e-12 * want.max())


def test_particles_in_the_way_of_gaussian_sizes_and_seats_by_the_formula():
    """Size and seat are independent and Gaussian: their difference is, of a variance in sum."""
    case = contact().replace(
        **{"particles.diameter": tb.TruncatedGaussian(mean=300e-9, std=20e-9, n=8.0)}
    )
    sums, law = interface(case).populations[0], case.particle_law
    width = np.hypot(20e-9, law.zeta_std * 100e-9)
    d = np.linspace(0.0, 6e-7, 13)
    gap = d + law.seat_offset(case.roughness)
    want = 2e10 * norm.sf((gap - 300e-9) / width)
    np.testing.assert_allclose(sums.touching(d), want, rtol=1e-10)


@pytest.mark.parametrize(
    "heights",
    [
        tb.heights.ExponentialHeights(),
        tb.heights.WeibullHeights(shape=4.0),
        tb.heights.JohnsonHeights(skewness=-0.5, kurtosis=3.5),
    ],
    ids=lambda h: type(h).__name__,
)
def test_spots_of_other_heights(heights):
    case = contact(heights=heights)
    state = tb.solve(case, F_star=LOADS)
    asperities, _ = spots(case, state)
    total = sum(s.total(s.load) for s in asperities)
    assert np.max(np.abs(total - state.F_ss_star * case.E_ss) / state.pressure) < 1e-9


@pytest.mark.parametrize(
    "law", [tb.asperity.KE(), tb.asperity.JG(), tb.asperity.GW()], ids=lambda x: x.name
)
def test_spots_of_other_laws(law):
    case = contact(law=law)
    with pytest.warns(tb.errors.RangeWarning) if law.name == "gw" else _quiet():
        state = tb.solve(case, F_star=LOADS)
    asperities, _ = spots(case, state)
    close(sum(s.total(s.load) for s in asperities), state.F_ss_star * case.E_ss, state.pressure)


def _quiet():
    import contextlib

    return contextlib.nullcontext()


@pytest.mark.parametrize("sizes", ["narrow", "one"])
def test_more_nodes_change_nothing(sizes):
    case = contact(sizes, second=SOFT)
    d = np.atleast_1d(tb.solve(case, F_star=LOADS).d)
    (response,) = interface(case).populations
    q = [
        sum(s.total(np.sqrt(s.depths[0]) * s.load) for s in response.spots(d, splits))
        for splits in ((), np.geomspace(1e-3, 0.3, 7))
    ]
    assert np.max(np.abs(q[1] / q[0] - 1)) < 1e-8


def test_explicit_asperities():
    """How many are pressed how deep, by counting a million of them."""
    case = contact().replace(particles=None)
    state = tb.solve(case, F_star=np.array([1e-5, 1e-4]))
    ((group,), _) = spots(case, state)
    rough = case.roughness
    z = np.random.default_rng(5).standard_normal(2_000_000) * rough.sigma_s
    for i, d in enumerate(state.d):
        omega = z - d
        level = 0.4 * rough.sigma_s
        counted = np.mean(omega > level)
        error = np.sqrt(counted / len(z))
        assert abs(group.deeper(level)[i] / rough.density - counted) < 4 * error
        assert group.deepest(rough.density * counted)[i] == pytest.approx(level, abs=0.02e-7)
        assert group.deeper(group.deepest(1e6))[i] == pytest.approx(1e6, rel=1e-9)


def test_explicit_particles():
    """Loads of particles one by one: a million sizes and seats drawn at random."""
    case = contact(second=SOFT)
    state = tb.solve(case, F_star=1e-5)
    _, (group,) = spots(case, state)
    rng = np.random.default_rng(8)
    count = 400_000
    x = case.particles.diameter.sample(rng, count)
    seats = rng.standard_normal(count) * case.roughness.sigma
    one = case.particle_law.single(x, state.h - seats, surfaces=case.surfaces, particle=SILICA)
    levels = np.array([1e-5, 1e-4, 3e-4])
    found = group.above(group.load, levels)[0] / case.particles.areal_density
    counted = np.array([np.mean(one["force"] > level) for level in levels])
    # a node is all above a level or all below it
    assert np.all(np.abs(found - counted) < 4 * np.sqrt(counted / count) + 0.01)
    for i in range(2):
        depth = group.total(group.depths[i] * group.load)[0] / case.particles.areal_density
        product = one[f"delta_{i + 1}"] * one["force"]
        assert abs(depth - product.mean()) < 4 * product.std() / np.sqrt(count)


def test_outputs_travel_with_the_contact():
    case = contact(outputs=tb.outputs.Counts())
    state = tb.solve(case, F_star=LOADS)
    one = tb.solve(case, F_star=float(LOADS[3]))
    assert isinstance(one.outputs["n_ss"], float)
    assert one.outputs["n_ss"] == pytest.approx(state.outputs["n_ss"][3], rel=1e-12)
    assert list(state.columns())[-2:] == ["p_sa", "status_code"]
    again = tb.Contact.from_dict(case.to_dict())
    assert again.outputs == case.outputs
    assert case != case.replace(outputs=())
    assert state.outputs["p_ss"] * state.A_ss == pytest.approx(state.F_ss_star * case.E_ss)


def test_swept_outputs_are_those_of_each_contact():
    case = contact(outputs=tb.outputs.Counts())
    sizes = [0.0, 250e-9, 300e-9]
    swept = tb.sweep(case, F_star=LOADS[2:4], vary={"particles.diameter.mean": sizes})
    assert swept["n_sa"].attrs["units"] == "1/m^2"
    assert np.all(swept["n_sa"].sel({"particles.diameter.mean": 0}) == 0)
    for x in sizes[1:]:
        own = tb.solve(case.replace(**{"particles.diameter.mean": x}), F_star=LOADS[2:4])
        np.testing.assert_allclose(
            swept["n_sa"].sel({"particles.diameter.mean": x}), own.outputs["n_sa"], rtol=1e-9
        )


def test_slopes_of_outputs():
    case = contact(outputs=tb.outputs.Counts())
    found = tb.sensitivity(case, of=["n_sa"], to=["roughness.sigma", "pressure"], pressure=5e6)
    for name in ("roughness.sigma", "pressure"):
        ends = []
        for factor in (1 - 1e-4, 1 + 1e-4):
            sigma = 100e-9 * (factor if name != "pressure" else 1)
            p = 5e6 * (factor if name == "pressure" else 1)
            moved = case.replace(**{"roughness.sigma": sigma})
            ends.append(np.log(tb.solve(moved, pressure=p).outputs["n_sa"]))
        assert found.elasticity["n_sa"][name] == pytest.approx((ends[1] - ends[0]) / 2e-4, rel=1e-6)


def test_unsolved_states_have_no_outputs():
    case = contact(outputs=tb.outputs.Counts())
    state = tb.solve(case, F_star=np.array([1e-5, 1e3]))
    assert state.status[1] != "ok"
    assert np.isnan(state.outputs["n_ss"][1])
    assert state.outputs["n_ss"][0] > 0


@pytest.mark.parametrize(
    ("outputs", "refusal"),
    [
        ((3,), refuses(Mistake.KIND, "Contact.outputs")),
        ((tb.outputs.Counts(), tb.outputs.Counts()), refuses(Mistake.CLASH, "Contact.outputs")),
    ],
)
def test_mistakes(outputs, refusal):
    with refusal:
        contact(outputs=outputs)


def test_a_law_without_spots_says_so():
    """Where the contact is bound, once for all outputs, and not when it is solved."""
    case = contact(outputs=(tb.outputs.Counts(), tb.outputs.Dents()))
    with refuses(Mistake.BEYOND, "Contact.outputs", says="law horng2022") as told:
        case.replace(particle_law=tb.particle.Horng2022())
    assert len(told.value.problems) == 1
    bare = case.replace(particles=None, particle_law=tb.particle.Horng2022())
    assert tb.solve(bare, F_star=1e-5).outputs["n_sa"] == 0


def test_columns_are_unique_and_described():
    seen = {}
    for name, kind in tb.outputs.REGISTRY.items():
        for column, about in kind.columns.items():
            assert column not in seen, f"{column} of {name} and {seen[column]}"
            assert column not in tb.solve(contact(), F_star=1e-5).columns()
            assert all(about)
            seen[column] = name


# ------------------------------------------------- sizes over many widths of the seat
def dust_on_a_fine_surface(**change):
    """Grains of 1 to 100 µm, 33 000 widths of the seat they rest on."""
    steel = tb.materials["S45C"]
    return tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=10e-9, R=280e-9),
        particles=tb.Particles(
            material=tb.materials["SiO2"],
            diameter=tb.distributions.Uniform(low=1e-6, high=100e-6),
            areal_density=1e6,
        ),
        particle_law=tb.particle.Series(deep="off", zeta_mean=0.3, zeta_std=0.3),
    ).replace(**change)


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
def test_only_seats_within_reach_of_a_state_are_laid_out():
    contact = dust_on_a_fine_surface()
    (response,) = interface(contact).populations
    d = np.array([0.5e-6, 20e-6, 21e-6, 80e-6, 99.9e-6])
    (spots,) = response.spots(d)
    assert len(spots.number) < 400 * len(d)
    load = response.fields(d)["F_sa"]
    np.testing.assert_allclose(spots.total(spots.load), load, rtol=1e-9)
    np.testing.assert_allclose(response.direct_fields(d)["F_sa"], load, rtol=1e-9)


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
def test_states_far_apart_are_laid_out_in_groups():
    """Memory stays small, every state is itself, and no warning is told once for each group."""
    contact = dust_on_a_fine_surface(outputs=(tb.outputs.Counts(),))
    loads = np.geomspace(1e-9, 1e-3, 300)
    tracemalloc.start()
    try:
        together = tb.solve(contact, F_star=loads)
        most = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert most < 400e6
    assert np.ptp(together.d) > 90e-6
    assert len(together.warnings) == 4  # area, seat, strength, asperities one by one
    for i in (0, 150, 299):
        alone = tb.solve(contact, F_star=float(loads[i]))
        for name, value in alone.outputs.items():
            np.testing.assert_allclose(together.outputs[name][i], value, rtol=1e-12, err_msg=name)


@pytest.mark.spread(3)
@pytest.mark.parametrize("hardness", [8e9, 3e9, 1e9])
def test_outputs_of_particles_that_sink_in_are_known_to_eight_digits(hardness, monkeypatch):
    """The impression bends where its table does: more nodes change nothing."""
    from thirdbody.contact import particle_averages

    debris = tb.Material(E=2e11, nu=0.3, H=hardness, thermal_conductivity=50.0)
    metal = debris.replace(H=5e9)
    case = tb.Contact(
        surfaces=tb.MaterialPair(metal, metal.replace(H=6e9)),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(
            material=debris,
            areal_density=1e11,
            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
        ),
        outputs=(tb.outputs.Friction(tau_ss=4e8, tau_sa=2e8), tb.outputs.ThermalConductance()),
    )
    loads = np.geomspace(1e-7, 1e-3, 3)
    few = tb.solve(case, F_star=loads).outputs
    monkeypatch.setattr(particle_averages, "SIZE_NODES", 24)
    monkeypatch.setattr(particle_averages, "SPOT_NODES", (32, 28))
    monkeypatch.setattr(particle_averages, "MOST", 0)  # by rows of gaps
    many = tb.solve(case, F_star=loads).outputs
    assert few["mu"][0] != many["mu"][0]  # more nodes are used
    for name in ("mu", "mu_sa_roll", "rolling_share", "hc_sa"):
        assert few[name] == pytest.approx(many[name], rel=1e-8, abs=1e-300), name


FRICTION, DENTS = tb.outputs.Friction(tau_ss=4e8, tau_sa=2e8), tb.outputs.Dents()


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
@pytest.mark.parametrize(
    "sizes",
    [
        tb.LogNormal(median=50e-9, gsd=1.3),
        tb.TruncatedGaussian(mean=300e-9, std=3e-9),
        tb.distributions.Uniform(low=20e-9, high=400e-9),
        tb.distributions.Weibull(scale=200e-9, shape=3.0),
    ],
)
def test_sums_over_squeezes_are_those_over_rows_of_gaps(sizes, monkeypatch):
    from thirdbody.contact import particle_averages

    steel = tb.materials["S45C"]
    case = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel.replace(H=4e9)),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(material=tb.materials["SiO2"], areal_density=1e10, diameter=sizes),
        outputs=(
            FRICTION,
            tb.outputs.Counts(),
            tb.outputs.Wear(K_ss=1e-5, K_sa=1e-4, f_ab=0.1, f_roll=0.01),
        ),
    )
    for F_star in (1e-7, 1e-4, 1e-2):  # from open gaps to closed ones
        monkeypatch.setattr(particle_averages, "MOST", 200_000)
        few = tb.solve(case, F_star=F_star).outputs
        monkeypatch.setattr(particle_averages, "MOST", 0)
        rows = tb.solve(case, F_star=F_star).outputs
        assert any(few[name] != rows[name] for name in rows)  # they are two sums
        for name in rows:
            assert few[name] == pytest.approx(rows[name], rel=2e-9, abs=1e-300, nan_ok=True), name


# ------------------------------------------------- seats so high that the gap is closed
@pytest.mark.spread(2)
@pytest.mark.parametrize(
    ("hardness", "second", "sizes", "deep", "outputs"),
    [
        (8e9, 5e9, tb.LogNormal(median=100e-9, gsd=1.4), "table", (FRICTION, DENTS)),
        (3e9, 2.9e9, tb.TruncatedGaussian(mean=3e-6, std=1e-6), "table", (FRICTION, DENTS)),
        (13.5e9, 4.2e9, tb.LogNormal(median=5e-9, gsd=2.3), "off", (FRICTION,)),
    ],
)
def test_outputs_in_closed_gaps_are_known_to_eight_digits(
    hardness, second, sizes, deep, outputs, monkeypatch
):
    """Small particles are squeezed by many times their size: what changes there is split too."""
    from thirdbody.contact import particle_averages

    debris = tb.Material(E=2e11, nu=0.3, H=hardness)
    steel = tb.Material(E=205e9, nu=0.3, H=min(second, 5e9))
    case = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel.replace(H=second)),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(material=debris, areal_density=1e9, diameter=sizes),
        particle_law=tb.particle.Series(deep=deep),
        outputs=outputs,
    )
    loads = [3e-5, 2e-2]
    few = tb.solve(case, F_star=loads).outputs
    monkeypatch.setattr(particle_averages, "SIZE_NODES", 16)
    monkeypatch.setattr(particle_averages, "SPOT_NODES", (22, 19))
    monkeypatch.setattr(particle_averages, "MOST", 0)  # by rows of gaps
    many = tb.solve(case, F_star=loads).outputs
    names = [
        name
        for name in ("mu_sa", "mu_sa_roll", "mu_plough_1", "dent_depth_1", "dent_volume_1")
        if name in few
    ]
    assert any(few[name][-1] != many[name][-1] for name in names)  # more nodes are used
    for name in names:
        assert few[name] == pytest.approx(many[name], rel=1e-8), name
