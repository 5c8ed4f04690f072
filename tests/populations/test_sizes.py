"""Measured sizes: weightings against quadrature and chance, fits, and files good and bad."""

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from refusals import Mistake, refuses
from scipy.integrate import quad
from twins import decades

import thirdbody as tb
from thirdbody.populations.distributions import PowerLaw
from thirdbody.populations.measured.sizes import (
    FITS,
    WEIGHTINGS,
    MeasuredSizes,
    by_number,
    read_sizes,
)


# ------------------------------------------------------------------------------ power laws
@st.composite
def power_laws(draw):
    counts = draw(st.lists(st.integers(0, 50), min_size=1, max_size=5).filter(any))
    many = {"min_size": len(counts), "max_size": len(counts)}
    ratios = draw(st.lists(st.floats(1.01, 4), **many))
    slopes = draw(st.lists(st.sampled_from([-1.0, 0.0, 1.0, 2.0, 3.0, -2.5, 3.34, 12.0]), **many))
    edges = draw(decades(1e-8, 1e-4)) * np.cumprod([1.0, *ratios])
    return PowerLaw(edges=tuple(edges), counts=tuple(counts), slopes=tuple(slopes))


def exact_moment(sizes, n, a, b):
    """∫x^n φ_a by the antiderivative, with 40 digits."""
    out = mp.mpf(0)
    with mp.workdps(40):
        sections = zip(sizes.edges, sizes.edges[1:], sizes.counts, sizes.slopes, strict=False)
        for lo, hi, count, s in sections:
            p, q = max(lo, a), min(hi, b)
            if q > p:
                part, whole = (
                    mp.log(mp.mpf(v) / u)
                    if k == s
                    else (mp.mpf(v) ** (k - s) - mp.mpf(u) ** (k - s)) / (mp.mpf(k) - mp.mpf(s))
                    for u, v, k in ((p, q, n), (lo, hi, 0))
                )
                out += mp.mpf(count) / mp.mpf(sum(sizes.counts)) * part / whole
    return float(out)


@settings(deadline=None)
@given(sizes=power_laws(), n=st.integers(0, 3), cuts=st.tuples(st.floats(0, 1), st.floats(0, 1)))
def test_power_law_moments(sizes, n, cuts):
    lo, hi = sizes.support
    a, b = sorted(lo + q * (hi - lo) for q in cuts)
    assert float(sizes.partial_moment(n, a, b)) == pytest.approx(
        exact_moment(sizes, n, a, b), rel=1e-12, abs=1e-14 * hi**n
    )


@settings(deadline=None)
@given(sizes=power_laws(), q=st.floats(0, 1))
def test_power_law_quantiles(sizes, q):
    lo, hi = sizes.support
    x = float(sizes.ppf(q))
    assert lo <= x <= hi
    assert float(sizes.partial_moment(0, lo / 2, x)) == pytest.approx(q, abs=1e-12)


@settings(deadline=None)
@given(sizes=power_laws())
def test_power_law_density_belongs_to_its_counts(sizes):
    edges = np.array(sizes.pieces)
    nodes, weights = np.polynomial.legendre.leggauss(16)
    half = 0.5 * np.diff(edges)[:, None]
    x = 0.5 * (edges[1:] + edges[:-1])[:, None] + half * nodes
    shares = np.sum(half * weights * sizes.pdf(x), axis=1)
    want = sizes.partial_moment(0, edges[:-1], edges[1:])
    np.testing.assert_allclose(shares, want, rtol=1e-9, atol=1e-12)


@settings(deadline=None)
@given(sizes=power_laws())
def test_power_law_survives_json_and_change_of_units(sizes):
    assert tb.distributions.Distribution.from_dict(sizes.to_dict()) == sizes
    scale, shape = sizes.standardised()
    assert scale * shape.mean_diameter == pytest.approx(sizes.mean_diameter, rel=1e-12)
    assert sizes.scaled(3.0).moment(2) == pytest.approx(9 * sizes.moment(2), rel=1e-12)


def test_power_law_of_slope_minus_one_is_a_histogram(reference_contact):
    edges, counts = (2e-7, 3e-7, 5e-7), (3, 1)
    flat = PowerLaw(edges=edges, counts=counts, slopes=(-1, -1))
    bins = tb.distributions.Histogram(edges=edges, counts=counts)
    one, other = (
        tb.solve(reference_contact.replace(**{"particles.diameter": sizes}), pressure=5e6)
        for sizes in (flat, bins)
    )
    assert one.d == pytest.approx(other.d, rel=1e-9)
    assert one.particle_load_share == pytest.approx(other.particle_load_share, rel=1e-9)


@pytest.mark.parametrize(
    ("given", "refusal"),
    [
        (dict(edges=(0, 1), counts=(1,), slopes=(3,)), refuses(Mistake.ORDER, "PowerLaw.edges")),
        (dict(edges=(1, 2), counts=(1, 2), slopes=(3,)), refuses(Mistake.SHAPE, "PowerLaw")),
        (dict(edges=(1, 2), counts=(0,), slopes=(3,)), refuses(Mistake.RANGE, "PowerLaw.counts")),
        (
            dict(edges=(1, 2), counts=(1,), slopes=(float("nan"),)),
            refuses(Mistake.KIND, "PowerLaw.edges,"),
        ),
        (
            dict(edges=(1, 2), counts=(1,), slopes=(1e4,)),
            refuses(Mistake.BEYOND, "PowerLaw.slopes"),
        ),
        (
            dict(edges="ab", counts=(1,), slopes=(1,)),
            refuses(Mistake.KIND, "PowerLaw.edges", value="'ab'"),
        ),
    ],
)
def test_power_law_refuses(given, refusal):
    with refusal:
        PowerLaw(**given)


@pytest.fixture
def reference_contact():
    steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    return tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(
            material=silica, diameter=tb.distributions.Monodisperse(mean=3e-7), areal_density=1e11
        ),
        particle_law=tb.particle.Series(deep="off"),
    )


# ------------------------------------------------------------------------------ weightings
SHAPES = {
    "gaussian": tb.TruncatedGaussian(mean=3e-6, std=0.5e-6),
    "weibull": tb.distributions.Weibull(scale=5e-6, shape=4.5),
    "rosin-rammler": tb.distributions.Weibull(scale=5e-6, shape=1.2),
    "log-normal": tb.LogNormal(median=2e-6, gsd=1.8),
    "uniform": tb.distributions.Uniform(low=1e-6, high=4e-6),
    "histogram": tb.distributions.Histogram(edges=(1e-6, 2e-6, 3e-6, 7e-6), counts=(2, 0, 5)),
    "power law": PowerLaw(edges=(1e-6, 2e-6, 7e-6), counts=(2, 5), slopes=(0.5, 3)),
}


@pytest.mark.spread(5)
@pytest.mark.parametrize("weighting", WEIGHTINGS)
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("smallest", [None, 1.5e-6])
def test_conversion_against_adaptive_quadrature(shape, weighting, smallest):
    sizes = SHAPES[shape]
    if smallest is None and weighting != "number" and sizes.support[0] == 0:
        with refuses(Mistake.MISSING, "", says="smallest"):
            by_number(sizes, weighting)
        return
    power = WEIGHTINGS[weighting]
    found = by_number(sizes, weighting, smallest=smallest)
    lo, hi = sizes.support
    hi = min(hi, float(sizes.ppf(1 - 1e-13)))
    lo = max(lo, float(sizes.ppf(1e-13)), smallest or 0.0)
    marks = np.unique([*np.geomspace(lo, hi, 40), *(x for x in sizes.kinks if lo < x < hi)])

    def integral(n):
        def f(x):
            return (1e6 * x) ** (n - power) * float(sizes.pdf(x)) * 1e-6

        return sum(
            quad(f, a, b, epsrel=1e-11, epsabs=0)[0] for a, b in zip(marks, marks[1:], strict=False)
        )

    for n in range(1, 4):
        want = integral(n) / integral(0)
        assert found.moment(n) * 1e6**n == pytest.approx(want, rel=3e-5)


def test_exact_conversions_are_exact():
    for shape in ("uniform", "histogram", "power law"):
        found = by_number(SHAPES[shape], "volume")
        for x in (1.2e-6, 2.5e-6, 3.4e-6):
            volume = found.partial_moment(3, 0, x) / found.moment(3)
            assert volume == pytest.approx(SHAPES[shape].partial_moment(0, 0, x), rel=1e-12)


def test_hatch_and_choate():
    by_volume = tb.LogNormal(median=10e-6, gsd=2.0)
    number = by_number(by_volume, "volume")
    for x in (3e-6, 10e-6, 40e-6):
        volume = number.partial_moment(3, 0, x) / number.moment(3)
        assert volume == pytest.approx(float(by_volume.partial_moment(0, 0, x)), rel=1e-9)


def test_weighed_particles_give_back_their_number():
    """A million particles, weighed bin by bin as an analyser would."""
    rng = np.random.default_rng(4)
    true = tb.LogNormal(median=2e-6, gsd=1.4)
    x = true.sample(rng, 1_000_000)
    edges = np.geomspace(x.min() * 0.999, x.max() * 1.001, 60)
    for weighting, power in WEIGHTINGS.items():
        amounts, _ = np.histogram(x, edges, weights=x**power)
        data = MeasuredSizes(
            sizes=tb.distributions.Histogram(edges=tuple(edges), counts=tuple(amounts)),
            weighting=weighting,
        )
        assert data.by_number().mean_diameter == pytest.approx(x.mean(), rel=2e-3)
        assert data.by_number().moment(3) == pytest.approx(np.mean(x**3), rel=1e-2)


def test_mixture_by_volume_splits_the_volume():
    both = tb.distributions.Mixture(
        parts=(tb.distributions.Monodisperse(mean=1e-6), tb.LogNormal(median=3e-6, gsd=1.2)),
        weights=(1, 3),
    )
    number = by_number(both, "volume")
    small = number.partial_moment(3, 0, 1.1e-6) / number.moment(3)
    assert small == pytest.approx(0.25, rel=1e-6)


@pytest.mark.parametrize("smallest", [0.0, -1.0, 1.0, float("nan")])
def test_smallest_must_be_a_size_inside(smallest):
    with refuses(Mistake.RANGE, "smallest"):
        by_number(SHAPES["rosin-rammler"], "volume", smallest=smallest)


def test_unknown_weighting():
    with refuses(Mistake.OPTION, "weighting", value='"mass"'):
        by_number(SHAPES["uniform"], "mass")


@pytest.mark.parametrize("shape", SHAPES)
def test_one_bound_for_many(shape):
    """Moments from one size to many, and from many to one."""
    sizes = SHAPES[shape]
    lo, hi = sizes.support
    x = np.linspace(lo, hi, 5)
    below, over = sizes.partial_moment(0, -1.0, x), sizes.partial_moment(0, x, 1.0)
    np.testing.assert_allclose(below + over, 1, rtol=1e-12)


# ------------------------------------------------------------------------------ fits
TRUE = {
    "log-normal": tb.LogNormal(median=3e-6, gsd=1.7),
    "rosin-rammler": tb.distributions.Weibull(scale=9e-6, shape=1.6),
    "truncated-gaussian": tb.TruncatedGaussian(mean=4e-6, std=1.1e-6),
}


def binned(sizes, count=25, weighting="volume"):
    lo, hi = (float(sizes.ppf(q)) for q in (1e-6, 1 - 1e-6))
    edges = np.linspace(lo, hi, count + 1)
    shares = sizes.partial_moment(0, edges[:-1], edges[1:])
    return MeasuredSizes(
        sizes=tb.distributions.Histogram(edges=tuple(edges), counts=tuple(shares)),
        weighting=weighting,
    )


@pytest.mark.parametrize("kind", FITS)
def test_fit_finds_what_was_binned(kind):
    fit = binned(TRUE[kind]).fits()[0]
    assert fit.kind == kind
    assert fit.worst < 3e-6
    assert fit.r_squared > 1 - 1e-10
    for name in ("median", "gsd", "scale", "shape", "mean", "std"):
        if hasattr(TRUE[kind], name):
            assert getattr(fit.distribution, name) == pytest.approx(
                getattr(TRUE[kind], name), rel=1e-4
            )


def test_goodness_is_that_of_the_fitted_curve():
    """Of the wrong kind: the misfit is computed again from the distribution, and it shows."""
    data = binned(TRUE["rosin-rammler"])
    for fit in data.fits():
        error = fit.distribution.partial_moment(0, -1, np.array(data.sizes.edges)) - data.cumulative
        assert fit.worst == pytest.approx(np.abs(error).max(), rel=1e-9)
        assert fit.rms == pytest.approx(np.sqrt(np.mean(error**2)), rel=1e-9)
    assert [fit.rms for fit in data.fits()] == sorted(fit.rms for fit in data.fits())
    assert data.fits()[-1].worst > 0.02


@pytest.mark.parametrize("kind", FITS)
def test_no_better_parameters_nearby(kind):
    data = binned(TRUE["log-normal"], count=8)
    fit = data.fit(kind)
    edges = np.array(data.sizes.edges)

    def squares(sizes):
        return np.sum((sizes.partial_moment(0, -1, edges) - data.cumulative) ** 2)

    best = squares(fit.distribution)
    names = {"log-normal": ("median", "gsd"), "rosin-rammler": ("scale", "shape")}
    for name in names.get(kind, ("mean", "std")):
        for factor in (0.98, 1.02):
            value = getattr(fit.distribution, name)
            assert squares(fit.distribution.replace(**{name: value * factor})) > best


def test_fit_by_number_begins_where_the_data_do():
    data = binned(TRUE["rosin-rammler"])
    number = data.fit("rosin-rammler").by_number()
    assert number.support[0] == pytest.approx(data.sizes.edges[0])
    assert isinstance(data.fit("log-normal").by_number(), tb.LogNormal)
    assert data.fit("rosin-rammler").by_number(1e-6).support[0] == 1e-6


def test_two_bins_are_no_test():
    data = MeasuredSizes(sizes=tb.distributions.Histogram(edges=(0, 1e-6, 2e-6), counts=(1, 1)))
    with refuses(Mistake.BEYOND, "", says="2 bins"):
        data.fit("log-normal")
    with refuses(Mistake.OPTION, "fit", value='"gauss"'):
        data.fit("gauss")


# ------------------------------------------------------------------------------ files
@pytest.fixture
def read(tmp_path):
    def read(text, **options):
        path = tmp_path / "sizes.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return read_sizes(path, **options)

    return read


BINS = "low [um],high [um],volume [%]\n1,2,40\n2,4,60\n"


@pytest.mark.parametrize(
    "text",
    [
        BINS,
        "\ufeff" + BINS,
        "# counted by hand\n\n" + BINS.replace("\n", "\r\n"),
        BINS.replace(",", ";"),
        BINS.replace(",", "\t"),
        "low [um];high [um];volume\n1,0;2,0;0,4\n2,0;4,0;0,6\n",
        "low (nm), high (nm), n\n1000, 2000, 40\n2000, 4000, 60\n",
        "size [um],below [%]\n1,0\n2,40\n4,100\n",
        "size [um],below\n1,0\n2,2\n4,5\n",
        BINS + ",,\n",
    ],
)
def test_good_files(read, text):
    sizes = read(text, weighting="volume").sizes
    np.testing.assert_allclose(sizes.edges, (1e-6, 2e-6, 4e-6), rtol=1e-14)
    assert sizes.counts[1] / sizes.counts[0] == pytest.approx(1.5)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "is empty; its first line must name the columns"),
        ("\n# only this\n,,\n", "is empty"),
        ("low [um],high [um],n\n", "has a first line but no sizes below it"),
        ("1,2,3\n2,4,5\n", 'line 1: column "1" has no unit; .* must be names, not numbers'),
        ("low,high,n\n1,2,3\n", 'column "low" has no unit; write it in brackets'),
        ("low [kg],high [kg],n\n1,2,3\n", 'column "low \\[kg\\]": "1 kg" is a mass, but a length'),
        ("low [um],high [nm],n\n1,2,3\n", "both sizes must have one unit"),
        ("low [um]\n1\n", "1 column where 2"),
        ("a,b,c,d\n1,2,3,4\n", "4 columns where 2"),
        (BINS + "4,8\n", "line 4: 2 values where the first line names 3 columns"),
        (BINS + "4,8,many\n", 'line 4: "many" is not a number'),
        (BINS + "4,,3\n", "line 4: a value is missing"),
        (BINS + "4,8,-1\n", "line 4: -1 must be finite and not negative"),
        (BINS + "4,8,nan\n", "line 4: nan must be finite"),
        (BINS + "4,inf,1\n", "line 4: inf must be finite"),
        (BINS + "4,3,1\n", "line 4: the upper edge 3 must be above the lower 4"),
        (BINS + "5,8,1\n", "line 4: the bin begins at 5, but the one before ends at 4"),
        (BINS + "3,8,1\n", "line 4: the bin begins at 3"),
        ("low [um],high [um],n\n1,2,0\n2,3,0\n", "every amount is 0"),
        ("size [um],below [%]\n1,3\n2,100\n", "line 2: 3 lies below the first size 1"),
        ("size [um],below [%]\n1,0\n2,60\n", "line 3: the last amount is 60 %"),
        ("size [um],below\n1,0\n2,5\n3,4\n", "line 4: amounts must not fall"),
        ("size [um],below\n1,0\n1,5\n", "line 3: sizes must increase"),
        ("size [um],below\n1,0\n", "has one size"),
        (b"\xff\xfe\x00\x01", "is not UTF-8 text; save the sheet as CSV UTF-8"),
        (b"PK\x03\x04\x00\x00", "is not text"),
        (b"low [um],high [um],n\n\x00", "is not text"),
    ],
)
def test_bad_files_get_one_sentence(read, text, said):
    with pytest.raises(tb.errors.InvalidValue, match=said) as caught:
        read(text)
    assert len(caught.value.problems) == 1
    assert "sizes.csv" in caught.value.problems[0]


def test_missing_file_and_folder(tmp_path):
    with refuses(Mistake.UNREADABLE, "", says="none.csv"):
        read_sizes(tmp_path / "none.csv")
    with refuses(Mistake.UNREADABLE, "", says="folder"):
        read_sizes(tmp_path)
    with refuses(Mistake.OPTION, "weighting", value='"mass"'):
        read_sizes(tmp_path, weighting="mass")


@settings(deadline=None, max_examples=150)
@given(text=st.text(alphabet="0123456789.,;[]um\n\t -e%abc\"'#", max_size=60))
def test_nonsense_is_refused_or_read_never_a_crash(tmp_path_factory, text):
    path = tmp_path_factory.mktemp("nonsense") / "sizes.csv"
    path.write_text(text)
    problems = ()
    try:
        read_sizes(path)
    except tb.errors.InvalidValue as error:
        problems = error.problems
    assert len(problems) <= 1


@pytest.mark.parametrize(("width", "slope"), [(1.6e-9, -1.0), (1e-8, 2.64), (1e-6, 5.0)])
def test_a_narrow_class_of_powers_holds_all_its_particles(width, slope):
    low, high = 3e-7, 3e-7 * (1 + width)
    sizes = PowerLaw(edges=(low, high), counts=(1,), slopes=(slope,))
    middle = 0.5 * (low + high)
    assert float(sizes.pdf(middle)) * (high - low) == pytest.approx(1, rel=1e-11)
    assert float(sizes.partial_moment(0, low, high)) == pytest.approx(1, rel=1e-14)
    assert float(sizes.partial_moment(3, low, high)) == pytest.approx(middle**3, rel=1e-11)
