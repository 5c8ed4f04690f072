"""Contacts whose friction acts back: closed forms, brute force, time, and mistakes."""

import math
import warnings

import numpy as np
import pytest
from refusals import Mistake, refuses, warns_of
from scipy import optimize
from steel_and_dust import DUSTY, STEEL, TWO_BODY

import thirdbody as tb
from thirdbody import feedback
from thirdbody.errors import InvalidValue, RangeWarning, code_of
from thirdbody.systems.coupled import coupled

TAU, COLD, MELT = 580e6, 293.0, 1793.0
PATH = feedback.ThermalPath(h_1=5e3, h_2=5e3, T_1=COLD, T_2=COLD)
RUBBING = TWO_BODY.replace(outputs=tb.outputs.Friction(tau_ss=TAU))
# of one size, which costs a third of a spread; spreads are on the page and in pairs of folds
DUSTY_RUBBING = DUSTY.replace(
    outputs=tb.outputs.Friction(tau_ss=TAU, tau_sa=200e6),
    **{"particles.diameter": tb.Monodisperse(mean=300e-9)},
)


def softening(exponent=1.0, **changes):
    return feedback.Softening(**dict(T_melt=MELT, T_0=COLD, exponent=exponent) | changes)


def asked(contact=RUBBING, *, pressure=5e6, sliding_speed=2.0, laws=None, **options):
    """`coupled`, of which the warnings are looked at elsewhere."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        return coupled(
            contact,
            **dict(pressure=pressure, sliding_speed=sliding_speed, cooling=PATH) | options,
            feedback=[softening()] if laws is None else laws,
        )


def friction_at(contact, T, *, pressure=5e6, exponent=1.0):
    """μ of a contact whose surfaces are at T, without `coupled`."""
    share = 1 - ((T - COLD) / (MELT - COLD)) ** exponent
    first, second = contact.surfaces.first, contact.surfaces.second
    pair = tb.MaterialPair(first.replace(H=first.H * share), second.replace(H=second.H * share))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        return tb.solve(contact.replace(surfaces=pair), pressure=pressure).outputs["mu"]


def frictions_at(contact, T, *, pressure=5e6, exponent=1.0):
    """μ at many T, states of one call."""
    share = 1 - ((T - COLD) / (MELT - COLD)) ** exponent
    first, second = contact.surfaces.first, contact.surfaces.second
    vary = {"surfaces.first.H": first.H * share, "surfaces.second.H": second.H * share}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        states = tb.equilibria.solve_states(contact, pressure=pressure, vary=vary)
    assert set(states["status"].values) == {"ok"}
    return states["mu"].values


# ------------------------------------------------------------------ closed forms
@pytest.fixture(scope="module")
def plastic():
    """All but stiff surfaces: every asperity is plastic, and μ = τ/H."""
    stiff = STEEL.replace(E=1e20)
    return RUBBING.replace(surfaces=tb.MaterialPair(stiff, stiff))


@pytest.mark.spread(3)
@pytest.mark.parametrize("exponent", [1.0, 0.7, 2.0])
def test_fold_of_plastic_surfaces(plastic, exponent):
    """v ∝ θ(1 − θ^m) has its maximum at θ = (1 + m)^(−1/m)."""
    theta = (1 + exponent) ** (-1 / exponent)
    heat = (MELT - COLD) * theta * (1 - theta**exponent) * 1e4 * STEEL.H / TAU
    found = asked(plastic, laws=[softening(exponent)])
    assert found.seizure_speed == pytest.approx(heat / 5e6, rel=1e-8)
    assert found.seizure_load == pytest.approx(heat / 2.0, rel=1e-8)
    assert "heats without a stop" in found.speed_limit


def test_both_states_of_plastic_surfaces(plastic):
    """With m = 1 the temperatures are the roots of a quadratic, and the gain is θ/(1 − θ)."""
    found = asked(plastic, sliding_speed=3.0, limits="speed")
    q = 3.0 * 5e6 * TAU / STEEL.H / 1e4 / (MELT - COLD)
    low, high = sorted(np.roots([1, -1, q]).real)
    rises = [(each.T - COLD) / (MELT - COLD) for each in found.states]
    np.testing.assert_allclose(rises, [low, high], rtol=1e-9)
    gains = [each.loop_gain for each in found.states]
    np.testing.assert_allclose(gains, [low / (1 - low), high / (1 - high)], rtol=1e-5)
    assert [each.stable for each in found.states] == [True, False]
    assert found.load_limit == "not asked for"


def test_strength_that_follows_the_hardness_has_no_fold(plastic):
    """With τ = m k(H) friction stays, the temperature rises with the speed, and nothing ends."""
    follows = plastic.replace(outputs=tb.outputs.Friction(m_ss=0.5))
    found = asked(follows, limits="speed")
    assert math.isnan(found.seizure_speed)
    # half of the area touches at H = 2 p, 1790 K
    assert found.speed_limit.startswith("not known: beyond")
    assert found.branch["T"][-1] == pytest.approx(1790.0, abs=0.5)
    (only,) = found.states
    mu = 0.5 / (3 * math.sqrt(3))
    assert only.T == pytest.approx(COLD + mu * 5e6 * 2.0 / 1e4, rel=1e-9)
    assert only.loop_gain == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(("alpha", "growth"), [(9.0, 0.0), (25.0, 0.0), (3.0, 0.05)])
def test_junctions_obey_their_yield_criterion(alpha, growth):
    law = feedback.JunctionGrowth(alpha=alpha)
    p = law.hardness(5e9, tau=TAU, growth=growth)
    assert p**2 + alpha * (TAU + growth * p) ** 2 == pytest.approx(25e18, rel=1e-14)


def test_junction_growth_alone(plastic):
    """Friction of plastic surfaces is τ/√(H² − ατ²), at any speed."""
    found = asked(plastic, laws=[feedback.JunctionGrowth(alpha=9)], cooling=None)
    (only,) = found.states
    H = math.sqrt(STEEL.H**2 - 9 * TAU**2)
    assert only.H_1 == pytest.approx(H, rel=1e-14)
    assert only.mu == pytest.approx(TAU / H, rel=1e-6)
    assert math.isnan(only.T)
    assert only.stable
    assert found.speed_limit.startswith("none")


@pytest.mark.check
def test_junctions_make_softening_worse(plastic):
    """v ∝ θ √((1 − θ)² − a²), a² = ατ²/H_0²: its maximum by another search."""
    a = 3 * TAU / STEEL.H
    best = optimize.minimize_scalar(
        lambda x: -x * math.sqrt(max((1 - x) ** 2 - a * a, 0.0)), bounds=(0, 1 - a),
        method="bounded", options={"xatol": 1e-12},
    )  # fmt: skip
    laws = [softening(), feedback.JunctionGrowth(alpha=9)]
    found = asked(plastic, laws=laws, limits="speed")
    speed = -best.fun * (MELT - COLD) * 1e4 * STEEL.H / TAU / 5e6
    assert found.seizure_speed == pytest.approx(speed, rel=1e-8)


# ------------------------------------------------------------------ by other ways
def test_states_by_brute_force():
    """Every change of sign of T_out − T over 60 temperatures, and no other state.

    Of particles: `test_particles_between_half_spaces_by_a_scan`.
    """
    contact, v = RUBBING, 3.0

    def miss(T):
        return COLD + friction_at(contact, T) * 5e6 * v / 1e4 - T

    grid = np.linspace(COLD + 1.0, COLD + 0.97 * (MELT - COLD), 60)
    values = [miss(T) for T in grid]
    exact = [
        optimize.brentq(miss, grid[i], grid[i + 1], xtol=1e-9)
        for i in range(len(grid) - 1)
        if values[i] * values[i + 1] < 0
    ]
    found = asked(contact, sliding_speed=v, limits="speed")
    np.testing.assert_allclose([each.T for each in found.states], exact, rtol=1e-9)


# ------------------------------------------------------------------ dense scans, no continuation
HOT = STEEL.replace(thermal_conductivity=50, density=7850, specific_heat=480)
DUST = tb.Particles(
    material=tb.materials["Al2O3"], areal_density=1e10, diameter=tb.Monodisperse(mean=500e-9)
)


def scanned(made, cold, end, count):
    """Every root of T_made − T between two temperatures, its gain by differences, in order."""
    grid = np.linspace(cold + 1e-3, end, count)
    miss = np.array([made(T) - T for T in grid])
    out = []
    for i in np.flatnonzero(miss[1:] * miss[:-1] < 0):
        T = optimize.brentq(lambda T: made(T) - T, grid[i], grid[i + 1], xtol=1e-10, rtol=1e-14)
        out.append((T, (made(T + 0.1) - made(T - 0.1)) / 0.2))
    return out


def fold(speed_of, low, high, count):
    """The largest speed that a temperature has, by a scan and golden sections."""
    grid = np.linspace(low, high, count)
    best = int(np.argmax([speed_of(T) for T in grid]))
    ends = grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)]
    found = optimize.minimize_scalar(
        lambda T: -speed_of(T), bounds=ends, method="bounded", options={"xatol": 1e-3}
    )
    return -found.fun


def softened(contact, share):
    pair = contact.surfaces
    soft = [each.replace(H=each.H * share) for each in (pair.first, pair.second)]
    return contact.replace(surfaces=tb.MaterialPair(*soft))


def untold(function, *given, **named):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        return function(*given, **named)


@pytest.mark.slow
def test_particles_between_half_spaces_by_a_scan():
    """States, stability and the end of a dusty contact whose heat goes into half-spaces."""
    from thirdbody.effects.single.heat import body_conductance

    hot = DUSTY_RUBBING.replace(surfaces=tb.MaterialPair(HOT, HOT), particles=DUST)
    area, p, b = 25e-6, 5e6, math.sqrt(25e-6 / math.pi)

    def conductance(v):
        D = 50 / (7850 * 480)
        return sum(body_conductance(b, k=50.0, D=D, v=each) for each in (0.0, v))

    known = {}

    def mu(T):
        if T not in known:
            share = 1 - ((T - COLD) / (MELT - COLD)) ** 1.5
            known[T] = untold(tb.solve, softened(hot, share), pressure=p).outputs["mu"]
        return known[T]

    def speed_of(T):
        """The speed at which friction makes this temperature."""
        return optimize.brentq(
            lambda v: COLD + mu(T) * p * v * area / conductance(v) - T, 1e-9, 1e9, xtol=1e-13
        )

    cooling = feedback.HalfSpaces(A_n=area, T_1=COLD, T_2=COLD)
    hottest = COLD + 0.99 * (MELT - COLD)
    end = fold(speed_of, COLD + 1e-3, hottest, 24)  # the same temperatures as below
    v = 0.6 * end
    exact = scanned(lambda T: COLD + mu(T) * p * v * area / conductance(v), COLD, hottest, 24)
    found = asked(hot, sliding_speed=v, laws=[softening(1.5)], cooling=cooling, limits="speed")
    assert [each.T for each in found.states] == pytest.approx([T for T, _ in exact], rel=1e-8)
    assert [each.stable for each in found.states] == [gain < 1 for _, gain in exact]
    gains = [each.loop_gain for each in found.states]
    assert gains == pytest.approx([gain for _, gain in exact], rel=2e-3)
    assert len(exact) == 2
    # above it there is no state: `test_loop_gain_is_one_at_the_fold`
    assert found.seizure_speed == pytest.approx(end, rel=1e-7)


@pytest.mark.slow
def test_particles_in_a_film_that_thins_by_a_scan():
    """A dusty mixed film whose oil thins and whose steel softens: the same roots by a dense scan."""
    dusty = DUSTY_RUBBING.replace(
        particles=tb.Particles(
            material=tb.materials["quartz"],
            areal_density=1e9,
            diameter=tb.Monodisperse(mean=500e-9),
        ),
    )
    oil = tb.films.Oil(eta=0.05, alpha=2e-8, eyring_stress=5e6)
    run = tb.systems.film_conditions.FilmConditions(
        conjunction=tb.films.Point(R=9.5e-3), oil=oil, load=20.0, speed=(0.5,), slide_roll=0.5
    )
    p, v, cold, h = run.nominal_pressure(dusty), 0.25, 40.0, 4e5
    beta = math.log(0.05 / 0.0068) / 60
    known = {}

    def made(T):
        if T not in known:
            film = untold(
                tb.films.mixed_film, softened(dusty, 1 - (T - 20) / 1480), conjunction=run.conjunction,
                oil=oil.replace(eta=0.05 * math.exp(-beta * (T - 40.0))), load=20.0, speed=0.5,
                slide_roll=0.5,
            )  # fmt: skip
            known[T] = cold + film.mu * p * v / h
        return known[T]

    # the oil is thinner than any from 226 °C on
    exact = scanned(made, cold, 220.0, 16)
    found = asked(
        dusty, pressure=None, sliding_speed=None, film=run, limits="speed",
        laws=[feedback.Thinning(beta=beta, T_0=40.0), softening(T_melt=1500.0, T_0=20.0)],
        cooling=feedback.ThermalPath(h_1=h / 2, h_2=h / 2, T_1=cold, T_2=cold),
    )  # fmt: skip
    assert [each.T for each in found.states] == pytest.approx([T for T, _ in exact], rel=1e-8)
    assert [each.stable for each in found.states] == [gain < 1 for _, gain in exact]
    gains = [each.loop_gain for each in found.states]
    assert gains == pytest.approx([gain for _, gain in exact], rel=5e-3, abs=1e-4)
    assert exact


def test_time_tells_the_stable_state_from_the_other():
    """dT/dt = T_out − T runs back to the first state, and away from the second."""
    found = asked(sliding_speed=3.0, limits="speed")
    cold, hot = (each.T for each in found.states)

    def after(T):
        for _ in range(40):
            T += 0.5 * (COLD + friction_at(RUBBING, T) * 5e6 * 3.0 / 1e4 - T)
            if T > COLD + 0.98 * (MELT - COLD):
                return math.inf
        return T

    assert after(cold + 30.0) == pytest.approx(cold, abs=0.01)
    assert after(hot - 5.0) == pytest.approx(cold, abs=0.5)
    assert after(hot + 5.0) == math.inf


@pytest.mark.check
def test_loop_gain_is_one_at_the_fold():
    end = asked(limits="speed").seizure_speed
    near = asked(sliding_speed=end * (1 - 1e-6), limits="speed")
    assert [each.loop_gain for each in near.states] == pytest.approx([1, 1], abs=5e-3)
    assert asked(sliding_speed=end * (1 + 1e-6), limits="speed").states == ()


@pytest.mark.slow
def test_flash_adds_the_mean_rise_of_the_spots():
    bodies = STEEL.replace(thermal_conductivity=50, density=7850, specific_heat=480)
    hot = DUSTY_RUBBING.replace(
        surfaces=tb.MaterialPair(bodies, bodies),
        particles=DUSTY_RUBBING.populations[0].replace(
            material=tb.materials["SiO2"].replace(thermal_conductivity=1.4)
        ),
    )
    laws = [softening(), softening(body="particles", T_melt=1900.0)]
    found = asked(hot, sliding_speed=1.0, laws=laws, flash=True, limits="speed")
    only = found.states[0]
    share = (only.T_particles - COLD) / (1900.0 - COLD)
    softer = bodies.replace(H=bodies.H * (MELT - only.T) / (MELT - COLD))
    dust = hot.populations[0]
    state = tb.solve(
        hot.replace(
            surfaces=tb.MaterialPair(softer, softer),
            particles=dust.replace(material=dust.material.replace(H=dust.material.H * (1 - share))),
            outputs=(*hot.outputs, tb.outputs.FlashTemperature(v=1.0, A_n=1e-6)),
        ),
        pressure=5e6,
    )
    bulk = COLD + state.outputs["mu"] * 5e6 / 1e4
    on = state.particle_load_share
    rise = (1 - on) * state.outputs["dT_ss_load"] + on * state.outputs["dT_sa_load"]
    assert only.T_bulk == pytest.approx(bulk, abs=1e-6)
    assert only.T == pytest.approx(bulk + rise, abs=1e-6)
    assert only.T_particles == pytest.approx(bulk + state.outputs["dT_sa_load"], abs=1e-6)


@pytest.mark.check
def test_oil_that_thins():
    """The film at the temperature that its own friction makes."""
    oil = tb.films.Oil(eta=0.05, alpha=2e-8, eyring_stress=5e6)
    run = tb.systems.film_conditions.FilmConditions(
        conjunction=tb.films.Point(R=9.5e-3), oil=oil, load=20.0, speed=(0.5,), slide_roll=0.5
    )
    cooling = feedback.ThermalPath(h_1=1e6, h_2=1e6, T_1=40.0, T_2=40.0)
    thin = feedback.Thinning.between(0.05, T_1=40.0, eta_2=0.0068, T_2=100.0)
    found = asked(
        RUBBING, pressure=None, sliding_speed=None, film=run, laws=[thin], cooling=cooling,
        limits="speed",
    )  # fmt: skip
    (only,) = found.states
    warm = oil.replace(eta=0.05 * math.exp(-math.log(0.05 / 0.0068) / 60 * (only.T - 40.0)))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        film = tb.films.mixed_film(
            RUBBING, conjunction=run.conjunction, oil=warm, load=20.0, speed=0.5, slide_roll=0.5
        )
    heat = film.mu * run.nominal_pressure(RUBBING) * 0.25
    assert only.T == pytest.approx(40.0 + heat / 2e6, abs=1e-7)
    assert only.T > 41.0


def test_half_spaces_are_those_of_the_moving_source():
    from thirdbody.effects.single.heat import body_conductance

    bodies = STEEL.replace(thermal_conductivity=50, density=7850, specific_heat=480)
    hot = RUBBING.replace(surfaces=tb.MaterialPair(bodies, bodies))
    cooling = feedback.HalfSpaces(A_n=1e-6, T_1=300.0, T_2=290.0)
    (only, *_) = asked(hot, cooling=cooling, limits="speed").states
    b, D = math.sqrt(1e-6 / math.pi), 50 / (7850 * 480)
    G = [body_conductance(b, k=50.0, D=D, v=v) for v in (0.0, 2.0)]
    T = (only.mu * 5e6 * 2.0 * 1e-6 + G[0] * 300 + G[1] * 290) / sum(G)
    assert pytest.approx(T, abs=1e-7) == only.T


# ------------------------------------------------------------------ symmetry and mistakes
@pytest.mark.check
def test_celsius_and_kelvin_give_the_same():
    one = asked(limits="speed")
    law = feedback.Softening(T_melt=MELT - 273.15, T_0=COLD - 273.15, exponent=1.0)
    path = PATH.replace(T_1=COLD - 273.15, T_2=COLD - 273.15)
    other = asked(laws=[law], cooling=path, limits="speed")
    assert other.seizure_speed == pytest.approx(one.seizure_speed, rel=1e-9)
    assert [each.T + 273.15 for each in other.states] == pytest.approx([s.T for s in one.states])


def test_a_guess_is_said():
    with warns_of("junction_growth.alpha"):
        coupled(RUBBING, pressure=5e6, sliding_speed=1.0, feedback=[feedback.JunctionGrowth()])


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"pressure": None}, "pressure is missing"),
        ({"sliding_speed": -1.0}, "sliding_speed = -1 must be a number > 0"),
        ({"contact": TWO_BODY}, "needs outputs.Friction"),
        ({"laws": []}, "feedback is empty"),
        ({"cooling": None}, "cooling is missing"),
        (
            {
                "contact": RUBBING.replace(
                    surfaces=tb.MaterialPair(STEEL, STEEL.replace(thermal_conductivity=None))
                ),
                "cooling": feedback.HalfSpaces(A_n=1e-6, T_1=1.0, T_2=1.0),
            },
            "surfaces.second needs thermal_conductivity",
        ),
        ({"laws": [softening(body="particles")]}, "the contact has none"),
        ({"laws": [feedback.Thinning(beta=0.03, T_0=40.0)]}, "there is no film"),
        ({"laws": [softening(T_melt=250.0, T_0=0.0)]}, "both in K, or both in °C"),
        ({"laws": [feedback.JunctionGrowth(alpha=90)]}, "grow without end"),
        (
            {
                "contact": TWO_BODY.replace(outputs=tb.outputs.Friction(tau_ss=TAU, alpha_T=9.0)),
                "laws": [feedback.JunctionGrowth(alpha=9)],
            },
            "leave alpha_T out",
        ),
    ],
)
def test_mistakes_are_named(options, words):
    with pytest.raises(InvalidValue, match=words):
        asked(**options)


def test_melting_below_the_reference_is_refused():
    with refuses(Mistake.ORDER, "Softening.T_melt", value="200"):
        softening(T_melt=200.0)


# ------------------------------------------------------------------ the page
def contact_of_the_page(density):
    dust = tb.Particles(
        material=tb.materials["Al2O3"], areal_density=density,
        diameter=tb.TruncatedGaussian(mean=500e-9, std=50e-9),
    )  # fmt: skip
    outputs = tb.outputs.Friction(tau_ss=TAU, tau_sa=200e6)
    return TWO_BODY.replace(particles=dust, outputs=outputs)


PAGE = {1e9: (0.18, 6.1), 1e10: (0.28, 5.4), 1e11: (0.16, 9.3)}
"""Friction at 1 m/s and seizure speed [m/s] by density, in the table of docs/feedback.md."""


@pytest.mark.slow
@pytest.mark.parametrize("density", PAGE)
def test_particles_of_the_page_by_a_scan(density):
    """The speed of every temperature: where it is 1 m/s, and where it first falls again.

    `coupled` holds to such a scan in `test_a_pair_of_folds_within_twenty_kelvin`.
    """
    mu, speed = PAGE[density]
    T, speeds = np.array([]), np.array([])
    while not turns_of(speeds).size:
        more = (T[-1] if T.size else 290.0) + 30.0 * np.arange(1, 6)
        frictions = frictions_at(contact_of_the_page(density), more, exponent=1.03)
        T, speeds = np.append(T, more), np.append(speeds, (more - COLD) * 1e4 / (frictions * 5e6))
    frictions = (T - COLD) * 1e4 / (speeds * 5e6)
    assert speeds[0] < 1.0 < speeds[-1]
    assert round(np.interp(1.0, speeds[:6], frictions[:6]), 2) == mu
    assert round(speeds[turns_of(speeds)[0]], 1) == speed


@pytest.mark.slow
def test_constants_of_the_page_by_a_scan():
    """The largest speed over the temperatures.

    `coupled` holds to it in `test_fold_of_plastic_surfaces`, `test_loop_gain_is_one_at_the_fold`
    and, with junctions, `test_junctions_make_softening_worse`.
    """
    rows = [
        ({"exponent": 0.7}, {}, 4.9),
        ({"exponent": 1.5}, {}, 7.8),
        ({"exponent": 1.03, "T_melt": 1400.0}, {}, 4.6),
        ({"exponent": 1.03}, {"tau": 300e6}, 12),
        ({"exponent": 1.03}, {"tau": 800e6}, 4.6),
        ({"exponent": 1.03}, {"alpha": 3.0}, 5.8),
        ({"exponent": 1.03}, {"alpha": 25.0}, 3.1),
    ]
    for law, more, speed in rows:
        tau, melt = more.get("tau", TAU), law.get("T_melt", MELT)
        T = np.arange(COLD + 20, melt, 20.0)
        H = STEEL.H * (1 - ((T - COLD) / (melt - COLD)) ** law["exponent"])
        # junctions: p² + ατ² = H²
        squared = H**2 - more.get("alpha", 0.0) * tau**2
        T, H = T[squared > 0], np.sqrt(squared[squared > 0])
        contact = TWO_BODY.replace(outputs=tb.outputs.Friction(tau_ss=tau))
        states = untold(
            tb.equilibria.solve_states, contact, pressure=5e6,
            vary={"surfaces.first.H": H, "surfaces.second.H": H},
        )  # fmt: skip
        speeds = (T - COLD) * 1e4 / (states["mu"].values * 5e6)
        assert float(f"{np.nanmax(speeds):.2g}") == speed, (law, more)


# ------------------------------------------------------------------ pairs of folds
def turns_of(values):
    """Numbers of the places at which a column turns, without its ends."""
    steps = np.diff(values)
    return np.flatnonzero(steps[1:] * steps[:-1] < 0) + 1


def silica(density=1e11, mean=300e-9, std=24e-9):
    return tb.Particles(
        material=tb.materials["SiO2"], areal_density=density,
        diameter=tb.TruncatedGaussian(mean=mean, std=std),
    )  # fmt: skip


@pytest.mark.slow
def test_a_pair_of_folds_within_twenty_kelvin():
    """Three folds and a kink at 1038 K: all of a scan, their speeds, and four states between."""
    contact = TWO_BODY.replace(
        particles=silica().replace(diameter=tb.Monodisperse(mean=300e-9)),
        outputs=tb.outputs.Friction(tau_ss=TAU, tau_sa=200e6),
    )

    def speeds_of(T):
        return (T - COLD) * 1e4 / (frictions_at(contact, T, exponent=1.03) * 5e6)

    def speed_of(T):
        return (T - COLD) * 1e4 / (friction_at(contact, T, exponent=1.03) * 5e6)

    grid = np.r_[
        np.arange(420, 1000, 80), np.arange(1000, 1030, 6), np.arange(1032, 1042, 0.5),
        np.arange(1045, 1160, 20), np.arange(1160, 1280, 20), np.arange(1320, 1700, 60.0),
    ]  # fmt: skip
    over = speeds_of(grid)
    exact = turns_of(over)
    assert len(exact) == 3
    between = 0.5 * (over[exact[0]] + over[exact[1]])
    found = asked(contact, sliding_speed=between, laws=[softening(1.03)], limits="speed")
    v, T = found.branch["speed"], found.branch["T"]
    np.testing.assert_allclose(T[turns_of(v)], grid[exact], rtol=0, atol=12)
    np.testing.assert_allclose(v[turns_of(v)], over[exact], rtol=2e-4)
    roots = [
        optimize.brentq(lambda T: speed_of(T) - between, a, b, xtol=1e-8)
        for a, b, low, high in zip(grid, grid[1:], over, over[1:], strict=False)
        if (low - between) * (high - between) < 0
    ]
    assert len(roots) == 4
    assert [each.T for each in found.states] == pytest.approx(roots, rel=1e-6)
    assert [each.stable for each in found.states] == [True, False, True, False]
    assert "6.037 m/s" in found.speed_limit


@pytest.mark.slow
def test_folds_of_a_contact_at_random_by_a_dense_scan():
    """Every turn of the speed over the temperature is a fold of the branch, and no other is.

    The scan has 50 temperatures, and parts each step of them into six, and each of these into
    seven, where the speed hardly changes along it or beside it. Those of particles by the table of
    deep squeezes:
    `test_a_pair_of_folds_within_twenty_kelvin`.
    """
    rng = np.random.default_rng(1)
    mean = 10 ** rng.uniform(-6.7, -6.2)
    dust = silica(10 ** rng.uniform(10.5, 11.5), mean, mean * rng.choice([0.05, 0.08, 0.15]))
    pressure, exponent = 10 ** rng.uniform(6.4, 7.2), rng.uniform(0.8, 1.5)
    contact = TWO_BODY.replace(
        particles=dust,
        particle_law=tb.particle.Series(deep="off"),
        outputs=tb.outputs.Friction(tau_ss=TAU, tau_sa=200e6),
    )
    found = asked(
        contact, pressure=pressure, sliding_speed=1.0, laws=[softening(exponent)], limits="speed"
    )

    def speeds_of(T):
        mu = frictions_at(contact, T, pressure=pressure, exponent=exponent)
        return (T - COLD) * 1e4 / (mu * pressure)

    v, T = found.branch["speed"], found.branch["T"]
    places = np.linspace(COLD + 10, min(T.max(), 1775.0), 50)
    speeds = speeds_of(places)
    for parts, slope in ((6, 2e-4), (7, 4e-5)):  # of the speed, per kelvin
        steps, lengths = np.diff(speeds), np.diff(places)
        flat = np.abs(steps) < slope * lengths * speeds[1:]
        turns = steps[1:] * steps[:-1] < 0
        flat[:-1] |= turns
        flat[1:] |= turns
        more = np.concatenate(
            [np.linspace(*places[i : i + 2], parts + 1)[1:-1] for i in np.flatnonzero(flat)]
        )
        speeds = np.append(speeds, speeds_of(more))[np.argsort(np.append(places, more))]
        places = np.sort(np.append(places, more))
    np.testing.assert_allclose(T[turns_of(v)], places[turns_of(speeds)], rtol=0, atol=1.6)
    np.testing.assert_allclose(v[turns_of(v)], speeds[turns_of(speeds)], rtol=2e-4)


# ------------------------------------------------------------------ jumps of friction
def one_that_softens(T):
    """Speed of every temperature where surface 1 alone softens, and becomes the softer one."""
    share = 1 - (T - COLD) / (MELT - COLD)
    pair = tb.MaterialPair(STEEL.replace(H=STEEL.H * share), STEEL)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        mu = tb.solve(RUBBING.replace(surfaces=pair), pressure=5e6).outputs["mu"]
    return (T - COLD) * 1e4 / (mu * 5e6)


@pytest.mark.check
def test_states_beyond_a_jump_of_friction_are_found():
    """Surface 1 becomes 1.2 times softer than its partner at share 1/1.2, and is then ploughed."""
    jump = COLD + (MELT - COLD) * (1 - 1 / 1.2)
    below, above = one_that_softens(jump * (1 - 1e-12)), one_that_softens(jump * (1 + 1e-12))
    assert above < 0.9 * below
    speed = (below + above) / 2
    found = asked(sliding_speed=speed, laws=[softening(body="first")], limits="speed")
    grid = np.concatenate(
        [np.linspace(COLD + 1, jump - 1e-9, 30), np.linspace(jump + 1e-9, 1780, 60)]
    )
    over = np.array([one_that_softens(T) - speed for T in grid])
    roots = [
        optimize.brentq(lambda T: one_that_softens(T) - speed, a, b)
        for a, b, low, high in zip(grid, grid[1:], over, over[1:], strict=False)
        if low * high < 0 and b - a > 1e-6
    ]
    assert [each.T for each in found.states] == pytest.approx(roots, rel=1e-9)
    assert [each.stable for each in found.states] == [True, True, False]
    (told,) = [note for note in found.warnings if code_of(note) == "coupled.jump"]
    assert f"{jump:.4g} K" in told


def test_the_stable_state_ends_where_no_state_is_left():
    found = asked(sliding_speed=1.0, laws=[softening(body="first")], limits="speed")
    T = optimize.minimize_scalar(
        lambda T: -one_that_softens(T),
        bounds=(600, 1700),
        method="bounded",
        options={"xatol": 1e-4},
    ).x
    jump = COLD + (MELT - COLD) * (1 - 1 / 1.2)
    most = max(one_that_softens(T), one_that_softens(jump * (1 - 1e-12)))
    assert found.seizure_speed == pytest.approx(most, rel=1e-7)


def test_states_as_data_and_as_a_table():
    found = asked()
    assert found.states
    data, table = found.to_dataset(), found.to_dataframe()
    assert data.sizes == {"state": len(found.states)}
    for i, state in enumerate(found.states):
        for name in ("T", "mu", "H_2", "stable"):
            assert table.loc[i, name] == getattr(state, name) == data[name].values[i]
        assert state.to_dataframe().loc[0, "T"] == state.T
        assert {"T", "stable"} <= set(state.to_dict())
        assert state.to_dict()["T"] == state.T
    assert float(data.seizure_speed) == found.seizure_speed
    assert (data.seizure_load.units, table.attrs["symbol"]["T_bulk"]) == ("Pa", "T_b")
    assert type(found).__name__ in found._repr_html_()
