"""The law of one field against the stored states of surfaces pressed point by point."""

from __future__ import annotations

import pytest

from thirdbody.papers.explicit.one_field import HEAVY, OPEN, against_stored, errors


@pytest.mark.slow
def test_every_stored_state():
    """What the book says of both laws: worst and RMS."""
    states = against_stored()
    assert len(states) == 128
    heavy = [s for s in states if s.F_star > HEAVY and s.case not in OPEN]
    assert len(heavy) == 68
    old, new = (errors(heavy, field=field) for field in (False, True))
    assert old["share"] == pytest.approx((0.431, 0.135), abs=0.002)
    assert new["share"][0] < 0.065
    assert new["share"][1] < 0.016
    assert new["h"][0] < 0.0145
    assert new["area"][0] < 0.085
    soft = [s for s in heavy if not s.case.startswith("chi")]
    assert len(soft) == 56
    assert errors(soft, field=True)["share"][0] < 0.016
    assert errors(soft, field=False)["share"][0] == pytest.approx(0.209, abs=0.002)


@pytest.mark.slow
def test_where_one_field_is_behind():
    """Two shares of the 118, as the book says, beyond the error bars of 8 surfaces."""
    behind = []
    for state in against_stored():
        new, old = (abs(state.differences(field=field)[0]) for field in (True, False))
        bar = 2.36 * state.share_error / state.share[0]
        if state.case not in OPEN and new > old and new > bar:
            behind.append((state.case, state.F_star))
    assert behind == [("settled", 1e-5), ("chi0.4_alpha15", 1.6e-2)]


@pytest.mark.slow
def test_light_states():
    states = against_stored()
    light = [s for s in states if s.F_star <= HEAVY and s.case not in OPEN]
    old, new = (errors(light, field=field) for field in (False, True))
    assert new["share"][0] < 0.05 < old["share"][0]
    assert new["h"][0] < 0.03


def test_some_states_by_the_endless_spectrum():
    states = against_stored(endless=True, cases=["x1", "large_soft", "density12"])
    old, new = (errors(states, field=field) for field in (False, True))
    assert new["share"][0] < 0.05 < 0.15 < old["share"][0]
    assert new["h"][0] < 0.02 < 0.6 < old["h"][0]
