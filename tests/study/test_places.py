"""A mistake is named at its place, whichever of several tables it stands in, in study keys."""

import copy
import re
import tomllib
from importlib import resources
from pathlib import Path

import pytest

from thirdbody.errors import InvalidValue, Mistake, in_study
from thirdbody.study import check
from thirdbody.systems.machine_elements import preloaded_load

STUDIES = resources.files("thirdbody").joinpath("data/studies")
NO_STRENGTH = {"material": "ZnO", "strength": "material"}
ANGULAR = {"kind": "angular", "roundness": 0.2, "angle": "25 deg"}
HORNG = {"name": "horng2022"}


def problems(study):
    with pytest.raises(InvalidValue) as error:
        check(study, folder=Path(str(STUDIES)))
    return [each.put_in_words(in_study) for each in error.value.problems]


def study(*populations):
    usual = {"material": "quartz", "distribution": "monodisperse", "mean": "5 um",
             "areal_density": "1e7 / m^2"}  # fmt: skip
    tables = [usual | {"name": f"kind {i}"} | each for i, each in enumerate(populations)]
    return {
        "surfaces": {"first": "100Cr6", "second": "100Cr6"},
        "roughness": {"sigma": "100 nm", "R": "2.8 um"},
        "particles": tables if len(tables) > 1 else tables[0],
        "load": {"pressure": "5 MPa"},
    }


@pytest.mark.parametrize(
    ("wrong", "key", "said"),
    [
        (NO_STRENGTH, "strength", "strength = {"),
        ({"strength": {"sigma_0": "-1 MPa", "at": "1 mm", "m": 3}}, "strength.sigma_0", "> 0"),
        ({"strength": "material", "law": HORNG}, "strength", 'law.name = "series"'),
        ({"shape": ANGULAR, "law": HORNG}, "shape", 'law.name = "series"'),
        ({"shape": ANGULAR | {"roundness": 3}}, "shape.roundness", "<= 1"),
        ({"areal_density": "1e12 / m^2"}, "areal_density", "jammed"),
        ({"law": {"name": "series", "friction_factor": 0}}, "law.friction_factor", "> 0"),
        ({"conducts": "yes"}, "conducts", "true or false"),
    ],
)
def test_the_second_of_two_populations_is_named(wrong, key, said):
    (alone,) = problems(study(wrong))
    (second,) = problems(study({}, wrong))
    assert alone.startswith(f"particles.{key}")
    assert second.startswith(f"particles.1.{key}")
    assert second == alone.replace("particles.", "particles.1.")
    assert said in second


def test_tables_of_a_list_are_numbered_as_set_numbers_them():
    parts = [{"distribution": "monodisperse", "mean": -1}]
    mixed = {"distribution": "mixture", "weights": [1], "parts": parts}
    one = study(mixed)
    del one["particles"]["mean"]
    (problem, *_) = problems(one)
    told = (Mistake.RANGE, "particles.parts.0.mean", "-1")
    assert (problem.code, problem.place, problem.value) == told
    oil = tomllib.loads(STUDIES.joinpath("oil-circuit.toml").read_text("utf-8"))
    oil["life"]["filters"][0]["name"] = True
    for value, shown in ((True, "true"), (1, "1")):
        oil["life"]["filters"][0]["name"] = value
        (problem,) = problems(oil)
        told = (Mistake.KIND, "life.filters.0.name", shown)
        assert (problem.code, problem.place, problem.value) == told
    assert problem.endswith('"1"')


def entries(table, place=()):
    if isinstance(table, dict):
        for key, value in table.items():
            yield from entries(value, (*place, key))
    elif isinstance(table, list) and table and isinstance(table[0], dict):
        for i, value in enumerate(table):
            yield from entries(value, (*place, i))
    else:
        yield place


@pytest.mark.parametrize("name", ["ball-screw", "wafer-chuck", "oil-circuit"])
@pytest.mark.parametrize("value", [True, {"a": 1}, 1e30], ids=["switch", "table", "huge"])
def test_no_word_of_python_is_told_and_nothing_breaks(name, value):
    whole = tomllib.loads(STUDIES.joinpath(f"{name}.toml").read_text("utf-8"))
    told = []
    python = re.compile(r"None\b|True\b|False\b|\{'|\w\(\w*=|unhashable")
    for place in entries(whole):
        spoiled = copy.deepcopy(whole)
        table = spoiled
        for step in place[:-1]:
            table = table[step]
        table[place[-1]] = value
        try:
            check(spoiled, folder=Path(str(STUDIES)))
        except InvalidValue as error:
            told += map(in_study, error.problems)
    assert [each for each in told if python.search(each)] == []


def test_a_preload_of_any_size():
    assert preloaded_load(100.0, 1e30) == pytest.approx(1e30, rel=1e-14)
    for preload in (1e-20, 1.0, 1e20):  # both laws of forces are of no size
        assert preloaded_load(1.5 * preload, preload) == pytest.approx(
            preload * preloaded_load(1.5, 1.0), rel=1e-13
        )
    high = preloaded_load(100.0, 80.0)
    assert high ** (2 / 3) + (high - 100.0) ** (2 / 3) == pytest.approx(2 * 80.0 ** (2 / 3))
