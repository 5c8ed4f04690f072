"""Strings with units: what is read, and what a user is told otherwise."""

import math
import subprocess
import sys

import pytest

from thirdbody.errors import InvalidValue
from thirdbody.quantities.kinds import one_spelling, registry
from thirdbody.quantities.units import _FACTORS, _POWERS, _scale, say, to_si


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("300 nm", "m", 300e-9),
        ("300nm", "m", 300e-9),
        ("2.8 um", "m", 2.8e-6),
        ("2.8 µm", "m", 2.8e-6),  # micro sign
        ("2.8 μm", "m", 2.8e-6),  # greek mu
        (" 2.8  micrometre ", "m", 2.8e-6),
        ("3 Å", "m", 3e-10),
        ("-5 nm", "m", -5e-9),
        ("5 GPa", "Pa", 5e9),
        ("5e3 N/mm^2", "Pa", 5e9),
        ("5e9 N m^-2", "Pa", 5e9),
        ("1e11 / m^2", "1/m^2", 1e11),
        ("1e11 1/m²", "1/m^2", 1e11),
        ("1e11 m⁻²", "1/m^2", 1e11),
        ("1e11 m-2", "1/m^2", 1e11),
        ("0.1 / um**2", "1/m^2", 1e11),
        ("1e11 particles/m^2", "1/m^2", 1e11),
        ("5 %", "1", 0.05),
        ("0.4", "1", 0.4),
        ("3e-7", "m", 3e-7),
        (3e-7, "m", 3e-7),
        (3, "m", 3.0),
    ],
)
def test_reads_what_users_write(text, unit, value):
    assert to_si(text, unit) == value


def test_decimal_prefixes_are_exact():
    """A string gives the double that the plain number is, so both give the same results."""
    for digits in ("1", "2.8", "300", "24", "0.7", "123.456"):
        assert to_si(f"{digits} nm", "m") == float(f"{digits}e-9")
        assert to_si(f"{digits} GPa", "Pa") == float(f"{digits}e9")


def test_factors_that_are_not_powers_of_ten():
    assert to_si("1 in", "m") == pytest.approx(0.0254, rel=1e-15)
    assert to_si("1 kgf/mm^2", "Pa") == pytest.approx(9.80665e6, rel=1e-15)


def test_not_finite_passes_for_the_range_check_to_refuse():
    assert math.isnan(to_si("nan", "m"))
    assert to_si("inf nm", "m") == math.inf
    assert to_si(10**400, "m") == math.inf


@pytest.mark.parametrize(
    ("text", "unit", "words"),
    [
        ("300 GPa", "m", ['"300 GPa" is a pressure', "a length [m] is needed", '"300 nm"']),
        ("300 nm", "Pa", ["is a length", "a pressure [Pa] is needed", '"5 GPa"']),
        ("1e11 / m^3", "1/m^2", ["is a number per volume", "a number per area", "1e11 / m^2"]),
        ("5 MPa", "1", ["is a pressure", "a pure number is needed"]),
        ("3 A", "m", ["electric current", "angstrom"]),
        ("1 kg*m^2/A", "m", ["in kg*m**2/A", "a length [m]"]),
        ("5 gpa", "Pa", ["gpa", "not known", "case", "did you mean GPa?"]),
        ("300 NM", "m", ["did you mean nm?"]),
        ("300 parsnip", "m", ["parsnip", "not known", '"300 nm"']),
        ("500 HV", "Pa", ["hardness number", '"500 kgf/mm^2"']),
        ("2,8 um", "m", ["decimal comma", '"2.8 um"']),
        ("0,100 N", "N", ["decimal comma", '"0.100 N"']),
        ("1,100 N", "N", ["decimal point or between thousands", '"1.100 N" or "1100 N"']),
        ("-1,100 N", "N", ['"-1.100 N" or "-1100 N"']),
        ("1,100", "1", ['"1.100" or "1100"']),
        ("1,100,000 N", "N", ["between thousands", '"1100000 N"']),
        ("1,1000 N", "N", ["decimal comma", '"1.1000 N"']),
        ("1,100.5 N", "N", ['"1100.5 N"']),
        ("nm", "m", ["has no number"]),
        ("", "m", ['""', "has no number"]),
        ("3 nm^9^9", "m", ["cannot be read", '"300 nm"']),
        ("9**9**9 m", "m", ["cannot be read"]),
        ("3 nm;import os", "m", ["cannot be read"]),
        ([1, "2 nm"], "m", ['[1, "2 nm"]', "must be a length"]),
        ({"a": 1}, "m", ["{ a = 1 }", "must be a length"]),
        (True, "m", ["true", "must be a length"]),
    ],
)
def test_says_what_is_wrong_and_what_is_needed(text, unit, words):
    with pytest.raises(InvalidValue) as caught:
        to_si(text, unit)
    (problem,) = caught.value.problems
    assert "\n" not in problem
    assert problem.startswith(say(text))
    for word in words:
        assert word in problem


def test_long_values_are_shortened():
    assert len(say("x" * 1000)) < 70
    assert len(say(list(range(1000)))) < 90


def test_pint_is_loaded_only_for_an_unusual_unit():
    code = (
        "import sys, thirdbody.study; from thirdbody.quantities.units import to_si; to_si('3 nm', 'm');"
        "from thirdbody.effects.single.dent import sink; import thirdbody as tb;"
        "sink(tb.materials['quartz'], hardness=7e9, computed=True);"  # a truth value, where one may be
        "assert 'pint' not in sys.modules; to_si('3 inch', 'm'); assert 'pint' in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_symbols_of_si_are_those_of_the_registry():
    """Where a unit is made of these alone, the registry is not asked, nor loaded."""
    from thirdbody.quantities.kinds import SYMBOLS, library_unit, registry

    for symbol in SYMBOLS:
        unit = registry().Unit(symbol)
        assert f"{unit:~}" == symbol.replace("ohm", "Ω"), symbol
    assert library_unit("W/(m² K)") == "W/m**2/K"


def entries(table):
    return [(unit, name) for unit, names in table.items() for name in names]


@pytest.mark.parametrize(("unit", "name"), entries(_FACTORS))
def test_usual_units_that_are_no_powers_of_ten_are_those_of_the_registry(unit, name):
    body = one_spelling(name)
    for number in ("1", "0.3", "7e-3", "-1.7", "123456.789", "1500", "inf", "-inf", "1e-320"):
        assert to_si(f"{number} {name}", unit) == _scale(number, body, "", unit)
    assert math.isnan(to_si(f"nan {name}", unit))


@pytest.mark.parametrize(("unit", "name"), entries(_POWERS))
def test_usual_units_are_those_of_the_registry(unit, name):
    wanted = unit.replace("^", "**")
    known = registry()(f"1 {name}" if name[0] in "/1" else name).to(wanted)
    assert known.magnitude == pytest.approx(10.0 ** _POWERS[unit][name], rel=1e-12)
    # the same double as by the registry, which reads a blank in front of the power
    for number in ("0.3", "7e-3", "-1.7", "123456.789"):
        body = one_spelling(name)
        assert to_si(f"{number} {name}", unit) == _scale(number, body, "", unit)
