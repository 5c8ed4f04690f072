"""What every public function does with what makes no sense: one clear sentence, no traceback."""

import inspect
import json
import math
import warnings
from pathlib import Path

import mutated_studies
import numpy as np
import pytest
import random_contacts
from refusals import Mistake, refuses
from test_signatures import PUBLIC

import thirdbody as tb
from thirdbody.app.fields import value_from
from thirdbody.quantities.files import whole, write_text
from thirdbody.quantities.units import to_si
from thirdbody.quantities.value import LARGEST, SMALLEST, Value

STEEL = tb.materials["S45C"]
PAIR = tb.MaterialPair(STEEL, STEEL)
CONTACT = tb.Contact(surfaces=PAIR, roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
OF_CONTACT = [
    (name, function)
    for name, function in PUBLIC
    if str(function.__annotations__.get("contact")) == "Contact"
    and not name.endswith("__init__")
    # outputs, seats and plots are asked by the library
    and next(iter(inspect.signature(function).parameters)) == "contact"
]


@pytest.mark.parametrize(("name", "function"), OF_CONTACT, ids=[name for name, _ in OF_CONTACT])
@pytest.mark.parametrize("given", [None, "study.toml", {}, 3.0, PAIR])
def test_what_is_no_contact_is_refused(name, function, given):
    with refuses(Mistake.KIND, "contact"):
        function(given)


def test_the_main_functions_are_looked_at():
    assert {
        "solve",
        "equilibria.solve_states",
        "sweep",
        "table",
        "transitions",
        "assess",
        "design",
    } <= {name for name, _ in OF_CONTACT}


# ---------------------------------------------------------------------------- sizes
HUGE = (10**400, -(10**400), 1e300, 1e-300, 5e-324, math.inf, -math.inf, math.nan)


@pytest.mark.parametrize("kind", [tb.Roughness, tb.Material, tb.TruncatedGaussian, tb.LogNormal])
@pytest.mark.parametrize("number", HUGE)
def test_numbers_beyond_computing_are_refused_by_name(kind, number):
    needed = [p.name for p in inspect.signature(kind).parameters.values() if p.default is p.empty]
    with pytest.raises(tb.errors.InvalidValue) as told:
        kind(**dict.fromkeys(needed, number))
    assert told.value.problems[0].startswith(f"{kind.__name__}.{needed[0]} ")


@pytest.mark.parametrize("number", HUGE)
def test_numbers_beyond_computing_are_refused_in_lists(number):
    with pytest.raises(tb.errors.InvalidValue, match=r"Histogram\.edges"):
        tb.distributions.Histogram(edges=[1e-7, number], counts=[1])


@pytest.mark.parametrize("load", ["pressure", "F_star", "d"])
def test_loads_beyond_a_double_are_refused_by_name(load):
    for number in (10**400, math.inf, math.nan):
        with pytest.raises(tb.errors.InvalidValue, match=f"^{load} "):
            tb.solve(CONTACT, **{load: number})


def test_the_ends_of_what_is_computed_are_taken():
    assert tb.Roughness(sigma=SMALLEST, R=LARGEST).sigma == SMALLEST
    with refuses(Mistake.RANGE, "Roughness.sigma", value="5e-41", says="1e-40 [m]"):
        tb.Roughness(sigma=SMALLEST / 2, R=1e-6)
    with refuses(Mistake.RANGE, "Roughness.R", value="2e+40", says="1e+40 [m]"):
        tb.Roughness(sigma=1e-7, R=2 * LARGEST)


@pytest.mark.parametrize("tiny", [5e-324, 1e-300, SMALLEST / 2])
def test_what_may_be_zero_may_be_as_small_as_it_likes(tiny):
    assert tb.Material(E=2e11, nu=tiny, H=5e9).nu == tiny
    assert tb.Material(E=2e11, nu=-tiny, H=5e9).nu == -tiny
    assert tb.particle.Horng2022(datum=-tiny).datum == -tiny
    surfaces = tb.MaterialPair(*(tb.Material(E=2e11, nu=nu, H=5e9) for nu in (tiny, 0.0)))
    state = tb.solve(CONTACT.replace(surfaces=surfaces), F_star=1e-5)
    plain = tb.MaterialPair(*(tb.Material(E=2e11, nu=0.0, H=5e9) for _ in range(2)))
    assert state.d == tb.solve(CONTACT.replace(surfaces=plain), F_star=1e-5).d
    with refuses(Mistake.RANGE, "Material.E", says="1e-40 [Pa]"):
        tb.Material(E=tiny, nu=0.3, H=5e9)


def test_numbers_in_text_may_be_beyond_a_double():
    assert to_si("1e308 km", "m") == math.inf
    assert to_si("-1e999 nm", "m") == -math.inf
    assert to_si("1e-999 nm", "m") == 0.0


@pytest.mark.parametrize(
    ("unit", "need"),
    [
        ("furlong", "m"),
        ("lightyear", "m"),
        ("parsec", "m"),
        ("slug/ft^3", "kg/m^3"),
        ("fortnight", "s"),
    ],
)
def test_units_of_other_trades_are_refused(unit, need):
    with refuses(Mistake.UNIT, ""):
        to_si(f"3 {unit}", need)


@pytest.mark.parametrize(
    ("text", "unit", "want"),
    [
        ("3 inch", "m", 0.0762), ("2 thou", "m", 50.8e-6), ("1 ksi", "Pa", 6894757.29),
        ("1 kgf/mm^2", "Pa", 9.80665e6), ("5 N/mm^2", "Pa", 5e6), ("20 cP", "Pa s", 0.02),
        ("40 cSt", "m^2/s", 40e-6), ("3 g/mL", "kg/m^3", 3000.0), ("1 Å", "m", 1e-10),
        ("25 deg", "rad", math.radians(25)), ("760 mmHg", "Pa", 101325.0), ("2 atm", "Pa", 202650.0),
        ("1e5 particles/mL", "1/m^3", 1e11), ("3 %", "1", 0.03), ("2 kip/in^2", "Pa", 2 * 6894757.29),
    ],
)  # fmt: skip
def test_units_of_this_trade_are_taken(text, unit, want):
    if "kip" in text:
        with refuses(Mistake.UNIT, "", says="kip"):
            to_si(text, unit)
    else:
        assert to_si(text, unit) == pytest.approx(want, rel=1e-5)


# ---------------------------------------------------------------------------- the page
@pytest.mark.parametrize(
    ("text", "one", "several"),
    [
        ("0,4 um", "0.4 um", "0.4 um"),
        ("0,4 µm", "0.4 um", "0.4 um"),
        ("-1,5e-3 mm", "-1.5e-3 mm", "-1.5e-3 mm"),
        ("0,29", 0.29, [0, 29]),
        ("1,100 N", "1,100 N", "1,100 N"),
        ("0,100 N", "0.100 N", "0.100 N"),
        ("1,2,3", [1, 2, 3], [1, 2, 3]),
        ("1 MPa, 2 MPa", ["1 MPa", "2 MPa"], ["1 MPa", "2 MPa"]),
        ("1 MPa,2 MPa", ["1 MPa", "2 MPa"], ["1 MPa", "2 MPa"]),
        ("1, 2 MPa", [1, "2 MPa"], [1, "2 MPa"]),
        ("0.4 um", "0.4 um", "0.4 um"),
    ],
)
def test_a_decimal_comma_is_understood(text, one, several):
    assert value_from(text, one=True) == one
    assert value_from(text) == several


# ---------------------------------------------------------------------------- no numbers
MASKED = np.ma.masked_array([5e6, 6e6], [False, True])


@pytest.mark.parametrize(
    "ask",
    [
        lambda: tb.solve(CONTACT, pressure=MASKED),
        lambda: tb.solve(CONTACT, pressure=[5e6, np.ma.masked]),
        lambda: tb.equilibria.solve_states(CONTACT, pressure=MASKED),
        lambda: tb.equilibria.solve_states(
            CONTACT, pressure=5e6, vary={"roughness.sigma": MASKED * 1e-14}
        ),
        lambda: tb.sweep(CONTACT, pressure=MASKED),
        lambda: tb.sweep(CONTACT, pressure=[5e6], vary={"roughness.sigma": MASKED * 1e-14}),
        lambda: tb.equilibria.roots(CONTACT, pressure=MASKED),
        lambda: tb.compare(CONTACT, pressure=MASKED),
        lambda: tb.heights.HistogramHeights(edges=(0.0, 1.0, 2.0), counts=MASKED),
    ],
)
def test_a_masked_value_is_refused(ask):
    """It is no number, and numpy would hand out what lies under the mask."""
    with pytest.raises(tb.errors.InvalidValue) as told:
        ask()
    (problem,) = told.value.problems
    assert problem.code is Mistake.KIND
    assert problem.path in ("pressure", "roughness.sigma", "counts")
    assert "1 masked" in problem


def test_an_array_of_which_nothing_is_masked_is_an_array():
    whole = np.ma.masked_array([5e6, 6e6], [False, False])
    assert list(tb.solve(CONTACT, pressure=whole).d) == list(
        tb.solve(CONTACT, pressure=whole.data).d
    )


@pytest.mark.parametrize("truth", [True, np.True_, [True, 5e6], np.array([True])])
def test_a_truth_value_is_no_load(truth):
    for ask in (tb.solve, tb.equilibria.solve_states, tb.sweep, tb.compare):
        with refuses(Mistake.KIND, "pressure"):
            ask(CONTACT, pressure=truth)


# ---------------------------------------------------------------------------- warnings
def test_warnings_name_the_line_of_their_user():
    line = inspect.currentframe().f_lineno
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        rough = tb.Contact(surfaces=PAIR, roughness=tb.Roughness(sigma=1.0, R=10.0))
        rough.replace(**{"roughness.sigma": 2.0})
        tb.solve(CONTACT, pressure=1.5e9)
        tb.equilibria.solve_states(rough, pressure=1e6, vary={"roughness.sigma": [1.0, 2.0]})
        tb.table(tb.Contact(surfaces=PAIR, roughness=CONTACT.roughness.replace(alpha=50.0)))
    heard = [each for each in heard if issubclass(each.category, tb.errors.RangeWarning)]
    assert {Path(each.filename).name for each in heard} == {"test_doors.py"}
    assert {each.lineno - line for each in heard} >= {3, 4, 5, 6}


def test_no_place_of_a_warning_is_counted_by_hand():
    """A count of frames is wrong as soon as a function is wrapped."""
    package = Path(tb.__file__).parent
    by_hand = [
        file.relative_to(package).as_posix()
        for file in sorted(package.rglob("*.py"))
        if "stacklevel=" in file.read_text("utf-8")
    ]
    assert by_hand == ["errors.py"]


# ---------------------------------------------------------------------------- disks
class Full(OSError):
    """What a full disk raises, with no file in it."""


def refused_write(*_, **__):
    raise OSError(28, "No space left on device")


def test_a_full_disk_is_told_and_leaves_nothing(tmp_path, monkeypatch):
    table = tb.table(CONTACT, tolerance=1e-3)
    monkeypatch.setattr(Path, "write_text", refused_write)
    for write in (table.to_csv, table.to_abaqus, table.to_comsol, table.to_avl, table.to_python):
        with refuses(Mistake.UNWRITABLE, "", says="no space left"):
            write(tmp_path / "table.csv")
    assert not list(tmp_path.iterdir())


def test_a_disk_that_is_full_at_the_end_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr("os.fsync", refused_write)
    (tmp_path / "old.txt").write_text("old")
    for name in ("new.txt", "old.txt"):
        with refuses(Mistake.UNWRITABLE, "", says=f"{name}: no space left"):
            write_text(tmp_path / name, "new")
    assert [each.name for each in tmp_path.iterdir()] == ["old.txt"]
    assert (tmp_path / "old.txt").read_text() == "old"


def test_errors_about_other_files_pass(tmp_path):
    with pytest.raises(FileNotFoundError), whole(tmp_path / "a.txt"):
        (tmp_path / "b.txt").read_text()


@pytest.mark.parametrize("place", ["/proc/thirdbody", "/dev/null/thirdbody"])
def test_folders_that_take_no_files_are_told(place):
    with pytest.raises(tb.errors.InvalidValue, match=r"^cannot"):
        tb.sweep(CONTACT, pressure=[1e6, 2e6], out=place)
    with pytest.raises(tb.errors.InvalidValue, match=r"^cannot write"):
        tb.table(CONTACT, tolerance=1e-2).to_csv(f"{place}/a.csv")


# ---------------------------------------------------------------------------- drawn at random
@pytest.mark.check
def test_studies_with_slips_end_with_a_sentence():
    failed = [
        mutated_studies.told(each)
        for each in mutated_studies.several(3, range(24))
        if each["failed"]
    ]
    assert failed == []


def test_every_study_and_every_kind_of_slip_is_drawn():
    drawn = [mutated_studies.draw(3, index) for index in range(1500)]
    assert {each.name for each in drawn} == {path.stem for path in mutated_studies.STUDIES}
    assert len({path.parent for path in mutated_studies.STUDIES}) == 2
    kinds = {slip.split(" ")[0] for each in drawn for slip in each.slips}
    assert kinds >= {
        *("extreme", "number", "unit", "type", "word", "drop", "spell", "move", "nest", "again"),
        *("cut", "double", "swap", "insert", "comma", "unquote", "deep"),
    }
    commands = {each.command for each in drawn}
    assert commands == {
        *("solve", "table", "compare", "assess", "sweep", "film", "explicit", "design")
    }
    assert mutated_studies.draw(3, 5) == drawn[5]


@pytest.mark.parametrize(
    ("status", "out", "err", "words"),
    [
        (1, "", "Traceback (most recent call last):\nKeyError: 3\n", "traceback: KeyError: 3"),
        (1, "", "", "exit status 1"),
        (2, "", "", "without a reason"),
        (None, "", "", "hangs"),
        (0, "{", "", "no JSON"),
        (0, '{"states": {"A_t": [NaN], "status": ["ok"]}}', "", "no JSON"),
        (0, '{"states": {"A_t": [1.5], "status": ["ok"]}}', "", "1.5 told as ok"),
        (0, '{"states": {"A_t": [null], "status": ["ok"]}}', "", "no area told as ok"),
        (0, '{"states": {"A_t": [0.1], "status": ["ok"]}}', "warning: overflow encountered in exp", "of Python's own"),
    ],
)  # fmt: skip
def test_what_must_not_happen_is_seen(status, out, err, words):
    drawn = mutated_studies.Drawn("a", b"", "solve", ())
    found = mutated_studies.problems(drawn, mutated_studies.Ended(status, out, err))
    assert any(words in each for each in found)


def test_what_may_happen_is_let_pass():
    drawn = mutated_studies.Drawn("a", b"", "solve", ())
    states = {"states": {"A_t": [0.5, None, 1.5], "status": ["ok", "no", "beyond"]}}
    for status, out, err in ((0, json.dumps(states), ""), (2, "", "error: no\n")):
        assert not mutated_studies.problems(drawn, mutated_studies.Ended(status, out, err))


@pytest.mark.parametrize(
    "index", [2, *(pytest.param(index, marks=pytest.mark.slow) for index in (0, 1, 3))]
)
def test_contact_with_all_that_it_may_have(index):
    result = random_contacts.run(40, index, shares=3, whole=True)
    assert not result["failed"], random_contacts.told(result)


@pytest.mark.slow
def test_all_that_a_contact_may_have_is_drawn():
    drawn = []
    for index in range(60):
        try:
            drawn.append(random_contacts.draw_whole(40, index).contact)
        except tb.errors.InvalidValue:
            continue
    grains = [p for each in drawn for p in each.populations]
    assert {type(p.shape).__name__ for p in grains} == {"Sphere", "Angular"}
    assert {p.strength.fragments for p in grains if p.strength} == {"footprint", "gone", "all"}
    assert {getattr(each.particle_law, "onset", "") for each in drawn} >= {"hermite", "jg"}
    assert {each.name for one in drawn for each in one.outputs} >= set(tb.outputs.REGISTRY)
    units = {
        item.metadata["quantity"]["unit"]
        for kind in Value._classes.values()
        if kind.__module__.startswith(
            ("thirdbody.populations", "thirdbody.laws", "thirdbody.effects")
        )
        for item in getattr(kind, "__dataclass_fields__", {}).values()
        if "quantity" in item.metadata
    }
    assert (
        units - {"m^3", "m^4"} <= random_contacts.LENGTHS.keys() == random_contacts.PRESSURES.keys()
    )
    one = random_contacts.draw_whole(40, 3)
    np.testing.assert_array_equal(one.loads, random_contacts.draw(40, 3).loads)
