"""What a public function is about stands first; every other number is a keyword.

Two numbers in a row are exchanged in silence, most of all where both are lengths or pressures.
"""

import inspect
import re
from importlib import import_module
from types import FunctionType, ModuleType

import pytest

import thirdbody as tb

MODULES = (
    *(f"effects.single.{name}" for name in ("dent", "heat", "ploughing", "severity")),
    "quantities.hardness",
    "equilibrium.table.writers",
)
"""Modules of the reference that have no name of their own in `thirdbody`."""
NUMBER = re.compile(r"\b(float|int|ArrayLike|Array|Number|Any)\b")
INTEGRAL = "an integral as it is written, n from a to b; called in inner loops"
DRAWN = "as in NumPy: the generator, and how many"
WHICH = "a word says which curve, the number is where: one number, by place"
HOOK = "called by the library alone, alike for every law, output or seat"
GAP = "a particle and the gap it lies in are one thing, and both are arrays of one shape"
PRESSED = "a contact and the height map that is pressed: neither is taken for the other"
EXCEPTIONS = {
    r".*\.partial_moment": INTEGRAL,
    r".*\.sample": DRAWN,
    r"asperity\.\w+\.reduced": WHICH,
    r".*\.ContactTable\.share": WHICH,
    r"particle\.OneParticle\.(regime|spots)": HOOK,
    r"outputs\.\w+\.of_asperities": HOOK,
    r"films\.\w+\.warnings": HOOK,
    r"explicit\.\w+\.draw": HOOK,
    r"explicit\.solve": PRESSED,
    r"objectives\.Objective\.cost": HOOK,
    r"particle\.AbstractParticleLaw\.single": GAP,
}
"""Where two numbers may stand without their names, and why."""


def public():
    """Names that users write, and the functions behind them: methods and constructors too."""
    out, seen = [], set()

    def add(name, thing):
        if id(thing) in seen:
            return
        seen.add(id(thing))
        if isinstance(thing, FunctionType):
            out.append((name, thing))
        elif isinstance(thing, type) and thing.__module__.startswith("thirdbody"):
            for key, member in vars(thing).items():
                if key == "__init__" or not key.startswith("_"):
                    member = getattr(member, "__func__", member)
                    if isinstance(member, FunctionType):
                        out.append((f"{name}.{key}", member))

    def add_all(module, prefix=""):
        for name in (name for name in module.__all__ if not name.startswith("_")):
            thing = getattr(module, name)
            if isinstance(thing, ModuleType):
                add_all(thing, f"{prefix}{name}.")
            else:
                add(f"{prefix}{name}", thing)

    add_all(tb)
    for module in MODULES:
        add_all(import_module(f"thirdbody.{module}"), f"{module}.")
    return out


def unnamed(function):
    """Numbers that may be given by place after the first argument."""
    places = [
        each
        for each in inspect.signature(function).parameters.values()
        if each.kind in (each.POSITIONAL_ONLY, each.POSITIONAL_OR_KEYWORD)
        and each.name not in ("self", "cls")
    ]
    return [
        each.name
        for each in places[1:]
        if each.annotation is each.empty or _is_number(str(each.annotation))
    ]


def _is_number(annotation):
    """Whether a type is one of numbers, not a mapping or a function of them."""
    return (
        NUMBER.search(re.sub(r"\[.*\]", "", annotation.replace("os.PathLike[str]", ""))) is not None
    )


PUBLIC = public()


def test_every_number_but_the_first_is_a_keyword():
    wrong = {name: unnamed(function) for name, function in PUBLIC}
    assert {
        name: numbers
        for name, numbers in wrong.items()
        if numbers and not any(re.fullmatch(one, name) for one in EXCEPTIONS)
    } == {}


@pytest.mark.parametrize("one", EXCEPTIONS)
def test_every_exception_is_needed(one):
    assert any(unnamed(function) for name, function in PUBLIC if re.fullmatch(one, name))


def test_the_search_sees_functions_methods_and_constructors():
    names = {name for name, _ in PUBLIC}
    assert {
        "solve",
        "Uncertain.normal",
        "results.Critical.__init__",
        "reference.hertz_point",
    } <= names

    def slip(contact, pressure: float, *, d: float):
        """Takes a pressure by place."""

    assert unnamed(slip) == ["pressure"]
