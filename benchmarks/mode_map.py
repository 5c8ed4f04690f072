"""The mode map of a thousand sizes and a thousand loads, as docs/figures/mode_map.png.

python benchmarks/mode_map.py
"""

from __future__ import annotations

import sys
import time
import warnings
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
import measured_contact

import thirdbody as tb

SIDE = 1_000
OUT = Path(__file__).parent.parent / "docs" / "figures" / "mode_map.png"


def main() -> int:
    warnings.simplefilter("ignore", tb.errors.RangeWarning)
    start = time.perf_counter()
    ax = tb.plot.mode_map(
        measured_contact.contact("rough"),
        ratio=np.geomspace(0.1, 10, SIDE),
        F_star=np.geomspace(1e-7, 1e-3, SIDE),
    )
    ax.figure.savefig(OUT, dpi=200, bbox_inches="tight")
    print(f"{SIDE} x {SIDE} states with their picture: {time.perf_counter() - start:.1f} s")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
