r"""Measured sizes: histograms by number, area or volume, and what is fitted to them.

The model counts particles. A size analyser may weigh each of them with its area or its volume,

.. math:: q_r(x) \propto x^r \varphi_a(x), \qquad r = 0, 2, 3,

and `by_number` undoes that: φ_a ∝ x^(−r) q_r. A little volume in the finest sizes is a great
many particles, so the smallest size must be said where the data do not end by themselves.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import exprel

from ...errors import InvalidValue, Mistake, Problem
from ...numerics.quadrature import gauss_legendre
from ...quantities.arguments import names_arguments
from ...quantities.carried import takes_units
from ...quantities.csv_cells import numbered_cells
from ...quantities.record import Record, column
from ...quantities.units import MICRONS, not_among, say, to_si
from ...quantities.value import Value, choice
from ..distributions import (
    Distribution,
    Histogram,
    LogNormal,
    Mixture,
    Monodisperse,
    PowerLaw,
    TruncatedGaussian,
    Uniform,
    Weibull,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["FITS", "WEIGHTINGS", "Fit", "MeasuredSizes", "by_number", "read_sizes"]

WEIGHTINGS = {"number": 0, "area": 2, "volume": 3}
"""The power r of the diameter with which a size analyser weighs a particle."""

_SECTIONS = 48
_LEFT_OUT = 1e-9
"""Volume (or area) above the largest size that a converted infinite tail keeps."""


@takes_units
def by_number(
    sizes: Distribution, weighting: str, *, smallest: float | None = None
) -> Distribution:
    r"""The number distribution behind sizes by area or by volume.

    .. math:: \varphi_a(x) = \frac{x^{-r} q_r(x)}{\int x^{-r} q_r\,dx}, \qquad r = 0, 2, 3

    Parameters
    ----------
    sizes : Distribution
        Sizes x with the density q_r [1/m].
    weighting : {"number", "area", "volume"}
        What q_r counts.
    smallest : float, optional
        Smallest diameter [m]; what is below is left out. Needed where the sizes reach down to
        zero, because the number of particles in a given volume then has no bound.

    Returns
    -------
    Distribution
        Exact for one size, log-normal (median times exp(−r s²), Hatch and Choate), uniform,
        histogram and power law; the others become a `PowerLaw` of 48 sections.

    Raises
    ------
    InvalidValue
        Unknown weighting; sizes that reach zero without ``smallest``.

    Notes
    -----
    Accuracy of the 48 sections: the moments 0 to 3 within 3e-5 for Rosin–Rammler shapes from 0.8
    to 6 cut at 1/20 of the scale.

    References
    ----------
    Hatch and Choate 1929, J. Franklin Inst. 207, 369, doi:10.1016/S0016-0032(29)91451-4.

    Examples
    --------
    >>> import thirdbody as tb
    >>> round(tb.sizes.by_number(tb.LogNormal(median=10e-6, gsd=2), "volume").median * 1e6, 4)
    2.3661
    """
    if weighting not in WEIGHTINGS:
        raise InvalidValue(not_among("weighting", weighting, WEIGHTINGS))
    power = WEIGHTINGS[weighting]
    if smallest is not None and not (0 < smallest < sizes.support[1]):
        rule = f"must be above 0 and below the largest size {sizes.support[1]:.4g} [m]"
        raise InvalidValue(
            Problem("smallest", rule, f"{smallest:g}", hint=MICRONS, code=Mistake.RANGE)
        )
    if power == 0 and smallest is None:
        return sizes
    match sizes:
        case Monodisperse():
            return sizes
        case LogNormal() if smallest is None:
            return LogNormal(median=sizes.median * math.exp(-power * sizes.s**2), gsd=sizes.gsd)
        case Mixture():
            parts = [
                by_number(component, weighting, smallest=smallest)
                for _, component in sizes.components
            ]
            # the share of each part: what of its weight is above the cut, over its ⟨x^r⟩
            weights = [
                weight * _above(component, smallest) / number.moment(power)
                for (weight, component), number in zip(sizes.components, parts, strict=True)
            ]
            return Mixture(parts=tuple(parts), weights=tuple(w / max(weights) for w in weights))
    return _reweight(sizes, power, smallest, weighting)


def _above(sizes: Distribution, smallest: float | None) -> float:
    lo, hi = sizes.support
    return float(sizes.partial_moment(0, lo - 1 if smallest is None else smallest, hi))


def _reweight(
    sizes: Distribution, power: int, smallest: float | None, weighting: str
) -> Distribution:
    """Sections of power laws with numbers that follow from their weights."""
    lo, hi = sizes.support
    if isinstance(sizes, (LogNormal, Weibull)):
        hi = float(sizes.ppf(1 - _LEFT_OUT))
    lo = lo if smallest is None else max(lo, smallest)
    if lo <= 0:
        raise InvalidValue(
            f"sizes by {weighting} that reach down to 0 stand for a number of particles without "
            "bound; give smallest, the diameter below which nothing is counted, e.g. '0.5 um'",
            code=Mistake.MISSING,
        )
    if isinstance(sizes, (Histogram, Uniform, PowerLaw)):
        inner = [x for x in sizes.kinks if lo < x < hi]
        edges = np.array([lo, *inner, hi])
        middle = np.sqrt(edges[1:] * edges[:-1])
        slopes = np.full(len(middle), -1.0)
        if isinstance(sizes, PowerLaw):
            slopes = np.array(sizes.slopes)[np.searchsorted(sizes.edges, middle) - 1]
        long = np.log(edges[1:] / edges[:-1])
        weight = sizes.partial_moment(0, edges[:-1], edges[1:])
        # ∫x^(−r) over ∫1, of a density ∝ x^(−s−1)
        share = exprel(-(slopes + power) * long) / exprel(-slopes * long)
        counts = weight * (edges[:-1] / lo) ** -power * share
        return PowerLaw(edges=tuple(edges), counts=tuple(counts), slopes=tuple(slopes + power))
    edges = np.geomspace(lo, hi, _SECTIONS + 1)
    edges[0], edges[-1] = lo, hi
    nodes, weights = gauss_legendre(16)
    half = 0.5 * np.diff(np.log(edges))[:, None]
    x = np.sqrt(edges[1:] * edges[:-1])[:, None] * np.exp(half * nodes)
    counts = np.sum(half * weights * x * sizes.pdf(x) * (x / lo) ** -power, axis=1)
    at = sizes.pdf(edges * (1 + 1e-12 * np.linspace(1, -1, len(edges))))
    with np.errstate(divide="ignore", invalid="ignore"):
        slopes = -np.diff(np.log(at)) / (2 * half[:, 0]) - 1 + power
    slopes = np.where(np.isfinite(slopes), slopes, 0.0)
    return PowerLaw(edges=tuple(edges), counts=tuple(counts), slopes=tuple(slopes))


# ------------------------------------------------------------------------------ measured
@dataclass(frozen=True, slots=True, kw_only=True)
class MeasuredSizes(Value):
    """A measured histogram and what it counts.

    Parameters
    ----------
    sizes : Histogram
        Edges [m] and amounts, spread evenly over x inside each bin.
    weighting : {"number", "area", "volume"}
        What the amounts are.

    Examples
    --------
    >>> import thirdbody as tb
    >>> data = tb.sizes.MeasuredSizes(
    ...     sizes=tb.distributions.Histogram(edges=(1e-6, 2e-6, 4e-6), counts=(1, 7)),
    ...     weighting="volume",
    ... )
    >>> round(data.by_number().mean_diameter * 1e6, 4)
    1.9556
    """

    sizes: Histogram
    weighting: str = choice("what the amounts are", *WEIGHTINGS, default="number")

    def _problems(self) -> list[str]:
        if isinstance(self.sizes, Histogram):
            return []
        return [Problem("sizes", "must be a Histogram", repr(self.sizes), code=Mistake.KIND)]

    def by_number(self, smallest: float | None = None) -> Distribution:
        """The number distribution φ_a; see `by_number`."""
        return by_number(self.sizes, self.weighting, smallest=smallest)

    @property
    def cumulative(self) -> Array:
        """Share of the amount below each edge [1], (n + 1,)."""
        counts = np.array(self.sizes.counts)
        return np.concatenate([[0.0], np.cumsum(counts)]) / counts.sum()

    def fit(self, kind: str) -> Fit:
        r"""Least squares of the cumulative amounts.

        .. math:: \min \sum_j [Q(e_j) - Q_j]^2

        Parameters
        ----------
        kind : {"log-normal", "rosin-rammler", "truncated-gaussian"}
            Rosin–Rammler is the Weibull law of the volume below a size, 1 − exp[−(x/x_0)^k].

        Returns
        -------
        Fit
            In the weighting of the data; `Fit.by_number` converts.

        Raises
        ------
        InvalidValue
            Unknown kind, or fewer than three bins: two parameters fit those whatever they are.
        """
        from scipy.optimize import least_squares

        if kind not in FITS:
            raise InvalidValue(not_among("fit", kind, FITS))
        if len(self.sizes.counts) < 3:
            raise InvalidValue(
                f"{len(self.sizes.counts)} bins do not test a fit with two parameters; "
                "give at least 3 bins, or use the histogram itself",
                code=Mistake.BEYOND,
            )
        edges = np.array(self.sizes.edges)
        below = self.cumulative
        median, low, high = (float(self.sizes.ppf(q)) for q in (0.5, 0.16, 0.84))
        build, start = FITS[kind](median, low, high)
        top = edges[-1]

        def misfit(p: Array) -> Array:
            return build(p).partial_moment(0, np.full_like(edges, -top), edges) - below

        solution = least_squares(misfit, start, x_scale=1.0, xtol=1e-12, ftol=1e-12, gtol=1e-12)
        error = misfit(solution.x)
        spread = np.sum((below - below.mean()) ** 2)
        return Fit(
            kind=kind,
            distribution=build(solution.x),
            weighting=self.weighting,
            smallest=float(edges[edges > 0][0]),
            r_squared=float(1 - np.sum(error**2) / spread),
            rms=float(np.sqrt(np.mean(error**2))),
            worst=float(np.max(np.abs(error))),
        )

    def fits(self) -> tuple[Fit, ...]:
        """Every kind of fit, the best first."""
        return tuple(sorted((self.fit(kind) for kind in FITS), key=lambda fit: fit.rms))


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Fit(Record):
    """A distribution fitted to measured sizes, and how well it fits.

    Parameters
    ----------
    kind : str
        Word of the fit.
    distribution : Distribution
        In the weighting of the data.
    weighting : str
        What the data count.
    smallest : float
        Smallest edge of the data above zero [m].
    r_squared : float
        1 − Σ(Q − Q_j)²/Σ(Q_j − mean)² over the edges [1].
    rms, worst : float
        Root mean square and largest |Q − Q_j| [1]; the largest is the Kolmogorov distance at the
        edges.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.populations.distributions import Histogram
    >>> bins = Histogram(edges=(0.5e-6, 1e-6, 2e-6, 4e-6, 8e-6, 16e-6), counts=(3, 14, 38, 36, 9))
    >>> fit = tb.sizes.MeasuredSizes(sizes=bins, weighting="volume").fits()[0]
    >>> fit.kind, round(fit.worst, 3), f"{fit.by_number().mean_diameter * 1e6:.2f} µm by number"
    ('log-normal', 0.012, '1.41 µm by number')
    """

    kind: str = column("", "", "word of the fit")
    distribution: Distribution
    weighting: str = column("", "", "what the data count")
    smallest: float = column("x", "m", "smallest edge of the data above zero")
    r_squared: float = column("R²", "1", "coefficient of determination over the edges")
    rms: float = column("", "1", "root mean square of |Q − Q_j|")
    worst: float = column("", "1", "largest |Q − Q_j|")

    @takes_units
    def by_number(self, smallest: float | None = None) -> Distribution:
        """The number distribution φ_a.

        Where it would reach down to zero it is cut at ``smallest`` [m], by default the smallest
        edge of the data: nothing was measured below.
        """
        cut = self.smallest if smallest is None and self.distribution.support[0] <= 0 else smallest
        cut = None if self.weighting == "number" and smallest is None else cut
        return by_number(self.distribution, self.weighting, smallest=cut)


_Start = tuple[Callable[[Any], Distribution], list[float]]


def _log_normal(median: float, low: float, high: float) -> _Start:
    def build(p: Array) -> Distribution:
        return LogNormal(
            median=median * math.exp(p[0]), gsd=1 + 18.9 / (1 + math.exp(-p[1])) + 1e-9
        )

    width = min(max(0.5 * math.log(high / max(low, high / 1e3)), 1e-3), 2.0)
    share = math.expm1(width) / 18.9
    return build, [0.0, math.log(share / (1 - share))]


def _rosin_rammler(median: float, low: float, high: float) -> _Start:
    def build(p: Array) -> Distribution:
        return Weibull(scale=median * math.exp(p[0]), shape=0.5 + 99 / (1 + math.exp(-p[1])))

    shape = min(max(2.356 / math.log(high / max(low, high / 1e3)), 0.6), 90.0)
    share = (shape - 0.5) / 99
    return build, [-math.log(math.log(2)) / shape, math.log(share / (1 - share))]


def _gaussian(median: float, low: float, high: float) -> _Start:
    def build(p: Array) -> Distribution:
        return TruncatedGaussian(mean=median * math.exp(p[0]), std=median * math.exp(p[1]))

    return build, [0.0, math.log(max(0.5 * (high - low), 1e-4 * median) / median)]


FITS: dict[str, Callable[[float, float, float], _Start]] = {
    "log-normal": _log_normal,
    "rosin-rammler": _rosin_rammler,
    "truncated-gaussian": _gaussian,
}
"""Every fit by its word: what a median and the 16 and 84 % sizes give as a start."""


# ------------------------------------------------------------------------------ files
_MOST_ROWS = 100_000


@names_arguments
def read_sizes(path: str | os.PathLike[str], *, weighting: str = "number") -> MeasuredSizes:
    """Measured sizes from a CSV file.

    Three columns are the lower edge, the upper edge and the amount of each bin; two columns are a
    size and the amount below it. The first line names them, with the unit of the sizes in
    brackets: ``low [um], high [um], volume [%]`` or ``size [um], below [%]``.

    Parameters
    ----------
    path : path-like
        Text in UTF-8, columns parted by comma, semicolon or tab; with semicolons or tabs the
        decimal mark may be a comma. Lines that begin with # are comments.
    weighting : {"number", "area", "volume"}, optional
        What the amounts are.

    Returns
    -------
    MeasuredSizes

    Raises
    ------
    InvalidValue
        One sentence with the line, what stands there, and what is allowed.

    Examples
    --------
    >>> from pathlib import Path
    >>> import tempfile
    >>> import thirdbody as tb
    >>> file = Path(tempfile.mkdtemp()) / "sizes.csv"
    >>> _ = file.write_text("low [um],high [um],volume [%]\\n1,2,40\\n2,4,60\\n")
    >>> tb.sizes.read_sizes(file, weighting="volume").sizes.edges
    (1e-06, 2e-06, 4e-06)
    """
    if weighting not in WEIGHTINGS:
        raise InvalidValue(not_among("weighting", weighting, WEIGHTINGS))
    lines = numbered_cells(Path(path), "a CSV file of sizes", most=_MOST_ROWS)
    head, names = lines[0]
    if len(names) not in (2, 3):
        raise InvalidValue(
            f"{path}, line {head}: {len(names)} column{'s' * (len(names) != 1)} where 2 (size, "
            "below) or 3 (low, high, amount) are needed; columns are parted by comma, semicolon "
            "or tab",
            code=Mistake.FORM,
        )
    unit = _unit(path, head, names)
    if len(lines) == 1:
        raise InvalidValue(f"{path} has a first line but no sizes below it", code=Mistake.EMPTY)
    rows = []
    for number, cells in lines[1:]:
        if len(cells) != len(names):
            raise InvalidValue(
                f"{path}, line {number}: {len(cells)} values where the first line names "
                f"{len(names)} columns",
                code=Mistake.FORM,
            )
        rows.append([_number(path, number, cell) for cell in cells])
    numbers = [number for number, _ in lines[1:]]
    edges, amounts = (_bins if len(names) == 3 else _below)(path, numbers, np.array(rows), names)
    if not amounts.any():
        raise InvalidValue(
            f"{path}: every amount is 0, so there are no particles", code=Mistake.EMPTY
        )
    scaled = [to_si(f"{edge!r} {unit}", "m") for edge in edges.tolist()]
    return MeasuredSizes(
        sizes=Histogram(edges=tuple(scaled), counts=tuple(amounts)), weighting=weighting
    )


def _unit(path: object, line: int, names: list[str]) -> str:
    """The unit of the sizes, from the first line."""
    units = []
    for name in names[:-1]:
        match = re.search(r"[\[(]\s*([^\])]+?)\s*[\])]", name)
        if not match:
            cause = (
                "; the first line must be names, not numbers"
                if re.fullmatch(r"[\d.eE+-]+", name)
                else ""
            )
            raise InvalidValue(
                f"{path}, line {line}: column {say(name)} has no unit; write it in brackets, "
                f'e.g. "{"low" if len(names) == 3 else "size"} [um]"{cause}',
                code=Mistake.FORM,
            )
        try:
            to_si(f"1 {match[1]}", "m")
        except InvalidValue as error:
            raise InvalidValue(
                f"{path}, line {line}, column {say(name)}: {error}", code=Mistake.FORM
            ) from None
        units.append(match[1])
    if len(set(units)) > 1:
        raise InvalidValue(
            f"{path}, line {line}: both sizes must have one unit, not {units}", code=Mistake.FORM
        )
    return units[0]


def _number(path: object, line: int, cell: str) -> float:
    try:
        value = float(cell)
    except ValueError:
        what = f"{say(cell)} is not a number" if cell else "a value is missing"
        raise InvalidValue(f"{path}, line {line}: {what}", code=Mistake.FORM) from None
    if not math.isfinite(value) or value < 0:
        raise InvalidValue(
            f"{path}, line {line}: {cell} must be finite and not negative", code=Mistake.FORM
        )
    return value


def _bins(path: object, lines: list[int], rows: Array, names: list[str]) -> tuple[Array, Array]:
    """Adjoining bins."""
    for i, (low, high, _) in enumerate(rows.tolist()):
        if high <= low:
            raise InvalidValue(
                f"{path}, line {lines[i]}: the upper edge {high:g} must be above the lower {low:g}",
                code=Mistake.FORM,
            )
        if i and not math.isclose(low, rows[i - 1, 1], rel_tol=1e-6):
            raise InvalidValue(
                f"{path}, line {lines[i]}: the bin begins at {low:g}, but the one before ends at "
                f"{rows[i - 1, 1]:g}; bins must increase and adjoin (an empty bin has the amount "
                "0)",
                code=Mistake.FORM,
            )
    return np.append(rows[:, 0], rows[-1, 1]), rows[:, 2]


def _below(path: object, lines: list[int], rows: Array, names: list[str]) -> tuple[Array, Array]:
    """Amounts between sizes, from the amounts below them."""
    sizes, below = rows.T
    for i in range(1, len(rows)):
        if sizes[i] <= sizes[i - 1] or below[i] < below[i - 1]:
            what = "sizes must increase" if sizes[i] <= sizes[i - 1] else "amounts must not fall"
            raise InvalidValue(
                f"{path}, line {lines[i]}: {what} from line to line; of two columns the second is "
                "the amount below each size; amounts of single classes need three columns, low, "
                "high, amount",
                code=Mistake.FORM,
            )
    if len(rows) < 2:
        raise InvalidValue(
            f"{path} has one size; a histogram needs at least two", code=Mistake.SHAPE
        )
    if below[0] > 0:
        raise InvalidValue(
            f"{path}, line {lines[0]}: {below[0]:g} lies below the first size {sizes[0]:g}, and "
            "nothing says how it is spread; add a line with the size below which there is 0",
            code=Mistake.FORM,
        )
    if "%" in names[1] and not 99.5 <= below[-1] <= 100.5:
        raise InvalidValue(
            f"{path}, line {lines[-1]}: the last amount is {below[-1]:g} %; add a line with the "
            "size below which there is 100 %",
            code=Mistake.FORM,
        )
    return sizes, np.diff(below)
