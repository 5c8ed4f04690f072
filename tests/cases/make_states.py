"""Reference states by mpmath with 30 digits: writes states.json beside this file.

    python tests/cases/make_states.py

It shares no line with the library or with the oracle of the tests: every integral is `mp.quad`
of the formulas as they stand, and every balance is solved by bisection. SI units; loads over
E*_ss. About three minutes.
"""

import json
from pathlib import Path

import mpmath as mp

mp.mp.dps = 30
PI = mp.pi
STEEL = {"E": "205e9", "nu": "0.29", "H": "5e9"}
SILICA = {"E": "68e9", "nu": "0.19", "H": "7.7e9"}
BRASS = {"E": "100e9", "nu": "0.35", "H": "1.5e9"}
TALC = {"E": "20e9", "nu": "0.3", "H": "0.3e9"}
K, RHO = mp.mpf("0.4"), mp.mpf(54)


def num(text):
    return mp.mpf(text)


def modulus(a, b):
    return 1 / sum((1 - num(m["nu"]) ** 2) / num(m["E"]) for m in (a, b))


def contact(w, R, E, H, rule, capped=False):
    """Load, area and zone (0, 1, 2) of one sphere on a flat."""
    if w <= 0:
        return mp.mpf(0), mp.mpf(0), 0
    w1 = (3 * PI * K * H / (4 * E)) ** 2 * R
    w2 = RHO * w1
    if w < w1:
        A, p, zone = PI * R * w, 4 * E / (3 * PI) * mp.sqrt(w / R), 0
    elif w < w2:
        s, u = (w - w1) / (w2 - w1), mp.log(w / w1) / mp.log(RHO)
        A, zone = PI * R * w * (1 + 3 * s**2 - 2 * s**3), 1
        if rule == "log":
            p = H * (K + (1 - K) * u)
        else:
            m0 = K * mp.log(RHO) / 2
            p = H * (
                K * (2 * u**3 - 3 * u**2 + 1) + m0 * (u**3 - 2 * u**2 + u) + 3 * u**2 - 2 * u**3
            )
    else:
        A, p, zone = 2 * PI * R * w, H, 2
    if capped and A >= PI * R**2:
        A, zone = PI * R**2, 2
    return p * A, A, zone


def kinks_of(R, E, H):
    w1 = (3 * PI * K * H / (4 * E)) ** 2 * R
    return w1, RHO * w1, R / 2


def asperities(d, case):
    """Pressure and regime areas of the asperities."""
    sigma, R = num(case["sigma"]), num(case["R"])
    s = sigma * mp.sqrt(1 - mp.mpf("0.8968") / num(case["alpha"]))
    eta = num(case["eta_R_sigma"]) / (R * sigma)
    one, two = case["first"], case["second"]
    E, H = modulus(one, two), min(num(one["H"]), num(two["H"]))
    centre = num(case.get("datum", "0")) * sigma
    w1, w2, _ = kinks_of(R, E, H)
    end = max(mp.mpf(0), centre - d) + 16 * s

    def sum_of(column, a, b):
        if b <= a:
            return mp.mpf(0)
        points = [a] + [x for x in mp.linspace(0, end, 65) if a < x < b] + [b]
        points = [mp.sqrt(x) for x in points]
        # mp.quad stops at an absolute error: take the size of the density out
        h = (d - centre) / s
        peak = max(h + a / s, mp.mpf(0))

        def integrand(v):
            area_or_load = contact(v * v, R, E, H, case["asperity_rule"])[column]
            return 2 * v * area_or_load * mp.exp(peak**2 / 2 - (h + v * v / s) ** 2 / 2)

        # and the size of one contact
        unit = 2 * PI * R * s * (H if column == 0 else 1) * s
        scaled = mp.quad(lambda v: integrand(v) / unit, points)
        return eta * unit * scaled * mp.npdf(peak) / s

    zones = ((mp.mpf(0), min(w1, end)), (min(w1, end), min(w2, end)), (min(w2, end), end))
    return sum(sum_of(0, *z) for z in zones), [sum_of(1, *z) for z in zones]


def sizes(case):
    """Density of a truncated Gaussian and its ends."""
    m, n = num(case["x_a"]), num(case["n"])
    s = num(case["width"]) * m
    lo, hi = max(mp.mpf(0), m - n * s), m + n * s
    mass = mp.ncdf(hi, m, s) - mp.ncdf(lo, m, s) if case.get("normalise", True) else 1
    return (lambda x: mp.npdf(x, m, s) / mass), lo, hi, m, s


def sides(case):
    """E and H on both sides of a particle."""
    a = case["particle"]
    return [(modulus(case[s], a), min(num(case[s]["H"]), num(a["H"]))) for s in ("first", "second")]


def share(t, both):
    """δ_1/x of a unit particle squeezed by t, by bisection."""
    if both[0] == both[1]:
        return t / 2

    def excess(w):
        one = contact(w, mp.mpf(1) / 2, *both[0], "hermite", True)[0]
        return one - contact(t - w, mp.mpf(1) / 2, *both[1], "hermite", True)[0]

    lo, hi = mp.mpf(0), t
    for _ in range(100):
        mid = (lo + hi) / 2
        lo, hi = (mid, hi) if excess(mid) < 0 else (lo, mid)
    return (lo + hi) / 2


def squeezed(t, both):
    """f, area on 1 by zone, area on 2 of a unit particle."""
    one = share(t, both)
    f1, A1, zone = contact(one, mp.mpf(1) / 2, *both[0], "hermite", True)
    f2, A2, _ = contact(t - one, mp.mpf(1) / 2, *both[1], "hermite", True)
    return [min(f1, f2), *(A1 if zone == z else mp.mpf(0) for z in range(3)), A2, max(A1, A2)]


def squeezed_kinks(both):
    """t where a formula changes on either side."""
    out = []
    for i in (0, 1):
        me, other = both[i], both[1 - i]
        for w in kinks_of(mp.mpf(1) / 2, *me):
            f = contact(w, mp.mpf(1) / 2, *me, "hermite", True)[0]
            if f > contact(1, mp.mpf(1) / 2, *other, "hermite", True)[0] * (1 + mp.mpf(10) ** -20):
                continue
            lo, hi = mp.mpf(0), mp.mpf(1) / 4
            for _ in range(100):
                mid = (lo + hi) / 2
                load = contact(mid, mp.mpf(1) / 2, *other, "hermite", True)[0]
                lo, hi = (mid, hi) if load < f else (lo, mid)
            out.append(w + (lo + hi) / 2)
    return sorted(out)


def vector_quad(f, points):
    """Integral of a list-valued function: a Gauss rule of 60 points on each panel."""
    nodes = gauss(60)
    total = None
    for a, b in zip(points, points[1:], strict=False):
        if b <= a:
            continue
        for x, w in nodes:
            value = [w * (b - a) / 2 * v for v in f((a + b) / 2 + (b - a) / 2 * x)]
            total = value if total is None else [p + q for p, q in zip(total, value, strict=True)]
    return total


_RULES = {}


def gauss(n):
    if n not in _RULES:
        rule = []
        for i in range(n):
            x = mp.cos(PI * (i + mp.mpf(3) / 4) / (n + mp.mpf(1) / 2))
            for _ in range(12):
                p0, p1 = mp.mpf(1), x
                for k in range(2, n + 1):
                    p0, p1 = p1, ((2 * k - 1) * x * p1 - (k - 1) * p0) / k
                slope = n * (x * p1 - p0) / (x * x - 1)
                x -= p1 / slope
            rule.append((x, 2 / ((1 - x * x) * slope**2)))
        _RULES[n] = rule
    return _RULES[n]


def plane(d, case):
    """Columns of `squeezed` summed over sizes; v² = x − gap near contact."""
    phi, lo, hi, m, s = sizes(case)
    both = sides(case)
    gap = d - num(case.get("h_0", "0"))
    marks = [gap / (1 - t) for t in squeezed_kinks(both) if t < 1]
    marks += [m + j * s for j in range(-4, 5)]
    start = max(gap, lo)
    marks = [start] + sorted(x for x in marks if start < x < hi) + [hi]
    roots = [mp.sqrt(x - start) for x in marks]

    def columns(v):
        x = start + v * v
        return [2 * v * phi(x) * x * x * c for c in squeezed(1 - gap / x, both)]

    return vector_quad(columns, roots)


def rough(d, case):
    """As `plane`, each size over all seat heights: ζ ~ N(0, σ²)."""
    phi, lo, hi, m, s = sizes(case)
    both, sigma = sides(case), num(case["sigma"])
    h = d + 4 * sigma / mp.sqrt(PI * num(case["alpha"]))
    kinks = squeezed_kinks(both)
    assert both[0] == both[1], "the saturated tail below assumes equal sides"

    def over_seats(x):
        marks = {mp.mpf(0), *(x * t for t in kinks), kinks[0] * x / 10}
        marks |= {h - x, *(j * sigma for j in range(-8, 9))}
        marks |= {j * sigma - h + x for j in range(-8, 9)}
        end = x * kinks[-1]
        points = sorted(y for y in marks if 0 <= y <= end)
        roots = [mp.sqrt(y) for y in points]

        def columns(v):
            weight = 2 * v * mp.npdf(h - x + v * v, 0, sigma) * x * x
            return [weight * c for c in squeezed(v * v / x, both)]

        body = vector_quad(columns, roots)
        rest = x * x * mp.ncdf(-(h - x + end) / sigma)
        return [b + rest * c for b, c in zip(body, squeezed(mp.mpf(1), both), strict=True)]

    marks = [lo, *(m + j * s for j in range(-2, 3) if lo < m + j * s < hi), hi]
    rule, total = gauss(24), None
    for a, b in zip(marks, marks[1:], strict=False):
        for y, w in rule:
            x = (a + b) / 2 + (b - a) / 2 * y
            part = [w * (b - a) / 2 * phi(x) * c for c in over_seats(x)]
            total = part if total is None else [p + q for p, q in zip(total, part, strict=True)]
    return total


def horng(d, case):
    """F_sa, areas and shadow of the printed model with its switches x2, plastic on, shadow d."""
    phi, lo, hi, _, _ = sizes(case)
    H1, H2, Ha = (num(case[b]["H"]) for b in ("first", "second", "particle"))
    E1, E2 = modulus(case["first"], case["particle"]), modulus(case["first"], case["second"])
    C = 9 * PI**2 / 4 * ((H1 / E1) ** 2 + (H2 / E2) ** 2)
    h_e, chi = num(case["h_e_sigma"]) * num(case["sigma"]), num(case["chi"])
    eta = chi * num(case["areal_density"])

    def second(a, b):
        a, b = max(a, lo), min(b, hi)
        return mp.quad(lambda x: x * x * phi(x), mp.linspace(a, b, 9)) if b > a else mp.mpf(0)

    window, above = C * second(d - h_e, d), second(d, hi)
    if case["hardness_rule"] == "sum":
        part, p = Ha / (H1 + Ha), H1 + Ha
    else:
        part, p = H2 / (H1 + H2), H1
    A = PI * eta * part * (window + above)
    return p * A, A, PI * eta * H1 / (H1 + H2) * above


def state(case):
    """All fields of one case."""
    d, E_ss = num(case["d"]), modulus(case["first"], case["second"])
    F2, areas = asperities(d, case)
    law = case["law"]
    if law == "none":
        F_sa, extra, A2, shade = mp.mpf(0), [mp.mpf(0)] * 3, mp.mpf(0), mp.mpf(0)
    elif law == "horng2022":
        F_sa, A, shade = horng(d, case)
        extra, A2 = [mp.mpf(0), mp.mpf(0), A], None
    else:
        eta = num(case["areal_density"])
        F_sa, *extra, A2, shade = (eta * c for c in (plane if law == "plane" else rough)(d, case))
    free = 1 - shade
    A_ss, A_sa = free * sum(areas), sum(extra)
    out = {
        "F_star": (free * F2 + F_sa) / E_ss,
        "F_ss_star": free * F2 / E_ss,
        "F_sa_star": F_sa / E_ss,
        "A_t": A_ss + A_sa,
        "A_ss": A_ss,
        "A_sa": A_sa,
        "A_sa2": A2,
        "shadow": shade,
    }
    for name, a, b in zip(("A_e", "A_ep", "A_p"), areas, extra, strict=True):
        out[name] = free * a + b
    return {k: None if v is None else float(v) for k, v in out.items()}


def cases():
    """Inputs, as decimal text so that every reader gets the same numbers."""
    ground = {
        "first": STEEL,
        "second": STEEL,
        "sigma": "1e-7",
        "R": "2.8e-6",
        "alpha": "5",
        "eta_R_sigma": "0.0455",
        "asperity_rule": "log",
        "law": "none",
    }
    for d in ("-2e-7", "0", "1e-7", "2.5e-7", "5e-7", "9e-7"):
        yield ground | {"d": d}
    yield ground | {"d": "2e-7", "asperity_rule": "hermite"}
    yield ground | {"d": "2e-7", "second": BRASS, "R": "20e-6", "alpha": "12"}
    dust = {
        "particle": SILICA,
        "x_a": "3e-7",
        "width": "0.2",
        "n": "3",
        "areal_density": "1e11",
    }
    yield ground | dust | {"law": "plane", "d": "2.5e-7"}
    yield ground | dust | {"law": "plane", "d": "1e-7"}
    yield ground | dust | {"law": "plane", "d": "4.7e-7"}
    yield ground | dust | {"law": "plane", "d": "5.4e-7", "h_0": "2.5e-7", "width": "0.05"}
    yield ground | dust | {"law": "plane", "d": "2e-7", "first": BRASS}
    yield ground | dust | {"law": "plane", "d": "2e-7", "first": BRASS, "particle": TALC}
    yield ground | dust | {"law": "plane", "d": "2.2e-7", "particle": TALC, "width": "0.4"}
    yield ground | dust | {"law": "rough", "d": "3e-7"}
    yield ground | dust | {"law": "rough", "d": "1.5e-7", "particle": TALC, "width": "0.4"}
    paper = {
        "law": "horng2022",
        "datum": "1",
        "R": "11.1e-6",
        "width": "0.388",
        "n": "2.05",
        "normalise": False,
        "h_e_sigma": "3.11",
        "chi": "0.00738",
        "hardness_rule": "sum",
    }
    yield ground | dust | paper | {"d": "4e-7"}
    yield ground | dust | paper | {"d": "5e-7", "hardness_rule": "surface", "chi": "0.0185"}


def main():
    rows = []
    for case in cases():
        rows.append({"inputs": case, "state": state(case)})
        print(case["law"], case["d"], rows[-1]["state"]["F_star"], flush=True)
    note = "written by make_states.py with mpmath, 30 digits; SI, loads over E*_ss, areas over A_n"
    text = json.dumps({"note": note, "states": rows}, indent=1, ensure_ascii=False)
    (Path(__file__).parent / "states.json").write_text(text + "\n", "utf-8")


if __name__ == "__main__":
    main()
