"""Bridge to the compiled engine: what the interfaces are made of, as arrays for `kernels`."""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

import numpy as np

from .asperities import AsperitySum, GaussianSum
from .contact import Interface, together
from .laws.particle.series import COLUMNS, SeatAverage, SeatedParticles
from .numerics import PiecewiseChebyshev

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Index = NDArray[np.intp]

__all__ = ["FEWEST", "Batch", "available", "threads"]

FEWEST = 5_000
"""States for which the compiled engine is worth its start."""
SCANNED, SCAN = 2_000, 512
"""States of one interface for which a scan of its load pays, and the separations it takes."""
AT_ONCE = 4_096
"""States handed to a thread at a time."""


def available() -> bool:
    """Whether the compiled engine is installed and not switched off.

    ``THIRDBODY_ENGINE=numpy`` in the environment switches it off.
    """
    from importlib.util import find_spec

    return os.environ.get("THIRDBODY_ENGINE") != "numpy" and find_spec("numba") is not None


def threads() -> int:
    """How many threads share the states: ``THIRDBODY_THREADS``, or one for each processor."""
    given = os.environ.get("THIRDBODY_THREADS", "")
    if given.isdigit() and int(given) > 0:
        return int(given)
    usable = getattr(os, "sched_getaffinity", None)
    return len(usable(0)) if usable else os.cpu_count() or 1


class _Panels:
    """Piecewise Chebyshev functions one after another in the kernel's layout, each kept once."""

    def __init__(self) -> None:
        self.known: dict[Any, tuple[int, int]] = {}
        self.panels: list[Array] = []
        self.count = 0

    def add(
        self, key: Any, function: PiecewiseChebyshev, load: Array, columns: int
    ) -> tuple[int, int]:
        """Begin and end of a function: what the balance needs of it, and its first columns."""
        if key not in self.known:
            from .kernels import EVERY, LOAD, PANEL, TERMS

            panels = np.zeros((len(function.half), PANEL + 1, TERMS))
            panels[:, LOAD : LOAD + load.shape[2]] = load.transpose(0, 2, 1)
            every = function.coefficients[:, :, :columns].transpose(0, 2, 1)
            panels[:, EVERY : EVERY + columns] = every
            panels[:, PANEL, 0], panels[:, PANEL, 1] = function.edges[:-1], function.half
            self.known[key] = self.count, self.count + len(panels)
            self.count += len(panels)
            self.panels.append(panels)
        return self.known[key]


class Batch:
    """Interfaces laid out for the kernel.

    Parameters
    ----------
    interfaces : sequence of Interface

    Raises
    ------
    TypeError
        An interface that the kernel does not know: adhesion, or particles that are not a
        `Series`.
    """

    def __init__(self, interfaces: Sequence[Interface]):
        from . import kernels as k

        particles = [bound.particles for bound in interfaces]
        if not all(p is None or isinstance(p, SeatedParticles) for p in particles):
            raise TypeError("these particles are not for the compiled engine")
        most = max(len(p.parts) if isinstance(p, SeatedParticles) else 0 for p in particles)
        self.kinds = np.full((len(interfaces), k.PARTS + most * k.PART_KINDS), k.ABSENT)
        self.values = np.zeros((len(interfaces), k.VALUES + most * k.PART_VALUES))
        pool = _Panels()
        for m, bound in enumerate(interfaces):
            self._add_asperities(m, bound.asperities, pool)
            if isinstance(bound.particles, SeatedParticles):
                self._add_particles(m, bound.particles, pool)
        self.series = np.concatenate(pool.panels)
        self.rules = np.zeros((k.AT + 1, 0))

    def _add_asperities(self, m: int, asperities: Any, pool: _Panels) -> None:
        from . import kernels as k

        if not isinstance(asperities, AsperitySum) or asperities.reduced.start < 0:
            raise TypeError("these asperities are not for the compiled engine")
        reduced = asperities.reduced
        table = reduced.table  # type: ignore[attr-defined]
        if isinstance(reduced, GaussianSum):
            kind, load = k.GAUSSIAN, table.coefficients[:, :, [0, 4, 5]]
        else:
            kind, load = k.DENSITY, table.with_derivatives[:, :, 0, :]
        self.kinds[m, k.KIND : k.PARTS] = kind, *pool.add(reduced, table, load, 4)
        self.values[m, : k.COVERAGE] = (
            *(reduced.w, asperities.sigma_s, asperities.centre),
            *(*asperities.units[:2], asperities.highest),
        )

    def _add_particles(self, m: int, particles: SeatedParticles, pool: _Panels) -> None:
        from . import kernels as k

        shadow = COLUMNS.index(particles.shadow) if particles.shadow in COLUMNS else -1
        self.kinds[m, k.SHADOW] = shadow
        covered = particles.shadow == "covered"
        self.values[m, k.COVERAGE] = particles.coverage if covered else 0.0
        for p, part in enumerate(particles.parts):
            average = part.average
            if isinstance(average, SeatAverage):
                kind, functions, plane = k.ROUGH, [average.table], average.average
                width, least = average.width, average.table.edges[0]
            else:
                # without small gaps the second function is not asked for
                kind, functions = k.PLANE, [average.upper, average.lower or average.upper]
                plane, width, least = average, 0.0, average.bottom
            kinds = [kind]
            for i, function in enumerate(functions):
                load = function.with_derivatives[:, :, [0, max(shadow, 0)], :]
                load = load.reshape(*load.shape[:2], -1)
                kinds += pool.add((average, shadow, i), function, load, len(COLUMNS))
            at = k.PARTS + p * k.PART_KINDS
            self.kinds[m, at : at + len(kinds)] = kinds
            at = k.VALUES + p * k.PART_VALUES
            self.values[m, at : at + k.PART_VALUES] = (
                *(part.scale, part.factor, part.offset, width),
                *((part.reach + part.offset) / part.scale, least),
                *(plane.top, plane.bottom, plane.join, *plane.powers, *plane.floor),
            )

    def solve(
        self, which: Index, target: Array | None, h: Array | None = None
    ) -> tuple[Array, Index, Index, dict[str, Array]]:
        """Separations h [σ_s], evaluations, fates and columns of states of interfaces ``which``."""
        from .kernels import FIELDS, solve_states

        count = len(which)
        given = h is not None
        h = np.array(h) if h is not None else np.empty(count)
        target = np.zeros(count) if target is None else np.ascontiguousarray(target)
        evaluations, fate = np.zeros(count, np.int64), np.zeros(count, np.int64)
        rows = np.empty((count, len(FIELDS)))

        scan = np.zeros((0, 3))
        if not given and len(self.kinds) == 1 and count >= SCANNED:
            scan = self._scan(target)

        def part(start: int) -> None:
            here = slice(start, start + AT_ONCE)
            solve_states(
                *(self.kinds, self.values, self.series, self.rules, scan),
                *(which[here], target[here], h[here], given),
                *(evaluations[here], fate[here], rows[here]),
            )

        starts = range(0, count, AT_ONCE)
        if (workers := min(threads(), len(starts))) > 1:
            part(0)  # compiled once, not by every thread
            with ThreadPoolExecutor(workers) as pool:
                list(pool.map(part, starts[1:]))
        else:
            for start in starts:
                part(start)
        F, *areas = rows.T[:4]
        return (
            h,
            evaluations,
            fate,
            together(F, areas, dict(zip(FIELDS[4:], rows.T[4:], strict=True))),
        )

    def _scan(self, target: Array) -> Array:
        """ln F and its slope over the separations of these loads, for close first guesses."""
        from .kernels import scan_loads

        ends = np.array([target.max(), target.min()])
        h, _, fate, _ = self.solve(np.zeros(2, np.int64), ends)
        scan = np.zeros((SCAN, 3))
        scan[:, 0] = np.linspace(h[0], h[1], SCAN)
        if fate.any() or h[0] >= h[1]:
            return scan[:0]
        scan_loads(0, self.kinds, self.values, self.series, self.rules, scan)
        return scan if np.all(np.diff(scan[:, 1]) < 0) else scan[:0]


def batch(bound: Interface) -> Batch | None:
    """The interface for the compiled engine, or None where only the NumPy engine knows it."""
    if not available():
        return None
    try:
        return Batch([bound])
    except TypeError:
        return None
