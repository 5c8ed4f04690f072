r"""Rough bodies of finite size: Greenwood and Tripp's sphere, and the cylinder.

A smooth elastic half-space and a body of radius B with a rough skin; whatever the skin is (bare
asperities of any law, particles between them), it is a pressure that depends on the local gap,

.. math:: p(r) = F_t(u(r)), \qquad u(r) = d + \frac{r^2}{2B} + w(r),

and the elastic displacement w follows from the pressure. The ring kernel of a sphere,

.. math:: w(r) = \frac{4}{\pi E^*}\int p(s)\,\frac{s}{r+s}\,K(m)\,ds, \quad m = \frac{4rs}{(r+s)^2},

is singular at s = r, but equals two smooth integrals, which is what is discretised here:

.. math:: w(r) = \frac{2}{\pi E^*}\int_0^{\pi/2} q(r\sin\theta)\,d\theta, \qquad
          q(x) = 2\int_0^\infty p\left(\sqrt{x^2+y^2}\right)dy .

The pressure is an even Chebyshev series; the balance is solved by Newton's method. The number of
nodes grows until the series has converged.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np

from ..contact.contact import Contact
from ..equilibrium.columns import CODE
from ..equilibrium.status import STATUS_CODE, Status
from ..errors import InvalidValue, Mistake, Problem
from ..quantities.carried import takes_units
from ..quantities.record import TableRecord, Variable, column
from .elastic_balance import (
    COARSE,
    Balance,
    Cylinder,
    Skin,
    Sphere,
    _line_weights,
    _ring_compliance,
    balance,
    crowded_warning,
    to_series,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["RoughBody", "curve", "rough_cylinder", "rough_sphere"]


PER_LENGTH = {"load": "N/m", "stiffness": "N/m^2", "real_area": "m^2/m"}
"""Units of a cylinder."""


def __dir__() -> list[str]:
    return sorted(__all__)


# ------------------------------------------------------------------------------ results
@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class RoughBody(TableRecord):
    """A solved rough sphere, or a rough cylinder per metre of length.

    Made by `rough_sphere` and `rough_cylinder`, where accuracy and source stand.

    Attributes
    ----------
    shape : str
        "sphere" or "cylinder".
    radius, d : float
        B [m]; separation d [m] of the undeformed body at its axis from the mean asperity height,
        negative when it has approached beyond first contact.
    load : float
        F [N], or [N/m] for the cylinder.
    stiffness : float
        −dF/dd [N/m], or [N/m²] for the cylinder (there it depends on the reference point).
    r, gap, pressure : array
        Distance from the axis [m], increasing; local separation u [m] and pressure p [Pa].
    peak_pressure, axis_gap : float
        p and u at the axis [Pa], [m].
    a_eff : float
        Effective contact radius 3π∫pr dr / 4∫p dr [m]; without roughness the Hertz radius.
    a_hertz, p_hertz : float
        Nominal contact radius (half-width) [m] and largest pressure [Pa] of smooth bodies under
        the same load.
    real_area : float or None
        Real contact area [m²], or [m²/m]; None for a plain pressure law.
    particle_load_share : float or None
        Load of the particles over the total load [1].
    resolution, residual : float
        Last coefficients of the pressure over the largest [1], largest error of the gap [m].
    crowded_share : float or None
        Share of the load at places where contacts have grown together, so that a model that counts
        them one by one has no answer [1]; None for a plain pressure law.
    status : str
        "ok", or a sentence that begins with "crowded".
    warnings : tuple of str
        Where the body leaves the range of the model.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.rough_body import rough_sphere
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> ball = rough_sphere(contact, radius=5e-3, load=10.0)
    >>> ball.shape, ball.peak_pressure < ball.p_hertz, ball.a_eff > ball.a_hertz
    ('sphere', True, True)
    """

    more_columns = {CODE: STATUS_CODE}
    along = "r"
    shape: str = column("shape", "", "sphere or cylinder")
    radius: float = column("B", "m", "radius of the body")
    d: float = column("d", "m", "separation of the undeformed body at its axis")
    load: float = column("F", "N", "load")
    stiffness: float = column("−dF/dd", "N/m", "stiffness")
    r: Array = column("r", "m", "distance from the axis")
    gap: Array = column("u", "m", "local separation")
    pressure: Array = column("p", "Pa", "local pressure")
    peak_pressure: float = column("p_0", "Pa", "pressure at the axis")
    axis_gap: float = column("u_0", "m", "separation at the axis")
    a_eff: float = column("a", "m", "effective contact radius")
    a_hertz: float = column("a_H", "m", "contact radius of smooth bodies")
    p_hertz: float = column("p_H", "Pa", "largest pressure of smooth bodies")
    real_area: float | None = column("A_t", "m^2", "real contact area")
    particle_load_share: float | None = column("F_sa/F_t", "1", "load share of particles")
    resolution: float = column("", "1", "last coefficients of the pressure over the largest")
    residual: float = column("", "m", "largest error of the gap")
    crowded_share: float | None = column(
        "", "1", "share of the load where contacts have grown together", default=None
    )
    status: str = column("status", "", "ok, or why its numbers are no answer", default="ok")
    warnings: tuple[str, ...] = ()

    def variables(self) -> Mapping[str, Variable]:
        """The columns; of a cylinder load, stiffness and area are those of a length."""
        out = dict(TableRecord.variables(self))
        for name, unit in PER_LENGTH.items() if self.shape == "cylinder" else ():
            out[name] = out[name]._replace(labels={**out[name].labels, "units": unit})
        return out

    @property
    def status_code(self) -> Status:
        """`thirdbody.results.Status`, of which ``status`` is the sentence."""
        return Status.OK if self.status == Status.OK.sentence else Status.CROWDED


def _result(
    skin: Skin, shape: Sphere | Cylinder, state: Balance, resolved: float = 1e-6
) -> RoughBody:
    grid, p = state.grid, state.pressure
    n = len(p)
    line = state.extent * _line_weights(n)
    ring = state.extent**2 * _ring_compliance(n)[2] / (2 * math.pi)
    axis = (-1.0) ** np.arange(n) @ to_series(n)[1]
    axis_gap = state.d + float(axis @ (grid.compliance @ p))
    area = share = close = None
    status = "ok"
    if skin.solids is not None:
        fields_ = skin.solids.fields(state.gap)
        area = float(grid.weights @ fields_["A_t"])
        share = float(grid.weights @ fields_["F_sa"]) / state.load
        close, status = skin.crowded_places(fields_["A_t"], grid.weights * p)
    a_hertz, p_hertz = shape.hertz(state.load)
    notes = skin.warnings + crowded_warning(status)
    if state.tail > resolved:
        notes += (f"the pressure is resolved to {state.tail:.1g} only: its edge is very sharp",)
    return RoughBody(
        shape=type(shape).__name__.lower(),
        radius=shape.radius,
        d=state.d,
        load=state.load,
        stiffness=-state.slope,
        r=grid.x[::-1],
        gap=state.gap[::-1],
        pressure=p[::-1],
        peak_pressure=skin.one(axis_gap)[0],
        axis_gap=axis_gap,
        a_eff=0.75 * math.pi * float(ring @ p) / float(line @ p),
        a_hertz=a_hertz,
        p_hertz=p_hertz,
        real_area=area,
        particle_load_share=share,
        resolution=state.tail,
        residual=state.residual,
        crowded_share=close,
        status=status,
        warnings=notes,
    )


def _positive(name: str, value: float) -> float:
    if not (math.isfinite(value) and value > 0):
        raise InvalidValue(Problem(name, "must be > 0 [m]", repr(value), code=Mistake.RANGE))
    return float(value)


@takes_units
def rough_sphere(
    contact: Contact | Callable[..., Array],
    *,
    radius: float,
    d: float | None = None,
    load: float | None = None,
    E_star: float | None = None,
    guess: float | None = None,
    quick: bool = False,
) -> RoughBody:
    r"""A rough sphere on a flat after Greenwood and Tripp, for any contact.

    Parameters
    ----------
    contact : Contact or callable
        The rough skin, particles included; or ``pressure(gap) -> (p, dp/dgap)`` over arrays
        [m] -> [Pa], [Pa/m], falling with the gap.
    radius : float
        B [m], 1/B = 1/B_1 + 1/B_2; large against the contact and every asperity radius.
    d : float, optional
        Separation at the axis without deformation [m]; negative when pressed together.
    load : float, optional
        F [N]. Exactly one of ``d`` and ``load``.
    E_star : float, optional
        Contact modulus of the bodies [Pa], with a callable only.
    guess : float, optional
        A separation [m] to start from when the load is given.
    quick : bool, optional
        Stop at five digits when the load is given, in half the time.

    Returns
    -------
    RoughBody

    Raises
    ------
    NoEquilibrium
        The local gap would fall below −3 σ_s.

    Notes
    -----
    Lengths along the flat scale with √(2Bσ), the pressure with E*√(σ/8B); a contact of GW
    asperities depends only on d/σ and μ = (8/3)ησ√(2BR). Where the load is large the pressure
    tends to that of Hertz, where it is small it is proportional to μ.

    Provenance: kernel seen in Johnson 1985; smooth form of it derived; eq. (4) of the 1967 paper
    is not used. Twelve digits against an independent solution with the singular kernel.

    References
    ----------
    Greenwood, Tripp 1967, J. Appl. Mech. 34, 153, doi:10.1115/1.3607616; Johnson 1985, Contact
    Mechanics, ch. 13, doi:10.1017/CBO9781139171731.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.rough_body import rough_sphere
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> ball = rough_sphere(contact, radius=5e-3, load=10.0)
    >>> round(ball.a_eff / ball.a_hertz, 3), round(ball.peak_pressure / ball.p_hertz, 3)
    (1.072, 0.895)
    """
    skin = Skin(contact, E_star)
    shape = Sphere(_positive("radius", radius), skin.E_star)
    state = balance(skin, shape, d=d, load=load, guess=guess, quick=quick)
    return _result(skin, shape, state, COARSE if quick else 1e-6)


@takes_units
def rough_cylinder(
    contact: Contact | Callable[..., Array],
    *,
    radius: float,
    d: float | None = None,
    load: float | None = None,
    E_star: float | None = None,
    reference: float | None = None,
    guess: float | None = None,
    quick: bool = False,
) -> RoughBody:
    r"""A rough cylinder on a flat (line contact), per metre of length.

    .. math:: u = d + \frac{x^2}{2B} - \frac{2}{\pi E^*}\int p(s)\,
              \ln\left|\frac{x-s}{x_0-s}\right| ds

    Parameters
    ----------
    contact, radius, E_star, quick
        As in `rough_sphere`.
    guess : float, optional
        As there [m].
    d : float, optional
        Separation at the axis [m], without the displacement relative to the point x_0.
    load : float, optional
        F per length [N/m]. Exactly one of ``d`` and ``load``.
    reference : float, optional
        x_0 [m], the point whose displacement counts as zero; B by default. In two dimensions the
        approach of two bodies is not a property of the contact: only d depends on x_0, every
        quantity at a given load does not.

    Returns
    -------
    RoughBody

    Notes
    -----
    Provenance: derived, from the displacement of a half-space under a line load.

    References
    ----------
    Greenwood, Tripp 1967, J. Appl. Mech. 34, 153, doi:10.1115/1.3607616; Johnson 1985, Contact
    Mechanics, ch. 2, doi:10.1017/CBO9781139171731.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.rough_body import rough_cylinder
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> roller = rough_cylinder(contact, radius=5e-3, load=5e4)
    >>> round(roller.a_eff / roller.a_hertz, 3)
    1.161
    """
    skin = Skin(contact, E_star)
    radius = _positive("radius", radius)
    point = radius if reference is None else float(reference)
    shape = Cylinder(radius, skin.E_star, point)
    state = balance(skin, shape, d=d, load=load, guess=guess, quick=quick)
    return _result(skin, shape, state, COARSE if quick else 1e-6)


@takes_units
def curve(
    contact: Contact | Callable[..., Array],
    *,
    radius: float,
    loads: ArrayLike,
    shape: str = "sphere",
    E_star: float | None = None,
) -> dict[str, Array]:
    """Every number of `RoughBody` against the load, as columns.

    Parameters
    ----------
    contact, radius, E_star
        As in `rough_sphere`.
    loads : array_like
        Loads F [N], or [N/m] for ``shape="cylinder"``.
    shape : {"sphere", "cylinder"}, optional

    Returns
    -------
    dict of str to array
        One array per number of `RoughBody` (``load``, ``d``, ``a_eff``, ``real_area``, …).

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.rough_body import curve
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> table = curve(contact, radius=5e-3, loads=[1.0, 10.0])
    >>> [round(float(a) * 1e6, 1) for a in table["a_eff"]]
    [40.8, 74.5]
    """
    solvers = {"sphere": rough_sphere, "cylinder": rough_cylinder}
    if shape not in solvers:
        raise InvalidValue(
            Problem("shape", "must be 'sphere' or 'cylinder'", repr(shape), code=Mistake.OPTION)
        )
    values = np.atleast_1d(np.asarray(loads, dtype=float))
    if values.ndim != 1:
        raise InvalidValue("loads must be a number or a 1-D array", code=Mistake.SHAPE)
    solved: list[RoughBody | None] = [None] * len(values)
    guess = None
    for i in np.argsort(values):
        state = solvers[shape](
            contact, radius=radius, load=float(values[i]), E_star=E_star, guess=guess
        )
        solved[i], guess = state, state.d
    names = [item.name for item in fields(RoughBody) if item.type in ("float", "float | None")]
    return {
        name: np.array([getattr(state, name) for state in solved], dtype=float) for name in names
    }
