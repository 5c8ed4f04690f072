"""What resists sliding: sheared contacts, ploughed surfaces, and particles that roll or slide."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from ..contact.evaluation import bodies_of
from ..contact.output import AbstractOutput, Column, changes
from ..errors import Mistake, Note, Problem
from ..populations.shape import CUTS
from ..quantities.say import value_of
from ..quantities.value import choice, quantity
from .single.ploughing import coefficient, coefficient_of_faces, rear_support
from .single.severity import severity, threshold

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from ..contact.contact import Contact
    from ..contact.evaluation import Solved
    from ..contact.output import Probe
    from ..contact.spots import AsperitySpots
    from ..laws.spots import ParticleSpots

    Array = NDArray[np.float64]
    Flags = NDArray[np.bool_]
    Sides = NDArray[np.intp]

__all__ = ["Friction", "Motion", "changes"]

PARTS = ("ss_shear", "ss_plough", "sa_shear", "sa_plough", "sa_roll")
TUMBLES = 1.74
"""Longest axis over gap below which a particle that is no sphere can turn over."""
TIE = 1e-12
"""Two ways of sliding that differ by less, relatively, cost the same."""


class Motion(NamedTuple):
    """Motion of particles and its cost for each: arrays (M, n).

    A particle takes the cheapest of three motions; see `Friction`.

    Examples
    --------
    >>> import numpy as np
    >>> one, two = np.array([[0.2]]), np.array([[0.3]])
    >>> Motion(rolls=one < two, side=np.array([[0]]), shear=np.array([[1e-6]]), plough=(one, two),
    ...        resistance=(one + two) / 2).resistance.item()
    0.25
    """

    rolls: Flags
    """Whether it rolls."""
    side: Sides
    """Surface it slides over where it does not roll: 0 the first, 1 the second."""
    shear: Array
    """Force [N] of shear on that side."""
    plough: tuple[Array, Array]
    """Ploughing force of sliding over either surface, over the load [1]."""
    resistance: Array
    """Rolling force over the load [1]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Friction(AbstractOutput):
    r"""Coefficient of friction with its parts: shear, ploughing and rolling.

    .. math:: \mu\,p = \sum_{ss} n\,(\tau_{ss} a+\mu_p f) + \sum_{sa} n\,T, \qquad
              T = \begin{cases}\tfrac12(\mu_{p1}+\mu_{p2}) f & \text{rolls}\\
              \mu_{pi} f+\tau_{sa} a_i & \text{slides over } i\end{cases}

    A particle slides where that costs less. It rolls when that costs less than both ways of
    sliding, which for a sphere is when the shear force it can pass on balances the moments:
    :math:`\tfrac12|\mu_{p1}-\mu_{p2}|\,f < \tau_{sa} a_i` on the side of smaller ploughing. It
    then rolls between equal surfaces, and between unequal ones sits in the softer one and
    grooves the harder.

    Parameters
    ----------
    tau_ss, tau_sa : float
        Shear strength of the contacts between the surfaces, and between particles and surfaces
        [Pa]. Nobody can predict them: one of τ and m is required for each kind of contact.
    m_ss, m_sa : float, instead of tau_ss, tau_sa
        Shear strength over that of the softer body, k = H/(3√3) (H = 3 Y and Mises) [1].
    alpha_ss, alpha_sa : float, optional
        Growth of the shear strength with the mean pressure of a contact, τ = τ_0 + α p [1].
    alpha_T : float, optional
        Turns on junction growth: a contact yields at p² + α_T τ² = H² and grows until its
        pressure obeys that. About 9 (from memory: not confirmed in a source). The shear strength
        of m is then that of the same criterion, k = H/√α_T.
    rear : "recovery", "rigid" or float, optional
        Support κ of the rear half of a ploughing contact over that of the front half: by elastic
        recovery (`thirdbody.effects.single.ploughing.rear_support`), none, or a number from 0 to 1.
    angle : {"depth", "area"}, optional
        Angle of a ploughing contact from its depth, cos θ = 1−δ/r, or area, sin θ = √(a/πr²).
    hardness_ratio : float, optional
        Asperities plough the softer surface when the other is harder by more than this factor;
        otherwise they flatten. 1.2 (from memory: not confirmed in a source).
    soft_particles : {"flatten", "plough"}, optional
        Of particles whose law does not say how deep they sink: one softer than a surface is
        deformed itself, and ploughs nothing when it slides there; "plough" treats it like a hard
        one. With `thirdbody.particle.Series` at its default, every particle ploughs as deep as it
        sinks.
    rolling : {"moment", "severity"}, optional
        Cheapest motion as above, or the severity of the contact below a threshold from tests
        with angular abrasive (`thirdbody.effects.single.severity`), the softer surface being the
        specimen.
    aspect : float, optional
        Longest axis of a particle over its size x, 1 for spheres [1]. A longer one rolls only if
        it can turn over besides: longest axis over gap below 1.74 (Williams and Hyncica;
        recalled: no source was found, and a body that spans the gap would have to be held with a
        coefficient of 1.42).
    offset : float, optional
        e/x, how far apart along the motion a grain touches the two surfaces, over its size [1]; 0
        for spheres. A grain with an offset rolls if it turns over before it slides, which in a
        gap g is where :math:`\min_i(\mu_{pi}+\tau_{sa}a_i/f) \ge e/g`.

    Notes
    -----
    Depth and area are those of the normal load alone; with κ < 1 a contact held at constant load
    would sink in deeper, so that ``rear="rigid"`` at the solved depth is an upper bound. The
    vertical part of the shear traction, of order θ²τ/H, and drag of a fluid are left out. What
    holds for a sphere is used for flakes with the radius of their tips.

    How deep a particle ploughs is the sink that its law tells. One of 1.5 times the hardness of
    the surfaces, as in the example, is squashed more than it sinks: μ is 0.069 where a particle
    that keeps its shape, ``Series(deep="off")``, gives 0.212. With faces of the particle smooth to
    welded (``friction_factor`` 0.05 to 1) it is 0.084 to 0.048.

    The verdict depends on the squeeze ε of a particle alone, also where τ depends on pressure or
    hardness, as every pressure does. Sums are split where it changes, and then as accurate as the
    contact itself (measured: 1e-8; 1e-5 where asperities' junctions grow).

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> silica = tb.Particles(material=tb.materials["SiO2"], areal_density=1e10,
    ...                       diameter=tb.TruncatedGaussian(mean=500e-9, std=100e-9))
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel), particles=silica,
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...                      outputs=tb.outputs.Friction(tau_ss=580e6, tau_sa=200e6))
    >>> state = tb.solve(contact, pressure=5e6)
    >>> f"μ = {state.outputs['mu']:.3f}, rolling {state.outputs['rolling_share']:.0%}"
    'μ = 0.069, rolling 100%'
    """

    tau_ss: float | None = quantity(
        "τ_ss", "Pa", "shear strength between the surfaces", default=None, ge=0
    )
    tau_sa: float | None = quantity(
        "τ_sa", "Pa", "shear strength between particles and surfaces", default=None, ge=0
    )
    m_ss: float | None = quantity(
        "m_ss", "1", "τ_ss over the shear strength of the softer body", default=None, ge=0, le=1
    )
    m_sa: float | None = quantity(
        "m_sa", "1", "τ_sa over the shear strength of the softer body", default=None, ge=0, le=1
    )
    alpha_ss: float = quantity("α_ss", "1", "growth of τ_ss with pressure", default=0.0, ge=0)
    alpha_sa: float = quantity("α_sa", "1", "growth of τ_sa with pressure", default=0.0, ge=0)
    alpha_T: float | None = quantity(
        "α_T", "1", "weight of shear in the yield of a growing contact", default=None, gt=0
    )
    rear: str | float = "recovery"
    angle: Literal["depth", "area"] = choice(
        "what the angle of a ploughing contact follows from", default="depth"
    )
    hardness_ratio: float = quantity(
        "H_1/H_2", "1", "hardness ratio above which asperities plough", default=1.2, ge=1
    )
    soft_particles: Literal["flatten", "plough"] = choice(
        "particles softer than a surface", default="flatten"
    )
    rolling: Literal["moment", "severity"] = choice(
        "what decides that a particle rolls", default="moment"
    )
    aspect: float = quantity("D_l/x", "1", "longest axis over size", default=1.0, ge=1)
    offset: float = quantity("e/x", "1", "offset of both contacts over size", default=0.0, ge=0)

    name = "friction"
    title = "Friction"
    year = 2026
    citation = "thirdbody: shear, ploughing and rolling of the contacts of a solved state"
    provenance = "derived"
    valid_range = "dry sliding; depths up to the radius of what ploughs"
    follows_sinks = True
    columns = {
        "mu": Column("μ", "1", "coefficient of friction"),
        "mu_ss_shear": Column("μ_ss,τ", "1", "part of μ: shear of asperities"),
        "mu_ss_plough": Column("μ_ss,p", "1", "part of μ: ploughing by asperities"),
        "mu_sa_shear": Column("μ_sa,τ", "1", "part of μ: shear of sliding particles"),
        "mu_sa_plough": Column("μ_sa,p", "1", "part of μ: ploughing by sliding particles"),
        "mu_sa_roll": Column("μ_sa,r", "1", "part of μ: rolling particles"),
        "mu_plough_1": Column("μ_p,1", "1", "part of μ: tracks in surface 1"),
        "mu_plough_2": Column("μ_p,2", "1", "part of μ: tracks in surface 2"),
        "mu_ss": Column("μ_ss", "1", "friction of the asperities over their load"),
        "mu_sa": Column("μ_sa", "1", "friction of the particles over their load"),
        "rolling_share": Column("w_r", "1", "share of the particles' load on rolling ones"),
    }

    def _problems(self) -> list[str]:
        out: list[str] = []
        if self.tau_ss is None and self.m_ss is None:
            out.append(
                Problem(
                    "tau_ss",
                    "is missing: give the shear strength between the surfaces [Pa], "
                    "or m_ss; no value fits all surfaces",
                    code=Mistake.MISSING,
                )
            )
        for kind in ("ss", "sa"):
            tau, m, _ = self._strength(kind)
            if tau is not None and m is not None:
                out.append(
                    Problem(
                        f"tau_{kind}",
                        f"and m_{kind} = {m:g}: give one of them",
                        f"{tau:g}",
                        code=Mistake.CLASH,
                    )
                )
        if self.rear not in ("recovery", "rigid"):
            number = isinstance(self.rear, int | float) and not isinstance(self.rear, bool)
            if not (number and 0 <= self.rear <= 1):  # type: ignore[operator]
                out.append(
                    Problem(
                        "rear",
                        "must be 'recovery', 'rigid', or a number from 0 to 1",
                        repr(self.rear),
                        code=Mistake.OPTION,
                    )
                )
        if self.offset > 0 and self.rolling != "moment":
            out.append(
                Problem(
                    "offset",
                    f"needs rolling = 'moment', whose balance it enters, not {self.rolling!r}",
                    f"{self.offset:g}",
                    code=Mistake.IDLE,
                )
            )
        return out

    def problems(self, contact: Contact) -> list[str]:
        out: list[str] = []
        if contact.populations and self.tau_sa is None and self.m_sa is None:
            out.append(
                self.problem(
                    "needs tau_sa, the shear strength between particles and surfaces [Pa], or m_sa",
                    code=Mistake.MISSING,
                )
            )
        if self.alpha_T is None:
            return out
        one, two, *particles = (body.H for body in bodies_of(contact).values())
        softest = {"ss": min(one, two), "sa": min(one, two, *particles)}
        for kind in ("ss", "sa") if particles else ("ss",):
            tau, m, _ = self._strength(kind)
            k = softest[kind] / math.sqrt(self.alpha_T)
            if m == 1:
                out.append(
                    self.problem(
                        f": junctions of m_{kind} = 1 would grow without end",
                        code=Mistake.BEYOND,
                    )
                )
            if tau is not None and tau >= k:
                out.append(
                    self.problem(
                        f": junctions of tau_{kind} = {tau:g} Pa would grow without end",
                        hint=f"with alpha_T = {self.alpha_T:g} it must be < {value_of(k, 'Pa')}",
                        code=Mistake.RANGE,
                    )
                )
        return out

    # ------------------------------------------------------------------ one contact
    def _strength(self, kind: str) -> tuple[float | None, float | None, float]:
        """τ, m and α of one kind of contact."""
        if kind == "ss":
            return self.tau_ss, self.m_ss, self.alpha_ss
        return self.tau_sa, self.m_sa, self.alpha_sa

    def shear_force(self, kind: str, *, area: Array, load: Array, H: float) -> Array:
        """Force of shear [N] of contacts of one kind.

        Parameters
        ----------
        kind : {"ss", "sa"}
        area, load : array
            Area [m²] and load [N] of one contact.
        H : float
            Hardness of its softer body [Pa].
        """
        tau_0, alpha, _ = self._law(kind, H)
        return tau_0 * self._growth(kind, area, load, H) * area + alpha * load

    def _law(self, kind: str, H: float) -> tuple[float, float, float]:
        """τ_0, α, and the pressure at which a contact under full shear yields (0: no growth)."""
        tau, m, alpha = self._strength(kind)
        shear_yield = H / (3 * math.sqrt(3) if self.alpha_T is None else math.sqrt(self.alpha_T))
        tau_0 = tau if tau is not None else (m or 0.0) * shear_yield
        if self.alpha_T is None:
            return tau_0, alpha, 0.0
        # p² + α_T (τ_0 + αp)² = H²
        a, b = 1 + self.alpha_T * alpha**2, self.alpha_T * tau_0 * alpha
        c = H**2 - self.alpha_T * tau_0**2
        return tau_0, alpha, c / (b + math.sqrt(b**2 + a * c))

    def _growth(self, kind: str, area: Array, load: Array, H: float) -> Array | float:
        """Grown area over the area of the normal load alone."""
        if self.alpha_T is None:
            return 1.0
        reached = self._law(kind, H)[2] * area
        return np.maximum(1.0, np.divide(load, reached, out=np.ones_like(load), where=reached > 0))

    def _support(self, depth: Array, yielding: Any) -> Any:
        """Support κ of a contact; ``yielding`` is its depth at first yield [m]."""
        if self.rear == "recovery":
            return rear_support(np.divide(depth, yielding, where=depth > 0, out=0.0 * depth))
        return 0.0 if self.rear == "rigid" else self.rear

    def _plough(self, depth: Array, radius: Array | float, area: Array, yielding: object) -> Array:
        """μ_p of a tip; ``yielding`` is its depth at first yield [m]."""
        kappa = self._support(depth, yielding)
        if self.angle == "area":
            share = np.minimum(area / (np.pi * np.square(radius)), 1.0)
            depth = radius * share / (1 + np.sqrt(1 - share))
        return coefficient(depth, radius=radius, rear=kappa)

    def _plough_by(self, spots: ParticleSpots, side: int) -> Array:
        """μ_p of particles on one side."""
        shape, radius = spots.shape, spots.impression_radius(side)
        depth, area = spots.sinks[side], spots.areas[side]
        yielding = spots.yields[side] * spots.x
        if shape is None or shape.round:
            return self._plough(depth, radius, area, yielding)
        return coefficient_of_faces(
            np.sqrt(area / np.pi),
            edge=shape.edge * spots.x,
            angle=shape.angle,
            rear=self._support(depth, yielding),
        )

    def ratio(self, contact: Contact) -> float:
        """Hardness of the harder surface over that of the softer."""
        one, two = contact.surfaces.first.H, contact.surfaces.second.H
        return max(one, two) / min(one, two)

    def of_asperities(self, spots: AsperitySpots, ratio: float = 1.0) -> dict[str, Array]:
        """Tangential force of one asperity [N] by cause: arrays (M, n).

        Parameters
        ----------
        spots : AsperitySpots
        ratio : float, optional
            Hardness of the harder surface over that of the softer.
        """
        force = {
            "ss_shear": self.shear_force("ss", area=spots.area, load=spots.load, H=spots.H),
            "ss_plough": np.zeros_like(spots.load),
        }
        if ratio > self.hardness_ratio:
            law = spots.law.bound(R=spots.R, E_star=spots.E_star, H=spots.H)
            omega_1 = law.yield_interference(R=spots.R, E_star=spots.E_star, H=spots.H)
            depth = np.maximum(spots.depth, 0.0)
            force["ss_plough"] = self._plough(depth, spots.R, spots.area, omega_1) * spots.load
        return force

    def indents(self, spots: ParticleSpots) -> tuple[bool, bool]:
        """Whether the particles plough surface 1, and surface 2."""
        if self.soft_particles == "plough" or spots.material is None:
            return True, True
        # the softer body of a contact with a softer particle is the particle
        one, two = (
            computed or spots.material.H > H
            for computed, H in zip(spots.knows_sink, spots.hardness, strict=True)
        )
        return one, two

    def motion(self, spots: ParticleSpots) -> Motion:
        """How every particle moves; found once for all outputs that ask."""
        if self not in spots.kept:
            spots.kept[self] = self._motion(spots)
        return spots.kept[self]

    def _motion(self, spots: ParticleSpots) -> Motion:
        acting = self.indents(spots)
        deform = [self._plough_by(spots, 0)]
        deform.append(deform[0] if spots.has_alike_sides else self._plough_by(spots, 1))
        one, two = (mu * acts for mu, acts in zip(deform, acting, strict=True))
        resistance = 0.5 * (deform[0] + deform[1])
        shear = [
            self.shear_force("sa", area=area, load=spots.load, H=H)
            for area, H in zip(spots.areas, spots.hardness, strict=True)
        ]
        slide = (one * spots.load + shear[0], two * spots.load + shear[1])
        side = (slide[1] < slide[0] * (1 - TIE)).astype(np.intp)
        gap = spots.x - spots.depths[0] - spots.depths[1]
        if self.offset > 0:
            held = np.minimum(*slide) * np.maximum(gap, 0.0)
            rolls = (held >= self.offset * spots.x * spots.load) & (spots.load > 0)
        elif self.rolling == "moment":
            rolls = resistance * spots.load < np.minimum(*slide) * (1 - TIE)
        else:
            softer, harder = sorted(spots.hardness)
            S = severity(spots.load, x=spots.x, H_1=softer, H_2=harder)
            rolls = (threshold(softer, H_b=harder) > S) & (spots.load > 0)
        if self.aspect > 1:
            rolls &= self.aspect * spots.x < TUMBLES * gap
        return Motion(rolls, side, np.where(side, shear[1], shear[0]), (one, two), resistance)

    def of_particles(self, spots: ParticleSpots) -> dict[str, Array]:
        """Tangential force of one particle [N] by cause: arrays (M, n)."""
        motion = self.motion(spots)
        slides = ~motion.rolls
        return {
            "sa_shear": slides * motion.shear,
            "sa_plough": slides * np.where(motion.side, *motion.plough[::-1]) * spots.load,
            "sa_roll": motion.rolls * motion.resistance * spots.load,
        }

    def rolls(self, spots: ParticleSpots) -> Flags:
        """Which particles roll: (M, n)."""
        return self.motion(spots).rolls

    def sliding_side(self, spots: ParticleSpots) -> Sides:
        """Surface that a particle slides over: 0 the first, 1 the second; (M, n).

        Meaningless where it rolls; 0 where both surfaces resist alike.
        """
        return self.motion(spots).side

    # ------------------------------------------------------------------ the interface
    def one_by_one(self, contact: Contact) -> bool:
        # shear goes by area and load in all; spots that grow and tips that plough do not
        return self.alpha_T is not None or self.ratio(contact) > self.hardness_ratio

    def of(self, state: Solved) -> dict[str, Array]:
        nothing = np.zeros_like(state.d)
        force = dict.fromkeys((*PARTS, "plough_1", "plough_2", "rolling"), nothing)

        def add(spots: AsperitySpots | ParticleSpots, values: Mapping[str, Array]) -> None:
            for name, spot_forces in values.items():
                force[name] = force[name] + spots.total(spot_forces)

        ratio = self.ratio(state.contact)
        for asperities in state.asperities:
            add(asperities, self.of_asperities(asperities, ratio))
        surfaces = state.contact.surfaces
        softer = 1 if surfaces.first.H < surfaces.second.H else 2
        force[f"plough_{softer}"] = force["ss_plough"]
        for particles in state.particles:
            motion = self.motion(particles)
            add(particles, self.of_particles(particles))
            add(particles, {"rolling": motion.rolls * particles.load})
            for i, track in enumerate(motion.plough):
                # a rolling particle leaves half a track on either side, and so does one that
                # slides over either of two surfaces alike
                share = np.where(motion.rolls | particles.even, 0.5, motion.side == i)
                add(particles, {f"plough_{i + 1}": share * track * particles.load})
        F_ss = state.total(lambda spots: spots.load)
        F_sa = state.total_of_particles(lambda spots: spots.load)
        T_ss = force["ss_shear"] + force["ss_plough"]
        T_sa = force["sa_shear"] + force["sa_plough"] + force["sa_roll"]
        with np.errstate(invalid="ignore", divide="ignore"):
            return {
                "mu": (T_ss + T_sa) / state.pressure,
                **{f"mu_{term}": force[term] / state.pressure for term in PARTS},
                "mu_plough_1": force["plough_1"] / state.pressure,
                "mu_plough_2": force["plough_2"] / state.pressure,
                "mu_ss": T_ss / F_ss,
                "mu_sa": T_sa / F_sa,
                "rolling_share": force["rolling"] / F_sa,
            }

    def warnings(self, state: Solved, values: Mapping[str, Array]) -> list[str]:
        shapes = (spots.shape for spots in state.particles)
        steep = [
            shape.angle
            for shape in shapes
            if shape and shape.has_touching_faces and shape.angle > CUTS
        ]
        if not steep:
            return []
        what = (
            f"outputs.friction: faces at {math.degrees(max(steep)):.3g}° cut rather than plough "
            "(critical angles from 45° are quoted for copper): grooves and the ploughing force are "
            "those of a plough that displaces"
        )
        return [Note(what, code=f"{self.name}.cuts")]

    def splits(self, probe: Probe) -> Sequence[float]:
        def kind(spots: ParticleSpots) -> NDArray[np.intp]:
            motion = self.motion(spots)
            out = np.where(motion.rolls, 2, motion.side)
            for side, (area, H) in enumerate(zip(spots.areas, spots.hardness, strict=True)):
                grown = self._growth("sa", area, spots.load, H) > 1.0
                computed = spots.knows_sink[side]
                ends = spots.impression_radius(side) if computed else spots.half
                out = 4 * out + 2 * grown + (spots.sinks[side] > ends)
            return out

        return changes(probe, kind)
