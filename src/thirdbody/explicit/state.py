"""What an explicit state is: numbers named as in `Equilibrium`, maps, and every particle."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ..contact.contact import Contact
from ..equilibrium.columns import COLUMNS as OF_EQUILIBRIUM
from ..quantities.arguments import names_arguments
from ..quantities.files import whole
from ..quantities.record import StateRecord, column, declared_columns
from .seats import SeatHeights

if TYPE_CHECKING:
    import numpy as np
    import xarray
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Number = float | Array

__all__ = ["COLUMNS", "CONTACTS", "ExplicitState"]

CONTACTS = ("none", "asperity", "capped asperity", "covered")
"""What the numbers of the map ``contact`` mean, from 0."""


def _as_equilibrium(name: str) -> Any:
    return column(*OF_EQUILIBRIUM[name])


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class ExplicitState(StateRecord):
    """A height map pressed with every particle at its place: floats for one load, else arrays.

    Columns have the names and the meaning that they have in `thirdbody.results.Equilibrium`. Made
    by `solve`.

    Attributes
    ----------
    maps : xarray.Dataset
        On (y, x): ``pressure`` [Pa], ``gap`` [m] (negative where the cap has let the flat sink
        in), ``height`` [m], ``displacement`` [m], ``contact`` (0 none, 1 asperity, 2 capped
        asperity, 3 covered by a particle). Of the last load, or of all along ``state``.
    particles : xarray.Dataset
        On ``particle``: ``x``, ``y``, ``diameter`` [m], ``population``, ``zeta`` (height of the
        seat over σ), ``squeeze`` [m], ``force`` [N], ``dent_1``, ``dent_2`` [m], ``regime``.
    """

    contact: Contact = field(repr=False)
    """What was pressed."""
    h: Number = _as_equilibrium("h")
    F_star: Number = _as_equilibrium("F_star")
    pressure: Number = _as_equilibrium("pressure")
    F_ss_star: Number = _as_equilibrium("F_ss_star")
    F_sa_star: Number = _as_equilibrium("F_sa_star")
    A_t: Number = _as_equilibrium("A_t")
    A_ss: Number = _as_equilibrium("A_ss")
    A_ss_counted: Number = column("A_c*", "1", "area of pixels in contact, without the correction")
    A_sa: Number = _as_equilibrium("A_sa")
    A_sa2: Number = _as_equilibrium("A_sa2")
    particle_load_share: Number = _as_equilibrium("particle_load_share")
    particle_area_share: Number = _as_equilibrium("particle_area_share")
    mode: str | NDArray[np.str_] = _as_equilibrium("mode")
    carrying_pixels: int | NDArray[np.int_] = column("n_p", "", "pixels under pressure")
    carrying_particles: int | NDArray[np.int_] = column("n_a", "", "particles that carry")
    converged: bool | NDArray[np.bool_] = column("", "", "whether the certificate is below tol")
    certificate: Number = column("ε", "1", "bound of the elastic energy of the error over σF")
    iterations: int | NDArray[np.int_] = column("n", "", "convolutions on the full grid")
    seconds: Number = field(repr=False)
    """Wall time [s]."""
    sigma: float = field(repr=False)
    """RMS height of the map [m]."""
    seats: SeatHeights
    """Heights of the places of these particles over σ."""
    maps: xarray.Dataset = field(repr=False)
    particles: xarray.Dataset = field(repr=False)
    warnings: tuple[str, ...] = ()
    """Where the map is too coarse or too small for the answer, a sentence each."""
    errors: Mapping[str, Number] = field(default_factory=dict)
    """Standard errors of h, A_t and the shares, over blocks of the map; empty unless asked for."""

    @names_arguments
    def to_netcdf(self, path: str | os.PathLike[str]) -> None:
        """Maps and particles in one NetCDF file.

        Parameters
        ----------
        path : path-like
            The file to write.
        """
        of_particles = self.particles.rename(
            {name: f"particle_{name}" for name in self.particles.data_vars}
        )
        with whole(path) as draft:
            self.maps.merge(of_particles, combine_attrs="override").to_netcdf(draft)


COLUMNS = declared_columns(ExplicitState)
"""Symbol, unit and meaning of every column."""
