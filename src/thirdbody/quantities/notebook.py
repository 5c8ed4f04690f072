"""What notebooks show of a value or a result: one table of symbols, values and words."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from html import escape
from typing import Any, NamedTuple

from .say import value_of

__all__ = ["Card", "Row", "Shown", "words_of"]


class Row(NamedTuple):
    """One line of a table."""

    symbol: str
    values: Sequence[str]
    words: str = ""


def words_of(value: Any, unit: str = "") -> str:
    """A value for reading: a number with its unit, or a word."""
    import numpy as np  # needed by no command that shows nothing in a notebook

    if isinstance(value, (bool, np.bool_, str)) or value is None:
        return "-" if value is None or value == "" else str(value)
    if np.ndim(value):
        return f"{np.size(value)} values"
    return value_of(float(value), unit)


class Card(NamedTuple):
    """A table with a title, and sentences below it; a row without values is a heading."""

    title: str
    rows: Iterable[Row]
    notes: Iterable[str] = ()


class Shown:
    """What a notebook shows as tables: a subclass says which cards."""

    __slots__ = ()

    def _cards(self) -> Iterator[Card]:
        """The tables, from top to bottom."""
        raise NotImplementedError

    def _repr_html_(self) -> str:
        """Every card; several in a block of their own."""
        texts = [_html(*card) for card in self._cards()]
        return texts[0] if len(texts) == 1 else f"<div>{''.join(texts)}</div>"


def _html(title: str, rows: Iterable[Row], notes: Iterable[str]) -> str:
    """A card, all text escaped."""
    lines = list(rows)
    width = max((len(row.values) for row in lines), default=1)
    out = [f"<div><strong>{escape(title)}</strong>", "<table>"]
    for symbol, values, words in lines:
        if not values:
            out.append(
                f'<tr><th colspan="{width + 2}" style="text-align:left">{escape(symbol)}'
                f"{escape(words and f': {words}')}</th></tr>"
            )
            continue
        cells = "".join(f"<td>{escape(value)}</td>" for value in values)
        out.append(
            f'<tr><td style="text-align:left">{escape(symbol)}</td>{cells}'
            f'<td style="text-align:left">{escape(words)}</td></tr>'
        )
    out.append("</table>")
    out += [f"<p>{escape(note)}</p>" for note in notes]
    return "".join([*out, "</div>"])
