r"""Bodies that a force presses together: what they are, and the pressure between them.

A force in newtons becomes the Hertz pressure of the smooth dry bodies, its mean and its largest,
and the contact of the rough ones integrated over it:

.. math:: \bar p = F/A, \qquad p_0 = \tfrac32\bar p\ \text{(point)},\ \tfrac4\pi\bar p\
          \text{(line)},\ \bar p\ \text{(flat)}, \qquad A_t = \int A_t^*(p)\,dA

A circular point contact and a line contact are integrated with the elastic bodies under the rough
skin (`rough_body`), which spread the load beyond Hertz; an ellipse over Hertz's pressure.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..contact.contact import Contact
from ..equilibrium.crowding import crowded_places
from ..equilibrium.solve import solve
from ..equilibrium.words import meets
from ..errors import InvalidValue, Mistake, NoEquilibrium, Note, Problem, RangeWarning
from ..laws.asperity import ZMC
from ..numerics.quadrature import gauss_legendre
from ..quantities.carried import takes_units
from ..quantities.record import Record
from ..quantities.say import number, percent, value_of
from .body_shapes import BallInGroove, BallOnFlat, Body, Cylinders, Flat, Roller
from .conjunctions import Hertz, Line, Point
from .machine_elements import BallBearing, BallScrew, Gear, LinearGuide, RollerBearing
from .rough_body import rough_cylinder, rough_sphere

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = [
    "BODIES",
    "BallBearing",
    "BallInGroove",
    "BallOnFlat",
    "Body",
    "Cylinders",
    "Flat",
    "Pressed",
    "Roller",
    "press",
    "yield_note",
]

YIELD = 1.5 * ZMC().k
"""Largest Hertz pressure at first yield over the hardness [1]: 0.6, 1.5 k of the law ZMC."""
NODES = 24


@takes_units
def yield_note(force: float, maximum: float, yields: float, *, flat: bool = False) -> Note:
    """The note that bodies themselves yield under a force.

    Parameters
    ----------
    force : float
        Force on the bodies [N].
    maximum, yields : float
        Largest pressure, and that at which yield begins [Pa].
    flat : bool, optional
        Whether a flat punch presses, whose yield stress that is.
    """
    first = "p_0 = 1.6 Y = 0.6 H, at which yield begins below a ball (ZMC, k = 0.4)"
    if flat:
        first = "the yield stress Y = 0.375 H: p_0 = 1.6 Y = 0.6 H at first yield under a ball"
    what = (
        f"under {value_of(force, 'N')} the bodies themselves yield: the largest pressure, "
        f"{value_of(maximum, 'Pa')}, is above {value_of(yields, 'Pa')}, {first}; "
        "Hertz and the elastic bodies then overestimate the pressure"
    )
    return Note(what, code="bodies.yield", effect=1 - yields / maximum)


BODIES: dict[str, type[Body]] = {
    "ball-on-flat": BallOnFlat,
    "ball-in-groove": BallInGroove,
    "roller": Roller,
    "cylinders": Cylinders,
    "flat": Flat,
    "ball-bearing": BallBearing,
    "roller-bearing": RollerBearing,
    "ball-screw": BallScrew,
    "linear-guide": LinearGuide,
    "gear": Gear,
}
"""Every pair of bodies by the word that study files use."""


# ------------------------------------------------------------------ under a force
@dataclass(frozen=True, eq=False, kw_only=True)
class Pressed(Record):
    """One contact of bodies under a force.

    Attributes
    ----------
    kind : str
        The word of the study file.
    force, bodies : float
        On all contacts together [N], and how many share it [1].
    area, mean, maximum : float
        Hertz contact of smooth bodies: area [m²], mean and largest pressure [Pa].
    yields : float
        Largest pressure at which the bodies themselves begin to yield [Pa].
    method : str
        How it was integrated: "rough body", "Hertz pressure", "even", or "" where it was not.
    real_area, particle_load_share : float or None
        Real contact area of one contact [m²], and the part of its load on particles [1].
    peak_pressure : float or None
        Largest pressure between the rough bodies [Pa].
    note : str
        Why it was not integrated, or not with the rough body; or that places of it are crowded.
    particles_held : float or None
        Particles that lie on the area that carries, on average [1]; None without particles. That
        area is Hertz's, or as much larger as roughness and particles make the largest pressure
        smaller.
    with_particles, without_particles : dict or None
        Where a contact holds less than one particle on average: ``share`` of the contacts,
        ``real_area``, ``particle_load_share`` and ``peak_pressure`` of those that hold some, and of
        those that hold none. Real area and load share above are means over both, and the largest
        pressure is that of the greater part.
    heaviest : float or None
        Load of the contact that was solved, where not all carry alike [N].
    crowded_share : float
        Part of the load at places that are crowded [1]; ``note`` says what that means.
    """

    not_in_dict = ("crowded_share",)
    kind: str
    force: float
    bodies: float
    area: float
    mean: float
    maximum: float
    yields: float
    method: str = ""
    real_area: float | None = None
    particle_load_share: float | None = None
    peak_pressure: float | None = None
    note: str = ""
    particles_held: float | None = None
    with_particles: dict[str, float | None] | None = None
    without_particles: dict[str, float | None] | None = None
    heaviest: float | None = None
    crowded_share: float = 0.0

    @property
    def warnings(self) -> tuple[str, ...]:
        """Where contacts have grown together, and where the bodies themselves yield."""
        close = (f"under {value_of(self.force, 'N')}: {self.note}",) if self.crowded_share else ()
        if self.maximum <= self.yields:
            return close
        flat = self.kind == "flat"
        return (*close, yield_note(self.force, self.maximum, self.yields, flat=flat))

    def sentence(self) -> str:
        """Force, pressures and what the integral gives, in words."""
        shared = "" if self.bodies == 1 else f" shared by {number(self.bodies)}"
        if self.heaviest is not None:
            shared += f", {value_of(self.heaviest, 'N')} on the most loaded"
        out = f"{value_of(self.force, 'N')} on the body {self.kind}{shared}: "
        area = f"{number(self.area * 1e6)} mm²"
        rare = self._rare()
        if self.kind == "flat":
            return f"{out}pressure {value_of(self.mean, 'Pa')} on {area}.{rare}"
        out += (
            f"Hertz contact of {area}, mean pressure {value_of(self.mean, 'Pa')}, "
            f"largest {value_of(self.maximum, 'Pa')}"
        )
        if self.real_area is None:
            return f"{out}." + (f" Not integrated: {self.note}." if self.note else "") + rare
        out += (
            f". Integrated over the contact ({self.method}), the real area is "
            f"{number(self.real_area * 1e6)} mm², {percent(self.real_area / self.area)} of Hertz's"
        )
        if self.particle_load_share is not None:
            out += f", and particles carry {percent(self.particle_load_share)} of the load"
            out += ", on average over many contacts" * bool(rare)
        if self.method == "rough body" and self.peak_pressure is not None:
            largest = value_of(self.peak_pressure, "Pa")
            most = " in most contacts" * bool(rare)
            out += f"; roughness changes the largest pressure{most} to {largest}"
        return f"{out}.{rare}"

    def _rare(self) -> str:
        """A sentence where a contact holds less than one particle; a blank stands before it."""
        rare = meets(self.particles_held or 0.0)
        if not rare:
            return ""
        sentence = f" {rare[0].upper()}{rare[1:]}, and the others are as without particles"
        some, none = self.with_particles, self.without_particles
        if some is None or none is None:
            return f"{sentence}."
        load = some["particle_load_share"]
        areas = [f"{number((case['real_area'] or math.nan) * 1e6)} mm²" for case in (some, none)]
        return (
            f"{sentence}. Where one is, particles carry {percent(load)} of the load and the real "
            f"area is {areas[0]}; where none is, asperities carry the whole load on {areas[1]}."
        )


@takes_units
def press(contact: Contact, body: Body, force: float, *, integrate: bool = True) -> Pressed:
    """A body under a force: pressures, and the rough contact integrated over it.

    Parameters
    ----------
    contact : Contact
    body : Body
    force : float
        On all its contacts together [N].
    integrate : bool, optional
        Whether to integrate; the pressures alone take no time.

    Returns
    -------
    Pressed

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> found = press(contact, BallOnFlat(diameter=10e-3), 10.0)
    >>> found.method, round(found.maximum / 1e6), round(found.peak_pressure / 1e6)
    ('rough body', 990, 886)
    """
    if not (math.isfinite(force) and force > 0):
        raise InvalidValue(Problem("force", "must be > 0 [N]", repr(force), code=Mistake.RANGE))
    hertz = body.hertz(force, contact.E_ss)
    kind = next(name for name, body_class in BODIES.items() if type(body) is body_class)
    H = contact.surfaces.H
    every = sum(dust.areal_density for dust in contact.populations)
    values: dict[str, Any] = {
        "kind": kind,
        "force": float(force),
        "bodies": body.bodies,
        "area": float(hertz.area),
        "mean": float(hertz.mean),
        "maximum": float(hertz.maximum),
        "yields": YIELD * H / (1.6 if kind == "flat" else 1.0),
        "particles_held": None if contact.two_body else float(every * hertz.area),
    }
    one = float(body.load_on_one(force, contact.E_ss))
    if abs(one * body.bodies / force - 1) > 1e-9:
        values["heaviest"] = one
    if not integrate:
        return Pressed(**values)
    integrals = _integrals(contact, body, force, hertz)
    if not contact.two_body and integrals.get("method") == "rough body":
        values["particles_held"] *= max(float(hertz.maximum) / integrals["peak_pressure"], 1.0)
    if 0 < (values["particles_held"] or 0.0) < 1 and "method" in integrals:
        integrals |= _with_and_without(
            contact, body, force, hertz, values["particles_held"], integrals
        )
    return Pressed(**values, **integrals)


def _with_and_without(
    contact: Contact, body: Body, force: float, hertz: Hertz, held: float, shared: dict[str, object]
) -> dict[str, Any]:
    """Contacts with a particle and contacts without, each under its whole load.

    Of those that hold some, the mean number of particles is 1/(1 − exp(−N)) times that of all.
    """
    without = math.exp(-held)
    clean = _integrals(contact.replace(particles=None), body, force, hertz)
    try:
        dusty = contact.replace(
            particles=tuple(
                population.replace(areal_density=population.areal_density / -math.expm1(-held))
                for population in contact.populations
            )
        )
        some = _integrals(dusty, body, force, hertz)
    except InvalidValue:  # so many do not find room
        some = shared
    if "method" not in clean or "method" not in some:
        return {}
    area = without * clean["real_area"] + (1 - without) * some["real_area"]
    usual = clean if without > 0.5 else some
    return {
        "real_area": area,
        "particle_load_share": (1 - without) * some["particle_load_share"],
        "peak_pressure": usual["peak_pressure"],
        "with_particles": _integrals_of(1 - without, some),
        "without_particles": _integrals_of(without, clean | {"particle_load_share": 0.0}),
    }


def _integrals_of(share: float, integrals: dict[str, Any]) -> dict[str, float | None]:
    names = ("real_area", "particle_load_share", "peak_pressure")
    return {"share": share} | {name: integrals[name] for name in names}


def _integrals(contact: Contact, body: Body, force: float, hertz: Hertz) -> dict[str, Any]:
    shape, one, why = body.conjunction, float(body.load_on_one(force, contact.E_ss)), ""
    try:
        if isinstance(shape, Line):
            roller = rough_cylinder(contact, radius=shape.R, load=one / shape.length, quick=True)
            return _values(contact, roller, shape.length)
        if isinstance(shape, Point) and shape.ratio == 1:
            ball = rough_sphere(contact, radius=shape.R, load=one, quick=True)
            return _values(contact, ball, 1.0)
    except (NoEquilibrium, InvalidValue) as error:
        why = str(error).splitlines()[0]
    integrals = _over_pressure(contact, shape, hertz)
    return integrals | ({"note": why} if why and not integrals.get("note") else {})


def _values(contact: Contact, rough_body: Any, length: float) -> dict[str, object]:
    share = None if contact.two_body else rough_body.particle_load_share
    return {
        "method": "rough body",
        "real_area": length * rough_body.real_area,
        "particle_load_share": share,
        "peak_pressure": rough_body.peak_pressure,
        **_crowd(rough_body.crowded_share, rough_body.status),
    }


def _over_pressure(contact: Contact, shape: Point | Line | None, hertz: Hertz) -> dict[str, object]:
    """Over the pressure of the smooth bodies, each place as if it were alone."""
    pressure, weights = _places(shape, float(hertz.maximum))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        state = solve(contact, pressure=pressure)
    is_solved = np.isfinite(np.atleast_1d(state.A_t))
    if not is_solved.all():
        return {"note": np.atleast_1d(state.status)[~is_solved].tolist()[0]}
    load = weights @ pressure
    crowd = crowded_places(contact, np.atleast_1d(state.A_t), weights * pressure)
    share = None
    if not contact.two_body:
        share = float(weights @ (pressure * np.atleast_1d(state.particle_load_share)) / load)
    return {
        "method": "even" if shape is None else "Hertz pressure",
        "real_area": float(hertz.area) * float(weights @ np.atleast_1d(state.A_t)),
        "particle_load_share": share,
        "peak_pressure": float(hertz.maximum),
        **_crowd(*crowd),
    }


def _crowd(share: float | None, status: str) -> dict[str, object]:
    """The part of the load at crowded places, and what that means."""
    return {"crowded_share": share, "note": status} if share else {}


def _places(
    shape: Point | Line | None, largest: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Pressures [Pa], and the parts of the area where they are."""
    if shape is None:
        return np.array([largest]), np.ones(1)
    nodes, weights = gauss_legendre(NODES)
    t, w = 0.5 * (1 + nodes), 0.5 * weights
    if isinstance(shape, Point):  # p = p_0 √(1 − s) over even s
        return largest * t, 2 * t * w
    angle = 0.5 * math.pi * t  # p = p_0 cos θ at x = b sin θ
    return largest * np.cos(angle), 0.5 * math.pi * np.cos(angle) * w
