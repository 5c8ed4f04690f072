"""What outputs say where the rough surface is one field: by the field itself, or told that not."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import thirdbody as tb

BRASS = tb.Material(
    E=110e9, nu=0.34, H=1.3e9, resistivity=6.4e-8, thermal_conductivity=110.0
)  # fmt: skip
LOADS = np.array([5e6, 5e7, 2e8])


def contact(*outputs, law=None, H=1.3e9, E=110e9, sigma=200e-9, R=5e-6, **others):
    body = BRASS.replace(H=H, E=E)
    return tb.Contact(
        surfaces=tb.MaterialPair(body, body), roughness=tb.Roughness(sigma=sigma, R=R),
        asperity_law=law or tb.asperity.Field(), outputs=outputs, **others,
    )  # fmt: skip


def solved(case, **load):
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        state = tb.solve(case, **load)
    return state, [str(each.message) for each in heard]


def about_spots(heard):
    return [each for each in heard if "no single spots" in each]


def test_an_elastic_surface_conducts_as_its_load_rises():
    """2(−dF/dh)/(E*(ρ_1 + ρ_2)), the derivative taken of solved states (Barber 2003)."""
    case = contact(tb.outputs.ElectricalConductance(), H=1e12)
    h = np.array([0.8, 1.5, 2.5]) * 200e-9
    mean_plane = tb.solve(case, F_star=1e-3).h - tb.solve(case, F_star=1e-3).d
    step = 1e-4 * 200e-9
    down, up = (solved(case, d=h + s - mean_plane)[0].pressure for s in (-step, step))
    state, heard = solved(case, d=h - mean_plane)
    expected = 2 * (down - up) / (2 * step) / case.E_ss / (2 * 6.4e-8)
    assert state.outputs["gc_ss"] == pytest.approx(expected, rel=0.02)
    assert not about_spots(heard)


def test_a_lower_bound_without_the_remainder():
    bare = contact(tb.outputs.ThermalConductance(), law=tb.asperity.Field(remainder=False))
    whole = contact(tb.outputs.ThermalConductance())
    d = tb.solve(whole, pressure=LOADS).d
    one, other = (solved(each, d=d)[0].outputs["hc_ss"] for each in (bare, whole))
    assert other / one == pytest.approx(1.0 + 0.10 + 0.04 * np.log(5.0), rel=1e-9)


def test_change_of_units():
    """Lengths three times as large, stresses twice: conductance is 1/length."""
    small = contact(tb.outputs.ElectricalConductance())
    large = contact(
        tb.outputs.ElectricalConductance(), H=2.6e9, E=220e9, sigma=600e-9, R=15e-6
    )  # fmt: skip
    one = solved(small, pressure=LOADS)[0].outputs["gc"]
    other = solved(large, pressure=2 * LOADS)[0].outputs["gc"]
    assert 3 * other == pytest.approx(one, rel=1e-6)


def test_films_and_free_paths_come_in_series():
    clean = solved(contact(tb.outputs.ElectricalConductance()), pressure=LOADS)[0]
    thick = contact(tb.outputs.ElectricalConductance(film=1e-8))
    state, heard = solved(thick, pressure=LOADS)
    assert state.outputs["gc"] == pytest.approx(state.A_t / 1e-8, rel=1e-3)
    assert len(about_spots(heard)) == 1
    thin = solved(contact(tb.outputs.ElectricalConductance(film=1e-18)), pressure=LOADS)[0]
    assert thin.outputs["gc"] == pytest.approx(clean.outputs["gc"], rel=1e-3)
    far = solved(contact(tb.outputs.ElectricalConductance(mean_free_path=1e-2)), pressure=LOADS)[0]
    sharvin = 3 * far.A_t / (4 * 6.4e-8 * 1e-2)
    assert far.outputs["gc"] == pytest.approx(sharvin, rel=1e-3)


def test_heat_and_current_follow_wiedemann_and_franz():
    both = contact(
        tb.outputs.ElectricalConductance(), tb.outputs.ThermalConductance(form="none")
    )  # fmt: skip
    found = solved(both, pressure=LOADS)[0].outputs
    assert found["hc_ss"] / found["gc_ss"] == pytest.approx(110.0 * 6.4e-8, rel=1e-12)


def test_wear_goes_by_the_areas_of_the_field():
    wear = tb.outputs.Wear(K_ss=1e-4, K_sa=0.0)
    friction = tb.outputs.Friction(tau_ss=1e8, tau_sa=1e8)
    state, heard = solved(contact(wear, friction, H=5e9), pressure=LOADS)
    assert state.outputs["wear_ss"] == pytest.approx(1e-4 * state.A_p, rel=1e-12)
    assert state.outputs["mu"] == pytest.approx(1e8 * state.A_t / LOADS, rel=1e-9)
    assert not about_spots(heard)


def test_outputs_that_need_spots_are_named():
    case = contact(tb.outputs.Counts(), tb.outputs.Friction(tau_ss=1e8, tau_sa=1e8))
    state, heard = solved(case, pressure=LOADS)
    (told,) = about_spots(heard)
    assert "outputs.counts" in told
    assert "friction" not in told
    assert state.outputs["p_ss"] == pytest.approx(LOADS / state.A_t, rel=1e-9)
    grown = contact(tb.outputs.Friction(tau_ss=1e8, tau_sa=1e8, alpha_T=9.0))
    assert "outputs.friction" in about_spots(solved(grown, pressure=LOADS)[1])[0]


def test_in_the_shadow_of_particles_less_is_conducted():
    dust = tb.Particles(
        material=tb.materials["SiO2"], areal_density=1e11, diameter=tb.distributions.Monodisperse(mean=400e-9)
    )  # fmt: skip
    case = contact(tb.outputs.ElectricalConductance(), particles=dust)
    bare = case.replace(particles=None)
    state = solved(case, F_star=1e-3)[0]
    same = solved(bare, d=state.h - (tb.solve(bare, F_star=1e-3).h - tb.solve(bare, F_star=1e-3).d))
    assert state.outputs["gc"] < (1 - state.shadow) * same[0].outputs["gc"] * (1 + 1e-9)
