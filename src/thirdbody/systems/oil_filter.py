r"""A filter in the line to a contact: what it lets through, from the β ratios of its data sheet.

.. math:: \beta_x = \frac{N_{up}(>x)}{N_{down}(>x)} \quad\Rightarrow\quad
          N_{down}(>x) = N_{up}(>x)/\beta_x
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Self

import numpy as np

from ..errors import InvalidValue, Mistake, Problem
from ..numerics.quadrature import gauss_legendre
from ..populations.distributions import Distribution, PowerLaw
from ..quantities.units import say, to_si
from ..quantities.value import Value, choice, quantity, sequences, several

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["Filter"]


def __dir__() -> list[str]:
    return sorted(__all__)


FINEST = 0.5
"""Size from which a filter holds something, over the smallest one of its data sheet, where that
names one size alone."""
NODES = 16
"""Gauss nodes for each stretch of a class of size."""
CLASSES = 24
"""Sections of the sizes behind a filter."""
STEEPEST = 100.0
"""Largest exponent of the number over size within a section."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Filter(Value):
    r"""A filter by its β ratios at sizes, as ISO 16889 measures them.

    .. math:: \ln(\beta_x - 1)\ \text{straight over}\ \ln x\ \text{between the sizes}

    Parameters
    ----------
    sizes : tuple of float
        Increasing sizes x [m], of the scale µm(c).
    betas : tuple of float
        Particles larger than each before the filter over those behind it β_x [1], at least 1.
    flow : float, optional
        Oil through it Q [m³/s]; needed in a circuit.
    capacity : float, optional
        Mass that it takes until it is full [kg], of its data sheet; without it is never full.
    when_full : {"change", "bypass"}, optional
        What happens then: a new one, or a valve that leads the oil past it.
    still_filtered : float, optional
        Part of the flow that still goes through a full one [1].
    service : float, optional
        What ln β in service is over ln β of the data sheet [1]. Cyclic flow and restarts release
        dirt: vary it.
    dust_slope : float, optional
        Fall q of the count of the test dust, N(>x) ∝ x^(−q) [1]. Of medium dust it is 1.6 at 3 µm
        and 3.6 at 20 µm; 3 is volume spread evenly over ln x.
    line : str, optional
        Filters of one line stand one behind the other, in their order; else each has its own.
    name : str, optional
        As in tables and figures.

    Notes
    -----
    Beyond the largest size β stays; from β = 1 on ln β is straight. On its way to a contact the oil
    passes the filter once (`behind`): below the smallest size ln β goes on along the line through
    the first two, to β = 1, and with one size alone the filter holds nothing below half of it
    (assumptions). In a circuit (`penetration`) nothing is held below the smallest size. Data sheets
    hold for the test dust, flow and fluid of the test; in a machine β is lower where flow pulsates.

    References
    ----------
    ISO 16889: multi-pass test (β ratio).

    Examples
    --------
    >>> import thirdbody as tb
    >>> fine = tb.oil.Filter.from_text("5=75, 10=1000")
    >>> fine.beta([5e-6, 20e-6]).round(6).tolist()
    [75.0, 1000.0]
    """

    sizes: tuple[float, ...] = several("m", "sizes at which β is known")
    betas: tuple[float, ...] = several("1", "particles before over particles behind the filter")
    flow: float | None = quantity("Q", "m^3/s", "oil through the filter", default=None, gt=0)
    capacity: float | None = quantity(
        "C", "kg", "mass that the filter takes", default=None, gt=0, hint="50 g is 0.05"
    )
    when_full: str = choice("what happens to a full filter", "change", "bypass", default="change")
    still_filtered: float = quantity(
        "f", "1", "part of the flow through a full filter", default=0.0, ge=0, le=1
    )
    service: float = quantity(
        "s", "1", "ln β in service over ln β of the data sheet", default=1.0, gt=0, le=2
    )
    dust_slope: float = quantity("q", "1", "fall of the count of the test dust", default=3.0, gt=0)
    line: str = ""
    name: str = ""

    def __post_init__(self) -> None:
        Value.__post_init__(self)
        sequences(self, "sizes", "betas")

    def _problems(self) -> list[str]:
        x, beta = self.sizes, self.betas
        if not x or len(x) != len(beta):
            return [
                Problem(
                    "",
                    f"has {len(x)} sizes and {len(beta)} betas; give one for each size",
                    owner="Filter",
                    code=Mistake.SHAPE,
                )
            ]
        out: list[str] = []
        if any(not (math.isfinite(v) and v > 0) for v in x) or any(
            b <= a for a, b in zip(x, x[1:], strict=False)
        ):
            out.append(Problem("sizes", "must increase and start above 0 [m]", code=Mistake.ORDER))
        if any(not (math.isfinite(v) and v >= 1) for v in beta):
            out.append(
                Problem(
                    "betas", "must be at least 1: a filter adds no particles", code=Mistake.RANGE
                )
            )
        elif any(b < a for a, b in zip(beta, beta[1:], strict=False)):
            out.append(
                Problem(
                    "betas",
                    "must not fall: a filter that holds small ones holds large ones",
                    code=Mistake.ORDER,
                )
            )
        return out

    @classmethod
    def from_text(cls, text: str) -> Self:
        """A filter from ``"5=75, 10=1000"``: sizes in µm(c) unless they have a unit, and their β.

        Parameters
        ----------
        text : str
            Pairs of a size and its β ratio.
        """
        sizes, betas = [], []
        for pair in filter(None, re.split(r"[,;]\s*", text.strip())):
            left, equals, right = pair.partition("=")
            left = re.sub(r"^\s*(beta|β)_?\s*|\(c\)\s*$", "", left).strip()
            try:
                if not equals:
                    raise InvalidValue(f"{say(pair)} has no '='", code=Mistake.FORM)
                plain = re.fullmatch(r"[\d.]+(e-?\d+)?", left)
                sizes.append(1e-6 * float(left) if plain else to_si(left, "m"))
                betas.append(to_si(right.strip(), "1"))
            except (InvalidValue, ValueError) as error:
                why = error.problems[0] if isinstance(error, InvalidValue) else str(error)
                raise InvalidValue(
                    f"{why}; a filter is written as on its data sheet, size [µm]=β: "
                    '"5=75, 10=1000"',
                    code=Mistake.FORM,
                ) from None
        order = np.argsort(sizes, kind="stable")
        return cls(sizes=tuple(sizes[i] for i in order), betas=tuple(betas[i] for i in order))

    def _line(self) -> tuple[Array, Array]:
        """ln x and ln β in service of the line, two points at least."""
        log_sizes, logs = np.log(self.sizes), self.service * np.log(self.betas)
        if len(log_sizes) > 1:
            return log_sizes, logs
        return np.array([log_sizes[0] + math.log(FINEST), log_sizes[0]]), np.array([0.0, logs[0]])

    @property
    def _finest(self) -> float:
        """The size from which it holds something [m]."""
        log_sizes, logs = self._line()
        rise = logs[1] - logs[0]
        if rise == 0:
            return 0.0
        return math.exp(log_sizes[0] - logs[0] * (log_sizes[1] - log_sizes[0]) / rise)

    def beta(self, x: ArrayLike) -> Array:
        """β ratios in service at sizes x [m].

        Parameters
        ----------
        x : float or array
            Sizes [m].
        """
        at, (log_sizes, logs) = np.log(np.asarray(x, float)), self._line()
        slope = (logs[1] - logs[0]) / (log_sizes[1] - log_sizes[0])
        below = np.maximum(logs[0] + slope * (at - log_sizes[0]), 0.0)
        between = self.service * self._logs_between(at)[0]
        return np.exp(np.where(at < math.log(self.sizes[0]), below, between))

    def _logs_between(self, at: Array) -> tuple[Array, Array]:
        """ln β and its slope over ln x at logarithms of sizes, from the first size on."""
        log_sizes, betas = np.log(self.sizes), np.array(self.betas)
        at = np.asarray(at, float)
        values, slopes = np.full(at.shape, math.log(betas[-1])), np.zeros(at.shape)
        for i, (a, b) in enumerate(pairwise(log_sizes)):
            one, two = betas[i : i + 2]
            inside = (at >= a) & (at < b)
            if one > 1:
                rise = math.log((two - 1) / (one - 1)) / (b - a)
                more = (one - 1) * np.exp(rise * (at[inside] - a))
                values[inside] = np.log1p(more)
                slopes[inside] = rise * more / (1 + more)
            else:
                slopes[inside] = math.log(two) / (b - a)
                values[inside] = slopes[inside] * (at[inside] - a)
        return values, slopes

    def _raw_penetration(self, x: ArrayLike) -> Array:
        """P(x), above 1 too [1]."""
        at = np.log(np.asarray(x, float))
        values, slopes = self._logs_between(at)
        penetration = np.exp(-self.service * values) * (1 + self.service * slopes / self.dust_slope)
        return np.where(np.asarray(x) < self.sizes[0], 1.0, penetration)

    def penetration(self, x: ArrayLike) -> Array:
        r"""Part of the particles of sizes x that passes once P [1].

        .. math:: P(x) = \beta^{-s}\left[1 + \frac{s}{q}
                  \frac{d\ln\beta}{d\ln x}\right] \le 1

        β counts all particles above a size, so one size alone needs the slope of β too. Below the
        first size nothing is held.

        Parameters
        ----------
        x : float or array
            Sizes [m].

        Examples
        --------
        >>> import thirdbody as tb
        >>> data_sheet = tb.oil.Filter(sizes=(5e-6, 10e-6), betas=(2.0, 75.0))
        >>> float(data_sheet.penetration(7e-6).round(6)), float(data_sheet.beta(7e-6).round(2))
        (0.313002, 9.08)
        """
        return np.minimum(self._raw_penetration(x), 1.0)

    @property
    def clipped_to(self) -> float | None:
        """The size up to which more would pass than comes, so that nothing is held [m].

        None where the β ratios rise slowly enough.
        """
        tops = [b for a, b in self._clipped_stretches]
        return max(tops) if tops else None

    @property
    def _clipped_stretches(self) -> list[tuple[float, float]]:
        """Stretches of size in which P would be above 1 [m]."""
        from scipy.optimize import brentq

        out = []
        for a, b in pairwise(self.sizes):
            first, last = a * (1 + 1e-12), b * (1 - 1e-12)
            # from β = 1 on P begins at 1, and rises where it is to fall below 1 later
            begins = float(self._raw_penetration(first)) - 1
            ends = float(self._raw_penetration(last)) - 1
            if begins <= 1e-12:
                continue
            if ends >= 0:
                out.append((a, b))
                continue
            end = brentq(lambda x: float(self._raw_penetration(x)) - 1, first, last, xtol=1e-18)
            out.append((a, float(end)))
        return out

    def mean_penetration(self, edges: ArrayLike) -> Array:
        r"""Part of the particles of each class that passes once P̄ [1], (K,).

        .. math:: \bar P_k = \int_k P\,x^{-4}\,dx \Big/ \int_k x^{-4}\,dx

        Parameters
        ----------
        edges : array (K + 1,)
            Edges of the classes [m].
        """
        e = np.asarray(edges, float)
        splits = [*self.sizes, *(end for _, end in self._clipped_stretches)]
        x = np.unique([*e, *(s for s in splits if e[0] < s < e[-1])])
        nodes, weights = gauss_legendre(NODES)
        low, high = np.log(x[:-1])[:, None], np.log(x[1:])[:, None]
        at = np.exp(0.5 * (high + low) + 0.5 * (high - low) * nodes)
        held = 0.5 * (high - low) * weights * (at / e[-1]) ** -3.0
        home = np.searchsorted(e, x[:-1], side="right") - 1
        sums = [
            np.bincount(home, weights=np.sum(amount, axis=1), minlength=len(e) - 1)
            for amount in (held * self.penetration(at), held)
        ]
        return sums[0] / sums[1]

    def behind(
        self, number: float, diameter: Distribution, *, goes_on: bool = True
    ) -> tuple[float, Distribution]:
        """Particles per volume n [1/m³] and their sizes behind the filter.

        Parameters
        ----------
        number : float
            Particles per volume before it [1/m³].
        diameter : Distribution
            Their sizes by number.
        goes_on : bool, optional
            Whether ln β goes on along its line below the smallest size; else nothing is held there.

        Raises
        ------
        InvalidValue
            All particles are of one size.
        """
        low, high = diameter.support
        if not 0 < low < high:
            raise InvalidValue(
                "a filter needs sizes that are spread: particles of one size have no count "
                "above it",
                code=Mistake.BEYOND,
            )
        kinks = [x for x in (*self.sizes, self._finest, *diameter.kinks) if low < x < high]
        edges = np.unique([*np.geomspace(low, high, CLASSES + 1), *kinks])
        above = number * np.array([float(diameter.partial_moment(0, x, high)) for x in edges])
        above[-1] = 0.0
        beta = self.beta(edges)
        left = above / beta
        if not left[0] > 0:
            return 0.0, diameter
        # −dN/dx behind, N/β, at both ends of each section, in which β is a power of x
        power = np.diff(np.log(beta)) / np.diff(np.log(edges))
        counts, betas = np.maximum(left[:-1] - left[1:], 0.0), (beta[:-1], beta[1:])
        if not goes_on:
            passes = edges[1:] <= self.sizes[0] * (1 + 1e-12)
            power = np.where(passes, 0.0, power)
            counts = np.where(passes, above[:-1] - above[1:], counts)
            betas = np.where(passes, 1.0, betas[0]), np.where(passes, 1.0, betas[1])
        ends = (edges[:-1], np.nextafter(edges[1:], 0.0))
        logs = [
            np.log(np.maximum((number * diameter.pdf(x) + N * power / x) / b, 1e-300))
            for x, N, b in zip(ends, (above[:-1], above[1:]), betas, strict=True)
        ]
        slopes = -(logs[1] - logs[0]) / np.diff(np.log(edges)) - 1
        slopes = np.where(counts > 0, np.clip(slopes, -STEEPEST, STEEPEST), 0.0)
        sizes_behind = PowerLaw(edges=tuple(edges), counts=tuple(counts), slopes=tuple(slopes))
        return float(left[0]) if goes_on else float(counts.sum()), sizes_behind
