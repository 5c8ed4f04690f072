"""What a command reads has an end, and what it does not read says why."""

import os
import threading

import pytest
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
