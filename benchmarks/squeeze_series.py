"""Smooth series of the computed curves of one particle, added to the table that the law reads.

    python benchmarks/squeeze_series.py

A curve of the table has the scatter of its mesh, 1 to 3 %. The law wants load and area that rise
smoothly. Each logarithm becomes a polynomial whose slope is a square, in ln ε/(1 − ε), in which
first contact and a thin disc are both nearly straight lines.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from numpy.polynomial import Chebyshev
from scipy.optimize import least_squares

DATA = Path(__file__).parents[1] / "src/thirdbody/data/deep_squeeze.json"
DEGREE = 6
"""Of the root of the slope."""
SHARE_DEGREE = 9


def place(eps: np.ndarray) -> np.ndarray:
    """Squeezes of a curve on [−1, 1]."""
    logit = np.log(eps / (1 - eps))
    return 2 * (logit - logit[0]) / (logit[-1] - logit[0]) - 1


def rising_series(s: np.ndarray, y: np.ndarray) -> Chebyshev:
    """The polynomial nearest to y(s) of those whose slope is a square."""
    slope = np.maximum(np.gradient(y, s), 1e-3)
    start = Chebyshev.fit(s, np.sqrt(slope), DEGREE, domain=[-1, 1])

    def series(p: np.ndarray) -> Chebyshev:
        root = Chebyshev(p[1:])
        return (root * root).integ(lbnd=-1) + p[0]

    best = least_squares(lambda p: series(p)(s) - y, [y[0], *start.coef], xtol=1e-13, ftol=1e-13)
    return series(best.x)


def add_series(curve: dict) -> float:
    """Adds the series to a curve; the largest relative distance of its load from the runs."""
    eps, load = np.array(curve["eps"]), np.array(curve["F"])
    s = place(eps)
    collar = np.array(curve["collar"]) if curve.get("collar") else 0.0 * eps
    own = np.maximum.accumulate(load * (1 - collar))
    columns = {"own": own, "all": np.maximum.accumulate(load), "area": np.array(curve["A"])}
    fits = {name: rising_series(s, np.log(values)) for name, values in columns.items()}
    curve["series"] = {name: np.round(fit.coef, 12).tolist() for name, fit in fits.items()}
    if curve.get("sink"):
        share = np.clip(np.array(curve["sink"]) / eps, 0.0, 1.0)
        fit = Chebyshev.fit(s, share, SHARE_DEGREE, domain=[-1, 1])
        curve["series"]["share"] = np.round(fit.coef, 12).tolist()
    return float(np.max(np.abs(np.expm1(fits["own"](s) - np.log(own)))))


if __name__ == "__main__":
    data = json.loads(DATA.read_text("utf-8"))
    for curve in data["curves"]:
        off = add_series(curve)
        name = [curve[key] for key in ("kind", "rho", "m", "kappa")]
        print(*name, f"{100 * off:.1f} %")
    DATA.write_text(json.dumps(data, indent=0) + "\n", "utf-8")
