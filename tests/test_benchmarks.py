"""The benchmarks run on a small scale, and solve what they say; how fast, they measure themselves."""

import importlib.util
import math
import sys
from pathlib import Path

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.equilibrium.engine import columns
from thirdbody.equilibrium.states import state_columns

pytest.importorskip("numba")
pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")]
FOLDER = Path(__file__).parent.parent / "benchmarks"
COUNT = 10_000


@pytest.fixture(scope="module")
def run():
    """benchmarks/run.py as a module."""
    spec = importlib.util.spec_from_file_location("run", FOLDER / "run.py")
    assert spec is not None
    assert spec.loader is not None
    module = sys.modules["run"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    yield module
    del sys.modules["run"]


@pytest.fixture(scope="module")
def naive(run):
    return run.naive_row()


@pytest.mark.parametrize("seat", ["plane", "rough", "two-body"])
def test_what_is_measured_is_solved(run, seat):
    contact, many, vary = run.contact(seat), run.loads(COUNT), run.inputs(seat, COUNT)
    assert set(tb.solve(contact, F_star=many).status) == {"ok"}
    found = []
    row = run.row(
        seat,
        lambda: found.append(state_columns(contact, F_star=many, vary=vary)),
        COUNT,
        repeats=1,
    )
    assert found
    assert all(np.all(each["status"] == "ok") for each in found)
    assert row.rate > 0


def test_both_agree_with_the_script(run, naive):
    _, few, slow = naive
    assert max(dict(run.largest_difference(few, slow)).values()) <= run.ERROR


def test_every_row_has_its_name(run, monkeypatch):
    monkeypatch.syspath_prepend(str(FOLDER))
    floor, outputs = map(importlib.import_module, ("floor", "outputs"))
    assert len(list(run.own_inputs(floor.nanoseconds(), COUNT))) == 6
    monkeypatch.setattr(outputs, "REPEATS", 1)
    monkeypatch.setattr(outputs, "LOADS", outputs.LOADS[::40])
    *_, every = outputs.costs()
    assert every.what == "all of them"


def test_every_kind_of_grain_is_solved(monkeypatch):
    monkeypatch.syspath_prepend(str(FOLDER))
    grains = importlib.import_module("grains")
    for kind in grains.KINDS:
        _, rate, engine = grains.measured(kind, COUNT)
        assert rate > 0
        assert engine == "compiled", kind


def test_particles_that_break_are_as_exact_as_the_engine_says(monkeypatch):
    """Twelve nodes a panel were off by 1e-9 in some of a hundred states, and said 1e-11.

    NumPy takes seconds for each, so those are compared that fewer nodes move most.
    """
    monkeypatch.syspath_prepend(FOLDER)
    accuracy = importlib.import_module("engine_accuracy")
    mine = [(contact, name) for case, contact, name in accuracy.cases() if case == "breaking rough"]
    contact, names = mine[0][0], [name for _, name in mine]
    rng = np.random.default_rng(accuracy.SEED)
    loads, vary = accuracy.inputs_of(contact, names, 50, rng)
    by_all, by_few = (_areas(contact, loads, vary, count, monkeypatch) for count in (None, (6, 12)))
    moved = np.abs(by_few / by_all - 1)
    chosen = np.argsort(-moved)[:2]
    assert moved[chosen[0]] > 0
    row = accuracy.compared("breaking rough", contact, names, 50, math.inf, chosen)
    assert row.states == 50
    assert (row.above, row.numpy, row.failed) == (0, 0, 0)
    assert row.load > 0
    assert max(row.load, row.area, row.d) < 1e-11


def _areas(contact, loads, vary, nodes, monkeypatch):
    """A_t by so many nodes of a panel at the first level, few and all."""
    with monkeypatch.context() as patch:
        if nodes:
            patch.setattr(columns, "BREAKING", nodes)
        columns.rules.cache_clear()
        found = state_columns(contact, F_star=loads, vary=vary)
    columns.rules.cache_clear()
    assert {*found["engine"]} == {"compiled"}
    return found["A_t"]


def test_oils_are_balanced_and_agree_with_steps():
    spec = importlib.util.spec_from_file_location("life", FOLDER / "life.py")
    module = sys.modules["life"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    found = module.compare_oils(12)
    del sys.modules["life"]
    assert found.residual < 1e-9
    assert found.off < 1e-4  # that of the steps, which are to 1e-6 each
    assert found.ratio > 0
