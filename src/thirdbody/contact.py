r"""A contact: laws integrated over populations, at a given separation.

.. math:: F_{ss}(d) = \eta\int_d^\infty F(z-d)\,\phi(z)\,dz, \qquad
          F_t = (1-\varsigma)F_{ss} + F_{sa}
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .asperities import asperity_sum
from .laws.asperity import ZMC, AbstractAsperityLaw
from .laws.particle import AbstractParticleLaw, Series
from .laws.particle.series import together_in
from .materials import MaterialPair
from .outputs.base import AbstractOutput, problems_of
from .particles import Particles
from .surfaces import Roughness
from .values import Value

if TYPE_CHECKING:
    from .table import ContactTable

__all__ = ["Contact"]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Contact(Value):
    """Two rough surfaces and what lies between them.

    Parameters
    ----------
    surfaces : MaterialPair
        The two bodies.
    roughness : Roughness
        The equivalent rough surface.
    asperity_law : AbstractAsperityLaw, optional
        What one asperity does; `ZMC` by default.
    particles : Particles or tuple of Particles, optional
        None, or a density of zero, is two-body contact. Several populations (wear debris, dust,
        an additive) lie side by side, each with its material, sizes and, if it has one, its law;
        dotted names number them, ``particles.0.areal_density``.
    particle_law : AbstractParticleLaw, optional
        What one particle does; `Series` on the rough seat by default.
    outputs : AbstractOutput or tuple of them, optional
        What else its states tell: friction, temperature, conductance, wear (`thirdbody.outputs`).

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                   roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> contact.two_body
    True
    """

    surfaces: MaterialPair
    roughness: Roughness
    asperity_law: AbstractAsperityLaw = field(default_factory=ZMC)
    particles: Particles | tuple[Particles, ...] | None = None
    particle_law: AbstractParticleLaw = field(default_factory=Series)
    outputs: tuple[AbstractOutput, ...] = ()

    def __post_init__(self) -> None:
        if self.particle_law is None:
            object.__setattr__(self, "particle_law", Series())
        if isinstance(self.particles, list):
            object.__setattr__(self, "particles", tuple(self.particles))
        if isinstance(self.outputs, AbstractOutput):
            object.__setattr__(self, "outputs", (self.outputs,))
        object.__setattr__(self, "outputs", tuple(self.outputs))
        Value.__post_init__(self)

    def _problems(self) -> list[str]:
        kinds = {
            "surfaces": MaterialPair,
            "roughness": Roughness,
            "asperity_law": AbstractAsperityLaw,
            "particle_law": AbstractParticleLaw,
        }
        out = [
            f"Contact.{name} = {getattr(self, name)!r} must be a {kind.__name__}"
            for name, kind in kinds.items()
            if not isinstance(getattr(self, name), kind)
        ]
        given = self.particles if isinstance(self.particles, tuple) else (self.particles,)
        if not all(isinstance(each, Particles) for each in given) and given != (None,):
            out.append(
                f"Contact.particles = {self.particles!r} must be Particles, several, or None"
            )
        out = out or self._population_problems()
        if not out and self.roughness.ellipticity is not None:
            out += _shape_problems(self.asperity_law)
        return out or problems_of(self.outputs, self)

    def _population_problems(self) -> list[str]:
        """Mistakes that concern several populations."""
        out = []
        covered = sum(each.coverage for each in self.populations)
        if covered >= 1:
            out.append(
                f"Contact.particles are jammed: together they would cover {covered:.3g} of the "
                "nominal area and it must stay below 1"
            )
        for each in self.populations:
            if each.law is not None and not isinstance(each.law, AbstractParticleLaw):
                out.append(
                    f"Particles.law = {each.law!r} must be a particle law, e.g. "
                    "particle.Series(seat='plane')"
                )
        if not out and len({self.law_of(each).centre for each in self.populations}) > 1:
            out.append(
                "Contact.particles follow laws that count d from different planes (Horng2022 and "
                "others); give all of them one kind of law"
            )
        return out

    @property
    def populations(self) -> tuple[Particles, ...]:
        """The populations of particles that have a density."""
        if self.particles is None:
            return ()
        given = self.particles if isinstance(self.particles, tuple) else (self.particles,)
        return tuple(each for each in given if each.areal_density > 0)

    def law_of(self, particles: Particles) -> AbstractParticleLaw:
        """The law that a population follows."""
        law = particles.law
        return law if isinstance(law, AbstractParticleLaw) else self.particle_law

    @property
    def E_ss(self) -> float:
        """Contact modulus E* of the two surfaces [Pa], the scale of F*."""
        return self.surfaces.E_star

    @property
    def two_body(self) -> bool:
        """No particles between the surfaces."""
        return not self.populations

    def table(
        self,
        *,
        low: float | None = None,
        high: float | None = None,
        tolerance: float = 1e-6,
        coordinate: str = "h",
        columns: Sequence[str] = (),
    ) -> ContactTable:
        r"""Pressure, real area and stiffness against separation as a C¹ table for other solvers.

        .. math:: p(h), \quad A_t(h), \quad dp/dh, \qquad
                  |\hat p - p| \le \epsilon\,p

        Parameters
        ----------
        low, high : float, optional
            Range of separations [m] in the chosen coordinate. Without them the table runs from
            A_t = 0.2 (at most down to −3 σ_s, or to where the pressure stops to rise on
            approach) up to the largest separation that carries F* = 1e-9.
        tolerance : float, optional
            Largest relative error ε of p and A_t, from 1e-9 to 0.1 [1]; for shares absolute.
        coordinate : {"h", "d"}, optional
            Count separations from the mean surface plane, or as `solve` counts d.
        columns : sequence of str, optional
            Shares to keep as well: "particle_area_share", "particle_load_share".

        Returns
        -------
        ContactTable
            Functions, knots, stated errors, and exports to CSV, Abaqus, COMSOL, AVL EXCITE,
            Python and C.

        Raises
        ------
        InvalidValue
            A range without contact, with attraction, or in which the pressure rises with the
            separation; a load that jumps; a tolerance that cannot be met.

        Warns
        -----
        RangeWarning
            The range leaves the model's validity; kept in ``warnings``.

        Examples
        --------
        >>> import thirdbody as tb
        >>> steel = tb.materials["S45C"]
        >>> contact = Contact(surfaces=tb.MaterialPair(steel, steel),
        ...                   roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
        >>> table = contact.table(tolerance=1e-4)
        >>> table.p(250e-9) > table.p(300e-9) > 0 > table.dp_dh(300e-9)
        True
        """
        from .table import make_table

        return make_table(
            self, low=low, high=high, tolerance=tolerance, coordinate=coordinate, columns=columns
        )


def _shape_problems(law: AbstractAsperityLaw) -> list[str]:
    """Why a law cannot take its ratio of radii from an ellipticity."""
    if not hasattr(law, "ratio"):
        able = [name for name, kind in law.registry.items() if hasattr(kind, "ratio")]
        return [
            f"Contact.asperity_law is {law.name}, whose tips are round, but the roughness has an "
            f"ellipticity; take {' or '.join(able)}, or remove the ellipticity"
        ]
    if law.ratio != 1:
        return [
            f"Contact.asperity_law.ratio = {law.ratio:g} and the ellipticity of the roughness both "
            "say how slender the tips are; leave one of them out"
        ]
    return []


class Interface:
    """A contact bound to its numbers: total load and every field as functions of d [m]."""

    def __init__(self, contact: Contact):
        self.contact = contact
        laws = [contact.law_of(each) for each in contact.populations]
        self.asperities = asperity_sum(
            contact.asperity_law,
            contact.roughness,
            contact.surfaces,
            laws[0].centre if laws else 0.0,
        )
        self.populations = [
            law.response(contact.surfaces, contact.roughness, each)
            for law, each in zip(laws, contact.populations, strict=True)
        ]
        self.particles = together_in(self.populations) if self.populations else None

    @property
    def monotone(self) -> bool:
        """Whether the total load falls with d everywhere above −3 σ_s, found from a scan."""
        from .equilibrium import load_scan

        return load_scan(self).monotone

    @property
    def mean_plane(self) -> float:
        """h − d [m]: separation from the mean surface plane minus d."""
        return self.contact.roughness.y_s - self.asperities.centre

    def load(self, d: Array) -> Array:
        """F_t [Pa] with first and second derivative: (N, 3)."""
        two_body = self.asperities.load(d)
        if self.particles is None:
            return two_body
        force, shadow = self.particles.load(d)
        f, f1, f2 = two_body.T
        bare = 1 - shadow[:, 0]
        out = force.copy()
        out[:, 0] += bare * f
        out[:, 1] += bare * f1 - shadow[:, 1] * f
        out[:, 2] += bare * f2 - 2 * shadow[:, 1] * f1 - shadow[:, 2] * f
        return out

    def fields(self, d: Array) -> dict[str, Array]:
        """Pressures [Pa] and areas per nominal area at d."""
        F, *areas = self.asperities.fields(d).T
        zero = np.zeros_like(d)
        part = dict.fromkeys(("F_sa", "A_e", "A_ep", "A_p", "A_sa2", "shadow"), zero)
        if self.particles is not None:
            part = self.particles.fields(d)
        return together(F, areas, part)


def together(F: Array, areas: Sequence[Array], part: Mapping[str, Array]) -> dict[str, Array]:
    """Asperities (load, areas by regime) under the shadow of the particles, and both in sum."""
    bare = 1 - part["shadow"]
    split = {
        name: bare * area + part[name]
        for name, area in zip(("A_e", "A_ep", "A_p"), areas, strict=True)
    }
    A_ss = bare * sum(areas)
    A_sa = part["A_e"] + part["A_ep"] + part["A_p"]
    return {
        "F_ss": bare * F,
        "F_sa": part["F_sa"],
        "A_t": A_ss + A_sa,
        "A_ss": A_ss,
        "A_sa": A_sa,
        "A_sa2": part["A_sa2"],
        **split,
        "shadow": part["shadow"],
    }


def interface(contact: Contact) -> Interface:
    """The cached `Interface` of a contact: one for all that carry load alike, whatever else."""
    return _interface(contact.replace(outputs=()) if contact.outputs else contact)


@lru_cache(maxsize=512)
def _interface(contact: Contact) -> Interface:
    return Interface(contact)
