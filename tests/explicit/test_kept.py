"""Surfaces that are kept in a folder: damage of every kind is seen, told and mended."""

import json
import shutil
import sys
from itertools import product

import pytest
from damage import another_number, empty, missing, truncated
from refusals import warns_of
from typer.testing import CliRunner

from thirdbody import cli
from thirdbody.errors import code_of, note_of
from thirdbody.explicit import ensemble as function

from .test_ensemble import CONTACT, EXAMPLE

RECORD = sys.modules["thirdbody.explicit.ensemble"].RECORD

ASKED = dict(surfaces=2, F_star=[1e-3], size=64, spacing=3e-7)
WORDS = ("--surfaces", "2", "--size", "64", "--spacing", "300 nm")


DAMAGES = [missing, empty, truncated, another_number]


def contents(folder):
    return {path.relative_to(folder): path.read_bytes()
            for path in sorted(folder.rglob("*")) if path.is_file()}  # fmt: skip


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_surface_is_pressed_again(tmp_path, damage, recwarn):
    wanted = function(CONTACT, **ASKED, folder=tmp_path)
    before = contents(tmp_path)
    damage(tmp_path / "surface_001.json")
    recwarn.clear()
    pressed = []
    again = function(CONTACT, **ASKED, folder=tmp_path, progress=pressed.append)
    assert pressed == [2]
    assert again.to_dict() == wanted.to_dict()
    assert contents(tmp_path) == before
    told = [note_of(each.message) for each in recwarn if each.category is UserWarning]
    assert told == ([] if damage is missing else told[:1])
    assert damage is missing or code_of(told[0]) == "kept.damaged"
    assert damage is missing or "(surface_001.json)" in told[0]


def test_surfaces_of_an_earlier_version_are_taken_and_told(tmp_path):
    wanted = function(CONTACT, **ASKED, folder=tmp_path)
    for file in tmp_path.iterdir():
        said = json.loads(file.read_text("utf-8"))
        assert set(said) == RECORD | {"sha256"}
        del said["sha256"]
        file.write_text(json.dumps(said))
    with warns_of("kept.unchecked", kind=UserWarning, says=": 2 surfaces "):
        again = function(CONTACT, **ASKED, folder=tmp_path)
    assert again.to_dict() == wanted.to_dict()


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    out = tmp_path_factory.mktemp("made") / "o"
    assert run(out).exit_code == 0
    return out


def run(out):
    return CliRunner().invoke(cli.app, ["explicit", str(EXAMPLE), *WORDS, "--out", str(out)])


TEXTS = ["study.json", "states.csv", "explicit.json", "surfaces/surface_000.json"]
DAMAGED = [*product(TEXTS, DAMAGES), ("maps.nc", truncated), ("explicit.png", truncated)]


@pytest.mark.check
@pytest.mark.spread(5)
@pytest.mark.parametrize(("name", "damage"), DAMAGED)
def test_the_command_makes_what_is_damaged_again(tmp_path, made, name, damage):
    out = tmp_path / "o"
    shutil.copytree(made, out)
    damage(out / name)
    done = run(out)
    assert done.exit_code == 0, done.output
    found, wanted = contents(out), contents(made)
    assert list(found) == list(wanted)
    differ = [str(path) for path in wanted if found[path] != wanted[path]]
    assert differ in ([], ["maps.nc"])  # HDF5 keeps no order
