"""Particles embedded to their cap before asperities carry: the load has hardly a slope there."""

import os
from unittest import mock

import numpy as np
import pytest
from refusals import Mistake, Status, refuses

import thirdbody as tb
from thirdbody.contact.interface import interface as bound_interface
from thirdbody.equilibrium import states
from thirdbody.equilibrium.columns import COLUMNS
from thirdbody.equilibrium.compiled import batch as engine
from thirdbody.equilibrium.states import state_columns

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
compiled = pytest.mark.skipif(not engine.available(), reason="needs the compiled engine")

SEATS = ("plane", "offset", "rough")
SIZES = {
    "monodisperse": lambda x: tb.distributions.Monodisperse(mean=x),
    "gaussian": lambda x: tb.TruncatedGaussian(mean=x, std=0.1 * x),
    "lognormal": lambda x: tb.LogNormal(median=x, gsd=1.15),
}
SIZE = 1.4e-6
NUMBERS = [name for name in COLUMNS if name not in ("mode", "status")]
EPS = np.finfo(float).eps


def dusty(seat="plane", shape="gaussian", sigma=10e-9, cover=1e-5) -> tb.Contact:
    """Silica dust between steel."""
    steel, sizes = tb.materials["S45C"], SIZES[shape](SIZE)
    return tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=sigma, R=28 * sigma),
        particles=tb.Particles(
            material=tb.materials["SiO2"],
            diameter=sizes,
            areal_density=cover / (np.pi / 4 * sizes.moment(2)),
        ),
        particle_law=tb.particle.Series(
            deep="off", seat=seat, **({"h_0": 2e-8} if seat == "offset" else {})
        ),
    )


def random_states(contact: tb.Contact, count: int, seed: int, most: float = 1000.0):
    """Inputs over x/σ from 0.3 on and coverages of seven decades, and loads over ten."""
    rng = np.random.default_rng(seed)
    sigma = SIZE / np.exp(rng.uniform(np.log(0.3), np.log(most), count))
    density = contact.particles.areal_density
    vary = {
        "roughness.sigma": sigma,
        "roughness.R": 28 * sigma * 2.0 ** rng.uniform(-1, 1, count),
        "particles.areal_density": density * 10.0 ** rng.uniform(-2, 4, count),
    }
    return vary, 10.0 ** rng.uniform(-12, -2, count)


def arrays(result) -> dict[str, np.ndarray]:
    return result if isinstance(result, dict) else result.columns()


def balanced(got, F_star, at, bound=1e-12) -> None:
    """Solved states are whole and carry their loads: to rounding, or to what an ulp of d changes.

    ``at`` gives the loads F* at separations.
    """
    got = arrays(got)
    ok = np.asarray(got["status"]) == "ok"
    for name in NUMBERS:
        assert np.all(np.isfinite(got[name][ok])), name
        if name != "iterations":
            given = name in ("F_star", "pressure")
            assert given or np.all(np.isnan(got[name][~ok])), name
    carried = got["F_ss_star"] + got["F_sa_star"]
    error = np.abs(carried / F_star - 1)
    loose = np.flatnonzero(ok & (error > bound))
    if len(loose):
        d, scale = got["d"][loose], np.abs(got["d"][loose]) + got["d"][loose] / got["d_star"][loose]
        steep = np.abs(at(d - 4 * EPS * scale, loose) - at(d + 4 * EPS * scale, loose))
        assert np.all(error[loose] <= bound + steep / F_star[loose])
    assert np.all(got["residual"][ok] == pytest.approx(error[ok], rel=1e-6, abs=1e-15))
    regimes = got["A_e"] + got["A_ep"] + got["A_p"]
    np.testing.assert_allclose(regimes[ok], got["A_t"][ok], rtol=1e-14)
    for name in ("A_e", "A_ep", "A_p", "A_ss", "A_sa", "A_sa2", "F_ss_star", "F_sa_star"):
        assert np.all(got[name][ok] >= 0), name


# --------------------------------------------------------------------------- balances
@pytest.mark.check
@pytest.mark.spread(4)
@compiled
@pytest.mark.parametrize("shape", SIZES)
@pytest.mark.parametrize("seat", SEATS)
def test_dust_under_many_loads(seat, shape):
    """The load rises by the asperities alone, from nothing, while all particles are at the cap."""
    contact, loads = dusty(seat, shape), np.geomspace(1e-9, 1e-3, 100_000)
    result = tb.sweep(contact, F_star=loads)
    assert set(result.status.values) == {"ok"}
    got = {name: result[name].values for name in COLUMNS if name != "F_star"}

    def at(d, which):
        state = tb.solve(contact, d=d)
        return state.F_ss_star + state.F_sa_star

    balanced(got | {"F_star": loads}, loads, at)
    assert np.all(np.diff(got["d"]) <= 1e-15 * SIZE)


@pytest.mark.spread(4)
@compiled
@pytest.mark.parametrize("shape", SIZES)
@pytest.mark.parametrize("seat", SEATS)
def test_random_states(seat, shape):
    # nodes reach seats of a hundredth of a broad distribution; the rest goes one by one
    most = 100.0 if (seat, shape) == ("rough", "lognormal") else 1000.0
    contact = dusty(seat, shape)
    vary, loads = random_states(contact, 20_000, 1, most)
    got = state_columns(contact, F_star=loads, vary=vary)
    assert set(got["status"]) == {"ok"}

    def at(d, which):
        some = {name: values[which] for name, values in vary.items()}
        state = state_columns(contact, d=d, vary=some)
        return state["F_ss_star"] + state["F_sa_star"]

    balanced(got, loads, at)


@pytest.mark.spread(4)
@compiled
@pytest.mark.parametrize("shape", SIZES)
@pytest.mark.parametrize("seat", SEATS)
def test_both_engines_agree(seat, shape):
    """Loads and areas; the separation where the load tells it."""
    contact = dusty(seat, shape)
    vary, loads = random_states(contact, 40, 2)
    plateau, sigma = slice(10), vary["roughness.sigma"]
    sigma[plateau] = SIZE / np.linspace(100, 300, 10)
    vary["roughness.R"][plateau] = 28 * sigma[plateau]
    loads[plateau] = state_columns(contact, d=7 * sigma, vary=vary)["F_star"][plateau]
    with mock.patch.object(states, "FEWEST", 2):
        got = state_columns(contact, F_star=loads, vary=vary)
    with mock.patch.dict(os.environ, THIRDBODY_ENGINE="numpy"):
        want = state_columns(contact, F_star=loads, vary=vary)
        d = want["d"]
        step = 4 * EPS * (np.abs(d) + sigma)  # beside the first touch it says much of the load
        below, above, near = (
            state_columns(contact, d=x, vary=vary) for x in (d - step, d + step, d + 1e-6 * sigma)
        )
    assert set(got["status"]) == set(want["status"]) == {"ok"}
    for name in ("F_ss_star", "F_sa_star", "A_t", "A_sa", "A_ss"):
        scale = loads if name.startswith("F") else want["A_t"]
        spread = np.abs(above[name] - below[name])
        assert np.all(np.abs(got[name] - want[name]) <= 1e-11 * scale + spread), name
    flat = 1 - near["F_star"] / loads < 1e-8
    assert flat[plateau].all()
    assert np.all(np.abs(got["d"] - d)[~flat] <= 1e-9 * sigma[~flat])


@compiled
def test_the_ends_of_the_load():
    """More than all carry at −3 σ_s, and less than the model resolves, on a plateau as well."""
    contact = dusty()
    bound = bound_interface(contact)
    most = float(bound.load(np.array([-3 * contact.roughness.sigma_s]))[0, 0]) / contact.E_ss
    loads = np.full(6_000, 1e-7)
    loads[:3] = most * (1 - 1e-9), most * (1 + 1e-9), 1e3
    got = tb.solve(contact, F_star=loads)
    assert got.status[0].startswith("crowded")  # half the plane is cut, and more
    assert got.A_t[0] > 0.5
    assert got.d[0] == pytest.approx(-3 * contact.roughness.sigma_s, rel=1e-8)
    assert got.status_code[1:3].tolist() == [Status.TOO_MUCH] * 2
    assert np.isnan(got.d[1:3]).all()
    assert set(got.status[3:]) == {"ok"}


# ---------------------------------------------------------- what the kernel could not solve
def failing(solve, where):
    """States of the compiled engine as if the kernel had found no balance for some of them."""

    def solved(self, which, target, h=None):
        from thirdbody.equilibrium.compiled.balance import UNSOLVED

        h, evaluations, fate, columns = solve(self, which, target, h)
        if target is not None and len(target) > max(where):
            fate[where] = UNSOLVED
            h[where] = np.nan
            for values in columns.values():
                values[where] = np.nan
        return h, evaluations, fate, columns

    return solved


@compiled
@pytest.mark.parametrize("how", ["solve", "sweep", "states", "stored"])
def test_a_state_without_balance_keeps_its_place(how, tmp_path):
    contact, loads, where = dusty(), np.geomspace(1e-9, 1e-4, 6_000), [3, 77]
    vary = {"roughness.sigma": np.linspace(9e-9, 11e-9, len(loads))}

    def run():
        if how == "solve":
            return tb.solve(contact, F_star=loads).columns()
        if how == "sweep":
            return {k: v.values for k, v in tb.sweep(contact, F_star=loads).items()}
        if how == "states":
            with mock.patch.object(states, "FIRST", len(loads)):
                return state_columns(contact, F_star=loads, vary=vary)
        pytest.importorskip("zarr")
        folder = tmp_path / str(len(list(tmp_path.iterdir())))
        return {k: v.values for k, v in tb.sweep(contact, F_star=loads, out=folder).items()}

    good = run()
    lost = mock.patch.object(engine._Batch, "solve", failing(engine._Batch.solve, where))
    with lost:
        got = run()
    ok = got["status"] == "ok"
    others = np.delete(np.arange(len(loads)), where)
    assert ok[others].all()
    for name in set(NUMBERS) & set(good) - {"F_star", "pressure", "iterations"}:
        assert np.array_equal(got[name][others], good[name][others]), name
        assert np.array_equal(np.isfinite(got[name]), ok), name


# -------------------------------------------------------------------- given separations
@pytest.mark.parametrize("name", ["numpy", pytest.param("", marks=compiled)])
def test_no_states_far_below_every_asperity(name):
    contact = dusty("rough")
    count, sigma_s = 30, contact.roughness.sigma_s
    d = np.full(count, 1e-8)
    d[:3] = -1.0, -5.001 * sigma_s, -4.999 * sigma_s
    vary = {"roughness.R": np.linspace(2.7e-7, 2.9e-7, count)}
    with mock.patch.dict(os.environ, THIRDBODY_ENGINE=name):
        for got in (
            tb.solve(contact, d=d).columns(),
            state_columns(contact, d=d, vary=vary),
            {k: v.values for k, v in tb.sweep(contact, d=d).items()},
        ):
            assert [text == "ok" for text in got["status"]] == [False] * 3 + [True] * (count - 3)
            assert got["status"][2].startswith("crowded")
            assert all("-5 sigma_s" in text for text in got["status"][:2])
            for column in set(NUMBERS) & set(got) - {"iterations"}:
                assert np.isnan(got[column][:2]).all(), column
                assert np.isfinite(got[column][2:]).all(), column
            assert set(got["iterations"][:2]) == {0}
        with refuses(Mistake.RANGE, "d", value="-1 m"):
            tb.solve(contact, d=-1.0)


def test_a_study_of_a_separation_that_deep(tmp_path):
    from thirdbody.study import load_study

    file = tmp_path / "study.toml"
    file.write_text(
        '[surfaces]\nfirst = "S45C"\nsecond = "S45C"\n[roughness]\nsigma = "100 nm"\n'
        'R = "2.8 um"\n[load]\nseparation = ["-1 m", "50 nm"]\n'
    )
    with pytest.raises(tb.errors.InvalidValue) as refused:
        load_study(file)
    assert len(refused.value.problems) == 1
    assert "load.separation = -1 m" in refused.value.problems[0]


# ---------------------------------------------------------------------------- rounding
@pytest.mark.parametrize("shape", SIZES)
def test_no_area_is_below_zero(shape):
    """A regime that does not occur is rounding of the others."""
    contact = dusty("rough", shape, sigma=SIZE / 30)
    d = contact.roughness.sigma * np.linspace(-3, 40, 400)
    with mock.patch.dict(os.environ, THIRDBODY_ENGINE="numpy"):
        got = tb.solve(contact, d=d)
    for name in ("A_e", "A_ep", "A_p", "A_sa", "A_sa2", "shadow", "F_sa_star"):
        assert np.min(getattr(got, name)) >= 0, name
    np.testing.assert_allclose(got.A_e + got.A_ep + got.A_p, got.A_t, rtol=1e-14, atol=0)
