"""What a sweep solves: plan, blocks, tasks, and how they are stored."""

from __future__ import annotations

import dataclasses
import hashlib
import itertools
import json
import math
import warnings
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...contact.citations import cite
from ...contact.contact import Contact
from ...equilibrium.columns import CODE, about, labels_of
from ...equilibrium.crowding import AREA, about_area, chi_of
from ...equilibrium.doubts import SHADOW, about_hardness, about_particles
from ...equilibrium.load import as_load
from ...equilibrium.modes import MODES
from ...equilibrium.solve import solve
from ...equilibrium.states import state_columns, vary_contact
from ...equilibrium.status import WORDS as STATUS_WORDS
from ...equilibrium.status import Status
from ...errors import RangeWarning, code_of
from ...numerics.sampling import DESIGNS, Span
from ...quantities.record import VERSION, Record, flags_of
from ...quantities.sharing import need_version
from ...quantities.value import Value
from .reduction import Reduction

__all__ = ["Block", "Layout", "Plan", "Task"]

Arrays = dict[str, NDArray[Any]]
Box = tuple[slice, ...]

CHUNK = 262_144
"""States of a block: the most that are lost when a run is killed, and written at once."""
LOOKED_AT = 200
"""States whose inputs are looked at before a run."""
CODES = {
    "mode": ("none", *(mode.replace("-", "") for mode in MODES)),
    "status": STATUS_WORDS,
}
"""Words of the columns that are stored as codes 0, 1, 2 ... (CF ``flag_meanings``)."""
STORED = {"mode": "i1", "status": "i1", "iterations": "i2"}
"""Stored types, other than 8-byte floats."""


# -------------------------------------------------------------------------- which states
@dataclass(frozen=True, eq=False)
class Listed(Record):
    """A dimension along which inputs take listed values."""

    in_dict = (("", lambda axis: {n: _axis_values(v) for n, v in axis.values.items()}),)
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

    def cut(self, places: slice) -> Listed:
        cut = {name: values[places] for name, values in self.values.items()}
        return Listed(self.name, cut, self.start + places.start)

    def inputs(self) -> Arrays:
        return self.values


@dataclass(frozen=True, eq=False)
class Sampled(Record):
    """A dimension along which inputs are sampled from ranges."""

    in_dict = ("design", ("samples", "count"), "seed", ("", "spans"))
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

    def cut(self, places: slice) -> Sampled:
        ends = {"start": self.start + places.start, "stop": self.start + places.stop}
        return dataclasses.replace(self, **ends)

    def inputs(self) -> Arrays:
        draw = DESIGNS[self.design]
        u = draw(self.count, len(self.spans), self.seed, self.start, self.stop)
        return {name: span.values_at(u[:, j]) for j, (name, span) in enumerate(self.spans.items())}


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
        for changes, which in _split_by_words(words, len(loads)):
            contact = vary_contact(self.contact, changes) if changes else self.contact
            load = as_load(self.load, loads[which])
            vary = {name: values[which] for name, values in numbers.items()}
            for name, column in state_columns(contact, **load, vary=vary or None).items():
                if name not in out:
                    kind = object if column.dtype.kind in "UO" else column.dtype
                    out[name] = np.empty(len(loads), dtype=kind)
                out[name][which] = column
        return {name: column.reshape(self.sizes) for name, column in out.items()}

    def sampled_inputs(self, kept: int) -> Arrays:
        """Inputs drawn along the first dimensions, so many of which are kept.

        They are made by whichever block comes first along the others.
        """
        out: Arrays = {}
        for dim in self.dims[:kept]:
            if isinstance(dim, Sampled) and all(d.start == 0 for d in self.dims if d != dim):
                out |= dim.inputs()
        return out

    def parts(self, most: int) -> Iterator[tuple[Box, Block]]:
        """The block in boxes of at most so many states."""
        for box in _boxes(self.sizes, _box(self.sizes, most)):
            yield box, self.cut(box)

    def cut(self, box: Box) -> Block:
        dims = tuple(dim.cut(s) for dim, s in zip(self.dims, box, strict=True))
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

    def __call__(self) -> tuple[Arrays, dict[str, object]]:
        """The arrays to store, and a summary: states, unsolved states, largest area, shadow."""
        need_version(self.version, "sweep")
        needed = dict.fromkeys((*self.columns, "status", CODE, "engine", "A_t", "shadow"))
        solved: Arrays = {}
        for box, block in self.block.parts(CHUNK):
            columns = block.solve()
            for name in needed:
                if name not in solved:
                    solved[name] = np.empty(self.block.sizes, dtype=columns[name].dtype)
                solved[name][box] = columns[name]
        summary: dict[str, object] = {
            "states": math.prod(self.block.sizes),
            "unsolved": int(np.sum(solved[CODE] != Status.OK)),
            "A_t": _largest(solved["A_t"]),
            "shadow": _largest(solved["shadow"]),
            "engine": dict(Counter(solved["engine"].ravel().tolist())),
        }
        if self.reduction is not None:
            kept = {name: solved[name] for name in (*self.columns, "status")}
            return self.reduction.reduce_samples(kept, self.outer), summary
        out = {name: solved[name] for name in self.columns}
        if self.coded:
            if "mode" in out:
                out["mode"] = _mode_codes(out["mode"])
            if "status" in out:
                out["status"] = solved[CODE]
        elif "status" in out:
            out[CODE] = solved[CODE]
        return out | self.block.sampled_inputs(len(self.block.dims)), summary


@dataclass(frozen=True)
class Layout:
    """The data set that a plan makes, without its numbers."""

    sizes: dict[str, int]
    chunks: dict[str, int]
    variables: dict[str, tuple[tuple[str, ...], str, Mapping[str, object]]]
    """Dimensions, type and attributes of every variable that blocks write."""
    coords: dict[str, tuple[tuple[str, ...], NDArray[Any], Mapping[str, object]]]
    """Dimensions, values and attributes of every coordinate known beforehand."""
    inputs: tuple[str, ...]
    """Those of the variables that are coordinates: sampled inputs."""
    attrs: dict[str, object]


@dataclass(frozen=True, eq=False)
class Plan(Record):
    """Which states there are, what is kept of them, and how they are cut into blocks.

    As plain data it is everything that decides the numbers.
    """

    in_dict = (
        *(VERSION, "contact", "load"),
        ("vary", lambda plan: {axis.name: axis for axis in plan.dims}),
        # a mapping forgets its order, which decides the samples of an input and the blocks
        ("order", lambda plan: [name for axis in plan.dims for name in axis.names]),
        *("columns", ("reduce", "reduction"), "chunk"),
    )
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
        """Slices of a block along each dimension."""
        place = np.unravel_index(number, self.grid)
        sizes = zip(place, self.box, self.whole.sizes, strict=True)
        return tuple(slice(int(i) * b, min((int(i) + 1) * b, n)) for i, b, n in sizes)

    def task(self, number: int, *, coded: bool) -> Task:
        from ...version import __version__

        block = self.whole.cut(self.region(number))
        return Task(block, self.columns, self.reduction, self.outer, coded, __version__)

    def reduce_parts(self, first: int, parts: Iterable[Arrays]) -> Arrays:
        """What is kept of the blocks of a cell, of which this is the first, and its inputs."""
        assert self.reduction is not None
        kept = self.reduction.result(self.reduction.merge_parts(list(parts)))
        return kept | self.whole.cut(self.region(first)).sampled_inputs(self.outer)

    def layout(self) -> Layout:
        from ...version import __version__

        kept = self.dims[: self.outer]
        names = tuple(dim.name for dim in kept)
        sizes = {dim.name: dim.size for dim in kept}
        variables: dict[str, tuple[tuple[str, ...], str, Mapping[str, object]]] = {}
        coords: dict[str, tuple[tuple[str, ...], NDArray[Any], Mapping[str, object]]] = {}
        for dim in kept:
            for name in dim.names:
                about = labels_of(self.contact, name)
                if isinstance(dim, Listed):
                    coords[name] = ((dim.name,), _axis_text(dim.values[name]), about)
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
        """Notes on the validity of the model for some states, evenly spread.

        Raises
        ------
        InvalidValue
            One of these states has inputs that the library refuses.
        """
        sentences: dict[str, str] = {}
        hardest: tuple[float, float, Contact] | None = None
        for load, contact in self.looked_at():
            sign = -1 if self.load == "d" else 1
            if hardest is None or sign * load > hardest[0]:
                hardest = sign * load, load, contact
            for sentence in (*about_hardness(contact), *about_particles(contact)):
                sentences.setdefault(code_of(sentence), sentence)
        if hardest is not None:
            _, load, contact = hardest
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", RangeWarning)
                state = solve(contact, **as_load(self.load, np.array([load])))
            for sentence in state.warnings:
                sentences.setdefault(code_of(sentence), sentence)
        return list(sentences.values())

    def looked_at(self) -> Iterator[tuple[float, Contact]]:
        """Load and contact of some states, evenly spread."""
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
            yield load, vary_contact(self.contact, inputs)


OF_STATES = (AREA, SHADOW.code)
"""Codes of notes that a finished run makes of all of its states."""


def all_notes(plan: Plan, notes: list[str], summary: Mapping[str, Any]) -> list[str]:
    """The sentences of a finished run: about its inputs, and about its states."""
    out = [note for note in notes if code_of(note).partition(".")[0] not in OF_STATES]
    chi = [chi_of(contact) for _, contact in plan.looked_at()]
    out += about_area(plan.contact, summary["A_t"], chi)
    if summary["shadow"] >= 1:
        out.append(SHADOW)
    return out


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


def _split_by_words(
    words: Arrays, count: int
) -> Iterator[tuple[dict[str, object], slice | NDArray[np.intp]]]:
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


def _mode_codes(words: NDArray[np.object_ | np.str_]) -> NDArray[np.int8]:
    return sum(
        ((words == mode) * np.int8(code) for code, mode in enumerate(("", *MODES))),
        start=np.zeros(words.shape, np.int8),
    )


def _largest(values: NDArray[np.float64]) -> float:
    return float(np.fmax.reduce(values, axis=None, initial=0.0))


def _axis_values(values: NDArray[Any]) -> object:
    """Values of an axis for JSON: themselves, or their fingerprint when there are many."""
    if values.dtype == object:
        return [v.to_dict() if isinstance(v, Value) else v for v in values]
    if len(values) <= 1000:
        return values.tolist()
    digest = hashlib.sha256(np.ascontiguousarray(values).data).hexdigest()
    ends = {"first": values[0].item(), "last": values[-1].item()}
    return {"values": len(values), **ends, "sha256": digest}


def _axis_text(values: NDArray[Any]) -> NDArray[Any]:
    return values.astype(str) if values.dtype == object else values


def _attributes(name: str) -> dict[str, object]:
    out: dict[str, object] = dict(about(name).labels)
    if name in CODES:
        out |= flags_of(CODES[name])
    return out
