"""``thirdbody design`` of an oil: the smallest filter for a code, the longest time to an event."""

import json
import tomllib
from pathlib import Path

import numpy as np
import pytest
from command_line import refused

import thirdbody as tb
from thirdbody.errors import Mistake
from thirdbody.study.run_life import load_oil, run_life
from thirdbody.study.run_life_design import design_life
from thirdbody.systems.life.oil_history import run_oil_history

from .life_shell import CONTACT, enter, run, said, study

FILTERS = """
[life.design]
code = "14/12/8"
[[life.design.filters]]
name = "coarse"
beta = { "4 um" = 1.2, "14 um" = 75 }
[[life.design.filters]]
name = "middle"
beta = { "4 um" = 5, "7 um" = 75 }
[[life.design.filters]]
name = "fine"
beta = { "4 um" = 75, "7 um" = 1000 }
"""
CHOICES = """
[life.until]
filter_full = true
[[life.design.choices]]
name = "as it is"
[[life.design.choices]]
name = "a larger filter"
"filters.0.capacity" = "100 g"
[[life.design.choices]]
name = "less oil"
"oil.volume" = "100 L"
"""


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    enter(tmp_path, monkeypatch)
    return tmp_path


def within(code, most):
    return all(int(a) <= int(b) for a, b in zip(code.split("/"), most.split("/"), strict=True))


def test_the_first_filter_that_is_enough_and_the_least_flow_of_each():
    file = study("oil-circuit", FILTERS)
    told = said(run("design", file))
    found = design_life(load_oil(file))
    enough = [name for name, code in zip(found.names, found.codes, strict=True)
              if within(code, "14/12/8")]  # fmt: skip
    assert found.best == enough[0] == "middle"
    assert f"Middle is the first of 3 enough for 14/12/8: the oil comes to {found.codes[1]}" in told
    # the flow is the least: a thousandth less is not enough
    asked = load_oil(file)
    coarse, *others = zip(asked.design.filters, found.flows, strict=True)
    # by its β ratios it takes nothing at 4 µm, whatever flows through it
    assert np.isnan(coarse[1])
    assert coarse[0].clipped_to > 5e-6
    for sheet, flow in others:
        for factor, reached in ((1.001, True), (0.999, False)):
            circuit = asked.circuit.replace(filters=sheet.replace(flow=factor * float(flow)))
            assert within(circuit.steady_code(), "14/12/8") is reached
    data = json.loads(run("design", file, "--json").stdout)
    assert data["best"] == "middle"
    assert data["choices"]["code"] == list(found.codes)
    assert data["choices"]["least_flow"] == [None, *map(pytest.approx, found.flows.tolist()[1:])]


def test_none_is_enough():
    file, key = study("oil-circuit", FILTERS), 'life.design.code="8/6/0"'
    found = design_life(load_oil(file, [key]))
    assert not any(within(code, "8/6/0") for code in found.codes)
    assert json.loads(run("design", file, "--set", key, "--json").stdout)["best"] is None
    assert found.best == ""


def test_the_choice_with_the_longest_time_to_an_event():
    file = study("oil-circuit", CHOICES)
    data = json.loads(run("design", file, "--json").stdout)
    assert data["best"] == "a larger filter"
    times = dict(zip(data["choices"]["name"], data["choices"]["time"], strict=True))
    asked = load_oil(file)
    for name, changes in {"a larger filter": {"filters.0.capacity": 0.1}, "less oil": {"volume": 0.1},
                          "as it is": {}}.items():  # fmt: skip
        history = run_oil_history(
            asked.circuit.replace(**changes), duration=7.2e6, until=(tb.oil.until.filter_full(),)
        )
        assert times[name] == pytest.approx(float(history.times[-1]), rel=1e-9)


def test_events_that_do_not_come_are_censored():
    file = study("oil-circuit", CHOICES)
    told = said(run("design", file, "--set", 'life.duration="500 h"'))
    assert "more than 500 h" in told.split("choice time")[1]
    data = json.loads(run("design", file, "--set", 'life.duration="500 h"', "--json").stdout)
    assert data["choices"]["time"][1] is None
    assert data["best"] == "a larger filter"
    short = ("--set", 'life.duration="10 h"')
    assert json.loads(run("design", file, *short, "--json").stdout)["choices"]["time"] == [None] * 3
    assert "life.duration" in said(run("design", file, *short)).split("10 h", 1)[1]


@pytest.mark.slow
def test_the_time_of_a_contact_is_that_of_its_history():
    """The depth that a history has after an hour is reached after an hour."""

    keys = ["life.oil.oil_changes=[]", 'life.duration="2 h"']
    contact = CONTACT.replace("f_roll = 0", "f_roll = 0.1") + "entry_ratio = 0.1\n"
    history = run_life(load_oil(study("oil-circuit", contact), keys)).history
    file = study("oil-circuit", contact + CHOICES.split("filter_full = true\n")[1])
    deepest = np.maximum(*(history.more[f"wear_{side}"][1] for side in (1, 2)))
    depth = float(np.interp(3600.0, history.times, deepest))
    asked = load_oil(file, [*keys, f'life.until.wear_depth="{depth!r} m"'])
    found = design_life(asked)
    assert found.times[0] == pytest.approx(3600.0, rel=1e-3)
    assert found.names[0] == tomllib.loads(CHOICES)["life"]["design"]["choices"][0]["name"]


MISTAKES = [
    (FILTERS.replace('code = "14/12/8"', ""), Mistake.CLASH, ""),
    (FILTERS.replace("14/12/8", "18"), Mistake.SHAPE, ".code"),
    (FILTERS.replace("4 um", "4 kg"), Mistake.UNIT, '.filters[0].beta."4 kg"'),
    (CHOICES.replace("filter_full = true", ""), Mistake.SHAPE, ".choices"),
    (
        CHOICES.replace("filters.0.capacity", "filters.7.capacity"),
        Mistake.UNKNOWN,
        '.choices[1]."filters.7.capacity"',
    ),
    (CHOICES.replace('"100 g"', '"100 m"'), Mistake.UNIT, '.choices[1]."filters.0.capacity"'),
    (CHOICES.replace('name = "less oil"', 'name = "as it is"'), Mistake.CLASH, ".choices"),
    (CHOICES.split('[[life.design.choices]]\nname = "a larger')[0], Mistake.SHAPE, ".choices"),
]


@pytest.mark.parametrize(("more", "code", "place"), MISTAKES)
def test_mistakes_get_one_sentence(more, code, place):
    done = refused("design", study("oil-circuit", more), "--csv", "a.csv")
    assert done.mistakes[0] == (code, f"life.design{place}")
    assert not Path("a.csv").exists()


def test_a_dry_contact_has_no_filters_to_choose():
    run("new", "dry-contact")
    done = run("design", "dry-contact.toml", "--set", 'life.design.code="14/12/8"')
    assert done.exit_code == 2
    assert done.mistakes == [(Mistake.CLASH, "life.dry")]


def test_an_empty_table_is_answered_with_examples():
    (problem,) = refused("design", study("oil-circuit", "[life.design]\n")).problems
    assert (problem.code, problem.place) == (Mistake.CLASH, "life.design")
    assert 'code = "16/14/11"' in problem
    assert "[[life.design.choices]]" in problem


def test_a_choice_says_that_beta_is_taken_as_constant():
    assert "beta ratios" in said(run("design", study("oil-circuit", FILTERS)))
