"""The balance F_t(d) = F: residual, extremes, branches, agreement with a plain root finder."""

import math
import warnings

import numpy as np
import oracle
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from twins import (
    Twin,
    base,
    decades,
    horng_twins,
    interfaces,
    material,
    series_twin,
    series_twins,
    sizes,
)

import thirdbody as tb
from thirdbody.equilibrium.status import Status

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
DECADES = np.logspace(-14, -2, 49)


def window_contact(x_a: float = 3e-7, sigma: float = 1e-7) -> tuple[tb.Contact, oracle.Horng]:
    """The window reading, whose load is not monotone in d, and its twin."""
    interface = oracle.Interface(rough=oracle.Rough(sigma, 2.8e-6))
    diameter, twin_sizes = sizes("gaussian", x_a, 0.08, normalise=False)
    particles = tb.Particles(
        material=material(oracle.SILICA), diameter=diameter, areal_density=1e11
    )
    contact = base(interface, particles, tb.particle.Horng2022(preset="window"))
    law = oracle.Horng(
        oracle.SILICA, twin_sizes, 1e11, x_a, 3.25 * sigma, plastic=False, chi=1 / 16, datum=1.0
    )
    return contact, law


@given(twin=st.one_of(series_twins(), horng_twins()), F=decades(1e-10, 1e-3))
def test_solution_carries_the_load(twin, F):
    """Solve, then evaluate at the separation found; the residual reported is not too small."""
    try:
        state = tb.solve(twin.contact, F_star=F)
    except tb.errors.NoEquilibrium:
        lowest = min(
            tb.solve(twin.contact, d=twin.interface.rough.sigma * np.array([-3.0, -2.0])).F_star
        )
        assert lowest < F
        return
    again = tb.solve(twin.contact, d=state.d)
    assert again.F_star == pytest.approx(F, rel=1e-9)
    assert state.F_star == pytest.approx(F, rel=1e-9)
    assert abs(state.residual) < 1e-9
    assert state.status == "ok"
    assert state.A_t == pytest.approx(again.A_t, rel=1e-8)
    assert state.pressure == pytest.approx(F * twin.interface.E_ss, rel=1e-9)


@given(twin=series_twins(), F=decades(1e-8, 1e-3))
def test_load_and_separation_are_inverse(twin, F):
    d = twin.d + 0.3 * twin.interface.rough.sigma
    given_d = tb.solve(twin.contact, d=d)
    if given_d.F_star < 1e-14 or given_d.shadow > 0.5:
        return
    back = tb.solve(twin.contact, F_star=given_d.F_star)
    if twin.law.shadow == "projected":
        # a particle shades before it carries, so the load may fall first: loading meets a larger d
        assert back.d >= d - 1e-9 * twin.interface.rough.sigma
        return
    assert back.d == pytest.approx(d, abs=1e-9 * twin.interface.rough.sigma)


@pytest.mark.spread(2)
@pytest.mark.parametrize("seat", ["plane", "offset", "rough"])
@pytest.mark.parametrize(("kind", "loads"), [("gaussian", (1e-7, 1e-4)), ("lognormal", (1e-4,))])
def test_against_a_plain_root_finder(seat, kind, loads):
    twin = series_twin(
        oracle.Interface(oracle.STEEL, oracle.STEEL),
        oracle.SILICA,
        sizes(kind, 3e-7, 0.15),
        1e11,
        0.0,
        seat=seat,
        h_0=0.7e-7,
    )
    for F in loads:
        d = oracle.separation(lambda d: twin.expected(d)["F_star"], F, 0.0, 9e-7)
        assert tb.solve(twin.contact, F_star=F).d == pytest.approx(d, abs=1e-17)


def test_two_body_against_a_plain_root_finder_over_twelve_decades():
    twin = Twin(base(oracle.Interface()), oracle.Interface(), None, 0.0)
    loads = DECADES[::4]
    found = tb.solve(twin.contact, F_star=loads)
    for F, d in zip(loads, found.d, strict=True):
        want = oracle.separation(lambda d: twin.expected(d)["F_star"], F, -4e-7, 9e-7)
        assert d == pytest.approx(want, abs=1e-17)


@given(twin=st.one_of(series_twins(), interfaces().map(lambda i: Twin(base(i), i, None, 0.0))))
def test_twelve_decades_of_load(twin):
    """No overflow, no NaN without a reason, separation falls with load, area grows."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        states = tb.solve(twin.contact, F_star=DECADES)
    solved = np.isfinite(states.d)
    for i in np.flatnonzero(~solved):
        assert states.status[i] != "ok"
    many = states.A_t[solved] > 0.5
    assert np.array_equal(np.asarray(states.status)[solved] == "ok", ~many)
    assert np.array_equal(states.status_code[solved], np.where(many, Status.CROWDED, Status.OK))
    # what cannot be solved lies at the heavy end
    assert np.all(np.diff(solved.astype(int)) <= 0)
    assert solved[:20].all()
    assert np.all(np.diff(states.d[solved]) < 0)
    np.testing.assert_allclose(states.F_star[solved], DECADES[solved], rtol=1e-9)
    light = solved & (states.shadow < 0.5)
    assert np.all(np.diff(states.A_t[light]) > 0)
    for name in ("A_t", "A_ss", "A_sa", "A_e", "A_ep", "A_p", "F_ss_star", "F_sa_star"):
        values = getattr(states, name)[solved]
        assert np.all(np.isfinite(values) & (values >= 0)), name


@given(twin=series_twins(), F=decades(1e-9, 1e-4))
def test_pressure_is_force_times_modulus(twin, F):
    one = tb.solve(twin.contact, F_star=F)
    two = tb.solve(twin.contact, pressure=F * twin.interface.E_ss)
    assert two.d == pytest.approx(one.d, abs=1e-9 * twin.interface.rough.sigma)


@given(twin=series_twins(), F=decades(1e-9, 1e-4))
def test_arrays_of_loads_equal_scalars(twin, F):
    loads = F * np.array([3.0, 1.0, 0.2, 1.0])
    states = tb.solve(twin.contact, F_star=loads)
    sigma = twin.interface.rough.sigma
    for i, load in enumerate(loads):
        assert states.d[i] == pytest.approx(tb.solve(twin.contact, F_star=load).d, abs=1e-9 * sigma)
    assert states.d[1] == pytest.approx(states.d[3], rel=1e-12)


def test_stiffness_of_the_interface():
    """dp/dd found from two loads equals the central difference of the load over d."""
    twin = series_twin(
        oracle.Interface(), oracle.SILICA, sizes("gaussian", 3e-7, 0.2), 1e11, 0.0, seat="rough"
    )
    for F in (1e-8, 1e-6, 1e-4):
        d = tb.solve(twin.contact, F_star=F * np.array([1 - 1e-5, 1 + 1e-5])).d
        step = 1e-5 * 1e-7
        center = tb.solve(twin.contact, F_star=F).d
        loads = tb.solve(twin.contact, d=center + step * np.array([-1, 1])).F_star
        exact = (
            twin.expected(center + step)["F_star"] - twin.expected(center - step)["F_star"]
        ) / (2 * step)
        assert (loads[1] - loads[0]) / (2 * step) == pytest.approx(exact, rel=1e-6)
        assert 2e-5 * F / (d[1] - d[0]) == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize("seat", ["plane", "rough"])
def test_few_evaluations(seat):
    """Exact derivatives find a root in a handful of evaluations; wrong ones fall back to halving."""
    twin = series_twin(
        oracle.Interface(), oracle.SILICA, sizes("gaussian", 1e-6, 0.2), 1e11, 0.0, seat=seat
    )
    iterations = tb.solve(twin.contact, F_star=np.logspace(-10, -2, 200)).iterations
    assert np.mean(iterations) < 4.5
    assert np.max(iterations) < 20


# ------------------------------------------------------------------------- several roots
def crossings(load, F: float, d: np.ndarray) -> list[float]:
    """Every separation at which a load passes F, by a dense scan and bisection."""
    values = np.array([load(x) for x in d]) - F
    out = []
    for i in np.flatnonzero(values[:-1] * values[1:] < 0):
        out.append(oracle.brentq(lambda x: load(x) - F, d[i], d[i + 1], xtol=1e-18, rtol=1e-14))
    return out


@pytest.mark.spread(4)
@pytest.mark.parametrize(
    ("x_a", "F"),
    [(3e-7, 3e-6), (3e-7, 2e-5), (1e-6, 1e-7), (1e-6, 1e-5), (1e-6, 9e-5), (1e-6, 3e-4)],
)
def test_all_roots_of_the_window_reading(x_a, F):
    contact, law = window_contact(x_a)
    interface = oracle.Interface()
    want = crossings(
        lambda d: oracle.horng_state(d, interface, law)["F_star"], F, np.linspace(0, 1.65e-6, 220)
    )
    found = tb.equilibria.roots(contact, F_star=F)
    separations = sorted(state.d for state, _ in found)
    assert separations == pytest.approx(want, abs=1e-15)
    loading = tb.solve(contact, F_star=F)
    assert loading.d == pytest.approx(max(want), abs=1e-15)
    unloading = tb.solve(contact, F_star=F, branch="unloading")
    for state, stable in found:
        step = 1e-12
        lower, upper = tb.solve(contact, d=state.d + np.array([-step, step])).F_star
        assert stable == (lower > upper)
        assert state.F_star == pytest.approx(F, rel=1e-8)
    if len(want) > 1:
        # the separation at which the load first falls to F when the surfaces part
        assert unloading.d == pytest.approx(min(want), abs=1e-15)
        assert {stable for _, stable in found} == {True, False}
    else:
        # found from two sides, each to the balance, 1e-13
        assert unloading.d == pytest.approx(loading.d, rel=1e-12)


def test_window_reading_has_loads_with_one_and_with_three_roots():
    """Otherwise the test above tests nothing."""
    contact, _ = window_contact(1e-6)
    counts = {len(tb.equilibria.roots(contact, F_star=F)) for F in np.geomspace(1e-7, 1e-3, 15)}
    assert 1 in counts
    assert max(counts) >= 3
    assert all(count % 2 for count in counts)


@given(twin=series_twins(), F=decades(1e-9, 1e-5))
def test_the_series_law_has_one_root(twin, F):
    assume(twin.law.shadow != "projected")
    found = tb.equilibria.roots(twin.contact, F_star=F)
    state = tb.solve(twin.contact, F_star=F)
    assert len(found) == 1
    assert found[0][1]
    assert found[0][0].d == pytest.approx(state.d, abs=1e-9 * twin.interface.rough.sigma)
    assert tb.solve(twin.contact, F_star=F, branch="unloading").d == pytest.approx(
        state.d, abs=1e-9 * twin.interface.rough.sigma
    )


@pytest.mark.parametrize("preset", ["published", "window", "all_terms", "window_E2", "literal"])
def test_loading_branch_of_every_preset(preset):
    """max{d: F_t(d) ≥ F}: beyond it the interface never carries the load again."""
    contact, _ = window_contact()
    contact = contact.replace(particle_law=tb.particle.Horng2022(preset=preset))
    loads = np.geomspace(1e-7, 1e-4, 13)
    states = tb.solve(contact, F_star=loads)
    assert np.all(np.diff(states.d) < 0)
    np.testing.assert_allclose(states.F_star, loads, rtol=1e-8)
    for d, F in zip(states.d, loads, strict=True):
        beyond = tb.solve(contact, d=d + np.linspace(1e-3, 12, 1500) * 1e-7).F_star
        assert np.all(beyond < F)


# ---------------------------------------------------------------------------- what fails
def test_too_heavy_a_load():
    contact = base(oracle.Interface())
    with pytest.raises(tb.errors.NoEquilibrium):
        tb.solve(contact, F_star=10.0)
    states = tb.solve(contact, F_star=np.array([1e-6, 10.0, 1e-5]))
    assert states.status[0] == states.status[2] == "ok"
    assert states.status[1] != "ok"
    assert math.isnan(states.d[1])
    assert math.isnan(states.A_t[1])
    assert np.isfinite(states.d[[0, 2]]).all()


@pytest.mark.parametrize(
    "load",
    [
        {},
        {"F_star": 1e-6, "d": 1e-7},
        {"F_star": 1e-6, "pressure": 1e6},
        {"F_star": -1e-6},
        {"F_star": 0.0},
        {"F_star": math.nan},
        {"pressure": math.inf},
        {"d": math.nan},
        {"F_star": [[1e-6]]},
        {"F_star": "1e-6"},
        {"F_star": 1e-6, "branch": "sideways"},
    ],
)
def test_bad_loads(load):
    with pytest.raises((tb.errors.InvalidValue, TypeError)):
        tb.solve(base(oracle.Interface()), **load)


def test_columns_hold_every_field():
    states = tb.solve(base(oracle.Interface()), F_star=np.array([1e-6, 1e-5]))
    columns = states.columns()
    for name in ("d", "h", "F_star", "A_t", "A_e", "mode", "status", "residual"):
        assert len(columns[name]) == 2
    one = tb.solve(base(oracle.Interface()), F_star=1e-6)
    assert isinstance(one.d, float)
    assert isinstance(one.mode, str)
    assert one.d == pytest.approx(columns["d"][0], rel=1e-12)
