"""Elastic asperities with a coating: exact solution of the layered half-space."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self

from ...errors import InvalidValue, Mistake
from ...quantities.value import quantity
from ..base import AbstractAsperityLaw, Branch
from .layer import ElasticLayer

__all__ = ["Coated"]

THICK_HINT = "nm are 100e-9 or '100 nm'"


@dataclass(frozen=True, slots=True, kw_only=True)
class Coated(AbstractAsperityLaw):
    r"""A bonded elastic coating 1 of thickness t on a substrate 2, pressed by a counter-body 3.

    .. math:: F = \frac{E_1^* t^3}{R}\,\hat F\!\left(\frac{\omega R}{t^2}\right), \qquad
              A = \pi t^2\,\hat A\!\left(\frac{\omega R}{t^2}\right), \qquad
              E_1^* = \frac{E_1}{1-\nu_1^2}

    with functions that depend on the materials alone, from the integral equation of
    `thirdbody.laws.asperity.layer`. Hertz with E_1* for a ≪ t and with E_2* for a ≫ t; with E_3,
    each in series with E_3*.

    Parameters
    ----------
    E_1, nu_1 : float
        Young's modulus E_1 [Pa] and Poisson ratio ν_1 [1] of the coating.
    t : float
        Thickness of the coating [m].
    E_2, nu_2 : float
        Modulus and Poisson ratio of the substrate. Give all five: the defaults are a coating of
        the substrate's own material, which is none.
    E_3, nu_3 : float, optional
        Modulus and Poisson ratio of an uncoated elastic counter-body; rigid when E_3 is not given.
    scale : float, optional
        E_1*t/(πRH) [1]; a contact fills it in.

    Notes
    -----
    Elastic at any load: there is no yield. E* of the contact does not enter, because the moduli
    stand here, and H is only the unit of force; E* stays the unit of F*. The unit of ω is
    t²/R, a scale. The law has a length of its own, so it does not serve for particles of all
    sizes.

    The contact is described by a/t (or ωR/t²), not by t/R or ω/t. A stiff coating lowers ω at
    the same load but raises it at the same contact radius; an effective modulus that depends on
    t alone does not exist. Under a stiff coating with a near t the load grows slower than
    ω^{3/2}, under a soft one faster.

    Formulas fitted to finite elements (Chen, Etsion and others) are not used: their coefficients
    could not be checked against a source.

    References
    ----------
    O'Sullivan, King 1988, J. Tribol. 110, 235, doi:10.1115/1.3261591 (layer compliance; title and
    year seen, volume and DOI from memory).

    Examples
    --------
    >>> import thirdbody as tb
    >>> same = tb.asperity.Coated(E_1=2e11, nu_1=0.3, t=1e-8, E_2=2e11, nu_2=0.3)
    >>> E_star = 2e11 / (1 - 0.3**2)
    >>> F = same.force(1e-8, R=1e-6, E_star=E_star, H=5e9)
    >>> round(float(F / (4 / 3 * E_star * 1e-6**0.5 * 1e-8**1.5)), 9)
    1.0
    """

    name = "coated"
    title = "Elastic coating on an elastic substrate"
    year = 1988
    citation = (
        "exact elastic layer: O'Sullivan, King 1988, J. Tribol. 110, 235 (compliance); "
        "contact equation derived"
    )
    doi = "10.1115/1.3261591"
    provenance = "recalled (compliance; checked), derived (contact)"
    valid_range = "elastic, bonded, frictionless; ω ≪ R, t ≪ R"
    beyond = "under a mean pressure above 0.4 H, and the law is elastic"
    scale_free = False

    E_1: float = quantity("E_1", "Pa", "modulus of the coating", default=2e11, gt=0)
    nu_1: float = quantity("ν_1", "1", "Poisson ratio of the coating", default=0.3, gt=-1, le=0.5)
    t: float = quantity("t", "m", "thickness of the coating", default=1e-7, gt=0, hint=THICK_HINT)
    E_2: float = quantity("E_2", "Pa", "modulus of the substrate", default=2e11, gt=0)
    nu_2: float = quantity("ν_2", "1", "Poisson ratio of the substrate", default=0.3, gt=-1, le=0.5)
    E_3: float | None = quantity("E_3", "Pa", "modulus of the counter-body", default=None, gt=0)
    nu_3: float = quantity(
        "ν_3", "1", "Poisson ratio of the counter-body", default=0.3, gt=-1, le=0.5
    )
    scale: float | None = quantity("E_1*t/πRH", "1", "unit of load", default=None, gt=0)

    @property
    def E_1_star(self) -> float:
        """E_1/(1 − ν_1²) [Pa]."""
        return self.E_1 / (1 - self.nu_1**2)

    @property
    def layer(self) -> ElasticLayer:
        """The materials without their scale."""
        indenter = 0.0
        if self.E_3 is not None:
            indenter = self.E_1_star * (1 - self.nu_3**2) / self.E_3
        ratio = self.E_1 / self.E_2
        return ElasticLayer(modulus_ratio=ratio, nu_1=self.nu_1, nu_2=self.nu_2, indenter=indenter)

    def bound(self, *, R, E_star, H, nu: float | None = None) -> Self:
        """The law with E_1*t/(πRH) of the contact."""
        return self.replace(scale=self.E_1_star * self.t / (math.pi * R * H))

    def yield_interference(self, *, R, E_star, H):
        """t²/R [m]: a scale, not a yield."""
        return self.t**2 / R

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """y = 1, where the coating is felt; the formula is one."""
        return (1.0,)

    @property
    def valid_to(self) -> float:
        """Where the mean pressure is 0.4 H, as at first yield of a uniform body."""
        from scipy.optimize import brentq

        def excess(log_y: float) -> float:
            force, area, _ = (float(v) for v in self.layer.reduced(math.exp(log_y)))
            return math.log(self._unit * force / area / 0.4)

        # the pressure grows like √y before and after the coating is felt
        hertz = 2 * math.log(0.3 / self._unit)
        far = 2 * abs(math.log(self.E_2 / self.E_1)) + 2 * math.log1p(self.layer.indenter) + 5
        return math.exp(brentq(excess, hertz - far, hertz + far, xtol=1e-12))

    @property
    def _unit(self) -> float:
        if self.scale is None:
            raise InvalidValue(
                "Coated.scale is needed; a contact fills it in", code=Mistake.MISSING
            )
        return self.scale

    @property
    def branches(self) -> tuple[Branch, ...]:
        layer, scale = self.layer, self._unit
        one = Branch(
            "elastic",
            lambda y: scale * layer.reduced(y)[0],
            lambda y: layer.reduced(y)[1],
            lambda y: scale * layer.reduced(y)[2],
        )
        return (one, one)
