"""The press against other programs, where they are installed."""

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.explicit.press import HARDEST, press

E_STAR, SPACING, POINTS = 1e11, 1e-7, 128
PRESSURE, SIDE = 1e-3 * E_STAR, POINTS * SPACING
CAP = 0.03 * E_STAR


def heights():
    return tb.surfaces.self_affine(
        sigma=5e-8, hurst=0.8, shortest=1.2e-6, longest=6e-6, spacing=SPACING, points=POINTS
    ).heights


def ours(cap):
    """Pressures at a certificate far below what is compared."""
    found = press(
        heights(), SPACING, E_STAR, c=np.full((POINTS, POINTS), cap), load=PRESSURE * SIDE**2,
        tol=1e-9,
    )  # fmt: skip
    assert found.converged
    return found.p


def test_elastic_contact_is_that_of_tamaas():
    tamaas = pytest.importorskip("tamaas", reason="tamaas is not installed")
    tamaas.set_log_level(tamaas.LogLevel.warning)
    z = heights()
    model = tamaas.Model(tamaas.model_type.basic_2d, [SIDE, SIDE], [POINTS, POINTS])
    model.E, model.nu = E_STAR, 0.0
    tamaas.PolonskyKeerRey(model, np.ascontiguousarray(z), 1e-12).solve(PRESSURE)
    theirs = np.asarray(model.traction).reshape(z.shape)
    p = ours(HARDEST)
    assert np.mean(theirs) == pytest.approx(PRESSURE, rel=1e-6)
    assert np.abs(p - theirs).sum() < 1e-3 * theirs.sum()
    assert np.mean(p > 0) == pytest.approx(np.mean(theirs > 0), rel=2e-3)


@pytest.mark.parametrize(("cap", "apart"), [(None, 2e-5), (CAP, 4e-4)])
def test_contact_is_that_of_contactmechanics(cap, apart):
    theirs_of = pytest.importorskip("ContactMechanics", reason="ContactMechanics is not installed")
    from ContactMechanics.Optimization.ConstrainedConjugateGradients import (
        constrained_conjugate_gradients,
    )

    space = theirs_of.PeriodicFFTElasticHalfSpace((POINTS, POINTS), E_STAR, (SIDE, SIDE))
    found = constrained_conjugate_gradients(
        space,
        heights(),
        hardness=None if cap is None else cap * SPACING**2,
        external_force=PRESSURE * SIDE**2,
        pentol=1e-13,
        thermotol=1e-8,
        forcetol=1e-6 * CAP * SPACING**2,
        maxiter=3000,
    )
    theirs = np.asarray(found.jac) / SPACING**2
    p = ours(HARDEST if cap is None else cap)
    if cap is not None:
        assert np.mean(p >= cap) > 0.3 * np.mean(p > 0)  # the cap is there to matter
    assert np.mean(theirs) == pytest.approx(PRESSURE, rel=1e-4)
    assert np.abs(p - theirs).sum() < apart * theirs.sum()
    assert np.mean(p > 0) == pytest.approx(np.mean(theirs > 0), rel=2e-3)
