"""Cells over the gap: what particles carry there stands at nodes, filled where a separation looks.

A segment of gaps is cut into equal cells. The nodes of a cell are filled when a separation first
comes near; those of the last cells are kept, in slots.
"""

from __future__ import annotations

import math

from ..compiled.machine import keep_apart
from .fields import WIDTH
from .fragments import fill_fragments
from .gaps import fill_gaps
from .laid import BASE, BY_GAPS, COUNT, FREE, PIECE_BEGIN, PIECE_END, SLOT, WAY
from .seats import (
    CELLS,
    FROM,
    KEY,
    MOST_NODES,
    PARTS,
    PLACE,
    PLACE_END,
    REACH,
    SLOTS,
    UNTIL,
    add_nodes,
    weigh_gaps,
)
from .sides import scalar

__all__ = ["add_cells", "empty_slots"]

MOST_OF_CELL = 64
"""Nodes of a cell, at most."""


@scalar
def empty_slots(grid, begin, end):
    """Forget the cells in these slots."""
    for slot in range(begin, end):
        grid[KEY, slot] = 0.0


@scalar
def _fill(given, sides, panels, p, own, grid, s, m, place, rule, sums, way):
    """Fill the nodes of cell m of segment s from a place on; where they end, or −1."""
    keep_apart()
    begin, end, parts = grid[FROM, s], grid[UNTIL, s], grid[PARTS, s]
    step, last = (end - begin) / parts, m == parts - 1
    a, b = begin + m * step, end if last else begin + (m + 1) * step
    if own[WAY] == BY_GAPS:
        return fill_gaps(given, sides, panels, p, own[COUNT], grid, s, a, b, place, rule, sums)
    return fill_fragments(
        given, sides, panels, p, own[COUNT], grid, s, last, a, b, place, rule, way
    )


@scalar
def add_cells(given, sides, panels, p, own, free, grid, gap, rule, sums, way, out):
    """What part p carries at a gap by its cells; False where there is no room.

    ``own`` is what is laid of it, ``free`` says where nodes are free.
    """
    keep_apart()
    width = given[p, WIDTH]
    low, high = gap - REACH * width, gap + REACH * width
    for s in range(own[PIECE_BEGIN], own[PIECE_END]):
        begin, end, parts = grid[FROM, s], grid[UNTIL, s], grid[PARTS, s]
        if end < low or begin > high:
            continue
        step = (end - begin) / parts
        first = int(max((low - begin) / step, 0.0))
        last = int(min(math.ceil((high - begin) / step), parts))
        for m in range(first, last):
            cell = grid[CELLS, s] + m
            slot = own[SLOT] + int(cell) % SLOTS
            if grid[KEY, slot] != cell + 1:
                if free[FREE] + MOST_OF_CELL > MOST_NODES:
                    free[FREE] = free[BASE]
                    empty_slots(grid, 0, 2 * SLOTS * len(given))
                place = _fill(given, sides, panels, p, own, grid, s, m, free[FREE], rule, sums, way)
                if place < 0:
                    return False
                grid[KEY, slot], grid[PLACE, slot], grid[PLACE_END, slot] = (
                    cell + 1,
                    free[FREE],
                    place,
                )
                free[FREE] = place
            place, until = int(grid[PLACE, slot]), int(grid[PLACE_END, slot])
            weigh_gaps(grid, place, until, gap, width)
            add_nodes(given, p, grid, place, until, out)
    return True
