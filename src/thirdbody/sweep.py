"""Sweeps: many states of many contacts as one labelled data set."""

from __future__ import annotations

import itertools
import json
import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from .citations import cite
from .contact import Contact
from .equilibrium import COLUMNS, given_load, solve
from .errors import InvalidValue, RangeWarning
from .states import varied

if TYPE_CHECKING:
    import xarray

__all__ = ["sweep"]

LOAD_UNITS = {"F_star": "1", "pressure": "Pa", "d": "m"}


def sweep(
    contact: Contact,
    *,
    F_star: ArrayLike | None = None,
    pressure: ArrayLike | None = None,
    d: ArrayLike | None = None,
    vary: Mapping[str, Sequence[Any]] | None = None,
) -> xarray.Dataset:
    """States of a contact over loads and any of its inputs, on a grid.

    Parameters
    ----------
    contact : Contact
        The inputs that are not varied.
    F_star, pressure, d : array_like
        Loads, as in `solve`; exactly one.
    vary : mapping, optional
        Dotted names of fields and the values they take, e.g.
        ``{"particles.diameter.mean": [0, 100e-9, 300e-9]}``. A mean diameter or an areal
        density of zero stands for two-body contact.

    Returns
    -------
    xarray.Dataset
        One dimension for each varied input and one for the load; every column of `Equilibrium`
        as a variable with ``units``, ``long_name`` and ``symbol``; inputs, version and citations
        as attributes. A state without equilibrium is NaN with its reason in ``status``.

    Raises
    ------
    InvalidValue
        An unknown name, an empty list, or a value that the field refuses.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> curves = tb.sweep(contact, F_star=[1e-6, 1e-5], vary={"roughness.sigma": [1e-7, 2e-7]})
    >>> curves.A_t.dims
    ('roughness.sigma', 'F_star')
    """
    import xarray as xr

    from . import __version__

    load, _, _ = given_load(contact, pressure, F_star, d)
    loads = np.atleast_1d(np.asarray({"pressure": pressure, "F_star": F_star, "d": d}[load], float))
    vary = {name: list(values) for name, values in (vary or {}).items()}
    for name, values in vary.items():
        if not values:
            raise InvalidValue(f"vary[{name!r}] is empty; give at least one value")
    shape = (*(len(values) for values in vary.values()), len(loads))
    columns: dict[str, np.ndarray] = {}
    notes: dict[str, None] = {}
    for index in itertools.product(*(range(len(values)) for values in vary.values())):
        changes = {name: vary[name][i] for name, i in zip(vary, index, strict=True)}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RangeWarning)
            state = varied(contact, changes)
            result = solve(state, **{load: loads})  # type: ignore[arg-type]
        notes |= dict.fromkeys(result.warnings)
        for name, column in result.columns().items():
            if name not in columns:
                kind = object if column.dtype.kind in "UO" else column.dtype
                columns[name] = np.empty(shape, dtype=kind)
            columns[name][index] = column
    dims = (*vary, load)
    columns.pop(load)
    coords: dict[str, Any] = {load: (load, loads, _attributes(load) | {"units": LOAD_UNITS[load]})}
    for name, values in vary.items():
        plain = [v if isinstance(v, (int, float, str, bool)) else str(v) for v in values]
        coords[name] = (name, plain)
    for name in ("mode", "status"):
        columns[name] = columns[name].astype(str)
    data = {name: (dims, values, _attributes(name)) for name, values in columns.items()}
    attributes = {
        "inputs": json.dumps(contact.to_dict(), ensure_ascii=False),
        "version": __version__,
        "citations": cite(contact),
        "warnings": "\n".join(notes),
    }
    return xr.Dataset(data, coords=coords, attrs=attributes)


def _attributes(name: str) -> dict[str, str]:
    about = COLUMNS[name]
    return {"units": about["unit"], "long_name": about["meaning"], "symbol": about["symbol"]}
