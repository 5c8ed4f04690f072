"""The page of a reproduced paper: its ledger beside what every page has."""

from __future__ import annotations

from collections.abc import Iterable

from ..views import html
from ..views.html import symbols, table

__all__ = ["document", "figures", "symbols", "table"]

STYLE = """
:root{--pass:#dcefe6;--fail:#fbe3d6;--none:#eee}
@media screen and (prefers-color-scheme:dark){:root{--pass:#1d4030;--fail:#55301c;--none:#2b2e32}}
body{max-width:92rem}
nav{margin:1rem 0}nav a{margin-right:1rem}
.bar{display:inline-block;height:.7rem;background:#0072B2;vertical-align:middle}
.pass{background:var(--pass)}.fail{background:var(--fail)}.none{background:var(--none)}
.ledger{table-layout:fixed;width:100%;min-width:72rem;font-size:.78rem}
.ledger td.v{font-variant-numeric:tabular-nums;overflow-wrap:normal}
.ledger b{white-space:nowrap}
.ledger th:nth-child(1){width:5.4rem}.ledger th:nth-child(2){width:21rem}
.ledger th:nth-child(3){width:11rem}.ledger th:nth-child(4){width:8rem}
.ledger-box{max-height:85vh;overflow:auto;border:1px solid var(--line)}
.ledger thead th{position:sticky;top:0;z-index:1}
details summary{cursor:pointer;color:var(--soft);font-size:.8rem}
details ul{margin:.25rem 0 .25rem 1.1rem;padding:0;font-size:.8rem}
.figures{grid-template-columns:repeat(auto-fill,minmax(min(34rem,100%),1fr))}
.figures figure{text-align:left}
@media print{.ledger-box{max-height:none}}
"""


def document(title: str, body: Iterable[str]) -> str:
    """A whole HTML page."""
    return html.document(title, body, style=STYLE)


def figures(images: Iterable[tuple[str, str, str, bytes]]) -> str:
    """Name, content, note and SVG of each figure, side by side."""
    shown = [
        html.figure(
            svg, f"Fig. {name}: {about}. {note}", about=f"Fig. {name}: {about}", name=f"fig{name}"
        )
        for name, about, note, svg in images
    ]
    return "<div class=figures>" + "\n".join(shown) + "</div>"
