"""Births of debris by brute force: equations written out here, contacts solved one by one."""

import math
import warnings
from dataclasses import dataclass

import numpy as np
import pytest
from contact_cases import DEBRIS, FILM, QUARTZ, STEEL, contact
from scipy.integrate import quad

import thirdbody as tb

EDGES = (1e-6, 2e-6, 4e-6, 8e-6, 16e-6)
LOW, HIGH = np.array(EDGES[:-1]), np.array(EDGES[1:])
SPEED, SLIP, CONTACTS, ENTRY, WORN = 0.5, 0.05 * 0.5, 20.0, 1.0, 1e-3
VOLUME, FLOW, DURATION = 0.01, 1e-6, 1e4
RATE = np.array([4e5, 2e5, 5e4, 5e3])
"""Quartz of each class that enters per time [1/s]."""


def mean_over_class(f, low, high):
    """Mean over sizes with numbers ∝ x⁻⁴."""
    kinks = [5e-6, 10e-6]
    weight = (low**-3 - high**-3) / 3
    points = [x for x in kinks if low < x < high] or None
    return quad(lambda x: f(x) * x**-4, low, high, points=points, epsrel=1e-12)[0] / weight


def removal():
    """Oil per time from which a filter of β_5 = 2, β_10 = 75 takes each class, eq. (5)."""

    def passes(x):
        if x < 5e-6:
            return 1.0
        if x >= 10e-6:
            return 1 / 75
        rise = math.log(74) / math.log(2)
        excess = (x / 5e-6) ** rise
        beta = 1 + excess
        return min((1 + rise * excess / beta / 3) / beta, 1.0)

    return FLOW * np.array(
        [1 - mean_over_class(passes, a, b) for a, b in zip(LOW, HIGH, strict=False)]
    )


@dataclass
class ByHand:
    """Numbers in the oil and volumes worn, stepped explicitly; every gap is a `mixed_film`."""

    film: float = 3e-7
    """The last mean gap [m]."""

    def __post_init__(self):
        self.volumes = np.array([math.pi / 6 * mean_over_class(lambda x: x**3, a, b)
                                 for a, b in zip(LOW, HIGH, strict=False)])  # fmt: skip
        density = [quad(lambda u: np.exp(3 * u - (u - math.log(2e-6)) ** 2 / 2 / math.log(1.3) ** 2),
                        math.log(a), math.log(b), epsrel=1e-12)[0]
                   for a, b in zip((2e-7, *EDGES[1:-1]), (*EDGES[1:-1], 1e-4), strict=False)]  # fmt: skip
        self.shares = np.array(density) / sum(density)
        self.loss = removal()
        self.area = CONTACTS * FILM["conjunction"].hertz(20.0, E=2 * contact().E_ss).area
        self.debris = STEEL.replace(H=9e9)

    def wear(self, numbers):
        """Volume per second that surfaces 1 and 2 lose, with N (3, K) in the oil."""
        for _ in range(20):
            layer = [
                mean_over_class(lambda x: max(self.film, x), a, b)
                for a, b in zip(LOW, HIGH, strict=False)
            ]
            eta = ENTRY * np.array(layer) * numbers / VOLUME
            particles = tuple(
                tb.Particles(
                    material=each,
                    diameter=tb.distributions.PowerLaw(
                        edges=EDGES, counts=tuple(row), slopes=(3.0,) * 4
                    ),
                    areal_density=row.sum(),
                )
                for each, row in zip((QUARTZ, self.debris, self.debris), eta, strict=False)
                if row.sum() > 0
            )
            found = tb.films.mixed_film(
                contact().replace(particles=particles or None), conjunction=FILM["conjunction"],
                oil=FILM["lubricant"], load=20.0, speed=SPEED, slide_roll=0.05,
            )  # fmt: skip
            moved = abs(found.h_T / self.film - 1)
            self.film = found.h_T
            if moved < 1e-6:
                break
        return [SLIP * self.area * found.state.outputs[f"wear_{i}"] for i in (1, 2)]

    def rates(self, y):
        """Of numbers (3, K) and of the two volumes."""
        numbers = y[:12].reshape(3, 4)
        worn = self.wear(np.maximum(numbers, 0.0))
        change = -numbers * self.loss / VOLUME
        change[0] += RATE
        for i in (0, 1):
            change[1 + i] += self.shares * worn[i] / self.volumes
        return np.concatenate([change.ravel(), worn])

    def run(self, steps):
        """Runge and Kutta's fourth order, in steps that grow."""
        y = np.zeros(14)
        times = DURATION * np.linspace(0, 1, steps + 1)
        for a, b in zip(times, times[1:], strict=False):
            h = b - a
            one = self.rates(y)
            two = self.rates(y + h / 2 * one)
            three = self.rates(y + h / 2 * two)
            four = self.rates(y + h * three)
            y = y + h / 6 * (one + 2 * two + 2 * three + four)
        return y


@pytest.fixture(scope="module")
def quiet():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


@pytest.mark.slow
@pytest.mark.usefixtures("quiet")
def test_births_are_those_of_a_brute_force():
    """Debris in an oil and depth of wear, by steps of Runge and Kutta over whole contacts."""
    dirt = tb.oil.Ingress(
        material=QUARTZ, rate=RATE.sum(),
        diameter=tb.distributions.PowerLaw(edges=EDGES, counts=tuple(RATE), slopes=(3.0,) * 4),
    )  # fmt: skip
    held = tb.oil.Filter(sizes=(5e-6, 10e-6), betas=(2.0, 75.0), flow=FLOW)
    oil = tb.oil.OilCircuit(
        volume=VOLUME, start=(), ingress=dirt, filters=held, classes=tb.oil.SizeClasses(edges=EDGES)
    )
    own = FILM | dict(entry_ratio=ENTRY, worn_area=(WORN, WORN))
    found = tb.life(contact(), oil=oil, duration=DURATION, debris=DEBRIS, **own)
    y = ByHand().run(4)
    worn = [found.more[f"wear_{i}"][1][-1] * WORN for i in (1, 2)]
    np.testing.assert_allclose(worn, y[12:], rtol=2e-5)
    numbers = found.numbers[-1].T * VOLUME
    np.testing.assert_allclose(numbers, y[:12].reshape(3, 4), rtol=2e-5, atol=1e-3)
    assert numbers[1].sum() > 1e3


@pytest.mark.usefixtures("quiet")
@pytest.mark.parametrize(("low", "high"), [(2e-6, 2.5e-6), (2e-6, 4e-6)])
def test_sizes_of_a_class_come_with_its_mean_layer(low, high):
    """With a layer of its own for each size a class wears more, by a square of its width."""
    worn = []
    for slope in (3.0, 2.0):  # numbers ∝ x⁻⁴, and the same times x
        dust = tb.Particles(
            material=QUARTZ, areal_density=1e8,
            diameter=tb.distributions.PowerLaw(edges=(low, high), counts=(1.0,), slopes=(slope,)),
        )  # fmt: skip
        state = tb.solve(contact(K_ss=0.0).replace(particles=dust), d=np.array([2e-7]))
        worn.append(float(state.outputs["wear_1"][0]))
    # of what goes as x^q it is q/12 of the square of the logarithm
    off = (worn[1] / worn[0] - 1) / math.log(high / low) ** 2
    assert 1 / 12 < off < 3 / 12
