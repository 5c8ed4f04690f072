"""What a million states of a sweep cost: processor time and disk.

python benchmarks/sweep.py
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
import warnings
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import measured_contact

import thirdbody as tb

WIDE = 1 << 19
OWN = 1 << 15
KEEP = ["A_t", "particle_load_share", "mode"]
LOADS = {"low": 5e-7, "high": 2.4e-4, "scale": "log"}
OWN_SIGMA = {"roughness.sigma": (80e-9, 120e-9)}
OWN_INPUTS = {**OWN_SIGMA, "particles.diameter.mean": (250e-9, 350e-9)}


def cost(samples: int, **asked: object) -> tuple[float, float]:
    """Processor seconds and bytes of a million states."""
    with tempfile.TemporaryDirectory() as folder:
        where = {"out": Path(folder) / "states"} if asked.pop("stored", True) else {}
        start = time.process_time()
        data = tb.sweep(
            measured_contact.contact("rough"),
            F_star=LOADS,
            design="sobol",
            samples=samples,
            **where,  # type: ignore[arg-type]
            **asked,  # type: ignore[arg-type]
        )
        seconds = time.process_time() - start
        data.close()
        size = sum(
            file.stat().st_size
            for name in ("states.zarr", "states.nc")
            for file in [Path(folder) / "states" / name, *Path(folder).glob(f"states/{name}/**/*")]
            if file.is_file()
        )
    return seconds / samples * 1e6, size / samples * 1e6


def main() -> int:
    warnings.simplefilter("ignore", tb.errors.RangeWarning)
    statistics = {"mean": True, "extrema": True, "exceed": {"particle_load_share": 0.5}}
    quantiles = statistics | {"quantiles": [0.05, 0.5, 0.95]}
    rows = {
        "one contact, in memory": (WIDE, {"stored": False}),
        "one contact, to Zarr": (WIDE, {}),
        "one contact, to NetCDF": (WIDE, {"format": "netcdf"}),
        f"one contact, {len(KEEP)} columns to Zarr": (WIDE, {"columns": KEEP}),
        "one contact, reduced": (WIDE, {"reduce": statistics}),
        "one contact, reduced, quantiles": (WIDE, {"reduce": quantiles}),
        "σ of its own for each state": (OWN, {"stored": False, "vary": OWN_SIGMA}),
        "σ and x_a of its own": (OWN, {"stored": False, "vary": OWN_INPUTS}),
    }
    # compiled, and what states share, before the clock runs
    cost(1 << 14, stored=False)
    cost(1 << 9, stored=False, vary=OWN_INPUTS)
    for name, (samples, asked) in rows.items():
        seconds, size = cost(samples, **asked)
        disk = f"{size / 1e6:8.1f} MB" if asked.get("stored", True) else ""
        print(f"{name:36s}{seconds:10.2f} s a million{disk}")
    return 0


if __name__ == "__main__":
    os.environ.setdefault("THIRDBODY_THREADS", "1")
    raise SystemExit(main())
