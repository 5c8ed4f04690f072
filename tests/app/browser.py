"""Which chromium drives the page; run as a script it fetches playwright's own where none is found.

It never fails and takes at most two minutes: without a browser the tests of the page skip.
"""

import shutil
import subprocess
import sys
from pathlib import Path

SECONDS = 120


def chromium(playwright):
    """The path of the system's chromium, or of playwright's own; None where there is neither."""
    names = ("chromium", "chromium-browser", "google-chrome")
    known = [shutil.which(name) for name in names]
    found = next(filter(None, [*known, playwright.chromium.executable_path]))
    return found if Path(found).exists() else None


def main():
    try:
        from playwright.sync_api import sync_playwright

        with sync_playwright() as playwright:
            found = chromium(playwright)
        if found is None:
            command = [sys.executable, "-m", "playwright", "install", "chromium"]
            done = subprocess.run(command, timeout=SECONDS, capture_output=True)
            found = "now installed" if done.returncode == 0 else None
    except Exception as error:
        print(f"no browser: {type(error).__name__}")
        return
    print(f"browser: {found or 'none, its tests will skip'}")


if __name__ == "__main__":
    main()
