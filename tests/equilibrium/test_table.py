"""A contact as a table for other solvers: its errors, its ends, and every file it writes."""

import importlib.util
import math
import re
import shutil
import subprocess
from pathlib import Path

import command_line
import numpy as np
import pytest
from refusals import Mistake, refuses, warns_of
from scipy.integrate import quad
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

import thirdbody as tb
from thirdbody.contact.interface import interface
from thirdbody.equilibrium.table.writers import FORMATS, rounded_up

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
SIZES = {
    "sizes": tb.TruncatedGaussian(mean=300e-9, std=24e-9),
    "uniform": tb.distributions.Uniform(low=200e-9, high=350e-9),
    "one size": tb.distributions.Monodisperse(mean=300e-9),
}


def contact(law=None, heights=None, sizes=None, particle_law=None, **options):
    rough = {} if heights is None else {"heights": heights}
    dust = None
    if sizes is not None:
        dust = tb.Particles(material=SILICA, diameter=SIZES[sizes], areal_density=1e11)
    return tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6, **rough),
        asperity_law=law or tb.asperity.ZMC(),
        particles=dust,
        particle_law=particle_law,
        **options,
    )


PLANE = tb.particle.Series(deep="off", seat="plane")
CONTACTS = {
    "zmc": contact(),
    "ke": contact(tb.asperity.KE()),
    "ceb": contact(tb.asperity.CEB()),
    "bounded heights": contact(
        heights=tb.heights.HistogramHeights(edges=(0, 1, 2.5, 3, 5), counts=(1, 3, 4, 2))
    ),
    "rough seat": contact(sizes="sizes"),
    "plane seat": contact(sizes="sizes", particle_law=PLANE),
    "plane seat, uniform": contact(sizes="uniform", particle_law=PLANE),
    "plane seat, one size": contact(sizes="one size", particle_law=PLANE),
    "horng2022": contact(sizes="sizes", particle_law=tb.particle.Horng2022()),
}


def everywhere(table):
    """Dense places, the neighbours of every knot, and many places in every panel, also narrow."""
    rng = np.random.default_rng(5)
    x = [rng.uniform(table.h[0], table.h[-1], 20_000), table.h]
    x += [np.nextafter(table.h[1:-1], side) for side in (-1, 1)]
    x += [table.h[:-1] + np.diff(table.h) * s for s in rng.random(60)]
    return np.clip(np.concatenate(x), table.h[0], table.h[-1])


@pytest.fixture(scope="module")
def table():
    return tb.table(
        CONTACTS["rough seat"],
        tolerance=1e-5,
        columns=("particle_area_share", "particle_load_share"),
    )


# ---------------------------------------------------------------- errors
@pytest.mark.parametrize("tolerance", [1e-3, 1e-6])
@pytest.mark.parametrize("name", CONTACTS)
def test_the_stated_error_is_never_less_than_the_true_one(name, tolerance):
    made = tb.table(CONTACTS[name], tolerance=tolerance)
    assert max(made.error.p, made.error.A) <= tolerance
    x = everywhere(made)
    bound = interface(made.contact)
    d = x - bound.mean_plane
    fields = bound.fields(d)
    true = fields["F_ss"] + fields["F_sa"]
    assert np.abs(made.p(x) / true - 1).max() <= made.error.p
    assert np.abs(made.A(x) / fields["A_t"] - 1).max() <= made.error.A
    assert np.abs(made.dp_dh(x) / bound.load(d)[:, 1] - 1).max() <= made.error.dp_dh
    # nor is it idle talk: within a factor of what is met
    assert np.abs(made.p(x) / true - 1).max() > 0.2 * made.error.p


def test_the_slope_is_that_of_the_solved_loads():
    """dp/dh against differences of `solve`, which know nothing of analytic derivatives."""
    made = tb.table(CONTACTS["rough seat"], tolerance=1e-6)
    x = np.linspace(made.h[0], made.h[-1], 203)[1:-1]
    step = 1e-3 * made.contact.roughness.sigma_s
    shift = interface(made.contact).mean_plane
    p = [
        tb.solve(made.contact, d=x - shift + k * step).pressure / made.p(x) for k in (-2, -1, 1, 2)
    ]
    slope = (8 * (p[2] - p[1]) - (p[3] - p[0])) / (12 * step)
    true = slope * made.p(x)
    assert np.abs(made.dp_dh(x) / true - 1).max() <= made.error.dp_dh + 1e-8


def test_against_an_integral_of_hertz_over_gaussian_heights():
    """Greenwood and Williamson's load, integrated here."""
    made = tb.table(contact(tb.asperity.GW()), tolerance=1e-8)
    rough, E = made.contact.roughness, made.contact.E_ss
    for h in np.linspace(made.h[0], made.h[-1], 9):
        d = (h - rough.y_s) / rough.sigma_s

        def integrand(u, d=d):
            z = u * u
            return 2 * u * z**1.5 * math.exp(-0.5 * z * z - d * z)

        whole = quad(integrand, 0, 4.5, epsabs=0, epsrel=1e-12, limit=200)[0]
        whole *= math.exp(-0.5 * d * d) / math.sqrt(2 * math.pi)
        true = rough.density * 4 / 3 * E * math.sqrt(rough.R) * rough.sigma_s**1.5 * whole
        assert made.p(h) == pytest.approx(true, rel=made.error.p)


def test_exponential_heights_give_an_exponential():
    """p ∝ exp(−d/σ_s) exactly: the table, its slope and its tail are exact."""
    made = tb.table(
        contact(tb.asperity.GW(), tb.heights.ExponentialHeights()), low=2e-7, tolerance=1e-8
    )
    sigma_s = made.contact.roughness.sigma_s
    x = np.linspace(2e-7, made.h[-1] + 3 * sigma_s, 1000)
    assert made.p(x) == pytest.approx(made.p(2e-7) * np.exp(-(x - 2e-7) / sigma_s), rel=1e-11)
    assert made.dp_dh(x) == pytest.approx(-made.p(x) / sigma_s, rel=1e-11)
    assert len(made.h) < 100


def test_a_written_bound_is_not_rounded_down():
    x = 10 ** np.random.default_rng(3).uniform(-12, 3, 3000)
    written = np.array([float(rounded_up(v)) for v in x])
    assert np.all((written >= x) & (written <= 1.012 * x))


def test_shares(table):
    x = everywhere(table)
    state = interface(table.contact).fields(x - interface(table.contact).mean_plane)
    area = state["A_sa"] / state["A_t"]
    load = state["F_sa"] / (state["F_ss"] + state["F_sa"])
    assert table.error.shares <= 1e-5
    assert np.abs(table.share("particle_area_share", x) - area).max() <= table.error.shares
    assert np.abs(table.share("particle_load_share", x) - load).max() <= table.error.shares
    with refuses(Mistake.UNKNOWN, "share", says="'A_ss'"):
        table.share("A_ss", x)


# ---------------------------------------------------------------- C1, and the ends
@pytest.mark.parametrize("name", ["zmc", "plane seat, one size", "horng2022"])
def test_value_and_slope_are_continuous(name):
    made = tb.table(CONTACTS[name], tolerance=1e-4)
    for part in (made._p, made._A):
        # the right end of each panel against the left end of the next
        value = part.left * np.exp(part.c.sum(axis=1))
        assert value == pytest.approx(part.at_knots()[1:], rel=1e-14)
        slope = part.c @ [1, 2, 3] / part.width
        following = np.append(part.c[1:, 0] / part.width[1:], part.tail)
        assert slope == pytest.approx(following, rel=1e-11)
    for end in made.h[[0, -1]]:
        for f in (made.p, made.dp_dh, made.A, made.dA_dh):
            assert f(end - 1e-20) == pytest.approx(f(end + 1e-20), rel=1e-10)


def test_the_slope_is_the_derivative_of_the_table(table):
    nodes, weights = np.polynomial.legendre.leggauss(12)
    a, b = table.h[:-1], table.h[1:]
    x = 0.5 * (a + b)[:, None] + 0.5 * (b - a)[:, None] * nodes
    for f, slope in ((table.p, table.dp_dh), (table.A, table.dA_dh)):
        rise = (slope(x) @ weights) * 0.5 * (b - a)
        assert rise == pytest.approx(f(b) - f(a), rel=1e-9)


def test_beyond_the_ends(table):
    low, high = table.h[[0, -1]]
    above = np.linspace(high, high + 2e-7, 50)
    true = interface(table.contact).load(above - interface(table.contact).mean_plane)[:, 0]
    assert np.abs(table.p(above) - true).max() <= table.error.above
    assert np.all(np.diff(table.p(above)) < 0)
    assert table.p(high + 1e-3) >= 0
    assert table.p(low - 1e-8) == pytest.approx(table.p(low) - 1e-8 * table.dp_dh(low), rel=1e-12)
    assert table.dp_dh(low - 1e-8) == table.dp_dh(low - 1e-9)
    assert math.isnan(table.p(math.nan))
    assert isinstance(table.p(high), float)
    assert table.p(np.zeros((2, 3)) + high).shape == (2, 3)


def test_range_and_coordinates():
    made = tb.table(CONTACTS["zmc"])
    shift = interface(made.contact).mean_plane
    assert made.A(made.h[0]) == pytest.approx(0.2, rel=1e-9)
    assert made.p(made.h[-1]) == pytest.approx(1e-9 * made.contact.E_ss, rel=1e-9)
    by_d = tb.table(made.contact, coordinate="d")
    assert by_d.h == pytest.approx(made.h - shift, rel=1e-12, abs=1e-20)
    assert by_d.p(1e-7) == pytest.approx(made.p(1e-7 + shift), rel=1e-12)
    part = tb.table(made.contact, low=1e-7, high=2e-7)
    assert part.h[[0, -1]].tolist() == [1e-7, 2e-7]
    with warns_of("area.close", says="A_t reaches 0.2"):
        deep = tb.table(made.contact, low=0.0)
    assert any("Validity: A_t reaches" in line for line in deep.about())


# ---------------------------------------------------------------- refusals
@pytest.mark.parametrize(
    ("options", "refusal"),
    [
        ({"low": 3e-7, "high": 2e-7}, refuses(Mistake.ORDER, "low", value="3e-07")),
        ({"low": "50 nm"}, refuses(Mistake.KIND, "low", value="'50 nm'")),
        ({"high": math.nan}, refuses(Mistake.KIND, "high", value="nan")),
        ({"tolerance": 0}, refuses(Mistake.RANGE, "tolerance", value="0")),
        ({"coordinate": "gap"}, refuses(Mistake.OPTION, "coordinate", value="'gap'")),
        ({"columns": "A"}, refuses(Mistake.KIND, "columns", value="'A'")),
        ({"columns": ["A_ss"]}, refuses(Mistake.OPTION, "columns", says="'A_ss'")),
        ({"low": -1e-6}, refuses(Mistake.RANGE, "low", says="-3")),
        ({"high": 1e-5}, refuses(Mistake.BEYOND, "high")),
    ],
)
def test_bad_requests_are_refused(options, refusal):
    with refusal:
        tb.table(CONTACTS["zmc"], **options)


def test_a_rising_pressure_is_refused_and_the_branch_of_approach_is_the_default():
    law = tb.particle.Horng2022(preset="window_E2")
    odd = contact(sizes="sizes", particle_law=law)
    with refuses(Mistake.BEYOND, "", says="3.059e-07"):
        tb.table(odd, low=2e-7)
    made = tb.table(odd, tolerance=1e-3)
    x = np.linspace(made.h[0], made.h[-1], 5000)
    assert np.all(np.diff(made.p(x)) < 0)
    assert made.h[0] > 3.3e-7


def test_jumps_are_refused():
    one = contact(sizes="one size", particle_law=tb.particle.Horng2022())
    with refuses(Mistake.BEYOND, "", says="p jumps by 0.289 "):
        tb.table(one)
    law = tb.particle.Series(deep="off", seat="plane", law=tb.asperity.KE())
    broken = contact(sizes="one size", particle_law=law)
    with refuses(Mistake.BEYOND, "", says="A_t jumps by 0.0261 "):
        tb.table(broken)


def test_attraction_is_refused():
    rubber = tb.Material(E=2e6, nu=0.49, H=1e6)
    sticky = tb.Contact(
        surfaces=tb.MaterialPair(rubber, rubber),
        roughness=tb.Roughness(sigma=1e-6, R=100e-6),
        asperity_law=tb.asperity.DMT(w=0.05),
    )
    with refuses(Mistake.BEYOND, "high", says="h = 1e-06 m"):
        tb.table(sticky, high=1e-6)
    made = tb.table(sticky, tolerance=1e-3)
    pull, d = tb.equilibria.pull_off(sticky)
    assert made.error.above > pull - made.p(d + interface(sticky).mean_plane) > 1e3
    sticky = sticky.replace(asperity_law=tb.asperity.JKR(w=0.05, unloading=True))
    with refuses(Mistake.BEYOND, "", says="A_t is above 0.2 "):
        tb.table(sticky)


# ---------------------------------------------------------------- files
def rows(path, comment, **options):
    text = path.read_text("ascii")
    assert all(line.startswith(comment) for line in text.splitlines()[:5])
    return np.loadtxt(path, comments=comment, **options)


def loads(made, x):
    return interface(made.contact).load(np.asarray(x) - interface(made.contact).mean_plane)[:, 0]


def test_every_file_says_what_it_is(table, tmp_path):
    for name, (write, suffix) in FORMATS.items():
        path, again = tmp_path / f"one{suffix}", tmp_path / f"two{suffix}"
        write(table, path)
        write(table, again)
        assert path.read_bytes() == again.read_bytes(), name
        text = " ".join(path.read_text("ascii").split())
        said = [
            f"thirdbody {tb.__version__}",
            "mean plane of the surface heights",
            "Pressure p [Pa]",
        ]
        said += [
            "upper bounds",
            f"p {rounded_up(table.error.p)}",
            "decay exponentially",
            "tangents",
        ]
        said += ["roughness.sigma = 1e-07", "particles.areal_density", "doi:10.1115/1.555332"]
        for words in said:
            assert words in text, (name, words)
        assert max(map(len, path.read_text("ascii").splitlines())) < 256


def test_csv_is_the_whole_table(table, tmp_path):
    path = tmp_path / "t.csv"
    table.to_csv(path)
    text = [line for line in path.read_text("ascii").splitlines() if not line.startswith("#")]
    heads = text[0].split(",")
    data = np.array([line.split(",") for line in text[1:]], dtype=float)
    column = dict(zip(heads, data.T, strict=True))
    h, p, slope = column["h [m]"], column["p [Pa]"], column["dp_dh [Pa/m]"]
    x = np.linspace(h[0], h[-1], 3000)
    assert np.exp(CubicHermiteSpline(h, np.log(p), slope / p)(x)) == pytest.approx(
        table.p(x), rel=1e-12
    )
    assert column["particle_load_share [1]"] == pytest.approx(
        table.share("particle_load_share", h), abs=1e-15
    )


def test_abaqus(table, tmp_path):
    path = tmp_path / "t.inp"
    table.to_abaqus(path, tolerance=1e-3)
    lines = [line for line in path.read_text("ascii").splitlines() if not line.startswith("**")]
    assert lines[:2] == [
        "*SURFACE INTERACTION, NAME=ROUGH",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR",
    ]
    p, over = np.array([line.split(",") for line in lines[2:]], dtype=float).T
    assert p[0] == 0
    assert np.all(np.diff(p) > 0)
    assert np.all(np.diff(over) > 0)
    # Abaqus: straight lines, the last one goes on
    h = np.linspace(table.h[0] * 1.0001, table.h[-1], 20_000)
    met = np.abs(np.interp(-h, over, p) / loads(table, h) - 1).max()
    assert 3e-4 < met <= 1e-3 + table.error.p
    assert all(len(item.strip()) <= 20 for line in lines[2:] for item in line.split(","))
    table.to_abaqus(path, units="mm", datum=1e-7, name="A-1")
    text = path.read_text("ascii")
    assert "NAME=A-1" in text
    assert "Overclosure [mm] is 1e-07 m minus h; pressure in MPa." in text
    last = np.array(text.splitlines()[-1].split(","), dtype=float)
    assert last == pytest.approx([p[-1] * 1e-6, (1e-7 + over[-1]) * 1e3], rel=1e-11)
    for bad in ({"units": "inch"}, {"name": "a, b"}, {"tolerance": 0}, {"datum": 1e6}):
        with pytest.raises(tb.errors.InvalidValue, match=next(iter(bad))):
            table.to_abaqus(tmp_path / "bad.inp", **bad)
    assert not (tmp_path / "bad.inp").exists()


def test_comsol(table, tmp_path):
    path = tmp_path / "t.txt"
    table.to_comsol(path)
    h, ln_p, p, A, area_share, load_share = rows(path, "%").T
    assert np.exp(ln_p) == pytest.approx(p, rel=1e-13)
    assert [table.A(h), table.share("particle_area_share", h)] == [
        pytest.approx(A),
        pytest.approx(area_share),
    ]
    assert np.all((load_share >= -1e-4) & (load_share <= 1 + 1e-4))
    x = np.linspace(h[0], h[-1], 20_000)
    true = loads(table, x)
    assert np.abs(np.exp(np.interp(x, h, ln_p)) / true - 1).max() <= 1e-4 + table.error.p
    # a monotone piecewise cubic, as such programs have
    assert np.abs(np.exp(PchipInterpolator(h, ln_p)(x)) / true - 1).max() <= 1e-4


def test_avl(table, tmp_path):
    path = tmp_path / "t.avl"
    table.to_avl(path)
    gap, p = rows(path, "#", delimiter="\t").T
    h = np.linspace(table.h[0], table.h[-1], 20_000)
    met = np.abs(np.interp(h * 1e3, gap, p) * 1e6 / loads(table, h) - 1).max()
    assert met <= 1e-3 + table.error.p
    table.to_avl(path, units="SI")
    assert rows(path, "#", delimiter="\t")[0] == pytest.approx([gap[0] / 1e3, p[0] * 1e6])


def outside_too(made):
    span = made.h[-1] - made.h[0]
    x = np.linspace(made.h[0] - 0.2 * span, made.h[-1] + 0.3 * span, 4001)
    return np.concatenate([x, made.h, np.nextafter(made.h, -1), np.nextafter(made.h, 1)])


@pytest.mark.parametrize("name", ["rough seat", "plane seat, one size"])
def test_python_snippet(name, tmp_path):
    made = tb.table(CONTACTS[name], tolerance=1e-5)
    path = tmp_path / "law.py"
    made.to_python(path)
    assert "import numpy" not in path.read_text("ascii")
    spec = importlib.util.spec_from_file_location("law", path)
    law = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(law)
    x = outside_too(made)
    for f, g in ((law.pressure, made.p), (law.area, made.A), (law.stiffness, made.dp_dh)):
        sign = -1 if f is law.stiffness else 1
        assert [f(float(v)) for v in x] == pytest.approx(sign * g(x), rel=1e-14, abs=0)
    assert math.isnan(law.pressure(math.nan))


MAIN = """
#include <stdio.h>
double pressure(double h); double area(double h); double stiffness(double h);
int main(void)
{
    double h;
    while (scanf("%lf", &h) == 1)
        printf("%.17g %.17g %.17g\\n", pressure(h), area(h), stiffness(h));
    return 0;
}
"""


@pytest.mark.parametrize("name", ["rough seat", "plane seat, one size"])
def test_c_snippet(name, tmp_path):
    compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if compiler is None:
        pytest.skip("no C compiler (cc, gcc, clang) on this machine")
    made = tb.table(CONTACTS[name], tolerance=1e-5)
    made.to_c(tmp_path / "law.c")
    (tmp_path / "main.c").write_text(MAIN)
    strict = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror"]
    built = subprocess.run(
        [compiler, *strict, "law.c", "main.c", "-o", "law", "-lm"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert built.returncode == 0, built.stderr
    x = outside_too(made)
    done = subprocess.run(
        [tmp_path / "law"],
        input="\n".join(map(repr, x.tolist())),
        capture_output=True,
        text=True,
        check=True,
    )
    p, A, k = np.array([line.split() for line in done.stdout.splitlines()], dtype=float).T
    assert p == pytest.approx(made.p(x), rel=1e-14, abs=0)
    assert A == pytest.approx(made.A(x), rel=1e-14, abs=0)
    assert k == pytest.approx(-made.dp_dh(x), rel=1e-14, abs=0)


def test_no_name_breaks_out_of_a_comment(tmp_path):
    """Texts of the user stand in comments of seven languages."""
    evil = "Bölcs µ */ \n#error x\r\n*STEP\u2028import os \\\\\\ ??/ ???/ \x0c end\\"
    body = tb.Material(E=2e11, nu=0.3, H=2e9, name=evil, source=evil)
    made = tb.table(
        tb.Contact(
            surfaces=tb.MaterialPair(body, STEEL), roughness=tb.Roughness(sigma=1e-7, R=3e-6)
        ),
        tolerance=1e-2,
    )
    marks = dict(csv="#", abaqus="**", comsol="%", avl="#", python="#", c="//")
    for name, (write, suffix) in FORMATS.items():
        path = tmp_path / f"evil{suffix}"
        write(made, path)
        lines = path.read_bytes().decode("ascii").split("\n")
        head = lines[: next(i for i, line in enumerate(lines) if not line.startswith(marks[name]))]
        assert any("Bolcs u" in line for line in head)
        assert not any("STEP" in line or "#error" in line for line in lines[len(head) :])
        assert not any(line.endswith("\\") or "??" in line for line in head)


def test_the_page_runs(tmp_path, monkeypatch):
    page = (Path(__file__).parents[2] / "docs" / "tables.md").read_text("utf-8")
    monkeypatch.chdir(tmp_path)
    names = {}
    for code in re.findall(r"^```python\n(.*?)^```$", page, re.S | re.M):
        exec(code, names)
    written = sorted(path.name for path in tmp_path.iterdir())
    assert written == ["contact.avl", "contact.inp", "contact.txt", "law.c", "law.csv", "law.py"]


# ---------------------------------------------------------------- command line
STUDY = """
[surfaces]
first = "S45C"
second = "S45C"
[roughness]
sigma = "100 nm"
R = "2.8 um"
[load]
pressure = "5 MPa"
"""


@pytest.fixture
def study(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(STUDY)
    return path


def run(*words):
    return command_line.run("table", *words)


@pytest.mark.parametrize("name", FORMATS)
def test_command_knows_the_format_by_its_suffix(name, study, tmp_path):
    write, suffix = FORMATS[name]
    out, same = tmp_path / f"out{suffix}", tmp_path / "same"
    done = run(study, "--out", out, "--tolerance", "1e-4", "--from", "50 nm", "--to", "0.4 um")
    assert done.exit_code == 0, done.stderr
    assert "relative errors of at most" in done.stdout
    assert "the pressure goes from" in done.stdout
    write(tb.table(CONTACTS["zmc"], low=50e-9, high=0.4e-6, tolerance=1e-4), same)
    assert out.read_bytes() == same.read_bytes()


def test_command_refuses(study, tmp_path):
    def problems(*words):
        return command_line.refused("table", study, *words).problems

    (suffix,) = problems("--out", "t.dat")
    assert suffix.code is Mistake.MISSING
    assert "--out t.dat" in suffix
    units, pressure = problems("--out", "t.csv", "--units", "mm", "--from", "3 GPa")
    assert units.code is Mistake.IDLE
    assert "--units mm" in units
    assert (pressure.code, pressure.place) == (Mistake.UNIT, "--from")
    (form,) = problems("--out", "t.csv", "--format", "xls")
    assert form.code is Mistake.OPTION
    assert "--format xls" in form
    (tolerance,) = problems("--out", tmp_path / "t.c", "--tolerance", "0")
    told = (Mistake.RANGE, "tolerance", "0.0")
    assert (tolerance.code, tolerance.place, tolerance.value) == told
    assert not list(tmp_path.glob("*.c"))
    out = tmp_path / "a"
    assert run(study, "--out", out, "--format", "abaqus", "--units", "mm").exit_code == 0
    assert "Overclosure [mm]" in out.read_text()
