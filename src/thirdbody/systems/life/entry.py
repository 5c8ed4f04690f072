r"""What an oil brings into a film: layers of oil, bounds on size, and the entry ratio from dents.

.. math:: \eta_{km} = \varepsilon\,\langle\max(h, x)\rangle_k\,n_{km}, \qquad
          x \le h + 2\mu^2 R'

or h alone, as `thirdbody.systems.film_conditions.Entrainment` has it. What passes the contacts per
time is η times their width and the speed of the oil.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.carried import takes_units
from ..oil_particles import FilmParticles
from .size_classes import SizeClasses

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["entry_ratio_from_dents", "oil_layer"]


def __dir__() -> list[str]:
    return sorted(__all__)


@takes_units
def oil_layer(
    classes: SizeClasses, *, film: float, largest: float = math.inf, height: str = "size"
) -> Array:
    """Mean layer of oil that brings the particles of each class [m], (K,).

    Parameters
    ----------
    classes : SizeClasses
    film : float
        Height of the film h [m].
    largest : float, optional
        Size above which none is dragged in [m].
    height : {"size", "film"}, optional
        max(h, x) for a particle of size x, or h for all.

    Returns
    -------
    array
        Times particles per volume of oil, those that stand in the contact per area.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.life.entry import oil_layer
    >>> one = tb.oil.SizeClasses(edges=(1e-6, 1.0001e-6))
    >>> [float(oil_layer(one, film=h)[0].round(9)) for h in (3e-7, 5e-6)]
    [1e-06, 5e-06]
    """
    low, high = classes.ends
    end = np.clip(largest, low, high)
    whole = low**-3 - high**-3
    if height == "film":
        return film * (low**-3 - end**-3) / whole
    # numbers ∝ x⁻⁴: ∫ max(h, x) x⁻⁴ dx, from the lower end to the film and on to the end
    split = np.clip(film, low, end)
    below = film * (low**-3 - split**-3) / whole
    above = 1.5 * (split**-2 - end**-2) / whole
    return below + above


@takes_units
def entry_ratio_from_dents(
    count: float, *, area: float, overrollings: float, oil: FilmParticles, side: int = 1
) -> float:
    r"""Entry ratio of the particles of an oil from dents counted in a surface.

    .. math:: N_d = \frac{1-e^{-N\eta a}}{a}, \qquad \eta = \varepsilon\,\eta_{\varepsilon=1}

    Parameters
    ----------
    count : float
        Dents counted [1].
    area : float
        Of the surface that was looked at [m²].
    overrollings : float
        N [1].
    oil : FilmParticles
        The oil and its film; its own entry ratio does not matter.
    side : int, optional
        Surface 1 or 2.

    Returns
    -------
    float
        ε [1]; the inverse of `FilmParticles.after`. All dents are counted that stay at all:
        count as small ones as the oil holds, or leave the small particles out of it.

    Raises
    ------
    InvalidValue
        More dents than a surface can show, none that the oil could make, or numbers below 0.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.oil_particles import FilmParticles
    >>> steel = tb.materials["S45C"]
    >>> oil = FilmParticles.from_iso4406("18/16/13", surfaces=tb.MaterialPair(steel, steel),
    ...                                  material=tb.materials["SiO2"], film=0.5e-6, entry=0.02)
    >>> seen = float(oil.after(1e6)) * 1e-6
    >>> round(tb.oil.entry_ratio_from_dents(seen, area=1e-6, overrollings=1e6, oil=oil), 12)
    0.02
    """
    values = {"count": count, "area": area, "overrollings": overrollings}
    if wrong := [
        Problem(
            name,
            f"must be finite and {'>= 0' if name == 'count' else '> 0'}",
            repr(value),
            code=Mistake.RANGE,
        )
        for name, value in values.items()
        if not math.isfinite(value) or value < 0 or (value == 0 and name != "count")
    ]:
        raise InvalidValue(*wrong)
    all_enter = oil.replace(entry=1.0).dents(side)
    if all_enter.number == 0:
        rule = ": no particle of this oil dents the surface: it gives no entry ratio"
        raise InvalidValue(Problem("", rule, code=Mistake.BEYOND))
    covered = count / area * all_enter.area
    if covered >= 1:
        rule = (
            f"dents of {all_enter.area:.3g} m² each cover more than the {area:g} m² looked at: so "
            "many cannot be told apart"
        )
        raise InvalidValue(Problem("count", rule, f"{count:g}", code=Mistake.BEYOND))
    per_pass = -math.log1p(-covered) / (all_enter.area * overrollings)
    return per_pass / all_enter.number
