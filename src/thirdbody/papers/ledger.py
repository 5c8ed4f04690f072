"""What every ledger of a paper is made of: a claim, what was measured, and the verdict."""

from __future__ import annotations

import math
import tomllib
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from typing import Any, SupportsFloat

__all__ = [
    "NO_SOURCE",
    "OWN",
    "REPORTED",
    "SEEN",
    "WORDS",
    "Claim",
    "Measurement",
    "Verdict",
    "claims_of",
    "data_of",
    "number",
]

WORDS = ("pass", "fail", "not reproduced", "not sourced", "own result")
"""Every verdict there is."""
SEEN, REPORTED = "abstract seen", "reported"
"""Standing of a statement read in an abstract of the authors, or in another paper about theirs."""
NO_SOURCE = "not obtainable"
"""Standing of a statement that the paper may make, and whose wording could not be found."""
OWN = "found here"
"""Standing of a number that no paper states, such as the load at which a trend ends."""


@dataclass(frozen=True)
class Measurement:
    """What a reading gives for a claim: numbers, or none and the reason."""

    values: tuple[float, ...]
    note: str = ""

    @classmethod
    def from_values(cls, *values: SupportsFloat, note: str = "") -> Measurement:
        return cls(tuple(float(value) for value in values), note)

    @classmethod
    def absent(cls, why: str) -> Measurement:
        return cls((), why)

    @property
    def exists(self) -> bool:
        return bool(self.values) and all(math.isfinite(value) for value in self.values)

    @property
    def text(self) -> str:
        """The numbers for a table."""
        return " … ".join(number(value) for value in self.values) if self.exists else "–"


@dataclass(frozen=True)
class Verdict:
    """A claim judged in one reading; made by `Claim.judge`.

    Examples
    --------
    >>> from thirdbody.papers.horng2022 import Verdict
    >>> from thirdbody.papers.ledger import Measurement
    >>> Verdict(Measurement.from_values(0.9), "pass", "0.9; allowed < 1").is_pass
    True
    """

    measured: Measurement
    word: str
    """One of `WORDS`: "not reproduced" when the reading has no such quantity, "not sourced" when
    the statement itself could not be found, whatever was measured."""
    why: str

    @property
    def is_pass(self) -> bool:
        """Whether the word is "pass"."""
        return self.word == "pass"

    def as_json(self) -> dict[str, Any]:
        """Numbers, word and reason."""
        values = list(self.measured.values) if self.measured.exists else None
        return {"values": values, "verdict": self.word, "why": self.why}


@dataclass(frozen=True)
class Claim:
    """One statement of a paper with what is measured and how it is judged.

    Attributes
    ----------
    id, place, statement : str
        Its key, where it stands in the paper, and what it says.
    quantity, measure : str
        What is measured, in words, and the name of the function that does.
    inputs : dict
        Arguments of that function.
    paper : str
        The number printed.
    rule : dict
        ``kind``, ``value`` and allowances; {} where nothing is judged.

    Examples
    --------
    >>> from thirdbody.papers.ledger import Measurement
    >>> from thirdbody.papers.horng2022.claims import claims
    >>> claim = claims()[0]
    >>> claim.judge(Measurement.absent("no such curve")).word
    'not reproduced'
    """

    id: str
    place: str = ""
    statement: str = ""
    quantity: str = ""
    measure: str = ""
    inputs: dict[str, Any] = field(default_factory=dict)
    paper: str = ""
    rule: dict[str, Any] = field(default_factory=dict)
    remark: str = ""
    conflicts: tuple[str, ...] = ()
    """Claims that the printed equations cannot meet at the same time."""
    standing: str = "read"
    """How well the statement is known: "read", `SEEN`, `REPORTED`, `NO_SOURCE`, or `OWN`."""

    @property
    def rule_words(self) -> str:
        """The rule in words; "" without one."""
        if not self.rule:
            return ""
        kind, value = self.rule["kind"], self.rule["value"]
        if kind == "factor":
            return f"within a factor {self.rule['of']:g} of {number(value)}"
        if kind == "absolute":
            return f"within {self.rule['of']:g} of {number(value)}"
        if kind == "relative":
            return f"within {100 * self.rule['of']:g} % of {number(value)}"
        if kind == "range":
            low, high = self.interval()
            return f"{number(low)} to {number(high)}"
        words = {"at_most": "≤", "at_least": "≥", "below": "<", "above": ">"}
        return f"{words[kind]} {value:.5g}".replace("-", "−")

    def interval(self) -> tuple[float, float]:
        """Allowed interval of every number measured."""
        if not self.rule:
            return (-math.inf, math.inf)
        kind, value, of = self.rule["kind"], self.rule["value"], self.rule.get("of", 0.0)
        if kind == "factor":
            return (value / of, value * of)
        if kind == "absolute":
            return (value - of, value + of)
        if kind == "relative":
            return (value - abs(value) * of, value + abs(value) * of)
        if kind == "range":
            slack, relative = self.rule.get("slack", 0.0), self.rule.get("relative_slack", 0.0)
            widen = self.rule.get("of", 1.0)
            low, high = value[0] / widen, value[1] * widen
            return (low * (1 - relative) - slack, high * (1 + relative) + slack)
        # the strict limits move by the smallest step
        return {
            "at_most": (-math.inf, value),
            "at_least": (value, math.inf),
            "below": (-math.inf, math.nextafter(value, -math.inf)),
            "above": (math.nextafter(value, math.inf), math.inf),
        }[kind]

    def judge(self, measured: Measurement) -> Verdict:
        """Compare with the rule."""
        word = {NO_SOURCE: "not sourced", OWN: "own result"}.get(self.standing)
        if not measured.exists:
            return Verdict(measured, word or "not reproduced", measured.note or "no such quantity")
        low, high = self.interval()
        good = all(low <= value <= high for value in measured.values)
        why = f"{measured.text}; allowed {self.rule_words}" if self.rule else measured.text
        if measured.note:
            why += f" ({measured.note})"
        return Verdict(measured, word or ("pass" if good else "fail"), why)


@cache
def data_of(paper: str) -> dict[str, Any]:
    """The data file of a paper: what it states, and where that is from."""
    file = resources.files("thirdbody").joinpath(f"data/papers/{paper}.toml")
    return tomllib.loads(file.read_text("utf-8"))


@cache
def claims_of(paper: str) -> tuple[Claim, ...]:
    """The statements of a paper, in the order of its data file.

    Examples
    --------
    >>> len(claims_of("horng2022"))
    84
    """
    entries = data_of(paper)["claims"]
    return tuple(
        Claim(**entry | {"conflicts": tuple(entry.get("conflicts", ()))}) for entry in entries
    )


def number(value: float) -> str:
    """Three or four digits, loads as powers of ten."""
    if not math.isfinite(value):
        return "–"
    if abs(value) < 1e-12:
        return "0"
    if not 1e-3 <= abs(value) < 1e4:
        mantissa, exponent = f"{value:.2e}".split("e")
        return f"{mantissa}e{int(exponent)}".replace("-", "−")
    return f"{value:.4g}".replace("-", "−")
