"""The words of study files: distributions, heights, loads, and what else people call them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from ..populations.distributions import Distribution
from ..populations.heights import Heights
from ..quantities import nearest
from ..quantities.value import quantity

__all__ = ["DISTRIBUTIONS", "HEIGHTS", "LOADS", "nearest_option"]

DISTRIBUTIONS = Distribution.registry
"""Every size distribution by the word that study files use."""

HEIGHTS = Heights.registry
"""Every distribution of asperity heights by the word that study files use."""

LOADS = {
    name: declared.metadata["quantity"]
    for name, declared in {
        "F_star": quantity("F*", "1", "load F/(A_n E_ss)", gt=0),
        "pressure": quantity("p", "Pa", "nominal pressure", gt=0, hint="MPa are 5e6 or '5 MPa'"),
        "separation": quantity("d", "m", "separation d, from the mean asperity height"),
    }.items()
}
"""The ways to give a load, as quantities."""

ALSO_CALLED = {
    "normal": ("truncated-gaussian", "gaussian"),
    "gauss": ("truncated-gaussian", "gaussian"),
    "rosin-rammler": ("weibull",),
    "pearson": ("johnson",),
    "delta": ("monodisperse",),
    "single": ("monodisperse",),
    **dict.fromkeys(("turning", "lathed"), ("turned",)),
    **dict.fromkeys(("milling", "mill"), ("milled",)),
    **dict.fromkeys(("grinded", "grinding", "grind"), ("ground",)),
    **dict.fromkeys(("honing", "hone"), ("honed",)),
    **dict.fromkeys(("lapping", "lap"), ("lapped",)),
    **dict.fromkeys(("superfinishing", "superfinish"), ("superfinished",)),
    **dict.fromkeys(("polishing", "polish", "buffed"), ("polished",)),
    **dict.fromkeys(("blasting", "blast", "sandblasted", "peened"), ("blasted",)),
}
"""Other words for distributions and finishing processes, to suggest the right one."""


def nearest_option(
    word: str, options: Iterable[str], meanings: Mapping[str, str] = nearest.NO_MEANINGS
) -> str | None:
    """The option that was probably meant, by its spelling or by what it is said to be."""
    options = list(options)
    meant = (name for name in ALSO_CALLED.get(word.lower(), ()) if name in options)
    return nearest.nearest_name(next(meant, word), options, meanings)
