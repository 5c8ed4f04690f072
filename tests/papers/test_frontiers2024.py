"""What Front. Mech. Eng. 2024, 1390335 states, in this library's mixed lubrication."""

import json

import pytest

from thirdbody.papers import frontiers2024 as study
from thirdbody.papers.ledger import OWN, SEEN, WORDS

pytestmark = pytest.mark.slow
READINGS = ("rough", "offset")


@pytest.fixture(scope="module")
def ledger(ledger_of):
    return ledger_of(study.STUDY)


VERDICTS = {
    "mixed-size": ("pass", "pass"),
    "mixed-density": ("pass", "pass"),
    "boundary-size": ("pass", "pass"),
    "boundary-density": ("pass", "pass"),
    "dry-size": ("pass", "pass"),
    "dry-density": ("pass", "pass"),
    "viscosity": ("pass", "pass"),
    "ratio": ("fail", "fail"),
    "load-scale": ("pass", "pass"),
    "load-density": ("fail", "fail"),
    "load-viscosity": ("not reproduced", "fail"),
}


def test_verdicts(ledger):
    stated = [claim.id for claim in study.STUDY.claims if claim.standing != OWN]
    assert {id: tuple(ledger[name][id].word for name in READINGS) for id in stated} == VERDICTS


@pytest.mark.parametrize(
    ("reading", "claim", "values"),
    [
        ("rough", "mixed-size", [1.01601]),
        ("offset", "mixed-density", [1.01708]),
        ("rough", "boundary-size", [0.999258]),
        ("offset", "dry-density", [0.999070]),
        ("rough", "viscosity", [1.00666]),
        ("rough", "ratio", [2.918, 11.07]),
        ("offset", "ratio", [1.107, 11.07]),
        ("rough", "load-density", [2.8296]),
        ("offset", "load-viscosity", [1.927]),
        ("rough", "crossing", [0.05678]),
    ],
)
def test_values(ledger, reading, claim, values):
    assert ledger[reading][claim].measured.values == pytest.approx(values, rel=5e-4)


def test_scale_alone_changes_no_pressure(ledger):
    """The laws have no length of their own: x_a, σ, R and the particles' spacing doubled."""
    for name in READINGS:
        assert ledger[name]["load-scale-density"].measured.values == pytest.approx([1], rel=1e-9)


def test_crossing_is_between_boundary_and_mixed(ledger):
    for name in READINGS:
        (share,) = ledger[name]["crossing"].measured.values
        assert 0.01 < share < 0.5


def test_every_claim_says_where_it_comes_from():
    assert {claim.standing for claim in study.STUDY.claims} <= {SEEN, OWN}
    assert all(claim.place for claim in study.STUDY.claims)


def test_pages(tmp_path, ledger, monkeypatch):
    monkeypatch.setattr(type(study.STUDY), "ledger", lambda self: ledger)
    summary = study.reproduce(tmp_path)
    claims = json.loads((tmp_path / "claims.json").read_text("utf-8"))
    assert "10.3389/fmech.2024.1390335" in claims["paper"]
    assert {"fig1.png", "fig1.svg", "fig1.csv", "index.html"} <= set(summary.files)
    assert summary.counts("rough")["pass"] == 8
    assert set(summary.counts("rough")) == set(WORDS)
    (panel,) = [draw() for draw in study.STUDY.panels]
    for line in panel.lines:
        assert line.y[0] < 0 < line.y[-1]
