"""Reports of all examples on paper: numbered pages, well filled, with nothing torn apart."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from thirdbody.study import load_study
from thirdbody.views.report import report

sync_api = pytest.importorskip("playwright.sync_api", reason="needs playwright to drive a browser")
sys.path.insert(0, str(Path(__file__).parents[1] / "app"))
from browser import chromium  # noqa: E402

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))
pytestmark = [
    pytest.mark.check,
    pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning"),
]
LONGEST, LEAST = 8, 0.6
"""Pages of a report; how far down a page is filled before the next one begins."""


@pytest.fixture(scope="module")
def browser():
    with sync_api.sync_playwright() as playwright:
        path = chromium(playwright)
        if path is None:
            pytest.skip("no browser")
        browser = playwright.chromium.launch(executable_path=path)
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def words_of():
    """Pages of a PDF, each the words on it with their lower edges as part of the height."""
    if shutil.which("pdftotext") is None:
        pytest.skip("needs pdftotext, of poppler")

    def read(pdf):
        done = subprocess.run(
            ["pdftotext", "-bbox", str(pdf), "-"], capture_output=True, text=True, check=True
        )
        pages = []
        for height, page in re.findall(
            r'<page [^>]*height="([\d.]+)">(.*?)</page>', done.stdout, re.S
        ):
            found = re.findall(r'yMax="([\d.]+)">(.*?)</word>', page)
            pages.append([(float(y) / float(height), word) for y, word in found])
        return pages

    return read


@pytest.mark.parametrize("file", EXAMPLES, ids=lambda file: file.stem)
def test_a_report_on_paper(file, browser, words_of, tmp_path):
    found = report(load_study(file), file=file.read_text("utf-8"))
    page = browser.new_page()
    page.set_content(found.html())
    pdf = tmp_path / "report.pdf"
    page.pdf(path=pdf, prefer_css_page_size=True)
    page.close()
    pages = words_of(pdf)
    assert 2 <= len(pages) <= LONGEST
    title = found.study.title
    for number, words in enumerate(pages, 1):
        foot = " ".join(word for y, word in words if y > 0.95)
        assert foot == f"{title} {number} / {len(pages)}"
        body = max(y for y, _ in words if y < 0.95)
        assert body > LEAST or number == len(pages), f"page {number} ends at {body:.0%}"


def test_a_title_of_any_letters_stands_below_the_page(browser, words_of, tmp_path):
    """Quotes, brackets and braces end no style."""
    from thirdbody.views.html import document
    from thirdbody.views.report import running

    title = 'σ "<of>" {dust}; \\a'
    page = browser.new_page()
    page.set_content(document(title, ["<p>text</p>"], style=running(title)))
    pdf = tmp_path / "page.pdf"
    page.pdf(path=pdf, prefer_css_page_size=True)
    page.close()
    (words,) = words_of(pdf)
    foot = " ".join(word for y, word in words if y > 0.95)
    assert foot.replace("&quot;", '"').replace("&lt;", "<").replace("&gt;", ">") == f"{title} 1 / 1"
