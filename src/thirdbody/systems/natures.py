"""What the particles of each population are: do they conduct, dent or get squashed, do they break?

Of a population, not of a state: one particle that is pressed until the surfaces meet.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ..errors import InvalidValue
from ..laws.particle.tension import tension
from ..populations.conduction import conducts
from ..populations.strength import WeibullStrength
from ..quantities.record import Record

if TYPE_CHECKING:
    from ..contact.contact import Contact
    from ..populations.particles import Particles

__all__ = ["Nature", "natures"]

WHOLE = 1.0
"""Squeeze over the diameter of a particle where the surfaces meet."""
Pressed = Literal["dents", "dents and is squashed", "is squashed", "dents the softer surface"]
Breaks = Literal["breaks", "would break", "stays whole", "not known"]
MOST, LITTLE = 0.8, 0.2
"""Part of the squeeze that goes into the surfaces above which a particle dents, and below which it
is squashed; between them it does both."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Nature(Record):
    """What the particles of one population are; made by `natures`.

    Attributes
    ----------
    name : str
    material : str
        Its name; empty for one without.
    conducts : bool or None
        Whether they conduct a current (`thirdbody.populations.conduction.conducts`).
    pressed : str
        "dents", "is squashed", "dents and is squashed", or "dents the softer surface".
    sinks : float or None
        Part of the squeeze that goes into the surfaces [1]; None where their law does not say it,
        and hardness alone decides.
    breaks : str
        "breaks" as the study asks; "would break", which it does not ask; "stays whole", all of
        them; "not known" where the material has no strength.
    breaks_from : float or None
        Size from which on most have broken by then [m]; None where it is not known.
    """

    name: str
    material: str
    conducts: bool | None
    pressed: Pressed
    sinks: float | None
    breaks: Breaks
    breaks_from: float | None


def natures(contact: Contact) -> tuple[Nature, ...]:
    """What the particles of each population of a contact are.

    Parameters
    ----------
    contact : Contact

    Returns
    -------
    tuple of Nature
        One a population, in their order.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["100Cr6"]
    >>> dust = tb.Particles(material=tb.materials["quartz"], areal_density=1e6,
    ...                     diameter=tb.distributions.Monodisperse(mean=10e-6))
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel), particles=dust,
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> (found,) = natures(contact)
    >>> found.conducts, found.pressed, found.breaks
    (False, 'dents and is squashed', 'would break')
    """
    return tuple(
        _nature(contact, population, i) for i, population in enumerate(contact.populations)
    )


def _nature(contact: Contact, dust: Particles, i: int) -> Nature:
    law = contact.law_of(dust)
    one: Any = None
    if law.knows_each:  # else it knows all particles together alone
        one = law.one(surfaces=contact.surfaces, particle=dust.material)
    sinks = _sinks(one)
    since = _breaks_from(dust, one) if law.knows_each and law.breakable else None
    return Nature(
        name=dust.name or dust.material.name or f"particles {i + 1}",
        material=dust.material.name,
        conducts=conducts(dust),
        pressed=_by_hardness(contact, dust) if sinks is None else _by_sink(sinks),
        sinks=sinks,
        breaks=_breaks(dust, since),
        breaks_from=since,
    )


def _sinks(one: Any) -> float | None:
    """Part of the whole squeeze that goes into both surfaces; None where no law says so."""
    if not all(getattr(one, "knows_sink", (False,))):
        return None
    depths = one.indentations(np.array([WHOLE]))
    return float(sum(side[0] for side in one.sinks(depths))) / WHOLE


def _by_sink(sinks: float) -> Pressed:
    return "dents" if sinks > MOST else "is squashed" if sinks < LITTLE else "dents and is squashed"


def _by_hardness(contact: Contact, dust: Particles) -> Pressed:
    pair = contact.surfaces
    harder = [dust.material.H > body.H for body in (pair.first, pair.second)]
    return "dents" if all(harder) else "dents the softer surface" if any(harder) else "is squashed"


def _breaks_from(dust: Particles, one: object) -> float | None:
    """Size at which a particle has its strength as tension by the time the surfaces meet [m]."""
    try:
        strength = dust.strength or WeibullStrength.of(dust.material)
    except InvalidValue:
        return None
    met = tension(one, dust.material.nu, strength.confinement).greatest_so_far(np.array([WHOLE]))
    stress = float(met[0])
    if strength.b == 0:
        since = 0.0 if stress > strength.sigma_0 else math.inf
    else:
        since = strength.x_0 * (strength.sigma_0 / stress) ** (1 / strength.b)
    return max(since, strength.least(dust.material))


def _breaks(dust: Particles, since: float | None) -> Breaks:
    if since is None:
        return "not known"
    if not since < dust.diameter.support[1]:
        return "stays whole"
    return "would break" if dust.strength is None else "breaks"
