"""The press against another program, where it is installed."""

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.explicit.press import HARDEST, press

E_STAR, SPACING, POINTS = 1e11, 1e-7, 128


def test_elastic_contact_is_that_of_tamaas():
    tamaas = pytest.importorskip("tamaas")
    tamaas.set_log_level(tamaas.LogLevel.warning)
    z = tb.synthetic.self_affine(
        sigma=5e-8, hurst=0.8, shortest=1.2e-6, longest=6e-6, spacing=SPACING, points=POINTS
    ).heights
    pressure, side = 1e-3 * E_STAR, POINTS * SPACING
    model = tamaas.Model(tamaas.model_type.basic_2d, [side, side], [POINTS, POINTS])
    model.E, model.nu = E_STAR, 0.0
    tamaas.PolonskyKeerRey(model, np.ascontiguousarray(z), 1e-12).solve(pressure)
    theirs = np.asarray(model.traction).reshape(z.shape)
    c = np.full(z.shape, HARDEST)
    ours = press(z, SPACING, E_STAR, c=c, load=pressure * side**2, tol=1e-9).p
    assert np.mean(theirs) == pytest.approx(pressure, rel=1e-6)
    assert np.abs(ours - theirs).sum() < 1e-3 * theirs.sum()
