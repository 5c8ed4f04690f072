"""States of contacts that the library varies of itself, of which it may refuse some."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidValue

__all__ = ["columns_tried"]

Columns = dict[str, NDArray[Any]]
Which = NDArray[np.intp]


def columns_tried(solve: Callable[[Which], Columns], count: int) -> tuple[Columns, dict[int, str]]:
    """Columns of many states, and why those that have none are refused.

    A range that the library tries of itself, a factor of 10 around an input say, may hold contacts
    that no model takes. They are found by halving: one that is refused costs about as much as all
    the states again.

    Parameters
    ----------
    solve : callable
        Gets the places of some states, returns their columns, raises InvalidValue for any of them.
    count : int
        How many states there are.

    Returns
    -------
    columns : dict of arrays (count,)
        NaN, or an empty word, where a state is refused; whole numbers are then NaN too.
    refused : dict
        Places of states that are refused, and the sentences of the error.

    Raises
    ------
    InvalidValue
        Every state is refused: what is wrong is nothing that varies.

    Examples
    --------
    >>> def solve(which):
    ...     if (which > 1).any():
    ...         raise InvalidValue("too far")
    ...     return {"A_t": 0.1 * which}
    >>> columns_tried(solve, 3)
    ({'A_t': array([0. , 0.1, nan])}, {2: 'too far'})
    """
    parts: list[tuple[Which, Columns]] = []
    refused: dict[int, str] = {}
    left = [np.arange(count)]
    first: InvalidValue | None = None
    while left:
        which = left.pop()
        try:
            parts.append((which, solve(which)))
        except InvalidValue as error:
            first = first or error
            if len(which) == 1:
                refused[int(which[0])] = "; ".join(error.problems)
            else:
                half = len(which) // 2
                left += [which[half:], which[:half]]
    if first is not None and not parts:
        raise first
    if not refused:
        parts = parts if len(parts) == 1 else [_join_columns(count, parts)]
        return parts[0][1], {}
    return _join_columns(count, parts)[1], refused


def _join_columns(count: int, parts: list[tuple[Which, Columns]]) -> tuple[Which, Columns]:
    """Columns of all states; those that none of the parts holds are not known."""
    out: Columns = {}
    for which, columns in parts:
        for name, values in columns.items():
            if name not in out:
                words = values.dtype.kind in "OUS"
                out[name] = np.full(count, "" if words else np.nan, object if words else float)
            out[name][which] = values
    return np.arange(count), out
