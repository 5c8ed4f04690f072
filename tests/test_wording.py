"""Wording is asserted by one test a renderer; elsewhere tests compare fields of records."""

import ast
import re
from collections import Counter
from pathlib import Path

TESTS = Path(__file__).parent
PROSE = re.compile(r"[A-Za-z]{2,} [a-z]{2,} [a-z]{2,}")
"""Three words in a row: a sentence, and no name, number or heading."""
COMMAND = re.compile(r"thirdbody [a-z]+ [\w.-]+")
"""A line for a shell, which is no English."""
MOST = {
    "analysis": 5,
    "app": 11,
    "cli": 19,
    "effects": 2,
    "equilibrium": 9,
    "explicit": 8,
    "laws": 3,
    "papers": 8,
    "populations": 2,
    "quantities": 9,
    "study": 6,
    "systems": 10,
    "tests": 6,
    "views": 9,
}
"""Assertions that compare English, by room; these numbers only fall."""


def text_of(node):
    """The text of a literal, without what an f-string puts in."""
    if isinstance(node, ast.JoinedStr):
        return "\0".join(str(getattr(each, "value", "")) for each in node.values
                         if isinstance(each, ast.Constant))  # fmt: skip
    value = getattr(node, "value", "") if isinstance(node, ast.Constant) else ""
    return value if isinstance(value, str) else ""


READ = {"count", "endswith", "find", "index", "partition", "rpartition", "split", "startswith"}
READ |= {"findall", "fullmatch", "match", "search"}
"""Calls that look for a text in another one."""


def compared(node):
    """Literals that are compared or looked for inside an expression: no keys, no arguments."""
    if isinstance(node, ast.Subscript):
        yield from compared(node.value)
    elif isinstance(node, ast.Call):
        yield from compared(node.func)
        if getattr(node.func, "attr", "") in READ:
            yield from (each for argument in node.args for each in compared(argument))
    elif isinstance(node, ast.Constant | ast.JoinedStr):
        yield node
    else:
        yield from (each for child in ast.iter_child_nodes(node) for each in compared(child))


def holds_prose(node):
    """Whether a literal that is compared is prose."""
    return any(PROSE.search(COMMAND.sub("", text_of(each))) for each in compared(node))


def lines_of(tree):
    """Lines at which English is compared: in assertions, and in what an error or warning says."""
    for node in ast.walk(tree):
        says = isinstance(node, ast.keyword) and node.arg in ("match", "says")
        if isinstance(node, ast.Assert) and holds_prose(node.test):
            yield node.lineno
        elif says and holds_prose(node.value):
            yield node.value.lineno


def test_what_counts_as_a_comparison_of_english():
    compared = """
assert "the leak has emptied it" in told
assert told == f"after {x} the oil is clean"
assert first.startswith("The oil goes from")
with raises(InvalidValue, match="must not be so"): pass
"""
    fields = """
assert (problem.code, problem.place) == (Mistake.RANGE, "life.oil.leak"), "of the three codes"
assert data["of the inner ring"] == number("so many of them")
assert printed == "thirdbody film ball-bearing.toml"
with refuses(Mistake.RANGE, "a", says="σ = 3"): pass
"""
    assert sorted(lines_of(ast.parse(compared))) == [2, 3, 4, 5]
    assert list(lines_of(ast.parse(fields))) == []


def test_wording_is_asserted_in_few_places():
    """Fewer than stated is no mistake, but lower the number."""
    found = Counter()
    for path in TESTS.rglob("*.py"):
        room = path.relative_to(TESTS).parts[0] if path.parent != TESTS else "tests"
        found[room] += len(set(lines_of(ast.parse(path.read_text(encoding="utf-8")))))
    assert {room: number for room, number in found.items() if number > MOST.get(room, 0)} == {}
