"""Single contacts and sums over heights against numbers by mpmath (`cases/make_laws.py`)."""

import json
import math
import warnings
from pathlib import Path

import mpmath
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
from thirdbody.contact.asperity_sums import GaussianSum
from thirdbody.contact.interface import interface
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


def test_root_of_jkr():
    """s − 1 against 40 digits at the same y: 12 decades, zero load, and up to the parting."""
    near = -0.75 + np.geomspace(2e-16, 0.7, 60)
    y = np.concatenate([near, -np.geomspace(1e-6, 0.74, 30), np.geomspace(1e-6, 1e6, 60)])
    got = tb.asperity.JKR._root(y)
    with mpmath.workdps(40):
        for value, at in zip(got, y, strict=True):
            q = mpmath.mpf(float(at))
            s = mpmath.findroot(lambda s, q=q: s**4 / 4 - s - q, 1 + mpmath.mpf(float(value)))
            assert abs(float((mpmath.mpf(float(value)) - (s - 1)) / (s - 1))) < 1e-15, at


@pytest.mark.parametrize("unloading", [False, True])
@pytest.mark.parametrize("w", [2e-5, 3e-3, 0.4])
def test_adhesion_is_resolved_however_short_its_reach(w, unloading):
    """Load and area over Gaussian heights against 25 digits, with s − 1 as variable.

    Panels as wide as the roughness asks, over which adhesion bends the law within its first
    thousandth, were 4e-7 of the area off.
    """
    law, h = tb.asperity.JKR(unloading=unloading, scale=0.3), 3.1
    got = GaussianSum(law, tb.heights.GaussianHeights(), w).fields(np.array([h]))[0]
    with mpmath.workdps(25):

        def density(e):
            y = e**2 * (1.5 + e + e**2 / 4) - mpmath.mpf(3) / 4
            slope = e * (3 + 3 * e + e**2)
            return w * slope * mpmath.exp(-((h + w * y) ** 2) / 2) / mpmath.sqrt(2 * mpmath.pi)

        first = 0 if unloading else mpmath.mpf(4) ** (mpmath.mpf(1) / 3) - 1
        edges = [first + (4 * 12 / mpmath.mpf(w)) ** 0.25 * k / 16 for k in range(17)]
        load = mpmath.quad(lambda e: 0.3 * ((1 + e) ** 6 / 6 - (1 + e) ** 3) * density(e), edges)
        area = mpmath.quad(lambda e: (1 + e) ** 4 / 4 * density(e), edges)
    assert got[0] == pytest.approx(float(load), rel=1e-11)
    assert got[1] == pytest.approx(float(area), rel=1e-11)


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
    assert tb.heights.Heights.from_dict(OURS["heights"][heights]["type"]) == HEIGHTS[heights]
    wrong = []
    for row in SUMS[heights]:
        found = [quadrature(law_of(row), HEIGHTS[heights], float(row["h"]))]
        if heights not in SLOW or row["law"] in TABULATED:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", tb.errors.RangeWarning)
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


def drawn_together(
    law: tb.asperity.AbstractAsperityLaw, heights: tb.heights.Heights, h: float
) -> float:
    """F/(ηE*R²) at separation h by panels of its own, from the second implementation."""
    start = -0.75 * (math.pi**2 * W**2 * R / E_STAR**2) ** (1 / 3)
    low = (start if getattr(law, "unloading", False) else 0.0) / SIGMA_S
    high = 40.0 if heights.kinks else h + 12.0
    # contact begins with a step, and the density may too
    marks = low + (high - low) * np.array([0, 0.002, 0.01, 0.04, 0.1, 0.2, 0.35, 0.5, 0.75, 1]) ** 2
    marks = sorted({*marks, *(z - h for z in heights.kinks if low < z - h < high)})
    x, weight = np.polynomial.legendre.leggauss(60)
    total = 0.0
    for a, b in zip(marks[:-1], marks[1:], strict=True):
        # √ as variable: an unloading contact starts like a root
        u_a, u_b = math.sqrt(a - low), math.sqrt(b - low)
        u = 0.5 * (u_a + u_b) + 0.5 * (u_b - u_a) * x
        omega = (low + u * u) * SIGMA_S
        o = {"w": W, "unloading": getattr(law, "unloading", False)}
        F, _ = plain.contact(law.name, omega, R=R, E=E_STAR, H=H, nu=NU, **o)
        phi = heights.pdf(h + low + u * u)
        total += 0.5 * (u_b - u_a) * float(np.sum(weight * 2 * u * F * phi))
    return total / (E_STAR * R**2)


@pytest.mark.parametrize("heights", ["gaussian", "exponential", "weibull"])
@pytest.mark.parametrize(
    ("name", "unloading", "pull"),
    [("dmt", None, -2.0), ("jkr", False, -4 / 3), ("jkr", True, -5 / 6)],
    ids=["dmt", "jkr", "jkr-unloading"],
)
def test_the_slope_of_a_sum_holds_the_pull_of_first_contact(name, unloading, pull, heights):
    """dF/dd of the library against differences of another sum; without the pull it is far off."""
    law = build(name, w=W) if unloading is None else build(name, w=W, unloading=unloading)
    own = law.bound(**CASE)
    unit = math.pi * R * H * float(own.yield_interference(**CASE))
    assert own.onset * unit == pytest.approx(pull * math.pi * W * R, rel=1e-14)
    density = HEIGHTS[heights]
    for h in (0.4, 1.5, 2.5):
        step = 2e-3
        F = [drawn_together(law, density, h + n * step) for n in (-2, -1, 1, 2)]
        drawn = (F[0] - 8 * F[1] + 8 * F[2] - F[3]) / (12 * step)
        bare = contact(law, density)
        got = float(interface(bare).load(np.array([h * SIGMA_S]))[0, 1]) * SIGMA_S
        got /= bare.roughness.eta * E_STAR * R**2
        begin = own.start * float(own.yield_interference(**CASE)) / SIGMA_S
        missing = -own.onset * unit / (E_STAR * R**2) * float(density.pdf(h + begin))
        size = abs(got) + abs(missing)
        assert abs(got - drawn) < 1e-8 * size
        assert abs(missing) > 0.05 * size


@pytest.mark.parametrize("subject", SUBJECTS, ids=lambda subject: subject.label)
def test_load_and_area_fall_with_the_separation(subject):
    """All areas, and the load of a law without adhesion, over 10 σ_s."""
    d = np.linspace(-1, 9, 60) * SIGMA_S
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        state = tb.solve(contact(subject.law), d=d)
    assert np.all(np.diff(state.A_t) < 0)
    assert_allclose(state.A_t, state.A_e + state.A_ep + state.A_p, rtol=1e-13)
    if not hasattr(subject.law, "w"):
        assert np.all(np.diff(state.F_star) < 0)
        back = tb.solve(contact(subject.law), F_star=state.F_star[20:])
        assert_allclose(back.d, d[20:], rtol=1e-10, atol=1e-12 * SIGMA_S)


def test_what_attracts_is_a_number_however_far():
    """Tall asperities pull back beyond 37 σ_s, then nothing is left; no sum overflows there."""
    steel = tb.Material(E=1e9, nu=0.3, H=1e8)
    rough = tb.Roughness(sigma=5e-9, R=15e-6, alpha=5.0, eta_R_sigma=0.05)
    law = tb.asperity.JKR(w=0.2, unloading=True)
    contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel), roughness=rough, asperity_law=law)
    asperities = interface(contact).asperities
    one, w = asperities.reduced.law, asperities.reduced.w
    start = float(one.start) * w
    assert -6 < start < -2
    for h in (30.0, 37.9, 38.1, 39.0, 45.0, 1e3, 1e6):
        t = np.linspace(start, start + 4.0, 400_001)
        with np.errstate(under="ignore"):
            density = np.exp(-0.5 * (h + t) ** 2) / math.sqrt(2 * math.pi)
        expected = asperities.units[0] * np.trapezoid(one.reduced("force", t / w) * density, t)
        d = asperities.centre + h * asperities.sigma_s
        load = asperities.load(np.array([d]))[0]
        assert np.isfinite(load).all()
        assert np.isfinite(asperities.fields(np.array([d]))).all()
        assert_allclose(load[0], expected, rtol=2e-3, err_msg=str(h))
        assert (load[0] < 0) == (h < 42)
