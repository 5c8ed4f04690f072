"""What the book needs beyond Sphinx: figures of the gallery, units of every input and column."""

import dataclasses
import inspect
import re
from pathlib import Path

from facts import insert_facts
from matplotlib.figure import Figure
from pages import insert_generated
from search import find_digits, insert_keywords
from sphinx_gallery.scrapers import figure_rst

SEEN = "_figures_shown"


def save_figures(block, block_vars, gallery_conf):
    """Save what an example calls ``figure`` or ``figures``; no global state of pyplot needed."""
    names = block_vars["example_globals"]
    found = names.get("figures", names.get("figure", []))
    found = [found] if isinstance(found, Figure) else list(found)
    shown = names.setdefault(SEEN, [])
    images = []
    for figure in found:
        if any(figure is one for one in shown):
            continue
        shown.append(figure)
        image = Path(next(block_vars["image_path_iterator"]))
        image.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(image, dpi=150, facecolor="white")
        images.append(str(image))
    return "".join(figure_rst([image], gallery_conf["src_dir"]) for image in images)


def set_colours(gallery_conf, example):
    """Before each example: the colours of the book, told apart by everybody."""
    import matplotlib as mpl

    from thirdbody.views.plot.style import OKABE_ITO

    names = ("blue", "vermilion", "green", "purple", "orange", "sky")
    mpl.rcParams["axes.prop_cycle"] = mpl.cycler(color=[OKABE_ITO[name] for name in names])


def inputs(value):
    """Rows (name, symbol, unit, meaning, range) of the numbers that a class takes."""
    from thirdbody.quantities.value import allowed_range

    rows = []
    for item in dataclasses.fields(value):
        if about := item.metadata.get("quantity"):
            allowed = allowed_range(about).split("[")[0].strip()
            if item.default is not dataclasses.MISSING:
                default = "optional" if item.default is None else f"default {item.default:g}"
                allowed = f"{allowed}; {default}" if allowed else default
            rows.append(
                [f"``{item.name}``", about["symbol"], about["unit"], about["meaning"], allowed]
            )
    return rows


def columns(result):
    """Rows (name, symbol, unit, meaning) of the columns that an answer has."""
    from thirdbody.quantities.record import declared_columns

    declared = declared_columns(result)
    return [[f"``{name}``", *(cell.replace("|", r"\|") for cell in about)]
            for name, about in declared.items()]  # fmt: skip


def table(title, head, rows):
    """A list-table in reStructuredText; none without rows."""
    lines = [f".. list-table:: {title}", "   :header-rows: 1", "   :widths: auto", ""]
    for row in [head, *rows]:
        lines += [f"   {'*' if i == 0 else ' '} - {cell}".rstrip() for i, cell in enumerate(row)]
    return ["", *lines, ""] if rows else []


def add_units(app, what, name, obj, options, lines):
    """Append the declared units of a value, or the columns of an answer, to its docstring."""
    if inspect.isclass(obj) and dataclasses.is_dataclass(obj):
        head = ["name", "symbol", "unit", "meaning"]
        lines += table("Numbers it takes", [*head, "allowed"], inputs(obj))
        lines += table("Columns of the answer", head, columns(obj))


def plain_bars(app, what, name, obj, options, lines):
    """|x| in a docstring is an absolute value, not a substitution."""
    in_math = False
    for i, line in enumerate(lines):
        if line.strip():
            in_math = line.lstrip().startswith(".. math::") or (in_math and line.startswith(" "))
        if "|" in line and not in_math and ":math:" not in line and "``" not in line:
            lines[i] = line.replace("|", r"\|")


COLON = "\ue000"


def hide_colon(app, what, name, obj, options, lines):
    """napoleon takes words before a colon for the type of an attribute; these are a sentence."""
    if what in ("attribute", "data", "property") and lines:
        lines[0] = re.sub(r"(?<!:):(?= |$)", COLON, lines[0])


def show_colon(app, what, name, obj, options, lines):
    """After napoleon, the colon is back."""
    lines[:] = [line.replace(COLON, ":") for line in lines]


# pages of the repository outside docs/, and where the book shows them
ELSEWHERE = {
    "../benchmarks/results.md": "speed.md",
    "CHANGELOG.md": "changelog.md",
    "CONTRIBUTING.md": "contribute.md",
}
INCLUDE = re.compile(r"^```\{include\} (\S+)\n```$", re.M)


def stay_in_the_book(app, docname, source):
    """Put included pages in place; links between pages of the repository lead within the book."""
    folder = Path(app.srcdir)
    text = INCLUDE.sub(lambda found: (folder / found[1]).read_text("utf-8"), source[0])
    for outside, inside in ELSEWHERE.items():
        text = text.replace(f"]({outside})", f"]({inside})").replace(
            f"](../{outside})", f"]({inside})"
        )
    text = insert_facts(text.replace("](docs/", "]("), docname)
    source[0] = insert_keywords(insert_generated(text), docname)


def setup(app):
    app.connect("source-read", stay_in_the_book)
    app.connect("build-finished", find_digits)
    app.connect("autodoc-process-docstring", plain_bars, priority=100)
    app.connect("autodoc-process-docstring", hide_colon, priority=100)
    app.connect("autodoc-process-docstring", show_colon, priority=900)
    # after napoleon, which would read the table as a part of its last section
    app.connect("autodoc-process-docstring", add_units, priority=900)
    return {"parallel_read_safe": True}
