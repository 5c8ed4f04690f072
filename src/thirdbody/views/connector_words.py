"""A connector in dust in words: how often it fails to close, and what that hangs on."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from ..quantities.say import join_words, number, percent, value_of
from ..systems.connector import name_of

if TYPE_CHECKING:
    from ..study.run_connector import ConnectorResult

__all__ = ["HEADS", "MEANS", "SELDOM", "answer", "facts", "once_in", "rows", "uncertainty"]

SELDOM, OFTEN = 1e-12, 0.1
"""How often a contact stays open: from the first on it is drawn, from the second on in per cent."""
HEADS = ("contact force", "one contact open", "connector open", "fails once in")
MEANS = {
    "one contact open": "how often dust keeps one contact open",
    "connector open": "how often any of its contacts stays open",
    "fails once in": "closings",
}


def once_in(failure: float) -> str:
    """How often, as people say it.

    >>> once_in(0.0048), once_in(0.35), once_in(0.0)
    ('once in 208 closings (0.48 %)', 'in 35 % of all closings', 'never')
    >>> once_in(1e-13)
    'less than once in 10¹² closings'
    """
    if failure <= 0:
        return "never"
    if failure < SELDOM:
        return "less than once in 10¹² closings"
    if failure >= OFTEN:
        return f"in {percent(failure)} of all closings"
    return f"once in {_count(failure)} closings ({percent(failure)})"


def _range_words(low: float, high: float) -> str:
    """How often, between two ends.

    >>> _range_words(0.0048, 0.35), _range_words(0.35, 1.0)
    ('once in 208 closings (0.48 %) to in 35 % of all closings', 'in 35 to 100 % of all closings')
    """
    if low >= OFTEN:
        return f"in {percent(low).removesuffix(' %')} to {percent(high)} of all closings"
    return f"{once_in(low)} to {once_in(high)}"


def _count(failure: float) -> str:
    """Closings for one failure, to three digits.

    >>> _count(0.0048), _count(2.6e-5), _count(1.5e-9)
    ('208', '38500', '6.67×10⁸')
    """
    turns = 1 / failure
    if turns >= 1e7:
        return number(turns, 3)
    digits = max(2 - math.floor(math.log10(turns)), -9)
    return f"{round(round(turns, digits))}"


def answer(result: ConnectorResult) -> list[str]:
    """Sentences on how often the connector fails."""
    plug = result.asked.connector
    many = _makes(result)
    out: list[str] = []
    of_one_contact = result.failure if plug.contacts == 1 else result.failure_of_contact
    for i in sorted({result.places[0], result.places[-1]}):
        force, one, every = (
            float(c[i]) for c in (result.force, of_one_contact, result.failure_of_all)
        )
        what = "connector" if many else "contact"
        often = f"fails to close {once_in(every)}" if every > 0 else "never fails to close"
        said = f"Under {value_of(force, 'N')} the {what} {often}"
        if many and not out and one > 0:
            said += f": of its {many}, each stays open on dust {once_in(one)}"
        elif many and not out:
            said += f": of its {many}, none stays open on dust"
        out.append(f"{said}.")
    if len(out) == 1:
        kinds = join_words([name_of(dust, i) for i, dust in enumerate(plug.particles)])
        out.append(
            f"On average {number(result.in_the_way, 3)} particles ({kinds}) lie where the metal "
            f"meets; pressing in the mean one takes {value_of(result.threshold, 'N', 3)}."
        )
    return out


def _makes(result: ConnectorResult) -> str:
    """What the connector is made of, empty for a single contact."""
    plug = result.asked.connector
    n, m = int(plug.contacts), int(plug.parallel)
    series = f"{n} contacts in series" if n > 1 else ""
    if m == 1:
        return series
    return f"{series} with {m} spots each" if series else f"{m} spots, of which one is enough"


def uncertainty(result: ConnectorResult) -> list[str]:
    """Sentences on what moves the answer most and on the wipe, each with what to do."""
    every = [what_if for what_if in result.what_ifs if what_if.ratio > 1]
    heads = ["Most uncertain"] + ["Besides"] * len(every)
    return [
        f"{head}: {what_if.what}. With {what_if.between} it fails "
        f"{_range_words(what_if.low, what_if.high)}; "
        f"{what_if.action}."
        for head, what_if in zip(heads, every, strict=False)
        if what_if is every[0] or what_if.code == "wipe"
    ]


def rows(result: ConnectorResult) -> list[list[str]]:
    """The table: a row a force."""
    out = []
    for i, force in enumerate(result.force):
        every = float(result.failure_of_all[i])
        turns = "-" if every < SELDOM else _count(every)
        shown = [
            percent(float(share), least=SELDOM) for share in (result.failure_of_contact[i], every)
        ]
        out.append([value_of(float(force), "N"), *shown, turns])
    return out


def facts(result: ConnectorResult) -> dict[str, str]:
    """Named numbers of the force that is asked for."""
    i = result.places[0]
    return {
        "connector open": percent(float(result.failure_of_all[i]), least=SELDOM),
        "one contact open": percent(float(result.failure_of_contact[i]), least=SELDOM),
        "particles in the way": number(result.in_the_way, 3),
        "force that presses the mean one in": value_of(result.threshold, "N", 3),
        "they lie within": value_of(result.asked.connector.reach, "m", 3),
    }
