"""Loops behind the chance that dust carries a load, compiled: `contact_probability`, `connector`.

They stand apart because what they need loads slowly, and few studies ask for them. No sum in them
may change its order, so that every processor gives the same digits.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numba import njit

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["add_numbers_below", "expand_sum"]


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
def add_numbers_below(
    loads: Array, x: Array, each: Array, reach: Array, eps: Array, load: Array, out: Array
) -> None:
    """Add to out how many particles carry at most these loads [N], which rise.

    A particle of class i is squeezed by ε where ``load[k] = f/x²`` over ``eps[k]`` says so, and
    ``each[i]`` of its class lie in the way per unit of ``reach[i]``, which is ε at the middle.
    """
    top = len(load) - 1
    whole = np.zeros(len(loads))  # classes that are wholly below from this load on
    for i in range(len(x)):
        if reach[i] <= 0.0:
            continue
        size = x[i] * x[i]
        k = 0
        for j in range(len(loads)):
            p = loads[j] / size
            step = 1
            while k + step <= top and load[k + step] <= p:  # the next load may be near, or far
                k += step
                step *= 2
            while step > 1:
                step //= 2
                if k + step <= top and load[k + step] <= p:
                    k += step
            if k == top:
                whole[j] += each[i] * reach[i]
                break
            if p < load[0]:
                squeeze = eps[0]
            else:
                slope = (eps[k + 1] - eps[k]) / (load[k + 1] - load[k])
                squeeze = eps[k] + slope * (p - load[k])
            out[j] += each[i] * min(squeeze, reach[i])
    below = 0.0
    for j in range(len(loads)):
        below += whole[j]
        out[j] += below
