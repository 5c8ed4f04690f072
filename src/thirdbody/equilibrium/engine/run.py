"""Many states by the kernel, and what is said of each."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

import numpy as np

from ...contact.broken_averages import is_rough
from ...contact.contact import Contact
from ...contact.interface import together
from ..columns import as_columns
from ..compiled.batch import NOT_BALANCED, NOT_MONOTONE
from ..load_scan import RESIDUAL
from ..status import Status
from . import fields as f
from .columns import Numbers, rules

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Index = NDArray[np.int64]

__all__ = ["DOUBTS", "lowest_separations", "own_columns"]

AT_ONCE = 256
"""States handed to a thread at a time."""
NOT_RESOLVED = "its error by the compiled engine may be above 1e-9"
TOO_LONG = "it takes more nodes than the compiled engine has room for"
SQUEEZED = "particles are squeezed by more than their size on a field of heights"
NO_TABLE = "its bandwidth is outside the table of the law field"
DOUBTS = (NOT_BALANCED, NOT_MONOTONE, NOT_RESOLVED, TOO_LONG, SQUEEZED, NO_TABLE)
"""Why a state is for the NumPy engine to judge."""
CODES = {
    f.UNSOLVED: NOT_BALANCED,
    f.TOO_LITTLE: NOT_BALANCED,
    f.NOT_MONOTONE: NOT_MONOTONE,
    f.NOT_RESOLVED: NOT_RESOLVED,
    f.TOO_LONG: TOO_LONG,
    f.SQUEEZED: SQUEEZED,
    f.NO_TABLE: NO_TABLE,
}


AGAIN = f.NOT_RESOLVED, f.NOT_MONOTONE, f.UNSOLVED
"""What may become of samples that are solved roughly, for which more care may find a state."""
CLEARLY = 0.999
"""Part of a load that is carried at most where it is too much for sure."""
LIFTED = 0.02
"""How far particles that are few may pull the ground of asperities below its separations [σ]."""
ROUGH = 1e-6
"""Estimated error that does for one of many samples."""


def own_columns(
    contact: Contact, arrays: Mapping[str, Array], load: str, loads: Array, threads: int = 1
) -> dict[str, Any]:
    """Every column of states at the given pressure [Pa], F* [1] or d [m].

    ``doubt`` says of each state why it is for the NumPy engine to judge, or nothing; ``error`` is
    its estimate.

    Raises
    ------
    NotCompiled
        Models that the kernel does not know.
    """
    count = len(loads)
    numbers = Numbers(contact, arrays, count)
    E, rough = numbers.varied.E_ss, numbers.varied.roughness
    unit, origin = numbers.skins[:, 0, f.SIGMA_S], numbers.origin
    target = None if load == "d" else loads * E if load == "F_star" else loads
    given = np.full(count, np.nan) if target is not None else (loads - origin) / unit
    h, evaluations, fate, error, rows = solve(numbers, target, given, threads)
    if target is None:
        deep = (given < numbers.deepest) & ~numbers.outside
        fate[deep], evaluations[deep] = Status.TOO_DEEP, 0
    if is_rough():
        fate[(fate == f.NOT_RESOLVED) & (error <= ROUGH)] = f.OK
    bad = fate != f.OK
    h[bad] = np.nan
    rows[bad] = np.nan
    columns = np.ascontiguousarray(rows.T)
    names = ("F_sa", "A_e", "A_ep", "A_p", "A_sa2", "shadow")
    part = dict(zip(names, columns[4:], strict=True))
    part["shadow"] = np.minimum(part["shadow"], 1.0)
    raw = together(columns[0], list(columns[1:4]), part)
    d = np.where(bad, np.nan, loads) if target is None else origin + unit * h
    star = loads if load == "F_star" else None
    found = as_columns(
        raw, d, rough.y_s - numbers.centre, rough.sigma, E, target=target, F_star=star
    )
    doubt = np.full(count, "", dtype=object)
    for code, why in CODES.items():
        doubt[fate == code] = why
    doubt[(fate == f.OK) & ~(found["residual"] <= RESIDUAL)] = NOT_BALANCED
    fate[doubt != ""] = f.UNSOLVED
    return found | {"status": fate, "iterations": evaluations, "doubt": doubt, "error": error}


def lowest_separations(contact: Contact, arrays: Mapping[str, Array], count: int) -> Array:
    """Separations d [m] below which the models of asperities of contacts (N,) end, or little above.

    Raises
    ------
    NotCompiled
        Models that the kernel does not know.
    """
    numbers = Numbers(contact, arrays, count)
    deepest = numbers.deepest + (LIFTED if numbers.ground is not None else 0.0)
    return np.asarray(numbers.origin + numbers.skins[:, 0, f.SIGMA_S] * deepest)


def solve(
    numbers: Numbers, target: Array | None, given: Array, threads: int = 1
) -> tuple[Array, Index, Index, Array, Array]:
    """Separations [σ_s], evaluations, fates, errors and columns of states."""
    count = numbers.count
    h = np.array(given)
    # an array of its own: one that may not be written to would be compiled for anew
    goal = np.array(np.broadcast_to(0.0 if target is None else target, count), dtype=float)
    evaluations, fate = np.zeros(count, np.int64), np.zeros(count, np.int64)
    error, rows = np.zeros(count), np.zeros((count, len(f.COLUMNS)))
    samples = is_rough()  # threads do not see that

    def solve_from(start: int) -> None:
        here = slice(start, start + AT_ONCE)
        found = goal[here], h[here], evaluations[here], fate[here], error[here], rows[here]
        solve_states(numbers, here, found, samples)
        if samples and len(some := start + np.flatnonzero(np.isin(found[3], AGAIN))):
            solve_with_care(some)

    def solve_with_care(some: Index) -> None:
        results = h, evaluations, fate, error, rows
        fate[some] = f.OK
        found = tuple(values[some] for values in results)
        solve_states(numbers, some, (goal[some], *found), samples=False)
        for values, again in zip(results, found, strict=True):
            values[some] = again

    starts = range(0, count, AT_ONCE)
    if (workers := min(threads, len(starts))) > 1:
        solve_from(0)  # compiled once, not by every thread
        with ThreadPoolExecutor(workers) as pool:
            list(pool.map(solve_from, starts[1:]))
    else:
        for start in starts:
            solve_from(start)
    if numbers.skins.shape[2] == f.OF_FIELD and numbers.ground is None:
        doubt_ends(numbers, goal, fate)
    fate[numbers.outside] = f.NO_TABLE
    return h, evaluations, fate, error, rows


def doubt_ends(numbers: Numbers, goal: Array, fate: Index) -> None:
    """Leave to NumPy loads that are too much by less than a thousandth on one field of heights."""
    some = np.flatnonzero(fate == f.TOO_MUCH)
    if not len(some):
        return
    h = np.broadcast_to(numbers.deepest, numbers.count)[some]
    counts, fates = np.zeros((2, len(some)), np.int64)
    rows = np.zeros((len(some), len(f.COLUMNS)))
    results = np.zeros(len(some)), np.array(h), counts, fates, np.zeros(len(some)), rows
    solve_states(numbers, some, results, samples=False)
    most = (1 - np.minimum(rows[:, f.SHADE], 1.0)) * rows[:, f.F_SS] + rows[:, f.F_SA]
    fate[some[~(most < CLEARLY * goal[some])]] = f.UNSOLVED


def solve_states(
    numbers: Numbers,
    here: slice | Index,
    found: tuple[NDArray[np.generic], ...],
    samples: bool,
) -> None:
    """Solve some states, into what is to be found; samples roughly."""
    breaks, ground = bool(numbers.inside[0, 0] > 0), numbers.ground
    own = numbers.skins[here], numbers.parts[here], numbers.bodies[here]
    if ground is None:
        from .balance import solve_own

        solve_own(*own, rules(breaks, samples), numbers.inside, numbers.coating, *found)
        return
    from .grounded import EXACT, ROUGH, solve_grounded

    known = ground.displacements
    solve_grounded(
        *(own[0], ground.parts[here], own[2], ground.tables[here]),
        *(ground.numbers[here], ground.seats[here]),
        *(known.series, known.alone, known.which[here], known.basis[here]),
        *(rules(), ROUGH if samples else EXACT),
        *found,
    )
