"""``thirdbody.life``: how dirty an oil becomes, and what acts in it, over time."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

from ...contact.contact import Contact
from ...errors import InvalidValue, Mistake, Problem, tell_of_range
from ...quantities.carried import takes_units
from .circuit import OilCircuit
from .conditions import (
    ContactInUse,
    DryConditions,
    FilmConditions,
    is_positive,
    read_conditions,
)
from .contact_history import DryHistory
from .contact_life import run_dry_history, run_film_history
from .debris import Debris
from .history import LifeHistory
from .kept_rates import KeptRates, plain_inputs
from .oil_history import need_duration, run_oil_history
from .surfaces import RunningIn
from .until import ContactUntil, Until

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["life"]


def __dir__() -> list[str]:
    return sorted(__all__)


@overload
def life(
    contact: Contact | None = None,
    *,
    oil: OilCircuit,
    duration: float,
    until: Until | Sequence[Until] = ...,
    times: ArrayLike | None = ...,
    debris: Debris | None = ...,
    running_in: RunningIn | None = ...,
    stays: float = ...,
    worn_area: tuple[float, float] | None = ...,
    keep: Path | str | None = ...,
    **conditions: Any,
) -> LifeHistory: ...


@overload
def life(
    contact: Contact,
    *,
    duration: float,
    until: Until | Sequence[Until] = ...,
    times: ArrayLike | None = ...,
    debris: Debris | None = ...,
    running_in: RunningIn | None = ...,
    stays: float = ...,
    worn_area: tuple[float, float] | None = ...,
    keep: Path | str | None = ...,
    **conditions: Any,
) -> DryHistory: ...


@takes_units
def life(
    contact: Contact | None = None,
    *,
    oil: OilCircuit | None = None,
    duration: float,
    until: Until | Sequence[Until] = (),
    times: ArrayLike | None = None,
    debris: Debris | None = None,
    running_in: RunningIn | None = None,
    stays: float = 0.0,
    worn_area: tuple[float, float] | None = None,
    keep: Path | str | None = None,
    **conditions: Any,
) -> LifeHistory | DryHistory:
    r"""The history of an oil circuit, of contacts in it, or of a dry contact.

    .. math:: \frac{d(V n_{km})}{dt} = r_{km} + q_{in} n^{in}_{km}
              - \Big(q_{out} + \sum_f Q_f \bar P_{f,k} + A_s w_{km}\Big) n_{km}

    Parameters
    ----------
    contact : Contact, optional
        What the particles act in, with `outputs.Friction` and `outputs.Wear`. In an oil it has no
        particles of its own; dry, its particles are there at the beginning.
    oil : OilCircuit, optional
        Its volume, dirt, ingress, filters. Without it the contact is dry.
    debris : Debris, optional
        Sizes and hardness of what wear leaves behind; needed where anything wears.
    running_in : RunningIn, optional
        How roughness falls with wear; without it σ stays.
    stays : float, optional
        Part of the particles sunk deeper than half their radius that stays embedded [1].
    worn_area : (float, float), optional
        Area of each surface that is worn in turn [m²]; that of the contact without it.
    keep : path-like, optional
        A file that keeps the rates of a history with a contact; the same call goes on with it, to
        the same numbers.
    **conditions
        Of contacts in a film ``conjunction`` (films.Point, films.Line), ``lubricant``
        (films.Oil), ``load`` of one [N], ``speed`` of entrainment [m/s], ``entry_ratio`` ε [1], and
        if need be ``slide_roll`` (0), ``contacts`` (1), ``particle_friction`` μ, which bounds the
        sizes dragged in, ``entry_height`` ("size" or "film"), ``film``, ``hertz``, ``strengths``
        by material. Of a dry contact ``pressure`` [Pa], ``sliding_speed`` [m/s], ``length`` along
        the motion [m], ``area`` [m²], ``loss``, the part of what leaves that does not come round
        again [1], ``moving``, the surface (1 or 2) that carries what it holds out of the contact,
        and if need be ``arrivals`` (Ingress with a rate, into the whole contact), ``classes``.
    duration : float
        How long at most [s].
    until : Until or sequence of Until, optional
        What it waits for: ``tb.oil.until.iso4406("21/19/16")``, ``tb.oil.until.filter_full()``.
    times : array, optional
        At which the oil is kept [s]; evenly and in the logarithm by default, and at every event.

    Returns
    -------
    LifeHistory
        With a contact a `ContactHistory`, of a dry one a `DryHistory`.

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
    >>> oil = tb.oil.OilCircuit(
    ...     volume=0.2, start=tb.oil.OilDirt.from_iso4406("18/16/13", material=quartz),
    ...     ingress=tb.oil.Ingress.from_counts(sizes=[4e-6, 6e-6, 14e-6], counts=[1e6, 3e5, 1e4],
    ...                                        material=quartz),
    ...     filters=tb.oil.Filter(sizes=(4e-6, 10e-6), betas=(75.0, 1000.0), flow=1e-3,
    ...                           capacity=0.05))
    >>> history = tb.life(oil=oil, duration=3.6e6)
    >>> history.codes[-1], history.steady()[0].code
    ('17/15/11', '17/15/11')
    """
    several = isinstance(until, Iterable) and not isinstance(until, Until | str)
    waits: tuple[Until, ...] = tuple(until) if several else (until,)  # type: ignore[assignment,arg-type]
    if wrong := [goal for goal in waits if not isinstance(goal, Until)]:
        rule = 'must hold what a history waits for, e.g. tb.oil.until.iso4406("21/19/16")'
        raise InvalidValue(Problem("until", rule, repr(wrong[0]), code=Mistake.KIND))
    if oil is None and contact is None:
        raise InvalidValue(
            Problem("oil", "or contact must be given, or both", code=Mistake.MISSING)
        )
    if oil is not None and not isinstance(oil, OilCircuit):
        raise InvalidValue(Problem("oil", "must be an OilCircuit", repr(oil), code=Mistake.KIND))
    shared: dict[str, Any] = {"duration": duration, "until": waits, "times": times}
    of_contact: dict[str, Any] = {
        "debris": debris, "running_in": running_in, "stays": stays, "worn_area": worn_area
    }  # fmt: skip
    history: LifeHistory | DryHistory
    if contact is None:
        assert oil is not None
        contact_options = of_contact | {"keep": keep}
        if lost := [*conditions, *(name for name, value in contact_options.items() if value)]:
            raise InvalidValue(Problem(lost[0], "needs a contact", code=Mistake.IDLE))
        if idle := [goal for goal in waits if isinstance(goal, ContactUntil)]:
            raise InvalidValue(Problem("until", "needs a contact", idle[0].name, code=Mistake.IDLE))
        history = run_oil_history(oil, **shared)
    else:
        use = ContactInUse(contact=contact, **of_contact)
        _check_parts(use)
        need_duration(duration)
        inputs = {"contact": contact, "oil": oil} | conditions | of_contact | shared
        file = None if keep is None else Path(keep)
        if oil is not None:
            film = read_conditions(FilmConditions, conditions)
            kept = KeptRates(file, plain_inputs(inputs))
            history = run_film_history(use, film, oil=oil, kept=kept, **shared)
        else:
            of_oil = [goal for goal in waits if not isinstance(goal, ContactUntil)]
            if of_oil:
                raise InvalidValue(
                    Problem("until", "needs an oil", of_oil[0].name, code=Mistake.IDLE)
                )
            dry = read_conditions(DryConditions, conditions)
            kept = KeptRates(file, plain_inputs(inputs))
            history = run_dry_history(use, dry, kept=kept, **shared)
    for note in history.warnings:
        tell_of_range(note)
    return history


def _check_parts(use: ContactInUse) -> None:
    """Refuse a share that is none, and areas that are none."""
    problems = []
    if not 0 <= use.stays <= 1:
        problems.append(
            Problem("stays", "must be from 0 to 1 [1]", repr(use.stays), code=Mistake.RANGE)
        )
    area = use.worn_area
    if area is not None and not (len(area) == 2 and all(is_positive(value) for value in area)):
        problems.append(
            Problem("worn_area", "must be two areas above 0 [m^2]", repr(area), code=Mistake.RANGE)
        )
    if problems:
        raise InvalidValue(*problems)
