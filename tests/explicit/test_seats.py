"""Where particles lie: what each rule means for the heights, and that particles keep apart."""

import numpy as np
import pytest
from refusals import Mistake, refuses

import thirdbody as tb
from thirdbody.explicit.seats import (
    SEATS,
    DownhillSeats,
    GivenSeats,
    HighestSeats,
    RandomSeats,
    SettledSeats,
    SphereSeats,
    SummitSeats,
    ValleySeats,
    height_at,
    placed_apart,
    seat_heights,
    seats_named,
)

SPACING = 1e-7
MAPS = [
    tb.surfaces.self_affine(
        sigma=300e-9, hurst=0.8, shortest=2.37e-6, longest=11.8e-6, spacing=SPACING, points=1024,
        seed=seed,
    ).heights
    for seed in range(2)
]  # fmt: skip
SIGMA = 300e-9


def heights(rule, size=3e-7, count=20_000):
    out = []
    for seed, z in enumerate(MAPS):
        found = rule.draw(z, SPACING, np.full(count, size), np.random.default_rng(seed))
        out.append((height_at(z, SPACING, found.x, found.y) + found.lift) / SIGMA)
    return np.concatenate(out)


@pytest.mark.parametrize(
    ("rule", "mean", "std"),
    [
        (RandomSeats(), 0.00, 1.00),
        (SettledSeats(), -0.20, 0.99),
        (SettledSeats(within=1.5e-6), -0.52, 0.93),
        (SettledSeats(within=5e-6), -0.99, 0.75),
        (SettledSeats(spots=20, within=1.5e-6), -0.77, 0.90),
        (HighestSeats(), 0.52, 0.93),
        (DownhillSeats(), -0.65, 0.94),
        (ValleySeats(), -1.45, 0.92),
    ],
)
def test_the_heights_of_a_rule(rule, mean, std):
    """Two maps of (0.1 mm)²: a mean of some hundred independent hills each."""
    found = seat_heights(heights(rule))
    assert found.mean == pytest.approx(mean, abs=0.05)
    assert found.std == pytest.approx(std, abs=0.04)


def test_summits_and_spheres():
    found = seat_heights(heights(SummitSeats(), count=450))
    assert found.mean == pytest.approx(1.0, abs=0.1)
    low, high = (seat_heights(heights(SphereSeats(), size, 2000)).mean for size in (3e-7, 3e-6))
    assert 0.08 < high - low < 0.25


def test_a_sphere_rests_on_what_is_under_it():
    """In a groove narrower than itself a sphere hangs on the edges."""
    z = np.zeros((64, 64))
    z[31:34, :] = -1e-6
    size, x = 1e-6, 32 * SPACING
    found = SphereSeats()
    lift = _lift(found, z, x, size)
    # edges two pixels away: the underside is radius − √(radius² − (2Δ)²) below them
    hang = 0.5e-6 - np.sqrt(0.25e-12 - (2 * SPACING) ** 2)
    assert lift == pytest.approx(1e-6 - hang, rel=1e-9)


def _lift(rule, z, x, size):
    from thirdbody.explicit.seats import _rest

    return _rest(z, SPACING, np.array([x]), np.array([3e-6]), np.array([size]))[0]


def test_downhill_ends_lower_and_in_reach():
    z = MAPS[0]
    size = np.full(500, 1e-7)
    start = RandomSeats().draw(z, SPACING, size, np.random.default_rng(4))
    end = DownhillSeats(distance=7e-7).draw(z, SPACING, size, np.random.default_rng(4))
    side = np.array(z.shape) * SPACING
    way = np.stack([end.x - start.x, end.y - start.y], axis=1)
    way -= side * np.round(way / side)
    assert np.hypot(*way.T).max() <= 7e-7 * (1 + 1e-9)
    assert np.all(height_at(z, SPACING, end.x, end.y) <= height_at(z, SPACING, start.x, start.y))


def test_valleys_have_no_way_down():
    z = MAPS[0]
    end = ValleySeats().draw(z, SPACING, np.full(300, 1e-7), np.random.default_rng(4))
    i, j = np.round(end.x / SPACING).astype(int), np.round(end.y / SPACING).astype(int)
    around = [z[(i + a) % 1024, (j + b) % 1024] for a in (-1, 0, 1) for b in (-1, 0, 1)]
    assert np.all(z[i % 1024, j % 1024] <= np.min(around, axis=0))


def test_particles_keep_apart():
    z = MAPS[0][:128, :128]
    size = np.random.default_rng(1).uniform(2e-7, 6e-7, 120)
    found, left = placed_apart(RandomSeats(), z, SPACING, size, np.random.default_rng(2))
    assert left == 0
    at, side = np.stack([found.x, found.y], axis=1), 128 * SPACING
    apart = at[:, None] - at
    apart -= side * np.round(apart / side)
    gap = np.hypot(apart[..., 0], apart[..., 1]) - (size[:, None] + size) / 2
    assert np.all(gap[~np.eye(120, dtype=bool)] >= 0)


def test_given_places_are_kept_and_overlaps_counted():
    z = np.zeros((64, 64))
    rule = seats_named([[1e-6, 2e-6], [1.1e-6, 2e-6], [9e-6, 9e-6]])
    assert isinstance(rule, GivenSeats)
    found, left = placed_apart(rule, z, SPACING, np.full(3, 3e-7), np.random.default_rng(0))
    assert found.x[1] == 1.1e-6
    assert found.x[2] == pytest.approx(9e-6 - 6.4e-6)
    assert left == 1


def test_every_rule_is_a_value():
    for name, kind in SEATS.items():
        rule = kind()
        assert rule == seats_named(name)
        assert hash(rule) == hash(kind())
        assert tb.explicit.RandomSeats.from_dict(rule.to_dict()) == rule
    with refuses(Mistake.RANGE, "SettledSeats.within", value="-1"):
        SettledSeats(within=-1)
    with refuses(Mistake.BEYOND, "seats", value="'summits'"):
        SummitSeats().draw(MAPS[0], SPACING, np.full(10**5, 1e-7), np.random.default_rng(0))
