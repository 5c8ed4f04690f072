"""A study as one page to hand on: the answer, its figures and tables, and what it rests on."""

from __future__ import annotations

import dataclasses
import math
import re
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..analysis.assess import assess
from ..analysis.assessment import Assessment
from ..analysis.inputs import declared
from ..analysis.inputs import inputs as numbers_of
from ..analysis.sensitivity import Sensitivity, sensitivity
from ..analysis.uncertainty.inputs import stated_ranges
from ..contact.contact import Contact
from ..contact.evaluation import bodies_of
from ..contact.output import AbstractOutput
from ..equilibrium.columns import Equilibrium, about
from ..equilibrium.solve import solve
from ..equilibrium.transitions import Critical, Transitions, TurningPoint
from ..equilibrium.words import (
    CRITICAL,
    carried,
    critical_load,
    happens,
    load_of,
    mode_of,
    mode_path,
    not_met,
    two_bodies,
    unsolved,
)
from ..errors import NoEquilibrium, RangeWarning, ThirdBodyError
from ..laws.base import Law
from ..populations.materials import NUMBERS, Material, materials
from ..quantities.say import (
    NOT_KNOWN,
    listed,
    number,
    percent,
    plural,
    signed,
    span,
    times,
    unit_of,
    value_of,
)
from ..quantities.value import Value
from ..study import Study, run_film, run_study
from .assess_page import WORDS as ASSESSMENT_WORDS
from .assess_page import pictures as pictures_of
from .html import breaking, document, figure, section, svg_of, symbols, table, text_table, words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["Report", "report"]

MOST_ROWS, MOST_COLUMNS = 20, 5
"""States in the table of states, and in that of the outputs."""
DRAWN, WINDOW, BEYOND = 120, (1e-8, 1e-2), 5.0
"""Loads of the curves, F* within which they lie, and the factor beyond what is marked on them."""
DRAWING = (4.6, 3.4)
"""Width and height of a figure [in]."""
MOST_SAMPLES = 256
"""Samples of the error bars; `assess` takes what the study asks for."""
USUAL, FAINT = 1e-5, 1e-12
"""The load F* around which is drawn where the study presses nothing, and what counts as nothing."""
MATTER, FEW = 3, 12
"""Inputs named in a sentence; loads that are marked one by one."""
STANDING = {
    "read": "read in the source, or in a stored copy of it",
    "abstract": "read in the abstract of the source",
    "from memory": "from memory: the source was not at hand",
}
CRITICAL_HEADS = ("critical load", "F*", "pressure", "status", "what happens there")
CARRIERS = ("the film", "asperities", "particles")
"""Who shares the load of a lubricated contact."""
SATED = 0.01
"""A share so near to 0 or 1 ranks no inputs."""
STATES = ("F_star", "pressure", "h", "d_star", "A_t", "A_ss")
SHARED = ("A_sa", "particle_load_share", "particle_area_share", "mode")
"""Columns of the table of states, and those that particles add."""
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


class Row(NamedTuple):
    """One input of the contact."""

    name: str
    symbol: str
    value: str
    meaning: str
    default: bool


@dataclass(frozen=True, kw_only=True)
class Report:
    """What a study found, ready to be written down.

    Attributes
    ----------
    study : Study
    result : dict
        As `run_study` gives it: states, critical loads, warnings, citations.
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
    film : dict or None
        What `run_film` gives, where the study has a table [film].
    """

    study: Study
    result: dict[str, Any] = field(repr=False)
    curve: Equilibrium = field(repr=False)
    assessment: Assessment | None
    slopes: Sensitivity | None
    at: int
    file: str = field(repr=False, default="")
    film: dict[str, Any] | None = field(repr=False, default=None)

    @property
    def contact(self) -> Contact:
        """The interface."""
        return self.study.contact

    def html(self) -> str:
        """The page as one file: figures inside, nothing loaded, no date: same bytes again."""
        title = self.result["title"] or "Contact of rough surfaces"
        parts = [
            f"<header><h1>{escape(title)}</h1>",
            f"<p class=soft>Report of thirdbody {escape(self.result['version'])}.</p></header>",
            section("The answer", self._answer(), name="answer").replace(
                "<section", "<section class=lead", 1
            ),
            *self._warnings(),
            *self._film(),
            section("Figures", self._figures(), name="figures"),
            section("States", self._states(), name="states"),
            *self._critical(),
            *self._outputs(),
            section("Error bars", self._error_bars(), name="errors"),
            section("Which inputs matter", self._slopes(), name="inputs-that-matter"),
            section("Inputs and their sources", self._inputs(), name="inputs"),
            section("Which laws, and why", self._laws(), name="laws"),
            section("To be cited", self._citations(), name="citations"),
        ]
        if self.file:
            use = "<p class=lead-in>With thirdbody, this file gives the same report again.</p>"
            text = f"<pre>{escape(self.file)}</pre>"
            parts.append(section("The study file", [use, text], name="study"))
        return document(title, parts, style=STYLE + running(title))

    # ------------------------------------------------------------------ the answer
    def sentences(self) -> tuple[str, ...]:
        """The answer: what carries, how close the surfaces are, how far it is from changing.

        Where the study has a film, first what it says with the oil.
        """
        return (*self._with_oil(), *self._without_oil())

    def _without_oil(self) -> tuple[str, str, str]:
        states = self.result["states"]
        known = sorted(self._known(), key=lambda i: states["pressure"][i])
        first, last = known[0], known[-1]
        if first == last:
            return (
                f"{self._at_load(first)} {self._carries(first)}.",
                f"{_capital(self._closeness(first))}.",
                self._distance(first),
            )
        low, high = (f"{self._at_load(i)} {self._carries(i)}" for i in (first, last))
        near, far = (self._apart(i) for i in (first, last))
        return f"{low}: {near}.", f"{high}: {far}.", self._path(known)

    def _with_oil(self) -> list[str]:
        """Which film, what carries at its ends, and where its regime changes."""
        if self.film is None:
            return []
        from .film_words import bodies, point, summary

        speeds = self.film["states"]["speed"]
        eta = value_of(self.film["inputs"]["film"]["oil"]["eta"], "Pa s")
        out = [f"This is a {bodies(self.film)}, in oil of {eta}."]
        for i in sorted({speeds.index(min(speeds)), speeds.index(max(speeds))}):
            told = point(self.film, i)
            film, *solids = (
                (who, told[f"load on {who}"]) for who in CARRIERS if f"load on {who}" in told
            )
            out.append(
                f"At {value_of(speeds[i], 'm/s')} lubrication is {told['regime']}: {film[0]} "
                f"carries {film[1]} of the load, {listed([' '.join(each) for each in solids])}."
            )
        return out + (summary(self.film)[:1] if len(speeds) > 1 else [])

    def _answer(self) -> list[str]:
        body = self.result.get("body", {}).get("sentences", ())
        return [f"<p>{words(sentence)}</p>" for sentence in (*body, *self.sentences())]

    def _known(self) -> list[int]:
        return [i for i, status in enumerate(self.result["states"]["status"]) if status == "ok"]

    def _at_load(self, i: int) -> str:
        return f"{'At' if self.film is None else 'Without the oil, at'} {self._load(i)}"

    def _load(self, i: int) -> str:
        states = self.result["states"]
        return load_of(states["pressure"][i], states["F_star"][i])

    def _carries(self, i: int) -> str:
        states = self.result["states"]
        if not states["A_t"][i]:
            return mode_of(None)
        if self.contact.two_body:
            return two_bodies()
        parts = {part["name"]: part["load_share"][i] for part in self.result["populations"]}
        share = carried(states["particle_load_share"][i], parts)
        return f"{mode_of(states['mode'][i])}, and {share}"

    def _gap(self, i: int) -> str:
        """How far the mean planes are from each other."""
        h = self.result["states"]["h"][i]
        if h < 0:
            return f"the mean planes of the surfaces overlap by {value_of(-h, 'm')}"
        return f"the mean planes of the surfaces are {value_of(h, 'm')} apart"

    def _area(self, i: int) -> str:
        return (
            f"real contact area is {percent(self.result['states']['A_t'][i])} of the nominal area"
        )

    def _apart(self, i: int) -> str:
        touching = self.result["states"]["A_t"][i] > 0
        return f"{self._gap(i)} and the {self._area(i)}" if touching else self._gap(i)

    def _closeness(self, i: int) -> str:
        states = self.result["states"]
        if not states["A_t"][i]:
            return self._gap(i)
        plastic = states["A_p"][i]
        part = "" if plastic is None else f", {percent(plastic / states['A_t'][i])} of it plastic"
        ratio = times(abs(states["h"][i]) / self.contact.roughness.sigma)
        return f"the {self._area(i)}{part}, and {self._gap(i)} ({ratio} the roughness)"

    def _distance(self, i: int) -> str:
        """How far the load is from what would change the mode."""
        F = self.result["states"]["F_star"][i]
        found = self._found("F_cr1", "F_cr2")
        if self.contact.two_body:
            return self._first_input()
        if not F > 0:
            what = "The surfaces pull at each other" if F < 0 else "There is no load"
            return f"{what}: nothing to compare with a critical load."
        if not found:
            entries = {name: self._entry(name) for name in ("F_cr1", "F_cr2")}
            return " ".join(not_met(name, **entry) for name, entry in entries.items())
        name = min(found, key=lambda key: abs(math.log(F / found[key])))
        ratio = number(max(F / found[name], found[name] / F), 3)
        side = f"a factor {ratio} {'above' if found[name] < F else 'below'}"
        if ratio == number(1):
            side = "close to"
        band = ""
        if self.assessment is not None:
            odds = self.assessment.propagation.mode_probability
            likely = max(odds, key=lambda mode: odds[mode])
            band = f"; with the inputs as uncertain as stated, the mode is {likely} in "
            band += f"{percent(odds[likely])} of cases"
        return (
            f"The load is {side} {name} = {number(found[name])} "
            f"({value_of(found[name] * self.contact.E_ss, 'Pa')}), where {happens(name)}{band}."
        )

    def _path(self, known: Sequence[int]) -> str:
        states = self.result["states"]
        if self.contact.two_body:
            return self._first_input()
        loads = [states["F_star"][i] for i in known]
        found = [
            f"{name} = {number(F)} ({value_of(F * self.contact.E_ss, 'Pa')}{_beyond(F, loads)})"
            for name, F in self._found("F_cr1", "F_cr2").items()
        ]
        path = mode_path(states["mode"][i] for i in known)
        critical = "the critical load is" if len(found) == 1 else "critical loads are"
        return f"{path}; {critical} {listed(found)}." if found else f"{path}."

    def _first_input(self) -> str:
        order = [] if self.slopes is None else _order(self.slopes, "A_t")
        if not order:
            return "Which input matters most could not be found."
        assert self.slopes is not None
        slope = float(self.slopes.elasticity["A_t"][order[0]])
        return (
            f"{self._when()}{order[0]} moves the real contact area most: 1 % more of it makes "
            f"{signed(slope, 2, '%')} of area."
        )

    def _when(self) -> str:
        """Of the inputs, and at which of several loads."""
        at = f", at {self._load(self.at)}" if len(self._known()) > 1 else ""
        return f"Of the inputs{at}, "

    def _found(self, *names: str) -> dict[str, float]:
        """Critical loads F* that exist."""
        values = {name: self._entry(name)["value"] for name in names or CRITICAL}
        return {name: value for name, value in values.items() if value}

    def _entry(self, name: str) -> dict[str, Any]:
        head, _, which = name.partition(" ")
        entry = self.result["transitions"][head]
        return entry[which] if which else entry

    # ------------------------------------------------------------------ warnings
    def _warnings(self) -> list[str]:
        texts = [*self.result["warnings"], *(self.film or {"warnings": []})["warnings"]]
        texts = list(dict.fromkeys(texts))
        texts += unsolved(self.result["states"]["status"])
        if not texts:
            return []
        items = "".join(f"<li>{words(text)}</li>" for text in texts)
        return [f"<div class=warning><p><b>Warnings</b></p><ul>{items}</ul></div>"]

    # ------------------------------------------------------------------ figures
    def _figures(self) -> list[str]:
        from matplotlib.ticker import EngFormatter

        from . import plot

        out: list[tuple[Axes, str]] = []
        if not self.contact.two_body:
            ax = plot.modes(
                self.curve,
                _place(left=0.60, above=0.74),
                transitions=_transitions(self.result["transitions"]),
            )
            out.append((self._at(ax), "Contact modes over the load."))
        ax = self._marked(plot.area(self.curve, _place(left=0.75)))
        out.append((ax, "Real contact area over the load."))
        if not self.contact.two_body:
            ax = plot.shares(self.curve, _place(left=0.60))
            if self.curve.populations:
                self._each_population(ax)
            out.append((self._marked(ax), "Part of the load that particles carry."))
        ax = self._marked(plot.separation(self.curve, _place(left=0.92), quantity="h"))
        ax.yaxis.set_major_formatter(EngFormatter("m"))
        ax.set_ylabel(ax.get_ylabel().removesuffix(" [m]"))
        out.append((ax, "Separation of the mean planes over the load."))
        ax = self._at(plot.regimes(self.curve, _place(left=0.60, above=0.12)))
        out.append((ax, "How the real contact is deformed."))
        legend = f"F* = F/(A_n E_ss), with E_ss = {value_of(self.contact.E_ss, 'Pa')}."
        loads = len(set(self._marks()))
        if loads:
            mark = "Bar" if loads > FEW else plural(loads, "Triangle").partition(" ")[2]
            legend += f" {mark} on the axis: the load{'s' if loads > 1 else ''} of the study."
        if drawn := self._drawn():
            legend += f" Dotted: {listed(list(drawn))}."
        pictures = "\n".join(figure(svg_of(ax.figure), caption) for ax, caption in out)
        lead = f'<p class="soft lead-in">{words(legend)}</p>'
        return [lead, f"<div class=figures>{pictures}</div>"]

    def _marked(self, ax: Axes) -> Axes:
        """Loads of the study and critical loads, and the pressure above."""
        from matplotlib.ticker import EngFormatter, NullLocator

        E = self.contact.E_ss
        self._at(ax)
        for name, F in self._drawn().items():
            ax.axvline(F, color="0.25", linewidth=0.8, linestyle=":")
            ax.annotate(
                f"$F^*_{{{name.removeprefix('F_')}}}$",
                (F, 1),
                xycoords=("data", "axes fraction"),
                xytext=(2, -3),
                textcoords="offset points",
                fontsize="small",
                va="top",
            )
        ax.tick_params(which="both", top=False)
        above = ax.secondary_xaxis("top", functions=(scaled(E), scaled(1 / E)))
        above.set_xlabel("Nominal pressure")
        above.xaxis.set_major_formatter(EngFormatter("Pa"))
        above.xaxis.set_minor_locator(NullLocator())
        above.tick_params(which="both", direction="in")
        return ax

    def _drawn(self) -> dict[str, float]:
        """Critical loads F* within the curves."""
        if self.contact.two_body:
            return {}
        drawn = np.atleast_1d(self.curve.F_star)
        found = self._found("F_cr1", "F_cr2")
        return {name: F for name, F in found.items() if drawn[0] <= F <= drawn[-1]}

    def _marks(self) -> list[float]:
        """Loads F* of the study that can be marked."""
        states = self.result["states"]
        return [F for i in self._known() if (F := states["F_star"][i]) >= FAINT]

    def _at(self, ax: Axes) -> Axes:
        """The loads of the study."""
        loads = self._marks()
        style: dict[str, Any] = dict(marker="^", markersize=5, linestyle="")
        if len(loads) > FEW:
            loads = [min(loads), max(loads)]
            style = dict(marker="|", markersize=7, linestyle="-", linewidth=2.5)
        below = ax.get_xaxis_transform()
        zeros = [0.0] * len(loads)
        ax.plot(loads, zeros, transform=below, clip_on=False, zorder=5, color="black", **style)
        return ax

    def _each_population(self, ax: Axes) -> None:
        from .plot.style import _CYCLE, _DASHES

        for i, part in enumerate(self.curve.populations):
            style: dict[str, Any] = dict(
                color=_CYCLE[(i + 1) % len(_CYCLE)], linestyle=_DASHES[(i + 1) % 4]
            )
            ax.plot(self.curve.F_star, part.load_share, label=part.name, **style)
        ax.lines[0].set_label("all particles")
        ax.legend(frameon=False, fontsize="small")

    # ------------------------------------------------------------------ tables
    def _states(self) -> list[str]:
        states = self.result["states"]
        names = list(STATES if self.contact.two_body else (*STATES, *SHARED))
        total = len(states["status"])
        rows = [
            [column_value(name, states[name][i]) for name in names] for i in _some(total, MOST_ROWS)
        ]
        head = [f"<th class=n>{symbols(about(name)['symbol'])}</th>" for name in names]
        cells = [[f"<td class=n>{words(cell)}</td>" for cell in row] for row in rows]
        meanings = "; ".join(f"{about(name)['symbol']}: {about(name)['meaning']}" for name in names)
        out = [table(head, cells), f"<p class=soft>{symbols(meanings)}.</p>"]
        if total > MOST_ROWS:
            out.append(f"<p>{MOST_ROWS} of {plural(total, 'state')}, evenly spread.</p>")
        if self.result["populations"]:
            out += ["<h3>What each population carries</h3>", self._populations(total)]
        return out

    def _populations(self, total: int) -> str:
        parts = self.result["populations"]
        states = self.result["states"]
        head = ["pressure", *(f"{part['name']}: {of}" for part in parts for of in ("load", "area"))]
        rows = [
            [
                value_of(states["pressure"][i], "Pa"),
                *(percent(part[f"{of}_share"][i]) for part in parts for of in ("load", "area")),
            ]
            for i in _some(total, MOST_ROWS)
        ]
        return text_table(head, rows)

    def _critical(self) -> list[str]:
        if self.contact.two_body:
            return []
        rows = []
        for name in CRITICAL:
            entry = self._entry(name)
            value, status = entry["value"], entry["status"]
            loads = (critical_load(value, status, E_ss) for E_ss in (None, self.contact.E_ss))
            rows.append([name, *loads, status, happens(name)])
        text = text_table(CRITICAL_HEADS, rows, CRITICAL_HEADS[3:])
        return [section("Critical loads", [text], name="critical")]

    def _outputs(self) -> list[str]:
        outputs = self.contact.outputs
        if not outputs:
            return []
        states = self.result["states"]
        which = _some(len(states["status"]), MOST_COLUMNS)
        loads = [value_of(states["pressure"][i], "Pa") for i in which]
        head = ["", "symbol", "unit", *(f"<th class=n>{words(load)}</th>" for load in loads)]
        out = []
        for output in outputs:
            rows = []
            for name, (symbol, unit, meaning) in output.columns.items():
                prefixed = unit in ("m", "Pa")
                values = (value_of(states[name][i], unit if prefixed else "1") for i in which)
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

    def _film(self) -> list[str]:
        """The lubricated contact: in words, over speed, and at a few speeds."""
        if self.film is None:
            return []
        from .film_words import bodies, point, summary
        from .plot.film import stribeck

        states, given = self.film["states"], self.film["inputs"]["film"]
        total = len(states["speed"])
        lead = f"A {bodies(self.film)}, in oil of {value_of(given['oil']['eta'], 'Pa s')}. "
        pressed = "the load of the study" if self.study.own_load else "this Hertz pressure"
        lead += f"What follows after this section leaves the oil out, under {pressed}."
        out = [f"<p>{words(text)}</p>" for text in (lead, *summary(self.film))]
        if total > 1:
            drawn = svg_of(stribeck(states, self.film["regime_speeds"]))
            caption = "Friction, load shares and film thickness over speed; grey: the regimes."
            out.append(f'<div class="figures tall">{figure(drawn, caption)}</div>')
        which = _some(total, MOST_COLUMNS)
        columns = [point(self.film, i) for i in which]
        head = ["at a speed of", *(value_of(states["speed"][i], "m/s") for i in which)]
        rows = [[name, *(column[name] for column in columns)] for name in columns[0]]
        return [section("The oil film", [*out, text_table(head, rows)], name="film")]

    # ------------------------------------------------------------------ how sure
    def _error_bars(self) -> list[str]:
        found = self.assessment
        if found is None:
            if not self.result["states"]["F_star"][self.at] >= FAINT:
                return ["<p>There are none: nothing presses the surfaces together.</p>"]
            if self.study.uncertainty is None and stated_ranges(self.contact):
                return [
                    "<p>There are none: with particles that break every sample takes a second, so "
                    "that bands are drawn only where a table [uncertainty] asks for them.</p>"
                ]
            names = [body.name or label for label, body in alike(self._bodies())]
            return [
                "<p>There are none: the study has no table [uncertainty] that says something of "
                "this contact, and the materials library states no ranges for "
                f"{escape(listed(list(dict.fromkeys(names))))}. Every input counts as exactly "
                "known.</p>"
            ]
        whence = (
            "The ranges are those of the table [uncertainty]."
            if self.study.uncertainty is not None
            else "The study has no table [uncertainty]: the ranges are those that the materials "
            "library states, and nothing else counts as uncertain."
        )
        if self.study.uncertainty and self.study.uncertainty.samples > MOST_SAMPLES:
            whence += f" {MOST_SAMPLES} samples stand here; `thirdbody assess` takes all."
        out = [f"<p>{words(found.headline())} {words(whence)}</p>"]
        for part in found.sections()[1:]:
            out.append(f"<h3>{escape(part.title)}</h3>")
            if part.rows:
                out.append(text_table(part.head, part.rows, ASSESSMENT_WORDS))
            out += [f"<p>{words(sentence)}</p>" for sentence in part.sentences]
        pictures = "\n".join(figure(svg, caption) for caption, svg in pictures_of(found))
        return [*out, f"<div class=figures>{pictures}</div>"]

    def ranked(self) -> tuple[str, list[str]]:
        """Which result inputs are ranked by, and the inputs, the strongest first.

        A share at its end hardly answers to anything, so that the area ranks then.
        """
        if self.slopes is None:
            return "A_t", []
        share = self.result["states"]["particle_load_share"][self.at]
        within = not self.contact.two_body and share is not None and SATED < share < 1 - SATED
        of = "particle_load_share" if within else "A_t"
        return of, _order(self.slopes, of)

    def _slopes(self) -> list[str]:
        of, order = self.ranked()
        if self.slopes is None or not order:
            reason = "Derivatives could not be formed for this contact."
            if not self.result["states"]["A_t"][self.at]:
                reason = "There is no contact, so that nothing answers to the inputs."
            return [f"<p>{reason}</p>"]
        others = [name for name in self.slopes.elasticity if name != of]
        rows = []
        for label in order[:10]:
            value = self.slopes.inputs[label]
            unit = {"F_star": "1", "pressure": "Pa", "d": "m"}.get(label)
            unit = unit or declared(self.contact, label.split("+")[0])["unit"]
            each = (float(self.slopes.elasticity[name][label]) for name in (of, *others))
            slopes = (signed(slope, 3) for slope in each)
            rows.append([label, value_of(float(value), unit), *slopes])
        sentence = (
            f"At {self._load(self.at)}, {self._strongest(of, order)}. The numbers tell by how many "
            "per cent a result changes when an input grows by one per cent, all others held, "
            "however well the input is known."
        )
        more = f"<p class=soft>{len(rows)} of {len(order)} inputs.</p>" * (len(order) > len(rows))
        head = ["input", "value", *(about(name)["meaning"] for name in (of, *others))]
        return [f"<p class=lead-in>{words(sentence)}</p>", text_table(head, rows), more]

    def _strongest(self, of: str, order: list[str]) -> str:
        first = order[:MATTER]
        most = f"{listed(first)} matter{'s' if len(first) == 1 else ''} most"
        most += f" to the {about(of)['meaning']}"
        if self.contact.two_body or of != "A_t":
            return most
        share = self.result["states"]["particle_load_share"][self.at]
        return f"{carried(share)}, which leaves that share little to answer with; {most}"

    # ------------------------------------------------------------------ what it rests on
    def _bodies(self) -> dict[str, Material]:
        return bodies_of(self.contact)

    def _inputs(self) -> list[str]:
        bodies = []
        for label, body in alike(self._bodies()):
            source, standing = source_of(body)
            values = [
                f"{about['symbol']} = {value_of(getattr(body, key), about['unit'])}"
                for key, about in NUMBERS.items()
                if getattr(body, key) is not None
            ]
            bodies.append(
                [escape(label), escape(body.name), words(", ".join(values)), source, standing]
            )
        head = ["body", "material", "numbers", "source", "standing of the source"]
        rows = [
            [
                symbols(row.meaning),
                symbols(row.symbol),
                f"<td class=n>{words(row.value)}</td>",
                "<span class=default>default</span>" if row.default else "study",
                breaking(escape(row.name)),
            ]
            for row in rows_of(self.contact)
        ]
        told = (
            "<p>“default” marks what the library takes where a study says nothing; everything "
            "else is what this study says.</p>"
        )
        columns = ["input", "symbol", "<th class=n>value</th>", "from", "name"]
        return [table(head, bodies), told, table(columns, rows)]

    def _laws(self) -> list[str]:
        rows = []
        for what, law, asked in laws_of(self.contact):
            doi = f", doi:{law.doi}" if law.doi else ""
            rows.append(
                [
                    escape(what),
                    f"<b>{escape(law.name)}</b>: {escape(law.title)}",
                    "study" if asked else "<span class=default>default</span>",
                    words(law.valid_range),
                    escape(law.provenance),
                    escape(law.citation + doi),
                ]
            )
        psi = (
            self.contact.surfaces.E_star
            / self.contact.surfaces.H
            * math.sqrt(self.contact.roughness.sigma_s / self.contact.roughness.R)
        )
        verdict = (
            "above 1, asperities yield under nearly any load, and an elastic law would be wrong"
            if psi > 1
            else "below 0.6, asperities stay elastic, and laws with and without yield agree"
            if psi < 0.6
            else "between 0.6 and 1, the load decides whether asperities yield"
        )
        why = (
            "The plasticity index of Greenwood and Williamson, ψ = (E*/H)√(σ_s/R), is "
            f"{number(psi, 3)}: {verdict}. How laws differ, and which suits which surface, tell "
            "the pages “Choose a law” and “Choose a seat” of the documentation; the command "
            "compare puts other laws beside this one."
        )
        head = ["for", "law", "chosen by", "valid", "provenance", "source"]
        return [
            f"<p class=lead-in>{words(why)}</p>",
            table(head, rows),
            "<p class=soft>Provenance: seen means that the formulas were read in the source, "
            "derived that they follow from what is said here, recalled that they were known "
            "without the source at hand, reconstructed that the source left something open.</p>",
        ]

    def _citations(self) -> list[str]:
        lines = [
            *self.result["citations"],
            *(self.film or {"citations": []})["citations"],
            *(
                output.citation + (f", doi:{output.doi}" if output.doi else "")
                for output in self.contact.outputs
            ),
            f"thirdbody {self.result['version']}",
        ]
        items = "".join(f"<li>{escape(line)}</li>" for line in dict.fromkeys(lines))
        return [f"<ul>{items}</ul>"]


def _place(*, left: float, above: float = 0.52) -> Axes:
    """Axes with so much room [in] for what stands beside them, found without drawing twice."""
    from matplotlib.figure import Figure

    width, height = DRAWING
    below, right = 0.54, 0.17
    rectangle = (
        left / width,
        below / height,
        1 - (left + right) / width,
        1 - (below + above) / height,
    )
    return Figure(figsize=DRAWING, dpi=150).add_axes(rectangle)


# -------------------------------------------------------------------------- numbers in words
def column_value(name: str, value: Any) -> str:
    """A cell of the table of states."""
    if isinstance(value, str) or value is None:
        return value or ("-" if name == "mode" else NOT_KNOWN)
    if name.endswith("_share"):
        return percent(value)
    return value_of(value, about(name)["unit"])


def _some(total: int, most: int) -> list[int]:
    """Numbers of at most so many states, evenly spread."""
    rows = min(total, most)
    return [round(row * (total - 1) / max(rows - 1, 1)) for row in range(rows)]


def scaled(factor: float) -> Any:
    """A function that multiplies."""
    return lambda values: values * factor


def _order(slopes: Sensitivity, of: str) -> list[str]:
    """Inputs to which a result answers, the strongest first; then those with no number."""
    row = slopes.elasticity[of]
    size = {label: abs(float(value)) for label, value in row.items()}
    if not any(0 < each < math.inf for each in size.values()):
        return []
    return sorted(size, key=lambda label: -(size[label] if math.isfinite(size[label]) else -1.0))


def _beyond(F: float, loads: Sequence[float]) -> str:
    """Whether a load lies outside those of the study."""
    low, high = min(loads), max(loads)
    if low <= F <= high:
        return ""
    return f", {'below' if F < low else 'above'} the loads of this study"


def _capital(sentence: str) -> str:
    return sentence[:1].upper() + sentence[1:]


def _transitions(found: dict[str, Any]) -> Transitions:
    turning = {name: Critical(**entry) for name, entry in found["F_tpca"].items()}
    return Transitions(
        Critical(**found["F_cr1"]), Critical(**found["F_cr2"]), TurningPoint(**turning)
    )


# -------------------------------------------------------------------------- inputs
def source_of(body: Material) -> tuple[str, str]:
    """Where the numbers of a body come from, and how well that is known (HTML)."""
    entry = materials.entries().get(body.name, {})
    own = {key: getattr(body, key) for key in NUMBERS if getattr(body, key) is not None}
    if not entry or any(value != entry.get(key) for key, value in own.items()):
        return escape(body.source) or "not stated", "given by the study"
    texts = [entry["source"] + (f", doi:{entry['doi']}" if entry.get("doi") else "")]
    texts += [
        f"{NUMBERS[key]['symbol']}: {text}"
        for key, text in entry.get("sources", {}).items()
        if key in own
    ]
    standing = entry.get("standing", "")
    return "<br>".join(map(symbols, texts)), escape(STANDING.get(standing, standing))


def alike(bodies: dict[str, Material]) -> list[tuple[str, Material]]:
    """Bodies by what they are called; two surfaces of one material are one row."""
    out = dict(bodies)
    first, second = (out[f"surface {i}"] for i in (1, 2))
    if dataclasses.asdict(first) == dataclasses.asdict(second):
        out = {"both surfaces": first} | {k: v for k, v in out.items() if "surface" not in k}
    names = {name: name.removeprefix("the ") for name in out}
    if "the particles 1" in out and "the particles 2" not in out:
        names["the particles 1"] = "particles"
    return [(names[name], body) for name, body in out.items()]


def kind_of(part: Value) -> str:
    """A law by its name; a distribution in words."""
    if isinstance(part, Law):
        return part.name
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", type(part).__name__).lower()


def rows_of(contact: Contact) -> list[Row]:
    """Every input but the materials: numbers, words, and which distribution or law."""
    rows = list(_rows(contact, ""))
    rough = contact.roughness
    if rough.eta is None and rough.eta_R_sigma is None:
        name = "roughness.eta_R_sigma"
        told = declared(contact, name)
        value = number(numbers_of(contact)[name])
        row = Row(name, told["symbol"], value, told["meaning"], True)
        place = next(i for i, each in enumerate(rows) if each.name == "roughness.alpha")
        rows.insert(place + 1, row)
    return rows


def _rows(value: Value, path: str) -> Iterator[Row]:
    for item in dataclasses.fields(value):  # type: ignore[arg-type]
        part, name = getattr(value, item.name), f"{path}{item.name}"
        default = _is_default(item, part)
        if about := item.metadata.get("quantity"):
            if part is not None:
                text = value_of(part, about["unit"])
                yield Row(name, about["symbol"], text, about["meaning"], default)
        elif about := item.metadata.get("choice"):
            yield Row(name, "", str(part), about["meaning"], default)
        elif isinstance(part, Value) and not isinstance(part, Material):
            if name == "particle_law" and value.two_body:  # type: ignore[attr-defined]
                continue
            if item.name not in ("surfaces", "roughness", "particles"):
                yield Row(name, "", kind_of(part), item.name.replace("_", " "), default)
                yield from _rows(part, f"{name}.")
            elif item.name != "surfaces":
                yield from _rows(part, f"{name}.")
        elif isinstance(part, tuple) and part:
            for place, each in enumerate(part):
                if isinstance(each, Value):
                    label = each.name if isinstance(each, AbstractOutput) else place
                    yield from _rows(each, f"{name}.{label}.")
            if all(isinstance(each, (int, float)) for each in part):
                text = f"{len(part)} values, {span(min(part), max(part), '1')}"
                yield Row(name, "", text, item.name.replace("_", " "), default)


def _is_default(item: dataclasses.Field[Any], value: Any) -> bool:
    if item.default is not dataclasses.MISSING:
        return bool(item.default == value)
    if item.default_factory is not dataclasses.MISSING:
        return bool(item.default_factory() == value)
    return False


def laws_of(contact: Contact) -> list[tuple[str, Law, bool]]:
    """What each law is for, the law, and whether the study chose it."""
    fields = {item.name: item for item in dataclasses.fields(contact)}

    def asked(name: str) -> bool:
        return not _is_default(fields[name], getattr(contact, name))

    out: list[tuple[str, Law, bool]] = [("asperities", contact.asperity_law, asked("asperity_law"))]
    for i, each in enumerate(contact.populations):
        law = contact.law_of(each)
        what = "particles" + (f" ({each.name or i + 1})" if len(contact.populations) > 1 else "")
        chosen = each.law is not None or asked("particle_law")
        out.append((what, law, chosen))
        if isinstance(inner := getattr(law, "law", None), Law):
            out.append((f"{what}: one indentation", inner, chosen))
    out += [("output", output, True) for output in contact.outputs]
    return out


# -------------------------------------------------------------------------- making it
PARTS = ("states", "error bars", "which inputs matter", "figures")
"""What is done one after the other until there is a page."""


def report(
    study: Study, *, file: str = "", progress: Callable[[str], None] = lambda part: None
) -> Report:
    """Everything that the page of a study tells.

    Parameters
    ----------
    study : Study
        From `load_study`.
    file : str, optional
        The study file, to be printed at the end.
    progress : callable, optional
        Gets the name of each part of the work, as it begins.

    Returns
    -------
    Report
        ``.html()`` is the page, ``.sentences()`` the answer in three sentences.

    Raises
    ------
    NoEquilibrium
        No state of the study has an equilibrium.

    Notes
    -----
    Error bars and elasticities are those at the middle of the loads. Error bars take what the
    table [uncertainty] says, in at most 256 samples (`assess` takes all that it asks for);
    without it, the ranges of the materials library, where it states some, but for particles that
    break, whose samples take a second each.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from thirdbody.study import load_study
    >>> file = Path(tempfile.mkdtemp()) / "study.toml"
    >>> _ = file.write_text('''
    ... [surfaces]
    ... first = "S45C"
    ... second = "S45C"
    ... [roughness]
    ... sigma = "100 nm"
    ... R = "2.8 um"
    ... [load]
    ... pressure = "5 MPa"
    ... ''')
    >>> print(report(load_study(file)).sentences()[0])
    At 5 MPa (F* = 4.468×10⁻⁵) asperities carry the whole load, because there are no particles.
    """
    progress(PARTS[0])
    result = run_study(study)
    states = result["states"]
    known = [i for i, status in enumerate(states["status"]) if status == "ok"]
    if not known:
        count = len(states["status"])
        more = f" (and so for all {count} states)" if count > 1 else ""
        raise NoEquilibrium(states["status"][0] + more)
    known.sort(key=lambda i: states["F_star"][i])
    loaded = [i for i in known if states["F_star"][i] >= FAINT]
    at = (loaded or known)[len(loaded or known) // 2]
    given = {study.load: float(study.values[at])}
    if study.load == "separation":
        given = {"F_star": states["F_star"][at]}
    bare = study.contact.replace(outputs=())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        curve = _curve(bare, result, loaded)
        progress(PARTS[1])
        assessment = _assessed(study, bare, given) if loaded else None
        progress(PARTS[2])
        return Report(
            study=study,
            result=result,
            curve=curve,
            assessment=assessment,
            slopes=_slopes(bare, given) if loaded else None,
            at=at,
            file=file,
            film=None if study.film is None else run_film(study),
        )


def _curve(contact: Contact, result: dict[str, Any], loaded: Sequence[int]) -> Equilibrium:
    """States over the loads of the study, the critical ones, and somewhat beyond."""
    loads = [result["states"]["F_star"][i] for i in loaded] or [USUAL]
    marked = [loads[0], loads[-1]]
    marked += [result["transitions"][name]["value"] for name in ("F_cr1", "F_cr2")]
    marked = [F for F in marked if F]
    low = min(max(min(marked) / BEYOND, WINDOW[0]), loads[0])
    high = max(min(max(marked) * BEYOND, WINDOW[1]), loads[-1])
    return solve(contact, F_star=np.geomspace(low, high, DRAWN))


def _assessed(study: Study, contact: Contact, given: dict[str, float]) -> Assessment | None:
    asked = study.uncertainty
    if asked is None:
        breaks = any(each.strength is not None for each in contact.populations)
        if breaks or not stated_ranges(contact):
            return None
        return assess(contact, **given, samples=MOST_SAMPLES)  # type: ignore[arg-type]
    loads = {"pressure", "F_star", "d"} - set(given)
    inputs = {label: known for label, known in asked.inputs.items() if label not in loads}
    if not inputs:
        return None
    samples = min(asked.samples, MOST_SAMPLES)
    return assess(contact, vary=inputs, **given, samples=samples, seed=asked.seed)  # type: ignore[arg-type]


def _slopes(contact: Contact, given: dict[str, float]) -> Sensitivity | None:
    """Of the load share, the area and the separation, to every input."""
    names = ["A_t", "h"]
    if not contact.two_body:
        names.insert(0, "particle_load_share")
    try:
        return sensitivity(contact, of=names, **given, quick=True)  # type: ignore[arg-type]
    except ThirdBodyError:
        return None
