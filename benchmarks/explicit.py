"""What a map of heights costs, pressed point by point: processor seconds at equal certificate.

Self-affine maps as in the literature on rough contact: Hurst 0.8, waves from an eighth of the side
to eight points, RMS slope 0.1, cap 0.05 E*. Where tamaas is installed, its solutions of the
elastic contacts are judged by the same certificate.

python benchmarks/explicit.py [512 1024 ...]
"""

from __future__ import annotations

import sys
import time
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import thirdbody as tb
from thirdbody.explicit.bodies import NONE, Bodies, LawTable, Placed, covered
from thirdbody.explicit.press import HARDEST, Pressed, press

Array = NDArray[np.float64]

E_STAR, SPACING, SLOPE, CAP = 1e11, 1e-7, 0.1, 0.05
PARTICLES = 10_000
TOL = 1e-6
LOADS = {"1 %": 3e-4, "6 %": 2e-3, "16 %": 6e-3}
"""F/(A_n E*) of elastic contacts with some such area."""


class Row(NamedTuple):
    """One solution."""

    points: int
    what: str
    area: float
    convolutions: int
    certificate: float
    seconds: float


def heights(points: int) -> Array:
    """The map, of RMS slope `SLOPE`."""
    surface = tb.synthetic.self_affine(
        sigma=1e-7,
        hurst=0.8,
        shortest=8 * SPACING,
        longest=points * SPACING / 8,
        spacing=SPACING,
        points=points,
    )
    return surface.heights * (SLOPE / surface.rms_slope)


def particles(z: Array, count: int) -> Bodies:
    """Silica between steels, as large as the heights, anywhere."""
    steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    law = tb.particle.Series().one(surfaces=tb.MaterialPair(steel, steel), particle=silica)
    rng = np.random.default_rng(0)
    side = len(z) * SPACING
    return Bodies(
        x=rng.random(count) * side,
        y=rng.random(count) * side,
        diameter=np.full(count, float(np.std(z))),
        lift=np.zeros(count),
        kind=np.zeros(count, np.int64),
        laws=(LawTable(law),),
    )


def measured(z: Array, load: float, cap: float, bodies: Bodies, what: str) -> Row:
    """Solve once, and once more for the clock."""
    c = np.full(z.shape, cap)
    if len(bodies):
        c *= 1 - covered(z, SPACING, bodies, Placed(bodies, z.shape, SPACING).at(z))
    total = load * E_STAR * z.size * SPACING**2

    def once() -> Pressed:
        return press(z, SPACING, E_STAR, c=c, bodies=bodies, load=total, tol=TOL)

    found = once()
    start = time.process_time()
    found = once()
    seconds = time.process_time() - start
    if not found.converged:
        raise RuntimeError(f"{what}: certificate {found.certificate:.1e}")
    return Row(
        len(z), what, float(np.mean(found.p > 0)), found.iterations, found.certificate, seconds
    )


def rows(points: int) -> list[Row]:
    """Elastic and capped contacts at three loads, and one with particles."""
    z = heights(points)
    out = []
    for name, load in LOADS.items():
        out.append(measured(z, load, HARDEST, NONE, f"{name}, elastic"))
        out.append(measured(z, load, CAP * E_STAR, NONE, f"{name}, cap"))
    count = PARTICLES * points**2 // 1024**2
    dusty = measured(z, LOADS["6 %"], CAP * E_STAR, particles(z, count), f"6 %, {count} particles")
    return [*out, dusty]


def others(points: int) -> list[str]:
    """What programs that are not needed here take, where they are installed."""
    try:
        import tamaas
    except ImportError:
        return ["tamaas is not installed"]
    z = heights(points)
    side = points * SPACING
    model = tamaas.Model(tamaas.model_type.basic_2d, [side, side], [points, points])
    model.E, model.nu = E_STAR, 0.0
    out = []
    for name, load in LOADS.items():
        solver = tamaas.PolonskyKeerRey(model, z, 1e-6)
        start = time.process_time()
        solver.solve(load * E_STAR)
        seconds = time.process_time() - start
        theirs = np.asarray(model.traction).reshape(z.shape)
        judged = press(
            z, SPACING, E_STAR, c=np.full(z.shape, HARDEST), load=load * E_STAR * side**2,
            start=(theirs, np.empty(0)), max_iterations=0,
        )  # fmt: skip
        out.append(f"tamaas, {name}, elastic: {seconds:.2f} s, {judged.certificate:.0e}")
    return out


def main() -> None:
    """Print a table."""
    sizes = [int(word) for word in sys.argv[1:]] or [512, 1024]
    print("| n | contact | area | convolutions | certificate | s |")
    print("|---|---|---|---|---|---|")
    for points in sizes:
        for row in rows(points):
            print(
                f"| {row.points} | {row.what} | {row.area:.1%} | {row.convolutions} | "
                f"{row.certificate:.0e} | {row.seconds:.2f} |"
            )
        for line in others(points):
            print(line)


if __name__ == "__main__":
    main()
