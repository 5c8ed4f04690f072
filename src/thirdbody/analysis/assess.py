"""One page for an engineer: the mode at the operating load, how sure it is, and what decides it."""

from __future__ import annotations

import itertools
import math
import time
import warnings
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..contact.broken_averages import roughly
from ..contact.contact import Contact
from ..equilibrium.compiled.batch import threads
from ..equilibrium.critical_loads import CRITICAL, carrying, load_falls
from ..equilibrium.engine.run import own_columns
from ..equilibrium.load import Load, as_load
from ..equilibrium.solve import given_load, solve
from ..equilibrium.states import FEWEST, OWN_SPOTS, fewest_of, vary_contact
from ..errors import (
    InvalidValue,
    Mistake,
    NoEquilibrium,
    NotCompiled,
    Note,
    RangeWarning,
    gather_places,
    note_of,
    tell_of_range,
)
from ..quantities.carried import takes_units
from ..quantities.progress import (
    FAR_OFF,
    LONG,
    SURE,
    Cost,
    Stages,
    count_contacts,
    duration,
    solving,
)
from ..quantities.say import number, percent, span, value_of
from ..quantities.value import problem_with
from .assessment import (
    COARSE,
    EACH,
    FAR,
    FINER,
    HALVES,
    SHOWN,
    UNMOVED,
    Assessment,
    Change,
    Stop,
    _nominal,
    unit_of,
)
from .attempts import columns_tried
from .differences import QUICK
from .inputs import declared_quantity, words_of
from .inputs import inputs as all_inputs
from .sensitivity import moves, sensitivity
from .uncertainty.inputs import Drawn, Uncertain, drawn_inputs, stated_ranges
from .uncertainty.propagation import Propagation, certain, propagate, swing
from .uncertainty.samples import (
    LEAST,
    MOST_CRITICAL,
    MOST_OUTPUTS,
    columns_at,
    costly,
    enough,
    points_of,
    power_of_two,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["assess", "assess_each"]


# -------------------------------------------------------------------------- making it
@takes_units
def assess(
    contact: Contact,
    *,
    pressure: float | None = None,
    F_star: float | None = None,
    vary: Mapping[str, Uncertain | tuple[float, float]] | None = None,
    samples: int | None = None,
    seed: int = 0,
    title: str = "",
    progress: Callable[[str], None] = lambda stage: None,
) -> Assessment:
    r"""Mode at the operating load with its probability, margins, and what decides them.

    Parameters
    ----------
    contact : Contact
    vary : mapping, optional
        What is uncertain, as in `propagate`. Without it the ranges of the materials library, where
        it states some, and of the finishing process, where a drawing names one; none is
        invented. Without any range the page tells mode, margins and what would change the mode,
        and no probability.
    pressure, F_star : float
        The operating load: p [Pa] or F* [1]; exactly one.
    samples, seed : int, optional
        As in `propagate`; 4096 without, 512 of particles on one `field` of heights, or 64 where
        each sample takes tables of its own, as particles that break do.
    title : str, optional
        Over the page.
    progress : callable, optional
        Gets the name of each part of the work, as it begins; one of
        `thirdbody.quantities.progress.stages` also how far a part is, and first results.

    Returns
    -------
    Assessment
        ``.page()`` for a terminal (rich) and ``.to_dict()``; `thirdbody.views.assess_page` makes
        HTML.

    Raises
    ------
    InvalidValue
        Several loads, or a mistake in the inputs.
    NoEquilibrium
        The contact does not carry the load.

    Notes
    -----
    Inputs are ranked by how far each alone, going from its 5th to its 95th percentile, moves the
    critical load nearest to the load; the part of the spread is the square of that way in the
    logarithm over the sum of the squares, which is exact where the inputs do not interact
    (`Propagation.sobol_indices` where they do). Values at which the mode changes are sought within
    a factor of 10 of each input and known to 0.1 %.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9)))
    >>> page = tb.assess(
    ...     contact, vary={"roughness.sigma": (80e-9, 120e-9)}, pressure=5e6, samples=256
    ... )
    >>> page.mode, page.decisive, page.changes[0].mode
    ('hybrid', 'F_cr1', 'p-s')
    """
    load, _, one = given_load(contact, pressure, F_star, None)
    load_value = pressure if load == "pressure" else F_star
    if not one:
        count = np.size(load_value)  # type: ignore[arg-type]
        raise InvalidValue(
            f"{load}: an assessment is of one operating load, not {count}", code=Mistake.SHAPE
        )
    (page,) = assess_each(
        contact,
        load,
        [float(load_value or 0.0)],
        vary=vary,
        samples=samples,
        seed=seed,
        title=title,
        progress=progress,
    )
    if isinstance(page, NoEquilibrium):
        raise page
    return page


def assess_each(
    contact: Contact,
    load: str,
    loads: Sequence[float],
    *,
    vary: Mapping[str, Uncertain | tuple[float, float]] | None = None,
    samples: int | None = None,
    seed: int = 0,
    title: str = "",
    progress: Callable[[str], None] = lambda stage: None,
) -> list[Assessment | NoEquilibrium]:
    """As `assess`, at each of several loads ("pressure" or "F_star"), or why there is no page.

    Samples, critical loads, and contacts on the way to another mode are those of all.
    """
    notes: list[str] = []
    none = False
    if vary is None:
        vary = stated_ranges(contact)
        none = not vary
        notes += _whence(contact, vary)
    states = [_own_state(contact, load, value) for value in loads]
    held = [value for value, state in zip(loads, states, strict=True) if isinstance(state, _Own)]
    progress(PARTS[0])
    count = 0 if none else power_of_two(enough(contact, samples, vary))
    work = _Work(progress, contact, vary or _usual(contact), count, len(held))
    work.first(load, held, states)
    outputs = min(count, MOST_OUTPUTS) * len(held) if contact.outputs else 0
    if held and not none:
        work.price(contact, vary, load, held, count, outputs)
    bands: Iterator[Propagation] = iter(())
    if held and none:
        bands = iter(certain(contact, load, held))
    elif held:
        at: Any = held if len(held) > 1 else held[0]
        with work.show_part(count, count * len(held) + EVALUATED * work.critical, outputs):
            propagation = propagate(contact, vary=vary, samples=count, seed=seed, **{load: at})
        work.second(propagation)
        bands = (propagation.at_load(i) for i in range(len(held)))
    progress(PARTS[1])
    slopes: dict[str, dict[str, float]] = {}
    with work.show_part(work.ends), _notes_once():
        out = [
            _page(title, next(bands), state, notes, slopes) if isinstance(state, _Own) else state
            for state in states
        ]
    progress(PARTS[2])
    with work.show_part(work.ways), roughly():
        changes_and_stops = iter(_changes([page for page in out if isinstance(page, Assessment)]))
    pages: list[Assessment | NoEquilibrium] = []
    for page in out:
        if isinstance(page, Assessment):
            changes, stops = next(changes_and_stops)
            page = replace(page, changes=changes, stops=stops)
        pages.append(page)
    return pages


class _Outputs:
    """Cost and progress of states whose outputs are calculated one by one."""

    def __init__(self, progress: Stages | None, total: int):
        self.progress, self.total, self.done = progress, total, 0.0
        self.warn = Cost(total, lambda now: None, "" if progress else "states with outputs")
        self.start, self.said = math.nan, False

    def __call__(self, count: float) -> None:
        self.done += count
        self.warn(count, OWN_SPOTS)
        if self.progress is None:
            return
        now = time.monotonic()
        if math.isnan(self.start):
            self.start, self.first = now, self.done
        elif not self.said and now > self.start + SURE:
            seconds = (now - self.start) / (self.done - self.first)
            whole = seconds * self.total
            if whole > max(LONG, FAR_OFF * self.progress.promised):
                self.progress.tell(
                    f"about {self.total:,} states with outputs, {number(seconds, 2)} s each: some "
                    f"{duration(whole)}"
                )
            self.said = True
        self.progress.report_progress(int(self.done), self.total, "states with outputs")


class _Work:
    """Progress of an assessment: its cost, how far it is, and first results.

    Contacts that share what they are made of are not bound one by one, and so not counted.
    """

    def __init__(
        self,
        progress: Callable[[str], None],
        contact: Contact,
        vary: Collection[str],
        count: int,
        loads: int,
    ):
        self.ends = (2 + SLOPES) * len(vary) if count else 0
        ways = len(range(0, COARSE - 1, EACH_COSTLY)) + HALVED * loads
        self.ways = 2 * len(vary) * ways
        self.within: Callable[[int, int], None] | None = None
        self.progress: Stages | None = None
        self.critical = 0
        """Samples in which critical loads are sought."""
        if not contact.two_body and load_falls(contact):
            self.critical = min(count, MOST_CRITICAL)
        self.tell: Callable[[str], None] = lambda sentence: None
        if isinstance(progress, Stages):
            self.progress, self.within = progress, progress.report_contacts
            alone = costly(contact, vary)
            few = 0 if fewest_of(contact) < FEWEST else self.ends + self.ways
            progress.expect(count + self.ends + self.ways if alone else few)
            if alone:
                self.tell = progress.tell

    @contextmanager
    def show_part(self, expected: int, states: int = 0, outputs: int = 0) -> Iterator[None]:
        """One part, of so many contacts or states, and so many states with outputs."""
        done, of_outputs = 0.0, _Outputs(self.progress, outputs)

        def more(count: float, why: str) -> None:
            nonlocal done
            if why == OWN_SPOTS:
                of_outputs(2 * count)  # the other half was the state
                return
            done += count
            if self.progress is not None and states and not why:
                self.progress.report_progress(int(done), states, "states")

        with count_contacts(expected, self.within), solving(more):
            yield

    def price(
        self,
        contact: Contact,
        vary: Mapping[str, Uncertain | tuple[float, float]],
        load: str,
        held: Sequence[float],
        count: int,
        outputs: int,
    ) -> None:
        """Tell what samples, and those with outputs, will take, from what few of them do, if long.

        Of contacts that are bound one by one the first few tell it.
        """
        if self.progress is None:
            return
        drawn = drawn_inputs(contact, vary, load, held[0])
        few = ALONE if (alone := costly(contact, vary)) else LEAST
        points = drawn.points(points_of(few, len(vary), 0, 0))
        bare, inputs = carrying(contact, points)
        loads = inputs.pop(load, np.full(few, held[0]))
        seconds = math.inf
        for _ in range(2):  # by the first the engine may be loaded
            start = time.monotonic()
            try:
                if not alone:
                    with roughly():
                        columns_at(bare, load, loads, inputs, few)
                elif np.any(own_columns(bare, inputs, load, loads)["doubt"] != ""):
                    return
            except NotCompiled:
                return
            seconds = min(seconds, (time.monotonic() - start) / few)
        states = count * len(held) + CRITICAL_COST * self.critical
        items = [(states, seconds, "states")]
        if not alone:  # so few are solved by one thread, and what decides is sought so, too
            changed = self.ends + self.ways
            items = [
                (states, seconds / threads(), "states"),
                (changed, CHANGE_COST * seconds, "changes of one input"),
            ]
        if outputs and not alone:
            dearer = _seconds_of_outputs(contact, load, held[0], points)
            items.append((outputs, dearer, "states with outputs"))
        self.progress.cost(*items)

    def first(self, load: str, held: Sequence[float], states: Sequence[object]) -> None:
        """The mode at each load, before anything is varied."""
        modes = [state.mode or "none" for state in states if isinstance(state, _Own)]
        unit = "Pa" if load == "pressure" else "1"
        for value, mode in zip(held, modes, strict=True):
            self.tell(f"at {load} {value_of(value, unit)} the mode is {mode}; how sure, comes next")

    def second(self, propagation: Propagation) -> None:
        """How probable the modes are, before it is known what decides."""
        for mode, share in propagation.mode_probability.items():
            for value, one in zip(np.ravel(propagation.loads), np.ravel(share), strict=True):
                if one > 0:
                    unit = "Pa" if propagation.load == "pressure" else "1"
                    self.tell(
                        f"at {propagation.load} {value_of(float(value), unit)} the mode is {mode} "
                        f"in {percent(float(one))} of {propagation.samples} samples"
                    )


def _seconds_of_outputs(
    contact: Contact, load: str, value: float, points: Mapping[str, Array]
) -> float:
    """Seconds that a state with outputs takes, after the first ones, by which all may be loaded."""
    seconds = 0.0
    for first, last in itertools.pairwise((0, ALONE, ALONE + TOGETHER)):
        few = {name: values[first:last] for name, values in points.items()}
        start = time.monotonic()
        try:
            columns_at(contact, load, value, few, last - first, outputs=True)
        except (InvalidValue, NoEquilibrium, NotCompiled):
            return seconds
        seconds = (time.monotonic() - start) / (last - first)
    return seconds


SLOPES, HALVED = 8, 2
"""Contacts of the derivatives with one input, and of the mean search for a change of mode at
a load."""
ALONE, TOGETHER, CRITICAL_COST, EVALUATED = 2, 24, 6, 20
"""States of costly contacts by which those of all are priced; states with outputs, so many that
they are solved as many are; what the critical loads of a sample take, in states, and at how many
they are found, most of one contact side by side."""
CHANGE_COST = 10
"""States that a change of one input takes, few at a time: 1 to 30 where it was measured."""
EACH_COSTLY = 10
"""As EACH, where each contact takes tables of its own."""


class _Own(NamedTuple):
    """Nominal state: its mode, and notes on it."""

    mode: str
    notes: list[str]


def _own_state(contact: Contact, load: str, value: float) -> _Own | NoEquilibrium:
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always", RangeWarning)
        try:
            state = solve(contact, **as_load(load, value))
        except NoEquilibrium as error:
            return error
    texts = dict.fromkeys(note_of(item.message) for item in heard)
    notes = [f"Warning: {text}." for text in texts]
    return _Own(str(state.mode), notes + about_fragments(contact, as_load(load, value)))


@contextmanager
def _notes_once() -> Iterator[None]:
    """Say what is said of several critical loads once, of all of them, when it is over."""
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always", RangeWarning)
        yield
    for item in heard:
        if not issubclass(item.category, RangeWarning):
            warnings.warn_explicit(item.message, item.category, item.filename, item.lineno)
    notes = [note_of(item.message) for item in heard if issubclass(item.category, RangeWarning)]
    for note in gather_places(notes):
        tell_of_range(note)


def _page(
    title: str,
    propagation: Propagation,
    state: _Own,
    notes: list[str],
    slopes: dict[str, dict[str, float]],
) -> Assessment | NoEquilibrium:
    """Assessment at one load, without its ``changes``; ``slopes`` caches elasticities."""
    if propagation.solved == 0:
        return NoEquilibrium("no sample has an equilibrium; check the unit of the load")
    decisive = _decisive(propagation)
    others = [name for name in SHOWN[:4] if name in propagation.bands and name != decisive]
    tornado = propagation.tornado([decisive, *others]) if propagation.inputs else {decisive: {}}
    moved = {name.strip() for label in propagation.inputs for name in label.split("+")}
    if decisive not in slopes:
        slopes[decisive] = _elasticities(propagation, decisive)
    return Assessment(
        title=title,
        propagation=propagation,
        mode=state.mode,
        decisive=decisive,
        matter=_parts(tornado[decisive], logarithm=decisive in CRITICAL),
        tornado=tornado,
        elasticity=slopes[decisive],
        changes=(),
        exact=tuple(name for name in all_inputs(propagation.contact) if name not in moved),
        notes=(*notes, *state.notes, *_outside(propagation)),
    )


PARTS = ("error bars", "what decides", "what would change the mode")
"""What an assessment does one after the other."""
TINY, SAME = 1e-3, 1e-9
"""Probability beyond which a nominal value no longer belongs to its distribution, and what the end
of a range may be off."""


def _whence(contact: Contact, vary: Iterable[str]) -> list[str]:
    """Sources of the ranges that the caller left out."""
    out = []
    for source, finished in (
        ("the materials library", False),
        ("the finishing process, from memory", True),
    ):
        named = [words_of(contact, k) for k in vary if k.startswith("roughness.") == finished]
        if named:
            out.append(f"Ranges of {source}: {'; '.join(named)}.")
    drawn = contact.roughness.ranges.get("alpha", (math.inf, -math.inf))
    low, high = contact.asperity_law.bandwidths
    if "roughness.alpha" in vary and (drawn[0] < low or drawn[1] > high):
        out.append(
            f"The law of the asperities knows a {words_of(contact, 'roughness.alpha')} from "
            f"{span(low, high, '1')}, so far it varies here; the process leaves "
            f"{span(*drawn, '1')} open: the bands lack what lies outside."
        )
    return out


BEAR = {"gone": "nothing", "footprint": "their footprint", "all": "all of them, in one layer"}
"""What pieces of broken particles bear, by the words of `WeibullStrength`."""
EXPONENT = "particles.strength.size_exponent"


def about_fragments(contact: Contact, load: Load[float]) -> list[str]:
    """Effect of the strength of fragments, which nobody has measured."""
    if all(population.strength is None for population in contact.populations):
        return []
    said = []
    for word, words in BEAR.items():
        broken = tuple(
            population if population.strength is None
            else population.replace(strength=population.strength.replace(fragments=word))
            for population in contact.populations
        )  # fmt: skip
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RangeWarning)
            try:
                state = solve(contact.replace(particles=broken, outputs=()), **load)
            except NoEquilibrium:
                said.append(f"{words}: no equilibrium")
                continue
            except InvalidValue as error:
                said.append(f"{words}: not known ({'; '.join(error.problems)})")
                continue
        said.append(
            f"{words}: particles carry {percent(float(state.particle_load_share))} "
            f"at d = {value_of(float(state.d), 'm', 3)}"
        )
    return [
        f"What pieces of broken particles bear is not known. {'; '.join(said)}. "
        "The largest uncertainty besides is the exponent of their strength over size: "
        f"give {EXPONENT} a range."
    ]


def _outside(propagation: Propagation) -> list[str]:
    """Inputs whose own value their range does not allow."""
    return [
        Note(
            "The value "
            f"{value_of(_nominal(propagation, label), unit_of(propagation.contact, label))} of the "
            f"{words_of(propagation.contact, label)} lies outside what its range says; nominal "
            "results and bands do not belong together.",
            code=f"uncertainty.outside.{label}",
        )
        for label, distribution in propagation.inputs.items()
        if _is_beyond(distribution, _nominal(propagation, label))
    ]


def _is_beyond(distribution: Uncertain, value: float) -> bool:
    """Whether a value is none that a range has; its ends are."""
    low, high = distribution.quantile(0.0), distribution.quantile(1.0)
    if math.isfinite(low) and math.isfinite(high):
        edge = SAME * max(abs(low), abs(high))
        return not low - edge <= value <= high + edge
    return not TINY < distribution.cdf(value) < 1 - TINY


def _decisive(propagation: Propagation) -> str:
    """The critical load nearest to the load, or the share to rank inputs by."""
    margins = {name: propagation.nominal.get(f"F/{name}", 0.0) for name in ("F_cr1", "F_cr2")}
    exist = {name: abs(math.log(x)) for name, x in margins.items() if 0 < x < math.inf}
    if exist:
        return min(exist, key=lambda name: exist[name])
    return "A_t" if propagation.contact.two_body else "particle_load_share"


def _parts(ends: Mapping[str, tuple[float, float]], *, logarithm: bool) -> dict[str, float]:
    """Part of each input in the spread, the largest first; NaN where an end does not exist."""
    ways = {}
    for label, (low, high) in ends.items():
        if logarithm:
            with np.errstate(divide="ignore"):
                low, high = (float(np.log(x)) for x in (low, high))
        way = swing(low, high) if not math.isnan(low + high) else 0.0
        ways[label] = way if way > UNMOVED else 0.0
    total = sum(way**2 for way in ways.values())
    order = sorted(ways, key=lambda label: -ways[label])
    if not 0 < total < math.inf:
        return dict.fromkeys(order, math.nan)
    return {label: ways[label] ** 2 / total for label in order}


def _elasticities(propagation: Propagation, decisive: str) -> dict[str, float]:
    """d ln F_cr/d ln p of every input, where it exists."""
    labels = [label for label in propagation.inputs if label != propagation.load]
    out = dict.fromkeys(labels, math.nan)
    if decisive not in CRITICAL:
        return out

    def slopes(some: list[str]) -> dict[str, float]:
        of = sensitivity(propagation.contact, of=decisive, to=some, quick=True)
        elasticities = of.elasticity[decisive]
        return {label: float(elasticities[label]) for label in some}

    bare = propagation.contact.replace(outputs=())
    try:
        return out | slopes([label for label in labels if moves(bare, label, QUICK)])
    except InvalidValue:  # one of them has none
        for label in labels:
            with suppress(InvalidValue):
                out |= slopes([label])
    return out


def _changes(pages: Sequence[Assessment]) -> list[tuple[tuple[Change, ...], tuple[Stop, ...]]]:
    """For each load where along each input, on either side, the mode ceases to be what it is.

    And where the way there ends, as the contact beyond is refused.
    """
    if not pages or pages[0].propagation.contact.two_body:
        return [((), ())] * len(pages)
    one = pages[0].propagation
    ways: dict[tuple[str, int], tuple[Drawn, Array]] = {}
    inputs = one.inputs or _usual(one.contact)
    stride = EACH_COSTLY if costly(one.contact, inputs) else EACH
    for label, distribution in inputs.items():
        if label != one.load:
            drawn = drawn_inputs(one.contact, {label: distribution}, one.load, float(one.loads))
            for side in (-1, 1):
                ways[label, side] = drawn, _path(one.contact, drawn, distribution, side, stride)
    every = {(i, *way): where for i in range(len(pages)) for way, where in ways.items()}
    steps, stops = _departures(pages, every)

    def alone(way: Way) -> bool:
        start = {name: float(v) for name, v in every[way][0].moved_numbers([steps[way][0]]).items()}
        return costly(vary_contact(one.contact, start), start)

    halved = {way for way in steps if alone(way)}
    for counts, some in (
        (FINER, [way for way in steps if way not in halved]),
        (HALVES, [way for way in steps if way in halved]),
    ):
        for count in counts:
            within = {way: np.linspace(*steps[way][:2], count) for way in some}
            steps |= _departures(pages, {way: (every[way][0], v) for way, v in within.items()})[0]
    out: list[list[Change]] = [[] for _ in pages]
    for (i, label, side), (low, high, other) in steps.items():
        value, beyond = 0.5 * (low + high), math.nan
        if one.inputs:
            distribution = one.inputs[label]
            beyond = distribution.cdf(value) if side < 0 else 1 - distribution.cdf(value)
        out[i].append(Change(label, value, other, beyond))

    def likely(change: Change) -> tuple[float, float]:
        start = _nominal(one, change.input)
        near = abs(math.log(change.value / start)) if change.value * start > 0 else math.inf
        return -float(np.nan_to_num(change.beyond)), near

    return [
        (
            tuple(sorted(changes, key=likely)),
            tuple(stop for (j, *_), stop in stops.items() if j == i),
        )
        for i, changes in enumerate(out)
    ]


def _usual(contact: Contact) -> dict[str, Uncertain]:
    """Inputs that are moved where none has a range: roughness, sizes, number, hardness."""
    values = {name: value for name, value in all_inputs(contact).items() if value > 0}
    labels: list[str] = ["roughness.sigma", "roughness.R"]
    labels += [name for name in values if name.endswith(".areal_density")]
    sizes: dict[str, list[str]] = {}
    for name in values:
        owner, separator, _ = name.rpartition(".diameter.")
        if separator and declared_quantity(contact, name)["unit"] == "m":
            sizes.setdefault(owner, []).append(name)
    labels += ["+".join(names) for names in sizes.values()]
    labels += [name for name in values if name.endswith(".material.H")]
    both = ["surfaces.first.H", "surfaces.second.H"]
    labels += ["+".join(both)] if contact.surfaces.alike else both
    ends = {label: values[label.partition("+")[0]] for label in labels}
    return {
        label: Uncertain.uniform(low=value / FAR, high=value * FAR) for label, value in ends.items()
    }


def _path(contact: Contact, drawn: Drawn, distribution: Uncertain, side: int, stride: int) -> Array:
    """Values of an input from where it is to as far as it may go."""
    (start,) = drawn.nominal
    (moved,) = drawn.moved
    assert not isinstance(moved, str)
    if start > 0:
        values = start * np.geomspace(1.0, FAR**side, COARSE)
    else:
        ends = np.array([distribution.quantile(0.0), distribution.quantile(1.0)])
        values = np.linspace(start, start + side * (np.ptp(ends) + np.abs(ends).max()), COARSE)

    def fits(value: float) -> bool:
        at = moved.numbers_at((value - moved.values[0]) / moved.scales[0])
        return all(
            problem_with(declared_quantity(contact, name), float(v)) is None
            for name, v in at.items()
        )

    good = [fits(float(value)) for value in values]
    open_way = values[: good.index(False)] if False in good else values
    last = len(open_way) - 1
    return open_way[np.unique(np.append(np.arange(0, last, stride), last))]


Way = tuple[int, str, int]
"""Which page, along which input, and to which side."""


def _departures(
    pages: Sequence[Assessment], ways: Mapping[Way, tuple[Drawn, Array]]
) -> tuple[dict[Way, tuple[float, float, str]], dict[Way, Stop]]:
    """First other mode along each direction that has one, and the step where it begins.

    Then, on each way that ends before, the last value that is not refused.
    """
    if not ways:
        return {}, {}
    one = pages[0].propagation
    nominal = all_inputs(one.contact)
    counts = [len(values) for _, values in ways.values()]
    ends = np.cumsum([0, *counts])
    pieces = [slice(*pair) for pair in itertools.pairwise(ends.tolist())]
    vary: dict[str, Array] = {}
    for (drawn, values), piece in zip(ways.values(), pieces, strict=True):
        for name, moved in drawn.moved_numbers([values]).items():
            vary.setdefault(name, np.full(ends[-1], nominal[name]))[piece] = moved
    loads = np.repeat([float(pages[i].propagation.loads) for i, _, _ in ways], counts)
    # samples of such contacts have the compiled engine at work already
    fewest = 1 if fewest_of(one.contact) < FEWEST else None

    def solve_some(which: NDArray[np.intp]) -> dict[str, NDArray[Any]]:
        some = {name: values[which] for name, values in vary.items()}
        return columns_at(one.contact, one.load, loads[which], some, len(which), fewest=fewest)

    states, refused = columns_tried(solve_some, int(ends[-1]))
    out, stops = {}, {}
    for (way, (_, values)), piece in zip(ways.items(), pieces, strict=True):
        modes = [str(word) for word in states["mode"][piece]]
        step = next((k for k, other in enumerate(modes) if other != pages[way[0]].mode), 0)
        if step > 0 and modes[step] != "":
            out[way] = float(values[step - 1]), float(values[step]), modes[step]
        elif step > 0 and piece.start + step in refused:
            stops[way] = Stop(way[1], float(values[step - 1]), refused[piece.start + step])
    return out, stops
