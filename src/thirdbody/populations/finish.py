"""Roughness as drawings state it: a height of each face, and how the face was finished."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from itertools import product
from typing import Any, NamedTuple

from ..errors import InvalidValue, Mistake, Problem
from ..quantities.say import join_words, number, value_of
from ..quantities.value import Value, problem_with, quantity

__all__ = ["STATED", "Drawing", "Finish", "drawing", "processes", "slopes"]

RQ_OVER_RA = math.sqrt(math.pi / 2)
"""Rq/Ra of Gaussian heights."""
ETA_R_SIGMA_OVER_ROOT_ALPHA = 3 / 8 / (6 * math.sqrt(3 * math.pi))
"""ηRσ/√α of an isotropic Gaussian surface (Nayak 1971)."""
STATED = {
    name: declared.metadata["quantity"]
    for name, declared in {
        "Ra": quantity("Ra", "m", "mean deviation of the profile", gt=0, hint="µm are 0.2e-6"),
        "Rq": quantity("Rq", "m", "RMS height of the profile", gt=0, hint="µm are 0.2e-6"),
        "Rz": quantity("Rz", "m", "mean peak-to-valley height", gt=0, hint="µm are 1.6e-6"),
    }.items()
}
"""The heights that drawings state, as quantities."""


@cache
def _tables() -> dict[str, Any]:
    text = resources.files("thirdbody").joinpath("data/finishes.toml").read_text("utf-8")
    return tomllib.loads(text)


def processes() -> dict[str, dict[str, Any]]:
    """Every finishing process by its word: reach of Ra [m], range of RMS slopes of profiles [1] at
    one Ra [m].

    Examples
    --------
    >>> processes()["ground"]["slope"]
    [0.05, 0.2]
    """
    return dict(_tables()["process"])


def slopes(process: str, Rq: float) -> tuple[float, float]:
    """Range of the RMS slopes of profiles [1] of a face with this height [m].

    Examples
    --------
    >>> [round(s, 3) for s in slopes("ground", 0.1 * 1.2533e-6)]
    [0.025, 0.1]
    """
    entry = processes()[process]
    scale = (Rq / RQ_OVER_RA / entry["at"]) ** _tables()["slopes"]["power"]
    low, high = entry["slope"]
    return scale * low, scale * high


@dataclass(frozen=True, slots=True, kw_only=True)
class Finish(Value):
    r"""Roughness of one face as its drawing states it.

    .. math:: R_q = \sqrt{\pi/2}\,R_a, \qquad R_z = 4 \dots 8\,R_a

    Parameters
    ----------
    Ra, Rq, Rz : float
        One of them [m].
    process : str, optional
        How the face was finished; without it the asperity radius must be known otherwise.

    Raises
    ------
    InvalidValue
        No height or several, an unknown process, or a height that the process does not reach.

    Examples
    --------
    >>> import thirdbody as tb
    >>> ground = tb.surfaces.Finish(Ra=0.2e-6, process="ground")
    >>> round(ground.heights[1] * 1e9, 1)
    250.7
    """

    Ra: float | None = None
    Rq: float | None = None
    Rz: float | None = None
    process: str | None = None

    def _problems(self) -> list[str]:
        stated = [name for name in STATED if getattr(self, name) is not None]
        if len(stated) != 1:
            shown = f", not {' and '.join(stated)}" if stated else ""
            return [
                Problem(
                    "",
                    f"needs exactly one of Ra, Rq and Rz{shown}",
                    owner=type(self).__name__,
                    code=Mistake.MISSING,
                )
            ]
        name = stated[0]
        if why := problem_with(STATED[name], getattr(self, name)):
            return [Problem(name, why, repr(getattr(self, name)))]
        object.__setattr__(self, name, float(getattr(self, name)))
        if self.process is None:
            return []
        if self.process not in processes():
            return [
                Problem(
                    "process",
                    f"must be one of {', '.join(processes())}",
                    repr(self.process),
                    code=Mistake.OPTION,
                )
            ]
        low, high = processes()[self.process]["Ra"]
        Ra = self.heights[1] / RQ_OVER_RA
        if low <= Ra <= high:
            return []
        Ra_text = f" (Ra about {value_of(Ra, 'm')})" if name != "Ra" else ""
        return [
            Problem(
                f"{name}",
                f"= {value_of(getattr(self, name), 'm')}{Ra_text} is not the height of a "
                f"{self.process} face, Ra from {value_of(low, 'm')} to {value_of(high, 'm')}; "
                "check its unit and the process",
                code=Mistake.BEYOND,
            )
        ]

    @property
    def heights(self) -> tuple[float, float, float]:
        """Rq [m]: the lowest it may be, the usual one, the highest."""
        if self.Rz is not None:
            low, high = _tables()["heights"]["Rz_over_Ra"]
            usual = math.sqrt(low * high)
            return tuple(RQ_OVER_RA * self.Rz / k for k in (high, usual, low))  # type: ignore[return-value]
        Rq = self.Rq if self.Rq is not None else RQ_OVER_RA * self.Ra  # type: ignore[operator]
        return Rq, Rq, Rq

    @property
    def words(self) -> str:
        """The face as a drawing writes it."""
        name = next(name for name in STATED if getattr(self, name) is not None)
        height = f"{name} {value_of(getattr(self, name), 'm')}"
        return f"{height}, {self.process}" if self.process else height


class Drawing(NamedTuple):
    """Numbers that follow from the faces: lowest, usual and highest value of each."""

    sigma: tuple[float, float, float]
    R: tuple[float, float, float] | None
    alpha: tuple[float, float, float] | None
    eta_R_sigma: tuple[float, float, float] | None
    """The last three are None where a process is not known."""


def drawing(faces: Sequence[Finish]) -> Drawing:
    r"""Numbers of the pair with these faces; one face alone is against a smooth one.

    .. math:: m_0 = R_q^2, \quad m_2 = s^2, \quad m_4 = \alpha m_2^2/m_0, \qquad
              R = \frac38\sqrt{\frac{\pi}{\sum m_4}}, \quad
              \alpha = \frac{\sum m_0 \sum m_4}{(\sum m_2)^2}

    The range of a number is that over all ends of the ranges of RMS slope s and bandwidth α of
    the faces.
    """
    sigma = tuple(math.hypot(*(face.heights[i] for face in faces)) for i in range(3))
    if any(face.process is None for face in faces):
        return Drawing(sigma, None, None, None)  # type: ignore[arg-type]
    spread = _tables()["spread"]["alpha"]
    usual = []
    corners: list[list[tuple[float, float, float]]] = []
    for face in faces:
        assert face.process is not None
        low, middle, high = face.heights
        usual.append((middle, _mid(slopes(face.process, middle)), _mid(spread)))
        corners.append(
            [
                (Rq, slope, alpha)
                for Rq in dict.fromkeys((low, high))
                for slope, alpha in product(slopes(face.process, Rq), spread)
            ]
        )
    ends = [_pair(corner) for corner in product(*corners)]
    ranges = [
        (min(column), middle, max(column))
        for column, middle in zip(zip(*ends, strict=True), _pair(usual), strict=True)
    ]
    return Drawing(sigma, *ranges)  # type: ignore[arg-type]


def _mid(ends: Sequence[float]) -> float:
    return math.sqrt(ends[0] * ends[1])


def _pair(faces: Sequence[tuple[float, float, float]]) -> tuple[float, float, float]:
    """R [m], α and ηRσ [1] of faces with Rq [m], RMS slope and α [1]."""
    m0 = sum(Rq**2 for Rq, _, _ in faces)
    m2 = sum(slope**2 for _, slope, _ in faces)
    m4 = sum(alpha * slope**4 / Rq**2 for Rq, slope, alpha in faces)
    alpha = m0 * m4 / m2**2
    R = 3 / 8 * math.sqrt(math.pi / m4)
    return R, alpha, ETA_R_SIGMA_OVER_ROOT_ALPHA * math.sqrt(alpha)


def needs_process(faces: Sequence[Finish]) -> str:
    """The sentence for heights that nothing says the sharpness of."""
    bare = join_words([face.words for face in faces if face.process is None])
    return (
        f"{bare} says how high the roughness is, not how sharp: give process = one of "
        f"{', '.join(processes())} for every face, which gives R, alpha and eta_R_sigma as ranges; "
        'or R, e.g. R = "10 um" (and alpha, eta_R_sigma or eta if you know them); '
        'or a measured surface, topography = "part.x3p"'
    )


def assumption_sentence(faces: Sequence[Finish], used: dict[str, float]) -> str:
    """The sentence that says what was taken on the way from the drawing to the numbers used."""
    numbers, tables = drawing(faces), _tables()
    stated = "; ".join(face.words for face in faces)
    how = []
    if any(face.Ra is not None for face in faces):
        how.append("Gaussian heights, Rq = 1.2533 Ra")
    if any(face.Rz is not None for face in faces):
        low, high = tables["heights"]["Rz_over_Ra"]
        how.append(f"Rz/Ra from {low:g} to {high:g} ({tables['heights']['standing']})")
    if len(faces) == 2:
        how.append("faces added as squares")
    else:
        how.append("one face, or the pair as a whole, against a smooth one")
    out = f"{stated}: sigma = {_range_text(numbers.sigma, 'm')} ({'; '.join(how)})"
    if numbers.R is None:
        return out
    parts = [
        f"{name} = {_range_text(getattr(numbers, name), unit)}"
        for name, unit in (("R", "m"), ("alpha", "1"), ("eta_R_sigma", "1"))
        if used.get(name) == getattr(numbers, name)[1]
    ]
    if parts:
        out += (
            f"; {', '.join(parts)} follow from the process, whose slopes are "
            f"{tables['slopes']['standing']} and not measured; assess takes the ranges"
        )
    return out


def _range_text(values: tuple[float, float, float], unit: str) -> str:
    low, usual, high = values

    def number_text(value: float) -> str:
        return number(value) if unit == "1" else value_of(value, unit)

    return number_text(usual) + (
        f" ({number_text(low)} to {number_text(high)})" if low < high else ""
    )


def given_or_drawn(faces: Sequence[Finish], stated: dict[str, float | None]) -> dict[str, Any]:
    """σ, R, α and ηRσ or η: what is given, and the usual values of the process for the rest."""
    numbers = drawing(faces)
    out: dict[str, object] = {name: value for name, value in stated.items() if value is not None}
    if numbers.R is None:
        if "R" not in out:
            raise InvalidValue(needs_process(faces), code=Mistake.MISSING)
    else:
        out.setdefault("R", numbers.R[1])
        out.setdefault("alpha", numbers.alpha[1])  # type: ignore[index]
        if "eta" not in out:
            out.setdefault("eta_R_sigma", numbers.eta_R_sigma[1])  # type: ignore[index]
    return {"sigma": numbers.sigma[1]} | out
