"""Smooth series of the computed curves of one particle: makes `data/deep_series.json`.

    python benchmarks/squeeze_series.py

A curve of the table has the scatter of its mesh, 1 to 3 %. The law wants load and area that rise
smoothly, also between the curves. Each logarithm becomes a polynomial whose slope is a square, in
ln ε/(1 − ε), in which first contact and a thin disc are both nearly straight lines; the root of the
slope is what the law interpolates.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import numpy as np
from numpy.polynomial import Chebyshev
from scipy.optimize import least_squares

DATA = Path(__file__).parents[1] / "src/thirdbody/data"
DEGREE = 6
"""Of the root of the slope."""


def place(eps: np.ndarray) -> np.ndarray:
    """Squeezes of a curve on [−1, 1]."""
    logit = np.log(eps / (1 - eps))
    return 2 * (logit - logit[0]) / (logit[-1] - logit[0]) - 1


def rising_series(s: np.ndarray, y: np.ndarray) -> tuple[float, Chebyshev]:
    """First value and root of the slope of the polynomial nearest to y(s) that never falls."""
    slope = np.maximum(np.gradient(y, s), 1e-3)
    start = Chebyshev.fit(s, np.sqrt(slope), DEGREE, domain=[-1, 1])

    def off(p: np.ndarray) -> np.ndarray:
        return rising(p[0], Chebyshev(p[1:]))(s) - y

    best = least_squares(off, [y[0], *start.coef], xtol=1e-13, ftol=1e-13)
    sign = np.sign(Chebyshev(best.x[1:])(0.0))  # roots of neighbours are to have one sign
    return float(best.x[0]), Chebyshev(sign * best.x[1:])


def rising(first: float, root: Chebyshev) -> Chebyshev:
    """The polynomial of this first value and root of the slope."""
    return (root * root).integ(lbnd=-1) + first


def sinking(eps: np.ndarray, sink: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Sinks at the wanted squeezes that never fall, nor rise faster than the squeeze.

    Beyond the last one that was computed they stay.
    """
    out = np.interp(wanted, eps, np.minimum(sink, eps))
    for i in range(1, len(out)):
        most = out[i - 1] + (wanted[i] - wanted[i - 1])
        out[i] = min(max(out[i], out[i - 1]), most)
    return out


def series_of(table_eps: np.ndarray, curve: dict) -> tuple[dict, float]:
    """The series of a curve, and the largest relative distance of its load from the runs."""
    reached = np.array([value is not None for value in curve["F"]])
    load, area, sink, collar = (
        np.array(curve[name], dtype=float)[reached] for name in ("F", "A", "sink", "collar")
    )
    eps = table_eps[reached]
    s = place(eps)
    own = np.maximum.accumulate(load * (1 - collar))
    columns = {"own": own, "area": np.maximum.accumulate(area)}
    fits = {name: rising_series(s, np.log(values)) for name, values in columns.items()}
    off = np.expm1(rising(*fits["own"])(s) - np.log(own))
    out = {name: curve[name] for name in ("rho", "m", "E_over_Y", "surfaces")}
    out["from"], out["to"] = float(eps[0]), float(eps[-1])
    for name, (first, root) in fits.items():
        out[name] = {"first": round(first, 12), "root": np.round(root.coef, 12).tolist()}
    out["sink"] = np.round(sinking(eps, sink, table_eps), 12).tolist()
    return out, float(np.max(np.abs(off)))


def main() -> None:
    """Reads the table and writes the series beside it."""
    source = (DATA / "deep_squeeze.json").read_text("utf-8")
    table = json.loads(source)
    eps, curves = np.array(table["eps"]), []
    for curve in table["curves"]:
        series, off = series_of(eps, curve)
        curves.append(series)
        print(*(series[key] for key in ("rho", "m", "E_over_Y", "surfaces")), f"{100 * off:.1f} %")
    out = {
        "title": "Series of the curves of deep_squeeze.json in ln eps/(1 - eps) on [from, to]",
        "script": "benchmarks/squeeze_series.py",
        "sha256": hashlib.sha256(source.encode()).hexdigest(),
        "curves": curves,
    }
    (DATA / "deep_series.json").write_text(json.dumps(out, indent=1) + "\n", "utf-8")


if __name__ == "__main__":
    main()
