"""Conditions that a contact of a history runs under: in a film, and dry."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, TypeVar

from ...errors import InvalidValue, Mistake, Problem
from .ingress import Ingress

if TYPE_CHECKING:
    from ...contact.contact import Contact
    from ...populations.materials import Material
    from ...populations.strength import WeibullStrength
    from ..conjunctions import Line, Oil, Point
    from ..film_formulas import AbstractFilm
    from .debris import Debris
    from .size_classes import SizeClasses
    from .surfaces import RunningIn

__all__ = ["ContactInUse", "DryConditions", "FilmConditions", "is_positive", "read_conditions"]


@dataclass(frozen=True, eq=False, kw_only=True)
class ContactInUse:
    """A contact of a history, in a film or dry, and what its use does to the surfaces."""

    contact: Contact
    debris: Debris | None
    """What wear leaves behind; needed where anything wears."""
    running_in: RunningIn | None
    stays: float
    """Part of the particles that sit deeper than half their radius and stay embedded [1]."""
    worn_area: tuple[float, float] | None
    """Of each surface, that is worn in turn [m²]; None for that of the contact."""


@dataclass(frozen=True, eq=False, kw_only=True)
class FilmConditions:
    """Conditions of alike contacts in an oil film; those with a default may be left out."""

    conjunction: Point | Line
    lubricant: Oil
    load: float
    """Of one contact [N]."""
    speed: float
    """Mean entrainment speed u [m/s]."""
    entry_ratio: float
    """ε, particles that enter over those in the oil that passes [1]."""
    slide_roll: float = 0.0
    contacts: float = 1.0
    """How many contacts there are."""
    particle_friction: float | None = None
    """μ of a particle on the surfaces, which bounds the sizes dragged in [1]; None for no bound."""
    entry_height: str = "size"
    """"size" or "film", as in `oil_layer`."""
    film: AbstractFilm | None = None
    hertz: str = "mean"
    strengths: Mapping[Material, WeibullStrength] = field(default_factory=dict)


@dataclass(frozen=True, eq=False, kw_only=True)
class DryConditions:
    """Conditions of a dry or greased contact; those with a default may be left out."""

    pressure: float
    """p [Pa]."""
    sliding_speed: float
    """v_s [m/s]."""
    length: float
    """L of the contact along the motion [m]."""
    area: float
    """Of the contact [m²]."""
    loss: float
    """1 − ρ_r, part of what leaves the contact that does not come round again [1]."""
    moving: int
    """The surface, 1 or 2, that carries what is held in it out of the contact."""
    arrivals: Sequence[Ingress] = ()
    """Into the whole contact; one alone is made a tuple of it."""
    classes: SizeClasses | None = None

    def __post_init__(self) -> None:
        one = isinstance(self.arrivals, Ingress)
        object.__setattr__(self, "arrivals", (self.arrivals,) if one else tuple(self.arrivals))


Conditions = TypeVar("Conditions", FilmConditions, DryConditions)

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
"""What each condition is that cannot be left out."""
POSITIVE = ("load", "speed", "contacts", "pressure", "sliding_speed", "length", "area")
PARTS = ("loss",)


def is_positive(value: object) -> bool:
    """Whether this is a finite number above zero."""
    return isinstance(value, int | float) and math.isfinite(value) and value > 0


def read_conditions(of: type[Conditions], named: Mapping[str, Any]) -> Conditions:
    """Conditions by their names as a record, those left out as usual.

    Parameters
    ----------
    of : {FilmConditions, DryConditions}
    named : mapping

    Raises
    ------
    InvalidValue
        Every condition that is missing, unknown or beyond its range.
    """
    allowed_names = [f.name for f in fields(of)]
    problems = [
        Problem(
            name,
            f"is no condition of this contact; they are {', '.join(allowed_names)}",
            code=Mistake.UNKNOWN,
        )
        for name in named
        if name not in allowed_names
    ]
    problems += [
        Problem(name, f"is missing: {MEANINGS[name]}", code=Mistake.MISSING)
        for name in allowed_names
        if name in MEANINGS and name not in named
    ]
    checks: list[tuple[tuple[str, ...], Callable[[Any], bool], str]] = [
        (POSITIVE, is_positive, "must be finite and > 0"),
        (PARTS, lambda value: isinstance(value, int | float) and 0 <= value <= 1, "must be 0 to 1"),
        (("entry_ratio",), is_positive, "must be finite and > 0 [1]"),
        (("moving",), lambda value: value in (1, 2), "must be 1 or 2"),
        (("entry_height",), lambda value: value in ("size", "film"), "must be 'size' or 'film'"),
        (("slide_roll",), lambda v: v == 0 or is_positive(v), "must be finite and >= 0 [1]"),
        (("particle_friction",), lambda v: v is None or is_positive(v), "must be > 0, or None"),
    ]
    for names, holds, rule in checks:
        problems += [
            Problem(name, rule, repr(named[name]), code=Mistake.RANGE)
            for name in names
            if name in named and not holds(named[name])
        ]
    if problems:
        raise InvalidValue(*problems)
    return of(**named)
