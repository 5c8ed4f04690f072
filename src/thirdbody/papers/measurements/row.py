"""What every comparison with a measurement is made of: conditions, statements, predictions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ..ledger import Claim, data_of, number
from ..panels import Panel

__all__ = [
    "ABSTRACT",
    "CAPTION",
    "CHOSEN",
    "COMPUTED",
    "CONSTRUCTED",
    "REPORTED",
    "STANDINGS",
    "WORDS",
    "Band",
    "Input",
    "Row",
    "Statement",
    "Verdict",
    "count_words",
    "row_of",
    "statement",
]

ABSTRACT, CAPTION = "abstract seen", "figure caption seen"
"""Standing of what was read in the authors' abstract, or under one of their figures."""
COMPUTED = "computed here"
"""Standing of a number from a computation that shares nothing with the model."""
CHOSEN = "chosen here"
"""Standing of an input that the source seen does not give: a range of what it can have been."""
REPORTED = "reported by others"
"""Standing of what another paper says of the measurement."""
STANDINGS = (ABSTRACT, CAPTION, REPORTED, COMPUTED, CHOSEN)

CONSTRUCTED = "by construction"
"""Verdict where the model holds whatever its numbers are: no measurement of it."""
WORDS = ("lost", "undecided", "met", CONSTRUCTED)
"""Every verdict there is, in the order in which a page shows them."""


def count_words(words: list[str]) -> dict[str, int]:
    """How often each verdict was reached; what holds by construction only where it occurs."""
    return {
        word: words.count(word) for word in WORDS if word != CONSTRUCTED or CONSTRUCTED in words
    }


@dataclass(frozen=True)
class Band:
    """A prediction: the number, and the least and largest over the inputs that are not known.

    Examples
    --------
    >>> Band.from_values([0.9, 0.95, 1.0]).text
    '0.95 (0.9 … 1)'
    """

    low: float
    best: float
    high: float
    note: str = ""

    @classmethod
    def from_values(cls, values: object, note: str = "") -> Band:
        """From predictions over the corners of the inputs; the middle one is the number."""
        import numpy as np

        numbers = np.sort(np.ravel(np.asarray(values, dtype=float)).round(12))
        return cls(float(numbers[0]), float(numbers[len(numbers) // 2]), float(numbers[-1]), note)

    @property
    def text(self) -> str:
        """For a table."""
        ends = f" ({number(self.low)} … {number(self.high)})" if self.low < self.high else ""
        return number(self.best) + ends


@dataclass(frozen=True)
class Input:
    """One input of a prediction: its meaning, value or range with unit, and source."""

    what: str
    value: str
    standing: str


@dataclass(frozen=True)
class Verdict:
    """A statement judged: one of `WORDS`, and why."""

    word: str
    why: str
    band: Band | None


@dataclass(frozen=True)
class Statement:
    """One measured statement, how well it is known, and the model's prediction.

    ``undecided`` is the reason why even a number within the limits would decide nothing;
    ``by_construction`` why no other number could come out.
    """

    claim: Claim
    predict: Callable[[], Band | None]
    undecided: str = ""
    by_construction: str = ""

    def judge(self) -> Verdict:
        """Met: the whole band lies within the limits. Lost: none of it does."""
        band = self.predict()
        if self.by_construction:
            return Verdict(CONSTRUCTED, self.by_construction, band)
        if self.undecided or band is None:
            return Verdict("undecided", self.undecided or "no prediction", band)
        low, high = self.claim.interval()
        if low <= band.low and band.high <= high:
            return Verdict("met", f"allowed {self.claim.rule_words}", band)
        if band.high < low or band.low > high:
            return Verdict("lost", f"allowed {self.claim.rule_words}", band)
        why = f"allowed {self.claim.rule_words}: the inputs that are not known decide"
        return Verdict("undecided", why, band)


def statement(
    id: str,
    measured: str,
    standing: str,
    quantity: str,
    rule: dict[str, object],
    predict: Callable[[], Band | None],
    *,
    remark: str = "",
    undecided: str = "",
) -> Statement:
    """A statement; ``rule`` as in `Claim`, {} where nothing can be judged."""
    claim = Claim(id, "", measured, quantity, "", {}, "", rule, remark, (), standing)
    return Statement(claim, predict, undecided)


@dataclass(frozen=True)
class Row:
    """One measurement: what was done, how well it is known, and the model's predictions."""

    name: str
    title: str
    source: str
    """Citation with DOI."""
    conditions: str
    inputs: tuple[Input, ...]
    statements: tuple[Statement, ...]
    means: str
    """What follows for who uses the model."""
    panels: tuple[Callable[[], Panel], ...] = ()
    computed: bool = False
    """Whether a computation was held against, and no measurement."""

    def judge(self) -> dict[str, Verdict]:
        """Every statement's verdict, by its id."""
        return {one.claim.id: one.judge() for one in self.statements}


def row_of(
    name: str,
    predictions: Mapping[str, Callable[[], Band | None]],
    *,
    statements: tuple[Statement, ...] = (),
    panels: tuple[Callable[[], Panel], ...] = (),
    paper: str = "measurements",
) -> Row:
    """A row of a data file; a prediction for each of its statements, by their ids.

    ``statements`` are those whose numbers are computed, and stand in no file.
    """
    data = data_of(paper)[name]
    stated: list[Statement] = []
    for entry in data.get("statements", ()):
        reasons = {key: entry[key] for key in ("undecided", "by_construction") if key in entry}
        claim = Claim(**{key: value for key, value in entry.items() if key not in reasons})
        stated.append(Statement(claim, predictions[claim.id], **reasons))
    return Row(
        name,
        data["title"],
        data["source"],
        data["conditions"],
        tuple(Input(*one) for one in data["inputs"]),
        (*stated, *statements),
        data["means"],
        panels,
        data.get("computed", False),
    )


def word_of(verdicts: dict[str, Verdict]) -> str:
    """The row's own: lost if any statement is, met if all are."""
    words = {one.word for one in verdicts.values()}
    return next(word for word in WORDS if word in words)
