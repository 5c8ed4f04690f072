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
