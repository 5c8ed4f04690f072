"""The worked examples run as a stranger runs them, and end in a sentence to act on."""

import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest
from matplotlib.image import imread

pytestmark = pytest.mark.check
ROOT = Path(__file__).parent.parent
EXAMPLES = ROOT / "examples"
# each with the answer that its last sentence gives
ANSWERS = {
    "ball_screw_heat": r"keep out grains above [\d.]+ µm",
    "ball_screw_dents": r"keep the dust out with wipers",
    "electrical_contact": r"press with [\d.]+ N instead of [\d.]+ N",
    "stribeck": r"filter the oil, or run [\d.]+ times as fast",
}
SLOW = {"additive": r"^Order silica of \d+ to \d+ nm and put in [\d.]+% by weight.*no margin"}
EVERY = [
    *ANSWERS.items(),
    *(pytest.param(*item, marks=pytest.mark.slow) for item in SLOW.items()),
]


def run(name, folder, *arguments):
    command = [sys.executable, "-W", "error", str(EXAMPLES / f"{name}.py"), *arguments]
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, check=False, encoding="utf-8"
    )
    assert done.returncode == 0, done.stderr[-2000:]
    return done.stdout.strip()


@pytest.mark.parametrize(("name", "answer"), EVERY)
def test_example_as_a_stranger(name, answer, tmp_path):
    """In a folder of one's own, where the figure is told to go; nothing else is left behind."""
    said = run(name, tmp_path, "told.png")
    assert [file.name for file in tmp_path.iterdir()] == ["told.png"]
    picture = imread(tmp_path / "told.png")
    assert min(picture.shape[:2]) > 300
    assert picture[..., :3].std() > 0.05  # something is drawn
    assert (tmp_path / "told.png").stat().st_size > 10_000
    last = said.splitlines()[-1]
    assert re.search(answer, last), last
    assert last.endswith(".")


def test_figure_goes_to_the_folder_when_nothing_is_told(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["electrical_contact.py"])
    runpy.run_path(str(EXAMPLES / "electrical_contact.py"), run_name="__main__")
    assert [file.name for file in tmp_path.iterdir()] == ["electrical_contact.png"]


def test_the_book_lists_every_command():
    from thirdbody.cli import app

    found = {(info.name or info.callback.__name__) for info in app.registered_commands}
    text = (ROOT / "docs" / "commands.md").read_text("utf-8")
    table = re.search(r"^[|]---[|]---[|]\n((?:[|].*\n)+)", text, re.M)[1]
    first = "".join(re.findall(r"^\|(.*?)\|", table, re.M))
    listed = set(re.findall(r"`(\w+)(?: [\w.]+)?`", first))
    assert found == listed


def test_every_example_is_here_and_in_the_book():
    scripts = {file.stem for file in EXAMPLES.glob("*.py")}
    assert scripts == {*ANSWERS, *SLOW}
    pages = [*(ROOT / "docs").glob("*.md"), ROOT / "README.md"]
    text = "\n".join(page.read_text("utf-8") for page in pages)
    for name in scripts:
        assert f"examples/{name}.py" in text, name
    readme = (ROOT / "README.md").read_text("utf-8")
    for name in scripts:
        assert f"examples/{name}.py" in readme, f"{name} is not in README"


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
def test_dust_and_debris_carry_what_the_book_says():
    import thirdbody as tb

    text = " ".join((ROOT / "docs" / "dust.md").read_text("utf-8").split())
    contact = tb.load_study(EXAMPLES / "dust_and_debris.toml").contact
    dust, debris = contact.populations
    assert dust.areal_density == pytest.approx(20 * debris.areal_density)
    light, heavy = (tb.solve(contact, pressure=p).populations for p in (8e4, 5e6))
    assert f"carries {light[1].load_share:.0%} of the load at 80 kPa.".replace("%", " %") in text
    said = f"the dust carries {heavy[0].load_share:.0%} and the debris {heavy[1].load_share:.0%}."
    assert said.replace("%", " %") in text


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
def test_squashed_debris_carries_four_times_the_load_of_spheres():
    """What docs/soft.md and the example say of a film of a tenth of the size."""
    import thirdbody as tb

    contact = tb.load_study(EXAMPLES / "steel_debris_in_film.toml").contact
    assert contact.particles.diameter.mean_diameter == pytest.approx(5e-6, rel=0.03)
    law = contact.particle_law
    spheres = contact.replace(particle_law=law.replace(soft="sphere"))
    squashed, whole = (tb.solve(one, d=0.5e-6).pressure for one in (contact, spheres))
    assert squashed / whole == pytest.approx(4, rel=0.1)
