"""`Any` stands where nothing better is known: of each room so many annotations hold it, no more."""

import ast
from collections import Counter
from pathlib import Path

import pytest

pytestmark = pytest.mark.check
ROOT = Path(__file__).parent.parent / "src" / "thirdbody"
MOST = {
    "__init__": 1,
    "analysis": 73,
    "app": 23,
    "cli": 20,
    "contact": 19,
    "definition": 10,
    "effects": 12,
    "equilibrium": 58,
    "explicit": 13,
    "laws": 17,
    "numerics": 2,
    "papers": 28,
    "populations": 33,
    "quantities": 51,
    "study": 124,
    "systems": 65,
    "views": 24,
}
"""How often `Any` stands in annotations, by room or module; these numbers only fall."""


def parsed(path):
    return ast.parse(path.read_text("utf-8"))


def annotations(tree):
    """Annotations of arguments, of what functions return, and of variables and fields."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node.returns
        elif isinstance(node, ast.arg | ast.AnnAssign):
            yield node.annotation


def anys(node):
    """Names `Any` in an annotation, also inside its strings."""
    for each in ast.walk(node):
        if isinstance(each, ast.Name | ast.Attribute):
            yield from ["Any"] * (getattr(each, "attr", getattr(each, "id", "")) == "Any")
        elif isinstance(each, ast.Constant) and isinstance(each.value, str):
            try:
                yield from anys(ast.parse(each.value, mode="eval"))
            except SyntaxError:  # a word of a Literal
                continue


def number_of(tree):
    """How often `Any` stands in the annotations of a module."""
    return sum(len(list(anys(each))) for each in annotations(tree) if each is not None)


def other_words(tree):
    """Names at the top of a module that are nothing but another word for `Any`."""
    for node in tree.body:
        value = getattr(node, "value", None)
        if isinstance(node, ast.Assign | ast.AnnAssign) and value is not None:
            name = getattr(value, "attr", getattr(value, "id", ""))
            if name == "Any":
                yield ast.unparse(node)


def test_what_counts():
    text = """
from typing import Any, Literal
Whatever = Any
x: Any = 1
y: "dict[str, Any]"
z: Literal["a b", "Any"]
def function(first, second: typing.Any, *, third: list["Any"], **rest: object) -> tuple[Any, Any]:
    inner = Any
"""
    assert number_of(ast.parse(text)) == 7
    assert list(other_words(ast.parse(text))) == ["Whatever = Any"]


def test_any_stands_in_few_annotations():
    """Fewer than stated is no mistake, but lower the number."""
    found = Counter()
    for path in ROOT.rglob("*.py"):
        found[path.relative_to(ROOT).parts[0].removesuffix(".py")] += number_of(parsed(path))
    assert {room: number for room, number in found.items() if number > MOST.get(room, 0)} == {}


def test_no_alias_hides_any():
    hidden = {path.name: list(other_words(parsed(path))) for path in ROOT.rglob("*.py")}
    assert {name: words for name, words in hidden.items() if words} == {}
