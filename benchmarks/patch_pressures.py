"""Pressures on the patches of rough surfaces: the law of one field beside maps pressed.

    python benchmarks/patch_pressures.py            # three maps of 512 x 512 points, 10 s
    python benchmarks/patch_pressures.py --maps 6

Of each hardness and load: the real area, the share of it that is pressed with H, and pressures
below which a tenth, a quarter, half … of the real area lie, over their mean.
"""

from __future__ import annotations

import argparse
import math

import numpy as np
from scipy.special import ndtr, ndtri

import thirdbody as tb
from thirdbody.explicit import surface_of
from thirdbody.explicit.press import press
from thirdbody.laws.field import programme
from thirdbody.laws.field.formulas import area, load
from thirdbody.laws.field.table import EDGE, PLASTIC, TAU, FieldSurface, field_of

SIGMA, R, ALPHA, POINTS, STEP = 0.3e-6, 3e-6, 5.0, 512, 0.1e-6
"""Of the surfaces [m], and points of a map along a side and how far apart [m]."""
RATIOS, LOADS = (0.04464, 0.1, 0.17, math.inf), (2e-3, 1e-2)
"""H/E* and F/(A_n E*)."""
SHARES = np.array([0.1, 0.25, 0.5, 0.75, 0.9])
HARDEST = 1e3
"""H/E* in the place of none."""


def of_field(surface: FieldSurface, h: float) -> np.ndarray:
    """Pressures over E*g below which these shares of the area lie: f at edges of the table."""
    columns = surface.columns(np.array([h]))
    low, tau = h + columns[:, EDGE], np.clip(columns[:, TAU], 0.0, 1.0)
    yields = np.clip(columns[:, PLASTIC], 0.0, 1.0) * ndtr(-low)
    elastic = yields < 1e-12
    width = np.log(np.maximum(-ndtri(np.maximum(yields, 1e-300)) - low, 1e-6))
    edges = programme.Edges(low, width, tau, elastic)
    basis = programme._Basis(surface.spectrum.series(programme.TERMS))
    found = basis.state(np.array([h]), np.array([surface.chi]), edges, programme.EDGE)
    theta = np.linspace(0, math.pi, 400)
    modes = np.sin(np.arange(1, programme.MODES + 1)[:, None] * theta)
    f = found.form[0] @ np.concatenate([[theta / math.pi], modes])
    s = low + 0.5 * (edges.high - low) * (1 - np.cos(theta))
    return np.interp(-ndtri((1 - SHARES) * ndtr(-low)), s, f, right=f[-1])


def of_maps(contact: tb.Contact, ratio: float, whole: float, maps: int) -> np.ndarray:
    """Real area, share at H, and pressures over the mean: the mean over maps."""
    rows = []
    for seed in range(maps):
        z = np.array(surface_of(contact, size=POINTS, spacing=STEP, seed=seed).heights)
        total = whole * (POINTS * STEP) ** 2
        cap = np.full(z.shape, ratio)
        found = press(z - z.mean(), STEP, 1.0, c=cap, load=total, tol=1e-5, max_iterations=800)
        p = found.p[found.p > 0]
        at_cap = np.mean(p >= ratio * (1 - 1e-6))
        rows.append([np.mean(found.p > 0), at_cap, *np.quantile(p, SHARES) / p.mean()])
    return np.mean(rows, axis=0)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--maps", type=int, default=3)
    maps = parser.parse_args().maps
    print("| H/(E*g) | F/E* | | A_ss | with H | " + " | ".join(f"{x:.0%}" for x in SHARES) + " |")
    print("|" + "---|" * (5 + len(SHARES)))
    for given in RATIOS:
        ratio = min(given, HARDEST)
        body = tb.Material(E=2 * 112e9 * (1 - 0.09), nu=0.3, H=ratio * 112e9)
        rough = tb.Roughness(sigma=SIGMA, R=R, alpha=ALPHA)
        contact = tb.Contact(surfaces=tb.MaterialPair(body, body), roughness=rough)
        surface = field_of(ratio / rough.slope, ALPHA)
        h = np.linspace(0.25, 4, 2000)
        carried = load(surface, h, remains=True)[:, 0] * rough.slope
        for whole in LOADS:
            here = np.interp(-whole, -carried, h)
            A, yields = area(surface, np.array([here]), remains=True)
            touched = ndtr(-here - surface.columns(np.array([here]))[0, EDGE])
            mean = surface.load(np.array([here]))[0, 0] / touched
            row = [A[0], yields[0], *of_field(surface, float(here)) / mean]
            pressed = of_maps(contact, ratio, whole, maps)
            for name, values in (("field", row), ("pressed", pressed)):
                told = " | ".join(f"{value:.3f}" for value in values)
                print(f"| {given / rough.slope:.3g} | {whole:g} | {name} | {told} |", flush=True)


if __name__ == "__main__":
    main()
