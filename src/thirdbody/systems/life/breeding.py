"""Who breeds whom in a contact: the reproduction number, and why it is 0 or has no value."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ...quantities.carried import takes_units
from ...quantities.say import value_of
from .film_loop import FilmLoop
from .linear_flow import reproduction
from .loop import Loop

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["births_and_losses", "reproduction_of", "why_none", "why_unknown"]


def births_and_losses(loop: Loop, y: Array) -> tuple[Array, Array]:
    """𝒢 and 𝓛 of a state [1/s] (J, J), in the order of the loop."""
    rates = loop.rates(y, loop.find_gap(y).d)
    pool = loop.layout[loop.pool]
    return rates.births, rates.births - rates.matrix[pool, pool]


def _breeders(births: Array, losses: Array) -> Array:
    """Which numbers count: what is removed, and what is never removed and breeds."""
    return np.any(births > 0, axis=0) | (np.diag(losses) > 0)


def reproduction_of(births: Array, losses: Array) -> float:
    """R_0; NaN where some particles that breed are never removed.

    Particles that are never removed and breed nothing have no part in it.

    Examples
    --------
    >>> births = np.array([[1e-3, 0.0], [1e-3, 0.0]])
    >>> reproduction_of(births, np.diag([2e-3, 0.0]))
    0.5
    """
    if not np.any(births):
        return 0.0
    some = np.ix_(*2 * (np.flatnonzero(_breeders(births, losses)),))
    if float(np.min(np.linalg.eigvals(losses[some]).real)) <= 0:
        return math.nan
    return reproduction(losses[some], births=births[some])


def why_none(loop: Loop, y: Array) -> str:
    """Why debris breeds no debris, as a clause."""
    setting, tables = loop.setting, loop.tables
    if setting.debris[0] < 0:
        return "nothing is worn off, as the wear coefficients are 0"
    if setting.sliding_speed == 0:
        return "the surfaces roll without sliding (slide_roll = 0), and what rolls cuts no groove"
    wear: Any = next((output for output in tables.contact.outputs if output.name == "wear"), None)
    if wear is not None and not (wear.f_ab or wear.f_roll or wear.K_sa):
        return "no particle takes anything off a surface: f_ab, f_roll and K_sa are 0"
    pair = tables.contact.surfaces
    hardest = max(tables.kinds[i].material.H for i in setting.debris)
    if hardest <= min(pair.first.H, pair.second.H) * (1 + 1e-9):
        return (
            "it is no harder than the surfaces and is squashed between them; "
            "life.debris.hardness says if it is harder"
        )
    largest = float(tables.classes.ends[1][np.flatnonzero(setting.shares > 0)[-1]])
    d = loop.find_gap(y).d
    gap, film = "gap", d
    if isinstance(loop, FilmLoop):
        gap, film = "film", loop.film_of(d, loop.sigma_of(y))
    if largest <= film:
        return (
            f"the {gap} of {value_of(film, 'm', 3)} is higher than the largest debris, "
            f"{value_of(largest, 'm', 3)}, which touches no surface"
        )
    return "what of it is pressed cuts no groove"


@takes_units
def why_unknown(births: Array, losses: Array, edges: Array, materials: tuple[str, ...]) -> str:
    """Which particles breed and are never removed, as a clause.

    Parameters
    ----------
    births, losses : array (J, J)
        Class by class, and in each material by material.
    edges : array (K + 1,)
        Of the classes [m].
    materials : tuple of str
    """
    stays = np.any(births > 0, axis=0) & (np.diag(losses) <= 0)
    if not np.any(stays):
        return "some particles are never taken out"
    last = int(np.flatnonzero(stays)[-1])
    top = float(edges[last // len(materials) + 1])
    who = materials[last % len(materials)]
    return (
        f"{who} up to {value_of(top, 'm', 3)} is never taken out, and each of its particles goes "
        "on wearing the surfaces"
    )
