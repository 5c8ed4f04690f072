"""Horng et al. 2022, Lubricants 10(7), 164: every figure, and a ledger of what it states.

The paper prints its equations with slips and leaves parameters open. `READINGS` are eight ways to
fill the gaps; each is scored against the paper's 84 checkable statements, and one of them draws
the figures.
"""

from ..ledger import Claim, Verdict
from .claims import claims, errata
from .figures import PANELS
from .ledger import score
from .readings import READINGS, Curves, Reading
from .study import Summary, reproduce

__all__ = [
    "PANELS",
    "READINGS",
    "Claim",
    "Curves",
    "Reading",
    "Summary",
    "Verdict",
    "claims",
    "errata",
    "reproduce",
    "score",
]
