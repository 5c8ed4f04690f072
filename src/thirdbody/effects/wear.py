"""What sliding takes away: adhesive wear, grooves, and tracks of rolling particles."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..contact.field_sums import FieldSpots
from ..contact.output import AbstractOutput, Column
from ..errors import InvalidValue, Mistake, Note
from ..laws.base import REGIMES
from ..quantities.say import value_of
from ..quantities.value import quantity
from .single.ploughing import groove_of
from .single.severity import severity, threshold

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from ..contact.contact import Contact
    from ..contact.evaluation import Solved
    from ..contact.output import Probe
    from ..laws.spots import ParticleSpots
    from ..populations.particles import Particles
    from .friction import Friction

    Array = NDArray[np.float64]

__all__ = ["Wear"]

NONE = 1e-12
"""Share of the pressure that counts as no particle at all."""


F_ROLL = (
    "needs f_roll, the broken-off part of the tracks of rolling particles [1]: some particles of "
    "this contact roll"
)


def _all_roll(friction: Friction, contact: Contact, population: Particles) -> bool:
    """Whether the particles of a population roll however they are squeezed."""
    law, surfaces = contact.law_of(population), contact.surfaces
    spots = law.probe(np.geomspace(1e-6, 0.5, 40), surfaces=surfaces, particle=population.material)
    spots = replace(spots, material=population.material, population=population)
    return bool(np.all(friction.motion(spots).rolls | (spots.load <= 0)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Wear(AbstractOutput):
    r"""Worn volume per area and sliding length, by cause and by surface.

    .. math:: \frac{dV}{A_n dL} = \sum_{ss} n K a + \sum_{\text{slides}} n\,(K a_i + f_{ab} A_{g,i})
              + \tfrac12 f_{roll} \sum_{\text{rolls}} n\,(A_{g,1}+A_{g,2})

    K a is Archard's law resolved by the regime of the contact; with one K for all and p = H it is
    K F/H. A particle that slides wears the surface i it slides over: a groove of the cross-section
    A_g, of which f_ab is removed. A rolling one leaves half a track in each surface, of which
    f_roll breaks off. Asperities wear the softer surface, equal ones both alike. Whether a
    particle slides, and where, is the verdict of the output `Friction`, which must stand beside.

    Parameters
    ----------
    K_ss : float
        Wear coefficient of plastic asperity contacts [1]. No theory gives it: 1e-8 to 1e-2.
    K_ss_ep, K_ss_e : float, optional
        Of elastoplastic and elastic ones; 0 by default.
    K_sa : float, optional
        Of plastic contacts of sliding particles, besides their grooves [1]; needed with particles.
        0 where the grooves are all their wear.
    K_sa_ep, K_sa_e : float, optional
        Of elastoplastic and elastic ones.
    f_ab : float, optional
        Removed part of a groove, 0 to 1 [1]; needed with particles.
    f_roll : float, optional
        Broken-off part of the track of rolling particles [1]; needed where particles roll.
    renewal : float, optional
        Fresh particles per particle and sliding length [1/m]. Without it the state is frozen: the
        same particles slide in the same grooves, and the rates hold only until the grooves have
        covered the surface, over the length ``groove_length``.

    Notes
    -----
    K, f_ab and f_roll need calibration; the equivalent coefficient ``wear_K`` = V H/(F L), with
    the softer surface's H, is what a wear test gives. A wear coefficient from a test with
    particles contains their grooves: do not count them twice.

    Severity and ``severe_share`` are the empirical route beside (Trezona; Adachi and Hutchings):
    they do not enter the volumes unless ``Friction(rolling="severity")`` decides who rolls.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.effects import Friction
    >>> steel, soft = tb.materials["S45C"], tb.materials["S45C"].replace(H=2.5e9)
    >>> dust = tb.Particles(material=tb.materials["SiO2"], areal_density=1e10,
    ...                     diameter=tb.TruncatedGaussian(mean=500e-9, std=100e-9))
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, soft), particles=dust,
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     outputs=(Friction(tau_ss=580e6, tau_sa=200e6),
    ...              tb.outputs.Wear(K_ss=1e-5, K_sa=0.0, f_ab=0.1, f_roll=0.001, renewal=100.0)))
    >>> worn = tb.solve(contact, pressure=5e6).outputs
    >>> f"surface 1 {worn['wear_1']:.1e}, surface 2 {worn['wear_2']:.1e} m³ per m² and m"
    'surface 1 7.2e-06, surface 2 5.7e-09 m³ per m² and m'
    """

    K_ss: float = quantity("K_ss", "1", "wear coefficient of plastic asperity contacts", ge=0)
    K_ss_ep: float = quantity("K_ss,ep", "1", "that of elastoplastic ones", default=0.0, ge=0)
    K_ss_e: float = quantity("K_ss,e", "1", "that of elastic ones", default=0.0, ge=0)
    K_sa: float | None = quantity(
        "K_sa", "1", "wear coefficient of plastic contacts of particles", default=None, ge=0
    )
    K_sa_ep: float = quantity("K_sa,ep", "1", "that of elastoplastic ones", default=0.0, ge=0)
    K_sa_e: float = quantity("K_sa,e", "1", "that of elastic ones", default=0.0, ge=0)
    f_ab: float | None = quantity("f_ab", "1", "removed part of a groove", default=None, ge=0, le=1)
    f_roll: float | None = quantity(
        "f_roll", "1", "broken-off part of a rolling track", default=None, ge=0, le=1
    )
    renewal: float | None = quantity(
        "1/L_r", "1/m", "fresh particles per particle and sliding length", default=None, gt=0
    )

    name = "wear"
    title = "Wear"
    year = 2026
    citation = "thirdbody: Archard wear by regime, grooves and rolling tracks of a solved state"
    provenance = "derived"
    valid_range = "coefficients measured on the same materials; shapes that wear leaves as they are"
    needs = ("friction",)
    follows_sinks = True
    columns = {
        "wear": Column("V/(A_n L)", "1", "worn volume per area and sliding length"),
        "wear_1": Column("V_1", "1", "worn from surface 1"),
        "wear_2": Column("V_2", "1", "worn from surface 2"),
        "wear_ss": Column("V_ss", "1", "worn by asperities"),
        "wear_sa": Column("V_sa", "1", "worn by sliding particles, grooves apart"),
        "wear_groove": Column("V_g", "1", "removed from grooves of sliding particles"),
        "wear_roll": Column("V_r", "1", "broken off the tracks of rolling particles"),
        "wear_K": Column("K", "1", "equivalent wear coefficient V H/(F L)"),
        "groove_length": Column("L_g", "m", "sliding length that covers the surface with grooves"),
        "renewed": Column("n_r", "1/m^3", "fresh particles per area and sliding length"),
        "severity": Column("S", "1", "mean severity of the loaded particles"),
        "severe_share": Column("w_S", "1", "share of loaded particles above the threshold S*"),
    }

    def problems(self, contact: Contact) -> list[str]:
        if not contact.populations:
            return []
        needed = {
            "K_sa": "wear coefficient of the contacts of particles (0 where grooves are all)",
            "f_ab": "removed part of a groove, 0 to 1",
        }
        out: list[str] = [
            self.problem(
                f"needs {name}, the {what} [1]",
                hint="it depends on the materials, and no value fits all",
                code=Mistake.MISSING,
            )
            for name, what in needed.items()
            if getattr(self, name) is None
        ]
        friction: Any = next(
            (output for output in contact.outputs if output.name == "friction"), None
        )
        unknown = self.f_roll is None and friction is not None and not friction.problems(contact)
        if unknown and any(
            _all_roll(friction, contact, population) for population in contact.populations
        ):
            out.append(self.problem(F_ROLL, code=Mistake.MISSING))
        return out

    def _archard(self, kind: str, regime: NDArray[np.intp], area: Array) -> Array:
        """K a of the regime [m²]."""
        K = dict(zip(REGIMES, ("_e", "_ep", ""), strict=True))
        return (
            np.array([getattr(self, f"K_{kind}{K[name]}") or 0.0 for name in REGIMES])[regime]
            * area
        )

    def of_particles(
        self, spots: ParticleSpots, friction: Friction
    ) -> dict[str, tuple[Array, Array]]:
        """Volume per sliding length [m²] that one particle removes from each surface, by cause.

        Besides ``cut``, the width of its grooves or tracks [m], and ``rolls`` its load [N] if it
        rolls (first) or slides (second).
        """
        motion = friction.motion(spots)
        rolls = motion.rolls
        even = spots.even
        out: dict[str, list[Array]] = {"sa": [], "groove": [], "roll": [], "cut": []}
        for side, acts in enumerate(friction.indents(spots)):
            slides = np.where(even, 0.5, motion.side == side) * ~rolls
            groove = acts * groove_of(spots, side=side)
            touch = self._archard("sa", spots.regimes[side], spots.areas[side])
            b = np.sqrt(spots.areas[side] / np.pi)
            out["sa"].append(slides * touch)
            out["groove"].append(slides * (self.f_ab or 0.0) * groove)
            out["roll"].append(0.5 * rolls * (self.f_roll or 0.0) * groove)
            out["cut"].append(acts * 2 * b * (slides + 0.5 * rolls))
        volumes = {name: (values[0], values[1]) for name, values in out.items()}
        return volumes | {"rolls": (rolls * spots.load, ~rolls * spots.load)}

    def _worn_asperities(self, state: Solved) -> Array:
        """Sum Σ K a over the asperities [1]; for the law field by its areas."""
        if patches := [patch for patch in state.asperities if isinstance(patch, FieldSpots)]:
            kinds = np.arange(len(REGIMES))
            return sum(
                (self._archard("ss", kinds, patch.regimes).sum(axis=1) for patch in patches),
                np.zeros_like(state.d),
            )
        return state.total(lambda spots: self._archard("ss", spots.regime, spots.area))

    def one_by_one(self, contact: Contact) -> bool:
        return False  # what asperities wear goes by areas

    def of(self, state: Solved) -> dict[str, Array]:
        friction: Friction = state.output("friction")
        surfaces = state.contact.surfaces
        nothing = np.zeros_like(state.d)
        volume = {
            name: [nothing, nothing] for name in ("ss", "sa", "groove", "roll", "cut", "rolls")
        }
        worn = self._worn_asperities(state)
        H = (surfaces.first.H, surfaces.second.H)
        shares = (0.5, 0.5) if H[0] == H[1] else (float(H[0] < H[1]), float(H[0] > H[1]))
        volume["ss"] = [share * worn for share in shares]
        loaded, S, severe = nothing, nothing, nothing
        for spots in state.particles:
            for name, sides in self.of_particles(spots, friction).items():
                for side, spot_volume in enumerate(sides):
                    volume[name][side] = volume[name][side] + spots.total(spot_volume)
            softer, harder = sorted(spots.hardness)
            value = severity(spots.load, x=spots.x, H_1=softer, H_2=harder)
            over = value > threshold(softer, H_b=harder)
            loaded = loaded + spots.total((spots.load > 0).astype(float))
            S = S + spots.total(value)
            severe = severe + spots.total(over.astype(float))
        if self.f_roll is None and np.any(volume["rolls"][0] > NONE * state.pressure):
            raise InvalidValue(self.problem(F_ROLL, code=Mistake.MISSING))  # in some of its states
        parts = {name: volume[name][0] + volume[name][1] for name in volume}
        total = parts["ss"] + parts["sa"] + parts["groove"] + parts["roll"]
        with np.errstate(invalid="ignore", divide="ignore"):
            return {
                "wear": total,
                **{
                    f"wear_{side + 1}": sum(
                        (volume[name][side] for name in ("ss", "sa", "groove", "roll")), nothing
                    )
                    for side in (0, 1)
                },
                **{f"wear_{name}": parts[name] for name in ("ss", "sa", "groove", "roll")},
                "wear_K": total * min(H) / state.pressure,
                "groove_length": 1 / np.maximum(*volume["cut"]),
                "renewed": (self.renewal or 0.0) * loaded,
                "severity": S / loaded,
                "severe_share": severe / loaded,
            }

    def splits(self, probe: Probe) -> Sequence[float]:
        """Squeezes at which the severity crosses the threshold."""
        from scipy.optimize import brentq

        def log_severity_ratio(log_eps: float) -> float:
            spots = probe(np.exp([log_eps]))
            softer, harder = sorted(spots.hardness)
            S = severity(spots.load, x=spots.x, H_1=softer, H_2=harder)[0, 0]
            return float(np.log(S / threshold(softer, H_b=harder)))

        low, high = math.log(1e-9), math.log(2.0)
        if log_severity_ratio(low) >= 0 or log_severity_ratio(high) <= 0:
            return ()
        return (math.exp(brentq(log_severity_ratio, low, high, xtol=1e-15)),)

    def warnings(self, state: Solved, values: Mapping[str, Array]) -> list[str]:
        out: list[str] = []
        if self.renewal is None and state.particles:
            length = float(np.min(values["groove_length"], initial=np.inf))
            if math.isfinite(length):
                what = (
                    "outputs.wear: without renewal the same particles stay in their grooves; the "
                    f"rates hold for about {value_of(length, 'm', 2)} of sliding, until grooves "
                    "cover the surface"
                )
                action = "give renewal, the fresh particles per particle and sliding length"
                out.append(Note(what, code=f"{self.name}.frozen", action=action))
        if (
            (self.K_sa or 0.0) > 0
            and (self.f_ab or 0.0) > 0
            and np.any((values["wear_sa"] > 0) & (values["wear_groove"] > 0))
        ):
            what = (
                "outputs.wear: sliding particles wear by K_sa and by their grooves; a K_sa "
                "measured with particles has the grooves in it already"
            )
            out.append(Note(what, code=f"{self.name}.twice", effect=1.0))
        return out
