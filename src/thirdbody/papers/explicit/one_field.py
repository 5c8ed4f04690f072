"""The stored states, pressed point by point, by the law of one field and by the sum over summits.

``python -m thirdbody.papers.explicit.one_field`` prints every state. Nothing is pressed: the states
are those of ``data/explicit_comparison.json``, and nothing was fitted to them. The law takes the
waves of the boxes that were pressed (102 µm, which repeat themselves), since these have fewer long
waves than an endless surface; ``--endless`` takes the library's spectrum.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...laws.field.own import OwnSpectrum
from ..seats import comparison
from .cases import CASES, Case
from .compared import FULL, box_of, by_field

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["OPEN", "State", "against_stored", "errors"]

OPEN = ("valleys", "summits", "debris")
"""Cases that no law of heights alone can follow: their seats know more than their height, or their
particles flatten one by one."""
HEAVY = 1.01e-4
"""F* from which the runs are exact enough to tell laws apart."""


@dataclass(frozen=True, kw_only=True)
class State:
    """One stored state: pressed, by the sum over summits as stored, and by one field."""

    case: str
    F_star: float
    share: tuple[float, float, float]
    h: tuple[float, float, float]
    area: tuple[float, float, float]
    share_error: float

    def differences(self, field: bool) -> tuple[float, float, float]:
        """Share over that pressed, less 1; separation less that pressed [σ]; area as the share."""
        i = 2 if field else 1
        return (
            self.share[i] / self.share[0] - 1,
            self.h[i] - self.h[0],
            self.area[i] / self.area[0] - 1,
        )


def _own_spectrum(case: Case, endless: bool) -> OwnSpectrum | None:
    bare = case.contact.replace(particles=None, surfaces=CASES[0].contact.surfaces)
    return None if endless else box_of(bare, FULL.size, FULL.spacing)


def against_stored(
    *, endless: bool = False, cases: Sequence[str] | None = None
) -> tuple[State, ...]:
    """Every stored state of these cases, all by default.

    Parameters
    ----------
    endless : bool, optional
        The library's spectrum of an endless surface in the place of the boxes' own waves.
    cases : sequence of str, optional
        Names of cases.

    Examples
    --------
    >>> states = against_stored(endless=True, cases=["soft_x2"])
    >>> max(abs(state.differences(field=True)[0]) for state in states) < 0.02
    True
    """
    rows = comparison()
    out = []
    for case in CASES:
        case_rows = [row for row in rows if row["case"] == case.name]
        if not case_rows or (cases is not None and case.name not in cases):
            continue
        seat = {name: case_rows[0][name] for name in ("zeta_mean", "zeta_std")}
        model = case.contact.replace(particle_law=case.contact.particle_law.replace(**seat))
        fields = by_field(model, [row["F_star"] for row in case_rows], _own_spectrum(case, endless))
        out += [
            State(
                case=case.name,
                F_star=row["F_star"],
                share=(_number(row["share"]), row["share_statistical"], fields[i][0]),
                h=(row["h_over_sigma"], row["h_over_sigma_statistical"], fields[i][1]),
                area=(row["A_t"], row["A_t_statistical"], fields[i][2]),
                share_error=_number(row["share_error"]),
            )
            for i, row in enumerate(case_rows)
        ]
    return tuple(out)


def _number(value: float | None) -> float:
    """A stored number; NaN where too little was drawn to know it."""
    return math.nan if value is None else value


def errors(states: Sequence[State], *, field: bool) -> dict[str, tuple[float, float]]:
    """Worst and RMS of share [1], separation [σ] and area [1], of what was pressed."""
    off = np.array([state.differences(field) for state in states])
    rms = np.sqrt(np.nanmean(off**2, axis=0))
    worst = np.nanmax(np.abs(off), axis=0)
    return {name: (float(worst[i]), float(rms[i])) for i, name in enumerate(("share", "h", "area"))}


def main(arguments: list[str] | None = None) -> int:
    """Print every state, and worst and RMS of both laws."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--endless", action="store_true", help="the library's spectrum")
    states = against_stored(endless=parser.parse_args(arguments).endless)
    print("case, F*: share (one field, summits) in %, h in sigma, area in %; error of the share")
    for state in states:
        new, old = state.differences(True), state.differences(False)
        print(
            f"{state.case:14} {state.F_star:7.0e}: {100 * new[0]:+5.1f} ({100 * old[0]:+5.1f})  "
            f"{new[1]:+.3f} ({old[1]:+.3f})  {100 * new[2]:+5.1f} ({100 * old[2]:+5.1f}); "
            f"{100 * state.share_error / state.share[0]:.1f}"
        )
    groups = {
        "F* > 1e-4": [s for s in states if s.F_star > HEAVY and s.case not in OPEN],
        "F* <= 1e-4": [s for s in states if s.F_star <= HEAVY and s.case not in OPEN],
        ", ".join(OPEN): [s for s in states if s.case in OPEN],
    }
    for words, some in groups.items():
        for field in (False, True):
            errors_of = errors(some, field=field)
            law = "one field" if field else "summits"
            print(
                f"{words}, {len(some)} states, {law}: worst and RMS: "
                f"share {100 * errors_of['share'][0]:.1f}, {100 * errors_of['share'][1]:.1f} %; "
                f"h {errors_of['h'][0]:.3f}, {errors_of['h'][1]:.3f} sigma; "
                f"area {100 * errors_of['area'][0]:.1f}, {100 * errors_of['area'][1]:.1f} %"
            )
    return 0 if math.isfinite(sum(state.share[2] for state in states)) else 1


if __name__ == "__main__":
    raise SystemExit(main())
