"""Bands of a life: ``thirdbody life`` and ``assess`` with [life.uncertainty], kept and resumed."""

import json
import math
import re
import warnings
from pathlib import Path

import numpy as np
import pytest
from command_line import refused

import thirdbody as tb
from thirdbody.errors import Mistake
from thirdbody.study import life_bands
from thirdbody.study.life_bands import propagate_dry, propagate_life
from thirdbody.study.life_kept import KeptEnds
from thirdbody.study.run_life import load_life, load_oil
from thirdbody.systems.life.loop import Loop
from thirdbody.views.life_words import words_of_bands

from .life_shell import CONTACT, HOUR, enter, run, said, study

OIL = """
[life.until]
iso4406 = "13/11/7"
[life.uncertainty]
ingress = { median = 1, gsd = 2 }
"oil.volume" = { low = "180 L", high = "220 L" }
"""
DRY = """
[life.until]
wear_depth = "100 nm"
[life.uncertainty]
arrivals = { median = 1, gsd = 3 }
"dry.loss" = { low = 0.1, high = 1 }
"""
SHORT = ["--set", 'life.duration="2 h"', "--set", "life.oil.oil_changes=[]"]


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    enter(tmp_path, monkeypatch)
    return tmp_path


@pytest.fixture(autouse=True)
def fewer(monkeypatch):
    """A quarter of the histories of oils."""
    monkeypatch.setattr(life_bands, "SAMPLES", 64)


@pytest.fixture
def few(monkeypatch):
    """Few histories of contacts: each takes a second."""
    monkeypatch.setattr(life_bands, "SAMPLES_OF_CONTACT", 4)


# ------------------------------------------------------------------------------ of an oil
@pytest.mark.check
def test_how_sure_an_oil_is_and_what_decides():
    file = study("oil-circuit", OIL)
    done = run("assess", file, *SHORT)
    assert done.exit_code == 0, done.stderr
    assert max(map(len, done.stdout.splitlines())) <= 80
    data = json.loads(run("assess", file, *SHORT, "--json").stdout)
    missed = data["missed"]["code 13/11/7"]
    assert 0 < missed < data["samples"] == 64
    assert data["reached"]["code 13/11/7"] == 1 - missed / 64
    assert data["swings"][0][0] == "ingress"
    assert data["times"]["code 13/11/7"][-1] is None  # censored


@pytest.mark.check
def test_censored_quantiles_are_those_of_what_is_known():
    """One exponential: with a factor on the start, the time to a count has a closed form."""
    quartz = tb.materials["quartz"]
    dirt = tb.oil.OilDirt.from_iso4406("18/16/13", material=quartz)
    oil = tb.oil.OilCircuit(volume=0.2, start=dirt, ingress=(),
                        filters=tb.oil.Filter(sizes=(4e-6,), betas=(1e9,), flow=1e-3))  # fmt: skip
    found = propagate_life(
        oil, vary={"volume": tb.Uncertain.uniform(low=0.1, high=0.3)}, duration=300.0,
        until=[tb.oil.until.iso4406("15/13/10")], samples=256,
    )  # fmt: skip
    one = propagate_life(
        oil, vary={"volume": tb.Uncertain.uniform(low=0.2, high=0.2000001)}, duration=1e4,
        until=[tb.oil.until.iso4406("15/13/10")], samples=64,
    )  # fmt: skip
    per_volume = one.times["code 15/13/10"][1] / 0.2  # time is proportional to the volume
    least = found.times["code 15/13/10"][0]
    assert least == pytest.approx(per_volume * 0.11, rel=0.02)
    assert math.isinf(found.times["code 15/13/10"][-1])
    assert found.reached["code 15/13/10"] == pytest.approx(
        (300.0 / per_volume - 0.1) / 0.2, abs=2 / 256
    )
    assert found.count_missed("code 15/13/10") == 256 - round(256 * found.reached["code 15/13/10"])


def test_an_event_that_never_comes_is_censored_throughout():
    oil = load_oil(study("oil-circuit", "")).circuit
    found = propagate_life(
        oil, vary={"ingress": tb.Uncertain.uniform(low=0.9, high=1.1)}, duration=60.0,
        until=[tb.oil.until.iso4406("28/26/24")], samples=16,
    )  # fmt: skip
    assert np.all(np.isinf(found.times["code 28/26/24"]))
    assert found.count_missed("code 28/26/24") == 16


IN_UNCERTAINTY = """
[life.until]
iso4406 = "13/11/7"
[uncertainty]
samples = 64
seed = 3
[uncertainty.inputs]
"roughness.sigma" = { low = "80 nm", high = "120 nm" }
"life.ingress" = { median = 1, gsd = 2 }
"life.oil.volume" = { low = "180 L", high = "220 L" }
"life.filters.0.beta.7 um" = { low = 40, high = 100 }
"""


@pytest.mark.check
def test_uncertainty_varies_a_life():
    """What [uncertainty] names of [life] is varied as in [life.uncertainty], β ratios too."""
    file = study("oil-circuit", IN_UNCERTAINTY)
    asked = load_oil(file, [SHORT[1], SHORT[3]])
    assert list(asked.uncertainty) == ["ingress", "volume", "filters.0.beta.7 um"]
    assert (asked.drawn.samples, asked.drawn.seed) == (64, 3)
    done = run("assess", file, *SHORT, "--json")
    assert done.exit_code == 0, done.stderr
    assert any('"roughness.sigma" ' in note for note in done.notes)
    data = json.loads(done.stdout)
    assert 0 < data["missed"]["code 13/11/7"] < data["samples"] == 64
    by_hand = propagate_life(
        asked.circuit, vary=asked.uncertainty, duration=2 * HOUR, samples=64, seed=3,
        until=[tb.oil.until.iso4406("13/11/7")],
    )  # fmt: skip
    assert data["counts"] == by_hand.counts.tolist()
    # the rest of the table is of the contact, for the other commands
    assert list(tb.load_study(file).uncertainty.inputs) == ["roughness.sigma"]


def test_a_beta_ratio_moves_what_it_holds():
    """β of one size up and down, the others as they are, as in circuits made by hand."""
    oil = load_oil(study("oil-circuit", "")).circuit
    found = propagate_life(
        oil, vary={"filters.0.beta.7 um": tb.Uncertain.uniform(low=20, high=200)},
        duration=HOUR, samples=2, probabilities=(0.0, 1.0),
    )  # fmt: skip
    (swing,) = found.swings
    for beta, end in ((20.0, swing.low), (200.0, swing.high)):
        betas = (2.0, 5.0, beta, 1000.0)
        own = oil.replace(filters=oil.filters[0].replace(betas=betas))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            assert end == pytest.approx(tb.life(oil=own, duration=HOUR).counts[-1, 1], rel=1e-9)
    assert swing.low > swing.high


@pytest.mark.parametrize(
    ("name", "entry", "code"),
    [
        ('"life.filters.0.beta.8 um"', "{ low = 40, high = 100 }", Mistake.UNKNOWN),
        ('"life.oil.volumes"', "{ low = 1, high = 2 }", Mistake.UNKNOWN),
        ('"life.ingress"', "{ low = 1 }", Mistake.OPTION),
    ],
)
def test_wrong_names_in_uncertainty_are_told(name, entry, code):
    file = study("oil-circuit", f"[uncertainty.inputs]\n{name} = {entry}\n")
    assert refused("assess", file).mistakes == [(code, f"uncertainty.inputs.{name}")]


def test_numbers_of_a_life_need_a_life():
    file = study("two-body", '[uncertainty.inputs]\n"life.ingress" = { low = 1, high = 2 }\n')
    told = refused("assess", file).mistakes
    assert told == [(Mistake.MISSING, "life"), (Mistake.MISSING, "uncertainty.inputs")]


@pytest.mark.slow
def test_numbers_inside_a_contact_are_varied(few):
    """Wear of asperities alone is K times what is slid: four times K wears four times as much."""
    file = study("dry-contact", "")
    keys = ["life.duration=2 s", "life.dry.arrivals=clean", "outputs.wear.f_ab=0",
            "outputs.wear.f_roll=0"]  # fmt: skip
    asked = load_life(file, keys)
    clean = asked.contact.replace(particles=None)
    found = propagate_dry(
        clean, vary={"outputs.wear.K_ss": tb.Uncertain.uniform(low=1e-10, high=4e-10)},
        duration=2.0, conditions=dict(asked.conditions) | {"debris": asked.debris},
        samples=2, probabilities=(0.0, 1.0),
    )  # fmt: skip
    assert found.swings[0].high / found.swings[0].low == pytest.approx(4, rel=1e-2)


# ------------------------------------------------------------------------------ of contacts
@pytest.mark.slow
def test_contacts_in_an_oil_are_varied_with_it(few):
    """ε enters as a factor on what stands in a thin film: wear of grooves is proportional to it."""
    file = study(
        "oil-circuit",
        CONTACT.replace("f_roll = 0", "f_roll = 0.1")
        + 'entry_ratio = 0.01\n[life.uncertainty]\n"contact.entry_ratio" = '
        '{ low = 0.01, high = 0.04 }\n',
    )  # fmt: skip
    bands = json.loads(run("life", file, *SHORT, "--json").stdout)["bands"]
    assert 0 < bands["wear"][0] < bands["wear"][-1]
    assert bands["swings"][0][0] == "entry_ratio"
    asked = load_oil(file, [SHORT[1], SHORT[3]])
    given = {"contact": asked.contact.contact, "debris": asked.contact.debris}
    found = propagate_life(
        asked.circuit, vary=asked.uncertainty, duration=HOUR,
        contact=given | dict(asked.contact.conditions), samples=2, probabilities=(0.0, 1.0),
    )  # fmt: skip
    (swing,) = found.swings
    assert swing.name == "entry_ratio"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        alone = [
            tb.life(
                oil=asked.circuit, duration=HOUR,
                **(given | dict(asked.contact.conditions) | {"entry_ratio": ratio}),
            )
            for ratio in (0.01, 0.04)
        ]  # fmt: skip
    worn = [max(a.more["wear_1"][1][-1], a.more["wear_2"][1][-1]) for a in alone]
    assert worn[1] / worn[0] == pytest.approx(4, rel=0.02)
    assert found.wear[0] >= worn[0] * (1 - 1e-3)
    assert found.wear[-1] <= worn[1] * (1 + 1e-3)


@pytest.mark.slow
def test_a_dry_contact_is_varied(few):
    file = study("dry-contact", DRY)
    keys = ["--set", 'life.duration="1 min"']
    told = said(run("assess", file, *keys))
    asked = load_life(file, [keys[1]])
    assert set(asked.uncertainty) == {"arrivals", "loss"}
    arguments = {**asked.conditions, "debris": asked.debris}
    found = propagate_dry(
        asked.contact, vary=asked.uncertainty, duration=60.0, conditions=arguments, samples=4,
        until=asked.until,
    )  # fmt: skip
    low, high = (value * 1e9 for value in (found.wear[0], found.wear[-1]))
    assert f"{low:.3g} nm to {high:.3g} nm" in " ".join(told.split())
    *first, last = words_of_bands(found)
    assert told.index(" ".join(first)) < told.index(last)


@pytest.mark.parametrize(
    ("kind", "more", "code", "place"),
    [
        ("dry-contact", DRY.replace('"dry.loss"', '"dry.lost"'), Mistake.UNKNOWN, '"dry.lost"'),
        ("dry-contact", DRY.replace("high = 1 }", "high = 2 }"), Mistake.RANGE, '"dry.loss".high'),
        (
            "oil-circuit",
            OIL.replace("oil.volume", "contact.entry_ratio"),
            Mistake.UNKNOWN,
            '"contact.entry_ratio"',
        ),
    ],
)
def test_mistakes_get_one_sentence(kind, more, code, place):
    assert refused("assess", study(kind, more)).mistakes == [(code, f"life.uncertainty.{place}")]


def test_what_does_not_go_together_is_refused():
    file = study("oil-circuit", OIL)
    (page,) = refused("assess", file, "--html", "a.html").problems
    assert page.code is Mistake.MISSING
    assert "--html" in page
    assert "thirdbody report" in page
    for command, code in (("life", Mistake.IDLE), ("assess", Mistake.MISSING)):
        (keep,) = refused(command, "bare-oil-circuit.toml", "--keep", "kept.jsonl").problems
        assert keep.code is code
        assert keep.startswith("--keep ")
    assert not Path("kept.jsonl").exists()


# ------------------------------------------------------------------------------ interrupted
@pytest.mark.check
def test_an_interrupted_run_goes_on_to_the_same_bytes(monkeypatch):
    file = study("oil-circuit", OIL)
    whole = run("assess", file, *SHORT, "--json").stdout
    done, at_once = [], life_bands.run_oil_history

    def breaks(*arguments, **given):
        if len(done) == 30:
            raise KeyboardInterrupt
        done.append(1)
        return at_once(*arguments, **given)

    monkeypatch.setattr(life_bands, "run_oil_history", breaks)
    broken = run("assess", file, *SHORT, "--json", "--keep", "kept.jsonl")
    assert broken.exit_code == 130
    assert "kept.jsonl holds 30 histories" in " ".join(
        f"{broken.stderr} {broken.exception}".split()
    )
    with Path("kept.jsonl").open("a") as out:
        out.write('{"i": 30, "en')  # the line that was being written
    done.clear()
    monkeypatch.setattr(
        life_bands, "run_oil_history", lambda *a, **k: done.append(1) or at_once(*a, **k)
    )
    resumed = run("assess", file, *SHORT, "--json", "--keep", "kept.jsonl")
    assert resumed.stdout == whole
    assert len(done) == 68 - 30  # 64 sets, and two ends of two inputs


@pytest.mark.check
def test_one_long_history_goes_on_to_the_same_bytes(monkeypatch):
    file = study("dry-contact")
    short = ["--set", 'life.duration="1 h"', "--json"]
    whole = run("life", file, *short).stdout
    computed, left = Loop.derivative, [15]

    def breaks(self, time, y):
        left[0] -= 1
        if left[0] == 0:
            raise KeyboardInterrupt
        return computed(self, time, y)

    monkeypatch.setattr(Loop, "derivative", breaks)
    broken = run("life", file, *short, "--keep", "kept.jsonl")
    assert broken.exit_code == 130
    words = " ".join(f"{broken.stderr} {broken.exception}".split())
    assert "kept.jsonl holds 15 steps" in words
    resumed = run("life", file, *short, "--keep", "kept.jsonl")
    assert resumed.stdout == whole
    (other,) = refused(
        "life", file, *short, "--set", "life.dry.loss=0.5", "--keep", "kept.jsonl"
    ).problems
    assert other.code is Mistake.OTHER_STUDY


# ------------------------------------------------------------------------------ impossible sets
def test_sets_that_no_oil_can_have_are_refused_before_anything_is_computed(monkeypatch):
    monkeypatch.setattr("thirdbody.study.run_life.history_of", None)  # cannot be called
    leak = """
[life.uncertainty]
"oil.leak" = { low = "1 mL/h", high = "1 L/h" }
"""
    (problem,) = refused("life", study("oil-circuit", leak)).problems
    place = 'life.uncertainty."oil.leak"'
    assert (problem.code, problem.place) == (Mistake.RANGE, place)
    assert "2000 h" in problem.rule
    wide = """
[uncertainty.inputs]
"life.filters.0.service" = { median = 1, gsd = 2 }
"""
    (problem,) = refused("life", study("oil-circuit", wide)).problems
    place = 'uncertainty.inputs."life.filters.0.service"'
    assert (problem.code, problem.place) == (Mistake.RANGE, place)
    assert "<= 2" in problem.rule
    assert re.findall(r"\d+", problem.hint) == ["11", "66"]


def test_a_factor_whose_tail_alone_is_impossible_is_allowed():
    """No set that is drawn has a service above 2."""
    file = study("oil-circuit", """
[life.uncertainty]
"filters.0.service" = { median = 0.9, gsd = 1.15 }
""")  # fmt: skip
    bands = json.loads(run("life", file, *SHORT, "--json").stdout)["bands"]
    assert bands["swings"][0][0] == "filters.0.service"


def test_a_file_of_another_study_is_refused():
    file = study("oil-circuit", OIL)
    KeptEnds(Path("kept.jsonl"), {"another": 1}).add(0, {})
    before = Path("kept.jsonl").read_bytes()
    (problem,) = refused("assess", file, *SHORT, "--keep", "kept.jsonl").problems
    assert problem.code is Mistake.OTHER_STUDY
    assert Path("kept.jsonl").read_bytes() == before
    Path("other.txt").write_text("mine")
    assert run("assess", file, *SHORT, "--keep", "other.txt").exit_code == 2
    assert Path("other.txt").read_text() == "mine"


def test_progress_says_how_many_histories_are_done():
    seen = []
    oil = load_oil(study("oil-circuit", "")).circuit
    propagate_life(
        oil, vary={"ingress": tb.Uncertain.uniform(low=0.9, high=1.1)}, duration=60.0, samples=8,
        progress=seen.append,
    )  # fmt: skip
    assert seen == list(range(1, 11))


@pytest.mark.parametrize(
    ("entries", "numbers"),
    [
        ('"filters.0.beta.7 um" = { low = 2, high = 20 }', ["2", "5", "4"]),
        (  # each alone is in order
            '"filters.0.beta.4 um" = { low = 3, high = 60 }\n'
            '"filters.0.beta.7 um" = { low = 40, high = 100 }',
            ["40", "60", "4"],
        ),
        ('"filters.0.beta.7 um" = { low = 40, high = 2000 }', ["2000", "1000", "14"]),
    ],
)
def test_beta_ratios_that_may_fall_are_refused_before_any_history(entries, numbers):
    """The end that may fall, the ratio beside it, and the size of that [µm]."""
    file = study("oil-circuit", f"[life.uncertainty]\n{entries}\n")
    done = refused("life", file)
    (problem,) = done.problems
    place = 'life.uncertainty."filters.0.beta.7 um"'
    assert (problem.code, problem.place) == (Mistake.ORDER, place)
    assert re.findall(r"\d+", problem.rule) == numbers
    assert "histories" not in done.stderr


@pytest.mark.parametrize(
    ("entries", "again", "before"),
    [
        (
            '"filters.0.beta.7 um" = { low = 40, high = 90 }\n'
            '"filters.0.beta.7000 nm" = { low = 50, high = 90 }',
            'life.uncertainty."filters.0.beta.7000 nm"',
            'life.uncertainty."filters.0.beta.7 um"',
        ),
        (
            "ingress = { low = 1, high = 2 }\n[uncertainty.inputs]\n"
            '"life.ingress" = { low = 1, high = 3 }',
            'uncertainty.inputs."life.ingress"',
            'life.uncertainty."ingress"',
        ),
    ],
)
def test_a_number_that_is_given_twice_is_refused(entries, again, before):
    file = study("oil-circuit", f"[life.uncertainty]\n{entries}\n")
    (problem,) = refused("life", file).problems
    assert (problem.code, problem.place) == (Mistake.CLASH, again)
    assert before in problem.rule
