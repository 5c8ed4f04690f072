"""How many contacts there are, and how hard they press."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..contact.output import AbstractOutput, Column
from ..errors import Note
from ..quantities.say import percent
from ..quantities.value import quantity

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from ..contact.evaluation import Solved

    Array = NDArray[np.float64]

__all__ = ["Counts"]

MERGED = 0.01
"""Real area of asperities from which they merge; most spots were measured at P/M = 7.5e-3
(O'Callaghan and Probert 1970)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Counts(AbstractOutput):
    r"""Contacts per area, load of one, and mean real pressure.

    .. math:: n = \sum n_i, \qquad \bar f = F/n, \qquad \bar p = F/A

    Parameters
    ----------
    A_n : float, optional
        Nominal area of the contact [m²]: a warning says where it holds less than one contact, or
        less than one of asperities or of particles alone that carry more than 1 % of the load.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel), outputs=tb.outputs.Counts(),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> state = tb.solve(contact, pressure=5e6)
    >>> f"{state.outputs['n_ss']:.3g} asperities a square metre"
    '3.84e+09 asperities a square metre'
    """

    A_n: float | None = quantity(
        "A_n", "m^2", "nominal area of the contact", default=None, gt=0, hint="1 mm² is 1e-6"
    )

    name = "counts"
    title = "Number of contacts"
    year = 2026
    citation = "thirdbody: number and mean load of the contacts of a solved state"
    provenance = "derived"
    valid_range = "wherever the contact is"
    columns = {
        "n_ss": Column("n_ss", "1/m^2", "asperities in contact"),
        "n_sa": Column("n_sa", "1/m^2", "loaded particles"),
        "f_ss": Column("f_ss", "N", "mean load of an asperity in contact"),
        "f_sa": Column("f_sa", "N", "mean load of a loaded particle"),
        "p_ss": Column("p_ss", "Pa", "mean real pressure on asperities"),
        "p_sa": Column("p_sa", "Pa", "mean real pressure of particles on surface 1"),
    }

    def of(self, state: Solved) -> dict[str, Array]:
        n_ss = state.total(lambda spots: spots.load > 0)
        F_ss = state.total(lambda spots: spots.load)
        A_ss = state.total(lambda spots: spots.area)
        n_sa = state.total_of_particles(lambda spots: spots.load > 0)
        F_sa = state.total_of_particles(lambda spots: spots.load)
        A_sa = state.total_of_particles(lambda spots: spots.areas[0])
        with np.errstate(invalid="ignore", divide="ignore"):
            return {
                "n_ss": n_ss,
                "n_sa": n_sa,
                "f_ss": F_ss / n_ss,
                "f_sa": F_sa / n_sa,
                "p_ss": F_ss / A_ss,
                "p_sa": F_sa / A_sa,
            }

    def warnings(self, state: Solved, values: Mapping[str, Array]) -> list[str]:
        most = float(np.nanmax(state.total(lambda spots: spots.area), initial=0.0))
        if most <= MERGED:
            return []
        what = (
            f"asperities are counted one by one, and they cover {percent(most, digits=2)} of the "
            f"surface: beyond some {percent(MERGED, digits=1)} spots merge, and fewer are found"
        )
        action = "count them on pressed maps (`explicit`)"
        return [Note(what, code=f"{self.name}.merged", action=action)]
