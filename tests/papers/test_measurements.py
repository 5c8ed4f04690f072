"""The page of measurements: verdicts, standings, and that nothing is fitted."""

import json
from pathlib import Path

import numpy as np
import pytest
from refusals import refuses

import thirdbody as tb
from thirdbody.errors import Mistake
from thirdbody.papers import measurements
from thirdbody.papers.measurements import trezona1999
from thirdbody.papers.measurements.row import CHOSEN, STANDINGS, WORDS, Band, statement, word_of

STEEL = tb.materials["S45C"]
BOOK = json.loads((Path(tb.__file__).parent / "data" / "verdicts.json").read_text("utf-8"))
VERDICTS = BOOK["measurements"] | BOOK["computations"]


# the whole page takes half a minute: what needs it is among the long tests
whole = pytest.mark.slow


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    return measurements.reproduce(tmp_path_factory.mktemp("measurements"))


@whole
def test_every_measurement_has_its_verdict(done):
    assert {name: word_of(dict(one)) for name, one in done.ledger.items()} == VERDICTS


@whole
def test_the_lost_ones_stand_first(done):
    words = [word_of(dict(done.ledger[row.name])) for row in done.rows]
    assert words == sorted(words, key=WORDS.index)
    assert words[0] == "lost"
    page = (done.out / "index.html").read_text("utf-8")
    places = [page.index(f"<section id='{row.name}'>") for row in done.rows]
    assert places == sorted(places)


def test_at_least_nine():
    assert len(measurements.rows()) >= 9
    assert [row.name for row in measurements.rows()] == list(measurements.NAMES)


def test_no_number_without_its_standing():
    """Every input of every row says where it comes from, and no other input exists."""
    for row in measurements.rows():
        assert all((row.source, row.conditions, row.means, row.inputs)), row.name
        for one in row.inputs:
            assert all((one.what, one.value)), (row.name, one)
            assert one.standing in STANDINGS, (row.name, one)
        for one in row.statements:
            assert one.claim.standing in {*STANDINGS} - {CHOSEN}, row.name
            assert one.claim.rule or one.undecided, (row.name, one.claim.id)


@pytest.mark.parametrize(
    ("row", "claim", "low", "high"),
    [
        # by hand: the limit of a fully plastic contact, a plate, a Gaussian tail, Mikic's 0.95
        ("jamari2006", "pressure", 1.0, 1.0),
        ("backside_particles", "width", 8.0e-3, 10.8e-3),
        ("thomas1972", "exponent", 0.94, 0.99),
        ("elastic_area", "area-0.01", 0.70, 0.71),
        ("elastic_area", "area-0.1", 0.61, 0.63),
        ("williamson1956", "manner", 1.0, 1.0),
    ],
)
@whole
def test_predictions(done, row, claim, low, high):
    band = done.ledger[row][claim].band
    assert low <= band.low * (1 + 1e-9)
    assert band.high * (1 - 1e-9) <= high


@pytest.mark.slow
@pytest.mark.parametrize("coefficients", trezona1999.COEFFICIENTS)
def test_the_load_of_a_particle_decides_whether_it_rolls(coefficients):
    """Where a tenth rolls the load on particles over their number is the same at both loads.

    The whole load over their number is not, as asperities carry 7 % of the lower one there.
    """
    loads = [
        pressure * share / density
        for pressure in trezona1999.PRESSURES
        for density, share in [trezona1999.turning(pressure, coefficients)]
    ]
    assert loads[1] / loads[0] == pytest.approx(1, abs=0.01)


@whole
def test_the_sharpest_change_of_one_size_is_at_its_cross_section(done):
    """At the load of one that is closed in, over the hardness of the steel."""
    surfaces, dust = tb.MaterialPair(STEEL, STEEL), tb.materials["Al2O3"]
    one = tb.particle.Series().single(1.0, 0.0, surfaces=surfaces, particle=dust)
    sharpest = float(one["force"]) / (STEEL.H * np.pi / 4)
    found = done.ledger["williamson1956"]["threshold"].band.low
    # its load rises by a fifth only while the last third of it is closed in
    assert 0.75 * sharpest < found < 1.03 * sharpest


def test_a_band_is_met_lost_or_undecided():
    def judged(*values, undecided=""):
        one = statement(
            "a",
            "x",
            STANDINGS[0],
            "q",
            {"kind": "range", "value": [1.0, 2.0]},
            lambda: Band.from_values(values),
            undecided=undecided,
        )
        return one.judge().word

    assert judged(1.1, 1.9) == "met"
    assert judged(0.5, 0.9) == "lost"
    assert judged(2.1, 3.0) == "lost"
    assert judged(0.9, 1.5) == "undecided"
    assert judged(0.5, 3.0) == "undecided"
    assert judged(1.5, undecided="circular") == "undecided"


@whole
def test_the_ledger_is_whole(done):
    found = json.loads((done.out / "measurements.json").read_text("utf-8"))
    assert sum(found["totals"].values()) == len(found["measurements"]) == len(VERDICTS)
    for row in found["measurements"]:
        for one in row["statements"]:
            assert one["verdict"] in WORDS
            assert one["predicted"] is None or len(one["predicted"]) == 3
    assert all((done.out / name).stat().st_size > 0 for name in done.files)


@whole
def test_the_summary_counts(done):
    text = "\n".join(done.lines())
    assert "15 measurements: 6 lost, 9 undecided, 0 met; 2 computations: 1 lost, 0 und" in text


def test_a_preset_is_refused(tmp_path):
    with refuses(Mistake.IDLE, "preset", value="'a'"):
        measurements.reproduce(tmp_path, preset="a")
