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


@pytest.mark.parametrize("fine", [FINE, Filter(sizes=(6e-6,), betas=(200.0,))])
@pytest.mark.parametrize("median", [1e-6, 5e-6])
def test_below_its_smallest_size_it_may_hold_nothing(fine, median):
    """All that is smaller comes through, and of the larger ones as many as β says."""
    dirt = LogNormal(median=median, gsd=1.8)
    number, sizes = fine.behind(1e9, dirt, goes_on=False)
    first, (low, high) = fine.sizes[0], dirt.support
    for x, rel in ((1.3 * low, 0.02), (0.7 * first, 0.02), (first, 1e-9), (1.4 * first, 0.02)):
        came = dirt.partial_moment(0, max(x, first), high) / float(fine.beta(max(x, first)))
        came += dirt.partial_moment(0, x, first) if x < first else 0.0
        assert above(number, sizes, x) == pytest.approx(1e9 * came, rel=rel)
    assert above(number, sizes, 0.8 * first) > above(*fine.behind(1e9, dirt), 0.8 * first)


def test_service_lowers_beta():
    dirt, worse = LogNormal(median=5e-6, gsd=1.8), FINE.replace(service=0.5)
    x = np.array([3e-6, 5e-6, 7e-6, 30e-6])
    np.testing.assert_allclose(np.log(worse.beta(x)), 0.5 * np.log(FINE.beta(x)), rtol=1e-12)
    behind = worse.behind(1e9, dirt)
    assert above(1e9, dirt, 5e-6) / above(*behind, 5e-6) == pytest.approx(math.sqrt(75), rel=1e-9)
