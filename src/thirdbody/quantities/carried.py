"""Quantities that carry a unit of their own, at the doors of the library.

Inside everything is a plain number in SI. What carries a unit is converted where it comes in, or
refused: numpy would take the number and drop the unit. Known are pint, astropy, unyt and whatever
speaks as they do: ``.units`` or ``.unit``, ``.to(unit)`` and ``.magnitude`` or ``.value``; arrays
of them, lists of them, and what says its unit in ``.attrs["units"]`` as xarray does.

Which unit an argument of a function needs stands in its docstring: "[Pa]". Functions that take
numbers are marked with `takes_units`; methods of a `thirdbody.quantities.value.Value` are so by
themselves.
"""

from __future__ import annotations

import inspect
import math
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from decimal import Decimal
from functools import cache, wraps
from types import FunctionType
from typing import Any, TypeVar

import numpy as np

from ..errors import InvalidValue, Mistake, Problem, is_inside
from .arguments import FAILURES, entries_of, refuse_misfits
from .kinds import kind_needed, kind_of, library_unit, registry
from .slips import LOADS, warn_of_load
from .uncertain import is_uncertain

__all__ = ["carries_unit", "in_si", "takes_units"]

F = TypeVar("F", bound=Callable[..., Any])

PLAIN = frozenset(
    (*(float, int, str, bool, type(None), np.float64, np.int64, bytes, complex, FunctionType),)
)
"""Types that carry no unit, as most arguments are."""
USUAL = {
    "pressure": "Pa",
    "F_star": "1",
    "d": "m",
    "h": "m",
    "E_star": "Pa",
    "H": "Pa",
    "omega": "m",
    "sigma": "m",
    **dict.fromkeys(("sigma_s", "R", "radius", "x", "gap", "amplitude", "cutoff"), "m"),
    **dict.fromkeys(("smallest", "largest"), "m"),
    "E": "Pa",
    "speed": "m/s",
    "oil_density": "kg/m^3",
    **dict.fromkeys(
        ("nu", "g", "hurst", "ratio", "q", "factor", "share", "weights", "counts"), "1"
    ),
    **dict.fromkeys(("eps", "eps_1", "eps_2", "tol", "tolerance", "few", "most"), "1"),
    **dict.fromkeys(("roundness", "flatness", "coverage", "overrollings"), "1"),
}
"""Units of arguments that are the same in every function, where its docstring leaves them out."""


def carries_unit(value: Any) -> bool:
    """Whether a value, or an item of a list or a mapping, carries a unit.

    >>> carries_unit(5e6), carries_unit([1.0, 2.0])
    (False, False)
    """
    kind = type(value)
    if kind in PLAIN:
        return False
    if kind is np.ndarray:
        return value.dtype.kind == "O" and any(map(carries_unit, value.flat))
    if kind in (list, tuple):
        return any(map(carries_unit, value))
    if kind is dict:
        return any(map(carries_unit, value.values()))
    if not _may_carry(kind):  # type: ignore[arg-type]
        return False
    return _speaks(value) or _unit_label(value) is not None or _has_unit_type(value)


@cache
def _may_carry(kind: type) -> bool:
    """Whether values of a type may carry a unit: those of most types cannot."""
    return any(hasattr(kind, name) for name in ("to", "attrs", "dtype"))


def _speaks(value: object) -> bool:
    """Whether this is a quantity of a library of units."""
    return (
        not isinstance(value, type)
        and hasattr(value, "to")
        and (hasattr(value, "units") or hasattr(value, "unit"))
        and (hasattr(value, "magnitude") or hasattr(value, "value"))
    )


def _unit_label(value: object) -> str | None:
    """The unit that an array says beside its numbers, as xarray's do."""
    if not (hasattr(value, "dims") and hasattr(value, "attrs")):
        return None
    if _speaks(getattr(value, "data", None)):
        return ""
    unit = value.attrs.get("units")
    return unit if isinstance(unit, str) and unit else None


def _has_unit_type(value: object) -> bool:
    """Whether an array says the unit in its type, as pint's in pandas do."""
    return hasattr(getattr(value, "dtype", None), "units")


def in_si(value: Any, unit: str) -> Any:
    """The number or numbers of a value that carries a unit, in SI; others as they are.

    Parameters
    ----------
    value : quantity, or a list, tuple or mapping that holds some
        What carries a unit.
    unit : str
        The unit that is needed, "1" for a pure number.

    Returns
    -------
    float, array, or list, tuple or mapping of them

    Raises
    ------
    InvalidValue
        One sentence that begins with the value: another dimension, or a unit that is not known.

    Examples
    --------
    >>> import pint
    >>> in_si(pint.Quantity(250, "nm"), "m"), in_si(pint.Quantity([1, 5], "MPa"), "Pa")
    (2.5e-07, array([1000000., 5000000.]))
    >>> in_si(pint.Quantity(5, "MPa"), "m")
    Traceback (most recent call last):
    ...
    thirdbody.errors.InvalidValue: 5 megapascal is a pressure, but a length [m] is needed...
    """
    if not carries_unit(value):
        return value
    if isinstance(value, Mapping):
        return {key: in_si(element, unit) for key, element in value.items()}
    if isinstance(value, tuple):
        return tuple(in_si(element, unit) for element in value)
    if isinstance(value, list):
        return [in_si(element, unit) for element in value]
    if _speaks(value):
        return _convert(value, unit)
    if (label := _unit_label(value)) is not None:
        if not label:
            return _convert(value.data, unit)
        return _scale(np.asarray(value, float), _factor(value.name, label, unit))
    items = value.ravel() if type(value) is np.ndarray else value
    return np.reshape([float(in_si(element, unit)) for element in items], np.shape(value))


def _convert(value: Any, unit: str) -> Any:
    """A quantity of a library of units, by that library's own factor."""
    wanted = library_unit(unit)
    if is_uncertain(getattr(value, "magnitude", None)):
        try:
            return value.to(wanted or "dimensionless").magnitude
        except Exception:
            raise InvalidValue(_why_not(value, unit), code=Mistake.UNIT) from None
    try:
        numbers, wanted_numbers = (
            _magnitude(quantity) for quantity in (value, value.to(wanted or "dimensionless"))
        )
    except Exception:
        raise InvalidValue(_why_not(value, unit), code=Mistake.UNIT) from None
    some = np.flatnonzero(np.isfinite(numbers) & (numbers != 0))
    factor = float(wanted_numbers.flat[some[0]] / numbers.flat[some[0]]) if len(some) else math.nan
    exact = _scale(numbers, factor)
    out = (
        exact
        if np.allclose(exact, wanted_numbers, rtol=1e-12, atol=0, equal_nan=True)
        else wanted_numbers
    )
    return out if out.ndim else float(out)


def _magnitude(value: Any) -> np.ndarray:
    bare = value.magnitude if hasattr(value, "magnitude") else value.value
    return np.asarray(bare, float)


def _scale(numbers: np.ndarray, factor: float) -> np.ndarray:
    """Numbers times a factor; powers of ten as one writes them: 250 nm is the double 250e-9."""
    exponent = round(math.log10(factor)) if factor > 0 and math.isfinite(factor) else 0
    if not math.isclose(factor, 10.0**exponent, rel_tol=1e-12):
        return numbers * factor
    shifted = [float(Decimal(repr(number)).scaleb(exponent)) for number in numbers.ravel().tolist()]
    return np.reshape(shifted, numbers.shape)


def _factor(name: object, label: str, unit: str) -> float:
    """Factor from the unit of an array's label to the unit wanted."""
    label_unit = "" if label == "1" else label.replace("^", "**")
    wanted = library_unit(unit) or "dimensionless"
    try:
        return float(registry().convert(1.0, label_unit or "dimensionless", wanted))
    except Exception:
        shown = f"{name or 'the array'} [{label}]"
        raise InvalidValue(
            f"{shown} is {kind_of(label_unit)}, but {kind_needed(unit)}", code=Mistake.UNIT
        ) from None


def _why_not(value: Any, unit: str) -> str:
    """Why a quantity cannot stand for this unit."""
    value_unit = value.units if hasattr(value, "units") else value.unit
    shown = " ".join(str(value).split())
    shown = shown if len(shown) <= 60 else f"an array [{value_unit}]"
    if isinstance(getattr(value, "magnitude", getattr(value, "value", None)), str):
        return f"{shown} is no number with a unit; it must be {kind_needed(unit)}"
    kind = kind_of(str(value_unit))
    return f"{shown} is {kind}, but {kind_needed(unit)}"


def takes_units(function: F) -> F:
    """Decorate a function: arguments that carry a unit are converted, or refused.

    The unit of each stands in the docstring, in brackets; that of an input in ``vary`` is known to
    the contact. Arguments without a unit are passed on as they are; where the function fails on
    one that is not what its signature says, that one is named
    (`thirdbody.quantities.arguments`).

    Raises
    ------
    InvalidValue
        When it is called: another dimension, or a unit where none is understood, a sentence for
        each argument.

    Examples
    --------
    >>> import pint
    >>> @takes_units
    ... def force(pressure, *, area):
    ...     '''Force on an area.
    ...
    ...     Parameters
    ...     ----------
    ...     pressure : float
    ...         p [Pa].
    ...     area : float
    ...         A_n [m^2].
    ...     '''
    ...     return pressure * area
    >>> force(pint.Quantity(2, "MPa"), area=1e-6), force(1.0, area=pint.Quantity(3, "mm^2"))
    (2.0, 3e-06)
    """
    if getattr(function, "takes_units", False):
        return function

    of_contact = str(function.__annotations__.get("contact", "")) == "Contact"
    place = function.__code__.co_varnames.index("contact") if of_contact else 0
    loads = LOADS.keys() & function.__annotations__ if of_contact else ()

    @wraps(function)
    def with_units(*args: object, **named: object) -> Any:
        if of_contact and (len(args) > place or "contact" in named):
            _need_contact(args[place] if len(args) > place else named["contact"])
        try:
            if any(map(carries_unit, args)) or (named and any(map(carries_unit, named.values()))):
                args, named = _all_in_si(function, args, named)
            if any(map(_may_be_none, args)) or (named and any(map(_may_be_none, named.values()))):
                _refuse_no_numbers(function, args, named)
            for load in loads:  # what the library hands on means what it says
                if named.get(load) is not None and not is_inside(sys._getframe(1)):
                    warn_of_load(load, named[load])
            return function(*args, **named)
        except FAILURES as error:
            owner: type = type(args[0]) if args else object
            units = units_of(function, owner)
            quantities = {name for name, unit in units.items() if unit}
            refuse_misfits(error, function, args, named, numbers=quantities)
            raise

    with_units.takes_units = True  # type: ignore[attr-defined]
    return with_units  # type: ignore[return-value]


def _may_be_none(value: Any) -> bool:
    """Whether an argument is to be looked at: masked or huge numbers, truth values for numbers."""
    kind = type(value)
    if kind is bool or kind is np.bool_:
        return True
    if kind is int:
        return bool(huge_words(value))
    if kind is np.ndarray:
        return value.dtype.kind == "b" or (
            value.dtype.kind == "O" and any(map(huge_words, value.flat))
        )
    if kind is dict:
        return any(map(_may_be_none, value.values()))
    if kind in (list, tuple):
        return len(value) <= LOOKED_AT and any(map(_may_be_none, value))
    return isinstance(value, np.ma.MaskedArray)


LOOKED_AT = 1000
"""Longest list in which each item is looked at, for a truth value among numbers."""


def huge_words(value: object) -> str:
    """Why a whole number is beyond every float; "" where it is not, or is no such number.

    It is not written out: Python refuses to write more than 4300 digits.

    >>> huge_words(10**400), huge_words(10**300), huge_words(1e300)
    ('is a whole number of 401 digits; it must be at most 1e40 in size; check its exponent', '', '')
    """
    if type(value) is not int or value.bit_length() <= sys.float_info.max_exp:
        return ""
    digits = math.floor(math.log10(abs(value))) + 1  # of any size, as `math` takes its bits
    return Mistake.RANGE.clause(
        f"is a whole number of {digits} digits; it must be at most 1e40 in size; check its exponent"
    )


def masked_words(value: object) -> str:
    """Why an array cannot be used of which some values are masked; "" where none is.

    >>> masked_words(np.ma.masked_array([5e6, 6e6], [False, True])), masked_words([5e6])
    ('has 1 masked value of 2; a masked value is no number: leave it out, by .compressed()', '')
    """
    if not isinstance(value, np.ma.MaskedArray) or not (count := np.ma.count_masked(value)):
        return ""
    values = "value" if count == 1 else "values"
    return Mistake.KIND.clause(
        f"has {count} masked {values} of {value.size}; a masked value is no number: "
        "leave it out, by .compressed()"
    )


@cache
def _signature_of(function: Callable[..., object]) -> inspect.Signature:
    return inspect.signature(function)


def _refuse_no_numbers(
    function: Callable[..., object], args: tuple[object, ...], named: dict[str, object]
) -> None:
    """Refuse masked and huge values, and truth values where a number with a unit is needed."""
    arguments = _signature_of(function).bind_partial(*args, **named).arguments
    owner: type = type(args[0]) if args else object
    problems: list[str] = []
    for name, value in arguments.items():
        for key, argument in value.items() if isinstance(value, dict) else [(name, value)]:
            some = (
                argument
                if type(argument) in (list, tuple) and len(argument) <= LOOKED_AT
                else [argument]
            )
            if isinstance(argument, np.ndarray) and argument.dtype.kind == "O":
                some = list(argument.flat)
            if why := next(filter(None, map(huge_words, some)), ""):
                problems.append(Problem(key, why))
                continue
            if why := next(filter(None, map(masked_words, some)), ""):
                problems.append(Problem(key, why))
            elif any(map(_is_truth, some)) and units_of(function, owner).get(key) is not None:
                rule = "must be a number, not a truth value"
                problems.append(Problem(key, rule, repr(argument), code=Mistake.KIND))
    if problems:
        raise InvalidValue(*problems)


def _is_truth(value: object) -> bool:
    """Whether a value is true or false, or an array of these."""
    return isinstance(value, (bool, np.bool_)) or getattr(value, "dtype", None) == np.bool_


def _need_contact(value: object) -> None:
    """Refuse what is no contact: None, a study, a mapping."""
    if hasattr(value, "asperity_law"):
        return
    shown = f"a {type(value).__name__}" if value is not None else "None"
    cause = "; of a study take study.contact" if hasattr(value, "contact") else ""
    raise InvalidValue(
        Problem(
            "contact",
            f"must be a Contact: surfaces and roughness{cause}",
            shown,
            code=Mistake.KIND,
        )
    )


def _all_in_si(
    function: Callable[..., object], args: tuple[object, ...], named: dict[str, object]
) -> tuple[tuple[object, ...], dict[str, object]]:
    """Arguments in SI."""
    call = _signature_of(function).bind_partial(*args, **named)
    owner = args[0] if args else None
    units = units_of(function, owner if isinstance(owner, type) else type(owner))
    problems: list[str] = []
    for name, value in call.arguments.items():
        parameter = call.signature.parameters[name]
        if parameter.kind is parameter.VAR_KEYWORD:  # another door takes them
            converted = {
                key: _argument_in_si(units, key, quantity, problems)
                for key, quantity in value.items()
                if carries_unit(quantity) and units.get(key)
            }
            call.arguments[name] = value | converted
        elif not carries_unit(value):
            continue
        elif name == "vary" and isinstance(value, Mapping):
            inputs = {key: _unit_of_input(owner, key) for key in value}
            call.arguments[name] = {
                k: _argument_in_si(inputs, k, v, problems) for k, v in value.items()
            }
        elif units.get(name) or _is_number(parameter) or not hasattr(value, "attrs"):
            call.arguments[name] = _argument_in_si(units, name, value, problems)
    if problems:
        raise InvalidValue(*problems)
    return call.args, call.kwargs


def _argument_in_si(
    units: Mapping[str, str | None], name: str, value: object, problems: list[str]
) -> Any:
    """One argument in SI; why not is added to the problems."""
    if not carries_unit(value):
        return value
    unit = units.get(name)
    if unit is None:
        shown = " ".join(str(value).split())
        rule = "carries a unit, which is not understood here"
        hint = "give the number alone, lengths, pressures and all else in SI"
        shown = shown if len(shown) <= 60 else "[...]"
        problems.append(Problem(name, rule, shown, hint=hint, code=Mistake.UNIT))
        return value
    try:
        return in_si(value, unit)
    except InvalidValue as error:
        problems += [problem.put_at(name, str(value)[:80]) for problem in error.problems]
        return value


def _is_number(parameter: inspect.Parameter) -> bool:
    """Whether an argument is a number or an array by its type, or may be."""
    annotation = "" if parameter.annotation is parameter.empty else str(parameter.annotation)
    return (
        not annotation
        or re.search(r"\b(float|int|ArrayLike|Array|Number)\b", annotation) is not None
    )


def _unit_of_input(contact: Any, name: str) -> str | None:
    """The unit of an input of a contact by its dotted name."""
    path, _, last = name.partition("+")[0].rpartition(".")
    if not path:
        return USUAL.get(last)
    try:
        owner = getattr(contact, "contact", contact).value_at(path)
    except (AttributeError, InvalidValue):
        return None
    item = getattr(type(owner), "__dataclass_fields__", {}).get(last)
    about = item.metadata.get("quantity") if item is not None else None
    return about["unit"] if about else None


@cache
def units_of(function: Callable[..., object], owner: type = object) -> dict[str, str | None]:
    """Units of the arguments of a function, or of a method of a class, as documented.

    None where a docstring names none, or several.
    """
    units: dict[str, str | None] = dict(USUAL)
    for docstring in reversed(list(_docstrings(function, owner))):
        units |= {name: unit for name, unit in arguments_of(docstring) if unit or name not in units}
    return units


def _docstrings(function: Callable[..., object], owner: type) -> Iterator[str]:
    """Docstrings of a function and of the methods that it overrides."""
    yield function.__doc__ or ""
    for base in owner.__mro__:
        method = base.__dict__.get(function.__name__)
        yield getattr(method, "__doc__", None) or ""


def arguments_of(docstring: str) -> Iterator[tuple[str, str | None]]:
    """Arguments that a docstring in the style of numpydoc describes, and their units.

    >>> list(arguments_of('''One line.
    ...
    ...     Parameters
    ...     ----------
    ...     load, R : float
    ...         Force [N] and radius [m].
    ...     seed : int
    ...         Of the generator.
    ... '''))
    [('load', 'N'), ('R', 'm'), ('seed', None)]
    """
    for head, entry in entries_of(docstring).items():
        names = re.split(", *", head)
        units = re.findall(r"\[([^\]\[]+)\]", " ".join(entry))
        if len(set(units)) == 1:
            units = units[:1] * len(names)
        named_units = units if len(units) == len(names) else [None] * len(names)
        for name, unit in zip(names, named_units, strict=True):
            yield (
                name.strip("*"),
                unit if unit is not None and library_unit(unit) is not None else None,
            )
