"""What a state is: its columns, their symbols and units, its mode."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..contact.contact import Contact
from ..contact.output import column

__all__ = ["Equilibrium"]

Array = NDArray[np.float64]

Number = float | Array

P_S, HYBRID, S_S = "p-s", "hybrid", "s-s"
MODES = np.array(["", S_S, HYBRID, P_S])
EPS_1, EPS_2 = 0.02, 0.05
"""Default shares that separate the contact modes: read-off resolution, and the paper's 95 %."""


def _column(symbol: str, unit: str, meaning: str) -> Any:
    return field(metadata={"symbol": symbol, "unit": unit, "meaning": meaning})


@dataclass(frozen=True, slots=True, kw_only=True)
class Equilibrium:
    """The solved contact: floats for one load, arrays for several.

    Areas are real areas per nominal area; F* = F/(A_n E_ss). A state that could not be solved
    holds NaN and a sentence in `status`.

    `d` counts from the datum of the particle law: the mean asperity height, except for
    `Horng2022`, which like the paper's eq. (8) puts that height at σ. `h`, from the mean surface
    plane, is the separation to compare between models.

    Made by `solve`, where accuracy and source stand. The columns are named as in the
    nomenclature.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9)))
    >>> state = tb.solve(contact, pressure=[1e6, 5e6, 2e7])  # Pa
    >>> state.mode.tolist(), state.d_star.round(2).tolist()
    (['hybrid', 'hybrid', 'hybrid'], [3.27, 2.43, 1.64])
    >>> state.modes(eps_1=0.05).tolist()  # 95 % of the area count as all of it
    ['p-s', 'hybrid', 'hybrid']
    """

    contact: Contact = field(repr=False)
    d: Number = _column("d", "m", "separation from the mean asperity height")
    h: Number = _column("h", "m", "separation from the mean surface plane")
    d_star: Number = _column("d*", "1", "separation d/σ")
    F_star: Number = _column("F_t*", "1", "load F/(A_n E_ss)")
    pressure: Number = _column("p", "Pa", "nominal pressure")
    F_ss_star: Number = _column("F_ss*", "1", "load on asperities")
    F_sa_star: Number = _column("F_sa*", "1", "load on particles")
    A_t: Number = _column("A_t*", "1", "real contact area")
    A_ss: Number = _column("A_ss*", "1", "real area of asperities")
    A_sa: Number = _column("A_sa*", "1", "real area of particles on surface 1")
    A_sa2: Number = _column("A_sa2*", "1", "real area of particles on surface 2")
    A_e: Number = _column("A_e*", "1", "elastic area")
    A_ep: Number = _column("A_ep*", "1", "elastoplastic area")
    A_p: Number = _column("A_p*", "1", "plastic area")
    shadow: Number = _column("ς", "1", "share of area in which particles keep asperities apart")
    particle_load_share: Number = _column("F_sa/F_t", "1", "load share of particles")
    particle_area_share: Number = _column("A_sa,t*", "1", "area share of particles")
    mode: str | NDArray[np.str_] = _column("mode", "", "contact mode")
    """p-s, hybrid or s-s by area; empty where nothing touches, and in a state without a number."""
    status: str | NDArray[np.str_] = _column("status", "", "ok, or why there is no state")
    residual: Number = _column("r", "1", "relative imbalance |F_t/F − 1|")
    iterations: int | NDArray[np.int_] = _column("n", "", "evaluations of the load")
    warnings: tuple[str, ...] = ()
    populations: tuple[PopulationShare, ...] = ()
    """What each of several populations carries; empty for one."""
    outputs: Mapping[str, Number] = field(default_factory=dict)
    """Every column of the outputs that the contact carries, by name."""
    engine: str = "numpy"
    """What found the separations: "compiled", or "numpy: " and why the compiled engine did not."""

    @property
    def scales(self) -> dict[str, float]:
        """What makes the starred quantities: E_ss [Pa] and σ [m]."""
        return {"E_ss": self.contact.E_ss, "sigma": self.contact.roughness.sigma}

    def columns(self) -> dict[str, NDArray[Any]]:
        """Every column as a 1-D array, those of the outputs last."""
        own = {name: np.atleast_1d(getattr(self, name)) for name in COLUMNS}
        return own | {name: np.atleast_1d(values) for name, values in self.outputs.items()}

    def modes(
        self, *, eps_1: float = EPS_1, eps_2: float = EPS_2, basis: str = "area"
    ) -> str | NDArray[np.str_]:
        """Contact mode with other thresholds, by area (as in the paper) or by load."""
        share = self.particle_area_share if basis == "area" else self.particle_load_share
        return _mode(share, eps_1, eps_2)


@dataclass(frozen=True, slots=True, kw_only=True)
class PopulationShare:
    """What one of several populations of particles carries: floats for one load, else arrays.

    Part of `Equilibrium.populations`; the shares of all populations add up to
    ``particle_load_share`` and ``particle_area_share``.
    """

    name: str
    F_sa_star: Number
    """Load over A_n E_ss [1]"""
    A_sa: Number
    """Real area on surface 1 over A_n [1]"""
    load_share: Number
    """of the total load [1]"""
    area_share: Number
    """of the total real area [1]"""


COLUMNS = {item.name: dict(item.metadata) for item in fields(Equilibrium) if item.metadata}
"""Symbol, unit and meaning of every column of a result."""


def about(name: str) -> dict[str, str]:
    """Symbol, unit and meaning of a column, of the state itself or of an output."""
    return COLUMNS[name] if name in COLUMNS else column(name)._asdict()


def columns_of(contact: Contact) -> tuple[str, ...]:
    """Names of the columns that states of a contact have."""
    return (*COLUMNS, *(name for output in contact.outputs for name in output.columns))


def _mode(particle_share: ArrayLike, eps_1: float, eps_2: float) -> Any:
    share = np.asarray(particle_share)
    # codes first: choosing among strings is slow
    sliding = np.where(1 - share >= 1 - eps_2, 1, 2)
    code = np.where(share >= 1 - eps_1, 3, sliding)
    out = MODES[np.where(np.isnan(share), 0, code)]
    return out if out.ndim else str(out)


def as_columns(
    raw: Mapping[str, Array],
    d: Array,
    mean_plane: Number,
    sigma: Number,
    E: Number,
    *,
    target: Array | None,
    F_star: Array | None = None,
) -> dict[str, Any]:
    """Every numeric column of a result, and the mode, from pressures and areas at d."""
    F = raw["F_ss"] + raw["F_sa"]
    with np.errstate(invalid="ignore", divide="ignore"):
        area_share = raw["A_sa"] / raw["A_t"]
        load_share = raw["F_sa"] / F
        residual = np.abs(F / target - 1) if target is not None else np.where(np.isnan(d), d, 0.0)
    load = F if target is None else target
    return {
        "d": d,
        "h": d + mean_plane,
        "d_star": d / sigma,
        "F_star": load / E if F_star is None else F_star,
        "pressure": load,
        "F_ss_star": raw["F_ss"] / E,
        "F_sa_star": raw["F_sa"] / E,
        **{name: raw[name] for name in COLUMNS if name in raw},
        "particle_load_share": load_share,
        "particle_area_share": area_share,
        "mode": _mode(area_share, EPS_1, EPS_2),
        "residual": residual,
    }
