"""One particle squeezed between two surfaces at any squeeze: makes `data/deep_squeeze.json`.

    python benchmarks/deep.py --quick           three points again, about two minutes
    python benchmarks/deep.py --runs FOLDER     all curves, one file each; those there stay
    python benchmarks/deep.py --write FOLDER    the table from these files
    python benchmarks/deep.py --again FOLDER    other runs beside the table, and in its errors

The computation is in `benchmarks/squeeze`.
"""

from __future__ import annotations

import argparse
import ast
import dataclasses
import hashlib
import json
import math
import sys
import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from squeeze import squeeze
from squeeze.shapes import Case

Array = NDArray[np.float64]

TABLE = Path(__file__).parent.parent / "src" / "thirdbody" / "data" / "deep_squeeze.json"
EPSILON = [round(0.05 * k, 2) for k in range(1, 20)]
RATIOS = (math.inf, 5.0, 3.0, 2.0, 1.4, 1.0, 0.7, 0.5, 0.0)
FRICTION = (1.0, 0.2, 0.0)
MODULI = {11: 28.5, 31: 80.0, 77: 200.0}
"""E*/H and E/Y: E* = E/(1 - 0.3²) beside a rigid body, H = 2.84 Y."""
FINER = {
    "grid": ({"fine": 1.6}, 1 / (1 - 1 / 1.6)),
    "step": ({"step": 0.004}, 2.0),
    "domain": ({"domain": 12.0}, 1.8),
}
"""What an error is read from: a run refined so, and what its difference is multiplied by.

Richardson: a difference at h and h/1.6 of an error ~ h, at Δε and Δε/2 of an error ~ Δε, at
domains L and 1.5 L of an error ~ 1/L² is that part of the whole error.
"""
PROBES = (math.inf, 1.0, 0.0)
FLOOR = 0.01
"""Least relative error said of any load or area: stopping of the solver, interpolation."""
ELASTIC_FLOOR = 0.05
"""Least relative error said of loads and areas of elastic bodies.

A run with steps 1.5 times and triangles at the edge 2.5 times as large differed by 2 % at most up
to ε = 0.2 (rigid particle, E/Y = 80).
"""
INDEPENDENT = {
    "load": {
        (math.inf, 1.0): {0.2: 4.49, 0.3: 6.36, 0.5: 9.10},
        (3.0, 1.0): {0.2: 4.56, 0.5: 9.43},
        (2.0, 1.0): {0.2: 4.32, 0.5: 8.53},
        (1.4, 1.0): {0.2: 2.89, 0.5: 5.86},
        (1.0, 1.0): {0.2: 2.05, 0.5: 4.18},
        (0.0, 0.2): {0.5: 3.89},
        (math.inf, 0.0): {0.2: 3.8, 0.5: 6.7},
    },
    "area": {
        (math.inf, 1.0): {0.1: 0.240, 0.2: 0.442, 0.3: 0.639, 0.5: 0.863},
        (0.0, 0.2): {0.05: 0.121, 0.1: 0.220, 0.2: 0.378, 0.3: 0.528, 0.5: 0.963},
    },
}
"""Loads and areas of another computation, made outside this project, by (ρ, m) and ε.

Same model: rigid-plastic, triangles made anew, welded where m = 1; another code. Its RMS difference
is part of every error.
"""
QUICK = ((math.inf, 1.0, 0.2), (0.0, 0.2, 0.5), (1.0, 1.0, 0.2))
"""ρ, m and ε of the points of --quick."""


def name(case: Case) -> str:
    """Name of a case's file: what differs from the plainest case."""
    plain = Case(rho=case.rho)
    parts = [f"rho={case.rho:g}", f"m={case.m:g}"]
    for field in dataclasses.fields(Case)[2:]:
        value = getattr(case, field.name)
        if value != getattr(plain, field.name):
            parts.append(f"{field.name}={value:g}" if field.name != "both" else "one-sided")
    return ",".join(parts)


def cases() -> list[Case]:
    """All curves of the table, those most needed first."""
    out = [Case(rho, m) for m in FRICTION for rho in RATIOS]
    out.append(Case(math.inf, 1.0, both=False))
    for rho in PROBES:
        out += [Case(rho, 1.0, **change) for change, _ in FINER.values()]
    return out


def elastic_cases() -> list[Case]:
    """Curves with elastic bodies."""
    return [Case(rho, 1.0, modulus=e) for e in MODULI.values() for rho in (math.inf, 2.0, 1.0)]


def run(case: Case, until: float) -> dict:
    """States of one curve, with the time it took and why it ended early, if it did."""
    rows: list[dict] = []
    start, reason = time.process_time(), None
    try:
        for state in squeeze.Squeezing(case).run(until):
            rows.append(dataclasses.asdict(state))
    except (squeeze.mesh.MeshError, np.linalg.LinAlgError, RuntimeError, AssertionError) as error:
        reason = f"{type(error).__name__}: {error}"
    return {
        "case": _plain(dataclasses.asdict(case)),
        "rows": rows,
        "ended": reason,
        "cpu_seconds": round(time.process_time() - start, 1),
    }


def _plain(values: dict) -> dict:
    """Numbers that JSON has: infinity as a word."""
    return {k: ("inf" if isinstance(v, float) and math.isinf(v) else v) for k, v in values.items()}


def at(rows: list[dict], key: str, epsilon: list[float]) -> Array:
    """A quantity at squeezes, between solved moments; NaN beyond the last."""
    e = np.array([row["squeeze"] for row in rows])
    y = np.array([row[key] for row in rows])
    log = key in ("load", "area")
    found = PchipInterpolator(e, np.log(y) if log else y, extrapolate=False)(epsilon)
    return np.exp(found) if log else found


def onset(rows: list[dict]) -> float | None:
    """Squeeze at which collars first carry load: the middle of that step; None: never."""
    for a, b in zip(rows, rows[1:], strict=False):
        if b["collar"] > 1e-4:
            return (a["squeeze"] + b["squeeze"]) / 2
    return None


def differences(folder: Path) -> dict[str, float]:
    """RMS relative difference of loads and areas from the independent computation."""
    out = {}
    for key, curves in INDEPENDENT.items():
        parts = []
        for (rho, m), values in curves.items():
            found = read(folder, Case(rho, m))
            if found is not None:
                own = at(found["rows"], key, list(values))
                parts.extend(own / np.array(list(values.values())) - 1)
        out[key] = float(np.sqrt(np.mean(np.square(parts))))
    return out


def errors(folder: Path, key: str) -> Array:
    """Error of a quantity at each ε, relative for loads and areas: largest over the probes.

    Parts of `FINER`, and the difference from the independent computation, added in squares.
    """
    worst = np.zeros(len(EPSILON))
    relative = key in ("load", "area")
    for rho in PROBES:
        base = at(read(folder, Case(rho, 1.0))["rows"], key, EPSILON)
        total = np.zeros(len(EPSILON))
        for _, factor, found in refined(folder, rho):
            part = factor * (at(found["rows"], key, EPSILON) - base) / (base if relative else 1.0)
            total += np.nan_to_num(part) ** 2
        worst = np.fmax(worst, np.sqrt(total))
    if not relative:
        return np.maximum(worst, 1e-3)
    return np.hypot(np.maximum(worst, FLOOR), differences(folder)[key])


def onset_error(folder: Path) -> float:
    """Error of the squeeze at which collars touch: that of a rigid particle's."""
    base = onset(read(folder, Case(math.inf, 1.0))["rows"])
    total = Case(1.0).step ** 2
    for _, factor, found in refined(folder, math.inf):
        total += (factor * (onset(found["rows"]) - base)) ** 2
    return math.sqrt(total)


def refined(folder: Path, rho: float) -> list[tuple[str, float, dict]]:
    """Refined runs of one ρ that are there: what is refined, its factor, its file."""
    found = [
        (word, factor, read(folder, Case(rho, 1.0, **change)))
        for word, (change, factor) in FINER.items()
    ]
    return [(word, factor, run) for word, factor, run in found if run is not None]


def read(folder: Path, case: Case) -> dict | None:
    """A curve's file, or None."""
    path = folder / f"{name(case)}.json"
    return json.loads(path.read_text("utf-8")) if path.exists() else None


def upper_bound(folder: Path, case: Case) -> Array | None:
    """ρ times the load between platens (EPSILON,), for particles that hardly sink: ρ <= 1.4."""
    if not 0 < case.rho <= 1.4 or math.isfinite(case.modulus):
        return None
    return case.rho * at(read(folder, Case(0.0, case.m))["rows"], "load", EPSILON)


def sound(case: Case, rows: list[dict]) -> list[dict]:
    """States up to the first in which more lies between the faces than the particle has.

    A (1 - ε) <= 2/3, as long as its faces are not pushed below the planes of the surfaces.
    """
    if not case.particle_deforms or math.isfinite(case.modulus):
        return rows
    bad = [k for k, row in enumerate(rows) if row["area"] * (1 - row["squeeze"]) > 0.67]
    return rows[: bad[0]] if bad else rows


def curve(
    case: Case, rows: list[dict], error: dict[str, Array], touch_error: float, platens: Array | None
) -> dict:
    """One curve of the table; platens: ρ times the load between platens, an upper bound."""
    load, area = at(rows, "load", EPSILON), at(rows, "area", EPSILON)
    sink = np.maximum(at(rows, "sink", EPSILON), 0.0)
    collar = np.clip(at(rows, "collar", EPSILON), 0.0, 1.0)
    if not (case.particle_deforms and case.surface_deforms):
        error = error | {"sink": 0.0 * sink}  # prescribed
    if math.isfinite(case.modulus):
        error = error | {k: np.fmax(error[k], ELASTIC_FLOOR) for k in ("load", "area")}
    touch = onset(rows)
    load_error = load * error["load"]
    if platens is not None:
        load_error = np.where(load > platens, np.fmax(load_error, load - platens), load_error)
    columns = {
        "F": load,
        "F_error": load_error,
        "A": area,
        "A_error": area * error["area"],
        "sink": sink,
        "sink_error": error["sink"] + 0.0 * sink,
        "collar": collar,
        "collar_error": np.where(collar > 0, error["collar"], 0.0) + 0.0 * collar,
    }
    return {
        **_plain({"rho": case.rho, "m": case.m, "E_over_Y": case.modulus}),
        "surfaces": 2 if case.both else 1,
        **{k: [_short(v) for v in column] for k, column in columns.items()},
        "collar_onset": touch and round(touch, 4),
        "collar_onset_error": touch and round(touch_error, 4),
        "volume_mended": round(rows[-1]["mended"], 4),
        "last_eps": round(rows[-1]["squeeze"], 4),
    }


def _short(value: float) -> float | None:
    return None if math.isnan(value) else float(f"{value:.5g}")


def source_hash() -> str:
    """SHA-256 of what is computed: the package's statements, without docstrings and checks."""
    total = hashlib.sha256()
    for path in sorted((Path(__file__).parent / "squeeze").glob("*.py")):
        if path.name in ("__init__.py", "checks.py"):
            continue
        tree = ast.parse(path.read_text("utf-8"))
        for node in ast.walk(tree):
            body = getattr(node, "body", None)
            if isinstance(body, list):
                node.body = [n for n in body if not _is_words(n)] or [ast.Pass()]
        total.update(ast.unparse(tree).encode())
    return total.hexdigest()


def _is_words(node: ast.stmt) -> bool:
    """Whether a statement is a docstring."""
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


def table(folder: Path) -> dict:
    """The table from the files of a folder."""
    error = {k: errors(folder, k) for k in ("load", "area", "sink", "collar")}
    touch_error = onset_error(folder)
    plain = [c for c in cases() if c == Case(c.rho, c.m, both=c.both)]
    found = [(case, read(folder, case)) for case in plain + elastic_cases()]
    base = Case(1.0)
    return {
        "title": "One particle of radius R squeezed between two equal surfaces",
        "quantities": {
            "eps": "squeeze 1 - g/(2R), g the distance of the surfaces' planes; with one surface"
            " the depth over R",
            "rho": "yield stress of the particle over the surfaces'; inf: rigid particle; 0: rigid"
            " surfaces (platens)",
            "m": "friction factor: shear stress of faces that touch over Y/sqrt(3) of the weaker"
            " body; 1: rough, as good as welded",
            "E_over_Y": "Young's modulus of what deforms over the surfaces' yield stress (Poisson's"
            " ratio 0.3); inf: rigid-plastic",
            "F": "load over Y_s R^2 (rho = 0: over Y_p R^2), collars with it",
            "A": "contact area of particle and one surface, seen from above, over pi R^2",
            "sink": "depth of the particle's top below the plane of the surface, over R",
            "collar": "part of F through the collars of the surfaces, which touch each other",
            "collar_onset": "eps at which the collars first touch; null: not up to 0.95",
        },
        "provenance": {
            "script": "benchmarks/deep.py",
            "sha256": source_hash(),
            "method": "axisymmetric von Mises flow of least power; quadratic velocities with a"
            " bubble and linear pressures on triangles made anew at each step; faces slide with"
            " friction m k; boundaries moved by the flow, contact where they meet",
            "triangle_at_edge": base.edge,
            "grading": squeeze.mesh.GRADE,
            "largest_step": base.step,
            "domain": base.domain,
            "rest_rate": base.rest,
            "tolerance": base.tolerance,
        },
        "errors": "triangles, step and domain refined for rho = inf, 1 and 0 at m = 1, parts added"
        " in squares, the largest of the three for all curves; RMS difference from an independent"
        " computation (independent_rms) added in squares; for rho <= 1.4 at least what F exceeds"
        " rho times the load between platens; elastic ones 5 % at least. Of the computation, not of"
        " the model",
        "independent_rms": {k: round(v, 4) for k, v in differences(folder).items()},
        "eps": EPSILON,
        "refined": {f"rho={rho:g}": [word for word, *_ in refined(folder, rho)] for rho in PROBES},
        "curves": [
            curve(c, sound(c, f["rows"]), error, touch_error, upper_bound(folder, c))
            for c, f in found
            if f
        ],
    }


def with_again(data: dict, folder: Path) -> dict:
    """The table with a second computation of its curves: beside each number, and in its error."""
    for found in data["curves"]:
        rho, modulus = float(found["rho"]), float(found["E_over_Y"])
        run = read(folder, Case(rho, found["m"], modulus, both=found["surfaces"] == 2))
        if run is None:
            continue
        for column, key in (("F", "load"), ("A", "area"), ("sink", "sink")):
            second = [_short(value) for value in np.maximum(at(run["rows"], key, EPSILON), 0.0)]
            found[f"{column}_again"] = second
            errors = found[f"{column}_error"]
            for i, (one, two) in enumerate(zip(found[column], second, strict=True)):
                if one is not None and two is not None:
                    errors[i] = max(errors[i], _short(abs(two - one)) or 0.0)
    return data


def quick() -> int:
    """Three points again; 1 where one is outside 5 %."""
    stored = json.loads(TABLE.read_text("utf-8"))
    bad = 0
    for rho, m, epsilon in QUICK:
        rows = run(Case(rho, m), epsilon + 1e-3)["rows"]
        load = float(at(rows, "load", [epsilon])[0])
        key = "inf" if math.isinf(rho) else rho
        held = next(
            c for c in stored["curves"]
            if (c["rho"], c["m"], c["E_over_Y"], c["surfaces"]) == (key, m, "inf", 2)
        )  # fmt: skip
        known = held["F"][stored["eps"].index(epsilon)]
        off = load / known - 1
        bad += abs(off) > 0.05
        print(
            f"rho = {rho:g}, m = {m:g}, eps = {epsilon:g}: F = {load:.4g}, "
            f"table {known:.4g}, {off:+.2%}"
        )
    return int(bad > 0)


def main() -> int:
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--quick", action="store_true")
    words.add_argument("--runs", type=Path)
    words.add_argument("--part", default="0/1", help="k/n: every n-th curve from the k-th")
    words.add_argument("--elastic", action="store_true")
    words.add_argument("--write", type=Path)
    words.add_argument("--again", type=Path)
    options = words.parse_args()
    if options.runs:
        options.runs.mkdir(parents=True, exist_ok=True)
        first, every = map(int, options.part.split("/"))
        for case in (elastic_cases() if options.elastic else cases())[first::every]:
            path = options.runs / f"{name(case)}.json"
            if not path.exists():
                found = run(case, 0.952)
                path.write_text(json.dumps(found), "utf-8")
                print(name(case), found["cpu_seconds"], found["ended"] or "", flush=True)
    if options.write:
        TABLE.write_text(json.dumps(table(options.write), indent=1) + "\n", "utf-8")
    if options.again:
        data = with_again(json.loads(TABLE.read_text("utf-8")), options.again)
        TABLE.write_text(json.dumps(data, indent=1) + "\n", "utf-8")
    return quick() if options.quick else 0


if __name__ == "__main__":
    sys.exit(main())
