"""Two sums of damage over codes that change."""

import pytest

import thirdbody as tb
from thirdbody.systems.bearing_life import contamination_factor, life_factor
from thirdbody.systems.life.fatigue import miner_pair

BEARING = dict(place="bath", bearing="ball", kappa=1.0, D=0.05, load_ratio=0.1, L_10=3.6e7)


def test_the_pair_to_its_printed_digits():
    pair = miner_pair([0.0, 3.6e5], codes=["-/19/16", "-/13/10"], end=7.2e5, **BEARING)
    assert [f"{life / 3600:.0f}" for life in (pair.forgets, pair.remembers)] == ["13261", "2244"]
    clean = miner_pair([0.0], codes=["-/13/10"], end=1.0, **BEARING)
    assert f"{clean.forgets / 3600:.0f}" == "13775"


def test_an_oil_that_only_gets_dirtier_is_remembered_as_it_is():
    codes = ["-/13/10", "-/15/12", "-/19/16"]
    pair = miner_pair([0.0, 1e6, 2e6], codes=codes, end=3e6, **BEARING)
    assert pair.forgets == pair.remembers
    assert pair.damage_forgets == pair.damage_remembers
    life = [
        3.6e7 * life_factor(
            "ball", kappa=1.0, load=0.1 * contamination_factor("bath", code, kappa=1.0, D=0.05)
        )
        for code in codes
    ]  # fmt: skip
    assert pair.damage_forgets == pytest.approx(sum(1e6 / each for each in life), rel=1e-12)


def test_a_life_may_end_inside_the_history():
    codes = ["-/19/16", "-/13/10"]
    pair = miner_pair([0.0, 9e7], codes=codes, end=1e8, **BEARING)
    assert pair.forgets < 9e7
    assert pair.damage_forgets > 1
    assert pair.forgets == pair.remembers


def test_bad_histories_are_refused():
    with pytest.raises(tb.errors.InvalidValue, match="increase"):
        miner_pair([0.0, 0.0], codes=["-/13/10"] * 2, end=1.0, **BEARING)
    with pytest.raises(tb.errors.InvalidValue, match="dirtier"):
        miner_pair([0.0], codes=["-/25/22"], end=1.0, **BEARING)
