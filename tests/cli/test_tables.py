"""Tables of the command line: whole numbers at every width, units, and what is left out."""

import pydoc
import re

import numpy as np
import pytest
from rich.console import Console
from typer.testing import CliRunner

from thirdbody import cli, load_study
from thirdbody.analysis.inputs import words_of
from thirdbody.analysis.uncertainty import samples
from thirdbody.cli.commands.solve import DROP
from thirdbody.equilibrium.columns import PLASTIC_SHARE
from thirdbody.quantities.say import percent
from thirdbody.quantities.tables import Table

from .test_cli import DUSTY, EXAMPLES

ASSESS, ADDITIVE, FILM, CLEAN, DEBRIS = (
    next(path for path in EXAMPLES if path.stem == stem)
    for stem in ("assess", "additive", "oil_film", "two_body_reference", "dust_and_debris")
)
NUMBER = re.compile(r"[−+(<]?\d\S*")


def run(width, *arguments):
    env = {"COLUMNS": None if width is None else str(width)}
    done = CliRunner().invoke(cli.app, [str(each) for each in arguments], env=env)
    assert done.exit_code == 0, done.output
    return done.stdout


def numbers(text):
    """What begins like a number, however far it goes."""
    return {word for word in text.split() if NUMBER.fullmatch(word)}


def assert_whole(width, *arguments):
    """Every number at this width is one that a screen without end shows, and no line is longer."""
    text = run(width, *arguments)
    assert max(map(len, text.splitlines())) <= width
    assert numbers(text) <= numbers(run(1000, *arguments))
    return text


def compute_once(monkeypatch, place):
    """Let every later call of a function of thirdbody.study have the answer of the first."""
    found, compute = [], pydoc.locate(f"thirdbody.study.{place}")

    def first_answer(*args, **options):
        if not found:
            found.append(compute(*args, **options))
        return found[0]

    monkeypatch.setattr(f"thirdbody.study.{place}", first_answer)


# ---------------------------------------------------------------------------- widths
@pytest.mark.parametrize("width", [60, 80])
@pytest.mark.parametrize("seed", range(4))
def test_no_number_of_a_study_drawn_at_random_is_broken(width, seed):
    rng = np.random.default_rng(seed)
    low, high = np.sort(10 ** rng.uniform(3, 9, 2))
    settings = [
        f"load.pressure={{ from = {low:.6g}, to = {high:.6g}, points = 7, spacing = 'log' }}",
        f"roughness.sigma={10 ** rng.uniform(-8, -6):.6g}",
    ]
    study = [DUSTY, CLEAN, DEBRIS, ADDITIVE][seed]
    more = [word for setting in settings for word in ("--set", setting)]
    assert_whole(width, "solve", study, *more)


@pytest.mark.check
@pytest.mark.spread(3)
@pytest.mark.parametrize(
    "arguments",
    [
        ("film", FILM),
        ("film", FILM, "--set", "film.speed=0.5 m/s"),
        ("assess", ASSESS, "--set", "uncertainty.samples=64"),
        ("assess", ADDITIVE),
        ("compare", DUSTY),
        ("surface", "example"),
        ("materials",),
        ("laws",),
        ("outputs",),
    ],
    ids=lambda arguments: "-".join(str(each).rpartition("/")[2] for each in arguments),
)
def test_no_number_of_any_command_is_broken(arguments, monkeypatch):
    # how many samples a page stands on changes none of its widths
    monkeypatch.setattr(samples, "USUAL", 64)
    # one study, computed once and printed at every width
    for place in ("analyses.assess_study", "run_film", "oil_what_ifs.what_ifs_of_oil"):
        compute_once(monkeypatch, place)
    for width in (60, 80):
        assert_whole(width, *arguments)


def test_a_pipe_heeds_columns_and_without_them_is_wide():
    assert max(map(len, run(72, "solve", DUSTY).splitlines())) <= 72
    for none in (None, "", "0", "wide"):
        assert 100 < max(map(len, run(none, "solve", DUSTY).splitlines())) <= 120


def test_columns_go_in_their_order_and_are_named():
    kept = []
    for width in (110, 80, 60):
        text = " ".join(run(width, "solve", DUSTY).split())
        gone = re.search(
            r"Not shown, because the window is too narrow: (.*?); --json or --csv FILE", text
        )
        kept.append(set() if gone is None else set(re.split(", | and ", gone[1])))
    assert kept[0] < kept[1] < kept[2]
    assert kept[1] == {"A_ss", "A_sa", "d", "d/sigma"}  # h is the separation
    assert "Not shown" not in run(130, "solve", DUSTY)


@pytest.mark.parametrize("width", [40, 50, 70])
def test_who_carries_the_load_and_the_mode_stand_at_every_width(width):
    state = load_study(DUSTY).solve()
    text = run(width, "solve", DUSTY)
    table = text[: text.index("Not shown")]
    shares = [percent(float(share)) for share in np.atleast_1d(state.particle_load_share)]
    assert any(f" {share} " in table for share in shares)
    assert re.search(r" (p-s|hybrid|s-s)\s*$", table, re.M)
    (gone,) = re.findall(r"too narrow: (.*?); --json", " ".join(text.split()))[:1]
    assert set(re.split(", | and ", gone)) <= {*DROP}


@pytest.mark.parametrize("seed", range(20))
def test_every_cell_shown_stands_whole(seed):
    rng = np.random.default_rng(seed)
    columns, rows, width = rng.integers(1, 12), rng.integers(1, 6), int(rng.integers(40, 121))
    heads = [f"head {i}" for i in range(columns)]
    words = [head for head in heads if rng.random() < 0.2]
    drop = [str(head) for head in rng.permutation(heads)[: rng.integers(0, columns + 1)]]
    wrap = bool(rng.random() < 0.3)
    table = Table(heads, right=True, words=words, drop=drop, wrap=wrap)
    cells = [
        [f"{'1' * int(rng.integers(1, 16))}.{i}{j}" for i in range(columns)] for j in range(rows)
    ]
    for row in cells:
        table.add_row(*row)
    console = Console(width=width, record=True, file=open("/dev/null", "w"))  # noqa: SIM115
    console.print(table)
    text = console.export_text()
    assert max(map(len, text.splitlines())) <= width
    shown = set(text.split())
    told = re.search(r"Not shown, because the window is too narrow: (.*);", " ".join(text.split()))
    gone = set() if told is None else set(re.split(", | and ", told[1]))
    for i, head in enumerate(heads):
        assert all((row[i] in shown) == (head not in gone) for row in cells)
    assert not (wrap and gone - set(drop))
    # nothing stays that was to go before what went
    order = [*drop, *(head for head in reversed(heads[1:]) if head not in drop)]
    assert gone == set(order[: len(gone)])


# ---------------------------------------------------------------------------- words and units
def test_every_head_of_the_states_is_told():
    text = " ".join(run(120, "solve", DUSTY).split())
    for told in (
        "d: separation d, from the mean asperity height",
        "F*: load F/(A_n E_ss), no unit",
    ):
        assert told in text


def test_outputs_at_every_load():
    loads = ["10 kPa", "100 kPa", "1 MPa", "3 MPa", "5 MPa"]
    text = run(80, "solve", ADDITIVE, "--set", f"load.pressure={loads}")
    part = text.partition(" mu ")[2].partition("critical load")[0]
    for load in loads:
        assert len(re.findall(rf"^ *{load} ", part, re.MULTILINE)) == part.count(" pressure ") + 1


OFF = [
    "--set=particle_law={name = 'series', deep = 'off'}",
    '--set=design.limits=[{ of = "plastic_share", most = 0.2 }]',
]
"""The law and the limit under which the example has its best size inside the range."""


@pytest.mark.slow
def test_design_speaks_the_units_of_its_file():
    done = CliRunner().invoke(cli.app, ["design", str(ADDITIVE), *OFF], env={"COLUMNS": "80"})
    text = " ".join(done.stdout.split())
    assert re.search(r"88\d nm", text)
    assert "0.7 wt %" in text
    asked = load_study(ADDITIVE, [each.removeprefix("--set=") for each in OFF])
    assert words_of(asked.contact, "particles.concentration") in text
    assert f"{PLASTIC_SHARE.meaning} at most 0.2" in text
    for code in ("particles.", "×10⁻⁷ ", "<="):
        assert code not in text
    for load in ("1 MPa", "2 MPa", "5 MPa", "10 MPa"):  # all that are asked for
        assert re.search(rf"^ *{load} +0\.\d+ ", done.stdout, re.MULTILINE), load
    assert re.search(r"from 8\d\d nm to 88\d nm, equal within 0.1 %", text)
    assert "particles." not in done.stderr
