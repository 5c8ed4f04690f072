"""The trends that Ghaednia and Jackson (2013) state, in the reconstructed two-submodel contact."""

import numpy as np
import pytest

from thirdbody.studies import ghaednia2013 as study


@pytest.mark.parametrize("entry", study.ledger(), ids=lambda entry: entry.statement.id)
def test_statement_holds(entry):
    assert entry.measured
    assert entry.holds, entry.measured


def test_every_statement_says_where_it_comes_from():
    words = {s.provenance.split()[0].rstrip(";") for s in study.STATEMENTS}
    assert words == {"seen", "recalled"}
    assert study.model("stack").provenance == "reconstructed"


def test_area_is_linear_though_the_bare_area_is_not():
    state = study.model("fractal").solve(study.PRESSURES)
    bare = np.polyfit(np.log(state.pressure), np.log(state.A_0), 1)[0]
    real = np.polyfit(np.log(state.pressure), np.log(state.A_real), 1)[0]
    assert bare > 1.2
    assert real == pytest.approx(1, abs=0.02)


def test_more_and_larger_particles_keep_the_surfaces_further_apart():
    small, large = (study.model("stack", x).solve(1e6) for x in (60e-9, 120e-9))
    assert large.gap > small.gap > 0
    few = study.model("stack").replace(**{"particles.areal_density": 1.9e13})
    assert few.solve(1e6).gap < study.model("stack").solve(1e6).gap


def test_the_stack_says_that_it_has_not_converged():
    assert "not converged" in study.model("stack").solve(1e6).warnings[0]
    assert study.model("fractal").solve(1e6).warnings == ()


def test_command_prints_the_ledger(capsys):
    assert study.main() == 0
    out = capsys.readouterr().out
    assert out.count("holds") == len(study.STATEMENTS)
    assert "reconstructed" in out
