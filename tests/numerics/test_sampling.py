"""Points of scrambled Sobol sequences, against those of SciPy."""

import subprocess
import sys

import pytest
from numpy.testing import assert_array_equal
from scipy.stats import qmc

from thirdbody.numerics.direction_numbers import BLOCK_BITS, WIDEST, scrambled_points
from thirdbody.numerics.sampling import sobol


@pytest.mark.parametrize("bits", [30, 32, 33, 64])
@pytest.mark.parametrize("width", [1, 2, 5, WIDEST])
def test_points_are_those_of_scipy(width, bits):
    count = 3 << BLOCK_BITS
    for seed in (0, 7, 2**31):
        wanted = qmc.Sobol(width, rng=seed, bits=bits).random_base2(BLOCK_BITS + 2)[:count]
        assert_array_equal(scrambled_points(width, bits, seed, 0, count), wanted)
        part = slice(count // 3 - 5, count - 1)
        found = scrambled_points(width, bits, seed, part.start, part.stop)
        assert_array_equal(found, wanted[part])
    assert scrambled_points(width, bits, 0, 5, 5).shape == (0, width)


def test_points_far_along_are_those_of_scipy():
    engine = qmc.Sobol(3, rng=1, bits=30)
    engine.fast_forward(2**26 + 3)
    found = scrambled_points(3, 30, 1, 2**26 + 3, 2**26 + 2003)
    assert_array_equal(found, engine.random(2000))


@pytest.mark.parametrize("width", [WIDEST, WIDEST + 1])
def test_more_inputs_than_the_table_has_are_those_of_scipy_too(width):
    assert_array_equal(sobol(64, width, 7, 0, 64), qmc.Sobol(width, rng=7).random(64))
    assert_array_equal(sobol(64, width, 7, 9, 40), qmc.Sobol(width, rng=7).random(64)[9:40])


def test_points_load_no_statistics():
    code = (
        "import sys; from thirdbody.numerics.sampling import sobol; sobol(8, 2, 1, 0, 8); "
        "print('scipy.stats' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False"]
