"""Sums against brute force: seeded random summits, and the second implementation for each.

The heights are drawn from numpy's generators, not by the library's own sampling.
"""

import functools
import math

import numpy as np
import plain
import pytest
from subjects import (
    ADHESIVE,
    CIRCLES,
    E_STAR,
    ELLIPSES,
    FIRST,
    HEIGHTS,
    NU,
    SIGMA_S,
    SUBJECTS,
    H,
    R,
    Subject,
    quadrature,
)

COUNT = 100_000
SEPARATION = 0.5
ONCE = [subject for name, subject in FIRST.items() if name in CIRCLES | set(ELLIPSES) | ADHESIVE]
ONCE += [subject for subject in SUBJECTS if subject.options.get("unloading")]


@functools.cache
def summits(name: str) -> np.ndarray:
    rng = np.random.default_rng(20221104)
    n = rng.standard_normal(COUNT)
    if name == "gaussian":
        return n
    if name == "exponential":
        return rng.exponential(size=COUNT) - 1
    if name == "weibull":
        first, second = math.gamma(1 + 1 / 1.8), math.gamma(1 + 2 / 1.8)
        return (rng.weibull(1.8, COUNT) - first) / math.sqrt(second - first**2)
    if name == "histogram":
        edges, counts = np.array([0, 1, 2.5, 3, 5]), np.array([1, 3, 4, 2])
        bins = rng.choice(4, COUNT, p=counts / counts.sum())
        x = rng.uniform(edges[bins], edges[bins + 1])
        middle, width = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)
        mean = counts @ middle / 10
        return (x - mean) / math.sqrt(counts @ (middle**2 + width**2 / 12) / 10 - mean**2)
    # parameters as in cases/laws.json
    gamma, delta, xi, lam, shape = {
        "johnson-SU": (2.2536604744, 2.9955259210, 1.8836886580, 2.1585924500, np.sinh),
        "johnson-SB": (
            0.9753614288,
            1.1569207074,
            -1.9353542579,
            5.9448335163,
            lambda v: 1 / (1 + np.exp(-v)),
        ),
    }[name]
    return xi + lam * shape((n - gamma) / delta)


@pytest.mark.parametrize("heights", HEIGHTS)
@pytest.mark.parametrize("subject", ONCE, ids=lambda subject: subject.label)
def test_sum(subject: Subject, heights: str):
    omega = (summits(heights) - SEPARATION) * SIGMA_S
    F, A = plain.contact(subject.law.name, omega, R=R, E=E_STAR, H=H, nu=NU, **subject.options)
    load, area = quadrature(subject.law, HEIGHTS[heights], SEPARATION)
    density = 0.05 / (R * SIGMA_S)
    for got, each in ((load * E_STAR, F), (area, A)):
        drawn = density * float(each.mean())
        error = density * float(each.std()) / math.sqrt(COUNT)
        assert abs(got - drawn) < 3.5 * error, (got / drawn - 1, error / drawn)
        # and the sample says something: a few parts in a thousand, more where loads cancel
        assert error < (0.02 if subject.law.name in ADHESIVE else 0.012) * abs(drawn)
