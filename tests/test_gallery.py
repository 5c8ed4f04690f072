"""Each example of the gallery runs as plain Python, draws, and checks a number."""

import ast
import runpy
import warnings
from pathlib import Path

import pytest
from matplotlib.figure import Figure

import thirdbody as tb
from thirdbody.papers.horng2022 import PANELS

pytestmark = pytest.mark.check
GALLERY = Path(__file__).parent.parent / "examples" / "gallery"
EXAMPLES = sorted(GALLERY.glob("*/*.py"))


@pytest.mark.parametrize("file", EXAMPLES, ids=lambda file: f"{file.parent.name}/{file.stem}")
def test_example(file, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    tree = ast.parse(file.read_text("utf-8"))
    assert any(isinstance(node, ast.Assert) for node in tree.body), "checks no number"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        names = runpy.run_path(str(file))
    figures = names.get("figures") or [names["figure"]]
    for figure in figures:
        assert isinstance(figure, Figure)
        assert any(ax.has_data() for ax in figure.axes)
        figure.savefig(tmp_path / "figure.png")


def test_there_are_enough_and_every_figure_of_the_paper():
    assert len(EXAMPLES) >= 15
    text = "".join(file.read_text("utf-8") for file in GALLERY.glob("paper/*.py"))
    assert [name for name in PANELS if f'"{name}"' not in text] == []
