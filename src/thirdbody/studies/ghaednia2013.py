"""Ghaednia and Jackson 2013: what the authors say of particles between rough surfaces.

``python -m thirdbody.studies.ghaednia2013`` prints the ledger. Only abstracts could be read: the
statements marked "seen" stand there, the model (`GhaedniaMultiscale`) is a reconstruction, and its
surfaces, sizes and densities were chosen here. A statement that holds therefore supports the
reconstruction; it does not reproduce the paper's numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

import thirdbody as tb

from ..fractal import GhaedniaMultiscale, MajumdarBhushan, NixGao, Stack

__all__ = ["PRESSURES", "STATEMENTS", "Entry", "Statement", "ledger", "model", "surfaces"]

PRESSURES = np.geomspace(1e5, 3e7, 8)
"""Nominal pressures of the trends [Pa]: far from full contact."""
SMALL, HIGH_PRESSURE = 40e-9, 4e8
"""A size [m] and a nominal pressure [Pa] at which the asperities touch between the particles."""


def surfaces() -> dict[str, Stack | MajumdarBhushan]:
    """Steel on steel, bare, as stacked sinusoids and as a fractal (chosen here)."""
    pair = tb.MaterialPair(tb.materials["S45C"], tb.materials["S45C"])
    return {
        "stack": Stack.self_affine(
            hurst=0.8,
            amplitude=100e-9,
            frequency=1e3,
            ratio=2,
            count=8,
            E_star=pair.E_star,
            H=pair.H,
        ),
        "fractal": MajumdarBhushan(D=1.4, G=1e-14, E_star=pair.E_star, H=pair.H, nominal_area=1e-6),
    }


def model(surface: str, size: float = 80e-9, size_effect: bool = False) -> GhaedniaMultiscale:
    """Silica particles on steel.

    Parameters
    ----------
    surface : {"stack", "fractal"}
        One of `surfaces`.
    size : float, optional
        Mean diameter x_a [m]; the standard deviation is a fifth of it.
    size_effect : bool, optional
        Yield that depends on the depth: `NixGao` with h* = 300 nm.

    Examples
    --------
    >>> state = model("fractal").solve(1e7)
    >>> round(float(state.A_real / state.A_0), 3)
    0.01
    """
    steel = tb.materials["S45C"]
    return GhaedniaMultiscale(
        surface=surfaces()[surface],
        surfaces=tb.MaterialPair(steel, steel),
        particles=tb.Particles(
            material=tb.materials["SiO2"],
            diameter=tb.TruncatedGaussian(mean=size, std=size / 5),
            areal_density=2e13,
        ),
        size_effect=NixGao(h_star=300e-9) if size_effect else None,
    )


class Statement(NamedTuple):
    """What the authors state, and the numbers that must lie in an interval for it to hold."""

    id: str
    statement: str
    provenance: str
    quantity: str
    measure: Callable[[], list[float]]
    low: float
    high: float


class Entry(NamedTuple):
    """A statement and its measurement."""

    statement: Statement
    measured: tuple[float, ...]
    holds: bool


def largest_area_ratios() -> list[float]:
    states = [model(name).solve(PRESSURES) for name in surfaces()]
    return [float(np.max(state.A_real / state.A_0)) for state in states]


def slopes() -> list[float]:
    """Smallest and largest d ln A/d ln p on each surface."""
    out: list[float] = []
    for name in surfaces():
        area = model(name).solve(PRESSURES).A_real
        slope = np.diff(np.log(area)) / np.diff(np.log(PRESSURES))
        out += [float(slope.min()), float(slope.max())]
    return out


def area_by_size() -> list[float]:
    out: list[float] = []
    for name in surfaces():
        small, large = (model(name, x, size_effect=True).solve(1e6) for x in (SMALL, 2 * SMALL))
        out.append(float(large.A_real / small.A_real))
    return out


def smallest_share() -> list[float]:
    return [
        float(model(name, SMALL).solve(HIGH_PRESSURE).particle_load_share) for name in surfaces()
    ]


STATEMENTS = (
    Statement(
        "less area",
        "Particles lower the real area of contact.",
        "seen (abstract, doi:10.1115/1.4024297)",
        "largest real area with particles over that without",
        largest_area_ratios,
        0.0,
        0.999,
    ),
    Statement(
        "linear",
        "The real area grows linearly with the load.",
        "recalled; in none of the abstracts",
        "slopes d ln A/d ln p",
        slopes,
        0.95,
        1.05,
    ),
    Statement(
        "size",
        "Particle size plays a key role.",
        "seen (abstract, doi:10.1115/1.4024297)",
        "real area at twice the size, yield depending on depth",
        area_by_size,
        1.1,
        np.inf,
    ),
    Statement(
        "both carry",
        "Asperities and particles both contribute to the contact force.",
        "seen (abstract of a talk, 2011)",
        "particles' share of the load where the asperities touch",
        smallest_share,
        0.01,
        0.99,
    ),
)


def ledger() -> list[Entry]:
    """Every statement, measured.

    Examples
    --------
    >>> [entry.holds for entry in ledger()]
    [True, True, True, True]
    """
    out = []
    for statement in STATEMENTS:
        measured = tuple(statement.measure())
        holds = all(statement.low <= value <= statement.high for value in measured)
        out.append(Entry(statement, measured, holds))
    return out


def main() -> int:
    """Print the ledger."""
    print(f"{GhaedniaMultiscale.citation}: model {GhaedniaMultiscale.provenance}\n")
    for (_, words, provenance, quantity, _, low, high), measured, holds in ledger():
        values = ", ".join(f"{value:.3g}" for value in measured)
        print(f"{'holds' if holds else 'FAILS'}  {words} [{provenance}]")
        print(f"       {quantity}: {values}; allowed {low:g} to {high:g}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
