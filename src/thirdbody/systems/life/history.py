"""A history: the particles of an oil over time, where they came from and where they went."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from ...populations.measured.cleanliness import counted_sizes, iso4406_of_counts
from ...quantities.arguments import names_arguments
from ...quantities.record import Column, Entry, TableRecord, Variable, with_names
from ...quantities.say import value_of
from .circuit import OilCircuit, OilTerms
from .code_times import SlowSizes, slow_sizes, times_within
from .ledger import Ledger
from .linear_flow import dirt_gain, flowing, generations, reproduction
from .steady import describe_reproduction

if TYPE_CHECKING:
    import xarray
    from numpy.typing import NDArray

    from .size_classes import SizeClasses

    Array = NDArray[np.float64]

__all__ = ["LifeEvent", "LifeHistory", "SteadyOil"]


def __dir__() -> list[str]:
    return sorted(__all__)


SETTLES_TO = 0.01
"""Part of the way to the steady state that is left when it counts as reached."""
EMPTY = 1e-9
"""Part of the oil at which a leak has emptied the circuit."""
MORE: Entry = ("more", lambda history: {name: item for name, (_, item) in history.more.items()})
"""What a contact adds to the plain data of a history."""


class LifeEvent(NamedTuple):
    """Something that happened; in ``events`` of a history."""

    time: float
    """When [s]."""
    name: str
    """What, in a word or two."""
    sentence: str
    """What, as a sentence without its stop."""


class SteadyOil(NamedTuple):
    """Oil that no longer changes; made by ``steady`` of a history."""

    numbers: Array
    """Particles per volume [1/m³], (K, M); NaN where they grow for ever."""
    code: str
    """ISO 4406; "-" for a count that grows for ever."""
    time: float
    """Until a hundredth of the way is left, of the slowest class that is counted [s]."""


def times_and_classes(
    times: Array, classes: SizeClasses, materials: tuple[str, ...]
) -> dict[str, Variable]:
    """Coordinates of numbers over time, by class and material."""
    low, high = classes.ends
    middle = Column("x", "m", "middle size")
    return {
        "time": Variable(("time",), times, Column("t", "s", "time").labels),
        "class": Variable(("class",), np.sqrt(low * high), middle.labels),
        "material": Variable(("material",), list(materials)),
    }


@dataclass(frozen=True, eq=False, kw_only=True)
class LifeHistory(TableRecord):
    """A history of oil, and of what acts in it; made by `thirdbody.life`.

    A table of it has a row for each time, and a column for each size, class and material:
    ``count[4e-06]``, ``n[5e-06][quartz]``.

    Attributes
    ----------
    circuit : OilCircuit
    terms : OilTerms
        What comes into the oil and goes out of it, no filter full.
    times : array (T,)
        [s].
    volume : array (T,)
        Of the oil V [m³].
    numbers : array (T, K, M)
        Particles per volume, by class and material n_km [1/m³].
    ledger : Ledger
        Where the mass came from and where it went.
    events : tuple of LifeEvent
    warnings : tuple of str
        What is to be said of it, a sentence each.
    more : dict of str to tuple of Column and array (T,)
        What a contact in the oil adds.
    births : array (J, J), optional
        𝒢 of classes and materials, row by row of ``numbers`` [1/s]; None where nothing is bred.

    Examples
    --------
    >>> import thirdbody as tb
    >>> quartz = tb.materials["quartz"]
    >>> oil = tb.oil.OilCircuit(
    ...     volume=0.2, start=tb.oil.OilDirt.from_iso4406("18/16/13", material=quartz), ingress=(),
    ...     filters=tb.oil.Filter(sizes=(4e-6,), betas=(75.0,), flow=1e-3))
    >>> history = tb.life(oil=oil, duration=1800.0)
    >>> history.codes[0], history.codes[-1]
    ('18/16/13', '5/3/0')
    """

    in_columns = ("size", "class", "material")
    in_dict: ClassVar[tuple[Entry, ...]] = (
        *("times", "codes", "counts", ("edges", "terms.classes.edges")),
        ("materials", lambda history: tuple(history.terms.materials)),
        *("numbers", "volume", "ledger"),
        *(("events", with_names("events")), MORE, ("steady", with_names("steady"))),
        *("code_times", ("slow_sizes", with_names("slow_sizes")), "time_scales"),
        *("R0", "reproduction", "dirt_gain", "warnings"),
    )
    circuit: OilCircuit
    terms: OilTerms
    times: Array
    volume: Array
    numbers: Array
    ledger: Ledger
    events: tuple[LifeEvent, ...] = ()
    warnings: tuple[str, ...] = ()
    more: Mapping[str, tuple[Column, Array]] = field(default_factory=dict)
    births: Array | None = None

    @cached_property
    def counts(self) -> Array:
        """Particles per volume from 4, 6 and 14 µm(c) [1/m³], (T, 3)."""
        return self.terms.classes.counted(self.numbers.sum(axis=-1))

    @cached_property
    def codes(self) -> tuple[str, ...]:
        """ISO 4406 code at each time."""
        return tuple(iso4406_of_counts(counts) for counts in self.counts)

    @property
    def mass_per_volume(self) -> Array:
        """Mass of particles per volume of oil [kg/m³], (T, M)."""
        return np.einsum("tkm,km->tm", self.numbers, self.terms.masses)

    @names_arguments
    def flows(self, *, rates: bool = False) -> list[tuple[str, str, float]]:
        """The flow table: from where, to where, and how much [kg].

        Parameters
        ----------
        rates : bool, optional
            Mean over the history [kg/s] in the place of the whole mass [kg].
        """
        over = self.times[-1] if rates else 1.0  # a history begins at 0
        return [(start, end, mass / over) for start, end, mass in self.ledger.rows()]

    @property
    def bypassed(self) -> tuple[str, ...]:
        """Names of the filters that are full in the end, so that the oil goes past them."""
        full = [event.sentence for event in self.events if event.name == "filter full"]
        named = zip(self.circuit.filter_names(), self.circuit.filters, strict=True)
        return tuple(
            name
            for name, oil_filter in named
            if oil_filter.when_full == "bypass"
            and any(s.startswith(f"{name} is full") for s in full)
        )

    @property
    def _terms_now(self) -> OilTerms:
        """What comes in and goes out in the end, past the filters that are full."""
        if not self.bypassed:
            return self.terms
        return self.circuit.terms(
            full=self.bypassed, classes=self.terms.classes, materials=self.terms.materials
        )

    # -------------------------------------------------------------------------- what it tends to
    def steady(self) -> tuple[SteadyOil, ...]:
        """The states in which the oil no longer changes; one, stable, without a contact."""
        numbers = self.terms.steady
        classes = self.terms.classes
        leaving = (self.terms.loss + self.terms.growth) / self.circuit.volume
        counts = classes.above(counted_sizes()[:1])[0] > 0
        inside = counts[:, None] & (self.terms.source + self.terms.start > 0) & (leaving > 0)
        slowest = float(np.min(leaving, where=inside, initial=math.inf))
        time = -math.log(SETTLES_TO) / slowest if math.isfinite(slowest) else math.nan
        return (SteadyOil(numbers, classes.iso4406(numbers.sum(axis=1)), time),)

    @cached_property
    def code_times(self) -> tuple[float, ...]:
        """Times from which the counts from 4, 6 and 14 µm(c) stay within half a code of their ends.

        From the beginning on, with no filter full and no oil changed [s]; NaN for a count that
        grows for ever.
        """
        terms, volume = self.terms, self.circuit.volume
        end = terms.classes.counted(terms.steady.sum(axis=1))

        def counts(time: float) -> Array:
            now = volume + terms.growth * time
            if now <= EMPTY * volume:
                return end
            state = flowing(
                volume, numbers=volume * terms.start, growth=terms.growth, source=terms.source,
                loss=terms.loss, time=time,
            )  # fmt: skip
            return terms.classes.counted(state.numbers.sum(axis=1) / now)

        return times_within(counts, end, first=self._first_time)

    @property
    def _first_time(self) -> float:
        """A time in which next to nothing is taken out [s]."""
        return 1e-3 * self.circuit.volume / max(float(np.max(self.terms.loss)), 1e-12)

    @property
    def slow_sizes(self) -> SlowSizes | None:
        """The sizes that go on when the counts of the code have long ended; None for none."""
        finite_times = [time for time in self.code_times if math.isfinite(time)]
        return slow_sizes(
            self._terms_now, volume=self.circuit.volume, than=max([self._first_time, *finite_times])
        )

    @property
    def _losses(self) -> Array:
        """𝓛 of classes and materials [1/s], (J, J)."""
        return np.diag((self.terms.loss / self.circuit.volume).ravel())

    @cached_property
    def R0(self) -> float:
        """Particles bred by one before it is removed [1]."""
        return 0.0 if self.births is None else reproduction(self._losses, births=self.births)

    @property
    def reproduction(self) -> str:
        """What R_0 means, in words."""
        why = "the study has no contact that returns any to the oil"
        return describe_reproduction(self.R0, why="" if self.R0 else why)

    @property
    def generations(self) -> Array:
        """Next-generation matrix: daughters of row i of a particle of column j [1], (J, J)."""
        losses = self._losses
        return generations(
            losses, births=np.zeros_like(losses) if self.births is None else self.births
        )

    @property
    def dirt_gain(self) -> float:
        """Particles in the steady state over those without debris [1].

        Infinite where one breeds more than one; NaN where R_0 is not known.
        """
        if self.births is None:
            return 1.0
        if not self.R0 < 1:
            return math.nan if math.isnan(self.R0) else math.inf
        source = (self.terms.source / self.circuit.volume).ravel()
        return dirt_gain(self._losses, births=self.births, source=source)

    @property
    def time_scales(self) -> dict[str, float]:
        """How long things take in the end [s], by name; NaN for what never ends."""
        volume, terms = self.circuit.volume, self._terms_now
        out: dict[str, float] = {}
        named = zip(self.circuit.filter_names(), self.circuit.filters, strict=True)
        flow = sum(
            (oil_filter.flow or 0.0) * (oil_filter.still_filtered if name in self.bypassed else 1.0)
            for name, oil_filter in named
        )
        if flow > 0:
            out["oil through the filters once"] = volume / flow
        for size, shares in zip(counted_sizes(), terms.classes.above(counted_sizes()), strict=True):
            held = np.flatnonzero(shares > 0)
            loss = float(terms.loss[held[0]].max()) if len(held) else 0.0
            name = f"removal of particles of {value_of(float(size), 'm')}"
            out[name] = volume / loss if loss > 0 else math.nan
        return out

    @property
    def histories(self) -> xarray.Dataset:
        """Everything over time, as labelled data: codes, counts, numbers by class, masses."""
        return self.to_dataset()

    def variables(self) -> dict[str, Variable]:
        """Codes, counts, numbers by class, volume, masses, and what a contact adds."""
        counted = Column("", "1/m^3", "particles per volume from a size on")
        numbers = Column("n", "1/m^3", "particles per volume of oil")
        volume = Column("V", "m^3", "volume of the oil")
        masses = {name: (Column("", "kg", name), m) for name, m in self.ledger.over_time().items()}
        over_time = {"volume": (volume, self.volume), **masses, **self.more}
        return {
            "code": Variable(("time",), list(self.codes), {"long_name": "ISO 4406 code"}),
            "count": Variable(("time", "size"), self.counts, counted.labels),
            "n": Variable(("time", "class", "material"), self.numbers, numbers.labels),
            **{
                name: Variable(("time",), m, about.labels) for name, (about, m) in over_time.items()
            },
        }

    def coordinates(self) -> dict[str, Variable]:
        """Times, sizes that are counted, middles of the classes, names of the materials."""
        sizes = Variable(("size",), list(counted_sizes()), Column("x", "m", "size").labels)
        classes = self.terms.classes
        over_classes = times_and_classes(self.times, classes, tuple(self.terms.materials))
        return {**over_classes, "size": sizes}
