"""What the tests of the papers share."""

import pytest


@pytest.fixture(scope="session")
def ledger_of():
    """The ledger of a study, made once in a process."""
    known = {}

    def make(study):
        if study.name not in known:
            known[study.name] = study.ledger()
        return known[study.name]

    return make
