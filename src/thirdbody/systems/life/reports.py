r"""What oil reports say of the dirt that enters: the ingress, its band, and whether it is constant.

.. math:: n_i(t_j) = \sum_k \left[a_k(t_j)\,\varphi_k\,n_0 + b_k(t_j)\,\psi_k\,r + c_k(t_j)\right]

Everything but the start n_0 and the ingress r of each interval of size is known of the circuit, and
both come in linearly. What is fitted is the logarithm of the counts: a code is a range of a factor.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np
from scipy.optimize import nnls
from scipy.special import chdtrc

from ...errors import InvalidValue, Mistake, Problem
from ...populations.materials import Material
from ...populations.measured.cleanliness import (
    LARGEST,
    TAIL_SLOPE,
    counted_sizes,
    iso4406_range,
    read_iso4406,
    sizes_above,
)
from ...quantities.carried import takes_units
from ...quantities.record import Column, TableRecord, Variable
from .circuit import OilCircuit
from .ingress import Ingress
from .linear_flow import flowing
from .oil_dirt import OilDirt
from .report_files import read_reports
from .reported_zeros import Zeros
from .size_classes import FALL, SizeClasses

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["Approach", "OilReports", "approach_of_reports", "oil_reports", "read_reports"]


def __dir__() -> list[str]:
    return sorted(__all__)


WIDTH = 2.0
"""Largest over least count that one number of an ISO 4406 code stands for."""
LEAST = 1e6
"""Count below which a report says 0 [1/m³]: one in a millilitre."""
OF_ZERO = 1.0
"""Standard deviation of the logarithm of a count of 0, anywhere below its limit."""
WITHIN = 6
"""Classes of size between two counted sizes."""
DRAWS = 200
"""Sets of reports of each kind of which the band is made."""
BAND = (5.0, 95.0)
"""Ends of the band [%]."""
SHAPES = 4
"""Times that the slopes inside the intervals are taken from the fit before."""
STEPS = 30
"""Most steps of a fit."""
UNLIKELY = 0.05
"""Probability below which a constant ingress does not fit."""
STEEPEST = 8.0
"""Largest slope of a count between two sizes."""


class Approach(NamedTuple):
    """How a count comes to its end; made by `approach_of_reports`.

    Examples
    --------
    >>> from thirdbody.systems.life.reports import approach_of_reports
    >>> found = approach_of_reports([10000e6, 22092.95e6, 30529.91e6], step=3600.0)
    >>> f"{found.rate:.4g} 1/s towards {found.limit / 1e6:.5g} per mL"
    '0.0001 1/s towards 50000 per mL'
    """

    rate: float
    """λ [1/s]."""
    limit: float
    """Particles per volume that it comes to n_∞ [1/m³]."""


@takes_units
def approach_of_reports(counts: Sequence[float], *, step: float) -> Approach:
    r"""Rate and end of a count, from three reports at equal times, whatever the filter does.

    .. math:: \lambda = \frac{1}{\Delta t}\ln\frac{n_1-n_0}{n_2-n_1}, \qquad
              n_\infty = \frac{n_0 n_2 - n_1^2}{n_0 + n_2 - 2 n_1}

    Parameters
    ----------
    counts : sequence of float
        Three counts [1/m³].
    step : float
        Time between two of them [s].

    Returns
    -------
    Approach

    Raises
    ------
    InvalidValue
        Counts that come to no end: they do not bend towards one.

    Notes
    -----
    Exact for n = n_∞ + (n_0 − n_∞) e^{−λt}, one class of size with constant ingress. With codes,
    each a factor of two wide, the three are seldom sharp enough.
    """
    if len(counts) != 3:
        raise InvalidValue(
            Problem("counts", "must be three", repr(len(counts)), code=Mistake.SHAPE)
        )
    first, middle, last = (float(count) for count in counts)
    one, two = middle - first, last - middle
    if not (one * two > 0 and abs(two) < abs(one)):
        rule = "come to no end: each step must be smaller than the one before, and in its direction"
        raise InvalidValue(Problem("counts", rule, code=Mistake.BEYOND))
    rate = math.log(one / two) / step
    return Approach(rate, (first * last - middle**2) / (first + last - 2 * middle))


@dataclass(frozen=True, eq=False, kw_only=True)
class OilReports(TableRecord):
    """Dirt that enters an oil, from reports of it; made by `oil_reports`.

    Attributes
    ----------
    times : array (R,)
        Of the reports [s].
    sizes : array (S,)
        From which is counted [m].
    counts, fitted : array (R, S)
        Particles per volume from each size on, as reported and as the circuit would have them
        [1/m³].
    rate, low, high : array (S,)
        Particles that enter per time from each size on, and the ends of their band [1/s].
    mass_rate, mass_low, mass_high : float
        The same as mass, from the first size on [kg/s].
    chi2 : float
        Squared misfit over that of codes [1].
    degrees : int
        Reported counts beyond what is fitted.
    probability : float
        Of a misfit as large, if the ingress is constant [1]; NaN where nothing is left to judge by.
    ingress : Ingress
        For a circuit.
    start : OilDirt
        In the oil at the first report.
    coded : bool
        Whether the reports are codes, not counts.
    width : float
        Largest over least count that a report may stand for w [1].
    least : float
        Count below which a report says 0 [1/m³].
    """

    not_in_dict: ClassVar[tuple[str, ...]] = ("ingress", "start", "coded", "width", "least")

    times: Array
    sizes: Array
    counts: Array
    fitted: Array
    rate: Array
    low: Array
    high: Array
    mass_rate: float
    mass_low: float
    mass_high: float
    chi2: float
    degrees: int
    probability: float
    ingress: Ingress
    start: OilDirt
    coded: bool = True
    width: float = WIDTH
    least: float = LEAST

    def variables(self) -> dict[str, Variable]:
        """Counts at each report and from each size on, and what enters."""
        both, of_size = ("time", "size"), ("size",)
        counts = Column("", "1/m^3", "reported particles per volume from a size on")
        fitted = Column("", "1/m^3", "particles per volume as the circuit would have them")
        rate = Column("", "1/s", "particles that enter per time from a size on")
        mass = Column("", "kg/s", "mass that enters per time")
        out = {
            "counts": Variable(both, self.counts, counts.labels),
            "fitted": Variable(both, self.fitted, fitted.labels),
        }
        for name, ending in (("rate", ""), ("low", ", low end"), ("high", ", high end")):
            for key, dims, about in ((name, of_size, rate), (f"mass_{name}", (), mass)):
                labels = about._replace(meaning=about.meaning + ending).labels
                out[key] = Variable(dims, getattr(self, key), labels)
        return out

    def coordinates(self) -> dict[str, Variable]:
        """Times of the reports, and sizes."""
        sizes = Column("x", "m", "size from which is counted")
        return {
            "time": Variable(("time",), self.times, Column("t", "s", "time of a report").labels),
            "size": Variable(("size",), self.sizes, sizes.labels),
        }

    @property
    def is_constant(self) -> bool | None:
        """Whether a constant ingress fits; None where two reports leave nothing to judge by."""
        return None if self.degrees == 0 else self.probability > UNLIKELY


# ------------------------------------------------------------------------------ the model
class _Grid(NamedTuple):
    """Classes of size, several in each interval between two counted sizes."""

    classes: SizeClasses
    ends: Array
    """Of the intervals [m], (S + 1,)."""

    @classmethod
    def from_sizes(cls, sizes: Array) -> _Grid:
        ends = np.append(sizes, LARGEST["iso4406"])
        parts = [np.geomspace(a, b, WITHIN + 1)[:-1] for a, b in zip(ends, ends[1:], strict=False)]
        return cls(SizeClasses(edges=(*np.concatenate(parts), ends[-1])), ends)

    def shape(self, above: Array) -> Array:
        """Part of each interval that is in its classes [1], (S, K), for counts above its ends."""
        edges, out = np.array(self.classes.edges), []
        for i in range(len(above)):
            slope = TAIL_SLOPE if i == len(above) - 1 else FALL
            if i < len(above) - 1 and above[i] > above[i + 1] > 0:
                slope = math.log(above[i] / above[i + 1]) / math.log(
                    self.ends[i + 1] / self.ends[i]
                )
            e = edges[i * WITHIN : (i + 1) * WITHIN + 1] / edges[i * WITHIN]
            parts = -np.diff(e ** -min(max(slope, 0.1), STEEPEST))
            row = np.zeros(self.classes.count)
            row[i * WITHIN : (i + 1) * WITHIN] = parts / parts.sum()
            out.append(row)
        return np.array(out)


class _Responses(NamedTuple):
    """Particles per volume at the reports, (R, K)."""

    of_start: Array
    """Of one particle per volume at the first report [1]."""
    of_source: Array
    """Of one particle that enters per time [s/m³]."""
    of_fresh: Array
    """Of the oil that comes in [1/m³]."""


def _responses(
    circuit: OilCircuit, material: Material, classes: SizeClasses, times: Array
) -> _Responses:
    """What a circuit makes of a start and of a source, class by class."""
    loss = sum(circuit.removal(classes, {"": material}).values(), np.zeros((classes.count, 1)))[
        :, 0
    ]
    growth = circuit.make_up - circuit.leak
    fresh = np.zeros(classes.count)
    for dirt in circuit.fresh_oil or ():
        fresh = fresh + _counted_in(classes, dirt)
    start = np.stack([np.ones(classes.count), np.zeros(classes.count), np.zeros(classes.count)])
    source = np.stack([np.zeros(classes.count), np.ones(classes.count), circuit.make_up * fresh])
    stops = sorted({*times, *(t for t in circuit.oil_changes if times[0] < t < times[-1])})
    volume, numbers, now = circuit.volume, circuit.volume * start, float(times[0])
    out = []
    for stop in stops:
        step = float(stop) - now
        numbers = flowing(
            volume, numbers=numbers, growth=growth, source=source, loss=loss, time=step
        ).numbers
        volume, now = volume + growth * step, float(stop)
        if stop in circuit.oil_changes and stop > times[0]:
            filled = np.stack([np.zeros_like(fresh), np.zeros_like(fresh), fresh])
            if stop in times:  # a sample of that hour is drawn before the oil
                out.append(numbers / volume)
            numbers = volume * filled
        elif stop in times:
            out.append(numbers / volume)
    return _Responses(*np.stack(out, axis=1))


def _counted_in(classes: SizeClasses, dirt: OilDirt) -> Array:
    """Particles of each class per volume; those below the first class are not counted."""
    edges = np.array(classes.edges)
    high = max(edges[-1], dirt.diameter.support[1])
    return dirt.number * np.asarray(
        dirt.diameter.partial_moment(0, edges[:-1], np.append(edges[1:-1], high)), float
    )


class _Fit(NamedTuple):
    """A fit to one set of reports."""

    start: Array
    """Particles per volume of each interval at the first report [1/m³], (S,)."""
    rate: Array
    """Particles of each interval that enter per time [1/s], (S,)."""
    fitted: Array
    """Counts from each size on [1/m³], (R, S)."""


class _Model:
    """Counts of the reports from start and ingress of each interval."""

    def __init__(self, grid: _Grid, responses: _Responses, count: int) -> None:
        self.grid, self.responses, self.count = grid, responses, count
        inside = np.repeat(np.arange(count), WITHIN)
        self.weights = np.ones(1)
        self.above = (inside[None, :] >= np.arange(count)[:, None]).astype(float)  # (S, K)
        self.set_shapes(np.ones(count), np.ones(count))

    def set_shapes(self, start: Array, rate: Array) -> None:
        """Take the slopes inside the intervals from these numbers of the intervals."""
        phi, psi = (self.grid.shape(np.cumsum(numbers[::-1])[::-1]) for numbers in (start, rate))
        parts = [
            np.einsum("rk,jk,sk->rsj", response, shape, self.above)
            for response, shape in ((self.responses.of_start, phi), (self.responses.of_source, psi))
        ]
        matrix = np.concatenate(parts, axis=2)
        self.matrix = matrix.reshape(-1, 2 * self.count)
        self.constant = (self.responses.of_fresh @ self.above.T).ravel()

    def fit(self, counts: Array) -> _Fit:
        """The start and the ingress, none below 0, whose counts are nearest in the logarithm."""
        seen = counts.ravel()
        scale = np.max(self.matrix / seen[:, None], axis=0)
        scale = np.where(scale > 0, scale, 1.0)
        now, solution = seen, np.zeros(2 * self.count)
        for _ in range(STEPS):
            # ln N + (N' − N)/N = ln N_seen
            wanted = 1 + np.log(seen / now) - self.constant / now
            weighed = self.matrix / scale / now[:, None] * self.weights[:, None]
            before, solution = solution, nnls(weighed, wanted * self.weights)[0]
            now = np.maximum(self.matrix / scale @ solution + self.constant, 1e-6 * seen)
            if np.allclose(solution, before, rtol=1e-9, atol=1e-12):
                break
        solution = solution / scale
        shape = counts.shape
        return _Fit(solution[: self.count], solution[self.count :], now.reshape(shape))


# ------------------------------------------------------------------------------ reports
def _counts_of(
    reports: Sequence[str] | ArrayLike, sizes: ArrayLike | None
) -> tuple[Array, Array, bool]:
    """Sizes [m] and counts [1/m³] of reports, and whether they are codes."""
    report_list = list(reports) if not isinstance(reports, str) else [reports]  # type: ignore[arg-type]
    if report_list and all(isinstance(report, str) for report in report_list):
        numbers = [read_iso4406(str(report)) for report in report_list]
        used = [i for i in range(3) if all(row[i] is not None for row in numbers)]
        middle = [
            [math.sqrt(max(low, high / WIDTH) * high) for low, high in
             (iso4406_range(row[i] or 0) for i in used)]
            for row in numbers
        ]  # fmt: skip
        return np.array(counted_sizes())[used], np.array(middle), True
    counts = np.asarray(report_list, float)
    at = np.array(counted_sizes() if sizes is None else sizes, float)
    if counts.ndim != 2 or counts.shape[1] != len(at) or not len(at):
        rule = f"must be codes, or {len(at)} counts each [1/m³], one from each size"
        raise InvalidValue(Problem("reports", rule, code=Mistake.SHAPE))
    if not np.all((counts >= 0) & np.isfinite(counts)):
        raise InvalidValue(
            Problem("reports", "must hold counts of 0 or more [1/m³]", code=Mistake.RANGE)
        )
    if np.any(np.diff(counts, axis=1) > 0):
        rule = "must fall with the size: larger particles are among the smaller"
        raise InvalidValue(Problem("reports", rule, code=Mistake.ORDER))
    return at, counts, False


def _material_of(circuit: OilCircuit, material: Material | None) -> Material:
    """What the particles are of."""
    if material is None:
        material = next(iter(circuit.materials.values()), None)
    if material is None or material.density is None:
        rule = "is missing: what the particles are of, with a density [kg/m^3]"
        raise InvalidValue(Problem("material", rule, code=Mistake.MISSING))
    return material


@takes_units
def oil_reports(
    times: ArrayLike,
    *,
    reports: Sequence[str] | ArrayLike,
    circuit: OilCircuit,
    sizes: ArrayLike | None = None,
    material: Material | None = None,
    width: float = WIDTH,
    least: float = LEAST,
) -> OilReports:
    r"""Dirt that enters an oil, from two or more reports of it.

    .. math:: \chi^2 = \sum_{ij} \frac{12}{\ln^2 w}\left(\ln\frac{n_{ij}}{\hat n_{ij}}\right)^2

    Parameters
    ----------
    times : array (R,)
        Of the reports, increasing [s]; counted as the times of ``circuit.oil_changes``.
    reports : sequence of str or array (R, S)
        ISO 4406 codes, or counts from each size on, 0 where no particle was counted [1/m³].
    circuit : OilCircuit
        Its volume, filters, make-up and changes of oil; start and ingress are not used.
    sizes : array (S,), optional
        From which is counted [m]; 4, 6 and 14 µm(c) by default.
    material : Material, optional
        Of the particles, by default the first of the circuit.
    width : float, optional
        Largest over least count that a report may stand for w [1]; 2 of a code.
    least : float, optional
        Count below which a report says 0 [1/m³]; 1 per mL by default.

    Returns
    -------
    OilReports

    Raises
    ------
    InvalidValue
        Fewer than two reports, times that do not increase, counts that are none.

    Notes
    -----
    Between two sizes counts are power laws, beyond the last as for ISO 4406, up to 70 µm. The band
    holds 90 % of what is found where every count may lie anywhere in its range: each for itself, or
    all of a size alike, as in oil that no longer changes, where codes repeat and more of them say
    no more; the wider end counts. It knows nothing of a filter that is worse than its data sheet.
    Exact counts give the ingress back within 2 %, and within 7 % where a filter begins to hold at a
    size between two counted ones. The mass leaves out what is below the first size, and hangs on
    the power law beyond the last (`systems.life.report_notes`); between 4 and 14 µm that of the
    test dusts A1 to A4 comes out within 8 %. A count of 0 is taken
    as anything below ``least``, which widens the band. Two reports are always fitted: whether the
    ingress is constant, three or more say. Filters are taken as never full.

    Examples
    --------
    >>> import thirdbody as tb
    >>> quartz = tb.materials["quartz"]
    >>> circuit = tb.oil.OilCircuit(
    ...     volume=0.2, start=tb.oil.OilDirt.from_iso4406("20/18/15", material=quartz), ingress=(),
    ...     filters=tb.oil.Filter(sizes=(4e-6, 10e-6), betas=(4.0, 75.0), flow=1e-3))
    >>> found = tb.oil.oil_reports([0.0, 9e5], reports=["20/18/15", "18/16/13"], circuit=circuit)
    >>> [f"{rate:.2g}" for rate in found.rate]
    ['1.3e+06', '4.2e+05', '5.6e+04']
    """
    t = np.atleast_1d(np.asarray(times, float))
    if len(t) < 2 or not np.all(np.diff(t) > 0) or not np.all(np.isfinite(t)):
        raise InvalidValue(
            Problem(
                "times",
                "must be of two reports or more, each later than the one before [s]",
                code=Mistake.ORDER,
            )
        )
    at, counts, coded = _counts_of(reports, sizes)
    if len(counts) != len(t):
        raise InvalidValue(
            Problem("reports", f"must be one for each of {len(t)} times", code=Mistake.SHAPE)
        )
    if not (math.isfinite(width) and width > 1):
        raise InvalidValue(Problem("width", "must be above 1", repr(width), code=Mistake.RANGE))
    if not (math.isfinite(least) and least > 0):
        raise InvalidValue(Problem("least", "must be above 0", repr(least), code=Mistake.RANGE))
    of = _material_of(circuit, material)
    zeros = Zeros.of_counts(counts, least=least)
    taken = zeros.replace_zeros(counts, 0.5)
    sigma = math.log(width) / math.sqrt(12)
    grid = _Grid.from_sizes(at)
    model = _Model(grid, _responses(circuit, of, grid.classes, t), len(at))
    model.weights = np.where(zeros.here, min(sigma / OF_ZERO, 1.0), 1.0).ravel()
    fit = model.fit(taken)
    for _ in range(SHAPES):
        model.set_shapes(fit.start, fit.rate)
        fit = model.fit(taken)
    random = np.random.default_rng(0)
    alike = random.uniform(-0.5, 0.5, (DRAWS, 1, counts.shape[1]))
    apart = random.uniform(-0.5, 0.5, (DRAWS, *counts.shape))
    drawn = [
        model.fit(zeros.replace_zeros(counts * width**draw, 0.5 + draw)).rate
        for draw in (*alike, *apart)
    ]
    ends = [
        model.fit(zeros.replace_zeros(counts, share)).rate
        for share in (0.0, 1.0)
        if zeros.here.any()
    ]
    rates = np.array([np.cumsum(rate[::-1])[::-1] for rate in (fit.rate, *drawn, *ends)])
    psi = grid.shape(rates[0])
    weights = of.density * psi @ grid.classes.volumes  # type: ignore[operator]
    masses = np.array([fit.rate, *drawn, *ends]) @ weights
    away = np.where(zeros.here, zeros.excess(fit.fitted), np.log(taken / fit.fitted))
    misfit = float(np.sum((away / sigma) ** 2))
    # a 0 that the fit obeys says nothing of the fit
    degrees = max(int(np.sum(~zeros.here | (away > 0))) - 2 * len(at), 0)
    low, high = _band(rates[1:])
    mass_low, mass_high = _band(masses[1:])
    return OilReports(
        times=t,
        sizes=at,
        counts=counts,
        fitted=fit.fitted,
        rate=rates[0],
        low=low,
        high=high,
        mass_rate=float(masses[0]),
        mass_low=float(mass_low),
        mass_high=float(mass_high),
        chi2=misfit,
        degrees=degrees,
        probability=float(chdtrc(degrees, misfit)) if degrees else math.nan,
        ingress=_ingress(at, rates[0], of),
        start=_dirt(at, np.cumsum(fit.start[::-1])[::-1], of),
        coded=coded,
        width=width,
        least=least,
    )


def _band(drawn: Array) -> tuple[Array, Array]:
    """Ends of the band of draws in which all reports are off alike, and of those where each is;
    and of what comes behind them: fits in which every 0 is none, and at its limit."""
    halves = np.split(drawn[: 2 * DRAWS], 2)
    low, high = np.array([np.percentile(half, BAND, axis=0) for half in halves]).swapaxes(0, 1)
    return (
        np.min([*low, *drawn[2 * DRAWS :]], axis=0),
        np.max([*high, *drawn[2 * DRAWS :]], axis=0),
    )


def _ingress(sizes: Array, rates: Array, material: Material) -> Ingress:
    """Ingress with these rates from each size on."""
    diameter, rate = _sizes_of(sizes, rates)
    return Ingress(material=material, diameter=diameter, rate=rate)


def _dirt(sizes: Array, counts: Array, material: Material) -> OilDirt:
    """Oil with these counts from each size on."""
    diameter, number = _sizes_of(sizes, counts)
    return OilDirt(material=material, diameter=diameter, number=number)


def _sizes_of(sizes: Array, above: Array) -> tuple[Any, float]:
    """Sizes and number of particles with counts that may end before the last size."""
    filled = np.flatnonzero(above > 0)
    last = LARGEST["iso4406"]
    if not len(filled):
        return sizes_above(
            sizes, counts=np.ones(len(sizes)) / (1 + np.arange(len(sizes))), largest=last
        ), 0.0
    if len(filled) < len(sizes):
        last = float(sizes[len(filled)])
    # no count equals the one before: a slope of 0 is none
    counts = above[filled] * (1 - 1e-12 * np.arange(len(filled)))
    return sizes_above(sizes[filled], counts=counts, largest=last), float(above[0])
