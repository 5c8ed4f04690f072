"""The report as one page."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cached_property
from html import escape

from ...analysis.assessment import WORDS as ASSESSMENT_WORDS
from ...analysis.inputs import declared_quantity, words_of
from ...analysis.uncertainty.inputs import stated_ranges
from ...analysis.uncertainty.samples import LEAST, costly, enough
from ...contact.contact import Contact
from ...equilibrium.columns import about
from ...equilibrium.modes import FAINT
from ...equilibrium.words import unsolved_sentences
from ...quantities.say import join_words, signed_number, value_of
from ...study.toml import heading_of
from ...version import __version__
from .. import connector_words, nature_words, oil_words, plate_words, state_words
from ..assess_page import pictures as pictures_of
from ..html import document, figure, section, text_table, words
from .figures import figures_of
from .found import Found
from .sentences import answer_sentences, ranked_inputs, strongest_inputs
from .sources import bodies_by_label, inputs_and_sources, laws_and_reasons, works_cited
from .tables import (
    bearing_section,
    critical_section,
    explicit_section,
    film_section,
    life_section,
    oil_section,
    outputs_section,
    question_sections,
    states_table,
)

MOST_SAMPLES = 256
"""Samples of the error bars; `assess` takes what the study asks for."""


def most_samples(contact: Contact, vary: Iterable[str]) -> int:
    """Largest number of samples of a report; small where each sample needs tables."""
    return LEAST if costly(contact, vary) else MOST_SAMPLES


UNTITLED = "Contact of rough surfaces"
"""Title of the page where a study has none."""
STYLE = """
.lead p{font-size:1.05rem;max-width:52rem}.warning{border-left:.25rem solid #D55E00;
padding:.1rem .8rem;margin:.8rem 0}
.default{color:var(--soft);font-style:italic}
pre{font-size:.8rem;background:var(--head);padding:.6rem .8rem;white-space:pre-wrap}
@media print{.warning{break-inside:avoid}.lead p{font-size:1rem;max-width:none}
header{border:solid var(--rule);border-width:1.5pt 0 .5pt;padding:.5rem 0 .3rem}
pre{font-size:6.8pt;line-height:1.3;padding:.4rem .6rem}}
"""


def running(title: str) -> str:
    """The style that puts a title below every printed page."""
    plain = re.sub(r"[^\w .,;:()/-]", lambda m: f"\\{ord(m[0]):x} ", title)
    box = f'@bottom-left{{content:"{plain}";font:8pt sans-serif;color:#555}}'
    return f"@media print{{@page{{{box}}}}}\n"


class Report(Found):
    """What a study found, ready to be written down.

    Attributes
    ----------
    study : Study
    result : StudyResult
        What `run_study` gives.
    curve : Equilibrium
        The states that are drawn, over the loads of the study and what is near them.
    assessment : Assessment or None
        Error bars at one load; None where nothing is known to be uncertain.
    slopes : Sensitivity or None
        Elasticities at that load.
    at : int
        Number of that state.
    file : str
        The study file.
    film : FilmResult or None
        What `run_film` gives, where the study has a table [film].
    pressed : OneSurface, str or None
        One small surface pressed point by point, where the study has a table [explicit]; or why
        it could not be.
    oil, oil_filtered : DirtyOil or None
        What the particles of the oil do, before and after a filter.
    life : LifeResult, DryResult or None
        The oil, or the dry contact, over time.
    connector : ConnectorResult or None
        How often dust keeps a connector open, where the study asks.
    plate : PlateResult or None
        How high a plate stands over particles on its chuck, where the study asks.
    """

    def sentences(self) -> tuple[str, ...]:
        """The answer; where the study has a film, first what it says with the oil."""
        return answer_sentences(self)

    @property
    def heading(self) -> str:
        """The title, and what was set over the file."""
        return heading_of(self.study.title or UNTITLED, self.study.settings)

    @cached_property
    def lead(self) -> list[str]:
        """What the study asks, in a few sentences, and what moves it most."""
        return _lead(self)

    def html(self) -> str:
        """The page as one file: figures inside, nothing loaded, no date: same bytes again."""
        title = self.heading
        parts = [
            f"<header><h1>{escape(title)}</h1>",
            f"<p class=soft>Report of thirdbody {escape(__version__)}.</p></header>",
            section(
                "The answer", [f"<p>{words(sentence)}</p>" for sentence in self.lead], name="answer"
            ).replace("<section", "<section class=lead", 1),
            *question_sections(self),
            *oil_section(self),
            *bearing_section(self),
            *life_section(self),
            section("In full", _in_full(self), name="in-full"),
            *_warnings(self),
            *film_section(self),
            section(f"Figures{self.dry}", figures_of(self), name="figures"),
            section(f"States{self.dry}", states_table(self), name="states"),
            *explicit_section(self),
            *critical_section(self),
            *outputs_section(self),
            section(f"Error bars{self.dry}", _error_bars(self), name="errors"),
            section(f"Which inputs matter{self.dry}", _slopes(self), name="inputs-that-matter"),
            section("Inputs and their sources", inputs_and_sources(self), name="inputs"),
            section("Which laws, and why", laws_and_reasons(self), name="laws"),
            section("To be cited", works_cited(self), name="citations"),
        ]
        if self.file:
            use = "<p class=lead-in>With thirdbody, this file gives the same report again.</p>"
            text = f"<pre>{escape(self.file)}</pre>"
            parts.append(section("The study file", [use, text], name="study"))
        return document(title, parts, style=STYLE + running(title))


def _lead(report: Found) -> list[str]:
    """What the study asks, in a few sentences, and what moves it most."""
    sentences = []
    if report.connector is not None:
        sentences += connector_words.answer(report.connector)
        sentences += connector_words.uncertainty(report.connector)
    if report.plate is not None:
        sentences += [*plate_words.answer(report.plate), *plate_words.uncertainty(report.plate)]
    if sentences:
        return sentences
    if report.oil is None:
        return [*state_words.answer(report.result), *state_words.uncertainty(report.result)]
    before_after = []
    if report.oil_filtered is not None:
        before_after = [oil_words.filter_answer(report.oil, report.oil_filtered)]
    last = oil_words.uncertainty(report.oil_what_ifs)
    return [*before_after, *oil_words.answer(report.oil), *last]


def _in_full(report: Found) -> list[str]:
    natures = nature_words.sentences(report.result.natures)
    sentences = (*natures, *report.result.force_sentences, *answer_sentences(report))
    return [f"<p>{words(sentence)}</p>" for sentence in sentences]


def _warnings(report: Found) -> list[str]:
    others = [
        result for result in (report.connector, report.plate, report.film) if result is not None
    ]
    texts = [text for result in others for text in result.run_warnings]
    texts += [*report.study.notes, *report.result.run_warnings]  # parts say what leaves oil out
    texts = [*dict.fromkeys(texts), *unsolved_sentences(report.result.states.status)]
    if not texts:
        return []
    items = "".join(f"<li>{words(text)}</li>" for text in texts)
    return [f"<div class=warning><p><b>Warnings</b></p><ul>{items}</ul></div>"]


def _error_bars(report: Found) -> list[str]:
    return [*_of_solids_alone(report), *_bars(report)]


def _of_solids_alone(report: Found) -> list[str]:
    """What error bars are of where the study has a film."""
    if report.film is None:
        return []
    sentence = (
        "These are of the solids alone, pressed together without the oil: how sure the film, its "
        "dents and its life are, they do not say"
    )
    more = f", but the table “{oil_words.HANGS_ON}” does" if report.oil_what_ifs else ""
    return [f"<p>{words(sentence + more)}.</p>"]


def _bars(report: Found) -> list[str]:
    assessment = report.assessment
    if assessment is None:
        if not report.result.states.F_star[report.at] >= FAINT:
            return ["<p>There are none: nothing presses the surfaces together.</p>"]
        bare = report.contact.replace(outputs=())  # as it is assessed
        if report.study.uncertainty is None and stated_ranges(bare):
            return [
                "<p>There are none: with particles that break every sample takes a second, so "
                "that bands are drawn only where a table [uncertainty] asks for them.</p>"
            ]
        names = [body.name or label for label, body in bodies_by_label(report.bodies())]
        return [
            "<p>There are none: the study has no table [uncertainty] that says something of "
            "this contact, and the materials library states no ranges for "
            f"{escape(join_words(list(dict.fromkeys(names))))}. Every input counts as exactly "
            "known.</p>"
        ]
    uncertainty = report.study.uncertainty
    whence = (
        "The ranges are those of the table [uncertainty]."
        if uncertainty is not None
        else "The study has no table [uncertainty]: the ranges are those that the materials "
        "library states, and nothing else counts as uncertain."
    )
    most = most_samples(report.study.contact, uncertainty.inputs) if uncertainty else MOST_SAMPLES
    if uncertainty and enough(report.study.contact, uncertainty.samples, uncertainty.inputs) > most:
        whence += f" {most} samples stand here; `thirdbody assess` takes "
        whence += "all." if most == MOST_SAMPLES else "more: each takes tables of its own."
    out = [f"<p>{words(assessment.headline())} {words(whence)}</p>"]
    for chapter in assessment.sections()[1:]:
        out.append(f"<h3>{escape(chapter.title)}</h3>")
        if chapter.rows:
            out.append(text_table(chapter.head, chapter.rows, ASSESSMENT_WORDS))
        out += [f"<p>{words(sentence)}</p>" for sentence in chapter.sentences]
    pictures = "\n".join(figure(svg, caption) for caption, svg in pictures_of(assessment))
    return [*out, f"<div class=figures>{pictures}</div>"]


def _slopes(report: Found) -> list[str]:
    of, order = ranked_inputs(report)
    if report.slopes is None or not order:
        reason = "Derivatives could not be formed for this contact."
        if not report.result.states.A_t[report.at]:
            reason = "There is no contact, so that nothing answers to the inputs."
        return [f"<p>{reason}</p>"]
    others = [name for name in report.slopes.elasticity if name != of]
    rows = []
    for label in order[:10]:
        value = report.slopes.inputs[label]
        unit = {"F_star": "1", "pressure": "Pa", "d": "m"}.get(label)
        unit = unit or declared_quantity(report.contact, label.split("+")[0])["unit"]
        elasticities = (float(report.slopes.elasticity[name][label]) for name in (of, *others))
        slopes = (signed_number(slope, 3) for slope in elasticities)
        rows.append([words_of(report.contact, label), value_of(float(value), unit), *slopes])
    sentence = (
        f"At {report.load(report.at)}, {strongest_inputs(report, of, order)}. The numbers tell by "
        "how many per cent a result changes when an input grows by one per cent, all others held, "
        "however well the input is known."
    )
    more = f"<p class=soft>{len(rows)} of {len(order)} inputs.</p>" * (len(order) > len(rows))
    head = ["input", "value", *(about(name).meaning for name in (of, *others))]
    slope_table = text_table(head, rows, ASSESSMENT_WORDS)
    return [f"<p class=lead-in>{words(sentence)}</p>", slope_table, more]
