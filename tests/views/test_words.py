"""Numbers and sentences have one home each, and it holds."""

import dataclasses
import math
import re
from pathlib import Path

import pytest

import thirdbody as tb
from thirdbody import effects
from thirdbody.equilibrium import words
from thirdbody.equilibrium.columns import COLUMNS
from thirdbody.equilibrium.modes import MODES
from thirdbody.quantities import say
from thirdbody.quantities.units import EXAMPLES
from thirdbody.quantities.value import Value
from thirdbody.views import html

SOURCE = Path(tb.__file__).parent
SPEAK = ("analysis/assess", "app", "cli", "views", "study/run")
"""Rooms that speak to a reader; the others refuse inputs, which they repeat in SI."""
PREFIXED = re.compile(r"\{[^{}\"]*:[+,z]*\.?\d*[gfe]?\}\s?(%|[nmµuk]m\b|[GMk]Pa\b)|:\.?\d*%\}")
PLAIN = re.compile(r"\{[^{}\"]*:[+,z]*\.?\d+[gfe]\}")
HOMES = ("quantities/say.py", "papers/", "views/html.py")
KEPT = (
    "task.percentage",  # the bar of rich
    "the last amount is",  # repeats a cell of the file
    *("size.clearance[0]:g", "return f'\"{1e3 * value"),  # numbers of a drawing, in a study file
)


def lines():
    """Code of the package without docstrings: path, line."""
    for path in sorted(SOURCE.rglob("*.py")):
        name = path.relative_to(SOURCE).as_posix()
        if name.startswith(HOMES):
            continue
        text = re.sub(r'r?"""(?:.|\n)*?"""', "", path.read_text(encoding="utf-8"))
        for line in text.splitlines():
            if not any(kept in line for kept in KEPT):
                yield name, line.strip()


def test_no_number_is_given_a_prefix_or_a_percent_sign_by_hand():
    found = [(name, line) for name, line in lines() if PREFIXED.search(line)]
    assert [each for each in found if not any(kept in each[1] for kept in BACK)] == []


DRAWN = ("app/cross_section.py", "app/page.py", "app/sliders.py", "app/state.py", "app/inputs.py")
"""Coordinates of a drawing, and numbers that are put back into a study."""
BACK = ("hovertemplate",)
"""Templates that the figure fills in."""


def test_who_speaks_rounds_nothing_by_hand():
    found = [
        (name, line)
        for name, line in lines()
        if name.startswith(SPEAK) and name not in DRAWN and PLAIN.search(line)
        if not any(kept in line for kept in BACK)
    ]
    assert found == []


def test_the_search_finds_what_it_seeks():
    for line in ('f"{x:.3g} %"', 'f"{1e9 * x:.4g} nm"', 'f"{x / 1e6:g} MPa"', 'f"{x:.0%}"'):
        assert PREFIXED.search(line), line
    assert PLAIN.search('f"{value:.4g}"')
    assert not PREFIXED.search('f"{percent(x)} of cases"')


def test_sentences_of_modes_stand_in_one_place():
    found = {
        name
        for name, line in lines()
        if re.search("real contact is on|of the real contact area \\(", line)
    }
    assert found == {"equilibrium/words.py"}


# ---------------------------------------------------------------- numbers
@pytest.mark.parametrize("value", [None, float("nan"), float("inf"), -float("inf")])
def test_what_is_no_number_has_a_word(value):
    each = [
        say.number,
        say.percent,
        say.times,
        lambda x: say.value_of(x, "m"),
        lambda x: say.signed_number(x, 1),
    ]
    assert [of(value).removesuffix(" times") for of in each] == [say.NOT_KNOWN] * 5


def test_a_negative_zero_has_no_sign():
    assert say.number(-0.0) == "0"
    assert say.percent(-0.0) == "0 %"
    assert say.value_of(-0.0, "Pa") == "0 Pa"
    assert say.signed_number(-1e-9, 2) == "+0.00"


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [(2.0, "m", "2 m"), (2.5e-3, "m", "2.5 mm"), (1e-6, "m", "1 µm"), (-3e-7, "m", "−300 nm"),
     (9.99996e-7, "m", "1 µm"), (999.96, "Pa", "1 kPa"), (5e9, "Pa", "5 GPa"), (1e-14, "m", "1×10⁻¹⁴ m"),
     (2e11, "1/m^2", "2×10¹¹ m⁻²"), (0.25, "1", "0.25"), (0.1, "Pa s", "0.1 Pa s")],
)  # fmt: skip
def test_units_take_prefixes(value, unit, text):
    assert say.value_of(value, unit) == text


# ---------------------------------------------------------------- modes and critical loads
def test_every_mode_has_a_sentence():
    for mode in MODES:
        assert f"({mode})" in words.mode_of(mode)
    assert words.mode_of("") == words.mode_of(None)


@pytest.mark.parametrize(
    ("name", "status", "number"),
    [("F_cr1", "never p-s", 0.0), ("F_cr2", "always s-s", 0.0),
     ("F_cr1", "always p-s", float("inf")), ("F_cr2", "never s-s", float("inf"))],
)  # fmt: skip
def test_a_critical_load_outside_the_window_is_one_sentence_however_it_is_told(
    name, status, number
):
    """`transitions` says None and a status, bands 0 or ∞."""
    for value in (None, number):
        assert words.critical_load(value, status) == words.critical_load(number)
        assert words.not_met(name, value, status) == words.not_met(name, number)
    told = words.not_met(name, number)
    assert f"lies {'above' if number else 'below'} every load searched: " in told
    assert status.split()[1] in told  # of which mode it speaks


def test_a_critical_load_that_does_not_exist_is_a_dash():
    assert words.critical_load(None, "none") == words.critical_load(float("nan")) == "-"


def declared(what):
    """A word of every declared quantity and every column: "unit" or "symbol"."""
    found = {getattr(column, what) for column in COLUMNS.values()}
    for each in effects.REGISTRY.values():
        found |= {getattr(column, what) for column in each.columns.values()}
    return found | {
        item.metadata["quantity"][what]
        for kind in Value._classes.values()
        if dataclasses.is_dataclass(kind)
        for item in dataclasses.fields(kind)
        if "quantity" in item.metadata
    }


def test_no_unit_stands_as_a_file_writes_it():
    """Powers are raised, products have no sign."""
    units = declared("unit") | set(EXAMPLES)
    assert len(units) > 15
    for unit in units - {"1"}:
        assert not re.search(r"[\^*]|1/|/.*/", say.unit_of(unit)), unit
    assert say.value_of(6.7e5, "Pa m^0.5") == "0.67 MPa √m"
    assert say.value_of(math.radians(35), "rad") == "35 deg"
    assert say.value_of(1e-6, "m^2") == "1 mm²"


def test_every_symbol_is_set_with_its_subscript():
    found = declared("symbol") - {None}
    assert len(found) > 100
    for symbol in sorted(found):
        shown = html.words(symbol)
        assert "_" not in shown, symbol
        assert not re.search(r"</sub>,\w", shown), symbol


def test_names_and_lists_are_no_subscripts():
    assert html.words("particle_law.zeta_mean") == "particle_law.zeta_mean"
    assert html.words("A_ss, F_cr1,F_cr2") == "A<sub>ss</sub>, F<sub>cr1</sub>,F<sub>cr2</sub>"
