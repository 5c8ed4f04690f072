"""Loops behind the chance that dust carries a load, compiled: `contact_probability`, `connector`.

They stand apart because what they need loads slowly, and few studies ask for them. No sum in them
may change its order, so that every processor gives the same digits.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numba import njit

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["add_numbers_below", "expand_sum", "fill_squeezes", "sum_squeezes"]


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


@njit(cache=True, error_model="numpy", nogil=True)
def find_cell(p: float, load: Array, k: int) -> int:
    """The last place of a table, not before k, whose load is at most p; -1 below all of them."""
    top = len(load) - 1
    if k < 0:
        if p < load[0]:
            return -1
        k = 0
    step = 1
    while k + step <= top and load[k + step] <= p:  # the next load may be near, or far
        k += step
        step *= 2
    while step > 1:
        step //= 2
        if k + step <= top and load[k + step] <= p:
            k += step
    return k


@njit(cache=True, error_model="numpy", nogil=True)
def squeeze_below(p: float, k: int, eps: Array, load: Array) -> float:
    """Squeeze ε at a load over x² p [Pa], in cell k of a table that is linear between its rows."""
    if k < 0 or k == len(load) - 1:
        return eps[max(k, 0)]
    return eps[k] + (eps[k + 1] - eps[k]) / (load[k + 1] - load[k]) * (p - load[k])


@njit(cache=True, error_model="numpy", nogil=True)
def sum_below(p: float, k: int, eps: Array, load: Array, sums: Array) -> float:
    r"""The integral of ``squeeze_below`` over ln p, from the first row of the table [1]."""
    if k < 0:
        return sums[0] - eps[0] * math.log(load[0] / p)
    if k == len(load) - 1:
        return sums[k] + eps[k] * math.log(p / load[k])
    slope = (eps[k + 1] - eps[k]) / (load[k + 1] - load[k])
    rest = (eps[k] - slope * load[k]) * math.log(load[k + 1] / p) + slope * (load[k + 1] - p)
    return sums[k + 1] - rest


@njit(cache=True, error_model="numpy", nogil=True)
def sum_squeezes(eps: Array, load: Array) -> Array:
    """``sum_below`` at the rows of a table; 0 where the load is 0."""
    sums = np.zeros(len(load))
    for k in range(1, len(load)):
        if load[k - 1] > 0.0 and load[k] > load[k - 1]:
            slope = (eps[k] - eps[k - 1]) / (load[k] - load[k - 1])
            log = math.log(load[k] / load[k - 1])
            sums[k] = (eps[k - 1] - slope * load[k - 1]) * log + eps[k] - eps[k - 1]
        sums[k] += sums[k - 1]
    return sums


@njit(cache=True, error_model="numpy", nogil=True)
def fill_squeezes(
    loads: Array, low: float, high: float, eps: Array, load: Array, sums: Array, out: Array
) -> None:
    r"""Mean squeeze of particles between two sizes [m] under loads that rise [N], into out.

    .. math:: \frac1{\ln(b/a)}\int_a^b \varepsilon(f/x^2)\,d\ln x

    with the squeeze ε(p) of ``squeeze_below``, and the ``sums`` of ``sum_squeezes``.
    """
    top = len(load) - 1
    first = last = -1  # cells of the smallest particle, which is squeezed most, and the largest
    width = 2 * math.log(high / low)
    before = 0.0
    for j in range(len(loads)):
        p, q = loads[j] / low**2, loads[j] / high**2
        first, last = find_cell(p, load, first), find_cell(q, load, last)
        if last == top:
            out[j:] = eps[top]
            return
        if width == 0.0 or p == 0.0:
            mean = squeeze_below(p, first, eps, load)
        else:
            over = sum_below(p, first, eps, load, sums) - sum_below(q, last, eps, load, sums)
            mean = over / width
        before = max(before, mean)  # rounding never makes it fall
        out[j] = before


@njit(cache=True, error_model="numpy", nogil=True)
def add_numbers_below(
    loads: Array, low: Array, high: Array, each: Array, reach: Array,
    eps: Array, load: Array, sums: Array, out: Array,
) -> None:  # fmt: skip
    """Add to out how many particles carry at most these loads [N], which rise.

    Particles of class i have sizes from ``low[i]`` to ``high[i]``, are squeezed as
    ``fill_squeezes`` says, and ``each[i]`` of them lie in the way per unit of ``reach[i]``, which
    is ε at the middle.
    """
    squeezes = np.empty(len(loads))
    for i in range(len(low)):
        if reach[i] <= 0.0:
            continue
        fill_squeezes(loads, low[i], high[i], eps, load, sums, squeezes)
        for j in range(len(loads)):
            out[j] += each[i] * min(squeezes[j], reach[i])
