"""The consistent model: a particle is two contacts in series, and it rests somewhere."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Literal

from ...errors import Mistake, Note, Problem
from ...populations.shape import Angular
from ...quantities.value import choice, quantity
from ..asperity.hermite import SMOOTH
from ..base import HERMITE, AbstractAsperityLaw, AbstractParticleLaw, OneParticle, SeatedLaw
from .deep import DeepSqueeze
from .faces import FacedSide, Faces
from .one_particle import SideForm, SqueezedParticle, contact_sides, squeezed_particle
from .squashed import Squash

if TYPE_CHECKING:
    from ...populations.materials import Material, MaterialPair
    from ...populations.particles import Particles
    from ...populations.roughness import Roughness
    from ...populations.shape import Shape

__all__ = ["Deep", "Series"]

Deep = Literal["table", "off"]
"""Particles beyond small indentations: by the computed table, or as at small ones."""


@dataclass(frozen=True, kw_only=True)
class _OfTips(AbstractParticleLaw):
    """Base of particles whose tips follow a law of one contact: its field precedes the seat's."""

    __slots__ = ()
    law: AbstractAsperityLaw


@dataclass(frozen=True, slots=True, kw_only=True)
class Series(SeatedLaw, _OfTips):
    r"""A particle indents both surfaces with one load, from wherever it rests.

    A particle of diameter x in a local gap g is squeezed by δ = x − g, shared so that

    .. math:: F_1(\delta_1) = F_2(\delta - \delta_1) = f(x, \delta)

    with the single-contact ``law`` on both sides (radius x/2, softer hardness of each contact),
    the contact area never larger than the great circle πx²/4. Summed over sizes and seats,

    .. math:: F_{sa}(h) = \eta_a \int \varphi_a(x) \int_0^\infty f(x,\delta)\,
              p_\zeta(h - x + \delta)\,d\delta\,dx .

    Seats: where a particle rests decides most of its load.

    ``rough``
        at a random place of the equivalent surface, height ζ ~ N(m_ζ σ, (s_ζ σ)²) above its
        mean plane; local gap h − ζ. No adjusted parameter; the default for prediction.
    ``plane``
        on the mean plane of asperity heights; gap d. The paper's simplification.
    ``offset``
        on a plane h_0 above that; gap d − h_0.

    Parameters
    ----------
    law : AbstractAsperityLaw, optional
        The law of each contact; `Hermite` by default.
    soft : {"squashed", "sphere"}, optional
        What a particle does on a surface that is harder than itself: ``squashed``, it follows
        ``deep``, without which it keeps its volume and ends as a thin disc; ``sphere``, it stays a
        sphere of constant pressure up to its great circle.
    friction_factor : float, optional
        Shear stress on the faces of a squashed particle over its shear strength, m_f [1], above 0
        and at most 1; it decides how thin the disc becomes. 0.2 is an assumption.
    deep : {"table", "off"}, optional
        What a round particle does beyond small squeezes. ``table``: what large-deformation
        computations say for any squeeze and hardness ratio, in place of the squashed particle and
        of the sphere that sinks in whole; ``off``: those two, with their step at equal hardness.
        The other choices of ``soft`` and ``onset`` are laws without the table, and put it aside.
    onset : {"hermite", "jg"}, optional
        What squashing sets in with: ``hermite``, area and pressure of ``law`` (`Hermite` by
        default), or ``jg``, those of Jackson and Green, for E*/H of the particle from 8 to 150.
    seat : {"rough", "plane", "offset"}, optional
        Where particles rest.
    h_0 : float, optional
        Height of the seat above the mean asperity plane [m], for ``offset``.
    zeta_mean, zeta_std : float, optional
        Mean m_ζ and width s_ζ of the seat heights in units of σ [1], for ``rough``. Where
        particles lie is the main uncertainty of the model: valleys (m_ζ < 0) and peaks differ
        tenfold in load.
    shadow : {"footprint", "projected", "covered", "none"}, optional
        The share ς of nominal area in which loaded particles keep asperities apart: their
        larger contact area, their projected area when loaded, the projected area of all
        particles, or nothing. Asperity loads and areas are multiplied by 1 − ς.

    Notes
    -----
    With ``deep="off"`` a particle softer than a surface is squashed there, each half keeping its
    own volume. With the squash τ = 2δ/x of a half, and area A_L and pressure p_L of one contact by
    ``law``,

    .. math:: \frac{A}{x^2} = \frac{\min(A_L/x^2, \pi/6)}{1-\tau}, \qquad
        p = p_L\left\{1 - \frac{0.92}{2.84}\left[1-\cos\pi q\right]
        + \frac{2m_f}{3\sqrt3\cdot2.84}\frac{a/x}{1-\tau}\right\}

    with q = min(1, 2a/x), up to the hardness of the surface, into which the disc then sinks. The
    constraint falls to that of a column (Ghaednia et al. 2019, J. Tribol., seen in a public
    implementation) and friction on the faces raises the pressure of a thin disc. Against a sphere
    the load is about half at half squeeze and twenty times as much at 95 %. A particle as hard as
    the surface keeps the law of a sphere, and so does one whose ``law`` never becomes plastic. On
    measured spheres the pressure is 19 to 53 % too high (`docs/validation.md`), falling as it does.

    With ``deep="table"``, the default, a side of a particle follows rigid- and elastic-plastic
    flow computed for hardness ratios ρ = H_particle/H_surface from 0.5 to 5 and both limits, faces
    that are smooth to welded, and E*/H of 11 and more (`benchmarks/deep.py`; errors of 5 to 10 %
    stand in its
    table). A particle as hard as a surface is squashed, not embedded; it embeds from ρ = 1.4 to 2
    on with smooth faces and from 2 to 3 with rough ones. Up to ε = 0.05 the ``law`` holds, from
    0.15 the table. What the collars of the two surfaces carry where they touch, from ε = 0.7 on,
    is left to the surfaces. No measurement of hard particles at such squeezes is known; metal
    spheres between platens pressed with 0.7 to 0.8 HV where the computation says 0.85 to 1.0.

    Valid while x/2 ≪ R and x ≪ the lateral wavelength. Against explicit particles on explicit
    rough surfaces the ``rough`` seat gives the load share within 2, 6 and 10 % at x/σ = 2, 1
    and 0.67; ``plane`` and ``offset`` have the wrong sign of the load dependence.

    References
    ----------
    Horng et al. 2022, doi:10.3390/lubricants10070164, corrected as docs/errata.md says.

    Examples
    --------
    >>> import thirdbody as tb
    >>> law = tb.particle.Series()
    >>> law.seat, law.shadow
    ('rough', 'footprint')
    """

    name = "series"
    title = "Two contacts in series (consistent model)"
    year = 2026
    citation = (
        "thirdbody consistent model: two contacts in series on a rough seat, "
        "after Horng et al. 2022, Lubricants 10(7), 164"
    )
    doi = "10.3390/lubricants10070164"
    provenance = "derived"
    valid_range = "x/2 ≪ R, A_t < 0.2"
    breakable = True

    law: AbstractAsperityLaw = SMOOTH
    soft: Literal["squashed", "sphere"] = choice(
        "particles softer than a surface", default="squashed"
    )
    friction_factor: float = quantity(
        "m_f", "1", "shear factor on the faces of squashed particles", default=0.2, le=1
    )
    onset: Literal["hermite", "jg"] = choice("how squashed particles set in", default="hermite")
    deep: Deep = choice("particles beyond small indentations", default="table")

    @property
    def tip_radius(self) -> float:
        """Radius of the contacting tips over the size x [1]."""
        return 0.5

    @property
    def follows_table(self) -> bool:
        """Whether round particles follow the computed table, where ``law`` can yield."""
        return (self.deep, self.soft, self.onset) == ("table", "squashed", "hermite")

    def _problems(self) -> list[str]:
        out = []
        if not isinstance(self.law, AbstractAsperityLaw):
            out.append(
                Problem(
                    "law",
                    "must be a law of one contact, e.g. " + HERMITE,
                    repr(self.law),
                    code=Mistake.KIND,
                )
            )
        elif self.law.of_surface:
            out.append(
                Problem(
                    "law",
                    "is a law of a whole surface; particles "
                    "need a law of one contact, e.g. " + HERMITE,
                    f"{type(self.law).__name__}",
                    code=Mistake.BEYOND,
                )
            )
        elif not self.law.scale_free:
            out.append(
                Problem(
                    "law",
                    "has a length of its own; particles of "
                    "all sizes need a law that only knows indentation over radius, e.g. " + HERMITE,
                    f"{type(self.law).__name__}",
                    code=Mistake.BEYOND,
                )
            )
        if self.soft != "squashed" and (self.friction_factor, self.onset) != (0.2, "hermite"):
            out.append(
                Problem(
                    "friction_factor",
                    f"and onset need soft = 'squashed', not {self.soft!r}",
                    code=Mistake.IDLE,
                )
            )
        if not self.friction_factor > 0:
            out.append(
                Problem(
                    "friction_factor",
                    "must be > 0: without friction "
                    "on its faces a squashed particle spreads without bound",
                    f"{self.friction_factor:g}",
                    code=Mistake.RANGE,
                )
            )
        return out + SeatedLaw._problems(self)

    def forms(
        self, surfaces: MaterialPair, particle: Material
    ) -> tuple[SideForm | None, SideForm | None]:
        """Forms of the sides of the particle that are no sphere of constant hardness."""

        def form(surface: Material) -> SideForm | None:
            if self.follows_table:
                return DeepSqueeze(particle.H / surface.H, self.friction_factor)
            if self.soft != "squashed" or not particle.H < surface.H:
                return None
            return Squash(surface.H, self.friction_factor, self.onset)

        return form(surfaces.first), form(surfaces.second)

    def one(self, *, surfaces: MaterialPair, particle: Material) -> OneParticle:
        sides = contact_sides(surfaces, particle)
        forms = self.forms(surfaces, particle)
        return squeezed_particle(self.law, *sides, self.tip_radius, forms)

    def of_shape(self, shape: Shape) -> Series:
        if not isinstance(shape, Angular):
            return self
        field_values = {item.name: getattr(self, item.name) for item in fields(Series)}
        return _OfAngular(**field_values, shape=shape)


@dataclass(frozen=True, slots=True, kw_only=True)
class _OfAngular(Series):
    """The same between the surfaces and angular particles of one shape."""

    shape: Angular

    @property
    def tip_radius(self) -> float:
        return self.shape.tip_radius

    def forms(self, surfaces: MaterialPair, particle: Material) -> tuple[None, None]:
        """None is squashed: a tip softer than the surface is blunted at its own hardness."""
        return None, None

    def one(self, *, surfaces: MaterialPair, particle: Material) -> SqueezedParticle:
        sides = contact_sides(surfaces, particle)
        faces = Faces(self.shape)
        return squeezed_particle(self.law, *sides, self.tip_radius, (faces, faces), self.shape)

    def of_shape(self, shape: Shape) -> Series:
        return self if shape == self.shape else Series.of_shape(self, shape)

    def warnings(
        self, surfaces: MaterialPair, roughness: Roughness, particles: Particles
    ) -> list[str]:
        out = SeatedLaw.warnings(self, surfaces, roughness, particles)
        one = self.one(surfaces=surfaces, particle=particles.material)
        least = min((s.pressure for s in one.sides if isinstance(s, FacedSide)), default=1.0)
        if least < BLUNT:
            name = particles.name or particles.material.name or "the particles"
            what = (
                f"{name}: faces at {math.degrees(self.shape.angle):.3g}° are so blunt that they "
                f"never yield fully (their mean pressure stays at {least:.2g} H); the law of a "
                "tip carried over to faces is some 15 % low where they stay elastic"
            )
            out.append(Note(what, code=f"{name}.blunt", effect=0.15))
        return out


BLUNT = 0.6
"""Mean pressure on faces over H below which they are told of."""
