"""What the tests of the page share."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))
from browser import chromium, ended, served

LATE = r"TimeoutError: |did not come in time"
"""What a browser says that had no processor: on a machine with other work it is asked again."""


def pytest_collection_modifyitems(items):
    for item in items:
        if "browser" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.flaky(reruns=2, only_rerun=[LATE]))


@pytest.fixture(scope="module")
def server():
    """A server of the page on a free port, of one module: what others left undone keeps none of
    its tests waiting; and its address."""
    process, address = served()
    yield process, address
    ended(process)


@pytest.fixture(scope="module")
def address(server):
    return server[1]


@pytest.fixture(scope="module")
def browser():
    """One for a module: what runs it would be in the way of tests with a loop of their own."""
    sync_api = pytest.importorskip("playwright.sync_api", reason="needs playwright")
    with sync_api.sync_playwright() as playwright:
        found = chromium(playwright)
        if found is None:
            pytest.skip("no chromium found, neither the system's nor playwright's: make browser")
        made = playwright.chromium.launch(executable_path=found, args=["--no-sandbox"])
        yield made
        made.close()
