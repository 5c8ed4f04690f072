"""Populations of elliptic asperities: limits, brute force, and two faces at an angle."""

import dataclasses
import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import Mistake, refuses
from scipy.special import elliprd, elliprf

import thirdbody as tb
from thirdbody.populations.ellipticity import combined_tips
from thirdbody.populations.measured.synthetic import self_affine
from thirdbody.populations.measured.topography import from_topography
from thirdbody.study import check, run_study

STEEL = tb.materials["S45C"]
PAIR = tb.MaterialPair(STEEL, STEEL)
ROUGH = tb.Roughness(sigma=100e-9, R=2.8e-6)
DUST = tb.Particles(
    material=tb.materials["SiO2"],
    areal_density=1e11,
    diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
)
ELLIPTIC = [tb.asperity.EllipticZMC, tb.asperity.EllipticCEB]
SUMS = ("F_star", "A_t", "A_e", "A_ep", "A_p")
D = np.array([0.0, 1.0, 2.5, 4.0]) * ROUGH.sigma
LAW = tb.particle.Series(deep="off")
MIXED = tb.surfaces.Ellipticity(ratios=(1, 2, 5), weights=(0.5, 0.3, 0.2), radii=(1.2, 1.0, 0.7))
both_laws = pytest.mark.parametrize("law", ELLIPTIC)


def contact(law, shape, rough=ROUGH, **more):
    return tb.Contact(
        surfaces=PAIR, roughness=rough.replace(ellipticity=shape), asperity_law=law, **more
    )


def sums(contact, d=D):
    state = tb.solve(contact, d=d)
    return np.array([getattr(state, name) for name in SUMS])


# ---------------------------------------------------------------- limits
@both_laws
@pytest.mark.parametrize("heights", [tb.heights.GaussianHeights(), tb.heights.ExponentialHeights()])
@pytest.mark.parametrize("density", [{}, {"eta_R_sigma": 0.06}, {"eta": 1.5e11}])
def test_one_class_is_the_law_with_that_ratio(law, heights, density):
    rough = ROUGH.replace(heights=heights, **density)
    one = sums(contact(law(), tb.surfaces.Ellipticity(ratios=(4,)), rough))
    np.testing.assert_allclose(one, sums(contact(law(ratio=4.0), None, rough)), rtol=1e-14)


@both_laws
def test_the_radius_of_a_class_leaves_the_density_of_asperities(law):
    shape = tb.surfaces.Ellipticity(ratios=(4,), radii=(1.5,))
    larger = ROUGH.replace(R=1.5 * ROUGH.R, eta=ROUGH.density)
    expected = sums(contact(law(ratio=4.0), None, larger))
    np.testing.assert_allclose(sums(contact(law(), shape)), expected, rtol=1e-14)


@pytest.mark.parametrize(
    ("law", "circular"),
    [
        (tb.asperity.EllipticZMC(), tb.asperity.ZMC()),
        (tb.asperity.EllipticCEB(K=0.6), tb.asperity.CEB(K=0.6)),
    ],
)
def test_round_classes_are_the_circular_law(law, circular):
    found = sums(contact(law, tb.surfaces.Ellipticity(ratios=(1, 1), weights=(1, 3))))
    np.testing.assert_allclose(found, sums(contact(circular, None)), rtol=1e-13)


def johnson(ratio):
    """R_A and √R_F over R_g by bisection on k, with Carlson's integrals."""
    low, high = 1e-9, 1.0
    for _ in range(200):
        k = 0.5 * (low + high)
        larger = elliprd(0, 1, k * k) / elliprd(0, k * k, 1) > ratio
        low, high = (k, high) if larger else (low, k)
    K, third = elliprf(0, k * k, 1), elliprd(0, k * k, 1) / 3
    R = math.sqrt(ratio)
    return 2 * R * k * third / K, math.pi / 2 * math.sqrt(2 * R * third) * K**-1.5


@both_laws
@pytest.mark.parametrize("heights", [tb.heights.GaussianHeights(), tb.heights.ExponentialHeights()])
def test_elastic_population_acts_by_its_mean_radii(law, heights):
    """H → ∞: the area is that of round tips with ⟨ρR_A⟩, the load with ⟨√(ρR_F)⟩²."""
    hard = STEEL.replace(H=1e16)
    pair = tb.MaterialPair(hard, hard)
    rough = ROUGH.replace(heights=heights)
    found = sums(contact(law(), MIXED, rough).replace(surfaces=pair))
    shares = np.array([0.5, 0.3, 0.2])
    radii = np.array([1.2, 1.0, 0.7])
    R_A, root_R_F = np.array([johnson(ratio) for ratio in (1, 2, 5)]).T
    round_tips = tb.Contact(surfaces=pair, roughness=rough, asperity_law=tb.asperity.GW())
    F, A, *_ = sums(round_tips)
    np.testing.assert_allclose(found[0], F * (shares @ (root_R_F * np.sqrt(radii))), rtol=1e-12)
    np.testing.assert_allclose(found[1], A * (shares @ (R_A * radii)), rtol=1e-12)
    # a mean ratio in one class is not the same
    mean = tb.surfaces.Ellipticity(ratios=(shares @ [1, 2, 5],), radii=(shares @ radii,))
    assert np.all(np.abs(sums(contact(law(), mean, rough))[0] / found[0] - 1) > 1e-3)


@both_laws
def test_weights_have_any_unit(law):
    one = contact(law(), MIXED)
    two = contact(law(), MIXED.replace(weights=(500, 300, 200)))
    np.testing.assert_allclose(sums(one), sums(two), rtol=1e-14)


# ---------------------------------------------------------------- brute force
@both_laws
@pytest.mark.parametrize("shape", ["classes", "uniform", "random angles"])
def test_against_explicit_asperities(law, shape):
    """Every asperity has its own height, shape and angle; 4 standard errors."""
    rng = np.random.default_rng(20030401)
    count, pools = 60_000, 300
    z = ROUGH.sigma_s * rng.standard_normal(count)
    if shape == "classes":
        population = MIXED
        which = rng.choice(3, count, p=(0.5, 0.3, 0.2))
        ratio, R = np.array([1, 2, 5.0])[which], ROUGH.R * np.array([1.2, 1.0, 0.7])[which]
    elif shape == "uniform":
        population = tb.surfaces.Ellipticity.from_distribution(
            tb.distributions.Uniform(low=1, high=9)
        )
        ratio = np.repeat(rng.uniform(1, 9, pools), count // pools)
        R = np.full(count, ROUGH.R)
    else:
        population = tb.surfaces.Ellipticity.combined(
            first_ratio=6, R_first=5e-6, second_ratio=3, R_second=7e-6, angle="random"
        )
        first, second = tensor(6, 5e-6, 0), (tensor(3, 7e-6, t) for t in rng.uniform(0, 7, pools))
        low, high = np.array([np.linalg.eigvalsh(first + other) for other in second]).T
        ratio = np.repeat(high / low, count // pools)
        # R of the roughness stands for 35/12 µm
        R = np.repeat(1 / np.sqrt(low * high), count // pools) * ROUGH.R / (35e-6 / 12)
    d = 0.3 * ROUGH.sigma
    F, A = np.zeros(count), np.zeros(count)
    for lam in np.unique(ratio):
        for radius in np.unique(R[ratio == lam]):
            mine = (ratio == lam) & (radius == R) & (z > d)
            body = dict(R=radius, E_star=PAIR.E_star, H=PAIR.H)
            tip = law(ratio=lam).bound(**body, nu=STEEL.nu)
            F[mine] = tip.force(z[mine] - d, **body)
            A[mine] = tip.area(z[mine] - d, **body)
    found = sums(contact(law(), population), np.array([d]))[:, 0]
    for each, value in ((F / PAIR.E_star, found[0]), (A, found[1])):
        # asperities of one pool share their shape: the pools are independent
        group = each.reshape(pools, -1).mean(axis=1) * ROUGH.density
        error = group.std(ddof=1) / math.sqrt(pools)
        assert abs(group.mean() - value) < 4 * error
        assert error < 0.02 * value


@both_laws
@pytest.mark.parametrize(
    "density",
    [
        tb.distributions.Uniform(low=1, high=20),
        tb.distributions.Histogram(edges=(1, 2, 5, 10), counts=(5, 3, 1)),
        tb.distributions.Mixture(
            parts=(tb.distributions.Monodisperse(mean=3), tb.distributions.Uniform(low=2, high=4)),
            weights=(1, 2),
        ),
    ],
)
def test_gauss_classes_against_many(law, density):
    """The density integrated over λ with many nodes, each its own contact with one ratio."""
    shape = tb.surfaces.Ellipticity.from_distribution(density)
    assert len(shape.ratios) <= 8
    reference = 0.0
    for weight, part in density.components:
        for a, b in zip(part.pieces[:-1], part.pieces[1:], strict=True):
            nodes, width = np.polynomial.legendre.leggauss(36 if b > a else 1)
            x = 0.5 * (a + b) + 0.5 * (b - a) * nodes
            mass = 0.5 * (b - a) * width * part.pdf(x) if b > a else np.array([1.0])
            one = [sums(contact(law(ratio=float(each)), None))[:2] for each in x]
            reference = reference + weight * np.tensordot(mass, one, 1)
    np.testing.assert_allclose(sums(contact(law(), shape))[:2], reference, rtol=1e-10)


def test_moments_of_the_classes_are_those_of_the_density():
    """Means of cosh ln λ and ln²λ, which the Gauss rule was not asked for."""
    shape = tb.surfaces.Ellipticity.from_distribution(tb.distributions.Uniform(low=1, high=5))
    ratio = np.array(shape.ratios)
    shares = np.array([each.share for each in shape.classes])
    assert shares.sum() == pytest.approx(1, abs=1e-14)
    assert shares @ (ratio + 1 / ratio) == pytest.approx((12 + math.log(5)) / 4, rel=1e-9)
    log = math.log(5)
    assert shares @ np.log(ratio) ** 2 == pytest.approx((5 * (log**2 - 2 * log + 2) - 2) / 4)


def test_ratios_below_one_are_turned():
    """λ and 1/λ are one shape: log-normal about 1 is the folded one."""
    shape = tb.surfaces.Ellipticity.from_distribution(tb.LogNormal(median=1.0, gsd=1.5))
    shares = np.array([each.share for each in shape.classes])
    assert min(shape.ratios) >= 1
    assert shares @ np.log(shape.ratios) ** 2 == pytest.approx(math.log(1.5) ** 2, rel=1e-12)
    assert tb.surfaces.Ellipticity.from_distribution(
        tb.distributions.Monodisperse(mean=0.25)
    ).ratios == pytest.approx((4,), rel=1e-14)


# ---------------------------------------------------------------- two faces
def tensor(ratio, R, angle):
    """Curvature tensor of a tip with its long axis at an angle."""
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, -s], [s, c]])
    long, short = R * math.sqrt(ratio), R / math.sqrt(ratio)
    return turn @ np.diag([1 / long, 1 / short]) @ turn.T


ratios = st.floats(1, 1000)
radii = st.floats(1e-7, 1e-3)
angles = st.floats(0, math.pi / 2)


@given(ratios, radii, ratios, radii, angles)
def test_sum_of_curvature_tensors(first, R_first, second, R_second, angle):
    found, R = combined_tips(first, R_first, second, R_second, angle)
    low, high = np.linalg.eigvalsh(tensor(first, R_first, 0) + tensor(second, R_second, angle))
    # numpy's eigenvalues carry an error of the larger one
    loss = 1e-14 * high / low
    assert float(found) == pytest.approx(high / low, rel=1e-13 + loss)
    assert float(R) == pytest.approx((low * high) ** -0.5, rel=1e-13 + loss)
    # R_g is never above that of round tips
    assert R <= R_first * R_second / (R_first + R_second) * (1 + 1e-15)


@given(ratios, radii, ratios, radii, angles)
def test_the_faces_can_change_places(first, R_first, second, R_second, angle):
    one = combined_tips(first, R_first, second, R_second, angle)
    two = combined_tips(second, R_second, first, R_first, angle)
    np.testing.assert_allclose(one, two, rtol=1e-13)


@given(ratios, radii, ratios, radii)
def test_parallel_and_crossed(first, R_first, second, R_second):
    """At 0 and 90° the principal curvatures add, long to long or long to short."""
    a, b = 1 / (R_first * math.sqrt(first)), math.sqrt(first) / R_first
    c, e = 1 / (R_second * math.sqrt(second)), math.sqrt(second) / R_second
    for angle, one, two in ((0.0, a + c, b + e), (math.pi / 2, a + e, b + c)):
        ratio, R = combined_tips(first, R_first, second, R_second, angle)
        assert float(ratio) == pytest.approx(max(one / two, two / one), rel=1e-13)
        assert float(R) == pytest.approx((one * two) ** -0.5, rel=1e-13)


def test_equal_faces():
    parallel = tb.surfaces.Ellipticity.combined(first_ratio=9, second_ratio=9, angle=0.0)
    assert parallel.ratios == pytest.approx((9,), rel=1e-15)
    assert parallel.radii == pytest.approx((1,), rel=1e-15)
    crossed = tb.surfaces.Ellipticity.combined(first_ratio=9, second_ratio=9, angle=math.pi / 2)
    assert crossed.ratios == pytest.approx((1,), rel=1e-15)
    # 2√λ/(1 + λ) for both radii √λ and 1/√λ
    assert crossed.radii == pytest.approx((0.6,), rel=1e-15)


def test_a_round_face_has_no_angle():
    shapes = [
        tb.surfaces.Ellipticity.combined(
            first_ratio=5, R_first=3e-6, second_ratio=1, R_second=2e-6, angle=t
        )
        for t in (0.0, 0.7, "random")
    ]
    for shape in shapes:
        assert shape.ratios == pytest.approx(shapes[0].ratios, rel=1e-14)
        assert shape.radii == pytest.approx(shapes[0].radii, rel=1e-14)


@both_laws
def test_random_angles_are_the_mean_over_angles(law):
    faces = dict(first_ratio=6, R_first=5e-6, second_ratio=3, R_second=7e-6)
    shape = tb.surfaces.Ellipticity.combined(**faces, angle="random")
    nodes, width = np.polynomial.legendre.leggauss(24)
    each = [
        sums(contact(law(), tb.surfaces.Ellipticity.combined(**faces, angle=math.pi / 4 * (1 + x))))
        for x in nodes
    ]
    expected = np.tensordot(0.5 * width, each, 1)
    np.testing.assert_allclose(sums(contact(law(), shape))[:2], expected[:2], rtol=1e-10)


# ---------------------------------------------------------------- everything that takes a contact
def test_solve_sweep_transitions_with_particles():
    between = contact(tb.asperity.EllipticZMC(), MIXED, particles=DUST, particle_law=LAW)
    state = tb.solve(between, F_star=[1e-6, 1e-5, 1e-4])
    assert list(state.status) == ["ok"] * 3
    back = tb.solve(between, d=state.d)
    np.testing.assert_allclose(back.F_star, state.F_star, rtol=1e-12)

    shapes = [MIXED.replace(weights=None), MIXED]
    swept = tb.sweep(between, F_star=1e-5, vary={"roughness.ellipticity": shapes})
    assert swept.A_t.values[1, 0] == pytest.approx(state.A_t[1], rel=1e-13)
    assert swept.A_t.values[0, 0] != pytest.approx(state.A_t[1], rel=1e-4)

    critical = tb.transitions(between)
    round_tips = tb.transitions(
        contact(tb.asperity.EllipticZMC(), None, particles=DUST, particle_law=LAW)
    )
    at = tb.solve(between, F_star=critical.F_cr2.value)
    assert at.A_ss / at.A_t == pytest.approx(0.95, rel=1e-6)
    assert critical.F_cr2.value != pytest.approx(round_tips.F_cr2.value, rel=1e-4)


@both_laws
@pytest.mark.parametrize("heights", [tb.heights.GaussianHeights(), tb.heights.ExponentialHeights()])
def test_derivatives(law, heights):
    from thirdbody.contact.asperity_sums import asperity_sum

    total = asperity_sum(law(), ROUGH.replace(heights=heights, ellipticity=MIXED), PAIR, 0.0)
    d, step = 1.1 * ROUGH.sigma, 1e-4 * ROUGH.sigma
    low, (F, slope, bend), high = total.load(np.array([d - step, d, d + step]))
    assert slope == pytest.approx((high[0] - low[0]) / (2 * step), rel=1e-6)
    assert bend == pytest.approx((high[1] - low[1]) / (2 * step), rel=1e-6)
    assert total.fields(np.array([d]))[0, 0] == pytest.approx(F, rel=1e-12)
    assert total.highest > 5


def test_json_and_replace():
    one = contact(tb.asperity.EllipticCEB(), MIXED)
    text = json.dumps(one.to_dict())
    assert tb.Contact.from_dict(json.loads(text)) == one
    turned = one.replace(**{"roughness.ellipticity.ratios": (1, 3, 5)})
    assert turned.roughness.ellipticity == MIXED.replace(ratios=(1, 3, 5))
    assert one.replace(**{"roughness.ellipticity": None}).roughness == ROUGH
    assert tb.cite(one) == tb.cite(one.replace(**{"roughness.ellipticity": None}))
    # a file from before there was an ellipticity
    old = {k: v for k, v in ROUGH.to_dict().items() if k != "ellipticity"}
    assert tb.Roughness.from_dict(old) == ROUGH


# ---------------------------------------------------------------- mistakes
@pytest.mark.parametrize(
    ("mistake", "words"),
    [
        (dict(ratios=()), ["Ellipticity.ratios is empty"]),
        (dict(ratios=(1, 0.5)), ["Ellipticity.ratios[1] = 0.5 must be >= 1", "shorter: 2"]),
        (dict(ratios=(math.nan,)), ["ratios[0] = nan must be >= 1"]),
        (dict(ratios=3), ["Ellipticity.ratios = 3 must be a sequence of numbers"]),
        (dict(ratios=(1, 2), weights=(1,)), ["2 ratios and 1 weights", "one for each"]),
        (dict(ratios=(1, 2), weights=(1, 0)), ["weights[1] = 0 must be > 0", "leave the class"]),
        (dict(ratios=(1,), radii=(-1,)), ["radii[0] = -1 must be > 0"]),
        (dict(ratios=(0.1,), radii=(1, 2)), ["ratios[0]", "1 ratios and 2 radii"]),
    ],
)
def test_a_wrong_population_is_refused(mistake, words):
    with pytest.raises(tb.errors.InvalidValue) as error:
        tb.surfaces.Ellipticity(**mistake)
    for word in words:
        assert word in str(error.value)


FACES = dict(first_ratio=4, second_ratio=2, angle=0.1)


@pytest.mark.parametrize(
    ("mistake", "words"),
    [
        (dict(first_ratio=0.5), ["first_ratio = 0.5 must be >= 1"]),
        (dict(angle=30), ["angle = 30 must be >= 0 and <= 1.5708 [rad]", "'30 deg'"]),
        (dict(angle="any"), ["angle = 'any' must be a number [rad] or 'random'"]),
        (dict(R_first=0, second_ratio=0), ["R_first = 0 must be > 0 [m]", "second_ratio = 0"]),
        (dict(first_ratio=1e4, second_ratio=1e4, angle="random"), ["too slender"]),
    ],
)
def test_wrong_faces_are_refused(mistake, words):
    with pytest.raises(tb.errors.InvalidValue) as error:
        tb.surfaces.Ellipticity.combined(**(FACES | mistake))
    for word in words:
        assert word in str(error.value)


@pytest.mark.parametrize(
    ("density", "words"),
    [
        (3.0, ["must be a distribution"]),
        (tb.distributions.Weibull(scale=2, shape=3), ["reaches down to 0"]),
        (
            tb.distributions.Uniform(low=1, high=40),
            ["spreads from 1 to 40", "too wide for 7 classes"],
        ),
    ],
)
def test_a_wrong_density_is_refused(density, words, monkeypatch):
    monkeypatch.setattr("thirdbody.populations.ellipticity.MOST_CLASSES", 7)
    with pytest.raises(tb.errors.InvalidValue) as error:
        tb.surfaces.Ellipticity.from_distribution(density)
    for word in words:
        assert word in str(error.value)


@pytest.mark.parametrize("law", tb.asperity.REGISTRY.values(), ids=lambda law: law.name)
def test_laws_without_a_ratio_are_refused(law):
    fields = {item.name for item in dataclasses.fields(law)}
    options = {name: 0.05 for name in ("w",) if name in fields}
    if "ratio" in fields:
        assert contact(law(), MIXED).roughness.ellipticity == MIXED
        with refuses(Mistake.CLASH, "Contact.asperity_law.ratio", value="3"):
            contact(law(ratio=3), MIXED)
        return
    try:
        made = law(**options)
    except (TypeError, tb.errors.InvalidValue):
        pytest.skip("the law needs a coating")
    with refuses(Mistake.BEYOND, "Contact.asperity_law", says="elliptic-zmc") as error:
        contact(made, MIXED)
    assert len(error.value.problems) == 1


def test_roughness_takes_an_ellipticity_only():
    with refuses(Mistake.KIND, "Roughness.ellipticity", value="(1, 2)"):
        tb.Roughness(sigma=1e-7, R=1e-6, ellipticity=(1, 2))


# ---------------------------------------------------------------- study files
def study(shape, law="elliptic-zmc", **rough):
    rough = {"sigma": "100 nm", "R": "2.8 um", "ellipticity": shape} | rough
    return {
        "surfaces": {"first": "S45C", "second": "S45C"},
        "roughness": {key: value for key, value in rough.items() if value is not None},
        "asperity_law": law,
        "load": {"pressure": "5 MPa"},
    }


@pytest.mark.parametrize(
    ("written", "expected"),
    [
        (dict(ratios=[1, 2, 5]), tb.surfaces.Ellipticity(ratios=(1, 2, 5))),
        (
            dict(ratios=[1, 2, 5], weights=[0.5, 0.3, 0.2], radii=["120 %", 1, 0.7]),
            tb.surfaces.Ellipticity(ratios=(1, 2, 5), weights=(0.5, 0.3, 0.2), radii=(1.2, 1, 0.7)),
        ),
        (
            dict(first=4, second=2, angle="90 deg"),
            tb.surfaces.Ellipticity.combined(first_ratio=4, second_ratio=2, angle=math.pi / 2),
        ),
        (
            dict(first=4, second=2, angle="random"),
            tb.surfaces.Ellipticity.combined(first_ratio=4, second_ratio=2, angle="random"),
        ),
    ],
)
def test_study_file(written, expected):
    made = check(study(written))
    assert made.contact.roughness.ellipticity == expected
    assert made.contact.roughness.R == 2.8e-6
    assert made.notes == ()
    told = run_study(made)
    assert told["states"]["status"] == ["ok"]
    again = tb.Roughness.from_dict(json.loads(json.dumps(told["inputs"]["roughness"])))
    assert again == made.contact.roughness


@pytest.mark.parametrize("R", [None, "2.4 um", "2.41 um"])
def test_two_faces_give_the_radius(R):
    faces = dict(first=4, second=2, angle="30 deg", R_first="4 um", R_second="6 um")
    made = check(study(faces, R=R)).contact.roughness
    assert made.R == pytest.approx(2.4e-6 if R is None else float(R[:-3]) * 1e-6, rel=1e-15)
    assert made.ellipticity == tb.surfaces.Ellipticity.combined(
        first_ratio=4, second_ratio=2, angle=math.radians(30), R_first=4e-6, R_second=6e-6
    )


@pytest.mark.parametrize(
    ("shape", "words"),
    [
        (3, ["roughness.ellipticity = 3 must be a table", "ratios = [1, 2, 5]", "30 deg"]),
        ("measured", ['ellipticity = "measured" must be a table', "goes with a topography"]),
        ({}, ["roughness.ellipticity.ratios is missing"]),
        ({"ratio": [1, 2]}, ["roughness.ellipticity.ratio", "did you mean ratios?"]),
        ({"ratios": 2}, ["roughness.ellipticity.ratios = 2 must be a list"]),
        ({"ratios": [1, 0.5]}, ["roughness.ellipticity.ratios[1] = 0.5 must be >= 1"]),
        ({"ratios": [1, 2], "weights": [1]}, ["roughness.ellipticity has 2 ratios and 1 weights"]),
        ({"ratios": ["2 nm"]}, ['roughness.ellipticity.ratios[0] = "2 nm" is a length']),
        ({"ratios": [2], "angle": 0}, ["ellipticity.angle = 0 is for two faces", "keep one"]),
        ({"first": 4, "second": 2}, ["roughness.ellipticity.angle is missing", '"30 deg"']),
        ({"first": 4, "angle": 0}, ["roughness.ellipticity.second is missing"]),
        ({"first": 0.4, "second": 2, "angle": 0}, ["ellipticity.first = 0.4 must be >= 1"]),
        ({"first": 4, "second": 2, "angle": 30}, ["angle = 30 must be an angle", '"30 deg"']),
        ({"first": 4, "second": 2, "angle": "30 nm"}, ['angle = "30 nm" must be an angle']),
        ({"first": 4, "second": 2, "angle": "any"}, ['or "random"']),
        ({"first": 4, "second": 2, "angle": 0, "R_first": "4 um"}, ["one face only"]),
        (
            {"first": 4, "second": 2, "angle": 0, "R_first": "4 um", "R_second": "6 um"},
            ['roughness.R = "2.8 um"', "= 2.4 µm", "leave it out"],
        ),
        (
            {"first": 1e5, "second": 1e5, "angle": "random"},
            ["roughness.ellipticity.first = 100000", "too slender"],
        ),
    ],
)
def test_mistakes_in_a_study_file(shape, words):
    with pytest.raises(tb.errors.InvalidValue) as error:
        check(study(shape))
    for word in words:
        assert word in str(error.value)


def test_a_study_with_a_round_law():
    with refuses(Mistake.BEYOND, "asperity_law"):
        check(study({"ratios": [1, 2]}, law="zmc"))


# ---------------------------------------------------------------- summits of a measured surface
def crossed_waves(first, second, amplitudes, points=512, side=10e-6):
    """Two waves of whole periods, their numbers along the axes given, and their curvatures."""
    x = np.arange(points) / points
    phases = (2 * np.pi * (m * x[:, None] + n * x) for m, n in (first, second))
    h = sum(a * np.cos(phase) for a, phase in zip(amplitudes, phases, strict=True))
    kappa = [
        a * (2 * np.pi / side) ** 2 * (m * m + n * n)
        for a, (m, n) in zip(amplitudes, (first, second), strict=True)
    ]
    made = from_topography(h, spacing=side / points, periodic=True, cutoff=0)
    return made, max(kappa), min(kappa)


@pytest.mark.parametrize(
    ("first", "second"), [((4, 0), (0, 8)), ((3, 4), (-8, 6)), ((6, 6), (-4, 4))]
)
def test_summits_of_crossed_waves_have_their_curvatures(first, second):
    """At a summit of a cos k₁x + b cos k₂x, k₁ ⊥ k₂, the curvatures are ak₁² and bk₂²."""
    made, larger, smaller = crossed_waves(first, second, (20e-9, 12e-9))
    principal = made.summits_at(0).principal
    # second differences at 51 points a wave and points beside the summit: 0.5 %
    np.testing.assert_allclose(principal[:, 0], larger, rtol=5e-3)
    np.testing.assert_allclose(principal[:, 1], smaller, rtol=5e-3)
    rough = made.roughness(ellipticity="measured")
    for ratio, radius, _ in rough.ellipticity.classes:
        assert ratio == pytest.approx(larger / smaller, rel=1e-2)
        assert radius * rough.R == pytest.approx(1 / math.sqrt(larger * smaller), rel=1e-2)
    assert sum(each.share for each in rough.ellipticity.classes) == pytest.approx(1)


def wavy(points, seed):
    """Heights [m] of an isotropic random surface, 20 points to its shortest wave."""
    lengths = {"sigma": 20e-9, "shortest": 2e-6, "longest": 8e-6, "spacing": 1e-7}
    return self_affine(**lengths, hurst=0.7, points=points, seed=seed).heights


def test_a_stretched_surface_has_stretched_summits():
    """Twice the spacing along x, a quarter of that curvature: the tensor tells, point by point."""
    h = wavy(256, seed=3)
    plain, stretched = (
        from_topography(h, spacing=s, periodic=True, cutoff=0).summits_at(0).principal
        for s in ((1e-7, 1e-7), (2e-7, 1e-7))
    )
    assert len(plain) == len(stretched) > 50
    product = stretched.prod(axis=1) / plain.prod(axis=1)  # of the determinant: 1/4 each
    np.testing.assert_allclose(product, 0.25, rtol=1e-9)
    assert np.median(stretched[:, 0] / stretched[:, 1]) > np.median(plain[:, 0] / plain[:, 1])


def test_classes_of_summits_carry_what_the_summits_carry():
    """Elastic load and area of the classes, against the sum over every summit."""
    from thirdbody.reference import elliptic_hertz

    h = wavy(512, seed=4)
    made = from_topography(h, spacing=(2e-7, 1e-7), periodic=True, cutoff=0)
    kappa = made.summits_at(0).principal
    kappa = kappa[kappa[:, 1] > 0]
    shape = made.roughness(ellipticity="measured")
    tips = [elliptic_hertz(a / b) for a, b in kappa]
    R_g = 1 / np.sqrt(kappa.prod(axis=1)) / shape.R
    load = np.mean([tip.root_R_F for tip in tips] * np.sqrt(R_g))
    area = np.mean([tip.R_A for tip in tips] * R_g)
    classes = [(elliptic_hertz(a), rho, w) for a, rho, w in shape.ellipticity.classes]
    assert len(kappa) > 200
    assert len(classes) == 64
    assert sum(w * t.root_R_F * rho**0.5 for t, rho, w in classes) == pytest.approx(load, rel=1e-12)
    assert sum(w * t.R_A * rho for t, rho, w in classes) == pytest.approx(area, rel=1e-2)


@pytest.mark.parametrize(
    ("curvatures", "R", "refusal"),
    [
        ([[1e5, -1e5], [2e5, 1e5]], 1e-6, refuses(Mistake.BEYOND, "", says="50")),
        (np.empty((0, 2)), 1e-6, refuses(Mistake.SHAPE, "", says="2")),
        ([[1e5, 1e5, 1e5]], 1e-6, refuses(Mistake.SHAPE, "", says="2")),
        ([[1e5, 1e5]], -1.0, refuses(Mistake.RANGE, "R", value="-1.0")),
    ],
)
def test_curvatures_that_are_no_summits(curvatures, R, refusal):
    with refusal:
        tb.surfaces.Ellipticity.from_curvatures(curvatures, R=R)


def test_a_measured_surface_solves_with_its_own_tips():
    rough = from_topography("example").roughness(ellipticity="measured")
    law = tb.asperity.EllipticZMC()
    state = tb.solve(tb.Contact(surfaces=PAIR, roughness=rough, asperity_law=law), pressure=1e6)
    plain = rough.replace(ellipticity=None)
    still = tb.solve(tb.Contact(surfaces=PAIR, roughness=plain), pressure=1e6)
    assert state.F_star == pytest.approx(still.F_star)
    assert state.d != still.d
    with pytest.raises(tb.errors.InvalidValue, match="measured"):
        from_topography("example").roughness(ellipticity="round")
