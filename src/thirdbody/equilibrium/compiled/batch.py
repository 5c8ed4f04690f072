"""Bridge to the compiled engine: what the interfaces are made of, as arrays for `kernels`."""

from __future__ import annotations

import dataclasses
import itertools
import math
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ...contact.asperity_sums import (
    AsperitySum,
    GaussianSum,
    GaussianSums,
    ReducedSum,
    gaussian_sums,
    scales,
)
from ...contact.contact import Contact
from ...contact.interface import Interface, together
from ...contact.particle_averages import SeatAverage, SizeAverage, size_average
from ...contact.particle_sums import SeatedParticles
from ...errors import InvalidValue, NotCompiled
from ...laws.base import COLUMNS, AbstractAsperityLaw
from ...laws.particle.series import Series as ParticleSeries
from ...numerics.chebyshev import PiecewiseChebyshev
from ...numerics.quadrature import panel_rule, subdivide
from ...populations.distributions import NORMAL_CUT, Distribution, Monodisperse, TruncatedGaussian
from ...populations.heights import GaussianHeights
from ...populations.materials import MaterialPair, reduced_modulus, softer_hardness
from ...populations.particles import Particles
from ...populations.roughness import Roughness
from ...populations.shape import Angular
from ..load_scan import load_scan
from .squeeze_rules import NEAR, SharedRules, near_rule, squeeze_rules

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Index = NDArray[np.intp]

__all__ = ["FEWEST", "Interfaces", "States", "available", "batch", "threads"]

FEWEST = 5_000
"""States for which the compiled engine is worth its start."""
SCANNED, SCAN = 2_000, 512
"""States of one interface for which a scan of its load pays, and the separations it takes."""
AT_ONCE = 4_096
"""States handed to a thread at a time."""
FEW_SIZES = 0.55
"""Share of the sizes with which a sum comes close enough to a root."""


NOT_BALANCED = "the compiled engine does not balance this load"
NOT_MONOTONE = "the load may rise with the separation; this is the loading branch"


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


def threads() -> int:
    """How many threads share the states: ``THIRDBODY_THREADS``, or one for each processor."""
    given = os.environ.get("THIRDBODY_THREADS", "")
    if given.isdigit() and int(given) > 0:
        return int(given)
    usable = getattr(os, "sched_getaffinity", None)
    return len(usable(0)) if usable else os.cpu_count() or 1


def pulls(law: AbstractAsperityLaw) -> bool:
    """Whether the load may be tension, which the compiled balance does not know."""
    return law.start < 0 or law.onset < 0


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
            self._append(key, _laid(function, load, function.coefficients[:, :, :columns]))
        return self.known[key]

    def _append(self, key: Any, panels: Array) -> None:
        self.known[key] = self.count, self.count + len(panels)
        self.count += len(panels)
        self.panels.append(panels)

    def add_inverse(self, of: GaussianSums | SizeAverage) -> int:
        """Where the separation stands as a function of the load, for first guesses."""
        key = of, "inverse"
        if key not in self.known:
            self._append(key, _inverse(of))
        return self.known[key][0]

    def add_family(self, family: GaussianSums) -> tuple[int, int]:
        """Begin and end of the sums over Gaussian heights for many w."""
        if family not in self.known:
            self._append(family, _family(family))
        return self.known[family]

    def add_average(self, function: PiecewiseChebyshev, shadow: int) -> tuple[int, int]:
        """Begin and end of particle columns: load and shadow with two derivatives, all seven."""
        load = function.with_derivatives[:, :, [0, max(shadow, 0)], :]
        load = load.reshape(*load.shape[:2], -1)
        return self.add((id(function), shadow), function, load, len(COLUMNS))


def _laid(function: PiecewiseChebyshev, load: Array, every: Array) -> Array:
    """Panels (P, ..., terms, columns) in the kernel's layout, the middle axes one after another."""
    from .kernels import EVERY, LOAD, PANEL, TERMS

    panels = np.zeros((*load.shape[:-2], PANEL + 1, TERMS))
    panels[..., LOAD : LOAD + load.shape[-1], :] = load.swapaxes(-1, -2)
    panels[..., EVERY : EVERY + every.shape[-1], :] = every.swapaxes(-1, -2)
    panels = panels.reshape(len(load), -1, PANEL + 1, TERMS)
    panels[:, :, PANEL, 0] = function.edges[:-1, None]
    panels[:, :, PANEL, 1] = function.half[:, None]
    return panels.reshape(-1, PANEL + 1, TERMS)


@lru_cache(maxsize=64)
def _family(family: GaussianSums) -> Array:
    """The sums over Gaussian heights for half an octave of w in the kernel's layout."""
    every = family.coefficients
    return _laid(family.table, every[..., [0, 4, 5]], every[..., :4])


@lru_cache(maxsize=128)
def _inverse(of: GaussianSums | SizeAverage) -> Array:
    """A panel of separations that fall with ln of a load."""
    from .kernels import PANEL, TERMS

    if isinstance(of, GaussianSums):
        separation = np.linspace(-ReducedSum.DEEPEST, GaussianSum.highest, 2_000)
        log_load = np.log(of.middle(separation)) - 0.5 * separation**2
    else:
        rise = np.geomspace(1, 1e-5, 2_000) * math.sqrt(of.top - of.bottom)
        separation = of.top - rise**2
        log_load = np.log(of(separation)[:, 0])
    depth = np.sqrt(np.maximum(log_load[0] - log_load, 0.0))
    at = np.linspace(0, depth[-1], (PANEL + 1) * TERMS - 2)
    panel = np.concatenate([[log_load[0], at[1]], np.interp(at, depth, separation)])
    return panel.reshape(1, PANEL + 1, TERMS)


class _Rules:
    """Quadrature rules one after another for the kernel, each kept once."""

    def __init__(self) -> None:
        self.known: dict[Any, tuple[int, int]] = {}
        self.rules: list[Array] = []
        self.count = 0
        self.own = 0
        """Numbers in the rules of single states."""

    def add(self, key: Any, rows: Array) -> tuple[int, int]:
        """Begin and nodes of a rule (k, n): weighted columns, then increasing abscissae."""
        if key not in self.known:
            begin, n = self.add_each(rows[None])[0]
            self.known[key] = int(begin), int(n)
        return self.known[key]

    def add_each(self, rows: Array) -> Index:
        """Begin and nodes (M, 2) of rules (M, k, n), one for each state."""
        count, k, n = rows.shape
        self.own += rows.size if count > 1 else 0
        begin = self.count + k * n * np.arange(count)
        self.rules.append(rows.ravel())
        self.count += rows.size
        return np.stack([begin, np.full(count, n)], axis=1)


class _Batch:
    """Interfaces laid out for the kernel, one row each."""

    def __init__(self, count: int, parts: int):
        from . import kernels as k

        self.kinds = np.full((count, k.PARTS + parts * k.PART_KINDS), k.ABSENT, np.int32)
        self.values = np.zeros((count, k.VALUES + parts * k.PART_VALUES))
        self._panels, self._rules = _Panels(), _Rules()

    def _finish(self) -> None:
        from . import kernels as k

        no_panel = np.zeros((1, k.PANEL + 1, k.TERMS))
        self.series = np.concatenate([*self._panels.panels, no_panel])
        self.edges = self.series[:, k.PANEL, 0].copy()
        self.rules = np.concatenate([*self._rules.rules, np.zeros(0)])
        self.own = self._rules.own

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """What the kernels read."""
        return self.kinds, self.values, self.series, self.edges, self.rules

    def solve(
        self, which: Index, target: Array | None, h: Array | None = None
    ) -> tuple[Array, Index, Index, dict[str, Array]]:
        """Separations h [σ_s], evaluations, fates and columns of states of interfaces ``which``."""
        from .kernels import FIELDS, SCRATCH, solve_states

        count = len(which)
        given = h is not None
        h = np.array(h) if h is not None else np.empty(count)
        target = np.zeros(count) if target is None else np.ascontiguousarray(target)
        evaluations, fate = np.zeros(count, np.int64), np.zeros(count, np.int64)
        rows = np.full((count, len(FIELDS)), np.nan)  # of states that are not solved

        scan = np.zeros((0, 3))
        if not given and len(self.kinds) == 1 and count >= SCANNED:
            scan = self._scan(target)

        def part(start: int) -> None:
            here = slice(start, start + AT_ONCE)
            solve_states(
                *self.arrays,
                np.empty(SCRATCH),
                scan,
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
        particles = [bound.particles for bound in interfaces]
        if not all(p is None or isinstance(p, SeatedParticles) for p in particles):
            raise NotCompiled("particles that are not Series")
        most = max(len(p.parts) if isinstance(p, SeatedParticles) else 0 for p in particles)
        super().__init__(len(interfaces), most)
        for m, bound in enumerate(interfaces):
            self._add_asperities(m, bound.asperities)
            if isinstance(bound.particles, SeatedParticles):
                self._add_particles(m, bound.particles)
        self._finish()

    def _add_asperities(self, m: int, asperities: Any) -> None:
        from . import kernels as k

        if not isinstance(asperities, AsperitySum) or pulls(asperities.reduced.law):
            raise NotCompiled("asperities of several shapes, or that attract")
        reduced = asperities.reduced
        table = reduced.table  # type: ignore[attr-defined]
        if isinstance(reduced, GaussianSum):
            kind, load = k.GAUSSIAN, table.coefficients[:, :, [0, 4, 5]]
        else:
            kind, load = k.DENSITY, table.with_derivatives[:, :, 0, :]
        self.kinds[m, k.KIND : k.GUESS] = kind, *self._panels.add(reduced, table, load, 4)
        self.values[m, : k.COVERAGE] = (
            *(0.0, asperities.sigma_s, asperities.centre),
            *(*asperities.units[:2], asperities.highest),
        )

    def _add_particles(self, m: int, particles: SeatedParticles) -> None:
        from . import kernels as k

        shadow = COLUMNS.index(particles.shadow) if particles.shadow in COLUMNS else -1
        self.kinds[m, k.SHADOW] = shadow
        covered = particles.shadow == "covered"
        self.values[m, k.COVERAGE] = particles.coverage if covered else 0.0
        for p, part in enumerate(particles.parts):
            average = part.average
            if isinstance(average, SeatAverage):
                kind, functions, plane = k.ROUGH, [average.table], average.average
                width, least, reach = average.width, average.table.edges[0], average.high
            elif part.breaks:
                raise NotCompiled("particles that break, on a plane seat")
            else:
                # without small gaps the second function is not asked for
                kind, functions = k.PLANE, [average.upper, average.lower or average.upper]
                plane, width, least, reach = average, 0.0, average.bottom, average.top
            kinds = [kind]
            for function in functions:
                kinds += self._panels.add_average(function, shadow)
            at = k.PARTS + p * k.PART_KINDS
            self.kinds[m, at : at + len(kinds)] = kinds
            at = k.VALUES + p * k.PART_VALUES
            self.values[m, at : at + k.PLACE] = (
                *(part.scale, part.factor, part.offset, width),
                *(reach, least),
                *(plane.top, plane.bottom, plane.join, *plane.powers, *plane.floor),
            )


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

    def __init__(self, contact: Contact, arrays: Mapping[str, Array], count: int):
        if any(name.startswith("asperity_law.") for name in arrays):
            raise NotCompiled("the asperity law varies")
        varied = contact.with_arrays(arrays)
        particles = None if bare(contact, arrays) else contact.particles
        if isinstance(particles, tuple) or (particles is not None and particles.law is not None):
            raise NotCompiled("several populations")
        if particles is not None and particles.strength is not None:
            raise NotCompiled("particles that break")
        super().__init__(count, 0 if particles is None else len(particles.diameter.components))
        datum = 0.0 if particles is None else contact.particle_law.centre
        self.covered: Array | None = None
        """Projected particle area per nominal area (N,)."""
        self.most = np.zeros(count)
        """Most of the nominal area that particles can shadow; more than all of it if squashed."""
        self.spreads = False
        """Particles are squashed, so that their area may grow faster than their load."""
        self.steepest = np.zeros(count)
        """Most that it changes with d on a plane seat [1/m]."""
        self._add_asperities(contact, varied, datum)
        if particles is not None:
            self._add_particles(contact, varied, arrays)
        self._finish()
        self.varied = varied

    def columns(self, load: str, loads: Array) -> dict[str, Any]:
        """Every column of a result at the given pressure [Pa], F* [1] or d [m].

        ``doubt`` says of each state why it is for the NumPy engine to judge, or nothing.
        """
        from ..columns import as_columns
        from ..load_scan import RESIDUAL
        from .kernels import CENTRE, OK, SIGMA_S, TOO_DEEP, UNSOLVED

        centre, sigma_s = self.values[:, CENTRE], self.values[:, SIGMA_S]
        E, rough = self.varied.E_ss, self.varied.roughness
        target = None if load == "d" else loads * E if load == "F_star" else loads
        given = (loads - centre) / sigma_s if target is None else None
        h, iterations, fate, raw = self.solve(np.arange(len(loads)), target, given)
        if given is not None:
            deep = given < -GaussianSum.DEEPEST
            fate[deep], iterations[deep] = TOO_DEEP, 0
        h[fate != 0] = np.nan
        for values in raw.values():
            values[fate != 0] = np.nan
        d = np.where(fate == 0, loads, np.nan) if target is None else centre + sigma_s * h
        given = loads if load == "F_star" else None
        columns = as_columns(
            raw, d, rough.y_s - centre, rough.sigma, E, target=target, F_star=given
        )
        doubt = np.full(len(loads), "", dtype=object)
        balanced = (columns["residual"] <= RESIDUAL) & np.isfinite(raw["A_t"])
        doubt[(fate == UNSOLVED) | ((fate == OK) & ~balanced)] = NOT_BALANCED
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

        law, varied, c = self.varied.particle_law, self.varied, self.covered
        if c is None or not isinstance(law, ParticleSeries) or law.shadow in ("none", "covered"):
            return np.ones(len(target), bool)
        rough = varied.roughness
        if law.seat == "rough":
            c = self.most
            steepest = c / (math.sqrt(2 * math.pi) * law.zeta_std * rough.sigma)
            return np.broadcast_to(steepest * rough.sigma_s <= 0.3 * (1 - c), target.shape)
        if self.spreads:
            return np.zeros(len(target), bool)
        if law.shadow == "projected":
            return self.steepest * rough.sigma_s <= 0.3 * (1 - c)
        if isinstance(varied.particles.shape, Angular):  # type: ignore[union-attr]
            return np.zeros(len(target), bool)
        body = varied.particles.material  # type: ignore[union-attr]
        pair = varied.surfaces.first, varied.surfaces.second
        sides = [(reduced_modulus(s, body), softer_hardness(s, body)) for s in pair]
        E = np.minimum(sides[0][0], sides[1][0])
        H = np.minimum(sides[0][1], sides[1][1])
        yields = np.inf
        for ratio in (float(np.min(H / E)), float(np.max(H / E))):
            bound = law.law.bound(R=law.tip_radius, E_star=1.0, H=ratio, nu=body.nu)
            if bound.jumps:
                return np.zeros(len(target), bool)
            p_over_H = bound.reduced("force", 1.0) / bound.reduced("area", 1.0)
            yields = min(yields, float(p_over_H))
        p = target / (1 - c)
        return (p <= 0.5 * yields * H) & (c * (0.5 * math.pi * p / E) ** 2 <= RISE)

    def _add_asperities(self, contact: Contact, varied: Contact, datum: float) -> None:
        from . import kernels as k

        rough, surfaces = varied.roughness, varied.surfaces
        law = _common_law(contact.asperity_law, rough, surfaces)
        if not isinstance(rough.heights, GaussianHeights) or rough.ellipticity or pulls(law):
            raise NotCompiled(
                "asperities of several shapes or heights that are not Gaussian, or that attract"
            )
        w, units = scales(law, rough, surfaces)
        self.law, self.w = law, np.broadcast_to(w, len(self.kinds))
        step, across = GaussianSums.place(self.w)

        def family(step: int) -> tuple[int, ...]:
            sums = gaussian_sums(law, step)
            return *self._panels.add_family(sums), self._panels.add_inverse(sums)

        self.kinds[:, k.BEGIN : k.PARTS] = _each(step, family, 3)
        self.kinds[:, k.KIND] = k.FAMILY
        named = {"ACROSS": across, "SIGMA_S": rough.sigma_s, "CENTRE": datum * rough.sigma}
        named |= {"FORCE": units[..., 0], "AREA": units[..., 1], "HIGHEST": GaussianSum.highest}
        self._set_values(0, named)

    def _set_values(self, at: int, named: Mapping[str, Any]) -> None:
        """Columns from ``at`` on by the kernel's names: those alike for all states as one row."""
        from . import kernels as k

        columns = {getattr(k, name): np.asarray(values) for name, values in named.items()}
        wide = (k.POWERS, k.FLOOR)
        alike = {i: values for i, values in columns.items() if values.ndim == (i in wide)}
        row = np.zeros(max(i + (len(COLUMNS) if i in wide else 1) for i in columns))
        for i, values in alike.items():
            row[i : i + values.size] = values
        self.values[:, at : at + len(row)] = row
        for i in columns.keys() - alike.keys():
            values = columns[i] if i in wide else columns[i][:, None]
            self.values[:, at + i : at + i + values.shape[1]] = values

    def _add_particles(
        self, contact: Contact, varied: Contact, arrays: Mapping[str, Array]
    ) -> None:
        from . import kernels as k

        law, particles = varied.particle_law, contact.particles
        if not (isinstance(law, ParticleSeries) and isinstance(particles, Particles)):
            raise NotCompiled("particles that are not Series")
        if any(name.startswith("particle_law.law") for name in arrays):
            raise NotCompiled("the law of the particles varies")
        if any(name.startswith(SHAPES) for name in arrays):
            raise NotCompiled("the shape of the particles varies")
        if "particle_law.friction_factor" in arrays:
            raise NotCompiled("the friction of squashed particles varies")
        if "particle_law.aspect" in arrays:
            raise NotCompiled("the aspect of flakes varies")
        self.kinds[:, k.SHADOW] = COLUMNS.index(law.shadow) if law.shadow in COLUMNS else -1
        own = law.seat == "rough" and own_particles(contact, arrays)
        parts = self._squeezed if own else self._averaged
        coverage = np.zeros(len(self.kinds))
        for p, part in enumerate(parts(contact, varied, arrays)):
            at = k.PARTS + p * k.PART_KINDS
            kinds = part.pop("kinds")
            self.kinds[:, at : at + kinds.shape[1]] = kinds
            coverage += part.pop("coverage")
            part["OFFSET"] = law.seat_offset(varied.roughness)
            self._set_values(k.VALUES + p * k.PART_VALUES, part)
        if np.any(coverage >= 1):
            raise NotCompiled("some particles are jammed")  # said better, one contact at a time
        one = contact.law_of(particles).one(surfaces=contact.surfaces, particle=particles.material)
        self.covered = one.breadth * coverage
        self.most = np.maximum(self.most, self.covered)
        if law.shadow == "covered":
            self.values[:, k.COVERAGE] = self.covered

    def _averaged(
        self, contact: Contact, varied: Contact, arrays: Mapping[str, Array]
    ) -> Iterator[dict[str, Any]]:
        """Parts of one material and shape: size averages that all states share."""
        from . import kernels as k

        law: Any = varied.particle_law
        particles, changed = contact.particles, varied.particles
        assert isinstance(particles, Particles)
        assert isinstance(changed, Particles)
        if any(name.startswith(MATERIALS) for name in arrays):
            raise NotCompiled("the materials of the particles vary")
        one = contact.law_of(particles).one(surfaces=contact.surfaces, particle=particles.material)
        shadow = self.kinds[0, k.SHADOW]
        rough = law.seat == "rough"
        ratio = size_factor(particles.diameter, arrays)
        if ratio is None:
            raise NotCompiled("the shape of the size distribution varies")
        for share, sizes in particles.diameter.components:
            scale, shape = sizes.standardised()
            average = size_average(one, shape)
            size = scale * ratio
            factor = changed.areal_density * share * size**2
            width = law.zeta_std * varied.roughness.sigma / size if rough else 0.0 * size
            if not rough:
                self.steepest += 0.25 * math.pi * one.breadth * factor / size * _densest(shape)
            if getattr(one, "spreads", False):
                self.spreads = True
                self.most = self.most + factor * average.floor[-2:].max()
            kinds = np.full((len(self.kinds), k.PART_KINDS), k.ABSENT)
            kinds[:, 0] = k.ROUGH_NODES if rough else k.PLANE
            kinds[:, k.PART_GUESS] = self._panels.add_inverse(average)
            if rough:
                kinds[:, 3:5] = kinds[:, 7:9] = self._rules.add("one", np.ones((2, 1)))
                octave = np.broadcast_to(np.frexp(width)[1] - 1, len(kinds))
                for i, rule in ((1, _seat_rule), (5, _few_on_seats)):

                    def ends(octave: int, rule: Any = rule, average: Any = average) -> Any:
                        return self._rules.add((rule, average, octave), rule(average, octave))

                    kinds[:, i : i + 2] = _each(octave, ends, 2)
            else:
                # without small gaps the second function is not asked for
                for i, function in enumerate((average.upper, average.lower or average.upper)):
                    kinds[:, 1 + 2 * i : 3 + 2 * i] = self._panels.add_average(function, shadow)
            yield {
                "kinds": kinds,
                "coverage": math.pi / 4 * factor * shape.moment(2),
                **{"SIZE": size, "FACTOR": factor, "WIDTH": width},
                "REACH": average.top + k.SEAT_REACH * width,
                "LEAST": average.bottom,
                **{"TOP": average.top, "BOTTOM": average.bottom},
                **({"NEAR": -1.0} if rough else {"JOIN": average.join}),
                **{"POWERS": average.powers, "FLOOR": average.floor},
            }

    def _squeezed(
        self, contact: Contact, varied: Contact, arrays: Mapping[str, Array]
    ) -> Iterator[dict[str, Any]]:
        """Parts whose material or shape varies, on a rough seat: nodes for each state."""
        from . import kernels as k

        law: Any = varied.particle_law
        particles, changed = contact.particles, varied.particles
        assert isinstance(particles, Particles)
        assert isinstance(changed, Particles)
        count = len(self.kinds)

        def column(values: Any) -> Array:
            return np.broadcast_to(values, count)[:, None]

        body = changed.material
        if isinstance(particles.shape, Angular):
            raise NotCompiled("angular particles whose material or shape of sizes varies")
        if squashed(contact, arrays, count).any():
            raise NotCompiled("squashed particles whose material or shape of sizes varies")
        sides = [
            (column(reduced_modulus(surface, body)), column(softer_hardness(surface, body)))
            for surface in (varied.surfaces.first, varied.surfaces.second)
        ]
        if not any(np.ptp(values) for side in sides for values in side):
            sides = [(E[:1], H[:1]) for E, H in sides]  # one rule for all
        bound = {
            law.law.bound(R=law.tip_radius, E_star=float(E[0, 0]), H=float(H[0, 0]), nu=nu)
            for (E, H), nu in itertools.product(sides, (0.1, 0.4))
        }
        if bound != {law.law}:
            raise NotCompiled("the law of the particles depends on their material")
        sigma = column(law.zeta_std * varied.roughness.sigma)
        unvaried = law.one(surfaces=contact.surfaces, particle=particles.material)
        parts = [part.standardised()[1] for _, part in particles.diameter.components]
        each = _sizes(particles.diameter, changed.diameter, arrays, count)
        for shape, (share, size, sizes) in zip(parts, each, strict=True):
            width = sigma / size
            x, weight = sizes(float(width.min()))
            if x[..., -1].max() > MOST_WIDTHS * width.min():
                raise NotCompiled("the seat is too smooth for nodes")
            panels = width / x[..., -1:]
            factor = changed.areal_density * share * size[:, 0] ** 2
            kinds = np.full((count, k.PART_KINDS), k.ABSENT)
            kinds[:, 0] = k.ROUGH_NODES
            average = size_average(unvaried, shape)
            kinds[:, k.PART_GUESS] = self._panels.add_inverse(average)
            few = sizes(float(width.min()), FEW_SIZES)
            rules = self._over_gaps(law, sides, panels, kinds)
            for i, (at, number) in ((3, (x, weight)), (7, few)):
                kinds[:, i : i + 2] = self._rules.add_each(np.stack([number * at**3, at], axis=1))
            yield {
                "kinds": kinds,
                "coverage": math.pi / 4 * factor * np.sum(weight * x**2, axis=-1),
                **{"SIZE": size[:, 0], "FACTOR": factor, "WIDTH": width[:, 0]},
                "REACH": x[..., -1] + k.SEAT_REACH * width[:, 0],
                **{"TOP": 1.0, **rules},
            }

    def _over_gaps(
        self, law: Any, sides: list[tuple[Array, Array]], panels: Array, kinds: Index
    ) -> dict[str, Array]:
        """Rules over the squeeze, with their places in ``kinds``: what else the kernel needs."""
        from . import kernels as k

        count, one = len(kinds), len(sides[0][0]) == 1
        out = {name: np.full(count, -1.0) for name in ("BOTTOM", "NEAR", "PLACE")}
        out["FLOOR"] = np.empty((count, len(COLUMNS)))
        for which, rule in squeeze_rules(
            law.law,
            *sides,
            tip_radius=law.tip_radius,
            widths=panels.min(keepdims=True) if one else panels,
            split_areas=law.shadow == "footprint",
        ):
            here = slice(None) if one else which
            if isinstance(rule, SharedRules):
                kinds[here, k.PART_TERMS], out["PLACE"][here] = len(rule.series.rows), rule.across
                rows, near = rule.series.rows, rule.series.near
                add: Callable[[Array], Any] = partial(self._add_series, rule.series)
            else:
                rows, near = rule.rows, near_rule(rule, float(panels.min()))
                add = self._rules.add_each
            kinds[here, 1:3] = kinds[here, 5:7] = add(rows)
            if near is not None:
                kinds[here, 5:7], out["NEAR"][here] = add(near), NEAR
            out["BOTTOM"][here], out["FLOOR"][here] = rule.bottom, rule.floor
        return out | {"MODULUS": np.broadcast_to(sides[0][0][:, 0], count)}

    def _add_series(self, series: Any, rows: Array) -> tuple[int, int]:
        """Begin and nodes of a rule (terms, 8, n) on a series, whose two rules differ in n."""
        return self._rules.add((series, rows.shape[2]), rows.reshape(-1, rows.shape[2]))


MATERIALS = ("surfaces.", "particles.material.")
"""Inputs on which the contact of a particle depends."""
SHAPES = "particles.shape."


def bare(contact: Contact, arrays: Mapping[str, Array]) -> bool:
    """Whether there are no particles in any of the states."""
    return contact.two_body and "particles.areal_density" not in arrays


def own_particles(contact: Contact, arrays: Mapping[str, Array]) -> bool:
    """Whether the material or the shape of the particles varies from state to state."""
    if any(name.startswith(MATERIALS) and np.ptp(v) > 0 for name, v in arrays.items()):
        return True
    particles = contact.particles
    return isinstance(particles, Particles) and size_factor(particles.diameter, arrays) is None


def squashed(contact: Contact, arrays: Mapping[str, Array], count: int) -> NDArray[np.bool_]:
    """States whose particles are softer than a surface, and squashed there."""
    law, out = contact.particle_law, np.zeros(count, bool)
    if not isinstance(law, ParticleSeries) or law.soft != "squashed" or bare(contact, arrays):
        return out
    if law.onset == "hermite" and not law.law.breakpoints:
        return out  # it never yields
    if isinstance(contact.particles, Particles) and isinstance(contact.particles.shape, Angular):
        return out
    varied = contact.with_arrays({k: v for k, v in arrays.items() if k.startswith(MATERIALS)})
    if isinstance(varied.particles, Particles):
        for surface in (varied.surfaces.first, varied.surfaces.second):
            out |= varied.particles.material.H < surface.H
    return out


def fineness(arrays: Mapping[str, Array]) -> Array:
    """Particle sizes over roughness, up to a factor: it tells how many nodes a state needs."""
    sizes = arrays.get("particles.diameter.mean", np.ones(1))
    rough = arrays.get("roughness.sigma", np.ones(1)) * arrays.get("particle_law.zeta_std", 1.0)
    return np.broadcast_to(sizes / rough, max(map(len, arrays.values())))


def _each(number: Index, places: Callable[[int], tuple[int, ...]], count: int) -> Index:
    """Places (N, count) of what belongs to each number, asked for each number once."""
    lowest = int(number.min())
    table = np.zeros((int(number.max()) - lowest + 1, count), np.int64)
    for there in np.flatnonzero(np.bincount(number - lowest)):
        table[there] = places(lowest + int(there))
    return table[number - lowest]


@lru_cache(maxsize=128)
def _densest(shape: Distribution) -> float:
    """The most of x²φ(x), nearly; infinite where all are of one size."""
    if isinstance(shape, Monodisperse):
        return math.inf
    x, _ = panel_rule(np.array(shape.pieces), 12)
    return float(np.max(x**2 * shape.pdf(x)))


@lru_cache(maxsize=128)
def _seat_rule(average: SizeAverage, octave: int) -> Array:
    """Weighted columns and gaps for seats of 2^octave to 2^(octave + 1) in the size."""
    if average.top - average.bottom > MOST_WIDTHS * 2.0**octave:
        raise NotCompiled("the seat is too smooth for shared nodes")
    gaps, weight, values = average.nodes(1.25 * 2.0**octave)
    return np.vstack([weight * values.T, gaps])


@lru_cache(maxsize=128)
def _few_on_seats(average: SizeAverage, octave: int) -> Array:
    """As `_seat_rule`, with nodes enough to come close to a root."""
    depth = subdivide(np.array([0.0, average.top - average.bottom]), width=0.75 * 2.0**octave)
    u, weight = panel_rule(np.sqrt(depth), 6)
    gaps = average.top - u[::-1] ** 2
    return np.vstack([(2 * u * weight)[::-1] * average(gaps).T, gaps])


def _sizes(
    base: Distribution, varied: Distribution, arrays: Mapping[str, Array], count: int
) -> Iterator[tuple[float, Array, Callable[..., tuple[Array, Array]]]]:
    """Weight, size (N, 1) [m], and a rule over the sizes in its unit for a width to resolve.

    The rule also takes the share of its nodes that are wanted, to come close to a root.
    """
    factor = size_factor(base, arrays)
    if factor is not None:
        for weight, part in base.components:
            scale, shape = part.standardised()
            size = np.broadcast_to(scale * factor, count)[:, None]
            yield weight, size, partial(_shape_rule, shape)
    elif isinstance(varied, TruncatedGaussian):
        size = np.broadcast_to(varied.mean, count)[:, None]
        std = np.broadcast_to(varied.std, count)[:, None] / size
        yield 1.0, size, partial(_gaussian_sizes, std, np.broadcast_to(varied.n, count)[:, None])
    else:
        raise NotCompiled("the shape of these sizes varies")


def _shape_rule(shape: Distribution, width: float, part: float = 1.0) -> tuple[Array, Array]:
    """Diameters and number weights of a fixed shape."""
    if isinstance(shape, Monodisperse):
        return np.full((1, 1), shape.mean), np.ones((1, 1))
    low, high = shape.support
    if low <= 0.5 * high:
        edges = subdivide(np.array(shape.pieces), width=1.5 * width)
        x, weight = panel_rule(edges, math.ceil(12 * part))
        return x[None], (weight * shape.pdf(x))[None]
    # sizes close together are counted from the largest, so that their densities keep all digits
    edges = subdivide(high - np.array(shape.pieces)[::-1], width=1.5 * width)
    depth, weight = panel_rule(edges, math.ceil(12 * part))
    return high - depth[None, ::-1], (weight * shape.pdf_below(depth))[None, ::-1]


def _gaussian_sizes(std: Array, n: Array, width: float, part: float = 1.0) -> tuple[Array, Array]:
    """Diameters over the mean and number weights of truncated Gaussians of their own widths."""
    high = np.minimum(n, NORMAL_CUT)
    low = np.maximum(-high, -1 / std)
    # One panel. The load smooths the seats of all gaps; the area of one regime may come from a few
    # of them, and is as steep in the size as one seat: exp(−k²w²/2) falls below 1e-13 at kw = 7.7,
    # and n nodes over a length L resolve k up to 4n/L, so n = 1.9 L/w and some at the ends.
    count = math.ceil(part * np.max((high - low) / 6 * (20 + 12 * std / width)))
    u, weight = panel_rule(np.concatenate([low, high], axis=1), count)
    density = np.exp(-0.5 * u * u) * weight
    return 1 + std * u, density / density.sum(axis=1, keepdims=True)


MOST_WIDTHS = 2_000.0
"""Widths of the seat over which nodes are laid."""


def size_factor(sizes: Distribution, arrays: Mapping[str, Array]) -> Array | float | None:
    """Factor on every length of the sizes (N,), or None where their shape varies."""
    prefix = "particles.diameter."
    given = {k.removeprefix(prefix): v for k, v in arrays.items() if k.startswith(prefix)}
    changed = {name: v for name, v in given.items() if np.any(v != getattr(sizes, name, np.nan))}
    if not changed:
        return 1.0
    fields = dataclasses.fields(sizes)  # type: ignore[arg-type]
    about = {item.name: item.metadata.get("quantity", {}) for item in fields}
    lengths = {name for name in about if about[name].get("unit") == "m"}
    if set(changed) != lengths:
        return None
    first, *others = (changed[name] / getattr(sizes, name) for name in sorted(lengths))
    alike = all(np.allclose(each, first, rtol=1e-14, atol=0) for each in others)
    return first if alike else None


def _common_law(
    law: AbstractAsperityLaw, rough: Roughness, surfaces: MaterialPair
) -> AbstractAsperityLaw:
    """The law bound to its contact, where all states bind it alike."""
    first, second = surfaces.first, surfaces.second
    nu = np.where(first.H <= second.H, first.nu, second.nu)
    given = [np.ravel(values) for values in (rough.R, surfaces.E_star, surfaces.H, nu)]
    one = [float(values[0]) for values in given]
    # bound alike where nothing varies, and where the extremes of what varies change nothing
    rows = [one]
    for i, values in enumerate(given):
        rows += [[*one[:i], float(v), *one[i + 1 :]] for v in {values.min(), values.max()}]
    try:
        bound = {law.bound(R=R, E_star=E, H=H, nu=v) for R, E, H, v in rows}
    except InvalidValue as error:  # of no state perhaps; said better, one contact at a time
        raise NotCompiled("the law does not know all of these inputs") from error
    if len(bound) > 1:
        raise NotCompiled("the law binds differently from state to state")
    return bound.pop()


def batch(bound: Interface) -> Interfaces:
    """The interface for the compiled engine; `NotCompiled` where only the NumPy engine knows it."""
    if why := unavailable():
        raise NotCompiled(why)
    if not load_scan(bound).monotone:
        raise NotCompiled(NOT_MONOTONE)
    return Interfaces([bound])
