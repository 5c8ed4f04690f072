"""One page for an engineer: the mode at the operating load, how sure it is, and what decides it."""

from __future__ import annotations

import itertools
import math
import warnings
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from html import escape
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .citations import cite
from .contact import Contact
from .equilibrium import given_load, solve
from .errors import InvalidValue, NoEquilibrium, RangeWarning
from .sensitivities import declared, sensitivity
from .sensitivities import inputs as all_inputs
from .uncertainty import (
    CRITICAL,
    OUTPUTS,
    Drawn,
    Propagation,
    Uncertain,
    about_result,
    columns_at,
    drawn_inputs,
    library_ranges,
    plain,
    propagate,
    swing,
)
from .values import problem_with

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .study import Study

    Array = NDArray[np.float64]

__all__ = ["Assessment", "Change", "assess", "assess_study"]

SHOWN = ("particle_load_share", "particle_area_share", "plastic_share", "A_t", "d", "h")
"""What the page tells of the state."""
BAND = (0.05, 0.5, 0.95)
FAR, COARSE, FINE = 10.0, 41, 81
"""Factor within which a change of mode is sought in an input, and the values tried."""
RARE = 1e-4
"""Probability below which a value counts as outside the range of an input."""
LOADS_SHOWN, SAMPLES_SHOWN = 25, 1024
"""Loads and samples of the figure."""
MEANS = {
    "p-s": "nearly all real contact is on particles",
    "hybrid": "real contact is on particles and on asperities",
    "s-s": "nearly all real contact is on asperities",
    "none": "no equilibrium",
}
ABOVE = {
    "F_cr1": "asperities come into contact (p-s to hybrid)",
    "F_cr2": "particles have little of the contact left (hybrid to s-s)",
    "F_tpca.A": "largest particle share",
    "F_tpca.B": "asperities and particles carry equal loads",
}


class Change(NamedTuple):
    """How far one input, the others as they are, must go to change the mode."""

    input: str
    value: float
    mode: str
    beyond: float
    """Probability that the input is there or farther."""

    def to_dict(self) -> dict[str, Any]:
        return {
            "input": self.input,
            "value": self.value,
            "mode": self.mode,
            "probability": self.beyond,
            "within_range": self.beyond >= RARE,
        }


class Section(NamedTuple):
    """A part of the page: a table, and sentences below it."""

    title: str
    head: tuple[str, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()
    sentences: tuple[str, ...] = ()


# -------------------------------------------------------------------------- the page
@dataclass(frozen=True, kw_only=True)
class Assessment:
    """What an engineer wants to know of a contact under its operating load.

    Attributes
    ----------
    title : str
    propagation : Propagation
        Bands of everything, at the load.
    mode : str
        Contact mode with the contact's own inputs.
    decisive : str
        The output by which inputs are ranked: the critical load nearest to the load, or a share.
    matter : dict
        Inputs, the one that moves `decisive` most first, and their part of its spread when each
        goes from the 5th to the 95th percentile alone; NaN where `decisive` ceases to exist.
    tornado : dict of dict
        ``tornado[of][input]``, outputs at both ends of each input.
    elasticity : dict
        d ln F_cr/d ln p of the nearest critical load; NaN where there is none.
    changes : tuple of Change
        Inputs that can change the mode alone, the likeliest first.
    exact : tuple of str
        Inputs without a range, taken as exactly known.
    notes : tuple of str
        What else is to be said.
    """

    title: str
    propagation: Propagation
    mode: str
    decisive: str
    matter: dict[str, float]
    tornado: dict[str, dict[str, tuple[float, float]]] = field(repr=False)
    elasticity: dict[str, float]
    changes: tuple[Change, ...]
    exact: tuple[str, ...]
    notes: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """The whole page as plain data ready for JSON."""
        from . import __version__

        found = self.propagation
        return {
            "title": self.title,
            "version": __version__,
            "contact": found.contact.to_dict(),
            "mode": self.mode,
            **plain(
                {
                    "propagation": found.to_dict(),
                    "decisive": self.decisive,
                    "matter": self.matter,
                    "tornado": self.tornado,
                    "elasticity": self.elasticity,
                    "changes": [change.to_dict() for change in self.changes],
                }
            ),
            "exact": list(self.exact),
            "sentences": {part.title: list(part.sentences) for part in self.sections()},
            "notes": list(self.notes),
            "citations": cite(found.contact).splitlines(),
        }

    # ------------------------------------------------------------------ words and tables
    def headline(self) -> str:
        """Mode, its probability and the load in one sentence."""
        found = self.propagation
        likely = max(found.mode_probability, key=lambda mode: found.mode_probability[mode])
        parts = [
            f"{mode} {percent(share, found.mode_error[mode])}"
            for mode, share in found.mode_probability.items()
            if share > 0
        ]
        words = f"At {self._load()} the contact is {self.mode}: {MEANS[self.mode or 'none']}"
        if found.contact.two_body:
            return f"{words}, because there are no particles."
        agree = "" if likely == self.mode else f" The likeliest mode is {likely}."
        return f"{words}. Probability of each mode: {', '.join(parts)}.{agree}"

    def sections(self) -> list[Section]:
        """The page from top to bottom."""
        parts = [Section("Mode at the operating load", sentences=(self.headline(),))]
        if not self.propagation.contact.two_body:
            parts.append(self._margins())
        parts += [self._state(), self._inputs()]
        if not self.propagation.contact.two_body:
            parts.append(Section("What would change the mode", sentences=self._ways()))
        parts.append(Section("What this rests on", sentences=self._basis()))
        return parts

    def _load(self) -> str:
        found = self.propagation
        pressure = found.nominal["pressure"]
        return f"{value_of(pressure, 'Pa')} (F* = {found.nominal['F_star']:.4g})"

    def _band(self, name: str) -> tuple[float, ...]:
        where = [self.propagation.probabilities.index(q) for q in BAND]
        return tuple(float(self.propagation.bands[name][i]) for i in where)

    def _margins(self) -> Section:
        found = self.propagation
        if "F_cr1" not in found.bands:
            return Section("Margins", sentences=(NO_CRITICAL.format(_law_of(found)),))
        rows, sentences = [], []
        E = found.contact.E_ss
        for name in (name for name in CRITICAL if name in found.bands):
            nominal, (low, _, high) = found.nominal[name], self._band(name)
            status = found.critical_status[name]
            exists = status.get("found", 0.0)
            rows.append(
                (
                    name,
                    _load(nominal),
                    value_of(nominal * E, "Pa") if 0 < nominal < math.inf else "-",
                    _load(low),
                    _load(high),
                    percent(exists, 0.0),
                    ABOVE[name],
                )
            )
        for name in ("F_cr1", "F_cr2"):
            nominal, (low, _, high) = found.nominal[f"F/{name}"], self._band(f"F/{name}")
            if not 0 < nominal < math.inf:
                where = "above" if nominal else "below"
                sentences.append(
                    f"{name} is not met: at every load searched this contact is {where} it."
                )
                continue
            band = f"{low:.3g} to {high:.3g} times"
            if low == 0 or math.isinf(high):
                band = f"at most {high:.3g} times" if low == 0 else f"at least {low:.3g} times"
            sentences.append(
                f"The load is {nominal:.3g} times {name}, where {ABOVE[name]}; in nine of ten "
                f"cases it is {band} that load."
            )
        head = ("critical load", "F*", "pressure", "5 %", "95 %", "exists", "where")
        return Section("Margins", head, tuple(rows), tuple(sentences))

    def _state(self) -> Section:
        found = self.propagation
        rows = []
        outputs = [name for each in found.contact.outputs for name in each.columns]
        for name in (name for name in (*SHOWN, *outputs) if name in found.bands):
            if found.contact.two_body and name.startswith("particle"):
                continue
            low, middle, high = self._band(name)
            each = (found.nominal[name], low, middle, high)
            where = [found.probabilities.index(q) for q in BAND]
            error = _error(float(np.max(found.error[name][where])), name)
            rows.append((about_result(name)["meaning"], *(_amount(x, name) for x in each), error))
        head = ("result", "nominal", "5 %", "50 %", "95 %", "error of the bands")
        lost = 1 - found.solved
        told = (f"{percent(lost, 0.0)} of the samples have no equilibrium.",) if lost else ()
        return Section("State", head, tuple(rows), told)

    def _inputs(self) -> Section:
        found = self.propagation
        rows = []
        for label, part in self.matter.items():
            known = found.inputs[label]
            unit, value = _unit(found.contact, label), _nominal(found, label)
            low, high = self.tornado[self.decisive][label]
            slope = self.elasticity.get(label, math.nan)
            rows.append(
                (
                    label,
                    value_of(value, unit),
                    *(value_of(known.at(end), unit) for end in (0.05, 0.95)),
                    *(_amount(end, self.decisive) for end in (low, high)),
                    "< 0.1 %" if part < 1e-3 else percent(part, 0.0),
                    "-" if math.isnan(slope) else "0" if abs(slope) < 1e-4 else f"{slope:.3g}",
                )
            )
        strongest = list(self.matter)[:3]
        sentences = [
            f"Of the inputs, {listed(strongest)} matter{'s' if len(strongest) == 1 else ''} most "
            f"to {self._decisive()}."
        ]
        first = self.matter[strongest[0]] if strongest else math.nan
        if math.isfinite(first):
            sentences.append(
                f"A better value of {strongest[0]} pays most: it alone makes about "
                f"{percent(first, 0.0)} of the spread of {self.decisive}"
                + (" (of its logarithm)." if self.decisive in CRITICAL else ".")
            )
        head = (
            *("input", "value", "5 %", "95 %"),
            *(f"{self.decisive} at {end}" for end in ("5 %", "95 %")),
            *("part of spread", "elasticity"),
        )
        return Section("Inputs that matter", head, tuple(rows), tuple(sentences))

    def _decisive(self) -> str:
        if self.decisive in CRITICAL:
            return f"{self.decisive}, the critical load nearest to this load"
        return f"the {OUTPUTS[self.decisive]['meaning']}"

    def _ways(self) -> tuple[str, ...]:
        found = self.propagation
        out = []
        F = found.nominal["F_star"]
        for name, modes in (("F_cr1", ("p-s", "hybrid")), ("F_cr2", ("hybrid", "s-s"))):
            critical = found.nominal.get(name, math.nan)
            if 0 < critical < math.inf and self.mode in modes:
                word = "fall" if critical < F else "rise"
                other = modes[0] if critical < F else modes[1]
                load = value_of(critical * found.contact.E_ss, "Pa")
                out.append(
                    f"The load would have to {word} to {load} ({critical / F:.3g} times "
                    f"the operating load) for {other}."
                )
        for change in self.changes:
            unit, value = _unit(found.contact, change.input), _nominal(found, change.input)
            word = "falling" if change.value < value else "rising"
            where = "outside its range"
            if change.beyond >= RARE:
                where = f"it is there or beyond in {percent(change.beyond, 0.0)} of cases"
            out.append(
                f"{change.input} {word} from {value_of(value, unit)} to "
                f"{value_of(change.value, unit)} makes it {change.mode}: {where}."
            )
        changed = {change.input for change in self.changes}
        still = [label for label in found.inputs if label not in changed and label != found.load]
        if still:
            out.append(
                f"{listed(still)}: no change of mode within a factor of {FAR:g}, the other "
                "inputs as they are."
            )
        return tuple(out)

    def _basis(self) -> tuple[str, ...]:
        from . import __version__

        found = self.propagation
        sought = f" and {found.critical_samples} of the critical loads"
        out = [
            f"{found.samples} samples of the state{sought if found.critical_samples else ''} "
            f"(scrambled Sobol points, seed {found.seed}); inputs independent of each "
            f"other; thirdbody {__version__}."
        ]
        if self.exact:
            out.append(f"Taken as exactly known: {', '.join(self.exact)}.")
        return (*out, *self.notes)

    # ------------------------------------------------------------------ terminal
    def page(self) -> Any:
        """The page for a terminal, to print by rich."""
        from rich import box
        from rich.console import Group
        from rich.table import Table

        parts: list[Any] = [self.title or "Assessment"]
        for section in self.sections():
            parts += ["", section.title.upper()]
            if section.rows:
                table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
                for i, head in enumerate(section.head):
                    words = not i or head == "where"
                    table.add_column(
                        head,
                        justify="left" if words else "right",
                        overflow="fold",
                        no_wrap=not i or head == "elasticity",
                    )
                for row in section.rows:
                    table.add_row(*row)
                parts.append(table)
            parts += section.sentences
        return Group(*parts)

    # ------------------------------------------------------------------ HTML
    def html(self) -> str:
        """The page as one file: figures inside, nothing loaded, no date: same bytes again."""
        from .html import document, figure, section, text_table, words

        title = self.title or "Assessment"
        body = [f"<h1>{escape(title)}</h1>"]
        figures = iter(self.figures())
        for part in self.sections():
            lines = [text_table(part.head, part.rows, WORDS)] if part.rows else []
            lines += [f"<p>{words(sentence)}</p>" for sentence in part.sentences]
            if part.title in ("State", "Inputs that matter"):
                caption, picture = next(figures)
                lines.append(figure(picture, caption))
            body.append(section(part.title, lines))
        return document(title, body)

    def figures(self) -> list[tuple[str, bytes]]:
        """Captions and pictures of the bands over the load, and of the inputs."""
        from matplotlib.figure import Figure

        from . import plot
        from .html import svg_of

        found = self.propagation
        of = "A_t" if found.contact.two_body else "particle_load_share"
        value = float(found.loads)
        loads = value * np.geomspace(1 / 30, 30, LOADS_SHOWN)
        known = {name: one for name, one in found.inputs.items() if name != found.load}
        out = []
        if known:
            curve = propagate(
                found.contact,
                known,
                **{found.load: loads},  # type: ignore[arg-type]
                samples=max(min(SAMPLES_SHOWN, found.samples // 16), 64),
                seed=found.seed,
                outputs=[of],
            )
            ax = plot.bands(curve, of, mark=value)
            words = f"Bands of the {OUTPUTS[of]['meaning']} over the load; the operating load is "
            out.append((words + "marked.", svg_of(ax.figure)))
        else:
            out.append(("Only the load is uncertain.", svg_of(Figure(figsize=(1, 1)))))
        ax = plot.tornado(found, self.decisive, values=self.tornado[self.decisive])
        words = f"{self.decisive} with one input at each end of its 5 % to 95 % range."
        return [*out, (words, svg_of(ax.figure))]


NO_CRITICAL = (
    "No critical loads: with {} as the law of the particles, the load need not fall as the "
    "separation grows, so that several separations may carry one load and the mode may change "
    "more than once; the bands of the state below hold, and `transitions` seeks the critical "
    "loads of single contacts."
)
"""What stands for the margins of a law whose load does not tell its separation."""

WORDS = ("where", "result")
"""Columns of words, which may break."""


def _law_of(found: Propagation) -> str:
    return type(found.contact.particle_law).__name__


# -------------------------------------------------------------------------- numbers in words
def value_of(value: float, unit: str) -> str:
    """A number with a readable unit: 3e-7 m is "300 nm"."""
    if not math.isfinite(value):
        return "-"
    prefixes = {
        "m": ((1e-3, "mm"), (1e-6, "um"), (0.0, "nm")),
        "Pa": ((1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (0.0, "Pa")),
    }
    scales = {"mm": 1e-3, "um": 1e-6, "nm": 1e-9, "GPa": 1e9, "MPa": 1e6, "kPa": 1e3, "Pa": 1.0}
    if unit in prefixes:
        name = next(name for least, name in prefixes[unit] if abs(value) >= least * (1 - 1e-9))
        return f"{value / scales[name]:.4g} {name}"
    return f"{value:.4g}" + ("" if unit in ("", "1") else f" {unit}")


def _amount(value: float, name: str) -> str:
    if name in CRITICAL:
        return _load(value)
    unit = about_result(name)["unit"]
    return percent(value, 0.0) if unit == "1" and name in OUTPUTS else value_of(value, unit)


def _load(value: float) -> str:
    if math.isnan(value):
        return "-"
    if not 0 < value < math.inf:
        return "below 1e-8" if value == 0 else "above 1e-2"
    return f"{value:.3g}"


def percent(value: float, error: float) -> str:
    if not math.isfinite(value):
        return "-"
    text = f"{100 * value:.3g} %" if value < 0.9995 or value == 1 else f"{100 * value:.5g} %"
    return f"{text} (± {100 * error:.1g} %)" if error > 0 else text


def _error(error: float, name: str) -> str:
    if not math.isfinite(error):
        return "-"
    if name not in OUTPUTS:
        return f"{error:.1g}"
    return f"{100 * error:.1g} %" if OUTPUTS[name]["unit"] == "1" else f"{error:.1g} m"


def listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _unit(contact: Contact, label: str) -> str:
    units = {"pressure": "Pa", "F_star": "1", "d": "m"}
    return units.get(label) or declared(contact, label.split("+")[0])["unit"]


def _nominal(found: Propagation, label: str) -> float:
    if label == found.load:
        return float(found.loads)
    return all_inputs(found.contact)[label.split("+")[0].strip()]


# -------------------------------------------------------------------------- making it
def assess(
    contact: Contact,
    inputs: Mapping[str, Uncertain | tuple[float, float]] | None = None,
    *,
    pressure: float | None = None,
    F_star: float | None = None,
    samples: int = 2**14,
    seed: int = 0,
    title: str = "",
) -> Assessment:
    r"""Mode at the operating load with its probability, margins, and what decides them.

    Parameters
    ----------
    contact : Contact
    inputs : mapping, optional
        What is uncertain, as in `propagate`. Without it the ranges of the materials library, where
        it states some; none is invented.
    pressure, F_star : float
        The operating load: p [Pa] or F* [1]; exactly one.
    samples, seed : int, optional
        As in `propagate`.
    title : str, optional
        Over the page.

    Returns
    -------
    Assessment
        ``.page()`` for a terminal (rich), ``.html()`` and ``.to_dict()``.

    Raises
    ------
    InvalidValue
        No uncertain input, several loads, or a mistake in the inputs.
    NoEquilibrium
        The contact does not carry the load.

    Notes
    -----
    Inputs are ranked by how far each alone, going from its 5th to its 95th percentile, moves the
    critical load nearest to the load; the part of the spread is the square of that way in the
    logarithm over the sum of the squares, which is exact where the inputs do not interact
    (`Propagation.sobol_indices` where they do). Values at which the mode changes are sought within
    a factor of 10 of each input and known to 0.1 %.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9)))
    >>> page = assess(contact, {"roughness.sigma": (80e-9, 120e-9)}, pressure=5e6, samples=256)
    >>> page.mode, page.decisive, page.changes[0].mode
    ('hybrid', 'F_cr1', 'p-s')
    """
    given = {"pressure": pressure, "F_star": F_star}
    load, values, one = given_load(contact, pressure, F_star, None)
    if not one:
        raise InvalidValue(f"{load}: an assessment is of one operating load, not {len(values)}")
    notes: list[str] = []
    if inputs is None:
        inputs = library_ranges(contact)
        if not inputs:
            known = ", ".join(all_inputs(contact))
            raise InvalidValue(
                f"no input has a range, and the materials library states none for these bodies: "
                f"say what is known of {known}, e.g. roughness.sigma = (80e-9, 120e-9)"
            )
        notes.append(f"Ranges of the materials library: {', '.join(inputs)}.")
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always", RangeWarning)
        state = solve(contact, **{load: given[load]})  # type: ignore[arg-type]
    notes += [f"Warning: {text}." for text in dict.fromkeys(str(item.message) for item in heard)]
    found = propagate(contact, inputs, **{load: given[load]}, samples=samples, seed=seed)  # type: ignore[arg-type]
    if found.solved == 0:
        raise NoEquilibrium("no sample has an equilibrium; check the unit of the load")
    for label, one_input in found.inputs.items():
        if not TINY < one_input.cdf(_nominal(found, label)) < 1 - TINY:
            unit = _unit(contact, label)
            notes.append(
                f"The value {value_of(_nominal(found, label), unit)} of {label} lies outside what "
                "its range says; nominal results and bands do not belong together."
            )
    decisive = _decisive(found)
    others = [name for name in SHOWN[:4] if name in found.bands and name != decisive]
    tornado = found.tornado([decisive, *others])
    moved = {name.strip() for label in found.inputs for name in label.split("+")}
    return Assessment(
        title=title,
        propagation=found,
        mode=str(state.mode),
        decisive=decisive,
        matter=_parts(tornado[decisive], logarithm=decisive in CRITICAL),
        tornado=tornado,
        elasticity=_elasticities(found, decisive),
        changes=_changes(found, str(state.mode)),
        exact=tuple(name for name in all_inputs(contact) if name not in moved),
        notes=tuple(notes),
    )


def assess_study(study: Study) -> Assessment:
    """The page of a study file: its load, and its table [uncertainty]; raises as `assess`."""
    if study.load == "separation":
        raise InvalidValue(
            "load.separation: an assessment needs the operating load; give load.pressure or "
            "load.F_star instead"
        )
    if len(study.values) != 1:
        raise InvalidValue(
            f"load.{study.load} has {len(study.values)} values, and an assessment is of one "
            'operating load; choose it, e.g. --set load.pressure="5 MPa"'
        )
    asked = study.uncertainty
    value: dict[str, Any] = {study.load: float(study.values[0])}
    if asked is None:
        if not library_ranges(study.contact):
            raise InvalidValue(
                "there is no table [uncertainty], and the materials library states no ranges for "
                f"these bodies; say what is known of {', '.join(all_inputs(study.contact))}, e.g. "
                '[uncertainty.inputs] roughness.sigma = { low = "80 nm", high = "120 nm" }'
            )
        return assess(study.contact, title=study.title, **value)
    return assess(
        study.contact,
        asked.inputs,
        samples=asked.samples,
        seed=asked.seed,
        title=study.title,
        **value,
    )


TINY = 1e-3
"""Probability beyond which a nominal value no longer belongs to its distribution."""


def _decisive(found: Propagation) -> str:
    """The critical load nearest to the load, or the share to rank inputs by."""
    margins = {name: found.nominal.get(f"F/{name}", 0.0) for name in ("F_cr1", "F_cr2")}
    exist = {name: abs(math.log(x)) for name, x in margins.items() if 0 < x < math.inf}
    if exist:
        return min(exist, key=lambda name: exist[name])
    return "A_t" if found.contact.two_body else "particle_load_share"


def _parts(ends: Mapping[str, tuple[float, float]], *, logarithm: bool) -> dict[str, float]:
    """Part of each input in the spread, the largest first; NaN where an end does not exist."""
    ways = {}
    for label, (low, high) in ends.items():
        if logarithm:
            with np.errstate(divide="ignore"):
                low, high = (float(np.log(x)) for x in (low, high))
        ways[label] = swing(low, high) if not math.isnan(low + high) else 0.0
    total = sum(way**2 for way in ways.values())
    order = sorted(ways, key=lambda label: -ways[label])
    if not 0 < total < math.inf:
        return dict.fromkeys(order, math.nan)
    return {label: ways[label] ** 2 / total for label in order}


def _elasticities(found: Propagation, decisive: str) -> dict[str, float]:
    """d ln F_cr/d ln p of every input, where it exists."""
    labels = [label for label in found.inputs if label != found.load]
    out = dict.fromkeys(labels, math.nan)
    if decisive not in CRITICAL:
        return out

    def slopes(some: list[str]) -> dict[str, float]:
        found_here = sensitivity(found.contact, of=decisive, to=some).elasticity[decisive]
        return {label: float(found_here[label]) for label in some}

    try:
        return slopes(labels)
    except InvalidValue:  # one of them has none
        for label in labels:
            with suppress(InvalidValue):
                out |= slopes([label])
    return out


def _changes(found: Propagation, mode: str) -> tuple[Change, ...]:
    """Where along each input, on either side, the mode ceases to be what it is."""
    out: list[Change] = []
    if found.contact.two_body:
        return ()
    ways: dict[tuple[str, int], tuple[Drawn, Array]] = {}
    for label, known in found.inputs.items():
        if label != found.load:
            drawn = drawn_inputs(found.contact, {label: known}, found.load, float(found.loads))
            for side in (-1, 1):
                ways[label, side] = drawn, _path(found.contact, drawn, known, side)
    steps = _departures(found, ways, mode)
    finer = {
        way: (ways[way][0], np.linspace(low, high, FINE)) for way, (low, high, _) in steps.items()
    }
    for (label, side), (low, high, other) in _departures(found, finer, mode).items():
        value, known = 0.5 * (low + high), found.inputs[label]
        beyond = known.cdf(value) if side < 0 else 1 - known.cdf(value)
        out.append(Change(label, value, other, beyond))
    near = {
        label: abs(math.log(change.value / start)) if change.value * start > 0 else math.inf
        for change in out
        for label, start in [(change.input, _nominal(found, change.input))]
    }
    return tuple(sorted(out, key=lambda change: (-change.beyond, near[change.input])))


def _path(contact: Contact, drawn: Drawn, known: Uncertain, side: int) -> Array:
    """Values of an input from where it is to as far as it may go."""
    (start,) = drawn.nominal
    (moved,) = drawn.moved
    assert not isinstance(moved, str)
    if start > 0:
        values = start * np.geomspace(1.0, FAR**side, COARSE)
    else:
        ends = np.array([known.at(0.0), known.at(1.0)])
        values = np.linspace(start, start + side * (np.ptp(ends) + np.abs(ends).max()), COARSE)

    def fits(value: float) -> bool:
        each = moved.at((value - moved.values[0]) / moved.scales[0])
        return all(
            problem_with(declared(contact, name), float(v)) is None for name, v in each.items()
        )

    good = [fits(float(value)) for value in values]
    return values[: good.index(False)] if False in good else values


def _departures(
    found: Propagation, ways: Mapping[tuple[str, int], tuple[Drawn, Array]], mode: str
) -> dict[tuple[str, int], tuple[float, float, str]]:
    """The step at which the first other mode comes, and that mode, on each way that has one."""
    if not ways:
        return {}
    own = all_inputs(found.contact)
    moved = [drawn.at([values]) for drawn, values in ways.values()]
    ends = np.cumsum([0, *(len(values) for _, values in ways.values())])
    pieces = [slice(*pair) for pair in itertools.pairwise(ends.tolist())]
    vary: dict[str, Array] = {}
    for some, piece in zip(moved, pieces, strict=True):
        for name, values in some.items():
            vary.setdefault(name, np.full(ends[-1], own[name]))[piece] = values
    states = columns_at(found.contact, found.load, float(found.loads), vary, int(ends[-1]))
    out = {}
    for (way, (_, values)), piece in zip(ways.items(), pieces, strict=True):
        modes = [str(word) for word in states["mode"][piece]]
        step = next((i for i, other in enumerate(modes) if other != mode), 0)
        if step > 0 and modes[step] != "":
            out[way] = float(values[step - 1]), float(values[step]), modes[step]
    return out
