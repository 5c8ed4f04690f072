"""Every law of the registry through the battery."""

import re
from pathlib import Path

import battery
import pytest
from subjects import ADHESIVE, CIRCLES, ELLIPSES, SUBJECTS, Subject

from thirdbody.laws.asperity import REGISTRY

GUIDE = Path(__file__).parents[2] / "docs" / "add-a-law.md"


@pytest.mark.check
@pytest.mark.parametrize("check", battery.CHECKS, ids=lambda check: check.__name__)
@pytest.mark.parametrize("subject", SUBJECTS, ids=lambda subject: subject.label)
def test_law(subject: Subject, check):
    check(subject.law)


def test_the_known_laws_are_all_here():
    known = CIRCLES | set(ELLIPSES) | ADHESIVE
    assert known <= set(REGISTRY)
    assert known <= {subject.law.name for subject in SUBJECTS}
    for name, kind in REGISTRY.items():
        assert kind.name == name
        for about in ("title", "year", "citation", "provenance", "valid_range"):
            assert getattr(kind, about), (name, about)


def test_the_law_of_the_guide_passes_too():
    """And does not without its jumps, or with another slope."""
    code = re.findall(r"^```python\n(.*?)^```$", GUIDE.read_text("utf-8"), re.S | re.M)[0]
    names: dict = {"__name__": "guide"}
    try:
        exec(code, names)
        law = names["Abrupt"]
        assert battery.failures(law()) == []
        assert battery.failures(law(k=0.5)) == []
        careless = type("Careless", (law,), {"__slots__": (), "jumps": {}})
        assert battery.failures(careless()) == ["jumps_are_declared"]
        late = type("Late", (law,), {"__slots__": (), "breakpoints": (2.0,)})
        assert "jumps_are_declared" in battery.failures(late())
    finally:
        REGISTRY.pop("abrupt", None)
