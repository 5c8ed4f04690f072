"""Every sentence of a report and of `solve` says what the numbers under it say.

Sentences are taken apart by the patterns below; one that fits none of them fails.
"""

import math
import re
import warnings

import numpy as np
import pytest
from random_studies import draw

import thirdbody as tb
from thirdbody.analysis.inputs import words_of
from thirdbody.equilibrium.modes import EPS_1, EPS_2
from thirdbody.quantities.say import number, percent, signed_number, value_of
from thirdbody.study import check
from thirdbody.views.report import report
from thirdbody.views.report.sentences import ranked_inputs
from thirdbody.views.state_words import answer

pytestmark = pytest.mark.filterwarnings("ignore")
NUMBER = r"[−+]?\d[\d.]*(?:×10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?"
AMOUNT = rf"{NUMBER} (?:GPa|MPa|kPa|Pa|m/s|m|mm|µm|nm)"
LOAD = rf"(?P<p>{AMOUNT}) \(F\* = (?P<F>{NUMBER})\)"
MEANS = {
    "nearly all real contact is on particles": "p-s",
    "real contact is on particles and on asperities": "hybrid",
    "nearly all real contact is on asperities": "s-s",
}
CARRIES = (
    r"(?:(?P<two>asperities carry the whole load, because there are no particles)"
    r"|(?P<none>there is no contact)"
    rf"|(?P<means>{'|'.join(MEANS)}) \((?P<mode>p-s|hybrid|s-s)\), and particles carry "
    rf"(?P<share>{NUMBER} %) of the load(?: \((?P<parts>[^)]*)\))?)"
)
GAP = rf"the mean planes of the surfaces (?:are (?P<apart>{AMOUNT}) apart|overlap by (?P<over>{AMOUNT}))"
AREA = rf"real contact area is (?P<A>{NUMBER} %) of the nominal area"
STATE = re.compile(
    rf"(?P<oil>Without the oil, at|At) {LOAD} {CARRIES}(?:: {GAP}(?: and the {AREA})?)?\."
)
CLOSE = re.compile(
    rf"The {AREA}(?:, (?P<plastic>{NUMBER} %) of it plastic)?, and {GAP} "
    rf"\((?P<ratio>{NUMBER}) times the roughness\)\."
)
CRITICAL = rf"F_cr\d = {NUMBER} \({AMOUNT}(?:, (?:above|below) the loads of this study)?\)"
PATH = re.compile(
    r"(?:Over these loads the mode goes (?P<path>[^;]*?)|The mode is (?P<one>\S+) at each of these "
    r"loads|There is no contact in any state of the study)"
    rf"(?:; (?P<verb>the critical load is|critical loads are) (?P<loads>{CRITICAL}(?: and {CRITICAL})?))?\."
)
DISTANCE = re.compile(
    rf"The load is (?:a factor (?P<ratio>{NUMBER}) (?P<side>above|below)|close to) "
    rf"(?P<name>F_cr\d) = (?P<F>{NUMBER}) \((?P<p>{AMOUNT})\), where (?P<what>asperities reach "
    r"2 %|particles are down to 5 %) of the real contact area \((?P<modes>[^)]*)\)"
    rf"(?:; with the inputs as uncertain as stated, the mode is (?P<likely>\S+) in (?P<odds>{NUMBER} %) "
    r"of cases)?\."
)
OUTSIDE = re.compile(
    r"(F_cr\d) (?:was not found|lies (below|above) every load searched: (at the least of them the mode "
    r"is not p-s any more|the mode is s-s at all of them|the mode is p-s at all of them|at the "
    r"greatest of them the mode is not s-s yet))\. ?"
)
FIRST = re.compile(
    rf"Of the inputs(?:, at {LOAD})?, (?P<label>[^.;]+?) moves the real contact area most: 1 % more of "
    r"it makes (?P<slope>[−+][\d.]+ %) of area\."
)
SHARE = rf"(?:< )?{NUMBER} %"
FILM = re.compile(
    rf"At (?P<speed>{AMOUNT}) lubrication is (?P<regime>[a-z ]+): the film carries (?P<film>{SHARE}) of "
    rf"the load, asperities (?P<asperities>{SHARE})(?: and particles (?P<particles>{SHARE}))?\."
)
NOTHING = ("There is no load", "The surfaces pull at each other")


def close(text, value, places=3):
    """A rounded number is the number."""
    digits = "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"
    plain = (
        text.replace("−", "-").replace("×10", "e").translate(str.maketrans(digits, "-0123456789"))
    )
    return math.isclose(float(plain), value, rel_tol=0.51 * 10.0 ** (1 - places), abs_tol=1e-300)


class Held:
    """The sentences of one study against its numbers."""

    def __init__(self, study):
        self.study = study
        self.found = report(study)
        self.result = self.found.result
        self.states = self.result["states"]
        every = range(len(self.states["status"]))
        self.known = sorted(
            (i for i in every if self.states["status"][i] == "ok"),
            key=lambda i: self.states["pressure"][i],
        )
        self.F = [self.states["F_star"][i] for i in self.known]

    def all(self):
        said = list(self.found.sentences())
        if self.study.film is not None:
            said = self.film(said)
        ends = [self.known[0], self.known[-1]]
        if ends[0] == ends[1]:
            first, second, third = said
            self.state(first, ends[0])
            self.closeness(second, ends[0])
            self.distance(third, ends[0])
            return
        for sentence, i in zip(said, ends, strict=False):
            self.state(sentence, i)
        self.path(said[2])

    def film(self, said):
        """Sentences that stand first, and those left."""
        film = self.found.film
        states = film["states"]
        speeds = states["speed"]
        assert said[0].startswith("This is a ")
        count = 1 if len(speeds) == 1 else 2
        at = [speeds.index(min(speeds)), speeds.index(max(speeds))]
        for sentence, i in zip(said[1 : 1 + count], at, strict=False):
            told = FILM.fullmatch(sentence)
            assert told, sentence
            assert told["speed"] == value_of(speeds[i], "m/s")
            assert told["regime"] == states["regime"][i]
            for who, column in (("film", "film"), ("asperities", "ss"), ("particles", "sa")):
                if told[who] is not None:
                    share = states[f"{column}_share"][i]
                    assert told[who] == percent(share, least=1e-6), sentence
            assert (told["particles"] is None) == self.study.contact.two_body
        assert any("egime" in line or "ubrication" in line for line in said[1 + count : -3]) == (
            count == 2
        )
        assert all(line.startswith("Without the oil, at") for line in said[-3:-2])
        return said[-3:]

    def carries(self, told, i):
        states, contact = self.states, self.study.contact
        assert (told["none"] is not None) == (not states["A_t"][i])
        if told["none"]:
            return
        assert (told["two"] is not None) == contact.two_body
        if told["two"]:
            return
        area, load = states["particle_area_share"][i], states["particle_load_share"][i]
        expected = "p-s" if area >= 1 - EPS_1 else "s-s" if area < EPS_2 else "hybrid"
        assert told["mode"] == MEANS[told["means"]] == expected
        assert told["share"] == percent(load)
        parts = {
            part["name"]: percent(part["load_share"][i]) for part in self.result["populations"]
        }
        assert (told["parts"] or "") == ", ".join(
            f"{name} {share}" for name, share in parts.items()
        )

    def gap(self, told, i):
        h = self.states["h"][i]
        assert told["apart"] == (value_of(h, "m") if h >= 0 else None)
        assert told["over"] == (value_of(-h, "m") if h < 0 else None)

    def state(self, sentence, i):
        told = STATE.fullmatch(sentence)
        assert told, sentence
        assert told["p"] == value_of(self.states["pressure"][i], "Pa")
        assert told["F"] == number(self.states["F_star"][i])
        assert told["oil"] == ("At" if self.study.film is None else "Without the oil, at")
        self.carries(told, i)
        if told["apart"] or told["over"]:
            self.gap(told, i)
            area = self.states["A_t"][i]
            assert told["A"] == (percent(area) if area else None)

    def closeness(self, sentence, i):
        if not self.states["A_t"][i]:
            told = re.fullmatch(rf"T{GAP[1:]}\.", sentence)
            assert told, sentence
            self.gap(told, i)
            return
        told = CLOSE.fullmatch(sentence)
        assert told, sentence
        self.gap(told, i)
        assert told["A"] == percent(self.states["A_t"][i])
        h, sigma = self.states["h"][i], self.study.contact.roughness.sigma
        assert close(told["ratio"], abs(h) / sigma)
        plastic = self.states["A_p"][i]
        if told["plastic"]:
            assert told["plastic"] == percent(plastic / self.states["A_t"][i])

    def critical(self, text):
        """Critical loads in a sentence: each is there, and outside where it is said to be."""
        found = {}
        for name, F, p, side in re.findall(
            rf"(F_cr\d) = ({NUMBER}) \(({AMOUNT})(?:, (above|below) the loads of this study)?\)",
            text,
        ):
            value = self.result["transitions"][name]["value"]
            assert F == number(value)
            assert p == value_of(value * self.study.contact.E_ss, "Pa")
            outside = "below" if value < min(self.F) else "above" if value > max(self.F) else ""
            assert side == outside, text
            found[name] = value
        exist = {n for n in ("F_cr1", "F_cr2") if self.result["transitions"][n]["value"]}
        assert set(found) == exist
        return found

    def path(self, sentence):
        if self.study.contact.two_body:
            self.first(sentence)
            return
        told = PATH.fullmatch(sentence)
        assert told, sentence
        modes = [self.states["mode"][i] or "no contact" for i in self.known]
        path = [m for k, m in enumerate(modes) if not k or m != modes[k - 1]]
        if told["path"]:
            assert told["path"].split(" → ") == path
            assert len(path) > 1
        else:
            assert path == [told["one"] or "no contact"]
        count = len(self.critical(told["loads"] or ""))
        assert told["verb"] == (None, "the critical load is", "critical loads are")[count]

    def distance(self, sentence, i):
        contact, F = self.study.contact, self.states["F_star"][i]
        if contact.two_body:
            self.first(sentence)
            return
        if not F > 0:
            assert sentence == f"{NOTHING[F < 0]}: nothing to compare with a critical load."
            return
        exist = {
            name: entry["value"]
            for name, entry in self.result["transitions"].items()
            if name != "F_tpca" and entry["value"]
        }
        if not exist:
            self.outside(sentence)
            return
        told = DISTANCE.fullmatch(sentence)
        assert told, sentence
        value = exist[told["name"]]
        assert all(abs(math.log(F / value)) <= abs(math.log(F / x)) for x in exist.values())
        assert told["F"] == number(value)
        assert told["p"] == value_of(value * contact.E_ss, "Pa")
        assert ("reach" in told["what"]) == (told["name"] == "F_cr1")
        if told["ratio"]:
            assert close(told["ratio"], max(F / value, value / F))
            assert (told["side"] == "above") == (value < F)
        if told["likely"]:
            odds = self.found.assessment.propagation.mode_probability
            assert odds[told["likely"]] == max(odds.values())
            assert told["odds"] == percent(odds[told["likely"]])

    def outside(self, sentence):
        """What is said of a critical load that was not found is so at the loads searched."""
        told = OUTSIDE.findall(sentence)
        assert OUTSIDE.sub("", sentence) == ""
        assert [name for name, *_ in told] == ["F_cr1", "F_cr2"]
        for _, side, what in told:
            if not side:
                continue
            low, middle, high = tb.solve(
                self.study.contact, F_star=np.array([1e-8, 1e-5, 1e-2])
            ).mode
            if "least" in what:
                assert low not in ("p-s",)
            elif "greatest" in what:
                assert high not in ("s-s",)
            else:
                wanted = "s-s" if "s-s" in what else "p-s"
                assert {low, middle, high} <= {wanted, "none"}

    def first(self, sentence):
        if sentence == "Which input matters most could not be found.":
            slopes = self.found.slopes
            assert slopes is None or not np.nanmax(
                np.abs([float(x) for x in slopes.elasticity["A_t"].values()]), initial=0
            )
            return
        told = FIRST.fullmatch(sentence)
        assert told, sentence
        slopes = {k: float(v) for k, v in self.found.slopes.elasticity["A_t"].items()}
        sizes = {k: abs(v) for k, v in slopes.items() if math.isfinite(v)}
        alike = [k for k in sizes if words_of(self.found.contact, k) == told["label"]]
        (label,) = (k for k in alike if sizes[k] == max(sizes.values()))
        assert told["slope"] == signed_number(slopes[label], 2, "%")
        assert (told["F"] is None) == (len(self.known) == 1)
        if told["F"]:
            assert told["F"] == number(self.states["F_star"][self.found.at])

    def ranking(self):
        """Inputs are ranked by a result that is not at its end."""
        of, order = ranked_inputs(self.found)
        if not order:
            return
        share = self.states["particle_load_share"][self.found.at]
        assert of == "A_t" or 0.01 < share < 0.99
        slopes = self.found.slopes.elasticity[of]
        sizes = [abs(float(slopes[label])) for label in order]
        finite = [x for x in sizes if math.isfinite(x)]
        assert finite == sorted(finite, reverse=True)
        assert math.isfinite(sizes[0])

    def answer(self):
        """What `solve` prints above its tables: the same states in one or two sentences."""
        first, *others = answer(self.result)
        ends = [self.known[0], self.known[-1]]
        if ends[0] == ends[1]:
            gap = rf"separation h = {AMOUNT} \(d = (?P<d>{AMOUNT}), (?P<ratio>{NUMBER}) sigma\)"
            told = re.fullmatch(
                rf"At {LOAD} {CARRIES}; {gap}(?:, {AREA.replace(' is', '')})?\.", first
            )
            assert told, first
            assert not others
            assert told["p"] == value_of(self.states["pressure"][ends[0]], "Pa")
            assert told["d"] == value_of(self.states["d"][ends[0]], "m")
            assert close(told["ratio"], self.states["d_star"][ends[0]])
            self.carries(told, ends[0])
            return

        def both(name, unit):
            said = [value_of(self.states[name][i], unit) if unit else percent(self.states[name][i])
                    for i in ends]  # fmt: skip
            return " to ".join(dict.fromkeys(said))

        (second,) = others
        assert first.startswith(f"From {both('pressure', 'Pa')} ")
        apart = f"separation h goes from {both('h', 'm')}, and the real contact area is "
        assert second.endswith(f"{apart}{both('A_t', '')} of the nominal one.")
        if self.study.contact.two_body:
            assert "there are no particles" in first
            return
        assert f"particles carry {both('particle_load_share', '')} of the load" in first
        modes = [self.states["mode"][i] or "no contact" for i in self.known]
        path = [m for k, m in enumerate(modes) if not k or m != modes[k - 1]]
        assert " → ".join(path) in second or path == ["no contact"]


QUICK = (1, 2, 4)
"""Studies that are drawn and solved in a second; others take up to ten."""


def held(seed, index):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            made = Held(check(draw(seed, index)))
        except tb.errors.NoEquilibrium:
            return False
        made.all()
        made.ranking()
        made.answer()
    return True


@pytest.mark.parametrize("index", QUICK)
def test_every_sentence_is_true(index):
    held(1, index)


@pytest.mark.slow
@pytest.mark.parametrize("index", sorted({*range(16)} - {*QUICK}))
def test_every_sentence_of_many_studies_is_true(index):
    held(1, index)
