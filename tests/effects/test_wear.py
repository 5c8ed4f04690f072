"""Wear of a solved contact: by cause, by surface, and what must be said."""

import math
import warnings

import numpy as np
import pytest
from refusals import Mistake, refuses, warns_of

import thirdbody as tb
from thirdbody.effects import AbstractOutput, Friction, Wear
from thirdbody.effects.single.ploughing import groove_area
from thirdbody.effects.single.severity import severity, threshold

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
SOFT = STEEL.replace(H=2.5e9)
FRICTION = Friction(tau_ss=580e6, tau_sa=200e6)
ALL = dict(
    K_ss=1e-5, K_ss_ep=1e-6, K_ss_e=1e-7, K_sa=2e-5, K_sa_ep=3e-6, K_sa_e=1e-7,
    f_ab=0.1, f_roll=0.01, renewal=10.0,
)  # fmt: skip
PARTS = ("wear_ss", "wear_sa", "wear_groove", "wear_roll")


def contact(first=STEEL, second=SOFT, *, wear=None, friction=FRICTION, density=1e10, splits=()):
    dust = tb.Particles(
        material=SILICA,
        areal_density=density,
        diameter=tb.TruncatedGaussian(mean=500e-9, std=100e-9),
    )
    return tb.Contact(
        surfaces=tb.MaterialPair(first, second),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=dust if density else None,
        particle_law=tb.particle.Series(deep="off"),
        outputs=(friction, wear or Wear(**ALL), *splits),
    )


def worn(*args, pressure=5e6, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        return tb.solve(contact(*args, **options), pressure=pressure).outputs


def test_parts_and_surfaces_add_up():
    found = worn(pressure=np.geomspace(1e5, 5e7, 7))
    total = sum(found[name] for name in PARTS)
    np.testing.assert_allclose(found["wear"], total, rtol=1e-13)
    np.testing.assert_allclose(found["wear_1"] + found["wear_2"], total, rtol=1e-13)
    assert all(np.all(found[name] > 0) for name in PARTS)


def test_surfaces_swap():
    one, two = worn(STEEL, SOFT), worn(SOFT, STEEL)
    for name in (*PARTS, "wear_K", "groove_length", "severity", "severe_share"):
        assert one[name] == pytest.approx(two[name], rel=1e-9), name
    assert one["wear_1"] == pytest.approx(two["wear_2"], rel=1e-9)
    assert one["wear_1"] > 10 * one["wear_2"]  # particles sit in the softer, groove the harder


@pytest.mark.parametrize("options", [{}, {"friction": FRICTION.replace(aspect=3.0)}])
def test_equal_surfaces_wear_alike(options):
    """Rolling, and grooving both in turn where particles cannot turn over."""
    found = worn(STEEL, STEEL, **options)
    assert found["wear_1"] == pytest.approx(found["wear_2"], rel=1e-9)
    assert (found["wear_groove"] > found["wear_roll"]) == bool(options)


def test_without_particles_it_is_archard():
    """One K for every regime: V = K A; only plastic: V = K A_p = K F_p/H."""
    wear = Wear(K_ss=1e-4, K_ss_ep=1e-4, K_ss_e=1e-4)
    system = contact(wear=wear, density=0)
    state = tb.solve(system, pressure=5e6)
    assert state.outputs["wear"] == pytest.approx(1e-4 * float(state.A_t), rel=1e-12)
    assert state.outputs["wear_1"] == 0  # the softer surface wears
    only = tb.solve(contact(wear=Wear(K_ss=1e-4), density=0), pressure=5e6)
    assert only.outputs["wear"] < state.outputs["wear"]
    assert state.outputs["wear_K"] == pytest.approx(
        1e-4 * float(state.A_t) * 2.5e9 / 5e6, rel=1e-12
    )


def test_linear_in_every_coefficient():
    base = worn()
    for name, column in (("f_ab", "wear_groove"), ("f_roll", "wear_roll")):
        twice = worn(wear=Wear(**ALL | {name: 2 * ALL[name]}))
        assert twice[column] == pytest.approx(2 * base[column], rel=1e-12)
        others = [each for each in PARTS if each != column]
        assert all(twice[each] == base[each] for each in others)
    none = worn(wear=Wear(K_ss=0.0, K_sa=0.0, f_ab=0.0, f_roll=0.0))
    assert all(none[name] == 0 for name in (*PARTS, "wear", "wear_1", "wear_2", "wear_K"))


def test_few_particles_wear_little():
    many, few = worn(density=1e8), worn(density=10)
    assert few["wear_groove"] < 2e-7 * many["wear_groove"]
    assert few["wear"] == pytest.approx(worn(density=0)["wear"], rel=1e-5)


def test_one_particle():
    """Against the formulas written out for a single one."""
    state = tb.solve(contact(), pressure=5e6)
    found = {}

    class Seen(AbstractOutput):
        __slots__ = ()
        name = "seen"
        columns = {}

        def of(self, solved):
            found["groups"] = solved.particles
            return {}

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tb.solve(contact(splits=(Seen(),)), pressure=5e6)
    finally:
        AbstractOutput.registry.pop("seen", None)
    (spots,) = found["groups"]
    motion = FRICTION.motion(spots)
    by_hand = np.zeros_like(spots.load)
    rolled = np.zeros_like(spots.load)
    for index in np.ndindex(spots.load.shape):
        A = [float(groove_area(side[index], radius=spots.radius[index])) for side in spots.depths]
        if motion.rolls[index]:
            rolled[index] = 0.01 * (A[0] + A[1]) / 2
        else:
            by_hand[index] = 0.1 * A[motion.side[index]]
    assert spots.total(by_hand)[0] == pytest.approx(state.outputs["wear_groove"], rel=1e-12)
    assert spots.total(rolled)[0] == pytest.approx(state.outputs["wear_roll"], rel=1e-12)
    count = spots.total(spots.load > 0)[0]
    H_1, H_2 = spots.hardness
    S = severity(spots.load, x=spots.x, H_1=H_1, H_2=H_2)
    assert spots.total(S)[0] / count == pytest.approx(state.outputs["severity"], rel=1e-12)
    assert state.outputs["renewed"] == pytest.approx(10 * count, rel=1e-12)


def test_a_load_puts_particles_above_the_threshold():
    found = worn(pressure=np.geomspace(1e3, 5e7, 9))
    assert np.all((found["severe_share"] >= 0) & (found["severe_share"] <= 1))
    assert np.all(np.diff(found["severity"]) > 0)


def test_severity_of_a_slurry():
    """S = W/(A v H') of a contact is that of each particle of a layer one particle high."""
    W, A, v, H, x = 1.0, 1e-6, 0.1, 7e9, 3e-6
    layer = 6 * v / (math.pi * x**2)
    S = float(severity(W / (A * layer), x=x, H_1=H, H_2=H))
    assert S == pytest.approx(W / (A * v * H / 2), rel=1e-13)
    assert S == pytest.approx(0.002857142857142857, rel=1e-13)
    assert float(threshold(1.0, H_b=4.0)) == pytest.approx(0.01499073710829906, rel=1e-13)


def test_share_above_the_threshold_does_not_depend_on_the_nodes():
    """Sums are split where severity crosses the threshold; more splits change nothing."""

    class Finer(AbstractOutput):
        __slots__ = ()
        name = "finer"
        columns = {}

        def of(self, solved):
            return {}

        def splits(self, probe):
            return tuple(np.geomspace(1e-5, 0.9, 12))

    try:
        one = worn(pressure=1e5)
        two = worn(pressure=1e5, splits=(Finer(),))
    finally:
        AbstractOutput.registry.pop("finer", None)
    for name in (*PARTS, "severity", "severe_share"):
        assert one[name] == pytest.approx(two[name], rel=1e-7), name


def test_change_of_units():
    """Stresses × 3 at the same separation: the same volumes."""

    def stiff(body):
        return body.replace(E=3 * body.E, H=3 * body.H)

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        one = tb.solve(contact(), pressure=5e6)
        system = contact(stiff(STEEL), stiff(SOFT), friction=Friction(tau_ss=1740e6, tau_sa=600e6))
        system = system.replace(particles=system.particles.replace(material=stiff(SILICA)))
        two = tb.solve(system, pressure=15e6)
    for name in (*PARTS, "wear_K", "groove_length", "severity"):
        assert one.outputs[name] == pytest.approx(two.outputs[name], rel=1e-7), name


def test_what_nobody_can_predict_must_be_given():
    with pytest.raises(TypeError, match="K_ss"):
        Wear()
    for lacking in ("K_sa", "f_ab"):
        with refuses(Mistake.MISSING, "outputs.wear", says=f"needs {lacking}, "):
            contact(wear=Wear(K_ss=1e-5))
    with refuses(Mistake.MISSING, "outputs.wear", says="needs f_roll, "):
        contact(STEEL, STEEL, wear=Wear(K_ss=1e-5, K_sa=0.0, f_ab=0.1))
    system = contact()
    with refuses(Mistake.MISSING, "outputs.wear", says="outputs.friction"):
        system.replace(outputs=(system.outputs[1],))


def test_warnings():
    with warns_of("wear.frozen"):
        tb.solve(contact(wear=Wear(**ALL | {"renewal": None})), pressure=5e6)
    with warns_of("wear.twice", effect=1):
        tb.solve(contact(), pressure=5e6)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        tb.solve(contact(wear=Wear(K_ss=1e-5), density=0), pressure=5e6)
