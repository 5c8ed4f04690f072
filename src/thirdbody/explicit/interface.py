"""From a contact and a surface to what is pressed: heights, caps, particles, and doubts."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ..contact.contact import Contact
from ..errors import Advice, InvalidValue, Mistake, Note, Problem
from ..laws.base import AbstractParticleLaw
from ..populations.materials import Material, MaterialPair
from ..populations.measured.topography import Topography
from ..quantities.say import number, percent, plural, value_of
from ..quantities.slips import warn_of_slip
from .bodies import NONE, Bodies, LawTable, covered_share
from .press import HARDEST
from .seats import (
    AbstractSeats,
    GivenSeats,
    Seated,
    SeatHeights,
    height_at,
    placed_apart,
    seat_heights,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Index = NDArray[np.int64]

__all__ = ["Interface", "Map", "cap_of", "interface_of", "map_of"]

ARRAYS = 15
"""Arrays of doubles of the size of the map that a solution takes."""
SHARE_OF_MEMORY = 0.6
FEW_POINTS = 8
"""Points to the shortest wave below which pressures are those of the grid."""
JUMP = 3.0
"""Difference across the rim over that of neighbours from which a map does not repeat itself."""
LARGEST = 0.1
"""Diameter over the side above which a particle meets its own images."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Map:
    """Heights to press: (n, m), x along the first axis [m], of zero mean."""

    z: Array
    spacing: float
    periodic: bool
    source: str
    notes: tuple[str, ...] = ()
    """What was done to the heights that were given."""

    @property
    def sigma(self) -> float:
        """RMS height [m]."""
        return float(np.std(self.z))

    @property
    def area(self) -> float:
        """Nominal area [m²]."""
        return self.z.size * self.spacing**2

    def _jumps(self) -> bool:
        """Whether heights jump from one rim to the other."""
        for axis in (0, 1):
            inside = np.mean(np.diff(self.z, axis=axis) ** 2)
            across = np.mean((self.z.take(0, axis) - self.z.take(-1, axis)) ** 2)
            if across > JUMP**2 * inside:
                return True
        return False

    def shortest_wave(self) -> float:
        """Wavelength above which 99 % of the mean square slope lies [m]; no jumps at the rim."""
        n, m = self.z.shape
        z = self.z
        if self._jumps():  # these have every wave
            z = z * np.hanning(n + 1)[:n, None] * np.hanning(m + 1)[:m]
        q = np.hypot(np.fft.fftfreq(n)[:, None], np.fft.rfftfreq(m)) / self.spacing
        power = (q * np.abs(np.fft.rfft2(z))) ** 2
        order = np.argsort(q, axis=None)
        total = np.cumsum(power.ravel()[order])
        if not total[-1] > 0:
            return math.inf
        wave_number = q.ravel()[order][np.searchsorted(total, 0.99 * total[-1])]
        return float(1 / wave_number)


@dataclass(frozen=True, eq=False, kw_only=True)
class Interface:
    """What is pressed."""

    contact: Contact
    map: Map
    cap: float | None
    """Pressure at which an asperity yields [Pa]; None for never."""
    c: Array
    bodies: Bodies
    seats: SeatHeights
    zeta: Array
    """Height of each seat [m]."""
    warnings: tuple[str, ...]

    def bare(self) -> Interface:
        """The same without its particles."""
        c = np.full_like(self.c, HARDEST if self.cap is None else self.cap)
        return Interface(
            contact=self.contact, map=self.map, cap=self.cap, c=c, bodies=NONE,
            seats=seat_heights(np.empty(0)), zeta=np.empty(0), warnings=(),
        )  # fmt: skip


def map_of(surface: object, spacing: float | None) -> Map:
    """The heights of a measured or synthetic surface, or of an array, ready to be pressed.

    A `Topography` without the waves below its cut-off, the recommended one where none was given;
    an array as it is, less its mean.
    """
    if isinstance(surface, Topography):
        return _of_topography(surface, spacing)
    try:
        z = np.array(surface, dtype=float)
    except (TypeError, ValueError):
        raise InvalidValue(
            Problem(
                "surface",
                "must be a Topography or an array of heights [m]",
                f"{surface!r:.80}",
                code=Mistake.KIND,
            )
        ) from None
    problems = []
    if z.ndim != 2 or min(z.shape) < 8:
        problems.append(
            Problem(
                "",
                f"surface: heights of shape {z.shape} must be a map of at least 8 x 8",
                code=Mistake.SHAPE,
            )
        )
    elif not np.all(np.isfinite(z)):
        problems.append(
            Problem(
                "",
                f"surface: {percent(float(np.mean(~np.isfinite(z))))} of the heights are missing; "
                "a map without gaps is needed (cut out a part that was measured)",
                code=Mistake.MISSING,
            )
        )
    if not (isinstance(spacing, (int, float)) and 0 < spacing < math.inf):
        problems.append(
            Problem(
                "spacing",
                "must be the distance of neighbouring points [m]",
                repr(spacing),
                code=Mistake.KIND,
            )
        )
    if problems:
        raise InvalidValue(*problems)
    assert spacing is not None
    for name, size in (("spacing", float(spacing)), ("heights (rms)", float(np.std(z)))):
        warn_of_slip(name, {"unit": "m"}, size)
    return Map(z=z - z.mean(), spacing=float(spacing), periodic=True, source="the heights")


def _of_topography(surface: Topography, spacing: float | None) -> Map:
    problems = []
    if spacing is not None:
        problems.append(
            Problem(
                "",
                f"spacing = {spacing!r}: the topography tells it; leave it out",
                code=Mistake.CLASH,
            )
        )
    if surface.dim != 2:
        problems.append(
            Problem(
                "",
                f"{surface.source} is a profile; a map of heights is needed",
                code=Mistake.KIND,
            )
        )
    elif not math.isclose(*surface.spacing, rel_tol=1e-6):
        problems.append(
            Problem(
                "",
                f"{surface.source} has pixels of {value_of(surface.spacing[0], 'm')} x "
                f"{value_of(surface.spacing[1], 'm')}; square ones are needed, resample it",
                code=Mistake.BEYOND,
            )
        )
    if surface.missing > 0:
        problems.append(
            Problem(
                "",
                f"{surface.source}: {percent(surface.missing)} of the points have no datum; a map "
                "without gaps is needed (cut out a part that was measured)",
                code=Mistake.BEYOND,
            )
        )
    if problems:
        raise InvalidValue(*problems)
    z = np.array(surface.filtered(), dtype=float)
    return Map(
        z=z - z.mean(), spacing=surface.spacing[0], periodic=surface.periodic,
        source=surface.source, notes=_sentence_of_smoothing(surface, z),
    )  # fmt: skip


def _sentence_of_smoothing(surface: Topography, z: Array) -> tuple[str, ...]:
    """Note that short waves were left out by default, and its effect."""
    if surface.given_cutoff is not None or surface.cutoff == 0:
        return ()
    kept = float(np.std(z) / np.std(surface.heights))
    what = (
        f"{surface.source} is pressed without its waves below the recommended cut-off, "
        f"{value_of(surface.cutoff, 'm')}, as the roughness of the statistical model is: sigma is "
        f"{percent(kept, digits=3)} of that of the heights, and the separation smaller ("
        + Advice("cutoff=0", "roughness.cutoff = 0")
        + " presses the heights as they are, a cutoff of your own those without shorter waves)"
    )
    return (Note(what, code=f"explicit.cutoff.{surface.source}"),)


@lru_cache(maxsize=64)
def _table(law: AbstractParticleLaw, surfaces: MaterialPair, material: Material) -> LawTable:
    return LawTable(law.one(surfaces=surfaces, particle=material))


def law_tables(contact: Contact) -> tuple[LawTable, ...]:
    """Tables of the law of one particle, for each population."""
    return tuple(
        _table(contact.law_of(population), contact.surfaces, population.material)
        for population in contact.populations
    )


def interface_of(
    contact: Contact,
    surface: Map,
    *,
    seats: AbstractSeats,
    cap: str | float | None,
    rng: np.random.Generator,
    particles: Mapping[str, object] | None = None,
) -> Interface:
    """A contact on a map, its particles drawn and seated."""
    _fits(surface.z.shape)
    yields = cap_of(cap, contact)
    warnings = _doubts(contact, surface)
    c = np.full_like(surface.z, HARDEST if yields is None else yields)
    bodies, overlaps = _draw_bodies(contact, surface, seats, rng, particles)
    zeta = np.empty(0)
    if len(bodies):
        zeta = height_at(surface.z, surface.spacing, bodies.x, bodies.y) + bodies.lift
        hidden = covered_share(surface.z, surface.spacing, bodies, zeta)
        if yields is None:
            c[hidden >= 0.5] = 0.0
        else:
            c *= 1 - hidden
        side = min(surface.z.shape) * surface.spacing
        if float(np.max(bodies.diameter)) > LARGEST * side:
            warnings.append(
                Note(
                    f"the largest particle, {value_of(float(np.max(bodies.diameter)), 'm')}, is "
                    f"more than a tenth of the side of the map, {value_of(side, 'm')}: it meets "
                    "its own images; take a larger map",
                    code="explicit.large",
                )
            )
    if overlaps:
        warnings.append(
            Note(
                f"{plural(overlaps, 'pair')} of particles overlap; each carries as if alone",
                code="explicit.overlap",
            )
        )
    scale = surface.sigma or 1.0
    return Interface(
        contact=contact, map=surface, cap=yields, c=c, bodies=bodies,
        seats=seat_heights(zeta / scale), zeta=zeta, warnings=tuple(warnings),
    )  # fmt: skip


def cap_of(cap: str | float | None, contact: Contact) -> float | None:
    """The highest pressure of asperities [Pa] that ``cap`` stands for; None for none."""
    if cap == "hardness":
        return contact.surfaces.H
    if cap is None or cap == "none":
        return None
    if isinstance(cap, (int, float)) and not isinstance(cap, bool) and 0 < cap < HARDEST:
        return float(cap)
    raise InvalidValue(
        Problem(
            "cap",
            "must be 'hardness' (of the softer body), 'none' for purely elastic asperities, or "
            "a pressure [Pa]",
            repr(cap),
            code=Mistake.OPTION,
        )
    )


def _draw_bodies(
    contact: Contact,
    surface: Map,
    seats: AbstractSeats,
    rng: np.random.Generator,
    particles: Mapping[str, object] | None,
) -> tuple[Bodies, int]:
    populations = contact.populations
    if particles is not None:
        return _bodies_of_user(contact, surface, particles, rng)
    if not populations:
        if isinstance(seats, GivenSeats):
            raise InvalidValue(
                "seats: positions are given, but the contact has no particles", code=Mistake.IDLE
            )
        return NONE, 0
    densities = np.array([population.areal_density for population in populations])
    if isinstance(seats, GivenSeats):
        shares = densities / densities.sum()
        kind = rng.choice(len(populations), size=len(seats.positions), p=shares)
    else:
        _refuse_countless(float(densities.sum()), surface)
        counts = rng.poisson(densities * surface.area)
        kind = np.repeat(np.arange(len(populations)), counts)
        rng.shuffle(kind)
    size = np.empty(len(kind))
    for i, population in enumerate(populations):
        here = kind == i
        size[here] = population.diameter.sample(rng, int(np.sum(here)))
    places, overlaps = placed_apart(seats, surface.z, surface.spacing, size, rng)
    return _bodies(contact, places, size, kind), overlaps


MOST_PARTICLES = 10_000_000
"""Particles on a map; each takes some hundred bytes."""


def _refuse_countless(density: float, surface: Map) -> None:
    """Refuse a map on which there would be more particles than anybody can press."""
    if (count := density * surface.area) <= MOST_PARTICLES:
        return
    rows, columns = (points * surface.spacing for points in surface.z.shape)
    raise InvalidValue(
        f"a map of {number(rows, 3)} m by {number(columns, 3)} m holds {number(count, 3)} "
        f"particles, more than {MOST_PARTICLES:,}: are heights and spacing, "
        f"{number(surface.spacing, 3)}, in metres? (a map in nm: heights * 1e-9, spacing * 1e-9)",
        code=Mistake.TOO_LARGE,
    )


def _bodies_of_user(
    contact: Contact, surface: Map, particles: Mapping[str, object], rng: np.random.Generator
) -> tuple[Bodies, int]:
    """Particles listed one by one by the user: x, y, diameter, population."""
    problems, columns = [], {}
    for name in ("x", "y", "diameter"):
        try:
            columns[name] = np.atleast_1d(np.asarray(particles[name], dtype=float))
            if columns[name].ndim != 1 or not np.all(np.isfinite(columns[name])):
                raise ValueError
        except KeyError:
            problems.append(
                Problem(
                    "",
                    f"particles has no {name!r}; it takes x, y, diameter [m], population",
                    code=Mistake.UNKNOWN,
                )
            )
        except (TypeError, ValueError):
            problems.append(
                Problem(
                    "",
                    f"particles[{name!r}] must be a list of finite lengths [m]",
                    code=Mistake.KIND,
                )
            )
    if not problems and len({len(values) for values in columns.values()}) > 1:
        problems.append(
            Problem("", "particles: x, y and diameter must be of one length", code=Mistake.SHAPE)
        )
    if not problems and not np.all(columns["diameter"] > 0):
        problems.append(Problem("", "particles['diameter'] must be > 0 [m]", code=Mistake.RANGE))
    if not contact.populations:
        problems.append(
            Problem(
                "",
                "particles are given, but the contact has none that say their material",
                code=Mistake.MISSING,
            )
        )
    if problems:
        raise InvalidValue(*problems)
    count = len(columns["x"])
    kind = np.asarray(
        particles["population"] if "population" in particles else np.zeros(count, int)
    )
    most = len(contact.populations)
    if kind.shape != (count,) or kind.dtype.kind not in "iu" or not np.all(
        (kind >= 0) & (kind < most)
    ):  # fmt: skip
        raise InvalidValue(
            f"particles['population'] must be whole numbers from 0 to {most - 1}", code=Mistake.KIND
        )
    seats = GivenSeats(
        positions=tuple(zip(columns["x"].tolist(), columns["y"].tolist(), strict=True))
    )
    places, overlaps = placed_apart(seats, surface.z, surface.spacing, columns["diameter"], rng)
    return _bodies(contact, places, columns["diameter"], kind), overlaps


def _bodies(contact: Contact, places: Seated, size: Array, kind: Index) -> Bodies:
    return Bodies(
        x=places.x, y=places.y, lift=places.lift, diameter=size,
        kind=kind.astype(np.int64), laws=law_tables(contact),
    )  # fmt: skip


def _doubts(contact: Contact, surface: Map) -> list[str]:
    out = list(surface.notes)
    if not surface.periodic:
        out.append(
            Note(
                f"{surface.source} does not repeat itself, the half-space does: contacts at the "
                "rim "
                "feel those across it",
                code="explicit.rim",
            )
        )
    wave = surface.shortest_wave() / surface.spacing
    if wave < FEW_POINTS:
        out.append(
            Note(
                f"the shortest waves of {surface.source} have {number(wave, 2)} points; "
                f"pressures and areas are those of the grid below {FEW_POINTS} (a longer cut-off, "
                "or a finer map)",
                code="explicit.grid",
            )
        )
    sigma = contact.roughness.sigma
    if surface.sigma > 0 and not 0.9 < sigma / surface.sigma < 1.1:
        out.append(
            Note(
                f"the map has sigma = {value_of(surface.sigma, 'm')} and the roughness of the "
                f"contact {value_of(sigma, 'm')}: the statistical model is one of another surface",
                code="explicit.sigma",
            )
        )
    return out


def _fits(shape: tuple[int, int]) -> None:
    """Refuse maps that do not fit into memory."""
    try:
        free = os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return
    need = ARRAYS * 8.0 * shape[0] * shape[1]
    if need > SHARE_OF_MEMORY * free:
        side = 2 ** math.floor(math.log2(math.sqrt(SHARE_OF_MEMORY * free / (ARRAYS * 8))))
        raise InvalidValue(
            f"a map of {shape[0]} x {shape[1]} points takes {need / 1e9:.2g} GB and "
            f"{free / 1e9:.2g} GB are free; {side} x {side} would fit",
            code=Mistake.TOO_LARGE,
        )
