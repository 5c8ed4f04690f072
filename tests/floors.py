"""The oldest releases that pyproject.toml allows, one `name==version` a line, for `pip -c`.

Those of what the library needs and of its extras; the tools of the tests and of the book are new.
"""

import re
import tomllib
from pathlib import Path

PYPROJECT = Path(__file__).parent.parent / "pyproject.toml"
TOOLS = ("test", "docs", "dev")


def floors() -> list[str]:
    """`name==version` for every `name[extra]>=version`."""
    project = tomllib.loads(PYPROJECT.read_text("utf-8"))["project"]
    extras = project["optional-dependencies"]
    needs = [*project["dependencies"], *(n for e in extras if e not in TOOLS for n in extras[e])]
    return [re.sub(r"^([\w-]+)(?:\[.*\])?>=([\w.]+)$", r"\1==\2", need) for need in needs]


if __name__ == "__main__":
    print(*floors(), sep="\n")
