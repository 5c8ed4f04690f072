"""What a command reads has an end, and what it does not read says why."""

import os
import threading

import pytest
from command_line import refused
from refusals import refuses

from thirdbody.errors import InvalidValue, Mistake
from thirdbody.quantities.files import read_bytes

from .test_cli import run

STUDY = """[surfaces]
first = "S45C"
second = "S45C"
[roughness]
sigma = "100 nm"
R = "2.8 um"
[load]
pressure = "5 MPa"
"""
EVERY = ["solve", "sweep", "film", "explicit", "assess", "design", "report", "compare", "table"]


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("a.png", b"\x89PNG\r\n\x1a\n\0\0", "PNG"),
        ("a.json", b'{"inputs": {}, "states": {}}', "--json"),
        ("a.json", b'{"curve": {}, "units": {}}', "thirdbody surface"),
        ("a.json", b"[1, 2]", ""),
        ("a.xlsx", b"PK\x03\x04...", "workbook"),
        ("part.x3p", b"PK\x03\x04...", "thirdbody surface part.x3p"),
        ("part.sur", b"\x01\0\x02", "thirdbody surface part.sur"),
        ("a.html", b"<!DOCTYPE html><html></html>", "HTML"),
        ("a.csv", b"status,h [m]\nok,1", "states"),
        ("oil.csv", b"time,code\n1 h,18/16/13", "--reports oil.csv"),
    ],
)
def test_a_file_that_is_no_study_is_told_what_it_is(tmp_path, monkeypatch, name, content, says):
    monkeypatch.chdir(tmp_path)
    (tmp_path / name).write_bytes(content)
    for command in ("solve", "film"):
        done = refused(command, name)
        (problem,) = done.problems
        assert problem.code is (Mistake.UNREADABLE if says else Mistake.FORM)
        assert name in problem
        assert says in problem


def test_a_study_is_read_whatever_its_name(tmp_path):
    for name in ("study.json", "study.csv", "study.svg.toml"):
        (tmp_path / name).write_text("# status, of a study\n" + STUDY, encoding="utf-8")
        assert run("solve", tmp_path / name).exit_code == 0


def test_a_file_may_have_so_many_bytes_and_no_more(tmp_path):
    file = tmp_path / "own.toml"
    file.write_bytes(b"x" * 100)
    assert read_bytes(file, "a study file", most=100) == b"x" * 100
    with refuses(Mistake.UNREADABLE, "", says="a study file"):
        read_bytes(file, "a study file", most=99)


def test_a_pipe_without_an_end_is_left_at_the_limit(tmp_path, monkeypatch):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)

    def pour():
        with open(pipe, "wb", buffering=0) as out:
            try:
                while True:
                    out.write(b"\0" * 65536)
            except BrokenPipeError:
                pass

    writer = threading.Thread(target=pour, daemon=True)
    writer.start()
    with pytest.raises(InvalidValue, match="longer than 1 MiB"):
        read_bytes(pipe, "a study file", most=2**20)
    writer.join(10)
    assert not writer.is_alive()


def test_a_pipe_that_ends_is_read(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    writer = threading.Thread(target=pipe.write_text, args=(STUDY,), daemon=True)
    writer.start()
    done = run("solve", pipe, "--json")
    assert done.exit_code == 0, done.output


@pytest.mark.parametrize("name", EVERY)
def test_no_command_reads_a_device(name, tmp_path):
    out = {"sweep": ["--out", tmp_path / "out"], "table": ["--out", tmp_path / "out.inp"]}
    done = run(name, "/dev/zero", *out.get(name, []))
    assert done.exit_code == 2
    assert done.stderr.splitlines() == [
        "error: cannot read /dev/zero: it is a device, not a study file"
    ]


@pytest.mark.parametrize(
    ("more", "what"),
    [
        ('materials = "/dev/zero"\n' + STUDY, "materials"),
        (
            STUDY.replace("[load]", '[particles]\nmaterial = "SiO2"\nsizes = "/dev/zero"\n'
                          'areal_density = "1e9 / m^2"\n[load]'),
            "sizes",
        ),
    ],
)  # fmt: skip
def test_no_file_that_a_study_names_is_a_device(more, what, tmp_path):
    study = tmp_path / "study.toml"
    study.write_text(more)
    done = run("solve", study)
    assert done.exit_code == 2
    (line,) = done.stderr.splitlines()
    assert "/dev/zero: it is a device" in line
    assert what in line
