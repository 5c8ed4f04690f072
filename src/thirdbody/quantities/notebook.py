"""What notebooks show of a value or a result: one table of symbols, values and words."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from typing import Any, NamedTuple

import numpy as np

from .say import value_of

__all__ = ["Row", "card", "words_of"]


class Row(NamedTuple):
    """One line of a table."""

    symbol: str
    values: Sequence[str]
    words: str = ""


def words_of(value: Any, unit: str = "") -> str:
    """A value for reading: a number with its unit, or a word."""
    if isinstance(value, (bool, np.bool_, str)) or value is None:
        return "-" if value is None or value == "" else str(value)
    if np.ndim(value):
        return f"{np.size(value)} values"
    return value_of(float(value), unit)


def card(title: str, rows: Iterable[Row], notes: Iterable[str] = ()) -> str:
    """A table with a title, and sentences below it; all text is escaped.

    A row without values is a heading.
    """
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
