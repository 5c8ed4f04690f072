"""What stands around the code: versions, links, scripts, and the examples in the pages."""

import ast
import json
import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from floors import floors

import thirdbody as tb

pytestmark = pytest.mark.check
ROOT = Path(__file__).parent.parent
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))


def run(*command, cwd=ROOT):
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def blocks(page, language):
    """The fenced blocks of one language ("" for plain ones), in order."""
    fences = re.findall(r"^```(\w*)\n(.*?)^```$", page.read_text("utf-8"), re.S | re.M)
    return [code for name, code in fences if name == language]


# ---------------------------------------------------------------- the table of files
def files_by_row():
    """The names of each row of the table in CONTRIBUTING, in order."""
    text = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    table = text.split("| in `src/thirdbody` | holds |\n|---|---|\n")[1].split("\n\n")[0]
    return [re.findall(r"`([^`]+)`", line.split("|")[1]) for line in table.splitlines()]


def test_the_table_of_files_is_the_tree():
    folder = Path(tb.__file__).parent
    named = [name for row in files_by_row() for name in row]
    assert len(named) == len(set(named))
    there = {path.name for path in folder.glob("*.py")} - {"__init__.py", "__main__.py"}
    there |= {f"{path.name}/" for path in folder.iterdir() if path.is_dir()} - {"__pycache__/"}
    assert set(named) == there


def imported_at_the_top(file, package):
    """Modules of the package that a file imports when it is itself imported."""
    where = (*package.split("."), *file.relative_to(Path(tb.__file__).parent).parts[:-1])
    for node in ast.parse(file.read_text("utf-8")).body:
        if isinstance(node, ast.ImportFrom) and node.level:
            base = where[: len(where) - node.level + 1]
            base += tuple(node.module.split(".")) if node.module else ()
            yield from ((*base, alias.name)[1] for alias in node.names if len(base) < 2)
            yield from base[1:2]


def test_imports_point_up_the_table_of_files():
    row = {re.sub(r"(\.py|/)$", "", n): i for i, names in enumerate(files_by_row()) for n in names}
    folder = Path(tb.__file__).parent
    seen = 0
    for file in sorted(folder.rglob("*.py")):
        here = file.relative_to(folder).parts[0].removesuffix(".py")
        if here not in row:
            continue  # the package itself, which gathers all
        for name in imported_at_the_top(file, "thirdbody"):
            if name in row:
                assert row[name] <= row[here], f"{file.relative_to(folder)} imports {name}"
                seen += 1
    assert seen > 300


# ---------------------------------------------------------------- what ships
def test_every_file_of_data_is_declared():
    folder = Path(tb.__file__).parent
    declared = PYPROJECT["tool"]["setuptools"]["package-data"]["thirdbody"]
    shipped = {path for pattern in declared for path in folder.glob(pattern) if path.is_file()}
    there = {path for path in (folder / "data").rglob("*") if path.is_file()}
    assert folder / "data" / "papers" / "horng2022.toml" in there
    assert {path for path in there if "__pycache__" not in path.parts} <= shipped


# ---------------------------------------------------------------- import
def test_import_is_light():
    code = "import sys, thirdbody; print(*sys.modules)"
    status, text = run(sys.executable, "-c", code, cwd=ROOT.parent)
    assert status == 0, text
    loaded = set(text.split())
    heavy = {"matplotlib", "xarray", "pandas", "pint", "typer", "rich"}
    assert not heavy & loaded


def test_public_names_exist():
    assert sorted(tb.__all__) == tb.__all__
    for name in tb.__all__:
        assert getattr(tb, name) is not None


# ---------------------------------------------------------------- versions
def test_one_version_everywhere():
    assert "version" in PYPROJECT["project"]["dynamic"]
    attribute = PYPROJECT["tool"]["setuptools"]["dynamic"]["version"]["attr"]
    assert attribute == "thirdbody.version.__version__"
    version = tb.__version__
    citation = (ROOT / "CITATION.cff").read_text("utf-8")
    released = re.search(r"^version: (.*)$", citation, re.M)[1]
    changes = (ROOT / "CHANGELOG.md").read_text("utf-8")
    if version.endswith(".dev0"):  # of the next release
        numbers = [tuple(map(int, v.removesuffix(".dev0").split("."))) for v in (released, version)]
        assert numbers[0] < numbers[1]
        assert "## [Unreleased]" in changes
    else:
        assert version == released
    assert f"## [{released}]" in changes


def test_licence_is_the_same_everywhere():
    assert "license: BSD-3-Clause" in (ROOT / "CITATION.cff").read_text("utf-8")
    assert PYPROJECT["project"]["license"] == "BSD-3-Clause"
    assert "BSD 3-Clause" in (ROOT / "LICENSE").read_text("utf-8")


# ---------------------------------------------------------------- pages
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    targets = re.findall(r"\]\((?!https?://)([^)#]+)", page.read_text("utf-8"))
    missing = [target for target in targets if not (page.parent / target).exists()]
    assert not missing


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_tables_have_equal_rows(page):
    rows = []
    for line in [*page.read_text("utf-8").splitlines(), ""]:
        if line.startswith("|"):
            rows.append(len(re.findall(r"(?<!\\)\|", line)))
        elif rows:
            assert len(set(rows)) == 1, f"{page.name}: ragged table before {line!r}"
            rows = []


def test_figures_are_small():
    figures = list((ROOT / "docs" / "figures").glob("*.png"))
    assert figures
    assert {f.name for f in figures if f.stat().st_size > 150_000} == set()


def test_nomenclature_names_every_column():
    text = (ROOT / "docs" / "nomenclature.md").read_text("utf-8")
    from thirdbody.equilibrium.columns import COLUMNS

    own_words = {"status", "residual", "iterations"}
    missing = [name for name in COLUMNS if f"`{name}`" not in text and name not in own_words]
    assert not missing


def test_pages_name_every_preset_and_seat():
    text = (ROOT / "docs" / "choose-a-model.md").read_text("utf-8")
    assert [name for name in tb.particle.PRESETS if f"`{name}`" not in text] == []


def test_readme_python_runs_and_prints_what_it_says(capsys):
    (code,) = blocks(ROOT / "README.md", "python")
    exec(code, {})
    assert capsys.readouterr().out in blocks(ROOT / "README.md", "")


def test_readme_is_short():
    assert len((ROOT / "README.md").read_text("utf-8").splitlines()) < 150


def test_study_file_of_the_reference_solves(tmp_path):
    study = blocks(ROOT / "docs" / "study-file.md", "toml")[0]
    file = tmp_path / "dust.toml"
    file.write_text(study, "utf-8")
    command = [sys.executable, "-m", "thirdbody", "solve", str(file), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    result = json.loads(done.stdout)
    assert result["title"] == "Dust in a ball-screw nut"
    assert len(result["states"]["A_t"]) == 60
    assert set(result["states"]["status"]) == {"ok"}


COMMANDS = (
    "thirdbody solve drawing.toml",
    "thirdbody new ball-screw",
    'thirdbody solve ball-screw.toml --set load.force="3 kN"',
    "thirdbody compare ball-screw.toml --csv laws.csv",
    "thirdbody solve ball-screw.toml --import my_law.py",
)


def test_readme_study_from_a_drawing(tmp_path, monkeypatch):
    """The file solves, and so do the commands of the book beside it, with a law of one's own."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")
    (study,) = blocks(ROOT / "README.md", "toml")
    (tmp_path / "drawing.toml").write_text(study, "utf-8")
    law = blocks(ROOT / "docs" / "add-a-law.md", "python")[0]
    (tmp_path / "my_law.py").write_text(law, "utf-8")
    for line in COMMANDS:
        command = [sys.executable, "-m", *shlex.split(line)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, f"{line}\n{done.stderr}"
    left = {path.name for path in tmp_path.iterdir() if path.suffix in (".toml", ".csv")}
    assert left == {"drawing.toml", "ball-screw.toml", "laws.csv"}


@pytest.mark.slow
def test_the_map_of_the_theory_page_is_drawn(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (code,) = blocks(ROOT / "docs" / "theory.md", "python")
    exec(code, {})
    assert (tmp_path / "mode_map.png").stat().st_size > 10_000


def test_choosing_pages_name_laws_that_exist():
    for page in ("choose-a-model.md", "choose-a-seat.md"):
        for code in blocks(ROOT / "docs" / page, "python"):
            for line in code.splitlines():
                exec(line, {"tb": tb})


def test_the_law_of_the_guide_works():
    code = blocks(ROOT / "docs" / "add-a-law.md", "python")[0]
    check = (
        "import numpy as np\nimport thirdbody as tb\n"
        "assert tb.asperity.REGISTRY['abrupt'] is Abrupt\n"
        "steel = tb.materials['S45C']\n"
        "contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel), asperity_law=Abrupt(),\n"
        "                     roughness=tb.Roughness(sigma=1e-7, R=3e-6))\n"
        "state = tb.solve(contact, F_star=np.geomspace(1e-6, 1e-4, 5))\n"
        "assert np.all(state.residual < 1e-12)\n"
        "law = Abrupt()\n"
        "assert tb.asperity.ZMC.from_dict(law.to_dict()) == law\n"
        "jump = law.reduced('force', 1.0) / law.reduced('force', 1 - 1e-12) - 1\n"
        "assert abs(jump - law.jumps[1.0].force) < 1e-9\n"
    )
    status, text = run(sys.executable, "-c", code + check)
    assert status == 0, text


# ---------------------------------------------------------------- the numbers of the errata
def test_numbers_of_the_errata():
    """Each number in the page, from its formula."""
    text = (ROOT / "docs" / "errata.md").read_text("utf-8").replace("\n", " ")
    steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    pair = tb.MaterialPair(steel, steel)
    E_ss, E_sa, H = pair.E_star, tb.MaterialPair(steel, silica).E_star, steel.H

    def C(first, second, convention=1):
        ratios = (H / (convention * first)) ** 2 + (H / (convention * second)) ** 2
        return 9 * np.pi**2 / 4 * ratios

    law = tb.asperity.ZMC()
    stiffness = [float(law.reduced("stiffness", y)) for y in (1 - 1e-9, 1, 54 - 1e-9, 54)]
    contact = tb.Contact(surfaces=pair, roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    nominal = 5.1e-5 * E_ss
    plastic = [np.pi / 2 * H * 1e11 * 300e-9 * (300e-9 - d) for d in (274e-9, 250e-9, 174e-9)]
    sizes = tb.TruncatedGaussian(mean=1.0, std=0.2, n=4)
    tail = sizes.partial_moment(2, 1.4, 9) / sizes.partial_moment(0, 1.4, 9)
    said = {
        "= 111.91$ GPa": E_ss / 1e9,
        "= 53.64$ GPa": E_sa / 1e9,
        "400^{2/3} = 54.3": 400 ** (2 / 3),
        "0.600 to 0.550": stiffness[0],
        "0.550 and": stiffness[1],
        "2.301 to 2.000": stiffness[2],
        "1.009\\,\\sigma": contact.roughness.y_s / 100e-9,
        "0.02036\\sqrt\\alpha": 3 / 8 / (6 * np.sqrt(3 * np.pi)),
        "four times too large: 0.237 for": C(E_sa, E_ss),
        "(0.0593 with": C(E_sa, E_ss, 2),
        "0.0887 for S45C": C(E_ss, E_ss),
        "(0.0222)": C(E_ss, E_ss, 2),
        "0.237 to 0.386": C(E_sa, E_ss),
        "to 0.386": C(E_sa, E_sa),
        "0.0593 to 0.0965": C(E_sa, E_ss, 2),
        "to 0.0965": C(E_sa, E_sa, 2),
        "factor 2.68": C(E_sa, E_ss) / C(E_ss, E_ss),
        "2.2 times $x_a^2$": tail,
        "15.7 % for 1000 nm": 100 * np.pi / 2 * 1e11 * 1e-12,
        "pressure is 5.7 MPa": nominal / 1e6,
        "| 6.1 MPa": plastic[0] / 1e6,
        "| 11.8 MPa": plastic[1] / 1e6,
        "| 29.7 MPa": plastic[2] / 1e6,
        "| 70.7 MPa": np.pi / 2 * H * 1e11 * 300e-9**2 / 1e6,
        "= 0.968$": 1.03 - np.log10(22 / 15) / 2.70,
        "8.3-fold": 10 ** ((1.03 - 0.69) * 2.70),
        "makes it 2.98 mm²": 80 / (2.4e-4 * E_ss) * 1e6,
        "1.49 mm²": 80 / (2.4e-4 * 2 * E_ss) * 1e6,
    }
    for words, value in said.items():
        assert words in text, f"the page no longer says {words!r}"
        # the number in the words that lies nearest, compared at its own number of digits
        numbers = re.findall(r"(?<![\d.])\d+\.\d+(?!\d)", words)
        digits = [len(number.split(".")[1]) for number in numbers]
        assert any(
            abs(value - float(number)) <= 0.5001 * 10.0**-places
            for number, places in zip(numbers, digits, strict=True)
        ), f"{words!r}: recomputed {value:.5g}"


def test_ranges_of_the_errata():
    steel = tb.materials["S45C"]
    pair = tb.MaterialPair(steel, steel)

    def two_body(R, loads):
        rough = tb.Roughness(sigma=100e-9, R=R)
        return tb.solve(tb.Contact(surfaces=pair, roughness=rough), F_star=loads)

    # item 19: 1.6–1.9 σ above the asperities, 2.6–2.9 above the surface
    ends = [two_body(R, 5.1e-5) for R in (10e-6, 1e-6)]
    assert [round(float(s.d_star), 1) for s in ends] == [1.6, 1.9]
    assert [round(float(s.h / 100e-9), 1) for s in ends] == [2.6, 2.9]
    # items 20 and 21
    loads = np.geomspace(4.8e-7, 2.4e-4, 60)
    for R, press, low, high, slope in (
        (2.8e-6, steel.H, 0.70, 0.79, 0.981),
        (11.1e-6, 12.7e9, 0.19, 0.23, 0.973),
    ):
        s = two_body(R, loads)
        ratio = s.pressure / s.A_t / press
        assert [round(ratio.min(), 2), round(ratio.max(), 2)] == [low, high]
        assert np.max(s.A_e / s.A_t) < 0.20
        fit = np.polyfit(np.log(loads), np.log(s.A_t), 1)[0]
        assert round(fit, 3) == slope


def test_consequences_in_the_errata():
    steel = tb.materials["S45C"]
    critical = {}
    for name in ("SiO2", "S45C"):
        dust = tb.Particles(
            material=tb.materials[name],
            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
            areal_density=1e11,
        )
        contact = tb.Contact(
            surfaces=tb.MaterialPair(steel, steel),
            roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
            particles=dust,
            particle_law=tb.particle.Series(deep="off"),
        )
        critical[name] = tb.transitions(contact)
        assert critical[name].F_tpca.A.value is None
    assert critical["SiO2"].F_cr1.value == pytest.approx(7.2e-6, abs=0.05e-6)
    assert critical["S45C"].F_cr1.value == pytest.approx(1.09e-5, abs=0.005e-5)
    assert critical["SiO2"].F_cr2.value == pytest.approx(5.3e-3, abs=0.05e-3)
    # item 17: the paper's particles press with a constant
    literal = contact.replace(
        particle_law=tb.particle.Horng2022(preset="literal"),
        **{"particles.diameter.mean": 1e-6, "particles.diameter.std": 8e-8},
    )
    state = tb.solve(literal, F_star=np.geomspace(5e-7, 1e-5, 5))
    assert set(state.mode) == {"p-s"}
    np.testing.assert_allclose(state.pressure / state.A_t, 5e9, rtol=1e-12)


# ---------------------------------------------------------------- scripts
def test_every_need_has_an_oldest_release():
    lines = floors()
    assert len(lines) > 12
    for line in lines:
        assert re.fullmatch(r"[\w-]+==\d[\w.]*", line), line


def test_scripts_are_well_formed():
    status, text = run("bash", "-n", str(ROOT / ".ci" / "run"))
    assert status == 0, text
    lines = (ROOT / ".ci" / "run").read_text("utf-8")
    assert "make test" in lines
    assert "make --keep-going --jobs 2 check" in lines


def test_make_knows_its_targets():
    for target in ("demo", "test", "check", "oldest", "coverage", "bench", "format", "clean"):
        try:
            status, text = run("make", "-n", target)
        except FileNotFoundError:
            pytest.skip("make is not installed")
        assert status == 0, text


def test_no_trace_of_one_machine():
    """No absolute paths of a checkout and no registry addresses in what is kept."""
    try:
        status, names = run("git", "ls-files", "-z")
    except FileNotFoundError:
        status, names = 1, ""
    if status:
        pytest.skip("not a git checkout")
    address = re.compile(r"https?://\S+/simple[/\s]|/tmp/|/home/\w+")
    home = str(ROOT.parent) + "/"
    found = []
    for name in filter(None, names.split("\0")):
        file = ROOT / name
        if file.suffix == ".png" or file == Path(__file__).resolve() or not file.is_file():
            continue
        text = file.read_text("utf-8", errors="ignore")
        if address.search(text) or (len(home) > 2 and home in text):
            found.append(name)
    assert not found
