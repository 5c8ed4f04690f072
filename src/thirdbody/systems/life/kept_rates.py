"""Rates of a long history in a file, so that it goes on where it was interrupted.

The steps of a history follow from its rates alone. So every rate that was computed is kept, with
the place at which its gap was found, and read back in the same order: the history is the same to
the last bit as one that was never interrupted.
"""

from __future__ import annotations

import base64
import binascii
import hashlib
import json
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...errors import InvalidValue, Mistake
from ...quantities.files import need_folders
from ...version import __version__

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .loop import Loop

    Array = NDArray[np.float64]

__all__ = ["KeptRates", "plain_inputs"]


class _Kept(NamedTuple):
    """One rate: of which state, where the gap was found, and its numbers."""

    of: int
    warm: tuple[float, ...]
    value: Array

    @property
    def check(self) -> int:
        """What another rate would hardly have alike."""
        return zlib.crc32(np.append(self.value, self.warm).tobytes(), self.of)


def plain_inputs(arguments: Mapping[str, object]) -> dict[str, object]:
    """Arguments as what tells one set of them from another.

    Parameters
    ----------
    arguments : mapping
    """
    return {
        name: value.to_dict() if hasattr(value, "to_dict") else repr(value)
        for name, value in arguments.items()
    }


class KeptRates:
    """The rates of one history, a line each; of none without a file.

    Parameters
    ----------
    file : Path or None
        Made when missing.
    inputs : mapping
        What the history follows from: a file of other inputs is refused.

    Raises
    ------
    InvalidValue
        A file of something else, or of other inputs.
    """

    def __init__(self, file: Path | None = None, inputs: Mapping[str, object] | None = None):
        self.file, self.next = file, 0
        self.rates: list[_Kept] = []
        if file is None:
            return
        text = json.dumps(
            {"version": __version__} | dict(inputs or {}), sort_keys=True, default=repr
        )
        head = json.dumps({"one history of": hashlib.sha256(text.encode()).hexdigest()})
        if file.exists():
            self._read_file(file, head)
        else:
            need_folders(file)
            file.write_text(head + "\n", "utf-8")

    def _read_file(self, file: Path, head: str) -> None:
        wrong = f"{file} does not hold the history of this study; remove it, or name another file"
        try:
            lines = file.read_text("utf-8").split("\n")
        except (UnicodeDecodeError, OSError):
            raise InvalidValue(wrong, code=Mistake.UNREADABLE) from None
        if lines[0] != head:
            raise InvalidValue(wrong, code=Mistake.OTHER_STUDY)
        whole = []
        for line in lines[1:]:
            try:
                entry = json.loads(line)
                numbers = np.frombuffer(base64.b64decode(entry["value"]), "<f8")
                value = numbers.reshape(entry["shape"]).astype(float)
                kept = _Kept(entry["of"], tuple(entry["warm"]), value)
                if kept.check != entry["check"]:
                    break  # it was changed: all from here on is computed again
            except (ValueError, KeyError, TypeError, binascii.Error):
                break  # the one that was being written when it ended
            self.rates.append(kept)
            whole.append(line)
        file.write_text("\n".join([head, *whole, ""]), "utf-8")

    def rate(self, loop: Loop, time: float, y: Array, compute: Callable[[], Array]) -> Array:
        """A rate of a state: as it was kept, or computed and kept.

        Parameters
        ----------
        loop : Loop
            Whose gap is found on the way.
        time : float
            [s].
        y : array (n,)
            The state.
        compute : callable
            Gives the rate.
        """
        if self.file is None:
            return compute()
        of = zlib.crc32(np.append(y, time).tobytes())
        if self.next < len(self.rates) and self.rates[self.next].of == of:
            kept = self.rates[self.next]
            self.next += 1
            loop.start_warm(kept.warm)
            return kept.value.copy()
        self.rates = []  # what follows is of another course
        value = np.asarray(compute(), float)
        kept = _Kept(of, loop.warm, value)
        numbers = np.ascontiguousarray(value, "<f8").tobytes()
        entry = {
            "of": of,
            "check": kept.check,
            "warm": kept.warm,
            "shape": value.shape,
            "value": base64.b64encode(numbers).decode(),
        }
        with self.file.open("a", encoding="utf-8") as out:
            out.write(json.dumps(entry) + "\n")
        return value
