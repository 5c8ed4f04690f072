"""What the book says in several places and knows from one: a page writes {{ name }}.

Agreements come from stored runs, verdicts from a stored ledger, limits from the code that warns.
"""

import json
import math
import re
import warnings
from functools import cache
from importlib import resources
from pathlib import Path

__all__ = ["WRITTEN", "facts", "insert_facts"]

WRITTEN = re.compile(r"\{\{ (\w+) \}\}")
NUMBERS = (
    *("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"),
    *("eleven", "twelve", "thirteen", "fourteen", "fifteen", "sixteen", "seventeen"),
    *("eighteen", "nineteen", "twenty"),
)
SIZES = {"x2": 600e-9, "x1": 300e-9, "x067": 200e-9}


def word(count):
    """A count as a word, as far as there is one here."""
    return NUMBERS[count] if count < len(NUMBERS) else str(count)


def stored(name):
    file = resources.files("thirdbody").joinpath(f"data/{name}.json")
    return json.loads(file.read_text("utf-8"))


def differences():
    """Largest differences of share [1] by case, and of h/σ of all, F* from 1e-5 on."""
    import thirdbody as tb
    from thirdbody.papers import seats

    share, gap = {}, 0.0
    for case, size in SIZES.items():
        found = [
            (one["share_statistical"], one["share"], one["h_over_sigma_statistical"],
             one["h_over_sigma"])
            for one in seats.comparison() if one["case"] == case
        ]  # fmt: skip
        older = [one for one in seats.explicit_particles()["points"] if one["diameter"] == size]
        older = [one for one in older if one["F_star"] >= 1e-5]
        contact = seats.contact(size)
        with warnings.catch_warnings():
            warnings.simplefilter(
                "ignore", tb.errors.RangeWarning
            )  # particles sit deep in the runs
            states = tb.solve(contact, F_star=[one["F_star"] for one in older])
        sigma = contact.roughness.sigma
        for point, model, h in zip(older, states.particle_load_share, states.h, strict=True):
            run = point["control_variate"]
            found.append((model, run["load_share"], h / sigma, run["h_over_sigma"]))
        share[case] = max(abs(model / run - 1) for model, run, _, _ in found)
        gap = max(gap, *(abs(model - run) for _, _, model, run in found))
    return share, gap


def least_and_most(values):
    """Both ends of some parts [1], in whole per cent: 8 to 21 %."""
    values = sorted(100 * each for each in values)
    return f"{values[0]:.0f} to {values[-1]:.0f} %"


def pressed():
    """How far both asperity laws are off where they leave the middle of the range."""
    from thirdbody.papers import seats
    from thirdbody.papers.explicit.one_field import HEAVY, OPEN

    every = [one for one in seats.comparison() if one["share"]]
    known = [one for one in every if one["case"] not in OPEN]
    heavy = [one for one in known if one["F_star"] > HEAVY]

    def too_high(some, law="statistical"):
        return [one[f"share_{law}"] / one["share"] - 1 for one in some]

    def apart(some, law="statistical"):
        return max(abs(one[f"h_over_sigma_{law}"] - one["h_over_sigma"]) for one in some)

    def area(some, law="statistical"):
        return max(abs(one[f"A_t_{law}"] / one["A_t"] - 1) for one in some)

    def worst(values):
        return f"{100 * max(map(abs, values)):.2g} %"

    def mean_square(values):
        return f"{100 * math.sqrt(sum(each**2 for each in values) / len(values)):.3g} %"

    large = [one for one in known if one["group"] == "loads"]
    hard = [one for one in known if one["group"] == "hard" and "alpha15" not in one["case"]]
    plain = [one for one in every if one["group"] not in ("hard", "debris")]
    deep = [one for one in every if one["case"] == "valleys"]
    summits = [one for one in every if one["case"] == "summits"]
    return {
        "off_large": least_and_most(too_high(large)),
        "off_hard": least_and_most(too_high(hard)),
        "off_crowded": least_and_most(too_high([*large, *hard])),
        "less_large": least_and_most([1 - 1 / (1 + each) for each in too_high(large)]),
        "less_hard": least_and_most([1 - 1 / (1 + each) for each in too_high(hard)]),
        "off_valleys": worst(too_high(deep)),
        "off_valleys_field": worst(too_high(deep, "field")),
        "off_summits_field": worst([round(each, 2) for each in too_high(summits, "field")]),
        "area_low": worst([one["A_t"] / one["A_t_statistical"] - 1 for one in plain]),
        "area_low_hard": worst([one["A_t"] / one["A_t_statistical"] - 1 for one in hard]),
        "states": f"{len([one for one in seats.comparison() if one['case'] not in OPEN])}",
        "states_heavy": f"{len(heavy)}",
        "sum_share": worst(too_high(heavy)),
        "sum_share_rms": mean_square(too_high(heavy)),
        "sum_separation": f"{apart(heavy):.2f} σ",
        "sum_area": worst([area(heavy)]),
        "field_share": worst(too_high(heavy, "field")),
        "field_share_rms": mean_square(too_high(heavy, "field")),
        "field_separation": f"{apart(heavy, 'field'):.3f} σ",
        "field_area": worst([area(heavy, "field")]),
    }


def counted(verdicts):
    """Verdicts of one kind in words: six lost, nine undecided, none met."""
    words = list(verdicts.values())
    return {each: words.count(each) for each in ("lost", "undecided", "met", "by construction")}


@cache
def facts():
    """Every name that a page may write, and what stands there."""
    import thirdbody as tb
    from thirdbody.equilibrium import crowding, status

    share, gap = differences()
    parts = [math.ceil(100 * share[case]) for case in SIZES]
    verdicts = stored("verdicts")
    measured, computed, life = (
        counted(verdicts[kind]) for kind in ("measurements", "computations", "life")
    )
    of = verdicts["horng2022"]
    errata = (Path(__file__).parent.parent / "errata.md").read_text("utf-8")
    two, one, small = parts
    separation = f"{math.ceil(200 * gap) / 200:g} σ"
    return {
        "version": tb.__version__,
        "agreement_share": f"{two}, {one}, {small} %",
        "agreement_separation": separation,
        "agreement": f"within {two} % of the load share at x = 2σ, {one} % at x = σ and {small} % "
        f"at x = 0.67σ, and within {separation} of the separation",
        "measurements": f"{len(verdicts['measurements'])}",
        "measurements_word": word(len(verdicts["measurements"])),
        "measurements_lost": word(measured["lost"]),
        "measurements_verdict": f"{measured['lost']} lost, {measured['undecided']} undecided, "
        f"{measured['met'] or 'none'} met",
        "computations_word": word(len(verdicts["computations"])),
        "computations_verdict": f"{computed['lost']} lost, {computed['met']} met",
        "life_measurements": f"{len(verdicts['life'])}",
        "life_lost": f"{life['lost']}",
        "life_undecided": f"{life['undecided']}",
        "life_met": f"{life['met']}",
        "life_built_in": f"{life['by construction']}",
        "paper_statements": f"{of['statements']}",
        "paper_published": f"{of['published']}",
        "paper_consistent": f"{of['series-rough']}",
        "area_close": f"{crowding.CLOSE:.0%}".replace("%", " %"),
        "area_wide": f"{crowding.WIDE:.0%}".replace("%", " %"),
        "area_most": f"{status.MOST_AREA:.0%}".replace("%", " %"),
        "chi_hard": f"{crowding.HARD:g}",
        "chi_elastic": f"{crowding.ELASTIC:g}",
        "laws_word": word(len(tb.asperity.REGISTRY)),
        "materials": f"{len(list(tb.materials))}",
        "errata": f"{len(re.findall(r'^[*][*][0-9]+[.] ', errata, re.M))}",
        **pressed(),
    }  # fmt: skip


def insert_facts(text, where="a page"):
    """The text of a page with its facts in place; a name that is none is an error."""

    def put(found):
        if found[1] not in facts():
            raise KeyError(f"{where}: no fact {found[1]}; there are {', '.join(facts())}")
        return facts()[found[1]]

    return WRITTEN.sub(put, text)
