"""What results say of themselves: status, the path taken, and equality."""

import os
from unittest import mock

import numpy as np
import oracle
import pytest
from twins import base, material

import thirdbody as tb
from thirdbody import engine, states
from thirdbody.errors import NotCompiled

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.RangeWarning")


def dusty(law=None, sizes=None, density: float = 1e11) -> tb.Contact:
    particles = tb.Particles(
        material=material(oracle.SILICA),
        diameter=sizes or tb.TruncatedGaussian(mean=3e-7, std=2.4e-8),
        areal_density=density,
    )
    return base(oracle.Interface(), particles, law or tb.particle.Series())


# ------------------------------------------------------------------------ the path taken
class TestPath:
    """Which engine found the states, and why not the compiled one."""

    def test_many_loads(self):
        pytest.importorskip("numba")
        loads = np.geomspace(1e-8, 1e-5, 20)
        with mock.patch.object(engine, "FEWEST", 1):
            assert tb.solve(dusty(), F_star=loads).engine == "compiled"
            other = tb.solve(dusty(tb.particle.Horng2022()), F_star=loads).engine
        assert other == "numpy: particles that are not Series"
        assert tb.solve(dusty(), F_star=loads).engine.startswith("numpy: fewer than")
        assert tb.solve(dusty(), d=2e-7).engine == "numpy: the separations are given"

    def test_switched_off(self):
        loads = np.geomspace(1e-8, 1e-5, 20)
        off = mock.patch.dict(os.environ, THIRDBODY_ENGINE="numpy")
        with mock.patch.object(engine, "FEWEST", 1), off:
            assert "THIRDBODY_ENGINE" in tb.solve(dusty(), F_star=loads).engine

    def test_states_with_inputs_of_their_own(self):
        """A law that varies in half of the states sends only these to the NumPy engine."""
        pytest.importorskip("numba")
        k = np.where(np.arange(40) < 20, 0.4, 0.35)
        sigma = 1e-7 * np.linspace(1, 1.2, 40)
        vary = {"asperity_law.k": k, "roughness.sigma": sigma}
        with mock.patch.object(states, "FEWEST", 2):
            found = tb.solve_states(dusty(), F_star=1e-6, vary=vary)["engine"]
        assert set(found[:20]) == {"compiled"}
        assert set(found[20:]) == {"numpy: the asperity law varies"}

    @pytest.mark.parametrize("out", [None, "sweep"])
    def test_sweep(self, out, tmp_path):
        pytest.importorskip("zarr")
        data = tb.sweep(
            dusty(),
            F_star=[1e-6],
            vary={"roughness.sigma": [1e-7, 2e-7]},
            out=out and tmp_path / out,
        )
        assert data.attrs["engine"] == "numpy: fewer than 5000 loads of one contact (2 states)"

    @pytest.mark.parametrize("where", ["_add_asperities", "_add_particles"])
    def test_a_type_error_is_an_error(self, where):
        """A mistake in the library is not taken for an input that the engine does not know."""
        pytest.importorskip("numba")
        vary = {"roughness.sigma": 1e-7 * np.linspace(1, 1.2, 40)}
        broken = {"side_effect": TypeError("a mistake")}
        with mock.patch.object(engine.States, where, **broken), pytest.raises(TypeError):
            tb.solve_states(dusty(), F_star=1e-6, vary=vary)
        loads = np.geomspace(1e-8, 1e-5, 20)
        few = mock.patch.object(engine, "FEWEST", 1)
        broken_there = mock.patch.object(engine.Interfaces, where, **broken)
        with few, broken_there, pytest.raises(TypeError):
            tb.solve(dusty(), F_star=loads)

    def test_the_refusal_is_no_type_error(self):
        assert not issubclass(NotCompiled, (TypeError, tb.ThirdBodyError))
