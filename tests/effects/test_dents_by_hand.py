"""Dents against brute force: every field, to 1e-7, and their number to 1e-9."""

import math
import warnings

import numpy as np
import pytest
from dents_by_hand import ByHand

import thirdbody as tb

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
SOFT = STEEL.replace(H=2.5e9)
GAUSS = tb.TruncatedGaussian(mean=500e-9, std=100e-9)
WIDE = tb.LogNormal(median=400e-9, gsd=1.4)
ONE = tb.distributions.Monodisperse(mean=500e-9)


RARE = 1e-14
"""Part of all particles of which sums that end at nine widths of the seat say nothing."""


def contact(dents, *, sizes=GAUSS, seat="rough", deep="table", material=SILICA, bodies=None):
    return tb.Contact(
        surfaces=tb.MaterialPair(*(bodies or (STEEL, SOFT))),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(material=material, areal_density=1e10, diameter=sizes),
        particle_law=tb.particle.Series(seat=seat, deep=deep),
        outputs=dents,
    )


def compare_sums(case, d, outputs, side):
    """Number, means, volume and number of embedded ones; what was compared."""
    hand = ByHand(case, d, side)
    if hand.one.flat and hand.dents.shallowest > 0:
        assert math.isnan(outputs[f"n_dents_{side + 1}"])  # not known of marks
        return hand, 0.0
    sums = hand.sums()
    names = {"n": "n_dents", "width": "dent_width"}
    if not hand.one.flat:
        names |= {"depth": "dent_depth", "volume": "dent_volume", "embedded": "embedded"}
    for key, column in names.items():
        known = 1e-9 if key == "n" else 1e-7
        if not sums["n"] > 0:
            assert not outputs[f"n_dents_{side + 1}"] > 0
        elif key != "embedded" or sums[key] > RARE * case.particles.areal_density:
            assert outputs[f"{column}_{side + 1}"] == pytest.approx(sums[key], rel=known), column
    return hand, sums["n"]


def compare_percentiles(hand, n, outputs, side):
    """The exact value lies within 1e-7 of the one that is asked."""
    A_n = hand.dents.A_n
    ends = {"p95": 0.05 * n, "max": math.log(2 / (1 + math.exp(-n * A_n))) / A_n}
    for name in ("width",) if hand.one.flat else ("depth", "width"):
        for end, count in ends.items():
            value = float(outputs[f"dent_{name}_{end}_{side + 1}"])
            mean = outputs[f"dent_{name}_{side + 1}"]
            if not value > 0 or (end == "max" and value == mean):
                continue  # none in A_n, or so few that it is the mean
            below, above = (hand.number_above(name, value * (1 + part)) for part in (-1e-7, 1e-7))
            assert below >= count >= above, (name, end)


BRITTLE = {"debris": "brittle"}


@pytest.mark.parametrize(
    ("dents", "options"),
    [
        pytest.param({**BRITTLE, "fragment": 450e-9}, {}, id="fragments"),
        pytest.param({**BRITTLE, "fragment": 300e-9}, {"sizes": ONE}, id="of-one-size"),
        pytest.param({**BRITTLE, "fragment": 350e-9}, {"seat": "plane"}, id="on-a-plane"),
        pytest.param(
            {**BRITTLE, "fragment": 420e-9, "shallowest": 3e-9}, {"deep": "off"}, id="deep-ones"
        ),
        pytest.param({"debris": "ductile"}, {}, id="widest-discs"),
        pytest.param({"debris": "ductile"}, {"sizes": ONE}, id="widest-discs-of-one-size"),
        pytest.param({}, {"material": STEEL.replace(H=1e9), "deep": "off"}, id="squashed"),
        pytest.param({"shallowest": 5e-9}, {}, id="from-a-depth-on"),
        pytest.param({"shallowest": 5e-9}, {"sizes": WIDE, "seat": "plane"}, id="so-on-a-plane"),
        pytest.param({"shallowest": 20e-9, "debris": "hard"}, {"sizes": ONE}, id="of-hard-ones"),
    ],
)
def test_sums_are_those_by_hand(dents, options):
    case = contact(tb.outputs.Dents(**dents), **options)
    d = 250e-9
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        outputs = tb.solve(case, d=d).outputs
    # shallow ones are harder on both sides: the softer one is looked at
    assert compare_sums(case, d, outputs, 1)[1] > 0


@pytest.mark.parametrize("d", [-150e-9, 100e-9])
def test_dents_in_closed_gaps_are_those_by_hand(d):
    """Where seats lie above the other surface, and dents are as wide and deep as particles."""
    case = contact(tb.outputs.Dents(debris="brittle", fragment=150e-9, shallowest=2e-9), deep="off")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        outputs = tb.solve(case, d=d).outputs
    assert compare_sums(case, d, outputs, 1)[1] > 0


@pytest.mark.parametrize(
    ("dents", "options"),
    [
        pytest.param({**BRITTLE, "fragment": 400e-9}, {"sizes": ONE}, id="fragments-of-one-size"),
        pytest.param({**BRITTLE, "fragment": 450e-9}, {"deep": "off"}, id="fragments"),
        pytest.param({"debris": "ductile"}, {"deep": "off"}, id="discs"),
        pytest.param({"debris": "ductile"}, {"sizes": WIDE, "deep": "off"}, id="hardly-pressed"),
    ],
)
def test_percentiles_are_those_by_hand(dents, options):
    case = contact(tb.outputs.Dents(A_n=1e-8, **dents), bodies=(SOFT, SOFT), **options)
    d = 250e-9
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        outputs = tb.solve(case, d=d).outputs
    hand, n = compare_sums(case, d, outputs, 0)
    compare_percentiles(hand, n, outputs, 0)


# ------------------------------------------------------------------------------ at random
KINDS = ("monodisperse", "gaussian", "log-normal")


def random_contact(index):
    """A contact and F*: surfaces alike or not, soft and hard particles, of every kind in turn."""
    rng = np.random.default_rng([3, index])

    def drawn(low, high):
        return float(np.exp(rng.uniform(math.log(low), math.log(high))))

    def body(H):
        return tb.Material(E=H * drawn(12, 80), nu=float(rng.uniform(0.15, 0.4)), H=H)

    first = body(drawn(0.5e9, 20e9))
    second = first if rng.random() < 0.5 else body(drawn(0.5e9, 20e9))
    debris = ("by_hardness", "hard", "ductile", "brittle")[index // 6 % 4]
    softer, harder = sorted((first.H, second.H))
    particle = body(softer * drawn(0.3, 8) if debris != "hard" else harder * drawn(1.1, 4))
    sigma = drawn(20e-9, 1e-6)
    mean = sigma * drawn(0.3, 30)
    sizes = {
        "monodisperse": tb.distributions.Monodisperse(mean=mean),
        "gaussian": tb.TruncatedGaussian(mean=mean, std=mean * float(rng.uniform(0.05, 0.3))),
        "log-normal": tb.LogNormal(median=mean, gsd=float(rng.uniform(1.1, 1.8))),
    }[KINDS[index % 3]]
    density = 0.02 / (math.pi / 4 * sizes.moment(2)) * drawn(1e-3, 1)
    options = {"fragment": mean * drawn(0.2, 1.5)} if debris == "brittle" else {}
    if debris != "ductile" and rng.random() < 0.35:
        options["shallowest"] = mean * drawn(1e-3, 3e-2)
    return tb.Contact(
        surfaces=tb.MaterialPair(first, second),
        roughness=tb.Roughness(sigma=sigma, R=sigma * drawn(20, 200)),
        particles=tb.Particles(material=particle, areal_density=density, diameter=sizes),
        particle_law=tb.particle.Series(
            seat=("rough", "plane")[index // 3 % 2], deep="table" if rng.random() < 0.6 else "off"
        ),
        outputs=tb.outputs.Dents(debris=debris, A_n=drawn(30, 3e4) / density, **options),
    ), drawn(1e-7, 1e-3)


@pytest.mark.check
@pytest.mark.parametrize("index", range(48))
def test_random_dents_are_those_by_hand(index):
    case, F_star = random_contact(index)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        state = tb.solve(case, F_star=F_star)
    for side in (0, 1):
        compare_sums(case, float(state.d), state.outputs, side)
