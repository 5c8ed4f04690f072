"""What the exponentials of a state cost: no quadrature over these nodes can be quicker.

Asperities are summed by series in the separation and in ω_1/σ_s, so they may beat this floor;
particles on a rough seat are summed over nodes.

python benchmarks/floor.py
"""

from __future__ import annotations

import math
import time

import numpy as np
from numba import njit
from numpy.typing import NDArray

from thirdbody.contact.asperity_sums import gaussian_rule
from thirdbody.equilibrium.compiled import batch as engine
from thirdbody.equilibrium.compiled import layout, machine

Array = NDArray[np.float64]


@njit(fastmath=machine.SUM, nogil=True)
def _total(x: Array) -> float:
    total = 0.0
    for i in range(len(x)):
        total += machine.exp(x[i])
    return total


def nanoseconds() -> float:
    """Processor time of one `machine.exp` in a loop of vectors over the first cache, best of 30."""
    x = np.random.default_rng(0).uniform(-40, 0, 1_000)
    _total(x)
    best = math.inf
    for _ in range(30):
        start = time.process_time_ns()
        for _ in range(2_000):
            _total(x)
        best = min(best, time.process_time_ns() - start)
    return best / 2_000 / len(x)


def exponentials(states: engine.States, h: Array) -> Array:
    """Exponentials of one evaluation of the load by quadrature at separations h [σ_s]: (N,).

    Nodes within reach, where the exponent has not fallen by 36.
    """
    rows = states.rows
    total = np.ones(len(h))
    for m, interface in enumerate(rows.interfaces[: len(h)]):
        reach = (math.sqrt(h[m] * h[m] + 72.0) - h[m]) / rows.w[m]
        total[m] += np.searchsorted(gaussian_rule(rows.law, math.frexp(rows.w[m])[1] - 1).y, reach)
        d = interface["centre"] + interface["sigma_s"] * h[m]
        for part in rows.parts[m]:
            if part["kind"] != layout.ROUGH_NODES:
                continue
            gap = (d + part["offset"]) / part["size"]
            reach = layout.SEAT_REACH * part["width"]
            at, n = part["gaps"]
            first, count = part["sizes"]
            gaps = rows.rules[at : at + (layout.AT + 1) * n].reshape(-1, n)[layout.AT]
            for size in rows.rules[first + count : first + 2 * count]:
                low, high = np.searchsorted(gaps, [(gap - reach) / size, (gap + reach) / size])
                total[m] += high - low
    return total


if __name__ == "__main__":
    print(f"{nanoseconds():.2f} ns an exponential")
