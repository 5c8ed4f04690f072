"""A study of a plate on a chuck: how high it stands over particles, and how often too high."""

from __future__ import annotations

import contextlib
import math
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import InvalidValue, Note
from ..populations.particles import Particles
from ..quantities.record import column
from ..quantities.say import percent, value_of
from ..systems.chuck import Chuck
from ..systems.connector import name_of
from ..systems.plate_over_particle import ATOM, THIN, Bump
from .asked_result import AskedResult, answer_entries
from .plate import AskedPlate, plate_of
from .what_ifs import HARDNESS, WhatIf
from .whole import load_tables

__all__ = ["PlateResult", "load_plate", "run_plate"]

NEEDED = frozenset({"surfaces", "particles", "plate"})
QUANTILES = (0.5, 0.9, 0.99, 0.999)
"""Particles of the table where no diameters are asked for, by number."""
REACH, POINTS = 10.0, 33
"""The curve goes so far below and above the particles, by so many points."""
THICKNESS = 1.1
CLOSE = 1e-4
"""How near the diameter from which particles break is sought, over itself."""


def load_plate(path: str | os.PathLike[str], overrides: Iterable[str] = ()) -> AskedPlate:
    """The plate of a study file, which needs no roughness and no load.

    Parameters
    ----------
    path : path-like
        A TOML file with tables [surfaces], [particles] and [plate].
    overrides : iterable of str, optional
        As those of `thirdbody.load_study`.

    Raises
    ------
    InvalidValue
        Every mistake of the file.
    """
    return load_tables(path, overrides, plate_of, NEEDED)


@dataclass(frozen=True, eq=False, kw_only=True)
class PlateResult(AskedResult):
    """Results of `run_plate`; indexed, they are the plain data of `to_dict`.

    Attributes
    ----------
    asked : AskedPlate
    at : int
        The particle that the answer tells of: the largest of the table.
    bumps, none : float or None
        Mean number of bumps above the limit [1], and how often there is none [1].
    lifting : tuple of float
        Diameter of the particle of each kind that lifts the plate to the limit [m].
    breaking : tuple of float
        Diameter of each kind from which on most particles would break [m]; infinite where none
        of the table would.
    what_ifs
        Of heights [m], or of bumps above the limit.
    """

    in_dict = answer_entries((("plate", "asked.chuck"),), "bumps", "none", "lifting")
    asked: AskedPlate
    at: int
    grain: np.ndarray = column("x", "m", "diameter of the particle")
    particles: list[str] = column("", "", "which kind of particle")
    height: np.ndarray = column("h", "m", "how high the plate stands above the particle")
    width: np.ndarray = column("2b", "m", "diameter of the bump")
    force: np.ndarray = column("F", "N", "force on the particle")
    thin: np.ndarray = column("", "", "whether the bump is wide against the thickness")
    bumps: float | None = None
    none: float | None = None
    lifting: tuple[float, ...] = ()
    breaking: tuple[float, ...] = ()

    title_without = "Plate"
    citations = ("Timoshenko, Woinowsky-Krieger, Theory of Plates and Shells, 2nd ed., ch. 3",)

    def curve(self) -> tuple[np.ndarray, list[tuple[str, np.ndarray]]]:
        """Diameters around those of the table [m]; name and heights [m] of each kind."""
        chuck = self.asked.chuck
        sizes = np.geomspace(self.grain.min() / REACH, self.grain.max() * REACH, POINTS)
        return sizes, [
            (name_of(dust, i), np.array([chuck.over(float(x), dust).height for x in sizes]))
            for i, dust in enumerate(chuck.particles)
        ]


def run_plate(request: AskedPlate) -> PlateResult:
    """Heights of a plate over particles of its study, and how often they exceed the limit.

    Parameters
    ----------
    request : AskedPlate
        As `load_plate` reads it.

    Examples
    --------
    >>> import numpy as np
    >>> import thirdbody as tb
    >>> silicon = tb.Material(E=160e9, nu=0.22, H=12e9)
    >>> dust = tb.Particles(material=tb.materials["SiO2"], areal_density=1e4,
    ...                     diameter=tb.LogNormal(median=3e-6, gsd=1.8))
    >>> chuck = Chuck(surfaces=tb.MaterialPair(silicon, tb.materials["SiC"]), thickness=775e-6,
    ...               pressure=80e3, particles=dust)
    >>> found = run_plate(AskedPlate(title="", chuck=chuck, grains=np.array([5e-6])))
    >>> f"{found.height[0] * 1e9:.1f} nm high, {found.width[0] * 1e3:.1f} mm wide"
    '57.6 nm high, 8.3 mm wide'
    """
    chuck = request.chuck
    wanted = [
        (dust, name_of(dust, i), float(x))
        for i, dust in enumerate(chuck.particles)
        for x in (request.grains if len(request.grains) else dust.diameter.ppf(np.array(QUANTILES)))
    ]
    # of one size there is one quantile
    wanted = [grain for i, grain in enumerate(wanted) if grain not in wanted[:i]]
    bump_shapes = [chuck.over(x, dust) for dust, _, x in wanted]
    at = int(np.argmax([bump.height for bump in bump_shapes]))
    whole = chuck.limit is not None and chuck.diameter is not None
    bumps = chuck.bumps_above(chuck.limit) if whole and chuck.limit is not None else None
    lifting = () if chuck.limit is None else tuple(
        chuck.lifting(chuck.limit, dust) for dust in chuck.particles
    )  # fmt: skip
    breaking = tuple(
        _breaks_from(chuck, dust, [x for other, _, x in wanted if other is dust])
        for dust in chuck.particles
    )
    return PlateResult(
        asked=request,
        at=at,
        grain=np.array([x for _, _, x in wanted]),
        particles=[name for _, name, _ in wanted],
        height=np.array([bump.height for bump in bump_shapes]),
        width=np.array([2 * bump.radius for bump in bump_shapes]),
        force=np.array([bump.force for bump in bump_shapes]),
        thin=np.array([bump.thin for bump in bump_shapes]),
        breaking=breaking,
        bumps=bumps,
        none=None if bumps is None else math.exp(-bumps),
        lifting=lifting,
        what_ifs=_what_ifs(chuck, wanted[at][0], wanted[at][2], counted=bumps is not None),
        run_warnings=(*_warnings(chuck, bump_shapes), *_breaking(chuck, breaking)),
    )


def _what_ifs(chuck: Chuck, dust: Particles, grain: float, *, counted: bool) -> tuple[WhatIf, ...]:
    """Effect of each input on the number of bumps, or else on the height, varied alone."""

    def heights(*chucks: Chuck, sizes: tuple[float, ...] = (1.0,)) -> tuple[float, ...]:
        if counted:
            return tuple(changed.bumps_above(changed.limit or 0.0) for changed in chucks)
        return tuple(
            changed.over(size * grain, dust).height for changed in chucks for size in sizes
        )

    def with_hardness(factor: float) -> Chuck:
        pair = chuck.surfaces
        first, second = (
            surface.replace(H=surface.H * factor) for surface in (pair.first, pair.second)
        )
        return chuck.replace(surfaces=pair.replace(first=first, second=second))

    def vary_heights(change: Callable[[float], Chuck], factor: float) -> tuple[float, ...]:
        return heights(change(1 / factor), change(factor))

    out = [
        WhatIf(
            what="the hardness of plate and chuck",
            between=f"{percent(1 - 1 / HARDNESS)} softer and {percent(HARDNESS - 1)} harder",
            action="measure both near the surface, coatings included",
            values=vary_heights(with_hardness, HARDNESS),
        ),
        WhatIf(
            what="the thickness of the plate",
            between=f"{percent(THICKNESS - 1)} more and as much less",
            action="give plate.thickness as measured",
            values=vary_heights(
                lambda factor: chuck.replace(thickness=chuck.thickness * factor), THICKNESS
            ),
        ),
    ]
    if counted:

        def with_dust(number: float) -> Chuck:
            kinds = [k.replace(areal_density=k.areal_density * number) for k in chuck.particles]
            return chuck.replace(particles=tuple(kinds))

        with contextlib.suppress(InvalidValue):  # twice as many may be more than there is room for
            out.append(
                WhatIf(
                    what="the number of particles",
                    between="half and twice as many",
                    action="count them on the back of a plate, by size",
                    values=vary_heights(with_dust, 2.0),
                )
            )
    else:
        out.append(
            WhatIf(
                what="the size of the particle",
                between="20 % smaller and 25 % larger",
                action="give plate.grain as measured",
                values=heights(chuck, sizes=(0.8, 1.25)),
            )
        )
    return tuple(sorted(out, key=lambda what_if: -what_if.ratio))


def _warnings(chuck: Chuck, bump_shapes: list[Bump]) -> list[Note]:
    """Notes where the theory of thin plates ends."""
    out = []
    t = chuck.thickness
    if stiff := [bump.height for bump in bump_shapes if not bump.thin]:
        out.append(
            Note(
                f"heights up to {value_of(max(ATOM, *stiff), 'm', 3)} are of bumps narrower than "
                f"{2 * THIN:g} thicknesses, where a plate also shears and gives way locally",
                code="thin plate",
                action="take these as orders of magnitude; larger particles (plate.grain) decide",
            )
        )
    if steep := [bump.height for bump in bump_shapes if bump.height > t / 2]:
        out.append(
            Note(
                f"{value_of(max(steep), 'm', 3)} is more than half the thickness: a plate so bent "
                "is stretched, too, and stands lower",
                code="stretched plate",
                action="take it as an upper end, or look at smaller particles (plate.grain)",
            )
        )
    if chuck.diameter is not None and any(2 * bump.radius > chuck.diameter for bump in bump_shapes):
        out.append(
            Note(
                "a bump is wider than the plate: it tilts on the particle instead of lying flat "
                "around it",
                code="wide bump",
                action="raise plate.pressure, or look at smaller particles (plate.grain)",
            )
        )
    return out


def _breaks_from(chuck: Chuck, dust: Particles, grains: Sequence[float]) -> float:
    """Diameter from which on most particles would break [m]; infinite where none of these would.

    Larger ones are weaker, and are pressed harder.
    """

    def breaks(x: float) -> bool:
        return chuck.breaks(chuck.over(x, dust), dust)

    high = next((x for x in sorted(grains) if breaks(x)), math.inf)
    if not math.isfinite(high):
        return high
    low = ATOM
    while high > low * (1 + CLOSE):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if breaks(middle) else (middle, high)
    return high


def _breaking(chuck: Chuck, sizes: Sequence[float]) -> list[Note]:
    """Notes on particles that would break under the plate."""
    return [
        Note(
            f"most particles of {name_of(dust, i)} from {value_of(x, 'm', 3)} on would break: "
            "their pieces are smaller, and the plate stands lower than computed",
            code="brittle",
            action="take heights from there on as an upper end; particles.strength says from which "
            "size on they break, and changes no height",
        )
        for i, (dust, x) in enumerate(zip(chuck.particles, sizes, strict=True))
        if math.isfinite(x)
    ]
