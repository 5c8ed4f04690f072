"""The elastic layer, and asperities with a coating: exact values, limits, other routes."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from refusals import Mistake, refuses

import thirdbody as tb
from thirdbody.contact.interface import interface
from thirdbody.laws.asperity import GW, Coated
from thirdbody.laws.asperity.layer import ElasticLayer

STIFF, MILD = (10.0, 0.25, 0.3), (2.0, 0.3, 0.3)
YIELDING, SOFT = (0.5, 0.3, 0.3), (0.1, 0.4, 0.3)

VALUES = [
    # E_1/E_2, ν_1, ν_2; a/t; FR/(E_1*a³), δR/a², S/(E_1*a)
    (STIFF, 0.01, 1.3333316196989, 1.0306597101563, 1.9120629760571),
    (STIFF, 0.3, 1.2919360412447, 1.853401208281, 0.85227733866558),
    (STIFF, 3.0, 0.31962181748331, 1.5607982255297, 0.28701381295954),
    (MILD, 0.01, 1.3333329051676, 1.0047513880745, 1.9858461963864),
    (MILD, 0.3, 1.3229531012696, 1.1319050130068, 1.6587803657202),
    (MILD, 3.0, 0.88971347272978, 1.1474604475767, 1.1310635022786),
    (YIELDING, 0.01, 1.3333336329514, 0.99728207740781, 2.0081875064657),
    (YIELDING, 0.3, 1.3406127963223, 0.92471393848962, 2.264206770592),
    (YIELDING, 3.0, 1.8617102909594, 0.86463158102266, 3.3668598433357),
    (SOFT, 0.01, 1.3333340682067, 0.99428383778222, 2.0172976811275),
    (SOFT, 0.3, 1.3511776235187, 0.84266543059272, 2.6439059936708),
    (SOFT, 3.0, 3.2595814226298, 0.63914233039985, 9.036192460475),
]
ROUNDED = [
    (STIFF, 0.1, 1.33163744, 1.30469372, 1.37113874),
    (STIFF, 1.0, 0.79698952, 2.27684950, 0.42566020),
    (STIFF, 10.0, 0.19182621, 1.19329622, 0.23719373),
    (MILD, 1.0, 1.16749729, 1.23756398, 1.31376646),
    (YIELDING, 1.0, 1.46660187, 0.84741547, 2.79707090),
    (SOFT, 0.1, 1.33405865, 0.94345534, 2.18628496),
    (SOFT, 1.0, 1.68410569, 0.66955552, 4.67700564),
    (SOFT, 10.0, 6.56972790, 0.75712349, 13.8512532),
]


def layer(case, **more) -> ElasticLayer:
    ratio, nu_1, nu_2 = case
    return ElasticLayer(modulus_ratio=ratio, nu_1=nu_1, nu_2=nu_2, **more)


def coated(case, E_1=2e11, t=1e-7, **more) -> Coated:
    ratio, nu_1, nu_2 = case
    return Coated(E_1=E_1, nu_1=nu_1, t=t, E_2=E_1 / ratio, nu_2=nu_2, **more)


# ------------------------------------------------------------------------ compliance
def compliance_by_elasticity(case, x: float) -> float:
    """M from the equations of plane strain: six constants of two Airy functions.

    φ = f(z)cos(x), t = 1 and ξ = x scaled away: σ_zz = −f, σ_xz ∝ f′, σ_xx = f″.
    """
    ratio, nu_1, nu_2 = case
    mu_1, mu_2 = ratio * (1 + nu_2) / (1 + nu_1), 1.0

    def state(z, k, power, mu, nu):
        """σ_zz, σ_xz, w and u of f = z^power e^{kz}, k = ±1."""
        e = math.exp(k * z)
        f = [e, z * e][power]
        df = [k * e, (1 + k * z) * e][power]
        ddf = [e, (2 * k + z) * e][power]
        integral = [e / k, e * (z / k - 1)][power]
        w = -((1 - nu) * integral + nu * df) / (2 * mu)
        u = ((1 - nu) * ddf + nu * f) / (2 * mu)
        return np.array([-f, df, w, u])

    top = [state(0.0, k, n, mu_1, nu_1) for k in (-1, 1) for n in (0, 1)]
    low = [state(x, k, n, mu_1, nu_1) for k in (-1, 1) for n in (0, 1)]
    base = [state(0.0, -1, n, mu_2, nu_2) for n in (0, 1)]
    matrix = np.zeros((6, 6))
    matrix[:2, :4] = np.array(top).T[:2]
    matrix[2:, :4] = np.array(low).T
    matrix[2:, 4:] = -np.array(base).T
    constants = np.linalg.solve(matrix, [-1.0, 0, 0, 0, 0, 0])
    w = np.array(top).T[2] @ constants[:4]
    bare = (1 - nu_1) / mu_1  # 2/(E_1*ξ)
    return w / bare


@pytest.mark.parametrize("case", [STIFF, MILD, YIELDING, SOFT, (3, 0.5, 0.1), (0.2, 0.0, 0.5)])
def test_compliance_follows_from_elasticity(case):
    x = np.array([1e-3, 0.05, 0.3, 1.0, 2.0, 5.0])
    expected = [compliance_by_elasticity(case, k) for k in x]
    assert_allclose(layer(case).compliance(x), expected, rtol=1e-9)


@pytest.mark.parametrize("case", [STIFF, SOFT])
def test_compliance_of_long_and_short_waves(case):
    ratio, nu_1, nu_2 = case
    one = layer(case)
    assert one.compliance(0.0) == pytest.approx(ratio * (1 - nu_2**2) / (1 - nu_1**2), rel=1e-13)
    assert one.compliance(40.0) == 1.0
    assert one.thin_modulus == pytest.approx(1 / one.compliance(0.0), rel=1e-13)


# ------------------------------------------------------------------------ integral equation
@pytest.mark.parametrize(("case", "a_t", "Phi", "Delta", "s"), VALUES)
def test_contact(case, a_t, Phi, Delta, s):
    assert_allclose(layer(case).contact(a_t), (Phi, Delta, s), rtol=1e-12)


@pytest.mark.parametrize(("case", "a_t", "Phi", "Delta", "s"), ROUNDED)
def test_contact_to_eight_digits(case, a_t, Phi, Delta, s):
    assert_allclose(layer(case).contact(a_t), (Phi, Delta, s), rtol=2e-8)


@pytest.mark.parametrize("a_t", [10.0, 30.0])
def test_plain_nystrom_gives_the_same(a_t):
    """One Gauss rule over the contact, its kernel by brute force."""
    n = int(4 * a_t) + 40
    nodes, weights = np.polynomial.legendre.leggauss(n)
    u, weights = 0.5 * (nodes + 1), 0.5 * weights
    x, dx = np.polynomial.legendre.leggauss(400)
    x, dx = 12 * (x + 1), 12 * dx
    excess = (layer(STIFF).compliance(x) - 1) * dx

    def rows(at):
        wave = np.cos(np.multiply.outer(a_t * at, x))
        return 2 * a_t / math.pi * (wave * excess) @ np.cos(np.outer(x, a_t * u)) * weights

    both = np.stack([np.ones(n), u**2], axis=1)
    chi = np.linalg.solve(np.eye(n) + rows(u), both)
    edge = 1 - rows(np.ones(1))[0] @ chi
    Delta = edge[1] / edge[0]
    punch, curved = weights @ chi
    expected = 2 * (Delta * punch - curved), Delta, 2 * punch
    assert_allclose(layer(STIFF).contact(a_t), expected, rtol=1e-11)


@pytest.mark.parametrize("case", [STIFF, SOFT, (300.0, 0.2, 0.45), (3e-3, 0.5, 0.3)])
@pytest.mark.parametrize("a_t", [0.02, 0.7, 5.0, 200.0])
def test_stiffness_is_that_of_a_flat_punch(case, a_t):
    """dF/dδ at the rim, where the pressure vanishes, does not feel that the rim moves."""
    h = 1e-3
    a = a_t * np.array([1 - h, 1 + h, 1 - 2 * h, 1 + 2 * h])
    Phi, Delta, _ = layer(case).contact(a)
    F, d = Phi * a**3, Delta * a**2

    def slope(q):
        return (8 * (q[1] - q[0]) - (q[3] - q[2])) / (12 * h)

    s = layer(case).contact(a_t)[2]
    assert slope(F) / slope(d) == pytest.approx(s * a_t, rel=1e-8)


@pytest.mark.parametrize("a_t", [1e-3, 1.0, 30.0, 1000.0])
def test_one_material_is_hertz(a_t):
    assert_allclose(layer((1.0, 0.3, 0.3)).contact(a_t), (4 / 3, 1, 2), rtol=1e-13)
    series = layer((1.0, 0.3, 0.3), indenter=1.0).contact(a_t)
    assert_allclose(series, (2 / 3, 1, 1), rtol=1e-13)


@pytest.mark.parametrize(("case", "k_0"), [(STIFF, 7.2244), (SOFT, -1.34699)])
def test_thick_layer(case, k_0):
    one = layer(case)
    assert one.thick_slope == pytest.approx(k_0, rel=1e-5)
    a = np.array([1e-3, 2e-3])
    Phi, Delta, _ = one.contact(a)
    assert_allclose((Delta - 1) / a, 4 * one.thick_slope / (3 * math.pi), rtol=1e-2)
    assert (Phi[1] - 4 / 3) / (Phi[0] - 4 / 3) == pytest.approx(8, rel=0.05)


@pytest.mark.parametrize("case", [STIFF, SOFT])
def test_thin_layer_is_approached_slowly(case):
    one = layer(case)
    a = np.array([30.0, 1000.0])
    Phi, Delta, s = one.contact(a)
    bare = one.thin_modulus
    away = np.abs([Phi / bare / (4 / 3) - 1, Delta - 1, s / bare / 2 - 1])
    # a logarithm slower than t/a
    assert np.all(away[:, 1] < 3 * 0.03 * away[:, 0])
    assert np.all(away[:, 1] < 0.02)
    assert away[0, 0] > 0.03


def test_stiff_layer_on_equal_poisson_ratios_at_thirty_thicknesses():
    Phi, Delta, _ = layer((10.0, 0.3, 0.3)).contact(30.0)
    assert Phi * 10 / (4 / 3) == pytest.approx(1.16, abs=0.01)
    assert pytest.approx(1.08, abs=0.01) == Delta


def test_soft_indenter_takes_over():
    """With an indenter far softer than both, the layer does not show."""
    Phi, Delta, s = layer(STIFF, indenter=1e6).contact(1.0)
    assert_allclose((Phi * 1e6, Delta, s * 1e6), (4 / 3, 1, 2), rtol=1e-5)


@pytest.mark.parametrize("a_t", [-0.1, 2000.0, math.inf])
def test_radius_out_of_range(a_t):
    with pytest.raises(tb.errors.InvalidValue, match="a/t"):
        layer(MILD).contact([1.0, a_t])


@pytest.mark.check
# ------------------------------------------------------------------------ table
@pytest.mark.parametrize("case", [STIFF, SOFT])
def test_table_is_the_solution(case):
    a = np.concatenate([[1e-6], np.geomspace(1e-3, 1000, 25)])
    Phi, Delta, s = layer(case).contact(a)
    F, A, S = layer(case).reduced(Delta * a**2)
    assert_allclose(F, Phi * a**3, rtol=2e-11)
    assert_allclose(A, a**2, rtol=2e-11)
    assert_allclose(S, s * a, rtol=2e-11)


@pytest.mark.parametrize("case", [STIFF, SOFT])
def test_beyond_the_table(case):
    """Continued without a step or a bend towards the substrate alone."""
    one = layer(case)
    y = 1024.0**2 * float(one.contact(1024.0)[1])
    below, above = (np.array(one.reduced(y * (1 + e))) for e in (-1e-9, 1e-9))
    assert_allclose(above, below, rtol=5e-9)
    far = np.geomspace(y, 1e14, 200)
    F, A, S = one.reduced(far)
    h = 1e-4
    rise = (one.reduced(far[1:] * (1 + h))[0] - one.reduced(far[1:] * (1 - h))[0]) / (2 * h)
    assert_allclose(rise / far[1:], S[1:], rtol=1e-8)
    hertz = one.thin_modulus * 4 / 3 * far**1.5
    distance = np.abs(F / hertz - 1)
    assert np.all(np.diff(distance) < 0)
    assert distance[-1] < 1e-6
    assert abs(A[-1] / far[-1] - 1) < 1e-5


def test_no_contact_and_shapes():
    assert [float(q) for q in layer(STIFF).reduced(-1.0)] == [0, 0, 0]
    assert layer(STIFF).reduced(np.ones((2, 3)))[0].shape == (2, 3)


# ------------------------------------------------------------------------ the law
R, E_STAR, H = 3e-6, 1e11, 3e9
KEYS = dict(R=R, E_star=E_STAR, H=H)


@pytest.mark.parametrize(("case", "a_t", "Phi", "Delta", "s"), VALUES[:3] + VALUES[-3:])
def test_asperity(case, a_t, Phi, Delta, s):
    law, t = coated(case), 1e-7
    E_1 = 2e11 / (1 - law.nu_1**2)
    a = a_t * t
    omega = Delta * a**2 / R
    assert law.contact_radius(omega, **KEYS) == pytest.approx(a, rel=1e-10)
    assert law.force(omega, **KEYS) == pytest.approx(Phi * E_1 * a**3 / R, rel=1e-10)
    assert law.stiffness(omega, **KEYS) == pytest.approx(s * E_1 * a, rel=1e-10)
    assert law.mean_pressure(omega, **KEYS) == pytest.approx(Phi * E_1 * a / (math.pi * R))
    assert law.regime(omega, **KEYS) == "elastic"


def test_hardness_and_modulus_of_the_contact_do_not_enter():
    law, omega = coated(STIFF), np.geomspace(1e-11, 1e-7, 9)
    for method in (law.force, law.area, law.stiffness, law.energy):
        one = method(omega, **KEYS)
        assert_allclose(method(omega, R=R, E_star=9 * E_STAR, H=1e3 * H), one, rtol=1e-14)


def test_scaling():
    """Same shapes: loads as the square of the size, and as the stress."""
    omega, k = np.geomspace(1e-11, 1e-7, 9), 7.0
    F = coated(STIFF).force(omega, **KEYS)
    larger = coated(STIFF, t=k * 1e-7).force(k * omega, R=k * R, E_star=E_STAR, H=H)
    harder = coated(STIFF, E_1=k * 2e11).force(omega, **KEYS)
    assert_allclose(larger, k**2 * F, rtol=1e-12)
    assert_allclose(harder, k * F, rtol=1e-12)


def test_one_material_against_an_elastic_body_is_hertz():
    law = coated((1.0, 0.3, 0.3), E_3=7e10, nu_3=0.2)
    E_star = 1 / ((1 - 0.3**2) / 2e11 + (1 - 0.2**2) / 7e10)
    keys = dict(R=R, E_star=E_star, H=H)
    omega = np.geomspace(1e-12, 1e-6, 9)
    for name in ("force", "area", "stiffness", "energy"):
        ours, hertz = (getattr(one, name)(omega, **keys) for one in (law, GW()))
        assert_allclose(ours, hertz, rtol=1e-12)


@pytest.mark.parametrize("case", [STIFF, SOFT])
def test_thickness_runs_from_coating_to_substrate(case):
    """An effective modulus depends on the load: from E_1* to E_2*, never on t alone."""
    law, omega = coated(case), np.geomspace(1e-16, 1e-3, 40)
    effective = law.force(omega, **KEYS) / (4 / 3 * math.sqrt(R) * omega**1.5)
    ends = law.E_1_star, law.E_2 / (1 - law.nu_2**2)
    assert_allclose(effective[[0, -1]], ends, rtol=5e-3)
    assert np.all(np.diff(effective) * (ends[1] - ends[0]) > 0)


def test_a_stiff_coating_lowers_the_approach_at_one_load_only():
    law = coated(STIFF)
    bare = dict(R=R, E_star=law.E_2 / (1 - law.nu_2**2), H=H)
    omega = 3e-9
    assert law.force(omega, **KEYS) > GW().force(omega, **bare)
    # the same contact radius needs a larger approach
    assert law.area(omega, **KEYS) < GW().area(omega, **bare)


@pytest.mark.parametrize(
    ("heights", "h", "F", "A", "rtol"),
    [
        (tb.heights.GaussianHeights(), 0.5, 2.726132100026e-4, 2.652385534603e-2, 1e-10),
        (tb.heights.GaussianHeights(), 3.0, 3.777405748688e-7, 4.871026776323e-5, 1e-11),
        (
            tb.heights.JohnsonHeights(skewness=-0.7, kurtosis=4.2),
            1.5,
            1.243286623426e-5,
            1.599285161095e-3,
            1e-11,
        ),
        # these two were made with an equation resolved to a/t = 30 and reach to 60
        (tb.heights.WeibullHeights(shape=1.8), 0.5, 3.420807024881e-4, 2.994559938564e-2, 2e-9),
        (tb.heights.ExponentialHeights(), 1.5, 1.500471506989e-4, 1.131086556798e-2, 4e-7),
    ],
)
def test_sums_over_a_rough_surface(heights, h, F, A, rtol):
    """E_1/E_2 = 5, t = σ_s, σ_s/R = 0.01, ηRσ_s = 0.05; load over E_1*."""
    radius, sigma_s = 1e-5, 1e-7
    law = coated((5.0, 0.3, 0.25), t=sigma_s)
    body = tb.Material(E=1e11, nu=0.3, H=1e9)
    contact = tb.Contact(
        surfaces=tb.MaterialPair(body, body),
        roughness=tb.Roughness(
            sigma=sigma_s / math.sqrt(1 - 0.8968 / 10),
            R=radius,
            alpha=10.0,
            eta=0.05 / (radius * sigma_s),
            heights=heights,
        ),
        asperity_law=law,
    )
    fields = interface(contact).fields(np.array([h * sigma_s]))
    assert fields["F_ss"][0] / law.E_1_star == pytest.approx(F, rel=rtol)
    assert fields["A_e"][0] == pytest.approx(A, rel=rtol)
    assert fields["A_ep"][0] == fields["A_p"][0] == 0


def test_a_vanishing_coating_in_a_contact_is_no_coating():
    steel = tb.materials["S45C"]
    law = Coated(
        E_1=4e11, nu_1=0.2, t=1e-13, E_2=steel.E, nu_2=steel.nu, E_3=steel.E, nu_3=steel.nu
    )
    contact = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        asperity_law=law,
    )
    bare = contact.replace(asperity_law=GW())
    one, two = (tb.solve(c, pressure=1e7) for c in (contact, bare))
    assert one.d == pytest.approx(two.d, rel=1e-6)
    assert one.A_t == pytest.approx(two.A_t, rel=1e-6)


def test_refusals():
    with refuses(Mistake.BEYOND, "Series.law", value="Coated"):
        tb.particle.Series(deep="off", law=coated(STIFF))
    with pytest.raises(tb.errors.InvalidValue, match="scale"):
        coated(STIFF).reduced("force", 1.0)
    with pytest.raises(tb.errors.InvalidValue, match=r"Coated\.t"):
        coated(STIFF, t=0.0)
