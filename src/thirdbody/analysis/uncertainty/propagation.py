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
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...contact.broken_averages import roughly
from ...contact.citations import cite
from ...contact.contact import Contact
from ...equilibrium.critical_loads import CRITICAL, critical_loads
from ...equilibrium.crowding import is_crowded
from ...equilibrium.solve import given_load
from ...equilibrium.states import FEWEST, goes_one_by_one, tables_each, why_outputs
from ...errors import InvalidValue, Mistake, Problem, tell_of_range
from ...quantities.arguments import need_place
from ...quantities.carried import takes_units
from ...quantities.notebook import Card, Row, words_of
from ...quantities.progress import watch_contacts
from ...quantities.record import TableRecord, Variable
from ...quantities.say import percent
from ...quantities.uncertain import uncertain_number
from .inputs import Drawn, Uncertain, drawn_inputs
from .samples import (
    MARGINS,
    MODES_OR_NONE,
    MOST_CRITICAL,
    MOST_OUTPUTS,
    OUTPUTS,
    PROBABILITIES,
    REPLICATES,
    about_loads,
    about_result,
    check_counts,
    columns_at,
    columns_of_loads,
    critical_of,
    crowded_samples,
    evaluate_samples,
    output_of,
    outputs_of,
    points_of,
    power_of_two,
    quantiles_of,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]
    Arrays = dict[str, NDArray[Any]]

__all__ = ["OUTPUTS", "Propagation", "about_result", "propagate"]


# -------------------------------------------------------------------------- result
@dataclass(frozen=True, eq=False, kw_only=True)
class Propagation(TableRecord):
    """Bands on the results of a contact with uncertain inputs: floats, or arrays over loads.

    As labelled data and as a table bands lie along ``quantile``, and along the loads where there
    are several; a table has a column for each contact mode, ``mode_probability[p-s]``.

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
    crowded : float or array (L,)
        Share of samples that are crowded, as the `status` of an `Equilibrium` says; they count.
    """

    not_in_dict = ("contact", "_critical_at_ends")
    in_columns = ("mode",)
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
    crowded: Any = 0.0
    _critical_at_ends: dict[tuple[float, float], Arrays] = field(default_factory=dict, repr=False)
    """Critical loads at the ends of each input, by the probabilities of the ends."""

    def variables(self) -> dict[str, Variable]:
        """Bands, their errors and nominal values, and shares of the samples."""
        along = self._load_dimension()
        out: dict[str, Variable] = {}
        for name, band in self.bands.items():
            if name in along:
                continue  # a coordinate
            column = about_result(name)
            dims = (*along[: np.ndim(band) - 1], "quantile")
            nominal = self.nominal[name]
            bands = column._replace(meaning=f"quantiles of the {column.meaning}")
            errors = column._replace(meaning=f"standard error of the {bands.meaning}")
            of_nominal = column._replace(meaning=f"{column.meaning}, with the contact's own inputs")
            out[name] = Variable(dims, band, bands.labels)
            out[f"{name}_error"] = Variable(dims, self.error[name], errors.labels)
            out[f"{name}_nominal"] = Variable(along[: np.ndim(nominal)], nominal, of_nominal.labels)
        for name, table in (("probability", self.mode_probability), ("error", self.mode_error)):
            values = np.stack([np.asarray(table[mode]) for mode in MODES_OR_NONE], axis=-1)
            labels = {"units": "1", "long_name": f"{name} of each contact mode"}
            out[f"mode_{name}"] = Variable((*along, "mode"), values, labels)
        for name, share in (("solved", self.solved), ("crowded", self.crowded)):
            labels = {"units": "1", "long_name": f"share of the samples that are {name}"}
            out[name] = Variable(along[: np.ndim(share)], share, labels)
        return out

    def coordinates(self) -> dict[str, Variable]:
        """Levels of the quantiles, modes, and several loads."""
        out = {
            "quantile": Variable(("quantile",), list(self.probabilities)),
            "mode": Variable(("mode",), list(MODES_OR_NONE)),
        }
        for name in self._load_dimension():
            out[name] = Variable((name,), np.asarray(self.loads), about_result(name).labels)
        return out

    def _load_dimension(self) -> tuple[str, ...]:
        """The dimension of several loads; none for one."""
        return (self.load,) if np.ndim(self.loads) else ()

    def attributes(self) -> Mapping[str, object]:
        """Contact, distributions, samples, version and citations."""
        import json

        from ...version import __version__

        return {
            "version": __version__,
            "contact": json.dumps(self.contact.to_dict()),
            "inputs": json.dumps(
                {name: distribution.to_dict() for name, distribution in self.inputs.items()}
            ),
            "samples": self.samples,
            "seed": self.seed,
            "citations": cite(self.contact),
        }

    @takes_units
    def ufloat(self, of: str) -> object:
        """The band of an output as a number with an uncertainty.

        Parameters
        ----------
        of : str
            Which output.

        Returns
        -------
        uncertainties.UFloat, or a list of them over the loads
            The median of the band (its middle where the median was not asked for), and the
            standard deviation of the normal distribution that has its outermost quantiles.

        Raises
        ------
        InvalidValue
            No such output, a band that is not finite, or `uncertainties` is not installed.

        Notes
        -----
        It says nothing of which input moved it; `Sensitivity.ufloats` does, to first order.

        Examples
        --------
        >>> import thirdbody as tb
        >>> steel = tb.materials["S45C"]
        >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
        ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
        >>> found = tb.propagate(contact, vary={"roughness.sigma": (90e-9, 110e-9)},
        ...                      pressure=5e6, samples=64, outputs=["h"])
        >>> print(f"{found.ufloat('h'):.2uP}")
        (2.80±0.16)×10⁻⁷
        """
        from scipy.special import ndtri

        if of not in self.bands:
            raise InvalidValue(
                Problem(
                    "of", f"must be one of {', '.join(self.bands)}", repr(of), code=Mistake.OPTION
                )
            )
        if len(self.probabilities) < 2:
            raise InvalidValue(
                "a band of one quantile has no width; ask for two quantiles or more",
                code=Mistake.BEYOND,
            )
        band, low, high = np.asarray(self.bands[of]), self.probabilities[0], self.probabilities[-1]
        std = (band[..., -1] - band[..., 0]) / float(ndtri(high) - ndtri(low))
        place = self.probabilities.index(0.5) if 0.5 in self.probabilities else None
        middle = band[..., [0, -1]].mean(axis=-1) if place is None else band[..., place]
        if not np.all(np.isfinite(middle) & np.isfinite(std)):
            raise InvalidValue(
                f"the band of {of} is not finite; see bands and critical_status", code=Mistake.RANGE
            )
        if band.ndim == 1:
            return uncertain_number(float(middle), float(std))
        return [uncertain_number(*pair) for pair in zip(middle.tolist(), std.tolist(), strict=True)]

    def _cards(self) -> Iterator[Card]:
        """A table for notebooks: quantiles of every output; of several loads at the first."""
        rows = [Row("", [percent(q) for q in self.probabilities])]
        for name, band in self.bands.items():
            column = about_result(name)
            first = np.reshape(band, (-1, len(self.probabilities)))[0]
            values = [words_of(value, column.unit) for value in first]
            rows.append(Row(name, values, column.meaning))
        for mode, share in self.mode_probability.items():
            values = [words_of(np.ravel(share)[0])]
            values += [""] * (len(self.probabilities) - 1)
            rows.append(Row(mode, values, "probability of the contact mode"))
        yield Card(f"Propagation, {self.samples} samples", rows)

    @takes_units
    def at_load(self, at: int) -> Propagation:
        """Propagation at one of several loads."""
        need_place("at", at, np.size(self.loads))
        if np.ndim(self.loads) == 0:
            return self

        def values_at(table: Mapping[str, Any], dims: int) -> dict[str, Any]:
            return {n: v[at] if np.ndim(v) > dims else v for n, v in table.items()}

        return dataclasses.replace(
            self,
            loads=float(self.loads[at]),
            nominal={name: float(value) for name, value in values_at(self.nominal, 0).items()},
            bands=values_at(self.bands, 1),
            error=values_at(self.error, 1),
            mode_probability={n: float(v) for n, v in values_at(self.mode_probability, 0).items()},
            mode_error={n: float(v) for n, v in values_at(self.mode_error, 0).items()},
            solved=float(self.solved[at]),
            crowded=float(self.crowded[at]),
        )

    # ------------------------------------------------------------------ one input at a time
    @takes_units
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
        names = outputs_of([of] if isinstance(of, str) else of, self.contact)
        need_place("at", at, np.size(self.loads))
        load = float(np.atleast_1d(self.loads)[at])
        vary, count = self._ends(probabilities, load)
        critical = self._critical_at_ends.get(probabilities, {})
        with roughly():
            if about_loads(names) and not critical:
                critical = critical_of(self.contact, self.load, vary, count)
                self._critical_at_ends[probabilities] = critical
            solved = evaluate_samples(self.contact, self.load, load, vary, count, names, critical)
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

    @takes_units
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
                "Sobol indices need SALib; pip install 'thirdbody[uncertainty]'",
                code=Mistake.ABSENT,
            ) from None
        if samples < 2 or samples & (samples - 1):
            raise InvalidValue(
                Problem("samples", "must be a power of two", f"{samples}", code=Mistake.RANGE)
            )
        names = outputs_of([of] if isinstance(of, str) else of, self.contact)
        width = len(self.inputs)
        cube = {"num_vars": width, "names": list(self.inputs), "bounds": [[0.0, 1.0]] * width}
        u = sample.sample(cube, samples, calc_second_order=False, seed=self.seed)
        need_place("at", at, np.size(self.loads))
        load = float(np.atleast_1d(self.loads)[at])
        vary = self._problem().points(u)
        needs_critical = about_loads(names)
        with roughly():
            critical = critical_of(self.contact, self.load, vary, len(u)) if needs_critical else {}
            solved = evaluate_samples(self.contact, self.load, load, vary, len(u), names, critical)
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
                    Problem(
                        "of",
                        f"has a value in only {len(groups)} of {samples} groups of samples; its "
                        "variance is none of the inputs' alone",
                        repr(name),
                        code=Mistake.BEYOND,
                    )
                )
            if np.ptp(groups) == 0:
                raise InvalidValue(
                    Problem(
                        "of",
                        "is the same in every sample: no variance",
                        repr(name),
                        code=Mistake.BEYOND,
                    )
                )
            # SALib takes a seed of zero for none
            indices = analyse.analyze(
                cube, groups.ravel(), calc_second_order=False, seed=self.seed + 1
            )
            out[name] = {
                label: {
                    "S1": float(indices["S1"][j]),
                    "S1_error": float(indices["S1_conf"][j]),
                    "ST": float(indices["ST"][j]),
                    "ST_error": float(indices["ST_conf"][j]),
                }
                for j, label in enumerate(self.inputs)
            }
        return out

    def _ends(self, probabilities: tuple[float, float], load: float) -> tuple[Arrays, int]:
        """Inputs of two states for each input, with it at each end; and how many states."""
        problem = self._problem()
        rows: list[list[float]] = []
        for j, distribution in enumerate(problem.distributions):
            for probability in probabilities:
                row = list(problem.nominal)
                row[j] = distribution.quantile(probability)
                rows.append(row)
        values = np.array(rows)
        values[np.isnan(values)] = load
        vary, count = problem.moved_numbers(list(values.T)), len(values)
        if not tables_each(self.contact, vary):  # the compiled engine takes no fewer
            spare = problem.points(points_of(FEWEST, len(self.inputs), 0, 0))
            vary = {name: np.append(column, spare[name]) for name, column in vary.items()}
            count += FEWEST
        return vary, count

    def _problem(self) -> Drawn:
        one = np.asarray(self.loads).flat[0]
        return drawn_inputs(self.contact, self.inputs, self.load, one)


def swing(low: float, high: float) -> float:
    """How far an output goes from end to end; beyond everything where one end is not finite."""
    return way if math.isfinite(way := abs(high - low)) else (0.0 if low == high else math.inf)


# -------------------------------------------------------------------------- propagation
@takes_units
def propagate(
    contact: Contact,
    *,
    pressure: ArrayLike | None = None,
    F_star: ArrayLike | None = None,
    d: ArrayLike | None = None,
    vary: Mapping[str, object],
    samples: int = 2**14,
    seed: int = 0,
    outputs: Sequence[str] | None = None,
    quantiles: Sequence[float] = PROBABILITIES,
    critical_samples: int | None = None,
    progress: bool | Callable[[int], None] = False,
) -> Propagation:
    r"""Bands on results and critical loads from what is known of the inputs.

    .. math:: p_i = F_i^{-1}(u_i), \qquad P(c \le q_\alpha) = \alpha

    Parameters
    ----------
    contact : Contact
        Every input that is known; the uncertain ones have their nominal values here.
    vary : mapping
        Dotted names of numbers of the contact, or several joined by "+", which move by one factor
        (``"surfaces.first.H+surfaces.second.H"``; values are those of the first), and for each an
        `Uncertain`, ``(low, high)`` for a uniform range, or a ufloat of the package
        `uncertainties`, a quantity with a unit too. The given load may be one of them.
    pressure, F_star, d : float or array (L,)
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
        Samples in which critical loads are sought, some six times the work of a state; by
        default as many as ``samples``, at most 2048.
    progress : bool or callable, optional
        Shows, or gets, how many contacts are done; a `SlowWarning` of more than 10 s without it.

    Returns
    -------
    Propagation

    Raises
    ------
    InvalidValue
        An unknown name, a range that the input does not take, or no load.

    Warns
    -----
    RangeWarning
        Samples that are crowded: their share.

    Notes
    -----
    Inputs are independent; correlated ones are not offered. What moves together stands joined by
    "+". Standard errors are the spread of eight scramblings over √8: for smooth results
    some 1e-3 of the width of a band at 2¹⁴ samples, falling faster than 1/√N. A critical load
    below the window of `transitions` counts as 0 and one above it as ∞, so that quantiles hold
    for all samples.
    A state costs 10 to 300 µs of a core where the compiled engine knows it; others are solved one
    by one, tens in a second. An output that looks at single contacts costs more: friction 10 to
    300 ms a state, dents with their quantiles a second. Each sample of particles that break takes
    a second or so, and its sums are to 1e-3, mostly to 1e-6, of the load.

    References
    ----------
    Owen 1998, ACM Trans. Model. Comput. Simul. 8, 71, doi:10.1145/272991.273010.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> found = tb.propagate(contact, vary={"roughness.sigma": (80e-9, 120e-9)}, pressure=5e6,
    ...                      samples=256, outputs=["A_t"], quantiles=[0.05, 0.95])
    >>> low, high = found.bands["A_t"]
    >>> bool(low < found.nominal["A_t"] < high)
    True
    """
    load, _, one = given_load(contact, pressure, F_star, d)
    loads = np.atleast_1d(np.asarray({"pressure": pressure, "F_star": F_star, "d": d}[load], float))
    drawn = drawn_inputs(contact, vary, load, loads[0] if one else loads)
    names = outputs_of(outputs, contact)
    probabilities = tuple(float(q) for q in quantiles)
    check_counts(probabilities, samples, critical_samples, seed)
    per_replicate = power_of_two(samples) // REPLICATES
    few = min(per_replicate, power_of_two(critical_samples or MOST_CRITICAL) // REPLICATES)
    u = points_of(per_replicate, len(vary), int(seed), REPLICATES)
    drawn_values = drawn.points(u)
    first_few = np.arange(len(u)).reshape(REPLICATES, per_replicate)[:, :few]
    sought = {MARGINS.get(name, name) for name in names} & set(CRITICAL)
    some = {n: v[first_few.ravel()] for n, v in drawn_values.items() if n != load}
    of_outputs = {name for output in contact.outputs for name in output.columns} & set(names)
    few_bound = of_outputs and not goes_one_by_one(contact, drawn_values)
    expected = first_few[:, :OUTPUTS_EACH].size if few_bound else len(u)
    with watch_contacts("propagate", expected, progress, why_outputs(contact, names)):
        critical = _sought(contact, sought, some, first_few)
        results = _Bands(names, probabilities, first_few, critical, contact)
        with roughly():
            output_columns = (
                _outputs(contact, load, loads, drawn_values, first_few) if of_outputs else {}
            )
        states = columns_of_loads(contact, load, loads, drawn_values, len(u))
        for i, value in enumerate(loads.tolist()):
            with roughly():
                state = next(states)
            state |= {name: output_columns[name][i] for name in names if name in of_outputs}
            results.add(state, columns_at(contact, load, value, {}, 1, outputs=bool(of_outputs)))

    for sentence in crowded_samples(results.crowded):
        tell_of_range(sentence)
    fixed = {name for name in names if name in CRITICAL}

    def shape_columns(table: Mapping[str, Sequence[object]]) -> dict[str, object]:
        flat = {n for n in table if one or n in fixed}
        return {n: values[0] if n in flat else np.array(values) for n, values in table.items()}

    return Propagation(
        contact=contact,
        inputs=dict(zip(vary, drawn.distributions, strict=True)),
        load=load,
        loads=float(loads[0]) if one else loads,
        samples=len(u),
        critical_samples=first_few.size if sought else 0,
        seed=int(seed),
        probabilities=probabilities,
        nominal=shape_columns(results.nominal),
        bands=shape_columns(results.bands),
        error=shape_columns(results.errors),
        mode_probability=shape_columns(results.modes),
        mode_error=shape_columns(results.mode_errors),
        critical_status=results.critical.statuses,
        solved=results.solved[0] if one else np.array(results.solved),
        crowded=results.crowded[0] if one else np.array(results.crowded),
    )


OUTPUTS_EACH = max(1, MOST_OUTPUTS // REPLICATES)
"""Samples of outputs in each scrambling."""


class _Critical(NamedTuple):
    """Critical loads of the first few samples, the shares of their statuses, and nominal ones."""

    loads: Arrays
    statuses: dict[str, dict[str, float]]
    nominal: Arrays


def _sought(
    contact: Contact, sought: set[str], some: Arrays, first_few: NDArray[np.intp]
) -> _Critical:
    if not sought:
        return _Critical({}, {}, {})
    with roughly():
        entries = critical_loads(contact, vary=some, count=first_few.size)
    loads = {name: entries[name][0].reshape(first_few.shape) for name in CRITICAL}
    statuses = {}
    for name in (name for name in CRITICAL if name in sought):
        words, counts = np.unique(entries[name][1], return_counts=True)
        shares = (counts / first_few.size).tolist()
        statuses[name] = dict(zip(map(str, words), shares, strict=True))
    nominal = {n: v[0] for n, v in critical_loads(contact, vary={}, count=1).items()}
    return _Critical(loads, statuses, nominal)


def _outputs(
    contact: Contact, load: str, loads: Array, drawn: Arrays, first_few: NDArray[np.intp]
) -> Arrays:
    """Columns (L, n) of a few samples with outputs, at every load: loads share their contacts."""
    which = first_few[:, :OUTPUTS_EACH].ravel()
    some = {name: np.tile(values[which], len(loads)) for name, values in drawn.items()}
    every = np.repeat(loads, len(which))
    columns = columns_at(contact, load, every, some, len(every), outputs=True)
    return {name: values.reshape(len(loads), -1) for name, values in columns.items()}


class _Bands:
    """Bands, load after load; critical loads have theirs once."""

    def __init__(
        self,
        names: Sequence[str],
        probabilities: Sequence[float],
        first_few: NDArray[np.intp],
        critical: _Critical,
        contact: Contact,
    ):
        self.contact = contact
        self.probabilities, self.first_few, self.critical = probabilities, first_few, critical
        self.bands: dict[str, list[Array]] = {name: [] for name in names}
        self.errors: dict[str, list[Array]] = {name: [] for name in names}
        self.nominal: dict[str, list[float]] = {name: [] for name in names}
        self.modes: dict[str, list[float]] = {mode: [] for mode in MODES_OR_NONE}
        self.mode_errors: dict[str, list[float]] = {mode: [] for mode in MODES_OR_NONE}
        self.solved: list[float] = []
        self.crowded: list[float] = []

    def add(self, state: Arrays, middle: Arrays) -> None:
        """Add one load: the states of its samples, and the nominal one."""
        for name, bands in self.bands.items():
            if name in CRITICAL and bands:
                continue
            few_of = self.first_few if name in CRITICAL or name in MARGINS else None
            values = output_of(name, state, self.critical.loads, few_of).reshape(REPLICATES, -1)
            band, error = quantiles_of(values, self.probabilities)
            bands.append(band)
            self.errors[name].append(error)
            nominal = output_of(name, middle, self.critical.nominal, np.zeros(1, int))
            self.nominal[name].append(float(nominal.flat[0]))
        words = np.asarray(state["mode"]).reshape(REPLICATES, -1)
        for mode in MODES_OR_NONE:
            share = np.mean(words == ("" if mode == "none" else mode), axis=1)
            self.modes[mode].append(float(share.mean()))
            self.mode_errors[mode].append(float(share.std(ddof=1) / math.sqrt(REPLICATES)))
        self.solved.append(float(np.mean(np.isfinite(state["d"]))))
        self.crowded.append(float(np.mean(is_crowded(self.contact, state["A_t"]))))


def certain(contact: Contact, load: str, loads: Sequence[float]) -> list[Propagation]:
    """A `Propagation` a load where nothing is uncertain: every quantile is the value itself."""
    names = outputs_of(None, contact)
    critical: Arrays = {}
    statuses: dict[str, dict[str, float]] = {}
    if set(names) & set(CRITICAL):
        entries = critical_loads(contact, vary={}, count=1)
        critical = {name: values for name, (values, _) in entries.items()}
        statuses = {name: {str(words[0]): 1.0} for name, (_, words) in entries.items()}
    few = np.zeros(1, int)
    out = []
    for value in loads:
        state = columns_at(contact, load, value, {}, 1, outputs=bool(contact.outputs))
        nominal = {name: float(output_of(name, state, critical, few).flat[0]) for name in names}
        mode = str(state["mode"][0]) or "none"
        out.append(
            Propagation(
                contact=contact,
                inputs={},
                load=load,
                loads=value,
                samples=1,
                critical_samples=len(critical) and 1,
                seed=0,
                probabilities=PROBABILITIES,
                nominal=nominal,
                bands={name: np.full(len(PROBABILITIES), one) for name, one in nominal.items()},
                error={name: np.zeros(len(PROBABILITIES)) for name in names},
                mode_probability={word: float(word == mode) for word in MODES_OR_NONE},
                mode_error=dict.fromkeys(MODES_OR_NONE, 0.0),
                critical_status=statuses,
                solved=1.0,
                crowded=float(is_crowded(contact, state["A_t"])[0]),
            )
        )
    return out
