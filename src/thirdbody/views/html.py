"""Pages that need nothing else: one style for screen and paper, tables, figures inside."""

from __future__ import annotations

import base64
import io
import re
from collections.abc import Collection, Iterable
from html import escape
from pathlib import Path
from typing import Any

from ..quantities.say import UNITS, powers

__all__ = [
    "breaking",
    "document",
    "figure",
    "is_page",
    "section",
    "svg_of",
    "symbols",
    "table",
    "text_table",
    "words",
]

STYLE = """
:root{color-scheme:light dark;--ink:#1c1c1c;--paper:#fff;--soft:#555;--line:#ddd;--rule:#999;
--head:#f4f4f4;--link:#00517f}
@media screen and (prefers-color-scheme:dark){
:root{--ink:#e6e6e6;--paper:#16181b;--soft:#b4b4b4;--line:#3a3d41;--rule:#777;
--head:#24272b;--link:#7cc0ef}}
*{box-sizing:border-box}
body{font:15px/1.45 system-ui,-apple-system,"Segoe UI",sans-serif;color:var(--ink);
background:var(--paper);max-width:60rem;margin:0 auto;padding:1.5rem 1rem 3rem;
overflow-wrap:anywhere}
h1{font-size:1.5rem;line-height:1.25;margin:0 0 .25rem}
h2{font-size:1.1rem;border-bottom:1px solid var(--rule);margin:1.6rem 0 .5rem}
h3{font-size:.95rem;margin:1rem 0 .3rem}
p{margin:.4rem 0;max-width:48rem}a{color:var(--link)}
.soft,figcaption,.note{color:var(--soft)}
.scroll{overflow-x:auto}
table{border-collapse:collapse;font-size:.86rem;margin:.5rem 0}
th,td{padding:.22rem .55rem;text-align:left;vertical-align:top;border-bottom:1px solid var(--line)}
thead th{background:var(--head);border-bottom:2px solid var(--rule);vertical-align:bottom}
table{overflow-wrap:normal}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums}td.n{white-space:nowrap}
td.words{min-width:9rem}
figure{margin:.8rem 0;text-align:center}
figure img{max-width:100%;width:32rem;height:auto;background:#fff;border-radius:.3rem}
figcaption{font-size:.82rem}
.figures{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(25rem,100%),1fr));gap:1rem}
.figures figure{margin:0}.figures img{width:100%}
@media print{html{font-size:9.5pt}body{margin:0;padding:0;max-width:none;font-size:9.5pt}
h1,h2,h3,.lead-in{break-after:avoid}
.lead-in{break-inside:avoid}.scroll+.soft{break-before:avoid}
h2{margin:.9rem 0 .3rem}p{max-width:none;orphans:3;widows:3}
figure,tr,li{break-inside:avoid}thead{display:table-header-group}
.scroll{overflow:visible;break-inside:avoid}.scroll.long{break-inside:auto}
pre{orphans:6;widows:6}
table{font-size:7.5pt}th,td{padding:.1rem .35rem}td.words{min-width:0}
figure img{width:11cm}
.figures{grid-template-columns:1fr 1fr;gap:.5rem}
.figures img{width:auto;max-width:100%;max-height:5.2cm}
.figures.tall{grid-template-columns:1fr}.figures.tall img{max-height:12cm}
.figures figure:last-child:nth-child(odd){grid-column:1/-1}
@page{size:A4;margin:15mm 15mm 17mm;
@bottom-right{content:counter(page) " / " counter(pages);font:8pt sans-serif;color:#555}}}
"""
"""Every colour is a variable that the dark scheme sets anew; paper is always light."""


LONG = 15
"""Rows beyond which a table may be continued on the next page."""


def is_page(file: Path) -> bool:
    """Whether a file is a page that `document` made."""
    try:
        with file.open(encoding="utf-8") as page:
            return "<style>" + STYLE[:40] in page.read(4000)
    except (OSError, ValueError):
        return False


def document(title: str, body: Iterable[str], *, style: str = "") -> str:
    """A whole HTML page.

    Parameters
    ----------
    title : str
        Plain text, in the title bar.
    body : iterable of str
        HTML, top to bottom.
    style : str, optional
        What this page has beside the common style.
    """
    lines = "\n".join(body)
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(title)}</title>\n<style>{STYLE}{style}</style></head>\n"
        f"<body>\n{lines}\n</body></html>\n"
    )


def section(title: str, parts: Iterable[str], *, name: str = "") -> str:
    """A heading and what stands below it (HTML)."""
    anchor = f' id="{escape(name)}"' if name else ""
    lines = "\n".join(parts)
    return f"<section{anchor}><h2>{escape(title)}</h2>\n{lines}\n</section>"


def svg_of(drawing: Any) -> bytes:
    """A matplotlib figure as SVG, the same bytes every time."""
    from matplotlib import rc_context

    from .figure_files import save_figure

    out = io.BytesIO()
    with rc_context({"svg.hashsalt": "thirdbody", "svg.fonttype": "path"}):
        save_figure(drawing, out, "svg", metadata={"Date": None, "Creator": None})
    return out.getvalue()


def figure(svg: bytes, caption: str, *, about: str | None = None, name: str = "") -> str:
    """An SVG inside the page, with its caption (plain text).

    Parameters
    ----------
    svg : bytes
    caption : str
        Below the picture.
    about : str, optional
        For who cannot see it; the caption when left out.
    name : str, optional
        Where a link leads.
    """
    data = base64.b64encode(svg).decode("ascii")
    anchor = f' id="{escape(name)}"' if name else ""
    plain = escape(caption if about is None else about, quote=True)
    return (
        f"<figure{anchor}><img alt=\"{plain}\" src='data:image/svg+xml;base64,{data}'>"
        f"<figcaption>{words(caption)}</figcaption></figure>"
    )


def symbols(text: str) -> str:
    """Escaped text with subscripts set: H_s, A_ss,t*, δ_max,1; dotted names stay as they are."""
    return re.sub(
        r"(?<![A-Za-z_.])([A-Za-zΑ-Ωα-ω])_([A-Za-zΑ-Ωα-ω0-9]+(?:,[A-Za-zα-ω0-9]+(?!\w))?)",
        r"\1<sub>\2</sub>",
        escape(text),
    )


def words(text: str) -> str:
    """Plain text as a page shows it: subscripts, powers of ten, units; 1.2e-05 is 1.2×10⁻⁵."""
    for plain, set_ in UNITS.items():
        text = re.sub(rf"(?<=\d ){re.escape(plain)}(?![\w^/*])", set_, text)
    return symbols(powers(text))


def breaking(name: str) -> str:
    """A dotted name that may break at its dots (HTML)."""
    return re.sub(r"(?<=[a-z0-9])([.+])(?=[a-z])", r"\1<wbr>", name)


def table(head: Iterable[str], rows: Iterable[Iterable[str]], kind: str = "") -> str:
    """A table that scrolls by itself; cells are HTML, and one that begins with "<td" is whole."""
    top = "".join(cell if cell.startswith("<th") else f"<th>{cell}</th>" for cell in head)
    lines = "\n".join(
        "<tr>" + "".join(c if c.startswith("<td") else f"<td>{c}</td>" for c in row) + "</tr>"
        for row in rows
    )
    about = ' class="scroll long"' if lines.count("<tr>") > LONG else " class=scroll"
    named = f" class={kind}" if kind else ""
    return (
        f"<div{about}><table{named}><thead><tr>{top}</tr></thead>"
        f"<tbody>\n{lines}\n</tbody></table></div>"
    )


def text_table(
    head: Iterable[str], rows: Iterable[Iterable[str]], reads: Collection[str] = ()
) -> str:
    """A table of plain text: the first column and those headed ``reads`` read, the others count."""
    heads = list(head)
    kinds = ["", *(" class=words" if text in reads else " class=n" for text in heads[1:])]

    def cells(tag: str, row: Iterable[str]) -> list[str]:
        pairs = zip(row, kinds, strict=True)
        return [f"<{tag}{kind}>{breaking(words(text))}</{tag}>" for text, kind in pairs]

    return table(cells("th", heads), [cells("td", row) for row in rows])
