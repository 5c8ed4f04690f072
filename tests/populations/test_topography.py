"""Measured surfaces: closed forms, SurfaceTopography's own numbers, files that are none."""

import json
import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from cases import make_example_surface
from command_line import run
from refusals import Mistake, refuses

import thirdbody as tb
from thirdbody import study
from thirdbody.cli.commands import surface
from thirdbody.errors import code_of
from thirdbody.populations.measured import synthetic
from thirdbody.populations.measured.topography import COLUMNS, from_topography

FOLDER = Path(__file__).parents[3] / "shared" / "data" / "topography"
FILES = ("matrix-3.txt", "metropro-1.dat", "mi-1.mi", "opdx-3.opdx", "x3p-2.x3p")
STUDY = """
[surfaces]
first = "S45C"
second = "S45C"
[roughness]
topography = "example"
[load]
pressure = "5 MPa"
"""


def is_of(kind, note):
    """Whether a note on a surface is of this kind."""
    return code_of(note).startswith(f"topography.{kind}.")


@pytest.fixture
def library():
    return pytest.importorskip("SurfaceTopography", reason="the extra `surfaces` is not installed")


@pytest.fixture(params=FILES)
def measured(request, library):
    path = FOLDER / request.param
    if not path.is_file():
        pytest.skip(f"no folder of measured surfaces beside this checkout ({path.name})")
    return path


@pytest.fixture
def part(tmp_path):
    """Writes a study file and reads it."""

    def read(*changes, folder=tmp_path):
        text = STUDY
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        path = folder / "study.toml"
        path.write_text(text)
        return study.load_study(path)

    return read


def grid(points, spacing):
    x = np.arange(points) * spacing
    return np.meshgrid(x, x, indexing="ij")


def waves(points, spacing, *, a=2e-8, turns=(4, 6)):
    """a cos(q1 x) + a cos(q2 y), which repeats on the grid."""
    x, y = grid(points, spacing)
    q = [2 * math.pi * n / (points * spacing) for n in turns]
    return a * (np.cos(q[0] * x) + np.cos(q[1] * y)), q


# ---------------------------------------------------------------- closed forms
def test_two_waves_by_the_spectrum_are_exact():
    h, (q1, q2) = waves(64, 1e-7)
    m = from_topography(h, spacing=1e-7, periodic=True, cutoff=0).moments_at(method="spectrum")
    a2 = 4e-16
    assert m.m0 == pytest.approx(a2, rel=1e-12)
    assert m.m2 == pytest.approx(a2 / 4 * (q1**2 + q2**2), rel=1e-12)
    assert m.m4 == pytest.approx(3 / 16 * a2 * (q1**4 + q2**4), rel=1e-12)


def test_two_waves_by_differences_have_the_known_error():
    h, (q1, q2) = waves(64, 1e-7)
    m = from_topography(h, spacing=1e-7, periodic=True, cutoff=0).moments
    seen = [2 * math.sin(q * 1e-7 / 2) / 1e-7 for q in (q1, q2)]
    assert m.m0 == pytest.approx(4e-16, rel=1e-12)
    assert m.m2 == pytest.approx(1e-16 * sum(q**2 for q in seen), rel=1e-12)
    assert m.m4 == pytest.approx(0.75e-16 * sum(q**4 for q in seen), rel=1e-12)


@pytest.mark.parametrize(("name", "order"), [("m2", 1 / 12), ("m4", 1 / 6)])
def test_differences_converge_to_the_continuum(name, order):
    for points in (64, 256):
        spacing = 6.4e-6 / points
        h, (q, _) = waves(points, spacing, turns=(4, 4))
        surface = from_topography(h, spacing=spacing, periodic=True, cutoff=0)
        exact = {"m2": 2e-16 * q**2, "m4": 1.5e-16 * q**4}[name]
        error = 1 - getattr(surface.moments, name) / exact
        assert error == pytest.approx(order * (q * spacing) ** 2, rel=0.03)


@pytest.mark.parametrize("turns", [(5, 0), (0, 5), (3, 4), (4, 3), (-3, 4)])
def test_moments_do_not_depend_on_the_direction(turns):
    x, y = grid(128, 1e-7)
    q = 2 * math.pi / 128e-7
    h = 1e-8 * np.cos(q * (turns[0] * x + turns[1] * y) + 0.3)
    m = from_topography(h, spacing=1e-7, periodic=True, cutoff=0, detrend="none")
    assert m.moments.alpha == pytest.approx(1.5, rel=2e-3)
    spectral = m.moments_at(0, method="spectrum")
    assert spectral.m4 == pytest.approx(3 / 16 * 1e-16 * (5 * q) ** 4, rel=1e-10)
    assert spectral.alpha == pytest.approx(1.5, rel=1e-10)


def test_a_profile_has_the_moments_of_a_profile():
    x = np.arange(512) * 1e-7
    q = 2 * math.pi / 6.4e-6
    surface = from_topography(
        1e-8 * np.sin(q * x) + 5e-9 * np.cos(3 * q * x), spacing=1e-7, periodic=True, cutoff=0
    ).moments_at(method="spectrum")
    exact = [0.5 * (1e-16 * q**n + 0.25e-16 * (3 * q) ** n) for n in (0, 2, 4)]
    assert [surface.m0, surface.m2, surface.m4] == pytest.approx(exact, rel=1e-10)


def test_oblong_points_are_known():
    x, y = np.meshgrid(np.arange(80) * 1e-7, np.arange(120) * 3e-7, indexing="ij")
    q = 2 * math.pi / 8e-6, 2 * math.pi / 36e-6 * 2
    h = 1e-8 * (np.cos(q[0] * x) + np.cos(q[1] * y))
    s = from_topography(h, spacing=(1e-7, 3e-7), periodic=True, cutoff=0)
    assert s.size == pytest.approx((8e-6, 36e-6))
    assert s.moments.m2 == pytest.approx(0.25e-16 * (q[0] ** 2 + q[1] ** 2), rel=5e-3)


def test_moments_give_nayaks_asperities():
    """Identities between σ, R, η and σ_s, y_s that hold whatever the bandwidth."""
    for m0, m2, m4 in [(1e-14, 3.3e-3, 5.5e9), (4e-16, 1e-4, 1e9)]:
        m = tb.surfaces.SpectralMoments(m0=m0, m2=m2, m4=m4)
        assert m.sigma_s**2 == pytest.approx(m0 - 3.717e-4 / (m.eta * m.R) ** 2, rel=1e-4)
        assert m.y_s == pytest.approx(0.045944 / (m.eta * m.R), rel=2e-5)
        assert m.eta * m.R * m.sigma == pytest.approx(
            math.sqrt(m.alpha / (768 * math.pi)), rel=1e-12
        )
        rough = m.roughness()
        assert (rough.sigma_s, rough.y_s) == pytest.approx((m.sigma_s, m.y_s), rel=1e-12)
        assert (rough.density, rough.R) == (m.eta, m.R)
        assert tb.surfaces.SpectralMoments.from_dict(m.to_dict()) == m


def test_moments_of_two_surfaces_add():
    x, y = grid(64, 1e-7)
    q = 2 * math.pi / 6.4e-6
    first, second = 1e-8 * np.cos(4 * q * x), 2e-8 * np.cos(q * (3 * x + 2 * y))

    def moments(h):
        return from_topography(h, spacing=1e-7, periodic=True, cutoff=0).moments

    both = moments(first) + moments(second)
    together = moments(first + second)
    for name in ("m0", "m2", "m4"):
        assert getattr(together, name) == pytest.approx(getattr(both, name), rel=1e-12)


def test_a_single_wave_is_no_random_surface():
    x, _ = grid(64, 1e-7)
    s = from_topography(1e-8 * np.cos(2.5e6 * math.pi * x), spacing=1e-7, periodic=True, cutoff=0)
    with refuses(Mistake.RANGE, "", says="1.5"):
        s.roughness()


# ---------------------------------------------------------------- synthetic surfaces
def test_a_surface_is_made_with_given_moments():
    for alpha in (2.2, 5.0, 20.0):
        asked = tb.surfaces.SpectralMoments(m0=1e-14, m2=4e-3, m4=alpha * 16e-6 / 1e-14)
        made = synthetic.from_moments(asked, spacing=5e-8, points=512, seed=3)
        found = made.moments_at(0, method="spectrum")
        for name in ("m0", "m2", "m4"):
            assert getattr(found, name) == pytest.approx(getattr(asked, name), rel=1e-8)


def test_synthetic_surfaces_are_seeded():
    one, same, other = (
        synthetic.self_affine(
            sigma=1e-7, hurst=0.8, shortest=5e-7, longest=4e-6, spacing=1e-7, points=64, seed=seed
        )
        for seed in (1, 1, 2)
    )
    assert np.array_equal(one.heights, same.heights)
    assert not np.allclose(one.heights, other.heights, atol=0)
    for method in ("spectrum", "differences"):
        a, b = one.moments_at(0, method=method), other.moments_at(0, method=method)
        assert a.m4 == pytest.approx(b.m4, rel=1e-10)


def test_self_affine_moments_tend_to_the_integral():
    """Sums over waves against ∫q^(n+1)C dq between the cut-offs, in closed form."""
    H, q_l, q_s = 0.7, 2 * math.pi / 10e-6, 2 * math.pi / 1e-6
    made = synthetic.self_affine(
        sigma=1e-7, hurst=H, shortest=1e-6, longest=10e-6, spacing=2e-7, points=512
    ).moments_at(0, method="spectrum")

    def integral(n):
        flat = q_l ** (n + 2) / (n + 2) * q_l ** (-2 - 2 * H)
        return flat + (q_s ** (n - 2 * H) - q_l ** (n - 2 * H)) / (n - 2 * H)

    assert made.m2 / made.m0 == pytest.approx(0.5 * integral(2) / integral(0), rel=0.01)
    assert made.m4 / made.m0 == pytest.approx(0.375 * integral(4) / integral(0), rel=0.01)


@pytest.mark.check
@pytest.mark.parametrize("alpha", [3.0, 5.0])
def test_summits_counted_are_those_of_nayak(alpha):
    asked = tb.surfaces.SpectralMoments(m0=1e-14, m2=2e-3, m4=alpha * 4e-6 / 1e-14)
    # 150 points a summit; means over two surfaces
    found = [
        synthetic.from_moments(
            asked, spacing=(150 * asked.eta) ** -0.5, points=768, seed=seed
        ).summits
        for seed in range(2)
    ]
    count = sum(s.count for s in found)
    heights = np.concatenate([s.heights for s in found])
    curvatures = np.concatenate([s.curvatures for s in found])
    assert count > 1000
    scatter = 4 / math.sqrt(count)
    assert np.mean([s.density for s in found]) == pytest.approx(asked.eta, rel=scatter + 0.02)
    assert 1 / curvatures.mean() == pytest.approx(asked.R, rel=scatter + 0.03)
    assert heights.std() == pytest.approx(asked.sigma_s, rel=scatter)
    assert heights.mean() == pytest.approx(asked.y_s, rel=scatter + 0.02)


@pytest.mark.parametrize(
    "changes",
    [
        {"hurst": 1.2},
        {"shortest": 1e-7},
        {"longest": 1e-3},
        {"sigma": -1.0},
        {"points": 5},
        {"seed": -1},
        {"spacing": math.nan},
    ],
)
def test_impossible_synthetic_surfaces_are_refused(changes):
    good = dict(sigma=1e-7, hurst=0.8, shortest=5e-7, longest=4e-6, spacing=1e-7, points=64)
    with pytest.raises(tb.errors.InvalidValue, match=next(iter(changes))):
        synthetic.self_affine(**good | changes)


def test_moments_that_no_spectrum_has_are_refused():
    asked = tb.surfaces.SpectralMoments(m0=1e-14, m2=4e-3, m4=1.6 * 16e-6 / 1e-14)
    with refuses(Mistake.BEYOND, "", says="α "):
        synthetic.from_moments(asked, spacing=1e-7)


# ---------------------------------------------------------------- form, gaps, filter
@pytest.mark.parametrize(("detrend", "form"), [("tilt", (1, 0)), ("curvature", (1, 1))])
def test_form_is_removed(detrend, form):
    rng = np.random.default_rng(5)
    x, y = np.meshgrid(np.linspace(-1, 1, 60), np.linspace(-1, 1, 40), indexing="ij")
    h = 1e-8 * rng.standard_normal(x.shape)
    h[10:14, 20:22] = np.nan
    shape = form[0] * (3e-7 * x - 2e-7 * y + 1e-6) + form[1] * 1e-7 * (x * y - x**2)
    plain = from_topography(h, spacing=1e-7, detrend=detrend)
    bent = from_topography(h + shape, spacing=1e-7, detrend=detrend)
    np.testing.assert_allclose(bent.heights, plain.heights, atol=1e-20)
    assert np.array_equal(np.isnan(bent.heights), np.isnan(h))


def test_gaps_are_filled_harmonically_for_the_spectrum():
    from thirdbody.populations.measured.spectra import fill_missing

    x, y = np.meshgrid(np.arange(40.0), np.arange(30.0), indexing="ij")
    h = x**2 - y**2 + 3 * x * y
    gap = h.copy()
    gap[10:20, 8:15] = gap[0, 3:5] = np.nan
    whole = fill_missing(gap)
    np.testing.assert_allclose(whole[10:20, 8:15], h[10:20, 8:15], rtol=1e-4, atol=1e-2)
    assert np.array_equal(whole[~np.isnan(gap)], h[~np.isnan(gap)])


@pytest.mark.parametrize("share", [0.005, 0.015])
def test_gaps_leave_the_moments_as_they_are(share):
    whole = synthetic.self_affine(
        sigma=1e-7, hurst=0.8, shortest=1e-6, longest=5e-6, spacing=1e-7, seed=4
    )
    h = whole.heights.copy()
    h[np.random.default_rng(1).random(h.shape) < share] = np.nan
    gaps = from_topography(h, spacing=1e-7, periodic=True, detrend="none", cutoff=1e-6)
    assert gaps.missing == pytest.approx(share, rel=0.3)
    full, some = whole.moments_at(1e-6), gaps.moments
    assert [some.m0, some.m2, some.m4] == pytest.approx([full.m0, full.m2, full.m4], rel=0.02)
    # fewer than one of a hundred need no word
    assert any(is_of("missing", text) for text in gaps.warnings) == (share > 0.01)


@pytest.mark.parametrize("periods", [1.0, 2.0, 4.0])
def test_the_filter_passes_what_its_cutoff_says(periods):
    """2^(−(λ_c/λ)²) of the amplitude, one half at the cut-off."""
    x, _ = grid(240, 1e-7)
    wave = 1e-8 * np.cos(2 * math.pi * x / 2.4e-6)
    s = from_topography(wave, spacing=1e-7, periodic=True, detrend="none")
    passed = s.filtered(2.4e-6 / periods).std() / wave.std()
    assert passed == pytest.approx(2 ** (-1 / periods**2), rel=1e-3)


def test_wide_filters_are_those_of_scipy():
    from scipy.ndimage import gaussian_filter

    from thirdbody.populations.measured.spectra import SIGMA_OF_CUTOFF, gaussian_filtered

    h = np.random.default_rng(8).standard_normal((300, 260))
    gaps = np.where(np.random.default_rng(9).random(h.shape) < 0.1, np.nan, h)
    width = SIGMA_OF_CUTOFF * 60
    for z in (h, gaps):
        known = np.isfinite(z).astype(float)
        pair = (
            gaussian_filter(a, width, mode="constant", truncate=8)
            for a in (np.nan_to_num(z), known)
        )
        total, weight = pair
        got = gaussian_filtered(z, (1.0, 1.0), 60.0, False)
        inside = np.isfinite(z)
        np.testing.assert_allclose(got[inside], (total / weight)[inside], atol=2e-6)


@pytest.mark.parametrize("cutoff", [0.0, 8e-7, 2e-6])
def test_both_methods_agree_where_the_grid_is_fine(cutoff):
    s = synthetic.self_affine(
        sigma=1e-7, hurst=0.8, shortest=2e-6, longest=8e-6, spacing=1e-7, seed=2
    )
    by, spectral = s.moments_at(cutoff), s.moments_at(cutoff, method="spectrum")
    pairs = [(getattr(by, name), getattr(spectral, name)) for name in ("m0", "m2", "m4")]
    for (a, b), tolerance in zip(pairs, (2e-3, 0.01, 0.02), strict=True):
        assert a == pytest.approx(b, rel=tolerance)


def test_a_window_cut_from_a_surface_has_its_moments():
    """Edges: what does not repeat is filtered and windowed, and gives the same numbers."""
    whole = synthetic.self_affine(
        sigma=1e-7, hurst=0.8, shortest=8e-7, longest=3e-6, spacing=1e-7, points=512, seed=6
    )
    cut = from_topography(whole.heights[:300, :300], spacing=1e-7, cutoff=1e-6)
    exact = whole.moments_at(1e-6)
    for method in ("differences", "spectrum"):
        found = cut.moments_at(method=method)
        assert [found.m0, found.m2, found.m4] == pytest.approx(
            [exact.m0, exact.m2, exact.m4], rel=0.15
        )


# ---------------------------------------------------------------- the cut-off
def test_a_band_limited_surface_does_not_move_with_the_cutoff():
    s = synthetic.self_affine(
        sigma=1e-7, hurst=0.8, shortest=4e-6, longest=8e-6, spacing=1e-7, points=256
    )
    still = from_topography(s.heights, spacing=1e-7, periodic=True, cutoff=5e-7)
    assert not any(is_of("cutoff", text) for text in still.warnings)
    moving = from_topography(s.heights, spacing=1e-7, periodic=True, cutoff=4e-6)
    assert any(is_of("cutoff", text) and "R by +" in text for text in moving.warnings)


def test_the_warning_tells_the_change_per_octave():
    s = from_topography("example", cutoff=1e-6)
    ends = [s.moments_at(1e-6 * 2**half).R for half in (-0.5, 0.5)]
    told = f"R by {100 * (ends[1] / ends[0] - 1):+.0f} %"
    assert any(told in text for text in s.warnings)


def test_noise_raises_the_recommended_cutoff():
    s = synthetic.self_affine(
        sigma=1e-7, hurst=0.8, shortest=3e-7, longest=1e-5, spacing=1e-7, points=256
    )
    clean = from_topography(s.heights, spacing=1e-7, periodic=True)
    assert clean.recommended[0] == pytest.approx(8e-7)
    noise = 5e-8 * np.random.default_rng(0).standard_normal(s.heights.shape)
    noisy = from_topography(s.heights + noise, spacing=1e-7, periodic=True)
    assert "noise" in noisy.recommended[1]
    # where the spectrum of the noise, flat, is as high as that of the surface
    wavelength, density = clean.psd()
    equal = wavelength[np.argmax(density > 25e-16 * 1e-14)]
    assert noisy.recommended[0] == pytest.approx(equal, rel=0.3)
    assert noisy.recommended[0] > clean.recommended[0]


def test_the_resolution_of_the_instrument_is_heeded():
    s = from_topography("example", resolution=1.2e-6)
    assert s.recommended[0] == s.cutoff == 1.2e-6
    assert "instrument" in s.recommended[1]
    assert any("below the recommended" in t for t in from_topography("example", cutoff=0).warnings)
    wide = from_topography("example", resolution=9e-6)
    assert wide.recommended[0] == pytest.approx(12.8e-6 / 5)
    assert "9 µm would be asked for" in wide.recommended[1]


def test_the_curve_holds_what_single_cutoffs_give():
    s = from_topography("example")
    curve = s.curve(points_per_octave=1)
    assert set(curve.columns) == set(COLUMNS)
    for i, cutoff in enumerate(curve["cutoff"]):
        m = s.moments_at(float(cutoff))
        assert (curve["m4"][i], curve["R"][i]) == (m.m4, m.R)
        assert curve["summits"][i] == s.summits_at(float(cutoff)).count
    assert np.all(np.diff(curve["m0"]) < 0)


def test_an_anisotropic_surface_says_so():
    rng = np.random.default_rng(2)
    s = from_topography(
        1e-8 * np.repeat(rng.standard_normal((128, 1)), 128, 1) + 1e-9 * rng.random((128, 128)),
        spacing=1e-7,
    )
    assert s.anisotropy > 10
    assert any(is_of("isotropy", text) for text in s.warnings)


def test_measured_heights_make_the_contact():
    s = from_topography("example", cutoff=5e-7)
    rough = s.roughness(heights="measured")
    summits = s.summits
    assert rough.sigma_s == pytest.approx(summits.sigma_s, rel=1e-12)
    assert (rough.density, rough.R) == (summits.density, summits.R)
    # standardised, the histogram has the quantiles of the summits
    z = (summits.heights - summits.y_s) / summits.heights.std()
    assert rough.heights.ppf(0.5) == pytest.approx(np.median(z), abs=0.2)
    assert sum(rough.heights.counts) == summits.count


def test_skewness_and_kurtosis():
    rng = np.random.default_rng(3)
    s = from_topography(rng.exponential(1e-8, (600, 600)), spacing=1e-6, cutoff=0)
    assert s.skewness == pytest.approx(2, abs=0.05)
    assert s.kurtosis == pytest.approx(9, abs=0.6)
    assert any(is_of("gaussian", text) for text in s.warnings)


# ---------------------------------------------------------------- sources
def test_the_example_is_what_its_script_makes():
    made = make_example_surface.made()
    h = np.cumsum(made["steps"], axis=0) * float(made["unit"])
    h[tuple(made["missing"].T)] = np.nan
    plain = from_topography(h, spacing=1e-7)
    np.testing.assert_allclose(from_topography("example").heights, plain.heights, atol=1e-20)


def test_a_surface_of_surfalize_is_read():
    h = from_topography("example", detrend="none").heights
    like = SimpleNamespace(data=1e6 * h.T[:100], step_x=0.1, step_y=0.2)
    s = from_topography(like, detrend="none", cutoff=0)
    assert s.heights.shape == (128, 100)
    assert s.spacing == pytest.approx((1e-7, 2e-7))
    assert s.rms_height == pytest.approx(np.nanstd(h[:, :100]))


def test_measured_files_agree_with_surfacetopography(measured, library):
    theirs = library.read_topography(str(measured)).to_unit("m")
    theirs = theirs.detrend(detrend_mode="height")
    s = from_topography(measured)
    if s.dim == 2:
        want = theirs.rms_height_from_area(), theirs.rms_gradient()
        want += (theirs.rms_curvature_from_area(),)
    else:
        want = theirs.rms_height_from_profile(), theirs.rms_slope_from_profile()
        want += (theirs.rms_curvature_from_profile(),)
    assert (s.rms_height, s.rms_slope, s.rms_curvature) == pytest.approx(want, rel=1e-6)
    if s.dim == 2:
        m = s.moments_at(0)
        assert math.sqrt(2 * m.m2) == pytest.approx(want[1], rel=1e-6)
        assert math.sqrt(m.m4 / 1.5) == pytest.approx(want[2], rel=1e-6)


def rms_by_points(h, dx, dy, wrap):
    """RMS height, gradient and mean curvature: each difference whose own points are known."""
    nx, ny = h.shape

    def at(i, j):
        if wrap:
            return h[i % nx, j % ny]
        return h[i, j] if 0 <= i < nx and 0 <= j < ny else math.nan

    gradients, curvatures = ([], []), []
    for i in range(nx):
        for j in range(ny):
            # forward differences in the cells of the grid, which the last row does not begin
            if wrap or (i + 1 < nx and j + 1 < ny):
                gradients[0].append((at(i + 1, j) - at(i, j)) / dx)
                gradients[1].append((at(i, j + 1) - at(i, j)) / dy)
            along = (at(i + 1, j) - 2 * at(i, j) + at(i - 1, j)) / dx**2
            across = (at(i, j + 1) - 2 * at(i, j) + at(i, j - 1)) / dy**2
            curvatures.append((along + across) / 2)

    def mean_square(values):
        known = [v * v for v in values if not math.isnan(v)]
        return math.fsum(known) / len(known)

    heights = [v for v in h.ravel().tolist() if not math.isnan(v)]
    middle = math.fsum(heights) / len(heights)
    return (
        math.sqrt(mean_square([v - middle for v in heights])),
        math.sqrt(mean_square(gradients[0]) + mean_square(gradients[1])),
        math.sqrt(mean_square(curvatures)),
    )


@pytest.mark.parametrize("wrap", [False, True])
@pytest.mark.parametrize("gap", ["none", "block", "points", "edge"])
def test_missing_points_as_defined(gap, wrap):
    """Against sums over points; SurfaceTopography agrees too where none is missing."""
    rng = np.random.default_rng(8)
    h = 1e-7 * rng.standard_normal((24, 30)) * np.linspace(0.2, 3, 30)
    if gap == "block":
        h[6:14, 15:28] = np.nan
    elif gap == "points":
        h[rng.random(h.shape) < 0.15] = np.nan
    elif gap == "edge":
        h[0, 3:20] = h[:9, -1] = np.nan
    s = from_topography(h, spacing=(1e-7, 2e-7), periodic=wrap, detrend="none", cutoff=0)
    found = s.rms_height, s.rms_slope, s.rms_curvature
    assert found == pytest.approx(rms_by_points(h, 1e-7, 2e-7, wrap), rel=1e-12)


@pytest.mark.parametrize("share", [0.0, 0.1])
def test_surfacetopography_averages_other_points_beside_gaps(library, share):
    rng = np.random.default_rng(9)
    h = 1e-7 * rng.standard_normal((40, 50))
    h[rng.random(h.shape) < share] = np.nan
    theirs = library.Topography(np.ma.masked_invalid(h), (4e-6, 5e-6), unit="m")
    s = from_topography(h, spacing=1e-7, detrend="none", cutoff=0)
    assert s.rms_height == pytest.approx(theirs.rms_height_from_area(), rel=1e-12)
    found = np.array([s.rms_slope, s.rms_curvature])
    off = found / [theirs.rms_gradient(), theirs.rms_curvature_from_area()] - 1
    if share == 0:
        assert np.all(np.abs(off) < 1e-12)
    else:
        assert np.all((np.abs(off) > 1e-6) & (np.abs(off) < 0.1))
        slopes, _ = theirs.derivative(1, interpolation="linear")
        ours = np.isfinite(h[1:, :-1] - h[:-1, :-1]).sum()
        assert np.ma.count(slopes) < ours


def test_measured_files_go_through_solve(measured, tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(STUDY.replace('"example"', json.dumps(str(measured))))
    result = run("solve", path, "--json")
    assert result.exit_code == 0, result.stderr
    answer = json.loads(result.stdout)
    assert answer["states"]["status"] == ["ok"]
    assert answer["inputs"]["roughness"]["sigma"] == from_topography(measured).moments.sigma
    assert "cut-off" in result.stderr


def test_an_object_of_surfacetopography_is_read(library):
    h = from_topography("example", detrend="none").heights[:60, :50]
    made = library.Topography(1e9 * h, (6000.0, 5000.0), unit="nm")
    s = from_topography(made, detrend="none", cutoff=0)
    assert s.spacing == pytest.approx((1e-7, 1e-7))
    np.testing.assert_allclose(s.heights, h - h.mean(), atol=1e-18)
    line = library.NonuniformLineScan(np.linspace(0, 5, 200) ** 1.1, h.ravel()[:200], unit="um")
    assert any("evenly" in text for text in from_topography(line, cutoff=0).notes)


def test_the_tip_radius_in_a_file_is_a_limit(library):
    h = 1e9 * from_topography("example", detrend="none").heights[:60, :50]
    tip = {"instrument": {"parameters": {"tip_radius": {"value": 3.0, "unit": "µm"}}}}
    s = from_topography(library.Topography(h, (6000.0, 5000.0), unit="nm", info=tip))
    assert s.limit is not None
    assert " 3 µm" in s.limit_reason
    blur = {"instrument": {"parameters": {"resolution": {"value": 900, "unit": "nm"}}}}
    s = from_topography(library.Topography(h, (6000.0, 5000.0), unit="nm", info=blur))
    assert s.limit == pytest.approx(9e-7)


# ---------------------------------------------------------------- what is no surface
@pytest.mark.parametrize(
    ("given", "words"),
    [
        (dict(source=np.ones((64, 64)), spacing=1e-7), "flat"),
        (dict(source=np.full((64, 64), np.nan), spacing=1e-7), "no datum at 100 %"),
        (dict(source=np.eye(5), spacing=1e-7), "5 x 5 points"),
        (dict(source=np.eye(64)), "needs spacing"),
        (dict(source=np.zeros((4, 64, 64)), spacing=1e-7), "3 axes"),
        (dict(source=np.eye(64), spacing=1e-7), "no surface"),
        (dict(source=object(), spacing=1e-7), "no topography"),
        (dict(source="example", detrend="plane"), "none, tilt, curvature"),
        (dict(source="example", cutoff=1e-9), "400 nm"),
        (dict(source="example", cutoff=1.0), "half of the shorter side"),
        (dict(source="example", cutoff=-1.0), "at least 0"),
        (dict(source="example", cutoff=math.nan), "finite"),
        (dict(source="example", unit="GPa"), "pressure"),
        (dict(source="example", unit="nm"), "leave it out"),
        (dict(source="example", spacing=1e-7), "leave it out"),
        (dict(source="example", spacing=(1, 2, 3)), "spacing"),
        (dict(source="example", resolution=0.0), "above 0"),
    ],
)
def test_nonsense_is_refused_in_one_sentence(given, words):
    with pytest.raises(tb.errors.InvalidValue, match=words) as error:
        from_topography(**given)
    assert len(error.value.problems) == 1


BAD_FILES = {
    "empty.x3p": b"",
    "noise.x3p": np.random.default_rng(0).bytes(5000),
    "square.bin": np.random.default_rng(1).bytes(2 * 100 * 100),
    "text.txt": b"hello\nthis is no map\n",
    "tiny.txt": b"1 2 3\n4 5 6\n",
    "one.txt": b"1",
    "zip.x3p": b"PK\x05\x06" + bytes(18),
    "numpy.npy": b"\x93NUMPY\x01\x00v\x00{'descr': '<f8', 'fortran_order': False, 'shape': (9",
}


@pytest.mark.parametrize("name", BAD_FILES)
def test_files_that_are_no_topography(name, tmp_path, library):
    path = tmp_path / name
    path.write_bytes(BAD_FILES[name])
    result = run("surface", path, "--unit", "nm", "--spacing", "1 nm")
    assert result.exit_code == 2
    assert result.stdout == ""
    (line,) = result.stderr.splitlines()
    assert line.startswith("error: ")
    assert name in line


def test_a_cut_off_file_is_no_file(measured, tmp_path):
    path = tmp_path / f"part{measured.suffix}"
    content = measured.read_bytes()
    path.write_bytes(content[: len(content) // 8])
    if measured.suffix == ".txt":
        pytest.skip("a part of a table of numbers is a table of numbers")
    result = run("surface", path)
    assert (result.exit_code, result.stdout) == (2, "")
    assert len(result.stderr.splitlines()) == 1


def test_a_file_without_unit_asks_for_it(tmp_path, library):
    path = tmp_path / "map.npy"
    h = from_topography("example", detrend="none").heights[:, :60]
    np.save(path, 1e9 * h)
    with pytest.raises(tb.errors.InvalidValue) as error:
        from_topography(path)
    unit, sides = error.value.problems
    assert unit.code is sides.code is Mistake.UNIT
    assert (unit.place, sides.place) == ("unit", "spacing")
    assert '"um"' in unit.hint
    for place in ("--unit", "--spacing"):
        with refuses(Mistake.UNIT, place):
            surface.command(surface.Options(file=path))
    s = from_topography(path, unit="nm", spacing=1e-7, detrend="none")
    np.testing.assert_allclose(s.heights, h - np.nanmean(h), atol=1e-18)


def test_a_text_parted_by_commas_is_read_like_one_parted_by_blanks(tmp_path, library):
    heights = np.random.default_rng(5).normal(0, 1, (40, 40))
    read = []
    for mark in (" ", ",", ";", ", "):
        np.savetxt(tmp_path / "map.csv", heights, delimiter=mark)
        read.append(from_topography(tmp_path / "map.csv", unit="nm", spacing=1e-7).heights)
        np.testing.assert_array_equal(read[-1], read[0])
    for text in ("0,1 0,2\n" * 9, "0,1;0,2\n" * 9, "1.000,1 1.000,2\n" * 9):
        (tmp_path / "map.csv").write_text(text, "utf-8")
        with refuses(Mistake.DAMAGED, "") as told:
            from_topography(tmp_path / "map.csv", unit="nm", spacing=1e-7)
        assert told.value.problems[0].hint


def test_huge_files_are_refused_before_they_are_read(tmp_path, library):
    path = tmp_path / "huge.npy"
    head = b"{'descr': '<f8', 'fortran_order': False, 'shape': (900000, 900000), }"
    head = head.ljust(117) + b"\n"
    path.write_bytes(b"\x93NUMPY\x01\x00" + len(head).to_bytes(2, "little") + head)
    with refuses(Mistake.TOO_LARGE, "", says="900000 x 900000"):
        from_topography(path, unit="nm", spacing=1e-7)
    with path.open("wb") as file:
        file.truncate(2_000_000_000)
    with pytest.raises(tb.errors.InvalidValue, match="2 GB"):
        from_topography(path)


def test_without_the_library_a_file_says_what_to_install(tmp_path, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "SurfaceTopography", None)
    path = tmp_path / "part.x3p"
    path.write_bytes(b"x")
    with pytest.raises(tb.errors.InvalidValue, match=r"thirdbody\[surfaces\]"):
        from_topography(path)
    assert from_topography("example").rms_height > 0


# ---------------------------------------------------------------- study files
def test_a_study_has_the_roughness_of_the_topography(part):
    s = from_topography("example", cutoff=1e-6, detrend="curvature")
    asked = part(('"example"', '"example"\ncutoff = "1 um"\ndetrend = "curvature"'))
    assert asked.contact.roughness == s.roughness()
    assert any("depends on the cut-off" in text for text in asked.notes)
    asked = part(('"example"', '"example"\ncutoff = "500 nm"\nheights = "measured"'))
    assert asked.contact.roughness == from_topography("example", cutoff=5e-7).roughness(
        heights="measured"
    )
    asked = part(('"example"', '"example"\nheights = { name = "weibull", shape = 2 }'))
    assert asked.contact.roughness.heights == tb.heights.WeibullHeights(shape=2)


def test_a_study_has_the_tips_of_the_topography(part):
    elliptic = ("[surfaces]", 'asperity_law = "elliptic-zmc"\n[surfaces]')
    one, s = from_topography("example", cutoff=8e-7), tb.surfaces.Ellipticity(ratios=(1, 2))
    file = '"example"\ncutoff = "800 nm"\n'
    for heights in (None, "measured"):
        more = f'heights = "{heights}"' if heights else ""
        asked = part(('"example"', f'{file}{more}\nellipticity = "measured"'), elliptic)
        rough = one.roughness(heights=heights, ellipticity="measured")
        assert asked.contact.roughness == rough
        assert len(rough.ellipticity.classes) > 8
    told = study.run_study(asked)
    inputs = json.loads(json.dumps(told.study.contact.to_dict()))
    assert tb.Roughness.from_dict(inputs["roughness"]) == rough
    assert list(told.states.status) == ["ok"]
    for files in (file, '["example", "example"]\ncutoff = "800 nm"\n'):
        asked = part(('"example"', f"{files}ellipticity = {{ ratios = [1, 2] }}"), elliptic)
        plain = part(('"example"', files))
        assert asked.contact.roughness == plain.contact.roughness.replace(ellipticity=s)


def test_two_faces_of_a_study_add(part):
    one, two = (part(('"example"', text)) for text in ('"example"', '["example", "example"]'))
    m = from_topography("example").moments
    assert two.contact.roughness == (m + m).roughness()
    assert two.contact.roughness.density == pytest.approx(one.contact.roughness.density)


def test_a_file_lies_beside_the_study(part, tmp_path, library):
    h = 1e9 * from_topography("example", detrend="none").heights[:, :60]
    np.save(tmp_path / "map.npy", h)
    asked = part(('"example"', '"map.npy"\nunit = "nm"\nspacing = "100 nm"'))
    assert asked.contact.roughness.sigma == pytest.approx(
        from_topography(1e-9 * h, spacing=1e-7).moments.sigma
    )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('"example"\nsigma = "1 um"', ["roughness.sigma", "remove one of the two"]),
        ('"example"\ncutoff = "1 nm"', ["roughness.cutoff = 1 nm", "between 400 nm"]),
        ('"example"\ncutoff = "1 GPa"', ["roughness.cutoff", "pressure"]),
        ('"example"\ndetrend = "plane"', ["roughness.detrend", "tilt"]),
        ('"example"\nheights = "mesured"', ["roughness.heights"]),
        ('"example"\nheigths = "measured"', ["roughness.heigths", "heights"]),
        ('"none.x3p"', ["roughness.topography", "no such file"]),
        ("5", ["roughness.topography = 5", "quotes"]),
        ('["example", "example", "example"]', ["roughness.topography", "two"]),
        ('["example", "example"]\nheights = "measured"', ["measured", "one file"]),
        ('"example"\ncutoff = "2.5 um"\nheights = "measured"', ["roughness", "too few"]),
        ('["example", "example"]\nellipticity = "measured"', ["ellipticity", "one file"]),
        ('"example"\nellipticity = "mesured"', ["roughness.ellipticity", 'must be "measured"']),
        ('"example"\nellipticity = 3', ["roughness.ellipticity = 3", 'must be "measured"']),
        ('"example"\nellipticity = { ratios = 2 }', ["ellipticity.ratios = 2 must be a list"]),
        (
            '"example"\nellipticity = { first = 4, second = 2, angle = 0, R_first = "1 um" }',
            ["ellipticity.R_first", "the topography tells; remove it"],
        ),
        (
            '"example"\n[roughness.ellipticity]\nfirst = 4\nsecond = 2\nangle = "random"\n'
            'R_first = "1 um"\nR_second = "1 um"\n',
            ["ellipticity.R_first and R_second would give R", "remove both"],
        ),
        ('"example"\nellipticity = "measured"', ["asperity_law", "round"]),
    ],
)
def test_mistakes_beside_a_topography(part, text, words):
    with pytest.raises(tb.errors.InvalidValue) as error:
        part(('"example"', text))
    (sentence,) = error.value.problems
    for word in words:
        assert word in sentence


# ---------------------------------------------------------------- the command
@pytest.mark.usefixtures("blank_pictures")
def test_the_command_prints_and_writes_it_all(tmp_path):
    result = run("surface", "example", "--out", tmp_path / "out", "--csv", tmp_path / "curve.csv")
    assert result.exit_code == 0
    assert "recommended cut-off: 800 nm" in result.stdout
    assert any("cut-off" in note for note in result.notes)
    assert (tmp_path / "out" / "surface.png").read_bytes().startswith(b"\x89PNG")
    lines = (tmp_path / "curve.csv").read_text().splitlines()
    assert lines[0].startswith("cutoff [m],m0 [m^2]")
    assert len(lines) == 1 + len(from_topography("example").curve()["cutoff"])


def test_the_command_prints_json(tmp_path):
    result = run("surface", "example", "--json", "--cutoff", "1 um")
    answer = json.loads(result.stdout, parse_constant=lambda token: pytest.fail(token))
    m = from_topography("example", cutoff=1e-6).moments
    assert answer["moments"]["m4"] == m.m4
    assert answer["asperities"]["R"] == m.R
    assert answer["cutoff"]["used"] == 1e-6
    assert set(answer["curve"]) == set(COLUMNS)


def test_the_page_prints_what_it_says(capsys):
    page = (Path(__file__).parents[2] / "docs" / "surfaces.md").read_text("utf-8")
    names = {}
    for block in page.split("```python\n")[1:3]:
        code, shown = block.split("```\n\n```\n")
        exec(compile(code, "surfaces.md", "exec"), names)
        assert capsys.readouterr().out == shown.split("```")[0]


def test_radii_of_a_self_affine_surface_grow_as_the_page_says():
    """R ∝ λ_c^(2−H) between the cut-offs of the surface."""
    H = 0.6
    s = synthetic.self_affine(
        sigma=1e-7, hurst=H, shortest=2.5e-7, longest=5e-5, spacing=1e-7, points=512
    )
    ratio = s.moments_at(4e-6, method="spectrum").R / s.moments_at(2e-6, method="spectrum").R
    assert math.log2(ratio) == pytest.approx(2 - H, abs=0.05)
