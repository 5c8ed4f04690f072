"""Reductions at the source: what remains of the samples of a cell when they are not stored."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...equilibrium.columns import about
from ...errors import InvalidValue, Mistake, Problem
from ...quantities.record import Record

__all__ = ["Reduction"]

Arrays = dict[str, NDArray[Any]]

KEYS = ("over", "quantiles", "exceed", "extrema", "mean")
SUMS: dict[str, Any] = {
    "count": np.sum,
    "solved": np.sum,
    "sum": np.sum,
    "over": np.sum,
    "min": np.min,
}
SUMS |= {"max": np.max}
"""How the parts of a cell are put together."""


@dataclass(frozen=True)
class Reduction(Record):
    """Reduction of the samples of every cell.

    A state without equilibrium, and a share of nothing (NaN), counts for no statistic; ``solved``
    says which part of the samples was solved.

    Parameters
    ----------
    over : tuple of str
        Dimensions that are reduced; the others make the cells.
    quantiles : tuple of float
        Probabilities; linear interpolation between order statistics, exact.
    exceed : mapping
        A threshold for each of some columns: the share of samples above it.
    extrema, mean : bool
        Smallest and largest value; arithmetic mean.
    """

    over: tuple[str, ...]
    quantiles: tuple[float, ...] = ()
    exceed: tuple[tuple[str, float], ...] = ()
    extrema: bool = False
    mean: bool = False

    @staticmethod
    def read(
        entries: Mapping[str, Any], dims: Mapping[str, Sequence[str]], columns: Sequence[str]
    ) -> Reduction:
        """From what a user writes; ``dims`` are the dimensions and the inputs along each."""
        problems = [
            Problem(
                f"reduce[{key!r}]", f"is not known; it has {', '.join(KEYS)}", code=Mistake.UNKNOWN
            )
            for key in entries
            if key not in KEYS
        ]
        over: list[str] = []
        names = entries.get("over", ["sample"] if "sample" in dims else None)
        if names is None:
            problems.append(
                Problem(
                    "reduce['over']",
                    "is missing: the varied inputs to reduce over",
                    code=Mistake.MISSING,
                )
            )
        for name in [names] if isinstance(names, str) else names or ():
            home = next((dim for dim, inputs in dims.items() if name in (dim, *inputs)), None)
            if home is None:
                varied = ", ".join(dict.fromkeys(n for dim in dims for n in (dim, *dims[dim])))
                problems.append(
                    Problem(
                        "reduce['over']",
                        f"names {name!r}, which is not varied: {varied}",
                        code=Mistake.UNKNOWN,
                    )
                )
            else:
                over.append(home)
        quantiles = tuple(float(q) for q in np.atleast_1d(entries.get("quantiles", ())))
        problems += [
            Problem("reduce['quantiles']", "must be from 0 to 1", f"{q:g}", code=Mistake.RANGE)
            for q in quantiles
            if not 0 <= q <= 1
        ]
        exceed = dict(entries.get("exceed", {}))
        for name, threshold in exceed.items():
            if name not in columns:
                rule = f"names {name!r}, which is not among the columns {', '.join(columns)}"
                problems.append(Problem("reduce['exceed']", rule, code=Mistake.UNKNOWN))
            elif isinstance(threshold, bool) or not isinstance(threshold, (int, float)):
                problems.append(
                    Problem(
                        f"reduce['exceed'][{name!r}]",
                        "must be a number",
                        repr(threshold),
                        code=Mistake.KIND,
                    )
                )
        extrema, mean = entries.get("extrema", False), entries.get("mean", False)
        if not (set(entries) - {"over"}):
            problems.append(
                Problem(
                    "reduce",
                    "keeps nothing: give quantiles, exceed, extrema or mean",
                    code=Mistake.EMPTY,
                )
            )
        if problems:
            raise InvalidValue(*problems)
        return Reduction(
            over=tuple(dim for dim in dims if dim in over),
            quantiles=quantiles,
            exceed=tuple((name, float(value)) for name, value in exceed.items()),
            extrema=bool(extrema),
            mean=bool(mean),
        )

    # ------------------------------------------------------------------ one part of cells
    def reduce_samples(self, columns: Arrays, outer: int) -> Arrays:
        """What is kept of the samples of these cells; the first ``outer`` axes make the cells."""
        out: Arrays = {}
        shape = next(iter(columns.values())).shape[:outer]
        flat = {name: values.reshape(*shape, -1) for name, values in columns.items()}
        ok = flat.pop("status") == "ok"
        out["solved"], out["count"] = ok.sum(-1), np.full(shape, ok.shape[-1])
        thresholds = dict(self.exceed)
        for name, values in flat.items():
            has_value = ~np.isnan(values)
            every = bool(has_value.all())
            out[f"{name}:count"] = has_value.sum(-1)
            if name in thresholds:
                out[f"{name}:over"] = (values > thresholds[name]).sum(-1)
            if self.mean:
                out[f"{name}:sum"] = np.where(has_value, values, 0).sum(-1)
            if self.extrema:
                out[f"{name}:min"] = np.where(has_value, values, np.inf).min(-1)
                out[f"{name}:max"] = np.where(has_value, values, -np.inf).max(-1)
            if self.quantiles:
                out[f"{name}:quantile"] = _quantiles(values, self.quantiles, every)
        return out

    @staticmethod
    def merge_parts(parts: Sequence[Arrays]) -> Arrays:
        """Parts of the same cells, put together."""
        if len(parts) == 1:
            return dict(parts[0])
        return {
            key: SUMS[key.rpartition(":")[2]](np.stack([arrays[key] for arrays in parts]), axis=0)
            for key in parts[0]
        }

    def result(self, arrays: Arrays) -> Arrays:
        """The stored variables."""
        out = {"solved": arrays["solved"] / arrays["count"]}
        for name in (key.removesuffix(":count") for key in arrays if key.endswith(":count")):
            count = arrays[f"{name}:count"]
            with np.errstate(invalid="ignore", divide="ignore"):
                none = np.where(count > 0, 0.0, np.nan)
                if self.mean:
                    out[f"{name}_mean"] = arrays[f"{name}:sum"] / count
                if f"{name}:over" in arrays:
                    out[f"{name}_exceeds"] = arrays[f"{name}:over"] / count
            if self.extrema:
                out[f"{name}_min"] = arrays[f"{name}:min"] + none
                out[f"{name}_max"] = arrays[f"{name}:max"] + none
            if self.quantiles:
                out[f"{name}_quantile"] = arrays[f"{name}:quantile"]
        return out

    def variables(self, columns: Sequence[str]) -> dict[str, tuple[bool, Mapping[str, object]]]:
        """Every stored variable: whether it has quantiles as its last dimension, and attributes."""
        words = {"mean": "mean of the {}", "min": "smallest {}", "max": "largest {}"}
        kinds = ["mean"] if self.mean else []
        kinds += ["min", "max"] if self.extrema else []
        thresholds = dict(self.exceed)
        out: dict[str, tuple[bool, Mapping[str, object]]] = {
            "solved": (False, {"units": "1", "long_name": "share of samples that were solved"})
        }
        for name in columns:
            column = about(name)
            unit = {"units": column.unit, "symbol": column.symbol}
            for kind in kinds:
                words_of = {"long_name": words[kind].format(column.meaning)}
                out[f"{name}_{kind}"] = (False, unit | words_of)
            if name in thresholds:
                said = f"share of samples with {column.symbol} > {thresholds[name]:g}"
                extra = {"units": "1", "long_name": said, "threshold": thresholds[name]}
                out[f"{name}_exceeds"] = (False, extra)
            if self.quantiles:
                words_of = {"long_name": f"quantiles of the {column.meaning}"}
                out[f"{name}_quantile"] = (True, unit | words_of)
        return out


def _quantiles(
    values: NDArray[np.float64], probabilities: tuple[float, ...], every: bool
) -> NDArray[np.float64]:
    if every:
        return np.moveaxis(np.quantile(values, probabilities, axis=-1), 0, -1)
    out = np.full((*values.shape[:-1], len(probabilities)), np.nan)
    for cell in np.ndindex(*values.shape[:-1]):
        numbers = values[cell][~np.isnan(values[cell])]
        if len(numbers):
            out[cell] = np.quantile(numbers, probabilities)
    return out
