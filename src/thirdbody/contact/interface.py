r"""A contact: laws integrated over populations, at a given separation.

.. math:: F_{ss}(d) = \eta\int_d^\infty F(z-d)\,\phi(z)\,dz, \qquad
          F_t = (1-\varsigma)F_{ss} + F_{sa}
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidValue
from ..laws.base import AbstractParticleLaw, SeatedLaw
from ..populations.particles import Particles
from ..quantities.progress import advance
from .asperity_sums import asperity_sum
from .broken_averages import is_rough
from .contact import Contact, at_population
from .field_ground import put_on_ground
from .field_sums import FieldSum
from .particle_sums import OWNER, ParticleSum, SeatedParticles, particle_sum, together_in

Array = NDArray[np.float64]


class Interface:
    """A contact bound to its numbers: total load and every field as functions of d [m]."""

    def __init__(self, contact: Contact):
        advance()
        self.contact = contact
        laws = [contact.law_of(population) for population in contact.populations]
        self.asperities = asperity_sum(
            contact.asperity_law,
            contact.roughness,
            contact.surfaces,
            laws[0].centre if laws else 0.0,
        )
        self.populations = [
            _sum_at(place, law, contact) for law, place in zip(laws, contact.places, strict=True)
        ]
        if self.populations and isinstance(self.asperities, FieldSum):
            self.asperities, on_ground = put_on_ground(
                self.asperities,
                [
                    response
                    for response in self.populations
                    if isinstance(response, SeatedParticles)
                ],
                [law for law in laws if isinstance(law, SeatedLaw)],
                [population.diameter.mean_diameter for population in contact.populations],
            )
            self.populations = list(on_ground)
        self.particles = together_in(self.populations) if self.populations else None

    @property
    def mean_plane(self) -> float:
        """h − d [m]: separation from the mean surface plane minus d."""
        return self.contact.roughness.y_s - self.asperities.centre

    @property
    def lowest(self) -> float:
        """Lowest separation d [m] that is searched."""
        skin = self.asperities
        return float(skin.centre + skin.searched * skin.sigma_s)

    @property
    def why_lowest(self) -> str:
        """Clause that explains the lowest separation, to follow a length."""
        if self.one_field:
            h = (self.lowest + self.mean_plane) / self.contact.roughness.sigma
            return f"h = {h:.2g} sigma, {self.asperities.ends}"
        return f"{self.asperities.searched:g} sigma_s, where every asperity is in contact"

    @property
    def one_field(self) -> bool:
        """Whether the rough surface is one field of heights, not a sum over summits."""
        return isinstance(self.asperities, FieldSum)

    @property
    def rows(self) -> Array:
        """Separations d [m] of a table of ground; none where there is no such table."""
        return getattr(self.asperities, "rows", np.empty(0))

    def load(self, d: Array) -> Array:
        """F_t [Pa] with first and second derivative: (N, 3)."""
        two_body = self.asperities.load(d)
        if self.particles is None:
            return two_body
        force, shadow = self.particles.load(d)
        # squashed particles may spread until nothing is left to asperities
        shadow = np.where(shadow[:, :1] >= 1, [1.0, 0.0, 0.0], shadow)
        f, f1, f2 = two_body.T
        bare = 1 - shadow[:, 0]
        out = force.copy()
        out[:, 0] += bare * f
        out[:, 1] += bare * f1 - shadow[:, 1] * f
        out[:, 2] += bare * f2 - 2 * shadow[:, 1] * f1 - shadow[:, 2] * f
        return out

    def fields(self, d: Array) -> dict[str, Array]:
        """Pressures [Pa] and areas per nominal area at d."""
        return self._fields(d, None if self.particles is None else self.particles.fields(d))

    def direct_fields(self, d: Array) -> dict[str, Array]:
        """Fields at these d with particles by quadrature, which needs no table."""
        return self._fields(d, None if self.particles is None else self.particles.direct_fields(d))

    def _fields(self, d: Array, of_particles: dict[str, Array] | None) -> dict[str, Array]:
        F, *areas = self.asperities.fields(d).T
        zero = np.zeros_like(d)
        particle_fields = dict.fromkeys(("F_sa", "A_e", "A_ep", "A_p", "A_sa2", "shadow"), zero)
        if of_particles is not None:
            particle_fields = of_particles
            particle_fields["shadow"] = np.minimum(particle_fields["shadow"], 1.0)
        return together(F, areas, particle_fields)


def _sum_at(place: str, law: AbstractParticleLaw, contact: Contact) -> ParticleSum:
    """Sum of the population at a place; its own mistakes are told there."""
    population = contact.places[place]
    try:
        return particle_sum(law, contact.surfaces, contact.roughness, population)
    except InvalidValue as error:
        raise InvalidValue(
            *(
                at_population(problem, place, population) if problem.owner == OWNER else problem
                for problem in error.problems
            )
        ) from None


def together(
    F: Array, areas: Sequence[Array], particle_fields: Mapping[str, Array]
) -> dict[str, Array]:
    """Asperities (load, areas by regime) under the shadow of the particles, and both in sum."""
    bare = 1 - particle_fields["shadow"]
    split = {
        name: bare * area + particle_fields[name]
        for name, area in zip(("A_e", "A_ep", "A_p"), areas, strict=True)
    }
    A_ss = bare * sum(areas)
    A_sa = particle_fields["A_e"] + particle_fields["A_ep"] + particle_fields["A_p"]
    return {
        "F_ss": bare * F,
        "F_sa": particle_fields["F_sa"],
        "A_t": A_ss + A_sa,
        "A_ss": A_ss,
        "A_sa": A_sa,
        "A_sa2": particle_fields["A_sa2"],
        **split,
        "shadow": particle_fields["shadow"],
    }


def interface(contact: Contact) -> Interface:
    """The cached `Interface` of a contact: one for all that carry load alike, whatever else."""
    rough = is_rough() and any(
        population.strength is not None for population in contact.populations
    )
    return _interface(carrying(contact), rough)


def carrying(contact: Contact) -> Contact:
    """The contact by what decides how it carries load: no outputs, no labels, no conductivities."""
    pair, populations = contact.surfaces, contact.particles
    surfaces = pair.replace_unchecked(first=pair.first.carrying, second=pair.second.carrying)
    particles: Particles | tuple[Particles, ...] | None = None
    if isinstance(populations, tuple):
        particles = tuple(_carrying(population) for population in populations)
    elif populations is not None:
        particles = _carrying(populations)
    return contact.replace_unchecked(surfaces=surfaces, particles=particles, outputs=())


def _carrying(population: Particles) -> Particles:
    return population.replace_unchecked(material=population.material.carrying, name="")


@lru_cache(maxsize=512)
def _interface(contact: Contact, rough: bool) -> Interface:
    return Interface(contact)
