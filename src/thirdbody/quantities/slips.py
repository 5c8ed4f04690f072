"""Numbers in SI that look like slips: allowed, but probably meant in another unit."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import NotRequired, TypedDict

import numpy as np

from ..errors import Note, tell_of_range

__all__ = ["SLIP", "is_silent", "slips_are_told", "unit_meant", "warn_of_load", "warn_of_slip"]

USUAL_LENGTH, USUAL_STRESS, USUAL_LOAD = 0.01, 1e5, 100.0
"""What lies in an interface is shorter [m], what holds it is stiffer [Pa], and what presses it
together is more [Pa]."""
SLIPS: dict[str, tuple[float, float, str]] = {
    "Pa m^0.5": (1e3, math.inf, "MPa m^0.5"),
    "kg/m^3": (50.0, math.inf, "g/cm^3"),
    "Pa s": (0.0, 10.0, "mPa s"),
    "1/Pa": (0.0, 1e-5, "/ GPa"),
    "J/m^2": (0.0, 5.0, "mJ/m^2"),
    "m^3": (0.0, 50.0, "L"),
    "m^3/s": (0.0, 0.5, "L/min"),
    "kg": (0.0, 20.0, "g"),
}
"""Sizes within which numbers in SI are no slip, and what was probably meant outside: a solid is
tougher than 1 kPa m^0.5, denser than 50 kg/m^3; an oil is thinner than 10 Pa s, its pressure
coefficient below 10 /MPa; no surface has 5 J/m^2; and no circuit 50 m³ of oil, 30 m³/min through a
filter, or 20 kg in it."""


class Usual(TypedDict):
    """Unit of a number, and the size up to which it looks like no slip."""

    unit: str
    usual: NotRequired[float | None]


def unit_meant(about: Usual, number: float, *, load: bool = False) -> str | None:
    """The unit that was probably forgotten, where a number in SI is allowed but looks like a slip.

    Lengths of 1 cm and more, moduli, hardnesses and stresses below 0.1 MPa, loads below 100 Pa, and
    what lies outside `SLIPS`.
    """
    unit, size = about["unit"], abs(number)
    usual = about.get("usual") or USUAL_LENGTH
    if unit == "m" and size >= usual:
        return "mm" if usual >= 1 else "nm" if size >= 10 else "um"
    if unit == "Pa" and load:
        return "MPa" if 0 < number < USUAL_LOAD else None
    if unit == "Pa" and about.get("usual"):
        return "kPa" if 0 < number < usual else None
    if unit == "Pa":
        return "GPa" if 0 < number < USUAL_STRESS else None
    least, most, meant = SLIPS.get(unit, (0.0, math.inf, ""))
    return meant if size and not least <= size <= most else None


_is_silent: ContextVar[bool] = ContextVar("_is_silent", default=False)


@contextmanager
def slips_are_told() -> Iterator[None]:
    """Context without warnings of unit slips; the caller reports them."""
    token = _is_silent.set(True)
    try:
        yield
    finally:
        _is_silent.reset(token)


def is_silent() -> bool:
    """Whether nobody is to be warned of a slip here."""
    return _is_silent.get()


SLIP = "unit of "
"""How codes of notes on numbers begin whose unit looks like a slip."""


def warn_of_slip(where: str, about: Usual, number: float, *, load: bool = False) -> None:
    """Warn of a number that looks like a forgotten unit; ``load`` as of `unit_meant`."""
    if not is_silent() and (meant := unit_meant(about, number, load=load)):
        what = f"{where} = {number:g} is taken as {number:g} {about['unit']}: numbers are in SI"
        action = f"was {number:g} {meant} meant?"
        tell_of_range(Note(what, code=SLIP + where, effect=math.inf, action=action))


LOADS = {"pressure": "Pa", "d": "m"}
"""Units of the loads that may lack theirs."""


def warn_of_load(name: str, values: object) -> None:
    """Warn of loads [Pa], or of separations [m], that look like a forgotten unit.

    Of several the largest is asked: a range may begin low.

    >>> import warnings
    >>> with warnings.catch_warnings(record=True) as heard:
    ...     warnings.simplefilter("always")
    ...     warn_of_load("pressure", [1.0, 1e6])
    ...     warn_of_load("pressure", 5)
    >>> [str(each.message) for each in heard]
    ['pressure = 5 is taken as 5 Pa: numbers are in SI; was 5 MPa meant?']
    """
    if name not in LOADS or is_silent():
        return
    try:
        largest = float(np.max(values))  # type: ignore[call-overload]
    except (TypeError, AttributeError, ValueError, OverflowError):
        return  # the function says what it needs
    warn_of_slip(name, {"unit": LOADS[name]}, largest, load=True)
