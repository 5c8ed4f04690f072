"""How much of a fluid is particles, by number, mass or volume."""

from __future__ import annotations

import math
import re
from typing import Literal, NamedTuple, get_args

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.carried import takes_units
from ...quantities.units import not_among, say, to_si
from ..distributions import Distribution

__all__ = ["OIL_DENSITY", "Concentration", "concentration", "particles_in"]

Amount = Literal["number", "mass", "volume", "mass per volume"]
"""What a concentration counts."""

OIL_DENSITY = 870.0
"""Density of a mineral lubricating oil [kg/m³], where none is given; they lie around 850 to 900."""


class Concentration(NamedTuple):
    """How much of the fluid is particles; made by `concentration`.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.dust.concentration("50 ppm")
    Concentration(amount=5e-05, by='mass')
    """

    amount: float
    """n [1/m³], w [1], φ [1] or c [kg/m³]."""
    by: Amount
    """Which of them: "number", "mass", "volume" or "mass per volume"."""


_PARTS: tuple[tuple[Amount, float, str], ...] = (
    ("mass", 100, r"(?:wt|mass|m|w)[ .-]?%|%[ ]?(?:wt|w/w|by (?:mass|weight)|mass)"),
    ("volume", 100, r"(?:vol|v)[ .-]?%|%[ ]?(?:vol|v/v|by volume|volume)"),
    ("mass", 1e6, r"ppm(?:[ ]?(?:wt|w|m|mass|by mass))?|mg/kg"),
    ("volume", 1e6, r"ppm[ ]?(?:vol|v|by volume)|ppmv"),
)
"""Parts of a whole: of what, how many make the whole, and how their unit is written."""
_DENSITIES: tuple[tuple[Amount, str], ...] = (("number", "1/m^3"), ("mass per volume", "kg/m^3"))
_SAID = '"0.1 wt%", "0.02 vol%", "50 ppm" (by mass), "10 mg/L" or "1e6 / mL"'


@takes_units
def concentration(value: float | str, by: Amount = "number") -> Concentration:
    """A concentration as it is written: "0.1 wt%", "50 ppm", "1e6 / mL".

    Parameters
    ----------
    value : float or str
        A number is in SI: n [1/m³], a fraction [1], or kg/m³, after ``by``. A string says itself
        what it is; ppm alone is by mass (mg/kg), as oil laboratories use it.
    by : {"number", "mass", "volume", "mass per volume"}, optional
        What a plain number is.

    Returns
    -------
    Concentration

    Raises
    ------
    InvalidValue
        One sentence that begins with the value.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.dust.concentration("0.1 wt%"), tb.dust.concentration("5000 / mL")
    (Concentration(amount=0.001, by='mass'), Concentration(amount=5000000000.0, by='number'))
    """
    if by not in get_args(Amount):
        raise InvalidValue(not_among("by", by, get_args(Amount)))
    if isinstance(value, str):
        amount, by = _read_concentration(value)
    else:
        amount = to_si(value, "1")
    if not (math.isfinite(amount) and amount >= 0):
        raise InvalidValue(
            f"{say(value)} must be a finite amount of particles, 0 or more", code=Mistake.RANGE
        )
    if by in ("mass", "volume") and amount >= 1:
        raise InvalidValue(
            f"{say(value)} is {amount:g} of the whole {by}; a fraction must stay below 1 "
            "(100 %), e.g. 0.1 wt% is 0.001",
            code=Mistake.RANGE,
        )
    return Concentration(amount, by)


def _read_concentration(text: str) -> tuple[float, Amount]:
    number = re.match(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?)\s*(.*?)\s*$", text)
    if not number or not number[2]:
        cause = "" if number is None else " has no unit:"
        code = Mistake.UNIT if cause else Mistake.FORM
        raise InvalidValue(f"{say(text)}{cause} must be a concentration, {_SAID}", code=code)
    amount, unit = float(number[1]), number[2]
    for kind, whole, pattern in _PARTS:
        if re.fullmatch(pattern, unit, re.IGNORECASE):
            return amount / whole, kind
    if unit == "%":
        raise InvalidValue(
            f'{say(text)} is of mass or of volume? write "wt%" or "vol%"', code=Mistake.UNIT
        )
    for kind, si in _DENSITIES:
        try:
            return to_si(text, si), kind
        except InvalidValue:
            continue
    raise InvalidValue(
        f"{say(text)} is not a concentration; it must be written {_SAID}", code=Mistake.UNIT
    )


@takes_units
def particles_in(
    found: Concentration,
    diameter: Distribution,
    *,
    particle_density: float | None = None,
    oil_density: float = OIL_DENSITY,
) -> float:
    r"""Particles per volume of fluid n [1/m³].

    .. math:: \phi = \frac{w/\rho_p}{w/\rho_p + (1-w)/\rho_f} = \frac{c}{\rho_p}, \qquad
              n = \frac{\phi}{\langle \pi x^3/6 \rangle}

    Parameters
    ----------
    found : Concentration
        w [1], c [kg/m³], φ [1] or n itself.
    diameter : Distribution
        Sizes x by number [m].
    particle_density, oil_density : float, optional
        ρ_p, ρ_f [kg/m³]; ρ_p is needed for a mass.

    Returns
    -------
    float

    Raises
    ------
    InvalidValue
        A mass without ρ_p, or a density that is not positive.

    Examples
    --------
    >>> import thirdbody as tb
    >>> sizes = tb.distributions.Monodisperse(mean=1e-6)
    >>> n = tb.dust.particles_in(tb.dust.concentration("0.1 wt%"), sizes, particle_density=2650)
    >>> f"{n:.4g}"
    '6.274e+14'
    """
    for name, density in (("particle_density", particle_density), ("oil_density", oil_density)):
        if density is not None and not (math.isfinite(density) and density > 0):
            raise InvalidValue(
                Problem(
                    name, "must be > 0 [kg/m^3]; water is 1000", repr(density), code=Mistake.RANGE
                )
            )
    amount, by = found
    if by == "number":
        return amount
    if by in ("mass", "mass per volume"):
        if particle_density is None:
            rule = (
                "is missing: a concentration by mass needs the density of the particles or of "
                "their material [kg/m^3], e.g. 2650 or '2.65 g/cm^3' for quartz"
            )
            raise InvalidValue(Problem("particle_density", rule, code=Mistake.MISSING))
        if by == "mass":
            solid = amount / particle_density
            amount = solid / (solid + (1 - amount) / oil_density)
        else:
            amount /= particle_density
    if amount >= 1:
        raise InvalidValue(
            f"the particles would fill {amount:.3g} of the volume of the fluid", code=Mistake.FULL
        )
    return amount / (math.pi / 6 * diameter.moment(3))
