"""The comparison with particles at their places: its cases, its reasons, and its short form."""

import csv
import dataclasses
import importlib
import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
from refusals import balances_not

import thirdbody as tb
from thirdbody.explicit.bodies import LawTable
from thirdbody.explicit.seats import SEATS, seats_named
from thirdbody.papers import PAPERS, explicit, seats
from thirdbody.papers.explicit import bump, page
from thirdbody.papers.explicit.cases import GROUPS
from thirdbody.papers.explicit.compared import Effort, Point
from thirdbody.papers.explicit.one_field import against_stored

DOCS = Path(__file__).parents[2] / "docs"
SMALL = Effort(surfaces=3, size=64, spacing=300e-9, loads=(3e-4, 1e-3))
NAMES = ("x1", "bump1")


@pytest.fixture
def few(monkeypatch):
    """Two cases on very small maps."""
    monkeypatch.setattr(page, "CASES", [c for c in explicit.CASES if c.name in NAMES])
    monkeypatch.setitem(page.PRESETS, "quick", SMALL)


def test_it_is_one_of_the_studies():
    assert "explicit" in PAPERS
    names = [case.name for case in explicit.CASES]
    assert len(set(names)) == len(names)
    assert {case.group for case in explicit.CASES} == set(GROUPS)


def test_what_varies():
    """Spectra, hardness, spread, density and seats of the comparison are those it names."""
    by = {case.name: case.contact for case in explicit.CASES}
    assert by["x1"] == seats.contact(300e-9)
    assert {by[f"alpha{a}_x1"].roughness.alpha for a in (4, 15)} == {4.0, 15.0}
    assert by["soft_x1"].surfaces.H / by["soft_x1"].E_ss == pytest.approx(0.018)
    one, two = by["unequal_x1"].surfaces.first.H, by["unequal_x1"].surfaces.second.H
    assert two == 2 * one
    dense = [by[f"density{p}"].populations[0].areal_density for p in (9, 10, 12)]
    assert dense == [1e9, 1e10, 1e12]
    assert by["spread1.6"].populations[0].diameter == tb.LogNormal(median=300e-9, gsd=1.6)
    rules = {type(seats_named(case.seats)) for case in explicit.CASES}
    assert rules == set(SEATS.values())


@pytest.mark.slow
def test_a_run_writes_what_it_says_and_goes_on(few, tmp_path, monkeypatch):
    done = explicit.reproduce(tmp_path, preset="quick")
    assert {file.name for file in tmp_path.iterdir()} == {*done.files, "surfaces", "study.json"}
    told = json.loads((tmp_path / "comparison.json").read_text("utf-8"))
    assert [state["case"] for state in told["states"]] == ["x1", "x1", "bump1", "bump1"]
    assert told["left_out"] == 0
    with (tmp_path / "comparison.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for row, state in zip(rows, told["states"], strict=True):
        assert float(row["share"]) == pytest.approx(state["share"], rel=1e-5)
    before = {name: (tmp_path / name).read_bytes() for name in done.files}

    def never(*_, **__):
        raise AssertionError("a finished surface was pressed again")

    monkeypatch.setattr("thirdbody.explicit.sums.curve", never)
    explicit.reproduce(tmp_path, preset="quick")
    assert {name: (tmp_path / name).read_bytes() for name in done.files} == before
    assert any("nothing fitted" in line for line in done.lines())


def test_another_preset_is_refused(tmp_path):
    with pytest.raises(tb.errors.InvalidValue, match="must be 'full' or 'quick'"):
        explicit.reproduce(tmp_path, preset="fast")


# ---------------------------------------------------------------- why
POINT = Point(
    case=explicit.CASES[0], F_star=1e-4, raw=(0.5, 0.02), share=(0.5, 0.01), statistical=0.56,
    h=(3.0, 0.01), h_statistical=3.0, area=(2e-3, 1e-5), area_statistical=2e-3,
    ratios={
        "bare_over_bearing": 0.66, "particles_over_sum": 0.8,
        "asperities_with_over_without": 0.97, "bearing_over_gaussian": 1.0,
    },
    model_bare=0.66, surfaces=8, zeta=(0.0, 1.0), stored=None,
)  # fmt: skip


def test_reasons_stand_in_the_order_of_their_size():
    assert POINT.is_off
    assert POINT.errors == pytest.approx(6)
    assert re.findall(r"\d+ %", POINT.why) == ["80 %", "97 %"]


def test_the_fewer_surfaces_the_wider_what_counts_as_luck():
    """Within 6 errors of three surfaces lies what 95 of 100 draws do not reach at 2.3 of eight."""
    at = dataclasses.replace(POINT, statistical=0.53)
    assert at.is_off
    assert not dataclasses.replace(at, surfaces=3).is_off
    assert not dataclasses.replace(at, statistical=0.52).is_off
    assert dataclasses.replace(at, statistical=0.52).why == ""


def test_where_too_little_was_drawn_the_bounds_are_shown():
    """Neither "100" without an error nor a number of 0/0; off is what lies outside."""
    nothing = (math.nan, math.nan)
    point = dataclasses.replace(POINT, share=nothing, bounds=(0.9761, 1.0), statistical=0.983)
    assert not point.is_off
    assert dataclasses.replace(point, statistical=0.97).is_off
    assert math.isnan(point.difference)
    record = {**page._columns(point), "off": point.is_off}
    cells = {name: None if v != v else v for name, v in record.items()}
    assert page._cell(cells) == "≥ 97.6, 98.3"
    assert page._cell(cells | {"share_least": 0.0, "share_most": 0.0123}) == "≤ 1.3, 98.3"
    assert page._cell(cells | {"share_most": 0.99}) == "97.6 to 99.0, 98.3"
    row = page._row(point, False)
    assert "≥ 97.6 %" in row[3]
    assert "within" in row[5]
    drawn = page.figure((point, dataclasses.replace(POINT, F_star=1e-3)))
    ends = [0.983 / 0.9761, 0.983]
    bars = [line for line in drawn.axes[0].lines if line.get_marker() == "_"]
    assert sum(list(bar.get_ydata()) == pytest.approx(ends) for bar in bars) == 1


# ---------------------------------------------------------------- a bump
def test_no_law_is_made_of_a_load_that_is_not_solved(monkeypatch):
    whole = bump.press
    monkeypatch.setattr(bump, "press", lambda *of, **how: whole(*of, **how | {"max_iterations": 2}))
    with balances_not(None, says="E*/H = 77"):
        bump.table.__wrapped__(77.0)


def test_a_bump_begins_as_hertz_says():
    """Radius x/4 on the composite half-space; the load of a map holds it to its grid."""
    eps, load, _ = bump.table(112 / 5)
    hertz = 4 / 3 * (112 / 5) * 0.5 * eps**1.5
    assert load[0] == pytest.approx(hertz[0], rel=0.02)
    assert np.all(np.diff(eps) > 0)


def test_a_bump_ends_embedded():
    body = seats.contact(300e-9).surfaces
    law = bump.BumpLaw().one(surfaces=body, particle=body.first)
    told = LawTable(law)
    assert told.limit == pytest.approx(math.pi / 4 * body.H, rel=1e-9)
    eps = np.geomspace(1e-5, 0.9, 400)
    load = law.at(eps).load
    assert np.all(np.diff(load) >= 0)
    # where all of it yields, the load is hardness times area
    deep = law.at(np.array([0.3]))
    assert deep.load / body.H == pytest.approx(deep.areas[0], rel=0.01)


def test_a_bump_carries_less_than_the_law_where_it_yields():
    """The law of the library reaches the hardness sooner: the known difference of the stored runs."""
    body = seats.contact(300e-9).surfaces
    eps = np.linspace(0.1, 0.5, 9)
    ours = tb.particle.Series(deep="off").one(surfaces=body, particle=body.first).at(eps).load
    theirs = bump.BumpLaw().one(surfaces=body, particle=body.first).at(eps).load
    assert np.all((ours / theirs > 1.02) & (ours / theirs < 1.16))


@pytest.mark.slow
def test_the_short_form(tmp_path, monkeypatch):
    """No state fails, and the shares that the model states agree within the short form's errors.

    Every second case, and all that the model states shares of.
    """
    cases = [case for i, case in enumerate(explicit.CASES) if i % 2 == 0 or case.group == "sizes"]
    monkeypatch.setattr(page, "CASES", cases)
    done = explicit.reproduce(tmp_path, preset="quick")
    assert set(done.lost) <= {"debris"}  # soft and deep, it runs away
    assert len(done.points) == sum(len(case.loads) or 2 for case in cases)
    for point in done.points:
        # too few surfaces may leave a share without an error, or unknown between bounds: there is
        # nothing to hold it to then
        assert 0 <= point.share[0] <= 1 or math.isnan(point.share[0])
        if point.case.group == "sizes" and math.isfinite(point.share[1]):
            stated = seats.STATED_AGREEMENT[round(point.case.diameter, 12)]
            allowed = stated * point.share[0] + 4.3 * point.share[1]
            assert abs(point.statistical - point.share[0]) < allowed, point.case.name


# ---------------------------------------------------------------- what is kept
def test_the_record_is_of_these_cases():
    """Its states in their order, and the reasons that their numbers give."""
    kept = seats.comparison()
    assert list(dict.fromkeys(s["case"] for s in kept)) == [c.name for c in explicit.CASES]
    words = {case.name: case.words for case in explicit.CASES}
    assert all(state["what"] == words[state["case"]] for state in kept)
    loads = {case.name: case.loads or explicit_loads() for case in explicit.CASES}
    for name, wanted in loads.items():
        assert [s["F_star"] for s in kept if s["case"] == name] == pytest.approx(wanted)


def explicit_loads():
    return page.PRESETS["full"].loads


@pytest.mark.parametrize("name", ["x2", "x067", "soft_x1", "spread1.6", "density12_x1"])
def test_the_record_has_the_numbers_of_the_model(name):
    (case,) = [c for c in explicit.CASES if c.name == name]
    kept = [state for state in seats.comparison() if state["case"] == name]
    law = case.contact.particle_law.replace(
        zeta_mean=kept[0]["zeta_mean"], zeta_std=kept[0]["zeta_std"]
    )
    state = tb.solve(
        case.contact.replace(particle_law=law), F_star=[each["F_star"] for each in kept]
    )
    told = [each["share_statistical"] for each in kept]
    assert state.particle_load_share == pytest.approx(told, rel=1e-6)


@pytest.mark.check
@pytest.mark.parametrize("name", ["x1", "chi0.7_alpha5", "chi0.4_alpha15"])
def test_the_record_has_the_numbers_of_one_field(name):
    kept = [state for state in seats.comparison() if state["case"] == name]
    found = against_stored(cases=[name])
    assert [s.share[2] for s in found] == pytest.approx([k["share_field"] for k in kept], rel=1e-6)
    assert [s.h[2] for s in found] == pytest.approx(
        [k["h_over_sigma_field"] for k in kept], rel=1e-6
    )


def test_the_law_of_a_bump_explains_the_earlier_runs():
    """As the book says: eight of nine shares within two of both errors, five without that law."""
    within = dict.fromkeys(("sizes", "bumps"), 0)
    for state in seats.comparison():
        if state["share_stored"] is not None and state["share_error"] is not None:
            error = math.hypot(state["share_error"], state["share_stored_error"])
            within[state["group"]] += abs(state["share"] - state["share_stored"]) < 2 * error
    assert within["bumps"] == 8
    assert within["sizes"] < within["bumps"]


def test_the_book_shows_the_record(monkeypatch):
    """The page as the book is built from it: every state in its cell, and what its words count."""
    monkeypatch.syspath_prepend(str(DOCS / "_ext"))
    facts, pages = (importlib.import_module(name) for name in ("facts", "pages"))
    text = facts.insert_facts((DOCS / "explicit-evidence.md").read_text("utf-8"), "the page")
    text = pages.insert_generated(text)
    assert "{generated}" not in text
    assert "{{" not in text
    whole, tables = " ".join(text.split()), text.split("## Every state\n")[1]
    cells = {}
    for table in re.findall(r"(?:^\|.*\|$\n?)+", tables, re.M):
        head, _, *rows = (line.strip("| ").split(" | ") for line in table.splitlines())
        cells |= {
            (head[0], row[0], load): cell
            for row in rows
            for load, cell in zip(head[1:], row[1:], strict=True)
        }
    assert len(cells) == len(seats.comparison())
    for state in seats.comparison():
        load = f"F* = {state['F_star']:.0e}".replace("e-0", "e-")
        cell = cells[GROUPS[state["group"]], state["what"], load]
        numbers = [float(each) for each in re.findall(r"\d+\.?\d*", cell)]
        known = [state["share_statistical"], state["share_field"]]
        known += [state["share"]] if state["share_least"] is None else []
        for share in known:
            assert min(abs(100 * share - each) for each in numbers) < 0.5, (state["case"], cell)
        assert ("**" in cell) == state["off"], (state["case"], cell)
    # what the words say is of the record, too
    every = [state for state in seats.comparison() if state["share"]]
    too_high = {
        group: [s["share_statistical"] / s["share"] - 1 for s in every if s["group"] == group]
        for group in ("loads", "hard")
    }
    low, high = (round(100 * each) for each in (min(too_high["loads"]), max(too_high["loads"])))
    assert f"the share is {low} to {high} % high, and the surfaces are" in whole
    steep = [s for s in every if s["group"] == "hard" and "α = 15" not in s["what"]]
    off = sorted(round(100 * (s["share_statistical"] / s["share"] - 1)) for s in steep)
    assert f"it is {off[0]} to {off[-1]} % high, from a real area of" in whole
    deep = max(s["share_statistical"] / s["share"] for s in every if s["case"] == "valleys") - 1
    assert f"The model is up to {100 * deep:.0f} % high." in whole
    area = min(
        s["A_t"] / s["A_t_statistical"] for s in every if s["group"] not in {"hard", "debris"}
    )
    assert f"pressed area is up to {100 * (1 - area):.0f} % lower" in whole


def test_where_the_model_may_be_trusted():
    """What the book says of its load shares, with the errors of the record."""

    def apart(state):
        ratio = state["share_statistical"] / state["share"] - 1
        return abs(ratio) - 2 * (state["share_error"] or 0) / state["share"]

    for state in seats.comparison():
        group, name = state["group"], state["case"]
        if state["share_least"] is not None:
            assert not state["off"], name
            continue
        field = abs(state["share_field"] / state["share"] - 1)
        if group == "debris":  # open: neither law
            assert abs(state["share_statistical"] / state["share"] - 1) < 0.08
            assert field < 0.11
            continue
        if group == "hard":
            assert field < 0.065, name
            assert abs(state["h_over_sigma_field"] - state["h_over_sigma"]) < 0.0145, name
            off = state["share_statistical"] / state["share"] - 1
            assert 0.23 < off < 0.44 or name == "chi0.4_alpha15", name
            assert 0.04 < state["h_over_sigma"] - state["h_over_sigma_statistical"] < 0.72, name
            continue
        if group == "loads":
            assert 0.07 < apart(state) < 0.22, name
            assert 0.035 < state["h_over_sigma"] - state["h_over_sigma_statistical"] < 0.65
            continue
        most = 0.05
        most = 0.11 if name in ("x067", "bump067") else most
        most = 0.135 if name == "soft_x1" else most  # 13 % in the book
        most = 0.08 if group == "spectra" else most
        most = 0.23 if name == "valleys" else most
        assert apart(state) < most, (name, state["F_star"])
