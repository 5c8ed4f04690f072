"""Every law of the registry through the battery."""

import battery
import pytest
from subjects import ADHESIVE, CIRCLES, ELLIPSES, SUBJECTS, Subject

from thirdbody.asperity import REGISTRY


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
