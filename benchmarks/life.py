"""Time a history with a contact: 1000 h, 24 classes of three kinds, a roughness that moves.

``python benchmarks/life.py`` prints the seconds of the first history, with its tables, and of a
second one with the same contact and another ingress.
"""

import time
import warnings

import thirdbody as tb
from thirdbody.systems.life.debris import Debris
from thirdbody.systems.life.surfaces import RunningIn
from thirdbody.systems.oil_filter import Filter

STEEL = tb.materials["S45C"].replace(density=7850.0)
QUARTZ = tb.materials["quartz"]


def oil(rate: float) -> tb.OilCircuit:
    """200 L with one filter, dust that comes in from 4 µm on."""
    return tb.OilCircuit(
        volume=0.2,
        start=tb.OilDirt.from_iso4406("18/16/13", material=QUARTZ, largest=60e-6),
        ingress=tb.Ingress.from_counts(
            sizes=[4e-6, 6e-6, 14e-6],
            counts=[rate, 0.3 * rate, 0.01 * rate],
            material=QUARTZ,
            largest=60e-6,
        ),
        filters=Filter(sizes=(5e-6, 10e-6), betas=(2.0, 75.0), flow=1e-3),
        classes=tb.SizeClasses.covering(smallest=0.25e-6, largest=64e-6),
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
        debris=Debris.boundary_lubricated(hardness=9e9),
        running_in=RunningIn(sigma_end=60e-9),
        duration=3.6e6,
    )
    print(found.codes[-1], f"σ = {found.more['sigma'][1][-1] * 1e9:.2f} nm,", found.reproduction)


def main() -> None:
    """Print wall and processor seconds of both histories."""
    warnings.simplefilter("ignore")
    for name, rate in (("first", 1e6), ("second", 2e6)):
        wall, cpu = time.perf_counter(), time.process_time()
        run(rate)
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
        print(f"{name} history: {wall:.2f} s, {cpu:.2f} s of the processor")


if __name__ == "__main__":
    main()
