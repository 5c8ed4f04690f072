"""The paper's checkable statements as data, and the rules by which a number meets one."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any, SupportsFloat

__all__ = ["Claim", "Errata", "Measurement", "Verdict", "claims", "errata", "study_data"]


@cache
def study_data() -> dict[str, Any]:
    """The data file: paper, definitions, claims and errata."""
    text = resources.files("thirdbody").joinpath("data/horng2022_claims.json").read_text("utf-8")
    return json.loads(text)


@dataclass(frozen=True)
class Measurement:
    """What a reading gives for a claim: numbers, or none and the reason."""

    values: tuple[float, ...]
    note: str = ""

    @classmethod
    def of(cls, *values: SupportsFloat, note: str = "") -> Measurement:
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
    """A claim judged in one reading."""

    measured: Measurement
    word: str
    """"pass", "fail", or "not reproduced" when the reading has no such quantity."""
    why: str

    @property
    def passed(self) -> bool:
        return self.word == "pass"


@dataclass(frozen=True)
class Claim:
    """One statement of the paper with what is measured and how it is judged."""

    id: str
    place: str
    statement: str
    quantity: str
    measure: str
    inputs: dict[str, Any]
    paper: str
    rule: dict[str, Any]
    remark: str = ""
    conflicts: tuple[str, ...] = ()
    """Claims that the printed equations cannot meet at the same time."""

    @property
    def allowed(self) -> str:
        """The rule in words."""
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
        kind, value, of = self.rule["kind"], self.rule["value"], self.rule.get("of", 0.0)
        if kind == "factor":
            return (value / of, value * of)
        if kind == "absolute":
            return (value - of, value + of)
        if kind == "relative":
            return (value - abs(value) * of, value + abs(value) * of)
        if kind == "range":
            slack, part = self.rule.get("slack", 0.0), self.rule.get("relative_slack", 0.0)
            widen = self.rule.get("of", 1.0)
            low, high = value[0] / widen, value[1] * widen
            return (low * (1 - part) - slack, high * (1 + part) + slack)
        # the strict limits move by the smallest step
        return {
            "at_most": (-math.inf, value),
            "at_least": (value, math.inf),
            "below": (-math.inf, math.nextafter(value, -math.inf)),
            "above": (math.nextafter(value, math.inf), math.inf),
        }[kind]

    def judge(self, measured: Measurement) -> Verdict:
        """Compare with the rule."""
        if not measured.exists:
            return Verdict(measured, "not reproduced", measured.note or "no such quantity")
        low, high = self.interval()
        good = all(low <= value <= high for value in measured.values)
        why = f"{measured.text}; allowed {self.allowed}"
        if measured.note:
            why += f" ({measured.note})"
        return Verdict(measured, "pass" if good else "fail", why)


@dataclass(frozen=True)
class Errata:
    """One slip of the paper and what the readings do about it."""

    erratum: int
    where: str
    printed: str
    used: str
    why: str
    applied: str


@cache
def claims() -> tuple[Claim, ...]:
    """All statements in the order of the paper."""
    return tuple(
        Claim(**{**entry, "conflicts": tuple(entry.get("conflicts", ()))})
        for entry in study_data()["claims"]
    )


@cache
def errata() -> tuple[Errata, ...]:
    """The errata that bear on the figures."""
    return tuple(Errata(**entry) for entry in study_data()["errata"])


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
