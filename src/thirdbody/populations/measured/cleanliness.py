r"""What engineers know of their particles: a concentration, a cleanliness code, a test dust.

All of them count particles per volume of fluid, n. The model counts particles per area,

.. math:: \eta_a = n\, h_{gap},

the particles in the column of fluid over a unit of area, of the height h_gap that closes. This
assumes that they follow the fluid: none is turned away at the inlet or flows out while the gap
closes, none gathers. For particles wider than the gap that is the only link between oil and
contact, and not a proven one; results are proportional to h_gap, so vary it.

Particles are spheres of the counted size. Counters calibrated after ISO 11171 give the diameter
of a circle with the projected area of the particle, written µm(c).
"""

from __future__ import annotations

import math
import re
import tomllib
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.arguments import names_arguments
from ...quantities.carried import takes_units
from ...quantities.units import MICRONS, not_among, say
from ..distributions import Distribution, PowerLaw
from .concentration import OIL_DENSITY, Concentration, concentration, particles_in

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = [
    "CLASSES",
    "DUSTS",
    "OIL_DENSITY",
    "TAIL_SLOPE",
    "Concentration",
    "class_of",
    "concentration",
    "counted_sizes",
    "dust_sizes",
    "iso4406_of",
    "iso4406_of_counts",
    "iso4406_range",
    "particles_in",
    "read_iso4406",
    "sizes_above",
    "suspension_of_class",
    "suspension_of_iso4406",
]

TAIL_SLOPE = 3.34
"""Fall of N(>x) ∝ x^(−s) from 14 to 70 µm(c) in every class of SAE AS4059."""

LARGEST = {"iso4406": 70e-6, "as4059": 100e-6, "nas1638": 100e-6}
"""Largest particle [m] of a population with each kind of code, where none is given."""

DUSTS = ("A1", "A2", "A3", "A4", "A3-lot")
"""The grades of ISO 12103-1 in this library, and one measured batch of A3."""

CLASSES = ("00", "0", *(str(i) for i in range(1, 13)))
"""Classes of NAS 1638; SAE AS4059 has 000 besides."""

Level = Literal["low", "middle", "high"]
LEVELS = get_args(Level)
"""Where in its range each number of an ISO 4406 code is taken."""

Limit = Literal["coarse", "middle", "fine"]
LIMITS = get_args(Limit)
"""Where between its printed limits a test dust is taken."""


@cache
def _table(name: str) -> dict[str, Any]:
    text = resources.files("thirdbody").joinpath(f"data/{name}.toml").read_text("utf-8")
    return tomllib.loads(text)


# ------------------------------------------------------------------------------ codes
def _falling(
    sizes: list[float], above: list[float], smallest: float | None, largest: float
) -> PowerLaw:
    """Power laws through cumulative counts, and beyond the last of them."""
    edges, counts, slopes = [sizes[0]], [], []
    for (x, n), (y, m) in zip(
        zip(sizes, above, strict=True),
        [*zip(sizes[1:], above[1:], strict=True), (largest, 0.0)],
        strict=True,
    ):
        edges.append(y)
        counts.append(n - m)
        slopes.append(math.log(n / m) / math.log(y / x) if m > 0 else TAIL_SLOPE)
    if smallest is not None and smallest < sizes[0]:
        edges.insert(0, smallest)
        counts.insert(0, above[0] * math.expm1(slopes[0] * math.log(sizes[0] / smallest)))
        slopes.insert(0, slopes[0])
    return PowerLaw(edges=tuple(edges), counts=tuple(counts), slopes=tuple(slopes))


@takes_units
def sizes_above(sizes: ArrayLike, *, counts: ArrayLike, largest: float) -> Distribution:
    """Sizes of particles that were counted above some sizes; power laws through the counts.

    Beyond the last size the count falls as from 14 µm(c) on in every class of SAE AS4059.

    Parameters
    ----------
    sizes : array (S,)
        Increasing sizes [m].
    counts : array (S,)
        Particles larger than each [1], in any unit; falling.
    largest : float
        End of the sizes [m], above the last of them.

    Raises
    ------
    InvalidValue
        An end that is not above the sizes.

    Examples
    --------
    >>> import thirdbody as tb
    >>> found = tb.dust.sizes_above([4e-6, 6e-6], counts=[2000.0, 500.0], largest=70e-6)
    >>> round(2000 * float(found.partial_moment(0, 6e-6, 1.0)), 6)
    500.0
    """
    x = [float(size) for size in np.ravel(np.asarray(sizes, float))]
    if not largest > x[-1]:
        rule = f"must be above {x[-1]:g} [m], the largest size that is counted"
        raise InvalidValue(
            Problem("largest", rule, f"{largest:g}", hint=MICRONS, code=Mistake.ORDER)
        )
    numbers = [float(n) for n in np.ravel(np.asarray(counts, float))]
    if len(numbers) != len(x):
        rule = f"must be a number for each of {len(x)} sizes"
        raise InvalidValue(Problem("counts", rule, f"{len(numbers)} numbers", code=Mistake.SHAPE))
    return _falling(x, numbers, None, largest)


def _check_ends(kind: str, sizes: list[float], smallest: float | None, largest: float) -> None:
    if smallest is not None and not 0 < smallest <= sizes[0]:
        rule = (
            f"must be above 0 and at most {sizes[0]:g} [m], the smallest size that the code counts"
        )
        raise InvalidValue(
            Problem("smallest", rule, f"{smallest:g}", hint=MICRONS, code=Mistake.RANGE)
        )
    if not (math.isfinite(largest) and largest > sizes[-1]):
        rule = f"must be above {sizes[-1]:g} [m], the largest size that the code counts"
        raise InvalidValue(
            Problem("largest", rule, f"{largest:g}", hint=MICRONS, code=Mistake.ORDER)
        )


@names_arguments
def read_iso4406(code: str) -> tuple[int | None, ...]:
    """The three numbers of a code, None where it has a dash.

    Parameters
    ----------
    code : str
        "18/16/13"; "-/16/13" where particles from 4 µm(c) are not reported.

    Returns
    -------
    tuple of int or None

    Raises
    ------
    InvalidValue
        Not three numbers, a number outside 0 to 28, or numbers that rise: particles from 6 µm(c)
        are among those from 4 µm(c), so there can never be more of them.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.dust.read_iso4406("18/16/13")
    (18, 16, 13)
    """
    most = len(_table("cleanliness")["iso4406"]["most"]) - 1
    shown = f"ISO 4406 code {say(code)}"
    if not isinstance(code, str):
        raise InvalidValue(
            f'{shown} must be three numbers in quotes, e.g. "18/16/13"', code=Mistake.SHAPE
        )
    parts = [text.strip() for text in re.sub(r"^\s*ISO(\s*4406)?[\s:]*", "", code).split("/")]
    if len(parts) == 2 and all(re.fullmatch(r"\d{1,2}", text) for text in parts):
        raise InvalidValue(
            f"{shown} has two numbers; they count from 6 and 14 µm(c), so write "
            f'"-/{parts[0]}/{parts[1]}"',
            code=Mistake.SHAPE,
        )
    if len(parts) != 3:
        raise InvalidValue(
            f'{shown} must be three numbers parted by slashes, e.g. "18/16/13", for the particles '
            "from 4, 6 and 14 µm(c)",
            code=Mistake.SHAPE,
        )
    numbers: list[int | None] = []
    for place, (text, size) in enumerate(zip(parts, (4, 6, 14), strict=True)):
        if text in "-–—" and text and place == 0:
            numbers.append(None)
            continue
        if not re.fullmatch(r"\d{1,3}", text):
            cause = "a whole number is needed"
            if text.startswith((">", "≥")):
                cause = (
                    "it is only a lower bound (few particles were counted, or too many); write "
                    "the number you take for it"
                )
            elif text == "*":
                cause = "there were too many to count; write the number you take for it"
            raise InvalidValue(
                f"{shown} has {say(text)} at {size} µm(c): {cause}", code=Mistake.FORM
            )
        if int(text) > most:
            raise InvalidValue(
                f"{shown} has {text} at {size} µm(c); the scale ends at {most}", code=Mistake.BEYOND
            )
        numbers.append(int(text))
    counted = [number for number in numbers if number is not None]
    if any(later > earlier for earlier, later in zip(counted, counted[1:], strict=False)):
        raise InvalidValue(
            f"{shown} is impossible: the numbers must fall or stay from ≥4 to ≥6 to ≥14 µm(c), "
            "because every larger particle is counted at the smaller sizes too; are they in the "
            "right order?",
            code=Mistake.ORDER,
        )
    return tuple(numbers)


@takes_units
def suspension_of_iso4406(
    code: str,
    *,
    level: Level = "middle",
    smallest: float | None = None,
    largest: float | None = None,
) -> tuple[float, Distribution]:
    r"""Particles per volume n [1/m³] and their sizes, from an ISO 4406 code.

    A code is a range of counts. Between 4, 6 and 14 µm(c) the cumulative count is taken as a
    power law, :math:`N(>x)\propto x^{-s}`, through both ends; beyond 14 µm(c) as one with s =
    3.34, the fall of the SAE AS4059 classes, ending at ``largest``. All three are assumptions:
    the code says nothing between and beyond its sizes.

    Parameters
    ----------
    code : str
        As in `read_iso4406`.
    level : {"low", "middle", "high"}, optional
        All counts at the low end of their range (just above the excluded end), at its geometric
        middle, or at its high end. Code 0 begins at no particles; its middle is 0.01/√2 per mL.
    smallest : float, optional
        Below 4e-6 m, continue the first power law down to there; by default nothing smaller.
    largest : float, optional
        End of the sizes [m], by default 70 µm.

    Returns
    -------
    tuple of float and Distribution

    Raises
    ------
    InvalidValue
        An impossible code, level or end.

    Notes
    -----
    The scale is that of ISO 4406, as printed by the sources named in the data file
    ``data/cleanliness.toml``.

    Examples
    --------
    >>> import thirdbody as tb
    >>> n, sizes = tb.dust.suspension_of_iso4406("18/16/13")
    >>> f"{n / 1e6:.0f} per mL from {sizes.support[0] * 1e6:.0f} µm"
    '1803 per mL from 4 µm'
    """
    scale = _table("cleanliness")["iso4406"]
    numbers = read_iso4406(code)
    if level not in LEVELS:
        raise InvalidValue(not_among("level", level, LEVELS))
    largest = LARGEST["iso4406"] if largest is None else largest
    counted = [
        (1e-6 * size, _count_in_range(scale["most"], number, level) / scale["volume"])
        for size, number in zip(scale["sizes"], numbers, strict=True)
        if number is not None
    ]
    sizes, above = (list(column) for column in zip(*counted, strict=True))
    _check_ends("iso4406", sizes, smallest, largest)
    if above[0] == 0:
        # no particles, in the sizes of the middle of the range
        return 0.0, suspension_of_iso4406(code, smallest=smallest, largest=largest)[1]
    distribution = _falling(sizes, above, smallest, largest)
    return sum(distribution.counts), distribution


def _count_in_range(most: list[float], number: int, level: Level) -> float:
    """A count per volume inside the range of a code number."""
    high = most[number]
    low = most[number - 1] if number else 0.0
    if level == "high":
        return high
    if level == "low":
        return low * (1 + 1e-6)
    return math.sqrt(low * high) if low else high / math.sqrt(2)


@takes_units
def iso4406_of(*, density: float, diameter: Distribution) -> str:
    """The ISO 4406 code of n particles per volume [1/m³] with these sizes.

    Parameters
    ----------
    density : float
        Particles per volume of fluid n [1/m³].
    diameter : Distribution
        Sizes by number [m].

    Returns
    -------
    str
        Such as "18/16/13". A count above the scale reads ">28"; counts equal an end of a range
        within 1e-9.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.dust.iso4406_of(density=300e6, diameter=tb.distributions.Monodisperse(mean=5e-6))
    '15/0/0'
    """
    scale = _table("cleanliness")["iso4406"]
    counts = np.array(_above(density, diameter, scale)) / scale["volume"]
    return iso4406_of_counts(counts)


@takes_units
def iso4406_of_counts(counts: ArrayLike) -> str:
    """The ISO 4406 code of counts from 4, 6 and 14 µm(c).

    Parameters
    ----------
    counts : array (3,)
        Particles per volume of fluid at and above each size [1/m³].

    Returns
    -------
    str
        As from `iso4406_of`; "-" for a count that is not known.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.dust.iso4406_of_counts([1803e6, 452e6, 57e6])
    '18/16/13'
    """
    scale = _table("cleanliness")["iso4406"]
    most = np.array(scale["most"]) * (1 + 1e-9)
    out = []
    for count in np.ravel(np.asarray(counts, float)) * scale["volume"]:
        if math.isnan(count):
            out.append("-")
            continue
        number = int(np.searchsorted(most, count))
        out.append(str(number) if number < len(most) else f">{number - 1}")
    return "/".join(out)


@names_arguments
def counted_sizes() -> tuple[float, ...]:
    """The sizes from which ISO 4406 counts, 4, 6 and 14 µm(c) [m].

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.dust.counted_sizes()
    (4e-06, 6e-06, 1.4e-05)
    """
    return tuple(1e-6 * size for size in _table("cleanliness")["iso4406"]["sizes"])


@takes_units
def iso4406_range(number: int) -> tuple[float, float]:
    """The counts that a number of an ISO 4406 code stands for [1/m³]: above one, up to another.

    Parameters
    ----------
    number : int
        From 0 to 28 [1].

    Examples
    --------
    >>> import thirdbody as tb
    >>> low, high = tb.dust.iso4406_range(18)
    >>> f"{low / 1e6:g} to {high / 1e6:g} per mL"
    '1300 to 2500 per mL'
    """
    scale = _table("cleanliness")["iso4406"]
    most = [count / scale["volume"] for count in scale["most"]]
    return (most[number - 1] if number else 0.0), most[number]


def _above(density: float, diameter: Distribution, scale: dict[str, Any]) -> list[float]:
    """Particles at and above each size of a scale, in its volume."""
    end = diameter.support[1]
    below = [np.nextafter(1e-6 * size, 0.0) for size in scale["sizes"]]
    return [
        float(density * scale["volume"] * diameter.partial_moment(0, x, max(end, x))) for x in below
    ]


@takes_units
def suspension_of_class(
    kind: str, name: str, *, smallest: float | None = None, largest: float | None = None
) -> tuple[float, Distribution]:
    """Particles per volume n [1/m³] and sizes of the dirtiest fluid of a class.

    Every size has its highest permitted count; power laws between, as for ISO 4406.

    Parameters
    ----------
    kind : {"as4059", "nas1638"}
        SAE AS4059 (cumulative counts, from 4 µm(c)) or NAS 1638 (the same counts from 6 µm(c)).
    name : str
        "000" (AS4059 only), "00", "0", "1" to "12".
    smallest, largest : float, optional
        As in `suspension_of_iso4406`; the largest is 100 µm by default.

    Returns
    -------
    tuple of float and Distribution

    Raises
    ------
    InvalidValue
        An unknown class, or an impossible end.

    Examples
    --------
    >>> import thirdbody as tb
    >>> n, sizes = tb.dust.suspension_of_class("nas1638", "6")
    >>> f"{n / 1e6:.0f} per mL"
    '195 per mL'
    """
    scale, limits = _class_table(kind)
    if not isinstance(name, str) or name not in limits:
        raise InvalidValue(
            f"{_TITLES[kind]} class {say(name)} must be one of {', '.join(map(say, limits))}, "
            "in quotes",
            code=Mistake.OPTION,
        )
    sizes = [1e-6 * size for size in scale["sizes"]]
    largest = LARGEST[kind] if largest is None else largest
    _check_ends(kind, sizes, smallest, largest)
    above = [most / scale["volume"] for most in limits[name]]
    if kind == "nas1638":
        above = [sum(above[i:]) for i in range(len(above))]
    filled = [i for i, count in enumerate(above) if count > 0]
    end = largest if len(filled) == len(sizes) else sizes[len(filled)]
    distribution = _falling([sizes[i] for i in filled], [above[i] for i in filled], smallest, end)
    return sum(distribution.counts), distribution


_TITLES = {"as4059": "SAE AS4059", "nas1638": "NAS 1638"}


def _class_table(kind: str) -> tuple[dict[str, Any], dict[str, list[int]]]:
    """The entry of a standard, and the highest counts of each of its classes."""
    if kind not in _TITLES:
        raise InvalidValue(not_among("standard", kind, _TITLES))
    scale = _table("cleanliness")[kind]
    return scale, scale["most" if kind == "as4059" else "within"]


@takes_units
def class_of(kind: str, *, density: float, diameter: Distribution) -> str:
    """The lowest class of `suspension_of_class` that permits these particles.

    Parameters
    ----------
    kind : {"as4059", "nas1638"}
    density : float
        Particles per volume of fluid n [1/m³].
    diameter : Distribution
        Sizes by number [m].

    Returns
    -------
    str
        The class, such as "6"; ">12" if none permits them.

    Examples
    --------
    >>> import thirdbody as tb
    >>> density, diameter = tb.dust.suspension_of_class("nas1638", "6")
    >>> tb.dust.class_of("nas1638", density=density, diameter=diameter)
    '6'
    """
    scale, limits = _class_table(kind)
    counts = _above(density, diameter, scale)
    if kind == "nas1638":
        counts = [a - b for a, b in zip(counts, [*counts[1:], 0.0], strict=True)]
    for name, most in limits.items():
        if all(
            count <= limit + 1e-9 * counts[0] for count, limit in zip(counts, most, strict=True)
        ):
            return name
    return f">{list(limits)[-1]}"


# ------------------------------------------------------------------------------ test dusts
def dust_table(name: str) -> dict[str, Any]:
    """The entry of a test dust as written in the data file, with its source.

    Raises
    ------
    InvalidValue
        A name that is not a grade.
    """
    dusts = _table("test_dust")
    if not isinstance(name, str) or name not in dusts:
        allowed = ", ".join(f"{say(key)} ({dust['name']})" for key, dust in dusts.items())
        raise InvalidValue(f"test dust {say(name)} must be one of {allowed}", code=Mistake.OPTION)
    return dusts[name]


@takes_units
def dust_sizes(
    name: str, *, limit: Limit = "middle", smallest: float | None = None
) -> Distribution:
    r"""Sizes by number of an Arizona test dust, ISO 12103-1.

    The standard prints between which limits the volume below a size lies. Between two sizes the
    volume is spread evenly over ln x, so dN ∝ dQ₃/x³ ∝ x⁻⁴ dx. Below the first size the same
    spread goes on until no volume is left, at 0.6 to 0.8 µm, or is cut or stretched to
    ``smallest``. Most particles by number lie there: the finest sizes rest on this assumption.

    Parameters
    ----------
    name : {"A1", "A2", "A3", "A4", "A3-lot"}
        Ultrafine, fine, medium, coarse; one batch of A3 as measured.
    limit : {"coarse", "middle", "fine"}, optional
        The lower printed limits, the middle between them, or the upper ones. A batch has no
        limits; all three are its curve.
    smallest : float, optional
        Size above which the volume below the first printed size lies [m].

    Returns
    -------
    Distribution

    Raises
    ------
    InvalidValue
        Unknown name or limit; ``smallest`` not below the first printed size.

    Notes
    -----
    A1 is the table of ISO 12103-1:2024 as a maker of the dust prints it. **A2, A3 and A4 are the
    limits of the 1997 edition and were not compared with a printed copy**; later editions use
    other sizes. Compare them with the certificate of your dust. One batch of A3, measured
    in 36 channels (Hagmeyer, Mauthe, Zeiler 2021, doi:10.36001/ijphm.2021.v12i2.3087), is
    ``"A3-lot"``; it is broader than the table and leaves its limits by up to 5 % of the volume.

    Examples
    --------
    >>> import thirdbody as tb
    >>> sizes = tb.dust.dust_sizes("A2")
    >>> volume = sizes.partial_moment(3, 0, 10e-6) / sizes.moment(3)
    >>> round(float(volume), 6)  # printed: 50 to 54 %
    0.52
    """
    dust = dust_table(name)
    if limit not in LIMITS:
        raise InvalidValue(not_among("limit", limit, LIMITS))
    pick = {"coarse": (1.0, 0.0), "middle": (0.5, 0.5), "fine": (0.0, 1.0)}[limit]
    x = np.array([1e-6 * row[0] for row in dust["finer"]])
    Q = np.array([pick[0] * row[1] + pick[1] * row[2] for row in dust["finer"]]) / 100
    if smallest is None:
        smallest = float(x[0] * (x[1] / x[0]) ** (-Q[0] / (Q[1] - Q[0])))
    if not 0 < smallest < x[0]:
        rule = f"must be above 0 and below {x[0]:g} [m], the first size of the table"
        hint = "um are 1e-6 or '0.5 um'"
        raise InvalidValue(
            Problem("smallest", rule, f"{smallest:g}", hint=hint, code=Mistake.ORDER)
        )
    edges = np.concatenate([[smallest], x])
    volume = np.diff(np.concatenate([[0.0], Q]))
    low, high = edges[:-1] / smallest, edges[1:] / smallest
    # ∫x^(−3) d ln x over the width in ln x
    number = volume * (low**-3 - high**-3) / (3 * np.log(high / low))
    return PowerLaw(edges=tuple(edges), counts=tuple(number), slopes=(3.0,) * len(number))
