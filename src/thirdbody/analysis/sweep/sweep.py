"""Sweeps: many states of many contacts as one labelled data set.

A `Plan` says which states there are and cuts them into blocks; a block knows everything it needs
to be solved anywhere, any number of times, with the same result.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from ...contact.contact import Contact
from ...errors import InvalidValue, Mistake, Problem
from ...numerics.sampling import SweepDesign
from ...quantities.carried import takes_units
from ...quantities.files import refused_by_disk
from .make_plan import make_plan
from .plan import CHUNK
from .streaming import Format

if TYPE_CHECKING:
    import os

    import xarray
    from distributed import Client

__all__ = ["sweep"]


# -------------------------------------------------------------------------- sweep
@takes_units
def sweep(
    contact: Contact,
    *,
    pressure: ArrayLike | Mapping[str, object] | None = None,
    F_star: ArrayLike | Mapping[str, object] | None = None,
    d: ArrayLike | Mapping[str, object] | None = None,
    vary: Mapping[str, object] | None = None,
    design: SweepDesign = "grid",
    samples: int | None = None,
    seed: int = 0,
    columns: Sequence[str] | None = None,
    reduce: Mapping[str, object] | None = None,
    out: str | os.PathLike[str] | None = None,
    format: Format = "zarr",
    chunk: int = CHUNK,
    workers: int = 1,
    client: Client | None = None,
    progress: bool | Callable[[int], None] = False,
) -> xarray.Dataset:
    """States of a contact over loads and any of its inputs: on a grid, in pairs, or sampled.

    Parameters
    ----------
    contact : Contact
        The inputs that are not varied.
    pressure, F_star, d : array_like or range
        Loads, as in `solve`; exactly one.
    vary : mapping, optional
        Dotted names of fields and the values they take, e.g.
        ``{"particles.diameter.mean": [0, 100e-9, 300e-9]}``. A mean diameter or an areal
        density of zero stands for two-body contact. In a sampled design a tuple ``(low, high)``
        or a mapping ``{"low": ..., "high": ..., "scale": "log"}`` is a range to sample; the same
        goes for the load.
    design : {"grid", "zip", "latin", "sobol"}, optional
        Every combination; the i-th value of every input; or samples of the ranges, the same in
        every combination of the inputs that are listed.
    samples : int, optional
        Number of samples. Sobol points are balanced best in powers of two.
    seed : int, optional
        Of the samples: the same seed gives the same samples.
    columns : sequence of str, optional
        Which columns of `Equilibrium` to keep; all by default.
    reduce : mapping, optional
        Keep only statistics of every cell of the remaining dimensions: ``over``, the inputs to
        reduce over (the samples by default); ``quantiles``, probabilities; ``exceed``, a threshold
        for each of some columns; ``extrema``, ``mean``, True or False.
    out : path-like, optional
        A folder to write to block by block, in bounded memory. A run that was interrupted or
        killed goes on when the same call is made again; a finished one is opened. What is not
        as it was written is told in a warning and solved again. A folder that holds anything
        else is refused.
    format : {"zarr", "netcdf"}, optional
        Of the data in ``out``.
    chunk : int, optional
        States of a block.
    workers : int, optional
        Threads that solve blocks.
    client : distributed.Client, optional
        An existing Dask cluster that solves the blocks instead; this process writes them.
    progress : bool or callable, optional
        Show rate and time left on standard error; or a function of the number of states solved
        for good (in ``out``: written), called after each block.

    Returns
    -------
    xarray.Dataset
        One dimension for each listed input, for the load, and for the samples (``sample``) or
        pairs (``state``); every column of `Equilibrium` as a variable with ``units``,
        ``long_name`` and ``symbol``; inputs, version, citations and ``engine``, how many states
        each engine solved and why, as attributes. A state without equilibrium is NaN with its
        reason in ``status``, of which ``status_code`` holds the number. Those of ``out`` are loaded
        when they are used; its files hold ``mode`` and ``status`` as codes (``flag_values``,
        ``flag_meanings``), so that ``status`` is the sentence that all states of a code share.

    Raises
    ------
    InvalidValue
        An unknown name, an empty list, or a value that the field refuses; a folder that another
        run uses, or that holds another study.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> curves = tb.sweep(contact, F_star=[1e-6, 1e-5], vary={"roughness.sigma": [1e-7, 2e-7]})
    >>> curves.A_t.dims
    ('roughness.sigma', 'F_star')
    >>> spread = tb.sweep(contact, pressure=[1e6, 1e7], design="sobol", samples=4,
    ...                   vary={"roughness.R": (2e-6, 4e-6)}, reduce={"quantiles": [0.5]})
    >>> spread.A_t_quantile.dims
    ('pressure', 'quantile')
    """
    from . import streaming

    plan = make_plan(
        contact,
        F_star=F_star,
        pressure=pressure,
        d=d,
        vary=vary,
        design=design,
        samples=samples,
        seed=seed,
        columns=columns,
        reduce=reduce,
        chunk=chunk,
    )
    if isinstance(workers, bool) or not isinstance(workers, int) or workers < 1:
        raise InvalidValue(
            Problem(
                "workers", "must be a whole number, at least 1", repr(workers), code=Mistake.KIND
            )
        )
    if client is not None and not hasattr(client, "submit"):
        raise InvalidValue(
            Problem(
                "client",
                "must be a Client of distributed, or None",
                f"{client!r:.60}",
                code=Mistake.KIND,
            )
        )
    if out is None:
        return streaming.in_memory(plan, workers=workers, client=client, progress=progress)
    with refused_by_disk(out):
        folder = streaming.run(
            plan, out, format=format, workers=workers, client=client, progress=progress
        )
        from .decoded import open_as_in_memory

        return open_as_in_memory(folder, plan)
