"""The study of Horng et al. 2022: its data, its ledger, its files."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import thirdbody
from thirdbody import InvalidValue
from thirdbody.papers.horng2022 import PANELS, READINGS, Curves, claims, reproduce, score, study
from thirdbody.papers.horng2022.measures import (
    MEASURES,
    critical_load_1,
    critical_load_2,
    interior_peak_of,
)
from thirdbody.papers.horng2022.readings import LOADS, RANGE, Curve
from thirdbody.papers.ledger import Claim, Measurement, data_of

EXPECTED = {"published": 66, "window": 60, "window_E2": 57, "all_terms": 56, "literal": 35}
"""Totals of the search that found the presets, on an independent implementation."""
EXPECTED_AS_THE_PAPER_BOOKS = {"series-offset": 56, "series-plane": 33, "series-rough": 35}
"""The same search took the area under every particle as F_sa/H_s, also in the consistent model."""
OWN_AREAS = {"series-offset": 49, "series-plane": 20, "series-rough": 25}
"""With the areas of the consistent model itself."""

BOOK = json.loads((Path(thirdbody.__file__).parent / "data" / "verdicts.json").read_text("utf-8"))

PUBLISHED_FAILS = {
    *("F3-04", "F3-12raw", "F3-15", "F4-02", "F4-03", "F5-06", "F6-03", "F8-03", "F9-03"),
    *("F9-06", "F12-03", "F12-04", "F12-06", "F12-07", "F12-08", "F12-09", "C-4", "C-5"),
}


@pytest.fixture(scope="session")
def verdicts():
    """Every reading scored once in a process."""
    return {name: score(Curves(reading)) for name, reading in READINGS.items()}


def total(scored):
    return sum(verdict.is_pass for verdict in scored.values())


# ------------------------------------------------------------------ data
def test_the_claims_are_84_and_each_can_be_measured():
    every = claims()
    assert len(every) == len({claim.id for claim in every}) == 84
    for claim in every:
        assert claim.measure == "all_of" or claim.measure in MEASURES, claim.id
        low, high = claim.interval()
        assert low < high, claim.id
        assert claim.statement
        assert claim.rule_words


def test_no_measure_is_left_over():
    named = {claim.measure for claim in claims()}
    named |= {claim.inputs["measure"] for claim in claims() if "measure" in claim.inputs}
    assert set(MEASURES) <= named


def test_conflicting_claims_exist():
    known = {claim.id for claim in claims()}
    assert all(set(claim.conflicts) <= known for claim in claims())


def test_loads_named_in_the_claims_lie_on_the_grid():
    def loads(inputs):
        for key in ("load", "at", "loads"):
            yield from np.atleast_1d(inputs.get(key, []))

    for claim in claims():
        for load in loads(claim.inputs):
            assert np.min(np.abs(LOADS / load - 1)) < 0.03, (claim.id, load)


@pytest.mark.parametrize(
    ("rule", "good", "bad"),
    [
        ({"kind": "factor", "value": 2e-6, "of": 1.5}, [1.34e-6, 2.99e-6], [1.3e-6, 3.1e-6]),
        ({"kind": "absolute", "value": 1.0, "of": 0.03}, [0.98, 1.02], [0.96, 1.04]),
        ({"kind": "relative", "value": -2.0, "of": 0.1}, [-2.1], [-2.3, -1.7]),
        ({"kind": "range", "value": [1, 2], "slack": 0.5}, [0.6, 2.4], [0.4, 2.6]),
        ({"kind": "range", "value": [1, 2], "of": 2}, [0.6, 3.9], [0.4, 4.1]),
        ({"kind": "below", "value": 1.0}, [0.999], [1.0]),
        ({"kind": "at_most", "value": 1.0}, [1.0], [1.001]),
        ({"kind": "above", "value": 1.0}, [1.001], [1.0]),
        ({"kind": "at_least", "value": 1.0}, [1.0], [0.999]),
    ],
)
def test_rules(rule, good, bad):
    claim = Claim("T", "", "", "", "", {}, "", rule)
    assert all(claim.judge(Measurement.from_values(value)).word == "pass" for value in good)
    assert all(claim.judge(Measurement.from_values(value)).word == "fail" for value in bad)
    assert claim.judge(Measurement.absent("none")).word == "not reproduced"
    assert claim.judge(Measurement.from_values(float("inf"))).word == "not reproduced"


# ------------------------------------------------------------------ what a curve says
def curve_with(share):
    """A curve with a given particle share of area at `LOADS`."""
    ones = np.ones_like(LOADS)
    columns = dict.fromkeys(("A_e", "A_ep", "A_p", "d", "d_star", "load_share"), ones)
    return Curve(F=LOADS, A_t=ones, A_ss=1 - share, A_sa=share, **columns)


def test_critical_loads_of_a_known_curve():
    # share = 1 / (1 + (F/F0)^3): 0.98 at F0 49^(-1/3), 0.05 at F0 19^(1/3)
    curve = curve_with(1 / (1 + (LOADS / 1e-5) ** 3))
    assert critical_load_1(curve) == pytest.approx(1e-5 * 49 ** (-1 / 3), rel=1e-3)
    assert critical_load_2(curve) == pytest.approx(1e-5 * 19 ** (1 / 3), rel=1e-3)
    assert interior_peak_of(curve, turns=False) is None


def test_critical_loads_that_do_not_exist():
    assert np.isnan(critical_load_1(curve_with(np.full_like(LOADS, 0.5))))
    assert np.isinf(critical_load_1(curve_with(np.full_like(LOADS, 0.99))))
    assert np.isinf(critical_load_2(curve_with(np.full_like(LOADS, 0.5))))
    assert critical_load_2(curve_with(np.zeros_like(LOADS))) == RANGE[0]


def test_turning_point_of_a_known_curve():
    hump = np.exp(-(np.log(LOADS / 3e-6) ** 2))
    load, height = interior_peak_of(curve_with(0.4 * hump), turns=True)
    assert load == pytest.approx(3e-6, rel=1e-3)
    assert height == pytest.approx(0.4, rel=1e-3)
    slight = curve_with(0.4 + 0.01 * hump)
    assert interior_peak_of(slight, turns=True) is None
    assert interior_peak_of(slight, turns=False)[0] == pytest.approx(3e-6, rel=1e-3)


# ------------------------------------------------------------------ readings
def test_datum_of_the_imitation():
    """A seat 3.16 σ + 0.6 x_a above a plane one σ below the mean asperity height."""
    law = READINGS["series-offset"].law(100e-9, 300e-9)
    assert law.h_0 == pytest.approx(2.16 * 100e-9 + 0.6 * 300e-9)


def test_separations_share_one_datum_within_a_reading():
    """Without particles d counts from the reading's datum: one σ more than from the asperities."""
    at_sigma = Curves(READINGS["window"]).two_body(100)
    at_zero = Curves(replace(READINGS["window"], datum=0.0)).two_body(100)
    np.testing.assert_allclose(at_sigma.d_star - at_zero.d_star, 1.0, rtol=1e-12)


def test_the_scale_of_loads_is_converted_at_the_door():
    one, two = READINGS["series-rough"], replace(READINGS["series-rough"], F_star_scale=2.0)
    a = Curves(one).curve_under(np.array([2e-5]), "SiO2", 100, 300)
    b = Curves(two).curve_under(np.array([1e-5]), "SiO2", 100, 300)
    np.testing.assert_allclose(a.A_t, b.A_t, rtol=1e-12)


def test_the_paper_s_booking_leaves_loads_and_asperities_alone():
    own = Curves(READINGS["series-rough"])("SiO2", 100, 300)
    booked = Curves(replace(READINGS["series-rough"], paper_booking=True))("SiO2", 100, 300)
    np.testing.assert_allclose(booked.A_ss, own.A_ss, rtol=1e-10)
    np.testing.assert_allclose(booked.load_share, own.load_share)
    np.testing.assert_allclose(booked.A_t, booked.A_e + booked.A_ep + booked.A_p, rtol=1e-12)
    assert np.all(booked.A_sa < own.A_sa)  # the mean pressure cannot exceed the hardness
    E_ss, H = 111.9e9, 5e9
    expected = own.load_share * own.F * E_ss / H
    np.testing.assert_allclose(booked.A_sa, expected, rtol=1e-3)


def test_shares_add_up_in_every_reading():
    for reading in READINGS.values():
        curve = Curves(reading)("SiO2", 100, 300)
        np.testing.assert_allclose(curve.asperity_share + curve.particle_share, 1, rtol=1e-12)
        regimes = sum(curve.share(name) for name in ("e", "ep", "p"))
        np.testing.assert_allclose(regimes, 1, rtol=1e-10)


# ------------------------------------------------------------------ totals
@pytest.mark.spread(3)
@pytest.mark.parametrize("name", EXPECTED)
def test_totals_of_the_printed_equations(verdicts, name):
    assert abs(total(verdicts[name]) - EXPECTED[name]) <= 3


@pytest.mark.parametrize("name", EXPECTED_AS_THE_PAPER_BOOKS)
def test_totals_of_the_consistent_model_as_the_paper_books_areas(name):
    scored = score(Curves(replace(READINGS[name], paper_booking=True)))
    assert abs(total(scored) - EXPECTED_AS_THE_PAPER_BOOKS[name]) <= 3


@pytest.mark.parametrize("name", OWN_AREAS)
def test_totals_of_the_consistent_model(verdicts, name):
    assert abs(total(verdicts[name]) - OWN_AREAS[name]) <= 1


def test_totals_that_the_book_states(verdicts):
    stored = dict(BOOK["horng2022"])
    assert stored.pop("statements") == len(claims())
    assert stored == {name: total(scored) for name, scored in verdicts.items()}


def test_the_best_reading_fails_what_it_is_known_to_fail(verdicts):
    failed = {name for name, verdict in verdicts["published"].items() if not verdict.is_pass}
    assert failed == PUBLISHED_FAILS


def test_how_many_claims_the_adjusted_readings_share(verdicts):
    adjusted = [verdicts[name] for name in ("published", "window", "window_E2", "all_terms")]
    passed = [[scored[claim.id].is_pass for scored in adjusted] for claim in claims()]
    assert (sum(map(all, passed)), sum(map(any, passed))) == (43, 75)


def test_the_printed_equations_never_meet_conflicting_claims(verdicts):
    pairs = {tuple(sorted((c.id, other))) for c in claims() for other in c.conflicts}
    assert len(pairs) == 6
    for name in EXPECTED:
        for one, other in pairs:
            both = verdicts[name][one].is_pass and verdicts[name][other].is_pass
            assert not both, (name, one, other)


@pytest.mark.parametrize(
    ("reading", "claim", "value", "within"),
    [
        # closed form of the saturation load, η_a f(x_a)(1 + s²)/E_ss, where F_cr1 tends to
        ("window", "F3-08", 9.37e-6, 0.03),
        ("window", "F3-20", 3.50e-6, 0.03),
        ("window", "F4-04", 1.04e-4, 0.05),
        ("published", "F12-02", 5.80, 0.01),
        ("published", "F12-05", 8.73, 0.01),
        ("published", "F3-12", 0.973, 0.001),
        ("published", "C-6", 0.55, 0.01),
        ("series-offset", "F12-05", 8.68, 0.01),
        ("series-offset", "F6-02", 2.0e-6, 0.06),
    ],
)
def test_values(verdicts, reading, claim, value, within):
    assert verdicts[reading][claim].measured.values[0] == pytest.approx(value, rel=within)


# ------------------------------------------------------------------ files
@pytest.fixture(scope="module")
def made(tmp_path_factory):
    stages = []
    folder = tmp_path_factory.mktemp("horng2022") / "new"
    summary = reproduce(folder, progress=lambda *step: stages.append(step))
    return folder, summary, stages


@pytest.mark.slow
def test_every_file_is_written(made):
    folder, summary, _ = made
    expected = {f"fig{name}.{kind}" for name in PANELS for kind in ("png", "svg", "csv")}
    expected |= {"claims.json", "index.html"}
    assert {path.name for path in folder.iterdir()} - {"study.json"} == expected
    assert expected == set(summary.files)
    assert len(PANELS) == 20
    for name in PANELS:
        assert (folder / f"fig{name}.png").read_bytes().startswith(b"\x89PNG")
        rows = (folder / f"fig{name}.csv").read_text().splitlines()
        assert rows[0].startswith("material,")
        assert len(rows) > 8


@pytest.mark.slow
def test_the_ledger_file(made):
    folder, summary, _ = made

    def refuse(word):
        raise AssertionError(f"{word} is not JSON")

    data = json.loads((folder / "claims.json").read_text("utf-8"), parse_constant=refuse)
    assert [claim["id"] for claim in data["claims"]] == [claim.id for claim in claims()]
    for name in READINGS:
        words = [claim["results"][name]["verdict"] for claim in data["claims"]]
        assert set(words) <= {"pass", "fail", "not reproduced"}
        assert words.count("pass") == data["readings"][name]["passed"] == summary.totals[name]
    assert data["errata"] == data_of("horng2022")["errata"]


@pytest.mark.slow
def test_the_page_needs_nothing_else(made):
    page = (made[0] / "index.html").read_text("utf-8")
    assert not re.search(r"https?:|//[a-z]|<script|<link|@import|url\(", page)
    assert set(re.findall(r"src='([^,]*),", page)) == {"data:image/svg+xml;base64"}
    assert page.count("<figure ") == 20
    assert all(f"id='{claim.id}'" in page for claim in claims())


@pytest.mark.slow
def test_progress_and_summary(made):
    _, summary, stages = made
    assert {stage for stage, _, _ in stages} == {"claims", "figures", "page"}
    assert all(0 <= done <= all_ for _, done, all_ in stages)
    text = "\n".join(summary.lines())
    assert "66 of 84" in text
    assert "index.html" in text


@pytest.mark.slow
def test_the_same_bytes_again(made, verdicts, tmp_path, monkeypatch):
    """The numbers are those scored above; two panels and the page around them, twice."""
    folder, summary, _ = made
    assert summary.ledger.verdicts == verdicts
    some = {name: PANELS[name] for name in ("5", "12a")}
    monkeypatch.setattr(study, "PANELS", some)
    monkeypatch.setattr(study, "keep_ledger", lambda *_: summary.ledger)
    for again in ("one", "two"):
        reproduce(tmp_path / again)
    for path in (tmp_path / "one").iterdir():
        same = (tmp_path / "two" / path.name).read_bytes()
        assert path.read_bytes() == same, path.name
        assert path.name == "index.html" or same == (folder / path.name).read_bytes(), path.name


def test_an_unknown_preset_is_refused(tmp_path):
    with pytest.raises(InvalidValue, match="series-rough"):
        reproduce(tmp_path / "x", preset="guess")
    assert not (tmp_path / "x").exists()


def test_a_file_where_the_folder_should_be(tmp_path):
    (tmp_path / "x").write_text("")
    with pytest.raises(InvalidValue, match="folder"):
        reproduce(tmp_path / "x")


@pytest.mark.parametrize("name", ["9a", "9b", "12b"])
def test_panels_of_every_reading_can_be_drawn(name):
    from thirdbody.papers.horng2022.drawing import draw

    for reading in ("literal", "series-plane"):
        draw(PANELS[name](Curves(READINGS[reading]))).canvas.draw()


@pytest.mark.parametrize("name", ["5", "9a", "9b", "12a"])
@pytest.mark.parametrize("reading", ["published", "series-plane"])
def test_the_legend_names_what_is_drawn_and_nothing_else(name, reading):
    from thirdbody.papers.horng2022.drawing import draw

    panel = PANELS[name](Curves(READINGS[reading]))
    figure = draw(panel)
    (legend,) = figure.legends
    held = [text.get_text() for text in legend.get_texts()]
    seen = {line.by for line in panel.lines if np.isfinite(line.ys[0]).any()} - {0}
    every = {line.by for line in panel.lines} - {0}
    assert {by for by in every if f"{by:g}" in held} == seen
    # points of the paper: their numbers are in the legend, and none lies in the picture
    assert not figure.axes[0].texts or not seen or panel.name == "5"
    for mark in panel.marks:
        if mark.y is not None:
            (label,) = [text for text in held if text.startswith(f"{mark.label}: ")]
            mantissa = f"{mark.y:.2e}".split("e")[0] if panel.ylog else f"{mark.y:g}"
            assert f"{float(mantissa):g}" in label


@pytest.mark.parametrize("name", ["3a", "3b", "5", "6b", "9a", "9b", "10c", "12a"])
def test_what_the_paper_quotes_is_told_apart_in_the_legend(name):
    """By its form, its colour, or its number."""
    from matplotlib.lines import Line2D

    from thirdbody.papers.horng2022.drawing import draw

    (legend,) = draw(PANELS[name](Curves(READINGS["series-plane"]))).legends
    labels = [text.get_text() for text in legend.get_texts()]
    looks = {}
    for handle, label in list(zip(legend.legend_handles, labels, strict=True))[
        labels.index("quoted in the paper") + 1 :
    ]:
        if isinstance(handle, Line2D):
            look = handle.get_marker(), handle.get_linestyle(), handle.get_color()
            looks.setdefault(look, []).append(label)
    for alike in looks.values():
        assert len(alike) == 1 or all(r"\times10" in label for label in alike)
    assert all(len(alike) == 1 for look, alike in looks.items() if look[0] in {"x", "+"})
