"""Bodies, waves and films of which some places are crowded: no answer of theirs is "ok"."""

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.equilibrium.crowding import crowded_places
from thirdbody.equilibrium.status import MOST_AREA
from thirdbody.quantities.say import number
from thirdbody.systems.bodies import BallInGroove, BallOnFlat, press
from thirdbody.systems.rough_body import curve, rough_cylinder, rough_sphere
from thirdbody.systems.waviness import elastic_wave, measured_wave, rigid_wave

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
SOFT = tb.Material(E=200e9, nu=0.3, H=1e9)
CONTACT = tb.Contact(
    surfaces=tb.MaterialPair(SOFT, SOFT), roughness=tb.Roughness(sigma=100e-9, R=2.8e-6)
)
HEIGHTS = 60e-9 * np.cos(np.linspace(0, 2 * np.pi, 33)[:-1])
SYSTEMS = {
    "sphere": lambda load: rough_sphere(CONTACT, radius=5e-3, load=load),
    "cylinder": lambda load: rough_cylinder(CONTACT, radius=5e-3, load=18e3 * load),
    "rigid wave": lambda load: rigid_wave(CONTACT, amplitude=60e-9, pressure=100e6 * load),
    "elastic wave": lambda load: elastic_wave(
        CONTACT, amplitude=60e-9, wavelength=2e-5, pressure=100e6 * load
    ),
    "measured wave": lambda load: measured_wave(CONTACT, heights=HEIGHTS, pressure=100e6 * load),
}


def places(name, found):
    """Real area and load of every place, the load but for a factor."""
    if "wave" in name:
        gap, load = found.gap, found.weight * found.local_pressure
    else:
        # equal steps would weigh otherwise: over r for lines, over r^2 for rings
        edges = np.interp(np.arange(len(found.r) + 1) - 0.5, np.arange(len(found.r)), found.r)
        ring = np.diff(edges ** (2 if name == "sphere" else 1))
        gap, load = found.gap, ring * found.pressure
    return tb.solve(CONTACT, d=gap).A_t, load


@pytest.mark.parametrize("name", SYSTEMS)
def test_places_that_are_crowded_are_told(name):
    shares = []
    for load in (0.2, 4.0):
        found = SYSTEMS[name](load)
        A_t, weight = places(name, found)
        close = A_t > MOST_AREA
        assert found.crowded_share == pytest.approx(weight[close].sum() / weight.sum(), abs=0.02)
        shares.append(found.crowded_share)
        if not close.any():
            assert (found.status, found.warnings) == ("ok", ())
        else:
            assert found.status.startswith("crowded: ")
            assert number(MOST_AREA) in found.status
            assert found.status in found.warnings
    assert shares[0] == 0 < shares[1] <= 1


def test_a_plain_law_of_pressure_says_nothing_of_areas():
    found = rough_sphere(
        lambda gap: (1e9 * np.exp(-gap / 1e-7), -1e16 * np.exp(-gap / 1e-7)),
        radius=5e-3, load=50.0, E_star=1e11,
    )  # fmt: skip
    assert (found.crowded_share, found.status) == (None, "ok")


def test_a_law_of_the_whole_surface_counts_no_contacts():
    field = CONTACT.replace(asperity_law=tb.asperity.REGISTRY["field"]())
    A_t, load = np.array([0.2, 0.9]), np.ones(2)
    assert crowded_places(field, A_t, load) == (0.0, "ok")
    assert crowded_places(CONTACT, A_t, load)[0] == 0.5


def test_columns_over_the_load_have_the_share():
    found = curve(CONTACT, radius=5e-3, loads=[0.2, 4.0])
    assert found["crowded_share"][0] == 0 < found["crowded_share"][1]


@pytest.mark.parametrize(
    ("body", "method", "largest"),
    [
        (BallOnFlat(diameter=10e-3), "rough body", 0.85e9),
        (BallInGroove(diameter=10e-3, conformity=0.6), "Hertz pressure", 0.7e9),
    ],
)
def test_a_body_that_is_crowded_warns_of_its_numbers(body, method, largest):
    shares = []
    for pressure in (0.3e9, largest):
        force = 1.0 * (pressure / body.hertz(1.0, CONTACT.E_ss).maximum) ** 3
        found = press(CONTACT, body, force)
        assert found.method == method
        assert found.real_area > 0
        told = [each for each in found.warnings if "crowded: more than 0.5" in each]
        shares.append(len(told))
        assert found.note == (told[0].split(": ", 1)[1] if told else "")
    assert shares == [0, 1]


def test_a_film_that_is_crowded_says_so():
    asked = dict(conjunction=tb.films.Point(R=5e-3), oil=tb.films.Oil(eta=0.02, alpha=2e-8))
    found = tb.films.mixed_film(CONTACT, load=[0.2, 6.0], speed=[1e-3, 1e-6], **asked)
    assert found.A_t[0] < MOST_AREA < found.A_t[1]
    assert found.status[0] == "ok"
    assert found.status[1].startswith("crowded: more than 0.5")
    assert found.columns()["status"].tolist() == found.status.tolist()
    one = tb.films.mixed_film(CONTACT, load=6.0, speed=1e-6, **asked)
    assert one.status == found.status[1]
