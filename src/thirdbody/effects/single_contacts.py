r"""One contact of a known area among many: with particles in the way, or without any.

Every contact of area A_n carries the load p A_n by itself. Without particles it comes to the clean
separation d_c. Particles lie at random, so that none of those that are larger than their gap there
lies in A_n with the probability

.. math:: w_0 = e^{-m}, \qquad m = A_n\,n_{sa}(d_c),

and then the contact is clean, whatever particles do in others. The state of a surface that shares
its load among all of its particles is that of no such contact. A quantity q is on average

.. math:: \bar q = w_0\,q_{clean}(p) + (1-w_0)\,q(p, c\,\eta_a), \qquad c = \frac{1}{1-e^{-m}},

the second term being a contact with the number of particles in the way that those contacts hold on
average which hold any: an estimate. Particles only hold the surfaces apart, so that the probability
that asperities close it is at least w_0 P_clean and at most P_clean.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..contact.evaluation import touching
from ..contact.interface import interface
from ..errors import InvalidValue

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from ..contact.contact import Contact
    from ..contact.evaluation import Solved, Solver

    Array = NDArray[np.float64]

__all__ = ["SingleContacts", "single_contacts"]

MANY = 50.0
"""Particles in the way from which no contact is without: exp(−50) = 2e-22."""
ONE = 1.0
"""Loaded particles in A_n below which it is chance which of them carry."""
FACTOR = 2.0
"""Bounds of a probability that lie further apart do not tell it."""
DIGITS = 2
"""Digits of the number of particles for which contacts with particles are solved."""


@dataclass(frozen=True, kw_only=True)
class SingleContacts:
    """Means over contacts with and without particles in the way: arrays (N,).

    Attributes
    ----------
    concerned : array of bool
        States whose A_n holds so few particles that it matters; the others are NaN below.
    values : dict
        Every column that was asked for, NaN where it is not known.
    low, high : array
        Between which the probability of closing lies.
    without : array
        The share of contacts with no particle in the way.
    clean : array
        The probability of closing of one that holds none.
    """

    concerned: NDArray[np.bool_]
    values: dict[str, Array]
    low: Array
    high: Array
    without: Array
    clean: Array


def single_contacts(
    output: Any, state: Solved, names: Sequence[str], closed: str, *, conduct: bool
) -> SingleContacts | None:
    """Columns of an output as means over contacts of its A_n; None where the state tells them.

    Parameters
    ----------
    output : AbstractOutput
        With an ``A_n`` and ``few``.
    state : Solved
        Under a load: contacts that share a separation need no means.
    names : sequence of str
        Columns that are means.
    closed : str
        The column that is the probability of closing.
    conduct : bool
        Whether particles close a contact too: then one in the way does.
    """
    contact, solver = state.contact, state.solver
    if output.A_n is None or solver is None or contact.two_body:
        return None
    crowd = np.ones_like(state.d) if state.crowd is None else state.crowd
    loaded = output.A_n * state.loaded_particles()
    few = np.flatnonzero(loaded < MANY)
    if not len(few):
        return None
    mean, columns = output.replace(few="mean"), (*names, closed)
    bare = contact.replace(particles=None, outputs=(mean,))
    d = solver.separation(bare, state.pressure[few])
    clean = solver.outputs(bare, d)
    count = touching(interface(contact), d)
    there = output.A_n * crowd[few] * count
    kept = ~(there >= MANY)
    few, there = few[kept], there[kept]
    if not len(few):
        return None
    clean = {name: values[kept] for name, values in clean.items()}
    rest = _with_particles(mean, contact, solver, state.pressure[few], crowd[few], there)
    without = np.exp(-there)
    sure = rest["n_sa"] * output.A_n >= ONE
    if conduct:
        rest[closed], sure = np.ones(len(few)), np.ones(len(few), bool)
    else:
        rest[closed] = np.minimum(rest[closed], clean[closed])
    low = without * clean[closed]
    high = np.where(sure, low + (1 - without) * rest[closed], clean[closed])
    low = np.where(sure, high, low)
    narrow = high <= FACTOR * low
    out = {}
    for name in columns:
        rest_share = np.where((1 - without) > 0, (1 - without) * rest[name], 0.0)
        out[name] = np.where(narrow, without * clean[name] + rest_share, np.nan)
    # where the estimate of the rest failed, and matters little, the least is given
    out[closed] = np.where(narrow & np.isnan(out[closed]), low, out[closed])

    def place_few(values: Array) -> Array:
        full = np.full_like(state.d, np.nan)
        full[few] = values
        return full

    return SingleContacts(
        concerned=np.isin(np.arange(len(state.d)), few),
        values={name: place_few(values) for name, values in out.items()},
        low=place_few(low),
        high=place_few(high),
        without=place_few(without),
        clean=place_few(clean[closed]),
    )


def _with_particles(
    output: Any, contact: Contact, solver: Solver, pressure: Array, crowd: Array, there: Array
) -> dict[str, Array]:
    """Columns of contacts that have a particle in the way; NaN where no such contact is solved."""
    with np.errstate(divide="ignore"):
        wanted = crowd / -np.expm1(-there)
    out = {name: np.full(len(there), np.nan) for name in (*output.columns, "n_sa")}
    size = 10.0 ** (np.floor(np.log10(np.where(np.isfinite(wanted), wanted, 1.0))) - DIGITS + 1)
    rounded = np.where(np.isfinite(wanted), np.round(wanted / size) * size, np.nan)
    for factor in np.unique(rounded[np.isfinite(rounded)]):
        which = np.flatnonzero(rounded == factor)
        try:
            more = contact.replace(
                outputs=(output,),
                particles=tuple(
                    population.replace(areal_density=factor * population.areal_density)
                    for population in contact.populations
                ),
            )
        except InvalidValue:  # so many do not find room: nothing is known of them
            continue
        d = solver.separation(more, pressure[which])
        solved = {**solver.outputs(more, d), "n_sa": touching(interface(more), d)}
        for name, values in out.items():
            values[which] = solved[name]
    return out
