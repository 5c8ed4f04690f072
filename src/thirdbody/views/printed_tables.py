"""Tables as they are printed, for a workbook: numbers as numbers, their units in the heads."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ..quantities.say import NOT_KNOWN, PREFIXED, number
from .columns import Cell
from .workbook import Grid, cell_of_words

__all__ = ["grid_of_words"]

NAMED = re.compile(r"[A-Za-zµΩ°][^\d×,]*|")
"""What may be a unit, and not the rest of a code or of a product."""
SIZES = {name: (unit, size) for unit, steps in PREFIXED.items() for size, name in steps}
"""Units with and without a prefix: the unit, and their size in it."""


def grid_of_words(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> Grid:
    """A table of the screen: numbers with the printed digits, units in heads, other words as is.

    Where a column has several units and the first head is empty, each row has one, beside its name.

    Parameters
    ----------
    heads : sequence of str
    rows : sequence of sequence of str

    Examples
    --------
    >>> grid_of_words(("dust", "depth"), [("a", "397 nm"), ("b", "1.2 µm"), ("c", "-")]).heads
    ['dust', 'depth [nm]']
    >>> _, ((name, now, then),) = grid_of_words(("", "now", "then"), [("depth", "1 nm", "2 nm")])
    >>> name, now.value, then.value
    ('depth [nm]', 1.0, 2.0)
    """
    if heads and not heads[0]:
        lines = [_in_one_unit(row[1:]) for row in rows]
        named = [f"{row[0]}{unit}" for row, (unit, _) in zip(rows, lines, strict=True)]
        return Grid(
            list(heads), [(name, *cells) for name, (_, cells) in zip(named, lines, strict=True)]
        )
    columns = [_in_one_unit(column) for column in zip(*rows, strict=True)]
    if not columns:
        return Grid(list(heads), [])
    made = [f"{head}{unit}" for head, (unit, _) in zip(heads, columns, strict=True)]
    return Grid(made, list(zip(*(cells for _, cells in columns), strict=True)))


def _in_one_unit(texts: Sequence[str]) -> tuple[str, list[Cell | str]]:
    """The unit, in brackets, and the cells of values that share one; else the words."""
    cells_and_units = [cell_of_words(text) for text in texts]
    parts = [(cell, unit) for cell, unit in cells_and_units if isinstance(cell, Cell)]
    others = [
        text
        for text, (cell, _) in zip(texts, cells_and_units, strict=True)
        if isinstance(cell, str)
    ]
    plain = all(text in ("-", NOT_KNOWN) or text.startswith("<") for text in others)
    if not (parts and plain and all(NAMED.fullmatch(unit) for _, unit in parts)):
        return "", list(texts)
    if len({SIZES.get(unit, (unit, 1.0))[0] for _, unit in parts}) > 1:
        return "", list(texts)
    sizes = sorted(SIZES.get(unit, (unit, 1.0))[1] for _, unit in parts)
    size = sizes[(len(sizes) - 1) // 2]
    shared = next(unit for _, unit in parts if SIZES.get(unit, (unit, 1.0))[1] == size)
    cells = [
        _scale_cell(cell, SIZES.get(unit, (unit, 1.0))[1] / size)
        if isinstance(cell, Cell)
        else text
        for text, (cell, unit) in zip(texts, cells_and_units, strict=True)
    ]
    return f" [{shared}]" if shared else "", cells


def _scale_cell(cell: Cell, factor: float) -> Cell:
    """A number in another unit, with as many digits as are printed."""
    if factor == 1:
        return cell
    digits = len(re.sub(r"×.*|\D", "", cell.text).lstrip("0"))
    value = float(f"{cell.value * factor:.{max(digits, 1)}g}")
    return Cell(value, number(value, max(digits, 1)) if abs(value) < 1 else number(value, 12))
