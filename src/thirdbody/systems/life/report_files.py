"""Files of oil reports: a line a report, codes or counts from some sizes on."""

from __future__ import annotations

import math
import re
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...errors import InvalidValue, Mistake, Problem
from ...populations.measured.cleanliness import read_iso4406
from ...quantities.carried import takes_units
from ...quantities.csv_cells import numbered_cells
from ...quantities.say import plural
from ...quantities.units import say, to_si

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["read_reports"]

MOST_ROWS = 10_000
MOST_MISTAKES = 20
"""Mistakes of a file that are said one by one."""


@takes_units
def read_reports(
    path: str | Path, *, fewest: int = 1
) -> tuple[Array, list[str] | Array, Array | None]:
    """Times, reports and sizes of a CSV file, as `oil_reports` takes them.

    The first line names the columns: the time with its unit in brackets, then the code, or counts
    by their sizes: ``time [h], ISO 4406`` or ``time [h], 4 um [1/mL], 6 um [1/mL], ...``.

    Parameters
    ----------
    path : path-like
        Text in UTF-8, columns parted by comma, semicolon or tab. Lines that begin with # are
        comments.
    fewest : int, optional
        Reports that are needed [1].

    Returns
    -------
    times : array (R,)
        [s].
    reports : list of str or array (R, S)
        Codes, or counts [1/m³]; 0 where no particle was counted.
    sizes : array (S,) or None
        From which is counted [m]; None of codes.

    Raises
    ------
    InvalidValue
        One sentence for each mistake, with its line and column.

    Examples
    --------
    >>> from pathlib import Path
    >>> import tempfile
    >>> from thirdbody.systems.life.reports import read_reports
    >>> file = Path(tempfile.mkdtemp()) / "oil.csv"
    >>> _ = file.write_text("time [h],ISO 4406\\n0,20/18/15\\n250,18/16/13\\n")
    >>> times, codes, _ = read_reports(file)
    >>> times.tolist(), codes
    ([0.0, 900000.0], ['20/18/15', '18/16/13'])
    """
    lines = numbered_cells(Path(path), "a CSV file of oil reports", most=MOST_ROWS)
    reading = _Reading(path)
    head, names = lines[0]
    columns = reading.columns(head, names)
    reading.end()  # below a line of names that is wrong every line would be
    rows = [reading.row(number, cells, names, columns) for number, cells in lines[1:]]
    if not rows:
        raise InvalidValue(f"{path} has a first line but no reports below it", code=Mistake.EMPTY)
    if len(rows) < fewest:
        rule = f"one report; {fewest} or more say what entered between them"
        reading.add_mistake(rows[0].number, None, rule, Mistake.EMPTY)
    reading.check_order(rows, f" {columns[0].unit}")
    reading.end()
    times = np.array([row.time for row in rows])
    if len(columns) == 2 and not columns[1].size:
        return times, [row.code for row in rows], None
    return times, np.array([row.counts for row in rows]), np.array([c.size for c in columns[1:]])


class _Column(NamedTuple):
    """A column of a file: times where it is the first, codes where it has no size."""

    unit: str = ""
    size: float = 0.0
    """From which is counted [m]."""


class _Row(NamedTuple):
    """A report."""

    number: int
    """Of its line."""
    said: str
    """Its time as it stands there."""
    time: float
    """[s]; NaN where it is wrong."""
    code: str
    counts: list[float]
    """[1/m³]."""


class _Reading:
    """A file that is read, and its mistakes so far."""

    def __init__(self, path: str | Path) -> None:
        self.path = path
        self.mistakes: list[tuple[int, int, Problem]] = []

    def end(self) -> None:
        """Raise what was wrong so far."""
        if not self.mistakes:
            return
        self.mistakes.sort(key=lambda mistake: mistake[:2])
        shown = [problem for *_, problem in self.mistakes[:MOST_MISTAKES]]
        if more := len(self.mistakes) - len(shown):
            *_, first = self.mistakes[MOST_MISTAKES]
            rule = f"{self.path} has {more} more mistakes like these"
            shown.append(Problem("", rule, code=first.code))
        raise InvalidValue(*shown)

    def add_mistake(self, line: int, column: int | None, rule: str, code: Mistake) -> None:
        """Add a mistake at a place, columns counted from 1."""
        at = f"{self.path}, line {line}" + ("" if column is None else f", column {column}")
        self.mistakes.append((line, column or 0, Problem("", f"{at}: {rule}", code=code)))

    def number(self, line: int, column: int, cell: str, unit: str, of: str) -> float:
        """A number of a cell in SI; NaN where there is none, which is told."""
        try:
            value = to_si(f"{cell} {unit}", of)
        except InvalidValue as error:
            first = error.problems[0]
            bare = re.fullmatch(r"[+-]?[\d.]+([eE][+-]?\d+)?|nan|inf", cell.strip())
            rule = str(first) if bare else f"{say(cell)} is not a number [{unit}]"
            self.add_mistake(line, column, rule, first.code if bare else Mistake.KIND)
            return math.nan
        if not math.isfinite(value):
            what = "time" if of == "s" else "number"
            self.add_mistake(
                line, column, f"{say(cell)} is not a finite {what} [{unit}]", Mistake.RANGE
            )
            return math.nan
        return value

    # -------------------------------------------------------------------------- the first line
    def columns(self, line: int, names: list[str]) -> list[_Column]:
        """What the columns hold, by the first line."""
        if len(names) < 2:
            rule = (
                "needs a column of times and one of codes, or of counts, e.g. "
                '"time [h],ISO 4406" or "time [h],4 um [1/mL],6 um [1/mL],14 um [1/mL]"'
            )
            self.add_mistake(line, None, rule, Mistake.SHAPE)
            return []
        out = [_Column(self._unit(line, 1, names[0], "s", "time [h]"))]
        if len(names) == 2 and not _is_count(names[1]):
            return [*out, _Column()]
        out += [self._counts(line, i, name) for i, name in enumerate(names[1:], 2)]
        for i, (a, b) in enumerate(pairwise(out[1:]), 3):
            if b.size and b.size <= a.size:
                rule = f"{say(names[i - 1])} must be of a larger size than the column before it"
                self.add_mistake(line, i, rule, Mistake.ORDER)
        return out

    def _unit(self, line: int, column: int, name: str, of: str, example: str) -> str:
        """The unit that stands in brackets behind a name."""
        match = re.search(r"\[\s*([^\]]+?)\s*\]", name)
        if not match:
            rule = f'{say(name)} has no unit; write it in brackets, e.g. "{example}"'
            self.add_mistake(line, column, rule, Mistake.UNIT)
            return ""
        try:
            to_si(f"1 {match[1]}", of)
        except InvalidValue as error:
            self.add_mistake(line, column, f"{say(name)}: {error.problems[0]}", Mistake.UNIT)
        return match[1]

    def _counts(self, line: int, column: int, name: str) -> _Column:
        """Size [m] and unit of a column of counts."""
        size = re.sub(r"\[.*?\]|\(c\)|[>≥]", "", name).strip()
        try:
            at = to_si(size, "m")
        except InvalidValue:
            rule = f'{say(name)} must be a size and a unit of counts, e.g. "4 um [1/mL]"'
            self.add_mistake(line, column, rule, Mistake.FORM)
            return _Column()
        return _Column(self._unit(line, column, name, "1/m^3", f"{size} [1/mL]"), at)

    # -------------------------------------------------------------------------- reports
    def row(self, line: int, cells: list[str], names: list[str], columns: list[_Column]) -> _Row:
        """A report of a line."""
        if len(cells) != len(names):
            rule = f"{plural(len(cells), 'value')} where the first line names {len(names)} columns"
            self.add_mistake(line, None, rule, Mistake.SHAPE)
            return _Row(line, cells[0], math.nan, "", [])
        time = self.number(line, 1, cells[0], columns[0].unit, "s")
        if not columns[1].size:
            try:
                read_iso4406(cells[1])
            except InvalidValue as error:
                self.add_mistake(line, 2, str(error.problems[0]), error.problems[0].code)
            return _Row(line, cells[0], time, cells[1], [])
        counts = [
            self._count(line, i, cell, column.unit)
            for i, (cell, column) in enumerate(zip(cells[1:], columns[1:], strict=True), 2)
        ]
        for i, (a, b) in enumerate(pairwise(counts), 3):
            if b > a:
                rule = (
                    f"{say(cells[i - 1])} is more than {say(cells[i - 2])} from the smaller size: "
                    "larger particles are among the smaller; do the columns count from a size on?"
                )
                self.add_mistake(line, i, rule, Mistake.ORDER)
        return _Row(line, cells[0], time, "", counts)

    def _count(self, line: int, column: int, cell: str, unit: str) -> float:
        count = self.number(line, column, cell, unit, "1/m^3")
        if count < 0:
            rule = f"{say(cell)} [{unit}] must be 0 or more: it counts particles"
            self.add_mistake(line, column, rule, Mistake.RANGE)
            return math.nan
        return count

    def check_order(self, rows: list[_Row], unit: str) -> None:
        """Tell where a report is not later than the one before."""
        rows_with_time = [row for row in rows if math.isfinite(row.time)]
        for before, row in pairwise(rows_with_time):
            if not row.time > before.time:
                rule = (
                    f"{say(row.said)}{unit} is not later than the report of line {before.number}: "
                    "reports stand in the order of their times"
                )
                self.add_mistake(row.number, 1, rule, Mistake.ORDER)


def _is_count(name: str) -> bool:
    """Whether a name is that of a column of counts: a size and a unit."""
    return bool(re.match(r"\s*[>≥]?\s*[\d.]+\s*(um|µm|μm|mm|nm)", name))
