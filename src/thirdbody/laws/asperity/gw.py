"""Greenwood and Williamson 1966: elastic asperities."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..base import AbstractAsperityLaw, Branch

__all__ = ["GW"]


@dataclass(frozen=True, slots=True, kw_only=True)
class GW(AbstractAsperityLaw):
    r"""Asperities that stay elastic however deep they are pressed.

    .. math:: F = \tfrac43 E^* \sqrt{R}\,\omega^{3/2}, \qquad A = \pi R\,\omega

    The limit of every other law as the hardness grows.

    Notes
    -----
    There is no yield; the scale ω_1 is the interference at which the mean pressure would equal
    the hardness, and the load does not depend on it.

    References
    ----------
    Greenwood, Williamson 1966, Proc. R. Soc. A 295, 300, doi:10.1098/rspa.1966.0242.

    Examples
    --------
    >>> import thirdbody as tb
    >>> round(float(tb.asperity.GW().force(1e-8, R=1e-6, E_star=1e11, H=5e9)) * 1e6, 6)
    133.333333
    """

    name = "gw"
    title = "Greenwood–Williamson"
    year = 1966
    citation = "Greenwood, Williamson 1966, Proc. R. Soc. A 295, 300"
    doi = "10.1098/rspa.1966.0242"
    provenance = "seen"
    valid_range = "elastic contact, ω ≪ R"
    beyond = "pressed beyond first yield (mean pressure 0.4 H), and the law is elastic"

    def yield_interference(self, *, R, E_star, H):
        """(3πH/4E*)² R [m]: a scale, not a yield."""
        return (3 * math.pi * H / (4 * E_star)) ** 2 * R

    @property
    def breakpoints(self) -> tuple[float, ...]:
        return ()

    @property
    def valid_to(self) -> float:
        """p = H√y reaches 0.4 H, ZMC's first yield."""
        return 0.4**2

    @property
    def branches(self) -> tuple[Branch, ...]:
        return (Branch("elastic", lambda y: y**1.5, lambda y: y, lambda y: 1.5 * y**0.5),)
