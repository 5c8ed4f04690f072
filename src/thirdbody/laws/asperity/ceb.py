"""Chang, Etsion and Bogy 1987: volume is conserved once an asperity yields."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..base import Branch, Jump
from .yielding import PeakPressureLaw

__all__ = ["CEB"]


@dataclass(frozen=True, slots=True, kw_only=True)
class CEB(PeakPressureLaw):
    r"""Hertz below ω_c; above it a frustum that keeps its volume, under the pressure K H.

    .. math:: A = \pi R\,\omega\,(2 - \omega_c/\omega), \qquad F = K H A, \qquad \omega > \omega_c

    Parameters
    ----------
    K : float, optional
        Peak pressure at yield over hardness [1]: 0.6 in 1987; when not given, 0.454 + 0.41 ν
        as in later papers. The two differ by 8 % in ω_c at ν = 0.3.
    nu : float, optional
        Poisson ratio ν of the softer body [1]; a contact fills it in.

    Notes
    -----
    Area is continuous at ω_c; load and pressure jump by 50 % and the stiffness doubles. The
    plastic pressure is K H, not H, so the law never reaches full hardness; reviews that plot it
    with H differ.

    References
    ----------
    Chang, Etsion, Bogy 1987, J. Tribol. 109, 257, doi:10.1115/1.3261348 (DOI from
    memory). Form checked against public code; the constants of K are from later papers.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.asperity.CEB(K=0.6).jumps[1.0]
    Jump(force=0.5, area=0.0, stiffness=1.0)
    """

    name = "ceb"
    title = "Chang–Etsion–Bogy"
    year = 1987
    citation = "Chang, Etsion, Bogy 1987, J. Tribol. 109, 257"
    doi = "10.1115/1.3261348"
    provenance = "seen (form), recalled (K)"
    valid_range = "spherical tips, ω ≪ R"

    @property
    def jumps(self) -> dict[float, Jump]:
        return {1.0: Jump(force=0.5, stiffness=1.0)}

    @property
    def breakpoints(self) -> tuple[float, ...]:
        return (1.0,)

    @property
    def branches(self) -> tuple[Branch, ...]:
        K = self.yield_factor
        return (
            Branch("elastic", lambda y: 2 / 3 * K * y**1.5, lambda y: y, lambda y: K * y**0.5),
            Branch(
                "plastic",
                lambda y: K * (2 * y - 1),
                lambda y: 2 * y - 1,
                lambda y: np.full_like(y, 2 * K),
            ),
        )
