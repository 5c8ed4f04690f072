"""The law of one field against the stored states of surfaces pressed point by point."""

from __future__ import annotations

import pytest

from thirdbody.papers.explicit.one_field import HEAVY, OPEN, against_stored, errors


@pytest.mark.slow
def test_every_stored_state():
    """What the book says of both laws: worst and RMS."""
    states = against_stored()
    assert len(states) == 114
    heavy = [s for s in states if s.F_star > HEAVY and s.case not in OPEN]
    light = [s for s in states if s.F_star <= HEAVY and s.case not in OPEN]
    assert len(heavy) == 56
    old, new = (errors(heavy, field=field) for field in (False, True))
    assert old["share"][0] == pytest.approx(0.209, abs=0.002)
    assert new["share"][0] < 0.03
    assert new["share"][1] < 0.01
    assert new["h"][0] < 0.02
    assert new["area"][0] < 0.05
    old, new = (errors(light, field=field) for field in (False, True))
    assert new["share"][0] < 0.05 < old["share"][0]
    assert new["h"][0] < 0.03


def test_some_states_by_the_endless_spectrum():
    states = against_stored(endless=True, cases=["x1", "large_soft", "density12"])
    old, new = (errors(states, field=field) for field in (False, True))
    assert new["share"][0] < 0.05 < 0.15 < old["share"][0]
    assert new["h"][0] < 0.02 < 0.6 < old["h"][0]
