"""Numbers with an uncertainty of the package `uncertainties`, which is never needed.

They are known by what they say, ``nominal_value`` and ``std_dev``, as those of pint's measurements
are.
"""

from __future__ import annotations

from typing import Any

from ..errors import InvalidValue, Mistake

__all__ = ["HELD", "are_correlated", "is_uncertain", "shift_value", "uncertain_number"]

HELD = Mistake.KIND.clause(
    "has an uncertainty, which is not held here; give its nominal_value, and the number itself in "
    "vary of propagate or assess"
)
"""Why such a number cannot stand where one number is needed."""


def is_uncertain(value: object) -> bool:
    """Whether a value is a number with an uncertainty.

    >>> is_uncertain(1e-7)
    False
    """
    return hasattr(value, "nominal_value") and hasattr(value, "std_dev")


def are_correlated(one: object, other: object) -> bool:
    """Whether two numbers with an uncertainty rest on the same measurement."""
    return bool(set(getattr(one, "derivatives", ())) & set(getattr(other, "derivatives", ())))


def uncertain_number(value: float, std: float) -> Any:
    """A number of the package `uncertainties`.

    Raises
    ------
    InvalidValue
        It is not installed.
    """
    try:
        from uncertainties import ufloat
    except ImportError:
        raise InvalidValue(
            "numbers with an uncertainty need uncertainties; pip install 'thirdbody[uncertainty]'",
            code=Mistake.ABSENT,
        ) from None
    return ufloat(value, std)


def shift_value(value: float, changes: list[tuple[float, Any]]) -> Any:
    """A value that moves with others: slopes, and numbers with an uncertainty, to first order.

    It stays correlated with them, and is a plain number without any.
    """
    return value + sum(slope * (number - number.nominal_value) for slope, number in changes)
