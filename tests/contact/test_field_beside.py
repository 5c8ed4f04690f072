"""The law of one field beside what was made for sums over summits: refused, or by its own range."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from refusals import Mistake, Status, balances_not, refuses

import thirdbody as tb
from thirdbody.contact.interface import interface
from thirdbody.equilibrium.critical_loads import critical_loads
from thirdbody.equilibrium.load_scan import load_scan
from thirdbody.equilibrium.states import state_columns
from thirdbody.systems.interaction import local_interaction, mean_interaction
from thirdbody.systems.mixed_film import mixed_film
from thirdbody.systems.stribeck import regime_speeds

SIGMA = 100e-9
FILM = {
    "conjunction": tb.films.Point(R=9.5e-3),
    "oil": tb.films.Oil(eta=0.02, alpha=2e-8),
}


def contact(H=5e9, *, density=0.0, **others):
    body = tb.Material(E=205e9, nu=0.29, H=H)
    dust = tb.Particles(
        material=tb.materials["SiO2"], areal_density=density,
        diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
    )  # fmt: skip
    given = {
        "surfaces": tb.MaterialPair(body, body),
        "roughness": tb.Roughness(sigma=SIGMA, R=2.8e-6),
        "particles": dust if density else None,
        "asperity_law": tb.asperity.Field(),
    }
    return tb.Contact(**given | others)


@pytest.mark.parametrize(
    "ask",
    [
        lambda case: mean_interaction(case, nominal_area=1e-6, pressure=5e6),
        lambda case: mean_interaction(case, nominal_area=1e-6, d_0=1e-7),
        lambda case: local_interaction(case, pressure=5e6),
    ],
)
def test_interaction_is_not_counted_twice(ask):
    with refuses(Mistake.BEYOND, "", says="interaction"):
        ask(contact())
    ask(contact(asperity_law=tb.asperity.ZMC()))


@pytest.mark.parametrize(
    ("H", "density"),
    [
        *((H, density) for density in (0.0, 1e11) for H in (2e9, 5e9, 20e9)),
        *((H, 4e11) for H in (2e9, 5e9)),
        pytest.param(20e9, 4e11, marks=pytest.mark.slow),  # hard and crowded: a dear ground
    ],
)
def test_its_lowest_separation_is_one_of_its_table(H, density):
    """Rounding at the end of a table made the scan of loads think that the load rises."""
    bound = interface(contact(H, density=density))
    d = np.array([bound.lowest, bound.asperities.deepest, bound.lowest + 0.1 * SIGMA])
    assert np.all(np.isfinite(bound.load(d)))
    assert all(np.all(np.isfinite(column)) for column in bound.fields(d).values())
    scan = load_scan(bound)
    assert np.all(np.isfinite(scan.log_F))
    assert scan.monotone
    assert len(tb.equilibria.roots(bound.contact, F_star=1e-3)) == 1


@pytest.mark.slow
def test_critical_loads_of_many_contacts_are_those_of_each():
    sigma = np.array([90e-9, 110e-9])
    for H in (5e9, 20e9):  # the second carries more than its table at F* = 1e-2
        case = contact(H, density=1e11)
        many = critical_loads(case, vary={"roughness.sigma": sigma}, count=2)
        for i, own in enumerate(sigma):
            one = tb.transitions(case.replace(roughness=case.roughness.replace(sigma=own)))
            for name, found in (("F_cr1", one.F_cr1), ("F_cr2", one.F_cr2)):
                loads, status = many[name]
                assert status[i] == found.status
                if found.value is not None:
                    assert loads[i] == pytest.approx(found.value, rel=1e-5)


def test_outputs_of_contacts_that_differ_in_their_particles():
    """Particles on ground that gives way stand elsewhere where there are more of them."""
    case = contact(outputs=(tb.outputs.Counts(),), density=1e10)
    densities = np.array([1e10, 4e11])
    both = state_columns(case, F_star=np.full(2, 2e-3), vary={"particles.areal_density": densities})
    for i, density in enumerate(densities):
        one = tb.solve(case.replace(particles=case.particles.replace(areal_density=density)),
                       F_star=2e-3)  # fmt: skip
        for name, value in one.outputs.items():
            assert both[name][i] == pytest.approx(value, rel=1e-9), name


def test_films_end_where_its_table_does():
    """Below its table the solids were taken for nothing, and the film for all."""
    hard = contact(12e9, roughness=tb.Roughness(sigma=300e-9, R=2.8e-6))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        slow = mixed_film(hard, load=5e3, speed=np.array([1e-6, 1e-4]), **FILM)
        assert slow.regime.tolist() == ["boundary", "boundary"]
        assert slow.film_share + slow.ss_share == pytest.approx(1.0, abs=1e-9)
        speeds = regime_speeds(hard, load=20.0, **FILM)
        found = mixed_film(hard, load=20.0, speed=speeds.full, **FILM)
        assert found.solid_share == pytest.approx(0.01, rel=1e-6)
        smooth = contact(20e9, roughness=tb.Roughness(sigma=20e-9, R=1e-3))
        with balances_not(Status.TOO_DEEP, says="h = 0.2 sigma"):
            mixed_film(smooth, load=5e3, speed=[1e-4, 1e-3], **FILM)
