"""Whole numbers that no float holds: one sentence each, which does not write them out."""

import numpy as np
import pytest

import thirdbody as tb

HUGE = [10**400, 10**5000, -(10**400)]
STEEL = tb.materials["S45C"]
ROUGH = tb.Roughness(sigma=100e-9, R=2.8e-6)
CONTACT = tb.Contact(surfaces=tb.MaterialPair(STEEL, STEEL), roughness=ROUGH)
DOORS = {
    "field": lambda n: tb.distributions.Monodisperse(mean=n),
    "second field": lambda n: tb.TruncatedGaussian(mean=3e-7, std=1e-8, n=n),
    "sequence": lambda n: tb.distributions.Histogram(edges=[1e-6, 2e-6], counts=[n]),
    "replace": lambda n: ROUGH.replace(sigma=n),
    "output": lambda n: tb.outputs.FlashTemperature(v=n, A_n=1e-6),
    "load": lambda n: tb.solve(CONTACT, pressure=n),
    "loads": lambda n: tb.solve(CONTACT, pressure=[1e6, n]),
    "array": lambda n: tb.solve(CONTACT, pressure=np.array([1e6, n], dtype=object)),
    "separation": lambda n: tb.solve(CONTACT, d=n),
    "vary": lambda n: tb.equilibria.solve_states(
        CONTACT, pressure=1e6, vary={"roughness.sigma": [n]}
    ),
    "sweep": lambda n: tb.sweep(CONTACT, pressure=[n]),
    "table": lambda n: tb.table(CONTACT, low=n),
    "tolerance": lambda n: tb.table(CONTACT, tolerance=n),
    "surfaces": lambda n: tb.explicit.ensemble(CONTACT, surfaces=n, F_star=1e-5),
    "oil": lambda n: tb.films.Oil(eta=n, alpha=2e-8),
}


@pytest.mark.parametrize("number", HUGE, ids=["1e400", "1e5000", "-1e400"])
@pytest.mark.parametrize("door", DOORS)
def test_a_number_beyond_every_float_is_named_and_not_written_out(door, number):
    with pytest.raises(tb.errors.InvalidValue) as found:
        DOORS[door](number)
    (sentence,) = found.value.problems
    digits = "5001" if abs(number) > 10**1000 else "401"
    assert f" {digits} digits" in sentence
    assert len(sentence) < 200
