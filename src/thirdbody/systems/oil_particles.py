r"""Dents: what a particle leaves in a surface, and what the particles of an oil leave in a film.

In an oil film of height h only particles larger than h touch both surfaces, and there are few of
them: each acts alone. Per area and overrolling

.. math:: \eta_a(>h) = \varepsilon\,h\,n(>h)

pass, n particles per volume of oil, with the entry ratio ε of particles that follow the oil into
the contact. The film is as high under a particle as elsewhere (a Hertz contact is stiff), which
makes depths upper bounds.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from ..contact.broken_averages import broken_average
from ..effects.single.dent import Debris, Dent, dent_of, dents_after, flattened_diameter, sink, sunk
from ..effects.single.ploughing import groove_of
from ..effects.single.severity import severity, threshold
from ..errors import InvalidValue, Mistake, Note, Problem, tell_of_range
from ..laws.asperity.hermite import SMOOTH
from ..laws.base import AbstractAsperityLaw
from ..laws.particle.breakage import Breakage, about_strength
from ..laws.particle.one_particle import contact_sides, squeezed_particle
from ..laws.particle.series import Deep, Series
from ..laws.particle.squashed import widest_disc
from ..numerics.quadrature import panel_rule, subdivide
from ..populations.distributions import Distribution
from ..populations.materials import Material, MaterialPair
from ..populations.measured.cleanliness import Level, suspension_of_iso4406
from ..populations.strength import WeibullStrength
from ..quantities.arguments import need_one
from ..quantities.record import Record, column
from ..quantities.say import number, percent, value_of
from ..quantities.units import to_si
from ..quantities.value import Value, choice, quantity

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ..laws.spots import ParticleSpots

    Array = NDArray[np.float64]

__all__ = ["FilmDents", "FilmParticles", "SeverityIndex"]


def __dir__() -> list[str]:
    return sorted(__all__)


NODES = 16
"""Gauss nodes for each panel over sizes."""


# ------------------------------------------------------------------------------ in a film
@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class FilmDents(Record):
    """Dents in one surface per overrolling, made by `FilmParticles.dents`.

    Depths are upper bounds: the film does not give way under a particle.
    Without dents their number and volume are 0, the rest NaN.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.oil_particles import FilmParticles
    >>> steel = tb.materials["S45C"]
    >>> oil = FilmParticles.from_iso4406("18/16/13", surfaces=tb.MaterialPair(steel, steel),
    ...                                  material=tb.materials["SiO2"], film=0.5e-6, entry=1.0)
    >>> found = oil.dents(side=1)
    >>> f"{found.depth_p95 * 1e6:.1f} µm deep and {found.diameter_p95 * 1e6:.1f} µm wide at p95"
    '1.0 µm deep and 20.6 µm wide at p95'
    """

    number: float = column("", "1/m^2", "dents per area", default=0.0)
    depth: float = column("", "m", "mean depth", default=math.nan)
    diameter: float = column("D", "m", "mean diameter", default=math.nan)
    area: float = column("πD²/4", "m^2", "mean area", default=math.nan)
    volume: float = column("", "m", "dented volume per area", default=0.0)
    depth_p95: float = column("", "m", "depth that 5 % of the dents exceed", default=math.nan)
    diameter_p95: float = column("", "m", "diameter that 5 % of the dents exceed", default=math.nan)
    embedded: float = column(
        "",
        "1",
        "share of the dents of particles that sit deeper than half their radius, and may stay",
        default=math.nan,
    )


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class SeverityIndex(Record):
    r"""Damaged volume per area and overrolling, with its parts. Not a life.

    .. math:: I = \varepsilon h \int n\,\varphi_a\,(V_1+V_2+f_{ab}\,s\,A_g)\,dx

    Made by `FilmParticles.severity_index`.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.oil_particles import FilmParticles
    >>> steel = tb.materials["S45C"]
    >>> oil = FilmParticles.from_iso4406("18/16/13", surfaces=tb.MaterialPair(steel, steel),
    ...                                  material=tb.materials["SiO2"], film=0.5e-6, entry=1.0)
    >>> index = oil.severity_index()
    >>> f"{index.total:.1e}", index.grooves_1, round(index.above, 2)
    ('1.1e-13', 0.0, 1.0)
    """

    total: float = column("I", "m", "sum of the four parts below", default=0.0)
    dents_1: float = column("", "m", "volume of the dents in surface 1 per area", default=0.0)
    dents_2: float = column("", "m", "the same in surface 2", default=0.0)
    grooves_1: float = column("", "m", "volume of grooves in surface 1 per area", default=0.0)
    grooves_2: float = column("", "m", "the same in surface 2", default=0.0)
    severity: float = column("S", "1", "mean severity of what touches both surfaces", default=0.0)
    above: float = column(
        "", "1", "share above the threshold from rolling to grooving", default=0.0
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class FilmParticles(Value):
    r"""The particles of an oil that pass a film of given height.

    .. math:: \eta_a(>x) = \varepsilon\,h\,n(>x), \qquad x \ge h

    Parameters
    ----------
    surfaces : MaterialPair
    material : Material
        Of the particles.
    diameter : Distribution
        Sizes by number [m].
    number : float
        Particles per volume of oil n [1/m³].
    film : float
        Film height h [m].
    entry : float
        Entry ratio ε: particles that pass the contact over those in the oil that passes [1].
        Nobody can predict it; inlets turn large particles away and gather them too.
    debris : {"by_hardness", "hard", "ductile", "brittle"}, optional
        By hardness, particles dent a surface as deep as the computed table says they sink; with
        ``deep="off"`` they dent what is softer than they are, and are flattened by what is not
        (`thirdbody.effects.single.dent.sink`). Hard ones keep their shape whatever their hardness.
        Ductile ones flatten to discs of the height of the film, as wide at most as the surface
        bears (`widest_disc` of the squashed particle): the footprint is given, its depth is not
        known (NaN), because it follows from friction on the disc. Brittle ones break before
        they dent.
    fragment : float, optional
        Size of the fragments [m]; needed for brittle particles.
    slip : float, optional
        Distance that a surface slides under a particle while it passes [m].
    f_ab : float, optional
        Removed fraction of a groove [1]; needed with slip.
    law : AbstractAsperityLaw, optional
        Of each contact of a particle.
    deep : {"table", "off"}, optional
        What a particle does beyond small squeezes, as in `thirdbody.particle.Series`; ``off``, a
        sphere that sinks in whole.
    friction_factor : float, optional
        Friction factor of the faces of particles, m_f [1], which the table needs.
    strength : WeibullStrength, optional
        How strong the particles are: what breaks on the way down to the film leaves pieces there,
        which may break again. Dents, footprints and the index are then of what is whole.

    Warns
    -----
    RangeWarning
        Sizes outside those of the strength data, and what else `thirdbody.solve` says of a
        strength.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.oil_particles import FilmParticles
    >>> steel = tb.materials["S45C"]
    >>> oil = FilmParticles.from_iso4406("18/16/13", surfaces=tb.MaterialPair(steel, steel),
    ...                                  material=tb.materials["SiO2"], film=0.5e-6, entry=1.0)
    >>> dents = oil.dents()
    >>> f"{dents.number:.0f} dents per m² and pass, {dents.depth * 1e6:.1f} µm deep"
    '901 dents per m² and pass, 0.4 µm deep'
    """

    surfaces: MaterialPair
    material: Material
    diameter: Distribution
    number: float = quantity("n", "1/m^3", "particles per volume of oil", ge=0)
    film: float = quantity("h", "m", "film height", gt=0, hint="0.5 um is 0.5e-6")
    entry: float = quantity("ε", "1", "entry ratio", ge=0)
    debris: Debris = choice("what particles do when pressed", default="by_hardness")
    fragment: float | None = quantity("x_f", "m", "size of fragments", default=None, gt=0)
    slip: float = quantity("s", "m", "sliding distance under a passing particle", default=0, ge=0)
    f_ab: float | None = quantity("f_ab", "1", "removed part of a groove", default=None, ge=0, le=1)
    law: AbstractAsperityLaw = SMOOTH
    deep: Deep = choice("particles beyond small indentations", default="table")
    friction_factor: float = quantity(
        "m_f", "1", "shear factor on the faces of particles", default=0.2, gt=0, le=1
    )
    strength: WeibullStrength | None = None

    def __post_init__(self) -> None:
        Value.__post_init__(self)
        for text in about_strength(self, self.surfaces):
            tell_of_range(text)

    def _problems(self) -> list[str]:
        out: list[str] = [
            Problem(
                name, f"must be a {kind.__name__}", repr(getattr(self, name)), code=Mistake.KIND
            )
            for name, kind in (
                ("surfaces", MaterialPair),
                ("material", Material),
                ("diameter", Distribution),
                ("law", AbstractAsperityLaw),
            )
            if not isinstance(getattr(self, name), kind)
        ]
        if (self.debris == "brittle") != (self.fragment is not None):
            out.append(
                Problem(
                    "fragment",
                    f"with debris = {self.debris!r}: "
                    "brittle particles, and only those, need the size of their fragments [m]",
                    repr(self.fragment),
                    code=Mistake.MISSING,
                )
            )
        if not isinstance(self.strength, WeibullStrength | None):
            out.append(
                Problem(
                    "strength",
                    "must be a WeibullStrength, e.g. WeibullStrength.of(material), or None",
                    repr(self.strength),
                    code=Mistake.KIND,
                )
            )
        elif self.strength is not None and self.fragment is not None:
            out.append(
                Problem(
                    "strength",
                    f"and fragment = {self.fragment:g} would break the particles twice; remove one",
                    code=Mistake.CLASH,
                )
            )
        if self.slip > 0 and self.f_ab is None:
            out.append(
                Problem(
                    "f_ab",
                    "is missing: with slip, particles groove, and the removed part "
                    "of a groove (0 to 1) must be given",
                    code=Mistake.MISSING,
                )
            )
        return out

    @classmethod
    def from_iso4406(
        cls,
        code: str,
        *,
        level: Level = "middle",
        smallest: float | str | None = None,
        largest: float | str | None = None,
        **others: Any,
    ) -> Self:
        """The particles of an oil with an ISO 4406 code.

        The code counts from 4 µm(c): a film below that lets more through than is known, unless
        ``smallest`` continues the count. ``level``, ``smallest`` and ``largest`` as in
        `thirdbody.Particles.from_iso4406`, other arguments as in the class.
        """
        ends = {
            name: None if value is None else to_si(value, "m")
            for name, value in (("smallest", smallest), ("largest", largest))
        }
        n, diameter = suspension_of_iso4406(code, level=level, **ends)
        return cls(diameter=diameter, number=n, **others)

    # -------------------------------------------------------------------------- counts
    @property
    def columns_of_oil(self) -> float:
        """ε h n: all particles over a unit of area, also those below the film [1/m²]."""
        return self.entry * self.film * self.number

    def above(self, x: float) -> float:
        """η_a(>x): particles larger than x and than the film per area and overrolling [1/m²]."""
        return self.columns_of_oil * self._share(max(x, self.film), 0)

    def _share(self, x: float, power: int, top: float | None = None) -> float:
        """∫ y^power φ_a dy from x."""
        end = self.diameter.support[1] if top is None else top
        return float(self.diameter.partial_moment(power, x, end)) if end > x else 0.0

    def _number_above(self, x: float) -> float:
        """Particles or fragments larger than x per particle of the oil."""
        if self.strength is not None:
            sizes, number, _ = self._pieces([x])
            return float(number[sizes > x].sum())
        x, size = max(x, self.film), self.fragment
        if size is None:
            return self._share(x, 0)
        if x >= size:
            return 0.0
        return self._share(x, 0, size) + self._share(size, 3) / size**3

    def _size(self, count: float, lowest: float) -> float:
        """Size that a given number of pressed particles per particle of the oil exceeds."""
        from scipy.optimize import brentq

        top = self.diameter.support[1]
        if self.fragment is not None and self._number_above(self.fragment * (1 - 1e-12)) >= count:
            return self.fragment
        return float(
            brentq(lambda x: self._number_above(x) - count, lowest, top, xtol=1e-16, rtol=1e-13)
        )

    def _pieces(self, ends: Sequence[float]) -> tuple[Array, Array, tuple[float, float]]:
        """Whole particles and pieces in the film, for sums whose panels end at sizes [m].

        Sizes, numbers per particle of the oil, and of the particles that were pressed how many
        there were and how many broke.
        """
        assert self.strength is not None
        size, number, pressed, broken = [np.empty(0)], [np.empty(0)], 0.0, 0.0
        eps = [1 - self.film / end for end in ends if end > self.film]
        for share, component in self.diameter.components:
            scale, shape = component.standardised()
            gap, top = self.film / scale, shape.support[1]
            if gap >= top:
                continue
            breakage = Breakage.of_material(self.strength, self.material, scale)
            average = broken_average(self._particle(), shape, breakage)
            pieces = average.pieces(
                np.array([[gap]]), np.array([[top - gap]]), eps,
                nodes=NODES, squeezes=average.squeezes,
            )  # fmt: skip
            here = pieces.delta > 0
            size.append(scale * pieces.x[here])
            number.append(share * pieces.number[here])
            pressed += share * float(pieces.parents[here].sum())
            broken += share * float((pieces.parents * (1 - pieces.survival))[here].sum())
        return np.concatenate(size), np.concatenate(number), (pressed, broken)

    @property
    def broken_share(self) -> float:
        """Broken ones of the particles larger than the film, by number; 0 without a strength."""
        if self.strength is None:
            return 0.0
        pressed, broken = self._pieces([])[2]
        return broken / pressed if pressed else 0.0

    # -------------------------------------------------------------------------- dents
    def sinks(self, side: int) -> bool:
        """Whether it is known how deep the particles sit in surface 1 (side 0) or 2 (side 1)."""
        need_one("side", side, 0, 1)
        one = self._particle()
        H, knows_sink = one.sides[side].H, one.knows_sink[side]
        return not math.isnan(
            sink(self.material, hardness=H, debris=self.debris, computed=knows_sink)
        )

    def _deep(self, spots: ParticleSpots, side: int) -> Array:
        return sunk(spots, side=side, particle=self.material, debris=self.debris)

    def _dent(self, spots: ParticleSpots, side: int) -> Dent:
        dent = dent_of(spots, side=side, particle=self.material, debris=self.debris)
        widest = np.where(np.isnan(dent.depth), self._widest(side), math.inf)
        return dent._replace(diameter=np.minimum(dent.diameter, widest * spots.x))

    def _widest(self, side: int) -> float:
        """Largest mark of a flattened particle in surface 1 (side 0) or 2, over its size."""
        H = (self.surfaces.first, self.surfaces.second)[side].H
        return widest_disc(min(self.material.H, H), H)  # flattened, and so not harder

    def _marks(self, x: ArrayLike, side: int) -> Array:
        """Widths of the marks of particles that are flattened [m]."""
        return np.minimum(flattened_diameter(x, gap=self.film), self._widest(side) * np.asarray(x))

    def _flat_sentence(self, side: int) -> str:
        body = (self.surfaces.first, self.surfaces.second)[side - 1]
        what = (
            f"particles of {value_of(self.material.H, 'Pa')} hardness are not harder than surface "
            f"{side} of {value_of(body.H, 'Pa')}, and are flattened: numbers and widths are those "
            "of their footprints, depth and volume are not known (NaN); debris = 'hard' keeps the "
            "shape of all"
        )
        return Note(what, code=f"dents.flat.{side}", effect=math.inf)

    def single(self, x: ArrayLike) -> ParticleSpots:
        """Particles of sizes x [m] in the film, one each: (n, 1)."""
        return self._spots(np.atleast_1d(np.asarray(x, dtype=float))[:, None], np.array(1.0))

    def _particle(self) -> Any:
        law = Series(law=self.law, deep=self.deep, friction_factor=self.friction_factor)
        sides = contact_sides(self.surfaces, self.material)
        forms = law.forms(self.surfaces, self.material) if self.deep == "table" else (None, None)
        return squeezed_particle(self.law, *sides, 0.5, forms)

    def _spots(self, x: Array, number: Array) -> ParticleSpots:
        delta = np.maximum(x - self.film, 0.0)
        number = np.broadcast_to(number, x.shape)
        return self._particle().spots(x, delta, share=None, number=number)

    def _first(self, side: int) -> float:
        """Smallest size that dents a surface: that of first yield there; infinite for none."""
        particle = self._particle()
        if not self.sinks(side):
            return math.inf
        return self._sunk(side, float(particle.sides[side].delta_1))

    def _sunk(self, side: int, depth: float) -> float:
        """Smallest size that sinks this deep into a side, over its size; infinite for none."""
        from scipy.optimize import brentq

        particle = self._particle()

        def excess(eps: float) -> float:
            depths = particle.indentations(np.array([eps]))
            sinks = depths if self.debris == "hard" else particle.sinks(depths)
            return float(sinks[side][0]) / depth - 1

        if excess(particle.kinks[-1]) <= 0:
            return math.inf
        eps = float(brentq(excess, particle.kinks[0] * 1e-9, particle.kinks[-1], xtol=1e-16))
        return self.film / (1 - eps) if eps < 1 else math.inf

    def _half(self, side: int) -> float:
        """Smallest size that sits half its radius deep in a side."""
        return self._sunk(side, 0.25)

    def _nodes(self) -> tuple[Array, Array]:
        """Sizes of what is pressed, and how many of each per particle of the oil."""
        size, weight = [], []
        particle = self._particle()
        inner = particle.kinks[particle.kinks < 1]
        # first yield and half a radius are kinks of the dents, not all of the load
        sides = [where(side) for side in (0, 1) for where in (self._first, self._half)]
        if self.strength is not None:
            return self._pieces([size for size in sides if math.isfinite(size)])[:2]
        cuts = np.array([*(self.film / (1 - inner)), *(s for s in sides if math.isfinite(s))])
        for share, component in self.diameter.components:
            low, high = max(component.support[0], self.film), component.support[1]
            if component.support[0] == high:
                size.append(np.array([high] if high > self.film else []))
                weight.append(np.full(len(size[-1]), share))
                continue
            if self.fragment is not None:
                high = min(high, self.fragment)
            if high <= low:
                continue
            edges = np.unique(
                np.concatenate([[low, high], component.pieces, component.kinks, cuts])
            )
            edges = edges[(edges >= low) & (edges <= high)]
            x, w = panel_rule(subdivide(edges, width=math.inf, ratio=1.5), NODES)
            size.append(x)
            weight.append(share * w * component.pdf(x))
        x, w = np.concatenate([*size, []]), np.concatenate([*weight, []])
        if self.fragment is None:
            return x, w
        kept = x <= self.fragment
        broken = self._share(max(self.fragment, self.film), 3) / self.fragment**3
        if not self.fragment > self.film:
            return x[:0], w[:0]
        return np.append(x[kept], self.fragment), np.append(w[kept], broken)

    def dents(self, side: int = 1) -> FilmDents:
        """Dents in surface 1 or 2 per overrolling.

        Mean and p95 are over the dents; depth and diameter grow with the size of the particle, so
        that their distributions are that of the sizes in other variables. NaN where there are no
        dents. Of particles that are flattened: the footprints, whose depth and volume are not
        known (NaN); a warning says so unless ``debris`` does.

        Warns
        -----
        RangeWarning
            The particles are not harder than the surface.
        """
        need_one("side", side, 1, 2)
        if not self.sinks(side - 1):
            if self.debris != "ductile":
                tell_of_range(self._flat_sentence(side))
            return self._footprints(side - 1)
        lowest = self._first(side - 1)
        count = self._number_above(lowest) if math.isfinite(lowest) else 0.0
        if count == 0:
            return FilmDents()
        x, w = self._nodes()
        spots = self._spots(x[None, :], w[None, :])
        dent = self._dent(spots, side - 1)
        stay = (dent.depth > 0) & (2 * self._deep(spots, side - 1) > spots.half)
        top = self.single(self._size(0.05 * count, lowest))
        deep = self._dent(top, side - 1)
        return FilmDents(
            number=self.columns_of_oil * count,
            depth=float(spots.total(dent.depth)[0] / count),
            diameter=float(spots.total(dent.diameter)[0] / count),
            area=float(spots.total(np.pi / 4 * dent.diameter**2)[0] / count),
            volume=float(self.columns_of_oil * spots.total(dent.volume)[0]),
            depth_p95=float(deep.depth[0, 0]),
            diameter_p95=float(deep.diameter[0, 0]),
            embedded=min(1.0, float(spots.total(stay.astype(float))[0] / count)),
        )

    def _footprints(self, side: int) -> FilmDents:
        x, w = self._nodes()
        count = float(w.sum())
        if count == 0:
            return FilmDents()
        wide = self._marks(x, side)
        held = float(w @ (wide < flattened_diameter(x, gap=self.film)) / count)
        if held > 0:
            what = (
                f"{percent(held, digits=2)} of the flattened particles would press harder than "
                f"surface {side + 1} is: such a disc sinks in, and its mark is held to "
                f"{number(self._widest(side), 3)} times the particle's size"
            )
            tell_of_range(Note(what, code=f"dents.wide.{side + 1}", effect=held))
        top = self._size(0.05 * count, self.film)
        return FilmDents(
            number=self.columns_of_oil * count,
            depth=math.nan,
            diameter=float(w @ wide / count),
            area=float(np.pi / 4 * (w @ wide**2) / count),
            volume=math.nan,
            depth_p95=math.nan,
            diameter_p95=float(self._marks(top, side)),
            embedded=0.0,
        )

    def largest(self, area: float, *, overrollings: float = 1.0, side: int = 1) -> Dent:
        """The largest dent in so much surface [m²] after so many overrollings (median).

        Exceeded in half of all cases, A N η_a(>x) = ln 2; NaN where even one is unlikely. Of
        particles that are flattened the footprint alone is known.

        Parameters
        ----------
        area : float
            Of the surface A [m²].
        overrollings : float, optional
            N [1].
        side : int, optional
            1 or 2.

        Raises
        ------
        InvalidValue
            Another side; a surface or a number of overrollings below 0, or not finite.
        """
        need_one("side", side, 1, 2)
        problems = [
            Problem(name, "must be finite and >= 0", repr(value), code=Mistake.RANGE)
            for name, value in (("area", area), ("overrollings", overrollings))
            if not 0 <= value < math.inf
        ]
        if problems:
            raise InvalidValue(*problems)
        passed = self.columns_of_oil * area * overrollings
        wanted = math.log(2) / passed if passed else math.inf
        lowest = self._first(side - 1) if self.sinks(side - 1) else self.film
        if not math.isfinite(lowest) or self._number_above(lowest) <= wanted:
            return Dent(np.array(math.nan), np.array(math.nan), np.array(math.nan))
        dent = self._dent(self.single(self._size(wanted, lowest)), side - 1)
        return Dent(*(value[0, 0] for value in dent))

    def after(self, overrollings: ArrayLike, *, side: int = 1) -> Array:
        """Dents per area of surface 1 or 2 after N overrollings, see `dents_after` [1/m²]."""
        dents = self.dents(side)
        return dents_after(
            dents.number, overrollings=overrollings, area=0.0 if dents.number == 0 else dents.area
        )

    def severity_index(self) -> SeverityIndex:
        r"""Damaged volume per area and overrolling, with its parts.

        .. math:: I = \varepsilon h \int n\,\varphi_a\,(V_1+V_2+f_{ab}\,s\,A_g)\,dx

        A particle is held in the surface in which it sits deeper, and grooves the other; between
        equal surfaces it grooves both over half the way. Of particles that are flattened the
        volume is not known, and the index is NaN.
        The index orders oils of one machine; it is not a life. With a constant entry ratio a
        thicker film brings more oil, and with it more of the particles far larger than the film:
        per overrolling the index then rises with h, per volume of oil that passes (index over h)
        it falls, and so does the number of dents once ``smallest`` lies below the film.
        """
        x, w = self._nodes()
        if len(x) == 0 or float(w.sum()) * self.columns_of_oil == 0:
            return SeverityIndex()
        spots = self._spots(x[None, :], w[None, :])
        per_area = self.columns_of_oil
        volumes, grooves = [], []
        one, two = spots.depths if self.debris == "hard" else spots.sinks
        even = np.abs(one - two) <= 1e-9 * (one + two)
        for side, (here, there) in enumerate(((one, two), (two, one))):
            dent = self._dent(spots, side)
            volumes.append(per_area * float(spots.total(dent.volume)[0]))
            share = np.where(even, 0.5, here < there) * self.sinks(side)
            cut = share * groove_of(spots, side=side)
            removed = self.slip * (self.f_ab or 0.0)
            grooves.append(per_area * removed * float(spots.total(cut)[0]))
        softer, harder = sorted(spots.hardness)
        S = severity(spots.load, x=spots.x, H_1=softer, H_2=harder)
        above = (threshold(softer, H_b=harder) < S).astype(float)
        count = float(spots.number.sum())
        return SeverityIndex(
            total=sum(volumes) + sum(grooves),
            dents_1=volumes[0],
            dents_2=volumes[1],
            grooves_1=grooves[0],
            grooves_2=grooves[1],
            severity=float(spots.total(S)[0]) / count,
            above=float(spots.total(above)[0]) / count,
        )
