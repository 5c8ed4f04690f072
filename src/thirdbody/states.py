"""Many states at once, each with its own inputs and its own load."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import engine
from .contact import Contact
from .equilibrium import COLUMNS, given_load, solve
from .errors import InvalidValue, RangeWarning

__all__ = ["solve_states", "varied"]


def solve_states(
    contact: Contact,
    *,
    F_star: ArrayLike | None = None,
    pressure: ArrayLike | None = None,
    d: ArrayLike | None = None,
    vary: Mapping[str, ArrayLike] | None = None,
) -> dict[str, NDArray[Any]]:
    """N states of a contact: state i has the i-th load and the i-th value of every varied input.

    Parameters
    ----------
    contact : Contact
        The inputs that are not varied.
    F_star, pressure, d : float or array (N,)
        Loads, as in `solve`; exactly one.
    vary : mapping, optional
        Dotted names of inputs and their values, each a number or an array (N,), e.g.
        ``{"roughness.sigma": sigma, "particles.diameter.mean": x_a}``. A mean diameter or an
        areal density of zero stands for two-body contact.

    Returns
    -------
    dict
        Every column of `Equilibrium`, arrays (N,). A state without equilibrium is NaN with its
        reason in ``status``.

    Raises
    ------
    InvalidValue
        An unknown name, lengths that do not fit, or a value that the field refuses.

    Examples
    --------
    >>> import numpy as np
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> sigma = np.array([50e-9, 100e-9, 200e-9])
    >>> states = tb.solve_states(contact, pressure=1e6, vary={"roughness.sigma": sigma})
    >>> states["A_t"].shape
    (3,)
    """
    load, _, _ = given_load(contact, pressure, F_star, d)
    given = {"pressure": pressure, "F_star": F_star, "d": d}[load]
    inputs = {load: np.asarray(given, float), **{k: np.asarray(v) for k, v in (vary or {}).items()}}
    try:
        arrays = dict(zip(inputs, np.broadcast_arrays(*inputs.values()), strict=True))
    except ValueError:
        sizes = ", ".join(f"{name} {values.shape}" for name, values in inputs.items())
        raise InvalidValue(f"inputs of different lengths: {sizes}; each must be one or N") from None
    loads = np.atleast_1d(arrays.pop(load))
    if loads.ndim > 1:
        raise InvalidValue(f"inputs have {loads.ndim} dimensions; give numbers or 1-D arrays")
    if any(len(np.unique(values)) >= FEWEST for values in arrays.values()):
        columns = _compiled(contact, arrays, load, loads)
        if columns is not None:
            return columns
    return _by_groups(contact, arrays, load, loads)


ABSENT = ("particles.diameter.mean", "particles.areal_density")
"""Inputs that are zero where there are no particles."""
FEWEST = 20
"""Different values of an input for which shared nodes are quicker than tables of each."""
AT_ONCE, FEW = 50_000, 512
"""States laid out at a time, and where each has nodes of its own."""
FATES = (
    "ok",
    "no equilibrium: the load is beyond the most this model carries down to a separation of "
    "-3 sigma_s; check the unit of the load",
    "no equilibrium: the load is below the smallest load this model resolves; check the unit of "
    "the load",
)


def _compiled(
    contact: Contact, arrays: Mapping[str, NDArray[Any]], load: str, loads: NDArray[np.float64]
) -> dict[str, NDArray[Any]] | None:
    """Every column by the compiled engine, or None where it does not know these inputs."""
    if not engine.available():
        return None
    arrays = {name: np.atleast_1d(values) for name, values in arrays.items()}
    numbers = {
        name: values.astype(float) for name, values in arrays.items() if values.dtype.kind in "iuf"
    }
    present = np.ones(len(loads), bool)
    for name in ABSENT:
        present &= numbers.get(name, np.ones(1)) != 0
    if len(numbers) < len(arrays) or not present.all():
        return None
    parts = []
    own = engine.own_particles(numbers)
    # states that need as many nodes side by side
    order = np.argsort(engine.fineness(contact, numbers)) if own else np.arange(len(loads))
    at_once = FEW if own else AT_ONCE
    for start in range(0, len(loads), at_once):
        here = order[start : start + at_once]
        inputs = {name: values[here] for name, values in numbers.items()}
        try:
            batch = engine.States(contact, inputs, len(loads[here]))
        except TypeError:
            return None
        parts.append(batch.columns(load, loads[here]))
        parts[-1]["status"] = np.array(FATES, dtype=object)[parts[-1]["status"]]
    back = np.argsort(order)
    return {name: np.concatenate([part[name] for part in parts])[back] for name in COLUMNS}


def _by_groups(
    contact: Contact,
    arrays: Mapping[str, NDArray[Any]],
    load: str,
    loads: NDArray[np.float64],
) -> dict[str, NDArray[Any]]:
    """Every column, one contact after another."""
    columns: dict[str, NDArray[Any]] = {}
    for which in _groups(arrays, len(loads)):
        state = varied(contact, {name: values[which[0]].item() for name, values in arrays.items()})
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RangeWarning)
            result = solve(state, **{load: loads[which]})  # type: ignore[arg-type]
        for name, column in result.columns().items():
            if name not in columns:
                kind = object if column.dtype.kind in "UO" else column.dtype
                columns[name] = np.empty(len(loads), dtype=kind)
            columns[name][which] = column
    return {name: columns[name] for name in COLUMNS}


def _groups(arrays: Mapping[str, NDArray[Any]], count: int) -> list[NDArray[np.intp]]:
    """The numbers of the states that have equal inputs."""
    if not arrays:
        return [np.arange(count)]
    keys = np.stack([np.unique(values, return_inverse=True)[1] for values in arrays.values()])
    group = np.unique(keys, axis=1, return_inverse=True)[1].ravel()
    order = np.argsort(group, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(group[order])) + 1)


def varied(contact: Contact, changes: Mapping[str, Any]) -> Contact:
    """The contact with some inputs changed; a size or density of zero removes the particles."""
    if any(changes.get(name, 1) == 0 for name in ABSENT):
        kept = {name: v for name, v in changes.items() if not name.startswith("particles.")}
        return contact.replace(particles=None).replace(**kept)
    return contact.replace(**changes)
