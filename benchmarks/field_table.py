"""Make the table of the law of one field: ``python benchmarks/field_table.py``.

It solves the programme of `thirdbody.laws.field.programme` for surfaces of the library's spectrum
at every separation, hardness and bandwidth of the table, and writes
``src/thirdbody/data/field.npz``. A quarter of an hour on one core; ``--quick`` solves one
bandwidth again and says how far the stored table is from it.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

from thirdbody.laws.field.programme import Edges, Pressed, solve_programme
from thirdbody.laws.field.spectrum import HURST, rolled_off
from thirdbody.laws.field.table import plastic_energy
from thirdbody.version import __version__

DATA = Path(__file__).parents[1] / "src/thirdbody/data/field.npz"
LOW = np.array([-1.0, -0.8, -0.6, -0.4, -0.2, 0.0])
"""Separations for soft surfaces alone."""
HIGH = np.concatenate(
    [[0.2, 0.3, 0.4, 0.55, 0.7, 0.85], np.arange(1.0, 2.0, 0.2), np.arange(2.0, 5.01, 0.25)]
)
CHI = np.array(
    [0.01, 0.02, 0.04, 0.07, 0.11, 0.16, 0.22, 0.3, 0.4, 0.5,
     0.62, 0.76, 0.92, 1.1, 1.3, 1.6, 2.0, 3.0]
)  # fmt: skip
SOFT = 0.5
"""χ up to which the low separations are solved."""
ALPHAS = 7
START = 0.4
TERMS = 400


def alphas() -> np.ndarray:
    """Chebyshev's points in ln α from 2.5 to 30."""
    x = -np.cos(np.pi * np.arange(ALPHAS) / (ALPHAS - 1))
    low, high = np.log([2.5, 30.0])
    return np.exp(0.5 * (low + high) + 0.5 * (high - low) * x)


def first(alpha: float) -> Edges:
    """At h = 2 and χ = 0.4, from what is known of α = 5 by small steps in α."""
    h, none = np.array([2.0]), np.zeros(1, bool)
    edges = Edges(h + 0.27, np.array([-1.2]), np.array([0.2]), none)
    count = 1 + int(abs(np.log(alpha / 5.0)) / 0.25)
    for a in np.geomspace(5.0, alpha, count + 1).tolist():
        edges = solve_programme(rolled_off(a, HURST).series(TERMS), h, START, edges).edges
    return edges


def spread(series, h: np.ndarray, edges: Edges) -> Edges:
    """At every h and χ = 0.4, each begun from those of its neighbours."""
    out = {2.0: edges}
    for way in (sorted(x for x in h if x > 2), sorted((x for x in h if x < 2), reverse=True)):
        known = [(2.0, edges)]
        for goal in way:
            for x in np.linspace(
                known[-1][0], goal, 1 + int(np.ceil(abs(goal - known[-1][0]) / 0.26))
            )[1:]:
                guess = known[-1][1]
                if len(known) > 1:
                    (x0, e0), (x1, e1) = known[-2:]
                    ratio = (x - x1) / (x1 - x0)
                    step = [ratio * (a - b) for a, b in zip(e1[:3], e0[:3], strict=True)]
                    guess = guess.plus(np.stack(step, axis=1))
                known.append((x, solve_programme(series, np.array([x]), START, guess).edges))
            out[goal] = known[-1][1]
    return Edges(*(np.concatenate([out[float(x)][i] for x in h]) for i in range(4)))


def alpha_of(series) -> float:
    return series.spectrum.alpha


def march(series, h: np.ndarray, chis: list[float], edges: Edges) -> dict[float, Pressed]:
    """States at every χ, each begun from those of its neighbours."""
    found = {START: solve_programme(series, h, START, spread(series, h, edges))}
    for way in ([c for c in chis if c > START], [c for c in chis if c < START][::-1]):
        before, now, at = None, found[START].edges, START
        pending = list(way)
        last_at = at
        while pending:
            chi = pending[0]
            guess = now
            if before is not None:
                ratio = np.log(chi / at) / np.log(at / last_at)
                step = ratio * np.stack(
                    [a - b for a, b in zip(now[:3], before[:3], strict=True)], axis=1
                )
                step[:, 1] = np.clip(step[:, 1], -1.0, 1.0)
                guess = now.plus(np.where(now.elastic[:, None], 0.0, step))
            try:
                state = solve_programme(series, h, chi, guess)
            except Exception as error:
                print(alpha_of(series), chi, error, flush=True)
                if abs(np.log(chi / at)) < 0.02:
                    raise
                pending.insert(0, float(np.sqrt(chi * at)))
                continue
            before, now, last_at, at = now, state.edges, at, chi
            pending.pop(0)
            found[chi] = state
    return found


def rows(state: Pressed, chi: float) -> np.ndarray:
    """What is stored of a state: (N, 16)."""
    first_moment = state.moments[:, :1]
    return np.column_stack(
        [
            np.log(state.energy / plastic_energy(state.h, chi)),
            state.low - state.h,
            state.plastic,
            state.edges.tau,
            state.moments[:, 1:] / first_moment,
        ]
    )


def one(alpha: float) -> np.ndarray:
    """All of a bandwidth: (χ, h, columns)."""
    series = rolled_off(alpha, HURST).series(TERMS)
    begun = first(alpha)
    out = np.full((len(CHI), len(LOW) + len(HIGH), 16), np.nan)
    for h, place, most in ((HIGH, slice(len(LOW), None), 10.0), (LOW, slice(0, len(LOW)), SOFT)):
        chis = [float(c) for c in CHI if c <= most]
        found = march(series, h, chis, begun)
        for i, chi in enumerate(CHI.tolist()):
            if chi <= most:
                out[i, place] = rows(found[chi], chi)
    return out


def main() -> int:
    """Write the table, or hold it against one bandwidth solved again."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", type=int, help="index of one bandwidth, kept in a file beside")
    args = parser.parse_args()
    every = alphas()
    if args.quick:
        stored = np.load(DATA)["rows"]
        again = one(float(every[3]))
        print(f"largest difference: {np.nanmax(np.abs(again - stored[3])):.2g}")
        return 0
    if args.only is not None:
        np.save(DATA.with_name(f"field-{args.only}.npy"), one(float(every[args.only])))
        return 0
    made = []
    for i, alpha in enumerate(every.tolist()):
        part = DATA.with_name(f"field-{i}.npy")
        made.append(np.load(part) if part.exists() else one(alpha))
        part.unlink(missing_ok=True)
        print(f"alpha = {alpha:.4g}", flush=True)
    np.savez_compressed(
        DATA, h=np.concatenate([LOW, HIGH]), chi=CHI, alpha=every, rows=np.stack(made),
        about=f"thirdbody {__version__}, benchmarks/field_table.py, Hurst {HURST}, {TERMS} terms",
    )  # fmt: skip
    return 0


if __name__ == "__main__":
    sys.exit(main())
