"""Many states by the compiled engine: which it knows, and what it finds."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

import numpy as np

from ...contact.asperity_sums import GaussianSum
from ...contact.contact import Contact
from ...contact.interface import Interface, together
from ...errors import InvalidValue, Mistake, NotCompiled, Problem
from ...laws.particle.series import Series as ParticleSeries
from ...populations.materials import reduced_modulus, softer_hardness
from ..load_scan import load_scan
from .inputs import MATERIALS, NOT_MONOTONE, SHAPES, bare, fineness, own_sizes
from .layout import WORK
from .rows import InterfaceRows, Rows, StateRows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Index = NDArray[np.intp]

__all__ = [
    "FEWEST",
    "MATERIALS",
    "NOT_BALANCED",
    "NOT_MONOTONE",
    "SHAPES",
    "Interfaces",
    "States",
    "available",
    "bare",
    "batch",
    "fineness",
    "own_sizes",
    "threads",
]

FEWEST = 5_000
"""States for which the compiled engine is worth its start."""
SCANNED, SCAN = 2_000, 512
"""States of one interface for which a scan of its load pays, and the separations it takes."""
AT_ONCE = 4_096
"""States handed to a thread at a time."""


NOT_BALANCED = "the compiled engine does not balance this load"


def available() -> bool:
    """Whether the compiled engine is installed and not switched off.

    ``THIRDBODY_ENGINE=numpy`` in the environment switches it off.
    """
    return not unavailable()


def unavailable() -> str:
    """Why there is no compiled engine, or nothing where there is one."""
    from importlib.util import find_spec

    if os.environ.get("THIRDBODY_ENGINE") == "numpy":
        return "THIRDBODY_ENGINE=numpy switches the compiled engine off"
    return "" if find_spec("numba") is not None else "numba is not installed"


MOST_THREADS = 4096


def threads() -> int:
    """How many threads share the states: ``THIRDBODY_THREADS``, or one for each processor.

    Raises
    ------
    InvalidValue
        The variable is no such number.
    """
    if text := os.environ.get("THIRDBODY_THREADS", "").strip():
        if not (text.isascii() and text.isdecimal() and 0 < int(text) <= MOST_THREADS):
            raise InvalidValue(
                Problem(
                    "THIRDBODY_THREADS",
                    f"must be a whole number from 1 to {MOST_THREADS}: how many threads share "
                    "the states; remove it for one each processor",
                    repr(text),
                    code=Mistake.KIND,
                )
            )
        return int(text)
    usable = getattr(os, "sched_getaffinity", None)
    return len(usable(0)) if usable else os.cpu_count() or 1


class _Batch:
    """Interfaces in the records of the kernels."""

    def __init__(self, rows: Rows):
        self.rows = rows

    def solve(
        self, which: Index, target: Array | None, h: Array | None = None
    ) -> tuple[Array, Index, Index, dict[str, Array]]:
        """Separations h [σ_s], evaluations, fates and columns of states of interfaces ``which``."""
        from .balance import solve_states
        from .kernels import FIELDS

        count = len(which)
        h_is_fixed = h is not None
        h = np.array(h) if h is not None else np.empty(count)
        target = np.zeros(count) if target is None else np.ascontiguousarray(target)
        evaluations, fate = np.zeros(count, np.int64), np.zeros(count, np.int64)
        rows = np.full((count, len(FIELDS)), np.nan)  # of states that are not solved

        scan = np.zeros((0, 3))
        if not h_is_fixed and len(self.rows.interfaces) == 1 and count >= SCANNED:
            scan = self._scan(target)

        def solve_part(start: int) -> None:
            here = slice(start, start + AT_ONCE)
            solve_states(
                *self.rows.arrays,
                np.empty(1, WORK),
                scan,
                *(which[here], target[here], h[here], h_is_fixed),
                *(evaluations[here], fate[here], rows[here]),
            )

        starts = range(0, count, AT_ONCE)
        if (workers := min(threads(), len(starts))) > 1:
            solve_part(0)  # compiled once, not by every thread
            with ThreadPoolExecutor(workers) as pool:
                list(pool.map(solve_part, starts[1:]))
        else:
            for start in starts:
                solve_part(start)
        columns = np.ascontiguousarray(rows.T)
        F, *areas = columns[:4]
        fields = dict(zip(FIELDS[4:], columns[4:], strict=True))
        return h, evaluations, fate, together(F, areas, fields)

    def _scan(self, target: Array) -> Array:
        """ln F and its slope over the separations of these loads, for close first guesses."""
        one = np.zeros(SCAN, np.intp)
        ends = np.array([target.max(), target.min()])
        h, _, fate, _ = self.solve(one[:2], ends)
        if fate.any() or h[0] >= h[1]:
            return np.zeros((0, 3))
        h = np.linspace(h[0], h[1], SCAN)
        _, _, _, columns = self.solve(one, None, h)
        log_load = np.log(columns["F_ss"] + columns["F_sa"])
        scan = np.stack([h, log_load, np.gradient(log_load, h)], axis=1)
        return scan if np.all(np.diff(log_load) < 0) else scan[:0]


class Interfaces(_Batch):
    """Interfaces by their tables.

    Parameters
    ----------
    interfaces : sequence of Interface

    Raises
    ------
    NotCompiled
        An interface that the kernel does not know: adhesion, or particles that are not a
        `Series`.
    """

    def __init__(self, interfaces: Sequence[Interface]):
        super().__init__(InterfaceRows(interfaces))


class States(_Batch):
    """States with inputs of their own, by quadrature over nodes that many of them share.

    Parameters
    ----------
    contact : Contact
        The inputs that do not vary.
    arrays : mapping
        Dotted names of inputs and their values (N,).

    Raises
    ------
    NotCompiled
        Inputs or models for which nodes are not shared: heights that are not Gaussian, a law
        that depends on what varies, particles whose shape or material varies, adhesion.
    """

    rows: StateRows

    def __init__(self, contact: Contact, arrays: Mapping[str, Array], count: int):
        super().__init__(StateRows(contact, arrays, count))

    def columns(self, load: str, loads: Array) -> dict[str, Any]:
        """Every column of a result at the given pressure [Pa], F* [1] or d [m].

        ``doubt`` says of each state why it is for the NumPy engine to judge, or nothing.
        """
        from ..columns import as_columns
        from ..load_scan import RESIDUAL
        from ..status import Status

        centre, sigma_s = self.rows.interfaces["centre"], self.rows.interfaces["sigma_s"]
        E, rough = self.rows.varied.E_ss, self.rows.varied.roughness
        target = None if load == "d" else loads * E if load == "F_star" else loads
        separations = (loads - centre) / sigma_s if target is None else None
        h, iterations, fate, raw = self.solve(np.arange(len(loads)), target, separations)
        if separations is not None:
            deep = separations < -GaussianSum.DEEPEST
            fate[deep], iterations[deep] = Status.TOO_DEEP, 0
        h[fate != 0] = np.nan
        for values in raw.values():
            values[fate != 0] = np.nan
        d = np.where(fate == 0, loads, np.nan) if target is None else centre + sigma_s * h
        F_star = loads if load == "F_star" else None
        columns = as_columns(
            raw, d, rough.y_s - centre, rough.sigma, E, target=target, F_star=F_star
        )
        doubt = np.full(len(loads), "", dtype=object)
        balanced = (columns["residual"] <= RESIDUAL) & np.isfinite(raw["A_t"])
        doubt[(fate == Status.UNSOLVED) | ((fate == Status.OK) & ~balanced)] = NOT_BALANCED
        if target is not None:
            doubt[~self._monotone(target)] = NOT_MONOTONE
        return columns | {"status": fate, "iterations": iterations, "doubt": doubt}

    def _monotone(self, target: Array) -> NDArray[np.bool_]:
        r"""Where no other separation can carry the load: sufficient, not necessary.

        The load falls with d while the shadow takes less from the asperities than they and the
        particles gain on approach, :math:`|\varsigma'|F_{ss} < (1-\varsigma)|F_{ss}'| +
        |F_{sa}'|`. Gaussian heights have :math:`|F_{ss}'| > 0.3\,F_{ss}/\sigma_s` above −3 σ_s; a
        seat of width s has :math:`|\varsigma'| \le c/(\sqrt{2\pi}s)` for a coverage c; on a plane
        the projected area changes as the density of the sizes, and the footprint carries the
        pressure of first yield, or is as small as where a sphere has that of the asperities.
        """
        from ..load_scan import RISE

        rows, varied, c = self.rows, self.rows.varied, self.rows.covered
        law = varied.particle_law
        if c is None or not isinstance(law, ParticleSeries) or law.shadow in ("none", "covered"):
            return np.ones(len(target), bool)
        rough = varied.roughness
        if law.seat == "rough":
            c = rows.most
            steepest = c / (math.sqrt(2 * math.pi) * law.zeta_std * rough.sigma)
            return np.broadcast_to(steepest * rough.sigma_s <= 0.3 * (1 - c), target.shape)
        if law.shadow == "projected":
            return rows.steepest * rough.sigma_s <= 0.3 * (1 - c)
        body = varied.particles.material  # type: ignore[union-attr]
        pair = varied.surfaces.first, varied.surfaces.second
        sides = [(reduced_modulus(s, body), softer_hardness(s, body)) for s in pair]
        E = np.minimum(sides[0][0], sides[1][0])
        H = np.minimum(sides[0][1], sides[1][1])
        yields = np.inf
        for ratio in (float(np.min(H / E)), float(np.max(H / E))):
            law_in_contact = law.law.bound(R=law.tip_radius, E_star=1.0, H=ratio, nu=body.nu)
            if law_in_contact.jumps:
                return np.zeros(len(target), bool)
            p_over_H = law_in_contact.reduced("force", 1.0) / law_in_contact.reduced("area", 1.0)
            yields = min(yields, float(p_over_H))
        p = target / (1 - c)
        return (p <= 0.5 * yields * H) & (c * (0.5 * math.pi * p / E) ** 2 <= RISE)


def batch(contact_interface: Interface) -> Interfaces:
    """The interface for the compiled engine; `NotCompiled` where only the NumPy engine knows it."""
    if why := unavailable():
        raise NotCompiled(why)
    if not load_scan(contact_interface).monotone:
        raise NotCompiled(NOT_MONOTONE)
    return Interfaces([contact_interface])
