"""What `lint-imports` cannot see of the rooms of the house."""

import ast
from collections import Counter
from pathlib import Path

import pytest

pytestmark = pytest.mark.check
ROOT = Path(__file__).parent.parent


def test_no_module_but_the_top_answers_for_names_it_has_not():
    """A module's names are those that stand in it, or modules inside it that load when asked for."""
    folder = ROOT / "src" / "thirdbody"
    found = [
        path for path in folder.rglob("*.py") if "\ndef __getattr__(" in path.read_text("utf-8")
    ]
    assert {path.relative_to(folder).as_posix() for path in found} == set(LOADED_LATE)


LOADED_LATE = ("__init__.py", "systems/__init__.py", "systems/life/__init__.py")
"""Lists of modules, of which few commands need more than some."""
AT_THE_RIM = (*LOADED_LATE, "app/", "cli/")
"""What may import by a string: the top, the page and the command line."""


@pytest.mark.parametrize("name", LOADED_LATE[1:])
def test_what_loads_late_is_seen_by_the_linter(name):
    """Each module that is imported by its name stands as a plain import, too, for the tools."""
    tree = ast.parse((ROOT / "src" / "thirdbody" / name).read_text("utf-8"))
    plain = [
        alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.level == 1 and node.module is None
        for alias in node.names
    ]
    (listed,) = (
        ast.literal_eval(node.value)
        for node in tree.body
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__"
    )
    assert plain == listed
    folder = (ROOT / "src" / "thirdbody" / name).parent
    assert all((folder / f"{each}.py").is_file() or (folder / each).is_dir() for each in listed)


def _imports_by_string(path):
    """Lines that import a module of the house by a name that is put together or quoted."""
    tree = ast.parse(path.read_text("utf-8"))
    for node in ast.walk(tree):
        called = isinstance(node, ast.Call) and ast.unparse(node.func).rpartition(".")[2]
        if called in ("import_module", "__import__", "resolve_name", "run_module"):
            yield node.lineno, called
        asked = ast.unparse(node) if isinstance(node, ast.Subscript) else ""
        if asked.startswith("sys.modules[") and "thirdbody" in asked:
            yield node.lineno, asked


def test_no_room_is_reached_through_a_string():
    """`lint-imports` sees imports alone, so a door made of text would be hidden from it."""
    folder = ROOT / "src" / "thirdbody"
    found = {
        path.relative_to(folder).as_posix(): list(_imports_by_string(path))
        for path in sorted(folder.rglob("*.py"))
    }
    inside = {name: lines for name, lines in found.items() if lines}
    assert any(name.startswith("cli/") for name in inside)  # the search finds what is there
    hidden = {n: lines for n, lines in inside.items() if not n.startswith(AT_THE_RIM)}
    assert hidden.pop("papers/measurements/listed.py")
    # packages of others, by the name that their extra has
    assert hidden.pop("analysis/sweep/streaming.py")
    assert hidden == {}


BARE = {
    *("told", "given", "found", "made", "asked", "known", "own", "each", "part", "kept", "held"),
    *("taken", "said", "shown", "seen", "heard", "drawn", "put", "met", "lost", "left", "gone"),
    *(
        "laid",
        "built",
        "spent",
        "written",
        "bound",
        "plain",
        "of",
        "at",
        "to",
        "by",
        "with",
        "within",
    ),
    *("over", "under", "on", "in", "for", "into", "out", "up", "down", "near", "beyond", "between"),
    *("behind", "before", "after", "until", "along", "apart", "among", "around", "across", "off"),
}
"""Words that say nothing of what a function does or returns."""
NOUNS = {"speed", "seed", "feed", "bed", "need"}
LEFT = {
    "analysis": 2,
    "contact": 1,
    "effects": 9,
    "equilibrium": 1,
    "errors.py": 1,
    "laws": 11,
    "papers": 3,
    "populations": 22,
    "study": 1,
    "systems": 9,
}
"""How many are left in each room."""


def is_bare(name):
    """Whether a function is named by one participle, preposition or adverb."""
    word = name.strip("_")
    return word in BARE or (word.isalpha() and word.endswith("ed") and word not in NOUNS)


def test_fewer_functions_are_named_by_a_bare_word():
    """A function is a verb with its object, or the noun it returns. The counts only shrink."""
    folder = ROOT / "src" / "thirdbody"
    found = Counter(
        path.relative_to(folder).parts[0]
        for path in folder.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.FunctionDef) and is_bare(node.name)
    )
    assert {room: n for room, n in found.items() if n > LEFT.get(room, 0)} == {}
    assert {room: n for room, n in LEFT.items() if found[room] < n} == {}, "lower these counts"


NINE = {"found", "given", "told", "own", "known", "asked", "bound", "each", "part"}
"""Words that tell nothing of a value."""
FILLERS = {
    "analysis": 1,
    "app": 2,
    "equilibrium": 237,
    "laws": 6,
    "papers": 1,
    "populations": 1,
    "study": 8,
}
"""How many values and arguments are named by one in each room; of equilibrium, the kernels."""


def _bound_names(tree):
    """Names of values, arguments and functions that a module gives."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Name | ast.Attribute) and isinstance(node.ctx, ast.Store):
            yield node.id if isinstance(node, ast.Name) else node.attr
        elif isinstance(node, ast.arg):
            yield node.arg
        elif isinstance(node, ast.FunctionDef | ast.ClassDef):
            yield node.name


def test_fewer_values_are_named_by_a_filler():
    """A value is named by what it is. The counts only shrink."""
    folder = ROOT / "src" / "thirdbody"
    found = Counter(
        path.relative_to(folder).parts[0]
        for path in folder.rglob("*.py")
        for name in _bound_names(ast.parse(path.read_text("utf-8")))
        if name.strip("_") in NINE
    )
    assert {room: n for room, n in found.items() if n > FILLERS.get(room, 0)} == {}
    assert {room: n for room, n in FILLERS.items() if found[room] < n} == {}, "lower these counts"


FORMS = {"to_dict", "to_json", "to_dataset", "to_dataframe", "_repr_html_"}
WRITTEN = {
    # what every record, state, value and table of a notebook has from one place
    "quantities/record.py": 3,
    "quantities/value.py": 1,
    "quantities/notebook.py": 1,
    # a text, not the plain data of a class
    "app/exports.py": 1,
}
"""Functions that write a form of a result by hand; these counts only shrink."""


def test_few_forms_of_results_are_written_by_hand():
    """A record says by `in_dict` what it hands out, and by `_cards` what a notebook shows."""
    folder = ROOT / "src" / "thirdbody"
    found = Counter(
        path.relative_to(folder).as_posix()
        for path in folder.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.FunctionDef) and node.name in FORMS
    )
    assert {path: n for path, n in found.items() if n > WRITTEN.get(path, 0)} == {}
    assert {path: n for path, n in WRITTEN.items() if found[path] < n} == {}, "lower these counts"
    assert sum(WRITTEN.values()) <= 6
