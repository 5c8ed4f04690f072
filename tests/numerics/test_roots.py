"""Roots inside brackets are those of SciPy, to the last bit."""

import numpy as np
import pytest
from scipy.optimize.elementwise import find_root

from thirdbody.numerics.roots import bracketed_root

RNG = np.random.default_rng(20)
FUNCTIONS = {
    "power": lambda x, c: x**3 - c,
    "log": lambda x, c: np.log(x + 1e-3) - c,
    "steep": lambda x, c: np.expm1(5 * (x - c)),
    "jump": lambda x, c: np.where(x < c, x - c - 1, x + 1),
    "flat": lambda x, c: (x - c) ** 7,
    "linear": lambda x, c: x - c,
    "none": lambda x, c: x**2 + 1 + c,
}


@pytest.mark.parametrize("xrtol", [1e-15, 4e-16, 1e-6])
@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_bit_is_that_of_scipy(name, xrtol):
    function = FUNCTIONS[name]
    c = np.concatenate([RNG.uniform(0.01, 2, 300), np.geomspace(1e-9, 1, 50), [0.0, 1.0, 3.0]])
    low, high = np.where(RNG.random(c.size) < 0.5, 0.0, 0.4 * c), np.full(c.size, 2.0)
    tolerances = {"xatol": 0.0, "xrtol": xrtol, "fatol": 0.0, "frtol": 0.0}
    theirs = find_root(function, (low, high), args=(c,), tolerances=tolerances).x
    np.testing.assert_array_equal(bracketed_root(function, low, high, (c,), xrtol=xrtol), theirs)
    assert np.isnan(theirs).all() == (name == "none")


def test_the_shape_is_that_of_the_brackets():
    c = RNG.uniform(0.1, 1, (3, 4))
    theirs = find_root(
        FUNCTIONS["power"],
        (np.zeros_like(c), np.full_like(c, 2.0)),
        args=(c,),
        tolerances={"xatol": 0.0, "xrtol": 1e-15, "fatol": 0.0, "frtol": 0.0},
    ).x
    ours = bracketed_root(FUNCTIONS["power"], np.zeros_like(c), np.full_like(c, 2.0), (c,))
    np.testing.assert_array_equal(ours, theirs)
    assert ours.shape == (3, 4)
    empty = np.empty(0)
    assert bracketed_root(FUNCTIONS["power"], empty, empty, (empty,)).shape == (0,)
