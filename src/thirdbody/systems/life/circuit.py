r"""An oil circuit: what brings particles into the oil, and what takes them out.

.. math:: \frac{d(V n_{km})}{dt} = r_{km} + q_{in} n^{in}_{km} - L_{km} n_{km}, \qquad
          L_{km} = q_{out} + \sum_f Q_f \bar P_{f,k} + A_s w_{km}
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InvalidValue, Mistake, Note, Problem
from ...populations.distributions import Distribution
from ...populations.materials import Material
from ...quantities.carried import takes_units
from ...quantities.say import join_words, number, value_of
from ...quantities.value import Value, items_of, quantity, sequences, several
from ..oil_filter import Filter
from .ingress import Ingress
from .oil_dirt import OilDirt
from .size_classes import SizeClasses, sizes_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["OilCircuit", "OilTerms", "settling_speed"]


def __dir__() -> list[str]:
    return sorted(__all__)


GRAVITY = 9.81
"""Acceleration of free fall [m/s²]."""
HOUR = 3600.0
SOON = 24 * HOUR
"""Time in which a filter that is full makes its ingress doubtful [s]."""
SETTLED, LEAKED = "settled", "leaked"
"""Names of what takes particles out beside filters."""


@takes_units
def settling_speed(
    x: Array | float, *, particle_density: float, oil_density: float, viscosity: float
) -> Array:
    r"""Speed at which a sphere sinks in oil, after Stokes [m/s].

    .. math:: w = \frac{(\rho_p-\rho)\,g\,x^2}{18\,\eta}

    Parameters
    ----------
    x : float or array
        Diameter [m].
    particle_density, oil_density : float
        ρ_p, ρ [kg/m³].
    viscosity : float
        η [Pa s].

    Returns
    -------
    array
        0 for what is lighter than oil.

    References
    ----------
    Stokes 1851, Trans. Cambridge Phil. Soc. 9, 8; Mathematical and Physical Papers 3, 1.

    Examples
    --------
    >>> from thirdbody.systems.life.circuit import settling_speed
    >>> w = settling_speed(10e-6, particle_density=2650, oil_density=870, viscosity=0.03)
    >>> f"{float(w):.5e}"
    '3.23367e-06'
    """
    lighter = max(particle_density - oil_density, 0.0)
    return lighter * GRAVITY * np.asarray(x, float) ** 2 / (18 * viscosity)


@dataclass(frozen=True, eq=False, kw_only=True)
class OilTerms:
    """What a circuit brings into its oil and takes out of it, by class k and material m.

    Attributes
    ----------
    classes : SizeClasses
    materials : dict of str to Material
        Columns of the arrays, by name.
    start, fresh : array (K, M)
        Particles per volume at the beginning, and in fresh oil [1/m³].
    ingress : array (K, M)
        Particles that enter per time [1/s].
    removal : dict of str to array (K, M)
        Oil per time from which they are taken, by what takes them [m³/s].
    make_up, growth : float
        Oil that comes in, and dV/dt [m³/s].
    masses : array (K, M)
        Of one particle [kg].
    """

    classes: SizeClasses
    materials: Mapping[str, Material]
    start: Array
    fresh: Array
    ingress: Array
    removal: Mapping[str, Array]
    make_up: float
    growth: float
    masses: Array

    @property
    def loss(self) -> Array:
        """Oil per time from which particles are taken, all together [m³/s], (K, M)."""
        return sum(self.removal.values(), np.zeros_like(self.start))

    @property
    def source(self) -> Array:
        """Particles that come per time, with ingress and fresh oil [1/s], (K, M)."""
        return self.ingress + self.make_up * self.fresh

    @property
    def steady(self) -> Array:
        """Particles per volume in the end [1/m³], (K, M); NaN where they grow for ever."""
        leaving = self.loss + self.growth
        kept = leaving > 1e-12 * (self.make_up + abs(self.growth))
        stays = self.source / np.where(kept, leaving, 1.0)
        return np.where(self.source == 0, 0.0, np.where(kept, stays, math.nan))


@dataclass(frozen=True, slots=True, kw_only=True)
class OilCircuit(Value):
    """Oil that goes round, with its filters, what enters it and what leaves it.

    Parameters
    ----------
    volume : float
        Of the oil V [m³].
    start : OilDirt or tuple of OilDirt
        Particles in it when the history begins; () for none.
    ingress : Ingress or tuple of Ingress
        Particles that enter it; () for none. Nobody can predict it.
    filters : Filter or tuple of Filter, optional
        Each with its flow. Filters of one ``line`` stand one behind the other.
    viscosity, density : float, optional
        η [Pa s] and ρ [kg/m³]; needed where particles settle.
    settling_area : float, optional
        Floor on which particles settle A_s [m²].
    make_up, leak : float, optional
        Oil that comes in q_in and goes out q_out [m³/s].
    fresh_oil : OilDirt or tuple of OilDirt, optional
        Particles in the oil that comes in, with ``make_up`` and at a change; () for none.
    oil_changes : tuple of float, optional
        Times at which all the oil is changed [s].
    classes : SizeClasses, optional
        Of size; by default edges a factor 2^⅓ apart that hold all particles.

    Raises
    ------
    InvalidValue
        What is missing for what is asked: flows of filters, densities, fresh oil.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.oil_filter import Filter
    >>> quartz = tb.materials["quartz"]
    >>> oil = tb.oil.OilCircuit(
    ...     volume=0.2,
    ...     start=tb.oil.OilDirt.from_iso4406("18/16/13", material=quartz),
    ...     ingress=tb.oil.Ingress.of_dust("A3", rate="125 mg/h", material=quartz),
    ...     filters=Filter(sizes=(5e-6, 10e-6), betas=(2.0, 75.0), flow=1e-3),
    ... )
    >>> oil.steady_code()  # nothing holds particles of 4 µm
    '-/12/7'
    """

    volume: float = quantity("V", "m^3", "volume of the oil", gt=0, hint="200 L is 0.2")
    start: tuple[OilDirt, ...]
    ingress: tuple[Ingress, ...]
    filters: tuple[Filter, ...] = ()
    viscosity: float | None = quantity("η", "Pa s", "viscosity of the oil", default=None, gt=0)
    density: float | None = quantity("ρ", "kg/m^3", "density of the oil", default=None, gt=0)
    settling_area: float = quantity("A_s", "m^2", "floor to settle on", default=0.0, ge=0)
    make_up: float = quantity("q_in", "m^3/s", "oil that comes in", default=0.0, ge=0)
    leak: float = quantity("q_out", "m^3/s", "oil that goes out", default=0.0, ge=0)
    fresh_oil: tuple[OilDirt, ...] | None = None
    oil_changes: tuple[float, ...] = several("s", "times of oil changes", default=())
    classes: SizeClasses | None = None

    def __post_init__(self) -> None:
        for name, kind in _TUPLES.items():
            value = getattr(self, name)
            if value is not None:
                several_of = (value,) if isinstance(value, kind) else items_of(value)
                object.__setattr__(self, name, several_of)
        Value.__post_init__(self)
        sequences(self, "oil_changes")

    def _problems(self) -> list[str]:
        out: list[str] = []
        for name, kind in _TUPLES.items():
            wrong = [value for value in getattr(self, name) or () if not isinstance(value, kind)]
            if wrong:
                out.append(
                    Problem(
                        name, f"must hold {kind.__name__} alone", repr(wrong[0]), code=Mistake.KIND
                    )
                )
        if not isinstance(self.classes, SizeClasses | None):
            out.append(
                Problem(
                    "classes", "must be SizeClasses, or None", repr(self.classes), code=Mistake.KIND
                )
            )
        if out:
            return out
        changes = self.oil_changes
        if any(not (math.isfinite(t) and t > 0) for t in changes) or any(
            b <= a for a, b in pairwise(changes)
        ):
            out.append(
                Problem(
                    "oil_changes",
                    "must be times that increase and start above 0 [s]",
                    code=Mistake.ORDER,
                )
            )
        if self.fresh_oil is None and (self.make_up > 0 or changes):
            what = "make_up" if self.make_up > 0 else "oil_changes"
            rule = f"is missing: {what} brings fresh oil, and new oil is seldom clean"
            out.append(Problem("fresh_oil", rule, code=Mistake.MISSING))
        if self.settling_area > 0 and (self.viscosity is None or self.density is None):
            rule = "needs viscosity [Pa s] and density [kg/m^3] of the oil"
            out.append(
                Problem("settling_area", rule, f"{self.settling_area:g}", code=Mistake.MISSING)
            )
        return [*out, *self._filter_problems(), *self._dirt_problems()]

    def _filter_problems(self) -> Iterable[Problem]:
        for i, oil_filter in enumerate(self.filters):
            if oil_filter.flow is None:
                rule = "is missing: oil through the filter [m^3/s]; 60 L/min is 1e-3"
                yield Problem(f"filters.{i}.flow", rule, code=Mistake.MISSING)
            if self.classes is not None:
                low, high = self.classes.edges[0], self.classes.edges[-1]
                missed = [x for x in oil_filter.sizes if not low <= x <= high]
                if missed:
                    rule = f"from {low:g} to {high:g} [m] miss a size of β of a filter"
                    yield Problem(
                        "classes", rule, hint=f"β is known at {missed[0]:g} m", code=Mistake.RANGE
                    )
        for name, line in self._lines():
            if len({oil_filter.flow for oil_filter in line}) > 1:
                rule = f"of line {name!r} have unlike flows, but the oil of a line goes through all"
                yield Problem("filters", rule, code=Mistake.CLASH)

    def _dirt_problems(self) -> Iterable[Problem]:
        for name in ("start", "ingress", "fresh_oil"):
            for i, dirt in enumerate(getattr(self, name) or ()):
                if dirt.material.density is None:
                    rule = "is missing: the mass of particles is counted [kg/m^3]"
                    yield Problem(f"{name}.{i}.material.density", rule, code=Mistake.MISSING)

    # -------------------------------------------------------------------------- what is in it
    @property
    def dirt(self) -> tuple[OilDirt | Ingress, ...]:
        """All that is in the oil or comes into it."""
        return (*self.start, *self.ingress, *(self.fresh_oil or ()))

    @property
    def materials(self) -> dict[str, Material]:
        """What the particles are of, by names that differ."""
        out: dict[str, Material] = {}
        for dirt in self.dirt:
            if dirt.material in out.values():
                continue
            name = dirt.material.name or "particles"
            while name in out:
                name += "'"
            out[name] = dirt.material
        return out

    def size_classes(self, *others: Distribution) -> SizeClasses:
        """Classes of size of all particles, as given or such that they hold them all.

        Parameters
        ----------
        *others : Distribution
            Sizes that come besides [m].
        """
        if self.classes is not None:
            return self.classes
        ends = [
            sizes_of(diameter) for diameter in (*(dirt.diameter for dirt in self.dirt), *others)
        ]
        lowest = min((low for low, _ in ends), default=1e-6)
        highest = max((high for _, high in ends), default=64e-6)
        filter_sizes = [x for oil_filter in self.filters for x in oil_filter.sizes]
        return SizeClasses.covering(
            smallest=min([lowest, *filter_sizes]), largest=max([highest, *filter_sizes])
        )

    def filter_names(self) -> tuple[str, ...]:
        """A name of each filter that no other has."""
        names: list[str] = []
        for i, oil_filter in enumerate(self.filters):
            name = oil_filter.name or ("filter" if len(self.filters) == 1 else f"filter {i + 1}")
            names.append(f"{name} ({i + 1})" if name in names else name)
        return tuple(names)

    def _lines(self) -> list[tuple[str, tuple[Filter, ...]]]:
        """Filters that stand one behind the other, by the name of their line."""
        names = dict.fromkeys(oil_filter.line for oil_filter in self.filters if oil_filter.line)
        return [
            (n, tuple(oil_filter for oil_filter in self.filters if oil_filter.line == n))
            for n in names
        ]

    def terms(
        self,
        *,
        full: Collection[str] = (),
        classes: SizeClasses | None = None,
        materials: Mapping[str, Material] | None = None,
    ) -> OilTerms:
        """What comes into the oil and what goes out, by class and material.

        Parameters
        ----------
        full : collection of str, optional
            Names of filters that are full and bypassed.
        classes : SizeClasses, optional
            Those of `size_classes`, where others are not needed.
        materials : mapping of str to Material, optional
            More materials than those of the circuit, after its own.
        """
        some = classes or self.size_classes()
        every = self.materials | dict(materials or {})
        shape = (some.count, len(every))
        start, fresh, entering = np.zeros(shape), np.zeros(shape), np.zeros(shape)
        place = {material: i for i, material in reversed(list(enumerate(every.values())))}
        for out, several_dirts in ((start, self.start), (fresh, self.fresh_oil or ())):
            for dirt in several_dirts:
                numbers = some.numbers_of(dirt.number, dirt.diameter)
                out[:, place[dirt.material]] += numbers
        removal = self.removal(some, every, full=full)
        never_full = sum(self.removal(some, every).values(), np.zeros(shape))
        for ingress in self.ingress:
            column = place[ingress.material]
            count = some.numbers_of if ingress.kept == "number" else some.numbers_by_volume
            if ingress.rate is not None:
                entering[:, column] += count(ingress.rate, ingress.diameter)
            elif ingress.steady is not None:
                stays = count(ingress.steady, ingress.diameter)
                loss = never_full[:, column] + self.make_up - self.leak
                entering[:, column] += stays * loss - self.make_up * fresh[:, column]
        if np.any(entering < 0):
            rule = "as an oil of a steady code is cleaner than the fresh oil that comes in"
            raise InvalidValue(Problem("ingress", rule, owner="OilCircuit", code=Mistake.CLASH))
        masses = [
            material.density if material.density is not None else math.nan
            for material in every.values()
        ]
        return OilTerms(
            classes=some,
            materials=every,
            start=start,
            fresh=fresh,
            ingress=entering,
            removal=removal,
            make_up=self.make_up,
            growth=self.make_up - self.leak,
            masses=some.volumes[:, None] * np.array(masses),
        )

    def removal(
        self,
        classes: SizeClasses,
        materials: Mapping[str, Material],
        *,
        full: Collection[str] = (),
    ) -> dict[str, Array]:
        """Oil per time from which particles are taken, by what takes them [m³/s], (K, M).

        Parameters
        ----------
        classes : SizeClasses
        materials : mapping of str to Material
            Of the particles.
        full : collection of str, optional
            Names of filters that are full and bypassed.
        """
        out: dict[str, Array] = {}
        flat = np.ones((1, len(materials)))
        passing = {name: np.ones(classes.count) for name, _ in self._lines()}
        for name, oil_filter in zip(self.filter_names(), self.filters, strict=True):
            taken = 1 - oil_filter.mean_penetration(classes.edges)
            if name in full:
                taken = taken * oil_filter.still_filtered
            before = passing.get(oil_filter.line, np.ones(classes.count))
            if oil_filter.line:
                passing[oil_filter.line] = before * (1 - taken)
            out[name] = (oil_filter.flow or 0.0) * (before * taken)[:, None] * flat
        if self.settling_area > 0:
            assert self.viscosity is not None
            assert self.density is not None
            speeds = [
                settling_speed(
                    np.sqrt(classes.mean_power(2)),
                    particle_density=material.density or self.density,
                    oil_density=self.density,
                    viscosity=self.viscosity,
                )
                for material in materials.values()
            ]
            out[SETTLED] = self.settling_area * np.stack(speeds, axis=1)
        if self.leak > 0:
            out[LEAKED] = self.leak * np.ones((classes.count, len(materials)))
        return out

    # -------------------------------------------------------------------------- without end
    def steady(self, *, full: Collection[str] = ()) -> Array:
        """Particles per volume that no longer change [1/m³], (K, M); NaN where they grow for ever.

        Parameters
        ----------
        full : collection of str, optional
            Names of filters that are full and bypassed.
        """
        return self.terms(full=full).steady

    def steady_code(self, *, full: Collection[str] = ()) -> str:
        """The ISO 4406 code that no longer changes; "-" for a count that grows for ever.

        Parameters
        ----------
        full : collection of str, optional
            Names of filters that are full and bypassed.
        """
        return self.size_classes().iso4406(self.steady(full=full).sum(axis=1))

    def notes(self) -> list[Note]:
        """What is to be said of the circuit: filters beyond their data sheets."""
        out = []
        for name, oil_filter in zip(self.filter_names(), self.filters, strict=True):
            if oil_filter.clipped_to is not None:
                out.append(
                    Note(
                        f"the β ratios of {name} rise so fast that up to "
                        f"{value_of(oil_filter.clipped_to, 'm', 3)} more particles would pass than "
                        "arrive; it holds none of these sizes",
                        code="clipped",
                        action="give β at more sizes of its data sheet",
                    )
                )
            low = oil_filter.sizes[0]
            if any(sizes_of(dirt.diameter)[0] < low for dirt in self.dirt):
                out.append(
                    Note(
                        f"{name} holds nothing below {value_of(low, 'm', 3)}, its smallest size "
                        "with a β ratio",
                        code="below the data sheet",
                        action="give β at smaller sizes, where the maker knows it",
                    )
                )
        out += self._filled_soon()
        settling = self.settling_area > 0 and self.density is not None
        floats = [n for n, m in self.materials.items() if settling and m.density <= self.density]  # type: ignore[operator]
        if floats:
            out.append(
                Note(
                    f"{join_words(floats)} is lighter than the oil and does not settle",
                    code="floats",
                    effect=0.0,
                )
            )
        return out

    def _filled_soon(self) -> list[Note]:
        """That filters would be full within a day, as hardly any is."""
        terms = self.terms()
        out = []
        for name, oil_filter in zip(self.filter_names(), self.filters, strict=True):
            if oil_filter.capacity is None:
                continue
            caught = float(np.nansum(terms.removal[name] * terms.steady * terms.masses))
            if caught * SOON <= oil_filter.capacity:
                continue
            hours = number(oil_filter.capacity / caught / HOUR, 2)
            out.append(
                Note(
                    f"so much dirt enters that {name} is full with "
                    f"{value_of(oil_filter.capacity, 'kg')} every {hours} h, where "
                    "filters last for months: codes and dents are those of an oil that hardly "
                    "anyone has",
                    code="life.ingress",
                    action="check the unit of the rate (mg/h or g/h); from reports, check volume, "
                    "flow and β of the study, as the ingress is wrong by as much as they are",
                )
            )
        return out


_TUPLES: dict[str, type[Any]] = {
    "start": OilDirt,
    "ingress": Ingress,
    "filters": Filter,
    "fresh_oil": OilDirt,
}
"""Fields that hold several, and what of."""
