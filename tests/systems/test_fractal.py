"""Fractal and stacked surfaces, and particles between them."""

import math

import numpy as np
import pytest
from refusals import Mistake, refuses
from scipy.integrate import quad

import thirdbody as tb
from thirdbody import reference
from thirdbody.systems import fractal
from thirdbody.systems.fractal import GhaedniaMultiscale, MajumdarBhushan, NixGao, Sinusoid, Stack


def surface(D, **more):
    return MajumdarBhushan(D=D, G=1e-12, E_star=1e11, H=2e9, **more)


# ---------------------------------------------------------------- Majumdar and Bhushan
@pytest.mark.parametrize(
    ("D", "a_L", "a_c", "area", "elastic", "plastic"),
    [
        (1.2, 1e-10, 1e-4, 1.5e-10, 0.0, 0.3),
        (1.5, 1e-12, 1e-16, 3e-12, 0.001632490326046, 0.0006),
        (1.5, 1e-8, 1e-16, 3e-8, 3.264980652092, 0.6),
        (1.7, 1e-10, 5.179474679231e-19, 5.666666666667e-10, 0.05615320340539, 0.06478888702169),
        (1.7, 1e-8, 5.179474679231e-19, 5.666666666667e-8, 2.852470475576, 3.247136305619),
    ],
)
def test_stored_fractal_loads(D, a_L, a_c, area, elastic, plastic):
    s = surface(D)
    load = s.load(a_L)
    assert s.critical_area == pytest.approx(a_c, rel=1e-11)
    assert s.area(a_L) == pytest.approx(area, rel=1e-12)
    assert load.elastic == pytest.approx(elastic, rel=1e-12, abs=0)
    assert load.plastic == pytest.approx(plastic, rel=1e-12)


@pytest.mark.parametrize("D", [1.25, 1.5, 1.5 + 1e-9, 1.8])
def test_closed_form_is_the_sum_over_spots(D):
    s = surface(D).replace(G=1e-16)
    a_c = s.critical_area
    a_L = 300 * a_c

    def summed(low, high, of):
        return quad(
            lambda x: float(of(math.exp(x)) * s.spot_density(math.exp(x), a_L=a_L)) * math.exp(x),
            math.log(low),
            math.log(high),
            epsabs=0,
            epsrel=1e-12,
            limit=400,
        )[0]

    load = s.load(a_L)
    assert load.elastic == pytest.approx(summed(a_c, a_L, s.spot_force), rel=1e-11)
    # the lower end of the integrable singularity in closed form
    low = 1e-12 * a_c
    rest = s.H * s.D / (2 - s.D) * a_L ** (s.D / 2) * low ** (1 - s.D / 2)
    plastic = summed(low, a_c * (1 - 1e-14), s.spot_force) + rest
    assert load.plastic == pytest.approx(plastic, rel=1e-9)
    area = summed(1e-12 * a_L, a_L, lambda a: a) + s.area(a_L) * 1e-12 ** (1 - s.D / 2)
    assert s.area(a_L) == pytest.approx(area, rel=1e-9)


def test_no_step_at_the_logarithm():
    around = [surface(1.5 + step).load(1e-10).total for step in (-1e-10, 0.0, 1e-10)]
    assert around[1] == pytest.approx(0.5 * (around[0] + around[2]), rel=1e-13)
    assert around[0] == pytest.approx(around[2], rel=1e-7)


def test_exponent_where_elastic_spots_carry():
    s = surface(1.3)
    a_L = s.critical_area * np.array([1e60, 1e62])
    slope = np.diff(np.log(s.load(a_L).total)) / np.diff(np.log(s.area(a_L)))
    assert slope[0] == pytest.approx((3 - s.D) / 2, abs=1e-4)


def test_small_spots_are_plastic_and_large_ones_elastic():
    s = surface(1.5)
    a_c = s.critical_area
    assert s.spot_force(0.1 * a_c) / (0.1 * a_c) == pytest.approx(s.H, rel=1e-14)
    # the published factor between the two loads at a_c, and a pressure that falls with size
    assert s.spot_force(a_c) / (s.H * a_c) == pytest.approx(2 * math.sqrt(math.pi) / 3, rel=1e-12)
    assert s.spot_force(1e4 * a_c) / (1e4 * a_c) < s.H
    # all plastic below a_c
    load = s.load(0.5 * a_c)
    assert load.elastic == 0
    assert load.plastic == pytest.approx(s.H * s.area(0.5 * a_c), rel=1e-14)


def test_an_elastic_spot_is_hertz_on_its_own_area():
    s, a = surface(1.4), 1e-12
    radius = math.sqrt(a / math.pi)
    hertz = 4 * s.E_star * radius**3 / (3 * s.curvature_radius(a))
    assert hertz == pytest.approx(float(s.spot_force(a)), rel=1e-12)


def test_largest_spot_inverts_the_load():
    for D in (1.05, 1.3, 1.5, 1.9):
        s = surface(D)
        P = np.geomspace(1e-9, 1e6, 7)
        np.testing.assert_allclose(s.load(s.largest_spot(P)).total, P, rtol=1e-12)
    assert surface(1.5).largest_spot(0.0) == 0


def test_fraction_needs_the_nominal_area():
    with pytest.raises(tb.errors.InvalidValue, match="nominal_area"):
        surface(1.5).fraction(1e6)
    s = surface(1.5, nominal_area=1e-6)
    fraction = s.fraction([1e4, 1e6, 1e12])
    assert s.load(fraction[1] * 1e-6 / 3).total == pytest.approx(1.0, rel=1e-12)
    assert fraction[2] == 1


def test_dimension_near_one_does_not_overflow():
    s = surface(1.001)
    assert s.critical_area == math.inf
    assert s.load(1e-10).total == pytest.approx(s.H * s.area(1e-10), rel=1e-14)


# ---------------------------------------------------------------- sinusoids
@pytest.mark.parametrize(
    ("q", "fraction"),
    [
        (1e-6, 7.6462535131561e-05),
        (0.01, 0.039703409909553),
        (0.3, 0.4762413835411),
        (0.79999, 0.90491877663293),
        (0.80001, 0.90451180879316),
        (1.0, 1.0),
    ],
)
def test_stored_sinusoid(q, fraction):
    assert fractal.jackson_streator(q) == pytest.approx(fraction, rel=1e-12)


def test_sinusoid_limits():
    wave, E_star = Sinusoid(amplitude=1e-8, frequency=1e5), 1e11
    p_star = wave.full_contact_pressure(E_star)
    assert p_star == pytest.approx(math.sqrt(2) * math.pi * E_star * 1e-3, rel=1e-14)
    # light load: one Hertz contact at each crest, 2f² of them per area, R = 1/(4π²f²Δ)
    R = 1 / (4 * math.pi**2 * wave.frequency**2 * wave.amplitude)
    crests = 2 * wave.frequency**2
    q = 1e-24  # what follows the contact of Hertz is less by q^0.37
    spot = reference.hertz_point(q * p_star / crests, R=R, E_star=E_star)
    assert wave.fraction(q * p_star, E_star=E_star) == pytest.approx(crests * spot.area, rel=1e-7)
    step = fractal.jackson_streator(0.8) / fractal.jackson_streator(0.8 - 1e-14)
    assert step - 1 == pytest.approx(-0.000461443, rel=1e-5)
    assert list(fractal.jackson_streator([0.0, 5.0])) == [0, 1]


LEVELS = tuple(
    Sinusoid(amplitude=a, frequency=f) for a, f in ((1e-6, 1e3), (5e-7, 1e4), (1e-7, 1e5))
)


@pytest.mark.parametrize(
    ("p", "fraction"),
    [(1e-7, 4.583691494805e-06), (1e-4, 0.003924735469202), (0.01, 0.3409906465236)],
)
def test_stored_stack(p, fraction):
    assert Stack(levels=LEVELS, E_star=1.0).fraction(p) == pytest.approx(fraction, rel=1e-12)


def test_stack_does_not_converge_and_says_so():
    def stack(count, **more):
        return Stack.self_affine(
            hurst=0.8, amplitude=1e-6, frequency=1e3, ratio=2, count=count, E_star=1.0, **more
        )

    areas = stack(40).fractions(1e-5)
    assert np.all(np.diff(areas) < 0)
    # each finer scale ends up lowering the area by the rise of p*: no limit but zero
    assert areas[-1] / areas[-2] == pytest.approx(2**-0.2, rel=1e-6)
    report = stack(40).convergence(1e-5)
    assert not report.converged
    assert "not converged" in report.message
    hard = stack(40, H=0.03)
    report = hard.convergence(1e-5)
    assert report.converged
    assert report.stopped_by_hardness
    assert hard.fraction(1e-5) == pytest.approx(1e-5 / 0.03, rel=1e-14)
    assert list(hard.fraction([0.0, 1.0])) == [0, 1]
    # a single smooth wave, nearly flat, has converged
    assert Stack(levels=LEVELS[:1], E_star=1.0).convergence(0.0044).converged


def test_stack_checks_its_levels():
    with refuses(Mistake.ORDER, "Stack.levels"):
        Stack(levels=LEVELS[::-1], E_star=1.0)
    with refuses(Mistake.KIND, "Stack.levels"):
        Stack(levels=(), E_star=1.0)
    for value in (Stack(levels=LEVELS, E_star=1.0), surface(1.5)):
        assert type(value).from_dict(value.to_dict()) == value


# ---------------------------------------------------------------- particles
def rigid_elastic(density=1e13):
    """Elastic particles, all contact moduli 1 Pa; the stored values cut the Gaussian at x = 0 only.

    They are not divided by the mass above zero, 1 − 2.9e-7, hence the factor on the density.
    """
    body = tb.Material(E=2.0, nu=0.0, H=1.0)
    sizes = tb.TruncatedGaussian(mean=1e-7, std=2e-8, n=8.5)
    return GhaedniaMultiscale(
        surface=Stack(levels=LEVELS[:2], E_star=1.0),
        surfaces=tb.MaterialPair(body, body),
        particles=tb.Particles(
            material=body, diameter=sizes, areal_density=density * sizes.retained_mass
        ),
        law=tb.asperity.GW(),
    )


@pytest.mark.parametrize(
    ("p", "A_0", "local", "gap", "A_real"),
    [
        (1e-7, 1.95907763459e-05, 0.0051044429396, 7.752369241e-08, 4.194856424e-07),
        (1e-5, 0.00128327185048, 0.00779258112478, 6.690716441e-08, 3.759894994e-05),
        (3e-3, 0.251162455646, 0.0119444603784, 5.349748046e-08, 0.009967756024),
    ],
)
def test_stored_two_submodels(p, A_0, local, gap, A_real):
    state = rigid_elastic().solve(p)
    assert state.A_0 == pytest.approx(A_0, rel=1e-11)
    assert state.local_pressure == pytest.approx(local, rel=1e-11)
    assert state.gap == pytest.approx(gap, rel=3e-10)
    assert state.A_real == pytest.approx(A_real, rel=3e-10)


def test_particle_pressure_with_closed_patches():
    # (η E*/3) ⟨x²⟩ of the stored, unnormalised density
    model = rigid_elastic()
    film = fractal.ParticleFilm(model)
    assert film(np.zeros(1))[0, 0] == pytest.approx(0.03466666664, rel=1e-10)


def test_few_particles_let_the_asperities_touch():
    model = rigid_elastic(density=1e12)
    p = 1e-5
    state = model.solve(p)
    assert state.gap == 0
    assert 0 < state.particle_load_share < 1
    pressed = fractal.ParticleFilm(model)(np.zeros(1))[0]
    assert state.particle_load_share == pytest.approx(state.A_0 * pressed[0] / p, rel=1e-12)
    # flat patches touch all around the particles
    assert state.A_real == pytest.approx(state.A_0, rel=1e-12)
    assert state.A_particles == pytest.approx(state.A_0 * pressed[1], rel=1e-12)


def test_the_film_carries_the_load():
    steel, glass = tb.materials["S45C"], tb.materials["SiO2"]
    pair = tb.MaterialPair(steel, glass)
    sizes = tb.distributions.Mixture(
        parts=(
            tb.distributions.Monodisperse(mean=90e-9),
            tb.TruncatedGaussian(mean=60e-9, std=9e-9),
        ),
        weights=(1, 3),
    )
    model = GhaedniaMultiscale(
        surface=MajumdarBhushan(D=1.4, G=1e-14, E_star=pair.E_star, H=pair.H, nominal_area=1e-6),
        surfaces=pair,
        particles=tb.Particles(material=glass, diameter=sizes, areal_density=3e13),
    )
    p = np.geomspace(3e5, 3e6, 4)
    state = model.solve(p)
    assert np.all(state.gap > 0)
    carried = state.A_0 * fractal.ParticleFilm(model)(state.gap)[:, 0]
    np.testing.assert_allclose(carried, p, rtol=1e-9)
    assert np.all(state.A_real < state.A_0)
    one = model.solve(float(p[2]))
    assert isinstance(one.gap, float)
    assert one.gap == pytest.approx(state.gap[2], rel=1e-12)


@pytest.mark.parametrize("second", ["S45C", "SiO2"])
@pytest.mark.parametrize("sizes", ["narrow", "single"])
def test_constant_hardness_factor_is_a_harder_pair(second, sizes):
    """The quadrature for a size effect against the tables, with a factor that is constant."""
    diameter = {
        "narrow": tb.TruncatedGaussian(mean=80e-9, std=16e-9),
        "single": tb.distributions.Monodisperse(mean=80e-9),
    }[sizes]
    bodies = [tb.materials["S45C"], tb.materials[second]]

    def model(factor, effect=None):
        harder = [body.replace(H=factor * body.H) for body in bodies]
        pair = tb.MaterialPair(*harder)
        return GhaedniaMultiscale(
            surface=Stack(levels=LEVELS[:1], E_star=pair.E_star),
            surfaces=pair,
            particles=tb.Particles(
                material=harder[0].replace(H=2 * harder[0].H),
                diameter=diameter,
                areal_density=2e13,
            ),
            size_effect=effect,
        )

    gaps = np.array([0.0, 20e-9, 60e-9, 79e-9])
    table = fractal.ParticleFilm(model(1.5))(gaps)
    direct = fractal.ParticleFilm(model(1.0, lambda depth: 1.5 + 0 * depth))(gaps)
    np.testing.assert_allclose(direct, table, rtol=1e-5)


def test_hardness_that_grows_in_small_dents_lowers_the_area():
    steel = tb.materials["S45C"]
    pair = tb.MaterialPair(steel, steel)
    plain = GhaedniaMultiscale(
        surface=Stack(levels=[Sinusoid(amplitude=2e-7, frequency=1e4)], E_star=pair.E_star),
        surfaces=pair,
        particles=tb.Particles(
            material=tb.materials["SiO2"],
            diameter=tb.distributions.Monodisperse(mean=100e-9),
            areal_density=3e13,
        ),
    )
    p = 1e7
    areas = [plain.solve(p).A_real]
    for h_star in (1e-12, 100e-9, 1e-6):
        areas.append(plain.replace(size_effect=NixGao(h_star=h_star)).solve(p).A_real)
    assert areas[1] == pytest.approx(areas[0], rel=1e-3)
    assert areas[0] > areas[2] > areas[3]


def test_two_submodels_check_their_input():
    model = rigid_elastic()
    with refuses(Mistake.BEYOND, "GhaedniaMultiscale.surface.E_star", value="2"):
        model.replace(**{"surface.E_star": 2.0})
    for law in (
        tb.asperity.JKR(w=0.05),
        tb.asperity.DMT(w=0.05),
        tb.asperity.Coated(E_1=2e11, E_2=1e11, t=1e-8),
    ):
        name = type(law).__name__
        with refuses(Mistake.BEYOND, "GhaedniaMultiscale.law", value=name) as caught:
            model.replace(law=law)
        assert len(caught.value.problems) == 1
    with refuses(Mistake.BEYOND, "GhaedniaMultiscale.law"):
        model.replace(law=tb.asperity.JG(), size_effect=NixGao(h_star=1e-7))
    with refuses(Mistake.BEYOND, "GhaedniaMultiscale.surface.H", value="2"):
        model.replace(**{"surface.H": 2.0})
    with refuses(Mistake.KIND, "GhaedniaMultiscale.surface", value="3.0"):
        model.replace(surface=3.0)
    with pytest.raises(tb.errors.InvalidValue, match="pressure"):
        model.solve([1e-6, 0.0])


# ---------------------------------------------------------------- the full stored set
def test_all_stored_values(shared_reference):
    stored = shared_reference("laws.json")
    for row in stored["majumdar_bhushan"]:
        s = MajumdarBhushan(D=row["D"], G=row["G"], E_star=row["E"], H=row["H"])
        load = s.load(row["aL"])
        found = (s.critical_area, s.area(row["aL"]), load.elastic, load.plastic)
        wanted = [float(row[key]) for key in ("ac", "A", "Pe", "Pp")]
        assert found == pytest.approx(wanted, rel=1e-12, abs=0)
    for row in stored["jgh"]:
        assert fractal.jackson_streator(row["q"]) == pytest.approx(
            float(row["fraction"]), rel=1e-12
        )
    waves = [Sinusoid(amplitude=a, frequency=f) for a, f in stored["stack"]["levels"]]
    for row in stored["stack"]["values"]:
        found = Stack(levels=waves, E_star=1.0).fraction(row["p"])
        assert found == pytest.approx(float(row["A"]), rel=1e-12)
    model = rigid_elastic()
    closed = fractal.ParticleFilm(model)(np.zeros(1))[0, 0]
    for row in stored["ghaednia_two_submodels"]["values"]:
        state = model.solve(row["p_over_Estar"])
        assert closed == pytest.approx(float(row["Pp_at_zero_gap"]), rel=2e-10)
        for name, key in (("A_0", "A0"), ("local_pressure", "p_local")):
            assert getattr(state, name) == pytest.approx(float(row[key]), rel=1e-11)
        # ten digits are stored
        assert state.gap == pytest.approx(float(row["gap"]), rel=1e-10, abs=5.1e-18)
        assert state.A_real == pytest.approx(float(row["A_real"]), rel=2e-10)
