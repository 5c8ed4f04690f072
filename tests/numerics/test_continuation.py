"""Branches that are followed through folds, held to closed forms."""

import numpy as np
import pytest

from thirdbody.numerics.continuation import follow_branch


def test_folds_of_a_cubic_source():
    """r = x − 2x²/(1 + x²): dr/dx = 0 has a root at 1 and one of a cubic."""

    def residual(x, r):
        return r - x + 2 * x**2 / (1 + x**2)

    branch = follow_branch(residual, x=[0.0], parameter=0.0, step=0.2, inside=lambda x, r: x[0] < 3)
    # (1 + x²)² = 4x
    roots = np.roots([1, 0, 2, -4, 1])
    folds = sorted(root.real for root in roots if abs(root.imag) < 1e-12)
    exact = [x - 2 * x**2 / (1 + x**2) for x in folds]
    np.testing.assert_allclose(branch.parameter[branch.folds], exact, atol=1e-12)
    np.testing.assert_allclose(branch.x[branch.folds, 0], folds, atol=1e-5)
    assert branch.ended == "border"
    assert (
        max(abs(residual(x, r)[0]) for x, r in zip(branch.x, branch.parameter, strict=True)) < 1e-7
    )


def test_a_helix_turns_again_and_again():
    """λ = sin s along x = (cos s, s/10): every quarter turn is known."""

    def residual(x, t):
        s = 10 * x[1]
        return np.array([x[0] - np.cos(s), t - np.sin(s)])

    branch = follow_branch(
        residual, x=[1.0, 0.0], parameter=0.0, step=0.3, inside=lambda x, t: x[1] < 2.0
    )
    s = 10 * branch.x[branch.folds, 1]
    np.testing.assert_allclose(s, np.pi / 2 + np.pi * np.arange(6), atol=1e-4)
    np.testing.assert_allclose(branch.parameter[branch.folds], [1, -1] * 3, atol=1e-11)


@pytest.mark.parametrize("width", [0.05, 0.02, 0.01, 0.005, 0.002])
def test_a_pair_of_folds_inside_one_step(width):
    """λ = x − 2w tanh((x − c)/w) turns where cosh² = 2, however narrow it is."""

    def residual(x, t):
        return x - 2 * width * np.tanh((x - 0.53) / width) - t

    start = 0.04 - 2 * width * np.tanh((0.04 - 0.53) / width)
    branch = follow_branch(
        residual, x=[0.04], parameter=start, step=0.1, inside=lambda x, t: x[0] < 1
    )
    away = width * np.arccosh(np.sqrt(2))
    np.testing.assert_allclose(branch.x[branch.folds, 0], [0.53 - away, 0.53 + away], atol=1e-5)
    value = 0.53
    found = np.ravel(branch.solutions(residual, value))
    assert len(found) == 3
    assert all(abs(residual(np.array([x]), value)[0]) < 1e-10 for x in found)


def test_folds_of_curves_at_random_by_a_dense_scan():
    """Steps and kinks at random: every turn of λ(x) over a fine grid, and no other."""
    rng, grid = np.random.default_rng(1), np.linspace(0.02, 1.0, 100_001)
    pairs = 0
    for _ in range(60):
        high, wide = (
            rng.uniform(-1, 1, 5) * 10 ** rng.uniform(-3, -1.3, 5),
            10 ** rng.uniform(-2, -0.7, 5),
        )
        at, kinks, bends = (
            rng.uniform(0.1, 0.9, 5),
            rng.uniform(0.1, 0.9, 2),
            rng.uniform(-0.5, 0.5, 2),
        )
        slope, fall = rng.uniform(0, 1, 2)

        def curve(x, high=high, wide=wide, at=at, kinks=kinks, bends=bends, slope=slope, fall=fall):
            x = np.asarray(x)[..., None]
            steps = np.sum(high * np.tanh((x - at) / wide), axis=-1)
            bent = np.sum(bends * np.maximum(x - kinks, 0), axis=-1)
            return slope * x[..., 0] - 0.8 * fall * x[..., 0] ** 2 + steps + bent

        over = curve(grid)
        if over[1] < over[0]:  # the walk begins towards larger λ
            continue
        branch = follow_branch(
            lambda x, t, curve=curve: curve(x) - t, x=[0.02], parameter=float(over[0]), step=0.1,
            inside=lambda x, t: x[0] < 1,
        )  # fmt: skip
        steps = np.diff(over)
        exact = grid[np.flatnonzero(steps[1:] * steps[:-1] < 0) + 1]
        exact = exact[exact < branch.x[-1, 0]]
        np.testing.assert_allclose(branch.x[branch.folds, 0], exact, atol=3e-4)
        pairs += len(exact) > 1
    assert pairs > 10


def test_solutions_at_one_parameter():
    def circle(x, t):
        return x**2 + t**2 - 1

    branch = follow_branch(
        circle, x=[0.6], parameter=-0.8, step=0.1, inside=lambda x, t: x[0] > -0.7
    )
    for value in (0.9, 1 - 1e-9):
        found = np.ravel(branch.solutions(circle, value))
        x = np.sqrt(1 - value**2)
        np.testing.assert_allclose(found, [x, -x], atol=1e-8)
    assert branch.solutions(circle, 1 + 1e-9) == []


def test_a_wall_ends_a_branch():
    """Where the equations have no value any more, the branch says so."""

    def residual(x, t):
        return np.where(x < 0.5, x - t, np.nan)

    branch = follow_branch(residual, x=[0.0], parameter=0.0, step=0.1, inside=lambda x, t: True)
    assert branch.ended == "step"
    assert 0.499 < branch.x[-1, 0] < 0.5


def test_no_solution_is_an_error():
    with pytest.raises(ValueError, match="no solution"):
        follow_branch(
            lambda x, t: x**2 + 1 + 0 * t, x=[0.3], parameter=0.0, step=0.1,
            inside=lambda x, t: True,
        )  # fmt: skip
