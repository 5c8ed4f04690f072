"""Distributions of asperity heights: zero mean, unit variance, and what else they promise."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from refusals import Mistake, refuses
from scipy import stats
from scipy.optimize import brentq
from subjects import E_STAR, HEIGHTS, SIGMA_S, contact, quadrature

import thirdbody as tb
from thirdbody.contact.asperity_sums import DensitySum

NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)


def integral(law: tb.heights.Heights, powers: range, top: float | None = None) -> np.ndarray:
    """∫z^j φ dz up to ``top``; the first panel with u = (z − z_0)^(1/6), for an edge z^(β−1)."""
    marks = np.array(law.pieces)
    ends = [z for z in (*law.kinks, *marks) if top is None or z < top]
    if top is not None:
        ends.append(top)
    marks = np.unique(ends)
    total = np.zeros(len(powers))
    for i, (a, b) in enumerate(zip(marks[:-1], marks[1:], strict=True)):
        for lower, upper in ((0.0, 0.5), (0.5, 1.0)):
            u = 0.5 * (lower + upper) + 0.5 * (upper - lower) * NODES
            weight = 0.5 * (upper - lower) * WEIGHTS * (b - a)
            if i == 0:
                weight, u = 6 * u**5 * weight, u**6
            z = a + (b - a) * u
            total += (weight * law.pdf(z)) @ z[:, None] ** np.array(powers)
    return total


ALL = {
    **HEIGHTS,
    "weibull-1": tb.heights.WeibullHeights(shape=1.0),
    "weibull-1.3": tb.heights.WeibullHeights(shape=1.3),
    "weibull-3.6": tb.heights.WeibullHeights(shape=3.6),
    "weibull-20": tb.heights.WeibullHeights(shape=20.0),
    "johnson-SN": tb.heights.JohnsonHeights(),
    "johnson-SU-symmetric": tb.heights.JohnsonHeights(skewness=0.0, kurtosis=5.0),
    "johnson-SU-right": tb.heights.JohnsonHeights(skewness=1.0, kurtosis=6.0),
    "johnson-SB-left": tb.heights.JohnsonHeights(skewness=-0.9, kurtosis=3.3),
    "johnson-SB-flat": tb.heights.JohnsonHeights(skewness=0.0, kurtosis=2.0),
    "histogram-one": tb.heights.HistogramHeights(edges=(-3, 5), counts=(7,)),
    "histogram-gap": tb.heights.HistogramHeights(edges=(0, 1, 2, 4), counts=(1, 0, 2)),
}
every = pytest.mark.parametrize("law", ALL.values(), ids=ALL)


@every
def test_zero_mean_unit_variance(law):
    assert_allclose(integral(law, range(3)), [1, 0, 1], atol=1e-12)


@every
def test_ppf_is_the_inverse_of_the_distribution(law):
    q = np.array([1e-4, 0.03, 0.3, 0.5, 0.8, 0.999])
    z = law.ppf(q)
    assert np.all(np.diff(z) > 0)
    assert_allclose([integral(law, range(1), top)[0] for top in z], q, rtol=1e-9, atol=1e-12)
    # a number and an array: see test_density_is_a_density
    np.testing.assert_array_max_ulp(law.ppf(0.3), z[2], maxulp=16)


@every
def test_density_is_a_density(law):
    z = np.linspace(law.pieces[0] - 2, law.pieces[-1] + 2, 801)
    phi = law.pdf(z)
    assert np.all(phi >= 0)
    assert np.all(np.isfinite(phi))
    assert phi[0] == 0 or phi[0] < 1e-30
    # one number and an array go through other instructions: exp and powers of NumPy are off by
    # up to 4 units in the last place (its own bound for the vector forms), here of up to three
    np.testing.assert_array_max_ulp(law.pdf(0.1), law.pdf(np.array([0.1]))[0], maxulp=16)
    assert list(law.pieces) == sorted(law.pieces)
    assert law.highest <= max((*law.kinks, law.pieces[-1]))


@every
def test_round_trip(law):
    again = tb.heights.Heights.from_dict(json.loads(json.dumps(law.to_dict())))
    assert again == law
    assert hash(again) == hash(law)


@every
def test_samples(law):
    z = law.sample(np.random.default_rng(7), 40_000)
    error = 1 / math.sqrt(40_000)
    assert abs(z.mean()) < 4 * error
    fourth = float(np.mean((z - z.mean()) ** 4))
    assert abs(z.var() - 1) < 4 * error * math.sqrt(fourth - 1)
    assert z.shape == (40_000,)
    assert z.min() >= law.pieces[0]


# -------------------------------------------------------------------------------- Johnson
@pytest.mark.parametrize(
    "name", [name for name, law in ALL.items() if isinstance(law, tb.heights.JohnsonHeights)]
)
def test_johnson_has_the_moments_asked_for(name):
    law = ALL[name]
    assert_allclose(integral(law, range(5))[3:], [law.skewness, law.kurtosis], atol=2e-11)


def test_johnson_anchor_and_closed_moments():
    law = tb.heights.JohnsonHeights(skewness=-0.7, kurtosis=4.2)
    assert law.family == "SU"
    assert_allclose(law.parameters, [2.25366, 2.99553, 1.88369, 2.15859], atol=6e-6)
    gamma, delta, xi, lam = law.parameters
    W, omega = math.exp(delta**-2), gamma / delta
    first = -math.sqrt(W) * math.sinh(omega)
    second = 0.5 * (W - 1) * (W * math.cosh(2 * omega) + 1)
    assert_allclose(xi + lam * first, 0, atol=1e-12)
    assert_allclose(lam**2 * second, 1, rtol=1e-12)
    third = W * (W + 2) * math.sinh(3 * omega) + 3 * math.sinh(omega)
    third *= -0.25 * math.sqrt(W) * (W - 1) ** 2
    fourth = W**2 * (W**4 + 2 * W**3 + 3 * W**2 - 3) * math.cosh(4 * omega)
    fourth += 4 * W**2 * (W + 2) * math.cosh(2 * omega) + 3 * (2 * W + 1)
    fourth *= 0.125 * (W - 1) ** 2
    assert_allclose([third / second**1.5, fourth / second**2], [-0.7, 4.2], rtol=1e-10)


@pytest.mark.parametrize("W", [1.01, 1.1, 1.4])
@pytest.mark.parametrize("sign", [-1, 1])
def test_johnson_on_the_lognormal_line(W, sign):
    skew = sign * math.sqrt(W - 1) * (W + 2)
    line = W**4 + 2 * W**3 + 3 * W**2 - 3
    law = tb.heights.JohnsonHeights(skewness=skew, kurtosis=line)
    assert law.family == "SL"
    moments = integral(law, range(5))
    assert_allclose(moments, [1, 0, 1, skew, line], rtol=1e-9, atol=1e-11)
    q = np.array([0.01, 0.5, 0.9])
    assert_allclose([integral(law, range(1), top)[0] for top in law.ppf(q)], q, rtol=1e-9)
    assert tb.heights.JohnsonHeights(skewness=skew, kurtosis=1.05 * line).family == "SU"
    assert tb.heights.JohnsonHeights(skewness=skew, kurtosis=0.97 * line).family == "SB"


@pytest.mark.parametrize(("skew", "kurtosis"), [(-1.8, 8.6), (-2.15, 11.35), (-2.475, 15.1)])
def test_skewness_of_either_sign(skew, kurtosis):
    right = tb.heights.JohnsonHeights(skewness=-skew, kurtosis=kurtosis)
    left = tb.heights.JohnsonHeights(skewness=skew, kurtosis=kurtosis)
    z = np.linspace(-3, 3, 7)
    assert_allclose(left.pdf(-z), right.pdf(z), rtol=1e-6, atol=1e-9)


@given(skew=st.floats(-1.5, 1.5), above=st.floats(0.4, 5.0))
def test_any_feasible_johnson(skew, above):
    """Moments as asked; mirrored heights for the opposite skewness."""
    assume(abs(skew) > 1e-3)
    kurtosis = skew**2 + 1 + above
    law = tb.heights.JohnsonHeights(skewness=skew, kurtosis=kurtosis)
    moments = integral(law, range(5))
    assert_allclose(moments[:3], [1, 0, 1], atol=1e-10)
    assert_allclose(moments[3:], [skew, kurtosis], rtol=1e-6, atol=1e-6)
    other = tb.heights.JohnsonHeights(skewness=-skew, kurtosis=kurtosis)
    z = np.array([-1.7, -0.4, 0.6, 2.1])
    assert_allclose(other.pdf(-z), law.pdf(z), rtol=1e-5, atol=1e-8)


def test_gaussian_is_a_johnson():
    z = np.linspace(-4, 4, 9)
    assert tb.heights.JohnsonHeights(skewness=0, kurtosis=3).family == "SN"
    assert_allclose(
        tb.heights.JohnsonHeights().pdf(z), tb.heights.GaussianHeights().pdf(z), rtol=1e-14
    )
    near = tb.heights.JohnsonHeights(skewness=0.0, kurtosis=3.0001)
    assert_allclose(near.pdf(z), tb.heights.GaussianHeights().pdf(z), rtol=1e-3)


@pytest.mark.parametrize(
    ("skew", "kurtosis"), [(0.0, 1.0), (0.0, 0.0), (1.0, 2.0), (-1.0, 1.5), (2.0, 4.9), (0.0, -1.0)]
)
def test_impossible_kurtosis_is_refused(skew, kurtosis):
    """κ ≥ Sk² + 1 for any distribution; 0 is the excess of a Gaussian, a likely slip."""
    with pytest.raises(tb.errors.InvalidValue, match="kurtosis"):
        tb.heights.JohnsonHeights(skewness=skew, kurtosis=kurtosis)


EDGE = np.random.default_rng(20).random((24, 3)).tolist()


@pytest.mark.check
@pytest.mark.spread(4)
@pytest.mark.parametrize("at", EDGE, ids=lambda at: f"{at[0]:.3f}-{at[1]:.3f}")
def test_edge_of_the_feasible_region(at):
    """At the edge κ = Sk² + 1 a fit is either refused in words or has the moments asked for."""
    skew = (1 if at[2] < 0.5 else -1) * 10 ** (4 * at[0] - 2)
    kurtosis = skew**2 + 1 + 10 ** (8 * at[1] - 7)
    try:
        law = tb.heights.JohnsonHeights(skewness=skew, kurtosis=kurtosis)
    except tb.errors.InvalidValue as error:
        (problem,) = error.problems
        assert "kurtosis" in problem
        assert problem.code is Mistake.BEYOND or kurtosis <= skew**2 + 1
    else:
        moments = integral(law, range(5))
        assert_allclose(moments[:3], [1, 0, 1], atol=1e-7)
        assert_allclose(moments[3:], [skew, kurtosis], rtol=1e-7, atol=1e-7)


@pytest.mark.spread(3)
@pytest.mark.parametrize(
    ("skew", "kurtosis"),
    [
        # sums once lost 60 % of these without a word
        (2.0, 5.1),
        (0.0, 1.03),
        (-10.0, 101.4),
        # once ZeroDivisionError, as rounding fell
        (2.0, 5.0001),
        (2.0, 5.001),
        (0.5, 1.250001),
        (0.0, math.nextafter(1.0, 2.0)),
        # once OverflowError
        (0.5, 1e5),
        (1e100, 1e201),
        (1e160, 1e308),
    ],
)
def test_too_extreme_is_refused_when_built(skew, kurtosis):
    code, place = (Mistake.BEYOND, "") if kurtosis < 1e40 else (Mistake.RANGE, ".kurtosis")
    with refuses(code, "JohnsonHeights" + place, says=f"{kurtosis:g}"):
        tb.heights.JohnsonHeights(skewness=skew, kurtosis=kurtosis)


@pytest.mark.parametrize(
    ("skew", "kurtosis"), [(0.0, 1.2), (-1.5, 3.65), (2.0, 5.6), (0.5, 1e4), (4.0, 20.0)]
)
def test_near_the_edge_fractions_are_right(skew, kurtosis):
    """Pile-ups at the ends, and a heavy tail, are summed to what the quantiles say."""
    law = tb.heights.JohnsonHeights(skewness=skew, kurtosis=kurtosis)
    q = np.array([0.01, 0.3, 0.5, 0.9])
    assert_allclose(law.sf(law.ppf(q)), 1 - q, rtol=1e-6)


def test_kurtosis_is_not_the_excess():
    from scipy import stats

    sample = stats.norm.ppf((np.arange(20_000) + 0.5) / 20_000)
    excess = float(stats.kurtosis(sample))
    assert excess == pytest.approx(0, abs=0.01)
    assert tb.heights.JohnsonHeights(kurtosis=excess + 3).family in ("SN", "SB", "SU")


# -------------------------------------------------------------------------------- Weibull
def test_weibull_anchors():
    z = np.linspace(-0.99, 8, 40)
    one = tb.heights.WeibullHeights(shape=1.0)
    assert_allclose(one.pdf(z), tb.heights.ExponentialHeights().pdf(z), rtol=1e-13)
    law = tb.heights.WeibullHeights(shape=1.8)
    assert_allclose(law.lowest, -1.7395151310437456, rtol=1e-14)
    assert law.pdf(law.lowest - 1e-9) == 0
    no_skew = tb.heights.WeibullHeights(shape=3.6023494257197)
    _, _, _, skew, kurtosis = integral(no_skew, range(5))
    assert abs(skew) < 1e-9
    assert kurtosis == pytest.approx(2.72, abs=0.005)  # not a Gaussian's 3


def test_weibull_moments_by_gamma_functions():
    for shape in (1.3, 1.8, 3.6, 20.0):
        g = [math.gamma(1 + j / shape) for j in range(5)]
        var = g[2] - g[1] ** 2
        skew = (g[3] - 3 * g[1] * g[2] + 2 * g[1] ** 3) / var**1.5
        kurt = (g[4] - 4 * g[1] * g[3] + 6 * g[1] ** 2 * g[2] - 3 * g[1] ** 4) / var**2
        got = integral(tb.heights.WeibullHeights(shape=shape), range(5))
        assert_allclose(got[3:], [skew, kurt], rtol=3e-10, atol=1e-10)


@pytest.mark.parametrize("shape", [0.5, 0.0, -1.0, math.nan, 51.0])
def test_weibull_refuses(shape):
    with pytest.raises(tb.errors.InvalidValue, match="shape"):
        tb.heights.WeibullHeights(shape=shape)


# ------------------------------------------------------------------------------ histogram
def test_histogram_of_a_sample_comes_back():
    counts, edges = np.histogram(np.random.default_rng(3).standard_normal(4000), bins=25)
    law = tb.heights.HistogramHeights(edges=tuple(edges), counts=tuple(counts))
    assert_allclose(integral(law, range(3)), [1, 0, 1], atol=1e-12)
    # position and unit of the heights do not matter
    other = tb.heights.HistogramHeights(edges=tuple(1e-9 * edges + 5e-9), counts=tuple(3 * counts))
    z = np.array([-1.23, 0.04, 1.01])
    assert_allclose(other.pdf(z), law.pdf(z), rtol=1e-9)
    assert_allclose(other.ppf([0.2, 0.7]), law.ppf([0.2, 0.7]), rtol=1e-9)


def test_histogram_far_from_its_origin():
    """Heights above a far datum: their variance is no small difference of squares."""
    near = tb.heights.HistogramHeights(edges=(0, 1, 2, 4), counts=(1, 3, 2))
    for far in (2.0**27, 2.0**40):
        law = tb.heights.HistogramHeights(
            edges=tuple(far + x for x in near.edges), counts=near.counts
        )
        assert_allclose(law.pieces, near.pieces, rtol=1e-14)


def test_fine_histogram_tends_to_its_density():
    z = np.linspace(-6, 6, 241)
    cdf = 0.5 * (1 + np.array([math.erf(x / math.sqrt(2)) for x in z]))
    law = tb.heights.HistogramHeights(edges=tuple(z), counts=tuple(np.diff(cdf)))
    for h in (0.5, 1.5):
        fine, exact = (
            quadrature(tb.asperity.GW(), heights, h) for heights in (law, HEIGHTS["gaussian"])
        )
        assert_allclose(fine, exact, rtol=1e-3)


@pytest.mark.parametrize(
    "bad",
    [
        {"edges": (0, 1), "counts": (1, 2)},
        {"edges": (0, 1, 1), "counts": (1, 2)},
        {"edges": (0, 2, 1), "counts": (1, 2)},
        {"edges": (0, 1, math.inf), "counts": (1, 2)},
        {"edges": (0, 1, 2), "counts": (1, -2)},
        {"edges": (0, 1, 2), "counts": (0, 2)},
        {"edges": (0, 1, 2), "counts": (math.nan, 2)},
        {"edges": (0,), "counts": ()},
        {"edges": (-1e308, 0, 1e308), "counts": (1, 2)},
        {"edges": (0, 1, 2), "counts": (1e308, 1e308)},
    ],
)
def test_histogram_refuses(bad):
    with pytest.raises(tb.errors.InvalidValue, match="HistogramHeights"):
        tb.heights.HistogramHeights(**bad)


# ---------------------------------------------------------------------------- conventions
def test_origin_of_exponential_heights():
    """Zero mean: a text that starts its heights at zero differs by one σ_s, a factor e."""
    bare = contact(tb.asperity.GW(), HEIGHTS["exponential"])
    own, shifted = tb.solve(bare, d=np.array([1.0, 2.0]) * SIGMA_S).F_star
    assert own / shifted == pytest.approx(math.e, rel=1e-11)
    started_at_zero = 4 / 3 * math.gamma(2.5) * 0.05 * math.sqrt(0.01) * math.exp(-2.0)
    assert own == pytest.approx(started_at_zero, rel=1e-11)
    assert bare.E_ss == pytest.approx(E_STAR, rel=1e-15)


def test_one_lower_edge_below_which_all_touch():
    """Below the lowest summit the area of GW grows linearly."""
    bare = contact(tb.asperity.GW(), HEIGHTS["histogram"])
    lowest = HEIGHTS["histogram"].pieces[0]
    h = lowest - np.array([0.3, 0.2, 0.1])
    with pytest.warns(tb.errors.RangeWarning):
        A = tb.solve(bare, d=h * SIGMA_S).A_t
    assert_allclose(A, math.pi * 0.05 * -h, rtol=1e-11)


def area_at(pressure: float, pdf, highest: float) -> float:
    """Real area of S45C on itself under ZMC, by a sum of its own: σ = 100 nm, R = 2.8 µm."""
    pair = tb.MaterialPair(tb.materials["S45C"], tb.materials["S45C"])
    rough = tb.Roughness(sigma=100e-9, R=2.8e-6)
    case = {"R": rough.R, "E_star": pair.E_star, "H": pair.H}
    law, (x, weight) = tb.asperity.ZMC(), np.polynomial.legendre.leggauss(60)
    kinks = np.sqrt(np.array([1, 54]) * law.yield_interference(**case) / rough.sigma_s)

    def total(h: float, method) -> float:
        end = math.sqrt(min(highest - h, 14.0))
        marks = np.sort([*np.linspace(0, end, 9), *(k for k in kinks if k < end)])
        out = 0.0
        for a, b in zip(marks[:-1], marks[1:], strict=True):
            u = 0.5 * (a + b) + 0.5 * (b - a) * x
            values = method(u * u * rough.sigma_s, **case) * pdf(h + u * u)
            out += 0.5 * (b - a) * float(np.sum(weight * 2 * u * values))
        return rough.density * out

    h = brentq(lambda h: math.log(total(h, law.force) / pressure), -2, min(highest - 0.05, 8))
    return total(h, law.area)


def test_johnson_in_place_of_pearson():
    """The numbers of the page on laws: at equal moments the families hardly differ in area."""
    page = (Path(__file__).parents[2] / "docs" / "choose-a-law.md").read_text("utf-8")
    skew = -0.7
    pearson = stats.pearson3(skew)
    kurtosis = 3 + float(pearson.stats(moments="k"))
    assert kurtosis == pytest.approx(3.735, rel=1e-12)
    johnson = tb.heights.JohnsonHeights(skewness=skew, kurtosis=kurtosis)
    less = {}
    for pressure in (3e5, 3e6, 3e7):
        two = area_at(pressure, johnson.pdf, johnson.highest)
        less[pressure] = 100 * (1 - two / area_at(pressure, pearson.pdf, -2 / skew))
    assert f"{less[3e6]:.1f} % less area" in " ".join(page.split())
    assert f"({less[3e5]:.1f} % at 0.3 MPa, {less[3e7]:.1f} % at 30 MPa)" in page
    gauss = area_at(3e6, stats.norm.pdf, math.inf)
    worth = 100 * (area_at(3e6, pearson.pdf, -2 / skew) / gauss - 1)
    assert f"changes it by {worth:.0f} %" in " ".join(page.split())
    # and the library finds the same area
    steel = tb.materials["S45C"]
    bare = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6, heights=johnson),
    )
    state = tb.solve(bare, pressure=3e6)
    assert state.A_t == pytest.approx(area_at(3e6, johnson.pdf, johnson.highest), rel=1e-9)


@pytest.mark.parametrize("name", ["histogram-one", "histogram-gap", "johnson-SB-flat"])
@pytest.mark.parametrize("w", [1e-5, 1e-4, 1e-2])
def test_light_loads_on_the_last_asperities(name, w):
    """Of bounded heights, with a law that changes its formula close to their end."""
    heights = ALL[name]
    law = tb.asperity.CEB(K=0.6)
    total = DensitySum(law, heights, w)
    rise = np.geomspace(1e-6, 0.3, 40)
    h = total.highest - rise
    rise = total.highest - h  # h is rounded
    expected = np.zeros(len(h))
    for i, up in enumerate(rise):
        marks = np.unique(
            [0.0, *(y * w for y in (1e-3, 0.1, 1.0, 10.0)), *(up * np.arange(1, 17) / 16)]
        )
        marks = np.append(marks[marks < up], up)
        for a, b in zip(np.sqrt(marks[:-1]), np.sqrt(marks[1:]), strict=True):
            v = 0.5 * (a + b) + 0.5 * (b - a) * NODES
            density = heights.pdf(heights.highest - (up - v * v))
            load = law.reduced("force", v * v / w)
            expected[i] += np.sum(0.5 * (b - a) * WEIGHTS * 2 * v * load * density)
    # fifteen decades of load; of one that falls like rise^n, h is known to an ulp
    known = expected > 1e-15 * total.load(np.array([-3.0]))[0, 0]
    slack = 1e-11 + 20 * np.finfo(float).eps / rise
    assert known.sum() > 10
    error = np.abs(total.load(h)[:, 0] / expected - 1)
    assert np.all((error < slack)[known]), (error / slack)[known].max()
    assert np.all(total.fields(h) >= 0)


@pytest.mark.parametrize(("skewness", "kurtosis"), [(-2.0, 6.0), (-1.0, 2.6), (0.0, 1.5)])
def test_loads_on_heights_that_crowd_at_their_ends(skewness, kurtosis):
    """Hertz contacts on bounded Johnson heights, by the normal variable behind them."""
    heights = tb.heights.JohnsonHeights(skewness=skewness, kurtosis=kurtosis)
    gamma, delta, xi, lam = heights.parameters
    assert heights.family == "SB"
    law = tb.asperity.GW()
    total = DensitySum(law, heights, 1.0)
    h = np.linspace(-2.0, total.highest - 0.01, 25)
    expected = np.zeros(len(h))
    for i, low in enumerate(h):
        share = (low - xi) / lam
        first = -12.0 if share <= 0 else max(gamma + delta * math.log(share / (1 - share)), -12.0)
        # the load starts like a power 1.5 of the distance: the root is smooth
        edges = np.linspace(0, math.sqrt(12 - first), 400)
        v = 0.5 * (edges[1:] + edges[:-1])[:, None] + 0.5 * np.diff(edges)[:, None] * NODES
        n = first + v**2
        z = xi + lam / (1 + np.exp(-(n - gamma) / delta))
        load = law.reduced("force", np.maximum(z - low, 0.0)) * stats.norm.pdf(n)
        expected[i] = np.sum(0.5 * np.diff(edges)[:, None] * WEIGHTS * 2 * v * load)
    assert_allclose(total.load(h)[:, 0], expected, rtol=1e-9)
