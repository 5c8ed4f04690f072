r"""The ledger: every particle that came is in the oil or has gone, by mass.

.. math:: M(t) + \sum_{out} C_{out}(t) = M(0) + \sum_{in} C_{in}(t)
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...quantities.record import Record

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["Ledger"]


def __dir__() -> list[str]:
    return sorted(__all__)


IN_OIL = "oil"
"""Name of the oil in the table of flows."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Ledger(Record):
    """Mass that came and mass that went, since the beginning.

    Attributes
    ----------
    in_oil : array (T,)
        Mass of the particles in the oil [kg].
    came : dict of str to array (T,)
        By where it came from [kg].
    went : dict of str to array (T,)
        By where it went [kg].
    begin : float, optional
        Mass in the oil at the beginning [kg], where the first time is a later one.
    """

    in_dict = (("in the oil", "in_oil"), "came", "went", "residual")
    in_oil: Array
    came: Mapping[str, Array]
    went: Mapping[str, Array]
    begin: float | None = None

    def over_time(self) -> dict[str, Array]:
        """Every column, by its name."""
        return {"in the oil": self.in_oil, **self.came, **self.went}

    def rows(self) -> list[tuple[str, str, float]]:
        """From where, to where, how much over the history [kg]; the largest first."""
        rows = [(name, IN_OIL, float(values[-1])) for name, values in self.came.items()]
        rows += [(IN_OIL, name, float(values[-1])) for name, values in self.went.items()]
        return sorted(rows, key=lambda row: -row[2])

    @property
    def residual(self) -> float:
        """What is in no account, over the largest of them, at the worst time [1]."""
        came = sum(self.came.values(), np.zeros_like(self.in_oil))
        went = sum(self.went.values(), np.zeros_like(self.in_oil))
        begin = self.in_oil[0] if self.begin is None else self.begin
        off = self.in_oil - begin + went - came
        largest = np.max([self.in_oil, np.full_like(off, begin), came, went])
        return float(np.max(np.abs(off)) / largest) if largest > 0 else 0.0
