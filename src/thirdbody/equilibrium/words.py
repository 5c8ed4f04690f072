"""What modes, critical loads and their statuses are called, for all who tell of them."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection, Iterable, Mapping

from ..quantities.say import number, percent, plural, value_of
from .modes import EPS_1, EPS_2, HYBRID, MODES, P_S, S_S, WINDOW, CriticalStatus

__all__ = [
    "BANDS",
    "CRITICAL",
    "MODES",
    "MOST_MEET_NONE",
    "NO_CONTACT",
    "NO_MODE",
    "RARE",
    "critical_load",
    "critical_name",
    "happens",
    "is_rare",
    "load_of",
    "meets",
    "mode_among",
    "mode_of",
    "mode_path",
    "not_met",
    "particle_share_text",
    "two_bodies",
    "unsolved_sentences",
]

NO_CONTACT = "no contact"
MEANS = {
    P_S: "nearly all real contact is on particles",
    HYBRID: "real contact is on particles and on asperities",
    S_S: "nearly all real contact is on asperities",
}
"""Modes are parts of the area, whatever the load does."""
BANDS = "bands: p-s real contact on particles, hybrid on both, s-s on asperities"
CRITICAL = {
    "F_cr1": f"asperities reach {percent(EPS_1)} of the real contact area (p-s to hybrid)",
    "F_cr2": f"particles are down to {percent(EPS_2)} of the real contact area (hybrid to s-s)",
    "F_tpca A": "particles have their largest share of the real area",
    "F_tpca B": "asperities and particles carry equal loads",
    "F_tpca C": "the area bends most over the load",
}
"""What happens at each critical load."""
FEW, MANY = 0.1, 1e7
"""Share of contacts below which they are one in so many, and how many are written out."""
Side = tuple[CriticalStatus, CriticalStatus]
BELOW: Side = (CriticalStatus.NEVER_P_S, CriticalStatus.ALWAYS_S_S)
ABOVE: Side = (CriticalStatus.ALWAYS_P_S, CriticalStatus.NEVER_S_S)
"""Statuses of critical loads that lie below, or above, every load searched."""
RARE = "rare"
"""Stands for the mode of contacts of which many meet no particle."""
MOST_MEET_NONE = "less than one particle lies in a contact, and those without are as without any"
"""What that means."""
THERE = {
    ("F_cr1", BELOW): "at the least of them the mode is not p-s any more",
    ("F_cr2", BELOW): "the mode is s-s at all of them",
    ("F_cr1", ABOVE): "the mode is p-s at all of them",
    ("F_cr2", ABOVE): "at the greatest of them the mode is not s-s yet",
}
"""What is known where a critical load lies outside: share and load need not fall together."""


NO_MODE = "there is no contact, or no equilibrium"
"""What it means where a state has no mode."""


def mode_of(mode: str | None) -> str:
    """A mode as a clause.

    >>> mode_of("hybrid"), mode_of(None)
    ('real contact is on particles and on asperities (hybrid)', 'there is no contact')
    """
    if mode == "none":
        return "there is no equilibrium"
    return f"{MEANS[mode]} ({mode})" if mode else "there is no contact"


def mode_among(mode: str | None, held: float) -> str:
    """The mode of contacts that hold so many particles on average, as a clause.

    A state is of a surface whose particles all share the load. Where most contacts hold none, only
    a mode in which asperities carry is that of the contacts too.

    >>> mode_among("p-s", 8.3e-5)
    'one contact in 12000 meets a particle, and the others are as without particles'
    >>> mode_among("hybrid", 20.0), mode_among("s-s", 8.3e-5) == mode_of("s-s")
    ('real contact is on particles and on asperities (hybrid)', True)
    """
    if is_rare(mode, held):
        return f"{meets(held)}, and the others are as without particles"
    return mode_of(mode)


def is_rare(mode: str | None, held: float) -> bool:
    """Whether contacts hold so few particles that a mode on particles is not theirs.

    >>> is_rare("p-s", 0.1), is_rare("p-s", 1.0), is_rare("s-s", 0.1), is_rare(None, 0.1)
    (True, False, False, False)
    """
    return mode in ("p-s", "hybrid") and 0 < held < 1


def two_bodies() -> str:
    """What stands for the mode of a contact without particles.

    >>> two_bodies()
    'asperities carry the whole load, because there are no particles'
    """
    return "asperities carry the whole load, because there are no particles"


def load_of(pressure: float | None, F_star: float | None) -> str:
    """A load in both of its measures.

    >>> load_of(5e6, 4.4676e-5)
    '5 MPa (F* = 4.468×10⁻⁵)'
    """
    return f"{value_of(pressure, 'Pa')} (F* = {number(F_star)})"


def particle_share_text(
    share: float | None, parts: Mapping[str, float | None] | None = None
) -> str:
    """How much of the load is on particles, and on each population.

    >>> particle_share_text(0.884, {"dust": 0.8, "debris": 0.084})
    'particles carry 88.4 % of the load (dust 80 %, debris 8.4 %)'
    """
    by_population = ", ".join(
        f"{name} {percent(carried)}" for name, carried in (parts or {}).items()
    )
    return f"particles carry {percent(share)} of the load" + (
        f" ({by_population})" if by_population else ""
    )


def meets(count: float) -> str:
    """Clause on how often a contact meets a particle, from the mean number; "" from 1 on.

    Places do not depend on one another, so that no particle is there with the probability
    exp(−count).

    >>> meets(3.2e-5), meets(0.5), meets(1.0)
    ('one contact in 31000 meets a particle', '39 % of the contacts meet a particle', '')
    """
    if not 0 < count < 1:
        return ""
    share = -math.expm1(-count)
    if share > FEW:
        return f"{percent(share, digits=2)} of the contacts meet a particle"
    every = float(f"{1 / share:.2g}")
    # no gap between thousands: a line that breaks there would say another number
    said = f"{every:.0f}" if every < MANY else number(every, 2)
    return f"one contact in {said} meets a particle"


def mode_path(modes: Iterable[str | None]) -> str:
    """Modes along the rising loads of a study, those that were solved, as a sentence.

    >>> mode_path(["p-s", "p-s", "hybrid"]), mode_path(["s-s", "s-s"])
    ('Over these loads the mode goes p-s → hybrid', 'The mode is s-s at each of these loads')
    >>> mode_path(["s-s"]), mode_path(["", ""])
    ('The mode is s-s', 'There is no contact in any state of the study')
    """
    met = [mode or NO_CONTACT for mode in modes]
    path = [mode for i, mode in enumerate(met) if i == 0 or mode != met[i - 1]]
    if len(path) > 1:
        return f"Over these loads the mode goes {' → '.join(path)}"
    if path[0] == NO_CONTACT:
        return "There is no contact in any state of the study"
    return f"The mode is {path[0]}" + (" at each of these loads" if len(met) > 1 else "")


def critical_name(name: str) -> str:
    """The name of a critical load; data join its parts by a dot.

    >>> critical_name("F_tpca.A")
    'F_tpca A'
    """
    return name.replace(".", " ")


def happens(name: str) -> str:
    """What happens at a critical load.

    >>> happens("F_tpca.B")
    'asperities and particles carry equal loads'
    """
    return CRITICAL[critical_name(name)]


def _side(value: float | None, status: str) -> Side | None:
    """Statuses of the side of the window on which a critical load lies; None inside."""
    for side, there in ((BELOW, 0.0), (ABOVE, math.inf)):
        if status in side or (not status and value == there):
            return side
    return None


def critical_load(value: float | None, status: str = "", E_ss: float | None = None) -> str:
    """Text of a critical load F* (a pressure if E_ss is given), or of the side on which it lies.

    A load that does not exist is "-"; one outside the loads searched lies below or above them,
    be it told by its status or by 0 and ∞.

    >>> critical_load(2.59e-5, "found"), critical_load(2.59e-5, "found", 1e11)
    ('2.59×10⁻⁵', '2.59 MPa')
    >>> critical_load(None, "never p-s"), critical_load(0.0), critical_load(None, "none")
    ('below 1×10⁻⁸', 'below 1×10⁻⁸', '-')
    """
    side = _side(value, status)
    if side is None and (value is None or math.isnan(value)):
        return "-"
    factor, unit = (1.0, "1") if E_ss is None else (E_ss, "Pa")
    if side is not None:
        end = value_of(WINDOW[side is ABOVE] * factor, unit)
        return f"{'below' if side is BELOW else 'above'} {end}"
    assert value is not None
    return value_of(value * factor, unit)


def not_met(name: str, value: float | None, status: str = "") -> str:
    """Why a load is not compared with F_cr1 or F_cr2.

    >>> not_met("F_cr1", None, "never p-s")
    'F_cr1 lies below every load searched: at the least of them the mode is not p-s any more.'
    >>> not_met("F_cr2", math.inf)
    'F_cr2 lies above every load searched: at the greatest of them the mode is not s-s yet.'
    """
    side = _side(value, status)
    if side is None:
        return f"{name} was not found."
    word = "below" if side is BELOW else "above"
    return f"{name} lies {word} every load searched: {THERE[name, side]}."


def unsolved_sentences(statuses: Collection[str]) -> list[str]:
    """How many states have no number, and why: a sentence for each reason.

    >>> unsolved_sentences(["ok", "no equilibrium"])
    ['1 of 2 states unsolved: no equilibrium']
    """
    return [
        f"{count} of {plural(len(statuses), 'state')} unsolved: {status}"
        for status, count in Counter(statuses).items()
        if status != "ok"
    ]
