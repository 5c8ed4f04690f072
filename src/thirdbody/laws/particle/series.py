"""The consistent model: a particle is two contacts in series, and it rests somewhere."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ..asperity.hermite import Hermite
from ..base import AbstractAsperityLaw, AbstractParticleLaw, OneParticle, SeatedLaw
from .one_particle import contact_sides, squeezed_particle

if TYPE_CHECKING:
    from ...populations.materials import Material, MaterialPair

__all__ = ["Series"]


@dataclass(frozen=True, kw_only=True)
class _OfTips(AbstractParticleLaw):
    """Particles whose tips follow a law of one contact: its field stands before those of a seat."""

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
    breakable = True

    law: AbstractAsperityLaw = field(default_factory=Hermite)

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
        return out + SeatedLaw._problems(self)

    def one(self, *, surfaces: MaterialPair, particle: Material) -> OneParticle:
        return squeezed_particle(self.law, *contact_sides(surfaces, particle), self.tip_radius)
