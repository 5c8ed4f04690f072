"""What the tests of the page share."""

import pytest

LATE = r"TimeoutError: |did not come in time"
"""What a browser says that had no processor: on a machine with other work it is asked again."""


def pytest_collection_modifyitems(items):
    for item in items:
        if "browser" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.flaky(reruns=2, only_rerun=[LATE]))
