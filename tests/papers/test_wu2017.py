"""Friction with particles as Wu, Chen and Horng (2017) and Wu and Chen state it."""

import json
from pathlib import Path

import numpy as np
import pytest

from thirdbody.papers import PAPERS
from thirdbody.papers import wu2017 as study
from thirdbody.papers.ledger import NO_SOURCE, OWN, SEEN
from thirdbody.papers.report import Summary

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")]
READINGS = ("few", "many", "smooth")
VERDICTS = {
    "grows": ("fail", "fail", "fail"),
    "falls": ("fail", "fail", "pass"),
    "smaller": ("fail", "fail", "pass"),
    "varies": ("pass", "pass", "pass"),
    "alone": ("pass", "pass", "pass"),
    "critical": ("pass", "pass", "pass"),
    "elastic": ("fail", "fail", "fail"),
    "elastoplastic": ("pass", "pass", "pass"),
    "two-body": ("pass", "pass", "pass"),
    "temperature": ("not reproduced",) * 3,
    "numbers": ("not sourced",) * 3,
}


@pytest.fixture(scope="module")
def ledger(ledger_of):
    return ledger_of(study.STUDY)


def test_verdicts(ledger):
    stated = [claim.id for claim in study.STUDY.claims if claim.standing != OWN]
    assert {id: tuple(ledger[name][id].word for name in READINGS) for id in stated} == VERDICTS


def test_the_rule_holds_everywhere(ledger):
    for name in READINGS:
        assert ledger[name]["rule"].measured.values == (1.0,)


def test_where_the_sign_changes(ledger):
    """The same density from both readings, and friction is that of bare surfaces there."""
    few, many = (ledger[name]["flip"].measured.values[0] for name in ("few", "many"))
    assert few == pytest.approx(many, rel=1e-6)
    trend = study.friction_trend(
        study.READINGS["few"], np.array([5e6]), size=5 / 3, density=few / study.FEW
    )
    assert trend.mu[0] == pytest.approx(trend.bare_mu[0], rel=1e-6)
    assert not ledger["smooth"]["flip"].measured.exists


def test_every_claim_says_where_it_comes_from():
    for claim in study.STUDY.claims:
        assert claim.standing in {SEEN, NO_SOURCE, OWN}, claim.id
        assert claim.place, claim.id


def test_study_is_registered_and_writes_its_ledger(ledger):
    assert "wu2017" in PAPERS
    summary = Summary(out=Path(), study=study.STUDY, ledger=ledger)
    text = json.dumps(summary.as_json())
    assert "10.3390/mi8100302" in text
