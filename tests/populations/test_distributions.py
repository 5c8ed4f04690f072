"""Size distributions against their densities, integrated with 40 digits."""

import math
import sys
from functools import cache

import mpmath as mp
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from refusals import Mistake, refuses
from twins import decades

import thirdbody as tb

mp.mp.dps = 40
KINDS = ("gaussian", "lognormal", "weibull", "uniform", "histogram")


def density(dist: tb.distributions.Distribution, x: mp.mpf) -> mp.mpf:
    """φ_a inside the support, not normalised for a truncated Gaussian."""
    match dist:
        case tb.TruncatedGaussian():
            return mp.npdf(x, dist.mean, dist.std)
        case tb.LogNormal():
            s = mp.log(mp.mpf(dist.gsd))
            return mp.npdf(mp.log(x / dist.median), 0, s) / x
        case tb.distributions.Weibull():
            t, k = x / mp.mpf(dist.scale), mp.mpf(dist.shape)
            return k / dist.scale * t ** (k - 1) * mp.exp(-(t**k))
        case tb.distributions.Uniform():
            return 1 / (mp.mpf(dist.high) - dist.low)
    raise TypeError(dist)


@cache
def mass(dist: tb.distributions.Distribution) -> mp.mpf:
    if not isinstance(dist, tb.TruncatedGaussian):
        return mp.mpf(1)
    lo, hi = dist.support
    return mp.ncdf(hi, dist.mean, dist.std) - mp.ncdf(lo, dist.mean, dist.std)


def marks(dist: tb.distributions.Distribution) -> list[float]:
    """Places where the density has shoulders."""
    match dist:
        case tb.TruncatedGaussian():
            return [dist.mean + j * dist.std for j in range(-8, 9)]
        case tb.LogNormal():
            return [dist.median * dist.gsd**j for j in np.arange(-8, 9 + 2 * dist.s)]
        case tb.distributions.Weibull():
            levels = (1e-16, 1e-12, 1e-9, 1e-6, 1e-4, 0.01, 0.1, 0.5, 1, 2, 4, 8, 16, 30)
            return [dist.scale * v ** (1 / dist.shape) for v in levels]
    return []


def exact_moment(dist: tb.distributions.Distribution, n: int, a: float, b: float) -> mp.mpf:
    """∫x^n φ_a between a and b, both cut to the support."""
    if isinstance(dist, tb.distributions.Histogram):
        total = sum(mp.mpf(c) for c in dist.counts)
        out = mp.mpf(0)
        for lo, hi, c in zip(dist.edges, dist.edges[1:], dist.counts, strict=False):
            p, q = mp.mpf(min(max(lo, a), hi)), mp.mpf(max(min(hi, b), lo))
            if q > p:
                power = (q ** (n + 1) - p ** (n + 1)) / (n + 1)
                out += c / total / (mp.mpf(hi) - lo) * power
        return out
    lo, hi = dist.support
    a, b = max(a, lo), min(b, hi)
    if b <= a:
        return mp.mpf(0)
    inner = sorted(x for x in marks(dist) if a < x < b)
    points = [mp.mpf(x) for x in (a, *inner, b)]
    # mpmath ends at an absolute error: let what it sums be near 1
    size = max((x**n * density(dist, x) for x in points), default=0) or mp.mpf(1)
    length = points[-1] - points[0]
    at = [(x - points[0]) / length for x in points]

    def part(t):
        x = points[0] + t * length
        return x**n * density(dist, x) / size

    return size * length * mp.quad(part, at) / mass(dist)


@st.composite
def distributions(draw, kinds=KINDS) -> tb.distributions.Distribution:
    kind = draw(st.sampled_from(kinds))
    size, width = draw(decades(1e-9, 1e-4)), draw(decades(1e-3, 1.0))
    if kind == "gaussian":
        n = draw(st.one_of(st.floats(0.3, 5.0), st.floats(5.0, 9.0)))
        return tb.TruncatedGaussian(mean=size, std=width * size, n=n)
    if kind == "lognormal":
        return tb.LogNormal(median=size, gsd=1 + width)
    if kind == "weibull":
        return tb.distributions.Weibull(scale=size, shape=draw(decades(0.6, 60)))
    if kind == "uniform":
        return tb.distributions.Uniform(low=size, high=size * (1 + width))
    counts = draw(st.lists(st.integers(0, 50), min_size=1, max_size=6).filter(lambda c: sum(c) > 0))
    steps = draw(st.lists(decades(0.01, 1), min_size=len(counts), max_size=len(counts)))
    start = draw(st.sampled_from((0.0, 0.3)))
    edges = size * (start + np.cumsum([0.0, *steps]))
    return tb.distributions.Histogram(edges=tuple(edges), counts=tuple(counts))


def inside(dist: tb.distributions.Distribution, share: float) -> float:
    lo, hi = dist.support
    return lo + share * (hi - lo)


shares = st.one_of(st.floats(0, 1), decades(1e-9, 0.5), decades(1e-9, 0.5).map(lambda q: 1 - q))


# ------------------------------------------------------------------------------ moments
@given(dist=distributions(), n=st.integers(0, 2), cuts=st.tuples(shares, shares))
def test_partial_moments(dist, n, cuts):
    a, b = sorted(inside(dist, q) for q in cuts)
    got, want = float(dist.partial_moment(n, a, b)), float(exact_moment(dist, n, a, b))
    # the far tail of an untruncated law is known to the digits of what lies beyond it
    beyond = max(float(exact_moment(dist, n, a, math.inf)), 0.0)
    rounding = 2e-15 if not isinstance(dist, tb.TruncatedGaussian) else 0.0
    assert got == pytest.approx(want, rel=1e-11, abs=rounding * beyond + 1e-300)


@given(
    width=decades(1e-3, 1),
    n_cut=st.floats(1, 6),
    n=st.integers(0, 2),
    reach=decades(1e-6, 1),
)
def test_last_particles_of_a_truncated_gaussian(width, n_cut, n, reach):
    """Just below x_max a difference of error functions keeps no digit; the result must."""
    dist = tb.TruncatedGaussian(mean=3e-7, std=width * 3e-7, n=n_cut)
    hi = dist.support[1]
    a = hi - reach * dist.std
    want = float(exact_moment(dist, n, a, hi))
    assert float(dist.partial_moment(n, a, 2 * hi)) == pytest.approx(want, rel=2e-12)


@pytest.mark.check
@given(dist=distributions(("gaussian", "weibull", "lognormal")), n=st.integers(3, 4))
def test_higher_moments(dist, n):
    if isinstance(dist, tb.LogNormal):
        # the support of a lognormal is cut for moments up to the second
        dist = tb.LogNormal(median=dist.median, gsd=min(dist.gsd, 1.3))
    lo, hi = dist.support
    assert dist.moment(n) == pytest.approx(float(exact_moment(dist, n, lo, hi)), rel=1e-9)


@given(dist=distributions(), cuts=st.tuples(shares, shares, shares), n=st.integers(0, 2))
def test_moments_add_up(dist, cuts, n):
    a, b, c = sorted(inside(dist, q) for q in cuts)
    parts = dist.partial_moment(n, a, b) + dist.partial_moment(n, b, c)
    assert float(parts) == pytest.approx(
        float(dist.partial_moment(n, a, c)), rel=1e-11, abs=1e-14 * dist.moment(n)
    )


@given(dist=distributions())
def test_limits_outside_the_support(dist):
    lo, hi = dist.support
    assert dist.partial_moment(0, lo - 1, hi + 1) == pytest.approx(1, abs=1e-13)
    assert dist.partial_moment(1, hi, hi + 1) == 0
    assert dist.partial_moment(2, hi + 1, lo) == 0
    assert dist.partial_moment(2, -1, lo) == 0
    assert lo <= dist.mean_diameter <= hi


@given(dist=distributions(), n=st.integers(0, 2))
def test_moments_of_arrays(dist, n):
    a = np.array([[inside(dist, q) for q in (0, 0.2, 0.7)]] * 2)
    b = np.array([[inside(dist, 0.5)], [inside(dist, 1.0)]])
    together = dist.partial_moment(n, a, b)
    assert together.shape == (2, 3)
    one_by_one = [
        [float(dist.partial_moment(n, u, v)) for u in row]
        for row, v in zip(a, b[:, 0], strict=True)
    ]
    np.testing.assert_allclose(together, one_by_one, rtol=1e-13, atol=0)


def test_known_means():
    assert tb.LogNormal(median=1e-6, gsd=math.e).mean_diameter == pytest.approx(
        1e-6 * math.exp(0.5), rel=1e-12
    )
    assert tb.distributions.Weibull(scale=1e-6, shape=2).moment(2) == pytest.approx(
        1e-12, rel=1e-12
    )
    assert tb.distributions.Uniform(low=1.0, high=3.0).moment(2) == pytest.approx(13 / 3, rel=1e-13)
    assert tb.TruncatedGaussian(mean=1.0, std=0.1, n=8.4).moment(2) == pytest.approx(
        1.01, rel=1e-13
    )


# ------------------------------------------------------------------- density and quantiles
@given(dist=distributions(("gaussian", "lognormal", "weibull", "uniform")), share=shares)
def test_density(dist, share):
    x = inside(dist, share)
    if x == 0:
        return
    want = float(density(dist, mp.mpf(x)) / mass(dist))
    assert float(dist.pdf(x)) == pytest.approx(want, rel=1e-10)
    lo, hi = dist.support
    assert dist.pdf(lo - 0.01 * hi) == dist.pdf(1.01 * hi) == 0


@given(dist=distributions())
def test_density_integrates_to_one(dist):
    """With Gauss panels between `pieces`, as the library integrates over sizes."""
    nodes, weights = np.polynomial.legendre.leggauss(24)
    edges = np.array(dist.pieces)
    assert np.all(np.diff(edges) > 0)
    assert (edges[0], edges[-1]) == dist.support
    half = 0.5 * np.diff(edges)[:, None]
    x = 0.5 * (edges[1:] + edges[:-1])[:, None] + half * nodes
    assert np.sum(half * weights * dist.pdf(x)) == pytest.approx(1, abs=2e-7)
    second = np.sum(half * weights * x**2 * dist.pdf(x))
    assert second == pytest.approx(dist.moment(2), rel=1e-9)


@given(dist=distributions(), q=st.floats(1e-9, 1 - 1e-9))
def test_quantiles_invert_the_mass(dist, q):
    x = float(dist.ppf(q))
    lo, hi = dist.support
    assert lo <= x <= hi
    # one rounding of x moves the mass by pdf·x·eps; a bin without particles moves it not at all
    slack = 1e-12 + 1e-15 * hi * float(np.nan_to_num(dist.pdf(x)))
    assert float(dist.partial_moment(0, lo - 1, x)) == pytest.approx(q, abs=slack)


@example(dist=tb.TruncatedGaussian(mean=3.0, std=1.0, n=8.0), q=(0.0, 1.0))
@given(dist=distributions(), q=st.tuples(st.floats(0, 1), st.floats(0, 1)))
def test_quantiles_increase(dist, q):
    low, high = dist.ppf(np.sort(q))
    assert low <= high
    assert tuple(float(v) for v in dist.ppf([0.0, 1.0])) == pytest.approx(dist.support, rel=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_samples_follow_the_law(kind):
    dist = {
        "gaussian": tb.TruncatedGaussian(mean=3.0, std=1.0, n=2.0),
        "lognormal": tb.LogNormal(median=3.0, gsd=1.4),
        "weibull": tb.distributions.Weibull(scale=3.0, shape=1.5),
        "uniform": tb.distributions.Uniform(low=1.0, high=2.0),
        "histogram": tb.distributions.Histogram(edges=(0.0, 1.0, 4.0), counts=(3, 1)),
    }[kind]
    x = dist.sample(np.random.default_rng(7), 200_000)
    for n in (1, 2):
        spread = np.std(x**n) / math.sqrt(x.size)
        assert abs(np.mean(x**n) - dist.moment(n)) < 4.5 * spread


# -------------------------------------------------------------------------- whole objects
@given(dist=distributions(), factor=decades(1e-3, 1e3), n=st.integers(0, 2), cut=shares)
def test_change_of_unit(dist, factor, n, cut):
    big = dist.scaled(factor)
    assert type(big) is type(dist)
    a = inside(dist, cut)
    want = factor**n * float(dist.partial_moment(n, a, math.inf))
    assert float(big.partial_moment(n, factor * a, math.inf)) == pytest.approx(
        want, rel=1e-6, abs=1e-12 * big.moment(n)
    )
    assert big.support == pytest.approx(tuple(factor * x for x in dist.support), rel=1e-12)


@given(dist=distributions())
def test_json_round_trip(dist):
    import json

    again = tb.distributions.Distribution.from_dict(json.loads(json.dumps(dist.to_dict())))
    assert again == dist
    assert hash(again) == hash(dist)


def test_a_distribution_is_frozen_and_has_replace():
    dist = tb.TruncatedGaussian(mean=3e-7, std=3e-8)
    with pytest.raises(AttributeError):
        dist.mean = 1.0
    assert dist.replace(std=6e-8) == tb.TruncatedGaussian(mean=3e-7, std=6e-8)
    assert dist != dist.replace(n=2)


# ------------------------------------------------------------------------------- mixtures
PARTS = (
    tb.TruncatedGaussian(mean=1e-7, std=1e-8),
    tb.distributions.Monodisperse(mean=2.5e-7),
    tb.distributions.Histogram(edges=(2e-7, 3e-7), counts=(1,)),
)


@given(
    weights=st.tuples(*[decades(1e-3, 1e3)] * 3),
    n=st.integers(0, 2),
    cuts=st.tuples(st.floats(0, 4e-7), st.floats(0, 4e-7)),
)
def test_mixture_is_the_weighted_sum(weights, n, cuts):
    both = tb.distributions.Mixture(parts=PARTS, weights=weights)
    want = sum(
        w / sum(weights) * float(part.partial_moment(n, *cuts))
        for w, part in zip(weights, PARTS, strict=True)
    )
    assert float(both.partial_moment(n, *cuts)) == pytest.approx(want, rel=1e-12, abs=1e-300)
    assert both.support == (pytest.approx(7e-8), 3e-7)


def test_mixture_of_mixtures():
    inner = tb.distributions.Mixture(parts=PARTS[:2], weights=(1, 3))
    outer = tb.distributions.Mixture(parts=(inner, PARTS[2]), weights=(1, 1))
    flat = tb.distributions.Mixture(parts=PARTS, weights=(1, 3, 4))
    for n in range(3):
        assert outer.moment(n) == pytest.approx(flat.moment(n), rel=1e-14)
    assert [w for w, _ in outer.components] == pytest.approx([1 / 8, 3 / 8, 1 / 2])
    assert tb.distributions.Distribution.from_dict(outer.to_dict()) == outer
    assert outer.scaled(2).moment(2) == pytest.approx(4 * outer.moment(2), rel=1e-12)


def test_mixture_quantiles():
    both = tb.distributions.Mixture(parts=PARTS, weights=(1, 1, 1))
    for q in (0.01, 0.2, 1 / 3 - 1e-6, 0.4, 0.9, 0.999):
        x = float(both.ppf(q))
        below, at = (float(both.partial_moment(0, 0, y)) for y in (x * (1 - 1e-9), x * (1 + 1e-9)))
        assert below - 1e-6 <= q <= at + 1e-6


def test_one_size():
    one = tb.distributions.Monodisperse(mean=2e-7)
    assert one.support == (2e-7, 2e-7)
    assert one.moment(3) == pytest.approx(8e-21)
    assert one.partial_moment(1, 0, 1.9e-7) == 0
    assert one.partial_moment(1, 2.1e-7, 1) == 0
    assert one.partial_moment(1, 1.9e-7, 1) == 2e-7
    assert one.scaled(3).mean == pytest.approx(6e-7)
    assert np.all(one.ppf([0.1, 0.9]) == 2e-7)


@given(width=decades(1e-6, 1e-3))
def test_narrow_gaussian_becomes_one_size(width):
    narrow = tb.TruncatedGaussian(mean=2e-7, std=2e-7 * width)
    for n in (1, 2):
        assert narrow.moment(n) == pytest.approx(2e-7**n, rel=2 * width)


def test_histogram_with_empty_ends_and_gaps():
    sizes = tb.distributions.Histogram(edges=(0.0, 1.0, 2.0, 3.0, 4.0), counts=(0, 1, 0, 3))
    assert sizes.support[1] == 4.0
    assert sizes.partial_moment(0, 2.0, 3.0) == 0
    assert sizes.moment(1) == pytest.approx(0.25 * 1.5 + 0.75 * 3.5)
    assert float(sizes.ppf(0.25 - 1e-9)) == pytest.approx(2.0)
    assert float(sizes.ppf(0.25 + 1e-9)) == pytest.approx(3.0)


@given(mean=decades(1e-8, 1e-5), width=decades(0.01, 1), n=st.floats(0.2, 7))
def test_retained_mass(mean, width, n):
    dist = tb.TruncatedGaussian(mean=mean, std=width * mean, n=n)
    lo = max(-1 / width, -n)
    want = 0.5 * (math.erf(n / math.sqrt(2)) - math.erf(lo / math.sqrt(2)))
    assert dist.retained_mass == pytest.approx(want, rel=1e-12)


def test_supports():
    """Where each law begins and ends, and what a cut tail may hold."""
    assert tb.TruncatedGaussian(mean=3.0, std=0.5, n=2).support == pytest.approx((2, 4))
    assert tb.TruncatedGaussian(mean=1.0, std=0.5, n=4).support == pytest.approx((0, 3))
    assert tb.distributions.Uniform(low=1.0, high=2.0).support == (1.0, 2.0)
    assert tb.distributions.Histogram(edges=(1.0, 2.0, 4.0), counts=(1, 1)).support == (1.0, 4.0)
    lo, hi = tb.LogNormal(median=1.0, gsd=2.0).support
    for z in (-math.log(lo) / math.log(2), math.log(hi) / math.log(2)):
        assert 0.5 * math.erfc(z / math.sqrt(2)) < 1e-16
    lo, hi = tb.distributions.Weibull(scale=1.0, shape=2.0).support
    assert lo == 0
    assert math.exp(-(hi**2)) < 1e-16


# ---------------------------------------------------------------------------- bad inputs
@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: tb.distributions.Monodisperse(mean=0.0), ["Monodisperse.mean = 0.0", "> 0 [m]"]),
        (
            lambda: tb.distributions.Monodisperse(mean="300 nm"),
            ["must be a number in SI units [m]"],
        ),
        (lambda: tb.distributions.Monodisperse(mean=math.nan), ["> 0 [m]"]),
        (
            lambda: tb.TruncatedGaussian(mean=-1e-7, std=1e-8),
            ["TruncatedGaussian.mean", "leave out the minus sign"],
        ),
        (lambda: tb.TruncatedGaussian(mean=1e-7, std=0), ["std", "Monodisperse"]),
        (lambda: tb.TruncatedGaussian(mean=1e-7, std=1e-8, n=0), ["TruncatedGaussian.n"]),
        (lambda: tb.TruncatedGaussian(mean=math.inf, std=1e-8), ["mean = inf"]),
        (lambda: tb.LogNormal(median=1e-7, gsd=1.0), ["gsd = 1.0", "> 1"]),
        (lambda: tb.LogNormal(median=1e-7, gsd=50), ["gsd", "<= 20"]),
        (lambda: tb.LogNormal(median=0, gsd=2), ["median"]),
        (lambda: tb.distributions.Weibull(scale=-1, shape=2), ["scale = -1"]),
        (lambda: tb.distributions.Weibull(scale=1e-7, shape=0.1), ["shape = 0.1", ">= 0.5"]),
        (lambda: tb.distributions.Uniform(low=2.0, high=1.0), ["high"]),
        (lambda: tb.distributions.Uniform(low=-1.0, high=1.0), ["low"]),
        (lambda: tb.distributions.Histogram(edges=(0, 1), counts=(1, 2)), ["2 edges", "2 counts"]),
        (lambda: tb.distributions.Histogram(edges=(0, 2, 1), counts=(1, 2)), ["increase"]),
        (lambda: tb.distributions.Histogram(edges=(-1, 2), counts=(1,)), ["at or above 0"]),
        (lambda: tb.distributions.Histogram(edges=(0, 1), counts=(0,)), ["at least one above 0"]),
        (lambda: tb.distributions.Histogram(edges=(0, 1), counts=(-1,)), [">= 0"]),
        (lambda: tb.distributions.Histogram(edges=(0, math.nan), counts=(1,)), ["finite"]),
        (lambda: tb.distributions.Histogram(edges="ab", counts=(1,)), ["sequence of numbers"]),
        (lambda: tb.distributions.Mixture(parts=(), weights=()), ["0 parts"]),
        (lambda: tb.distributions.Mixture(parts=PARTS, weights=(1, 2)), ["3 parts and 2 weights"]),
        (lambda: tb.distributions.Mixture(parts=PARTS, weights=(1, 2, 0)), ["must all be > 0"]),
        (lambda: tb.distributions.Mixture(parts=(1.0,), weights=(1,)), ["size distributions"]),
    ],
)
def test_mistakes_are_named(make, words):
    with pytest.raises(tb.errors.InvalidValue) as caught:
        make()
    for word in words:
        assert word in str(caught.value)
    assert caught.value.problems


def test_all_mistakes_at_once():
    with pytest.raises(tb.errors.InvalidValue) as caught:
        tb.TruncatedGaussian(mean=-1, std=-1, n=-1)
    assert len(caught.value.problems) == 3


@pytest.mark.spread(7)
@pytest.mark.parametrize(
    "dist",
    [
        tb.LogNormal(median=1e-6, gsd=1.003),
        tb.LogNormal(median=1e-6, gsd=3.4),
        tb.distributions.Weibull(scale=1e-6, shape=0.5),
        tb.distributions.Weibull(scale=1e-6, shape=15.0),
    ],
    ids=str,
)
@pytest.mark.parametrize("q", [1e-9, 0.01, 0.5, 0.99, 1 - 1e-9])
@pytest.mark.parametrize("stretch", [1e-12, 1e-6, 1e-3, 0.05, 0.3])
def test_moments_over_a_short_stretch_keep_their_digits(dist, q, stretch):
    a = float(dist.ppf(q))
    b = a * (1 + stretch)
    for n in range(4):
        want = float(exact_moment(dist, n, a, b))
        # the density of a size that is known to rounding
        step = 1e-6 * a
        steep = abs(math.log(float(dist.pdf(a + step) / dist.pdf(a - step))) / 2e-6)
        rounding = 2e-14 + 0.5 * sys.float_info.epsilon * steep
        assert float(dist.partial_moment(n, a, b)) == pytest.approx(want, rel=rounding)


def test_sizes_that_numbers_cannot_tell_apart_are_one_size():
    with refuses(Mistake.RANGE, "TruncatedGaussian.std", value="5e-28"):
        tb.TruncatedGaussian(mean=4e-7, std=5e-28)
    sizes = tb.TruncatedGaussian(mean=4e-7, std=4e-16)
    assert sizes.support[0] <= sizes.mean_diameter <= sizes.support[1]
