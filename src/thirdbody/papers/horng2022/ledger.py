"""The ledger: every statement of the paper, measured in every reading.

One function measures one kind of statement; the data file names it for each claim and gives its
inputs (σ and x_a in nm). Orders are measured as ratios of neighbours: an order "falls" when the
largest ratio of a value to the one before it is below 1.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from ..ledger import Measurement, Verdict
from . import areas, loads, separations  # noqa: F401  (their measures enter MEASURES)
from .claims import claims
from .measures import MEASURES
from .readings import Curves

__all__ = ["score"]


def score(curves: Curves, progress: Callable[[], None] = lambda: None) -> dict[str, Verdict]:
    """The verdict on every claim in one reading, by claim id.

    Parameters
    ----------
    curves : Curves
        Of the reading.
    progress : callable, optional
        Called after each claim.

    Returns
    -------
    dict of str to Verdict

    Examples
    --------
    It takes seconds: every curve of the paper is computed::

        verdicts = score(Curves(READINGS["published"]))
        sum(verdict.is_pass for verdict in verdicts.values())  # 66 of 84
    """
    verdicts: dict[str, Verdict] = {}
    for claim in claims():
        if claim.measure == "all_of":
            measured = all_of(curves, verdicts, **claim.inputs)
        else:
            measured = MEASURES[claim.measure](curves, **claim.inputs)
        verdicts[claim.id] = claim.judge(measured)
        progress()
    return verdicts


def all_of(
    curves: Curves,
    verdicts: dict[str, Verdict],
    claims: list[str],
    measure: str | None = None,
    inputs: dict[str, object] | None = None,
    limit: float = math.inf,
) -> Measurement:
    """How many of several claims hold, and of one more measurement at or below a limit."""
    failed = [name for name in claims if not verdicts[name].is_pass]
    held = len(claims) - len(failed)
    if measure is not None:
        extra = MEASURES[measure](curves, **(inputs or {}))
        good = extra.exists and extra.values[0] <= limit
        held += good
        if not good:
            failed.append(f"{measure.replace('_', ' ')} = {extra.text}")
    return Measurement.from_values(held, note=f"not: {', '.join(failed)}" if failed else "")
