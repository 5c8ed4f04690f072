"""Workbooks: sheets of sentences, tables and pictures, the same bytes every time.

A cell holds the whole number and shows it rounded as a reader gets it printed: its number format
follows from the printed text.
"""

from __future__ import annotations

import io
import math
import re
import zipfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_HALF_UP, Decimal
from typing import TYPE_CHECKING, Any, NamedTuple

from ..quantities.files import with_units
from ..quantities.say import Least, number
from .columns import Cell

if TYPE_CHECKING:
    from openpyxl.worksheet.worksheet import Worksheet

__all__ = [
    "MADE",
    "Grid",
    "Sheet",
    "cell_of",
    "cell_of_words",
    "sheet_of_table",
    "shown_in_excel",
    "workbook_bytes",
]

MADE = "1980-01-01T00:00:00Z"
"""When every workbook says it was made: the same bytes every time."""
PROSE, WIDEST, LEAST_WIDTH = 100, 60, 6
"""Characters of a line of sentences, of the widest column of a table, and of the narrowest."""
LINE = 15.0
"""Height of a line [pt]."""
PRINTED = re.compile(r"(−?\d+(?:\.(\d+))?)(×10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?( %)?")
"""A number as `thirdbody.quantities.say` prints it."""


DIGITS = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")


class Grid(NamedTuple):
    """A table: heads, and rows of words, numbers and cells; None is an empty one."""

    heads: Sequence[str]
    rows: Sequence[Sequence[Any]]


@dataclass(frozen=True)
class Sheet:
    """Content of one sheet, from top to bottom.

    Attributes
    ----------
    name : str
    parts : tuple
        Sentences; `Grid`; pictures, the bytes of a PNG.
    title : str, optional
        Above all.
    frozen : str, optional
        The cell above and left of which all stays in sight; of a sheet with a title none.
    """

    name: str
    parts: tuple[str | Grid | bytes, ...]
    title: str = ""
    frozen: str = "A2"


def cell_of(value: Any) -> Cell | str | None:
    """A value of a table of numbers and words; one that is no finite number is left empty.

    >>> cell_of(4.46764e-5), cell_of(12345), cell_of("s-s"), cell_of(float("nan"))
    (Cell(value=4.46764e-05, text='4.468×10⁻⁵'), Cell(value=12345, text='12345'), 's-s', None)
    """
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return Cell(value, number(value)) if math.isfinite(value) else None
    return Cell(value, str(value)) if isinstance(value, int) else value


def cell_of_words(text: str) -> tuple[Cell | str, str]:
    """Number and unit of a printed value; other words as they are, without a unit.

    >>> from thirdbody.quantities.say import percent
    >>> cell_of_words("226.4 nm"), cell_of_words("12.5 %"), cell_of_words("mixed")
    ((Cell(value=226.4, text='226.4'), 'nm'), (Cell(value=0.125, text='12.5 %'), ''), ('mixed', ''))
    >>> cell_of_words(percent(4e-8, least=1e-6))
    (Cell(value=4e-08, text='< 0.0001 %'), '')
    """
    if isinstance(text, Least):
        return Cell(text.value, str(text)), ""
    match = PRINTED.match(text)
    if match is None:
        return text, ""
    plain = match[0].removesuffix(" %").replace("−", "-").replace("×10", "e")
    value = Decimal(plain.translate(DIGITS)).scaleb(-2 if match[4] else 0)
    return Cell(float(value), match[0]), text[match.end() :].strip()


def sheet_of_table(
    name: str, columns: Mapping[str, Sequence[object]], units: Mapping[str, str]
) -> Sheet:
    """All columns of a table as they are, their SI units in their heads, a row a state."""
    named = with_units(columns, units)
    rows = [list(map(cell_of, row)) for row in zip(*named.values(), strict=True)]
    return Sheet(name, (Grid(list(named), rows),), frozen="B2")


def shown_in_excel(cell: Cell) -> str:
    """The number format that shows a number as it is printed.

    What a spreadsheet would round to another digit, as it does halves, stands there as words.

    >>> [shown_in_excel(Cell(v, number(v))) for v in (226.4, 4.4678e-5, 12.325)]
    ['0.0', '0.000E+00', '"12.32"']
    >>> shown_in_excel(Cell(0.1234, "12.3 %")), shown_in_excel(Cell(1e-8, "< 0.0001 %"))
    ('0.0 %', '"< 0.0001 %"')
    """
    match = PRINTED.fullmatch(cell.text)
    if match is None:
        return f'"{cell.text}"'
    plain, decimals, power, share = match.groups()
    tens = int(power.removeprefix("×10").translate(DIGITS)) if power else 0
    digits = Decimal(repr(cell.value)).scaleb(2 * bool(share) - tens)
    rounded = digits.quantize(Decimal(1).scaleb(-len(decimals or "")), ROUND_HALF_UP)
    if rounded != Decimal(plain.replace("−", "-")):
        return f'"{cell.text}"'
    form = f"0.{'0' * len(decimals)}" if decimals else "0"
    return form + ("E+00" if power else "") + (" %" if share else "")


def workbook_bytes(sheets: Sequence[Sheet]) -> bytes:
    """A workbook; when it was made stands nowhere in it: the same sheets are the same bytes."""
    from openpyxl import Workbook

    book = Workbook()
    book.remove(book.active)
    book.properties.creator = "thirdbody"
    for sheet in sheets:
        _draw_sheet(book.create_sheet(sheet.name), sheet)
    made = io.BytesIO()
    book.save(made)
    out = io.BytesIO()
    with zipfile.ZipFile(made) as held, zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as packed:
        for name in held.namelist():
            data = held.read(name)
            if name == "docProps/core.xml":
                data = re.sub(rb"\d{4}-\d\d-\d\dT[\d:]+Z", MADE.encode(), data)
            entry = zipfile.ZipInfo(name)  # dated 1980
            entry.compress_type = zipfile.ZIP_DEFLATED
            packed.writestr(entry, data)
    return out.getvalue()


def _draw_sheet(drawn: Worksheet, sheet: Sheet) -> None:
    """Write the parts of a sheet below each other; the head of a table stays in sight."""
    from openpyxl.styles import Font

    widths = _widths([grid for grid in sheet.parts if isinstance(grid, Grid)])
    if sheet.title:  # the last column of each table has room at its right
        widths = _widths(
            [Grid(grid.heads[:-1], grid.rows) for grid in sheet.parts if isinstance(grid, Grid)]
        )
        widths = [max(w, 12) for w in (*widths, *[12] * (9 - len(widths)))]
    for i, width in enumerate(widths, 1):
        drawn.column_dimensions[_letter(i)].width = width
    row = 1
    if sheet.title:
        _write_words(drawn, 1, 1, sheet.title).font = Font(bold=True, size=14)
        row = 3
    elif isinstance(first := sheet.parts[0], Grid):
        drawn.freeze_panes = sheet.frozen
        if len(sheet.parts) == 1 and len(first.rows) > 1:
            drawn.auto_filter.ref = f"A1:{_letter(len(first.heads))}{len(first.rows) + 1}"
    for content in sheet.parts:
        if isinstance(content, Grid):
            row = _draw_grid(drawn, content, row, widths, free=bool(sheet.title)) + 1
        elif isinstance(content, bytes):
            row = _place_picture(drawn, content, row) + 1
        else:
            row = _draw_sentence(drawn, content, row, widths)
    drawn.page_setup.orientation = "landscape"
    drawn.page_setup.fitToHeight = 0
    drawn.sheet_properties.pageSetUpPr.fitToPage = True


def _widths(grids: Iterable[Grid]) -> list[int]:
    """Characters of each column: heads and cells whole, words of many folded."""
    widths: list[int] = []
    for grid in grids:
        for i, head in enumerate(grid.heads):
            shown = [row[i].text if isinstance(row[i], Cell) else str(row[i] or "")
                     for row in grid.rows]  # fmt: skip
            needed = max(math.ceil(1.15 * len(head)), *map(len, shown), LEAST_WIDTH) + 3
            widths += [LEAST_WIDTH] * (i + 1 - len(widths))
            widths[i] = max(widths[i], min(needed, WIDEST))
    return widths


def _draw_grid(
    drawn: Worksheet, grid: Grid, row: int, widths: Sequence[int], *, free: bool = False
) -> int:
    """A table whose first row is ``row``; words of its last column are not folded where ``free``.

    Returns the row after it.
    """
    from openpyxl.styles import Alignment, Border, Font, PatternFill, Side

    bold, fill = Font(bold=True), PatternFill("solid", fgColor="F0F0F0")
    last = -1 if free else 0
    below = Border(bottom=Side(style="thin", color="999999"))
    numeric = [any(isinstance(line[i], Cell) for line in grid.rows) for i in range(len(grid.heads))]
    sides = ["right" if is_numeric else "left" for is_numeric in numeric]
    # words keep off the number before them
    places = [{"horizontal": side, "vertical": "top", "indent": int(i > 0 and side == "left")}
              for i, side in enumerate(sides)]  # fmt: skip
    folded = [Alignment(**place, wrap_text=True) for place in places]
    if free:
        folded[-1] = Alignment(**places[-1])
    top = Alignment(vertical="top")
    for i, head in enumerate(grid.heads):
        cell = _write_words(drawn, row, i + 1, head)
        cell.font, cell.fill, cell.border = bold, fill, below
        cell.alignment = Alignment(**places[i])
    for line in grid.rows:
        row += 1
        words = [str(v) if v is not None and not isinstance(v, Cell) else "" for v in line]
        lines = max(_lines(text, widths[i]) for i, text in enumerate(words[: last or None]))
        for i, value in enumerate(line):
            if isinstance(value, Cell):
                cell = drawn.cell(row, i + 1, value.value)
                cell.number_format = shown_in_excel(value)
                if lines > 1:
                    cell.alignment = top
            elif words[i]:
                _write_words(drawn, row, i + 1, words[i]).alignment = folded[i]
        if lines > 1:
            drawn.row_dimensions[row].height = LINE * lines
    return row + 1


def _draw_sentence(drawn: Worksheet, text: str, row: int, widths: Sequence[int]) -> int:
    """A sentence over as many columns as a line takes; the row after it."""
    from openpyxl.styles import Alignment

    across, room = 0, 0
    while across < len(widths) and room < PROSE:
        room += widths[across]
        across += 1
    _write_words(drawn, row, 1, text).alignment = Alignment(wrap_text=True, vertical="top")
    if across > 1:
        drawn.merge_cells(start_row=row, start_column=1, end_row=row, end_column=across)
    drawn.row_dimensions[row].height = LINE * _lines(text, room)
    return row + 1


def _place_picture(drawn: Worksheet, png: bytes, row: int) -> int:
    """A picture below what stands there; the row after it."""
    from openpyxl.drawing.image import Image

    image = Image(io.BytesIO(png))
    drawn.add_image(image, f"A{row}")
    return row + math.ceil(image.height * 0.75 / LINE) + 1


def _lines(text: str, width: int) -> int:
    """Lines that a text takes in a column, as letters are wider than figures at times."""
    return max(1, math.ceil(len(text) * 1.1 / max(width - 1, 1)))


def _letter(column: int) -> str:
    from openpyxl.utils import get_column_letter

    return str(get_column_letter(column))


def _write_words(drawn: Worksheet, row: int, column: int, text: str) -> Any:
    """A cell of words, which are no formula, whatever they begin with."""
    from openpyxl.cell.cell import ILLEGAL_CHARACTERS_RE

    cell = drawn.cell(row, column, ILLEGAL_CHARACTERS_RE.sub(" ", text))
    cell.data_type = "s"
    return cell
