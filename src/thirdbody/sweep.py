"""Sweeps: many states of many contacts as one labelled data set.

A `Plan` says which states there are and cuts them into blocks; a block knows everything it needs
to be solved anywhere, any number of times, with the same result.
"""

from __future__ import annotations

import dataclasses
import hashlib
import itertools
import json
import math
import re
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .citations import cite
from .contact import Contact
from .designs import DESIGNS, Span
from .equilibrium import about, about_particles, columns_of, given_load, solve
from .errors import InvalidValue, RangeWarning
from .reduction import Reduction
from .states import solve_states, varied
from .values import Value, problem_with

if TYPE_CHECKING:
    import os

    import xarray
    from distributed import Client

__all__ = ["Block", "Layout", "Plan", "Task", "sweep"]

Arrays = dict[str, NDArray[Any]]
Box = tuple[slice, ...]

CHUNK = 262_144
"""States of a block: the most that are lost when a run is killed, and written at once."""
CELL = 100_000_000
"""Numbers of one cell that may be held in memory for exact quantiles (0.8 GB)."""
LOOKED_AT = 200
"""States whose inputs are looked at before a run."""
LOAD_UNITS = {"F_star": "1", "pressure": "Pa", "d": "m"}
ABSENT = ("particles.diameter.mean", "particles.areal_density")
MODES = ("", "p-s", "hybrid", "s-s")
STATUSES = ("ok", "no_equilibrium_above", "no_equilibrium_below", "no_equilibrium", "jump")
CODES = {
    "mode": ("none", *(mode.replace("-", "") for mode in MODES[1:])),
    "status": STATUSES,
}
"""Words of the columns that are stored as codes 0, 1, 2 ... (CF ``flag_meanings``)."""
STORED = {"mode": "i1", "status": "i1", "iterations": "i2"}
"""Stored types, other than 8-byte floats."""


# -------------------------------------------------------------------------- which states
@dataclass(frozen=True, eq=False)
class Listed:
    """A dimension along which inputs take listed values."""

    name: str
    values: Arrays
    start: int = 0

    @property
    def size(self) -> int:
        return len(next(iter(self.values.values())))

    @property
    def names(self) -> tuple[str, ...]:
        """Its inputs, in order."""
        return tuple(self.values)

    def cut(self, part: slice) -> Listed:
        cut = {name: values[part] for name, values in self.values.items()}
        return Listed(self.name, cut, self.start + part.start)

    def inputs(self) -> Arrays:
        return self.values

    def to_dict(self) -> dict[str, Any]:
        return {name: _listed(values) for name, values in self.values.items()}


@dataclass(frozen=True, eq=False)
class Sampled:
    """A dimension along which inputs are sampled from ranges."""

    spans: dict[str, Span]
    design: str
    count: int
    seed: int
    start: int
    stop: int
    name: str = "sample"

    @property
    def size(self) -> int:
        return self.stop - self.start

    @property
    def names(self) -> tuple[str, ...]:
        """Its inputs, in order."""
        return tuple(self.spans)

    def cut(self, part: slice) -> Sampled:
        ends = {"start": self.start + part.start, "stop": self.start + part.stop}
        return dataclasses.replace(self, **ends)

    def inputs(self) -> Arrays:
        draw = DESIGNS[self.design]
        u = draw(self.count, len(self.spans), self.seed, self.start, self.stop)
        return {name: span.at(u[:, j]) for j, (name, span) in enumerate(self.spans.items())}

    def to_dict(self) -> dict[str, Any]:
        own = {"design": self.design, "samples": self.count, "seed": self.seed}
        return own | {name: dataclasses.asdict(span) for name, span in self.spans.items()}


@dataclass(frozen=True, eq=False)
class Block:
    """Some states of a plan: a box along its dimensions."""

    contact: Contact
    load: str
    dims: tuple[Listed | Sampled, ...]

    @property
    def sizes(self) -> tuple[int, ...]:
        return tuple(dim.size for dim in self.dims)

    def inputs(self) -> Arrays:
        """Every input of every state, flat in C order."""
        out = {}
        for axis, dim in enumerate(self.dims):
            shape = [1] * len(self.dims)
            shape[axis] = dim.size
            for name, values in dim.inputs().items():
                out[name] = np.broadcast_to(values.reshape(shape), self.sizes).ravel()
        return out

    def solve(self) -> Arrays:
        """Every column, in the shape of the block."""
        inputs = self.inputs()
        loads = inputs.pop(self.load)
        words = {name: v for name, v in inputs.items() if v.dtype == object}
        numbers = {name: v for name, v in inputs.items() if v.dtype != object}
        out: Arrays = {}
        for changes, which in _alike(words, len(loads)):
            contact = varied(self.contact, changes) if changes else self.contact
            given: dict[str, Any] = {self.load: loads[which]}
            vary = {name: values[which] for name, values in numbers.items()}
            for name, column in solve_states(contact, **given, vary=vary or None).items():
                if name not in out:
                    kind = object if column.dtype.kind in "UO" else column.dtype
                    out[name] = np.empty(len(loads), dtype=kind)
                out[name][which] = column
        return {name: column.reshape(self.sizes) for name, column in out.items()}

    def parts(self, most: int) -> Iterator[tuple[Box, Block]]:
        """The block in boxes of at most so many states."""
        for part in _boxes(self.sizes, _box(self.sizes, most)):
            yield part, self.cut(part)

    def cut(self, part: Box) -> Block:
        dims = tuple(dim.cut(s) for dim, s in zip(self.dims, part, strict=True))
        return dataclasses.replace(self, dims=dims)


@dataclass(frozen=True, eq=False)
class Task:
    """The work on one block: solve it, and keep what is asked for."""

    block: Block
    columns: tuple[str, ...]
    reduction: Reduction | None
    outer: int
    coded: bool
    version: str

    def __call__(self) -> tuple[Arrays, dict[str, Any]]:
        """The arrays to store, and a summary: states, unsolved states, largest area, shadow."""
        from . import __version__

        if self.version != __version__:
            raise InvalidValue(
                f"this worker runs thirdbody {__version__} and the sweep needs {self.version}; "
                "install the same version everywhere"
            )
        needed = dict.fromkeys((*self.columns, "status", "engine", "A_t", "shadow"))
        solved: Arrays = {}
        for part, block in self.block.parts(CHUNK):
            columns = block.solve()
            for name in needed:
                if name not in solved:
                    solved[name] = np.empty(self.block.sizes, dtype=columns[name].dtype)
                solved[name][part] = columns[name]
        summary: dict[str, Any] = {
            "states": math.prod(self.block.sizes),
            "unsolved": int(np.sum(solved["status"] != "ok")),
            "A_t": _largest(solved["A_t"]),
            "shadow": _largest(solved["shadow"]),
            "engine": dict(Counter(solved["engine"].ravel().tolist())),
        }
        if self.reduction is not None:
            kept = {name: solved[name] for name in (*self.columns, "status")}
            return self.reduction.part(kept, self.outer), summary
        out = {name: solved[name] for name in self.columns}
        if self.coded:
            out |= {name: _codes(name, values) for name, values in out.items() if name in CODES}
        for dim in self.block.dims:
            # made by whoever comes first along the other dimensions
            if isinstance(dim, Sampled) and all(d.start == 0 for d in self.block.dims if d != dim):
                out |= dim.inputs()
        return out, summary


@dataclass(frozen=True)
class Layout:
    """The data set that a plan makes, without its numbers."""

    sizes: dict[str, int]
    chunks: dict[str, int]
    variables: dict[str, tuple[tuple[str, ...], str, dict[str, Any]]]
    """Dimensions, type and attributes of every variable that blocks write."""
    coords: dict[str, tuple[tuple[str, ...], NDArray[Any], dict[str, Any]]]
    """Dimensions, values and attributes of every coordinate known beforehand."""
    inputs: tuple[str, ...]
    """Those of the variables that are coordinates: sampled inputs."""
    attrs: dict[str, Any]


@dataclass(frozen=True, eq=False)
class Plan:
    """Which states there are, what is kept of them, and how they are cut into blocks."""

    contact: Contact
    load: str
    dims: tuple[Listed | Sampled, ...]
    columns: tuple[str, ...]
    reduction: Reduction | None
    chunk: int

    @property
    def whole(self) -> Block:
        return Block(self.contact, self.load, self.dims)

    @property
    def outer(self) -> int:
        """Number of dimensions that are kept."""
        return len(self.dims) - (0 if self.reduction is None else len(self.reduction.over))

    @property
    def states(self) -> int:
        return math.prod(self.whole.sizes)

    @property
    def samples(self) -> int:
        """Samples of every combination of the listed inputs, 0 without a sampled design."""
        return sum(dim.count for dim in self.dims if isinstance(dim, Sampled))

    @property
    def box(self) -> tuple[int, ...]:
        """Size of a block along each dimension."""
        return _box(self.whole.sizes, self.chunk)

    @property
    def grid(self) -> tuple[int, ...]:
        """Number of blocks along each dimension."""
        return tuple(-(-n // b) for n, b in zip(self.whole.sizes, self.box, strict=True))

    @property
    def count(self) -> int:
        """Number of blocks."""
        return math.prod(self.grid)

    def region(self, number: int) -> Box:
        """Where a block lies."""
        place = np.unravel_index(number, self.grid)
        sizes = zip(place, self.box, self.whole.sizes, strict=True)
        return tuple(slice(int(i) * b, min((int(i) + 1) * b, n)) for i, b, n in sizes)

    def task(self, number: int, *, coded: bool) -> Task:
        from . import __version__

        block = self.whole.cut(self.region(number))
        return Task(block, self.columns, self.reduction, self.outer, coded, __version__)

    def to_dict(self) -> dict[str, Any]:
        """Everything that decides the numbers, ready for JSON."""
        from . import __version__

        return {
            "version": __version__,
            "contact": self.contact.to_dict(),
            "load": self.load,
            "vary": {dim.name: dim.to_dict() for dim in self.dims},
            # a mapping forgets its order, which decides the samples of an input and the blocks
            "order": [name for dim in self.dims for name in dim.names],
            "columns": list(self.columns),
            "reduce": None if self.reduction is None else dataclasses.asdict(self.reduction),
            "chunk": self.chunk,
        }

    def layout(self) -> Layout:
        from . import __version__

        kept = self.dims[: self.outer]
        names = tuple(dim.name for dim in kept)
        sizes = {dim.name: dim.size for dim in kept}
        variables: dict[str, tuple[tuple[str, ...], str, dict[str, Any]]] = {}
        coords: dict[str, tuple[tuple[str, ...], NDArray[Any], dict[str, Any]]] = {}
        for dim in kept:
            for name in dim.names:
                about = _attributes_of(self.contact, name)
                if isinstance(dim, Listed):
                    coords[name] = ((dim.name,), _shown(dim.values[name]), about)
                else:
                    variables[name] = ((dim.name,), "f8", about)
        inputs = tuple(variables)
        if self.reduction is None:
            for name in self.columns:
                variables[name] = (names, STORED.get(name, "f8"), _attributes(name))
        else:
            if self.reduction.quantiles:
                sizes["quantile"] = len(self.reduction.quantiles)
                levels = np.array(self.reduction.quantiles)
                coords["quantile"] = (("quantile",), levels, {"units": "1"})
            for name, (deep, attrs) in self.reduction.variables(self.columns).items():
                variables[name] = ((*names, "quantile") if deep else names, "f8", attrs)
        attrs = {
            "inputs": json.dumps(self.contact.to_dict(), ensure_ascii=False),
            "version": __version__,
            "citations": cite(self.contact),
        }
        chunks = dict(zip(sizes, self.box[: self.outer], strict=False))
        return Layout(sizes, sizes | chunks, variables, coords, inputs, attrs)

    def notes(self) -> list[str]:
        """What the inputs of some states, evenly spread, say about the model's validity.

        Raises
        ------
        InvalidValue
            One of these states has inputs that the library refuses.
        """
        found: dict[str, str] = {}
        hardest: tuple[float, float, Contact] | None = None
        listed = [1 if isinstance(dim, Sampled) else dim.size for dim in self.dims]
        spread = np.linspace(0, math.prod(listed) - 1, LOOKED_AT).astype(np.int64)
        for i, number in enumerate(spread if self.samples else np.unique(spread)):
            # the first samples: the later ones cost time to come to
            place = np.unravel_index(number, listed)
            at = [
                i % dim.size if isinstance(dim, Sampled) else int(k)
                for dim, k in zip(self.dims, place, strict=True)
            ]
            one = self.whole.cut(tuple(slice(k, k + 1) for k in at)).inputs()
            inputs = {name: values[0] for name, values in one.items()}
            inputs = {k: v.item() if isinstance(v, np.generic) else v for k, v in inputs.items()}
            load = inputs.pop(self.load)
            contact = varied(self.contact, inputs)
            sign = -1 if self.load == "d" else 1
            if hardest is None or sign * load > hardest[0]:
                hardest = sign * load, load, contact
            for sentence in about_particles(contact):
                found.setdefault(_wording(sentence), sentence)
        if hardest is not None:
            _, load, contact = hardest
            given: dict[str, Any] = {self.load: np.array([load])}
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", RangeWarning)
                state = solve(contact, **given)
            for sentence in state.warnings:
                found.setdefault(_wording(sentence), sentence)
        return list(found.values())


def _wording(sentence: str) -> str:
    """A sentence without its numbers, to say it once."""
    return re.sub(r"[\d.e+-]+", "", sentence)


def all_notes(notes: list[str], summary: Mapping[str, Any]) -> list[str]:
    """The sentences of a finished run: about its inputs, and about its states."""
    out = [note for note in notes if not note.startswith(("A_t reaches", "particles shadow"))]
    if summary["A_t"] > 0.2:
        out.append(
            f"A_t reaches {summary['A_t']:.3g}: above 0.2 neighbouring contacts interact, "
            "which this model neglects"
        )
    if summary["shadow"] >= 1:
        out.append("particles shadow the whole area: the area correction was cut at zero")
    return out


# -------------------------------------------------------------------------- making a plan
def make_plan(
    contact: Contact,
    *,
    F_star: Any = None,
    pressure: Any = None,
    d: Any = None,
    vary: Mapping[str, Any] | None = None,
    design: str = "grid",
    samples: int | None = None,
    seed: int = 0,
    columns: Sequence[str] | None = None,
    reduce: Mapping[str, Any] | None = None,
    chunk: int = CHUNK,
) -> Plan:
    """The plan that these arguments describe; see `sweep`."""
    given = {"pressure": pressure, "F_star": F_star, "d": d}
    given = {name: value for name, value in given.items() if value is not None}
    if len(given) != 1:
        names = ", ".join(given) or "none"
        raise InvalidValue(f"give exactly one of pressure, F_star, d; got {names}")
    ((load, loads),) = given.items()
    problems = _not_known("design", design, ("grid", "zip", *DESIGNS))
    entries: dict[str, Any] = dict(vary or {})
    if load in entries:
        raise InvalidValue(f"vary[{load!r}] is the load, which is given already")
    entries[load] = loads
    spans: dict[str, Span] = {}
    listed: Arrays = {}
    for name, entry in entries.items():
        label = load if name == load else f"vary[{name!r}]"
        if isinstance(entry, Mapping) or (design in DESIGNS and isinstance(entry, tuple)):
            if design not in DESIGNS:
                problems.append(
                    f"{label} = {entry!r} is a range to be sampled, which needs design = 'latin' "
                    "or 'sobol'"
                )
                continue
            span, why = _span(label, entry)
            problems += why
            spans |= {name: span} if span else {}
            values = np.array([span.low, span.high]) if span else np.empty(0)
        else:
            values = _as_array(entry)
            if not len(values):
                problems.append(f"{label} is empty; give at least one value")
            listed[name] = values
        problems += _refused(contact, label, name, values) if name != load else []
        if name == load and len(values) and values.dtype != object:
            try:
                given_load(contact, **{"pressure": None, "F_star": None, "d": None, load: values})
            except InvalidValue as error:
                problems += error.problems
        elif name == load and len(values):
            problems.append(f"{load} = {entry!r} must be a number or an array of numbers")
    if design in DESIGNS and not spans and not problems:
        problems.append(
            f"design = {design!r} samples ranges and none is given; a range is (low, high) or "
            "{'low': ..., 'high': ..., 'scale': 'log'}"
        )
    problems += _sampling_problems(design, samples, seed)
    if isinstance(chunk, bool) or not isinstance(chunk, int) or chunk < 1:
        problems.append(f"chunk = {chunk!r} must be a whole number of states, at least 1")
    sizes = {name: len(values) for name, values in listed.items()}
    if design == "zip" and len({size for size in sizes.values() if size != 1}) > 1:
        shown = ", ".join(f"{name} {size}" for name, size in sizes.items())
        problems.append(f"design = 'zip' needs inputs of one length, and got {shown}")
    known = columns_of(contact)
    if columns is not None:
        problems += [p for name in columns for p in _not_known("column", name, known)]
    if problems:
        raise InvalidValue(*problems)

    dims: list[Listed | Sampled]
    if design == "zip":
        length = max(sizes.values())
        together = {name: np.broadcast_to(v, (length,)) for name, v in listed.items()}
        dims = [Listed("state", together)]
    else:
        dims = [Listed(name, {name: values}) for name, values in listed.items()]
        if spans:
            assert samples is not None
            dims.append(Sampled(spans, design, samples, seed, 0, samples))
    kept = tuple(name for name in known if name != load and name in (columns or known))
    if reduce is None:
        return Plan(contact, load, tuple(dims), kept, None, chunk)
    words = ("mode", "status", "iterations", *(() if columns else ("residual",)))
    kept = tuple(name for name in kept if name not in words)
    reduction = Reduction.read(reduce, {dim.name: dim.names for dim in dims}, kept)
    dims.sort(key=lambda dim: dim.name in reduction.over)
    plan = Plan(contact, load, tuple(dims), kept, reduction, chunk)
    return _with_whole_cells(plan) if reduction.quantiles else plan


def _with_whole_cells(plan: Plan) -> Plan:
    """Blocks that hold every sample of a cell, as exact quantiles need."""
    cell = math.prod(plan.whole.sizes[plan.outer :])
    numbers = cell * (len(plan.columns) + 3)
    if numbers > CELL:
        raise InvalidValue(
            f"reduce['quantiles']: a cell has {cell:,} samples of {len(plan.columns)} columns, and "
            f"exact quantiles need them in memory, which holds {CELL:,} numbers; name fewer "
            f"columns, take at most {CELL // 4:,} samples, or leave the quantiles out (mean, "
            "extrema and exceed have no limit)"
        )
    return dataclasses.replace(plan, chunk=max(plan.chunk, cell))


def _span(label: str, entry: Any) -> tuple[Span | None, list[str]]:
    """A range, or what is wrong with it."""
    pair = not isinstance(entry, Mapping)
    keys = {"low": entry[0], "high": entry[-1]} if pair and len(entry) == 2 else {}
    keys = keys if pair else dict(entry)
    if not {"low", "high"} <= set(keys) <= {"low", "high", "scale"}:
        return None, [f"{label} = {entry!r} must be (low, high) or have the keys low, high, scale"]
    low, high, scale = keys["low"], keys["high"], keys.get("scale", "linear")
    problems = _not_known(f"{label} scale", scale, ("linear", "log"))
    for end in (low, high):
        about = {"unit": "SI", "gt": None, "ge": None, "lt": None, "le": None, "hint": ""}
        if problem_with(about, end):
            problems.append(f"{label}: {end!r} must be a finite number in SI units")
    if problems:
        return None, problems
    if not low < high:
        return None, [f"{label}: low = {low:g} must be below high = {high:g}"]
    if scale == "log" and low <= 0:
        return None, [f"{label}: low = {low:g} must be > 0 with scale = 'log'"]
    return Span(float(low), float(high), scale), []


def _sampling_problems(design: str, samples: Any, seed: Any) -> list[str]:
    out = []
    if design in DESIGNS:
        if isinstance(samples, bool) or not isinstance(samples, int) or samples < 1:
            out.append(f"samples = {samples!r} must be a whole number, at least 1")
        elif samples > 2**48:
            out.append(f"samples = {samples:,} must be at most {2**48:,}")
        if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
            out.append(f"seed = {seed!r} must be a whole number, at least 0")
    elif samples is not None:
        out.append(f"samples = {samples!r} goes with design = 'latin' or 'sobol'")
    return out


def _not_known(what: str, word: Any, options: Sequence[str]) -> list[str]:
    if word in options:
        return []
    return [f"{what} = {word!r} must be one of {', '.join(map(repr, options))}"]


def _as_array(entry: Any) -> NDArray[Any]:
    """Numbers as they are; anything else as objects."""
    if isinstance(entry, (str, Value)) or not np.iterable(entry):
        entry = [entry]
    values = list(entry) if not isinstance(entry, np.ndarray) else entry.ravel()
    if isinstance(values, np.ndarray) and values.dtype.kind in "fiub":
        return values
    numbers = (int, float, np.number, np.bool_)
    if len(values) and all(isinstance(value, numbers) for value in values):
        return np.asarray(values)
    out = np.empty(len(values), dtype=object)
    out[:] = values
    return out


def _refused(contact: Contact, label: str, name: str, values: NDArray[Any]) -> list[str]:
    """Numbers that the field never takes; the rest is for the contact to judge."""
    about = _quantity(contact, name)
    if about is None or values.dtype.kind not in "fiu" or not len(values):
        return []
    some = values[values != 0] if name in ABSENT else values
    ends = [] if not len(some) else [some.min(), some.max()]
    bad = [value for value in ends if problem_with(about, value)]
    return [f"{label}: {value:g} {problem_with(about, value)}" for value in bad[:1]]


def _quantity(contact: Contact, name: str) -> dict[str, Any] | None:
    """Symbol, unit and range of an input by its dotted name."""
    path, _, last = name.rpartition(".")
    try:
        owner = contact.part(path)
    except InvalidValue:
        return None
    if not dataclasses.is_dataclass(owner):
        return None
    found = (item.metadata.get("quantity") for item in dataclasses.fields(owner))
    names = [item.name for item in dataclasses.fields(owner)]
    return dict(zip(names, found, strict=True)).get(last)


# -------------------------------------------------------------------------- small parts
def _box(sizes: Sequence[int], most: int) -> tuple[int, ...]:
    """The largest box of at most so many states, whole along the last dimensions."""
    out: list[int] = []
    for size in reversed(sizes):
        out.append(min(size, most))
        most = most // size if most >= size else 1
        most = max(most, 1)
    return tuple(reversed(out))


def _boxes(sizes: Sequence[int], box: Sequence[int]) -> Iterator[Box]:
    cuts = [
        [slice(i, min(i + step, size)) for i in range(0, size, step)]
        for size, step in zip(sizes, box, strict=True)
    ]
    return itertools.product(*cuts)


def _alike(words: Arrays, count: int) -> Iterator[tuple[dict[str, Any], Any]]:
    """States with equal words: those words, and which states."""
    if not words:
        yield {}, slice(None)
        return
    numbers: dict[tuple[str, ...], list[int]] = {}
    shown = {id(value): repr(value) for values in words.values() for value in values}
    for i, key in enumerate(zip(*words.values(), strict=True)):
        numbers.setdefault(tuple(shown[id(value)] for value in key), []).append(i)
    for which in numbers.values():
        yield {name: values[which[0]] for name, values in words.items()}, np.array(which)


def _codes(name: str, words: NDArray[Any]) -> NDArray[np.int8]:
    if name == "mode":
        return sum(
            ((words == mode) * np.int8(code) for code, mode in enumerate(MODES)),
            start=np.zeros(words.shape, np.int8),
        )
    codes = np.zeros(words.shape, np.int8)
    for place in zip(*np.nonzero(words != "ok"), strict=True):
        text = str(words[place])
        jump = text.startswith("jump")
        codes[place] = 4 if jump else 1 if "beyond" in text else 2 if "below the" in text else 3
    return codes


def _largest(values: NDArray[Any]) -> float:
    return float(np.fmax.reduce(values, axis=None, initial=0.0))


def _listed(values: NDArray[Any]) -> Any:
    """Values of an axis for JSON: themselves, or their fingerprint when there are many."""
    if values.dtype == object:
        return [v.to_dict() if isinstance(v, Value) else v for v in values]
    if len(values) <= 1000:
        return values.tolist()
    digest = hashlib.sha256(np.ascontiguousarray(values).data).hexdigest()
    ends = {"first": values[0].item(), "last": values[-1].item()}
    return {"values": len(values), **ends, "sha256": digest}


def _shown(values: NDArray[Any]) -> NDArray[Any]:
    return values.astype(str) if values.dtype == object else values


def _attributes(name: str) -> dict[str, Any]:
    told = about(name)
    out: dict[str, Any] = {"units": told["unit"], "long_name": told["meaning"]}
    out["symbol"] = told["symbol"]
    if name in CODES:
        words = CODES[name]
        out |= {"flag_values": list(range(len(words))), "flag_meanings": " ".join(words)}
    return out


def _attributes_of(contact: Contact, name: str) -> dict[str, Any]:
    """Attributes of an input or load."""
    if name in LOAD_UNITS:
        return _attributes(name) | {"units": LOAD_UNITS[name]}
    about = _quantity(contact, name)
    if about is None:
        return {}
    return {"units": about["unit"], "long_name": about["meaning"], "symbol": about["symbol"]}


# -------------------------------------------------------------------------- sweep
def sweep(
    contact: Contact,
    *,
    F_star: ArrayLike | Mapping[str, Any] | None = None,
    pressure: ArrayLike | Mapping[str, Any] | None = None,
    d: ArrayLike | Mapping[str, Any] | None = None,
    vary: Mapping[str, Any] | None = None,
    design: str = "grid",
    samples: int | None = None,
    seed: int = 0,
    columns: Sequence[str] | None = None,
    reduce: Mapping[str, Any] | None = None,
    out: str | os.PathLike[str] | None = None,
    format: str = "zarr",
    chunk: int = CHUNK,
    workers: int = 1,
    client: Client | None = None,
    progress: bool | Callable[[int], None] = False,
) -> xarray.Dataset:
    """States of a contact over loads and any of its inputs: on a grid, in pairs, or sampled.

    Parameters
    ----------
    contact : Contact
        The inputs that are not varied.
    F_star, pressure, d : array_like or range
        Loads, as in `solve`; exactly one.
    vary : mapping, optional
        Dotted names of fields and the values they take, e.g.
        ``{"particles.diameter.mean": [0, 100e-9, 300e-9]}``. A mean diameter or an areal
        density of zero stands for two-body contact. In a sampled design a tuple ``(low, high)``
        or a mapping ``{"low": ..., "high": ..., "scale": "log"}`` is a range to sample; the same
        goes for the load.
    design : {"grid", "zip", "latin", "sobol"}, optional
        Every combination; the i-th value of every input; or samples of the ranges, the same in
        every combination of the inputs that are listed.
    samples : int, optional
        Number of samples. Sobol points are balanced best in powers of two.
    seed : int, optional
        Of the samples: the same seed gives the same samples.
    columns : sequence of str, optional
        Which columns of `Equilibrium` to keep; all by default.
    reduce : mapping, optional
        Keep only statistics of every cell of the remaining dimensions: ``over``, the inputs to
        reduce over (the samples by default); ``quantiles``, probabilities; ``exceed``, a threshold
        for each of some columns; ``extrema``, ``mean``, True or False.
    out : path-like, optional
        A folder to write to block by block, in bounded memory. A run that was interrupted or
        killed goes on when the same call is made again; a finished one is opened.
    format : {"zarr", "netcdf"}, optional
        Of the data in ``out``.
    chunk : int, optional
        States of a block.
    workers : int, optional
        Threads that solve blocks.
    client : distributed.Client, optional
        An existing Dask cluster that solves the blocks instead; this process writes them.
    progress : bool or callable, optional
        Show rate and time left on standard error; or a function of the number of states solved.

    Returns
    -------
    xarray.Dataset
        One dimension for each listed input, for the load, and for the samples (``sample``) or
        pairs (``state``); every column of `Equilibrium` as a variable with ``units``,
        ``long_name`` and ``symbol``; inputs, version, citations and ``engine``, how many states
        each engine solved and why, as attributes. A state without equilibrium is NaN with its
        reason in ``status``. In ``out``, ``mode`` and ``status`` are codes (``flag_values``,
        ``flag_meanings``), and the data are loaded when they are used.

    Raises
    ------
    InvalidValue
        An unknown name, an empty list, or a value that the field refuses; a folder that another
        run uses, or that holds another study.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> curves = tb.sweep(contact, F_star=[1e-6, 1e-5], vary={"roughness.sigma": [1e-7, 2e-7]})
    >>> curves.A_t.dims
    ('roughness.sigma', 'F_star')
    >>> spread = tb.sweep(contact, pressure=[1e6, 1e7], design="sobol", samples=4,
    ...                   vary={"roughness.R": (2e-6, 4e-6)}, reduce={"quantiles": [0.5]})
    >>> spread.A_t_quantile.dims
    ('pressure', 'quantile')
    """
    from . import streaming

    plan = make_plan(
        contact,
        F_star=F_star,
        pressure=pressure,
        d=d,
        vary=vary,
        design=design,
        samples=samples,
        seed=seed,
        columns=columns,
        reduce=reduce,
        chunk=chunk,
    )
    if isinstance(workers, bool) or not isinstance(workers, int) or workers < 1:
        raise InvalidValue(f"workers = {workers!r} must be a whole number, at least 1")
    if out is None:
        return streaming.in_memory(plan, workers=workers, client=client, progress=progress)
    return streaming.run(
        plan, out, format=format, workers=workers, client=client, progress=progress
    ).open()
