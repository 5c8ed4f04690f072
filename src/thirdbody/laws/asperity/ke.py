"""Kogut and Etsion 2002: finite-element fits of a deformable sphere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..base import Branch, Jump
from .yielding import PeakPressureLaw

__all__ = ["KE"]


@dataclass(frozen=True, slots=True, kw_only=True)
class KE(PeakPressureLaw):
    r"""Power laws between yield and full plasticity.

    With :math:`y=\omega/\omega_c`, F_c = (2/3) K H π R ω_c and A_c = π R ω_c:

    =======  =====================  =====================
    y        F / F_c                A / A_c
    =======  =====================  =====================
    < 1      y^1.5                  y
    1–6      1.03 y^1.425           0.93 y^1.136
    6–110    1.40 y^1.263           0.94 y^1.146
    > 110    3 y / K                2 y
    =======  =====================  =====================

    Parameters
    ----------
    K : float, optional
        Peak pressure at yield over hardness [1]; 0.454 + 0.41 ν when not given. The fits assume
        H = 2.8 S_y.
    nu : float, optional
        Poisson ratio ν of the softer body [1]; a contact fills it in.

    Notes
    -----
    The published fits do not join: at y = 1, 6 and 110 the load jumps by +3.0, +1.7 and, for
    ν = 0.29, +8.6 % (it depends on ν through K), the area by −7.0, +2.9 and +7.1 %. The area
    falls at 1 and the pressure at 6. They are kept as published. Beyond y = 110 the fits end;
    full plasticity there is the convention of the authors' rough-surface paper of 2003.

    References
    ----------
    Kogut, Etsion 2002, J. Appl. Mech. 69, 657, doi:10.1115/1.1490373. Loads checked against
    public code, exponents of the area recalled.

    Examples
    --------
    >>> import thirdbody as tb
    >>> law = tb.asperity.KE(nu=0.29)
    >>> y = 3.0
    >>> F_c = law.reduced("force", 1 - 1e-15)
    >>> round(float(law.reduced("force", y) / F_c), 6)
    4.92873
    """

    name = "ke"
    title = "Kogut–Etsion"
    year = 2002
    citation = "Kogut, Etsion 2002, J. Appl. Mech. 69, 657"
    doi = "10.1115/1.1490373"
    provenance = "seen (loads), recalled (areas)"
    valid_range = "ω ≤ 110 ω_c; H = 2.8 S_y"
    beyond = "pressed beyond ω = 110 ω_c, where the fits end"

    @property
    def jumps(self) -> dict[float, Jump]:
        # ratios of the powers on both sides; the stiffness has that of the exponents besides
        F = (1.03, 1.40 / 1.03 * 6 ** (1.263 - 1.425), 3 / self.yield_factor / 1.40 * 110**-0.263)
        A = (0.93, 0.94 / 0.93 * 6 ** (1.146 - 1.136), 2 / 0.94 * 110**-0.146)
        n = (1.425 / 1.5, 1.263 / 1.425, 1 / 1.263)
        steps = zip((1.0, 6.0, 110.0), F, A, n, strict=True)
        return {y: Jump(f - 1, a - 1, f * m - 1) for y, f, a, m in steps}

    @property
    def valid_to(self) -> float:
        return 110.0

    @property
    def breakpoints(self) -> tuple[float, ...]:
        return (1.0, 6.0, 110.0)

    @property
    def branches(self) -> tuple[Branch, ...]:
        unit = 2 / 3 * self.yield_factor

        def power(regime: str, load: tuple[float, float], area: tuple[float, float]) -> Branch:
            (f, m), (a, n) = load, area
            return Branch(
                regime,
                lambda y: unit * f * y**m,
                lambda y: a * y**n,
                lambda y: unit * f * m * y ** (m - 1),
            )

        return (
            power("elastic", (1.0, 1.5), (1.0, 1.0)),
            power("elastoplastic", (1.03, 1.425), (0.93, 1.136)),
            power("elastoplastic", (1.40, 1.263), (0.94, 1.146)),
            Branch("plastic", lambda y: 2 * y, lambda y: 2 * y, lambda y: np.full_like(y, 2.0)),
        )
