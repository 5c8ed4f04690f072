"""What can go wrong, in one hierarchy.

A message says what, where, what is allowed, and the likely cause.
"""

from __future__ import annotations

import os
import sys
import warnings
from types import FrameType

__all__ = [
    "InvalidValue",
    "NoEquilibrium",
    "NoTransition",
    "RangeWarning",
    "SlowWarning",
    "ThirdBodyError",
    "tell_of_range",
]


class ThirdBodyError(Exception):
    """Base class of every error that this library raises on purpose."""


class InvalidValue(ThirdBodyError, ValueError):
    """An input has no meaning: negative, NaN, wrong dimension, unknown name.

    ``problems`` holds one sentence per mistake, so that a user mends all of them at once.
    """

    def __init__(self, *problems: str):
        self.problems = problems
        super().__init__("\n".join(problems))


class NoEquilibrium(ThirdBodyError, RuntimeError):
    """No separation inside the searched range carries the load."""


class NoTransition(ThirdBodyError, RuntimeError):
    """The contact mode does not change inside the loads searched."""


class WrongKind(InvalidValue):
    """Arguments that are not what a signature says; an outer function may know them better."""


class NotCompiled(Exception):
    """The compiled engine does not know these inputs, and why; the NumPy engine takes them.

    Raised and caught inside the library only.
    """


class RangeWarning(UserWarning):
    """A model is used outside the range for which it was derived or published."""


class SlowWarning(UserWarning):
    """What is asked takes more than some seconds: how long, and why."""


_HERE = os.path.dirname(os.path.abspath(__file__)) + os.sep
_DATACLASSES = os.sep + "dataclasses.py"


def tell_of_range(message: str | Warning, kind: type[Warning] = RangeWarning) -> None:
    """Warn, of a range or whatever `kind` says, at the line of the user that called the library."""
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and _is_inside(frame):
        frame, level = frame.f_back, level + 1
    warnings.warn(message, kind, stacklevel=level)


def _is_inside(frame: FrameType) -> bool:
    """Whether code is this library's, or what Python writes for its classes."""
    code = frame.f_code
    of_dataclass = code.co_filename == "<string>" and code.co_name == "__init__"
    return of_dataclass or code.co_filename.startswith(_HERE) or _DATACLASSES in code.co_filename
