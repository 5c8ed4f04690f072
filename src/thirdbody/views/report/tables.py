"""The tables of a report: states, critical loads, outputs, the oil film."""

from __future__ import annotations

from collections.abc import Collection
from html import escape
from typing import Any

import numpy as np

from ...equilibrium.columns import about
from ...equilibrium.words import (
    MOST_MEET_NONE,
    RARE,
    critical_load,
    critical_name,
    happens,
    is_rare,
)
from ...quantities.say import NOT_KNOWN, percent, plural, unit_of, value_of
from ...quantities.tables import WordTable
from ..explicit_words import comparison_table, headline
from ..html import figure, section, svg_of, symbols, table, text_table, words
from .found import Found, some_of

MOST_ROWS, MOST_COLUMNS = 20, 5
"""States in the table of states, and in that of the outputs."""

FEW_TIMES = 8
"""Times in the table of an oil over time."""

CRITICAL_HEADS = ("critical load", "F*", "pressure", "status", "what happens there")

STATES = ("F_star", "pressure", "h", "d_star", "A_t", "A_ss")

SHARED = ("A_sa", "particle_load_share", "particle_area_share", "mode")
"""Columns of the table of states, and those that particles add."""


def _with_legend(shown: WordTable, reads: Collection[str] = ()) -> list[str]:
    """A table with the meaning of its heads below (HTML); columns ``reads`` are of words."""
    means = shown.means
    legend = "; ".join(f"{head}: {means[head]}" for head in shown.heads if head in means)
    return [text_table(shown.heads, shown.rows, reads), f"<p class=soft>{words(legend)}.</p>"]


def states_table(report: Found) -> list[str]:
    names = list(STATES if report.contact.two_body else (*STATES, *SHARED))
    total = len(report.result.states.status)
    rows = [[_cell(report, name, i) for name in names] for i in some_of(total, MOST_ROWS)]
    head = [f"<th class=n>{symbols(about(name).symbol)}</th>" for name in names]
    cells = [[f"<td class=n>{words(cell)}</td>" for cell in row] for row in rows]
    meanings = "; ".join(f"{about(name).symbol}: {about(name).meaning}" for name in names)
    out = [table(head, cells), f"<p class=soft>{symbols(meanings)}.</p>"]
    if any(RARE in row for row in rows):
        out.append(f"<p class=soft>{RARE}: {MOST_MEET_NONE}.</p>")
    if total > MOST_ROWS:
        out.append(f"<p>{MOST_ROWS} of {plural(total, 'state')}, evenly spread.</p>")
    if report.result.states.populations:
        out += ["<h3>What each population carries</h3>", _populations(report, total)]
    return out


def _cell(report: Found, name: str, i: int) -> str:
    """A number of a state; a mode as far as the contact itself has one."""
    value = getattr(report.result.states, name)[i]
    if name == "mode" and is_rare(value, report.result.particles_in(i)):
        return RARE
    return column_value(name, value)


def _populations(report: Found, total: int) -> str:
    states = report.result.states
    parts = states.populations
    head = [
        "pressure",
        *(f"{population.name}: {of}" for population in parts for of in ("load", "area")),
    ]
    rows = [
        [
            value_of(states.pressure[i], "Pa"),
            *(
                percent(x[i])
                for population in parts
                for x in (population.load_share, population.area_share)
            ),
        ]
        for i in some_of(total, MOST_ROWS)
    ]
    return text_table(head, rows)


def critical_section(report: Found) -> list[str]:
    if report.contact.two_body:
        return []
    rows = []
    for name, entry in report.result.transitions.entries().items():
        Es = (None, report.contact.E_ss)
        loads = (critical_load(entry.value, entry.status, E_ss) for E_ss in Es)
        rows.append([critical_name(name), *loads, entry.status, happens(name)])
    text = text_table(CRITICAL_HEADS, rows, CRITICAL_HEADS[3:])
    return [section(f"Critical loads{report.dry}", [text], name="critical")]


def outputs_section(report: Found) -> list[str]:
    outputs = report.contact.outputs
    if not outputs:
        return []
    states = report.result.states
    which = some_of(len(states.status), MOST_COLUMNS)
    loads = [value_of(states.pressure[i], "Pa") for i in which]
    head = ["", "symbol", "unit", *(f"<th class=n>{words(load)}</th>" for load in loads)]
    out = []
    for output in outputs:
        rows = []
        for name, (symbol, unit, meaning) in output.columns.items():
            prefixed = unit in ("m", "Pa")
            shown, column = unit if prefixed else "1", states.outputs[name]
            values = (value_of(column[i], shown) for i in which)
            rows.append(
                [
                    f"<td class=words>{words(meaning)}</td>",
                    symbols(symbol),
                    "" if prefixed else unit_of(unit),
                    *(f"<td class=n>{words(value)}</td>" for value in values),
                ]
            )
        out += [f"<h3>{escape(output.title)}</h3>", table(head, rows)]
    return [section("What else the contact does", out, name="outputs")]


def question_sections(report: Found) -> list[str]:
    """Sections on what a connector or a plate on its chuck was asked."""
    from .. import connector_words, plate_words

    out = []
    if (plug := report.connector) is not None:
        rows, means = connector_words.rows(plug), connector_words.MEANS
        table_of = _with_legend(WordTable(connector_words.HEADS, rows, means))
        out.append(section("How often dust keeps it open", table_of, name="connector"))
    if (plate := report.plate) is not None:
        heads, rows = plate_words.heads(plate), plate_words.rows(plate)
        table_of = _with_legend(WordTable(heads, rows, plate_words.MEANS))
        out.append(section("How high the plate stands", table_of, name="plate"))
    return out


def oil_section(report: Found) -> list[str]:
    """Section on the populations of the oil, before and after a filter, and what they hang on."""
    from .. import oil_words

    out: list[str] = []
    if report.oil is not None and report.oil_filtered is not None:
        rows = oil_words.filter_rows(report.oil, report.oil_filtered)
        out.append(text_table(("", "before", "after the filter"), rows))
    elif report.oil is not None:
        rows = oil_words.rows(report.oil)
        out += _with_legend(WordTable(oil_words.HEADS, rows, oil_words.MEANS))
    if report.oil_what_ifs:
        rows = oil_words.what_if_rows(report.oil_what_ifs)
        out.append(f"<h3>{escape(oil_words.HANGS_ON)}</h3>")
        heads = oil_words.WHAT_IF_HEADS
        out += _with_legend(WordTable(heads, rows, oil_words.WHAT_IF_MEANS), heads[1:2])
    return [section("What the oil carries", out, name="oil")] if out else []


def bearing_section(report: Found) -> list[str]:
    """Section on how the bodies of a bearing share its load; its dimensions are with the inputs."""
    from .. import bearing_words

    study = report.study
    if not bearing_words.shares_load(study):
        return []
    rows = bearing_words.rows(study)
    table_of = _with_legend(WordTable(bearing_words.HEADS, rows, bearing_words.MEANS))
    lead = f"<p>{words(bearing_words.sharing(study))}</p>"
    where = (
        '<p class=soft>Its dimensions and its load are <a href="#inputs">with the inputs</a>.</p>'
    )
    return [section("The bearing", [lead, *table_of, where], name="bearing")]


def life_section(report: Found) -> list[str]:
    """The oil or dry contact over time: what it comes to, a few times, flows, what happened."""
    from ...study.run_dry import DryResult
    from .. import life_dry_words, life_words
    from ..life_dents_words import tables_of_dents
    from ..plot.life import life

    result = report.life
    if result is None:
        return []
    dry = isinstance(result, DryResult)
    words_module: Any = life_dry_words if dry else life_words
    of, shown = ("contact", "Wear and particles") if dry else ("oil", "Code and counts")
    every = words_module.rows(result)
    said = [*words_module.answer(result), *words_module.last_words(result)]
    rows = [every[i] for i in some_of(len(every), FEW_TIMES)]
    caption = f"{shown} over time, masses since the beginning, and where the dirt went."
    out = [
        *(f"<p>{words(sentence)}</p>" for sentence in said),
        *_with_legend(WordTable(words_module.HEADS, rows, words_module.MEANS)),
    ]
    by_oil = None if isinstance(result, DryResult) else result.dents
    for dent_table in tables_of_dents(by_oil):
        out += [f"<p>{words(dent_table.above)}</p>", *_with_legend(dent_table)]
    out.append(f"<div class=figures>{figure(svg_of(life(result.history)), caption)}</div>")
    return [section(f"The {of} over time", out, name="life")]


def film_section(report: Found) -> list[str]:
    """The lubricated contact: in words, over speed, and at a few speeds."""
    if report.film is None:
        return []
    from ..film_figure import draw_film
    from ..film_words import bodies, point, summary

    states, oil = report.film.states, report.film.conditions.oil
    total = len(states["speed"])
    lead = f"A {bodies(report.film)}, in oil of {value_of(oil.eta, 'Pa s')}. "
    pressed = "the load of the study" if report.study.own_load else "this Hertz pressure"
    lead += f"What follows after this section leaves the oil out, under {pressed}."
    out = [f"<p>{words(text)}</p>" for text in (lead, *summary(report.film))]
    slow = any(population.strength is not None for population in report.contact.populations)
    if total > 1 or not slow:  # around one speed dozens of others are solved
        drawn = svg_of(draw_film(report.film))
        friction = "Friction, load" if np.any(np.isfinite(states["mu"])) else "Load"
        caption = f"{friction} shares and film thickness over speed; grey: the regimes."
        caption += " Dotted: the speed of the study." if total == 1 else ""
        out.append(f'<div class="figures tall">{figure(drawn, caption)}</div>')
    which = some_of(total, MOST_COLUMNS)
    columns = [point(report.film, i) for i in which]
    head = ["at a speed of", *(value_of(states["speed"][i], "m/s") for i in which)]
    rows = [[name, *(column[name] for column in columns)] for name in columns[0]]
    return [section("The oil film", [*out, text_table(head, rows)], name="film")]


def explicit_section(report: Found) -> list[str]:
    """One small surface, every particle at its place, beside the states of the study."""
    surface = report.pressed
    if surface is None:
        return []
    if isinstance(surface, str):
        text = f"<p>{words(f'The surface of the study could not be pressed: {surface}.')}</p>"
        return [section("Point by point", [text], name="explicit")]
    from ..plot.explicit import explicit

    head, rows = comparison_table(surface)
    last = len(rows) - 1
    sentences = [headline(surface, last), *surface.warnings]
    out = [f"<p>{words(text)}</p>" for text in sentences]
    caption = (
        f"At F* = {rows[last][0]}: (a) contact pressure, with the particles that carry in true "
        "size; (b) gap; (c) section through the particle that carries most; (d) parts of the "
        "load on single particles."
    )
    drawn = figure(svg_of(explicit(surface.state)), caption)
    out += [text_table(head, rows), drawn]
    return [section("Point by point", out, name="explicit")]


def column_value(name: str, value: Any) -> str:
    """A cell of the table of states."""
    if isinstance(value, str):
        return value or ("-" if name == "mode" else NOT_KNOWN)
    if name.endswith("_share"):
        return percent(value)
    return value_of(value, about(name).unit)
