"""Functions without a branch, for loops that become vectors, hold to those of the library."""

import math

import numpy as np
import pytest

pytest.importorskip("numba")
from thirdbody.equilibrium.engine.vectors import ln, padded_length


def test_the_logarithm_holds_to_that_of_the_library():
    x = np.concatenate(
        [
            np.geomspace(1e-300, 1e300, 3001),
            1
            + np.concatenate([[0.0], np.geomspace(1e-15, 0.5, 200), -np.geomspace(1e-15, 0.5, 99)]),
            np.sqrt(0.5) * (1 + 1e-15 * np.arange(-9, 10)),
        ]
    )
    for each in x:
        assert ln(each) == pytest.approx(math.log(each), rel=1e-15, abs=0), each


def test_rows_are_whole_vectors():
    assert [padded_length.py_func(count) for count in (1, 8, 9, 24)] == [8, 8, 16, 24]
