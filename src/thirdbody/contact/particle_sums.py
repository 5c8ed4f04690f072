r"""Sums over all particles between two surfaces, as functions of the separation.

.. math:: F_{sa} = \eta_a \int \varphi_a(x) \int_0^\infty f(x,\delta)\,
          p_\zeta(h - x + \delta)\,d\delta\,dx

and areas alike, for every law that says what one particle does. A law whose authors print the
sum itself registers it with `particle_sum`.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from functools import singledispatch
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..errors import Advice, InvalidValue, Mistake, Problem
from ..laws.base import COLUMNS, AbstractParticleLaw, SeatedLaw
from ..laws.particle.breakage import Breakage
from ..laws.particle.horng2022 import NO_ONE_PARTICLE, Horng2022
from ..populations.materials import MaterialPair, reduced_modulus
from ..populations.particles import Particles
from ..populations.roughness import Roughness
from ..quantities.say import value_of
from .broken_averages import BrokenAverage, broken_average
from .particle_averages import WIDEST, SeatAverage, SizeAverage, seat_average, size_average

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..laws.spots import ParticleSpots
    from ..populations.distributions import Distribution

    Array = NDArray[np.float64]
    Number = float | Array

__all__ = ["ParticleSum", "particle_sum", "printed_numbers", "together_in"]


@singledispatch
def particle_sum(
    law: AbstractParticleLaw, surfaces: MaterialPair, roughness: Roughness, particles: Particles
) -> ParticleSum:
    """The sum over one population, by the kind of its law."""
    raise InvalidValue(
        f"the particle law {law.name} has no sum: derive it from SeatedLaw, or register its sum "
        "with thirdbody.contact.particle_sums.particle_sum",
        code=Mistake.BEYOND,
    )


@particle_sum.register(SeatedLaw)
def _over_sizes_and_seats(
    law: SeatedLaw, surfaces: MaterialPair, roughness: Roughness, particles: Particles
) -> ParticleSum:
    of_shape = law.of_shape(particles.shape)
    one = of_shape.one(surfaces=surfaces, particle=particles.material)
    if (coverage := one.breadth * particles.coverage) >= 1:
        raise InvalidValue(law.describe_jam(coverage), code=Mistake.FULL)
    parts = []
    for weight, sizes in particles.diameter.components:
        scale, shape = sizes.standardised()
        average: SizeAverage | SeatAverage
        if particles.strength is None:
            average = size_average(one, shape)
        else:
            breakage = Breakage.of_material(particles.strength, particles.material, scale)
            average = broken_average(one, shape, breakage)
        if law.seat == "rough":
            width = law.zeta_std * roughness.sigma
            _need_room((average.top - average.bottom) * scale, width)
            average = seat_average(average, width / scale)
        density = particles.areal_density * weight
        parts.append(Part(average, scale, density, offset=law.seat_offset(roughness)))
    made = SeatedParticles(parts, law.shadow, coverage)
    if made.in_one_layer >= 1:
        raise InvalidValue(
            f"fragments in one layer would cover {made.in_one_layer:.3g} of the nominal area and "
            "it must stay below 1; use fragments = 'footprint' or fewer particles",
            code=Mistake.FULL,
        )
    return made


OWNER = "particles"
"""Whose mistakes are those of a population, which stands at a place of its own in a contact."""


def _need_room(span: float, width: float) -> None:
    """Refuse diameters that range over more of a rough seat than there are nodes for; all [m]."""
    if span > WIDEST * width:
        most, seat = value_of(WIDEST * width, "m", 3), value_of(width, "m", 3)
        rule = f": diameters range over {value_of(span, 'm', 3)}, and {most} is the most on a seat"
        hint = "check the units of sizes and roughness; where both are right the surface is smooth "
        hint += "for such particles, " + Advice("seat='plane'", 'particle_law.seat = "plane"')
        raise InvalidValue(
            Problem(
                "",
                f"{rule} as rough as {seat}",
                hint=hint,
                owner=OWNER,
                code=Mistake.BEYOND,
            )
        )


@particle_sum.register(Horng2022)
def _as_printed(
    law: Horng2022, surfaces: MaterialPair, roughness: Roughness, particles: Particles
) -> ParticleSum:
    return PrintedIntegrals(law, surfaces, roughness, particles)


class ParticleSum(ABC):
    """Particles between two surfaces, per nominal area, as functions of the separation d [m].

    Made by `particle_sum`.

    Examples
    --------
    >>> import numpy as np
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> dust = tb.Particles(material=tb.materials["SiO2"], areal_density=1e11,
    ...                     diameter=tb.distributions.Monodisperse(mean=300e-9))
    >>> made = particle_sum(tb.particle.Series(seat="plane"), tb.MaterialPair(steel, steel),
    ...                     tb.Roughness(sigma=100e-9, R=2.8e-6), dust)
    >>> f"{made.reach:.1e}", f"{made.fields(np.array([250e-9]))['F_sa'][0]:.3g} Pa"
    ('3.0e-07', '6.95e+06 Pa')
    """

    reach: float
    """Separation [m] above which no particle is loaded (or the load is negligible)."""
    monotone: bool = True
    """The load falls with d everywhere."""
    resolution: float = np.inf
    """Step of d [m] that resolves the load, where it is not monotone."""
    stretch: float = np.inf
    """Range of d [m] in which spots of many states are few enough to be laid out together."""
    in_one_layer: float = 0.0
    """Part of the nominal area that particles which break and their fragments would cover side by
    side where the gap closes, each as round as it came; fragments that are gone cover none."""
    marks: Array | tuple[float, ...] = ()
    """Separations d [m] between which load and shadow are smooth, where the law knows them."""

    @abstractmethod
    def load(self, d: Array) -> tuple[Array, Array]:
        """Pressure F_sa and shadow ς with first and second derivative: two arrays (N, 3)."""

    @abstractmethod
    def fields(self, d: Array) -> dict[str, Array]:
        """F_sa [Pa], A_e, A_ep, A_p on surface 1, A_sa2 on surface 2, and the shadow ς."""

    def direct_fields(self, d: Array) -> dict[str, Array]:
        """Fields at these d by quadrature, where that saves tables."""
        return self.fields(d)

    def touching(self, d: Array) -> Array:
        """Loaded particles per nominal area [1/m²] at d (N,)."""
        groups = self.spots(d)
        return np.sum([spots.total(np.sign(spots.load)) for spots in groups], axis=0)

    @abstractmethod
    def spots(self, d: Array, splits: Sequence[float] = ()) -> list[ParticleSpots]:
        """Every loaded particle at d (N,), in groups.

        Parameters
        ----------
        d : array (N,)
        splits : sequence of float, optional
            Squeezes over diameter ε where what is asked of a particle changes its formula.
        """


class ParticlesTogether(ParticleSum):
    """Several populations side by side: loads, areas and shadows add."""

    def __init__(self, sums: Sequence[ParticleSum]):
        self.sums = sums
        self.reach = max(response.reach for response in sums)
        self.monotone = all(response.monotone for response in sums)
        self.resolution = min(response.resolution for response in sums)
        self.stretch = min(response.stretch for response in sums)
        self.in_one_layer = sum(response.in_one_layer for response in sums)
        self.marks = np.concatenate([np.asarray(response.marks, float) for response in sums])

    def load(self, d: Array) -> tuple[Array, Array]:
        loads, shadows = zip(*(response.load(d) for response in self.sums), strict=True)
        return np.sum(loads, axis=0), np.sum(shadows, axis=0)

    def fields(self, d: Array) -> dict[str, Array]:
        return self._add_parts([response.fields(d) for response in self.sums])

    def direct_fields(self, d: Array) -> dict[str, Array]:
        return self._add_parts([response.direct_fields(d) for response in self.sums])

    @staticmethod
    def _add_parts(parts: Sequence[dict[str, Array]]) -> dict[str, Array]:
        return {name: np.sum([fields[name] for fields in parts], axis=0) for name in parts[0]}

    def touching(self, d: Array) -> Array:
        return np.sum([response.touching(d) for response in self.sums], axis=0)

    def spots(self, d: Array, splits: Sequence[float] = ()) -> list[ParticleSpots]:
        return [spots for response in self.sums for spots in response.spots(d, splits)]


class Part:
    """Particles of one shape of size distribution: an average, scaled; gap = d + offset."""

    def __init__(
        self, average: SizeAverage | SeatAverage, scale: float, density: float, *, offset: float
    ):
        self.average, self.scale, self.offset = average, scale, offset
        self.density = density
        self.factor = density * scale**2
        top = average.top if isinstance(average, SizeAverage) else average.high
        self.reach = scale * top - offset

    @property
    def breaks(self) -> bool:
        """Its particles break."""
        average = self.average
        one = average.average if isinstance(average, SeatAverage) else average
        return isinstance(one, BrokenAverage)

    @property
    def closed_area(self) -> float:
        """Part of the nominal area that its pieces cover where the gap closes, if they break."""
        one = self.average.particles
        return self.factor * one.closed_area if isinstance(one, BrokenAverage) else 0.0

    @property
    def resolution(self) -> float:
        """Step of d [m] fine enough for loads that rise and fall; else infinite."""
        if not self.breaks:
            return np.inf
        if isinstance(self.average, SeatAverage):  # nothing changes faster than the seat is wide
            return 0.25 * self.scale * self.average.width
        low, high = self.average.sizes.support
        return self.scale * (0.01 * low or 0.001 * high)

    @property
    def stretch(self) -> float:
        """Range of d [m] whose spots are laid out together: so many widths of the seat."""
        average = self.average
        if not isinstance(average, SeatAverage):
            return np.inf
        return STRETCH * self.scale * average.width

    @property
    def marks(self) -> Array:
        """Ends of the panels of the tables, as separations d [m]."""
        return self.scale * self.average.edges - self.offset

    def load(self, d: Array, shadow: int) -> Array:
        values = self.average.derivatives((d + self.offset) / self.scale, (0, shadow))
        return self.factor / self.scale ** np.arange(3) * values

    def columns(self, d: Array) -> Array:
        return self.factor * self.average((d + self.offset) / self.scale)

    def direct_columns(self, d: Array) -> Array:
        """Columns as of `columns`, by quadrature instead of tables."""
        return self.factor * self.average.direct((d + self.offset) / self.scale)

    def load_in_gaps(self, d: Array, squeeze: float) -> Array:
        """Pressure [Pa] at d on particles where the gap squeezes the largest one beyond ε: (N,)."""
        narrow = self._gap_under_largest(squeeze)
        return self.factor * self.average.load_in_gaps((d + self.offset) / self.scale, narrow)

    def most_in_gaps(self, d: Array, squeeze: float) -> Array:
        """Upper bound of `load_in_gaps`, from the load of each particle without a gap."""
        most = self.factor * self.average.floor[0]
        narrow = self._gap_under_largest(squeeze)
        return most * self.average.part_in_gaps((d + self.offset) / self.scale, narrow)

    def _gap_under_largest(self, squeeze: float) -> float:
        return (1 - squeeze) * self.average.particles.top

    def touching(self, d: Array) -> Array:
        """Loaded particles per nominal area [1/m²] at d (N,); all that are squeezed are."""
        if self.breaks:
            spots = self.spots(d)
            return spots.total(np.sign(spots.load))
        return self.density * self.average.touching((d + self.offset) / self.scale)

    def spots(self, d: Array, splits: Sequence[float] = ()) -> ParticleSpots:
        spots = self.average.spots((d + self.offset) / self.scale, splits)
        return spots.of_size(self.scale, self.density)


class SeatedParticles(ParticleSum):
    """The sum over the components of the size distribution."""

    def __init__(self, parts: list[Part], shadow: str, coverage: float):
        self.parts, self.coverage = parts, coverage
        self.shadow = shadow
        self.reach = max(component.reach for component in parts)
        self._shadow_column = COLUMNS.index(shadow) if shadow in COLUMNS else 0
        self.monotone = not any(component.breaks for component in parts)
        self.resolution = min((component.resolution for component in parts), default=np.inf)
        self.stretch = min((component.stretch for component in parts), default=np.inf)
        self.in_one_layer = sum(component.closed_area for component in parts)

    @property
    def marks(self) -> Array:  # type: ignore[override]
        # what does not change takes no load from asperities
        if self.shadow not in COLUMNS and self.monotone:
            return np.empty(0)
        return np.concatenate([component.marks for component in self.parts])

    def load(self, d: Array) -> tuple[Array, Array]:
        total = np.sum([component.load(d, self._shadow_column) for component in self.parts], axis=0)
        force, shadow = total[:, 0], total[:, 1]
        return force, self._shadow(shadow)

    def _shadow(self, values: Array) -> Array:
        if self.shadow in COLUMNS:
            return values
        fixed = np.zeros_like(values)
        if self.shadow == "covered":
            fixed[..., 0] = self.coverage
        return fixed

    def fields(self, d: Array) -> dict[str, Array]:
        return self._columns_of(np.sum([component.columns(d) for component in self.parts], axis=0))

    def direct_fields(self, d: Array) -> dict[str, Array]:
        return self._columns_of(
            np.sum([component.direct_columns(d) for component in self.parts], axis=0)
        )

    def _columns_of(self, total: Array) -> dict[str, Array]:
        total = np.maximum(total, 0.0)  # rounding of the other regimes
        return {
            "F_sa": total[:, 0],
            "A_e": total[:, 1],
            "A_ep": total[:, 2],
            "A_p": total[:, 3],
            "A_sa2": total[:, 4],
            "shadow": self._shadow(total[:, self._shadow_column][:, None])[:, 0],
        }

    def touching(self, d: Array) -> Array:
        return np.sum([component.touching(d) for component in self.parts], axis=0)

    def spots(self, d: Array, splits: Sequence[float] = ()) -> list[ParticleSpots]:
        return [component.spots(d, splits) for component in self.parts]


def together_in(sums: Sequence[ParticleSum]) -> ParticleSum:
    """Populations side by side, as one sum where their shadows follow one rule."""
    if len(sums) == 1:
        return sums[0]
    seated = [response for response in sums if isinstance(response, SeatedParticles)]
    if len(seated) < len(sums) or len({response.shadow for response in seated}) > 1:
        return ParticlesTogether(sums)
    return SeatedParticles(
        [component for response in seated for component in response.parts],
        seated[0].shadow,
        sum(response.coverage for response in seated),
    )


class PrintedNumbers(NamedTuple):
    """The numbers in the printed integrals; arrays where their inputs are."""

    C: Number
    h_e: Any
    area_factor: Number
    pressure: Number
    shadow_factor: Number


def printed_numbers(
    law: Horng2022,
    surfaces: MaterialPair,
    roughness: Roughness,
    particles: Particles,
    x_a: Number,
    mass: Number,
) -> PrintedNumbers:
    """The numbers in the printed integrals, of a law as it is or with arrays in it.

    Parameters
    ----------
    law, surfaces, roughness, particles
        As for `particle_sum`, or stand-ins with arrays.
    x_a, mass : float or array
        Nominal diameter [m] and the mass inside the truncation [1].
    """
    H1, H2, Ha = surfaces.first.H, surfaces.second.H, particles.material.H
    if law.hardness_rule == "softer":
        H1, H2 = np.minimum(H1, Ha), np.minimum(H2, Ha)
    elif law.hardness_rule == "replace2":
        H2 = Ha
    E1 = law.kappa_C * reduced_modulus(surfaces.first, particles.material)
    second = surfaces.E_star
    if law.second_modulus == "sa":
        second = reduced_modulus(surfaces.second, particles.material)
    C = 9 * math.pi**2 / 4 * ((H1 / E1) ** 2 + (H2 / (law.kappa_C * second)) ** 2)
    h_e = law.h_e_sigma * roughness.sigma + law.h_e_diameter * x_a
    if law.h_e_rule == "approach":
        h_e = C * x_a / 2
    eta = law.chi * particles.areal_density * (1.0 if law.normalise else mass)
    shadow_factor = math.pi * eta * H1 / (H1 + H2)
    if law.hardness_rule == "sum":
        return PrintedNumbers(C, h_e, math.pi * eta * Ha / (H1 + Ha), H1 + Ha, shadow_factor)
    return PrintedNumbers(C, h_e, math.pi * eta * H2 / (H1 + H2), H1, shadow_factor)


class PrintedIntegrals(ParticleSum):
    """The printed integrals in closed form, as functions of d."""

    monotone = False

    def __init__(
        self, law: Horng2022, surfaces: MaterialPair, roughness: Roughness, particles: Particles
    ):
        self.law, self.sizes = law, particles.diameter
        self.x_a = nominal_diameter(self.sizes)
        self.C, self.h_e, self.area_factor, self.pressure, self.shadow_factor = printed_numbers(
            law, surfaces, roughness, particles, self.x_a, self.sizes.retained_mass
        )
        low, high = self.sizes.support
        self.reach = high + self.h_e
        pieces = np.asarray(self.sizes.pieces)
        self.marks = np.unique(np.concatenate([pieces, pieces + self.h_e]))
        width = (high - low) / 6 or self.x_a
        self.resolution = min(roughness.sigma, self.h_e or np.inf, width) / 40

    def _moment(self, weight: str, a: Array | float, b: Array | float) -> Array:
        if weight == "xa2":
            return self.x_a**2 * self.sizes.partial_moment(0, a, b)
        return self.sizes.partial_moment(2, a, b)

    def _density(self, x: Array) -> Array:
        """w(x) φ_a(x); 0 where particles of one size jump in and out, which is no slope."""
        scale = self.x_a if self.law.weight == "xa2" else x
        pdf = self.sizes.pdf(x)
        return scale**2 * np.where(np.isfinite(pdf), pdf, 0.0)

    def _window(self, d: Array) -> Array:
        return self.C * self._moment(self.law.weight, d - self.h_e, d)

    def _above(self, d: Array) -> Array:
        """∫_d^x_max w_p φ_a dx, the plastic footprint."""
        if not self.law.plastic:
            return np.zeros_like(d)
        if self.law.plastic_weight == "xxd":
            m2 = self.sizes.partial_moment(2, d, np.inf)
            return m2 - d * self.sizes.partial_moment(1, d, np.inf)
        return self._moment(self.law.weight, d, np.inf)

    def _above_slope(self, d: Array) -> Array:
        if not self.law.plastic:
            return np.zeros_like(d)
        if self.law.plastic_weight == "xxd":
            return -self.sizes.partial_moment(1, d, np.inf)
        return -self._density(d)

    def _shadow(self, d: Array) -> Array:
        if self.law.shadow == "none":
            return np.zeros_like(d)
        lower = d if self.law.shadow == "d" else np.zeros_like(d)
        return self.shadow_factor * self._above(lower)

    def load(self, d: Array) -> tuple[Array, Array]:
        force, shadow = np.zeros((len(d), 3)), np.zeros((len(d), 3))
        window_slope = self.C * (self._density(d) - self._density(d - self.h_e))
        force[:, 0] = self._window(d) + self._above(d)
        force[:, 1] = window_slope + self._above_slope(d)
        force *= self.pressure * self.area_factor
        shadow[:, 0] = self._shadow(d)
        if self.law.shadow == "d":
            shadow[:, 1] = self.shadow_factor * self._above_slope(d)
        over = shadow[:, 0] >= 1
        shadow[over] = [1.0, 0.0, 0.0]
        return force, shadow

    def fields(self, d: Array) -> dict[str, Array]:
        window, above = (self.area_factor * share for share in (self._window(d), self._above(d)))
        elastic = window if self.law.particle_regime == "split" else np.zeros_like(d)
        total = window + above
        return {
            "F_sa": self.pressure * total,
            "A_e": elastic,
            "A_ep": np.zeros_like(d),
            "A_p": total - elastic,
            "A_sa2": total,
            "shadow": np.minimum(self._shadow(d), 1.0),
        }

    def spots(self, d: Array, splits: Sequence[float] = ()) -> list[ParticleSpots]:
        raise InvalidValue(NO_ONE_PARTICLE, code=Mistake.BEYOND)


STRETCH = 200.0
"""Widths of the seat over which spots of many states are laid out together."""


def nominal_diameter(sizes: Distribution) -> float:
    """x_a as the paper means it: the centre of the Gaussian, or the mean of another law [m]."""
    return getattr(sizes, "mean", None) or sizes.mean_diameter
