"""The page of every asperity law."""

from __future__ import annotations

import inspect
from typing import Any

from ..analysis.compare import _usual
from ..laws.asperity import REGISTRY, AbstractAsperityLaw
from ..populations.materials import MaterialPair, materials
from ..quantities.say import number

__all__ = ["laws_page"]

# -------------------------------------------------------------------------- the page of laws
VALIDATED = {
    "gw": "Hertz; closed Gaussian and exponential sums",
    "jkr": "anchors: pull-off, ω = 0, ω = −¾X",
    "dmt": "Hertz less 2πwR",
    "ceb": "public code (form); closed exponential sum; 2·10⁷ random asperities, 1.8 std. errors",
    "elliptic-ceb": "Hertz's ellipse by quadrature; CEB at λ = 1",
    "coated": "flat-punch stiffness; Hertz for like materials; thick and thin limits",
    "zmc": "public code; 2·10⁷ random asperities, 1.4 std. errors",
    "ke": "public code (loads); closed exponential sum",
    "elliptic-zmc": "Hertz's ellipse by quadrature; ZMC at λ = 1",
    "jg": "two public codes",
    "field": "surfaces pressed point by point; the programme maximised on a grid",
    "hermite": "C¹, Hertz's slope at yield, H at the end",
}
"""What the shipped laws were held against, beside what all of them were."""


def laws_page() -> str:
    """The page docs/laws.md: every shipped law, described by its class.

    ``thirdbody laws --markdown`` prints it.

    Returns
    -------
    str
        Markdown.

    Examples
    --------
    >>> laws_page().splitlines()[0]
    '# Every law'
    """
    shipped = [law for law in REGISTRY.values() if law.__module__.startswith("thirdbody.")]
    heads = ("word", "law", "year", "what yields, and how", "range", "jumps")
    table = [
        [*heads, "provenance", "held against", "DOI"],
        ["---"] * (len(heads) + 3),
        *(_page_row(law) for law in sorted(shipped, key=lambda law: (law.year, law.name))),
    ]
    rows = ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in table]
    return "\n".join([_PAGE_HEAD, *rows, _PAGE_FOOT])


_PAGE_HEAD = """\
# Every law

What one asperity does when it is pressed by ω into a flat. The word goes into a study file
(`[asperity_law]`, `name = "ke"`), the class is in `thirdbody.asperity`. Which to take:
[choose a law](choose-a-law.md). To see what the choice does to your contact:
`thirdbody compare STUDY.toml`.
"""

_PAGE_FOOT = """
**Jumps** are those of load F, area A and stiffness S = dF/dω at ω/ω_1, where the formula changes;
ω_1 is the interference of first yield. They are in the published formulas and stay there: nothing
is smoothed in silence. Every law declares its jumps, and the tests hold what is declared against
what is computed. Where they depend on the materials they are for S45C steel on itself (ν = 0.29)
and R = 2.8 µm. Sums over many asperities do not jump.

**Provenance**: *seen* in a source, *derived* here, *recalled* without the source at hand,
*reconstructed* from a description.

**Held against**: beside what the table says, every law was held against a second implementation in
30 digits, on every branch and on both sides of each border (agreement 2e-15; 2e-8 at the very
point where a JKR contact parts), and its sums over Gaussian, exponential, Weibull and Johnson
heights against another quadrature (3e-12). That says that the formulas are computed as they stand.
Whether they describe your metal is for experiments to say.

This page is made from the laws themselves: `thirdbody laws --markdown > docs/laws.md`.
"""


def _page_row(law: type[Any]) -> list[str]:
    doi = f"[{law.doi}](https://doi.org/{law.doi})" if law.doi else "–"
    first = (inspect.getdoc(law) or "").splitlines()[0]
    return [
        f"`{law.name}`",
        law.title,
        str(law.year),
        first,
        law.valid_range,
        _jumps(_usual(law)),
        law.provenance,
        VALIDATED.get(law.name, "–"),
        doi,
    ]


def _jumps(law: AbstractAsperityLaw) -> str:
    """Where load, area or stiffness jump, and by how much."""
    steel = materials["S45C"]
    pair = MaterialPair(steel, steel)
    body: dict[str, Any] = dict(R=2.8e-6, E_star=pair.E_star, H=pair.H)
    law = law.bound(**body, nu=steel.nu)
    out = []
    w = getattr(law, "w", None)
    if w is not None and law.onset:
        touch = law.onset * float(law.yield_interference(**body)) * body["H"] / w
        out.append(f"at touch: F from 0 to {_signed_text(touch)} πwR")
    for y, jump in law.jumps.items():
        changes = [
            f"{symbol} {_signed_text(100 * step)} %"
            for symbol, step in zip("FAS", jump, strict=True)
            if abs(step) > 5e-5
        ]
        if changes:
            out.append(f"{number(y)}: {', '.join(changes)}")
    return "; ".join(out) if out else "none"


def _signed_text(value: float) -> str:
    return f"{'+' if value >= 0 else ''}{number(value, 3)}"
