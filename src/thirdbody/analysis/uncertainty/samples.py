"""Outputs of samples, and their quantiles with errors."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...contact.contact import Contact
from ...equilibrium.columns import COLUMNS, PLASTIC_SHARE, about
from ...equilibrium.critical_loads import CRITICAL, carrying, critical_loads, load_falls
from ...equilibrium.modes import MODES
from ...equilibrium.states import carries, state_columns, tables_each
from ...equilibrium.status import MOST_AREA
from ...errors import InvalidValue, Mistake, Note, Problem
from ...numerics.sampling import sobol
from ...quantities.arguments import is_empty
from ...quantities.record import Column
from ...quantities.say import percent
from ..inputs import NUMBERS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Arrays = dict[str, NDArray[Any]]

__all__ = ["OUTPUTS", "about_result", "columns_at", "columns_of_loads", "costly", "enough"]

REPLICATES = 8
"""Scramblings of the sequence."""
LEAST, MOST_CRITICAL, USUAL = 64, 2_048, 2**12
"""Fewest samples, those for which critical loads are sought unless more are asked for, and usual
ones."""
ON_A_FIELD = 512
"""Usual samples of particles on one field of heights, milliseconds each."""
PROBABILITIES = (0.05, 0.25, 0.5, 0.75, 0.95)
MARGINS = {"F/F_cr1": "F_cr1", "F/F_cr2": "F_cr2"}
MODES_OR_NONE = (*MODES, "none")
OUTPUTS: dict[str, Column] = {
    **{name: COLUMNS[name] for name in NUMBERS},
    "plastic_share": PLASTIC_SHARE,
    "F_cr1": Column("F_cr1*", "1", "critical load, p-s to hybrid"),
    "F_cr2": Column("F_cr2*", "1", "critical load, hybrid to s-s"),
    "F_tpca.A": Column("F_tpca,A*", "1", "load of the largest area share"),
    "F_tpca.B": Column("F_tpca,B*", "1", "load of equal load shares"),
    "F/F_cr1": Column("F/F_cr1", "1", "load over the first critical load"),
    "F/F_cr2": Column("F/F_cr2", "1", "load over the second critical load"),
}
"""Symbol, unit and meaning of everything that gets a band, beside the outputs of the contact."""
AT_ONCE = 2**17
"""States of several loads that are solved together."""
MOST_OUTPUTS = 512
"""Samples of outputs: each is a contact of its own, with spots of its own."""


def enough(contact: Contact, samples: int | None, vary: Iterable[str]) -> int:
    """Samples that were asked for, or the usual number; few where each builds its own tables."""
    if samples is not None:
        return samples
    if costly(contact, vary):
        return LEAST
    on_a_field = contact.asperity_law.of_surface and not contact.two_body
    return ON_A_FIELD if on_a_field else USUAL


def costly(contact: Contact, vary: Iterable[str]) -> bool:
    """Whether contacts that differ in these inputs each take tables of their own, 0.1 s to 5 s."""
    names = [name for label in vary for name in label.split("+") if carries(name)]
    if not names:
        return False
    if any(population.strength is not None for population in contact.populations):
        return True
    return tables_each(contact, names)


def about_result(name: str) -> Column:
    """Symbol, unit and meaning of what has a band."""
    return OUTPUTS.get(name) or about(name)


def outputs_of(outputs: Sequence[str] | None, contact: Contact) -> list[str]:
    """The outputs, each once, that the contact has."""
    about_loads = (*CRITICAL, *MARGINS)
    without = contact.two_body or not load_falls(contact)
    options = [*OUTPUTS, *(name for output in contact.outputs for name in output.columns)]
    if outputs is None:
        return [name for name in options if not (without and name in about_loads)]
    names = list(dict.fromkeys(outputs))
    problems = [
        Problem(
            "",
            f"{name!r} has no band",
            hint=f"it must be one of {', '.join(options)}",
            code=Mistake.OPTION,
        )
        for name in names
        if name not in options
    ]
    if not names:
        problems.append(is_empty("outputs", "name a column of Equilibrium or a critical load"))
    if contact.two_body:
        problems += [
            Problem(
                "",
                f"{name!r} needs particles: a two-body contact is always s-s",
                code=Mistake.BEYOND,
            )
            for name in names
            if name in about_loads
        ]
    if problems:
        raise InvalidValue(*problems)
    return names


def check_counts(
    probabilities: Sequence[float], samples: object, critical_samples: object, seed: object
) -> None:
    problems = [
        Problem("quantiles", f": {q:g} must be between 0 and 1", code=Mistake.RANGE)
        for q in probabilities
        if not 0 < q < 1
    ]
    for name, value, least in (
        ("samples", samples, LEAST),
        ("critical_samples", LEAST if critical_samples is None else critical_samples, LEAST),
        ("seed", seed, 0),
    ):
        if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < least:
            problems.append(
                Problem(
                    f"{name}",
                    f"must be a whole number, at least {least}",
                    repr(value),
                    code=Mistake.KIND,
                )
            )
    if problems:
        raise InvalidValue(*problems)


def power_of_two(count: int) -> int:
    return 1 << (int(count) - 1).bit_length()


def points_of(per_replicate: int, width: int, seed: int, replicates: int) -> Array:
    """Scrambled Sobol sequences, one after another; for none a short unscrambled one."""
    rows: Iterator[int] = iter(range(replicates)) if replicates else iter([REPLICATES])
    seeds = [int(np.random.SeedSequence([seed, r]).generate_state(1)[0]) for r in rows]
    return np.concatenate([sobol(per_replicate, width, one, 0, per_replicate) for one in seeds])


def crowded_samples(shares: Sequence[float]) -> list[str]:
    """Notes on the shares of samples that are crowded, one a load.

    >>> crowded_samples([0.0, 0.0])
    []
    """
    if not (most := max(shares)):
        return []
    where = f" at one of {len(shares)} loads" if len(shares) > 1 else ""
    what = (
        f"{percent(most)} of the samples{where} are crowded: more than {MOST_AREA:g} of the "
        "nominal area would be in contact, where contacts that this model counts one by one have "
        "grown together; they count in the bands, whose ends on that side are no answer: lower the "
        "load, or narrow the inputs"
    )
    return [Note(what, code="samples.crowded")]


def columns_at(
    contact: Contact,
    load: str,
    value: float | Array,
    vary: Arrays,
    count: int,
    *,
    outputs: bool = False,
    fewest: int | None = None,
) -> Arrays:
    """States at a load, or each at its own, bare unless outputs are asked; the load may be among
    what varies. By the compiled engine from the ``fewest`` of `state_columns` on."""
    if outputs:
        vary = dict(vary)
    else:
        contact, vary = carrying(contact, vary)
    loads: dict[str, Any] = {load: vary.pop(load, np.full(count, value))}
    return state_columns(contact, **loads, vary=vary or None, fewest=fewest)


def columns_of_loads(
    contact: Contact, load: str, loads: Array, vary: Arrays, count: int
) -> Iterator[Arrays]:
    """States of all samples at each load in turn, bare.

    What is laid or tabulated of a sample serves all loads: its states are solved side by side.
    """
    together = 1 if load in vary else max(1, AT_ONCE // count)
    for start in range(0, len(loads), together):
        some = loads[start : start + together]
        every = {name: np.repeat(values, len(some)) for name, values in vary.items()}
        size = count * len(some)
        columns = columns_at(contact, load, np.tile(some, count), every, size)
        for i in range(len(some)):
            yield {name: values[i :: len(some)] for name, values in columns.items()}


def about_loads(names: Iterable[str]) -> bool:
    """Whether an output is a critical load, or a margin to one."""
    return any(name in CRITICAL or name in MARGINS for name in names)


def critical_of(contact: Contact, load: str, vary: Arrays, count: int) -> Arrays:
    """Critical loads of samples; a load that varies changes none."""
    rest = {name: values for name, values in vary.items() if name != load}
    return {name: v[0] for name, v in critical_loads(contact, vary=rest, count=count).items()}


def evaluate_samples(
    contact: Contact,
    load: str,
    value: float,
    vary: Arrays,
    count: int,
    names: Sequence[str],
    critical: Arrays,
) -> dict[str, Array]:
    """Outputs (N,) of samples at one load, of which the critical loads are known."""
    needs_outputs = any(name in output.columns for output in contact.outputs for name in names)
    state = columns_at(contact, load, value, vary, count, outputs=needs_outputs)
    return {name: output_of(name, state, critical, np.arange(count)) for name in names}


def output_of(
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


def quantiles_of(values: Array, probabilities: Sequence[float]) -> tuple[Array, Array]:
    """Quantiles (Q,) of all samples (R, n), and their standard errors from the replicates.

    Those of all together lie as far from the mean of the replicates as they do, beside the error
    of that mean: of one input, whose points are the most even, this is the larger part.
    """
    apart = np.array([_quantile(row, probabilities) for row in values])
    quantiles = _quantile(values.ravel(), probabilities)
    with np.errstate(invalid="ignore"):
        error = apart.std(axis=0, ddof=1) / math.sqrt(len(values))
        error = np.hypot(error, quantiles - apart.mean(axis=0))
    return quantiles, error


def _quantile(values: Array, probabilities: Sequence[float]) -> Array:
    numbers = values[~np.isnan(values)]
    if not len(numbers):
        return np.full(len(probabilities), np.nan)
    # N points in N equal cells: the i-th smallest stands in the middle of its cell
    method = "hazen" if np.isfinite(numbers).all() else "inverted_cdf"
    return np.quantile(numbers, probabilities, method=method)  # type: ignore[call-overload]
