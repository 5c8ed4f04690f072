"""``thirdbody.life``: how dirty an oil becomes, and what acts in it, over time."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

from ...contact.contact import Contact
from ...errors import InvalidValue, Mistake, Problem, tell_of_range
from ...quantities.carried import takes_units
from .circuit import OilCircuit
from .contact_history import DryHistory
from .contact_life import run_dry_history, run_film_history
from .debris import Debris
from .history import LifeHistory
from .ingress import Ingress
from .kept_rates import KeptRates, plain_inputs
from .oil_history import need_duration, run_oil_history
from .surfaces import RunningIn
from .until import ContactUntil, Until

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["life"]

FILM: dict[str, object] = {
    "slide_roll": 0.0,
    "contacts": 1.0,
    "particle_friction": None,
    "entry_height": "size",
    "film": None,
    "hertz": "mean",
    "strengths": {},
}
"""Conditions of contacts in a film that may be left out."""
OF_FILM = ("conjunction", "lubricant", "load", "speed", "entry_ratio")
DRY: dict[str, object] = {"arrivals": (), "classes": None}
"""Conditions of a dry contact that may be left out."""
OF_DRY = ("pressure", "sliding_speed", "length", "area", "loss", "moving")
MEANINGS = {
    "conjunction": "the bodies, e.g. films.Point(R=10e-3)",
    "lubricant": "the oil in the film, e.g. films.Oil(eta=0.04, alpha=2e-8)",
    "load": "of one contact [N]",
    "speed": "of entrainment [m/s]",
    "entry_ratio": "particles that enter over those in the oil that passes [1]; nobody can predict "
    "it: count dents (entry_ratio_from_dents), or try it from 1e-3 to 1",
    "pressure": "[Pa]",
    "sliding_speed": "[m/s]",
    "length": "of the contact along the motion [m]",
    "area": "of the contact [m^2]",
    "loss": "part of what leaves the contact that does not come round again, 0 to 1 [1]",
    "moving": "the surface, 1 or 2, that carries what it holds out of the contact",
}
POSITIVE = ("load", "speed", "contacts", "pressure", "sliding_speed", "length", "area")
PARTS = ("loss",)


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
        What it waits for: ``tb.until.iso4406("21/19/16")``, ``tb.until.filter_full()``.
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
    >>> oil = tb.OilCircuit(
    ...     volume=0.2, start=tb.OilDirt.from_iso4406("18/16/13", material=quartz),
    ...     ingress=tb.Ingress.from_counts(sizes=[4e-6, 6e-6, 14e-6], counts=[1e6, 3e5, 1e4],
    ...                                    material=quartz),
    ...     filters=tb.Filter(sizes=(4e-6, 10e-6), betas=(75.0, 1000.0), flow=1e-3, capacity=0.05))
    >>> history = tb.life(oil=oil, duration=3.6e6)
    >>> history.codes[-1], history.steady()[0].code
    ('17/15/11', '17/15/11')
    """
    several = isinstance(until, Iterable) and not isinstance(until, Until | str)
    waits: tuple[Until, ...] = tuple(until) if several else (until,)  # type: ignore[assignment,arg-type]
    if wrong := [each for each in waits if not isinstance(each, Until)]:
        rule = 'must hold what a history waits for, e.g. tb.until.iso4406("21/19/16")'
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
    found: LifeHistory | DryHistory
    if contact is None:
        assert oil is not None
        given = of_contact | {"keep": keep}
        if lost := [*conditions, *(name for name, value in given.items() if value)]:
            raise InvalidValue(Problem(lost[0], "needs a contact", code=Mistake.IDLE))
        if idle := [each for each in waits if isinstance(each, ContactUntil)]:
            raise InvalidValue(Problem("until", "needs a contact", idle[0].name, code=Mistake.IDLE))
        found = run_oil_history(oil, **shared)
    else:
        _check_parts(of_contact)
        need_duration(duration)
        asked = {"contact": contact, "oil": oil} | conditions | of_contact | shared
        file = None if keep is None else Path(keep)
        if oil is not None:
            whole = _whole(conditions, OF_FILM, FILM)
            shared["kept"] = KeptRates(file, plain_inputs(asked))
            found = run_film_history(contact, oil=oil, **whole, **of_contact, **shared)
        else:
            of_oil = [each for each in waits if not isinstance(each, ContactUntil)]
            if of_oil:
                raise InvalidValue(
                    Problem("until", "needs an oil", of_oil[0].name, code=Mistake.IDLE)
                )
            whole = _whole(conditions, OF_DRY, DRY)
            arriving = whole["arrivals"]
            whole["arrivals"] = (arriving,) if isinstance(arriving, Ingress) else tuple(arriving)
            shared["kept"] = KeptRates(file, plain_inputs(asked))
            found = run_dry_history(contact, **whole, **of_contact, **shared)
    for note in found.warnings:
        tell_of_range(note)
    return found


def _check_parts(of_contact: Mapping[str, Any]) -> None:
    """Refuse a share that is none, and areas that are none."""
    problems = []
    if not 0 <= of_contact["stays"] <= 1:
        problems.append(
            Problem(
                "stays", "must be from 0 to 1 [1]", repr(of_contact["stays"]), code=Mistake.RANGE
            )
        )
    area = of_contact["worn_area"]
    if area is not None and not (len(area) == 2 and all(_positive(each) for each in area)):
        problems.append(
            Problem("worn_area", "must be two areas above 0 [m^2]", repr(area), code=Mistake.RANGE)
        )
    if problems:
        raise InvalidValue(*problems)


def _positive(value: object) -> bool:
    return isinstance(value, int | float) and math.isfinite(value) and value > 0


def _whole(
    conditions: Mapping[str, object], needed: Sequence[str], usual: Mapping[str, object]
) -> dict[str, Any]:
    """All conditions of a contact, those left out as usual."""
    problems = [
        Problem(
            name,
            f"is no condition of this contact; they are {', '.join((*needed, *usual))}",
            code=Mistake.UNKNOWN,
        )
        for name in conditions
        if name not in needed and name not in usual
    ]
    problems += [
        Problem(name, f"is missing: {MEANINGS[name]}", code=Mistake.MISSING)
        for name in needed
        if name not in conditions
    ]
    whole = {**usual, **conditions}
    checks: list[tuple[tuple[str, ...], Callable[[Any], bool], str]] = [
        (POSITIVE, _positive, "must be finite and > 0"),
        (PARTS, lambda value: isinstance(value, int | float) and 0 <= value <= 1, "must be 0 to 1"),
        (("entry_ratio",), _positive, "must be finite and > 0 [1]"),
        (("moving",), lambda value: value in (1, 2), "must be 1 or 2"),
        (("entry_height",), lambda value: value in ("size", "film"), "must be 'size' or 'film'"),
        (("slide_roll",), lambda v: v == 0 or _positive(v), "must be finite and >= 0 [1]"),
        (("particle_friction",), lambda v: v is None or _positive(v), "must be > 0, or None"),
    ]
    for names, holds, rule in checks:
        problems += [
            Problem(name, rule, repr(whole[name]), code=Mistake.RANGE)
            for name in names
            if name in conditions and not holds(whole[name])
        ]
    if problems:
        raise InvalidValue(*problems)
    return whole
