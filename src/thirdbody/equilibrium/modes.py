"""Contact modes, the shares of the real area that separate them, and what became of each load."""

from __future__ import annotations

from enum import StrEnum
from typing import Literal

from ..errors import InvalidValue, Mistake, Problem

__all__ = [
    "Basis",
    *("EPS_1", "EPS_2", "FAINT", "HYBRID", "P_S", "S_S", "WINDOW"),
    *("CriticalStatus", "need_shares"),
]

P_S, HYBRID, S_S = MODES = "p-s", "hybrid", "s-s"
EPS_1, EPS_2 = 0.02, 0.05
"""Default shares that separate the contact modes: read-off resolution, and the paper's 95 %."""
Basis = Literal["area", "load"]
"""Whose shares are compared with them."""
WINDOW = (1e-8, 1e-2)
"""Loads F* between which critical loads are sought."""
FAINT = 1e-12
"""The load F* that counts as nothing."""


class CriticalStatus(StrEnum):
    """Status of a critical load; each member is the text that results and JSON hold.

    Examples
    --------
    >>> CriticalStatus("always p-s").name, CriticalStatus.FOUND == "found"
    ('ALWAYS_P_S', True)
    """

    FOUND = "found"
    JUMP = "jump"
    NONE = "none"
    NOT_CARRIED = "none: no load of the window can be carried"
    NEVER_P_S = "never p-s"
    ALWAYS_S_S = "always s-s"
    """It lies below every load searched, as in the one before."""
    ALWAYS_P_S = "always p-s"
    NEVER_S_S = "never s-s"
    """It lies above every load searched, as in the one before."""

    __repr__ = str.__repr__


def need_shares(**shares: float) -> None:
    """Refuse thresholds that are no shares.

    Raises
    ------
    InvalidValue
        A sentence for each that does not lie between 0 and 1.
    """
    problems = [
        Problem(name, "must lie between 0 and 1", repr(share), code=Mistake.RANGE)
        for name, share in shares.items()
        if not 0 < share < 1
    ]
    if problems:
        raise InvalidValue(*problems)
