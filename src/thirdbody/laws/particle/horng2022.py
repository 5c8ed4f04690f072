"""The particle law of Horng et al. 2022 as printed, and the readings that reproduce its figures."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.nearest import guess
from ...quantities.value import choice, quantity
from ..base import FLAKES, SERIES, AbstractParticleLaw, OneParticle

if TYPE_CHECKING:
    from ...populations.materials import Material, MaterialPair

__all__ = ["PRESETS", "Horng2022"]

PRESETS: dict[str, dict[str, Any]] = {
    "published": dict(h_e_sigma=3.11, chi=0.00738, hardness_rule="sum"),
    "window": dict(h_e_sigma=3.25, chi=1 / 16, plastic=False),
    "all_terms": dict(h_e_sigma=3.15, chi=0.0185),
    "window_E2": dict(h_e_sigma=2.39, kappa_C=2.0, plastic=False),
    "literal": dict(h_e_rule="approach"),
}
"""What each reading of the printed equations changes; the rest is as printed."""

NO_ONE_PARTICLE = (
    "the particle law horng2022 knows loads and areas of all particles together, not how deep one "
    "of them sits; outputs need " + SERIES + " or " + FLAKES
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Horng2022(AbstractParticleLaw):
    r"""Particle load and area of eqs. (1), (2) and (13) of Horng et al. 2022, errors as switches.

    .. math:: \Sigma = C\int_{d-h_e}^{d} w\,\varphi_a\,dx + \int_d^{x_{max}} w_p\,\varphi_a\,dx,
        \qquad C=\frac{9\pi^2}{4}\left(\frac{H_{s1}^2}{E_1^2}+\frac{H_{s2}^2}{E_2^2}\right)
    .. math:: A_{sa}=\frac{\pi H_{s2}}{H_{s1}+H_{s2}}\,\chi\eta_a\Sigma, \qquad
              F_{sa}=H_{s1}A_{sa}

    ``Horng2022(preset="window")`` sets every switch as that reading does; switches given beside
    it override. The first integral gives a load to every particle caught between surface 1 and
    the level of the highest asperities, d − h_e < x < d, and none to larger ones: particles are
    released once they exceed the gap. That is an artefact of the printed equations (and why the
    load need not fall with d), not physics; use `Series` to predict.

    Parameters
    ----------
    preset : {"published", "window", "all_terms", "window_E2", "literal"}
        A reading of the paper. ``published`` reproduces most of its statements.
    weight : {"x2", "xa2"}
        w = x² or, as printed, x_a².
    plastic : bool
        Keep the second integral.
    plastic_weight : {"x2", "xxd"}
        w_p = w as printed, or x(x − d) from the balance of indentations.
    h_e_rule : {"level", "approach"}
        ``level``: h_e = h_e_sigma σ + h_e_diameter x_a; ``approach``: h_e = C x_a/2.
    h_e_sigma, h_e_diameter : float
        Level of the highest asperities over σ, and its part over x_a [1].
    second_modulus : {"ss", "sa"}
        E_2 is that of the surfaces (as printed) or of particle and surface 2.
    kappa_C : float
        Modulus convention in C: 1 for E*, 2 for E' = 2E* [1].
    chi : float
        Factor χ on the particle density [1].
    shadow : {"d", "xmin", "none"}
        Lower limit of the area correction, which counts the footprint of the second integral:
        d, the smallest particle (as eq. 1 prints), or no correction.
    hardness_rule : {"surface", "softer", "replace2", "sum"}
        How the particle hardness enters: not at all (as printed), as the softer of each
        contact, in place of H_s2, or as a mean pressure H_s1 + H_a. The last is inferred from
        the published numbers; it is in no printed equation and is not physical.
    particle_regime : {"plastic", "split"}
        Book all particle area as plastic (eq. 13) or the first integral as elastic.
    datum : float
        Centre of the asperity heights in the coordinate of d, in units of σ [1]; eq. (8)
        prints 1.
    normalise : bool
        Divide the truncated density by its mass; as printed: no.

    References
    ----------
    Horng et al. 2022, Lubricants 10(7), 164, doi:10.3390/lubricants10070164.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.particle.Horng2022(preset="window").plastic
    False
    """

    name = "horng2022"
    title = "Horng et al. 2022 as printed, with switches"
    year = 2022
    citation = "Horng et al. 2022, Lubricants 10(7), 164"
    doi = "10.3390/lubricants10070164"
    provenance = "seen"
    valid_range = "d > 0; reproduces the paper, does not predict"
    knows_each = False

    preset: str = choice("reading of the paper", *PRESETS, default="published")
    weight: Literal["x2", "xa2"] = choice("weight of the particle integrals", default="x2")
    plastic: bool = True
    plastic_weight: Literal["x2", "xxd"] = choice("weight of the plastic integral", default="x2")
    h_e_rule: Literal["level", "approach"] = choice("meaning of h_e", default="level")
    h_e_sigma: float = quantity("h_e/σ", "1", "level of the highest asperities", default=0.0, ge=0)
    h_e_diameter: float = quantity("h_e/x_a", "1", "part of h_e over x_a", default=0.0, ge=0)
    second_modulus: Literal["ss", "sa"] = choice("modulus of the second contact", default="ss")
    kappa_C: float = quantity("κ_C", "1", "modulus convention in C", default=1.0, gt=0)
    chi: float = quantity("χ", "1", "factor on the particle density", default=1.0, gt=0)
    shadow: Literal["d", "xmin", "none"] = choice("lower limit of the area correction", default="d")
    hardness_rule: Literal["surface", "softer", "replace2", "sum"] = choice(
        "how H_a enters", default="surface"
    )
    particle_regime: Literal["plastic", "split"] = choice(
        "regime of particle area", default="plastic"
    )
    datum: float = quantity("μ_0/σ", "1", "centre of asperity heights", default=1.0)
    normalise: bool = False

    def __init__(self, *, preset: str = "published", **switches: Any):
        fields = {item.name: item for item in dataclasses.fields(type(self))}
        if unknown := [key for key in switches if key not in fields]:
            raise InvalidValue(
                *(
                    Problem(
                        "",
                        f"has no switch {key!r}",
                        hint=guess(key, fields, otherwise="it has "),
                        owner="Horng2022",
                        code=Mistake.UNKNOWN,
                    )
                    for key in unknown
                )
            )
        values = {key: item.default for key, item in fields.items()}
        values |= {"preset": preset} | PRESETS.get(preset, {}) | switches
        for key, value in values.items():
            object.__setattr__(self, key, value)
        self.__post_init__()

    def _problems(self) -> list[str]:
        return [
            Problem(key, "must be true or false", f"{getattr(self, key)!r}", code=Mistake.KIND)
            for key in ("plastic", "normalise")
            if not isinstance(getattr(self, key), bool)
        ]

    @property
    def centre(self) -> float:
        return self.datum

    def one(self, *, surfaces: MaterialPair, particle: Material) -> OneParticle:
        raise InvalidValue(NO_ONE_PARTICLE, code=Mistake.BEYOND)
