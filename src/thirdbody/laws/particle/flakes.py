"""Flakes: oblate particles that lie flat between the surfaces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, Self

from ...quantities.value import choice, quantity
from ..base import AbstractParticleLaw
from .series import Series

if TYPE_CHECKING:
    from ...populations.shape import Shape

__all__ = ["Flakes"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Flakes(Series):
    r"""Oblate spheroids lying flat: thin in the gap, wide and flat where they touch.

    A flake of diameter D and thickness τ touches with the curvature of its pole,

    .. math:: R_p = \frac{D^2}{2\tau}, \qquad A \le \frac{\pi D^2}{4},

    and is squeezed by τ − g, shared by two contacts in series as in `Series`. With equal
    materials and full plasticity below the cap :math:`F = \tfrac12\pi H (D^2/\tau)(\tau-g)`.

    The size distribution of the particles is that of the **thickness** τ; all flakes have the
    same aspect ratio, D = (D/τ) τ.

    Parameters
    ----------
    aspect : float, optional
        D/τ [1], at least 1; the default 1 is a sphere and gives exactly
        ``Series(soft="sphere")``.
    law, seat, h_0, zeta_mean, zeta_std, shadow
        As in `Series`. Flakes softer than a surface are not squashed: ``soft`` is "sphere".

    Notes
    -----
    The plastic load of a flake grows like D²/τ, the elastic one like D/√τ. Say what is held when
    shapes are compared: at a fixed mass per area the number of flakes goes like 1/(D²τ).

    Each contact is a half-space contact, so a ≪ τ is needed: thin flakes leave this range early.
    Bending, tilt, and stacking of flakes are left out. The plastic area of a shallow cap,
    2πR_pω, is used up to the great circle; the exact section of a spheroid is smaller by
    1 − ω/τ.

    References
    ----------
    Derived. The single contacts cite their own law.

    Examples
    --------
    >>> import thirdbody as tb
    >>> body = tb.Material(E=2e11, nu=0.0, H=1e9)
    >>> pair = tb.MaterialPair(body, body)
    >>> x, gap = 1e-7, 0.9e-7
    >>> ball, flake = (
    ...     tb.particle.Flakes(aspect=aspect).single(x, gap, surfaces=pair, particle=body)["force"]
    ...     for aspect in (1, 2)
    ... )
    >>> round(float(flake / ball), 9)
    4.0
    """

    name = "flakes"
    title = "Flakes lying flat (two contacts in series)"
    year = 2026
    citation = "thirdbody flakes: oblate spheroids lying flat, two contacts in series"
    doi = ""
    provenance = "derived"
    valid_range = "a ≪ τ, D/2 ≪ R, A_t < 0.2; no bending or tilt"
    breakable = False

    soft: Literal["sphere"] = choice("flakes softer than a surface", default="sphere")
    aspect: float = quantity("D/τ", "1", "diameter over thickness", default=1.0, ge=1)

    def of_shape(self, shape: Shape) -> Self:
        AbstractParticleLaw.of_shape(self, shape)  # theirs is in the law
        return self

    @property
    def tip_radius(self) -> float:
        """R_p/τ = (D/τ)²/2."""
        return 0.5 * self.aspect**2

    def describe_jam(self, coverage: float) -> str:
        return (
            f"flakes of aspect {self.aspect:g} would cover {coverage:.3g} of the nominal area "
            "and it must stay below 1; the size distribution is that of their thickness"
        )
