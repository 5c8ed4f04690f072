"""A new asperity law is one file and one import line; the page that says so is followed here."""

import dataclasses
import importlib
import math
import re
import sys
import textwrap
from pathlib import Path

import numpy as np
import oracle
import pytest
from twins import base, material

import thirdbody as tb
from thirdbody.study import load_study

ONE_FILE = '''
"""Perfectly plastic asperities: every contact is cut geometrically at the hardness."""

from dataclasses import dataclass

import numpy as np

from thirdbody.laws.base import AbstractAsperityLaw, Branch


@dataclass(frozen=True, slots=True, kw_only=True)
class Truncated(AbstractAsperityLaw):
    """A = 2πRω, F = HA. The interference of first yield only sets a scale here."""

    name = "test-truncated"
    title = "Geometric truncation"
    year = 1933
    citation = "Abbott, Firestone 1933"
    provenance = "derived"
    valid_range = "fully plastic contact"

    def yield_interference(self, *, R, E_star, H):
        return R * (H / E_star) ** 2

    @property
    def breakpoints(self):
        return ()

    @property
    def branches(self):
        return (
            Branch("plastic", lambda y: 2 * y, lambda y: 2 * y, lambda y: np.full_like(y, 2.0)),
        )
'''


ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "add-a-law.md").read_text("utf-8")
FILE, IMPORT, USE = re.findall(r"^```python\n(.*?)^```$", PAGE, re.S | re.M)
(TABLE,) = re.findall(r"^```toml\n(.*?)^```$", PAGE, re.S | re.M)


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A temporary package with two laws, one a file, and their imports in another."""
    folder = tmp_path / "extra_laws"
    folder.mkdir()
    (folder / "truncated.py").write_text(textwrap.dedent(ONE_FILE), "utf-8")
    (folder / "abrupt.py").write_text(FILE, "utf-8")
    (folder / "__init__.py").write_text(f"from .truncated import Truncated\n{IMPORT}", "utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    before = dict(tb.asperity.REGISTRY)
    yield importlib.import_module("extra_laws")
    for name in list(tb.asperity.REGISTRY):
        if name not in before:
            del tb.asperity.REGISTRY[name]
    for name in [name for name in sys.modules if name.startswith("extra_laws")]:
        del sys.modules[name]


def test_a_new_law_works_everywhere(package):
    law = package.Truncated()
    assert tb.asperity.REGISTRY["test-truncated"] is package.Truncated
    args = {"R": 1e-6, "E_star": 1e11, "H": 5e9}
    assert float(law.force(1e-8, **args)) == pytest.approx(2 * math.pi * 1e-6 * 1e-8 * 5e9)
    assert float(law.energy(1e-8, **args)) == pytest.approx(math.pi * 1e-6 * 1e-16 * 5e9)
    assert str(law.regime(1e-8, **args)) == "plastic"

    # asperities: A = 2πηRσ_s F_1(h), F = HA, exactly
    interface = oracle.Interface()
    rough, d = interface.rough, 1.3e-7
    bare = base(interface).replace(asperity_law=law)
    state = tb.solve(bare, d=d)
    h = d / rough.sigma_s
    F_1 = oracle.normal(h) - h * oracle.normal_above(h)
    area = 2 * math.pi * rough.eta * rough.R * rough.sigma_s * F_1
    assert state.A_t == state.A_p == pytest.approx(area, rel=1e-10)
    assert state.F_star * interface.E_ss == pytest.approx(area * 5e9, rel=1e-10)
    assert tb.solve(bare, F_star=state.F_star).d == pytest.approx(d, rel=1e-9)

    # particles: F_sa = ½πH η_a x(x − d), also as the law of both sides of a particle
    x, density = 3e-7, 1e10
    dusty = bare.replace(
        particles=tb.Particles(
            material=material(oracle.SILICA),
            diameter=tb.TruncatedGaussian(mean=x, std=0.05 * x),
            areal_density=density,
        ),
        particle_law=tb.particle.Series(law=law, seat="plane", shadow="none"),
    )
    gap = 2.2e-7
    m_1, m_2 = (float(dusty.particles.diameter.partial_moment(n, gap, 1.0)) for n in (1, 2))
    state = tb.solve(dusty, d=gap)
    want = 0.5 * math.pi * 5e9 * density * (m_2 - gap * m_1)
    assert state.F_sa_star * interface.E_ss == pytest.approx(want, rel=1e-9)

    # and in everything built on top
    assert tb.Contact.from_dict(dusty.to_dict()) == dusty
    assert "Abbott" in tb.cite(dusty)
    on_rough = dusty.replace(particle_law=tb.particle.Series(law=law))
    loads = np.geomspace(1e-8, 1e-3, 6)
    states = tb.solve(on_rough, F_star=loads)
    np.testing.assert_allclose(states.F_star, loads, rtol=1e-9)
    assert tb.transitions(on_rough).F_cr2.status in {"found", "never s-s", "always s-s"}
    assert tb.sweep(on_rough, F_star=loads)["A_t"].shape == (6,)


def test_the_law_of_the_page_works_everywhere(package, tmp_path):
    """The page's own file, import line, contact and study table."""
    interface = oracle.Interface()
    rough = interface.rough
    plain = base(interface)
    given = {item.name: getattr(plain, item.name) for item in dataclasses.fields(plain)}
    given.pop("asperity_law")
    code = USE.replace("...", "**given").strip()
    names = {"tb": tb, "given": given, "Abrupt": package.Abrupt}
    exec(code, names)
    contact = names["contact"]
    assert contact.asperity_law == package.Abrupt(k=0.4)

    # A = πRω on both sides of yield: A_t = πηRσ_s F_1(h), exactly
    d = 1.3e-7
    state = tb.solve(contact, d=d)
    h = d / rough.sigma_s
    F_1 = oracle.normal(h) - h * oracle.normal_above(h)
    assert state.A_t == pytest.approx(
        math.pi * rough.eta * rough.R * rough.sigma_s * F_1, rel=1e-10
    )
    assert tb.solve(contact, F_star=state.F_star).d == pytest.approx(d, rel=1e-9)

    example = (ROOT / "examples" / "two_body_reference.toml").read_text("utf-8")
    assert "[asperity_law]" not in example
    study = tmp_path / "study.toml"
    study.write_text(f"{example}\n{TABLE}", "utf-8")
    assert load_study(study).contact.asperity_law == package.Abrupt(k=0.4)


def test_a_particle_law_sets_the_origin_of_d():
    """The hook that the page names moves the asperities, here by 0.7 σ."""
    (hook,) = re.findall(r"own origin\s+for `d`, override the property `(\w+)`", PAGE)
    horng = tb.particle.Horng2022

    def at(law):
        interface = oracle.Interface()
        dusty = base(interface).replace(
            particles=tb.Particles(
                material=material(oracle.SILICA),
                diameter=tb.TruncatedGaussian(mean=3e-7, std=2.4e-8),
                areal_density=1e10,
            ),
            particle_law=law,
        )
        return lambda d: float(tb.solve(dusty, d=d).F_ss_star), dusty.roughness.sigma

    one, sigma = at(horng(datum=0.0))
    registry = dict(tb.particle.REGISTRY)
    try:
        moved = type("Moved", (horng,), {"name": "test-moved", hook: property(lambda law: 0.7)})
        other, _ = at(moved(datum=0.0))
        assert other(4e-7) == pytest.approx(one(4e-7 - 0.7 * sigma), rel=1e-9)
    finally:
        tb.particle.REGISTRY.clear()
        tb.particle.REGISTRY.update(registry)


def test_the_registry_is_left_clean():
    assert not {"test-truncated", "abrupt"} & set(tb.asperity.REGISTRY)
    assert "test-moved" not in tb.particle.REGISTRY
