"""Uncertain inputs: their distributions, and drawing them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...contact.contact import Contact
from ...errors import Clause, InvalidValue, Mistake, Problem
from ...quantities.arguments import NamesArguments, is_empty
from ...quantities.carried import takes_units
from ...quantities.record import Record
from ...quantities.uncertain import are_correlated, is_uncertain
from ...quantities.value import problem_with
from ..inputs import Input as Moved
from ..inputs import declared_quantity, input_of, inputs

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]
    Arrays = dict[str, NDArray[Any]]

__all__ = ["Uncertain", "Uncertainty", "library_ranges", "stated_ranges"]

TAIL = 1e-9
"""Probability beyond which no sample is drawn, on either side (six standard deviations)."""
KINDS = {
    "uniform": ("low", "high"),
    "log-uniform": ("low", "high"),
    "normal": ("mean", "std"),
    "lognormal": ("median", "gsd"),
}
"""Distributions of an input and what each is given by."""


# -------------------------------------------------------------------------- one input
@dataclass(frozen=True, slots=True, kw_only=True)
class Uncertain(NamesArguments, Record):
    """What is known of one input: its distribution, in SI.

    Parameters
    ----------
    kind : {"uniform", "log-uniform", "normal", "lognormal"}
    first, second : float
        Lowest and highest value; mean and standard deviation; or median and geometric standard
        deviation σ_g [1], above 1.

    Raises
    ------
    InvalidValue
        Ends in the wrong order, or a spread that is none.

    Notes
    -----
    No sample is drawn beyond a probability of 1e-9 on either side.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.Uncertain.uniform(low=80e-9, high=120e-9).quantile(0.5)
    1e-07
    >>> round(tb.Uncertain.normal(mean=7.7e9, std=0.5e9).quantile(0.975) / 1e9, 3)
    8.68
    >>> tb.Uncertain.lognormal(median=1e11, gsd=1.5).cdf(1e11)
    0.5
    """

    in_dict = ("kind", ("", "_numbers"))
    kind: str
    first: float
    second: float

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise InvalidValue(
                Problem(
                    "kind",
                    f"must be one of {', '.join(KINDS)}",
                    repr(self.kind),
                    code=Mistake.OPTION,
                )
            )
        one, two = KINDS[self.kind]
        problems = []
        for name, item in ((one, self.first), (two, self.second)):
            number = isinstance(item, (int, float, np.number)) and not isinstance(item, bool)
            if not (number and math.isfinite(item)):
                problems.append(
                    Problem(name, "must be a finite number", repr(item), code=Mistake.RANGE)
                )
        if not problems:
            for name in ("first", "second"):
                object.__setattr__(self, name, float(getattr(self, name)))
            first, second = self.first, self.second
            shown = f"{one} = {first:g}"
            if two == "high" and not first < second:
                swap = "; exchange them" if first > second else "; what is exact needs no range"
                problems.append(
                    Problem(
                        one,
                        f"must be below high = {second:g}{swap}",
                        f"{first:g}",
                        code=Mistake.ORDER,
                    )
                )
            elif self.kind == "log-uniform" and first <= 0:
                problems.append(
                    Problem(
                        one,
                        "must be > 0 for a range even in the logarithm",
                        f"{first:g}",
                        code=Mistake.RANGE,
                    )
                )
            elif two == "std" and second <= 0:
                problems.append(
                    Problem(
                        "std",
                        "must be > 0; what is exact needs no range",
                        f"{second:g}",
                        code=Mistake.RANGE,
                    )
                )
            elif two == "gsd" and not 1 < second <= 20:
                problems.append(
                    Problem(
                        "gsd",
                        "must be above 1, at most 20: a factor, 1.2 for about 20 %",
                        f"{second:g}",
                        code=Mistake.RANGE,
                    )
                )
            if two == "gsd" and first <= 0:
                problems.append(Problem("", f"{shown} must be > 0", code=Mistake.RANGE))
        if problems:
            raise InvalidValue(*problems)

    @classmethod
    @takes_units
    def uniform(cls, *, low: float, high: float) -> Uncertain:
        """Anything between two ends, equally likely."""
        return cls(kind="uniform", first=low, second=high)

    @classmethod
    @takes_units
    def log_uniform(cls, *, low: float, high: float) -> Uncertain:
        """Anything between two ends, equally likely in the logarithm."""
        return cls(kind="log-uniform", first=low, second=high)

    @classmethod
    @takes_units
    def normal(cls, *, mean: float, std: float) -> Uncertain:
        """A measured value and its standard uncertainty."""
        return cls(kind="normal", first=mean, second=std)

    @classmethod
    @takes_units
    def lognormal(cls, *, median: float, gsd: float) -> Uncertain:
        """A value known to a factor: two in three between median/gsd and median·gsd."""
        return cls(kind="lognormal", first=median, second=gsd)

    @classmethod
    @takes_units
    def from_ufloat(cls, number: Any) -> Uncertain:
        """A number of the package `uncertainties`: normal, about its nominal value.

        Parameters
        ----------
        number : uncertainties.UFloat
            What is known of the input, in SI.

        Returns
        -------
        Uncertain

        Raises
        ------
        InvalidValue
            It is no such number, or its uncertainty is 0.

        Examples
        --------
        >>> from uncertainties import ufloat
        >>> import thirdbody as tb
        >>> tb.Uncertain.from_ufloat(ufloat(100e-9, 5e-9))
        Uncertain(kind='normal', first=1e-07, second=5e-09)
        """
        if not is_uncertain(number):
            raise InvalidValue(
                Problem(
                    "number",
                    "must have a nominal_value and a std_dev, as a ufloat; of a quantity with a "
                    "unit, give it in SI",
                    f"{number!r:.80}",
                    code=Mistake.KIND,
                )
            )
        return cls.normal(mean=float(number.nominal_value), std=float(number.std_dev))

    @property
    def _numbers(self) -> dict[str, float]:
        """The two numbers by their names, as a study file has them."""
        return dict(zip(KINDS[self.kind], (self.first, self.second), strict=True))

    @takes_units
    def quantile(self, u: ArrayLike) -> Any:
        """The value that is exceeded with probability 1 − u."""
        from scipy.special import ndtri

        x = np.clip(np.asarray(u, float), TAIL, 1 - TAIL)
        if self.kind == "uniform":
            out = self.first + x * (self.second - self.first)
        elif self.kind == "log-uniform":
            out = self.first * (self.second / self.first) ** x
        elif self.kind == "normal":
            out = self.first + self.second * ndtri(x)
        else:
            out = self.first * self.second ** ndtri(x)
        return out if np.ndim(u) else float(out)

    @takes_units
    def cdf(self, value: float) -> float:
        """Probability that the input is at most ``value``."""
        from scipy.special import ndtr

        if self.kind in ("log-uniform", "lognormal") and value <= 0:
            return 0.0
        if self.kind == "uniform":
            u = (value - self.first) / (self.second - self.first)
        elif self.kind == "log-uniform":
            u = math.log(value / self.first) / math.log(self.second / self.first)
        elif self.kind == "normal":
            u = ndtr((value - self.first) / self.second)
        else:
            u = ndtr(math.log(value / self.first) / math.log(self.second))
        return float(min(max(u, 0.0), 1.0))


@dataclass(frozen=True, kw_only=True)
class Uncertainty:
    """What the table [uncertainty] of a study file says.

    Parameters
    ----------
    inputs : dict
        Dotted names, several joined by "+", and what is known of each.
    samples, seed : int
        As in `propagate`; no number of samples leaves it to what is done with them.
    """

    inputs: dict[str, Uncertain]
    samples: int | None = None
    seed: int = 0


def stated_ranges(contact: Contact) -> dict[str, Uncertain]:
    """Ranges that nobody gave: of the materials library, and of a finishing process.

    Bandwidths α of a process go as far as the law of the asperities knows them.
    """
    limits = {"alpha": contact.asperity_law.bandwidths}
    out = library_ranges(contact)
    for name, ends in contact.roughness.ranges.items():
        least, most = limits.get(name, ends)
        low, high = max(ends[0], least), min(ends[1], most)
        out[f"roughness.{name}"] = Uncertain.log_uniform(low=low, high=high)
    return out


def library_ranges(contact: Contact) -> dict[str, Uncertain]:
    """Ranges that the materials library states for the bodies of a contact, as uniform."""
    from ...populations.materials import materials

    entries = materials.entries()
    numbers = inputs(contact)
    bodies = {"surfaces.first": contact.surfaces.first, "surfaces.second": contact.surfaces.second}
    particles = contact.particles
    if isinstance(particles, tuple):
        bodies |= {
            f"particles.{i}.material": population.material for i, population in enumerate(particles)
        }
    elif particles is not None:
        bodies["particles.material"] = particles.material
    alike = contact.surfaces.alike
    out = {}
    for name, body in bodies.items():
        for key, (low, high) in entries.get(body.name, {}).get("range", {}).items():
            if not low < high or f"{name}.{key}" not in numbers:
                continue
            if key == "K_c":  # of the size below which nothing breaks: vary x_c or B for that
                continue
            label = f"{name}.{key}"
            if alike and name.startswith("surfaces"):
                label = f"surfaces.first.{key}+surfaces.second.{key}"
            if getattr(body, key) == entries[body.name][key]:
                out[label] = Uncertain.uniform(low=low, high=high)
    return out


def as_uncertain(value: Any) -> Uncertain:
    """Distribution of an input from a distribution, two ends, or a ufloat."""
    if isinstance(value, Uncertain):
        return value
    return Uncertain.from_ufloat(value) if is_uncertain(value) else _uniform_between(*value)


def _uniform_between(low: float, high: float) -> Uncertain:
    return Uncertain.uniform(low=low, high=high)


def _correlated_inputs(inputs: Mapping[str, object], where: str) -> list[str]:
    """Ufloats that rest on the same measurement, which no two inputs here may."""
    uncertain = [(label, value) for label, value in inputs.items() if is_uncertain(value)]
    return [
        Problem(
            where.format(one),
            f"and {where.format(other)} are correlated, and inputs are independent here",
            hint="join what is one thing by +, or take sensitivity(...).ufloats(...)",
            code=Mistake.CLASH,
        )
        for (one, first), (other, second) in combinations(uncertain, 2)
        if are_correlated(first, second)
    ]


class Drawn(NamedTuple):
    """Uncertain inputs of a contact: what moves, and how it is distributed."""

    moved: tuple[Moved | str, ...]
    distributions: tuple[Uncertain, ...]

    def moved_numbers(self, values: Sequence[object]) -> Arrays:
        """Every number of the contact that moves, from the values of the inputs."""
        out: Arrays = {}
        for moved, value in zip(self.moved, values, strict=True):
            if isinstance(moved, str):
                out[moved] = np.asarray(value)
            else:
                out |= moved.numbers_at((np.asarray(value) - moved.values[0]) / moved.scales[0])
        return out

    def points(self, u: Array) -> Arrays:
        """Numbers of the contact at points of the unit cube (N, k)."""
        return self.moved_numbers(
            [distribution.quantile(u[:, j]) for j, distribution in enumerate(self.distributions)]
        )

    @property
    def nominal(self) -> list[float]:
        """The values that the contact has; NaN for the load."""
        return [math.nan if isinstance(m, str) else m.values[0] for m in self.moved]


def drawn_inputs(
    contact: Contact,
    inputs: Mapping[str, object],
    load: str,
    loads: ArrayLike,
    where: str = "vary[{!r}]",
) -> Drawn:
    """The uncertain inputs; mistakes say ``where`` they stand."""
    moved: list[Moved | str] = []
    distributions: list[Uncertain] = []
    taken: dict[str, str] = {}
    problems = _correlated_inputs(inputs, where)
    if not inputs:
        problems.append(
            is_empty("vary", 'say what is uncertain, e.g. {"roughness.sigma": (80e-9, 120e-9)}')
        )
    for label, value in inputs.items():
        place = where.format(label)
        try:
            moved_input: Moved | str = label
            if label not in ("pressure", "F_star", "d"):
                moved_input = input_of(contact, label, where)
            elif label != load:
                rule = f": the given load is {load}; only that can be uncertain"
                problems.append(Problem(place, rule, code=Mistake.CLASH))
                continue
            elif np.ndim(loads):
                rule = ": give one load where the load is uncertain"
                problems.append(Problem(place, rule, code=Mistake.SHAPE))
                continue
        except InvalidValue as error:
            problems += [
                why if why.place and not why.owner else Problem(place, f": {why}", code=why.code)
                for why in error.problems
            ]
            continue
        try:
            one = as_uncertain(value)
        except InvalidValue as error:
            problems += [Problem(place, f": {why}", code=why.code) for why in error.problems]
            continue
        except TypeError:
            rule = (
                "must be (low, high), or one of Uncertain.uniform, log_uniform, normal, lognormal; "
                "or a ufloat"
            )
            problems.append(Problem(place, rule, repr(value), code=Mistake.KIND))
            continue
        names = (moved_input,) if isinstance(moved_input, str) else moved_input.names
        for name in names:
            if name in taken:
                rule = f"and {where.format(taken[name])} both move {name}"
                problems.append(Problem(place, rule, code=Mistake.CLASH))
            taken[name] = label
        problems += [
            Problem(place, f": {text}", code=text.code)
            for text in _range_problems(contact, moved_input, one)
        ]
        moved.append(moved_input)
        distributions.append(one)
    if problems:
        raise InvalidValue(*problems)
    return Drawn(tuple(moved), tuple(distributions))


def _range_problems(contact: Contact, moved: Moved | str, distribution: Uncertain) -> list[Clause]:
    """Why the ends of a distribution cannot stand for the input."""
    for end in (distribution.quantile(0.0), distribution.quantile(1.0)):
        if isinstance(moved, str):
            low = moved != "d" and end <= 0
            why = Mistake.RANGE.clause("must be > 0") if low else None
        else:
            values = moved.numbers_at((end - moved.values[0]) / moved.scales[0])
            problems = (
                problem_with(declared_quantity(contact, n), float(v)) for n, v in values.items()
            )
            why = next(filter(None, problems), None)
        if why:
            cause = "; a lognormal stays positive" if distribution.kind == "normal" else ""
            far = (
                ", six standard deviations from the mean," if distribution.kind == "normal" else ""
            )
            return [why.code.clause(f"the value {end:.4g}{far} {why}{cause}")]
    return []
