"""Columns of numbers as readers get them, printed and in a workbook: the same digits."""

from __future__ import annotations

import math
from collections.abc import Iterable
from decimal import Decimal
from typing import TYPE_CHECKING, NamedTuple

from ..equilibrium.words import RARE, is_rare
from ..quantities.say import NOT_KNOWN, number, percent, readable_unit

if TYPE_CHECKING:
    from ..contact.contact import Contact
    from ..study import FilmResult, StudyResult

__all__ = ["Cell", "Shown", "film_columns", "in_unit", "modes_of", "state_columns"]


class Cell(NamedTuple):
    """A number, and how a reader gets it printed."""

    value: float
    text: str


class Shown(NamedTuple):
    """A column for readers: unit in sentences, and one unit for all states in a workbook.

    ``unit`` is an SI unit, "1", or "share", which is printed in per cent; shares below ``least``
    are printed as such.
    """

    head: str
    name: str
    unit: str
    least: float = 0.0

    def words(self, value: float | None) -> str:
        """One value with its unit.

        >>> Shown("h", "h", "m").words(2.264e-7), Shown("area", "A_t", "share").words(0.1234)
        ('226.4 nm', '12.3 %')
        """
        if self.unit == "share":
            return percent(value, least=self.least)
        if value is None or not math.isfinite(value):
            return NOT_KNOWN
        size, unit = readable_unit(value, self.unit)
        return f"{number(value / size, least=self.least)} {unit}".rstrip()

    def column(self, values: Iterable[float | None]) -> tuple[str, list[Cell | str]]:
        """Head and cells of all values, in the unit in which most are read.

        >>> Shown("h", "h", "m").column([1e-7, 2e-7, 1.2e-6])
        ('h [nm]', [Cell(value=100.0, text='100'), Cell(value=200.0, text='200'), \
Cell(value=1200.0, text='1200')])
        """
        finite = [None if v is None or not math.isfinite(v) else float(v) for v in values]
        sizes = sorted(abs(v) for v in finite if v)
        size, unit = 1.0, ""
        if sizes and self.unit not in ("1", "share"):
            size, unit = readable_unit(sizes[len(sizes) // 2], self.unit)
        head = f"{self.head} [{unit}]" if unit else self.head
        return head, [self._cell(value, size) for value in finite]

    def _cell(self, value: float | None, size: float) -> Cell | str:
        if value is None:
            return NOT_KNOWN
        if self.unit == "share":
            return Cell(value, percent(value, least=self.least))
        return Cell(in_unit(value, size), number(value / size, least=self.least))


def in_unit(value: float, size: float) -> float:
    """A number in a unit of so many SI units; one of a power of ten moves the point alone.

    >>> in_unit(1e-7, 1e-9), 1e-7 / 1e-9
    (100.0, 99.99999999999999)
    """
    power = round(math.log10(size))
    if not math.isclose(size, 10.0**power, rel_tol=1e-12):
        return value / size
    return float(Decimal(repr(value)).scaleb(-power))


STATE_COLUMNS = (
    Shown("F*", "F_star", "1"),
    Shown("pressure", "pressure", "Pa"),
    Shown("h", "h", "m"),
    Shown("d", "d", "m"),
    Shown("d/sigma", "d_star", "1"),
    Shown("A_t", "A_t", "1"),
    Shown("A_ss", "A_ss", "1"),
    Shown("A_sa", "A_sa", "1"),
    Shown("particles' load", "particle_load_share", "share"),
    Shown("particles' area", "particle_area_share", "share"),
)
"""Columns of a table of states; the last three where there are particles."""
OF_DUST = ("A_sa", "particle_load_share", "particle_area_share")
FILM_COLUMNS = (
    Shown("speed", "speed", "m/s"),
    Shown("film h_T", "h_T", "m"),
    Shown("lambda", "lambda_ratio", "1"),
    Shown("on film", "film_share", "share", 1e-6),
    Shown("on asperities", "ss_share", "share", 1e-6),
    Shown("on particles", "sa_share", "share", 1e-6),
    Shown("friction", "mu", "1"),
)
"""Columns of a table of a film over the speed."""


def state_columns(contact: Contact) -> list[Shown]:
    """Columns of a table of states of a contact."""
    dusty = not contact.two_body
    return [column for column in STATE_COLUMNS if dusty or column.name not in OF_DUST]


def modes_of(result: StudyResult) -> list[str]:
    """The mode of every state, as far as the contact itself has one."""
    return [
        RARE if is_rare(mode, result.particles_in(i)) else mode or "-"
        for i, mode in enumerate(result.states.mode)
    ]


def film_columns(result: FilmResult) -> list[Shown]:
    """Columns of a table of a film: particles and friction where there are any."""
    gone = {"sa_share"} if not result.passing else set()
    gone |= set() if any(map(math.isfinite, result.states["mu"])) else {"mu"}
    return [column for column in FILM_COLUMNS if column.name not in gone]
