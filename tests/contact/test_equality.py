"""Contacts are equal where all of them is, and share tables where they carry load alike."""

import warnings

import pytest

import thirdbody as tb
from thirdbody.app.python_text import _code
from thirdbody.contact.interface import carrying, interface

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]


def contact(first: tb.Material = STEEL, body: tb.Material = SILICA, **more) -> tb.Contact:
    particles = tb.Particles(
        material=body,
        areal_density=1e10,
        diameter=tb.distributions.Monodisperse(mean=300e-9),
        name="dust",
    )
    return tb.Contact(
        surfaces=tb.MaterialPair(first, STEEL),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=particles,
        **more,
    )


OTHERS = {
    "thermal_conductivity": 11.0,
    "density": 5e3,
    "specific_heat": 700.0,
    "resistivity": 1e-7,
    "sigma_0": 1e8,
    "x_0": 1e-4,
    "m": 3.0,
}
"""What a body has besides what carries load."""


@pytest.mark.parametrize("name", OTHERS)
def test_every_number_of_a_body_counts_in_equality_and_none_of_these_in_tables(name):
    own, other = contact(), contact(STEEL.replace(**{name: OTHERS[name]}))
    grains = contact(body=SILICA.replace(**{name: OTHERS[name]}))
    assert own == contact()
    assert hash(own) == hash(contact())
    assert own != other
    assert own != grains
    assert interface(own) is interface(other) is interface(grains)
    assert own.surfaces.alike
    assert other.surfaces.alike


@pytest.mark.parametrize("name", ["E", "nu", "H", "K_c"])
def test_what_carries_load_has_tables_of_its_own(name):
    value = 1.01 * (getattr(STEEL, name) or 5e7)
    own, other = contact(), contact(STEEL.replace(**{name: value}))
    assert own != other
    assert interface(own) is not interface(other)
    assert not other.surfaces.alike


def test_labels_of_a_body_do_not_count():
    other = contact(STEEL.replace(name="another", source="a handbook"))
    assert other == contact()
    assert interface(other) is interface(contact())


def test_a_name_of_a_population_and_outputs_share_tables():
    own = contact()
    other = own.replace(**{"particles.name": "sand"}, outputs=(tb.outputs.Counts(),))
    assert own != other
    assert interface(own) is interface(other)


def test_a_conductivity_of_its_own_is_written_out():
    """The text of a contact of known materials names them only where nothing was changed."""
    known = next(body for body in map(tb.materials.__getitem__, tb.materials) if body.density)
    own = contact(known.replace(thermal_conductivity=11.5, resistivity=1e-6))
    made = eval(_code(own), {"tb": tb})
    assert made == own
    assert made.surfaces.first.thermal_conductivity == 11.5
    assert eval(_code(contact(known)), {"tb": tb}).surfaces.first == known


def test_tables_of_a_contact_do_not_warn_of_a_slip_again():
    with pytest.warns(tb.errors.RangeWarning, match="GPa"):
        soft = tb.Material(E=205.0, nu=0.3, H=5e9)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        slip = contact(soft)
        assert carrying(slip).surfaces.first.E == 205.0
