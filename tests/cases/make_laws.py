"""Asperity laws by mpmath with 30 digits: writes laws.json beside this file.

    python tests/cases/make_laws.py

It shares no line with the library or with the tests: every law is written from its published
regimes, every sum is `mp.quad` of law times density. Where the library has a choice this script
takes the other: elliptic integrals K and E instead of Carlson's, Johnson parameters by Newton on
integrated moments, JKR in its own parameter. Lengths over R (elliptic: R_g), stresses over E*.
About a minute.
"""

import json
from pathlib import Path

import mpmath as mp

mp.mp.dps = 30
PI = mp.pi
num = mp.mpf

H, NU, K_CEB, K_ZMC, RHO = num("0.02"), num("0.29"), num("0.6"), num("0.4"), num(54)
S_Y, W = num("0.007"), num("5e-5")
SIGMA_S, ETA_R_SIGMA_S = num("0.01"), num("0.05")


# ------------------------------------------------------------------------------- the laws
# each law: (names of regimes, breakpoints in ω, [F(ω), ...], [A(ω), ...])
def hertz(w):
    return num(4) / 3 * w ** num("1.5")


def disc(w):
    return PI * w


def gw():
    return ("elastic",), (), (hertz,), (disc,)


def ceb(K=K_CEB):
    wc = (PI * K * H / 2) ** 2

    def area(w):
        return PI * w * (2 - wc / w)

    return ("elastic", "plastic"), (wc,), (hertz, lambda w: K * H * area(w)), (disc, area)


def pressure_log(u):
    return K_ZMC + (1 - K_ZMC) * u


def pressure_hermite(u):
    m0 = K_ZMC * mp.log(RHO) / 2
    return K_ZMC * (2 * u**3 - 3 * u**2 + 1) + m0 * (u**3 - 2 * u**2 + u) + 3 * u**2 - 2 * u**3


def three_stages(pressure, R_A=1, root_R_F=1, full=2):
    """ZMC, its smooth variant, and the elliptic one; ``full`` is the plastic area over πω."""
    w1 = (3 * PI * K_ZMC * H * R_A / (4 * root_R_F)) ** 2
    w2 = RHO * w1

    def middle_area(w):
        s = (w - w1) / (w2 - w1)
        return PI * w * (R_A + (full - R_A) * (3 * s**2 - 2 * s**3))

    def middle(w):
        return H * pressure(mp.log(w / w1) / mp.log(RHO)) * middle_area(w)

    return (
        ("elastic", "elastoplastic", "plastic"),
        (w1, w2),
        (lambda w: root_R_F * hertz(w), middle, lambda w: H * full * PI * w),
        (lambda w: PI * R_A * w, middle_area, lambda w: full * PI * w),
    )


def ke(nu=NU):
    K = num("0.454") + num("0.41") * nu
    wc = (PI * K * H / 2) ** 2
    Fc, Ac = num(2) / 3 * K * H * PI * wc, PI * wc

    def power(unit, c, m):
        return lambda w: unit * num(c) * (w / wc) ** num(m)

    return (
        ("elastic", "elastoplastic", "elastoplastic", "plastic"),
        (wc, 6 * wc, 110 * wc),
        (
            power(Fc, "1", "1.5"),
            power(Fc, "1.03", "1.425"),
            power(Fc, "1.40", "1.263"),
            power(Fc, 3 / K, "1"),
        ),
        (
            power(Ac, "1", "1"),
            power(Ac, "0.93", "1.136"),
            power(Ac, "0.94", "1.146"),
            power(Ac, "2", "1"),
        ),
    )


def jg(nu=NU):
    C, B = num("1.295") * mp.exp(num("0.736") * nu), num("0.14") * mp.exp(23 * S_Y)
    wc = (PI * C * S_Y / 2) ** 2
    Fc = num(4) / 3 * (PI * C * S_Y / 2) ** 3

    def area(w):
        return PI * w * (w / (num("1.9") * wc)) ** B

    def force(w):
        x, a = w / wc, mp.sqrt(area(w) / PI)
        HG = num("2.84") * S_Y * (1 - mp.exp(-num("0.82") * a ** -num("0.7")))
        first = mp.exp(-(x ** (num(5) / 12)) / 4) * x ** num("1.5")
        return Fc * (first + 4 * HG / (C * S_Y) * (1 - mp.exp(-(x ** (num(5) / 9)) / 25)) * x)

    return ("elastic", "elastoplastic"), (num("1.9") * wc,), (hertz, force), (disc, area)


def ellipse(ratio):
    """k, K(m), R_A, √R_F of a contact with R′/R″ = ratio and √(R′R″) = 1."""
    ratio = num(ratio)
    with mp.workdps(60):
        R1 = mp.sqrt(ratio)
        if ratio == 1:
            return num(1), PI / 2, num(1), num(1)

        def curvature(log_k):
            k2 = mp.exp(2 * log_k)
            K, E = mp.ellipk(1 - k2), mp.ellipe(1 - k2)
            return (E / k2 - K) / (K - E)

        low, high = -mp.log(ratio), -mp.log(ratio) / 100
        log_k = mp.findroot(lambda q: mp.log(curvature(q) / ratio), (low, high), solver="anderson")
        k = mp.exp(log_k)
        K, E = mp.ellipk(1 - k**2), mp.ellipe(1 - k**2)
        # unit p_0/E*: δ and a_x from the potential of an ellipsoidal pressure
        D = (K - E) / (1 - k**2)
        a_x = 1 / (num(1) / (2 * R1) / (k * D))  # 1/2R′ = (p_0/E*) k D/a_x for p_0 = E*
        delta = k * a_x * K
        R_A = k * a_x**2 / delta
        root_R_F = num(2) / 3 * PI * k * a_x**2 / (num(4) / 3 * delta ** num("1.5"))
    return +k, +K, +R_A, +root_R_F


def elliptic_ceb(ratio, rule):
    _, _, R_A, root_R_F = ellipse(ratio)
    p = K_CEB * H * 2 / 3
    wc = (3 * PI * p * R_A / (4 * root_R_F)) ** 2

    def area(w):
        if rule == "volume":
            return PI * R_A * wc + 2 * PI * (w - wc)
        return PI * R_A * w * (2 - wc / w)

    return (
        ("elastic", "plastic"),
        (wc,),
        (lambda w: root_R_F * hertz(w), lambda w: K_CEB * H * area(w)),
        (lambda w: PI * R_A * w, area),
    )


def elliptic_zmc(ratio, rule):
    _, _, R_A, root_R_F = ellipse(ratio)
    full = num(2) if rule == "volume" else 2 * R_A
    return three_stages(pressure_log, R_A, root_R_F, full)


def dmt():
    return ("elastic",), (), (lambda w: hertz(w) - 2 * PI * W,), (disc,)


X = (PI**2 * W**2) ** (num(1) / 3)


def jkr_root(w):
    return mp.findroot(lambda s: s**4 / 4 - s - w / X, (4 * (abs(w / X) + 2)) ** num("0.25") + 1)


def jkr():
    return (
        ("elastic",),
        (),
        (lambda w: PI * W * (jkr_root(w) ** 6 / 6 - jkr_root(w) ** 3),),
        (lambda w: PI * X * jkr_root(w) ** 4 / 4,),
    )


SPHERES = {
    "gw": gw(),
    "ceb": ceb(),
    "zmc": three_stages(pressure_log),
    "hermite": three_stages(pressure_hermite),
    "ke": ke(),
    "jg": jg(),
    "dmt": dmt(),
    "jkr": jkr(),
}
REDUCED = ("1e-4", "0.3", "0.999", "1.001", "2.5", "5.99", "6.01", "20", "53.95", "54.05")
REDUCED += ("109.9", "110.1", "500", "9000")


def piece(law, w):
    return sum(w >= edge for edge in law[1])


def at(law, text):
    w = num(text)
    i = piece(law, w)
    names, _, force, area = law
    S = mp.diff(force[i], w, h=w * num("1e-12"))
    return {"omega": text, **show(F=force[i](w), A=area[i](w), S=S), "regime": names[i]}


def show(**values):
    return {name: mp.nstr(value, 17, min_fixed=0, max_fixed=0) for name, value in values.items()}


def singles():
    out = []
    for name, law in SPHERES.items():
        scale = law[1][0] if law[1] else num("3e-4")
        if name == "jg":
            scale /= num("1.9")
        ys = REDUCED + (("1.899", "1.901") if name == "jg" else ())
        omegas = [mp.nstr(num(y) * scale, 12) for y in ys]
        if name == "jkr":
            omegas = [mp.nstr(num(y) * X, 12) for y in ("-0.7", "-0.5", "-0.1", *ys)]
        out += [{"law": name, "options": {}, **at(law, text)} for text in omegas]
    for make, name in ((elliptic_ceb, "elliptic-ceb"), (elliptic_zmc, "elliptic-zmc")):
        for ratio in ("1", "1.1", "2", "10", "100"):
            for rule in ("volume", "doubling"):
                law = make(ratio, rule)
                options = {"ratio": float(ratio), "area_rule": rule}
                for y in ("0.3", "0.999", "1.001", "3", "30", "53.95", "54.05", "300"):
                    text = mp.nstr(num(y) * law[1][0], 12)
                    out.append({"law": name, "options": options, **at(law, text)})
    return out


# ---------------------------------------------------------------------------- the heights
def gauss(z):
    return mp.exp(-(z**2) / 2) / mp.sqrt(2 * PI)


def johnson(kind, skew, kurtosis, start):
    """γ, δ, ξ, λ by Newton on the moments of the bare variable."""
    shape = {"SU": mp.sinh, "SB": lambda v: 1 / (1 + mp.exp(-v))}[kind]
    panels = mp.linspace(-13, 13, 9)

    def moments(gamma, delta):
        raw = [
            mp.quad(lambda n, j=j: shape((n - gamma) / delta) ** j * gauss(n), panels)
            for j in range(5)
        ]
        _, m, r2, r3, r4 = raw
        v = r2 - m**2
        third = r3 - 3 * m * r2 + 2 * m**3
        fourth = r4 - 4 * m * r3 + 6 * m**2 * r2 - 3 * m**4
        return m, v, third / v ** num("1.5"), fourth / v**2

    def misfit(gamma, delta):
        _, _, s, k = moments(gamma, delta)
        return [s - skew, k - kurtosis]

    gamma, delta = mp.findroot(misfit, start, tol=1e-24)
    m, v, _, _ = moments(gamma, delta)
    lam = 1 / mp.sqrt(v)
    return gamma, delta, -lam * m, lam


def heights():
    """Name: (constructor, density, ends of integration, Johnson parameters)."""
    beta = num("1.8")
    mean = mp.gamma(1 + 1 / beta)
    std = mp.sqrt(mp.gamma(1 + 2 / beta) - mean**2)

    def weibull(z):
        x = mean + std * z
        return std * beta * x ** (beta - 1) * mp.exp(-(x**beta)) if x > 0 else num(0)

    out = {
        "gaussian": ({"type": "GaussianHeights"}, gauss, (-13, 13), None),
        "exponential": ({"type": "ExponentialHeights"}, lambda z: mp.exp(-z - 1), (-1, 60), None),
        "weibull": (
            {"type": "WeibullHeights", "shape": 1.8},
            weibull,
            (-mean / std, (60 ** (1 / beta) - mean) / std),
            None,
        ),
    }
    for kind, skew, kurtosis, start in (
        ("SU", "-0.7", "4.2", (2.2, 3.0)),
        ("SB", "0.6", "2.8", (1.0, 1.2)),
    ):
        p = johnson(kind, num(skew), num(kurtosis), start)
        gamma, delta, xi, lam = p

        def density(z, kind=kind, gamma=gamma, delta=delta, xi=xi, lam=lam):
            y = (z - xi) / lam
            if kind == "SU":
                n, slope = gamma + delta * mp.asinh(y), 1 / mp.sqrt(1 + y * y)
            elif 0 < y < 1:
                n, slope = gamma + delta * mp.log(y / (1 - y)), 1 / (y * (1 - y))
            else:
                return num(0)
            return delta / lam * slope * gauss(n)

        ends = (xi, xi + lam)
        if kind == "SU":
            ends = tuple(xi + lam * mp.sinh((n - gamma) / delta) for n in (-13, 13))
        out[f"johnson-{kind}"] = (
            {"type": "JohnsonHeights", "skewness": float(skew), "kurtosis": float(kurtosis)},
            density,
            ends,
            p,
        )
    return out


# ------------------------------------------------------------------------------- the sums
def total(law, density, ends, h):
    """ηR ∫F₁ φ dω and ηR ∫A₁ φ dω over u = √t."""
    unit = ETA_R_SIGMA_S / SIGMA_S
    low, high = max(num(0), ends[0] - h), ends[1] - h
    kinks = [w / SIGMA_S for w in law[1]]
    marks = {low, high, *(t for t in kinks if low < t < high)}
    marks |= {t for t in (num("0.02"), num("0.3"), *map(num, range(1, 12, 2))) if low < t < high}
    edges = [mp.sqrt(t) for t in sorted(marks)]
    out = []
    for column in (2, 3):
        value = num(0)
        for a, b in zip(edges[:-1], edges[1:], strict=True):
            formula = law[column][piece(law, SIGMA_S * ((a + b) / 2) ** 2)]
            value += mp.quad(
                lambda u, f=formula: 2 * u * f(SIGMA_S * u * u) * density(h + u * u), [a, b]
            )
        out.append(unit * value)
    return out


def total_jkr(density, ends, h, unloading):
    """The same in s, with ω = X(s⁴/4 − s)."""
    unit = ETA_R_SIGMA_S / SIGMA_S
    first = num(1) if unloading else num(4) ** (num(1) / 3)

    def s_of(t):
        return jkr_root(SIGMA_S * t)

    low, high = first, s_of(ends[1] - h)
    if ends[0] > h:
        low = max(low, s_of(ends[0] - h))
    edges = mp.linspace(low, high, 13)
    out = []
    for value in (lambda s: PI * W * (s**6 / 6 - s**3), lambda s: PI * X * s**4 / 4):
        out.append(
            unit
            * mp.quad(
                lambda s, v=value: (
                    v(s) * density(h + X / SIGMA_S * (s**4 / 4 - s)) * X / SIGMA_S * (s**3 - 1)
                ),
                edges,
            )
        )
    return out


def sums(populations):
    out = []
    laws = {(name, ()): law for name, law in SPHERES.items() if name != "jkr"}
    for make, name in ((elliptic_ceb, "elliptic-ceb"), (elliptic_zmc, "elliptic-zmc")):
        laws[name, (("ratio", 4.0),)] = make("4", "volume")
    with mp.workdps(22):
        for _, density, ends, _ in populations.values():
            mass = mp.quad(density, mp.linspace(*ends, 25))
            assert abs(mass - 1) < 1e-15, mass
        for label, (_, density, ends, _) in populations.items():
            for h in ("0.5", "1.5", "3"):
                if num(h) >= ends[1]:
                    continue
                for (name, options), law in laws.items():
                    F, A = total(law, density, ends, num(h))
                    out.append(row(name, dict(options), label, h, F, A))
                for unloading in (False, True):
                    F, A = total_jkr(density, ends, num(h), unloading)
                    out.append(row("jkr", {"unloading": unloading}, label, h, F, A))
    return out


def row(name, options, label, h, F, A):
    return {"law": name, "options": options, "heights": label, "h": h, **show(F=F, A=A)}


def main():
    populations = heights()
    ellipses = []
    for ratio in ("1", "1.00000001", "1.1", "2", "4", "10", "100", "1000000"):
        k, K, R_A, root_R_F = ellipse(ratio)
        ellipses.append({"ratio": ratio, **show(k=k, K=K, R_A=R_A, root_R_F=root_R_F)})
    data = {
        "about": "made by make_laws.py; lengths over R, stresses over E*; sums per nominal area",
        "constants": {
            "H": "0.02",
            "nu": "0.29",
            "S_y": "0.007",
            "K": "0.6",
            "w": "5e-5",
            "sigma_s": "0.01",
            "eta_R_sigma_s": "0.05",
        },
        "single": singles(),
        "ellipses": ellipses,
        "heights": {
            label: {
                "type": build,
                **({} if p is None else {"johnson": [mp.nstr(v, 17) for v in p]}),
            }
            for label, (build, _, _, p) in populations.items()
        },
        "sums": sums(populations),
    }
    path = Path(__file__).with_name("laws.json")
    path.write_text(json.dumps(data, indent=1, ensure_ascii=False) + "\n", "utf-8")


if __name__ == "__main__":
    main()
