"""What outputs cost over the bare solve: 200 loads of one contact, processor time.

python benchmarks/outputs.py
"""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
import measured_contact

import thirdbody as tb

LOADS = np.geomspace(1e-6, 1e-4, 200)
REPEATS = 5
METAL = dict(thermal_conductivity=50, density=7850, specific_heat=480, resistivity=2e-7)
GLASS = dict(thermal_conductivity=1.4, density=2200, specific_heat=740)


class Cost(NamedTuple):
    """Milliseconds of one contact with outputs; x: over the bare solve of a new, a known one."""

    what: str
    milliseconds: float
    new: float
    known: float


def sets() -> dict[str, tuple[tb.outputs.AbstractOutput, ...]]:
    """Outputs with those that they need."""
    friction = tb.outputs.Friction(tau_ss=580e6, tau_sa=200e6)
    heat = tb.outputs.FlashTemperature(v=1.0, A_n=1e-6)
    wear = tb.outputs.Wear(K_ss=1e-4, K_sa=1e-4, f_ab=0.1, f_roll=0.01)
    out = {
        "counts": (tb.outputs.Counts(),),
        "friction": (friction,),
        "friction, flash temperature": (friction, heat),
        "thermal, electrical conductance": (
            tb.outputs.ThermalConductance(),
            tb.outputs.ElectricalConductance(),
        ),
        "friction, wear": (friction, wear),
        "dents": (tb.outputs.Dents(),),
        "static friction": (tb.outputs.StaticFriction(),),
    }
    return out | {
        "all of them": tuple(dict.fromkeys(each for some in out.values() for each in some))
    }


def once(contact: tb.Contact) -> float:
    start = time.process_time()
    tb.solve(contact, F_star=LOADS)
    return time.process_time() - start


def costs() -> Iterator[Cost]:
    """The bare solve, then every set of outputs on the same contact."""
    contact = measured_contact.contact("rough")
    steel = contact.surfaces.first.replace(**METAL)
    contact = contact.replace(surfaces=tb.MaterialPair(steel, steel))
    contact = contact.replace(**{"particles.material": contact.particles.material.replace(**GLASS)})
    # sizes of another relative width: tables of their own
    new = np.median(
        [once(contact.replace(**{"particles.diameter.std": s})) for s in (21e-9, 22e-9, 23e-9)]
    )
    known = min(once(contact) for _ in range(REPEATS))
    yield Cost("nothing, new contact", 1e3 * new, 1.0, new / known)
    yield Cost("nothing, known contact", 1e3 * known, known / new, 1.0)
    for what, some in sets().items():
        more = min(once(contact.replace(outputs=some)) for _ in range(REPEATS)) - known
        yield Cost(what, 1e3 * more, more / new, more / known)


def main() -> int:
    warnings.simplefilter("ignore", tb.errors.RangeWarning)
    for cost in costs():
        ratios = f"{cost.new:8.2f} x new{cost.known:8.1f} x known"
        print(f"{cost.what:34s}{cost.milliseconds:8.1f} ms{ratios}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
