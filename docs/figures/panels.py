"""Draw the panels of papers that stand in the book, without the title: the page has a caption."""

from pathlib import Path

from thirdbody.papers import ghaednia2014
from thirdbody.papers.measurements import trezona1999
from thirdbody.papers.panels import draw

HERE = Path(__file__).parent


def draw_panel(panel, name):
    """One panel as a picture of its own."""
    figure = draw(panel)
    for text in list(figure.texts):
        text.remove()
    figure.savefig(HERE / f"{name}.png", dpi=150, bbox_inches="tight", facecolor="white")


if __name__ == "__main__":
    (wear,) = trezona1999.ROW.panels
    draw_panel(wear(), "measurements_wear")
    for number, name in ((1, "area"), (2, "exponent")):
        draw_panel(ghaednia2014.STUDY.panels[number](), f"ghaednia2014_{name}")
