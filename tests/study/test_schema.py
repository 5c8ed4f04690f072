"""The JSON Schema of study files: it refuses no study, and sees the slips that an editor can see."""

import copy
import json
import math
import re
import tomllib
from pathlib import Path

import mutated_studies
import numpy as np
import pytest
import random_studies
from jsonschema import Draft7Validator
from random_contacts import Pen
from typer.testing import CliRunner

import thirdbody as tb
from thirdbody.cli import app
from thirdbody.cli.commands.new import KINDS, SCHEMA
from thirdbody.errors import InvalidValue
from thirdbody.quantities.unit_patterns import pattern_of_unit
from thirdbody.quantities.units import _FACTORS, _POWERS, EXAMPLES, to_si
from thirdbody.study import check, study_schema
from thirdbody.study.reader import UNITS

FILES = mutated_studies.STUDIES
DATA = [tomllib.loads(file.read_text("utf-8")) for file in FILES]


@pytest.fixture(scope="module")
def schema():
    Draft7Validator.check_schema(study_schema())
    return Draft7Validator(study_schema())


def errors(schema, data):
    return [f"{error.json_path}: {error.message[:200]}" for error in schema.iter_errors(data)]


@pytest.mark.parametrize("data", DATA, ids=[file.name for file in FILES])
def test_every_example_and_template_fits(schema, data):
    assert errors(schema, data) == []


def test_studies_drawn_at_random_fit(schema):
    for index in range(300):
        assert errors(schema, random_studies.draw(11, index)) == [], index


@pytest.mark.parametrize(
    "table",
    [
        {"particles": [{"iso4406": "18/16/13", "gap": "1 um", "material": "SiO2"}] * 2},
        {"particles": {"sizes": {"edges": [1e-6, 2e-6], "counts": [5]}, "material": "SiO2"}},
        {"particles": {"distribution": "weibull", "shape": 2.5, "scale": 1e-6, "material": "SiO2"}},
        {"particles": {"material": "SiO2", "strength": "material", "law": {"name": "flakes"}}},
        {"particles": {"material": {"E": 1e9, "nu": 0.3, "H": 1e8}, "shape": "sphere"}},
        {"roughness": {"first": {"Ra": "0.2 um", "process": "ground"}, "R": "9 um"}},
        {
            "roughness": {
                "topography": ["a.txt", "b.txt"],
                "heights": {"name": "weibull", "shape": 3},
            }
        },
        {"asperity_law": {"name": "field", "spectrum": {"hurst": 0.7, "corner": "sharp"}}},
        {"sweep": {"pressure": {"from": 1, "to": 2}, "vary": {"roughness": {"R": [1, 2]}}}},
        {"uncertainty": {"inputs": {"roughness.sigma": {"low": 1, "high": 2}}, "samples": 64}},
        {"explicit": {"seats": {"rule": "settled"}, "cap": "5 GPa"}},
    ],
    ids=lambda table: next(iter(table)),
)
def test_ways_to_write_a_table_fit(schema, table):
    """Keys and types: whether the values make sense together is the reader's to say."""
    missing = "is a required property"
    data = {"load": {"pressure": 1e6}} | table
    assert [each for each in errors(schema, data) if missing not in each] == []


@pytest.mark.spread(3)
@pytest.mark.parametrize("seed", range(6))
def test_no_study_that_is_read_is_refused(schema, seed):
    """Slips at random: what the reader takes fits, and most of what it refuses does not."""
    refused = seen = 0
    for index in range(120):
        pen = Pen(np.random.default_rng([seed, index]))
        which = index % len(FILES)
        data = copy.deepcopy(DATA[which])
        slip = mutated_studies.change(pen, data, numbers=False)
        found = errors(schema, data)
        try:
            check(data, folder=FILES[which].parent)
        except InvalidValue:
            refused, seen = refused + 1, seen + bool(found)
        else:
            assert not found, (FILES[which].name, slip)
    assert seen > refused / 2


@pytest.mark.parametrize("kind", KINDS)
def test_every_template_fits(schema, kind, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert CliRunner().invoke(app, ["new", kind]).exit_code == 0
    (file,) = tmp_path.glob("*.toml")
    assert errors(schema, tomllib.loads(file.read_text("utf-8"))) == []


WRONG = [
    'roughness.sigma="300 GPa"',
    'roughness.sigma="100 nmm"',
    'roughness.sigma="100 furlong"',
    'roughness.sigma="abc"',
    'roughness.sigma="0,1 um"',
    "roughness.sigma=true",
    'roughness.R="60 HRC"',
    'surfaces.first="S45D"',
    'surfaces.second={E="205 mm", nu=0.3, H="5 GPa"}',
    'surfaces.second={E="205 GPa", nu=0.3, H="60 HRX"}',
    'surfaces.second={E="60 HRC", nu=0.3, H="5 GPa"}',
    'particles.material="SiO3"',
    'particles.mean="500 MPa"',
    'particles.areal_density="1e11 / s"',
    'particles.concentration=["0.1 wt%"]',
    'load={pressure="5 um"}',
    'load={pressure=["5 MPa", "6 nm"]}',
    'load={pressure={from="1 MPa", to="5 kg", points=3}}',
    'load={pressure="5 MPa", separation="1 um"}',
    "load={}",
    'roughness={sigma="100 nm", R="2.8 um", eta="1e11/m^2", eta_R_sigma=0.05}',
]
"""What a reader refuses, and an editor sees: units, words, names, two loads, none."""


@pytest.mark.parametrize("setting", WRONG)
def test_what_a_reader_refuses_does_not_fit(schema, setting):
    which = [file.name for file in FILES].index("dusty_ball_screw.toml")
    data = copy.deepcopy(DATA[which])
    table, _, key = setting.partition("=")[0].partition(".")
    value = tomllib.loads(f"{setting.partition('=')[0].strip()}{setting[setting.index('=') :]}")
    data[table] = data[table] | value[table] if key else value[table]
    with pytest.raises(InvalidValue):
        check(data, folder=FILES[which].parent)
    assert errors(schema, data)


def test_a_study_without_a_load_does_not_fit(schema):
    which = [file.name for file in FILES].index("dusty_ball_screw.toml")
    data = {name: table for name, table in DATA[which].items() if name != "load"}
    with pytest.raises(InvalidValue):
        check(data, folder=FILES[which].parent)
    assert errors(schema, data)
    assert not errors(schema, data | {"sweep": {"pressure": ["1 MPa", "5 MPa"]}})


@pytest.mark.parametrize("unit", sorted({*UNITS.values()} & EXAMPLES.keys()))
def test_every_usual_way_to_write_a_unit_fits(unit):
    pattern = re.compile(pattern_of_unit(unit))
    texts = [f"2.5e3 {name}" for name in (*_POWERS.get(unit, ()), *_FACTORS.get(unit, ()))]
    for text in (*texts, EXAMPLES[unit].strip('"')):
        assert math.isfinite(to_si(text, unit))
        assert pattern.search(text), text


@pytest.mark.parametrize(
    ("text", "unit"),
    [
        *(("3 micrometers", "m"), ("3µm", "m"), ("1e-3 inch", "m"), ("5 N/mm²", "Pa")),
        *(("5 kgf / mm^2", "Pa"), ("72 ksi", "Pa"), ("1e11 particles/m^2", "1/m^2")),
        *(("7 m^-2", "1/m^2"), ("7 m⁻²", "1/m^2"), ("2 W/m/K", "W/m/K"), ("5 %", "1")),
        *(("3 g cm^-3", "kg/m^3"), ("12 l/min", "m^3/s"), ("3 mm2", "m^2"), ("30 degree", "rad")),
    ],
)
def test_other_ways_to_write_a_unit_fit(text, unit):
    assert math.isfinite(to_si(text, unit))
    assert re.search(pattern_of_unit(unit), text)


def test_slips_are_seen(schema):
    data = copy.deepcopy(DATA[[file.name for file in FILES].index("dusty_ball_screw.toml")])
    data["roughness"]["sigm"] = data["roughness"].pop("sigma")
    data["particles"]["distribution"] = "log-norm"
    data["load"]["F_star"] = -1
    places = {error.json_path for error in schema.iter_errors(data)}
    assert {"$.roughness", "$.load.F_star"} < places
    assert any(place.startswith("$.particles") for place in places)


def test_words_are_those_of_the_registries():
    words = json.dumps(study_schema())
    for registry in (tb.asperity.REGISTRY, tb.particle.REGISTRY, tb.outputs.REGISTRY):
        assert all(f'"{name}"' in words for name in registry)
    assert all(f'"{name}"' in words for name in tb.materials)


# ---------------------------------------------------------------------------- command line
def test_the_command_prints_it():
    done = CliRunner().invoke(app, ["schema"])
    assert (done.exit_code, done.stderr) == (0, "")
    assert json.loads(done.stdout) == study_schema()


def test_a_new_study_names_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for kind in KINDS[:2]:
        assert CliRunner().invoke(app, ["new", kind, "--schema"]).exit_code == 0
        first, *rest = Path(f"{kind}.toml").read_text("utf-8").splitlines()
        assert first == f"#:schema ./{SCHEMA}"
        assert rest[0].startswith("# ")
        check(tomllib.loads(Path(f"{kind}.toml").read_text("utf-8")))
    assert json.loads(Path(SCHEMA).read_text("utf-8")) == study_schema()


def test_a_schema_that_is_there_is_kept(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path(SCHEMA).write_text("mine")
    assert CliRunner().invoke(app, ["new", "additive", "--schema"]).exit_code == 0
    assert Path(SCHEMA).read_text() == "mine"
    done = CliRunner().invoke(app, ["new", "two-body", "--schema", "--out", SCHEMA])
    assert done.exit_code == 2
    assert Path(SCHEMA).read_text() == "mine"
