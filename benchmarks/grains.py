"""Many loads of one contact with grains that are angular, squashed, or break, against spheres.

python benchmarks/grains.py
"""

from __future__ import annotations

import sys
import time
import warnings
from typing import Any

import numpy as np

import thirdbody as tb

COUNT = 200_000
BREAKING, TABLES = 50_000, 2.0
"""States a second of grains that break, and seconds for their tables, that are asked for."""
STEEL = tb.Material(E=206e9, nu=0.29, H=7.37e9)  # 60 HRC
KINDS: dict[str, dict[str, Any]] = {
    "spheres": {},
    "angular": {"shape": tb.grains.Angular(roundness=0.25, angle="35 deg")},
    "squashed": {"material": tb.Material(E=193e9, nu=0.29, H=1.36e9)},
    "breaking": {"strength": tb.grains.WeibullStrength.of(tb.materials["quartz"])},
}


def contact(kind: str) -> tb.Contact:
    """Grains of 5 to 40 µm between hardened steels."""
    dust: dict[str, Any] = {"material": tb.materials["quartz"], "areal_density": 1e7}
    dust["diameter"] = tb.distributions.PowerLaw(edges=(5e-6, 40e-6), counts=(1,), slopes=(3,))
    return tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL),
        roughness=tb.Roughness(sigma=50e-9, R=20e-6),
        particles=tb.Particles(**dust | KINDS[kind]),
    )


def measured(kind: str, count: int = COUNT) -> tuple[float, float, str]:
    """Seconds for the tables, states a second, and the engine."""
    case = contact(kind)
    start = time.process_time()
    tb.solve(case, d=5e-6)
    tables = time.process_time() - start
    loads = np.geomspace(1e4, 1e6, count)
    start = time.process_time()
    state = tb.solve(case, pressure=loads)
    rate = count / (time.process_time() - start)
    if set(np.unique(state.status)) != {"ok"}:
        raise RuntimeError(f"{kind}: not every state was solved")
    return tables, rate, state.engine


def main() -> int:
    warnings.simplefilter("ignore", tb.errors.RangeWarning)
    measured("spheres", 10_000)  # compiled before the clock runs
    found = {kind: measured(kind) for kind in KINDS}
    for kind, (tables, rate, engine) in found.items():
        print(f"{kind:10} tables {tables:.2f} s, {rate:9.0f} states/s ({engine})")
    tables, rate, _ = found["breaking"]
    return 0 if rate >= BREAKING and tables <= TABLES else 1


if __name__ == "__main__":
    sys.exit(main())
