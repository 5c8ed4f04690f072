"""A filter by its β ratios: counts before over counts behind, at every size."""

import math

import numpy as np
import pytest
from refusals import Mistake, refuses

from thirdbody import InvalidValue, LogNormal, Monodisperse
from thirdbody.populations.measured.cleanliness import iso4406_of, suspension_of_iso4406
from thirdbody.systems.oil_filter import Filter

FINE = Filter(sizes=(5e-6, 10e-6), betas=(75.0, 1000.0))


def above(number, sizes, x):
    return number * float(sizes.partial_moment(0, x, sizes.support[1]))


@pytest.mark.parametrize("fine", [FINE, Filter(sizes=(6e-6,), betas=(200.0,))])
@pytest.mark.parametrize("dirt", ["18/16/13", "dust"])
def test_beta_is_the_ratio_of_the_counts(fine, dirt):
    oil = suspension_of_iso4406(dirt) if "/" in dirt else (1e9, LogNormal(median=5e-6, gsd=1.8))
    behind = fine.behind(*oil)
    for x in (5e-6, 10e-6) if fine is FINE else (6e-6,):
        assert above(*oil, x) / above(*behind, x) == pytest.approx(fine.beta(x), rel=1e-9)
    for x in np.geomspace(4.1e-6, 20e-6, 23):
        assert above(*oil, x) / above(*behind, x) == pytest.approx(fine.beta(x), rel=0.02)


def test_between_and_beyond_the_sizes():
    middle = math.sqrt(5e-6 * 10e-6)
    assert FINE.beta(middle) == pytest.approx(1 + math.sqrt(74 * 999), rel=1e-12)
    assert FINE.beta(50e-6) == pytest.approx(1000, rel=1e-12)
    assert FINE.beta(0.1e-6) == 1
    one = Filter(sizes=(6e-6,), betas=(200.0,))
    assert one.beta([3e-6, 6e-6, 60e-6]) == pytest.approx([1, 200, 200], rel=1e-12)


def test_a_filter_that_holds_nothing_changes_nothing():
    none = Filter(sizes=(5e-6,), betas=(1.0,))
    oil = suspension_of_iso4406("18/16/13")
    number, sizes = none.behind(*oil)
    assert number == pytest.approx(oil[0], rel=1e-12)
    for n in (1, 2, 3):
        assert sizes.moment(n) == pytest.approx(oil[1].moment(n), rel=1e-9)
    assert iso4406_of(density=number, diameter=sizes) == "18/16/13"


def test_all_sizes_held_alike_keep_their_distribution():
    """β the same everywhere: fewer, and nothing else."""
    even = Filter(sizes=(0.1e-6, 1e-3), betas=(100.0, 100.0))
    number, sizes = even.behind(1e9, LogNormal(median=5e-6, gsd=1.5))
    assert number == pytest.approx(1e7, rel=1e-9)
    assert sizes.moment(3) == pytest.approx(LogNormal(median=5e-6, gsd=1.5).moment(3), rel=1e-3)


def test_as_written_on_data_sheets():
    for text in (
        "5=75, 10=1000",
        "beta5(c) = 75; beta10(c) = 1000",
        "10=1000,5=75",
        "5um=75, 10 um=1000",
    ):
        found = Filter.from_text(text)
        assert found.sizes == pytest.approx(FINE.sizes, rel=1e-12)
        assert found.betas == FINE.betas


@pytest.mark.parametrize(
    ("text", "refusal"),
    [
        ("5:75", refuses(Mistake.FORM, "", says="'='")),
        ("5=x", refuses(Mistake.FORM, "", says='"x"')),
        ("5=75, 10=20", refuses(Mistake.ORDER, "Filter.betas")),
        ("5=0.5", refuses(Mistake.RANGE, "Filter.betas")),
        ("0=5", refuses(Mistake.ORDER, "Filter.sizes")),
        ("5=75, 5=80", refuses(Mistake.ORDER, "Filter.sizes")),
        ("", refuses(Mistake.SHAPE, "Filter")),
        ("5 MPa=3", refuses(Mistake.FORM, "", says='"5 MPa"')),
    ],
)
def test_mistakes(text, refusal):
    with refusal:
        Filter.from_text(text)


def test_one_size_has_no_count_above_it():
    with pytest.raises(InvalidValue, match="spread"):
        FINE.behind(1e9, Monodisperse(mean=5e-6))
    assert FINE.behind(0.0, LogNormal(median=5e-6, gsd=1.5))[0] == 0
