"""What breaks, what sinks whole, and the fragments that bear."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ..contact.output import AbstractOutput, Column
from ..errors import Advice, Mistake
from ..laws.particle.breakage import Breakage, crush_embed_size
from ..quantities.value import quantity
from .quantiles import Values, exceeded_values

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..contact.contact import Contact
    from ..contact.evaluation import Solved
    from ..laws.spots import ParticleSpots

    Array = NDArray[np.float64]

__all__ = ["Crushing"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Crushing(AbstractOutput):
    r"""Share of particles that have broken, and what bears the load after that.

    .. math:: \text{broken} = \frac{\int_g\varphi_a(1-P_s)\,dx}{\int_g\varphi_a\,dx}, \qquad
              x^* = x_0\left(\frac{\hat\sigma_{max}}{\sigma_0}\right)^{-1/b}

    Particles are counted where they are larger than the gap under them. Above x* they break
    (63 %) before the surfaces swallow them, below it they sink whole.

    Parameters
    ----------
    A_n : float, optional
        Nominal area of which the largest bearing piece is asked [m²]: the size that the largest
        one in A_n exceeds in half of all cases, :math:`A_n N(>x)=\ln 2`.

    Notes
    -----
    Several populations count together; x* is that of the first one with a strength. Sizes are read
    from counts at 240 levels, within 2 %.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, quartz = tb.materials["S45C"], tb.materials["quartz"]
    >>> dust = tb.Particles(material=quartz, areal_density=1e7,
    ...                     diameter=tb.TruncatedGaussian(mean=10e-6, std=2e-6),
    ...                     strength=tb.grains.WeibullStrength.of(quartz))
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     particles=dust,
    ...     particle_law=tb.particle.Series(seat="plane"),
    ...     roughness=tb.Roughness(sigma=1e-6, R=50e-6),
    ...     outputs=tb.outputs.Crushing(),
    ... )
    >>> found = tb.solve(contact, d=2e-6).outputs
    >>> f"{100 * found['broken_share']:.0f} % broken, x* = {found['x_star'] * 1e6:.1f} µm"
    '53 % broken, x* = 11.7 µm'
    """

    A_n: float = quantity(
        "A_n", "m^2", "area of which the largest piece is", default=1e-6, gt=0,
        hint="1 mm² is 1e-6",
    )  # fmt: skip

    name = "crushing"
    title = "Crushing"
    year = 2026
    citation = "thirdbody: particles that break between the surfaces of a solved state"
    provenance = "derived"
    valid_range = "gaps that only close; pieces that break independently"
    columns = {
        "broken_share": Column("n_b/n", "1", "broken part of the caught particles, by number"),
        "broken_mass_share": Column("m_b/m", "1", "broken part of the caught particles, by mass"),
        "x_star": Column("x*", "m", "size above which particles break, below it sink whole"),
        "fragment_size": Column("x_50", "m", "mass median of the fragments that bear"),
        "n_bearing": Column("n_p", "1/m^2", "whole particles and fragments that bear"),
        "survivor_max": Column("x_max", "m", "largest bearing particle or piece of A_n (median)"),
        "load_if_whole": Column("F_w/F", "1", "load of particles if none broke, over theirs"),
    }

    def one_by_one(self, contact: Contact) -> bool:
        return False  # of particles alone

    def problems(self, contact: Contact) -> list[str]:
        if any(population.strength is not None for population in contact.populations):
            return []
        return [
            self.problem(
                "needs particles with a strength, e.g. "
                + Advice(
                    "Particles(..., strength=WeibullStrength.of(material))",
                    'strength = "material" in [particles]',
                ),
                code=Mistake.MISSING,
            )
        ]

    def of(self, state: Solved) -> dict[str, Array]:
        nothing = np.zeros_like(state.d)
        sums = dict.fromkeys(
            (
                "caught",
                "broken",
                "mass",
                "broken mass",
                "pieces",
                "bearing",
                "borne",
                "load",
                "whole",
            ),
            nothing,
        )
        sizes, fragments = [], []
        for spots in state.particles:
            bears = spots.load > 0
            counted = replace(spots, layout=None)  # sizes do not change as a gap closes
            was, survival = _numbers_before(spots)
            broken = bears * was * (1 - survival)
            number = np.where(spots.number > 0, spots.number, 1.0)
            piece = bears * np.clip(1 - was * survival / number, 0.0, 1.0)
            piece = np.where(piece > ROUNDING, piece, 0.0)
            mass = spots.x**3
            for name, q in (
                ("caught", bears * was),
                ("broken", broken),
                ("mass", bears * was * mass),
                ("broken mass", broken * mass),
                ("pieces", piece * spots.number * mass),
                ("bearing", bears * spots.number),
                ("borne", bears * spots.number * mass),
                ("load", spots.load * spots.number),
                ("whole", spots.load * was),
            ):
                total = np.sum(q, axis=-1)
                sums[name] = sums[name] + (total if spots.share is None else spots.share @ total)
            sizes.append(Values(counted, bears * spots.x, bears.astype(float)))
            fragments.append(Values(counted, (piece > 0) * spots.x, piece * mass))
        pieces = sums["pieces"] > ROUNDING * sums["borne"]
        (median,) = exceeded_values(fragments, [0.5 * sums["pieces"]])
        (largest,) = exceeded_values(sizes, [nothing + math.log(2) / self.A_n])
        with np.errstate(invalid="ignore", divide="ignore"):
            return {
                "broken_share": sums["broken"] / sums["caught"],
                "broken_mass_share": sums["broken mass"] / sums["mass"],
                "x_star": nothing + _x_star(state.contact),
                "fragment_size": np.where(pieces, median, np.nan),
                "n_bearing": sums["bearing"],
                # less than one bears in most areas: no largest one has a median
                "survivor_max": np.where(largest > 0, largest, np.nan),
                "load_if_whole": sums["whole"] / sums["load"],
            }


ROUNDING = 1e-12
"""Part of the pieces of a size that is rounding where all are whole particles."""


def _numbers_before(spots: ParticleSpots) -> tuple[Array, Array]:
    """Numbers before any broke, and P_s."""
    if spots.parents is None or spots.survival is None:
        return spots.number, np.ones_like(spots.number)
    return spots.parents, spots.survival


def _x_star(contact: Contact) -> float:
    """x* of the first population with a strength [m]."""
    population = next(
        population for population in contact.populations if population.strength is not None
    )
    assert population.strength is not None
    one = contact.law_of(population).one(surfaces=contact.surfaces, particle=population.material)
    scale = population.strength.x_0
    return scale * crush_embed_size(
        one, Breakage.of_material(population.strength, population.material, scale)
    )
