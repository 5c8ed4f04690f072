"""The first process after an installation gives the bytes of every later one."""

import os
import subprocess
import sys

import pytest

pytestmark = pytest.mark.check

STATES = """
import numpy as np, thirdbody as tb
steel = tb.materials["S45C"]
contact = tb.Contact(
    surfaces=tb.MaterialPair(steel, steel),
    roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    particles=tb.Particles(
        material=tb.materials["SiO2"],
        diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
        areal_density=1e11,
    ),
)
F_star, n = np.geomspace(1e-7, 1e-4, 500), 500
vary = {"roughness.sigma": np.linspace(8e-8, 1.2e-7, n), "particles.diameter.mean": np.linspace(2.8e-7, 3.2e-7, n)}
states = tb.equilibria.solve_states(contact, F_star=F_star, vary=vary)
assert set(states["engine"].values) == {"compiled"}
for name in ("d", "F_ss_star", "F_sa_star", "A_t", "A_sa2"):
    print(name, states[name].values.tobytes().hex())
"""


def test_compiling_leaves_no_trace_in_the_numbers(tmp_path):
    """Compiled and loaded code of the engine differed in the last digits of one state in three."""
    run = [sys.executable, "-c", STATES]
    where = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    first, second = (
        subprocess.run(run, env=where, capture_output=True, text=True, check=True).stdout
        for _ in range(2)
    )
    assert first == second
    assert len(first) > 5 * 500 * 16
