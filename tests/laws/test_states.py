"""Laws and heights through the whole machine, with and without particles."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose
from subjects import FIRST, HEIGHTS, SIGMA_S, SUBJECTS, Subject, contact

import thirdbody as tb

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
STATUS = {"found", "jump", "never p-s", "always p-s", "always s-s", "never s-s", "none"}
STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
LOADS = np.geomspace(1e-7, 3e-4, 7)
DUST = tb.Particles(
    material=SILICA,
    areal_density=1e11,
    diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
)


def paper(law: tb.asperity.AbstractAsperityLaw, **changes) -> tb.Contact:
    return tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        asperity_law=law,
        particles=DUST,
        particle_law=tb.particle.Series(deep="off"),
    ).replace(**changes)


def gentle(subject: Subject) -> tb.asperity.AbstractAsperityLaw:
    """The law with the work of adhesion of clean oxide, and ν left to the contact."""
    changes = {"w": 0.05} if hasattr(subject.law, "w") else {}
    if hasattr(subject.law, "nu"):
        changes["nu"] = None
    return subject.law.replace(**changes)


def balanced(state: tb.results.Equilibrium, loads: np.ndarray) -> None:
    assert set(state.status) == {"ok"}, set(state.status)
    for name, column in state.columns().items():
        if column.dtype.kind == "f":
            assert np.all(np.isfinite(column)), name
    assert np.all(state.residual < 1e-9)
    assert_allclose(state.F_ss_star + state.F_sa_star, loads, rtol=1e-9)
    assert_allclose(state.A_t, state.A_ss + state.A_sa, rtol=1e-12)
    assert_allclose(state.A_t, state.A_e + state.A_ep + state.A_p, rtol=1e-12)
    assert np.all(np.diff(state.d) < 0)


each = pytest.mark.parametrize("subject", SUBJECTS, ids=lambda subject: subject.label)


@each
def test_asperity_law_beside_particles(subject: Subject):
    one = paper(gentle(subject))
    balanced(tb.solve(one, F_star=LOADS), LOADS)
    found = tb.transitions(one)
    for critical in (found.F_cr1, found.F_cr2, *(getattr(found.F_tpca, n) for n in "ABC")):
        assert critical.status in STATUS
        assert (critical.value is None) == (critical.status not in ("found", "jump"))


@each
def test_sweep(subject: Subject):
    data = tb.sweep(
        paper(gentle(subject)),
        F_star=LOADS[2:6],
        vary={"particles.diameter.mean": [0, 300e-9]},
    )
    assert data.sizes == {"particles.diameter.mean": 2, "F_star": 4}
    assert set(data.status.values.ravel()) == {"ok"}
    assert np.all(np.isfinite(data.A_t))
    assert np.all(data.A_sa[0] == 0)


@each
def test_the_contact_fills_in_its_constants(subject: Subject):
    """ν and ratios come from the softer body; a given ν is kept."""
    if not hasattr(subject.law, "nu"):
        assert tb.solve(paper(gentle(subject)), F_star=1e-5).status == "ok"
        return
    open_, given = gentle(subject), subject.law.replace(nu=STEEL.nu)
    one, two = (tb.solve(paper(law, particles=None), F_star=LOADS) for law in (open_, given))
    assert_allclose(one.A_t, two.A_t, rtol=1e-13)
    soft = tb.Material(E=STEEL.E, nu=0.45, H=0.9 * STEEL.H)
    for pair in (tb.MaterialPair(STEEL, soft), tb.MaterialPair(soft, STEEL)):
        bare = paper(open_, particles=None, surfaces=pair)
        other = paper(subject.law.replace(nu=0.45), particles=None, surfaces=pair)
        assert_allclose(
            tb.solve(bare, F_star=LOADS).A_t, tb.solve(other, F_star=LOADS).A_t, rtol=1e-13
        )


SQUEEZED = ("gw", "ceb", "zmc", "hermite", "ke", "jg")


@pytest.mark.parametrize("name", SQUEEZED)
def test_law_of_the_particles(name):
    law = gentle(FIRST[name])
    one = paper(FIRST["zmc"].law, particle_law=tb.particle.Series(deep="off", law=law))
    balanced(tb.solve(one, F_star=LOADS), LOADS)
    assert tb.transitions(one).F_cr1.status in STATUS


@pytest.mark.parametrize("name", SQUEEZED)
def test_law_of_one_particle_between_equal_surfaces(name):
    """Each side carries the load of the law with half the squeeze, up to the great circle."""
    law = FIRST[name].law
    one = tb.particle.Series(deep="off", law=law)
    x = 300e-9
    delta = x * np.geomspace(1e-5, 0.1, 12)
    got = one.single(x, x - delta, surfaces=tb.MaterialPair(STEEL, STEEL), particle=SILICA)
    E = 1 / (1 / STEEL.plane_strain_modulus + 1 / SILICA.plane_strain_modulus)
    case = {"R": x / 2, "E_star": E, "H": min(STEEL.H, SILICA.H)}
    free = law.area(delta / 2, **case) < 0.999 * np.pi * x**2 / 4
    assert_allclose(got["force"][free], law.force(delta / 2, **case)[free], rtol=1e-9)
    assert_allclose(got["area_1"][free], law.area(delta / 2, **case)[free], rtol=1e-9)
    assert np.sum(free) > 8


@pytest.mark.parametrize("name", ["gw", "zmc", "hermite", "ke", "jg", "ceb"])
def test_law_of_the_particles_between_unequal_surfaces(name):
    soft = tb.Material(E=70e9, nu=0.33, H=1.5e9)
    one = paper(
        FIRST["zmc"].law,
        surfaces=tb.MaterialPair(STEEL, soft),
        particle_law=tb.particle.Series(deep="off", law=gentle(FIRST[name]), seat="plane"),
    )
    balanced(tb.solve(one, F_star=LOADS), LOADS)


@pytest.mark.parametrize("heights", [h for h in HEIGHTS if h != "gaussian"])
@pytest.mark.parametrize("name", ["gw", "ceb"])
def test_heights_with_particles(name, heights):
    """The canonical surface, so that its sums are shared with the other tests."""
    dust = tb.Particles(
        material=SILICA,
        areal_density=1e11,
        diameter=tb.TruncatedGaussian(mean=3 * SIGMA_S, std=0.2 * SIGMA_S),
    )
    one = contact(FIRST[name].law, HEIGHTS[heights], particles=dust)
    loads = np.geomspace(1e-7, 3e-4, 5)
    balanced(tb.solve(one, F_star=loads), loads)
    assert tb.transitions(one).F_cr2.status in STATUS
    data = tb.sweep(one, pressure=[1e6, 1e7], vary={"particles.areal_density": [0, 1e11]})
    assert set(data.status.values.ravel()) == {"ok"}


def test_pull_off():
    """Only adhesive laws pull, unloading more than loading; nothing pulls harder anywhere."""
    laws = [FIRST["jkr"].law.replace(unloading=True), FIRST["jkr"].law, FIRST["dmt"].law]
    pulls = [tb.equilibria.pull_off(contact(law)) for law in laws]
    assert pulls[0][0] > pulls[1][0] >= 0
    assert pulls[2][0] > 0
    for law, (pressure, d) in zip(laws, pulls, strict=True):
        at = tb.solve(contact(law), d=d + np.linspace(-2, 2, 41) * SIGMA_S)
        assert at.pressure.min() >= -pressure * (1 + 1e-9)
        assert_allclose(at.pressure[20], -pressure, rtol=1e-12)
    assert tb.equilibria.pull_off(contact(FIRST["gw"].law))[0] == 0


@pytest.mark.parametrize("name", ["dmt", "jkr"])
def test_adhesion_that_fades_leaves_hertz(name):
    d = np.array([0.5, 1.5, 3.0]) * SIGMA_S
    weak = tb.solve(contact(FIRST[name].law.replace(w=1e-9)), d=d)
    gw = tb.solve(contact(FIRST["gw"].law), d=d)
    assert_allclose(weak.F_star, gw.F_star, rtol=1e-3)
    assert_allclose(weak.A_t, gw.A_t, rtol=1e-3)


def test_warnings_are_sentences():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        tb.solve(contact(FIRST["gw"].law), d=-2.0 * SIGMA_S)
    assert any("A_t" in str(one.message) for one in caught)
