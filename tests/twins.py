"""Contacts of the library, each with its twin in the oracle, and ways to draw them at random."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import oracle
from hypothesis import strategies as st

import thirdbody as tb

FIELDS = (
    "F_star",
    "F_ss_star",
    "F_sa_star",
    "A_t",
    "A_ss",
    "A_sa",
    "A_sa2",
    "A_e",
    "A_ep",
    "A_p",
    "shadow",
)


@dataclass(frozen=True)
class Twin:
    """One interface, said twice."""

    contact: tb.Contact
    interface: oracle.Interface
    law: oracle.Series | oracle.Horng | None
    d: float
    """A separation at which something happens [m]."""

    def expected(self, d: float | None = None) -> dict[str, float]:
        d = self.d if d is None else d
        if isinstance(self.law, oracle.Horng):
            return oracle.horng_state(d, self.interface, self.law)
        return oracle.series_state(d, self.interface, self.law)


def differences(
    state: Any, expected: dict[str, float], rtol: float = 1e-10, floor: float = 1e-12
) -> list[str]:
    """Fields that differ by more than ``rtol``, unless below ``floor`` of their total."""
    out = []
    for name, want in expected.items():
        got = getattr(state, name)
        if math.isnan(want):
            continue
        total = expected["F_star"] if name.startswith("F") else max(expected["A_t"], 1e-300)
        if not abs(got - want) <= rtol * abs(want) + floor * total * (abs(want) < floor * total):
            out.append(
                f"{name}: {got!r} is not {want!r} (ratio − 1 = {got / (want or 1e-300) - 1:.1e})"
            )
    return out


def agree(state: Any, expected: dict[str, float], **tolerances: float) -> None:
    wrong = differences(state, expected, **tolerances)
    assert not wrong, "\n".join(wrong)


# ----------------------------------------------------------------------------- building
def material(body: oracle.Body) -> tb.Material:
    return tb.Material(E=body.E, nu=body.nu, H=body.H)


def sizes(kind: str, mean: float, width: float, n: float = 3.0, *, normalise: bool = True):
    """A distribution of the library and its twin; ``width`` is relative."""
    if kind == "monodisperse":
        return tb.distributions.Monodisperse(mean=mean), oracle.monodisperse(mean)
    if kind == "lognormal":
        gsd = 1 + width
        return tb.LogNormal(median=mean, gsd=gsd), oracle.lognormal(mean, gsd)
    if kind == "weibull":
        shape = min(max(1.2 / width, 1.0), 30.0)
        return tb.distributions.Weibull(scale=mean, shape=shape), oracle.weibull(mean, shape)
    if kind == "uniform":
        low, high = mean * (1 - 0.9 * width), mean * (1 + 0.9 * width)
        return tb.distributions.Uniform(low=low, high=high), oracle.uniform(low, high)
    std = width * mean
    return (
        tb.TruncatedGaussian(mean=mean, std=std, n=n),
        oracle.truncated_gaussian(mean, std, n, normalise),
    )


def base(
    interface: oracle.Interface, particles: tb.Particles | None = None, particle_law: Any = None
) -> tb.Contact:
    rough = interface.rough
    law = tb.asperity.ZMC if interface.asperity_rule == "log" else tb.asperity.Hermite
    return tb.Contact(
        surfaces=tb.MaterialPair(material(interface.first), material(interface.second)),
        roughness=tb.Roughness(
            sigma=rough.sigma, R=rough.R, alpha=rough.alpha, eta_R_sigma=rough.eta_R_sigma
        ),
        asperity_law=law(k=interface.k, rho=interface.rho),
        particles=particles,
        particle_law=particle_law,
    )


def series_twin(
    interface: oracle.Interface,
    particle: oracle.Body,
    distributions: tuple[tb.distributions.Distribution, oracle.Sizes],
    density: float,
    d: float,
    *,
    seat: str = "plane",
    h_0: float = 0.0,
    zeta_mean: float = 0.0,
    zeta_std: float = 1.0,
    shadow: str = "footprint",
    rule: str = "hermite",
) -> Twin:
    """``zeta_mean`` and ``zeta_std`` in units of σ."""
    sigma = interface.rough.sigma
    options: dict[str, Any] = {"soft": "sphere", "seat": seat, "shadow": shadow}
    if seat == "offset":
        options["h_0"] = h_0
    if seat == "rough":
        options |= {"zeta_mean": zeta_mean, "zeta_std": zeta_std}
    options["law"] = tb.asperity.Hermite() if rule == "hermite" else tb.asperity.ZMC()
    contact = base(
        interface,
        tb.Particles(material=material(particle), diameter=distributions[0], areal_density=density),
        tb.particle.Series(deep="off", **options),
    )
    law = oracle.Series(
        particle,
        distributions[1],
        density,
        seat,
        h_0,
        zeta_mean * sigma,
        zeta_std * sigma,
        shadow,
        rule,
    )
    return Twin(contact, interface, law, d)


# ------------------------------------------------------------------------------ drawing
def decades(low: float, high: float) -> st.SearchStrategy[float]:
    """Log-uniform numbers."""
    return st.floats(math.log(low), math.log(high)).map(math.exp)


bodies = st.builds(
    lambda E, nu, ratio: oracle.Body(E, nu, ratio * E),
    decades(5e9, 5e11),
    st.floats(0.0, 0.45),
    decades(3e-3, 0.08),
)


@st.composite
def roughnesses(draw) -> oracle.Rough:
    sigma = draw(decades(1e-8, 2e-6))
    return oracle.Rough(
        sigma,
        sigma * draw(decades(4, 400)),
        draw(st.floats(1.6, 60.0)),
        draw(decades(0.01, 0.1)),
    )


@st.composite
def interfaces(draw, same: bool | None = None) -> oracle.Interface:
    first = draw(bodies)
    equal = draw(st.booleans()) if same is None else same
    return oracle.Interface(
        first,
        first if equal else draw(bodies),
        draw(roughnesses()),
        draw(st.sampled_from(("log", "hermite"))),
        draw(st.floats(0.3, 0.5)),
        draw(decades(20, 100)),
    )


@st.composite
def series_twins(draw, seats=("plane", "offset", "rough"), kinds=None) -> Twin:
    interface = draw(interfaces())
    sigma = interface.rough.sigma
    mean = sigma * draw(decades(0.3, 12))
    kind = draw(
        st.sampled_from(
            kinds or ("gaussian", "monodisperse", "lognormal", "weibull", "uniform", "gaussian")
        )
    )
    width = draw(decades(0.02, 0.6))
    distributions = sizes(kind, mean, width, draw(st.floats(1.0, 4.0)))
    second_moment = distributions[0].moment(2)
    density = draw(decades(1e-6, 0.2)) / (math.pi / 4 * second_moment)
    seat = draw(st.sampled_from(seats))
    h_0 = sigma * draw(st.floats(0.1, 4.0)) if seat == "offset" else 0.0
    # a size inside the population, squeezed by a fraction of itself
    x = float(distributions[0].ppf(np.float64(draw(st.floats(0.02, 0.98)))))
    zeta_mean = draw(st.floats(-1.0, 1.0)) if seat == "rough" else 0.0
    zeta_std = draw(st.floats(0.3, 1.5)) if seat == "rough" else 1.0
    level = h_0
    if seat == "rough":
        level = (zeta_mean + zeta_std * draw(st.floats(-1.5, 4.0))) * sigma - interface.rough.y_s
    d = level + x * (1 - draw(decades(1e-4, 1.1)))
    return series_twin(
        interface,
        draw(bodies),
        distributions,
        density,
        d,
        seat=seat,
        h_0=h_0,
        zeta_mean=zeta_mean,
        zeta_std=zeta_std,
        shadow=draw(st.sampled_from(("footprint", "projected", "covered", "none"))),
        rule=draw(st.sampled_from(("hermite", "log"))),
    )


@st.composite
def horng_twins(draw) -> Twin:
    """All switches of the printed model."""
    interface = draw(interfaces())
    sigma = interface.rough.sigma
    mean = sigma * draw(decades(0.5, 12))
    normalise = draw(st.booleans())
    distributions = sizes(
        "gaussian", mean, draw(decades(0.02, 0.6)), draw(st.floats(1.0, 4.0)), normalise=normalise
    )
    coverage = draw(decades(1e-6, 0.05))
    density = coverage / (math.pi / 4 * distributions[0].moment(2))
    particle = draw(bodies)
    switches = {
        "weight": draw(st.sampled_from(("x2", "xa2"))),
        "plastic": draw(st.booleans()),
        "plastic_weight": draw(st.sampled_from(("x2", "xxd"))),
        "second_modulus": draw(st.sampled_from(("ss", "sa"))),
        "kappa_C": draw(st.sampled_from((1, 2))),
        "chi": draw(decades(1e-3, 1.0)),
        "shadow": draw(st.sampled_from(("d", "xmin", "none"))),
        "hardness_rule": draw(st.sampled_from(("surface", "softer", "replace2", "sum"))),
        "particle_regime": draw(st.sampled_from(("plastic", "split"))),
        "datum": draw(st.floats(-0.5, 1.5)),
    }
    if switches["shadow"] == "xmin":
        # Eq. (1) as printed: its area factor goes with the printed plastic term only
        switches |= {"plastic": True, "plastic_weight": "x2"}
    rule = draw(st.sampled_from(("level", "approach")))
    approach = {"h_e_rule": rule}
    if rule == "level":
        approach |= {
            "h_e_sigma": draw(st.floats(0.1, 4.0)),
            "h_e_diameter": draw(st.floats(0.0, 1.0)),
        }
    contact = base(
        interface,
        tb.Particles(material=material(particle), diameter=distributions[0], areal_density=density),
        tb.particle.Horng2022(preset="published", normalise=normalise, **switches, **approach),
    )
    law = oracle.Horng(particle, distributions[1], density, mean, 0.0, **switches)
    if rule == "level":
        h_e = approach["h_e_sigma"] * sigma + approach["h_e_diameter"] * mean
    else:
        hard = oracle.horng_hardness(interface, law)
        h_e = oracle.horng_bracket(interface, law, *hard) * mean / 2
    law = oracle.replace(law, h_e=h_e)
    x = float(distributions[0].ppf(np.float64(draw(st.floats(0.0, 1.0)))))
    return Twin(contact, interface, law, x + draw(st.floats(0.0, 1.0)) * h_e)
