"""Loops behind the chance that dust carries a load, compiled: `contact_probability`, `connector`.

They stand apart because what they need loads slowly, and few studies ask for them. No sum in them
may change its order, so that every processor gives the same digits.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numba import njit

from ..quantities.carried import takes_units

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["add_numbers_below", "expand_sum", "fill_squeezes", "tabulate_squeezes"]


@njit(cache=True, error_model="numpy", nogil=True)
def expand_sum(weight: Array, last: int, large: float, g: Array) -> int:
    r"""Masses of a compound Poisson sum, in the place of g; how often they were scaled down.

    .. math:: j\,g_j = \sum_{i=1}^{\min(j, K)} w_i\,g_{j-i}, \qquad w_i = N\,i\,m_i

    with the masses m of one term (Panjer 1981, ASTIN Bulletin 12, 22,
    doi:10.1017/S0515036100006796). No term is negative, so that nothing cancels.

    Parameters
    ----------
    weight : array (n,)
        w_i at places 0 to n − 1 [1].
    last : int
        The last place K with a weight above 0.
    large : float
        All masses are divided by it when one exceeds it.
    g : array (n,)
        The mass at place 0, then zeros; holds the masses afterwards.
    """
    n = len(g)
    scaled = 0
    for i in range(n):
        if i > 0:
            g[i] /= i
        if g[i] > large:
            scaled += 1
            for k in range(n):
                g[k] /= large
        here = g[i]
        for j in range(1, min(last + 1, n - i)):
            g[i + j] += weight[j] * here
    return scaled


LOAD, LOG, RATE, REST, SUM = range(5)
"""Columns of a table of squeezes."""
SAME = 1e-12
"""Loads that differ by less, relatively, are one."""


@takes_units
def tabulate_squeezes(eps: Array, load: Array) -> Array:
    r"""Squeezes ε as a function that is linear in the load p between its rows, with its integral.

    .. math:: \varepsilon = r_k\,p + s_k, \qquad \int\varepsilon\,d\ln p

    Parameters
    ----------
    eps : array (n,)
        Squeezes ε [1].
    load : array (n,)
        Loads over x² p that never fall, from 0 on [Pa].

    Returns
    -------
    array (m, 5)
        Load, its logarithm, r and s from there on, and the integral up to there. Rows with
        the same load, but for rounding, are one, at which ε jumps. The logarithm of a load of 0
        is 0, and is not used.
    """
    rises = np.diff(load) > SAME * load[1:]
    arrives, leaves = eps[np.append(True, rises)], eps[np.append(rises, True)]
    load = load[np.append(True, rises)]
    rate = np.append((arrives[1:] - leaves[:-1]) / np.diff(load), 0.0)
    rest = leaves - rate * load
    log = np.log(np.where(load > 0, load, 1.0))
    integrals = rest[:-1] * np.diff(log) + arrives[1:] - leaves[:-1]
    sums = np.cumsum(np.append(0.0, np.where(load[:-1] > 0, integrals, 0.0)))
    return np.ascontiguousarray(np.transpose([load, log, rate, rest, sums]))


@njit(cache=True, error_model="numpy", nogil=True)
def find_row(p: float, table: Array, k: int) -> int:
    """The last row of a table, not before k, whose load is at most p."""
    top = len(table) - 1
    step = 1
    while k + step <= top and table[k + step, LOAD] <= p:  # the next load may be near, or far
        k += step
        step *= 2
    while step > 1:
        step //= 2
        if k + step <= top and table[k + step, LOAD] <= p:
            k += step
    return k


@njit(cache=True, error_model="numpy", nogil=True)
def sum_below(p: float, log: float, k: int, table: Array) -> float:
    """The integral of the squeeze over ln p up to a load p over x² [Pa], in row k of a table."""
    if k == len(table) - 1:
        return table[k, SUM] + table[k, REST] * (log - table[k, LOG])
    up = k + 1
    rest = table[k, REST] * (table[up, LOG] - log) + table[k, RATE] * (table[up, LOAD] - p)
    return table[up, SUM] - rest


@njit(cache=True, error_model="numpy", nogil=True)
def fill_squeezes(
    loads: Array, logs: Array, low: float, high: float, table: Array, out: Array
) -> None:
    r"""Mean squeeze of particles between two sizes [m] under loads that rise [N], into out.

    .. math:: \frac1{\ln(b/a)}\int_a^b \varepsilon(f/x^2)\,d\ln x

    Parameters
    ----------
    loads, logs : array (n,)
        Loads f from 0 on [N], and their logarithms.
    low, high : float
        The sizes a and b [m], which may be equal.
    table : array (m, 5)
        Of `tabulate_squeezes`, whose first load is 0.
    out : array (n,)
        Squeezes [1].
    """
    top = len(table) - 1
    first = last = 0  # rows of the smallest particle, which is squeezed most, and the largest
    width = 2 * math.log(high / low)
    before = 0.0
    for j in range(len(loads)):
        p, q = loads[j] / low**2, loads[j] / high**2
        first, last = find_row(p, table, first), find_row(q, table, last)
        if last == top:
            out[j:] = table[top, REST]
            return
        if width == 0.0 or p == 0.0:
            mean = table[first, RATE] * p + table[first, REST]
        else:
            log = logs[j] - 2 * math.log(low)
            over = sum_below(p, log, first, table) - sum_below(q, log - width, last, table)
            mean = over / width
        before = max(before, mean)  # rounding never makes it fall
        out[j] = before


@njit(cache=True, error_model="numpy", nogil=True)
def add_numbers_below(
    loads: Array, logs: Array, low: Array, high: Array, in_the_way: Array, reach: Array,
    table: Array, out: Array,
) -> None:  # fmt: skip
    """Add to out how many particles carry at most these loads [N], which rise.

    Particles of class i have sizes from ``low[i]`` to ``high[i]``, are squeezed as
    `fill_squeezes` says, and ``in_the_way[i]`` of them lie in the way per unit of
    ``reach[i]``, which is ε at the middle.
    """
    squeezes = np.empty(len(loads))
    for i in range(len(low)):
        if reach[i] <= 0.0:
            continue
        fill_squeezes(loads, logs, low[i], high[i], table, squeezes)
        for j in range(len(loads)):
            out[j] += in_the_way[i] * min(squeezes[j], reach[i])
