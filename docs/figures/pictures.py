"""Draw the pictures of the README into docs/images: make pictures.

Three figures of one contact, drawn by `thirdbody.plot` and by the section of the page, and the
page itself in a browser, where there is one. Colours are reduced to a palette.
"""

import io
import re
import shutil
import subprocess
import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse
from PIL import Image

import thirdbody as tb
from thirdbody.app.cross_section import section
from thirdbody.study import load_study
from thirdbody.views import plot
from thirdbody.views.plot.style import OKABE_ITO

ROOT = Path(__file__).parents[2]
OUT = ROOT / "docs" / "images"
STUDY = ROOT / "examples" / "dusty_ball_screw.toml"
WIDTH = 900
MOST = 80_000
"""Bytes of a picture."""


def keep(name: str, png: bytes, width: int) -> None:
    """Write a picture with as many colours as its size allows."""
    image = Image.open(io.BytesIO(png)).convert("RGB")
    if image.width != width:
        size = (width, round(image.height * width / image.width))
        image = image.resize(size, Image.Resampling.LANCZOS)
    for colours in (256, 128, 64, 32):
        out = io.BytesIO()
        image.quantize(colours, dither=Image.Dither.NONE).save(out, "PNG", optimize=True)
        if len(out.getvalue()) <= MOST:
            break
    else:
        sys.exit(f"{name}.png has {len(out.getvalue())} bytes, more than {MOST}")
    (OUT / f"{name}.png").write_bytes(out.getvalue())
    print(f"docs/images/{name}.png: {image.width} x {image.height}, {len(out.getvalue())} bytes")


def figure(name: str, drawn: Figure) -> None:
    """Write a figure of matplotlib."""
    out = io.BytesIO()
    drawn.savefig(out, dpi=2 * WIDTH / drawn.get_figwidth(), facecolor="white")
    keep(name, out.getvalue(), WIDTH)


def interface(contact: tb.Contact) -> Figure:
    """One draw from the model, to scale: what carries the load."""
    state = tb.solve(contact, F_star=2e-4)
    drawn = next(
        found
        for found in (section(contact, state, seed=seed) for seed in range(1000))
        if (found.z > found.h).any() and 6 <= sum(grain.is_loaded for grain in found.grains) <= 9
    )
    x, z, h = 1e6 * drawn.x, 1e9 * drawn.z, 1e9 * drawn.h
    made = Figure(figsize=(9, 1.75), layout="constrained")
    ax = made.add_subplot()
    top, bottom = h + 150, z.min() - 150
    ax.fill_between(x, bottom, np.minimum(z, h), color="#c3c7cd", lw=0)
    ax.plot(x, np.minimum(z, h), color="#333333", lw=1.2)
    ax.fill_between(x, h, top, color="#dcdfe3", lw=0)
    ax.axhline(h, color="#333333", lw=1.2)
    ax.plot(x, np.where(z > h, h, np.nan), color=OKABE_ITO["vermilion"], lw=5, zorder=4)
    for grain in drawn.grains:
        middle = grain.seat + 0.5 * (grain.gap if grain.is_loaded else grain.diameter)
        edge = (OKABE_ITO["vermilion"], 2.0, "-") if grain.is_loaded else ("#333333", 1.0, "--")
        size = (1e6 * grain.diameter, 1e9 * grain.diameter)
        ax.add_patch(
            Ellipse(
                (1e6 * grain.place, 1e9 * middle), *size, zorder=3, fc=OKABE_ITO["orange"],
                ec=edge[0], lw=edge[1], ls=edge[2], alpha=1.0 if grain.is_loaded else 0.5,
            )
        )  # fmt: skip
    ax.set(xlim=(x[0], x[-1]), ylim=(bottom, top), aspect=1e-3)
    ax.set(xlabel="Along the surface [µm]", ylabel="Height [nm]")
    told = f"p = {state.pressure / 1e6:.0f} MPa, h = {h:.0f} nm"
    share = 100 * float(state.particle_load_share)
    ax.set_title(
        f"{told}: particles carry {share:.0f} % (red outline: loaded; red line: asperity contact)",
        fontsize=10,
    )
    return made


def share(contact: tb.Contact) -> Figure:
    """What particles carry over the load, modes and critical loads."""
    state = tb.solve(contact, F_star=np.geomspace(1e-7, 8e-3, 300))  # up to A_t = 0.2
    made = Figure(figsize=(9, 3.6), layout="constrained")
    left, right = made.subplots(1, 2)
    plot.shares(state, left)
    plot.modes(state, right, transitions=tb.transitions(contact))
    right.texts[-1].set(position=(-3, 0), ha="right")  # F_cr2 lies at the edge
    return made


def modes(contact: tb.Contact) -> Figure:
    """Contact mode over particle size and load."""
    sizes, loads = np.geomspace(0.1, 10, 1000), np.geomspace(1e-7, 1e-3, 800)
    made = Figure(figsize=(7, 4), layout="constrained")
    plot.mode_map(contact, F_star=loads, ratio=sizes, ax=made.add_subplot())
    return made


def page() -> None:
    """The page in the browser, a tab with figures; the old picture stays where none is found."""
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        print("docs/images/page.png stays as it is: playwright is not installed")
        return
    command = [sys.executable, "-m", "thirdbody", "app", str(STUDY), "--no-browser", "--port", "0"]
    with sync_playwright() as playwright:
        found = shutil.which("chromium") or playwright.chromium.executable_path
        if not Path(found).exists():
            print("docs/images/page.png stays as it is: no chromium found (make browser)")
            return
        server = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        try:
            address = re.search(r"http://[\d.]+:\d+", server.stderr.readline())[0]  # type: ignore
            browser = playwright.chromium.launch(executable_path=found, args=["--no-sandbox"])
            shown = browser.new_page(
                viewport={"width": 1280, "height": 1030}, reduced_motion="reduce"
            )
            shown.goto(address)
            shown.get_by_role("tab", name="Curves", exact=True).click()
            shown.wait_for_selector('[data-figure="critical"]')
            shown.add_style_tag(content=".modebar { display: none !important; }")
            shown.mouse.move(342, 220)
            shown.wait_for_timeout(1000)
            keep("page", shown.screenshot(), 1280)
            browser.close()
        finally:
            server.terminate()
            server.wait(10)


if __name__ == "__main__":
    OUT.mkdir(parents=True, exist_ok=True)
    mpl.rcParams["font.size"] = 10
    contact = load_study(STUDY).contact
    for name, draw in (("interface", interface), ("share", share), ("modes", modes)):
        figure(name, draw(contact))
    page()
