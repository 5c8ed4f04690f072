"""Materials, pairs of them, and the library that ships."""

import pytest
from hypothesis import given
from twins import bodies, material

import thirdbody as tb


def test_materials_of_the_paper():
    steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    assert (steel.E, steel.nu, steel.H) == (205e9, 0.29, 5e9)
    assert (silica.E, silica.nu, silica.H) == (68e9, 0.19, 7.7e9)
    assert tb.MaterialPair(steel, steel).E_star == pytest.approx(111.91e9, rel=1e-4)
    assert tb.MaterialPair(steel, silica).E_star == pytest.approx(53.64e9, rel=1e-4)


@given(first=bodies, second=bodies)
def test_pair(first, second):
    pair = tb.MaterialPair(material(first), material(second))
    turned = tb.MaterialPair(material(second), material(first))
    compliance = (1 - first.nu**2) / first.E + (1 - second.nu**2) / second.E
    assert pair.E_star == pytest.approx(1 / compliance, rel=1e-14)
    assert turned.E_star == pytest.approx(pair.E_star, rel=1e-15)
    assert pair.H == turned.H == min(first.H, second.H)
    assert pair == tb.MaterialPair(first=pair.first, second=pair.second)
    assert (pair == turned) == (first == second)


@given(body=bodies)
def test_rigid_partner(body):
    """Against a body that does not give, E* is the plane-strain modulus."""
    rigid = tb.Material(E=1e30, nu=0.0, H=1e30)
    pair = tb.MaterialPair(material(body), rigid)
    assert pair.E_star == pytest.approx(body.E / (1 - body.nu**2), rel=1e-12)
    assert pair.H == body.H


def test_library():
    assert {"S45C", "SiO2"} <= set(tb.materials)
    assert len(tb.materials) == len(list(tb.materials))
    for name in tb.materials:
        entry = tb.materials[name]
        assert entry.name == name
        assert entry.source, f"{name} has no source"
        # strain at yield of any solid: H/E between 1e-4 and 0.5
        assert 1e-4 < entry.H / entry.E < 0.5
        # a material that a user writes with the same numbers is the same material
        assert entry == tb.Material(E=entry.E, nu=entry.nu, H=entry.H)
        assert tb.Material.from_dict(entry.to_dict()) == entry


def test_unknown_material():
    with pytest.raises(KeyError, match="did you mean 'S45C'"):
        tb.materials["S45c"]
    with pytest.raises(tb.InvalidValue, match="not in the library"):
        tb.materials["unobtainium"]
    assert "unobtainium" not in tb.materials
    assert tb.materials.get("unobtainium") is None
