"""Roughness: the equivalent rough surface and its population of asperities."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

from ..errors import InvalidValue, Mistake, Problem
from ..quantities.value import Value, quantity
from .ellipticity import Ellipticity
from .finish import Finish, drawing, given_or_drawn
from .heights import GaussianHeights, Heights

__all__ = ["ETA_R_SIGMA", "Roughness"]

ETA_R_SIGMA = 0.0455
"""ηRσ of an isotropic Gaussian surface with bandwidth α = 5 (McCool 1986, rounded as in use)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Roughness(Value):
    r"""The equivalent rough surface of a pair, after Nayak and McCool.

    .. math:: \sigma_s = \sigma\sqrt{1 - 0.8968/\alpha}, \qquad
              y_s = 4\sigma/\sqrt{\pi\alpha}, \qquad \eta = (\eta R\sigma)/(R\sigma)

    Parameters
    ----------
    sigma : float
        RMS height σ of the equivalent surface [m].
    R : float
        Mean asperity tip radius R [m].
    alpha : float, optional
        Nayak's bandwidth α = m0·m4/m2² [1], above 1.5.
    eta_R_sigma : float, optional
        The product ηRσ [1]; 0.0455 when neither it nor ``eta`` is given.
    eta : float, optional
        Asperity density η [1/m²], instead of ``eta_R_sigma``.
    heights : Heights, optional
        Distribution of asperity heights over σ_s; Gaussian by default.
    ellipticity : Ellipticity, optional
        Elliptic asperities of several shapes, for laws with a ratio of radii; R is then R_g =
        √(R′R″) of a class with radius 1.
    finish : tuple of Finish, optional
        What the drawing states of the faces: `from_drawing` sets it. It moves no number; the
        ranges that `assess` carries come from it.

    Raises
    ------
    InvalidValue
        A number outside its meaning, or both ``eta`` and ``eta_R_sigma``.

    References
    ----------
    Nayak 1971, J. Lubr. Technol. 93, 398, doi:10.1115/1.3451608; McCool 1986, Wear 107, 37,
    doi:10.1016/0043-1648(86)90045-1.

    Examples
    --------
    >>> import thirdbody as tb
    >>> rough = tb.Roughness(sigma=100e-9, R=2.8e-6)
    >>> round(rough.sigma_s * 1e9, 3), round(rough.y_s / rough.sigma, 4)
    (90.589, 1.0093)
    """

    sigma: float = quantity(
        "σ",
        "m",
        "RMS roughness of equivalent surface heights",
        gt=0,
        hint="nm are 100e-9 or '100 nm'",
    )
    R: float = quantity("R", "m", "mean asperity radius", gt=0, hint="µm are 2.8e-6 or '2.8 um'")
    alpha: float = quantity("α", "1", "Nayak bandwidth", default=5.0, gt=1.5)
    eta_R_sigma: float | None = quantity("ηRσ", "1", "product ηRσ", default=None, gt=0)
    eta: float | None = quantity("η", "1/m^2", "asperity density", default=None, gt=0)
    heights: Heights = field(default_factory=GaussianHeights)
    ellipticity: Ellipticity | None = None
    finish: tuple[Finish, ...] = field(default=(), metadata={"in_dict": "where filled"})

    @classmethod
    def from_drawing(
        cls,
        first: Finish,
        second: Finish | None = None,
        *,
        R: float | None = None,
        alpha: float | None = None,
        eta_R_sigma: float | None = None,
        eta: float | None = None,
        **others: Any,
    ) -> Roughness:
        r"""The pair whose faces a drawing states by Ra, Rq or Rz and the finishing process.

        .. math:: \sigma^2 = R_{q1}^2 + R_{q2}^2, \qquad R_q = \sqrt{\pi/2}\,R_a

        Parameters
        ----------
        first, second : Finish
            The faces; without a second one the other is smooth, or the first is the pair.
        R, alpha, eta_R_sigma, eta : float, optional
            What is known better than by the process [m], [1], [1], [1/m²].
        **others
            Heights and ellipticity.

        Returns
        -------
        Roughness
            With the usual values of the process; `ranges` has their ranges.

        Raises
        ------
        InvalidValue
            A face without a process, and no R.

        Notes
        -----
        Heights are Gaussian and the faces isotropic. What a process says of the slope and of α is
        wide and from memory, so R is known to a factor of some six either way: measure it where it
        matters.

        Examples
        --------
        >>> import thirdbody as tb
        >>> ground = tb.surfaces.Finish(Ra=0.4e-6, process="ground")
        >>> lapped = tb.surfaces.Finish(Ra=0.1e-6, process="lapped")
        >>> rough = tb.Roughness.from_drawing(ground, lapped)
        >>> round(rough.sigma * 1e9), round(rough.R * 1e6)
        (517, 12)
        >>> [round(end * 1e6) for end in rough.ranges["R"]]
        [2, 76]
        """
        faces = (first,) if second is None else (first, second)
        if problems := _problems_of_faces(faces):
            raise InvalidValue(*problems)
        values = {"R": R, "alpha": alpha, "eta_R_sigma": eta_R_sigma, "eta": eta}
        return cls(**given_or_drawn(faces, values), **others, finish=faces)

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """Low and high ends of what the drawing leaves open, in SI; of numbers set since, none."""
        if not self.finish:
            return {}
        numbers = drawing(self.finish)._asdict()
        return {
            name: (ends[0], ends[2])
            for name, ends in numbers.items()
            if ends is not None and ends[0] < ends[2] and getattr(self, name) == ends[1]
        }

    def _problems(self) -> list[str]:
        if self.eta is not None and self.eta_R_sigma is not None:
            return [
                Problem(
                    "eta",
                    "and eta_R_sigma say the same thing; give one of them",
                    code=Mistake.CLASH,
                )
            ]
        if not isinstance(self.heights, Heights):
            return [
                Problem(
                    "heights",
                    "must be a height distribution",
                    repr(self.heights),
                    code=Mistake.KIND,
                )
            ]
        if not isinstance(self.ellipticity, Ellipticity | None):
            return [
                Problem(
                    "ellipticity",
                    "must be an Ellipticity or None",
                    repr(self.ellipticity),
                    code=Mistake.KIND,
                )
            ]
        return _problems_of_faces(self.finish)

    @property
    def density(self) -> float:
        """Asperities per nominal area η [1/m²]."""
        if self.eta is not None:
            return self.eta
        product = ETA_R_SIGMA if self.eta_R_sigma is None else self.eta_R_sigma
        return product / (self.R * self.sigma)

    @property
    def slope(self) -> float:
        r"""RMS slope of the surface :math:`g = \sqrt{2 m_2}` [1], not of its profiles.

        .. math:: m_2 = \sqrt{\sigma^2 m_4/\alpha}, \qquad m_4 = \frac{9\pi}{64R^2}

        for Gaussian isotropic heights: McCool 1986, doi:10.1016/0043-1648(86)90045-1, and Nayak
        1971, doi:10.1115/1.3451608.

        >>> import thirdbody as tb
        >>> round(tb.Roughness(sigma=300e-9, R=3e-6).slope, 3)
        0.244
        """
        return (2 * self.sigma / self.R * (9 * math.pi / 64 / self.alpha) ** 0.5) ** 0.5

    @property
    def sigma_s(self) -> float:
        """Standard deviation of the asperity heights σ_s [m]."""
        return self.sigma * (1 - 0.8968 / self.alpha) ** 0.5

    @property
    def y_s(self) -> float:
        """Height of the mean asperity plane above the mean surface plane y_s [m]."""
        return 4 * self.sigma / (math.pi * self.alpha) ** 0.5


def _problems_of_faces(faces: object) -> list[str]:
    """Mistakes in what should be one face or two."""
    if not (isinstance(faces, tuple) and len(faces) <= 2):
        rule = "must be a tuple of one or two Finish"
        return [Problem("finish", rule, repr(faces), owner="Roughness", code=Mistake.KIND)]
    rule = 'must be a Finish, e.g. Finish(Ra=0.2e-6, process="ground")'
    return [
        Problem(f"finish[{i}]", rule, repr(face), owner="Roughness", code=Mistake.KIND)
        for i, face in enumerate(faces)
        if not isinstance(face, Finish)
    ]
