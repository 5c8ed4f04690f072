r"""What a bearing standard makes of dirty oil: the contamination factor and life factor of ISO 281.

.. math:: e_C = a\left(1-\frac{b}{D^{1/3}}\right), \qquad a = \min(1,\,c\,\kappa^{0.68}D^{0.55})

with the pitch diameter D of the bearing in millimetres. The factors of this module are a
cross-check of the **order** in which oils come out, not of a number: e_C belongs to a cleanliness
code and a whole bearing, what `thirdbody.systems.oil_particles` computes to particles and their
dents. Neither is calibrated to the other.
"""

from __future__ import annotations

import math

from ..errors import InvalidValue, Mistake, Problem
from ..populations.measured.cleanliness import read_iso4406
from ..quantities.arguments import not_positive
from ..quantities.carried import takes_units
from ..quantities.units import say

__all__ = [
    "BEARINGS",
    "FROM_MEMORY",
    "GREASES",
    "OILS",
    "contamination_factor",
    "life_factor",
    "reference_viscosity",
    "viscosity_ratio",
]


def __dir__() -> list[str]:
    return sorted(__all__)


OILS: dict[str, dict[str, tuple[float, float]]] = {
    "filter": {
        "-/13/10": (0.0864, 0.5663),
        "-/15/12": (0.0432, 0.9987),
        "-/17/14": (0.0288, 1.6329),
        "-/19/16": (0.0216, 2.3362),
    },
    "bath": {
        "-/13/10": (0.0864, 0.6796),
        "-/15/12": (0.0288, 1.141),
        "-/17/14": (0.0133, 1.67),
        "-/19/16": (0.00864, 2.5164),
        "-/21/18": (0.00411, 3.8974),
    },
}
"""c and b of oil with an on-line filter, and of an oil bath or off-line filter, by code."""

GREASES: dict[str, tuple[float, float]] = {
    "high cleanliness": (0.0864, 0.6796),
    "normal cleanliness": (0.0432, 1.141),
    "slight contamination": (0.0177, 1.887),
    "severe contamination": (0.0115, 2.662),
    "very severe contamination": (0.00617, 4.06),
}
"""c and b of grease; slight contamination has another b from D = 500 mm on, `LARGE`."""

LARGE = (0.5, 1.677)

FROM_MEMORY = frozenset(
    [
        *(("filter", code) for code in OILS["filter"]),
        *(("bath", code) for code in OILS["bath"] if code != "-/13/10"),
        *(("grease", word) for word in GREASES),
    ]
)
"""Rows from memory: not confirmed in a source. Slight contamination is confirmed from 500 mm on."""

BEARINGS: dict[str, tuple[float, float, float, float]] = {
    "ball": (2.5671, 0.83, 1 / 3, 9.3),
    "roller": (1.5859, 1.0, 0.4, 9.185),
}
"""Constant and three exponents of the life factor of radial bearings."""

OF_KAPPA = {
    "ball": ((0.4, 2.2649, 0.054381), (1.0, 1.9987, 0.19087), (4.0, 1.9987, 0.071739)),
    "roller": ((0.4, 1.3993, 0.054381), (1.0, 1.2348, 0.19087), (4.0, 1.2348, 0.071739)),
}
"""C and p of C/κ^p up to each κ."""

KAPPA = (0.1, 4.0)
MOST = 50.0
"""The largest life factor."""
PLACES = ("filter", "bath", "grease")


def _positive(**values: float) -> None:
    if wrong := not_positive(**values):
        raise InvalidValue(*wrong)


def _kappa(kappa: float) -> float:
    _positive(kappa=kappa)
    if kappa < KAPPA[0]:
        raise InvalidValue(
            Problem(
                "kappa",
                f"must be at least {KAPPA[0]:g}: below, ISO 281 gives no factor (is the "
                "viscosity that at the working temperature?)",
                f"{kappa:g}",
                code=Mistake.RANGE,
            )
        )
    return min(kappa, KAPPA[1])


@takes_units
def reference_viscosity(turns: float, *, D: float) -> float:
    r"""Viscosity ν_1 that a bearing needs for an adequate film.

    .. math:: \nu_1 = 45000\,n^{-0.83} D^{-1/2}\ (n<1000), \qquad 4500\,(n D)^{-1/2}
              \quad[\mathrm{mm^2/s}]

    with n in revolutions per minute and D in millimetres.

    Parameters
    ----------
    turns : float
        Revolutions per second [1/s]; 1500 rpm are 25.
    D : float
        Pitch diameter, the mean of bore and outer diameter [m].

    Returns
    -------
    float
        Kinematic viscosity ν_1 [m²/s].

    Notes
    -----
    The two branches differ by 2.3 % at 1000 rpm.

    References
    ----------
    ISO 281:2007.

    Examples
    --------
    >>> from thirdbody.systems.bearing_life import reference_viscosity
    >>> round(reference_viscosity(25.0, D=0.05) * 1e6, 3)
    16.432
    """
    _positive(turns=turns, D=D)
    rpm, mm = 60 * turns, 1e3 * D
    if rpm < 1000:
        return 1e-6 * 45000 * rpm**-0.83 / math.sqrt(mm)
    return 1e-6 * 4500 / math.sqrt(rpm * mm)


@takes_units
def viscosity_ratio(viscosity: float, *, turns: float, D: float) -> float:
    r"""Viscosity ratio of ISO 281.

    .. math:: \kappa = \nu/\nu_1

    Parameters
    ----------
    viscosity : float
        Kinematic viscosity ν at the working temperature [m²/s].
    turns, D : float
        As in `reference_viscosity`, which gives ν_1 [1/s], [m].

    Returns
    -------
    float
        κ [1].

    Examples
    --------
    >>> from thirdbody.systems.bearing_life import viscosity_ratio
    >>> round(viscosity_ratio(32e-6, turns=25.0, D=0.05), 3)
    1.947
    """
    _positive(viscosity=viscosity)
    return viscosity / reference_viscosity(turns, D=D)


def _row(place: str, state: str, D: float) -> tuple[float, float]:
    if place not in PLACES:
        raise InvalidValue(
            Problem(
                "place",
                f"must be one of {', '.join(map(say, PLACES))}",
                f"{say(place)}",
                code=Mistake.OPTION,
            )
        )
    if place == "grease":
        if state not in GREASES:
            greases = ", ".join(map(say, GREASES))
            raise InvalidValue(
                f"grease state = {say(state)} must be one of {greases}", code=Mistake.OPTION
            )
        c, b = GREASES[state]
        return (c, LARGE[1]) if state == "slight contamination" and D >= LARGE[0] else (c, b)
    counted = [number or 0 for number in read_iso4406(state)[1:]]
    for code, row in OILS[place].items():
        if all(n <= (m or 0) for n, m in zip(counted, read_iso4406(code)[1:], strict=True)):
            return row
    raise InvalidValue(
        f"ISO 4406 code {say(state)} is dirtier than the last one with a factor here, "
        f"{say(list(OILS[place])[-1])} for place = {say(place)}",
        code=Mistake.BEYOND,
    )


@takes_units
def contamination_factor(place: str, state: str, *, kappa: float, D: float) -> float:
    """Contamination factor e_C of ISO 281: 1 for clean oil, towards 0 for dirty oil.

    Parameters
    ----------
    place : {"filter", "bath", "grease"}
        Circulating oil with an on-line filter, an oil bath or oil filtered off-line, or grease.
    state : str
        ISO 4406 code of the oil, "-/15/12" or "18/15/12", or a key of `GREASES`. A code between
        two rows takes the dirtier of them.
    kappa : float
        Viscosity ratio κ, at least 0.1; above 4 it counts as 4 [1].
    D : float
        Pitch diameter [m].

    Returns
    -------
    float
        e_C [1].

    Raises
    ------
    InvalidValue
        κ below 0.1, a code dirtier than the last row, or a bearing so small that the formula gives
        no positive factor, D ≤ b³ mm.

    Notes
    -----
    The bath at "-/13/10" and grease with slight contamination from 500 mm on are confirmed in
    public implementations. All other constants are from memory: not confirmed in a source
    (`FROM_MEMORY`). The filter rows assume filters that let through at most one particle of 200 at
    6 and 12 µm(c) and one of 75 at 25 and 40 µm(c), also from memory.

    References
    ----------
    ISO 281:2007, annex A.

    Examples
    --------
    >>> from thirdbody.systems.bearing_life import contamination_factor
    >>> round(contamination_factor("bath", "-/13/10", kappa=1.0, D=0.05), 6)
    0.605879
    >>> round(contamination_factor("filter", "18/15/12", kappa=0.5, D=0.1), 6)
    0.266417
    """
    kappa = _kappa(kappa)
    _positive(D=D)
    c, b = _row(place, state, D)
    mm = 1e3 * D
    clean = 1 - b / mm ** (1 / 3)
    if clean <= 0:
        raise InvalidValue(
            Problem(
                "D",
                f"must be above {0.001 * b**3:.3g} [m], where the factor of this row reaches 0; "
                "mm are 1e-3",
                f"{D:g}",
                code=Mistake.ORDER,
            )
        )
    return min(1.0, c * kappa**0.68 * mm**0.55) * clean


@takes_units
def life_factor(bearing: str, *, kappa: float, load: float) -> float:
    r"""Life modification factor a_ISO of radial bearings: rating life is a_1 a_ISO L_10.

    .. math:: a_{ISO} = 0.1\left[1-\left(A-\frac{C}{\kappa^p}\right)^{m}
              \left(\frac{e_C C_u}{P}\right)^{n}\right]^{-q} \le 50

    Parameters
    ----------
    bearing : {"ball", "roller"}
    kappa : float
        Viscosity ratio κ, at least 0.1; above 4 it counts as 4 [1].
    load : float
        e_C C_u/P: contamination factor times fatigue load limit over equivalent load [1].

    Returns
    -------
    float
        a_ISO [1], at most 50.

    Raises
    ------
    InvalidValue
        Another bearing, κ below 0.1, or a load factor that is not positive.

    Notes
    -----
    C and p change at κ = 0.4 and 1. The branches join: at 0.4 within 4e-4 for balls.

    References
    ----------
    ISO 281:2007.

    Examples
    --------
    >>> from thirdbody.systems.bearing_life import life_factor
    >>> round(life_factor("ball", kappa=0.7, load=0.1), 6)
    1.127238
    """
    if bearing not in BEARINGS:
        raise InvalidValue(
            Problem(
                "bearing", "must be one of 'ball', 'roller'", f"{say(bearing)}", code=Mistake.OPTION
            )
        )
    kappa = _kappa(kappa)
    _positive(load=load)
    A, m, n, q = BEARINGS[bearing]
    C, p = next((C, p) for top, C, p in OF_KAPPA[bearing] if kappa < top or top == KAPPA[1])
    inner = 1 - max(A - C / kappa**p, 0.0) ** m * load**n
    return MOST if inner <= 0 else min(MOST, 0.1 * inner**-q)
