"""Speed as ratios inside one run: this library beside the script a user would write.

python benchmarks/run.py
"""

from __future__ import annotations

import subprocess
import sys
import time
import warnings
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
import naive

import thirdbody as tb


def contact(seat: str, x_a: float = naive.X_A) -> tb.Contact:
    """The contact of `naive`."""
    steel = tb.Material(E=naive.E, nu=naive.NU, H=naive.H)
    silica = tb.Material(E=naive.E_A, nu=naive.NU_A, H=7.7e9)
    sizes = tb.TruncatedGaussian(mean=x_a, std=x_a * naive.S_A / naive.X_A, n=naive.CUT)
    return tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=naive.SIGMA, R=naive.R),
        particles=tb.Particles(material=silica, diameter=sizes, areal_density=naive.ETA_A),
        particle_law=tb.particle.Series(seat=seat),
    )


def rate(seat: str, count: int, repeats: int = 5) -> float:
    """States a second, best of several runs; loads in random order, tables built anew before."""
    loads = np.random.default_rng(1).permutation(np.geomspace(1e-8, 3e-4, count))
    bound = contact(seat)
    tb.solve(bound, F_star=1e-5)
    best = np.inf
    for _ in range(repeats):
        start = time.perf_counter()
        tb.solve(bound, F_star=loads)
        best = min(best, time.perf_counter() - start)
    return count / best


def mode_map(seat: str, side: int = 200) -> float:
    """Seconds for a map of side × side states over particle size and load."""
    start = time.perf_counter()
    for x_a in np.geomspace(0.2, 10, side) * naive.SIGMA:
        tb.solve(contact(seat, x_a), F_star=np.geomspace(5e-7, 2.4e-4, side))
    return time.perf_counter() - start


def main() -> int:
    warnings.simplefilter("ignore", tb.RangeWarning)
    loads = np.geomspace(1e-7, 2e-4, 24)
    start = time.perf_counter()
    slow = np.array([naive.separation(F) for F in loads])
    naive_rate = len(loads) / (time.perf_counter() - start)
    fast = np.asarray(tb.solve(contact("plane"), F_star=loads).d)
    worst = np.max(np.abs(fast / slow - 1))
    plane, rough = rate("plane", 200_000), rate("rough", 200_000)
    command = "from time import *; t = perf_counter(); import thirdbody; print(perf_counter() - t)"
    call = [sys.executable, "-c", command]
    imports = [
        float(subprocess.run(call, capture_output=True, text=True, check=True).stdout)
        for _ in range(3)
    ]
    rows = [
        ("quad + brentq script", f"{naive_rate:,.0f} states/s", 1.0),
        ("solve, seat plane", f"{plane:,.0f} states/s", plane / naive_rate),
        ("solve, seat rough", f"{rough:,.0f} states/s", rough / naive_rate),
    ]
    for name, value, ratio in rows:
        print(f"{name:28s}{value:>22s}{ratio:>12,.0f} x")
    print(f"{'largest difference in d':28s}{worst:22.1e}")
    print(f"{'mode map 200 x 200, rough':28s}{mode_map('rough'):20.2f} s")
    print(f"{'mode map 200 x 200, plane':28s}{mode_map('plane'):20.2f} s")
    print(f"{'import thirdbody':28s}{min(imports):20.2f} s")
    return 0 if plane / naive_rate >= 300 and worst < 1e-8 else 1


if __name__ == "__main__":
    raise SystemExit(main())
