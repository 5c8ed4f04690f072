"""``thirdbody.life``: how dirty an oil becomes, and what acts in it, over time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ...errors import InvalidValue, Problem, tell_of_range
from ...quantities.carried import takes_units
from .circuit import OilCircuit
from .history import LifeHistory
from .oil_history import run_oil_history
from .until import Until

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["life"]


@takes_units
def life(
    *,
    oil: OilCircuit,
    duration: float,
    until: Until | Sequence[Until] = (),
    times: ArrayLike | None = None,
) -> LifeHistory:
    r"""The history of an oil circuit.

    .. math:: \frac{d(V n_{km})}{dt} = r_{km} + q_{in} n^{in}_{km}
              - \Big(q_{out} + \sum_f Q_f \bar P_{f,k} + A_s w_{km}\Big) n_{km}

    Parameters
    ----------
    oil : OilCircuit
        Its volume, dirt, ingress, filters.
    duration : float
        How long at most [s].
    until : Until or sequence of Until, optional
        What it waits for: ``tb.until.iso4406("21/19/16")``, ``tb.until.filter_full()``.
    times : array, optional
        At which the oil is kept [s]; evenly and in the logarithm by default, and at every event.

    Returns
    -------
    LifeHistory

    Raises
    ------
    InvalidValue
        What is no circuit, or a duration in which it runs dry.

    Warns
    -----
    RangeWarning
        Filters beyond their data sheets.

    Examples
    --------
    >>> import thirdbody as tb
    >>> quartz = tb.materials["quartz"]
    >>> oil = tb.OilCircuit(
    ...     volume=0.2, start=tb.OilDirt.from_iso4406("18/16/13", material=quartz),
    ...     ingress=tb.Ingress.from_counts(sizes=[4e-6, 6e-6, 14e-6], counts=[1e6, 3e5, 1e4],
    ...                                    material=quartz),
    ...     filters=tb.Filter(sizes=(4e-6, 10e-6), betas=(75.0, 1000.0), flow=1e-3, capacity=0.05))
    >>> history = tb.life(oil=oil, duration=3.6e6)
    >>> history.codes[-1], history.steady()[0].code
    ('17/15/11', '17/15/11')
    """
    if not isinstance(oil, OilCircuit):
        raise InvalidValue(Problem("oil", "must be an OilCircuit", repr(oil)))
    waits = (until,) if isinstance(until, Until) else tuple(until)
    if wrong := [each for each in waits if not isinstance(each, Until)]:
        rule = 'must hold what a history waits for, e.g. tb.until.iso4406("21/19/16")'
        raise InvalidValue(Problem("until", rule, repr(wrong[0])))
    found = run_oil_history(oil, duration=duration, until=waits, times=times)
    for note in found.warnings:
        tell_of_range(note)
    return found
