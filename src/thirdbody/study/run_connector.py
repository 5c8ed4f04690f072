"""A study of a connector: how often its contacts stay open on dust, and what that hangs on."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np

from ..errors import InvalidValue, Note
from ..quantities.record import column
from ..quantities.say import number, percent
from ..systems.connector import Connector
from .asked_result import AskedResult, answer_entries
from .connector import AskedConnector, connector_of
from .what_ifs import HARDNESS, WhatIf
from .whole import load_tables

__all__ = ["ConnectorResult", "load_connector", "run_connector"]

NEEDED = frozenset({"surfaces", "particles", "connector"})
AROUND = (0.25, 0.5, 1.0, 2.0, 4.0)
"""Forces of the table over the one that is asked for."""
REACH, POINTS = 20.0, 41
"""The curve goes so far below and above the forces, by so many points."""
SIZES = 1.25
"""What sizes may be off by, as a factor."""
VAGUE = 0.2
"""Width of the bounds over the failure from which a note tells of it."""


def load_connector(path: str | os.PathLike[str], overrides: Iterable[str] = ()) -> AskedConnector:
    """The connector of a study file, which needs no roughness and no load.

    Parameters
    ----------
    path : path-like
        A TOML file with tables [surfaces], [particles] and [connector].
    overrides : iterable of str, optional
        As those of `thirdbody.load_study`.

    Raises
    ------
    InvalidValue
        Every mistake of the file.
    """
    return load_tables(path, overrides, connector_of, NEEDED)


@dataclass(frozen=True, eq=False, kw_only=True)
class ConnectorResult(AskedResult):
    """Results of `run_connector`; indexed, they are the plain data of `to_dict`.

    Attributes
    ----------
    asked : AskedConnector
    places : tuple of int
        The forces that were asked for, among those of the table.
    """

    in_dict = answer_entries(
        (("connector", "asked.connector"), ("force", "asked.forces")), "in_the_way", "threshold"
    )
    asked: AskedConnector
    places: tuple[int, ...]
    force: np.ndarray = column("W", "N", "contact force of each contact")
    failure: np.ndarray = column("f", "1", "how often one spot stays open")
    failure_low: np.ndarray = column("f_low", "1", "the least that rounding allows")
    failure_high: np.ndarray = column("f_high", "1", "the most that rounding allows")
    failure_of_all: np.ndarray = column("f_all", "1", "how often the connector stays open")
    in_the_way: float = 0.0
    threshold: float = 0.0

    title_without = "Connector"
    citations = (
        "Williamson, Greenwood, Harris 1956, Proc. R. Soc. A 237, 560, doi:10.1098/rspa.1956.0197",
        "Panjer 1981, ASTIN Bulletin 12, 22, doi:10.1017/S0515036100006796",
    )

    @property
    def failure_of_contact(self) -> np.ndarray:
        """How often one contact stays open: all of its spots do [1]."""
        return self.failure**self.asked.connector.parallel

    def curve(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Forces around those of the study, and how often one contact and all of them stay open."""
        plug, study_forces = self.asked.connector, self.asked.forces
        forces = np.geomspace(study_forces[0] / REACH, study_forces[-1] * REACH, POINTS)
        one = plug.failures(forces)
        every = np.array([plug.of_all(float(failure)) for failure in one])
        return forces, one**plug.parallel, every


def run_connector(request: AskedConnector) -> ConnectorResult:
    """How often a connector stays open, under the forces of its study.

    One force is told with others about it.

    Parameters
    ----------
    request : AskedConnector
        As `load_connector` reads it.

    Examples
    --------
    >>> import numpy as np
    >>> import thirdbody as tb
    >>> from thirdbody.study.connector import AskedConnector
    >>> bronze = tb.materials["CuSn8"]
    >>> dust = tb.Particles(material=tb.materials["quartz"], areal_density=1e5,
    ...                     diameter=tb.LogNormal(median=8e-6, gsd=1.5))
    >>> plug = Connector(radius=2e-3, surfaces=tb.MaterialPair(bronze, bronze), particles=dust,
    ...                  contacts=20)
    >>> found = run_connector(AskedConnector(title="", connector=plug, forces=np.array([0.5])))
    >>> [f"{each:.4f}" for each in found.failure_of_all]
    ['0.0653', '0.0231', '0.0047', '0.0005', '0.0000']
    """
    plug, forces = request.connector, request.forces
    one = len(forces) == 1
    shown = forces[0] * np.array(AROUND) if one else forces
    bounds = np.array([plug.bounds(float(force)) for force in shown])
    middle = bounds.mean(axis=1)
    result = ConnectorResult(
        asked=request,
        places=(AROUND.index(1.0),) if one else tuple(range(len(forces))),
        force=shown,
        failure=middle,
        failure_low=bounds[:, 0],
        failure_high=bounds[:, 1],
        failure_of_all=np.array([plug.of_all(failure) for failure in middle]),
        in_the_way=plug.in_the_way,
        threshold=plug.threshold,
    )
    at = result.places[0]
    notes = [*_bounds_note(result, at), *_breaking_note(plug)]
    what_ifs = _what_ifs(plug, float(shown[at]))
    return replace(result, what_ifs=what_ifs, run_warnings=tuple(notes))


def _what_ifs(plug: Connector, force: float) -> tuple[WhatIf, ...]:
    """Effect of each uncertain input, varied alone; without those that would be no connector."""
    pair = plug.surfaces

    def with_dust(number: float = 1.0, size: float = 1.0) -> Connector:
        return plug.replace(
            particles=tuple(
                dust.replace(
                    areal_density=dust.areal_density * number, diameter=dust.diameter.scaled(size)
                )
                for dust in plug.particles
            )
        )

    def with_hardness(factor: float) -> Connector:
        return plug.replace(
            surfaces=pair.replace(
                first=pair.first.replace(H=pair.first.H * factor),
                second=pair.second.replace(H=pair.second.H * factor),
            )
        )

    ends: list[tuple[dict[str, str], tuple[Callable[[], Connector], ...]]] = [
        (
            {
                "what": "the number of particles",
                "between": "half and twice as many",
                "action": "count the dust on your contacts, e.g. from a tape lift",
            },
            (lambda: with_dust(0.5), lambda: with_dust(2.0)),
        ),
        (
            {
                "what": "the size of the particles",
                "between": f"{percent(1 - 1 / SIZES)} smaller and {percent(SIZES - 1)} larger",
                "action": "measure the sizes of the dust on your contacts, above all the largest",
            },
            (lambda: with_dust(size=1 / SIZES), lambda: with_dust(size=SIZES)),
        ),
        (
            {
                "what": "the hardness of the contacts",
                "between": f"{percent(1 - 1 / HARDNESS)} softer and {percent(HARDNESS - 1)} harder",
                "action": "measure the hardness of the plated contact itself",
            },
            (lambda: with_hardness(1 / HARDNESS), lambda: with_hardness(HARDNESS)),
        ),
    ]
    if plug.wipe > 0 and plug.pushed_aside is None:
        wipe = {
            "what": "what the wipe pushes aside",
            "between": "all of the dust before it and none, as taken",
            "action": "give connector.pushed_aside from a test with and without wipe",
            "code": "wipe",
        }
        ends.append((wipe, (lambda: plug.replace(pushed_aside=1.0), lambda: plug)))
    out = []
    for words, plugs in ends:
        with contextlib.suppress(InvalidValue):  # twice the dust may be more than there is room for
            values = tuple(make_plug().failure_of_all(force) for make_plug in plugs)
            out.append(WhatIf(**words, values=values))
    return tuple(sorted(out, key=lambda what_if: -what_if.ratio))


def _bounds_note(result: ConnectorResult, at: int) -> list[Note]:
    """Note where rounding blurs the answer."""
    low, high = result.failure_low[at], result.failure_high[at]
    if not high > 0 or (high - low) < VAGUE * high:
        return []
    return [
        Note(
            f"one contact stays open between {number(low, 2)} and {number(high, 2)} of the time: "
            "the force is at a jump, where particles of one size are just pressed in",
            code="jump",
            effect=(high - low) / high,
            action='give the dust its spread of sizes, e.g. distribution = "log-normal"',
        )
    ]


def _breaking_note(plug: Connector) -> list[Note]:
    """Dust that is not pressed in whole."""
    return [
        Note(
            f"most particles of {name} of the mean size would break before they are pressed in; "
            "they count as whole here; the contacts fail less often where the pieces carry less, "
            "and more often where they spread",
            code="brittle",
            action="take the answer for dust that stays whole, or measure with and without force",
        )
        for name in plug.breaking()
    ]
