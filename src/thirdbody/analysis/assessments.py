"""What an assessment of several loads says: a row a load, and what would change each mode."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from ..contact.citations import cite
from ..equilibrium.words import load_of, mode_path
from ..quantities.record import VERSION, Column, Variable
from ..quantities.say import number, percent, plural, value_of
from ..quantities.tables import WIDER
from .assessment import (
    NO_RANGES,
    RARE,
    SENTENCES,
    Assessment,
    PageRecord,
    Section,
    _nominal,
    terminal_page,
    unit_of,
)
from .inputs import words_of
from .uncertainty.propagation import about_result

__all__ = ["Assessments"]

NUMBERS = ("pressure", "F_star", "A_t", "particle_load_share", "F/F_cr1", "F/F_cr2")
"""Columns of a result of several loads, beside those of the mode."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Assessments(PageRecord):
    """What an engineer wants to know of a contact under each of several loads.

    As labelled data and as a table it has a row for each load.

    Attributes
    ----------
    title : str
    pages : tuple of Assessment
        One for each load that was assessed, in the order of the study.
    asked : int
        Loads of the study; of many, some evenly spread are assessed.
    separations : tuple of float
        Where the study gives separations, that of each page [m]; otherwise empty.
    unsolved : tuple of str
        Loads that no equilibrium carries, a sentence each.
    notes : tuple of str
        What else is to be said of all.
    """

    in_dict = (
        *("title", VERSION, "asked", ("loads", "_each_load"), "unsolved", SENTENCES, "notes"),
        ("citations", lambda result: cite(result.pages[0].propagation.contact).splitlines()),
    )
    along = "load"
    title: str
    pages: tuple[Assessment, ...]
    asked: int
    separations: tuple[float, ...] = ()
    unsolved: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    def _each_load(self) -> list[dict[str, Any]]:
        """Every page, with its separation where the study gives separations."""
        pages = [page.to_dict() for page in self.pages]
        for page, d in zip(pages, self.separations, strict=False):
            page["separation"] = d
        return pages

    def variables(self) -> dict[str, Variable]:
        """Load, mode, and how sure it is; shares, and how far the load is from critical ones."""
        columns: dict[str, tuple[Column, list[float] | list[str]]] = {
            name: (about_result(name), self._nominal(name)) for name in NUMBERS
        }
        sure = [page.propagation.mode_probability.get(page.mode, math.nan) for page in self.pages]
        columns["mode"] = about_result("mode"), [page.mode for page in self.pages]
        columns["mode_probability"] = Column("", "1", "probability of this mode"), sure
        if self.separations:
            columns["separation"] = about_result("d"), list(self.separations)
        return {
            name: Variable((self.along,), values, about.labels)
            for name, (about, values) in columns.items()
        }

    def _nominal(self, name: str) -> list[float]:
        """A number of each page with the contact's own inputs; NaN where there is none."""
        return [page.propagation.nominal.get(name, math.nan) for page in self.pages]

    # ------------------------------------------------------------------ words and tables
    @cached_property
    def _uncertain(self) -> bool:
        return bool(self.pages[0].propagation.inputs)

    @cached_property
    def _two_body(self) -> bool:
        return self.pages[0].propagation.contact.two_body

    def sections(self) -> list[Section]:
        """The page from top to bottom."""
        parts = [self._modes()]
        if not self._two_body:
            margins = self.pages[0].margins()
            sentences = margins.sentences if not margins.rows else ()
            parts.append(margins._replace(title="Critical loads", sentences=sentences))
            parts.append(self._changes())
        parts.append(Section("What this rests on", sentences=self._basis()))
        return parts

    def _basis(self) -> tuple[str, ...]:
        """Sentences on all loads, then on single ones."""
        bases = [page.basis() for page in self.pages]
        common = [said for said in bases[0] if all(said in other for other in bases)]
        of_single_pages = [
            f"At {self._loads(page)[0]}: {said}"
            for page, basis in zip(self.pages, bases, strict=True)
            for said in basis
            if said not in common
        ]
        return (*common, *of_single_pages)

    def _loads(self, page: Assessment) -> tuple[str, str]:
        nominal = page.propagation.nominal
        return value_of(nominal["pressure"], "Pa"), number(nominal["F_star"])

    def _modes(self) -> Section:
        rows = []
        for i, page in enumerate(self.pages):
            propagation = page.propagation
            cells = [*self._loads(page)]
            cells += [value_of(d, "m") for d in self.separations[i : i + 1]]
            cells.append(page.mode or "no contact")
            if self._uncertain and not self._two_body:
                cells.append(percent(propagation.mode_probability.get(page.mode, math.nan)))
            if not self._two_body:
                cells.append(percent(propagation.nominal["particle_load_share"]))
                margins = (
                    propagation.nominal.get(f"F/{name}", math.nan) for name in ("F_cr1", "F_cr2")
                )
                cells += ["-" if not 0 < x < math.inf else number(x, 3) for x in margins]
            else:
                cells.append(percent(propagation.nominal["A_t"]))
            rows.append(tuple(cells))
        head = ["pressure", "F*", *["separation d"] * bool(self.separations), "mode"]
        if self._two_body:
            head.append("real area")
        else:
            head += ["probability"] * self._uncertain
            head += ["particles' load", "over F_cr1", "over F_cr2"]
        said = []
        order = sorted(self.pages, key=lambda page: page.propagation.nominal["F_star"])
        said.append(f"{mode_path(page.mode for page in order)}.")
        if self.asked > len(self.pages) + len(self.unsolved):
            shown = len(self.pages) + len(self.unsolved)
            said.append(
                f"{shown} of {plural(self.asked, 'load')}, evenly spread. The whole page of one "
                'load: --set load.pressure="5 MPa".'
            )
        said += self.unsolved
        said += self.notes
        if not self._uncertain:
            said.append(NO_RANGES)
        elif words := self.pages[0].fixed_numbers_words():
            said.append(words)
        drop = ("F*", "over F_cr2", "particles' load")
        return Section("Mode at each load", tuple(head), tuple(rows), tuple(said), drop)

    def _changes(self) -> Section:
        """What would change the mode at each load: the load itself, then inputs alone."""
        rows, said = [], []
        for page in self.pages:
            propagation, load = page.propagation, self._loads(page)[0]
            ways = page.load_changes()
            for to, other in ways:
                share = "" if self._uncertain else None
                rows.append(_row(load, "load", load, value_of(to, "Pa"), other, share))
            for change in page.changes:
                unit, value = (
                    unit_of(propagation.contact, change.input),
                    _nominal(propagation, change.input),
                )
                cells = value_of(value, unit, 3), value_of(change.value, unit, 3)
                share = percent(change.beyond, least=RARE) if self._uncertain else None
                words = words_of(propagation.contact, change.input)
                rows.append(_row(load, words, *cells, change.mode, share))
            said += [text for text in page.stops_words() if text not in said]
            if not (ways or page.changes):
                loads = load_of(propagation.nominal["pressure"], propagation.nominal["F_star"])
                said.append(f"At {loads} nothing was found that alone changes the mode.")
        cases = ("in cases",) * self._uncertain
        head = ("at the load", "what alone changes", "from", "to", "mode there", *cases)
        said.append("Inputs are moved within a factor of 10, the others as they are.")
        return Section("What would change the mode", head, tuple(rows), tuple(said), ("in cases",))

    # ------------------------------------------------------------------ terminal
    def page(self, more: str = WIDER) -> Any:
        """The page for a terminal, to print by rich; ``more`` is how to see what has no room."""
        return terminal_page(self.title or "Assessment", self.sections(), more, LEGEND)


LEGEND = {
    "over F_cr1": "the load over the first critical load, p-s to hybrid, no unit",
    "over F_cr2": "the load over the second critical load, hybrid to s-s, no unit",
    "in cases": "part of the cases in which the input is there or beyond",
    "probability": "of this mode",
}


def _row(*cells: str | None) -> tuple[str, ...]:
    return tuple(cell for cell in cells if cell is not None)
