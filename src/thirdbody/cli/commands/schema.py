"""``thirdbody schema``: what a study file may hold, for editors."""

from __future__ import annotations

import json

__all__ = ["command", "schema_text"]


def command() -> None:
    """JSON Schema of study files, for editors.

    They complete keys and words by it: thirdbody schema > FILE.json
    """
    print(schema_text(), end="")


def schema_text() -> str:
    """The schema as the text of a file."""
    from ...study import study_schema

    return json.dumps(study_schema(), indent=1, ensure_ascii=False) + "\n"
