"""What a designation of a deep-groove ball bearing stands for: dimensions, balls, clearance."""

from __future__ import annotations

import math
import re
import tomllib
from functools import cache
from importlib import resources
from typing import Any, NamedTuple

from ..errors import InvalidValue, Mistake, Problem
from ..quantities.arguments import names_arguments
from ..quantities.nearest import guess
from ..quantities.units import say
from .machine_elements import BallBearing

__all__ = ["DESIGNATIONS", "BearingSize", "bearing_size"]


def __dir__() -> list[str]:
    return sorted(__all__)


FILL = 0.6
"""Part of the pitch circle that balls of a Conrad bearing take, in angle."""
BALL = 0.3
"""Ball diameter over half the room between bore and outer diameter, halved: D_w = 0.3 (D − d)."""

ROLLERS = (
    "`thirdbody new roller-bearing` takes the dimensions of cylindrical rollers under a radial load"
)
ONE_ROLLER = (
    "`thirdbody new rolling-bearing` takes diameter and length of one roller, and the force on it"
)
ONE_BALL = (
    'of one ball, kind = "ball-in-groove" in [body] takes diameter, conformity, pitch_diameter and '
    "contact_angle, and load.force what presses it"
)
FLAT_BALL = (
    'kind = "ball-in-groove" in [body] takes diameter, conformity and number of the balls '
    "(bodies), and load.force what presses all of them"
)
BARREL = (
    'its rollers are barrels: film.conjunction = { shape = "point", R = "...", R_y = "..." } and '
    "film.load take the contact of one"
)
DIMENSIONS = 'give bore x outer diameter x width in mm, e.g. "25x52x15"'
UNLISTED = "a deep-groove ball bearing that is not in the list here"
KINDS = (
    (r"R?NA ?\d|[HB]K ?\d|NKI?S? ?\d{2}", "a needle roller bearing", ONE_ROLLER),
    (r"N[A-Z]{0,3} ?\d{3}|RNU ?\d", "a cylindrical roller bearing", ROLLERS),
    (r"7\d{3}(?!\d)", "an angular contact ball bearing", ONE_BALL),
    (r"(3[23]|5[23])\d{2}(?!\d)", "a double-row angular contact ball bearing", ONE_BALL),
    (r"QJ ?\d", "a four-point contact ball bearing", ONE_BALL),
    (r"[12][0-3]\d{2}(?!\d)", "a self-aligning ball bearing", ONE_BALL),
    (r"4[23]\d{2}(?!\d)", "a double-row deep-groove ball bearing", ONE_BALL),
    (r"5[1-4]\d{3}(?!\d)", "a thrust ball bearing", FLAT_BALL),
    (r"3[0-3]\d{3}(?!\d)", "a tapered roller bearing", ONE_ROLLER),
    (r"29[2-4]\d{2}(?!\d)", "a spherical roller thrust bearing", BARREL),
    (r"2[1-4]\d{3}(?!\d)", "a spherical roller bearing", BARREL),
    (r"8[1-9]\d{3}(?!\d)", "a cylindrical roller thrust bearing", ONE_ROLLER),
    (r"(6[0-37-9]\d\d|6[12]8\d\d|16\d{3}|6[023]/\d\d|6[0-389][3-9])(?!\d)", UNLISTED, DIMENSIONS),
)
"""Other designations: how they begin, what they are, and what can be done with them."""


@cache
def _table() -> dict[str, Any]:
    text = resources.files("thirdbody").joinpath("data/bearings.toml").read_text("utf-8")
    return tomllib.loads(text)


DESIGNATIONS = tuple(_table()["size"])
"""Designations that are known."""


class BearingSize(NamedTuple):
    """What a designation, or the dimensions of a bearing, stand for.

    Examples
    --------
    >>> from thirdbody.systems.bearing_sizes import bearing_size
    >>> found = bearing_size("6205-2RS/C3")
    >>> found.name, found.outer_diameter, found.balls, found.clearance
    ('6205', 0.052, 9, (1.3e-05, 2.8e-05))
    """

    name: str
    """Designation, or the dimensions as given."""
    bore: float
    """d [m]."""
    outer_diameter: float
    """D [m]."""
    width: float
    """B [m]."""
    balls: int
    """Z [1]."""
    ball_diameter: float
    """D_w [m]."""
    clearance: tuple[float, float]
    """Least and most radial internal clearance of its class, unmounted [m]."""
    clearance_class: str
    """Of ISO 5753: C2, CN, C3 or C4."""
    estimated: bool
    """Whether number and diameter of the balls follow from the dimensions alone."""

    @names_arguments
    def bearing(self, **others: Any) -> BallBearing:
        """The bearing, with the least clearance of its class unless one is given."""
        dimensions = {
            "bore": self.bore,
            "outer_diameter": self.outer_diameter,
            "ball_diameter": self.ball_diameter,
            "balls": float(self.balls),
            "clearance": self.clearance[0],
        }
        return BallBearing(**(dimensions | others))


@names_arguments
def bearing_size(which: str) -> BearingSize:
    """The bearing of a designation such as 6205 or 6305-2RS/C3, or of dimensions as 25x52x15.

    Parameters
    ----------
    which : str
        Series 6000, 6200 and 6300 from 10 to 60 mm bore; C2, C3 or C4 after it names the class of
        clearance, and other suffixes count for nothing. Or bore x outer diameter x width [mm].

    Returns
    -------
    BearingSize

    Raises
    ------
    InvalidValue
        Another designation, or dimensions of no bearing.

    Notes
    -----
    Dimensions are those of ISO 15, clearances those of ISO 5753. Number and diameter of the balls
    are typical values, from memory; of bare dimensions they are D_w = 0.3 (D − d), and as many as
    fill 0.6 of the circle. The file ``data/bearings.toml`` says what was confirmed where.
    """
    if not isinstance(which, str):
        raise InvalidValue(
            Problem(
                "which",
                "must be a designation in quotes, e.g. '6205'",
                repr(which),
                code=Mistake.KIND,
            )
        )
    text = which.strip().upper().replace("×", "X")
    if sides := re.fullmatch(r"([\d.]+)\s*X\s*([\d.]+)\s*X\s*([\d.]+)\s*(?:MM)?(.*)", text):
        bore, outer, width = (float(length) for length in sides.groups()[:3])
        return _of_dimensions(which, bore, outer, width, sides[4])
    sizes = _table()["size"]
    match = re.match(r"(\d{4,5})(?!\d)(.*)", text)
    if match is None or match[1] not in sizes:
        if other := _other_bearing(text):
            raise InvalidValue(
                Problem(
                    "",
                    f"{say(which)} is {other[0]}; those known by their designation are deep-groove "
                    "ball bearings 6000 to 6012, 6200 to 6212 and 6300 to 6312",
                    hint=other[1],
                    code=Mistake.KIND,
                )
            )
        hint = guess(match[1] if match else text, sizes, otherwise=None) if text else None
        raise InvalidValue(
            Problem(
                "",
                f"{say(which)} must be a deep-groove ball bearing 6000 to 6012, 6200 to 6212 or "
                '6300 to 6312, or its bore x outer diameter x width in mm, e.g. "25x52x15"',
                hint=hint or "",
                code=Mistake.KIND,
            )
        )
    bore, outer, width, balls, ball = sizes[match[1]]
    name, limits = _clearance(bore, match[2])
    d, D, B = _mm(bore), _mm(outer), _mm(width)
    return BearingSize(match[1], d, D, B, balls, _mm(ball), limits, name, False)


def _other_bearing(text: str) -> tuple[str, str] | None:
    """What a designation is that no deep-groove ball bearing here has, and what can be done.

    >>> _other_bearing("NU205")[0], _other_bearing("7205 B")[0], _other_bearing("51105")[0]
    ('a cylindrical roller bearing', 'an angular contact ball bearing', 'a thrust ball bearing')
    """
    for begins, what, action in KINDS:
        if re.match(begins, text):
            return what, action
    return None


def _of_dimensions(which: str, bore: float, outer: float, width: float, suffix: str) -> BearingSize:
    """The bearing with balls as large and as many as usual."""
    largest = _table()["clearance"]["bores"][-1]
    if not (0 < bore < outer and width > 0):
        raise InvalidValue(
            f"{say(which)}: bore, outer diameter and width in mm must rise from bore to outer "
            'diameter and be above 0, e.g. "25x52x15"',
            code=Mistake.ORDER,
        )
    if bore > largest:
        raise InvalidValue(
            f"{say(which)}: the bore must be at most {largest} mm", code=Mistake.RANGE
        )
    ball = round(BALL * (outer - bore), 3)
    balls = max(3, round(FILL * math.pi / math.asin(2 * ball / (bore + outer))))
    name, limits = _clearance(bore, suffix)
    return BearingSize(
        which.strip(), _mm(bore), _mm(outer), _mm(width), balls, _mm(ball), limits, name, True
    )


def _clearance(bore: float, suffix: str) -> tuple[str, tuple[float, float]]:
    """Name and limits [m] of the class of clearance, normal unless the suffix names another."""
    table = _table()["clearance"]
    match = re.search(r"(?<![A-Z0-9])(C[N234])(?![0-9])", suffix)
    name = match[1] if match else "CN"
    row = next(i for i, top in enumerate(table["bores"]) if bore <= top)
    least, most = table[name][row]
    return name, (round(1e-6 * least, 9), round(1e-6 * most, 9))


def _mm(value: float) -> float:
    return round(1e-3 * value, 9)
