"""The consistent model: a particle is two contacts in series, and it rests somewhere."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ...quantities.value import choice, quantity
from ..asperity.hermite import Hermite
from ..base import REGIMES, AbstractAsperityLaw, AbstractParticleLaw, ParticleResponse
from ..spots import ParticleSpots
from .one_particle import contact_sides, squeezed_particle
from .sums import Part, SeatAverage, SeatedParticles, SizeAverage, seat_average, size_average

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ...populations.materials import Material, MaterialPair
    from ...populations.particles import Particles
    from ...populations.roughness import Roughness

    Array = NDArray[np.float64]

__all__ = ["Series"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Series(AbstractParticleLaw):
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
    Valid while x/2 ≪ R and x ≪ the lateral wavelength. Against explicit particles on explicit
    rough surfaces the ``rough`` seat gives the load share within 2, 6 and 10 % at x/σ = 2, 1
    and 0.67; ``plane`` and ``offset`` have the wrong sign of the load dependence.

    References
    ----------
    Horng et al. 2022, doi:10.3390/lubricants10070164, corrected as docs/errata.md says.

    Examples
    --------
    >>> law = Series()
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

    law: AbstractAsperityLaw = field(default_factory=Hermite)
    seat: str = choice("where particles rest", "rough", "plane", "offset", default="rough")
    h_0: float = quantity("h_0", "m", "seat height above the mean asperity plane", default=0.0)
    zeta_mean: float = quantity("m_ζ", "1", "mean seat height over σ", default=0.0)
    zeta_std: float = quantity("s_ζ", "1", "width of seat heights over σ", default=1.0, gt=0)
    shadow: str = choice(
        "area in which particles keep asperities apart",
        "footprint",
        "projected",
        "covered",
        "none",
        default="footprint",
    )

    @property
    def tip_radius(self) -> float:
        """Radius of the contacting tips over the size x [1]."""
        return 0.5

    def _problems(self) -> list[str]:
        out = []
        name = type(self).__name__
        if not isinstance(self.law, AbstractAsperityLaw):
            out.append(f"{name}.law = {self.law!r} must be a law of one contact, e.g. Hermite()")
        elif not self.law.scale_free:
            out.append(
                f"{name}.law = {type(self.law).__name__} has a length of its own; particles of "
                "all sizes need a law that only knows indentation over radius, e.g. Hermite()"
            )
        if self.h_0 != 0 and self.seat != "offset":
            out.append(
                f"{name}.h_0 = {self.h_0:g} has no meaning with seat = {self.seat!r}; "
                "set seat = 'offset'"
            )
        if self.seat != "rough" and (self.zeta_mean, self.zeta_std) != (0.0, 1.0):
            out.append(f"{name}.zeta_mean and zeta_std need seat = 'rough', not {self.seat!r}")
        return out

    def single(
        self, x: ArrayLike, gap: ArrayLike, *, surfaces: MaterialPair, particle: Material
    ) -> dict[str, Array]:
        """One particle between two flats.

        Parameters
        ----------
        x, gap : array_like
            Diameter and gap between the flats [m].
        surfaces : MaterialPair
        particle : Material

        Returns
        -------
        dict
            ``force`` [N], ``area_1``, ``area_2`` [m²], ``delta_1``, ``delta_2`` [m], and
            ``regime`` on surface 1.
        """
        x, gap = np.broadcast_arrays(np.asarray(x, float), np.asarray(gap, float))
        shape = x.shape
        x, eps = x.ravel(), np.maximum(1 - gap / x, 0.0).ravel()
        sides = contact_sides(surfaces, particle)
        law = squeezed_particle(self.law, *sides, self.tip_radius)
        values = law(eps) * x[:, None] ** 2
        one, two = (x * part for part in law.indentations(eps))
        names = np.array(REGIMES)[law.sides[0].regime(one / x)]
        return {
            "force": values[:, 0].reshape(shape),
            "area_1": values[:, 1:4].sum(axis=1).reshape(shape),
            "area_2": values[:, 4].reshape(shape),
            "delta_1": one.reshape(shape),
            "delta_2": two.reshape(shape),
            "regime": np.where(eps > 0, names, "none").reshape(shape),
        }

    def probe(self, eps: Array, *, surfaces: MaterialPair, particle: Material) -> ParticleSpots:
        law = squeezed_particle(self.law, *contact_sides(surfaces, particle), self.tip_radius)
        one = np.ones((len(eps), 1))
        return law.spots(one, eps[:, None], share=None, number=one)

    def response(
        self, surfaces: MaterialPair, roughness: Roughness, particles: Particles
    ) -> ParticleResponse:
        sides = contact_sides(surfaces, particles.material)
        parts = []
        for weight, sizes in particles.diameter.components:
            scale, shape = sizes.standardised()
            average: SizeAverage | SeatAverage
            average = size_average(self.law, *sides, shape, self.tip_radius)
            if self.seat == "rough":
                average = seat_average(average, self.zeta_std * roughness.sigma / scale)
            density = particles.areal_density * weight
            parts.append(Part(average, scale, density, offset=self.seat_offset(roughness)))
        return SeatedParticles(parts, self.shadow, self._coverage(particles))

    def seat_offset(self, roughness: Roughness) -> float:
        """Mean gap minus d [m]."""
        if self.seat == "rough":
            return roughness.y_s - self.zeta_mean * roughness.sigma
        return -self.h_0

    def _coverage(self, particles: Particles) -> float:
        """Projected particle area per nominal area [1]."""
        return 2 * self.tip_radius * particles.coverage

    def warnings(
        self, surfaces: MaterialPair, roughness: Roughness, particles: Particles
    ) -> list[str]:
        out = []
        # πd²/4 of a particle of size x is πx²·tip_radius/2
        radius = particles.diameter.mean_diameter * math.sqrt(0.5 * self.tip_radius)
        if self.seat == "rough" and radius > 0.5 * roughness.R:
            out.append(
                f"mean particle radius {radius:.3g} m is not small against the asperity "
                f"radius R = {roughness.R:.3g} m: the rough seat takes the surface under a "
                "particle as flat"
            )
        return out
