"""A contact: two rough surfaces, their laws, and what lies between them."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..errors import Advice, InvalidValue, Mistake, Problem
from ..laws.asperity import ZMC, AbstractAsperityLaw
from ..laws.base import SERIES
from ..laws.particle import AbstractParticleLaw, Series
from ..populations.materials import MaterialPair
from ..populations.particles import Particles
from ..populations.roughness import Roughness
from ..quantities.value import Value, items_of
from .output import AbstractOutput, problems_of

__all__ = ["Contact"]


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

    Warns
    -----
    RangeWarning
        A length of 1 cm and more, or a modulus, hardness or stress below 0.1 MPa: mostly a
        forgotten unit.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
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
        object.__setattr__(self, "outputs", items_of(self.outputs))
        Value.__post_init__(self)

    def _problems(self) -> list[str]:
        kinds: dict[str, tuple[type, str]] = {
            "surfaces": (MaterialPair, "a MaterialPair"),
            "roughness": (Roughness, "a Roughness"),
            "asperity_law": (AbstractAsperityLaw, "an asperity law, e.g. asperity.ZMC()"),
            "particle_law": (AbstractParticleLaw, "a particle law, e.g. particle.Series()"),
        }
        out: list[str] = []
        for name, (kind, words) in kinds.items():
            value = getattr(self, name)
            if not isinstance(value, kind):
                # a class instead of one of its laws
                bare = isinstance(value, type) and issubclass(value, kind)
                hint = f"write {value.__name__}()" if bare else ""
                rule = f"must be {words}"
                out.append(Problem(name, rule, repr(value), hint=hint, code=Mistake.KIND))
        populations = self.particles if isinstance(self.particles, tuple) else (self.particles,)
        if not all(
            isinstance(population, Particles) for population in populations
        ) and populations != (None,):
            out.append(
                Problem(
                    "particles",
                    "must be Particles, several, or None",
                    repr(self.particles),
                    code=Mistake.KIND,
                )
            )
        if out:
            return out
        laws, out = self._laws_of_populations()
        if not out and self.roughness.ellipticity is not None:
            out += _shape_problems(self.asperity_law)
        if not out:
            out += self.asperity_law.problems(self.roughness, laws)
        return out or (problems_of(self.outputs, self) if self.outputs else [])

    def _laws_of_populations(self) -> tuple[list[AbstractParticleLaw], list[str]]:
        """The law of every population, and mistakes that concern several populations."""
        laws: list[AbstractParticleLaw] = []
        out: list[str] = []
        places = self.places
        several = len(places) > 1  # one alone has refused to cover all
        if several and (covered := sum(one.coverage for one in places.values())) >= 1:
            out.append(
                Problem(
                    "particles",
                    f"are jammed: together they would cover {covered:.3g} of the "
                    "nominal area and it must stay below 1",
                    code=Mistake.FULL,
                )
            )
        for place, population in places.items():
            if population.law is not None and not isinstance(population.law, AbstractParticleLaw):
                allowed = "must be a particle law, e.g. " + Advice(
                    "particle.Series(seat='plane')", '{ name = "series", seat = "plane" }'
                )
                out.append(
                    Problem("law", allowed, repr(population.law), owner=place, code=Mistake.KIND)
                )
                continue
            try:
                law = self.law_of(population)
            except InvalidValue as error:
                out += [at_population(one, place, population) for one in error.problems]
                continue
            laws.append(law)
            if population.strength is not None and not law.breakable:
                rule = f": particles of the law {law.name} do not break"
                hint = "use " + SERIES + ", or remove strength"
                out.append(
                    at_population(
                        Problem("strength", rule, hint=hint, code=Mistake.BEYOND), place, population
                    )
                )
        if not out and several and len({law.centre for law in laws}) > 1:
            out.append(
                Problem(
                    "particles",
                    "follow laws that count d from different planes (Horng2022 and "
                    "others); give all of them one kind of law",
                    code=Mistake.BEYOND,
                )
            )
        return laws, out

    @property
    def populations(self) -> tuple[Particles, ...]:
        """The populations of particles that have a density."""
        return tuple(self.places.values())

    @property
    def places(self) -> dict[str, Particles]:
        """The populations that have a density, by their dotted places in the contact."""
        every: dict[str, Particles] = {}
        if isinstance(self.particles, tuple):
            every = {f"particles.{i}": population for i, population in enumerate(self.particles)}
        elif self.particles is not None:
            every = {"particles": self.particles}
        return {
            place: population for place, population in every.items() if population.areal_density > 0
        }

    def law_of(self, particles: Particles) -> AbstractParticleLaw:
        """The law that a population follows, for particles of its shape."""
        law = particles.law
        law = law if isinstance(law, AbstractParticleLaw) else self.particle_law
        return law.of_shape(particles.shape)

    @property
    def E_ss(self) -> float:
        """Contact modulus E* of the two surfaces [Pa], the scale of F*."""
        return self.surfaces.E_star

    @property
    def two_body(self) -> bool:
        """No particles between the surfaces."""
        return not self.populations


def at_population(problem: Problem, place: str, particles: Particles) -> Problem:
    """A problem of one population at its place; advice on its law where it has one of its own."""

    def advice(text: str) -> str:
        if particles.law is None or not isinstance(text, Advice):
            return text
        return Advice(text, text.study.replace("particle_law.", f"{place}.law."))

    return problem.changed(owner=place).put_in_words(advice)


def _shape_problems(law: AbstractAsperityLaw) -> list[str]:
    """Why a law cannot take its ratio of radii from an ellipticity."""
    if not hasattr(law, "ratio"):
        able = [name for name, kind in law.registry.items() if hasattr(kind, "ratio")]
        return [
            Problem(
                "asperity_law",
                f"is {law.name}, whose tips are round, but the roughness has an ellipticity",
                hint=f"take {' or '.join(able)}, or remove the ellipticity",
                code=Mistake.BEYOND,
            )
        ]
    if law.ratio != 1:
        return [
            Problem(
                "asperity_law.ratio",
                "and the ellipticity of the roughness both say how slender the tips are",
                f"{law.ratio:g}",
                hint="leave one of them out",
                code=Mistake.CLASH,
            )
        ]
    return []
