"""Ends of histories in a file, so that a long run goes on where it was interrupted."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..errors import InvalidValue, Mistake
from ..quantities.files import need_folders
from ..version import __version__

__all__ = ["KeptEnds"]


class KeptEnds:
    """The ends of histories that are done, a line each; in memory only without a file.

    Parameters
    ----------
    file : Path or None
        Made with the first history when missing.
    inputs : mapping
        What the histories follow from: a file of other inputs is refused.

    Raises
    ------
    InvalidValue
        A file of something else, or of other inputs.

    Examples
    --------
    >>> kept = KeptEnds(None, {"volume": 1.0})
    >>> kept.add(0, {"wear": 1e-6}), kept.get(0), kept.get(1)
    ({'wear': 1e-06}, {'wear': 1e-06}, None)
    """

    def __init__(self, file: Path | None, inputs: Mapping[str, object]):
        self.file = file
        text = json.dumps({"version": __version__} | dict(inputs), sort_keys=True, default=repr)
        self.of = hashlib.sha256(text.encode()).hexdigest()
        self.ends: dict[int, dict[str, Any]] = {}
        if file is None:
            return
        if file.exists():
            self._read(file)
        else:
            need_folders(file)

    def _read(self, file: Path) -> None:
        wrong = f"{file} does not hold histories of this study; remove it, or name another file"
        try:
            lines = file.read_text("utf-8").split("\n")
            head = json.loads(lines[0])
        except (ValueError, UnicodeDecodeError, OSError):
            raise InvalidValue(wrong, code=Mistake.UNREADABLE) from None
        if not isinstance(head, dict) or head.get("histories of") != self.of:
            raise InvalidValue(wrong, code=Mistake.OTHER_STUDY)
        whole = []
        for line in lines[1:]:
            try:
                entry = json.loads(line)
                self.ends[int(entry["i"])] = _from_plain(entry["end"])
            except (ValueError, KeyError, TypeError):
                continue  # the one that was being written when it ended
            whole.append(line)
        file.write_text("\n".join([lines[0], *whole, ""]), "utf-8")

    @property
    def count(self) -> int:
        """Histories that are done."""
        return len(self.ends)

    def get(self, i: int) -> dict[str, Any] | None:
        """The end of a history; None where it is not done.

        Parameters
        ----------
        i : int
            Which set of inputs.
        """
        return self.ends.get(i)

    def add(self, i: int, end: dict[str, Any]) -> dict[str, Any]:
        """Keep the end of a history, and return it.

        Parameters
        ----------
        i : int
            Which set of inputs.
        end : dict
            Numbers, lists of them, and dictionaries of them.
        """
        self.ends[i] = end
        if self.file is not None:
            line = json.dumps({"i": i, "end": _to_plain(end)})
            if not self.file.exists():  # a run that fails before its first history leaves none
                self.file.write_text(json.dumps({"histories of": self.of}) + "\n", "utf-8")
            with self.file.open("a", encoding="utf-8") as out:
                out.write(line + "\n")
        return end


def _to_plain(end: Mapping[str, object]) -> dict[str, object]:
    """Every number as JSON has it; NaN is null."""
    return {k: None if isinstance(v, float) and math.isnan(v) else v for k, v in end.items()}


def _from_plain(end: Mapping[str, object]) -> dict[str, Any]:
    out = {k: math.nan if v is None else v for k, v in end.items()}
    return {k: tuple(v) if isinstance(v, list) else v for k, v in out.items()}
