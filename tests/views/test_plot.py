"""Figures show the data they were given, named with symbol and unit, and leave pyplot alone."""

import itertools
import subprocess
import sys

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

import thirdbody as tb
from thirdbody.equilibrium import solve as one_solve
from thirdbody.equilibrium.words import MODES
from thirdbody.views import plot
from thirdbody.views.plot import style

STEEL = tb.materials["S45C"]
LOADS = np.geomspace(1e-7, 1e-2, 40)
MEAN = "particles.diameter.mean"


def make_contact(**changes):
    dust = tb.Particles(
        material=tb.materials["SiO2"],
        diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
        areal_density=1e11,
    )
    contact = tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=dust,
        particle_law=tb.particle.Series(deep="off"),
    )
    return contact.replace(**changes)


@pytest.fixture(scope="module")
def curves():
    return tb.sweep(make_contact(), F_star=LOADS, vary={MEAN: [0, 100e-9, 300e-9]})


@pytest.fixture(scope="module")
def state():
    return tb.solve(make_contact(), F_star=LOADS[:-4])


@pytest.mark.parametrize(
    ("draw", "quantity"),
    [
        (plot.area, "A_t"),
        (plot.shares, "particle_load_share"),
        (plot.separation, "d_star"),
    ],
)
def test_lines_are_the_data(curves, draw, quantity):
    ax = Figure().add_subplot()
    assert draw(curves, ax) is ax
    assert len(ax.lines) == 3
    for line, values in zip(ax.lines, curves[quantity].values, strict=True):
        np.testing.assert_array_equal(line.get_xdata(), LOADS)
        np.testing.assert_array_equal(line.get_ydata(), values)
    assert [text.get_text() for text in ax.get_legend().get_texts()] == [
        "two bodies",
        "$x_a$ = 100 nm",
        "$x_a$ = 300 nm",
    ]
    looks = {(line.get_color(), line.get_linestyle()) for line in ax.lines}
    assert len(looks) == 3
    assert len({line.get_linestyle() for line in ax.lines[1:]}) == 2, "told apart without colour"


def test_every_axis_has_symbol_and_unit(curves, state):
    axes = [
        plot.area(curves),
        plot.area(curves, per_load=True),
        plot.shares(curves, basis="area"),
        plot.separation(curves),
        plot.separation(curves, quantity="h"),
        plot.regimes(state),
        plot.mode_map(make_contact(), ratio=[1, 2, 3], F_star=[1e-5, 1e-4, 1e-3]),
    ]
    for ax in axes:
        for label in (ax.get_xlabel(), ax.get_ylabel()):
            assert "$" in label
            assert label.endswith("]")


def test_area_per_load(curves):
    ax = plot.area(curves, per_load=True)
    np.testing.assert_allclose(ax.lines[0].get_ydata(), curves.A_t.values[0] / LOADS, rtol=1e-14)


def test_pressure_on_the_abscissa(curves):
    ax = plot.area(curves, against="pressure")
    np.testing.assert_array_equal(ax.lines[1].get_xdata(), curves.pressure.values[1])
    assert "[Pa]" in ax.get_xlabel()


def test_a_sweep_over_pressure_and_a_word():
    found = tb.sweep(
        make_contact(), pressure=[1e6, 1e7], vary={"particle_law.seat": ["rough", "plane"]}
    )
    ax = plot.area(found, against="pressure")
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert labels == ["seat: rough", "seat: plane"]


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        (MEAN, 2.5e-6, "$x_a$ = 2.5 µm"),
        ("particles.areal_density", 3e10, r"$\eta_a$ = 3×10¹⁰ m⁻²"),
        ("particles.areal_density", 1e11, r"$\eta_a$ = 1×10¹¹ m⁻²"),
        ("surfaces.first.nu", 0.3, "surfaces.first.nu = 0.3"),
    ],
)
def test_legend_entries_read_well(name, value, text):
    assert style._legend_entry(name, value) == text


def test_equilibrium_is_one_curve(state):
    for draw in (plot.area, plot.shares, plot.separation):
        ax = draw(state)
        assert len(ax.lines) == 1
        assert ax.get_legend() is None


def test_regimes_fill_the_axis(state):
    ax = plot.regimes(state)
    tops = [collection.get_paths()[0].vertices[:, 1].max() for collection in ax.collections]
    assert tops[-1] == pytest.approx(1, abs=1e-12)
    assert len(ax.collections) == 3


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
def test_modes_bands_and_critical_loads():
    contact = make_contact()
    loads = np.geomspace(1e-7, 2e-2, 90)
    state = tb.solve(contact, F_star=loads)
    found = tb.transitions(contact)
    ax = plot.modes(state, transitions=found)
    marks = sorted(line.get_xdata()[0] for line in ax.lines[2:])
    assert marks == [found.F_cr1.value, found.F_cr2.value]
    bands = [
        (patch.get_x(), patch.get_x() + patch.get_width(), patch.get_facecolor()[:3])
        for patch in ax.patches
    ]
    for load, mode in zip(loads[1:-1], state.mode[1:-1], strict=True):
        colours = [colour for start, end, colour in bands if start < load < end]
        assert colours == [pytest.approx(plot.MODE_COLOURS[mode])]
    key = ax.get_legend()
    words = [text.get_text() for text in key.get_texts()]
    assert words[2:] == ["p-s", "hybrid", "s-s"]
    filled = {patch.get_label(): patch.get_facecolor()[:3] for patch in key.get_patches()}
    assert filled == {name: pytest.approx(plot.MODE_COLOURS[name]) for name in words[2:]}
    # the two shares that are drawn
    np.testing.assert_allclose(ax.lines[0].get_ydata() + ax.lines[1].get_ydata(), 1)


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
def test_modes_without_transitions_marks_between_states():
    state = tb.solve(make_contact(), F_star=np.geomspace(1e-7, 2e-2, 60))
    ax = plot.modes(state)
    first, second = (line.get_xdata()[0] for line in ax.lines[2:])
    modes = list(state.mode)
    i, j = modes.index("hybrid"), modes.index("s-s")
    assert state.F_star[i - 1] < first < state.F_star[i]
    assert state.F_star[j - 1] < second < state.F_star[j]


def test_modes_of_several_curves_is_a_chart(curves):
    ax = plot.modes(curves)
    rows = [text.get_text() for text in ax.get_yticklabels()]
    assert rows == ["two bodies", "$x_a$ = 100 nm", "$x_a$ = 300 nm"]
    # row by row: the number of different modes in the data is the number of bars
    expected = sum(1 + np.sum(row[1:] != row[:-1]) for row in curves["mode"].values)
    assert len(ax.collections) == expected


def test_mode_map_is_solved_states():
    contact = make_contact()
    ratio, loads = np.geomspace(0.5, 6, 9), np.geomspace(1e-6, 1e-3, 7)
    ax = plot.mode_map(contact, ratio=ratio, F_star=loads)
    shown = ax.collections[0].get_array().reshape(len(loads), len(ratio))
    seen = set()
    for i, size in enumerate(ratio):
        factor = size * 100e-9 / 300e-9
        one = contact.replace(**{MEAN: 300e-9 * factor, "particles.diameter.std": 24e-9 * factor})
        modes = tb.solve(one, F_star=loads).mode
        assert [MODES[k] for k in shown[:, i]] == list(modes)
        seen |= set(modes)
    assert seen == set(MODES)


def test_mode_map_leaves_jammed_sizes_white():
    ax = plot.mode_map(make_contact(), ratio=[1, 10, 50], F_star=[1e-6, 1e-5])
    shown = np.ma.getmaskarray(ax.collections[0].get_array()).reshape(2, 3)
    assert shown.tolist() == [[False, False, True]] * 2


def test_mode_map_solves_all_loads_of_a_size_at_once(monkeypatch):
    """What makes it quick; benchmarks/waiting.py measures it."""
    solve, solved = one_solve.solve, []

    def counting(contact, *, F_star):
        solved.append(len(F_star))
        return solve(contact, F_star=F_star)

    monkeypatch.setattr("thirdbody.views.plot.maps.solve", counting)
    plot.mode_map(make_contact(), ratio=np.geomspace(0.1, 5, 6), F_star=np.geomspace(1e-7, 1e-4, 7))
    assert solved == [7] * 6


def test_mistakes_are_named(curves):
    bare = make_contact(particles=None)
    for call, words in (
        (lambda: plot.mode_map(bare), "no particles"),
        (lambda: plot.mode_map(make_contact(), ratio=[2, 1]), "increasing"),
        (lambda: plot.regimes(curves), "holds 3"),
        (lambda: plot.area([1, 2, 3]), "Dataset from sweep"),
        (lambda: plot.area(curves.isel(F_star=0)), "none of them is a load"),
        (lambda: plot.area(curves, quantity="A_q"), "not in the data"),
        (lambda: plot.shares(curves, basis="weight"), "must be 'load' or 'area'"),
    ):
        with pytest.raises(tb.errors.InvalidValue, match=words):
            call()


def _as_seen_by(kind, colour):
    """Linear-light simulation of dichromacy at full severity, Machado et al. 2009."""
    matrix = {
        "protanopia": [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ],
        "deuteranopia": [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ],
        "normal": np.eye(3),
    }[kind]
    rgb = np.array(to_rgb(colour))
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    return np.clip(np.array(matrix) @ linear, 0, 1)


def _lab(linear):
    xyz = (
        np.array(
            [
                [0.4124564, 0.3575761, 0.1804375],
                [0.2126729, 0.7151522, 0.0721750],
                [0.0193339, 0.1191920, 0.9503041],
            ]
        )
        @ linear
        / [0.95047, 1, 1.08883]
    )
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


@pytest.mark.parametrize("kind", ["normal", "protanopia", "deuteranopia"])
def test_modes_can_be_told_apart_by_colour_blind_readers(kind):
    colours = [_lab(_as_seen_by(kind, colour)) for colour in plot.MODE_COLOURS.values()]
    for i in range(3):
        for j in range(i):
            assert np.linalg.norm(colours[i] - colours[j]) > 20


@pytest.mark.check
def test_pyplot_stays_untouched():
    code = (
        "import sys, numpy as np, thirdbody as tb\n"
        "from thirdbody.papers.seats import contact, figure\n"
        "tb.plot.mode_map(contact(3e-7), ratio=[1, 2, 3], F_star=[1e-6, 1e-4, 1e-3])\n"
        "tb.plot.modes(tb.solve(contact(3e-7), F_star=np.geomspace(1e-6, 1e-3, 9)))\n"
        "figure(loads=np.geomspace(1e-6, 1e-4, 5)).savefig(sys.stdout.buffer, format='svg')\n"
        "sys.exit('matplotlib.pyplot' in sys.modules)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert done.returncode == 0, done.stderr.decode()
    assert b"</svg>" in done.stdout


@pytest.mark.parametrize(
    ("low", "high"), [(1.7e-8, 1.5e-7), (2e-6, 8e-6), (0.3, 4.0), (1.5e-8, 2.5e-8), (3e-3, 30.0)]
)
def test_a_logarithmic_axis_has_three_numbers_that_stand_apart(low, high):
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from thirdbody.views.plot.style import plain_powers

    drawn = Figure(figsize=(4.6, 3.4), layout="constrained")
    FigureCanvasAgg(drawn)
    ax = drawn.add_subplot(xscale="log", xlim=(low, high))
    plain_powers(ax.xaxis)
    drawn.canvas.draw()
    labels = [*ax.xaxis.get_majorticklabels(), *ax.xaxis.get_minorticklabels()]
    seen = [
        label for label in labels if label.get_text() and low <= label.get_position()[0] <= high
    ]
    assert len(seen) >= 3
    boxes = sorted((label.get_window_extent().x0, label.get_window_extent().x1) for label in seen)
    assert all(end < start for (_, end), (start, _) in itertools.pairwise(boxes))


def test_long_labels_leave_width_to_bars_and_their_legend():
    """Names of several words break; the legend stands over the figure, within it."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    quartz = tb.Particles(
        material=tb.materials["quartz"],
        diameter=tb.distributions.Monodisperse(mean=3e-7),
        areal_density=1e9,
    )
    steel = tb.materials["S45C"]
    contact = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel), roughness=tb.Roughness(sigma=1e-7, R=2.8e-6),
        particles=quartz,
    )  # fmt: skip
    vary = {"particles.material.size_exponent": (0.5, 0.6), "roughness.eta_R_sigma": (0.03, 0.06)}
    found = tb.propagate(contact, vary=vary, pressure=5e6, samples=64, outputs=["A_t"])
    ax = plot.tornado(found, "A_t")
    drawn = ax.get_figure()
    FigureCanvasAgg(drawn)
    drawn.canvas.draw()
    width = drawn.bbox.width
    assert ax.get_window_extent().width > 0.5 * width
    (legend,) = drawn.legends
    box = legend.get_window_extent()
    assert 0 <= box.x0 < box.x1 <= width


def test_bands_of_faint_shares_are_drawn_on_a_logarithm():
    found = replace_bands(np.geomspace(1e-7, 1e-6, 15).reshape(5, 3))
    ax = plot.bands(found, "particle_load_share", mark=float(found.loads[-1]))
    assert ax.get_yscale() == "log"
    assert ax.get_xlim()[1] > found.loads[-1]  # the mark is seen
    found = replace_bands(np.linspace(0.1, 0.9, 15).reshape(5, 3))
    assert plot.bands(found, "particle_load_share").get_yscale() == "linear"


def replace_bands(band):
    """Data of `plot.bands` with these quantiles."""
    from types import SimpleNamespace

    return SimpleNamespace(
        bands={"particle_load_share": band}, nominal={"particle_load_share": band[:, 1]},
        loads=np.geomspace(1e6, 1e9, 5), load="pressure", probabilities=(0.05, 0.5, 0.95),
    )  # fmt: skip
