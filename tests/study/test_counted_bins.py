"""Counted sizes that stand in the study itself are those of the file they came from."""

import pytest
from refusals import Mistake, refuses

from thirdbody.study import check

FILE = "low [um],high [um],number [1/ml]\n1,4,2400\n4,6,420\n6,14,61\n14,21,3\n"
BINS = {"edges": ["1 um", "4 um", "6 um", "14 um", "21 um"], "counts": [2400, 420, 61, 3]}


def study(sizes, **more):
    dust = {"material": "SiO2", "sizes": sizes, "areal_density": 1e8} | more
    return {
        "surfaces": {"first": "S45C", "second": "S45C"},
        "roughness": {"sigma": "100 nm", "R": "2.8 um"},
        "particles": dust,
        "load": {"pressure": "5 MPa"},
    }


@pytest.mark.parametrize(
    "more", [{}, {"weighting": "volume"}, {"weighting": "volume", "fit": "log-normal"}]
)
def test_bins_in_the_study_are_those_of_the_file(tmp_path, more):
    (tmp_path / "sizes.csv").write_text(FILE)
    by_file = check(study("sizes.csv", **more), folder=tmp_path).contact
    assert check(study(BINS, **more)).contact == by_file


@pytest.mark.parametrize(
    ("sizes", "refusal"),
    [
        ({"edges": ["1 um"]}, refuses(Mistake.MISSING, "particles.sizes.counts")),
        (BINS | {"counts": [1]}, refuses(Mistake.SHAPE, "particles.sizes", says="5")),
        (
            BINS | {"count": [1]},
            refuses(Mistake.UNKNOWN, "particles.sizes.count", value="[1]", meant="counts"),
        ),
        (5, refuses(Mistake.KIND, "particles.sizes")),
    ],
)
def test_bins_with_a_mistake_are_told(sizes, refusal):
    with refusal as found:
        check(study(sizes))
    assert len(found.value.problems) == 1
