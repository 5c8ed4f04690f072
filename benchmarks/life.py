"""Time histories: of a contact for 1000 h with 32 classes of three kinds, and of oils alone.

``python benchmarks/life.py`` prints the seconds of the first history with a contact, with its
tables, and of a second one with the same contact and another ingress; then for oils alone, drawn
at random, the largest residual of the ledger, how far the exact course is from one that is
integrated step by step (Radau of SciPy), and how many times as long that takes, in the same run.
"""

import time
import warnings
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

import thirdbody as tb
from thirdbody.systems.life.oil_history import run_oil_history

STEEL = tb.materials["S45C"].replace(density=7850.0)
QUARTZ = tb.materials["quartz"]
CIRCUITS = 300
RTOL = 1e-6
"""Of the steps of Radau."""


def oil(rate: float) -> tb.oil.OilCircuit:
    """200 L with one filter, dust that comes in from 4 µm on."""
    return tb.oil.OilCircuit(
        volume=0.2,
        start=tb.oil.OilDirt.from_iso4406("18/16/13", material=QUARTZ, largest=60e-6),
        ingress=tb.oil.Ingress.from_counts(
            sizes=[4e-6, 6e-6, 14e-6],
            counts=[rate, 0.3 * rate, 0.01 * rate],
            material=QUARTZ,
            largest=60e-6,
        ),
        filters=tb.oil.Filter(sizes=(5e-6, 10e-6), betas=(2.0, 75.0), flow=1e-3),
        classes=tb.oil.SizeClasses.covering(smallest=0.25e-6, largest=64e-6),
    )


def run(rate: float) -> None:
    """One history of 1000 h."""
    contact = tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        outputs=(
            tb.outputs.Friction(tau_ss=580e6, tau_sa=200e6),
            tb.outputs.Wear(K_ss=1e-6, K_sa=0.0, f_ab=0.1, f_roll=0.001, renewal=1.0),
        ),
    )
    found = tb.life(
        contact,
        oil=oil(rate),
        conjunction=tb.films.Point(R=9.5e-3),
        lubricant=tb.films.Oil(eta=0.02, alpha=2e-8),
        load=20.0,
        speed=0.5,
        slide_roll=0.05,
        contacts=20.0,
        entry_ratio=0.01,
        worn_area=(1e-3, 1e-3),
        debris=tb.oil.Debris.boundary_lubricated(hardness=9e9),
        running_in=tb.oil.RunningIn(sigma_end=60e-9),
        duration=3.6e6,
    )
    print(found.codes[-1], f"σ = {found.more['sigma'][1][-1] * 1e9:.2f} nm,", found.reproduction)


def drawn(index: int) -> tuple[tb.oil.OilCircuit, float]:
    """A circuit without events, drawn at random over real ranges, and a duration [s]."""
    rng = np.random.default_rng(index)

    def log(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    volume, duration, first = log(1e-4, 10.0), log(60.0, 1e7), log(1.5e-6, 6e-6)
    beta, rate = log(1.5, 100), log(1e3, 1e9)
    number = int(rng.integers(10, 22))
    moving = 0.5 * volume / duration
    circuit = tb.oil.OilCircuit(
        volume=volume,
        start=tb.oil.OilDirt.from_iso4406(f"{number}/{number - 2}/{number - 5}", material=QUARTZ),
        ingress=tb.oil.Ingress.from_counts(
            sizes=[4e-6, 6e-6, 14e-6], counts=[rate, 0.3 * rate, 0.01 * rate], material=QUARTZ
        ),
        filters=tb.oil.Filter(
            sizes=(first, first * log(1.2, 4)),
            betas=(beta, beta * log(1, 200)),
            flow=log(1e-6, 1e-2),
            service=log(0.3, 1.2),
        ),
        viscosity=log(1e-3, 1),
        density=870.0,
        settling_area=log(1e-3, 10),
        make_up=moving * rng.random(),
        leak=moving * rng.random(),
        fresh_oil=(),
    )
    return circuit, duration


class Oils(NamedTuple):
    """What the oils of a run came to."""

    residual: float
    """The largest of a ledger, over its largest account [1]."""
    off: float
    """Largest distance of both courses at the end, over the most particles of a class [1]."""
    ratio: float
    """Time of Radau over that of the exact course [1]."""


def compare_oils(count: int = CIRCUITS) -> Oils:
    """Exact courses of oils drawn at random, and the same step by step.

    Parameters
    ----------
    count : int, optional
        Circuits.
    """
    exact = stepped = residual = off = 0.0
    for index in range(count):
        circuit, duration = drawn(index)
        begin = time.perf_counter()
        history = run_oil_history(circuit, duration=duration, times=[0.0, duration])
        exact += time.perf_counter() - begin
        residual = max(residual, history.ledger.residual)
        begin = time.perf_counter()
        terms = circuit.terms()
        source, loss = terms.source.ravel(), terms.loss.ravel()
        start = circuit.volume * terms.start.ravel()
        scale = max(float(np.max(start)), float(np.max(source)) * duration)
        found = solve_ivp(
            lambda t, y: source - loss * y / (circuit.volume + terms.growth * t),  # noqa: B023
            (0.0, duration),
            start,
            method="Radau",
            jac=lambda t, y: np.diag(-loss / (circuit.volume + terms.growth * t)),  # noqa: B023
            rtol=RTOL,
            atol=1e-9 * scale,
        )
        stepped += time.perf_counter() - begin
        end = history.numbers[-1].ravel() * history.volume[-1]
        off = max(off, float(np.max(np.abs(end - found.y[:, -1])) / max(np.max(end), scale * 1e-6)))
    return Oils(residual, off, stepped / exact)


def main() -> None:
    """Print wall and processor seconds of both histories, and what the oils come to."""
    warnings.simplefilter("ignore")
    for name, rate in (("first", 1e6), ("second", 2e6)):
        wall, cpu = time.perf_counter(), time.process_time()
        run(rate)
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
        print(f"{name} history: {wall:.2f} s, {cpu:.2f} s of the processor")
    found = compare_oils()
    print(
        f"{CIRCUITS} oils: residual of mass {found.residual:.1e}, {found.off:.1e} from Radau, "
        f"which takes {found.ratio:.1f} times as long"
    )


if __name__ == "__main__":
    main()
