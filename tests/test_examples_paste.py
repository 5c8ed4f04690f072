"""Examples of public names run where a user pastes them: in a session that knows no name yet.

Doctest runs an example among the names of its own module, and so does not see one that is missing.
"""

import ast
import builtins
import doctest
import inspect
import pkgutil
import re
import symtable
from pathlib import Path
from types import FunctionType, ModuleType

import pytest

import thirdbody as tb

REFERENCE = Path(__file__).parent.parent / "docs" / "reference.md"


def documented():
    """Modules, classes and functions of the reference, and all that public modules hold."""
    yield "thirdbody", tb
    for name in tb.__all__:
        thing = getattr(tb, name)
        yield f"thirdbody.{name}", thing
        if isinstance(thing, ModuleType):
            for each in thing.__all__:
                yield f"thirdbody.{name}.{each}", getattr(thing, each)
    text = REFERENCE.read_text("utf-8")
    for module, body in re.findall(r"currentmodule:: (\S+)\n(.*?)^```$", text, re.S | re.M):
        for name in re.findall(r"^   (\w+)$", body, re.M):
            yield f"{module}.{name}", getattr(pkgutil.resolve_name(module), name)


def methods(thing):
    """Public methods and properties of a class, those of its bases of the library too."""
    for base in thing.__mro__ if inspect.isclass(thing) else ():
        if base.__module__.startswith("thirdbody"):
            for name, member in vars(base).items():
                for inner in ("__func__", "fget", "func"):
                    member = getattr(member, inner, member)
                if not name.startswith("_") and isinstance(member, FunctionType):
                    yield name, member


def examples():
    """What is shown below the prompts of each docstring, as one program, by the name."""
    out, seen = {}, set()
    for name, thing in documented():
        for path, each in ((name, thing), *((f"{name}.{k}", m) for k, m in methods(thing))):
            text = each.__doc__
            if id(each) not in seen and isinstance(text, str) and ">>> " in text:
                out[path] = "".join(e.source for e in doctest.DocTestParser().get_examples(text))
            seen.add(id(each))
    return out


def used_below(table):
    """Names that the functions and comprehensions of a statement take from outside of them."""
    for inner in table.get_children():
        yield from (s.get_name() for s in inner.get_symbols() if s.is_global())
        yield from used_below(inner)


def missing_names(program):
    """Names that a program reads before it has bound them."""
    bound, missing = set(dir(builtins)), set()
    for statement in ast.parse(program).body:
        table = symtable.symtable(ast.unparse(statement), "<example>", "exec")
        symbols = table.get_symbols()
        used = {s.get_name() for s in symbols if s.is_referenced()} | set(used_below(table))
        stored = {s.get_name() for s in symbols if s.is_assigned() or s.is_imported()}
        # the value of an assignment is read before the name is bound; a loop binds its own first
        missing |= used - bound - (set() if isinstance(statement, ast.Assign) else stored)
        bound |= stored
    return missing


EXAMPLES = examples()


def test_examples_are_seen():
    assert len(EXAMPLES) > 300
    assert {"thirdbody.design", "thirdbody.oil.Filter.penetration"} <= set(EXAMPLES)


def test_every_example_binds_the_names_it_reads():
    wrong = {name: missing_names(program) for name, program in EXAMPLES.items()}
    assert {name: sorted(names) for name, names in wrong.items() if names} == {}


@pytest.mark.parametrize(
    ("program", "names"),
    [
        ("import numpy as np\nx = np.ones(3)\n[y + x for y in x]", set()),
        ("design = design(1)", {"design"}),
        ("x = 1\nx = x + 1", set()),
        ("for i in range(3):\n    print(i)", set()),
        ("f = lambda x: Law(x).force\nf(1)", {"Law"}),
        ("[Law(x) for x in y]", {"Law", "y"}),
        ('f"{Law().force:.3g}"', {"Law"}),
        ("def half(x):\n    y = x / 2\n    return y\nhalf(2)", set()),
        ("x\nx = 1", {"x"}),
        ("from thirdbody.oil import Filter\nFilter.from_text('5=75')", set()),
    ],
)
def test_missing_names_are_those_that_an_empty_session_lacks(program, names):
    assert missing_names(program) == names
