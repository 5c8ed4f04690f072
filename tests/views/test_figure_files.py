"""Figures as files."""

import io

import matplotlib as mpl
import pytest
from matplotlib.figure import Figure

from thirdbody.views.figure_files import save_figure

OPTIONS = {
    "png": {"dpi": 180, "metadata": {"Software": None}},
    "svg": {"metadata": {"Date": None}},
    "pdf": {"metadata": {"CreationDate": None}},
}


def drawn(layout):
    figure = Figure(figsize=(5, 3), layout=layout)
    for ax in figure.subplots(1, 2):
        ax.semilogy([0, 1, 2], [1e-3, 1, 20], label="a curve")
        ax.set(xlabel="force [N]", ylabel="area\nin two lines", title="a title")
        ax.legend()
    return figure


def written(save, figure, kind):
    file = io.BytesIO()
    with mpl.rc_context({"svg.hashsalt": "thirdbody"}):
        save(figure, file, kind)
    return file.getvalue()


def plain(figure, file, kind):
    figure.savefig(file, format=kind, **OPTIONS[kind])


def ours(figure, file, kind):
    save_figure(figure, file, kind, **OPTIONS[kind])


@pytest.mark.check
@pytest.mark.parametrize("kind", OPTIONS)
@pytest.mark.parametrize("layout", ["constrained", "tight", "none"])
def test_a_figure_has_the_bytes_that_matplotlib_gives_it(kind, layout):
    """And its size and resolution afterwards."""
    figure = drawn(layout)
    assert written(ours, figure, kind) == written(plain, drawn(layout), kind)
    assert figure.dpi == drawn(layout).dpi
    assert figure.get_size_inches().tolist() == [5, 3]


@pytest.mark.parametrize("kind", OPTIONS)
def test_a_figure_is_drawn_once(kind, monkeypatch):
    drawings = []
    draw = Figure.draw
    monkeypatch.setattr(Figure, "draw", lambda self, to: drawings.append(to) or draw(self, to))
    figure = drawn("constrained")
    written(ours, figure, kind)
    written(ours, figure, "png")
    assert len(drawings) == 2


def test_a_second_file_has_the_places_of_the_first():
    figure = drawn("constrained")
    written(ours, figure, "png")
    before = [ax.get_position().bounds for ax in figure.axes]
    written(ours, figure, "svg")
    assert [ax.get_position().bounds for ax in figure.axes] == before
    assert before != [ax.get_position().bounds for ax in drawn("none").axes]
