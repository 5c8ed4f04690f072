"""What a mistake is: a record with its place, of which the sentence is made where it is shown."""

import ast
import copy
import pickle
import tomllib
from pathlib import Path

import pytest
from refusals import refuses
from steel_and_dust import DUSTY as CONTACT

import thirdbody as tb
from thirdbody.errors import Advice, Mistake, Problem, in_study
from thirdbody.quantities.units import to_si
from thirdbody.study.toml import override
from thirdbody.study.whole import check

SRC = Path(tb.__file__).parent
MISSPELT = {"roughness.sigm": (1e-7, 2e-7)}
NOT_AN_INPUT = "{} is not an input; did you mean 'roughness.sigma'?"
READ_BACK = {"startswith", "endswith", "removeprefix", "removesuffix", "replace", "split"}
READ_BACK |= {"partition", "rpartition", "match", "search", "sub", "fullmatch"}


@pytest.mark.parametrize(
    "call",
    [
        lambda: tb.sweep(CONTACT, F_star=1e-4, vary={"roughness.sigm": [1e-7]}),
        lambda: tb.equilibria.solve_states(CONTACT, F_star=1e-4, vary={"roughness.sigm": [1e-7]}),
        lambda: tb.equilibria.critical_loads(CONTACT, vary={"roughness.sigm": [1e-7]}, count=1),
        lambda: tb.propagate(CONTACT, F_star=1e-4, vary=MISSPELT),
        lambda: tb.design(
            CONTACT,
            F_star=1e-4,
            vary=MISSPELT,
            objective=tb.objectives.Objective(of="A_t", aim="smallest"),
        ),
    ],
    ids=["sweep", "solve_states", "critical_loads", "propagate", "design"],
)
def test_one_mistake_has_one_sentence(call):
    with pytest.raises(tb.errors.InvalidValue) as told:
        call()
    (problem,) = told.value.problems
    assert problem.place == "vary['roughness.sigm']"
    assert problem == NOT_AN_INPUT.format(problem.place)


def test_sensitivity_names_its_own_argument():
    with pytest.raises(tb.errors.InvalidValue) as told:
        tb.sensitivity(CONTACT, F_star=1e-4, of="A_t", to=["roughness.sigm"])
    (problem,) = told.value.problems
    assert problem == NOT_AN_INPUT.format("to = 'roughness.sigm'")
    assert (problem.place, problem.value) == ("to", "'roughness.sigm'")


def test_a_name_of_no_material_has_a_place():
    with refuses(Mistake.UNKNOWN, "materials['S45']", meant="S45C"):
        tb.materials["S45"]


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("sigma", "roughness.sigma"),
        ("particles.mean", "particles.diameter.mean"),
        ("surfaces.first.conductivity", "surfaces.first.thermal_conductivity"),
        ("surfaces.first.hardnes", "surfaces.first.H"),
        ("roughness.rms", "roughness.sigma"),
        ("particles.0.mean", "particles.diameter.mean"),
        ("surfaces.first", None),
    ],
)
def test_the_input_that_was_meant(name, meant):
    try:
        tb.equilibria.solve_states(CONTACT, F_star=1e-4, vary={name: [1e-7]})
    except tb.errors.InvalidValue as error:
        hint = error.problems[0].hint
        assert hint == ("" if meant is None else f"did you mean {meant!r}?")


BY_MEANING = {
    "first": {
        "hardnes": "H",
        "hardness": "H",
        "youngs_modulus": "E",
        "modulus": "E",
        "poison": "nu",
        "poissons_ratio": "nu",
        "toughness": "K_c",
        "conductivity": "thermal_conductivity",
        "heat": "specific_heat",
        "mass_density": "density",
        "colour": None,
    },
    "roughness": {
        "roughness": "sigma",
        "rms_roughnes": "sigma",
        "radius": "R",
        "tip_radius": "R",
        "asperity_density": "eta",
        "bandwidth": "alpha",
    },
    "particles": {"density": "areal_density", "number_density": "areal_density"},
}
"""Names that somebody may write who does not know the symbol, and what is meant."""
MADE_BY_HAND = {
    "first": (tb.Material, dict(E=205e9, nu=0.29, H=5e9)),
    "roughness": (tb.Roughness, dict(sigma=1e-7, R=2e-6)),
    "particles": (
        tb.Particles,
        dict(
            material=tb.materials["SiO2"],
            areal_density=1e11,
            diameter=tb.Monodisperse(mean=3e-7),
        ),
    ),
}
IN_A_FILE = {
    "first": 'E = "205 GPa"\nnu = 0.29\nH = "5 GPa"',
    "roughness": 'sigma = "100 nm"\nR = "2 um"',
    "particles": 'material = "SiO2"\ndistribution = "monodisperse"\nmean = "300 nm"\n'
    'areal_density = "1e11 / m^2"',
}


@pytest.mark.parametrize(
    ("table", "name", "meant"),
    [(table, *pair) for table, pairs in BY_MEANING.items() for pair in pairs.items()],
)
def test_a_symbol_is_known_by_what_it_means(table, name, meant, tmp_path):
    kind, values = MADE_BY_HAND[table]
    with pytest.raises(tb.errors.InvalidValue) as told:
        kind(**values, **{name: 1.0})
    assert [problem.meant for problem in told.value.problems] == [meant]
    if meant in values:  # instead of it: nothing is missing, too
        with pytest.raises(tb.errors.InvalidValue) as told:
            kind(**{key: values[key] for key in values if key != meant}, **{name: 1.0})
        assert [problem.meant for problem in told.value.problems] == [meant]
    path = "surfaces.first" if table == "first" else table
    text = 'surfaces.second = "S45C"\n[load]\npressure = "5 MPa"\n'
    for head, lines in IN_A_FILE.items():
        text += f"[{'surfaces.first' if head == 'first' else head}]\n{lines}\n"
        text += f"{name} = 1.0\n" * (head == table)
    file = tmp_path / "study.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(tb.errors.InvalidValue) as told:
        tb.load_study(file)
    (problem,) = told.value.problems
    assert (problem.path, problem.meant) == (f"{path}.{name}", meant)


def test_a_mistake_keeps_its_parts():
    with pytest.raises(tb.errors.InvalidValue) as told:
        tb.Roughness(sigma=-1.0, R=2e-6)
    (problem,) = told.value.problems
    assert (problem.owner, problem.path, problem.value) == ("Roughness", "sigma", "-1.0")
    assert str(problem).startswith(f"Roughness.sigma = -1.0 {problem.rule}")
    for same in (pickle.loads(pickle.dumps(problem)), copy.copy(problem)):
        assert same == problem
        assert vars(same) == vars(problem)
    assert problem.move_under("roughness").place == "roughness.sigma"
    assert pickle.loads(pickle.dumps(told.value)).problems[0].place == "Roughness.sigma"


def test_a_mistake_of_no_place_gets_one():
    told = tb.errors.InvalidValue("too many").move_under("particles").problems[0]
    assert (told, told.place) == ("particles: too many", "particles")
    assert told.move_under("debris") == "debris: too many"


@pytest.mark.parametrize(
    ("changed", "place"),
    [
        ('roughness.sigma = "5 furlong"', "roughness.sigma"),
        ('load.presure = "1 MPa"', "load.presure"),
        ('particles.mean = "-1 nm"', "particles.mean"),
        ('surfaces.first = "S45"', "surfaces.first"),
        ("roughness.R = -1.0", "roughness.R"),
        (
            'design.objective = { of = "A_t", aim = "window", low = 2, high = 1 }',
            "design.objective",
        ),
    ],
)
def test_a_study_says_where_each_mistake_is(changed, place, tmp_path):
    study = SRC / "data" / "studies" / "ball-screw.toml"
    data = override(tomllib.loads(study.read_text("utf-8")), [changed.replace(" = ", "=", 1)])
    with pytest.raises(tb.errors.InvalidValue) as told:
        check(data, folder=tmp_path)
    assert any(each.place.startswith(place) for each in told.value.problems), told.value.problems


def test_one_maker_of_did_you_mean():
    asks = [path for path in SRC.rglob("*.py") if "difflib" in path.read_text("utf-8")]
    assert asks == [SRC / "quantities" / "nearest.py"]


def _loops(tree):
    """Names that stand for a mistake, and what is done with each."""
    for node in ast.walk(tree):
        of = getattr(node, "generators", None) or ([node] if isinstance(node, ast.For) else [])
        for loop in of:
            if ast.unparse(loop.iter).endswith(".problems"):
                yield ast.unparse(loop.target), node


def test_no_room_reads_a_mistake_back():
    """Its parts are there: a sentence is made where it is shown, and taken apart nowhere."""
    found = []
    for path in sorted(SRC.rglob("*.py")):
        for name, node in _loops(ast.parse(path.read_text("utf-8"))):
            for call in (n for n in ast.walk(node) if isinstance(n, ast.Call)):
                method = ast.unparse(call.func).rpartition(".")
                of_name = method[0] == name or any(ast.unparse(a) == name for a in call.args)
                if method[2] in READ_BACK and of_name:
                    found.append(f"{path.relative_to(SRC)}:{call.lineno}")
    assert found == []
    assert Problem("", "text").rule == "text"


def _is_text(node):
    return isinstance(node, ast.JoinedStr) or isinstance(getattr(node, "value", None), str)


def _without_a_code(function):
    """Mistakes that a function makes of plain text, or of a name that it gave to plain text."""
    texts = {
        ast.unparse(target)
        for node in ast.walk(function)
        if isinstance(node, ast.Assign) and _is_text(node.value)
        for target in node.targets
    }
    for node in ast.walk(function):
        name = getattr(getattr(node, "func", None), "id", "")
        if name not in ("InvalidValue", "Problem") or any(k.arg == "code" for k in node.keywords):
            continue
        rule = node.args[1:2] if name == "Problem" else node.args[:1]
        if any(_is_text(each) or ast.unparse(each) in texts for each in rule):
            yield node.lineno


def test_every_mistake_has_a_code():
    """A mistake that the library raises says what kind it is; code of a user's own need not."""
    bare = set()
    for path in sorted(SRC.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef):
                bare |= {f"{path.relative_to(SRC)}:{line}" for line in _without_a_code(node)}
    assert bare == set()


@pytest.mark.parametrize(
    ("make", "code", "place"),
    [
        (lambda: tb.Roughness(sigma=-1, R=1e-6), Mistake.RANGE, "Roughness.sigma"),
        (lambda: tb.Roughness(sigma="1 um", R=1e-6), Mistake.KIND, "Roughness.sigma"),
        (lambda: tb.Roughness(sigma=1e50, R=1e-6), Mistake.RANGE, "Roughness.sigma"),
        (lambda: tb.particle.Series(seat="high"), Mistake.OPTION, "Series.seat"),
        (lambda: tb.particle.Series(h_0=1e-7), Mistake.IDLE, "Series.h_0"),
        (lambda: CONTACT.replace(sigm=1), Mistake.UNKNOWN, "Contact"),
        (lambda: to_si("3 GPa", "m"), Mistake.UNIT, ""),
        (lambda: to_si("3,5 mm", "m"), Mistake.FORM, ""),
        (lambda: to_si("thick", "m"), Mistake.KIND, ""),
        (lambda: to_si("10 nm to 100 nm", "m"), Mistake.FORM, ""),
        (lambda: to_si("10-100 nm", "m"), Mistake.FORM, ""),
        (lambda: tb.Uncertain.uniform(low=2.0, high=1.0), Mistake.ORDER, "low"),
    ],
)
def test_the_code_of_a_mistake(make, code, place):
    with pytest.raises(tb.errors.InvalidValue) as told:
        make()
    (problem,) = told.value.problems
    assert (problem.code, problem.place) == (code, place)
    kept = pickle.loads(pickle.dumps(told.value))
    assert [each.code for each in kept.problems] == [code]


def test_a_clause_keeps_its_code_and_its_words_for_studies():
    clause = Mistake.RANGE.clause("must be > 0; " + Advice("R=1e-6", 'R = "1 um"'))
    again = pickle.loads(pickle.dumps(clause))
    assert (again, again.code, again.study) == (clause, Mistake.RANGE, 'must be > 0; R = "1 um"')
    moved = Problem("R", clause, "0").move_under("roughness").put_in_words(in_study)
    assert (moved.code, moved.hint) == (Mistake.RANGE, 'R = "1 um"')
    assert moved.rule == clause.study.partition("; ")[0]
    assert moved.endswith(clause.study)
    assert Problem("R", clause, "0", code=Mistake.KIND).code is Mistake.KIND
    assert tb.errors.InvalidValue("my own words").problems[0].code is Mistake.UNSAID


# ------------------------------------------------------------------------- what to write instead
@pytest.mark.parametrize(
    ("call", "place", "hint"),
    [
        (lambda: CONTACT.replace(asperity_law=tb.asperity.ZMC), "Contact.asperity_law", "ZMC()"),
        (lambda: tb.solve(CONTACT, pressure="5 MPa"), "pressure", "5e6"),
        (lambda: tb.solve(CONTACT, d="200 nm"), "d", "200e-9"),
    ],
)
def test_what_is_no_law_or_number_is_answered_with_one(call, place, hint):
    with pytest.raises(tb.errors.InvalidValue) as raised:
        call()
    (problem,) = raised.value.problems
    assert (problem.code, problem.place) == (Mistake.KIND, place)
    assert hint in problem.hint


def test_loads_that_clash_are_none_that_is_missing():
    for loads, code in (({}, Mistake.MISSING), ({"d": 0.0, "F_star": 1e-5}, Mistake.CLASH)):
        with pytest.raises(tb.errors.InvalidValue) as raised:
            tb.solve(CONTACT, **loads)
        assert raised.value.problems[0].code is code
