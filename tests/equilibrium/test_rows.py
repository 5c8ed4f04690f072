"""From a contact to the records of the compiled engine, and what is compiled for them."""

import importlib
import sys

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.contact.interface import interface
from thirdbody.equilibrium.compiled import layout
from thirdbody.equilibrium.compiled.rows import InterfaceRows, StateRows

pytest.importorskip("numba")

SIZES = {
    "one size": tb.distributions.Monodisperse(mean=300e-9),
    "many sizes": tb.LogNormal(median=250e-9, gsd=1.4),
    "two kinds": tb.distributions.Mixture(
        parts=(tb.LogNormal(median=200e-9, gsd=1.3), tb.distributions.Monodisperse(mean=400e-9)),
        weights=(0.7, 0.3),
    ),
}


def contact(seat: str, sizes: str, shadow: str = "footprint") -> tb.Contact:
    steel = tb.materials["S45C"]
    return tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(
            material=tb.materials["SiO2"], diameter=SIZES[sizes], areal_density=1e10
        ),
        particle_law=tb.particle.Series(deep="off", seat=seat, shadow=shadow),
    )


@pytest.mark.parametrize("sizes", SIZES)
@pytest.mark.parametrize("seat", ["plane", "rough"])
@pytest.mark.parametrize("shadow", ["footprint", "covered"])
def test_one_contact_by_tables_and_as_a_state(seat, sizes, shadow):
    """What both ways fill in, they fill in alike."""
    case = contact(seat, sizes, shadow)
    by_table = InterfaceRows([interface(case)])
    vary = {"roughness.sigma": np.full(3, case.roughness.sigma)}
    as_states = StateRows(case, vary, 3)
    for name in ("shadow", "sigma_s", "centre", "force", "area", "highest", "coverage"):
        wanted = np.full(3, by_table.interfaces[name][0])
        np.testing.assert_allclose(as_states.interfaces[name], wanted, rtol=1e-14, err_msg=name)
    names = ["size", "factor", "offset", "width", "reach", "floor"]
    assert by_table.parts.shape[1] == len(case.particles.diameter.components)
    if seat == "plane":
        names += ["kind", "least", "top", "join", "powers"]
    else:
        assert set(by_table.parts["kind"][0]) == {layout.ROUGH}
        assert set(as_states.parts["kind"].ravel()) == {layout.ROUGH_NODES}
    for name in names:
        wanted = np.broadcast_to(by_table.parts[name], as_states.parts[name].shape)
        np.testing.assert_allclose(as_states.parts[name], wanted, rtol=1e-14, err_msg=name)


def test_what_varies_stands_in_its_record_and_nothing_else_does():
    case = contact("plane", "many sizes")
    density = np.array([1e9, 2e9, 4e9])
    rows = StateRows(case, {"particles.areal_density": density}, 3)
    part = rows.parts[:, 0]
    np.testing.assert_allclose(part["factor"] / part["factor"][0], density / density[0])
    for name in set(layout.PART.names) - {"factor"}:
        assert len({each.tobytes() for each in part[name]}) == 1, name
    assert len({each.tobytes() for each in rows.interfaces}) == 1


# ------------------------------------------------------------------------------ the cache
DOUBLE = """
from numba import njit
from thirdbody.equilibrium.compiled.cached import Cached

@Cached
@njit(cache=True)
def double(x):
    return 2 * x
"""


def test_a_change_of_any_module_of_the_engine_compiles_anew(tmp_path, monkeypatch):
    """numba looks at the module of a function alone, not at those that it takes code from."""
    from numba import types

    from thirdbody.equilibrium.compiled import cached

    engine, home = tmp_path / "engine", tmp_path / "home"
    engine.mkdir()
    home.mkdir()
    (engine / "layout.py").write_text("TERMS = 18\n")
    (engine / "kernels.py").write_text("from .layout import TERMS\n")
    (home / "doubles.py").write_text(DOUBLE)
    monkeypatch.setattr(cached, "files", lambda _: engine)
    monkeypatch.syspath_prepend(home)
    signature = (types.float64,)

    def fresh():
        sys.modules.pop("doubles", None)
        return importlib.import_module("doubles").double

    fresh().function.compile(signature)
    assert fresh().is_cached(signature)
    (engine / "layout.py").write_text("TERMS = 20\n")
    assert not fresh().is_cached(signature)
    (engine / "layout.py").write_text("TERMS = 18\n")
    assert fresh().is_cached(signature)
    for path in home.rglob("*.nbc"):
        path.unlink()
    assert not fresh().is_cached(signature)
    sys.modules.pop("doubles")


def test_arguments_are_told_apart_as_numba_does():
    from thirdbody.equilibrium.compiled.cached import Cached, _kind

    line, plane = np.zeros(4), np.zeros((4, 4))
    fixed = np.zeros(4)
    fixed.setflags(write=False)
    values = [
        *(
            line,
            line[::2],
            plane,
            plane.T,
            plane[::2, ::2],
            fixed,
            line.astype(np.int32),
            True,
            1,
            1.0,
        ),
        *(np.zeros(2, layout.SPAN), np.zeros(2, layout.RULE), np.zeros(2, layout.RULE)[0]),
        *((line, line), (line, plane), np.zeros(3), np.zeros(7, layout.SPAN)),
    ]
    for one in values:
        for two in values:
            same = Cached._signature((one,)) == Cached._signature((two,))
            assert same == (_kind(one) == _kind(two))
