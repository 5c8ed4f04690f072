"""What a map of heights costs, pressed point by point: processor seconds at equal certificate.

Self-affine maps as in the literature on rough contact: Hurst 0.8, waves from an eighth of the side
to eight points, RMS slope 0.1, cap 0.05 E*. Where tamaas (elastic contacts) and ContactMechanics
are installed, their solutions are judged by the same certificate: the time that counts is that of
the loosest of their own tolerances with which it is at most 1e-5, and ratios are to ours at 1e-5.

python benchmarks/explicit.py [512 1024 ...]
"""

from __future__ import annotations

import importlib.util
import math
import sys
import time
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import thirdbody as tb
from thirdbody.explicit.bodies import NONE, Bodies, LawTable, Placed, covered_share
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
    surface = tb.surfaces.self_affine(
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
        c *= 1 - covered_share(z, SPACING, bodies, Placed(bodies, z.shape, SPACING).at_particles(z))
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


EQUAL = 1e-5
"""Certificate at which programs are compared."""
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)


class Other(NamedTuple):
    """What another program took for one contact; infinite where it did not get there."""

    points: int
    what: str
    ours: float
    program: str
    seconds: float
    certificate: float


Solve = Callable[[Array, float, float | None, float], Array]
"""Pressures from heights, nominal pressure, cap, and a tolerance of the program's own."""


def tamaas_solve(z: Array, pressure: float, cap: float | None, tol: float) -> Array:
    """Polonsky, Keer and Rey, elastic."""
    import tamaas

    tamaas.set_log_level(tamaas.LogLevel.error)
    points, side = len(z), len(z) * SPACING
    model = tamaas.Model(tamaas.model_type.basic_2d, [side, side], [points, points])
    model.E, model.nu = E_STAR, 0.0
    tamaas.PolonskyKeerRey(model, z, 1e-3 * tol).solve(pressure)
    return np.asarray(model.traction).reshape(z.shape)


def contactmechanics_solve(z: Array, pressure: float, cap: float | None, tol: float) -> Array:
    """Polonsky and Keer, with the cap of Almqvist et al."""
    import ContactMechanics
    from ContactMechanics.Optimization.ConstrainedConjugateGradients import (
        constrained_conjugate_gradients,
    )

    side = len(z) * SPACING
    space = ContactMechanics.PeriodicFFTElasticHalfSpace(z.shape, E_STAR, (side, side))
    found = constrained_conjugate_gradients(
        space,
        z,
        hardness=None if cap is None else cap * SPACING**2,
        external_force=pressure * side**2,
        pentol=tol * float(np.std(z)),
        thermotol=tol,
        forcetol=tol * CAP * E_STAR * SPACING**2,
        maxiter=1000,
    )
    return np.asarray(found.jac) / SPACING**2


PROGRAMS: dict[str, Solve] = {
    "tamaas": tamaas_solve,
    "ContactMechanics": contactmechanics_solve,
}


def judged(z: Array, p: Array, c: Array) -> float:
    """The certificate of pressures found elsewhere, at the load that they carry."""
    p = np.where(p >= c * (1 - 1e-9), c, np.maximum(p, 0.0))  # at the cap but for rounding
    load = float(np.sum(p)) * SPACING**2
    start = (p, np.empty(0))
    return press(z, SPACING, E_STAR, c=c, load=load, start=start, max_iterations=0).certificate


def timed(call: Callable[[], Array | Pressed]) -> tuple[float, Array | Pressed]:
    """Processor seconds of a call, and what it gave."""
    start = time.process_time()
    found = call()
    return time.process_time() - start, found


def compared(points: int, programs: list[str]) -> Iterator[Other]:
    """Every contact in every program that is there and knows it."""
    z = np.ascontiguousarray(heights(points))
    area = (points * SPACING) ** 2
    for name, load in LOADS.items():
        pressure = load * E_STAR
        for cap in (None, CAP * E_STAR):
            if cap is not None and pressure > 0.9 * cap:
                continue
            c = np.full(z.shape, HARDEST if cap is None else cap)

            def solve(c: Array = c, pressure: float = pressure) -> Pressed:
                return press(z, SPACING, E_STAR, c=c, load=pressure * area, tol=EQUAL)

            solve()
            ours, _ = timed(solve)
            what = f"{name}, {'elastic' if cap is None else 'cap'}"
            for program in programs:
                if program == "tamaas" and cap is not None:
                    continue
                best = math.inf
                for tol in TOLERANCES:
                    seconds, theirs = timed(
                        lambda p=pressure, k=cap, t=tol, run=PROGRAMS[program]: run(z, p, k, t)
                    )
                    certificate = judged(z, np.asarray(theirs), c)
                    best = min(best, certificate)
                    if certificate <= EQUAL:
                        yield Other(points, what, ours, program, seconds, certificate)
                        break
                else:
                    yield Other(points, what, ours, program, math.inf, best)


def peak() -> float:
    """Most memory that this process had, in GB."""
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6


def main() -> None:
    """Print tables."""
    sizes = [int(word) for word in sys.argv[1:]] or [512, 1024]
    print("| n | contact | area | convolutions | certificate | s |")
    print("|---|---|---|---|---|---|")
    for points in sizes:
        before = peak()
        done = rows(points)
        for row in done:
            print(
                f"| {row.points} | {row.what} | {row.area:.1%} | {row.convolutions} | "
                f"{row.certificate:.0e} | {row.seconds:.2f} |"
            )
        bare = next(row for row in done if row.what == "6 %, cap")
        print(f"\nparticles: {done[-1].seconds / bare.seconds:.2f} times the time without")
        print(f"memory: {peak():.2f} GB, of which {before:.2f} GB before\n")
    known = [name for name in PROGRAMS if importlib.util.find_spec(name) is not None]
    for name in PROGRAMS:
        if name not in known:
            print(f"{name} is not installed")
    if not known:
        return
    print("| n | contact | s | program | s | certificate | times |")
    print("|---|---|---|---|---|---|---|")
    for points in sizes:
        for other in compared(points, known):
            ratio = other.seconds / other.ours
            print(
                f"| {other.points} | {other.what} | {other.ours:.2f} | {other.program} | "
                f"{other.seconds:.2f} | {other.certificate:.0e} | {ratio:.1f} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
