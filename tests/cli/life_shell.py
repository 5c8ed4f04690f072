"""What the tests of ``thirdbody life``, ``assess`` and ``design`` of a life have in common."""

from pathlib import Path

from command_line import run

__all__ = ["CONTACT", "HOUR", "complained", "enter", "quarry", "run", "said", "setting", "study"]

HOUR = 3600.0
CONTACT = """
[outputs.friction]
tau_ss = "100 MPa"
tau_sa = "100 MPa"
[outputs.wear]
K_ss = 1e-7
K_sa = 0
f_ab = 0.1
f_roll = 0
[film]
conjunction = { shape = "point", R = "9.5 mm" }
oil = { eta = "30 mPa s", alpha = "20 / GPa" }
load = "50 N"
speed = "1 m/s"
slide_roll = 0.05
[life.debris]
sizes = "boundary-lubricated"
[life.contact]
contacts = 20
"""
"""Contacts in the oil of the template, without an entry ratio."""


def said(done):
    """What a command that succeeded printed, in one line."""
    assert done.exit_code == 0, done.stderr
    return " ".join(done.stdout.split())


def complained(done):
    """What a command that was refused said, in one line."""
    assert done.exit_code == 2, done.stdout
    assert "Traceback" not in done.stderr
    return " ".join(done.stderr.split())


def setting(*keys):
    """Options that set keys."""
    return [word for key in keys for word in ("--set", key)]


def study(kind, more="", file="study.toml"):
    """The file of a template with more tables."""
    if not Path(f"bare-{kind}.toml").exists():
        assert run("new", kind, "--out", f"bare-{kind}.toml").exit_code == 0
    Path(file).write_text(Path(f"bare-{kind}.toml").read_text("utf-8") + more, "utf-8")
    return file


def quarry(more="", file="quarry.toml"):
    """The bearing of its template in the oil of the other."""
    oil = Path(study("oil-circuit")).read_text("utf-8")
    life = oil[oil.index("[life]") : oil.index("# The contact that")]
    bearing = Path(study("ball-bearing")).read_text("utf-8").split("[[particles]]")[0]
    Path(file).write_text(bearing + life + more, "utf-8")
    return file


def enter(tmp_path, monkeypatch):
    """Work in an empty folder, on a screen of 80 columns."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    return tmp_path
