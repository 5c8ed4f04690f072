"""Points of the Sobol sequence against SciPy's, bit by bit."""

import subprocess
import sys

import numpy as np
import pytest
from scipy.stats import qmc

from thirdbody.numerics.sampling import sobol
from thirdbody.numerics.sobol_points import WIDEST, points


@pytest.mark.parametrize("bits", [30, 33, 40])
@pytest.mark.parametrize("width", [1, 2, 7, WIDEST])
def test_points_are_those_of_scipy(width, bits):
    for seed in (0, 123_456_789):
        known = qmc.Sobol(width, rng=seed, bits=bits).random(1024)
        np.testing.assert_array_equal(points(width, seed, bits, 0, 1024), known)
        np.testing.assert_array_equal(points(width, seed, bits, 137, 900), known[137:900])


def test_wider_ones_come_from_scipy():
    width = WIDEST + 1
    known = qmc.Sobol(width, rng=3, bits=30).random(64)
    np.testing.assert_array_equal(sobol(64, width, 3, 0, 64), known)
    np.testing.assert_array_equal(sobol(64, width, 3, 16, 40), known[16:40])
    assert np.array_equal(sobol(64, WIDEST, 3, 0, 64), points(WIDEST, 3, 30, 0, 64))


def test_bands_load_no_statistics():
    words = (
        "import sys; from thirdbody.numerics.sampling import sobol; sobol(64, 6, 0, 0, 64); "
        "assert 'scipy.stats' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", words], check=True)
