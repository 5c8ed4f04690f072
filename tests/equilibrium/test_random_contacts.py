"""What must hold for every contact, over the ranges in which people work.

Ten thousand contacts are drawn and held by a command; `random_contacts` says which.
"""

from contextlib import contextmanager
from unittest import mock

import numpy as np
import pytest
import random_contacts

import thirdbody as tb
from thirdbody.contact import interface as contact
from thirdbody.equilibrium import columns
from thirdbody.equilibrium import load_scan as equilibrium

SEED = 20


def hold(seed: int, index: int) -> None:
    result = random_contacts.run(seed, index, shares=3)
    assert not result["failed"], random_contacts.told(result)


@pytest.mark.parametrize(
    "index", [*range(11), *(pytest.param(i, marks=pytest.mark.slow) for i in range(11, 24))]
)
def test_contact(index):
    hold(SEED, index)


@pytest.mark.parametrize(
    "index",
    [
        256,  # soft grains of 50 to 370 µm on a seat of 6 nm
        495,  # fine dust beside millimetres, by the printed integrals
        1325,  # adhesive asperities far apart
        6345,  # areas that change order on a jump of JG
    ],
)
def test_contact_that_failed_once(index):
    hold(1, index)


@pytest.mark.slow
def test_more_contacts():
    results = [random_contacts.run(SEED + 1, index, shares=3) for index in range(10)]
    bad = [random_contacts.told(result) for result in results if result["failed"]]
    assert not bad, "\n".join(bad)


def test_draws_depend_on_seed_and_index_alone():
    drawn = [random_contacts.draw(SEED, index) for index in (3, 4, 3)]
    assert drawn[0].contact == drawn[2].contact != drawn[1].contact
    np.testing.assert_array_equal(drawn[0].loads, drawn[2].loads)
    np.testing.assert_array_equal(drawn[0].d, drawn[2].d)


def test_ranges_and_laws_are_reached():
    """Every law, seat, kind of sizes and of heights, and both ends of what is drawn by decades."""
    every = []
    for index in range(400):
        try:
            every.append(random_contacts.draw(SEED, index).contact)
        except tb.errors.InvalidValue:  # no such heights
            continue
    assert len(every) > 380
    grains = [p for each in every for p in each.populations]
    laws = [each.law_of(p) for each in every for p in each.populations]
    tips = {name for name, kind in tb.asperity.REGISTRY.items() if not kind.of_surface}
    assert {each.asperity_law.name for each in every} == tips
    assert {law.name for law in laws} == set(tb.particle.REGISTRY)
    assert {getattr(law, "seat", "plane") for law in laws} == {"rough", "plane", "offset"}
    assert {getattr(law, "shadow", "none") for law in laws} >= set(random_contacts.SHADOWS)
    assert {len(each.populations) for each in every} == {0, 1, 2, 3}
    heights = {type(each.roughness.heights).__name__ for each in every}
    assert heights == {
        f"{k}Heights" for k in ("Gaussian", "Exponential", "Weibull", "Johnson", "Histogram")
    }
    kinds = {type(p.diameter) for p in grains}
    assert kinds == {
        *(
            tb.distributions.Monodisperse,
            tb.TruncatedGaussian,
            tb.LogNormal,
            tb.distributions.Weibull,
            tb.distributions.Uniform,
        ),
        *(tb.distributions.Histogram, tb.distributions.PowerLaw, tb.distributions.Mixture),
    }
    covered = [p.coverage for p in grains]
    assert min(covered) < 1e-7
    assert 0.1 < max(covered) < 1
    hardness = [p.material.H / each.surfaces.H for each in every for p in each.populations]
    assert min(hardness) < 0.02
    assert max(hardness) > 50


def test_units_of_everything_change():
    one = random_contacts.draw(SEED, 7).contact
    other = random_contacts.in_other_units(one, 3.0, 5.0)
    assert other.E_ss == pytest.approx(5 * one.E_ss)
    assert other.roughness.sigma == pytest.approx(3 * one.roughness.sigma)
    assert other.roughness.density == pytest.approx(one.roughness.density / 9)
    for a, b in zip(one.populations, other.populations, strict=True):
        assert b.coverage == pytest.approx(a.coverage)
        assert b.material.H == pytest.approx(5 * a.material.H)


# ---------------------------------------------------------------------- the checks can fail
def _wrong(name, change):
    """Fields of which one is changed."""
    true = contact.together

    def together(*args):
        out = true(*args)
        out[name] = change(out[name])
        return out

    return lambda: mock.patch.object(contact, "together", together)


def _columns(name, change):
    """Results of which one column is changed."""
    true = columns.as_columns

    def as_columns(*args, **kwargs):
        out = true(*args, **kwargs)
        out[name] = change(out[name])
        return out

    return lambda: mock.patch("thirdbody.equilibrium.solve.as_columns", as_columns)


def _off(self, target, cells, **kwargs):
    d, *others = POLISH(self, target, cells, **kwargs)
    return d * (1 + 1e-6), *others


@contextmanager
def _told_ok(name, function):
    """A method of `LoadScan` goes wrong, and no imbalance is too large to be told ok."""
    with (
        mock.patch.object(equilibrium, "RESIDUAL", np.inf),
        mock.patch.object(equilibrium.LoadScan, name, function),
    ):
        yield


POLISH = equilibrium.LoadScan.polish
WHOLE = 5
"""Index of a contact with particles that every check holds."""
WRONG = {
    "no NaN told as ok": _wrong("A_sa2", lambda A: A * np.nan),
    "areas from 0 up": _wrong("A_sa2", lambda A: -A - 1e-40),
    "sum of areas": _wrong("A_e", lambda A: A + 1e-9),
    "sum of loads": _columns("F_sa_star", lambda F: 1.001 * F),
    "shares in [0, 1]": _columns("particle_area_share", lambda S: S + 1.0),
    "mode": _columns("mode", lambda words: np.full(len(words), "")),
    "residual": lambda: _told_ok("polish", _off),
    "round trip": lambda: _told_ok("polish", _off),
    "engines": lambda: _told_ok("polish", _off),
    "first root on approach": lambda: _told_ok(
        "cells", lambda self, F, branch: np.full(len(F), len(self.d) - 2)
    ),
    "shadow": _wrong("shadow", lambda s: s - 2.0),
    "units": lambda: mock.patch.dict(random_contacts.LENGTHS, {"1/m^2": -1}),
}


@pytest.mark.parametrize("check", WRONG)
def test_checks_fail_where_something_is_wrong(check):
    drawn = random_contacts.draw(SEED, WHOLE)
    assert not random_contacts.hold(drawn)[0].failed
    with WRONG[check]():
        found, _ = random_contacts.hold(drawn)
    assert check in {name for name, _ in found.failed}
