"""The book as HTML: it asks nothing from outside, and its search leads where people want to go."""

import contextlib
import http.server
import importlib.util
import re
import shutil
import subprocess
import sys
import threading
import urllib.parse
from pathlib import Path

import pytest

import thirdbody as tb

pytestmark = pytest.mark.check
ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"


OUTSIDE = re.compile(
    r"<(?:script|img|iframe|source|video|audio|embed|object)\b[^>]*\b(?:src|data|srcset)="
    r"[\"'](?:https?:)?//[^\"']*|"
    r"<link\b(?=[^>]*rel=[\"'](?:stylesheet|preload|preconnect|icon|prefetch|manifest))"
    r"[^>]*href=[\"'](?:https?:)?//[^\"']*"
)
OUTSIDE_CSS = re.compile(r"@import\s+[\"'(]*(?:https?:)?//|url\([\"']?(?:https?:)?//[^)]*")


def test_the_search_for_requests_finds_them():
    """The patterns above would see each way to fetch."""
    for text in (
        '<script src="https://x.org/a.js">',
        '<link rel="stylesheet" href="https://x.org/a.css">',
        '<link href="//x.org/a.css" rel="stylesheet">',
        '<img alt="" src="http://x.org/a.png">',
    ):
        assert OUTSIDE.search(text), text
    assert OUTSIDE_CSS.search("@font-face{src:url(https://x.org/a.woff2)}")
    assert not OUTSIDE.search('<a href="https://doi.org/1"> <script src="_static/a.js">')


@pytest.fixture(scope="module")
def book(tmp_path_factory):
    """The book as HTML, built once."""
    for name in ("sphinx", "sphinx_gallery", "myst_nb", "pydata_sphinx_theme"):
        if importlib.util.find_spec(name) is None:
            pytest.skip(f"{name} is not installed; pip install -e '.[docs]'")
    # in a copy: the build writes pages of the gallery and of the API beside its sources
    folder = tmp_path_factory.mktemp("book")
    ignore = shutil.ignore_patterns("_build", "_cases", "gallery.*", "__pycache__")
    for part in ("docs", "examples", "benchmarks", "src"):
        shutil.copytree(ROOT / part, folder / part, ignore=ignore)
    for made in ("gallery", "api", "cases", "_cases"):
        shutil.rmtree(folder / "docs" / made, ignore_errors=True)
    for file in ROOT.glob("*.md"):
        shutil.copy(file, folder)
    # of the tutorials one runs in a kernel; tests/test_docs.py runs the code of each
    with (folder / "docs" / "conf.py").open("a", encoding="utf-8") as conf:
        conf.write('nb_execution_excludepatterns = ["oil-report.ipynb"]\n')
    out = folder / "html"
    # one example of the gallery is drawn; tests/test_gallery.py runs every one
    few = ["-D", "sphinx_gallery_conf.filename_pattern=01_one_asperity"]
    command = [sys.executable, "-m", "sphinx", "-W", "-q", "-b", "html", *few, folder / "docs", out]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-3000:]
    return out


@pytest.mark.slow
def test_the_book_asks_nothing_from_outside(book):
    pages = list(book.rglob("*.html"))
    assert len(pages) > 100
    for page in pages:
        assert not OUTSIDE.findall(page.read_text("utf-8")), page.name
    for sheet in book.rglob("*.css"):
        assert not OUTSIDE_CSS.findall(sheet.read_text("utf-8")), sheet.name
    assert 'src="_static/tex-svg.js' in (book / "theory.html").read_text("utf-8")


@pytest.mark.slow
def test_the_search_of_the_book_finds_an_equation_by_its_number(book):
    """In a real browser: "Equation 9" leads to the heading over sigma_s, and asks nobody else."""
    api = pytest.importorskip("playwright.sync_api", reason="needs playwright to drive a browser")
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        pytest.skip("needs chromium")
    with api.sync_playwright() as playwright, served(book) as address:
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        page = browser.new_page()
        asked = []
        page.on("request", lambda request: asked.append(request.url))
        page.goto(f"{address}/search.html?q=Equation+9")
        found = page.locator("#search-results ul.search li > a")
        heading = found.filter(has_text=re.compile(r"Equation 9: sigma_s$"))
        heading.first.wait_for(timeout=30_000)
        places = [link.get_attribute("href") for link in found.all()]
        # the page first, and the heading among the first of its results
        assert places[0].startswith("equations.html")
        assert "equations.html#equation-9-sigma-s" in places[:5]
        heading.first.click()
        page.wait_for_url("**/equations.html**#equation-9-sigma-s")
        section = page.locator("section#equation-9-sigma-s")
        assert section.locator("h2").inner_text().startswith("Equation 9")
        section.locator("mjx-container svg").first.wait_for(timeout=30_000)
        assert "Roughness.sigma_s" in section.inner_text()
        assert section.bounding_box()["y"] < page.viewport_size["height"]
        browser.close()
    assert [url for url in asked if not url.startswith((address, "data:", "blob:"))] == []


# what people type, and the page that they want
SEARCHES = {
    "install": "install",
    "quickstart": "start",
    "FAQ": "faq",
    "no equilibrium": "faq",
    "NaN": "faq",
    "gasket": "faq",
    "fretting": "faq",
    "ISO 4406": "dust",
    "ISO4406": "dust",
    "4406": "dust",
    "NAS 1638": "dust",
    "test dust": "dust",
    "debris": "dust",
    "bearing": "bearings",
    "6205": "bearings",
    "ISO 281": "bearings",
    "ball screw": "cases",
    "additive": "cases",
    "connector": "connector",
    "relay": "connector",
    "contact resistance": "conductance",
    "wafer": "wafer",
    "EHL": "lubrication",
    "Stribeck": "lubrication",
    "Hertz": "bodies",
    "friction": "friction",
    "wear": "wear",
    "Ra": "surfaces",
    "Greenwood-Williamson": "choose-a-law",
    "Abaqus": "tables",
    "Excel": "files",
    "Tamaas": "others",
    "BibTeX": "cite",
    "error bars": "uncertainty",
    "study file": "study-file",
    "command line": "commands",
    "columns": "columns",
    "glossary": "glossary",
    "what's new": "changes",
    "Equation 9": "equations",
}


@pytest.mark.slow
def test_the_search_of_the_book_leads_to_the_page(book):
    """In a real browser: the first result for each of the words that people type."""
    api = pytest.importorskip("playwright.sync_api", reason="needs playwright to drive a browser")
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        pytest.skip("needs chromium")
    first = {}
    with api.sync_playwright() as playwright, served(book) as address:
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        page = browser.new_page()
        for words in SEARCHES:
            page.goto(f"{address}/search.html?q={urllib.parse.quote_plus(words)}")
            link = page.locator("#search-results ul.search li > a").first
            link.wait_for(timeout=30_000)
            first[words] = link.get_attribute("href").partition(".html")[0]
        browser.close()
    assert first == SEARCHES


# ---------------------------------------------------------------- the switch between versions
def fake_books(folder, **pages_of):
    """Books of several versions with the header of the real one, in a folder that make docs wrote."""
    jinja2 = pytest.importorskip("jinja2", reason="needs the extra docs")
    made = importlib.util.spec_from_file_location("versions_of_book", DOCS / "versions.py")
    versions = importlib.util.module_from_spec(made)
    made.loader.exec_module(versions)
    header = jinja2.Template((DOCS / "_templates" / "version.html").read_text("utf-8"))
    for version, pages in pages_of.items():
        book = folder / version.removeprefix("v").replace("_", ".")
        (book / "_static").mkdir(parents=True)
        (book / "objects.inv").touch()
        shutil.copy(DOCS / "_static" / "version.js", book / "_static")
        for page in pages:
            root = "../" * page.count("/") or "./"
            shown = header.render(
                version=book.name,
                pagename=page,
                pathto=lambda name, _, root=root: f"{root}{name}",
            )
            file = book / f"{page}.html"
            file.parent.mkdir(exist_ok=True)
            # the theme has the header twice: in a window for telephones it is in the side bar
            file.write_text(f"<!doctype html><p>{page}</p>{shown}{shown}", "utf-8")
    versions.add_switch(folder, book.name)


@contextlib.contextmanager
def chromium_page():
    """A page of a browser without a window, and what it says of mistakes."""
    api = pytest.importorskip("playwright.sync_api", reason="needs playwright to drive a browser")
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        pytest.skip("needs chromium")
    with api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        page = browser.new_page()
        page.set_default_timeout(30_000)
        mistakes = []
        page.on("pageerror", lambda mistake: mistakes.append(str(mistake)))
        yield page, mistakes
        browser.close()


SWITCH = ".book-version select"


@pytest.mark.slow
def test_the_switch_leads_to_the_same_page_of_another_version(tmp_path):
    """In a real browser: there and back, and to the first page where the other has no such page."""
    both = ["index", "theory", "api/solve"]
    fake_books(tmp_path, v0_9=both, v0_10=[*both, "new"])
    with chromium_page() as (page, mistakes), served(tmp_path) as address:
        page.goto(address)  # the folder leads to the version that was built
        page.wait_for_url("**/0.10/index.html")
        for here, there in (("theory", "theory"), ("api/solve", "api/solve"), ("new", "index")):
            page.goto(f"{address}/0.10/{here}.html")
            assert page.locator(SWITCH).count() == 2
            for switch in page.locator(SWITCH).all():
                assert switch.locator("option").all_inner_texts() == ["version 0.10", "version 0.9"]
                assert switch.input_value() == "0.10"
            page.locator(SWITCH).last.select_option("0.9")
            page.wait_for_url(f"{address}/0.9/{there}.html")
            assert page.locator(SWITCH).first.input_value() == "0.9"
            page.go_back()
            page.wait_for_url(f"{address}/0.10/{here}.html")
            assert page.locator(SWITCH).first.input_value() == "0.10"
        # a folder that is opened without a server
        page.goto((tmp_path / "0.9" / "theory.html").as_uri())
        page.locator(SWITCH).first.select_option("0.10")
        page.wait_for_url("**/0.10/index.html")
    assert mistakes == []


@pytest.mark.slow
def test_a_version_alone_has_no_switch(tmp_path):
    fake_books(tmp_path / "one", v0_9=["index"])
    fake_books(tmp_path / "none", v0_9=["index"])
    (tmp_path / "none" / "versions.js").unlink()  # a book that was taken out of its folder
    with chromium_page() as (page, mistakes), served(tmp_path) as address:
        for folder in ("one", "none"):
            page.goto(f"{address}/{folder}/0.9/index.html")
            assert page.locator(SWITCH).count() == 0
            assert page.locator(".book-version").first.inner_text() == "version 0.9"
    assert mistakes == []


@pytest.mark.slow
def test_the_header_of_the_book_has_the_switch(book, tmp_path):
    """The real book beside a copy of itself, by links: the switch is seen and can be used."""
    for version in (tb.__version__, "0.0.9"):
        (tmp_path / version).symlink_to(book, target_is_directory=True)
    listed = f'window.BOOK_VERSIONS = ["{tb.__version__}", "0.0.9"];'
    (tmp_path / "versions.js").write_text(listed, "utf-8")
    with chromium_page() as (page, mistakes), served(tmp_path) as address:
        page.goto(f"{address}/{tb.__version__}/api/thirdbody.solve.html")
        switch = page.locator(f"header {SWITCH}").filter(visible=True)
        assert switch.count() == 1
        assert switch.get_attribute("aria-label") == "version of this book"
        switch.select_option("0.0.9")
        page.wait_for_url(f"{address}/0.0.9/api/thirdbody.solve.html")
        assert page.locator("article h1").inner_text().startswith("solve")
    assert mistakes == []


@pytest.mark.slow
def test_every_page_shows_its_version(book):
    shown = f"<span>version {tb.__version__}</span>"
    for name in ("index", "theory", "api/thirdbody.solve"):
        assert shown in (book / f"{name}.html").read_text("utf-8")


@contextlib.contextmanager
def served(folder):
    """The address of a folder, on loopback."""

    class Quiet(http.server.SimpleHTTPRequestHandler):
        def __init__(self, *args):
            super().__init__(*args, directory=folder)

        def log_message(self, *args):
            pass

    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Quiet) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()
