"""What can go wrong, in one hierarchy.

A message says what, where, what is allowed, and the likely cause.
"""

__all__ = [
    "InvalidValue",
    "NoEquilibrium",
    "NoTransition",
    "RangeWarning",
    "SlowWarning",
    "ThirdBodyError",
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


class NotCompiled(Exception):
    """The compiled engine does not know these inputs, and why; the NumPy engine takes them.

    Raised and caught inside the library only.
    """


class RangeWarning(UserWarning):
    """A model is used outside the range for which it was derived or published."""


class SlowWarning(UserWarning):
    """What is asked takes more than some seconds: how long, and why."""
