"""The compiled engine held to the NumPy engine: every column, on any contact that both can solve."""

import math
import os
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path
from unittest import mock

import numpy as np
import oracle
import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import Mistake, refuses
from twins import base, bodies, decades, interfaces, material, series_twin, sizes

import thirdbody as tb
from thirdbody.contact.asperity_sums import GaussianSums, gaussian_rule
from thirdbody.contact.interface import interface as bound_interface
from thirdbody.equilibrium import states
from thirdbody.equilibrium.columns import COLUMNS
from thirdbody.equilibrium.compiled import batch as engine
from thirdbody.equilibrium.engine import run as own
from thirdbody.equilibrium.load_scan import load_scan
from thirdbody.equilibrium.states import state_columns
from thirdbody.errors import NotCompiled
from thirdbody.laws.asperity import REGISTRY
from thirdbody.numerics.chebyshev import chebyshev_transform

pytest.importorskip("numba")
pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")

LOADS = np.geomspace(1e-14, 1.0, 43)
"""From what one asperity in a million carries to more than anything carries."""
EPS = np.finfo(float).eps
ADHESIVE = ("dmt", "jkr")
WORDS = ("mode", "status")
COUNTED = ("iterations", "residual")
"""How a state was found and not what it is."""


@pytest.fixture(autouse=True, scope="module")
def few_states_are_enough():
    """Both engines on samples that the NumPy engine can afford."""
    with mock.patch.object(engine, "FEWEST", 1), mock.patch.object(states, "FEWEST", 2):
        yield


@contextmanager
def numpy_engine():
    with mock.patch.dict(os.environ, THIRDBODY_ENGINE="numpy"):
        yield


def beyond(contact: tb.Contact) -> bool:
    """Whether no compiled way may suit: Weibull sizes off rough seats, whose area may outgrow them.

    Nodes that states share need a load that falls, and states by their own laws other sizes.
    """
    return (
        contact.particles is not None
        and isinstance(contact.particles.diameter, tb.distributions.Weibull)
        and contact.particle_law.seat != "rough"
    )


@contextmanager
def compiled_engine(scanned: int = 3, *, unless: bool = False):
    """Fails unless the compiled engine was asked; from ``scanned`` loads on it looks ahead."""
    solve = engine._Batch.solve
    with (
        mock.patch.dict(os.environ, THIRDBODY_ENGINE=""),
        mock.patch.object(engine, "SCANNED", scanned),
        mock.patch.object(engine._Batch, "solve", autospec=True, side_effect=solve) as asked,
        mock.patch.object(own, "solve", side_effect=own.solve) as asked_own,
    ):
        yield asked_own
    assert asked.called or asked_own.called or unless


def columns(result) -> dict[str, np.ndarray]:
    return result if isinstance(result, dict) else result.columns()


def reason(status) -> list[str]:
    """Which kind of sentence: the numbers in it belong to one engine."""
    kinds = ("ok", "is beyond", "is below", "jump", "crowded")
    return [next(kind for kind in kinds if kind in str(sentence)) for sentence in status]


def hold(got, want, sigma, at, promise=1e-13) -> None:
    """Every column to 1e-12 relative, or what is promised of the total, or what 4 ulp of d change.

    Twice that below F* = 1e-11, where only the largest particles touch: there the last nodes over
    sizes leave 1.3e-12 of what these carry.
    ``at`` gives the columns at separations; near the last particle's first touch the load rises
    so steeply that an ulp of d is more than 1e-12 of it.
    """
    got, want = columns(got), columns(want)
    assert reason(got["status"]) == reason(want["status"])
    solved = np.isfinite(want["d"])
    d = want["d"][solved]
    sigma = np.broadcast_to(sigma, solved.shape)[solved]
    step = 4 * EPS * (np.abs(d) + sigma)
    above, below = columns(at(d + step, solved)), columns(at(d - step, solved))
    totals = {"A": want["A_t"], "F": want["F_star"]}
    wrong = []
    for name in COLUMNS:
        if name in COUNTED + WORDS:
            continue
        assert np.array_equal(np.isfinite(got[name]), np.isfinite(want[name])), name
        x, y = got[name][solved], want[name][solved]
        spread = np.abs(above[name] - below[name])
        if name in ("F_star", "pressure"):
            np.testing.assert_allclose(x, y, rtol=max(1e-12, promise), err_msg=name)
            continue
        floor = sigma if name in ("d", "h") else totals.get(name[0], np.ones_like(solved))[solved]
        bound = np.where(want["F_star"][solved] < 1e-11, 2e-12, 1e-12)
        over = np.abs(x - y) - bound * np.abs(y) - promise * floor - spread
        if np.any(over > 0):
            i = int(np.argmax(over / np.maximum(np.abs(y), 1e-300)))
            wrong.append(f"{name} at F* = {want['F_star'][solved][i]:.3g}: {x[i]!r}, not {y[i]!r}")
    assert not wrong, "\n".join(wrong)
    edge = np.abs(want["particle_area_share"][:, None] - [0.98, 0.05]).min(axis=1) < 1e-9
    same = np.asarray(got["mode"]) == np.asarray(want["mode"])
    assert np.all(same | edge)
    # the balance holds as well as separations can say
    slack = np.abs(
        above["F_ss_star"] + above["F_sa_star"] - below["F_ss_star"] - below["F_sa_star"]
    )
    assert np.all(got["residual"][solved] <= 1e-12 + slack / want["F_star"][solved])


def hold_loads(contact: tb.Contact, loads=LOADS, scanned: int = 3) -> None:
    with compiled_engine(scanned):
        got = tb.solve(contact, F_star=loads)
    with numpy_engine():
        want = tb.solve(contact, F_star=loads)
        hold(got, want, contact.roughness.sigma, lambda d, _: tb.solve(contact, d=d))


def promise(asked_own) -> float:
    """Relative error of states by their own laws; by nodes that states share, of two tables."""
    return 1e-9 if asked_own.called else 2e-13


def hold_states(contact: tb.Contact, vary: dict, **load) -> None:
    with compiled_engine(unless=beyond(contact)) as asked_own:
        got = state_columns(contact, vary=vary, **load)
    with numpy_engine():
        want = state_columns(contact, vary=vary, **load)
        vary = dict(zip(vary, np.broadcast_arrays(*vary.values()), strict=True))

        def at(d, solved):
            return state_columns(contact, d=d, vary={k: v[solved] for k, v in vary.items()})

        hold(
            got, want, vary.get("roughness.sigma", contact.roughness.sigma), at, promise(asked_own)
        )


# ------------------------------------------------------------------------------ drawing
DISTRIBUTIONS = st.one_of(
    st.tuples(
        st.sampled_from(("monodisperse", "gaussian", "lognormal", "weibull", "uniform")),
        decades(0.02, 0.6),
        st.floats(1.0, 4.0),
    ).map(lambda given: sizes(given[0], 1.0, *given[1:])[0]),
    st.builds(
        lambda ratio, share: tb.distributions.Mixture(
            parts=(tb.LogNormal(median=1.0, gsd=1.3), tb.distributions.Monodisperse(mean=ratio)),
            weights=(1 - share, share),
        ),
        decades(0.3, 3.0),
        st.floats(0.1, 0.9),
    ),
)
HEIGHTS = st.sampled_from(
    [tb.heights.GaussianHeights()] * 4
    + [tb.heights.ExponentialHeights(), tb.heights.JohnsonHeights(skewness=-0.7, kurtosis=4.2)]
)


@st.composite
def contacts(draw, heights=st.just(tb.heights.GaussianHeights())) -> tb.Contact:
    """Three-body contacts with every seat, shadow, size distribution, spheres and flakes."""
    contact = base(draw(interfaces()))
    rough = contact.roughness.replace(heights=draw(heights))
    diameter = draw(DISTRIBUTIONS).scaled(rough.sigma * draw(decades(0.3, 12)))
    kind = draw(st.sampled_from((tb.particle.Series, tb.particle.Series, tb.particle.Flakes)))
    options = {"aspect": draw(decades(1.0, 10.0))} if kind is tb.particle.Flakes else {}
    options["seat"] = draw(st.sampled_from(("plane", "offset", "rough")))
    if options["seat"] == "offset":
        options["h_0"] = rough.sigma * draw(st.floats(0.1, 4.0))
    if options["seat"] == "rough":
        options["zeta_mean"] = draw(st.floats(-1.0, 1.0))
        options["zeta_std"] = draw(st.floats(0.3, 1.5))
    cover = draw(decades(1e-6, 0.1)) / options.get("aspect", 1.0)
    return contact.replace(
        roughness=rough,
        particles=tb.Particles(
            material=material(draw(bodies)),
            diameter=diameter,
            areal_density=cover / (math.pi / 4 * diameter.moment(2)),
        ),
        particle_law=kind(
            law=draw(st.sampled_from((tb.asperity.Hermite(), tb.asperity.ZMC()))),
            shadow=draw(st.sampled_from(("footprint", "projected", "covered", "none"))),
            **options,
        ),
    )


def ratios(seed: int, count: int, most: float = 1.6) -> np.ndarray:
    return most ** np.random.default_rng(seed).uniform(-1, 1, count)


def variations(contact: tb.Contact, seed: int, count: int) -> dict[str, np.ndarray]:
    """Inputs of states around a contact."""
    rough = contact.roughness
    out = {
        "roughness.sigma": rough.sigma * ratios(seed, count),
        "roughness.R": rough.R * ratios(seed + 1, count),
        "roughness.alpha": 1.55 + (rough.alpha - 1.55) * ratios(seed + 2, count),
        "roughness.eta_R_sigma": 0.0455 * ratios(seed + 3, count),
    }
    if contact.particles is not None:
        density = contact.particles.areal_density / 2.6
        out["particles.areal_density"] = density * ratios(seed + 4, count)
    return out


def default(seat: str = "rough", **options) -> tb.Contact:
    law = oracle.Interface(oracle.STEEL, oracle.STEEL)
    twin = series_twin(
        law, oracle.SILICA, sizes("gaussian", 3e-7, 0.08), 1e11, 0.0, seat=seat, **options
    )
    return twin.contact


SEEDS = st.integers(0, 2**20)


# ------------------------------------------------------------------- the same as NumPy's
@given(contact=contacts(HEIGHTS), looks_ahead=st.booleans())
def test_many_loads(contact, looks_ahead):
    if not load_scan(bound_interface(contact)).monotone:
        assert tb.solve(contact, F_star=LOADS).engine == f"numpy: {engine.NOT_MONOTONE}"
        return
    hold_loads(contact, scanned=3 if looks_ahead else 10**9)


@given(interface=interfaces(), heights=HEIGHTS)
def test_many_loads_without_particles(interface, heights):
    contact = base(interface)
    hold_loads(contact.replace(roughness=contact.roughness.replace(heights=heights)))


def test_particles_touch_where_the_density_of_asperities_underflows():
    """Particles of 10 to 80 σ: exp(−h²/2) has no bits left above h = 37."""
    contact = default().replace(
        particles=tb.Particles(
            material=tb.materials["SiO2"],
            diameter=tb.LogNormal(median=1.2e-6, gsd=1.25),
            areal_density=1e11,
        )
    )
    hold_loads(contact)
    vary = {"roughness.sigma": 1e-7 * ratios(1, 8)}
    hold_states(contact, vary, F_star=np.geomspace(1e-14, 1e-6, 8))


def test_the_last_particles_on_the_highest_seats():
    """What is left of a load at seven widths of the seat comes from nine to twelve widths."""
    rough = tb.Roughness(sigma=1.1e-7, R=5e-7, alpha=2.0, eta_R_sigma=0.01)
    contact = default(zeta_std=0.6).replace(roughness=rough)
    hold_states(contact, {"roughness.R": 5e-7 * ratios(2, 8)}, F_star=np.geomspace(1e-14, 1e-9, 8))


@pytest.mark.parametrize("median", [0.3e-7, 1e-7, 3e-7])
def test_the_many_below_the_last_particles(median):
    """Broad sizes: the largest touch first, and nearly all of the load is on smaller ones."""
    particles = tb.Particles(
        material=tb.materials["SiO2"],
        diameter=tb.LogNormal(median=median, gsd=1.3),
        areal_density=0.05 / median**2,
    )
    rough = tb.Roughness(sigma=1.1e-7, R=5e-7, alpha=2.0, eta_R_sigma=0.01)
    contact = default(zeta_std=1.4).replace(roughness=rough, particles=particles)
    hold_states(contact, {"roughness.R": 5e-7 * ratios(2, 8)}, F_star=np.geomspace(1e-14, 1e-9, 8))


SLOW_TABLES = tb.heights.WeibullHeights(shape=1.8)
OTHER_HEIGHTS = {
    "gaussian": tb.heights.GaussianHeights(),
    "exponential": tb.heights.ExponentialHeights(),
    "johnson": tb.heights.JohnsonHeights(skewness=-0.7, kurtosis=4.2),
}
EXTRA = {
    "coated": {"E_1": 2e11, "nu_1": 0.3, "t": 2e-8, "E_2": 4e10, "nu_2": 0.25},
    "elliptic-ceb": {"ratio": 4.0},
    "elliptic-zmc": {"ratio": 4.0},
    "jg": {"hardness_ratio": 2.86},
}
TIPS = [name for name, kind in REGISTRY.items() if not kind.of_surface]
MONOTONE = [name for name in TIPS if name not in ADHESIVE]


@pytest.mark.parametrize("heights", OTHER_HEIGHTS)
@pytest.mark.parametrize("name", MONOTONE)
def test_every_law(name, heights):
    contact = default().replace(asperity_law=REGISTRY[name](**EXTRA.get(name, {})))
    rough = contact.roughness.replace(heights=OTHER_HEIGHTS[heights])
    hold_loads(contact.replace(roughness=rough))
    hold_loads(contact.replace(roughness=rough, particles=None))


@pytest.mark.parametrize("name", ["gw", "zmc"])
def test_weibull_heights(name):
    contact = default().replace(asperity_law=REGISTRY[name]())
    hold_loads(contact.replace(roughness=contact.roughness.replace(heights=SLOW_TABLES)))


@given(contact=contacts(), seed=SEEDS, scaled=st.booleans())
def test_states_with_inputs_of_their_own(contact, seed, scaled):
    count = 5
    vary = variations(contact, seed, count)
    diameter = contact.particles.diameter
    if scaled and isinstance(diameter, tb.TruncatedGaussian | tb.distributions.Monodisperse):
        size = ratios(seed + 5, count, 1.2)
        vary["particles.diameter.mean"] = diameter.mean * size
        if isinstance(diameter, tb.TruncatedGaussian):
            vary["particles.diameter.std"] = diameter.std * size
    loads = 10.0 ** np.random.default_rng(seed).uniform(-14, 0, count)
    hold_states(contact, vary, F_star=loads)


@given(interface=interfaces(), seed=SEEDS, name=st.sampled_from(MONOTONE))
def test_states_without_particles(interface, seed, name):
    contact = base(interface)
    if name not in ("zmc", "hermite"):
        contact = contact.replace(asperity_law=REGISTRY[name](**EXTRA.get(name, {})))
    vary = variations(contact, seed, 6)
    if name in ("coated", "jg"):  # these know the radius or the yield strain
        del vary["roughness.R"]
    hold_states(contact, vary, F_star=10.0 ** np.random.default_rng(seed).uniform(-14, 0, 6))


def materials_of_their_own(count: int) -> dict[str, np.ndarray]:
    return {
        "surfaces.first.E": 2.05e11 * ratios(6, count, 1.2),
        "surfaces.second.H": 5e9 * ratios(7, count, 1.5),
        "particles.material.H": 7.7e9 * ratios(8, count, 1.8),
        "particles.diameter.mean": 3e-7 * ratios(9, count, 1.2),
        "roughness.sigma": 1e-7 * ratios(10, count),
    }


@pytest.mark.spread(2)
@pytest.mark.parametrize("seat", ["plane", "rough"])
def test_states_with_materials_and_shapes_of_their_own(seat):
    """Nodes over the squeeze on a rough seat; on a plane nodes over the sizes."""
    loads = 10.0 ** np.random.default_rng(3).uniform(-9, -3, 4)
    hold_states(default(seat), materials_of_their_own(4), F_star=loads)


@given(contact=contacts(), seed=SEEDS)
def test_states_at_given_separations(contact, seed):
    vary = variations(contact, seed, 5)
    d = vary["roughness.sigma"] * np.random.default_rng(seed).uniform(-3.5, 12, 5)
    with compiled_engine(unless=beyond(contact)) as asked_own:
        got = state_columns(contact, d=d, vary=vary)
    with numpy_engine():
        want = state_columns(contact, d=d, vary=vary)
        sigma = vary["roughness.sigma"]
        # what carries nothing has no shares
        touching = want["F_star"] > 1e-25
        got, want = ({k: v[touching] for k, v in x.items()} for x in (got, want))
        vary = {k: v[touching] for k, v in vary.items()}

        def at(d, _):
            return state_columns(contact, d=d, vary=vary)

        hold(got, want, sigma[touching], at, promise(asked_own))


def test_pressure_means_force():
    contact, vary = default(), {"roughness.sigma": 1e-7 * ratios(0, 30)}
    loads = np.geomspace(1e-9, 1e-4, 30)
    one = state_columns(contact, F_star=loads, vary=vary)
    two = state_columns(contact, pressure=loads * contact.E_ss, vary=vary)
    np.testing.assert_allclose(one["d"], two["d"], rtol=1e-14)


# -------------------------------------------------------------- threads, order, company
def sample(count: int) -> tuple[dict[str, np.ndarray], np.ndarray]:
    contact = default()
    vary = variations(contact, 11, count)
    vary["particles.diameter.mean"] = 3e-7 * ratios(12, count, 1.2)
    vary["particles.diameter.std"] = 0.08 * vary["particles.diameter.mean"]
    return vary, 10.0 ** np.random.default_rng(4).uniform(-10, -3, count)


def same(one: dict, two: dict) -> None:
    for name in COLUMNS:
        assert np.array_equal(one[name], two[name], equal_nan=name not in WORDS), name


@pytest.mark.parametrize("seat", ["plane", "rough"])
def test_threads_change_no_bit(seat, monkeypatch):
    vary, loads = sample(10_000)
    results = []
    for count in ("1", "3"):
        monkeypatch.setenv("THIRDBODY_THREADS", count)
        assert engine.threads() == int(count)
        with compiled_engine():
            results.append(state_columns(default(seat), F_star=loads, vary=vary))
        with compiled_engine():
            results.append(columns(tb.solve(default(seat), F_star=loads)))
    same(results[0], results[2])
    same(results[1], results[3])


@pytest.mark.parametrize("seat", ["plane", "rough"])
def test_order_and_company_change_no_bit(seat):
    vary, loads = sample(5_000)
    whole = state_columns(default(seat), F_star=loads, vary=vary)
    order = np.random.default_rng(5).permutation(len(loads))
    other = state_columns(
        default(seat), F_star=loads[order], vary={k: v[order] for k, v in vary.items()}
    )
    same({k: v[order] for k, v in whole.items()}, other)
    with mock.patch.object(states, "AT_ONCE", 777), mock.patch.object(engine, "AT_ONCE", 100):
        same(whole, state_columns(default(seat), F_star=loads, vary=vary))
    alone = slice(17, 40)
    few = state_columns(
        default(seat), F_star=loads[alone], vary={k: v[alone] for k, v in vary.items()}
    )
    same({k: v[alone] for k, v in whole.items()}, few)


@pytest.mark.parametrize(
    ("name", "own", "most"),
    [
        ("roughness.sigma", 1e-8, 1.5),
        ("particles.diameter.mean", 3e-7, 1.5),
        ("roughness.sigma", 1e-7, 3.2),  # near a wide seat all nodes are few
    ],
)
def test_few_nodes_come_close(name, own, most):
    """After them one evaluation by all nodes mostly ends at the root."""
    loads = 10.0 ** np.random.default_rng(6).uniform(-10, -3, 500)
    with compiled_engine():
        got = state_columns(default("rough"), F_star=loads, vary={name: own * ratios(3, 500)})
    assert np.mean(got["iterations"]) < most
    assert np.max(got["residual"]) < 1e-11


@pytest.mark.parametrize("seed", range(3))
def test_series_across_a_family(seed):
    """Half an octave of ω_1/σ_s in one series against the quadrature at each: 1e-13."""
    rng = np.random.default_rng(seed)
    law = [tb.asperity.ZMC(), tb.asperity.KE(), tb.asperity.CEB()][seed]
    law = law.bound(R=2.8e-6, E_star=110e9, H=5e9, nu=0.3)
    step = int(rng.integers(-14, 4))
    family, rule = GaussianSums(law, step), gaussian_rule(law, step // 2)
    for w, h in zip(2.0 ** (0.5 * (step + rng.random(20))), rng.uniform(-4.5, 30, 20), strict=True):
        _, place = GaussianSums.place(np.array([w]))
        every = family.table(np.array([h])).reshape(GaussianSums.TERMS, -1)
        got = np.polynomial.chebyshev.chebval(place[0], chebyshev_transform(len(every))[1] @ every)
        wanted = rule.sums(w, np.array([h]))[0]
        scale = np.array([wanted[0], *[wanted[1:4].sum()] * 3, *wanted[4:]])
        assert np.all(np.abs(got - wanted) < 2e-13 * scale)


def test_company_of_states_with_materials_of_their_own():
    """Their nodes follow what the company needs: equal to rounding, and for any threads."""
    vary, loads = materials_of_their_own(1_500), np.geomspace(1e-9, 1e-4, 1_500)
    whole = state_columns(default(), F_star=loads, vary=vary)
    with mock.patch.dict(os.environ, THIRDBODY_THREADS="3"):
        same(whole, state_columns(default(), F_star=loads, vary=vary))
    some = slice(None, None, 50)
    few = state_columns(default(), F_star=loads[some], vary={k: v[some] for k, v in vary.items()})
    for name in ("d", "A_t", "A_sa", "F_sa_star", "shadow"):
        np.testing.assert_allclose(few[name], whole[name][some], rtol=2e-12, err_msg=name)


# ---------------------------------------------------------------------- which one runs
def test_switched_off_or_not_installed():
    contact = default()
    vary = {"roughness.sigma": 1e-7 * ratios(1, 4)}
    with compiled_engine():
        fast = tb.solve(contact, F_star=LOADS)
        many = state_columns(contact, F_star=1e-6, vary=vary)
    for absent in (
        mock.patch.dict(os.environ, THIRDBODY_ENGINE="numpy"),
        mock.patch("importlib.util.find_spec", return_value=None),
    ):
        with absent, mock.patch.object(engine._Batch, "solve", side_effect=AssertionError):
            assert not engine.available()
            slow = tb.solve(contact, F_star=LOADS)
            np.testing.assert_allclose(slow.d, fast.d, rtol=1e-13, atol=1e-21)
            assert np.array_equal(slow.mode, fast.mode)
            states_ = state_columns(contact, F_star=1e-6, vary=vary)
            np.testing.assert_allclose(states_["A_t"], many["A_t"], rtol=1e-12)
    assert engine.available()


def mixed_tips() -> tb.Contact:
    contact = default()
    rough = contact.roughness.replace(ellipticity=tb.surfaces.Ellipticity(ratios=(1.0, 3.0)))
    return contact.replace(asperity_law=tb.asperity.EllipticZMC(), roughness=rough)


OTHERS = {
    "jkr": lambda: default().replace(asperity_law=tb.asperity.JKR(w=0.05)),
    "jkr apart": lambda: default().replace(asperity_law=tb.asperity.JKR(w=0.05, unloading=True)),
    "dmt": lambda: default().replace(asperity_law=tb.asperity.DMT(w=0.05)),
    "ellipticity": mixed_tips,
}


@pytest.mark.parametrize("kind", OTHERS)
def test_tables_that_only_numpy_knows_go_there_silently(kind, recwarn):
    """Many loads of one contact; states of their own are solved by their own laws."""
    contact = OTHERS[kind]()
    with pytest.raises(NotCompiled):
        engine.batch(bound_interface(contact))
    loads = np.geomspace(1e-9, 1e-5, 5)
    vary = {"roughness.sigma": 1e-7 * np.array([1.0, 1.1, 0.9, 1.0, 1.2])}
    got = tb.solve(contact, F_star=loads), state_columns(contact, F_star=loads, vary=vary)
    with numpy_engine():
        same(columns(got[0]), columns(tb.solve(contact, F_star=loads)))
        want = state_columns(contact, F_star=loads, vary=vary)
    assert "compiled" in set(got[1]["engine"])
    for name in ("d", "A_t", "F_ss_star", "F_sa_star"):
        np.testing.assert_allclose(got[1][name], want[name], rtol=1e-9, err_msg=name)
    assert not [w for w in recwarn if not issubclass(w.category, tb.errors.RangeWarning)]


def test_few_loads_need_no_compiled_engine():
    with (
        mock.patch.object(engine, "FEWEST", 5_000),
        mock.patch.object(engine._Batch, "solve", side_effect=AssertionError),
    ):
        tb.solve(default(), F_star=np.geomspace(1e-9, 1e-5, 4_999))


# ------------------------------------------------------------------------ exponentials
def test_exponential():
    from thirdbody.equilibrium.compiled import machine

    x = np.concatenate(
        [
            np.linspace(-700, 700, 100_001)[1:-1],
            np.geomspace(1e-300, 1, 999),
            np.arange(-699.0, 700),
        ]
    )
    x = np.concatenate([x, 0.5 * math.log(2) * np.arange(-2001, 2002)])  # ends of the polynomial
    got = np.array([machine.exp(value) for value in x])
    assert np.max(np.abs(got / np.exp(x) - 1)) <= 4e-16
    assert machine.exp(0.0) == 1.0


def test_exponential_against_thirty_digits():
    import mpmath

    from thirdbody.equilibrium.compiled import machine

    with mpmath.workdps(30):
        for x in np.random.default_rng(6).uniform(-700, 700, 2_000):
            assert abs(mpmath.mpf(float(machine.exp(x))) / mpmath.exp(mpmath.mpf(x)) - 1) < 4e-16


def test_gaussian_tail_against_thirty_digits():
    import mpmath

    from thirdbody.equilibrium.compiled import machine

    with mpmath.workdps(30):
        for z in [*np.random.default_rng(7).uniform(-14, 14, 2_000), 0.0, -1e-9, 1e-9, 40.0]:
            got = float(machine.normal_cdf(z, math.exp(-0.5 * z * z)))
            # the density given has rounding of its own, z² ulps of it
            most = 2e-15 * (1 + 0.1 * z * z)
            assert (
                abs(mpmath.mpf(got) / (mpmath.erfc(-mpmath.mpf(z) / mpmath.sqrt(2)) / 2) - 1) < most
            )


# ------------------------------------------------------------------------ materials that vary alike
def test_states_whose_materials_vary_alike():
    """Each of them as it is alone, by tables."""
    rng = np.random.default_rng(8)
    count = 600
    hardness = 5e9 * 1.25 ** rng.uniform(-1, 1, count)
    vary = {
        "surfaces.first.H": hardness,
        "surfaces.second.H": hardness,
        "roughness.sigma": 1e-7 * 1.2 ** rng.uniform(-1, 1, count),
        "particles.diameter.mean": 3e-7 * 1.3 ** rng.uniform(-1, 1, count),
    }
    pressure = np.geomspace(1e3, 1e8, count)
    together = state_columns(default(), pressure=pressure, vary=vary)
    assert set(together["status"]) == {"ok"}
    assert set(together["engine"]) == {"compiled"}
    for i in (0, 100, 300, 599):
        one = states.vary_contact(default(), {name: values[i] for name, values in vary.items()})
        alone = tb.solve(one, pressure=pressure[i])
        for name in ("A_t", "F_sa_star", "A_sa2", "d"):
            assert getattr(alone, name) == pytest.approx(together[name][i], rel=1e-10), name


# ---------------------------------------------------------------------------- mistakes
def with_one(name: str, value: float, count: int = 30) -> dict[str, np.ndarray]:
    """Good values with one bad among them."""
    good: float = {
        "roughness.sigma": 1e-7,
        "roughness.R": 2.8e-6,
        "roughness.alpha": 5.0,
        "particles.areal_density": 1e11,
        "particles.diameter.mean": 3e-7,
        "particles.diameter.std": 2.4e-8,
        "surfaces.first.E": 2.05e11,
    }[name]
    values = good * ratios(0, count, 1.05)
    values[count // 2] = value
    return {name: values}


@pytest.mark.parametrize("wrong", [math.nan, -1.0, math.inf])
@pytest.mark.parametrize(
    "name",
    ["roughness.sigma", "roughness.R", "roughness.alpha", "particles.areal_density",
     "particles.diameter.mean", "particles.diameter.std", "surfaces.first.E"],
)  # fmt: skip
def test_a_bad_value_says_what_replace_says(name, wrong):
    contact = default()
    with pytest.raises(tb.errors.InvalidValue) as one:
        contact.replace(**{name: wrong})
    with pytest.raises(tb.errors.InvalidValue) as many:
        state_columns(contact, F_star=1e-6, vary=with_one(name, wrong))
    assert str(many.value) == str(one.value)


@pytest.mark.parametrize("name", ["roughness.sgima", "particles.size", "x"])
def test_a_wrong_name_is_named_whole_whatever_the_engine(name):
    contact, values = default(), 1e-7 * ratios(0, 30)
    with pytest.raises(tb.errors.InvalidValue):
        contact.replace(**{name: float(values[0])})
    for count in (1, len(values)):
        with pytest.raises(tb.errors.InvalidValue) as told:
            state_columns(contact, F_star=1e-6, vary={name: values[:count]})
        assert [each.place for each in told.value.problems] == [f"vary[{name!r}]"]


def test_a_part_is_not_a_number():
    with refuses(Mistake.KIND, "Contact.roughness", value="6.266109538505207e-08"):
        state_columns(default(), F_star=1e-6, vary={"roughness": 1e-7 * ratios(0, 30)})


def test_jammed_particles():
    contact = default()
    vary = with_one("particles.areal_density", 1e14)
    with pytest.raises(tb.errors.InvalidValue, match="cover") as one:
        contact.replace(**{"particles.areal_density": 1e14})
    with pytest.raises(tb.errors.InvalidValue) as many:
        state_columns(contact, F_star=1e-6, vary=vary)
    assert str(many.value) == str(one.value)


def test_lengths_and_shapes():
    with refuses(Mistake.SHAPE, "", says="F_star (3,), roughness.sigma (4,)"):
        state_columns(default(), F_star=np.ones(3), vary={"roughness.sigma": 1e-7 * np.ones(4)})
    with refuses(Mistake.SHAPE, "", says="2 dimensions"):
        state_columns(default(), F_star=1e-6, vary={"roughness.sigma": 1e-7 * np.ones((2, 2))})


@pytest.mark.check
@pytest.mark.parametrize(
    ("sizes", "name"),
    [
        (tb.LogNormal(median=150e-9, gsd=1.5), "median"),
        (tb.distributions.Weibull(scale=300e-9, shape=4.0), "scale"),
    ],
)
@pytest.mark.parametrize("material", [False, True])
def test_one_length_alone_changes_no_shape(sizes, name, material):
    from thirdbody.equilibrium.compiled import batch as engine

    steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    case = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(material=silica, areal_density=1e10, diameter=sizes),
        particle_law=tb.particle.Series(deep="off"),
    )
    vary = {f"particles.diameter.{name}": getattr(sizes, name) * np.linspace(0.7, 1.4, 30)}
    assert not engine.own_sizes(case, vary)
    if material:
        vary["particles.material.E"] = np.linspace(6e10, 8e10, 30)
    states = state_columns(case, F_star=1e-5, vary=vary)
    for i in (0, 13, 29):
        alone = tb.solve(case.replace(**{k: v[i] for k, v in vary.items()}), F_star=1e-5)
        assert states["d"][i] == pytest.approx(alone.d, rel=1e-11)
        assert states["F_sa_star"][i] == pytest.approx(alone.F_sa_star, rel=1e-9)


# ---------------------------------------------------------------------------- threads of BLAS
BITS = """
import hashlib, sys
import numpy as np
import thirdbody as tb
from thirdbody.equilibrium.states import state_columns
from thirdbody.study import load_study

out = hashlib.sha256()
study = load_study(sys.argv[1])
contact = study.contact
bare = contact.replace(outputs=())
for one, at in ((bare, {"d": np.linspace(-1e-7, 5e-7, 60_000)}),
                (contact, {"pressure": np.geomspace(1e3, 1e8, 100)})):
    result = tb.solve(one, **at).columns()
    for name in sorted(result):
        if result[name].dtype.kind == "f":
            out.update(result[name].tobytes())
H = np.linspace(4e9, 6e9, 600)
vary = {"surfaces.first.H": H, "surfaces.second.H": H}
states = state_columns(bare, pressure=5e6, vary=vary)
out.update(states["d"].tobytes())
print(out.hexdigest())
"""


@pytest.mark.slow
def test_threads_of_linear_algebra_change_no_bit():
    """A product of matrices shared by threads has other last digits than one that is not."""
    study = Path(__file__).parents[2] / "examples" / "bearing_wear_debris.toml"
    found = set()
    for count in ("1", "2"):
        names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
        run = subprocess.run(
            [sys.executable, "-W", "ignore", "-c", BITS, str(study)],
            env=os.environ | dict.fromkeys(names, count),
            capture_output=True,
            text=True,
            check=True,
        )
        found.add(run.stdout)
    assert len(found) == 1
