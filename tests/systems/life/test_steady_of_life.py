"""What generations add up to, the balance of a stock, and all steady states."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from thirdbody.systems.life.linear_flow import dirt_gain, reproduction, steady_numbers
from thirdbody.systems.life.steady import (
    contact_stock,
    describe_reproduction,
    find_steady_points,
)


def test_births_and_losses_to_their_printed_digits():
    L, G = np.diag([1e-3, 5e-4]), np.array([[0, 0], [3e-5, 1e-4]])
    r = np.array([1e5, 0.0])
    assert reproduction(L, births=G) == pytest.approx(0.2, rel=1e-14)
    assert steady_numbers(L, births=G, source=r) == pytest.approx([1e8, 7.5e6], rel=1e-14)


@pytest.mark.parametrize("R0", [0.0, 1e-4, 0.3, 0.93])
def test_the_gain_of_one_class(R0):
    found = dirt_gain([[2e-3]], births=[[R0 * 2e-3]], source=[5.0])
    assert found == pytest.approx(1 / (1 - R0), rel=1e-13)


def test_R0_is_what_generations_add_up_to():
    """Count the daughters generation by generation, and run the equations to their end."""
    rng = np.random.default_rng(8)
    G = rng.random((5, 5)) * 1e-4
    L = np.diag(rng.uniform(5e-4, 2e-3, 5)) - 1e-5 * np.tril(rng.random((5, 5)), -1)
    r = rng.random(5)
    parents = rng.random(5)
    for _ in range(200):
        daughters = G @ np.linalg.solve(L, parents)
        growth = daughters.sum() / parents.sum()
        parents = daughters / daughters.sum()
    assert reproduction(L, births=G) == pytest.approx(growth, rel=1e-10)
    done = solve_ivp(lambda t, n: r + (G - L) @ n, (0, 2e5), np.zeros(5), method="BDF", rtol=1e-9)
    assert steady_numbers(L, births=G, source=r) == pytest.approx(done.y[:, -1], rel=1e-6)


@pytest.mark.parametrize("factor", [0.98, 1.02])
def test_R0_of_one_is_the_edge_of_growth(factor):
    G, L = np.array([[1e-4, 3e-4], [2e-4, 1e-5]]), np.diag([4e-4, 2e-4])
    G = G * factor / reproduction(L, births=G)
    growth = np.max(np.linalg.eigvals(G - L).real)
    assert (growth > 0) == (reproduction(L, births=G) > 1) == (factor > 1)


@pytest.mark.parametrize(
    ("R0", "words"),
    [(0.0, "makes no new debris"), (7e-5, "does not feed itself"), (0.93, "hardness and sizes"),
     (1.2, "without end"), (0.998, "breeds about 1 other before it is removed (R₀), about as many"),
     (1.004, "about as many as are removed: at these rates wear feeds itself"), (math.nan, "never removed")],
)  # fmt: skip
def test_what_R0_means_in_words(R0, words):
    assert words in describe_reproduction(R0)


def test_the_balance_of_a_stock_to_its_printed_digits():
    found = contact_stock(1e-6, capacity=2e-4, residence=100.0)
    assert f"{found.stock:.5e} {found.time:.4f}" == "6.66667e-05 66.6667"
    assert found.flow < 1e-6
    # the steady source, by the equation itself
    done = solve_ivp(
        lambda t, M: 1e-6 * (1 - M / 2e-4) - M / 100, (0, 3e3), [0.0], rtol=1e-11, atol=1e-18,
        dense_output=True,
    )  # fmt: skip
    assert done.y[0, -1] == pytest.approx(found.stock, rel=1e-9)
    assert done.sol(found.time)[0] == pytest.approx(found.stock * (1 - math.exp(-1)), rel=1e-7)
    assert 1e-6 * (1 - found.stock / 2e-4) == pytest.approx(found.flow, rel=1e-13)


@pytest.mark.parametrize(("r", "count"), [(0.05, 3), (0.1348, 3), (0.135, 1), (-0.001, 1)])
def test_all_steady_states_of_the_fold_test(r, count):
    """ẋ = r − x + 2x²/(1+x²): folds at r = 0 and 0.134884."""

    def balance(x):
        return r - x + 2 * x * x / (1 + x * x)

    found = find_steady_points(balance, low=-0.5, high=4.0)
    assert len(found) == count
    assert all(abs(balance(each.value)) < 1e-12 for each in found)
    assert [each.stable for each in found] == [True, False, True][:: 2 if count == 1 else 1][:count]
