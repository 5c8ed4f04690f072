"""What is pressed: the surfaces, materials, sizes, densities and seats of the comparison."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import thirdbody as tb

from ...explicit import (
    DownhillSeats,
    HighestSeats,
    SettledSeats,
    SphereSeats,
    SummitSeats,
    ValleySeats,
)
from ..seats import contact as stored_contact
from .bump import BumpLaw

__all__ = ["CASES", "GROUPS", "SIGMA", "Case"]

SIGMA = 300e-9
"""RMS height of every surface [m]."""
NU = 0.3
GROUPS = {
    "sizes": "Size over roughness",
    "bumps": "The same, with the law of a resolved bump",
    "spectra": "Spectrum of the roughness",
    "materials": "Hardness",
    "hard": "Hardness over what flattens slopes, χ = H/(E*g), x/σ = 1",
    "mixtures": "Sizes spread log-normally",
    "debris": "Debris wider than summits",
    "densities": "Particles per area",
    "seats": "Seats",
    "loads": "Large loads",
}
"""What varies, in the order of the page."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """One row of the comparison: a contact, and where its particles lie."""

    name: str
    group: str
    words: str
    contact: tb.Contact
    seats: Any = "random"
    loads: tuple[float, ...] = ()
    """F* in the place of those of all [1]."""

    @property
    def diameter(self) -> float:
        """Mean diameter [m]."""
        return float(self.contact.populations[0].diameter.mean_diameter)


def _contact(
    over_sigma: float,
    *,
    density: float = 1e11,
    alpha: float = 5.0,
    H: tuple[float, float] | None = None,
    sizes: tb.distributions.Distribution | None = None,
    law: object = None,
    harder: float = 4.0,
) -> tb.Contact:
    """The interface of the stored runs, with other numbers.

    Particles of a surface whose hardness is given are so many times ``harder``.
    """
    base = stored_contact(over_sigma * SIGMA)
    body = base.surfaces.first
    surfaces = base.surfaces
    particles = base.particles
    assert isinstance(particles, tb.Particles)
    material = particles.material
    if H is not None:
        surfaces = tb.MaterialPair(body.replace(H=H[0]), body.replace(H=H[1]))
        material = body.replace(H=harder * max(H))
    rough = base.roughness
    if alpha != 5.0:
        # asperities of a Gaussian surface, Nayak 1971
        rough = tb.Roughness(
            sigma=SIGMA, R=rough.R, alpha=alpha,
            eta_R_sigma=0.375 * math.sqrt(math.pi * alpha) / (6 * math.pi * math.sqrt(3)),
        )  # fmt: skip
    return base.replace(
        surfaces=surfaces,
        roughness=rough,
        particles=particles.replace(
            material=material,
            areal_density=density,
            diameter=particles.diameter if sizes is None else sizes,
        ),
        particle_law=law or base.particle_law,
    )


def _hard(chi: float, alpha: float = 5.0, over_sigma: float = 1.0, **other: Any) -> tb.Contact:
    """Surfaces of the hardness χE*g."""
    plain = _contact(over_sigma, alpha=alpha)
    H = chi * plain.E_ss * plain.roughness.slope
    return _contact(over_sigma, alpha=alpha, H=(H, H), **other)


def _name_of(over_sigma: float) -> str:
    return f"x/σ = {over_sigma:.2g}"


def _cases() -> tuple[Case, ...]:
    out = []

    def add(
        name: str, group: str, words: str, contact: tb.Contact, seats: object = "random"
    ) -> None:
        out.append(Case(name=name, group=group, words=words, contact=contact, seats=seats))

    sizes = {"2": 2.0, "1": 1.0, "067": 2 / 3}
    for key, x in sizes.items():
        add(f"x{key}", "sizes", _name_of(x), _contact(x))
    for key, x in sizes.items():
        add(f"bump{key}", "bumps", _name_of(x), _contact(x, law=BumpLaw()))
    for alpha in (4.0, 15.0):
        for x in (2.0, 1.0):
            words = f"α = {alpha:g}, {_name_of(x)}"
            add(f"alpha{alpha:g}_x{x:g}", "spectra", words, _contact(x, alpha=alpha))
    soft = 0.018 * stored_contact(SIGMA).E_ss
    for x in (2.0, 1.0):
        words = f"soft, H/E* = 0.018, {_name_of(x)}"
        add(f"soft_x{x:g}", "materials", words, _contact(x, H=(soft, soft)))
    for x in (2.0, 1.0):
        words = f"one body twice as hard, {_name_of(x)}"
        add(f"unequal_x{x:g}", "materials", words, _contact(x, H=(5e9, 10e9)))
    for gsd in (1.3, 1.6):
        spread = tb.LogNormal(median=SIGMA, gsd=gsd)
        words = f"median x/σ = 1, σ_g = {gsd:g}"
        add(f"spread{gsd:g}", "mixtures", words, _contact(1.0, sizes=spread))
    for power, words in ((9, "10⁹ m⁻²"), (10, "10¹⁰ m⁻²"), (12, "10¹² m⁻²")):
        dense = _contact(2.0, density=10.0**power)
        add(f"density{power}", "densities", f"{words}, {_name_of(2)}", dense)
    add("density12_x1", "densities", f"10¹² m⁻², {_name_of(1)}", _contact(1.0, density=1e12))
    seats: tuple[tuple[str, str, object], ...] = (
        ("settled", "lowest of 5 spots in 0.5 µm", SettledSeats()),
        ("settled_wide", "lowest of 5 spots in 1.5 µm", SettledSeats(within=1.5e-6)),
        ("downhill", "1 µm downhill", DownhillSeats()),
        ("valleys", "at the end of the way down", ValleySeats()),
        ("highest", "highest of 5 spots in 1.5 µm", HighestSeats()),
        ("sphere", "as a sphere rests", SphereSeats()),
    )
    for name, words, rule in seats:
        add(name, "seats", f"{words}, {_name_of(2)}", _contact(2.0), rule)
    add("summits", "seats", f"a summit each, 2×10¹⁰ m⁻², {_name_of(1)}",
        _contact(1.0, density=2e10), SummitSeats())  # fmt: skip
    for name, words, case in (
        ("large", _name_of(1), _contact(1.0)),
        ("large_soft", f"soft, H/E* = 0.018, {_name_of(1)}", _contact(1.0, H=(soft, soft))),
    ):
        out.append(Case(name=name, group="loads", words=words, contact=case, loads=LARGE))
    out += _crowded_cases()
    return tuple(out)


def _crowded_cases() -> list[Case]:
    """Surfaces hard against their slopes, and soft debris, at real areas of 0.002 to 0.25."""
    out = [
        Case(name=f"chi{chi:g}_alpha{alpha:g}", group="hard", words=f"χ = {chi:g}, α = {alpha:g}",
             contact=_hard(chi, alpha), loads=CROWDED)
        for chi, alpha in ((0.4, 5.0), (0.7, 5.0), (0.4, 3.0), (0.4, 15.0))
    ]  # fmt: skip
    sizes = tb.LogNormal(median=5 * SIGMA, gsd=1.5)
    wide = _hard(0.6, over_sigma=5.0, sizes=sizes, density=3e9, harder=0.5)
    words = "χ = 0.6, half as hard, median x/σ = 5, σ_g = 1.5, 3×10⁹ m⁻²"
    out.append(Case(name="debris", group="debris", words=words, contact=wide, loads=CROWDED[:2]))
    return out


LARGE = (2e-3, 4e-3, 8e-3)
CROWDED = (4e-4, 4e-3, 1.6e-2)
CASES = _cases()
"""Every row."""
