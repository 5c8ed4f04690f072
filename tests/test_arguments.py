"""Every public function with what is no argument: one sentence that names it, no error of Python.

The functions are found by signature, not by a list. What each needs for a first call stands in
`SAMPLES` and in the signature; a function is tried with each of its arguments wrong in turn.
"""

import copy
import inspect
import pickle
import re
import warnings

import numpy as np
import pytest
from refusals import Mistake, refuses
from test_signatures import PUBLIC

import thirdbody as tb
from thirdbody.quantities.arguments import NamesArguments, misfits, names_arguments

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
PAIR = tb.MaterialPair(STEEL, STEEL)
SIZES = tb.LogNormal(median=3e-6, gsd=1.5)
CONTACT = tb.Contact(surfaces=PAIR, roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
SURFACE = tb.surfaces.self_affine(
    sigma=1e-7, hurst=0.8, shortest=4e-7, longest=6e-6, spacing=1e-7, points=64
)
SAMPLES = {
    **{"contact": CONTACT, "surfaces": PAIR, "material": SILICA, "particle": SILICA},
    **{"diameter": SIZES, "sizes": SIZES, "moments": SURFACE.moments_at(), "surface": SURFACE},
    **{"code": "18/16/13", "kind": "as4059", "standard": "as4059", "grade": "6A/6B/6C"},
    **{
        "weighting": "volume",
        "overrides": [],
        "first": tb.surfaces.Finish(Ra=2e-7, process="ground"),
    },
    **{"value": 500.0, "start": "HV", "end": "GPa", "scale": "HV", "level": "middle"},
    **{"place": "filter", "state": "18/16/13", "bearing": "ball", "source": "example"},
    **{"quantity": "force", "debris": "hard", "form": "power", "by": "number"},
    **{"radius": 1e-3, "load": 1.0, "amplitude": 1e-7, "pressure": 5e6, "h": 1.0},
    **{"concentration": 1e9, "gap": 1e-6, "fraction": 0.1, "n": 1, "size": 4},
}
WRONG = {
    "None": None, "object": object(), "a mapping": {"a": 1}, "a list": ["a", None],
    "a class": int, "bytes": b"x", "an array": np.zeros((2, 2, 2)),
}  # fmt: skip
INSTANCES = (
    *(
        SIZES,
        tb.distributions.Histogram(edges=(1e-7, 2e-7), counts=(1.0,)),
        tb.heights.GaussianHeights(),
        SURFACE,
    ),
    *(tb.Uncertain.normal(mean=1.0, std=0.1), tb.asperity.ZMC(), tb.particle.Series()),
    *(tb.table(CONTACT, tolerance=1e-2), tb.solve(CONTACT, F_star=[1e-6, 1e-5])),
    *(tb.grains.WeibullStrength(sigma_0=1e7, x_0=1e-6, m=3.0), tb.films.Point(R=0.01)),
    *(tb.films.Oil(eta=0.02, alpha=2e-8), tb.films.HamrockDowson()),
)
HOOKS = {"Series.probe"}
"""Called by the library alone, with a shape of its own."""
LONG = {"assess", "design", "propagate", "sensitivity", "sweep", "explicit.ensemble"}
"""Functions that work for seconds before they look at the last of their arguments."""
RAW = (TypeError, AttributeError, LookupError, ArithmeticError, ValueError, AssertionError)


def bound():
    """Public functions that can be called here, and methods of `INSTANCES`."""
    for name, function in PUBLIC:
        parameters = inspect.signature(function).parameters
        if "self" not in parameters and "cls" not in parameters:
            yield name, function
    for instance in INSTANCES:
        for key in dir(type(instance)):
            method = inspect.getattr_static(type(instance), key)
            if not key.startswith("_") and inspect.isfunction(method):
                yield f"{type(instance).__name__}.{key}", getattr(instance, key)


def calls():
    for name, function in bound():
        if name in LONG | HOOKS:
            continue
        parameters = [
            each
            for each in inspect.signature(function).parameters.values()
            if each.kind is not each.VAR_KEYWORD
        ]
        for each in parameters:
            if "Any" not in str(each.annotation) and each.annotation is not each.empty:
                yield name, function, parameters, each


CALLS = list(calls())


def called(function, parameters, wrong, value):
    """What a call raises, with one argument wrong; None where it is taken."""
    given = {
        each.name: SAMPLES.get(each.name, 1e-7)
        for each in parameters
        if each.default is each.empty and each.kind is not each.VAR_POSITIONAL
    }
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            if wrong.kind is wrong.VAR_POSITIONAL:
                function(*given.values(), value)
            else:
                function(**given | {wrong.name: value})
    except Exception as error:
        return error
    return None


@pytest.mark.parametrize(
    ("name", "function", "parameters", "wrong"),
    CALLS,
    ids=[f"{name}-{wrong.name}" for name, _, _, wrong in CALLS],
)
def test_what_is_no_argument_is_refused_in_words(
    name, function, parameters, wrong, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)  # some write
    for kind, value in WRONG.items():
        error = called(function, parameters, wrong, value)
        assert error is None or isinstance(error, tb.errors.ThirdBodyError), f"{kind}: {error!r}"


def test_a_keyword_that_a_function_has_not_is_answered_with_the_one_meant():
    for call, place, meant in (
        (lambda: tb.solve(CONTACT, presure=1e6), "presure", "pressure"),
        (lambda: tb.transitions(CONTACT, colour="red"), "colour", None),
        (lambda: tb.propagate(CONTACT, sampels=16, F_star=1e-5), "sampels", "samples"),
        (lambda: tb.sizes.read_sizes("a.csv", weigthing="area"), "weigthing", "weighting"),
    ):
        with refuses(Mistake.UNKNOWN, place, meant=meant):
            call()


def test_what_is_missing_or_has_no_name_is_said():
    for call, *places in (
        (lambda: tb.solve(CONTACT, 5e6), ""),
        (lambda: tb.solve(CONTACT, True), ""),
        (lambda: tb.solve(), "contact"),
        (lambda: tb.design(CONTACT), "vary", "objective"),
        (lambda: tb.Roughness(1e-7, 2.8e-6), "Roughness"),
        (lambda: tb.Roughness(sigma=1e-7), "Roughness.R"),
        (lambda: tb.MaterialPair(STEEL), "MaterialPair.second"),
    ):
        with pytest.raises(tb.errors.WrongKind) as refused:
            call()
        told = [(one.code, one.place) for one in refused.value.problems]
        assert told == [(Mistake.MISSING, place) for place in places]
    with refuses(Mistake.MISSING, "", says="pressure="):
        tb.solve(CONTACT, 5e6)
    for value in (CONTACT, tb.Roughness(sigma=1e-7, R=2.8e-6)):  # copies are made without arguments
        assert pickle.loads(pickle.dumps(value)) == value == copy.deepcopy(value)


@pytest.mark.parametrize("module", [tb, tb.systems, tb.systems.life])
def test_a_misspelt_name_of_a_module_is_answered_with_the_one_meant(module):
    name = module.__all__[-1]
    with pytest.raises(AttributeError, match=re.escape(f"did you mean {name}?")):
        getattr(module, name[:-1] + name[-1] * 2)
    with pytest.raises(AttributeError, match=r"__wrapped__'$"):
        _ = module.__wrapped__


def test_a_text_in_the_place_of_a_number_or_sizes_is_answered_with_what_to_write():
    with refuses(Mistake.UNIT, "pressure", says="length"):
        tb.solve(CONTACT, pressure="5 mm")
    with refuses(Mistake.KIND, "pressure"):
        tb.solve(CONTACT, pressure="5 MPa")
    for size in ("3 um", 3e-6):
        with refuses(Mistake.KIND, "Particles.diameter", says="Monodisperse(mean=3e-06)"):
            tb.Particles(material=SILICA, areal_density=1e9, diameter=size)


def test_most_public_functions_are_called():
    names = {name for name, *_ in CALLS}
    assert {"solve", "load_study", "transitions", "sizes.read_sizes", "plot.area"} <= names
    assert {"ContactTable.to_csv", "LogNormal.ppf", "systems.rough_body.rough_sphere"} <= names
    assert len(CALLS) > 400


@pytest.mark.parametrize("value", [None, 3, {}, object(), b"a"])
def test_paths_are_asked_for_by_name(value):
    table = tb.table(CONTACT, tolerance=1e-2)
    doors = (tb.load_study, tb.sizes.read_sizes, table.to_csv, table.to_abaqus, table.to_c)
    for door in doors:
        with refuses(Mistake.KIND, "path"):
            door(value)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: tb.transitions(CONTACT, window=3), r"^window = 3 must be 2 values, a number and a number$"),
        (lambda: tb.transitions(CONTACT, eps_1="a"), r"^eps_1 = 'a' must be a number$"),
        (lambda: tb.equilibria.solve_states(CONTACT, pressure=1e6, vary=[1]), r"^vary = a list must be a mapping"),
        (lambda: tb.sensitivity(CONTACT, of=3, pressure=1e6), r"^of = 3 must be text or a list of texts$"),
        (lambda: tb.design(CONTACT, vary={}, objective=None), r"^objective = None must be an Objective or a list"),
        (lambda: tb.sweep(CONTACT, pressure=[1e6], out=3.5), r"^out = 3.5 must be the path of a file or None$"),
        (lambda: tb.sweep(CONTACT, pressure=[1e6], client=object()), r"^client = .* must be a Client"),
        (lambda: tb.materials.search(3), r"^query = 3 must be text$"),
        (lambda: tb.materials[["S45C"]], r"^name = a list must be text$"),
        (lambda: tb.surfaces.Finish(Ra=1e-7, process=["ground"]), r"^Finish.process = a list must be text or None$"),
    ],
)  # fmt: skip
def test_an_argument_of_another_kind_is_named(call, words):
    with pytest.raises(tb.errors.InvalidValue, match=words):
        call()


def test_every_public_function_that_takes_anything_is_marked():
    """Without a mark it fails in words of Python; methods that the library alone calls may."""
    bare = {
        name
        for name, function in PUBLIC
        if not hasattr(function, "__wrapped__")
        and not name.endswith("__init__")
        and {*inspect.signature(function).parameters} - {"self", "cls"}
    }
    assert bare == {
        *(
            "results.Assessment.page",
            "errors.InvalidValue.move_under",
            "errors.InvalidValue.name_source",
            "errors.Mistake.clause",
        ),  # texts
        *(f"errors.Problem.{key}" for key in ("changed", "move_under", "put_at", "put_in_words")),
        *(f"outputs.Solved.{key}" for key in ("output", "total", "total_of_particles")),
        "particle.OneParticle.sinks",
    }


# ---------------------------------------------------------------- words that passed for others
@pytest.mark.parametrize(
    "call",
    [
        lambda: tb.solve(CONTACT, F_star=1e-5).modes(basis="are"),
        lambda: tb.solve(CONTACT, F_star=1e-5).modes(eps_1=1.5),
        lambda: tb.transitions(CONTACT, basis="are"),
        lambda: tb.asperity.ZMC().reduced("forces", 1.0),
        lambda: tb.equilibria.equal_share_size(
            CONTACT.replace(
                particles=tb.Particles(material=SILICA, areal_density=1e9, diameter=SIZES)
            ),
            F_star=1e-5,
            low=-1.0,
        ),
        lambda: tb.reference.exponential_gw(1.0, eta=1e12, sigma_s=1e-8, R=-1e-6, E_star=1e11),
    ],
)
def test_words_and_numbers_that_mean_nothing_are_refused(call):
    with pytest.raises(tb.errors.InvalidValue, match=r"^(basis|eps_1|quantity|low|R) = .* must"):
        call()


def test_words_of_single_contacts_are_refused():
    from thirdbody.effects.single import dent, heat

    sphere = dict(a_2=0.1, r=1.0, k=1.0)
    for name, word, call in (
        ("form", "series ", lambda word: heat.spreading(0.1, form=word)),
        ("kind", "maximum", lambda word: heat.sudden_share(0.1, kind=word)),
        ("flux", "hertzian", lambda word: heat.sudden_share(0.1, flux=word)),
        ("flux", "hertzian", lambda word: heat.moving_rise(0.1, flux=word)),
        ("ends", "uniform", lambda word: heat.sphere_resistance(0.1, ends=word, **sphere)),
        ("debris", "soft", lambda word: dent.sink(SILICA, hardness=1e9, debris=word)),
    ):
        with refuses(Mistake.OPTION, name, value=repr(word)):
            call(word)


def test_a_side_of_an_oil_that_does_not_exist_is_refused():
    """Counted from the end, 0 was surface 2."""
    from thirdbody.systems.oil_particles import FilmParticles

    oil = FilmParticles.from_iso4406(
        "18/16/13", surfaces=PAIR, material=SILICA, film=3e-7, entry=1.0
    )
    for call in (oil.dents, lambda side: oil.largest(1e-6, side=side)):
        for side in (0, 3, -1, 1.5, True, None):
            with refuses(Mistake.OPTION, "side"):
                call(side)
    with refuses(Mistake.OPTION, "side", value="-1"):
        oil.sinks(-1)
    with refuses(Mistake.RANGE, "area", value="nan"):
        oil.largest(float("nan"))
    assert oil.replace(debris="hard").dents().embedded <= 1.0


# ---------------------------------------------------------------- the check itself
def test_a_failure_with_arguments_that_fit_passes_as_it_is():
    @names_arguments
    def broken(load: float) -> float:
        raise KeyError(load)

    with pytest.raises(KeyError):
        broken(1.0)
    with refuses(Mistake.KIND, "load", value="'a'"):
        broken("a")


def test_what_works_is_never_refused():
    @names_arguments
    def lenient(load: float) -> object:
        return load

    assert lenient("a") == "a"


def test_an_outer_function_names_its_own_argument():
    @names_arguments
    def inner(R: float) -> float:
        return R * 1.0

    @names_arguments
    def outer(radius: float) -> float:
        return inner(radius)

    with refuses(Mistake.KIND, "radius", value="None"):
        outer(None)


@pytest.mark.parametrize("value", [1, 1.5, np.float64(2), np.array(3.0), np.int32(4)])
def test_numbers_of_all_makes_are_numbers(value):
    def of_number(x: float, y: "np.ndarray | None" = None): ...

    assert misfits(of_number, (value,), {"y": np.ones(3)}) == []


# ---------------------------------------------------------------- what is left out or misspelt
def built(module=tb, seen=None):
    """Classes that users build, by the names that they write."""
    seen = set() if seen is None else seen
    for name in module.__all__:
        thing = getattr(module, name)
        if inspect.ismodule(thing):
            yield from built(thing, seen)
        elif isinstance(thing, type) and issubclass(thing, NamesArguments) and thing not in seen:
            seen.add(thing)
            parameters = inspect.signature(thing).parameters.values()
            if parameters and not any(each.kind is each.VAR_KEYWORD for each in parameters):
                yield name, thing


DOORS = [*bound(), *built()]


def needed_by(function):
    return {
        each.name
        for each in inspect.signature(function).parameters.values()
        if each.default is each.empty and each.kind not in (each.VAR_POSITIONAL, each.VAR_KEYWORD)
    }


@pytest.mark.parametrize(
    ("name", "function"),
    [(name, door) for name, door in DOORS if needed_by(door)],
    ids=lambda each: each if isinstance(each, str) else "",
)
def test_every_argument_that_is_left_out_is_named(name, function):
    for _ in range(2):
        with pytest.raises(tb.errors.InvalidValue) as raised:
            function()
        assert isinstance(raised.value, TypeError)
        problems = raised.value.problems
        assert {(each.code, each.path) for each in problems} == {
            (Mistake.MISSING, each) for each in needed_by(function)
        }


def test_most_doors_that_need_something_are_called():
    names = {name for name, door in DOORS if needed_by(door)}
    assert {"Oil", "Material", "Roughness", "Topography", "solve", "films.mixed_film"} <= names
    assert len(names) > 100


def test_what_an_argument_is_stands_behind_its_name():
    for door, words in [(tb.films.Oil, ("η", "Pa s")), (tb.films.mixed_film, ("speed", "m/s"))]:
        with pytest.raises(tb.errors.WrongKind) as raised:
            door()
        told = [each for each in raised.value.problems if each.path in ("eta", "speed")]
        assert all(word in each.rule for each in told for word in words)
        assert len(told) == 1


@pytest.mark.parametrize(("name", "door"), list(built()))
def test_a_misspelt_keyword_is_answered_with_the_one_meant(name, door):
    key = max(inspect.signature(door).parameters, key=len)
    with pytest.raises(tb.errors.WrongKind) as raised:
        door(**{f"{key}x": 1.0})
    unknown = [each for each in raised.value.problems if each.code == Mistake.UNKNOWN]
    assert [(each.path, each.meant) for each in unknown] == [(f"{key}x", key)]
    missing = {each.path for each in raised.value.problems if each.code == Mistake.MISSING}
    assert missing == needed_by(door) - {key}


def test_a_copy_needs_no_arguments():
    with pytest.raises(tb.errors.WrongKind):
        tb.films.Oil()
    oil = tb.films.Oil(eta=0.04, alpha=2e-8)
    assert copy.copy(oil) == pickle.loads(pickle.dumps(oil)) == oil
