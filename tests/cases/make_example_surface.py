"""Makes src/thirdbody/data/example_surface.npz: a small map as an instrument would give it.

A self-affine surface that does not repeat, with tilt, a shallow form, 0.3 nm of noise, missing
points, and heights in whole units of 1 nm, kept as steps from row to row. It is made, not
measured.
"""

from pathlib import Path

import numpy as np

from thirdbody.populations.measured import synthetic

POINTS, SPACING, UNIT = 128, 1e-7, 1e-9


def made():
    whole = synthetic.self_affine(
        sigma=6e-8, hurst=0.8, shortest=6e-7, longest=5e-6, spacing=SPACING, points=256, seed=12
    )
    rng = np.random.default_rng(12)
    x, y = np.meshgrid(*[np.linspace(-1, 1, POINTS)] * 2, indexing="ij")
    heights = whole.heights[:POINTS, :POINTS] + 3e-10 * rng.standard_normal(x.shape)
    heights = heights + 8e-8 * x - 3e-8 * y + 2e-8 * (x**2 + y**2)
    counts = np.rint(heights / UNIT).astype(np.int16)
    missing = np.zeros(counts.shape, dtype=bool)
    missing[20:22, 60:63] = missing[71, 15:17] = missing[-3, 100:104] = True
    return {
        "steps": np.diff(counts, axis=0, prepend=np.int16(0)).astype(np.int16),
        "spacing": np.array([SPACING, SPACING]),
        "unit": np.array(UNIT),
        "missing": np.argwhere(missing).astype(np.uint8),
    }


if __name__ == "__main__":
    path = Path(__file__).parents[2] / "src" / "thirdbody" / "data" / "example_surface.npz"
    np.savez_compressed(path, **made())
    print(path, path.stat().st_size)
