"""Laws and outputs of one's own on the command line: files, and installed packages."""

import json
import os
import re
import subprocess
import sys
import tomllib
from contextlib import contextmanager
from importlib.metadata import EntryPoint, EntryPoints
from pathlib import Path
from unittest import mock

import numpy as np
import pytest
from command_line import refused
from scipy.integrate import quad
from typer.testing import CliRunner

import thirdbody as tb
from thirdbody import cli, definition
from thirdbody.equilibrium.states import state_columns
from thirdbody.errors import Mistake
from thirdbody.laws import asperity
from thirdbody.quantities import installed
from thirdbody.study import own_code

ROOT = Path(__file__).parents[2]
END = 6**0.5
PLAIN = """from thirdbody.populations.distributions import Distribution
class Plain(Distribution):
    name = "plain"
"""


@contextmanager
def registries_kept():
    """What is defined inside is forgotten outside, and no later process imports it."""
    before = [(kind, dict(kind.registry)) for kind in own_code.KINDS]
    try:
        with mock.patch.dict(os.environ):
            yield
    finally:
        for name in ("abrupt", "overload", "sizes", "heights"):
            sys.modules.pop(name, None)
        for kind, known in before:
            kind.registry.clear()
            kind.registry.update(known)


def code(page, number=0):
    return re.findall(
        r"^```python\n(.*?)^```$", (ROOT / "docs" / page).read_text("utf-8"), re.S | re.M
    )[number]


def process(*arguments, **more):
    command = [sys.executable, "-m", "thirdbody", *arguments]
    environment = os.environ | more
    return subprocess.run(command, capture_output=True, text=True, check=False, env=environment)


def run(*arguments):
    return CliRunner().invoke(cli.app, arguments)


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "abrupt.py").write_text(code("add-a-law.md"), "utf-8")
    (tmp_path / "overload.py").write_text(code("add-an-output.md"), "utf-8")
    (tmp_path / "sizes.py").write_text(code("add-a-distribution.md"), "utf-8")
    (tmp_path / "heights.py").write_text(code("add-a-distribution.md", 1), "utf-8")
    return tmp_path


@pytest.mark.check
def test_a_law_of_ones_own_is_solved():
    process("new", "two-body")
    law = '--set=asperity_law={name="abrupt",k=0.4}'
    found = process("solve", "two-body.toml", "--import", "abrupt.py", law, "--json")
    assert found.returncode == 0, found.stderr
    result = json.loads(found.stdout)
    assert result["inputs"]["asperity_law"]["type"] == "Abrupt"
    assert set(result["states"]["status"]) == {"ok"}
    first = process("--import", "abrupt.py", "solve", "two-body.toml", law, "--json")
    named = process("solve", "two-body.toml", law, "--json", THIRDBODY_IMPORT="abrupt.py")
    assert first.stdout == named.stdout == found.stdout
    without = process("solve", "two-body.toml", law)
    assert without.returncode == 2
    assert 'error: asperity_law.name = "abrupt" ' in without.stderr


SIZES = '{distribution="triangular", low="100 nm", mode="200 nm", high="300 nm"}'


@pytest.mark.parametrize(
    ("file", "setting", "place"),
    [
        ("sizes.py", f"particles={SIZES[:-1]}, material='SiO2', areal_density=1e11}}", "sizes"),
        ("heights.py", "roughness.heights='triangular'", "heights"),
    ],
)
def test_a_distribution_of_ones_own_is_solved(file, setting, place):
    """As by Python; a study that does not import it is refused."""
    run("new", "two-body")
    command = ["solve", "two-body.toml", f"--set={setting}"]
    told = {(each.code, each.value) for each in refused(*command).problems}
    assert (Mistake.OPTION, '"triangular"') in told
    with registries_kept():
        found = run(*command, "--import", file, "--json")
        schema = run("schema", "--import", file).stdout
    assert found.exit_code == 0, found.stderr
    result = json.loads(found.stdout)
    assert set(result["states"]["status"]) == {"ok"}
    part = result["inputs"]
    part = part["particles"]["diameter"] if place == "sizes" else part["roughness"]["heights"]
    assert part["type"].startswith("Triangular")
    assert "triangular" in schema


def test_distributions_of_ones_own_hold_in_every_engine():
    """A triangle of sizes and of heights: moments by quadrature, states by three ways."""
    steel = tb.materials["S45C"]
    contact = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(
            material=tb.materials["SiO2"],
            areal_density=1e11,
            diameter=tb.distributions.Monodisperse(mean=300e-9),
        ),
    )
    with registries_kept():
        spaces = [{"__name__": "own"}, {"__name__": "own"}]
        for space, number in zip(spaces, (0, 1), strict=True):
            exec(code("add-a-distribution.md", number), space)  # the page's own text
        sizes = spaces[0]["Triangular"](low=150e-9, mode=350e-9, high=420e-9)
        heights = spaces[1]["TriangularHeights"]()
        for n in range(4):
            pieces = [(150e-9, 210e-9), (210e-9, 350e-9), (350e-9, 400e-9)]
            want = sum(quad(lambda x: x**n * sizes.pdf(x), a, b)[0] for a, b in pieces)  # noqa: B023
            assert sizes.partial_moment(n, 0, 400e-9) == pytest.approx(want, rel=1e-11)
        assert heights.sf(1.0) == pytest.approx((END - 1) ** 2 / 12, rel=1e-13)

        own = contact.replace(**{"particles.diameter": sizes})
        modes = np.linspace(300e-9, 400e-9, 24)
        by = {"vary": {"particles.diameter.mode": modes}, "F_star": 3e-5}
        compiled = state_columns(own, **by)
        with mock.patch.dict(os.environ, THIRDBODY_ENGINE="numpy"):
            numpy = state_columns(own, **by)
        for name in ("F_sa_star", "A_sa", "d"):
            np.testing.assert_allclose(compiled[name], numpy[name], rtol=1e-9)

        bare = contact.replace(particles=None, **{"roughness.heights": heights})
        state = tb.solve(bare, d=150e-9)
        plain = definition.state(bare, 150e-9)
        assert state.A_t == pytest.approx(plain["A_t"], rel=1e-10)
        assert state.F_star == pytest.approx(plain["F_ss"] / bare.E_ss, rel=1e-10)


def test_tables_list_what_is_imported():
    with registries_kept():
        found = run("laws", "--import", "abrupt.py", "--json")
        both = run("outputs", "--import", "abrupt.py", "--import", "overload.py")
    assert "abrupt" in [each["name"] for each in json.loads(found.stdout)["asperity"]]
    assert both.exit_code == 0, both.stderr
    assert "overload" in both.stdout


@pytest.mark.parametrize("command", [each.name for each in cli.app.registered_commands])
def test_every_command_imports(command):
    done = CliRunner().invoke(cli.app, [command, "--help"], env={"COLUMNS": "100"})
    assert "--import FILE.py" in done.stdout


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("import numpy\n1 / 0\n", "mine.py, line 2: ZeroDivisionError: division by zero"),
        ("def (", "mine.py, line 1: SyntaxError"),
        ("import nowhere_at_all", "line 1: ModuleNotFoundError"),
        ("x = 1", "mine.py brings nothing of its own"),
        ("LAW name = 'zmc'", "there is a law 'zmc' already"),
        ("LAW title = ''; del title", "Abrupt lacks title"),
        (PLAIN, "Plain lacks partial_moment, pdf, ppf, scaled, standardised, support, @dataclass("),
        (None, "mine.py: there is no such file"),
    ],
)
def test_one_line_where_a_file_fails(text, words, folder):
    if text is not None:
        if text.startswith("LAW "):
            line = text.removeprefix("LAW ")
            key = line.split(" ")[0]
            text = re.sub(rf"^    {key} = .*$", f"    {line}", code("add-a-law.md"), flags=re.M)
        (folder / "mine.py").write_text(text, "utf-8")
    before = dict(asperity.REGISTRY)
    done = CliRunner().invoke(cli.app, ["laws", "--import", "mine.py"])
    assert done.exit_code == 2
    (line,) = done.stderr.splitlines()
    assert line.startswith("error: --import mine.py")
    assert words in line
    assert before == asperity.REGISTRY
    assert "mine" not in sys.modules


def test_installed_packages_are_found(folder, monkeypatch):
    """A good entry point brings its law; a broken one is told and left out."""
    (folder / "plugin_of_tests.py").write_text(
        code("add-a-law.md").replace('"abrupt"', '"abrupt-too"'), "utf-8"
    )
    monkeypatch.syspath_prepend(folder)
    law = EntryPoint("good", "plugin_of_tests", "thirdbody.laws")
    bad = EntryPoint("bad", "nowhere_at_all", "thirdbody.laws")
    monkeypatch.setattr(installed, "entry_points", lambda: EntryPoints([law, bad]))
    known = dict(asperity.REGISTRY)
    installed.offers.cache_clear()
    own_code._load_entry_points.cache_clear()
    try:
        with pytest.warns(UserWarning, match="entry point bad = nowhere_at_all") as heard:
            own_code.load_installed()
        assert len(heard) == 1
        assert asperity.REGISTRY["abrupt-too"]().breakpoints == (1.0,)
    finally:
        installed.offers.cache_clear()
        own_code._load_entry_points.cache_clear()
        asperity.REGISTRY.clear()
        asperity.REGISTRY.update(known)


def test_the_page_names_the_groups():
    text = (ROOT / "docs" / "add-a-law.md").read_text("utf-8")
    (example,) = (b for b in re.findall(r"^```toml\n(.*?)^```$", text, re.S | re.M) if "entry" in b)
    (group,) = tomllib.loads(example)["project"]["entry-points"]
    assert group in installed.GROUPS
