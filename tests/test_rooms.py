"""The rooms of the house stand one on another; pyproject.toml says in which order."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent


def test_imports_point_one_way():
    """Lazy imports and those for types count, too."""
    pytest.importorskip("importlinter", reason="pip install -e '.[test]'")
    code = "from importlinter.cli import lint_imports_command as run; run()"
    command = [sys.executable, "-c", code, "--no-cache", "--config", str(ROOT / "pyproject.toml")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_no_module_but_the_top_answers_for_names_it_has_not():
    """A module's names are those that stand in it."""
    folder = ROOT / "src" / "thirdbody"
    found = [
        path for path in folder.rglob("*.py") if "\ndef __getattr__(" in path.read_text("utf-8")
    ]
    assert found == [folder / "__init__.py"]
