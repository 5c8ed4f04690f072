"""A server of the page and the chromium that drives it; run as a script it fetches playwright's own where none is found.

It never fails and takes at most two minutes: without a browser the tests of the page skip.
"""

import contextlib
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request
from pathlib import Path

SECONDS = 120


def served(port=0, source=None):
    """A server of the page, of another checkout where one is given; and its address."""
    around = {name: value for name, value in os.environ.items() if name != "PYTEST_CURRENT_TEST"}
    if source is not None:
        around["PYTHONPATH"] = str(source / "src")
    command = [sys.executable, "-m", "thirdbody", "app", "--no-browser", "--port", str(port)]
    server = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=around, cwd=source)
    try:
        found = re.search(r"http://[\d.]+:\d+", server.stderr.readline())
        assert found, "the server did not say where it is"
        deadline = time.monotonic() + 60
        while not _answers(found[0]):
            assert time.monotonic() < deadline, "the server does not answer"
            time.sleep(0.1)
    except BaseException:
        ended(server)
        raise
    return server, found[0]


def ended(server):
    """Ends it as Ctrl-C does."""
    server.send_signal(signal.SIGINT)
    try:
        server.wait(10)
    except subprocess.TimeoutExpired:
        server.kill()
        server.wait()
    server.stderr.close()


def _answers(address):
    try:
        return urllib.request.urlopen(address, timeout=5).status == 200
    except (urllib.error.URLError, ConnectionError, TimeoutError):
        return False


def processes_below(pid, words):
    """Process ids of all that a process began, itself or through others, with words in their
    command; none where the system does not list them."""
    every = " ".join(f.read_text() for f in Path(f"/proc/{pid}/task").glob("*/children"))
    below = []
    for child in map(int, every.split()):
        with contextlib.suppress(OSError):
            if words in Path(f"/proc/{child}/cmdline").read_text():
                below.append(child)
            below += processes_below(child, words)
    return below


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
