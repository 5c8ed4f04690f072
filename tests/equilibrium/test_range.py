"""Where states leave the range in which the model was compared with pressed surfaces."""

import warnings

import pytest

import thirdbody as tb
from thirdbody.papers import seats

CLOSE = "pressed point by point, surfaces with more than 0.05"


def told(contact, F_star):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        return " ".join(tb.solve(contact, F_star=F_star).warnings)


@pytest.mark.parametrize(("F_star", "warns"), [(1e-3, False), (2e-3, False), (4e-3, True)])
def test_large_areas_are_told_with_what_was_found_there(F_star, warns):
    """At F* = 2e-3 the model's area is 0.047, at 4e-3 0.092."""
    assert (CLOSE in told(seats.contact(300e-9), F_star)) == warns


def test_only_of_particles_on_the_rough_surface():
    """Nothing else was pressed: no particles on a plane, none without any."""
    contact = seats.contact(300e-9)
    assert CLOSE not in told(contact.replace(particles=None), 4e-3)
    assert CLOSE not in told(seats.contact(300e-9, "plane"), 4e-3)


def test_the_numbers_are_those_of_the_record():
    large = [state for state in seats.comparison() if state["group"] == "loads"]
    low = min(state["h_over_sigma"] - state["h_over_sigma_statistical"] for state in large)
    high = max(state["h_over_sigma"] - state["h_over_sigma_statistical"] for state in large)
    less = [1 - state["share"] / state["share_statistical"] for state in large]
    text = told(seats.contact(300e-9), 4e-3)
    assert f" {low:.2f} to {high:.2f} sigma" in text
    assert f"carried {100 * min(less):.0f} to {100 * max(less):.0f} % less" in text
