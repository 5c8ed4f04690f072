"""One field of heights by the compiled engines: held to NumPy, and to itself."""

import os
from unittest import mock

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.contact import interface
from thirdbody.equilibrium import states
from thirdbody.equilibrium.columns import COLUMNS
from thirdbody.equilibrium.compiled import batch
from thirdbody.equilibrium.states import state_columns
from thirdbody.equilibrium.status import FIELD_SENTENCES, Status
from thirdbody.laws.field.formulas import hardness_ratio
from thirdbody.laws.field.own import RollOff

pytest.importorskip("numba")
from thirdbody.equilibrium.engine.run import own_columns

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
STEEL = tb.Material(E=208e9, nu=0.3, H=6e9)
HELD = ("d_star", "F_ss_star", "F_sa_star", "A_e", "A_p", "A_sa", "A_sa2", "A_t", "shadow")
BOUND, ROUNDED = 1e-11, 2e-12
"""Of d over σ, of loads over F, of areas over A_t; and what NumPy itself is off by rounding."""


def contact(particles=None, *, H=6e9, **more):
    body = STEEL.replace(H=H)
    return tb.Contact(
        surfaces=tb.MaterialPair(body, body),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6, alpha=5.0),
        asperity_law=tb.asperity.Field(**more),
        particles=particles,
    )


def drawn(count: int, seed: int) -> tuple[dict, np.ndarray]:
    """Surfaces of every hardness ratio and bandwidth of the table, and loads F*."""
    rng = np.random.default_rng(seed)
    vary = {
        "roughness.sigma": 10 ** rng.uniform(-8.5, -6, count),
        "roughness.R": 10 ** rng.uniform(-6, -4, count),
        "roughness.alpha": rng.uniform(2.5, 30, count),
        "surfaces.first.H": 10 ** rng.uniform(7.5, 11, count),
        "surfaces.first.E": 10 ** rng.uniform(10.5, 11.8, count),
    }
    return vary, 10 ** rng.uniform(-9, -2, count)


def by_numpy(case: tb.Contact, loads: np.ndarray, vary: dict) -> dict:
    with mock.patch.dict(os.environ, THIRDBODY_ENGINE="numpy"):
        return state_columns(case, F_star=loads, vary=vary)


def errors(got: dict, want: dict) -> np.ndarray:
    """The largest error of each state (N,), of columns over what they are measured against."""
    found = []
    for name in HELD:
        unit = {"d": 1.0, "F": want["F_star"], "s": 1.0}.get(name[0], want["A_t"])
        found.append(np.abs(got[name] - want[name]) / unit)
    return np.max(found, axis=0)


@pytest.mark.parametrize("remainder", [True, False])
def test_surfaces_of_their_own_hold_to_numpy(remainder):
    case, (vary, loads) = contact(H=1e13, remainder=remainder), drawn(150, 1)
    varied = case.with_arrays(vary)
    chi = hardness_ratio(
        varied.roughness, E_star=varied.surfaces.E_star, H=vary["surfaces.first.H"]
    )
    assert chi.min() < 0.01  # all parts of the table are asked
    assert chi.max() > 3
    got, want = own_columns(case, vary, "F_star", loads), by_numpy(case, loads, vary)
    solved = np.isfinite(want["d"])
    assert 0.5 < solved.mean() < 1  # some of the loads are too much
    assert not np.any(got["doubt"] != "")
    assert np.array_equal(got["status"] == 0, solved)
    assert set(got["status"][~solved]) == {Status.TOO_MUCH}
    off = errors(got, want)[solved]
    assert off.max() <= BOUND
    assert np.all(off <= got["error"][solved] + ROUNDED)
    assert np.all(got["residual"][solved] <= 1e-11)


def test_at_given_separations():
    case, (vary, _) = contact(H=1e13), drawn(40, 2)
    d = vary["roughness.sigma"] * np.linspace(0.3, 6.0, 40)
    got = own_columns(case, vary, "d", d)
    with mock.patch.dict(os.environ, THIRDBODY_ENGINE="numpy"):
        want = state_columns(case, d=d, vary=vary)
    known = np.isfinite(want["d"])
    assert known.sum() > 30
    for name in ("F_ss_star", "A_t", "h"):
        np.testing.assert_allclose(got[name][known], want[name][known], rtol=1e-11, atol=1e-300)
    for name in ("A_e", "A_p"):  # what is elastic is one less what has yielded
        off = np.abs(got[name] - want[name])[known]
        assert np.all(off <= 1e-12 * want["A_t"][known])
    below = contact(H=1e13).replace(roughness=case.roughness)
    deep = own_columns(below, {}, "d", np.array([-1.0e-6]))
    assert (deep["doubt"][0], deep["status"][0]) == ("", Status.TOO_DEEP)


def test_alone_among_others_and_in_any_order():
    case, (vary, loads) = contact(), drawn(60, 3)
    together = own_columns(case, vary, "F_star", loads)
    order = np.random.default_rng(0).permutation(60)
    turned = own_columns(case, {k: v[order] for k, v in vary.items()}, "F_star", loads[order])
    for name in COLUMNS:
        if name in ("status", "mode"):
            continue
        np.testing.assert_array_equal(turned[name], np.asarray(together[name])[order])
    for i in (0, 31, 59):
        alone = own_columns(case, {k: v[[i]] for k, v in vary.items()}, "F_star", loads[[i]])
        for name in ("d", "A_t", "A_p", "F_ss_star"):
            np.testing.assert_array_equal(alone[name][0], together[name][i])


def test_a_load_that_is_too_much_is_told_of_the_table():
    sigma = np.linspace(90e-9, 110e-9, 30)
    found = state_columns(contact(), F_star=np.full(30, 0.9), vary={"roughness.sigma": sigma})
    assert set(found["status_code"]) == {1}
    assert {str(each) for each in found["status"]} == {FIELD_SENTENCES[Status.TOO_MUCH]}


def test_many_loads_of_one_contact_hold_to_numpy():
    case, loads = contact(None, H=6e9), np.geomspace(1e-9, 0.3, 61)
    with mock.patch.object(batch, "FEWEST", 1):
        got = tb.solve(case, F_star=loads)
    assert got.engine == "compiled"
    with mock.patch.dict(os.environ, THIRDBODY_ENGINE="numpy"):
        want = tb.solve(case, F_star=loads)
    assert got.status.tolist() == want.status.tolist()
    assert 0 < np.isfinite(want.d).sum() < 61
    assert np.nanmax(errors(got.columns(), want.columns())) <= BOUND


@pytest.mark.spread(2)
@pytest.mark.parametrize(
    ("diameter", "H", "density"),
    [
        (tb.TruncatedGaussian(mean=300e-9, std=30e-9), 6e9, 1e11),
        (tb.distributions.Monodisperse(mean=200e-9), 20e9, 3e11),
        (tb.distributions.Mixture(parts=(tb.distributions.Monodisperse(mean=100e-9), tb.LogNormal(median=250e-9, gsd=1.2)),
                    weights=(7, 3)), 3e9, 1e11),
    ],
)  # fmt: skip
def test_many_loads_with_particles_are_those_of_each(diameter, H, density):
    """A ground solved for many loads says of each what it says of that alone."""
    silica = tb.materials["SiO2"]
    dust = tb.Particles(material=silica, areal_density=density, diameter=diameter)
    case, loads = contact(dust, H=H), np.geomspace(1e-9, 0.3, 31)
    with mock.patch.object(batch, "FEWEST", 1):
        together = tb.solve(case, F_star=loads)
    assert together.engine != "compiled"
    assert 0 < np.isfinite(together.d).sum() < 31
    for k in (5, 15, 20):
        interface._interface.cache_clear()
        alone = tb.solve(case, F_star=loads[[k]])
        assert alone.d[0] == pytest.approx(together.d[k], abs=1e-11 * case.roughness.sigma)
        assert alone.A_t[0] == pytest.approx(together.A_t[k], rel=1e-10)


BRITTLE = tb.Particles(
    material=STEEL,
    areal_density=1e10,
    diameter=tb.LogNormal(median=250e-9, gsd=1.2),
    strength=tb.grains.WeibullStrength(
        sigma_0=67e6, x_0=1e-3, m=3.0, size_exponent=0.55, x_c=50e-9
    ),
)


@pytest.mark.spread(2)
@pytest.mark.parametrize(
    ("case", "why"),
    [
        (contact(BRITTLE), "ground of particles"),
        (contact(spectrum=RollOff(corner="sharp")), "spectrum of its own"),
    ],
)  # fmt: skip
def test_what_has_tables_of_its_own_says_so(case, why):
    vary = {"roughness.sigma": np.array([99e-9, 101e-9])}
    with mock.patch.object(states, "FEWEST", 2):
        found = state_columns(case, F_star=np.full(2, 1e-3), vary=vary)
    assert all(str(each).startswith("numpy: ") and why in each for each in found["engine"])
    assert set(found["status"]) == {"ok"}


def test_what_needs_tables_of_its_own_is_known_beforehand():
    assert states.tables_each(contact(BRITTLE), ["roughness.sigma", "pressure"])
    assert not states.tables_each(contact(BRITTLE), ["pressure", "outputs.friction.m_ss"])
    assert not states.tables_each(contact(), ["roughness.sigma", "surfaces.first.H"])
    assert states.tables_each(contact(spectrum=RollOff(corner="sharp")), ["roughness.R"])
