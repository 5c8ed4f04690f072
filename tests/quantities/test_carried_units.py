"""Quantities that carry a unit: every public door converts them or refuses them.

The doors are found by walking the public names and the classes of values, not by a list.
"""

import dataclasses
import importlib
import inspect
import pkgutil
import re

import numpy as np
import pint
import pytest
import xarray
from random_contacts import draw
from refusals import Mistake, refuses
from test_signatures import PUBLIC, _is_number

import thirdbody as tb
from thirdbody.quantities.carried import (
    USUAL,
    arguments_of,
    carries_unit,
    in_si,
    takes_units,
    units_of,
)
from thirdbody.quantities.value import Value
from thirdbody.study.whole import check

u = pint.get_application_registry()
WRONG = pint.Quantity(3.0, "candela * kg^3")
"""What no argument of this library is measured in."""


class Unit:
    """A unit of another library than pint."""

    def __init__(self, name):
        self.name = name

    def __str__(self):
        return self.name


class Quantity:
    """A quantity as astropy's: ``.unit``, ``.value`` and ``.to``; numpy sees the bare number."""

    def __init__(self, value, unit):
        self.value, self.unit = value, Unit(unit)

    def to(self, unit):
        there = pint.Quantity(self.value, str(self.unit)).to(unit)
        return Quantity(there.magnitude, unit)

    def __float__(self):
        return float(self.value)

    def __array__(self, *_, **__):
        return np.asarray(self.value)

    def __str__(self):
        return f"{self.value} {self.unit}"


def boxed(value):
    """An array that holds the quantity itself."""
    out = np.empty((), object)
    out[()] = value
    return out


KINDS = {
    "pint": lambda number, unit: pint.Quantity(number, unit),
    "a registry of one's own": lambda number, unit: u.Quantity(number, unit),
    "astropy's protocol": Quantity,
    "xarray over pint": lambda number, unit: xarray.DataArray(
        pint.Quantity(np.array(number), unit)
    ),
    "xarray with attrs": lambda number, unit: xarray.DataArray(number, attrs={"units": unit}),
    "an array of objects": lambda number, unit: boxed(pint.Quantity(number, unit)),
}
STEEL = tb.materials["S45C"]
CONTACT = draw(1, 3).contact
DRY = tb.Contact(
    surfaces=tb.MaterialPair(STEEL, STEEL), roughness=tb.Roughness(sigma=100e-9, R=2.8e-6)
)


def is_door(parameter):
    """Whether an argument is a number, by its type."""
    return parameter.name not in ("self", "cls", "vary") and (
        parameter.annotation is parameter.empty or _is_number(str(parameter.annotation))
    )


DOORS = [
    (name, function, parameter)
    for name, function in PUBLIC
    if not name.endswith("__init__")
    for parameter in inspect.signature(function).parameters.values()
    if is_door(parameter) and parameter.kind is not parameter.VAR_KEYWORD
]


def by_room(doors):
    """Doors by the folder or file of the library that they stand in: one test each."""
    rooms = {}
    for door in doors:
        rooms.setdefault(room_of(door[1]), []).append(door)
    return [pytest.param(rooms[room], id=room) for room in sorted(rooms)]


def room_of(function):
    return function.__module__.split(".")[1]


def test_each_door_stands_in_a_room():
    rooms = by_room(DOORS)
    assert sum(len(doors.values[0]) for doors in rooms) == len(DOORS) > 600
    assert {doors.id for doors in rooms} >= {"equilibrium", "laws", "populations", "reference"}


@pytest.mark.parametrize("doors", by_room(DOORS))
def test_no_door_drops_a_unit(doors):
    """Nothing but the argument is given: it is refused before anything else is looked at."""
    wrong = []
    for name, function, parameter in doors:
        for value in (WRONG, [WRONG, WRONG], WRONG * np.ones(3)):
            answer = what_is_said(function, {parameter.name: value})
            if not answer.startswith(f"{parameter.name} = "):
                wrong.append(f"{name}({parameter.name}={value}): {answer}")
    assert wrong == []


def what_is_said(function, arguments):
    """The words in which arguments are refused; those that say otherwise where they are not."""
    try:
        return f"no refusal but {function(**arguments)!r}"
    except tb.errors.InvalidValue as refused:
        return str(refused)
    except Exception as error:
        return f"no refusal but {error!r}"


def test_a_door_that_takes_a_unit_as_a_number_is_seen():
    assert what_is_said(lambda d: d, {"d": WRONG}).startswith("no refusal but ")
    assert what_is_said(lambda d: 1 / 0, {"d": WRONG}).startswith("no refusal but ")


@pytest.mark.parametrize("doors", by_room(DOORS))
def test_what_a_docstring_measures_in_a_unit_is_converted(doors):
    wrong, one = [], pytest.approx(3.0, rel=1e-12)
    for name, function, parameter in doors:
        unit = units_of(function, owner_of(name)).get(parameter.name)
        if unit is None:
            continue
        got = converted(function, parameter.name, unit)
        wrong += [f"{name}({parameter.name}) [{unit}]: {each}" for each in got if each != one]
    assert wrong == []


def owner_of(name):
    """The class that a method stands in, by its public name."""
    owner = getattr(tb, name.split(".")[0], object)
    for part in name.split(".")[1:-1]:
        owner = getattr(owner, part, object)
    return owner if isinstance(owner, type) else object


def converted(function, argument, unit):
    """What a door of this signature passes on for 3 of this unit, in three ways to write them."""
    got = []

    def record(*args, **named):
        got.append(named[argument] if named else args[-1])

    record.__doc__ = "\n".join(
        ["One.", "", "Parameters", "----------", f"{argument} : float", f"    [{unit}]"]
    )
    record.__signature__ = inspect.signature(function)
    door = takes_units(record)
    wanted = "dimensionless" if unit == "1" else unit.replace("^", "**").replace("²", "**2")
    value = pint.Quantity(3.0, wanted.replace("³", "**3"))
    for given in (value, value.to_base_units(), value.to_root_units()):
        door(**{argument: given})
    return got


def test_most_doors_convert():
    """Loads, separations and lengths are converted, not refused."""
    refused = [
        f"{name}-{parameter.name}"
        for name, function, parameter in DOORS
        if parameter.name in USUAL and units_of(function)[parameter.name] is None
    ]
    assert refused == []


COUNTED = re.compile(r"int\b")
HOOK = "called by the library alone"
EITHER = "one of several units, which the number alone does not say"
REFUSED = {
    r"Uncertain\..*": "the unit is that of the input it will stand for",
    r"objectives\.(Objective\.cost|Limit\.excess)\(metric\)": HOOK,
    r"outputs\.AbstractOutput\.\w+\((state|contact)\)": "no number",
    r"explicit\.ensemble\((seats|cap)\)": "words as well",
    r"explicit\.\w+\.(draw|room)\(.*": HOOK,
    r"asperity\.(\w+\.pressure|\w+\.reduced)\([uy]\)": HOOK,
    r"particle\.OneParticle\.\w+\((depth|delta|number)\)": HOOK,
    r"films\.\w+\.(limits_of|join_limits|warnings)\(.*": HOOK,
    r"films\.\w+\.(central|minimum|asymptotes)\((load|eta|alpha)\)": EITHER,
    r".*\(concentration\)|dust\.concentration\(value\)": EITHER,
    r"quantities\.hardness\.\w+\(value\)": EITHER,
    r"surfaces\.from_topography\(source\)": "a file as well",
    r"effects\.single\.heat\.\w+\((k|m|T_1|T_2|film)\)": EITHER,
    r"effects\.single\.ploughing\.coefficient_of_faces\(.*": "lengths in any one unit",
    r"systems\.fractal\.MajumdarBhushan\.largest_spot\(load\)": EITHER,
    r"systems\.fractal\.Stack\.self_affine\(frequency\)": EITHER,
    r"systems\.rough_body\.curve\(loads\)": EITHER,
    r"systems\.load_sharing\.share_radial_load\(stiffness\)": "its unit goes with the exponent",
    r"plot\.bands\(mark\)": "the unit is that of the load",
    r"systems\.feedback\.\w+\.(share|between)\((T|T_1|T_2)\)": EITHER,
    r"oil\.until\.\w+\.excess\(state\)": HOOK,
    r"systems\.life\.steady\.contact_stock\(capacity\)": "its unit goes with that of the source",
    r"systems\.life\.steady\.find_steady_points\((low|high)\)": "the unit of any unknown",
}
"""Numbers of which a unit is refused, and why; counts, seeds and places have none."""


def refused_numbers():
    """Doors, but those of whole numbers, that refuse every unit."""
    return [
        f"{name}({parameter.name})"
        for name, function, parameter in DOORS
        if not COUNTED.match(str(parameter.annotation))
        and units_of(function, owner_of(name)).get(parameter.name) is None
    ]


def test_a_number_takes_its_unit_or_it_is_said_why_not():
    wrong = [door for door in refused_numbers() if not any(re.fullmatch(e, door) for e in REFUSED)]
    assert wrong == []


@pytest.mark.parametrize("one", REFUSED)
def test_every_refusal_is_needed(one):
    assert any(re.fullmatch(one, door) for door in refused_numbers())


# ---------------------------------------------------------------------------- values
def values_in(value):
    """A value and every value in it."""
    if isinstance(value, tuple):
        for each in value:
            yield from values_in(each)
    elif isinstance(value, Value):
        yield value
        for item in dataclasses.fields(value):
            yield from values_in(getattr(value, item.name))


def fields_of_values():
    for kind in sorted(Value._classes.values(), key=lambda kind: kind.__name__):
        if dataclasses.is_dataclass(kind) and kind.__module__.startswith("thirdbody"):
            for item in dataclasses.fields(kind):
                if item.metadata.keys() & {"quantity", "several"}:
                    yield kind, item.name


FIELDS = list(fields_of_values())


@pytest.fixture(scope="module")
def samples():
    found = {}
    for index in range(60):
        for value in values_in(draw(2, index).contact):
            found.setdefault(type(value), value)
    return found


FIELDS_BY_ROOM = {
    room: [(kind, name) for kind, name in FIELDS if room_of(kind) == room]
    for room in sorted({room_of(kind) for kind, _ in FIELDS})
}


@pytest.mark.parametrize("room", FIELDS_BY_ROOM)
def test_no_field_drops_a_unit(room, samples):
    unsaid = []
    for kind, name in FIELDS_BY_ROOM[room]:
        # what is needed beside it is wrong as well where no sample is at hand, and said too
        needed = [
            each.name for each in dataclasses.fields(kind) if each.default is each.default_factory
        ]
        others = {
            each: getattr(samples[kind], each) if kind in samples else WRONG for each in needed
        }
        for wrong in (WRONG, [WRONG, WRONG]):
            answer = what_is_said(kind, others | {name: wrong})
            if not re.search(f"{kind.__name__}.{name} = .*candela", answer):
                unsaid.append(f"{kind.__name__}({name}={wrong}): {answer}")
    assert unsaid == []


@pytest.mark.parametrize("kind", KINDS)
def test_fields_are_converted(kind):
    of = KINDS[kind]
    rough = tb.Roughness(sigma=of(100.0, "nm"), R=of(2.8, "um"), eta=of(3e11, "1/m**2"))
    assert (rough.sigma, rough.R, rough.eta) == (1e-7, 2.8e-6, 3e11)
    assert tb.Material(E=of(205, "GPa"), nu=of(30, "percent"), H=8e9).E == 205e9
    assert rough.replace(sigma=of(0.2, "um")).sigma == 2e-7
    assert DRY.replace(**{"roughness.sigma": of(50, "nm")}).roughness.sigma == 50e-9
    sizes = tb.distributions.Histogram(edges=[of(1, "um"), of(2, "um"), 3e-6], counts=[1, 2])
    assert sizes.edges == (1e-6, 2e-6, 3e-6)


def test_arrays_with_a_unit_are_fields_of_several_numbers():
    sizes = tb.distributions.Histogram(edges=[1, 2, 3] * u.um, counts=[1, 2] * u.dimensionless)
    assert sizes.edges == (1e-6, 2e-6, 3e-6)
    with refuses(Mistake.UNIT, "Histogram.edges"):
        tb.distributions.Histogram(edges=[1, 2, 3] * u.MPa, counts=[1, 2])


# ---------------------------------------------------------------------------- the doors by use
@pytest.mark.parametrize("kind", KINDS)
def test_loads_are_converted(kind):
    of = KINDS[kind]
    assert tb.solve(DRY, pressure=of(5.0, "MPa")).A_t == tb.solve(DRY, pressure=5e6).A_t
    assert tb.solve(DRY, d=of(250, "nm")).F_star == tb.solve(DRY, d=250e-9).F_star > 0
    assert (
        tb.equilibria.roots(DRY, pressure=of(5, "MPa"))[0][0].d
        == tb.equilibria.roots(DRY, pressure=5e6)[0][0].d
    )


def test_arrays_and_lists_are_converted():
    want = tb.solve(DRY, pressure=np.array([1e6, 5e6])).A_t
    for given in (
        [1, 5] * u.MPa,
        [1 * u.MPa, 50 * u.bar],
        xarray.DataArray([1.0, 5.0], dims="load", attrs={"units": "MPa"}),
    ):
        assert tb.solve(DRY, pressure=given).A_t.tolist() == want.tolist()


def test_varied_inputs_have_the_units_of_their_fields():
    vary = {"roughness.sigma": [50, 100] * u.nm, "roughness.alpha": np.array([4.0, 5.0])}
    got = tb.equilibria.solve_states(DRY, pressure=2 * u.MPa, vary=vary)
    want = {"roughness.sigma": np.array([50e-9, 1e-7]), "roughness.alpha": np.array([4.0, 5.0])}
    assert (
        got.A_t.values.tolist()
        == tb.equilibria.solve_states(DRY, pressure=2e6, vary=want).A_t.values.tolist()
    )
    with refuses(Mistake.UNIT, "roughness.sigma"):
        tb.equilibria.solve_states(DRY, pressure=2e6, vary={"roughness.sigma": [50, 100] * u.MPa})


def test_another_dimension_is_told_with_its_key_what_is_needed_and_what_it_is():
    with pytest.raises(tb.errors.InvalidValue) as told:
        tb.solve(DRY, pressure=250 * u.nm)
    assert str(told.value) == (
        "pressure = 250 nanometer is a length, but a pressure [Pa] is needed"
    )
    with pytest.raises(tb.errors.InvalidValue) as told:
        tb.Roughness(sigma=5 * u.MPa, R=3 * u.s)
    assert told.value.problems == (
        "Roughness.sigma = 5 megapascal is a pressure, but a length [m] is needed",
        "Roughness.R = 3 second is a time, but a length [m] is needed",
    )


def test_every_wrong_argument_is_told():
    with pytest.raises(tb.errors.InvalidValue) as told:
        tb.reference.hertz_point(5 * u.m, R=2 * u.N, E_star=1e11)
    assert [each.split(" = ")[0] for each in told.value.problems] == ["force", "R"]


def test_study_values_may_carry_units():
    study = {
        "surfaces": {"first": "S45C", "second": "S45C"},
        "roughness": {"sigma": 100 * u.nm, "R": 2.8 * u.um},
        "load": {"pressure": 5 * u.MPa},
    }
    read = check(study)
    assert (read.contact.roughness.sigma, read.values.tolist()) == (1e-7, [5e6])


def test_results_go_in_again():
    states = tb.solve(DRY, pressure=[1e6, 5e6]).to_dataset()
    back = tb.solve(DRY, d=states.d)
    assert back.pressure == pytest.approx([1e6, 5e6], rel=1e-9)


@pytest.mark.parametrize(
    ("value", "unit", "want"),
    [
        (250 * u.nm, "m", 250e-9),
        (0.3 * u.um, "m", 0.3e-6),
        (1 * u.inch, "m", 0.0254),
        (50 * u.percent, "1", 0.5),
        (25 * u.deg, "rad", np.deg2rad(25)),
        (pint.Quantity(20, "degC"), "K", 293.15),
        (2 / u.mm**2, "1/m^2", 2e6),
        (1.2 * u.MPa * u.m**0.5, "Pa m^0.5", 1.2e6),
        (20 * u.mPa * u.s, "Pa s", 0.02),
    ],
)
def test_numbers_are_those_that_one_would_write(value, unit, want):
    assert in_si(value, unit) == pytest.approx(want, rel=2e-16)


def test_nothing_of_a_number_is_lost():
    assert in_si(np.array([np.nan, 0.0, np.inf, -3.0]) * u.nm, "m") == pytest.approx(
        [np.nan, 0.0, np.inf, -3e-9], nan_ok=True
    )
    assert in_si(0 * u.nm, "m") == 0.0


@pytest.mark.parametrize("plain", [3.0, 3, "300 nm", None, True, np.arange(3), [1.0], {"a": 1}])
def test_what_has_no_unit_is_left_as_it_is(plain):
    assert not carries_unit(plain)
    assert in_si(plain, "m") is plain


def test_the_library_carries_no_units_itself():
    for value in values_in(CONTACT):
        assert not carries_unit(value)


# ---------------------------------------------------------------------------- every module
PHYSICS = ("populations", "systems", "effects", "analysis", "equilibrium", "explicit")
INNER = {
    "thirdbody.explicit.press": "pixels of one solver, called by the solver alone",
    "thirdbody.explicit.bodies": "pixels of one solver, called by the solver alone",
    "thirdbody.explicit.interface": "called by the solver of height maps alone",
    "thirdbody.explicit.seats": "called by the solver of height maps alone",
    "thirdbody.equilibrium.crowding": "sentences about solved states",
}
"""Modules whose functions no user calls, and why."""


def measured_functions():
    """Functions in ``__all__`` of any module of physics that measure a number in a unit."""
    for package in PHYSICS:
        root = importlib.import_module(f"thirdbody.{package}")
        for found in pkgutil.walk_packages(root.__path__, f"{root.__name__}."):
            if found.name in INNER:
                continue
            try:
                module = importlib.import_module(found.name)
            except ImportError:  # an extra that is not installed
                continue
            for name in getattr(module, "__all__", ()):
                function = getattr(module, name, None)
                if inspect.isfunction(function) and function.__module__ == found.name:
                    units = {
                        each: unit
                        for each, unit in arguments_of(function.__doc__ or "")
                        if unit not in (None, "1")
                        and each in (given := inspect.signature(function).parameters)
                        and is_door(given[each])
                    }
                    if units:
                        yield f"{found.name}.{name}", function


def test_every_function_that_measures_a_number_is_a_door():
    """Also those that no name of `thirdbody` itself leads to."""
    found = dict(measured_functions())
    assert "thirdbody.populations.ellipticity.combined_tips" in found
    assert "thirdbody.systems.bodies.press" in found
    assert [name for name, each in found.items() if not hasattr(each, "takes_units")] == []


def test_tips_speeds_and_forces_are_converted():
    from thirdbody.populations.ellipticity import combined_tips
    from thirdbody.systems.bodies import BallOnFlat, press

    got = combined_tips(3.0, 0.3 * u.um, 8.0, 5 * u.nm, 30 * u.deg)
    assert np.array(got) == pytest.approx(combined_tips(3.0, 3e-7, 8.0, 5e-9, np.pi / 6), rel=1e-14)
    ball = BallOnFlat(diameter=10e-3)
    assert press(DRY, ball, 0.02 * u.kN, integrate=False) == press(DRY, ball, 20.0, integrate=False)


def test_units_with_brackets_are_understood():
    """W/(m K) and W/(m² K), as docstrings write them."""
    from thirdbody.effects.single.heat import body_conductance

    got = body_conductance(1e-6, k=50e3 * u.mW / u.m / u.K, D=1.3e-5)
    assert got == body_conductance(1e-6, k=50.0, D=1.3e-5)
    with refuses(Mistake.UNIT, "k", says="[W/(m K)]"):
        body_conductance(1e-6, k=5 * u.m, D=1.3e-5)


def test_a_difference_of_temperatures_is_no_temperature():
    hot = tb.outputs.FlashTemperature(v=1.0, A_n=1e-6, T_1=u.Quantity(40, "degC"))
    assert hot.T_1 == 313.15
    for unit in ("delta_degC", "delta_degF"):
        with refuses(Mistake.KIND, "FlashTemperature.T_1"):
            tb.outputs.FlashTemperature(v=1.0, A_n=1e-6, T_1=u.Quantity(5, unit))
