"""Long work in a process of its own: ``python -m thirdbody.app.worker``.

One JSON object comes in on standard input; lines of JSON go out: {"done": 0.3} while it goes on,
then {"result": ...} or {"problems": [...]}. Nothing but plain data passes either way, so a file
that makes this process misbehave cannot reach the page.
"""

from __future__ import annotations

import dataclasses
import json
import math
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np

from ..quantities import progress
from ..quantities.plain_data import plain_data

if TYPE_CHECKING:
    from ..analysis.uncertainty.propagation import Propagation
    from ..contact.contact import Contact
    from ..study import Study

__all__ = [
    "TASKS",
    "Bands",
    "Designed",
    "Laws",
    "ModeMap",
    "Pressing",
    "Reading",
    "Surface",
    "compare",
    "compare_laws",
    "counter_bins",
    "design",
    "error_bars",
    "explicit",
    "handed_on",
    "in_little",
    "mode_map",
    "roughness",
    "surface",
]

Report = Callable[[float], None]
SECONDS = 300
"""Processor time a task may take."""
MOST_LOADS, MOST_SAMPLES = 10, 256
"""For error bars of outputs."""
MEMORY = 6 * 2**30
"""Bytes a task may use."""


Numbers = list[float | None]
"""As JSON has them: None where there is none."""


class ModeMap(TypedDict):
    """Modes and load shares, a row a size; sizes over σ and loads F*, with σ [m] and E_ss [Pa]."""

    sizes: list[float]
    loads: list[float]
    sigma: float
    E_ss: float
    mode: list[list[int]]
    share: list[Numbers]
    mean: float


class Laws(TypedDict):
    """Results of every asperity law; of each column a row a law."""

    laws: list[str]
    load: str
    loads: list[float]
    columns: dict[str, list[Numbers]]
    conditions: dict[str, Numbers]
    notes: list[str]
    own: str


class Bands(TypedDict):
    """Quantiles of one result over the load and at one, and what each input alone does."""

    of: str
    loads: list[float]
    probabilities: list[float]
    bands: list[Numbers]
    nominal: Numbers
    critical: dict[str, Numbers]
    F_star_at: float
    samples: int
    at: float
    band_at: Numbers
    nominal_at: float | None
    tornado: dict[str, Numbers]
    words: dict[str, str]
    ends: dict[str, list[str]]


class Reading(TypedDict, total=False):
    """How `from_topography` reads a file."""

    cutoff: float
    resolution: float
    spacing: list[float]
    detrend: str
    unit: str
    channel: str


class Designed(TypedDict):
    """The best inputs, and every point that was tried."""

    values: dict[str, str | float]
    objectives: dict[str, float]
    points: dict[str, list[str] | Numbers]
    tolerance: dict[str, tuple[float, float]]
    feasible: bool
    reason: str
    at_bound: list[str]
    active: list[str]


class Picture(TypedDict):
    """Heights for a drawing."""

    heights: list[float] | list[list[float]]
    spacing: list[float]


class Used(TypedDict):
    """The moments of a surface."""

    sigma: float
    R: float
    eta: float
    alpha: float
    sigma_s: float
    y_s: float
    cutoff: float | None


class Surface(TypedDict):
    """A measured surface."""

    picture: Picture
    used: Used
    curve: dict[str, Numbers]
    skewness: float
    kurtosis: float
    warnings: list[str]


class Section(TypedDict):
    """A cut through one small surface."""

    along: list[float]
    height: list[float]
    deformed: list[float]
    size: float
    seat: float
    share: float


class Pressing(TypedDict):
    """One small surface, pressed."""

    h: float
    spacing: float
    pressure: list[list[float]]
    carrying: dict[str, list[float]]
    section: Section
    compared: dict[str, tuple[str, str]]
    headline: str
    warnings: list[str]


def main() -> None:
    """Read one request, do it, write what was found."""
    _limit()
    warnings.simplefilter("ignore")
    request = json.loads(sys.stdin.read())
    out = sys.stdout
    sys.stdout = sys.stderr  # what a reader of instrument files prints is no answer

    def write_line(**line: object) -> None:
        out.write(json.dumps(line, allow_nan=False) + "\n")
        out.flush()

    from ..errors import InvalidValue, ThirdBodyError

    def refuse(*problems: str) -> None:
        write_line(problems=[vars(problem) for problem in InvalidValue(*problems).problems])

    try:
        task = TASKS[request.pop("task")]
        write_line(
            result=plain_data(task(report=lambda fraction: write_line(done=fraction), **request))
        )
    except ThirdBodyError as error:
        refuse(*(getattr(error, "problems", None) or [str(error)]))
    except MemoryError:
        refuse("this needs more memory than the page allows")
    except Exception as error:  # readers of files raise whatever comes to their mind
        refuse(f"this failed: {type(error).__name__}: {error}")


def _limit() -> None:
    """Bounds on memory and processor time, where the system has them."""
    try:
        import resource
    except ImportError:
        return
    # at the first limit the signal says that it was the time, which SIGKILL at the last would not
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 5))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def in_little(task: str, request: dict[str, object]) -> object:
    """A task that is short, without progress."""
    return plain_data(TASKS[task](**request, report=lambda fraction: None))


def _study(study: dict[str, object], folder: str) -> Study:
    from ..study import check

    return check(study, folder=Path(folder))


def _bare(contact: Contact) -> Contact:
    return contact.replace(outputs=())


# ---------------------------------------------------------------------- tasks
def mode_map(
    *, study: dict[str, object], folder: str, sizes: list[float], loads: list[float], report: Report
) -> ModeMap:
    """Contact mode over x_a/σ and F*: index into p-s, hybrid, s-s (−1: none) and load share."""
    from ..equilibrium.solve import solve_untold
    from ..equilibrium.words import MODES
    from ..errors import InvalidValue, ThirdBodyError

    contact = _bare(_study(study, folder).contact)
    (dust,) = contact.populations
    mean = float(dust.diameter.mean_diameter)
    names = list(MODES)
    index: list[list[int]] = []
    share: list[Numbers] = []
    for number, size in enumerate(sizes):
        row: list[int] = [-1] * len(loads)
        shares: Numbers = [math.nan] * len(loads)
        try:
            sizes_there = dust.diameter.scaled(size * contact.roughness.sigma / mean)
            made = contact.replace(particles=dust.replace(diameter=sizes_there))
            state = solve_untold(made, "F_star", np.array(loads))
            row = [names.index(m) if m in names else -1 for m in np.asarray(state.mode).tolist()]
            shares = np.asarray(state.particle_load_share).tolist()
        except (InvalidValue, ThirdBodyError):
            pass  # jammed
        index.append(row)
        share.append(shares)
        report((number + 1) / len(sizes))
    return {
        "sizes": sizes,
        "loads": loads,
        "sigma": contact.roughness.sigma,
        "E_ss": contact.E_ss,
        "mode": index,
        "share": share,
        "mean": mean,
    }


def compare(
    *, study: dict[str, object], folder: str, load: str, loads: list[float], report: Report
) -> Laws:
    """The same interface under every asperity law."""
    contact = _study(study, folder).contact
    report(0.05)
    return compare_laws(contact, load, loads)


def compare_laws(contact: Contact, load: str, loads: list[float]) -> Laws:
    """Every asperity law under these loads."""
    import thirdbody as tb

    from ..equilibrium.load import as_force_load

    contact = _bare(contact)
    table = tb.compare(contact, **as_force_load(load, np.array(loads)))
    laws = [str(law) for law in table.law.values]
    comparison = {
        "laws": laws,
        "load": load,
        "loads": loads,
        "columns": {str(name): table[name].values for name in table.data_vars},
        "conditions": {name: table[name].values for name in ("F_star", "pressure")},
        "notes": table["note"].values if "note" in table.coords else [""] * len(laws),
        "own": table.attrs["own_law"],
    }
    return plain_data(comparison)


def error_bars(
    *,
    study: dict[str, object],
    folder: str,
    load: str,
    loads: list[float],
    at: float,
    of: str,
    samples: int,
    report: Report,
) -> Bands:
    """Bands of one result over the load, and its tornado at the operating load.

    Critical loads do not depend on the load: all of them have one band each.
    """
    import thirdbody as tb

    from ..analysis.assessment import unit_of
    from ..analysis.inputs import words_of
    from ..analysis.uncertainty.inputs import stated_ranges
    from ..analysis.uncertainty.samples import LEAST, costly
    from ..equilibrium.critical_loads import CRITICAL
    from ..equilibrium.load import as_load
    from ..errors import InvalidValue, Mistake
    from ..quantities.say import value_of

    checked = _study(study, folder)
    uncertainty = checked.uncertainty
    inputs = uncertainty.inputs if uncertainty is not None else stated_ranges(checked.contact)
    if not inputs:
        raise InvalidValue(
            "no input is uncertain yet; add one, and what is known of it", code=Mistake.MISSING
        )
    seed = 0 if uncertainty is None else uncertainty.seed
    critical = of in CRITICAL
    if any(of in output.columns for output in checked.contact.outputs):
        # each sample of an output is a contact of its own
        loads, samples = loads[:: len(loads) // MOST_LOADS + 1], min(samples, MOST_SAMPLES)
    if costly(checked.contact, inputs):
        samples = min(samples, LEAST)  # each takes tables of its own, which all loads share
    names = list(CRITICAL) if critical else [of]
    rows, nominal = [], []

    def states_under(value: float) -> Propagation:
        return tb.propagate(
            checked.contact,
            **as_load(load, value),
            vary=inputs,
            samples=samples,
            seed=seed,
            outputs=[*names, "F_star"],
        )

    def report_part(done: int, expected: int) -> None:
        report(0.9 * min(done / expected, 1.0) / (1 if critical else len(loads)))

    for number, value in enumerate([] if critical else loads):
        with progress.count_contacts(samples, None if number else report_part):
            propagated = states_under(value)
        rows.append(propagated.bands[of])
        nominal.append(propagated.nominal[of])
        report(0.9 * (number + 1) / len(loads))
    with progress.count_contacts(samples, report_part if critical else None):
        point = states_under(at)
    report(0.95)
    found_at = {
        "of": of,
        "loads": loads,
        "probabilities": point.probabilities,
        "bands": rows,
        "nominal": nominal,
        "critical": {n: [*point.bands[n], point.nominal[n]] for n in names if critical},
        "F_star_at": point.nominal["F_star"],
        "samples": point.critical_samples if critical else point.samples,
        "at": at,
        "band_at": point.bands[of],
        "nominal_at": point.nominal[of],
        "tornado": point.tornado(of)[of],
        "words": {label: words_of(checked.contact, label) for label in point.inputs},
        "ends": {
            label: [
                value_of(one.quantile(q), unit_of(checked.contact, label)) for q in (0.05, 0.95)
            ]
            for label, one in point.inputs.items()
        },
    }
    return plain_data(found_at)


def design(*, study: dict[str, object], folder: str, report: Report) -> dict[str, object]:
    """The best inputs over a range of loads, as the table [design] asks."""
    from ..study.analyses import design_study

    checked = _study(study, folder)
    report(0.05)
    return design_study(checked).to_dict()


def roughness(*, study: dict[str, object], folder: str, report: Report) -> dict[str, object]:
    """The table [roughness] in numbers, where it names measured files, and what is told of them."""

    base = {"surfaces": {"first": "S45C", "second": "S45C"}, "load": {"F_star": 1e-5}}
    checked = _study(base | study, folder)
    rough = checked.contact.roughness
    heights = rough.heights
    word = heights.name
    numbers = _fields(rough)
    table: dict[str, object] = {k: v for k, v in numbers.items() if isinstance(v, float)}
    table["heights"] = {"name": word} | _fields(heights)
    if rough.ellipticity is not None:
        table["ellipticity"] = _fields(rough.ellipticity)
    return {"roughness": table, "notes": list(checked.notes)}


def _fields(value: Any) -> dict[str, object]:
    every = {item.name: getattr(value, item.name) for item in dataclasses.fields(value)}
    return {name: field_value for name, field_value in every.items() if field_value is not None}


def surface(*, file: str, options: Reading, report: Report) -> Surface:
    """A measured surface: heights for a picture, moments, and their course with the cut-off."""
    from ..populations.measured.topography import from_topography

    topography = from_topography(file if file == "example" else Path(file), **options)
    report(0.4)
    data = topography.to_dict()
    report(0.9)
    heights, used = topography.heights, topography.moments
    steps = tuple(max(1, math.ceil(n / 160)) for n in heights.shape)
    named = ("sigma", "R", "eta", "alpha", "sigma_s", "y_s")
    more = {
        "picture": {
            "heights": heights[tuple(slice(None, None, step) for step in steps)],
            "spacing": [d * step for d, step in zip(topography.spacing, steps, strict=True)],
        },
        "used": {name: getattr(used, name) for name in named} | {"cutoff": topography.cutoff},
        "warnings": list(topography.warnings),
    }
    return plain_data(data | more)


def counter_bins(file: str) -> dict[str, list[float]]:
    """The bins of a particle counter, as a study file writes them."""
    from ..populations.measured.sizes import read_sizes

    bins = read_sizes(file).sizes
    return {"edges": list(bins.edges), "counts": list(bins.counts)}


def explicit(
    *, study: dict[str, object], folder: str, F_star: float, points: int, report: Report
) -> Pressing:
    """One small surface of the study pressed point by point under one load."""
    from ..study.one_surface import one_surface
    from ..views.explicit_words import headline, rows
    from ..views.plot.explicit import section_of

    report(0.1)
    pressed = one_surface(_study(study, folder), F_star, points=points)
    report(0.9)
    maps, bodies = pressed.state.maps, pressed.state.particles
    field = {str(name): maps[name].values for name in maps.data_vars}
    every = {str(name): bodies[name].values for name in bodies.data_vars}
    step = float(maps.attrs["spacing"])
    carries = every["force"] > 0
    total = float(np.sum(field["pressure"])) * step**2 + float(np.sum(every["force"]))
    shown = {name: every[name][carries] for name in ("x", "y", "diameter", "force")}
    pressing = {
        "h": float(maps.attrs["h"]),
        "spacing": step,
        "pressure": field["pressure"],
        "carrying": shown | {"share": shown["force"] / total},
        "section": section_of(field, every, step)._asdict(),
        "compared": rows(pressed, 0),
        "headline": headline(pressed, 0),
        "warnings": list(pressed.warnings),
    }
    return plain_data(pressing)


def handed_on(*, study: dict[str, object], folder: str, report: Report) -> dict[str, object]:
    """What ``thirdbody report`` writes, with the study file at its end."""
    from ..views.report import PARTS
    from ..views.report import report as made
    from .text import to_toml

    stages = _Told(report, len(PARTS) + 1)
    page = made(_study(study, folder), file=to_toml(study), progress=stages)
    stages(PARTS[-1])
    return {"html": page.html()}


class _Told(progress.Stages):
    """How far a work of several parts is, to the page."""

    def __init__(self, report: Report, parts: int):
        super().__init__("")
        self.report, self.parts = report, parts

    def show(self, part: float, more: str) -> None:
        self.report((self.begun + part) / self.parts)

    def tell(self, sentence: str) -> None:
        """The page has no place for it."""


TASKS: dict[str, Callable[..., object]] = {
    "map": mode_map,
    "compare": compare,
    "error bars": error_bars,
    "design": design,
    "surface": surface,
    "roughness": roughness,
    "explicit": explicit,
    "report": handed_on,
}


if __name__ == "__main__":
    main()
