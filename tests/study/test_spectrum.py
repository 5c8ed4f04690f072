"""Waves of the roughness in a study file, for the law of one field."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from refusals import Mistake, refuses

import thirdbody as tb
from thirdbody.laws.asperity import Field, OwnSpectrum, RollOff
from thirdbody.populations.measured.topography import from_topography
from thirdbody.study import load_study

ROUGH = 'sigma = "100 nm"\nR = "2.8 um"'


def study(tmp_path, law, rough=ROUGH):
    path = tmp_path / "study.toml"
    path.write_text(
        f'[surfaces]\nfirst = "S45C"\nsecond = "S45C"\n[roughness]\n{rough}\n'
        f'[asperity_law]\nname = "field"\n{law}\n[load]\nF_star = 1e-3\n'
    )
    return load_study(path)


def test_another_roll_off(tmp_path):
    found = study(tmp_path, 'spectrum = { hurst = 0.5, corner = "sharp" }').contact
    assert found.asperity_law == Field(spectrum=RollOff(hurst=0.5, corner="sharp"))
    assert tb.Contact.from_dict(found.to_dict()) == found
    usual = study(tmp_path, "remainder = true").contact
    assert usual.asperity_law.spectrum is None
    one, other = (tb.solve(each, F_star=1e-3).h / 100e-9 for each in (found, usual))
    assert 0.001 < abs(one - other) < 0.1


def test_the_usual_roll_off_is_the_table(tmp_path):
    named = study(tmp_path, "spectrum = { hurst = 0.8 }").contact
    usual = study(tmp_path, "").contact
    assert tb.solve(named, F_star=1e-3).h == tb.solve(usual, F_star=1e-3).h


def test_solved_and_stored_tables_agree():
    """A roll-off hardly different from the usual one is solved anew, and is as the table says."""
    steel = tb.materials["S45C"]
    case = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel), roughness=tb.Roughness(sigma=1e-7, R=2.8e-6)
    )
    loads = np.array([1e-5, 1e-3, 5e-3])
    near, table = (
        tb.solve(case.replace(asperity_law=Field(spectrum=spectrum)), F_star=loads)
        for spectrum in (RollOff(hurst=0.8 + 1e-7), None)
    )
    assert near.h == pytest.approx(table.h, rel=2e-4)
    assert near.A_t == pytest.approx(table.A_t, rel=5e-3)


def test_a_measured_surface_brings_its_waves(tmp_path):
    found = study(tmp_path, 'spectrum = "measured"', 'topography = "example"').contact
    own = found.asperity_law.spectrum
    assert own == OwnSpectrum.of(from_topography("example"))
    assert own.spectrum.alpha == pytest.approx(found.roughness.alpha, rel=0.25)
    assert tb.Contact.from_dict(found.to_dict()) == found
    assert tb.solve(found, F_star=1e-3).h > 0


def test_two_faces_add_their_waves(tmp_path):
    both = study(tmp_path, 'spectrum = "measured"', 'topography = ["example", "example"]').contact
    one = study(tmp_path, 'spectrum = "measured"', 'topography = "example"').contact
    one_own, own = (each.asperity_law.spectrum for each in (one, both))
    assert own.q == one_own.q
    assert own.weight == pytest.approx(one_own.weight, rel=1e-12)
    assert sum(own.weight) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("law", "rough", "refusal"),
    [
        (
            'spectrum = "measured"',
            ROUGH,
            refuses(Mistake.IDLE, "asperity_law.spectrum", value='"measured"'),
        ),
        ('spectrum = "own"', ROUGH, refuses(Mistake.KIND, "asperity_law.spectrum", value='"own"')),
        ("spectrum = 3", ROUGH, refuses(Mistake.KIND, "asperity_law.spectrum", value="3")),
        (
            "spectrum = { hurst = 1.5 }",
            ROUGH,
            refuses(Mistake.RANGE, "asperity_law.spectrum.hurst", value="1.5"),
        ),
        (
            'spectrum = { corner = "shrp" }',
            ROUGH,
            refuses(Mistake.OPTION, "asperity_law.spectrum.corner", value='"shrp"', meant="sharp"),
        ),
        (
            "spectrum = { hurts = 0.5 }",
            ROUGH,
            refuses(Mistake.UNKNOWN, "asperity_law.spectrum.hurts", value="0.5", meant="hurst"),
        ),
        (
            'spectrum = "measured"',
            'topography = "none.x3p"',
            refuses(Mistake.UNREADABLE, "roughness.topography"),
        ),
    ],
)
def test_mistakes_in_words(tmp_path, law, rough, refusal):
    with refusal as told:
        study(tmp_path, law, rough)
    assert len(told.value.problems) == 1


def test_maps_with_gaps():
    whole = from_topography("example")
    z = np.array(whole.heights)
    assert np.isnan(z).any()
    z[:, :20] = np.nan
    with refuses(Mistake.BEYOND, "", says="16 %"):
        OwnSpectrum.of(from_topography(z, spacing=whole.spacing))


def test_listed_with_the_laws():
    (item,) = [each for each in dataclasses.fields(Field) if each.name == "spectrum"]
    from thirdbody.cli.commands.laws import _about_law

    options = {option["key"]: option for option in _about_law(Field)["options"]}
    assert list(options) == ["remainder", "spectrum"]
    assert options["spectrum"]["allowed"] == item.metadata["table"]["allowed"]
