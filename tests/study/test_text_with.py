"""Keys set in the text of a study file: what it says then is what `--set` says."""

import tomllib
from importlib import resources

import pytest

from thirdbody.cli.commands.new import KINDS
from thirdbody.study.toml import override
from thirdbody.study.toml_text import text_with, to_toml

BEARING = resources.files("thirdbody").joinpath("data/studies/ball-bearing.toml").read_text("utf-8")


@pytest.mark.parametrize(
    ("setting", "lines"),
    [
        ("load.force=1 kN", ['force = "1 kN" ', "# radial, on the bearing"]),
        ("body.balls=8", ["balls = 8                   # typical"]),
        ('film.filter="5=75"', ["[film]", 'filter = "5=75"']),
        ("film.oil.eyring_stress=5 MPa", ['eyring_stress = "5 MPa"']),
        ("particles.1.share=0.5", ["share = 0.5"]),
        ("particles.0.strength=material", ['strength = "material"']),
        ("asperity_law.name=kogut-etsion", ["[asperity_law]", 'name = "kogut-etsion"']),
        ("title=Mine", ['title = "Mine"']),
        ("film.conjunction={ shape = 'point', R = '9 mm' }", ['R = "9 mm" }']),
    ],
)
def test_a_line_is_changed_and_the_rest_stays(setting, lines):
    found = text_with(BEARING, [setting])
    assert tomllib.loads(found) == override(tomllib.loads(BEARING), [setting])
    for line in lines:
        assert line in found
    kept = set(BEARING.splitlines()) - set(found.splitlines())
    assert len(kept) <= 1
    assert "# A deep-groove ball bearing 6205" in found


def test_what_cannot_be_changed_in_a_line_is_written_anew():
    """One of two keys that exclude each other drives the other out."""
    found = text_with(BEARING, ["load.pressure=1 GPa"])
    wanted = override(tomllib.loads(BEARING), ["load.pressure=1 GPa"])
    assert tomllib.loads(found) == wanted
    assert "force" not in wanted["load"]
    assert found == to_toml(wanted)


@pytest.mark.parametrize("kind", KINDS)
def test_tables_written_anew_say_the_same(kind):
    text = resources.files("thirdbody").joinpath(f"data/studies/{kind}.toml").read_text("utf-8")
    assert tomllib.loads(to_toml(tomllib.loads(text))) == tomllib.loads(text)
    assert text_with(text, []) == text
    found = text_with(text, ["title=A", "load.pressure=1 MPa", "title=B"])
    assert tomllib.loads(found)["title"] == "B"
    assert tomllib.loads(found)["load"]["pressure"] == "1 MPa"
