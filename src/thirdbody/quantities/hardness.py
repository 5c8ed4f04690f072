"""Hardness numbers and what they mean: Vickers, Brinell, Rockwell C and Knoop as mean pressures.

The hardness H of the contact laws is a mean pressure on the *projected* area of an indent. A
Vickers number divides the load in kgf by the area of the four slant faces, a Knoop number by the
projected area. Brinell and Rockwell numbers of steels are led to Vickers numbers by published
tables (`data/hardness.toml`).
"""

from __future__ import annotations

import math
import tomllib
from functools import cache
from importlib import resources
from typing import Any

import numpy as np

from ..errors import InvalidValue, Mistake
from ..quantities.carried import takes_units

__all__ = ["convert", "pressure", "tables"]

KGF_PER_MM2 = 9.80665e6
"""One kgf/mm² [Pa], exact."""

VICKERS = KGF_PER_MM2 / math.sin(math.radians(136 / 2))
"""Mean pressure on the projected area [Pa] per Vickers number: faces at 136° to each other."""

_COLUMNS = ("HV", "HB", "HRC")
_ALSO_WRITTEN = {"HBW": "HB", "HBS": "HB"}


@cache
def tables() -> dict[str, dict[str, Any]]:
    """The published tables that convert hardness, by name.

    Returns
    -------
    dict
        For each table its title, source and rows (HV, HB, HRC); NaN where a scale ends.

    Examples
    --------
    >>> from thirdbody.quantities.hardness import tables
    >>> list(tables())
    ['iso18265', 'astm-e140']
    """
    text = resources.files("thirdbody").joinpath("data/hardness.toml").read_text("utf-8")
    return tomllib.loads(text)


@cache
def _columns(table: str, start: str, end: str) -> tuple[np.ndarray, np.ndarray]:
    """The rows of a table in which both scales stand."""
    if table not in tables():
        raise InvalidValue(
            f"table = {table!r} must be one of {', '.join(map(repr, tables()))}",
            code=Mistake.OPTION,
        )
    rows = np.array(tables()[table]["rows"], dtype=float)
    x, y = (rows[:, _COLUMNS.index(scale)] for scale in (start, end))
    both = np.isfinite(x) & np.isfinite(y)
    return x[both], y[both]


def _by_table(value: float, start: str, end: str, table: str) -> float:
    if start == end:
        return value
    x, y = _columns(table, start, end)
    if not x[0] <= value <= x[-1]:
        raise InvalidValue(
            f"{value:g} {start} has no {end} in {tables()[table]['source'].partition(' (')[0]}, "
            f"which goes from {x[0]:g} to {x[-1]:g} {start} there; give a Vickers number or GPa",
            code=Mistake.BEYOND,
        )
    return float(np.interp(value, x, y))


def _scales_text(scale: str, allowed: tuple[str, ...]) -> str:
    scale = _ALSO_WRITTEN.get(scale, scale)
    if scale not in allowed:
        hint = (
            "; a Knoop number is a mean pressure, see pressure(value, 'HK')"
            if scale == "HK"
            else ""
        )
        raise InvalidValue(
            f"scale {scale!r} must be one of {', '.join(allowed)}{hint}", code=Mistake.OPTION
        )
    return scale


def _positive(value: float, scale: str) -> float:
    if not (math.isfinite(value) and value > 0):
        raise InvalidValue(f"{value:g} {scale} must be a finite number > 0", code=Mistake.RANGE)
    return float(value)


@takes_units
def convert(value: float, start: str, end: str, *, table: str = "iso18265") -> float:
    r"""A hardness of steel on another scale.

    Vickers numbers and GPa are two units of one measurement, joined by the geometry of the
    pyramid, :math:`H = \mathrm{HV}\; g\,\mathrm{kgf/mm^2} / \sin 68°`, that is 10.577 MPa per
    Vickers number. Brinell and Rockwell C numbers are interpolated linearly in a table.

    Parameters
    ----------
    value : float
        The hardness number, or GPa.
    start, end : {"HV", "HB", "HRC", "GPa"}
        Scale of ``value`` and scale wanted; "HBW" counts as "HB".
    table : {"iso18265", "astm-e140"}, optional
        Which published table.

    Returns
    -------
    float
        The hardness on the other scale.

    Raises
    ------
    InvalidValue
        An unknown scale or table, or a value outside the table: nothing is extrapolated.

    Notes
    -----
    The tables hold for steels and are empirical; the two agree within 1 % in HV. For other
    materials convert HV and GPa only.

    References
    ----------
    ISO 18265:2013, Table A.1; ASTM E140, Table 1; ISO 6507-1 (Vickers).

    Examples
    --------
    >>> from thirdbody.quantities.hardness import convert
    >>> round(convert(62, "HRC", "HV")), round(convert(300, "HV", "HB"))
    (746, 285)
    >>> round(convert(700, "HV", "GPa"), 3)
    7.404
    """
    allowed = (*_COLUMNS, "GPa")
    start, end = _scales_text(start, allowed), _scales_text(end, allowed)
    value = _positive(value, start)
    if start == "GPa":
        start, value = "HV", value * 1e9 / VICKERS
    if end == "GPa":
        return _by_table(value, start, "HV", table) * VICKERS / 1e9
    return _by_table(value, start, end, table)


@takes_units
def pressure(value: float, scale: str) -> float:
    r"""Mean pressure H [Pa] on the projected area of an indent, from a hardness number.

    HV: :math:`9.80665\,\mathrm{MPa}/\sin 68°` per number. HK: 9.80665 MPa per number, since Knoop
    numbers refer to the projected area already. HB and HRC: through HV by ISO 18265, for steels.

    Parameters
    ----------
    value : float
        The hardness number.
    scale : {"HV", "HK", "HB", "HRC"}
        Its scale; "HBW" counts as "HB".

    Returns
    -------
    float
        H [Pa].

    Raises
    ------
    InvalidValue
        An unknown scale, or a number outside the table.

    Examples
    --------
    >>> from thirdbody.quantities.hardness import pressure
    >>> [round(pressure(*number) / 1e9, 2) for number in ((700, "HV"), (62, "HRC"), (200, "HB"))]
    [7.4, 7.89, 2.23]
    """
    scale = _scales_text(scale, (*_COLUMNS, "HK"))
    value = _positive(value, scale)
    if scale == "HK":
        return value * KGF_PER_MM2
    return _by_table(value, scale, "HV", "iso18265") * VICKERS
