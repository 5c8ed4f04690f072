r"""A contact's answer as a C¹ table: pressure and real area against separation, for other solvers.

Between knots :math:`x_i` pressure and area are the exponential of a cubic,

.. math:: p(x) = p_i\, e^{c_{i1}s + c_{i2}s^2 + c_{i3}s^3}, \qquad
          s = \frac{x - x_i}{x_{i+1} - x_i},

the Hermite interpolant of :math:`\ln p` with the true slopes, so that the relative error is the
same from full contact to the last asperity. Panels are halved until it is met.
"""

from __future__ import annotations

import csv
import io
import os
import textwrap
import unicodedata
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .citations import cite
from .contact import Contact, Interface, interface
from .equilibrium import DEEPEST, LoadScan, pull_off, solve
from .errors import InvalidValue, RangeWarning
from .files import write_text
from .units import say

__all__ = ["FORMATS", "SHARES", "ContactTable", "TableError", "make_table"]

Array = NDArray[np.float64]
Number = float | Array

SHARES = ("particle_area_share", "particle_load_share")
"""Columns that can be had beside pressure and area; A_sa is the area share times A_t."""
COORDINATES = {"h": "mean surface plane", "d": "datum of d"}
UNITS = {"SI": ("m", "Pa", 1.0, 1.0), "mm": ("mm", "MPa", 1e3, 1e-6)}
"""Length, pressure, and how many of them one metre and one pascal are."""

LEAST_LOAD = 1e-9
"""F* at the upper end of a table unless another is given: nothing that a solver could feel."""
MOST_AREA = 0.2
"""A_t at its lower end: beyond it neighbouring contacts interact, which the model neglects."""
ACCURACY = 1e-10
"""Relative accuracy of the loads and areas that the table is compared with."""
SAMPLES = 33
SAFETY = 1.5
"""Stated error over the largest one met at SAMPLES places of a panel."""
LEAST_PRESSURE = 1e-250
MOST_PANELS = 20_000
_PLACES = np.sin(0.5 * np.pi * (np.arange(SAMPLES) + 0.5) / SAMPLES) ** 2


@dataclass(frozen=True, slots=True, kw_only=True)
class TableError:
    """How far a table is from the contact it was made of; never less than the true error.

    Inside the range ``p`` and ``A`` are relative errors, ``dp_dh`` is relative to the true slope,
    ``shares`` is absolute. ``above`` [Pa] bounds the pressure error beyond the upper end.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> error = contact.table(tolerance=1e-4).error
    >>> error.p <= 1e-4, error.A <= 1e-4
    (True, True)
    """

    p: float
    """Of the pressure [1]."""
    A: float
    """Of the real area [1]."""
    dp_dh: float
    """Of the slope [1]."""
    shares: float
    """Of the columns asked for [1]."""
    above: float
    """Of the pressure beyond the upper end [Pa]."""


@dataclass(frozen=True, eq=False, kw_only=True)
class ContactTable:
    r"""Pressure, real area and stiffness of a contact as C¹ functions of the separation.

    Made by `thirdbody.Contact.table`. Inside the range each is within `error` of the contact.
    Above it p and A_t decay exponentially, :math:`p = p_N e^{-(x-x_N)/\lambda}`; below it they go
    on along their tangents. Value and slope are continuous everywhere. Below the range there is
    no statement on the error; shares are constant outside.

    Parameters
    ----------
    contact : Contact
    coordinate : {"h", "d"}
        What the argument of every function is: the separation from the mean surface plane, or
        from the datum of `solve`'s d.
    h : array (N + 1,)
        Knots [m], increasing, in that coordinate.
    error : TableError
    tolerance : float
        What was asked for.
    warnings : tuple of str
        Where the range leaves the model's validity.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> table = contact.table(tolerance=1e-4)
    >>> state = tb.solve(contact, pressure=5e6)
    >>> abs(table.p(state.h) / 5e6 - 1) < table.error.p < 1e-4
    True
    """

    contact: Contact
    coordinate: str
    h: Array
    error: TableError
    tolerance: float
    warnings: tuple[str, ...]
    _p: _LogCubic = field(repr=False)
    _A: _LogCubic = field(repr=False)
    _shares: dict[str, Array] = field(repr=False)
    """Cubics of each share: (N, 4)."""

    # ------------------------------------------------------------------ values
    def p(self, h: ArrayLike) -> Number:
        """Nominal pressure [Pa] at separations [m], any shape."""
        return _as_given(h, self._p.value(np.asarray(h, dtype=float)))

    def dp_dh(self, h: ArrayLike) -> Number:
        """Slope of `p` [Pa/m], negative: the exact derivative of the table."""
        return _as_given(h, self._p.slope(np.asarray(h, dtype=float)))

    def A(self, h: ArrayLike) -> Number:
        """Real area A_t per nominal area [1]."""
        return _as_given(h, self._A.value(np.asarray(h, dtype=float)))

    def dA_dh(self, h: ArrayLike) -> Number:
        """Slope of `A` [1/m]: the exact derivative of the table."""
        return _as_given(h, self._A.slope(np.asarray(h, dtype=float)))

    def share(self, name: str, h: ArrayLike) -> Number:
        """A share [1] that was asked for in ``columns``; constant beyond the ends."""
        if name not in self._shares:
            known = ", ".join(self._shares) or "none; give columns=... when the table is made"
            raise InvalidValue(f"share {name!r} is not in this table; it has {known}")
        c = self._shares[name]
        x = np.clip(np.asarray(h, dtype=float), self.h[0], self.h[-1])
        i = self._p.panel(x)
        s = (x - self.h[i]) / self._p.width[i]
        return _as_given(h, c[i, 0] + s * (c[i, 1] + s * (c[i, 2] + s * c[i, 3])))

    # ------------------------------------------------------------------ what files say
    def about(self) -> list[str]:
        """What every exported file says at its top, one sentence each."""
        from . import __version__

        e, name = self.error, self.coordinate
        shift = interface(self.contact).mean_plane
        other = f"h = d + {shift!r} m" if name == "h" else f"d = h - {shift!r} m"
        plane = (
            "the mean plane of the surface heights"
            if name == "h"
            else "the datum of d in thirdbody.solve"
        )
        inputs = [f"  {key} = {value}" for key, value in _flat(self.contact.to_dict())]
        return [
            f"Contact pressure and real contact area against separation, thirdbody {__version__}",
            f"Separation {name} [m] is counted from {plane}, positive when the surfaces part; "
            f"{other}.",
            "Pressure p [Pa] is load per nominal area, positive in compression; area A_t is real "
            "contact area per nominal area.",
            f"Range: {name} from {float(self.h[0])!r} to {float(self.h[-1])!r} m, "
            f"p from {float(self._p.left[0])!r} down to {self._p.last!r} Pa.",
            f"Errors against the contact inside the range, upper bounds: p {rounded_up(e.p)} "
            f"relative, A_t {rounded_up(e.A)} relative, dp/d{name} {rounded_up(e.dp_dh)} relative.",
            f"Above the range p and A_t decay exponentially with continuous slope; the error of p "
            f"there is at most {rounded_up(e.above)} Pa.",
            "Below the range p and A_t follow their tangents; no statement on the error is made.",
            *(f"Validity: {sentence}" for sentence in self.warnings),
            "Inputs, SI units:",
            *inputs,
            "Please cite:",
            *(f"  {line}" for line in cite(self.contact).splitlines()),
        ]

    # ------------------------------------------------------------------ files
    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Knots, values and slopes, with a head of ``#`` lines.

        The cubic Hermite interpolant of ln p (and of ln A_t) through these rows is the table.
        """
        name = self.coordinate
        columns: dict[str, Array] = {
            f"{name} [m]": self.h,
            "p [Pa]": self._p.at_knots(),
            f"dp_d{name} [Pa/m]": self._p.slope(self.h),
            "A_t [1]": self._A.at_knots(),
            f"dA_d{name} [1/m]": self._A.slope(self.h),
        }
        columns |= {f"{key} [1]": np.asarray(self.share(key, self.h)) for key in self._shares}
        text = io.StringIO()
        text.write(self._head("# "))
        if self._shares:
            text.write(
                "# Shares: absolute error, with the table's own cubics between rows, at most "
                f"{rounded_up(self.error.shares)}.\n"
            )
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*(map(repr, c.tolist()) for c in columns.values()), strict=True))
        write_text(path, text.getvalue())

    def to_abaqus(
        self,
        path: str | os.PathLike[str],
        *,
        tolerance: float = 1e-3,
        units: Literal["SI", "mm"] = "SI",
        datum: float = 0.0,
        name: str = "ROUGH",
    ) -> None:
        """A surface interaction with a tabular pressure-overclosure relation, as Abaqus reads it.

        Abaqus takes the pairs (pressure, overclosure) as piecewise linear, from a first pair
        without pressure, and continues the last slope. Overclosure is datum − h.

        Parameters
        ----------
        path : path-like
            Usually ``*.inp``; to be included in the model.
        tolerance : float, optional
            Relative error of the straight lines; decides the number of pairs.
        units : {"SI", "mm"}, optional
            m and Pa, or mm and MPa.
        datum : float, optional
            Separation [m] that counts as overclosure zero. With 0 the meshed faces are the
            planes that h is counted from.
        name : str, optional
            Name of the surface interaction.
        """
        length, stress, per_m, per_Pa = _units(units)
        if not (name.isascii() and name.replace("_", "").replace("-", "").isalnum()):
            raise InvalidValue(f"name = {name!r} must be letters, digits, - and _")
        x, worst = self._rows(tolerance)
        # the tangent at the last knot leads to no pressure at all
        foot = self.h[-1] - self._p.last / float(self._p.slope(self.h[-1:])[0])
        x = np.append(x, foot)
        p = np.append(self._p.value(x[:-1]), 0.0)
        over = [f"{(datum - at) * per_m:.12e}" for at in x[::-1].tolist()]
        if len(set(over)) < len(over):
            raise InvalidValue(
                f"datum = {datum:g} m is so far from the gaps that pairs coincide when written"
            )
        pairs = [
            f"{value * per_Pa:.12e}, {at}" for value, at in zip(p[::-1].tolist(), over, strict=True)
        ]
        note = [
            f"Overclosure [{length}] is {datum!r} m minus {self.coordinate}; pressure in {stress}.",
            f"Straight lines between the pairs are within {rounded_up(worst)} of p, relative, and "
            "the table's own error comes on top; the first one is the tangent that leads to p = 0.",
        ]
        text = self._head("** ", note)
        text += f"*SURFACE INTERACTION, NAME={name}\n"
        text += "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR\n"
        write_text(path, text + "\n".join(pairs) + "\n")

    def to_comsol(self, path: str | os.PathLike[str], *, tolerance: float = 1e-4) -> None:
        """Columns for an interpolation function of COMSOL: separation, ln p, p, A_t.

        The file is of the spreadsheet kind: ``%`` lines are comments, the first column is the
        argument, each further one a function. ``exp(lnp(h))[Pa]`` keeps the tail.

        Parameters
        ----------
        path : path-like
        tolerance : float, optional
            Relative error of p when ln p is interpolated linearly between the rows.
        """
        x, worst = self._rows(tolerance, log=True)
        p, A = self._p.value(x), self._A.value(x)
        shares = {key: np.asarray(self.share(key, x)) for key in self._shares}
        straight_p, straight_A = (rounded_up(_chords(c, x).max()) for c in (self._p, self._A))
        others = "".join(f", {i} {key}" for i, key in enumerate(shares, 4))
        note = [
            "COMSOL: Interpolation, data source File, data format Spreadsheet, one argument. "
            f"Functions by position in file: 1 ln_p, 2 p, 3 A_t{others}. Unit of the argument m, "
            f"of p Pa, of the others 1. Use exp(ln_p({self.coordinate}))[Pa] with piecewise cubic "
            "interpolation and linear extrapolation: C1, with an exponential tail; then p goes on "
            "exponentially below the range too.",
            f"Interpolated linearly between the rows, p from ln_p is within {rounded_up(worst)}, "
            f"p itself within {straight_p}, A_t within {straight_A}, all relative; the table's own "
            "errors come on top.",
            f"{self.coordinate} (m)  ln_p (1)  p (Pa)  A_t (1)"
            + "".join(f"  {key} (1)" for key in shares),
        ]
        rows = zip(x, np.log(p), p, A, *shares.values(), strict=True)
        body = "\n".join(" ".join(repr(float(v)) for v in row) for row in rows)
        write_text(path, self._head("% ", note) + body + "\n")

    def to_avl(
        self,
        path: str | os.PathLike[str],
        *,
        tolerance: float = 1e-3,
        units: Literal["SI", "mm"] = "mm",
    ) -> None:
        """Gap and asperity pressure in two columns, for the contact tables of AVL EXCITE.

        The file layout of EXCITE is not public: assumed are two columns that are pasted into the
        table of the contact model, gap first and increasing, interpolated linearly.

        Parameters
        ----------
        path : path-like
        tolerance : float, optional
            Relative error of p between the rows, interpolated linearly.
        units : {"mm", "SI"}, optional
            mm and MPa, or m and Pa.
        """
        length, stress, per_m, per_Pa = _units(units)
        x, worst = self._rows(tolerance)
        note = [
            "Assumed: two columns, gap increasing, interpolated linearly; the layout of AVL "
            "EXCITE's files is not public. Remove the lines that begin with # if they are refused.",
            f"Straight lines between the rows are within {rounded_up(worst)} of p, relative, and "
            "the table's own error comes on top.",
            f"gap {self.coordinate} [{length}]\tpressure [{stress}]",
        ]
        body = "\n".join(
            f"{at * per_m:.12e}\t{value * per_Pa:.12e}"
            for at, value in zip(x.tolist(), self._p.value(x).tolist(), strict=True)
        )
        write_text(path, self._head("# ", note) + body + "\n")

    def to_python(self, path: str | os.PathLike[str]) -> None:
        """A Python module with ``pressure(h)``, ``area(h)`` and ``stiffness(h)`` = −dp/dh.

        It needs the standard library only and agrees with the table to rounding.
        """
        rows = "\n".join(f"    ({', '.join(row)})," for row in self._coefficients())
        write_text(path, self._head("# ") + _PYTHON.format(rows=rows, **self._ends()))

    def to_c(self, path: str | os.PathLike[str]) -> None:
        """A C99 file with ``pressure(h)``, ``area(h)`` and ``stiffness(h)`` = −dp/dh.

        It needs ``math.h`` only and agrees with the table to rounding.
        """
        rows = "\n".join(f"    {{{', '.join(row)}}}," for row in self._coefficients())
        text = _C.replace("@rows@", rows).replace("@panels@", str(len(self.h) - 1))
        for key, value in self._ends().items():
            text = text.replace(f"@{key}@", value)
        write_text(path, self._head("// ") + text)

    # ------------------------------------------------------------------ parts of files
    def _head(self, mark: str, more: Sequence[str] = ()) -> str:
        """The lines of `about`, and more, as comments of at most 100 ASCII characters."""
        out = []
        for sentence in (*self.about(), *more):
            plain = _ascii(sentence)
            indent = " " * (len(plain) - len(plain.lstrip()))
            # the names of columns keep their tab
            lines = (
                [plain]
                if "\t" in plain
                else textwrap.wrap(plain, 96, initial_indent="", subsequent_indent=indent + "  ")
            )
            out += [(mark + line).rstrip() for line in lines]
        return "\n".join(out) + "\n"

    def _coefficients(self) -> Iterator[tuple[str, ...]]:
        """x_i, width, p_i, c_1..c_3, A_i, a_1..a_3 of every panel."""
        for i in range(len(self.h) - 1):
            row = (self.h[i], self._p.width[i], self._p.left[i], *self._p.c[i])
            row += (self._A.left[i], *self._A.c[i])
            yield tuple(repr(float(v)) for v in row)

    def _ends(self) -> dict[str, str]:
        ends = {
            "last": self.h[-1],
            "p_last": self._p.last,
            "p_tail": self._p.tail,
            "p_head": self._p.head,
            "A_last": self._A.last,
            "A_tail": self._A.tail,
            "A_head": self._A.head,
        }
        return {key: repr(float(value)) for key, value in ends.items()}

    def _rows(self, tolerance: float, *, log: bool = False) -> tuple[Array, float]:
        """Separations between which straight lines of p (or ln p) keep an error, and it."""
        if not (_is_number(tolerance) and 1e-6 <= tolerance <= 0.1):
            raise InvalidValue(
                f"tolerance = {tolerance!r} of straight lines must be from 1e-6 to 0.1 [1]"
            )
        x = self.h[[0, -1]]
        while True:
            error = _chords(self._p, x, log=log)
            bad = np.flatnonzero(error > tolerance)
            if not len(bad):
                return x, float(error.max())
            x = np.insert(x, bad + 1, 0.5 * (x[bad] + x[bad + 1]))


@dataclass(frozen=True, eq=False)
class _LogCubic:
    """exp of a piecewise cubic Hermite interpolant, with its continuations."""

    x: Array
    left: Array
    """Value at the left knot of each panel."""
    c: Array
    """Coefficients c_1, c_2, c_3 in s of ln(value/left): (N, 3)."""
    last: float
    head: float
    """Logarithmic slope at the first knot [1/m]."""
    tail: float
    """Logarithmic slope at the last knot [1/m]."""

    @property
    def width(self) -> Array:
        return np.diff(self.x)

    def panel(self, x: Array) -> NDArray[np.intp]:
        return np.clip(np.searchsorted(self.x, x, side="right") - 1, 0, len(self.x) - 2)

    def _inside(self, x: Array) -> tuple[Array, Array]:
        i = self.panel(x)
        s = (np.clip(x, self.x[0], self.x[-1]) - self.x[i]) / self.width[i]
        c1, c2, c3 = self.c[i].T if x.ndim == 1 else np.moveaxis(self.c[i], -1, 0)
        value = self.left[i] * np.exp(s * (c1 + s * (c2 + s * c3)))
        return value, (c1 + s * (2 * c2 + s * (3 * c3))) / self.width[i]

    def value(self, x: Array) -> Array:
        inside, _ = self._inside(x)
        with np.errstate(under="ignore"):
            above = self.last * np.exp(self.tail * np.maximum(x - self.x[-1], 0.0))
        below = self.left[0] * (1 + self.head * (x - self.x[0]))
        return np.where(x > self.x[-1], above, np.where(x < self.x[0], below, inside))

    def slope(self, x: Array) -> Array:
        inside, log_slope = self._inside(x)
        above = self.tail * self.value(x)
        below = np.full_like(x, self.left[0] * self.head)
        return np.where(x > self.x[-1], above, np.where(x < self.x[0], below, inside * log_slope))

    def at_knots(self) -> Array:
        return np.append(self.left, self.last)


# -------------------------------------------------------------------------- making a table
def make_table(
    contact: Contact,
    *,
    low: float | None = None,
    high: float | None = None,
    tolerance: float = 1e-6,
    coordinate: str = "h",
    columns: Sequence[str] = (),
) -> ContactTable:
    """The table of a contact: what `thirdbody.Contact.table` calls, and where arguments stand.

    Parameters
    ----------
    contact : Contact
    low, high, tolerance, coordinate, columns
        As in `thirdbody.Contact.table`.

    Returns
    -------
    ContactTable

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> table = make_table(contact, tolerance=1e-4)
    >>> table.error.p <= 1e-4
    True
    """
    problems = _mistakes(low, high, tolerance, coordinate, columns)
    if problems:
        raise InvalidValue(*problems)
    bound = interface(contact)
    shift = bound.mean_plane if coordinate == "h" else 0.0
    scan = LoadScan(bound)
    d_high = _upper_end(bound, scan) if high is None else float(high) - shift
    d_low = _bottom(bound) if low is None else float(low) - shift
    _check_range(bound, d_low, d_high, shift, coordinate)
    if low is None:
        d_low = _lower_end(bound, d_high)
    panels = _Panels(bound, shift, columns, coordinate)
    x_low = d_low + shift if low is None else float(low)
    x_high = d_high + shift if high is None else float(high)
    x, parts, error = panels.refined(x_low, x_high, tolerance)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        said = solve(contact, d=np.array([d_low, d_high])).warnings
    for sentence in said:
        warnings.warn(sentence, RangeWarning, stacklevel=3)
    p, A, *shares = parts
    return ContactTable(
        contact=contact,
        coordinate=coordinate,
        h=x,
        tolerance=float(tolerance),
        warnings=said,
        error=TableError(**error, above=_above(bound, scan, d_high, p.last)),
        _p=p,
        _A=A,
        _shares=dict(zip(columns, shares, strict=True)),
    )


def _mistakes(
    low: Any, high: Any, tolerance: Any, coordinate: Any, columns: Sequence[str]
) -> list[str]:
    out = []
    for name, value in (("low", low), ("high", high)):
        if value is not None and not (_is_number(value) and np.isfinite(value)):
            out.append(f"{name} = {value!r} must be a separation [m], or None")
    if not out and low is not None and high is not None and not low < high:
        out.append(f"low = {low:g} must be below high = {high:g} [m]")
    if not (_is_number(tolerance) and 1e-9 <= tolerance <= 0.1):
        out.append(
            f"tolerance = {tolerance!r} must be from 1e-9 to 0.1 [1]; it is a relative error"
        )
    if coordinate not in COORDINATES:
        out.append(f"coordinate = {coordinate!r} must be 'h' or 'd'")
    if isinstance(columns, str) or len(set(columns)) != len(columns):
        out.append(f"columns = {columns!r} must be a list of different names")
    else:
        known = ", ".join(SHARES)
        out += [f"columns: {c!r} must be one of {known}" for c in columns if c not in SHARES]
    return out


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float, np.number)) and not isinstance(value, bool)


def _upper_end(bound: Interface, scan: LoadScan) -> float:
    """The largest d that carries `LEAST_LOAD`, or more where the load jumps over it."""
    d, _, status = scan.met(np.array([LEAST_LOAD * bound.contact.E_ss]), "loading")
    if np.isnan(d[0]):
        raise InvalidValue(f"no table: {status[0]}; give high [m]")
    return float(d[0])


def _bottom(bound: Interface) -> float:
    return bound.asperities.centre + DEEPEST * bound.asperities.sigma_s


def _lower_end(bound: Interface, d_high: float) -> float:
    """The separation of A_t = MOST_AREA, of −3 σ_s, or where the load stops to rise on approach."""
    bottom = _bottom(bound)
    d = np.linspace(d_high, bottom, _panel_count(bound, bottom, d_high) * 8)
    F, F1, _ = bound.load(d).T
    good = (F > 0) & (F1 < 0) & (bound.fields(d)["A_t"] <= MOST_AREA)
    stop = int(np.argmin(good)) if not good.all() else len(d)
    if stop == 0 and F1[0] < 0 < F[0]:
        raise InvalidValue(
            f"A_t is above {MOST_AREA:g} at the upper end already, so the range has no natural "
            "lower end; give low [m]"
        )
    if stop == len(d):
        return bottom
    if stop == 0 or F1[stop] >= 0:
        return float(d[max(stop - 1, 0)])
    inside, outside = d[stop - 1], d[stop]
    for _ in range(60):
        middle = 0.5 * (inside + outside)
        if bound.fields(np.array([middle]))["A_t"][0] <= MOST_AREA:
            inside = middle
        else:
            outside = middle
    return float(inside)


def _panel_count(bound: Interface, low: float, high: float) -> int:
    """Panels of the first grid: none wider than half a σ_s, nor too wide to see a narrow size."""
    width = 0.5 * bound.asperities.sigma_s
    if not bound.monotone and bound.particles is not None:
        width = min(width, 20 * bound.particles.resolution)
    count = int(np.ceil((high - low) / width))
    if count > MOST_PANELS:
        raise InvalidValue(
            f"the range of {high - low:.4g} m needs {count} panels to see particles "
            f"{width:.3g} m wide; give low and high closer together"
        )
    return max(count, 4)


def _check_range(bound: Interface, low: float, high: float, shift: float, name: str) -> None:
    """The range must be one in which ln p exists."""
    bottom = _bottom(bound)
    if low < bottom - 1e-12 * bound.asperities.sigma_s:
        raise InvalidValue(
            f"low: {name} = {low + shift:.6g} m must be >= {bottom + shift:.6g} m, "
            f"{DEEPEST:g} sigma_s, where every asperity is in contact and the model ends"
        )
    if not low < high:
        raise InvalidValue(
            f"the range of {name} from {low + shift:.6g} to {high + shift:.6g} m is empty; give "
            "low and high [m]"
        )
    d = np.linspace(low, high, 8 * _panel_count(bound, low, high))
    F = bound.load(d)[:, 0]
    bad = np.flatnonzero(~(F > LEAST_PRESSURE))
    if len(bad):
        at = d[bad[0]]
        what = (
            "the surfaces attract each other and ln p does not exist"
            if F[bad[0]] < 0
            else "nothing touches any more"
        )
        raise InvalidValue(
            f"high: {name} = {high + shift:.6g} m is too far: from {at + shift:.6g} m on {what}; "
            "leave high out, or give a smaller one"
        )


def _above(bound: Interface, scan: LoadScan, d_high: float, p_last: float) -> float:
    """Largest difference from the exponential tail beyond the range [Pa].

    Both lie between zero and the last pressure, unless the surfaces attract each other or the
    load rises again.
    """
    asperities = bound.asperities
    d = asperities.centre + asperities.sigma_s * np.linspace(DEEPEST, 10, 400)
    pull = 0.0
    if np.any(bound.load(d)[:, 0] < 0):
        pull = pull_off(bound.contact)[0] * (1 + 1e-6)
    most = p_last
    if not bound.monotone:
        beyond = scan.log_F[scan.d > d_high]
        most = max([most, *np.exp(beyond) * 1.1])
    return most + pull


class _Panels:
    """Panels of a growing table: the truth at their samples is computed once."""

    def __init__(self, bound: Interface, shift: float, columns: Sequence[str], name: str):
        self.bound, self.shift, self.name = bound, shift, name
        self.columns = tuple(columns)

    # ------------------------------------------------------------------ the contact itself
    def truth(self, x: Array) -> Array:
        """p, dp/dx, A_t and the shares: (N, 3 + shares)."""
        d = x - self.shift
        F, F1, _ = self.bound.load(d).T
        part = self.bound.fields(d)
        shares = {
            "particle_area_share": lambda: part["A_sa"] / part["A_t"],
            "particle_load_share": lambda: part["F_sa"] / (part["F_ss"] + part["F_sa"]),
        }
        return np.column_stack([F, F1, part["A_t"], *(shares[c]() for c in self.columns)])

    def log_slopes(self, x: Array) -> Array:
        """d ln A_t/dx and slopes of the shares at knots, by differences of fourth order."""
        step = np.diff(x)
        step = np.minimum(np.append(step, step[-1]), np.append(step[0], step))
        step = np.minimum(0.25 * step, 1e-3 * self.bound.asperities.sigma_s)
        # steps that the separations can tell
        step = (x + step) - x
        # five places about each knot, at the ends all of them inside the range
        offsets = np.tile(np.arange(-2.0, 3.0)[:, None], len(x))
        offsets[:, 0], offsets[:, -1] = np.arange(5), np.arange(-4, 1)
        weights = np.tile(np.array([1, -8, 0, 8, -1])[:, None] / 12, len(x))
        weights[:, 0] = np.array([-25, 48, -36, 16, -3]) / 12
        weights[:, -1] = -weights[::-1, 0]
        f = self.truth((x + offsets * step).ravel())[:, 2:].reshape(5, len(x), -1)
        f[..., 0] = np.log(f[..., 0])
        slope = np.einsum("kn,knj->nj", weights, f) / step[:, None]
        # a tail that does not grow
        slope[-1, 0] = min(slope[-1, 0], 0.0)
        return slope

    # ------------------------------------------------------------------ refinement
    def refined(
        self, low: float, high: float, tolerance: float
    ) -> tuple[Array, list[Any], dict[str, float]]:
        """Knots, interpolants of p, A_t and the shares, and their errors."""
        x = np.linspace(low, high, _panel_count(self.bound, low, high) + 1)
        reach = [a.reach for a in (self.bound.particles,) if a is not None]
        x = np.unique([*x, *(r + self.shift for r in reach if low < r + self.shift < high)])
        at_knots = self.truth(x)
        inside = self._samples(x[:-1], x[1:])
        while True:
            cubics = self._cubics(x, at_knots)
            errors, falls = self._errors(x, cubics, inside, at_knots)
            stated = SAFETY * errors + ACCURACY
            relevant = np.delete(stated, 1, axis=1)
            bad = np.flatnonzero(~((relevant <= tolerance).all(axis=1) & falls))
            if not len(bad):
                break
            self._give_up(x, bad, at_knots, relevant, tolerance)
            middle = 0.5 * (x[bad] + x[bad + 1])
            new = self.truth(middle)
            left, right = self._samples(x[bad], middle), self._samples(middle, x[bad + 1])
            x, at_knots = np.insert(x, bad + 1, middle), np.insert(at_knots, bad + 1, new, axis=0)
            inside = np.insert(inside, bad + 1, right, axis=0)
            inside[bad + np.arange(len(bad))] = left
        worst = stated.max(axis=0)
        names = ("p", "dp_dh", "A")
        error = {key: float(value) for key, value in zip(names, worst, strict=False)}
        error["shares"] = float(worst[3:].max()) if len(worst) > 3 else 0.0
        return x, cubics, error

    def _samples(self, a: Array, b: Array) -> Array:
        x = a[:, None] + (b - a)[:, None] * _PLACES
        return self.truth(x.ravel()).reshape(*x.shape, -1)

    def _cubics(self, x: Array, at_knots: Array) -> list[Any]:
        slopes = self.log_slopes(x)
        width = np.diff(x)
        p, dp, A = at_knots[:, :3].T
        out: list[Any] = []
        for value, slope in ((p, dp / p), (A, slopes[:, 0])):
            rise = np.log(value[1:] / value[:-1])
            c = _hermite(rise, slope[:-1] * width, slope[1:] * width)
            out.append(
                _LogCubic(x, value[:-1], c, float(value[-1]), float(slope[0]), float(slope[-1]))
            )
        for j in range(len(self.columns)):
            value, slope = at_knots[:, 3 + j], slopes[:, 1 + j]
            c = _hermite(np.diff(value), slope[:-1] * width, slope[1:] * width)
            out.append(np.column_stack([value[:-1], c]))
        return out

    def _errors(
        self, x: Array, cubics: list[Any], inside: Array, at_knots: Array
    ) -> tuple[Array, NDArray[np.bool_]]:
        """Largest error of p, dp/dx, A_t and the shares, panel by panel; whether p falls."""
        s, width = _PLACES, np.diff(x)[:, None]
        p, A, *shares = cubics

        def cubic(c: Array) -> Array:
            return s * (c[:, :1] + s * (c[:, 1:2] + s * c[:, 2:]))

        c = p.c
        # a panel that is still too wide may overflow
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
            value = p.left[:, None] * np.exp(cubic(c))
            slope = value * (c[:, :1] + s * (2 * c[:, 1:2] + s * 3 * c[:, 2:])) / width
            columns = [
                value / inside[..., 0] - 1,
                slope / inside[..., 1] - 1,
                A.left[:, None] * np.exp(cubic(A.c)) / inside[..., 2] - 1,
            ]
        for j, part in enumerate(shares):
            columns.append(part[:, :1] + cubic(part[:, 1:]) - inside[..., 3 + j])
        errors = np.stack([np.abs(column).max(axis=1) for column in columns], axis=1)
        self._must_fall(x, inside, at_knots)
        # the derivative of a cubic is largest at an end or at its vertex
        with np.errstate(divide="ignore", invalid="ignore"):
            vertex = np.clip(np.nan_to_num(-c[:, 1] / (3 * c[:, 2])), 0.0, 1.0)
        at = np.stack([np.zeros_like(vertex), vertex, np.ones_like(vertex)])
        steepest = (c[:, 0] + at * (2 * c[:, 1] + at * 3 * c[:, 2])).max(axis=0)
        return np.where(np.isnan(errors), np.inf, errors), steepest < 0

    def _must_fall(self, x: Array, inside: Array, at_knots: Array) -> None:
        """A pressure that rises with the separation has no single gap: refused."""
        rising = np.flatnonzero((inside[..., 1] >= 0).any(axis=1) | (at_knots[:-1, 1] >= 0))
        if len(rising):
            a, b = x[rising[0]], x[rising[-1] + 1]
            raise InvalidValue(
                f"the pressure rises with the separation between {self.name} = {a:.6g} and "
                f"{b:.6g} m, so one pressure would have several gaps; give low >= {b:.6g} m, the "
                f"branch met on approach, or high <= {a:.6g} m"
            )

    def _give_up(
        self, x: Array, bad: NDArray[np.intp], at_knots: Array, stated: Array, tolerance: float
    ) -> None:
        narrow = 1e-13 * np.maximum(np.abs(x[bad]), self.bound.contact.roughness.sigma)
        stuck = bad[np.diff(x)[bad] < narrow]
        if len(stuck):
            i = int(stuck[0])
            near = at_knots[np.abs(x - x[i]) <= 1e-9 * self.bound.asperities.sigma_s]
            spread = near.max(axis=0) - near.min(axis=0)
            jumps = {"p": spread[0] / near[0, 0], "A_t": spread[2] / near[0, 2]}
            jumps |= dict(zip(self.columns, spread[3:], strict=True))
            which = max(jumps, key=lambda key: jumps[key])
            place = f"at {self.name} = {x[i]:.9g} m"
            if jumps[which] > tolerance:
                raise InvalidValue(
                    f"{which} jumps by {jumps[which]:.3g} {place}, so no continuous table is "
                    f"within {tolerance:g}; take a law without jumps, or particles of more than "
                    "one size, or give a range without that place"
                )
            raise InvalidValue(
                f"the tolerance {tolerance:g} cannot be met {place}: the load is not known that "
                "well there; give a larger tolerance or another range"
            )
        if len(x) > MOST_PANELS:
            raise InvalidValue(
                f"the tolerance {tolerance:g} needs more than {MOST_PANELS} panels; give a larger "
                f"one (met so far: {stated.max():.3g})"
            )


def _hermite(rise: Array, m0: Array, m1: Array) -> Array:
    """c_1, c_2, c_3 of the cubic in s with rise and end slopes, zero at s = 0: (N, 3)."""
    return np.column_stack([m0, 3 * rise - 2 * m0 - m1, m0 + m1 - 2 * rise])


def _chords(cubic: _LogCubic, x: Array, *, log: bool = False) -> Array:
    """Relative error of straight lines between places, interval by interval."""
    at = x[:-1, None] + np.diff(x)[:, None] * _PLACES
    true, ends = cubic.value(at), cubic.value(x)
    if log:
        rise = np.log(ends[1:] / ends[:-1])[:, None]
        line = ends[:-1, None] * np.exp(rise * _PLACES)
    else:
        line = ends[:-1, None] + np.diff(ends)[:, None] * _PLACES
    return 1.1 * np.abs(line / true - 1).max(axis=1)


# -------------------------------------------------------------------------- text
def _as_given(x: ArrayLike, values: Array) -> Number:
    return float(values) if np.ndim(x) == 0 else values


def rounded_up(error: float) -> str:
    """A bound in three digits, never below the bound.

    Examples
    --------
    >>> rounded_up(1.2341e-6)
    '1.24e-06'
    """
    text = f"{error:.3g}"
    return text if float(text) >= error else f"{error * 1.006:.3g}"


def _units(word: str) -> tuple[str, str, float, float]:
    if word not in UNITS:
        raise InvalidValue(f"units = {word!r} must be 'SI' (m, Pa) or 'mm' (mm, MPa)")
    return UNITS[word]


def _flat(data: dict[str, Any], path: str = "") -> Iterator[tuple[str, str]]:
    """Every input as ``surfaces.first.E`` and its value; the kind of a part is its own line."""
    for key, value in data.items():
        if isinstance(value, dict):
            yield f"{path}{key}", value["type"]
            yield from _flat(value, f"{path}{key}.")
        elif isinstance(value, list) and any(isinstance(item, dict) for item in value):
            for i, item in enumerate(value):
                yield from _flat({f"{key}[{i}]": item}, path)
        elif key != "type" and value is not None:
            yield f"{path}{key}", say(value)


_LETTERS = str.maketrans(
    {"–": "-", "—": "-", "−": "-", "×": "x", "·": "*", "µ": "u", "μ": "u", "σ": "sigma"}
    | {"’": "'", "‘": "'", "“": '"', "”": '"', "ß": "ss", "ø": "o", "ł": "l", "\\": "/"}
)


def _ascii(text: str) -> str:
    """Text that any of the programs reads: ASCII, one line, nothing that ends a C comment."""
    plain = unicodedata.normalize("NFKD", text.translate(_LETTERS))
    plain = "".join(c for c in plain if not unicodedata.combining(c))
    plain = plain.encode("ascii", "replace").decode()
    plain = "".join(c if c.isprintable() or c == "\t" else " " for c in plain)
    while "??" in plain:  # a trigraph of C
        plain = plain.replace("??", "?")
    return plain


_PYTHON = '''
from bisect import bisect_right
from math import exp

# x_i, width, p_i, three coefficients of ln p, A_i, three coefficients of ln A
_PANELS = (
{rows}
)
_KNOTS = [row[0] for row in _PANELS]
_LAST = {last}


def _panel(h):
    return _PANELS[max(bisect_right(_KNOTS, h) - 1, 0)]


def _value(h, k, last, head, tail):
    if h > _LAST:
        return last * exp(tail * (h - _LAST))
    if h < _KNOTS[0]:
        return _PANELS[0][k] * (1 + head * (h - _KNOTS[0]))
    row = _panel(h)
    s = (h - row[0]) / row[1]
    return row[k] * exp(s * (row[k + 1] + s * (row[k + 2] + s * row[k + 3])))


def pressure(h):
    """Nominal pressure [Pa] at separation h [m]."""
    return _value(h, 2, {p_last}, {p_head}, {p_tail})


def area(h):
    """Real contact area per nominal area [1] at separation h [m]."""
    return _value(h, 6, {A_last}, {A_head}, {A_tail})


def stiffness(h):
    """-dp/dh [Pa/m] at separation h [m], positive."""
    if h > _LAST:
        return -({p_tail}) * pressure(h)
    if h < _KNOTS[0]:
        return -(_PANELS[0][2] * {p_head})
    row = _panel(h)
    s = (h - row[0]) / row[1]
    return -pressure(h) * ((row[3] + s * (2 * row[4] + s * (3 * row[5]))) / row[1])
'''

_C = """
#include <math.h>

/* x_i, width, p_i, three coefficients of ln p, A_i, three coefficients of ln A */
#define PANELS @panels@
static const double panels[PANELS][10] = {
@rows@
};
static const double last_knot = @last@;

static const double *panel_of(double h)
{
    int low = 0, high = PANELS;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (panels[middle][0] <= h) low = middle; else high = middle;
    }
    return panels[low];
}

static double value_of(double h, int k, double last, double head, double tail)
{
    const double *row;
    double s;
    if (h > last_knot) return last * exp(tail * (h - last_knot));
    if (h < panels[0][0]) return panels[0][k] * (1 + head * (h - panels[0][0]));
    row = panel_of(h);
    s = (h - row[0]) / row[1];
    return row[k] * exp(s * (row[k + 1] + s * (row[k + 2] + s * row[k + 3])));
}

/* nominal pressure [Pa] at separation h [m] */
double pressure(double h)
{
    return value_of(h, 2, @p_last@, @p_head@, @p_tail@);
}

/* real contact area per nominal area [1] at separation h [m] */
double area(double h)
{
    return value_of(h, 6, @A_last@, @A_head@, @A_tail@);
}

/* -dp/dh [Pa/m] at separation h [m], positive */
double stiffness(double h)
{
    const double *row;
    double s;
    if (h > last_knot) return -(@p_tail@) * pressure(h);
    if (h < panels[0][0]) return -(panels[0][2] * @p_head@);
    row = panel_of(h);
    s = (h - row[0]) / row[1];
    return -pressure(h) * ((row[3] + s * (2 * row[4] + s * (3 * row[5]))) / row[1]);
}
"""

FORMATS = {
    "csv": (ContactTable.to_csv, ".csv"),
    "abaqus": (ContactTable.to_abaqus, ".inp"),
    "comsol": (ContactTable.to_comsol, ".txt"),
    "avl": (ContactTable.to_avl, ".avl"),
    "python": (ContactTable.to_python, ".py"),
    "c": (ContactTable.to_c, ".c"),
}
"""Every export by the word of the command line, with the suffix that means it."""
