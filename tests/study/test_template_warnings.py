"""A study from a template warns of at most two things, each with what to do about it."""

from importlib import resources

import pytest

from thirdbody.cli.commands.new import KINDS as TEMPLATES
from thirdbody.study import load_study, run_film, run_study

ADVICE = (
    "solve again with",
    'the asperity law "field"',
    'few = "mean"',
    "assess",
    "quote them with their cut-off",
    "take ",
    "give ",
)

OF_THE_FILM = ("ball-bearing", "roller-bearing")
"""Templates whose answer is that of the film, and which no dry contact stands for."""


@pytest.mark.parametrize("name", TEMPLATES)
def test_a_template_warns_of_two_things_at_most(name):
    path = resources.files("thirdbody").joinpath(f"data/studies/{name}.toml")
    with resources.as_file(path) as file:
        asked = load_study(file)
        found = run_film(asked) if name in OF_THE_FILM else run_study(asked)
    warnings = [text for text in found["warnings"] if text not in asked.assumed]
    assert len(warnings) <= 2, warnings
    for text in warnings:
        assert any(word in text for word in ADVICE), text
    assert len(asked.assumed) <= 1
