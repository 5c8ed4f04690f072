"""A study from a template warns of at most two things, each with what to do about it."""

from importlib import resources

import pytest

from thirdbody.cli.commands.new import KINDS as TEMPLATES
from thirdbody.study import load_study, run_film, run_study
from thirdbody.study.run_connector import load_connector, run_connector
from thirdbody.study.run_plate import load_plate, run_plate

ADVICE = (
    "solve again with",
    'the asperity law "field"',
    'few = "mean"',
    "assess",
    "quote them with their cut-off",
    "take ",
    "give ",
)

ANSWERS = {
    "ball-bearing": run_film,
    "roller-bearing": run_film,
    "connector": run_connector,
    "wafer-chuck": run_plate,
}
"""What answers a template that no dry contact stands for."""
READERS = {"connector": load_connector, "wafer-chuck": load_plate}


@pytest.mark.check
@pytest.mark.spread(3)
@pytest.mark.parametrize("name", TEMPLATES)
def test_a_template_warns_of_two_things_at_most(name):
    path = resources.files("thirdbody").joinpath(f"data/studies/{name}.toml")
    with resources.as_file(path) as file:
        asked = READERS.get(name, load_study)(file)
        found = ANSWERS.get(name, run_study)(asked)
    assumed = getattr(asked, "assumed", ())
    of_files = (*assumed, *getattr(found, "oil_notes", ()))  # what the head of a template says
    warnings = [text for text in found.warnings if text not in of_files]
    assert len(warnings) <= 2, warnings
    for text in warnings:
        assert any(word in text for word in ADVICE), text
    assert len(assumed) <= 1
