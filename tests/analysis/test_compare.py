"""One interface under every law: numbers, rows that fail, files, and the page of laws."""

import csv
import io
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from refusals import Mistake, refuses
from typer.testing import CliRunner

import thirdbody as tb
from thirdbody import cli
from thirdbody.analysis.compare import csv_text
from thirdbody.quantities.say import number
from thirdbody.study import load_study
from thirdbody.views.comparison import figure, save
from thirdbody.views.laws_page import laws_page

ROOT = Path(__file__).parents[2]
CLEAN = ROOT / "examples" / "two_body_reference.toml"
DUSTY = ROOT / "examples" / "dusty_ball_screw.toml"
STEEL = tb.materials["S45C"]
LOADS = np.geomspace(1e-6, 1e-3, 7)
USUAL = ["zmc", "gw", "ceb", "ke", "jg", "field", "hermite"]
TIPS = [name for name in USUAL if name != "field"]


def contact(**changes):
    rough = tb.Roughness(sigma=100e-9, R=2.8e-6)
    return tb.Contact(surfaces=tb.MaterialPair(STEEL, STEEL), roughness=rough).replace(**changes)


def dusty():
    sizes = tb.TruncatedGaussian(mean=300e-9, std=24e-9)
    silica = tb.materials["SiO2"]
    return contact(particles=tb.Particles(material=silica, diameter=sizes, areal_density=1e11))


@pytest.fixture(scope="module")
def clean():
    return tb.compare(contact(), F_star=LOADS)


@pytest.fixture
def extra(monkeypatch):
    """A registry to which a test may add laws."""
    monkeypatch.setattr(
        tb.asperity.AbstractAsperityLaw, "registry", registry := dict(tb.asperity.REGISTRY)
    )
    monkeypatch.setattr(sys.modules["thirdbody.analysis.compare"], "REGISTRY", registry)
    return registry


# ---------------------------------------------------------------------------- numbers
@pytest.mark.parametrize("case", [contact(), dusty()], ids=["bare", "dusty"])
def test_rows_are_what_solve_gives(case):
    table = tb.compare(case, F_star=LOADS)
    assert table.law.values.tolist() == USUAL + ["persson"] * case.two_body
    assert table.A_t.dims == ("law", "F_star")
    own = tb.solve(case, F_star=LOADS)
    for name in USUAL:
        law = tb.asperity.REGISTRY[name]()
        state = tb.solve(case.replace(asperity_law=law), F_star=LOADS)
        row = table.sel(law=name)
        for column in ("d", "A_t", "A_e", "A_ep", "A_p"):
            np.testing.assert_array_equal(row[column], getattr(state, column))
        np.testing.assert_allclose(row.A_t_difference, 100 * (state.A_t / own.A_t - 1), atol=1e-12)
        np.testing.assert_allclose(row.mean_pressure, state.pressure / state.A_t, rtol=1e-14)
        gap = (state.d - own.d) / case.roughness.sigma
        np.testing.assert_allclose(row.d_star_difference, gap, atol=1e-12)
        shares = row.elastic_share + row.elastoplastic_share + row.plastic_share
        np.testing.assert_allclose(shares, 1, rtol=1e-12)
    assert ("particle_load_share" in table) is not case.two_body
    for variable in table.data_vars.values():
        assert {"units", "long_name", "symbol"} <= set(variable.attrs)


def test_what_each_law_believes(clean):
    assert np.all(clean.elastic_share.sel(law="gw") == 1)
    assert np.all(clean.elastoplastic_share.sel(law="ceb") == 0)
    assert np.all(clean.plastic_share.sel(law="jg") == 0)
    H, pressure = clean.attrs["hardness"], clean.mean_pressure
    assert np.all(pressure.sel(law="gw") > H)
    for law in ("zmc", "hermite", "ke"):
        assert np.all(pressure.sel(law=law) < H)
    nu = STEEL.nu
    assert np.all(pressure.sel(law="ceb") < (0.454 + 0.41 * nu) * H)


def test_pressure_is_the_same_comparison(clean):
    table = tb.compare(contact(), pressure=LOADS * contact().E_ss)
    assert table.A_t.dims == ("law", "pressure")
    np.testing.assert_allclose(table.A_t, clean.A_t, rtol=1e-10)
    np.testing.assert_allclose(table.F_star, LOADS, rtol=1e-14)


def test_elastic_limit():
    """Infinite hardness: every law of a tip is GW."""
    hard = tb.Material(E=205e9, nu=0.29, H=1e12)
    table = tb.compare(contact(surfaces=tb.MaterialPair(hard, hard)), F_star=LOADS, laws=TIPS)
    np.testing.assert_allclose(table.A_t_difference, 0, atol=1e-6)


@pytest.mark.parametrize(
    ("ratio_law", "circular"), [("elliptic-ceb", "ceb"), ("elliptic-zmc", "zmc")]
)
def test_elliptic_laws_equal_their_circular_ones(ratio_law, circular):
    table = tb.compare(contact(), F_star=LOADS, laws=[circular, ratio_law])
    np.testing.assert_allclose(
        table.A_t.sel(law=ratio_law), table.A_t.sel(law=circular), rtol=1e-12
    )


# ---------------------------------------------------------------------------- which laws
def test_own_law_comes_first_with_its_options():
    case = contact(asperity_law=tb.asperity.KE(K=0.6))
    table = tb.compare(case, F_star=1e-5, laws=["ke", "zmc", tb.asperity.KE(), "zmc"])
    assert table.law.values.tolist() == ["ke(K=0.6)", "zmc", "ke"]
    assert table.attrs["own_law"] == "ke(K=0.6)"
    assert '"K": 0.6' in table.options.values[0]
    assert "Kogut" in table.title.values[0]
    assert {"10.1115/1.1490373", "10.1115/1.555332"} <= set(
        re.findall(r"doi:(\S+)", table.attrs["citations"])
    )


def test_adhesive_and_elliptic_laws_when_asked():
    table = tb.compare(contact(), F_star=1e-5, laws=["jkr", "dmt", "elliptic-ceb"])
    assert table.law.values.tolist() == ["zmc", "jkr", "dmt", "elliptic-ceb"]
    assert set(table.status.values.ravel()) == {"ok"}
    note = table.note.sel(law="jkr").item()
    assert "w = 0.05 J/m², Tabor number 0.41" in note
    assert f": {tb.asperity.JKR.valid_range}" in note
    sticky = contact(asperity_law=tb.asperity.JKR(w=0.1, unloading=True))
    table = tb.compare(sticky, F_star=1e-5, laws="gw")
    assert table.law.values.tolist() == ["jkr(w=0.1, unloading=True)", "gw"]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (dict(F_star=1e-5, laws=["kee", "nonsense"]), ["'kee'", "did you mean 'ke'", "'nonsense'"]),
        (dict(F_star=1e-5, laws=[3]), ["3 names no asperity law"]),
        (dict(F_star=1e-5, laws=[]), ["laws is empty"]),
        (dict(), ["exactly one"]),
        (dict(F_star=1e-5, pressure=1e6), ["exactly one"]),
        (dict(F_star=-1.0), ["F_star = -1"]),
    ],
)
def test_mistakes(options, words):
    with pytest.raises(tb.errors.InvalidValue) as caught:
        tb.compare(contact(), **options)
    for word in words:
        assert word in str(caught.value)


# ---------------------------------------------------------------------------- rows that fail
def test_a_law_that_fails_keeps_its_row(extra):
    why = "its formula divides by zero"

    class Broken(tb.asperity.GW):
        name = "broken"
        title = "Broken"

        @property
        def branches(self):
            raise ZeroDivisionError(why)

    @dataclass(frozen=True, slots=True, kw_only=True)
    class Needy(tb.asperity.GW):
        name = "needy"
        title = "Needy"
        length: float

    table = tb.compare(contact(), F_star=LOADS, laws=["broken", "needy", "gw"])
    assert table.law.values.tolist() == ["zmc", "broken", "needy", "gw"]
    assert table.note.sel(law="broken").item() == f"failed: {why}"
    assert "give the law itself" in table.note.sel(law="needy").item()
    for law in ("broken", "needy"):
        assert np.all(np.isnan(table.A_t.sel(law=law)))
        assert np.all(table.status.sel(law=law) == table.note.sel(law=law))
    assert np.all(np.isfinite(table.A_t.sel(law="gw")))
    assert "broken" in csv_text(table)
    assert "no state" in [text.get_text() for text in figure(table).axes[3].texts]
    assert "broken" not in laws_page()


def test_a_state_without_equilibrium_keeps_its_place():
    table = tb.compare(contact(), F_star=[1e-5, 0.04], laws=["gw", "ceb"])
    zmc, gw = table.sel(law="zmc"), table.sel(law="gw")
    assert zmc.status.values[0] == "ok"
    assert "no equilibrium" in zmc.status.values[1]
    assert np.isnan(zmc.A_t.values[1])
    assert "1 state(s)" in zmc.note.item()
    assert zmc.status.values[1] in zmc.note.item()
    assert gw.status.values[1] == "ok"
    assert np.isnan(gw.A_t_difference.values[1])


def test_notes_say_where_a_law_leaves_its_range():
    table = tb.compare(contact(), F_star=[1e-6, 2e-2])
    note = {law: table.note.sel(law=law).item() for law in table.law.values}
    for law in ("jg", "gw"):
        assert re.search(rf"\d+ % .*{re.escape(tb.asperity.REGISTRY[law].beyond)}", note[law])
    assert note["zmc"] == note["hermite"] == ""
    assert "A_t reaches" in table.attrs["warnings"]
    soft = tb.Material(E=205e9, nu=0.29, H=0.5e9)
    table = tb.compare(contact(surfaces=tb.MaterialPair(soft, soft)), F_star=1e-4, laws="ke")
    assert "beyond ω = 110 ω_c" in table.note.sel(law="ke").item()


def test_elastic_laws_end_at_one_mean_pressure():
    """GW, DMT, JKR and Coated say the same of the same contact, where adhesion is slight."""
    same = tb.asperity.Coated(
        E_1=205e9, nu_1=0.29, t=1e-8, E_2=205e9, nu_2=0.29, E_3=205e9, nu_3=0.29
    )
    laws = ["gw", tb.asperity.DMT(w=1e-6), tb.asperity.JKR(w=1e-6), same]
    table = tb.compare(contact(), F_star=[1e-9], laws=laws)
    said = [re.search(r"(\d+) % of the asperities' area", text) for text in table.note.values[1:]]
    assert all(said)
    assert len({match[1] for match in said if match}) == 1
    # the part of the area above ω = (0.3πH/E*)²R, by sampling
    rough, E_star, H = contact().roughness, contact().E_ss, contact().surfaces.H
    rng = np.random.default_rng(3)
    h = float(tb.solve(contact(asperity_law=tb.asperity.GW()), F_star=1e-9).d) / rough.sigma_s
    z = -np.log(rng.random(400_000)) / h + h  # exponential proposal, weighted
    weight = np.exp(-0.5 * z * z + h * (z - h))
    omega = (z - h) * rough.sigma_s * weight
    first = (0.3 * np.pi * H / E_star) ** 2 * rough.R
    share = omega[(z - h) * rough.sigma_s > first].sum() / omega.sum()
    assert float(said[0][1]) == pytest.approx(100 * share, abs=1.0)


def test_share_beyond_the_fits_is_the_plastic_share_of_ke():
    soft = tb.Material(E=205e9, nu=0.29, H=0.5e9)
    case = contact(surfaces=tb.MaterialPair(soft, soft), asperity_law=tb.asperity.KE())
    table = tb.compare(case, F_star=1e-4, laws="zmc")
    said = float(re.search(r"([\d.]+) % of", table.note.values[0])[1])
    assert said == pytest.approx(100 * table.plastic_share.values[0, 0], abs=0.6)


# ---------------------------------------------------------------------------- files, figure
def test_csv_holds_every_number(clean):
    header, *rows = csv.reader(io.StringIO(csv_text(clean)))
    assert header[:3] == ["law", "F_star [1]", "pressure [Pa]"]
    assert len(rows) == clean.A_t.size
    column = [name.split(" [")[0] for name in header].index("A_t")
    found = np.array([float(row[column]) for row in rows]).reshape(clean.A_t.shape)
    np.testing.assert_array_equal(found, clean.A_t)


def test_figure_shows_the_data(clean):
    drawn = figure(clean)
    assert isinstance(drawn, Figure)
    pressure, area, separation, regimes = drawn.axes
    for ax, name, scale in (
        (pressure, "mean_pressure", 1e-9),
        (area, "A_t_difference", 1),
        (separation, "d_star_difference", 1),
    ):
        for law in USUAL:
            (line,) = [item for item in ax.lines if item.get_label() == law]
            np.testing.assert_allclose(line.get_ydata(), scale * clean[name].sel(law=law))
            np.testing.assert_array_equal(line.get_xdata(), LOADS)
        assert re.search(r"\[.+\]$", ax.get_xlabel())
        assert re.search(r"\[.+\]$", ax.get_ylabel())
    looks = {(line.get_color(), str(line.get_linestyle())) for line in area.lines[:6]}
    assert len(looks) == 6
    assert [label.get_text() for label in regimes.get_yticklabels()] == [*USUAL, "persson"]
    widths = np.array([bar.get_width() for bar in regimes.patches]).reshape(3, -1)
    np.testing.assert_allclose(widths.sum(axis=0), 100)
    np.testing.assert_allclose(widths[0], 100 * clean.elastic_share.values[:, 3])


def test_figure_of_one_load_has_points():
    drawn = figure(tb.compare(contact(), F_star=1e-5))
    assert drawn.axes[1].lines[0].get_marker() == "o"
    drawn.draw_without_rendering()


@pytest.mark.usefixtures("blank_pictures")
def test_files_appear_together_or_not_at_all(clean, tmp_path, monkeypatch):
    folder = tmp_path / "new" / "out"
    assert [path.name for path in save(clean, folder)] == [
        "compare.csv",
        "compare.png",
        "compare.svg",
    ]
    assert sorted(path.name for path in folder.iterdir()) == [
        "compare.csv",
        "compare.png",
        "compare.svg",
    ]
    assert (folder / "compare.csv").read_text("utf-8") == csv_text(clean)
    first = (folder / "compare.svg").read_bytes()
    save(clean, folder)
    assert (folder / "compare.svg").read_bytes() == first, "the same figure, the same bytes"

    def fail(self, name, **_):
        Path(name).write_bytes(b"half")
        raise RuntimeError("no ink")

    monkeypatch.setattr(Figure, "savefig", fail)
    other = tmp_path / "other"
    with pytest.raises(RuntimeError, match="no ink"):
        save(clean, other)
    assert list(other.iterdir()) == []
    (tmp_path / "file").write_text("x")
    with refuses(Mistake.UNWRITABLE, "", says="file: a file"):
        save(clean, tmp_path / "file")


# ---------------------------------------------------------------------------- command line
def run(*arguments):
    return CliRunner().invoke(cli.app, ["compare", *map(str, arguments)])


def rows_of(text):
    return [line.split()[0] for line in text.splitlines() if re.match(r" [a-z]+ ", line)]


def test_command_needs_no_labelled_arrays(tmp_path):
    """A table of plain columns takes neither xarray nor what that looks for."""
    code = (
        "import runpy, sys\n"
        f"sys.argv = ['thirdbody', 'compare', {str(CLEAN)!r}, '--csv', {str(tmp_path / 'c.csv')!r}]\n"
        "try:\n    runpy.run_module('thirdbody', run_name='__main__')\n"
        "except SystemExit as end:\n    assert not end.code, end.code\n"
        "print(*sys.modules, file=sys.stderr)\n"
    )
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    loaded = done.stderr.splitlines()[-1].split()
    assert "thirdbody.analysis.compare" in loaded
    # splines of the law "field" bring scipy.optimize
    assert not {"xarray", "pandas", "dask", "pint", "matplotlib"} & set(loaded)


@pytest.mark.usefixtures("blank_pictures")
def test_command_writes_every_number(tmp_path):
    """--csv is the table of --out, whichever load the study gives."""
    for load in ('load={pressure="3 MPa"}', "load={F_star=[1e-6, 1e-5]}"):
        folder, file = tmp_path / load[6:10], tmp_path / f"{load[6:10]}.csv"
        result = run(CLEAN, "--laws", "all", "--set", load, "--out", folder, "--csv", file)
        assert result.exit_code == 0, result.output
        assert f"written: {file}" in result.stderr
        assert file.read_bytes() == (folder / "compare.csv").read_bytes()
    assert run(CLEAN, "--csv", tmp_path / "none" / "c.csv").exit_code == 2


@pytest.mark.usefixtures("blank_pictures")
def test_command_prints_one_table(tmp_path):
    result = run(CLEAN, "--laws", "ke, jg", "--out", tmp_path / "out")
    assert result.exit_code == 0
    assert rows_of(result.stdout)[1:] == ["zmc", "ke", "jg"]
    assert "3 MPa (F* = 2.681×10⁻⁵)" in result.stdout
    assert "particles' load" not in " ".join(result.stdout.split())
    assert result.stderr.count("written: ") == 3
    assert len(list((tmp_path / "out").iterdir())) == 3
    table = tb.compare(load_study(CLEAN).contact, pressure=3e6, laws="jg")
    line = next(line for line in result.stdout.splitlines() if line.startswith(" jg "))
    assert f"{table.A_t_difference.values[1, 0]:+.1f} %" in line


def test_command_keeps_the_area_after_persson_apart_from_the_laws():
    """The range is that of laws of asperities; Persson's area stands against the elastic law."""
    answer = run(CLEAN).stdout.split("─")[0]
    areas = tb.compare(load_study(CLEAN).contact, pressure=3e6).A_t.squeeze()
    of_laws = areas.drop_sel(law="persson")
    ends = [of_laws.law.values[place].item() for place in (of_laws.argmin(), of_laws.argmax())]
    shown = [*ends, "persson", "gw"]
    assert re.findall(r"([\d.]+) %\s\(([a-z]+)\)", answer) == [
        (number(100 * areas.sel(law=law).item(), 3), law) for law in shown
    ]
    assert "persson" not in run(CLEAN, "--laws", "gw").stdout


def test_command_shows_a_load_that_no_law_carries():
    result = run(CLEAN, "--laws", "gw", "--at", "end", "--set", "load.F_star=[1e-5, 10.0]")
    assert result.exit_code == 0
    assert rows_of(result.stdout)[1:] == ["zmc", "gw"]


@pytest.mark.parametrize(("place", "load"), [("start", "0.0005"), ("end", "0.24")])
def test_command_shows_the_load_asked_for(place, load):
    result = run(DUSTY, "--laws", "gw", "--at", place, "--set", "load.F_star=[2.4e-4, 5e-7, 1e-5]")
    assert result.exit_code == 0
    assert f"(F* = {number(float(load) / 1000)})" in result.stdout
    assert "particles'" in result.stdout


def test_command_with_separations_compares_at_their_loads(tmp_path):
    file, apart = tmp_path / "a.csv", "load.separation=['200 nm', '100 nm']"
    result = run(CLEAN, "--laws", "gw", "--set", apart, "--csv", file)
    assert result.exit_code == 0
    rows = csv.DictReader(io.StringIO(file.read_text("utf-8")))
    loads = {float(row["F_star [1]"]) for row in rows}
    held = tb.solve(load_study(CLEAN).contact, d=[200e-9, 100e-9]).F_star
    assert sorted(loads) == pytest.approx(sorted(held), rel=1e-9)
    assert "warning: " in result.stderr
    assert re.search(r"zmc .* 1 ", result.stdout)


def test_command_all_laws():
    result = run(DUSTY, "--laws", "all", "--set", "load.F_star=1e-5")
    assert result.exit_code == 0
    assert all(re.search(rf"^ {name} ", result.stdout, re.M) for name in tb.asperity.REGISTRY)


@pytest.mark.parametrize(
    ("arguments", "status"),
    [
        (["--laws", "kee"], 2),
        (["--laws", ","], 2),
        (["--at", "top"], 2),
        (["--out", CLEAN], 2),
        (["--set", "roughness.sigma=-1"], 2),
        (["--set", "load.F_star=5e6"], 3),
        (["--set", "load.separation=1 m"], 3),
    ],
)
def test_command_exit_status(arguments, status):
    result = run(CLEAN, *arguments)
    assert result.exit_code == status
    assert result.stdout == ""
    assert re.search(r"^error: ", result.stderr, re.M)


@pytest.mark.check
def test_row_that_fails_is_shown_with_its_reason(extra, tmp_path):
    why = "divides by zero"

    class Broken(tb.asperity.GW):
        name = "broken"
        title = "Broken"

        @property
        def branches(self):
            raise ZeroDivisionError(f"its formula {why}")

    result = run(CLEAN, "--laws", "broken", "--out", tmp_path / "out")
    assert result.exit_code == 0
    assert re.search(r"^ broken +- +-", result.stdout, re.M)
    assert why in result.stdout
    assert (tmp_path / "out" / "compare.png").is_file()


# ---------------------------------------------------------------------------- pages
def test_page_of_laws_is_the_generated_one():
    page = (ROOT / "docs" / "laws.md").read_text("utf-8")
    assert page == laws_page(), "run: thirdbody laws --markdown > docs/laws.md"
    result = CliRunner().invoke(cli.app, ["laws", "--markdown"])
    assert (result.exit_code, result.stdout) == (0, page)


def test_page_has_every_law_with_its_jumps():
    page = laws_page()
    for name, law in tb.asperity.REGISTRY.items():
        if law.__module__.startswith("thirdbody."):
            (row,) = re.findall(rf"^\| `{name}` .*$", page, re.M)
            assert law.doi in row
            assert law.valid_range in row
    (ke,) = re.findall(r"^\| `ke` .*$", page, re.M)
    assert "1: F +3 %, A −7 %" in ke
    (jkr,) = re.findall(r"^\| `jkr` .*$", page, re.M)
    assert "F from 0 to −1.33 πwR" in jkr
    (smooth,) = re.findall(r"^\| `hermite` .*$", page, re.M)
    assert "| none |" in smooth


def test_numbers_of_the_choosing_page():
    text = (ROOT / "docs" / "choose-a-law.md").read_text("utf-8")
    table = tb.compare(load_study(CLEAN).contact, pressure=3e6)
    for law in TIPS:
        row = table.sel(law=law).isel(pressure=0)
        (line,) = re.findall(rf"^\| `{law}` \| \d.*$", text, re.M)
        cells = [cell.strip().replace("−", "-") for cell in line.strip("|").split("|")]
        exponent = int(np.floor(np.log10(float(row.A_t))))
        assert cells[1] == f"{float(row.A_t) / 10.0**exponent:.2f}e-{-exponent}"
        assert cells[2] == ("" if law == "zmc" else f"{float(row.A_t_difference):+.1f} %")
        assert cells[3] == f"{float(row.mean_pressure) / 1e9:.2f} GPa"
        assert cells[4] == f"{float(row.d_star):.3f} σ"
        assert cells[5].rstrip(" %") == f"{100 * float(row.elastic_share):.1f}".replace(
            "100.0", "100"
        )
    case = load_study(CLEAN).contact
    rough = case.roughness
    index = case.E_ss / case.surfaces.H * np.sqrt(rough.sigma_s / rough.R)
    assert f"the steel below has {index:.1f}" in " ".join(text.split())
    in_stages = table.sel(law=["zmc", "hermite", "ke", "jg"])
    assert float(in_stages.A_t.max() / in_stages.A_t.min()) < 1.22
    assert float(in_stages.d_star.max() - in_stages.d_star.min()) < 0.05
    tips = table.sel(law=TIPS)
    assert float(tips.d_star.max() - tips.d_star.min()) < 0.135


def test_python_of_the_choosing_page_runs():
    text = (ROOT / "docs" / "choose-a-law.md").read_text("utf-8")
    (code,) = re.findall(r"^```python\n(.*?)^```$", text, re.S | re.M)
    imports, *lines = filter(None, code.splitlines())
    assert imports == "import thirdbody as tb"
    for line in lines:
        assert isinstance(
            eval(line, {"tb": tb}), (tb.heights.Heights, tb.asperity.AbstractAsperityLaw)
        )
