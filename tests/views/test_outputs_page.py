"""The table of outputs is the generated one, and a new output is one file and one import line."""

import importlib
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import thirdbody as tb
from thirdbody.laws.base import Law
from thirdbody.study import load_study
from thirdbody.views import outputs_page

ROOT = Path(__file__).parents[2]
GUIDE = ROOT / "docs" / "add-an-output.md"
STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
STRENGTH = 2e9

STUDY = """
[surfaces]
first = "S45C"
second = "S45C"
[roughness]
sigma = "100 nm"
R = "2.8 um"
[particles]
material = "SiO2"
distribution = "monodisperse"
mean = "300 nm"
areal_density = "1e11 / m^2"
[outputs.overload]
strength = "2 GPa"
[load]
F_star = 1e-5
"""


# ---------------------------------------------------------------- the page
@pytest.mark.check
def test_page_of_outputs_is_the_generated_one():
    """Made in a process of its own: other tests of this one may have brought outputs along."""
    command = [sys.executable, "-m", "thirdbody", "outputs", "--markdown"]
    done = subprocess.run(command, capture_output=True, text=True, check=True, encoding="utf-8")
    page = (ROOT / "docs" / "outputs.md").read_text("utf-8")
    assert page == done.stdout, "run: thirdbody outputs --markdown > docs/outputs.md"


def test_page_has_every_output_with_its_numbers():
    page = (ROOT / "docs" / "outputs.md").read_text("utf-8")
    shipped = [kind for kind in tb.outputs.REGISTRY.values() if _shipped(kind)]
    assert len(shipped) >= 8
    for kind in shipped:
        (part,) = re.findall(rf"^## `{kind.name}`: .*?(?=^## |\Z)", page, re.S | re.M)
        assert kind.doi in part
        for column in kind.columns:
            assert f"| `{column}` |" in part
        for field in kind.__dataclass_fields__:
            assert f"| `{field}` |" in part


def test_page_says_which_numbers_are_yours():
    yours = {
        (entry["name"], option["key"])
        for entry in outputs_page.entries()
        for option in entry["options"]
        if option["required"]
    }
    assert ("flash_temperature", "v") in yours
    assert ("wear", "K_ss") in yours
    assert ("flash_temperature", "T_1") not in yours
    page = (ROOT / "docs" / "outputs.md").read_text("utf-8")
    for _, key in yours:
        assert re.search(rf"^\| `{key}` \|.*\*\*yours\*\*", page, re.M), key


def _shipped(kind: type[Law]) -> bool:
    return kind.__module__.startswith("thirdbody.")


# ---------------------------------------------------------------- a new output
@pytest.fixture
def overload(tmp_path, monkeypatch):
    """The output of the guide: its block in one file, its import line in another."""
    output, line, *_ = re.findall(r"^```python\n(.*?)^```$", GUIDE.read_text("utf-8"), re.S | re.M)
    folder = tmp_path / "extra_outputs"
    folder.mkdir()
    (folder / "overload.py").write_text(output, "utf-8")
    (folder / "__init__.py").write_text(line, "utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    before = dict(tb.outputs.REGISTRY)
    yield importlib.import_module("extra_outputs").Overload
    for name in set(tb.outputs.REGISTRY) - set(before):
        del tb.outputs.REGISTRY[name]
    for name in [name for name in sys.modules if name.startswith("extra_outputs")]:
        del sys.modules[name]


def contact(*outputs, seat="rough", particles=True, second=STEEL):
    dust = tb.Particles(
        material=SILICA,
        areal_density=1e11,
        diameter=tb.TruncatedGaussian(mean=300e-9, std=40e-9),
    )
    return tb.Contact(
        surfaces=tb.MaterialPair(STEEL, second),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=dust if particles else None,
        particle_law=tb.particle.Series(deep="off", seat=seat),
        outputs=outputs,
    )


def load_of(eps):
    """Load over x² of a particle squeezed by ε, from a contact with one size on a plane."""
    x = 300e-9
    one = contact(seat="plane").replace(
        **{"particles.diameter": tb.distributions.Monodisperse(mean=x)}
    )
    state = tb.solve(one, d=(1 - eps) * x)
    return float(state.F_sa_star) * one.E_ss / 1e11 / x**2


def test_the_output_of_the_guide_counts_right(overload):
    """On a plane every particle larger than d/(1 − ε_c) is crushed, counted by the sizes."""
    case = contact(overload(strength=STRENGTH), seat="plane")
    critical = brentq(lambda eps: load_of(eps) - STRENGTH, 0.01, 0.6, xtol=1e-14)
    d = np.array([150e-9, 200e-9, 240e-9, 400e-9])
    with pytest.warns(tb.errors.RangeWarning, match=rf"^outputs\.{overload.name}: "):
        state = tb.solve(case, d=d)
    sizes = case.particles.diameter
    larger = [sizes.partial_moment(0, x, 1.0) for x in d / (1 - critical)]
    expected = 1e11 * np.array(larger) / sizes.partial_moment(0, 0, 1.0)
    assert 0.05 < expected[2] / 1e11 < 0.95  # otherwise the sizes are not seen
    np.testing.assert_allclose(state.outputs["n_crushed"], expected, rtol=1e-8, atol=1.0)


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
def test_the_output_of_the_guide_works_everywhere(overload, tmp_path):
    assert tb.outputs.REGISTRY["overload"] is overload
    output = overload(strength=STRENGTH)
    assert overload.from_dict(output.to_dict()) == output
    case = contact(output)
    F = np.geomspace(1e-6, 1e-4, 3)
    counted = tb.solve(case, F_star=F).outputs["n_crushed"]
    assert np.all(np.diff(counted) > 0)

    swept = tb.sweep(case, F_star=F, vary={"particles.diameter.mean": [300e-9]})
    np.testing.assert_allclose(swept["n_crushed"].values.ravel(), counted, rtol=1e-9)
    slopes = tb.sensitivity(case, of=["n_crushed"], to=["particles.areal_density"], F_star=F[1])
    assert np.isfinite(slopes.elasticity["n_crushed"]["particles.areal_density"])

    file = tmp_path / "crush.toml"
    file.write_text(STUDY, "utf-8")
    (asked,) = load_study(file).contact.outputs
    assert asked == overload(strength=2e9)
    assert "## `overload`: Crushed particles" in outputs_page.outputs_page()


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
def test_the_output_of_the_guide_knows_its_limits(overload):
    with pytest.raises(tb.errors.InvalidValue, match="strength"):
        overload(strength=0)
    with pytest.raises(tb.errors.InvalidValue, match="needs particles"):
        contact(overload(strength=1e8), particles=False)
    strong = contact(overload(strength=1e15))
    assert tb.solve(strong, F_star=1e-5).outputs["n_crushed"] == 0
    soft = STEEL.replace(H=2.5e9)
    ways = [
        tb.solve(contact(overload(strength=1e9), second=soft), F_star=1e-5),
        tb.solve(
            contact(overload(strength=1e9)).replace(surfaces=tb.MaterialPair(soft, STEEL)),
            F_star=1e-5,
        ),
    ]
    first, second = (float(state.outputs["n_crushed"]) for state in ways)
    assert 0 < first == pytest.approx(second, rel=1e-10)
