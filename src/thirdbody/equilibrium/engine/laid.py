"""What is laid of a state, in rows of whole numbers: one for each part and level, one of all."""

from __future__ import annotations

COUNT, GRID, GRID_END, SIZED, SIZED_END, WHOLE, WHOLE_END, PIECE_BEGIN, PIECE_END, GAPS = range(10)
"""Of a part, a level: its panels; where nodes, sizes, what is whole and pieces begin and end. The
row after the last part is of the asperities."""
WAY, SLOT, TWIN, LAID = range(10, 14)
"""How a part is summed, the first slot of its cells, and the first part that is as squeezed."""
PIECES, BY_GAPS, BY_FRAGMENTS = range(3)
"""Ways: by pieces of the squeeze, over gaps, or by fragments under each gap."""
BASE, FREE, QUICK = SIZED, SIZED_END, WAY
"""In the row of the asperities: from where nodes are free for cells, where the next is, and whether
it is enough to say roughly what is carried far away."""
