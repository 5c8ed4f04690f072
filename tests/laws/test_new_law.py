"""A new law is one file and one import line; the page that says so is followed here."""

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
from numpy.testing import assert_allclose
from refusals import Mistake, refuses
from scipy.special import ndtr
from twins import base, material

import thirdbody as tb
from thirdbody import definition
from thirdbody.laws.base import AbstractParticleLaw
from thirdbody.populations.materials import reduced_modulus
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
FILE, IMPORT, USE, PEGS, PEGS_IMPORT, PEGS_USE = re.findall(
    r"^```python\n(.*?)^```$", PAGE, re.S | re.M
)
TABLE, _ENTRY_POINTS, PEGS_TABLE = re.findall(r"^```toml\n(.*?)^```$", PAGE, re.S | re.M)


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A temporary package with three laws, one a file, and their imports in another."""
    folder = tmp_path / "extra_laws"
    folder.mkdir()
    (folder / "truncated.py").write_text(textwrap.dedent(ONE_FILE), "utf-8")
    (folder / "abrupt.py").write_text(FILE, "utf-8")
    (folder / "pegs.py").write_text(PEGS, "utf-8")
    lines = f"from .truncated import Truncated\n{IMPORT}{PEGS_IMPORT}"
    (folder / "__init__.py").write_text(lines, "utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    before = [(kind, dict(kind)) for kind in (tb.asperity.REGISTRY, tb.particle.REGISTRY)]
    yield importlib.import_module("extra_laws")
    for registry, known in before:
        for name in registry.keys() - known.keys():
            del registry[name]
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
        particle_law=tb.particle.Series(deep="off", law=law, seat="plane", shadow="none"),
    )
    gap = 2.2e-7
    m_1, m_2 = (float(dusty.particles.diameter.partial_moment(n, gap, 1.0)) for n in (1, 2))
    state = tb.solve(dusty, d=gap)
    want = 0.5 * math.pi * 5e9 * density * (m_2 - gap * m_1)
    assert state.F_sa_star * interface.E_ss == pytest.approx(want, rel=1e-9)

    # and in everything built on top
    assert tb.Contact.from_dict(dusty.to_dict()) == dusty
    assert "Abbott" in tb.cite(dusty)
    on_rough = dusty.replace(particle_law=tb.particle.Series(deep="off", law=law))
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


SPREAD = tb.TruncatedGaussian(mean=3e-7, std=4e-8)


def pegs(law, sizes=SPREAD, **more):
    """A contact of unlike surfaces with pegs between them."""
    steel, soft = tb.materials["S45C"], tb.Material(E=110e9, nu=0.33, H=1.5e9)
    dust = tb.Particles(material=tb.materials["SiO2"], diameter=sizes, areal_density=2e11)
    return tb.Contact(
        surfaces=tb.MaterialPair(steel, soft),
        roughness=tb.Roughness(sigma=1e-7, R=2.8e-6),
        particles=dust,
        particle_law=law.replace(**more),
    )


def by_quadrature(contact, d):
    """F_sa [Pa], area on surface 1 by regime, area on surface 2: sums of the formulas of a peg."""
    dust, pair, rough = contact.particles, contact.surfaces, contact.roughness
    E = [reduced_modulus(body, dust.material) for body in (pair.first, pair.second)]
    H = [min(body.H, dust.material.H) for body in (pair.first, pair.second)]
    stiffness, full = E[0] * E[1] / (E[0] + E[1]), math.pi / 4
    kink = full * min(H) / stiffness
    assert H[0] > H[1]  # surface 1 stays elastic

    def peg(eps):
        load = np.clip(stiffness * eps, 0.0, full * min(H))
        area, none = np.where(eps > 0, full, 0.0), np.zeros_like(eps)
        return np.stack([load, area, none, none, area])

    if contact.particle_law.seat == "plane":
        found = definition.over_sizes(
            dust.diameter, lambda x: x**2 * peg(1 - d / x), splits=[d, d / (1 - kink)]
        )
    else:
        gap, width = d + rough.y_s, rough.sigma

        def on_seats(x, eps):
            z = (gap - x * (1 - eps)) / width
            return x**3 * np.exp(-0.5 * z**2) / (math.sqrt(2 * math.pi) * width) * peg(eps)

        def embedded(x):
            return x**2 * ndtr((x * (1 - kink) - gap) / width) * peg(kink + 0 * x)

        found = definition.over_sizes(dust.diameter, on_seats, [0.0, kink])
        found = found + definition.over_sizes(dust.diameter, embedded)
    return dust.areal_density * found


@pytest.mark.parametrize("shadow", ["footprint", "projected", "covered", "none"])
@pytest.mark.parametrize("seat", ["plane", "rough"])
@pytest.mark.parametrize(
    "sizes", [SPREAD, tb.distributions.Monodisperse(mean=3e-7)], ids=["spread", "one"]
)
def test_the_particle_law_of_the_page_is_summed(package, sizes, seat, shadow):
    contact = pegs(package.Pegs(), sizes, seat=seat, shadow=shadow)
    d = 2.6e-7
    F_sa, A_e, A_ep, A_p, A_sa2 = by_quadrature(contact, d)
    state = tb.solve(contact, d=d)
    assert state.F_sa_star * contact.E_ss == pytest.approx(F_sa, rel=1e-9)
    assert A_ep == A_p == 0.0
    assert (state.A_sa, state.A_sa2) == pytest.approx((A_e, A_sa2), rel=1e-9)
    # both ends are as wide as the peg
    coverage = contact.particles.coverage
    want = {"covered": coverage, "none": 0.0}.get(shadow, A_e)
    assert state.shadow == pytest.approx(want, rel=1e-9)
    bare = tb.solve(contact.replace(particles=None), d=d)
    assert state.F_ss_star == pytest.approx((1 - want) * bare.F_ss_star, rel=1e-9)


def test_the_particle_law_of_the_page_works_everywhere(package, tmp_path):
    """The page's own file, import line, contact and study table."""
    plain = pegs(package.Pegs())
    given = {item.name: getattr(plain, item.name) for item in dataclasses.fields(plain)}
    given.pop("particle_law")
    names = {"tb": tb, "given": given, "Pegs": package.Pegs}
    exec(PEGS_USE.replace("...", "**given").strip(), names)
    contact = names["contact"]
    assert contact.particle_law == package.Pegs(seat="plane")
    assert tb.Contact.from_dict(contact.to_dict()) == contact
    assert "teaching example" in tb.cite(contact)

    one = package.Pegs().one(surfaces=contact.surfaces, particle=contact.particles.material)
    single = contact.particle_law.single(
        2e-7, [1.9e-7, 2.1e-7], surfaces=contact.surfaces, particle=contact.particles.material
    )
    squeeze = min(1e-8 / 2e-7, one.kinks[0])
    assert_allclose(single["force"], [one.stiffness * squeeze * 2e-7**2, 0.0], rtol=1e-12)
    assert single["regime"].tolist() == ["elastic", "none"]

    loads = np.geomspace(1e-7, 1e-3, 40)
    counted = contact.replace(outputs=(tb.outputs.Counts(),))
    for case in (contact, counted.replace(**{"particle_law.seat": "rough"})):
        states = tb.solve(case, F_star=loads)
        np.testing.assert_allclose(states.F_star, loads, rtol=1e-9)
        assert np.all(states.residual < 1e-12)
        again = tb.solve(case, d=states.d)
        for name in ("F_sa_star", "A_t", "A_e", "A_p", "shadow"):
            np.testing.assert_allclose(getattr(again, name), getattr(states, name), rtol=1e-9)
    sigma = np.linspace(0.9e-7, 1.2e-7, 30)
    found = tb.equilibria.solve_states(contact, F_star=1e-5, vary={"roughness.sigma": sigma})
    alone = tb.solve(contact.replace(**{"roughness.sigma": sigma[7]}), F_star=1e-5)
    assert found["A_t"][7] == pytest.approx(alone.A_t, rel=1e-9)

    example = (ROOT / "examples" / "soft_ptfe_particles.toml").read_text("utf-8")
    without = re.sub(r"^\[particle_law\]\n(?:[^\[\n].*\n|\n)*", "", example, flags=re.M)
    study = tmp_path / "study.toml"
    study.write_text(f"{without}\n{PEGS_TABLE}", "utf-8")
    assert load_study(study).contact.particle_law == package.Pegs(seat="plane")


def test_pegs_of_equal_numbers_share_their_sums(package):
    from thirdbody.contact.particle_averages import size_average

    contact = pegs(package.Pegs())
    sizes = contact.particles.diameter.standardised()[1]
    one, two = (
        size_average(law.one(surfaces=contact.surfaces, particle=contact.particles.material), sizes)
        for law in (package.Pegs(), package.Pegs(seat="plane", shadow="none"))
    )
    assert one is two


def test_particles_wider_than_their_size_may_jam(package, monkeypatch):
    monkeypatch.setattr(package.pegs.OnePeg, "breadth", 100.0)
    contact = pegs(package.Pegs())
    with refuses(Mistake.FULL, "", says="law pegs would cover 1.44"):
        tb.solve(contact, F_star=1e-5)


def test_a_law_without_seat_and_sum_says_so(package):
    kind = type("Nowhere", (AbstractParticleLaw,), {"name": "test-nowhere", "one": None})
    kind = dataclasses.dataclass(frozen=True)(kind)
    with refuses(Mistake.BEYOND, "", says="test-nowhere"):
        tb.solve(pegs(kind()), F_star=1e-5)


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

        def of_asperities(d):
            """Their load, had no particle kept any of them apart."""
            state = tb.solve(dusty, d=d)
            return float(state.F_ss_star / (1 - state.shadow))

        return of_asperities, dusty.roughness.sigma

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
    assert not {"test-moved", "test-nowhere", "pegs"} & set(tb.particle.REGISTRY)
