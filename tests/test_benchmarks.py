"""The benchmark on a small scale: fails only where speed is lost by a factor, not by a busy machine."""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest

import thirdbody as tb

pytest.importorskip("numba")
pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore::thirdbody.RangeWarning")]
FOLDER = Path(__file__).parent.parent / "benchmarks"
COUNT = 100_000


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


def solved(run, seat, **environment):
    """States a second of processor time."""
    contact, many = run.contact(seat), run.loads(COUNT)
    with run.environment(**environment):
        tb.solve(contact, F_star=many)  # tables and compilation
        return run.row(seat, lambda: tb.solve(contact, F_star=many), COUNT, repeats=3).rate


@pytest.mark.parametrize("seat", ["plane", "rough", "two-body"])
def test_compiled_against_the_script_and_numpy(run, naive, seat):
    compiled = solved(run, seat)
    assert compiled >= 100 * naive[0].rate
    assert compiled >= 0.7 * solved(run, seat, THIRDBODY_ENGINE="numpy")


@pytest.mark.parametrize("seat", ["plane", "rough", "two-body"])
def test_states_of_their_own_against_the_script(run, naive, seat):
    contact, many, vary = run.contact(seat), run.loads(20_000), run.inputs(seat, 20_000)

    def call():
        return tb.solve_states(contact, F_star=many, vary=vary)

    assert np.all(call()["status"] == "ok")
    assert run.row(seat, call, len(many), repeats=3).rate >= 100 * naive[0].rate


def test_both_agree_with_the_script(run, naive):
    _, few, slow = naive
    assert max(dict(run.largest_difference(few, slow)).values()) <= run.ERROR


def test_no_state_is_quicker_than_its_exponentials(run):
    """Counted too high, the floor would lie above what is measured."""
    floor = importlib.import_module("floor")
    rows = list(run.own_inputs(floor.nanoseconds()))
    shares = [int(row.note.split("%")[0]) for row in rows]
    assert len(shares) == 6
    assert all(1 < share < 100 for share in shares)


def test_outputs_cost_about_a_solve(run, monkeypatch):
    monkeypatch.syspath_prepend(str(FOLDER))
    import outputs

    *_, every = outputs.costs()
    assert every.what == "all of them"
    # 1.7 on a quiet machine
    assert every.new < 8
