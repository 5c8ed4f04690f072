"""Particles of broad sizes on a rough seat, summed over gaps by the compiled engine."""

import math

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.laws.asperity import CEB, JG, KE
from thirdbody.laws.particle import Series

pytest.importorskip("numba")

from thirdbody.equilibrium.engine import gaps
from thirdbody.equilibrium.engine.run import own_columns

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
STEEL, BRONZE = tb.materials["100Cr6"], tb.materials["CuSn8"]
LAWS = Series(), Series(shadow="none"), Series(law=KE()), Series(law=JG()), Series(law=CEB())
COLUMNS = "A_e", "A_ep", "A_p", "A_sa", "A_t"


def random_contact(rng, law=None):
    """A contact with sizes that spread over many widths of the seat."""
    x = math.exp(rng.uniform(math.log(5e-7), math.log(2e-5)))
    sizes = (
        tb.distributions.PowerLaw(
            edges=(x, 1.5 * x, 4 * x, 20 * x),
            counts=tuple(rng.uniform(0.1, 5, 3)),
            slopes=tuple(rng.uniform(0.5, 5, 3)),
        ),
        tb.distributions.Uniform(low=x, high=x * rng.uniform(1.5, 10)),
        tb.distributions.Histogram(
            edges=(x, 2 * x, 3 * x, 6 * x), counts=tuple(rng.uniform(0.1, 5, 3))
        ),
    )[rng.integers(3)]
    material = tb.materials[("100Cr6", "quartz", "S45C")[rng.integers(3)]]
    return tb.Contact(
        surfaces=tb.MaterialPair(STEEL, (STEEL, BRONZE)[rng.integers(2)]),
        roughness=tb.Roughness(sigma=x * rng.uniform(0.005, 0.1), R=5e-6, alpha=4.0),
        particles=tb.Particles(
            material=material, areal_density=rng.uniform(1e-6, 5e-3) / x**2, diameter=sizes
        ),
        particle_law=law or LAWS[rng.integers(len(LAWS))],
    )


@pytest.mark.parametrize("seed", range(12))
def test_a_state_agrees_with_the_numpy_engine_within_its_estimate(seed):
    rng = np.random.default_rng([38, seed])
    contact, loads = random_contact(rng), 10 ** rng.uniform(-9, -3, 3)
    got = own_columns(contact, {}, "F_star", loads)
    solved = [i for i in range(3) if got["doubt"][i] == "" and np.isfinite(got["d"][i])]
    for i in solved:
        state = tb.solve(contact, d=float(got["d"][i]))
        allowed = got["error"][i] + 2e-11
        assert float(state.F_star) == pytest.approx(loads[i], rel=allowed)
        for name in COLUMNS:
            off = abs(got[name][i] - float(getattr(state, name)))
            assert off < 2 * allowed * float(state.A_t), name
    assert solved


def test_the_same_bits_alone_and_among_others():
    """Cells that another load has filled, and their order, change no bit."""
    contact = random_contact(np.random.default_rng(1), Series())
    loads = np.geomspace(1e-9, 1e-3, 9)
    together = own_columns(contact, {}, "F_star", loads)
    turned = own_columns(contact, {}, "F_star", loads[::-1].copy())
    for i, load in enumerate(loads):
        alone = own_columns(contact, {}, "F_star", np.array([load]))
        for name in ("d", *COLUMNS):
            assert alone[name][0] == together[name][i] == turned[name][8 - i], name


def test_cells_are_forgotten_where_the_room_ends():
    """A thousand loads of a contact need more cells than there is room for."""
    contact = random_contact(np.random.default_rng(5), Series())
    loads = np.geomspace(1e-10, 1e-3, 1000)
    got = own_columns(contact, {}, "F_star", loads)
    for i in (0, 500, 999):
        alone = own_columns(contact, {}, "F_star", loads[i : i + 1])
        assert alone["d"][0] == got["d"][i]


def test_what_is_carried_under_a_gap_is_an_integral_over_sizes():
    """One law of powers, no seat: the difference of two sums is what quadrature over sizes gives.

    q(ε) = ε^1.5, numbers like x^(−n): L(t) = ∫ x² ε^1.5 x^(−n) dx from max(t, x_1) to x_2, where
    ε = 1 − t/x; and the same by Q.
    """
    from scipy.integrate import quad

    n, low, high = 3.4, 1.0, 5.0

    def q_sum(eps):
        return quad(lambda e: e**1.5 * (1 - e) ** (n - 4), 0, eps, epsabs=0, epsrel=1e-13)[0]

    for t in (0.3, 0.9, 1.1, 3.0, 4.9):
        direct = quad(
            lambda x, t=t: x ** (2 - n) * (1 - t / x) ** 1.5,
            max(t, low), high, epsabs=0, epsrel=1e-13,
        )[0]  # fmt: skip
        by_sums = t ** (3 - n) * (q_sum(1 - t / high) - q_sum(max(1 - t / low, 0.0)))
        assert by_sums == pytest.approx(direct, rel=1e-11)


@pytest.mark.parametrize("power", [-4.0, -0.6, 1.0])
def test_sums_on_a_panel_are_integrals(power):
    """The series of a sum is the integral of what it is of, at every place."""
    from scipy.integrate import quad

    from thirdbody.equilibrium.engine.fields import POLYNOMIAL
    from thirdbody.equilibrium.engine.run import rules

    rule = rules()[-2, POLYNOMIAL:]
    places = rule[0, : gaps.TERMS]
    series, terms = np.zeros(gaps.TERMS + 1), np.zeros(gaps.TERMS)
    values = np.exp(power * places)
    whole, left = sum_row(rule, values, np.ones(gaps.TERMS), np.empty(gaps.TERMS), terms, series)
    assert left < 1e-15 * whole
    for x in (-0.7, 0.0, 0.4, 1.0):
        exact = quad(lambda u: math.exp(power * u), -1, x, epsabs=0, epsrel=1e-13)[0]
        assert np.polynomial.chebyshev.chebval(x, series) == pytest.approx(exact, rel=1e-13)
    assert whole == pytest.approx(quad(lambda u: math.exp(power * u), -1, 1)[0], rel=1e-13)


def sum_row(*args):
    """`gaps._sum_row` as Python runs it: alone it is compiled for the kernel only."""
    from unittest import mock

    def transform(rule, values, series):
        series[:] = rule[1 : 1 + len(series), : len(values)] @ values

    with mock.patch.object(gaps, "transform", transform):
        return gaps._sum_row.py_func(*args)
