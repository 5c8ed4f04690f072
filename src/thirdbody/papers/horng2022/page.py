"""The study as one page that needs nothing else: figures, ledger, totals, errata, parameters."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

from ...views.html import symbols, table
from ..ledger import Claim, Verdict, data_of, number
from ..page import document
from .claims import PAPER, claims, errata
from .readings import READINGS, Reading

if TYPE_CHECKING:
    from .record import Ledger

__all__ = ["page"]

SIGNS = {"pass": "✓", "fail": "✗", "not reproduced": "–"}
PRINTED = ["published", "window", "window_E2", "all_terms"]


def page(ledger: Ledger, drawn: Reading, figures: str) -> str:
    """The whole page; its figures are HTML."""
    paper = data_of(PAPER)["paper"]
    body = [
        "<h1>What can be reproduced of Horng et al. 2022</h1>",
        f"<p class=soft>{escape(paper['title'])}. {escape(paper['journal'])}, "
        f"doi:{escape(paper['doi'])}. Figures drawn with reading {drawn.key} "
        f"({escape(drawn.name)}).</p>",
        "<nav><a href='#totals'>Totals</a><a href='#figures'>Figures</a>"
        "<a href='#ledger'>Ledger</a><a href='#booking'>Particle area</a>"
        "<a href='#parameters'>Parameters</a><a href='#errata'>Errata</a>"
        "<a href='#definitions'>Definitions</a></nav>",
        _finding(ledger),
        _totals(ledger),
        "<h2 id=figures>Figures</h2><p>Numbers that the paper quotes are dotted or dashed lines, "
        "crosses, or tinted bands. A line may hide another: with 25 nm particles the curve is "
        "that of bare surfaces.</p>" + figures,
        _ledger(ledger),
        _booking(ledger),
        _parameters(),
        _errata(),
        _definitions(),
    ]
    return document("Horng et al. 2022: reproduction", body)


def _finding(ledger: Ledger) -> str:
    every, some = ledger.met_by(PRINTED)
    count = len(claims())
    best = max(READINGS, key=ledger.total)
    rough = ledger.total("series-rough")
    return (
        f"<p>The paper makes {count} statements that can be checked. No reading of it meets more "
        f"than {ledger.total(best)} of them (reading {READINGS[best].key}). The four readings of "
        f"the printed equations whose open parameters were adjusted meet {every} together and "
        f"{some} between them; the equations to the letter meet {ledger.total('literal')}.</p>"
        f"<p>The consistent model, with nothing adjusted, meets {rough}. That is a finding and "
        "not a defect to be tuned away. It puts 10<sup>11</sup> particles per square metre, each "
        "carrying what two indentations in series carry; they then hold the surfaces apart far "
        "above the loads at which the paper sees s-s contact. Both materials indent the steel at "
        "the hardness of the steel, and silica differs only by being elastically softer: it "
        "lets the surfaces come closer and leaves more area, where the paper says the opposite. "
        "And a real pressure 4.5 times that of bare surfaces would exceed the hardness.</p>"
    )


def _totals(ledger: Ledger) -> str:
    count = len(claims())
    rows = []
    for name, reading in READINGS.items():
        words = [verdict.word for verdict in ledger.verdicts[name].values()]
        passed = words.count("pass")
        rows.append(
            [
                f"<b>{reading.key}</b>",
                escape(name),
                symbols(reading.title),
                f"<td class=n>{passed}</td>",
                f"<td class=n>{words.count('fail')}</td>",
                f"<td class=n>{words.count('not reproduced')}</td>",
                f"<span class=bar style='width:{8 * passed / count:.2f}rem'></span>",
                symbols(reading.adjusted),
            ]
        )
    head = ["", "name", "reading", *(f"<th class=n>{w}</th>" for w in ("pass", "fail", "–"))]
    return (
        "<h2 id=totals>Totals per reading</h2>"
        f"<p>Of {count} statements. “–” counts statements about something that the reading does "
        "not have, such as a turning point; they are not met either.</p>"
        + table([*head, "", "adjusted to the paper"], rows)
    )


def _ledger(ledger: Ledger) -> str:
    rows = []
    for claim in claims():
        cells = [_verdict(ledger.verdicts[name][claim.id]) for name in READINGS]
        rows.append(
            [
                f"<td id='{claim.id}'><b>{claim.id}</b><br><span class=soft>{escape(claim.place)}"
                "</span>",
                _statement(claim, ledger),
                f"{symbols(claim.quantity)}",
                f"{symbols(claim.paper)}<br><span class=soft>{symbols(claim.rule_words)}</span>",
                *cells,
            ]
        )
    totals = [
        f"<td class=v><b>{ledger.total(name)} of {len(claims())}</b></td>" for name in READINGS
    ]
    rows.append(["<b>met</b>", "", "", "", *totals])
    head = ["claim", "statement", "measured", "paper, allowed", *(r.key for r in READINGS.values())]
    return (
        "<h2 id=ledger>Ledger</h2><p>✓ met, ✗ not met, – no such quantity in this reading. "
        "“Allowed” is the tolerance of the statement; none was adjusted to a result. Where a "
        "statement leaves open for which loads or which material it holds, the inputs in "
        "claims.json and the definitions below say what was taken. Open a row for the reasons in "
        "words.</p>" + table(head, rows, "ledger").replace("class=scroll", "class=ledger-box", 1)
    )


def _verdict(verdict: Verdict) -> str:
    kind = {"pass": "pass", "fail": "fail"}.get(verdict.word, "none")
    text = (
        verdict.measured.text.replace(" … ", "&nbsp;…<br>&nbsp;&nbsp;&nbsp;")
        if verdict.measured.exists
        else ""
    )
    return (
        f"<td class='v {kind}' title='{escape(verdict.why, quote=True)}'>"
        f"{SIGNS[verdict.word]}&nbsp;{text}</td>"
    )


def _statement(claim: Claim, ledger: Ledger) -> str:
    items = "".join(
        f"<li>{reading.key}: {verdict.word}: {symbols(verdict.why)}</li>"
        for name, reading in READINGS.items()
        for verdict in (ledger.verdicts[name][claim.id],)
    )
    text = symbols(claim.statement) + "."
    if claim.remark:
        text += f"<br><span class=soft>{symbols(claim.remark)}</span>"
    apart = [other for other in claim.conflicts if not ledger.can_meet_both(claim.id, other)]
    if apart:
        others = ", ".join(f"<a href='#{name}'>{name}</a>" for name in apart)
        text += f"<br><span class=soft>No reading meets it together with {others}.</span>"
    return f"{text}<details><summary>reasons</summary><ul>{items}</ul></details>"


def _booking(ledger: Ledger) -> str:
    rows = []
    for name in ledger.paper_booking:
        gained, lost = ledger.changed_by_booking(name)
        rows.append(
            [
                f"<b>{READINGS[name].key}</b> {escape(name)}",
                f"<td class=n>{ledger.total(name)}</td>",
                f"<td class=n>{ledger.total(name, paper_booking=True)}</td>",
                escape(", ".join(gained)),
                escape(", ".join(lost) or "none"),
            ]
        )
    head = ["reading", *(f"<th class=n>{w}</th>" for w in ("its own areas", "as the paper books"))]
    return (
        "<h2 id=booking>The area under particles</h2>"
        "<p>Under eqs. (1), (2) and (13) every loaded particle is plastic and its area is "
        "F<sub>sa</sub>/H<sub>s</sub>. In the consistent model most particles are still "
        "elastoplastic: their mean pressure is below the hardness, so the same load needs more "
        "area, and more with soft silica than with steel. Scoring the consistent readings with the "
        "paper's own booking shows how many statements hang on that alone.</p>"
        + table([*head, "then met as well", "no longer met"], rows)
    )


def _parameters() -> str:
    rows = []
    for reading in READINGS.values():
        rows.append(
            [
                f"<b>{reading.key}</b> {escape(reading.name)}",
                symbols(reading.law_words),
                f"<td class=n>{1e6 * reading.R:g}</td>",
                f"<td class=n>{reading.spread:.4g}</td>",
                f"<td class=n>{reading.cut:g}</td>",
                f"<td class=n>{number(reading.areal_density)}</td>",
                f"<td class=n>{reading.datum:g}</td>",
                f"<td class=n>{reading.F_star_scale:g}</td>",
            ]
        )
    units = ("R [µm]", "σ_a/x_a", "n", "η_a [1/m²]", "centre/σ", "F* scale/E_ss")
    head = ["reading", "particle law", *(f"<th class=n>{symbols(u)}</th>" for u in units)]
    return (
        "<h2 id=parameters>Parameters</h2><p>Common to all: both surfaces S45C (E = 205 GPa, "
        "ν = 0.29, H = 5 GPa); particles S45C or SiO₂ (68 GPa, 0.19, 7.7 GPa); ZMC asperities with "
        "k = 0.4 and ω<sub>2</sub> = 54 ω<sub>1</sub>; α = 5, ηRσ = 0.0455; sizes Gaussian, cut at "
        "n σ<sub>a</sub>. “Centre” is the mean asperity height in the coordinate of d.</p>"
        + table(head, rows)
    )


def _errata() -> str:
    rows = [
        [
            f"<td class=n>{one.erratum}</td>",
            *(symbols(text) for text in (one.where, one.printed, one.used, one.why, one.applied)),
        ]
        for one in errata()
    ]
    head = ["<th class=n>no.</th>", "where", "printed", "used", "because", "in readings"]
    return "<h2 id=errata>Errata applied</h2>" + table(head, rows)


def _definitions() -> str:
    words = data_of(PAPER)["definitions"]
    names = {
        "F_cr1": "F_cr1*",
        "F_cr2": "F_cr2*",
        "F_tpca": "F_tpca*",
        "turn": "return",
        "material": "material",
    }
    items = "".join(
        f"<li>{symbols(name)}: {symbols(words[key])}.</li>" for key, name in names.items()
    )
    low, high = data_of(PAPER)["load_range"]
    return (
        f"<h2 id=definitions>Definitions</h2><ul>{items}<li>Loads run from {number(low)} to "
        f"{number(high)} unless a statement names others; “growing” and “falling” are judged by "
        "the ratio of neighbours.</li></ul>"
    )
