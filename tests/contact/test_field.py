"""The law of one field in a contact: surfaces pressed point by point, ground, refusals, spots."""

from __future__ import annotations

import math
import warnings
from itertools import pairwise

import numpy as np
import pytest
from refusals import Mistake, Status, balances_not, refuses, warns_of
from scipy.integrate import quad

import thirdbody as tb
from thirdbody.contact.evaluation import spots_of
from thirdbody.contact.interface import Interface, interface
from thirdbody.explicit import surface_of
from thirdbody.laws.field.own import OwnSpectrum

E_STAR, SIGMA = 112e9, 0.3e-6
EXPLICIT = {
    0.04464: (
        [2.232e-4, 8.929e-4, 2.232e-3, 4.464e-3, 8.929e-3, 1.339e-2],
        [2.433, 1.884, 1.459, 1.094, 0.686, 0.421],
        [6.469, 4.480, 3.361, 2.658, 1.990, 1.624],
        [0.077, 0.016, 0.005, 0.015, 0.002, 0.004],
        0.03,
    ),
    0.1: (
        [5e-4, 2e-3, 5e-3, 1e-2, 2e-2, 3e-2],
        [2.270, 1.698, 1.265, 0.907, 0.544, 0.323],
        [8.07, 5.543, 4.126, 3.220, 2.310, 1.829],
        [0.15, 0.027, 0.019, 0.006, 0.005, 0.009],
        0.04,
    ),
}
"""By H/E*: F*, h/σ, share in %, its error, and how far off a share may be."""


def contact(ratio=0.04464, *, density=1e11, size=SIGMA, law=None, **others):
    body = tb.Material(E=2 * E_STAR * (1 - 0.09), nu=0.3, H=ratio * E_STAR)
    particles = tb.Particles(
        material=body.replace(H=4 * body.H), areal_density=density,
        diameter=tb.distributions.Monodisperse(mean=size),
    )  # fmt: skip
    given = {
        "surfaces": tb.MaterialPair(body, body),
        "roughness": tb.Roughness(sigma=SIGMA, R=3e-6, alpha=5.0),
        "asperity_law": law or tb.asperity.Field(),
        "particles": particles if density else None,
        "particle_law": tb.particle.Series(deep="off"),
    }
    return tb.Contact(**given | others)


def solved(case, **load):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return tb.solve(case, **load)


NORM = np.array([math.sqrt(math.factorial(n)) for n in range(13)])


def ground_at(zeta, u):
    """Σ u_n He_n/√n! at a height."""
    return float(np.polynomial.hermite_e.hermeval(min(max(zeta, -4.0), 4.0), u / NORM))


@pytest.fixture(scope="module")
def box():
    """The waves of the boxes of 102 µm that were pressed."""
    surface = surface_of(contact(), size=512, spacing=0.2e-6, seed=1)
    return OwnSpectrum.of(surface, box=True)


def test_waves_of_a_box(box):
    assert box.spectrum.alpha == pytest.approx(5.0, rel=2e-3)
    k = box.spectrum.integrals(0.0, 3)
    assert k[1:] == pytest.approx([1.654, 1.023, 0.791], abs=1e-3)
    with refuses(Mistake.SHAPE, "OwnSpectrum.q"):
        OwnSpectrum(q=(1.0, 2.0), weight=(1.0,))


@pytest.mark.parametrize("ratio", list(EXPLICIT))
def test_against_surfaces_pressed_point_by_point(ratio, box):
    loads, h, share, error, part = EXPLICIT[ratio]
    law = tb.asperity.Field(spectrum=box)
    state = solved(contact(ratio, law=law), F_star=np.array(loads))
    assert state.h / SIGMA == pytest.approx(h, abs=0.02)
    off = np.abs(100 * state.particle_load_share - share)
    assert np.all(off < np.maximum(part * np.array(share), 2.5 * np.array(error)))


def test_without_particles_it_is_the_clean_contact():
    loads = np.geomspace(1e-6, 1e-2, 9)
    clean = solved(contact(density=0), F_star=loads)
    none = solved(contact().replace(particles=contact().particles.replace(areal_density=0.0)),
                  F_star=loads)  # fmt: skip
    for name, values in clean.columns().items():
        assert np.array_equal(values, none.columns()[name]), name
    few = solved(contact(density=1e3), F_star=loads)
    assert few.h == pytest.approx(clean.h, rel=1e-5)


@pytest.mark.parametrize("size", [0.67 * SIGMA, 2 * SIGMA, 6 * SIGMA])
def test_derivatives_of_the_load(size):
    bound = interface(contact(size=size, density=3e11 if size < SIGMA else 2e10))
    d = np.linspace(bound.lowest + 0.2 * SIGMA, size + 3 * SIGMA, 30)
    step = 1e-4 * SIGMA
    values = bound.load(d)
    for n in (0, 1):
        slope = (bound.load(d + step)[:, n] - bound.load(d - step)[:, n]) / (2 * step)
        assert slope == pytest.approx(values[:, n + 1], rel=2e-5, abs=1e-6 * abs(values[0, n + 1]))
    fields = bound.fields(d)
    assert fields["F_ss"] + fields["F_sa"] == pytest.approx(values[:, 0], rel=1e-12)


def test_load_of_particles_on_their_ground():
    case = contact(0.1)
    bound = interface(case)
    ground, one = (
        bound.asperities.ground,
        case.particle_law.one(surfaces=case.surfaces, particle=case.particles.material),
    )
    x = case.particles.diameter.mean
    # rows of the table: between them splines leave out some 1e-5
    for h, u in zip(ground.h[[10, 14, 19]], ground.u[[10, 14, 19]], strict=True):
        d = np.array([h * SIGMA - bound.mean_plane])

        def load(zeta, u=u, h=h):
            gap = SIGMA * (h - zeta + ground_at(zeta, u))
            force = one(np.array([max(1 - gap / x, 0.0)]))[0, 0] * x**2
            return force * math.exp(-(zeta**2) / 2) / math.sqrt(2 * math.pi)

        ends = h - x / SIGMA - 1, 4.0, 8.5
        parts = (quad(load, a, b, limit=900, epsabs=0, epsrel=1e-11) for a, b in pairwise(ends))
        expected = 1e11 * sum(part for part, _ in parts)
        assert bound.fields(d)["F_sa"][0] == pytest.approx(expected, rel=1e-8)


SIZES = {
    "one": tb.distributions.Monodisperse(mean=SIGMA),
    "Gaussian": tb.TruncatedGaussian(mean=3 * SIGMA, std=0.3 * SIGMA, n=3.0),
    "power": tb.distributions.PowerLaw(
        edges=(0.03 * SIGMA, SIGMA, 3 * SIGMA), counts=(1e4, 50.0), slopes=(5.0, 3.0)
    ),
}


@pytest.mark.parametrize("wild", [False, True])
@pytest.mark.parametrize("sizes", SIZES)
def test_sums_over_heights_by_many_even_steps(sizes, wild):
    """Soft particles, whose law has kinks; on wild ground gaps rise with the height in places."""
    case = contact(0.1, density=1e9)
    soft = case.particles.replace(
        diameter=SIZES[sizes],
        material=case.particles.material.replace(H=0.3 * case.surfaces.first.H),
    )
    ground = interface(case.replace(particles=soft)).asperities.ground
    rng = np.random.default_rng(5)
    zeta = np.linspace(-8.5, 8.5, 400_001)
    for row in (6, 12, 20):
        u, h = ground.u[row], ground.h[row]
        if wild:
            u = 0.5 * rng.normal(size=13) * 0.8 ** np.arange(13)
        (seat,) = ground.seats
        columns, moments = seat.sums(np.array([h]), u[None])
        x = np.clip(zeta, -4.0, 4.0)
        polynomials = np.polynomial.hermite_e.hermevander(x, 12) / NORM
        gap = h - zeta + polynomials @ u
        assert np.any(np.diff(gap) > 0) == wild
        values = np.maximum(seat.average.average(gap / seat.unit), 0.0)
        mass = np.exp(-0.5 * zeta**2) / math.sqrt(2 * math.pi) * (zeta[1] - zeta[0])
        expected = mass @ values
        np.testing.assert_allclose(columns[0, 1:], expected[1:], atol=3e-5 * expected[1:].max())
        assert columns[0, 0] == pytest.approx(expected[0], rel=1e-6)
        np.testing.assert_allclose(
            moments[0], (mass * values[:, 0]) @ polynomials, atol=2e-5 * expected[0]
        )


def test_ground_by_its_own_equation():
    """u_n of the table put into the definition give themselves again."""
    bound = interface(contact(0.1, density=4e11))
    ground = bound.asperities.ground
    rows = np.flatnonzero((ground.h > 0.5) & (ground.h < 2.5))
    h, u = ground.h[rows], ground.u[rows]
    (seat,) = ground.seats
    columns, moments = seat.sums(h, u)
    beta = seat.component.factor / bound.asperities.unit * moments
    shade = seat.component.factor * columns[:, 5:6]
    pressed = ground._of_asperities(h + ground.w[rows])
    weights = ground._under_asperities(h + ground.w[rows])
    again = 2 * math.sqrt(2) * ((1 - shade) * pressed + ground.k_pp * beta)
    assert again == pytest.approx(u, abs=1e-8)
    assert 2 * math.sqrt(2) * np.sum(weights * beta, axis=1) == pytest.approx(
        ground.w[rows], abs=1e-8
    )
    assert np.all(u[:, 1] > 0)  # high ground is pressed most
    assert np.all(ground.w[rows] > 0)


def fulfils_the_equations(bound, h, *, atol=1e-10):
    """Check u_n and w of one population's ground at h, and give the columns of its particles."""
    ground, (seat,) = bound.asperities.ground, bound.asperities.ground.seats
    moved = ground.patch_moments(h)
    u, w = moved[:, :-1], moved[:, -1]
    columns, moments = seat.sums(h, u)
    beta = seat.component.factor / bound.asperities.unit * moments
    shade = seat.component.factor * columns[:, 5:6]
    again = (1 - shade) * ground._of_asperities(h + w) + ground.k_pp * beta
    assert ground.twice * again == pytest.approx(u, abs=atol)
    lifted = ground.twice * np.sum(ground._under_asperities(h + w) * beta, axis=1)
    assert lifted == pytest.approx(w, abs=10 * atol)
    return columns


@pytest.mark.parametrize("H", [0.3, 3.0])
def test_between_rows_by_the_equations_there(H):
    """At any separation u_n, w and the load fulfil the equations, not only at rows of the table."""
    case = contact(0.1, density=1e10)
    body = case.particles.material.replace(H=H * case.surfaces.first.H)
    case = case.replace(particles=case.particles.replace(material=body))
    bound = interface(case)
    ground = bound.asperities.ground
    h = np.sort(np.random.default_rng(3).uniform(ground.h[0], 5.5, 40))
    columns = fulfils_the_equations(bound, h)
    d = SIGMA * h - case.roughness.y_s + bound.asperities.centre
    (part,) = bound.populations[0].parts
    got, most = part.columns(d) / part.factor, columns[:, :1].max()
    felt = columns[:, 0] > 1e-9 * most
    assert got[felt, 0] == pytest.approx(columns[felt, 0], rel=1e-9)
    assert got[felt, 1:4].sum(axis=1) == pytest.approx(columns[felt, 1:4].sum(axis=1), rel=1e-9)


def test_table_begins_where_asperities_come_into_theirs():
    """Particles pull the ground of asperities down there: their own table ends a little above."""
    bound = interface(contact(0.05, density=1e12))
    ground, lowest = bound.asperities.ground, bound.asperities.surface.lowest
    assert ground.w[0] < -1e-3
    assert 0 < ground.h[0] + ground.w[0] - lowest < 1e-3
    d = SIGMA * (ground.h[0] - 1e-6) - bound.contact.roughness.y_s + bound.asperities.centre
    assert np.isnan(bound.particles.load(np.array([d]))[0]).all()


def test_units():
    """Lengths three times as large and stresses twice: the same numbers."""
    small = contact(0.1)
    body = small.surfaces.first.replace(E=2 * small.surfaces.first.E, H=2 * small.surfaces.first.H)
    large = tb.Contact(
        surfaces=tb.MaterialPair(body, body),
        roughness=tb.Roughness(sigma=3 * SIGMA, R=9e-6, alpha=5.0),
        asperity_law=tb.asperity.Field(),
        particles=tb.Particles(
            material=body.replace(H=4 * body.H), areal_density=1e11 / 9,
            diameter=tb.distributions.Monodisperse(mean=3 * SIGMA),
        ), particle_law=tb.particle.Series(deep="off"),
    )  # fmt: skip
    loads = np.array([1e-4, 1e-3, 1e-2])
    one, other = (solved(each, F_star=loads) for each in (small, large))
    assert other.h == pytest.approx(3 * one.h, rel=1e-7)
    assert other.A_t == pytest.approx(one.A_t, rel=1e-7)
    assert other.particle_load_share == pytest.approx(one.particle_load_share, rel=1e-6)


def test_spots_add_up_to_the_state():
    case = contact(outputs=(tb.outputs.Counts(),))
    state = solved(case, F_star=np.array([1e-4, 1e-3, 5e-3]))
    bound = interface(case)
    asperities, particles = spots_of(case, bound, state.d, state.shadow)
    fields = bound.fields(state.d)
    assert sum(s.total(s.load) for s in asperities) == pytest.approx(fields["F_ss"], rel=1e-9)
    assert sum(s.total(s.area) for s in asperities) == pytest.approx(fields["A_ss"], rel=1e-9)
    assert sum(s.total(s.load) for s in particles) == pytest.approx(fields["F_sa"], rel=1e-9)
    assert sum(s.total(s.areas[0]) for s in particles) == pytest.approx(fields["A_sa"], rel=1e-5)


def test_several_populations_share_the_ground():
    case = contact()
    half = case.particles.replace(areal_density=0.5e11)
    both = case.replace(particles=(half, half))
    loads = np.array([3e-4, 3e-3])
    one, two = (solved(each, F_star=loads) for each in (case, both))
    assert two.h == pytest.approx(one.h, rel=1e-9)
    assert two.particle_load_share == pytest.approx(one.particle_load_share, rel=1e-8)
    assert two.populations[0].load_share == pytest.approx(one.particle_load_share / 2, rel=1e-6)


def test_particles_of_many_sizes():
    wide = contact().particles.replace(diameter=tb.LogNormal(median=SIGMA, gsd=1.6))
    state = solved(contact(particles=wide), F_star=np.array([1e-5, 1e-4, 1e-3]))
    assert set(state.status) == {"ok"}
    assert np.all(np.diff(state.particle_load_share) < 0)


@pytest.mark.parametrize(
    ("changes", "refusal"),
    [
        (
            {"roughness": tb.Roughness(sigma=SIGMA, R=3e-6, alpha=2.0)},
            refuses(Mistake.BEYOND, "Contact.asperity_law", says="2.5"),
        ),
        (
            {
                "roughness": tb.Roughness(
                    sigma=SIGMA, R=3e-6, heights=tb.heights.WeibullHeights(shape=2.0)
                )
            },
            refuses(Mistake.BEYOND, "Contact.asperity_law", says="Gaussian"),
        ),
        (
            {"particle_law": tb.particle.Series(deep="off", seat="plane")},
            refuses(Mistake.MISSING, "Contact.asperity_law", says='seat="rough"'),
        ),
    ],
)
def test_what_it_does_not_know_is_refused(changes, refusal):
    with refusal:
        contact(**changes)


def test_where_its_table_ends():
    with balances_not(Status.TOO_MUCH, says="h = 0.2 sigma"):
        solved(contact(0.5, density=0), F_star=0.3)
    with refuses(Mistake.RANGE, "d", value="-1.5e-06 m"):
        solved(contact(density=0), d=-5 * SIGMA)
    soft = solved(contact(0.02, density=0), F_star=0.013)
    assert -1 < soft.h / SIGMA < 0


@pytest.mark.check
def test_debris_that_covers_the_surface_is_solved_above_that():
    """Soft wide grains that spread: their ground has no answer down to the end of the table."""
    steel = tb.Material(E=100e9, nu=0.3, H=4.2e9)
    rough = tb.Roughness(sigma=177e-9, R=8.16e-6, alpha=17.0)
    grains = tb.Particles(
        material=steel.replace(H=1.27e9),
        areal_density=1.55e11,
        diameter=tb.LogNormal(median=621e-9, gsd=1.33),
    )
    case = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=rough,
        asperity_law=tb.asperity.Field(),
        particles=grains,
        particle_law=tb.particle.Series(friction_factor=0.05),
    )
    bound = interface(case)
    ground = bound.asperities.ground
    # short steps from nothing lead to the same ground, but for the lowest, which has several
    some = np.arange(9, len(ground.h), 20)
    state, lift = np.zeros((len(some), 14)), np.zeros(len(some))
    for _ in range(400):
        lift = ground._lift(ground.h[some], state[:, :-1], lift)
        found, u = ground._round(ground.h[some], state, lift)
        state += 0.1 * (found - state)
    np.testing.assert_allclose(u, ground.u[some], atol=1e-6)
    low = solved(case, d=(ground.h[0] + 1e-9) * rough.sigma - rough.y_s)
    assert low.shadow < 1
    with balances_not(Status.TOO_MUCH, says="h = 0.4 sigma"):
        solved(case, pressure=1e9)
    # also between the lowest, where plain iteration comes to other grounds; a round adds to a miss
    fulfils_the_equations(bound, np.linspace(ground.h[0], ground.h[3], 20), atol=1e-8)
    assert np.all(np.diff(ground.lifts(np.linspace(ground.h[0], ground.h[3], 50))[:, 0]) < 0)


def test_a_step_without_ground_has_no_answer(monkeypatch):
    """Where no ground is found between two separations of the table, nothing is made up."""
    case = contact(0.1, density=2e10)
    bound = Interface(case)
    ground, (part,) = bound.asperities.ground, bound.populations[0].parts
    fill = type(ground)._columns_at

    def columns_at(self, h):
        if np.any((h > ground.h[10]) & (h < ground.h[11])):
            raise tb.NoEquilibrium("no ground here")
        return fill(self, h)

    monkeypatch.setattr(type(ground), "_columns_at", columns_at)
    h = 0.5 * (ground.h[9:12] + ground.h[10:13])
    d = SIGMA * h - case.roughness.y_s + bound.asperities.centre
    assert np.isnan(bound.asperities.load(d)[:, 0]).tolist() == [False, True, False]
    assert np.isnan(part.columns(d)[:, 0]).tolist() == [False, True, False]
    assert np.isnan(ground.patch_moments(h)[:, 0]).tolist() == [False, True, False]


def test_one_warning_for_crowded_contacts():
    soft = contact(0.02, density=0)
    with warns_of("area", says="0.5"):
        tb.solve(soft, F_star=0.013)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        tb.solve(soft, F_star=0.008)
    with warns_of("area.hard", effect=0.3, says="= 0.41"):
        tb.solve(contact(0.1, law=tb.asperity.ZMC()), F_star=2e-3)


def test_a_seat_of_its_own_height_and_width():
    """Particles on high narrow seats carry more, at any ground."""
    seats = [
        tb.particle.Series(deep="off", zeta_mean=m, zeta_std=s) for m, s in ((0, 1), (1.0, 0.5))
    ]
    one, other = (solved(contact(particle_law=seat), F_star=1e-3) for seat in seats)
    assert other.particle_load_share > 1.3 * one.particle_load_share
    assert isinstance(interface(contact(particle_law=seats[1])), Interface)


def test_panels_end_where_gaps_are_widest_or_narrowest():
    """On ground of any shape, against a dense scan."""
    seat = interface(contact(density=1e10)).particles.parts[0].seat
    rng = np.random.default_rng(4)
    u = rng.normal(size=(40, 13)) * np.exp(-0.5 * np.arange(13))
    turns, zeta = seat._turning_points(np.zeros(40), u)[2], np.linspace(-3.999, 3.999, 40001)
    gaps = seat._gap(np.zeros(40), u, np.broadcast_to(zeta, (40, len(zeta))))
    assert np.count_nonzero(turns > turns.min()) > 20
    for mine, gap in zip(turns, gaps, strict=True):
        scanned = zeta[1:-1][np.diff(np.sign(np.diff(gap))) != 0]
        mine = mine[mine > turns.min()]
        assert len(scanned) == len(mine)
        assert np.max(np.abs(scanned - mine), initial=0.0) < 4e-4


@pytest.mark.parametrize("width", [0.05, pytest.param(0.08, marks=pytest.mark.slow)])
def test_ground_of_narrow_seats_goes_on_without_a_leap(width):
    """Of several grounds the table keeps to one, however close its separations lie."""
    bodies = tb.Material(E=50.5e9, nu=0.458, H=139e6), tb.Material(E=1.64e9, nu=0.078, H=29.2e6)
    case = tb.Contact(
        surfaces=tb.MaterialPair(*bodies),
        roughness=tb.Roughness(sigma=3.3e-6, R=7.95e-3, alpha=9.66, eta_R_sigma=0.02284),
        asperity_law=tb.asperity.Field(),
        particles=tb.Particles(
            material=tb.Material(E=4.92e9, nu=0.166, H=5.82e6),
            diameter=tb.TruncatedGaussian(mean=18.8e-6, std=1.124e-6, n=4.144),
            areal_density=9.0e6,
        ),
        particle_law=tb.particle.Series(
            zeta_mean=1.6, zeta_std=width, shadow="projected", friction_factor=0.03, deep="off"
        ),
    )
    ground = interface(case).asperities.ground
    assert not ground.cut
    assert np.abs(np.diff(ground.w)).max() < 0.015
