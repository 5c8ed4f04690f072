"""Friction: identities, limits, published signs, and explicit particles one by one."""

import dataclasses
import math

import numpy as np
import pytest
from refusals import Mistake, refuses, warns_of
from scipy import integrate

import thirdbody as tb
from thirdbody.contact.evaluation import spots_of
from thirdbody.contact.interface import interface
from thirdbody.effects import Friction, StaticFriction
from thirdbody.effects.friction import PARTS
from thirdbody.effects.single.ploughing import coefficient, rear_support
from thirdbody.effects.static_friction import FAILS, full_stick, kogut_etsion
from thirdbody.errors import code_of

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
SOFT = STEEL.replace(H=2.5e9)
TAU = {"tau_ss": 580e6, "tau_sa": 200e6}


def contact(x_a=500e-9, density=1e10, *, first=STEEL, second=STEEL, particle=SILICA, **friction):
    dust = tb.Particles(
        material=particle,
        diameter=tb.TruncatedGaussian(mean=x_a or 1e-7, std=0.2 * (x_a or 1e-7)),
        areal_density=density,
    )
    return tb.Contact(
        surfaces=tb.MaterialPair(first, second),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=dust if x_a else None,
        particle_law=tb.particle.Series(deep="off"),
        outputs=(Friction(**(TAU | friction)),),
    )


def solved(case, **load):
    with pytest.warns(tb.errors.RangeWarning) if load.pop("warns", False) else _nothing():
        return tb.solve(case, **(load or {"pressure": 5e6}))


class _nothing:
    def __enter__(self):
        import warnings

        self.guard = warnings.catch_warnings()
        self.guard.__enter__()
        warnings.simplefilter("ignore")

    def __exit__(self, *problem):
        self.guard.__exit__(*problem)


def groups(case, state):
    return spots_of(case, interface(case), np.atleast_1d(state.d), np.atleast_1d(state.shadow))


# ------------------------------------------------------------------ values of a second program
@pytest.mark.parametrize(
    ("x_a", "density", "mu", "close"),
    [
        (0.0, 0.0, 0.15307781176777055, 1e-13),
        # the other program sums particles to 7e-7 of their part; finer sums do not move ours
        (200e-9, 1e10, 0.1562437729764932, 6e-8),
        (500e-9, 1e10, 0.21186162417680454, 1e-8),
        (500e-9, 1e11, 0.12228755635180351, 1e-11),
    ],
)
def test_values_of_another_program(x_a, density, mu, close):
    assert solved(contact(x_a, density or 1e10)).outputs["mu"] == pytest.approx(mu, rel=close)


def test_who_rolls():
    equal = solved(contact()).outputs
    assert equal["rolling_share"] == pytest.approx(1, rel=1e-12)
    unequal = solved(contact(second=SOFT)).outputs
    # 0.0520 in the other program, which has no split at the jump
    assert unequal["rolling_share"] == pytest.approx(0.05202592951177722, rel=3e-3)


# ------------------------------------------------------------------ identities
CASES = {
    "equal": {},
    "unequal": {"second": SOFT},
    "softer first": {"first": SOFT},
    "severity": {"second": SOFT, "rolling": "severity"},
    "long": {"second": SOFT, "aspect": 1.4, "x_a": 300e-9},
    "offset": {"second": SOFT, "offset": 0.15, "x_a": 300e-9},
    "film": {"tau_sa": 1e7, "alpha_ss": 0.05, "alpha_sa": 0.08, "second": SOFT},
    "factor": {"tau_ss": None, "tau_sa": None, "m_ss": 0.3, "m_sa": 0.2, "second": SOFT},
    "growing": {"alpha_T": 9.0, "second": SOFT},
    "rigid": {"rear": "rigid", "angle": "area", "second": SOFT},
    "soft particles": {"particle": SILICA.replace(H=4e9)},
    "two bodies": {"x_a": 0.0},
}


@pytest.mark.parametrize("name", CASES)
def test_parts_add_up(name):
    out = solved(contact(**CASES[name]), pressure=np.geomspace(1e5, 1e8, 7)).outputs
    assert np.allclose(sum(out[f"mu_{part}"] for part in PARTS), out["mu"], rtol=1e-13, atol=0)
    ploughed = out["mu_ss_plough"] + out["mu_sa_plough"] + out["mu_sa_roll"]
    tracks = out["mu_plough_1"] + out["mu_plough_2"]
    if name == "soft particles":
        assert np.all(tracks < ploughed)
    else:
        assert np.allclose(tracks, ploughed, rtol=1e-12, atol=0)


@pytest.mark.parametrize("name", [name for name in CASES if name != "two bodies"])
def test_weighted_with_the_load(name):
    state = solved(contact(**CASES[name]))
    w, out = state.particle_load_share, state.outputs
    assert out["mu"] == pytest.approx((1 - w) * out["mu_ss"] + w * out["mu_sa"], rel=1e-12)


@pytest.mark.parametrize("name", CASES)
def test_swapped_surfaces(name):
    case = contact(**CASES[name])
    pair = case.surfaces
    other = case.replace(surfaces=tb.MaterialPair(pair.second, pair.first))
    one, two = solved(case).outputs, solved(other).outputs
    for column, value in one.items():
        swapped = {"mu_plough_1": "mu_plough_2", "mu_plough_2": "mu_plough_1"}.get(column, column)
        if pair.first == pair.second:
            swapped = column
        assert two[swapped] == pytest.approx(value, rel=1e-9, abs=1e-15, nan_ok=True), column


@pytest.mark.parametrize("name", CASES)
def test_stronger_and_larger_is_the_same(name):
    """Stresses × 3 at the same separation; lengths × 10 with the same coverage."""
    case = contact(**CASES[name])
    state = solved(case)

    def stronger(body):
        return body.replace(E=3 * body.E, H=3 * body.H)

    friction = case.outputs[0]
    taus = {
        key: 3 * getattr(friction, key)
        for key in ("tau_ss", "tau_sa")
        if getattr(friction, key) is not None
    }
    pair = case.surfaces
    changes = {
        "surfaces": tb.MaterialPair(stronger(pair.first), stronger(pair.second)),
        "outputs": (friction.replace(**taus),),
    }
    if case.particles is not None:
        changes["particles"] = case.particles.replace(material=stronger(case.particles.material))
    strong = solved(case.replace(**changes), d=state.d).outputs
    larger = {"roughness": tb.Roughness(sigma=1e-6, R=28e-6)}
    if case.particles is not None:
        size = case.particles.diameter
        larger["particles"] = case.particles.replace(
            diameter=tb.TruncatedGaussian(mean=10 * size.mean, std=10 * size.std),
            areal_density=case.particles.areal_density / 100,
        )
    large = solved(case.replace(**larger), d=10 * state.d).outputs
    for column, value in state.outputs.items():
        assert strong[column] == pytest.approx(value, rel=1e-9, abs=1e-14, nan_ok=True), column
        assert large[column] == pytest.approx(value, rel=1e-9, abs=1e-14, nan_ok=True), column


class Finer(Friction):
    """The same with many more nodes."""

    __slots__ = ()

    def splits(self, probe):
        return sorted({*Friction.splits(self, probe), *np.geomspace(1e-5, 1.2, 30)})


@pytest.mark.parametrize("name", ["unequal", "severity", "long", "film", "growing", "rigid"])
def test_finer_sums(name):
    case = contact(**CASES[name])
    friction = case.outputs[0]
    fields = {item.name: getattr(friction, item.name) for item in dataclasses.fields(friction)}
    one, two = solved(case).outputs, solved(case.replace(outputs=(Finer(**fields),))).outputs
    for column in one:
        assert two[column] == pytest.approx(one[column], rel=1e-9, abs=1e-13, nan_ok=True), column


def test_shear_alone_is_the_area():
    state = solved(contact(0.0))
    expected = TAU["tau_ss"] * state.A_ss / state.pressure
    assert state.outputs["mu"] == pytest.approx(expected, rel=1e-13)
    assert math.isnan(state.outputs["mu_sa"])
    plastic = solved(contact(0.0, tau_ss=None, m_ss=0.5).replace(asperity_law=tb.asperity.JG()))
    assert plastic.outputs["mu"] > 0


def test_fewer_particles_approach_none():
    bare = solved(contact(0.0)).outputs["mu"]
    found = [solved(contact(density=n)).outputs["mu"] - bare for n in (1e6, 1e5, 1e4)]
    np.testing.assert_allclose(np.array(found[:-1]) / found[1:], 10, rtol=1e-3)


def test_sign_follows_from_the_load_of_a_particle():
    bare = solved(contact(0.0)).outputs["mu"]
    few, some, many = (solved(contact(density=n)).outputs for n in (1e10, 3e10, 1e11))
    assert few["mu"] > some["mu"] > bare > many["mu"]
    assert few["mu_sa"] > bare > many["mu_sa"]
    assert few["mu"] == pytest.approx(0.212, abs=5e-4)
    assert some["mu"] == pytest.approx(0.156, abs=5e-4)
    assert many["mu"] == pytest.approx(0.122, abs=5e-4)


# ------------------------------------------------------------------ one contact
def particles(case, pressure=5e6):
    state = solved(case, pressure=pressure)
    (spots,) = groups(case, state)[1]
    return case.outputs[0], spots


@pytest.mark.parametrize("name", ["equal", "unequal", "film", "rigid", "soft particles"])
def test_a_sphere_takes_the_cheapest_motion(name):
    """Of three explicit ones, written out here for every particle."""
    case = contact(**CASES[name])
    friction, spots = particles(case)
    x = spots.x
    loaded = spots.load > 0
    mu = []
    for delta, first, area in zip(spots.depths, spots.yields, spots.areas, strict=True):
        depth = delta
        if friction.angle == "area":
            sine = np.sqrt(np.minimum(area / (np.pi * (x / 2) ** 2), 1))
            depth = x * np.sin(np.arcsin(sine) / 2) ** 2
        s = np.maximum(delta / (first * x), 1e-9)
        kappa = 0.0 if friction.rear == "rigid" else rear_support(s)
        mu.append(coefficient(depth, radius=x / 2, rear=kappa))
    hard = [
        case.particles.material.H > body.H for body in (case.surfaces.first, case.surfaces.second)
    ]
    roll = 0.5 * (mu[0] + mu[1]) * spots.load
    slide = [
        acts * m * spots.load + friction.tau_sa * area + friction.alpha_sa * spots.load
        for m, area, acts in zip(mu, spots.areas, hard, strict=True)
    ]
    cheapest = np.minimum(roll, np.minimum(*slide))
    found = sum(friction.of_particles(spots).values())
    assert np.allclose(found[loaded], cheapest[loaded], rtol=1e-11, atol=0)
    if name in ("unequal", "film", "rigid"):
        less = np.argmin(mu, axis=0)
        arm = (
            np.take_along_axis(np.array(slide), less[None], 0)[0] - np.min(mu, axis=0) * spots.load
        )
        balance = 0.5 * np.abs(mu[0] - mu[1]) * spots.load < arm
        assert np.array_equal(friction.rolls(spots)[loaded], balance[loaded])


def test_rolling_is_the_power_of_two_tracks():
    """Two tracks, each passed at half the speed."""
    case = contact(second=SOFT, rear="rigid", tau_sa=5e9)
    friction, spots = particles(case)
    from thirdbody.effects.single.ploughing import groove_area

    loaded = spots.load > 0
    assert np.all(friction.rolls(spots)[loaded])
    power = 0.0
    for depth in spots.depths:
        deep = np.minimum(depth, spots.radius)
        b2 = np.maximum(deep * (2 * spots.radius - deep), 1e-300)
        pressure = spots.load / (np.pi / 2 * b2)
        power = power + 0.5 * pressure * groove_area(deep, radius=spots.radius)
    found = friction.of_particles(spots)["sa_roll"]
    assert np.allclose(found[loaded], power[loaded], rtol=1e-12, atol=0)


def test_equal_surfaces():
    for tau in (1e3, 1e9):
        friction, spots = particles(contact(tau_sa=tau))
        loaded = spots.load > 0
        assert np.all(friction.rolls(spots)[loaded])
        plough = friction.motion(spots).plough[0]
        force = friction.of_particles(spots)
        expected = (plough * spots.load)[loaded]
        np.testing.assert_allclose(force["sa_roll"][loaded], expected, rtol=1e-13)
    friction, spots = particles(contact(tau_sa=0.0))
    assert not np.any(friction.rolls(spots))


def test_the_harder_surface_is_grooved():
    friction, spots = particles(contact(second=SOFT))
    slides = ~friction.rolls(spots) & (spots.load > 0)
    assert np.any(slides)
    assert np.all(friction.sliding_side(spots)[slides] == 0)
    assert np.all(spots.depths[0][slides] < spots.depths[1][slides])


def test_elastic_contacts_do_not_plough():
    friction, spots = particles(contact(), pressure=1e4)
    elastic = (spots.load > 0) & (spots.depths[0] <= spots.yields[0] * spots.x)
    assert np.any(elastic)
    assert np.all(friction.of_particles(spots)["sa_roll"][elastic] == 0)
    assert np.all(friction.rolls(spots)[elastic])


def test_long_particles_tumble_only_in_a_wide_gap():
    friction, spots = particles(contact(300e-9, aspect=1.3))
    gap = spots.x - spots.depths[0] - spots.depths[1]
    loaded = spots.load > 0
    assert np.array_equal(friction.rolls(spots)[loaded], (1.3 * spots.x < 1.74 * gap)[loaded])
    never = solved(contact(300e-9, aspect=1.75)).outputs
    assert never["rolling_share"] == 0
    assert never["mu_sa_plough"] > 0


@pytest.mark.parametrize("second", [None, SOFT], ids=["equal", "unequal"])
def test_grains_with_an_offset_turn_over_where_they_are_held(second):
    """min(μ_p + τa/f) ≥ (e/x)/(g/x)."""
    bodies = {} if second is None else {"second": second}
    friction, spots = particles(contact(300e-9, offset=0.2, **bodies))
    gap = spots.x - spots.depths[0] - spots.depths[1]
    loaded = spots.load > 0
    mu = friction.motion(spots).plough
    with np.errstate(invalid="ignore", divide="ignore"):
        held = np.minimum(*(m + 2e8 * a / spots.load for m, a in zip(mu, spots.areas, strict=True)))
        turns = (held >= 0.2 * spots.x / gap) & (gap > 0)
    assert np.array_equal(friction.rolls(spots)[loaded], turns[loaded])
    assert 0 < np.count_nonzero(turns[loaded]) < np.count_nonzero(loaded)


def test_an_offset_lets_equal_surfaces_be_grooved():
    rolling, sliding = (solved(contact(300e-9, offset=e)).outputs for e in (0.0, 2.0))
    assert rolling["rolling_share"] == 1
    assert sliding["rolling_share"] < 1e-9  # barely loaded ones are held by their shear
    assert sliding["mu_sa_plough"] > 0
    assert sliding["mu_plough_1"] == sliding["mu_plough_2"]  # over either of them
    ladder = [solved(contact(300e-9, offset=e)).outputs["rolling_share"] for e in (0.05, 0.1, 0.2)]
    assert np.all(np.diff(ladder) < 0)


def test_severity_decides_instead():
    friction, spots = particles(contact(300e-9, rolling="severity"), pressure=1e4)
    S = 6 * spots.load / (np.pi * spots.x**2) * 2 / 5e9
    loaded = spots.load > 0
    assert np.array_equal(friction.rolls(spots)[loaded], (S < 0.0076)[loaded])


def test_soft_particles_flatten():
    soft = SILICA.replace(H=4e9)
    out = solved(contact(particle=soft)).outputs
    assert out["mu_sa_plough"] == 0
    assert out["mu_plough_1"] == 0
    as_hard = solved(contact(particle=soft, soft_particles="plough")).outputs
    assert as_hard["mu_plough_1"] > 0
    assert as_hard["mu"] >= out["mu"]


def test_asperities_plough_a_much_softer_surface():
    state = solved(contact(0.0, second=SOFT))
    case = contact(0.0, second=SOFT)
    (spots,) = groups(case, state)[0]
    # by a quadrature of its own over the heights
    law, R, E, H = spots.law, spots.R, spots.E_star, spots.H
    omega_1 = float(law.yield_interference(R=R, E_star=E, H=H))

    def density(y):
        omega = y * omega_1
        f = float(law.force(omega, R=R, E_star=E, H=H))
        mu = float(coefficient(omega, radius=R, rear=rear_support(y)))
        z = float(spots.lowest[0]) + omega / spots.sigma_s
        return mu * f * math.exp(-z * z / 2) / math.sqrt(2 * math.pi) * omega_1 / spots.sigma_s

    edges = [0.0, 1.0, 54.0, 8 * spots.sigma_s / omega_1]
    total = sum(
        integrate.quad(density, a, b, epsabs=0, epsrel=1e-11, limit=200)[0]
        for a, b in zip(edges[:-1], edges[1:], strict=True)
    )
    found = state.outputs["mu_ss_plough"] * state.pressure
    assert found == pytest.approx(float(spots.density[0]) * total, rel=1e-8)
    assert state.outputs["mu_plough_2"] == pytest.approx(state.outputs["mu_ss_plough"], rel=1e-13)
    limit = contact(0.0, second=SOFT, hardness_ratio=2.0)
    assert solved(limit).outputs["mu_ss_plough"] == 0


# ------------------------------------------------------------------ shear strength and growth
def test_shear_strength_over_that_of_the_softer_body():
    H = 5e9
    one = solved(contact(tau_ss=None, m_ss=0.3, tau_sa=None, m_sa=0.1)).outputs
    k = H / (3 * math.sqrt(3))
    two = solved(contact(tau_ss=0.3 * k, tau_sa=0.1 * k)).outputs
    for column in two:
        assert one[column] == pytest.approx(two[column], rel=1e-12), column


def test_pressure_dependent_shear_strength():
    """A part α p of τ adds α to the coefficient of asperities."""
    plain = solved(contact(0.0)).outputs["mu"]
    assert solved(contact(0.0, alpha_ss=0.07)).outputs["mu"] == pytest.approx(plain + 0.07)


@pytest.mark.parametrize("c", [0.1, 0.5, 0.95])
def test_junctions_of_a_plastic_contact(c):
    """μ = c/√(α_T(1 − c²)) under full plasticity, which starts at p = H."""
    H, area = 5e9, np.array([2e-12])
    friction = Friction(tau_ss=c * H / 3, tau_sa=0.0, alpha_T=9.0)
    force = friction.shear_force("ss", area=area, load=H * area, H=H)
    assert force / (H * area) == pytest.approx(c / math.sqrt(9 * (1 - c * c)), rel=1e-13)
    if c == 0.5:
        assert force / (H * area) == pytest.approx(0.19245, abs=5e-6)
    if c == 0.95:
        assert force / (H * area) == pytest.approx(1.014144974098885, rel=1e-13)


def test_a_growing_junction_obeys_its_yield_criterion():
    H, area = 5e9, np.array([1e-12])
    friction = Friction(tau_ss=3e8, tau_sa=0.0, alpha_ss=0.1, alpha_T=9.0)
    for p in (1e9, 4.6e9, 4.9e9, 5e9):
        force = float(friction.shear_force("ss", area=area, load=p * area, H=H)[0])
        grown = (force - 0.1 * p * area[0]) / 3e8
        tau, pressure = force / grown, p * area[0] / grown
        assert grown >= area[0] * (1 - 1e-14)
        if grown > area[0] * (1 + 1e-9):
            assert math.hypot(pressure, 3 * tau) == pytest.approx(H, rel=1e-12)
        else:
            assert math.hypot(pressure, 3 * tau) <= H * (1 + 1e-9)


def test_growth_raises_friction_and_none_is_the_default():
    plain, grown = (solved(contact(0.0, alpha_T=a)).outputs["mu"] for a in (None, 9.0))
    assert plain == pytest.approx(0.15307781176777055, rel=1e-12)
    assert grown > plain


# ------------------------------------------------------------------ mistakes
@pytest.mark.parametrize(
    ("fields", "code", "name", "value"),
    [
        ({}, Mistake.MISSING, "tau_ss", None),
        ({"m_ss": 0.1}, Mistake.CLASH, "tau_ss", None),
        ({"tau_ss": -1.0}, Mistake.RANGE, "tau_ss", "-1.0"),
        ({"rear": "soft"}, Mistake.OPTION, "rear", "'soft'"),
        ({"rear": 1.5}, Mistake.OPTION, "rear", "1.5"),
        ({"rolling": "coin"}, Mistake.OPTION, "rolling", "'coin'"),
        ({"aspect": 0.5}, Mistake.RANGE, "aspect", "0.5"),
        ({"offset": -0.1}, Mistake.RANGE, "offset", "-0.1"),
        ({"offset": 0.1, "rolling": "severity"}, Mistake.IDLE, "offset", "0.1"),
    ],
)
def test_mistakes(fields, code, name, value):
    with refuses(code, "Friction." + name, value=value):
        Friction(**({"tau_ss": 1e8} if fields else {}) | fields)


def test_mistakes_of_a_contact():
    with refuses(Mistake.MISSING, "outputs.friction", says="tau_sa"):
        contact(tau_sa=None)
    assert contact(0.0, tau_sa=None).two_body
    with refuses(Mistake.RANGE, "outputs.friction", says="1.667 GPa"):
        contact(0.0, tau_ss=2e9, alpha_T=9.0)
    with refuses(Mistake.BEYOND, "outputs.friction", says="m_ss = 1"):
        contact(0.0, tau_ss=None, m_ss=1.0, alpha_T=9.0)


def test_deep_particles_are_told():
    """Once, by the state itself, with outputs and without."""
    for case in (contact(second=SOFT), contact(second=SOFT).replace(outputs=())):
        with warns_of("buried"):
            state = tb.solve(case, pressure=5e6)
        assert [code_of(note) for note in state.warnings].count("buried") == 1


# ------------------------------------------------------------------ static friction
def test_static_friction_of_one_sphere():
    assert kogut_etsion(1.0) == 0.52
    assert kogut_etsion(6.0) == pytest.approx(0.036, rel=1e-12)
    assert kogut_etsion(1 + 1e-12) == pytest.approx(0.511, abs=1e-9)
    cubic = np.roots([-0.007, 0.085, -0.389, 0.822])
    real = float(cubic[np.isreal(cubic)].real[0])
    assert pytest.approx(real, abs=1e-8) == FAILS
    assert kogut_etsion(FAILS) == 0
    assert full_stick(1e6) == pytest.approx(0.26, abs=1e-12)
    assert full_stick(1.0) == pytest.approx(0.26 / math.tanh(0.27), rel=1e-14)


@pytest.mark.parametrize("law", ["full stick", "kogut-etsion"])
def test_static_friction_of_rough_surfaces(law):
    case = contact(0.0).replace(outputs=(StaticFriction(law=law),))
    state = solved(case)
    (spots,) = groups(case, state)[0]
    body = {"R": spots.R, "E_star": spots.E_star, "H": spots.H}
    omega_1 = float(spots.law.yield_interference(**body))
    critical = float(spots.law.force(omega_1, **body))

    def density(y):
        f = float(spots.law.force(y * omega_1, **body))
        mu = float(full_stick(f / critical) if law == "full stick" else kogut_etsion(y))
        z = float(spots.lowest[0]) + y * omega_1 / spots.sigma_s
        return mu * f * math.exp(-z * z / 2) / math.sqrt(2 * math.pi) * omega_1 / spots.sigma_s

    edges = [1e-14, 1.0, FAILS, 54.0, 8 * spots.sigma_s / omega_1]
    total = sum(
        integrate.quad(density, a, b, epsabs=0, epsrel=1e-11, limit=200)[0]
        for a, b in zip(edges[:-1], edges[1:], strict=True)
    )
    expected = float(spots.density[0]) * total / state.pressure
    assert state.outputs["mu_static"] == pytest.approx(expected, rel=1e-8)


def test_static_friction_with_particles():
    stick = contact(300e-9, second=SOFT).replace(outputs=(StaticFriction(),))
    out = solved(stick).outputs
    swapped = stick.replace(surfaces=tb.MaterialPair(SOFT, STEEL))
    assert solved(swapped).outputs["mu_static"] == pytest.approx(out["mu_static"], rel=1e-10)
    assert out["mu_static"] == pytest.approx(out["mu_static_ss"] + out["mu_static_sa"], rel=1e-14)
    state = solved(stick)
    assert out["mu_static_sa"] >= 0.26 * state.particle_load_share * (1 - 1e-12)
    plastic = stick.replace(outputs=(StaticFriction(law="kogut-etsion"),))
    with warns_of("static_friction.plastic", effect=0.9745):
        tb.solve(plastic, pressure=5e6)
