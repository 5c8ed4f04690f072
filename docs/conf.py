"""How the book of thirdbody is built: `make docs`, or sphinx-build -W docs docs/_build/html."""

import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE / "_ext"), str(HERE.parent / "src")]

import thirdbody  # noqa: E402

# the API pages call things by the names that users write
for _name in thirdbody._MODULES:
    sys.modules.setdefault(f"thirdbody.{_name}", getattr(thirdbody, _name))
sys.modules.setdefault("thirdbody.oil.until", thirdbody.oil.until)

project = "thirdbody"
author = "The thirdbody developers"
version = release = thirdbody.__version__
language = "en"

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
    "sphinx.ext.napoleon",
    "sphinx_gallery.gen_gallery",
    "myst_nb",
    "book",
]
source_suffix = {".rst": "restructuredtext", ".md": "myst-nb", ".ipynb": "myst-nb"}
exclude_patterns = [
    "_build",
    "_ext",
    "_templates",
    "**.ipynb_checkpoints",
    "_cases",
    *(
        f"{made}/**.{end}"
        for made in ("gallery", "cases")
        for end in ("ipynb", "py.md5", "codeobj.json")
    ),
]
templates_path = ["_templates"]
default_role = "py:obj"
# `pressure` in a docstring is a word here: several classes have one, and none is meant
suppress_warnings = ["ref.python"]
highlight_language = "none"  # a block without a language is output
html_copy_source = False
html_show_sourcelink = False

# ---------------------------------------------------------------- pages in Markdown
myst_enable_extensions = ["dollarmath", "amsmath", "colon_fence", "deflist", "attrs_inline"]
myst_dmath_double_inline = True
myst_heading_anchors = 3
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 300
nb_merge_streams = True

# ---------------------------------------------------------------- the API
autosummary_generate = True
autodoc_typehints = "none"
autodoc_member_order = "bysource"
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True

# ---------------------------------------------------------------- the gallery, and the cases
# the worked examples are files of their own for whoever runs them; the gallery wants a folder
CASES = HERE / "_cases"
CASES.mkdir(exist_ok=True)
for _file in sorted((HERE.parent / "examples").glob("*.py")):
    shutil.copyfile(_file, CASES / _file.name)
shutil.copyfile(HERE.parent / "examples" / "additive.toml", CASES / "additive.toml")
(CASES / "GALLERY_HEADER.rst").write_text(
    "Worked programs\n===============\n\nEach draws a figure and ends in a sentence to act on.\n",
    "utf-8",
)

sphinx_gallery_conf = {
    "examples_dirs": ["../examples/gallery", "_cases"],
    "gallery_dirs": ["gallery", "cases"],
    "filename_pattern": r"\.py$",
    "image_scrapers": ("book.save_figures",),
    "reset_modules": ("matplotlib", "book.set_colours"),
    "within_subsection_order": "FileNameSortKey",
    "abort_on_example_error": True,
    "capture_repr": (),
    "download_all_examples": False,
    "show_signature": False,
    "show_memory": False,
    "min_reported_time": 1e9,
    "remove_config_comments": True,
    "doc_module": ("thirdbody",),
    "backreferences_dir": "gallery/uses",
    "write_computation_times": False,
}

# ---------------------------------------------------------------- HTML, complete in itself
html_theme = "pydata_sphinx_theme"
html_title = "thirdbody"
html_static_path = ["_static"]
html_css_files = ["book.css"]
html_theme_options = {
    "show_prev_next": True,
    "navigation_with_keys": False,
    "header_links_before_dropdown": 8,
    "navbar_align": "left",
    "secondary_sidebar_items": ["page-toc"],
    "navbar_end": ["version.html", "theme-switcher", "navbar-icon-links"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "pygments_light_style": "a11y-high-contrast-light",
    "pygments_dark_style": "a11y-high-contrast-dark",
    "back_to_top_button": False,
}
copyright = "the thirdbody developers, BSD-3-Clause"

# MathJax in one file, from an installed package: no page asks another machine for it
MATHJAX = "tex-svg.js"
_package = find_spec("sphinx-mathjax-offline")
if _package is None:
    raise SystemExit("the book needs the extra docs: pip install -e '.[docs]'")
html_static_path.append(str(Path(_package.origin).parent / "static" / "mathjax" / MATHJAX))
mathjax_path = MATHJAX
mathjax3_config = {"svg": {"fontCache": "global"}, "options": {"enableMenu": False}}
