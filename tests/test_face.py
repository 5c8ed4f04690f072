"""What a newcomer sees first: few names at the top, modules that hold what they promise."""

import inspect
import pkgutil
import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

import thirdbody as tb
import thirdbody.study

pytestmark = pytest.mark.check
REFERENCE = Path(__file__).parent.parent / "docs" / "reference.md"
MOST = 40
"""Names at the top, no more: whatever comes goes into a module, or takes the place of another."""
MODULES = [name for name in tb.__all__ if isinstance(getattr(tb, name), ModuleType)]
LEFT = {
    "distributions": "Distribution Histogram Mixture Monodisperse PowerLaw Uniform Weibull",
    "equilibria": "coupled critical_loads equal_share_size pull_off roots solve_states",
    "errors": "InvalidValue NoEquilibrium NoTransition RangeWarning SlowWarning ThirdBodyError",
    "films": "mixed_film stribeck",
    "grains": "Angular Sphere WeibullStrength",
    "heights": "ExponentialHeights GaussianHeights Heights HistogramHeights JohnsonHeights "
    "WeibullHeights",
    "objectives": "Limit Objective Suspension",
    "oil": "Debris Filter Ingress OilCircuit OilDirt RunningIn SizeClasses entry_ratio_from_dents "
    "oil_reports until",
    "results": "Assessment Critical Equilibrium LifeHistory Propagation Sensitivity Transitions "
    "TurningPoint",
    "surfaces": "Ellipticity Finish SpectralMoments Topography",
    "systems": "feedback fractal interaction rough_body waviness",
}
"""Names that once stood at the top, by the module that lists them now."""
OLD = [(name, module) for module, names in LEFT.items() for name in names.split()]
DOCUMENTED = [
    (module, name)
    for module, body in re.findall(
        r"currentmodule:: (\S+)\n(.*?)^```$", REFERENCE.read_text("utf-8"), re.S | re.M
    )
    for name in re.findall(r"^   (\w+)$", body, re.M)
]
"""What the reference lists: the path that it prints, and the name."""


def is_documented(thing):
    """Whether the reference has to list it: constants and modules stand in their own places."""
    return inspect.isclass(thing) or inspect.isfunction(thing)


def test_few_names_stand_at_the_top():
    assert len(tb.__all__) <= MOST
    assert {name for name in dir(tb) if not name.startswith("_")} == set(tb.__all__)


@pytest.mark.parametrize("name", MODULES)
def test_a_module_at_the_top_holds_what_it_promises(name):
    module = getattr(tb, name)
    assert module.__doc__
    assert module.__all__
    assert len(set(module.__all__)) == len(module.__all__)
    assert all(hasattr(module, each) for each in module.__all__)


@pytest.mark.parametrize("name", MODULES)
def test_a_module_says_what_each_of_its_names_is(name):
    """Its first line is a sentence; each name stands in a list, ``- `name`: what it is``."""
    module = getattr(tb, name)
    text = module.__doc__
    assert text.splitlines()[0].endswith(".")
    items = re.findall(r"^- (.+(?:\n  .+)*)", text, re.M)
    assert all(re.match(r"`\w+`(, `\w+`)*: \w", item) for item in items)
    assert set(module.__all__) <= set(re.findall(r"`(\w+)`", "\n".join(items)))


@pytest.mark.parametrize("name", MODULES)
def test_completion_offers_the_names_of_a_module_alone(name):
    module = getattr(tb, name)
    assert {each for each in dir(module) if not each.startswith("__")} == set(module.__all__)


def test_modules_are_imported_by_the_names_that_they_have_at_the_top():
    """Also `from thirdbody.outputs import Friction`, as tools for types and completion see it."""
    lines = [f"import thirdbody.{name} as module" for name in MODULES]
    lines += [
        f"from thirdbody.{name} import {', '.join(getattr(tb, name).__all__)}" for name in MODULES
    ]
    lines += ["import thirdbody as tb"]
    lines += [f"assert sys.modules['thirdbody.{name}'] is tb.{name}" for name in MODULES]
    script = "import sys\n" + "\n".join(lines)
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


def test_the_first_page_names_every_name_at_the_top():
    words = set(re.findall(r"\w+", tb.__doc__))
    assert set(tb.__all__) <= words


def test_the_first_page_says_what_each_function_gives():
    """By its type; functions and methods of study files too."""
    pairs = re.findall(r"`(\w+)`:\s+(?:an?\s+)?`([\w.]+)`", tb.__doc__)
    assert {name for name, _ in pairs} >= {"solve", "sweep", "stribeck", "run_study", "run_film"}
    homes = [tb, thirdbody.study, thirdbody.study.Study]
    for name, kind in pairs:
        functions = [each for home in homes if inspect.isroutine(each := getattr(home, name, None))]
        assert functions, name
        for function in functions:
            assert kind in inspect.signature(inspect.unwrap(function)).return_annotation, name


def test_names_of_the_top_are_all_accounted_for():
    """A name is listed, or it is an old one whose module is listed; `synthetic` is all old."""
    known = set(tb._HOMES) | set(tb._MODULES)
    assert known - set(tb.__all__) == {name for name, _ in OLD} | {"synthetic"}


@pytest.mark.parametrize(("name", "module"), OLD, ids=[name for name, _ in OLD])
def test_a_name_that_left_the_top_goes_on_working(name, module):
    assert module in MODULES
    assert name in getattr(tb, module).__all__
    assert getattr(tb, name) is getattr(getattr(tb, module), name)


def test_made_surfaces_left_the_top_with_their_module():
    for name in tb.synthetic.__all__:
        assert name in tb.surfaces.__all__
        assert getattr(tb.synthetic, name) is getattr(tb.surfaces, name)


def test_old_names_work_without_a_warning_and_before_their_module_is_loaded():
    names = [*(name for name, _ in OLD), "synthetic"]
    script = f"import thirdbody as tb\nfor name in {names!r}:\n    getattr(tb, name)\n"
    script += "from thirdbody import Weibull, until\n"
    command = [sys.executable, "-W", "error", "-c", script]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_a_look_at_the_top_loads_no_module():
    script = "import sys, thirdbody; dir(thirdbody)\n"
    script += "print(*[each for each in sys.modules if each.startswith('thirdbody')])"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert {*done.stdout.split()} == {"thirdbody", "thirdbody.version"}


def test_what_the_reference_lists_is_reached_by_the_path_it_prints():
    assert len(DOCUMENTED) > 250
    for module, name in DOCUMENTED:
        assert hasattr(pkgutil.resolve_name(module), name), f"{module}.{name}"
        first = module.split(".")[1:2]
        if first and first[0] in MODULES:  # from the top alone, without another import
            assert first[0] in dir(tb)
            here = tb
            for step in [*module.split(".")[1:], name]:
                here = getattr(here, step)


def test_the_reference_lists_what_the_modules_hold():
    listed = {id(getattr(pkgutil.resolve_name(module), name)) for module, name in DOCUMENTED}
    missing = [
        f"{name}.{each}"
        for name in MODULES
        for each in getattr(tb, name).__all__
        if is_documented(thing := getattr(getattr(tb, name), each)) and id(thing) not in listed
    ]
    assert missing == []


def test_the_reference_explains_the_constants():
    """What is no class, function or module has its sentence in the text: `NAME`: what it is."""
    text = REFERENCE.read_text("utf-8")
    for name in MODULES:
        held = {each: getattr(getattr(tb, name), each) for each in getattr(tb, name).__all__}
        constants = [each for each, thing in held.items() if not callable(thing)]
        constants = [each for each in constants if not isinstance(held[each], ModuleType)]
        (section,) = re.findall(rf"^`thirdbody\.{name}`\..*(?:\n.+)*", text, re.M) or [""]
        assert [each for each in constants if f"`{each}`" not in section] == []


def test_the_reference_names_nothing_by_an_old_path():
    old = {("thirdbody", name) for name, _ in OLD}
    old |= {(f"thirdbody.{name}", each) for name, _ in OLD for each in dir(getattr(tb, name))}
    assert [f"{module}.{name}" for module, name in DOCUMENTED if (module, name) in old] == []


def modules_of(module, place, seen):
    """Modules that a user meets by completion, by the names that are written."""
    for name in dir(module):
        thing = None if name.startswith("_") else getattr(module, name)
        if isinstance(thing, ModuleType) and thing not in seen:
            seen.add(thing)
            yield f"{place}.{name}", thing
            yield from modules_of(thing, f"{place}.{name}", seen)


PUBLIC = list(modules_of(tb, "tb", set()))


@pytest.mark.parametrize(("place", "module"), PUBLIC, ids=[place for place, _ in PUBLIC])
def test_every_name_that_completion_offers_is_public_documented_and_importable(place, module):
    names = {name for name in dir(module) if not name.startswith("_")}
    assert names == set(module.__all__)
    assert module.__name__.startswith("thirdbody")
    for name in names:
        thing = getattr(module, name)
        if inspect.isclass(thing) or inspect.isfunction(thing) or inspect.ismodule(thing):
            assert thing.__doc__, f"{place}.{name}"


def test_completion_reaches_the_life_of_a_bearing():
    places = {place for place, _ in PUBLIC}
    assert {"tb.systems.bearing_life", "tb.systems.life.run", "tb.oil.until"} <= places
    with pytest.raises(AttributeError, match=r"systems\.bearing_life"):
        _ = tb.bearing_life


def test_completion_loads_no_module():
    script = "import sys\nfrom thirdbody import systems\nfrom thirdbody.systems import life\n"
    script += "dir(systems), dir(life)\n"
    script += "print(*[each for each in sys.modules if each.startswith('thirdbody.systems.')])"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.stdout.split() == ["thirdbody.systems.life"]
