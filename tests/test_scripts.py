"""Scripts of figures, benchmarks and the gallery call the library as it is: each call binds."""

import ast
import inspect
from pathlib import Path

import pytest

import thirdbody as tb
from thirdbody.views import plot

ROOT = Path(__file__).parents[1]
SCRIPTS = sorted(
    path
    for room in ("docs/figures", "benchmarks", "examples")
    for path in (ROOT / room).rglob("*.py")
)
ROOMS = {"tb": tb, "plot": plot}


def called(node: ast.expr) -> object:
    """What a chain of names means that begins with the library, or nothing."""
    names: list[str] = []
    while isinstance(node, ast.Attribute):
        names.append(node.attr)
        node = node.value
    if not (isinstance(node, ast.Name) and node.id in ROOMS and names):
        return None
    found: object = ROOMS[node.id]
    for name in reversed(names):
        found = getattr(found, name)  # a name that is gone fails here
    return found


def wrong_calls(source: str) -> list[str]:
    """Calls of the library that do not bind to its signatures."""
    out = []
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Call) or not callable(target := called(node.func)):
            continue
        if any(isinstance(each, ast.Starred) for each in node.args):
            continue
        if any(word.arg is None for word in node.keywords):
            continue
        try:
            signature = inspect.signature(target)
        except ValueError:  # built in
            continue
        try:
            signature.bind(*node.args, **{w.arg: w for w in node.keywords})
        except TypeError as error:
            out.append(f"line {node.lineno}: {ast.unparse(node)[:80]}: {error}")
    return out


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_calls_bind(path):
    assert wrong_calls(path.read_text("utf-8")) == []


def test_a_call_that_does_not_bind_is_found():
    assert wrong_calls("plot.mode_map(contact, sizes, loads, ax=made)")
    assert wrong_calls("tb.Roughness(sigma=1e-7, radius=1e-6)")
    assert not wrong_calls("tb.Roughness(sigma=1e-7, R=1e-6)")
    with pytest.raises(AttributeError):
        wrong_calls("tb.no_such_thing(1)")
