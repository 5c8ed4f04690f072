"""Tables that heed the width they get: no number is broken, and what has no room is named."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from .say import join_words

__all__ = ["WIDER", "Table", "WordTable"]

WIDER = "a wider window shows more"
COMFORT = 12
"""Characters that a column of words keeps, be its words shorter."""


class WordTable(NamedTuple):
    """A table as it is read, wherever it is shown: on a screen, in a workbook, on a page."""

    heads: Sequence[str]
    rows: Sequence[Sequence[str]]
    means: Mapping[str, str]
    """What heads mean, of those that do not say it."""
    above: str = ""
    """The sentence that it follows."""


class Table:
    """A table to print by rich.

    Columns of numbers are never folded. Where the whole does not fit, first the gaps shrink and
    columns of words fold at spaces, then columns are left out, and a line says which.

    Parameters
    ----------
    heads : sequence of str
    right : bool, optional
        Columns stand at the right, except those of words.
    words : sequence of str, optional
        Heads of columns that may fold at spaces.
    drop : sequence of str, optional
        Heads of columns in the order in which they are left out; those not named go after these,
        from the last, and the first column stays.
    more : str, optional
        How to see what is left out.
    legend : mapping, optional
        What heads mean: told below, of the columns shown.
    wrap : bool, optional
        What does not fit goes on below, with the first column again; only columns of ``drop`` are
        left out.
    """

    def __init__(
        self,
        heads: Sequence[str],
        *,
        right: bool = False,
        words: Sequence[str] = (),
        drop: Sequence[str] = (),
        more: str = WIDER,
        legend: Mapping[str, str] | None = None,
        wrap: bool = False,
    ) -> None:
        self.heads, self.right, self.words = list(heads), right, set(words)
        self.drop, self.more, self.legend = list(drop), more, legend or {}
        self.wrap = wrap
        self.rows: list[tuple[str, ...]] = []

    def add_row(self, *cells: str) -> None:
        self.rows.append(cells)

    # ------------------------------------------------------------------ widths
    def _needs(self, i: int) -> tuple[int, int]:
        """The least width of a column and the width at which nothing folds."""
        from rich.cells import cell_len

        def widest(texts: list[str]) -> int:
            return max(map(cell_len, texts), default=0)

        head, cells = self.heads[i], [row[i] for row in self.rows]
        longest = widest([word for text in (head, *cells) for word in text.split()])
        whole = max(longest, widest(cells))
        if head not in self.words:
            return whole, max(whole, cell_len(head))
        whole = max(whole, cell_len(head))
        return max(longest, min(whole, COMFORT)), whole

    def _going(self) -> list[int]:
        """Columns in the order in which they are left out."""
        named = [self.heads.index(head) for head in self.drop if head in self.heads]
        return [*named, *(i for i in reversed(range(1, len(self.heads))) if i not in named)]

    def _columns_to_show(self, every: list[int], room: int) -> list[int]:
        """Columns that are shown side by side or below: without as many of ``drop`` as must go."""
        kept, going = every, [self.heads.index(head) for head in self.drop if head in self.heads]
        while going and len(kept) > 1 and self._fit_columns(kept, room)[0] != kept:
            gone = going.pop(0)
            kept = [i for i in kept if i != gone]
        return kept

    def _fit_columns(self, shown: list[int], room: int) -> tuple[list[int], list[int], int]:
        """Columns that fit the width, their widths, and the gap between them."""
        needs = {i: self._needs(i) for i in shown}
        going = [i for i in self._going() if i in shown]
        while True:
            for gap, which in ((3, 1), (3, 0), (2, 0)):  # 1: at which nothing folds
                if sum(needs[i][which] for i in shown) + gap * (len(shown) - 1) + 2 <= room:
                    return shown, self._widths([needs[i] for i in shown], room, gap), gap
            if not going:
                return shown, [max(room - 2, 1)], 2
            gone = going.pop(0)
            shown = [i for i in shown if i != gone]

    @staticmethod
    def _widths(needs: list[tuple[int, int]], room: int, gap: int) -> list[int]:
        """Widths that fill the room: the widest column gives way first."""
        widths = [whole for _, whole in needs]
        while sum(widths) + gap * (len(widths) - 1) + 2 > room:
            able = [i for i, (least, _) in enumerate(needs) if widths[i] > least]
            widths[max(able, key=lambda i: widths[i])] -= 1
        return widths

    # ------------------------------------------------------------------ on the screen
    def __rich_console__(self, console: object, options: Any) -> Any:
        every = list(range(len(self.heads)))
        kept = self._columns_to_show(every, options.max_width) if self.wrap else every
        shown, widths, gap = self._fit_columns(kept, options.max_width)
        yield self._draw_table(shown, widths, gap)
        while self.wrap and (rest := [i for i in kept if i not in shown]):
            now, widths, gap = self._fit_columns([kept[0], *rest], options.max_width)
            if len(now) == 1:
                break
            yield self._draw_table(now, widths, gap)
            shown += now[1:]
        shown_heads = [self.heads[i] for i in every if i in shown]
        if meanings := [
            f"{head}: {self.legend[head]}" for head in shown_heads if head in self.legend
        ]:
            yield "; ".join(meanings) + "."
        if gone := [self.heads[i] for i in every if i not in shown]:
            yield f"Not shown, because the window is too narrow: {join_words(gone)}; {self.more}."

    def _draw_table(self, shown: list[int], widths: list[int], gap: int) -> Any:
        from rich import box
        from rich.table import Table as Drawn

        padding = (0, 1) if gap == 3 else (0, 1, 0, 0)
        drawn = Drawn(box=box.SIMPLE_HEAD, pad_edge=False, padding=padding)
        for i, width in zip(shown, widths, strict=True):
            left = not self.right or self.heads[i] in self.words
            drawn.add_column(
                self.heads[i], justify="left" if left else "right", overflow="fold", width=width
            )
        for row in self.rows:
            drawn.add_row(*(row[i] for i in shown))
        return drawn
