"""What the lists of laws and outputs say of their options."""

import re

import pytest

import thirdbody as tb
from thirdbody.laws import asperity, particle

from .test_cli import run

RAW = r"\d{6}|\de[+-]\d|\d\.0\b|\^"


@pytest.mark.parametrize("command", ["laws", "outputs"])
def test_defaults_are_said_with_their_units(command, monkeypatch):
    monkeypatch.setenv("COLUMNS", "240")
    shown = run(command).stdout
    names = {"laws": [*asperity.REGISTRY, *particle.REGISTRY], "outputs": tb.outputs.REGISTRY}
    assert all(name in shown for name in names[command])
    cells = []
    for table in re.findall(r"^ (?:options of|key).*\n ─+ *\n(?: +\S.*\n)+", shown, re.MULTILINE):
        head, _, *rows = table.splitlines()
        start, end = head.index("default"), head.index("allowed" if "allowed" in head else "mean")
        cells += [row[start:end].strip() for row in rows]
    assert not [cell for cell in cells if re.search(RAW, cell)]
    some = {"laws": {"200 GPa", "100 nm", "0.05 J/m²", '"hermite"', "true"}}
    some["outputs"] = {"1 mm²", "0 nm", '"by_hardness"', "required", "-"}
    assert some[command] <= set(cells)
