"""A second, slow and plain implementation of the physics: the judge of the fast one.

Nothing here imports the library. Scalars in, scalars out, SI units; `scipy.integrate.quad` with
``epsabs=0`` on finite panels, `brentq` for every balance. Densities are plain functions.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import lru_cache

from scipy.integrate import quad
from scipy.optimize import brentq

RTOL = 1e-12
TINY = 1e-300
REGIMES = ("elastic", "elastoplastic", "plastic")


def integrate(f: Callable[[float], float], edges: Iterable[float]) -> float:
    """∫f over the sorted, distinct edges, one finite panel after the other."""
    points = sorted(set(edges))
    total = 0.0
    for a, b in zip(points, points[1:], strict=False):
        total += quad(f, a, b, epsabs=0.0, epsrel=RTOL, limit=200, full_output=1)[0]
    return total


def normal(y: float) -> float:
    return math.exp(-0.5 * y * y) / math.sqrt(2 * math.pi)


def normal_above(y: float) -> float:
    return 0.5 * math.erfc(y / math.sqrt(2))


# ------------------------------------------------------------------------------ materials
@dataclass(frozen=True)
class Body:
    E: float
    nu: float
    H: float


STEEL = Body(205e9, 0.29, 5e9)
SILICA = Body(68e9, 0.19, 7.7e9)


def contact_modulus(a: Body, b: Body) -> float:
    return 1 / ((1 - a.nu**2) / a.E + (1 - b.nu**2) / b.E)


# ------------------------------------------------------------------------- single contact
@dataclass(frozen=True)
class Tip:
    """One sphere of radius R on a flat; ``rule`` is "log" (ZMC) or "hermite"."""

    R: float
    E: float
    H: float
    rule: str = "log"
    k: float = 0.4
    rho: float = 54.0
    cap: bool = False

    @property
    def omega_1(self) -> float:
        return self.R * (3 * math.pi * self.k * self.H / (4 * self.E)) ** 2

    @property
    def omega_2(self) -> float:
        return self.rho * self.omega_1

    @property
    def saturation(self) -> float:
        """Interference after which a capped contact carries no more."""
        return max(self.omega_2, self.R / 2)

    def pressure(self, omega: float) -> float:
        if omega <= 0:
            return 0.0
        if omega < self.omega_1:
            return 4 * self.E / (3 * math.pi) * math.sqrt(omega / self.R)
        if omega >= self.omega_2:
            return self.H
        u = math.log(omega / self.omega_1) / math.log(self.rho)
        if self.rule == "log":
            return self.H * (self.k + (1 - self.k) * u)
        m_0 = 0.5 * self.k * math.log(self.rho)
        rise = 3 * u * u - 2 * u**3
        return self.H * (self.k * (1 - rise) + m_0 * u * (1 - u) ** 2 + rise)

    def area(self, omega: float) -> float:
        if omega <= 0:
            return 0.0
        s = (omega - self.omega_1) / (self.omega_2 - self.omega_1)
        s = min(max(s, 0.0), 1.0)
        area = math.pi * self.R * omega * (1 + 3 * s * s - 2 * s**3)
        return min(area, math.pi * self.R**2) if self.cap else area

    def force(self, omega: float) -> float:
        if omega <= 0:
            return 0.0
        return self.pressure(omega) * self.area(omega)

    def regime(self, omega: float) -> int:
        """0 elastic, 1 elastoplastic, 2 plastic (or capped)."""
        if self.cap and self.area(omega) >= math.pi * self.R**2:
            return 2
        return 0 if omega < self.omega_1 else 1 if omega < self.omega_2 else 2


# ------------------------------------------------------------------------------ asperities
@dataclass(frozen=True)
class Rough:
    sigma: float
    R: float
    alpha: float = 5.0
    eta_R_sigma: float = 0.0455

    @property
    def eta(self) -> float:
        return self.eta_R_sigma / (self.R * self.sigma)

    @property
    def sigma_s(self) -> float:
        return self.sigma * math.sqrt(1 - 0.8968 / self.alpha)

    @property
    def y_s(self) -> float:
        return 4 * self.sigma / math.sqrt(math.pi * self.alpha)


def asperity_sums(d: float, rough: Rough, tip: Tip, centre: float = 0.0) -> dict[str, float]:
    """Pressure F [Pa] and regime areas per nominal area; ``centre`` [m] is the mean height."""
    s = rough.sigma_s
    h = (d - centre) / s
    w_1, w_2 = tip.omega_1 / s, tip.omega_2 / s
    scale = min(1.0, 1 / max(h, 1.0))
    splits = {scale * j for j in (0.25, 1, 2, 4, 8, 16, 32)}
    if h < 0:
        splits |= {-h + j for j in (-4, -2, -1, 0, 1, 2, 4)}
    splits |= {w_1, w_2, w_1 / 10}
    out = {}
    zones = (("A_e", 0.0, w_1), ("A_ep", w_1, w_2), ("A_p", w_2, math.inf))
    force = 0.0
    for name, a, b in zones:
        # beyond this height the density has dropped by e^-45 from its largest value in the zone
        peak = max(h + a, 0.0)
        end = min(b, math.sqrt(peak**2 + 90) - h)
        if end <= a:
            out[name] = 0.0
            continue
        inner = {t for t in (*splits, *(a + t for t in splits)) if a < t < end}
        # v = √t makes the t^(3/2) of Hertz smooth
        roots = [math.sqrt(t) for t in (a, end, *inner)]

        def sum_of(f: Callable[[float], float], edges: list[float] = roots) -> float:
            return integrate(lambda v: 2 * v * f(s * v * v) * normal(h + v * v), edges)

        out[name] = rough.eta * sum_of(tip.area)
        force += rough.eta * sum_of(tip.force)
    return {"F": force, **out}


# -------------------------------------------------------------------------- one particle
@dataclass(frozen=True)
class Squeezed:
    """A particle of unit diameter between two flats, as function of t = δ/x."""

    one: Tip
    two: Tip

    @property
    def limit(self) -> float:
        """Load that neither side can exceed, over x²."""
        return math.pi / 4 * min(self.one.H, self.two.H)

    def carry(self, tip: Tip, force: float) -> float:
        """Smallest indentation at which one side carries a load."""
        if force <= 0:
            return 0.0
        if force >= tip.force(tip.saturation):
            return tip.saturation
        return math.exp(
            brentq(
                lambda u: tip.force(math.exp(u)) - force,
                math.log(1e-30),
                math.log(tip.saturation),
                xtol=1e-15,
                rtol=1e-15,
            )
        )

    @property
    def end(self) -> float:
        """t after which nothing changes."""
        return self.carry(self.one, self.limit) + self.carry(self.two, self.limit)

    @property
    def kinks(self) -> tuple[float, ...]:
        """t where either side changes its formula."""
        forces = {
            tip.force(w)
            for tip in (self.one, self.two)
            for w in (tip.omega_1, tip.omega_2, tip.R / 2, self.capped_from(tip))
        }
        inside = sorted(f for f in forces if 0 < f < self.limit)
        return (*(self.carry(self.one, f) + self.carry(self.two, f) for f in inside), self.end)

    @staticmethod
    def capped_from(tip: Tip) -> float:
        """Interference at which the area reaches the great circle."""
        full = math.pi * tip.R**2 * (1 - 1e-15)
        return brentq(lambda w: tip.area(w) - full, 0.0, 1.1 * tip.R, xtol=1e-16)

    def split(self, t: float) -> tuple[float, float]:
        """δ_1/x, δ_2/x from the balance of loads."""
        if t <= 0:
            return 0.0, 0.0
        if replace(self.one, cap=True) == replace(self.two, cap=True):
            return t / 2, t / 2
        if t >= self.end:
            if self.one.H < self.two.H:
                two = self.carry(self.two, self.limit)
                return t - two, two
            if self.two.H < self.one.H:
                one = self.carry(self.one, self.limit)
                return one, t - one
            return t / 2, t / 2
        # bracket in both directions so that tiny shares keep their digits
        small = brentq(
            lambda u: self.one.force(t * u) - self.two.force(t * (1 - u)), 0, 1, xtol=1e-17
        )
        return t * small, t * (1 - small)

    def response(self, t: float) -> tuple[float, float, float, int]:
        """f, a_1, a_2 over x², and the regime on surface 1."""
        if t <= 0:
            return 0.0, 0.0, 0.0, 0
        if t >= self.end:
            full = math.pi / 4
            one = full if self.one.H <= self.two.H else self.one.area(self.split(t)[0])
            two = full if self.two.H <= self.one.H else self.two.area(self.split(t)[1])
            return self.limit, one, two, self.one.regime(self.split(t)[0])
        w_1, w_2 = self.split(t)
        # the two loads agree up to the split; the stiffer reading is not favoured
        force = 0.5 * (self.one.force(w_1) + self.two.force(w_2))
        return force, self.one.area(w_1), self.two.area(w_2), self.one.regime(w_1)


# ------------------------------------------------------------------------- size laws
@dataclass(frozen=True)
class Sizes:
    """A density of diameters on [lo, hi] with the points where quadratures must split."""

    density: Callable[[float], float]
    lo: float
    hi: float
    splits: tuple[float, ...] = ()
    atom: float | None = None
    """All particles of one diameter."""

    def mean(self, f: Callable[[float], float], splits: Iterable[float] = ()) -> float:
        """⟨f(x)⟩."""
        if self.atom is not None:
            return f(self.atom)
        inner = (x for x in (*self.splits, *splits) if self.lo < x < self.hi)
        return integrate(lambda x: f(x) * self.density(x), (self.lo, self.hi, *inner))


def truncated_gaussian(mean: float, std: float, n: float = 3.0, normalise: bool = True) -> Sizes:
    lo, hi = max(0.0, mean - n * std), mean + n * std
    mass = 1.0
    if normalise:
        mass = normal_above((lo - mean) / std) - normal_above((hi - mean) / std)
    return Sizes(
        lambda x: normal((x - mean) / std) / std / mass,
        lo,
        hi,
        tuple(mean + j * std for j in range(-8, 9)),
    )


def lognormal(median: float, gsd: float) -> Sizes:
    """Cut where the tail holds 1e-17, as the library says it does."""
    s = math.log(gsd)
    return Sizes(
        lambda x: normal(math.log(x / median) / s) / (s * x),
        median * math.exp(-8.5 * s),
        median * math.exp((8.5 + 2 * s) * s),
        tuple(median * math.exp(0.75 * j * s) for j in range(-10, 13)),
    )


def weibull(scale: float, shape: float) -> Sizes:
    def density(x: float) -> float:
        t = x / scale
        return shape / scale * t ** (shape - 1) * math.exp(-(t**shape))

    levels = (1e-12, 1e-8, 1e-5, 1e-3, 0.03, 0.2, 0.5, 1, 2, 4, 8, 16, 30)
    return Sizes(
        density,
        1e-12 * scale,
        scale * 45 ** (1 / shape),
        tuple(scale * v ** (1 / shape) for v in levels),
    )


def uniform(low: float, high: float) -> Sizes:
    return Sizes(lambda x: 1 / (high - low), low, high)


def monodisperse(x: float) -> Sizes:
    return Sizes(lambda _: 0.0, x, x, atom=x)


# ------------------------------------------------------------------------- model (b)
@dataclass(frozen=True)
class Interface:
    """Everything a state depends on."""

    first: Body = STEEL
    second: Body = STEEL
    rough: Rough = field(default_factory=lambda: Rough(1e-7, 2.8e-6))
    asperity_rule: str = "log"
    k: float = 0.4
    rho: float = 54.0

    @property
    def E_ss(self) -> float:
        return contact_modulus(self.first, self.second)

    @property
    def tip(self) -> Tip:
        H = min(self.first.H, self.second.H)
        return Tip(self.rough.R, self.E_ss, H, self.asperity_rule, self.k, self.rho)


@dataclass(frozen=True)
class Series:
    """The consistent model; lengths in m (``zeta_mean``, ``zeta_std`` too)."""

    particle: Body
    sizes: Sizes
    density: float
    seat: str = "plane"
    h_0: float = 0.0
    zeta_mean: float = 0.0
    zeta_std: float = 0.0
    shadow: str = "footprint"
    rule: str = "hermite"
    k: float = 0.4
    rho: float = 54.0


def squeezed(interface: Interface, law: Series) -> Squeezed:
    sides = (
        Tip(
            0.5,
            contact_modulus(surface, law.particle),
            min(surface.H, law.particle.H),
            law.rule,
            law.k,
            law.rho,
            cap=True,
        )
        for surface in (interface.first, interface.second)
    )
    return Squeezed(*sides)


def kernel(pair: Squeezed) -> Callable[[float, int], float]:
    """Column j of (f, a_e, a_ep, a_p, a_2, max(a_1, a_2)) over x² as function of t."""

    @lru_cache(maxsize=200_000)
    def values(t: float) -> tuple[float, ...]:
        f, a_1, a_2, regime = pair.response(t)
        parts = [a_1 if regime == j else 0.0 for j in range(3)]
        return (f, *parts, a_2, max(a_1, a_2))

    return lambda t, j: values(t)[j]


def area_crossings(pair: Squeezed) -> list[float]:
    """t where a_1 − a_2 changes sign: kinks of the larger footprint."""

    def difference(t: float) -> float:
        _, a_1, a_2, _ = pair.response(t)
        return a_1 - a_2

    steps = [0.0]
    kinks = [0.0, *sorted(set(pair.kinks))]
    for a, b in zip(kinks, kinks[1:], strict=False):
        steps += [a + (b - a) * j / 6 for j in range(1, 7)]
    out = []
    for a, b in zip(steps[1:], steps[2:], strict=False):
        u, v = difference(a), difference(b)
        if u * v < 0 and min(abs(u), abs(v)) > 1e-13:
            out.append(brentq(difference, a, b, xtol=1e-15))
    return out


def particle_sums(d: float, interface: Interface, law: Series) -> dict[str, float]:
    """F_sa [Pa], A_e, A_ep, A_p on surface 1, A_sa2 and the shadow, per nominal area."""
    pair = squeezed(interface, law)
    column = kernel(pair)
    kinks = [t for t in (*pair.kinks, *area_crossings(pair)) if t > 0]
    names = ("F_sa", "A_e", "A_ep", "A_p", "A_sa2", "footprint")
    if law.seat == "rough":
        sums = _rough_sums(d + interface.rough.y_s, law, pair, column, kinks)
    else:
        gap = d - (law.h_0 if law.seat == "offset" else 0.0)
        sums = _plane_sums(gap, law, column, kinks)
    *values, projected = sums
    out = {name: law.density * value for name, value in zip(names, values, strict=True)}
    footprint = out.pop("footprint")
    out["shadow"] = {
        "footprint": footprint,
        "projected": law.density * projected,
        "covered": law.density * math.pi / 4 * law.sizes.mean(lambda x: x * x),
        "none": 0.0,
    }[law.shadow]
    return out


def _plane_sums(gap: float, law: Series, column, kinks: list[float]) -> list[float]:
    sizes = law.sizes
    # t = 1 − gap/x; a negative gap means t > 1 for every size
    splits = [gap / (1 - t) for t in kinks if abs(1 - t) > 1e-9 and gap / (1 - t) > 0]
    if gap > 0:
        # f starts like δ^(3/2): crowd the panels there
        splits += [gap * (1 + 10.0**-j) for j in range(1, 9)] + [gap]
    out = []
    for j in range(6):

        def one(x: float, j: int = j) -> float:
            return x * x * column(1 - gap / x, j) if x > max(gap, 0.0) else 0.0

        out.append(sizes.mean(one, splits))
    out.append(sizes.mean(lambda x: math.pi / 4 * x * x if x > gap else 0.0, splits))
    return out


def _rough_sums(h: float, law: Series, pair: Squeezed, column, kinks: list[float]) -> list[float]:
    """∫dt k(t) ∫dx x³ φ_a(x) p_ζ(h − x + x t), and the saturated rest beyond t = end by erfc."""
    sizes, m, s = law.sizes, law.zeta_mean, law.zeta_std
    end = pair.end

    def weight(t: float) -> float:
        # where, in x, the seat density has its peak and its shoulders
        slope = 1 - t
        marks = []
        if abs(slope) > 1e-6:
            marks = [(h - m + j * s) / slope for j in (-9, -6, -3, -1.5, 0, 1.5, 3, 6, 9)]
        return sizes.mean(lambda x: x**3 * normal((h - x + x * t - m) / s) / s, marks)

    weight = lru_cache(maxsize=100_000)(weight)
    edges = {0.0, end, *(t for t in kinks if t < end)}
    edges |= {min(kinks) * 10.0**-j for j in range(1, 4)}
    # the seat density in t at the largest size
    for x in (sizes.lo, 0.5 * (sizes.lo + sizes.hi), sizes.hi):
        if x > 0:
            edges |= {t for j in range(-8, 9, 2) if 0 < (t := 1 + (m + j * s - h) / x) < end}
    out = []
    for j in range(6):
        # v = √t makes the start smooth
        roots = [math.sqrt(t) for t in edges]
        body = integrate(lambda v, j=j: 2 * v * column(v * v, j) * weight(v * v), roots)
        slope = 1 - end
        marks = [(h - m + i * s) / slope for i in (-6, -3, 0, 3, 6)] if abs(slope) > 1e-6 else []
        rest = column(1.5 * end + 1, j) * sizes.mean(
            lambda x: x * x * normal_above((h - x + end * x - m) / s), marks
        )
        out.append(body + rest)
    marks = [h - m + i * s for i in (-6, -3, 0, 3, 6)]
    out.append(sizes.mean(lambda x: math.pi / 4 * x * x * normal_above((h - x - m) / s), marks))
    return out


def series_state(d: float, interface: Interface, law: Series | None) -> dict[str, float]:
    """The library's fields at a given separation."""
    asperities = asperity_sums(d, interface.rough, interface.tip)
    nothing = dict.fromkeys(("F_sa", "A_e", "A_ep", "A_p", "A_sa2", "shadow"), 0.0)
    particles = nothing if law is None else particle_sums(d, interface, law)
    return _combine(asperities, particles, interface.E_ss)


def _combine(
    asperities: dict[str, float], particles: dict[str, float], E_ss: float
) -> dict[str, float]:
    free = max(0.0, 1 - particles["shadow"])
    F_ss, F_sa = free * asperities["F"], particles["F_sa"]
    A_ss = free * (asperities["A_e"] + asperities["A_ep"] + asperities["A_p"])
    A_sa = particles["A_e"] + particles["A_ep"] + particles["A_p"]
    return {
        "F_star": (F_ss + F_sa) / E_ss,
        "F_ss_star": F_ss / E_ss,
        "F_sa_star": F_sa / E_ss,
        "A_t": A_ss + A_sa,
        "A_ss": A_ss,
        "A_sa": A_sa,
        "A_sa2": particles["A_sa2"],
        "A_e": free * asperities["A_e"] + particles["A_e"],
        "A_ep": free * asperities["A_ep"] + particles["A_ep"],
        "A_p": free * asperities["A_p"] + particles["A_p"],
        "shadow": particles["shadow"],
    }


# ------------------------------------------------------------------------- model (a)
@dataclass(frozen=True)
class Horng:
    """The paper's model with its switches; h_e in m, datum in units of σ."""

    particle: Body
    sizes: Sizes
    density: float
    mean: float
    h_e: float
    weight: str = "x2"
    plastic: bool = True
    plastic_weight: str = "x2"
    second_modulus: str = "ss"
    kappa_C: float = 1.0
    chi: float = 1.0
    shadow: str = "d"
    hardness_rule: str = "surface"
    particle_regime: str = "plastic"
    datum: float = 1.0


def horng_bracket(interface: Interface, law: Horng, first: float, second: float) -> float:
    """C = (9π²/4)(H_1²/E_1² + H_2²/E_2²)."""
    E_1 = law.kappa_C * contact_modulus(interface.first, law.particle)
    other = law.particle if law.second_modulus == "sa" else interface.first
    E_2 = law.kappa_C * contact_modulus(interface.second, other)
    return 9 * math.pi**2 / 4 * ((first / E_1) ** 2 + (second / E_2) ** 2)


def horng_hardness(interface: Interface, law: Horng) -> tuple[float, float]:
    """H_s1 and H_s2 as the hardness rule reads them."""
    H_1, H_2, H_a = interface.first.H, interface.second.H, law.particle.H
    if law.hardness_rule == "softer":
        return min(H_1, H_a), min(H_2, H_a)
    return H_1, H_a if law.hardness_rule == "replace2" else H_2


def horng_state(d: float, interface: Interface, law: Horng) -> dict[str, float]:
    """The library's fields for the printed model; A_sa is surface 1's area."""
    H_1, H_2 = horng_hardness(interface, law)
    H_a = law.particle.H
    C = horng_bracket(interface, law, H_1, H_2)
    sizes = law.sizes

    def between(f: Callable[[float], float], a: float, b: float) -> float:
        a, b = max(a, sizes.lo), min(b, sizes.hi)
        if b <= a:
            return 0.0
        inner = [x for x in sizes.splits if a < x < b]
        return integrate(lambda x: f(x) * sizes.density(x), (a, b, *inner))

    def w(x: float) -> float:
        return x * x if law.weight == "x2" else law.mean**2

    def w_p(x: float) -> float:
        return x * (x - d) if law.plastic_weight == "xxd" else w(x)

    window = C * between(w, d - law.h_e, d)
    plastic = between(w_p, d, math.inf) if law.plastic else 0.0
    density = law.chi * law.density
    if law.hardness_rule == "sum":
        share, pressure = H_a / (H_1 + H_a), H_1 + H_a
    else:
        share, pressure = H_2 / (H_1 + H_2), H_1
    area = math.pi * density * share
    start = {"d": d, "xmin": -math.inf, "none": math.inf}[law.shadow]
    surfaces = H_1 / (H_1 + H_2)
    # only plastic particles shade, each by its own footprint
    shade = w_p if law.shadow == "d" else w
    shadow = math.pi * density * surfaces * between(shade, start, math.inf) if law.plastic else 0.0
    asperities = asperity_sums(d, interface.rough, interface.tip, law.datum * interface.rough.sigma)
    split = law.particle_regime == "split"
    particles = {
        "F_sa": pressure * area * (window + plastic),
        "A_e": area * window if split else 0.0,
        "A_ep": 0.0,
        "A_p": area * (plastic if split else window + plastic),
        "A_sa2": math.nan,
        "shadow": shadow,
    }
    return _combine(asperities, particles, interface.E_ss)


# ----------------------------------------------------------------------- equilibrium
def separation(load: Callable[[float], float], F: float, lo: float, hi: float) -> float:
    """d in [lo, hi] at which a falling load(d) equals F."""
    return brentq(
        lambda d: math.log(max(load(d), TINY)) - math.log(F), lo, hi, xtol=1e-20, rtol=1e-14
    )
