"""The book: its pages run, its links lead somewhere, and its numbers are measured here."""

import contextlib
import functools
import importlib
import importlib.util
import io
import json
import pkgutil
import re
import shutil
import sys
import warnings
from pathlib import Path

import numpy as np
import oracle
import pytest
from twins import FIELDS, series_twin

import thirdbody as tb
from thirdbody import reference
from thirdbody.papers import seats
from thirdbody.papers.horng2022 import READINGS, Curves
from thirdbody.study import own_code

pytestmark = pytest.mark.check
ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
sys.path.insert(0, str(DOCS / "_ext"))
from facts import facts, insert_facts  # noqa: E402
from pages import insert_generated  # noqa: E402

PAGES = sorted(DOCS.glob("*.md"))
NOTEBOOKS = sorted((DOCS / "tutorials").glob("*.ipynb"))
FENCE = re.compile(r"^```(\{?[\w-]*\}?).*?\n(.*?)^```$", re.S | re.M)
# made by the build, so that no file of theirs is in the checkout
MADE = ("gallery/", "api/", "cases/")
# run by tests of their own, with the files or the time that they need
ELSEWHERE = {
    "add-a-law.md",
    "add-an-output.md",
    "choose-a-seat.md",
    "theory.md",
    "reproduction.md",
}


def said(code, names):
    """What a piece of code prints."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out), warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        exec(compile(code, "<page>", "exec"), names)
    return out.getvalue()


def matches(shown, printed):
    """Whether a page shows what was printed; with a line "..." it may leave lines out."""
    shown, printed = shown.strip().splitlines(), printed.strip().splitlines()
    if "..." not in shown:
        return shown == printed
    lines = iter(printed)
    return all(line in lines for line in shown if line != "...")


@pytest.fixture(autouse=True)
def registries():
    """What a page defines is forgotten after it: other tests list all that there is."""
    before = [(kind, dict(kind.registry)) for kind in own_code.KINDS]
    yield
    for kind, names in before:
        kind.registry.clear()
        kind.registry.update(names)


# ---------------------------------------------------------------- pages
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_code_of_the_page_runs(page, tmp_path, monkeypatch):
    """Python blocks run in order in one namespace; a plain block after one is its output."""
    if page.name in ELSEWHERE:
        pytest.skip("has a test of its own or shows files to write")
    monkeypatch.chdir(tmp_path)
    # what pages call a study of one's own
    shutil.copy(ROOT / "examples" / "dusty_ball_screw.toml", tmp_path / "study.toml")
    # a page begins with its own import, so that its first block runs when pasted
    names = {}
    printed = None
    for language, code in FENCE.findall(insert_facts(page.read_text("utf-8"))):
        if language == "python":
            printed = said(code, names)
        elif language == "" and printed:
            assert matches(code, printed), f"{page.name} shows\n{code}\nbut prints\n{printed}"
            printed = None


@functools.cache
def whole_text(page):
    """A page with its generated parts."""
    return insert_generated(page.read_text("utf-8"))


@functools.cache
def anchors_of(page):
    """What links can lead to: headings as the build names them, and labels."""
    titles = re.findall(r"^#+ (.*)$", whole_text(page), re.M)
    slugs = {re.sub(r"[^\w\- ]", "", t.lower()).replace(" ", "-").replace("_", "-") for t in titles}
    return slugs | set(re.findall(r"^\(([\w-]+)\)=$", whole_text(page), re.M))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_anchors_and_documents_exist(page):
    """Links to headings, {doc} and toctree entries and included files: not checked by Markdown."""
    text = whole_text(page)
    for file, anchor in re.findall(r"\]\(([\w./-]*)#([\w-]+)\)", text):
        target = (page.parent / file) if file else page
        assert anchor in anchors_of(target), f"{page.name}: no heading #{anchor} in {target.name}"
    for file in re.findall(r"^```\{(?:literal)?include\} (\S+)$", text, re.M):
        assert (page.parent / file).is_file(), f"{page.name}: {file}"
    entries = re.findall(r"\{doc\}`(?:[^`<]*<)?([^`>]+)>?`", text)
    for body in re.findall(r"^```\{toctree\}\n(.*?)^```$", text, re.S | re.M):
        entries += [line for line in body.splitlines() if line and not line.startswith(":")]
    for entry in entries:
        if not entry.startswith(MADE):
            found = [DOCS / f"{entry}{suffix}" for suffix in (".md", ".ipynb")]
            assert any(file.is_file() for file in found), f"{page.name}: {entry}"
        elif entry.startswith("gallery/") and entry != "gallery/index":
            source = ROOT / "examples" / f"{entry}.py"
            assert source.is_file(), f"{page.name}: {entry}"
        elif entry.startswith("cases/") and entry != "cases/index":
            source = ROOT / "examples" / f"{entry.removeprefix('cases/')}.py"
            assert source.is_file(), f"{page.name}: {entry}"


def test_every_page_is_in_the_contents():
    text = "\n".join(page.read_text("utf-8") for page in PAGES)
    listed = set()
    for body in re.findall(r"^```\{toctree\}\n(.*?)^```$", text, re.S | re.M):
        listed |= {line for line in body.splitlines() if line and not line.startswith(":")}
    assert {page.stem for page in PAGES} - listed == {"index"}


def test_every_equation_of_the_paper_has_its_place():
    text = (DOCS / "equations.md").read_text("utf-8")
    for number in range(1, 15):
        assert f"```{{index}} ! Equation {number}\n```" in text
        title = re.search(rf"^## (Equation {number}: .*)$", text, re.M)[1]
        # the search of the book finds a heading by its words when they are half of it
        assert len(title) <= 2 * len(f"Equation {number}")
    assert "sigma_s" in re.search(r"^## (Equation 9: .*)$", text, re.M)[1]
    named = re.findall(r"`(?:thirdbody\.)?(?:tb\.)?Horng2022\((\w+)=", text)
    named += re.findall(r"`(\w+)=\S+ as printed", text)
    fields = tb.particle.Horng2022.__dataclass_fields__
    assert named
    assert set(named) <= set(fields)
    items = {
        int(n) for n in re.findall(r"^\*\*(\d+)\. ", (DOCS / "errata.md").read_text("utf-8"), re.M)
    }
    assert {int(n) for n in re.findall(r"item (\d+)", text)} <= items


BOOK = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *PAGES]


def reached(dotted):
    """Whether a dotted name leads somewhere from the package: attribute, field or module."""
    here, path = tb, "thirdbody"
    for step in dotted.split("."):
        path = f"{path}.{step}"
        if step in getattr(here, "__dataclass_fields__", {}):
            return True  # what a field holds is an instance's
        if not hasattr(here, step):
            try:
                here = importlib.import_module(path)
            except ImportError:
                return False
        else:
            here = getattr(here, step)
    return True


def test_the_check_of_names_sees_a_wrong_one():
    assert reached("asperity.ZMC.force")
    assert not reached("asperity.ZMC.forse")
    assert not reached("nothing")


@pytest.mark.parametrize("page", BOOK, ids=lambda page: page.name)
def test_names_of_the_page_exist(page):
    named = re.findall(r"`(?:tb|thirdbody)\.([A-Za-z_]\w*(?:\.\w+)*)", page.read_text("utf-8"))
    assert [name for name in named if not reached(name)] == []


COMMAND = re.compile(r"(?:^|`)(?:\.venv/bin/)?thirdbody +(?!as\b)([a-z][\w-]*)([^`\n]*)", re.M)


def mistakes_in(text):
    """Commands and options that the command line does not have."""
    import typer

    from thirdbody.cli import app

    commands = typer.main.get_command(app).commands
    out = []
    for name, rest in COMMAND.findall(text):
        if name not in commands:
            out.append(name)
            continue
        known = {word for item in commands[name].params for word in (*item.opts, "--help")}
        known |= {word for item in commands[name].params for word in item.secondary_opts}
        used = re.findall(r"(?<!\S)--?[a-z][\w-]*", rest.partition(" #")[0].partition(" |")[0])
        out += [f"{name} {word}" for word in used if word not in known]
    return out


def test_the_check_of_commands_sees_a_wrong_one():
    assert mistakes_in("`thirdbody solve a.toml --json`") == []
    assert mistakes_in("thirdbody solve a.toml --jsn\n`thirdbody slove`") == [
        "solve --jsn",
        "slove",
    ]


@pytest.mark.parametrize("page", BOOK, ids=lambda page: page.name)
def test_commands_of_the_page_exist(page):
    assert mistakes_in(page.read_text("utf-8")) == []


def test_hooks_of_the_guides_exist():
    """Names in the tables and sentences of the pages on extending are those of the classes."""
    from thirdbody.contact import evaluation as outputs
    from thirdbody.contact import spots
    from thirdbody.laws import base

    known = {
        name
        for module in (base, outputs, spots)
        for kind in vars(module).values()
        if isinstance(kind, type)
        for name in (*dir(kind), *getattr(kind, "__annotations__", ()))
    }
    for name in ("add-a-law.md", "add-an-output.md"):
        text = (DOCS / name).read_text("utf-8")
        hooks = [
            w
            for row in re.findall(r"^\| (`.*?) \|", text, re.M)
            for w in re.findall(r"`(\w+)", row)
        ]
        hooks += re.findall(r"(?:set|override the property|implements?|give) `(\w+)", text)
        assert len(hooks) > 3, name
        assert [hook for hook in hooks if hook not in known] == [], name


def test_the_reference_lists_every_public_name():
    text = (DOCS / "reference.md").read_text("utf-8")
    listed = set()
    for module, body in re.findall(r"currentmodule:: (\S+)\n(.*?)^```$", text, re.S | re.M):
        for name in re.findall(r"^   (\w+)$", body, re.M):
            assert hasattr(pkgutil.resolve_name(module), name), f"{module}.{name}"
            listed.add((module, name))
    modules = {name for name in tb.__all__ if type(getattr(tb, name)).__name__ == "module"}
    for name in set(tb.__all__) - modules:
        assert ("thirdbody", name) in listed, name
    for module in modules:
        assert any(where == f"thirdbody.{module}" for where, _ in listed), module
    for law in tb.asperity.REGISTRY.values():
        assert ("thirdbody.asperity", law.__name__) in listed
    for law in tb.particle.REGISTRY.values():
        assert ("thirdbody.particle", law.__name__) in listed
    for output in tb.outputs.REGISTRY.values():
        if output.__module__.startswith("thirdbody."):
            assert ("thirdbody.outputs", output.__name__) in listed


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda file: file.stem)
def test_tutorial_runs(file, tmp_path, monkeypatch):
    """All cells in order, as plain Python; the build of the book runs them in a kernel."""
    monkeypatch.chdir(tmp_path)
    names = {}
    cells = [c for c in json.loads(file.read_text("utf-8"))["cells"] if c["cell_type"] == "code"]
    assert any("assert " in "".join(cell["source"]) for cell in cells)
    for cell in cells:
        assert cell["outputs"] == [], f"{file.name}: clear the outputs before keeping it"
        said("".join(cell["source"]), names)


# ---------------------------------------------------------------- numbers of "validation"
STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
PAIR = tb.MaterialPair(STEEL, STEEL)


def worst(found, expected):
    return float(np.max(np.abs(np.asarray(found) / np.asarray(expected) - 1)))


def dusty(**changes):
    contact = tb.Contact(
        surfaces=PAIR,
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(
            material=SILICA,
            areal_density=1e11,
            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
        ),
    )
    return contact.replace(**changes)


def hertz():
    """Load of an elastic tip against Hertz, solved the other way round."""
    force = np.geomspace(1e-12, 1e-9, 9)
    point = reference.hertz_point(force, R=2.8e-6, E_star=PAIR.E_star)
    got = tb.asperity.ZMC().force(point.interference, R=2.8e-6, E_star=PAIR.E_star, H=STEEL.H)
    return worst(got, force)


def gaussian_sums():
    """Elastic asperities against the closed integrals of Greenwood and Williamson."""
    contact = tb.Contact(
        surfaces=PAIR,
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        asperity_law=tb.asperity.GW(),
    )
    rough = contact.roughness
    h = np.array([-1.0, 0.0, 1.0, 2.0, 4.0])
    state = tb.solve(contact, d=h * rough.sigma_s)
    scale = 4 / 3 * rough.density * np.sqrt(rough.R) * rough.sigma_s**1.5
    area = np.pi * rough.density * rough.R * rough.sigma_s
    return max(
        worst(state.F_star, scale * reference.gaussian_integral(h, n=1.5)),
        worst(state.A_t, area * reference.gaussian_integral(h, n=1)),
    )


def particle_limits():
    """One particle squeezed very little and very much: elastic and embedded."""
    x = 300e-9
    contact = dusty().replace(
        **{"particles.diameter": tb.distributions.Monodisperse(mean=x)},
        particle_law=tb.particle.Series(deep="off", seat="plane"),
    )
    squeeze = np.array([1e-5, 0.9]) * x
    force = np.asarray(tb.solve(contact, d=x - squeeze).F_sa_star) * contact.E_ss / 1e11
    E_sa = tb.MaterialPair(STEEL, SILICA).E_star
    elastic = 4 / 3 * E_sa * np.sqrt(x / 2) * (squeeze[0] / 2) ** 1.5
    return worst(force, [elastic, np.pi / 4 * STEEL.H * x**2])


def second_implementation():
    """Every field of a state, three seats, against adaptive quadrature that shares no code."""
    from twins import sizes

    out = 0.0
    for seat in ("rough", "plane", "offset"):
        twin = series_twin(
            oracle.Interface(),
            oracle.SILICA,
            sizes("gaussian", 300e-9, 0.08),
            1e11,
            250e-9,
            seat=seat,
            h_0=50e-9,
        )
        state, expected = tb.solve(twin.contact, d=twin.d), twin.expected()
        for name in FIELDS:
            if expected[name] > 1e-12 * expected["A_t"]:
                out = max(out, worst(getattr(state, name), expected[name]))
    return out


def seats_by_sampling():
    """The rough seat as a mean over heights: 4080 planes weighed by the height density.

    Panels end where the smallest and the largest particles are squeezed flat.
    """
    contact = dusty(particle_law=tb.particle.Series(shadow="none"))
    d = 150e-9
    rough = contact.roughness
    x, gauss = np.polynomial.legendre.leggauss(40)
    flat = 1e-3 * (300e-9 + np.array([3, -3]) * 24e-9)
    large, small, meet = (d + rough.y_s - np.append(flat, 0.0)) / rough.sigma
    edges = np.concatenate([np.linspace(-8, large, 51), [small], np.linspace(meet, 8, 51)])
    half = np.diff(edges)[:, None] / 2
    zeta = (edges[:-1, None] + half * (1 + x)).ravel()
    weight = np.exp(-(zeta**2) / 2) * (half * gauss).ravel() / np.sqrt(2 * np.pi)
    plane = contact.replace(particle_law=tb.particle.Series(seat="plane", shadow="none"))
    load = np.asarray(tb.solve(plane, d=d + rough.y_s - zeta * rough.sigma).F_sa_star)
    return worst(tb.solve(contact, d=d).F_sa_star, np.nan_to_num(load) @ weight)


def balance():
    """Loads carried over loads asked for."""
    F = np.geomspace(1e-8, 1e-3, 1000)
    return float(np.max(tb.solve(dusty(), F_star=F).residual))


def units():
    """Lengths a thousandfold, stresses a thousandth: dimensionless results stay."""
    body = tb.Material(E=STEEL.E * 1e-3, nu=STEEL.nu, H=STEEL.H * 1e-3)
    sand = tb.Material(E=SILICA.E * 1e-3, nu=SILICA.nu, H=SILICA.H * 1e-3)
    large = tb.Contact(
        surfaces=tb.MaterialPair(body, body),
        roughness=tb.Roughness(sigma=100e-6, R=2.8e-3),
        particles=tb.Particles(
            material=sand,
            areal_density=1e5,
            diameter=tb.TruncatedGaussian(mean=300e-6, std=24e-6),
        ),
    )
    F = np.geomspace(1e-7, 1e-3, 9)
    one, other = tb.solve(dusty(), F_star=F), tb.solve(large, F_star=F)
    return max(worst(getattr(other, c), getattr(one, c)) for c in ("A_t", "d_star", "F_sa_star"))


def table_error():
    """True error of a table over the error it states."""
    contact = dusty()
    table = tb.table(contact, tolerance=1e-6)
    h = np.linspace(210e-9, 600e-9, 997)
    exact = tb.solve(contact, d=h - contact.roughness.y_s).pressure
    return worst(table.p(h), exact) / table.error.p


def explicit(diameter):
    """Load share of the rough seat against explicit particles, 1e-5 ≤ F* ≤ 3e-4."""
    points = seats.explicit_particles()["points"]
    data = {
        point["F_star"]: point["control_variate"]["load_share"]
        for point in points
        if point["diameter"] == diameter and point["F_star"] >= 1e-5
    }
    assert len(data) >= 3
    share = tb.solve(seats.contact(diameter), F_star=list(data)).particle_load_share
    return worst(share, list(data.values()))


def bare_is_bare():
    """No particle touches: the two-body state, to the last bit."""
    far = dusty(particle_law=tb.particle.Series(seat="plane"))
    bare = tb.Contact(surfaces=far.surfaces, roughness=far.roughness)
    d = np.array([373e-9, 400e-9])
    one, other = tb.solve(far, d=d), tb.solve(bare, d=d)
    return max(worst(getattr(one, c), getattr(other, c)) for c in ("F_star", "A_t", "A_ep"))


def printed_pressure():
    """The letter of Eqs. 1 and 2: particles press with H whatever the load."""
    curve = Curves(READINGS["literal"])("SiO2", 100, 1000)
    pressure = curve.F * PAIR.E_star / curve.A_t
    return worst(pressure[curve.particle_share > 1 - 1e-12], STEEL.H)


MEASURED = {
    hertz: 1e-14,
    gaussian_sums: 1e-13,
    particle_limits: 1e-10,
    second_implementation: 1e-12,
    seats_by_sampling: 1e-10,
    balance: 1e-13,
    units: 1e-13,
    bare_is_bare: 0.0,
    table_error: 1.0,
    printed_pressure: 1e-12,
}


@pytest.mark.parametrize("measure", MEASURED, ids=lambda measure: measure.__name__)
def test_numbers_of_the_validation_page(measure):
    """The page states a bound for each, and what is measured here stays within it."""
    page = (DOCS / "validation.md").read_text("utf-8")
    (stated,) = re.findall(rf"\| `{measure.__name__}` \| ([^|]+) \|", page)
    words = {"bit for bit": 0.0, "below what it states": 1.0}
    bound = words[stated] if stated in words else float(stated)
    assert bound == MEASURED[measure]
    assert measure() <= bound


@pytest.mark.parametrize(
    ("diameter", "case", "stated"), [(200e-9, "x067", 11), (300e-9, "x1", 6), (600e-9, "x2", 4)]
)
def test_agreement_with_explicit_particles(diameter, case, stated):
    """What the book says of both sets of runs."""
    newer = [state for state in seats.comparison() if state["case"] == case]
    off = worst(
        [state["share_statistical"] for state in newer], [state["share"] for state in newer]
    )
    assert explicit(diameter) <= seats.STATED_AGREEMENT[diameter]
    assert stated / 100 - 0.01 < max(off, explicit(diameter)) <= stated / 100
    assert facts()["agreement_share"] == "4, 6, 11 %"
    assert facts()["agreement_separation"] == "0.035 σ"


SECTIONS = {
    "What the contact does": "",
    "Laws and systems of the literature": "",
    "The parts around it": "",
}


@pytest.mark.parametrize("section", SECTIONS)
def test_validation_states_what_the_tests_ask(section):
    """Each row names a test, and the tolerance stands in it."""
    page = (DOCS / "validation.md").read_text("utf-8")
    part = page.split(f"## {section}\n")[1].split("\n## ")[0]
    row = r"^\| .* \| ([^|]+) \| `([\w/]+\.py)` \| `(\w+)` \|$"
    rows = re.findall(row, part, re.M)
    assert len(rows) == len(re.findall(r"^\| (?!quantity)", part, re.M)) > 15
    for asked, file, name in rows:
        source = (ROOT / "tests" / SECTIONS[section] / file).read_text("utf-8")
        (body,) = re.findall(rf"^def {name}\(.*?(?=^def |^@|^# ---|\Z)", source, re.S | re.M)
        if asked != "bit for bit":
            numbers = re.findall(r"(?<![\w.])\d+(?:\.\d+)?(?:e-?\d+)?", body)
            assert float(asked) in [float(number) for number in numbers], f"{name}: {asked}"
