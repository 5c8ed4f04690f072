r"""Uncertain inputs: bands on every result and on the critical loads, by quasi-Monte Carlo.

Inputs are independent, each with a distribution; scrambled Sobol points u in the unit cube become
inputs by their inverse distribution functions,

.. math:: p_i = F_i^{-1}(u_i), \qquad
          q_\alpha(c) \approx \text{the } \alpha\text{-quantile of } c(p^{(1)}), \dots, c(p^{(N)})

The points are eight scramblings of one sequence, each of which answers alone: by how much the
eight differ is the error of what they say together.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .citations import cite
from .contact import Contact, interface
from .designs import sobol
from .equilibrium import COLUMNS, DEEPEST, EPS_1, EPS_2, about, given_load
from .errors import InvalidValue
from .sensitivities import NUMBERS, declared, input_of, inputs
from .sensitivities import Input as Moved
from .states import FEWEST, carries, solve_states
from .values import problem_with

if TYPE_CHECKING:
    import xarray
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]
    Arrays = dict[str, NDArray[Any]]

__all__ = [
    "CRITICAL",
    "OUTPUTS",
    "Propagation",
    "Uncertain",
    "Uncertainty",
    "critical_loads",
    "library_ranges",
    "propagate",
]

REPLICATES = 8
"""Scramblings of the sequence."""
LEAST, MOST_CRITICAL = 64, 2_048
"""Fewest samples, and samples for which critical loads are sought unless more are asked for."""
TAIL = 1e-9
"""Probability beyond which no sample is drawn, on either side (six standard deviations)."""
PROBABILITIES = (0.05, 0.25, 0.5, 0.75, 0.95)
CRITICAL = ("F_cr1", "F_cr2", "F_tpca.A", "F_tpca.B")
MARGINS = {"F/F_cr1": "F_cr1", "F/F_cr2": "F_cr2"}
MODES = ("p-s", "hybrid", "s-s", "none")
WINDOW = (1e-8, 1e-2)
"""Loads F* between which critical loads are sought, as in `transitions`."""
NODES, AT_ONCE = 25, 8_192
"""Separations at which shares are known before crossings are refined, and samples at a time."""
EXACT = 1e-7
"""Tolerance of a crossing, over the range of separations; 3e-6 of the load."""
EXACT_PEAK = 1e-4
OUTPUTS: dict[str, dict[str, str]] = {
    **{name: COLUMNS[name] for name in NUMBERS},
    "plastic_share": {"symbol": "A_p/A_t", "unit": "1", "meaning": "plastic part of the real area"},
    "F_cr1": {"symbol": "F_cr1*", "unit": "1", "meaning": "critical load, p-s to hybrid"},
    "F_cr2": {"symbol": "F_cr2*", "unit": "1", "meaning": "critical load, hybrid to s-s"},
    "F_tpca.A": {"symbol": "F_tpca,A*", "unit": "1", "meaning": "load of the largest area share"},
    "F_tpca.B": {"symbol": "F_tpca,B*", "unit": "1", "meaning": "load of equal load shares"},
    "F/F_cr1": {"symbol": "F/F_cr1", "unit": "1", "meaning": "load over the first critical load"},
    "F/F_cr2": {"symbol": "F/F_cr2", "unit": "1", "meaning": "load over the second critical load"},
}
"""Symbol, unit and meaning of everything that gets a band, beside the outputs of the contact."""
MOST_OUTPUTS = 512
"""Samples of outputs: each is a contact of its own, with spots of its own."""
KINDS = {
    "uniform": ("low", "high"),
    "log-uniform": ("low", "high"),
    "normal": ("mean", "std"),
    "lognormal": ("median", "gsd"),
}
"""Distributions of an input and what each is given by."""


# -------------------------------------------------------------------------- one input
@dataclass(frozen=True, slots=True)
class Uncertain:
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
    >>> Uncertain.uniform(80e-9, 120e-9).at(0.5)
    1e-07
    >>> round(Uncertain.normal(7.7e9, 0.5e9).at(0.975) / 1e9, 3)
    8.68
    >>> Uncertain.lognormal(1e11, 1.5).cdf(1e11)
    0.5
    """

    kind: str
    first: float
    second: float

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise InvalidValue(f"kind = {self.kind!r} must be one of {', '.join(KINDS)}")
        one, two = KINDS[self.kind]
        problems = []
        for name, item in ((one, self.first), (two, self.second)):
            number = isinstance(item, (int, float, np.number)) and not isinstance(item, bool)
            if not (number and math.isfinite(item)):
                problems.append(f"{name} = {item!r} must be a finite number")
        if not problems:
            for name in ("first", "second"):
                object.__setattr__(self, name, float(getattr(self, name)))
            first, second = self.first, self.second
            shown = f"{one} = {first:g}"
            if two == "high" and not first < second:
                swap = "; exchange them" if first > second else "; what is exact needs no range"
                problems.append(f"{shown} must be below high = {second:g}{swap}")
            elif self.kind == "log-uniform" and first <= 0:
                problems.append(f"{shown} must be > 0 for a range even in the logarithm")
            elif two == "std" and second <= 0:
                problems.append(f"std = {second:g} must be > 0; what is exact needs no range")
            elif two == "gsd" and not 1 < second <= 20:
                problems.append(
                    f"gsd = {second:g} must be above 1, at most 20: a factor, 1.2 for about 20 %"
                )
            if two == "gsd" and first <= 0:
                problems.append(f"{shown} must be > 0")
        if problems:
            raise InvalidValue(*problems)

    @classmethod
    def uniform(cls, low: float, high: float) -> Uncertain:
        """Anything between two ends, equally likely."""
        return cls("uniform", low, high)

    @classmethod
    def log_uniform(cls, low: float, high: float) -> Uncertain:
        """Anything between two ends, equally likely in the logarithm."""
        return cls("log-uniform", low, high)

    @classmethod
    def normal(cls, mean: float, std: float) -> Uncertain:
        """A measured value and its standard uncertainty."""
        return cls("normal", mean, std)

    @classmethod
    def lognormal(cls, median: float, gsd: float) -> Uncertain:
        """A value known to a factor: two in three between median/gsd and median·gsd."""
        return cls("lognormal", median, gsd)

    def at(self, u: ArrayLike) -> Any:
        """The value that is exceeded with probability 1 − u."""
        from scipy.special import ndtri

        x: Any = np.clip(np.asarray(u, float), TAIL, 1 - TAIL)
        if self.kind == "uniform":
            out = self.first + x * (self.second - self.first)
        elif self.kind == "log-uniform":
            out = self.first * (self.second / self.first) ** x
        elif self.kind == "normal":
            out = self.first + self.second * ndtri(x)
        else:
            out = self.first * self.second ** ndtri(x)
        return out if np.ndim(u) else float(out)

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

    def to_dict(self) -> dict[str, Any]:
        """Kind and numbers, as a study file has them."""
        names = KINDS[self.kind]
        return {"kind": self.kind} | dict(zip(names, (self.first, self.second), strict=True))


@dataclass(frozen=True, kw_only=True)
class Uncertainty:
    """What the table [uncertainty] of a study file says.

    Parameters
    ----------
    inputs : dict
        Dotted names, several joined by "+", and what is known of each.
    samples, seed : int
        As in `propagate`.
    """

    inputs: dict[str, Uncertain]
    samples: int = 2**14
    seed: int = 0


def library_ranges(contact: Contact) -> dict[str, Uncertain]:
    """Ranges that the materials library states for the bodies of a contact, as uniform."""
    from .materials import materials

    entries = materials.entries()
    known = inputs(contact)
    bodies = {"surfaces.first": contact.surfaces.first, "surfaces.second": contact.surfaces.second}
    if (one := getattr(contact.particles, "material", None)) is not None:
        bodies["particles.material"] = one
    alike = contact.surfaces.first == contact.surfaces.second
    out = {}
    for name, body in bodies.items():
        for key, (low, high) in entries.get(body.name, {}).get("range", {}).items():
            if not low < high or f"{name}.{key}" not in known:
                continue
            label = f"{name}.{key}"
            if alike and name.startswith("surfaces"):
                label = f"surfaces.first.{key}+surfaces.second.{key}"
            if getattr(body, key) == entries[body.name][key]:
                out[label] = Uncertain.uniform(low, high)
    return out


class Drawn(NamedTuple):
    """Uncertain inputs of a contact: what moves, and how it is distributed."""

    moved: tuple[Moved | str, ...]
    known: tuple[Uncertain, ...]

    def at(self, values: Sequence[Any]) -> Arrays:
        """Every number of the contact that moves, from the values of the inputs."""
        out: Arrays = {}
        for moved, value in zip(self.moved, values, strict=True):
            if isinstance(moved, str):
                out[moved] = np.asarray(value)
            else:
                out |= moved.at((np.asarray(value) - moved.values[0]) / moved.scales[0])
        return out

    def points(self, u: Array) -> Arrays:
        """Numbers of the contact at points of the unit cube (N, k)."""
        return self.at([known.at(u[:, j]) for j, known in enumerate(self.known)])

    @property
    def nominal(self) -> list[Any]:
        """The values that the contact has; NaN for the load."""
        return [math.nan if isinstance(m, str) else m.values[0] for m in self.moved]


def drawn_inputs(contact: Contact, inputs: Mapping[str, Any], load: str, loads: ArrayLike) -> Drawn:
    """The uncertain inputs, every mistake in them told."""
    moved: list[Moved | str] = []
    known: list[Uncertain] = []
    taken: dict[str, str] = {}
    problems: list[str] = []
    if not inputs:
        problems.append(
            'inputs is empty; say what is uncertain, e.g. {"roughness.sigma": (80e-9, 120e-9)}'
        )
    for label, given in inputs.items():
        where = f"inputs[{label!r}]"
        try:
            each: Moved | str = label
            if label not in ("pressure", "F_star", "d"):
                each = input_of(contact, label)
            elif label != load:
                problems.append(f"{where}: the given load is {load}; only that can be uncertain")
                continue
            elif np.ndim(loads):
                problems.append(f"{where}: give one load where the load is uncertain")
                continue
            one = given if isinstance(given, Uncertain) else Uncertain("uniform", *given)
        except InvalidValue as error:
            problems += [f"{where}: {text.removeprefix('to = ')}" for text in error.problems]
            continue
        except TypeError:
            problems.append(
                f"{where} = {given!r} must be (low, high), or one of Uncertain.uniform, "
                "log_uniform, normal, lognormal"
            )
            continue
        names = (each,) if isinstance(each, str) else each.names
        for name in names:
            if name in taken:
                problems.append(f"{where} and inputs[{taken[name]!r}] both move {name}")
            taken[name] = label
        problems += [f"{where}: {text}" for text in _beyond(contact, each, one)]
        moved.append(each)
        known.append(one)
    if problems:
        raise InvalidValue(*problems)
    return Drawn(tuple(moved), tuple(known))


def _beyond(contact: Contact, moved: Moved | str, known: Uncertain) -> list[str]:
    """Why the ends of a distribution cannot stand for the input."""
    for end in (known.at(0.0), known.at(1.0)):
        if isinstance(moved, str):
            why = None if moved == "d" or end > 0 else "must be > 0"
        else:
            values = moved.at((end - moved.values[0]) / moved.scales[0])
            found = (problem_with(declared(contact, n), float(v)) for n, v in values.items())
            why = next(filter(None, found), None)
        if why:
            cause = "; a lognormal stays positive" if known.kind == "normal" else ""
            far = ", six standard deviations from the mean," if known.kind == "normal" else ""
            return [f"the value {end:.4g}{far} {why}{cause}"]
    return []


# -------------------------------------------------------------------------- critical loads
def critical_loads(
    contact: Contact, vary: Mapping[str, ArrayLike], count: int
) -> dict[str, tuple[Array, NDArray[np.str_]]]:
    r"""Critical loads of many contacts at once, as `transitions` defines them.

    .. math:: \ln\frac{A_{sa}}{A_{ss}}(d) = \ln\frac{1-\epsilon_1}{\epsilon_1}
              \ \text{at}\ F_{cr1}, \qquad \ln\frac{\epsilon_2}{1-\epsilon_2}\ \text{at}\ F_{cr2}

    Parameters
    ----------
    contact : Contact
        The inputs that do not vary.
    vary : mapping
        Dotted names of inputs and their values (N,), as in `solve_states`.
    count : int
        N.

    Returns
    -------
    dict
        For "F_cr1", "F_cr2", "F_tpca.A" and "F_tpca.B" the loads F* (N,) and their statuses
        (N,), the words of `transitions`. A load below the window of 1e-8 to 1e-2 is 0, one above
        it ∞, one that does not exist NaN.

    Raises
    ------
    InvalidValue
        No particles, or a law whose load does not fall with the separation.

    Notes
    -----
    Shares at 25 separations from F* = 1e-8 to 1e-2; crossings of a cubic spline through them,
    corrected by Newton's method and, where that does not do, by Chandrupatla's, on all contacts
    together. Relative error 1e-5 (F_tpca.A: 1e-3) against `transitions`. F_tpca.C, which
    `transitions` takes from a grid of loads, has no distribution worth the name and is left out.

    References
    ----------
    Chandrupatla 1997, Adv. Eng. Softw. 28, 145, doi:10.1016/S0965-9978(96)00051-8.

    Examples
    --------
    >>> import numpy as np
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9)))
    >>> vary = {"roughness.sigma": np.linspace(90e-9, 110e-9, 21)}
    >>> loads, status = critical_loads(contact, vary, 21)["F_cr1"]
    >>> bool(np.all(np.diff(loads) < 0)), str(status[0])
    (True, 'found')
    """
    contact, vary = _bare(contact, vary)
    if contact.two_body:
        raise InvalidValue("a contact without particles has no critical loads")
    if not _falls(contact):
        raise InvalidValue(
            "critical loads of many contacts need a load that falls with the separation, which "
            f"{type(contact.particle_law).__name__} does not promise; name other outputs, or call "
            "transitions for each"
        )
    arrays = {name: np.broadcast_to(np.asarray(v, float), count) for name, v in vary.items()}
    parts = [
        _critical_loads(contact, {n: v[start : start + AT_ONCE] for n, v in arrays.items()}, size)
        for start in range(0, count, AT_ONCE)
        for size in [min(AT_ONCE, count - start)]
    ]
    return {
        name: (
            np.concatenate([part[name][0] for part in parts]),
            np.concatenate([part[name][1] for part in parts]),
        )
        for name in CRITICAL
    }


def _falls(contact: Contact) -> bool:
    """Whether the load falls with the separation, here and as far as the law of particles tells."""
    bound = interface(contact)
    return bound.monotone and (bound.particles is None or bound.particles.monotone)


class Shares:
    """Shares of many contacts, each between a highest (t = 0) and a lowest separation (t = 1)."""

    def __init__(self, contact: Contact, vary: Arrays, count: int):
        self.contact, self.vary, self.count = contact, vary, count
        first, last = (self._solve(F_star=np.full(count, F)) for F in WINDOW)
        own = {name: values for name, values in vary.items() if name.startswith("roughness.")}
        rough = contact.with_arrays(own).roughness if own else contact.roughness
        # a load that no contact carries is replaced by the deepest one that the model knows
        deepest = rough.y_s - (first["h"] - first["d"]) + DEEPEST * rough.sigma_s
        self.top = np.asarray(first["d"], float)
        self.bottom = np.where(np.isnan(last["d"]), deepest, last["d"])

    def _solve(self, **given: Any) -> Arrays:
        return solve_states(self.contact, **given, vary=self.vary or None)

    def at(self, t: Array, which: NDArray[np.intp]) -> tuple[Array, Array, Array]:
        """ln A_sa/A_ss, ln F_sa/F_ss and F* of contacts ``which`` (M,) at t (M,)."""
        count = len(t)
        if count < FEWEST:  # the compiled engine takes no fewer
            others = np.setdiff1d(np.arange(self.count), which)[: FEWEST - count]
            t, which = np.append(t, np.full(len(others), 0.5)), np.append(which, others)
        d = self.top[which] + t * (self.bottom[which] - self.top[which])
        vary = {name: values[which] for name, values in self.vary.items()}
        states = solve_states(self.contact, d=d, vary=vary or None)
        return (
            _log_ratio(states["A_sa"], states["A_ss"])[:count],
            _log_ratio(states["F_sa_star"], states["F_ss_star"])[:count],
            states["F_star"][:count],
        )

    def load(self, t: Array, which: NDArray[np.intp]) -> Array:
        return self.at(t, which)[2]


def _log_ratio(one: Array, other: Array) -> Array:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.clip(np.log(one) - np.log(other), -1500.0, 1500.0)


def _critical_loads(
    contact: Contact, vary: Arrays, count: int
) -> dict[str, tuple[Array, NDArray[np.str_]]]:
    shares = Shares(contact, vary, count)
    every = np.arange(count)
    t = np.linspace(0.0, 1.0, NODES)
    grid = shares.at(np.tile(t, count), np.repeat(every, NODES))
    area, load = (values.reshape(count, NODES) for values in grid[:2])
    lost = np.isnan(shares.top)

    def found(
        rows: NDArray[np.bool_], cell: NDArray[np.intp], column: int, level: float
    ) -> tuple[Array, NDArray[np.intp]]:
        """F* at which a share has its level between nodes ``cell`` and the next."""
        which = np.flatnonzero(rows & ~lost)
        if not len(which):
            return np.empty(0), which
        return _crossing(shares, t, (area, load)[column], which, cell[which], column, level), which

    def entry(
        cases: Sequence[tuple[NDArray[np.bool_], str, float]], loads: tuple[Array, Any]
    ) -> tuple[Array, NDArray[np.str_]]:
        value, status = np.full(count, np.nan), np.full(count, "found", dtype="<U12")
        value[loads[1]] = loads[0]
        for rows, word, number in (*cases, (lost, "none", np.nan)):
            value[rows], status[rows] = number, word
        return value, status

    out = {}
    level = math.log((1 - EPS_1) / EPS_1)
    below = area < level
    never, always = below[:, 0], np.all(~below, axis=1)
    cell = np.maximum(np.argmax(below, 1) - 1, 0)
    out["F_cr1"] = entry(
        [(never, "never p-s", 0.0), (always, "always p-s", np.inf)],
        found(~never & ~always, cell, 0, level),
    )
    level = math.log(EPS_2 / (1 - EPS_2))
    above = area >= level
    last = NODES - 1 - np.argmax(above[:, ::-1], 1)
    none, end = np.all(~above, axis=1), above[:, -1]
    out["F_cr2"] = entry(
        [(none, "always s-s", 0.0), (end, "never s-s", np.inf)],
        found(~none & ~end, last, 0, level),
    )
    out["F_tpca.A"] = _peak(shares, area, t, lost, entry)
    above = load >= 0
    changes = above[:, 1:] != above[:, :-1]
    last = NODES - 2 - np.argmax(changes[:, ::-1], 1)
    none = np.all(~changes, axis=1)
    out["F_tpca.B"] = entry([(none, "none", np.nan)], found(~none, last, 1, 0.0))
    return out


def _crossing(
    shares: Shares,
    t: Array,
    grid: Array,
    which: NDArray[np.intp],
    cell: NDArray[np.intp],
    column: int,
    level: float,
) -> Array:
    """F* of contacts ``which`` at which a share, known on a grid, has its level in a cell."""
    from scipy.interpolate import CubicSpline
    from scipy.optimize import elementwise

    low, high = t[cell], t[np.minimum(cell + 1, NODES - 1)]
    spline = CubicSpline(t, grid[which], axis=1).c[:, cell, np.arange(len(which))]
    coefficients = spline - np.array([0.0, 0.0, 0.0, level])[:, None]
    start = elementwise.find_root(
        lambda x, a, b, c, d: ((a * x + b) * x + c) * x + d,
        (np.zeros(len(which)), high - low),
        args=tuple(coefficients),
    ).x
    start = np.where(np.isfinite(start), start, 0.5 * (high - low))
    a, b, c, _ = coefficients
    slope = (3 * a * start + 2 * b) * start + c
    miss = shares.at(low + start, which)[column] - level
    with np.errstate(divide="ignore", invalid="ignore"):
        x = np.clip(low + start - miss / slope, low, high)
    x = np.where(np.isfinite(x), x, low + start)
    at = shares.at(x, which)
    F = at[2]
    rest = np.flatnonzero(~(np.abs(at[column] - level) <= EXACT * np.abs(slope)))
    if len(rest):
        answer = elementwise.find_root(
            lambda x, i: shares.at(x, i.astype(np.intp))[column] - level,
            (low[rest], high[rest]),
            args=(which[rest].astype(float),),
            tolerances={"xatol": EXACT},
        )
        root = np.where(answer.success, answer.x, x[rest])
        F[rest] = shares.load(root, which[rest])
    return F


def _peak(
    shares: Shares, area: Array, t: Array, lost: NDArray[np.bool_], entry: Any
) -> tuple[Array, NDArray[np.str_]]:
    """The load of the largest area share, where the share falls on both sides."""
    from scipy.optimize import elementwise
    from scipy.special import expit

    top = np.argmax(area, axis=1)
    size, rows = expit(area), np.arange(len(area))
    ends = np.maximum(size[:, 0], size[:, -1])
    good = (top > 0) & (top < NODES - 1) & (ends <= 0.9 * size[rows, top])
    good &= (size[rows, top] >= 1e-6) & ~lost
    which = np.flatnonzero(good)
    answer = elementwise.find_minimum(
        lambda x, i: -shares.at(x, i.astype(np.intp))[0],
        tuple(t[top[which] + side] for side in (-1, 0, 1)),
        args=(which.astype(float),),
        tolerances={"xatol": EXACT_PEAK},
    )
    return entry([(~good, "none", np.nan)], (shares.load(answer.x, which), which))


# -------------------------------------------------------------------------- result
@dataclass(frozen=True, kw_only=True)
class Propagation:
    """Bands on the results of a contact with uncertain inputs: floats, or arrays over loads.

    Attributes
    ----------
    contact : Contact
    inputs : dict
        What was uncertain, and how.
    load, loads : str, float or array (L,)
        Which load was given, and its values.
    samples, critical_samples, seed : int
        Samples of states, and of critical loads.
    probabilities : tuple of float
        Of the quantiles (Q,).
    nominal : dict
        Every output with the contact's own inputs.
    bands, error : dict
        Quantiles of every output, (Q,) or (L, Q), and the standard error of each.
    mode_probability, mode_error : dict
        Probability of "p-s", "hybrid", "s-s" and "none", and its standard error.
    critical_status : dict of dict
        Share of the samples with each status of every critical load.
    solved : float or array (L,)
        Share of samples with an equilibrium; the others count for no band.
    """

    contact: Contact = field(repr=False)
    inputs: dict[str, Uncertain]
    load: str
    loads: Any
    samples: int
    critical_samples: int
    seed: int
    probabilities: tuple[float, ...]
    nominal: dict[str, Any]
    bands: dict[str, Any]
    error: dict[str, Any]
    mode_probability: dict[str, Any]
    mode_error: dict[str, Any]
    critical_status: dict[str, dict[str, float]]
    solved: Any

    def to_dict(self) -> dict[str, Any]:
        """Everything but the contact, ready for JSON: None for what is not a finite number."""
        out = {item.name: getattr(self, item.name) for item in dataclasses.fields(self)}
        del out["contact"]
        out["inputs"] = {name: known.to_dict() for name, known in self.inputs.items()}
        return plain(out)

    def to_dataset(self) -> xarray.Dataset:
        """Bands and errors as labelled data, with units, version and citations."""
        import json

        import xarray

        from . import __version__

        one = np.ndim(self.loads) == 0
        dims = () if one else (self.load,)
        data: dict[str, Any] = {}
        for name, band in self.bands.items():
            if name == self.load and not one:
                continue  # a coordinate
            told = about_result(name)
            of = (*dims, "quantile") if np.ndim(band) > 1 else ("quantile",)
            words = {"units": told["unit"], "symbol": told["symbol"]}
            data[name] = (of, band, words | {"long_name": f"quantiles of the {told['meaning']}"})
            said = {"long_name": f"standard error of the quantiles of the {told['meaning']}"}
            data[f"{name}_error"] = (of, self.error[name], words | said)
        for name, table in (("probability", self.mode_probability), ("error", self.mode_error)):
            values = np.stack([np.asarray(table[mode]) for mode in MODES], axis=-1)
            said = {"units": "1", "long_name": f"{name} of each contact mode"}
            data[f"mode_{name}"] = ((*dims, "mode"), values, said)
        coordinates: dict[str, Any] = {"quantile": list(self.probabilities), "mode": list(MODES)}
        if not one:
            coordinates[self.load] = np.asarray(self.loads)
        attributes = {
            "version": __version__,
            "contact": json.dumps(self.contact.to_dict()),
            "inputs": json.dumps({name: known.to_dict() for name, known in self.inputs.items()}),
            "samples": self.samples,
            "seed": self.seed,
            "citations": cite(self.contact),
        }
        return xarray.Dataset(data, coords=coordinates, attrs=attributes)

    # ------------------------------------------------------------------ one input at a time
    def tornado(
        self,
        of: str | Sequence[str],
        *,
        at: int = 0,
        probabilities: tuple[float, float] = (0.05, 0.95),
    ) -> dict[str, dict[str, tuple[float, float]]]:
        """Outputs with one input at each end of its range, the others as the contact has them.

        Parameters
        ----------
        of : str or list of str
            Which outputs.
        at : int, optional
            Number of the load, where several were given.
        probabilities : (float, float), optional
            Where the range of an input ends.

        Returns
        -------
        dict of dict
            ``tornado[of][input]``: the output at the low and at the high end of the input; the
            strongest input of the first output comes first.
        """
        names = _outputs([of] if isinstance(of, str) else of, self.contact)
        problem = self._problem()
        rows: list[list[float]] = []
        for j, known in enumerate(problem.known):
            for probability in probabilities:
                row = list(problem.nominal)
                row[j] = known.at(probability)
                rows.append(row)
        values = np.array(rows)
        load = float(np.atleast_1d(self.loads)[at])
        values[np.isnan(values)] = load
        # the compiled engine takes no fewer states
        spare = problem.points(_points(FEWEST, len(self.inputs), 0, 0))
        vary = {
            name: np.append(column, spare[name])
            for name, column in problem.at(list(values.T)).items()
        }
        solved = _evaluated(self.contact, self.load, load, vary, len(values) + FEWEST, names)
        out = {
            name: {
                label: (float(solved[name][2 * j]), float(solved[name][2 * j + 1]))
                for j, label in enumerate(self.inputs)
            }
            for name in names
        }
        first = out[names[0]]
        order = sorted(first, key=lambda label: -swing(*first[label]))
        return {name: {label: table[label] for label in order} for name, table in out.items()}

    def sobol_indices(
        self, of: str | Sequence[str], *, at: int = 0, samples: int = 1024
    ) -> dict[str, dict[str, dict[str, float]]]:
        r"""What part of the variance of an output each input has: which measurement to improve.

        .. math:: S_i = \frac{\operatorname{Var}\,\mathrm E[c|p_i]}{\operatorname{Var}\,c}, \qquad
                  S_{Ti} = 1 - \frac{\operatorname{Var}\,\mathrm E[c|p_{\sim i}]}
                  {\operatorname{Var}\,c}

        Parameters
        ----------
        of : str or list of str
            Which outputs. Of critical loads and margins the logarithm is taken.
        at : int, optional
            Number of the load, where several were given.
        samples : int, optional
            Base samples N, a power of two; N (k + 2) states are solved for k inputs.

        Returns
        -------
        dict of dict of dict
            ``indices[of][input]`` with "S1", the part of the variance that goes when this input
            is known exactly, "ST", the part that stays when all others are, and "S1_error" and
            "ST_error", half widths of their 95 % intervals (bootstrap).

        Raises
        ------
        InvalidValue
            SALib is not installed, or the output has no value in more than half of the samples.

        Notes
        -----
        A sample in which the output has no value is left out with the whole group it belongs to.

        References
        ----------
        Saltelli et al. 2010, Comput. Phys. Commun. 181, 259, doi:10.1016/j.cpc.2009.09.018;
        SALib: Iwanaga, Usher, Herman 2022, doi:10.18174/sesmo.18155.
        """
        try:
            from SALib.analyze import sobol as analyse
            from SALib.sample import sobol as sample
        except ImportError:
            raise InvalidValue(
                "Sobol indices need SALib; pip install 'thirdbody[uncertainty]'"
            ) from None
        if samples < 2 or samples & (samples - 1):
            raise InvalidValue(f"samples = {samples} must be a power of two")
        names = _outputs([of] if isinstance(of, str) else of, self.contact)
        width = len(self.inputs)
        cube = {"num_vars": width, "names": list(self.inputs), "bounds": [[0.0, 1.0]] * width}
        u = sample.sample(cube, samples, calc_second_order=False, seed=self.seed)
        load = float(np.atleast_1d(self.loads)[at])
        vary = self._problem().points(u)
        solved = _evaluated(self.contact, self.load, load, vary, len(u), names)
        out: dict[str, dict[str, dict[str, float]]] = {}
        for name in names:
            values = solved[name]
            if name in CRITICAL or name in MARGINS:
                with np.errstate(divide="ignore"):
                    values = np.log(values)
            groups = values.reshape(samples, width + 2)
            groups = groups[np.isfinite(groups).all(1)]
            if len(groups) < samples / 2:
                raise InvalidValue(
                    f"of = {name!r} has a value in only {len(groups)} of {samples} groups of "
                    "samples; its variance is none of the inputs' alone"
                )
            if np.ptp(groups) == 0:
                raise InvalidValue(f"of = {name!r} is the same in every sample: no variance")
            # SALib takes a seed of zero for none
            found = analyse.analyze(
                cube, groups.ravel(), calc_second_order=False, seed=self.seed + 1
            )
            out[name] = {
                label: {
                    "S1": float(found["S1"][j]),
                    "S1_error": float(found["S1_conf"][j]),
                    "ST": float(found["ST"][j]),
                    "ST_error": float(found["ST_conf"][j]),
                }
                for j, label in enumerate(self.inputs)
            }
        return out

    def _problem(self) -> Drawn:
        one = np.asarray(self.loads).flat[0]
        return drawn_inputs(self.contact, self.inputs, self.load, one)


def plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: plain(part) for name, part in value.items()}
    if isinstance(value, (np.ndarray, np.generic)):
        return plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [plain(part) for part in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def swing(low: float, high: float) -> float:
    """How far an output goes from end to end; beyond everything where one end is not finite."""
    swing = abs(high - low)
    return swing if math.isfinite(swing) else (0.0 if low == high else math.inf)


# -------------------------------------------------------------------------- propagation
def propagate(
    contact: Contact,
    inputs: Mapping[str, Uncertain | tuple[float, float]],
    *,
    F_star: ArrayLike | None = None,
    pressure: ArrayLike | None = None,
    d: ArrayLike | None = None,
    samples: int = 2**14,
    seed: int = 0,
    outputs: Sequence[str] | None = None,
    quantiles: Sequence[float] = PROBABILITIES,
    critical_samples: int | None = None,
) -> Propagation:
    r"""Bands on results and critical loads from what is known of the inputs.

    .. math:: p_i = F_i^{-1}(u_i), \qquad P(c \le q_\alpha) = \alpha

    Parameters
    ----------
    contact : Contact
        Every input that is known; the uncertain ones have their nominal values here.
    inputs : mapping
        Dotted names of numbers of the contact, or several joined by "+", which move by one factor
        (``"surfaces.first.H+surfaces.second.H"``; values are those of the first), and for each an
        `Uncertain`, or ``(low, high)`` for a uniform range. The given load may be one of them.
    F_star, pressure, d : float or array (L,)
        Loads, as in `solve`; exactly one.
    samples : int, optional
        Samples N for each load, at least 64, rounded up to a power of two.
    seed : int, optional
        The same seed gives the same bands, to the last digit with the same versions of
        thirdbody, NumPy, SciPy and numba on the same type of processor.
    outputs : sequence of str, optional
        Columns of `Equilibrium`, "plastic_share" (A_p/A_t), critical loads "F_cr1", "F_cr2",
        "F_tpca.A", "F_tpca.B", and margins "F/F_cr1", "F/F_cr2". All that the contact has by
        default.
    quantiles : sequence of float, optional
        Probabilities α of the bands.
    critical_samples : int, optional
        Samples in which critical loads are sought, some fifty times the work of a state; by
        default as many as ``samples``, at most 2048.

    Returns
    -------
    Propagation

    Raises
    ------
    InvalidValue
        An unknown name, a range that the input does not take, or no load.

    Notes
    -----
    Inputs are independent; correlated ones are not offered. What moves together stands joined by
    "+". Standard errors are the spread of eight scramblings over √8: for smooth results
    some 1e-3 of the width of a band at 2¹⁴ samples, falling faster than 1/√N. A critical load
    below the window of `transitions` counts as 0 and one above it as ∞, so that quantiles hold
    for all samples.
    On the rough seat a state costs about 12 µs of a core where sizes vary, or the hardness of both
    surfaces alike; 80 µs and more where the contacts of a particle with both surfaces become
    unlike. On the plane seat, under `asperity_law` options and for heights that are not Gaussian,
    states with other inputs are solved one by one, tens in a second.

    References
    ----------
    Owen 1998, ACM Trans. Model. Comput. Simul. 8, 71, doi:10.1145/272991.273010.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> found = tb.propagate(contact, {"roughness.sigma": (80e-9, 120e-9)}, pressure=5e6,
    ...                      samples=256, outputs=["A_t"], quantiles=[0.05, 0.95])
    >>> low, high = found.bands["A_t"]
    >>> bool(low < found.nominal["A_t"] < high)
    True
    """
    load, _, one = given_load(contact, pressure, F_star, d)
    loads = np.atleast_1d(np.asarray({"pressure": pressure, "F_star": F_star, "d": d}[load], float))
    drawn = drawn_inputs(contact, inputs, load, loads[0] if one else loads)
    names = _outputs(outputs, contact)
    probabilities = tuple(float(q) for q in quantiles)
    problems = [f"quantiles: {q:g} must be between 0 and 1" for q in probabilities if not 0 < q < 1]
    for name, value, least in (
        ("samples", samples, LEAST),
        ("critical_samples", LEAST if critical_samples is None else critical_samples, LEAST),
        ("seed", seed, 0),
    ):
        if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < least:
            problems.append(f"{name} = {value!r} must be a whole number, at least {least}")
    if problems:
        raise InvalidValue(*problems)
    each = _power_of_two(samples) // REPLICATES
    few = min(each, _power_of_two(critical_samples or MOST_CRITICAL) // REPLICATES)
    u = _points(each, len(inputs), int(seed), REPLICATES)
    vary = drawn.points(u)

    critical: Arrays = {}
    sought = {MARGINS.get(name, name) for name in names} & set(CRITICAL)
    first_few = np.arange(len(u)).reshape(REPLICATES, each)[:, :few]
    statuses: dict[str, dict[str, float]] = {}
    nominal_critical: Arrays = {}
    if sought:
        some = {n: v[first_few.ravel()] for n, v in vary.items() if n != load}
        found = critical_loads(contact, some, first_few.size)
        critical = {name: found[name][0].reshape(first_few.shape) for name in CRITICAL}
        for name in (name for name in CRITICAL if name in sought):
            words, counts = np.unique(found[name][1], return_counts=True)
            shares = (counts / first_few.size).tolist()
            statuses[name] = dict(zip(map(str, words), shares, strict=True))
        nominal_critical = {n: v[0] for n, v in critical_loads(contact, {}, 1).items()}

    of_outputs = {name for each in contact.outputs for name in each.columns} & set(names)
    some_outputs = first_few[:, : max(1, MOST_OUTPUTS // REPLICATES)]

    bands: dict[str, list[Array]] = {name: [] for name in names}
    errors: dict[str, list[Array]] = {name: [] for name in names}
    nominal: dict[str, list[float]] = {name: [] for name in names}
    modes: dict[str, list[float]] = {mode: [] for mode in MODES}
    mode_errors: dict[str, list[float]] = {mode: [] for mode in MODES}
    solved: list[float] = []
    fixed = {name for name in names if name in CRITICAL}
    for number, value in enumerate(loads):
        state = columns_at(contact, load, value, vary, len(u))
        middle = columns_at(contact, load, value, {}, 1, outputs=bool(of_outputs))
        if of_outputs:
            some = {n: v[some_outputs.ravel()] for n, v in vary.items()}
            told = columns_at(contact, load, value, some, some_outputs.size, outputs=True)
            state |= {name: told[name] for name in of_outputs}
        for name in names:
            if name in fixed and number:
                continue
            few_of = first_few if name in CRITICAL or name in MARGINS else None
            values = _output(name, state, critical, few_of).reshape(REPLICATES, -1)
            band, error = _quantiles(values, probabilities)
            bands[name].append(band)
            errors[name].append(error)
            own = _output(name, middle, nominal_critical, np.zeros(1, int))
            nominal[name].append(float(own.flat[0]))
        words = np.asarray(state["mode"]).reshape(REPLICATES, -1)
        for mode in MODES:
            share = np.mean(words == ("" if mode == "none" else mode), axis=1)
            modes[mode].append(float(share.mean()))
            mode_errors[mode].append(float(share.std(ddof=1) / math.sqrt(REPLICATES)))
        solved.append(float(np.mean(state["status"] == "ok")))

    def shaped(table: Mapping[str, Sequence[Any]]) -> dict[str, Any]:
        flat = {n for n in table if one or n in fixed}
        return {n: part[0] if n in flat else np.array(part) for n, part in table.items()}

    return Propagation(
        contact=contact,
        inputs=dict(zip(inputs, drawn.known, strict=True)),
        load=load,
        loads=float(loads[0]) if one else loads,
        samples=len(u),
        critical_samples=first_few.size if sought else 0,
        seed=int(seed),
        probabilities=probabilities,
        nominal=shaped(nominal),
        bands=shaped(bands),
        error=shaped(errors),
        mode_probability=shaped(modes),
        mode_error=shaped(mode_errors),
        critical_status=statuses,
        solved=solved[0] if one else np.array(solved),
    )


def about_result(name: str) -> dict[str, str]:
    """Symbol, unit and meaning of what has a band."""
    return OUTPUTS[name] if name in OUTPUTS else about(name)


def _outputs(asked: Sequence[str] | None, contact: Contact) -> list[str]:
    """The outputs, each once, that the contact has."""
    about_loads = (*CRITICAL, *MARGINS)
    without = contact.two_body or not _falls(contact)
    known = [*OUTPUTS, *(name for each in contact.outputs for name in each.columns)]
    if asked is None:
        return [name for name in known if not (without and name in about_loads)]
    names = list(dict.fromkeys(asked))
    problems = [
        f"{name!r} has no band; it must be one of {', '.join(known)}"
        for name in names
        if name not in known
    ]
    if not names:
        problems.append("outputs is empty; name a column of Equilibrium or a critical load")
    if contact.two_body:
        problems += [
            f"{name!r} needs particles: a two-body contact is always s-s"
            for name in names
            if name in about_loads
        ]
    if problems:
        raise InvalidValue(*problems)
    return names


def _power_of_two(count: int) -> int:
    return 1 << (int(count) - 1).bit_length()


def _points(each: int, width: int, seed: int, replicates: int) -> Array:
    """Scramblings of the Sobol sequence, one after another; a short one of its own for none."""
    rows: Iterator[int] = iter(range(replicates)) if replicates else iter([REPLICATES])
    seeds = [int(np.random.SeedSequence([seed, r]).generate_state(1)[0]) for r in rows]
    return np.concatenate([sobol(each, width, one, 0, each) for one in seeds])


def columns_at(
    contact: Contact, load: str, value: float, vary: Arrays, count: int, *, outputs: bool = False
) -> Arrays:
    """States at one load, bare unless outputs are asked; the load may be among what varies."""
    if outputs:
        vary = dict(vary)
    else:
        contact, vary = _bare(contact, vary)
    loads = vary.pop(load, np.full(count, value))
    return solve_states(contact, **{load: loads}, vary=vary or None)


def _bare(contact: Contact, vary: Mapping[str, Any]) -> tuple[Contact, dict[str, Any]]:
    """The contact without outputs, and of what varies that which decides how it carries load."""
    return contact.replace(outputs=()), {name: v for name, v in vary.items() if carries(name)}


def _evaluated(
    contact: Contact, load: str, value: float, vary: Arrays, count: int, names: Sequence[str]
) -> dict[str, Array]:
    """Outputs (N,) of samples at one load."""
    critical: Arrays = {}
    if any(name in CRITICAL or name in MARGINS for name in names):
        rest = {n: v for n, v in vary.items() if n != load}
        critical = {name: v[0] for name, v in critical_loads(contact, rest, count).items()}
    asked = any(name in each.columns for each in contact.outputs for name in names)
    state = columns_at(contact, load, value, vary, count, outputs=asked)
    return {name: _output(name, state, critical, np.arange(count)) for name in names}


def _output(
    name: str, state: Arrays, critical: Mapping[str, Array], few: NDArray[np.intp] | None
) -> Array:
    """One output of every sample; critical loads and margins of a few of them."""
    if name in CRITICAL:
        return critical[name]
    with np.errstate(divide="ignore", invalid="ignore"):
        if name in MARGINS:
            return state["F_star"][few] / critical[MARGINS[name]]
        if name == "plastic_share":
            return state["A_p"] / state["A_t"]
    return state[name]


def _quantiles(values: Array, probabilities: Sequence[float]) -> tuple[Array, Array]:
    """Quantiles (Q,) of all samples (R, n), and their standard errors from the replicates."""
    apart = np.array([_quantile(row, probabilities) for row in values])
    with np.errstate(invalid="ignore"):
        error = apart.std(axis=0, ddof=1) / math.sqrt(len(values))
    return _quantile(values.ravel(), probabilities), error


def _quantile(values: Array, probabilities: Sequence[float]) -> Array:
    known = values[~np.isnan(values)]
    if not len(known):
        return np.full(len(probabilities), np.nan)
    # N points in N equal cells: the i-th smallest stands in the middle of its cell
    method = "hazen" if np.isfinite(known).all() else "inverted_cdf"
    return np.quantile(known, probabilities, method=method)  # type: ignore[call-overload]
