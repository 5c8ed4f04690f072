"""Build the book into a folder that a static host can serve as it is: `make docs`.

The folder has one book for each version, ``versions.js`` for the switch at the top of every page,
and an ``index.html`` that leads to this version. Books of other versions in it stay.
"""

import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
MADE = "<!-- made by docs/versions.py -->"


def in_order(version):
    """A key that sorts versions by their numbers, and one with .dev0 before its release."""
    parts = [*version.replace("-", ".").split("."), "0"]
    return [int(part) if part.isdigit() else -1 for part in parts]


def add_switch(folder, version):
    """Write the list of versions in a folder, and the page that leads to one of them."""
    versions = {path.parent.name for path in folder.glob("*/objects.inv")} | {version}
    listed = ", ".join(f'"{each}"' for each in sorted(versions, key=in_order, reverse=True))
    (folder / "versions.js").write_text(f"window.BOOK_VERSIONS = [{listed}];\n", "utf-8")
    page = f"""<!doctype html>
{MADE}
<html lang="en">
<meta charset="utf-8">
<title>thirdbody {version}</title>
<meta http-equiv="refresh" content="0; url={version}/index.html">
<a href="{version}/index.html">thirdbody {version}</a>
</html>
"""
    (folder / "index.html").write_text(page, "utf-8")
    # hosts that run Jekyll over a folder would leave out names with an underscore
    (folder / ".nojekyll").write_text("", "utf-8")


def main(folder):
    """Build this version into a folder."""
    sys.path.insert(0, str(HERE.parent / "src"))
    from thirdbody import __version__

    folder = Path(folder)
    book = folder / __version__
    command = [sys.executable, "-m", "sphinx", "-W", "-q", "-b", "html", "-d"]
    command += [folder.parent / "doctrees", HERE, book]
    done = subprocess.run(command, check=False).returncode
    if done == 0:
        # what cells of the notebooks left beside the book is no page of it
        shutil.rmtree(folder / "jupyter_execute", ignore_errors=True)
        add_switch(folder, __version__)
    return done


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
