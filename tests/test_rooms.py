"""What `lint-imports` cannot see of the rooms of the house."""

from pathlib import Path

import pytest

pytestmark = pytest.mark.check
ROOT = Path(__file__).parent.parent


def test_no_module_but_the_top_answers_for_names_it_has_not():
    """A module's names are those that stand in it."""
    folder = ROOT / "src" / "thirdbody"
    found = [
        path for path in folder.rglob("*.py") if "\ndef __getattr__(" in path.read_text("utf-8")
    ]
    assert found == [folder / "__init__.py"]
