"""Pages that need nothing else: style, tables, and figures inside the HTML."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterable
from html import escape

__all__ = ["document", "figures", "symbols", "table"]

STYLE = """
:root { --ink: #1c1c1c; --soft: #5b5b5b; --line: #d9d9d9; --pass: #dcefe6; --fail: #fbe3d6;
  --none: #eeeeee; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 92rem; padding: 1.5rem 1.25rem 4rem; color: var(--ink);
  background: #fff; font: 16px/1.5 system-ui, -apple-system, "Segoe UI", sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.25; margin: 0 0 .25rem; }
h2 { font-size: 1.25rem; margin: 2.5rem 0 .5rem; }
p { max-width: 48rem; margin: .5rem 0; }
nav { margin: 1rem 0; } nav a { margin-right: 1rem; }
a { color: #00517f; }
.soft, figcaption, .note { color: var(--soft); }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: .875rem; }
th, td { padding: .3rem .55rem; text-align: left; vertical-align: top;
  border-bottom: 1px solid var(--line); }
thead th { background: #f4f4f4; border-bottom: 2px solid #bbb; }
td.n, th.n { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
.bar { display: inline-block; height: .7rem; background: #0072B2; vertical-align: middle; }
.ledger td.v { font-variant-numeric: tabular-nums; overflow-wrap: normal; }
.pass { background: var(--pass); } .fail { background: var(--fail); }
.none { background: var(--none); }
.ledger { table-layout: fixed; width: 100%; min-width: 80rem; font-size: .78rem; }
.ledger b { white-space: nowrap; }
.ledger th:nth-child(1) { width: 5.4rem; }
.ledger th:nth-child(2) { width: 21rem; }
.ledger th:nth-child(3) { width: 11rem; }
.ledger th:nth-child(4) { width: 8rem; }
.ledger-box { max-height: 85vh; overflow: auto; border: 1px solid var(--line); }
.ledger thead th { position: sticky; top: 0; z-index: 1; }
details summary { cursor: pointer; color: var(--soft); font-size: .8rem; }
details ul { margin: .25rem 0 .25rem 1.1rem; padding: 0; font-size: .8rem; }
.figures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(34rem, 100%), 1fr));
  gap: 1.25rem; }
figure { margin: 0; } figure img { width: 100%; height: auto; border: 1px solid var(--line); }
figcaption { font-size: .85rem; }
@media print { .ledger-box { max-height: none; } }
"""


def document(title: str, body: Iterable[str]) -> str:
    """A whole HTML page."""
    return (
        "<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8>"
        "<meta name=viewport content='width=device-width, initial-scale=1'>"
        f"<title>{escape(title)}</title><style>{STYLE}</style></head>\n"
        f"<body>\n{chr(10).join(body)}\n</body></html>\n"
    )


def figures(images: Iterable[tuple[str, str, str, bytes]]) -> str:
    """Name, content, note and SVG of each figure, side by side."""
    shown = []
    for name, about, note, svg in images:
        data = base64.b64encode(svg).decode("ascii")
        shown.append(
            f"<figure id=fig{name}><img alt='Fig. {name}: {escape(about, quote=True)}' "
            f"src='data:image/svg+xml;base64,{data}'><figcaption>Fig. {name}: {escape(about)}. "
            f"{escape(note)}</figcaption></figure>"
        )
    return "<div class=figures>" + "\n".join(shown) + "</div>"


def symbols(text: str) -> str:
    """Escaped text with subscripts set: H_s, A_ss,t*, F_cr1*."""
    return re.sub(
        r"([A-Za-zσηωχφμ])_([A-Za-z0-9]+(?:,[tn](?![A-Za-z]))?)", r"\1<sub>\2</sub>", escape(text)
    )


def table(head: Iterable[str], rows: Iterable[Iterable[str]], kind: str = "") -> str:
    """Cells are HTML; one that begins with "<td" is taken as it stands."""
    top = "".join(cell if cell.startswith("<th") else f"<th>{cell}</th>" for cell in head)
    lines = [
        "<tr>" + "".join(c if c.startswith("<td") else f"<td>{c}</td>" for c in row) + "</tr>"
        for row in rows
    ]
    return (
        f"<div class=scroll><table{f' class={kind}' if kind else ''}><thead><tr>{top}</tr></thead>"
        f"<tbody>\n{chr(10).join(lines)}\n</tbody></table></div>"
    )
