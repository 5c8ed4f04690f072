"""The verdicts of every reading of the paper."""

from __future__ import annotations

from dataclasses import dataclass

from ..ledger import Verdict
from .claims import claims

__all__ = ["Ledger"]


@dataclass(frozen=True)
class Ledger:
    """Verdicts of every reading, by reading name and claim id."""

    verdicts: dict[str, dict[str, Verdict]]
    paper_booking: dict[str, dict[str, Verdict]]
    """The consistent readings once more, with the particle area that the paper would book."""

    def total(self, name: str, *, paper_booking: bool = False) -> int:
        """Claims that a reading meets."""
        table = self.paper_booking if paper_booking else self.verdicts
        return sum(verdict.is_pass for verdict in table[name].values())

    def changed_by_booking(self, name: str) -> tuple[list[str], list[str]]:
        """Claims gained and lost when the particle area is booked as in the paper."""
        verdicts, booked = self.verdicts[name], self.paper_booking[name]
        gained = [key for key in verdicts if booked[key].is_pass and not verdicts[key].is_pass]
        lost = [key for key in verdicts if verdicts[key].is_pass and not booked[key].is_pass]
        return gained, lost

    def can_meet_both(self, one: str, other: str) -> bool:
        """Whether some reading meets both claims."""
        return any(
            scored[one].is_pass and scored[other].is_pass for scored in self.verdicts.values()
        )

    def met_by(self, names: list[str]) -> tuple[int, int]:
        """Claims met by all of several readings, and by at least one of them."""
        passed = [[self.verdicts[name][claim.id].is_pass for name in names] for claim in claims()]
        return sum(map(all, passed)), sum(map(any, passed))
