"""Conductance of the contact: against stiffness, explicit sums, and the law of Wiedemann, Franz."""

import math

import numpy as np
import pytest
from refusals import Mistake, refuses, warns_of

import thirdbody as tb
from thirdbody.contact.evaluation import spots_of
from thirdbody.contact.interface import interface
from thirdbody.effects import ElectricalConductance, ThermalConductance
from thirdbody.effects.single import heat

STEEL = tb.materials["S45C"].replace(thermal_conductivity=50.0, resistivity=2e-7)
SILICA = tb.materials["SiO2"].replace(thermal_conductivity=1.4, resistivity=1e-6)
LOADS = np.geomspace(1e5, 1e8, 5)
pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")


def contact(*outputs, size=300e-9, density=1e10, first=STEEL, second=STEEL, dust=SILICA, **others):
    particles = None
    if density:
        diameter = tb.TruncatedGaussian(mean=size, std=0.2 * size)
        particles = tb.Particles(material=dust, areal_density=density, diameter=diameter)
    given = dict(roughness=tb.Roughness(sigma=100e-9, R=2.8e-6)) | others
    return tb.Contact(
        surfaces=tb.MaterialPair(first, second), particles=particles, outputs=outputs, **given
    )


def test_value_of_two_bodies():
    """ZMC asperities at d = 2σ, by independent quadrature."""
    state = tb.solve(contact(ThermalConductance(form="none"), density=0), d=200e-9)
    assert state.outputs["hc"] == pytest.approx(61836.21313184142, rel=1e-9)
    state = tb.solve(contact(ThermalConductance(), density=0), pressure=5e6)
    assert state.outputs["hc"] == pytest.approx(117_900, rel=5e-4)


@pytest.mark.parametrize(("size", "h"), [(100e-9, 117708.133678133), (300e-9, 94307.0011313149)])
def test_value_of_three_bodies(size, h):
    """An independent state, which lets ψ act on particles too and averages logs over a disc."""
    case = contact(ThermalConductance(), size=size)
    case = case.replace(particle_law=tb.particle.Series(deep="off"))
    state = tb.solve(case, pressure=5e6)
    _, groups = spots_of(case, interface(case), np.atleast_1d(state.d), np.atleast_1d(state.shadow))
    through = 0.0
    for spots in groups:
        b = [np.sqrt(np.maximum(area, 1e-300) / np.pi) for area in spots.areas]
        R = sum(
            1 / (4 * 50 * each)
            + 1 / (4 * 1.4 * each)
            + (np.log(2 * spots.x / each) - 0.75) / (4 * np.pi * 1.4 * spots.x / 2)
            for each in b
        )
        through += spots.total(np.where(spots.load > 0, 1 / R, 0.0))[0]
    psi = (1 - math.sqrt(state.A_t)) ** 1.5
    psi_ss = (1 - math.sqrt(state.A_ss)) ** 1.5
    found = state.outputs["hc_ss"] * psi_ss / psi + through / psi
    assert found == pytest.approx(h, rel=1e-9)
    assert state.outputs["hc"] == pytest.approx(h, rel=7e-3)


@pytest.mark.parametrize("second_k", [50.0, 5.0])
def test_conductance_is_stiffness(second_k):
    """Barber 2003: elastic spots conduct 2k_h/E* of their stiffness."""
    case = contact(
        ThermalConductance(form="none"),
        density=0,
        asperity_law=tb.asperity.GW(),
        second=STEEL.replace(thermal_conductivity=second_k),
    )
    d = np.linspace(0.5, 3, 6) * 100e-9
    found = np.array([tb.solve(case, d=float(each)).outputs["hc"] for each in d])
    k = 2 / (1 / 50 + 1 / second_k)
    # a spot conducts 2 k b and has the stiffness 2 E* b
    exact = k / case.E_ss * interface(case).load(d)[:, 1]
    np.testing.assert_allclose(found, np.abs(exact), rtol=1e-8)


def test_elastic_particles_by_stiffness():
    """Perfect conductors: R = 1/(4kb_1)+1/(4kb_2), and both contacts have 2E*b in series."""
    case = contact(
        ThermalConductance(form="none"),
        dust=SILICA.replace(thermal_conductivity=1e9),
        size=200e-9,
        roughness=tb.Roughness(sigma=50e-9, R=100e-6),
        asperity_law=tb.asperity.GW(),
        particle_law=tb.particle.Series(
            deep="off", law=tb.asperity.GW(), seat="plane", shadow="none"
        ),
    )
    state = tb.solve(case, pressure=1e6)
    bare = case.replace(particles=None)
    d = np.atleast_1d(state.d)
    stiffness = interface(case).load(d)[0, 1] - interface(bare).load(d)[0, 1]
    E_sa = tb.MaterialPair(STEEL, SILICA).E_star
    assert state.outputs["hc_sa"] == pytest.approx(2 * 50 * abs(stiffness) / E_sa, rel=1e-6)


def test_wiedemann_franz():
    T = 300.0
    metal = STEEL.replace(resistivity=2e-7, thermal_conductivity=heat.LORENZ * T / 2e-7)
    other = STEEL.replace(resistivity=5e-8, thermal_conductivity=heat.LORENZ * T / 5e-8)
    dust = SILICA.replace(resistivity=1e-6, thermal_conductivity=heat.LORENZ * T / 1e-6)
    case = contact(
        ThermalConductance(), ElectricalConductance(particles="conduct"),
        first=metal, second=other, dust=dust,
    )  # fmt: skip
    found = tb.solve(case, pressure=LOADS).outputs
    np.testing.assert_allclose(found["hc"], heat.LORENZ * T * found["gc"], rtol=1e-12)
    np.testing.assert_allclose(found["hc_sa"], heat.LORENZ * T * found["gc_sa"], rtol=1e-12)
    np.testing.assert_allclose(found["rho_c"] * found["gc"], 1, rtol=1e-14)


def test_parts_and_insulators():
    found = tb.solve(contact(ThermalConductance(k_gap=0.026, M=0.4e-6)), pressure=LOADS)
    out = found.outputs
    np.testing.assert_allclose(out["hc"], out["hc_ss"] + out["hc_sa"] + out["hc_gap"], rtol=1e-14)
    np.testing.assert_allclose(out["hc_gap"], 0.026 / (found.h + 0.4e-6), rtol=1e-14)
    closed = tb.solve(contact(ThermalConductance(particles="insulate")), pressure=LOADS).outputs
    np.testing.assert_allclose(closed["hc"], out["hc_ss"], rtol=1e-13)
    assert np.all(closed["hc_sa"] == 0)
    poor = contact(ThermalConductance(), dust=SILICA.replace(thermal_conductivity=1e-9))
    poor = tb.solve(poor, pressure=LOADS).outputs
    assert np.all(poor["hc_sa"] < 1e-5 * poor["hc"])


def test_insulating_particles_need_no_conductivity():
    dust = tb.materials["TiO2"]
    tb.solve(contact(ElectricalConductance(), dust=dust), pressure=5e6)
    tb.solve(contact(ThermalConductance(particles="insulate"), dust=dust), pressure=5e6)
    with refuses(
        Mistake.MISSING, "outputs.thermal_conductance", says="thermal_conductivity of the particles"
    ):
        contact(ThermalConductance(), dust=dust)
    with refuses(
        Mistake.MISSING,
        "outputs.electrical_conductance",
        says="resistivity of surface 1 (SnSb8Cu4)",
    ):
        contact(ElectricalConductance(), first=tb.materials["SnSb8Cu4"])


def test_particles_lower_it():
    """At equal load more and larger insulating particles hold the surfaces further apart."""
    h = [
        tb.solve(contact(ThermalConductance(), size=size, density=n), pressure=5e6).outputs["hc"]
        for size, n in ((300e-9, 0), (300e-9, 1e10), (300e-9, 3e10), (500e-9, 3e10))
    ]
    assert np.all(np.diff(h) < 0)


def test_swapped_surfaces():
    other = STEEL.replace(thermal_conductivity=5.0, H=2.5e9)
    one = tb.solve(contact(ThermalConductance(), second=other), pressure=LOADS).outputs
    two = tb.solve(contact(ThermalConductance(), first=other), pressure=LOADS).outputs
    for name in ThermalConductance.columns:
        np.testing.assert_allclose(one[name], two[name], rtol=1e-9)


def test_change_of_units():
    """Lengths × L at equal pressure: conductance over L."""
    L = 7.0
    one = tb.solve(contact(ThermalConductance(), density=1e10), pressure=LOADS).outputs
    big = contact(
        ThermalConductance(),
        size=300e-9 * L,
        density=1e10 / L**2,
        roughness=tb.Roughness(sigma=100e-9 * L, R=2.8e-6 * L),
    )
    two = tb.solve(big, pressure=LOADS).outputs
    for name in ("hc_ss", "hc_sa", "hc_cmy"):
        np.testing.assert_allclose(one[name], L * two[name], rtol=1e-7)


def test_finer_nodes_change_nothing():
    case = contact(ThermalConductance())
    d = np.atleast_1d(tb.solve(case, pressure=LOADS).d)
    (response,) = interface(case).populations
    b = [
        sum(s.total(np.sqrt(s.areas[0])) for s in response.spots(d, splits))
        for splits in ((), np.geomspace(1e-3, 0.3, 7))
    ]
    np.testing.assert_allclose(*b, rtol=1e-6)


def test_films_and_small_spots_resist():
    def rho(**given):
        case = contact(ElectricalConductance(particles="conduct", **given))
        return tb.solve(case, pressure=5e6).outputs["rho_c"]

    assert rho() < rho(mean_free_path=40e-9) < rho(mean_free_path=400e-9)
    # a film that dominates: ρ_c A_t = σ_f for asperities alone
    case = contact(ElectricalConductance(film=1e-6, form="none"), density=0)
    state = tb.solve(case, pressure=5e6)
    assert state.outputs["rho_c"] * state.A_t == pytest.approx(1e-6, rel=1e-4)


def test_clean_plastic_surfaces():
    """Elastic-plastic asperities have 1 to 2 times the conductance of plastic surfaces."""
    state = tb.solve(contact(ThermalConductance(), density=0), pressure=np.geomspace(2e5, 5e7, 6))
    ratio = state.outputs["hc"] / state.outputs["hc_cmy"]
    assert np.all((ratio > 1) & (ratio < 2))
    # in proportion to load within 5 % a decade of load each
    slope = np.diff(np.log(state.outputs["hc"])) / np.diff(np.log(np.geomspace(2e5, 5e7, 6)))
    assert np.all((slope > 0.9) & (slope < 1.02))


def test_warns_of_wide_contacts():
    with warns_of("thermal_conductance.wide", effect=0.1063):
        tb.solve(contact(ThermalConductance(), size=500e-9), pressure=5e6)


@pytest.mark.parametrize("law", ["elastic", "elastic-plastic"])
def test_conduction_of_the_2014_paper(law):
    """Insulating particles lower conduction, by the same ratio as from the stiffness."""
    from thirdbody.papers import ghaednia2014

    pressures = np.array([1e6, 1e7, 5e7])
    dusty = ghaednia2014.contact(law)
    metal = dusty.surfaces.first.replace(thermal_conductivity=50.0)
    heat_only = ThermalConductance(particles="insulate", form="none")
    dusty = dusty.replace(surfaces=tb.MaterialPair(metal, metal), outputs=heat_only)
    with_particles = tb.solve(dusty, pressure=pressures).outputs["hc"]
    without = tb.solve(dusty.replace(particles=None), pressure=pressures).outputs["hc"]
    ratio = ghaednia2014.conductance_ratio(law, pressures)
    np.testing.assert_allclose(with_particles / without, ratio, rtol=1e-7)
    assert np.all(with_particles < without)


def mixed(*outputs, silica=SILICA):
    """Silica and steel particles of one size side by side."""
    size = tb.TruncatedGaussian(mean=300e-9, std=60e-9)
    kinds = tuple(
        tb.Particles(material=each, areal_density=5e9, diameter=size, name=name)
        for name, each in (("sand", silica), ("debris", STEEL))
    )
    return contact(*outputs, density=0).replace(particles=kinds)


def test_by_material_what_has_no_resistivity_is_no_way_for_a_current():
    """As sand of a resistivity beyond measure does, where all conduct."""
    rubber = SILICA.replace(resistivity=1e25)
    all_conduct = ElectricalConductance(particles="conduct")
    expected = tb.solve(mixed(all_conduct, silica=rubber), pressure=LOADS).outputs
    none = SILICA.replace(resistivity=None)
    by_material = ElectricalConductance(particles="by material")
    found = tb.solve(mixed(by_material, silica=none), pressure=LOADS).outputs
    assert found["gc_sa"] == pytest.approx(expected["gc_sa"], rel=1e-9)
    assert found["rho_c"] == pytest.approx(expected["rho_c"], rel=1e-9)
    assert np.all(found["gc_sa"] > 0)


def test_by_material_one_kind_conducts_or_insulates():
    none = SILICA.replace(resistivity=None)
    for dust, as_word in ((SILICA, "conduct"), (none, "insulate")):
        for A_n in (None, 1e-10):
            found, expected = (
                tb.solve(
                    contact(ElectricalConductance(particles=word, A_n=A_n), dust=dust),
                    pressure=LOADS,
                ).outputs
                for word in ("by material", as_word)
            )
            for name, values in expected.items():
                assert np.array_equal(found[name], values, equal_nan=True), name


def test_of_few_particles_that_differ_nothing_is_told():
    none = SILICA.replace(resistivity=None)
    with refuses(Mistake.CLASH, "outputs.electrical_conductance.A_n"):
        mixed(ElectricalConductance(particles="by material", A_n=1e-10), silica=none)


@pytest.mark.parametrize("seat", ["rough", "plane"])
def test_soft_debris_conducts_the_more_the_more_it_is_pressed(seat):
    """Squashed flat it is all but no resistance, and never less than none."""
    debris = STEEL.replace(H=1e9)
    through_all = ThermalConductance(), ElectricalConductance(particles="conduct")
    case = contact(*through_all, dust=debris, density=1e11, second=SILICA)
    case = case.replace(particle_law=tb.particle.Series(seat=seat))
    state = tb.solve(case, F_star=np.geomspace(1e-8, 1e-3, 12))
    for name in ("hc_sa", "gc_sa"):
        through = state.outputs[name]
        assert np.all(through > 0)
        assert np.all(np.diff(through) > 0)


def test_film_under_soft_debris_is_what_resists():
    """Particles squashed flat leave the film and the surfaces: R → Σ 1/(4k b) + R_f/(πb²)."""
    debris = STEEL.replace(H=1e9)
    film = 1e-6
    case = contact(ThermalConductance(film=film), dust=debris, density=1e9)
    state = tb.solve(case, F_star=1e-3)
    _, groups = spots_of(case, interface(case), np.atleast_1d(state.d), np.atleast_1d(state.shadow))
    most = 0.0
    for spots in groups:
        R = sum(
            1 / (4 * 50 * b) + film / (np.pi * b**2)
            for b in (np.sqrt(np.maximum(area, 1e-300) / np.pi) for area in spots.areas)
        )
        most += spots.total(np.where(spots.load > 0, 1 / R, 0.0))[0]
    assert 0.9 < state.outputs["hc_sa"] / most < 1.0
