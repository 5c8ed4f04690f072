"""What every asperity law must satisfy: plain functions of a law that raise AssertionError.

`failures` runs them all; the mutation check asks it for laws with a planted slip.
"""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import plain
from numpy.testing import assert_allclose
from numpy.typing import NDArray
from subjects import (
    ADHESIVE,
    CASE,
    CIRCLES,
    E_STAR,
    ELLIPSES,
    ETA,
    HEIGHTS,
    NU,
    SIGMA_S,
    H,
    R,
    build,
    contact,
    nu_of,
)

import thirdbody as tb
from thirdbody.contact.interface import interface
from thirdbody.laws.asperity import GW, AbstractAsperityLaw, Jump

Array = NDArray[np.float64]
Law = AbstractAsperityLaw
PI = math.pi


# ------------------------------------------------------------------------------- helpers
def bound(law: Law) -> Law:
    return law.bound(**CASE, nu=nu_of(law))


def unit(law: Law) -> float:
    """The law's own interference scale [m]."""
    return float(bound(law).yield_interference(**CASE))


def edges(law: Law) -> Array:
    """Its breakpoints [m]."""
    return np.array(bound(law).breakpoints) * unit(law)


def grid(law: Law, count: int = 200, away: float = 0.0) -> Array:
    """Interferences over all regimes, at a relative distance from the breakpoints."""
    w = np.geomspace(1.03e-7, 1.03, count) * R
    if getattr(law, "unloading", False):
        # from past the minimum of the load, where the contact is stable under load control
        w = np.concatenate([np.linspace(-0.36, -0.01, 20) * unit(law), w])
    for edge in edges(law):
        w = w[np.abs(w / edge - 1) > away]
    return w


def expected(law: Law, omega: Array) -> tuple[Array, Array]:
    """Load and area after `plain`, with the law's own options."""
    return plain.contact(law.name, omega, **inputs(law))


def inputs(law: Law) -> dict[str, Any]:
    names = ("K", "k", "ratio", "area_rule", "w", "unloading", "hardness_ratio")
    own = {name: getattr(law, name) for name in names if hasattr(law, name)}
    return {"R": R, "E": E_STAR, "H": H, "nu": nu_of(law), **own}


def onset(law: Law) -> float:
    """Interference of first yield [m], not asked of the law."""
    return plain.onset(law.name, **inputs(law))


def gauss(f: Callable[[Array], Array], marks: list[float], order: int = 60) -> float:
    """∫f over sorted marks, in panels."""
    x, weight = np.polynomial.legendre.leggauss(order)
    total = 0.0
    for a, b in zip(marks[:-1], marks[1:], strict=True):
        total += 0.5 * (b - a) * float(np.sum(weight * f(0.5 * (a + b) + 0.5 * (b - a) * x)))
    return total


# ------------------------------------------------------------------------ single contact
def no_load_without_interference(law: Law) -> None:
    none = bound(law).start * unit(law)
    for omega in (none * (1 + 1e-12), none - 1e-9 * R, -R):
        for method in (law.force, law.area, law.stiffness, law.mean_pressure, law.energy):
            assert method(omega, **CASE) == 0, (method.__name__, omega)
        assert str(law.regime(omega, **CASE)) == "none"


def load_grows(law: Law) -> None:
    F = law.force(np.sort(np.concatenate([grid(law, 2000), *beside(law)])), **CASE)
    assert np.all(np.isfinite(F))
    assert np.all(np.diff(F) >= -1e-14 * np.abs(F[1:]))


def beside(law: Law, gap: float = 1e-9) -> list[Array]:
    return [edges(law) * (1 + side * gap) for side in (-1, 1)]


def area_grows(law: Law) -> None:
    w = np.sort(np.concatenate([grid(law, 2000), *beside(law)]))
    A = law.area(w, **CASE)
    falls = [y for y, jump in bound(law).jumps.items() if jump.area < 0]
    assert falls == ([1.0] if law.name == "ke" else []), "no other law loses area"
    down = np.flatnonzero(np.diff(A) < -1e-14 * A[1:])
    for i in down:
        assert any(w[i] <= y * unit(law) <= w[i + 1] for y in falls), w[i] / unit(law)
    assert len(down) == len(falls)


def jumps_are_declared(law: Law) -> None:
    own = bound(law)
    assert set(own.jumps) <= set(own.breakpoints)
    for y, w in zip(own.breakpoints, edges(law), strict=True):
        declared = own.jumps.get(y, Jump())
        for name, step in declared._asdict().items():
            below, above = getattr(law, name)(w * np.array([1 - 1e-12, 1 + 1e-12]), **CASE)
            jump = float(above / below) - 1
            assert abs(jump - step) < 2e-11, (name, y, jump)
        at = law.force(w * (1 + 4e-16), **CASE) / law.force(w * (1 + 1e-12), **CASE)
        assert abs(float(at) - 1) < 1e-11, "the upper branch holds at a breakpoint"
    # and none in between: no step larger than its slope allows
    w = grid(law, 4000)
    F, A, S = (method(w, **CASE) for method in (law.force, law.area, law.stiffness))
    inner = np.ones(len(w) - 1, dtype=bool)
    for edge in edges(law):
        inner &= (w[1:] < edge) | (w[:-1] >= edge)
    allowed = 1.5 * np.maximum(np.abs(S[1:]), np.abs(S[:-1])) * np.diff(w)
    allowed += 1e-13 * np.abs(F[1:])
    inner &= (w[:-1] > 0) | (w[1:] < 0)
    assert np.all((np.abs(np.diff(F)) <= allowed)[inner])
    assert np.all((np.diff(A) <= 3 * np.diff(w) / np.abs(w[:-1]) * A[1:])[inner])


def onset_is_declared(law: Law) -> None:
    """The load at first touch: none, or the pull of adhesion."""
    own = bound(law)
    touch = 1e-300 if own.start == 0 else np.nextafter(own.start, 1)
    first = float(own.reduced("force", touch))
    # an unloading JKR contact starts like a root
    assert abs(first - own.onset) <= (5e-8 if own.start < 0 else 1e-14) * abs(own.onset) + 1e-150
    assert (own.onset < 0) == (law.name in ADHESIVE)


def the_range_ends_where_it_says(law: Law) -> None:
    """`valid_to` and its sentence go together; the elastic laws end at a mean pressure of 0.4 H."""
    own = bound(law)
    assert (own.valid_to < math.inf) == bool(own.beyond)
    assert own.valid_to > 0
    if {branch.regime for branch in own.branches} == {"elastic"}:
        assert own.valid_to < math.inf
        end = own.valid_to * unit(law)
        if law.name in ADHESIVE:
            assert_allclose(end, R * (0.3 * PI * H / E_STAR) ** 2, rtol=1e-12)
        else:
            assert_allclose(float(law.mean_pressure(end, **CASE)), 0.4 * H, rtol=1e-9)


def stiffness_is_the_slope(law: Law) -> None:
    w = grid(law, 300, away=1e-3)
    step = 1e-5 * np.abs(w)
    slope = (law.force(w + step, **CASE) - law.force(w - step, **CASE)) / (2 * step)
    S = law.stiffness(w, **CASE)
    F = np.abs(law.force(w, **CASE))
    assert np.all(np.abs(S - slope) <= 2e-8 * (np.abs(S) + 1e-3 * F / np.abs(w)) + 1e-15 * F / step)


def energy_is_the_work(law: Law) -> None:
    for omega in np.array([3e-5, 1e-3, 0.03, 1.0]) * R:
        # u = √ω, in panels that never span more than a factor of two
        marks = [0.0, *(2.0**-i * math.sqrt(omega) for i in range(12, -1, -1))]
        marks = sorted({*marks, *(math.sqrt(w) for w in edges(law) if w < omega)})
        work = gauss(lambda u: 2 * u * law.force(u * u, **CASE), marks)
        size = gauss(lambda u: 2 * u * np.abs(law.force(u * u, **CASE)), marks)
        assert abs(float(law.energy(omega, **CASE)) - work) <= 1e-11 * size, omega / R


def any_units(law: Law) -> None:
    """Lengths × L, stresses × S: F × L²S, A × L², energy × L³S; pure numbers stay."""
    w = grid(law, 60, away=1e-6)
    for L, S in ((1e-3, 1.0), (1.0, 40.0), (7.0, 1e-6)):
        other = rescaled(law, L, S)
        case = {"R": L * R, "E_star": S * E_STAR, "H": S * H}
        for method, factor in (
            ("force", L * L * S),
            ("area", L * L),
            ("stiffness", L * S),
            ("mean_pressure", S),
            ("contact_radius", L),
            ("energy", L**3 * S),
        ):
            small, large = getattr(law, method)(w, **CASE), getattr(other, method)(L * w, **case)
            floor = 1e-13 * factor * np.max(np.abs(small)) if law.name in ADHESIVE else 0.0
            assert_allclose(large, factor * small, rtol=2e-12, atol=floor, err_msg=method)


def rescaled(law: Law, L: float, S: float) -> Law:
    factors = {"1": 1.0, "m": L, "Pa": S, "J/m^2": S * L}
    changes = {}
    for name in law.__dataclass_fields__:
        about = law.__dataclass_fields__[name].metadata.get("quantity")
        if about and getattr(law, name) is not None:
            changes[name] = getattr(law, name) * factors[about["unit"]]
    return law.replace(**changes)


def one_number_or_many(law: Law) -> None:
    w = grid(law, 12, away=1e-6)[-12:].reshape(3, 4)
    radius = np.array([[1.0], [1.7], [3.1]]) * R
    hard = np.array([1.0, 0.3, 2.0, 1.0]) * H
    stiff = np.array([[1.0, 0.8, 0.8, 1.2]]) * E_STAR
    for tips, moduli, hardness in ((radius, E_STAR, H), (R, stiff, H), (radius, stiff, hard)):
        case: Any = {"R": tips, "E_star": moduli, "H": hardness}
        every = [np.broadcast_to(values, w.shape) for values in case.values()]
        for name in ("force", "area", "stiffness", "energy", "mean_pressure", "regime"):
            together = getattr(law, name)(w, **case)
            assert together.shape == w.shape
            for at in np.ndindex(*w.shape):
                single = dict(zip(case, (float(values[at]) for values in every), strict=True))
                one = getattr(law, name)(float(w[at]), **single)
                assert np.ndim(one) == 0
                if name == "regime":
                    assert str(one) == together[at]
                else:
                    assert_allclose(float(one), together[at], rtol=1e-13)


def round_trip(law: Law) -> None:
    for one in (law, bound(law)):
        text = json.dumps(one.to_dict())
        again = tb.Contact.from_dict(json.loads(text))
        assert again == one
        assert hash(again) == hash(one)
        assert type(again) is type(one)


def elastic_limit(law: Law) -> None:
    """Hertz before yield: of a sphere, of an ellipse by polar quadrature, of w → 0."""
    if law.name in ADHESIVE:
        law = law.replace(w=1e-15 * law.w)
        w, tolerance = np.geomspace(1e-3, 1, 20) * R, 1e-5
    elif law.name == "coated":
        # no coating at all: Hertz with E_1* of the table, which is E*
        law = law.replace(E_2=law.E_1, nu_2=law.nu_1)
        w, tolerance = np.geomspace(1e-6, 1, 20) * R, 1e-9
    elif law.name in CIRCLES or law.name in ELLIPSES:
        last = 1.9 if law.name == "jg" else 1.0
        top = R if law.name == "gw" else 0.999999 * last * onset(law)
        w, tolerance = np.geomspace(1e-6, 1, 20) * top, 1e-12
    elif bound(law).branches[0].regime == "elastic":
        # a law that is not known here
        top = 0.999999 * float(edges(law)[0]) if len(edges(law)) else R
        w, tolerance = np.geomspace(1e-6, 1, 20) * top, 1e-12
    else:
        return
    _, area, load = plain.ellipse(getattr(law, "ratio", 1.0))
    assert_allclose(law.area(w, **CASE), PI * R * area * w, rtol=tolerance)
    F = 4 / 3 * E_STAR * load * math.sqrt(R) * w**1.5
    assert_allclose(law.force(w, **CASE), F, rtol=tolerance)
    assert_allclose(law.stiffness(w, **CASE), 1.5 * F / w, rtol=tolerance)
    assert set(law.regime(w, **CASE)) == {"elastic"}
    a = np.sqrt(R * area * w)
    assert_allclose(law.contact_radius(w, **CASE), a, rtol=tolerance)


def pressure_at_yield(law: Law) -> None:
    """⅔KH or kH, for every ratio of radii; JG: peak pressure CS_y."""
    if law.name not in CIRCLES | set(ELLIPSES) or law.name == "gw":
        return
    if law.name == "jg":
        p = 2 / 3 * 1.295 * math.exp(0.736 * nu_of(law)) * H / law.hardness_ratio
    elif hasattr(law, "k"):
        p = law.k * H
    else:
        p = 2 / 3 * (law.K or 0.454 + 0.41 * nu_of(law)) * H
    omega = unit(law) * (1 - 1e-13)
    assert_allclose(float(law.mean_pressure(omega, **CASE)), p, rtol=1e-12)
    assert_allclose(unit(law), onset(law), rtol=1e-11)


def plastic_limit(law: Law) -> None:
    """Pressure KH after CEB, H after ZMC and KE; section 2πR_gω of the undeformed tip."""
    if law.name in ADHESIVE | {"gw", "jg", "coated"}:
        assert "plastic" not in law.regime(grid(law), **CASE)
    if law.name in ("gw", "jg") or law.name not in CIRCLES | set(ELLIPSES):
        return
    p = H
    if law.name in ("ceb", "elliptic-ceb"):
        p = (law.K or 0.454 + 0.41 * nu_of(law)) * H
    omega = 1e6 * onset(law)
    _, area, _ = plain.ellipse(getattr(law, "ratio", 1.0))
    full = 2 * area if getattr(law, "area_rule", "") == "doubling" else 2.0
    assert_allclose(float(law.mean_pressure(omega, **CASE)), p, rtol=1e-12)
    assert_allclose(float(law.area(omega, **CASE)), full * PI * R * omega, rtol=2e-6)
    assert_allclose(float(law.stiffness(omega, **CASE)), full * PI * R * p, rtol=1e-12)
    assert str(law.regime(omega, **CASE)) == "plastic"


def same_as_plain(law: Law) -> None:
    """Against the second implementation, everywhere."""
    if law.name not in CIRCLES | set(ELLIPSES) | ADHESIVE:
        return
    w = grid(law, 400, away=1e-9)
    F, A = expected(law, w)
    floor = 1e-12 * PI * R * law.w if law.name in ADHESIVE else 0.0
    assert_allclose(law.force(w, **CASE), F, rtol=1e-11, atol=floor)
    assert_allclose(law.area(w, **CASE), A, rtol=1e-11)


def hard_is_elastic(law: Law) -> None:
    """H → ∞ equals Greenwood and Williamson, for one tip and in sums."""
    if law.name not in CIRCLES:
        return
    hard = {"R": R, "E_star": E_STAR, "H": 20 * E_STAR}
    w = np.geomspace(1e-7, 1, 30) * R
    for method in ("force", "area", "stiffness"):
        assert_allclose(
            getattr(law, method)(w, **hard), getattr(GW(), method)(w, **hard), rtol=1e-12
        )
    d = np.array([-1.0, 0.5, 3.0]) * SIGMA_S
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        one, gw = (tb.solve(contact(x, hardness=20 * E_STAR), d=d) for x in (law, GW()))
    assert_allclose(one.F_star, gw.F_star, rtol=1e-12)
    assert_allclose(one.A_t, gw.A_t, rtol=1e-12)
    assert_allclose(one.A_e, gw.A_t, rtol=1e-12)


def a_round_ellipse_is_a_circle(law: Law) -> None:
    if law.name not in ELLIPSES:
        return
    for rule in ("volume", "doubling"):
        round_one = law.replace(ratio=1.0, area_rule=rule)
        own = {"K": law.K} if law.name == "elliptic-ceb" else {}
        circle = build(ELLIPSES[law.name], **own)
        w = grid(circle, 200, away=1e-9)
        for method in ("force", "area", "stiffness", "energy"):
            got, want = getattr(round_one, method)(w, **CASE), getattr(circle, method)(w, **CASE)
            assert_allclose(got, want, rtol=1e-14, err_msg=method)
        assert bound(round_one).breakpoints == bound(circle).breakpoints


# ---------------------------------------------------------------------------------- sums
def exponential_heights(law: Law) -> None:
    """F/A does not depend on h, and d ln F/dh = −1; with adhesion too while all is in reach."""
    if law.of_surface:
        return  # no sum over tips
    d = np.array([-0.9, 0.0, 1.5, 4.0, 9.0]) * SIGMA_S
    if getattr(law, "unloading", False):
        d = d[1:]
    bare = contact(law, HEIGHTS["exponential"])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        state = tb.solve(bare, d=d)
    F, slope, curve = interface(bare).load(d).T
    assert_allclose(state.F_star / state.A_t, state.F_star[0] / state.A_t[0], rtol=1e-11)
    assert_allclose(state.A_t, state.A_t[1] * np.exp((d[1] - d) / SIGMA_S), rtol=1e-11)
    assert_allclose(slope * SIGMA_S / F, -1, rtol=1e-9)
    assert_allclose(curve * SIGMA_S**2 / F, 1, rtol=1e-6)


def derivative_of_the_sum(law: Law) -> None:
    """dF/dd = −η[∫F₁′φ + ΣJφ(d + ω_i)], jumps of the law included, and the difference."""
    if law.of_surface:
        return
    for name in ("gaussian", "exponential"):
        heights = HEIGHTS[name]
        bare = contact(law, heights)
        force = interface(bare).load
        for h in (0.3, 2.0):
            d = h * SIGMA_S
            got = float(force(np.array([d]))[0, 1])
            assert_allclose(got, by_parts(law, heights, h), rtol=1e-8, err_msg=name)
            step = 1e-4 * SIGMA_S
            F = force(d + step * np.array([-2, -1, 1, 2]))[:, 0]
            slope = float(F @ [1, -8, 8, -1]) / (12 * step)
            size = float(np.max(np.abs(F))) / SIGMA_S
            assert abs(got - slope) <= 1e-8 * (abs(got) + size)


def by_parts(law: Law, heights: tb.heights.Heights, h: float) -> float:
    start = bound(law).start * unit(law)
    top = start + 42 * SIGMA_S if heights.kinks else start + (h + 12) * SIGMA_S
    inside = [w for w in edges(law) if w < top]
    marks = {0.0, *(math.sqrt(w - start) for w in inside)}
    marks |= {math.sqrt(top - start) * x for x in (0.02, 0.1, 0.25, 0.4, 0.6, 0.8, 1.0)}

    def integrand(u: Array) -> Array:
        w = start + u * u
        return 2 * u * law.stiffness(w, **CASE) * heights.pdf(h + w / SIGMA_S)

    total = gauss(integrand, sorted(marks))
    sets_in = float(law.force(start + 1e-13 * abs(unit(law)), **CASE))
    if start < 0:
        sets_in = -5 / 6 * PI * R * law.w
    for w, jump in [(start, sets_in if law.name in ADHESIVE else 0.0)] + [
        (w, float(np.diff(law.force(w * np.array([1 - 1e-13, 1 + 1e-13]), **CASE))[0]))
        for w in inside
    ]:
        total += jump * float(heights.pdf(h + w / SIGMA_S))
    return -ETA * total / SIGMA_S


# ------------------------------------------------------------------------------ published
def published(law: Law) -> None:
    """Numbers that the sources give, or that follow from them by hand."""
    check = PUBLISHED.get(law.name)
    if check is not None:
        check(law)


def _gw(law: Law) -> None:
    F = law.force(1e-8, R=1e-6, E_star=1e11, H=5e9)
    assert_allclose(float(F), 400 / 3 * 1e-6, rtol=1e-14)


def _ceb(law: Law) -> None:
    K = law.K or 0.454 + 0.41 * nu_of(law)
    w = (PI * K * H / (2 * E_STAR)) ** 2 * R
    below, above = law.mean_pressure(w * np.array([1 - 1e-12, 1 + 1e-12]), **CASE) / H
    assert_allclose([below, above], [2 / 3 * K, K], rtol=1e-11)
    S = law.stiffness(w * np.array([1 - 1e-12, 1 + 1e-12]), **CASE)
    assert_allclose(S[1] / S[0], 2, rtol=1e-10)
    A = law.area(w * np.array([2.0, 3.0, 10.0]), **CASE)
    assert_allclose(A / (PI * R * w), [3, 5, 19], rtol=1e-11)


def _zmc(law: Law) -> None:
    w1 = (0.3 * PI * H / E_STAR) ** 2 * R
    s = np.array([1e-15, 0.25, 0.5, 0.75, 1])
    w = w1 * (1 + 53 * s)
    area = law.area(w, **CASE) / (PI * R * w)
    assert_allclose(area, [1, 1.15625, 1.5, 1.84375, 2], rtol=1e-12)
    p = law.mean_pressure(w, **CASE) / H
    assert_allclose(p, [0.4, 0.799614, 0.898501, 0.957654, 1], atol=6e-7)
    S = [law.stiffness(w1 * y * np.array([1 - 1e-12, 1 + 1e-12]), **CASE) for y in (1, 54)]
    assert_allclose([b / a - 1 for a, b in S], [-0.0826, -0.1307], atol=6e-5)


def _hermite(law: Law) -> None:
    w1 = (0.3 * PI * H / E_STAR) ** 2 * R
    middle = float(law.mean_pressure(w1 * math.sqrt(54), **CASE)) / H
    # halfway k/2 + m_0/8 + 1/2 with m_0 = 0.2 ln 54
    assert_allclose(middle, 0.7 + 0.025 * math.log(54), rtol=1e-13)
    for y in (1.0, 54.0):
        a, b = law.stiffness(w1 * y * np.array([1 - 1e-10, 1 + 1e-10]), **CASE)
        assert_allclose(b, a, rtol=1e-8)


def _ke(law: Law) -> None:
    nu = nu_of(law)
    K = 0.454 + 0.41 * nu
    wc = (PI * K * H / (2 * E_STAR)) ** 2 * R
    Fc, Ac = 2 / 3 * K * H * PI * R * wc, PI * R * wc
    F = law.force(wc * np.array([3.0, 50.0]), **CASE) / Fc
    assert_allclose(F, [4.928730, 195.851612], rtol=2e-7)
    A = law.area(wc * np.array([3.0, 50.0, 200.0]), **CASE) / Ac
    assert_allclose(A, [0.93 * 3**1.136, 0.94 * 50**1.146, 400], rtol=1e-11)
    last = {0.29: 0.0865, 0.25: 0.1185, 0.35: 0.0418}.get(nu)
    jumps = bound(law).jumps
    assert_allclose(jumps[1.0], [0.03, -0.07, -0.0215], atol=6e-5)
    assert_allclose(jumps[6.0], [0.0168, 0.0290, -0.0988], atol=6e-5)
    if last is not None:
        assert_allclose(jumps[110.0][:2], [last, 0.0712], atol=6e-5)
    if nu == 0.29:
        assert_allclose(jumps[110.0].stiffness, -0.1398, atol=6e-5)
    assert bound(law).valid_to == 110


def _jg(law: Law) -> None:
    S_y = 1e9
    E = 200 * S_y
    case = {"R": R, "E_star": E, "H": law.hardness_ratio * S_y}
    C = 1.295 * math.exp(0.736 * NU)
    law = law.replace(nu=NU)
    wc = (PI * C * S_y / (2 * E)) ** 2 * R
    Fc = 4 / 3 * (R / E) ** 2 * (PI * C * S_y / 2) ** 3
    F = law.force(wc * np.array([10.0, 110.0, 1000.0]), **case) / Fc
    assert_allclose(F, [25.9475, 501.588, 4373.96], rtol=2e-6)
    near = 1.9 * wc * np.array([1 - 1e-12, 1 + 1e-12])
    F, S = law.force(near, **case), law.stiffness(near, **case)
    assert_allclose(F[1] / F[0] - 1, 0.00684, atol=6e-6)
    assert_allclose(S[1] / S[0] - 1, -0.0510, atol=6e-5)
    # the slope of the area jumps by 1 + B
    w = 1.9 * wc * (1 + np.array([1e-9, 1e-5]))
    slope = float(np.diff(law.area(w, **case))[0] / np.diff(w)[0]) / (PI * R)
    assert_allclose(slope, 1 + 0.14 * math.exp(23 / 200), rtol=1e-5)
    for hardness in (H, 30 * E_STAR):  # the limit beyond 1.9 ω_c and below
        case = {**CASE, "H": hardness}
        own = law.bound(**case)
        end = own.valid_to * float(own.yield_interference(**case))
        assert_allclose(float(law.contact_radius(end, **case)) / R, 0.41, rtol=1e-12)


def _elliptic(law: Law) -> None:
    """R_A/R_g, and ω of yield over that of the sphere of R_g."""
    rows = ((2.0, 0.99348, 0.9676), (4.0, 0.97555, 0.8802), (10.0, 0.94088, 0.7197))
    sphere = unit(law.replace(ratio=1.0))
    for ratio, area, earlier in (*rows, (100.0, 0.84440, 0.3462)):
        one = law.replace(ratio=ratio)
        w = 0.5 * unit(one)
        assert_allclose(float(one.area(w, **CASE)) / (PI * R * w), area, atol=6e-6)
        assert_allclose(unit(one) / sphere, earlier, atol=6e-5)
    volume = law.replace(ratio=10.0, area_rule="volume")
    w = np.array([1e6, 2e6]) * unit(volume)
    slope = float(np.diff(volume.area(w, **CASE))[0] / np.diff(w)[0])
    assert_allclose(slope, 2 * PI * R, rtol=1e-9)


def _dmt(law: Law) -> None:
    w = law.w
    assert_allclose(float(law.force(1e-20 * R, **CASE)), -2 * PI * w * R, rtol=1e-12)
    balance = R * (1.5 * PI * w / (E_STAR * R)) ** (2 / 3)
    assert abs(float(law.force(balance, **CASE))) < 1e-13 * PI * w * R
    assert_allclose(float(law.area(balance, **CASE)), PI * R * balance, rtol=1e-13)


def _jkr(law: Law) -> None:
    w = law.w
    X = (PI**2 * w**2 * R / E_STAR**2) ** (1 / 3)
    radius = (PI * w * R**2 / E_STAR) ** (1 / 3)
    pull = PI * w * R
    on = law.replace(unloading=False)
    assert_allclose(float(on.force(1e-13 * X, **CASE)) / pull, -4 / 3, rtol=1e-10)
    off = law.replace(unloading=True)
    assert_allclose(float(off.force(-0.75 * X * (1 - 1e-13), **CASE)) / pull, -5 / 6, atol=1e-5)
    a = float(off.contact_radius(-0.75 * X * (1 - 1e-13), **CASE)) / radius
    assert_allclose(a, 0.5, atol=1e-5)
    # the load is least where â³ = 9/8
    at = 1.125 ** (2 / 3) - math.sqrt(2 * 1.125 ** (1 / 3))
    assert_allclose(at, -0.360562, atol=6e-7)
    assert_allclose(float(off.force(at * X, **CASE)) / pull, -1.5, rtol=1e-12)
    assert_allclose(
        float(off.contact_radius(at * X, **CASE)) / radius, 1.125 ** (1 / 3), rtol=1e-11
    )
    assert abs(float(off.stiffness(at * X, **CASE))) < 1e-10 * E_STAR * radius
    # load and unload agree wherever both are in contact
    omega = np.geomspace(1e-3, 1e3, 20) * X
    assert_allclose(on.force(omega, **CASE), off.force(omega, **CASE), rtol=1e-14)


PUBLISHED: dict[str, Callable[[Law], None]] = {
    "gw": _gw,
    "ceb": _ceb,
    "zmc": _zmc,
    "hermite": _hermite,
    "ke": _ke,
    "jg": _jg,
    "elliptic-ceb": _elliptic,
    "elliptic-zmc": _elliptic,
    "dmt": _dmt,
    "jkr": _jkr,
}

CHECKS: tuple[Callable[[Law], None], ...] = (
    elastic_limit,
    no_load_without_interference,
    load_grows,
    area_grows,
    jumps_are_declared,
    onset_is_declared,
    the_range_ends_where_it_says,
    stiffness_is_the_slope,
    energy_is_the_work,
    any_units,
    one_number_or_many,
    round_trip,
    pressure_at_yield,
    plastic_limit,
    a_round_ellipse_is_a_circle,
    published,
    hard_is_elastic,
    exponential_heights,
    derivative_of_the_sum,
    same_as_plain,
)


def failures(
    law: Law, checks: tuple[Callable[[Law], None], ...] = CHECKS, *, first: bool = False
) -> list[str]:
    """Names of the checks that the law does not pass, or the first of them."""
    out: list[str] = []
    for check in checks:
        if first and out:
            break
        try:
            with np.errstate(all="ignore"):
                check(law)
        except (AssertionError, ArithmeticError, ValueError):
            out.append(check.__name__)
    return out
