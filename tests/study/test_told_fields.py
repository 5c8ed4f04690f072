"""What a mistake in a study file is told with: its key, its value, its kind, what was meant."""

import copy
import tomllib

import pytest
from refusals import refuses

import thirdbody as tb
from thirdbody.errors import Mistake, in_study
from thirdbody.quantities.units import example_of, to_si
from thirdbody.study import check
from thirdbody.study.reader import UNITS

DUSTY = {
    "surfaces": {"first": "S45C", "second": "S45C"},
    "roughness": {"sigma": "100 nm", "R": "2.8 um"},
    "particles": {
        "material": "SiO2",
        "distribution": "log-normal",
        "median": "300 nm",
        "gsd": 1.5,
        "areal_density": "1e11 / m^2",
    },
    "load": {"pressure": "5 MPa"},
}
MEDIAN = "particles.median"
DULL = {"E": "205 GPa", "nu": 0.29}


def problems(**tables):
    with pytest.raises(tb.errors.InvalidValue) as told:
        check(copy.deepcopy(DUSTY | tables))
    return told.value.problems


def design(low, high, **changes):
    return {"vary": {MEDIAN: {"low": low, "high": high}}, "objective": {"of": "A_t"}} | changes


@pytest.mark.parametrize(
    ("tables", "place", "first"),
    [
        ({"design": design("1 um", "50 nm")}, f'design.vary."{MEDIAN}"', '"1 um"'),
        (
            {"uncertainty": {"inputs": {MEDIAN: {"low": "1 um", "high": "50 nm"}}}},
            f'uncertainty.inputs."{MEDIAN}"',
            '"1 um"',
        ),
        (
            {"sweep": {"pressure": {"from": "1 GPa", "to": "2 MPa", "points": 2}}},
            "sweep.pressure",
            '"1 GPa"',
        ),
    ],
)
def test_ends_in_the_wrong_order_as_the_file_writes_them(tables, place, first):
    (problem,) = problems(**tables)
    assert (problem.code, problem.place) == (Mistake.ORDER, place)
    assert first in problem.rule
    assert problem.hint == "exchange them"


def test_objectives_and_limits_that_are_no_numbers_are_all_named():
    wrong = {"of": "plastic_shar"}
    limits = [{"of": "A_t", "most": 0.1}, {"of": "mu", "most": 0.2}]
    asked = design("1 um", "50 nm", objective=wrong, limits=limits)
    told = {each.place: each for each in problems(design=asked)}
    assert told.keys() == {f'design.vary."{MEDIAN}"', "design.objective.of", "design.limits.1.of"}
    objective, limit = told["design.objective.of"], told["design.limits.1.of"]
    assert {objective.code, limit.code} == {Mistake.UNKNOWN}
    assert (objective.value, objective.meant) == ('"plastic_shar"', "plastic_share")
    assert "[outputs.friction]" in limit.hint


def test_of_many_inputs_the_nearest_few_are_listed():
    (problem,) = problems(design=design(1, 2, vary={"particles.size": {"low": 1, "high": 2}}))
    assert (problem.code, problem.place) == (Mistake.UNKNOWN, 'design.vary."particles.size"')
    assert MEDIAN in problem.hint
    assert problem.hint.count("particles.") <= 6
    assert "[roughness]" in problem.hint
    assert "roughness." not in problem.hint


def test_particles_too_large_for_their_seat_are_named_with_the_limit():
    large = DUSTY["particles"] | {"median": "100 mm", "areal_density": 1e-3}
    beside = DUSTY["particles"] | {"law": {"name": "series", "seat": "plane"}}
    for particles, place in ((large, "particles"), ([beside, large], "particles.1")):
        study = check(copy.deepcopy(DUSTY | {"particles": particles}))
        with refuses(Mistake.BEYOND, place, says="10 mm") as told:
            study.solve()
        assert 'particle_law.seat = "plane"' in in_study(told.value.problems[0].hint)


def test_a_misspelt_kind_of_table_is_one_mistake():
    gaussian = DUSTY["particles"] | {"distribution": "gaussian"}
    asked = design("50 nm", "1 um")
    (problem,) = problems(particles=gaussian, design=asked)
    assert (problem.code, problem.place) == (Mistake.OPTION, "particles.distribution")
    assert problem.meant == "truncated-gaussian"
    told = problems(particles=gaussian | {"gsdd": 1.5})
    assert [each.place for each in told] == ["particles.gsdd", "particles.distribution"]
    assert told[0].meant == "gsd"


@pytest.mark.parametrize(
    ("word", "meant"),
    [("grinded", "ground"), ("Grinding", "ground"), ("honing", "honed"), ("turning", "turned")],
)
def test_other_words_for_a_finishing_process(word, meant):
    (problem,) = problems(roughness={"Ra": "0.1 um", "process": word})
    assert (problem.code, problem.place) == (Mistake.OPTION, "roughness.process")
    assert (problem.value, problem.meant) == (f'"{word}"', meant)


@pytest.mark.parametrize(
    "written",
    ['median = "300 nm', "median = '300 nm", 'median = 300 nm"', 'median = "300 nm  # of all'],
)
def test_a_quote_that_is_missing_is_named_with_its_line(tmp_path, written):
    file = tmp_path / "study.toml"
    file.write_text(f"[particles]\n{written}\ngsd = 1.5\nname = 2\n", "utf-8")
    with refuses(Mistake.FORM, "", says="line 2") as told:
        tb.load_study(file)
    (problem,) = told.value.problems
    assert 'median = "300 nm"' in problem.hint
    assert problem.source == str(file)


def test_a_value_that_may_be_written_is_one_of_the_quantity():
    """5 GPa are no load, but a hardness; and of every unit one can be written."""
    (pressure,) = problems(load={"pressure": "5 N"})
    (hardness,) = problems(surfaces={"first": DULL | {"H": "5 N"}, "second": "S45C"})
    assert (pressure.code, pressure.place) == (Mistake.UNIT, "load.pressure")
    assert (hardness.code, hardness.place) == (Mistake.UNIT, "surfaces.first.H")
    assert ('"5 MPa"' in pressure, '"5 GPa"' in hardness) == (True, True)
    for unit in {*UNITS.values()} - {"1"}:
        written = tomllib.loads(f"example = {example_of(unit)}")["example"]
        assert to_si(written, unit) > 0


@pytest.mark.parametrize("ends", [["50 nm", "400 nm"], [5e-8, 4e-7]])
def test_a_list_of_numbers_to_choose_from_is_told_as_a_range(ends):
    (problem,) = problems(design={"vary": {MEDIAN: ends}, "objective": {"of": "A_t"}})
    assert (problem.code, problem.place) == (Mistake.KIND, f'design.vary."{MEDIAN}"')
    assert "low = " in problem.hint
