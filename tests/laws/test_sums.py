"""Single contacts and sums over heights against numbers by mpmath (`cases/make_laws.py`)."""

import json
import math
import warnings
from pathlib import Path

import numpy as np
import plain
import pytest
from numpy.testing import assert_allclose
from subjects import (
    CASE,
    CIRCLES,
    E_STAR,
    FIRST,
    HEIGHTS,
    NU,
    SIGMA_S,
    SLOW,
    SUBJECTS,
    TABULATED,
    H,
    R,
    W,
    build,
    contact,
    quadrature,
)

import thirdbody as tb
from thirdbody.laws.asperity import elliptic_hertz

OURS = json.loads((Path(__file__).parents[1] / "cases" / "laws.json").read_text("utf-8"))
COMMON = {
    "ceb": {"K": 0.6},
    "elliptic-ceb": {"K": 0.6},
    "jg": {"hardness_ratio": 0.02 / 0.007},
    "jkr": {"w": W},
    "dmt": {"w": W},
}


def law_of(row: dict) -> tb.asperity.AbstractAsperityLaw:
    return build(row["law"], **COMMON.get(row["law"], {}), **row["options"])


def label(row: dict) -> str:
    return " ".join([row["law"], *(str(v) for v in row["options"].values())])


SINGLE = {
    name: [row for row in OURS["single"] if label(row) == name]
    for name in dict.fromkeys(label(row) for row in OURS["single"])
}
SUMS = {
    name: [row for row in OURS["sums"] if row["heights"] == name]
    for name in dict.fromkeys(row["heights"] for row in OURS["sums"])
}


@pytest.mark.parametrize("name", SINGLE)
def test_single_contacts(name):
    rows = SINGLE[name]
    law = law_of(rows[0])
    if law.name == "jkr":
        law = law.replace(unloading=True)
    omega = np.array([float(row["omega"]) for row in rows]) * R
    F, A, S = (np.array([float(row[key]) for row in rows]) for key in "FAS")
    floor = 1e-12 * math.pi * W * R if law.name in COMMON and hasattr(law, "w") else 0.0
    assert_allclose(law.force(omega, **CASE), F * E_STAR * R**2, rtol=1e-12, atol=floor)
    assert_allclose(law.area(omega, **CASE), A * R**2, rtol=1e-12)
    assert_allclose(law.stiffness(omega, **CASE), S * E_STAR * R, rtol=2e-11)
    assert list(law.regime(omega, **CASE)) == [row["regime"] for row in rows]


@pytest.mark.parametrize("name", SINGLE)
def test_the_second_implementation(name):
    """The judge of the Monte Carlo sums, by the same numbers."""
    rows = SINGLE[name]
    omega = np.array([float(row["omega"]) for row in rows]) * R
    options = {**COMMON.get(rows[0]["law"], {}), **rows[0]["options"]}
    if rows[0]["law"] == "jkr":
        options["unloading"] = True
    F, A = plain.contact(rows[0]["law"], omega, R=R, E=E_STAR, H=H, nu=NU, **options)
    floor = 1e-12 * math.pi * W * R if "w" in options else 0.0
    assert_allclose(F, [float(row["F"]) * E_STAR * R**2 for row in rows], rtol=1e-11, atol=floor)
    assert_allclose(A, [float(row["A"]) * R**2 for row in rows], rtol=1e-11)


@pytest.mark.parametrize("row", OURS["ellipses"], ids=lambda row: row["ratio"])
def test_exact_ellipse(row):
    """Carlson's integrals against K and E of the parameter m; nothing cancels near the circle."""
    one = elliptic_hertz(float(row["ratio"]))
    for name in ("K", "R_A", "root_R_F"):
        assert_allclose(getattr(one, name), float(row[name]), rtol=2e-14, err_msg=name)
    assert_allclose(one.k, float(row["k"]), rtol=1e-13)
    if row["ratio"] == "1.00000001":
        assert_allclose((1 - one.k) / (1 - float(row["k"])), 1, rtol=1e-6)


@pytest.mark.parametrize("heights", SUMS)
def test_sums(heights):
    assert tb.Heights.from_dict(OURS["heights"][heights]["type"]) == HEIGHTS[heights]
    wrong = []
    for row in SUMS[heights]:
        found = [quadrature(law_of(row), HEIGHTS[heights], float(row["h"]))]
        if heights not in SLOW or row["law"] in TABULATED:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", tb.RangeWarning)
                one = contact(law_of(row), HEIGHTS[heights])
                state = tb.solve(one, d=float(row["h"]) * SIGMA_S)
            found.append((state.F_star, state.A_t))
        off = np.abs(np.array(found) / [float(row["F"]), float(row["A"])] - 1)
        if not np.all(off < 1e-10):
            wrong.append((label(row), row["h"], off))
    assert wrong == []
    assert len(SUMS[heights]) > 20


def test_laws_that_yield_carry_alike_and_touch_differently():
    """Gaussian heights, h = 1.5: loads within 5 %, areas not; one third below the elastic load."""
    d = 1.5 * SIGMA_S
    state = {name: tb.solve(contact(FIRST[name].law), d=d) for name in CIRCLES}
    loads = {name: one.F_star for name, one in state.items()}
    assert_allclose(
        [loads[name] for name in ("gw", "zmc", "ceb", "jg")],
        [1.642632e-4, 1.066061e-4, 1.060915e-4, 1.105018e-4],
        rtol=1e-6,
    )
    assert loads["hermite"] / loads["zmc"] == pytest.approx(1.09, abs=0.01)
    assert_allclose(
        [state[name].A_t for name in ("ceb", "jg", "ke", "zmc", "gw")],
        [8.847e-3, 6.840e-3, 6.700e-3, 6.256e-3, 4.604e-3],
        rtol=2e-4,
    )


def test_adhesive_sums():
    """DMT is GW less 2πwR for each contact; unloading JKR touches more and pulls harder."""
    d = np.array([0.5, 1.5, 3.0]) * SIGMA_S
    on, off = (tb.solve(contact(build("jkr", w=W, unloading=back)), d=d) for back in (False, True))
    assert np.all(off.A_t > on.A_t)
    assert np.all(off.F_star < on.F_star)
    gw, dmt = (tb.solve(contact(FIRST[name].law), d=d) for name in ("gw", "dmt"))
    touching = np.array([0.5 * math.erfc(x / SIGMA_S / math.sqrt(2)) for x in d])
    pull = 2 * math.pi * W * R * 0.05 / (R * SIGMA_S) * touching
    assert_allclose((gw.F_star - dmt.F_star) * E_STAR, pull, rtol=1e-11)
    assert_allclose(gw.A_t, dmt.A_t, rtol=1e-13)


@pytest.mark.parametrize("subject", SUBJECTS, ids=lambda subject: subject.label)
def test_load_and_area_fall_with_the_separation(subject):
    """All areas, and the load of a law without adhesion, over 10 σ_s."""
    d = np.linspace(-1, 9, 60) * SIGMA_S
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.RangeWarning)
        state = tb.solve(contact(subject.law), d=d)
    assert np.all(np.diff(state.A_t) < 0)
    assert_allclose(state.A_t, state.A_e + state.A_ep + state.A_p, rtol=1e-13)
    if not hasattr(subject.law, "w"):
        assert np.all(np.diff(state.F_star) < 0)
        back = tb.solve(contact(subject.law), F_star=state.F_star[20:])
        assert_allclose(back.d, d[20:], rtol=1e-10, atol=1e-12 * SIGMA_S)
