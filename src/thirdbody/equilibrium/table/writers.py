"""A table of a contact, and its files for other solvers."""

from __future__ import annotations

import csv
import io
import os
import textwrap
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...contact.citations import cite
from ...contact.contact import Contact
from ...contact.interface import interface
from ...errors import Advice, InvalidValue, Mistake, Problem
from ...quantities.arguments import names_arguments
from ...quantities.carried import takes_units
from ...quantities.files import write_text
from ...quantities.record import VERSION, Column, Record, TableRecord, Variable
from ...quantities.units import say
from ..columns import COLUMNS, about, provenance
from .cubic import _LogCubic

__all__ = ["FORMATS", "ContactTable", "TableError"]

Array = NDArray[np.float64]

Number = float | Array

UNITS = {"SI": ("m", "Pa", 1.0, 1.0), "mm": ("mm", "MPa", 1e3, 1e-6)}
"""Length, pressure, and how many of them one metre and one pascal are."""
SAMPLES = 33
_PLACES = np.sin(0.5 * np.pi * (np.arange(SAMPLES) + 0.5) / SAMPLES) ** 2


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class TableError(Record):
    """How far a table is from the contact it was made of; never less than the true error.

    Inside the range ``p`` and ``A`` are relative errors, ``dp_dh`` is relative to the true slope,
    ``shares`` is absolute. ``above`` [Pa] bounds the pressure error beyond the upper end.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> error = tb.table(contact, tolerance=1e-4).error
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
class ContactTable(TableRecord):
    r"""Pressure, real area and stiffness of a contact as C¹ functions of the separation.

    Made by `thirdbody.Contact.table`. Inside the range each is within `error` of the contact.
    Above it p and A_t decay exponentially, :math:`p = p_N e^{-(x-x_N)/\lambda}`; below it they go
    on along their tangents. Value and slope are continuous everywhere. Below the range there is
    no statement on the error; shares are constant outside. As labelled data and as a table it has
    pressure, area and their slopes at its knots, as the file of `to_csv`.

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
    >>> table = tb.table(contact, tolerance=1e-4)
    >>> state = tb.solve(contact, pressure=5e6)
    >>> abs(table.p(state.h) / 5e6 - 1) < table.error.p < 1e-4
    True
    """

    in_dict = (
        *(VERSION, "coordinate", "tolerance", "error"),
        ("", lambda table: {name: column.values for name, column in table.at_knots().items()}),
        "warnings",
    )
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
    @takes_units
    def p(self, h: ArrayLike) -> Number:
        """Nominal pressure [Pa] at separations [m], any shape."""
        return _as_given(h, self._p.value(np.asarray(h, dtype=float)))

    @takes_units
    def dp_dh(self, h: ArrayLike) -> Number:
        """Slope of `p` [Pa/m], negative: the exact derivative of the table."""
        return _as_given(h, self._p.slope(np.asarray(h, dtype=float)))

    @takes_units
    def A(self, h: ArrayLike) -> Number:
        """Real area A_t per nominal area [1]."""
        return _as_given(h, self._A.value(np.asarray(h, dtype=float)))

    @takes_units
    def dA_dh(self, h: ArrayLike) -> Number:
        """Slope of `A` [1/m]: the exact derivative of the table."""
        return _as_given(h, self._A.slope(np.asarray(h, dtype=float)))

    @takes_units
    def share(self, name: str, h: ArrayLike) -> Number:
        """A share [1] that was asked for in ``columns``; constant beyond the ends."""
        if name not in self._shares:
            names = ", ".join(self._shares) or "none; " + Advice(
                "give columns=... when the table is made",
                "this command makes tables without shares",
            )
            raise InvalidValue(
                Problem(
                    "share",
                    f"{name!r} is not in this table",
                    hint="it has " + names,
                    code=Mistake.UNKNOWN,
                )
            )
        c = self._shares[name]
        x = np.clip(np.asarray(h, dtype=float), self.h[0], self.h[-1])
        i = self._p.panel(x)
        s = (x - self.h[i]) / self._p.width[i]
        return _as_given(h, c[i, 0] + s * (c[i, 1] + s * (c[i, 2] + s * c[i, 3])))

    # ------------------------------------------------------------------ as data
    def at_knots(self) -> dict[str, Variable]:
        """Separations, pressure, area, slopes and shares at the knots."""
        x = self.coordinate
        slope = Column(f"dp/d{x}", "Pa/m", "slope of the pressure")
        of_area = Column(f"dA_t*/d{x}", "1/m", "slope of the area")
        columns: dict[str, tuple[Column, Array]] = {
            x: (COLUMNS[x], self.h),
            "p": (COLUMNS["pressure"], self._p.at_knots()),
            f"dp_d{x}": (slope, self._p.slope(self.h)),
            "A_t": (COLUMNS["A_t"], self._A.at_knots()),
            f"dA_d{x}": (of_area, self._A.slope(self.h)),
        }
        for name in self._shares:
            columns[name] = about(name)._replace(unit="1"), np.asarray(self.share(name, self.h))
        return {name: Variable((x,), values, to.labels) for name, (to, values) in columns.items()}

    def variables(self) -> dict[str, Variable]:
        """What there is at the knots but the separations."""
        columns = self.at_knots()
        del columns[self.coordinate]
        return columns

    def coordinates(self) -> dict[str, Variable]:
        """The separations of the knots."""
        return {self.coordinate: self.at_knots()[self.coordinate]}

    def attributes(self) -> Mapping[str, object]:
        """Tolerance and errors, warnings, inputs, version and citations."""
        errors = {f"error_{name}": value for name, value in self.error.to_dict().items()}
        said = {"tolerance": self.tolerance, **errors, "warnings": "\n".join(self.warnings)}
        return said | provenance(self.contact)

    # ------------------------------------------------------------------ what files say
    def about(self) -> list[str]:
        """Sentences at the top of every exported file."""
        from ...version import __version__

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
    @names_arguments
    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Knots, values and slopes, with a head of ``#`` lines.

        The cubic Hermite interpolant of ln p (and of ln A_t) through these rows is the table.
        """
        columns = {
            f"{name} [{column.labels['units']}]": np.asarray(column.values)
            for name, column in self.at_knots().items()
        }
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

    @takes_units
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
            raise InvalidValue(
                Problem("name", "must be letters, digits, - and _", repr(name), code=Mistake.FORM)
            )
        x, worst = self._rows(tolerance)
        # the tangent at the last knot leads to no pressure at all
        foot = self.h[-1] - self._p.last / float(self._p.slope(self.h[-1:])[0])
        x = np.append(x, foot)
        p = np.append(self._p.value(x[:-1]), 0.0)
        over = [f"{(datum - at) * per_m:.12e}" for at in x[::-1].tolist()]
        if len(set(over)) < len(over):
            raise InvalidValue(
                Problem(
                    "datum",
                    "m is so far from the gaps that pairs coincide when written",
                    f"{datum:g}",
                    code=Mistake.BEYOND,
                )
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

    @takes_units
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

    @takes_units
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

    @names_arguments
    def to_python(self, path: str | os.PathLike[str]) -> None:
        """A Python module with ``pressure(h)``, ``area(h)`` and ``stiffness(h)`` = −dp/dh.

        It needs the standard library only and agrees with the table to rounding.
        """
        rows = "\n".join(f"    ({', '.join(row)})," for row in self._coefficients())
        write_text(path, self._head("# ") + _PYTHON.format(rows=rows, **self._ends()))

    @names_arguments
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
                Problem(
                    "tolerance",
                    "of straight lines must be from 1e-6 to 0.1 [1]",
                    repr(tolerance),
                    code=Mistake.RANGE,
                )
            )
        x = self.h[[0, -1]]
        while True:
            error = _chords(self._p, x, log=log)
            bad = np.flatnonzero(error > tolerance)
            if not len(bad):
                return x, float(error.max())
            if len(x) > MOST_ROWS:
                raise InvalidValue(
                    Problem(
                        "tolerance",
                        f"takes more than {MOST_ROWS:,} straight lines: the error no longer "
                        "falls with their length; ask for less",
                        repr(tolerance),
                        code=Mistake.TOO_LARGE,
                    )
                )
            x = np.insert(x, bad + 1, 0.5 * (x[bad] + x[bad + 1]))


MOST_ROWS = 200_000
"""Straight lines of a table."""


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float, np.number)) and not isinstance(value, bool)


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
        raise InvalidValue(
            Problem(
                "units", "must be 'SI' (m, Pa) or 'mm' (mm, MPa)", repr(word), code=Mistake.OPTION
            )
        )
    return UNITS[word]


def _flat(data: dict[str, Any], path: str = "") -> Iterator[tuple[str, str]]:
    """Pairs of dotted name and value of every input; the kind of a part is a pair too."""
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
    """Text for every program: ASCII, one line, nothing that ends a C comment."""
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
