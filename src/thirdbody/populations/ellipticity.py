r"""Populations of elliptic asperities: how slender, how large, and at what angle two faces meet.

The height of a summit near its top is a quadratic form. With principal radii R′ ≥ R″,

.. math:: \lambda = R'/R'', \qquad R_g = \sqrt{R'R''}, \qquad
          m, q = \frac{\sqrt\lambda \pm 1/\sqrt\lambda}{2R_g}

m is the mean of the principal curvatures and q half their difference, so the curvature tensor is m
times the unit tensor plus q times a traceless one that turns with twice the angle of the axes. Two
tips that meet top to top have a gap whose tensor is the sum. Its principal curvatures are M ± Q,

.. math:: M = m_1 + m_2, \qquad Q^2 = (q_1-q_2)^2 + 4q_1q_2\cos^2\theta,

and their product, written without a difference of like numbers,

.. math:: \frac{1}{R_g^2} = M^2 - Q^2 = \left(\frac1{R_1}+\frac1{R_2}\right)^2
          + \frac{\left[(\lambda_1/\lambda_2)^{1/4}-(\lambda_2/\lambda_1)^{1/4}\right]^2}{R_1R_2}
          + 4q_1q_2\sin^2\theta .

So λ = (M + Q)²R_g², and R_g never exceeds R_1R_2/(R_1 + R_2), the radius of two round tips, which
it reaches only for equal ratios at θ = 0.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from ..errors import InvalidValue, Mistake, Problem
from ..numerics.quadrature import panel_rule, subdivide
from ..quantities.carried import takes_units
from ..quantities.say import percent
from ..quantities.value import Value, problem_with, quantity, sequences, several
from .distributions import Distribution

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["Ellipticity", "combined_tips"]

FACES = {
    name: declared.metadata["quantity"]
    for name, declared in {
        "first_ratio": quantity("λ_1", "1", "ratio of the radii on the first face", ge=1),
        "second_ratio": quantity("λ_2", "1", "ratio of the radii on the second face", ge=1),
        "R_first": quantity("R_1", "m", "radius R_g of tips on the first face", gt=0),
        "R_second": quantity("R_2", "m", "radius R_g of tips on the second face", gt=0),
        "angle": quantity(
            "θ",
            "rad",
            "angle between the long axes of the two faces",
            ge=0,
            le=math.pi / 2,
            hint="degrees are math.radians(30) or '30 deg'; beyond 90° the axes repeat",
        ),
    }.items()
}
"""What describes two faces, as quantities."""

ACCURACY = 1e-12
"""How well the classes of a density must give the means of `_probes`, all of order one."""
MOST_CLASSES = 64
BINS = 8
"""Classes of measured summits by ratio, and within each by radius."""
MOST_SADDLES = 0.1
"""Share of summits counted that may lack a second curvature."""
SMALLEST_WEIGHT = 1e-14
"""Classes with a smaller share are left out."""


class Asperities(NamedTuple):
    """One class of a population."""

    ratio: float
    """λ = R′/R″ [1]."""
    radius: float
    """R_g over the R of the roughness [1]."""
    share: float
    """Part of all asperities [1]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Ellipticity(Value):
    r"""A population of elliptic asperities, as classes of one shape each.

    .. math:: F_{ss} = \sum_i w_i\,F_{ss}(\lambda_i, \rho_iR), \qquad \sum_i w_i = 1

    and areas alike. Shape and height are independent.

    Parameters
    ----------
    ratios : tuple of float
        λ = R′/R″ of each class [1], at least 1.
    weights : tuple of float, optional
        Number of asperities of each class, in any unit; equal when left out.
    radii : tuple of float, optional
        ρ = R_g/R [1] of each class, with R_g = √(R′R″) and R that of the roughness; 1 when left
        out.

    Raises
    ------
    InvalidValue
        A ratio below 1, a weight or a radius not above 0, or lists of different lengths.

    Notes
    -----
    In frictionless contact the direction of an ellipse does not matter, so a population has no
    angles. The angle between two rough faces does: `combined`. An elastic population acts like
    round tips with ⟨R_A⟩ in the area and ⟨√R_F⟩ in the load (`laws.asperity.elliptic`).

    References
    ----------
    Johnson 1985, Contact Mechanics, ch. 4, doi:10.1017/CBO9781139171731.

    Examples
    --------
    >>> import thirdbody as tb
    >>> some = tb.surfaces.Ellipticity(ratios=(1, 2, 5), weights=(5, 3, 2))
    >>> [tuple(each) for each in some.classes]
    [(1.0, 1.0, 0.5), (2.0, 1.0, 0.3), (5.0, 1.0, 0.2)]
    """

    ratios: tuple[float, ...] = several("1", "ratios λ of the radii")
    weights: tuple[float, ...] | None = several("1", "asperities in each class", default=None)
    radii: tuple[float, ...] | None = several("1", "R_g over R of each class", default=None)

    def __post_init__(self) -> None:
        sequences(self, "ratios", "weights", "radii")
        Value.__post_init__(self)

    def _problems(self) -> list[str]:
        out: list[str] = []
        if not self.ratios:
            out.append(
                Problem(
                    "ratios", "is empty; give at least one ratio of the radii", code=Mistake.EMPTY
                )
            )
        for i, value in enumerate(self.ratios):
            if not (math.isfinite(value) and value >= 1):
                turned = f"; it is the longer over the shorter: {1 / value:g}" if value > 0 else ""
                turned = turned if value < 1 else ""
                out.append(
                    Problem(
                        f"ratios[{i}]", f"must be >= 1{turned}", f"{value:g}", code=Mistake.RANGE
                    )
                )
        for name in ("weights", "radii"):
            values = getattr(self, name)
            if values is None:
                continue
            if len(values) != len(self.ratios):
                out.append(
                    Problem(
                        "",
                        f"has {len(self.ratios)} ratios and {len(values)} {name}; "
                        "give one for each ratio",
                        owner=type(self).__name__,
                        code=Mistake.SHAPE,
                    )
                )
            for i, value in enumerate(values):
                if not (math.isfinite(value) and value > 0):
                    cause = "; leave the class out" if name == "weights" and value == 0 else ""
                    out.append(
                        Problem(
                            f"{name}[{i}]", f"must be > 0{cause}", f"{value:g}", code=Mistake.RANGE
                        )
                    )
        return out

    @property
    def classes(self) -> tuple[Asperities, ...]:
        """Ratio, radius over R, and share of the asperities of each class."""
        weights = self.weights or (1.0,) * len(self.ratios)
        radii = self.radii or (1.0,) * len(self.ratios)
        total = math.fsum(weights)
        shares = (weight / total for weight in weights)
        return tuple(Asperities(*row) for row in zip(self.ratios, radii, shares, strict=True))

    @classmethod
    def from_distribution(cls, ratio: Distribution) -> Ellipticity:
        r"""Classes for a density of ratios at one R_g, by its Gauss rule.

        The nodes are those of the polynomials in ln²λ that are orthogonal under the density: a
        contact does not change when R′ and R″ change places, so every sum is an even function
        of ln λ.

        Parameters
        ----------
        ratio : Distribution
            Density of λ = R_x/R_y [1], where other distributions of the library have a diameter.
            A ratio below 1 is the same asperity turned by 90°, and counts as 1/λ.

        Returns
        -------
        Ellipticity
            With the fewest classes that give the means of R_A, √R_F, and of functions that fall
            with the interference of first yield, to 1e-12: 4 to 8 for usual densities.

        Raises
        ------
        InvalidValue
            The density reaches down to zero, or is too wide for 64 classes.

        Notes
        -----
        Accuracy: load and area to 1e-10 (at worst 3e-11 was met), areas of one regime to 1e-9 of
        the whole, against rules of 32 nodes a panel: both elliptic laws, ratios up to 40, Gaussian
        and exponential heights, separations from −2 σ_s (−σ_s where exponential heights begin) to
        8 σ_s. Below the edge of a density of heights the sums have kinks in λ, and the areas of
        single regimes are good to 1e-5 only.

        References
        ----------
        Golub, Welsch 1969, Math. Comp. 23, 221, doi:10.1090/S0025-5718-69-99647-1.

        Examples
        --------
        >>> import thirdbody as tb
        >>> slender = tb.surfaces.Ellipticity.from_distribution(
        ...     tb.distributions.Uniform(low=1, high=5)
        ... )
        >>> mean = sum(share * (ratio + 1 / ratio) for ratio, _, share in slender.classes)
        >>> len(slender.ratios), round(mean, 6)
        (5, 3.402359)
        """
        if not isinstance(ratio, Distribution):
            raise InvalidValue(
                f"ratio = {ratio!r} must be a distribution, e.g. Uniform(low=1, high=5)",
                code=Mistake.KIND,
            )
        low, high = ratio.support
        if low <= 0:
            raise InvalidValue(
                f"ratio = {ratio!r} reaches down to 0, where a tip is a ridge; take a density of "
                "ratios that begins above 0",
                code=Mistake.RANGE,
            )
        ratios, shares = _fine(ratio)
        x, order = np.unique(np.log(ratios) ** 2, return_inverse=True)
        mass = np.bincount(order.ravel(), weights=shares).astype(float)
        exact = _means(np.exp(np.sqrt(x)), np.ones_like(x), mass)
        for nodes, weights in _gauss_rules(x, mass):
            kept = weights > SMALLEST_WEIGHT
            kept_ratios = np.exp(np.sqrt(np.maximum(nodes[kept], 0.0)))
            weights = weights[kept]
            if _close(_means(kept_ratios, np.ones_like(kept_ratios), weights), exact):
                return cls(ratios=tuple(kept_ratios), weights=tuple(weights))
        raise InvalidValue(
            f"ratio = {ratio!r} spreads from {low:.3g} to {high:.3g}, too wide for "
            f"{MOST_CLASSES} classes; narrow it, or give ratios and weights",
            code=Mistake.BEYOND,
        )

    @classmethod
    def from_curvatures(cls, curvatures: ArrayLike, *, R: float) -> Ellipticity:
        r"""The classes that stand for summits counted on a surface.

        .. math:: \lambda = \frac{\kappa_1}{\kappa_2}, \qquad
                  R_g = \frac{1}{\sqrt{\kappa_1\kappa_2}}, \qquad
                  \sqrt{R_F(\lambda_i)\rho_i} = \big\langle\sqrt{R_F(\lambda)R_g/R}\big\rangle_i

        Summits go by λ into 8 classes of equal number, and each of these by R_g into 8. A class
        has the mean of ln λ, and the R_g that gives the mean elastic load of its summits.

        Parameters
        ----------
        curvatures : array_like (N, 2)
            Principal curvatures κ of each summit [1/m], as in `Summits.principal`.
        R : float
            R of the roughness that gets these classes [m].

        Returns
        -------
        Ellipticity
            At most 64 classes. The elastic load of the population is that of the summits, to
            rounding; the elastic area to 1e-2 for a few hundred summits of a random surface.

        Raises
        ------
        InvalidValue
            No summits, or more than a tenth of them without two positive curvatures. Fewer are
            left out: points above their neighbours on a ridge that runs askew.

        Notes
        -----
        Shape and height are taken as independent, although high summits are a little rounder.
        Second differences see curvatures at 8 points a wave 5 % too small.

        Examples
        --------
        >>> import thirdbody as tb
        >>> some = tb.surfaces.Ellipticity.from_curvatures([[4e5, 1e5], [4e5, 1e5]], R=5e-6)
        >>> [round(number, 12) for number in some.classes[0]]
        [4.0, 1.0, 1.0]
        """
        from ..reference import elliptic_hertz

        if why := problem_with(FACES["R_first"], R):
            raise InvalidValue(Problem("R", why, repr(R)))
        pairs = np.sort(np.atleast_2d(np.asarray(curvatures, dtype=float)), axis=1)[:, ::-1]
        if pairs.size == 0 or pairs.shape[1] != 2:
            raise InvalidValue(
                f"curvatures of shape {np.shape(curvatures)} must be (N, 2), two for each summit",
                code=Mistake.SHAPE,
            )
        tips = pairs[np.all(np.isfinite(pairs) & (pairs > 0), axis=1)]
        lost = 1 - len(tips) / len(pairs)
        if lost > MOST_SADDLES:
            raise InvalidValue(
                f"{percent(lost, digits=2)} of {len(pairs)} summits lack two positive curvatures; "
                "the surface is not resolved at its summits: take a longer cut-off, or a map",
                code=Mistake.BEYOND,
            )
        ratio, radius = tips[:, 0] / tips[:, 1], 1 / np.sqrt(tips[:, 0] * tips[:, 1]) / R
        root_load = np.array([elliptic_hertz(float(value)).root_R_F for value in ratio])
        root_load *= np.sqrt(radius)
        classes = []
        for alike in np.array_split(np.argsort(ratio, kind="stable"), BINS):
            inner = alike[np.argsort(radius[alike], kind="stable")]
            for group in (group for group in np.array_split(inner, BINS) if len(group)):
                mean = max(float(np.exp(np.log(ratio[group]).mean())), 1.0)
                rho = (root_load[group].mean() / elliptic_hertz(mean).root_R_F) ** 2
                classes.append((mean, float(rho), float(len(group))))
        ratios, radii, weights = zip(*_merge_alike(classes), strict=True)
        return cls(ratios=ratios, radii=radii, weights=weights)

    @classmethod
    def combined(
        cls,
        *,
        first_ratio: float,
        second_ratio: float,
        angle: float | Literal["random"],
        R_first: float = 1.0,
        R_second: float = 1.0,
    ) -> Ellipticity:
        r"""Two anisotropic rough faces: tips of one shape on each, at an angle.

        .. math:: \lambda = (M+Q)^2R_g^2, \qquad
                  \rho = R_g\left(\frac{1}{R_1}+\frac{1}{R_2}\right)

        with M, Q and R_g as at the top of this module.

        Parameters
        ----------
        first_ratio, second_ratio : float
            λ_1, λ_2 of the tips on each face [1], at least 1.
        angle : float or "random"
            θ between the long axes of the two faces [rad], from 0 (lays parallel) to π/2
            (crossed); or any angle, equally frequent.
        R_first, R_second : float, optional
            R_g of the tips on each face [m]. Only their ratio counts; equal when left out.

        Returns
        -------
        Ellipticity
            One class for an angle. For random angles as many of equal weight as give sums to 1e-10;
            the midpoint rule in θ is the Gauss rule in cos 2θ, on which all depends.

        Raises
        ------
        InvalidValue
            A number outside its meaning, or tips too slender for 64 classes.

        Notes
        -----
        `radii` are over R = R_1R_2/(R_1 + R_2), the rule for round tips: that R belongs in the
        `Roughness`. Tips meet top to top, as wherever two rough faces are replaced by one.

        Examples
        --------
        Crossed ridges of equal tips touch like spheres of a smaller radius.

        >>> import math
        >>> import thirdbody as tb
        >>> crossed = tb.surfaces.Ellipticity.combined(
        ...     first_ratio=4, second_ratio=4, angle=math.pi / 2
        ... )
        >>> [round(number, 9) for number in crossed.classes[0]]
        [1.0, 0.8, 1.0]
        """
        values = dict(
            first_ratio=first_ratio, second_ratio=second_ratio, R_first=R_first, R_second=R_second
        )
        if isinstance(angle, str) and angle != "random":
            raise InvalidValue(
                f"angle = {angle!r} must be a number [rad] or 'random'", code=Mistake.KIND
            )
        values |= {} if isinstance(angle, str) else {"angle": angle}
        problems = [
            Problem(name, why, repr(value))
            for name, value in values.items()
            if (why := problem_with(FACES[name], value))
        ]
        if problems:
            raise InvalidValue(*problems)

        round_tips = 1 / (1 / R_first + 1 / R_second)

        def tips_at(theta: ArrayLike) -> tuple[Array, Array]:
            ratio, R = combined_tips(first_ratio, R_first, second_ratio, R_second, theta)
            return ratio, R / round_tips

        if not isinstance(angle, str):
            ratio, radius = tips_at(angle)
            return cls(ratios=(float(ratio),), radii=(float(radius),))

        def rule(count: int) -> tuple[Array, Array]:
            return tips_at((np.arange(count) + 0.5) * (0.5 * np.pi / count))

        exact = _means(*rule(8 * MOST_CLASSES))
        for count in range(1, MOST_CLASSES + 1):
            if _close(_means(*rule(count)), exact):
                ratios, radii = rule(count)
                return cls(ratios=tuple(ratios), radii=tuple(radii))
        slender = (
            f"and second_ratio = {second_ratio:g} are too slender for {MOST_CLASSES} classes of "
            "angles"
        )
        hint = "give classes of your own"
        raise InvalidValue(
            Problem("first_ratio", slender, f"{first_ratio:g}", hint=hint, code=Mistake.BEYOND)
        )


@takes_units
def combined_tips(
    first_ratio: ArrayLike,
    R_first: ArrayLike,
    second_ratio: ArrayLike,
    R_second: ArrayLike,
    angle: ArrayLike,
) -> tuple[Array, Array]:
    """λ and R_g of the gap between two elliptic tips, top to top.

    The formulas stand at the top of this module.

    Parameters
    ----------
    first_ratio, second_ratio : array_like
        λ_1, λ_2 = R′/R″ [1], at least 1.
    R_first, R_second : array_like
        R_g = √(R′R″) of each tip [m].
    angle : array_like
        θ between their long axes [rad].

    Returns
    -------
    ratio, R : array
        λ [1] and R_g [m] of the sum of the curvature tensors. Relative error 1e-15 times a few
        for any ratios and angles, except that λ − 1 is absolute.

    Examples
    --------
    >>> ratio, R = combined_tips(4.0, 2.0, 4.0, 2.0, 0.0)
    >>> float(ratio), float(R)
    (4.0, 1.0)
    """
    l1, R1, l2, R2 = (
        np.asarray(a, dtype=float) for a in (first_ratio, R_first, second_ratio, R_second)
    )
    theta = np.asarray(angle, dtype=float)
    q1, q2 = ((np.sqrt(lam) - 1 / np.sqrt(lam)) / (2 * R) for lam, R in ((l1, R1), (l2, R2)))
    m1, m2 = ((np.sqrt(lam) + 1 / np.sqrt(lam)) / (2 * R) for lam, R in ((l1, R1), (l2, R2)))
    larger = m1 + m2 + np.sqrt((q1 - q2) ** 2 + 4 * q1 * q2 * np.cos(theta) ** 2)
    skew = ((l1 / l2) ** 0.25 - (l2 / l1) ** 0.25) ** 2 / (R1 * R2)
    product = (1 / R1 + 1 / R2) ** 2 + skew + 4 * q1 * q2 * np.sin(theta) ** 2
    return np.maximum(larger**2 / product, 1.0), 1 / np.sqrt(product)


# -------------------------------------------------------------------------- rules
def _merge_alike(classes: list[tuple[float, float, float]]) -> list[tuple[float, float, float]]:
    """Neighbouring classes of one shape as one."""
    out = [classes[0]]
    for ratio, radius, weight in classes[1:]:
        if np.allclose((ratio, radius), out[-1][:2], rtol=1e-9, atol=0):
            out[-1] = (*out[-1][:2], out[-1][2] + weight)
        else:
            out.append((ratio, radius, weight))
    return out


def _fine(ratio: Distribution) -> tuple[Array, Array]:
    """Ratios and shares of a rule that leaves no error in a density: (N,), (N,)."""
    ratios, shares = [], []
    for weight, component in ratio.components:
        low, high = component.support
        if low == high:
            ratios.append(np.array([low]))
            shares.append(np.array([weight]))
            continue
        x, width = panel_rule(subdivide(np.array(component.pieces), width=np.inf, ratio=8.0), 32)
        mass = width * component.pdf(x)
        ratios.append(x)
        shares.append(weight * mass / mass.sum())
    return np.concatenate(ratios), np.concatenate(shares)


def _gauss_rules(x: Array, mass: Array) -> Iterable[tuple[Array, Array]]:
    """Gauss rules of 1, 2, ... nodes for masses at points x, by Lanczos (Golub, Welsch 1969)."""
    basis = [np.sqrt(mass / mass.sum())]
    diagonal: list[float] = []
    beside: list[float] = []
    while len(diagonal) < min(MOST_CLASSES, len(x)):
        vector = x * basis[-1]
        diagonal.append(float(basis[-1] @ vector))
        matrix = np.diag(diagonal) + np.diag(beside, 1) + np.diag(beside, -1)
        nodes, vectors = np.linalg.eigh(matrix)
        yield nodes, vectors[0] ** 2
        for _ in range(2):  # twice is enough to keep them orthogonal
            for other in basis:
                vector = vector - (other @ vector) * other
        beside.append(float(np.linalg.norm(vector)))
        if beside[-1] <= 1e-14 * np.max(x):
            return
        basis.append(vector / beside[-1])


def _probes(ratio: float, radius: float) -> list[float]:
    """What sums over a population are made of: R_A, √R_F, and the yield interference y.

    A law meets the shape only in R_A, √R_F and y. Yielding takes from the elastic sum what the
    asperities pressed beyond y bear less, which falls with y like the density of heights.
    """
    from ..reference import elliptic_hertz

    tip = elliptic_hertz(ratio)
    y = tip.yield_factor * radius
    decays = [math.exp(-c * y) for c in (1.0, 4.0, 16.0)]
    return [tip.R_A * radius, tip.root_R_F * math.sqrt(radius), y, *decays]


def _means(ratios: Array, radii: Array, shares: float | Array = 1.0) -> Array:
    values = np.array([_probes(float(a), float(b)) for a, b in zip(ratios, radii, strict=True)])
    shares = np.broadcast_to(shares, len(ratios))
    return shares @ values / shares.sum()


def _close(means: Array, exact: Array) -> bool:
    return bool(np.all(np.abs(means - exact) <= ACCURACY * np.maximum(exact, 1.0)))
